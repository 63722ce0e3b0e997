//! The output of `pc theory`.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use crate::each_model::each;
use pc_expr::parse::parse;
use pc_model::{BUILTIN, Model};
use pc_print::{Page, Theory, TheoryOptions};
use serde_json::Value;

fn run(arguments: &[&str], directory: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pc"))
        .arg("theory")
        .args(arguments)
        .current_dir(directory)
        .output()
        .expect("pc starts")
}

fn said(arguments: &[&str]) -> String {
    let output = run(arguments, Path::new("."));
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("UTF-8")
}

/// The exit code and output for a model text.
fn said_of(model: &str, arguments: &[&str]) -> (i32, String) {
    let directory = tempfile::tempdir().expect("a directory");
    fs::write(directory.path().join("model.toml"), model).expect("written");
    let output = run(&[&["model.toml"], arguments].concat(), directory.path());
    let text = [output.stdout, output.stderr].concat();
    (output.status.code().expect("an end"), String::from_utf8(text).expect("UTF-8"))
}

const KEPLER: &str = "[model]\nname = \"Kepler's problem\"\n[parameters]\nm = 2.0\nk = 3.0\n[coordinates]\nr = 1.2\n\"φ\" = 0.3\n\
    [quasi_velocities]\n\"r'\" = 0.1\n\"φ'\" = 0.9\n[lagrangian]\nkinetic = \"m*(r'^2 + r^2*φ'^2)/2\"\npotential = \"-k/r\"\n";

const ACTION: &str = "[hamilton_jacobi]\naction = \"l*φ - E*t + sqrt(2*m*E*r^2 + 2*m*k*r - l^2) \
    + m*k/sqrt(-2*m*E)*atan((-2*m*E*r - m*k)/(sqrt(-2*m*E)*sqrt(2*m*E*r^2 + 2*m*k*r - l^2))) \
    - l*atan((m*k*r - l^2)/(l*sqrt(2*m*E*r^2 + 2*m*k*r - l^2)))\"\nconstants = { E = -1.0, l = 2.4 }\n";

#[test]
fn a_planet_with_its_action() {
    let (code, text) = said_of(&format!("{KEPLER}{ACTION}"), &[]);
    assert_eq!(code, 0, "{text}");
    insta::assert_snapshot!(text);
}

/// Its action depends on the vertical, on which the rotations act intransitively.
const SPHERICAL_TOP: &str = "[model]\nname = \"Spherical top\"\n[parameters]\nA = 2.0\n[coordinates]\n\"γ1\" = 0.48\n\"γ2\" = 0.36\n\"γ3\" = 0.8\n\
    [quasi_velocities]\n\"ω1\" = 0.5\n\"ω2\" = 0.5\n\"ω3\" = -0.525\n[kinematics]\n\"γ1\" = \"γ2*ω3 - γ3*ω2\"\n\"γ2\" = \"γ3*ω1 - γ1*ω3\"\n\
    \"γ3\" = \"γ1*ω2 - γ2*ω1\"\n[algebra]\nname = \"so3\"\n[lagrangian]\nkinetic = \"A*(ω1^2 + ω2^2 + ω3^2)/2\"\n[hamilton_jacobi]\n\
    action = \"A*acos(γ1*sin(u)*cos(v) + γ2*sin(u)*sin(v) + γ3*cos(u))^2/(2*t)\"\nconstants = { u = 0.6, v = 0.1 }\n[simulation]\nt_end = 2.0\n";

#[test]
fn an_action_on_the_sphere() {
    let (code, text) = said_of(SPHERICAL_TOP, &[]);
    assert_eq!(code, 0, "{text}");
    insta::assert_snapshot!(section(&text, "Hamilton–Jacobi"));
    let (_, latex) = said_of(SPHERICAL_TOP, &["--format", "latex"]);
    assert!(latex.contains("\\frac{\\partial S}{\\partial u} &= "), "{latex}");
}

