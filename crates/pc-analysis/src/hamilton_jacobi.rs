//! Hamilton–Jacobi's equation in quasi-velocities, and Jacobi's theorem.

pub(crate) mod proposed_action;
mod roots;

use pc_expr::{Evaluator, Inputs, Program};
use pc_mech::{Backend, Canonical, Expr, Matrix, MechError, Neighbourhood, ShapeError};

use crate::error::{AnalysisError, shape};
use crate::numeric::{dense::norm, newton};
use roots::vanishes;

/// The largest number of steps of Newton's method for one position.
const MOST_STEPS: usize = 100;
/// The residual that counts as zero, relative to |∂F/∂x| (1 + |x|).
const ENOUGH: f64 = 1e-12;

/// A complete integral S(t, x, α) of Hamilton–Jacobi's equation, from which the motions follow by Jacobi's
/// theorem:
///
///   ∂S/∂α_s = β_s,   y_s = X_s S,   s = 1..k,
///
/// satisfy the canonical equations (10), (11) for any constants α, β.
#[derive(Clone, Debug)]
pub struct CompleteIntegral<'g> {
    coordinates: Vec<String>,
    parameters: Vec<f64>,
    conjugates: Vec<Expr<'g>>,
    momenta: Vec<Expr<'g>>,
    /// ∂S/∂α (k), ∂²S/∂α∂x (k × k, by rows), X_s S (k) in this order, as functions of t, x and (p, α).
    values: Evaluator,
}

/// The left-hand side of Hamilton–Jacobi's equation
///
///   X_0 S + H(t, x, X_s S) = 0
///
/// for S = `action`, a function of t, x and any constants. S is a solution if this [is zero](Expr::is_zero);
/// in that case y_s = X_s S satisfies (10) along the motion (11). The constant zero is a proof, since a
/// difference of expressions of equal value is folded to zero. Square roots are resolved if the radicand is
/// linear in some symbol, for example the energy.
///
/// # Errors
/// [`AnalysisError::Forced`] if a generalised force is not zero;
/// [`LagrangianError::NotQuadratic`](pc_mech::LagrangianError::NotQuadratic) if H is not
/// [closed](Canonical::is_closed).
///
/// ```
/// # use pc_analysis::hamilton_jacobi;
/// # use pc_mech::{Graph, System};
/// let graph = Graph::new();
/// let particle =
///     System::builder(&graph).coordinates(["x"]).lagrangian(|_, _, v| v[0].square() / 2.0).build()?;
/// let [t, x, a] = graph.symbols(["t", "x", "a"]);
/// let canonical = particle.canonical()?;
/// assert!(hamilton_jacobi(&canonical, (x - a).square() / (2.0 * t))?.is_zero());
/// assert!(!hamilton_jacobi(&canonical, x * x - t)?.is_zero());
/// # Ok::<(), pc_analysis::AnalysisError>(())
/// ```
pub fn hamilton_jacobi<'g>(canonical: &Canonical<'g>, action: Expr<'g>) -> Result<Expr<'g>, AnalysisError> {
    canonical.closed_quasi_velocities()?;
    let system = canonical.system();
    if let Some(s) = system.forces().iter().position(|force| !force.is_zero()) {
        return Err(AnalysisError::Forced { quasi_velocity: system.quasi_velocities()[s].to_string() });
    }
    let momenta: Vec<_> = canonical.momenta().iter().copied().zip(slopes(canonical, action)).collect();
    let hamiltonian = system.graph().substitute(&[canonical.hamiltonian()], &momenta)[0];
    let left = system.frame().apply(0, &[action])[0] + hamiltonian;
    system.graph().check(&[left])?;
    Ok(if vanishes(system.graph(), left) { Expr::ZERO } else { left })
}

/// X_s S, length k.
fn slopes<'g>(canonical: &Canonical<'g>, action: Expr<'g>) -> Vec<Expr<'g>> {
    let frame = canonical.system().frame();
    frame.contract(&canonical.system().graph().gradient(action, frame.coordinates()))
}

