//! The tree: which body is attached to which, and how it moves.

use std::collections::HashMap;
use std::ops::Range;

use pc_expr::{Expr, Graph, Number};

use crate::error::{MechError, TreeError};
use crate::tree::body::TreeBody;
use crate::tree::joint::{Drive, Joint, Kind};
use crate::tree::link::{Hinge, Link};
use crate::tree::spatial::{
    Tensor, Vector, ZERO, add, apply, congruent, entries_of, product, tensor, transpose, unit,
};

/// Bodies joined by joints: one or more trees attached to the world.
///
/// The coordinates of the tree are those of the joints, in the order in which the bodies are declared; its
/// quasi-velocities are velocities of a body relative to its parent. The velocities of a body follow from
/// those of its parent,
///
/// ω = Rᵀ ω_p + ω_joint, v = Rᵀ (v_p + ω_p × r) + v_joint,
///
/// along body axes, with R from the axes of the body to those of its parent and r the position of its origin
/// along the parent's axes.
///
/// ```
/// use pc_mech::{Graph, Joint, System, Tree, TreeBody};
///
/// // A double pendulum of two rods.
/// let graph = Graph::new();
/// let [m, l, g] = graph.symbols(["m", "l", "g"]);
/// let rod = |name, joint| TreeBody::new(name, joint).mass(m).centre([0.into(), 0.into(), -l / 2.0]);
/// let tree = Tree::new(&graph, [
///     rod("upper", Joint::revolute([0.0, 1.0, 0.0])),
///     rod("lower", Joint::revolute([0.0, 1.0, 0.0]).at([0.into(), 0.into(), -l])).on("upper"),
/// ])?;
/// let system = System::builder(&graph)
///     .coordinates(["upper", "lower"])
///     .gravity(|_| [0.into(), 0.into(), -g])
///     .tree(tree)
///     .build()?;
/// assert_eq!(system.poincare()?.mass_matrix()[(1, 1)], m * l.square() / 4.0);
/// # Ok::<(), pc_mech::MechError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Tree<'g> {
    pub(crate) graph: &'g Graph,
    pub(crate) bodies: Vec<TreeBody<'g>>,
    /// The link to which each body is fixed, and where.
    pub(crate) stands: Vec<Stand<'g>>,
    /// The links, each after its parent.
    pub(crate) links: Vec<Link<'g>>,
    /// The links of each body.
    pub(crate) own: Vec<Range<usize>>,
    /// The bodies and their parents, parents first.
    pub(crate) order: Vec<(usize, Option<usize>)>,
}

/// The maximum number of elementary joints in a tree whose equations are also derived as a whole: with more
/// joints, the equations do not fit on a page.
const MANY_LINKS: usize = 4;

/// The link to which a body is fixed, and where.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stand<'g> {
    /// The link; `None` for the world.
    pub(crate) link: Option<usize>,
    /// The origin of the body, along the axes of the link.
    pub(crate) place: Vector<'g>,
    /// The rotation from the axes of the body to those of the link.
    pub(crate) rotation: Tensor<'g>,
}

