//! Families of equilibria and of steady motions.

use pc_mech::{Matrix, SingularValues};

use crate::error::AnalysisError;
use crate::linear::leaf::independent_rows;
use crate::linear::linearizer::Linearizer;
use crate::linear::search::{Balanced, FEW};
use crate::linear::statics::Unknowns;
use crate::numeric::dense::norm;
use crate::stability::steady_motion::SteadyOptions;

/// Directions of the kernel below this fraction of the largest count as zero.
const ZERO: f64 = 1e-8;

/// How far along a direction another member of a family is sought, relative to 1 + |y|, and the fraction of the way that it has
/// to be away: in a direction between that of the family and others it is nearer.
const AWAY: f64 = 0.02;
const FAR: f64 = 0.25;

/// What the members of a family have in common.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Family {
    /// They are at rest.
    AtRest,
    /// All components but the cyclic coordinates are constant.
    Steady,
}

/// What is near a steady state.
#[derive(Clone, Copy, Debug)]
pub(super) struct Neighbours {
    /// The number of directions along which the conditions of steady motion hold to first order.
    pub(super) neutral: usize,
    /// The dimension of the family of steady states.
    pub(super) family: usize,
}

impl Linearizer {
    /// The dimension of the family of steady states through one: the number of independent directions along which there are
    /// others on both sides. Cyclic coordinates are left out. At an isolated state it is 0, even if the first
    /// approximation has a kernel, as at the minimum of x⁴.
    ///
    /// # Errors
    /// [`AnalysisError`] if the conditions of steady motion are not defined at the state.
    pub(super) fn family(
        &mut self,
        t: f64,
        state: &[f64],
        kind: Family,
    ) -> Result<Neighbours, AnalysisError> {
        let (options, moving) = (self.options_of(kind), self.moving_in(kind));
        let (directions, size) = (self.neutral(t, state, kind)?, 1.0 + norm(&self.in_units(state)));
        let seen: Vec<usize> = (0..state.len()).filter(|i| !self.cyclic.contains(i)).collect();
        // From an aim beside the family, if a direction leads away from it, the member nearest to the aim is reached.
        let mut reached = |direction: &[f64], side: f64| {
            let way = |i: usize| side * AWAY * size * direction[i];
            let aim: Vec<f64> = (0..state.len()).map(|i| state[i] + way(i) * self.units[i]).collect();
            let found = self.find_on(t, state, &aim, &options, &moving).ok()?;
            let moved: Vec<f64> = seen.iter().map(|&i| (found.state[i] - state[i]) / self.units[i]).collect();
            let missed: Vec<f64> = seen.iter().zip(&moved).map(|(&i, moved)| moved - way(i)).collect();
            (norm(&missed) <= AWAY * size && norm(&moved) >= FAR * AWAY * size).then_some(moved)
        };
        let across = |direction: &Vec<f64>| {
            let (there, back) = (reached(direction, 1.0)?, reached(direction, -1.0)?);
            Some(there.iter().zip(&back).map(|(there, back)| there - back).collect::<Vec<f64>>())
        };
        let members: Vec<Vec<f64>> = directions.iter().filter_map(across).collect();
        let members = Matrix::from_fn(members.len(), seen.len(), |i, j| members[i][j]);
        let family = independent_rows(&members, FAR * AWAY * size).len();
        Ok(Neighbours { neutral: directions.len(), family })
    }

    /// Whether a steady state is a member of the family of another: whether one comes to it, on the way along the family
    /// that leads nearer.
    pub(super) fn is_in_family(
        &mut self,
        t: f64,
        (member, other): (&[f64], &[f64]),
        kind: Family,
        is_same: impl Fn(&[f64], &[f64]) -> bool,
    ) -> bool {
        let near = |linearizer: &mut Linearizer| {
            let unknowns = linearizer.unknowns_of(t, member, kind)?;
            let levels = linearizer.levels(t, member)?;
            linearizer.balanced_near(t, (member, other), &levels, &unknowns)
        };
        near(self).is_ok_and(|reached| is_same(&reached.point.state, other))
    }

    /// The coordinates that may move.
    fn moving_in(&self, kind: Family) -> Vec<usize> {
        if kind == Family::AtRest { Vec::new() } else { self.cyclic.clone() }
    }

    fn options_of(&self, kind: Family) -> SteadyOptions {
        let held = if kind == Family::AtRest { self.zero_at_rest() } else { Vec::new() };
        SteadyOptions::default().fixed(held)
    }

    fn unknowns_of(&mut self, t: f64, state: &[f64], kind: Family) -> Result<Unknowns, AnalysisError> {
        let held = self.options_of(kind).fixed_among(self.names())?;
        let mut unknowns = self.all_unknowns(t, state, &self.moving_in(kind))?;
        unknowns.components.retain(|i| !held.contains(i));
        Ok(unknowns)
    }

    /// Orthonormal directions of the state in its units, without cyclic coordinates, along which the conditions of steady motion hold to
    /// first order.
    fn neutral(&mut self, t: f64, state: &[f64], kind: Family) -> Result<Vec<Vec<f64>>, AnalysisError> {
        let unknowns = self.unknowns_of(t, state, kind)?;
        let levels = self.levels(t, state)?;
        let Balanced { end, .. } = self.balanced(t, state, &levels, (FEW, false), &unknowns)?;
        let kernel = end.kernel()?;
        let size = |l: usize| norm(&kernel.column(l).collect::<Vec<_>>());
        let sizes: Vec<f64> = (0..kernel.columns()).map(size).collect();
        let seen: Vec<usize> = (0..unknowns.components.len())
            .filter(|&j| !self.cyclic.contains(&unknowns.components[j]))
            .collect();
        let entry = |i: usize, l: usize| kernel[(seen[i], l)] / sizes[l];
        let factors = SingularValues::of(&Matrix::from_fn(seen.len(), kernel.columns(), entry))?;
        let direction = |l: usize| {
            let mut direction = vec![0.0; state.len()];
            seen.iter().zip(factors.left.column(l)).for_each(|(&j, u)| direction[unknowns.components[j]] = u);
            direction
        };
        Ok((0..factors.rank(ZERO)).map(direction).collect())
    }
}
