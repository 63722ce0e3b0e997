//! How velocities respond to an impulse.

use pc_algebra::Matrix;
use pc_expr::{Backend, Evaluator, Inputs, Program};
use serde::{Deserialize, Serialize};

use crate::compiled::failure::check_finite;
use crate::compiled::inverse_dynamics::InverseDynamics;
use crate::compiled::mass_factors::{MassFactors, SingularMatrix};
use crate::compiled::point::Point;
use crate::compiled::projection::holding::DEPENDENT;
use crate::constraints::multipliers::Multipliers;
use crate::equations::poincare::Equations;
use crate::error::{EvaluationError, MechError};
use crate::numeric::least_squares::LeastSquares;

/// The change of the quasi-velocities by an impulse π, whose components are the integrals of generalised forces over
/// the short time in which it acts:
///
///   M Δη + Cᵀ μ = π,   C Δη = 0,
///
/// where C = ∂g/∂η belongs to the constraints, if there are any: their reactions are impulses −Cᵀ μ.
///
/// ```
/// # use pc_mech::{Graph, System};
/// // Two masses on a line, in the coordinates x and the distance d: a blow on d moves both.
/// let graph = Graph::new();
/// let system = System::builder(&graph)
///     .coordinates(["x", "d"])
///     .kinetic(|_, _, v| (v[0].square() + (v[0] + v[1]).square()) / 2.0)
///     .build()?;
/// let mut response = system.poincare()?.impulse_response()?;
/// let mut change = [0.0, 1.0];
/// response.respond(0.0, &[0.0; 4], &mut change)?;
/// assert!((change[0] + 1.0).abs() < 1e-15 && (change[1] - 2.0).abs() < 1e-15);
/// # Ok::<(), pc_mech::MechError>(())
/// ```
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ImpulseResponse {
    /// M
    inverse: InverseDynamics,
    factors: MassFactors,
    /// C, row by row, from (t, y, p).
    constraints: Option<Evaluator>,
    names: Vec<String>,
    quasi_velocities: Vec<String>,
}

impl Equations<'_> {
    /// The response of these quasi-velocities to an impulse, compiled.
    ///
    /// # Errors
    /// As for [`inverse_dynamics_of_motion`](Equations::inverse_dynamics_of_motion).
    pub fn impulse_response(&self) -> Result<ImpulseResponse, MechError> {
        let (inverse, system) = (self.inverse_dynamics_of_motion()?, self.system());
        let names = |list: &[pc_expr::Expr<'_>]| list.iter().map(ToString::to_string).collect();
        Ok(ImpulseResponse {
            factors: MassFactors::new(inverse.len()),
            inverse,
            constraints: None,
            names: names(&system.state()),
            quasi_velocities: names(system.quasi_velocities()),
        })
    }
}

impl Multipliers<'_> {
    /// The response of all quasi-velocities to an impulse under the constraints, compiled.
    ///
    /// # Errors
    /// As for [`Equations::impulse_response`].
    pub fn impulse_response(&self) -> Result<ImpulseResponse, MechError> {
        let system = self.equations().system();
        let c = self.coefficients();
        let rows: Vec<_> = (0..c.rows()).flat_map(|a| (0..c.columns()).map(move |s| c[(a, s)])).collect();
        let parameters = system.run_time_inputs().into_iter().map(|(symbol, _)| symbol).collect();
        let inputs = Inputs { time: Some(system.frame().time()), state: system.state(), parameters };
        let program = Program::new(system.graph(), &inputs, &rows)?;
        let constraints = Some(Evaluator::new(program, Backend::Interpreter));
        Ok(ImpulseResponse { constraints, ..self.equations().impulse_response()? })
    }
}

impl ImpulseResponse {
    /// The values of the parameters, which may be changed.
    pub fn parameters_mut(&mut self) -> &mut [f64] {
        self.inverse.parameters_mut()
    }

    /// Replaces the components of an impulse at (t, y), where y = (x, η, z), by the change of η that it causes.
    ///
    /// # Errors
    /// [`MechError::Expr`] where a value is not finite; [`EvaluationError::SingularMassMatrix`].
    ///
    /// # Panics
    /// If a length is wrong.
    pub fn respond(&mut self, t: f64, y: &[f64], impulse: &mut [f64]) -> Result<(), MechError> {
        let k = self.quasi_velocities.len();
        assert_eq!(impulse.len(), k, "number of components");
        let mut mass = vec![0.0; k * k];
        self.inverse.mass_matrix(t, y, &mut mass)?;
        let Some(constraints) = &mut self.constraints else {
            self.factors.factorise(&mass).map_err(|SingularMatrix { index, pivot }| {
                let state = self.names.iter().cloned().zip(y.iter().copied()).collect();
                let quasi_velocity = self.quasi_velocities[index].clone();
                EvaluationError::SingularMassMatrix { quasi_velocity, pivot, t, state }
            })?;
            self.factors.solve(impulse);
            return Ok(());
        };
        let mut rows = vec![0.0; constraints.program().outputs_len()];
        let p = self.inverse.parameters_mut();
        constraints.eval(t, y, p, &mut rows);
        let finite = check_finite(&rows, constraints, Point { t, y, p });
        finite.map_err(|failure| failure.at(&self.quasi_velocities, t, &self.names, y))?;
        bordered(&mass, &rows, impulse)
    }
}

/// Solves M Δ + Cᵀ μ = π, C Δ = 0 for Δ in units in which masses, and the rows of C, have length one. Dependent rows
/// share their reaction.
fn bordered(mass: &[f64], rows: &[f64], impulse: &mut [f64]) -> Result<(), MechError> {
    let (k, m) = (impulse.len(), rows.len() / impulse.len());
    let own = |s: usize| Some(mass[s * k + s].abs()).filter(|mass| *mass > 0.0);
    let lightest = (0..k).filter_map(own).fold(f64::INFINITY, f64::min);
    let lightest = if lightest.is_finite() { lightest } else { 1.0 };
    let units: Vec<f64> = (0..k).map(|s| own(s).unwrap_or(lightest).sqrt().recip()).collect();
    let row = |a: usize| (0..k).map(move |s| rows[a * k + s]);
    let length = |a: usize| row(a).zip(&units).map(|(c, unit)| c * unit).fold(0.0, f64::hypot);
    let lengths: Vec<f64> = (0..m).map(|a| Some(length(a)).filter(|l| *l > 0.0).unwrap_or(1.0)).collect();
    let c = |a: usize, s: usize| rows[a * k + s] * units[s] / lengths[a];
    let matrix = Matrix::from_fn(k + m, k + m, |i, j| match (i < k, j < k) {
        (true, true) => mass[i * k + j] * units[i] * units[j],
        (false, true) => c(i - k, j),
        (true, false) => c(j - k, i),
        (false, false) => 0.0,
    });
    let right: Vec<f64> = (0..k + m).map(|i| if i < k { impulse[i] * units[i] } else { 0.0 }).collect();
    let solved = LeastSquares::of(&matrix)?.shortest(&right, DEPENDENT);
    impulse.iter_mut().zip(solved.iter().zip(&units)).for_each(|(out, (step, unit))| *out = step * unit);
    Ok(())
}
