//! Rest and steady motion under constraints, and in units of all sizes, against closed forms.

use std::fs;
use std::process::Command;

use serde_json::Value;

/// Newton's method ends at rounding; lengths are of order one.
const EXACT: f64 = 1e-9;

#[track_caller]
fn said(model: &str, arguments: &[&str]) -> Value {
    let directory = tempfile::tempdir().expect("a directory");
    let path = match model.contains('\n') {
        true => {
            fs::write(directory.path().join("model.toml"), model).expect("written");
            "model.toml"
        }
        false => model,
    };
    let (command, others) = arguments.split_first().expect("a command");
    let output = Command::new(env!("CARGO_BIN_EXE_pc"))
        .args([command, path, "--format", "json"])
        .args(others)
        .current_dir(directory.path())
        .output()
        .expect("pc starts");
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{text}");
    serde_json::from_slice(&output.stdout).expect("JSON")
}

/// The equilibria of a model.
#[track_caller]
fn equilibria(model: &str) -> Vec<Value> {
    said(model, &["equilibria"])["equilibria"].as_array().expect("a list").clone()
}

#[track_caller]
fn number(of: &Value) -> f64 {
    of.as_f64().unwrap_or_else(|| panic!("{of} is no number"))
}

/// The imaginary parts of the eigenvalues, those that are positive, in ascending order.
fn frequencies(of: &Value) -> Vec<f64> {
    let pairs = of["eigenvalues"].as_array().expect("eigenvalues");
    let mut all: Vec<f64> = pairs.iter().map(|pair| number(&pair[1])).filter(|omega| *omega > 0.0).collect();
    all.sort_by(f64::total_cmp);
    all
}

#[track_caller]
fn assert_near(found: f64, expected: f64) {
    assert!((found - expected).abs() <= EXACT * (1.0 + expected.abs()), "{found} {expected}");
}

/// At the lowest point of y = x², only x is a good coordinate; y occurs in the constraint alone, and is found by it.
#[test]
fn a_bead_rests_in_a_parabola() {
    let found = equilibria(
        r#"
[coordinates]
x = 0.5
y = 0.25
[constraints]
curve = "y - x^2"
[lagrangian]
kinetic = "(x'^2 + y'^2)/2"
potential = "9.81*y"
"#,
    );
    let [lowest] = found.as_slice() else { panic!("{found:?}") };
    assert!(["x", "y"].iter().all(|x| number(&lowest["state"][x]).abs() < EXACT), "{lowest}");
    assert_near(frequencies(lowest)[0], (2.0f64 * 9.81).sqrt());
    assert_eq!(lowest["verdict"], "stable, by the second variation of the energy");
}

/// The frequencies of two masses, the first on a spring 1 to the ground, joined by a spring k: ω⁴ − (2k + 1) ω² + k = 0.
#[test]
fn stiffness_does_not_keep_newton_from_its_one_step() {
    let k = 1e6f64;
    let found = equilibria(
        r#"
[coordinates]
x = 0.1
y = 0.2
[lagrangian]
kinetic = "(x'^2 + y'^2)/2"
potential = "1e6*(x - y)^2/2 + x^2/2"
"#,
    );
    let [rest] = found.as_slice() else { panic!("{found:?}") };
    assert!(["x", "y"].iter().all(|x| number(&rest["state"][x]).abs() < EXACT), "{rest}");
    let half = k + 0.5;
    let fast = half + (half * half - k).sqrt();
    for (found, square) in frequencies(rest).iter().zip([k / fast, fast]) {
        // The slow one is the difference of numbers 10⁶ times its square.
        assert!((found * found / square - 1.0).abs() < 1e-9, "{found} {square}");
    }
}

/// A first-order state with a time constant of a millisecond.
#[test]
fn a_fast_lag_is_at_rest() {
    let found = equilibria(
        r#"
[coordinates]
x = 0.1
[states]
i = { start = 0.0, rate = "(10*x + 3*x' - i)/1e-3" }
[lagrangian]
kinetic = "x'^2/2"
[forces]
x = "-i"
"#,
    );
    let [rest] = found.as_slice() else { panic!("{found:?}") };
    assert!(["x", "i"].iter().all(|x| number(&rest["state"][x]).abs() < EXACT), "{rest}");
    assert_eq!(rest["verdict"], "asymptotically stable, by the first approximation");
}

