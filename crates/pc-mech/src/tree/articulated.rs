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
//! A [coupling](crate::tree::coupling) η_d is open on the way from the links i that it moves by m_i η_d to the
//! link where these meet. With w_d = η̇_d, open couplings add C_d w_d to the force on a link, and
//!
//!   C_d · A + Σ_e D_de w_e + p_d = τ_d
//!
//! to the equations. A link that moves by m s w_d adds m Φ s to C_d, m s·C_e to D_de, m (m s·Φ s + m·armature + 2 s·C_d) to D_dd
//! and m s·p to p_d. Where the links meet, w_d is eliminated like a component of a joint.
//!
//! This is the elimination M = Lᵀ D L of the mass matrix of the whole tree, in an order that produces no fill-in
//! (Featherstone 1983; Rodriguez 1987).

use std::collections::BTreeMap;

use pc_expr::{Expr, Graph, Number};

use crate::tree::coupling::Coupling;
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
        let (pivot, size) = (number(direction.along(&column) + direction.armature)?, number(size)?);
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
    /// Each open coupling, with s·C_d and s·C_d/(s·Φ s).
    coupled: Vec<(usize, Expr<'g>, Expr<'g>)>,
}

/// A coupling that has been eliminated where the links that it moves meet.
#[derive(Clone, Debug)]
struct Shared<'g> {
    /// C_d, and C_d/D_dd.
    column: Spatial<'g>,
    factors: Spatial<'g>,
    /// 1/D_dd
    inverse: Expr<'g>,
    /// Each other open coupling, with D_de and D_de/D_dd.
    coupled: Vec<(usize, Expr<'g>, Expr<'g>)>,
    pivot: Pivot<'g>,
}

/// How a coupling moves a link.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moved<'g> {
    coupling: usize,
    ratio: Expr<'g>,
    direction: Direction<'g>,
}

/// A pivot of the elimination.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pivot<'g> {
    /// The link and which of its own quasi-velocities it belongs to.
    pub(crate) link: usize,
    pub(crate) component: usize,
    /// The pivot with the size of its terms before elimination, if it may vanish.
    pub(crate) watched: Option<(Expr<'g>, Expr<'g>)>,
    /// Whether it is identically zero: no inertia resists the quasi-velocity.
    pub(crate) is_massless: bool,
}

/// The direction s, one of the six components; for a screw, one of the first three plus a multiple of the
/// displacement along the same axis. The armature J resists it in addition to Φ.
#[derive(Clone, Copy, Debug)]
struct Direction<'g> {
    component: usize,
    pitch: Expr<'g>,
    armature: Expr<'g>,
}

/// A remainder this small relative to its terms may be a rounding error.
const ROUNDING: f64 = 1e-12;

impl<'g> Direction<'g> {
    /// Whether eliminating the direction eliminates one of the six components: nothing resists it afterwards.
    fn is_pure(&self) -> bool {
        self.pitch.is_zero() && self.armature.is_zero()
    }

    /// Whether eliminating the direction eliminates component `r` of the six.
    fn is_component(&self, r: usize) -> bool {
        self.is_pure() && r == self.component
    }

    /// Φ s
    fn column(&self, graph: &'g Graph, phi: &Inertia6<'g>) -> Spatial<'g> {
        std::array::from_fn(|r| match self.pitch.is_zero() {
            true => phi.0[r][self.component],
            false => graph.keep(phi.0[r][self.component] + self.pitch * phi.0[r][self.component + 3]),
        })
    }

    /// An upper bound on s·Φ s + J: the trace of the block of Φ, in the units of the direction, and the armature.
    fn size(&self, graph: &'g Graph, phi: &Inertia6<'g>) -> Expr<'g> {
        let trace = |first: usize| graph.sum((first..first + 3).map(|r| phi.0[r][r]));
        let size = match self.component < 3 {
            true if self.pitch.is_zero() => trace(0),
            true => trace(0) + self.pitch.square() * trace(3),
            false => trace(3),
        };
        size + self.armature
    }

    /// Adds s w to an acceleration.
    fn accelerate(&self, graph: &'g Graph, a: &mut Spatial<'g>, w: Expr<'g>) {
        let Direction { component, pitch, .. } = *self;
        a[component] = graph.keep(a[component] + w);
        if !pitch.is_zero() {
            a[component + 3] = graph.keep(a[component + 3] + pitch * w);
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
        self.direction.accelerate(graph, a, w);
    }

    /// Removes the free component from an acceleration and returns it, if it is one of the six components and
    /// has no inertia of its own.
    pub(crate) fn leave_out(&self, a: &mut Spatial<'g>) -> Expr<'g> {
        match self.direction.is_pure() {
            true => std::mem::replace(&mut a[self.direction.component], Expr::ZERO),
            false => Expr::ZERO,
        }
    }
}

impl<'g> Moved<'g> {
    /// m s · p
    fn along(&self, graph: &'g Graph, p: &Spatial<'g>) -> Expr<'g> {
        graph.keep(self.ratio * self.direction.along(p))
    }

    /// Adds m s w to an acceleration.
    pub(crate) fn accelerate(&self, graph: &'g Graph, a: &mut Spatial<'g>, w: Expr<'g>) {
        self.direction.accelerate(graph, a, graph.keep(self.ratio * w));
    }
}

