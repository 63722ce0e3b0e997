//! The report of `pc check`.

use std::process::{Command, Output};

use crate::each_model::{answer, each};
use serde_json::{Value, json};

const LAGRANGE: &str = "\
Heavy top of Lagrange
  coordinates        n = 3   γ1, γ2, γ3
  quasi-velocities   k = 3   ω1, ω2, ω3
  rank of the frame  2 of 3, brackets given
                     1 integrable constraint f(x) = const holds by the frame
  closure            holds identically
  Jacobi identity    holds identically
  algebra            so3, constant structure coefficients
  constraints        none
  mass matrix        symmetric, rank 3 of 3
  start              γ1 = 0.6, γ2 = 0, γ3 = 0.8, ω1 = 0.1, ω2 = -0.2, ω3 = 3
  rates there        finite at t = 0, the largest 1.72
  operations         parameters free   22 = 3 div + 5 fma + 10 mul + 1 neg + 3 sub
                     parameters bound  10 = 5 fma + 4 mul + 1 neg
  second derivation  agrees at 100 states
  integrals          area    conserved (proved), a Casimir
                     norm    conserved (proved), a Casimir
                     spin    conserved for these parameters (proved)
                     energy  conserved (proved)
  invariant measure  dx dy, and so dx dη, Liouville's
  steady motion      γ1 = 0, γ2 = 0, γ3 = 1, ω1 = 0, ω2 = 0, ω3 = 3
                     0.671 from the start, with its norm, spin
                     eigenvalues 0.6614 ± 2.25i, 0, -0.6614 ± 2.25i
                     unstable, by the first approximation
";

const EULER: &str = "\
Euler's top
  coordinates        n = 0
  quasi-velocities   k = 3   ω1, ω2, ω3
  rank of the frame  0 of 3, brackets given
  closure            holds identically
  Jacobi identity    holds identically
  algebra            so3, constant structure coefficients
  constraints        none
  mass matrix        symmetric, rank 3 of 3
  start              ω1 = 1, ω2 = 0, ω3 = 1
  rates there        finite at t = 0, the largest 1
  operations         parameters free   13 = 3 div + 6 mul + 1 neg + 3 sub
                     parameters bound  6 = 4 mul + 2 neg
  second derivation  agrees at 100 states
  integrals          momentum  conserved (proved), a Casimir
                     energy    conserved (proved)
  invariant measure  dx dy, and so dx dη, Liouville's
  steady motion      ω1 = 0, ω2 = 0, ω3 = 1
                     1 from the start
                     eigenvalues ±1i, 0
                     stable, by the second variation of the energy
";

const INDUCTION: &str = "\
Charged particle in a pulsating magnetic field
  coordinates        n = 2   ρ, φ
  quasi-velocities   k = 2   η1, η2
  rank of the frame  2 of 2, brackets from the frame
  holonomic          η1 = d(ρ)/dt
  closure            holds identically
  Jacobi identity    holds identically
  algebra            none: the structure coefficients depend on the state or on time
  constraints        none
  mass matrix        symmetric, rank 2 of 2
  start              ρ = 1, φ = 0, η1 = 0.5, η2 = 1
  rates there        finite at t = 0, the largest 2
  operations         parameters free   16 = 1 add + 1 cos + 1 div + 3 fma + 8 mul + 1 neg + 1 sin
                     parameters bound  14 = 1 add + 1 cos + 1 div + 3 fma + 6 mul + 1 neg + 1 sin
  second derivation  agrees at 100 states
  integrals          momentum  conserved (proved)
                     energy    dE/dt = -½ B0 ε ρ η2 cos(t), -0.25 at the start
  invariant measure  ρ dx dy, and so dx dη, Liouville's
  steady motion      not looked for: the model depends on time
";

const PLANE: &str = "[parameters]\nm = 2.0\n[coordinates]\nx = 1.0\ny = 0.0\n[quasi_velocities]\n\"y'\" = 0.5\n\
                     [lagrangian]\nkinetic = \"m*(x'^2 + y'^2)/2\"\npotential = \"exp(-x^2 - y^2)\"\n";

