//! The header that tells the sources which model they belong to.

use std::fmt::Write;

use pc_expr::Language;
use pc_model::document::Simulation;

use crate::contents::{Contents, ParameterKind, Slope, sign};
use crate::experiment::Experiment;
use crate::options::FmuSolver;

/// Occurrences of events accumulate where the time left is this fraction of their first interval, unless the model says another.
const ACCUMULATION: f64 = 1e-5;
/// Parts of a step that are searched for events, unless the model says another number.
const SAMPLES: u32 = 4;

/// The header for a model whose functions begin with `prefix`.
pub(crate) fn layout(
    contents: &Contents<'_>,
    experiment: &Experiment,
    simulation: &Simulation,
    (prefix, token): (&str, &str),
) -> String {
    let constant = |value: f64| Language::C.constant(value);
    let (solver, step) = match experiment.solver {
        FmuSolver::Dop853 => ("FMU_DOP853", 1.0),
        FmuSolver::Radau5 => ("FMU_RADAU5", 1.0),
        FmuSolver::RungeKutta4 { step } => ("FMU_RK4", step),
    };
    let resets = contents.events.iter().filter(|event| event.is_reset).count();
    let places = |slopes: Vec<Slope<'_>>| -> Vec<(usize, usize)> {
        slopes.iter().filter(|_| contents.has_derivatives).map(|slope| (slope.of, slope.by)).collect()
    };
    let (calculated_slopes, start_slopes) =
        (places(contents.calculated_slopes()), places(contents.start_slopes()));
    let mut text = format!(
        "/* The sizes, names and settings of this model. */\n#ifndef PC_LAYOUT_H\n#define PC_LAYOUT_H\n\n#include \"{prefix}.h\"\n\n"
    );
    let mut define = |name: &str, value: String| {
        let _ = writeln!(text, "#define FMU_{name:<17} {value}");
    };
    define("TOKEN", Language::C.string(token));
    for (name, count) in [
        ("STATES", contents.states.len()),
        ("PARAMETERS", contents.parameters.len()),
        ("CALCULATED", contents.calculated.len()),
        ("OBSERVED", contents.observed.len()),
        ("EVENTS", contents.events.len()),
        ("RESETS", resets),
        ("KEPT", contents.kept.len()),
        ("GUARDS", contents.guards.len()),
        ("DERIVATIVES", usize::from(contents.has_derivatives)),
        ("CALCULATED_SLOPES", calculated_slopes.len()),
        ("START_SLOPES", start_slopes.len()),
        ("TIME_SLOPES", if contents.has_derivatives { contents.time_slopes().len() } else { 0 }),
    ] {
        define(name, count.to_string());
    }
    for (place, name) in ["DOP853", "RADAU5", "RK4"].into_iter().enumerate() {
        define(name, place.to_string());
    }
    define("SOLVER", solver.to_owned());
    define("FIXED_STEP", constant(step));
    define("MAX_STEP", constant(simulation.max_step.as_ref().map_or(f64::INFINITY, |step| step.value)));
    define("RELATIVE", constant(experiment.relative));
    define("T_START", constant(experiment.t_start));
    define("HORIZON", constant(experiment.length()));
    define("SAMPLES", simulation.samples_per_step.as_ref().map_or(SAMPLES, |n| n.value).to_string());
    define(
        "ACCUMULATION",
        constant(simulation.accumulation.as_ref().map_or(ACCUMULATION, |part| part.value)),
    );
    define("FIXED", u8::from(contents.is_fixed).to_string());
    text += "/* What a parameter of the equations is. */\n";
    for (place, name) in ["PARAMETER", "FOLLOWS", "INPUT"].into_iter().enumerate() {
        let _ = writeln!(text, "#define FMU_{name:<12} {place}");
    }
    text += "\n";
    for name in ["rhs", "jacobian"].into_iter().map(str::to_owned).chain(FUNCTIONS.map(str::to_owned)) {
        let _ = writeln!(text, "#define fmu_{name} {prefix}_{name}");
    }
    text += "\n";
    let mut array = |kind: &str, name: &str, entries: Vec<String>, none: &str| {
        let entries = if entries.is_empty() { vec![none.to_owned()] } else { entries };
        let _ = writeln!(text, "static const {kind}{name}[] = {{\n    {},\n}};", entries.join(",\n    "));
    };
    let strings = |names: &mut dyn Iterator<Item = &String>| -> Vec<String> {
        names.map(|name| Language::C.string(name)).collect()
    };
    let string = "char *const ";
    array(string, "state_names", strings(&mut contents.states.iter().map(|s| &s.name)), "\"\"");
    let absolute = contents.states.iter().map(|state| constant(experiment.absolute(&state.name)));
    array("double ", "absolute_tolerances", absolute.collect(), "0.0");
    let nominal = contents.states.iter().map(|state| constant(experiment.nominal(&state.name)));
    array("double ", "nominal_values", nominal.collect(), "1.0");
    let exact = contents.states.iter().map(|state| u8::from(state.number.is_some()).to_string());
    array("int ", "start_is_exact", exact.collect(), "0");
    array(string, "parameter_names", strings(&mut contents.parameters.iter().map(|p| &p.name)), "\"\"");
    let values = contents.parameters.iter().map(|parameter| constant(parameter.value));
    array("double ", "default_parameters", values.collect(), "0.0");
    let kinds = contents.parameters.iter().map(|parameter| match parameter.kind {
        ParameterKind::Given => "FMU_PARAMETER".to_owned(),
        ParameterKind::Follows => "FMU_FOLLOWS".to_owned(),
        ParameterKind::Input => "FMU_INPUT".to_owned(),
    });
    array("int ", "parameter_kinds", kinds.collect(), "0");
    if !contents.calculated.is_empty() {
        let places = contents.calculated.iter().map(|(place, _)| place.to_string());
        array("int ", "calculated_places", places.collect(), "0");
    }
    for (name, slopes) in [("calculated", calculated_slopes), ("start", start_slopes)] {
        if !slopes.is_empty() {
            let of = slopes.iter().map(|(of, _)| of.to_string()).collect();
            array("int ", &format!("{name}_slope_of"), of, "");
            let by = slopes.iter().map(|(_, by)| by.to_string()).collect();
            array("int ", &format!("{name}_slope_by"), by, "");
        }
    }
    if !contents.events.is_empty() {
        let events = &contents.events;
        array(string, "event_names", strings(&mut events.iter().map(|event| &event.name)), "");
        array("int ", "event_directions", events.iter().map(|e| sign(e.direction).to_string()).collect(), "");
        let terminal = events.iter().map(|event| u8::from(event.is_terminal).to_string());
        array("int ", "event_terminal", terminal.collect(), "");
        array("int ", "event_resets", events.iter().map(|e| u8::from(e.is_reset).to_string()).collect(), "");
    }
    if !contents.kept.is_empty() {
        array(string, "kept_names", strings(&mut contents.kept.iter().map(|kept| &kept.name)), "");
        let zero = contents.kept.iter().map(|kept| u8::from(kept.is_constraint).to_string());
        array("int ", "kept_constraint", zero.collect(), "");
    }
    text + "\n#endif\n"
}

/// The functions beside those of the equations.
const FUNCTIONS: [&str; 12] = [
    "start",
    "calculated",
    "observed",
    "events",
    "resets",
    "kept",
    "kept_slopes",
    "guards",
    "calculated_slopes",
    "start_slopes",
    "time_slopes",
    "directional",
];
