//! Motions under constraints with momenta for the components of their state.

use std::ops::Range;

use pc_algebra::Matrix;
use pc_expr::{
    Backend, Evaluator, Expr, ExprError, Failure, Inputs, Pattern, Program, TimeDependence, VectorField,
};

use crate::compiled::elimination::columns::derivative;
use crate::compiled::failure::check_finite;
use crate::compiled::legendre_transform::LegendreTransform;
use crate::compiled::motion::{InMomenta, Motion, Slopes};
use crate::compiled::options::CompileOptions;
use crate::compiled::point::Point;
use crate::constraints::multipliers::Multipliers;
use crate::error::{EvaluationError, MechError};

impl Multipliers<'_> {
    /// Compiles the canonical equations with multipliers as a vector field of the state (x, y) with the momenta
    /// y_s = ∂L/∂η_s of all quasi-velocities, called as [`System::momentum_symbols`](crate::System::momentum_symbols):
    ///
    ///   ẏ_s = (c_rs^m η_r + c_0s^m) y_m + X_s L + Q_s + C_αs λ_α,   ẋ = b η + b_0,   C η + c_0 = 0.
    ///
    /// No velocities are chosen for independent ones, so that no position is singular but those of the constraints
    /// themselves. States are projected as those of [`compile_for`](Multipliers::compile_for) are, and what is observed or
    /// [kept](Motion::keep) is the same; to keep integrals, those of these multipliers are to be given. There is no product with
    /// the Jacobian.
    ///
    /// `guess` are η from which solutions of y = ∂L/∂η are looked for where L is not quadratic in η, or a constraint is not
    /// affine.
    ///
    /// ```
    /// use pc_mech::{Constraint, Graph, System, VectorField};
    ///
    /// // A pendulum of mass 2 in Cartesian coordinates, where it is level.
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
    /// As [`compile_for`](Multipliers::compile_for); [`ShapeError`](crate::ShapeError) for a guess of another length.
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
            .chain([(system.frame().time(), Expr::ONE)])
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
            Ok::<_, ExprError>(Slopes {
                symbols: symbols.len(),
                multipliers: multipliers.constraints().len(),
                entries: derivative(graph, &inputs, &entries, options.backend)?,
            })
        };
        let states = system.states().iter().map(|&(z, _)| z);
        let unmoved: Vec<Expr<'g>> = x.iter().copied().chain(states).collect();
        let dim = unmoved.len() + eta.len();
        Ok(InMomenta {
            inner: Box::new(multipliers.compile_for(CompileOptions { jvp: false, ..*options })?),
            transport: Evaluator::new(Program::new(graph, &inputs, &rates)?, Backend::Interpreter),
            jacobian: options.jacobian.then(|| slopes(&unmoved)).transpose()?,
            parameter_jacobian: (options.jacobian && options.parameter_jacobian)
                .then(|| slopes(&parameters))
                .transpose()?,
            quasi_velocities: eta.len(),
            known: vec![0.0; dim + eta.len()],
            full: Pattern::full(dim, dim),
            transform,
        })
    }

    /// The motion of (x, η, z).
    pub(crate) fn inner(&self) -> &Motion {
        &self.inner
    }

    /// The motion of (x, η), to be changed.
    pub(crate) fn inner_mut(&mut self) -> &mut Motion {
        &mut self.inner
    }

    /// What contains t, as far as it is a function of t alone: what the motion of (x, η) shows of others is in other variables.
    pub(crate) fn time_dependence(&self) -> TimeDependence {
        match self.inner.time_dependence() {
            TimeDependence::Known(profile) if profile.follows_states() => TimeDependence::Unknown,
            TimeDependence::Known(profile) => TimeDependence::Known(profile).with_unknown(),
            other => other,
        }
    }

    /// The places of the Jacobian.
    pub(crate) fn pattern(&self) -> Option<&Pattern> {
        self.jacobian.as_ref().map(|_| &self.full)
    }

    /// (x, η) of (x, y).
    ///
    /// # Errors
    /// As [`LegendreTransform::to_quasi_velocities`].
    pub(crate) fn read(&mut self, t: f64, y: &[f64]) -> Result<Vec<f64>, MechError> {
        let parameters = self.transform.parameters_mut();
        let known = parameters.len();
        parameters.copy_from_slice(&self.inner.parameters()[..known]);
        self.transform.to_quasi_velocities(t, y)
    }

    /// The observables, not finite where momenta have no quasi-velocities.
    pub(crate) fn observe(&mut self, t: f64, y: &[f64]) -> Vec<f64> {
        match self.read(t, y) {
            Ok(state) => self.inner.observe(t, &state),
            Err(_) => vec![f64::NAN; self.inner.observable_names().len()],
        }
    }

    /// What should be zero of each constraint, not finite where momenta have no quasi-velocities.
    pub(crate) fn constraint_residuals(&mut self, t: f64, y: &[f64]) -> Vec<f64> {
        match self.read(t, y) {
            Ok(state) => self.inner.constraint_residuals(t, &state),
            Err(_) => vec![f64::NAN; self.inner.constraint_names().len()],
        }
    }

    /// The places of η, or of their momenta, in a state.
    fn moving(&self) -> Range<usize> {
        let n = self.inner.coordinates();
        n..n + self.quasi_velocities
    }

    /// Leaves (x, η, z, η̇) in `known`, and ẋ and ż in `rates`.
    fn solve(&mut self, t: f64, y: &[f64], rates: &mut [f64]) -> Result<(), Failure> {
        let state = self.read(t, y).map_err(Failure::recoverable)?;
        self.inner.rhs(t, &state, rates)?;
        let moving = self.moving();
        self.known[..y.len()].copy_from_slice(&state);
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

    /// To where the motion of (x, η) is projected; momenta of a state that is there are left as they are.
    pub(crate) fn project(&mut self, t: f64, y: &mut [f64]) -> Result<(), Failure> {
        let state = self.read(t, y).map_err(Failure::recoverable)?;
        let mut projected = state.clone();
        self.inner.project(t, &mut projected)?;
        if projected != state {
            y.copy_from_slice(&self.transform.to_momenta(t, &projected).map_err(Failure::recoverable)?);
        }
        Ok(())
    }

    pub(crate) fn restart(&mut self, t: f64, y: &[f64]) {
        // Where momenta have no quasi-velocities the next evaluation says so.
        if let Ok(state) = self.read(t, y) {
            self.inner.restart(t, &state);
        }
    }

    /// ∂f/∂y, column after column: with F(t, x, η, z) = (ẋ, ẏ, ż) and η = h(t, x, y, z),
    ///
    ///   ∂f/∂x = ∂F/∂x + (∂F/∂η) ∂h/∂x,   ∂f/∂y = (∂F/∂η) ∂h/∂y,   ∂f/∂z as ∂f/∂x.
    pub(crate) fn jacobian(&mut self, t: f64, y: &[f64], entries: &mut [f64]) -> Result<(), Failure> {
        let Some(slopes) = self.jacobian.clone() else {
            return Err(Failure::fatal(MechError::Evaluation(EvaluationError::NotCompiled {
                what: "Jacobian",
            })));
        };
        let of_inner = self.inner_jacobian(t, y)?;
        let moving = self.moving();
        let place = |q: usize| if q < moving.start { q } else { q + moving.len() };
        let columns = self.changes(&slopes, t, &of_inner, |i, q| of_inner[(i, place(q))])?;
        // Those by x and z come first.
        let places = (0..slopes.symbols).map(place).chain(moving.clone());
        for (place, column) in places.zip(columns.chunks_exact(y.len())) {
            entries[place * y.len()..(place + 1) * y.len()].copy_from_slice(column);
        }
        Ok(())
    }

    /// The derivative of (ẋ, η̇, ż) by (x, η, z); leaves (x, η, z, η̇) in `known`.
    fn inner_jacobian(&mut self, t: f64, y: &[f64]) -> Result<Matrix<f64>, Failure> {
        let dim = y.len();
        self.solve(t, y, &mut vec![0.0; dim])?;
        let mut entries = vec![0.0; dim * dim];
        self.inner.jacobian(t, &self.known[..dim], &mut entries)?;
        Ok(Matrix::from_fn(dim, dim, |i, j| entries[i + j * dim]))
    }

    /// ∂f/∂p, column after column, as [`jacobian`](InMomenta::jacobian).
    pub(crate) fn parameter_jacobian(
        &mut self,
        t: f64,
        y: &[f64],
        entries: &mut [f64],
    ) -> Result<(), Failure> {
        let Some(slopes) = self.parameter_jacobian.clone() else {
            return Err(Failure::fatal(MechError::Evaluation(EvaluationError::NotCompiled {
                what: "derivative by parameters",
            })));
        };
        let (dim, of_inner) = (y.len(), self.inner_jacobian(t, y)?);
        let mut by_parameters = vec![0.0; entries.len()];
        self.inner.parameter_jacobian(t, &self.known[..dim], &mut by_parameters)?;
        let columns = self.changes(&slopes, t, &of_inner, |i, q| by_parameters[i + q * dim])?;
        entries.copy_from_slice(&columns[..entries.len()]);
        Ok(())
    }

    /// The columns of ∂f/∂q for each symbol q of `slopes`, then those of ∂f/∂y; (ẋ, η̇, ż) has the derivatives `of_inner` by
    /// (x, η, z) and `by_symbol` by q.
    fn changes(
        &mut self,
        slopes: &Slopes,
        t: f64,
        of_inner: &Matrix<f64>,
        by_symbol: impl Fn(usize, usize) -> f64,
    ) -> Result<Vec<f64>, Failure> {
        let (n, k, dim) = (self.inner.coordinates(), self.quasi_velocities, of_inner.rows());
        let m = slopes.multipliers;
        let stride = 2 * k + m;
        let mut values = vec![0.0; slopes.symbols * stride + 2 * k * k];
        slopes.entries.clone().eval(t, &self.known, self.inner.parameters(), &mut values);
        check_finite(&values, &slopes.entries, Point { t, y: &self.known, p: self.inner.parameters() })
            .map_err(|failure| self.inner.failure(failure, t, &self.known[..dim]))?;
        let (by_q, moving) = values.split_at(slopes.symbols * stride);
        let (by_eta, mass) = moving.split_at(k * k);
        // ∂h/∂q, then ∂h/∂y
        let mut h = vec![0.0; (slopes.symbols + k) * (k + m)];
        for (q, column) in h.chunks_exact_mut(k + m).enumerate() {
            match q.checked_sub(slopes.symbols) {
                None => column.copy_from_slice(&by_q[q * stride + k..(q + 1) * stride]),
                Some(s) => column[s] = 1.0,
            }
        }
        self.transform.solve_last(&mut h);
        let mut columns = Vec::with_capacity((slopes.symbols + k) * dim);
        for (q, h) in h.chunks_exact(k + m).enumerate() {
            let is_symbol = q < slopes.symbols;
            let inner: Vec<f64> = (0..dim)
                .map(|i| {
                    let direct = if is_symbol { by_symbol(i, q) } else { 0.0 };
                    direct + (0..k).map(|s| of_inner[(i, n + s)] * h[s]).sum::<f64>()
                })
                .collect();
            columns.extend_from_slice(&inner[..n]);
            columns.extend((0..k).map(|r| {
                let direct = if is_symbol { by_q[q * stride + r] } else { 0.0 };
                let along = |s: usize| by_eta[r + s * k] * h[s] + mass[r + s * k] * inner[n + s];
                direct + (0..k).map(along).sum::<f64>()
            }));
            columns.extend_from_slice(&inner[n + k..]);
        }
        Ok(columns)
    }
}
