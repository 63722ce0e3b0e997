//! `bench speed`: whole integrations to one global error, by our methods and by DOP853 by hand on right-hand sides by hand.

use std::time::Instant;

use pc_mech::{Graph, Motion};
use pc_solve::{Method, Options, solve};

use crate::ensembles;
use crate::error::Error;
use crate::hand::{self, Hand, Routine};
use crate::measure::Times;
use crate::report::{Report, triple};
use crate::systems::{SYSTEMS, pendulum};

/// The global error, the largest of the components relative to the larger of 1 and their size.
const ERROR: f64 = 1e-8;
/// Least number of rounds, and how long they are repeated.
const ROUNDS: usize = 25;
const SECONDS: f64 = 3.0;
/// Tolerances are tried from 1e-6 down, so many for each power of ten.
const PER_DECADE: i32 = 8;
/// By how much the start, relative to itself, is another one from round to round.
const SPREAD: f64 = 1e-9;

/// A motion, derived and by hand.
struct Problem {
    about: &'static str,
    motion: Motion,
    hand: Routine,
    start: Vec<f64>,
    end: f64,
}

/// One way to integrate it; steps and y(end).
type Integrate<'a> = Box<dyn FnMut(f64, &[f64]) -> Result<(u64, Vec<f64>), Error> + 'a>;

fn problems() -> Result<Vec<Problem>, Error> {
    let case = |place: usize, about, start: &[f64], end| -> Result<Problem, Error> {
        let graph = Graph::new();
        let case = SYSTEMS[place](&graph)?;
        let (motion, hand) = (case.equations.compile()?, case.hand[0].1.into());
        Ok(Problem { about, motion, hand, start: start.to_vec(), end })
    };
    // Starts of which an error grows little.
    let top = [0.6, 0.0, 0.8, 0.1, 0.2, 3.0];
    let disk = [0.0, 0.0, 0.0, 1.2, 0.0, 0.2, 0.5, 4.0];
    let graph = Graph::new();
    let chain = |hand: Hand| -> Result<Problem, Error> {
        Ok(Problem {
            about: "pendulum of 16 links, 10",
            motion: pendulum(&graph, 16)?.poincare()?.compile()?,
            hand: hand.into(),
            start: [vec![0.2; 16], vec![0.0; 16]].concat(),
            end: 10.0,
        })
    };
    Ok(vec![
        case(0, "heavy top, 100", &top, 100.0)?,
        case(4, "tilted disk, 100", &disk, 100.0)?,
        chain(hand::pendulum(16))?,
    ])
}

/// By hand, for the lengths of state that there are.
fn by_hand<'a>(hand: &'a mut Routine, end: f64) -> Integrate<'a> {
    fn of<const N: usize>(hand: &mut Routine, start: &[f64], end: f64, rtol: f64) -> (u64, Vec<f64>) {
        let mut y = [0.0; N];
        y.copy_from_slice(start);
        let (y, steps) = hand::integrate(|y: &[f64; N], dy| hand.call(y, dy), y, end, (rtol, rtol * 1e-3));
        (steps, y.to_vec())
    }
    Box::new(move |rtol, start| match start.len() {
        6 => Ok(of::<6>(hand, start, end, rtol)),
        8 => Ok(of::<8>(hand, start, end, rtol)),
        32 => Ok(of::<32>(hand, start, end, rtol)),
        found => unreachable!("a state of {found} numbers"),
    })
}

fn ours<'a>(motion: &'a mut Motion, method: Method, end: f64) -> Integrate<'a> {
    Box::new(move |rtol, start| {
        let options = Options::new(method)
            .relative_tolerance(rtol)
            .absolute_tolerance(rtol * 1e-3)
            .max_steps(10_000_000);
        let found = solve(&mut *motion, 0.0, start, &[end], &options)?;
        Ok((found.statistics().steps, found.state(0).to_vec()))
    })
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs() / b.abs().max(1.0)).fold(0.0, f64::max)
}

