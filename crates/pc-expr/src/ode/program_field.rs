//! Programs as vector fields.

use std::sync::Arc;

use crate::kernel::evaluator::{Backend, Evaluator};
use crate::ode::failure::Failure;
use crate::ode::lane_field::{LaneField, Watched};
use crate::ode::varied::VariedSeries;
use crate::ode::vector_field::VectorField;
use crate::program::program::Program;
use crate::taylor::coefficients::TaylorSeries;
use crate::time_profile::profile::TimeDependence;
use crate::time_profile::steep::SteepFunctions;

/// A program as a vector field: its outputs are f of (t, y) and parameters.
///
/// ```
/// use pc_expr::{Backend, Graph, Inputs, Program, ProgramField, VectorField};
///
/// let graph = Graph::new();
/// let [y, k] = graph.symbols(["y", "k"]);
/// let inputs = Inputs { time: None, state: vec![y], parameters: vec![k] };
/// let program = Program::new(&graph, &inputs, &[-k * y])?;
/// let mut decay = ProgramField::new(program, vec![3.0], Backend::Fastest);
/// let mut rates = [0.0];
/// decay.rhs(0.0, &[2.0], &mut rates)?;
/// assert_eq!(rates, [-6.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct ProgramField {
    rates: Evaluator,
    parameters: Vec<f64>,
    backend: Backend,
    series: Option<TaylorSeries>,
    varied: VariedSeries,
}

impl ProgramField {
    /// The vector field of a program, with these values of its parameters.
    ///
    /// # Panics
    /// Unless there are as many outputs as components of the state, and as many values as parameters.
    pub fn new(program: Program, parameters: Vec<f64>, backend: Backend) -> ProgramField {
        assert_eq!(program.outputs_len(), program.state_len(), "a rate for each component");
        assert_eq!(program.parameters_len(), parameters.len(), "values of the parameters");
        let (series, varied) = (None, VariedSeries::default());
        ProgramField { rates: Evaluator::new(program, backend), parameters, backend, series, varied }
    }

    /// The program.
    pub fn program(&self) -> &Arc<Program> {
        self.rates.program()
    }

    /// The values of the parameters.
    pub fn parameters(&self) -> &[f64] {
        &self.parameters
    }
}

impl VectorField for ProgramField {
    fn dim(&self) -> usize {
        self.rates.program().state_len()
    }

    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        self.rates.eval(t, y, &self.parameters, ydot);
        if ydot.iter().all(|rate| rate.is_finite()) {
            return Ok(());
        }
        Err(Failure::recoverable(self.rates.blame(t, y, &self.parameters)))
    }

    fn checks_rates(&self) -> bool {
        true
    }

    fn time_dependence(&self) -> TimeDependence {
        TimeDependence::of(&[self.rates.program()], self.dim(), &self.parameters)
    }

    fn steep_functions(&self) -> Option<SteepFunctions> {
        SteepFunctions::of(&[self.rates.program()], self.dim(), &self.parameters)
    }

    fn component_name(&self, i: usize) -> String {
        self.program().input_names()[1 + i].clone()
    }

    fn lanes(&mut self) -> Option<LaneField> {
        let has_lanes = self.backend == Backend::Fastest && self.steep_functions().is_none();
        has_lanes.then(|| LaneField {
            program: Arc::clone(self.rates.program()),
            parameters: self.parameters.clone(),
            watched: Watched::NOTHING,
            unit_quaternions: Vec::new(),
        })
    }

    fn series(&mut self) -> Result<&TaylorSeries, Failure> {
        let (program, backend) = (self.rates.program(), self.backend);
        Ok(self.series.get_or_insert_with(|| TaylorSeries::new(program, backend)))
    }

    fn expand(&mut self, t: f64, y: &[f64], sides: &[f64], order: usize) -> Result<&TaylorSeries, Failure> {
        let (program, backend) = (self.rates.program(), self.backend);
        let series = self.series.get_or_insert_with(|| TaylorSeries::new(program, backend));
        series.expand(t, y, sides, &self.parameters, order);
        Ok(series)
    }

    fn varied_series(&mut self, columns: &[Option<usize>]) -> Result<&TaylorSeries, Failure> {
        Ok(self.varied.of(columns, self.rates.program(), self.backend))
    }

    fn expand_varied(
        &mut self,
        columns: &[Option<usize>],
        t: f64,
        all: &[f64],
        sides: &[f64],
        order: usize,
    ) -> Result<&TaylorSeries, Failure> {
        let series = self.varied.of(columns, self.rates.program(), self.backend);
        series.expand(t, all, sides, &self.parameters, order);
        Ok(series)
    }
}
