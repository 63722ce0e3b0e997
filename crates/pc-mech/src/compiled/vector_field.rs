//! A compiled motion as a vector field.

use pc_expr::{
    Failure, LaneField, Pattern, RateJump, SteepFunctions, Switching, TaylorSeries, TimeDependence,
    VectorField,
};

use crate::compiled::change_point::bridge::Rates;
use crate::compiled::elimination::columns::Storage;
use crate::compiled::failure::EvaluationFailure;
use crate::compiled::motion::{Form, Motion, Switches};
use crate::compiled::point::Point;
use crate::error::{EvaluationError, FrameError, MechError};

/// The maximum number of repetitions of a projection: after this many, even a long step has shrunk to a
/// rounding error.
const MOST_RETURNS: usize = 4;

impl Motion {
    /// Projects onto unit quaternions, then onto the constraints by the shortest path in the kinetic metric, then
    /// along the constraints to the values of the integrals.
    pub(super) fn project_in_turn(&mut self, t: f64, y: &mut [f64]) -> Result<(), EvaluationFailure> {
        self.quaternions.normalise(y);
        self.follow_signals(t);
        if let Some(surface) = &mut self.surface {
            surface.project(t, y, &self.parameters)?;
            // A step along the constraints leaves the unit sphere by a distance of the order of its square.
            for _ in 0..MOST_RETURNS {
                if !self.quaternions.normalise(y) {
                    break;
                }
                surface.project(t, y, &self.parameters)?;
            }
        }
        if let Some(kept) = &mut self.kept {
            kept.project(t, y, &self.parameters)?;
        }
        Ok(())
    }

    /// Sets inputs to the values of the tables at t, if there are any.
    #[inline]
    pub(super) fn read_signals(&mut self, t: f64) -> Result<(), Failure> {
        if self.signals.is_empty() {
            return Ok(());
        }
        if self.signals.read(t, &mut self.parameters).map_err(Failure::fatal)?
            && let Form::Unrolled(unrolled) = &mut self.form
        {
            unrolled.forget();
        }
        Ok(())
    }

    /// Sets inputs to the values of the tables at t; outside of these, where rates fail, they keep the last values.
    pub(super) fn follow_signals(&mut self, t: f64) {
        let _ = self.read_signals(t);
    }

    fn write_jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        entries: &mut [f64],
        storage: Storage,
    ) -> Result<(), Failure> {
        if self.watch.bridge(t, y).is_some() {
            entries.fill(0.0); // its rates are functions of time
            return Ok(());
        }
        if let Some(switches) = self.holding() {
            let written = match storage {
                Storage::Dense => switches.jacobian(t, y, entries),
                Storage::Sparse => {
                    let mut dense = vec![0.0; y.len() * y.len()];
                    let written = switches.jacobian(t, y, &mut dense);
                    self.sparsity().inspect(|pattern| pattern.gather(&dense, entries));
                    written
                }
            };
            if is_written(&written) {
                return written;
            }
        }
        self.read_signals(t)?;
        let at = Point { t, y, p: &self.parameters };
        let outcome = match &mut self.form {
            Form::Unrolled(unrolled) => unrolled.jacobian(at, entries, storage),
            Form::Staged(staged) => staged.jacobian(at, entries, storage),
            Form::InMomenta(motion) => return motion.jacobian(t, y, entries), // full in both storages
        };
        outcome.map_err(|failure| self.failure(failure, t, y))
    }
}

impl VectorField for Motion {
    #[inline]
    fn dim(&self) -> usize {
        self.names.len()
    }

