//! `pc run`: integrate, write, sum up.

use pc_model::Variables;
use pc_report::picture::{Drawing, Picture, Wanted};
use pc_run::files::apart::keep_apart;
use pc_run::files::stream::Stream;
use pc_run::files::target;
use pc_run::motion::cache::Cache;
use pc_run::motion::integrate::Besides;
use pc_run::motion::run::Run;
use pc_run::motion::summary;
use pc_run::table::file::TableFile;

use crate::args::checkpoint::CheckpointArguments;
use crate::args::input;
use crate::args::options::{Outputs, RunArguments};
use crate::error::CliError;
use crate::output::destination::{Destination, table};
use crate::output::standard_output::print_or_keep;
use crate::terminal::observer::Terminal;
use crate::terminal::text;

/// Runs `pc run`.
///
/// # Errors
/// [`CliError`]; the motion has been written as far as it was reached.
pub fn command(arguments: &RunArguments) -> Result<(), CliError> {
    let file = table(arguments.output.as_deref())?;
    let picture =
        Destination::plot(arguments.plot.as_deref())?.map(|place| (place, arguments.drawn.wanted()));
    let is_hamel = arguments.form == Some(Variables::Given);
    let mut model = input::open_in(&arguments.model, &arguments.velocities, is_hamel)?;
    let results = [arguments.output.as_deref(), arguments.plot.as_deref()];
    let CheckpointArguments { checkpoint, resume, .. } = &arguments.checkpoints;
    input::keep_apart(&arguments.model, &model, results.into_iter().chain([checkpoint.as_deref()]))?;
    // The checkpoint from which a run continues may be replaced by later ones, but not by results.
    keep_apart(resume.as_deref(), results.into_iter().filter_map(target::file))?;
    model.observe_reactions(arguments.outputs == Some(Outputs::Reactions));
    if arguments.outputs.is_some() && model.document().constraints.is_empty() {
        text::say(format_args!("note: there are no constraints, and so no reactions\n"));
    }
    model.differentiate_by_parameters(!arguments.sensitivities.is_empty());
    for name in &arguments.project {
        model.keep(name).map_err(CliError::UnknownIntegral)?;
    }
    let besides = Besides {
        verify: !arguments.no_verify,
        fine: picture.is_some(),
        remarks: true,
        estimate: arguments.estimate,
        checkpoints: arguments.checkpoints.files(),
        cache: std::env::var_os("PC_CACHE_DIR").filter(|directory| !directory.is_empty()).map(Cache::new),
        ..Besides::default()
    };
    // A picture needs all rows.
    let mut stream = file.as_ref().and_then(TableFile::stream).filter(|_| picture.is_none());
    let run = Run::of(&model, &arguments.wishes(), &besides, stream.as_mut(), &Terminal)?;
    let so_far = file.as_ref().filter(|_| run.is_interrupted()).and_then(TableFile::so_far);
    let file = so_far.as_ref().or(file.as_ref());
    let picture = picture.map(|(place, wanted)| (place.for_run(&run), wanted));
    let written = write(&run, stream.filter(Stream::is_begun), file, picture.as_ref());
    text::say(format_args!("{}", summary::text(&run)));
    match (run.outcome(), written) {
        (Err(ending), Err(error)) => {
            text::say(format_args!("{}\n", error.report()));
            Err(ending.into())
        }
        (outcome, written) => outcome.map_err(CliError::from).and(written),
    }
}

fn write(
    run: &Run,
    stream: Option<Stream<'_>>,
    file: Option<&TableFile>,
    picture: Option<&(Destination, Wanted)>,
) -> Result<(), CliError> {
    match (stream, file) {
        (Some(stream), Some(file)) => file.end(stream)?,
        (None, Some(file)) => run.write(file)?,
        (_, None) => print_or_keep("motion.csv", |out| run.write_csv(out))?,
    }
    if let Some(file) = file {
        text::say_so_far(file.path(), file.instead_of());
    }
    match picture {
        Some((place, wanted)) => place.write_plot(&drawn(run, wanted)?),
        None => Ok(()),
    }
}

/// The wanted columns of a motion, drawn.
///
/// # Errors
/// [`CliError::Column`] where it has no such column.
pub fn drawn(run: &Run, wanted: &Wanted) -> Result<Drawing, CliError> {
    let picture = Picture::of(&run.title, &run.record(), wanted);
    Ok(picture.map_err(|source| CliError::Column { option: "plot", source })?.drawing())
}
