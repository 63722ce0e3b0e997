//! The first sign change of functions along a step, from their series.

/// The resolution, as a fraction of a step.
const RESOLVED: f64 = 1e-14;
/// A function counts as beginning at zero if its initial value is below this fraction of the
/// largest term of its series.
const AT_ZERO: f64 = 1e-13;

/// The first s in [0, length] at which the polynomial with these coefficients leaves `side`; the
/// polynomial begins on that side, or at zero up to rounding error. None if the polynomial stays on
/// that side.
///
/// On an interval around m with coefficients d_k there, |p(s) − d_0| ≤ Σ |d_k| rᵏ: where that is
/// less than |d_0| there is no root, and where Σ k |d_k| rᵏ⁻¹, k ≥ 2, is less than |d_1| there is
/// at most one. All other intervals are halved.
pub(super) fn first_exit(coefficients: &[f64], side: f64, length: f64) -> Option<f64> {
    // In units of the step.
    let mut scaled: Vec<f64> = coefficients.to_vec();
    let mut power = side;
    for c in &mut scaled {
        *c *= power;
        power *= length;
    }
    let largest = scaled.iter().map(|c| c.abs()).fold(0.0, f64::max);
    if largest == 0.0 {
        return None;
    }
    // Past a root at zero, the other roots are those of p(s)/s.
    let terms = if scaled[0] <= AT_ZERO * largest { &scaled[1..] } else { &scaled[..] };
    if terms.iter().find(|c| **c != 0.0).is_some_and(|c| *c < 0.0) {
        return Some(0.0);
    }
    let mut open = vec![(0.0, 1.0)];
    while let Some((a, b)) = open.pop() {
        let (middle, radius) = (0.5 * (a + b), 0.5 * (b - a));
        let local = shifted(terms, middle);
        let bound = |from: usize, weight: fn(usize) -> f64| {
            let terms = local.iter().enumerate().skip(from);
            terms.fold(0.0, |sum, (k, d)| sum + weight(k) * d.abs() * radius.powi((k - from) as i32))
        };
        let rest = bound(1, |_| 1.0) * radius;
        if local[0] > rest {
            continue;
        }
        let ends = [a, b].map(|s| value(terms, s));
        let is_monotone = local.get(1).is_some_and(|slope| slope.abs() > bound(2, |k| k as f64) * radius);
        if is_monotone || radius < RESOLVED {
            if ends[1] < 0.0 {
                return Some(bisected(terms, (a, b)) * length);
            }
            continue;
        }
        open.push((middle, b));
        open.push((a, middle));
    }
    None
}

/// The coefficients of the polynomial about another point.
fn shifted(terms: &[f64], by: f64) -> Vec<f64> {
    let mut local = terms.to_vec();
    for i in 0..local.len() {
        for k in (i..local.len() - 1).rev() {
            local[k] += by * local[k + 1];
        }
    }
    local
}

fn value(terms: &[f64], s: f64) -> f64 {
    terms.iter().rev().fold(0.0, |sum, c| sum * s + c)
}

/// A point in [a, b] that lies at most a few rounding errors beyond the zero at which the
/// polynomial becomes negative.
fn bisected(terms: &[f64], (mut a, mut b): (f64, f64)) -> f64 {
    while b - a > 4.0 * f64::EPSILON * b {
        let middle = 0.5 * (a + b);
        if middle <= a || middle >= b {
            break;
        }
        if value(terms, middle) < 0.0 { b = middle } else { a = middle }
    }
    b
}

#[cfg(test)]
mod tests {
    use super::first_exit;

    /// The coefficients of Π (s − root).
    fn with_roots(roots: &[f64]) -> Vec<f64> {
        roots.iter().fold(vec![1.0], |p, root| {
            let mut product = vec![0.0; p.len() + 1];
            for (k, c) in p.iter().enumerate() {
                product[k] -= root * c;
                product[k + 1] += c;
            }
            product
        })
    }

    #[test]
    fn the_first_root_of_odd_order_is_found() {
        for (roots, first) in [
            (vec![0.3, 0.300001, 0.9], Some(0.3)),
            (vec![0.25, 0.25, 0.7], Some(0.7)), // touches zero at the double root
            (vec![0.5, 0.5], None),
            (vec![-0.5, 1.5], None),
            (vec![0.0, 0.6], Some(0.6)), // begins at zero, on the side it enters
            (vec![1.0], Some(1.0)),
        ] {
            let p = with_roots(&roots);
            let side = if p.iter().find(|c| **c != 0.0).is_some_and(|c| *c > 0.0) { 1.0 } else { -1.0 };
            for length in [1.0, 1.0 + 1e-9] {
                let found = first_exit(&p, side, length);
                match first {
                    // The accuracy of a root is limited by the rounding of the coefficients.
                    Some(root) if root < length => {
                        assert!((found.unwrap() - root).abs() < 1e-9, "{roots:?}: {found:?}");
                    }
                    Some(_) | None if first.is_none() => assert_eq!(found, None, "{roots:?}"),
                    _ => {}
                }
            }
            // Backwards in time, on the mirror image.
            let mirrored: Vec<f64> =
                p.iter().enumerate().map(|(k, c)| if k % 2 == 1 { -c } else { *c }).collect();
            let back = first_exit(&mirrored, side, -1.0 - 1e-9);
            assert_eq!(back.is_some(), first.is_some(), "{roots:?}");
        }
        // A function that begins at zero and enters the other side exits at once.
        assert_eq!(first_exit(&[1e-17, -1.0, 0.5], 1.0, 1.0), Some(0.0));
        assert_eq!(first_exit(&[-1e-17, 1.0, 0.5], 1.0, 1.0), None);
    }
}
