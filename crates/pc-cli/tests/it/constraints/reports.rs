//! Reports and refusals of constraints.

use serde_json::json;

use super::{SLEIGH, SPHERE, json_of, pc, run, stderr, stdout, table};

#[test]
fn a_start_is_moved_on_request() {
    let off = SPHERE.replace("x = 0.6", "x = 0.7");
    let refused = pc(&off, &["run", "-"]);
    assert_eq!(refused.status.code(), Some(4));
    assert_eq!(
        stderr(&refused),
        "pc: <stdin>:15:11: [constraints] length: the start is off the constraint `length`: it is 0.13, not 0\n    \
         length = \"x^2+y^2+z^2-l^2\"\n              ^^^^^^^^^^^^^^^\n  \
         help: give a start that satisfies it, or move it there with --project-start (--keep NAMES holds what is to stay)\n"
    );
    assert!(refused.stdout.is_empty());
    let (_, rows) = run(&off, &["--project-start"]);
    // The nearest point of the sphere.
    let r = 0.7f64.hypot(0.8);
    assert!((rows[0][1] - 0.7 / r).abs() < 1e-15 && (rows[0][3] + 0.8 / r).abs() < 1e-15, "{:?}", rows[0]);
    for command in ["check", "derive"] {
        assert_eq!(pc(&off, &[command, "-"]).status.code(), Some(4));
        assert_eq!(pc(&off, &[command, "-", "--project-start"]).status.code(), Some(0));
    }
    // A parameter moves constraint and start together if both contain it.
    assert_eq!(pc(SPHERE, &["check", "-", "--set", "l=2"]).status.code(), Some(4), "x is a number");
    let together = SPHERE.replace("x = 0.6", "x = \"0.6*l\"");
    assert_eq!(pc(&together, &["check", "-", "--set", "l=2"]).status.code(), Some(0));
}

/// The cusp of y² = x³ at the origin: no motion continues from there.
#[test]
fn a_singular_place_on_the_way_ends_the_run() {
    let cusp = "[coordinates]\nx = 1.0\ny = 1.0\n[quasi_velocities]\n\"x'\" = -2.0\n\"y'\" = -3.0\n[constraints]\n\
                edge = \"y^2 - x^3\"\n[lagrangian]\nkinetic = \"(x'^2 + y'^2)/2\"\n[simulation]\nt_end = 2.0\nsamples = 21\n";
    // The length of y² = x³ from (1, 1) to the cusp is (13√13 − 8)/27, the speed is √13.
    let arrival = (13.0 * 13f64.sqrt() - 8.0) / 27.0 / 13f64.sqrt();
    for method in ["auto", "adams"] {
        let output = pc(cusp, &["run", "-", "--method", method]);
        let text = stderr(&output);
        assert_eq!(output.status.code(), Some(5), "{text}");
        let said =
            text.split("the integration failed at t = ").nth(1).and_then(|rest| rest.split(',').next());
        let t: f64 = said.expect("a time").parse().expect("a number");
        // Near the cusp x ~ t_1 − t and y ~ x^(3/2): a step of the square root of the tolerance is
        // lost there.
        assert!((t - arrival).abs() < 1e-4, "{t} {arrival}");
        assert!(text.contains("`edge`"), "{text}");
        let (_, rows) = table(&String::from_utf8(output.stdout).expect("UTF-8"));
        let times: Vec<f64> = rows.iter().map(|row| row[0]).collect();
        assert_eq!(times, [0.0, 0.1, 0.2, 0.3], "what was reached is kept");
    }
}

