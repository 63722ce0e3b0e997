//! The command line of the differential tester.

use std::path::PathBuf;
use std::time::Duration;

use pc_tests::fuzz::campaign::{Campaign, Subject};
use pc_tests::fuzz::program::Program;

pub(crate) const USAGE: &str = "usage: fuzz models|trees|breaks [--count N] [--seed S] [--first K] [--model K] [--threads T] [--emitted-every N] \
     [--program-every N] [--units-every N] [--save DIR]
Every 50th model is emitted and compiled; every 5th is tried by commands of the program `pc`, and run in other units. \
     Other numbers may be given; 0 is for none";

/// What is to be done.
#[derive(Debug)]
pub(crate) struct Arguments {
    pub(crate) campaign: Campaign,
    /// The one model that is shown.
    pub(crate) model: Option<u64>,
    /// Where models with findings are written.
    pub(crate) save: Option<PathBuf>,
}

impl Arguments {
    pub(crate) fn of(mut words: impl Iterator<Item = String>) -> Result<Arguments, String> {
        let subject = match words.next().as_deref() {
            Some("models") => Subject::Models,
            Some("trees") => Subject::Trees,
            Some("breaks") => Subject::Breaks,
            _ => return Err("what is varied are `models`, `trees` or `breaks`".to_owned()),
        };
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        let limit = Duration::from_secs(60);
        let campaign = Campaign {
            subject,
            seed: 1,
            first: 0,
            count: 20_000,
            threads,
            emitted_every: 50,
            program: Program::near_this_executable(),
            program_every: 5,
            units_every: 5,
            limit,
        };
        let mut arguments = Arguments { campaign, model: None, save: None };
        while let Some(word) = words.next() {
            let mut text = || words.next().ok_or_else(|| format!("`{word}` needs a value"));
            if word == "--save" {
                arguments.save = Some(text()?.into());
                continue;
            }
            let mut number = || -> Result<u64, String> {
                let text = text()?;
                text.parse().map_err(|_| format!("`{word}` needs a number, not `{text}`"))
            };
            let campaign = &mut arguments.campaign;
            match word.as_str() {
                "--count" => campaign.count = number()?,
                "--seed" => campaign.seed = number()?,
                "--first" => campaign.first = number()?,
                "--model" => arguments.model = Some(number()?),
                "--threads" => campaign.threads = number()?.clamp(1, 1024) as usize,
                "--emitted-every" => campaign.emitted_every = number()?,
                "--program-every" => campaign.program_every = number()?,
                "--units-every" => campaign.units_every = number()?,
                other => return Err(format!("there is no `{other}`")),
            }
        }
        if arguments.campaign.program_every > 0 && arguments.campaign.program.is_none() {
            let how =
                "`cargo build -p pc-cli` with the same profile makes it, `--program-every 0` does without";
            return Err(format!("there is no program `pc` beside this one: {how}"));
        }
        Ok(arguments)
    }
}
