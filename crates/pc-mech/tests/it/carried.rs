//! Bodies that carry one another, given by positions, against the same Lagrangian without bodies.

use pc_mech::{
    CompileOptions, Expr, Graph, Motion, Particle, RigidBody, System, SystemBuilder, TreeElimination,
    VectorField,
};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed, TestRunner};

use crate::common::{rates, some};

/// A link: what carries it, and what it consists of.
#[derive(Clone, Debug)]
struct Hung {
    /// The number of the link that carries it; none for the support.
    carrier: Option<usize>,
    /// Whether its direction has two angles; otherwise it stays in a plane.
    in_space: bool,
    length: f64,
    /// The place of its mass, as a part of the length, and whether it is a bar.
    middle: f64,
    is_bar: bool,
    /// Whether there is a second mass at its end.
    at_end: bool,
    mass: f64,
}

fn link(index: usize) -> impl Strategy<Value = Hung> {
    let part = prop_oneof![Just(1.0), 0.2..0.9f64];
    (0..=index, prop::bool::weighted(0.3), 0.5..2.0f64, part, any::<[bool; 2]>(), 0.5..2.0f64).prop_map(
        |(carrier, in_space, length, middle, [is_bar, at_end], mass)| Hung {
            carrier: carrier.checked_sub(1),
            in_space,
            length,
            middle,
            is_bar: is_bar && !in_space,
            at_end: at_end || middle < 1.0,
            mass,
        },
    )
}

/// What is the same in both systems.
#[derive(Clone, Copy, Debug)]
struct Around {
    /// Quasi-velocities that are multiples of the velocities by functions of the angle.
    scaled: bool,
    springs: bool,
    damping: bool,
}

/// The names of the angles, and the direction of each link.
fn directions<'g>(graph: &'g Graph, links: &[Hung]) -> (Vec<String>, Vec<[Expr<'g>; 3]>) {
    let mut names = Vec::new();
    let mut directions = Vec::new();
    for (i, link) in links.iter().enumerate() {
        let tilt = graph.symbol(&format!("θ{i}"));
        names.push(format!("θ{i}"));
        let (across, turn) = (tilt.sin(), graph.symbol(&format!("φ{i}")));
        directions.push(if link.in_space {
            names.push(format!("φ{i}"));
            [across * turn.cos(), -tilt.cos(), across * turn.sin()]
        } else {
            [across, -tilt.cos(), Expr::ZERO]
        });
    }
    (names, directions)
}

fn surrounded<'g>(graph: &'g Graph, names: &[String], around: Around) -> SystemBuilder<'g> {
    let builder = System::builder(graph).coordinates(names);
    let builder = if around.scaled {
        let eta: Vec<String> = names.iter().map(|name| format!("u_{name}")).collect();
        builder.quasi_velocities(eta).kinematics(|_, x, eta| {
            x.iter().zip(eta).map(|(x, eta)| *eta * (2.0 + x.sin())).collect::<Vec<_>>()
        })
    } else {
        builder
    };
    let builder = if around.springs {
        builder.potential(|t, x, _| {
            let pairs = x.windows(2).map(|pair| (pair[0] - pair[1]).square() * (1.0 + t.square()) / 2.0);
            pairs.fold(Expr::ZERO, |sum, spring| sum + spring)
        })
    } else {
        builder
    };
    if around.damping {
        builder.dissipation(|_, x, eta| {
            let pairs = eta.windows(2).map(|pair| (pair[0] - pair[1] * x[0].cos()).square() / 5.0);
            pairs.fold(Expr::ZERO, |sum, part| sum + part)
        })
    } else {
        builder
    }
}

/// The system of the bodies.
fn hung<'g>(graph: &'g Graph, links: &[Hung], around: Around) -> System<'g> {
    let (names, directions) = directions(graph, links);
    let mut builder = surrounded(graph, &names, around).gravity(|_| [0.into(), (-10.0).into(), 0.into()]);
    let mut ends: Vec<[Expr<'g>; 3]> = Vec::new();
    for (i, (link, direction)) in links.iter().zip(&directions).enumerate() {
        let hinge = link.carrier.map_or([Expr::ZERO; 3], |carrier| ends[carrier]);
        let at = |part: f64| std::array::from_fn::<_, 3, _>(|k| hinge[k] + part * link.length * direction[k]);
        builder = if link.is_bar {
            let rate = graph.symbol(&format!("θ{i}'"));
            let inertia = [0.1 * link.mass, 0.2 * link.mass, 0.3 * link.mass];
            builder.rigid_body(|_, _, _| {
                RigidBody::turning(link.mass, at(link.middle), inertia, [0.into(), 0.into(), rate])
            })
        } else {
            builder.particle(|_, _, _| Particle::new(link.mass, at(link.middle)))
        };
        if link.at_end {
            builder = builder.particle(|_, _, _| Particle::new(0.5 * link.mass, at(1.0)));
        }
        ends.push(at(1.0));
    }
    builder.build().unwrap()
}

