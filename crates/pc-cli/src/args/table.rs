//! The options of every command that writes a table.

use std::path::PathBuf;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};
use pc_model::Model;
use pc_run::table::format::Format;

use crate::terminal::text;

/// Where a table is written, and how.
#[derive(Clone, Debug, Default, Args)]
pub struct TableArguments {
    /// Write to FILE, whose ending says how: .csv, .json, .npz, .parquet, .mat or .txt, as far as the command has these
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// How to write, whatever the ending of FILE; npz, parquet and mat go to a file or a pipe, but not to a terminal
    /// [default: by the ending of FILE]
    #[arg(long, value_name = "FORMAT", value_parser = format())]
    pub format: Option<Format>,
}

/// Which columns a table has.
#[derive(Clone, Debug, Default, Args)]
pub struct ColumnArguments {
    /// Only these columns, separated by commas, in this order, in table and picture alike; those that tell rows apart, such as t,
    /// member and what is varied, stay in the table
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub columns: Vec<String>,
}

/// Additional outputs of a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Outputs {
    /// The reactions of the constraints.
    Reactions,
}

/// Which additional outputs the model has.
#[derive(Clone, Copy, Debug, Default, Args)]
pub struct OutputArguments {
    /// More outputs: the reactions of the constraints. λ_NAME is the reaction for the expression as it is written; models with
    /// bodies also have forces F_NAME_BODY in space axes at the body's position and torques N_NAME_BODY in body axes,
    /// as far as virtual work determines them: a component perpendicular to every possible motion is given as 0, whatever holds
    /// the body
    #[arg(long, value_name = "OUTPUTS")]
    pub outputs: Option<Outputs>,
}

impl ColumnArguments {
    /// The names, without the spaces around them.
    pub fn names(&self) -> Vec<String> {
        self.columns.iter().map(|name| name.trim().to_owned()).collect()
    }
}

impl OutputArguments {
    /// Adds the outputs to models; where none of these can have any, this is said.
    pub fn apply<const N: usize>(self, models: [&mut Model; N]) {
        if self.outputs.is_none() {
            return;
        }
        let mut have_none = true;
        for model in models {
            model.observe_reactions(true);
            let document = model.document();
            have_none &= document.constraints.is_empty() && document.tree.is_empty();
        }
        if have_none {
            text::say(format_args!("note: there are no constraints, and so no reactions\n"));
        }
    }
}

/// The names of the formats.
fn format() -> impl TypedValueParser<Value = Format> {
    let words = Format::ALL.iter().map(|format| PossibleValue::new(format.name()));
    PossibleValuesParser::new(words).try_map(|given| {
        let found = Format::ALL.iter().find(|format| format.name() == given);
        found.copied().ok_or_else(|| format!("there is no `{given}`"))
    })
}