const BRACKETS: &str = "[coordinates]\n[quasi_velocities]\na = 1.0\nb = 0.5\nc = 0.2\n[algebra]\n\
                        brackets = { \"a,b\" = \"b\", \"a,c\" = \"2*c\" }\n\
                        [lagrangian]\nkinetic = \"(a^2 + b^2 + c^2)/2\"\n";

const PENDULUM: &str = "[parameters]\ndrag = 0.1\n[coordinates]\nq = 2.0\n[lagrangian]\nkinetic = \"q'^2/2\"\n\
                        potential = \"-cos(q)\"\ndissipation = \"drag*q'^2/2\"\n";

/// A particle on a cylinder x² + y² = const, pulled to one side, in a frame of two operators in
/// three coordinates.
const CYLINDER: &str = "[coordinates]\nx = 0.6\ny = 0.8\nz = 0.3\n[quasi_velocities]\nu = 0.7\nw = 0.0\n[kinematics]\n\
                        x = \"-y*u\"\ny = \"x*u\"\nz = \"w\"\n[lagrangian]\n\
                        kinetic = \"(u^2*(x^2 + y^2) + w^2)/2\"\npotential = \"z^2 - x\"\n";

fn run(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pc")).args(arguments).output().expect("pc starts")
}

fn stdout(output: &Output) -> String {
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout.clone()).expect("UTF-8")
}

fn check(model: &str) -> String {
    stdout(&run(&["check", model]))
}

/// The report on a built-in model, or on the text of one.
fn report(model: &str) -> Value {
    if !model.contains('\n') {
        return serde_json::from_str(&stdout(&run(&["check", model, "--format", "json"]))).expect("JSON");
    }
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("model.toml");
    std::fs::write(&path, model).expect("written");
    report(path.to_str().expect("UTF-8"))
}

fn integral(report: &Value, name: &str) -> Value {
    let integrals = report["integrals"].as_array().expect("a list").iter();
    integrals.clone().find(|integral| integral["name"] == name).unwrap_or(&Value::Null).clone()
}

fn without_integrals(model: &str) -> String {
    let text = pc_model::Builtin::named(model).expect("a model").text;
    let (before, rest) = text.split_once("[integrals]").expect("integrals");
    let (_, after) = rest.split_once("\n[").expect("another table");
    let project = "project = [\"norm\"]";
    format!("{before}[{after}").replace(project, "")
}

/// The report without the digits of the second derivation, which depend on the processor.
fn without_digits(report: &str) -> String {
    let (before, rest) = report.split_once("second derivation  agrees to ").expect("an agreement");
    let (digits, after) = rest.split_once(' ').expect("more");
    assert!(digits.parse::<f64>().is_ok_and(|error| error < 1e-13), "{digits}");
    format!("{before}second derivation  agrees {after}")
}

#[test]
fn a_check_in_print() {
    assert_eq!(without_digits(&check("heavy-top-lagrange")), LAGRANGE);
    assert_eq!(without_digits(&check("euler-top")), EULER);
    assert_eq!(without_digits(&check("charged-particle-induction")), INDUCTION);
}

#[test]
fn every_check_fits_on_a_screen() {
    each(pc_model::BUILTIN, |model| {
        let text = String::from_utf8(answer(&["check", model.name]).stdout).expect("UTF-8");
        assert!(text.lines().count() <= 31, "{text}");
        assert!(text.lines().all(|line| line.chars().count() <= 130), "{text}");
    });
}

