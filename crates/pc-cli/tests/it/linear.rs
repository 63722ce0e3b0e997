//! `pc linearize` and `pc equilibria`.

use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use serde_json::Value;

fn run(arguments: &[&str], directory: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pc")).args(arguments).current_dir(directory).output().expect("pc starts")
}

/// The exit code and output for a model text.
fn said_of(model: &str, command: &str, arguments: &[&str]) -> (i32, String) {
    let directory = tempfile::tempdir().expect("a directory");
    fs::write(directory.path().join("model.toml"), model).expect("written");
    let output = run(&[&[command, "model.toml"], arguments].concat(), directory.path());
    let text = [output.stdout, output.stderr].concat();
    (output.status.code().expect("an end"), String::from_utf8(text).expect("UTF-8"))
}

#[track_caller]
fn said(model: &str, command: &str, arguments: &[&str]) -> String {
    let (code, text) = said_of(model, command, arguments);
    assert_eq!(code, 0, "{text}");
    text
}

#[track_caller]
fn refused(model: &str, command: &str, arguments: &[&str], expected: i32) -> String {
    let (code, text) = said_of(model, command, arguments);
    assert_eq!(code, expected, "{text}");
    text
}

const CART_POLE: &str = r#"
[model]
name = "Pole on a cart"
[parameters]
M = 2.0
m = 0.5
l = 0.8
g = 10.0
[inputs]
push = 0.0
[coordinates]
x = 0.0
"θ" = 0.1
[lagrangian]
kinetic = "(M + m)/2*x'^2 + m*l*x'*θ'*cos(θ) + m*l^2/2*θ'^2"
potential = "m*g*l*cos(θ)"
dissipation = "0.2*x'^2"
[forces]
x = "push"
[outputs]
tip = "x + l*sin(θ)"
"#;

const BEAD: &str = r#"
[model]
name = "Bead on a turning hoop"
[parameters]
"Ω" = 2.0
g = 1.0
[coordinates]
"θ" = 0.4
[lagrangian]
kinetic = "(θ'^2 + Ω^2*sin(θ)^2)/2"
potential = "-g*cos(θ)"
"#;

const DRIVEN: &str = r#"
[parameters]
a = 0.1
[coordinates]
"θ" = 0.1
[lagrangian]
kinetic = "θ'^2/2"
potential = "(1 + a*cos(20*t))*cos(θ)"
"#;

#[test]
fn a_pole_on_a_cart() {
    insta::assert_snapshot!(said(CART_POLE, "linearize", &["--hold", "x'"]));
}

#[test]
fn a_pole_on_a_cart_for_programs() {
    let text = said(CART_POLE, "linearize", &["--hold", "x'", "--cyclic", "drop", "--format", "json"]);
    // The last digits depend on the processor.
    let object = rounded(serde_json::from_str(&text).expect("JSON"));
    insta::assert_snapshot!(object);
}

fn rounded(value: Value) -> Value {
    match value {
        Value::Number(number) => {
            let number = (number.as_f64().expect("a number") * 1e9).round() / 1e9;
            serde_json::json!(number + 0.0)
        }
        Value::Array(list) => list.into_iter().map(rounded).collect(),
        Value::Object(members) => members.into_iter().map(|(name, value)| (name, rounded(value))).collect(),
        other => other,
    }
}

#[test]
fn a_pole_on_a_cart_as_lines() {
    let text = said(CART_POLE, "linearize", &["--hold", "x'", "--format", "csv"]);
    let value = |place: &str| -> f64 {
        let line = text.lines().find_map(|line| line.strip_prefix(place)).expect("a line");
        line.parse().expect("a number")
    };
    assert!(text.starts_with("array,row,column,value\n"));
    // (M + m) g/(M l) = 15.625, 1/M
    assert!((value("A,θ',θ,") - 15.625).abs() < 1e-13);
    assert_eq!((value("B,x',push,"), value("C,tip,θ,"), value("D,tip,push,")), (0.5, 0.8, 0.0));
    // Rounding of numbers of order one.
    assert!((value("M,x,x,") - 2.5).abs() < 1e-15 && value("F,θ,push,").abs() < 1e-15);
    assert!((value("eigenvalues.re,1,,") - value("modes.re,x',1,") / value("modes.re,x,1,")).abs() < 1e-12);
}

