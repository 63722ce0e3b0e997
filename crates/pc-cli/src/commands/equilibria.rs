//! `pc equilibria`: the equilibria in a box.

use pc_analysis::EquilibriumSearch;
use pc_model::Variables;
use pc_print::{visible, visible_json};
use pc_verify::Outlet;

use crate::args::input;
use crate::args::linear::{EquilibriaArguments, MatrixFormat};
use crate::error::CliError;
use crate::linear::error::LinearError;
use crate::linear::file::{Contents, Destination};
use crate::linear::found;
use crate::linear::ground::{Ground, placed};
use crate::output::standard_output::print;
use crate::report::notes::{say_dropped, say_moved};
use crate::report::verification::vouched;

/// Runs `pc equilibria`.
///
/// # Errors
/// [`CliError`]
pub fn command(arguments: &EquilibriaArguments) -> Result<(), CliError> {
    let destination = arguments.output.as_deref().map(Destination::of_list).transpose()?;
    let model = input::open(&arguments.model)?;
    let graph = model.graph();
    let mut ground = Ground::new(&model, &graph)?;
    say_dropped(&ground.assembly);
    say_moved(&ground.assembly);
    vouched(&model, &ground.assembly, Outlet::Equations(Variables::QuasiVelocities), arguments.verify)?;
    let integrals = ground.integrals();
    let mut search = EquilibriumSearch::default().starts(arguments.starts);
    for (i, bounds) in arguments.bounds.iter().enumerate() {
        if arguments.bounds[..i].iter().any(|known| known.name == bounds.name) {
            return Err(LinearError::Twice { name: bounds.name.clone() }.into());
        }
        search = search.within(&bounds.name, bounds.low, bounds.high);
    }
    let at = (ground.assembly.t_start, ground.start.as_slice());
    let found = search.run(&ground.equations, &mut ground.linearizer, at, integrals.list());
    ground.assembly.within_limits()?;
    let found = found.map_err(|error| placed(&ground.assembly, error, false))?;
    if found.list.is_empty() {
        return Err(LinearError::NoEquilibrium { starts: found.starts, converged: found.converged }.into());
    }
    let (title, names) = (model.title(), ground.linearizer.names());
    let places = ground.equations.system().frame().coordinates().len();
    match (&destination, arguments.format) {
        (Some(destination), _) => destination.write(&Contents {
            json: &found::json(title, names, &found),
            csv: &found::csv(names, &found),
            arrays: &[],
            texts: &[],
        }),
        (None, MatrixFormat::Text) => {
            print(|out| write!(out, "{}", visible(&found::text(title, names, places, &found))))
        }
        (None, MatrixFormat::Json) => {
            print(|out| writeln!(out, "{}", visible_json(&found::json(title, names, &found))))
        }
        (None, MatrixFormat::Csv) => print(|out| write!(out, "{}", found::csv(names, &found))),
    }
}
