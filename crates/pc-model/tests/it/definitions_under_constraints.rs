//! Quasi-velocities defined by `is` together with `[constraints]`: how velocities and their start are
//! determined, and every refusal in full.

use pc_mech::{Graph, VectorField};
use pc_model::{Category, ConstraintFormulation, Document, Flow, Model, ModelError, Source, Variables};

use crate::verified::derived_twice;

/// A pendulum of length one in Cartesian coordinates, by its angular velocity.
const PENDULUM: &str = r#"[coordinates]
x = 0.6
y = -0.8
[quasi_velocities]
w = { is = "x*y' - y*x'", start = 0.2 }
[constraints]
rod = "x^2 + y^2 - 1"
[lagrangian]
kinetic = "(x'^2 + y'^2)/2"
potential = "y"
"#;

/// A wheel of radius r on the ground.
const WHEEL: &str = r#"[parameters]
r = 0.5
[coordinates]
x = 0
y = "r"
"φ" = 0
[quasi_velocities]
"ω" = { is = "φ'", start = 2.0 }
[constraints]
rolls = "x' - r*ω"
contact = "y - r"
[lagrangian]
kinetic = "(x'^2 + y'^2)/2 + r^2*φ'^2/4"
potential = "0.3*x"
"#;

fn model(text: &str) -> Model {
    derived_twice(Document::parse(Source::new("m.toml", text)).unwrap_or_else(|error| panic!("{error}")))
}

/// Names, state and rates at the start.
type Tried = (Vec<String>, Vec<f64>, Vec<f64>);

/// Assembles the model and evaluates it at its start: names and values of the state, and its rates.
fn tried(model: &Model) -> Result<Tried, ModelError> {
    let graph = Graph::new();
    let assembly = model.assemble(&graph)?;
    let (mut motion, start) = model.compile(&assembly)?;
    let mut rates = vec![0.0; start.len()];
    motion.rhs(assembly.t_start, &start, &mut rates).unwrap();
    Ok((motion.names().to_vec(), start, rates))
}

#[track_caller]
fn refuses(text: &str, expected: &str) {
    let error = tried(&model(text)).map(|found| panic!("accepted: {found:?}")).unwrap_err();
    assert_eq!(error.to_string(), expected);
    assert_eq!(error.category(), Category::Inconsistent);
}

/// Start value and rate of a component.
#[track_caller]
fn of(model: &Model, name: &str) -> (f64, f64) {
    let (names, start, rates) = tried(model).unwrap_or_else(|error| panic!("{error}"));
    let place = names.iter().position(|known| known == name).unwrap();
    (start[place], rates[place])
}

/// ẇ = −x, ẋ = −y w, ẏ = x w
#[test]
fn a_pendulum_moves_by_its_angular_velocity() {
    let pendulum = model(PENDULUM);
    for (name, rate) in [("x", 0.16), ("y", 0.12), ("w", -0.6)] {
        assert!((of(&pendulum, name).1 - rate).abs() < 1e-15, "{name}: a rounding or two");
    }
    let graph = Graph::new();
    let assembly = pendulum.assemble(&graph).unwrap();
    assert_eq!(assembly.declared, 1);
    assert!(
        matches!(assembly.constraints.formulation(), ConstraintFormulation::Multipliers(_)),
        "the position is held"
    );
    let equations = assembly.equations().unwrap();
    assert_eq!(equations.system().quasi_velocities(), [graph.symbol("w")]);
}

/// For any defined velocity: x'' = −x (w² − y) for the pendulum with w = y'/x = −x'/y.
#[test]
fn any_choice_of_velocities_gives_the_same_motion() {
    let by = |is: &str, start: f64| {
        let text = PENDULUM.replace("x*y' - y*x'", is).replace("start = 0.2", &format!("start = {start}"));
        model(&text)
    };
    let (w, x, y) = (0.2, 0.6, -0.8);
    let acceleration = [-y * -x - x * w * w, x * -x - y * w * w];
    assert!((of(&by("x'", -y * w), "w").1 - acceleration[0]).abs() < 1e-15);
    assert!((of(&by("y'", x * w), "w").1 - acceleration[1]).abs() < 1e-15);
    let expected = 3.0 * acceleration[0] - acceleration[1];
    assert!((of(&by("3*x' - y'", -3.0 * y * w - x * w), "w").1 - expected).abs() < 1e-14);
}

