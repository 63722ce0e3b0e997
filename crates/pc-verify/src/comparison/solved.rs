//! The unknowns for which the equations are solved, and the effect of their errors on functions of them.

use crate::comparison::natural::{SHARED, motion, natural_size};
use crate::comparison::tolerance::TOLERANCE;
use crate::derivation::derivation::Derivation;
use crate::derivation::equations::Derived;
use crate::derivation::place::Place;
use crate::derivation::point::Point;
use crate::derivation::quantity::{Free, Quantity};
use crate::error::Irregular;
use crate::numbers::linear::{matrix, solve};
use crate::numbers::rounding::Rounding;
use crate::numbers::sized::Sized;
use crate::text::resultant::Resultants;

/// The unknowns: w, ẇ, λ and the reactions on bodies.
#[derive(Clone)]
pub(crate) struct Solved {
    velocities: Vec<f64>,
    accelerations: Vec<f64>,
    reactions: Vec<f64>,
    resultants: Option<Resultants>,
}

impl Solved {
    pub(crate) fn of(derived: &Derived, resultants: Option<Resultants>) -> Solved {
        Solved {
            velocities: derived.place.w.clone(),
            accelerations: derived.accelerations.clone(),
            reactions: derived.reactions.clone(),
            resultants,
        }
    }
}

impl Derivation {
    /// The point on a motion at which the unknowns have these values.
    pub(crate) fn on_motion<'a>(
        &'a self,
        solved: &Solved,
        derived: &Derived,
        rounding: &'a Rounding,
    ) -> Point<'a, f64> {
        let mut reactions = vec![0.0; self.on_positions.len()];
        self.kept.iter().zip(&solved.reactions).for_each(|(&a, &value)| reactions[a] = value);
        let at = Place { w: solved.velocities.clone(), ..derived.place.clone() };
        let point = self.still(&at, rounding).on_motion(solved.accelerations.clone(), reactions);
        point.with_resultants(solved.resultants.clone())
    }

    /// The sizes of the terms of integrals and outputs that result from the unknowns in them: if each of w, ẇ
    /// and λ agrees to within the tolerance of its own terms, an output may differ accordingly; if λ
    /// vanishes, λ² may differ by the square of that tolerance.
    pub(crate) fn led_to_observed(
        &self,
        derived: &Derived,
        wanted: &[Quantity],
        resultants: Option<&Resultants>,
    ) -> Result<Vec<f64>, Irregular> {
        let mut sizes = vec![0.0f64; wanted.len()];
        if !wanted.iter().any(|wanted| matches!(wanted, Quantity::Observed(_))) {
            return Ok(sizes);
        }
        let exact = Rounding::none();
        let observed = |solved: &Solved| {
            let point = self.on_motion(solved, derived, &exact);
            let value = |wanted: &Quantity| match wanted {
                Quantity::Observed(j) => point.value(&self.text.observed[*j].1),
                _ => Ok(0.0),
            };
            wanted.iter().map(value).collect::<Result<Vec<f64>, Irregular>>()
        };
        let solved = Solved::of(derived, resultants.cloned());
        let values = observed(&solved)?;
        for moved in self.uncertain(&solved, derived)? {
            // At a corner, and past an edge of its domain, a function gives no information on rounding.
            let Ok(moved) = observed(&moved) else { continue };
            for (size, (moved, value)) in sizes.iter_mut().zip(moved.iter().zip(&values)) {
                let led = (moved - value).abs() / TOLERANCE;
                *size = if led.is_finite() { size.max(led) } else { *size };
            }
        }
        Ok(sizes)
    }

    /// Raises the sizes of integrals and outputs to account for the reactions in them, if the reactions are
    /// less certain.
    pub(crate) fn lead_reactions(
        &self,
        quantities: &mut [Sized],
        wanted: &[Quantity],
        derived: &Derived,
    ) -> Result<(), Irregular> {
        let mut derived = derived.clone();
        for (quantity, wanted) in quantities.iter().zip(wanted) {
            let Quantity::Reaction(a) = wanted else { continue };
            if let Some(place) = self.kept.iter().position(|kept| kept == a) {
                derived.reaction_sizes[place] = quantity.size.max(derived.reaction_sizes[place]);
            }
        }
        let resultants = self.needed_resultants(&derived, wanted, &Rounding::none())?;
        let led = self.led_to_observed(&derived, wanted, resultants.as_ref())?;
        quantities.iter_mut().zip(led).for_each(|(quantity, led)| quantity.size = quantity.size.max(led));
        Ok(())
    }

    /// The unknowns with each number moved up and down by its possible error.
    fn uncertain(&self, solved: &Solved, derived: &Derived) -> Result<Vec<Solved>, Irregular> {
        let [drift, _] = self.drift(&derived.place, &derived.velocities, &Rounding::none())?;
        let natural = |quantity: Quantity| SHARED * natural_size(derived, &drift, &quantity);
        let (velocity, acceleration) = (natural(Quantity::Column(0)), natural(Quantity::ColumnRate(0)));
        let mut all = Vec::new();
        for sign in [-TOLERANCE, TOLERANCE] {
            for s in 0..solved.velocities.len() {
                let mut moved = solved.clone();
                moved.velocities[s] += sign * derived.velocity_sizes[s].max(velocity);
                all.push(moved);
                let mut moved = solved.clone();
                moved.accelerations[s] += sign * derived.acceleration_sizes[s].max(acceleration);
                all.push(moved);
            }
            for place in 0..solved.reactions.len() {
                let mut moved = solved.clone();
                moved.reactions[place] += sign * derived.reaction_sizes[place];
                if let Some(resultants) = &mut moved.resultants {
                    resultants.values.iter_mut().for_each(|row| row[place].value += sign * row[place].size);
                }
                all.push(moved);
            }
        }
        Ok(all)
    }

    /// The sizes that the reactions would have without cancellation, in a unit that two eliminations share.
    /// These sizes follow from the given velocities and momenta and, if the quasi-velocities of the text
    /// together with the constraints determine all velocities, also from
    ///
    ///   λ_α = (ṗ − F)·W_α,
    ///
    /// with the virtual velocities W_α at which φ_α alone is 1 and all quasi-velocities are 0. The first
    /// derivation finds λ using these W_α, and if they are large, more cancels than in M ẇ − Cᵀλ = F.
    pub(crate) fn least_reaction_sizes(&self, derived: &Derived) -> Result<Vec<f64>, Irregular> {
        let exact = Rounding::none();
        let (at, k, l) = (&derived.place, derived.place.w.len(), self.kept.len());
        let [drift, _] = self.drift(at, &derived.velocities, &exact)?;
        let natural = SHARED * natural_size(derived, &drift, &Quantity::Reaction(0));
        let mut sizes: Vec<f64> = derived.reactions.iter().map(|lambda| natural.max(lambda.abs())).collect();
        let columns: Vec<Free> =
            (0..self.columns(&self.still(at, &exact))?.len()).map(Free::Column).collect();
        if l == 0 || columns.len() + l != k {
            return Ok(sizes);
        }
        let [rows, rates] = self.adapted(at, &self.kept, &columns, &motion(derived), &exact)?;
        let nothing = vec![0.0; k];
        // If they do not determine each other, there is no first derivation, either.
        let Ok(solution) = solve(&matrix(&rows, k), &nothing, &nothing) else { return Ok(sizes) };
        let w = solution.inverse.abs().columns(0, l).into_owned();
        let turning = solution.inverse.abs() * (matrix(&rates, k).abs() * &w);
        for (a, size) in sizes.iter_mut().enumerate() {
            for s in 0..k {
                let force = derived.momentum_rate_sizes[s].max(derived.force_sizes[s]);
                let terms = (force * w[(s, a)]).max(derived.momentum_sizes[s] * turning[(s, a)]);
                *size = size.max(SHARED * terms);
            }
        }
        Ok(sizes)
    }
}

