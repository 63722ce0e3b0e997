//! The steady motion near the start, and whether it is stable.

use pc_mech::{Equations, Expr, ExprError, Graph, Matrix, Motion, System};

use crate::error::AnalysisError;
use crate::integrals::integral::{Integral, bind};
use crate::integrals::search::rank_of_gradients;
use crate::stability::reachable::Reachable;
use crate::stability::second_variation::SecondVariation;
use crate::stability::spectrum::{Eigenvalue, Verdict};
use crate::stability::steady_motion::{SteadyMotion, SteadyOptions, first_approximation};

/// If the slopes of the rates exceed those at the start by this factor, the coordinates are singular.
const MOST_STEEPER: f64 = 1e6;

/// The largest number of steps of Newton's method.
const MOST_STEPS: usize = 50;

/// An equilibrium or a steady motion of an autonomous system near its start.
#[derive(Clone, Debug)]
pub struct NearbySteadyMotion {
    /// The components that are not cyclic, with their values.
    pub state: Vec<(String, f64)>,
    /// The cyclic coordinates whose rates are constant, with these rates.
    pub rates: Vec<(String, f64)>,
    /// The Euclidean distance from the start in the components that are not cyclic.
    pub distance: f64,
    /// The integrals that have the same values as at the start.
    pub same: Vec<String>,
    /// The eigenvalues of the first approximation, in the directions left free by the relations between the
    /// coordinates.
    pub eigenvalues: Vec<Eigenvalue>,
    /// The real part that counts as zero.
    pub tolerance: f64,
    /// The verdict of the first approximation.
    pub first_approximation: Verdict,
    /// The number of neutral directions, if neighbouring motions approach steady ones: λ = 0 with this
    /// multiplicity, once for each of as many independent integrals, and all other real parts negative.
    pub neutral: Option<usize>,
    /// The verdict of the second variation, if the energy and the integrals are conserved.
    pub second_variation: Option<EnergyCriterion>,
}

/// The verdict of the second variation of the energy under the integrals.
#[derive(Clone, Debug)]
pub struct EnergyCriterion {
    /// Stable, or undecided.
    pub verdict: Verdict,
    /// The variables of the criterion, unless they are all components that are not cyclic.
    pub variables: Option<Vec<String>>,
}

/// The stability of a steady motion, and the criterion that shows it.
#[derive(Clone, Debug, PartialEq)]
pub enum Stability {
    /// The first approximation decides.
    ByFirstApproximation(Verdict),
    /// The motion is stable by the second variation of the energy.
    BySecondVariation {
        /// The variables of the criterion, unless they are all components that are not cyclic.
        variables: Option<Vec<String>>,
    },
    /// The motion is stable by the second variation of a declared integral: the energy is not conserved.
    ByIntegral {
        /// The name of the integral.
        name: String,
        /// The variables of the criterion, unless they are all components that are not cyclic.
        variables: Option<Vec<String>>,
    },
    /// By the first approximation the motion is asymptotically stable, except in neutral directions.
    AsymptoticBut {
        /// The number of neutral directions.
        directions: usize,
    },
    /// No criterion decides.
    Undecided {
        /// Whether the second variation was also tried.
        second_variation: bool,
    },
}

/// Whether the equations are independent of time and inputs, for the present parameters.
pub(crate) fn is_autonomous(equations: &Equations<'_>) -> bool {
    let system = equations.system();
    !timed(equations).any(|x| moves(system, x) && moves(system, bind(system, x)))
}

/// Whether the equations depend on time or inputs for some values of the parameters.
pub(crate) fn names_time(equations: &Equations<'_>) -> bool {
    timed(equations).any(|x| moves(equations.system(), x))
}

fn moves<'g>(system: &System<'g>, x: Expr<'g>) -> bool {
    x.depends_on(system.frame().time()) || system.signals().iter().any(|&u| x.depends_on(u))
}

/// The expressions that occur in the rates.
fn timed<'g>(equations: &Equations<'g>) -> impl Iterator<Item = Expr<'g>> {
    let all =
        [equations.velocities(), &equations.mass_matrix().nonzero_entries(), equations.right_hand_side()];
    all.concat()
        .into_iter()
        .chain(equations.system().states().iter().map(|&(_, rate)| rate).collect::<Vec<_>>())
}