#[test]
fn the_equilibria_of_a_bead() {
    insta::assert_snapshot!(said(BEAD, "equilibria", &[]));
}

#[test]
fn the_equilibria_of_a_bead_for_programs() {
    let text = said(BEAD, "equilibria", &["--format", "json", "--box", "θ=0.1:2", "--starts", "50"]);
    let found: Value = serde_json::from_str(&text).expect("JSON");
    let list = found["equilibria"].as_array().expect("a list");
    assert_eq!(list.len(), 1);
    let close = |value: &Value, expected: f64| (value.as_f64().expect("a number") - expected).abs() < 1e-12;
    // cos θ = g/Ω² = 1/4, energy −Ω² sin²θ/2 − g cos θ, ω² = Ω² − g²/Ω².
    assert!(close(&list[0]["state"]["θ"], 0.25f64.acos()) && close(&list[0]["energy"], -2.125));
    assert!(close(&list[0]["eigenvalues"][0][1], 3.75f64.sqrt()));
    assert_eq!(list[0]["verdict"], "stable, by the second variation of the energy");
    assert_eq!(
        (&found["box"]["θ"], &found["starts"]),
        (&serde_json::json!([0.1, 2.0]), &serde_json::json!(50))
    );
    let table = said(BEAD, "equilibria", &["--format", "csv"]);
    assert_eq!(table.lines().next(), Some("θ,θ',energy,verdict,family,members,re1,im1,re2,im2"));
    assert_eq!(table.lines().count(), 5);
}

/// The examples of the page show what the program prints.
#[test]
fn the_page_shows_the_output_of_the_program() {
    let page = include_str!("../../../../docs/linearization.md");
    let mut model = String::new();
    let mut examples = 0;
    for block in page.split("\n```").skip(1).step_by(2) {
        match block.split_once('\n').expect("a block") {
            ("toml", text) => text.clone_into(&mut model),
            ("console", text) => {
                let (command, expected) = text.split_once('\n').expect("a command");
                let words: Vec<&str> =
                    command.split_whitespace().map(|word| word.trim_matches('"')).collect();
                let &["$", "pc", command, "model.toml", ref arguments @ ..] = &words[..] else {
                    panic!("{command}")
                };
                assert_eq!(said(&model, command, arguments).trim_end(), expected.trim_end(), "{command}");
                examples += 1;
            }
            (other, _) => panic!("a block of {other}"),
        }
    }
    assert_eq!(examples, 2);
}

/// At Ω² = g the bottom loses its stability: λ² = Ω² − g at the bottom, λ² = −(Ω² − g²/Ω²) at the
/// tilted equilibrium.
#[test]
fn a_pitchfork_over_the_rate_of_the_hoop() {
    let text = said(BEAD, "linearize", &["--set", "θ=0", "--vary", "Ω=0:2:5", "--format", "csv"]);
    assert_eq!(text.lines().next(), Some("Ω,re1,im1,re2,im2"));
    for (line, turn) in text.lines().skip(1).zip([0.0f64, 0.5, 1.0, 1.5, 2.0]) {
        let row: Vec<f64> = line.split(',').map(|field| field.parse().expect("a number")).collect();
        let square = turn * turn - 1.0;
        let (real, imaginary) = if square > 0.0 { (square.sqrt(), 0.0) } else { (0.0, (-square).sqrt()) };
        assert_eq!(row[0], turn);
        assert!((row[1].abs() - real).abs() < 1e-14 && (row[2].abs() - imaginary).abs() < 1e-14, "{line}");
        assert!((row[1] + row[3]).abs() < 1e-14 && (row[2] + row[4]).abs() < 1e-14, "{line}");
    }
    let beside = said(BEAD, "linearize", &["--format", "json", "--set", "θ=1.2"]);
    let beside: Value = serde_json::from_str(&beside).expect("JSON");
    let frequency = beside["eigenvalues"][0][1].as_f64().expect("a number");
    assert!((frequency - 3.75f64.sqrt()).abs() < 1e-13, "{frequency}");
}

