//! Where functions along a step first change their signs, by their series.

/// Parts of a step that are told apart.
const RESOLVED: f64 = 1e-14;
/// A function that begins below this part of its terms begins at zero.
const AT_ZERO: f64 = 1e-13;

/// The first s in [0, length] at which a polynomial with these coefficients, which begins on this side of zero or, but for rounding, at
/// zero, goes to the other; none if it does not.
///
/// On an interval around m with coefficients d_k there, |p(s) − d_0| ≤ Σ |d_k| rᵏ: where that is less than |d_0| there is no root, and
/// where Σ k |d_k| rᵏ⁻¹, k ≥ 2, is less than |d_1| there is at most one. Other intervals are halved.
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
    // What begins at zero has left it: the other roots are those of p(s)/s.
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

/// The coefficients at another point.
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

/// A place at most a few roundings behind where the polynomial falls through zero between a and b.
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
            (vec![0.25, 0.25, 0.7], Some(0.7)), // which the first two only touch
            (vec![0.5, 0.5], None),
            (vec![-0.5, 1.5], None),
            (vec![0.0, 0.6], Some(0.6)), // begins at zero, on the side that it goes to
            (vec![1.0], Some(1.0)),
        ] {
            let p = with_roots(&roots);
            let side = if p.iter().find(|c| **c != 0.0).is_some_and(|c| *c > 0.0) { 1.0 } else { -1.0 };
            for length in [1.0, 1.0 + 1e-9] {
                let found = first_exit(&p, side, length);
                match first {
                    // A root is as exact as the coefficients are, of which each has rounding.
                    Some(root) if root < length => {
                        assert!((found.unwrap() - root).abs() < 1e-9, "{roots:?}: {found:?}");
                    }
                    Some(_) | None if first.is_none() => assert_eq!(found, None, "{roots:?}"),
                    _ => {}
                }
            }
            // Against time, on the mirror image.
            let mirrored: Vec<f64> =
                p.iter().enumerate().map(|(k, c)| if k % 2 == 1 { -c } else { *c }).collect();
            let back = first_exit(&mirrored, side, -1.0 - 1e-9);
            assert_eq!(back.is_some(), first.is_some(), "{roots:?}");
        }
        // What begins at zero and goes to the other side exits at once.
        assert_eq!(first_exit(&[1e-17, -1.0, 0.5], 1.0, 1.0), Some(0.0));
        assert_eq!(first_exit(&[-1e-17, 1.0, 0.5], 1.0, 1.0), None);
    }
}
