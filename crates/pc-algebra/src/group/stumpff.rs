//! Stumpff's functions, in terms of which the exponentials of rotations and motions are free of
//! cancellation.

/// c_n(θ²) = Σ (−θ²)^i/(2i + n)! for n = 0..5, so that c_0 = cos θ, c_1 = sin θ/θ, c_2 = (1 − cos θ)/θ²,
/// c_3 = (θ − sin θ)/θ³ and c_n = 1/n! − θ² c_(n+2).
pub(crate) fn stumpff(angle: f64) -> [f64; 6] {
    /// Below this angle the quotients lose digits (1/6 − c_3 is a fifth of its terms here) and the series
    /// needs few terms.
    const SERIES: f64 = 2.0;
    let square = angle * angle;
    let [c4, c5];
    if angle.abs() < SERIES {
        [c4, c5] = [series(4, square), series(5, square)];
        let (c2, c3) = (0.5 - square * c4, 1.0 / 6.0 - square * c5);
        return [angle.cos(), 1.0 - square * c3, c2, c3, c4, c5];
    }
    let (c0, c1) = (angle.cos(), angle.sin() / angle);
    let (c2, c3) = ((1.0 - c0) / square, (1.0 - c1) / square);
    [c4, c5] = [(0.5 - c2) / square, (1.0 / 6.0 - c3) / square];
    [c0, c1, c2, c3, c4, c5]
}

/// The sum Σ (−z)^i/(2i + n)!: after 12 terms the rest is below 2⁻⁵³ of the sum for z ≤ 4, n ≥ 4.
fn series(n: u32, z: f64) -> f64 {
    const TERMS: u32 = 12;
    // 1/n! (1 − z/((n+1)(n+2)) (1 − z/((n+3)(n+4)) (…)))
    let nested = (0..TERMS).rev().fold(1.0, |rest, i| {
        let below = f64::from((n + 2 * i + 1) * (n + 2 * i + 2));
        1.0 - z / below * rest
    });
    nested / (1..=n).map(f64::from).product::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_rational::BigRational;
    use num_traits::{One, ToPrimitive, Zero};

    /// The series in exact rational arithmetic, 40 terms.
    fn exact(n: u32, angle: f64) -> f64 {
        let square = BigRational::from_float(angle).unwrap().pow(2);
        let mut term = (1..=n).fold(BigRational::one(), |f, i| f / BigRational::from_integer(i.into()));
        let mut sum = BigRational::zero();
        for i in 0..40 {
            sum += &term;
            let below = (n + 2 * i + 1) * (n + 2 * i + 2);
            term = -term * &square / BigRational::from_integer(below.into());
        }
        sum.to_f64().unwrap()
    }

    /// The bound is 16 rounding errors: at the angle 2, (1/6 − c_3)/θ² magnifies the four or so rounding
    /// errors of its terms by a factor of six.
    const RELATIVE: f64 = 16.0 * f64::EPSILON;

    #[test]
    fn values_agree_with_the_exact_series_around_the_change() {
        let angles = [0.0, 1e-9, 1e-4, 0.01, 0.3, 0.9, 1.5, 1.999, 1.999_999, 2.0, 2.000_001, 2.1, 2.9, 3.2];
        for angle in angles {
            for (n, value) in stumpff(angle).into_iter().enumerate().skip(1) {
                let exact = exact(n as u32, angle);
                assert!((value / exact - 1.0).abs() < RELATIVE, "c_{n}({angle}): {value} {exact}");
            }
            // c_0 passes through 0: an absolute bound.
            assert!((stumpff(angle)[0] - exact(0, angle)).abs() < 1e-15);
        }
    }
}