/// With another spin the start is on no motion of the action.
#[test]
fn an_action_on_the_sphere_has_no_motions_with_area() {
    let (code, text) = said_of(SPHERICAL_TOP, &["--set", "ω3=0.2"]);
    let lines = section(&text, "Hamilton–Jacobi");
    assert_eq!(code, 0, "{text}");
    assert!(lines.contains("the motions of S: γ1 p_ω1 + γ2 p_ω2 + γ3 p_ω3 = 0"), "{lines}");
    assert!(
        lines.contains("at the start it is 1.16") && lines.contains("no constants of the start are found"),
        "{lines}"
    );
}

#[test]
fn a_heavy_top() {
    insta::assert_snapshot!(said(&["heavy-top-lagrange"]));
}

#[test]
fn a_rolling_disk() {
    insta::assert_snapshot!(said(&["vertical-disk"]));
}

#[test]
fn a_sleigh_for_a_paper() {
    insta::assert_snapshot!(said(&["chaplygin-sleigh", "--format", "latex"]));
}

#[test]
fn a_free_body_for_programs() {
    insta::assert_snapshot!(said(&["euler-top", "--format", "json"]));
}

/// Formulas in JSON can be parsed, braces in LaTeX are closed, and every model has a complete
/// theory.
#[test]
fn all_models_have_a_theory() {
    each(BUILTIN, |builtin| {
        let model = Model::new(builtin.document().expect("a model"));
        let graph = model.graph();
        let assembly = model.assemble(&graph).expect("assembled");
        let theory = Theory::of(&model, &assembly, &TheoryOptions::default()).expect("a theory");
        let object: Value = serde_json::from_str(&theory.printed(Page::Json)).expect("JSON");
        let sections = object.as_object().expect("an object");
        let mut formulas = 0;
        for entry in sections.values().filter_map(Value::as_array).flatten() {
            for formula in entry["formulas"].as_array().into_iter().flatten() {
                let right = formula["right"].as_str().expect("text");
                let is_field = right.contains("∂/∂") || right.contains(" X_");
                assert!(is_field || parse(right).is_ok(), "{}: {right}", builtin.name);
                formulas += 1;
            }
            let verdict = entry["verdict"].as_str().unwrap_or("open");
            assert!(["proved", "disproved", "open"].contains(&verdict), "{}: {verdict}", builtin.name);
            assert_eq!(verdict == "disproved", entry["margin"].is_number(), "{}: {entry}", builtin.name);
        }
        assert!(formulas > 1, "{}", builtin.name);
        let latex = theory.printed(Page::Latex);
        let count = |c: char| latex.chars().filter(|&other| other == c).count();
        assert_eq!(count('{'), count('}'), "{}", builtin.name);
        let text = theory.printed(Page::Text);
        // Sums are broken into lines; other formulas are not.
        assert!(text.lines().all(|line| line.chars().count() < 400), "{}", builtin.name);
    });
}

/// What the program prints is what the library does.
#[test]
fn the_program_prints_the_theory() {
    let model = Model::new(
        BUILTIN
            .iter()
            .find(|model| model.name == "vertical-disk")
            .expect("there")
            .document()
            .expect("a model"),
    );
    let graph = model.graph();
    let assembly = model.assemble(&graph).expect("assembled");
    let theory = Theory::of(&model, &assembly, &TheoryOptions::default()).expect("a theory");
    for (name, page) in [("text", Page::Text), ("latex", Page::Latex), ("json", Page::Json)] {
        assert_eq!(said(&["vertical-disk", "--format", name]), theory.printed(page));
    }
}

/// The lines of a section.
fn section<'a>(text: &'a str, title: &str) -> &'a str {
    let text = text.split_once(&format!("\n{title}\n")).unwrap_or_else(|| panic!("no {title} in {text}")).1;
    text.split("\n\n").next().unwrap_or_default()
}

