//! Motions from a complete integral, by Jacobi's theorem.

use pc_expr::{Evaluator, Inputs, Program};
use pc_mech::{Backend, Canonical, Expr, Matrix, MechError, Neighbourhood, ShapeError};

use crate::error::{AnalysisError, shape};
use crate::hamilton_jacobi::orbit::Orbit;
use crate::hamilton_jacobi::{remainder_on, slopes};
use crate::numeric::{dense::norm, newton};

/// The largest number of steps of Newton's method for one position.
const MOST_STEPS: usize = 100;
/// The residual that counts as zero, relative to |∂F/∂x| (1 + |x|).
const ENOUGH: f64 = 1e-12;
/// The multiples of the given constants from which those of a motion are sought.
const MULTIPLES: [f64; 7] = [1.0, 1.5, 3.0, 10.0, 0.5, 0.1, -1.0];

/// A complete integral S(t, x, α) of Hamilton–Jacobi's equation, from which the motions follow by Jacobi's
/// theorem:
///
///   ∂S/∂α_s = β_s,   y_r = X_r S,   s = 1..rank b,   r = 1..k,
///
/// satisfy the canonical equations (10), (11) for any constants α, β. On an [orbit](Orbit) of an intransitive group the
/// invariants f_a = c_a complete these equations for x.
#[derive(Clone, Debug)]
pub struct CompleteIntegral<'g> {
    coordinates: Vec<String>,
    constants: Vec<String>,
    parameters: Vec<f64>,
    conjugates: Vec<Expr<'g>>,
    momenta: Vec<Expr<'g>>,
    levels: Vec<f64>,
    values: Evaluator,
}

/// What is evaluated at (t, x, α).
pub(super) struct Values {
    /// ∂S/∂α, length r.
    pub(super) conjugates: Vec<f64>,
    /// f_a, length n − r.
    invariants: Vec<f64>,
    /// ∂²S/∂α∂x, then ∂f/∂x, n × n.
    pub(super) slopes: Matrix<f64>,
    /// X_s S, length k.
    pub(super) momenta: Vec<f64>,
    /// ∂(X_s S)/∂α, k × r.
    of_constants: Matrix<f64>,
    /// ẋ by (11), length n.
    pub(super) velocities: Vec<f64>,
}

