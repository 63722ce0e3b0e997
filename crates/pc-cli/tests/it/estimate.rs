//! `pc run --estimate`: the global errors of the columns, against closed forms; what the summary says of them.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

const OSCILLATOR: &str = "[coordinates]\nx = 1.0\n[lagrangian]\nkinetic = \"x'^2/2\"\npotential = \"x^2/2\"\n\
     [simulation]\nt_end = 100\n";

/// Lorenz' equations, beside a coordinate that rests.
const LORENZ: &str = "[coordinates]\nq = 0.0\n[states]\nx = { start = 1, rate = \"10*(y - x)\" }\n\
     y = { start = 1, rate = \"x*(28 - z) - y\" }\nz = { start = 1, rate = \"x*y - 8*z/3\" }\n\
     [lagrangian]\nkinetic = \"q'^2/2\"\n[simulation]\nt_end = 60\n";

fn pc(directory: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pc")).args(arguments).current_dir(directory).output().unwrap()
}

/// What is said in a run of a model; its files are in the directory.
fn said(directory: &Path, model: &str, arguments: &[&str]) -> String {
    fs::write(directory.join("model.toml"), model).unwrap();
    let output = pc(directory, &[&["run", "model.toml", "--estimate"], arguments].concat());
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(0), "{said}");
    said
}

/// The names of the columns and the rows of a table.
fn table(path: &Path) -> (Vec<String>, Vec<Vec<f64>>) {
    let text = fs::read_to_string(path).unwrap();
    let mut lines = text.lines();
    let names = lines.next().unwrap().split(',').map(str::to_owned).collect();
    let row = |line: &str| line.split(',').map(|number| number.parse().unwrap()).collect();
    (names, lines.map(row).collect())
}

/// The lines of the summary that begin with this one.
fn lines<'s>(said: &'s str, label: &str) -> Vec<&'s str> {
    let from = said.lines().skip_while(|line| !line.trim_start().starts_with(label));
    let is_next = |(i, line): &(usize, &str)| *i == 0 || line.starts_with("       ");
    from.enumerate().take_while(is_next).map(|(_, line)| line.trim()).collect()
}

#[test]
fn each_row_has_the_error_of_each_column() {
    let directory = tempfile::tempdir().unwrap();
    let said = said(directory.path(), OSCILLATOR, &["--rtol", "1e-6", "-o", "run.csv"]);
    let (names, rows) = table(&directory.path().join("run.csv"));
    assert_eq!(names, ["t", "x", "x'", "energy", "error(x)", "error(x')", "error(energy)"]);
    for row in &rows {
        let [t, x, v, energy, of_x, of_v, of_energy] = row[..] else { panic!("{row:?}") };
        for (error, estimate) in [(x - t.cos(), of_x), (v + t.sin(), of_v), (energy - 0.5, of_energy)] {
            // The companion is known to the rounding of some hundred steps.
            assert!((error.abs() - estimate).abs() < 1e-13, "t = {t}: {error:e}, estimated {estimate:e}");
        }
    }
    let errors = lines(&said, "errors");
    let last = rows.last().unwrap();
    assert_eq!(errors[0], format!("errors   x {:.1e}, x' {:.1e}", last[4], last[5]), "{said}");
    assert!(errors[1].starts_with("at t = 100, relative to the motion up to "), "{said}");
    assert!(errors[1].ends_with(", by a companion: Taylor, rtol 1e-16"), "{said}");
    assert_eq!(errors.len(), 2, "{said}");
}

#[test]
fn programs_find_the_errors_of_the_end() {
    let directory = tempfile::tempdir().unwrap();
    said(directory.path(), OSCILLATOR, &["--rtol", "1e-6", "-o", "run.json"]);
    let run: Value =
        serde_json::from_str(&fs::read_to_string(directory.path().join("run.json")).unwrap()).unwrap();
    let errors = &run["summary"]["errors"];
    assert_eq!(errors["companion"]["method"], "taylor");
    assert_eq!((&errors["t"], &errors["grown_from"]), (&Value::from(100.0), &Value::Null));
    let (columns, rows) = (run["columns"].as_array().unwrap(), run["rows"].as_array().unwrap());
    let place = columns.iter().position(|name| name == "error(x')").unwrap();
    assert_eq!(errors["end"]["x'"]["absolute"], rows.last().unwrap()[place]);
}

/// A motion that is not stiff has no steps by other formulas, whose companion would be another.
#[test]
fn stiff_motions_have_a_finer_companion() {
    let directory = tempfile::tempdir().unwrap();
    let output =
        pc(directory.path(), &["run", "stiff-sleigh", "--method", "auto", "--estimate", "-o", "run.csv"]);
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(said.contains("stiffness was seen first at t = "), "{said}");
    assert!(said.contains("by a companion: auto, rtol 1e-12"), "{said}");
}

