//! Emitted C and Rust: compiled without a warning, and run against the interpreter.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Arc, LazyLock};

use pc_expr::{Inputs, Interpreter, Kernel, Program};
use pc_mech::{Backend, EmitOptions, Equations, Expr, Graph, Language, System, VectorField};
use pc_model::{Builtin, Document, Model, Source};
use pc_tests::classical::{MODELS, SplitMix64, sample};
use pc_tests::emitted::{self, Emitted, Routine, execute, fresh_directory, rustc, write_files};
use pc_tests::reference::reference;

/// States tried for each model.
const STATES: usize = 200;

/// On Linux the mathematical library of the compiled source is ours, and results agree to the last bit. Elsewhere its
/// functions may differ by a unit in the last place, which a few hundred roundings of the largest entry allow for; and
/// everywhere the Jacobian may, which, derived once more in the same graph, finds other common factors.
const TOLERANCE: f64 = 1e-13;
const SAME_LIBRARY: bool = cfg!(target_os = "linux");

/// `main` takes 10 000 steps of fourth order: their length is at most 0.002, the motions are of order one.
const MAIN_TOLERANCE: f64 = 1e-8;

const C_FLAGS: &[&str] = &[
    "-std=c99",
    "-O2",
    "-fno-tree-slp-vectorize",
    "-ffp-contract=off",
    "-Wall",
    "-Wextra",
    "-Wpedantic",
    "-Werror",
];
const CXX_FLAGS: &[&str] =
    &["-x", "c++", "-std=c++11", "-O1", "-ffp-contract=off", "-Wall", "-Wextra", "-Wpedantic", "-Werror"];

/// A system as source, with what it has to compute.
struct Case {
    emitted: Emitted,
    /// The names of the state.
    names: Vec<String>,
    /// t, state, parameters
    inputs: Vec<Vec<f64>>,
    /// ydot, mass matrix, energy, integrals; then the Jacobian
    expected: Vec<(Vec<f64>, Vec<f64>)>,
}

impl Case {
    fn new(
        equations: &Equations<'_>,
        options: impl Fn(Language) -> EmitOptions,
        fused: bool,
        states: impl Iterator<Item = (f64, Vec<f64>, Vec<f64>)>,
    ) -> Case {
        let system = equations.system();
        let graph = system.graph();
        let parameters: Vec<Expr<'_>> = system.parameters().iter().map(|&(symbol, _)| symbol).collect();
        let state = system.frame().coordinates().iter().chain(system.quasi_velocities()).copied().collect();
        let inputs = Inputs { time: Some(system.frame().time()), state, parameters };
        let names = inputs.state.iter().map(Expr::to_string).collect();
        let accelerations = equations.accelerations();
        let rates: Vec<_> = system.accelerations().into_iter().zip(accelerations.iter().copied()).collect();
        let integrals: Vec<Expr<'_>> = system.integrals().iter().map(|&(_, value)| value).collect();
        let integrals = graph.substitute(&integrals, &rates);
        let motion: Vec<Expr<'_>> = equations.velocities().iter().chain(&accelerations).copied().collect();
        // Each function of the source is a program of its own: in a common one sums may be parted otherwise.
        let outputs = [&motion[..], &equations.mass_matrix().entries(), &[equations.energy()], &integrals];
        let mut interpreters = outputs.map(|outputs| {
            let program = Program::new(graph, &inputs, outputs).unwrap();
            Interpreter::new(Arc::new(if fused { program.fused() } else { program }))
        });
        let mut motion = equations.compile_for(Backend::Interpreter).unwrap();

        let dimension = inputs.state.len();
        let routine = |name, outputs| Routine { name, outputs };
        let mut routines = vec![
            routine("rhs", Some(dimension)),
            routine("mass_matrix", Some(accelerations.len() * accelerations.len())),
            routine("energy", None),
        ];
        if !integrals.is_empty() {
            routines.push(routine("integrals", Some(integrals.len())));
        }
        routines.push(routine("jacobian", Some(dimension * dimension)));
        let emitted = Emitted::new(equations, |language| options(language).fused(fused), routines).unwrap();
        let mut case = Case { emitted, names, inputs: Vec::new(), expected: Vec::new() };
        for (t, y, p) in states {
            let values = interpreters.iter_mut().flat_map(|interpreter| {
                let mut values = vec![0.0; interpreter.program().outputs_len()];
                interpreter.eval(t, &y, &p, &mut values);
                values
            });
            let values = values.collect();
            let mut jacobian = vec![0.0; y.len() * y.len()];
            motion.parameters_mut().copy_from_slice(&p);
            let _ = motion.jacobian(t, &y, &mut jacobian); // not finite where the state is not
            case.inputs.push([vec![t], y, p].concat());
            case.expected.push((values, jacobian));
        }
        case
    }

