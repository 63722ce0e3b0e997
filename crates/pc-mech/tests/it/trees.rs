//! Bodies joined by joints against the same bodies placed by hand, with positions and rotations written out.

use pc_expr::{Backend, Evaluator, Inputs, Program};
use pc_mech::{
    CompileOptions, Expr, Graph, Joint, Matrix, Motions, RigidBody, System, SystemBuilder, Tree, TreeBody,
    TreeElimination, TreeError, VectorField,
};
use proptest::prelude::*;
use proptest::test_runner::{RngSeed, TestRunner};

mod inverse_dynamics;
mod reactions;
mod recursion;

/// A joint by its number, with its axes.
#[derive(Clone, Debug)]
pub(crate) struct Hung {
    kind: usize,
    axes: [[f64; 3]; 2],
    parent: Option<usize>,
    place: [f64; 3],
    /// Rotation vector of the joint's axes in the parent.
    tilt: [f64; 3],
    mass: f64,
    centre: [f64; 3],
    /// Points of unit mass, which give the inertia of a body.
    spread: [[f64; 3]; 3],
    /// The body whose joint moves this one, with ratio and offset.
    follows: Option<(usize, f64, f64)>,
    /// Armature, stiffness, place at rest and damping of the joint.
    drive: Option<[f64; 4]>,
}

const KINDS: usize = 9;

fn coordinate_axis(i: usize, sign: f64) -> [f64; 3] {
    std::array::from_fn(|j| if i == j { sign } else { 0.0 })
}

fn axis() -> impl Strategy<Value = [f64; 3]> {
    let small = -2.0..2.0f64;
    let any = (small.clone(), small.clone(), 0.5..2.0f64).prop_map(|(x, y, z)| [x, y, z]);
    prop_oneof![
        ((0..3usize), prop::bool::ANY).prop_map(|(i, s)| coordinate_axis(i, if s { 1.0 } else { -1.0 })),
        any
    ]
}

fn body(index: usize) -> impl Strategy<Value = Hung> {
    let vector = || prop::array::uniform3(-1.0..1.0f64);
    let tilt = prop_oneof![Just([0.0; 3]), vector()];
    let parts = (0..KINDS, axis(), axis(), 0..=index, vector(), tilt);
    (parts, 0.5..2.0f64, vector(), prop::array::uniform3(vector())).prop_map(
        |((kind, first, second, parent, place, tilt), mass, centre, spread)| Hung {
            kind,
            // Two axes of a universal joint are not parallel.
            axes: [
                first,
                if cross(first, second).iter().all(|c| c.abs() < 0.2) {
                    [first[1], first[2], first[0] + 0.1]
                } else {
                    second
                },
            ],
            parent: parent.checked_sub(1),
            place,
            tilt,
            mass,
            centre,
            spread,
            follows: None,
            drive: None,
        },
    )
}

fn tree_of(count: usize) -> impl Strategy<Value = Vec<Hung>> {
    (0..count).map(body).collect::<Vec<_>>()
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Σ (r²δ − r rᵀ) over the points: [xx, yy, zz, xy, yz, xz].
fn inertia(points: &[[f64; 3]]) -> [f64; 6] {
    let entry = |i: usize, j: usize| -> f64 {
        let square = |r: &[f64; 3]| r.iter().map(|c| c * c).sum::<f64>();
        points.iter().map(|r| if i == j { square(r) } else { 0.0 } - r[i] * r[j]).sum()
    };
    [entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(1, 2), entry(0, 2)]
}

type Rows<'g> = [[Expr<'g>; 3]; 3];

fn identity<'g>() -> Rows<'g> {
    std::array::from_fn(|i| std::array::from_fn(|j| if i == j { Expr::ONE } else { Expr::ZERO }))
}

fn times<'g>(a: &Rows<'g>, b: &Rows<'g>) -> Rows<'g> {
    std::array::from_fn(|i| {
        std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).fold(Expr::ZERO, |s, x| s + x))
    })
}

fn on<'g>(a: &Rows<'g>, v: [Expr<'g>; 3]) -> [Expr<'g>; 3] {
    std::array::from_fn(|i| (0..3).map(|k| a[i][k] * v[k]).fold(Expr::ZERO, |s, x| s + x))
}

