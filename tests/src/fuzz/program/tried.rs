//! A model that the program is tried on, with what this process knows of it.

use std::path::Path;

use pc_model::{Document, Flow, Model, Source, Variables};

use super::child::{Outcome, Program};
use super::table::Table;
use super::{MODEL, Tally};
use crate::fuzz::execution::{Execution, Refusal};
use crate::fuzz::random::Random;

/// What the program says where its two derivations disagree.
const DISAGREE: &str = "the two derivations disagree";

/// A model in its directory.
pub(super) struct Tried<'a> {
    program: &'a Program,
    directory: &'a Path,
    /// What was run here.
    pub(super) execution: &'a Execution,
    /// Names and values of parameters.
    pub(super) parameters: Vec<(String, f64)>,
    /// Names and values of what has a start.
    pub(super) starts: Vec<(String, f64)>,
    /// What velocities are described by.
    pub(super) quasi_velocities: Vec<String>,
    /// The rates of its equations.
    pub(super) flow: Flow,
    /// The time of the start.
    pub(super) t_start: f64,
    pub(super) random: &'a mut Random,
    pub(super) tally: Tally,
}

impl<'a> Tried<'a> {
    pub(super) fn new(
        program: &'a Program,
        directory: &'a Path,
        text: &str,
        execution: &'a Execution,
        random: &'a mut Random,
    ) -> Option<Tried<'a>> {
        let model = Model::new(Document::parse(Source::new(MODEL, text)).ok()?);
        let graph = model.graph();
        let assembly = model.assemble(&graph).ok()?;
        let mut flow = Flow::new(&model, &assembly, Variables::QuasiVelocities).ok()?;
        let row = flow.row(assembly.t_start, &flow.start.clone());
        let starts: Vec<(String, f64)> = flow.names.iter().cloned().zip(row).collect();
        let coordinates = flow.motion.coordinates();
        let quasi_velocities = flow.names[coordinates..coordinates + flow.quasi_velocities()].to_vec();
        let parameters = model.parameters().map(|(name, value)| (name.to_owned(), value)).collect();
        let (t_start, tally) = (assembly.t_start, Tally::default());
        Some(Tried {
            program,
            directory,
            execution,
            parameters,
            starts,
            quasi_velocities,
            flow,
            t_start,
            random,
            tally,
        })
    }

    /// What is in a file of the directory.
    pub(super) fn contents(&self, name: &str) -> String {
        std::fs::read_to_string(self.directory.join(name)).unwrap_or_default()
    }

    /// Calls the program; what is wrong whatever the command is noted.
    pub(super) fn call(&mut self, command: &str, arguments: &[String]) -> Outcome {
        let all = [&[command.to_owned(), MODEL.to_owned()], arguments].concat();
        let outcome = self.program.call(self.directory, &all);
        let agrees = matches!(self.execution.second, Some(Ok(_)));
        judge(&outcome, &all, agrees, &mut self.tally);
        outcome
    }

    /// The same, of which the standard output is wanted; a refusal is counted at its stage.
    pub(super) fn output(
        &mut self,
        stage: &'static str,
        command: &str,
        arguments: &[String],
    ) -> Option<String> {
        match self.call(command, arguments) {
            Outcome::Done(output) => Some(output),
            Outcome::Refused(code, message) => {
                let message = format!("{} (exit code {code}, {command} {})", message, arguments.join(" "));
                self.tally.refusals.push(Refusal { stage, message });
                None
            }
            Outcome::Crashed(_) | Outcome::Late => None,
        }
    }

    /// The table of an output; one that is none is noted, and so is what is no number in rows that are wanted.
    pub(super) fn table(
        &mut self,
        text: &str,
        arguments: &[String],
        wanted: impl Fn(&Table, usize) -> bool,
    ) -> Option<Table> {
        match Table::of(text) {
            Ok(table) => {
                let undefined = table.not_a_number(|row| wanted(&table, row));
                // Outputs have values where their functions have: those of this process are the measure.
                let here = self.execution.motion.rows.iter().flatten().all(|number| number.is_finite());
                if let Some(undefined) = undefined.filter(|_| here) {
                    let detail = format!("{undefined}: {}", arguments.join(" "));
                    self.tally.find("the program writes what is no number", detail);
                }
                Some(table)
            }
            Err(error) => {
                self.tally
                    .find("the program writes what is no table", format!("{error}: {}", arguments.join(" ")));
                None
            }
        }
    }

    /// A name with a number for `--set` and the like.
    pub(super) fn value_of(&self, name: &str) -> Option<f64> {
        self.parameters.iter().chain(&self.starts).find(|(known, _)| known == name).map(|(_, value)| *value)
    }
}

/// Notes what is wrong with an outcome whatever the command: `agrees` where the derivations agree in this process.
pub(super) fn judge(outcome: &Outcome, arguments: &[String], agrees: bool, tally: &mut Tally) {
    let command = arguments.join(" ");
    match outcome {
        Outcome::Done(_) => {}
        Outcome::Refused(4, message) if agrees && message.contains(DISAGREE) => {
            tally.find("the program sees derivations that disagree", format!("pc {command}: {message}"));
        }
        Outcome::Refused(..) => {}
        Outcome::Crashed(message) => {
            tally.find("the program ends by a panic or a signal", format!("pc {command}: {message}"));
        }
        Outcome::Late => {
            let message = format!("no end: pc {command}");
            tally.refusals.push(Refusal { stage: "pc, time", message });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn false_alarms_and_crashes_are_findings_and_refusals_are_none() {
        let arguments = ["run".to_owned(), MODEL.to_owned()];
        let found = |outcome: Outcome, agrees| {
            let mut tally = Tally::default();
            judge(&outcome, &arguments, agrees, &mut tally);
            tally.findings.first().map(|finding| finding.kind)
        };
        let alarm = || Outcome::Refused(4, format!("{DISAGREE}: the rate of x'"));
        assert_eq!(found(alarm(), true), Some("the program sees derivations that disagree"));
        assert_eq!(found(alarm(), false), None);
        assert_eq!(found(Outcome::Refused(4, "not steady".to_owned()), true), None);
        let crash = Outcome::Crashed("signal: 11".to_owned());
        assert_eq!(found(crash, true), Some("the program ends by a panic or a signal"));
    }
}
