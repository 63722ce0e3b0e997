//! Motions that keep first integrals constant.

use crate::compiled::motion::Motion;
use crate::compiled::point::Point;
use crate::compiled::projection::integrals::KeptIntegrals;
use crate::constraints::multipliers::Multipliers;
use crate::equations::canonical::Canonical;
use crate::equations::poincare::Equations;
use crate::error::{IntegralError, MechError};
use pc_expr::VectorField;

/// A rate of change counts as nonzero if it exceeds this fraction of the size of its terms; the fraction is far
/// above rounding errors.
const RATE: f64 = 1e-9;

/// A rate is itself a rounding error if it changes by more than this fraction when the last digits change.
const UNCERTAIN: f64 = 1.0 / 64.0;

/// The number of trial changes to the last digits, and their size.
const PROBES: u64 = 8;
const LAST_DIGITS: f64 = 8.0 * f64::EPSILON;

/// The number of steps along which an integral is tested, each twice as long as the one before; the first
/// step changes the state by about this fraction, with an error far below [`RATE`].
const STEPS: usize = 8;
const FIRST_STEP: f64 = 1e-4;

impl<'g> Equations<'g> {
    /// The integrals with these names, or `energy`, to be [kept](Motion::keep).
    ///
    /// # Errors
    /// [`IntegralError::Unknown`].
    pub fn kept<S: AsRef<str>>(&self, names: &[S]) -> Result<KeptIntegrals, MechError> {
        self.first_order().kept(names, &[])
    }
}

impl<'g> Canonical<'g> {
    /// The integrals with these names, or `energy`, as functions of (t, x, y), to be [kept](Motion::keep).
    ///
    /// # Errors
    /// [`IntegralError::Unknown`]; [`LagrangianError::NotQuadratic`](crate::LagrangianError::NotQuadratic) where η is
    /// not an expression in the momenta.
    pub fn kept<S: AsRef<str>>(&self, names: &[S]) -> Result<KeptIntegrals, MechError> {
        let mut equations = self.observed_first_order()?;
        let closed = self.closed_quasi_velocities()?.iter().copied();
        let solved: Vec<_> = equations.unknowns.iter().copied().zip(closed).collect();
        for (_, observable) in &mut equations.observables {
            *observable = equations.graph.substitute(&[*observable], &solved)[0];
        }
        equations.kept(names, &[])
    }
}

impl<'g> Multipliers<'g> {
    /// The integrals with these names, or `energy`, to be [kept](Motion::keep) together with the constraints.
    ///
    /// # Errors
    /// [`IntegralError::Unknown`].
    pub fn kept<S: AsRef<str>>(&self, names: &[S]) -> Result<KeptIntegrals, MechError> {
        self.first_order().kept(names, &self.conditions())
    }
}

