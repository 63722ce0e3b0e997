//! What `pc derive` prints for programs is read back and computed: it has the values of the expressions it was written from,
//! and of the equations that are run.

use std::collections::HashMap;
use std::fs;
use std::path::Path;

use nalgebra::{DMatrix, DVector};
use pc_expr::parse::{Ast, AstKind, Factor, Sign, parse};
use pc_expr::{Folding, Function};
use pc_mech::{Backend, Graph, VectorField};
use pc_model::{BUILTIN, Builtin, Document, Model, Source};
use pc_print::{Balance, Derived, Form, Layout, Page, Sheet, page};
use pc_tests::classical::SplitMix64;
use serde_json::Value;

/// A number with the size of what was summed and multiplied on the way to it, in its units.
#[derive(Clone, Copy, Debug)]
struct Sized {
    value: f64,
    size: f64,
}

impl Sized {
    fn of(value: f64) -> Sized {
        Sized { value, size: value.abs() }
    }
}

/// The value of a syntax tree.
fn value(ast: &Ast, names: &HashMap<String, Sized>) -> Sized {
    let of = |ast: &Ast| value(ast, names);
    match &ast.kind {
        AstKind::Number(x) => Sized::of(*x),
        AstKind::Name(name) => *names.get(name).unwrap_or_else(|| panic!("`{name}` is not known")),
        AstKind::Velocity(name) => {
            *names.get(&format!("{name}'")).unwrap_or_else(|| panic!("{name}' is not known"))
        }
        AstKind::Negate(x) => {
            let x = of(x);
            Sized { value: -x.value, size: x.size }
        }
        AstKind::Sum(terms) => terms.iter().fold(Sized::of(0.0), |sum, (sign, term)| {
            let (term, sign) = (of(term), if *sign == Sign::Plus { 1.0 } else { -1.0 });
            Sized { value: sum.value + sign * term.value, size: sum.size + term.size }
        }),
        AstKind::Product(factors) => factors.iter().fold(Sized::of(1.0), |product, (side, factor)| {
            let x = of(factor);
            let factor = match side {
                Factor::Times => x,
                Factor::Over => Sized { value: 1.0 / x.value, size: x.size / (x.value * x.value) },
            };
            let size = product.size * factor.value.abs() + product.value.abs() * factor.size;
            Sized { value: product.value * factor.value, size }
        }),
        AstKind::Power(base, exponent) => call(Function::Pow, &[of(base), of(exponent)]),
        AstKind::Call(function, _, arguments) => {
            let function = Function::ALL.into_iter().find(|f| f.name() == function).unwrap();
            call(function, &arguments.iter().map(of).collect::<Vec<_>>())
        }
        AstKind::TotalDerivative(x) => match &x.kind {
            AstKind::Velocity(name) => {
                *names.get(&format!("{name}''")).unwrap_or_else(|| panic!("d({name}') is not known"))
            }
            other => panic!("d({other:?}) is no acceleration"),
        },
    }
}

fn call(function: Function, arguments: &[Sized]) -> Sized {
    let values: Vec<f64> = arguments.iter().map(|x| x.value).collect();
    let value = function.eval(&values);
    let slopes = (0..values.len()).map(|i| {
        let (mut aside, step) = (values.clone(), 1e-6 * (1.0 + values[i].abs()));
        aside[i] += step;
        let slope = (function.eval(&aside) - value) / step;
        if slope.is_finite() { slope.abs() * arguments[i].size } else { 0.0 }
    });
    Sized { value, size: value.abs() + slopes.sum::<f64>() }
}

/// A page for programs with the values of its symbols.
struct Read {
    object: Value,
    names: HashMap<String, Sized>,
}

impl Read {
    /// The page where symbols have these values.
    fn at(object: &Value, symbols: &[(String, f64)]) -> Read {
        let names = symbols.iter().map(|(name, value)| (name.clone(), Sized::of(*value))).collect();
        let mut read = Read { object: object.clone(), names };
        for definition in object["definitions"].as_array().into_iter().flatten() {
            let text = definition["value"].as_str().unwrap();
            let value = read.text(text);
            read.names.insert(definition["name"].as_str().unwrap().to_owned(), value);
        }
        read
    }