/// The data that all starts of a search share.
pub(crate) struct Seeker<'a, 'g> {
    equations: &'a Equations<'g>,
    bound: Equations<'g>,
    integrals: Vec<(String, Expr<'g>)>,
    /// All integrals, dependent ones too.
    all: Vec<(String, Expr<'g>)>,
    /// The functions of the coordinates that are constant along all motions.
    relations: Vec<Expr<'g>>,
    t: f64,
    /// The largest slope of the rates: a larger one indicates singular coordinates.
    steepest: f64,
}

impl<'a, 'g> Seeker<'a, 'g> {
    /// `None` if the motion has no derivatives at the start.
    pub(crate) fn new(
        equations: &'a Equations<'g>,
        motion: &mut Motion,
        (t, start): (f64, &[f64]),
        known: &Known<'g>,
        positions: &[(String, Expr<'g>)],
    ) -> Option<Seeker<'a, 'g>> {
        let slopes = first_approximation(motion, t, start).ok()?;
        let (bound, integrals, all) =
            (equations.with_parameters_bound(), known.integrals.clone(), known.all.clone());
        let positions = positions.iter().map(|&(_, position)| bind(equations.system(), position));
        let relations = known.of_coordinates.iter().map(|&(_, f)| f).chain(positions).collect();
        let steepest = MOST_STEEPER * largest(&slopes);
        Some(Seeker { equations, bound, integrals, all, relations, t, steepest })
    }

    /// The functions `same`, and those of the positions that are independent of them.
    pub(super) fn with_positions(
        &self,
        mut same: Vec<(String, Expr<'g>)>,
        positions: &[(String, Expr<'g>)],
    ) -> Vec<(String, Expr<'g>)> {
        let system = self.equations.system();
        let x = system.frame().coordinates();
        for (name, position) in positions {
            let functions: Vec<Expr<'g>> = same.iter().map(|&(_, f)| f).collect();
            let more = [functions.as_slice(), &[bind(system, *position)]].concat();
            if rank_of_gradients(system.graph(), &more, x) > rank_of_gradients(system.graph(), &functions, x)
            {
                same.push((name.clone(), bind(system, *position)));
            }
        }
        same
    }

    /// The steady motion near a guess, if there is one at which coordinates are regular.
    pub(super) fn steady_motion(
        &self,
        motion: &mut Motion,
        guess: &[f64],
        options: &SteadyOptions,
        surface: &Surface<'g>,
    ) -> Option<SteadyMotion> {
        let options = options.clone().iterations(MOST_STEPS);
        let found = SteadyMotion::on_surface(motion, self.t, guess, &options, |y| Ok(surface.at(y)?)).ok()?;
        (largest(&found.first_approximation) <= self.steepest).then_some(found)
    }

    /// The motion as names and numbers, with the results on its stability.
    pub(crate) fn described(
        &self,
        found: &SteadyMotion,
        start: &[f64],
        same: Vec<String>,
    ) -> Result<NearbySteadyMotion, AnalysisError> {
        // An integral that contains a cyclic coordinate changes with it, at constant values of the others. A dependent
        // integral adds a direction that is kept, unless it has no derivatives there.
        let symbols = self.equations.system().state();
        let cyclic: Vec<Expr<'g>> =
            symbols.into_iter().filter(|y| !found.components.contains(&y.to_string())).collect();
        let under = |integrals: &[(String, Expr<'g>)]| {
            let own = integrals.iter().filter(|(_, f)| !cyclic.iter().any(|&x| f.depends_on(x))).cloned();
            SecondVariation::under(&self.bound, &own.collect::<Vec<_>>(), &found.state).ok()
        };
        let is_decisive = |second: &SecondVariation| second.verdict == Verdict::Stable;
        let second = under(&self.integrals)
            .filter(is_decisive)
            .or_else(|| under(&self.all))
            .or_else(|| under(&self.integrals));
        let second_variation = second.map(|second| EnergyCriterion {
            verdict: second.verdict,
            variables: Some(second.variables).filter(|variables| *variables != found.components),
        });
        let reachable = self.reachable(found)?;
        let differentials = differentials(self.equations.system(), found, &self.integrals)?;
        let kept = self.kept(found, start);
        let distance = kept.iter().map(|(_, y, start)| (y - start).powi(2)).sum::<f64>().sqrt();
        Ok(NearbySteadyMotion {
            state: kept.into_iter().map(|(name, y, _)| (name, y)).collect(),
            rates: constant_rates(self.equations, found),
            distance,
            same,
            eigenvalues: reachable.spectrum.eigenvalues().to_vec(),
            tolerance: reachable.spectrum.tolerance(),
            first_approximation: reachable.spectrum.verdict(),
            neutral: reachable.neutral(&differentials),
            second_variation,
        })
    }

    /// The directions from a steady motion along which all relations hold.
    fn reachable(&self, found: &SteadyMotion) -> Result<Reachable, AnalysisError> {
        let system = self.equations.system();
        let (graph, symbols) = (system.graph(), system.state());
        let slopes: Vec<Expr<'g>> =
            self.relations.iter().flat_map(|&f| graph.gradient(f, &symbols)).collect();
        let state = symbols.iter().copied().zip(found.state.iter().copied());
        let at: Vec<_> = state.chain([(system.frame().time(), self.t)]).collect();
        let slopes = graph.evaluate(&slopes, &at)?;
        let normals =
            Matrix::from_fn(self.relations.len(), symbols.len(), |a, j| slopes[a * symbols.len() + j]);
        let is_kept = |&i: &usize| found.components.contains(&symbols[i].to_string());
        let kept: Vec<usize> = (0..symbols.len()).filter(is_kept).collect();
        Ok(Reachable::of(found, &kept, &normals)?)
    }

    /// The names of the components that are not cyclic, with their values in the motion and at the start.
    fn kept(&self, found: &SteadyMotion, start: &[f64]) -> Vec<(String, f64, f64)> {
        let names = self.equations.system().state().into_iter().map(|y| y.to_string());
        let all = names.zip(found.state.iter().zip(start)).map(|(name, (&y, &start))| (name, y, start));
        all.filter(|(name, ..)| found.components.contains(name)).collect()
    }
}

/// The differentials of the integrals with respect to the components that are not cyclic. An integral that
/// contains a cyclic coordinate is left out: it is not a function of the other components alone.
fn differentials<'g>(
    system: &System<'g>,
    found: &SteadyMotion,
    integrals: &[(String, Expr<'g>)],
) -> Result<Vec<Vec<f64>>, ExprError> {
    let graph = system.graph();
    let symbols = system.state();
    let (kept, cyclic): (Vec<Expr<'g>>, Vec<Expr<'g>>) =
        symbols.iter().partition(|y| found.components.contains(&y.to_string()));
    let at: Vec<(Expr<'g>, f64)> = symbols.into_iter().zip(found.state.iter().copied()).collect();
    let of_kept = integrals.iter().filter(|(_, f)| !cyclic.iter().any(|&x| f.depends_on(x)));
    of_kept.map(|&(_, f)| graph.evaluate(&graph.gradient(f, &kept), &at)).collect()
}

/// Those rates of the cyclic coordinates that contain no cyclic coordinate.
fn constant_rates(equations: &Equations<'_>, found: &SteadyMotion) -> Vec<(String, f64)> {
    let x = equations.system().frame().coordinates();
    let is_cyclic = |name: &str| found.rates.iter().any(|(cyclic, _)| cyclic == name);
    let cyclic: Vec<Expr<'_>> = x.iter().copied().filter(|x| is_cyclic(&x.to_string())).collect();
    let rates = x.iter().zip(equations.velocities());
    let constant: Vec<String> = rates
        .filter(|(_, rate)| !cyclic.iter().any(|&x| rate.depends_on(x)))
        .map(|(x, _)| x.to_string())
        .collect();
    // The rate of a coordinate whose velocity is a component of the state is already listed.
    let is_component = |name: &str| found.components.iter().any(|known| *known == format!("{name}'"));
    let rates = found.rates.iter().filter(|(name, _)| constant.contains(name) && !is_component(name));
    rates.cloned().collect()
}

/// The largest absolute value of an entry.
pub(crate) fn largest(matrix: &Matrix<f64>) -> f64 {
    matrix.entries().iter().fold(0.0, |largest, entry| entry.abs().max(largest))
}

/// The integrals that do not contain time and are independent of the energy and of each other; parameters are
/// replaced by numbers.
pub(crate) struct Known<'g> {
    integrals: Vec<(String, Expr<'g>)>,
    /// All integrals that do not contain time, whether they are independent or not.
    all: Vec<(String, Expr<'g>)>,
    /// The Casimirs among them.
    casimirs: Vec<(String, Expr<'g>)>,
    /// The functions of the coordinates among them.
    of_coordinates: Vec<(String, Expr<'g>)>,
}

impl<'g> Known<'g> {
    pub(crate) fn of(equations: &Equations<'g>, integrals: &[Integral<'g>]) -> Known<'g> {
        let system = equations.system();
        let (graph, eta) = (system.graph(), system.quasi_velocities());
        let variables = system.state();
        let is_of_coordinates = |f: Expr<'g>| !eta.iter().any(|&eta| f.depends_on(eta));
        let mut independent = vec![bind(system, equations.energy())];
        let mut known = Known {
            integrals: Vec::new(),
            all: Vec::new(),
            casimirs: Vec::new(),
            of_coordinates: Vec::new(),
        };
        for integral in integrals.iter().filter(|integral| integral.is_conserved() && !integral.is_energy()) {
            let value = bind(system, integral.value);
            if !value.depends_on(system.frame().time()) {
                known.all.push((integral.name.clone(), value));
            }
            independent.push(value);
            let is_new = rank_of_gradients(graph, &independent, &variables) == independent.len();
            if value.depends_on(system.frame().time()) || !is_new {
                independent.pop();
                continue;
            }
            let named = (integral.name.clone(), value);
            if is_of_coordinates(value) {
                known.of_coordinates.push(named.clone());
            }
            if integral.is_casimir() || is_of_coordinates(value) {
                known.casimirs.push(named.clone());
            }
            known.integrals.push(named);
        }
        known
    }

    /// Sets of integrals whose values a steady motion may share with the start, the largest set first: a
    /// motion is compared with steady motions that have the same values of the integrals, if there are any
    /// (E. J. Routh).
    pub(super) fn choices(self) -> Vec<Vec<(String, Expr<'g>)>> {
        let mut choices = vec![self.integrals, self.casimirs, self.of_coordinates];
        choices.dedup_by_key(|choice| choice.len());
        choices
    }
}

/// The states at which given functions have the same values as at the start.
pub(super) struct Surface<'g> {
    graph: &'g Graph,
    symbols: Vec<Expr<'g>>,
    /// g_1, g_2, …, then ∂g_1/∂y_1, ∂g_1/∂y_2, …
    expressions: Vec<Expr<'g>>,
    values: Vec<f64>,
}

impl<'g> Surface<'g> {
    /// The surface, if n − rank b of the functions, as many as are constant along motions in the frame,
    /// depend on the coordinates alone.
    pub(super) fn new(
        equations: &Equations<'g>,
        same: &[(String, Expr<'g>)],
        start: &[f64],
    ) -> Option<Surface<'g>> {
        let system = equations.system();
        let (graph, x, eta) = (system.graph(), system.frame().coordinates(), system.quasi_velocities());
        let symbols = system.state();
        let functions: Vec<Expr<'g>> = same.iter().map(|&(_, f)| f).collect();
        let of_coordinates = |f: &Expr<'g>| !eta.iter().any(|&eta| f.depends_on(eta));
        let relations: Vec<Expr<'g>> = functions.iter().copied().filter(of_coordinates).collect();
        // With bound velocities, the frame keeps only the functions given as positions.
        let is_bound = system.structure().operators() != eta.len();
        if !is_bound && rank_of_gradients(graph, &relations, x) != x.len() - system.frame().rank() {
            return None;
        }
        let slopes = functions.iter().flat_map(|&f| graph.gradient(f, &symbols));
        let expressions: Vec<Expr<'g>> = functions.iter().copied().chain(slopes).collect();
        let mut surface = Surface { graph, values: vec![0.0; functions.len()], symbols, expressions };
        surface.values = surface.at(start).ok()?.0;
        Some(surface)
    }

    /// g(y) − g(start) and ∂g/∂y
    pub(super) fn at(&self, y: &[f64]) -> Result<(Vec<f64>, Matrix<f64>), ExprError> {
        // A check at each step of Newton's method whether to continue.
        self.graph.check_budget()?;
        let state: Vec<_> = self.symbols.iter().copied().zip(y.iter().copied()).collect();
        let numbers = self.graph.evaluate(&self.expressions, &state)?;
        let (values, slopes) = numbers.split_at(self.values.len());
        let distances = values.iter().zip(&self.values).map(|(value, start)| value - start).collect();
        Ok((distances, Matrix::from_fn(values.len(), y.len(), |i, j| slopes[i * y.len() + j])))
    }
}

impl NearbySteadyMotion {
    /// The stability, and the criterion that shows it.
    pub fn stability(&self) -> Stability {
        let proved = |second: &&EnergyCriterion| second.verdict == Verdict::Stable;
        match (self.first_approximation, self.second_variation.as_ref().filter(proved)) {
            (Verdict::Undecided, Some(second)) => {
                Stability::BySecondVariation { variables: second.variables.clone() }
            }
            (Verdict::Undecided, None) => match self.neutral {
                Some(directions) => Stability::AsymptoticBut { directions },
                None => Stability::Undecided { second_variation: self.second_variation.is_some() },
            },
            (verdict, _) => Stability::ByFirstApproximation(verdict),
        }
    }
}
