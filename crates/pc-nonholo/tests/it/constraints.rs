//! Constraints as expressions: classified, and put into frames of their own.

use pc_mech::{Constraint, Expr, Graph, System};
use pc_nonholo::{Adapted, Binding, ConstraintClassification, ConstraintKind, Redundant};

/// Chaplygin's sleigh in the velocities of its coordinates.
fn sleigh(graph: &Graph) -> System<'_> {
    let [m, j, a] = graph.symbols(["m", "J", "a"]);
    System::builder(graph)
        .parameter(m, 1.0)
        .parameter(j, 1.0)
        .parameter(a, 0.5)
        .coordinates(["x", "y", "φ"])
        .lagrangian(|_, x, v| {
            let (s, c) = (x[2].sin(), x[2].cos());
            let centre = (v[0] - a * s * v[2]).square() + (v[1] + a * c * v[2]).square();
            (m * centre + j * v[2].square()) / 2.0
        })
        .build()
        .unwrap()
}

fn state<'g>(graph: &'g Graph, system: &System<'g>) -> Vec<(Expr<'g>, f64)> {
    let symbols = system.frame().coordinates().iter().chain(system.quasi_velocities());
    let values = (1..).map(|i| 0.3 * f64::from(i));
    symbols.copied().zip(values).chain([(graph.symbol("t"), 0.2)]).collect()
}

#[test]
fn the_frame_of_the_blade_is_found() {
    let graph = Graph::new();
    let system = sleigh(&graph);
    let [vx, vy, phi] = graph.symbols(["x'", "y'", "φ"]);
    let blade = Constraint::new("blade", vy * phi.cos() - vx * phi.sin());
    let at = [state(&graph, &system), vec![(phi, 0.5)]].concat();
    let multipliers = system.with_multipliers(&[blade]).unwrap();
    let adapted = Adapted::new(&multipliers, &at).unwrap();
    let names: Vec<String> = adapted.system().quasi_velocities().iter().map(Expr::to_string).collect();
    assert_eq!(names, ["x'", "φ'", "blade"], "cos φ > sin φ: the blade determines ẏ best");
    // In x' and φ' the motion is that of the two equations of the sleigh with v = x'/cos φ.
    let equations = adapted.constrained().unwrap();
    let [v, w] = graph.symbols(["x'", "φ'"]);
    let [m, j, a] = graph.symbols(["m", "J", "a"]);
    let rates = equations.equations().accelerations();
    let speed = v / phi.cos();
    let along = a * w.square() - speed * w * phi.sin() / phi.cos();
    assert!((rates[0] - along * phi.cos()).is_zero(), "{}", rates[0]);
    assert!((rates[1] + m * a * speed * w / (j + m * a.square())).is_zero(), "{}", rates[1]);
}