/// Two discs geared together, a spring on the first: ω² = k/(J1 + n² J2). The force λ at the teeth is that which
/// accelerates the second disc.
#[test]
fn geared_discs() {
    let model = r#"
[inputs]
T = 0.0
[coordinates]
a = 0.1
b = 0.3
[constraints]
gear = "b - 3*a"
[lagrangian]
kinetic = "a'^2/2 + 2*b'^2/2"
potential = "5*a^2/2"
[forces]
b = "T"
[outputs]
tooth = "λ_gear"
"#;
    let found = equilibria(model);
    let [rest] = found.as_slice() else { panic!("{found:?}") };
    assert_near(frequencies(rest)[0], (5.0f64 / 19.0).sqrt());
    let linear = said(model, &["linearize"]);
    let of = linear["components"][0].as_str().expect("a name").to_owned();
    let by_a = number(&linear["C"][0][0]) * if of == "b" { 3.0 } else { 1.0 };
    // λ = 2 b'' − T with b'' = 3 a'' = 3 (3 T − 5 a)/19.
    assert_near(by_a, -30.0 / 19.0);
    assert_near(number(&linear["D"][0][0]), -1.0 / 19.0);
}

/// The tension of the rod of a pendulum in Cartesian coordinates is its weight, at the bottom and at the top.
#[test]
fn a_rod_bears_the_weight() {
    let found = equilibria(
        r#"
[coordinates]
x = "sin(0.5)"
z = "-cos(0.5)"
[constraints]
rod = "x^2 + z^2 - 1"
[bodies.bob]
mass = 1.0
position = ["x", 0, "z"]
force = [0, 0, -9.81]
[outputs]
tension = "sqrt(F_rod_bob_x^2 + F_rod_bob_z^2)"
"#,
    );
    assert_eq!(found.len(), 2);
    for (one, z) in found.iter().zip([-1.0, 1.0]) {
        assert_near(number(&one["state"]["z"]), z);
        assert_near(number(&one["outputs"]["tension"]), 9.81);
    }
    assert_eq!(found[0]["verdict"], "stable, by the second variation of the energy");
    assert_eq!(found[1]["verdict"], "unstable, by the first approximation");
}

/// A weight on a string that wraps round a cylinder hangs at any length: a family, and not as many entries as there are
/// starts.
#[test]
fn a_family_is_one_entry_for_each_kind_of_stability() {
    let found = equilibria(
        r#"
[coordinates]
"θ" = -0.4
L = 0.5
[constraints]
string = "L' + 0.03*θ'"
[bodies.weight]
mass = 0.1
position = ["0.03*cos(θ) - L*sin(θ)", "0.03*sin(θ) + L*cos(θ)", 0]
[gravity]
acceleration = [0, 9.81, 0]
"#,
    );
    assert!(found.len() <= 4, "{}", found.len());
    for one in &found {
        assert_eq!(one["family"], 1, "{one}");
        let angle = number(&one["state"]["θ"]);
        assert!(angle.abs() < EXACT || (angle - std::f64::consts::PI).abs() < EXACT, "{angle}");
    }
}

/// Two wheels on an axle roll down a slope: the drag 2·0.05 v/r² of the wheels balances the weight. As the velocities along
/// the slope and across it are not independent where the axle lies along the slope, the wheels' rates are.
#[test]
fn an_axle_rolls_straight_down() {
    let linear = said(
        r#"
[coordinates]
x = 0.0
y = 0.0
"ψ" = 0.5
qL = 0.0
qR = 0.0
[quasi_velocities]
"ψ'" = 0.7
"qL'" = 20.0
[definitions]
vx = "cos(ψ)*x' + sin(ψ)*y'"
vy = "-sin(ψ)*x' + cos(ψ)*y'"
[constraints]
left = "vx - 0.4*ψ' - 0.25*qL'"
across = "vy"
right = "vx + 0.4*ψ' - 0.25*qR'"
[lagrangian]
kinetic = "3/2*(vx^2 + (vy + 0.15*ψ')^2) + 0.4*ψ'^2 + x'^2 + y'^2 + 0.16*ψ'^2 + 0.0156*(qL'^2 + qR'^2)"
potential = "-9.81*sin(0.2)*(5*x + 3*0.15*cos(ψ))"
[forces]
"qL'" = "-0.05*qL'"
"qR'" = "-0.05*qR'"
[outputs]
grip = "λ_left"
"#,
        &["linearize"],
    );
    let speed = 9.81 * 0.2f64.sin() * 5.0 * 0.0625 / 0.1;
    assert!(number(&linear["state"]["ψ"]).abs() < EXACT, "{}", linear["state"]);
    assert_near(number(&linear["left_out"]["x"]), speed);
    // Each wheel is braked by 0.05 q' about its axle, r λ at the ground.
    assert_near(number(&linear["output_values"][0]), -0.05 * speed / 0.0625);
    assert_eq!(linear["stability"], "asymptotically stable, by the first approximation");
}