impl<'g> Link<'g> {
    /// The directions of the free components, in the order of the quasi-velocities of the hinge.
    fn directions(&self) -> Vec<Direction<'g>> {
        let of = |component: usize| Direction { component, pitch: Expr::ZERO, armature: self.armature };
        match &self.hinge {
            Hinge::Turn { axis, pitch, .. } => vec![Direction { pitch: *pitch, ..of(*axis) }],
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
    couplings: Vec<Coupling<'g>>,
    /// The couplings as they have been eliminated.
    shared: Vec<Shared<'g>>,
}

/// A link whose joint has been eliminated.
#[derive(Clone, Debug)]
pub(crate) struct Eliminated<'g> {
    pub(crate) parent: Option<usize>,
    pub(crate) turning: Turning<'g>,
    pub(crate) place: Vector<'g>,
    /// The free components in the order of the quasi-velocities, eliminated one after the other.
    pub(crate) freedoms: Vec<Freedom<'g>>,
    /// The coupling that moves the link in their place.
    pub(crate) moved: Option<Moved<'g>>,
    /// The couplings whose links meet here, eliminated one after the other before the free components.
    meets: Vec<usize>,
}

/// The open couplings of a subtree: the C_d of a link, and the D_de of all links so far.
#[derive(Clone, Debug, Default)]
struct Open<'g> {
    columns: Vec<BTreeMap<usize, Spatial<'g>>>,
    sizes: BTreeMap<(usize, usize), Expr<'g>>,
}

