//! One right-hand side run in five ways: interpreted, compiled at run time with the usual options and with
//! exact ones, and emitted as C and as Rust.

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use pc_expr::{Jit, JitOptions};
use pc_mech::EmitOptions;
use pc_tests::classical::{SplitMix64, sample};
use pc_tests::emitted::{self, Emitted, Routine, fresh_directory};
use pc_tests::reference::reference;

use crate::derived::Derived;
use crate::subject::Subject;

/// States tried for each model.
const STATES: usize = 10_000;

/// The C library's functions are Rust's on Linux. Elsewhere they may be a unit in the last place off.
const SAME_LIBRARY: bool = cfg!(target_os = "linux");

const C_FLAGS: &[&str] =
    &["-std=c99", "-O2", "-ffp-contract=off", "-Wall", "-Wextra", "-Wpedantic", "-Werror"];

/// A model whose constraint, homogeneous in the velocities, restricts none of them where all vanish.
pub(crate) const SINGULAR_AT_REST: &str = "appell-hamel";

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

/// The right-hand side of a model, with states at which it is regular.
fn subject_of(derived: &Derived<'_>) -> Subject {
    let (name, equations) = (derived.name, &derived.equations);
    let system = equations.system();
    let (state, values) = (derived.state(), system.parameters().iter().map(|&(_, value)| value));
    let values: Vec<f64> = values.collect();
    let routine = Routine { name: "rhs", outputs: Some(state.len()) };
    let angles: Vec<bool> = system.frame().coordinates().iter().map(|x| is_angle(&x.to_string())).collect();
    let columns = reference(name).unwrap();
    // No faster than light.
    let fastest = if name.starts_with("relativistic") { 0.0 } else { 3.0 };
    let mut random = SplitMix64::new(29);
    let states = (0..STATES).map(|_| {
        let (t, y) = sample(name, &mut random).unwrap();
        let mut y = columns.pick(&state, &y);
        scatter(&mut y, &angles, fastest, &mut random);
        if name == SINGULAR_AT_REST && y[angles.len()..].iter().all(|&rate| rate == 0.0) {
            y[angles.len()..].fill(1.0);
        }
        // Within what keeps the samples regular, so that parameters are seen to be arguments.
        let p = values.iter().map(|value| value * (1.0 + random.uniform(0.0, 0.05)));
        [t].into_iter().chain(y).chain(p).collect()
    });
    let options = |language| EmitOptions::new(language, name);
    let emitted = Emitted::new(equations, options, vec![routine]).unwrap();
    Subject::new(name, derived.program().clone(), emitted, states.collect())
}

/// The subject of a model, made by the claim that asks first.
fn subject(derived: &Derived<'_>) -> Arc<Subject> {
    let mut findings = derived.findings.borrow_mut();
    Arc::clone(findings.subject.get_or_insert_with(|| Arc::new(subject_of(derived))))
}

pub(crate) fn compiled_equations_agree_to_rounding_of_the_largest_term(derived: &Derived<'_>) {
    let subject = subject(derived);
    let found = subject.run(&mut Jit::new(&subject.program).unwrap());
    let worst = subject.assert_rounding(&found, "compiled");
    println!("{}: {worst:.1e} of the largest term", subject.name);
}

pub(crate) fn exactly_compiled_equations_have_the_same_bits(derived: &Derived<'_>) {
    let exact = JitOptions { fma: false, inline_trig: false, ..JitOptions::default() };
    let subject = subject(derived);
    let found = subject.run(&mut Jit::with_options(&subject.program, &exact).unwrap());
    subject.assert_bits(&found, "exactly compiled");
}

/// What emitted source makes of the inputs of each subject; `compile` answers the program.
fn emitted_rates(
    subjects: &[&Subject],
    language: &str,
    compile: impl Fn(&Path, &[Emitted]) -> PathBuf,
) -> Vec<Vec<Vec<f64>>> {
    let directory = fresh_directory(Path::new(env!("CARGO_TARGET_TMPDIR")).join("backends").join(language));
    let sources: Vec<Emitted> = subjects.iter().map(|subject| subject.emitted.clone()).collect();
    let program = compile(&directory, &sources);
    emitted::run(&program, subjects.iter().map(|subject| (&subject.emitted, &subject.inputs[..])))
}

/// Of all built-in models in one program.
pub(crate) fn assert_emitted_c(subjects: &[&Subject]) {
    let found =
        emitted_rates(subjects, "c", |path, sources| emitted::compile_c(path, "gcc", C_FLAGS, sources));
    for (subject, found) in subjects.iter().zip(&found) {
        if SAME_LIBRARY {
            subject.assert_bits(found, "in C");
        } else {
            subject.assert_rounding(found, "in C");
        }
    }
}

/// Of all built-in models in one program.
pub(crate) fn assert_emitted_rust(subjects: &[&Subject]) {
    let found = emitted_rates(subjects, "rust", |path, sources| emitted::compile_rust(path, &[], sources));
    for (subject, found) in subjects.iter().zip(&found) {
        subject.assert_bits(found, "in Rust");
    }
}
