//! What takes the place of the parameters where integrals for their present values are sought.

use pc_mech::{Expr, Number, System};

/// A rational p/q is short if |p| q is at most this: coefficients of the second degree in such numbers are read back from
/// their residues.
const SHORT: u64 = 1 << 24;
/// Numerators and denominators of the ratios of parameters that are recognised.
const LARGEST_IN_RATIO: i32 = 12;

/// The parameters of the system that are replaced, each with its short rational value, or with a multiple of an earlier
/// parameter of which it is a simple multiple.
///
/// A parameter such as √2 or π/3 stays a symbol: its value is no short rational, and integrals whose coefficients are
/// functions of the symbol hold for every value.
pub(crate) fn present_values<'g>(system: &System<'g>) -> Vec<(Expr<'g>, Expr<'g>)> {
    let mut indeterminate: Vec<(Expr<'g>, f64)> = Vec::new();
    let mut replaced = Vec::new();
    for (parameter, value) in system.numbers() {
        let Some(number) = value.constant() else { continue };
        if is_short(number) {
            replaced.push((parameter, value));
            continue;
        }
        let size = number.to_f64();
        let multiple =
            indeterminate.iter().find_map(|&(other, of)| Some(other * Expr::from(simple(size / of)?)));
        match multiple {
            Some(multiple) => replaced.push((parameter, multiple)),
            None => indeterminate.push((parameter, size)),
        }
    }
    replaced
}

/// Whether the number is a short rational.
pub(crate) fn is_short(number: Number) -> bool {
    match number {
        Number::Rational { num, den } => num.unsigned_abs().saturating_mul(den.unsigned_abs()) <= SHORT,
        Number::Scaled { .. } | Number::Real(_) => false,
    }
}

/// The simple rational that this is, to within the rounding of a quotient of two rounded numbers.
fn simple(ratio: f64) -> Option<Number> {
    let denominators = 1..=LARGEST_IN_RATIO;
    denominators.map(|den| (ratio * f64::from(den), den)).find_map(|(num, den)| {
        let whole = num.round();
        let is_close = (num - whole).abs() <= 4.0 * f64::EPSILON * whole.abs();
        let is_small = whole != 0.0 && whole.abs() <= f64::from(LARGEST_IN_RATIO);
        (is_close && is_small).then(|| Number::ratio(whole as i64, i64::from(den)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn simple_ratios_are_seen() {
        assert_eq!(simple(0.3 / 0.2), Some(Number::ratio(3, 2)));
        assert_eq!(simple(-2f64.sqrt() / 8f64.sqrt()), Some(Number::ratio(-1, 2)));
        assert_eq!(simple(2f64.sqrt()), None);
        assert_eq!(simple(1.0 + 1e-12), None);
    }
}
