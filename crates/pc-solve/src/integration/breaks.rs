//! Times at which a field is not smooth: no step crosses one.

/// The relative difference below which two times count as equal: twice the one that CVODES uses.
const ROUNDINGS: f64 = 4.0 * f64::EPSILON;

/// Whether two times are equal up to rounding error.
fn are_close(a: f64, b: f64) -> bool {
    (a - b).abs() <= ROUNDINGS * a.abs().max(b.abs())
}

/// The break that equals t up to rounding error, if there is one.
pub(crate) fn break_at(breaks: &[f64], t: f64) -> Option<f64> {
    breaks.iter().copied().find(|&time| are_close(time, t))
}

/// The first break strictly between t and the end, in the direction of the end; `breaks` are in
/// ascending order.
fn following(breaks: &[f64], t: f64, end: f64) -> Option<f64> {
    let next = if end >= t {
        breaks.get(breaks.partition_point(|&time| time <= t)).copied().filter(|&time| time < end)
    } else {
        let before = breaks.partition_point(|&time| time < t).checked_sub(1);
        before.map(|i| breaks[i]).filter(|&time| time > end)
    };
    next.filter(|&time| end.is_infinite() || !are_close(time, end))
}

/// The time from which breaks count as being ahead, which is t or a break close to t; and the first
/// break ahead, if it lies before the end.
///
/// A break that differs from t by rounding error only, as after an event, is too close for a step
/// and counts as having been reached.
pub(crate) fn next_break(breaks: &[f64], mut t: f64, end: f64) -> (f64, Option<f64>) {
    let mut next = following(breaks, t, end);
    while let Some(time) = next.filter(|&time| are_close(time, t)) {
        t = time;
        next = following(breaks, t, end);
    }
    (t, next)
}