    fn text(&self, text: &str) -> Sized {
        value(&parse(text).unwrap_or_else(|error| panic!("{text}: {error}")), &self.names)
    }

    fn list(&self, key: &str) -> Vec<Sized> {
        fn leaves(value: &Value, out: &mut Vec<String>) {
            match value {
                Value::Array(list) => list.iter().for_each(|value| leaves(value, out)),
                value => out.push(value.as_str().unwrap().to_owned()),
            }
        }
        let mut texts = Vec::new();
        leaves(&self.object[key], &mut texts);
        texts.iter().map(|text| self.text(text)).collect()
    }
}

const FORMS: [Form; 4] = [Form::Poincare, Form::Canonical, Form::Lagrange, Form::Voronets];
/// Two ways to round a sum of products: some units in the last place of the largest that was computed on the way.
const ROUNDING: f64 = 1e-12;

fn assert_close(read: &[Sized], written: &[f64], what: &str) {
    assert_eq!(read.len(), written.len(), "{what}");
    for (i, (read, written)) in read.iter().zip(written).enumerate() {
        let same = (read.value - written).abs() <= ROUNDING * read.size.max(written.abs());
        assert!(same || !written.is_finite(), "{what} {i}: read {read:?}, written from {written}");
    }
}

/// Compares each text of a form's page with the expression it was written from, at random places around the start.
fn compare(name: &str, model: &Model, form: Form, states: usize) -> bool {
    let graph = Graph::new();
    let assembly = model.assemble(&graph).unwrap_or_else(|error| panic!("{name}: {error}"));
    let Ok((_, derived)) = Derived::new(form, &assembly) else { return false };
    let paper = graph.page(Folding::Structural);
    let sheet = if form == Form::Canonical {
        let Ok(equations) = assembly.free_system().unwrap().canonical() else { return false };
        Sheet::of_momenta(&assembly, &derived, &equations, &paper)
    } else {
        Sheet::of_velocities(&assembly, &derived, &paper)
    };
    // In a graph of its own, as the program has it: what was made before may be a shorter form of what is made now.
    let other = Graph::new();
    let anew = model.assemble(&other).unwrap();
    let printed = page(form, Page::Json, &Layout::default(), name, &anew).unwrap();
    assert!(!printed.contains('…'), "{name}: something is left out");
    let object: Value = serde_json::from_str(&printed).unwrap();
    let (names, expressions) = match &sheet.balance {
        Balance::Velocities { mass, right, .. } => {
            (vec!["mass_matrix", "equations"], vec![mass.entries().into_owned(), right.clone()])
        }
        Balance::Momenta { of_velocities, right, .. } => {
            (vec!["momenta_of_velocities", "equations"], vec![of_velocities.clone(), right.clone()])
        }
    };
    let energy = if form == Form::Canonical { "hamiltonian" } else { "energy" };
    let mut everything = expressions.concat();
    everything.push(sheet.energy);
    everything.extend(sheet.reactions.iter().map(|&(_, value)| value));
    everything.extend(sheet.constraints.iter().map(|&(_, left, _)| left));
    everything.extend(sheet.frame.0.nonzero_entries().into_iter().chain(sheet.frame.1.clone()));
    everything
        .extend(sheet.brackets.nonzero.iter().flat_map(|bracket| bracket.components.iter().map(|&(_, c)| c)));
    everything.extend(sheet.rates.iter().chain(&sheet.states).map(|&(_, value)| value));
    everything.extend(sheet.definitions.iter().map(|given| given.value));
    let known: HashMap<String, f64> = assembly
        .at_start()
        .into_iter()
        .chain(assembly.system.parameters().iter().copied())
        .map(|(symbol, value)| (symbol.to_string(), value))
        .collect();
    let parameters: Vec<String> = sheet.parameters.iter().map(|(name, _)| name.clone()).collect();
    let symbols = paper.symbols_of(&everything);
    let mut random = SplitMix64::new(11);
    for _ in 0..states {
        let at: Vec<_> = symbols
            .iter()
            .map(|&symbol| {
                let name = symbol.symbol_name().unwrap();
                let start = known.get(&name).copied().unwrap_or(0.3);
                let moved =
                    if parameters.contains(&name) { start } else { start + random.uniform(-0.2, 0.2) };
                (symbol, moved)
            })
            .collect();
        let named: Vec<(String, f64)> =
            at.iter().map(|(symbol, value)| (symbol.to_string(), *value)).collect();
        let read = Read::at(&object, &named);
        for (key, list) in names.iter().zip(&expressions) {
            assert_close(
                &read.list(key),
                &paper.evaluate(list, &at).unwrap(),
                &format!("{name}, {form:?}, {key}"),
            );
        }
        let value = paper.evaluate(&[sheet.energy], &at).unwrap();
        assert_close(
            &[read.text(object[energy].as_str().unwrap())],
            &value,
            &format!("{name}, {form:?}, {energy}"),
        );
        for (reaction, value) in &sheet.reactions {
            let text = object["reactions"][reaction.to_string()].as_str().unwrap();
            let value = paper.evaluate(&[*value], &at).unwrap();
            assert_close(&[read.text(text)], &value, &format!("{name}, {form:?}, {reaction}"));
        }
    }
    true
}