/// η in a constraint stands for its definition, also inside an entry of `[definitions]`.
#[test]
fn rolling_may_be_written_with_the_angular_velocity() {
    let expected = -0.3 * 0.5 / (0.25 + 0.125); // (m r² + m r²/2) ω̇ = −0.3 r
    for rolls in ["x' - r*ω", "x' - r*φ'", "x' - slip"] {
        let text =
            WHEEL.replace("x' - r*ω", rolls).replace("[quasi", "[definitions]\nslip = \"r*ω\"\n[quasi");
        let (start, rate) = of(&model(&text), "ω");
        assert_eq!(start, 2.0);
        assert!((rate - expected).abs() < 1e-15, "{rolls}: {rate}");
        assert!((of(&model(&text), "x").1 - 1.0).abs() < 1e-15, "{rolls}");
        assert!(of(&model(&text), "y").1.abs() < 1e-15, "{rolls}");
    }
}

#[test]
fn constraints_that_follow_from_others_are_dropped() {
    let text = WHEEL.replace("[lagrangian]", "again = \"2*x' - 2*r*φ'\"\nstays = \"y'\"\n[lagrangian]");
    let graph = Graph::new();
    let assembly = model(&text).assemble(&graph).unwrap();
    let dropped: Vec<(&str, &[String])> = assembly
        .constraints
        .redundant()
        .iter()
        .map(|r| (r.constraint.as_str(), r.follows_from.as_slice()))
        .collect();
    assert_eq!(dropped, [("again", &["rolls".to_owned()][..]), ("stays", &["contact".to_owned()][..])]);
}

#[test]
fn definitions_and_constraints_are_as_many_as_coordinates() {
    let help = "\n  help: give as many independent definitions (and constraints) as there are coordinates";
    let line = "\n    w = { is = \"x*y' - y*x'\", start = 0.2 }\n    ^";
    refuses(
        &PENDULUM.replace("y = -0.8", "y = -0.8\nz = 0"),
        &format!(
            "m.toml:6:1: [quasi_velocities] w: 2 definitions of quasi-velocities cannot be solved for 3 velocities{line}{help}"
        ),
    );
    refuses(
        &PENDULUM.replace("[lagrangian]", "top = \"y + 0.8\"\n[lagrangian]"),
        &format!(
            "m.toml:5:1: [quasi_velocities] w: 3 definitions of quasi-velocities cannot be solved for 2 velocities{line}{help}"
        ),
    );
    // The constraint keeps the definition constant.
    refuses(
        &PENDULUM.replace("x*y' - y*x'", "x*x' + y*y'").replace("start = 0.2", "start = 0"),
        &format!(
            "m.toml:7:8: [constraints] rod: the definitions of the quasi-velocities are linearly dependent: their matrix is \
             singular everywhere\n    rod = \"x^2 + y^2 - 1\"\n           ^^^^^^^^^^^^^{help}"
        ),
    );
}

#[test]
fn the_start_must_determine_all_velocities() {
    let text = PENDULUM.replace("x*y' - y*x'", "x'").replace("x = 0.6\ny = -0.8", "x = 1\ny = 0");
    refuses(
        &text.replace("start = 0.2", "start = 0"),
        "m.toml:5:1: [quasi_velocities] w: at the start the definitions of the quasi-velocities and the constraints leave y' \
         undetermined\n    w = { is = \"x'\", start = 0 }\n    ^\n  \
         help: start where they are determined, or define other quasi-velocities",
    );
}