    fn builtin(name: &str, states: usize) -> Case {
        Case::of(name, name, false, states)
    }

    fn fused(name: &str, states: usize) -> Case {
        Case::of(name, &format!("{name}-fused"), true, states)
    }

    fn of(name: &str, called: &str, fused: bool, states: usize) -> Case {
        let model = Model::new(Builtin::named(name).unwrap().document().unwrap());
        let graph = Graph::new();
        let assembly = model.assemble(&graph).unwrap_or_else(|e| panic!("{e}"));
        let equations = assembly.equations().unwrap();
        let system = equations.system();
        let state = [system.frame().coordinates(), system.quasi_velocities()].concat();
        let (start, columns) = (assembly.start_of(&state), reference(name).unwrap());
        let title = model.document().model.name.as_ref().map_or(name, |title| &title.value).to_owned();
        let options = |language| {
            let options = EmitOptions::new(language, called).title(&title);
            options.start(assembly.t_start, &start, columns.t_end)
        };
        let mut random = SplitMix64::new(11);
        let states = (0..states).map(|_| {
            let (t, y) = sample(name, &mut random).unwrap();
            // within what keeps the samples regular, so that parameters are seen to be arguments
            let p = model.parameters().map(|(_, value)| value * (1.0 + random.uniform(0.0, 0.05))).collect();
            (t, columns.pick(&state, &y), p)
        });
        Case::new(&equations, options, fused, states)
    }
}

/// Every function of the language, names that no compiler would take, and values that are not numbers.
fn awkward() -> Case {
    let graph = Graph::new();
    let parameters = graph.symbols(["p", "int", "sin", "ε", "DIM", "None", "*/ ??/", "AWKWARD_DIM"]);
    let [p, int, sin, epsilon, dim, none, comment, size] = parameters;
    let mut builder = System::builder(&graph).coordinates(["y", "γ", "gamma", "v1", "t'"]);
    for (i, symbol) in parameters.into_iter().enumerate() {
        builder = builder.parameter(symbol, 0.5 + i as f64);
    }
    let system = builder
        .lagrangian(|_, _, v| {
            (v[0].square() + v[1].square() + v[2].square() + v[3].square() + v[4].square()) / 2.0
        })
        .forces(|t, x, v| {
            let positive = x[0].square() + 1.0;
            let small = x[1].tanh() / 2.0;
            let smooth = small.asin() + small.acos() - x[2].atan() * epsilon - v[1].atan2(x[3]);
            let grown =
                (-positive).exp() - positive.log().sqrt() + positive.pow(sin) + small.sinh() * small.cosh();
            [
                x[0].sign() - x[0].abs() * p,
                x[1].step(x[2], int) - 3.0 * (x[3] - v[2]).step(x[0], -1.5),
                x[2].min(x[3]) + dim * x[0].max(v[3]) - none,
                smooth * size + x[4].sin() * x[4].cos() * t,
                -grown - (-x[0] - v[0]) / (comment + positive),
            ]
        })
        .integral("an \"integral\" ??/ \\", |_, x, v| x[0] * v[1] - x[1] * v[0])
        .build()
        .unwrap();
    let special = [0.0, -0.0, 1.0, -1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, 5e-324];
    let mut random = SplitMix64::new(5);
    let states = (0..300).map(|i| {
        let mut value = |special_too: bool| match random.next_bits() % 4 {
            0 if special_too => special[(random.next_bits() % special.len() as u64) as usize],
            _ => random.normal(),
        };
        let y = (0..10).map(|_| value(i % 2 == 0)).collect();
        (0.5, y, (0..8).map(|_| value(false)).collect())
    });
    let title = "Awkward */ names ??/\n\\";
    Case::new(
        &system.poincare().unwrap(),
        |language| EmitOptions::new(language, "awkward").title(title),
        false,
        states,
    )
}