fn sort<'g>(
    system: &System<'g>,
    constraints: &[Constraint<'g>],
    at: &[(Expr<'g>, f64)],
) -> ConstraintClassification<'g> {
    ConstraintClassification::new(system, constraints, at).unwrap()
}

#[test]
fn constraints_are_classified_by_frobenius_test() {
    let graph = Graph::new();
    let [x, y, z, vx, vy, vz] = graph.symbols(["x", "y", "z", "x'", "y'", "z'"]);
    let system = System::builder(&graph)
        .coordinates(["x", "y", "z", "u"])
        .lagrangian(|_, _, v| v.iter().map(|v| v.square()).sum::<Expr<'_>>() / 2.0)
        .build()
        .unwrap();
    let at = state(&graph, &system);
    let sphere = Constraint::new("sphere", x.square() + y.square() + z.square() - 1.0);
    let disguised = Constraint::new("disguised", y * vx - x * vy + 2.0 * (x.square() + y.square()));
    let knife = Constraint::new("knife", vz - y * vx);

    let sorted = sort(&system, &[sphere.clone(), disguised.clone()], &at);
    assert_eq!(sorted.kinds(), [ConstraintKind::Position, ConstraintKind::Integrable], "φ̇ = 2 in disguise");
    assert!(sorted.is_holonomic());
    let sorted = sort(&system, std::slice::from_ref(&knife), &at);
    assert!(matches!(*sorted.kinds(), [ConstraintKind::Nonholonomic { residual }] if residual > 0.5));
    // The two planes y = const and the knife: on them the knife is integrable.
    let sorted = sort(&system, &[Constraint::new("plane", vy * x.exp()), knife.clone()], &at);
    assert_eq!(sorted.kinds(), [ConstraintKind::Integrable, ConstraintKind::Integrable]);

    let twice = Constraint::new("twice", 2.0 * x * vx + 2.0 * y * vy + 2.0 * z * vz);
    let sorted = sort(&system, &[knife.clone(), sphere.clone(), twice], &at);
    let follows = Redundant { constraint: "twice".to_owned(), follows_from: vec!["sphere".to_owned()] };
    assert_eq!(sorted.redundant(), [follows]);
    assert_eq!(sorted.kinds().len(), 2);

    let other = Constraint::new("other", 2.0 * vz - 2.0 * y * vx - 1.0);
    let error = ConstraintClassification::new(&system, &[sphere, knife, other], &at).unwrap_err();
    assert_eq!(error.to_string(), "the constraint `other` contradicts `knife`");
    let impossible = Constraint::new("impossible", graph.symbol("t").sin());
    let error = ConstraintClassification::new(&system, &[impossible], &at).unwrap_err();
    assert_eq!(error.to_string(), "the constraint `impossible` contradicts itself: no velocity satisfies it");
    assert_eq!(sort(&system, &[Constraint::new("empty", vx - vx)], &at).redundant().len(), 1);
}

/// A rolling disk of any radius: the kinds of constraints are independent of units.
#[test]
fn the_kind_of_a_constraint_does_not_depend_on_units() {
    for radius in [1.0, 1e-6, 1e-10, 1e-14, 1e10] {
        let graph = Graph::new();
        let [vx, vy, phi, vphi, vtheta] = graph.symbols(["x'", "y'", "φ", "φ'", "θ'"]);
        let system = System::builder(&graph)
            .coordinates(["x", "y", "φ", "θ"])
            .lagrangian(|_, _, v| v.iter().map(|v| v.square()).sum::<Expr<'_>>() / 2.0)
            .build()
            .unwrap();
        let at = state(&graph, &system);
        let along = Constraint::new("along", vx - radius * vtheta * phi.cos());
        let across = Constraint::new("across", vy - radius * vtheta * phi.sin());
        let sorted = sort(&system, &[along.clone(), across.clone()], &at);
        let nonholonomic = |kind: &ConstraintKind| matches!(kind, ConstraintKind::Nonholonomic { residual } if *residual > 0.0);
        assert!(sorted.kinds().iter().all(nonholonomic), "{radius}: {:?}", sorted.kinds());
        // Where it cannot turn, all three can be integrated.
        let straight = Constraint::new("straight", radius * vphi);
        let sorted = sort(&system, &[along, across, straight], &at);
        assert_eq!(sorted.kinds(), [ConstraintKind::Integrable; 3], "{radius}");
    }
}

/// log(xy) − log x − log y is zero, though the graph does not know it.
#[test]
fn a_bracket_that_vanishes_up_to_rounding_is_integrable() {
    let graph = Graph::new();
    let [x, y, vx, vz] = graph.symbols(["x", "y", "x'", "z'"]);
    let system = System::builder(&graph)
        .coordinates(["x", "y", "z"])
        .lagrangian(|_, _, v| v.iter().map(|v| v.square()).sum::<Expr<'_>>() / 2.0)
        .build()
        .unwrap();
    let zero = (x * y).log() - x.log() - y.log();
    let plane = Constraint::new("plane", vz - (x + zero) * vx);
    assert_eq!(sort(&system, &[plane], &state(&graph, &system)).kinds(), [ConstraintKind::Integrable]);
}

/// In an orthonormal frame ζ of the allowed velocities ζ̇_s = r_s; ẍ is the same as in independent
/// velocities.
#[test]
fn an_orthonormal_frame_gives_the_same_motion() {
    let graph = Graph::new();
    let system = sleigh(&graph);
    let [vx, vy, phi] = graph.symbols(["x'", "y'", "φ"]);
    let blade = Constraint::new("blade", vy * phi.cos() - vx * phi.sin());
    let at = [state(&graph, &system), vec![(phi, 0.5)]].concat();
    let multipliers = system.with_multipliers(&[blade]).unwrap();
    let plain = Adapted::new(&multipliers, &at).unwrap();
    let orthonormal = plain.orthonormal(&["ζ1", "ζ2"]).unwrap();
    let accelerations = |adapted: &Adapted<'_>, eta: &[(&str, f64)]| {
        let constrained = adapted.constrained().unwrap();
        let equations = constrained.equations();
        let system = equations.system();
        let x = system.frame().coordinates().iter().copied().zip(equations.velocities().iter().copied());
        let rates = system.quasi_velocities().iter().copied().zip(equations.accelerations());
        let along: Vec<_> = x.chain(rates).collect();
        let second = graph.directional(equations.velocities(), &along);
        let known = eta.iter().map(|&(name, value)| (graph.symbol(name), value));
        let values: Vec<_> = system.parameters().iter().copied().chain([(phi, 0.7)]).chain(known).collect();
        let both = [equations.velocities(), &second].concat();
        graph.evaluate(&both, &values).unwrap()
    };
    let constrained = orthonormal.constrained().unwrap();
    let mass = constrained.equations().mass_matrix();
    assert_eq!(*mass.entries(), [Expr::ONE, Expr::ZERO, Expr::ZERO, Expr::ONE]);

    let (zeta1, zeta2) = (0.4, -0.9);
    let expected = accelerations(&orthonormal, &[("ζ1", zeta1), ("ζ2", zeta2)]);
    let found = accelerations(&plain, &[("x'", expected[0]), ("φ'", expected[2])]);
    for (found, expected) in found.iter().zip(&expected) {
        assert!((found - expected).abs() < 1e-14, "{found} instead of {expected}"); // rounding
    }
    assert_eq!(
        plain.orthonormal(&["ζ1"]).unwrap_err().to_string(),
        "the list of names has 1 entries where 2 are needed"
    );
}

/// A position that follows from others is dropped, but a velocity does not make a position redundant.
#[test]
fn positions_come_first() {
    let graph = Graph::new();
    let [x, y, vx] = graph.symbols(["x", "y", "x'"]);
    let system = System::builder(&graph)
        .coordinates(["x", "y", "z"])
        .lagrangian(|_, _, v| v.iter().map(|v| v.square()).sum::<Expr<'_>>() / 2.0)
        .build()
        .unwrap();
    let at = state(&graph, &system);
    let constraints = [
        Constraint::new("velocity", vx * y.exp()),
        Constraint::new("position", x - 1.0),
        Constraint::new("again", (x - 1.0) * (2.0 + x)),
        Constraint::new("other", y + graph.symbol("z")),
    ];
    let sorted = sort(&system, &constraints, &at);
    let names: Vec<&str> = sorted.multipliers().unwrap().constraints().iter().map(Constraint::name).collect();
    assert_eq!(names, ["position", "other"], "in the order given");
    let dropped: Vec<(&str, &[String])> =
        sorted.redundant().iter().map(|r| (r.constraint.as_str(), r.follows_from.as_slice())).collect();
    let position = ["position".to_owned()];
    assert_eq!(dropped, [("again", &position[..]), ("velocity", &position[..])]);
    let error = ConstraintClassification::new(&system, &[Constraint::new("speed", vx.square() - y)], &at)
        .unwrap_err();
    assert_eq!(error.to_string(), "the constraint `speed` is not affine in the quasi-velocities");
}

/// A disk rolling without tilt: [X_φ, X_θ] has a component along `along` only where the disk is oblique to an
/// axis; brackets of brackets have one along both.
#[test]
fn brackets_of_brackets_count() {
    let graph = Graph::new();
    let [theta, heading] = graph.symbols(["θ'", "φ"]);
    let [vx, vy] = graph.symbols(["x'", "y'"]);
    let system = System::builder(&graph)
        .coordinates(["x", "y", "φ", "θ"])
        .lagrangian(|_, _, v| v.iter().map(|v| v.square()).sum::<Expr<'_>>() / 2.0)
        .build()
        .unwrap();
    let at = state(&graph, &system);
    // Across and along the heading: the first bracket reaches only one of the two.
    let (s, c) = (heading.sin(), heading.cos());
    let across = Constraint::new("across", c * vy - s * vx);
    let rolling = Constraint::new("rolling", c * vx + s * vy - theta);
    let sorted = sort(&system, &[across, rolling], &at);
    assert!(
        sorted.kinds().iter().all(|kind| matches!(kind, ConstraintKind::Nonholonomic { .. })),
        "{:?}",
        sorted.kinds()
    );
}

/// A frame of three parallel bars, where two suffice; if one bar has another length, it cannot move.
#[test]
fn a_redundant_bar_is_found_where_the_others_hold() {
    let frame = |third: f64| {
        let graph = Graph::new();
        let names = ["α", "β", "γ", "θ", "φ"];
        let system = System::builder(&graph)
            .coordinates(names)
            .lagrangian(|_, _, v| v.iter().map(|v| v.square()).sum::<Expr<'_>>() / 2.0)
            .build()
            .unwrap();
        let [a, b, c, top, end] = graph.symbols(names);
        let [t] = graph.symbols(["t"]);
        // Cranks of length one at 0, 2 and 3 on the ground; a platform at θ from the first to the second and
        // at φ from there to the third.
        let loops = [
            Constraint::new("x2", a.cos() + 2.0 * top.cos() - b.cos() - 2.0),
            Constraint::new("y2", a.sin() + 2.0 * top.sin() - b.sin()),
            Constraint::new("stiff", top - end),
            Constraint::new("x3", b.cos() + end.cos() - third * c.cos() - 1.0),
            Constraint::new("y3", b.sin() + end.sin() - third * c.sin()),
        ];
        let at = [(t, 0.0), (a, 1.0), (b, 1.0), (c, 1.0), (top, 0.0), (end, 0.0)];
        let binding = Binding::new(&system, &loops, &at).unwrap();
        (binding.binding().to_vec(), binding.redundant().to_vec())
    };
    let (binding, redundant) = frame(1.0);
    assert_eq!(binding, [0, 1, 2, 3]);
    assert_eq!(redundant[0].constraint, "y3");
    assert_eq!(redundant.len(), 1);
    assert_eq!(frame(1.01).0, [0, 1, 2, 3, 4]);
}

/// y = 0 and y = x² touch: their gradients are parallel where both hold, but neither follows from the other.
#[test]
fn tangent_conditions_do_not_follow_from_each_other() {
    let graph = Graph::new();
    let [t, x, y, z] = graph.symbols(["t", "x", "y", "z"]);
    let system = System::builder(&graph)
        .coordinates(["x", "y", "z"])
        .lagrangian(|_, _, v| (v[0].square() + v[1].square() + v[2].square()) / 2.0)
        .build()
        .unwrap();
    let touching = [Constraint::new("line", y), Constraint::new("parabola", y - x.square())];
    let binding = Binding::new(&system, &touching, &[(t, 0.0), (x, 0.0), (y, 0.0), (z, 0.5)]).unwrap();
    assert_eq!(binding.binding(), [0, 1]);
    assert!(binding.redundant().is_empty());
}

/// The velocity of a point on a circle that turns at the rate 1 follows from its position, c_0 included only
/// where that holds; at another rate the two contradict each other.
#[test]
fn a_velocity_may_follow_only_where_positions_hold() {
    let graph = Graph::new();
    let [t, x, y, vx, vy] = graph.symbols(["t", "x", "y", "x'", "y'"]);
    let system = System::builder(&graph)
        .coordinates(["x", "y"])
        .lagrangian(|_, _, v| (v[0].square() + v[1].square()) / 2.0)
        .build()
        .unwrap();
    let spoke = Constraint::new("spoke", x * t.sin() - y * t.cos());
    let at = [(t, 0.0), (x, 0.7), (y, 0.0)];
    // On the spoke x = r cos t and y = r sin t: x' sin t − y' cos t = −r.
    let turning = |rate: f64| {
        let radius = (x.square() + y.square()).sqrt();
        let turns = Constraint::new("turns", vx * t.sin() - vy * t.cos() + rate * radius);
        Binding::new(&system, &[spoke.clone(), turns], &at)
    };
    let follows = turning(1.0).unwrap();
    assert_eq!(follows.binding(), [0]);
    assert_eq!(follows.redundant()[0].follows_from, ["spoke"]);
    assert_eq!(turning(1.1).unwrap_err().to_string(), "the constraint `turns` contradicts `spoke`");
}
