//! FMUs of models: what they say of themselves, and what an importer of our own gets out of them, compiled by the system's C compiler.
//! Validation by the schemas of FMI and simulation by FMPy: `cargo xtask fmu`.

#![allow(clippy::unwrap_used)] // in what the tests share

use std::fs;
use std::process::Command;

use pc_fmu::{FmiVersion, Fmu, FmuError, FmuOptions, FmuSolver};
use pc_model::{Builtin, Document, Model, Source, Variables};

const VERSIONS: [FmiVersion; 2] = [FmiVersion::V2, FmiVersion::V3];
const KINDS: [&str; 2] = ["me", "cs"];

fn model(name: &str) -> Model {
    Model::new(Builtin::named(name).unwrap().document().unwrap())
}

fn written(text: &str) -> Model {
    Model::new(Document::parse(Source::new("model.toml", text)).unwrap())
}

fn export(model: &Model, options: &FmuOptions) -> Result<Fmu, FmuError> {
    let graph = model.graph();
    Fmu::new(model, &model.assemble(&graph)?, Variables::QuasiVelocities, options)
}

fn exported(model: &Model, version: FmiVersion) -> Fmu {
    export(model, &FmuOptions::new(version, "it")).unwrap()
}

/// The attributes of the variable of this name, and its value reference.
fn variable(fmu: &Fmu, name: &str, attribute: &str) -> Option<String> {
    let document = roxmltree::Document::parse(fmu.model_description()).unwrap();
    let found = document.descendants().find(|node| {
        matches!(node.tag_name().name(), "ScalarVariable" | "Float64") && node.attribute("name") == Some(name)
    });
    let node = found.unwrap_or_else(|| panic!("no variable {name}"));
    let real = node.children().find(|child| child.tag_name().name() == "Real");
    node.attribute(attribute).or_else(|| real?.attribute(attribute)).map(str::to_owned)
}

fn reference(fmu: &Fmu, name: &str) -> String {
    variable(fmu, name, "valueReference").unwrap()
}

/// The importer for an FMU, compiled with it.
struct Importer {
    place: tempfile::TempDir,
}

impl Importer {
    fn new(fmu: &Fmu, version: FmiVersion) -> Importer {
        let place = tempfile::tempdir().unwrap();
        for (name, bytes) in fmu.files() {
            if let Some(name) = name.strip_prefix("sources/") {
                fs::write(place.path().join(name), bytes).unwrap();
            }
        }
        fs::write(place.path().join("importer.c"), include_str!("c/importer.c")).unwrap();
        let version = if version == FmiVersion::V2 { "-DVERSION=2" } else { "-DVERSION=3" };
        let warnings = ["-Wall", "-Wextra", "-Werror", "-Wpedantic", "-Wshadow", "-Wno-unused-function"];
        let output = Command::new("cc")
            .args(["-std=c99", "-O1", "-ffp-contract=off", version, "-o", "importer"])
            .args(warnings)
            .args(["importer.c", "it_model.c", "-lm"])
            .current_dir(place.path())
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        Importer { place }
    }

    /// Its lines, or what it complains of.
    fn run(&self, arguments: &[&str]) -> Result<Vec<Vec<f64>>, String> {
        let output = Command::new(self.place.path().join("importer")).args(arguments).output().unwrap();
        if !output.status.success() {
            return Err(String::from_utf8_lossy(&output.stderr).into_owned());
        }
        let numbers = |line: &str| line.split(' ').map(|number| number.parse().unwrap()).collect();
        Ok(String::from_utf8_lossy(&output.stdout).lines().map(numbers).collect())
    }
}

/// Height and velocity of the bouncing ball: h = 1, g = 9.81, e = 0.8.
fn ball(t: f64, h: f64) -> [f64; 2] {
    let (g, e) = (9.81, 0.8);
    let (mut landing, mut speed) = ((2.0 * h / g).sqrt(), (2.0 * g * h).sqrt());
    if t < landing {
        return [h - g * t * t / 2.0, -g * t];
    }
    loop {
        speed *= e;
        let flight = 2.0 * speed / g;
        if t < landing + flight {
            let s = t - landing;
            return [speed * s - g * s * s / 2.0, speed - g * s];
        }
        landing += flight;
    }
}

