//! What the page asks for.

use std::collections::BTreeMap;

use serde::Deserialize;

use crate::args::options::Setting;

/// A text with the choices of the page.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct Job {
    pub(super) text: String,
    /// Values other than those of the text, as for `--set`.
    #[serde(default)]
    pub(super) set: BTreeMap<String, String>,
    /// The end of the motion, if the page says one.
    pub(super) t_end: Option<f64>,
    /// The name of a form; empty or missing for that of the text.
    #[serde(default)]
    pub(super) form: String,
}

/// A command to be done, and what it is done to.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct Order {
    pub(super) what: String,
    #[serde(flatten)]
    pub(super) job: Job,
    /// What a sweep varies, as for `--vary`.
    pub(super) vary: Option<String>,
    /// The time of a picture, as for `--time`.
    pub(super) at: Option<String>,
}

/// A text to be saved.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct Saving {
    pub(super) text: String,
    #[serde(default)]
    pub(super) force: bool,
}

impl Job {
    /// The values as settings.
    pub(super) fn settings(&self) -> Vec<Setting> {
        let setting =
            |(name, value): (&String, &String)| Setting { name: name.clone(), value: value.clone() };
        self.set.iter().map(setting).collect()
    }
}
