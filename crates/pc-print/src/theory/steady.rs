//! Equilibria and steady motions, and their stability.

use pc_analysis::{
    Conserved, Eigenvalue, FoundSteadyMotion, Integrals, Linearization, NearbySteadyMotion, NoSteadyMotions,
    Stability, SteadyMotions, SteadyOptions, Verdict as Of,
};
use pc_model::ModelError;

use crate::theory::basis::Basis;
use crate::theory::description::{Entry, Section, Verdict};
use crate::theory::extent::Extent;
use crate::theory::linear_model::LinearModel;
use crate::words::words::short;

/// Numbers up to this size count as zero: Newton's method leaves such remainders in place of zeros.
const ZERO: f64 = 1e-9;

/// The number of starts of each kind in a brief search.
const STARTS_BRIEFLY: usize = 8;

/// The largest number of members of families that are listed.
const MOST_LISTED: usize = 8;

/// A real part that is smaller, as a fraction of the largest eigenvalue, decides nothing where the linear theory of the model does
/// not reach the state: the state is then not known well enough.
const DECISIVE: f64 = 1e-6;

/// The section on all steady motions found, or on the nearest of many.
pub(crate) fn section<'g>(
    ground: &Basis<'_, 'g>,
    integrals: &Integrals<'g>,
    extent: Extent,
) -> Result<Section<'g>, ModelError> {
    let section =
        |entries| Ok(Section { key: "steady_motions", title: "Steady motions", names: Vec::new(), entries });
    if ground.assembly.constraints.nonlinear().is_some() {
        return section(vec![Entry::words("not looked for: a constraint is not affine in the velocities")]);
    }
    if ground.has_external_forces() {
        return section(vec![Entry::words("not looked for: forces are computed outside")]);
    }
    if let Some(name) = ground.assembly.undetermined_functions().first() {
        return section(vec![Entry::words(format!("not looked for: `{name}` has no value in [functions]"))]);
    }
    let (equations, assembly) = (&ground.equations, ground.assembly);
    let mut motion = assembly.placed(equations.compile())?;
    let start = assembly.start_of(&equations.system().state());
    let at = (assembly.t_start, start.as_slice());
    let (positions, most) = (assembly.held_positions(), extent.either(usize::MAX, STARTS_BRIEFLY));
    let found = SteadyMotions::search(equations, &mut motion, at, integrals.list(), &positions, most);
    section(match found {
        Ok(found) => {
            let mut judge = Judge::new(ground, integrals);
            let listed = found.list.iter().take(MOST_LISTED);
            let judged: Vec<_> = listed.map(|found| (found, judge.judged(&found.motion))).collect();
            // Nonholonomic motions need not have a steady one with the integrals of the start.
            let stability = |(found, judged): &(&FoundSteadyMotion, Option<(Linearization, Stability)>)| {
                stability_in_words(
                    &judged.as_ref().map_or_else(|| decided(&found.motion), |(_, by)| by.clone()),
                )
            };
            let known = judged.iter().map(stability).collect();
            let near = if ground.is_holonomic() { Vec::new() } else { judge.near(known) };
            if judged.is_empty() && near.is_empty() {
                return section(vec![Entry::words(format!("none found from {} starts", found.starts))]);
            }
            let listed = judged.into_iter().map(|(found, judged)| entry(found, judged));
            let all = listed.chain(near.iter().map(|(linear, stability)| near_entry(linear, stability)));
            let more = found.list.len().saturating_sub(MOST_LISTED);
            let more =
                (more > 0).then(|| Entry::words(format!("{more} more are found: they are not isolated")));
            let starts = Entry::words(format!("found from {} starts; there may be others", found.starts));
            (1..)
                .zip(all)
                .map(|(number, entry): (usize, Entry<'g>)| entry.named(number.to_string()))
                .chain(more)
                .chain([starts])
                .collect()
        }
        Err(NoSteadyMotions::NotAutonomous) => {
            vec![Entry::words("not looked for: the model depends on time")]
        }
        Err(NoSteadyMotions::SurfaceUnknown) => {
            let words = "not looked for: the functions of the coordinates that the frame keeps are unknown";
            vec![Entry::words(words)]
        }
        Err(NoSteadyMotions::TooLarge { components }) => {
            vec![Entry::words(format!("not looked for: the state has {components} components"))]
        }
        Err(NoSteadyMotions::NoApproximation) => {
            vec![Entry::words("not looked for: the equations have no derivatives at the start")]
        }
    })
}

/// Judges steady motions in the linear theory of the model, so that all commands have one verdict.
struct Judge<'g> {
    t: f64,
    model: Option<(LinearModel<'g>, Conserved<'g>)>,
}

