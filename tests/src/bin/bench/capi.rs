//! `bench capi`: evaluations and integrations through the functions of libpc, against those by hand.

#![expect(unsafe_code, reason = "calls a C interface")]

use std::hint::black_box;
use std::time::Instant;

use pc::pc_method;
use pc_tests::through_c::{self, Handles, Rhs, Subject};

use crate::error::Error;
use crate::hand::{self, Hand, Routine};
use crate::measure::{Call, ROUNDS, Times, Variant, geometric_mean, interleave};
use crate::report::{Report, triple};
use crate::solve::{self, Plain};

/// Variants of a right-hand side may differ by this, relative to the largest component; for long chains rounding grows with the
/// condition of the mass matrix.
const ROUNDING: f64 = 1e-11;
/// Least number of integrations of each variant, and how long they are repeated.
const TURNS: usize = 15;
const SECONDS: f64 = 2.0;
const TOLERANCE: f64 = 1e-9;
/// By how much the start, relative to itself, is another one from turn to turn.
const SPREAD: f64 = 1e-9;

/// Times evaluations, then integrations.
///
/// # Errors
/// [`Error::Refused`] if libpc refuses a call, [`Error::Disagreement`] if variants differ.
pub(crate) fn run(report: &mut Report) -> Result<(), Error> {
    evaluations(report)?;
    integrations(report)
}

fn made(subject: &Subject) -> Result<Handles, Error> {
    Handles::of(&subject.text).ok_or(Error::Refused { call: "a system" })
}

fn evaluations(report: &mut Report) -> Result<(), Error> {
    report.line(format!(
        "ns a call: minimum, 10th percentile and median of {ROUNDS} rounds, in each of which every variant has one \
         turn of about 100 µs. `pointer` is `pc_kernel_rhs`, as integrators are given it, parameters free; `handle` is \
         `pc_system_rhs`, which checks lengths and overlaps and that nobody changes the parameters meanwhile. \
         `/ hand` is the median over the rounds of the ratio to the best by hand within a round.\n"
    ));
    report.columns(&["system", "variant", "min", "p10", "median", "/ hand"]);
    let pendulum = |links| vec![hand::pendulum(links), hand::pendulum_by_tensions(links)];
    let short: Vec<(Subject, Vec<Hand>)> = vec![
        (through_c::top(), vec![hand::poisson()]),
        (through_c::sleigh(), vec![hand::sleigh()]),
        (through_c::disk(), vec![hand::disk()]),
        (through_c::pendulum(2), pendulum(2)),
        (through_c::pendulum(4), pendulum(4)),
        (through_c::pendulum(8), pendulum(8)),
    ];
    let long: Vec<(Subject, Vec<Hand>)> =
        [16, 32].map(|links| (through_c::chain_of_masses(links), pendulum(links))).into();
    let mut ratios = Vec::new();
    for (subject, hands) in &short {
        ratios.push(evaluate(report, subject, hands)?);
    }
    let largest = ratios.iter().copied().fold(0.0, f64::max);
    for (subject, hands) in &long {
        evaluate(report, subject, hands)?;
    }
    let mean = geometric_mean(&ratios);
    report.line(format!("\ngeometric mean pointer/hand to 8 links {mean:.2}, largest {largest:.2}\n"));
    Ok(())
}