#[test]
fn a_ball_bounces_in_both_kinds_and_versions() {
    let model = model("bouncing-ball");
    for version in VERSIONS {
        let fmu = exported(&model, version);
        assert_eq!(variable(&fmu, "h", "causality").as_deref(), Some("parameter"));
        assert_eq!(variable(&fmu, "y", "initial").as_deref(), Some("calculated")); // it follows h
        assert_eq!(variable(&fmu, "y'", "initial").as_deref(), Some("exact"));
        let importer = Importer::new(&fmu, version);
        let [y, v, h] = ["y", "y'", "h"].map(|name| reference(&fmu, name));
        for kind in KINDS {
            for height in ["1", "0.5"] {
                let lines =
                    importer.run(&[kind, "2", "0.1", "set", &h, height, "get", &y, "get", &v]).unwrap();
                assert_eq!(lines.len(), 21);
                for line in lines {
                    let expected = ball(line[0], height.parse().unwrap());
                    // Impacts are located to rounding, of times and heights near 1, six times amplified by speeds near 5.
                    for (found, expected) in line[1..].iter().zip(expected) {
                        assert!((found - expected).abs() < 1e-9, "{kind} {line:?} {expected:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn what_no_simulation_passes_is_an_error() {
    let fmu = exported(&model("bouncing-ball"), FmiVersion::V3);
    let importer = Importer::new(&fmu, FmiVersion::V3);
    // The bounces accumulate at t₀ (1 + e)/(1 − e) = 4.0637.
    for kind in KINDS {
        let complaint = importer.run(&[kind, "5", "0.1"]).unwrap_err();
        assert!(complaint.contains("the event bounce accumulates at t = 4.063"), "{kind}: {complaint}");
    }
}

#[test]
fn a_terminal_event_ends_a_simulation() {
    let falls = written(
        "[coordinates]\nz = 2.0\n[lagrangian]\nkinetic = \"z'^2/2\"\npotential = \"z\"\n\
         [events.floor]\nwhen = \"z\"\ndirection = \"falling\"\nterminal = true\n[simulation]\nt_end = 3.0\n",
    );
    for version in VERSIONS {
        let fmu = exported(&falls, version);
        let importer = Importer::new(&fmu, version);
        let event_mode = ["events", "1"];
        let ways = [("me", [].as_slice()), ("cs", &[]), ("cs", &event_mode)];
        for (kind, more) in ways.into_iter().take(if version == FmiVersion::V3 { 3 } else { 2 }) {
            let asked = [kind, "3", "0.75", "get", &reference(&fmu, "z")];
            let lines = importer.run(&[&asked, more].concat()).unwrap();
            let last = lines.last().unwrap();
            // z = 2 − t²/2
            assert!((last[0] - 2.0).abs() < 1e-12 && last[1].abs() < 1e-12, "{kind} {lines:?}");
            assert_eq!(lines.len(), 4);
        }
    }
}

#[test]
fn events_of_co_simulation_are_left_to_importers_with_event_mode() {
    let fmu = exported(&model("bouncing-ball"), FmiVersion::V3);
    let abilities = "mightReturnEarlyFromDoStep=\"true\" hasEventMode=\"true\"";
    assert!(fmu.model_description().contains(abilities), "{}", fmu.model_description());
    let importer = Importer::new(&fmu, FmiVersion::V3);
    let [y, v] = ["y", "y'"].map(|name| reference(&fmu, name));
    let run = |events| importer.run(&["cs", "2", "0.5", "events", events, "get", &y, "get", &v]).unwrap();
    // The same motion, to the last bit.
    let inside = run("0");
    assert_eq!(run("1"), inside);
    let mut lines = run("2");
    lines.retain(|line| !inside.contains(line));
    // Three bounces: where and how fast before them and after them.
    let (t0, speed) = ((2.0_f64 / 9.81).sqrt(), (2.0 * 9.81_f64).sqrt());
    assert_eq!(lines.len(), 6);
    for (n, pair) in lines.chunks(2).enumerate() {
        let flights: f64 = (1..=n as i32).map(|flight| 2.0 * t0 * 0.8f64.powi(flight)).sum();
        let before = -speed * 0.8f64.powi(n as i32);
        for (line, velocity) in pair.iter().zip([before, -0.8 * before]) {
            // To rounding, of times near 1, amplified by speeds near 5.
            assert!((line[0] - t0 - flights).abs() < 1e-12, "{line:?}");
            assert!(line[1].abs() < 1e-12 && (line[2] - velocity).abs() < 1e-11, "{line:?}");
        }
    }
    let complaint = importer.run(&["cs", "5", "0.5", "events", "1"]).unwrap_err();
    assert!(complaint.contains("the event bounce accumulates at t = 4.063"), "{complaint}");
    assert!(complaint.contains("an event has occurred at t = 0.45152"), "{complaint}");
}

#[test]
fn a_model_without_events_has_no_event_mode() {
    let fmu = exported(&written(PUSHED), FmiVersion::V3);
    assert!(!fmu.model_description().contains("hasEventMode"));
    let importer = Importer::new(&fmu, FmiVersion::V3);
    let complaint = importer.run(&["cs", "1", "0.5", "events", "1"]).unwrap_err();
    assert!(complaint.contains("there is no event mode: the model has no events"), "{complaint}");
}

/// A cart with a pendulum, pushed by the input F.
const CART: &str = r#"
[parameters]
M = 1.0
m = 0.2
l = 0.5
J = "m*l^2/3"
g = 9.81

[inputs]
F = 0.25

[coordinates]
x = 0.0
"θ" = 0.1

[lagrangian]
kinetic = "(M + m)*x'^2/2 + m*l*x'*θ'*cos(θ) + (m*l^2 + J)*θ'^2/2"
potential = "m*g*l*cos(θ)"

[forces]
x = "F - 0.1*x'"

[outputs]
tip = "x + 2*l*sin(θ)"
push = "F*x'"
jerk = "d(θ')"

[simulation]
t_end = 1.0
"#;

#[test]
fn derivatives_along_directions_are_those_of_difference_quotients() {
    let cart = written(CART);
    for version in VERSIONS {
        let fmu = exported(&cart, version);
        let importer = Importer::new(&fmu, version);
        // Where the motion is after 0.3, by both sides of each known.
        for known in ["x'", "θ", "θ'", "F", "M", "l", "g"] {
            let set = reference(&fmu, known);
            for unknown in ["der(x)", "der(x')", "der(θ')", "tip", "push", "jerk", "x", "J"] {
                let of = reference(&fmu, unknown);
                let start: f64 = variable(&fmu, known, "start").unwrap().parse().unwrap();
                let at = |value: f64| {
                    let value = format!("{value:?}");
                    let lines = importer.run(&[
                        "cs",
                        "1",
                        "1",
                        "set",
                        &set,
                        &value,
                        "get",
                        &of,
                        "derivative",
                        &of,
                        &set,
                    ]);
                    (lines.as_ref().unwrap()[0][1], lines.unwrap()[0][2])
                };
                let h = 1e-5; // truncation h² and rounding ε/h are 1e-10
                let quotient = (at(start + h).0 - at(start - h).0) / (2.0 * h);
                let slope = at(start).1;
                assert!(
                    (slope - quotient).abs() < 1e-7 * (1.0 + slope.abs()),
                    "∂{unknown}/∂{known}: {slope} {quotient}"
                );
            }
        }
    }
}

/// A weight that is pushed, also as 3 sin t, from where its parameters put it; one of them follows another.
const MOVED: &str = r#"
[parameters]
k = 4.0
c = 0.5
w = "k^2"

[inputs]
a = 0.0
b = 0.0

[coordinates]
x = "c*w"

[quasi_velocities]
"x'" = 2.0

[lagrangian]
kinetic = "x'^2/2"

[forces]
x = "a*c + b*sign(x) - k*x' + 3*sin(t)"

[outputs]
twice = "2*x + w"
pull = "d(x')"

[simulation]
t_end = 1.0
"#;

#[test]
fn derivatives_before_the_start_follow_it() {
    for version in VERSIONS {
        let fmu = exported(&written(MOVED), version);
        let importer = Importer::new(&fmu, version);
        let slope = |when: &[&str], unknown: &str, known: &str| {
            let (unknown, known) = (reference(&fmu, unknown), reference(&fmu, known));
            let asked = ["cs", "1", "0.25", "derivative", &unknown, &known];
            importer
                .run(&[&asked, when].concat())
                .unwrap()
                .iter()
                .map(|line| [line[0], line[1]])
                .collect::<Vec<_>>()
        };
        // x = c w and w = k² at k = 4, c = 0.5; once the motion has begun x is on its own.
        let expected =
            [("w", "k", 8.0, 8.0), ("x", "k", 4.0, 0.0), ("x", "c", 16.0, 0.0), ("twice", "k", 16.0, 8.0)];
        for (unknown, known, before, later) in expected {
            assert_eq!(slope(&["initial"], unknown, known)[0][1], before, "∂{unknown}/∂{known}");
            assert_eq!(slope(&[], unknown, known)[0][1], later, "∂{unknown}/∂{known}");
        }
        for unknown in ["der(x')", "pull"] {
            for [t, by_time] in slope(&[], unknown, "t") {
                assert!((by_time - 3.0 * t.cos()).abs() < 1e-15, "{t} {by_time}");
            }
        }
        let complaint = importer
            .run(&["cs", "1", "1", "derivative", &reference(&fmu, "x"), &reference(&fmu, "w")])
            .unwrap_err();
        let expected = "derivatives are taken by time, states, parameters and inputs, not by value reference";
        assert!(complaint.contains(expected), "{complaint}");
    }
}

/// What a variable depends on by a list of the structure, and how.
fn depends(fmu: &Fmu, version: FmiVersion, list: &str, name: &str) -> String {
    let document = roxmltree::Document::parse(fmu.model_description()).unwrap();
    let names: Vec<&str> = document
        .descendants()
        .filter(|node| matches!(node.tag_name().name(), "ScalarVariable" | "Float64"))
        .map(|node| node.attribute("name").unwrap())
        .collect();
    let (tag, place, first) = match version {
        FmiVersion::V2 => ("Unknown", "index", 1),
        FmiVersion::V3 => (list, "valueReference", 0),
    };
    let of = |place: &str| names[place.parse::<usize>().unwrap() - first];
    let unknown = document
        .descendants()
        .filter(|node| node.has_tag_name(tag))
        .filter(|node| version == FmiVersion::V3 || node.parent().unwrap().has_tag_name(list))
        .find(|node| of(node.attribute(place).unwrap()) == name)
        .unwrap_or_else(|| panic!("no {name} in {list}"));
    let words = |name| unknown.attribute(name).unwrap_or_default().split_whitespace();
    let pairs = words("dependencies").zip(words("dependenciesKind"));
    pairs.map(|(on, kind)| format!("{} {kind}", of(on))).collect::<Vec<_>>().join(", ")
}

#[test]
fn dependencies_are_those_of_the_expressions() {
    let model = written(MOVED);
    let [fmi2, fmi3] = VERSIONS.map(|version| exported(&model, version));
    // No factor describes how a jump enters; parameters are known in FMI 3 only.
    let (outputs, rates) = (("Outputs", "Output"), ("Derivatives", "ContinuousStateDerivative"));
    let rows = [
        (outputs, "x", "x constant", "", ""),
        (outputs, "twice", "x constant", ", k dependent", ""),
        (rates, "der(x)", "x' constant", "", ""),
        (
            rates,
            "der(x')",
            "t dependent, x dependent, x' tunable",
            ", k dependent, c dependent",
            ", a tunable, b dependent",
        ),
    ];
    for ((of2, of3), name, known, parameters, inputs) in rows {
        assert_eq!(depends(&fmi2, FmiVersion::V2, of2, name), format!("{known}{inputs}"), "{name}");
        assert_eq!(
            depends(&fmi3, FmiVersion::V3, of3, name),
            format!("{known}{parameters}{inputs}"),
            "{name}"
        );
    }
    let at_start = [
        ("x", "k dependent, c dependent"),
        ("w", "k dependent"),
        ("twice", "k dependent, c dependent"),
        ("der(x)", "x' constant"),
    ];
    for (name, known) in at_start {
        assert_eq!(depends(&fmi2, FmiVersion::V2, "InitialUnknowns", name), known, "{name}");
        assert_eq!(depends(&fmi3, FmiVersion::V3, "InitialUnknown", name), known, "{name}");
    }
}

#[test]
fn units_are_those_of_time_and_of_angles_of_joints() {
    let arm = written(
        "[bodies.upper]\njoint = { kind = \"revolute\", axis = [0, 1, 0] }\nmass = 1.0\ncenter = [0, 0, -0.5]\n\
         [bodies.slide]\nparent = \"upper\"\njoint = { kind = \"prismatic\", axis = [0, 0, 1] }\nmass = 1.0\n\
         [simulation]\nt_end = 1.0\n",
    );
    for version in VERSIONS {
        let fmu = exported(&arm, version);
        let unit = |name: &str| variable(&fmu, name, "unit");
        let units = ["t", "upper", "upper'", "der(upper)", "der(upper')"].map(unit);
        assert_eq!(units.map(Option::unwrap), ["s", "rad", "rad/s", "rad/s", "rad/s2"]);
        assert_eq!(unit("slide"), None);
        let text = fmu.model_description();
        assert!(
            text.contains("<Unit name=\"rad/s2\">") && text.contains("<BaseUnit rad=\"1\" s=\"-2\"/>"),
            "{text}"
        );
    }
}

#[test]
fn units_are_those_that_the_text_names() {
    let spring = written(
        "[parameters]\nk = 4.0\n[coordinates]\nx = 1.0\n[lagrangian]\nkinetic = \"x'^2/2\"\npotential = \"k*x^2/2\"\n\
         [outputs]\npull = \"-k*x\"\nturn = \"x/2\"\n[units]\nx = \"m\"\n\"x'\" = \"m/s\"\nk = \"N/m\"\npull = \"N\"\nturn = \"rad\"\n\
         [simulation]\nt_end = 1.0\n",
    );
    for version in VERSIONS {
        let fmu = exported(&spring, version);
        let unit = |name: &str| variable(&fmu, name, "unit");
        let units = ["t", "x", "x'", "der(x)", "k", "pull", "turn"].map(unit);
        assert_eq!(units.map(Option::unwrap), ["s", "m", "m/s", "m/s", "N/m", "N", "rad"]);
        assert_eq!(unit("der(x')"), None);
        let text = fmu.model_description();
        // A name alone says nothing of its meaning.
        assert!(text.contains("<Unit name=\"rad\">") && text.contains("<Unit name=\"N/m\""), "{text}");
    }
}

#[test]
fn parameters_follow_and_inputs_act() {
    let fmu = exported(&written(CART), FmiVersion::V2);
    assert_eq!(variable(&fmu, "J", "causality").as_deref(), Some("calculatedParameter"));
    assert_eq!(variable(&fmu, "F", "causality").as_deref(), Some("input"));
    assert_eq!(variable(&fmu, "θ", "causality").as_deref(), Some("output"));
    assert_eq!(variable(&fmu, "der(θ)", "derivative").as_deref(), Some("3")); // the index of θ, from 1
    let importer = Importer::new(&fmu, FmiVersion::V2);
    let [l, j, f] = ["l", "J", "F"].map(|name| reference(&fmu, name));
    let lines = importer.run(&["cs", "1", "1", "set", &l, "3", "get", &j]).unwrap();
    assert!((lines[0][1] - 0.6).abs() < 1e-15);
    let complaint = importer.run(&["cs", "1", "1", "set", &j, "3"]).unwrap_err();
    assert!(complaint.contains("the parameter J follows from others: it cannot be set"), "{complaint}");
    // M + m moves as one mass where the pendulum hangs still: here it does not, so that the sign alone is looked at.
    let x = reference(&fmu, "x");
    let pushed = |force: &str| importer.run(&["cs", "1", "1", "set", &f, force, "get", &x]).unwrap()[1][1];
    assert!(pushed("5") > 1.0 && pushed("-5") < -1.0);
}

/// Two inputs push a mass, one of them through a state: ẍ = a + b z, ż = b.
const PUSHED: &str = r#"
[inputs]
a = 0.0
b = 0.0

[coordinates]
x = 0.0

[states.z]
rate = "b"

[lagrangian]
kinetic = "x'^2/2"

[forces]
x = "a + b*z"

[outputs]
power = "a*x'"

[simulation]
t_end = 2.0
"#;

/// With a = b = sin t from rest, the first on its own: x = t − sin t, and the second as well: z = 1 − cos t, so that
/// b z = sin t − sin 2t/2 and x = 2 (t − sin t) − (2t − sin 2t)/8.
fn pushed(t: f64, both: bool) -> [f64; 2] {
    match both {
        false => [t - t.sin(), 1.0 - t.cos()],
        true => [
            2.0 * (t - t.sin()) - (2.0 * t - (2.0 * t).sin()) / 8.0,
            2.0 * (1.0 - t.cos()) - (1.0 - (2.0 * t).cos()) / 4.0,
        ],
    }
}

#[test]
fn inputs_move_between_communication_points_as_the_importer_says() {
    let model = written(PUSHED);
    let solvers = [
        (FmuSolver::Dop853, 1e-9),
        (FmuSolver::Radau5, 1e-9),
        // h⁴ t/120, twice.
        (FmuSolver::RungeKutta4 { step: 0.02 }, 1e-8),
    ];
    for (solver, within) in solvers {
        for version in VERSIONS {
            let fmu = export(&model, &FmuOptions::new(version, "it").solver(solver)).unwrap();
            let importer = Importer::new(&fmu, version);
            let [x, v, a, b, power] = ["x", "x'", "a", "b", "power"].map(|name| reference(&fmu, name));
            let asked = ["get", &x, "get", &v, "get", &power];
            let worst = |more: &[&str], both: bool| {
                let lines = importer.run(&[&["cs", "2", "0.1"], more, &asked].concat()).unwrap();
                assert_eq!(lines.len(), 21);
                let errors = lines.iter().map(|line| {
                    let [x, v] = pushed(line[0], both);
                    let power = line[0].sin() * v;
                    [(x, line[1]), (v, line[2]), (power, line[3])]
                        .map(|(a, b)| (a - b).abs())
                        .into_iter()
                        .fold(0.0, f64::max)
                });
                errors.fold(0.0, f64::max)
            };
            // Held, the force comes half a step of 0.1 late: the velocity lacks 0.05 sin t.
            let held = worst(&["sine", &a, "0"], false);
            assert!(held > 0.04 && held < 0.2, "{solver:?} {version:?}: {held:e}");
            let bound = |order: i32| match version {
                // What is left of the series, (0.1)ⁿ⁺¹/(n + 1)!, at all times of a way of length 2, and what the method leaves.
                FmiVersion::V2 => 0.2 * f64::powi(0.1, order) + within,
                FmiVersion::V3 => within,
            };
            for order in [1, 2, 3, 7] {
                let text = order.to_string();
                let alone = worst(&["sine", &a, &text], false);
                let both = worst(&["sine", &a, &text, "sine", &b, &text], true);
                let most = bound(order);
                assert!(alone < most && both < most, "{solver:?} {version:?} {order}: {alone:e} {both:e}");
            }
        }
    }
}

#[test]
fn a_saved_state_has_the_derivatives_of_inputs_and_the_event_that_waits() {
    for version in VERSIONS {
        let fmu = exported(&written(PUSHED), version);
        let importer = Importer::new(&fmu, version);
        let [x, a] = ["x", "a"].map(|name| reference(&fmu, name));
        let run = |more: &[&str]| {
            importer.run(&[&["cs", "2", "0.1", "sine", &a, "3", "get", &x], more].concat()).unwrap()
        };
        assert_eq!(run(&["again"]), run(&[]), "{version:?}");
    }
    let fmu = exported(&model("bouncing-ball"), FmiVersion::V3);
    let importer = Importer::new(&fmu, FmiVersion::V3);
    let run = |more: &[&str]| {
        importer.run(&[&["cs", "2", "0.5", "get", &reference(&fmu, "y")], more].concat()).unwrap()
    };
    assert_eq!(run(&["events", "1", "again"]), run(&[]));
}

#[test]
fn a_jump_of_an_input_in_event_mode_passes_events_at_once() {
    let kicked = written(
        "[inputs]\na = -1.0\n[coordinates]\nx = 0.0\n[quasi_velocities]\n\"x'\" = 1.0\n[lagrangian]\nkinetic = \"x'^2/2\"\n\
         [events.kick]\nwhen = \"a - x/2\"\ndirection = \"rising\"\nreset = { \"x'\" = \"2*x'\" }\n[simulation]\nt_end = 2.0\n",
    );
    let fmu = exported(&kicked, FmiVersion::V3);
    let importer = Importer::new(&fmu, FmiVersion::V3);
    let [x, v, a] = ["x", "x'", "a"].map(|name| reference(&fmu, name));
    let asked = ["cs", "2", "1", "jump", &a, "3", "1", "get", &x, "get", &v];
    let rows = |more: &[&str]| importer.run(&[&asked, more].concat()).unwrap();
    // Twice as fast from t = 1 on: known at once in event mode, within the next step otherwise.
    let expected = [[0.0, 0.0, 1.0], [1.0, 1.0, 1.0], [1.0, 1.0, 2.0], [2.0, 3.0, 2.0]];
    for (found, expected) in rows(&["events", "1"]).iter().zip(expected) {
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?} {expected:?}");
    }
    let without = rows(&[]);
    assert!(without.len() == 3 && (without[2][1] - 3.0).abs() < 1e-12, "{without:?}");
}

#[test]
fn a_step_returns_early_where_the_importer_asks_for_that() {
    let model = written(PUSHED);
    let options = FmuOptions::new(FmiVersion::V3, "it").solver(FmuSolver::RungeKutta4 { step: 0.02 });
    let fmu = export(&model, &options).unwrap();
    let importer = Importer::new(&fmu, FmiVersion::V3);
    let [x, a] = ["x", "a"].map(|name| reference(&fmu, name));
    // The importer of the test sees to it that the step from 0.2 ends at this time.
    let lines = importer.run(&["cs", "2", "0.1", "sine", &a, "1", "early", "0.2345", "get", &x]).unwrap();
    for line in lines {
        assert!((line[1] - pushed(line[0], false)[0]).abs() < 1e-8, "{line:?}");
    }
}

#[test]
fn derivatives_are_of_inputs_and_their_orders_few() {
    let fmu = exported(&written(PUSHED), FmiVersion::V2);
    let importer = Importer::new(&fmu, FmiVersion::V2);
    let complaint = importer.run(&["cs", "1", "1", "sine", &reference(&fmu, "a"), "9"]).unwrap_err();
    let expected = "the derivative of order 9 of the input a: orders are 1 to 8";
    assert!(complaint.contains(expected), "{complaint}");
    let abilities = [
        (FmiVersion::V2, "canInterpolateInputs=\"true\""),
        (
            FmiVersion::V3,
            "providesIntermediateUpdate=\"true\" canReturnEarlyAfterIntermediateUpdate=\"true\" \
                          recommendedIntermediateInputSmoothness=\"8\"",
        ),
    ];
    for (version, ability) in abilities {
        let fmu = exported(&written(PUSHED), version);
        assert!(fmu.model_description().contains(ability), "{}", fmu.model_description());
    }
    // Without inputs there is nothing to interpolate.
    let alone = exported(&model("heavy-top-lagrange"), FmiVersion::V2);
    assert!(!alone.model_description().contains("canInterpolateInputs"));
}

#[test]
fn co_simulation_stays_on_constraints_and_refuses_a_start_off_them() {
    let pendulum = written(
        "[coordinates]\nx = 0.6\ny = 0.0\nz = -0.8\n[quasi_velocities]\n\"y'\" = 1.5\n\
         [constraints]\nrod = \"x^2 + y^2 + z^2 - 1\"\n\
         [lagrangian]\nkinetic = \"(x'^2 + y'^2 + z'^2)/2\"\npotential = \"10*z\"\n\
         [simulation]\nt_end = 5.0\nproject = [\"energy\"]\nindependent = [\"x'\", \"y'\"]\n",
    );
    let fmu = exported(&pendulum, FmiVersion::V3);
    let projected = "In Co-Simulation each step is projected to rod, energy";
    assert!(fmu.notes().iter().any(|note| note.contains(projected)), "{:?}", fmu.notes());
    assert_eq!(variable(&fmu, "x", "initial").as_deref(), Some("exact"));
    let importer = Importer::new(&fmu, FmiVersion::V3);
    let [x, y, z, energy] = ["x", "y", "z", "energy"].map(|name| reference(&fmu, name));
    let lines = importer.run(&["cs", "5", "0.1", "get", &x, "get", &y, "get", &z, "get", &energy]).unwrap();
    for line in &lines {
        // A projection ends within rounding, of numbers up to 10.
        let length: f64 = line[1..4].iter().map(|x| x * x).sum();
        assert!((length - 1.0).abs() < 1e-14 && (line[4] - (-8.0 + 1.125)).abs() < 1e-13, "{line:?}");
    }
    let complaint = importer.run(&["cs", "1", "1", "set", &x, "0.9"]).unwrap_err();
    assert!(complaint.contains("the start is off the constraint rod: it is 0.45, not 0"), "{complaint}");
}

#[test]
fn each_method_of_co_simulation_has_its_order() {
    let oscillator = written(
        "[coordinates]\nx = 1.0\n[lagrangian]\nkinetic = \"x'^2/2\"\npotential = \"x^2/2\"\n[simulation]\nt_end = 10.0\n",
    );
    // cos 10 by steps of 0.1, h⁴ t/120 = 1e-5 for the method of order 4; by the tolerance 1e-9 for the others.
    let methods =
        [(FmuSolver::Dop853, 1e-8), (FmuSolver::Radau5, 1e-8), (FmuSolver::RungeKutta4 { step: 0.1 }, 2e-5)];
    for (solver, bound) in methods {
        let options = FmuOptions::new(FmiVersion::V2, "it").solver(solver);
        let fmu = export(&oscillator, &options).unwrap();
        let importer = Importer::new(&fmu, FmiVersion::V2);
        let lines = importer.run(&["cs", "10", "2.5", "get", &reference(&fmu, "x")]).unwrap();
        let error = (lines.last().unwrap()[1] - 10.0f64.cos()).abs();
        assert!(error < bound, "{solver:?}: {error:e}");
    }
    let step = FmuSolver::RungeKutta4 { step: -1.0 };
    let refused = export(&oscillator, &FmuOptions::new(FmiVersion::V2, "it").solver(step));
    assert!(matches!(refused, Err(FmuError::Step { .. })));
}

#[test]
fn what_has_no_formula_is_refused() {
    let wall = written(
        "[coordinates]\nx = 0.6\nz = -0.8\n[constraints]\nrod = \"x^2 + z^2 - 1\"\n\
         [lagrangian]\nkinetic = \"(x'^2 + z'^2)/2\"\npotential = \"z\"\n\
         [events.wall]\nwhen = \"x\"\nreset = { \"x'\" = \"-x'\" }\n[simulation]\nt_end = 3.0\n",
    );
    let refused = export(&wall, &FmuOptions::new(FmiVersion::V2, "it")).unwrap_err();
    assert!(matches!(&refused, FmuError::ResetUnderConstraints { event } if event == "wall"), "{refused}");
}

#[test]
fn the_same_model_gives_the_same_bytes() {
    let bytes = |version| {
        let mut out = std::io::Cursor::new(Vec::new());
        exported(&model("heavy-top-lagrange"), version).write(&mut out).unwrap();
        out.into_inner()
    };
    for version in VERSIONS {
        assert!(bytes(version) == bytes(version));
    }
}

/// Each model of the program but those of many bodies, whose derivatives along a direction take minutes in a test.
#[test]
fn all_models_are_exported() {
    for builtin in pc_model::BUILTIN {
        let model = Model::new(builtin.document().unwrap());
        let fmu = export(&model, &FmuOptions::new(FmiVersion::V3, "it"));
        let fmu = fmu.unwrap_or_else(|error| panic!("{}: {error}", builtin.name));
        assert_eq!(variable(&fmu, "energy", "causality").as_deref(), Some("output"), "{}", builtin.name);
    }
}

/// The example of the documentation.
#[test]
fn the_example_of_the_page_is_exported() {
    let page = include_str!("../../../docs/fmu.md");
    let text = page.split("```toml\n").nth(1).unwrap().split("```").next().unwrap();
    let fmu = exported(&written(text), FmiVersion::V3);
    for name in ["x", "θ", "x'", "θ'", "tip"] {
        assert_eq!(variable(&fmu, name, "causality").as_deref(), Some("output"));
    }
    assert_eq!(variable(&fmu, "F", "causality").as_deref(), Some("input"));
}
