//! The program `pc` on the text of a model, as users call it: by commands drawn at random, at its default options.
//!
//! ```text
//! text without tolerances ─► directory ─ child: `pc …` ─► Outcome ─► a refusal, or a table
//!                                                            runs        motions, against the tight motion of this process
//!                                                            members     of a sweep, against runs of their values
//!                                                            slopes      sensitivities, against differences of runs
//!                                                            rates       matrices and equilibria, against the rates of this process
//!                                                            linear      in other units, against that in its own
//!                                                            pages       what is printed and emitted: only that it is
//! ```
//! What runs in this process at tight tolerances need not run there: the program has its own options, limits, vectors of
//! members and pages. Each command has an end. A panic, an end by a signal, derivations that disagree though they agree here, and
//! a table that is none are findings whatever the command; other refusals are counted.

mod child;
mod linear;
mod members;
mod pages;
mod rates;
mod runs;
mod slopes;
mod table;
mod tried;

use std::fs;
use std::io;

use super::comparison::Finding;
use super::execution::{Execution, Refusal};
use super::random::Random;

use child::Outcome;
pub use child::Program;
use tried::{Tried, judge};

/// The name of the file in its directory.
const MODEL: &str = "model.toml";

/// The choices of commands are others than those of the generator, whose seed they have.
const COMMANDS: u64 = 0x70_63;

/// The program, and which of its commands are tried on a model.
#[derive(Clone, Debug)]
pub struct Session {
    program: Program,
    random: Random,
}

/// What came of the commands.
#[derive(Debug, Default)]
pub(super) struct Tally {
    pub(super) findings: Vec<Finding>,
    pub(super) refusals: Vec<Refusal>,
}

impl Session {
    /// The commands for model number `index` of a seed, the same each time.
    pub fn new(program: Program, seed: u64, index: u64) -> Session {
        Session { program, random: Random::new(seed ^ COMMANDS, index) }
    }

    /// Two or three commands on a text that was run here.
    pub(super) fn examine(mut self, text: &str, execution: &Execution) -> Tally {
        let count = 2 + self.random.below(2);
        let kinds: Vec<Kind> = (0..count).map(|_| Kind::drawn(&mut self.random)).collect();
        let directory = match tempfile::tempdir() {
            Ok(directory) => directory,
            Err(error) => return Tally::refused(format!("no directory for the program: {error}")),
        };
        let Some(mut tried) = Tried::new(&self.program, directory.path(), text, execution, &mut self.random)
        else {
            return Tally::refused("the text is no model any more".to_owned());
        };
        if let Err(error) = fs::write(directory.path().join(MODEL), at_default_options(text)) {
            return Tally::refused(format!("the text cannot be written: {error}"));
        }
        kinds.into_iter().for_each(|kind| kind.examine(&mut tried));
        tried.tally
    }

    /// A motion at default options; a refusal is a finding of texts that must run.
    pub(super) fn follow(self, text: &str, arguments: &[&str], must_run: bool) -> Tally {
        let mut tally = Tally::default();
        match self.ended(text, arguments, &mut tally) {
            Ok(Outcome::Refused(code, message)) if tally.findings.is_empty() => {
                let detail = format!("{message} (exit code {code}, run {})", arguments.join(" "));
                match must_run {
                    true => tally.find("the program refuses what it must run", detail),
                    false => tally.refusals.push(Refusal { stage: "pc run, for long", message: detail }),
                }
            }
            Ok(_) => {}
            Err(error) => return Tally::refused(format!("the program cannot be tried: {error}")),
        }
        tally
    }

    /// The motion of a model in other units, at default options: one that is refused though the original runs is a finding.
    pub(super) fn follow_in_other_units(self, text: &str, in_other_units: &str) -> Tally {
        let mut tally = Tally::default();
        let other = self.ended(in_other_units, &[], &mut tally);
        if let Ok(Outcome::Refused(code, message)) = other
            && tally.findings.is_empty()
            && let Ok(Outcome::Done(_)) = self.ended(text, &[], &mut tally)
        {
            tally.find(
                "the program refuses in other units",
                format!("{message} (exit code {code}): {in_other_units}"),
            );
        }
        tally
    }

    /// How `pc run` of a text ends. What is wrong whatever the text is noted.
    fn ended(&self, text: &str, arguments: &[&str], tally: &mut Tally) -> io::Result<Outcome> {
        let directory = tempfile::tempdir()?;
        fs::write(directory.path().join(MODEL), at_default_options(text))?;
        let words = ["run", MODEL].iter().chain(arguments).map(|&word| word.to_owned());
        let words: Vec<String> = words.collect();
        let outcome = self.program.call(directory.path(), &words);
        judge(&outcome, &words, true, tally);
        Ok(outcome)
    }
}