/// A table of one system; returns the ratio of `pointer` to the best by hand.
fn evaluate(report: &mut Report, subject: &Subject, hands: &[Hand]) -> Result<f64, Error> {
    let handles = made(subject)?;
    let mut variants: Vec<Variant<'_>> =
        hands.iter().map(|&hand| Variant::new("hand", enter(hand.into()))).collect();
    variants.push(Variant::new("pointer", by_pointer(&handles)));
    variants.push(Variant::new("handle", by_handle(&handles)));
    let reference = variants[0].at(&subject.start);
    let size = reference.iter().fold(1.0f64, |size, v| size.max(v.abs()));
    for variant in &mut variants[1..] {
        for (component, (a, b)) in variant.at(&subject.start).iter().zip(&reference).enumerate() {
            let error = (a - b).abs() / size;
            if error.is_nan() || error > ROUNDING {
                return Err(Error::Disagreement {
                    system: subject.name.clone(),
                    variant: variant.name.clone(),
                    reference: "hand".to_owned(),
                    component,
                    error,
                    state: subject.start.clone(),
                });
            }
        }
    }
    let times = interleave(&subject.start, &mut variants);
    let best = (0..hands.len()).min_by(|&i, &j| times[i].median().total_cmp(&times[j].median())).unwrap_or(0);
    let mut of_pointer = f64::NAN;
    for (i, (variant, taken)) in variants.iter().zip(&times).enumerate() {
        let ratio = taken.ratio_to(&times[best]);
        if i == hands.len() {
            of_pointer = ratio;
        }
        let numbers = [taken.min(), taken.p10(), taken.median()].map(|time| format!("{time:.1}"));
        let mut row = vec![subject.name.clone(), variant.name.clone()];
        row.extend(numbers);
        row.push(format!("{ratio:.2}"));
        report.row(&row);
    }
    Ok(of_pointer)
}

fn enter(mut routine: Routine) -> Box<Call<'static>> {
    Box::new(move |y, dy| routine.call(y, dy))
}

fn by_handle(handles: &Handles) -> Box<Call<'_>> {
    Box::new(move |y, dy| {
        if !handles.by_handle(&y[..dy.len()], dy) {
            dy.fill(f64::NAN);
        }
    })
}

fn by_pointer(handles: &Handles) -> Box<Call<'_>> {
    let (rhs, kernel) = handles.pointers();
    let rhs: Rhs = black_box(rhs);
    Box::new(move |y, dy| {
        // SAFETY: a live kernel that only this thread uses, and arrays as long as its state.
        if unsafe { rhs(0.0, y.as_ptr(), dy.as_mut_ptr(), kernel) } != 0 {
            dy.fill(f64::NAN);
        }
    })
}

/// A method, which C passes as a number.
type Choice = fn() -> pc_method;
/// One integration from this start; the number of steps.
type Integrate<'a> = Box<dyn FnMut(&[f64]) -> Result<u64, Error> + 'a>;

/// DOP853 by hand on the kernel of libpc.
fn by_hand(handles: &Handles, end: f64) -> Integrate<'_> {
    fn of<const N: usize>((rhs, kernel): (Rhs, *mut std::ffi::c_void), start: &[f64], end: f64) -> u64 {
        let mut y = [0.0; N];
        y.copy_from_slice(start);
        let f = |y: &[f64; N], dy: &mut [f64; N]| {
            // SAFETY: a live kernel that only this thread uses, and arrays as long as its state.
            if unsafe { rhs(0.0, y.as_ptr(), dy.as_mut_ptr(), kernel) } != 0 {
                dy.fill(f64::NAN);
            }
        };
        hand::integrate(f, y, end, (TOLERANCE, TOLERANCE * 1e-3)).1
    }
    let pointers = handles.pointers();
    Box::new(move |start| {
        Ok(match start.len() {
            6 => of::<6>(pointers, start, end),
            8 => of::<8>(pointers, start, end),
            32 => of::<32>(pointers, start, end),
            found => unreachable!("a state of {found} numbers"),
        })
    })
}

fn ours(handles: &Handles, method: Choice, end: f64) -> Integrate<'_> {
    Box::new(move |start| {
        let done = handles.integrate(method(), (TOLERANCE, TOLERANCE * 1e-3), start, end);
        done.map(|(_, steps)| steps).ok_or(Error::Refused { call: "an integration" })
    })
}

