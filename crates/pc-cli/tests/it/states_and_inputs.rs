//! First-order states and inputs in runs, sweeps and emitted source.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

fn pc(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pc")).args(arguments).output().expect("pc runs")
}

#[track_caller]
fn ok(arguments: &[&str]) -> String {
    let output = pc(arguments);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("text")
}

/// The model in a file in a temporary directory.
fn written(text: &str) -> (tempfile::TempDir, String) {
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("model.toml");
    fs::write(&path, text).expect("a file");
    let path = path.display().to_string();
    (directory, path)
}

/// Header and rows.
fn table(csv: &str) -> (Vec<String>, Vec<Vec<f64>>) {
    let mut lines = csv.lines();
    let header = lines.next().expect("a header").split(',').map(str::to_owned).collect();
    let number = |cell: &str| cell.parse().expect("a number");
    (header, lines.map(|line| line.split(',').map(number).collect()).collect())
}

#[track_caller]
fn assert_close(found: &[f64], expected: &[f64], within: f64) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() <= within, "{found} is not {expected}");
    }
}

/// A pendulum held by a motor: current and integral of the error are states.
const MOTOR: &str = r#"
[parameters]
J = 0.01
m = 0.2
l = 0.3
g = 9.81
mgl = "m*g*l"
L = 0.005
R = 1.0
ke = 0.05
Kp = 30.0
Ki = 20.0
Kd = 2.0
ref = 1.0
[coordinates]
th = 0
[quasi_velocities]
w = { is = "th'", start = 0 }
[states]
i = { start = 0, rate = "(Kp*(ref-th) + Ki*e - Kd*w - R*i - ke*w)/L" }
e = { rate = "ref - th" }
[lagrangian]
kinetic = "J/2*w^2"
potential = "-mgl*cos(th)"
[forces]
w = "ke*i"
[outputs]
heat = "R*i^2"
[simulation]
t_end = 5
method = "bdf"
"#;

/// The expected values are from Radau and DOP853 of SciPy, which agree to 1e-14.
#[test]
fn a_motor_is_integrated_with_its_pendulum() {
    let (_directory, model) = written(MOTOR);
    let expected = [0.984_241_575_619_586, 0.008_901_351_626_70, 9.803_339_179_834, 0.467_456_350_102_65];
    for form in ["poincare", "canonical"] {
        for method in ["bdf", "adams"] {
            let run =
                ok(&["run", &model, "--rows", "2", "--form", form, "--method", method, "--rtol", "1e-11"]);
            let (header, rows) = table(&run);
            assert_eq!(header, ["t", "th", "w", "i", "e", "energy", "heat"]);
            // A few thousand steps with errors of 1e-11, for values up to 10.
            assert_close(&rows[1][1..5], &expected, 1e-8);
        }
    }
}

#[test]
fn states_are_printed_and_swept() {
    let (directory, model) = written(MOTOR);
    let derived = ok(&["derive", &model]);
    assert!(derived.contains("\nStates\n  i' = "), "{derived}");
    assert!(derived.contains("\n  e' = ref - th\n"), "{derived}");
    let json: Value = serde_json::from_str(&ok(&["derive", &model, "--format", "json"])).expect("JSON");
    assert_eq!(json["states"]["e"], "ref - th");
    let canonical: Value =
        serde_json::from_str(&ok(&["derive", &model, "--form", "canonical", "--format", "json"]))
            .expect("JSON");
    assert!(canonical["states"]["i"].as_str().expect("text").contains("p_w"), "{canonical}");
    assert!(ok(&["derive", &model, "--format", "latex"]).contains("\\paragraph{States.}\n"));
    let check = ok(&["check", &model]);
    assert!(check.contains("l = 2   i, e"), "{check}");

    let sweep = directory.path().join("sweep.csv").display().to_string();
    ok(&["sweep", &model, "--vary", "e=0:1:2", "--vary", "m=0.2:0.4:2", "-o", &sweep]);
    let text = fs::read_to_string(&sweep).expect("a file");
    assert!(text.starts_with("member,e(start),m,status,t,th,w,i,e,energy,heat,"), "{text}");
    let column =
        |line: &str, j: usize| line.split(',').nth(j).expect("a cell").parse::<f64>().expect("a number");
    let lines: Vec<&str> = text.lines().skip(1).collect();
    let heavier = ok(&["run", &model, "--rows", "2", "--set", "m=0.4"]);
    let (_, rows) = table(&heavier);
    assert_close(&[column(lines[1], 5), column(lines[1], 7)], &[rows[1][1], rows[1][3]], 1e-12);
}