/// The largest tolerance that leads to the error, with a tenth as a margin for other starts.
fn tolerance(integrate: &mut Integrate<'_>, start: &[f64], exact: &[f64]) -> Result<f64, Error> {
    let mut rtol = 1e-6;
    for step in 0..8 * PER_DECADE {
        rtol = 10f64.powf(-6.0 - f64::from(step) / f64::from(PER_DECADE));
        if distance(&integrate(rtol, start)?.1, exact) <= 0.9 * ERROR {
            break;
        }
    }
    Ok(rtol)
}

/// Times all problems; the last line is the worst of the ratios to DOP853 by hand.
///
/// # Errors
/// [`Error::Apart`] where a method does not come to the error.
pub(crate) fn run(report: &mut Report) -> Result<(), Error> {
    report.line(format!(
        "ms from the creation of the solver to its destruction: minimum, 10th percentile and median of at least \
         {ROUNDS} integrations of each variant in turns, each at the largest tolerance (eight for each power of ten) \
         that leads to a global error of {ERROR:e}; the absolute tolerance is a thousandth of the relative one. \
         `/ hand` is the median of the ratios of neighbours. By hand is DOP853 for a state of known length \
         on the right-hand side of `bench rhs`.\n"
    ));
    report.columns(&["problem", "variant", "rtol", "steps", "error", "ms", "/ hand"]);
    let (mut worst, mut worst_taylor) = (0.0_f64, 0.0_f64);
    for Problem { about, mut motion, mut hand, start, end } in problems()? {
        let mut others = [motion.clone(), motion.clone(), motion.clone()];
        let (_, exact) = ours(&mut motion, Method::Dop853, end)(1e-14, &start)?;
        let check = ours(&mut motion, Method::Adams, end)(1e-13, &start)?.1;
        if distance(&check, &exact) > 0.1 * ERROR {
            return Err(Error::Apart { system: about, rtol: 1e-13, distance: distance(&check, &exact) });
        }
        let [dop, adams, taylor] = &mut others;
        let mut variants: [(&str, Integrate<'_>); 4] = [
            ("dop853 by hand", by_hand(&mut hand, end)),
            ("dop853", ours(dop, Method::Dop853, end)),
            ("adams", ours(adams, Method::Adams, end)),
            ("taylor", ours(taylor, Method::Taylor, end)),
        ];
        let mut tolerances = [0.0; 4];
        for (rtol, (_, integrate)) in tolerances.iter_mut().zip(&mut variants) {
            *rtol = tolerance(integrate, &start, &exact)?;
        }
        let mut times: [Times; 4] = std::array::from_fn(|_| Times::default());
        let mut found: [(u64, f64); 4] = Default::default();
        let begun = Instant::now();
        while times[0].0.len() < ROUNDS || begun.elapsed().as_secs_f64() < SECONDS {
            let round = times[0].0.len();
            let here: Vec<f64> = start.iter().map(|y| y * (1.0 + SPREAD * round as f64)).collect();
            for turn in 0..variants.len() {
                let i = if round.is_multiple_of(2) { turn } else { variants.len() - 1 - turn };
                let clock = Instant::now();
                let (steps, y) = variants[i].1(tolerances[i], &here)?;
                times[i].0.push(clock.elapsed().as_secs_f64() * 1e3);
                if round == 0 {
                    found[i] = (steps, distance(&y, &exact));
                }
            }
        }
        for (i, (name, _)) in variants.iter().enumerate() {
            let ratio = times[i].ratio_to(&times[0]);
            if *name == "dop853" {
                worst = worst.max(ratio);
            }
            // A method of series is for short right-hand sides: the pendulum is shown, not counted.
            if *name == "taylor" && start.len() <= 8 {
                worst_taylor = worst_taylor.max(ratio);
            }
            report.row(&[
                about.to_owned(),
                (*name).to_owned(),
                format!("{:.1e}", tolerances[i]),
                found[i].0.to_string(),
                format!("{:.1e}", found[i].1),
                triple(&times[i], 3),
                format!("{ratio:.2}"),
            ]);
        }
    }
    let ensemble = ensembles::compare(report)?.map_or("-".to_owned(), |ratio| format!("{ratio:.2}"));
    report.line(format!(
        "\nworst of taylor/hand-dop853 {worst_taylor:.2}, dop853/hand {worst:.2}, ensemble/hand {ensemble} \
         (in trajectories a second)"
    ));
    Ok(())
}
