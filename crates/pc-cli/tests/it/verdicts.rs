//! Verdicts of `pc check` by theorems rather than by cancellation of terms.

use std::collections::BTreeMap;
use std::process::Command;
use std::sync::Mutex;

use crate::each_model::each;
use crate::piped::answer;
use pc_model::Builtin;
use serde_json::Value;

fn check(model: &str) -> String {
    answer(model, &["check", "-"])
}

/// The verdict on the energy.
#[track_caller]
fn energy(model: &str) -> String {
    let text = check(model);
    let words = text.lines().find_map(|line| {
        line.trim().strip_prefix("integrals").unwrap_or(line).trim().strip_prefix("energy ")
    });
    words.unwrap_or_else(|| panic!("{text}")).trim().to_owned()
}

/// A particle under a constraint such as ż = α(y) ẋ.
fn bound(constraint: &str, kinetic: &str) -> String {
    format!(
        "[coordinates]\nx = 1.0\ny = 0.0\nz = 0.0\n[quasi_velocities]\n\"x'\" = 1.0\n[constraints]\nc = \"{constraint}\"\n\
         [lagrangian]\nkinetic = \"{kinetic}\"\n"
    )
}

/// Homogeneous constraints do no work, so the rate of the energy need not be seen to cancel, which
/// roots would prevent.
#[test]
fn homogeneous_constraints_keep_the_energy() {
    let kinetic = "(x'^2 + y'^2 + z'^2)/2";
    for rate in ["1 + y^2", "sqrt(1 + y^2)", "sqrt(2 + sqrt(1 + y^2))"] {
        assert_eq!(energy(&bound(&format!("z' - y*x'/({rate})"), kinetic)), "conserved (proved)");
    }
    for not in [
        bound("z' - (y - t)*x'/sqrt(1 + y^2) - t", kinetic), // does work
        bound("z' - y*x'/sqrt(1 + y^2)", "(1 + t^2)*(x'^2 + y'^2 + z'^2)/2"),
        bound("z' - y*x'/sqrt(1 + y^2)", kinetic) + "[forces]\nx = \"-x'\"\n",
    ] {
        assert_ne!(energy(&not), "conserved (proved)");
    }
}

/// A pendulum on a cart, with its weight as a force on a body.
const CART: &str = "[coordinates]\ns = 0.0\nphi = 0.5\n[bodies.cart]\nmass = 2\nposition = [\"s\", 0, 0]\n[bodies.bob]\nmass = 1\n\
                    position = [\"s + sin(phi)/2\", 0, \"-cos(phi)/2\"]\nforce = [0, 0, -9.81]\n";

#[test]
fn weight_counts_in_the_energy() {
    assert_eq!(energy(CART), "conserved (proved)");
    let text = check(CART);
    assert!(text.contains("                     stable, by the second variation of the energy\n"), "{text}");
    // A bead on a turning hoop has Jacobi's integral, if there is no drag.
    let hoop = "[parameters]\nW = 3.0\n[coordinates]\nth = 0.05\n[bodies.bead]\nmass = 1\n\
                position = [\"sin(th)*cos(W*t)\", \"sin(th)*sin(W*t)\", \"-cos(th)\"]\nforce = [0, 0, -9.81]\n";
    assert_eq!(energy(hoop), "conserved (proved)");
    let dragged = energy(&format!("{hoop}[forces]\nth = \"-0.1*th'\"\n"));
    assert_eq!(dragged, "not conserved: dE/dt = -0.1 th'², 0 at the start");
}

/// The cart moves on for ever, while its pendulum comes to rest on it.
#[test]
fn damping_leaves_the_direction_of_a_momentum_neutral() {
    let text = check(&format!("{CART}[forces]\nphi = \"-0.2*phi'\"\n"));
    let verdict = "asymptotically stable except for one neutral direction, by the first approximation\n";
    assert!(text.contains(verdict), "{text}");
    // Without the integral of momentum, as with a force of higher order on the cart, that direction
    // is undecided.
    let pushed = check(&format!("{CART}[forces]\nphi = \"-0.2*phi'\"\ns = \"s'^3\"\n"));
    assert!(!pushed.contains("asymptotically"), "{pushed}");
}

fn json(arguments: &[&str]) -> Option<Value> {
    let output = Command::new(env!("CARGO_BIN_EXE_pc")).args(arguments).output().expect("pc runs");
    serde_json::from_slice(&output.stdout).ok()
}

