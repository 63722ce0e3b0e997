//! `[constraints]`: their effect on a model, and every refusal in full.

use pc_mech::{Graph, VectorField};
use pc_model::{Category, ConstraintFormulation, Document, Model, ModelError, Source};
use pc_nonholo::{ConstraintKind, Redundant};

use crate::verified::derived_twice;

/// A point in a vertical plane, below the origin.
const BELOW: &str = "x = 0.6\ny = -0.8\n";

/// The model of a heavy point in a plane with this start, with further sections, under constraints.
fn point(start: &str, more: &str, constraints: &str) -> String {
    format!(
        "[coordinates]\n{start}{more}[constraints]\n{constraints}\n[lagrangian]\n\
         kinetic = \"(x'^2 + y'^2)/2\"\npotential = \"9.8*y\"\n"
    )
}

const SLEIGH: &str = r#"[parameters]
m = 1.0
J = 0.5
a = 0.3
[coordinates]
x = 0.0
y = 0.0
phi = 0.4
[quasi_velocities]
v = { is = "cos(phi)*x' + sin(phi)*y'", start = 1.0 }
omega = { is = "phi'", start = 2.0 }
[lagrangian]
kinetic = "m/2*(x'^2 + y'^2) + m*a*omega*(cos(phi)*y' - sin(phi)*x') + (J + m*a^2)/2*omega^2"
[constraints]
"#;

const BLADE: &str = "blade = \"-sin(phi)*x' + cos(phi)*y'\"\n";

fn model(text: &str) -> Model {
    derived_twice(Document::parse(Source::new("m.toml", text)).unwrap_or_else(|error| panic!("{error}")))
}

/// Assembles, compiles and evaluates the model at its start; or returns the error.
fn tried(model: &Model) -> Result<Vec<f64>, ModelError> {
    let graph = Graph::new();
    let assembly = model.assemble(&graph)?;
    let (mut motion, start) = model.compile(&assembly)?;
    let mut rates = vec![0.0; start.len()];
    motion.rhs(assembly.t_start, &start, &mut rates).unwrap();
    Ok(assembly.start)
}

fn error(text: &str) -> ModelError {
    tried(&model(text)).map(|start| panic!("accepted from {start:?}: {text}")).unwrap_err()
}

#[track_caller]
fn refuses(text: &str, category: Category, expected: &str) {
    let error = error(text);
    assert_eq!(error.to_string(), expected);
    assert_eq!(error.category(), category);
}

#[track_caller]
fn refuses_point(start: &str, constraints: &str, category: Category, expected: &str) {
    refuses(&point(start, "", constraints), category, expected);
}

#[test]
fn texts_that_are_not_constraints_are_refused() {
    refuses_point(
        BELOW,
        "length = \"x^2 + z^2 - 1\"",
        Category::Text,
        "m.toml:5:17: [constraints] length: the name `z` is not declared\n    length = \"x^2 + z^2 - 1\"\n                    \
         ^\n  help: declare it, for example in [parameters]",
    );
    refuses_point(
        BELOW,
        "stop = \"d(x')\"",
        Category::Text,
        "m.toml:5:9: [constraints] stop: `d()` of velocities gives accelerations, which cannot be used in a constraint\
         \n    stop = \"d(x')\"\n            ^^^^^\n  help: accelerations can be used in [integrals] and [outputs]",
    );
    refuses_point(
        BELOW,
        "speed = \"x'^2 + y'^2 - 1\"",
        Category::Text,
        "m.toml:5:10: [constraints] speed: `x'^2 + y'^2 - 1` is not affine in the velocities\n    \
         speed = \"x'^2 + y'^2 - 1\"\n             ^^^^^^^^^^^^^^^\n  help: write a sum of terms linear in the velocities, \
         or declare it nonlinear, with Chetaev's condition for the displacements: \
         `speed = { expr = \"…\", kind = \"nonlinear\" }`",
    );
    // The second derivatives of these vanish.
    for text in ["abs(x') - y'", "sign(x') - 1", "max(x', y')", "step(x', 1, 2)*x"] {
        let error = error(&point(BELOW, "", &format!("c = \"{text}\"")));
        let expected = format!("m.toml:5:6: [constraints] c: `{text}` is not affine in the velocities\n");
        assert!(error.to_string().starts_with(&expected), "{error}");
    }
    // … and this is x' = 0.
    tried(&model(&point(BELOW, "", "c = \"(x'^2 + x'*y')/(x' + y')\""))).unwrap();
}

