//! What `pc check` proves by theorems, not by terms that cancel.

use std::io::Write;
use std::process::{Command, Stdio};

fn check(model: &str) -> String {
    let mut child = Command::new(env!("CARGO_BIN_EXE_pc"))
        .args(["check", "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("pc starts");
    child.stdin.take().expect("a pipe").write_all(model.as_bytes()).expect("pc reads");
    let output = child.wait_with_output().expect("pc ends");
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("UTF-8")
}

/// What is said of the energy.
#[track_caller]
fn energy(model: &str) -> String {
    let text = check(model);
    let words = text.lines().find_map(|line| {
        line.trim().strip_prefix("integrals").unwrap_or(line).trim().strip_prefix("energy ")
    });
    words.unwrap_or_else(|| panic!("{text}")).trim().to_owned()
}

/// A particle whose velocities are bound by ż = α(y) ẋ.
fn bound(constraint: &str, kinetic: &str) -> String {
    format!(
        "[coordinates]\nx = 1.0\ny = 0.0\nz = 0.0\n[quasi_velocities]\n\"x'\" = 1.0\n[constraints]\nc = \"{constraint}\"\n\
         [lagrangian]\nkinetic = \"{kinetic}\"\n"
    )
}

/// Homogeneous constraints do no work, and what is left of the rate of the energy need not be seen to cancel; roots do not let
/// it be seen.
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

/// A pendulum on a cart under its weight, a force on a body.
const CART: &str = "[coordinates]\ns = 0.0\nphi = 0.5\n[bodies.cart]\nmass = 2\nposition = [\"s\", 0, 0]\n[bodies.bob]\nmass = 1\n\
                    position = [\"s + sin(phi)/2\", 0, \"-cos(phi)/2\"]\nforce = [0, 0, -9.81]\n";

#[test]
fn weight_counts_in_the_energy() {
    assert_eq!(energy(CART), "conserved (proved)");
    let text = check(CART);
    assert!(text.contains("                     stable, by the second variation of the energy\n"), "{text}");
    // A bead on a hoop that turns: Jacobi's integral but for the drag.
    let hoop = "[parameters]\nW = 3.0\n[coordinates]\nth = 0.05\n[bodies.bead]\nmass = 1\n\
                position = [\"sin(th)*cos(W*t)\", \"sin(th)*sin(W*t)\", \"-cos(th)\"]\nforce = [0, 0, -9.81]\n";
    assert_eq!(energy(hoop), "conserved (proved)");
    let dragged = energy(&format!("{hoop}[forces]\nth = \"-0.1*th'\"\n"));
    assert_eq!(dragged, "dE/dt = -0.1 th'², 0 at the start");
}

/// The cart goes on for ever, and its pendulum comes to rest on it.
#[test]
fn damping_leaves_the_direction_of_a_momentum_neutral() {
    let text = check(&format!("{CART}[forces]\nphi = \"-0.2*phi'\"\n"));
    let verdict = "asymptotically stable but for one neutral direction, by the first approximation\n";
    assert!(text.contains(verdict), "{text}");
    // Without the momentum, as with a force on the cart of higher order, nothing is known of that direction.
    let pushed = check(&format!("{CART}[forces]\nphi = \"-0.2*phi'\"\ns = \"s'^3\"\n"));
    assert!(!pushed.contains("asymptotically"), "{pushed}");
}

/// ż − y ẋ = 0 and ẇ − y ẋ = 0 both bind velocities alone, their difference z − w.
#[test]
fn integrable_combinations_of_constraints_are_counted() {
    let model = |second: &str| {
        format!(
            "[coordinates]\nx = 0.1\ny = 0.2\nz = 0.3\nw = 0.4\n[constraints]\na = \"z' - y*x'\"\nb = \"{second}\"\n[lagrangian]\n\
             kinetic = \"(x'^2 + y'^2 + z'^2 + w'^2)/2\"\n"
        )
    };
    let text = check(&model("w' - y*x'"));
    assert!(text.contains("b: nonholonomic, by 1 in a bracket\n"), "{text}");
    assert!(text.contains("one combination of the nonholonomic ones is integrable\n"), "{text}");
    assert!(!check(&model("w' - z*x'")).contains("combination"), "the n-trailer's chain reaches all places");
}
