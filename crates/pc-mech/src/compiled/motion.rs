//! Compiled equations of motion: a vector field with its derivatives, and the quantities observed along it.

use pc_algebra::Matrix;
use pc_expr::{
    Cost, Digest, Evaluator, Expr, Failure, Method, Pattern, Program, RateJump, VariedSeries, VectorField,
};
use serde::{Deserialize, Serialize};

use crate::compiled::change_point::watch::Watch;
use crate::compiled::chart::Chart;
use crate::compiled::elimination::numeric::{OF_A_LOOP, Staged};
use crate::compiled::elimination::observed::{By, OF_OBSERVABLES};
use crate::compiled::elimination::schur::Schur;
use crate::compiled::elimination::symbolic::Unrolled;
use crate::compiled::failure::EvaluationFailure;
use crate::compiled::holds::Holds;
use crate::compiled::legendre_transform::LegendreTransform;
use crate::compiled::machine_code::MachineCode;
use crate::compiled::options::{CompileOptions, TreeElimination};
use crate::compiled::point::Point;
use crate::compiled::projection::constraint_manifold::Surface;
use crate::compiled::projection::integrals::KeptIntegrals;
use crate::compiled::projection::unit_quaternions::UnitQuaternions;
use crate::compiled::surface_slopes::SurfaceSlopes;
use crate::error::MechError;
use crate::system::signals::Signals;
use crate::system::system::System;

/// The compiled first-order system ẏ = f(t, y) for y = (x, η, z), which owns its data and is independent of the
/// graph.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Motion {
    /// The names of the n coordinates, then of the k quasi-velocities or momenta, then of the first-order
    /// states.
    pub(super) names: Vec<String>,
    pub(super) coordinates: usize,
    pub(super) states: usize,
    /// The unknowns to which pivots of M belong: quasi-velocities, then constraints.
    pub(super) quasi_velocities: Vec<String>,
    pub(super) parameters: Vec<f64>,
    pub(super) form: Form,
    pub(super) options: CompileOptions,
    pub(super) observable_names: Vec<String>,
    pub(super) conserved: usize,
    /// The names of the constraints, and the surface where they hold.
    pub(super) constraints: Vec<String>,
    pub(super) surface: Option<Box<Surface>>,
    pub(super) kept: Option<Box<KeptIntegrals>>,
    pub(super) quaternions: UnitQuaternions,
    pub(super) signals: Signals,
    /// The conditions under which the state determines velocities.
    pub(super) charts: Vec<Chart>,
    /// How far the constraints are from losing rank, and the motion across a state where they do.
    pub(super) watch: Watch,
    /// The surfaces on which f jumps, if derivatives were compiled.
    pub(super) jumps: Vec<RateJump>,
    /// The motion held on one side of each surface between pieces, if f is piecewise.
    pub(super) switches: Option<Box<Switches>>,
}

/// How f is computed.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) enum Form {
    Unrolled(Box<Unrolled>),
    Staged(Box<Staged>),
    InMomenta(Box<InMomenta>),
}

/// The motion of (x, y), y = p(t, x, η) = ∂L/∂η, derived from that of (x, η), where η solves
///
///   M η − Cᵀ μ = y − p_0,   C η = −c_0,
///
/// or p − Cᵀ μ = y, g = 0, which satisfies the constraints and is regular wherever the constraints are (μ = 0
/// where they hold),
///
///   ẏ = ∂p/∂t + (∂p/∂x) ẋ + (∂p/∂z) ż + M η̇ = (c_rs^m η_r + c_0s^m) y_m + X_s L + Q_s + C_αs λ_α.
///
/// In both motions the first-order states z come last.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct InMomenta {
    pub(super) transform: LegendreTransform,
    pub(super) inner: Box<Motion>,
    pub(super) quasi_velocities: usize,
    /// ẏ from (t, (x, η, z, η̇)).
    pub(super) transport: Evaluator,
    /// The derivatives with respect to x and z and, if compiled, to the parameters and t.
    pub(super) jacobian: Option<Slopes>,
    pub(super) parameter_jacobian: Option<Slopes>,
    pub(super) time_derivative: Option<Slopes>,
    /// x, η, z, then η̇.
    pub(super) known: Vec<f64>,
    pub(super) full: Pattern,
    /// Storage for the last x, η, z that were read, for their projection, and for the rates of both motions.
    pub(super) state: Vec<f64>,
    pub(super) projected: Vec<f64>,
    pub(super) rates: Vec<f64>,
    /// The derivative of (ẋ, η̇, ż) with respect to (x, η, z), column by column.
    pub(super) of_inner: Vec<f64>,
}

