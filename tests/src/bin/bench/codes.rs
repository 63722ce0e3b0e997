//! `bench codes`: a model that is derived once, loaded, and shared by threads, through libpc.

use std::fs;
use std::hint::black_box;
use std::num::NonZero;
use std::sync::Barrier;
use std::thread::{self, ScopedJoinHandle};
use std::time::Instant;

use pc_model::Builtin;
use pc_tests::through_c::{Code, Handles};

use crate::error::Error;
use crate::measure::Times;
use crate::report::{Report, triple};

const MODELS: [&str; 4] = ["heavy-top-euler", "whipple-bicycle", "puma-560", "quadruped"];
/// How often a model is derived, and loaded.
const TURNS: usize = 15;
/// Systems whose memory is measured together.
const SYSTEMS: usize = 200;
const THREADS: [usize; 4] = [1, 2, 4, 16];
/// How long all threads together evaluate, by the time that one thread takes.
const SECONDS: f64 = 0.2;
/// How often each number of threads has its turn.
const ROUNDS: usize = 9;

/// Times derivation and loading, then evaluations on several threads.
///
/// # Errors
/// [`Error::Refused`] if libpc refuses a call.
pub(crate) fn run(report: &mut Report) -> Result<(), Error> {
    report.line(format!(
        "ms to the first ẏ, minimum, 10th percentile and median of {TURNS} turns: `derived` from the text, `loaded` from \
         what `pc_code_save` gave, of which `system` is the time without ẏ, for which machine code is made. `kB a system` \
         is the growth of the resident memory by each of {SYSTEMS} systems of one code that have evaluated ẏ.\n"
    ));
    report.columns(&["model", "derived", "loaded", "system", "derived / loaded", "kB saved", "kB a system"]);
    for name in MODELS {
        starts(report, name)?;
    }
    report.line(format!(
        "\nEvaluations of ẏ a second on all threads, relative to one thread: the median of {ROUNDS} rounds, in each of which \
         every number of threads has its turn, on {} processors.\n",
        thread::available_parallelism().map_or(1, NonZero::get)
    ));
    let threads = THREADS.map(|threads| threads.to_string());
    let columns: Vec<&str> = ["model"].into_iter().chain(threads.iter().map(String::as_str)).collect();
    report.columns(&columns);
    for name in MODELS {
        scaling(report, name)?;
    }
    Ok(())
}

fn text(name: &'static str) -> Result<&'static str, Error> {
    Builtin::named(name).map(|builtin| builtin.text).ok_or(Error::NoModel { name })
}

fn derived(name: &'static str) -> Result<Code, Error> {
    Code::derived(text(name)?).ok_or(Error::Refused { call: "pc_code_new" })
}

fn system(code: &Code) -> Result<Handles, Error> {
    code.system().ok_or(Error::Refused { call: "pc_system_of_code" })
}

/// ẏ at the start.
fn first(handles: &Handles) -> Result<(), Error> {
    let y = handles.start().ok_or(Error::Refused { call: "pc_system_start" })?;
    let mut dy = vec![0.0; y.len()];
    if !handles.by_handle(&y, &mut dy) {
        return Err(Error::Refused { call: "pc_system_rhs" });
    }
    black_box(dy);
    Ok(())
}

fn starts(report: &mut Report, name: &'static str) -> Result<(), Error> {
    let mut times = [Times::default(), Times::default(), Times::default()];
    let mut kept = (0, 0.0);
    for _ in 0..TURNS {
        let clock = Instant::now();
        let code = derived(name)?;
        first(&system(&code)?)?;
        times[0].0.push(clock.elapsed().as_secs_f64() * 1e3);
        let bytes = code.saved().ok_or(Error::Refused { call: "pc_code_save" })?;
        drop(code);
        let clock = Instant::now();
        let code = Code::loaded(&bytes).ok_or(Error::Refused { call: "pc_code_load" })?;
        let handles = system(&code)?;
        times[2].0.push(clock.elapsed().as_secs_f64() * 1e3);
        first(&handles)?;
        times[1].0.push(clock.elapsed().as_secs_f64() * 1e3);
        kept = (bytes.len(), memory(&code)?);
    }
    let [derived, loaded, system] = &times;
    report.row(&[
        name.to_owned(),
        triple(derived, 1),
        triple(loaded, 1),
        triple(system, 1),
        format!("{:.0}", derived.ratio_to(loaded)),
        format!("{}", kept.0 / 1000),
        format!("{:.0}", kept.1),
    ]);
    Ok(())
}

/// kB by which the resident memory grows with each system.
fn memory(code: &Code) -> Result<f64, Error> {
    let before = resident();
    let mut systems = Vec::with_capacity(SYSTEMS);
    for _ in 0..SYSTEMS {
        let handles = system(code)?;
        first(&handles)?;
        systems.push(handles);
    }
    Ok((resident() - before) / SYSTEMS as f64)
}

/// The resident memory in kB, where the system tells it.
fn resident() -> f64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    line.and_then(|line| line.trim().trim_end_matches(" kB").parse().ok()).unwrap_or(f64::NAN)
}

fn scaling(report: &mut Report, name: &'static str) -> Result<(), Error> {
    let code = derived(name)?;
    let calls = (SECONDS / evaluations(&code, 1, 1000)? * 1000.0) as usize;
    let mut rates = THREADS.map(|_| Times::default());
    for _ in 0..ROUNDS {
        for (threads, rates) in THREADS.into_iter().zip(&mut rates) {
            let each = calls.div_ceil(threads);
            rates.0.push((each * threads) as f64 / evaluations(&code, threads, each)?);
        }
    }
    let relative = rates.iter().map(|rate| format!("{:.2}", rate.ratio_to(&rates[0])));
    report.row(&[name.to_owned()].into_iter().chain(relative).collect::<Vec<_>>());
    Ok(())
}

/// The seconds in which so many threads make so many evaluations each, with a system of its own for each thread.
fn evaluations(code: &Code, threads: usize, calls: usize) -> Result<f64, Error> {
    let ready = Barrier::new(threads + 1);
    thread::scope(|scope| {
        let work = || -> Result<(), Error> {
            let handles = system(code).and_then(|handles| first(&handles).map(|()| handles));
            ready.wait();
            let handles = handles?;
            let y = handles.start().ok_or(Error::Refused { call: "pc_system_start" })?;
            let mut dy = vec![0.0; y.len()];
            for _ in 0..calls {
                if !handles.by_handle(&y, &mut dy) {
                    return Err(Error::Refused { call: "pc_system_rhs" });
                }
                black_box(&dy);
            }
            Ok(())
        };
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        ready.wait();
        let clock = Instant::now();
        let ended: Vec<_> = workers.into_iter().map(ScopedJoinHandle::join).collect();
        let seconds = clock.elapsed().as_secs_f64();
        for worker in ended {
            worker.map_err(|_| Error::Refused { call: "a thread" })??;
        }
        Ok(seconds)
    })
}
