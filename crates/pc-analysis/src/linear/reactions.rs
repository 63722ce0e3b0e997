//! Reactions near a state, determined from the accelerations there.

use pc_expr::{Backend, Evaluator, Inputs, Program};
use pc_mech::{Expr, LeastSquares, Matrix, Multipliers};

use crate::error::AnalysisError;
use crate::linear::leaf::ZERO;
use crate::numeric::dense::product;
use crate::numeric::program::values;

/// The reactions λ of M η̇ = r + Cᵀ λ with their derivatives, given η̇ with its derivatives. The forces F = M
/// η̇ − r − Cᵀ λ vanish at a state and near it, so that
///
///   Cᵀ λ = M η̇ − r,   Cᵀ δλ = (∂F/∂y) δy + M δη̇ + (∂F/∂u) δu,
///
/// Each of the two is a system of k equations, of rank m if the constraints are independent; they alone
/// determine λ.
#[derive(Clone, Debug)]
pub(super) struct Reactions {
    /// C (m × k), then M η̇ − r, from (t, (y, η̇), p).
    balance: Evaluator,
    /// ∂F/∂(y, η̇, u), k rows, from (t, (y, η̇, λ), p).
    slopes: Evaluator,
    /// m, k.
    size: (usize, usize),
    /// The names of the outputs that contain λ.
    outputs: Vec<String>,
}

/// λ with its derivatives at a state.
pub(super) struct Reacting {
    pub(super) values: Vec<f64>,
    /// ∂λ/∂y
    pub(super) by_state: Matrix<f64>,
    /// ∂λ/∂u
    pub(super) by_inputs: Matrix<f64>,
}

impl Reactions {
    /// The names of the outputs that contain reactions.
    pub(super) fn observed(multipliers: &Multipliers<'_>) -> Vec<String> {
        let outputs = multipliers.equations().system().outputs().iter();
        let reacts = |f: &Expr<'_>| multipliers.reactions().iter().any(|&reaction| f.depends_on(reaction));
        outputs.filter(|(_, f)| reacts(f)).map(|(name, _)| name.clone()).collect()
    }

    /// The reactions of `multipliers` in these `outputs`; `of_state` is (t, y, p), and `inputs` are some of
    /// the parameters.
    pub(super) fn new<'g>(
        multipliers: &Multipliers<'g>,
        outputs: Vec<String>,
        of_state: &Inputs<'g>,
        inputs: &[Expr<'g>],
    ) -> Result<Reactions, AnalysisError> {
        let (equations, c) = (multipliers.equations(), multipliers.coefficients());
        let (graph, accelerations) = (equations.system().graph(), equations.system().accelerations());
        let lacking = equations.inverse_dynamics();
        let given = multipliers.reaction_forces();
        let forces: Vec<Expr<'g>> =
            lacking.iter().zip(given).map(|(&lacking, given)| lacking - given).collect();
        let known = [&of_state.state[..], &accelerations].concat();
        let by = [&known[..], inputs].concat();
        let slopes: Vec<Expr<'g>> = forces.iter().flat_map(|&force| graph.gradient(force, &by)).collect();
        let at = |state: Vec<Expr<'g>>| Inputs { state, ..of_state.clone() };
        let evaluator = |inputs: &Inputs<'g>, outputs: &[Expr<'g>]| -> Result<Evaluator, AnalysisError> {
            Ok(Evaluator::new(Program::new(graph, inputs, outputs)?, Backend::Interpreter))
        };
        Ok(Reactions {
            slopes: evaluator(&at([&known[..], multipliers.reactions()].concat()), &slopes)?,
            balance: evaluator(&at(known), &[&c.entries()[..], &lacking].concat())?,
            size: (c.rows(), c.columns()),
            outputs,
        })
    }

    /// λ and its derivatives at (t, y), a state with these names, for the given η̇ with its derivatives with
    /// respect to the state and the inputs.
    ///
    /// # Errors
    /// [`AnalysisError::ReactionsUndetermined`] if the constraints are dependent.
    pub(super) fn at(
        &mut self,
        (t, y, parameters): (f64, &[f64], &[f64]),
        (accelerations, by_state, by_inputs): (&[f64], &Matrix<f64>, &Matrix<f64>),
        names: &[String],
    ) -> Result<Reacting, AnalysisError> {
        let (m, k) = self.size;
        let known = [y, accelerations].concat();
        let numbers = values(&mut self.balance, t, &known, parameters)?;
        let (c, lacking) = numbers.split_at(m * k);
        let transposed = LeastSquares::of(&Matrix::from_fn(k, m, |s, a| c[a * k + s]))?;
        if transposed.rank(ZERO) < m {
            let state = names.iter().cloned().zip(y.iter().copied()).collect();
            return Err(AnalysisError::ReactionsUndetermined { outputs: self.outputs.clone(), state });
        }
        let reactions = transposed.shortest(lacking, ZERO);
        let slopes = values(&mut self.slopes, t, &[&known[..], &reactions].concat(), parameters)?;
        let columns = known.len() + by_inputs.columns();
        let part =
            |from: usize, width: usize| Matrix::from_fn(k, width, |s, j| slopes[s * columns + from + j]);
        let mass = part(y.len(), k);
        let solved = |own: &Matrix<f64>, of_accelerations: &Matrix<f64>| {
            let moved = product(&mass, of_accelerations);
            let column = |j: usize| (0..k).map(|s| own[(s, j)] + moved[(s, j)]).collect::<Vec<f64>>();
            let columns: Vec<Vec<f64>> =
                (0..own.columns()).map(|j| transposed.shortest(&column(j), ZERO)).collect();
            Matrix::from_fn(m, columns.len(), |a, j| columns[j][a])
        };
        Ok(Reacting {
            by_state: solved(&part(0, y.len()), by_state),
            by_inputs: solved(&part(known.len(), by_inputs.columns()), by_inputs),
            values: reactions,
        })
    }
}