fn integrations(report: &mut Report) -> Result<(), Error> {
    report.line(format!(
        "ms from the creation of the solver to its destruction, rtol {TOLERANCE:e}: minimum, 10th percentile and median \
         of at least {TURNS} integrations of each variant in turns. `dop853 by hand` is a loop for a state of known length \
         on `pc_kernel_rhs`; `C` is `bench solve`'s program, with right-hand side and Jacobian by hand. `/` is the \
         median of the ratios of time a step to that of the first of each group.\n"
    ));
    report.columns(&["motion", "variant", "steps", "ms", "/"]);
    let dop853 = || pc_method::PC_DOP853;
    let taylor = || pc_method::PC_TAYLOR;
    let mut worst: f64 = 0.0;
    for subject in
        [through_c::top(), through_c::disk(), through_c::disk_by_definitions(), through_c::pendulum(16)]
    {
        let handles = made(&subject)?;
        let end = subject.end;
        let variants = vec![
            ("dop853 by hand", by_hand(&handles, end)),
            ("dop853", ours(&handles, dop853, end)),
            ("taylor", ours(&handles, taylor, end)),
        ];
        worst = worst.max(integrate(report, &subject, variants)?);
    }
    let directory =
        tempfile::tempdir().map_err(|source| Error::Start { command: "tempdir".into(), source })?;
    let program = solve::compiled(directory.path())?;
    let adams = || pc_method::PC_ADAMS;
    let bdf = || pc_method::PC_BDF;
    let plain: [(&str, Subject, Choice); 4] = [
        ("top", through_c::symmetric_top(), adams),
        ("disk", through_c::disk(), adams),
        ("pendulum", through_c::pendulum(16), adams),
        ("sleigh", through_c::stiff_sleigh(), bdf),
    ];
    let mut worst_cvode: f64 = 0.0;
    for (name, subject, method) in plain {
        let handles = made(&subject)?;
        let mut plain = Plain::start(&program, name, TOLERANCE)?;
        let start = subject.start.clone();
        let by_c: Integrate<'_> = Box::new(move |from| {
            let place = start.iter().position(|&y| y != 0.0).unwrap_or(0);
            plain.integrate(from[place] / start[place]).map(|answer| answer.steps)
        });
        let variants = vec![("C", by_c), ("cvode", ours(&handles, method, subject.end))];
        worst_cvode = worst_cvode.max(integrate(report, &subject, variants)?);
    }
    report.line(format!(
        "\nworst of dop853 to the loop by hand, a step: {worst:.2}; of cvode to plain C, a step: {worst_cvode:.2}"
    ));
    Ok(())
}

/// A table of one motion; returns the ratio of the second variant to the first, a step.
fn integrate(
    report: &mut Report,
    subject: &Subject,
    mut variants: Vec<(&str, Integrate<'_>)>,
) -> Result<f64, Error> {
    let mut times: Vec<Times> = variants.iter().map(|_| Times::default()).collect();
    let mut each = times.clone();
    let mut steps = vec![0; variants.len()];
    let begun = Instant::now();
    while times[0].0.len() < TURNS || begun.elapsed().as_secs_f64() < SECONDS {
        let turn = times[0].0.len();
        let start: Vec<f64> = subject.start.iter().map(|y| y * (1.0 + SPREAD * turn as f64)).collect();
        for i in 0..variants.len() {
            let clock = Instant::now();
            steps[i] = variants[i].1(&start)?;
            let milliseconds = clock.elapsed().as_secs_f64() * 1e3;
            times[i].0.push(milliseconds);
            each[i].0.push(milliseconds / steps[i] as f64);
        }
    }
    for (i, (name, _)) in variants.iter().enumerate() {
        report.row(&[
            subject.name.clone(),
            (*name).to_owned(),
            steps[i].to_string(),
            triple(&times[i], 3),
            format!("{:.2}", each[i].ratio_to(&each[0])),
        ]);
    }
    Ok(each[1].ratio_to(&each[0]))
}
