//! The motion of bodies, computed recursively from each body to those attached to it.

use pc_algebra::{LieGroup, Matrix, Side, UnitQuaternions};
use pc_expr::{Expr, Graph};

use crate::tree::link::{Hinge, Link};
use crate::tree::spatial::{
    Tensor, Vector, ZERO, add, apply, apply_transpose, cross, dot, entries_of, matrix_of, product, scaled,
    tensor, transpose, unit, vector,
};
use crate::tree::tree::{Stand, Tree};

/// The motion of a link: its position and axes in the world, and its velocities along its own axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LinkMotion<'g> {
    /// The position of its origin.
    pub(crate) place: Vector<'g>,
    /// The rotation from its axes to those of the world.
    pub(crate) rotation: Tensor<'g>,
    /// Velocity of its origin.
    pub(crate) velocity: Vector<'g>,
    pub(crate) omega: Vector<'g>,
}

impl<'g> LinkMotion<'g> {
    /// The same motion with each quantity kept as a separate step of the recursion.
    fn kept(&self, graph: &'g Graph) -> LinkMotion<'g> {
        let keep = |v: &Vector<'g>| v.map(|component| graph.keep(component));
        LinkMotion {
            place: keep(&self.place),
            rotation: self.rotation.map(|row| keep(&row)),
            velocity: keep(&self.velocity),
            omega: keep(&self.omega),
        }
    }
}

const AT_REST: fn() -> LinkMotion<'static> =
    || LinkMotion { place: ZERO, rotation: unit(), velocity: ZERO, omega: ZERO };

/// The motions of the bodies of a tree.
#[derive(Clone, Debug)]
pub struct Motions<'a, 'g> {
    pub(crate) tree: &'a Tree<'g>,
    pub(crate) links: Vec<LinkMotion<'g>>,
}

impl<'a, 'g> Motions<'a, 'g> {
    pub(crate) fn of(tree: &'a Tree<'g>) -> Motions<'a, 'g> {
        let graph = tree.graph;
        let mut links: Vec<LinkMotion<'g>> = Vec::with_capacity(tree.links.len());
        for link in &tree.links {
            let parent = link.parent.map_or_else(AT_REST, |parent| links[parent]);
            let motion = link.motion(graph, &parent);
            links.push(if tree.is_large() { motion.kept(graph) } else { motion });
        }
        Motions { tree, links }
    }

    pub(crate) fn of_body(&self, name: &str) -> Option<(LinkMotion<'g>, Stand<'g>)> {
        let body = self.tree.place_of(name)?;
        let stand = self.tree.stands[body];
        Some((self.of_stand(&stand), stand))
    }

