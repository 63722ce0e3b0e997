//! Messages on motions that slide where a force jumps, on numbers that are not finite, and on work
//! that is too large.

use std::io::Write;
use std::process::{Command, Stdio};

/// The exit code and standard error.
fn said(arguments: &[&str], model: &str) -> (Option<i32>, String) {
    let mut child = Command::new(env!("CARGO_BIN_EXE_pc"))
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("pc starts");
    // A refused command line leaves the input unread.
    let _ = child.stdin.take().expect("a pipe").write_all(model.as_bytes());
    let output = child.wait_with_output().expect("pc ends");
    (output.status.code(), String::from_utf8(output.stderr).expect("UTF-8"))
}

/// A block on a plane, in x and v = x'.
fn block(more: &str) -> String {
    format!(
        "[coordinates]\nx = -0.5\n[quasi_velocities]\nv = 1.0\n[kinematics]\nx = \"v\"\n\
         [lagrangian]\nkinetic = \"v^2/2\"\n{more}\n[simulation]\nt_end = 4.0\nsamples = 9\n"
    )
}

/// The block stops at t = 2 and stays; the summary says so.
#[test]
fn dry_friction_holds() {
    let (code, said) = said(&["run", "-"], &block("[forces]\nv = \"-sign(v)/2\""));
    assert_eq!(code, Some(0), "{said}");
    let line = said.lines().find(|line| line.contains("slides")).unwrap_or_default();
    assert_eq!(line, "  slides   along v = 0 from 2 on", "{said}");
}

#[test]
fn values_that_are_not_finite_are_named() {
    let (code, said) = said(&["run", "-"], &block("[outputs]\nlg = \"log(1.25 - x)\""));
    assert_eq!(code, Some(0));
    let line = said.lines().find(|line| line.contains("values")).unwrap_or_default();
    // x = t − 1/2 passes 5/4 at t = 7/4
    assert_eq!(line, "  values   lg is NaN at t = 2, not finite in 5 of 9 rows", "{said}");
}

/// The same message for rows that are written as they are computed, because they exceed the memory
/// limit.
#[test]
fn values_of_rows_that_are_not_held_are_named() {
    let directory = tempfile::tempdir().expect("a directory");
    let output = directory.path().join("rows.csv").display().to_string();
    let model = block("[outputs]\nlg = \"log(1.25 - x)\"").replace("samples = 9", "samples = 50001");
    let line = |limit: &str| {
        let (code, said) = said(&["run", "-", "-o", &output, "--limit-memory", limit], &model);
        assert_eq!(code, Some(0), "{said}");
        said.lines().find(|line| line.contains("values")).map(str::to_owned)
    };
    let held = line("1G");
    assert!(held.is_some());
    assert_eq!(line("1M"), held);
}

#[test]
fn work_that_is_too_large_is_refused_in_advance() {
    let sum = (1..2000).map(|i| format!("sin({i}*x)")).collect::<Vec<_>>().join(" + ");
    let model = block("").replace("v^2/2\"", &format!("v^2/2\"\npotential = \"{sum}\""));
    let (code, text) = said(&["derive", "-", "--limit-memory", "1M"], &model);
    assert_eq!(code, Some(4), "{text}");
    assert!(text.contains("more memory would be needed than the limit of 1 MiB"), "{text}");
    assert!(text.contains("help: raise the limit (`--limit-memory`, `--limit-time`;"), "{text}");
    let (code, text) = said(&["check", "-", "--limit-time", "1e-6"], &model);
    assert_eq!(code, Some(4), "{text}");
    assert!(text.contains("more time would be needed than the limit of 0.000001 s"), "{text}");
    let (code, text) = said(&["run", "-", "--limit-memory", "nothing"], &model);
    assert_eq!(code, Some(2), "{text}");
}

#[test]
fn names_have_a_maximum_length() {
    let model = block("").replace('x', &"x".repeat(300));
    let (code, text) = said(&["check", "-"], &model);
    assert_eq!(code, Some(3), "{text}");
    assert!(text.ends_with("help: a name has at most 255 bytes\n"), "{text}");
}

/// Comments follow lines of code of any length.
#[test]
fn a_long_line_of_code_is_written() {
    let sum = (1..6000).map(|i| format!("sin({i}*x)")).collect::<Vec<_>>().join(" + ");
    let model = block("").replace("v^2/2\"", &format!("v^2/2\"\npotential = \"{sum}\""));
    let directory = tempfile::tempdir().expect("a directory");
    let output = directory.path().display().to_string();
    let (code, text) = said(&["emit", "-", "--lang", "c", "-o", &output], &model);
    assert_eq!(code, Some(0), "{text}");
}

/// ṙ = r v does not determine v at r = 0.
#[test]
fn a_start_where_the_frame_is_singular_is_refused() {
    let model = block("").replace("x = -0.5", "x = 0.0").replace("x = \"v\"", "x = \"x*v\"");
    let (code, text) = said(&["run", "-"], &model);
    assert_eq!(code, Some(4), "{text}");
    let why = "the frame is singular there: the matrix b of the velocities has rank 0, but 1 at most states";
    assert!(text.contains(why), "{text}");
}