/// x' = −y w
#[test]
fn quasi_velocities_follow_from_start_velocities() {
    let text = PENDULUM.replace(", start = 0.2 }", " }\n\"x'\" = 0.8");
    assert!((of(&model(&text), "w").0 - 1.0).abs() < 1e-15);
    let both = PENDULUM.replace("0.2 }", "0.2 }\n\"x'\" = 0.16");
    assert_eq!(of(&model(&both), "w").0, 0.2);
    refuses(
        &both.replace("0.16", "0.8"),
        "m.toml:6:8: [quasi_velocities] x': the start velocity `x'` = 0.8 contradicts the quasi-velocities: by their start it \
         is 0.16\n    \"x'\" = 0.8\n           ^^^\n  \
         help: leave it out, or the `start` of a quasi-velocity, which then follows",
    );
    // With [kinematics], too, and where two of them are needed.
    let sleigh = "[coordinates]\nx = 0\ny = 0\nφ = 0.5\n[quasi_velocities]\nv = { is = \"cos(φ)*x' + sin(φ)*y'\" }\n\
                  u = { is = \"cos(φ)*y' - sin(φ)*x'\" }\nω = { is = \"φ'\", start = 2 }\n\"x'\" = 3\n\"y'\" = 4\n[lagrangian]\n\
                  kinetic = \"(x'^2 + y'^2 + φ'^2)/2\"\n";
    let sleigh = model(
        &sleigh
            .replace('φ', "\"φ\"")
            .replace("ω =", "\"ω\" =")
            .replace("(\"φ\")", "(φ)")
            .replace("\"φ\"'", "φ'"),
    );
    let (sine, cosine) = 0.5f64.sin_cos();
    assert!((of(&sleigh, "v").0 - (3.0 * cosine + 4.0 * sine)).abs() < 1e-14);
    assert!((of(&sleigh, "u").0 - (4.0 * cosine - 3.0 * sine)).abs() < 1e-14);
    assert_eq!(of(&sleigh, "ω").0, 2.0);
}

#[test]
fn held_start_values_are_not_moved() {
    let off = PENDULUM
        .replace("y = -0.8", "y = -0.7")
        .replace("w = { is = \"x*y' - y*x'\", start = 0.2 }", "\"x'\" = 0.8");
    let moved = |held: &[&str]| {
        let mut model = model(&off);
        model.project_start(true);
        held.iter().for_each(|name| model.hold_start(name).unwrap());
        tried(&model).map(|(_, start, _)| start)
    };
    let close = |found: Vec<f64>, expected: [f64; 4]| {
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-14), "{found:?}");
    };
    // The component of the velocity along the circle.
    close(moved(&["x"]).unwrap(), [0.6, -0.8, 0.8 * 0.64, 0.8 * 0.48]);
    close(moved(&["x", "x'"]).unwrap(), [0.6, -0.8, 0.8, 0.6]);
    close(moved(&["y", "y'"]).unwrap(), [0.51f64.sqrt(), -0.7, 0.0, 0.0]);
    assert_eq!(
        moved(&["x", "y"]).unwrap_err().to_string(),
        "m.toml:7:8: [constraints] rod: with x, y kept, nothing is left to move to the constraint `rod`\n    \
         rod = \"x^2 + y^2 - 1\"\n           ^^^^^^^^^^^^^\n  help: keep less"
    );
    let unknown = model(&off).hold_start("z").unwrap_err();
    assert_eq!(unknown.to_string(), "`z` has no start value in this model; x, y, x', y' have");
    // The quasi-velocities of definitions that constraints complete are prescribed.
    let mut by_velocity = model(&PENDULUM.replace("x*y' - y*x'", "x'").replace("y = -0.8", "y = -0.7"));
    by_velocity.project_start(true);
    assert_eq!(of(&by_velocity, "w").0, 0.2);
}

#[test]
fn an_invalid_reset_lists_what_can_be_reset() {
    let text = "[coordinates]\nx = 0.0\ny = 0.0\n[quasi_velocities]\nw1 = { is = \"x'\", start = 0.0 }\n\
                w2 = { is = \"y'\", start = 1.0 }\n[constraints]\nm0 = \"w1\"\n[lagrangian]\nkinetic = \"(x'^2 + y'^2)/2\"\n\
                [events.e]\nwhen = \"y - 0.5\"\nreset = { w1 = \"0.3\" }\n";
    let error = tried(&model(text)).unwrap_err();
    assert_eq!(
        error.to_string(),
        "m.toml:13:11: [events.e] reset.w1: `w1` cannot be reset: it is a quasi-velocity that a constraint keeps at zero\n    \
         reset = { w1 = \"0.3\" }\n              ^^\n  help: an event can reset x, y, w2"
    );
}