/// A chain of pendulums, in angles from the vertical: long sums, a full mass matrix.
fn chain(links: usize) -> Case {
    let graph = Graph::new();
    let gravity = graph.symbol("g");
    let names: Vec<String> = (1..=links).map(|i| format!("θ{i}")).collect();
    let system = System::builder(&graph)
        .parameter(gravity, 9.81)
        .coordinates(&names)
        .lagrangian(|_, angle, rate| {
            let [mut right, mut up, mut height] = [Expr::ZERO; 3];
            let moved = angle.iter().zip(rate).map(|(&angle, &rate)| {
                right += angle.cos() * rate;
                up += angle.sin() * rate;
                height -= angle.cos();
                (right.square() + up.square()) / 2.0 - gravity * height
            });
            graph.sum(moved.collect::<Vec<_>>())
        })
        .build()
        .unwrap();
    let mut random = SplitMix64::new(3);
    let states = (0..STATES).map(|_| (0.0, (0..2 * links).map(|_| random.normal()).collect(), vec![9.81]));
    Case::new(&system.poincare().unwrap(), |language| EmitOptions::new(language, "chain"), false, states)
}

/// A fresh directory for files of this test.
fn directory(name: &str) -> PathBuf {
    fresh_directory(Path::new(env!("CARGO_TARGET_TMPDIR")).join("emission").join(name))
}

/// Runs a driver on all inputs and compares what it prints.
fn compare(program: &Path, cases: &[Case], language: &str) {
    let found = emitted::run(program, cases.iter().map(|case| (&case.emitted, &case.inputs[..])));
    for (case, found) in cases.iter().zip(found) {
        for ((inputs, found), (values, jacobian)) in case.inputs.iter().zip(found).zip(&case.expected) {
            let (found_values, found_jacobian) = found.split_at(values.len());
            let blame = |what: &str, i: usize, found: f64, expected: f64| {
                let name = &case.emitted.name;
                panic!("{name} in {language} at {inputs:?}: {what} {i} is {found:e}, not {expected:e}")
            };
            // The sign of zero is not determined where min or max takes one of +0 and −0.
            let same = |a: f64, b: f64| a == b || a.is_nan() && b.is_nan();
            let near = |a: f64, b: f64, all: &[f64]| {
                let size = all.iter().fold(1.0f64, |size, v| size.max(v.abs()));
                (a - b).abs() <= TOLERANCE * size
            };
            for (i, (&f, &e)) in found_values.iter().zip(values).enumerate() {
                if !(same(f, e) || !SAME_LIBRARY && near(f, e, values)) {
                    blame("value", i, f, e);
                }
            }
            let regular = inputs.iter().all(|input| input.abs() < 1e100);
            for (i, (&f, &e)) in found_jacobian.iter().zip(jacobian).enumerate() {
                if regular && !same(f, e) && !near(f, e, jacobian) {
                    blame("entry of the Jacobian", i, f, e);
                }
            }
        }
    }
}

fn sources(cases: &[Case]) -> Vec<Emitted> {
    cases.iter().map(|case| case.emitted.clone()).collect()
}

fn compile_c(compiler: &str, flags: &[&str], cases: &[Case]) -> PathBuf {
    emitted::compile_c(&directory(compiler), compiler, flags, &sources(cases))
}

