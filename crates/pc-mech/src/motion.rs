//! Compiled equations of motion: a vector field with its Jacobian, and the quantities watched along it.

use pc_expr::{Backend, Cost, Evaluator, Expr, ExprError, Failure, Inputs, Program, VectorField};

use crate::error::MechError;
use crate::ldl::Factors;
use crate::poincare::Equations;

/// A pivot this small against the largest diagonal entry of M is rounding.
const VANISHING_PIVOT: f64 = 1e-14;

/// A Jacobian of more operations is interpreted: integrators ask for it once in dozens of steps, and machine code for
/// it would take longer to make than a run.
const LONG_JACOBIAN: usize = 5000;

/// The first-order system ẏ = f(t, y) of y = (x, η), compiled; owned and independent of the graph.
#[derive(Clone, Debug)]
pub struct Motion {
    /// n coordinates, then k quasi-velocities.
    names: Vec<String>,
    coordinates: usize,
    parameters: Vec<f64>,
    /// Outputs: ẋ, η̇, the pivots D of M, the diagonal of M.
    rhs: Evaluator,
    jacobian: Evaluator,
    observables: Evaluator,
    observable_names: Vec<String>,
    conserved: usize,
    outputs: Vec<f64>,
}

impl<'g> Equations<'g> {
    /// Compiles the equations, their Jacobian and the observables: integrals, energy, outputs.
    ///
    /// # Errors
    /// [`ExprError::UnboundSymbol`] for a symbol that is neither state nor declared parameter.
    pub fn compile(&self) -> Result<Motion, MechError> {
        self.compile_for(Backend::Fastest)
    }

