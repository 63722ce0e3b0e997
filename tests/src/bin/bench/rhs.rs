//! `bench rhs`: one evaluation of ẏ = f(y), derived and by hand.

use std::hint::black_box;
use std::sync::Arc;

use pc_expr::{Inputs, Interpreter, Jit, Kernel, Program};
use pc_mech::{Equations, Graph, VectorField};
use pc_tests::classical::SplitMix64;

use crate::error::Error;
use crate::measure::{ROUNDS, Times, Variant, geometric_mean, interleave};
use crate::report::Report;
use crate::systems::{Case, SYSTEMS};

/// Variants may differ by this, relative to the largest component.
const ROUNDING: f64 = 1e-12;
/// States at which they are compared.
const STATES: usize = 100;

/// A way to run programs.
struct KernelKind {
    name: &'static str,
    /// A kernel of the program, or why there is none.
    make: fn(&Program) -> Result<Box<dyn Kernel>, String>,
}

/// Every kernel is timed alike.
const KERNELS: &[KernelKind] = &[
    KernelKind {
        name: "interpreter",
        make: |program| Ok(Box::new(Interpreter::new(Arc::new(program.clone())))),
    },
    KernelKind {
        name: "jit",
        make: |program| match Jit::new(program) {
            Ok(jit) => Ok(Box::new(jit)),
            Err(error) => Err(error.to_string()),
        },
    },
];

/// A kernel with its parameters against the code by hand: one ratio for each system.
struct Comparison {
    kernel: &'static str,
    bound: bool,
    ratios: Vec<f64>,
}

/// Times all systems.
///
/// # Errors
/// [`Error::Disagreement`] before anything is timed of a system whose variants differ.
pub(crate) fn run(report: &mut Report) -> Result<(), Error> {
    report.line(format!(
        "ns a call: minimum, 10th percentile and median of {ROUNDS} rounds, in each of which every variant of a system \
         has one turn of about 100 µs.\nEach call waits for the one before, since every input contains an output. \
         `empty` copies the state: the cost of the harness, contained in the other rows.\n`/ hand` is the median over \
         the rounds of the ratio within a round. All variants agree to {ROUNDING:e} at {STATES} random states.\n\
         `bound` has numbers for parameters, as `hand` has; `motion` is what an integrator calls, pivots watched.\n"
    ));
    report.columns(&["system", "variant", "operations", "min", "p10", "median", "/ hand"]);
    let mut comparisons: Vec<Comparison> = Vec::new();
    for kernel in KERNELS {
        for bound in [true, false] {
            comparisons.push(Comparison { kernel: kernel.name, bound, ratios: Vec::new() });
        }
    }
    for system in SYSTEMS {
        let graph = Graph::new();
        let case = system(&graph)?;
        time(&case, &mut comparisons, report)?;
    }
    report.line("");
    for Comparison { kernel, bound, ratios } in &comparisons {
        let parameters = if *bound { "" } else { ", parameters free" };
        report.line(format!("geometric mean {kernel}/hand{parameters}: {:.2}", geometric_mean(ratios)));
    }
    Ok(())
}

/// What is timed, beside what the table says of it.
struct Entry<'a> {
    variant: Variant<'a>,
    operations: Option<usize>,
    /// Index of the comparison it belongs to.
    comparison: Option<usize>,
}

fn time(case: &Case<'_>, comparisons: &mut [Comparison], report: &mut Report) -> Result<(), Error> {
    let mut entries =
        vec![Entry { variant: Variant::new("empty", empty), operations: None, comparison: None }];
    for &(name, hand) in &case.hand {
        entries.push(Entry { variant: Variant::new(name, hand), operations: None, comparison: None });
    }
    for (equations, bound) in [(&case.equations.with_parameters_bound(), true), (&case.equations, false)] {
        let (program, parameters) = program(equations)?;
        for kind in KERNELS {
            let mut kernel = (kind.make)(&program).map_err(|cause| Error::Kernel {
                kernel: kind.name,
                system: case.name.clone(),
                cause,
            })?;
            let parameters = parameters.clone();
            let name = if bound { format!("{}, bound", kind.name) } else { kind.name.to_owned() };
            entries.push(Entry {
                variant: Variant::new(name, move |y: &[f64], dy: &mut [f64]| {
                    kernel.eval(0.0, y, &parameters, dy);
                }),
                operations: Some(program.cost().total()),
                comparison: comparisons.iter().position(|c| c.kernel == kind.name && c.bound == bound),
            });
        }
    }
    let mut motion = case.equations.compile()?;
    entries.push(Entry {
        variant: Variant::new("motion", move |y: &[f64], dy: &mut [f64]| {
            if motion.rhs(0.0, y, dy).is_err() {
                dy.fill(f64::NAN);
            }
        }),
        operations: None,
        comparison: None,
    });

    let mut random = SplitMix64::new(1);
    for _ in 0..STATES {
        compare(case, &(case.state)(&mut random), &mut entries)?;
    }
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
            comparisons[i].ratios.push(ratio);
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

/// Compares all variants but the empty one with the first by hand.
fn compare(case: &Case<'_>, state: &[f64], entries: &mut [Entry<'_>]) -> Result<(), Error> {
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
