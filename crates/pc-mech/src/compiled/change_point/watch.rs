//! The rank of the constraints along a motion, as known from step to step.

use serde::{Deserialize, Serialize};

use crate::compiled::change_point::collocation::Collocation;
use crate::compiled::elimination::saddle_point::{Independence, Pivot};

/// A state this near to a bridge, as a fraction of its components, is taken to lie on it.
const ON_BRIDGE: f64 = 1e-2;

/// The rank at the end of the last step, and the motion across the state where it is lost.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Watch {
    #[serde(skip)]
    pub(super) last: Option<Box<Seen>>,
    /// Storage for the rank at the end of the next step.
    #[serde(skip)]
    pub(super) next: Independence,
    #[serde(skip)]
    pub(super) bridge: Option<Box<Collocation>>,
    /// Whether the method needs derivatives of the rates along the motion, which a bridge does not have.
    pub(super) refuses: bool,
}

/// The rank at a state of the motion.
#[derive(Clone, Debug)]
pub(super) struct Seen {
    pub(super) t: f64,
    pub(super) state: Vec<f64>,
    pub(super) rank: Independence,
    /// The largest coefficient of each constraint so far, as a measure of their size elsewhere.
    sizes: Vec<f64>,
    /// The least pivot relative to these coefficients.
    pub(super) least: f64,
    /// The largest of these least pivots so far.
    pub(super) largest: f64,
    /// How far ahead in time a bridge was last tried.
    pub(super) tried: f64,
}

impl Seen {
    pub(super) fn new((t, y): (f64, &[f64]), rank: Independence) -> Seen {
        let sizes = rank.row_sizes.clone();
        let least = least(&rank, &sizes).0;
        Seen { t, state: y.to_vec(), rank, sizes, least, largest: least, tried: f64::INFINITY }
    }

    /// Moves to the state at the end of a step; returns the rank at its start.
    pub(super) fn advance(&mut self, (t, y): (f64, &[f64]), rank: Independence) -> Independence {
        self.sizes.iter_mut().zip(&rank.row_sizes).for_each(|(size, now)| *size = size.max(*now));
        let before = std::mem::replace(&mut self.least, least(&rank, &self.sizes).0);
        if self.least > before {
            self.tried = f64::INFINITY;
        }
        self.largest = self.largest.max(self.least);
        self.state.copy_from_slice(y);
        self.t = t;
        std::mem::replace(&mut self.rank, rank)
    }

    /// The constraint and the unknown of the least pivot.
    pub(super) fn least_determined(&self) -> (usize, usize) {
        let pivot = &self.rank.pivots[least(&self.rank, &self.sizes).1];
        (pivot.constraint, pivot.unknown)
    }
}

/// The least of the pivots relative to the sizes of their constraints, and its index.
fn least(rank: &Independence, sizes: &[f64]) -> (f64, usize) {
    let relative = |pivot: &Pivot| pivot.size / sizes[pivot.constraint];
    let places = rank.pivots.iter().map(relative).zip(0..);
    places.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((f64::INFINITY, 0))
}

impl Watch {
    /// The bridge, if the state is on it.
    #[inline]
    pub(crate) fn bridge(&self, t: f64, y: &[f64]) -> Option<&Collocation> {
        self.bridge.as_deref().filter(|bridge| bridge.contains(t) && bridge.is_near(t, y))
    }

    /// Forgets the rank and the bridge, since a different motion begins.
    pub(crate) fn forget(&mut self) {
        (self.last, self.bridge) = (None, None);
    }

    /// Declares that the method needs derivatives of the rates, which rules out bridges.
    pub(crate) fn refuse_bridges(&mut self) {
        self.refuses = true;
    }
}

impl Collocation {
    fn is_near(&self, t: f64, y: &[f64]) -> bool {
        self.distance(&self.state(t), y) <= ON_BRIDGE
    }
}
