//! Motions under external forces, which the caller computes.

use pc_expr::{Expr, Failure, Pattern, SteepFunctions, TimeDependence, VectorField};

use crate::compiled::motion::Motion;
use crate::compiled::options::CompileOptions;
use crate::constraints::multipliers::Multipliers;
use crate::equations::canonical::Canonical;
use crate::equations::poincare::Equations;
use crate::error::{ForceError, MechError, ShapeError};
use crate::system::external_force::ExternalForce;

/// A [`Motion`] under external forces: ẏ = f(t, y, q(t, y)).
///
/// The forces are run-time inputs of the motion, like parameters, and come after them. So the Jacobian is ∂f/∂y +
/// ∂f/∂q ∂q/∂y, where only ∂q/∂y may be a [difference quotient](ExternalForce::jacobian). The Jacobian is full,
/// since its zero pattern is not known.
///
/// ```
/// use pc_mech::{Graph, System, VectorField};
///
/// let graph = Graph::new();
/// let pendulum = System::builder(&graph)
///     .coordinates(["φ"])
///     .lagrangian(|_, x, v| v[0].square() / 2.0 + x[0].cos())
///     .external_force(["φ'"])
///     .build()?;
/// let controller = |_: f64, y: &[f64], q: &mut [f64]| q[0] = 2.0 * y[0].sin() - y[1];
/// let mut motion = pendulum.poincare()?.compile_forced(controller)?;
/// let mut rate = [0.0; 2];
/// motion.rhs(0.0, &[0.5, 0.1], &mut rate)?;
/// assert_eq!(rate, [0.1, 0.5f64.sin() - 0.1]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct ForcedMotion<F> {
    motion: Motion,
    force: F,
    /// The quasi-velocities on which the forces act.
    names: Vec<String>,
    /// The number of parameters; the forces come after them.
    parameters: usize,
    /// q
    values: Vec<f64>,
    /// ∂q/∂y
    slopes: Vec<f64>,
    /// ∂f/∂(p, q)
    columns: Vec<f64>,
    pattern: Pattern,
}

impl Equations<'_> {
    /// Compiles the equations, their Jacobian and the observables, with `force` for the external forces.
    ///
    /// # Errors
    /// As for [`compile`](Equations::compile), and [`ForceError::NoneDeclared`] if no external force was declared.
    pub fn compile_forced<F: ExternalForce>(&self, force: F) -> Result<ForcedMotion<F>, MechError> {
        self.compile_forced_for(CompileOptions::default(), force)
    }

    /// Compiles as [`compile_forced`](Equations::compile_forced) does, with other derivatives or for another kernel.
    ///
    /// # Errors
    /// As for [`compile_forced`](Equations::compile_forced).
    pub fn compile_forced_for<F: ExternalForce>(
        &self,
        options: impl Into<CompileOptions>,
        force: F,
    ) -> Result<ForcedMotion<F>, MechError> {
        ForcedMotion::new(self.compile_for(derived(options.into()))?, self.system.external_forces(), force)
    }
}

impl Canonical<'_> {
    /// Compiles the equations as [`compile_for`](Canonical::compile_for) does, with `force` for the external forces;
    /// the force receives the state (x, y).
    ///
    /// # Errors
    /// As for [`Equations::compile_forced`].
    pub fn compile_forced_for<F: ExternalForce>(
        &self,
        options: impl Into<CompileOptions>,
        force: F,
    ) -> Result<ForcedMotion<F>, MechError> {
        ForcedMotion::new(self.compile_for(derived(options.into()))?, self.system().external_forces(), force)
    }
}

impl Multipliers<'_> {
    /// Compiles the equations as [`compile_for`](Multipliers::compile_for) does, with `force` for the external forces.
    ///
    /// # Errors
    /// As for [`Equations::compile_forced`].
    pub fn compile_forced_for<F: ExternalForce>(
        &self,
        options: impl Into<CompileOptions>,
        force: F,
    ) -> Result<ForcedMotion<F>, MechError> {
        let external = self.equations().system().external_forces();
        ForcedMotion::new(self.compile_for(derived(options.into()))?, external, force)
    }
}