/// Values at the start, or near it where all states are possible, disprove that a function is
/// conserved.
#[test]
fn a_changing_function_is_disproved_with_a_margin() {
    for (model, margin) in [("damped-oscillator", 0.0769), ("rotating-oscillator", 0.739)] {
        let text = said(&[model]);
        let integrals = section(&text, "Integrals");
        assert!(integrals.contains("(disproved)\n      d/dt energy = "), "{integrals}");
        let object: Value = serde_json::from_str(&said(&[model, "--format", "json"])).expect("JSON");
        let mut entries = object["integrals"].as_array().into_iter().flatten();
        let energy = entries.find(|entry| entry["name"] == "energy").expect("the energy");
        assert!((energy["margin"].as_f64().expect("a number") - margin).abs() < 1e-3, "{energy}");
    }
}

#[test]
fn integrals_contain_parameters_not_their_values() {
    let text = said(&["rotating-oscillator"]);
    let integrals = section(&text, "Integrals");
    assert!(integrals.contains("(k2 - k1) (Ω²") && !integrals.contains("for these"), "{integrals}");
}

/// A free body with moments A, B, C: nothing depends on its coordinates, be they nine, four or
/// three.
#[test]
fn a_free_body_has_the_bracket_of_lie_and_poisson() {
    let body = "[parameters]\nA = 1.0\nB = 2.0\nC = 3.0\n[coordinates]\n\"ψ\" = 0.1\n\"θ\" = 1.0\n\"φ\" = 0.2\n\
                [quasi_velocities]\nw1.is = \"ψ'*sin(θ)*sin(φ) + θ'*cos(φ)\"\nw2.is = \"ψ'*sin(θ)*cos(φ) - θ'*sin(φ)\"\n\
                w3 = { is = \"ψ'*cos(θ) + φ'\", start = 1.0 }\n[lagrangian]\nkinetic = \"(A*w1^2 + B*w2^2 + C*w3^2)/2\"\n";
    let (code, text) = said_of(body, &[]);
    assert_eq!(code, 0, "{text}");
    let expected =
        "  nothing depends on variables other than p_w1, p_w2, p_w3, by the bracket of Lie and Poisson
  (p_w1, p_w2) = -p_w3
  (p_w1, p_w3) = p_w2
  (p_w2, p_w3) = -p_w1
  H = ½ (p_w1²/A + p_w2²/B + p_w3²/C)
  p_w1' = p_w2 p_w3 (1/C - 1/B)
  p_w2' = p_w1 p_w3 (1/A - 1/C)
  p_w3' = p_w1 p_w2 (1/B - 1/A)
  C1 = p_w1² + p_w2² + p_w3²   (proved)
  rank 2 of 3: 1 independent near almost every point";
    assert_eq!(section(&text, "Reduction by symmetry"), expected);
    // The three components of its momentum in space belong to rotations that commute with those in
    // body axes.
    let displacements = section(&text, "Cyclic displacements");
    assert_eq!(displacements.matches("commutes with all operators").count(), 3, "{displacements}");
}

/// They may contain definitions of the model.
#[test]
fn functions_are_those_of_the_model() {
    let model = "[parameters]\nk = 3.0\n[coordinates]\nx = 1.0\ny = 0.2\nz = 0.3\n[definitions]\nr = \"sqrt(x^2 + y^2 + z^2)\"\n\
                 [lagrangian]\nkinetic = \"(x'^2 + y'^2 + z'^2)/2\"\npotential = \"-k/r\"\n";
    let count = |arguments: &[&str]| {
        let (code, text) = said_of(model, arguments);
        assert_eq!(code, 0, "{text}");
        section(&text, "Integrals").matches("(proved)").count()
    };
    // Energy, area and the vector of Runge and Lenz.
    assert_eq!((count(&[]), count(&["--functions", "1/r"]), count(&["--degree", "1"])), (4, 7, 4));
    assert_eq!(count(&["--functions", "1/r", "x*y", "--degree", "2"]), 7, "options after functions are none");
    let (code, text) = said_of(model, &["--functions", "1/q"]);
    assert!(code == 3 && text.contains("`q`"), "{text}");
    let (code, text) = said_of(model, &["--degree", "9"]);
    assert!(code == 2 && text.contains("--degree"), "{text}");
}