/// `pc check` and `pc linearize` look at the same state, count the same eigenvalues and say the same of stability, with a
/// quaternion, constraints and cyclic coordinates or without; the table says what of each built-in model.
#[test]
fn check_and_linearize_agree_on_stability() {
    let table = Mutex::new(BTreeMap::new());
    each(Builtin::all(), |model| {
        let Some(check) = json(&["check", model.name, "--format", "json"]) else { return };
        let steady = &check["steady_motion"];
        let linearize = ["linearize", model.name, "--format", "json", "--cyclic", "drop"];
        let linear = if steady.is_null() { None } else { json(&linearize) };
        let verdict =
            steady["verdict"].as_str().unwrap_or("none is found, or the model depends on time").to_owned();
        table.lock().expect("no claim panics while it holds the lock").insert(model.name, verdict);
        let Some(linear) = linear else { return };
        let values = steady["state"].as_object().expect("names and values");
        let is_near = |(name, value): (&String, &Value)| {
            let (one, other) = (value.as_f64().unwrap_or(f64::NAN), linear["state"][name].as_f64());
            other.is_some_and(|other| (one - other).abs() <= 1e-7 * (1.0 + one.abs()))
        };
        assert!(values.iter().all(is_near), "{}: {steady} {}", model.name, linear["state"]);
        let count = |of: &Value| of["eigenvalues"].as_array().map(Vec::len);
        assert_eq!(count(steady), count(&linear), "{}", model.name);
        assert_eq!(steady["verdict"], linear["stability"], "{}", model.name);
    });
    let table = table.into_inner().expect("no claim panicked");
    let lines: Vec<String> = table.iter().map(|(name, verdict)| format!("{name:32} {verdict}")).collect();
    insta::assert_snapshot!(lines.join("\n"));
}

/// A particle in four dimensions under two constraints on its velocities.
fn bound_twice(first: &str, second: &str) -> String {
    format!(
        "[parameters]\nR = 0.37\n[coordinates]\nx = 0.1\ny = 0.2\nz = 0.3\nw = 0.4\n[constraints]\nk1 = \"{first}\"\nk2 = \"{second}\"\n\
         [lagrangian]\nkinetic = \"(x'^2 + y'^2 + z'^2 + w'^2)/2\"\n"
    )
}

/// The report on combinations of constraints.
#[track_caller]
fn combinations(model: &str) -> Vec<String> {
    let text = check(model);
    let lines = text.lines().map(|line| line.trim().trim_start_matches("constraints").trim());
    lines.filter(|line| line.contains("combination")).map(str::to_owned).collect()
}

/// Neither constraint binds positions alone.
#[test]
fn integrable_combinations_of_constraints_are_written() {
    for (first, second, said) in [
        // ż − y ẋ and ẇ − y ẋ: their difference is that of z and w.
        ("z' - y*x'", "w' - y*x'", "k1 - k2: z - w = const"),
        ("z' - y*x'", "w' + y*x'/2 + cos(z)*z'/2 + y'", "k1 + 2 k2: 2 y + z + 2 w + sin(z) = const"),
        // With a parameter.
        ("z' - R*y*x'", "w' - y*x'", "k1 - R k2: z - R w = const"),
        // With functions: dw is y dx divided by z, dz is y dx.
        ("z' - y*x'", "z*w' - y*x'", "-(1/z) k1 + (1/z) k2: w - ½ log(z²) = const"),
        // With the time.
        ("z' - y*x' - t", "w' - y*x'", "k1 - k2: z - w - ½ t² = const"),
    ] {
        assert_eq!(combinations(&bound_twice(first, second)), [format!("integrable combination  {said}")]);
    }
    // The chain of the n-trailer reaches all positions.
    assert!(combinations(&bound_twice("z' - y*x'", "w' - z*x'")).is_empty());
}

/// Two wheels of radius R on an axle of length 2 b: the difference of their angles determines the
/// direction of the axle.
#[test]
fn wheels_on_an_axle_determine_its_direction() {
    let axle = "[parameters]\nR = 0.25\nb = 0.4\n[coordinates]\nx = 0.0\ny = 0.0\npsi = 0.3\nleft = 0.0\nright = 0.0\n\
                [constraints]\nblade = \"y'*cos(psi) - x'*sin(psi)\"\n\
                k1 = \"x'*cos(psi) + y'*sin(psi) - b*psi' - R*left'\"\n\
                k2 = \"x'*cos(psi) + y'*sin(psi) + b*psi' - R*right'\"\n\
                [lagrangian]\nkinetic = \"(x'^2 + y'^2 + psi'^2 + left'^2 + right'^2)/2\"\n";
    let said = combinations(axle);
    assert_eq!(said, ["integrable combination  k1 - k2: R right - R left - 2 b psi = const"]);
}

/// They are counted although their integral, of Airy's kind, is not an elementary function.
#[test]
fn integrable_combinations_that_are_not_found_are_counted() {
    let model = bound_twice("z' - y*x'", "w' - y*x' - exp(z^2)*z'");
    assert_eq!(combinations(&model), ["1 integrable combination, not found in closed form"]);
}
