//! Couplings on the way from the links that they move to the link where these meet.

use std::collections::BTreeMap;

use pc_expr::{Expr, Graph};

use crate::tree::freedom::Direction;
use crate::tree::inertia6::{Inertia6, Spatial};

/// How a coupling moves a link.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moved<'g> {
    pub(crate) coupling: usize,
    pub(crate) ratio: Expr<'g>,
    pub(crate) direction: Direction<'g>,
}

impl<'g> Moved<'g> {
    /// m s · p
    pub(crate) fn along(&self, graph: &'g Graph, p: &Spatial<'g>) -> Expr<'g> {
        graph.keep(self.ratio * self.direction.along(p))
    }

    /// Adds m s w to an acceleration.
    pub(crate) fn accelerate(&self, graph: &'g Graph, a: &mut Spatial<'g>, w: Expr<'g>) {
        self.direction.accelerate(graph, a, graph.keep(self.ratio * w));
    }
}

/// A coupling that has been eliminated where the links that it moves meet.
#[derive(Clone, Debug)]
pub(crate) struct Shared<'g> {
    /// C_d, and C_d/D_dd.
    pub(crate) column: Spatial<'g>,
    pub(crate) factors: Spatial<'g>,
    /// 1/D_dd
    pub(crate) inverse: Expr<'g>,
    /// Each other open coupling, with D_de and D_de/D_dd.
    pub(crate) coupled: Vec<(usize, Expr<'g>, Expr<'g>)>,
    pub(crate) pivot: Pivot<'g>,
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

/// The open couplings of a subtree: the C_d of a link, and the D_de of all links so far.
#[derive(Clone, Debug, Default)]
pub(crate) struct Open<'g> {
    pub(crate) columns: Vec<BTreeMap<usize, Spatial<'g>>>,
    pub(crate) sizes: BTreeMap<(usize, usize), Expr<'g>>,
}

impl<'g> Open<'g> {
    /// D_de, in either order of the indices.
    fn size(&mut self, d: usize, e: usize) -> &mut Expr<'g> {
        self.sizes.entry((d.min(e), d.max(e))).or_insert(Expr::ZERO)
    }

    /// Adds the inertia that resists the movement of link `i`.
    pub(crate) fn join(&mut self, graph: &'g Graph, i: usize, moved: &Moved<'g>, inertia: &Inertia6<'g>) {
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
    pub(crate) fn close(
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
    pub(crate) fn reduce(
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
    pub(crate) fn hand_on(
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
