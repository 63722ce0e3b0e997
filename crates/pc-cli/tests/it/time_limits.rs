//! `--limit-time` holds for all work of a command.

use std::fmt::Write as _;
use std::fs;
use std::io::Write as _;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

/// A pendulum whose motion to `t_end` takes a day, at some hundred thousand swings per second of
/// computing.
const PENDULUM: &str = r#"
[parameters]
g = 9.81
[coordinates]
q = 1.0
[lagrangian]
kinetic = "q'^2/2"
potential = "-g*cos(q)"
[simulation]
t_end = 1e9
samples = 2001
"#;

/// The output of `pc` with a model on standard input, and the time that it takes.
fn pc(arguments: &[&str], model: &str) -> (Output, Duration) {
    let begun = Instant::now();
    let mut command = Command::new(env!("CARGO_BIN_EXE_pc"));
    let command = command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("pc starts");
    child.stdin.take().expect("a pipe").write_all(model.as_bytes()).expect("pc reads");
    (child.wait_with_output().expect("pc ends"), begun.elapsed())
}

/// Checks that a command was ended by its time limit, soon after it; returns its messages.
#[track_caller]
fn limited((output, elapsed): (Output, Duration), limit: f64) -> String {
    let said = String::from_utf8(output.stderr).expect("text");
    assert_eq!(output.status.code(), Some(4), "{said}");
    assert!(said.contains(&format!("more time would be needed than the limit of {limit} s")), "{said}");
    // A busy machine may add seconds.
    assert!(elapsed.as_secs_f64() < limit + 3.0, "{elapsed:?}: {said}");
    said
}

#[test]
fn a_run_ends_with_the_rows_that_it_reached() {
    let directory = tempfile::tempdir().expect("a directory");
    let table = directory.path().join("rows.csv").display().to_string();
    // Without --t-end, the limit of steps between rows would end it after some seconds.
    let said = limited(pc(&["run", "-", "--limit-time", "1", "-o", &table, "--t-end", "1e7"], PENDULUM), 1.0);
    assert!(said.contains("ended by its limit at ") && said.contains("pc: ended at t = "), "{said}");
    let rows = fs::read_to_string(&table).expect("rows").lines().count();
    assert!((2..2002).contains(&rows), "{rows}");
}

#[test]
fn a_run_with_checkpoints_continues_where_a_limit_ended_it() {
    let directory = tempfile::tempdir().expect("a directory");
    let at = |name: &str| directory.path().join(name).display().to_string();
    let run = |limit: &str, name: &str, more: &[&str]| {
        let arguments = ["run", "-", "--t-end", "10000", "--limit-time", limit, "-o", &at(name)];
        pc(&[&arguments[..], more].concat(), PENDULUM)
    };
    let (whole, _) = run("1e6", "whole.csv", &["--checkpoint", &at("other")]);
    assert_eq!(whole.status.code(), Some(0), "{}", String::from_utf8_lossy(&whole.stderr));
    let said = limited(run("0.3", "part.csv", &["--checkpoint", &at("kept")]), 0.3);
    assert!(said.contains("the same command with --resume"), "{said}");
    let (rest, _) = run("1e6", "part.csv", &["--resume", &at("kept"), "--checkpoint", &at("kept")]);
    assert_eq!(rest.status.code(), Some(0), "{}", String::from_utf8_lossy(&rest.stderr));
    assert!(fs::read(at("part.csv")).expect("rows") == fs::read(at("whole.csv")).expect("rows"));
}

#[test]
fn a_sweep_ends_as_a_whole_and_continues() {
    let directory = tempfile::tempdir().expect("a directory");
    let at = |name: &str| directory.path().join(name).display().to_string();
    let model = at("model.toml");
    fs::write(&model, PENDULUM).expect("a model");
    let sweep = |limit: &str, name: &str| {
        let vary = ["--vary", "g=1:2:60", "--t-end", "4000", "--limit-time", limit, "-o", &at(name)];
        pc(&[&["sweep", &model], &vary[..]].concat(), "")
    };
    let said = limited(sweep("0.2", "part.csv"), 0.2);
    assert!(
        said.contains("of 60 members: more time") && said.contains("the same command continues"),
        "{said}"
    );
    for name in ["part.csv", "whole.csv"] {
        let (output, _) = sweep("1e6", name);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    }
    assert!(fs::read(at("part.csv")).expect("rows") == fs::read(at("whole.csv")).expect("rows"));
}

/// The coordinates are all coupled, so the second derivation evaluates thousands of second
/// derivatives at each state.
#[test]
fn a_check_ends_within_the_second_derivation() {
    const N: usize = 120;
    let mut model = "[coordinates]\n".to_owned();
    let all = |term: &dyn Fn(usize) -> String| (0..N).map(term).collect::<Vec<_>>().join(" + ");
    (0..N).for_each(|i| writeln!(model, "x{i} = {}", 0.1 + 0.01 * i as f64).expect("text"));
    write!(
        model,
        "[lagrangian]\nkinetic = \"({})^2/2 + ({})/2\"\npotential = \"{}\"\n",
        all(&|i| format!("x{i}'")),
        all(&|i| format!("x{i}'^2")),
        all(&|i| format!("cos({i}*x{i})*x{}", (i + 1) % N)),
    )
    .expect("text");
    let said = limited(pc(&["check", "-", "--limit-time", "0.5"], &model), 0.5);
    assert!(said.contains("help: raise the limit"), "{said}");
}
