//! The properties of a model before it is run.

use pc_analysis::{FrameFacts, Integrals, Linearization};
use pc_mech::{Equations, Expr, Identity, MechError, Neighbourhood, System, VectorField};
use pc_model::{Assembly, ClassifiedConstraint, Model, ModelError};
use pc_nonholo::{ConstraintKind, IntegrableCombination, Redundant};
use pc_print::{
    Extent, Operations, assignments, columns, integrals_of, kind_in_words, labelled, one_line, short, small,
    wrapped,
};
use pc_verify::{Agreement, VerifyError};
use serde_json::{Value, json};

use crate::check::measure::Measure;
use crate::check::steady::SteadyFinding;
use crate::check::{agreement, combinations, frame, integrals, steady};
use crate::remarks::{NEGATIVE_ENERGY, changing_masses, dropped};

/// The number of operations of one right-hand side beyond which equations are too long for the analyses of a brief check: these
/// take a second for so many.
pub(crate) const LONG: usize = 600;

/// The properties of a model before it is run.
#[derive(Clone, Debug)]
pub struct Check<'g> {
    title: String,
    coordinates: Vec<String>,
    quasi_velocities: Vec<String>,
    /// First-order states.
    states: Vec<String>,
    pub(super) rank: usize,
    given_algebra: bool,
    pub(super) closure_residual: f64,
    pub(super) jacobi_residual: f64,
    pub(super) algebra: String,
    pub(super) mass_rank: usize,
    negative_energy: bool,
    /// Remarks on masses that change in time.
    changing_masses: Option<String>,
    /// The number of rows of the mass matrix.
    free: usize,
    t_start: f64,
    start: Vec<f64>,
    largest_rate: f64,
    /// The names of the functions without a value.
    undetermined: Vec<String>,
    pub(super) frame: FrameFacts<'g>,
    /// The constraints, each with its kind.
    constraints: Vec<(String, String)>,
    pub(super) classified: Vec<ClassifiedConstraint>,
    redundant: Vec<Redundant>,
    /// The number of integrable combinations of constraints.
    integrable_combinations: usize,
    /// The integrable combinations that were found.
    combinations: Vec<IntegrableCombination<'g>>,
    start_residual: f64,
    pub(super) integrals: Integrals<'g>,
    /// None if the equations are too long to look for it.
    measure: Option<Measure<'g>>,
    pub(super) steady: SteadyFinding,
    operations: Operations,
    pub(super) second: Option<Result<Agreement, VerifyError>>,
}

