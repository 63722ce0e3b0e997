//! The steady motion near the start, and whether it is stable.

use pc_analysis::{Eigenvalue, SecondVariation, SteadyMotion, SteadyOptions, Verdict, first_approximation};
use pc_mech::{Equations, Expr, ExprError, Graph, Matrix, Motion};
use serde_json::{Map, Value, json};

use super::integrals::{Integral, bind, rank_of_gradients};
use crate::report::text::{short, wrapped};

/// An equilibrium or a steady motion of an autonomous system near its start.
#[derive(Clone, Debug)]
pub(super) struct Steady {
    /// The components that are not cyclic, with their values.
    state: Vec<(String, f64)>,
    /// The cyclic coordinates whose rates are constant, with these.
    rates: Vec<(String, f64)>,
    /// Euclidean, in the components that are not cyclic.
    distance: f64,
    /// The integrals that have the values of the start.
    same: Vec<String>,
    eigenvalues: Vec<Eigenvalue>,
    /// The real part that counts as zero.
    tolerance: f64,
    first_approximation: Verdict,
    /// How many directions are neutral, where neighbouring motions approach steady ones: λ = 0 so many times, once for each of
    /// as many independent integrals, and all other real parts negative.
    neutral: Option<usize>,
    second_variation: Option<Variation>,
}

/// What the second variation of the energy under the integrals says.
#[derive(Clone, Debug)]
struct Variation {
    verdict: Verdict,
    /// In which variables, if not in all that are not cyclic.
    variables: Option<Vec<String>>,
}

/// What came of the search.
#[derive(Clone, Debug)]
pub(super) enum Search {
    /// The equations depend on time.
    NotAutonomous,
    /// Not as many functions of the coordinates are known as the frame keeps: a solution might not be reached.
    SurfaceUnknown,
    /// The constraints leave no velocities that are independent of each other.
    Nonlinear,
    /// Newton's method ended nowhere, or far away.
    None,
    /// It is there.
    Found(Box<Steady>),
}

