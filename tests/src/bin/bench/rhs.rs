//! `bench rhs`: one evaluation of ẏ = f(y), derived and by hand.

use std::hint::black_box;
use std::sync::Arc;

use pc_expr::{Inputs, Interpreter, Jit, Kernel, Program};
use pc_mech::{Equations, Graph, VectorField};
use pc_tests::classical::SplitMix64;

use crate::error::Error;
use crate::hand::Routine;
use crate::measure::{Call, ROUNDS, Times, Variant, geometric_mean, interleave};
use crate::report::Report;
use crate::systems::{Case, Derive, FURTHER, SYSTEMS};

/// Variants may differ by this, relative to the largest component.
const ROUNDING: f64 = 1e-12;
/// States at which they are compared.
const STATES: usize = 100;

/// A way to run programs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Backend {
    Interpreter,
    Jit,
}

impl Backend {
    const ALL: [Backend; 2] = [Backend::Interpreter, Backend::Jit];

    fn name(self) -> &'static str {
        match self {
            Backend::Interpreter => "interpreter",
            Backend::Jit => "jit",
        }
    }

    /// The program as a function of the state, or why there is none.
    fn call(self, program: &Program, parameters: Vec<f64>) -> Result<Box<Call<'static>>, String> {
        match self {
            Backend::Interpreter => {
                let mut kernel = Interpreter::new(Arc::new(program.clone()));
                Ok(Box::new(move |y, dy| kernel.eval(0.0, y, &parameters, dy)))
            }
            Backend::Jit => {
                let jit = Jit::new(program).map_err(|error| error.to_string())?;
                Ok(enter(Routine::compiled(jit, parameters)))
            }
        }
    }
}

/// Machine code as a variant calls it, by hand or not.
fn enter(mut routine: Routine) -> Box<Call<'static>> {
    Box::new(move |y, dy| routine.call(y, dy))
}

/// A backend against the code by hand, with numbers for parameters or not: one ratio for each system.
struct Comparison {
    backend: Backend,
    bound: bool,
    ratios: Vec<(String, f64)>,
}

impl Comparison {
    /// One for each backend, with parameters bound and free.
    fn all() -> Vec<Comparison> {
        let of = |bound| Backend::ALL.map(|backend| Comparison { backend, bound, ratios: Vec::new() });
        [of(false), of(true)].into_iter().flatten().collect()
    }

    fn mean(&self) -> f64 {
        geometric_mean(&self.ratios.iter().map(|&(_, ratio)| ratio).collect::<Vec<_>>())
    }

    fn largest(&self) -> Option<&(String, f64)> {
        self.ratios.iter().max_by(|a, b| a.1.total_cmp(&b.1))
    }
}

/// Times all systems; the last line is the geometric mean of the JIT's ratios to the code by hand.
///
/// # Errors
/// [`Error::Disagreement`] before anything is timed of a system whose variants differ.
pub(crate) fn run(report: &mut Report) -> Result<(), Error> {
    report.line(format!(
        "ns a call: minimum, 10th percentile and median of {ROUNDS} rounds, in each of which every variant \
         of a system has one turn of about 100 µs.\nEach call waits for the one before: where its state is \
         depends on all outputs. `empty` copies the state: the cost of the harness, contained in the other \
         rows.\n`/ hand` is the median over the rounds of the ratio within a round. `hand` and `jit` are \
         entered by the same instructions, through a pointer to machine code.\nAll variants agree to \
         {ROUNDING:e} at {STATES} random states. `bound` has numbers for parameters, as `hand` has; `motion` \
         is what an integrator calls, pivots watched.\n"
    ));
    let comparisons = group(SYSTEMS, report)?;
    report.line("\nSystems beside those that the means are taken of:\n");
    group(FURTHER, report)?;

    report.line("");
    for bound in [false, true] {
        let parameters = if bound { "" } else { ", parameters free" };
        for comparison in comparisons.iter().filter(|comparison| comparison.bound == bound) {
            let name = comparison.backend.name();
            if let Some((system, ratio)) = comparison.largest() {
                report.line(format!("largest {name}/hand{parameters}: {ratio:.2} ({system})"));
            }
            report.line(format!("geometric mean {name}/hand{parameters}: {:.2}", comparison.mean()));
        }
    }
    Ok(())
}

/// Times systems in a table.
fn group(systems: &[Derive], report: &mut Report) -> Result<Vec<Comparison>, Error> {
    report.columns(&["system", "variant", "operations", "min", "p10", "median", "/ hand"]);
    let mut comparisons = Comparison::all();
    for system in systems {
        let graph = Graph::new();
        time(&system(&graph)?, &mut comparisons, report)?;
    }
    Ok(comparisons)
}

/// What is timed, beside what the table says of it.
struct Entry<'a> {
    variant: Variant<'a>,
    operations: Option<usize>,
    /// Index of the comparison it belongs to.
    comparison: Option<usize>,
}

