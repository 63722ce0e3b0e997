//! Arguments of `pc models`.

use clap::Args;

use crate::args::options::Format;

/// Arguments of `pc models`.
#[derive(Clone, Debug, Args)]
pub struct ModelsArguments {
    /// Print the text of this model, as a starting point for your own
    #[arg(value_name = "NAME", conflicts_with = "algebras")]
    pub name: Option<String>,
    /// List instead the Lie algebras that `[algebra]` accepts by name
    #[arg(long)]
    pub algebras: bool,
    /// List the models with this tag, with references; with several, those that have all of them (repeatable)
    #[arg(long, value_name = "TAG", conflicts_with_all = ["name", "algebras"])]
    pub tag: Vec<String>,
    /// List the tags instead, each with the number of models that have it
    #[arg(long, conflicts_with_all = ["name", "algebras", "tag"])]
    pub tags: bool,
    /// List all models with their references and tags
    #[arg(long, conflicts_with_all = ["name", "algebras", "tags"])]
    pub long: bool,
    /// How to print the list
    #[arg(long, default_value = "text", conflicts_with_all = ["name", "algebras", "tags"])]
    pub format: Format,
}