impl Motion {
    /// The same motion with a further [projection](pc_expr::VectorField::project), which comes after the
    /// projection onto its constraints: it moves the state, by the shortest path in its components, to where
    /// these integrals have their values at (t, y). Applied after each step, it changes the state by at most
    /// the error of the step.
    ///
    /// An integral is not kept at states where its gradient depends linearly on the gradients of the
    /// integrals before it; an example is the energy at rest. A quantity that may jump along the motion is
    /// refused: keeping it would change the motion.
    ///
    /// # Errors
    /// [`IntegralError::NotAnIntegral`] if one of the integrals changes along the motion at (t, y) or a
    /// little later; errors of the equations of motion at (t, y).
    ///
    /// ```
    /// use pc_mech::{Graph, System, VectorField};
    ///
    /// // A point that circles with ω; |x| keeps its value.
    /// let graph = Graph::new();
    /// let equations = System::builder(&graph)
    ///     .coordinates(["x", "y"])
    ///     .quasi_velocities(["ω"])
    ///     .kinematics(|_, x, eta| [-x[1] * eta[0], x[0] * eta[0]])
    ///     .lagrangian(|_, _, eta| eta[0].square() / 2.0)
    ///     .integral("norm", |_, x, _| x[0].square() + x[1].square())
    ///     .build()?
    ///     .poincare()?;
    /// let kept = equations.kept(&["norm"])?;
    /// let mut motion = equations.compile()?.keep(kept, 0.0, &[1.0, 0.0, 2.0])?;
    /// let mut state = [0.6003, 0.8004, 2.0];
    /// motion.project(1.0, &mut state)?;
    /// assert!((state[0] - 0.6).abs() < 1e-15 && (state[1] - 0.8).abs() < 1e-15);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn keep(mut self, integrals: KeptIntegrals, t: f64, y: &[f64]) -> Result<Motion, MechError> {
        self.set_kept(Some(integrals));
        self.keep_from(t, y)?;
        Ok(self)
    }

    /// Makes the values at (t, y) the ones to be [kept](Motion::keep) from now on: for another initial state,
    /// or for other values of the parameters.
    ///
    /// # Errors
    /// As for [`keep`](Motion::keep).
    pub fn keep_from(&mut self, t: f64, y: &[f64]) -> Result<(), MechError> {
        if let Some(motion) = self.in_momenta() {
            motion.read(t, y)?;
            let state = motion.state().to_vec();
            return motion.inner_mut().keep_from(t, &state);
        }
        let Some(mut integrals) = self.set_kept(None) else { return Ok(()) };
        let kept = self.try_to_keep(&mut integrals, t, y);
        integrals.set_levels(Point { t, y, p: self.parameters() });
        self.set_kept(Some(integrals));
        kept
    }

    fn try_to_keep(&mut self, integrals: &mut KeptIntegrals, t: f64, y: &[f64]) -> Result<(), MechError> {
        let rates = self.rates(t, y)?;
        self.check(integrals, t, y, &rates)?;
        // At rest many quantities that will change have no rate yet; a few short steps show that they change.
        let largest = |values: &[f64]| values.iter().fold(0.0f64, |size, x| size.max(x.abs()));
        let (mut now, mut state) = (t, y.to_vec());
        let mut step = FIRST_STEP * largest(y).max(1.0) / largest(&rates).max(1.0);
        for _ in 0..STEPS {
            let Ok(next) = self.runge_kutta(now, &state, step) else { break };
            (now, state) = (now + step, next);
            // Where the constraints do not hold, reactions do work.
            if self.project(now, &mut state).is_err() {
                break;
            }
            let Ok(rates) = self.rates(now, &state) else { break };
            self.check(integrals, now, &state, &rates)?;
            step *= 2.0;
        }
        Ok(())
    }

    /// # Errors
    /// [`IntegralError::NotAnIntegral`] if one of the integrals changes at (t, y), where ẏ = `rates`.
    fn check(
        &mut self,
        integrals: &mut KeptIntegrals,
        t: f64,
        y: &[f64],
        rates: &[f64],
    ) -> Result<(), MechError> {
        let found = integrals.rates_of_change(Point { t, y, p: self.parameters() }, rates);
        for (place, &(rate, size)) in found.iter().enumerate() {
            if rate.is_nan() || rate.abs() > RATE * size && !self.is_uncertain(integrals, place, rate, t, y) {
                let name = integrals.names[place].clone();
                return Err(IntegralError::NotAnIntegral { name, t, rate }.into());
            }
        }
        Ok(())
    }

    /// Whether the rate of change of an integral at (t, y) is due to rounding errors in ẏ: it then changes with
    /// the last digits of the state and of the equations. The changes made to the last digits are the same on
    /// every run.
    fn is_uncertain(
        &mut self,
        integrals: &mut KeptIntegrals,
        place: usize,
        rate: f64,
        t: f64,
        y: &[f64],
    ) -> bool {
        let mut bits = 0x9e37_79b9_7f4a_7c15_u64;
        (0..PROBES).any(|_| {
            let factor = || {
                bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                let part = (bits >> 11) as f64 / (1u64 << 52) as f64 - 1.0;
                1.0 + LAST_DIGITS * part
            };
            let Ok((probe, rates)) = self.perturbed_rates(t, y, factor) else { return false };
            let (there, _) =
                integrals.rates_of_change(Point { t, y: &probe, p: self.parameters() }, &rates)[place];
            (there - rate).abs() > UNCERTAIN * rate.abs()
        })
    }

    /// The same motion, projected onto its constraints alone.
    pub fn without_kept(mut self) -> Motion {
        self.set_kept(None);
        self
    }

    /// The state after a step of the classical Runge–Kutta method.
    fn runge_kutta(&mut self, t: f64, y: &[f64], step: f64) -> Result<Vec<f64>, MechError> {
        let along =
            |rates: &[f64], h: f64| y.iter().zip(rates).map(|(y, rate)| y + h * rate).collect::<Vec<_>>();
        let a = self.rates(t, y)?;
        let b = self.rates(t + step / 2.0, &along(&a, step / 2.0))?;
        let c = self.rates(t + step / 2.0, &along(&b, step / 2.0))?;
        let d = self.rates(t + step, &along(&c, step))?;
        let mean: Vec<f64> = (0..y.len()).map(|i| (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]) / 6.0).collect();
        Ok(along(&mean, step))
    }
}
