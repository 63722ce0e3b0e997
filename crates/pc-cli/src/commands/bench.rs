//! `pc bench`: how long the derivation of a model and an evaluation of its equations take.

use std::time::Instant;

use pc_mech::CompileOptions;
use pc_model::Model;
use pc_print::{visible, visible_json};

use crate::args::bench::BenchArguments;
use crate::args::input;
use crate::args::options::Format;
use crate::bench::derivation::Derivation;
use crate::bench::kernels::Derived;
use crate::bench::measure::interleave;
use crate::bench::page::Figures;
use crate::error::CliError;
use crate::output::text::TextOutput;
use crate::terminal::observer::Terminal;
use pc_run::motion::remarks::say_moved;

/// Prints the times of derivations and evaluations.
///
/// # Errors
/// [`CliError`] of the model; `FileError::Write`.
pub fn command(arguments: &BenchArguments) -> Result<(), CliError> {
    let place = TextOutput::at(arguments.output.as_deref())?;
    let model = input::open(&arguments.model)?;
    input::keep_apart(&arguments.model, &model, [arguments.output.as_deref()])?;
    model.require_values()?;
    // Each derivation has the full memory limit; the time limit holds for all of them together.
    let fresh = || -> Model {
        let mut model = model.clone();
        model.limit(model.budget().limits().clone());
        model
    };
    let graph = model.graph();
    let assembly = model.assemble(&graph)?;
    say_moved(&assembly, &Terminal);
    let derived = Derived::new(&model, &assembly)?;
    let mut variants = derived.variants()?;
    assembly.within_limits()?;

    let half = arguments.seconds / 2;
    let start = Instant::now();
    let mut derivation = Derivation::default();
    while derivation.total.len() == 0 || start.elapsed() < half {
        derivation.repeat(&fresh())?;
    }
    let times = interleave(derived.start(), &mut variants, half);
    let figures = Figures {
        title: model.title().to_owned(),
        state: derived.start().len(),
        nodes: graph.len(),
        cost: derived.compile(CompileOptions::default())?.cost(),
        derivation,
        variants: &variants,
        times,
    };
    place.write(|out| match arguments.format {
        Format::Text => write!(out, "{}", visible(&figures.text())),
        Format::Json => writeln!(out, "{}", visible_json(&figures.json())),
    })
}
