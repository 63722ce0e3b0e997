//! Absolute tolerances by component: what small motions are right to, and what is said.

use std::process::Output;

use crate::piped::pc;

fn said(output: &Output, code: i32) -> String {
    let text = String::from_utf8(output.stderr.clone()).expect("UTF-8");
    assert_eq!(output.status.code(), Some(code), "{text}");
    text
}

/// The column of this name in a table.
fn column(output: &Output, name: &str) -> Vec<f64> {
    let text = String::from_utf8(output.stdout.clone()).expect("UTF-8");
    let mut lines = text.lines();
    let place = lines.next().expect("names").split(',').position(|known| known == name).expect("a column");
    lines.map(|line| line.split(',').nth(place).expect("a number").parse().expect("a number")).collect()
}

/// A charge that swings beside a disk that turns: q = a cos 2t, φ = sin t.
fn beside(a: f64) -> String {
    format!(
        "[coordinates]\nq = {a:e}\n\"φ\" = 0\n[quasi_velocities]\n\"φ'\" = 1\n[lagrangian]\nkinetic = \"(q'^2 + φ'^2)/2\"\n\
         potential = \"2*q^2 + φ^2/2\"\n[simulation]\nt_end = 20\nsamples = 41\n"
    )
}

/// Errors of integration grow by some hundred in seven periods, by BDF's low orders by more; of 1e-9 beside 1 seven digits are left.
#[test]
fn a_small_motion_has_the_digits_of_a_large_one() {
    for method in ["adams", "dop853", "taylor", "auto", "bdf"] {
        for a in [1.0, 1e-4, 1e-9] {
            let output = pc(&beside(a), &["run", "-", "--method", method]);
            said(&output, 0);
            let worst = column(&output, "t")
                .iter()
                .zip(column(&output, "q"))
                .fold(0.0, |worst, (t, q)| f64::max(worst, (q / a - (2.0 * t).cos()).abs()));
            let most = if method == "bdf" || a < 1e-6 { 2e-5 } else { 1e-6 };
            assert!(worst < most, "{method}, {a}: {worst}");
        }
    }
}

#[test]
fn what_is_below_its_tolerance_is_said_and_a_tolerance_of_its_own_helps() {
    // Below the rounding of φ: nothing tells it from that.
    let output = pc(&beside(1e-14), &["run", "-"]);
    let text = said(&output, 0);
    assert!(
        text.contains(
            "digits   q is at most 1.0e-14 at the rows and its tolerance 1.0e-12: none of its digits is certain; \
             --atol \"q=…\" makes them so"
        ),
        "{text}"
    );
    for further in [&["--atol", "q=1e-24,q'=1e-24"][..], &["--atol", "q=1e-24", "--atol", "q'=1e-24"]] {
        let output = pc(&beside(1e-14), &[&["run", "-", "--method", "adams"], further].concat());
        let text = said(&output, 0);
        assert!(!text.contains("digits"), "{text}");
        assert!(text.contains("atol 1e-12, 1e-24 for q, 1e-24 for q'\n"), "{text}");
        for (t, q) in column(&output, "t").iter().zip(column(&output, "q")) {
            assert!((q / 1e-14 - (2.0 * t).cos()).abs() < 1e-6, "{q} at {t}");
        }
    }
    let written = format!("{}atol = {{ q = 1e-24, \"q'\" = 1e-24 }}\n", beside(1e-14));
    let of_file = pc(&written, &["run", "-", "--method", "adams"]);
    let given = pc(&beside(1e-14), &["run", "-", "--method", "adams", "--atol", "q=1e-24,q'=1e-24"]);
    assert_eq!(of_file.stdout, given.stdout);
}

#[test]
fn one_number_is_for_all_and_the_command_line_comes_first() {
    let model = format!("{}atol = {{ q = 1e-15 }}\n", beside(1.0));
    let words = |further: &[&str]| {
        let text = said(&pc(&model, &[&["run", "-"], further].concat()), 0);
        let line = text.lines().find(|line| line.trim_start().starts_with("method")).expect("a method");
        line.split_once("atol ").expect("a tolerance").1.to_owned()
    };
    assert_eq!(words(&[]), "1e-12, 1e-15 for q");
    assert_eq!(words(&["--atol", "1e-10"]), "1e-10, 1e-15 for q");
    assert_eq!(words(&["--atol", "1e-10,q=1e-10"]), "1e-10");
}

/// Those of the model, for all members, alone and side by side.
#[test]
fn members_of_a_sweep_have_the_digits_too() {
    let table = tempfile::tempdir().expect("a directory");
    let file = table.path().join("members.csv");
    let name = file.to_str().expect("UTF-8");
    let arguments = ["sweep", "-", "--vary", "q=1e-9:2e-9:5", "-o", name, "--no-progress"];
    let output = pc(&beside(1e-9), &arguments[..6]);
    said(&output, 0);
    let rows = std::fs::read_to_string(&file).expect("a table");
    let names: Vec<&str> = rows.lines().next().expect("names").split(',').collect();
    for (row, a) in rows.lines().skip(1).zip([1.0, 1.25, 1.5, 1.75, 2.0]) {
        let cells: Vec<&str> = row.split(',').collect();
        // The last column of this name: the first is the start.
        let place = names.iter().rposition(|known| *known == "q").expect("a column");
        let q: f64 = cells[place].parse().expect("a number");
        assert!((q / (a * 1e-9) - 40f64.cos()).abs() < 2e-5, "{q} of {a}");
    }
}

#[test]
fn a_tolerance_of_what_is_no_component_is_refused() {
    let model = format!("{}atol = {{ p = 1e-15 }}\n", beside(1.0));
    let refused = [
        (model.as_str(), &["run", "-"][..], 1),
        (&beside(1.0), &["run", "-", "--atol", "p=1e-15"], 2),
        (&beside(1.0), &["run", "-", "--atol", "q=0"], 2),
        (&beside(1.0), &["run", "-", "--atol", "q"], 2),
    ];
    let said: Vec<String> = refused
        .map(|(model, arguments, _)| String::from_utf8(pc(model, arguments).stderr).expect("UTF-8"))
        .into();
    insta::assert_snapshot!(said.join("--\n"));
}