#[test]
fn integrals_are_found_where_none_are_declared() {
    let lagrange = report(&without_integrals("heavy-top-lagrange"));
    let expected = [
        ("energy", "energy", "conserved (proved)"),
        ("momentum of ω3", "cyclic displacement", "conserved for these parameters (proved)"),
        ("Casimir 1", "Casimir", "conserved (proved)"),
        ("Casimir 2", "Casimir", "conserved (proved)"),
    ];
    let found: Vec<[&str; 3]> = lagrange["integrals"]
        .as_array()
        .expect("a list")
        .iter()
        .map(|integral| ["name", "how", "verdict"].map(|key| integral[key].as_str().expect("text")))
        .collect();
    assert_eq!(found, expected.map(|(name, how, verdict)| [name, how, verdict]));
    assert_eq!(integral(&lagrange, "Casimir 1")["expression"], "γ1^2 + γ2^2 + γ3^2");
    assert_eq!(integral(&lagrange, "Casimir 2")["expression"], "I1*γ1*ω1 + I2*γ2*ω2 + I3*γ3*ω3");

    let euler = report(&without_integrals("euler-top"));
    assert_eq!(integral(&euler, "Casimir 1")["expression"], "I1^2*ω1^2 + I2^2*ω2^2 + I3^2*ω3^2");

    // The area integral, linear in ω with products of the q, is neither a momentum of the frame nor
    // a Casimir.
    let quaternion = report(&without_integrals("heavy-top-quaternion"));
    assert_eq!(integral(&quaternion, "Casimir 1")["expression"], "q0^2 + q1^2 + q2^2 + q3^2");
    assert_eq!(integral(&quaternion, "found 1")["how"], "found");
    assert_eq!(integral(&quaternion, "found 2"), Value::Null);
    assert_eq!(integral(&report("heavy-top-quaternion"), "found 1"), Value::Null, "it is declared");

    let plane = report(PLANE);
    assert_eq!(integral(&plane, "found 1")["expression"], "y*x' - x*y'");
    assert_eq!(integral(&plane, "found 2"), Value::Null);
    assert_eq!(plane["integrals"].as_array().map(Vec::len), Some(2));
}

#[test]
fn casimirs_are_not_kept_under_forces() {
    let text = without_integrals("euler-top");
    let dragged = text.replace("[lagrangian]", "[lagrangian]\ndissipation = \"(ω1^2 + ω2^2 + ω3^2)/10\"");
    let report = report(&dragged);
    assert_eq!(integral(&report, "Casimir 1"), Value::Null);
    let energy = integral(&report, "energy");
    assert_eq!(energy["rate_at_start"], -0.4);
    assert!(energy["rate"].as_str().expect("a formula").contains("ω2^2"));
    assert_eq!(report["steady_motion"]["verdict"], "asymptotically stable, by the first approximation");
}

/// The momenta and the accelerations contain roots.
#[test]
fn energy_and_momentum_of_a_fast_particle_are_conserved() {
    let report = report("relativistic-particle");
    for name in ["energy", "momentum"] {
        assert_eq!(integral(&report, name)["verdict"], "conserved (proved)", "{name}");
    }
}

#[test]
fn a_frame_is_described() {
    let object = |model: &str| {
        let report = report(model);
        (report["frame_constraints"].clone(), report["holonomic"].clone())
    };
    let (constraints, holonomic) = object("charged-particle");
    assert_eq!(constraints, json!({ "count": 0 }));
    let expected = json!([
        { "name": "η1", "holonomic": true, "coordinate": "ρ" },
        { "name": "η2", "holonomic": false, "bracket": ["η1", "η2"] },
    ]);
    assert_eq!(holonomic, expected);
    let (constraints, holonomic) = object("heavy-top-quaternion");
    assert_eq!(constraints, json!({ "count": 1, "integrable": true, "of": "f(x)" }));
    assert!(holonomic.as_array().expect("a list").iter().all(|eta| eta["holonomic"] == false));
    assert!(
        check("damped-oscillator").contains("  holonomic          all, the velocities of the coordinates\n")
    );
    assert!(check("heavy-top-quaternion").contains("  holonomic          none\n"));
    // A frame of rank 2 does not determine three quasi-velocities.
    assert_eq!(object("heavy-top-lagrange").1, json!([]));

    let (constraints, holonomic) = object(CYLINDER);
    assert_eq!(constraints["count"], 1);
    assert!(holonomic.as_array().expect("a list").iter().all(|eta| eta["holonomic"] == true));
}

#[test]
fn an_algebra_outside_the_catalogue_is_classified() {
    let expected = "constant structure coefficients, not one of the catalogue: solvable, rank 1, index 1";
    assert_eq!(report(BRACKETS)["algebra"], expected);
}