fn mechanisms() -> Vec<(String, Model)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("mechanisms");
    let mut files: Vec<_> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    let model = |path: std::path::PathBuf| {
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        let document = Document::parse(Source::new(&name, fs::read_to_string(&path).unwrap())).unwrap();
        (name, Model::new(document))
    };
    files.into_iter().map(model).collect()
}

#[test]
fn pages_of_built_in_models_agree_with_their_equations() {
    let mut compared = 0;
    for builtin in BUILTIN {
        let model = Model::new(builtin.document().unwrap());
        compared += FORMS.iter().filter(|&&form| compare(builtin.name, &model, form, 20)).count();
    }
    assert!(compared >= 3 * BUILTIN.len(), "{compared} pages");
}

#[test]
fn pages_of_mechanisms_agree_with_their_equations() {
    for (name, model) in mechanisms() {
        for form in FORMS {
            assert!(compare(&name, &model, form, 20), "{name} has no form {form:?}");
        }
    }
}

/// M η̇ = r as it is read back has the accelerations of the run, at 1000 states of each mechanism.
#[test]
fn accelerations_that_are_read_back_are_those_of_the_run() {
    for (name, model) in mechanisms() {
        let graph = Graph::new();
        let assembly = model.assemble(&graph).unwrap();
        let printed = page(Form::Poincare, Page::Json, &Layout::default(), &name, &assembly).unwrap();
        let object: Value = serde_json::from_str(&printed).unwrap();
        let equations = assembly.equations().unwrap();
        let mut motion = equations.compile_for(Backend::default()).unwrap();
        let system = equations.system();
        let state = system.state();
        let (names, start) = (motion.names().to_vec(), assembly.start_of(&state));
        let k = system.quasi_velocities().len();
        let mut random = SplitMix64::new(5);
        for _ in 0..1000 {
            let y: Vec<f64> = start.iter().map(|x| x + random.uniform(-0.1, 0.1)).collect();
            let mut rates = vec![0.0; y.len()];
            if motion.rhs(assembly.t_start, &y, &mut rates).is_err() {
                continue;
            }
            let parameters = system.parameters().iter().map(|(symbol, value)| (symbol.to_string(), *value));
            let mut symbols: Vec<(String, f64)> = names.iter().cloned().zip(y).chain(parameters).collect();
            symbols.push(("t".to_owned(), assembly.t_start));
            // Constraints and reactions, and their definitions, may have rates in them that are not read here. A rate that is itself
            // a component of the state has its value.
            let rates_of = names
                .iter()
                .chain(assembly.system.state().iter().map(ToString::to_string).collect::<Vec<_>>().iter())
                .map(|name| (format!("{name}'"), 0.0))
                .filter(|(rate, _)| !names.contains(rate))
                .collect::<Vec<_>>();
            symbols.extend(rates_of);
            let read = Read::at(&object, &symbols);
            let (mass, right) = (read.list("mass_matrix"), read.list("equations"));
            let matrix = DMatrix::from_fn(k, k, |r, s| mass[r * k + s].value);
            let vector = DVector::from_iterator(k, right.iter().map(|r| r.value));
            let scale = right.iter().fold(1.0f64, |size, r| size.max(r.size));
            let inverse = matrix.clone().try_inverse().unwrap();
            let solved = matrix.lu().solve(&vector).unwrap();
            let n = system.frame().coordinates().len();
            for s in 0..k {
                let difference = (solved[s] - rates[n + s]).abs();
                // What is summed on the right, rounded in another order, and its effect through M⁻¹.
                let allowed = ROUNDING * (scale * inverse.norm()).max(rates[n + s].abs());
                assert!(
                    difference <= allowed,
                    "{name}: {} is {}, read back {}",
                    names[n + s],
                    rates[n + s],
                    solved[s]
                );
            }
        }
    }
}