/// Components that differ by this fraction are the same.
const SAME: f64 = 1e-6;

impl<'g> Judge<'g> {
    fn new(ground: &Basis<'_, 'g>, integrals: &Integrals<'g>) -> Judge<'g> {
        let (assembly, equations) = (ground.assembly, &ground.equations);
        let model = LinearModel::of(assembly, equations, || integrals.clone(), &[]).ok();
        let with_conserved = |model: LinearModel<'g>| {
            let conserved = model.conserved(equations, integrals);
            (model, conserved)
        };
        Judge { t: assembly.t_start, model: model.map(with_conserved) }
    }

    /// The linearization at a steady motion, and its stability; none where the linear theory does not apply, or its
    /// velocities do not determine the state.
    fn judged(&mut self, motion: &NearbySteadyMotion) -> Option<(Linearization, Stability)> {
        let (model, conserved) = self.model.as_mut()?;
        let velocities = model.linearizer.quasi_velocities();
        let value = |(place, name): (usize, &String)| {
            let known = motion.state.iter().find(|(known, _)| known == name);
            let unknown = if velocities.contains(&place) { 0.0 } else { model.start[place] };
            known.map_or(unknown, |&(_, value)| value)
        };
        let guess: Vec<f64> = model.linearizer.names().iter().enumerate().map(value).collect();
        let linear = model.linearizer.steady(self.t, &guess, &SteadyOptions::default()).ok()?;
        let stability = model.linearizer.stability(&linear, conserved).ok()?;
        is_at(&linear, &motion.state).then_some((linear, stability))
    }

    /// The steady motions next to the start, to its reversal, and to motions along one velocity alone, of a stability that none
    /// of the list has; of each stability the first.
    fn near(&mut self, mut known: Vec<String>) -> Vec<(Linearization, Stability)> {
        let Some((model, conserved)) = self.model.as_mut() else { return Vec::new() };
        let velocities = model.linearizer.quasi_velocities();
        let speed = model.start[velocities.clone()].iter().fold(0.0_f64, |norm, eta| norm.hypot(*eta));
        let moving = |velocity: &dyn Fn(usize) -> f64| {
            let mut guess = model.start.clone();
            velocities.clone().for_each(|i| guess[i] = velocity(i));
            guess
        };
        let along = |s: usize, speed: f64| moving(&|i| if i == s { speed } else { 0.0 });
        let mut guesses = vec![model.start.clone(), moving(&|i| -model.start[i])];
        guesses.extend(velocities.clone().flat_map(|s| [along(s, speed), along(s, -speed)]));
        let mut near: Vec<(Linearization, Stability)> = Vec::new();
        for guess in guesses {
            let found = model.linearizer.steady(self.t, &guess, &SteadyOptions::default());
            let Ok(linear) = found else { continue };
            let Ok(stability) = model.linearizer.stability(&linear, conserved) else { continue };
            let words = stability_in_words(&stability);
            if !known.contains(&words) {
                known.push(words);
                near.push((linear, stability));
            }
        }
        near
    }
}

/// Whether these components have the same values in the state of a linearization, except for cyclic coordinates.
fn is_at(linear: &Linearization, components: &[(String, f64)]) -> bool {
    let is_cyclic = |name: &str| linear.cyclic.iter().any(|(cyclic, _)| cyclic == name);
    components.iter().filter(|(name, _)| !is_cyclic(name)).all(|(name, value)| {
        let found = linear.state.iter().find(|(known, _)| known == name);
        found.is_none_or(|(_, found)| (found - value).abs() <= SAME * (1.0 + value.abs()))
    })
}

fn entry<'g>(found: &FoundSteadyMotion, judged: Option<(Linearization, Stability)>) -> Entry<'g> {
    let motion = &found.motion;
    let clean = |value: f64| if value.abs() <= ZERO { 0.0 } else { value };
    let state = motion.state.iter().map(|(name, value)| (name.clone(), clean(*value)));
    let rates = motion.rates.iter().map(|(name, rate)| (format!("{name}'"), clean(*rate)));
    let (eigenvalues, stability) = match judged {
        Some((linear, stability)) => (linear.spectrum.eigenvalues().to_vec(), stability),
        None => (motion.eigenvalues.clone(), decided(motion)),
    };
    let in_words = eigenvalues_in_words(&eigenvalues, motion.tolerance.max(ZERO)).join(", ");
    let same = (!motion.same.is_empty()).then(|| format!("with the {} of the start", motion.same.join(", ")));
    let family = match found.family {
        0 => None,
        1 => Some("the nearest to the start of a family of 1 dimension".to_owned()),
        n => Some(format!("the nearest to the start of a family of {n} dimensions")),
    };
    let words = [Some(stability_in_words(&stability)), Some(format!("eigenvalues {in_words}")), same, family];
    Entry {
        values: state.chain(rates).collect(),
        words: words.into_iter().flatten().collect(),
        spectrum: eigenvalues.iter().map(|value| (clean(value.real), clean(value.imaginary))).collect(),
        ..Entry::default()
    }
    .with_on("stability", verdict(&stability, &eigenvalues))
}