/// The system of the same Lagrangian.
fn written_out<'g>(graph: &'g Graph, hung: &System<'g>, links: &[Hung], around: Around) -> System<'g> {
    let (names, _) = directions(graph, links);
    let around = Around { springs: false, ..around };
    surrounded(graph, &names, around).lagrangian(|_, _, _| hung.lagrangian()).build().unwrap()
}

fn compiled(system: &System<'_>, elimination: TreeElimination) -> Motion {
    let options = CompileOptions::default().jvp(true).elimination(elimination);
    system.poincare().unwrap().compile_for(options).unwrap()
}

fn state(len: usize, seed: u32) -> Vec<f64> {
    (0..len as u32).map(|i| 0.3 + some(i, seed)).collect()
}

fn agree(a: &[f64], b: &[f64]) -> bool {
    let size = b.iter().fold(1.0f64, |size, b| size.max(b.abs()));
    a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 1e-9 * size)
}

/// Rates, Jacobians and products of trees of pendulums in the plane and in space, of bars and several masses a link,
/// with springs and dampers, in velocities and quasi-velocities.
#[test]
fn trees_of_pendulums_move_as_by_their_lagrangian() {
    let links = (1..7usize).prop_flat_map(|count| (0..count).map(link).collect::<Vec<_>>());
    let strategy = (links, any::<[bool; 3]>());
    let config = Config { cases: 60, rng_seed: RngSeed::Fixed(4), ..Config::default() };
    let outcome = TestRunner::new(config).run(&strategy, |(links, [scaled, springs, damping])| {
        let around = Around { scaled, springs, damping };
        let graph = Graph::new();
        let carried = hung(&graph, &links, around);
        let written = written_out(&graph, &carried, &links, around);
        let by_links = TreeElimination::ByJoints;
        let (mut carried, mut written) = (compiled(&carried, by_links), compiled(&written, by_links));
        let dim = carried.dim();
        for seed in 0..3 {
            let (t, y, v) = (0.3 * f64::from(seed), state(dim, seed), state(dim, seed + 7));
            let pair = [rates(&mut carried, t, &y), rates(&mut written, t, &y)];
            prop_assert!(agree(&pair[0], &pair[1]), "{pair:?}");
            let pair = [&mut carried, &mut written].map(|motion| {
                let mut entries = vec![f64::NAN; dim * dim];
                motion.jacobian(t, &y, &mut entries).unwrap();
                entries
            });
            prop_assert!(agree(&pair[0], &pair[1]), "{pair:?}");
            let pair = [&mut carried, &mut written].map(|motion| {
                let mut product = vec![f64::NAN; dim];
                motion.jvp(t, &y, &v, &mut product).unwrap();
                product
            });
            prop_assert!(agree(&pair[0], &pair[1]), "{pair:?}");
        }
        Ok(())
    });
    outcome.unwrap();
}

fn chain(links: usize) -> Vec<Hung> {
    let link = |i: usize| Hung {
        carrier: i.checked_sub(1),
        in_space: false,
        length: 1.0,
        middle: 1.0,
        is_bar: false,
        at_end: false,
        mass: 1.0,
    };
    (0..links).map(link).collect()
}

/// A chain of twice the links takes twice the operations.
#[test]
fn the_work_grows_with_the_number_of_links() {
    let around = Around { scaled: false, springs: false, damping: false };
    let cost = |links: usize| {
        let graph = Graph::new();
        compiled(&hung(&graph, &chain(links), around), TreeElimination::Shorter).cost().total()
    };
    let [short, long] = [cost(10), cost(20)];
    // The first links differ: the support does not move.
    assert!(long < 2 * short + 40 && short < 450, "{short}, {long}");
}
