//! Equations (30): constraints η_α = 0 put in after differentiation.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use pc_mech::{Equations, Expr, Graph, System};
use pc_solve::{Options, solve};

/// What is asked of an integration at rtol = 1e-12: the references have 16 digits.
const TOLERANCE: f64 = 1e-8;

fn reaches(equations: &Equations<'_>, start: &[f64], t_end: f64, reference: &[f64], conserved: &[&str]) {
    let mut motion = equations.compile().unwrap();
    let mut watch = equations.compile().unwrap();
    let options = Options::default().relative_tolerance(1e-12).absolute_tolerance(1e-14);
    let trajectory = solve(&mut motion, 0.0, start, &[0.5 * t_end, t_end], &options).unwrap();
    let (_, end) = trajectory.last().unwrap();
    for (found, expected) in end.iter().zip(reference) {
        assert!((found - expected).abs() <= TOLERANCE, "{end:?} is not {reference:?}");
    }
    let (before, after) = (watch.observe(0.0, start), watch.observe(t_end, end));
    for (i, name) in watch.observable_names().iter().enumerate() {
        if conserved.contains(&name.as_str()) {
            assert!(
                (before[i] - after[i]).abs() <= TOLERANCE,
                "{name} drifts from {} to {}",
                before[i],
                after[i]
            );
        }
    }
}

/// System 5: blade at (x, y), heading φ; η = (v, ω, u), u the lateral velocity of the blade.
///
/// The kinetic energy is computed with `lateral(u)` for u: itself, or 0 to put the constraint in too early.
fn sleigh<'g>(graph: &'g Graph, lateral: fn(Expr<'g>) -> Expr<'g>) -> System<'g> {
    let [m, j, a] = graph.symbols(["m", "J", "a"]);
    System::builder(graph)
        .parameter(m, 1.0)
        .parameter(j, 1.0)
        .parameter(a, 0.5)
        .coordinates(["x", "y", "phi"])
        .quasi_velocities(["v", "w", "u"])
        .kinematics(|_, x, eta| {
            let (s, c) = (x[2].sin(), x[2].cos());
            [eta[0] * c - eta[2] * s, eta[0] * s + eta[2] * c, eta[1]]
        })
        .lagrangian(|_, _, eta| {
            let across = lateral(eta[2]) + a * eta[1];
            m * (eta[0].square() + across.square()) / 2.0 + j * eta[1].square() / 2.0
        })
        .build()
        .unwrap()
}

#[test]
fn the_chaplygin_sleigh_turns_round() {
    let graph = Graph::new();
    let equations = sleigh(&graph, |u| u).poincare_constrained(2).unwrap();
    assert_eq!(
        equations.right_hand_side().iter().map(Expr::to_string).collect::<Vec<_>>(),
        ["m*a*w^2", "-m*a*v*w"]
    );
    let reference =
        [-2.076459013951296, 2.306638548235811, 3.036242321872673, 1.092780100402684, 0.2113417179146603];
    reaches(&equations, &[0.0, 0.0, 0.0, 0.0, 1.0], 5.0, &reference, &["energy"]);
}

/// The classical mistake: with the constraint in L before differentiation the sleigh does not turn.
#[test]
fn a_constraint_put_into_the_lagrangian_gives_the_wrong_motion() {
    let graph = Graph::new();
    let right = sleigh(&graph, |u| u).poincare_constrained(2).unwrap();
    let wrong = sleigh(&graph, |_| Expr::ZERO).poincare_constrained(2).unwrap();
    assert!(wrong.right_hand_side().iter().all(|r| r.is_zero()));
    assert!(right.right_hand_side().iter().all(|r| !r.is_zero()));
}

/// System 7: a disk rolling on a plane, θ the angle of its axle with the vertical; slips u and v are zero.
fn disk(graph: &Graph) -> System<'_> {
    let [m, a, c, r, g] = graph.symbols(["m", "A", "C", "r", "g"]);
    let numbers = [(m, 1.0), (a, 0.25), (c, 0.5), (r, 1.0), (g, 10.0)];
    let builder =
        numbers.into_iter().fold(System::builder(graph), |b, (symbol, value)| b.parameter(symbol, value));
    builder
        .coordinates(["X", "Y", "psi", "theta", "phi"])
        .quasi_velocities(["w1", "w2", "w3", "u", "v"])
        .kinematics(|_, x, w| {
            let roll = w[2] - w[1] * x[3].cot();
            let along = w[3] - r * roll;
            [
                along * x[2].cos() - w[4] * x[2].sin(),
                along * x[2].sin() + w[4] * x[2].cos(),
                w[1] / x[3].sin(),
                w[0],
                roll,
            ]
        })
        .lagrangian(|_, x, w| {
            let (s, co) = (x[3].sin(), x[3].cos());
            let centre = (w[3] - r * w[2]).square() + (w[4] * co).square() + (r * w[0] - w[4] * s).square();
            (m * centre + a * (w[0].square() + w[1].square()) + c * w[2].square()) / 2.0 - m * g * r * s
        })
        .build()
        .unwrap()
}