/// The stability by the search alone, unless eigenvalues that may be rounding errors have decided it.
fn decided(motion: &NearbySteadyMotion) -> Stability {
    let largest = motion.eigenvalues.iter().map(|l| l.real.hypot(l.imaginary)).fold(0.0, f64::max);
    let rightmost = motion.eigenvalues.iter().map(|l| l.real).fold(f64::NEG_INFINITY, f64::max);
    match motion.stability() {
        Stability::ByFirstApproximation(_) if rightmost.abs() <= DECISIVE * largest => {
            Stability::Undecided { second_variation: motion.second_variation.is_some() }
        }
        stability => stability,
    }
}

/// A steady motion that the linear theory reaches from next to the start.
fn near_entry<'g>(linear: &Linearization, stability: &Stability) -> Entry<'g> {
    let clean = |value: f64| if value.abs() <= ZERO { 0.0 } else { value };
    let moves = |name: &str| linear.cyclic.iter().any(|(cyclic, _)| cyclic == name);
    let state = linear.state.iter().filter(|(name, _)| !moves(name));
    let state = state.map(|(name, value)| (name.clone(), clean(*value)));
    let eigenvalues = linear.spectrum.eigenvalues();
    let in_words = eigenvalues_in_words(eigenvalues, linear.spectrum.tolerance().max(ZERO)).join(", ");
    Entry {
        values: state.collect(),
        words: vec![stability_in_words(stability), format!("eigenvalues {in_words}")],
        spectrum: eigenvalues.iter().map(|value| (clean(value.real), clean(value.imaginary))).collect(),
        ..Entry::default()
    }
    .with_on("stability", verdict(stability, eigenvalues))
}

/// The verdict that a stability is.
fn verdict(stability: &Stability, eigenvalues: &[Eigenvalue]) -> Verdict {
    match stability {
        Stability::BySecondVariation { .. } | Stability::ByIntegral { .. } => Verdict::Proved,
        Stability::AsymptoticBut { .. } => Verdict::Proved,
        Stability::ByFirstApproximation(Of::Stable | Of::AsymptoticallyStable) => Verdict::Proved,
        Stability::ByFirstApproximation(Of::Unstable) => {
            let growth = eigenvalues.iter().map(|value| value.real).fold(0.0, f64::max);
            Verdict::Unstable { growth }
        }
        Stability::ByFirstApproximation(Of::Undecided) | Stability::Undecided { .. } => Verdict::Open,
    }
}

/// The stability in words, with the criterion that shows it.
pub fn stability_in_words(stability: &Stability) -> String {
    let by_second_variation = |variables: &Option<Vec<String>>, of: &str| {
        let seen = variables.as_ref().map_or(String::new(), |all| format!(" in {}", all.join(", ")));
        format!("stable{seen}, by the second variation of {of}")
    };
    match stability {
        Stability::BySecondVariation { variables } => by_second_variation(variables, "the energy"),
        Stability::ByIntegral { name, variables } => {
            by_second_variation(variables, &format!("the integral {name}"))
        }
        Stability::AsymptoticBut { directions } => {
            let directions = match directions {
                1 => "one neutral direction".to_owned(),
                count => format!("{count} neutral directions"),
            };
            format!("asymptotically stable except for {directions}, by the first approximation")
        }
        Stability::Undecided { second_variation: true } => {
            "undecided by the first approximation and by the second variation of the energy".to_owned()
        }
        Stability::Undecided { second_variation: false } => "undecided by the first approximation".to_owned(),
        Stability::ByFirstApproximation(verdict) => format!("{verdict}, by the first approximation"),
    }
}

/// The eigenvalues in words, with conjugate ones together and equal ones counted: `0.5, ±2i, 0 (twice)`.
pub fn eigenvalues_in_words(eigenvalues: &[Eigenvalue], zero: f64) -> Vec<String> {
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
