//! `pc emit`: the equations as source in other languages.

use std::fs;
use std::io::Write;
use std::path::Path;

use pc_mech::{EmitOptions, Language};
use pc_model::Variables;
use pc_print::energy_remark;
use pc_verify::Outlet;

use crate::args::input;
use crate::args::options::{EmitArguments, Lang};
use crate::error::CliError;
use crate::output::standard_output::print;
use crate::terminal::observer::Terminal;
use crate::terminal::text::say;
use pc_run::files::error::FileError;
use pc_run::files::target::{Target, file};
use pc_run::motion::remarks::{choice, say_dropped, say_moved};
use pc_run::motion::verification::vouched;
use pc_run::observer::Observer;

const NO_EVENTS: &str =
    "The events of the model are not part of this source: it has the equations between them.";

const NO_TABLES: &str = "The tables of inputs are not part of this source: their values at each time are arguments of its \
                         functions, like parameters.";

/// Writes the source of a model into a directory, one file after the other, each whole.
///
/// # Errors
/// [`CliError`].
pub fn command(arguments: &EmitArguments) -> Result<(), CliError> {
    let model = input::open_in(&arguments.model, &arguments.velocities, arguments.form == Variables::Given)?;
    model.require_values()?;
    let graph = model.graph();
    let assembly = model.assemble(&graph)?;
    let (equations, form) = assembly.equations_of(arguments.form)?;
    let language = match arguments.lang {
        Some(Lang::Rust) => Language::Rust,
        Some(Lang::C) | None => Language::C, // the command line requires a language
    };
    let mut options = EmitOptions::new(language, name(model.document().source.name()));
    options = options.title(model.title()).jacobian(!arguments.no_jacobian);
    say_dropped(&assembly, &Terminal);
    say_moved(&assembly, &Terminal);
    let mut remarks = Vec::new();
    if let Some(remark) = choice(&assembly, &form.independent) {
        Terminal.remark(&remark);
        remarks.push(remark);
        remarks.extend(energy_remark(&assembly).map(str::to_owned));
    }
    if !assembly.events.is_empty() {
        say(format_args!("note: {NO_EVENTS}\n"));
        remarks.push(NO_EVENTS.to_owned());
    }
    let has_tables = !equations.system().signals().is_empty();
    if has_tables {
        say(format_args!("note: {NO_TABLES}\n"));
        remarks.push(NO_TABLES.to_owned());
    }
    if !remarks.is_empty() {
        options = options.remark(remarks.join("\n"));
    }
    if !arguments.verify.no_verify {
        vouched(&model, &assembly, Outlet::Source(arguments.form), &Terminal)?;
    }
    // With its inputs fixed at their start values, the motion would be a different one.
    if let Some(t_end) = model.document().simulation.t_end.as_ref().filter(|_| !has_tables) {
        options = options.start(assembly.t_start, &assembly.start_in(&form)?, t_end.value);
    }
    let files = assembly.placed(equations.emit(&options))?;

    let Some(directory) = file(Some(&arguments.output)) else {
        return match files.as_slice() {
            [file] => print(|out| out.write_all(file.text.as_bytes())),
            _ => {
                let files = files.into_iter().map(|file| file.name).collect();
                Err(CliError::SeveralFiles { files })
            }
        };
    };
    let paths: Vec<_> = files.iter().map(|file| directory.join(&file.name)).collect();
    input::keep_apart(&arguments.model, &model, paths.iter().map(|path| Some(path.as_path())))?;
    fs::create_dir_all(directory).map_err(|source| FileError::cannot_write(directory, source))?;
    let mut places = Vec::new();
    for path in &paths {
        places.push(Target::regular(path).map_err(|source| FileError::cannot_write(path, source))?);
    }
    for (file, place) in files.iter().zip(&places) {
        let path = place.path();
        place
            .write(|out| out.write_all(file.text.as_bytes()))
            .map_err(|source| FileError::cannot_write(path, source))?;
        say(format_args!("{}\n", path.display()));
    }
    Ok(())
}

/// The name of a model file without directory and extension.
pub(super) fn name(file: &str) -> &str {
    Path::new(file).file_stem().and_then(|stem| stem.to_str()).unwrap_or("model").trim_matches(['<', '>'])
}