#[test]
fn the_nearest_steady_motion_is_judged() {
    let steady = report("heavy-top-lagrange")["steady_motion"].clone();
    // The upright top with ω3 = 3 as at the start; C²ω3² < 4 A mgl: it does not sleep.
    for (name, expected) in [("γ1", 0.0), ("γ3", 1.0), ("ω1", 0.0), ("ω3", 3.0)] {
        let value = steady["state"][name].as_f64().expect("a number");
        assert!((value - expected).abs() < 1e-9, "{name} = {value}: Newton's method ends at the rounding");
    }
    assert_eq!(steady["same"], json!(["norm", "spin"]));
    assert_eq!(steady["first_approximation"], "unstable");
    // γ keeps its length.
    assert_eq!(steady["eigenvalues"].as_array().map(Vec::len), Some(5));

    let steady = report("euler-top")["steady_motion"].clone();
    assert_eq!(steady["state"], json!({ "ω1": 0.0, "ω2": 0.0, "ω3": 1.0 }));
    assert_eq!(steady["verdict"], "stable, by the second variation of the energy");

    let steady = report("charged-particle")["steady_motion"].clone();
    assert_eq!(steady["verdict"], "stable, by the second variation of the energy");

    let steady = report(CYLINDER)["steady_motion"].clone();
    let square = |name: &str| steady["state"][name].as_f64().expect("a number").powi(2);
    assert!((square("x") + square("y") - 1.0).abs() < 1e-9, "{steady}");
    assert_eq!(steady["verdict"], "stable, by the second variation of the energy");

    // Without the force the particle circles steadily: the coordinates x and y are left out, but
    // their rates vary.
    let steady = report(&CYLINDER.replace(" - x", ""))["steady_motion"].clone();
    assert_eq!(steady["rates"], json!({}));
    assert_eq!(steady["state"].as_object().map(serde_json::Map::len), Some(3));
}

#[test]
fn a_pendulum_with_drag_is_steady_upright() {
    let steady = report(PENDULUM)["steady_motion"].clone();
    let angle = steady["state"]["q"].as_f64().expect("a number");
    assert!((angle - std::f64::consts::PI).abs() < 1e-9, "{angle}");
    assert_eq!(steady["verdict"], "unstable, by the first approximation");
}

#[test]
fn no_steady_motion_is_reported_where_there_is_none() {
    let none = "  steady motion      none found near the start\n";
    assert!(check("swinging-atwood").ends_with(none), "its two masses are never at rest together");
    for model in ["charged-particle-induction", "damped-oscillator"] {
        assert!(
            check(model).ends_with("  steady motion      not looked for: the model depends on time\n"),
            "{model}"
        );
        assert_eq!(report(model)["steady_motion"], Value::Null);
    }
}

/// The report on the invariant measure of a built-in model.
#[track_caller]
fn measure(model: &str) -> String {
    let text = check(model);
    let line = text.lines().find_map(|line| line.strip_prefix("  invariant measure  "));
    line.unwrap_or_else(|| panic!("{text}")).to_owned()
}

#[test]
fn the_invariant_measure_is_reported() {
    for (model, said) in [
        ("heavy-top-euler", "sin(θ) dx dy, and so dx dη, Liouville's"),
        ("relativistic-particle", "ρ dx dy, (ρ/((η1² + η2²)/c² - 1)²) dx dη, Liouville's"),
        (
            "spherical-pendulum-cartesian",
            "-z dx dy, z (x² y²/z⁴ - (x²/z² + 1) (y²/z² + 1)) dx dη, Liouville's",
        ),
        ("turning-wire", "(α t + 1) dx dy, (1/(α t + 1)) dx dη, Liouville's"),
        ("bouncing-ball", "dx dy, and so dx dη, Liouville's, between events"),
        // Constraints, and no potential.
        ("tilted-disk", "sin(θ) dx dy, and so dx dη"),
        ("turntable", "dx dy, and so dx dη"),
        // Phase volume shrinks towards the steady motion, which the density compensates.
        ("chaplygin-sleigh", "(1/p_ω) dx dy, (1/ω) dx dη, singular where p_ω = 0"),
        ("suslov", "none found"),
        ("appell-hamel", "not looked for: a constraint is not affine in the velocities"),
    ] {
        assert_eq!(measure(model), said, "{model}");
    }
}