impl<'g> Check<'g> {
    /// The properties of an assembled model, whose equations in independent quasi-velocities are given.
    ///
    /// # Errors
    /// [`ModelError`] if some part cannot be derived.
    pub fn new(
        model: &Model,
        assembly: &Assembly<'g>,
        equations: &Equations<'g>,
    ) -> Result<Check<'g>, ModelError> {
        Check::within(model, assembly, equations, |_| Extent::Full)
    }

    /// The properties of an assembled model; those of [long](LONG) equations without integrals, invariant measure and steady motion.
    ///
    /// # Errors
    /// As for [`new`](Check::new).
    pub(crate) fn brief(
        model: &Model,
        assembly: &Assembly<'g>,
        equations: &Equations<'g>,
    ) -> Result<Check<'g>, ModelError> {
        Check::within(model, assembly, equations, |operations| Extent::Brief { operations })
    }

    fn within(
        model: &Model,
        assembly: &Assembly<'g>,
        equations: &Equations<'g>,
        extent: impl FnOnce(usize) -> Extent,
    ) -> Result<Check<'g>, ModelError> {
        let system = &assembly.system;
        let (frame, structure, graph) = (system.frame(), system.structure(), system.graph());
        let operations = assembly.placed(Operations::of(equations).map_err(MechError::from))?;
        let is_short = extent(operations.free.total()).allows(LONG);
        let names = |symbols: &[Expr<'_>]| symbols.iter().map(Expr::to_string).collect::<Vec<_>>();

        let (mut motion, start) = model.compile(assembly)?;
        let mut rate = vec![0.0; start.len()];
        // `compile` has evaluated the same
        let evaluated = motion.rhs(assembly.t_start, &start, &mut rate).is_ok();
        let largest_rate = rate.iter().fold(0.0f64, |largest, r| largest.max(r.abs()));

        let state = system.state().into_iter();
        let mut centre = system.parameters().to_vec();
        centre.push((frame.time(), assembly.t_start));
        centre.extend(state.zip(assembly.start.iter().copied()));
        let near = Neighbourhood { centre };

        let integrals = match is_short {
            true => integrals_of(assembly, equations, &near, true),
            false => Integrals::default(),
        };
        Ok(Check {
            title: model.title().to_owned(),
            coordinates: names(frame.coordinates()),
            quasi_velocities: names(system.quasi_velocities()),
            states: system.states().iter().map(|(z, _)| z.to_string()).collect(),
            rank: frame.rank(),
            given_algebra: model.document().algebra.is_some(),
            closure_residual: frame.closure_residual(structure, &near),
            jacobi_residual: frame.jacobi_residual(structure, &near),
            algebra: algebra(system),
            mass_rank: graph.generic_rank_of_entries(
                equations.mass_matrix().columns(),
                &equations.mass_matrix().nonzero_rows(),
            ),
            negative_energy: assembly.has_negative_energy(),
            changing_masses: changing_masses(assembly),
            free: equations.mass_matrix().rows(),
            t_start: assembly.t_start,
            start: assembly.start.clone(),
            largest_rate: if evaluated { largest_rate } else { f64::NAN },
            undetermined: assembly.undetermined_functions(),
            frame: FrameFacts::of(system, &near),
            constraints: constraints(assembly),
            classified: assembly.constraints.classified().to_vec(),
            redundant: assembly.dropped_constraints().cloned().collect(),
            integrable_combinations: assembly.constraints.integrable_combinations(),
            combinations: assembly.placed(assembly.constraints.combinations_found(&assembly.at_start()))?,
            start_residual: start_residual(assembly, &near),
            measure: is_short.then(|| Measure::of(assembly, &near.centre)),
            steady: match is_short {
                true => steady::near_start(assembly, equations, &integrals),
                false => SteadyFinding::TooLong,
            },
            integrals,
            operations,
            second: None,
        })
    }

    /// The properties, together with the result of the comparison with a second derivation.
    pub fn compared(self, second: Result<Agreement, VerifyError>) -> Check<'g> {
        Check { second: Some(second), ..self }
    }

    /// The number of operations of one right-hand side, with parameters as inputs.
    pub(crate) fn operations(&self) -> usize {
        self.operations.free.total()
    }

    /// The linear theory of the steady motion near the start, if one was found.
    pub fn steady_motion(&self) -> Option<&Linearization> {
        steady::linearization(&self.steady)
    }

    /// For people.
    pub fn text(&self) -> String {
        const LABEL: usize = 19;
        let lines = |(label, lines): (&'static str, Vec<String>)| labelled(label, LABEL, &lines);
        let text = self.entries().into_iter().map(lines).collect::<String>();
        format!("{}\n{text}", one_line(&self.title))
    }

    /// The results as lines of text, each result with a label.
    pub fn entries(&self) -> Vec<(&'static str, Vec<String>)> {
        const WIDTH: usize = 78;
        let k = self.quasi_velocities.len();
        let counted_names = |symbol: &str, names: &[String]| {
            let mut lines = wrapped(names.iter().cloned(), WIDTH - 8);
            lines.insert(0, format!("{symbol} = {}", names.len()));
            if lines.len() == 2 { vec![lines.join("   ")] } else { lines }
        };
        let brackets = match (self.given_algebra, self.rank == k) {
            (true, _) => "brackets given",
            (false, true) => "brackets from the frame",
            (false, false) => "constant brackets found",
        };
        let names = self.coordinates.iter().chain(&self.quasi_velocities).chain(&self.states);
        let names = names.map(String::as_str);
        let start = assignments(names.zip(self.start.iter().copied()), WIDTH);
        let rank =
            [format!("{} of {k}, {brackets}", self.rank)].into_iter().chain(frame::constraints(&self.frame));
        let of_states = if self.states.is_empty() { Vec::new() } else { counted_names("l", &self.states) };
        let mut entries: Vec<(&str, Vec<String>)> = vec![
            ("functions", self.function_lines()),
            ("coordinates", counted_names("n", &self.coordinates)),
            ("quasi-velocities", counted_names("k", &self.quasi_velocities)),
            ("states", of_states),
            ("rank of the frame", rank.collect()),
            ("holonomic", frame::holonomic(&self.frame, WIDTH)),
            ("closure", vec![held(self.closure_residual)]),
            ("Jacobi identity", vec![held(self.jacobi_residual)]),
            ("algebra", vec![self.algebra.clone()]),
            ("constraints", self.constraint_lines()),
            ("mass matrix", self.mass_matrix_lines()),
            ("start", start),
            ("rates there", self.rate_lines()),
            ("operations", self.operations.lines()),
        ];
        if let Some(second) = &self.second {
            entries.push(("second derivation", agreement::lines(second, WIDTH)));
        }
        let width = self.integrals.list().iter().map(|integral| columns(&integral.name)).max().unwrap_or(0);
        let mut kept = Vec::new();
        for integral in self.integrals.list() {
            let lines = (0..).zip(integrals::lines(integral));
            kept.extend(
                lines.map(|(i, line)| format!("{:width$}  {line}", if i == 0 { &integral.name } else { "" })),
            );
        }
        entries.push(("integrals", kept));
        match &self.measure {
            Some(measure) => {
                entries.push(("invariant measure", measure.lines()));
                entries.push(("steady motion", steady::lines(&self.steady, WIDTH)));
            }
            None => entries.push((
                "not looked for",
                vec!["integrals, invariant measure and steady motion, since the equations are long; pc check finds them".to_owned()],
            )),
        }
        entries.retain(|(_, lines)| !lines.is_empty());
        entries
    }

    /// The functions without a value, with what the results say of them.
    fn function_lines(&self) -> Vec<String> {
        match self.undetermined.as_slice() {
            [] => Vec::new(),
            names => vec![format!("{}: any smooth function, compared for a generic one", names.join(", "))],
        }
    }

    /// The rates at the start, which have values if all functions do.
    fn rate_lines(&self) -> Vec<String> {
        match self.undetermined.first() {
            Some(name) => vec![format!("no numbers: `{name}` has no value")],
            None => vec![format!(
                "finite at t = {}, the largest {}",
                short(self.t_start, 6),
                short(self.largest_rate, 4)
            )],
        }
    }

    fn mass_matrix_lines(&self) -> Vec<String> {
        let rank = format!("symmetric, rank {} of {}", self.mass_rank, self.free);
        let negative = self.negative_energy.then(|| NEGATIVE_ENERGY.to_owned());
        [rank].into_iter().chain(negative).chain(self.changing_masses.clone()).collect()
    }

    fn constraint_lines(&self) -> Vec<String> {
        match self.constraints.as_slice() {
            [] => vec!["none".to_owned()],
            all => {
                let combinations = combinations::lines(&self.combinations, self.integrable_combinations);
                all.iter().map(|(name, what)| format!("{name}: {what}")).chain(combinations).collect()
            }
        }
    }

    /// For programs.
    pub fn json(&self) -> Value {
        let integrals: Vec<Value> = self.integrals.list().iter().map(integrals::object).collect();
        let (frame_constraints, holonomic) = frame::objects(&self.frame);
        json!({
            "model": self.title,
            "coordinates": self.coordinates.len(),
            "quasi_velocities": self.quasi_velocities.len(),
            "states": self.states,
            "rank": self.rank,
            "frame_constraints": frame_constraints,
            "holonomic": holonomic,
            "closure_residual": self.closure_residual,
            "constraints": self.classified.iter().map(constraint).collect::<Vec<_>>(),
            "dropped_constraints": self.redundant.iter().map(dropped_object).collect::<Vec<_>>(),
            "integrable_combinations": self.integrable_combinations,
            "combinations_found": self.combinations.iter().map(combinations::object).collect::<Vec<_>>(),
            "jacobi_residual": self.jacobi_residual,
            "algebra": self.algebra,
            "mass_matrix_rank": self.mass_rank,
            "negative_energy": self.negative_energy,
            "changing_masses": self.changing_masses,
            "start_residual": self.start_residual,
            "integrals": integrals,
            "invariant_measure": self.measure.as_ref().map(Measure::object),
            "steady_motion": steady::object(&self.steady),
            "second_derivation": self.second.as_ref().map(agreement::object),
        })
    }
}

