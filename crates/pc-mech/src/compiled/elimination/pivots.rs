//! Checks of the pivots of M.

use std::sync::Arc;

use pc_expr::{Backend, Evaluator, Expr, ExprError, Program, Watched};
use serde::{Deserialize, Serialize};

use crate::compiled::elimination::symbolic_ldl::Factors;
use crate::compiled::failure::EvaluationFailure;
use crate::compiled::first_order::FirstOrder;

/// A pivot this small relative to its diagonal entry before elimination is treated as rounding error.
const VANISHING_PIVOT: f64 = 1e-14;

/// A diagonal entry this small relative to the largest may be the square of a rounding error, as sin² π is.
const SQUARE_OF_ROUNDING: f64 = 2.0 * f64::EPSILON * f64::EPSILON;

/// Checks that no pivot vanishes; `sizes` gives for each one the size of its terms, including the diagonal
/// entry.
///
/// Where all pivots have the same sign, each is compared with its own diagonal entry, independently of units
/// and of mass ratios. Otherwise they are compared with the largest, since a small pivot makes the others,
/// and their rounding errors, large.
///
/// # Errors
/// [`EvaluationFailure::Pivot`] with the index of the first pivot that vanishes.
#[inline]
pub(crate) fn check(pivots: &[f64], sizes: &[f64]) -> Result<(), EvaluationFailure> {
    let largest = sizes.iter().fold(0.0f64, |largest, size| largest.max(size.abs()));
    if pivots.iter().all(|d| d.abs() > VANISHING_PIVOT * largest) {
        return Ok(());
    }
    closely(pivots, sizes, largest)
}

#[cold]
fn closely(pivots: &[f64], sizes: &[f64], largest: f64) -> Result<(), EvaluationFailure> {
    let definite = pivots.iter().all(|&d| d > 0.0) || pivots.iter().all(|&d| d < 0.0);
    let vanishes = |(d, size): (&f64, &f64)| {
        let (d, size) = (d.abs(), size.abs());
        if definite {
            d <= VANISHING_PIVOT * size || size <= SQUARE_OF_ROUNDING * largest
        } else {
            d <= VANISHING_PIVOT * largest
        }
    };
    match pivots.iter().zip(sizes).position(vanishes) {
        Some(index) => Err(EvaluationFailure::Pivot { index, pivot: pivots[index] }),
        None => Ok(()),
    }
}

/// The layout of the pivots: which pivots, and which of their sizes, change with the state. One list contains
/// all pivots, followed by as many sizes.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct PivotPartition {
    /// The index of the quasi-velocity of each pivot.
    places: Vec<usize>,
    /// The indices of the numbers that change with the state, and how many of them are pivots.
    moving: Vec<usize>,
    moving_pivots: usize,
    /// The indices of the numbers that do not change with the state.
    fixed: Vec<usize>,
}

/// The fixed numbers: the smallest pivot, the largest size, then all fixed pivots and sizes.
const SMALLEST: usize = 0;
const LARGEST: usize = 1;
const ALL: usize = 2;

impl PivotPartition {
    /// How many fixed numbers there are.
    pub(crate) fn fixed_len(&self) -> usize {
        ALL + self.fixed.len()
    }

    /// The number of pivots and sizes that change with the state.
    pub(crate) fn moving_len(&self) -> usize {
        self.moving.len()
    }

    /// Checks that no pivot vanishes, given the fixed numbers and the values of the numbers that change.
    ///
    /// # Errors
    /// [`EvaluationFailure::Pivot`] for the first pivot that vanishes.
    #[inline]
    pub(crate) fn check(
        &self,
        fixed: impl Fn(usize) -> f64,
        moving: &[f64],
    ) -> Result<(), EvaluationFailure> {
        let (pivots, sizes) = moving.split_at(self.moving_pivots);
        let largest = sizes.iter().fold(fixed(LARGEST), |largest, size| largest.max(size.abs()));
        let least = VANISHING_PIVOT * largest;
        if fixed(SMALLEST) > least && pivots.iter().all(|pivot| pivot.abs() > least) {
            return Ok(());
        }
        self.check_each(fixed, moving)
    }

    #[cold]
    fn check_each(&self, fixed: impl Fn(usize) -> f64, moving: &[f64]) -> Result<(), EvaluationFailure> {
        let mut values = vec![0.0; 2 * self.places.len()];
        for (k, &i) in self.fixed.iter().enumerate() {
            values[i] = fixed(ALL + k);
        }
        for (&i, &value) in self.moving.iter().zip(moving) {
            values[i] = value;
        }
        let (pivots, sizes) = values.split_at(self.places.len());
        check(pivots, sizes).map_err(|failure| failure.at_place(|index| self.places[index]))
    }
}

