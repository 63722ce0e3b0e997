//! `pc compare`: equal motions, different ones, and refused comparisons.

use std::io::Write;
use std::process::{Command, Output, Stdio};

use pc_model::Builtin;
use serde_json::Value;

/// A harmonic oscillator of frequency 2, x = cos 2t.
const OSCILLATOR: &str = "[parameters]\nk = 4.0\n[coordinates]\nx = 1.0\n[lagrangian]\nkinetic = \"x'^2/2\"\npotential = \
                          \"k*x^2/2\"\n[simulation]\nt_end = 3.0\nsamples = 31\n";

fn run_on(model: &str, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_pc"));
    command.arg("compare").args(arguments);
    let child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn();
    let mut child = child.expect("pc starts");
    // A refused command line leaves the input unread.
    let _ = child.stdin.take().expect("a pipe").write_all(model.as_bytes());
    child.wait_with_output().expect("pc ends")
}

fn compare(arguments: &[&str]) -> Output {
    run_on("", arguments)
}

fn said(output: &Output) -> &str {
    std::str::from_utf8(&output.stderr).expect("UTF-8")
}

fn json(output: &Output) -> Value {
    serde_json::from_slice(&output.stdout).unwrap_or_else(|_| panic!("{}", said(output)))
}

fn names(columns: &Value) -> Vec<&str> {
    columns
        .as_array()
        .expect("a list")
        .iter()
        .map(|column| column["name"].as_str().expect("a name"))
        .collect()
}

#[track_caller]
fn refuses(model: &str, arguments: &[&str], code: i32, message: &str) {
    let output = run_on(model, arguments);
    assert_eq!((output.status.code(), said(&output)), (Some(code), message));
    assert!(output.stdout.is_empty());
}

/// A file of a model that is removed with its directory.
struct Written(tempfile::TempDir);

impl Written {
    fn new(text: &str) -> Written {
        let directory = tempfile::tempdir().expect("a directory");
        std::fs::write(directory.path().join("model.toml"), text).expect("written");
        Written(directory)
    }

    fn name(&self) -> String {
        self.0.path().join("model.toml").display().to_string()
    }
}

#[test]
fn a_motion_is_itself() {
    let same = Written::new(OSCILLATOR);
    let output = run_on(OSCILLATOR, &["-", &same.name()]);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    let text = String::from_utf8(output.stdout).expect("UTF-8").replace(&same.name(), "model.toml");
    insta::assert_snapshot!(text);
}

#[test]
fn two_forms_of_one_model_have_the_same_motion() {
    for model in ["heavy-top-euler", "relativistic-particle"] {
        let output = compare(&[model, "--form", "poincare,canonical", "--format", "json"]);
        assert_eq!(output.status.code(), Some(0), "{}", said(&output));
        let found = json(&output);
        assert_eq!(
            (&found["first"]["form"], &found["second"]["form"]),
            (&"poincare".into(), &"canonical".into())
        );
        assert_eq!((&found["verdict"], &found["only_first"]), (&"same".into(), &Value::Array(Vec::new())));
        let columns = found["columns"].as_array().expect("a list");
        // The motions have different steps, so some differences are not zero.
        assert!(columns.iter().any(|column| column["largest"].as_f64() > Some(0.0)));
    }
}

/// The models have different coordinates, as their descriptions say.
#[test]
fn the_top_in_a_quaternion_is_the_top_in_eulers_angles() {
    let output = compare(&["heavy-top-quaternion", "heavy-top-euler", "--t-end", "5", "--format", "json"]);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    let found = json(&output);
    let columns = names(&found["columns"]);
    assert!(["ω1", "ω2", "ω3", "energy"].iter().all(|name| columns.contains(name)), "{columns:?}");
    assert!(found["only_first"].as_array().expect("a list").contains(&"q0".into()));
    assert!(found["only_second"].as_array().expect("a list").contains(&"ψ".into()));
}