#[test]
fn constraints_must_leave_something_to_move() {
    refuses_point(
        BELOW,
        "a = \"x - 0.6\"\nb = \"y + 0.8\"",
        Category::Inconsistent,
        "m.toml:6:6: [constraints] b: the constraints leave nothing free: there are 2 of them for 2 quasi-velocities\n    b = \"y + 0.8\"\n         \
         ^^^^^^^\n  help: there must be fewer independent constraints than velocities, or nothing moves",
    );
    // Two equivalent constraints leave one velocity.
    tried(&model(&point(BELOW, "", "a = \"x - 0.6\"\nb = \"2*x - 1.2\""))).unwrap();
    refuses(
        &format!("{SLEIGH}{BLADE}more = \"x' + y'\"\n"),
        Category::Inconsistent,
        "m.toml:10:1: [quasi_velocities] v: 4 definitions of quasi-velocities cannot be solved for 3 velocities\n    \
         v = { is = \"cos(phi)*x' + sin(phi)*y'\", start = 1.0 }\n    ^\n  \
         help: give as many independent definitions (and constraints) as there are coordinates",
    );
    refuses(
        &format!("{SLEIGH}stop = \"omega - 2\"\n"),
        Category::Inconsistent,
        "m.toml:10:1: [quasi_velocities] v: 2 definitions of quasi-velocities cannot be solved for 3 velocities\n    \
         v = { is = \"cos(phi)*x' + sin(phi)*y'\", start = 1.0 }\n    ^\n  \
         help: give as many independent definitions (and constraints) as there are coordinates",
    );
}

#[test]
fn redundant_constraints_are_dropped() {
    let redundant = |constraints: &str| {
        let model = model(&point(BELOW, "", constraints));
        let graph = Graph::new();
        let assembly = model.assemble(&graph).unwrap();
        let held: Vec<String> =
            assembly.constraints.classified().iter().map(|verdict| verdict.constraint.clone()).collect();
        (held, assembly.constraints.redundant().to_vec())
    };
    let follows = |constraint: &str, from: &[&str]| Redundant {
        constraint: constraint.to_owned(),
        follows_from: from.iter().map(|&name| name.to_owned()).collect(),
    };
    let (held, dropped) = redundant("a = \"x - 0.6\"\nb = \"x'*y\"\nc = \"x^2 - 0.36\"");
    assert_eq!((held, dropped), (vec!["a".to_owned()], vec![follows("c", &["a"]), follows("b", &["a"])]));
    // A position is kept, wherever it stands.
    let (held, dropped) = redundant("rolling = \"x*x' + y*y'\"\nlength = \"x^2 + y^2 - 1\"");
    assert_eq!((held, dropped), (vec!["length".to_owned()], vec![follows("rolling", &["length"])]));
    let (held, dropped) = redundant("nothing = \"0*x\"");
    assert_eq!((held, dropped), (vec![], vec![follows("nothing", &[])]));
}