#[test]
fn dropped_constraints_are_reported() {
    let twice = SPHERE.replace("length =", "speed = \"x*x' + y*y' + z*z'\"\nnothing = \"0\"\nlength =");
    let note = "note: the constraint nothing holds whatever the motion; it is dropped\n\
                note: the constraint speed follows from length; it is dropped\n";
    for arguments in [["derive", "-", "--form", "poincare"], ["derive", "-", "--form", "canonical"]] {
        assert_eq!(stderr(&pc(&twice, &arguments)), note);
    }
    let text = stderr(&pc(&twice, &["run", "-"]));
    assert!(
        text.contains(
            "\n  dropped  nothing holds whatever the motion: λ_nothing is taken as 0\n           speed follows from length: λ_speed is taken as 0\n"
        ),
        "{text}"
    );
    let check = stdout(&pc(&twice, &["check", "-"]));
    let lines = "constraints        length: holonomic\n                     nothing: holds whatever the motion; dropped\n                     \
                 speed: follows from length; dropped\n";
    assert!(check.contains(lines), "{check}");
    let report = json_of(&twice, &["check", "-", "--format", "json"]);
    let dropped = json!([
        { "name": "nothing", "follows_from": [] },
        { "name": "speed", "follows_from": ["length"] },
    ]);
    assert_eq!(report["dropped_constraints"], dropped);
    let directory = tempfile::tempdir().expect("a directory");
    let output = pc(&twice, &["emit", "-", "--lang", "c", "-o", directory.path().to_str().expect("UTF-8")]);
    assert!(stderr(&output).starts_with(note), "{}", stderr(&output));
    assert_eq!(run(&twice, &[]), run(SPHERE, &[]), "the motion is the same");
}

#[test]
fn a_check_reports_the_kinds_of_constraints() {
    let report = json_of(SPHERE, &["check", "-", "--format", "json"]);
    assert_eq!(report["constraints"], json!([{ "name": "length", "kind": "holonomic", "residual": 0.0 }]));
    // 0.6² + 0.8² in numbers.
    assert!(report["start_residual"].as_f64().expect("a number") < 2e-16, "{report}");
    let report = json_of(SLEIGH, &["check", "-", "--format", "json"]);
    let blade = &report["constraints"][0];
    assert_eq!((&blade["name"], &blade["kind"]), (&json!("blade"), &json!("nonholonomic")));
    // [v, ω] = −blade
    assert_eq!(blade["residual"], 1.0);
    assert_eq!(report["start_residual"], 0.0);
    let text = stdout(&pc(SLEIGH, &["check", "-"]));
    assert!(text.contains("  constraints        blade: nonholonomic\n"), "{text}");
    assert!(text.contains("  mass matrix        symmetric, rank 2 of 2\n"), "{text}");
}

/// On a belt Jacobi's integral is not the energy of the run, and each is called by its name.
#[test]
fn energies_are_distinguished() {
    let belt = "[coordinates]\nx = 0.0\ny = 0.0\n[quasi_velocities]\n\"x'\" = 1.0\n\"y'\" = 2.0\n[constraints]\n\
                belt = \"y' - 2 - x\"\n[lagrangian]\nkinetic = \"(x'^2 + y'^2)/2\"\n[simulation]\nt_end = 1.0\n";
    let remark = "(This energy is y·η − L of the independent velocities (Jacobi's integral). The energy of a run is that of \
                  all velocities.)\n";
    for (form, expected) in [("poincare", true), ("canonical", true), ("voronets", true), ("lagrange", false)]
    {
        let text = stdout(&pc(belt, &["derive", "-", "--form", form]));
        assert_eq!(text.contains(remark), expected, "{form}: {text}");
        let page = stdout(&pc(belt, &["derive", "-", "--form", form, "--format", "latex"]));
        assert_eq!(page.contains("Jacobi's integral"), expected, "{form}: {page}");
    }
    assert!(!stdout(&pc(SPHERE, &["derive", "-"])).contains("Jacobi"));
    let report = json_of(belt, &["check", "-", "--format", "json"]);
    let named = |name: &str| {
        report["integrals"].as_array().expect("a list").iter().find(|i| i["name"] == name).cloned()
    };
    // ½ (1 + (2 + x)²) grows at the rate (2 + x) ẋ = 2.
    assert_eq!(named("energy").expect("listed")["rate_at_start"], 2.0);
    assert!(named("Jacobi's").is_some(), "{report}");
    let directory = tempfile::tempdir().expect("a directory");
    std::fs::write(directory.path().join("belt.toml"), belt).expect("written");
    let path = |name: &str| directory.path().join(name).to_str().expect("UTF-8").to_owned();
    pc("", &["emit", &path("belt.toml"), "--lang", "c", "-o", &path("")]);
    let header = std::fs::read_to_string(path("belt.h")).expect("a header");
    assert!(header.contains("This energy is y·η − L of the independent velocities"), "{header}");
}

