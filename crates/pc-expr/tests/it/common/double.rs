//! Functions to some 31 digits, as sums of two numbers.

/// The unevaluated sum of two numbers, the second below half a unit of the first.
#[derive(Clone, Copy)]
pub(crate) struct Double(pub(crate) f64, pub(crate) f64);

pub(crate) fn two_sum(a: f64, b: f64) -> Double {
    let s = a + b;
    let v = s - a;
    Double(s, (a - (s - v)) + (b - v))
}

pub(crate) fn two_product(a: f64, b: f64) -> Double {
    let p = a * b;
    Double(p, a.mul_add(b, -p))
}

impl Double {
    pub(crate) fn plus(self, b: Double) -> Double {
        let s = two_sum(self.0, b.0);
        let t = two_sum(self.1, b.1);
        let s = two_sum(s.0, s.1 + t.0);
        two_sum(s.0, s.1 + t.1)
    }

    pub(crate) fn times(self, b: Double) -> Double {
        let p = two_product(self.0, b.0);
        two_sum(p.0, p.1 + (self.0 * b.1 + self.1 * b.0))
    }

    pub(crate) fn over(self, d: f64) -> Double {
        let q = self.0 / d;
        let p = two_product(q, d);
        let rest = (self.0 - p.0) - p.1 + self.1;
        two_sum(q, rest / d)
    }
}

/// π/2 to 212 bits.
const HALF_PI: [f64; 4] = [
    std::f64::consts::FRAC_PI_2,
    6.123_233_995_736_766e-17,
    -1.497_384_904_859_169_8e-33,
    5.562_271_104_316_826e-50,
];

/// (sin x, cos x); for |x| ≤ 10⁶ also where one of them is tiny.
pub(crate) fn circle(x: f64) -> [Double; 2] {
    let n = (x * std::f64::consts::FRAC_2_PI).round();
    let mut r = Double(x, 0.0);
    for part in HALF_PI {
        let p = two_product(-n, part);
        r = r.plus(p);
    }
    let square = r.times(r);
    let taylor = |first: Double, mut k: f64| {
        let (mut term, mut sum) = (first, first);
        while term.0.abs() > 1e-36 * sum.0.abs() && k < 60.0 {
            let next = term.times(square).over(k * (k + 1.0));
            term = Double(-next.0, -next.1);
            sum = sum.plus(term);
            k += 2.0;
        }
        sum
    };
    let (s, c) = (taylor(r, 2.0), taylor(Double(1.0, 0.0), 1.0));
    let minus = |d: Double| Double(-d.0, -d.1);
    match n.rem_euclid(4.0) as u32 {
        0 => [s, c],
        1 => [c, minus(s)],
        2 => [minus(s), minus(c)],
        _ => [minus(c), s],
    }
}

/// The distance in units in the last place of the exact value.
pub(crate) fn error(found: f64, exact: Double) -> f64 {
    let size = exact.0.abs().max(f64::MIN_POSITIVE);
    let unit = f64::from_bits(size.to_bits() + 1) - size;
    ((found - exact.0) - exact.1).abs() / unit
}

/// log 2 to 159 bits.
const LOG_2_DIGITS: [f64; 3] =
    [std::f64::consts::LN_2, 2.319_046_813_846_299_6e-17, 5.707_708_438_416_212e-34];

/// eˣ = 2ⁿ eʳ, x = n log 2 + r: (eʳ, n).
pub(crate) fn exp(x: f64) -> (Double, i32) {
    let n = (x * std::f64::consts::LOG2_E).round();
    let r = LOG_2_DIGITS.iter().fold(Double(x, 0.0), |r, &part| r.plus(two_product(-n, part)));
    let (mut term, mut sum) = (Double(1.0, 0.0), Double(1.0, 0.0));
    for k in 1..40 {
        term = term.times(r).over(f64::from(k));
        sum = sum.plus(term);
    }
    (sum, n as i32)
}

/// log x for a normal x, from an approximation y that is right to 1e-10: y + log (x e^{−y}), with two terms
/// of the series.
pub(crate) fn log(x: f64) -> Double {
    let y = x.ln();
    let (power, n) = exp(-y);
    let half = 2.0_f64.powi(n / 2);
    let scaled = Double(power.0 * half, power.1 * half).times(Double(x, 0.0));
    let rest = 2.0_f64.powi(n - n / 2);
    let d = Double(scaled.0 * rest, scaled.1 * rest).plus(Double(-1.0, 0.0));
    let square = d.times(d);
    Double(y, 0.0).plus(d).plus(Double(-0.5 * square.0, -0.5 * square.1))
}