#[test]
fn contradictions_name_both() {
    refuses_point(
        BELOW,
        "a = \"x'\"\nb = \"2*x' - 1\"",
        Category::Inconsistent,
        "m.toml:6:6: [constraints] b: the constraint `b` contradicts `a`\n    b = \"2*x' - 1\"\n         ^^^^^^^^\n  \
         help: no motion satisfies it; correct it or leave it out",
    );
    let expected = "m.toml:6:6: [constraints] b: the constraint `b` contradicts `a`: where that holds, it is -1, not 0\
                    \n    b = \"x - 1\"\n         ^^^^^\n  help: no motion satisfies it; correct it or leave it out";
    // The start satisfies the first, the second, neither.
    for start in ["x = 0\ny = 0\n", "x = 1\ny = 0\n", "x = 0.5\ny = 0\n"] {
        refuses_point(start, "a = \"x\"\nb = \"x - 1\"", Category::Inconsistent, expected);
        let mut projected = model(&point(start, "", "a = \"x\"\nb = \"x - 1\""));
        projected.project_start(true);
        assert_eq!(tried(&projected).unwrap_err().to_string(), expected);
    }
    refuses_point(
        "x = 0\ny = 0\nz = 0\n",
        "a = \"x - z\"\nb = \"y - t\"\nc = \"x + y - z - t - 2.5e-7\"",
        Category::Inconsistent,
        "m.toml:8:6: [constraints] c: the constraint `c` contradicts `a` and `b`: where these hold, it is -2.5e-7, not 0\
         \n    c = \"x + y - z - t - 2.5e-7\"\n         ^^^^^^^^^^^^^^^^^^^^^^\n  \
         help: no motion satisfies it; correct it or leave it out",
    );
    refuses_point(
        "x = 0\ny = 0\n",
        "v = \"x'\"\nb = \"x - t\"",
        Category::Inconsistent,
        "m.toml:5:6: [constraints] v: the constraint `v` contradicts `b`\n    v = \"x'\"\n         ^^\n  \
         help: no motion satisfies it; correct it or leave it out",
    );
    // No contradiction: the velocity follows from the position, which the start violates.
    refuses_point(
        "x = 0\ny = 0\n",
        "v = \"x'\"\nb = \"x - 1\"",
        Category::Inconsistent,
        "m.toml:6:6: [constraints] b: the start is off the constraint `b`: it is -1, not 0\n    b = \"x - 1\"\n         \
         ^^^^^\n  help: give a start that satisfies it, or move it there with --project-start (--keep NAMES holds what is to stay)",
    );
}

#[test]
fn constraints_on_constants_are_refused() {
    refuses_point(
        BELOW,
        "late = \"t - 1\"",
        Category::Inconsistent,
        "m.toml:5:9: [constraints] late: the constraint `late` contradicts itself: no velocity satisfies it\n    \
         late = \"t - 1\"\n            ^^^^^\n  help: no motion satisfies it; correct it or leave it out",
    );
    refuses(
        &format!("[parameters]\np = 1\n{}", point(BELOW, "", "c = \"p - 2\"")),
        Category::Inconsistent,
        "m.toml:7:6: [constraints] c: the constraint `c` cannot hold: it is always -1, not 0\n    c = \"p - 2\"\n         \
         ^^^^^\n  help: no motion satisfies it; correct it or leave it out",
    );
}