/// A parameter that is an expression follows the parameters that are set.
#[test]
fn parameters_made_of_others_are_set() {
    let (_directory, model) = written(MOTOR);
    let end = |settings: &[&str]| {
        let run = ok(&[&["run", &model, "--rows", "2"], settings].concat());
        table(&run).1[1][1..].to_vec()
    };
    let set = end(&["--set", "m=0.4"]);
    assert_close(&set, &end(&["--set", "mgl=1.1772"]), 1e-12);
    assert_ne!(set, end(&["--set", "m=0.4", "--set", "mgl=0.5886"]));
}

/// y'' = u: u = 6 t gives t³; a jump from 0 to 2 at t = 1 gives (t − 1)²; a spline through sin t
/// gives t − sin t to order h⁴.
fn driven(input: &str) -> String {
    format!(
        "[inputs]\nu = {input}\n[coordinates]\ny = 0\n[lagrangian]\nkinetic = \"y'^2/2\"\n[forces]\ny = \"u\"\n\
         [outputs]\nforce = \"u\"\n[simulation]\nt_end = 2\n"
    )
}

#[test]
fn tables_drive_a_motion() {
    let (directory, model) =
        written(&driven("{ file = \"u.csv\", column = \"u\", interpolation = \"linear\" }"));
    fs::write(Path::new(&directory.path()).join("u.csv"), "t,u\n0,0\n1,6\n2,12\n").expect("a file");
    let (_, rows) = table(&ok(&["run", &model, "--rows", "3", "--rtol", "1e-12"]));
    assert_close(&rows[2][1..3], &[8.0, 12.0], 1e-10);
    assert_eq!(rows.iter().map(|row| row[4]).collect::<Vec<_>>(), [0.0, 6.0, 12.0]);

    let held = "{ times = [0, 1], values = [0, 2], interpolation = \"hold\" }";
    let (_directory, model) = written(&driven(held));
    for form in ["poincare", "canonical"] {
        let (_, rows) = table(&ok(&["run", &model, "--rows", "5", "--form", form]));
        let [at_half, at_one, at_end] = [1, 2, 4].map(|i| rows[i].clone());
        // Before the jump nothing moves, to the last bit.
        assert_eq!([&at_half[1..3], &at_one[1..3]], [[0.0; 2], [0.0; 2]]);
        assert_close(&at_end[1..3], &[1.0, 2.0], 1e-10);
        assert_eq!(rows.iter().map(|row| row[4]).collect::<Vec<_>>(), [0.0, 0.0, 2.0, 2.0, 2.0]);
    }

    let h = 0.01;
    let times: Vec<f64> = (0..=200).map(|i| f64::from(i) * h).collect();
    let values: Vec<f64> = times.iter().map(|t| t.sin()).collect();
    let cubic = format!("{{ times = {times:?}, values = {values:?}, interpolation = \"cubic\" }}");
    let (_directory, model) = written(&driven(&cubic));
    let (_, rows) = table(&ok(&["run", &model, "--rows", "2", "--rtol", "1e-12"]));
    assert_close(&rows[1][1..3], &[2.0 - 2f64.sin(), 1.0 - 2f64.cos()], 1e-9);
}

