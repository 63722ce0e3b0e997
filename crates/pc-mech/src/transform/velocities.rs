//! The conversion of quasi-velocities to velocities and back.

use pc_expr::{Backend, Evaluator, Expr, Inputs, Program};

use crate::error::MechError;
use crate::system::system::System;

/// The compiled conversion between states (x, η) and (x, ẋ) of one system, by ẋ = b η + b_0 (3) and η = a ẋ +
/// a_0 (2).
///
/// Where n > k, velocities that the frame does not allow are replaced by the nearest allowed ones: a = (bᵀb)⁻¹bᵀ.
/// Where rank b < k, the result is not finite.
#[derive(Clone, Debug)]
pub struct VelocityTransform {
    parameters: Vec<f64>,
    velocities: Evaluator,
    quasi_velocities: Evaluator,
}

impl System<'_> {
    /// Compiles the conversion between quasi-velocities and velocities.
    ///
    /// # Errors
    /// [`AlgebraError::DependentOperators`](crate::AlgebraError::DependentOperators) where rank b < k everywhere;
    /// [`ExprError::UnboundSymbol`](crate::ExprError::UnboundSymbol) for a symbol that is neither coordinate nor
    /// declared parameter.
    ///
    /// ```
    /// use pc_mech::{Graph, System};
    ///
    /// // Polar coordinates, η_2 the velocity across the radius.
    /// let graph = Graph::new();
    /// let system = System::builder(&graph)
    ///     .coordinates(["ρ", "φ"])
    ///     .quasi_velocities(["η1", "η2"])
    ///     .kinematics(|_, x, eta| [eta[0], eta[1] / x[0]])
    ///     .lagrangian(|_, _, eta| (eta[0].square() + eta[1].square()) / 2.0)
    ///     .build()?;
    /// let mut transform = system.velocity_transform()?;
    /// assert_eq!(transform.to_velocities(0.0, &[2.0, 0.0, 3.0, 5.0]), [2.0, 0.0, 3.0, 2.5]);
    /// assert_eq!(transform.to_quasi_velocities(0.0, &[2.0, 0.0, 3.0, 2.5]), [2.0, 0.0, 3.0, 5.0]);
    /// # Ok::<(), pc_mech::MechError>(())
    /// ```
    pub fn velocity_transform(&self) -> Result<VelocityTransform, MechError> {
        let (graph, x) = (self.graph(), self.frame.coordinates());
        let (a, a0) = self.frame.definitions()?;
        let rates: Vec<Expr<'_>> = self.all_unused(x.iter().map(|x| format!("{x}'")), "_");
        let eta: Vec<Expr<'_>> = (0..a.rows())
            .map(|s| graph.dot(a.row(s).iter().copied(), rates.iter().copied()) + a0[s])
            .collect();
        let compiled = |moving: &[Expr<'_>], values: &[Expr<'_>]| -> Result<Evaluator, MechError> {
            let inputs = Inputs {
                time: Some(self.frame.time()),
                state: self.state_with(moving),
                parameters: self.parameters.iter().map(|&(symbol, _)| symbol).collect(),
            };
            let outputs = self.state_with(values);
            Ok(Evaluator::new(Program::new(graph, &inputs, &outputs)?, Backend::Interpreter))
        };
        Ok(VelocityTransform {
            parameters: self.parameters.iter().map(|&(_, value)| value).collect(),
            velocities: compiled(&self.quasi_velocities, &self.frame.velocities(&self.quasi_velocities))?,
            quasi_velocities: compiled(&rates, &eta)?,
        })
    }
}

impl VelocityTransform {
    /// The state (x, ẋ), of length 2n, that corresponds to (x, η), of length n + k.
    ///
    /// # Panics
    /// If the state has a different length.
    pub fn to_velocities(&mut self, t: f64, state: &[f64]) -> Vec<f64> {
        let mut result = vec![0.0; self.velocities.program().outputs_len()];
        self.velocities.eval(t, state, &self.parameters, &mut result);
        result
    }

    /// The state (x, η), of length n + k, that corresponds to (x, ẋ), of length 2n.
    ///
    /// # Panics
    /// If the state has a different length.
    pub fn to_quasi_velocities(&mut self, t: f64, state: &[f64]) -> Vec<f64> {
        let mut result = vec![0.0; self.quasi_velocities.program().outputs_len()];
        self.quasi_velocities.eval(t, state, &self.parameters, &mut result);
        result
    }
}
