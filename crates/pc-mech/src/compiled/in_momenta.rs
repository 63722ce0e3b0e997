//! Motions under constraints whose state consists of coordinates and momenta.

use std::ops::Range;

use pc_expr::{
    Backend, Evaluator, Expr, ExprError, Failure, Inputs, Pattern, Program, SteepFunctions, TimeDependence,
    VectorField,
};

use crate::compiled::elimination::columns::derivative;
use crate::compiled::elimination::observed::{By, OF_OBSERVABLES};
use crate::compiled::failure::check_finite;
use crate::compiled::legendre_transform::LegendreTransform;
use crate::compiled::motion::{InMomenta, Motion, Slopes};
use crate::compiled::options::CompileOptions;
use crate::compiled::point::Point;
use crate::constraints::multipliers::Multipliers;
use crate::error::{EvaluationError, MechError};

impl Multipliers<'_> {
    /// Compiles the canonical equations with multipliers as a vector field of the state (x, y) with the momenta
    /// y_s = ∂L/∂η_s of all quasi-velocities, named like
    /// [`System::momentum_symbols`](crate::System::momentum_symbols):
    ///
    ///   ẏ_s = (c_rs^m η_r + c_0s^m) y_m + X_s L + Q_s + C_αs λ_α,   ẋ = b η + b_0,   C η + c_0 = 0.
    ///
    /// No velocities are chosen as independent, so a position is singular only where the constraints themselves are
    /// singular. The projection, the observables and the [kept](Motion::keep) integrals are the same as with
    /// [`compile_for`](Multipliers::compile_for); integrals to be kept must be integrals of the equations with these
    /// multipliers. Products with the Jacobian are not available.
    ///
    /// `guess` is the η from which the solution of y = ∂L/∂η starts, where L is not quadratic in η or a
    /// constraint is not affine.
    ///
    /// ```
    /// use pc_mech::{Constraint, Graph, System, VectorField};
    ///
    /// // A pendulum of mass 2 in Cartesian coordinates, in a horizontal position.
    /// let graph = Graph::new();
    /// let pendulum = System::builder(&graph)
    ///     .coordinates(["x", "y"])
    ///     .lagrangian(|_, x, v| v[0].square() + v[1].square() - 20.0 * x[1])
    ///     .build()?;
    /// let [x, y] = graph.symbols(["x", "y"]);
    /// let circle = Constraint::new("length", x.square() + y.square() - 1.0);
    /// let held = pendulum.with_multipliers(&[circle])?;
    /// let mut motion = held.compile_in_momenta(Default::default(), &[0.0, 0.0])?;
    /// let mut rates = [0.0; 4];
    /// motion.rhs(0.0, &[1.0, 0.0, 0.0, 4.0], &mut rates)?; // ẏ = 2: ẍ = −|ṙ|²
    /// assert_eq!(rates, [0.0, 2.0, -8.0, -20.0]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As for [`compile_for`](Multipliers::compile_for); [`ShapeError`](crate::ShapeError) for a guess of the wrong
    /// length.
    pub fn compile_in_momenta(&self, options: CompileOptions, guess: &[f64]) -> Result<Motion, MechError> {
        let motion = InMomenta::new(self, self.legendre_transform(guess)?, &options)?;
        let momenta = self.equations.system.momentum_symbols();
        Ok(Motion::of_momenta(motion, momenta.iter().map(Expr::to_string)))
    }
}

