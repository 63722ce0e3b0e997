//! Forces of given accelerations, and what a free tree keeps.

use super::*;

#[test]
fn forces_on_geared_joints_are_those_of_their_accelerations() {
    geared(24, 8, |bodies, numbers| {
        let graph = Graph::new();
        let system = hung(&graph, bodies, true);
        let equations = system.poincare().unwrap();
        let y = state(bodies, numbers);
        let options = CompileOptions::default().jacobian(false);
        let rates = equations.compile_for(options).unwrap().rates(0.0, &y).unwrap();
        let n = system.frame().coordinates().len();
        let found = equations.inverse_dynamics();
        let missing = values(&system, &found, &y, &rates[n..]);
        let other: Vec<f64> = rates[n..].iter().map(|rate| rate + 1.0).collect();
        let taken = values(&system, &found, &y, &other);
        let size = taken.iter().fold(1.0f64, |size, force| size.max(force.abs()));
        assert!(missing.iter().all(|force| force.abs() < 1e-11 * size), "{missing:?} of {size}");
    });
}

#[test]
fn inverse_dynamics_inverts_forward_dynamics() {
    // Enough links that both go from body to body.
    trees(12, 8, |bodies, numbers| {
        let graph = Graph::new();
        let system = hung(&graph, bodies, true);
        let equations = system.poincare().unwrap();
        let y = state(bodies, numbers);
        let rates =
            equations.compile_for(CompileOptions::default().jacobian(false)).unwrap().rates(0.0, &y).unwrap();
        let n = system.frame().coordinates().len();
        let found = equations.inverse_dynamics();
        let missing = values(&system, &found, &y, &rates[n..]);
        let other: Vec<f64> = rates[n..].iter().map(|rate| rate + 1.0).collect();
        let taken = values(&system, &found, &y, &other);
        // Relative to the forces for unit accelerations.
        let size = taken.iter().fold(1.0f64, |size, force| size.max(force.abs()));
        assert!(missing.iter().all(|force| force.abs() < 1e-11 * size), "{missing:?} of {size}");
    });
}

/// τ is linear in η̇ with the matrix M, which is symmetric; it vanishes for the motion, and
/// what holds the system is τ at rest.
#[test]
fn forces_of_motions_are_linear_in_accelerations() {
    let check = |bodies: &[Hung], numbers: &[f64]| {
        let graph = Graph::new();
        let system = hung(&graph, bodies, true);
        let equations = system.poincare().unwrap();
        let y = state(bodies, numbers);
        let (n, k) = (system.frame().coordinates().len(), system.quasi_velocities().len());
        let mut dynamics = equations.inverse_dynamics_of_motion().unwrap();
        let mut mass = vec![0.0; k * k];
        dynamics.mass_matrix(0.0, &y, &mut mass).unwrap();
        let largest = mass.iter().fold(0.0f64, |largest, entry| largest.max(entry.abs()));
        for (r, s) in (0..k).flat_map(|r| (0..r).map(move |s| (r, s))) {
            assert!((mass[r * k + s] - mass[s * k + r]).abs() < 1e-13 * largest, "{mass:?}");
        }
        let (mut forces, mut bias) = (vec![0.0; k], vec![0.0; k]);
        let accelerations: Vec<f64> = numbers[..k].iter().map(|a| 3.0 * a).collect();
        dynamics.forces(0.0, &y, &accelerations, &mut forces).unwrap();
        dynamics.bias(0.0, &y, &mut bias).unwrap();
        let product = |s: usize| (0..k).map(|r| mass[r * k + s] * accelerations[r]).sum::<f64>();
        let sums: Vec<f64> = (0..k).map(|s| bias[s] + product(s)).collect();
        assert!(difference(&forces, &sums) < 1e-12, "{forces:?} {sums:?}");
        let motion = equations.compile_for(CompileOptions::default().jacobian(false));
        let rates = motion.unwrap().rates(0.0, &y).unwrap();
        dynamics.forces(0.0, &y, &rates[n..], &mut bias).unwrap();
        let size = forces.iter().fold(1.0f64, |size, force| size.max(force.abs()));
        assert!(bias.iter().all(|left| left.abs() < 1e-10 * size), "{bias:?} of {size}");
        let mut at_rest = y.clone();
        at_rest[n..].fill(0.0);
        dynamics.holding(0.0, &y, &mut forces).unwrap();
        dynamics.bias(0.0, &at_rest, &mut bias).unwrap();
        assert_eq!(forces, bias);
    };
    trees(6, 3, check);
    geared(8, 7, check);
}

#[test]
fn a_free_tree_keeps_its_momenta_and_its_energy() {
    trees(16, 5, |bodies, numbers| {
        let mut bodies = bodies.to_vec();
        // One tree, with a free base.
        for (i, body) in bodies.iter_mut().enumerate() {
            body.parent = body.parent.or(i.checked_sub(1));
        }
        bodies[0].kind = 8;
        let graph = Graph::new();
        let system = hung(&graph, &bodies, false);
        let y = state(&bodies, numbers);
        let motion = system.poincare().unwrap().compile_for(CompileOptions::default().jacobian(false));
        let rates = motion.unwrap().rates(0.0, &y).unwrap();
        let tree = tree(&graph, &bodies, false);
        let motions = tree.motions();
        let mut kept = vec![Expr::ZERO; 7];
        for body in tree.bodies() {
            let linear = motions.momentum(body.name()).unwrap();
            let angular = motions.angular_momentum(body.name()).unwrap();
            for (kept, part) in kept.iter_mut().zip(linear.into_iter().chain(angular)) {
                *kept += part;
            }
            kept[6] += motions.kinetic_energy(body.name()).unwrap();
        }
        let n = system.frame().coordinates().len();
        let x = system.frame().coordinates().iter().copied().zip(tree.velocities());
        let eta = system.quasi_velocities().iter().copied().zip(system.accelerations());
        let along: Vec<_> = x.chain(eta).collect();
        let change = values(&system, &graph.directional(&kept, &along), &y, &rates[n..]);
        // Relative to the accelerations that would change it.
        let size = rates.iter().fold(1.0f64, |size, rate| size.max(rate.abs()));
        assert!(change.iter().all(|rate| rate.abs() < ROUNDING * size), "{change:?} of {size}");
    });
}