/// A motion fails where its table ends, and is kept as far as it was reached.
#[test]
fn a_motion_ends_with_its_table() {
    let (_directory, model) = written(&driven("{ times = [0, 1], values = [0, 6] }"));
    let output = pc(&["run", &model, "--rows", "3"]);
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(5), "{text}");
    assert!(
        text.contains("the input `u` has no value at t = ") && text.contains("goes from 0 to 1"),
        "{text}"
    );
    let (_, rows) = table(&String::from_utf8(output.stdout).expect("text"));
    assert_close(&rows.last().expect("a row")[..2], &[1.0, 1.0], 1e-8);
}

#[test]
fn constant_inputs_are_set_and_varied_and_tables_are_not() {
    let (_directory, model) = written(&driven("3"));
    let (_, rows) = table(&ok(&["run", &model, "--rows", "2", "--set", "u=1"]));
    assert_close(&rows[1][1..3], &[2.0, 2.0], 1e-9);
    let (directory, model) = written(&driven("{ times = [0, 2], values = [0, 6] }"));
    let output = pc(&["run", &model, "--set", "u=1"]);
    assert_eq!(output.status.code(), Some(2), "{}", String::from_utf8_lossy(&output.stderr));
    let sweep = directory.path().join("x.csv").display().to_string();
    let output = pc(&["sweep", &model, "--vary", "u=0:1:2", "-o", &sweep]);
    assert_eq!(output.status.code(), Some(2), "{}", String::from_utf8_lossy(&output.stderr));
    let check = ok(&["check", &model]);
    assert!(check.contains("energy") && !check.contains("conserved (proved)"), "{check}");
}

/// The C source of a model with states and inputs contains both.
#[test]
fn source_has_states_and_takes_inputs_as_arguments() {
    let text =
        MOTOR.replace("ref = 1.0\n", "") + "[inputs]\nref = { times = [0, 1, 9], values = [0, 1, 1] }\n";
    let (directory, model) = written(&text);
    let out = directory.path().join("src").display().to_string();
    let output = pc(&["emit", &model, "--lang", "c", "-o", &out]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let header = fs::read_to_string(Path::new(&out).join("model.h")).expect("a header");
    assert!(header.contains("#define MODEL_STATES     2  /* first-order states */"), "{header}");
    assert!(
        header.contains("State: one coordinate, then one quasi-velocity, then 2 first-order states."),
        "{header}"
    );
    assert!(header.contains("The tables of inputs are not part of this source"), "{header}");
    assert!(!header.contains("T_END"), "a motion with a constant input would be another");
}

/// m ż = −∫ m g dt where the lost mass is left at rest, and z̈ = −g where it goes on falling: which of the two holds is said.
#[test]
fn a_mass_that_is_lost_leaves_at_rest_unless_a_force_says_otherwise() {
    let falling = |force: &str| {
        written(&format!(
            r#"
[parameters]
k = 0.1
g = 9.81
[states]
m = {{ rate = "-k", start = 1.0 }}
[coordinates]
z = 0
[bodies.drop]
mass = "m"
position = ["0", "0", "z"]
{force}
[gravity]
acceleration = [0, 0, "-g"]
[simulation]
t_end = 2
"#
        ))
    };
    let note = "the mass of drop changes in time: what is lost or taken up is at rest, D_t (m v) = F; for what leaves or comes \
                with a velocity u add the force d(m)*u";
    let speed = |force: &str| {
        let (_directory, model) = falling(force);
        let output = pc(&["run", &model, "--rows", "2"]);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        assert!(String::from_utf8_lossy(&output.stderr).contains(&format!("note: {note}\n")));
        table(&String::from_utf8(output.stdout).expect("text")).1[1][2]
    };
    // (m0 t − k t²/2)/(m0 − k t) of g, to the tolerance of the run
    assert_close(&[speed("")], &[-9.81 * 1.8 / 0.8], 1e-8);
    assert_close(&[speed("force = [0, 0, \"d(m)*z'\"]")], &[-9.81 * 2.0], 1e-8);
    let (_directory, model) = falling("");
    assert!(ok(&["check", &model]).contains(note));
}
