//! Watching the pivots of M.

use pc_expr::{Backend, Evaluator, Expr, ExprError, Program};

use crate::compiled::fault::Fault;
use crate::compiled::first_order::FirstOrder;
use crate::compiled::ldl::Factors;

/// A pivot this small against the entry of M in its place, from which it is what the other pivots leave, is rounding.
const VANISHING_PIVOT: f64 = 1e-14;

/// Finds a pivot that vanishes against the entry of the diagonal of M in its place.
///
/// # Errors
/// [`Fault::Pivot`] for the first.
#[inline]
pub(crate) fn check(pivots: &[f64], diagonal: &[f64]) -> Result<(), Fault> {
    let vanishes = |(d, m): (&f64, &f64)| d.abs() <= VANISHING_PIVOT * m.abs();
    match pivots.iter().zip(diagonal).position(vanishes) {
        Some(index) => Err(Fault::Pivot { index, pivot: pivots[index] }),
        None => Ok(()),
    }
}

/// The pivots and the diagonal of M. Those that parameters alone determine are computed once for their
/// values.
#[derive(Clone, Debug)]
pub(crate) struct Pivots {
    /// k pivots, then k entries of the diagonal.
    values: Vec<f64>,
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
        let pivots = factors.pivots();
        let diagonal = (0..pivots.len()).map(|s| system.mass[(s, s)]);
        let all: Vec<Expr<'g>> = pivots.iter().copied().chain(diagonal).collect();
        let (fixed, moving): (Vec<usize>, Vec<usize>) =
            (0..all.len()).partition(|&i| system.is_fixed(all[i]));
        let pick = |indices: &[usize]| indices.iter().map(|&i| all[i]).collect::<Vec<_>>();
        let program = Program::new(system.graph, &system.inputs(&[]), &pick(&fixed))?;
        let watched = Pivots {
            values: vec![0.0; all.len()],
            of_parameters: Evaluator::new(program, Backend::Interpreter),
            known: false,
            fixed,
            moving: moving.clone(),
        };
        Ok((watched, pick(&moving)))
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
        let (pivots, diagonal) = self.values.split_at(self.values.len() / 2);
        let outcome = check(pivots, diagonal);
        self.known = outcome.is_ok();
        outcome
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