/// Values without an equilibrium are gaps, and are reported.
#[test]
fn values_without_an_equilibrium_are_gaps() {
    let pulled = BEAD
        .replace("[lagrangian]", "[forces]\n\"θ\" = \"pull\"\n[lagrangian]")
        .replace("g = 1.0", "g = 1.0\npull = 0.0");
    let vary = ["--set", "Ω=0", "--vary", "pull=0:1.5:4", "--format", "json"];
    let text = said(&pulled, "linearize", &vary);
    assert!(text.contains("note: nothing at pull = 1.5: no steady state was found near the start"), "{text}");
    let object: Value = serde_json::from_str(&text[..text.find("note:").expect("a note")]).expect("JSON");
    let branch = object["branches"][0]["imaginary"].as_array().expect("a branch");
    // ω² = cos θ with sin θ = pull.
    assert!((branch[1].as_f64().expect("a number").abs() - 0.75f64.powf(0.25)).abs() < 1e-12, "{branch:?}");
    assert!(branch[3].is_null());
    assert_eq!(object["missing"][0]["value"], 1.5);
    let none = refused(&pulled, "linearize", &["--set", "Ω=0", "--vary", "pull=2:3:2"], 5);
    assert!(none.contains("there is no steady state for any of the 2 values"), "{none}");
}

#[test]
fn files_contain_the_same_numbers() {
    let directory = tempfile::tempdir().expect("a directory");
    fs::write(directory.path().join("model.toml"), CART_POLE).expect("written");
    let write = |file: &str| {
        let output = run(&["linearize", "model.toml", "--hold", "x'", "-o", file], directory.path());
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        assert!(output.stdout.is_empty());
        fs::read(directory.path().join(file)).expect("a file")
    };
    let json: Value = serde_json::from_slice(&write("a.json")).expect("JSON");
    assert_eq!(json["A"][3][1].as_f64().map(|a| (a * 1e9).round()), Some(15.625e9));
    assert!(String::from_utf8(write("a.csv")).expect("UTF-8").contains("A,θ',θ,1.562"));
    // Both archives contain the number, by rows and by columns.
    let number = json["A"][3][1].as_f64().expect("a number").to_le_bytes();
    for file in ["a.npz", "a.mat"] {
        let bytes = write(file);
        assert!(bytes.windows(8).any(|window| window == number), "{file}");
        assert_eq!(bytes, write(file), "the same bytes");
    }
    let archive = write("a.npz");
    for name in ["A.npy", "B.npy", "modes.npy", "K.npy"] {
        assert!(archive.windows(name.len()).any(|window| window == name.as_bytes()), "{name}");
    }

    let locus = |file: &str| {
        let arguments = ["linearize", "model.toml", "--vary", "l=0.5:1:3", "-o", file, "--plot", "a.svg"];
        assert_eq!(run(&arguments, directory.path()).status.code(), Some(0));
        fs::read(directory.path().join(file)).expect("a file")
    };
    let table = String::from_utf8(locus("b.csv")).expect("UTF-8");
    assert_eq!(table.lines().count(), 4);
    assert!(!locus("b.npz").is_empty() && !locus("b.mat").is_empty());
    let picture = fs::read_to_string(directory.path().join("a.svg")).expect("a picture");
    let words =
        ["Re λ", "Im λ", "Pole on a cart", "in the complex plane", "<title>λ1, mostly", "the present 0.8"];
    for word in words {
        assert!(picture.contains(word), "{word}");
    }
    let symlog = [
        "linearize",
        "model.toml",
        "--vary",
        "l=0.5:1:3",
        "--plot",
        "b.svg",
        "--axes",
        "symlog",
        "-o",
        "c.csv",
    ];
    assert_eq!(run(&symlog, directory.path()).status.code(), Some(0));
    let other = fs::read_to_string(directory.path().join("b.svg")).expect("a picture");
    assert!(other.contains("10⁰") && other != picture);
}

