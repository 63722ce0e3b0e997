//! `project` in a model and `--project`.

use std::process::Output;

use crate::piped;

const OSCILLATOR: &str = r#"[coordinates]
x = 1.0
[lagrangian]
kinetic = "x'^2/2"
potential = "x^2/2"
[integrals]
place = "x"
radius = "x^2 + x'^2"
[simulation]
t_end = 100.0
samples = 11
"#;

fn pc(model: &str, arguments: &[&str]) -> Output {
    piped::pc(model, &[&["run", "-"], arguments].concat())
}

fn said(output: &Output, code: i32) -> String {
    let text = String::from_utf8(output.stderr.clone()).expect("UTF-8");
    assert_eq!(output.status.code(), Some(code), "{text}");
    text
}

/// The largest |x² + ẋ² − 1| of a table with the columns t, x, x', place, radius, energy.
fn drift(output: &Output) -> f64 {
    let text = String::from_utf8(output.stdout.clone()).expect("UTF-8");
    let radius = text.lines().skip(1).map(|row| row.split(',').nth(4).map(str::parse::<f64>));
    radius.map(|radius| (radius.expect("a column").expect("a number") - 1.0).abs()).fold(0.0, f64::max)
}

#[test]
fn integrals_are_kept_on_request() {
    let plain = pc(OSCILLATOR, &["--rtol", "1e-6"]);
    said(&plain, 0);
    assert!(drift(&plain) > 1e-6);
    let asked = pc(OSCILLATOR, &["--rtol", "1e-6", "--project", "radius"]);
    said(&asked, 0);
    assert!(drift(&asked) < 1e-14); // a few roundings of numbers below 1
    let written = pc(&format!("{OSCILLATOR}project = [\"radius\", \"energy\"]\n"), &["--rtol", "1e-6"]);
    said(&written, 0);
    assert!(drift(&written) < 1e-14);
}

#[test]
fn functions_that_are_not_integrals_are_refused() {
    assert_eq!(
        said(&pc(OSCILLATOR, &["--project", "radios"]), 2),
        "pc: --project: `radios` is not an integral of this model; there are place, radius, energy\n"
    );
    assert_eq!(
        said(&pc(&format!("{OSCILLATOR}project = [\"radius\", \"radios\"]\n"), &[]), 3),
        "pc: <stdin>:12:22: [simulation] project: `radios` is not an integral\n    \
         project = [\"radius\", \"radios\"]\n                         ^^^^^^^^\n  \
         help: did you mean `radius`? the integrals are place, radius, energy\n"
    );
    let moving = OSCILLATOR.replace("x = 1.0", "x = 1.0\n[quasi_velocities]\n\"x'\" = 0.5");
    assert_eq!(
        said(&pc(&moving, &["--project", "place"]), 4),
        "pc: <stdin>:9:1: [integrals] place: `place` cannot be kept: it changes along the motion, at t = 0 at the rate \
         0.5\n    place = \"x\"\n    ^^^^^\n  \
         help: leave it out of `project`; `pc check` says what the motion keeps\n"
    );
    assert_eq!(
        said(&pc(&format!("{OSCILLATOR}project = \"radius\"\n"), &[]), 3),
        "pc: <stdin>:12:11: [simulation] project: expected a list of names of integrals, found a string\n    \
         project = \"radius\"\n              ^^^^^^^^\n  \
         help: write `project = [\"energy\"]`\n"
    );
    let held = "[coordinates]\nx = 1.0\ny = 0.0\n[constraints]\nrod = \"x^2 + y^2 - 1\"\n[lagrangian]\n\
                kinetic = \"(x'^2 + y'^2)/2\"\n[integrals]\narea = \"x*y' - y*x'\"\n[simulation]\nt_end = 1.0\n";
    said(&pc(held, &["--project", "area"]), 0);
    said(&pc(held, &["--form", "canonical", "--project", "energy"]), 0);
    said(&pc(held, &["--form", "canonical", "--project", "area"]), 0);
}