/// The algebra of the operators in words; if the algebra depends on the parameters, it is given for their
/// present values.
fn algebra(system: &System<'_>) -> String {
    let (always, bound) = (system.structure(), system.with_parameters_bound());
    match bound.structure().are_constant() && !always.are_constant() {
        true => frame::algebra(bound.structure(), "constant for these parameters"),
        false => frame::algebra(always, "constant structure coefficients"),
    }
}

/// Says in words whether an identity holds, given its numerical residual relative to its terms.
pub(super) fn held(residual: f64) -> String {
    match Identity::of(residual) {
        Identity::Proved => "holds identically".to_owned(),
        Identity::Open { rest } if rest.is_finite() => format!("open: holds to {}", small(rest)),
        Identity::Open { .. } => "open: has no values near the start".to_owned(),
        Identity::Disproved { rest } => format!("disproved: {} of the terms is left", small(rest)),
    }
}

/// The constraints, each with its kind; those that were dropped come last.
fn constraints(assembly: &Assembly<'_>) -> Vec<(String, String)> {
    let classified = assembly.constraints.classified().iter();
    let binding =
        classified.map(|verdict| (verdict.constraint.clone(), kind_in_words(verdict.kind).to_owned()));
    let redundant = dropped(assembly).into_iter().map(|(name, reason)| (name, format!("{reason}; dropped")));
    binding.chain(redundant).collect()
}