impl<'g> CompleteIntegral<'g> {
    /// The complete integral S = `action` with n constants α of the given names, for a frame of rank n.
    ///
    /// # Errors
    /// As for [`on_orbit`](CompleteIntegral::on_orbit), and [`AnalysisError::OrbitUnknown`] if rank b < n.
    pub fn new(
        canonical: &Canonical<'g>,
        action: Expr<'g>,
        constants: &[&str],
    ) -> Result<CompleteIntegral<'g>, AnalysisError> {
        CompleteIntegral::on_orbit(
            canonical,
            action,
            constants,
            &Orbit::through(canonical.system(), &[], &[])?,
        )
    }

    /// The complete integral S = `action` on an orbit, with as many constants α as the orbit has dimensions.
    ///
    /// # Errors
    /// [`AnalysisError::NotAnAction`] if S does not satisfy the [equation](crate::hamilton_jacobi) on the orbit: its left-hand
    /// side is not folded to zero, and its numerical value exceeds rounding error;
    /// [`AnalysisError::IncompleteIntegral`] if the rank of ∂(X_s S)/∂α_r is below that of b at almost all points;
    /// [`ShapeError`] if there are more or fewer constants; [`AnalysisError::Forced`];
    /// [`LagrangianError::NotQuadratic`](pc_mech::LagrangianError::NotQuadratic);
    /// [`ExprError::UnboundSymbol`](pc_mech::ExprError::UnboundSymbol).
    pub fn on_orbit(
        canonical: &Canonical<'g>,
        action: Expr<'g>,
        constants: &[&str],
        orbit: &Orbit<'g>,
    ) -> Result<CompleteIntegral<'g>, AnalysisError> {
        let graph = canonical.system().graph();
        let dimension = orbit.dimension();
        if constants.len() != dimension {
            let what = "the list of constants";
            return Err(
                MechError::from(ShapeError { what, found: constants.len(), expected: dimension }).into()
            );
        }
        let remainder = orbit.restricted(graph, &[remainder_on(canonical, action, orbit)?])[0];
        // Roots and arc functions of quotients obey more laws than the graph knows.
        if !Neighbourhood::anywhere(graph, &[remainder]).vanishes(graph, remainder) {
            return Err(AnalysisError::NotAnAction { remainder: remainder.to_string() });
        }
        let alpha: Vec<Expr<'g>> = constants.iter().map(|name| graph.symbol(name)).collect();
        let rows: Vec<Vec<Expr<'g>>> = slopes(canonical, action)
            .into_iter()
            .map(|y| orbit.restricted(graph, &graph.gradient(y, &alpha)))
            .collect();
        let rank = graph.generic_rank(&rows);
        if rank < dimension {
            return Err(AnalysisError::IncompleteIntegral { rank, size: dimension });
        }
        CompleteIntegral::of_known(canonical, action, &alpha, orbit)
    }

    /// The complete integral of an action that is known to be one.
    pub(super) fn of_known(
        canonical: &Canonical<'g>,
        action: Expr<'g>,
        alpha: &[Expr<'g>],
        orbit: &Orbit<'g>,
    ) -> Result<CompleteIntegral<'g>, AnalysisError> {
        let (system, graph) = (canonical.system(), canonical.system().graph());
        let x = system.frame().coordinates();
        let momenta = slopes(canonical, action);
        let of_constants: Vec<Vec<Expr<'g>>> = momenta.iter().map(|&y| graph.gradient(y, alpha)).collect();
        let conjugates = graph.gradient(action, alpha);
        let invariants: Vec<Expr<'g>> = orbit.invariants().iter().map(|&(f, _)| f).collect();
        let functions = [conjugates.clone(), invariants].concat();
        let known: Vec<_> = canonical.momenta().iter().copied().zip(momenta.iter().copied()).collect();
        let outputs = [
            functions.clone(),
            functions.iter().flat_map(|&f| graph.gradient(f, x)).collect(),
            momenta.clone(),
            of_constants.concat(),
            graph.substitute(canonical.velocities(), &known),
        ];
        let parameters = system.parameters().iter().map(|&(symbol, _)| symbol);
        let inputs = Inputs {
            time: Some(system.frame().time()),
            state: x.to_vec(),
            parameters: parameters.chain(alpha.iter().copied()).collect(),
        };
        Ok(CompleteIntegral {
            coordinates: x.iter().map(Expr::to_string).collect(),
            constants: alpha.iter().map(Expr::to_string).collect(),
            parameters: system.parameters().iter().map(|&(_, value)| value).collect(),
            levels: orbit.invariants().iter().map(|&(_, value)| value).collect(),
            values: Evaluator::new(Program::new(graph, &inputs, &outputs.concat())?, Backend::Interpreter),
            conjugates,
            momenta,
        })
    }

    /// ∂S/∂α_s in terms of (t, x, α), length rank b: constant along every motion.
    pub fn conjugates(&self) -> &[Expr<'g>] {
        &self.conjugates
    }

    /// y_s = X_s S in terms of (t, x, α), length k.
    pub fn momenta(&self) -> &[Expr<'g>] {
        &self.momenta
    }

    /// The constants β_s = ∂S/∂α_s, length rank b, of the motion that is at x at time t; `x` has length n and `alpha` rank b.
    ///
    /// # Errors
    /// [`ShapeError`]; [`ExprError::NotFinite`](pc_mech::ExprError::NotFinite) outside the domain of S.
    pub fn betas(&mut self, t: f64, x: &[f64], alpha: &[f64]) -> Result<Vec<f64>, AnalysisError> {
        Ok(self.evaluate(t, x, alpha)?.conjugates)
    }

    /// The constants α of the motion that is in the state (x, y) at time t: y_s = X_s S is solved for them by Newton's method
    /// from `guess` and multiples of it.
    ///
    /// # Errors
    /// [`AnalysisError::NoConstants`] if no solution is found, as on another branch of S, or where S has no motion through this
    /// state because λ_s y_s ≠ 0 for a [relation](Orbit::relations) λ_s X_s = 0; [`ShapeError`].
    pub fn alphas(
        &mut self,
        t: f64,
        (x, y): (&[f64], &[f64]),
        guess: &[f64],
    ) -> Result<Vec<f64>, AnalysisError> {
        shape("the list of momenta", y.len(), self.momenta.len())?;
        shape("the list of constants α", guess.len(), self.constants.len())?;
        shape("the list of coordinates", x.len(), self.coordinates.len())?;
        let mut best = (f64::INFINITY, guess.to_vec());
        for multiple in MULTIPLES {
            let from: Vec<f64> = guess.iter().map(|alpha| multiple * alpha).collect();
            let end = newton::solve(from, MOST_STEPS, |alpha| {
                let values = self.evaluate(t, x, alpha)?;
                let difference = values.momenta.iter().zip(y).map(|(value, y)| value - y).collect();
                Ok((difference, values.of_constants))
            });
            let Ok(end) = end else { continue };
            if end.is_solution(ENOUGH) {
                return Ok(end.point);
            }
            let residual = norm(&end.values);
            if residual < best.0 {
                best = (residual, end.point);
            }
        }
        let constants = self.constants.iter().cloned().zip(best.1).collect();
        Err(AnalysisError::NoConstants { residual: best.0, t, constants })
    }

    /// The state (x, y) at time t of the motion with the constants α, β, in the layout of the [canonical
    /// equations](Canonical::compile_for): ∂S/∂α_s = β_s is solved for x by Newton's method from `guess`, of length n; α and β
    /// have length rank b.
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
        let (x, values) = self.position(t, (alpha, beta), guess)?;
        Ok(x.into_iter().chain(values.momenta).collect())
    }

    /// The position at time t, as for [`state`](CompleteIntegral::state), with all values there.
    pub(super) fn position(
        &mut self,
        t: f64,
        (alpha, beta): (&[f64], &[f64]),
        guess: &[f64],
    ) -> Result<(Vec<f64>, Values), AnalysisError> {
        shape("the list of constants β", beta.len(), self.constants.len())?;
        let end = newton::solve(guess.to_vec(), MOST_STEPS, |x| {
            let values = self.evaluate(t, x, alpha)?;
            let found = values.conjugates.iter().chain(&values.invariants);
            let wanted = beta.iter().chain(&self.levels);
            let difference = found.zip(wanted).map(|(value, wanted)| value - wanted).collect();
            Ok((difference, values.slopes))
        })?;
        if !end.is_solution(ENOUGH) {
            let residual = norm(&end.values);
            let coordinates = self.coordinates.iter().cloned().zip(end.point).collect();
            return Err(AnalysisError::NoPosition { residual, iterations: end.iterations, t, coordinates });
        }
        let values = self.evaluate(t, &end.point, alpha)?;
        Ok((end.point, values))
    }

    /// The names of the coordinates with these values.
    pub(super) fn named(&self, x: &[f64]) -> Vec<(String, f64)> {
        self.coordinates.iter().cloned().zip(x.iter().copied()).collect()
    }

    pub(super) fn evaluate(&mut self, t: f64, x: &[f64], alpha: &[f64]) -> Result<Values, AnalysisError> {
        let (n, k, r) = (self.coordinates.len(), self.momenta.len(), self.constants.len());
        shape("the list of coordinates", x.len(), n)?;
        shape("the list of constants α", alpha.len(), r)?;
        let parameters: Vec<f64> = self.parameters.iter().chain(alpha).copied().collect();
        let mut values = vec![0.0; n + n * n + k + k * r + n];
        self.values.eval(t, x, &parameters, &mut values);
        if !values.iter().all(|value| value.is_finite()) {
            return Err(self.values.blame(t, x, &parameters).into());
        }
        let (functions, rest) = values.split_at(n);
        let (slopes, rest) = rest.split_at(n * n);
        let (momenta, rest) = rest.split_at(k);
        let (of_constants, velocities) = rest.split_at(k * r);
        Ok(Values {
            conjugates: functions[..r].to_vec(),
            invariants: functions[r..].to_vec(),
            slopes: Matrix::from_fn(n, n, |a, i| slopes[a * n + i]),
            momenta: momenta.to_vec(),
            of_constants: Matrix::from_fn(k, r, |s, a| of_constants[s * r + a]),
            velocities: velocities.to_vec(),
        })
    }
}