impl InMomenta {
    /// # Errors
    /// [`MechError::Expr`] for a symbol that is neither state nor declared parameter.
    pub(crate) fn new<'g>(
        multipliers: &Multipliers<'g>,
        transform: LegendreTransform,
        options: &CompileOptions,
    ) -> Result<InMomenta, MechError> {
        let system = multipliers.equations().system();
        let (graph, x, eta) = (system.graph(), system.frame().coordinates(), system.quasi_velocities());
        let accelerations = system.accelerations();
        let velocities = system.frame().velocities(eta);
        let along: Vec<_> = x
            .iter()
            .copied()
            .zip(velocities)
            .chain(eta.iter().copied().zip(accelerations.iter().copied()))
            .chain(graph.in_time(system.frame().time()))
            .chain(system.states().iter().copied())
            .collect();
        let parameters: Vec<Expr<'g>> =
            system.run_time_inputs().into_iter().map(|(symbol, _)| symbol).collect();
        let inputs = Inputs {
            time: Some(system.frame().time()),
            state: [system.state(), accelerations.clone()].concat(),
            parameters: parameters.clone(),
        };
        let momenta = system.momenta();
        let rates = graph.shorten(&graph.directional(&momenta, &along), &system.collecting_order());
        let slopes = |symbols: &[Expr<'g>]| {
            let negative: Vec<_> = momenta.iter().map(|&p| -p).collect();
            let balance = [negative.as_slice(), multipliers.velocities()].concat();
            let by = |functions: &[Expr<'g>], symbol: Expr<'g>| {
                graph.directional(functions, &[(symbol, Expr::ONE)])
            };
            let columns = symbols.iter().flat_map(|&q| [by(&rates, q), by(&balance, q)].concat());
            let moving = eta.iter().chain(&accelerations).flat_map(|&eta| by(&rates, eta));
            let entries: Vec<Expr<'g>> = columns.chain(moving).collect();
            let (columns, bound) = (symbols.len() + eta.len(), multipliers.constraints().len());
            Ok::<_, ExprError>(Slopes {
                symbols: symbols.len(),
                multipliers: bound,
                values: vec![0.0; entries.len()],
                entries: derivative(graph, &inputs, &entries, options.backend)?,
                by_symbol: Vec::new(),
                of_unknowns: vec![0.0; columns * (eta.len() + bound)],
                columns: vec![0.0; columns * system.state().len()],
            })
        };
        let states = system.states().iter().map(|&(z, _)| z);
        let unmoved: Vec<Expr<'g>> = x.iter().copied().chain(states).collect();
        let dim = unmoved.len() + eta.len();
        Ok(InMomenta {
            inner: Box::new(multipliers.compile_for(CompileOptions { jvp: false, ..*options })?),
            transport: Evaluator::new(Program::new(graph, &inputs, &rates)?, Backend::Interpreter),
            jacobian: options.jacobian.then(|| slopes(&unmoved)).transpose()?,
            parameter_jacobian: (options.jacobian
                && (options.parameter_jacobian || options.observable_jacobian))
                .then(|| slopes(&parameters))
                .transpose()?,
            time_derivative: (options.jacobian && options.time_derivative)
                .then(|| slopes(&[system.frame().time()]))
                .transpose()?,
            quasi_velocities: eta.len(),
            known: vec![0.0; dim + eta.len()],
            full: Pattern::full(dim, dim),
            state: vec![0.0; dim],
            projected: vec![0.0; dim],
            rates: vec![0.0; dim],
            of_inner: vec![0.0; dim * dim],
            transform,
        })
    }

    /// The motion of (x, η, z).
    pub(crate) fn inner(&self) -> &Motion {
        &self.inner
    }

    /// The motion of (x, η), mutable.
    pub(crate) fn inner_mut(&mut self) -> &mut Motion {
        &mut self.inner
    }

    /// The time dependence through functions of t alone; the rest of the time dependence of the motion of (x,
    /// η) is in terms of other variables.
    pub(crate) fn time_dependence(&self) -> TimeDependence {
        match self.inner.time_dependence() {
            TimeDependence::Known(profile) => TimeDependence::Known(profile).with_unknown(),
            other => other,
        }
    }

    /// The steep functions of the coordinates, which are the same for both motions.
    pub(crate) fn steep_functions(&self) -> Option<SteepFunctions> {
        self.inner.steep_functions()?.of_components(self.inner.coordinates)
    }

    /// The pattern of the Jacobian.
    pub(crate) fn pattern(&self) -> Option<&Pattern> {
        self.jacobian.as_ref().map(|_| &self.full)
    }

    /// Writes the (x, η, z) that corresponds to (x, y, z) to `state`.
    ///
    /// # Errors
    /// As for [`LegendreTransform::to_quasi_velocities`].
    pub(crate) fn read(&mut self, t: f64, y: &[f64]) -> Result<(), MechError> {
        let parameters = self.transform.parameters_mut();
        let known = parameters.len();
        parameters.copy_from_slice(&self.inner.parameters()[..known]);
        self.transform.to_quasi_velocities_in(t, y, &mut self.state)
    }

    /// The last (x, η, z) that was read.
    pub(crate) fn state(&self) -> &[f64] {
        &self.state
    }

    /// The observables, not finite where the momenta do not determine quasi-velocities; without accelerations
    /// unless `solved`.
    pub(crate) fn observe(&mut self, t: f64, y: &[f64], values: &mut [f64], solved: bool) {
        match self.read(t, y) {
            Ok(()) => self.inner.watch(t, &self.state, values, solved),
            Err(_) => values.fill(f64::NAN),
        }
    }

    /// The residual of each constraint, not finite where the momenta do not determine quasi-velocities.
    pub(crate) fn constraint_residuals(&mut self, t: f64, y: &[f64], residuals: &mut [f64]) {
        match self.read(t, y) {
            Ok(()) => self.inner.constraint_residuals_to(t, &self.state, residuals),
            Err(_) => residuals.fill(f64::NAN),
        }
    }

    /// The range of indices of η, or of the momenta, in a state.
    fn moving(&self) -> Range<usize> {
        let n = self.inner.coordinates();
        n..n + self.quasi_velocities
    }

    /// Computes (x, η, z, η̇) into `known`, and ẋ and ż into `rates`.
    fn solve(&mut self, t: f64, y: &[f64], rates: &mut [f64]) -> Result<(), Failure> {
        self.read(t, y).map_err(Failure::recoverable)?;
        self.inner.rhs(t, &self.state, rates)?;
        let moving = self.moving();
        self.known[..y.len()].copy_from_slice(&self.state);
        self.known[y.len()..].copy_from_slice(&rates[moving]);
        Ok(())
    }

    pub(crate) fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        self.solve(t, y, ydot)?;
        let parameters = self.inner.parameters();
        let rates = &mut ydot[self.moving()];
        self.transport.eval(t, &self.known, parameters, rates);
        check_finite(rates, &self.transport, Point { t, y: &self.known, p: parameters })
            .map_err(|failure| self.inner.failure(failure, t, &self.known[..y.len()]))
    }

    /// Projects as the motion of (x, η) does; the momenta of a state on the constraints are unchanged.
    pub(crate) fn project(&mut self, t: f64, y: &mut [f64]) -> Result<(), Failure> {
        self.read(t, y).map_err(Failure::recoverable)?;
        self.projected.copy_from_slice(&self.state);
        self.inner.project(t, &mut self.projected)?;
        if self.projected != self.state {
            let written = self.transform.to_momenta_in(t, &self.projected, &mut self.state);
            written.map_err(Failure::recoverable)?;
            y.copy_from_slice(&self.state);
        }
        Ok(())
    }

    pub(crate) fn restart(&mut self, t: f64, y: &[f64]) {
        // If the momenta do not determine quasi-velocities, the next evaluation reports it.
        if self.read(t, y).is_ok() {
            self.inner.restart(t, &self.state);
        }
    }

    /// Computes ∂f/∂y, column by column: with F(t, x, η, z) = (ẋ, ẏ, ż) and η = h(t, x, y, z),
    ///
    ///   ∂f/∂x = ∂F/∂x + (∂F/∂η) ∂h/∂x,   ∂f/∂y = (∂F/∂η) ∂h/∂y,   ∂f/∂z as ∂f/∂x.
    pub(crate) fn jacobian(&mut self, t: f64, y: &[f64], entries: &mut [f64]) -> Result<(), Failure> {
        let Some(mut slopes) = self.jacobian.take() else {
            return Err(Failure::fatal(MechError::Evaluation(EvaluationError::NotCompiled {
                what: "Jacobian",
            })));
        };
        let outcome = self.jacobian_by(&mut slopes, t, y, entries);
        self.jacobian = Some(slopes);
        outcome
    }

    fn jacobian_by(
        &mut self,
        slopes: &mut Slopes,
        t: f64,
        y: &[f64],
        entries: &mut [f64],
    ) -> Result<(), Failure> {
        self.find_inner_jacobian(t, y)?;
        let (dim, moving) = (y.len(), self.moving());
        let place = |q: usize| if q < moving.start { q } else { q + moving.len() };
        slopes.by_symbol.clear();
        for q in 0..slopes.symbols {
            slopes.by_symbol.extend_from_slice(&self.of_inner[place(q) * dim..(place(q) + 1) * dim]);
        }
        self.change(slopes, t)?;
        // The columns for x and z come first.
        let places = (0..slopes.symbols).map(place).chain(moving.clone());
        for (place, column) in places.zip(slopes.columns.chunks_exact(dim)) {
            entries[place * dim..(place + 1) * dim].copy_from_slice(column);
        }
        Ok(())
    }

    /// Computes the derivative of (ẋ, η̇, ż) with respect to (x, η, z) into `of_inner`, and (x, η, z, η̇) into
    /// `known`.
    fn find_inner_jacobian(&mut self, t: f64, y: &[f64]) -> Result<(), Failure> {
        let mut rates = std::mem::take(&mut self.rates);
        let outcome = self.solve(t, y, &mut rates);
        self.rates = rates;
        outcome?;
        self.inner.jacobian(t, &self.known[..y.len()], &mut self.of_inner)
    }

    /// Computes ∂f/∂p, column by column, in the way in which [`jacobian`](InMomenta::jacobian) computes
    /// ∂f/∂y.
    pub(crate) fn parameter_jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        entries: &mut [f64],
    ) -> Result<(), Failure> {
        let slopes = self.parameter_jacobian.take();
        let mut slopes = slopes.ok_or_else(|| not_compiled("derivative by parameters"))?;
        let outcome = self.slopes_by(&mut slopes, t, y, entries, Motion::parameter_jacobian);
        self.parameter_jacobian = Some(slopes);
        outcome
    }

    /// Computes ∂f/∂t, in the way in which [`jacobian`](InMomenta::jacobian) computes ∂f/∂y.
    pub(crate) fn time_derivative(
        &mut self,
        t: f64,
        y: &[f64],
        derivative: &mut [f64],
    ) -> Result<(), Failure> {
        let mut slopes = self.time_derivative.take().ok_or_else(|| not_compiled("derivative by time"))?;
        let outcome = self.slopes_by(&mut slopes, t, y, derivative, Motion::time_derivative);
        self.time_derivative = Some(slopes);
        outcome
    }

    /// The columns of ∂f/∂q for the symbols q of `slopes`, where `inner` differentiates the motion of (x, η,
    /// z).
    fn slopes_by(
        &mut self,
        slopes: &mut Slopes,
        t: f64,
        y: &[f64],
        entries: &mut [f64],
        inner: impl FnOnce(&mut Motion, f64, &[f64], &mut [f64]) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        self.find_inner_jacobian(t, y)?;
        slopes.by_symbol.resize(entries.len(), 0.0);
        inner(&mut self.inner, t, &self.known[..y.len()], &mut slopes.by_symbol)?;
        self.change(slopes, t)?;
        entries.copy_from_slice(&slopes.columns[..entries.len()]);
        Ok(())
    }

    /// Computes the columns of ∂f/∂q for each symbol q, then those of ∂f/∂y, into `columns` of `slopes`; (ẋ,
    /// η̇, ż) has the derivatives `of_inner` with respect to (x, η, z) and `by_symbol` with respect to q.
    fn change(&mut self, slopes: &mut Slopes, t: f64) -> Result<(), Failure> {
        self.change_of_velocities(slopes, t)?;
        let (n, k, dim) = (self.inner.coordinates(), self.quasi_velocities, self.state.len());
        let (m, of_inner) = (slopes.multipliers, &self.of_inner);
        let stride = 2 * k + m;
        let (by_q, moving) = slopes.values.split_at(slopes.symbols * stride);
        let (by_eta, mass) = moving.split_at(k * k);
        for (q, h) in slopes.of_unknowns.chunks_exact(k + m).enumerate() {
            let is_symbol = q < slopes.symbols;
            let column = &mut slopes.columns[q * dim..(q + 1) * dim];
            for (i, change) in column.iter_mut().enumerate() {
                let direct = if is_symbol { slopes.by_symbol[i + q * dim] } else { 0.0 };
                *change = direct + (0..k).map(|s| of_inner[i + (n + s) * dim] * h[s]).sum::<f64>();
            }
            // η̇, which ẏ contains.
            let accelerations = &mut self.rates[..k];
            accelerations.copy_from_slice(&column[n..n + k]);
            for (r, change) in column[n..n + k].iter_mut().enumerate() {
                let direct = if is_symbol { by_q[q * stride + r] } else { 0.0 };
                let along = |s: usize| by_eta[r + s * k] * h[s] + mass[r + s * k] * accelerations[s];
                *change = direct + (0..k).map(along).sum::<f64>();
            }
        }
        Ok(())
    }

    /// Computes the entries of `slopes`, and ∂h/∂q for each symbol q, then ∂h/∂y, into its `of_unknowns`.
    fn change_of_velocities(&mut self, slopes: &mut Slopes, t: f64) -> Result<(), Failure> {
        let (k, dim, m) = (self.quasi_velocities, self.state.len(), slopes.multipliers);
        let stride = 2 * k + m;
        slopes.entries.eval(t, &self.known, self.inner.parameters(), &mut slopes.values);
        check_finite(
            &slopes.values,
            &slopes.entries,
            Point { t, y: &self.known, p: self.inner.parameters() },
        )
        .map_err(|failure| self.inner.failure(failure, t, &self.known[..dim]))?;
        let by_q = &slopes.values[..slopes.symbols * stride];
        let h = &mut slopes.of_unknowns;
        h.fill(0.0);
        for (q, column) in h.chunks_exact_mut(k + m).enumerate() {
            match q.checked_sub(slopes.symbols) {
                None => column.copy_from_slice(&by_q[q * stride + k..(q + 1) * stride]),
                Some(s) => column[s] = 1.0,
            }
        }
        self.transform.solve_last(h);
        Ok(())
    }

    /// Writes the derivatives of the observables column by column, with η = h(t, x, y, z) in
    /// those of the motion of (x, η, z); not finite where momenta do not determine quasi-velocities.
    ///
    /// # Errors
    /// [`EvaluationError::NotCompiled`].
    pub(crate) fn observed_slopes(
        &mut self,
        by: By,
        (t, y): (f64, &[f64]),
        entries: &mut [f64],
    ) -> Result<(), Failure> {
        let kept = match by {
            By::State => &mut self.jacobian,
            By::Parameters => &mut self.parameter_jacobian,
        };
        let mut slopes = kept.take().ok_or_else(|| not_compiled(OF_OBSERVABLES))?;
        let outcome = self.observed_slopes_by(&mut slopes, by, (t, y), entries);
        match by {
            By::State => self.jacobian = Some(slopes),
            By::Parameters => self.parameter_jacobian = Some(slopes),
        }
        match outcome {
            Err(failure) if failure.is_recoverable() => {
                entries.fill(f64::NAN);
                Ok(())
            }
            other => other,
        }
    }

    fn observed_slopes_by(
        &mut self,
        slopes: &mut Slopes,
        by: By,
        (t, y): (f64, &[f64]),
        entries: &mut [f64],
    ) -> Result<(), Failure> {
        let mut rates = std::mem::take(&mut self.rates);
        let outcome = self.solve(t, y, &mut rates);
        self.rates = rates;
        outcome?;
        self.change_of_velocities(slopes, t)?;
        let (dim, moving, m) = (y.len(), self.moving(), slopes.multipliers);
        let rows = self.inner.observable_names().len();
        let mut of_inner = vec![0.0; rows * dim];
        self.inner.observable_jacobian(t, &self.state, &mut of_inner)?;
        let columns: Vec<usize> = match by {
            By::State => (0..dim).filter(|i| !moving.contains(i)).chain(moving.clone()).collect(),
            By::Parameters => (0..slopes.symbols).collect(),
        };
        match by {
            By::State => entries.copy_from_slice(&of_inner),
            By::Parameters => self.inner.observable_parameter_jacobian(t, &self.state, entries)?,
        }
        for (&column, h) in columns.iter().zip(slopes.of_unknowns.chunks_exact(moving.len() + m)) {
            let is_momentum = by == By::State && moving.contains(&column);
            for (i, entry) in entries[column * rows..(column + 1) * rows].iter_mut().enumerate() {
                let through: f64 = moving.clone().zip(h).map(|(s, h)| of_inner[i + s * rows] * h).sum();
                *entry = if is_momentum { through } else { *entry + through };
            }
        }
        Ok(())
    }
}

fn not_compiled(what: &'static str) -> Failure {
    Failure::fatal(MechError::Evaluation(EvaluationError::NotCompiled { what }))
}
