//! The slopes of a cubic spline.

/// The slopes of the spline (not-a-knot); for three points, those of the parabola through the points, and for
/// two, those of the straight line.
pub(super) fn slopes_of_spline(x: &[f64], u: &[f64]) -> Vec<f64> {
    let n = x.len();
    let h: Vec<f64> = x.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let rise: Vec<f64> = u.windows(2).zip(&h).map(|(pair, h)| (pair[1] - pair[0]) / h).collect();
    match n {
        2 => return vec![rise[0]; 2],
        3 => {
            let curve = (rise[1] - rise[0]) / (h[0] + h[1]);
            return vec![rise[0] - h[0] * curve, rise[0] + h[0] * curve, rise[1] + h[1] * curve];
        }
        _ => {}
    }
    // Rows (below, diagonal, above | right); the pivots of the elimination are positive.
    let (first, last) = (x[2] - x[0], x[n - 1] - x[n - 3]);
    let start = ((h[0] + 2.0 * first) * h[1] * rise[0] + h[0] * h[0] * rise[1]) / first;
    let mut rows = vec![(0.0, h[1], first, start)];
    for i in 1..n - 1 {
        let right = 3.0 * (h[i] * rise[i - 1] + h[i - 1] * rise[i]);
        rows.push((h[i], 2.0 * (h[i - 1] + h[i]), h[i - 1], right));
    }
    let end = h[n - 2] * h[n - 2] * rise[n - 3] + (2.0 * last + h[n - 2]) * h[n - 3] * rise[n - 2];
    rows.push((last, h[n - 3], 0.0, end / last));
    for i in 1..n {
        let (_, pivot, above, right) = rows[i - 1];
        let row = &mut rows[i];
        let share = row.0 / pivot;
        row.1 -= share * above;
        row.3 -= share * right;
    }
    let mut slopes = vec![0.0; n];
    for i in (0..n).rev() {
        let (_, pivot, above, right) = rows[i];
        let next = if i + 1 < n { slopes[i + 1] } else { 0.0 };
        slopes[i] = (right - above * next) / pivot;
    }
    slopes
}