fn constraint(verdict: &ClassifiedConstraint) -> Value {
    let residual = match verdict.kind {
        ConstraintKind::Nonholonomic { residual } => Some(residual),
        ConstraintKind::Position | ConstraintKind::Integrable => Some(0.0),
        ConstraintKind::Nonlinear => None, // not tested
    };
    json!({ "name": verdict.constraint, "kind": kind_in_words(verdict.kind), "residual": residual })
}

fn dropped_object(redundant: &Redundant) -> Value {
    json!({ "name": redundant.constraint, "follows_from": redundant.follows_from })
}

/// The largest value that the functions which should vanish have at the start.
fn start_residual(assembly: &Assembly<'_>, near: &Neighbourhood<'_>) -> f64 {
    let Some(multipliers) = assembly.constraints.multipliers() else { return 0.0 };
    let graph = assembly.system.graph();
    let value = |x: Expr<'_>| graph.evaluate(&[x], &near.centre).map_or(f64::NAN, |values| values[0]);
    let constraints = multipliers.constraints().iter();
    let both = constraints.flat_map(|c| [c.expression(), c.velocity(&assembly.system)]);
    both.map(|x| value(x).abs()).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_condition_that_fails_is_not_reported_as_holding() {
        assert_eq!(held(0.0), "holds identically");
        assert_eq!(held(2.5e-16), "open: holds to 2.5e-16");
        assert_eq!(held(2e-9), "open: holds to 2.0e-9");
        assert_eq!(held(2e-3), "disproved: 2.0e-3 of the terms is left");
        assert!(
            held(f64::NAN).starts_with("open: has no") && held(f64::INFINITY).starts_with("open: has no")
        );
    }
}
