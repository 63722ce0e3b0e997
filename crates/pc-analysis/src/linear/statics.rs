//! The conditions of rest and of steady motion, with the reactions among the unknowns.

use pc_expr::{Backend, Evaluator, Inputs, Program};
use pc_mech::{Equations, Expr, Matrix, Multipliers};

use crate::error::AnalysisError;
use crate::numeric::program::values;

/// Rounding errors of a function relative to the effect of changes of its arguments by their own size.
const ROUNDING: f64 = 1e-14;

/// The conditions of a steady motion as functions of the state (x, η, z), the reactions λ, the accelerations η̇ and the
/// inputs,
///
///   ẋ = 0,   M η̇ − r − Cᵀ λ = 0,   g = 0,   ġ = 0,   ż = 0,
///
/// where g = 0 are the conditions on velocities. With the reactions among the unknowns (W. Karush, H. W. Kuhn, A. W.
/// Tucker), no mass matrix is inverted and no velocity is eliminated, so that the conditions are regular wherever the
/// constraints are; for a linear system they are linear.
#[derive(Clone, Debug)]
pub(super) struct Statics {
    /// The conditions, then their derivatives by all unknowns, row by row.
    conditions: Evaluator,
    /// The numbers of rows of each kind.
    coordinates: usize,
    velocities: usize,
    constraints: usize,
    states: usize,
    inputs: usize,
    /// For each constraint, whether its condition on velocities is needed while cyclic coordinates move, and while they
    /// rest: where no coordinate of a holonomic constraint moves, it is satisfied.
    binds_moving: Vec<bool>,
    binds_resting: Vec<bool>,
}

/// The unknowns of a search, and the conditions that apply.
#[derive(Clone, Debug)]
pub(super) struct Unknowns {
    /// The free components of the state.
    pub(super) components: Vec<usize>,
    /// The free inputs, by their places among the inputs.
    pub(super) inputs: Vec<usize>,
    /// The coordinates that may move.
    pub(super) moving: Vec<usize>,
    /// The quasi-velocities that may vary, as far as constraints make them.
    pub(super) varying: Vec<usize>,
}

/// The point at which the conditions are evaluated.
#[derive(Clone, Debug)]
pub(super) struct Balance {
    pub(super) state: Vec<f64>,
    /// η̇, zero except for the quasi-velocities that may vary.
    pub(super) accelerations: Vec<f64>,
    pub(super) reactions: Vec<f64>,
}

impl Statics {
    /// The conditions for `equations`, those of `multipliers` if there are any; `cyclic` are the coordinates that may move,
    /// and `inputs` some of the parameters of `of_state`, which are (t, y, p).
    pub(super) fn new<'g>(
        equations: &Equations<'g>,
        multipliers: Option<&Multipliers<'g>>,
        cyclic: &[usize],
        of_state: &Inputs<'g>,
        inputs: &[Expr<'g>],
    ) -> Result<Statics, AnalysisError> {
        let system = equations.system();
        let (graph, frame, eta) = (system.graph(), system.frame(), system.quasi_velocities());
        let accelerations = system.accelerations();
        let (x, x_dot) = (frame.coordinates(), equations.velocities());
        let along: Vec<(Expr<'g>, Expr<'g>)> = (x.iter().copied().zip(x_dot.iter().copied()))
            .chain(eta.iter().copied().zip(accelerations.iter().copied()))
            .chain(graph.in_time(frame.time()))
            .collect();

        let mut dynamics = equations.inverse_dynamics();
        let (mut positions, mut given) = (Vec::new(), Vec::new());
        if let Some(multipliers) = multipliers {
            let forces = multipliers.reaction_forces();
            dynamics = dynamics.into_iter().zip(forces).map(|(lacking, given)| lacking - given).collect();
            // Of ḟ = ∂f/∂x · ẋ, the part of the coordinates that may move; that of the others vanishes with their rates.
            let moving: Vec<(Expr<'g>, Expr<'g>)> = cyclic.iter().map(|&i| (x[i], x_dot[i])).collect();
            for (a, constraint) in multipliers.constraints().iter().enumerate() {
                let position = multipliers.is_holonomic(a).then(|| constraint.expression());
                given.push(match position {
                    Some(f) if moving.is_empty() => graph.directional(&[f], &graph.in_time(frame.time()))[0],
                    Some(f) => graph.directional(&[f], &moving)[0],
                    None => multipliers.velocities()[a],
                });
                positions.push(position.is_some());
            }
        }
        let reactions = multipliers.map_or(&[][..], Multipliers::reactions);
        let rates = multipliers.map(|all| graph.directional(all.velocities(), &along)).unwrap_or_default();
        let states: Vec<Expr<'g>> = system.states().iter().map(|&(_, rate)| rate).collect();
        let all = [x_dot, &dynamics, &given, &rates, &states].concat();

        let known = [&of_state.state[..], &accelerations, reactions].concat();
        let by = [&known[..], inputs].concat();
        let slopes: Vec<Expr<'g>> = all.iter().flat_map(|&f| graph.gradient(f, &by)).collect();
        let program = Inputs { state: known, ..of_state.clone() };
        Ok(Statics {
            conditions: Evaluator::new(
                Program::new(graph, &program, &[all, slopes].concat())?,
                Backend::Interpreter,
            ),
            coordinates: x.len(),
            velocities: eta.len(),
            constraints: reactions.len(),
            states: states.len(),
            inputs: inputs.len(),
            binds_moving: given.iter().map(|g| !g.is_zero()).collect(),
            binds_resting: positions.iter().map(|is_position| !is_position).collect(),
        })
    }

