//! The section of functions: their arguments, and their values if these are given.

use std::collections::HashSet;

use pc_expr::MOST_ARGUMENTS;
use pc_expr::parse::{Declared, is_name};

use super::reader::{Item, Table, is_reserved};
use crate::diagnostics::error::ModelError;
use crate::diagnostics::error_kind::ErrorKind;
use crate::document::contents::{Document, GivenFunction};

const KEYS: &[&str] = &["of", "is"];
const EXAMPLE: &str = "of = \"r\"";

/// The functions that the file declares, wherever the section is: all other sections may call them.
pub(super) fn declared(root: &Table<'_>) -> Result<Vec<Declared>, ModelError> {
    let Some(section) = root.items().find(|item| item.key() == "functions") else { return Ok(Vec::new()) };
    let section = section.section("functions", "[functions]")?;
    section.items().map(|item| signature(&item)).collect()
}

fn signature(item: &Item<'_>) -> Result<Declared, ModelError> {
    let name = item.new_name()?.text;
    let table = item.table("a table", "{ of = \"r\" }")?;
    let Some(part) = table.items().find(|part| part.key() == "of") else {
        return Err(table.error(ErrorKind::Missing { key: "of", example: EXAMPLE }));
    };
    let text = part.text()?.value;
    let arguments: Vec<String> = text.split(',').map(|name| name.trim().to_owned()).collect();
    if let Some(wrong) = arguments.iter().find(|name| !is_name(name)) {
        return Err(part.error(ErrorKind::NotAName { key: wrong.clone() }));
    }
    if let Some(reserved) = arguments.iter().find(|name| is_reserved(name)) {
        return Err(part.error(ErrorKind::Reserved { name: reserved.clone() }));
    }
    let distinct: HashSet<&String> = arguments.iter().collect();
    if arguments.len() > MOST_ARGUMENTS || distinct.len() < arguments.len() {
        let expected = "one to three different names, separated by commas";
        let example = "of = \"x, y\"";
        return Err(part.error(ErrorKind::OutOfRange { expected, found: text, example }));
    }
    Ok(Declared { name, arguments })
}

/// The functions, each with its value if it is given; a value may call the functions before it.
pub(super) fn functions(table: &Table<'_>) -> Result<Vec<GivenFunction>, ModelError> {
    let mut functions = Vec::new();
    for (place, item) in table.items().enumerate() {
        let (name, signature, mut is) = (item.new_name()?, signature(&item)?, None);
        for part in item.table("a table", "{ of = \"r\" }")?.items() {
            match part.key() {
                "of" => {}
                "is" => is = Some(part.with_functions_before(place).expression()?),
                _ => return Err(part.unknown(KEYS)),
            }
        }
        functions.push(GivenFunction { name, arguments: signature.arguments, is });
    }
    Ok(functions)
}

impl GivenFunction {
    /// The name of the function and of its arguments.
    pub fn signature(&self) -> Declared {
        Declared { name: self.name.text.clone(), arguments: self.arguments.clone() }
    }
}

impl Document {
    /// The functions that expressions may call besides those of the language.
    pub fn declared_functions(&self) -> Vec<Declared> {
        self.functions.iter().map(GivenFunction::signature).collect()
    }

    /// The functions without a value, each of which stands for any smooth function.
    pub fn undetermined_functions(&self) -> impl Iterator<Item = &GivenFunction> {
        self.functions.iter().filter(|function| function.is.is_none())
    }
}