/// With the resistance ẍ = −ẋ/10 phase volume shrinks at a rate that no density in the coordinates
/// compensates.
#[test]
fn measures_for_programs() {
    assert_eq!(report(PENDULUM)["invariant_measure"], Value::Null);
    let disk = &report("vertical-disk")["invariant_measure"];
    assert_eq!(disk["liouville"], false);
    assert_eq!(disk["density"], disk["reducing_multiplier"]);
    assert_eq!(disk["singular"], json!([]));
    let sleigh = &report("chaplygin-sleigh")["invariant_measure"];
    assert_eq!(sleigh["singular"], json!(["p_ω"]));
    // A determinant of five rows is not written out.
    let rows = (0..5).map(|i| {
        let terms: Vec<String> = (0..5).map(|j| format!("cos({} + q{j})*q{j}'", i * j)).collect();
        format!("u{i} = {{ start = 0.1, is = \"3*q{i}' + {}\" }}\n", terms.join(" + "))
    });
    let coordinates: String = (0..5).map(|i| format!("q{i} = 0.{i}\n")).collect();
    let kinetic: Vec<String> = (0..5).map(|i| format!("u{i}^2/2")).collect();
    let dense = format!(
        "[coordinates]\n{coordinates}[quasi_velocities]\n{}[lagrangian]\nkinetic = \"{}\"\n",
        rows.collect::<String>(),
        kinetic.join(" + ")
    );
    let dense = &report(&dense)["invariant_measure"];
    assert_eq!((&dense["liouville"], &dense["density"]), (&json!(true), &Value::Null));
    assert_eq!(sleigh["jumps"], false);
    assert_eq!(report("bouncing-ball")["invariant_measure"]["jumps"], true);
    let top = &report("euler-top")["invariant_measure"];
    assert_eq!((&top["density"], &top["liouville"]), (&json!("1"), &json!(true)));
}

/// What a reset changes is conserved only between events; what it leaves unchanged, always.
#[test]
fn resets_may_change_what_is_conserved() {
    let verdict =
        |report: &Value, name: &str| integral(report, name)["verdict"].as_str().expect("text").to_owned();
    let between = "conserved between events (proved)";
    assert_eq!(verdict(&report("bouncing-ball"), "energy"), between);
    assert_eq!(verdict(&report("rocking-disk"), "energy"), between);
    assert!(check("bouncing-ball").contains("energy  conserved between events (proved)\n"));
    // A ball in the plane: the floor damps the vertical velocity and leaves the horizontal one.
    let plane = |reset: &str| {
        format!(
            "[parameters]\ne = 1.0\n[coordinates]\nx = 0.0\ny = 1.0\n[lagrangian]\nkinetic = \"(x'^2 + y'^2)/2\"\n\
             potential = \"y\"\n[integrals]\nalong = \"x'\"\n[events.floor]\nwhen = \"y\"\n{reset}[simulation]\nt_end = 1.0\n"
        )
    };
    let of = |reset: &str| {
        let report = report(&plane(reset));
        ["along", "energy"].map(|name| verdict(&report, name))
    };
    let always = "conserved (proved)";
    assert_eq!(of(""), [always, always]);
    assert_eq!(of("terminal = true\n"), [always, always]);
    // With e = 1 the energy is conserved.
    let here = "conserved for these parameters (proved)";
    assert_eq!(of("reset = { \"y'\" = \"-e*y'\" }\n"), [always, here]);
    assert_eq!(of("reset = { \"y'\" = \"-e*y'/2\" }\n"), [always, between]);
    assert_eq!(of("reset = { \"y'\" = \"-y'\", \"x'\" = \"x'/2\" }\n"), [between, between]);
}
