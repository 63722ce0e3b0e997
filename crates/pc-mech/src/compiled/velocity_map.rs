//! Velocities and momenta as linear maps of the quasi-velocities.

use pc_expr::{Backend, Evaluator, Expr, Inputs, Program};
use serde::{Deserialize, Serialize};

use crate::compiled::failure::check_finite;
use crate::compiled::point::Point;
use crate::equations::poincare::Equations;
use crate::error::{FrameError, MechError};

/// Functions w(t, x, η) that are affine in the quasi-velocities, such as velocities of points and momenta, with their rates,
///
///   w = A η + a_0,   ẇ = A η̇ + α.
///
/// For the velocity of a point and the angular velocity of its body, A is their Jacobian, with Kane's partial velocities as
/// columns; for the momentum and the angular momentum about the centre of mass it is the centroidal momentum matrix [Orin,
/// Goswami & Lee 2013]. a_0 is what the frame itself contributes as it moves, and α are the rates for η̇ = 0, such as the
/// J̇ η of a Jacobian J. First-order states move as well.
///
/// ```
/// # use pc_mech::{Graph, System};
/// // The tip of a rod of length 2 that turns about one end.
/// let graph = Graph::new();
/// let rod = System::builder(&graph).coordinates(["φ"]).kinetic(|_, _, v| 2.0 / 3.0 * v[0].square()).build()?;
/// let [phi, turn] = graph.symbols(["φ", "φ'"]);
/// let mut tip = rod.poincare()?.velocity_map(&[-2.0 * phi.sin() * turn, 2.0 * phi.cos() * turn], &[])?;
/// let ([mut jacobian, mut rest, mut rates], y) = ([[0.0; 2]; 3], [0.0, 3.0]);
/// tip.map(0.0, &y, &mut jacobian, &mut rest)?;
/// tip.rates(0.0, &y, &mut rates)?;
/// assert_eq!((jacobian, rest, rates), ([0.0, 2.0], [0.0, 0.0], [-18.0, 0.0]));
/// # Ok::<(), pc_mech::MechError>(())
/// ```
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct VelocityMap {
    /// A column by column, then a_0.
    map: Evaluator,
    /// α
    rates: Evaluator,
    functions: usize,
    names: Vec<String>,
    quasi_velocities: Vec<String>,
    /// The parameters, then the arguments.
    parameters: Vec<f64>,
    arguments: usize,
    /// A and a_0
    values: Vec<f64>,
}

impl<'g> Equations<'g> {
    /// Functions w of (t, x, η) that are affine in η, and their rates, compiled. They may contain `arguments` besides, symbols
    /// whose values can be [set](VelocityMap::arguments_mut), such as the components of a point along the axes of its body.
    ///
    /// # Errors
    /// [`FrameError::NotAffine`]; [`ExprError::UnboundSymbol`](crate::ExprError::UnboundSymbol) for a symbol that is none of
    /// those of the system, nor an argument.
    pub fn velocity_map(
        &self,
        functions: &[Expr<'g>],
        arguments: &[Expr<'g>],
    ) -> Result<VelocityMap, MechError> {
        let (system, graph) = (self.system(), self.system().graph());
        let (eta, k) = (system.quasi_velocities(), system.quasi_velocities().len());
        let rows = graph.jacobian(functions, eta);
        let mut values = vec![Expr::ZERO; functions.len() * (k + 1)];
        for (i, row) in rows.iter().enumerate() {
            for &(s, slope) in row {
                if graph.symbols_of(&[slope]).iter().any(|symbol| eta.contains(symbol)) {
                    let (what, quasi_velocity) = (functions[i].to_string(), eta[s].to_string());
                    return Err(FrameError::NotAffine { what, quasi_velocity }.into());
                }
                values[i + functions.len() * s] = slope;
            }
        }
        let zeros: Vec<_> = eta.iter().map(|&eta| (eta, Expr::ZERO)).collect();
        values[functions.len() * k..].copy_from_slice(&graph.substitute(functions, &zeros));
        let moving = system.frame().coordinates().iter().copied().zip(self.velocities().iter().copied());
        let along: Vec<_> = moving
            .chain(graph.in_time(system.frame().time()))
            .chain(system.states().iter().copied())
            .collect();
        let rates = graph.directional(functions, &along);
        graph.check_budget()?;
        let Inputs { time, state, parameters } = system.inputs();
        let inputs = Inputs { time, state, parameters: [&parameters, arguments].concat() };
        let compiled = |values: &[Expr<'g>]| -> Result<Evaluator, MechError> {
            Ok(Evaluator::new(Program::new(graph, &inputs, values)?, Backend::default()))
        };
        let given = system.run_time_inputs().into_iter().map(|(_, value)| value);
        Ok(VelocityMap {
            map: compiled(&values)?,
            rates: compiled(&rates)?,
            functions: functions.len(),
            names: inputs.state.iter().map(Expr::to_string).collect(),
            quasi_velocities: eta.iter().map(Expr::to_string).collect(),
            parameters: given.chain(arguments.iter().map(|_| 0.0)).collect(),
            arguments: arguments.len(),
            values: vec![0.0; values.len()],
        })
    }
}

impl VelocityMap {
    /// k, the number of quasi-velocities.
    pub fn quasi_velocities(&self) -> usize {
        self.quasi_velocities.len()
    }

    /// The number of functions.
    pub fn functions(&self) -> usize {
        self.functions
    }

    /// The values of the parameters, which may be changed.
    pub fn parameters_mut(&mut self) -> &mut [f64] {
        let count = self.parameters.len() - self.arguments;
        &mut self.parameters[..count]
    }

    /// The values of the arguments, all of which are 0 until they are set.
    pub fn arguments_mut(&mut self) -> &mut [f64] {
        let count = self.parameters.len() - self.arguments;
        &mut self.parameters[count..]
    }

    /// Writes A at (t, y), column by column, and a_0: for m functions A_is is at i + m s.
    ///
    /// # Errors
    /// [`MechError::Expr`] where a value is not finite.
    ///
    /// # Panics
    /// If a length is wrong.
    pub fn map(&mut self, t: f64, y: &[f64], matrix: &mut [f64], rest: &mut [f64]) -> Result<(), MechError> {
        let expected = (self.names.len(), self.functions * self.quasi_velocities.len(), self.functions);
        assert_eq!((y.len(), matrix.len(), rest.len()), expected, "lengths of y, A and a_0");
        self.map.eval(t, y, &self.parameters, &mut self.values);
        let at = Point { t, y, p: &self.parameters };
        let outcome = check_finite(&self.values, &self.map, at);
        outcome.map_err(|failure| failure.at(&self.quasi_velocities, t, &self.names, y))?;
        let (of_matrix, of_rest) = self.values.split_at(matrix.len());
        matrix.copy_from_slice(of_matrix);
        rest.copy_from_slice(of_rest);
        Ok(())
    }

    /// Writes α at (t, y), the rates of the functions for η̇ = 0.
    ///
    /// # Errors
    /// As for [`map`](VelocityMap::map).
    ///
    /// # Panics
    /// If a length is wrong.
    pub fn rates(&mut self, t: f64, y: &[f64], rates: &mut [f64]) -> Result<(), MechError> {
        assert_eq!((y.len(), rates.len()), (self.names.len(), self.functions), "lengths of y and of α");
        self.rates.eval(t, y, &self.parameters, rates);
        let at = Point { t, y, p: &self.parameters };
        let outcome = check_finite(rates, &self.rates, at);
        outcome.map_err(|failure| failure.at(&self.quasi_velocities, t, &self.names, y))
    }
}