type Vector = [f64; 3];

fn cross(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3])
}

fn plus(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|i| a[i] + b[i])
}

fn times(factor: f64, a: Vector) -> Vector {
    a.map(|a| factor * a)
}

fn dot(a: Vector, b: Vector) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

/// A v, or with `transposed` Aᵀ v.
fn apply(a: &[f64], v: Vector, transposed: bool) -> Vector {
    let entry = |i: usize, j: usize| if transposed { a[3 * j + i] } else { a[3 * i + j] };
    std::array::from_fn(|i| (0..3).map(|j| entry(i, j) * v[j]).sum())
}

/// A body of a page with numbers.
struct Printed {
    parent: Option<usize>,
    rotation: Vec<f64>,
    inertia: Vec<f64>,
    mass: f64,
    vectors: HashMap<&'static str, Vector>,
    forces: Vec<(String, f64)>,
}

fn printed_body(body: &Value, names: &[String], read: &Read) -> Printed {
    let number = |value: &Value| read.text(value.as_str().unwrap()).value;
    let rows = |key: &str| {
        let rows = body[key].as_array().unwrap().iter();
        rows.flat_map(|row| row.as_array().unwrap()).map(number).collect()
    };
    let vector = |key: &str| -> Vector { std::array::from_fn(|i| number(&body[key][i])) };
    let keys = ["place", "angular_velocity", "velocity", "center", "force", "torque"];
    Printed {
        parent: names.iter().position(|name| name == body["parent"].as_str().unwrap()),
        rotation: rows("rotation"),
        inertia: rows("inertia"),
        mass: number(&body["mass"]),
        vectors: keys.into_iter().map(|key| (key, vector(key))).collect(),
        forces: body["forces"].as_object().unwrap().iter().map(|(eta, q)| (eta.clone(), number(q))).collect(),
    }
}

