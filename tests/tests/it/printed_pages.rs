//! What `pc derive` prints for programs is read back and computed: it has the values of the equations that are run. (That it has
//! those of the expressions it was written from is a claim of the program `models`.)

use std::collections::HashMap;
use std::fs;
use std::path::Path;

use nalgebra::{DMatrix, DVector};
use pc_mech::{Backend, Graph, VectorField};
use pc_model::{Builtin, Document, Model, Source};
use pc_print::{Form, Layout, Page, page};
use pc_tests::classical::SplitMix64;
use serde_json::Value;

use crate::read_back::{ROUNDING, Read};

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