#[test]
fn a_verdict_on_an_action_is_one_of_three() {
    let action = |action: &str| {
        format!("{KEPLER}[hamilton_jacobi]\naction = \"{action}\"\nconstants = {{ E = -1.0, l = 2.4 }}\n")
    };
    let (_, proved) = said_of(&format!("{KEPLER}{ACTION}"), &[]);
    assert!(section(&proved, "Hamilton–Jacobi").contains("(proved)"), "{proved}");
    let (_, refuted) = said_of(&action("l*φ - E*t + m*r"), &[]);
    let lines = section(&refuted, "Hamilton–Jacobi");
    assert!(lines.contains("(disproved)") && lines.contains("refuted: X_0 S + H is "), "{lines}");
    assert!(lines.contains("not complete: ∂(X_s S)/∂α has rank 1 of 2"), "{lines}");
    // Nonholonomic systems have no such equation.
    let held = "[coordinates]\nx = 1\ny = 0.5\nz = 0\n[constraints]\nc = \"z' - y*x'\"\n[lagrangian]\nkinetic = \"(x'^2 + y'^2 + z'^2)/2\"\n\
                [hamilton_jacobi]\naction = \"x\"\n";
    let (code, text) = said_of(held, &[]);
    assert!(code == 0 && section(&text, "Hamilton–Jacobi").starts_with("  the action open: "), "{text}");
}

/// Every command shows the place in the file.
#[test]
fn a_wrong_action_is_refused() {
    for (section, message) in [
        ("action = \"r'*x\"", "r'"),
        ("action = \"E*r\"", "`E`"),
        ("constants = { E = 1.0 }", "`action` is missing"),
        ("action = \"E*r\"\nconstants = { E = \"1\" }", "expected a number"),
        ("action = \"k*r\"\nconstants = { k = 1.0 }", "`k`"),
        ("action = \"r\"\nkonstants = { }", "`konstants`"),
    ] {
        let (code, text) = said_of(&format!("{KEPLER}[hamilton_jacobi]\n{section}\n"), &[]);
        assert!(code == 3 && text.contains(message), "{section}: {text}");
    }
}

#[test]
fn limits_hold() {
    // The equations need a few hundred KiB, the theory a few thousand.
    for limit in ["100K", "500K", "2M"] {
        let output = run(&["heavy-top-euler", "--limit-memory", limit], Path::new("."));
        assert_eq!(output.status.code(), Some(4), "{limit}");
        assert!(
            output.stdout.is_empty() && String::from_utf8_lossy(&output.stderr).contains("--limit-memory")
        );
    }
    let (code, text) = said_of(KEPLER, &["--limit-memory", "50K"]);
    assert!(code == 4 && text.contains("--limit-memory"), "{text}");
}

/// Whether a word is z and a number.
fn is_named(word: &str) -> bool {
    word.strip_prefix('z').is_some_and(|rest| !rest.is_empty() && rest.chars().all(|c| c.is_ascii_digit()))
}

fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !c.is_alphanumeric() && c != '_')
}

/// Long expressions have names, each defined once and before its use, in text and for programs.
#[test]
fn theories_of_mechanisms_name_what_is_long() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/mechanisms");
    for name in ["crank-rocker", "rattleback"] {
        let model = folder.join(format!("{name}.toml")).display().to_string();
        let text = said(&[&model]);
        let mut known: Vec<String> = Vec::new();
        for line in text.lines().skip(2) {
            assert!(line.chars().count() <= 112, "{name}: {line}");
            let (left, right) = line.split_once(" = ").unwrap_or(("", line));
            let unknown = words(right).find(|word| is_named(word) && !known.iter().any(|z| z == word));
            assert_eq!(unknown, None, "{name}: {line}");
            if is_named(left.trim()) {
                assert!(!known.iter().any(|z| z == left.trim()), "{name}: {line}");
                known.push(left.trim().to_owned());
            }
        }
        assert!(!known.is_empty(), "{name} has long formulas: {text}");
        let object: Value = serde_json::from_str(&said(&[&model, "--format", "json"])).expect("JSON");
        let definitions = object["definitions"].as_array().expect("definitions");
        let names: Vec<&str> =
            definitions.iter().map(|given| given["name"].as_str().expect("a name")).collect();
        for (place, given) in definitions.iter().enumerate() {
            let value = given["value"].as_str().expect("text");
            assert!(parse(value).is_ok(), "{name}: {value}");
            let later = words(value).find(|word| names[place..].contains(word));
            assert_eq!(later, None, "{name}: {} = {value}", names[place]);
        }
        assert!(known.iter().all(|z| names.contains(&z.as_str())), "{name}: {names:?}");
    }
}

