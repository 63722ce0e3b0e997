//! Articulated inertias: the inertia of a subtree after the joints beyond a link have been eliminated, from the
//! tips to the root.
//!
//! Forces on a link and its accelerations, six components each, are related by
//!
//!   n = J α + H a + n_0,   f = Hᵀ α + M a + f_0,
//!
//! with the moment n about the origin of the link and the acceleration a of this origin. A free component c of
//! a joint, with the force τ, is eliminated like a row of a symmetric matrix Φ = (J H; Hᵀ M): w_c = (τ − p_c −
//! Σ_{r≠c} Φ_cr A_r)/Φ_cc, Φ ← Φ − Φ_c Φ_cᵀ/Φ_cc, p ← p + Φ_c (τ − p_c)/Φ_cc.
//!
//! This is the elimination M = Lᵀ D L of the mass matrix of the whole tree, in an order that produces no fill-in
//! (Featherstone 1983; Rodriguez 1987).

use pc_expr::{Expr, Graph, Number};

use crate::tree::link::{Hinge, Link};
use crate::tree::spatial::{Tensor, Vector, ZERO, cross, tensor, transpose, vector};
use crate::tree::tree::MassOnLink;
use crate::tree::turning::Turning;

/// Six components: rotation, then displacement; or moment, then force.
pub(crate) type Spatial<'g> = [Expr<'g>; 6];

pub(crate) fn joined<'g>(turning: &Vector<'g>, moving: &Vector<'g>) -> Spatial<'g> {
    std::array::from_fn(|i| if i < 3 { turning[i] } else { moving[i - 3] })
}

pub(crate) fn turning_part<'g>(a: &Spatial<'g>) -> Vector<'g> {
    vector(|i| a[i])
}

pub(crate) fn moving_part<'g>(a: &Spatial<'g>) -> Vector<'g> {
    vector(|i| a[i + 3])
}

/// A symmetric matrix with six rows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Inertia6<'g>([[Expr<'g>; 6]; 6]);