/// All models and some systems more, derived once for all tests.
static CASES: LazyLock<Vec<Case>> = LazyLock::new(|| {
    let fused = ["heavy-top-euler", "charged-particle-induction"].map(|name| Case::fused(name, STATES));
    MODELS.iter().map(|name| Case::builtin(name, STATES)).chain(fused).chain([awkward(), chain(4)]).collect()
});

/// The case of a model, or of a system by its name.
fn case_of(name: &str) -> &'static Case {
    CASES.iter().find(|case| case.emitted.name == name.replace('-', "_")).unwrap()
}

#[test]
fn emitted_c_computes_what_the_interpreter_does() {
    compare(&compile_c("gcc", C_FLAGS, &CASES), &CASES, "C");
}

#[test]
fn emitted_c_is_cpp() {
    if Command::new("g++").arg("--version").output().is_err() {
        println!("SKIPPED: there is no g++ here, so that emitted C has not been tried as C++");
        return;
    }
    compare(&compile_c("g++", CXX_FLAGS, &CASES), &CASES, "C++");
}

#[test]
fn emitted_rust_computes_what_the_interpreter_does() {
    compare(&emitted::compile_rust(&directory("rustc"), &[], &sources(&CASES)), &CASES, "Rust");
}

/// The crate `libm` as far as it is called, so that the test needs no network.
const LIBM: &str = "
macro_rules! functions {
    ($($name:ident => $method:ident($($more:ident),*);)*) => {
        $(pub fn $name(x: f64 $(, $more: f64)*) -> f64 { x.$method($($more),*) })*
    };
}
functions! {
    sin => sin(); cos => cos(); asin => asin(); acos => acos(); atan => atan(); atan2 => atan2(z);
    sinh => sinh(); cosh => cosh(); tanh => tanh(); exp => exp(); log => ln(); sqrt => sqrt(); fabs => abs();
    pow => powf(y); fma => mul_add(y, z);
}
";

#[test]
fn emitted_rust_needs_no_std() {
    let sources = ["heavy-top-euler", "euler-top", "awkward"].map(|name| case_of(name).emitted.clone());
    let path = directory("no_std");
    write_files(&path, &sources);
    fs::write(path.join("libm.rs"), LIBM).unwrap();
    let modules: String = sources.iter().map(|source| format!("pub mod {};\n", source.name)).collect();
    fs::write(path.join("alone.rs"), format!("#![no_std]\n{modules}")).unwrap();
    let rustc = || {
        let mut command = rustc();
        command.current_dir(&path).args(["--edition=2021", "--crate-type=lib", "-Dwarnings"]);
        command
    };
    execute(rustc().arg("libm.rs"), &[]);
    let cfg = ["--cfg", "feature=\"libm\"", "--extern", "libm=liblibm.rlib", "--emit=metadata"];
    execute(rustc().args(cfg).arg("alone.rs"), &[]);
}

/// The last line of what a `main` prints: t, the state and the energy.
fn last_line(program: &Path) -> Vec<f64> {
    let output = String::from_utf8(execute(&mut Command::new(program), &[])).unwrap();
    output.lines().last().unwrap().split(',').map(|number| number.parse().unwrap()).collect()
}

fn compare_end(name: &str, end: &[f64]) {
    let reference = reference(name).unwrap();
    assert!((end[0] - reference.t_end).abs() < 1e-9, "{name} ends at {}", end[0]);
    let names = &case_of(name).names;
    for (column, expected) in reference.columns.iter().zip(reference.state) {
        let Some(place) = names.iter().position(|name| name == column) else { continue };
        let found = end[1 + place];
        assert!(
            (found - expected).abs() <= MAIN_TOLERANCE,
            "{name}: {column} ends at {found}, not {expected}"
        );
    }
}

/// A stiff model, which an explicit method does not reach the end of, and one whose independent velocities are not
/// determined by the others where cos φ = 0.
const OUT_OF_REACH: [&str; 2] = ["stiff-sleigh", "vertical-disk"];