/// A few hundred coordinates take seconds: where quasi-velocities are velocities, frames are not
/// multiplied.
#[test]
fn a_theory_of_many_coordinates_ends() {
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("chain.toml");
    let n = 200;
    let coordinates: String = (0..n).map(|i| format!("q{i} = 0.1\n")).collect();
    let kinetic: Vec<String> = (0..n).map(|i| format!("q{i}'^2/2")).collect();
    let potential: Vec<String> = (1..n).map(|i| format!("(q{i} - q{})^2/2", i - 1)).collect();
    let text = format!(
        "[coordinates]\n{coordinates}[lagrangian]\nkinetic = \"{}\"\npotential = \"{}\"\n",
        kinetic.join(" + "),
        potential.join(" + ")
    );
    fs::write(&path, text).expect("written");
    let said = said(&[&path.display().to_string()]);
    assert!(said.contains("Jacobi's identity proved"), "{said}");
}

/// A planet in space, in its Cartesian coordinates.
const PLANET: &str = "[parameters]\nm = 2.0\nk = 3.0\n[coordinates]\nx = 1.0\ny = 0.2\nz = 0.3\n\
    [quasi_velocities]\n\"x'\" = 0.1\n\"y'\" = 1.1\n\"z'\" = 0.2\n[definitions]\nr = \"sqrt(x^2 + y^2 + z^2)\"\n\
    [lagrangian]\nkinetic = \"m*(x'^2 + y'^2 + z'^2)/2\"\npotential = \"-k/r\"\n";

/// The angular momentum and Lenz's vector, up to factors: so(4), with H.
#[test]
fn the_integrals_of_a_planet_and_their_brackets() {
    let (code, text) = said_of(PLANET, &["--functions", "1/r"]);
    assert_eq!(code, 0, "{text}");
    insta::assert_snapshot!(section(&text, "Brackets of integrals"));
}

/// The momentum of the cyclic angle is one component of the angular momentum; with a second, which is declared, Poisson's
/// theorem gives the third, which has no form that is looked for.
#[test]
fn poissons_theorem_gives_a_new_integral() {
    let model = "[parameters]\nm = 2.0\nk = 3.0\n[coordinates]\nr = 1.0\n\"θ\" = 0.9\n\"φ\" = 0.3\n\
        [quasi_velocities]\n\"r'\" = 0.1\n\"θ'\" = 1.1\n\"φ'\" = 0.2\n[lagrangian]\n\
        kinetic = \"m*(r'^2 + r^2*θ'^2 + r^2*sin(θ)^2*φ'^2)/2\"\npotential = \"-k/r\"\n[integrals]\n\
        Kx = \"-m*r^2*(sin(φ)*θ' + sin(θ)*cos(θ)*cos(φ)*φ')\"\n";
    let (code, text) = said_of(model, &[]);
    assert_eq!(code, 0, "{text}");
    insta::assert_snapshot!(section(&text, "Brackets of integrals"));
}

/// Integrals that commute, and what follows from their number.
#[test]
fn integrals_in_involution_suffice_or_not() {
    for (model, expected) in [
        ("heavy-top-lagrange", "integrable by Liouville's theorem: 2 independent integrals in"),
        ("euler-top", "integrable by Liouville's theorem: 1 independent integral in"),
        ("toda-chain", "integrable by Liouville's theorem"),
        ("heavy-top-euler", "these integrals do not suffice"),
    ] {
        let text = said(&[model]);
        let brackets = section(&text, "Brackets of integrals");
        assert!(brackets.contains(expected), "{model}: {brackets}");
    }
}