    pub(crate) fn of_stand(&self, stand: &Stand<'g>) -> LinkMotion<'g> {
        stand.link.map_or_else(AT_REST, |link| self.links[link])
    }

    /// The velocity of the origin of a body, along the axes of the body.
    pub fn velocity(&self, body: &str) -> Option<[Expr<'g>; 3]> {
        let graph = self.tree.graph;
        self.of_body(body).map(|(motion, stand)| {
            let velocity = add(&motion.velocity, &cross(&motion.omega, &stand.place));
            apply_transpose(graph, &stand.rotation, &velocity)
        })
    }

    /// The angular velocity of a body, along the axes of the body.
    pub fn angular_velocity(&self, body: &str) -> Option<[Expr<'g>; 3]> {
        let graph = self.tree.graph;
        self.of_body(body).map(|(motion, stand)| apply_transpose(graph, &stand.rotation, &motion.omega))
    }
}

/// The motion of a body relative to its parent.
#[derive(Clone, Debug)]
pub struct JointMotion<'g> {
    /// The 3 × 3 matrix from the axes of the body to those of its parent.
    pub rotation: Matrix<Expr<'g>>,
    /// The position of the origin of the body, along the axes of its parent from the parent's origin.
    pub place: [Expr<'g>; 3],
    /// The angular velocity of the body relative to its parent, along the axes of the body.
    pub angular_velocity: [Expr<'g>; 3],
    /// The velocity of the origin of the body relative to its parent, along the axes of the body.
    pub velocity: [Expr<'g>; 3],
    /// The quasi-velocities of the joint; none for a joint that follows another.
    pub quasi_velocities: Vec<Expr<'g>>,
    /// The armature of the joint, an inertia that resists the quasi-velocity by which it moves.
    pub armature: Expr<'g>,
}

impl<'g> Tree<'g> {
    /// The velocities ẋ in terms of η (3).
    pub fn velocities(&self) -> Vec<Expr<'g>> {
        let own = |link: &usize| self.links[*link].follows.is_none();
        self.declared().filter(own).flat_map(|link| rates(self.graph, &self.links[link].hinge)).collect()
    }

    /// The motions of all bodies, as expressions in x and η.
    pub fn motions(&self) -> Motions<'_, 'g> {
        Motions::of(self)
    }

    /// The motion of a body relative to its parent, or to the world.
    pub fn joint_motion(&self, body: &str) -> Option<JointMotion<'g>> {
        let (graph, i) = (self.graph, self.place_of(body)?);
        let world = Stand { link: None, place: ZERO, rotation: unit() };
        let parent = self.bodies[i].parent.as_ref().and_then(|parent| self.place_of(parent));
        let parent = parent.map_or(world, |parent| self.stands[parent]);
        let mut moved = AT_REST();
        for link in &self.links[self.own[i].clone()] {
            moved = link.motion(graph, &moved);
        }
        let stand = &self.stands[i];
        let place = add(&moved.place, &apply(graph, &moved.rotation, &stand.place));
        let from_parent = vector(|c| place[c] - parent.place[c]);
        let rotation =
            product(graph, &product(graph, &transpose(&parent.rotation), &moved.rotation), &stand.rotation);
        let links = &self.links[self.own[i].clone()];
        Some(JointMotion {
            rotation: matrix_of(&rotation),
            place: apply_transpose(graph, &parent.rotation, &from_parent),
            angular_velocity: apply_transpose(graph, &stand.rotation, &moved.omega),
            velocity: apply_transpose(graph, &stand.rotation, &moved.velocity),
            quasi_velocities: links.iter().flat_map(Link::quasi_velocities).collect(),
            armature: graph.sum(links.iter().map(|link| {
                let ratio = link.follows.map_or(Expr::ONE, |(_, ratio)| ratio);
                link.armature * ratio.square()
            })),
        })
    }
}

impl<'g> Motions<'_, 'g> {
    /// The position of the origin of a body, along the axes of the world.
    pub fn place(&self, body: &str) -> Option<[Expr<'g>; 3]> {
        self.of_body(body).map(|(motion, stand)| {
            add(&motion.place, &apply(self.tree.graph, &motion.rotation, &stand.place))
        })
    }

    /// The 3 × 3 matrix from the axes of a body to those of the world.
    pub fn rotation(&self, body: &str) -> Option<Matrix<Expr<'g>>> {
        self.of_body(body)
            .map(|(motion, stand)| matrix_of(&product(self.tree.graph, &motion.rotation, &stand.rotation)))
    }

