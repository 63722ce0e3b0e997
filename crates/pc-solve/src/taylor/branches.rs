//! Corners and jumps of a field: the branch on which a series is valid, given by the signs of
//! branch functions.

use pc_expr::VectorField;

use crate::error::{Reason, SolveError};
use crate::integration::stepper::Stepper;
use crate::taylor::corners::first_exit;
use crate::taylor::step::Refusal;
use crate::taylor::stepper::Taylor;

/// Sign changes within this fraction of a step are simultaneous.
const TOGETHER: f64 = 1e-12;

impl<F: VectorField> Taylor<F> {
    /// Expands the motion in a series at the end of the last step, on the sides that the motion
    /// enters from there.
    pub(super) fn expand_at_end(&mut self, direction: f64) -> Result<(), SolveError> {
        self.direction = direction;
        self.sides.fill(0.0);
        // Each side found may determine another one.
        for _ in 0..=2 * self.branches.len() {
            match self.expand(self.end) {
                Ok(()) => {}
                Err(Refusal::Shorter(reason, failure)) => {
                    self.direction = 0.0;
                    return Err(self.failed(reason, failure));
                }
                Err(Refusal::Fatal(error)) => return Err(error),
            }
            let sides: Vec<f64> = (0..self.sides.len()).map(|i| self.leading_side(i)).collect();
            if sides == self.sides {
                return Ok(());
            }
            self.sides = sides;
        }
        self.direction = 0.0;
        Err(self.failed(Reason::Sliding { branch: self.branches.join(", "), t: self.end }, None))
    }

    /// The side that a branch function is on, or enters.
    pub(super) fn leading_side(&self, i: usize) -> f64 {
        let along = |k: usize| self.branch_series.of_order(k)[i] * self.direction.powi(k as i32 % 2);
        let leading = (0..=self.branch_series.order()).map(along).find(|c| *c != 0.0);
        leading.map_or(0.0, f64::signum)
    }

    /// The time within h at which any branch functions first change sign, and which of them do.
    pub(super) fn corner(&self, h: f64) -> Option<(f64, Vec<usize>)> {
        let mut first = None::<f64>;
        let mut exits = Vec::new();
        for i in 0..self.branches.len() {
            let coefficients: Vec<f64> =
                (0..=self.branch_series.order()).map(|k| self.branch_series.of_order(k)[i]).collect();
            if self.sides[i] == 0.0 || coefficients.iter().any(|c| !c.is_finite()) {
                continue;
            }
            if let Some(exit) = first_exit(&coefficients, self.sides[i], h) {
                exits.push((i, exit));
                first = Some(first.map_or(exit, |first| if exit.abs() < first.abs() { exit } else { first }));
            }
        }
        let first = first?;
        let together = |&(_, exit): &(usize, f64)| (exit - first).abs() <= TOGETHER * h.abs();
        let last = exits.iter().filter(|exit| together(exit)).map(|&(_, exit)| exit);
        let end = last.fold(first, |end, exit| if exit.abs() > end.abs() { exit } else { end });
        Some((end, exits.iter().filter(|exit| together(exit)).map(|&(i, _)| i).collect()))
    }

    /// The length over which the series of the branch functions are valid.
    pub(super) fn branch_length(&self) -> f64 {
        let order = self.branch_series.order();
        let mut length = f64::INFINITY;
        for i in 0..self.branches.len() {
            let c = |k: usize| self.branch_series.of_order(k)[i].abs();
            let size = (0..order.min(2)).map(c).fold(self.tolerances.largest_absolute(), f64::max);
            for k in [order.max(2) - 1, order] {
                let radius = (c(k) / size).powf(-1.0 / k as f64);
                length = length.min(radius * self.tolerances.relative.powf(1.0 / (order as f64 + 1.0)));
            }
        }
        length
    }

    /// Switches to the other side of these branch functions at the start of the step.
    pub(super) fn turn(&mut self, which: &[usize], direction: f64) -> Result<(), SolveError> {
        for &i in which {
            self.sides[i] = -self.sides[i];
        }
        self.ahead.of_order_mut(0).copy_from_slice(self.series.of_order(0));
        match self.expand(self.start) {
            Ok(()) => std::mem::swap(&mut self.series, &mut self.ahead),
            Err(Refusal::Shorter(reason, failure)) => return Err(self.failed(reason, failure)),
            Err(Refusal::Fatal(error)) => return Err(error),
        }
        match which.iter().find(|&&i| self.returns(i, direction)) {
            Some(&i) => Err(self.sliding(i, self.start)),
            None => Ok(()),
        }
    }

    /// Whether a branch function at zero turns back from the side it has entered.
    pub(super) fn returns(&self, i: usize, direction: f64) -> bool {
        self.branch_series.order() >= 1 && self.branch_series.of_order(1)[i] * direction * self.sides[i] < 0.0
    }

    pub(super) fn sliding(&mut self, i: usize, t: f64) -> SolveError {
        self.failed(Reason::Sliding { branch: self.branches[i].clone(), t }, None)
    }
}
