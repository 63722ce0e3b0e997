//! The forces that accelerations require.

use pc_expr::{Backend, Evaluator, Expr, Inputs, Program};
use serde::{Deserialize, Serialize};

use crate::compiled::elimination::columns::Storage;
use crate::compiled::elimination::products::Products;
use crate::compiled::failure::check_finite;
use crate::compiled::point::Point;
use crate::equations::poincare::Equations;
use crate::error::MechError;

/// Poincaré's equations (9) read from right to left, M η̇ + h = Q + τ: the generalised forces τ that have to be added
/// to the forces Q of a system for the accelerations η̇.
///
/// The terms are computed as functions of t and the state y = (x, η, z). For a large tree of bodies, τ is found from
/// body to body in O(N) operations (Newton–Euler; Luh, Walker & Paul 1980), and M as its derivative by η̇, eight
/// columns at a time.
///
/// ```
/// # use pc_mech::{Graph, System};
/// // A pendulum in a viscous medium: θ'' + 0.1 θ' + 9.81 sin θ = τ
/// let graph = Graph::new();
/// let system = System::builder(&graph)
///     .coordinates(["θ"])
///     .kinetic(|_, _, v| v[0].square() / 2.0)
///     .potential(|_, x, _| -9.81 * x[0].cos())
///     .dissipation(|_, _, v| 0.1 * v[0].square() / 2.0)
///     .build()?;
/// let mut dynamics = system.poincare()?.inverse_dynamics_of_motion()?;
/// let mut torque = [0.0];
/// dynamics.forces(0.0, &[0.5, 2.0], &[3.0], &mut torque)?;
/// assert!((torque[0] - (3.0 + 0.2 + 9.81 * f64::sin(0.5))).abs() < 1e-14);
/// # Ok::<(), pc_mech::MechError>(())
/// ```
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct InverseDynamics {
    /// From (t, (y, η̇), p).
    forces: Evaluator,
    /// M by its columns, from (t, y, p).
    mass: Products,
    names: Vec<String>,
    coordinates: usize,
    quasi_velocities: Vec<String>,
    parameters: Vec<f64>,
    /// y, η̇
    known: Vec<f64>,
}

impl Equations<'_> {
    /// The inverse dynamics, compiled.
    ///
    /// # Errors
    /// [`ExprError::UnboundSymbol`](crate::ExprError::UnboundSymbol) for a symbol that is neither state nor
    /// declared parameter.
    pub fn inverse_dynamics_of_motion(&self) -> Result<InverseDynamics, MechError> {
        let system = self.system();
        match system.tree() {
            Some(_) => {
                let graph = system.graph().page(system.graph().folding());
                system.in_graph(&graph).poincare()?.compiled_inverse()
            }
            None => self.compiled_inverse(),
        }
    }

    fn compiled_inverse(&self) -> Result<InverseDynamics, MechError> {
        let (system, graph) = (self.system(), self.system().graph());
        let (state, accelerations) = (system.state(), system.accelerations());
        let forces = self.inverse_dynamics();
        let (parameters, values): (Vec<Expr<'_>>, Vec<f64>) = system.run_time_inputs().into_iter().unzip();
        let inputs = Inputs { time: Some(system.frame().time()), state, parameters };
        let with_accelerations =
            Inputs { state: [&inputs.state[..], &accelerations].concat(), ..inputs.clone() };
        let v = self.new_symbols("δ", &accelerations);
        let along: Vec<_> = accelerations.iter().copied().zip(v.iter().copied()).collect();
        let products = graph.directional(&forces, &along);
        let zeros = vec![Expr::ZERO; accelerations.len()];
        Ok(InverseDynamics {
            forces: Evaluator::new(Program::new(graph, &with_accelerations, &forces)?, Backend::default()),
            mass: Products::new(graph, &inputs, (&accelerations, &zeros), (&v, &products))?,
            names: inputs.state.iter().map(Expr::to_string).collect(),
            coordinates: system.frame().coordinates().len(),
            quasi_velocities: system.quasi_velocities().iter().map(Expr::to_string).collect(),
            parameters: values,
            known: vec![0.0; with_accelerations.state.len()],
        })
    }
}

impl InverseDynamics {
    /// k, the number of quasi-velocities.
    pub fn len(&self) -> usize {
        self.quasi_velocities.len()
    }

    /// Whether nothing moves.
    pub fn is_empty(&self) -> bool {
        self.quasi_velocities.is_empty()
    }

    /// The values of the parameters, which may be changed.
    pub fn parameters_mut(&mut self) -> &mut [f64] {
        &mut self.parameters
    }

    /// Writes τ = M η̇ + h − Q, k numbers, for the k accelerations η̇ at (t, y).
    ///
    /// # Errors
    /// [`MechError::Expr`] where a value is not finite.
    ///
    /// # Panics
    /// If a length is wrong.
    pub fn forces(
        &mut self,
        t: f64,
        y: &[f64],
        accelerations: &[f64],
        forces: &mut [f64],
    ) -> Result<(), MechError> {
        assert_eq!((y.len(), accelerations.len()), (self.names.len(), self.len()), "lengths of y and of η̇");
        let (state, rates) = self.known.split_at_mut(y.len());
        state.copy_from_slice(y);
        rates.copy_from_slice(accelerations);
        self.evaluate(t, forces)
    }

    /// Writes h − Q, the forces for η̇ = 0: those that the motion itself requires.
    ///
    /// # Errors
    /// As for [`forces`](InverseDynamics::forces).
    ///
    /// # Panics
    /// If a length is wrong.
    pub fn bias(&mut self, t: f64, y: &[f64], forces: &mut [f64]) -> Result<(), MechError> {
        let (state, rates) = self.known.split_at_mut(y.len());
        state.copy_from_slice(y);
        rates.fill(0.0);
        self.evaluate(t, forces)
    }

    /// Writes the forces that hold the system at rest where it is, at η = 0 and η̇ = 0: against weight and springs.
    ///
    /// # Errors
    /// As for [`forces`](InverseDynamics::forces).
    ///
    /// # Panics
    /// If a length is wrong.
    pub fn holding(&mut self, t: f64, y: &[f64], forces: &mut [f64]) -> Result<(), MechError> {
        let (state, rates) = self.known.split_at_mut(y.len());
        state.copy_from_slice(y);
        state[self.coordinates..self.coordinates + rates.len()].fill(0.0);
        rates.fill(0.0);
        self.evaluate(t, forces)
    }

    /// Writes the mass matrix M = ∂²L/∂η∂η at (t, y), k × k, which is symmetric.
    ///
    /// # Errors
    /// As for [`forces`](InverseDynamics::forces).
    ///
    /// # Panics
    /// If a length is wrong.
    pub fn mass_matrix(&mut self, t: f64, y: &[f64], entries: &mut [f64]) -> Result<(), MechError> {
        assert_eq!((y.len(), entries.len()), (self.names.len(), self.len().pow(2)), "lengths of y and of M");
        let outcome = self.mass.eval(Point { t, y, p: &self.parameters }, entries, Storage::Dense);
        outcome.map_err(|failure| failure.at(&self.quasi_velocities, t, &self.names, y))
    }

    fn evaluate(&mut self, t: f64, forces: &mut [f64]) -> Result<(), MechError> {
        assert_eq!(forces.len(), self.len(), "number of forces");
        self.forces.eval(t, &self.known, &self.parameters, forces);
        let at = Point { t, y: &self.known, p: &self.parameters };
        let outcome = check_finite(forces, &self.forces, at);
        outcome.map_err(|failure| failure.at(&self.quasi_velocities, t, &self.names, &self.known))
    }
}
