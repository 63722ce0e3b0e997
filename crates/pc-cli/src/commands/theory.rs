//! `pc theory`: what can be said of the motions of a model, printed.

use pc_model::Variables;
use pc_print::{Theory, TheoryOptions};
use pc_verify::Outlet;

use crate::args::input;
use crate::args::options::TheoryArguments;
use crate::error::CliError;
use crate::output::text::TextOutput;
use crate::terminal::observer::Terminal;
use pc_run::motion::remarks::{say_dropped, say_moved};
use pc_run::motion::verification::vouched;

/// Prints the theory of a model.
///
/// # Errors
/// [`CliError`].
pub fn command(arguments: &TheoryArguments) -> Result<(), CliError> {
    if !arguments.canonical.len().is_multiple_of(2) {
        return Err(CliError::NotInPairs);
    }
    let place = TextOutput::at(arguments.output.as_deref())?;
    let model = input::open(&arguments.model)?;
    input::keep_apart(&arguments.model, &model, [arguments.output.as_deref()])?;
    let graph = model.graph();
    let assembly = model.assemble(&graph)?;
    say_dropped(&assembly, &Terminal);
    say_moved(&assembly, &Terminal);
    let canonical = arguments.canonical.iter().map(|new| (new.name.clone(), new.value.clone()));
    let options = TheoryOptions {
        degree: arguments.degree,
        functions: arguments.functions.clone(),
        canonical: canonical.collect(),
        ..TheoryOptions::default()
    };
    let page = Theory::of(&model, &assembly, &options)?.printed(arguments.format.into());
    if !arguments.verify.no_verify {
        vouched(&model, &assembly, Outlet::Equations(Variables::QuasiVelocities), &Terminal)?;
    }
    place.write(|out| write!(out, "{page}"))
}
