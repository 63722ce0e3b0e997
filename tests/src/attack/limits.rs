//! Large models of every kind within small limits.

mod expressions;
mod models;

use std::fs;
use std::io;

use crate::attack::victim::usage::Usage;
use crate::attack::victim::{Finding, Victim};
use crate::fuzz::random::Random;

pub use models::model;

/// Seconds and megabytes that a command may take, the latter for each of what is limited.
type Budget = (&'static str, &'static str);

const BUDGETS: &[Budget] = &[("0.3", "500M"), ("1", "500M"), ("3", "500M"), ("5", "50M"), ("5", "200M")];

/// Seconds by which a limit may be exceeded.
const SECONDS: f64 = 0.5;
/// How many times the memory for expressions a program may take.
const TIMES: f64 = 1.5;
/// Megabytes of a program that has nothing to do.
const PROGRAM: f64 = 40.0;

/// How far the limits were exceeded at most.
#[derive(Clone, Copy, Debug, Default)]
pub struct Worst {
    /// In seconds.
    pub seconds: f64,
    /// In megabytes.
    pub megabytes: f64,
}

/// Runs a model that lies in the directory of the victim, each time with another command, within so many of the limits, which
/// hold to the second where that is asked for.
///
/// # Errors
/// If the program cannot be run.
pub fn limits(
    victim: &Victim,
    model: &str,
    (budgets, is_timed): (usize, bool),
    worst: &mut Worst,
    random: &mut Random,
) -> io::Result<Vec<Finding>> {
    let mut findings = Vec::new();
    let mut order: Vec<Budget> = BUDGETS.to_vec();
    random.shuffle(&mut order);
    for (time, memory) in order.into_iter().take(budgets) {
        let command = *random.pick(COMMANDS);
        let limits = ["--limit-time", time, "--limit-memory", memory];
        let arguments = [&[command[0], model], &command[1..], &limits].concat();
        match victim.run(&arguments)? {
            Err(finding) => findings.push(finding),
            Ok(_) if !is_timed => {}
            Ok(ended) => {
                let works = if command[0] == "compare" { 2.0 } else { 1.0 };
                let exceeded = Exceeded::by(&ended.usage, time, memory, works);
                worst.seconds = worst.seconds.max(exceeded.seconds);
                worst.megabytes = worst.megabytes.max(exceeded.megabytes);
                findings.extend(exceeded.what(&ended.usage).map(|what| ended.finding(what)));
            }
        }
    }
    for name in ["out.csv", "out.csv.partial", "out.svg", "out.html", "out.urdf", "out.fmu"] {
        let _ = fs::remove_file(victim.file(name));
    }
    Ok(findings)
}

/// How far a run went beyond its limits.
struct Exceeded {
    seconds: f64,
    megabytes: f64,
}

impl Exceeded {
    /// By what a command took that does so many works, each within the limits.
    fn by(usage: &Usage, time: &str, memory: &str, works: f64) -> Exceeded {
        let number = |text: &str| text.trim_end_matches('M').parse::<f64>().unwrap_or(f64::INFINITY);
        Exceeded {
            seconds: usage.seconds() - works * number(time),
            megabytes: usage.megabytes() - works * TIMES * number(memory) - PROGRAM,
        }
    }

    fn what(&self, usage: &Usage) -> Option<String> {
        let seconds = (self.seconds > SECONDS)
            .then(|| format!("{:.1} s, {:.1} s beyond the limit", usage.seconds(), self.seconds));
        let megabytes = (self.megabytes > 0.0).then(|| {
            format!("{:.0} MB, {:.0} MB more than the limit allows", usage.megabytes(), self.megabytes)
        });
        let said: Vec<String> = seconds.into_iter().chain(megabytes).collect();
        (!said.is_empty()).then(|| said.join("; "))
    }
}

const COMMANDS: &[&[&str]] = &[
    &["check"],
    &["check", "--format", "json"],
    &["derive"],
    &["derive", "--inline"],
    &["derive", "--reactions", "--symbols"],
    &["derive", "--no-verify", "--format", "json"],
    &["derive", "--form", "canonical", "--format", "latex"],
    &["derive", "--form", "lagrange"],
    &["derive", "--form", "voronets"],
    &["derive", "--form", "reduced"],
    &["derive", "--form", "lie-poisson"],
    &["derive", "--form", "orthonormal"],
    &["derive", "--form", "hamel", "u=2*x0'"],
    &["derive", "--form", "maggi"],
    &["derive", "--form", "kane"],
    &["derive", "--form", "gibbs-appell"],
    &["theory"],
    &["theory", "--degree", "4"],
    &["theory", "--no-verify", "--format", "json"],
    &["emit", "--lang", "c", "-o", "emitted"],
    &["emit", "--lang", "rust", "-o", "-"],
    &["emit", "--fmu", "2", "--sources-only", "-o", "out.fmu"],
    &["emit", "--fmu", "3", "-o", "out.fmu"],
    &["run", "-o", "out.csv"],
    &["run", "--outputs", "reactions", "--plot", "out.svg", "-o", "out.csv"],
    &["run", "--form", "canonical", "-o", "out.csv"],
    &["run", "--form", "orthonormal", "--no-verify", "-o", "out.csv"],
    &["run", "--method", "taylor", "-o", "out.csv"],
    &["run", "--method", "bdf", "-o", "out.csv"],
    &["run", "--method", "adams", "--sensitivities", "p", "-o", "out.csv"],
    &["run", "--estimate", "-o", "out.csv"],
    &["run", "--project", "energy", "-o", "out.csv"],
    &["linearize"],
    &["linearize", "--at", "start", "--format", "json"],
    &["linearize", "--vary", "p=1:2:3", "-o", "out.csv"],
    &["equilibria", "--starts", "10"],
    &["report", "-o", "out.html"],
    &["animate", "-o", "out.html"],
    &["sweep", "--vary", "p=1:2:3", "-o", "out.csv"],
    &["sweep", "--of", "linearize", "--vary", "p=1:2:3", "-o", "out.csv"],
    &["sweep", "--of", "check", "--vary", "p=1:2:3", "-o", "out.csv"],
    &["compare", "--form", "poincare,canonical"],
    &["bench", "--seconds", "0.1"],
    &["export", "-o", "out.urdf"],
];