/// Computes derivatives with respect to symbols q, from (t, (x, η, z, η̇)): the columns of ∂ẏ/∂q and (−∂p/∂q,
/// ∂g/∂q) one after the other; then those of ∂ẏ/∂η and of M.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Slopes {
    pub(super) symbols: usize,
    pub(super) multipliers: usize,
    pub(super) entries: Evaluator,
    pub(super) values: Vec<f64>,
    /// The derivatives of (ẋ, η̇, ż) with respect to q at fixed (x, η, z), those of (η, μ) with respect to q and y,
    /// and those of (ẋ, ẏ, ż) with respect to both.
    pub(super) by_symbol: Vec<f64>,
    pub(super) of_unknowns: Vec<f64>,
    pub(super) columns: Vec<f64>,
}

/// The surfaces between the pieces of a motion, and the motion on given sides of them.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Switches {
    /// The functions that vanish on the surfaces, as text.
    pub(super) names: Vec<String>,
    /// The motion with the sides as further parameters, which come after the parameters of the system.
    pub(super) motion: Box<Motion>,
    /// g from (t, y, p, sides).
    pub(super) functions: Evaluator,
    pub(super) slopes: SurfaceSlopes,
    /// Whether g contains inputs given by tables.
    pub(super) follows_tables: bool,
    /// The motion on sides between −1 and 1, for observables that depend on the side.
    pub(super) observing: Option<Box<Motion>>,
    /// What holds the motion on each surface.
    pub(super) holds: Holds,
    /// The sides on which the motion is held, if it is held.
    pub(super) sides: Option<Vec<f64>>,
    /// The motion along these surfaces, made on first use.
    #[serde(skip)]
    pub(super) along: Option<Along>,
}

/// The Taylor series of the motion along surfaces.
#[derive(Clone, Debug)]
pub(super) struct Along {
    pub(super) surfaces: Vec<usize>,
    pub(super) program: Program,
    pub(super) series: VariedSeries,
}

impl Motion {
    /// Names of the components of the state: coordinates, then quasi-velocities or momenta, then first-order states.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Number n of coordinates, which come first in the state.
    pub fn coordinates(&self) -> usize {
        self.coordinates
    }

    /// Number of first-order states, which come last in the state.
    pub fn states(&self) -> usize {
        self.states
    }

    /// The values of the parameters, in the order of declaration.
    pub fn parameters(&self) -> &[f64] {
        match &self.form {
            Form::InMomenta(motion) => motion.inner().parameters(),
            Form::Unrolled(_) | Form::Staged(_) => &self.parameters,
        }
    }

    /// Mutable access to the values of the parameters.
    pub fn parameters_mut(&mut self) -> &mut [f64] {
        self.watch.forget();
        match &mut self.form {
            Form::InMomenta(motion) => return motion.inner_mut().parameters_mut(),
            Form::Unrolled(unrolled) => unrolled.forget(),
            Form::Staged(_) => {}
        }
        &mut self.parameters
    }

    /// Mutable access to the values, from index `first` on, of inputs on which M does not depend, such as
    /// external forces.
    pub(crate) fn inputs_mut(&mut self, first: usize) -> &mut [f64] {
        match &mut self.form {
            Form::InMomenta(motion) => motion.inner_mut().inputs_mut(first),
            Form::Unrolled(_) | Form::Staged(_) => &mut self.parameters[first..],
        }
    }

    /// The motion in quasi-velocities from which a motion in momenta under constraints is derived; for any
    /// other motion, the motion itself.
    pub fn in_quasi_velocities(&self) -> &Motion {
        match &self.form {
            Form::InMomenta(motion) => motion.inner(),
            Form::Unrolled(_) | Form::Staged(_) => self,
        }
    }

