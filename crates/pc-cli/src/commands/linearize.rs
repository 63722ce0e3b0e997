//! `pc linearize`: the motions near a state to first order, and their eigenvalues over a parameter.

use pc_run::linear::error::LinearError;
use pc_run::linear::linearized::Linearized;
use pc_run::linear::locus::Locus;
use pc_run::sweep::values::Vary;
use pc_run::table::format::Format;

use crate::args::input;
use crate::args::linear::LinearizeArguments;
use crate::args::table::TableArguments;
use crate::error::CliError;
use crate::output::destination::Destination;
use crate::output::table::TablePlace;
use crate::terminal::observer::Terminal;

/// Runs `pc linearize`.
///
/// # Errors
/// [`CliError`]
pub fn command(arguments: &LinearizeArguments) -> Result<(), CliError> {
    let place = TablePlace::of(&arguments.table, Format::OF_ARRAYS)?;
    if let Some(vary) = &arguments.vary {
        return locus(arguments, vary, &place);
    }
    let mut model = input::open(&arguments.model)?;
    input::keep_apart(&arguments.model, &model, [arguments.table.output.as_deref()])?;
    arguments.outputs.apply([&mut model]);
    let verify = !arguments.verify.no_verify;
    let state = arguments.state.choice();
    let linear = match arguments.free.as_slice() {
        [] => Linearized::of(&model, &state, verify, &Terminal)?,
        free => Linearized::trimmed(&model, free, state.cyclic, verify, &Terminal)?,
    };
    place.write(&linear, "linearization")
}

/// The eigenvalues for each value of a parameter.
fn locus(arguments: &LinearizeArguments, vary: &Vary, place: &TablePlace) -> Result<(), CliError> {
    let picture = Destination::plot(arguments.plot.as_deref())?;
    let mut model = input::open(&arguments.model)?;
    let results = [arguments.table.output.as_deref(), arguments.plot.as_deref()];
    input::keep_apart(&arguments.model, &model, results)?;
    arguments.outputs.apply([&mut model]);
    if arguments.model.set.iter().any(|set| set.name == vary.name) {
        return Err(LinearError::Twice { name: vary.name.clone() }.into());
    }
    let verify = !arguments.verify.no_verify;
    let locus = Locus::of(&model, vary, &arguments.state.choice(), verify, &Terminal)?;
    if let Some(picture) = picture {
        picture.write_plot(&locus.picture(arguments.axes.into()).drawing())?;
    }
    // A picture alone is enough, unless the table is asked for.
    let TableArguments { output, format } = &arguments.table;
    if arguments.plot.is_some() && output.is_none() && format.is_none() {
        return Ok(());
    }
    place.write(&locus, "locus")
}
