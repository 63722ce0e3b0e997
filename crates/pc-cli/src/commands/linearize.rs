//! `pc linearize`: the motions near a state to first order, and their eigenvalues over a parameter.

use pc_print::{visible, visible_json};
use pc_run::linear::error::LinearError;
use pc_run::linear::linearized::Linearized;
use pc_run::linear::locus::Locus;
use pc_run::sweep::values::Vary;
use pc_run::table::file::{Format, TableFile};

use crate::args::input;
use crate::args::linear::{LinearizeArguments, MatrixFormat};
use crate::error::CliError;
use crate::output::destination::Destination;
use crate::output::standard_output::print;
use crate::terminal::observer::Terminal;

/// Runs `pc linearize`.
///
/// # Errors
/// [`CliError`]
pub fn command(arguments: &LinearizeArguments) -> Result<(), CliError> {
    let file = arguments.output.as_deref().map(|path| TableFile::new(path, Format::OF_ARRAYS)).transpose()?;
    if let Some(vary) = &arguments.vary {
        return locus(arguments, vary, file.as_ref());
    }
    let model = input::open(&arguments.model)?;
    input::keep_apart(&arguments.model, &model, [arguments.output.as_deref()])?;
    let verify = !arguments.verify.no_verify;
    let state = arguments.state.choice();
    let linear = match arguments.free.as_slice() {
        [] => Linearized::of(&model, &state, verify, &Terminal)?,
        free => Linearized::trimmed(&model, free, state.cyclic, verify, &Terminal)?,
    };
    match (&file, arguments.format) {
        (Some(file), _) => Ok(linear.write(file)?),
        (None, Some(MatrixFormat::Text) | None) => print(|out| write!(out, "{}", visible(&linear.text()))),
        (None, Some(MatrixFormat::Csv)) => print(|out| write!(out, "{}", linear.csv())),
        (None, Some(MatrixFormat::Json)) => print(|out| writeln!(out, "{}", visible_json(&linear.json()))),
    }
}

/// The eigenvalues for each value of a parameter.
fn locus(arguments: &LinearizeArguments, vary: &Vary, file: Option<&TableFile>) -> Result<(), CliError> {
    let picture = Destination::plot(arguments.plot.as_deref())?;
    let model = input::open(&arguments.model)?;
    input::keep_apart(&arguments.model, &model, [arguments.output.as_deref(), arguments.plot.as_deref()])?;
    if arguments.model.set.iter().any(|set| set.name == vary.name) {
        return Err(LinearError::Twice { name: vary.name.clone() }.into());
    }
    let verify = !arguments.verify.no_verify;
    let locus = Locus::of(&model, vary, &arguments.state.choice(), verify, &Terminal)?;
    if let Some(picture) = picture {
        picture.write_plot(&locus.picture(arguments.axes.into()).drawing())?;
    }
    match (file, arguments.format) {
        (Some(file), _) => Ok(locus.write(file)?),
        (None, None) if arguments.plot.is_some() => Ok(()),
        (None, Some(MatrixFormat::Text) | None) => print(|out| write!(out, "{}", visible(&locus.text()))),
        (None, Some(MatrixFormat::Csv)) => print(|out| write!(out, "{}", locus.csv())),
        (None, Some(MatrixFormat::Json)) => print(|out| writeln!(out, "{}", visible_json(&locus.json()))),
    }
}