/// A point on a sphere: Dirac's bracket of its Cartesian coordinates and momenta.
#[test]
fn a_point_on_a_sphere_has_diracs_bracket() {
    let model = "[parameters]\nm = 1.5\ng = 9.81\nl = 0.8\n[coordinates]\nx = 0.48\ny = 0.0\nz = -0.64\n\
        [quasi_velocities]\n\"x'\" = 0.0\n\"y'\" = 1.0\n\"z'\" = 0.0\n[lagrangian]\nkinetic = \"m*(x'^2 + y'^2 + z'^2)/2\"\n\
        potential = \"m*g*z\"\n[constraints]\nrod = \"x^2 + y^2 + z^2 - l^2\"\n";
    let (code, text) = said_of(model, &[]);
    assert_eq!(code, 0, "{text}");
    insta::assert_snapshot!(section(&text, "Dirac brackets"));
}

/// Functions that are canonical variables, or not, and what is refused.
#[test]
fn canonical_variables_are_tested() {
    let tested = |definitions: &[&str]| said_of(PLANET, &[&["--canonical"], definitions].concat());
    let (code, text) =
        tested(&["ρ=sqrt(x^2+y^2)", "φ=atan2(y, x)", "p=(x*p_x + y*p_y)/sqrt(x^2+y^2)", "K=m*(x*y' - y*x')"]);
    assert_eq!(code, 0, "{text}");
    insta::assert_snapshot!("polar_coordinates", section(&text, "Canonical variables"));
    let (_, text) = tested(&["Q=2*x", "P=m*x'"]);
    insta::assert_snapshot!("a_multiplier_of_brackets", section(&text, "Canonical variables"));
    let (_, text) = tested(&["Q=x", "R=y + p_x", "P=p_x", "S=p_y*y"]);
    insta::assert_snapshot!("brackets_that_fail", section(&text, "Canonical variables"));
    let (code, text) = tested(&["Q=x"]);
    assert_eq!(code, 2, "{text}");
    insta::assert_snapshot!("an_odd_number_of_variables", text);
    let (code, text) = tested(&["Q=x", "P=p_q"]);
    assert_eq!(code, 3, "{text}");
    insta::assert_snapshot!("an_unknown_momentum", text);
    let output = run(&["chaplygin-sleigh", "--canonical", "Q=φ", "P=ω"], Path::new("."));
    insta::assert_snapshot!("no_canonical_variables", String::from_utf8_lossy(&output.stderr));
}

/// Neumann's problem in Cartesian coordinates: an integral of Uhlenbeck is one on the sphere, which is no integral itself.
#[test]
fn an_integral_on_a_sphere_is_proved() {
    let model = "[parameters]\na = 1.0\nb = 2.3\nc = 3.1\n[coordinates]\nx = 0.48\ny = 0.64\nz = 0.6\n\
        [quasi_velocities]\n\"x'\" = 0.64\n\"y'\" = -0.48\n\"z'\" = 0.0\n[constraints]\nsphere = \"x^2 + y^2 + z^2 - 1\"\n\
        [lagrangian]\nkinetic = \"(x'^2 + y'^2 + z'^2)/2\"\npotential = \"(a*x^2 + b*y^2 + c*z^2)/2\"\n\
        [integrals]\nF = \"x^2 + (x*y' - y*x')^2/(a - b) + (x*z' - z*x')^2/(a - c)\"\n";
    let (code, text) = said_of(model, &[]);
    assert_eq!(code, 0, "{text}");
    insta::assert_snapshot!(section(&text, "Integrals"));
}

/// N = (CA + m r·Ir)^(−1/2), and the integrals of Jellett and Routh.
#[test]
fn routh_s_sphere_has_an_invariant_measure() {
    let text = said(&["../../tests/systems/rouths-sphere.toml"]);
    insta::assert_snapshot!([section(&text, "Integrals"), section(&text, "Invariant measure")].concat());
}
