//! The derivatives of a motion, compiled once and evaluated at any state.

use std::ops::Range;

use pc_expr::{Backend, Deadline, Evaluator, Inputs, Program};
use pc_mech::{CompileOptions, Equations, Expr, Graph, Matrix, Motion, Multipliers, System, VectorField};

use crate::error::{AnalysisError, check_variables};
use crate::integrals::search::rank_of_gradients;
use crate::linear::leaf::{Directions, Velocities};
use crate::linear::reactions::Reactions;
use crate::linear::statics::Statics;
use crate::numeric::dense::{norm, product};
use crate::numeric::equilibrated::{aside, larger};
use crate::numeric::program::{values, values_or_not};
use crate::stability::steady_motion::{cyclic_coordinates, first_approximation};
use crate::stability::steady_search::{is_autonomous, names_time};

/// The states that a motion can reach from its start.
#[derive(Clone, Debug)]
pub struct Leaf<'g> {
    /// The system with all quasi-velocities, including those that constraints make vanish: its frame is
    /// integrable.
    pub whole: System<'g>,
    /// The functions f in the conditions f(x) = 0 that the constraints imply.
    pub positions: Vec<Expr<'g>>,
    /// Functions of the coordinates alone that keep their initial values, such as the length of a quaternion.
    pub kept: Vec<Expr<'g>>,
}

impl<'g> Leaf<'g> {
    /// The leaf that consists of all states, for a system without constraints whose coordinates are
    /// independent.
    pub fn of(system: &System<'g>) -> Leaf<'g> {
        Leaf { whole: system.clone(), positions: Vec::new(), kept: Vec::new() }
    }

    /// The number of functions of the coordinates that are constant along all motions in the frame, n − rank
    /// b.
    pub fn codimension(&self) -> usize {
        self.whole.frame().coordinates().len() - self.whole.frame().rank()
    }
}

/// Linearizes the equations of motion, ẏ = f(t, y, u) with outputs h(t, y, u), using derivatives from the
/// graph.
///
/// ```
/// use pc_analysis::{Leaf, Linearizer, SteadyOptions};
/// use pc_mech::{Graph, System};
///
/// // An inverted pendulum with a torque: θ̈ = g sin θ + u.
/// let graph = Graph::new();
/// let [g, u] = graph.symbols(["g", "u"]);
/// let pendulum = System::builder(&graph)
///     .parameter(g, 9.0)
///     .parameter(u, 0.0)
///     .coordinates(["θ"])
///     .lagrangian(|_, x, v| v[0].square() / 2.0 - g * x[0].cos())
///     .forces(|_, _, _| [u])
///     .build()?;
/// let mut linearizer = Linearizer::new(&pendulum.poincare()?, &Leaf::of(&pendulum), &["u"])?;
/// let upright = linearizer.steady(0.0, &[0.2, 0.0], &SteadyOptions::default())?;
/// assert_eq!(upright.components, ["θ", "θ'"]);
/// assert_eq!(upright.state_matrix.to_rows(), [[0.0, 1.0], [9.0, 0.0]]);
/// assert_eq!(upright.input_matrix.to_rows(), [[0.0], [1.0]]);
/// let second_order = upright.second_order?;
/// assert_eq!((second_order.mass[(0, 0)], second_order.stiffness[(0, 0)]), (1.0, -9.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Linearizer {
    pub(super) motion: Motion,
    pub(super) cyclic: Vec<usize>,
    /// The quasi-velocities that nonholonomic constraints make depend on the others, by their indices among the
    /// quasi-velocities: where the others are constant, these need not be.
    pub(super) dependent: Vec<usize>,
    /// Whether rates depend on time, for the present values of the parameters and, in `names_time`, for any
    /// values.
    depends_on_time: bool,
    names_time: bool,
    /// The names of the inputs and their indices among the parameters.
    pub(super) inputs: Vec<(String, usize)>,
    outputs: Vec<String>,
    /// The position constraints, the kept functions and the conditions on velocities, then their slopes.
    surface: Evaluator,
    /// b
    frame: Evaluator,
    /// b and M.
    parts: Evaluator,
    /// The outputs, and their derivatives by the state, the accelerations, the reactions and the inputs.
    observed: Evaluator,
    /// The conditions of steady motion.
    pub(super) statics: Statics,
    /// The reactions that occur in the outputs.
    reactions: Option<Reactions>,
    pub(super) sizes: Sizes,
    /// Whether a state is at rest if its quasi-velocities are zero: b_0 = 0.
    pub(super) rests_at_zero: bool,
    /// Whether all functions that are constant along the motions in the frame are known.
    pub(super) is_leaf_known: bool,
    /// The units in which the components of the state are measured.
    pub(super) units: Vec<f64>,
    /// When searches have to end, if ever.
    pub(super) until: Option<Deadline>,
}

