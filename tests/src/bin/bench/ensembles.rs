//! Many motions at once: an ensemble of heavy tops in lanes, and the same by hand.

use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::time::Instant;

use pc_expr::LaneField;
use pc_mech::{Graph, VectorField};
use pc_solve::{Ensemble, Method, Options, Trajectory, solve};
use pc_tests::classical::SplitMix64;

use crate::error::Error;
use crate::hand;
use crate::measure::Times;
use crate::report::{Report, triple};
use crate::systems::SYSTEMS;

/// Members, to what time, and the tolerance of ours.
const MEMBERS: usize = 10_000;
const END: f64 = 10.0;
const RTOL: f64 = 1e-9;
/// So many members are compared with exact ones.
const COMPARED: usize = 200;
/// How often each variant gets its turn.
const ROUNDS: usize = 15;
/// By hand tolerances are tried from ten times ours down, so many for each power of ten.
const PER_DECADE: i32 = 32;

const ABOUT: &str = "10 000 heavy tops, 10";

/// Tops on random heights with random velocities.
fn starts() -> Vec<[f64; 6]> {
    let mut random = SplitMix64::new(3);
    let mut start = || {
        let (z, angle) = (random.uniform(-0.9, 0.9), random.uniform(-3.0, 3.0));
        let r = f64::sqrt(1.0 - z * z);
        let spin = [0.0; 3].map(|_: f64| random.uniform(-2.0, 2.0));
        [r * angle.cos(), r * angle.sin(), z, spin[0], spin[1], spin[2]]
    };
    (0..MEMBERS).map(|_| start()).collect()
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs() / b.abs().max(1.0)).fold(0.0, f64::max)
}

/// The median of the errors of the first members.
fn error(found: &[[f64; 6]], exact: &[Vec<f64>]) -> f64 {
    let mut errors: Vec<f64> = found.iter().zip(exact).map(|(found, exact)| distance(found, exact)).collect();
    errors.sort_by(f64::total_cmp);
    errors[errors.len() / 2]
}

fn ensemble(threads: usize) -> Ensemble<'static> {
    Ensemble::new().threads(NonZeroUsize::new(threads).unwrap_or(NonZeroUsize::MIN))
}

/// The states at the end, in the lanes of an ensemble, and the number of steps.
fn ours(
    ensemble: &Ensemble<'_>,
    field: &LaneField,
    starts: &[[f64; 6]],
) -> Result<(Vec<[f64; 6]>, u64), Error> {
    let options = Options::new(Method::Dop853).relative_tolerance(RTOL).absolute_tolerance(RTOL * 1e-3);
    let (mut ends, mut steps) = (Vec::with_capacity(starts.len()), 0);
    let begin = |member: u64| ((), Some((field.clone(), starts[member as usize].to_vec())));
    let end = |_, (), motion: Trajectory| {
        let mut y = [0.0; 6];
        y.copy_from_slice(motion.state(0));
        Some((y, motion.statistics().lane_steps))
    };
    let ending = ensemble.map_in_lanes(
        0..starts.len() as u64,
        (0.0, &[END], &options),
        begin,
        end,
        |_, (), _| None,
        |_, result| match result {
            Ok(Some((y, more))) => {
                ends.push(y);
                steps += more;
                ControlFlow::Continue(())
            }
            _ => ControlFlow::Break(()),
        },
    );
    match ending {
        Ok(_) if ends.len() == starts.len() => Ok((ends, steps)),
        _ => Err(Error::Ensemble { members: starts.len(), ended: ends.len() }),
    }
}