/// The steady motion of `equations` near the start (t, y), among the states in which coordinates that are not
/// independent keep their relations; `positions` are those that constraints say.
pub(super) fn steady_motion<'g>(
    equations: &Equations<'g>,
    motion: &mut Motion,
    (t_start, start): (f64, &[f64]),
    integrals: &[Integral<'g>],
    positions: &[(String, Expr<'g>)],
) -> Search {
    let system = equations.system();
    let (frame, time) = (system.frame(), system.frame().time());
    let mut all = equations
        .velocities()
        .iter()
        .chain(equations.mass_matrix().entries())
        .chain(equations.right_hand_side())
        .chain(system.states().iter().map(|(_, rate)| rate));
    let moves = |x: Expr<'_>| x.depends_on(time) || system.signals().iter().any(|&u| x.depends_on(u));
    if all.any(|&x| moves(bind(system, x))) {
        return Search::NotAutonomous;
    }
    let Ok(slopes) = first_approximation(motion, t_start, start) else { return Search::None };
    let steepest = MOST_STEEPER * largest(&slopes);
    let known = Known::of(equations, integrals);
    let bound = equations.with_parameters_bound();
    let all = known.integrals.clone();
    for mut same in known.choices() {
        for (name, position) in positions {
            let functions: Vec<Expr<'g>> = same.iter().map(|&(_, f)| f).collect();
            let more = [functions.as_slice(), &[bind(system, *position)]].concat();
            if rank_of_gradients(system.graph(), &more, frame.coordinates())
                > rank_of_gradients(system.graph(), &functions, frame.coordinates())
            {
                same.push((name.clone(), bind(system, *position)));
            }
        }
        let Some(surface) = Surface::new(equations, &same, start) else {
            return Search::SurfaceUnknown;
        };
        let options = SteadyOptions::default().iterations(MOST_STEPS);
        let found = SteadyMotion::on_surface(motion, t_start, start, &options, |y| Ok(surface.at(y)?));
        let Some(found) = found.ok().filter(|found| largest(&found.first_approximation) <= steepest) else {
            continue;
        };
        let state = system.state();
        let names = state.iter().map(Expr::to_string);
        let second = SecondVariation::under(&bound, &all, &found.state).ok().map(|second| Variation {
            verdict: second.verdict,
            variables: Some(second.variables).filter(|variables| *variables != found.components),
        });
        let same = same.into_iter().map(|(name, _)| name).collect();
        let rates = constant_rates(equations, &found);
        let neutral = neutral_directions(equations, &found, &all);
        if let Some(steady) = Steady::new(&found, names, start, (rates, neutral), same, second) {
            return Search::Found(Box::new(steady));
        }
    }
    Search::None
}

/// The number k of neutral directions of a steady motion that is one of a family: the first approximation has λ = 0 in k
/// blocks of size 1 and negative real parts else, and there are k integrals whose differentials are independent there, so that
/// on each level near by the steady motion is one alone, and approached (I. G. Malkin's theorem of the critical case of k
/// zeros).
fn neutral_directions(
    equations: &Equations<'_>,
    found: &SteadyMotion,
    integrals: &[(String, Expr<'_>)],
) -> Option<usize> {
    let spectrum = &found.spectrum;
    let &[count] = spectrum.zero_blocks() else { return None };
    let damped = spectrum.eigenvalues().iter().filter(|value| value.real < -spectrum.tolerance()).count();
    if damped + count != spectrum.eigenvalues().len() || spectrum.neutral() != count {
        return None;
    }
    let (system, graph) = (equations.system(), equations.system().graph());
    let symbols = [system.frame().coordinates(), system.quasi_velocities()].concat();
    let kept: Vec<Expr<'_>> =
        symbols.iter().copied().filter(|y| found.components.contains(&y.to_string())).collect();
    let at: Vec<(Expr<'_>, f64)> = symbols.into_iter().zip(found.state.iter().copied()).collect();
    // One of a cyclic coordinate is none of the other components alone.
    let of_kept = |f: &Expr<'_>| {
        graph
            .symbols_of(&[*f])
            .iter()
            .all(|symbol| kept.contains(symbol) || !at.iter().any(|(y, _)| y == symbol))
    };
    let functions: Vec<Expr<'_>> = integrals.iter().map(|&(_, f)| f).filter(of_kept).collect();
    let mut basis: Vec<Vec<f64>> = Vec::new();
    for function in functions {
        let mut gradient = graph.evaluate(&graph.gradient(function, &kept), &at).ok()?;
        let length = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let size = length(&gradient);
        for known in &basis {
            let along: f64 = known.iter().zip(&gradient).map(|(a, b)| a * b).sum();
            gradient.iter_mut().zip(known).for_each(|(g, known)| *g -= along * known);
        }
        let left = length(&gradient);
        if left > INDEPENDENT * size {
            basis.push(gradient.iter().map(|g| g / left).collect());
        }
    }
    (basis.len() >= count).then_some(count)
}

/// The rates of the cyclic coordinates that contain no cyclic coordinate.
fn constant_rates(equations: &Equations<'_>, found: &SteadyMotion) -> Vec<(String, f64)> {
    let x = equations.system().frame().coordinates();
    let is_cyclic = |name: &str| found.rates.iter().any(|(cyclic, _)| cyclic == name);
    let cyclic: Vec<Expr<'_>> = x.iter().copied().filter(|x| is_cyclic(&x.to_string())).collect();
    let rates = x.iter().zip(equations.velocities());
    let constant: Vec<String> = rates
        .filter(|(_, rate)| !cyclic.iter().any(|&x| rate.depends_on(x)))
        .map(|(x, _)| x.to_string())
        .collect();
    // A velocity that is a component of the state is known already.
    let is_component = |name: &str| found.components.iter().any(|known| *known == format!("{name}'"));
    let rates = found.rates.iter().filter(|(name, _)| constant.contains(name) && !is_component(name));
    rates.cloned().collect()
}

/// The largest size of an entry.
fn largest(matrix: &Matrix<f64>) -> f64 {
    matrix.entries().iter().fold(0.0, |largest, entry| entry.abs().max(largest))
}

/// The integrals that do not contain the time, independent of the energy and of each other; parameters are numbers.
struct Known<'g> {
    integrals: Vec<(String, Expr<'g>)>,
    /// Those of them that are Casimirs.
    casimirs: Vec<(String, Expr<'g>)>,
    /// Those of them that are functions of the coordinates.
    of_coordinates: Vec<(String, Expr<'g>)>,
}

impl<'g> Known<'g> {
    fn of(equations: &Equations<'g>, integrals: &[Integral<'g>]) -> Known<'g> {
        let system = equations.system();
        let (graph, eta) = (system.graph(), system.quasi_velocities());
        let variables = system.state();
        let is_of_coordinates = |f: Expr<'g>| !eta.iter().any(|&eta| f.depends_on(eta));
        let mut independent = vec![bind(system, equations.energy())];
        let mut known = Known { integrals: Vec::new(), casimirs: Vec::new(), of_coordinates: Vec::new() };
        for integral in integrals.iter().filter(|integral| integral.is_conserved() && !integral.is_energy()) {
            let value = bind(system, integral.value);
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

    /// What a steady motion may have in common with the start, most first: a motion is compared with the steady
    /// ones of the same integrals, if there are any (E. J. Routh).
    fn choices(self) -> Vec<Vec<(String, Expr<'g>)>> {
        let mut choices = vec![self.integrals, self.casimirs, self.of_coordinates];
        choices.dedup_by_key(|choice| choice.len());
        choices
    }
}

/// The states in which given functions have their values of the start.
struct Surface<'g> {
    graph: &'g Graph,
    symbols: Vec<Expr<'g>>,
    /// g_1, g_2, …, then ∂g_1/∂y_1, ∂g_1/∂y_2, …
    expressions: Vec<Expr<'g>>,
    values: Vec<f64>,
}

impl<'g> Surface<'g> {
    /// If n − rank b of them are functions of the coordinates, as many as the frame keeps.
    fn new(equations: &Equations<'g>, same: &[(String, Expr<'g>)], start: &[f64]) -> Option<Surface<'g>> {
        let system = equations.system();
        let (graph, x, eta) = (system.graph(), system.frame().coordinates(), system.quasi_velocities());
        let symbols = system.state();
        let functions: Vec<Expr<'g>> = same.iter().map(|&(_, f)| f).collect();
        let of_coordinates = |f: &Expr<'g>| !eta.iter().any(|&eta| f.depends_on(eta));
        let relations: Vec<Expr<'g>> = functions.iter().copied().filter(of_coordinates).collect();
        // Where velocities are bound the frame keeps no function that is not said to be a position.
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
    fn at(&self, y: &[f64]) -> Result<(Vec<f64>, Matrix<f64>), ExprError> {
        let state: Vec<_> = self.symbols.iter().copied().zip(y.iter().copied()).collect();
        let numbers = self.graph.evaluate(&self.expressions, &state)?;
        let (values, slopes) = numbers.split_at(self.values.len());
        let distances = values.iter().zip(&self.values).map(|(value, start)| value - start).collect();
        Ok((distances, Matrix::from_fn(values.len(), y.len(), |i, j| slopes[i * y.len() + j])))
    }
}

impl Steady {
    /// The motion in names and numbers, unless it is farther from the start than the start is large.
    fn new(
        found: &SteadyMotion,
        names: impl Iterator<Item = String>,
        start: &[f64],
        (rates, neutral): (Vec<(String, f64)>, Option<usize>),
        same: Vec<String>,
        second_variation: Option<Variation>,
    ) -> Option<Steady> {
        let all = names.zip(found.state.iter().zip(start));
        let kept: Vec<_> = all.filter(|(name, _)| found.components.contains(name)).collect();
        let norm = |numbers: Vec<f64>| numbers.iter().map(|z| z * z).sum::<f64>().sqrt();
        let distance = norm(kept.iter().map(|(_, (y, start))| *y - *start).collect());
        let size = 1.0 + norm(kept.iter().map(|(_, (_, start))| **start).collect());
        (distance <= size).then(|| Steady {
            state: kept.into_iter().map(|(name, (&y, _))| (name, y)).collect(),
            rates,
            distance,
            same,
            eigenvalues: found.spectrum.eigenvalues().to_vec(),
            tolerance: found.spectrum.tolerance(),
            first_approximation: found.verdict(),
            neutral,
            second_variation,
        })
    }

    /// What is known of stability, and by what.
    fn verdict(&self) -> String {
        let proved = |variation: &&Variation| variation.verdict == Verdict::Stable;
        match (self.first_approximation, self.second_variation.as_ref().filter(proved)) {
            (Verdict::Undecided, Some(Variation { variables: None, .. })) => {
                "stable, by the second variation of the energy".to_owned()
            }
            (Verdict::Undecided, Some(Variation { variables: Some(variables), .. })) => {
                format!("stable in {}, by the second variation of the energy", variables.join(", "))
            }
            (Verdict::Undecided, None) if self.neutral.is_some() => {
                let directions = match self.neutral {
                    Some(1) => "one neutral direction".to_owned(),
                    count => format!("{} neutral directions", count.unwrap_or_default()),
                };
                format!("asymptotically stable but for {directions}, by the first approximation")
            }
            (Verdict::Undecided, None) if self.second_variation.is_some() => {
                "undecided by the first approximation and by the second variation of the energy".to_owned()
            }
            (Verdict::Undecided, None) => "undecided by the first approximation".to_owned(),
            (verdict, _) => format!("{verdict}, by the first approximation"),
        }
    }

    /// Where it is, how far from the start, eigenvalues, verdict: lines of `width` characters.
    fn lines(&self, width: usize) -> Vec<String> {
        let assigned = |name: &str, value: f64| format!("{name} = {}", rounded(value));
        let state = self.state.iter().map(|(name, value)| assigned(name, *value));
        let rates = self.rates.iter().map(|(name, rate)| assigned(&format!("{name}'"), *rate));
        let mut lines = wrapped(state.chain(rates), width);
        lines.push(match (rounded(self.distance).as_str(), self.same.as_slice()) {
            ("0", _) => "the start itself".to_owned(),
            (_, []) => format!("{} from the start", short(self.distance, 3)),
            (_, same) => format!("{} from the start, with its {}", short(self.distance, 3), same.join(", ")),
        });
        let eigenvalues = wrapped(spectrum(&self.eigenvalues, self.tolerance.max(ZERO)), width - 12);
        lines.extend((0..).zip(eigenvalues).map(|(i, line)| match i {
            0 => format!("eigenvalues {line}"),
            _ => format!("            {line}"),
        }));
        lines.push(self.verdict());
        lines
    }

    fn object(&self) -> Value {
        let map = |pairs: &[(String, f64)]| -> Map<String, Value> {
            pairs.iter().map(|(name, value)| (name.clone(), json!(value))).collect()
        };
        json!({
            "state": map(&self.state),
            "rates": map(&self.rates),
            "distance": self.distance,
            "same": self.same,
            "eigenvalues": self.eigenvalues.iter().map(|l| [l.real, l.imaginary]).collect::<Vec<_>>(),
            "first_approximation": self.first_approximation.to_string(),
            "second_variation": self.second_variation.as_ref().map(|second| second.verdict.to_string()),
            "verdict": self.verdict(),
        })
    }
}

impl Search {
    /// What to print; nothing where no steady motion is to be expected.
    pub(super) fn lines(&self, width: usize) -> Vec<String> {
        match self {
            Search::NotAutonomous => Vec::new(),
            Search::SurfaceUnknown => {
                vec![
                    "not looked for: the functions of the coordinates that the frame keeps are unknown"
                        .to_owned(),
                ]
            }
            Search::Nonlinear => {
                vec!["not looked for: a constraint is not affine in the velocities".to_owned()]
            }
            Search::None => vec!["none found near the start".to_owned()],
            Search::Found(steady) => steady.lines(width),
        }
    }

    /// The motion for programs; null where none is found.
    pub(super) fn object(&self) -> Value {
        match self {
            Search::Found(steady) => steady.object(),
            _ => Value::Null,
        }
    }
}

/// Where rates are steeper than this many times those at the start, the coordinates are singular.
const MOST_STEEPER: f64 = 1e6;

/// A differential of which more than this part is left beside others is independent of them.
const INDEPENDENT: f64 = 1e-8;

/// Steps of Newton's method.
const MOST_STEPS: usize = 50;

/// What Newton's method leaves of a zero.
const ZERO: f64 = 1e-9;

/// Six digits; what Newton's method leaves of a zero is one.
fn rounded(value: f64) -> String {
    if value.abs() <= ZERO { "0".to_owned() } else { short(value, 6) }
}

/// The eigenvalues, conjugate ones together, equal ones counted: `0.5, ±2i, 0 (twice)`.
fn spectrum(eigenvalues: &[Eigenvalue], zero: f64) -> Vec<String> {
    let part = |value: f64| if value.abs() <= zero { 0.0 } else { value };
    let mut counted: Vec<(String, usize)> = Vec::new();
    for eigenvalue in eigenvalues.iter().filter(|eigenvalue| part(eigenvalue.imaginary) >= 0.0) {
        let (real, imaginary) = (part(eigenvalue.real), part(eigenvalue.imaginary));
        let text = match (real == 0.0, imaginary == 0.0) {
            (_, true) => short(real, 4),
            (true, false) => format!("±{}i", short(imaginary, 4)),
            (false, false) => format!("{} ± {}i", short(real, 4), short(imaginary, 4)),
        };
        match counted.iter_mut().find(|(known, _)| *known == text) {
            Some((_, count)) => *count += 1,
            None => counted.push((text, 1)),
        }
    }
    let shown = counted.into_iter().map(|(text, count)| match count {
        1 => text,
        2 => format!("{text} (twice)"),
        _ => format!("{text} ({count} times)"),
    });
    shown.collect()
}
