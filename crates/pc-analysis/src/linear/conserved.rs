//! What motions conserve near a steady state, and the stability that follows from it.

use pc_mech::{Equations, Expr, Graph, Multipliers};

use crate::error::AnalysisError;
use crate::integrals::integral::Integral;

use crate::linear::family::Family;
use crate::linear::linearization::Linearization;
use crate::linear::linearizer::{Leaf, Linearizer};
use crate::stability::second_variation::SecondVariation;
use crate::stability::spectrum::Verdict;
use crate::stability::steady_search::Stability;

/// The functions of the state that motions keep: the energy, if it is conserved, other integrals, and the relations among
/// the coordinates and among the velocities that constraints impose.
#[derive(Clone, Debug)]
pub struct Conserved<'g> {
    graph: &'g Graph,
    state: Vec<Expr<'g>>,
    parameters: Vec<(Expr<'g>, f64)>,
    energy: Option<Expr<'g>>,
    functions: Vec<(String, Expr<'g>)>,
}

impl<'g> Conserved<'g> {
    /// The functions that the motions of `equations` in independent quasi-velocities keep on a leaf: those of the
    /// `integrals` that are conserved, and the relations of the leaf. With `multipliers`, the state is that of their
    /// equations, and the conditions on velocities are relations too.
    pub fn of(
        equations: &Equations<'g>,
        multipliers: Option<&Multipliers<'g>>,
        leaf: &Leaf<'g>,
        integrals: &[Integral<'g>],
    ) -> Conserved<'g> {
        let whole = multipliers.map_or(equations, Multipliers::equations).system();
        let time = whole.frame().time();
        let kept = integrals.iter().filter(|integral| integral.is_conserved());
        let (energies, others): (Vec<_>, Vec<_>) = kept.partition(|integral| integral.is_energy());
        let conditions = multipliers.map_or(&[][..], Multipliers::velocities);
        let relations = [&leaf.positions[..], &leaf.kept, conditions].concat();
        let named = others.into_iter().map(|integral| (integral.name.clone(), integral.value));
        let functions = named.chain(relations.into_iter().map(|f| (String::new(), f)));
        // Under conditions that are homogeneous in the velocities, the energy is that of all velocities, which is regular
        // where the independent ones are not.
        let at_rest: Vec<_> = whole.quasi_velocities().iter().map(|&eta| (eta, Expr::ZERO)).collect();
        let homogeneous = whole.graph().substitute(conditions, &at_rest).iter().all(|g| g.is_zero());
        let energy = energies.first().map(|integral| match multipliers {
            Some(multipliers) if homogeneous => multipliers.equations().energy(),
            _ => integral.value,
        });
        Conserved {
            graph: whole.graph(),
            state: whole.state(),
            parameters: whole.parameters().to_vec(),
            energy: energy.filter(|energy| !energy.depends_on(time)),
            functions: functions.filter(|(_, f)| !f.depends_on(time)).collect(),
        }
    }

    /// The second variation of a conserved function at the state of a linearization, under all others of these that are
    /// defined there; none if it is not smooth there.
    fn second_variation(
        &self,
        linear: &Linearization,
        (of, others): (Expr<'g>, &[(String, Expr<'g>)]),
    ) -> Option<SecondVariation> {
        // What contains a coordinate that is left out is not a function of the others, and changes with it.
        let left_out = |y: &&Expr<'g>| linear.cyclic.iter().any(|(name, _)| *name == y.to_string());
        let left_out: Vec<Expr<'g>> = self.state.iter().filter(left_out).copied().collect();
        let is_own = |f: Expr<'g>| !left_out.iter().any(|&x| f.depends_on(x));
        if !is_own(of) {
            return None;
        }
        let state = self.state.iter().copied().zip(linear.state.iter().map(|&(_, y)| y));
        let values: Vec<(Expr<'g>, f64)> = state.chain(self.parameters.iter().copied()).collect();
        let is_smooth = |f: Expr<'g>| {
            let slopes = self.graph.gradient(f, &self.state);
            self.graph
                .evaluate(&slopes, &values)
                .is_ok_and(|slopes| slopes.iter().all(|slope| slope.is_finite()))
        };
        let functions: Vec<_> = others.iter().filter(|&&(_, f)| is_own(f) && is_smooth(f)).cloned().collect();
        let (of, at) = ((self.graph, of, functions.as_slice()), (self.state.as_slice(), values.as_slice()));
        SecondVariation::among(of, at, Some(&linear.extension)).ok()
    }

    /// Where the energy is not conserved, the first integral with a definite second variation under the others, such as
    /// Jacobi's in a turning frame, with the variables in which it shows stability.
    fn definite_integral(&self, linear: &Linearization) -> Option<(String, Option<Vec<String>>)> {
        let named = || self.functions.iter().enumerate().filter(|(_, (name, _))| !name.is_empty());
        let decides = |(place, (name, of)): (usize, &(String, Expr<'g>))| {
            let mut others = self.functions.clone();
            others.remove(place);
            let second = self.second_variation(linear, (*of, &others))?;
            Some((name.clone(), stable_in(&second, linear)?))
        };
        if self.energy.is_some() { None } else { named().find_map(decides) }
    }

    /// The stability of the steady state of a linearization without cyclic coordinates: by the eigenvalues (A. M.
    /// Lyapunov's first method); by the energy, or another integral where it is not conserved, if it has a strict minimum
    /// among the states with the same values of all other functions (E. J. Routh); or, if all neighbours in the directions of
    /// zero eigenvalues are steady, by the other eigenvalues (I. G. Malkin). `family` returns the dimension of the family of
    /// steady states.
    ///
    /// # Errors
    /// [`AnalysisError`]
    fn stability(
        &self,
        linear: &Linearization,
        family: impl FnOnce() -> Result<usize, AnalysisError>,
    ) -> Result<Stability, AnalysisError> {
        let spectrum = &linear.spectrum;
        let verdict = spectrum.verdict();
        if verdict != Verdict::Undecided {
            return Ok(Stability::ByFirstApproximation(verdict));
        }
        let second = self.energy.and_then(|energy| self.second_variation(linear, (energy, &self.functions)));
        if let Some(variables) = second.as_ref().and_then(|second| stable_in(second, linear)) {
            return Ok(Stability::BySecondVariation { variables });
        }
        if let Some((name, variables)) = self.definite_integral(linear) {
            return Ok(Stability::ByIntegral { name, variables });
        }
        let zeros: usize = spectrum.zero_blocks().iter().sum();
        let damped = spectrum.eigenvalues().iter().filter(|value| value.real < 0.0).count();
        let is_critical = spectrum.zero_blocks().len() == 1 && damped + zeros == spectrum.eigenvalues().len();
        if is_critical && family()? == zeros {
            return Ok(Stability::AsymptoticBut { directions: zeros });
        }
        Ok(Stability::Undecided { second_variation: second.is_some() })
    }
}

/// The variables in which a state is stable by a second variation, unless they are all components; none if it does not decide.
fn stable_in(second: &SecondVariation, linear: &Linearization) -> Option<Option<Vec<String>>> {
    let is_seen = |name: &&String| second.variables.contains(*name);
    let seen: Vec<String> = linear.components.iter().filter(is_seen).cloned().collect();
    let is_all = seen.len() == linear.components.len();
    (second.verdict == Verdict::Stable && !seen.is_empty()).then_some((!is_all).then_some(seen))
}

impl Linearizer {
    /// The stability of the steady state of a linearization, judged without cyclic coordinates.
    ///
    /// # Errors
    /// [`AnalysisError`] if the equations are not smooth at the state.
    pub fn stability(
        &mut self,
        steady: &Linearization,
        conserved: &Conserved<'_>,
    ) -> Result<Stability, AnalysisError> {
        let (t, cyclic) = (steady.t, self.cyclic.clone());
        let state: Vec<f64> = steady.state.iter().map(|&(_, value)| value).collect();
        let linear = self.put_together(t, &state, &cyclic, Some(steady.uncertainty))?;
        conserved.stability(&linear, || Ok(self.family(t, &state, Family::Steady)?.family))
    }
}