/// The laws of the page of a large tree, gone through with its numbers, hold for the accelerations of the run.
#[test]
fn pages_of_trees_hold_for_the_accelerations_of_the_run() {
    let mut random = SplitMix64::new(20);
    for name in ["quadruped", "satellite", "spatial-chain"] {
        let model = Model::new(Builtin::named(name).unwrap().document().unwrap());
        let graph = model.graph();
        let assembly = model.assemble(&graph).unwrap();
        let object: Value = serde_json::from_str(
            &page(Form::Poincare, Page::Json, &Layout::default(), name, &assembly).unwrap(),
        )
        .unwrap();
        let system = &assembly.system;
        let symbols: Vec<String> = system.state().iter().map(ToString::to_string).collect();
        let (mut motion, start) = model.compile(&assembly).unwrap();
        let y: Vec<f64> = start
            .iter()
            .map(|y| if *y == 0.0 || *y == 1.0 { *y } else { y + random.uniform(-0.1, 0.1) })
            .collect();
        let n = motion.coordinates();
        let y: Vec<f64> = y
            .iter()
            .enumerate()
            .map(|(i, y)| if i >= n { y + random.uniform(-1.0, 1.0) } else { *y })
            .collect();
        let mut rates = vec![0.0; y.len()];
        motion.rhs(0.0, &y, &mut rates).unwrap();
        let read_with = |state: &[f64]| {
            let parameters = object["parameters"].as_object().unwrap().iter();
            let parameters = parameters.map(|(name, value)| (name.clone(), value.as_f64().unwrap()));
            let at = symbols.iter().cloned().zip(state.iter().copied()).chain(parameters);
            Read::at(&object, &at.chain([("t".to_owned(), 0.0)]).collect::<Vec<_>>())
        };
        let read_at =
            |h: f64| read_with(&y.iter().zip(&rates).map(|(y, rate)| y + h * rate).collect::<Vec<_>>());
        let list = object["bodies"].as_array().unwrap();
        let names: Vec<String> = list.iter().map(|body| body["name"].as_str().unwrap().to_owned()).collect();
        let bodies_at = |h: f64| -> Vec<Printed> {
            let read = read_at(h);
            list.iter().map(|body| printed_body(body, &names, &read)).collect()
        };
        // Velocities against the parent, and their rates by a difference that is good for nine digits.
        let step = 1e-5;
        let (before, bodies, after) = (bodies_at(-step), bodies_at(0.0), bodies_at(step));
        let rate = |i: usize, key: &str| {
            times(0.5 / step, plus(after[i].vectors[key], times(-1.0, before[i].vectors[key])))
        };
        let gravity: Vector = {
            let read = read_at(0.0);
            std::array::from_fn(|i| read.text(object["gravity"][i].as_str().unwrap()).value)
        };
        let zero = [0.0; 3];
        let unit = vec![1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        // W, ω, α, a
        let mut moved: Vec<(Vec<f64>, Vector, Vector, Vector)> = Vec::new();
        for (i, body) in bodies.iter().enumerate() {
            let world = (unit.clone(), zero, zero, times(-1.0, gravity));
            let (w_p, omega_p, alpha_p, a_p) = body.parent.map_or(&world, |parent| &moved[parent]).clone();
            let (r, omega_r, v_r) =
                (body.vectors["place"], body.vectors["angular_velocity"], body.vectors["velocity"]);
            let back = |v: Vector| apply(&body.rotation, v, true);
            let omega = plus(back(omega_p), omega_r);
            let alpha = plus(plus(back(alpha_p), cross(omega, omega_r)), rate(i, "angular_velocity"));
            let carried = plus(plus(a_p, cross(alpha_p, r)), cross(omega_p, cross(omega_p, r)));
            let coriolis = cross(plus(times(2.0, omega), times(-1.0, omega_r)), v_r);
            let a = plus(plus(back(carried), coriolis), rate(i, "velocity"));
            let w = (0..9).map(|k| (0..3).map(|j| w_p[3 * (k / 3) + j] * body.rotation[3 * j + k % 3]).sum());
            moved.push((w.collect(), omega, alpha, a));
        }
        let mut borne: Vec<(Vector, Vector)> = vec![(zero, zero); bodies.len()];
        for (i, body) in bodies.iter().enumerate().rev() {
            let (w, omega, alpha, a) = moved[i].clone();
            let c = body.vectors["center"];
            let of_centre = plus(plus(a, cross(alpha, c)), cross(omega, cross(omega, c)));
            let force = apply(&w, body.vectors["force"], true);
            let f = plus(times(body.mass, of_centre), times(-1.0, force));
            let spin =
                plus(apply(&body.inertia, alpha, false), cross(omega, apply(&body.inertia, omega, false)));
            let n = plus(plus(spin, cross(c, f)), times(-1.0, body.vectors["torque"]));
            borne[i] = (plus(borne[i].0, n), plus(borne[i].1, f));
            if let Some(parent) = body.parent {
                let f = apply(&body.rotation, borne[i].1, false);
                let n = plus(apply(&body.rotation, borne[i].0, false), cross(body.vectors["place"], f));
                borne[parent] = (plus(borne[parent].0, n), plus(borne[parent].1, f));
            }
        }
        // ∂ω_r/∂η and ∂v_r/∂η: both are linear in η.
        for (i, body) in bodies.iter().enumerate() {
            for (eta, force) in &body.forces {
                let one = |(k, y): (usize, &f64)| match k < n {
                    true => *y,
                    false => f64::from(symbols[k] == *eta),
                };
                let state: Vec<f64> = y.iter().enumerate().map(one).collect();
                let alone = printed_body(&list[i], &names, &read_with(&state));
                let (n_i, f_i) = borne[i];
                let taken = dot(n_i, alone.vectors["angular_velocity"]) + dot(f_i, alone.vectors["velocity"]);
                let size = 1.0 + dot(n_i, n_i).sqrt() + dot(f_i, f_i).sqrt();
                assert!((taken - force).abs() < 1e-7 * size, "{name}, {eta}: {taken}, not {force}");
            }
        }
    }
}
