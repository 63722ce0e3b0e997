//! One right-hand side run in five ways: interpreted, compiled at run time with the usual options and with
//! exact ones, and emitted as C and as Rust.

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use pc_expr::{Expr, Inputs, Interpreter, Jit, JitOptions, Kernel, Program};
use pc_mech::{EmitOptions, Equations, Graph};
use pc_model::{BUILTIN, Model};
use pc_tests::classical::{SplitMix64, sample};
use pc_tests::emitted::{self, Emitted, Routine, fresh_directory};
use pc_tests::magnitude::terms;
use pc_tests::reference::reference;

/// States tried for each model.
const STATES: usize = 10_000;

/// Fused operations and sines that are 2 units in the last place off: some hundred roundings of the largest
/// term.
const ROUNDING: f64 = 1e-13;

/// The C library's functions are Rust's on Linux. Elsewhere they may be a unit in the last place off.
const SAME_LIBRARY: bool = cfg!(target_os = "linux");

const C_FLAGS: &[&str] =
    &["-std=c99", "-O2", "-ffp-contract=off", "-Wall", "-Wextra", "-Wpedantic", "-Werror"];

/// The right-hand side of a model as a program and as source, with states at which it is regular.
struct Subject {
    name: String,
    program: Program,
    emitted: Emitted,
    /// t, state, parameters
    inputs: Vec<Vec<f64>>,
}