impl<'g> Inertia6<'g> {
    /// The inertia of a body with this mass.
    pub(crate) fn rigid(body: &MassOnLink<'g>) -> Inertia6<'g> {
        let h = skew(&body.moment);
        Inertia6::of(&body.inertia, &h, &tensor(|i, j| if i == j { body.mass } else { Expr::ZERO }))
    }

    fn of(j: &Tensor<'g>, h: &Tensor<'g>, m: &Tensor<'g>) -> Inertia6<'g> {
        let entry = |r: usize, c: usize| match (r < 3, c < 3) {
            (true, true) => j[r][c],
            (true, false) => h[r][c - 3],
            (false, true) => h[c][r - 3],
            (false, false) => m[r - 3][c - 3],
        };
        Inertia6(std::array::from_fn(|r| std::array::from_fn(|c| entry(r, c))))
    }

    pub(crate) fn plus(&self, other: &Inertia6<'g>, graph: &'g Graph) -> Inertia6<'g> {
        self.map(|r, c, entry| graph.keep(entry + other.0[r][c]))
    }

    /// The symmetric matrix with `put` applied to each entry on and below the diagonal.
    fn map(&self, put: impl Fn(usize, usize, Expr<'g>) -> Expr<'g>) -> Inertia6<'g> {
        let mut mapped = *self;
        for r in 0..6 {
            for c in 0..=r {
                mapped.0[r][c] = put(r, c, self.0[r][c]);
                mapped.0[c][r] = mapped.0[r][c];
            }
        }
        mapped
    }

    /// The inertia of a single body that remains after elimination, if its resistance to the direction is a
    /// number that is not a rounding error of `size`. The pivot of the joint is then at least as large: the
    /// inertia of the bodies beyond it is nonnegative, and the remainder of a sum is at least the sum of the
    /// remainders.
    fn resisting(&self, graph: &'g Graph, direction: Direction<'g>, size: Expr<'g>) -> Option<Inertia6<'g>> {
        let column = direction.column(graph, self);
        let number = |x: Expr<'g>| x.constant().map(Number::to_f64);
        let (pivot, size) = (number(direction.along(&column))?, number(size)?);
        (pivot > ROUNDING * size).then(|| self.map(|r, c, entry| entry - column[r] * column[c] / pivot))
    }

    fn blocks(&self) -> (Tensor<'g>, Tensor<'g>, Tensor<'g>) {
        (tensor(|i, j| self.0[i][j]), tensor(|i, j| self.0[i][j + 3]), tensor(|i, j| self.0[i + 3][j + 3]))
    }

    /// The inertia seen from the parent: rotated to the parent's axes, then taken about the parent's origin;
    /// the origin of the link is at `place` relative to the parent's origin.
    ///
    ///   G = Hᵀ − M r̂,   J ← J − H r̂ + r̂ G,   H ← Gᵀ
    fn seen(&self, graph: &'g Graph, turning: &Turning<'g>, place: &Vector<'g>) -> Inertia6<'g> {
        let (j, h, m) = self.blocks();
        let turned = |block: &Tensor<'g>| turning.matrix_to_parent(graph, block);
        let (j, h, m) = (turned(&j), turned(&h), turned(&m));
        let keep = |x: Expr<'g>| graph.keep(x);
        // In symmetric blocks the entries below the diagonal are those above.
        let symmetric = |a: Tensor<'g>| tensor(|i, k| if i <= k { a[i][k] } else { a[k][i] });
        let (j, m) = (symmetric(j), symmetric(m));
        // a r̂, row by row: r × over the columns
        let times_skew = |a: &Tensor<'g>| a.map(|row| cross(&row, place));
        let mr = times_skew(&m);
        let g = tensor(|i, k| keep(h[k][i] - mr[i][k]));
        let (hr, g_columns) = (times_skew(&h), transpose(&g));
        let rg = transpose(&g_columns.map(|column| cross(place, &column)));
        let moved =
            symmetric(tensor(
                |i, k| if i <= k { keep(keep(j[i][k] - hr[i][k]) + rg[i][k]) } else { Expr::ZERO },
            ));
        Inertia6::of(&moved, &g_columns, &m)
    }
}

/// A force expressed along the parent's axes and about its origin: f, n + r × f.
pub(crate) fn force_seen<'g>(
    graph: &'g Graph,
    turning: &Turning<'g>,
    place: &Vector<'g>,
    p: &Spatial<'g>,
) -> Spatial<'g> {
    let n = turning.to_parent(graph, &turning_part(p));
    let f = turning.to_parent(graph, &moving_part(p));
    let arm = cross(place, &f);
    joined(&vector(|i| graph.keep(n[i] + arm[i])), &f)
}

/// The parent's acceleration at the origin of the link: α, a + α × r.
pub(crate) fn acceleration_seen<'g>(
    graph: &'g Graph,
    turning: &Turning<'g>,
    place: &Vector<'g>,
    a: &Spatial<'g>,
) -> Spatial<'g> {
    let carried = cross(&turning_part(a), place);
    let moving = moving_part(a);
    let carried = vector(|i| graph.keep(moving[i] + carried[i]));
    joined(&turning.to_link(graph, &turning_part(a)), &turning.to_link(graph, &carried))
}

/// r̂ with r̂ v = r × v.
fn skew<'g>(r: &Vector<'g>) -> Tensor<'g> {
    [[Expr::ZERO, -r[2], r[1]], [r[2], Expr::ZERO, -r[0]], [-r[1], r[0], Expr::ZERO]]
}

/// A free component of a joint that has been eliminated.
#[derive(Clone, Debug)]
pub(crate) struct Freedom<'g> {
    /// The direction in which the component moves, along the axes of its link.
    direction: Direction<'g>,
    /// Φ s
    column: Spatial<'g>,
    inverse: Expr<'g>,
    /// The vector Φ s/(s·Φ s), with zero at its own component.
    factors: Spatial<'g>,
    /// The pivot s·Φ s with the size of its terms before elimination, if it may vanish.
    pub(crate) watched: Option<(Expr<'g>, Expr<'g>)>,
    /// Whether s·Φ s is identically zero: no inertia resists the direction.
    pub(crate) is_massless: bool,
}

/// The direction s, one of the six components; for a screw, one of the first three plus a multiple of the
/// displacement along the same axis.
#[derive(Clone, Copy, Debug)]
struct Direction<'g> {
    component: usize,
    pitch: Expr<'g>,
}

/// A remainder this small relative to its terms may be a rounding error.
const ROUNDING: f64 = 1e-12;

impl<'g> Direction<'g> {
    /// Whether the direction is component `r` of the six.
    fn is_component(&self, r: usize) -> bool {
        self.pitch.is_zero() && r == self.component
    }