/// Rodrigues' formula: 1 + sin φ ê + (1 − cos φ) ê².
fn turn<'g>(axis: [f64; 3], angle: Expr<'g>) -> Rows<'g> {
    let length = axis.iter().map(|c| c * c).sum::<f64>().sqrt();
    let [x, y, z] = axis.map(|c| if length == 0.0 { Expr::ZERO } else { Expr::from(c / length) });
    let hat = [[Expr::ZERO, -z, y], [z, Expr::ZERO, -x], [-y, x, Expr::ZERO]];
    let square = times(&hat, &hat);
    let one = identity();
    std::array::from_fn(|i| {
        std::array::from_fn(|j| one[i][j] + angle.sin() * hat[i][j] + (1.0 - angle.cos()) * square[i][j])
    })
}

fn quaternion<'g>(q: &[Expr<'g>]) -> Rows<'g> {
    let [a, b, c, d] = [q[0], q[1], q[2], q[3]];
    let s = |x: Expr<'g>| x.square();
    [
        [s(a) + s(b) - s(c) - s(d), 2.0 * (b * c - a * d), 2.0 * (b * d + a * c)],
        [2.0 * (b * c + a * d), s(a) - s(b) + s(c) - s(d), 2.0 * (c * d - a * b)],
        [2.0 * (b * d - a * c), 2.0 * (c * d + a * b), s(a) - s(b) - s(c) + s(d)],
    ]
}

fn normed(axis: [f64; 3]) -> [f64; 3] {
    let length = axis.iter().map(|c| c * c).sum::<f64>().sqrt();
    axis.map(|c| c / length)
}

impl Hung {
    fn tilted<'g>(&self) -> Rows<'g> {
        let angle = self.tilt.iter().map(|c| c * c).sum::<f64>().sqrt();
        turn(self.tilt, angle.into())
    }

    fn joint<'g>(&self) -> Joint<'g> {
        let [first, second] = self.axes;
        let joint = match self.kind {
            0 => Joint::fixed(),
            1 => Joint::revolute(first),
            2 => Joint::prismatic(first),
            3 => Joint::screw(first, 0.3),
            4 => Joint::cylindrical(first),
            5 => Joint::universal(first, second),
            6 => Joint::planar(coordinate_axis(2, 1.0)),
            7 => Joint::spherical(),
            _ => Joint::free(),
        };
        let joint = match self.follows {
            Some((body, ratio, offset)) => joint.following(format!("b{body}"), ratio, offset),
            None => joint,
        };
        let joint = match self.drive {
            Some([armature, stiffness, rest, damping]) => {
                joint.armature(armature).spring(stiffness, rest).damping(damping)
            }
            None => joint,
        };
        let rows = self.tilted();
        joint.at(self.place).rotated(&Matrix::from_fn(3, 3, |i, j| rows[i][j]))
    }

    /// The body on a joint without spring and damper.
    pub(crate) fn with_inertia_alone(self) -> Hung {
        Hung { drive: self.drive.map(|[armature, ..]| [armature, 0.0, 0.0, 0.0]), ..self }
    }

    fn sizes(&self) -> (usize, usize) {
        if self.follows.is_some() {
            return (0, 0);
        }
        [(0, 0), (1, 1), (1, 1), (1, 1), (2, 2), (2, 2), (3, 3), (4, 3), (7, 6)][self.kind]
    }

    /// Displacement and rotation in the axes of the joint.
    fn moved<'g>(&self, x: &[Expr<'g>]) -> ([Expr<'g>; 3], Rows<'g>) {
        let [first, second] = self.axes.map(normed);
        let along = |length: Expr<'g>| first.map(|c| length * c);
        let zero = [Expr::ZERO; 3];
        match self.kind {
            0 => (zero, identity()),
            1 => (zero, turn(first, x[0])),
            2 => (along(x[0]), identity()),
            3 => (along(0.3 * x[0]), turn(first, x[0])),
            4 => (along(x[0]), turn(first, x[1])),
            5 => (zero, times(&turn(first, x[0]), &turn(second, x[1]))),
            6 => ([x[0], x[1], Expr::ZERO], turn([0.0, 0.0, 1.0], x[2])),
            7 => (zero, quaternion(&x[0..4])),
            _ => ([x[0], x[1], x[2]], quaternion(&x[3..7])),
        }
    }
}

