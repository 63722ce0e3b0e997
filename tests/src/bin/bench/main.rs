//! The benchmarks of the workspace: `cargo xtask bench [NAME…]`.
//!
//! Each prints a Markdown table as it goes and leaves it in `target/bench/NAME.md`. Only the ratios between variants
//! of one run mean anything: variants are run in turns, so that whatever slows the machine slows all of them.

mod capi;
mod codes;
mod derive;
mod ensembles;
mod error;
mod hand;
mod measure;
mod mechanisms;
mod report;
mod rhs;
mod robots;
mod solve;
mod speed;
mod start;
mod systems;
mod trees;

use std::env;
use std::process::ExitCode;

use error::Error;
use report::Report;

/// A benchmark that can be asked for by name.
struct Benchmark {
    name: &'static str,
    about: &'static str,
    run: fn(&mut Report) -> Result<(), Error>,
}

const BENCHMARKS: &[Benchmark] = &[
    Benchmark {
        name: "rhs",
        about: "one evaluation of a right-hand side, derived and by hand",
        run: rhs::run,
    },
    Benchmark { name: "derive", about: "from the text of a model to its compiled motion", run: derive::run },
    Benchmark { name: "solve", about: "a whole integration, by us and by plain C", run: solve::run },
    Benchmark {
        name: "speed",
        about: "a whole integration to one global error, by our methods and by hand",
        run: speed::run,
    },
    Benchmark { name: "ensembles", about: "many motions at once, in lanes and by hand", run: ensembles::run },
    Benchmark {
        name: "trees",
        about: "chains of bodies, joint after joint, derived and by hand",
        run: trees::run,
    },
    Benchmark {
        name: "capi",
        about: "evaluations and integrations through libpc, against those by hand",
        run: capi::run,
    },
    Benchmark {
        name: "codes",
        about: "a model derived, loaded, and shared by threads, through libpc",
        run: codes::run,
    },
    Benchmark { name: "start", about: "a whole run of the program `pc`, start to exit", run: start::run },
];

fn main() -> ExitCode {
    let names: Vec<String> = env::args().skip(1).collect();
    let mut chosen = Vec::new();
    for name in &names {
        let Some(benchmark) = BENCHMARKS.iter().find(|benchmark| benchmark.name == name) else {
            eprintln!("bench: there is no benchmark `{name}`; there are");
            for Benchmark { name, about, .. } in BENCHMARKS {
                eprintln!("  {name:8} {about}");
            }
            return ExitCode::from(2);
        };
        chosen.push(benchmark);
    }
    if chosen.is_empty() {
        chosen.extend(BENCHMARKS);
    }
    for benchmark in chosen {
        let mut report = Report::new(benchmark.name, benchmark.about);
        if let Err(error) = (benchmark.run)(&mut report).and_then(|()| report.save()) {
            eprintln!("bench {}: {error}", benchmark.name);
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}
