//! From MODEL on the command line to a model and its equations.

use std::io;
use std::path::{Path, PathBuf};

use pc_expr::Limits;
use pc_expr::parse::nearest;
use pc_mech::{Equations, Graph};
use pc_model::document::{read_bounded, read_file_bounded};
use pc_model::{Assembly, Builtin, Document, Model, ModelError, Source};
use pc_run::files::{apart, target};

use crate::args::options::{ModelArguments, Setting, VelocityArguments};
use crate::error::CliError;

/// Opens the model that the command line names, and sets its parameters and start.
///
/// `-` is standard input; a name that contains `/` or `.` or is that of an existing file is a file;
/// any other name is that of a built-in model.
///
/// # Errors
/// [`CliError`] if the model cannot be found, read or understood, or has no such parameter or start value.
pub fn open(arguments: &ModelArguments) -> Result<Model, CliError> {
    let mut model = Model::new(document(&arguments.model)?);
    model.limit(Limits { memory: arguments.limit_memory, time: arguments.limit_time, ..Limits::default() });
    model.project_start(arguments.project_start);
    for name in &arguments.keep {
        model.hold_start(name)?;
    }
    set(&mut model, &arguments.set)?;
    Ok(model)
}

/// Sets parameters and start values.
///
/// # Errors
/// [`CliError::UnknownValue`], [`CliError::SetTwice`], [`CliError::BadValue`].
pub(crate) fn set(model: &mut Model, settings: &[Setting]) -> Result<(), CliError> {
    for (i, Setting { name, value }) in settings.iter().enumerate() {
        if settings[..i].iter().any(|known| known.name == *name) {
            return Err(CliError::SetTwice { name: name.clone() });
        }
        match value.parse::<f64>() {
            Ok(value) if value.is_finite() => model.set_value(name, value)?,
            _ => return Err(CliError::BadValue { name: name.clone(), value: value.clone() }),
        }
    }
    Ok(())
}

/// Opens a model as [`open`] does, and chooses the velocities of its equations; `is_hamel` says whether the form uses the
/// definitions given.
///
/// # Errors
/// As [`open`], and [`CliError::Definitions`] if velocities are defined that the form does not use.
pub fn open_in(
    arguments: &ModelArguments,
    velocities: &VelocityArguments,
    is_hamel: bool,
) -> Result<Model, CliError> {
    let mut model = open(arguments)?;
    if !is_hamel && let Some(definition) = velocities.definitions.first() {
        return Err(CliError::Definitions { name: definition.name.clone() });
    }
    // Definitions on the command line replace those of the file.
    if !velocities.definitions.is_empty() {
        model.give_no_quasi_velocities();
    }
    for Setting { name, value } in &velocities.definitions {
        model.give_quasi_velocity(name, value)?;
    }
    if !velocities.independent.is_empty() {
        model.choose_independent(velocities.independent.iter().map(|name| name.trim()));
    }
    Ok(model)
}

/// Refuses to write a file that a model is read from, or two results to one file; `-` is standard output.
///
/// # Errors
/// As for [`apart::keep_apart`].
pub fn keep_apart<'p>(
    arguments: &ModelArguments,
    model: &Model,
    written: impl IntoIterator<Item = Option<&'p Path>>,
) -> Result<(), CliError> {
    let own = if arguments.model == "-" { apart::STANDARD_INPUT } else { &arguments.model };
    let (own, tables) = (PathBuf::from(own), model.document().files());
    let read = std::iter::once(&own).chain(&tables).map(PathBuf::as_path).filter(|path| path.is_file());
    let written = written.into_iter().filter_map(target::file);
    Ok(apart::keep_apart(read, written)?)
}

fn document(name: &str) -> Result<Document, CliError> {
    Ok(Document::parse(source(name)?)?)
}

/// The text of the model that the command line names.
///
/// # Errors
/// [`CliError`] if the model cannot be found or read.
pub(crate) fn source(name: &str) -> Result<Source, CliError> {
    if name == "-" {
        let bytes = read_bounded(io::stdin().lock());
        let bytes = bytes.map_err(|source| CliError::Read { name: "standard input".to_owned(), source })?;
        return Ok(Source::from_bytes("<stdin>", &bytes));
    }
    let path = Path::new(name);
    let looks_like_a_path = name.contains(['/', '\\', '.']);
    if !path.exists() || !(looks_like_a_path || path.is_file()) {
        return match Builtin::named(name) {
            Some(builtin) if !looks_like_a_path => {
                Ok(Source::new(format!("{}.toml", builtin.name), builtin.text))
            }
            _ => Err(no_such_model(name)),
        };
    }
    let bytes = read_file_bounded(path).map_err(|source| CliError::Read { name: name.to_owned(), source })?;
    Ok(Source::from_bytes(name, &bytes))
}

/// The error for an unknown model, which suggests the models that have the name as a part of theirs, or else the one whose name
/// is nearest.
pub(crate) fn no_such_model(name: &str) -> CliError {
    let stem = Path::new(name).file_stem().and_then(|stem| stem.to_str()).unwrap_or(name);
    let names = || Builtin::all().map(|model| model.name);
    let parted = format!("-{stem}-");
    let akin: Vec<&'static str> = names().filter(|name| format!("-{name}-").contains(&parted)).collect();
    let meant = if akin.is_empty() { nearest(stem, names()).into_iter().collect() } else { akin };
    CliError::NoSuchModel { name: name.to_owned(), meant }
}

/// The system of a model and its equations in independent quasi-velocities, as expressions in `graph`.
///
/// # Errors
/// [`ModelError`], located at the entry of the file that causes it.
pub fn derive<'g>(model: &Model, graph: &'g Graph) -> Result<(Assembly<'g>, Equations<'g>), ModelError> {
    let assembly = model.assemble(graph)?;
    let equations = assembly.equations()?;
    Ok((assembly, equations))
}
