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

use pc_expr::{Expr, Graph};

use crate::tree::coupling::Coupling;
use crate::tree::freedom::{Freedom, eliminate};
use crate::tree::inertia6::{Inertia6, Spatial, acceleration_seen, force_seen, joined};
use crate::tree::link::Link;
use crate::tree::open_couplings::{Moved, Open, Pivot, Shared};
use crate::tree::spatial::{Vector, ZERO};
use crate::tree::tree::MassOnLink;
use crate::tree::turning::Turning;

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