/// A particle on a turning hoop of radius one in a plane that turns freely: at θ from the lowest point ψ'² cos θ = g. The
/// energy has a minimum among the states of the same momentum, so that the steady motion is stable. The particle has
/// Cartesian coordinates, so that this is the minimum of an effective potential under a constraint.
#[test]
fn a_conical_pendulum_on_a_constraint_is_stable() {
    let linear = said(
        r#"
[coordinates]
"ψ" = 0.0
x = "sin(0.9)"
z = "-cos(0.9)"
[quasi_velocities]
"ψ'" = 4.0
[constraints]
rod = "x^2 + z^2 - 1"
[lagrangian]
kinetic = "(x'^2 + z'^2 + (x^2 + 0.2)*ψ'^2)/2"
potential = "9.81*z"
"#,
        &["linearize"],
    );
    let rate = number(&linear["state"]["ψ'"]);
    assert_near(rate * rate * -number(&linear["state"]["z"]), 9.81);
    assert_eq!(linear["stability"], "stable, by the second variation of the energy");
}

/// Six legs with springs and dampers hold a plate; nothing of it is cyclic.
#[test]
fn a_stewart_platform_settles() {
    let linear = said("stewart-platform", &["linearize", "--at", "rest", "--no-verify"]);
    assert_eq!(linear["stability"], "asymptotically stable, by the first approximation");
    // All legs are alike: each strut bears a sixth of what the plate, the struts and the tubes weigh, along its axis.
    let struts: Vec<f64> = (1..=6).map(|leg| number(&linear["state"][format!("strut{leg}")])).collect();
    assert!(struts.iter().all(|strut| (strut - struts[0]).abs() < EXACT), "{struts:?}");
    assert_eq!(linear["left_out"], Value::Object(serde_json::Map::new()));
}

/// Lengths in micrometres and kilometres, stiffnesses from 1e-8 to 1e8: one equilibrium, whose place, frequency and
/// reaction have all digits.
#[test]
fn units_do_not_matter() {
    for (x, mass) in [(1e-8, 1e8), (1e-4, 1.0), (1.0, 1e-6), (1e7, 1e-3)] {
        let found = equilibria(&format!(
            r#"
[coordinates]
x = {x:e}
y = 0.5
[constraints]
tie = "x/{x:e} - 2*y"
[lagrangian]
kinetic = "{mass:e}*(x'/{x:e})^2/2 + y'^2*{mass:e}/2"
potential = "{mass:e}*(3*(x/{x:e})^2/2 - 5*y)"
[outputs]
pull = "λ_tie/{mass:e}"
"#
        ));
        let [rest] = found.as_slice() else { panic!("{x}: {found:?}") };
        // With ξ = x/length = 2 y: T = 5 y'²/2, V = 6 y² − 5 y, and λ balances 3 ξ.
        assert_near(number(&rest["state"]["y"]), 5.0 / 12.0);
        assert_near(number(&rest["state"]["x"]) / x, 5.0 / 6.0);
        assert_near(frequencies(rest)[0], (12.0f64 / 5.0).sqrt());
        assert_near(number(&rest["outputs"]["pull"]), 2.5);
    }
}

/// A pendulum of unit length and mass 2, held at 30° by a moment: M = m g l sin θ, and the frequency is √(g cos θ/l).
#[test]
fn an_input_that_is_free_holds_a_pendulum_aside() {
    let held = said(
        "[parameters]\nm = 2.0\ng = 9.81\n[inputs]\nM = 0.0\n[coordinates]\n\"φ\" = \"pi/6\"\n\
         [lagrangian]\nkinetic = \"m*φ'^2/2\"\npotential = \"-m*g*cos(φ)\"\n[forces]\n\"φ\" = \"M\"\n",
        &["linearize", "--free", "M"],
    );
    assert_near(number(&held["chosen_inputs"]["M"]), 9.81);
    assert_near(number(&held["state"]["φ"]), std::f64::consts::FRAC_PI_6);
    assert_near(frequencies(&held)[0], (9.81 * 3.0_f64.sqrt() / 2.0).sqrt());
    assert_near(number(&held["B"][1][0]), 0.5);
}

/// A drone on four propellers climbs at 0.2 with a quarter of its weight on each.
#[test]
fn a_drone_climbs_steadily() {
    let still = ["--set", "p=0", "--set", "q=0", "--set", "s=0", "--free", "f1,f2,f3,f4,θ,φ"];
    let climb = said("quadrotor", &[&["linearize"][..], &still].concat());
    for propeller in ["f1", "f2", "f3", "f4"] {
        assert_near(number(&climb["chosen_inputs"][propeller]), 0.5 * 9.81 / 4.0);
    }
    assert_near(number(&climb["state"]["v_z"]), 0.2);
    assert_near(number(&climb["state"]["θ"]), 0.0);
}
