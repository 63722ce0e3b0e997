//! Equilibria and steady motions, and their stability.

use pc_analysis::{
    Eigenvalue, FoundSteadyMotion, Integrals, NoSteadyMotions, Stability, SteadyMotions, Verdict as Of,
};
use pc_model::ModelError;

use crate::theory::basis::Basis;
use crate::theory::description::{Entry, Section, Verdict};
use crate::words::words::short;

/// Numbers up to this size count as zero: Newton's method leaves such remainders in place of zeros.
const ZERO: f64 = 1e-9;

/// The largest number of members of families that are listed.
const MOST_LISTED: usize = 8;

/// The section on all steady motions found, or on the nearest of many.
pub(crate) fn section<'g>(
    ground: &Basis<'_, 'g>,
    integrals: &Integrals<'g>,
) -> Result<Section<'g>, ModelError> {
    let section =
        |entries| Ok(Section { key: "steady_motions", title: "Steady motions", names: Vec::new(), entries });
    if ground.assembly.constraints.nonlinear().is_some() {
        return section(vec![Entry::words("not looked for: a constraint is not affine in the velocities")]);
    }
    if ground.has_external_forces() {
        return section(vec![Entry::words("not looked for: forces are computed outside")]);
    }
    let (equations, assembly) = (&ground.equations, ground.assembly);
    let mut motion = assembly.placed(equations.compile())?;
    let start = assembly.start_of(&equations.system().state());
    let at = (assembly.t_start, start.as_slice());
    let found =
        SteadyMotions::search(equations, &mut motion, at, integrals.list(), &assembly.held_positions());
    section(match found {
        Ok(found) if found.list.is_empty() => {
            vec![Entry::words(format!("none found from {} starts", found.starts))]
        }
        Ok(found) => {
            let all = (1..).zip(found.list.iter().take(MOST_LISTED));
            let more = found.list.len().saturating_sub(MOST_LISTED);
            let more =
                (more > 0).then(|| Entry::words(format!("{more} more are found: they are not isolated")));
            let starts = Entry::words(format!("found from {} starts; there may be others", found.starts));
            all.map(|(number, found)| entry(number, found)).chain(more).chain([starts]).collect()
        }
        Err(NoSteadyMotions::NotAutonomous) => vec![Entry::words("none: the equations depend on time")],
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

fn entry<'g>(number: usize, found: &FoundSteadyMotion) -> Entry<'g> {
    let motion = &found.motion;
    let clean = |value: f64| if value.abs() <= ZERO { 0.0 } else { value };
    let state = motion.state.iter().map(|(name, value)| (name.clone(), clean(*value)));
    let rates = motion.rates.iter().map(|(name, rate)| (format!("{name}'"), clean(*rate)));
    let stability = motion.stability();
    let eigenvalues = eigenvalues_in_words(&motion.eigenvalues, motion.tolerance.max(ZERO)).join(", ");
    let same = (!motion.same.is_empty()).then(|| format!("with the {} of the start", motion.same.join(", ")));
    let family = match found.family {
        0 => None,
        1 => Some("the nearest to the start of a family of 1 dimension".to_owned()),
        n => Some(format!("the nearest to the start of a family of {n} dimensions")),
    };
    let words =
        [Some(stability_in_words(&stability)), Some(format!("eigenvalues {eigenvalues}")), same, family];
    let verdict = match &stability {
        Stability::BySecondVariation { .. } | Stability::AsymptoticBut { .. } => Verdict::Proved,
        Stability::ByFirstApproximation(Of::Stable | Of::AsymptoticallyStable) => Verdict::Proved,
        Stability::ByFirstApproximation(Of::Unstable) => {
            let growth = motion.eigenvalues.iter().map(|value| value.real).fold(0.0, f64::max);
            Verdict::Unstable { growth }
        }
        Stability::ByFirstApproximation(Of::Undecided) | Stability::Undecided { .. } => Verdict::Open,
    };
    Entry {
        values: state.chain(rates).collect(),
        words: words.into_iter().flatten().collect(),
        spectrum: motion
            .eigenvalues
            .iter()
            .map(|value| (clean(value.real), clean(value.imaginary)))
            .collect(),
        ..Entry::default()
    }
    .named(number.to_string())
    .with_on("stability", verdict)
}

/// The stability in words, with the criterion that shows it.
pub fn stability_in_words(stability: &Stability) -> String {
    match stability {
        Stability::BySecondVariation { variables: None } => {
            "stable, by the second variation of the energy".to_owned()
        }
        Stability::BySecondVariation { variables: Some(variables) } => {
            format!("stable in {}, by the second variation of the energy", variables.join(", "))
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
