//! Times at which a field is not smooth: no step crosses one.

/// What CVODES takes two times for the same by, and as much again.
const ROUNDINGS: f64 = 4.0 * f64::EPSILON;

/// Whether two times are the same but for rounding.
pub(crate) fn are_close(a: f64, b: f64) -> bool {
    (a - b).abs() <= ROUNDINGS * a.abs().max(b.abs())
}

/// The first of the breaks, which rise, after t and before the end in its direction.
pub(crate) fn following(breaks: &[f64], t: f64, end: f64) -> Option<f64> {
    let next = if end >= t {
        breaks.get(breaks.partition_point(|&time| time <= t)).copied().filter(|&time| time < end)
    } else {
        let before = breaks.partition_point(|&time| time < t).checked_sub(1);
        before.map(|i| breaks[i]).filter(|&time| time > end)
    };
    next.filter(|&time| end.is_infinite() || !are_close(time, end))
}