impl<'g> Open<'g> {
    /// D_de, in either order of the indices.
    fn size(&mut self, d: usize, e: usize) -> &mut Expr<'g> {
        self.sizes.entry((d.min(e), d.max(e))).or_insert(Expr::ZERO)
    }

    /// Adds the inertia that resists the movement of link `i`.
    fn join(&mut self, graph: &'g Graph, i: usize, moved: &Moved<'g>, inertia: &Inertia6<'g>) {
        let Moved { coupling: d, ratio, direction } = *moved;
        let own = direction.column(graph, inertia).map(|entry| graph.keep(ratio * entry));
        let others = self.columns[i].clone();
        for (&e, column) in &others {
            let times = if e == d { Expr::from(2) } else { Expr::ONE };
            let shared = moved.along(graph, column);
            let size = self.size(d, e);
            *size = graph.keep(*size + times * shared);
        }
        let armature = ratio.square() * direction.armature;
        let size = self.size(d, d);
        *size = graph.keep(*size + moved.along(graph, &own) + armature);
        let column = self.columns[i].entry(d).or_insert([Expr::ZERO; 6]);
        *column = std::array::from_fn(|r| graph.keep(column[r] + own[r]));
    }

    /// Removes coupling `d` from link `i`, or from the world, with its pivot D_dd of this `size`.
    fn close(
        &mut self,
        graph: &'g Graph,
        (d, i): (usize, Option<usize>),
        inertia: Option<&mut Inertia6<'g>>,
        (owner, size): (usize, Option<Expr<'g>>),
    ) -> Shared<'g> {
        let column = i.and_then(|i| self.columns[i].remove(&d)).unwrap_or([Expr::ZERO; 6]);
        let pivot = *self.size(d, d);
        let inverse = graph.keep(pivot.powi(-1));
        let factors = column.map(|entry| graph.keep(entry * inverse));
        if let Some(inertia) = inertia {
            *inertia = inertia.map(|r, c, entry| graph.keep(entry - column[r] * factors[c]));
        }
        let with_d: Vec<_> = self.sizes.iter().filter(|((a, b), _)| (*a == d) != (*b == d)).collect();
        let with_d = with_d.into_iter().filter(|(_, size)| !size.is_zero());
        let coupled: Vec<_> = with_d
            .map(|(&(a, b), &size)| (if a == d { b } else { a }, size, graph.keep(size * inverse)))
            .collect();
        self.sizes.retain(|(a, b), _| *a != d && *b != d);
        self.reduce(graph, i, &column, &coupled);
        let watched = size.map(|size| (pivot, size));
        let pivot = Pivot { link: owner, component: 0, watched, is_massless: pivot.is_zero() };
        Shared { column, factors, inverse, coupled, pivot }
    }

    /// Removes what an eliminated row with these entries of Φ and D takes from the open couplings of a link.
    fn reduce(
        &mut self,
        graph: &'g Graph,
        i: Option<usize>,
        row: &Spatial<'g>,
        coupled: &[(usize, Expr<'g>, Expr<'g>)],
    ) {
        for (n, &(d, entry, _)) in coupled.iter().enumerate() {
            for &(e, _, factor) in &coupled[..=n] {
                let size = self.size(d, e);
                *size = graph.keep(*size - entry * factor);
            }
        }
        let Some(i) = i else { return };
        for &(d, _, factor) in coupled {
            let column = self.columns[i].entry(d).or_insert([Expr::ZERO; 6]);
            *column = std::array::from_fn(|r| graph.keep(column[r] - row[r] * factor));
        }
    }

    /// Hands the open couplings of link `i` on to its parent.
    fn hand_on(
        &mut self,
        graph: &'g Graph,
        i: usize,
        parent: usize,
        seen: impl Fn(&Spatial<'g>) -> Spatial<'g>,
    ) {
        for (d, column) in std::mem::take(&mut self.columns[i]) {
            let column = seen(&column);
            let sum = self.columns[parent].entry(d).or_insert([Expr::ZERO; 6]);
            *sum = std::array::from_fn(|r| graph.keep(sum[r] + column[r]));
        }
    }
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
        let couplings = Coupling::all(links);
        let mut shared: Vec<Option<Shared<'g>>> = vec![None; couplings.len()];
        let mut open = Open { columns: vec![BTreeMap::new(); links.len()], sizes: BTreeMap::new() };
        // The size of each D_dd, and whether a body alone resists.
        let mut sizes = vec![(Expr::ZERO, false); couplings.len()];
        let mut left: Vec<Option<Inertia6<'g>>> = vec![None; links.len()];
        let mut eliminated = Vec::with_capacity(links.len());
        for (i, link) in links.iter().enumerate().rev() {
            let rigid = Inertia6::rigid(&masses[i]);
            let mut inertia = left[i].map_or(rigid, |children| children.plus(&rigid, graph));
            let mut itself = own.map(|own| Inertia6::rigid(&own[i]));
            let (whole, alone) = (inertia, itself);
            let moved = couplings.iter().enumerate().find_map(|(coupling, known)| {
                let (ratio, direction) = (known.ratio(i)?, *link.directions().first()?);
                Some(Moved { coupling, ratio, direction })
            });
            if let Some(moved) = &moved {
                let Moved { coupling, ratio, direction } = *moved;
                open.join(graph, i, moved, &inertia);
                let (size, is_resisted) = &mut sizes[coupling];
                *size += ratio.square() * direction.size(graph, &whole);
                let resists = |alone: Inertia6<'g>| {
                    alone.resisting(graph, direction, direction.size(graph, &alone)).is_some()
                };
                *is_resisted |= couplings[coupling].owner == i && alone.is_some_and(resists);
            }
            let meets: Vec<usize> =
                (0..couplings.len()).filter(|&d| couplings[d].meeting == Some(i)).collect();
            for &d in &meets {
                let (size, is_resisted) = sizes[d];
                let size = (couplings[d].owner, (!is_resisted).then_some(size));
                shared[d] = Some(open.close(graph, (d, Some(i)), Some(&mut inertia), size));
            }
            let mut freedoms = Vec::new();
            let directions = if moved.is_some() { Vec::new() } else { link.directions() };
            for direction in directions {
                let size = |of: &Inertia6<'g>| direction.size(graph, of);
                itself = itself.and_then(|left| left.resisting(graph, direction, alone.as_ref().map(size)?));
                let size = itself.is_none().then(|| size(&whole));
                let mut freedom = eliminate(graph, &mut inertia, direction, size);
                let along = |(&d, column): (&usize, &Spatial<'g>)| {
                    let entry = direction.along(column);
                    (d, entry, graph.keep(entry * freedom.inverse))
                };
                freedom.coupled =
                    open.columns[i].iter().map(along).filter(|(_, entry, _)| !entry.is_zero()).collect();
                open.reduce(graph, Some(i), &freedom.column, &freedom.coupled);
                freedoms.push(freedom);
            }
            if let Some(parent) = link.parent {
                let seen = inertia.seen(graph, &turnings[i], &places[i]);
                left[parent] = Some(left[parent].map_or(seen, |others| others.plus(&seen, graph)));
                open.hand_on(graph, i, parent, |p| force_seen(graph, &turnings[i], &places[i], p));
            }
            eliminated.push(Eliminated {
                parent: link.parent,
                turning: turnings[i].clone(),
                place: places[i],
                freedoms,
                moved,
                meets,
            });
        }
        eliminated.reverse();
        let close = |(d, shared): (usize, Option<Shared<'g>>)| {
            let (size, is_resisted) = sizes[d];
            let size = (couplings[d].owner, (!is_resisted).then_some(size));
            shared.unwrap_or_else(|| open.close(graph, (d, None), None, size))
        };
        let shared = shared.into_iter().enumerate().map(close).collect();
        Articulated { graph, links: eliminated, couplings, shared }
    }

    /// The pivots, link by link.
    pub(crate) fn pivots(&self) -> impl Iterator<Item = Pivot<'g>> {
        let own = self.links.iter().enumerate().flat_map(|(link, eliminated)| {
            eliminated.freedoms.iter().enumerate().map(move |(component, freedom)| Pivot {
                link,
                component,
                watched: freedom.watched,
                is_massless: freedom.is_massless,
            })
        });
        own.chain(self.shared.iter().map(|shared| shared.pivot))
    }

    /// The acceleration η̇_d of the coupling that moves a link, if one does, from those of all links.
    pub(crate) fn shared_by(&self, link: usize, accelerations: &[Vec<Expr<'g>>]) -> Option<Expr<'g>> {
        let moved = self.links[link].moved.as_ref()?;
        accelerations[self.couplings[moved.coupling].owner].first().copied()
    }

    /// The forces in the directions of the quasi-velocities of a link when these are the forces on all joints, and
    /// the forces that their accelerations η̇ require of armatures.
    pub(crate) fn along(
        &self,
        link: usize,
        forces: &[Spatial<'g>],
        accelerations: &[Expr<'g>],
    ) -> Vec<Expr<'g>> {
        let graph = self.graph;
        if self.links[link].moved.is_none() {
            let along = |(freedom, &w): (&Freedom<'g>, &Expr<'g>)| {
                freedom.along(&forces[link]) + freedom.direction.armature * w
            };
            return self.links[link].freedoms.iter().zip(accelerations).map(along).collect();
        }
        let owned = self.couplings.iter().filter(|coupling| coupling.owner == link);
        let along = |(coupling, &w): (&Coupling<'g>, &Expr<'g>)| {
            let moved = coupling.moved.iter().filter_map(|&(i, _)| Some((i, self.links[i].moved?)));
            let terms = moved.flat_map(|(i, moved)| {
                let armature = moved.ratio.square() * moved.direction.armature;
                [moved.along(graph, &forces[i]), armature * w]
            });
            graph.sum(terms)
        };
        owned.zip(accelerations).map(along).collect()
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
        // (τ − s·p)/pivot, tip to root; for couplings p_d, then (τ_d − p_d)/D_dd.
        let mut impulses: Vec<Vec<Expr<'g>>> = vec![Vec::new(); self.links.len()];
        let mut shared = vec![Expr::ZERO; self.couplings.len()];
        for (i, link) in self.links.iter().enumerate().rev() {
            let mut p = forces[i].unwrap_or([Expr::ZERO; 6]);
            if let Some(moved) = &link.moved {
                let sum = &mut shared[moved.coupling];
                *sum = graph.keep(*sum + moved.along(graph, &p));
            }
            for &d in &link.meets {
                self.push(d, applied, &mut shared, Some(&mut p));
            }
            for (freedom, &applied) in link.freedoms.iter().zip(&applied[i]) {
                let u = graph.keep(applied - freedom.direction.along(&p));
                let impulse = graph.keep(u * freedom.inverse);
                for (p, &column) in p.iter_mut().zip(&freedom.column) {
                    *p = graph.keep(*p + column * impulse);
                }
                if freedom.direction.is_pure() {
                    p[freedom.direction.component] = applied; // the remaining force is τ
                }
                for &(d, entry, _) in &freedom.coupled {
                    shared[d] = graph.keep(shared[d] + entry * impulse);
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
        let at_world: Vec<usize> =
            (0..self.couplings.len()).filter(|&d| self.couplings[d].meeting.is_none()).collect();
        at_world.iter().for_each(|&d| self.push(d, applied, &mut shared, None));
        // From here on the accelerations w_d of couplings.
        at_world.iter().rev().for_each(|&d| self.pull(d, &mut shared, None));
        let mut accelerations: Vec<Spatial<'g>> = Vec::with_capacity(self.links.len());
        let mut unknowns = Vec::with_capacity(self.links.len());
        for (i, link) in self.links.iter().enumerate() {
            let mut a = match link.parent {
                Some(parent) => acceleration_seen(graph, &link.turning, &link.place, &accelerations[parent]),
                None => joined(&ZERO, &ZERO),
            };
            let mut of_link = vec![Expr::ZERO; link.freedoms.len()];
            for (j, freedom) in link.freedoms.iter().enumerate().rev() {
                let component = freedom.direction.component;
                let from_others = graph.dot(freedom.factors.iter().copied(), a.iter().copied());
                let from_shared = freedom.coupled.iter().map(|&(d, _, factor)| factor * shared[d]);
                let total = graph.keep(impulses[i][j] - from_others - graph.sum(from_shared));
                if freedom.direction.is_pure() {
                    of_link[j] = total - a[component];
                    a[component] = total;
                } else {
                    of_link[j] = total;
                    freedom.accelerate(graph, &mut a, total);
                }
            }
            for &d in link.meets.iter().rev() {
                self.pull(d, &mut shared, Some(&a));
            }
            if let Some(moved) = &link.moved {
                moved.accelerate(graph, &mut a, shared[moved.coupling]);
                if self.couplings[moved.coupling].owner == i {
                    of_link.push(shared[moved.coupling]);
                }
            }
            accelerations.push(a);
            unknowns.push(of_link);
        }
        unknowns
    }

    /// Turns p_d of a coupling into (τ_d − p_d)/D_dd, and adds what that does to the link where its links meet.
    fn push(
        &self,
        d: usize,
        applied: &[Vec<Expr<'g>>],
        shared: &mut [Expr<'g>],
        p: Option<&mut Spatial<'g>>,
    ) {
        let (graph, known) = (self.graph, &self.shared[d]);
        let applied = applied[self.couplings[d].owner].first().copied().unwrap_or(Expr::ZERO);
        let impulse = graph.keep((applied - shared[d]) * known.inverse);
        shared[d] = impulse;
        if let Some(p) = p {
            *p = std::array::from_fn(|r| graph.keep(p[r] + known.column[r] * impulse));
        }
        for &(e, entry, _) in &known.coupled {
            shared[e] = graph.keep(shared[e] + entry * impulse);
        }
    }

    /// Turns (τ_d − p_d)/D_dd of a coupling into w_d, with the acceleration of the link where its links meet.
    fn pull(&self, d: usize, shared: &mut [Expr<'g>], a: Option<&Spatial<'g>>) {
        let (graph, known) = (self.graph, &self.shared[d]);
        let carried = a.map(|a| graph.dot(known.factors.iter().copied(), a.iter().copied()));
        let others = known.coupled.iter().map(|&(e, _, factor)| factor * shared[e]);
        shared[d] = graph.keep(shared[d] - carried.unwrap_or(Expr::ZERO) - graph.sum(others));
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
    let pivot = direction.along(&column) + direction.armature;
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
    let is_massless = pivot.is_zero();
    Freedom { direction, column, inverse, factors, watched, is_massless, coupled: Vec::new() }
}
