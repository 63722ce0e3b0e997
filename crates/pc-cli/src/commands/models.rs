//! `pc models`: the built-in models.

use std::io::{self, Write};

use pc_algebra::{CATALOGUE, LieAlgebra};
use pc_expr::parse::nearest;
use pc_model::document::{Heading, Located};
use pc_model::{Builtin, TAGS};
use pc_print::{columns, combination};
use serde_json::{Value, json};

use crate::args::input::no_such_model;
use crate::args::models::ModelsArguments;
use crate::args::options::Format;
use crate::error::CliError;
use crate::output::standard_output::print;

/// Prints the list of the built-in models, the text of one, their tags, or the named algebras.
///
/// # Errors
/// [`CliError::NoSuchModel`]; [`CliError::NoSuchTag`]; `FileError::Write`.
pub fn command(arguments: &ModelsArguments) -> Result<(), CliError> {
    if let Some(name) = &arguments.name {
        let model = Builtin::named(name).ok_or_else(|| no_such_model(name))?;
        return print(|out| out.write_all(model.text.as_bytes()));
    }
    if arguments.algebras {
        return print(|out| algebras(out));
    }
    if arguments.tags {
        return print(|out| tags(out));
    }
    if let Some(name) = arguments.tag.iter().find(|name| TAGS.iter().all(|tag| tag.name != **name)) {
        let nearest = nearest(name, TAGS.iter().map(|tag| tag.name));
        return Err(CliError::NoSuchTag { name: name.clone(), nearest });
    }
    let has_all =
        |model: &&Builtin| arguments.tag.iter().all(|name| model.tags().any(|tag| tag.name == *name));
    let listed: Vec<&Builtin> = Builtin::all().filter(has_all).collect();
    print(|out| match arguments.format {
        Format::Text => models(&listed, arguments.long || !arguments.tag.is_empty(), out),
        Format::Json => writeln!(out, "{}", listed.iter().map(|model| object(model)).collect::<Value>()),
    })
}

fn models(listed: &[&Builtin], long: bool, out: &mut dyn Write) -> io::Result<()> {
    let width = listed.iter().map(|model| columns(model.name)).max().unwrap_or(0);
    for model in listed {
        let heading = heading(model);
        let parts: Vec<&str> = [&heading.name, &heading.description].into_iter().filter_map(text).collect();
        writeln!(out, "{:width$}  {}", model.name, parts.join(": "))?;
        if long {
            if let Some(reference) = text(&heading.reference) {
                writeln!(out, "{:width$}  {reference}", "")?;
            }
            let tags: Vec<&str> = model.tags().map(|tag| tag.name).collect();
            writeln!(out, "{:width$}  [{}]", "", tags.join(", "))?;
        }
    }
    Ok(())
}

fn object(model: &Builtin) -> Value {
    let heading = heading(model);
    json!({
        "name": model.name,
        "title": text(&heading.name),
        "description": text(&heading.description),
        "reference": text(&heading.reference),
        "tags": model.tags().map(|tag| tag.name).collect::<Vec<_>>(),
    })
}

/// The heading of a model; empty if it cannot be read, which the tests exclude.
fn heading(model: &Builtin) -> Heading {
    model.document().map(|document| document.model).unwrap_or_default()
}

fn text(part: &Option<Located<String>>) -> Option<&str> {
    part.as_ref().map(|part| part.value.as_str())
}

fn tags(out: &mut dyn Write) -> io::Result<()> {
    let width = TAGS.iter().map(|tag| columns(tag.name)).max().unwrap_or(0);
    TAGS.iter()
        .try_for_each(|tag| writeln!(out, "{:width$}  {:2}  {}", tag.name, tag.models.len(), tag.meaning))
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