#[test]
fn a_mass_of_the_wrong_sign_is_reported() {
    let words = "the kinetic energy is negative for some velocities at the start: a mass or a moment of inertia has the \
                 wrong sign";
    let negative = ["--set", "m=-1"];
    let text = stdout(&pc(SPHERE, &[&["check", "-"], &negative[..]].concat()));
    assert!(text.contains(words), "{text}");
    let output = pc(SPHERE, &[&["run", "-"], &negative[..]].concat());
    assert_eq!(output.status.code(), Some(0), "a note is no error");
    assert!(stderr(&output).starts_with(&format!("note: {words}\n")), "{}", stderr(&output));
    assert!(!stdout(&pc(SPHERE, &["check", "-"])).contains("wrong sign"));
    // A negative mass in a direction that the constraint forbids does not count.
    let forbidden = "[coordinates]\nx = 0.0\ny = 0.0\n[constraints]\nwall = \"y\"\n[lagrangian]\n\
                     kinetic = \"(x'^2 - y'^2)/2\"\n[simulation]\nt_end = 1.0\n";
    assert!(!stderr(&pc(forbidden, &["run", "-"])).contains("wrong sign"));
}

#[test]
fn a_moved_start_is_reported() {
    let off = SPHERE.replace("x = 0.6", "x = 0.7");
    let text = stderr(&pc(&off, &["run", "-", "--project-start"]));
    let note = "note: the start was moved onto the constraints:\n      x = 0.7 → 0.6585046079, z = -0.8 → -0.7525766947\n";
    assert!(text.starts_with(note), "{text}");
    let text = stderr(&pc(SLEIGH, &["run", "-", "--project-start"]));
    assert!(text.starts_with("note: the start satisfies the constraints; it was not moved\n"), "{text}");
}

#[test]
fn an_unknown_name_is_reported_once() {
    let text = stderr(&pc("", &["run", "euler-top", "--set", "I4=1"]));
    assert_eq!(
        text,
        "pc: --set: `I4` is neither a parameter nor a start value of this model; its parameters are I1, I2, I3, its start values \
         ω1, ω2, ω3\n"
    );
}

/// Lagrange's equations need as many velocities as coordinates.
#[test]
fn an_unknown_form_lists_those_available() {
    let output = pc("", &["derive", "spherical-pendulum-cartesian", "--form", "lagrange"]);
    assert_eq!(output.status.code(), Some(4));
    let text = stderr(&output);
    let help = "\n  help: its forms are poincare, canonical, kane and gibbs-appell, in the quasi-velocities of the model\n";
    assert!(text.ends_with(help), "{text}");
}

#[test]
fn parameters_of_any_name_can_be_set() {
    let names = "[coordinates]\nth = 0.1\nphi = 0.2\nheight = 0.3\n[lagrangian]\n\
                 kinetic = \"(th'^2 + phi'^2 + height'^2)/2\"\npotential = \"cos(th)*cos(phi)*cos(height)\"\n";
    let page = stdout(&pc(names, &["derive", "-", "--format", "latex"]));
    for word in [
        "\\cos \\theta",
        "\\cos \\varphi",
        "\\cos \\mathrm{height}",
        "\\ddot{\\theta}",
        "\\ddot{\\mathrm{height}}",
    ] {
        assert!(page.contains(word), "{word}: {page}");
    }
    assert!(!page.contains("\\text"), "{page}");
}