    #[inline]
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        if let Some(bridge) = self.watch.bridge(t, y) {
            bridge.rates(t, ydot);
            return Ok(());
        }
        if let Some(switches) = self.holding() {
            let written = switches.rhs(t, y, ydot);
            // A state that overflows moves away from the surface: a shorter step ends before it does.
            if is_written(&written) || ydot.iter().any(|rate| rate.is_infinite()) {
                return written;
            }
        }
        self.read_signals(t)?;
        let outcome = match &mut self.form {
            Form::Unrolled(unrolled) => unrolled.rhs(t, y, &self.parameters, ydot),
            Form::Staged(staged) => staged.rhs(t, y, &self.parameters, ydot),
            Form::InMomenta(motion) => return motion.rhs(t, y, ydot),
        };
        outcome.map_err(|failure| self.failure(failure, t, y))
    }

    #[inline]
    fn checks_rates(&self) -> bool {
        true
    }

    fn has_jacobian(&self) -> bool {
        self.options.jacobian
    }

    fn jacobian(&mut self, t: f64, y: &[f64], jacobian: &mut [f64]) -> Result<(), Failure> {
        self.write_jacobian(t, y, jacobian, Storage::Dense)
    }

    /// Available if the Jacobian was compiled.
    fn sparsity(&self) -> Option<&Pattern> {
        match &self.form {
            Form::Unrolled(unrolled) => unrolled.pattern(),
            Form::Staged(staged) => staged.pattern(),
            Form::InMomenta(motion) => motion.pattern(),
        }
    }

    fn sparse_jacobian(&mut self, t: f64, y: &[f64], values: &mut [f64]) -> Result<(), Failure> {
        self.write_jacobian(t, y, values, Storage::Sparse)
    }

    fn has_jvp(&self) -> bool {
        self.options.jvp
    }

    fn jvp(&mut self, t: f64, y: &[f64], v: &[f64], product: &mut [f64]) -> Result<(), Failure> {
        if let Some(switches) = self.holding() {
            let written = switches.jvp(t, y, v, product);
            if is_written(&written) {
                return written;
            }
        }
        self.read_signals(t)?;
        let at = Point { t, y, p: &self.parameters };
        let outcome = match &mut self.form {
            Form::Unrolled(unrolled) => unrolled.jvp(at, v, product),
            Form::Staged(staged) => staged.jvp(at, v, product),
            Form::InMomenta(_) => Err(EvaluationFailure::NotCompiled { what: "product with its Jacobian" }),
        };
        outcome.map_err(|failure| self.failure(failure, t, y))
    }

    fn parameters_len(&self) -> usize {
        self.parameters().len()
    }

    fn has_parameter_jacobian(&self) -> bool {
        self.options.parameter_jacobian
    }

    fn parameter_jacobian(&mut self, t: f64, y: &[f64], jacobian: &mut [f64]) -> Result<(), Failure> {
        if let Some(switches) = self.holding() {
            let written = switches.parameter_jacobian(t, y, jacobian);
            if is_written(&written) {
                return written;
            }
        }
        self.read_signals(t)?;
        let at = Point { t, y, p: &self.parameters };
        let outcome = match &mut self.form {
            Form::Unrolled(unrolled) => unrolled.parameter_jacobian(at, jacobian),
            Form::Staged(staged) => staged.parameter_jacobian(at, jacobian),
            Form::InMomenta(motion) => return motion.parameter_jacobian(t, y, jacobian),
        };
        outcome.map_err(|failure| self.failure(failure, t, y))
    }

    fn parameter_size(&self, j: usize) -> Option<f64> {
        self.parameters.get(j).map(|value| value.abs())
    }

    fn has_projection(&self) -> bool {
        let inner = self.in_quasi_velocities();
        inner.surface.is_some() || inner.kept.is_some() || !inner.quaternions.is_empty()
    }

    fn project(&mut self, t: f64, y: &mut [f64]) -> Result<(), Failure> {
        if self.watch.bridge(t, y).is_some() {
            return Ok(()); // on it states satisfy the constraints, which do not say how to get there
        }
        if let Form::InMomenta(motion) = &mut self.form {
            return motion.project(t, y);
        }
        self.project_in_turn(t, y).map_err(|failure| self.failure(failure, t, y))
    }

    fn time_dependence(&self) -> TimeDependence {
        match &self.form {
            Form::Unrolled(unrolled) => unrolled.time_dependence(self.names.len(), &self.parameters),
            Form::Staged(staged) => staged.time_dependence(&self.parameters),
            Form::InMomenta(motion) => motion.time_dependence(),
        }
    }

    fn steep_functions(&self) -> Option<SteepFunctions> {
        if let Some(switches) = &self.switches {
            return switches.motion.steep_functions();
        }
        match &self.form {
            Form::Unrolled(unrolled) => unrolled.steep_functions(self.names.len(), &self.parameters),
            Form::Staged(staged) => staged.steep_functions(&self.parameters),
            Form::InMomenta(motion) => motion.steep_functions(),
        }
    }

    fn series(&mut self) -> Result<&TaylorSeries, Failure> {
        self.check_series()?;
        if let Some(switches) = &mut self.switches {
            return switches.motion.series();
        }
        match &mut self.form {
            Form::Unrolled(unrolled) => Ok(unrolled.series()),
            Form::Staged(_) | Form::InMomenta(_) => unreachable!("has been refused"),
        }
    }

    fn expand(&mut self, t: f64, y: &[f64], sides: &[f64], order: usize) -> Result<&TaylorSeries, Failure> {
        self.check_series()?;
        self.watch.refuse_bridges();
        if let Some(switches) = &mut self.switches {
            switches.follow(&self.parameters);
            return switches.expand(t, y, order);
        }
        let at = Point { t, y, p: &self.parameters };
        let outcome = match &mut self.form {
            Form::Unrolled(unrolled) => unrolled.expand(at, sides, order),
            Form::Staged(_) | Form::InMomenta(_) => unreachable!("has been refused"),
        };
        // The state is borrowed by the series.
        outcome.map_err(|failure| {
            let error = failure.at(&self.quasi_velocities, t, &self.names, y);
            Failure::recoverable(error)
        })
    }

    fn varied_series(&mut self, columns: &[Option<usize>]) -> Result<&TaylorSeries, Failure> {
        self.check_series()?;
        if let Some(switches) = &mut self.switches {
            return switches.motion.varied_series(columns);
        }
        match &mut self.form {
            Form::Unrolled(unrolled) => Ok(unrolled.varied_series(columns)),
            Form::Staged(_) | Form::InMomenta(_) => unreachable!("has been refused"),
        }
    }

    fn expand_varied(
        &mut self,
        columns: &[Option<usize>],
        t: f64,
        all: &[f64],
        sides: &[f64],
        order: usize,
    ) -> Result<&TaylorSeries, Failure> {
        self.check_series()?;
        if let Some(switches) = &mut self.switches {
            switches.follow(&self.parameters);
            return switches.expand_varied(columns, t, all, order);
        }
        let at = Point { t, y: all, p: &self.parameters };
        let outcome = match &mut self.form {
            Form::Unrolled(unrolled) => unrolled.expand_varied(columns, at, sides, order),
            Form::Staged(_) | Form::InMomenta(_) => unreachable!("has been refused"),
        };
        // The state is borrowed by the series.
        outcome.map_err(|failure| {
            let error = failure.at(&self.quasi_velocities, t, &self.names, &all[..self.names.len()]);
            Failure::recoverable(error)
        })
    }

    fn lanes(&mut self) -> Option<LaneField> {
        let on_surface = self.surface.is_some() || self.kept.is_some();
        let alone = self.signals.is_empty() && self.charts.is_empty() && self.switches.is_none();
        if !alone || on_surface || self.steep_functions().is_some() {
            return None;
        }
        match &mut self.form {
            Form::Unrolled(unrolled) => {
                let lanes = unrolled.lanes(self.names.len(), &self.parameters)?;
                Some(LaneField { unit_quaternions: self.quaternions.places().to_vec(), ..lanes })
            }
            Form::Staged(_) | Form::InMomenta(_) => None,
        }
    }

    fn restart(&mut self, t: f64, y: &[f64]) {
        if self.watch.bridge(t, y).is_none() {
            self.watch.forget();
        }
        if let Form::InMomenta(motion) = &mut self.form {
            return motion.restart(t, y);
        }
        self.follow_signals(t);
        let Some(kept) = &mut self.kept else { return };
        let mut state = std::mem::take(&mut kept.room.state);
        state.copy_from_slice(y);
        if let Some(surface) = &mut self.surface
            && surface.project(t, &mut state, &self.parameters).is_err()
        {
            state.copy_from_slice(y); // the next projection reports the failure
        }
        kept.set_levels(Point { t, y: &state, p: &self.parameters });
        kept.room.state = state;
    }

    fn breaks(&self) -> &[f64] {
        self.signals().breaks()
    }

    fn enter(&mut self, t: f64, end: f64) -> bool {
        if let Some(switches) = &mut self.switches {
            switches.motion.enter(t, end);
        }
        match &mut self.form {
            Form::InMomenta(motion) => motion.inner_mut().enter(t, end),
            Form::Unrolled(_) | Form::Staged(_) => self.signals.enter(t, end),
        }
    }

    fn switching(&mut self) -> Option<&mut dyn Switching> {
        let switches = self.switches.as_deref_mut()?;
        switches.follow(&self.parameters);
        Some(switches)
    }

    fn jumps(&self) -> &[RateJump] {
        match &self.switches {
            Some(switches) => &switches.motion.jumps,
            None => &self.jumps,
        }
    }

    fn leads(&mut self, from: (f64, &[f64]), to: (f64, &[f64])) -> Result<(), Failure> {
        self.leads_by(from, to, &mut |motion, t, y, rates| motion.rhs(t, y, rates))
    }

    fn component_name(&self, i: usize) -> String {
        self.names.get(i).cloned().unwrap_or_else(|| format!("y[{i}]"))
    }
}

