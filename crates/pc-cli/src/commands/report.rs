//! `pc report`: all that is known of a model on one page; `pc animate`: its motion alone, as a page or in pictures.

use pc_model::{Assembly, Model};
use pc_report::files::{nearest, stills};
use pc_report::{Page, Recording, ReportError, Scene, animation, report};
use pc_run::Plan;
use pc_run::RunError;
use pc_run::Wishes;
use pc_run::motion::integrate::Besides;
use pc_run::motion::run::Run;

use crate::args::input;
use crate::args::report::{AnimateArguments, ReportArguments, ShownArguments};
use crate::error::CliError;
use crate::output::destination::{Destination, Encoding};
use crate::terminal::observer::Terminal;
use crate::terminal::progress_of_parts::Progress;

/// Points with which a curve looks smooth.
const SMOOTH: usize = 601;
/// Width and height of a frame.
const PAPER: [f64; 2] = [480.0, 360.0];

/// Writes the page of a model.
///
/// # Errors
/// [`CliError`]; a motion that failed has been written as far as it was reached.
pub fn command(arguments: &ReportArguments) -> Result<(), CliError> {
    let destination = Destination::page(arguments.output.as_deref())?;
    let model = input::open(&arguments.shown.model)?;
    input::keep_apart(&arguments.shown.model, &model, [arguments.output.as_deref()])?;
    if arguments.no_run {
        let page = model.derived(|assembly| made(arguments.full, &model, assembly, None))?;
        return destination.write_page(&page);
    }
    let mut model = kept(model, &arguments.shown)?;
    model.observe_reactions(!model.document().constraints.is_empty());
    let graph = model.graph();
    let assembly = model.assemble(&graph)?;
    let run = match integrated(&model, &assembly, &arguments.shown) {
        Err(CliError::Run(RunError::NoEnd { .. })) => None,
        run => Some(run?),
    };
    let none = || Recording { remark: Some(NO_END.to_owned()), ..Recording::default() };
    let record = run.as_ref().map_or_else(none, Run::record);
    let destination = match &run {
        Some(run) => destination.for_run(run),
        None => destination,
    };
    destination.write_page(&made(arguments.full, &model, &assembly, Some(&record))?)?;
    Ok(run.map_or(Ok(()), Run::outcome)?)
}

/// The page, with progress on a terminal.
fn made(
    full: bool,
    model: &Model,
    assembly: &Assembly<'_>,
    motion: Option<&Recording>,
) -> Result<String, ReportError> {
    let progress = Progress::new();
    Page { full, part: &|part| progress.at(part) }.of(model, assembly, motion)
}

const NO_END: &str = "There is no motion: the text says no end of time, and --t-end was not given.";

/// Writes a motion as a page, a film, or a picture of one frame.
///
/// # Errors
/// [`CliError`], also where there is nothing to draw; a motion that failed has been written as far
/// as it was reached.
pub fn animate(arguments: &AnimateArguments) -> Result<(), CliError> {
    let destination = Destination::shown(arguments.output.as_deref())?;
    let is_frame = matches!(destination.encoding(), Encoding::Svg | Encoding::Png | Encoding::Pdf);
    if arguments.time.is_some() && !is_frame {
        return Err(CliError::NoFrame);
    }
    let model = kept(input::open(&arguments.shown.model)?, &arguments.shown)?;
    input::keep_apart(&arguments.shown.model, &model, [arguments.output.as_deref()])?;
    let graph = model.graph();
    let assembly = model.assemble(&graph)?;
    let run = integrated(&model, &assembly, &arguments.shown)?;
    let scene = Scene::of(&model, &assembly, &run.record())?;
    let scene = scene.ok_or_else(|| CliError::NothingToDraw { model: model.title().to_owned() })?;
    let (title, times) = (model.title(), &scene.times);
    let drawing = |frame| scene.drawing(title, frame, PAPER);
    let destination = destination.for_run(&run);
    match destination.encoding() {
        Encoding::Gif => destination.write_film(stills(times).into_iter().map(drawing))?,
        _ if is_frame => {
            let at = arguments.time.map_or(times.len() - 1, |t| nearest(times, t));
            destination.write_plot(&drawing(at))?;
        }
        _ => destination.write_page(&animation(title, &scene))?,
    }
    Ok(run.outcome()?)
}

/// The page of a model with a motion that has been integrated.
///
/// # Errors
/// [`CliError`] for a model that cannot be derived.
pub fn page(model: &Model, run: &Run) -> Result<String, CliError> {
    Ok(model.derived(|assembly| report(model, assembly, Some(&run.record())))?)
}

/// The model with the integrals to be kept.
fn kept(mut model: Model, shown: &ShownArguments) -> Result<Model, CliError> {
    for name in &shown.project {
        model.keep(name).map_err(CliError::UnknownIntegral)?;
    }
    Ok(model)
}

/// The motion, with enough rows for smooth curves.
fn integrated(model: &Model, assembly: &Assembly<'_>, shown: &ShownArguments) -> Result<Run, CliError> {
    let wishes = shown.wishes();
    let rows = Plan::of(model, &wishes)?.samples;
    let wishes = Wishes { samples: Some(shown.rows.unwrap_or(rows.max(SMOOTH))), ..wishes };
    Ok(Run::of_assembly(model, assembly, &wishes, &Besides::shown(), None, &Terminal)?)
}