#[test]
fn a_start_off_a_constraint_is_refused_or_moved() {
    let length = "length = \"x^2 + y^2 - 1\"";
    let help = "\n    length = \"x^2 + y^2 - 1\"\n              ^^^^^^^^^^^^^\n  \
                help: give a start that satisfies it, or move it there with --project-start (--keep NAMES holds what is to stay)";
    let off = "x = 1.0\ny = -0.8\n";
    refuses_point(
        off,
        length,
        Category::Inconsistent,
        &format!(
            "m.toml:5:11: [constraints] length: the start is off the constraint `length`: it is 0.64, not 0{help}"
        ),
    );
    let given = "[quasi_velocities]\n\"x'\" = 1.0\n";
    let moving = point(BELOW, &format!("{given}\"y'\" = 0.0\n"), length);
    refuses(
        &moving,
        Category::Inconsistent,
        &format!(
            "m.toml:8:11: [constraints] length: the start is off the constraint `length`: its rate is 1.2, not 0{help}"
        ),
    );
    let blade = point(BELOW, &format!("{given}\"y'\" = 0.0\n"), "blade = \"x' - x*y'\"");
    refuses(
        &blade,
        Category::Inconsistent,
        "m.toml:8:10: [constraints] blade: the start is off the constraint `blade`: it is 1, not 0\n    \
         blade = \"x' - x*y'\"\n             ^^^^^^^^^\n  \
         help: give a start that satisfies it, or move it there with --project-start (--keep NAMES holds what is to stay)",
    );

    // The nearest point of the circle is on the ray, and the velocity keeps its tangential part.
    let moved = |text: &str| {
        let mut model = model(text);
        model.project_start(true);
        tried(&model).unwrap()
    };
    let close = |found: &[f64], expected: &[f64]| {
        // Newton's method ends at the rounding.
        found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15 * 4.0)
    };
    let r = 1.64f64.sqrt();
    let start = moved(&point(off, "", length));
    assert!((start[0].hypot(start[1]) - 1.0).abs() < 1e-15 && start[0] > 0.0 && start[1] < 0.0, "{start:?}");
    // Newton's steps go along the gradient, which on a circle is the ray.
    assert!(close(&start, &[1.0 / r, -0.8 / r, 0.0, 0.0]), "{start:?}");
    assert!(close(&moved(&moving), &[0.6, -0.8, 0.64, 0.48]), "{:?}", moved(&moving));
    let start = moved(&blade);
    assert!((start[2] - 0.6 * start[3]).abs() < 1e-15, "{start:?}");
}

#[test]
fn velocities_that_are_not_given_follow_from_those_that_are() {
    let start = |text: &str| tried(&model(text)).unwrap();
    // x x' + y y' = 0 on the circle, x' = x y' along the blade.
    let given = "[quasi_velocities]\n\"x'\" = 1.0\n";
    let close =
        |found: &[f64], expected: &[f64]| found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-14);
    assert!(close(&start(&point(BELOW, given, "length = \"x^2 + y^2 - 1\"")), &[0.6, -0.8, 1.0, 0.75]));
    assert!(close(&start(&point(BELOW, given, "blade = \"x' - x*y'\"")), &[0.6, -0.8, 1.0, 1.0 / 0.6]));
    // Where a constraint asks for motion, it has it; what it leaves open rests.
    assert!(close(&start(&point(BELOW, "", "belt = \"x' - 3\"")), &[0.6, -0.8, 3.0, 0.0]));
    // A disk that rolls: its centre follows from its rotations.
    let disk = |more: &str| {
        format!(
            "[parameters]\nR = 0.5\n[coordinates]\nx = 0\ny = 0\nphi = 0\npsi = 1.2\n[quasi_velocities]\n\"phi'\" = 5.0\n\
             \"psi'\" = 0.3\n{more}[constraints]\nx = \"x' - R*cos(psi)*phi'\"\ny = \"y' - R*sin(psi)*phi'\"\n\
             [lagrangian]\nkinetic = \"x'^2 + y'^2 + phi'^2 + psi'^2\"\n"
        )
    };
    let rolling = [0.0, 0.0, 0.0, 1.2, 2.5 * 1.2f64.cos(), 2.5 * 1.2f64.sin(), 5.0, 0.3];
    assert!(close(&start(&disk("")), &rolling), "{:?}", start(&disk("")));
    // One that the others contradict is refused, also if others could give way.
    let error = tried(&model(&disk("\"x'\" = 0.0\n"))).unwrap_err().to_string();
    assert!(error.contains("the start is off the constraint `x`"), "{error}");
}

