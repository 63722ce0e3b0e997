//! `cargo xtask test`: everything that has to hold before a change goes in.
//!
//! `stage` lists what is done, each part in a process group of its own with its own limit; `programs` builds and runs the test
//! programs, `libtest` follows what they say, `limited` kills what takes too long, by the times in `usual`; `touched` finds what a
//! change concerns, and `report` is the last page.

mod libtest;
mod limited;
mod programs;
mod report;
mod stage;
mod touched;
mod usual;

use std::collections::BTreeSet;
use std::time::{Duration, Instant};

use crate::counts::Counts;
use crate::error::Error;
use report::{Report, Verdict, seconds};
pub(crate) use stage::run_alone as stage;
use stage::{AFTER, BEFORE, Stage};

/// Which of the tests are wanted.
#[derive(Debug, Default, PartialEq, Eq)]
pub(crate) struct Wanted {
    /// Nothing after the test programs, and no long tests.
    pub(crate) quick: bool,
    /// Only what can behave otherwise than at this revision.
    pub(crate) since: Option<String>,
}

/// Runs the stages in order and stops at the first that fails; a failure of one test program does not keep the others from
/// running.
///
/// The last lines are the stages with their times, the slowest tests, and the sum over all tests.
///
/// # Errors
/// That of the first stage that fails.
pub(crate) fn run(wanted: &Wanted) -> Result<(), Error> {
    let touched = wanted.since.as_deref().map(touched::since).transpose()?;
    let mut work = Work { report: Report::default(), counts: Counts::default(), touched };
    let outcome = work.everything(wanted.quick);
    print!("{}", work.report);
    outcome?;
    if wanted.since.is_none() && work.counts.executed() == 0 {
        return Err(Error::NoTests);
    }
    println!("{}", work.counts);
    Ok(())
}

/// What is done so far.
struct Work {
    report: Report,
    counts: Counts,
    /// The packages that are tried; all of them where none are named.
    touched: Option<BTreeSet<String>>,
}

impl Work {
    fn everything(&mut self, quick: bool) -> Result<(), Error> {
        BEFORE.iter().try_for_each(|stage| self.stage(stage))?;
        let tests = self.tests(quick);
        let documentation = self.stage(&stage::DOCUMENTATION_TESTS);
        tests.and(documentation)?;
        if quick { Ok(()) } else { AFTER.iter().try_for_each(|stage| self.stage(stage)) }
    }

    /// Whether packages are tried; everything concerns a stage without packages.
    fn concerns(&self, packages: &[&str]) -> bool {
        let Some(touched) = &self.touched else { return true };
        packages.is_empty() || packages.iter().any(|&package| touched.contains(package))
    }

    fn stage(&mut self, stage: &Stage) -> Result<(), Error> {
        if !self.concerns(stage.packages) {
            self.report.stage(stage.title, Verdict::Untouched, Duration::ZERO);
            return Ok(());
        }
        println!("\n== {}", stage.title);
        let start = Instant::now();
        let outcome = stage.run(|line| self.counts.add_line(line));
        let verdict = match &outcome {
            Ok(()) => Verdict::Passed,
            Err(Error::Unavailable { .. }) => Verdict::Skipped,
            Err(_) => Verdict::Failed,
        };
        self.over(stage.title, verdict, start);
        match outcome {
            Err(Error::Unavailable { what }) => {
                self.report.skipped.push(format!("{}: {what}", stage.title));
                Ok(())
            }
            outcome => outcome,
        }
    }

    /// The test programs, one after the other; each uses all processors.
    fn tests(&mut self, quick: bool) -> Result<(), Error> {
        let title = "build of everything";
        println!("\n== {title}");
        let start = Instant::now();
        let built = programs::build(usual::limit(stage::BUILD));
        self.over(title, if built.is_ok() { Verdict::Passed } else { Verdict::Failed }, start);
        let mut first = None;
        for program in
            built?.into_iter().filter(|program| self.concerns(&[program.package()])).collect::<Vec<_>>()
        {
            let start = Instant::now();
            let run = programs::run(&program, &mut self.counts, quick)?;
            let verdict = if run.failure.is_none() { Verdict::Passed } else { Verdict::Failed };
            self.over(&program.name, verdict, start);
            self.report.tests(run.tests);
            if let Some(failure) = run.failure {
                println!("== {failure}");
                first = first.or(Some(failure));
            }
        }
        first.map_or(Ok(()), |failure| Err(Error::Tests { counts: self.counts, failure: Box::new(failure) }))
    }

    fn over(&mut self, title: &str, verdict: Verdict, start: Instant) {
        let took = start.elapsed();
        println!("== {title} {verdict} in {}", seconds(took));
        self.report.stage(title, verdict, took);
    }
}
