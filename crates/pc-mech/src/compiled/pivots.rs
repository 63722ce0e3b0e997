//! Watching the pivots of M.

use pc_expr::{Backend, Evaluator, Expr, ExprError, Program};

use crate::compiled::fault::Fault;
use crate::compiled::first_order::FirstOrder;
use crate::compiled::ldl::Factors;

/// A pivot this small against the largest diagonal entry of M is rounding.
const VANISHING_PIVOT: f64 = 1e-14;

/// Finds a pivot that vanishes against the diagonal of M.
///
/// # Errors
/// [`Fault::Pivot`] for the first.
pub(crate) fn check(pivots: &[f64], diagonal: impl IntoIterator<Item = f64>) -> Result<(), Fault> {
    let limit = VANISHING_PIVOT * largest(0.0, diagonal);
    match pivots.iter().position(|d| d.abs() <= limit) {
        Some(index) => Err(Fault::Pivot { index, pivot: pivots[index] }),
        None => Ok(()),
    }
}

fn largest(least: f64, values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(least, |scale, m| scale.max(m.abs()))
}

/// The pivots and the diagonal of M. Those that parameters alone determine are computed once for their
/// values.
#[derive(Clone, Debug)]
pub(crate) struct Pivots {
    /// k pivots, then k entries of the diagonal.
    values: Vec<f64>,
    /// Which of them change with the state.
    moving: Vec<usize>,
    /// How many of these are pivots, which come first.
    moving_pivots: usize,
    /// Which do not, and the program that computes them.
    fixed: Vec<usize>,
    of_parameters: Evaluator,
    /// Of the fixed ones, once they are computed: the least pivot and the largest entry of the diagonal.
    bounds: Option<(f64, f64)>,
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
            moving_pivots: moving.iter().filter(|&&i| i < pivots.len()).count(),
            of_parameters: Evaluator::new(program, Backend::Interpreter),
            bounds: None,
            fixed,
            moving: moving.clone(),
        };
        Ok((watched, pick(&moving)))
    }

    /// Says that the parameters may have changed.
    pub(crate) fn forget(&mut self) {
        self.bounds = None;
    }

    /// Whether no pivot vanishes; `moving` are the values of those that change.
    ///
    /// # Errors
    /// [`Fault::Pivot`] for the first that does.
    #[inline]
    pub(crate) fn check(&mut self, state: &[f64], parameters: &[f64], moving: &[f64]) -> Result<(), Fault> {
        let (least, scale) = match self.bounds {
            Some(bounds) => bounds,
            None => self.fix(state, parameters),
        };
        let (pivots, diagonal) = moving.split_at(self.moving_pivots);
        let limit = VANISHING_PIVOT * largest(scale, diagonal.iter().copied());
        // Written so that a pivot that is no number is looked at closely.
        if least > limit && pivots.iter().all(|d| d.abs() > limit) { Ok(()) } else { self.closely(moving) }
    }

    #[cold]
    fn fix(&mut self, state: &[f64], parameters: &[f64]) -> (f64, f64) {
        let mut values = vec![0.0; self.fixed.len()];
        self.of_parameters.eval(0.0, state, parameters, &mut values);
        for (&i, value) in self.fixed.iter().zip(values) {
            self.values[i] = value;
        }
        let k = self.values.len() / 2;
        let of = |range: std::ops::Range<usize>| {
            self.fixed.iter().filter(move |&&i| range.contains(&i)).map(|&i| self.values[i])
        };
        let least = of(0..k).fold(f64::INFINITY, |least, d| least.min(d.abs()));
        let bounds = (least, largest(0.0, of(k..2 * k)));
        self.bounds = Some(bounds);
        bounds
    }

    #[cold]
    fn closely(&mut self, moving: &[f64]) -> Result<(), Fault> {
        for (&i, &value) in self.moving.iter().zip(moving) {
            self.values[i] = value;
        }
        let (pivots, diagonal) = self.values.split_at(self.values.len() / 2);
        check(pivots, diagonal.iter().copied())
    }
}
