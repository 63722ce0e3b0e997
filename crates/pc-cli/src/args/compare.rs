//! Arguments of `pc compare`.

use std::time::Duration;

use clap::Args;
use pc_model::Variables;
use pc_run::Wishes;
use pc_run::compare::comparison::Question;
use pc_run::compare::difference::Allowance;

use crate::args::forms::run_form;
use crate::args::options;
use crate::args::options::{IntegrationArguments, ModelArguments, Setting};
use crate::args::table::{ColumnArguments, OutputArguments, TableArguments};

/// Arguments of `pc compare`.
#[derive(Clone, Debug, Args)]
pub struct CompareArguments {
    /// A file, `-` for standard input, or a built-in name
    #[arg(value_name = "A")]
    pub first: String,
    /// Another model [default: A again]
    #[arg(value_name = "B")]
    pub second: Option<String>,
    /// Form of the equations: one for both, or one for A and one for B [default: that of each file, or poincare]
    #[arg(long, value_name = "FORM[,FORM]", value_delimiter = ',', value_parser = run_form)]
    pub form: Vec<Variables>,
    /// Set a parameter, or the start of a coordinate, velocity or first-order state, to another value in each model that has it
    /// (repeatable)
    #[arg(long, value_name = "NAME=VALUE", value_parser = options::setting)]
    pub set: Vec<Setting>,
    /// End time [default: that of A, or that of B]
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_parser = options::finite)]
    pub t_end: Option<f64>,
    /// Number of evenly spaced times at which to compare, start and end included [default: as for `pc run` of A]
    #[arg(long, value_name = "N", value_parser = options::rows)]
    pub rows: Option<usize>,
    /// Tolerances and method.
    #[command(flatten)]
    pub integration: IntegrationArguments,
    /// Difference allowed in addition to errors of integration, as a fraction of the largest value in its column
    #[arg(long, value_name = "P", default_value = "0", allow_hyphen_values = true, value_parser = options::not_negative)]
    pub tolerance: f64,
    /// Difference allowed in addition to errors of integration, whatever the size of the values
    #[arg(long, value_name = "D", default_value = "0", allow_hyphen_values = true, value_parser = options::not_negative)]
    pub absolute: f64,
    /// Which columns are compared.
    #[command(flatten)]
    pub columns: ColumnArguments,
    /// Further outputs.
    #[command(flatten)]
    pub outputs: OutputArguments,
    /// Also compare an expression in the columns and parameters of A with one in the columns and parameters of B (repeatable)
    #[arg(long, value_name = "EXPR=EXPR", value_parser = options::definition)]
    pub map: Vec<Setting>,
    /// Memory limit for the expressions of the equations, and separately for the rows of a motion, such as
    /// 500M or 8G
    #[arg(long, value_name = "BYTES", value_parser = options::bytes, default_value = "4G")]
    pub limit_memory: u64,
    /// Time limit in seconds for all work on each model [default: none]
    #[arg(long, value_name = "SECONDS", value_parser = options::seconds)]
    pub limit_time: Option<Duration>,
    /// The table.
    #[command(flatten)]
    pub table: TableArguments,
}

impl CompareArguments {
    /// The arguments for the model of this name, with the parameters and start of the file.
    pub fn model(&self, name: &str) -> ModelArguments {
        ModelArguments {
            model: name.to_owned(),
            set: Vec::new(),
            project_start: false,
            keep: Vec::new(),
            limit_memory: self.limit_memory,
            limit_time: self.limit_time,
        }
    }

    /// The options for A if `which` is 0, for B if it is 1.
    pub(crate) fn wishes(&self, which: usize, t_end: Option<f64>) -> Wishes {
        Wishes {
            form: self.form.get(which).or(self.form.first()).copied(),
            t_end,
            samples: self.rows,
            ..self.integration.wishes()
        }
    }

    /// What to compare.
    pub(crate) fn question(&self) -> Question {
        Question {
            allowance: Allowance { relative: self.tolerance, absolute: self.absolute },
            columns: self.columns.names(),
            pairs: self.map.iter().map(|map| (map.name.clone(), map.value.clone())).collect(),
        }
    }
}