    /// The velocity of a point of a body, along the axes of the world; the point is given along the axes of the body,
    /// from its origin.
    pub fn velocity_of_point(&self, body: &str, point: &[Expr<'g>; 3]) -> Option<[Expr<'g>; 3]> {
        let graph = self.tree.graph;
        self.of_body(body).map(|(motion, stand)| {
            let velocity = add(&motion.velocity, &cross(&motion.omega, &stand.point(graph, point)));
            apply(graph, &motion.rotation, &velocity)
        })
    }

    /// The angular velocity of a body, along the axes of the world.
    pub fn angular_velocity_in_world(&self, body: &str) -> Option<[Expr<'g>; 3]> {
        let graph = self.tree.graph;
        self.of_body(body).map(|(motion, _)| apply(graph, &motion.rotation, &motion.omega))
    }

    /// The motion of the link of a body, the position of the mass centre on the link, and the velocity of the
    /// mass centre along the axes of the link.
    fn centre(&self, body: usize) -> (LinkMotion<'g>, Vector<'g>, Vector<'g>) {
        let (graph, stand) = (self.tree.graph, &self.tree.stands[body]);
        let motion = self.of_stand(stand);
        let centre = stand.point(graph, &self.tree.bodies[body].centre);
        let velocity = add(&motion.velocity, &cross(&motion.omega, &centre));
        (motion, centre, velocity)
    }

    /// ½ m |v_c|² + ½ ω·Iω of a body.
    pub fn kinetic_energy(&self, body: &str) -> Option<Expr<'g>> {
        let (graph, i) = (self.tree.graph, self.tree.place_of(body)?);
        let (motion, _, velocity) = self.centre(i);
        let spin = apply(graph, &self.tree.stands[i].inertia(graph, &self.tree.bodies[i]), &motion.omega);
        let moving = self.tree.bodies[i].mass * dot(graph, &velocity, &velocity);
        Some((moving + dot(graph, &motion.omega, &spin)) / 2.0)
    }

    /// The momentum m v_c of a body, along the axes of the world.
    pub fn momentum(&self, body: &str) -> Option<[Expr<'g>; 3]> {
        let i = self.tree.place_of(body)?;
        let (motion, _, velocity) = self.centre(i);
        Some(scaled(self.tree.bodies[i].mass, &apply(self.tree.graph, &motion.rotation, &velocity)))
    }

    /// The position of the mass centre of a body, along the axes of the world.
    pub fn mass_centre(&self, body: &str) -> Option<[Expr<'g>; 3]> {
        let (motion, centre, _) = self.centre(self.tree.place_of(body)?);
        Some(add(&motion.place, &apply(self.tree.graph, &motion.rotation, &centre)))
    }

    /// The angular momentum I ω of a body about its mass centre, along the axes of the world.
    pub fn spin(&self, body: &str) -> Option<[Expr<'g>; 3]> {
        let (graph, i) = (self.tree.graph, self.tree.place_of(body)?);
        let motion = self.of_stand(&self.tree.stands[i]);
        let spin = apply(graph, &self.tree.stands[i].inertia(graph, &self.tree.bodies[i]), &motion.omega);
        Some(apply(graph, &motion.rotation, &spin))
    }

    /// The angular momentum r_c × m v_c + I ω of a body about the origin of the world, along the axes of the
    /// world.
    pub fn angular_momentum(&self, body: &str) -> Option<[Expr<'g>; 3]> {
        let (place, momentum) = (self.mass_centre(body)?, self.momentum(body)?);
        Some(add(&cross(&place, &momentum), &self.spin(body)?))
    }

    /// The centre of mass Σ m r_c/Σ m of all bodies, along the axes of the world.
    pub fn centre_of_mass(&self) -> [Expr<'g>; 3] {
        let graph = self.tree.graph;
        let masses = graph.sum(self.tree.bodies.iter().map(|body| body.mass));
        let places: Vec<Vector<'g>> = (0..self.tree.bodies.len())
            .map(|i| {
                let (motion, centre, _) = self.centre(i);
                let place = add(&motion.place, &apply(graph, &motion.rotation, &centre));
                scaled(self.tree.bodies[i].mass, &place)
            })
            .collect();
        vector(|c| graph.sum(places.iter().map(|place| place[c])) / masses)
    }
}