impl<'a> Entry<'a> {
    /// One that belongs to no comparison.
    fn plain(name: &str, call: Box<Call<'a>>) -> Entry<'a> {
        Entry { variant: Variant::new(name, call), operations: None, comparison: None }
    }
}

fn entries<'a>(case: &Case<'_>, comparisons: &[Comparison]) -> Result<Vec<Entry<'a>>, Error> {
    let mut entries = vec![Entry::plain("empty", Box::new(empty))];
    entries.extend(case.hand.iter().map(|&(name, hand)| Entry::plain(name, enter(hand.into()))));
    for (equations, bound) in [(&case.equations.with_parameters_bound(), true), (&case.equations, false)] {
        let (program, parameters) = program(equations)?;
        for backend in Backend::ALL {
            let call = backend.call(&program, parameters.clone()).map_err(|cause| Error::Kernel {
                kernel: backend.name(),
                system: case.name.clone(),
                cause,
            })?;
            let name = if bound { format!("{}, bound", backend.name()) } else { backend.name().to_owned() };
            entries.push(Entry {
                variant: Variant::new(name, call),
                operations: Some(program.cost().total()),
                comparison: comparisons.iter().position(|c| c.backend == backend && c.bound == bound),
            });
        }
    }
    let mut motion = case.equations.compile()?;
    let rhs = move |y: &[f64], dy: &mut [f64]| {
        if motion.rhs(0.0, y, dy).is_err() {
            dy.fill(f64::NAN);
        }
    };
    entries.push(Entry::plain("motion", Box::new(rhs)));
    Ok(entries)
}

fn time(case: &Case<'_>, comparisons: &mut [Comparison], report: &mut Report) -> Result<(), Error> {
    let mut entries = entries(case, comparisons)?;
    let mut random = SplitMix64::new(1);
    compare(case, &mut random, &mut entries)?;
    let mut variants: Vec<Variant<'_>> = Vec::new();
    let mut labels = Vec::new();
    for entry in entries {
        variants.push(entry.variant);
        labels.push((entry.operations, entry.comparison));
    }
    let times = interleave(&(case.state)(&mut random), &mut variants);
    let hand = times[1].clone();
    for ((variant, times), (operations, comparison)) in variants.iter().zip(&times).zip(labels) {
        let ratio = times.ratio_to(&hand);
        if let Some(i) = comparison {
            comparisons[i].ratios.push((case.name.clone(), ratio));
        }
        report.row(&row(&case.name, &variant.name, operations, times, ratio));
    }
    Ok(())
}

fn row(system: &str, variant: &str, operations: Option<usize>, times: &Times, ratio: f64) -> [String; 7] {
    [
        system.to_owned(),
        variant.to_owned(),
        operations.map_or_else(String::new, |count| count.to_string()),
        format!("{:.1}", times.min()),
        format!("{:.1}", times.p10()),
        format!("{:.1}", times.median()),
        format!("{ratio:.2}"),
    ]
}

/// The program of ẋ and η̇ alone, with the values of its parameters.
fn program(equations: &Equations<'_>) -> Result<(Program, Vec<f64>), Error> {
    let system = equations.system();
    let frame = system.frame();
    let (parameters, values) = system.parameters().iter().copied().unzip();
    let inputs = Inputs {
        time: Some(frame.time()),
        state: frame.coordinates().iter().chain(system.quasi_velocities()).copied().collect(),
        parameters,
    };
    let mut outputs = equations.velocities().to_vec();
    outputs.extend(equations.accelerations());
    Ok((Program::new(system.graph(), &inputs, &outputs)?, values))
}

/// ẏ = y, number by number.
fn empty(y: &[f64], dy: &mut [f64]) {
    for (dy, y) in dy.iter_mut().zip(y) {
        *dy = black_box(*y);
    }
}

/// Compares all variants but the empty one with the first by hand, at random states.
fn compare(case: &Case<'_>, random: &mut SplitMix64, entries: &mut [Entry<'_>]) -> Result<(), Error> {
    (0..STATES).try_for_each(|_| compare_at(case, &(case.state)(random), entries))
}

fn compare_at(case: &Case<'_>, state: &[f64], entries: &mut [Entry<'_>]) -> Result<(), Error> {
    let reference = entries[1].variant.at(state);
    let size = reference.iter().fold(1.0f64, |size, v| size.max(v.abs()));
    for i in 2..entries.len() {
        let found = entries[i].variant.at(state);
        for (component, (a, b)) in found.iter().zip(&reference).enumerate() {
            let error = (a - b).abs() / size;
            if error.is_nan() || error > ROUNDING {
                return Err(Error::Disagreement {
                    system: case.name.clone(),
                    variant: entries[i].variant.name.clone(),
                    reference: entries[1].variant.name.clone(),
                    component,
                    error,
                    state: state.to_vec(),
                });
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equations_written_by_hand_are_those_derived() -> Result<(), Error> {
        let mut random = SplitMix64::new(2);
        for system in SYSTEMS.iter().chain(FURTHER) {
            let graph = Graph::new();
            let case = system(&graph)?;
            compare(&case, &mut random, &mut entries(&case, &[])?)?;
        }
        Ok(())
    }
}
