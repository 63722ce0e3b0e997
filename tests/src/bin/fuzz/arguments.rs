//! The command line of the differential tester.

use std::path::PathBuf;
use std::time::Duration;

use pc_tests::fuzz::campaign::{Campaign, Subject};

pub(crate) const USAGE: &str = "usage: fuzz models|trees [--count N] [--seed S] [--first K] [--model K] [--threads T] [--emitted-every N] \
     [--save DIR]";

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
            _ => return Err("what is varied are `models` or `trees`".to_owned()),
        };
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        let limit = Duration::from_secs(60);
        let campaign =
            Campaign { subject, seed: 1, first: 0, count: 20_000, threads, emitted_every: 50, limit };
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
                other => return Err(format!("there is no `{other}`")),
            }
        }
        Ok(arguments)
    }
}
