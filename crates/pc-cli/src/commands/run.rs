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
use pc_run::table::format::Format;

use crate::args::checkpoint::CheckpointArguments;
use crate::args::input;
use crate::args::options::RunArguments;
use crate::error::CliError;
use crate::output::destination::Destination;
use crate::output::table::TablePlace;
use crate::terminal::observer::Terminal;
use crate::terminal::text;

/// Runs `pc run`.
///
/// # Errors
/// [`CliError`]; the motion has been written as far as it was reached.
pub fn command(arguments: &RunArguments) -> Result<(), CliError> {
    let place = TablePlace::of(&arguments.table, Format::OF_TABLES)?;
    let (file, columns) = (place.file(), arguments.columns.names());
    let picture = Destination::plot(arguments.plot.as_deref())?
        .map(|place| (place, arguments.drawn.wanted(columns.clone())));
    let is_hamel = arguments.form == Some(Variables::Given);
    let mut model = input::open_in(&arguments.model, &arguments.velocities, is_hamel)?;
    let results = [arguments.table.output.as_deref(), arguments.plot.as_deref()];
    let CheckpointArguments { checkpoint, resume, .. } = &arguments.checkpoints;
    input::keep_apart(&arguments.model, &model, results.into_iter().chain([checkpoint.as_deref()]))?;
    // The checkpoint from which a run continues may be replaced by later ones, but not by results.
    keep_apart(resume.as_deref(), results.into_iter().filter_map(target::file))?;
    arguments.outputs.apply([&mut model]);
    model.differentiate_by_parameters(!arguments.sensitivities.is_empty());
    for name in &arguments.project {
        model.keep(name).map_err(CliError::UnknownIntegral)?;
    }
    let besides = Besides {
        verify: !arguments.no_verify,
        fine: picture.is_some(),
        remarks: true,
        columns,
        estimate: arguments.estimate,
        checkpoints: arguments.checkpoints.files(),
        cache: std::env::var_os("PC_CACHE_DIR").filter(|directory| !directory.is_empty()).map(Cache::new),
        ..Besides::default()
    };
    // A picture needs all rows.
    let mut stream = file.and_then(TableFile::stream).filter(|_| picture.is_none());
    let run = Run::of(&model, &arguments.wishes(), &besides, stream.as_mut(), &Terminal)?;
    let so_far = file.filter(|_| run.is_interrupted()).and_then(TableFile::so_far).map(TablePlace::File);
    let place = so_far.as_ref().unwrap_or(&place);
    let picture = picture.map(|(place, wanted)| (place.for_run(&run), wanted));
    let written = write(&run, stream.filter(Stream::is_begun), place, picture.as_ref());
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
    place: &TablePlace,
    picture: Option<&(Destination, Wanted)>,
) -> Result<(), CliError> {
    match (stream, place) {
        (Some(stream), TablePlace::File(file)) => file.end(stream)?,
        _ => place.write(run, "motion")?,
    }
    if let Some(file) = place.file() {
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