/// A constraint has the same effect in all units.
#[test]
fn the_units_of_a_constraint_do_not_matter() {
    let rates = |factor: &str, start: &str| {
        let model = model(&point(start, "", &format!("length = \"{factor}*(x^2 + y^2 - 1)\"")));
        let graph = Graph::new();
        let assembly = model.assemble(&graph)?;
        let (mut motion, start) = model.compile(&assembly)?;
        let mut rates = vec![0.0; 4];
        motion.rhs(0.0, &start, &mut rates).unwrap();
        Ok::<_, ModelError>(rates)
    };
    let expected = rates("1", BELOW).unwrap();
    for factor in ["1e12", "1e-12", "1e150", "1e-150"] {
        for (found, expected) in rates(factor, BELOW).unwrap().iter().zip(&expected) {
            assert!(
                (found - expected).abs() <= 1e-15 * 4.0 * expected.abs(),
                "{factor}: rounding of the factor"
            );
        }
        let off = rates(factor, "x = 1.0\ny = -0.8\n").unwrap_err().to_string();
        assert!(off.contains("the start is off the constraint `length`"), "{factor}: {off}");
    }
    // A start may be off by 10⁻⁸ of a coordinate, relative for a large one.
    for (start, good) in [("x = 1.000000009\ny = 0\n", true), ("x = 1.00000002\ny = 0\n", false)] {
        assert_eq!(rates("1e-3", start).is_ok(), good, "{start}");
    }
    let earth = "[parameters]\nR = 6.4e6\n[coordinates]\nx = \"R/3\"\ny = \"sqrt(8)*R/3\"\n[constraints]\n\
                 length = \"x^2 + y^2 - R^2\"\n[lagrangian]\nkinetic = \"x'^2 + y'^2\"\n";
    tried(&model(earth)).unwrap();
}

#[test]
fn a_start_where_constraints_are_singular_is_refused() {
    refuses_point(
        "x = 0\ny = 0\n",
        "cross = \"x*y\"",
        Category::Inconsistent,
        "m.toml:5:10: [constraints] cross: the constraint `cross` restricts no velocity that the others leave free at \
         t = 0, x = 0, y = 0, x' = 0, y' = 0\n    cross = \"x*y\"\n             ^^^\n  \
         help: start where the constraints are independent of each other",
    );
    refuses_point(
        "x = 0\ny = 0\n",
        "root = \"sqrt(x) - y\"",
        Category::Inconsistent,
        "m.toml:5:9: [constraints] root: `d(sqrt(x) - y)` is NaN at the start (x = 0, y = 0, x' = 0, y' = 0)\n    \
         root = \"sqrt(x) - y\"\n            ^^^^^^^^^^^\n  help: start where the coordinates and functions are regular",
    );
    // A nonholonomic one: here Frobenius' test meets the singular place.
    let text = point("x = 0\ny = 0\nz = 0\n", "", "blade = \"x*x' + y*z*y' + z*z'\"");
    let text = text.replace("y'^2)", "y'^2 + z'^2)");
    let expected = "m.toml:6:10: [constraints] blade: the constraint `blade` restricts no velocity that the others leave \
                    free at t = 0, x = 0, y = 0, z = 0, ";
    assert!(error(&text).to_string().starts_with(expected), "{}", error(&text));
    // Two links folded onto each other while the end moves along the first: the rank is lost exactly at the
    // start.
    let folded = "[coordinates]\nx1 = 1\ny1 = 0\nx2 = 0\ny2 = 0\n[constraints]\na = \"x1^2 + y1^2 - 1\"\n\
                  b = \"(x2 - x1)^2 + (y2 - y1)^2 - 1\"\nc = \"x2\"\n[lagrangian]\n\
                  kinetic = \"x1'^2 + y1'^2 + x2'^2 + y2'^2\"\n";
    let expected = "m.toml:9:6: [constraints] c: the constraint `c` restricts no velocity that the others leave free at \
                    t = 0, x1 = 1, ";
    assert!(error(folded).to_string().starts_with(expected), "{}", error(folded));
}

