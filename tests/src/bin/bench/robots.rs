//! Of `bench trees`: robots with the structure of real ones, and their Jacobians.

use std::time::Instant;

use pc_mech::{
    CompileOptions, Equations, Expr, Graph, Joint, MechError, System, Tree, TreeBody, VectorField,
};
use pc_model::import::model_of_urdf;
use pc_model::{Document, Model, Source};
use pc_tests::classical::SplitMix64;

use crate::error::Error;
use crate::measure::{Variant, interleave};
use crate::report::Report;

/// The bodies of a robot, in an order in which each follows the one that carries it.
struct Robot {
    name: &'static str,
    /// Whether the first body is free.
    floats: bool,
    bodies: Vec<Link>,
    /// What is asked of it.
    goal: &'static str,
}

struct Link {
    parent: Option<usize>,
    slides: bool,
    follows: Option<usize>,
}

impl Robot {
    fn new(name: &'static str, floats: bool, goal: &'static str) -> Robot {
        let bodies = vec![Link { parent: None, slides: false, follows: None }];
        Robot { name, floats, bodies, goal }
    }

    /// The robot with a chain of revolute joints on one of its bodies.
    fn chain(mut self, parent: usize, joints: usize) -> Robot {
        for joint in 0..joints {
            let parent = if joint == 0 { parent } else { self.bodies.len() - 1 };
            self.bodies.push(Link { parent: Some(parent), slides: false, follows: None });
        }
        self
    }

    /// The robot with a finger, and one that mimics it, on its last body but for fingers.
    fn gripper(mut self, parent: usize, slides: bool) -> Robot {
        let first = self.bodies.len();
        self.bodies.push(Link { parent: Some(parent), slides, follows: None });
        self.bodies.push(Link { parent: Some(parent), slides, follows: Some(first) });
        self
    }

    fn tip(&self) -> usize {
        self.bodies.len() - 1
    }

    fn system<'g>(&self, graph: &'g Graph) -> Result<System<'g>, MechError> {
        let mut random = SplitMix64::new(self.bodies.len() as u64);
        let name = |i: usize| format!("b{i}");
        let body = |(i, link): (usize, &Link)| {
            let mut axis = [0.0; 3];
            axis[random.below(3)] = 1.0;
            let mut number =
                |low: f64, high: f64| Expr::from((1e3 * random.uniform(low, high)).round() / 1e3);
            let at = [number(-0.3, 0.3), number(-0.3, 0.3), number(-0.3, 0.3)];
            let joint = match (link.parent, link.slides) {
                (None, _) if self.floats => Joint::free(),
                (_, true) => Joint::prismatic(axis).at(at),
                (_, false) => Joint::revolute(axis).at(at),
            };
            let joint = match link.follows {
                Some(other) => joint.following(name(other), 1.0, 0.0),
                None => joint,
            };
            let body = TreeBody::new(name(i), joint)
                .mass(number(0.5, 2.0))
                .centre([number(-0.1, 0.1), number(-0.1, 0.1), number(0.1, 0.2)])
                .inertia([
                    number(0.1, 0.2),
                    number(0.1, 0.2),
                    number(0.1, 0.2),
                    number(-0.01, 0.01),
                    number(-0.01, 0.01),
                    number(-0.01, 0.01),
                ]);
            match link.parent {
                Some(parent) => body.on(name(parent)),
                None => body,
            }
        };
        let tree = Tree::new(graph, self.bodies.iter().enumerate().map(body).collect::<Vec<_>>())?;
        let names = |list: Vec<Expr<'_>>| list.iter().map(Expr::to_string).collect::<Vec<_>>();
        let velocities = tree.velocities();
        System::builder(graph)
            .coordinates(names(tree.coordinates()))
            .quasi_velocities(names(tree.quasi_velocities()))
            .kinematics(|_, _, _| velocities)
            .gravity(|_| [Expr::ZERO, Expr::ZERO, (-9.81).into()])
            .tree(tree)
            .build()
    }
}

