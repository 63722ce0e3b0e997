//! The differential tester: `cargo xtask fuzz models|trees|breaks [--count N] [--seed S] [--model K] [--threads T]
//! [--program-every N] [--save DIR]`.
//!
//! It runs random models over the whole text format and compares what the product makes of them with independent
//! computations. The same seed gives the same models with any number of threads; `--model K` shows one of them, `--save DIR`
//! writes those with findings.

mod arguments;

use std::fs;
use std::process::ExitCode;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use arguments::Arguments;
use pc_tests::fuzz::breaks;
use pc_tests::fuzz::campaign::{Campaign, Subject};
use pc_tests::fuzz::examination::{Examined, note_panics};
use pc_tests::fuzz::generator;
use pc_tests::fuzz::report::Report;
use pc_tests::fuzz::shrink::shrink;

fn main() -> ExitCode {
    let arguments = match Arguments::of(std::env::args().skip(1)) {
        Ok(arguments) => arguments,
        Err(message) => {
            eprintln!("fuzz: {message}\n{}", arguments::USAGE);
            return ExitCode::from(2);
        }
    };
    note_panics();
    match arguments.model {
        Some(index) => one(&arguments.campaign, index),
        None => many(&arguments),
    }
}

/// Shows a model, what came of it, and the shortest that has the same findings.
fn one(campaign: &Campaign, index: u64) -> ExitCode {
    let examined = campaign.subject.examine(campaign.seed, index, campaign.thoroughness(index));
    show(&examined);
    for refusal in &examined.refusals {
        println!("# refused, {}: {}", refusal.stage, refusal.message.replace('\n', "\n#   "));
    }
    let kinds: Vec<&str> = examined.findings.iter().map(|finding| finding.kind).collect();
    kinds.iter().for_each(|kind| show_shrunk(campaign, index, kind));
    ExitCode::from(u8::from(!kinds.is_empty()))
}

fn many(arguments: &Arguments) -> ExitCode {
    let campaign = &arguments.campaign;
    let begin = Instant::now();
    let (done, found) = (AtomicU64::new(0), AtomicU64::new(0));
    // What is found is said and saved at once: a run that is ended keeps it.
    let results = campaign.run(|index, examined| {
        if !examined.findings.is_empty() {
            found.fetch_add(1, Ordering::Relaxed);
            keep(arguments, index, examined);
        }
        let done = done.fetch_add(1, Ordering::Relaxed) + 1;
        if done.is_multiple_of(1000) {
            let (seconds, found) = (begin.elapsed().as_secs_f64(), found.load(Ordering::Relaxed));
            eprintln!("{done} of {} models, {found} with findings, {seconds:.0} s", campaign.count);
        }
    });
    let report = Report::of(&results);
    println!("seed {}, {:.0} s", campaign.seed, begin.elapsed().as_secs_f64());
    print!("{}", report.text());
    for (kind, first) in report.kinds() {
        show_shrunk(campaign, first, kind);
    }
    ExitCode::from(u8::from(!report.is_clean()))
}

/// Says what was found with a model, and writes the model if it is to be saved.
fn keep(arguments: &Arguments, index: u64, examined: &Examined) {
    for finding in &examined.findings {
        eprintln!("model {index}: {}", finding.kind);
    }
    let Some(directory) = &arguments.save else { return };
    let path = directory.join(format!("{}-{index}.toml", arguments.campaign.seed));
    if let Err(error) = fs::create_dir_all(directory).and_then(|()| fs::write(&path, shown(examined))) {
        eprintln!("fuzz: `{}` cannot be written: {error}", path.display());
    }
}

/// Of a tree nothing is shrunk: it has few bodies.
fn show_shrunk(campaign: &Campaign, index: u64, kind: &str) {
    let examined = match campaign.subject {
        Subject::Trees => return,
        Subject::Breaks => breaks::shrink(campaign.seed, index, kind, campaign.limit),
        Subject::Models => {
            let specimen = generator::specimen(campaign.seed, index);
            shrink(&specimen, kind, &campaign.thoroughness(index)).1
        }
    };
    println!("\n# model {index} of seed {}, shrunk: {kind}", campaign.seed);
    show(&examined);
}

fn show(examined: &Examined) {
    println!("{}", shown(examined));
}

/// The text with what was found, and the twin as a comment.
fn shown(examined: &Examined) -> String {
    let comment = |text: &str| format!("# {}\n", text.trim_end().replace('\n', "\n# "));
    let findings: String = examined.findings.iter().map(|finding| comment(&finding.to_string())).collect();
    let twin = examined
        .twin
        .as_ref()
        .map_or_else(String::new, |twin| format!("# the same in ordinary velocities\n{}", comment(twin)));
    format!("{findings}{}{twin}", examined.text)
}