/// The options, with ∂f/∂q added if a Jacobian needs it.
fn derived(options: CompileOptions) -> CompileOptions {
    options.parameter_jacobian(options.parameter_jacobian || options.jacobian || options.jvp)
}

impl Motion {
    /// The motion under the forces that `force` computes. The forces act on the quasi-velocities called
    /// `names`, those for which external forces were [declared](crate::SystemBuilder::external_force), in that
    /// order. It [keeps](Motion::keep) the same integrals. The new motion has a Jacobian if this one has, and
    /// also [one with respect to its parameters](CompileOptions::parameter_jacobian).
    ///
    /// # Errors
    /// [`ForceError::NoneDeclared`] without names; [`ShapeError`] for more names than the motion has inputs.
    pub fn forced<F: ExternalForce>(
        self,
        names: Vec<String>,
        force: F,
    ) -> Result<ForcedMotion<F>, MechError> {
        if names.is_empty() {
            return Err(ForceError::NoneDeclared.into());
        }
        let (dim, inputs, forces) = (self.dim(), self.parameters_len(), names.len());
        let what = "the list of external forces";
        let parameters = inputs.checked_sub(forces);
        let parameters = parameters.ok_or(ShapeError { what, found: forces, expected: inputs })?;
        Ok(ForcedMotion {
            force,
            names,
            parameters,
            values: vec![0.0; forces],
            slopes: vec![0.0; forces * dim],
            columns: vec![0.0; inputs * dim],
            pattern: Pattern::full(dim, dim),
            motion: Motion { switches: None, ..self }, // forces may jump, too
        })
    }
}

