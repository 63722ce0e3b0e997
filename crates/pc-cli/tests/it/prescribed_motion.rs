//! Motions prescribed by tables: of constraints, of supports, in kinetic energies; with the rates of the tables.

use std::process::{Command, Output};

use serde_json::Value;

fn pc(text: &str, options: &[&str]) -> (Output, Option<Value>) {
    let directory = tempfile::tempdir().unwrap();
    let (model, result) = (directory.path().join("m.toml"), directory.path().join("run.json"));
    std::fs::write(&model, text).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_pc"));
    let output = command.arg("run").arg(&model).arg("-o").arg(&result).args(options).output().unwrap();
    (output, std::fs::read(&result).ok().map(|bytes| serde_json::from_slice(&bytes).unwrap()))
}

/// The table of a run that the second derivation confirms.
fn run(text: &str) -> Value {
    let (output, result) = pc(text, &[]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && said.contains("verified by a second derivation"), "{said}\n{text}");
    result.unwrap()
}

/// The rows of the columns t and `names`.
fn columns<const N: usize>(run: &Value, names: [&str; N]) -> Vec<(f64, [f64; N])> {
    let all = run["columns"].as_array().unwrap();
    let places = names.map(|name| all.iter().position(|known| known == name).unwrap());
    let row = |row: &Value| (row[0].as_f64().unwrap(), places.map(|place| row[place].as_f64().unwrap()));
    run["rows"].as_array().unwrap().iter().map(row).collect()
}

/// A table of f with f' and f'' at some times, as entries of an input.
fn quintic(times: &[f64], f: impl Fn(f64) -> [f64; 3]) -> String {
    let list = |k: usize| times.iter().map(|&t| f(t)[k]).collect::<Vec<_>>();
    let [values, rates, accelerations] = [0, 1, 2].map(list);
    format!(
        "{{ times = {times:?}, values = {values:?}, rates = {rates:?}, accelerations = {accelerations:?}, \
         interpolation = \"quintic\" }}"
    )
}

/// A cam moves x = t³ and drags a spring whose end moves with it: ÿ = −6t − 4y, and λ = ẍ = 6t.
#[test]
fn a_cam_moves_a_coordinate_by_a_constraint() {
    let text = "[inputs]\n\
        cam = { times = [0, 1, 2, 3, 4], values = [0, 1, 8, 27, 64], interpolation = \"cubic\" }\n\
        [coordinates]\nx = 0.0\ny = 0.0\n\
        [lagrangian]\nkinetic = \"(x'^2 + (y' + cam')^2)/2\"\npotential = \"2*y^2\"\n\
        [constraints]\nfollows = \"x - cam\"\n\
        [outputs]\nforce = \"λ_follows\"\nacceleration = \"d(d(cam))\"\n\
        [simulation]\nt_end = 4.0\nsamples = 17\n";
    for (t, [x, y, rate, force, acceleration]) in
        columns(&run(text), ["x", "y", "x'", "force", "acceleration"])
    {
        let known = 0.75 * (2.0 * t).sin() - 1.5 * t;
        // x and λ by the table, a cubic in one piece but for rounding; y to the tolerance of a run.
        assert!((x - t.powi(3)).abs() < 1e-11 && (rate - 3.0 * t * t).abs() < 1e-11, "{t}: {x} {rate}");
        assert!((force - 6.0 * t).abs() < 1e-10 && (acceleration - 6.0 * t).abs() < 1e-10, "{t}: {force}");
        assert!((y - known).abs() < 1e-7, "{t}: {y}, not {known}");
    }
}

/// A pendulum whose support is moved by a table against the same one moved by a formula, which is a polynomial of the
/// degree of the table's pieces.
#[test]
fn a_support_moves_by_a_table() {
    let f = |t: f64| [0.1 * t.powi(5) - 0.2 * t * t, 0.5 * t.powi(4) - 0.4 * t, 2.0 * t.powi(3) - 0.4];
    let text = |inputs: &str, support: &str| {
        format!(
            "{inputs}[coordinates]\nθ = 0.3\n\
             [bodies.bob]\nmass = 1.0\nposition = [\"{support} + 0.5*sin(θ)\", 0, \"-0.5*cos(θ) + 0.3*({support})^2\"]\n\
             [gravity]\nacceleration = [0, 0, -9.81]\n[simulation]\nt_end = 1.5\nsamples = 31\n"
        )
        .replace("θ", "\"θ\"")
        .replace("(\"θ\")", "(θ)")
    };
    let table = quintic(&[0.0, 0.4, 1.0, 1.5], f);
    let by_table = run(&text(&format!("[inputs]\nroad = {table}\n"), "road"));
    let by_formula = run(&text("", "(0.1*t^5 - 0.2*t^2)"));
    let known = columns(&by_formula, ["θ", "θ'"]);
    for ((t, found), (_, known)) in columns(&by_table, ["θ", "θ'"]).into_iter().zip(known) {
        let apart = (found[0] - known[0]).abs().max((found[1] - known[1]).abs());
        assert!(apart < 1e-7, "at {t}: {found:?}, not {known:?}"); // the tolerances of two runs are 1e-9
    }
}

/// Rates at the times make each cubic that of Hermite: it moves with corners in its acceleration, which both sides of a
/// knot see.
#[test]
fn accelerations_of_cubics_may_jump() {
    let text = "[inputs]\n\
        slide = { times = [0, 1, 2], values = [0, 1, 1], rates = [0, 0, 0], interpolation = \"cubic\" }\n\
        [coordinates]\ny = 0.0\n[lagrangian]\nkinetic = \"(y' + slide')^2/2\"\n\
        [simulation]\nt_end = 2.0\nsamples = 9\n";
    // y' + slide' is constant: y = −slide.
    for (t, [y]) in columns(&run(text), ["y"]) {
        let slide = if t < 1.0 { t * t * (3.0 - 2.0 * t) } else { 1.0 };
        assert!((y + slide).abs() < 1e-9, "{t}: {y}");
    }
}

#[test]
fn rates_of_corners_are_refused() {
    let text = |table: &str| {
        format!(
            "[inputs]\nroad = {table}\n[coordinates]\nx = 0.0\ny = 0.0\n\
             [lagrangian]\nkinetic = \"(x'^2 + y'^2)/2\"\n[constraints]\nfollows = \"x - road\"\n\
             [simulation]\nt_end = 1.0\n"
        )
    };
    let said = |table: &str| {
        let (output, _) = pc(&text(table), &[]);
        assert_eq!(output.status.code(), Some(3), "{table}");
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        said[said.find("m.toml").unwrap()..].to_owned()
    };
    let tables = [
        "{ times = [0, 1], values = [0, 1] }",
        "{ times = [0, 1], values = [0, 1], rates = [0, 0] }",
        "{ times = [0, 1], values = [0, 1], rates = [0], interpolation = \"cubic\" }",
        "{ times = [0, 1], values = [0, 1], rates = [0, 0], interpolation = \"quintic\" }",
        "0.5",
    ];
    insta::assert_snapshot!(tables.map(said).join("\n"));
}
