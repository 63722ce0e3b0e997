//! The contribution of a tree to a system.

use pc_expr::Expr;

use crate::system::bodies::velocity::BodyVelocity;
use crate::system::holds::Hold;
use crate::tree::joint::Drive;
use crate::tree::kinematics::Motions;
use crate::tree::spatial::{Vector, add, apply, apply_transpose, cross, dot};
use crate::tree::tree::Tree;

/// The terms that the bodies of a tree add to L and Q.
pub(crate) struct TreeShare<'g> {
    /// Σ ½ m |v_c|² + ½ ω·Iω (König), and ½ J η² of armatures.
    pub(crate) kinetic: Vec<Expr<'g>>,
    /// Σ m g · r_c
    pub(crate) weight: Vec<Expr<'g>>,
    /// Q_1..Q_k (8)
    pub(crate) forces: Vec<Expr<'g>>,
    pub(crate) velocities: Vec<BodyVelocity<'g>>,
}

impl<'g> Tree<'g> {
    /// −½ k (x − x_0)² of each spring, and −½ k s² of stops.
    pub(crate) fn springs(&self) -> impl Iterator<Item = Expr<'g>> {
        let energies = |(drive, x, _): (Drive<'g>, Expr<'g>, Expr<'g>)| {
            let spring = drive.spring.map(|(stiffness, rest)| stiffness * (x - rest).square() / 2.0);
            let stops = drive.stops.map(|stops| stops.energy(x));
            spring.into_iter().chain(stops).map(|energy| -energy)
        };
        self.drives().flat_map(energies)
    }

    /// The forces of dampers, stops and friction on the quasi-velocities `eta`: −(d ẋ + F sign ẋ) ∂ẋ/∂η_s.
    pub(crate) fn dampers(&self, eta: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let mut forces = vec![Expr::ZERO; eta.len()];
        for (drive, x, rate) in self.drives() {
            let stops = drive.stops.map_or(Expr::ZERO, |stops| stops.damper(x));
            let resisting = (drive.damping + stops) * rate + drive.friction * rate.sign();
            if resisting.is_zero() {
                continue;
            }
            for (force, ratio) in forces.iter_mut().zip(self.graph.gradient(rate, eta)) {
                *force -= resisting * ratio;
            }
        }
        forces
    }
}

impl<'g> Tree<'g> {
    /// What holds joints at rest: stiction, and rigid stops at both ends.
    pub(crate) fn holds(&self) -> Vec<Hold<'g>> {
        let of_drive = |(drive, x, rate): (Drive<'g>, Expr<'g>, Expr<'g>)| {
            let ratio = drive.stiction.map(|size| size / drive.friction);
            let sticks = ratio.map(|ratio| Hold::Stiction { rate, ratio });
            let stops = drive.ends.map(|[lower, upper]| {
                let way = upper - lower;
                let below = Hold::Stop { gap: x - lower, rate, way };
                [below, Hold::Stop { gap: upper - x, rate: -rate, way }]
            });
            sticks.into_iter().chain(stops.into_iter().flatten())
        };
        self.drives().flat_map(of_drive).collect()
    }
}

impl<'g> Motions<'_, 'g> {
    /// The terms for this acceleration of gravity, for the quasi-velocities `eta`.
    pub(crate) fn share(&self, gravity: &Vector<'g>, eta: &[Expr<'g>]) -> TreeShare<'g> {
        let graph = self.tree.graph;
        let (mut kinetic, mut weight, mut velocities) = (Vec::new(), Vec::new(), Vec::new());
        // F and N may depend on η: symbols represent them where the power is differentiated, Q_s = ∂(F·v + N·ω)/∂η_s.
        let (mut power, mut values) = (Vec::new(), Vec::new());
        for (body, stand) in self.tree.bodies.iter().zip(&self.tree.stands) {
            let motion = self.of_stand(stand);
            let centre = stand.point(graph, &body.centre);
            let velocity = add(&motion.velocity, &cross(&motion.omega, &centre));
            let inertia = stand.inertia(graph, body);
            let spin = apply(graph, &inertia, &motion.omega);
            kinetic.push(body.mass * dot(graph, &velocity, &velocity) / 2.0);
            kinetic.push(dot(graph, &motion.omega, &spin) / 2.0);
            let place = add(&motion.place, &apply(graph, &motion.rotation, &centre));
            weight.push(body.mass * dot(graph, gravity, &place));
            let in_world = apply(graph, &motion.rotation, &velocity);
            let torque = apply(graph, &stand.rotation, &body.torque);
            let loads = body.force.iter().zip(in_world).chain(torque.iter().zip(motion.omega));
            for (load, velocity) in loads.filter(|(load, _)| !load.is_zero()) {
                let stands_for = graph.symbol(&format!("load {} of the tree", values.len()));
                power.push(stands_for * velocity);
                values.push((stands_for, *load));
            }
            velocities.push(BodyVelocity {
                name: body.name.clone(),
                mass: body.mass,
                velocity: in_world.to_vec(),
                angular_velocity: Some(apply_transpose(graph, &stand.rotation, &motion.omega).to_vec()),
                in_lagrangian: Vec::new(),
            });
        }
        kinetic.extend(self.tree.drives().map(|(drive, _, eta)| drive.armature * eta.square() / 2.0));
        let forces = graph.substitute(&graph.gradient(graph.sum(power), eta), &values);
        TreeShare { kinetic, weight, forces, velocities }
    }
}
