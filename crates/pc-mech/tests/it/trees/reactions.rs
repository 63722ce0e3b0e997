//! Reactions of joints, against the changes of the momenta of bodies.

use super::*;

/// r × f
fn arm_times<'g>(r: &[Expr<'g>; 3], f: &[Expr<'g>; 3]) -> [Expr<'g>; 3] {
    std::array::from_fn(|c| r[(c + 1) % 3] * f[(c + 2) % 3] - r[(c + 2) % 3] * f[(c + 1) % 3])
}

/// A vector of a body along the axes of the world.
fn turned<'g>(motions: &Motions<'_, 'g>, body: &str, v: [Expr<'g>; 3]) -> [Expr<'g>; 3] {
    let rotation = motions.rotation(body).unwrap();
    std::array::from_fn(|c| (0..3).fold(Expr::ZERO, |sum, j| sum + rotation[(c, j)] * v[j]))
}

/// The momentum and the angular momentum of each body change by its weight, its loads, the reaction of its joint, and
/// those of the joints that hang on it.
#[test]
fn joint_reactions_change_the_momenta() {
    trees(8, 4, reactions_change_the_momenta);
    geared(8, 5, reactions_change_the_momenta);
}

fn reactions_change_the_momenta(bodies: &[Hung], numbers: &[f64]) {
    let graph = Graph::new();
    let system = hung(&graph, bodies, true);
    let y = state(bodies, numbers);
    let motion = system.poincare().unwrap().compile_for(CompileOptions::default().jacobian(false));
    let rates = motion.unwrap().rates(0.0, &y).unwrap();
    let tree = tree(&graph, bodies, true);
    let motions = tree.motions();
    let n = system.frame().coordinates().len();
    let x = system.frame().coordinates().iter().copied().zip(tree.velocities());
    let eta = system.quasi_velocities().iter().copied().zip(system.accelerations());
    let along: Vec<_> = x.chain(eta).collect();
    let reactions = system.joint_reactions();
    let turned = |body: &str, v| turned(&motions, body, v);
    // The force of a joint, and its moment about the origin of the world.
    let borne = |i: usize| {
        let reaction = &reactions[i];
        let force = turned(reaction.body(), *reaction.force());
        let arm = arm_times(&motions.place(reaction.body()).unwrap(), &force);
        let moment = turned(reaction.body(), *reaction.moment());
        let of_world: [Expr<'_>; 6] =
            std::array::from_fn(|c| if c < 3 { force[c] } else { arm[c - 3] + moment[c - 3] });
        of_world
    };
    let (mut change, mut causes) = (Vec::new(), Vec::new());
    for (i, body) in tree.bodies().iter().enumerate() {
        assert_eq!(reactions[i].body(), body.name());
        change.extend(graph.directional(&motions.momentum(body.name()).unwrap(), &along));
        change.extend(graph.directional(&motions.angular_momentum(body.name()).unwrap(), &along));
        let centre = turned(body.name(), bodies[i].centre.map(Expr::from));
        let place = motions.place(body.name()).unwrap();
        let centre: [Expr<'_>; 3] = std::array::from_fn(|c| place[c] + centre[c]);
        let load: [Expr<'_>; 3] = std::array::from_fn(|c| (bodies[i].mass * GRAVITY[c] + LOAD[c]).into());
        let (arm, torque) = (arm_times(&centre, &load), turned(body.name(), TORQUE.map(Expr::from)));
        let own = borne(i);
        let hanging: Vec<_> = (0..bodies.len()).filter(|&j| bodies[j].parent == Some(i)).map(borne).collect();
        causes.extend((0..6).map(|c| {
            let load = if c < 3 { load[c] } else { arm[c - 3] + torque[c - 3] };
            own[c] + load - graph.sum(hanging.iter().map(|other| other[c]))
        }));
    }
    let change = values(&system, &change, &y, &rates[n..]);
    let causes = values(&system, &causes, &y, &rates[n..]);
    assert!(difference(&change, &causes) < ROUNDING, "{change:?} {causes:?}");
}

#[test]
fn a_pendulum_pulls_at_its_joint() {
    let graph = Graph::new();
    let [m, l, g] = graph.symbols(["m", "l", "g"]);
    let bob = TreeBody::new("bob", Joint::revolute([0.0, 1.0, 0.0])).mass(m).centre([0.into(), 0.into(), -l]);
    let pendulum = System::builder(&graph)
        .coordinates(["bob"])
        .gravity(|_| [0.into(), 0.into(), -g])
        .tree(Tree::new(&graph, [bob]).unwrap())
        .build()
        .unwrap();
    let [angle, rate] = graph.symbols(["bob", "bob'"]);
    let tension = m * (g * angle.cos() + l * rate.square());
    assert_eq!(pendulum.joint_reactions()[0].force()[2], tension);
    assert_eq!(pendulum.joint_reactions()[0].moment()[1], pendulum.poincare().unwrap().inverse_dynamics()[0]);
}