#[test]
fn constraints_that_no_state_satisfies_are_refused() {
    let text = point("x = 1\ny = 0.5\nz = 0\n", "", "a = \"x\"\nb = \"x + y^2 + 1\"");
    let mut model = model(&text.replace("y'^2)", "y'^2 + z'^2)"));
    model.project_start(true);
    let error = tried(&model).unwrap_err().to_string();
    assert!(
        error.starts_with(
            "m.toml:6:6: [constraints] a: no state that satisfies the constraints `a`, `b` was found near t = 0, "
        ),
        "{error}"
    );
    assert!(error.ends_with("help: start nearer to a state that satisfies them, if there is one"), "{error}");
}

#[test]
fn a_kind_may_be_given() {
    let kind = |text: &str| {
        let model = model(text);
        let graph = Graph::new();
        model.assemble(&graph).map(|assembly| assembly.constraints.classified()[0].kind)
    };
    let given = |kind: &str| {
        format!("{SLEIGH}blade = {{ expr = \"-sin(phi)*x' + cos(phi)*y'\", kind = \"{kind}\" }}\n")
    };
    refuses(
        &given("holonomic"),
        Category::Inconsistent,
        "m.toml:15:55: [constraints] blade.kind: the constraint `blade` is not holonomic: the velocities it allows leave \
         every surface (component 1.0e0)\n    blade = { expr = \"-sin(phi)*x' + cos(phi)*y'\", kind = \"holonomic\" }\n    \
         \u{20}                                                     ^^^^^^^^^^^\n  \
         help: leave out its kind, or write it as a function of coordinates and t",
    );
    assert!(matches!(kind(&given("nonholonomic")), Ok(ConstraintKind::Nonholonomic { .. })));
    let circle =
        |kind: &str| point(BELOW, "", &format!("c = {{ expr = \"x*x' + y*y'\", kind = \"{kind}\" }}"));
    for given in ["holonomic", "nonholonomic"] {
        assert_eq!(kind(&circle(given)).unwrap(), ConstraintKind::Integrable);
    }
    assert_eq!(kind(&point(BELOW, "", "c = \"x^2 + y^2 - 1\"")).unwrap(), ConstraintKind::Position);
}

/// The name of a constraint may be that of something else: it is outside the namespace of expressions.
#[test]
fn constraints_may_have_any_label() {
    for name in ["blade", "m", "x", "v", "t", "energy"] {
        let text = format!("{SLEIGH}{}", BLADE.replace("blade", name));
        let model = model(&text);
        let graph = Graph::new();
        let assembly = model.assemble(&graph).unwrap();
        assert!(matches!(assembly.constraints.formulation(), ConstraintFormulation::Vanishing(_)), "{name}");
        let (mut motion, start) = model.compile(&assembly).unwrap();
        let mut rates = vec![0.0; 5];
        motion.rhs(0.0, &start, &mut rates).unwrap();
        // v' = a ω², ω' = −m a v ω/(J + m a²)
        let (v, omega) = (1.0, 2.0);
        assert!((rates[3] - 0.3 * omega * omega).abs() < 1e-15, "{name}");
        assert!((rates[4] + 0.3 * v * omega / (0.5 + 0.09)).abs() < 1e-15, "{name}");
    }
}

#[test]
fn a_quasi_velocity_that_vanishes_starts_at_zero() {
    let text = |u: &str| {
        format!(
            "[coordinates]\nx = 0.0\ny = 0.0\nphi = 0.4\n[quasi_velocities]\nu = {u}\nv = 1.0\nomega = 2.0\n\
             [kinematics]\nx = \"cos(phi)*v - sin(phi)*u\"\ny = \"sin(phi)*v + cos(phi)*u\"\nphi = \"omega\"\n\
             [constraints]\nslip = \"u\"\n[lagrangian]\nkinetic = \"(v^2 + (u + 0.3*omega)^2 + omega^2)/2\"\n"
        )
    };
    refuses(
        &text("0.1"),
        Category::Inconsistent,
        "m.toml:14:9: [constraints] slip: the start is off the constraint `slip`: it is 0.1, not 0\n    slip = \"u\"\n            \
         ^\n  help: give a start that satisfies it, or move it there with --project-start (--keep NAMES holds what is to stay)",
    );
    let mut moved = model(&text("0.1"));
    moved.project_start(true);
    assert_eq!(tried(&moved).unwrap()[3], 0.0);
    assert_eq!(tried(&model(&text("0"))).unwrap(), [0.0, 0.0, 0.4, 0.0, 1.0, 2.0]);
}

