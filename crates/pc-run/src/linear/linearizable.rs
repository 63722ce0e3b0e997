//! Makes the linearizer of a model.

use std::convert::Infallible;

use pc_analysis::{
    AnalysisError, Integrals, Leaf, Linearization, Linearizer, Stability, SteadySearch, Verdict,
};
use pc_mech::{Equations, Expr, Graph, MechError, Neighbourhood};
use pc_model::{Assembly, Model, Variables};
use pc_nonholo::NonholoError;
use pc_print::integrals_of;
use pc_verify::Outlet;

use crate::error::RunError;
use crate::linear::error::LinearError;
use crate::motion::remarks::{say_dropped, say_moved};
use crate::motion::verification::vouched;
use crate::observer::Observer;

/// A model with its equations in independent quasi-velocities, compiled to be linearized.
pub(crate) struct Linearizable<'g> {
    pub(crate) assembly: Assembly<'g>,
    pub(crate) equations: Equations<'g>,
    pub(crate) linearizer: Linearizer,
    /// The start in the variables of these equations.
    pub(crate) start: Vec<f64>,
}

impl<'g> Linearizable<'g> {
    /// # Errors
    /// [`RunError`] at the place in the file that causes the error.
    pub(crate) fn new(model: &Model, graph: &'g Graph) -> Result<Linearizable<'g>, RunError> {
        let assembly = model.assemble(graph)?;
        if assembly.constraints.nonlinear().is_some() {
            return Err(LinearError::Nonlinear.into());
        }
        let equations = assembly.equations()?;
        let mut leaf = Leaf::of(&assembly.system);
        leaf.positions = assembly.held_positions().into_iter().map(|(_, f)| f).collect();
        if leaf.codimension() > 0 {
            leaf.kept = of_coordinates(&equations, &integrals(&assembly, &equations));
        }
        let inputs: Vec<&str> =
            model.document().inputs.iter().map(|input| input.name.text.as_str()).collect();
        let held = assembly
            .constraints
            .held()
            .filter(|held| (0..held.constraints().len()).all(|constraint| held.is_holonomic(constraint)));
        let linearizer = assembly.stage("the linearization", || {
            let linearizer = match held {
                Some(held) => Linearizer::with_multipliers(held, &leaf, &inputs),
                None => Linearizer::new(&equations, &leaf, &inputs),
            };
            linearizer.map_err(|error| placed(&assembly, error, true))
        })?;
        let start = match held {
            Some(_) => assembly.start.clone(),
            None => assembly.start_of(&equations.system().state()),
        };
        Ok(Linearizable { assembly, equations, linearizer, start })
    }

    /// As [`new`](Linearizable::new), but also gives the observer remarks on the equations and, if requested, compares the
    /// equations with a second derivation.
    ///
    /// # Errors
    /// As for [`new`](Linearizable::new), and [`RunError::Verify`].
    pub(crate) fn vouched(
        model: &Model,
        graph: &'g Graph,
        verify: bool,
        observer: &dyn Observer,
    ) -> Result<Linearizable<'g>, RunError> {
        let ground = Linearizable::new(model, graph)?;
        say_dropped(&ground.assembly, observer);
        say_moved(&ground.assembly, observer);
        if verify {
            vouched(model, &ground.assembly, Outlet::Equations(Variables::QuasiVelocities), observer)?;
        }
        Ok(ground)
    }

    /// For each component of the state, its index among the start values of the model; none if other
    /// parameters or starts may lead to other equations, or if the start has to be solved for.
    pub(crate) fn places(&self, model: &Model) -> Option<Vec<usize>> {
        let is_fixed = self.assembly.constraints.redundant().is_empty();
        let follows = model.derives_start() || model.completes_start() || model.projects_start();
        if !is_fixed || follows {
            return None;
        }
        let names = model.start_names();
        let state = self.linearizer.names().iter();
        state.map(|x| names.iter().position(|name| name == x)).collect()
    }

    /// The stability of a steady state, as `pc check` judges it: without cyclic coordinates, and using the second
    /// variation and integrals if the first approximation does not decide. None if the state is not steady.
    pub(crate) fn stability(&self, linear: &Linearization) -> Option<Stability> {
        let verdict = linear.spectrum.verdict();
        if !linear.is_steady || verdict != Verdict::Undecided {
            return linear.is_steady.then_some(Stability::ByFirstApproximation(verdict));
        }
        let (equations, positions) = (&self.equations, self.assembly.held_positions());
        let value =
            |name: String| linear.state.iter().find(|(known, _)| *known == name).map(|&(_, value)| value);
        let state: Option<Vec<f64>> =
            equations.system().state().iter().map(|y| value(y.to_string())).collect();
        let undecided = Stability::Undecided { second_variation: false };
        let (Some(state), Ok(mut motion)) = (state, equations.compile()) else { return Some(undecided) };
        let at = (linear.t, state.as_slice());
        match SteadySearch::near(equations, &mut motion, at, self.integrals().list(), &positions) {
            SteadySearch::Found(found) => Some(found.stability()),
            _ => Some(undecided),
        }
    }

    /// The integrals that are given or were found.
    pub(crate) fn integrals(&self) -> Integrals<'g> {
        integrals(&self.assembly, &self.equations)
    }
}

fn integrals<'g>(assembly: &Assembly<'g>, equations: &Equations<'g>) -> Integrals<'g> {
    let centre = assembly.system.parameters().iter().copied().chain(assembly.at_start()).collect();
    integrals_of(assembly, equations, &Neighbourhood { centre }, true)
}

/// The integrals that are functions of the coordinates alone.
fn of_coordinates<'g>(equations: &Equations<'g>, integrals: &Integrals<'g>) -> Vec<Expr<'g>> {
    let system = equations.system();
    let others: Vec<Expr<'g>> = system
        .quasi_velocities()
        .iter()
        .copied()
        .chain(system.states().iter().map(|&(z, _)| z))
        .chain([system.frame().time()])
        .collect();
    let conserved =
        integrals.list().iter().filter(|integral| integral.is_conserved() && !integral.is_energy());
    conserved.map(|integral| integral.value).filter(|f| !others.iter().any(|&y| f.depends_on(y))).collect()
}

/// An error of the analysis, located at the place in the file that causes it, if there is one.
pub(crate) fn placed(assembly: &Assembly<'_>, error: AnalysisError, of_linearization: bool) -> RunError {
    match error {
        AnalysisError::Nonholo(error) => at(assembly, error),
        AnalysisError::Mech(error) => at(assembly, error),
        AnalysisError::Expr(error) => at(assembly, MechError::from(error)),
        other => LinearError::of(other, of_linearization).into(),
    }
}

fn at(assembly: &Assembly<'_>, error: impl Into<NonholoError>) -> RunError {
    match assembly.placed::<Infallible>(Err(error)) {
        Err(error) => error.into(),
        Ok(never) => match never {},
    }
}
