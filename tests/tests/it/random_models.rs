//! Random models over the whole text format agree with independent computations, in every form of the product.

use std::time::Duration;

use pc_tests::fuzz::campaign::{Campaign, Subject};
use pc_tests::fuzz::examination::note_panics;
use pc_tests::fuzz::program::Program;
use pc_tests::fuzz::report::Report;

/// Enough for each way of writing a model to be met some dozen times; `cargo xtask fuzz models` tries more.
const MODELS: u64 = 500;
/// Each joint a dozen times.
const TREES: u64 = 40;
/// Each kind of piece some times.
const BREAKS: u64 = 40;
/// Commands of the program on a few of them.
const PROGRAM_EVERY: u64 = 20;
/// Every so many are run in other units.
const UNITS_EVERY: u64 = 20;

#[test]
fn random_models_agree_with_independent_computations() {
    agree(Subject::Models, MODELS);
    agree(Subject::Trees, TREES);
}

#[test]
fn random_motions_over_breaks_agree_with_an_independent_integration() {
    agree(Subject::Breaks, BREAKS);
}

fn agree(subject: Subject, count: u64) {
    note_panics();
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let program = Program::near_this_executable();
    if program.is_none() {
        println!("left out: commands of the program, which is not built");
    }
    let campaign = Campaign {
        subject,
        seed: 1,
        first: 0,
        count,
        threads,
        emitted_every: 50,
        program,
        program_every: PROGRAM_EVERY,
        units_every: UNITS_EVERY,
        limit: Duration::from_secs(3600),
    };
    let report = Report::of(&campaign.run(|_, _| ()));
    // Panics of models are noted, not printed.
    println!("{}", report.text());
    assert!(report.is_clean());
    // A tester whose models are all refused sees nothing.
    assert!(report.ran() * 10 > 8 * usize::try_from(count).unwrap_or(0));
}