    /// The same motion with the values of some of its parameters read from tables at each evaluation. No step
    /// of an integrator crosses the times in these tables.
    ///
    /// ```
    /// use std::sync::Arc;
    ///
    /// use pc_mech::{Graph, Interpolation, Signals, System, Table, VectorField};
    ///
    /// let graph = Graph::new();
    /// let pull = graph.symbol("pull");
    /// let point = System::builder(&graph)
    ///     .signal(pull, 0.0)
    ///     .coordinates(["x"])
    ///     .kinetic(|_, _, v| v[0].square() / 2.0)
    ///     .forces(|_, _, _| [pull])
    ///     .build()?;
    /// let table = Table::new(vec![0.0, 2.0], vec![0.0, 6.0], Interpolation::Linear)?;
    /// let signals = Signals::new([("pull", 0, Arc::new(table))]);
    /// let mut motion = point.poincare()?.compile()?.driven_by(signals);
    /// let mut rates = [0.0; 2];
    /// motion.rhs(0.5, &[0.0, 1.0], &mut rates)?;
    /// assert_eq!(rates, [1.0, 1.5]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Panics
    /// If one of the indices is not the index of a parameter.
    #[must_use]
    pub fn driven_by(mut self, signals: Signals) -> Motion {
        assert!(signals.places().all(|place| place < self.parameters().len()), "places of parameters");
        if let Some(switches) = &mut self.switches {
            switches.drive(&signals);
        }
        match &mut self.form {
            Form::InMomenta(motion) => motion.inner_mut().signals = signals,
            Form::Unrolled(unrolled) => {
                unrolled.vary(&signals.places().collect::<Vec<_>>(), self.options.backend, self.names.len());
                self.signals = signals;
            }
            Form::Staged(_) => self.signals = signals,
        }
        self
    }

    /// The tables by which the motion is driven.
    pub fn signals(&self) -> &Signals {
        &self.in_quasi_velocities().signals
    }

    /// Names of the observables: the integrals, `energy`, the outputs.
    pub fn observable_names(&self) -> &[String] {
        &self.observable_names
    }

    /// Number of observables that the motion should keep constant, the integrals and the energy, which come first.
    pub fn conserved_len(&self) -> usize {
        self.conserved
    }

    /// The observables at (t, y), as many as [`observable_names`](Motion::observable_names); not finite where a table
    /// that it is [driven by](Motion::driven_by) has no value. Where the motion slides along a surface on which its
    /// rates jump, the observables are those of [Filippov's combination](pc_expr::Sliding).
    ///
    /// # Panics
    /// If `y` does not have the length of the state.
    pub fn observe(&mut self, t: f64, y: &[f64]) -> Vec<f64> {
        let mut values = vec![f64::NAN; self.observable_names.len()];
        self.observe_to(t, y, &mut values);
        values
    }

    /// Writes the observables at (t, y) to `values`, as [`observe`](Motion::observe) gives them.
    ///
    /// # Panics
    /// If `y` does not have the length of the state, or `values` not that of
    /// [`observable_names`](Motion::observable_names).
    pub fn observe_to(&mut self, t: f64, y: &[f64], values: &mut [f64]) {
        self.watch(t, y, values, true);
    }

    /// Writes the derivatives ∂h/∂y of the observables h(t, y), column by column: that of observable i by component j
    /// is at i + j o, where o is the number of [observables](Motion::observable_names). In observables with accelerations or
    /// reactions these change with the state. An entry is not finite where its observable has no derivative, as that of a
    /// speed at rest, or no value. The derivatives are those on one side of surfaces where rates jump.
    ///
    /// # Errors
    /// [`EvaluationError::NotCompiled`](crate::EvaluationError::NotCompiled) unless they were
    /// [compiled](CompileOptions::observable_jacobian).
    ///
    /// # Panics
    /// If a length is wrong.
    pub fn observable_jacobian(&mut self, t: f64, y: &[f64], entries: &mut [f64]) -> Result<(), Failure> {
        self.observed_slopes(By::State, (t, y), entries, y.len())
    }