/// Times both; the ratio of the trajectories in a second, ours to those by hand, or none where there are no vectors.
///
/// # Errors
/// [`Error::Ensemble`] where members do not come to their end.
pub(crate) fn compare(report: &mut Report) -> Result<Option<f64>, Error> {
    let graph = Graph::new();
    let mut motion = SYSTEMS[0](&graph)?.equations.compile()?;
    let Some(field) = motion.lanes() else {
        return Err(Error::Ensemble { members: MEMBERS, ended: 0 });
    };
    let starts = starts();
    let tight = Options::new(Method::Dop853).relative_tolerance(1e-14).absolute_tolerance(1e-16);
    let mut exact = Vec::new();
    for start in &starts[..COMPARED] {
        exact.push(solve(&mut motion, 0.0, start, &[END], &tight)?.state(0).to_vec());
    }
    let by_hand = |rtol: f64, threads: usize| {
        let mut states = starts.clone();
        hand::tops(&mut states, END, rtol, threads).map(|()| states)
    };
    let ensembles = [ensemble(1), ensemble(2)];
    let clock = Instant::now();
    ours(&ensembles[0], &field, &starts[..1])?;
    let making = clock.elapsed().as_secs_f64() * 1e3;
    let (found, steps) = ours(&ensembles[0], &field, &starts)?;
    ours(&ensembles[1], &field, &starts)?;
    let of_ours = error(&found, &exact);
    // The largest tolerance by which the code by hand errs as little.
    let (mut rtol, mut of_hand) = (10.0 * RTOL, f64::INFINITY);
    for step in 1..4 * PER_DECADE {
        let mut some = starts[..COMPARED].to_vec();
        if hand::tops(&mut some, END, rtol, 1).is_none() {
            report.line("no vectors of AVX2 or AVX-512 here, and so no ensemble by hand");
            return Ok(None);
        }
        of_hand = error(&some, &exact);
        if of_hand <= of_ours {
            break;
        }
        rtol = 10.0 * RTOL * 10f64.powf(-f64::from(step) / f64::from(PER_DECADE));
    }

    let mut times: [Times; 4] = std::array::from_fn(|_| Times::default());
    for round in 0..ROUNDS {
        for turn in 0..4 {
            let i = if round % 2 == 0 { turn } else { 3 - turn };
            let threads = 1 + i % 2;
            let clock = Instant::now();
            if i < 2 {
                std::hint::black_box(by_hand(rtol, threads));
            } else {
                std::hint::black_box(ours(&ensembles[threads - 1], &field, &starts)?);
            }
            times[i].0.push(clock.elapsed().as_secs_f64() * 1e3);
        }
    }
    let names = ["lockstep by hand", "lockstep by hand, 2 threads", "ensemble", "ensemble, 2 threads"];
    for (i, name) in names.into_iter().enumerate() {
        let (rtol, error) = if i < 2 { (rtol, of_hand) } else { (RTOL, of_ours) };
        let steps = if i < 2 { "-".to_owned() } else { steps.to_string() };
        report.row(&[
            ABOUT.to_owned(),
            name.to_owned(),
            format!("{rtol:.1e}"),
            steps,
            format!("{error:.1e}"),
            triple(&times[i], 1),
            format!("{:.2}", times[i].ratio_to(&times[i % 2])),
        ]);
    }
    let speeds: Vec<String> =
        times.iter().map(|times| format!("{:.0} 000", MEMBERS as f64 / times.median())).collect();
    report.line(format!(
        "\nTrajectories a second: {}. Two threads over one: {:.2} by hand, {:.2} ours. \
         Before, making the machine code of ours and starting a thread took {making:.2} ms.",
        speeds.join(", "),
        times[0].ratio_to(&times[1]),
        times[2].ratio_to(&times[3])
    ));
    Ok(Some(times[0].ratio_to(&times[2])))
}

/// Runs the benchmark of ensembles alone.
///
/// # Errors
/// Those of [`compare`].
pub(crate) fn run(report: &mut Report) -> Result<(), Error> {
    report.line(format!(
        "ms for all members: minimum, 10th percentile and median of {ROUNDS} rounds in turns, at equal median error of \
         {COMPARED} members. `/ hand` is the median of the ratios of neighbours with as many threads. By hand are vectors of the \
         processor, with one step for all lanes.\n"
    ));
    report.columns(&["problem", "variant", "rtol", "steps", "error", "ms", "/ hand"]);
    if let Some(ratio) = compare(report)? {
        report.line(format!("\nensemble/hand, trajectories a second: {ratio:.2}"));
    }
    Ok(())
}
