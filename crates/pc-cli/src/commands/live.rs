//! `pc live`: a page on this computer that follows the text of a model.

use std::time::Duration;

use crate::args::live::LiveArguments;
use crate::error::CliError;
use crate::live::{Desk, Original, server};
use crate::output::standard_output::print;

/// The time for one computation, where the command line says none.
const PATIENCE: Duration = Duration::from_secs(60);

/// Serves the page until Ctrl-C.
///
/// # Errors
/// [`CliError`] if there is no such model; [`CliError::Port`].
pub fn command(arguments: &LiveArguments) -> Result<(), CliError> {
    let original = Original::open(&arguments.model)?;
    let desk = Desk::new(original, arguments.limit_memory, arguments.limit_time.unwrap_or(PATIENCE));
    let told = |address: &str| {
        // The page is served also where nobody reads what this prints.
        _ = print(|out| writeln!(out, "{}: {address}\nCtrl-C ends it.", arguments.model));
    };
    server::serve(desk, arguments.port, told)
        .map_err(|source| CliError::Port { port: arguments.port, source })
}