    /// The number of reactions.
    pub(super) fn reactions(&self) -> usize {
        self.constraints
    }

    /// The conditions that apply at a point, and their slopes by the free components, the free inputs, the reactions and
    /// the accelerations of the velocities that may vary.
    pub(super) fn at(
        &mut self,
        t: f64,
        point: &Balance,
        parameters: &[f64],
        unknowns: &Unknowns,
    ) -> Result<(Vec<f64>, Matrix<f64>), AnalysisError> {
        let (n, k, m) = (self.coordinates, self.velocities, self.constraints);
        let known = [&point.state[..], &point.accelerations, &point.reactions].concat();
        let numbers = values(&mut self.conditions, t, &known, parameters)?;
        let count = n + k + 2 * m + self.states;
        let (all, slopes) = numbers.split_at(count);
        let width = known.len() + self.inputs;

        let is_moving = |i: &usize| unknowns.moving.contains(i);
        let binds = if unknowns.moving.is_empty() { &self.binds_resting } else { &self.binds_moving };
        let rows: Vec<usize> = (0..n)
            .filter(|i| !is_moving(i))
            .chain(n..n + k)
            .chain((0..m).filter(|&a| binds[a]).map(|a| n + k + a))
            .chain((0..m).filter(|_| !unknowns.varying.is_empty()).map(|a| n + k + m + a))
            .chain(n + k + 2 * m..count)
            .collect();
        let size = point.state.len();
        let columns: Vec<usize> = (unknowns.components.iter().copied())
            .chain(unknowns.inputs.iter().map(|&j| known.len() + j))
            .chain((0..m).map(|a| size + k + a))
            .chain(unknowns.varying.iter().map(|&s| size + s))
            .collect();
        let slope = |i: usize, j: usize| slopes[rows[i] * width + columns[j]];
        let value = |&row: &usize| {
            let by_known = &slopes[row * width..][..known.len()];
            let is_given = columns.iter().all(|&j| slopes[row * width + j] == 0.0);
            if is_given { without_rounding(all[row], by_known, &known) } else { all[row] }
        };
        Ok((rows.iter().map(value).collect(), Matrix::from_fn(rows.len(), columns.len(), slope)))
    }
}

/// A value on which no unknown acts, zero if it is below the rounding errors of a function with these slopes.
pub(super) fn without_rounding(value: f64, slopes: &[f64], point: &[f64]) -> f64 {
    let size: f64 = slopes.iter().zip(point).map(|(slope, z)| slope.abs() * (1.0 + z.abs())).sum();
    if value.abs() <= ROUNDING * size { 0.0 } else { value }
}
