//! Second routes of derivatives, resets and verdicts, through the commands that users type.

use crate::piped::pc;

fn text(bytes: &[u8]) -> &str {
    std::str::from_utf8(bytes).expect("UTF-8")
}

/// z'' = −k, with bounces.
const BALL: &str = "[parameters]\nk = 2\n[coordinates]\nz = 1\n[lagrangian]\nkinetic = \"z'^2/2\"\npotential = \"k*z\"\n[events.bounce]\n\
                    when = \"z\"\ndirection = \"falling\"\nreset = { \"z'\" = \"-0.8*z'\" }\n[simulation]\nt_end = 3\nsamples = 3\n";

#[test]
fn derivatives_and_resets_are_compared_and_said() {
    let output = pc(BALL, &["run", "-", "--method", "adams", "--sensitivities", "k"]);
    let said = text(&output.stderr);
    assert!(output.status.success(), "{said}");
    assert!(said.contains("\n           the first state after each reset, by its definition\n"), "{said}");
    assert!(
        said.contains("\n           the rates of the derivatives at the end, by its differences, to "),
        "{said}"
    );
    let silent = pc(BALL, &["run", "-", "--method", "adams", "--sensitivities", "k", "--no-verify"]);
    assert!(!text(&silent.stderr).contains("by its"), "{}", text(&silent.stderr));
    assert_eq!(output.stdout, silent.stdout);
}

/// What vanishes at the start alone is refuted by states near it.
#[test]
fn what_changes_off_the_start_is_not_conserved() {
    let model = "[coordinates]\nx = 1\ny = 0.5\n[quasi_velocities]\n\"x'\" = -0.7\n\"y'\" = 0.3\n[lagrangian]\nkinetic = \"(x'^2 + y'^2)/2\"\n\
                 potential = \"y^2\"\n[integrals]\nflat = \"x'^2*(y - 0.5)^2*(y' - 0.3)^3\"\npx = \"x'\"\n";
    let output = pc(model, &["check", "-"]);
    let checked = text(&output.stdout);
    let flat =
        "flat    not conserved, though it does not change at the start; conserved where px = 0 (proved)\n";
    assert!(checked.contains(flat), "{checked}");
    assert!(checked.contains("px      conserved (proved)\n"), "{checked}");
}

/// Two masses of 1 and 2·10⁻⁶ on a spring of 10⁶: accelerations of 5·10¹¹ say nothing of which velocities are independent.
#[test]
fn a_stiff_spring_leaves_its_velocities_independent() {
    let model = "[coordinates]\nx = 0\ny = 0\n[lagrangian]\nkinetic = \"(x'^2 + 2e-6*y'^2)/2\"\npotential = \"1e6*(x - y)^2/2\"\n";
    let output = pc(model, &["linearize", "-", "--format", "json"]);
    let linear: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(linear["second_order"]["K"], serde_json::json!([[1e6, -1e6], [-1e6, 1e6]]), "{linear}");
}

/// ẍ = −x + 2 u with u(0) = 0.3 of a table: B = (0, 2), as for an input that is given by a number.
#[test]
fn the_derivative_by_an_input_of_a_table_agrees() {
    for input in ["0.3", "{ times = [-1, 0, 1], values = [0, 0.3, 0.1], interpolation = \"cubic\" }"] {
        let model = format!(
            "[coordinates]\nx = 0.5\n[lagrangian]\nkinetic = \"x'^2/2\"\npotential = \"x^2/2\"\n[inputs]\nu = {input}\n[forces]\nx = \"2*u\"\n"
        );
        let output = pc(&model, &["linearize", "-", "--at", "start", "--format", "json"]);
        assert!(output.status.success(), "{}", text(&output.stderr));
        let linear: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
        assert_eq!(linear["B"], serde_json::json!([[0.0], [2.0]]), "{linear}");
    }
}

/// At coarse tolerances the two forms are apart by errors of integration, which companions tell from a difference.
#[test]
fn errors_of_integration_are_no_difference() {
    let coarse = ["--t-end", "10", "--rtol", "1e-5", "--atol", "1e-8", "--rows", "21"];
    let forms =
        pc("", &[&["compare", "pendulum-chain", "--form", "poincare,canonical"], &coarse[..]].concat());
    let said = text(&forms.stdout);
    assert!(said.contains("allowed   3 times the errors of both\n"), "{said}");
    assert!(
        forms.status.success() && said.contains("verdict   the same motion in what is compared"),
        "{said}"
    );
    // A thousandth more of gravity is no error of integration.
    let other = BALL.replace("k = 2", "k = 2.002");
    let directory = tempfile::tempdir().expect("a directory");
    let file = directory.path().join("other.toml");
    std::fs::write(&file, other).expect("written");
    let pair = pc(BALL, &["compare", "-", file.to_str().expect("UTF-8"), "--rtol", "1e-5"]);
    assert_eq!(pair.status.code(), Some(1), "{}", text(&pair.stdout));
}

/// The overturned bicycle rests with φ, x and roll zero up to rounding, which is no unit of any of them.
#[test]
fn what_newton_leaves_of_zeros_is_no_unit() {
    let rest = ["x=1.0352770200567091e-16", "roll=1.3137e-28", "φ=3.141592653589793", "δ=-1.375041004822907"];
    let sets = rest.iter().flat_map(|value| ["--set", value]);
    let arguments: Vec<&str> =
        ["linearize", "whipple-bicycle", "--at", "start", "--set", "θ=-0.7176980208682097"]
            .into_iter()
            .chain(sets)
            .collect();
    let output = pc("", &arguments);
    assert!(output.status.success(), "{}", text(&output.stderr));
}

/// A matrix of a quaternion given to nine digits is a rotation times 1 + 4e-10.
#[test]
fn a_matrix_that_is_a_multiple_of_a_rotation_turns_alike() {
    for digits in [["q0=0.980066578", "q1=0.198669331"], ["q0=0.98", "q1=0.19"]] {
        let output = pc("", &["check", "rigid-body-spring", "--set", digits[0], "--set", digits[1]]);
        assert!(output.status.success(), "{}", text(&output.stderr));
        assert!(text(&output.stdout).contains("agrees to "), "{}", text(&output.stdout));
    }
}

/// Where the rates have no derivatives, no box helps.
#[test]
fn poles_are_named_as_such() {
    let said = |arguments: &[&str]| text(&pc("", arguments).stderr).to_owned();
    insta::assert_snapshot!(
        [
            said(&["equilibria", "spherical-pendulum-meridian"]),
            said(&["equilibria", "appell-hamel"]),
            said(&["linearize", "appell-hamel", "--at", "rest"]),
        ]
        .concat()
    );
}
