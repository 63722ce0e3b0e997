//! `pc report`: all that is known of a model on one page.

use std::ops::Range;

use pc_model::Model;
use pc_report::{Columns, Kind, Record, report};

use crate::args::input;
use crate::args::report::ReportArguments;
use crate::commands::run::integrate;
use crate::error::CliError;
use crate::motion::plan::Plan;
use crate::motion::run::{Ending, Run};
use crate::output::destination::Destination;
use crate::report::summary;

/// Writes the page of a model.
///
/// # Errors
/// [`CliError`]; of a motion that failed, what was reached has been written then.
pub fn command(arguments: &ReportArguments) -> Result<(), CliError> {
    let destination = Destination::page(arguments.output.as_deref())?;
    let mut model = input::open(&arguments.model)?;
    let run = if arguments.no_run { None } else { integrated(&mut model, arguments)? };
    let record = match &run {
        Some(run) => Some(record(run)),
        None if arguments.no_run => None,
        None => Some(Record { remark: Some(NO_END.to_owned()), ..Record::default() }),
    };
    destination.write_page(&report(&model, record.as_ref())?)?;
    run.map_or(Ok(()), Run::outcome)
}

const NO_END: &str = "There is no motion: the text says no end of time, and --t-end was not given.";

/// The motion with the reactions of constraints; none without an end of time.
fn integrated(model: &mut Model, arguments: &ReportArguments) -> Result<Option<Run>, CliError> {
    let arguments = arguments.as_run();
    model.observe_reactions(!model.document().constraints.is_empty());
    for name in &arguments.project {
        model.keep(name).map_err(CliError::UnknownIntegral)?;
    }
    match Plan::new(model, &arguments) {
        Err(CliError::NoEnd { .. }) => Ok(None),
        plan => integrate(model, Plan::form(model, &arguments), || plan).map(Some),
    }
}

/// What a page shows of a run.
fn record(run: &Run) -> Record {
    let table = &run.table;
    let columns = |kind, places: Range<usize>| Columns {
        kind,
        list: places.map(|j| (table.columns()[j].clone(), table.column(j).collect())).collect(),
    };
    let remark = match &run.ending {
        Ending::Completed => None,
        Ending::Event { name } => Some(format!("The event {name} ended the motion.")),
        ending => Some(format!("The motion {}; what was reached is shown.", ending.word())),
    };
    Record {
        times: table.column(0).collect(),
        columns: vec![
            columns(Kind::Coordinates, table.coordinates()),
            columns(Kind::QuasiVelocities, table.quasi_velocities()),
            columns(Kind::States, table.states()),
            columns(Kind::Conserved, table.conserved()),
            columns(Kind::Outputs, table.conserved().end..table.columns().len()),
        ],
        summary: summary::entries(run).into_iter().map(|(label, lines)| (label.to_owned(), lines)).collect(),
        keeps_energy: run.keeps_energy,
        events: run.occurrences.iter().map(|&(_, t)| t).collect(),
        remark,
    }
}
