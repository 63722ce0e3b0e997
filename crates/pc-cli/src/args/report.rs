//! Arguments of `pc report` and `pc animate`.

use std::path::PathBuf;

use clap::Args;
use pc_model::Variables;
use pc_run::Wishes;

use crate::args::forms::run_form;
use crate::args::options;
use crate::args::options::{IntegrationArguments, ModelArguments};

/// How the motion on a page is computed.
#[derive(Clone, Debug, Args)]
pub struct ShownArguments {
    /// The model.
    #[command(flatten)]
    pub model: ModelArguments,
    /// End time [default: the file's]
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_parser = options::finite)]
    pub t_end: Option<f64>,
    /// Number of points on each curve, and of frames, evenly spaced in time, start and end included [default: the file's, but
    /// at least 601]
    #[arg(long, value_name = "N", value_parser = options::rows)]
    pub rows: Option<usize>,
    /// Tolerances and method.
    #[command(flatten)]
    pub integration: IntegrationArguments,
    /// Form of the equations that are integrated, as for `pc run`
    #[arg(long, value_name = "FORM", value_parser = run_form)]
    pub form: Option<Variables>,
    /// Keep an integral, or energy, at its start value by projection after each step (repeatable)
    #[arg(long, value_name = "NAME")]
    pub project: Vec<String>,
}

/// Arguments of `pc report`.
#[derive(Clone, Debug, Args)]
#[command(after_help = "Examples:\n  \
                        pc report tilted-disk -o disk.html\n  \
                        pc report my-model.toml --t-end 20 --set m=2.5 -o report.html\n  \
                        pc models heavy-top-euler | pc report - --no-run > top.html\n\n\
                        The page needs nothing beside itself: no network and no other file; it is read without scripts, by which \
                        the motion can be watched. What would take more than seconds is left out, and the page says which command does it: \
                        --full derives it here. The same model gives the same bytes. Without an end of time there is no \
                        motion. What was reached of one that fails stands on the page, and the exit code is that of `pc run`.")]
pub struct ReportArguments {
    /// The motion.
    #[command(flatten)]
    pub shown: ShownArguments,
    /// Leave out the motion
    #[arg(long, conflicts_with_all = ["t_end", "rows", "form", "project"])]
    pub no_run: bool,
    /// Derive everything, however long it takes: theory, further forms, and the second derivation at 100 states in every form
    #[arg(long)]
    pub full: bool,
    /// Write the page to FILE.html instead of standard output
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
}

/// Arguments of `pc animate`.
#[derive(Clone, Debug, Args)]
#[command(after_help = "Examples:\n  \
                        pc animate spatial-chain -o chain.html\n  \
                        pc animate tilted-disk --t-end 20 > disk.html\n  \
                        pc animate tilted-disk -o disk.gif\n  \
                        pc animate tilted-disk --time 12 -o disk.png\n\n\
                        What is drawn are bodies, joints and points, and the shapes of `[[draw]]` in the text of the model. The \
                        page needs nothing beside itself. A film shows 25 frames a second of a motion of up to 10 seconds, and a \
                        longer one in 10 seconds; a picture shows one frame. The same model gives the same bytes.")]
pub struct AnimateArguments {
    /// The motion.
    #[command(flatten)]
    pub shown: ShownArguments,
    /// Write the page to FILE.html instead of standard output, a film to FILE.gif, or one frame to FILE.svg, FILE.png or FILE.pdf
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// With a single frame: the one nearest to this time [default: the last]
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_parser = options::finite)]
    pub time: Option<f64>,
}

impl ShownArguments {
    /// The options of the motion.
    pub(crate) fn wishes(&self) -> Wishes {
        Wishes { form: self.form, t_end: self.t_end, samples: self.rows, ..self.integration.wishes() }
    }
}