#[cfg(test)]
mod tests {
    use pc_mech::Graph;
    use pc_model::{Document, Flow, Model, Source, Variables};

    use super::*;
    use crate::comparison::compare::Options;
    use crate::comparison::second::Second;
    use crate::error::VerifyError;
    use crate::tests::verified;

    fn model(text: &str) -> Model {
        Model::new(Document::parse(Source::new("model.toml", text)).unwrap())
    }

    /// x is fixed and no forces act: λ = 0, with terms as large as the velocity of y.
    const HELD: &str = r#"
[parameters]
g = 0.0
[coordinates]
x = 0.0
y = 0.2
[quasi_velocities]
"y'" = 2.0
[constraints]
k = "x'"
[lagrangian]
kinetic = "(x'^2 + y'^2)/2"
potential = "g*x"
[outputs]
once = "3*λ_k"
twice = "λ_k^2"
root = "sqrt(1 + λ_k) - 1"
"#;

    #[test]
    fn outputs_are_as_uncertain_as_the_reactions_in_them() {
        let (graph, model) = (Graph::new(), model(HELD));
        let second = Second::new(&model, &model.assemble(&graph).unwrap()).unwrap();
        let derived = second.derivation().at(second.start(), &Rounding::none()).unwrap();
        let wanted: Vec<Quantity> = (0..3).map(Quantity::Observed).collect();
        let led = second.derivation().led_to_observed(&derived, &wanted, None).unwrap();
        let size = derived.reaction_sizes[0];
        // y'² = 4, times the accuracy of reactions, 1e-3.
        assert!((size - 4.0 * SHARED).abs() < 1e-15, "{size}");
        // The third is evaluated near 1, with rounding of a part in 1e-4 for 1e-12.
        let near = |found: f64, expected: f64, error: f64| (found - expected).abs() <= error;
        assert!(near(led[0], 3.0 * size, 1e-12), "{led:?}");
        assert!(near(led[1], TOLERANCE * size * size, 1e-25), "{led:?}");
        assert!(near(led[2], size / 2.0, 1e-3), "{led:?}");
    }