/// Mechanisms in quasi-velocities that the velocities of coordinates, or constraints, complete; functions to differentiate, and
/// independent velocities.
const MOVING: [(&str, &[&str], &[&str]); 6] = [
    // Coefficients of the definition contain a coordinate that follows.
    (
        "[coordinates]\na = 0.7\nb = 0.49\nc = 0.343\n[quasi_velocities]\nw = { is = \"exp(b/2)*a' + 0.4*c'\", start = 0.9 }\n\
         [constraints]\nk0 = \"b - a^2\"\nk1 = \"c - a^3\"\n[lagrangian]\nkinetic = \"(a'^2 + 2*b'^2 + c'^2)/2\"\n",
        &["a'", "b'", "c'", "w", "w*a'*c", "b'*c' + sin(t)*w^2"],
        &["w"],
    ),
    // A rod that becomes longer.
    (
        "[coordinates]\nx = 0.6\ny = -0.8\n[quasi_velocities]\nw = { is = \"x' + 0.2*y'\", start = 1.1 }\n[constraints]\n\
         rod = \"x^2 + y^2 - (1 + t/3)^2\"\n[lagrangian]\nkinetic = \"(x'^2 + y'^2)/2\"\npotential = \"y\"\n",
        &["x'", "y'", "w", "x*y' - y*x'"],
        &["y'"],
    ),
    // Two degrees of freedom, a definition that changes with time.
    (
        "[coordinates]\nx = 1.0\ny = 0.5\nz = 0.2\n[quasi_velocities]\nu = { is = \"x' + y*z'\", start = 0.4 }\n\
         v = { is = \"2*z' + t*y\", start = -0.3 }\n[constraints]\nk = \"y - x^2/2 - sin(t)\"\n[lagrangian]\n\
         kinetic = \"(x'^2 + 2*y'^2 + 3*z'^2)/2\"\npotential = \"x^2 + z*y\"\n",
        &["x'", "y'", "z'", "u*v", "t*y'"],
        &["u", "v"],
    ),
    // A knife edge on a surface: constraints of both kinds.
    (
        "[coordinates]\nx = 0.1\ny = 0.2\nq = 0.3\nz = 0.02\n[quasi_velocities]\n\
         v = { is = \"cos(q)*x' + sin(q)*y' + z'/5\", start = 1.0 }\nw = { is = \"q' + z*x'\", start = 0.7 }\n[constraints]\n\
         edge = \"sin(q)*x' - cos(q)*y'\"\nlift = \"z - x*y\"\n[lagrangian]\n\
         kinetic = \"(x'^2 + y'^2 + 2*q'^2 + z'^2)/2\"\npotential = \"x/3 + q^2 + z\"\n",
        &["x'", "y'", "z'", "v*w", "q'*z'"],
        &["v", "w"],
    ),
    // A first-order state pulls.
    (
        "[coordinates]\nx = 0.6\ny = 0.36\n[quasi_velocities]\nw = { is = \"x' + y*y'\", start = 1.0 }\n[constraints]\n\
         k = \"y - x^2\"\n[states]\ns = { start = 0.2, rate = \"x' - s\" }\n[lagrangian]\nkinetic = \"(x'^2 + y'^2)/2\"\n\
         [forces]\nx = \"-s\"\n",
        &["x'", "y'", "s*y'", "w*s"],
        &["w"],
    ),
    // As many definitions as coordinates, which a constraint binds.
    (
        "[coordinates]\na = 0.4\nb = 0.1\n[quasi_velocities]\nu = { is = \"a' + sin(a)*b'\", start = 0.3 }\n\
         v = { is = \"b'*exp(a/3)\", start = 1.0 }\n[constraints]\nk = \"u - 0.3*v\"\n[lagrangian]\n\
         kinetic = \"(a'^2 + b'^2 + a'*b'*cos(a - b))/2\"\npotential = \"-cos(a) - cos(b)\"\n",
        &["a'", "b'", "u*v", "a'*b'"],
        &["v"],
    ),
];