/// cos 2t and cos 2.02 t are known at all times.
#[test]
fn another_motion_is_exit_1_and_the_columns_are_named() {
    let other = Written::new(&OSCILLATOR.replace("k = 4.0", "k = 4.0804"));
    let arguments = ["-", &other.name(), "--columns", "x", "--format", "json"];
    let output = run_on(OSCILLATOR, &arguments);
    assert_eq!(output.status.code(), Some(1), "{}", said(&output));
    let found = json(&output);
    let column = &found["columns"][0];
    let apart = |t: f64| ((2.0 * t).cos() - (2.02 * t).cos()).abs();
    let largest = (0..31).map(|i| apart(f64::from(i) / 10.0)).fold(0.0, f64::max);
    // Up to the tolerance of the integration over three units of time.
    assert!((column["largest"].as_f64().expect("a number") - largest).abs() < 1e-7, "{column}");
    assert_eq!(
        (&column["since"], &column["scale"]),
        (&0.1.into(), &1.0.into()),
        "the first time after the start"
    );
    let errors: Vec<f64> =
        column["errors"].as_array().expect("a list").iter().map(|e| e.as_f64().expect("known")).collect();
    // Those of the tolerance, grown over three units of time.
    assert!(errors.iter().all(|error| (1e-13..1e-8).contains(error)), "{column}");
    let said_of_it = format!(
        "pc: the motions differ: x by {largest:.1e}, where the errors are {:.1e} and {:.1e}\n",
        errors[0], errors[1]
    );
    assert_eq!((said(&output), &found["verdict"]), (said_of_it.as_str(), &"different".into()));
    let output = run_on(OSCILLATOR, &[&arguments[..], &["--tolerance", "0.1"]].concat());
    assert_eq!((output.status.code(), &json(&output)["verdict"]), (Some(0), &"same".into()));
    let output = run_on(OSCILLATOR, &[&arguments[..], &["--tolerance", "0", "--absolute", "0.1"]].concat());
    assert_eq!(output.status.code(), Some(0));
}

/// A tenth of a millionth more of a parameter, where the errors of integration are 1e-9 or so; no millionth of a millionth.
#[test]
fn models_that_differ_by_more_than_errors_are_found() {
    for (k, code) in [("4.0000004", 1), ("4.000000000001", 0)] {
        let other = Written::new(&OSCILLATOR.replace("k = 4.0", &format!("k = {k}")));
        let output = run_on(OSCILLATOR, &["-", &other.name(), "--map", "x^2*x'=x^2*x'"]);
        assert_eq!(output.status.code(), Some(code), "{k}: {}", String::from_utf8_lossy(&output.stdout));
        if code == 1 {
            assert!(
                said(&output).contains("x by ") && said(&output).contains("x^2*x' = x^2*x' by "),
                "{}",
                said(&output)
            );
        }
    }
}

/// Lorenz' equations amplify errors by e^(0.9 t): those of 1e-9 are as large as the motion at t = 25.
#[test]
fn a_chaotic_motion_is_undecided() {
    let lorenz = "[coordinates]\nw = 1.0\n[lagrangian]\nkinetic = \"w'^2/2\"\n[states]\nx = { start = 1.0, rate = \"10*(y - x)\" }\ny = { start = 1.0, rate = \"x*(28 - z) - y\" }\nz = { \
                  start = 1.0, rate = \"x*y - 8*z/3\" }\n[simulation]\nt_end = 40.0\n";
    let same = Written::new(lorenz);
    let chaos =
        |further: &[&str]| run_on(lorenz, &[&["-", &same.name(), "--format", "json"], further].concat());
    let output = chaos(&[]);
    assert_eq!(output.status.code(), Some(7), "{}", said(&output));
    let found = json(&output);
    assert_eq!(found["verdict"], "undecided");
    let columns = found["columns"].as_array().expect("a list");
    let of = |name: &str| columns.iter().find(|column| column["name"] == name).expect(name);
    let x = of("x");
    assert_eq!(of("w")["verdict"], "same");
    let untold = x["untold"].as_f64().expect("a time");
    assert!((8.0..30.0).contains(&untold), "{x}");
    assert!(said(&output).contains("the errors of integration are too large to tell"), "{}", said(&output));
    assert_eq!(chaos(&["--t-end", "5"]).status.code(), Some(0));
    let output = chaos(&["--tolerance", "2"]);
    assert_eq!((output.status.code(), &json(&output)["verdict"]), (Some(7), &"undecided".into()));
}