impl Subject {
    fn new(
        name: &str,
        equations: &Equations<'_>,
        sample: impl Fn(&mut SplitMix64) -> (f64, Vec<f64>),
        fastest: f64,
    ) -> Subject {
        let system = equations.system();
        let (coordinates, velocities) = (system.frame().coordinates(), system.quasi_velocities());
        let (parameters, values): (Vec<Expr<'_>>, Vec<f64>) = system.parameters().iter().copied().unzip();
        let inputs = Inputs {
            time: Some(system.frame().time()),
            state: coordinates.iter().chain(velocities).copied().collect(),
            parameters,
        };
        let rates = [equations.velocities(), &equations.accelerations()].concat();
        let routine = Routine { name: "rhs", outputs: Some(rates.len()) };
        let angles: Vec<bool> = coordinates.iter().map(|x| is_angle(&x.to_string())).collect();
        let mut random = SplitMix64::new(29);
        let states = (0..STATES).map(|_| {
            let (t, mut y) = sample(&mut random);
            scatter(&mut y, &angles, fastest, &mut random);
            if name == SINGULAR_AT_REST && y[angles.len()..].iter().all(|&rate| rate == 0.0) {
                y[angles.len()..].fill(1.0);
            }
            // Within what keeps the samples regular, so that parameters are seen to be arguments.
            let p = values.iter().map(|value| value * (1.0 + random.uniform(0.0, 0.05)));
            [t].into_iter().chain(y).chain(p).collect()
        });
        Subject {
            name: name.to_owned(),
            program: Program::new(system.graph(), &inputs, &rates).unwrap(),
            emitted: Emitted::new(equations, |language| EmitOptions::new(language, name), vec![routine])
                .unwrap(),
            inputs: states.collect(),
        }
    }

    /// What a kernel of the program makes of each input.
    fn run(&self, kernel: &mut dyn Kernel) -> Vec<Vec<f64>> {
        let dimension = self.program.state_len();
        let rates = self.inputs.iter().map(|inputs| {
            let (y, p) = inputs[1..].split_at(dimension);
            let mut rates = vec![f64::NAN; dimension];
            kernel.eval(inputs[0], y, p, &mut rates);
            rates
        });
        rates.collect()
    }

    fn interpreted(&self) -> Vec<Vec<f64>> {
        let rates = self.run(&mut Interpreter::new(Arc::new(self.program.clone())));
        let regular = rates.iter().flatten().all(|rate| rate.is_finite());
        assert!(regular, "{} has been tried where it is singular", self.name);
        rates
    }

    /// `found` is what the interpreter finds, bit for bit.
    fn assert_bits(&self, found: &[Vec<f64>], by: &str) {
        assert_eq!(found.len(), STATES);
        for ((inputs, expected), found) in self.inputs.iter().zip(self.interpreted()).zip(found) {
            let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
            let same = bits(&expected) == bits(found);
            assert!(same, "{} {by} at {inputs:?}: {found:?}, not {expected:?}", self.name);
        }
    }

    /// The largest difference of `found` from what the interpreter finds, relative to the largest term; at
    /// most [`ROUNDING`].
    fn assert_rounding(&self, found: &[Vec<f64>], by: &str) -> f64 {
        let mut worst = 0.0f64;
        for (inputs, found) in self.inputs.iter().zip(found) {
            for (i, (term, found)) in terms(&self.program, inputs).iter().zip(found).enumerate() {
                let error = (found - term.value).abs();
                assert!(
                    error <= ROUNDING * term.size,
                    "{} {by} at {inputs:?}: component {i} is {found}, not {term:?}",
                    self.name
                );
                if error > 0.0 {
                    worst = worst.max(error / term.size);
                }
            }
        }
        worst
    }
}

/// A model whose constraint, homogeneous in the velocities, restricts none of them where all vanish.
const SINGULAR_AT_REST: &str = "appell-hamel";

fn is_angle(name: &str) -> bool {
    ["ψ", "θ", "φ", "psi", "theta", "phi"].contains(&name)
}

/// Velocities from a millionth to 10^`fastest` times those drawn, some of them zero, and up to a million
/// turns more.
fn scatter(y: &mut [f64], angles: &[bool], fastest: f64, random: &mut SplitMix64) {
    let scale = 10f64.powf(random.uniform(-6.0, fastest));
    for (i, y) in y.iter_mut().enumerate() {
        let seldom = random.next_bits().is_multiple_of(20);
        match angles.get(i) {
            Some(true) if seldom => *y += TAU * (10f64.powf(random.uniform(0.0, 6.0)) * y.signum()).round(),
            Some(_) => {}
            None if seldom => *y *= 0.0,
            None => *y *= scale,
        }
    }
}

/// All built-in models.
fn subjects() -> Vec<Subject> {
    let mut subjects: Vec<Subject> = Vec::new();
    for builtin in BUILTIN {
        let graph = Graph::new();
        let assembly =
            Model::new(builtin.document().unwrap()).assemble(&graph).unwrap_or_else(|e| panic!("{e}"));
        let equations = assembly.equations().unwrap();
        let system = equations.system();
        let state = [system.frame().coordinates(), system.quasi_velocities()].concat();
        let columns = reference(builtin.name).unwrap();
        // No faster than light.
        let fastest = if builtin.name.starts_with("relativistic") { 0.0 } else { 3.0 };
        let draw = |random: &mut SplitMix64| {
            let (t, y) = sample(builtin.name, random).unwrap();
            (t, columns.pick(&state, &y))
        };
        subjects.push(Subject::new(builtin.name, &equations, draw, fastest));
    }
    subjects
}

/// What emitted source makes of the inputs of each subject; `compile` answers the program.
fn emitted_rates(
    subjects: &[Subject],
    language: &str,
    compile: impl Fn(&Path, &[Emitted]) -> PathBuf,
) -> Vec<Vec<Vec<f64>>> {
    let directory = fresh_directory(Path::new(env!("CARGO_TARGET_TMPDIR")).join("backends").join(language));
    let sources: Vec<Emitted> = subjects.iter().map(|subject| subject.emitted.clone()).collect();
    let program = compile(&directory, &sources);
    emitted::run(&program, subjects.iter().map(|subject| (&subject.emitted, &subject.inputs[..])))
}

#[test]
fn compiled_equations_agree_to_rounding_of_the_largest_term() {
    for subject in subjects() {
        let found = subject.run(&mut Jit::new(&subject.program).unwrap());
        let worst = subject.assert_rounding(&found, "compiled");
        println!("{}: {worst:.1e} of the largest term", subject.name);
    }
}

#[test]
fn exactly_compiled_equations_have_the_same_bits() {
    let exact = JitOptions { fma: false, inline_trig: false, ..JitOptions::default() };
    for subject in subjects() {
        let found = subject.run(&mut Jit::with_options(&subject.program, &exact).unwrap());
        subject.assert_bits(&found, "exactly compiled");
    }
}

#[test]
fn emitted_c_has_the_same_bits() {
    let subjects = subjects();
    let found =
        emitted_rates(&subjects, "c", |path, sources| emitted::compile_c(path, "gcc", C_FLAGS, sources));
    for (subject, found) in subjects.iter().zip(&found) {
        if SAME_LIBRARY {
            subject.assert_bits(found, "in C");
        } else {
            subject.assert_rounding(found, "in C");
        }
    }
}

#[test]
fn emitted_rust_has_the_same_bits() {
    let subjects = subjects();
    let found = emitted_rates(&subjects, "rust", |path, sources| emitted::compile_rust(path, &[], sources));
    for (subject, found) in subjects.iter().zip(&found) {
        subject.assert_bits(found, "in Rust");
    }
}