    /// Compiles as [`compile`](Equations::compile) does, for the kernel chosen.
    ///
    /// # Errors
    /// As [`compile`](Equations::compile).
    pub fn compile_for(&self, backend: Backend) -> Result<Motion, MechError> {
        let system = &self.system;
        let graph = system.graph();
        let x = system.frame.coordinates();
        let inputs = self.inputs();
        let state = inputs.state.clone();
        let compile = |outputs: &[Expr<'g>], backend| -> Result<Evaluator, ExprError> {
            Ok(Evaluator::new(Program::new(graph, &inputs, outputs)?, backend))
        };
        let factors = Factors::of(graph, &self.mass);
        let accelerations = self.solve(&factors);
        let mut outputs = self.velocities.clone();
        outputs.extend(&accelerations);
        outputs.extend(factors.pivots());
        outputs.extend((0..factors.pivots().len()).map(|s| self.mass[(s, s)]));

        let energy = ("energy".to_owned(), self.energy);
        let observed: Vec<(String, Expr<'g>)> =
            system.integrals.iter().chain([&energy]).chain(&system.outputs).cloned().collect();
        let (observable_names, observed): (Vec<String>, Vec<Expr<'g>>) = observed.into_iter().unzip();
        let rates: Vec<_> = system.accelerations().into_iter().zip(accelerations.iter().copied()).collect();
        let observed = graph.substitute(&observed, &rates);

        let rhs = compile(&outputs, backend)?;
        Ok(Motion {
            names: state.iter().map(Expr::to_string).collect(),
            coordinates: x.len(),
            parameters: system.parameters.iter().map(|&(_, value)| value).collect(),
            outputs: vec![0.0; rhs.program().outputs_len()],
            rhs,
            jacobian: self.compile_jacobian(&inputs, &factors, &accelerations, backend)?,
            observables: compile(&observed, Backend::Interpreter)?,
            observable_names,
            conserved: system.integrals.len() + 1,
        })
    }

    fn compile_jacobian(
        &self,
        inputs: &Inputs<'g>,
        factors: &Factors<'g>,
        accelerations: &[Expr<'g>],
        backend: Backend,
    ) -> Result<Evaluator, ExprError> {
        let program = Program::new(self.system.graph(), inputs, &self.jacobian(factors, accelerations))?;
        let long = program.code().len() > LONG_JACOBIAN;
        Ok(Evaluator::new(program, if long { Backend::Interpreter } else { backend }))
    }

    /// What the compiled programs read.
    pub(crate) fn inputs(&self) -> Inputs<'g> {
        let system = &self.system;
        Inputs {
            time: Some(system.frame.time()),
            state: system.frame.coordinates().iter().chain(&system.quasi_velocities).copied().collect(),
            parameters: system.parameters.iter().map(|&(symbol, _)| symbol).collect(),
        }
    }

    /// ∂(ẋ, η̇)/∂(x, η), column after column. No inverse is differentiated: with F = r − M a at fixed a = η̇,
    /// ∂η̇/∂y = M⁻¹ ∂F/∂y.
    pub(crate) fn jacobian(&self, factors: &Factors<'g>, accelerations: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let graph = self.system.graph();
        let eta = &self.system.quasi_velocities;
        let state: Vec<Expr<'g>> = self.system.frame.coordinates().iter().chain(eta).copied().collect();
        let fixed = self.system.accelerations();
        let balance: Vec<Expr<'g>> = (0..eta.len())
            .map(|s| self.right[s] - graph.dot(self.mass.row(s).iter().copied(), fixed.iter().copied()))
            .collect();
        let rows: Vec<Expr<'g>> = self.velocities.iter().chain(&balance).copied().collect();
        let values: Vec<_> = fixed.into_iter().zip(accelerations.iter().copied()).collect();
        let mut columns = Vec::with_capacity(rows.len() * state.len());
        for &y in &state {
            let column = graph.directional(&rows, &[(y, Expr::ONE)]);
            let (velocity, balance) = column.split_at(self.velocities.len());
            columns.extend(velocity);
            columns.extend(factors.solve(graph, &graph.substitute(balance, &values)));
        }
        columns
    }
}

impl Motion {
    /// Names of the components of the state: coordinates, then quasi-velocities.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Number n of coordinates, which come first in the state.
    pub fn coordinates(&self) -> usize {
        self.coordinates
    }

    /// The values of the parameters, in the order of declaration.
    pub fn parameters(&self) -> &[f64] {
        &self.parameters
    }

    /// The values of the parameters, to be changed.
    pub fn parameters_mut(&mut self) -> &mut [f64] {
        &mut self.parameters
    }

    /// Names of the observables: the integrals, `energy`, the outputs.
    pub fn observable_names(&self) -> &[String] {
        &self.observable_names
    }

    /// Number of observables, the first ones, that the motion should keep constant: the integrals and the energy.
    pub fn conserved_len(&self) -> usize {
        self.conserved
    }

    /// The observables at (t, y), as many as [`observable_names`](Motion::observable_names).
    ///
    /// # Panics
    /// If `y` has not the length of the state.
    pub fn observe(&mut self, t: f64, y: &[f64]) -> Vec<f64> {
        assert_eq!(y.len(), self.names.len(), "length of the state");
        let mut values = vec![0.0; self.observable_names.len()];
        self.observables.eval(t, y, &self.parameters, &mut values);
        values
    }

    /// Operations of one evaluation of the right-hand side, kinematics included.
    pub fn cost(&self) -> Cost {
        self.rhs.program().cost()
    }

    fn check(&mut self, t: f64, y: &[f64]) -> Result<(), Failure> {
        let (motion, factors) = self.outputs.split_at(self.names.len());
        let (pivots, diagonal) = factors.split_at(factors.len() / 2);
        let scale = diagonal.iter().fold(0.0f64, |scale, m| scale.max(m.abs()));
        if let Some(s) = pivots.iter().position(|d| d.abs() <= VANISHING_PIVOT * scale) {
            return Err(Failure::recoverable(MechError::SingularMassMatrix {
                quasi_velocity: self.names[self.coordinates + s].clone(),
                pivot: pivots[s],
                t,
                state: self.names.iter().cloned().zip(y.iter().copied()).collect(),
            }));
        }
        if motion.iter().all(|v| v.is_finite()) {
            return Ok(());
        }
        let culprit = self.rhs.diagnose(t, y, &self.parameters);
        match culprit {
            Some(error) => Err(Failure::recoverable(MechError::from(error))),
            None => Ok(()),
        }
    }
}

impl VectorField for Motion {
    fn dim(&self) -> usize {
        self.names.len()
    }

    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        self.rhs.eval(t, y, &self.parameters, &mut self.outputs);
        self.check(t, y)?;
        ydot.copy_from_slice(&self.outputs[..y.len()]);
        Ok(())
    }

    fn has_jacobian(&self) -> bool {
        true
    }

    fn jacobian(&mut self, t: f64, y: &[f64], jacobian: &mut [f64]) -> Result<(), Failure> {
        self.jacobian.eval(t, y, &self.parameters, jacobian);
        if jacobian.iter().all(|v| v.is_finite()) {
            return Ok(());
        }
        match self.jacobian.diagnose(t, y, &self.parameters) {
            Some(error) => Err(Failure::recoverable(MechError::from(error))),
            None => Ok(()),
        }
    }

    fn component_name(&self, i: usize) -> String {
        self.names.get(i).cloned().unwrap_or_else(|| format!("y[{i}]"))
    }
}
