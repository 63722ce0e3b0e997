//! The equations of bodies that carry one another.

use pc_algebra::Matrix;
use pc_expr::Expr;

use crate::points::elimination::Elimination;
use crate::points::links::{Link, Row, links};
use crate::system::bodies::velocity::BodyVelocity;
use crate::system::system::System;
use crate::tree::spatial::{Vector, ZERO, vector};

/// Fewer quasi-velocities than this are eliminated as a whole.
const FEWEST: usize = 4;

/// M η̇ = r of a system of bodies that carry one another.
#[derive(Clone, Debug)]
pub(crate) struct PointEquations<'g> {
    pub(crate) elimination: Elimination<'g>,
    /// The acceleration of each arm relative to its hinge where all η̇ are 0.
    biases: Vec<Vec<Vector<'g>>>,
    /// The right-hand side without the inertia of the bodies.
    others: Vec<Expr<'g>>,
}

impl<'g> PointEquations<'g> {
    /// The equations of a system; none unless its bodies carry one another and whatever else has inertia belongs to
    /// one link each.
    pub(crate) fn of(system: &System<'g>) -> Option<PointEquations<'g>> {
        let (graph, eta) = (system.graph(), system.quasi_velocities());
        let others = system.bodies.others.filter(|_| may_carry(system))?;
        let kinetic = |body: &BodyVelocity<'g>| {
            body.mass * graph.dot(body.velocity.iter().copied(), body.velocity.iter().copied()) / 2.0
        };
        if graph.sum(system.bodies.list.iter().map(kinetic).chain([others])) != system.lagrangian {
            return None; // L is not that of the bodies any more
        }
        let still: Vec<_> = eta.iter().map(|&eta| (eta, Expr::ZERO)).collect();
        let mut points = Vec::new();
        for body in &system.bodies.list {
            if graph.substitute(&body.velocity, &still).iter().any(|v| !v.is_zero()) {
                return None; // it is also moved by time
            }
            let mut row = Row::new();
            for (i, slopes) in graph.jacobian(&body.velocity, eta).into_iter().enumerate() {
                slopes.into_iter().for_each(|(s, slope)| row.entry(s).or_insert(ZERO)[i] = slope);
            }
            points.push((body.mass, row));
        }
        let links = links(points, eta.len())?;
        let others = System { lagrangian: others, ..system.clone() }.equations(eta.len()).ok()?;
        let rest = others.mass_matrix();
        if !belongs_to_links(&links, rest) {
            return None;
        }
        let frame = system.frame();
        let along: Vec<_> = (frame.coordinates().iter().copied().zip(frame.velocities(eta)))
            .chain(graph.in_time(frame.time()))
            .collect();
        let bias = |own: &[usize], directions: &[Vector<'g>]| {
            let changes: Vec<Vec<Expr<'g>>> =
                directions.iter().map(|u| graph.directional(u, &along)).collect();
            vector(|i| graph.keep(graph.sum(own.iter().zip(&changes).map(|(&s, change)| change[i] * eta[s]))))
        };
        let of_link =
            |link: &Link<'g>| link.arms.iter().map(|arm| bias(&link.own, &arm.directions)).collect();
        let biases = links.iter().map(of_link).collect();
        let elimination = Elimination::of(graph, links, rest);
        Some(PointEquations { elimination, biases, others: others.right_hand_side().to_vec() })
    }

    /// η̇ = M⁻¹ r
    pub(crate) fn accelerations(&self) -> Vec<Expr<'g>> {
        self.elimination.solve(Some(&self.biases), &self.others)
    }
}

/// Whether a system has as many bodies with positions and quasi-velocities that they may be worth the search.
pub(crate) fn may_carry(system: &System<'_>) -> bool {
    system.quasi_velocities().len() >= FEWEST
        && system.tree.is_none()
        && system.bodies.others.is_some()
        && !system.bodies.list.is_empty()
}

/// Whether a mass matrix couples only quasi-velocities of one link each.
fn belongs_to_links(links: &[Link<'_>], mass: &Matrix<Expr<'_>>) -> bool {
    links
        .iter()
        .flat_map(|link| link.own.iter().map(move |&s| (s, link)))
        .all(|(s, link)| mass.nonzero(s).all(|(r, _)| link.own.contains(&r)))
}
