//! A piece of a motion that can be evaluated at any time.

use pc_expr::VectorField;

use crate::error::SolveError;
use crate::integration::integration::Integration;
use crate::settings::options::Options;

/// The polynomials of the method for the steps of a piece of a motion.
#[derive(Debug, Default)]
pub(crate) struct MotionRecord {
    dim: usize,
    /// 1 or −1
    direction: f64,
    /// The end of each step.
    ends: Vec<f64>,
    /// The index at which the coefficients of each step begin.
    first: Vec<usize>,
    /// y⁽ᵏ⁾(end)/k! of each step, for k from 0 to the order of the step.
    coefficients: Vec<f64>,
}

impl MotionRecord {
    /// Integrates from y(t0) = y0 to `t1`, without evaluating the field beyond `t1`, while the
    /// field is held on these sides of its surfaces.
    pub(crate) fn of(
        field: &mut impl VectorField,
        t0: f64,
        y0: &[f64],
        t1: f64,
        sides: &[f64],
        options: &Options,
    ) -> Result<MotionRecord, SolveError> {
        let mut motion = Integration::new(field, t0, y0, &options.clone().stop_time(t1))?;
        motion.stay_on(sides);
        let direction = 1.0_f64.copysign(t1 - t0);
        let mut record = MotionRecord { dim: y0.len(), direction, ..MotionRecord::default() };
        while motion.time() != t1 {
            let t = motion.step_towards(t1)?;
            record.ends.push(t);
            record.first.push(record.coefficients.len());
            let mut factorial = 1.0;
            for k in 0..=motion.statistics().last_order {
                factorial *= f64::from(k.max(1));
                let derivative = motion.interpolate(t, k)?;
                record.coefficients.extend(derivative.iter().map(|value| value / factorial));
            }
        }
        Ok(record)
    }

    /// Writes y(t).
    pub(crate) fn state(&self, t: f64, y: &mut [f64]) {
        let step = self.ends.partition_point(|end| (end - t) * self.direction < 0.0);
        let step = step.min(self.ends.len() - 1);
        let end = self.first.get(step + 1).copied().unwrap_or(self.coefficients.len());
        let from_end = t - self.ends[step];
        y.fill(0.0);
        for coefficients in self.coefficients[self.first[step]..end].chunks_exact(self.dim).rev() {
            for (y, coefficient) in y.iter_mut().zip(coefficients) {
                *y = *y * from_end + coefficient;
            }
        }
    }
}
