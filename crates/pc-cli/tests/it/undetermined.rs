//! Functions that are not given, from the text to the pages.

use std::fs;
use std::process::Command;

/// The exit code and output for a model text.
fn said_of(model: &str, arguments: &[&str]) -> (i32, String) {
    let directory = tempfile::tempdir().expect("a directory");
    fs::write(directory.path().join("model.toml"), model).expect("written");
    let output = Command::new(env!("CARGO_BIN_EXE_pc"))
        .args(arguments)
        .current_dir(directory.path())
        .output()
        .expect("pc starts");
    let text = [output.stdout, output.stderr].concat();
    (output.status.code().expect("an end"), String::from_utf8(text).expect("UTF-8"))
}

const CENTRAL: &str = "[functions]\nV = { of = \"s\" }\n[parameters]\nm = 2.0\n[coordinates]\nr = 1.2\n\"φ\" = 0.3\n\
    [quasi_velocities]\n\"φ'\" = 0.9\n[lagrangian]\nkinetic = \"m*(r'^2 + r^2*φ'^2)/2\"\npotential = \"V(r)\"\n\
    [integrals]\narea = \"m*r^2*φ'\"\n";

/// A particle on the surface z = f(r) that turns about its axis, under its weight.
const SURFACE: &str = "[functions]\nf = { of = \"r\" }\n[parameters]\ng = 9.81\n[coordinates]\nr = 1.0\n\"φ\" = 0.0\n\
    [quasi_velocities]\n\"φ'\" = 1.0\n[lagrangian]\nkinetic = \"(r'^2 + r^2*φ'^2 + d(f(r))^2)/2\"\npotential = \"g*f(r)\"\n";

/// A charge in the plane, with the vector potential (A, B).
const CHARGE: &str = "[functions]\nA = { of = \"x, y\" }\nB = { of = \"x, y\" }\n[coordinates]\nx = 0.1\ny = 0.2\n\
    [lagrangian]\nlagrangian = \"(x'^2 + y'^2)/2 + A(x, y)*x' + B(x, y)*y'\"\n";

#[test]
fn pages_of_every_format() {
    let mut all = String::new();
    for (model, format) in
        [(CENTRAL, "text"), (CENTRAL, "latex"), (CENTRAL, "json"), (SURFACE, "text"), (CHARGE, "latex")]
    {
        let (code, text) = said_of(model, &["derive", "model.toml", "--format", format]);
        assert_eq!(code, 0, "{text}");
        all += &format!("{text}\n");
    }
    insta::assert_snapshot!(all);
}

#[test]
fn the_theory_of_central_motion() {
    let (code, text) = said_of(CENTRAL, &["theory", "model.toml"]);
    assert_eq!(code, 0, "{text}");
    assert!(text.contains("area: m r² φ' = const   (proved)"), "{text}");
    insta::assert_snapshot!(text);
}

/// What holds for V = -k/r alone is disproved for a generic function.
#[test]
fn laplaces_vector_is_not_for_every_potential() {
    let cartesian = "[functions]\nV = { of = \"r\" }\n[parameters]\nk = 3.0\n[coordinates]\nx = 1.0\ny = 0.2\n[lagrangian]\n\
        kinetic = \"(x'^2 + y'^2)/2\"\npotential = \"V(sqrt(x^2 + y^2))\"\n[integrals]\n\
        laplace = \"y'*(x*y' - y*x') - k*x/sqrt(x^2 + y^2)\"\n";
    let (code, text) = said_of(cartesian, &["theory", "model.toml"]);
    assert_eq!(code, 0, "{text}");
    assert!(text.contains("y x' - x y' = const   (proved)"), "{text}");
    let laplace = text.lines().skip_while(|line| !line.contains("laplace")).take(2).collect::<String>();
    assert!(laplace.contains("disproved"), "{text}");
}

#[test]
fn a_check_leaves_out_what_needs_numbers() {
    for model in [CENTRAL, SURFACE, CHARGE] {
        let (code, text) = said_of(model, &["check", "model.toml"]);
        assert_eq!(code, 0, "{text}");
        assert!(text.contains("any smooth function, compared for a generic one"), "{text}");
        assert!(text.contains("no numbers: `"), "{text}");
    }
}

#[test]
fn numbers_need_a_value() {
    for arguments in [
        &["run", "model.toml"][..],
        &["linearize", "model.toml"],
        &["sweep", "model.toml", "--vary", "m=1:2:2", "--t-end", "1", "-o", "out.csv"],
        &["emit", "model.toml", "--lang", "c", "-o", "out"],
    ] {
        let (code, text) = said_of(CENTRAL, arguments);
        assert_ne!(code, 0, "{text}");
        assert!(
            text.contains("the function `V` has no value, so there are no numbers"),
            "{arguments:?}: {text}"
        );
    }
    insta::assert_snapshot!(said_of(CENTRAL, &["run", "model.toml"]).1);
}
