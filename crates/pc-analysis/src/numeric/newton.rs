//! Newton's method for F(z) = 0 where solutions may come in families, so that ∂F/∂z need not be regular.

use pc_mech::{Matrix, SingularValues};

use crate::error::AnalysisError;
use crate::numeric::dense::norm;

/// The largest number of times that a step is halved before the iteration ends.
const HALVINGS: usize = 40;

/// The point at which an iteration ends, with the values there.
#[derive(Clone, Debug)]
pub(crate) struct Iterate {
    /// z
    pub(crate) point: Vec<f64>,
    /// F(z)
    pub(crate) values: Vec<f64>,
    /// ∂F/∂z
    pub(crate) slopes: Matrix<f64>,
    /// The number of steps taken.
    pub(crate) iterations: usize,
}

impl Iterate {
    /// |F| relative to the effect of a change of z by its own size, |∂F/∂z| (1 + |z|).
    pub(crate) fn relative_residual(&self) -> f64 {
        let residual = norm(&self.values);
        if residual == 0.0 { 0.0 } else { residual / (norm(&self.slopes.entries()) * self.scale()) }
    }

    /// Whether the relative residual is at most `tolerance`.
    pub(crate) fn is_solution(&self, tolerance: f64) -> bool {
        self.relative_residual() <= tolerance
    }

    fn scale(&self) -> f64 {
        1.0 + norm(&self.point)
    }

    /// The step of Levenberg and Marquardt, δ = −(JᵀJ + μ)⁻¹ Jᵀ F with μ = |J| |F|/(1 + |z|): near a family
    /// of solutions the iteration converges quadratically to the nearest one, as Newton's method does near a
    /// single solution (J. Fan, Y. Yuan, Computing 74, 2005, 23–39).
    fn step(&self) -> Result<Vec<f64>, AnalysisError> {
        let factors = SingularValues::of(&self.slopes)?;
        let size = self.slopes.rows().max(self.slopes.columns()) as f64;
        let largest = factors.values.first().copied().unwrap_or(0.0);
        let damping = largest * norm(&self.values) / self.scale();
        let mut step = vec![0.0; self.point.len()];
        for l in 0..factors.rank(4.0 * size * f64::EPSILON * largest) {
            let sigma = factors.values[l];
            let along: f64 = self.values.iter().zip(factors.left.column(l)).map(|(f, u)| f * u).sum();
            let factor = -sigma * along / (sigma * sigma + damping);
            for (change, v) in step.iter_mut().zip(factors.right.column(l)) {
                *change += factor * v;
            }
        }
        Ok(step)
    }
}

/// Reduces |F(z)|, beginning at `start`, until it no longer decreases or `most` steps have been taken. The
/// caller decides whether the residual counts as zero.
///
/// `f` returns F(z) and ∂F/∂z; if it fails after a step, a shorter step is tried.
///
/// # Errors
/// The error of `f` at `start`.
pub(crate) fn solve(
    start: Vec<f64>,
    most: usize,
    mut f: impl FnMut(&[f64]) -> Result<(Vec<f64>, Matrix<f64>), AnalysisError>,
) -> Result<Iterate, AnalysisError> {
    let (values, slopes) = f(&start)?;
    let mut here = Iterate { point: start, values, slopes, iterations: 0 };
    while here.iterations < most && norm(&here.values) > 0.0 {
        let step = here.step()?;
        let shortened = |halvings: usize| {
            let fraction = 0.5f64.powi(halvings as i32);
            let point: Vec<f64> = here.point.iter().zip(&step).map(|(z, d)| z + fraction * d).collect();
            let (values, slopes) = f(&point).ok()?;
            let enough = (1.0 - 1e-4 * fraction) * norm(&here.values);
            (norm(&values) < enough).then_some(Iterate {
                point,
                values,
                slopes,
                iterations: here.iterations + 1,
            })
        };
        let Some(next) = (0..HALVINGS).find_map(shortened) else { break };
        here = next;
    }
    Ok(here)
}