impl<F: ExternalForce> ForcedMotion<F> {
    fn new(motion: Motion, external: &[(String, Expr<'_>)], force: F) -> Result<ForcedMotion<F>, MechError> {
        motion.forced(external.iter().map(|(name, _)| name.clone()).collect(), force)
    }

    /// The motion as a function of the forces, which come after its parameters.
    pub fn motion(&self) -> &Motion {
        &self.motion
    }

    /// The external force.
    pub fn force(&self) -> &F {
        &self.force
    }

    /// Mutable access to the external force.
    pub fn force_mut(&mut self) -> &mut F {
        &mut self.force
    }

    /// The values of the parameters, in the order of declaration.
    pub fn parameters(&self) -> &[f64] {
        &self.motion.parameters()[..self.parameters]
    }

    /// Mutable access to the values of the parameters.
    pub fn parameters_mut(&mut self) -> &mut [f64] {
        &mut self.motion.parameters_mut()[..self.parameters]
    }

    /// The parameters, then the forces at (t, y): the run-time inputs of everything compiled from the system.
    ///
    /// # Errors
    /// [`ForceError::Failed`] and [`ForceError::NotFinite`].
    pub fn inputs(&mut self, t: f64, y: &[f64]) -> Result<&[f64], Failure> {
        self.apply(t, y)?;
        Ok(self.motion.parameters())
    }

    /// The derivatives ∂q/∂y of the forces at (t, y), column by column: that of force i by component j of the state is at i +
    /// j e for e forces.
    ///
    /// # Errors
    /// [`ForceError::Failed`] and [`ForceError::SlopeNotFinite`].
    pub fn force_jacobian(&mut self, t: f64, y: &[f64]) -> Result<&[f64], Failure> {
        self.find_slopes(t, y)?;
        Ok(&self.slopes)
    }

    /// The residual of each constraint at (t, y), as [`Motion::constraint_residuals`] gives it.
    ///
    /// # Panics
    /// If `y` does not have the length of the state.
    pub fn constraint_residuals(&mut self, t: f64, y: &[f64]) -> Vec<f64> {
        self.motion.constraint_residuals(t, y)
    }

    /// The observables at (t, y), as [`Motion::observe`] gives them; observables that contain a force that
    /// cannot be computed are not finite.
    ///
    /// # Panics
    /// If `y` does not have the length of the state.
    pub fn observe(&mut self, t: f64, y: &[f64]) -> Vec<f64> {
        let mut values = vec![f64::NAN; self.motion.observable_names().len()];
        self.observe_to(t, y, &mut values);
        values
    }

    /// Writes the observables at (t, y) to `values`, as [`observe`](ForcedMotion::observe) gives them.
    ///
    /// # Panics
    /// As for [`Motion::observe_to`].
    pub fn observe_to(&mut self, t: f64, y: &[f64], values: &mut [f64]) {
        match self.apply(t, y) {
            Ok(()) => self.motion.observe_to(t, y, values),
            Err(_) => self.observe_unforced_to(t, y, values),
        }
    }

    /// Writes the observables at (t, y) to `values` without computing the forces; observables that contain a
    /// force are not finite.
    ///
    /// # Panics
    /// As for [`Motion::observe_to`].
    pub fn observe_unforced_to(&mut self, t: f64, y: &[f64], values: &mut [f64]) {
        self.motion.inputs_mut(self.parameters).fill(f64::NAN);
        self.motion.watch(t, y, values, false);
    }

    /// Writes the residual of each constraint at (t, y), like [`Motion::constraint_residuals_to`].
    ///
    /// # Panics
    /// As there.
    pub fn constraint_residuals_to(&mut self, t: f64, y: &[f64], residuals: &mut [f64]) {
        self.motion.constraint_residuals_to(t, y, residuals);
    }

    /// Computes the forces and gives them to the motion.
    fn apply(&mut self, t: f64, y: &[f64]) -> Result<(), Failure> {
        self.values.fill(f64::NAN);
        let outcome = self.force.force(t, y, &mut self.values);
        outcome.map_err(|failure| self.failed(&failure, t))?;
        if let Some(i) = self.values.iter().position(|value| !value.is_finite()) {
            return Err(Failure::recoverable(MechError::Force(ForceError::NotFinite {
                quasi_velocity: self.names[i].clone(),
                value: self.values[i],
                t,
                state: self.state(y),
            })));
        }
        self.motion.inputs_mut(self.parameters).copy_from_slice(&self.values);
        Ok(())
    }

    /// Computes ∂q/∂y and ∂f/∂(p, q).
    fn differentiate(&mut self, t: f64, y: &[f64]) -> Result<(), Failure> {
        self.find_slopes(t, y)?;
        self.motion.parameter_jacobian(t, y, &mut self.columns)
    }

    /// Computes ∂q/∂y.
    fn find_slopes(&mut self, t: f64, y: &[f64]) -> Result<(), Failure> {
        self.slopes.fill(f64::NAN);
        let outcome = self.force.jacobian(t, y, &mut self.slopes);
        outcome.map_err(|failure| self.failed(&failure, t))?;
        if let Some(i) = self.slopes.iter().position(|value| !value.is_finite()) {
            let (quasi_velocity, by) = (i % self.names.len(), i / self.names.len());
            return Err(Failure::recoverable(MechError::Force(ForceError::SlopeNotFinite {
                quasi_velocity: self.names[quasi_velocity].clone(),
                by: self.motion.component_name(by),
                value: self.slopes[i],
                t,
                state: self.state(y),
            })));
        }
        Ok(())
    }

    /// The columns of ∂f/∂q, one after the other.
    fn by_forces(&self) -> impl Iterator<Item = &[f64]> {
        self.columns.chunks_exact(self.motion.dim()).skip(self.parameters)
    }

    /// The state with its names.
    fn state(&self, y: &[f64]) -> Vec<(String, f64)> {
        self.motion.names().iter().cloned().zip(y.iter().copied()).collect()
    }

    #[cold]
    fn failed(&self, failure: &Failure, t: f64) -> Failure {
        let quasi_velocities = self.names.clone();
        let error = MechError::Force(ForceError::Failed { quasi_velocities, t, cause: failure.to_string() });
        if failure.is_recoverable() { Failure::recoverable(error) } else { Failure::fatal(error) }
    }
}

impl<F: ExternalForce> VectorField for ForcedMotion<F> {
    fn dim(&self) -> usize {
        self.motion.dim()
    }

    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        self.apply(t, y)?;
        self.motion.rhs(t, y, ydot)
    }

    fn checks_rates(&self) -> bool {
        self.motion.checks_rates()
    }

    fn has_jacobian(&self) -> bool {
        self.motion.has_jacobian() && self.motion.has_parameter_jacobian()
    }

    fn jacobian(&mut self, t: f64, y: &[f64], jacobian: &mut [f64]) -> Result<(), Failure> {
        self.apply(t, y)?;
        self.motion.jacobian(t, y, jacobian)?;
        self.differentiate(t, y)?;
        let slopes = self.slopes.chunks_exact(self.names.len());
        for (column, slopes) in jacobian.chunks_exact_mut(y.len()).zip(slopes) {
            for (by_force, slope) in self.by_forces().zip(slopes) {
                column.iter_mut().zip(by_force).for_each(|(entry, by_force)| *entry += by_force * slope);
            }
        }
        Ok(())
    }

    fn sparsity(&self) -> Option<&Pattern> {
        self.motion.has_jacobian().then_some(&self.pattern)
    }

    /// The pattern is full, so sparse and dense storage are the same.
    fn sparse_jacobian(&mut self, t: f64, y: &[f64], values: &mut [f64]) -> Result<(), Failure> {
        self.jacobian(t, y, values)
    }

    fn has_jvp(&self) -> bool {
        self.motion.has_jvp() && self.motion.has_parameter_jacobian()
    }

    fn jvp(&mut self, t: f64, y: &[f64], v: &[f64], product: &mut [f64]) -> Result<(), Failure> {
        self.apply(t, y)?;
        self.motion.jvp(t, y, v, product)?;
        self.differentiate(t, y)?;
        for (i, by_force) in self.by_forces().enumerate() {
            let slopes = self.slopes.iter().skip(i).step_by(self.names.len());
            let change: f64 = slopes.zip(v).map(|(slope, v)| slope * v).sum();
            product.iter_mut().zip(by_force).for_each(|(entry, by_force)| *entry += by_force * change);
        }
        Ok(())
    }

    fn parameters_len(&self) -> usize {
        self.parameters
    }

    fn has_parameter_jacobian(&self) -> bool {
        self.motion.has_parameter_jacobian()
    }

    fn parameter_jacobian(&mut self, t: f64, y: &[f64], jacobian: &mut [f64]) -> Result<(), Failure> {
        self.apply(t, y)?;
        self.motion.parameter_jacobian(t, y, &mut self.columns)?;
        jacobian.copy_from_slice(&self.columns[..jacobian.len()]);
        Ok(())
    }

    fn parameter_size(&self, j: usize) -> Option<f64> {
        self.motion.parameter_size(j)
    }

    fn has_projection(&self) -> bool {
        self.motion.has_projection()
    }

    fn project(&mut self, t: f64, y: &mut [f64]) -> Result<(), Failure> {
        self.motion.project(t, y)
    }

    fn time_dependence(&self) -> TimeDependence {
        self.motion.time_dependence().with_unknown()
    }

    fn steep_functions(&self) -> Option<SteepFunctions> {
        self.motion.steep_functions()
    }

    fn restart(&mut self, t: f64, y: &[f64]) {
        self.motion.restart(t, y);
    }

    fn breaks(&self) -> &[f64] {
        self.motion.breaks()
    }

    fn enter(&mut self, t: f64, end: f64) -> bool {
        self.motion.enter(t, end)
    }

    fn jumps(&self) -> &[pc_expr::RateJump] {
        self.motion.jumps()
    }

    fn leads(&mut self, from: (f64, &[f64]), to: (f64, &[f64])) -> Result<(), Failure> {
        let ForcedMotion { motion, force, parameters, values, .. } = self;
        let mut rates = |motion: &mut Motion, t: f64, y: &[f64], rates: &mut [f64]| {
            force.force(t, y, values)?;
            motion.inputs_mut(*parameters).copy_from_slice(values);
            motion.rhs(t, y, rates)
        };
        motion.leads_by(from, to, &mut rates)
    }

    fn component_name(&self, i: usize) -> String {
        self.motion.component_name(i)
    }
}