impl<'g> Tree<'g> {
    /// The tree of bodies, declared in any order.
    ///
    /// # Errors
    /// [`TreeError`] for two bodies with the same name, a parent that does not exist, parents in a circle, an
    /// axis without a direction, a list of names that does not fit its joint, or a joint without exactly one
    /// coordinate that follows another or has an armature, a spring, a damping or friction;
    /// [`BodyError`](crate::BodyError) for a matrix that is not a rotation.
    pub fn new(
        graph: &'g Graph,
        bodies: impl IntoIterator<Item = TreeBody<'g>>,
    ) -> Result<Tree<'g>, MechError> {
        let bodies: Vec<TreeBody<'g>> = bodies.into_iter().collect();
        let order = from_root_to_tip(&bodies)?;
        let (stands, links, own) = (Vec::new(), Vec::new(), Vec::new());
        let mut tree = Tree { graph, bodies, stands, links, own, order };
        let world = Stand { link: None, place: ZERO, rotation: unit() };
        let mut stands = vec![world; tree.bodies.len()];
        let mut own = vec![0..0; tree.bodies.len()];
        for (body, parent) in tree.order.clone() {
            let first = tree.links.len();
            stands[body] = tree.hang(body, parent.map_or(world, |parent| stands[parent]))?;
            own[body] = first..tree.links.len();
        }
        for body in 0..tree.bodies.len() {
            if let Some(followed) = tree.followed(body)? {
                tree.links[own[body].start].follows = Some((own[followed.body].start, followed.ratio));
            }
            let TreeBody { name, joint: Joint { kind, drive, .. }, .. } = &tree.bodies[body];
            match drive.part() {
                Some(what) if !kind.is_single() => {
                    return Err(TreeError::NoDrive { body: name.clone(), what }.into());
                }
                Some(_) => tree.links[own[body].start].armature = drive.armature,
                None => {}
            }
        }
        tree.own = own;
        tree.stands = stands;
        Ok(tree)
    }

    /// The coordinates x, joint by joint.
    pub fn coordinates(&self) -> Vec<Expr<'g>> {
        self.declared().flat_map(|link| self.links[link].coordinates()).collect()
    }

    /// The quasi-velocities η, joint by joint.
    pub fn quasi_velocities(&self) -> Vec<Expr<'g>> {
        self.declared().flat_map(|link| self.links[link].quasi_velocities()).collect()
    }

    /// The quaternions of the joints that have one; each quaternion has |q| = 1.
    pub fn quaternions(&self) -> Vec<[Expr<'g>; 4]> {
        let quaternion = |link: usize| match &self.links[link].hinge {
            Hinge::Ball { quaternion, .. } | Hinge::Free { quaternion, .. } => Some(*quaternion),
            Hinge::Turn { .. } | Hinge::Slide { .. } => None,
        };
        self.declared().filter_map(quaternion).collect()
    }

    /// The bodies, in the order of declaration.
    pub fn bodies(&self) -> &[TreeBody<'g>] {
        &self.bodies
    }

    /// The coordinates of the joint of a body; none for an unknown body, or a joint that follows another.
    pub fn joint_coordinates(&self, body: &str) -> Vec<Expr<'g>> {
        let links = self.place_of(body).map_or(0..0, |body| self.own[body].clone());
        self.links[links].iter().flat_map(Link::coordinates).collect()
    }

    /// The drives of joints with one coordinate, each with x and η of its joint.
    pub(crate) fn drives(&self) -> impl Iterator<Item = (Drive<'g>, Expr<'g>, Expr<'g>)> {
        self.bodies.iter().enumerate().filter_map(|(place, body)| {
            let (x, eta) = self.way_of(place)?;
            Some((body.joint.drive, x, eta))
        })
    }

    /// The coordinate of the joint of a body, by its index, and the velocity of this coordinate, if the joint has exactly
    /// one; of a joint that follows another, as functions of the coordinate and the velocity of that one.
    pub fn way_of(&self, body: usize) -> Option<(Expr<'g>, Expr<'g>)> {
        let own = self.own.get(body).filter(|own| own.len() == 1)?;
        self.links.get(own.start)?.hinge.single()
    }

    /// The index of a body in the order of declaration.
    pub(crate) fn place_of(&self, body: &str) -> Option<usize> {
        self.bodies.iter().position(|known| known.name == body)
    }

    /// The links, in the order in which the bodies to which they belong are declared.
    pub(crate) fn declared(&self) -> impl Iterator<Item = usize> {
        self.own.iter().cloned().flatten()
    }

    /// Adds the links of a body. Returns the link to which the body is fixed, and where.
    fn hang(&mut self, body: usize, parent: Stand<'g>) -> Result<Stand<'g>, MechError> {
        let graph = self.graph;
        let TreeBody { name, joint: Joint { kind, place, rotation, .. }, .. } = &self.bodies[body];
        let (coordinates, velocities) = self.moved_by(body)?;
        let (mut x, mut eta) = (coordinates.into_iter(), velocities.into_iter());
        let mut x = || x.next().unwrap_or(Expr::ZERO); // the kind determines their number
        let mut eta = || eta.next().unwrap_or(Expr::ZERO);
        // The position of the joint on the link of the parent.
        let place = add(&parent.place, &apply(graph, &parent.rotation, place));
        let rotation = product(graph, &parent.rotation, rotation);
        let align = |axis: &[f64; 3]| {
            aligned(*axis).ok_or_else(|| TreeError::NoDirection { body: name.clone(), axis: *axis })
        };
        let turned = |matrix: &Tensor<'g>| product(graph, &rotation, matrix);
        let kind = kind.clone();
        let mut stand = Stand { link: parent.link, place, rotation };
        // Adds the next elementary movement after the last one.
        let mut links = Vec::new();
        let first = self.links.len();
        let mut push = |rotation: Tensor<'g>, hinge: Hinge<'g>| {
            let on =
                if links.is_empty() { (parent.link, place) } else { (Some(first + links.len() - 1), ZERO) };
            links.push(Link {
                parent: on.0,
                place: on.1,
                rotation,
                hinge,
                follows: None,
                armature: Expr::ZERO,
            });
            stand = Stand { link: Some(first + links.len() - 1), place: ZERO, rotation: unit() };
        };
        let mut matrix = unit();
        match kind {
            Kind::Fixed => {}
            Kind::Revolute(direction) => {
                let axis;
                (axis, matrix) = align(&direction)?;
                push(turned(&matrix), Hinge::Turn { axis, pitch: Expr::ZERO, angle: x(), rate: eta() });
            }
            Kind::Screw(direction, pitch) => {
                let axis;
                (axis, matrix) = align(&direction)?;
                push(turned(&matrix), Hinge::Turn { axis, pitch, angle: x(), rate: eta() });
            }
            Kind::Prismatic(direction) => {
                let axis;
                (axis, matrix) = align(&direction)?;
                push(turned(&matrix), Hinge::Slide { axis, way: x(), rate: eta() });
            }
            Kind::Cylindrical(direction) => {
                let axis;
                (axis, matrix) = align(&direction)?;
                push(turned(&matrix), Hinge::Slide { axis, way: x(), rate: eta() });
                push(unit(), Hinge::Turn { axis, pitch: Expr::ZERO, angle: x(), rate: eta() });
            }
            Kind::Planar(normal) => {
                let axis;
                (axis, matrix) = align(&normal)?;
                for side in [1, 2] {
                    let rotation = if side == 1 { turned(&matrix) } else { unit() };
                    push(rotation, Hinge::Slide { axis: (axis + side) % 3, way: x(), rate: eta() });
                }
                push(unit(), Hinge::Turn { axis, pitch: Expr::ZERO, angle: x(), rate: eta() });
            }
            Kind::Universal(first, second) => {
                let (outer, to_joint) = align(&first)?;
                // The second axis along the axes of the first link.
                let carried = numbers(&apply(graph, &transpose(&to_joint), &second.map(Expr::from)));
                let (inner, to_outer) = align(&carried)?;
                push(
                    turned(&to_joint),
                    Hinge::Turn { axis: outer, pitch: Expr::ZERO, angle: x(), rate: eta() },
                );
                push(to_outer, Hinge::Turn { axis: inner, pitch: Expr::ZERO, angle: x(), rate: eta() });
                matrix = product(graph, &to_joint, &to_outer);
            }
            Kind::Spherical => {
                let quaternion = [x(), x(), x(), x()];
                push(rotation, Hinge::Ball { quaternion, omega: [eta(), eta(), eta()] });
            }
            Kind::Free => {
                let (way, quaternion) = ([x(), x(), x()], [x(), x(), x(), x()]);
                let (v, omega) = ([eta(), eta(), eta()], [eta(), eta(), eta()]);
                push(rotation, Hinge::Free { way, quaternion, v, omega });
            }
        }
        if !links.is_empty() {
            stand.rotation = transpose(&matrix);
        }
        self.links.extend(links);
        Ok(stand)
    }

    /// Whether the tree has too many quasi-velocities for its mass matrix to be written out as a whole.
    pub(crate) fn is_large(&self) -> bool {
        self.links.len() > MANY_LINKS
    }

    /// The tree with `put` applied to each expression, in another graph.
    pub(crate) fn map<'n>(&self, graph: &'n Graph, put: &impl Fn(Expr<'g>) -> Expr<'n>) -> Tree<'n> {
        let stand = |stand: &Stand<'g>| Stand {
            link: stand.link,
            place: stand.place.map(put),
            rotation: stand.rotation.map(|row| row.map(put)),
        };
        Tree {
            graph,
            bodies: self.bodies.iter().map(|body| body.map(put)).collect(),
            stands: self.stands.iter().map(stand).collect(),
            links: self.links.iter().map(|link| link.map(put)).collect(),
            own: self.own.clone(),
            order: self.order.clone(),
        }
    }

    /// What takes the place of x and η in the joint of a body: symbols, or multiples of those that it follows.
    fn moved_by(&self, body: usize) -> Result<(Vec<Expr<'g>>, Vec<Expr<'g>>), TreeError> {
        let symbols = |names: Vec<String>| -> Vec<Expr<'g>> {
            names.iter().map(|name| self.graph.symbol(name)).collect()
        };
        let (coordinates, velocities) = self.names(body)?;
        let Some(Followed { body, ratio, offset }) = self.followed(body)? else {
            return Ok((symbols(coordinates), symbols(velocities)));
        };
        let (coordinates, velocities) = self.names(body)?;
        let geared = |x: Expr<'g>| ratio * x;
        let coordinates = symbols(coordinates).into_iter().map(|x| geared(x) + offset).collect();
        Ok((coordinates, symbols(velocities).into_iter().map(geared).collect()))
    }

    /// The joint that moves the joint of a body, by way of any number of others that follow it too; none for a
    /// joint that moves by itself.
    fn followed(&self, body: usize) -> Result<Option<Followed<'g>>, TreeError> {
        let (mut ratio, mut offset) = (Expr::ONE, Expr::ZERO);
        let mut line = vec![body];
        loop {
            let last = &self.bodies[line[line.len() - 1]];
            let Some(follows) = &last.joint.follows else { break };
            let unknown =
                || TreeError::NoFollowed { body: last.name.clone(), followed: follows.body.clone() };
            let next = self.place_of(&follows.body).ok_or_else(unknown)?;
            if !(last.joint.kind.is_single() && self.bodies[next].joint.kind.is_single()) {
                let (body, followed) = (last.name.clone(), follows.body.clone());
                return Err(TreeError::NotSingle { body, followed });
            }
            offset += ratio * follows.offset;
            ratio *= follows.ratio;
            line.push(next);
            if let Some(first) = line[..line.len() - 1].iter().position(|&known| known == next) {
                let bodies = line[first..].iter().map(|&body| self.bodies[body].name.clone()).collect();
                return Err(TreeError::FollowedCircle { bodies });
            }
        }
        let body = line[line.len() - 1];
        Ok((line.len() > 1).then_some(Followed { body, ratio, offset }))
    }

    fn names(&self, body: usize) -> Result<(Vec<String>, Vec<String>), TreeError> {
        let TreeBody { name, joint, .. } = &self.bodies[body];
        let (coordinates, velocities) = joint.names_for(name);
        let rule = Joint { names: None, ..joint.clone() }.names_for(name);
        for (what, found, expected) in [
            ("coordinates", coordinates.len(), rule.0.len()),
            ("quasi-velocities", velocities.len(), rule.1.len()),
        ] {
            if found != expected {
                return Err(TreeError::Names { body: name.clone(), what, found, expected });
            }
        }
        Ok((coordinates, velocities))
    }

    /// Whether masses and inertias are nonnegative numbers.
    pub(crate) fn is_definite(&self) -> bool {
        self.is_nowhere_negative(&[])
    }

    /// Whether, at these values of the parameters, no body has a negative mass, or a negative moment of
    /// inertia about any axis through its mass centre: then no motion has a negative kinetic energy.
    pub fn is_nowhere_negative(&self, parameters: &[(Expr<'g>, f64)]) -> bool {
        let numbers =
            |body: &TreeBody<'g>| [vec![body.mass], entries_of(&body.inertia.matrix()).concat()].concat();
        let all: Vec<Expr<'g>> = self.bodies.iter().flat_map(numbers).collect();
        let Ok(values) = self.graph.evaluate(&all, parameters) else { return false };
        values.chunks_exact(10).all(|body| {
            let i = |p: usize, q: usize| body[1 + 3 * p + q];
            let minor = |p: usize, q: usize| i(p, p) * i(q, q) - i(p, q) * i(p, q);
            let cofactor = |q: usize, r: usize| i(1, q) * i(2, r) - i(1, r) * i(2, q);
            let determinant = i(0, 0) * cofactor(1, 2) - i(0, 1) * cofactor(0, 2) + i(0, 2) * cofactor(0, 1);
            let minors = [i(0, 0), i(1, 1), i(2, 2), minor(0, 1), minor(1, 2), minor(0, 2), determinant];
            body[0] >= 0.0 && minors.iter().all(|&minor| minor >= 0.0)
        })
    }

    /// The mass, the first moment and the inertia about the origin of the link of all bodies fixed to it, along
    /// its axes.
    pub(crate) fn mass_on(&self, link: usize) -> MassOnLink<'g> {
        let mut on_link = MassOnLink { mass: Expr::ZERO, moment: ZERO, inertia: [ZERO; 3] };
        let bodies = self.bodies.iter().zip(&self.stands).filter(|(_, stand)| stand.link == Some(link));
        bodies.for_each(|(body, stand)| on_link.add(&self.mass_of(body, stand)));
        on_link
    }

    /// The mass, the first moment and the inertia of a body about the origin of its link, along the axes of the link.
    pub(crate) fn mass_of(&self, body: &TreeBody<'g>, stand: &Stand<'g>) -> MassOnLink<'g> {
        let graph = self.graph;
        let centre = stand.point(graph, &body.centre);
        let inertia = stand.inertia(graph, body);
        let moment = centre.map(|c| body.mass * c);
        let square = graph.dot(moment.iter().copied(), centre.iter().copied());
        let about_origin = |i: usize, j: usize| {
            let diagonal = if i == j { square } else { Expr::ZERO };
            inertia[i][j] + diagonal - moment[i] * centre[j]
        };
        MassOnLink { mass: body.mass, moment, inertia: tensor(about_origin) }
    }
}

