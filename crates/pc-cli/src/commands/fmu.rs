//! `pc emit --fmu`: a model as a Functional Mock-up Unit.

use std::io::Cursor;
use std::io::Write;

use pc_fmu::{FmiVersion, Fmu, FmuOptions, FmuSolver};
use pc_model::Variables;
use pc_verify::Outlet;

use crate::args::input;
use crate::args::options::{EmitArguments, FmuMethod, FmuVersion};
use crate::commands::emit::name;
use crate::error::CliError;
use crate::terminal::observer::Terminal;
use crate::terminal::text::say;
use pc_run::files::error::FileError;
use pc_run::files::target::Target;
use pc_run::motion::remarks::{choice, say_dropped, say_moved};
use pc_run::motion::verification::vouched;
use pc_run::observer::Observer;

/// Writes the FMU of a model, whole or not at all.
///
/// # Errors
/// [`CliError`].
pub fn command(arguments: &EmitArguments, version: FmuVersion) -> Result<(), CliError> {
    let path = &arguments.output;
    if path.extension().is_none_or(|ending| ending != "fmu") {
        let (option, path, expected) = ("--output", path.clone(), ".fmu".to_owned());
        return Err(FileError::UnknownExtension { option, path, expected }.into());
    }
    let place = Target::regular(path).map_err(|source| FileError::cannot_write(path, source))?;
    let model = input::open_in(&arguments.model, &arguments.velocities, arguments.form == Variables::Given)?;
    input::keep_apart(&arguments.model, &model, [Some(path.as_path())])?;
    let graph = model.graph();
    let assembly = model.assemble(&graph)?;
    let version = match version {
        FmuVersion::V2 => FmiVersion::V2,
        FmuVersion::V3 => FmiVersion::V3,
    };
    let mut options = FmuOptions::new(version, name(model.document().source.name()));
    if let Some(solver) = arguments.solver {
        options = options.solver(match (solver, arguments.step) {
            (FmuMethod::Dop853, _) => FmuSolver::Dop853,
            (FmuMethod::Radau5, _) => FmuSolver::Radau5,
            (FmuMethod::Rk4, step) => FmuSolver::RungeKutta4 { step: step.unwrap_or(f64::NAN) },
        });
    }
    say_dropped(&assembly, &Terminal);
    say_moved(&assembly, &Terminal);
    let (_, form) = assembly.equations_of(arguments.form)?;
    if let Some(remark) = choice(&assembly, &form.independent) {
        Terminal.remark(&remark);
    }
    if !arguments.verify.no_verify {
        vouched(&model, &assembly, Outlet::Source(arguments.form), &Terminal)?;
    }
    let mut fmu = Fmu::new(&model, &assembly, arguments.form, &options)?;
    for note in fmu.notes() {
        say(format_args!("note: {note}\n"));
    }
    if !arguments.sources_only {
        fmu = fmu.compiled()?;
    }
    let mut archive = Cursor::new(Vec::new());
    fmu.write(&mut archive).map_err(|source| FileError::cannot_write(path, source))?;
    place
        .write(|out| out.write_all(archive.get_ref()))
        .map_err(|source| FileError::cannot_write(place.path(), source))?;
    say(format_args!("{}\n", path.display()));
    Ok(())
}