/// z = 1 − t² until the ball bounces at t = 1, where a row is, and again at t = 3: each form may have it on either side.
#[test]
fn rows_at_a_jump_are_left_out() {
    let ball = "[parameters]\nm = 3.0\n[coordinates]\nz = 1.0\n[lagrangian]\nkinetic = \"m*z'^2/2\"\npotential = \"2*m*z\"\n\
                [events.ground]\nwhen = \"z\"\ndirection = \"falling\"\nreset = { \"z'\" = \"-z'\" }\n[simulation]\nt_end = 4.5\n\
                samples = 46\n";
    let output = run_on(ball, &["-", "--form", "poincare,canonical", "--format", "json"]);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    let found = json(&output);
    assert_eq!((&found["times"], &found["left_out"]), (&44.into(), &2.into()));
    // A ball that bounces a millionth later is another one.
    let other = Written::new(&ball.replace("z = 1.0", "z = 1.000002"));
    let output = run_on(ball, &["-", &other.name(), "--columns", "z'"]);
    assert_eq!(output.status.code(), Some(1), "{}", String::from_utf8_lossy(&output.stdout));
}

/// At default options.
#[test]
fn two_forms_of_each_model_have_the_same_motion() {
    crate::each_model::each(Builtin::all(), |model| {
        for form in ["canonical", "orthonormal"] {
            let output =
                crate::each_model::answer(&["compare", model.name, "--form", &format!("poincare,{form}")]);
            // It has no such form, or the form ends where its chart does.
            let has_no_form = matches!(output.status.code(), Some(2..=5));
            let is_same = output.status.code() == Some(0);
            let shown = String::from_utf8_lossy(&output.stdout);
            assert!(has_no_form || is_same, "{} {form}: {}\n{shown}", model.name, said(&output));
        }
    });
}

#[test]
fn parameters_are_set_in_each_model_that_has_them() {
    let other = Written::new(&OSCILLATOR.replace("k = 4.0", "k = 9.0\nspare = 1.0"));
    let set =
        |settings: &[&str]| run_on(OSCILLATOR, &[&["-", &other.name()], settings].concat()).status.code();
    assert_eq!(set(&[]), Some(1));
    assert_eq!(set(&["--set", "k=5", "--set", "spare=2"]), Some(0));
    refuses(
        OSCILLATOR,
        &["-", &other.name(), "--set", "c=5"],
        2,
        "pc: --set: `c` is neither a parameter nor a start value of this model; its parameters are k, spare, its start values \
         x, x'\n",
    );
}