impl Tally {
    fn refused(message: String) -> Tally {
        Tally { refusals: vec![Refusal { stage: "pc", message }], ..Tally::default() }
    }

    fn find(&mut self, kind: &'static str, detail: String) {
        self.findings.push(Finding { kind, detail });
    }
}

/// What is asked of the program.
#[derive(Clone, Copy, Debug)]
enum Kind {
    Run,
    Sweep,
    Sensitivities,
    Linearize,
    Equilibria,
    Page,
}

impl Kind {
    /// Motions most often: most of what the program does is done for them.
    fn drawn(random: &mut Random) -> Kind {
        match random.below(100) {
            0..36 => Kind::Run,
            36..52 => Kind::Sweep,
            52..62 => Kind::Sensitivities,
            62..77 => Kind::Linearize,
            77..85 => Kind::Equilibria,
            _ => Kind::Page,
        }
    }

    fn examine(self, tried: &mut Tried<'_>) {
        match self {
            Kind::Run => runs::examine(tried),
            Kind::Sweep => members::examine(tried),
            Kind::Sensitivities => slopes::examine(tried),
            Kind::Linearize => rates::linearized(tried),
            Kind::Equilibria => rates::equilibria(tried),
            Kind::Page => pages::examine(tried),
        }
    }
}

/// The text without the entries that say how finely it is integrated and how many rows it has.
fn at_default_options(text: &str) -> String {
    let finely =
        |line: &&str| ["samples = ", "rtol = ", "atol = "].iter().any(|entry| line.starts_with(entry));
    text.lines().filter(|line| !finely(line)).map(|line| format!("{line}\n")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fuzz::execution::{Forms, execute};

    fn oscillator(stiffness: f64) -> String {
        format!(
            "[parameters]\nk = {stiffness:?}\n[coordinates]\nx = 0.5\n[quasi_velocities]\n\"x'\" = 0.2\n\
             [lagrangian]\nkinetic = \"x'^2/2\"\npotential = \"k*x^2\"\n[simulation]\nt_end = 1.0\nsamples = 5\n"
        )
    }

    /// What the commands of many models find in a text, where this process has run another.
    fn found(text: &str, run_here: &str) -> Option<Vec<&'static str>> {
        let Some(program) = Program::near_this_executable() else {
            println!("left out: the program is not built");
            return None;
        };
        let execution =
            execute("model.toml", run_here, Forms { second: true, ..Forms::ONE }).expect("a motion");
        let tally = |index| Session::new(program.clone(), 0, index).examine(text, &execution);
        let findings = (0..12).flat_map(|index| tally(index).findings);
        Some(findings.map(|finding| finding.kind).collect())
    }

    #[test]
    fn commands_agree_with_the_same_model_and_not_with_another() {
        let Some(of_the_same) = found(&oscillator(1.0), &oscillator(1.0)) else { return };
        assert_eq!(of_the_same, [""; 0]);
        let of_another = found(&oscillator(1.01), &oscillator(1.0)).unwrap_or_default();
        assert!(of_another.contains(&"the motion of the program differs"), "{of_another:?}");
    }

    #[test]
    fn a_text_is_tried_at_default_options() {
        let text = "[simulation]\nt_end = 1.0\nsamples = 5\nrtol = 1e-11\natol = 1e-13\n";
        assert_eq!(at_default_options(text), "[simulation]\nt_end = 1.0\n");
    }

    #[test]
    fn a_text_that_must_run_and_one_that_is_refused_in_other_units_are_findings() {
        let Some(program) = Program::near_this_executable() else { return };
        let session = || Session::new(program.clone(), 0, 0);
        let (right, wrong) = (oscillator(1.0), oscillator(1.0).replace("k*x^2", "1/(x - 0.5)"));
        assert!(session().follow(&right, &[], true).findings.is_empty());
        let refused = session().follow(&wrong, &[], true);
        assert_eq!(refused.findings[0].kind, "the program refuses what it must run");
        assert_eq!(session().follow(&wrong, &[], false).refusals[0].stage, "pc run, for long");
        let other = session().follow_in_other_units(&right, &wrong);
        assert_eq!(other.findings[0].kind, "the program refuses in other units");
        assert!(session().follow_in_other_units(&wrong, &wrong).findings.is_empty());
    }
}