impl<'g> CompleteIntegral<'g> {
    /// The complete integral S = `action` with k constants α of the given names.
    ///
    /// # Errors
    /// [`AnalysisError::NotAnAction`] if S does not satisfy the [equation](hamilton_jacobi): its left-hand side
    /// is not folded to zero, and its numerical value exceeds rounding error;
    /// [`AnalysisError::IncompleteIntegral`] if det ∂(X_s S)/∂α_r = 0 at almost all points; [`ShapeError`] if
    /// there are not k constants and k coordinates; [`AnalysisError::Forced`];
    /// [`LagrangianError::NotQuadratic`](pc_mech::LagrangianError::NotQuadratic);
    /// [`ExprError::UnboundSymbol`](pc_mech::ExprError::UnboundSymbol).
    pub fn new(
        canonical: &Canonical<'g>,
        action: Expr<'g>,
        constants: &[&str],
    ) -> Result<CompleteIntegral<'g>, AnalysisError> {
        let (system, graph, k) = (canonical.system(), canonical.system().graph(), canonical.momenta().len());
        let x = system.frame().coordinates();
        for (what, found) in
            [("the list of constants", constants.len()), ("the list of coordinates", x.len())]
        {
            if found != k {
                return Err(MechError::from(ShapeError { what, found, expected: k }).into());
            }
        }
        let remainder = hamilton_jacobi(canonical, action)?;
        // Roots and arc functions of quotients obey more laws than the graph knows.
        if !Neighbourhood::anywhere(graph, &[remainder]).vanishes(graph, remainder) {
            return Err(AnalysisError::NotAnAction { remainder: remainder.to_string() });
        }
        let alpha: Vec<Expr<'g>> = constants.iter().map(|name| graph.symbol(name)).collect();
        let momenta = slopes(canonical, action);
        let rows: Vec<Vec<Expr<'g>>> = momenta.iter().map(|&y| graph.gradient(y, &alpha)).collect();
        let rank = graph.generic_rank(&rows);
        if rank < k {
            return Err(AnalysisError::IncompleteIntegral { rank, size: k });
        }
        let conjugates = graph.gradient(action, &alpha);
        let slopes = conjugates.iter().flat_map(|&f| graph.gradient(f, x));
        let outputs: Vec<Expr<'g>> =
            conjugates.iter().copied().chain(slopes).chain(momenta.clone()).collect();
        let parameters = system.parameters().iter().map(|&(symbol, _)| symbol);
        let inputs = Inputs {
            time: Some(system.frame().time()),
            state: x.to_vec(),
            parameters: parameters.chain(alpha).collect(),
        };
        Ok(CompleteIntegral {
            coordinates: x.iter().map(Expr::to_string).collect(),
            parameters: system.parameters().iter().map(|&(_, value)| value).collect(),
            values: Evaluator::new(Program::new(graph, &inputs, &outputs)?, Backend::Interpreter),
            conjugates,
            momenta,
        })
    }

    /// ∂S/∂α_s in terms of (t, x, α), length k: constant along every motion.
    pub fn conjugates(&self) -> &[Expr<'g>] {
        &self.conjugates
    }

    /// y_s = X_s S in terms of (t, x, α), length k.
    pub fn momenta(&self) -> &[Expr<'g>] {
        &self.momenta
    }

    /// The constants β_s = ∂S/∂α_s, length k, of the motion that is at x at time t; `x` and `alpha` have
    /// length k.
    ///
    /// # Errors
    /// [`ShapeError`]; [`ExprError::NotFinite`](pc_mech::ExprError::NotFinite) outside the domain of S.
    pub fn betas(&mut self, t: f64, x: &[f64], alpha: &[f64]) -> Result<Vec<f64>, AnalysisError> {
        let mut values = self.evaluate(t, x, alpha)?;
        values.truncate(alpha.len());
        Ok(values)
    }

    /// The state (x, y) at time t of the motion with the constants α, β, in the layout of the [canonical
    /// equations](Canonical::compile_for): ∂S/∂α_s = β_s is solved for x by Newton's method from `guess`; all
    /// have length k.
    ///
    /// S has several branches if it contains roots or inverse trigonometric functions; the position found
    /// is on the branch of the guess.
    ///
    /// # Errors
    /// [`AnalysisError::NoPosition`] with the best x found; otherwise as [`betas`](CompleteIntegral::betas) at
    /// the guess.
    pub fn state(
        &mut self,
        t: f64,
        alpha: &[f64],
        beta: &[f64],
        guess: &[f64],
    ) -> Result<Vec<f64>, AnalysisError> {
        let k = self.coordinates.len();
        shape("the list of constants β", beta.len(), k)?;
        let end = newton::solve(guess.to_vec(), MOST_STEPS, |x| {
            let values = self.evaluate(t, x, alpha)?;
            let difference = values.iter().zip(beta).map(|(value, beta)| value - beta).collect();
            Ok((difference, Matrix::from_fn(k, k, |s, i| values[k + s * k + i])))
        })?;
        if !end.is_solution(ENOUGH) {
            let residual = norm(&end.values);
            let coordinates = self.coordinates.iter().cloned().zip(end.point).collect();
            return Err(AnalysisError::NoPosition { residual, iterations: end.iterations, t, coordinates });
        }
        let values = self.evaluate(t, &end.point, alpha)?;
        Ok(end.point.into_iter().chain(values[k + k * k..].iter().copied()).collect())
    }

    fn evaluate(&mut self, t: f64, x: &[f64], alpha: &[f64]) -> Result<Vec<f64>, AnalysisError> {
        let k = self.coordinates.len();
        shape("the list of coordinates", x.len(), k)?;
        shape("the list of constants α", alpha.len(), k)?;
        let parameters: Vec<f64> = self.parameters.iter().chain(alpha).copied().collect();
        let mut values = vec![0.0; k * (k + 2)];
        self.values.eval(t, x, &parameters, &mut values);
        if values.iter().all(|value| value.is_finite()) {
            Ok(values)
        } else {
            Err(self.values.blame(t, x, &parameters).into())
        }
    }
}