fn robots() -> Vec<Robot> {
    let arm = |name, goal| Robot::new(name, false, goal).chain(0, 6);
    let with_gripper = arm("arm of 7 with a gripper that mimics", "");
    let tip = with_gripper.tip();
    let hand = arm("arm of 7 with a hand, 34 joints mimic", "2 s");
    let palm = hand.tip();
    let legs =
        |robot: Robot, legs: usize, joints: usize| (0..legs).fold(robot, |robot, _| robot.chain(0, joints));
    let humanoid = legs(Robot::new("humanoid of 30 joints", true, "J 60 µs"), 2, 6).chain(0, 3);
    let chest = humanoid.tip();
    vec![
        arm("arm of 7", ""),
        with_gripper.gripper(tip, true),
        (0..34).fold(hand, |hand, _| hand.gripper(palm, false)),
        legs(Robot::new("quadruped of 12 joints", true, ""), 4, 3),
        humanoid.chain(chest, 7).chain(chest, 7).chain(chest, 1),
        legs(Robot::new("50 branches of 3 on a free root", true, "4 s"), 50, 3),
    ]
}

/// Rates and Jacobians of robots.
///
/// # Errors
/// If one cannot be derived.
pub(crate) fn run(report: &mut Report) -> Result<(), Error> {
    report.line("");
    report.columns(&[
        "robot",
        "η",
        "operations",
        "derived and compiled, s",
        "first J, s",
        "f, µs",
        "J, µs",
        "J / f",
        "f a column",
        "goal",
    ]);
    let begun = Instant::now();
    let graph = Graph::new();
    let equations = panda_like(&graph)?;
    report_row(report, ("arm7_gripper.urdf of the zoo", "1050 operations, 0.1 s"), begun, &equations, false)?;
    for robot in robots() {
        let begun = Instant::now();
        let graph = Graph::new();
        let equations = robot.system(&graph)?.poincare()?;
        report_row(report, (robot.name, robot.goal), begun, &equations, robot.floats)?;
    }
    Ok(())
}

/// An arm of seven axes with inertias as a CAD program gives them, and a gripper whose second finger mimics the first.
fn panda_like(graph: &Graph) -> Result<Equations<'_>, Error> {
    let source = Source::new("arm7_gripper.urdf", include_str!("../../../zoo/arm7_gripper.urdf"));
    let (text, _) =
        model_of_urdf(&source, false).map_err(|error| Error::Robot { cause: error.to_string() })?;
    let model = Model::new(Document::parse(Source::new("arm7_gripper.toml", &text))?);
    Ok(model.assemble(graph)?.equations()?)
}

/// Times the rates and the Jacobian of a robot and adds them to the table; `begun` is when its derivation began.
fn report_row(
    report: &mut Report,
    (name, goal): (&str, &str),
    begun: Instant,
    equations: &Equations<'_>,
    floats: bool,
) -> Result<(), Error> {
    let k = equations.system().quasi_velocities().len();
    let mut motion = equations.compile_for(CompileOptions::default().jacobian(false))?;
    let operations = motion.cost().total();
    let mut random = SplitMix64::new(7);
    let n = motion.names().len();
    let mut state: Vec<f64> = (0..n).map(|_| random.uniform(-0.5, 0.5)).collect();
    if floats {
        state[3..7].copy_from_slice(&[0.5; 4]);
    }
    motion.rhs(0.0, &state, &mut vec![0.0; n])?;
    let derived = begun.elapsed().as_secs_f64();
    let mut with_jacobian = equations.compile()?;
    let begun = Instant::now();
    with_jacobian.jacobian(0.0, &state, &mut vec![0.0; n * n])?;
    let first = begun.elapsed().as_secs_f64();
    let mut entries = vec![0.0; n * n];
    let mut variants = vec![
        Variant::new(
            "f",
            Box::new(move |y: &[f64], dy: &mut [f64]| {
                if motion.rhs(0.0, y, dy).is_err() {
                    dy.fill(0.0);
                }
            }),
        ),
        Variant::new(
            "J",
            Box::new(move |y: &[f64], dy: &mut [f64]| {
                if with_jacobian.jacobian(0.0, y, &mut entries).is_err() {
                    entries.fill(0.0);
                }
                dy.copy_from_slice(&entries[entries.len() - dy.len()..]);
            }),
        ),
    ];
    let times = interleave(&state, &mut variants);
    let ratio = times[1].ratio_to(&times[0]);
    report.row(&[
        name.to_owned(),
        k.to_string(),
        operations.to_string(),
        format!("{derived:.2}"),
        format!("{first:.2}"),
        format!("{:.2}", times[0].median() / 1e3),
        format!("{:.1}", times[1].median() / 1e3),
        format!("{ratio:.0}"),
        format!("{:.2}", ratio / n as f64),
        goal.to_owned(),
    ]);
    Ok(())
}
