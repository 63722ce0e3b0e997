//! Arguments of `pc live`.

use std::time::Duration;

use clap::Args;

use crate::args::options::{bytes, seconds};

/// Arguments of `pc live`.
#[derive(Clone, Debug, Args)]
#[command(after_help = "Examples:\n  \
                        pc live my-model.toml\n  \
                        pc live tilted-disk --port 8420\n\n\
                        The page is for browsers on this computer alone, and its address, which is printed, is known to nobody else. \
                        It has the text on the left, and on the right the motion, plots, equations and verdicts, which are \
                        computed again as you type. Sliders change parameters and starts, and a button for each command shows the \
                        line that does the same. The page saves to the file of the model, and to no other.")]
pub struct LiveArguments {
    /// A file, `-` for standard input, or a built-in name
    pub model: String,
    /// The port on which the page is served [default: any that is free]
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    pub port: u16,
    /// Memory limit for the expressions of one computation, such as 500M or 8G
    #[arg(long, value_name = "BYTES", value_parser = bytes, default_value = "2G")]
    pub limit_memory: u64,
    /// Time limit in seconds for one computation [default: 60]
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub limit_time: Option<Duration>,
}
