//! Equations (30): constraints η_α = 0 put in after differentiation.

use pc_mech::{Equations, Expr, Graph};
use pc_model::{Builtin, Model};
use pc_solve::{Options, solve};
use pc_tests::definition::assert_derived;
use pc_tests::nonholonomic::{SYSTEMS, ball_on_turntable, disk, sleigh, voronets};

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

#[test]
fn equation_30_turns_the_chaplygin_sleigh_round() {
    let graph = Graph::new();
    let equations = sleigh(&graph, |u| u).unwrap().poincare_constrained(2).unwrap();
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
fn equation_30_forbids_to_put_the_constraint_into_the_lagrangian() {
    let graph = Graph::new();
    let right = sleigh(&graph, |u| u).unwrap().poincare_constrained(2).unwrap();
    let wrong = sleigh(&graph, |_| Expr::ZERO).unwrap().poincare_constrained(2).unwrap();
    assert!(wrong.right_hand_side().iter().all(|r| r.is_zero()));
    assert!(right.right_hand_side().iter().all(|r| !r.is_zero()));
}

#[test]
fn equation_30_rolls_the_tilted_disk_as_in_the_book() {
    let graph = Graph::new();
    let equations = disk(&graph).unwrap().poincare_constrained(3).unwrap();
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
fn equation_30_of_the_disk_is_short() {
    let graph = Graph::new();
    let equations = disk(&graph).unwrap().poincare_constrained(3).unwrap();
    let free = equations.compile().unwrap().cost();
    let bound = equations.with_parameters_bound().compile().unwrap().cost();
    assert!(free.total() <= 44, "{free:?}\n{:?}", equations.right_hand_side());
    assert!(bound.total() <= 30, "{bound:?}");
}

/// An affine constraint whose coefficients depend on the dependent coordinate and on time.
#[test]
fn equation_30_leads_the_rheonomic_voronets_system_to_its_reference() {
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
        let system = voronets(&graph, affine).unwrap();
        let equations = system.poincare_constrained(2).unwrap();
        let conserved: &[&str] = if affine { &[] } else { &["energy"] };
        reaches(&equations, &[0.5, -0.5, 1.0, 0.8, -0.6], 5.0, &reference, conserved);
    }
}

/// A ball on a turntable, redundant quaternion, affine slip constraints, b_0 ≠ 0 and c_0s ≠ 0.
#[test]
fn equation_30_leads_the_ball_on_a_turntable_to_its_references() {
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
        let system = ball_on_turntable(&graph, accelerated).unwrap();
        let equations = system.poincare_constrained(3).unwrap();
        reaches(&equations, &[1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 3.0, 1.0, 0.5], 5.0, &reference, &[]);
    }
}

#[test]
fn equation_30_is_that_of_the_definition() {
    for described in SYSTEMS {
        let vanishing = described.vanishing.len();
        let build = described.system;
        let worst =
            assert_derived(described.name, |graph| build(graph).unwrap(), vanishing, 300, described.sample);
        println!("{}: {worst:.1e} of the largest term", described.name);
    }
}

/// Constants in disguise of quaternion and angle: the brackets of the ball in the cylinder, in a and R alone.
#[test]
fn equation_30_has_brackets_that_forget_the_place() {
    let model = Model::new(Builtin::named("ball-in-cylinder").unwrap().document().unwrap());
    let graph = Graph::new();
    let assembly = model.assemble(&graph).unwrap();
    let [a, radius] = graph.symbols(["a", "R"]);
    let structure = assembly.system.structure();
    for (.., c) in structure.nonzero() {
        assert!(graph.symbols_of(&[c]).iter().all(|symbol| [a, radius].contains(symbol)), "{c}");
    }
    // [ω_r, ω_z] turns with φ̇ = −a ω_z/(R − a), beside the angular velocity of the axes
    assert!((structure.get(1, 3, 2) - (1.0 + a / (radius - a))).is_zero(), "{}", structure.get(1, 3, 2));
}