#[test]
fn the_tilted_disk_rolls_as_in_the_book() {
    let graph = Graph::new();
    let equations = disk(&graph).poincare_constrained(3).unwrap();
    let mass: Vec<String> = (0..3).map(|s| equations.mass_matrix()[(s, s)].to_string()).collect();
    assert_eq!(mass, ["m*r^2 + A", "A", "m*r^2 + C"]);
    let reference = [
        4.425392415561948,
        4.473322951536658,
        -4.936364273304879,
        1.135107373891322,
        23.2600612998216,
        0.7739534176492255,
        -0.01163611737026912,
        3.989394532184395,
    ];
    reaches(&equations, &[0.0, 0.0, 0.0, 1.2, 0.0, 0.2, 0.5, 4.0], 5.0, &reference, &["energy"]);
}

#[test]
fn the_equations_of_the_disk_are_short() {
    let graph = Graph::new();
    let equations = disk(&graph).poincare_constrained(3).unwrap();
    let free = equations.compile().unwrap().cost();
    let bound = equations.with_parameters_bound().compile().unwrap().cost();
    assert!(free.total() <= 44, "{free:?}\n{:?}", equations.right_hand_side());
    assert!(bound.total() <= 30, "{bound:?}");
}

/// A, B, D of the constraint ż = A ẋ + B ẏ + D.
fn voronets_coefficients<'g>(affine: bool, t: Expr<'g>, x: &[Expr<'g>]) -> [Expr<'g>; 3] {
    let drift = if affine { t.cos() / 2.0 + x[1] / 10.0 + x[2] / 5.0 } else { Expr::ZERO };
    [x[1] + x[2].square() / 2.0, x[0] * x[2], drift]
}

/// System 15: an affine constraint whose coefficients depend on the dependent coordinate and on time.
#[test]
fn the_rheonomic_voronets_system_reaches_its_reference() {
    let graph = Graph::new();
    let cases = [
        (
            false,
            [
                7.652529543655616,
                -2.799001626851772,
                -1.542307483484538,
                2.399046385940416,
                -0.3223853032925174,
            ],
        ),
        (
            true,
            [
                5.772359768745835,
                -3.38367175217733,
                -1.441281591163689,
                1.924512584414301,
                -0.6578079305316382,
            ],
        ),
    ];
    for (affine, reference) in cases {
        let system = System::builder(&graph)
            .coordinates(["x", "y", "z"])
            .quasi_velocities(["vx", "vy", "slip"])
            .kinematics(|t, x, eta| {
                let [a, b, d] = voronets_coefficients(affine, t, x);
                [eta[0], eta[1], eta[2] + a * eta[0] + b * eta[1] + d]
            })
            .lagrangian(|t, x, eta| {
                let [a, b, d] = voronets_coefficients(affine, t, x);
                let vz = a * eta[0] + b * eta[1] + eta[2] + d;
                (eta[0].square() + eta[1].square() + vz.square()) / 2.0
                    - x[2].square() / 2.0
                    - x[0] * x[2] / 4.0
            })
            .build()
            .unwrap();
        let equations = system.poincare_constrained(2).unwrap();
        let conserved: &[&str] = if affine { &[] } else { &["energy"] };
        reaches(&equations, &[0.5, -0.5, 1.0, 0.8, -0.6], 5.0, &reference, conserved);
    }
}

/// System 10: a ball on a turntable, redundant quaternion, affine slip constraints, b_0 ≠ 0 and c_0s ≠ 0.
#[test]
fn the_ball_on_a_turntable_reaches_its_references() {
    let cases = [
        (
            false,
            [
                -0.5858394110506533,
                0.3487082162886643,
                0.5597051818731494,
                -0.471089029523026,
                -0.4692884514941789,
                1.960389900644303,
                -1.197967004269083,
                6.601114001840867,
                0.5,
            ],
        ),
        (
            true,
            [
                0.8750223130613459,
                0.3436983108789376,
                0.2809173687590521,
                0.1931135797224726,
                2.803120996566108,
                1.889474315555643,
                10.58146034610535,
                7.07331030000028,
                0.5,
            ],
        ),
    ];
    for (accelerated, reference) in cases {
        let graph = Graph::new();
        let (m, r, j) = (1.0, 0.5, 0.1);
        let system = System::builder(&graph)
            .coordinates(["q0", "q1", "q2", "q3", "X", "Y"])
            .quasi_velocities(["wx", "wy", "wz", "u", "v"])
            .kinematics(|t, x, w| {
                let omega: Expr<'_> = if accelerated { 1.0 + t / 4.0 } else { 2.0.into() };
                let q = &x[..4];
                [
                    (-q[1] * w[0] - q[2] * w[1] - q[3] * w[2]) / 2.0,
                    (q[0] * w[0] + q[3] * w[1] - q[2] * w[2]) / 2.0,
                    (q[0] * w[1] + q[1] * w[2] - q[3] * w[0]) / 2.0,
                    (q[0] * w[2] + q[2] * w[0] - q[1] * w[1]) / 2.0,
                    w[1] * r + w[3] - omega * x[5],
                    w[4] - w[0] * r + omega * x[4],
                ]
            })
            .lagrangian(|t, x, w| {
                let omega: Expr<'_> = if accelerated { 1.0 + t / 4.0 } else { 2.0.into() };
                let (vx, vy) = (w[1] * r + w[3] - omega * x[5], w[4] - w[0] * r + omega * x[4]);
                let spin = w[0].square() + w[1].square() + w[2].square();
                (vx.square() + vy.square()) * (m / 2.0) + spin * (j / 2.0)
            })
            .build()
            .unwrap();
        let equations = system.poincare_constrained(3).unwrap();
        reaches(&equations, &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 3.0, 1.0, 0.5], 5.0, &reference, &[]);
    }
}