    /// Φ s
    fn column(&self, graph: &'g Graph, phi: &Inertia6<'g>) -> Spatial<'g> {
        std::array::from_fn(|r| match self.pitch.is_zero() {
            true => phi.0[r][self.component],
            false => graph.keep(phi.0[r][self.component] + self.pitch * phi.0[r][self.component + 3]),
        })
    }

    /// An upper bound on s·Φ s: the trace of J, or of M, in the units of the direction.
    fn size(&self, graph: &'g Graph, phi: &Inertia6<'g>) -> Expr<'g> {
        let trace = |first: usize| graph.sum((first..first + 3).map(|r| phi.0[r][r]));
        match self.component < 3 {
            true if self.pitch.is_zero() => trace(0),
            true => trace(0) + self.pitch.square() * trace(3),
            false => trace(3),
        }
    }

    /// s · p
    fn along(&self, p: &Spatial<'g>) -> Expr<'g> {
        match self.pitch.is_zero() {
            true => p[self.component],
            false => p[self.component] + self.pitch * p[self.component + 3],
        }
    }
}

impl<'g> Freedom<'g> {
    /// s · p
    pub(crate) fn along(&self, p: &Spatial<'g>) -> Expr<'g> {
        self.direction.along(p)
    }

    /// Adds s w to an acceleration.
    pub(crate) fn accelerate(&self, graph: &'g Graph, a: &mut Spatial<'g>, w: Expr<'g>) {
        let Direction { component, pitch } = self.direction;
        a[component] = graph.keep(a[component] + w);
        if !pitch.is_zero() {
            a[component + 3] = graph.keep(a[component + 3] + pitch * w);
        }
    }

    /// Removes the free component from an acceleration and returns it, if it is one of the six components.
    pub(crate) fn leave_out(&self, a: &mut Spatial<'g>) -> Expr<'g> {
        match self.direction.pitch.is_zero() {
            true => std::mem::replace(&mut a[self.direction.component], Expr::ZERO),
            false => Expr::ZERO,
        }
    }
}

impl<'g> Hinge<'g> {
    /// The directions of the free components, in the order of the quasi-velocities of the hinge.
    fn directions(&self) -> Vec<Direction<'g>> {
        let of = |component: usize| Direction { component, pitch: Expr::ZERO };
        match self {
            Hinge::Turn { axis, pitch, .. } => vec![Direction { component: *axis, pitch: *pitch }],
            Hinge::Slide { axis, .. } => vec![of(3 + axis)],
            Hinge::Ball { .. } => (0..3).map(of).collect(),
            Hinge::Free { .. } => (3..6).chain(0..3).map(of).collect(),
        }
    }
}

/// A tree whose joints have been eliminated: M⁻¹ in the form in which it is applied, which takes O(N)
/// operations.
#[derive(Clone, Debug)]
pub(crate) struct Articulated<'g> {
    graph: &'g Graph,
    pub(crate) links: Vec<Eliminated<'g>>,
}

/// A link whose joint has been eliminated.
#[derive(Clone, Debug)]
pub(crate) struct Eliminated<'g> {
    pub(crate) parent: Option<usize>,
    pub(crate) turning: Turning<'g>,
    pub(crate) place: Vector<'g>,
    /// The free components in the order of the quasi-velocities, eliminated one after the other.
    pub(crate) freedoms: Vec<Freedom<'g>>,
}

