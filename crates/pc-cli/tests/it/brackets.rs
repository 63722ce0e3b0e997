//! Brackets that the frame does not determine: given in `[algebra]`, found, or requested by an
//! error.

use std::process::Output;

use crate::piped::pc;

fn stderr(output: &Output) -> String {
    let text = String::from_utf8(output.stderr.clone()).expect("UTF-8");
    assert!(!text.contains("panicked"), "{text}");
    text
}

#[track_caller]
fn stdout(model: &str, arguments: &[&str]) -> String {
    let output = pc(model, arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    String::from_utf8(output.stdout).expect("UTF-8")
}

/// The last row of a table.
#[track_caller]
fn end(model: &str, arguments: &[&str]) -> Vec<f64> {
    let table = stdout(model, &[&["run", "-"], arguments].concat());
    let last = table.lines().last().expect("a row");
    last.split(',').map(|cell| cell.parse().expect("a number")).collect()
}

/// The lines under a heading of `pc derive`.
#[track_caller]
fn section(model: &str, arguments: &[&str], heading: &str) -> String {
    let text = stdout(model, &[&["derive", "-"], arguments].concat());
    let lines = text.lines().skip_while(|&line| line != heading).skip(1).take_while(|line| !line.is_empty());
    lines.map(|line| format!("{}\n", line.trim())).collect()
}

/// Bianchi's type V, with a constraint on the third quasi-velocity: ω_1' = ω_2², ω_2' = −ω_1 ω_2,
/// so that ω_1 = R tanh(R t + artanh(1/R)) with R² = 5/4.
const HELD: &str = r#"
[coordinates]
q = 0.0
[quasi_velocities]
w1 = 1.0
w2 = 0.5
w3 = 0.0
[kinematics]
q = "w1"
[algebra]
name = "bianchi5"
[constraints]
k = "2*w3"
[lagrangian]
kinetic = "(w1^2 + w2^2 + w3^2)/2"
[simulation]
t_end = 1.0
samples = 2
"#;

#[test]
fn a_given_algebra_holds_in_every_form() {
    let r = 1.25f64.sqrt();
    let angle = r + (1.0 / r).atanh();
    let expected = [1.0, (angle.cosh() / (1.0 / r).atanh().cosh()).ln(), r * angle.tanh(), r / angle.cosh()];
    let bare = HELD.replace("2*w3", "w3");
    for (model, form) in [(HELD, "poincare"), (HELD, "canonical"), (&bare, "poincare"), (&bare, "canonical")]
    {
        let found = end(model, &["--form", form]);
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-7, "{form}: {found}, not {expected}"); // rtol 1e-9 over 50 steps
        }
    }
    assert_eq!(section(HELD, &[], "Brackets"), "[w1, w2] = -w2\n");
    assert_eq!(section(HELD, &[], "Equations"), "w1' = w2²\nw2' = -w1 w2\n");
    assert_eq!(section(HELD, &["--form", "canonical"], "Equations"), "p_w1' = p_w2²\np_w2' = -p_w1 p_w2\n");
    assert!(!stdout(HELD, &["check", "-"]).contains("w2  conserved"));
}

/// A model without coordinates.
#[test]
fn a_given_algebra_needs_no_coordinates() {
    let model = HELD.replace("[coordinates]\nq = 0.0\n", "").replace("[kinematics]\nq = \"w1\"\n", "");
    let (usual, canonical) = (end(&model, &[]), end(&model, &["--form", "canonical"]));
    for (usual, canonical) in usual.iter().zip(&canonical) {
        assert!((usual - canonical).abs() < 1e-7, "{usual} {canonical}");
    }
    assert_eq!(section(&model, &[], "Equations"), "w1' = w2²\nw2' = -w1 w2\n");
    stdout(&model, &["check", "-"]);
}

/// A top in Poisson's variables whose axis glides along a plane through the pole.
#[test]
fn a_top_with_a_held_coordinate_moves_alike_in_all_forms() {
    let model = r#"
[coordinates]
"γ1" = 0.48
"γ2" = 0.6
"γ3" = 0.64
[quasi_velocities]
w1 = 0.3
w2 = 0.225
w3 = 0.0
[kinematics]
"γ1" = "γ2*w3 - γ3*w2"
"γ2" = "γ3*w1 - γ1*w3"
"γ3" = "γ1*w2 - γ2*w1"
[algebra]
name = "so3"
[constraints]
plane = "4*γ1 + 3*γ2 - 3.72"
[lagrangian]
kinetic = "(w1^2 + 2*w2^2 + 0.5*w3^2)/2"
potential = "γ3"
[simulation]
t_end = 1.0
samples = 2
"#;
    let found = end(&model.replace("[algebra]\nname = \"so3\"\n", ""), &[]);
    for form in ["poincare", "canonical"] {
        for (one, other) in end(model, &["--form", form]).iter().zip(&found) {
            assert!((one - other).abs() < 1e-6, "{form}: {one} {other}");
        }
    }
}

#[track_caller]
fn refused(model: &str, code: i32, beginning: &str) {
    for command in ["run", "check", "derive"] {
        let output = pc(model, &[command, "-"]);
        let text = stderr(&output);
        assert_eq!(output.status.code(), Some(code), "{text}");
        assert!(text.starts_with(beginning), "{text}");
    }
}

const DEPENDENT: &str = r#"
[coordinates]
q = 0.0
[quasi_velocities]
w1 = 1.0
w2 = 0.5
[kinematics]
q = "w1 + 2*w2"
[lagrangian]
kinetic = "(w1^2 + 3*w2^2)/2"
potential = "cos(q)"
[simulation]
t_end = 1.0
"#;