/// Whether a held motion has produced a value: beyond a surface it may have no value, though the motion on
/// the other side may have one.
fn is_written(outcome: &Result<(), Failure>) -> bool {
    outcome.as_ref().err().is_none_or(|failure| !failure.is_recoverable())
}

impl Motion {
    /// The surfaces at which the motion switches pieces, while the motion is held on given sides of them.
    #[inline]
    fn holding(&mut self) -> Option<&mut Switches> {
        self.switches.as_deref_mut().filter(|switches| switches.holds())
    }

    /// Does the work of [`leads`](VectorField::leads), with rates computed by `rates`.
    pub(super) fn leads_by(
        &mut self,
        from: (f64, &[f64]),
        to: (f64, &[f64]),
        rates: &mut Rates<'_>,
    ) -> Result<(), Failure> {
        self.watch_rank(from, to, rates)?;
        if self.charts.is_empty() {
            return Ok(());
        }
        let mut charts = std::mem::take(&mut self.charts);
        let undetermined = charts.iter_mut().any(|chart| {
            let Some(passage) = chart.passage(from, to, self.parameters()) else {
                return false;
            };
            let mut there = vec![f64::NAN; to.1.len()];
            let outcome = rates(self, to.0, to.1, &mut there);
            let velocities = &there[..self.coordinates];
            !(outcome.is_ok() && chart.rests(passage, to, velocities, self.parameters()))
        });
        self.charts = charts;
        match undetermined {
            true => {
                Err(Failure::fatal(MechError::Frame(FrameError::Undetermined { from: from.0, to: to.0 })))
            }
            false => Ok(()),
        }
    }