/// [bodies] give the energy, constraints the geometry: ẍ = −λ x, ÿ = −λ y − g with λ = ẋ² + ẏ² − g y.
#[test]
fn constraints_bind_bodies_too() {
    let text = "[coordinates]\nx = 0.6\ny = -0.8\n[quasi_velocities]\n\"x'\" = 0.8\n\"y'\" = 0.6\n[constraints]\n\
                length = \"x^2 + y^2 - 1\"\n[bodies.bob]\nmass = 2\nposition = [\"x\", \"y\", 0]\nforce = [0, -19.6, 0]\n";
    let model = model(text);
    let graph = Graph::new();
    let assembly = model.assemble(&graph).unwrap();
    let (mut motion, start) = model.compile(&assembly).unwrap();
    let mut rates = [0.0; 4];
    motion.rhs(0.0, &start, &mut rates).unwrap();
    let lambda = 1.0 + 9.8 * 0.8;
    for (found, expected) in rates.iter().zip([0.8, 0.6, -lambda * 0.6, lambda * 0.8 - 9.8]) {
        assert!((found - expected).abs() < 1e-14, "{found} {expected}: rounding of a few operations");
    }
}

/// z has no inertia of its own; z = x y gives it that of x and y.
#[test]
fn a_coordinate_without_mass_is_held_by_a_constraint() {
    let text = "[coordinates]\nx = 0.6\ny = -0.8\nz = -0.48\n[constraints]\ntie = \"z - x*y\"\n[lagrangian]\n\
                kinetic = \"(x'^2 + y'^2)/2\"\npotential = \"z\"\n";
    let graph = Graph::new();
    let held = model(text);
    let assembly = held.assemble(&graph).unwrap();
    let (mut motion, start) = held.compile(&assembly).unwrap();
    let mut rates = [0.0; 6];
    motion.rhs(0.0, &start, &mut rates).unwrap();
    // V = x y: ẍ = −y, ÿ = −x, z̈ = ẍ y + x ÿ at rest.
    for (found, expected) in rates[3..].iter().zip([0.8, -0.6, -0.64 - 0.36]) {
        assert!((found - expected).abs() < 1e-15 * 2.0, "{found} {expected}");
    }
    let free = "[coordinates]\nx = 0.6\ny = 0.6\nz = 1\n[constraints]\ntie = \"x - y\"\n[lagrangian]\n\
                kinetic = \"(x'^2 + y'^2)/2\"\n";
    refuses(
        free,
        Category::Inconsistent,
        "m.toml:7:1: [lagrangian]: the Lagrangian is degenerate: its Hessian in the quasi-velocities has rank 2 of 3, so \
         z'' is not determined\n    [lagrangian]\n    ^^^^^^^^^^^^\n  \
         help: every quasi-velocity needs kinetic energy of its own",
    );
}