    /// Writes the derivatives ∂h/∂p of the observables by the parameters, followed by those by the external forces, column
    /// by column, as [`observable_jacobian`](Motion::observable_jacobian) writes ∂h/∂y.
    ///
    /// # Errors
    /// As there.
    ///
    /// # Panics
    /// As there.
    pub fn observable_parameter_jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        entries: &mut [f64],
    ) -> Result<(), Failure> {
        let columns = self.parameters().len();
        self.observed_slopes(By::Parameters, (t, y), entries, columns)
    }

    fn observed_slopes(
        &mut self,
        by: By,
        (t, y): (f64, &[f64]),
        entries: &mut [f64],
        columns: usize,
    ) -> Result<(), Failure> {
        assert_eq!(y.len(), self.names.len(), "length of the state");
        assert_eq!(entries.len(), self.observable_names.len() * columns, "length of the derivatives");
        if self.signals.show(t, &mut self.parameters).is_err() {
            entries.fill(f64::NAN);
            return Ok(());
        }
        let at = Point { t, y, p: &self.parameters };
        let is_known = match &mut self.form {
            Form::Unrolled(unrolled) => {
                unrolled.observed_slopes().map(|slopes| slopes.eval(by, at, entries)).is_some()
            }
            Form::Staged(staged) => staged.observed_slopes(by, at, entries),
            Form::InMomenta(motion) => return motion.observed_slopes(by, (t, y), entries),
        };
        match is_known {
            true => Ok(()),
            false => Err(self.failure(EvaluationFailure::NotCompiled { what: OF_OBSERVABLES }, t, y)),
        }
    }

    /// The observables on the side of each surface that the signs at y indicate, even where the motion slides along
    /// the surface; the signs may then be due to rounding errors.
    ///
    /// # Panics
    /// As for [`observe`](Motion::observe).
    pub fn observe_beside(&mut self, t: f64, y: &[f64]) -> Vec<f64> {
        let mut values = vec![f64::NAN; self.observable_names.len()];
        self.watch_beside(t, y, &mut values, true);
        values
    }

    /// Writes the observables. Unless `solved`, accelerations are not computed, and observables that contain
    /// an acceleration are not finite.
    pub(crate) fn watch(&mut self, t: f64, y: &[f64], values: &mut [f64], solved: bool) {
        assert_eq!(y.len(), self.names.len(), "length of the state");
        assert_eq!(values.len(), self.observable_names.len(), "number of observables");
        let known = self.signals.show(t, &mut self.parameters).is_ok();
        if known
            && solved
            && let Some(switches) = &mut self.switches
        {
            switches.follow(&self.parameters);
            if switches.observe(t, y, values) {
                return;
            }
        }
        self.watch_beside(t, y, values, solved);
    }

    fn watch_beside(&mut self, t: f64, y: &[f64], values: &mut [f64], solved: bool) {
        if self.signals.show(t, &mut self.parameters).is_err() {
            return values.fill(f64::NAN);
        }
        match &mut self.form {
            Form::Unrolled(unrolled) => unrolled.observe(t, y, &self.parameters, values),
            Form::Staged(staged) => staged.observe((t, y, &self.parameters), values, solved),
            Form::InMomenta(motion) => motion.observe(t, y, values, solved),
        }
    }

    /// The motion restricted to where its state determines the velocities of `system`. It does not
    /// [lead](VectorField::leads) past a state where velocities and the quasi-velocities defined by them no
    /// longer determine each other.
    ///
    /// # Errors
    /// [`MechError`] if the frame contains a symbol that is neither a coordinate nor a parameter.
    pub fn within_chart(self, system: &System<'_>) -> Result<Motion, MechError> {
        Ok(Motion { charts: Chart::of(system)?.into_iter().collect(), ..self })
    }

    /// The motion in other quasi-velocities η' = A η + A_0, with A for all quasi-velocities of the system, in
    /// order; the new motion also does not lead past a state where η' does not determine η.
    ///
    /// # Errors
    /// As there.
    pub fn within_chart_of_change<'g>(
        self,
        system: &System<'g>,
        change: &Matrix<Expr<'g>>,
    ) -> Result<Motion, MechError> {
        Ok(Motion { charts: Chart::of_change(system, change)?.into_iter().collect(), ..self })
    }

    /// The motion in independent quasi-velocities of a system; the new motion also does not lead past a state
    /// where this square matrix, through which constraints determine the others, is singular.
    ///
    /// # Errors
    /// As there.
    pub fn within_choice<'g>(
        mut self,
        system: &System<'g>,
        square: &Matrix<Expr<'g>>,
    ) -> Result<Motion, MechError> {
        self.charts.extend(Chart::watching(system, square)?);
        Ok(self)
    }

    /// The motion whose momenta have these names.
    pub(crate) fn of_momenta(mut motion: InMomenta, names: impl Iterator<Item = String>) -> Motion {
        motion.inner_mut().switches = None; // those of the momenta are not derived
        let inner = motion.inner();
        Motion {
            names: inner.names[..inner.coordinates]
                .iter()
                .cloned()
                .chain(names)
                .chain(inner.names[inner.names.len() - inner.states..].iter().cloned())
                .collect(),
            coordinates: inner.coordinates,
            states: inner.states,
            quasi_velocities: inner.quasi_velocities.clone(),
            parameters: Vec::new(),
            signals: Signals::default(),
            charts: Vec::new(),
            watch: Watch::default(),
            jumps: inner.jumps.clone(),
            switches: None,
            options: inner.options,
            observable_names: inner.observable_names.clone(),
            conserved: inner.conserved,
            constraints: inner.constraints.clone(),
            surface: None,
            kept: None,
            quaternions: inner.quaternions.clone(),
            form: Form::InMomenta(Box::new(motion)),
        }
    }

    /// The parts of a motion whose state contains momenta under constraints.
    pub(crate) fn in_momenta(&mut self) -> Option<&mut InMomenta> {
        match &mut self.form {
            Form::InMomenta(motion) => Some(motion),
            Form::Unrolled(_) | Form::Staged(_) => None,
        }
    }

    /// The motion with accelerations and reactions computed by `schur`, if that takes fewer operations or the
    /// options choose it.
    pub(crate) fn by_joints(mut self, schur: Schur) -> Motion {
        self.form = match self.form {
            Form::Staged(staged)
                if self.options.elimination == TreeElimination::ByJoints
                    || schur.operations(OF_A_LOOP) < staged.operations() =>
            {
                Form::Staged(Box::new(staged.by_joints(schur)))
            }
            form => form,
        };
        self
    }

    /// The motion under the constraints with these names.
    pub(crate) fn on_surface(self, constraints: Vec<String>, surface: Surface) -> Motion {
        Motion { constraints, surface: Some(Box::new(surface)), ..self }
    }

    /// Makes the motion project onto the values of these integrals from now on; returns the previous
    /// integrals.
    pub(crate) fn set_kept(&mut self, integrals: Option<KeptIntegrals>) -> Option<KeptIntegrals> {
        if let Form::InMomenta(motion) = &mut self.form {
            return motion.inner_mut().set_kept(integrals);
        }
        std::mem::replace(&mut self.kept, integrals.map(Box::new)).map(|kept| *kept)
    }

    /// A number that distinguishes this motion from motions with other equations or names: a digest of the names of
    /// states, parameters and constraints, and of the programs of f. It is the same on every run, whatever the values
    /// of the parameters.
    pub fn digest(&self) -> u64 {
        let mut digest = Digest::default();
        self.add_to(&mut digest);
        digest.value()
    }

    fn add_to(&self, digest: &mut Digest) {
        self.names.iter().chain(&self.constraints).for_each(|name| digest.name(name));
        match &self.form {
            Form::Unrolled(unrolled) => unrolled.programs().for_each(|program| digest.program(program)),
            Form::Staged(staged) => staged.programs().for_each(|program| digest.program(program)),
            Form::InMomenta(motion) => {
                motion.inner().add_to(digest);
                digest.program(motion.transport.program());
            }
        }
    }

    /// The number of operations of one evaluation of the right-hand side, kinematics included. The number
    /// excludes the factorisation if M is factorised numerically, and includes one iteration if y = ∂L/∂η is
    /// solved for η by Newton's method.
    pub fn cost(&self) -> Cost {
        match &self.form {
            Form::Unrolled(unrolled) => unrolled.cost(self.names.len()),
            Form::Staged(staged) => staged.cost().clone(),
            Form::InMomenta(motion) => motion.inner().cost(),
        }
    }

    /// Compiles what a method evaluates besides f, so that clones made afterwards share it; otherwise it is compiled on
    /// first use, by each clone. Where a method is not defined for this motion, nothing is compiled.
    pub fn prepare(&mut self, method: Method) {
        self.charts.iter_mut().for_each(Chart::prepare);
        match (method, &mut self.form) {
            (Method::Taylor, _) => {
                // The method gives the reason where there is no series.
                let _ = self.series();
            }
            (Method::Bdf, Form::Unrolled(unrolled)) => unrolled.prepare_jacobian(),
            _ => {}
        }
    }

    /// The machine code of f; none if f consists of more than one program of (t, y, p), reads tables, or is
    /// interpreted.
    pub fn machine_code(&mut self) -> Option<MachineCode> {
        match &mut self.form {
            Form::Unrolled(unrolled) if self.signals.is_empty() => unrolled.machine_code(self.names.len()),
            Form::Unrolled(_) | Form::Staged(_) | Form::InMomenta(_) => None,
        }
    }

    /// The parameters of [`machine_code`](Motion::machine_code), for the current values: the parameters of the
    /// motion, and results that depend on them alone. `None` if M is factorised numerically.
    pub fn code_parameters(&mut self) -> Option<&[f64]> {
        match &mut self.form {
            Form::Unrolled(unrolled) => Some(unrolled.code_parameters(&self.parameters)),
            Form::Staged(_) | Form::InMomenta(_) => None,
        }
    }

    /// The pivots of M that do not depend on the state, for the current parameters, as [`MachineCode::is_regular`]
    /// expects them. None if M is factorised numerically.
    pub fn fixed_pivots(&mut self) -> Option<&[f64]> {
        match &mut self.form {
            Form::Unrolled(unrolled) => Some(unrolled.fixed_pivots(self.names.len(), &self.parameters)),
            Form::Staged(_) | Form::InMomenta(_) => None,
        }
    }

    /// The program whose first outputs are ẏ; none if M is factorised numerically.
    pub(super) fn program_of_rates(&self) -> Option<&Program> {
        match &self.form {
            Form::Unrolled(unrolled) => unrolled.programs().next(),
            Form::Staged(_) | Form::InMomenta(_) => None,
        }
    }

    /// Whether M is factorised numerically.
    #[cfg(test)]
    pub(crate) fn is_staged(&self) -> bool {
        matches!(self.form, Form::Staged(_))
    }

    /// Computes ẏ with each component of the state, and each number in the equations if these are solved
    /// numerically, multiplied by the next value of `factor`.
    pub(crate) fn perturbed_rates(
        &mut self,
        t: f64,
        y: &[f64],
        mut factor: impl FnMut() -> f64,
    ) -> Result<(Vec<f64>, Vec<f64>), MechError> {
        // Constraints mix velocities: the remainder of one velocity may be a rounding error of the largest.
        let moving = self.coordinates()..y.len() - self.states();
        let fastest = y[moving.clone()].iter().fold(0.0f64, |fastest, eta| fastest.max(eta.abs()));
        let least = |i: usize| if moving.contains(&i) { fastest } else { 0.0 };
        let by = |(i, &y): (usize, &f64)| y + (factor() - 1.0) * y.abs().max(least(i));
        let state: Vec<f64> = y.iter().enumerate().map(by).collect();
        let mut rates = vec![0.0; y.len()];
        let outcome = match &mut self.form {
            Form::Staged(staged) => {
                staged.perturbed_rhs(Point { t, y: &state, p: &self.parameters }, &mut rates, factor)
            }
            Form::Unrolled(_) | Form::InMomenta(_) => {
                self.rhs(t, &state, &mut rates)?;
                Ok(())
            }
        };
        outcome.map_err(|failure| MechError::from(self.failure(failure, t, &state)))?;
        Ok((state, rates))
    }

    #[cold]
    pub(crate) fn failure(&self, failure: EvaluationFailure, t: f64, y: &[f64]) -> Failure {
        let fatal = matches!(failure, EvaluationFailure::NotCompiled { .. });
        let error = failure.at(&self.quasi_velocities, t, &self.names, y);
        if fatal { Failure::fatal(error) } else { Failure::recoverable(error) }
    }
}