    /// If a reaction has an error of one part in 1e9 of its terms, outputs that contain it disagree, even its
    /// square.
    #[test]
    fn an_output_of_a_wrong_reaction_is_found() {
        for output in ["3*λ_k", "λ_k^2", "sqrt(1 + λ_k) - 1"] {
            let (physics, _) = HELD.split_once("[outputs]\n").unwrap();
            let text = format!("{physics}[outputs]\nout = \"{output}\"\n");
            let (mut pulled, graph) = (model(&text), Graph::new());
            let free = model(&text);
            let assembly = free.assemble(&graph).unwrap();
            let flow = Flow::new(&free, &assembly, Variables::QuasiVelocities).unwrap();
            let state = flow.start.clone();
            pulled.set("g", 4e-9).unwrap();
            let second = Second::new(&pulled, &assembly).unwrap();
            let found = second.agrees("poincare", &flow, &assembly, 0.0, &state);
            let Err(VerifyError::Disagreement(disagreement)) = found else { panic!("{output}: {found:?}") };
            assert_eq!(disagreement.quantity, "out");
        }
    }

    /// λ vanishes in one derivation; in the other it amounts to some units in the last place of cancelling
    /// terms.
    #[test]
    fn squares_of_reactions_that_vanish_agree() {
        let frames = r#"
[coordinates]
x = 0.95
y = 0.91
"φ" = 0.88
q = 0.82
[quasi_velocities]
w1 = { is = "sqrt(0.66)*φ'", start = 0.3493336513993463 }
w2 = { is = "x'", start = -0.53 }
"ω" = { is = "y*q' + φ'", start = -0.2343 }
[constraints]
k0 = "y'"
[lagrangian]
kinetic = "x' + q' + q'^2 + 0.15*φ'*x'"
[outputs]
out = "λ_k0^2"
"#;
        let brackets = r#"
[coordinates]
x = 0.54
[quasi_velocities]
w1 = 0.0
w2 = -0.077509327700342
"ω" = -0.012577885537135403
[kinematics]
x = "w1"
[algebra]
brackets = { "w1,w2" = "2*w2 + 3*ω", "w1,ω" = "-w2 - 2*ω" }
[constraints]
k0 = "x^2*w1 - 0.08*w2 + tanh(x)*ω"
k1 = "x - 0.54"
[lagrangian]
kinetic = "w2^2 + 0.5*(x*w1 + ω)^2"
potential = "1.14*x"
[outputs]
out = "λ_k0^2"
"#;
        for text in [frames, brackets] {
            assert_eq!(verified(&model(text), &Options::default()).unwrap().states, 100);
        }
    }

    /// ẋ = (2 + x²) (w − e^{x/2} q'): no force acts along q, and λ is what remains of the cancelling terms
    /// (∂ẋ/∂q')˙ p.
    const LEVER: &str = r#"
[parameters]
p = 0.74
[coordinates]
x = 1.02
y = 0.5
"φ" = 1.1
q = 1.03
[quasi_velocities]
w1 = { is = "(1.0/(2.0 + x^2))*x' + exp(x/(2.0))*q'", start = -0.00718840077729515 }
[constraints]
k0 = "(y + 0.76*(1.0/(2.0 + x^2))) + (-0.7499671095908433)"
k1 = "exp(q)*q'"
k2 = "φ'"
[lagrangian]
kinetic = "x'^2 + 0.42*p*y'^2"
[simulation]
t_end = -0.5
"#;

    #[test]
    fn reactions_are_as_uncertain_as_the_contributions_of_the_frame() {
        let agreement = verified(&model(LEVER), &Options::default()).unwrap();
        assert_eq!(agreement.states, 100);
    }

    /// An error of one part in 1e8 in a mass is an error of one part in 1e10 in the reaction to which the
    /// mass contributes.
    #[test]
    fn a_reaction_of_another_mass_is_found() {
        let (mut heavier, graph) = (model(LEVER), Graph::new());
        let mut light = model(LEVER);
        light.observe_reactions(true);
        let assembly = light.assemble(&graph).unwrap();
        let flow = Flow::new(&light, &assembly, Variables::QuasiVelocities).unwrap();
        let state = flow.start.clone();
        heavier.set("p", 0.74 * (1.0 + 1e-8)).unwrap();
        let second = Second::new(&heavier, &assembly).unwrap();
        let found = second.agrees("poincare", &flow, &assembly, 0.0, &state);
        assert!(matches!(found, Err(VerifyError::Disagreement(_))), "{found:?}");
    }
}
