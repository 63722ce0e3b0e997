//! `pc models`: what comes with the program.

use std::io::{self, Write};

use pc_algebra::{CATALOGUE, LieAlgebra};
use pc_model::Builtin;
use pc_print::{columns, combination};

use crate::args::input::no_such_model;
use crate::args::options::ModelsArguments;
use crate::error::CliError;
use crate::output::standard_output::print;

/// Prints the list of the built-in models, the text of one, or the algebras that have a name.
///
/// # Errors
/// [`CliError::NoSuchModel`]; [`CliError::Write`].
pub fn command(arguments: &ModelsArguments) -> Result<(), CliError> {
    match &arguments.name {
        Some(name) => {
            let model = Builtin::named(name).ok_or_else(|| no_such_model(name))?;
            print(|out| out.write_all(model.text.as_bytes()))
        }
        None => print(if arguments.algebras { algebras } else { models }),
    }
}

fn models(out: &mut dyn Write) -> io::Result<()> {
    let width = Builtin::all().map(|model| columns(model.name)).max().unwrap_or(0);
    for model in Builtin::all() {
        writeln!(out, "{:width$}  {}", model.name, described(model))?;
    }
    Ok(())
}

/// The name and description that stand in the model.
fn described(model: &Builtin) -> String {
    let Ok(document) = model.document() else { return String::new() };
    let heading = &document.model;
    let parts = [&heading.name, &heading.description];
    let parts: Vec<&str> = parts.into_iter().flatten().map(|part| part.value.as_str()).collect();
    parts.join(": ")
}

fn algebras(out: &mut dyn Write) -> io::Result<()> {
    let width = CATALOGUE.iter().map(|entry| columns(entry.name)).max().unwrap_or(0);
    for entry in CATALOGUE {
        writeln!(out, "{:width$}  {}", entry.name, entry.description)?;
        if let Ok(algebra) = LieAlgebra::named(entry.name) {
            writeln!(out, "{:width$}  {}", "", brackets(&algebra).join(", "))?;
        }
    }
    Ok(())
}

/// The brackets that are not 0, as `[X1,X2] = X3`.
fn brackets(algebra: &LieAlgebra) -> Vec<String> {
    let k = algebra.dim();
    let mut brackets = Vec::new();
    for (r, s) in (0..k).flat_map(|r| (r + 1..k).map(move |s| (r, s))) {
        let terms = (0..k).map(|m| (algebra.constant(r, s, m).to_string(), format!("X{}", m + 1)));
        let sum = combination(terms);
        if sum != "0" {
            brackets.push(format!("[X{},X{}] = {sum}", r + 1, s + 1));
        }
    }
    brackets
}