#[test]
fn an_error_as_large_as_the_motion_is_said() {
    let directory = tempfile::tempdir().unwrap();
    let said = said(directory.path(), LORENZ, &["-o", "run.csv"]);
    // Errors grow by e^0.9t from 1e-9: at t = 15 they have hardly begun, at 45 they have long been there.
    let first = "the error has the size of the motion first at t = ";
    let line = lines(&said, "errors").into_iter().find_map(|line| line.strip_prefix(first));
    let t: f64 = line.expect(&said).parse().unwrap();
    assert!((15.0..45.0).contains(&t), "{said}");
}

/// The ball falls for one time unit, and the rows at t = 1 and 2 have the times of bounces: there the error is that
/// of the reset where only one of both motions has bounced, and then the summary says so.
#[test]
fn rows_at_events_are_named_where_they_differ() {
    let directory = tempfile::tempdir().unwrap();
    let ball = "[coordinates]\ny = 1.0\n[lagrangian]\nkinetic = \"y'^2/2\"\npotential = \"2*y\"\n\
                [events.bounce]\nwhen = \"y\"\ndirection = \"falling\"\nreset = { \"y'\" = \"-0.5*y'\" }\n\
                [simulation]\nt_end = 2.2\nsamples = 12\n";
    let mut named = 0;
    for method in ["auto", "adams", "bdf", "dop853", "taylor"] {
        let said = said(directory.path(), ball, &["--method", method, "-o", "run.csv"]);
        let (_, rows) = table(&directory.path().join("run.csv"));
        let large = rows.iter().filter(|row| row[5] > 0.1).map(|row| row[0].to_string());
        let large: Vec<String> = large.collect();
        let line =
            format!("at t = {} the row is before an event in one of both motions alone", large.join(", "));
        assert_eq!(lines(&said, "errors").contains(&line.as_str()), !large.is_empty(), "{method}: {said}");
        assert!(!said.contains("the size of the motion"), "{said}");
        named += large.len();
    }
    assert!(named > 0, "no method rounds the time of a bounce otherwise than the companion");
}

#[test]
fn derivatives_and_checkpoints_go_with_it() {
    let directory = tempfile::tempdir().unwrap();
    let parametric = OSCILLATOR
        .replace("[coordinates]", "[parameters]\nk = 1.0\n[coordinates]")
        .replace("x^2/2", "k*x^2/2");
    said(directory.path(), &parametric, &["--sensitivities", "k", "-o", "run.csv"]);
    let (names, _) = table(&directory.path().join("run.csv"));
    let expected = ["t", "x", "x'", "energy", "∂x/∂k", "∂x'/∂k", "error(x)", "error(x')", "error(energy)"];
    assert_eq!(names, expected);
    let kept = ["--every", "50", "-o"];
    said(directory.path(), OSCILLATOR, &[&["--checkpoint", "kept"][..], &kept, &["whole.csv"]].concat());
    said(directory.path(), OSCILLATOR, &[&["--resume", "kept"][..], &kept, &["resumed.csv"]].concat());
    let [whole, resumed] =
        ["whole.csv", "resumed.csv"].map(|name| fs::read(directory.path().join(name)).unwrap());
    assert!(whole == resumed, "the errors of a resumed motion are others");
}

#[test]
fn errors_are_drawn_by_decades() {
    let directory = tempfile::tempdir().unwrap();
    said(directory.path(), OSCILLATOR, &["-o", "run.csv", "--plot", "run.svg"]);
    let picture = fs::read_to_string(directory.path().join("run.svg")).unwrap();
    assert!(picture.contains("Estimated errors") && picture.contains("error(x)"));
    said(directory.path(), OSCILLATOR, &["-o", "run.csv", "--plot", "one.svg", "--columns", "error(x)"]);
    let picture = fs::read_to_string(directory.path().join("one.svg")).unwrap();
    assert!(picture.contains("error(x)") && !picture.contains("error(energy)"));
    // Without errors the motion alone is drawn.
    pc(directory.path(), &["run", "model.toml", "-o", "run.csv", "--plot", "none.svg"]);
    assert!(!fs::read_to_string(directory.path().join("none.svg")).unwrap().contains("Estimated errors"));
}

#[test]
fn rows_are_held_in_memory_or_refused() {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("model.toml"), OSCILLATOR).unwrap();
    let arguments =
        ["run", "model.toml", "--rows", "1000000", "-o", "run.csv", "--limit-memory", "64M", "--estimate"];
    let output = pc(directory.path(), &arguments);
    assert_eq!(output.status.code(), Some(4));
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.starts_with("pc: 1000000 rows of "), "{said}");
}
