//! Makes the linearizer of a model.

use std::convert::Infallible;

use pc_analysis::{AnalysisError, Conserved, Integrals, Linearization, Stability};
use pc_mech::{Equations, Graph, MechError, Neighbourhood};
use pc_model::document::{Input, InputValue};
use pc_model::{Assembly, Model, Variables};
use pc_nonholo::NonholoError;
use pc_print::{LinearModel, integrals_of};
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
    pub(crate) linear: LinearModel<'g>,
}

/// The names of the inputs; of the rates of tables, those on which the equations or what is observed depend.
fn inputs_of<'m>(model: &'m Model, equations: &Equations<'_>) -> Vec<&'m str> {
    let (system, graph) = (equations.system(), equations.system().graph());
    let observed = system.integrals().iter().chain(system.outputs()).map(|(_, value)| *value);
    let values: Vec<_> = equations.inverse_dynamics().into_iter().chain(observed).collect();
    let counts = |input: &&Input| {
        let symbol = || graph.symbol(&input.name.text);
        !matches!(input.value, InputValue::RateOf(_)) || values.iter().any(|value| value.depends_on(symbol()))
    };
    model.document().inputs.iter().filter(counts).map(|input| input.name.text.as_str()).collect()
}

impl<'g> Linearizable<'g> {
    /// # Errors
    /// [`RunError`] at the place in the file that causes the error.
    pub(crate) fn new(model: &Model, graph: &'g Graph) -> Result<Linearizable<'g>, RunError> {
        model.require_values()?;
        let assembly = model.assemble(graph)?;
        let equations = assembly.equations()?;
        let inputs = inputs_of(model, &equations);
        let linear = assembly.stage("the linearization", || {
            let linear = LinearModel::of(&assembly, &equations, || integrals(&assembly, &equations), &inputs);
            linear.map_err(|error| placed(&assembly, error, true))
        })?;
        Ok(Linearizable { assembly, equations, linear })
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
        let state = self.linear.linearizer.names().iter();
        state.map(|x| names.iter().position(|name| name == x)).collect()
    }

    /// The stability of a steady state, judged without cyclic coordinates; none if the state is not steady.
    ///
    /// # Errors
    /// [`AnalysisError`] if the equations are not smooth at the state.
    pub(crate) fn stability(&mut self, linear: &Linearization) -> Result<Option<Stability>, AnalysisError> {
        if !linear.is_steady {
            return Ok(None);
        }
        let conserved = self.conserved();
        self.linear.linearizer.stability(linear, &conserved).map(Some)
    }

    /// The functions of the state that motions keep.
    pub(crate) fn conserved(&self) -> Conserved<'g> {
        self.linear.conserved(&self.equations, &self.integrals())
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