#[test]
fn brackets_that_the_frame_leaves_open_are_asked_for() {
    let words = "the frame does not determine the brackets of the quasi-velocities:";
    let cases = [
        ("w1 + 2*w2", format!("pc: <stdin>:6:1: [quasi_velocities] w2: {words} 2*w1 - w2 acts as zero")),
        ("w1*cos(q)", format!("pc: <stdin>:6:1: [quasi_velocities] w2: {words} w2 acts as zero")),
        ("t*w1 - w2", format!("pc: <stdin>:6:1: [quasi_velocities] w2: {words} (-1/t)*w1 - w2 acts as zero")),
    ];
    for (rate, beginning) in cases {
        refused(&DEPENDENT.replace("w1 + 2*w2", rate), 4, &beginning);
    }
    let help = "help: give the brackets in [algebra]: `name = \"so3\"` or `brackets = { \"w1,w2\" = \"w3\" }`, or `{}` if";
    assert!(stderr(&pc(DEPENDENT, &["check", "-"])).contains(help));
    // Any multiple of 2 w1 − w2 is possible.
    for (brackets, expected) in
        [("{}", "all operators commute\n"), ("{ \"w1,w2\" = \"2*w1 - w2\" }", "[w1, w2] = 2 w1 - w2\n")]
    {
        let model = format!("{DEPENDENT}[algebra]\nbrackets = {brackets}\n");
        assert_eq!(section(&model, &[], "Brackets"), expected);
    }
    let wrong = format!("{DEPENDENT}[algebra]\nbrackets = {{ \"w1,w2\" = \"w1\" }}\n");
    refused(
        &wrong,
        4,
        "pc: <stdin>:15:15: [algebra] brackets.w1,w2: the bracket of w1 and w2 given in [algebra] contradicts",
    );
}

/// Without the attitude of a body as coordinates, only the algebra gives Euler's terms.
#[test]
fn a_body_without_attitude_needs_its_algebra() {
    let body = r#"
[coordinates]
x = 0.0
[quasi_velocities]
w1 = 0.1
w2 = -0.2
w3 = 3.0
v = 1.0
[kinematics]
x = "v"
[bodies.top]
mass = 1
position = ["x", 0, 0]
inertia = [1, 2, 3]
angular_velocity = ["w1", "w2", "w3"]
[simulation]
t_end = 1.0
"#;
    refused(body, 4, "pc: <stdin>:5:1: [quasi_velocities] w1: the frame does not determine the brackets");
    let given = format!(
        "{body}[algebra]\nbrackets = {{ \"w1,w2\" = \"w3\", \"w2,w3\" = \"w1\", \"w3,w1\" = \"w2\" }}\n"
    );
    let equations = section(&given, &[], "Equations");
    assert!(equations.contains("w1'   = -w2 w3\n"), "{equations}");
}

/// γ̇ = γ × (σ ω + Ω(t)).
#[test]
fn brackets_found_contain_parameters_and_time() {
    let model = r#"
[parameters]
a = 0.7
[coordinates]
"γ1" = 0.9
"γ2" = 0.1
"γ3" = 0.2
[quasi_velocities]
w1 = 0.1
w2 = -0.2
w3 = 3.0
[kinematics]
"γ1" = "γ2*(a*w3 + cos(t)) - γ3*0.37*w2"
"γ2" = "γ3*w1 - γ1*(a*w3 + cos(t))"
"γ3" = "γ1*0.37*w2 - γ2*w1"
[lagrangian]
kinetic = "(w1^2 + w2^2 + w3^2)/2"
[simulation]
t_end = 1.0
"#;
    assert_eq!(
        section(model, &[], "Brackets"),
        "[t, w1] = (100/37 cos(t)) w2\n[t, w2] = -0.37 cos(t) w1\n\
         [w1, w2] = (0.37/a) w3\n[w1, w3] = -(100/37 a) w2\n[w2, w3] = 0.37 a w1\n"
    );
}

#[test]
fn an_impossible_algebra_is_refused_at_its_name() {
    let named = |name: &str| HELD.replace("bianchi5", name);
    refused(
        &named("so17"),
        4,
        "pc: <stdin>:11:8: [algebra] name: so(n) is available up to n = 12, not for n = 17\n",
    );
    refused(
        &named("so3"),
        4,
        "pc: <stdin>:11:8: [algebra] name: the bracket of w2 and w3 given in [algebra] contradicts",
    );
}

/// Elroy's beanie: its equations contain parameters, not their values.
#[test]
fn the_canonical_equations_of_two_coupled_bodies() {
    let model = r#"
[parameters]
I1 = 2.0
I2 = 1.0
k = 3.0
[coordinates]
th = 0
ps = 1.0
[quasi_velocities]
"ps'" = 0.0
"th'" = 0.0
[lagrangian]
kinetic = "I1/2*th'^2 + I2/2*(th'+ps')^2"
potential = "k*(1-cos(ps))"
[simulation]
t_end = 20
"#;
    assert_eq!(
        section(model, &["--form", "canonical"], "Kinematics"),
        "th' = (p_th - p_ps)/I1\nps' = (p_ps (I1 + I2)/I2 - p_th)/I1\n"
    );
    assert_eq!(section(model, &["--form", "canonical"], "Equations"), "p_th' = 0\np_ps' = -k sin(ps)\n");
}
