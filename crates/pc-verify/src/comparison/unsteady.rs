//! Differences that jump between nearby states: they come from rounding errors or from a jump of the rates, not from an
//! error of derivation.

use crate::comparison::compare::error;
use crate::comparison::first::First;
use crate::comparison::tolerance::TOLERANCE;
use crate::derivation::derivation::Derivation;
use crate::derivation::here::Here;
use crate::error::Irregular;
use crate::numbers::rounding::{Random, Rounding, within};
use crate::numbers::sized::Sized;

/// The distance of other states from the state in question: large enough that small terms absorbed by a large
/// number are rounded differently, which single rounding errors do not achieve, and so small that a
/// difference due to a wrong term stays the same to as many digits.
const ASIDE: f64 = 1e-9;

/// The number of other states that are tried.
const STATES: u64 = 4;

/// A difference of at most this many jumps is attributed to rounding errors.
const JUMPS: f64 = 4.0;

/// The result of comparing two derivations near a state at which they differ.
pub(crate) struct Aside {
    /// The sizes of terms whose rounding errors would explain the jumps of the differences.
    pub(crate) noise: Vec<f64>,
    /// The largest relative differences at the nearby states; none if the derivations disagree at one of
    /// these states, or if too few states could be compared.
    pub(crate) errors: Option<Vec<f64>>,
}

impl Derivation {
    /// Compares two derivations near a state at which they differ. If rates jump, the last bit of the state decides on
    /// which side of the jump the state lies, and the derivations may be on different sides; at nearby states the
    /// derivations agree.
    pub(crate) fn aside(
        &self,
        first: &mut First<'_>,
        here: &Here,
        values: &[f64],
        seconds: &[Sized],
    ) -> Aside {
        let (wanted, exact, free) = (first.quantities(), Rounding::none(), first.free.clone());
        let mut largest = vec![0.0f64; values.len()];
        let (mut errors, mut agree, mut compared) = (vec![0.0f64; values.len()], true, 0);
        for seed in 0..STATES {
            let mut both = || -> Result<_, Irregular> {
                let place = self.random_within(&here.derived.place, ASIDE, &mut Random::new(seed))?;
                let near = Here::new(self, self.at(&place, &exact)?)?;
                let seconds = self.quantities(&near.derived, &wanted, free.as_deref(), &exact)?;
                let values = first.values(self, &near, &exact)?;
                Ok(values.into_iter().zip(seconds).collect::<Vec<_>>())
            };
            // Nearby states without values are left out.
            let Ok(near) = both() else { continue };
            compared += 1;
            for (i, (one, two)) in near.into_iter().enumerate() {
                let error = error(one, two);
                agree &= within(error, TOLERANCE);
                errors[i] = errors[i].max(error);
                let jump = (one - two.value - (values[i] - seconds[i].value)).abs();
                if jump.is_finite() {
                    largest[i] = largest[i].max(jump);
                }
            }
        }
        let noise = largest.into_iter().map(|jump| JUMPS * jump / TOLERANCE).collect();
        Aside { noise, errors: (agree && compared > STATES / 2).then_some(errors) }
    }
}

#[cfg(test)]
mod tests {
    use pc_mech::Graph;
    use pc_model::{Document, Flow, Model, Source, Variables};

    use super::*;
    use crate::comparison::compare::Options;
    use crate::comparison::second::Second;
    use crate::tests::verified;

    fn model(text: &str) -> Model {
        Model::new(Document::parse(Source::new("model.toml", text)).unwrap())
    }

    /// A mass with an error of one part in 1e10 makes a difference that does not jump.
    #[test]
    fn errors_of_derivation_are_steady() {
        let text = "[coordinates]\nx = 1.0\ny = 0.3\n[parameters]\nm = 2.0\n[lagrangian]\n\
                    kinetic = \"m*x'^2/2 + cos(x)*x'*y' + y'^2\"\npotential = \"1/x + x*y\"";
        let (mut heavier, graph) = (model(text), Graph::new());
        let light = model(text);
        let assembly = light.assemble(&graph).unwrap();
        let flow = Flow::new(&light, &assembly, Variables::QuasiVelocities).unwrap();
        heavier.set("m", 2.0 * (1.0 + 1e-10)).unwrap();
        let second = Second::new(&heavier, &assembly).unwrap();
        let (derivation, exact) = (second.derivation(), Rounding::none());
        let mut first = First::flow("poincare", flow, &second, &assembly, &mut second.nothing_yet());
        let here = Here::new(derivation, derivation.at(second.start(), &exact).unwrap()).unwrap();
        let seconds = derivation.quantities(&here.derived, &first.quantities(), None, &exact).unwrap();
        let values = first.values(derivation, &here, &exact).unwrap();
        let unsteady = derivation.aside(&mut first, &here, &values, &seconds).noise;
        let rate = first.wanted.iter().position(|(label, _)| label == "the rate of x'").unwrap();
        let difference = (values[rate] - seconds[rate].value).abs();
        assert!(difference > 1e-12, "{difference:e}");
        assert!(TOLERANCE * unsteady[rate] < 1e-3 * difference, "{difference:e} of {:e}", unsteady[rate]);
    }

    /// As x tends to 0, the constraint determines w less and less accurately: the printed expression for the
    /// other velocity has terms in 1/x⁴ that cancel and absorb the remainder. Some states give no information
    /// about w, while others do.
    #[test]
    fn absorbed_terms_are_ignored() {
        let agreement = verified(
            &model(
                r#"
[coordinates]
x = 0.94
y = 0.9
"φ" = 0.88
[quasi_velocities]
"ω" = -0.30129374675524623
w1 = 1.1293421813528932
w2 = 0.0
[kinematics]
x = "w1"
y = "cos(φ/(4.0))*w2"
"φ" = "sqrt(1.22*φ)*ω + 0.44*cos(2.0*t)"
[constraints]
k0 = "y + (-0.9)"
k1 = "(-0.05)*cos(φ)*ω + (-0.19)*x^2*w1 + 0.18"
[lagrangian]
kinetic = "0.51*ω^2 + 0.2*w1 + 1.04*exp((-1.0))*w1 + 0.26*tanh(x)*ω"
"#,
            ),
            &Options { states: 6, ..Options::default() },
        );
        let agreement = agreement.unwrap();
        assert_eq!(agreement.states, 6);
        let partly = agreement.not_compared.iter().any(|line| line.contains("amplified too much"));
        assert!(partly, "{:?}", agreement.not_compared);
    }
}