/// The body whose joint moves another joint: x = ratio · x of the body + offset.
struct Followed<'g> {
    body: usize,
    ratio: Expr<'g>,
    offset: Expr<'g>,
}

/// The mass m, the first moment m c and the inertia about the origin of a link.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MassOnLink<'g> {
    pub(crate) mass: Expr<'g>,
    pub(crate) moment: Vector<'g>,
    pub(crate) inertia: Tensor<'g>,
}

impl<'g> Stand<'g> {
    /// The position of a point of a body, along the axes of the link.
    pub(crate) fn point(&self, graph: &'g Graph, point: &Vector<'g>) -> Vector<'g> {
        add(&self.place, &apply(graph, &self.rotation, point))
    }

    /// The inertia of a body about its mass centre, along the axes of the link.
    pub(crate) fn inertia(&self, graph: &'g Graph, body: &TreeBody<'g>) -> Tensor<'g> {
        congruent(graph, &self.rotation, &entries_of(&body.inertia.matrix()))
    }
}

/// The indices of the bodies and of their parents, parents first.
fn from_root_to_tip(bodies: &[TreeBody<'_>]) -> Result<Vec<(usize, Option<usize>)>, TreeError> {
    let mut places = HashMap::new();
    for (place, body) in bodies.iter().enumerate() {
        if places.insert(body.name.as_str(), place).is_some() {
            return Err(TreeError::TwoBodies { body: body.name.clone() });
        }
    }
    let mut parents = Vec::with_capacity(bodies.len());
    for body in bodies {
        let unknown =
            |parent: &String| TreeError::NoParent { body: body.name.clone(), parent: parent.clone() };
        let parent = body.parent.as_ref();
        parents.push(
            parent
                .map(|parent| places.get(parent.as_str()).copied().ok_or_else(|| unknown(parent)))
                .transpose()?,
        );
    }
    let mut order = Vec::with_capacity(bodies.len());
    let mut hung = vec![false; bodies.len()];
    for body in 0..bodies.len() {
        // The body and those of its ancestors that are not yet in the list.
        let mut line = vec![body];
        while let Some(parent) = parents[line[line.len() - 1]].filter(|&parent| !hung[parent]) {
            if line.contains(&parent) {
                let circle = line.iter().map(|&body| bodies[body].name.clone()).collect();
                return Err(TreeError::Circle { bodies: circle });
            }
            line.push(parent);
        }
        for body in line
            .into_iter()
            .rev()
            .filter(|&body| !std::mem::replace(&mut hung[body], true))
            .collect::<Vec<_>>()
        {
            order.push((body, parents[body]));
        }
    }
    Ok(order)
}

/// The index of a coordinate axis, and the rotation that takes this axis to a direction.
fn aligned<'g>(direction: [f64; 3]) -> Option<(usize, Tensor<'g>)> {
    let length = direction.iter().fold(0.0f64, |length, c| length.hypot(*c));
    if !(length.is_normal()) {
        return None;
    }
    let along = |axis: usize| (0..3).all(|i| (direction[i] != 0.0) == (i == axis));
    if let Some(axis) = (0..3).find(|&axis| along(axis)) {
        // Opposite direction: half a turn about the next axis but one.
        let backwards = direction[axis] < 0.0;
        let sign = |i: usize| if backwards && i != (axis + 2) % 3 { -1 } else { 1 };
        return Some((
            axis,
            std::array::from_fn(|i| {
                std::array::from_fn(|j| if i == j { sign(i).into() } else { Expr::ZERO })
            }),
        ));
    }
    let n = direction.map(|c| c / length);
    // Orthogonal to the direction and to the axis farthest from it.
    let far = (0..3).min_by(|&i, &j| n[i].abs().total_cmp(&n[j].abs()))?;
    let mut e = [0.0; 3];
    e[far] = 1.0;
    let across = |a: [f64; 3], b: [f64; 3]| -> [f64; 3] {
        std::array::from_fn(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3])
    };
    let u = across(e, n);
    let length = u.iter().fold(0.0f64, |length, c| length.hypot(*c));
    let u = u.map(|c| c / length);
    let v = across(n, u);
    Some((2, std::array::from_fn(|i| [u[i].into(), v[i].into(), n[i].into()])))
}

/// The components of a vector as numbers.
fn numbers(v: &Vector<'_>) -> [f64; 3] {
    v.map(|component| component.constant().map_or(f64::NAN, Number::to_f64))
}