#[test]
fn a_constraint_declared_nonlinear_must_be_so() {
    let called = |expr: &str| format!("c = {{ expr = \"{expr}\", kind = \"nonlinear\" }}");
    let place = |column: usize, line: &str| {
        format!("\n    {line}\n{}^^^^^^^^^^^\n  help: leave out its kind", " ".repeat(3 + column))
    };
    let affine = called("x' - x*y'");
    refuses_point(
        BELOW,
        &affine,
        Category::Text,
        &format!(
            "m.toml:5:34: [constraints] c.kind: the constraint `c` is called nonlinear and is affine in the velocities{}",
            place(34, &affine)
        ),
    );
    let position = called("x^2 + y^2 - 1");
    refuses_point(
        BELOW,
        &position,
        Category::Text,
        &format!(
            "m.toml:5:38: [constraints] c.kind: the constraint `c` is called nonlinear and contains no velocity{}",
            place(38, &position)
        ),
    );
    // One that defines a quasi-velocity without being declared nonlinear.
    let defining = format!("{SLEIGH}speed = \"x'^2 + y'^2 - 1\"\n");
    let found = error(&defining).to_string();
    assert!(found.contains("`x'^2 + y'^2 - 1` is not affine in the velocities\n"), "{found}");
    assert!(found.ends_with("`speed = { expr = \"…\", kind = \"nonlinear\" }`"), "{found}");
    let unmoved = point("x = 0\ny = 0\n", "", &called("x'^2 + y'^2"));
    let found = error(&unmoved).to_string();
    assert!(
        found.contains("the constraint `c` restricts no velocity that the others leave free at t = 0"),
        "{found}"
    );
}

/// With defined quasi-velocities, it defines none; other constraints keep their kinds.
#[test]
fn nonlinear_constraints_stand_beside_others() {
    let classified = |text: &str| {
        let graph = Graph::new();
        let assembly = model(text).assemble(&graph).unwrap();
        assembly.constraints.classified().iter().map(|v| (v.constraint.clone(), v.kind)).collect::<Vec<_>>()
    };
    let text = "[coordinates]\nx = 0\ny = 0\nz = 0\n[quasi_velocities]\nu = { is = \"x'\", start = 1 }\n\
                v = { is = \"y'\", start = 0 }\n[constraints]\n\
                cone = { expr = \"x'^2 + y'^2 - 1\", kind = \"nonlinear\" }\nknife = \"z' - y*x'\"\n[lagrangian]\n\
                kinetic = \"(x'^2 + y'^2 + z'^2)/2\"\n";
    let found = classified(text);
    assert_eq!(found[0], ("cone".to_owned(), ConstraintKind::Nonlinear));
    assert!(found[1].0 == "knife" && matches!(found[1].1, ConstraintKind::Nonholonomic { .. }), "{found:?}");
    // On a circle of the plane, a constant speed is one of the angle: the circle remains a position.
    let circle = "circle = \"x^2 + y^2 - 1\"\nspeed = { expr = \"x'^2 + z'^2 - 1\", kind = \"nonlinear\" }";
    let text = point("x = 1\ny = 0\nz = 0\n", "[quasi_velocities]\n\"z'\" = 1\n", circle);
    let found = classified(&text.replace("y'^2)", "y'^2 + z'^2)"));
    assert_eq!(
        found.iter().map(|(_, kind)| *kind).collect::<Vec<_>>(),
        [ConstraintKind::Position, ConstraintKind::Nonlinear]
    );
}

/// The error is located at the definition that causes it, not at the first.
#[test]
fn errors_in_definitions_are_located_there() {
    let text = |is: &str| {
        format!(
            "[coordinates]\nx = 0\ny = 0\n[quasi_velocities]\nu = {{ is = \"x' + y'\", start = 1 }}\n\
             w = {{ is = \"{is}\", start = 1 }}\n[lagrangian]\nkinetic = \"x'^2 + y'^2\"\n"
        )
    };
    refuses(
        &text("x*y"),
        Category::Text,
        "m.toml:6:13: [quasi_velocities] w.is: `x*y` contains no velocity, so it defines no quasi-velocity\n    \
         w = { is = \"x*y\", start = 1 }\n                ^^^\n  \
         help: write a sum of terms linear in the velocities, such as \"x'\"",
    );
    refuses(
        &text("2*x' + 2*y'"),
        Category::Inconsistent,
        "m.toml:6:13: [quasi_velocities] w.is: the definitions of the quasi-velocities are linearly dependent: their matrix is \
         singular everywhere\n    w = { is = \"2*x' + 2*y'\", start = 1 }\n                ^^^^^^^^^^^\n  \
         help: give as many independent definitions (and constraints) as there are coordinates",
    );
}