#[test]
fn a_model_comes_from_standard_input() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_pc"))
        .args(["equilibria", "-", "--format", "csv"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("pc starts");
    child.stdin.take().expect("open").write_all(BEAD.as_bytes()).expect("written");
    let output = child.wait_with_output().expect("an end");
    assert_eq!(String::from_utf8(output.stdout).expect("UTF-8").lines().count(), 5);
}

#[test]
fn what_is_not_defined_is_refused_with_a_cure() {
    let driven = [
        refused(DRIVEN, "linearize", &[], 4),
        refused(DRIVEN, "equilibria", &[], 4),
        refused(BEAD, "linearize", &["--set", "g=0", "--set", "θ=0.4", "--hold", "θ"], 5),
        refused(BEAD, "equilibria", &["--box", "θ=1.5:2"], 5),
        refused(BEAD, "linearize", &["--hold", "phi"], 2),
        refused(BEAD, "linearize", &["--set", "h=1"], 2),
        refused(BEAD, "linearize", &["--set", "θ=1", "--set", "θ=2"], 2),
        refused(BEAD, "linearize", &["--set", "θ=1", "--vary", "θ=1:2:3"], 2),
        refused(BEAD, "linearize", &["--vary", "h=1:2:3"], 2),
        refused(BEAD, "linearize", &["--set", "g=2", "--vary", "g=1:2:3"], 2),
        refused(BEAD, "linearize", &["-o", "a.xlsx"], 2),
        refused(BEAD, "equilibria", &["--box", "θ'=0:1"], 2),
        refused(CART_POLE, "equilibria", &["--box", "x=0:1"], 2),
        refused(&CART_POLE.replace("\"push\"", "\"push + 1\""), "equilibria", &[], 5),
    ];
    insta::assert_snapshot!(driven.concat());
    let jacobian = said(DRIVEN, "linearize", &["--at", "start", "--set", "θ=0"]);
    assert!(jacobian.contains("the start, not steady"), "{jacobian}");
    let missing = refused(BEAD, "linearize", &["--plot", "a.svg"], 2);
    assert!(missing.contains("--vary"), "{missing}");
}

/// A pendulum in Cartesian coordinates has the acceleration −x g/l near the bottom, however it is
/// held.
#[test]
fn constraints_reduce_the_state() {
    let pendulum = r#"
[parameters]
g = 9.0
[coordinates]
x = 0.6
y = -0.8
[constraints]
rod = "x^2 + y^2 - 1"
[lagrangian]
kinetic = "(x'^2 + y'^2)/2"
potential = "g*y"
"#;
    let text = said(pendulum, "linearize", &["--format", "json"]);
    let object: Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(object["components"], serde_json::json!(["x", "x'"]));
    let number = |place: &Value| place.as_f64().expect("a number");
    assert!(
        (number(&object["A"][1][0]) + 9.0).abs() < 1e-12
            && (number(&object["state"]["y"]) + 1.0).abs() < 1e-14
    );
    let second = &object["second_order"];
    assert!(
        (number(&second["K"][0][0]) - 9.0).abs() < 1e-12 && (number(&second["M"][0][0]) - 1.0).abs() < 1e-12
    );
    let both: Value =
        serde_json::from_str(&said(pendulum, "equilibria", &["--format", "json"])).expect("JSON");
    let list = both["equilibria"].as_array().expect("a list");
    let verdicts: Vec<_> = list.iter().map(|one| one["verdict"].as_str().expect("a verdict")).collect();
    assert_eq!(
        verdicts,
        ["stable, by the second variation of the energy", "unstable, by the first approximation"]
    );
    assert!(
        (number(&list[0]["state"]["y"]) + 1.0).abs() < 1e-12
            && (number(&list[1]["state"]["y"]) - 1.0).abs() < 1e-12
    );
}

/// A mass on a rod pushed by u: with θ from below the tension is g cos θ + u sin θ, 12.5 in balance at tan θ = u/g,
/// where its slope is (0, sin θ). The force on the mass is the tension along the rod.
#[test]
fn reactions_among_the_outputs_have_slopes() {
    let text = r#"
[inputs]
u = 7.5
[coordinates]
x = 0.6
z = -0.8
[constraints]
rod = "x^2 + z^2 - 1"
[bodies.bob]
mass = 1
position = ["x", 0, "z"]
[gravity]
acceleration = [0, 0, -10]
[forces]
x = "u"
[outputs]
tension = "-2*λ_rod"
across = "F_rod_bob_x"
along = "x*F_rod_bob_x + z*F_rod_bob_z"
"#;
    let all: Value = serde_json::from_str(&said(text, "linearize", &["--format", "json"])).expect("JSON");
    assert_eq!(all["outputs"], serde_json::json!(["tension", "across", "along"]));
    let slope = |matrix: &str, i: usize, j: usize| all[matrix][i][j].as_f64().expect("a number");
    // The force across is −T x, and T is stationary in θ.
    for (i, (by_input, by_x)) in [(0.6, 0.0), (-0.36, -12.5), (-0.6, 0.0)].into_iter().enumerate() {
        assert!((slope("D", i, 0) - by_input).abs() < 1e-12, "{i}: {}", slope("D", i, 0));
        assert!((slope("C", i, 0) - by_x).abs() < 1e-11, "{i}: {}", slope("C", i, 0));
        assert!(slope("C", i, 1).abs() < 1e-12, "{i}: {}", slope("C", i, 1));
    }
}

/// A mass m on a rod, tied to a spring-loaded wheel by φ' = x' cos φ + y' φ: about the lowest point
/// m x'' = 2u + 2x λ − μ, φ'' = μ − 2φ, φ'' = x'' and 0 = u − m g − 2λ, so that (m + 1) x'' = 2u − m g x − 2φ and
/// the reaction of the tie is μ = x'' + 2φ.
#[test]
fn reactions_of_conditions_on_velocities_have_slopes_beside_those_of_positions() {
    let text = r#"
[inputs]
u = 0
[coordinates]
x = 0
y = -1
"φ" = 0
[constraints]
rod = "x^2 + y^2 - 1"
tie = "φ' - x'*cos(φ) - y'*φ"
[lagrangian]
kinetic = "φ'^2/2"
potential = "φ^2"
[bodies.bob]
mass = 2
position = ["x", "y", 0]
[gravity]
acceleration = [0, -9.75, 0]
[forces]
x = "2*u"
y = "u"
[outputs]
tension = "-2*λ_rod"
tied = "λ_tie"
"#;
    let all: Value = serde_json::from_str(&said(text, "linearize", &["--format", "json"])).expect("JSON");
    assert_eq!(all["components"], serde_json::json!(["x", "φ", "x'"]));
    let by_state = [0.0, 0.0, 0.0, -6.5, 4.0 / 3.0, 0.0];
    for (matrix, expected) in [("C", &by_state[..]), ("D", &[-1.0, 2.0 / 3.0])] {
        let rows =
            all[matrix].as_array().expect("rows").iter().flat_map(|row| row.as_array().expect("a row"));
        let found: Vec<f64> = rows.map(|x| x.as_f64().expect("a number")).collect();
        assert_eq!(found.len(), expected.len());
        // A few roundings of numbers up to 20.
        assert!(found.iter().zip(expected).all(|(x, y)| (x - y).abs() < 1e-12), "{matrix}: {found:?}");
    }
}
