//! `pc theory`: what can be said of the motions of a model, printed.

use pc_model::Variables;
use pc_print::{Theory, TheoryOptions};
use pc_verify::Outlet;

use crate::args::input;
use crate::args::options::TheoryArguments;
use crate::error::CliError;
use crate::output::standard_output::print;
use crate::report::notes::{say_dropped, say_moved};
use crate::report::verification::vouched;

/// Prints the theory of a model.
///
/// # Errors
/// [`CliError`].
pub fn command(arguments: &TheoryArguments) -> Result<(), CliError> {
    let model = input::open(&arguments.model)?;
    let graph = model.graph();
    let assembly = model.assemble(&graph)?;
    say_dropped(&assembly);
    say_moved(&assembly);
    let options = TheoryOptions { degree: arguments.degree, functions: arguments.functions.clone() };
    let page = Theory::of(&model, &assembly, &options)?.printed(arguments.format.into());
    vouched(&model, &assembly, Outlet::Equations(Variables::QuasiVelocities), arguments.verify)?;
    print(|out| write!(out, "{page}"))
}
