//! `--limit-time` holds for all work of a command.

use std::fmt::Write as _;
use std::fs;
use std::io::Write as _;
use std::process::{Command, Output, Stdio};
use std::time::Instant;

use crate::patience::{ended, started};

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

/// The output of `pc` with a model on standard input.
fn pc(arguments: &[&str], model: &str) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_pc"));
    let command = command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = started(command);
    child.stdin.take().expect("a pipe").write_all(model.as_bytes()).expect("pc reads");
    ended(child)
}

/// What a command says that succeeds, and the seconds that it takes.
#[track_caller]
fn whole(command: impl FnOnce() -> Output) -> (String, f64) {
    let begun = Instant::now();
    let output = command();
    let said = String::from_utf8(output.stderr).expect("text");
    assert_eq!(output.status.code(), Some(0), "{said}");
    (said, begun.elapsed().as_secs_f64())
}

/// Checks that a command was ended by its time limit; returns its messages.
#[track_caller]
fn limited(output: Output, limit: f64) -> String {
    let said = String::from_utf8(output.stderr).expect("text");
    assert_eq!(output.status.code(), Some(4), "{said}");
    assert!(said.contains(&format!("more time would be needed than the limit of {limit} s")), "{said}");
    said
}

/// The parts of the time that the whole took, in milliseconds: one of them ends it midway, on a machine of any speed.
fn parts(whole: f64) -> impl Iterator<Item = f64> {
    (1..=30).map(move |k| (whole * 1000.0 * f64::from(k) / 30.0).ceil() / 1000.0)
}

#[test]
fn a_run_ends_with_the_rows_that_it_reached() {
    let directory = tempfile::tempdir().expect("a directory");
    let table = directory.path().join("rows.csv").display().to_string();
    let ended_at = |limit: f64| {
        // Without --t-end, the limit of steps between rows would end it after some seconds.
        let arguments = ["run", "-", "--limit-time", &limit.to_string(), "-o", &table, "--t-end", "1e7"];
        let said = limited(pc(&arguments, PENDULUM), limit);
        let is_midway = said.contains("ended by its limit at ") && said.contains("pc: ended at t = ");
        is_midway.then(|| fs::read_to_string(&table).expect("rows").lines().count())
    };
    let rows = (-2..8).find_map(|k| ended_at(f64::from(k).exp2()).filter(|&rows| rows > 2));
    let rows = rows.expect("some limit ends it midway");
    assert!((3..2002).contains(&rows), "{rows}");
}

#[test]
fn a_run_with_checkpoints_continues_where_a_limit_ended_it() {
    let directory = tempfile::tempdir().expect("a directory");
    let at = |name: &str| directory.path().join(name).display().to_string();
    let run = |limit: f64, name: &str, more: &[&str]| {
        let limit = limit.to_string();
        let arguments = ["run", "-", "--t-end", "10000", "--limit-time", &limit, "-o", &at(name)];
        pc(&[&arguments[..], more].concat(), PENDULUM)
    };
    let (_, time) = whole(|| run(1e6, "whole.csv", &["--checkpoint", &at("other")]));
    let midway = parts(time).any(|limit| {
        let said = limited(run(limit, "part.csv", &["--checkpoint", &at("kept")]), limit);
        said.contains("the same command with --resume")
    });
    assert!(midway, "some limit ends it midway");
    whole(|| run(1e6, "part.csv", &["--resume", &at("kept"), "--checkpoint", &at("kept")]));
    assert!(fs::read(at("part.csv")).expect("rows") == fs::read(at("whole.csv")).expect("rows"));
}

#[test]
fn a_sweep_ends_as_a_whole_and_continues() {
    let directory = tempfile::tempdir().expect("a directory");
    let at = |name: &str| directory.path().join(name).display().to_string();
    let model = at("model.toml");
    fs::write(&model, PENDULUM).expect("a model");
    let sweep = |limit: f64, name: &str| {
        let (limit, table) = (limit.to_string(), at(name));
        let vary = ["--vary", "g=1:2:60", "--t-end", "4000", "--limit-time", &limit, "-o", &table];
        pc(&[&["sweep", &model], &vary[..]].concat(), "")
    };
    let (_, time) = whole(|| sweep(1e6, "whole.csv"));
    let midway = parts(time).any(|limit| {
        let said = limited(sweep(limit, "part.csv"), limit);
        said.contains("of 60 members: more time") && said.contains("the same command continues")
    });
    assert!(midway, "some limit ends it midway");
    whole(|| sweep(1e6, "part.csv"));
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
