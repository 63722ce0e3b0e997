//! Watching the pivots of M.

use pc_expr::{Backend, Evaluator, Expr, ExprError, Program};

use crate::compiled::fault::Fault;
use crate::compiled::first_order::FirstOrder;
use crate::compiled::ldl::Factors;

/// A pivot this small against what it is left of is rounding.
const VANISHING_PIVOT: f64 = 1e-14;

/// An entry on the diagonal this small against the largest may be the square of a rounding, as sin² π is.
const SQUARE_OF_ROUNDING: f64 = 2.0 * f64::EPSILON * f64::EPSILON;

/// Finds a pivot that vanishes; `sizes` are those of the terms that each is the sum of, its entry on the diagonal among
/// them.
///
/// Where all have one sign, each is what the others leave of its own entry, so that units and the ratio of masses do not
/// matter. Otherwise they are compared with the largest, for a small one makes the others large, and their rounding with
/// them.
///
/// # Errors
/// [`Fault::Pivot`] with the place of the first.
#[inline]
pub(crate) fn check(pivots: &[f64], sizes: &[f64]) -> Result<(), Fault> {
    let largest = sizes.iter().fold(0.0f64, |largest, size| largest.max(size.abs()));
    if pivots.iter().all(|d| d.abs() > VANISHING_PIVOT * largest) {
        return Ok(());
    }
    closely(pivots, sizes, largest)
}

#[cold]
fn closely(pivots: &[f64], sizes: &[f64], largest: f64) -> Result<(), Fault> {
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
        Some(index) => Err(Fault::Pivot { index, pivot: pivots[index] }),
        None => Ok(()),
    }
}

/// The pivots of M and what they are compared with. Those that parameters alone determine are computed once for their
/// values.
#[derive(Clone, Debug)]
pub(crate) struct Pivots {
    /// The pivots, then as many sizes.
    values: Vec<f64>,
    /// The quasi-velocity of each pivot.
    places: Vec<usize>,
    /// Which of them change with the state.
    moving: Vec<usize>,
    /// Which do not, and the program that computes them.
    fixed: Vec<usize>,
    of_parameters: Evaluator,
    /// Whether the fixed ones are known, for the parameters as they are, and none vanished when last looked at.
    known: bool,
}

impl Pivots {
    /// The pivots of `factors`, and the expressions that [`check`](Pivots::check) is to be given the values
    /// of.
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
        let (fixed, moving): (Vec<usize>, Vec<usize>) =
            (0..all.len()).partition(|&i| system.is_fixed(all[i]));
        let pick = |indices: &[usize]| indices.iter().map(|&i| all[i]).collect::<Vec<_>>();
        let program = Program::new(system.graph, &system.inputs(&[]), &pick(&fixed))?;
        let pivots = Pivots {
            values: vec![0.0; all.len()],
            places: watched.iter().map(|watched| watched.place).collect(),
            of_parameters: Evaluator::new(program, Backend::Interpreter),
            known: false,
            fixed,
            moving: moving.clone(),
        };
        Ok((pivots, pick(&moving)))
    }

    /// Says that the parameters may have changed.
    pub(crate) fn forget(&mut self) {
        self.known = false;
    }

    /// Whether no pivot vanishes; `moving` are the values of those that change.
    ///
    /// # Errors
    /// [`Fault::Pivot`] for the first that does.
    #[inline]
    pub(crate) fn check(&mut self, state: &[f64], parameters: &[f64], moving: &[f64]) -> Result<(), Fault> {
        if self.known && moving.is_empty() {
            return Ok(());
        }
        if !self.known {
            self.fix(state, parameters);
        }
        for (&i, &value) in self.moving.iter().zip(moving) {
            self.values[i] = value;
        }
        let (pivots, sizes) = self.values.split_at(self.places.len());
        let outcome = check(pivots, sizes);
        self.known = outcome.is_ok();
        outcome.map_err(|fault| fault.at_place(|index| self.places[index]))
    }

    #[cold]
    fn fix(&mut self, state: &[f64], parameters: &[f64]) {
        let mut values = vec![0.0; self.fixed.len()];
        self.of_parameters.eval(0.0, state, parameters, &mut values);
        for (&i, value) in self.fixed.iter().zip(values) {
            self.values[i] = value;
        }
    }
}
