//! `--method` of `pc run` and `pc sweep`.

use std::fs;
use std::process::{Command, Output};

fn pc(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pc")).args(arguments).output().expect("pc starts")
}

/// Standard error of a command that ends with this code.
fn said(output: &Output, code: i32) -> String {
    let text = String::from_utf8(output.stderr.clone()).expect("UTF-8");
    assert_eq!(output.status.code(), Some(code), "{text}");
    text
}

/// The line of the summary with this label.
fn line<'a>(summary: &'a str, label: &str) -> Option<&'a str> {
    summary.lines().find_map(|line| line.trim_start().strip_prefix(label)).map(str::trim)
}

fn table(output: &Output) -> Vec<Vec<f64>> {
    let text = String::from_utf8(output.stdout.clone()).expect("UTF-8");
    let row = |line: &str| line.split(',').map(|number| number.parse().expect("a number")).collect();
    text.lines().skip(1).map(row).collect()
}

#[test]
fn the_summary_says_what_ran_and_why() {
    let run = |model: &str, further: &[&str]| {
        said(&pc(&[&["run", model, "--t-end", "5", "--no-verify"], further].concat()), 0)
    };
    let summary = run("heavy-top-lagrange", &["--method", "dop853"]);
    assert_eq!(line(&summary, "method"), Some("DOP853, rtol 1e-9, atol 1e-12"));
    assert_eq!(line(&summary, "chosen"), None, "{summary}");
    let summary = run("heavy-top-lagrange", &["--method", "auto"]);
    assert_eq!(line(&summary, "method"), Some("auto, rtol 1e-9, atol 1e-12"));
    assert_eq!(line(&summary, "chosen"), Some("DOP853: no stiffness was seen"), "{summary}");
    let summary = run("stiff-sleigh", &["--method", "auto"]);
    let chosen = line(&summary, "chosen").expect("a choice");
    assert!(chosen.starts_with("DOP853 for ") && chosen.ends_with("changed once"), "{summary}");
    assert!(chosen.contains("stiffness was seen first at t = "), "{summary}");
    let summary = run("heavy-top-lagrange", &["--method", "adams"]);
    assert_eq!(line(&summary, "chosen"), None, "{summary}");
}

#[test]
fn all_methods_come_to_the_same_end() {
    let end = |method: &str| {
        let output = pc(&["run", "heavy-top-lagrange", "--t-end", "5", "--rows", "2", "--method", method]);
        said(&output, 0);
        table(&output).pop().expect("a row")
    };
    let adams = end("adams");
    for method in ["bdf", "dop853", "taylor", "auto"] {
        for (found, expected) in end(method).iter().zip(&adams) {
            // A few hundred steps with errors of 1e-9, a thousand by BDF.
            assert!((found - expected).abs() < 1e-5, "{method}: {found}, not {expected}");
        }
    }
}

#[test]
fn sensitivities_are_those_of_each_method() {
    let run = |method: &str| {
        pc(&[
            "run",
            "spherical-pendulum-meridian",
            "--t-end",
            "1",
            "--sensitivities",
            "g",
            "--method",
            method,
            "--no-verify",
        ])
    };
    let end = |method: &str| -> Vec<f64> {
        let output = run(method);
        said(&output, 0);
        let rows = String::from_utf8(output.stdout).expect("UTF-8");
        let last = rows.lines().last().expect("a row");
        last.split(',').map(|cell| cell.parse().expect("a number")).collect()
    };
    let close = |(a, b): (&f64, &f64)| (a - b).abs() <= 1e-6 * a.abs().max(1.0);
    let adams = end("adams");
    for method in ["dop853", "taylor", "bdf"] {
        let other = end(method);
        assert!(other.iter().zip(&adams).all(close), "{method}: {other:?} {adams:?}");
    }
    let summary = said(&run("auto"), 0);
    let chosen = "Adams, which has sensitivities";
    assert_eq!(line(&summary, "chosen"), Some(chosen), "{summary}");
}

#[test]
fn sweeps_and_checkpoints_have_all_methods() {
    let directory = tempfile::tempdir().expect("a directory");
    let place = |name: &str| directory.path().join(name).to_str().expect("UTF-8").to_owned();
    for method in ["dop853", "taylor", "auto"] {
        let swept = place(&format!("{method}.csv"));
        let output = pc(&[
            "sweep",
            "spherical-pendulum-meridian",
            "--vary",
            "g=9:10:3",
            "--t-end",
            "2",
            "--method",
            method,
            "-o",
            &swept,
        ]);
        said(&output, 0);
        assert_eq!(fs::read_to_string(&swept).expect("a table").lines().count(), 4);

        let kept = place(&format!("{method}.ckpt"));
        let run = |further: &[&str]| {
            let given = ["run", "rocking-block", "--t-end", "3", "--method", method, "--every", "7"];
            pc(&[&given, further].concat())
        };
        let whole = run(&["--checkpoint", &kept]);
        said(&whole, 0);
        let resumed = run(&["--resume", &kept]);
        said(&resumed, 0);
        assert_eq!(whole.stdout, resumed.stdout, "{method}");
        let other = pc(&["run", "rocking-block", "--t-end", "3", "--method", "adams", "--resume", &kept]);
        assert!(said(&other, 2).contains(&format!("--method {method}")));
    }
}

#[test]
fn taylor_refuses_equations_that_are_solved_in_numbers() {
    let refused = said(&pc(&["run", "vertical-disk", "--method", "taylor", "--no-verify"]), 5);
    assert!(refused.contains("Taylor's method needs equations that are solved in expressions"), "{refused}");
}
