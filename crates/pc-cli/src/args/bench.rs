//! Arguments of `pc bench`.

use std::path::PathBuf;
use std::time::Duration;

use clap::Args;

use crate::args::options;
use crate::args::options::{Format, ModelArguments};

/// Arguments of `pc bench`.
#[derive(Clone, Debug, Args)]
pub struct BenchArguments {
    /// The model.
    #[command(flatten)]
    pub model: ModelArguments,
    /// Approximate number of seconds to spend, half of them on derivations; each derivation is made at least once
    #[arg(long, value_name = "SECONDS", value_parser = options::seconds, default_value = "2")]
    pub seconds: Duration,
    /// How to print
    #[arg(long, default_value = "text")]
    pub format: Format,
    /// Write to FILE instead of standard output
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
}