/// The zero of the potential energy is arbitrary.
#[test]
fn energies_count_where_they_are_named() {
    let other = Written::new(&OSCILLATOR.replace("k*x^2/2", "k*x^2/2 + 3"));
    let output = run_on(OSCILLATOR, &["-", &other.name()]);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    assert!(text.contains("energy  3.0e0"), "{text}");
    assert!(text.contains("different from t = 0 on, which does not count\n"), "{text}");
    let output = run_on(OSCILLATOR, &["-", &other.name(), "--columns", "x,energy"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(
        said(&output).starts_with("pc: the motions differ: energy by 3.0e0, where the errors are "),
        "{}",
        said(&output)
    );
}

/// r² = x² + y², φ the angle: the same plane motion in two kinds of coordinates without common
/// names.
#[test]
fn expressions_are_compared() {
    let cartesian = "[parameters]\na = 1.0\n[coordinates]\nx = 1.0\ny = 0.0\n[quasi_velocities]\n\"y'\" = 1.2\n\
                     [lagrangian]\nkinetic = \"(x'^2 + y'^2)/2\"\npotential = \"-a/sqrt(x^2 + y^2)\"\n[simulation]\nt_end = 3.0\n";
    let polar = Written::new(
        "[coordinates]\nr = 1.0\n\"φ\" = 0.0\n[quasi_velocities]\n\"φ'\" = 1.2\n[lagrangian]\nkinetic = \
         \"(r'^2 + r^2*φ'^2)/2\"\npotential = \"-1/r\"\n",
    );
    let maps = [
        "--map",
        "a*sqrt(x^2+y^2) = r",
        "--map",
        "x=r*cos(φ)",
        "--map",
        "atan2(y,x)=φ",
        "--map",
        "x*y'-y*x'=r^2*φ'",
    ];
    let output = run_on(cartesian, &[&["-", &polar.name(), "--format", "json"], &maps[..]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    assert_eq!(
        names(&json(&output)["columns"]),
        ["energy", "a*sqrt(x^2+y^2) = r", "x = r*cos(φ)", "atan2(y,x) = φ", "x*y'-y*x' = r^2*φ'"]
    );
    let wrong = run_on(cartesian, &["-", &polar.name(), "--map", "y=r*cos(φ)"]);
    assert_eq!(wrong.status.code(), Some(1));
    refuses(
        cartesian,
        &["-", &polar.name()],
        2,
        "pc: no column but the energy is in both motions: the first has x, y, x', y', energy, the second r, φ, r', φ', \
         energy; say what corresponds, as in `--map \"r=sqrt(x^2+y^2)\"`\n",
    );
    refuses(
        cartesian,
        &["-", &polar.name(), "--map", "x=r*cos(theta)"],
        2,
        &format!(
            "pc: --map: `r*cos(theta)`: `theta` is neither a column nor a parameter of {}; these are t, r, φ, r', φ', energy\n",
            polar.name()
        ),
    );
    refuses(
        cartesian,
        &["-", &polar.name(), "--map", "x=r*cos(φ"],
        2,
        "pc: --map: `r*cos(φ`: unclosed parenthesis; close it with `)`\n",
    );
    refuses(
        cartesian,
        &["-", &polar.name(), "--map", "d(x')=r"],
        2,
        "pc: --map: `d(x')`: d() cannot be taken of columns; make it an entry of [outputs] in the model\n",
    );
}

#[test]
fn motions_that_end_at_different_times_differ() {
    let event = |height: &str| {
        format!(
            "[coordinates]\nz = {height}\n[lagrangian]\nkinetic = \"z'^2/2\"\npotential = \"z\"\n\
                 [events.ground]\nwhen = \"z\"\nterminal = true\n[simulation]\nt_end = 3.0\n"
        )
    };
    let (low, high) = (Written::new(&event("0.5")), Written::new(&event("2.0")));
    let output = compare(&[&low.name(), &high.name()]);
    assert_eq!(output.status.code(), Some(1));
    let (first, second) =
        ("A is ended by the event ground at t = ", "B is ended by the event ground at t = ");
    assert!(said(&output).contains(first) && said(&output).contains(second), "{}", said(&output));
    let output = compare(&[&low.name(), &low.name(), "--form", "poincare,canonical"]);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
}

#[test]
fn anything_but_two_motions_is_refused() {
    refuses(
        "",
        &["euler-top"],
        2,
        "pc: there is one motion only: give another model, or two forms as in `--form poincare,canonical`\n",
    );
    refuses(
        "",
        &["euler-top", "--form", "poincare,canonical,poincare"],
        2,
        "pc: --form: 3 forms are given for two motions; give one or two\n",
    );
    refuses(OSCILLATOR, &["-", "-"], 2, "pc: only one of the models can come from standard input\n");
}

#[test]
fn a_motion_that_fails_is_exit_5() {
    let centre = "[coordinates]\nr = 1.0\n[lagrangian]\nkinetic = \"r'^2/2\"\npotential = \"log(r)\"\n[simulation]\nt_end = 2.0\n";
    let output = run_on(centre, &["-", "--form", "poincare,canonical"]);
    assert_eq!(output.status.code(), Some(5), "{}", said(&output));
    assert!(said(&output).contains("the integration failed at t = "), "{}", said(&output));
    assert!(!output.stdout.is_empty(), "what was reached is compared");
    let other = Written::new(&OSCILLATOR.replace("[simulation]\n", "[simulation]\nt_start = 1.0\n"));
    refuses(
        OSCILLATOR,
        &["-", &other.name()],
        2,
        "pc: the motions begin at t = 0 and t = 1: `t_start` in [simulation] must be the same\n",
    );
    refuses(
        OSCILLATOR,
        &["-", "--form", "poincare,canonical", "--columns", "y"],
        2,
        "pc: --columns: `y` is not a column of both motions; these are x, x', energy\n",
    );
}