impl<'g> Link<'g> {
    /// The matrix from the axes of the link to those of its parent.
    pub(crate) fn to_parent(&self, graph: &'g Graph) -> Tensor<'g> {
        product(graph, &self.rotation, &self.hinge.turning())
    }

    /// The position of the origin of the link, along the axes of its parent.
    pub(crate) fn origin(&self, graph: &'g Graph) -> Vector<'g> {
        add(&self.place, &apply(graph, &self.rotation, &self.hinge.displacement()))
    }

    fn motion(&self, graph: &'g Graph, parent: &LinkMotion<'g>) -> LinkMotion<'g> {
        let (to_parent, origin) = (self.to_parent(graph), self.origin(graph));
        let carried = add(&parent.velocity, &cross(&parent.omega, &origin));
        LinkMotion {
            place: add(&parent.place, &apply(graph, &parent.rotation, &origin)),
            rotation: product(graph, &parent.rotation, &to_parent),
            velocity: add(&apply_transpose(graph, &to_parent, &carried), &self.hinge.velocity()),
            omega: add(&apply_transpose(graph, &to_parent, &parent.omega), &self.hinge.omega()),
        }
    }
}

impl<'g> Hinge<'g> {
    /// The matrix from the axes of the link to those of the joint; for a quaternion it is |q|² times a
    /// rotation.
    pub(crate) fn turning(&self) -> Tensor<'g> {
        match self {
            Hinge::Turn { axis, angle, .. } => plane_rotation(*axis, angle.cos(), angle.sin()),
            Hinge::Slide { .. } => unit(),
            Hinge::Ball { quaternion, .. } | Hinge::Free { quaternion, .. } => {
                entries_of(&UnitQuaternions.rotation_matrix(quaternion))
            }
        }
    }

    /// The position of the origin of the link, along the axes of the joint.
    pub(crate) fn displacement(&self) -> Vector<'g> {
        match self {
            Hinge::Turn { axis, pitch, angle, .. } => along(*axis, *pitch * *angle),
            Hinge::Slide { axis, way, .. } => along(*axis, *way),
            Hinge::Ball { .. } => ZERO,
            Hinge::Free { way, .. } => *way,
        }
    }

    /// The velocity of the origin of the link relative to the parent, along the axes of the link.
    pub(crate) fn velocity(&self) -> Vector<'g> {
        match self {
            Hinge::Turn { axis, pitch, rate, .. } => along(*axis, *pitch * *rate),
            Hinge::Slide { axis, rate, .. } => along(*axis, *rate),
            Hinge::Ball { .. } => ZERO,
            Hinge::Free { v, .. } => *v,
        }
    }

    /// The angular velocity of the link relative to the parent, along the axes of the link.
    pub(crate) fn omega(&self) -> Vector<'g> {
        match self {
            Hinge::Turn { axis, rate, .. } => along(*axis, *rate),
            Hinge::Slide { .. } => ZERO,
            Hinge::Ball { omega, .. } | Hinge::Free { omega, .. } => *omega,
        }
    }
}

/// The rates ẋ of the coordinates of a hinge in terms of η.
pub(crate) fn rates<'g>(graph: &'g Graph, hinge: &Hinge<'g>) -> Vec<Expr<'g>> {
    let turning = |quaternion: &[Expr<'g>; 4], omega: &Vector<'g>| -> Vec<Expr<'g>> {
        let operators = UnitQuaternions.operators(Side::Left, quaternion);
        (0..4).map(|i| graph.dot(operators.row(i).iter().copied(), omega.iter().copied())).collect()
    };
    match hinge {
        Hinge::Turn { rate, .. } | Hinge::Slide { rate, .. } => vec![*rate],
        Hinge::Ball { quaternion, omega } => turning(quaternion, omega),
        Hinge::Free { quaternion, v, omega, .. } => {
            let way = apply(graph, &hinge.turning(), v);
            way.into_iter().chain(turning(quaternion, omega)).collect()
        }
    }
}

/// The matrix of a rotation about a coordinate axis by an angle with this cosine and sine.
fn plane_rotation<'g>(axis: usize, cos: Expr<'g>, sin: Expr<'g>) -> Tensor<'g> {
    let (p, q) = ((axis + 1) % 3, (axis + 2) % 3);
    tensor(|i, j| match (i, j) {
        _ if i == axis || j == axis => {
            if i == j {
                Expr::ONE
            } else {
                Expr::ZERO
            }
        }
        (i, j) if i == j => cos,
        (i, j) if (i, j) == (p, q) => -sin,
        _ => sin,
    })
}

/// A vector of this length along a coordinate axis.
pub(crate) fn along<'g>(axis: usize, length: Expr<'g>) -> Vector<'g> {
    scaled(length, &vector(|i| if i == axis { Expr::ONE } else { Expr::ZERO }))
}