#[test]
fn main_of_emitted_c_reaches_the_end_time() {
    let path = directory("main_c");
    for &name in MODELS.iter().filter(|name| !OUT_OF_REACH.contains(name)) {
        let source = &case_of(name).emitted;
        write_files(&path, std::slice::from_ref(source));
        let main = format!("-D{}_MAIN", source.name.to_uppercase());
        let file = &source.file(".c").unwrap().name;
        let mut gcc = Command::new("gcc");
        execute(gcc.current_dir(&path).args(C_FLAGS).args([&main, "-o", &source.name, file, "-lm"]), &[]);
        compare_end(name, &last_line(&path.join(&source.name)));
    }
}

#[test]
fn main_of_emitted_rust_reaches_the_end_time() {
    let path = directory("main_rust");
    for name in ["heavy-top-lagrange", "euler-top"] {
        let source = &case_of(name).emitted;
        write_files(&path, std::slice::from_ref(source));
        let flags = ["-O", "--cfg", "pc_main", "-Dwarnings", &source.file(".rs").unwrap().name];
        execute(rustc().current_dir(&path).args(flags), &[]);
        compare_end(name, &last_line(&path.join(&source.name)));
    }
}

#[test]
fn emission_is_deterministic() {
    for name in ["heavy-top-euler", "relativistic-particle"] {
        assert_eq!(Case::builtin(name, 0).emitted.files, case_of(name).emitted.files);
    }
}

#[test]
fn start_states_have_the_length_of_the_state() {
    let model = Model::new(Builtin::named("euler-top").unwrap().document().unwrap());
    let graph = Graph::new();
    let equations = model.assemble(&graph).unwrap().system.poincare().unwrap();
    let options = EmitOptions::new(Language::C, "top").start(0.0, &[1.0], 2.0);
    let message = equations.emit(&options).unwrap_err().to_string();
    assert_eq!(message, "the start state has 1 entries where 3 are needed");
}

/// The Whipple bicycle in independent velocities: its right-hand side to the last bit, and what goes through the table of its
/// operations, the Jacobian, the mass matrix and the energy, to the rounding of some thousand operations.
fn bicycle() -> Case {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("mechanisms/whipple-bicycle.toml");
    let source = Source::new("bicycle", fs::read_to_string(path).unwrap());
    let model = Model::new(Document::parse(source).unwrap());
    let graph = Graph::new();
    let assembly = model.assemble(&graph).unwrap_or_else(|e| panic!("{e}"));
    let equations = assembly.equations().unwrap();
    let start = assembly.start_of(&equations.system().state());
    let options =
        |language| EmitOptions::new(language, "bicycle").title("Whipple bicycle").start(0.0, &start, 1.0);
    let mut random = SplitMix64::new(5);
    let start = start.clone();
    let states = (0..STATES / 4).map(|_| {
        let y = start.iter().map(|y| y + 0.2 * random.uniform(-1.0, 1.0)).collect();
        let p = model.parameters().map(|(_, value)| value * (1.0 + random.uniform(0.0, 0.05))).collect();
        (0.0, y, p)
    });
    Case::new(&equations, options, false, states.collect::<Vec<_>>().into_iter())
}

/// What is found is near what is expected: the rates the same.
fn compare_long(program: &Path, case: &Case, language: &str) {
    let found = emitted::run(program, std::iter::once((&case.emitted, &case.inputs[..])));
    let dimension = case.emitted.routines[0].outputs.unwrap();
    for (found, (values, jacobian)) in found.into_iter().flatten().zip(&case.expected) {
        let (found_values, found_jacobian) = found.split_at(values.len());
        if SAME_LIBRARY {
            assert_eq!(found_values[..dimension], values[..dimension], "the rates in {language}");
        }
        for (found, expected) in [(found_values, values), (found_jacobian, jacobian)] {
            let size = expected.iter().fold(1.0f64, |size, v| size.max(v.abs()));
            for (i, (f, e)) in found.iter().zip(expected).enumerate() {
                assert!((f - e).abs() <= 1e-10 * size, "number {i} in {language} is {f:e}, not {e:e}");
            }
        }
    }
}