/// The pivots of M and the sizes with which they are compared. Pivots and sizes that depend on parameters
/// alone are computed once for given values of the parameters.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Pivots {
    partition: Arc<PivotPartition>,
    of_parameters: Evaluator,
    /// The fixed numbers for the last values of the parameters.
    fixed: Vec<f64>,
    is_known: bool,
}

impl Pivots {
    /// The pivots of `factors`, and the expressions whose values are passed to [`check`](Pivots::check).
    ///
    /// # Errors
    /// As for [`Program::new`].
    pub(crate) fn new<'g>(
        system: &FirstOrder<'g>,
        factors: &Factors<'g>,
    ) -> Result<(Pivots, Vec<Expr<'g>>), ExprError> {
        let watched = factors.watched(system.graph, &system.mass);
        let pivots = watched.iter().map(|watched| watched.pivot);
        let all: Vec<Expr<'g>> = pivots.chain(watched.iter().map(|watched| watched.size)).collect();
        let is_fixed = system.are_fixed(&all);
        let (fixed, moving): (Vec<usize>, Vec<usize>) = (0..all.len()).partition(|&i| is_fixed[i]);
        let pick = |indices: &[usize]| indices.iter().map(|&i| all[i]).collect::<Vec<_>>();
        let program = Program::new(system.graph, &system.inputs(&[]), &pick(&fixed))?;
        let values = pick(&moving);
        let partition = PivotPartition {
            places: watched.iter().map(|watched| watched.place).collect(),
            moving_pivots: moving.partition_point(|&i| i < watched.len()),
            moving,
            fixed,
        };
        let of_parameters = Evaluator::new(program, Backend::Interpreter);
        let fixed = vec![0.0; partition.fixed_len()];
        Ok((Pivots { partition: Arc::new(partition), of_parameters, fixed, is_known: false }, values))
    }

    /// Which pivots change with the state.
    pub(crate) fn partition(&self) -> &Arc<PivotPartition> {
        &self.partition
    }

    /// Makes the next check recompute the fixed numbers, since the parameters may have changed.
    pub(crate) fn forget(&mut self) {
        self.is_known = false;
    }

    /// Checks that no pivot vanishes; `moving` are the values of the numbers that change.
    ///
    /// # Errors
    /// [`EvaluationFailure::Pivot`] for the first pivot that vanishes.
    #[inline]
    pub(crate) fn check(
        &mut self,
        state: &[f64],
        parameters: &[f64],
        moving: &[f64],
    ) -> Result<(), EvaluationFailure> {
        if !self.is_known {
            self.fix(state, parameters);
        }
        self.partition.check(|k| self.fixed[k], moving)
    }

    /// The numbers with which the same check is made for many states at once.
    pub(crate) fn watched(&mut self, state: &[f64], parameters: &[f64]) -> Watched {
        let fixed = self.fixed(state, parameters);
        let (smallest, largest) = (fixed[SMALLEST], fixed[LARGEST]);
        Watched { pivots: self.partition.moving_pivots, smallest, largest, vanishing: VANISHING_PIVOT }
    }

    /// The fixed numbers for the given parameters.
    pub(crate) fn fixed(&mut self, state: &[f64], parameters: &[f64]) -> &[f64] {
        if !self.is_known {
            self.fix(state, parameters);
        }
        &self.fixed
    }

    #[cold]
    fn fix(&mut self, state: &[f64], parameters: &[f64]) {
        let partition = &self.partition;
        let fixed = &mut self.fixed;
        self.of_parameters.eval(0.0, state, parameters, &mut fixed[ALL..]);
        let (pivots, sizes) = fixed[ALL..].split_at(partition.places.len() - partition.moving_pivots);
        (fixed[SMALLEST], fixed[LARGEST]) = if partition.moving.is_empty() {
            // No pivot changes with the state, so this check is final.
            let regular = check(pivots, sizes).is_ok();
            (if regular { f64::INFINITY } else { 0.0 }, 0.0)
        } else {
            (
                pivots.iter().fold(f64::INFINITY, |smallest, pivot| smallest.min(pivot.abs())),
                sizes.iter().fold(0.0, |largest, size| size.abs().max(largest)),
            )
        };
        self.is_known = true;
    }
}