    /// Returns an error that says why there are no Taylor series, if there are none.
    fn check_series(&self) -> Result<(), Failure> {
        let because = match &self.form {
            Form::Unrolled(_) if self.signals.is_empty() => return Ok(()),
            Form::Unrolled(_) => "these read tables of inputs",
            Form::Staged(_) => "accelerations are solved for in numbers here",
            Form::InMomenta(_) => {
                "momenta under constraints are changed into quasi-velocities in numbers here"
            }
        };
        Err(Failure::fatal(MechError::from(EvaluationError::NoSeries { because })))
    }
}

impl Motion {
    /// Writes ∂f/∂t, one number per component; inputs given by tables count as constant parameters.
    ///
    /// # Errors
    /// As for [`rhs`](VectorField::rhs), and if ∂f/∂t was not
    /// [compiled](crate::CompileOptions::time_derivative).
    pub fn time_derivative(&mut self, t: f64, y: &[f64], derivative: &mut [f64]) -> Result<(), Failure> {
        self.read_signals(t)?;
        let at = Point { t, y, p: &self.parameters };
        let outcome = match &mut self.form {
            Form::Unrolled(unrolled) => unrolled.time_derivative(at, derivative),
            Form::Staged(staged) => staged.time_derivative(at, derivative),
            Form::InMomenta(motion) => return motion.time_derivative(t, y, derivative),
        };
        outcome.map_err(|failure| self.failure(failure, t, y))
    }

    /// The rates ẏ = f(t, y), one number per component.
    ///
    /// # Errors
    /// As for [`rhs`](VectorField::rhs), if f is not defined there.
    pub fn rates(&mut self, t: f64, y: &[f64]) -> Result<Vec<f64>, MechError> {
        let mut rates = vec![0.0; y.len()];
        self.rhs(t, y, &mut rates)?;
        Ok(rates)
    }
}