const GRAVITY: [f64; 3] = [0.3, -0.2, -9.81];

const LOAD: [f64; 3] = [0.5, -0.25, 0.125];
const TORQUE: [f64; 3] = [-0.1, 0.2, 0.3];

fn tree<'g>(graph: &'g Graph, bodies: &[Hung], loaded: bool) -> Tree<'g> {
    let hung = bodies.iter().enumerate().map(|(i, body)| {
        let hung = TreeBody::new(format!("b{i}"), body.joint())
            .mass(body.mass)
            .centre(body.centre)
            .inertia(inertia(&body.spread));
        let hung = if loaded { hung.force(LOAD).torque(TORQUE) } else { hung };
        match body.parent {
            Some(parent) => hung.on(format!("b{parent}")),
            None => hung,
        }
    });
    Tree::new(graph, hung).unwrap()
}

fn names(list: &[Expr<'_>]) -> Vec<String> {
    list.iter().map(Expr::to_string).collect()
}

/// A system that moves according to the joints of a tree.
fn started<'g>(graph: &'g Graph, tree: &Tree<'g>, loaded: bool) -> SystemBuilder<'g> {
    let velocities = tree.velocities();
    let system = System::builder(graph)
        .coordinates(names(&tree.coordinates()))
        .quasi_velocities(names(&tree.quasi_velocities()))
        .kinematics(|_, _, _| velocities);
    if loaded { system.gravity(|_| GRAVITY.map(Expr::from)) } else { system }
}

pub(crate) fn hung<'g>(graph: &'g Graph, bodies: &[Hung], loaded: bool) -> System<'g> {
    let tree = tree(graph, bodies, loaded);
    started(graph, &tree, loaded).tree(tree).build().unwrap()
}

