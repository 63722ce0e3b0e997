//! `pc report`: all that is known of a model on one page; `pc animate`: its motion alone, as a page or in pictures.

use pc_model::Model;
use pc_report::files::{frames, nearest};
use pc_report::{Record, Scene, animation, report};
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
    let mut model = input::open(&arguments.shown.model)?;
    if arguments.no_run {
        return destination.write_page(&report(&model, None)?);
    }
    model.observe_reactions(!model.document().constraints.is_empty());
    let run = match integrated(&mut model, &arguments.shown) {
        Err(CliError::Run(RunError::NoEnd { .. })) => None,
        run => Some(run?),
    };
    let none = || Record { remark: Some(NO_END.to_owned()), ..Record::default() };
    let record = run.as_ref().map_or_else(none, Run::record);
    destination.write_page(&report(&model, Some(&record))?)?;
    Ok(run.map_or(Ok(()), Run::outcome)?)
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
    if arguments.at.is_some() && !is_frame {
        return Err(CliError::NoFrame);
    }
    let mut model = input::open(&arguments.shown.model)?;
    let run = integrated(&mut model, &arguments.shown)?;
    let graph = model.graph();
    let scene = Scene::of(&model, &model.assemble(&graph)?, &run.record())?;
    let scene = scene.ok_or_else(|| CliError::NothingToDraw { model: model.title().to_owned() })?;
    let (title, times) = (model.title(), &scene.times);
    let drawing = |frame| scene.drawing(title, frame, PAPER);
    match destination.encoding() {
        Encoding::Gif => destination.write_film(frames(times).into_iter().map(drawing))?,
        _ if is_frame => {
            let at = arguments.at.map_or(times.len() - 1, |t| nearest(times, t));
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
    Ok(report(model, Some(&run.record()))?)
}

/// The motion, with enough rows for smooth curves.
fn integrated(model: &mut Model, shown: &ShownArguments) -> Result<Run, CliError> {
    for name in &shown.project {
        model.keep(name).map_err(CliError::UnknownIntegral)?;
    }
    let wishes = shown.wishes();
    let rows = Plan::of(model, &wishes)?.samples;
    let wishes = Wishes { samples: Some(shown.samples.unwrap_or(rows.max(SMOOTH))), ..wishes };
    Ok(Run::of(model, &wishes, &Besides::shown(), None, &Terminal)?)
}