impl<'g> Articulated<'g> {
    /// Eliminates the joints of links with these masses, from the last to the first. Where all inertias are
    /// nonnegative, the inertias of the single bodies, `own`, show which pivots cannot vanish.
    pub(crate) fn of(
        graph: &'g Graph,
        links: &[Link<'g>],
        masses: &[MassOnLink<'g>],
        own: Option<&[MassOnLink<'g>]>,
    ) -> Articulated<'g> {
        let turnings: Vec<Turning<'g>> = links.iter().map(|link| Turning::of(graph, link)).collect();
        let places: Vec<Vector<'g>> = links.iter().map(|link| link.origin(graph)).collect();
        let mut left: Vec<Option<Inertia6<'g>>> = vec![None; links.len()];
        let mut eliminated = Vec::with_capacity(links.len());
        for (i, link) in links.iter().enumerate().rev() {
            let rigid = Inertia6::rigid(&masses[i]);
            let mut inertia = left[i].map_or(rigid, |children| children.plus(&rigid, graph));
            let mut itself = own.map(|own| Inertia6::rigid(&own[i]));
            let (whole, alone) = (inertia, itself);
            let mut freedoms = Vec::new();
            for direction in link.hinge.directions() {
                let size = |of: &Inertia6<'g>| direction.size(graph, of);
                itself = itself.and_then(|left| left.resisting(graph, direction, alone.as_ref().map(size)?));
                let size = itself.is_none().then(|| size(&whole));
                freedoms.push(eliminate(graph, &mut inertia, direction, size));
            }
            if let Some(parent) = link.parent {
                let seen = inertia.seen(graph, &turnings[i], &places[i]);
                left[parent] = Some(left[parent].map_or(seen, |others| others.plus(&seen, graph)));
            }
            eliminated.push(Eliminated {
                parent: link.parent,
                turning: turnings[i].clone(),
                place: places[i],
                freedoms,
            });
        }
        eliminated.reverse();
        Articulated { graph, links: eliminated }
    }

    /// The response of the free components to the forces p on the links and the components τ = `applied` of the
    /// joints, link by link, relative to the accelerations for which p was computed.
    pub(crate) fn solve(
        &self,
        forces: Vec<Option<Spatial<'g>>>,
        applied: &[Vec<Expr<'g>>],
    ) -> Vec<Vec<Expr<'g>>> {
        let graph = self.graph;
        let mut forces = forces;
        // (τ − s·p)/pivot, tip to root.
        let mut impulses: Vec<Vec<Expr<'g>>> = vec![Vec::new(); self.links.len()];
        for (i, link) in self.links.iter().enumerate().rev() {
            let mut p = forces[i].unwrap_or([Expr::ZERO; 6]);
            for (freedom, &applied) in link.freedoms.iter().zip(&applied[i]) {
                let u = graph.keep(applied - freedom.direction.along(&p));
                let impulse = graph.keep(u * freedom.inverse);
                for (p, &column) in p.iter_mut().zip(&freedom.column) {
                    *p = graph.keep(*p + column * impulse);
                }
                if freedom.direction.pitch.is_zero() {
                    p[freedom.direction.component] = applied; // the remaining force is τ
                }
                impulses[i].push(impulse);
            }
            if let Some(parent) = link.parent {
                let seen = force_seen(graph, &link.turning, &link.place, &p);
                forces[parent] = Some(match forces[parent] {
                    Some(others) => std::array::from_fn(|i| graph.keep(others[i] + seen[i])),
                    None => seen,
                });
            }
        }
        let mut accelerations: Vec<Spatial<'g>> = Vec::with_capacity(self.links.len());
        let mut unknowns = Vec::with_capacity(self.links.len());
        for (i, link) in self.links.iter().enumerate() {
            let mut a = match link.parent {
                Some(parent) => acceleration_seen(graph, &link.turning, &link.place, &accelerations[parent]),
                None => joined(&ZERO, &ZERO),
            };
            let mut of_link = vec![Expr::ZERO; link.freedoms.len()];
            for (j, freedom) in link.freedoms.iter().enumerate().rev() {
                let Direction { component, pitch } = freedom.direction;
                let from_others = graph.dot(freedom.factors.iter().copied(), a.iter().copied());
                let total = graph.keep(impulses[i][j] - from_others);
                if pitch.is_zero() {
                    of_link[j] = total - a[component];
                    a[component] = total;
                } else {
                    of_link[j] = total;
                    a[component] = graph.keep(a[component] + total);
                    a[component + 3] = graph.keep(a[component + 3] + pitch * total);
                }
            }
            accelerations.push(a);
            unknowns.push(of_link);
        }
        unknowns
    }
}

/// Eliminates a component, so that the remaining `inertia` does not resist it. The pivot of the component is
/// watched if the `size` of its terms is given.
fn eliminate<'g>(
    graph: &'g Graph,
    inertia: &mut Inertia6<'g>,
    direction: Direction<'g>,
    size: Option<Expr<'g>>,
) -> Freedom<'g> {
    let column = direction.column(graph, inertia);
    let pivot = direction.along(&column);
    let inverse = graph.keep(pivot.powi(-1));
    let factors: Spatial<'g> = std::array::from_fn(|r| match direction.is_component(r) {
        true => Expr::ZERO,
        false => graph.keep(column[r] * inverse),
    });
    *inertia = inertia.map(|r, c, entry| match direction.is_component(r) || direction.is_component(c) {
        true => Expr::ZERO,
        false => graph.keep(entry - column[r] * factors[c]),
    });
    let watched = size.map(|size| (pivot, size));
    Freedom { direction, column, inverse, factors, watched, is_massless: pivot.is_zero() }
}