/// The system of the tree, and the same bodies placed by hand.
fn systems<'g>(graph: &'g Graph, bodies: &[Hung]) -> (System<'g>, System<'g>) {
    let tree = tree(graph, bodies, true);
    let start = || started(graph, &tree, true);
    let (x, eta) = (tree.coordinates(), tree.quasi_velocities());
    let mut by_hand = start();
    let mut placed: Vec<([Expr<'g>; 3], Rows<'g>)> = Vec::new();
    let before = |i: usize, size: fn(&Hung) -> usize| -> usize { bodies[..i].iter().map(size).sum() };
    let starts: Vec<usize> = (0..bodies.len()).map(|i| before(i, |body| body.sizes().0)).collect();
    for (i, (body, &start)) in bodies.iter().zip(&starts).enumerate() {
        if let Some([armature, stiffness, rest, damping]) = body.drive {
            let (followed, ratio, offset) = body.follows.unwrap_or((i, 1.0, 0.0));
            let moving = before(followed, |body| body.sizes().1);
            let (x, rate) = (ratio * x[starts[followed]] + offset, ratio * eta[moving]);
            by_hand = by_hand
                .kinetic(|_, _, _| armature * rate.square() / 2.0)
                .potential(|_, _, _| stiffness * (x - rest).square() / 2.0)
                .dissipation(|_, _, _| damping * rate.square() / 2.0);
        }
        let (place, rotation) = body.parent.map_or(([Expr::ZERO; 3], identity()), |parent| placed[parent]);
        let (way, turned) = match body.follows {
            Some((followed, ratio, offset)) => body.moved(&[ratio * x[starts[followed]] + offset]),
            None => body.moved(&x[start..]),
        };
        let tilted = body.tilted();
        let offset = on(&tilted, way);
        let offset = on(&rotation, std::array::from_fn(|i| offset[i] + body.place[i]));
        let place: [Expr<'g>; 3] = std::array::from_fn(|i| place[i] + offset[i]);
        let rotation = times(&times(&rotation, &tilted), &turned);
        placed.push((place, rotation));
        let centre = on(&rotation, body.centre.map(Expr::from));
        let centre: [Expr<'g>; 3] = std::array::from_fn(|i| place[i] + centre[i]);
        by_hand = by_hand.rigid_body(|_, _, _| {
            RigidBody::rotating(
                body.mass,
                centre,
                inertia(&body.spread),
                Matrix::from_fn(3, 3, |i, j| rotation[i][j]),
            )
            .force(LOAD)
            .torque(TORQUE)
        });
    }
    (hung(graph, bodies, true), by_hand.build().unwrap())
}

/// A state with unit quaternions.
pub(crate) fn state(bodies: &[Hung], numbers: &[f64]) -> Vec<f64> {
    let mut y: Vec<f64> = Vec::new();
    for body in bodies {
        let first = y.len();
        y.extend(&numbers[first..first + body.sizes().0]);
        let quaternion = match body.kind {
            7 => first..first + 4,
            8 => first + 3..first + 7,
            _ => continue,
        };
        y[quaternion.start] += 0.5;
        let norm = y[quaternion.clone()].iter().map(|q| q * q).sum::<f64>().sqrt();
        y[quaternion].iter_mut().for_each(|q| *q /= norm);
    }
    let k: usize = bodies.iter().map(|body| body.sizes().1).sum();
    let first = y.len();
    y.extend(&numbers[first..first + k]);
    y
}

/// The largest difference of two lists, relative to the largest number in them.
pub(crate) fn difference(a: &[f64], b: &[f64]) -> f64 {
    let largest = a.iter().chain(b).fold(1.0f64, |largest, x| largest.max(x.abs()));
    a.iter().zip(b).fold(0.0, |worst: f64, (a, b)| worst.max((a - b).abs())) / largest
}

/// Random trees of `count` bodies, with numbers for their states.
pub(crate) fn trees(cases: u32, count: usize, check: impl Fn(&[Hung], &[f64])) {
    let config = ProptestConfig {
        cases,
        rng_seed: RngSeed::Fixed(20),
        failure_persistence: None,
        max_shrink_iters: 0, // smaller numbers give masses without inertia
        ..ProptestConfig::default()
    };
    let strategy = (tree_of(count), prop::collection::vec(-1.0..1.0f64, 20 * count));
    let outcome = TestRunner::new(config).run(&strategy, |(bodies, numbers)| {
        prop_assume!(bodies.iter().any(|body| body.kind != 0));
        check(&bodies, &numbers);
        Ok(())
    });
    outcome.unwrap();
}

/// The condition of mass matrices of a few bodies, times rounding.
const ROUNDING: f64 = 1e-10;

#[test]
fn bodies_hung_by_joints_move_as_those_placed_by_hand() {
    trees(16, 3, |bodies, numbers| {
        let graph = Graph::new();
        let (hung, placed) = systems(&graph, bodies);
        let y = state(bodies, numbers);
        let rates = |system: &System<'_>, elimination: TreeElimination| -> Vec<f64> {
            let options = CompileOptions::default().jacobian(false).elimination(elimination);
            system.poincare().unwrap().compile_for(options).unwrap().rates(0.0, &y).unwrap()
        };
        let placed = rates(&placed, TreeElimination::Whole);
        for elimination in [TreeElimination::ByJoints, TreeElimination::Whole, TreeElimination::Shorter] {
            let hung = rates(&hung, elimination);
            assert!(difference(&hung, &placed) < ROUNDING, "{elimination:?}: {hung:?}\n{placed:?}");
        }
    });
}

/// Random trees in which most joints with one coordinate follow the first such joint, or the last, and half of
/// them have drives.
pub(crate) fn geared(cases: u32, count: usize, check: impl Fn(&[Hung], &[f64])) {
    trees(cases, count, |bodies, numbers| {
        let mut bodies = bodies.to_vec();
        let single: Vec<usize> = (0..count).filter(|&i| (1..=3).contains(&bodies[i].kind)).collect();
        let [first, others @ .., last] = &single[..] else { return };
        for (n, &i) in others.iter().enumerate() {
            let followed = if n % 2 == 0 { *first } else { *last };
            bodies[i].follows = (n % 3 < 2).then_some((followed, 0.7 - 0.9 * n as f64, 0.3));
        }
        if others.is_empty() {
            bodies[*first].follows = Some((*last, -0.8, 0.1));
        }
        for (n, &i) in single.iter().enumerate().filter(|(n, _)| (n + count).is_multiple_of(2)) {
            bodies[i].drive = Some([0.4, 3.0, -0.1 * n as f64, 0.2]);
        }
        check(&bodies, numbers);
    });
}

#[test]
fn geared_joints_move_as_bodies_placed_by_hand() {
    geared(40, 6, |bodies, numbers| {
        let graph = Graph::new();
        let (hung, placed) = systems(&graph, bodies);
        let y = state(bodies, numbers);
        let rates = |system: &System<'_>, elimination: TreeElimination| -> Vec<f64> {
            let options = CompileOptions::default().jacobian(false).elimination(elimination);
            system.poincare().unwrap().compile_for(options).unwrap().rates(0.0, &y).unwrap()
        };
        let placed = rates(&placed, TreeElimination::Whole);
        for elimination in [TreeElimination::ByJoints, TreeElimination::Whole] {
            let hung = rates(&hung, elimination);
            assert!(difference(&hung, &placed) < ROUNDING, "{elimination:?}: {hung:?}\n{placed:?}");
        }
    });
}

/// Values of expressions of (x, η, η̇).
pub(crate) fn values(
    system: &System<'_>,
    expressions: &[Expr<'_>],
    y: &[f64],
    accelerations: &[f64],
) -> Vec<f64> {
    let inputs = Inputs {
        time: Some(system.frame().time()),
        state: system.state().into_iter().chain(system.accelerations()).collect(),
        parameters: Vec::new(),
    };
    let program = Program::new(system.graph(), &inputs, expressions).unwrap();
    let mut values = vec![0.0; expressions.len()];
    let state = [y, accelerations].concat();
    Evaluator::new(program, Backend::Interpreter).eval(0.0, &state, &[], &mut values);
    values
}

/// A mass point on a ball joint, and one on a hinge at it: if all are on one line, no inertia resists a
/// rotation about it.
#[test]
fn a_state_in_which_a_joint_loses_its_inertia_is_refused() {
    let graph = Graph::new();
    let line = [0.3, 0.0, -1.1]; // no axis of the frame, so that all diagonal entries of the inertia are positive
    let ball = TreeBody::new("ball", Joint::spherical()).mass(2).centre(line);
    let hinge =
        TreeBody::new("hinge", Joint::revolute([0.0, 1.0, 0.0]).at(line)).on("ball").mass(0.7).centre(line);
    let tree = Tree::new(&graph, [ball, hinge]).unwrap();
    let system = started(&graph, &tree, true).tree(tree).build().unwrap();
    let options = CompileOptions::default().jacobian(false).elimination(TreeElimination::ByJoints);
    let mut motion = system.poincare().unwrap().compile_for(options).unwrap();
    let mut rates = |angle: f64| motion.rates(0.0, &[0.6, 0.0, 0.8, 0.0, angle, 0.1, 0.2, 0.3, 0.4]);
    for straight in [0.0, 1e-9, std::f64::consts::PI, 2.0 * std::f64::consts::PI] {
        let error = rates(straight).unwrap_err().to_string();
        assert!(error.contains("mass matrix is singular"), "{straight}: {error}");
    }
    assert!(rates(1.0).is_ok());
}

/// Where gravity depends on the place, L contains its gradient, and the world has no acceleration.
#[test]
fn gravity_may_change_from_place_to_place() {
    let graph = Graph::new();
    let weight = TreeBody::new("z", Joint::prismatic([0.0, 0.0, 1.0])).mass(2);
    let z = graph.symbol("z");
    let system = System::builder(&graph)
        .coordinates(["z"])
        .gravity(|_| [Expr::ZERO, Expr::ZERO, -z])
        .tree(Tree::new(&graph, [weight]).unwrap())
        .build()
        .unwrap();
    let options = CompileOptions::default().elimination(TreeElimination::ByJoints);
    let mut motion = system.poincare().unwrap().compile_for(options).unwrap();
    // L = z'²  - 2 z · z, so that z'' = -2 z.
    assert_eq!(motion.rates(0.0, &[0.25, 0.5]).unwrap(), [0.5, -0.5]);
}

/// A tree without its cyclic coordinates moves as before.
#[test]
fn a_tree_without_its_cyclic_coordinates_moves_as_before() {
    let graph = Graph::new();
    let bodies: Vec<Hung> = (0..6)
        .map(|i| Hung {
            kind: if i == 0 { 8 } else { 1 },
            axes: [coordinate_axis(i % 3, 1.0); 2],
            parent: (i > 0).then(|| (i - 1) / 2),
            place: [0.3, -0.2, 0.1 * i as f64],
            tilt: [0.0; 3],
            mass: 1.0,
            centre: [0.1, 0.2, -0.3],
            spread: [[0.5, 0.0, 0.1], [0.0, 0.4, 0.0], [0.1, 0.2, 0.6]],
            follows: None,
            drive: None,
        })
        .collect();
    let system = hung(&graph, &bodies, false);
    let reduced = system.reduced().unwrap();
    let (n, kept) = (system.frame().coordinates().len(), reduced.frame().coordinates().len());
    assert_eq!((n, kept), (12, 5), "a free body has no place and no attitude");
    let y = state(&bodies, &(0..40).map(|i| (0.7 * f64::from(i)).sin()).collect::<Vec<_>>());
    let rates = |system: &System<'_>, y: &[f64]| {
        let options = CompileOptions::default().jacobian(false);
        system.poincare().unwrap().compile_for(options).unwrap().rates(0.0, y).unwrap()
    };
    let whole = rates(&system, &y);
    let (of_reduced, of_whole) = (rates(&reduced, &y[n - kept..]), &whole[n - kept..]);
    assert!(difference(&of_reduced, of_whole) < ROUNDING, "{of_reduced:?} {of_whole:?}");
}

#[test]
fn invalid_trees_are_refused() {
    let graph = Graph::new();
    let body = |name: &str| TreeBody::new(name, Joint::revolute([0.0, 0.0, 1.0]));
    let error = |bodies: Vec<TreeBody<'_>>| Tree::new(&graph, bodies).unwrap_err().to_string();
    assert_eq!(error(vec![body("a"), body("a")]), "there are two bodies called `a`");
    assert_eq!(
        error(vec![body("a").on("b")]),
        "the body `a` hangs on `b`, but there is no body of that name"
    );
    assert_eq!(
        error(vec![body("a").on("c"), body("b").on("a"), body("c").on("b")]),
        "bodies hang on each other in a circle: a on c on b"
    );
    assert_eq!(
        error(vec![TreeBody::new("a", Joint::prismatic([0.0; 3]))]),
        "the axis (0, 0, 0) of the joint of `a` has no direction"
    );
    let named = Joint::spherical().named(["q"], ["ω"]);
    assert_eq!(
        error(vec![TreeBody::new("a", named)]),
        "the joint of `a` has 4 coordinates; 1 names are given"
    );
    let following = |name: &str, other: &str| {
        TreeBody::new(name, Joint::revolute([0.0, 0.0, 1.0]).following(other, 2.0, 0.0))
    };
    assert_eq!(
        error(vec![following("a", "b")]),
        "the joint of `a` follows that of `b`, but there is no body of that name"
    );
    assert_eq!(
        error(vec![following("a", "b"), following("b", "c"), following("c", "b")]),
        "joints follow each other in a circle: b, c, b"
    );
    assert_eq!(
        error(vec![following("a", "b"), TreeBody::new("b", Joint::spherical())]),
        "the joint of `a` cannot follow that of `b`: both must have exactly one coordinate"
    );
    assert_eq!(
        error(vec![TreeBody::new("a", Joint::planar([0.0, 0.0, 1.0]).damping(0.1))]),
        "the joint of `a` cannot have the damping given to it: it does not have exactly one coordinate"
    );
    let tree = Tree::new(&graph, [body("a").mass(1)]).unwrap();
    let outcome = System::builder(&graph).coordinates(["b"]).tree(tree).build();
    let missing = TreeError::NotOfTheSystem { name: "a".to_owned(), what: "coordinates" };
    assert_eq!(outcome.unwrap_err(), missing.into());
}