/// The numbers of components of all parts.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sizes {
    pub(super) coordinates: usize,
    /// The number of quasi-velocities in the state, and, in `whole`, their total number.
    pub(super) velocities: usize,
    whole: usize,
    /// The number of rows of the mass matrix; 0 for a large tree.
    mass: usize,
    pub(super) positions: usize,
    pub(super) kept: usize,
    /// The number of conditions on the velocities.
    conditions: usize,
}

/// The parts, evaluated at a state.
pub(super) struct Evaluated {
    /// ∂f/∂y
    pub(super) jacobian: Matrix<f64>,
    /// ∂f/∂u
    pub(super) by_inputs: Matrix<f64>,
    pub(super) mass: Option<Matrix<f64>>,
    pub(super) directions: Directions,
    pub(super) velocities: Velocities,
    /// h
    pub(super) output_values: Vec<f64>,
    /// ∂h/∂y and ∂h/∂u with the accelerations substituted.
    pub(super) outputs: Matrix<f64>,
    pub(super) outputs_by_inputs: Matrix<f64>,
}

/// How far from a state typical sizes of slopes are taken.
const ASIDE: f64 = 0.05;

impl Linearizer {
    /// Linearizes equations in independent quasi-velocities; `inputs` names the parameters that are inputs, or symbols of
    /// [external forces](pc_mech::System::external_forces).
    ///
    /// # Errors
    /// [`AnalysisError::UnknownComponent`] for an input that is not a parameter; otherwise as
    /// [`Equations::compile`](pc_mech::Equations::compile).
    pub fn new<'g>(
        equations: &Equations<'g>,
        leaf: &Leaf<'g>,
        inputs: &[&str],
    ) -> Result<Linearizer, AnalysisError> {
        let options = CompileOptions::default().parameter_jacobian(!inputs.is_empty());
        Linearizer::of(equations.compile_for(options)?, equations, leaf, None, inputs)
    }

    /// Linearizes equations with multipliers, which are regular wherever the constraints are. No choice of
    /// independent velocities is regular everywhere: ẏ, for example, is not at the lowest point of a circle.
    ///
    /// Under nonholonomic constraints, the [dependent](Multipliers::dependent) velocities of a steady motion may vary, as
    /// those of a wheel along fixed axes do in a turn.
    ///
    /// # Errors
    /// As [`new`](Linearizer::new).
    pub fn with_multipliers<'g>(
        multipliers: &Multipliers<'g>,
        leaf: &Leaf<'g>,
        inputs: &[&str],
    ) -> Result<Linearizer, AnalysisError> {
        let options = CompileOptions::default().parameter_jacobian(!inputs.is_empty());
        let motion = multipliers.compile_for(options)?;
        Linearizer::of(motion, multipliers.equations(), leaf, Some(multipliers), inputs)
    }

    /// As [`new`](Linearizer::new), with `multipliers` if these enforce conditions on the velocities.
    fn of<'g>(
        motion: Motion,
        equations: &Equations<'g>,
        leaf: &Leaf<'g>,
        multipliers: Option<&Multipliers<'g>>,
        inputs: &[&str],
    ) -> Result<Linearizer, AnalysisError> {
        let (system, graph) = (equations.system(), equations.system().graph());
        let conditions = multipliers.map_or(&[][..], Multipliers::velocities);
        let own = system.parameters().iter().map(|(symbol, _)| symbol);
        let names: Vec<String> = own
            .chain(system.external_forces().iter().map(|(_, symbol)| symbol))
            .map(Expr::to_string)
            .collect();
        let place = |&input: &&str| match names.iter().position(|name| name == input) {
            Some(place) => Ok((input.to_owned(), place)),
            None => Err(AnalysisError::UnknownComponent { name: input.to_owned(), known: names.clone() }),
        };
        let inputs = inputs.iter().map(place).collect::<Result<Vec<_>, _>>()?;
        let x = system.frame().coordinates();
        let relations = [&leaf.positions[..], &leaf.kept].concat();
        let candidates: Vec<usize> =
            (0..x.len()).filter(|&i| !conditions.iter().any(|g| g.depends_on(x[i]))).collect();
        let cyclic = motion.sparsity().map(|pattern| {
            let cyclic = cyclic_coordinates(pattern, &candidates);
            undetermined(graph, &relations, x, &cyclic)
        });
        let cyclic = cyclic.unwrap_or_default();

        let state = system.state();
        let functions: Vec<Expr<'g>> =
            leaf.positions.iter().chain(&leaf.kept).chain(conditions).copied().collect();
        let moving = [x, system.quasi_velocities()].concat();
        let slopes = functions.iter().flat_map(|&f| graph.gradient(f, &moving));
        let external = system.external_forces().iter().map(|&(_, symbol)| symbol);
        let parameters: Vec<Expr<'g>> =
            system.parameters().iter().map(|&(symbol, _)| symbol).chain(external).collect();
        let accelerations = system.accelerations();
        let time = Some(system.frame().time());
        let of_state = Inputs { time, state: state.clone(), parameters: parameters.clone() };
        let surface: Vec<Expr<'g>> = functions.iter().copied().chain(slopes).collect();
        let b = leaf.whole.frame().b();
        let is_large = system.large_tree().is_some();
        let mass = match is_large {
            true => Vec::new(),
            false => equations.mass_matrix().to_rows().concat(),
        };
        let of_outputs = |by: &[Expr<'g>]| -> Vec<Expr<'g>> {
            system.outputs().iter().flat_map(|&(_, h)| graph.gradient(h, by)).collect()
        };
        let symbols: Vec<Expr<'g>> = inputs.iter().map(|&(_, place)| parameters[place]).collect();
        let outputs: Vec<Expr<'g>> = system.outputs().iter().map(|&(_, h)| h).collect();
        let reacting =
            multipliers.map(|all| (all, Reactions::observed(all))).filter(|(_, list)| !list.is_empty());
        let reactions = reacting.as_ref().map_or(&[][..], |(all, _)| all.reactions());
        let with_unknowns =
            Inputs { state: [&state, &accelerations, reactions].concat(), ..of_state.clone() };
        let known = [&with_unknowns.state[..], &parameters, &[system.frame().time()]].concat();
        check_variables("an output", graph, &outputs, &known)?;
        let parts = [b.to_rows().concat(), mass];
        let observed = [
            outputs,
            of_outputs(&state),
            of_outputs(&accelerations),
            of_outputs(reactions),
            of_outputs(&symbols),
        ];
        let evaluator = |inputs: &Inputs<'g>, outputs: &[Expr<'g>]| -> Result<Evaluator, AnalysisError> {
            Ok(Evaluator::new(Program::new(graph, inputs, outputs)?, Backend::Interpreter))
        };
        let sizes = Sizes {
            coordinates: x.len(),
            velocities: system.quasi_velocities().len(),
            whole: b.columns(),
            mass: if is_large { 0 } else { system.quasi_velocities().len() },
            positions: leaf.positions.len(),
            kept: leaf.kept.len(),
            conditions: conditions.len(),
        };
        let is_timed = conditions.iter().any(|g| g.depends_on(system.frame().time()));
        Ok(Linearizer {
            until: None,
            surface: evaluator(&of_state, &surface)?,
            frame: evaluator(&of_state, &b.to_rows().concat())?,
            parts: evaluator(&with_unknowns, &parts.concat())?,
            observed: evaluator(&with_unknowns, &observed.concat())?,
            statics: Statics::new(equations, multipliers, &cyclic, &of_state, &symbols)?,
            reactions: reacting
                .map(|(all, list)| Reactions::new(all, list, &of_state, &symbols))
                .transpose()?,
            depends_on_time: is_timed || !is_autonomous(equations),
            names_time: is_timed || names_time(equations),
            outputs: system.outputs().iter().map(|(name, _)| name.clone()).collect(),
            is_leaf_known: leaf.codimension() == 0
                || rank_of_gradients(graph, &leaf.kept, x) >= leaf.codimension(),
            rests_at_zero: system.frame().b0().iter().all(|b| b.is_zero()),
            dependent: multipliers.map(following).unwrap_or_default(),
            units: vec![1.0; state.len()],
            sizes,
            motion,
            cyclic,
            inputs,
        })
    }

    /// The names of the components of the state.
    pub fn names(&self) -> &[String] {
        self.motion.names()
    }

    /// The range of the quasi-velocities in the state.
    pub fn quasi_velocities(&self) -> Range<usize> {
        self.sizes.coordinates..self.sizes.coordinates + self.sizes.velocities
    }

    /// The names of the cyclic coordinates, on which no rates depend except those of cyclic ones, and which no relation
    /// ties to the others.
    pub fn cyclic(&self) -> Vec<String> {
        self.cyclic.iter().map(|&i| self.motion.names()[i].clone()).collect()
    }

    /// The names of the quasi-velocities, if they are zero at rest.
    pub(super) fn zero_at_rest(&self) -> Vec<String> {
        let velocities = if self.rests_at_zero { self.quasi_velocities() } else { 0..0 };
        self.names()[velocities].to_vec()
    }

    /// The components whose rates need not vanish in a steady motion, apart from the cyclic coordinates.
    pub(super) fn varying(&self) -> Vec<usize> {
        self.dependent.iter().map(|s| self.sizes.coordinates + s).collect()
    }

    /// The names of the inputs.
    pub fn inputs(&self) -> Vec<String> {
        self.inputs.iter().map(|(name, _)| name.clone()).collect()
    }

    /// The names of the outputs.
    pub fn outputs(&self) -> &[String] {
        &self.outputs
    }

    /// Whether the rates depend on time explicitly.
    pub fn depends_on_time(&self) -> bool {
        self.depends_on_time
    }

    /// Gives the parameters, and then the external forces, other values, in the order of declaration.
    ///
    /// # Panics
    /// If there are more values than the equations have parameters and external forces.
    pub fn set_parameters(&mut self, values: &[f64]) {
        let parameters = &mut self.motion.parameters_mut()[..values.len()];
        if parameters != values {
            parameters.copy_from_slice(values);
            // A vanishing factor may have become nonzero.
            self.depends_on_time = self.names_time;
        }
    }

    /// Checks that a search for equilibria is possible.
    ///
    /// # Errors
    /// [`AnalysisError::DependsOnTime`], [`AnalysisError::LeafUnknown`].
    pub(super) fn check_searchable(&mut self, t: f64, start: &[f64]) -> Result<(), AnalysisError> {
        if self.depends_on_time {
            return Err(AnalysisError::DependsOnTime);
        }
        match self.is_leaf_known {
            true => Ok(()),
            false => Err(AnalysisError::LeafUnknown { residual: norm(&self.motion.rates(t, start)?) }),
        }
    }

    /// The values of the position constraints, followed by those of the kept functions and the conditions on
    /// velocities.
    pub(super) fn levels(&mut self, t: f64, state: &[f64]) -> Result<Vec<f64>, AnalysisError> {
        Ok(self.surface_at(t, state, None)?.0)
    }

    /// The position constraints, the kept functions minus their `levels`, and the conditions on velocities,
    /// with their slopes.
    pub(super) fn surface_at(
        &mut self,
        t: f64,
        y: &[f64],
        levels: Option<&[f64]>,
    ) -> Result<(Vec<f64>, Matrix<f64>), AnalysisError> {
        let (moving, m) = (self.sizes.coordinates + self.sizes.velocities, self.sizes.positions);
        let kept = m..m + self.sizes.kept;
        let rows = kept.end + self.sizes.conditions;
        let numbers = values(&mut self.surface, t, y, self.motion.parameters())?;
        let (values, slopes) = numbers.split_at(rows);
        let level = |a: usize| levels.filter(|_| kept.contains(&a)).map_or(0.0, |levels| levels[a]);
        let values = values.iter().enumerate().map(|(a, value)| value - level(a)).collect();
        let slope = |a: usize, j: usize| if j < moving { slopes[a * moving + j] } else { 0.0 };
        Ok((values, Matrix::from_fn(rows, y.len(), slope)))
    }

    /// The frame b at a state.
    fn frame_at(&mut self, t: f64, y: &[f64]) -> Result<Matrix<f64>, AnalysisError> {
        let (n, k) = (self.sizes.coordinates, self.sizes.whole);
        let numbers = values(&mut self.frame, t, y, self.motion.parameters())?;
        Ok(Matrix::from_fn(n, k, |i, j| numbers[i * k + j]))
    }

    /// All derivatives at a state.
    pub(super) fn evaluated(&mut self, t: f64, y: &[f64]) -> Result<Evaluated, AnalysisError> {
        let (n, l, size) = (self.sizes.coordinates, self.sizes.velocities, y.len());
        let rates = self.motion.rates(t, y)?;
        let jacobian = first_approximation(&mut self.motion, t, y)?;
        let mut by_parameters = vec![0.0; size * self.motion.parameters().len()];
        if !self.inputs.is_empty() {
            self.motion.parameter_jacobian(t, y, &mut by_parameters)?;
        }
        let places: Vec<usize> = self.inputs.iter().map(|&(_, place)| place).collect();
        let by_inputs = Matrix::from_fn(size, places.len(), |i, j| by_parameters[i + places[j] * size]);
        let (_, slopes) = self.surface_at(t, y, None)?;
        let first = self.sizes.positions + self.sizes.kept;
        let of_conditions =
            |slopes: &Matrix<f64>, rows: usize| Matrix::from_fn(rows, n + l, |a, j| slopes[(first + a, j)]);
        let of_positions =
            |slopes: &Matrix<f64>, rows: usize| Matrix::from_fn(rows, n, |a, j| slopes[(a, j)]);
        let there = aside(y, &self.units, ASIDE);
        let typical = self
            .surface_at(t, &there, None)
            .map_or_else(|_| slopes.clone(), |(_, there)| larger(&slopes, &there));
        let (conditions, positions) = (self.sizes.conditions, self.sizes.positions);
        let velocities = Velocities::new(
            (&of_conditions(&slopes, conditions), &of_conditions(&typical, conditions)),
            n,
            l,
            &self.dependent,
        )?;

        let parameters = self.motion.parameters().to_vec();
        let rows = |of: &Matrix<f64>| Matrix::from_fn(l, of.columns(), |s, j| of[(n + s, j)]);
        let accelerating = (&rates[n..n + l], &rows(&jacobian), &rows(&by_inputs));
        let here = (t, y, parameters.as_slice());
        let reacting = self.reactions.as_mut().map(|all| all.at(here, accelerating, self.motion.names()));
        let reacting = reacting.transpose()?;
        let reactions = reacting.as_ref().map_or(&[][..], |reacting| &reacting.values);
        let state = [y, &rates[n..n + l], reactions].concat();
        // An output such as a speed has no derivative at rest, where all else has.
        let numbers = [
            values(&mut self.parts, t, &state, &parameters)?,
            values_or_not(&mut self.observed, t, &state, &parameters),
        ]
        .concat();
        let mut rest = numbers.as_slice();
        let mut take = |rows: usize, columns: usize| {
            let (own, others) = rest.split_at(rows * columns);
            rest = others;
            Matrix::from_fn(rows, columns, |i, j| own[i * columns + j])
        };
        let outputs = self.outputs.len();
        let b = take(n, self.sizes.whole);
        let typical_b = larger(&b, &self.frame_at(t, &there).unwrap_or_else(|_| b.clone()));
        let mass = take(self.sizes.mass, self.sizes.mass);
        let output_values = take(1, outputs).row(0).into_owned();
        let (by_state, by_accelerations) = (take(outputs, size), take(outputs, l));
        let (by_reactions, by_own_inputs) = (take(outputs, reactions.len()), take(outputs, places.len()));
        let through = |own: Matrix<f64>, accelerated: &Matrix<f64>, reacted: Option<&Matrix<f64>>| {
            let mut all = vec![own, product(&by_accelerations, accelerated)];
            all.extend(reacted.map(|reacted| product(&by_reactions, reacted)));
            Matrix::from_fn(outputs, all[0].columns(), |i, j| all.iter().map(|part| part[(i, j)]).sum())
        };
        let (_, accelerated, accelerated_by_inputs) = accelerating;
        let reacted = reacting.as_ref();
        Ok(Evaluated {
            output_values,
            outputs: through(by_state, accelerated, reacted.map(|all| &all.by_state)),
            outputs_by_inputs: through(
                by_own_inputs,
                accelerated_by_inputs,
                reacted.map(|all| &all.by_inputs),
            ),
            mass: (self.sizes.mass == l).then_some(mass),
            directions: Directions::new(
                (&b, &typical_b),
                (&of_positions(&slopes, positions), &of_positions(&typical, positions)),
            )?,
            velocities,
            jacobian,
            by_inputs,
        })
    }
}

/// Those of the coordinates x_i that can move while all others are held and the relations f(x) = 0 hold: x_i is
/// determined by the others if column i of ∂f/∂x is independent of the other columns.
fn undetermined<'g>(
    graph: &'g Graph,
    relations: &[Expr<'g>],
    x: &[Expr<'g>],
    coordinates: &[usize],
) -> Vec<usize> {
    let rank = |columns: &[usize]| {
        let moving: Vec<Expr<'g>> = columns.iter().map(|&i| x[i]).collect();
        rank_of_gradients(graph, relations, &moving)
    };
    let all = rank(coordinates);
    let without = |&i: &usize| coordinates.iter().copied().filter(|&j| j != i).collect::<Vec<_>>();
    coordinates.iter().copied().filter(|i| all == 0 || rank(&without(i)) == all).collect()
}

/// The velocities that follow from the others under nonholonomic constraints.
fn following(multipliers: &Multipliers<'_>) -> Vec<usize> {
    let is_holonomic = (0..multipliers.constraints().len()).all(|a| multipliers.is_holonomic(a));
    if is_holonomic { Vec::new() } else { multipliers.dependent().to_vec() }
}