#[test]
fn a_bicycle_is_short_source_with_its_jacobian() {
    let case = bicycle();
    for (suffix, most) in [(".c", 150_000), (".rs", 150_000)] {
        let size = case.emitted.file(suffix).unwrap().text.len();
        assert!(size < most, "{suffix} has {size} bytes");
    }
    for file in &case.emitted.files {
        let longest = file.text.lines().map(|line| line.chars().count()).max();
        assert!(longest <= Some(160), "{}: a line of {longest:?} characters", file.name);
    }
    let cases = [case];
    let program = emitted::compile_c(&directory("bicycle-c"), "cc", C_FLAGS, &sources(&cases));
    compare_long(&program, &cases[0], "C");
    let program = emitted::compile_rust(&directory("bicycle-rust"), &[], &sources(&cases));
    compare_long(&program, &cases[0], "Rust");
}

#[test]
fn a_jacobian_is_left_out_on_request() {
    let model = Model::new(Builtin::named("heavy-top-euler").unwrap().document().unwrap());
    let graph = Graph::new();
    let equations = model.assemble(&graph).unwrap().equations().unwrap();
    for language in [Language::C, Language::Rust] {
        for (jacobian, there) in [(true, true), (false, false)] {
            let files = equations.emit(&EmitOptions::new(language, "top").jacobian(jacobian)).unwrap();
            assert!(files.iter().all(|file| file.text.contains("jacobian(") == there), "{language:?}");
        }
    }
}

/// Thirty masses, on each of which all functions that have a rule of differentiation act.
fn long() -> Case {
    const MASSES: usize = 30;
    let graph = Graph::new();
    let names: Vec<String> = (0..MASSES).map(|i| format!("x{i}")).collect();
    let k = graph.symbol("k");
    let system = System::builder(&graph)
        .coordinates(&names)
        .parameter(k, 0.7)
        .lagrangian(|_, x, v| {
            let kinetic = v.iter().zip(x).map(|(&v, &x)| (2.0 + x.cos()) * v.square() / 2.0);
            graph.sum(kinetic.collect::<Vec<_>>())
        })
        .forces(|_, x, v| {
            let of = |i: usize, j: usize| (x[(i + j) % MASSES] + k * v[(i + 2 * j) % MASSES]) / 9.0;
            (0..MASSES)
                .map(|i| {
                    let smooth =
                        [of(i, 1).sin(), of(i, 2).cos(), of(i, 3).asin(), of(i, 4).acos(), of(i, 5).atan()];
                    let hyperbolic = [of(i, 6).sinh(), of(i, 7).cosh(), of(i, 8).tanh(), of(i, 9).exp()];
                    let others =
                        [(of(i, 10).square() + 1.0).log(), (of(i, 11).square() + 2.0).sqrt(), -of(i, 12)];
                    graph.sum(smooth.into_iter().chain(hyperbolic).chain(others).collect::<Vec<_>>())
                })
                .collect::<Vec<_>>()
        })
        .build()
        .unwrap();
    let mut random = SplitMix64::new(8);
    let states: Vec<_> = (0..STATES / 4)
        .map(|_| (0.0, (0..2 * MASSES).map(|_| random.uniform(-2.0, 2.0)).collect(), vec![0.7]))
        .collect();
    Case::new(
        &system.poincare().unwrap(),
        |language| EmitOptions::new(language, "masses"),
        false,
        states.into_iter(),
    )
}

#[test]
fn the_chain_rule_has_a_rule_for_each_function() {
    let cases = [long()];
    assert!(cases[0].emitted.file(".c").unwrap().text.contains("masses_code[]"), "it goes through a table");
    let program = emitted::compile_c(&directory("long-c"), "cc", C_FLAGS, &sources(&cases));
    compare_long(&program, &cases[0], "C");
    let program = emitted::compile_rust(&directory("long-rust"), &[], &sources(&cases));
    compare_long(&program, &cases[0], "Rust");
}