/// A form of the equations of a model, with the independent velocities asked for.
fn flow(text: &str, variables: Variables, independent: &[&str]) -> Flow {
    let mut model = model(text);
    model.choose_independent(independent.iter().copied());
    let graph = Graph::new();
    let assembly = model.assemble(&graph).unwrap_or_else(|error| panic!("{error}\n{text}"));
    Flow::new(&model, &assembly, variables).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// The rate of a function along the motion is its difference quotient along (1, ẏ), at the start and beside it.
#[test]
fn rates_of_velocities_are_those_along_the_motion() {
    for (text, functions, chosen) in MOVING {
        let outputs =
            functions.iter().enumerate().map(|(i, f)| format!("f{i} = \"{f}\"\nd{i} = \"d({f})\"\n"));
        let text = format!("{text}[outputs]\n{}", outputs.collect::<String>());
        let forms = [
            (Variables::QuasiVelocities, &[][..]),
            (Variables::Momenta, &[]),
            (Variables::QuasiVelocities, chosen),
            (Variables::Momenta, chosen),
        ];
        for (variables, independent) in forms {
            let mut flow = flow(&text, variables, independent);
            let start = flow.start.clone();
            let mut rates = vec![f64::NAN; start.len()];
            flow.motion.rhs(0.0, &start, &mut rates).unwrap();
            let mut at = |h: f64| {
                let moved: Vec<f64> = start.iter().zip(&rates).map(|(y, rate)| y + h * rate).collect();
                flow.row(h, &moved)
            };
            // Quotients of order 4: their truncation, of h⁴, and rounding are below 1e-10.
            let h = 1e-3;
            let (here, values) = (at(0.0), [at(h), at(-h), at(2.0 * h), at(-2.0 * h)]);
            let names = [flow.names.clone(), flow.motion.observable_names().to_vec()].concat();
            let place = |name: String| names.iter().position(|known| *known == name).unwrap();
            for (i, f) in functions.iter().enumerate() {
                let (f_place, d_place) = (place(format!("f{i}")), place(format!("d{i}")));
                let [ahead, behind, far_ahead, far_behind] = &values;
                let quotient = (8.0 * (ahead[f_place] - behind[f_place]) - far_ahead[f_place]
                    + far_behind[f_place])
                    / (12.0 * h);
                let rate = here[d_place];
                assert!(
                    (rate - quotient).abs() < 1e-8 * rate.abs().max(1.0),
                    "d({f}) by {variables:?} {independent:?}: {rate} is not {quotient}\n{text}"
                );
            }
        }
    }
}

/// On the curve (a, a², a³) without forces the energy a'² (1 + 4 a² + 9 a⁴)/2 stays, so that a'' = −a'² (4 a + 18 a³)/(1 + 4 a²
/// + 9 a⁴), and c'' = 3 a² a'' + 6 a a'².
#[test]
fn accelerations_on_a_curve_are_those_of_its_formula() {
    for (a, start) in [(0.6f64, 1.0), (0.5, -0.7), (1.2, 0.3)] {
        let text = format!(
            "[coordinates]\na = {a}\nb = {}\nc = {}\n[quasi_velocities]\nw = {{ is = \"cos(b)*a' + 0.3*c'\", start = {start} }}\n\
             [constraints]\nk0 = \"b - a^2\"\nk1 = \"c - a^3\"\n[lagrangian]\nkinetic = \"(a'^2 + b'^2 + c'^2)/2\"\n\
             [outputs]\nbend = \"d(c')\"\n",
            a * a,
            a * a * a
        );
        let speed = start / ((a * a).cos() + 0.9 * a * a);
        let slow = -speed * speed * (4.0 * a + 18.0 * a.powi(3)) / (1.0 + 4.0 * a * a + 9.0 * a.powi(4));
        let expected = 3.0 * a * a * slow + 6.0 * a * speed * speed;
        for (variables, independent) in [
            (Variables::QuasiVelocities, &[][..]),
            (Variables::QuasiVelocities, &["w"]),
            (Variables::QuasiVelocities, &["b'"]),
            (Variables::Momenta, &[]),
            (Variables::Momenta, &["w"]),
            (Variables::Orthonormal, &["w"]),
        ] {
            let mut flow = flow(&text, variables, independent);
            let place = flow.motion.observable_names().iter().position(|name| name == "bend").unwrap();
            let bend = flow.row(0.0, &flow.start.clone())[flow.names.len() + place];
            assert!(
                (bend - expected).abs() < 1e-13 * expected.abs().max(10.0),
                "{variables:?} {independent:?} at {a}: {bend} is not {expected}"
            );
        }
    }
}
