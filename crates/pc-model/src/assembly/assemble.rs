//! From a document to a mechanical system.

use std::sync::atomic::{AtomicUsize, Ordering};

use pc_expr::SymbolPlaces;
use pc_mech::{Expr, Frame, Graph, LagrangianError, Neighbourhood, System};

use crate::assembly::assembler::Assembler;
use crate::assembly::assembly::Assembly;
use crate::assembly::bodies::SystemBody;
use crate::assembly::constraints::Written;
use crate::assembly::tables;
use crate::diagnostics::error::ModelError;
use crate::diagnostics::meaning::MeaningError;
use crate::document::{InputValue, NamedExpression};
use crate::model::model::Model;
use crate::names::scope::Scope;
use crate::names::stage::Stage;

static DERIVATIONS: AtomicUsize = AtomicUsize::new(0);

/// The number of times this process has [assembled](Model::assemble) a model: a measure of its work on derivations
/// that is the same on every machine.
pub fn derivations() -> usize {
    DERIVATIONS.load(Ordering::Relaxed)
}

impl Model {
    /// The mechanical system of the model, with its expressions in `graph`, and the start state.
    ///
    /// # Errors
    /// [`ModelError`] at the place in the file that causes the error.
    pub fn assemble<'g>(&self, graph: &'g Graph) -> Result<Assembly<'g>, ModelError> {
        DERIVATIONS.fetch_add(1, Ordering::Relaxed);
        self.parameter_values().check(self.document())?;
        let assembler =
            || Assembler { model: self, graph, scope: Scope::new(graph, self.document()) }.assemble();
        let assembly = self.document().stage(graph, "the mechanical system", assembler)?;
        assembly.check_inertia()?;
        self.drawn(&assembly)?; // an error in a drawing is an error of the text
        Ok(assembly)
    }

    /// Runs `work` on the mechanical system, whose expressions live only as long as it runs.
    ///
    /// # Errors
    /// The errors of [`assemble`](Model::assemble), those of `work`, and [`ErrorKind::Spent`](crate::ErrorKind::Spent) if
    /// the [limits](Model::limit) are reached.
    pub fn derived<T, E: From<ModelError>>(
        &self,
        work: impl FnOnce(&Assembly<'_>) -> Result<T, E>,
    ) -> Result<T, E> {
        let graph = self.graph();
        let assembly = self.assemble(&graph)?;
        let outcome = work(&assembly)?;
        assembly.within_limits()?;
        Ok(outcome)
    }
}

/// The first parts of a mechanical system to be assembled: its frame, the constraints as written, and its
/// start.
pub(super) struct Begun<'g> {
    pub(super) t_start: f64,
    pub(super) frame: Frame<'g>,
    pub(super) constraints: Vec<Written<'g>>,
    /// All quasi-velocities, with the declared ones first.
    pub(super) eta: Vec<Expr<'g>>,
    declared: usize,
    /// The number of quasi-velocities that come first and determine the others.
    pub(super) prescribed: usize,
    /// The velocities x' with their values b η + b_0.
    pub(super) x_dot: Vec<(Expr<'g>, Expr<'g>)>,
    /// The start values of coordinates, quasi-velocities and first-order states, as written.
    pub(super) start: Vec<f64>,
}

impl<'g> Assembler<'g, '_> {
    fn parameters(&self) -> Vec<(Expr<'g>, f64)> {
        self.model.parameters().map(|(name, value)| (self.graph.symbol(name), value)).collect()
    }

    /// The values of parameters, time and the symbols of the state.
    pub(super) fn values_at(
        &self,
        (frame, t): (&Frame<'g>, f64),
        symbols: &[Expr<'g>],
        state: &[f64],
    ) -> Vec<(Expr<'g>, f64)> {
        let mut values = self.parameters();
        values.push((frame.time(), t));
        values.extend(symbols.iter().copied().zip(state.iter().copied()));
        values
    }

    /// Checks that the frame has the same rank at the start as elsewhere: where q = 0, for example, the rate
    /// of a quaternion is zero for any ω.
    fn check_frame_at_start(&self, frame: &Frame<'g>, values: &[(Expr<'g>, f64)]) -> Result<(), ModelError> {
        let start = Neighbourhood { centre: values.to_vec() };
        let (rank, everywhere) = (start.rank_at_centre(self.graph, frame.b()), frame.rank());
        match rank.filter(|&rank| rank < everywhere) {
            None => Ok(()),
            Some(rank) => {
                let cause = format!(
                    "the frame is singular there: the matrix b of the velocities has rank {rank}, but {everywhere} at most states"
                );
                let document = self.model.document();
                Err(document.error(
                    &document.operator_place(1),
                    MeaningError::SingularStart { cause, is_massless: false },
                ))
            }
        }
    }

    /// The frame, the constraints as written, and the start before it is moved onto them.
    pub(super) fn begin(&mut self) -> Result<Begun<'g>, ModelError> {
        let document = self.model.document();
        let parameters = self.parameters();
        let mut given = self.given_start(&parameters)?;
        self.check_rotations(&parameters)?;
        self.normalise_quaternions(&mut given.values)?;
        let t_start = document.simulation.start_time();
        let mut constraints = self.constraints()?;
        let mut at = parameters;
        at.push((self.graph.symbol("t"), t_start));
        self.place_contacts(&mut given, &at)?;
        at.extend(self.scope.coordinates().into_iter().zip(given.values.iter().copied()));
        let (frame, completing) = self.frame(&mut constraints, &at)?;
        let mut eta =
            if self.is_lagrangian_form() { self.scope.velocities() } else { self.scope.quasi_velocities() };
        let declared = eta.len();
        eta.extend(&completing);
        let mut start = self.start_state(&frame, &eta, &constraints, &at, &given)?;
        start.extend(given.states);

        let velocities = frame.velocities(&eta);
        let x_dot: Vec<(Expr<'g>, Expr<'g>)> = self
            .scope
            .velocities()
            .into_iter()
            .zip(velocities)
            .filter(|(symbol, value)| symbol != value)
            .collect();
        let prescribed = if completing.is_empty() { 0 } else { declared };
        Ok(Begun { t_start, frame, constraints, eta, declared, prescribed, x_dot, start })
    }

    fn assemble(&mut self) -> Result<Assembly<'g>, ModelError> {
        let Begun { t_start, frame, constraints, eta, declared, prescribed, x_dot, mut start } =
            self.begin()?;
        let document = self.model.document();
        let lagrangian = self.lagrangian(&x_dot)?;
        let bodies = self.bodies(&eta, &x_dot)?;
        let of_forces: Result<_, _> = bodies.iter().map(|body| body.force_function(&frame, &eta)).collect();
        self.scope.force_functions = of_forces.map_err(|error| document.derivation_error(error))?;
        let changing_masses = self.changing_masses()?;
        let tree = self.tree(&x_dot)?;
        let stops = self.stops(tree.as_ref())?;
        let gravity = self.gravity()?;
        let dissipation = self.dissipation(&x_dot)?;
        let rates = self.state_rates(&x_dot)?;
        let (forces, on_coordinates) = self.forces(eta.len(), &x_dot)?;
        let integrals = self.observed(&document.integrals, &eta, &x_dot)?;
        let outputs = self.observed(&document.outputs, &eta, &x_dot)?;

        let given = self.given_quasi_velocities(&eta, &x_dot)?;
        let crossings = self.crossings(&x_dot)?;

        let states = self.scope.states();
        let state = [frame.coordinates(), &eta, &states].concat();
        let parameters = self.parameters();
        let values = self.values_at((&frame, t_start), &state, &start);
        self.check_finite(&values, &x_dot, &state)?;
        self.check_frame_at_start(&frame, &values)?;
        self.check_orientations(&frame, &values)?;

        let mut builder = System::builder(self.graph)
            .coordinates(document.coordinates.iter().map(|c| &c.name.text))
            .quasi_velocities(eta.iter().map(Expr::to_string))
            .near(values.iter().copied())
            .lagrangian(|_, _, _| lagrangian)
            .dissipation(|_, _, _| dissipation)
            .forces(|_, _, _| forces)
            .force_on_coordinates(|_, _, _| on_coordinates);
        for body in bodies {
            builder = match body {
                SystemBody::Particle(particle) => builder.particle(|_, _, _| particle),
                SystemBody::Rigid(body) => builder.rigid_body(|_, _, _| *body),
            };
        }
        if let Some(tree) = tree {
            builder = builder.tree(tree);
        }
        for (symbol, rate) in states.into_iter().zip(rates) {
            builder = builder.state(symbol, |_, _, _| rate);
        }
        if let Some(acceleration) = gravity {
            builder = builder.gravity(|_| acceleration);
        }
        let values_of = self.model.parameter_values();
        for (place, (symbol, value)) in parameters.into_iter().enumerate() {
            builder = match values_of.is_table(place) {
                true => builder.signal(symbol, value),
                false => builder.parameter(symbol, value),
            };
        }
        for (name, value) in integrals {
            builder = builder.integral(name, |_, _, _| value);
        }
        for (name, value) in outputs {
            builder = builder.output(name, |_, _, _| value);
        }
        for &(symbol, definition) in &given {
            builder = builder.output(symbol.to_string(), |_, _, _| definition);
        }
        if let Some(structure) = self.structure(&eta)? {
            builder = builder.structure(structure);
        }
        builder = builder.external_force(self.model.external_forces());
        let system =
            builder.frame(frame).build().map_err(|error| self.model.document().derivation_error(error))?;
        let system = self.with_joint_reactions(system)?;
        let (system, jams) = self.with_friction_of_contacts(system, &constraints, &x_dot, &values)?;
        self.check_inputs(&system)?;
        let written_start = self.model.projects_start().then(|| start.clone());
        let constraints =
            self.treatment(&system, &constraints, &x_dot, &values, (t_start, &mut start), prescribed)?;
        if !constraints.redundant().is_empty() {
            self.refuse_joint_reactions(
                "a constraint follows from others, so that these forces are not unique",
            )?;
        }
        let independent = self.model.independent().iter().map(|name| self.graph.symbol(name)).collect();
        let constraints = constraints.with_independent(independent);
        let mut events =
            self.events(crossings, &x_dot, &constraints, system.frame().coordinates().len() + eta.len())?;
        events.extend(self.impacts(&stops)?);
        events.extend(jams);
        self.check_joints(&stops, &system, &start)?;
        let action = self.action()?;
        self.scope.look_at_unused()?;
        self.scope.look_at_functions()?;
        Ok(Assembly {
            system,
            constraints,
            t_start,
            start,
            written_start,
            declared,
            events,
            definitions: self.scope.meanings(&x_dot),
            given,
            action,
            changing_masses,
            document: self.model.shared_document(),
        })
    }

    /// Checks that the rates of inputs are known where they are in use: of those in momenta, and of those whose
    /// rates the text uses.
    fn check_inputs(&self, system: &System<'g>) -> Result<(), ModelError> {
        let (document, momenta) = (self.model.document(), system.momenta());
        for (place, input) in document.inputs.iter().enumerate() {
            let symbol = self.graph.symbol(&input.name.text);
            let in_momenta = momenta.iter().any(|p| p.depends_on(symbol));
            if in_momenta && self.graph.rate_of(symbol).is_none() {
                let error = LagrangianError::SignalInMomentum { input: input.name.text.clone() };
                return Err(document.derivation_error(error.into()));
            }
            let InputValue::RateOf(of) = input.value else { continue };
            let function = self.graph.symbol(&document.inputs[of].name.text);
            let in_use = || self.scope.rates_in_use.contains(&function);
            let in_momenta = || momenta.iter().any(|p| p.depends_on(function));
            let unknown = self.model.parameter_values().is_unknown(document.parameters.len() + place);
            if unknown && (in_use() || in_momenta()) {
                return Err(tables::without_rate(document, &document.inputs[of].name));
            }
        }
        Ok(())
    }

    /// T − V as given by `[lagrangian]`, without the bodies.
    fn lagrangian(&mut self, x_dot: &[(Expr<'g>, Expr<'g>)]) -> Result<Expr<'g>, ModelError> {
        let Some(energy) = &self.model.document().lagrangian else { return Ok(Expr::ZERO) };
        let mut lagrangian = Expr::ZERO;
        for (expression, sign) in [(&energy.kinetic, 1), (&energy.potential, -1), (&energy.lagrangian, 1)] {
            if let Some(expression) = expression {
                lagrangian += self.dynamic(expression, x_dot)? * sign;
            }
        }
        Ok(lagrangian)
    }

    fn dissipation(&mut self, x_dot: &[(Expr<'g>, Expr<'g>)]) -> Result<Expr<'g>, ModelError> {
        let energy = self.model.document().lagrangian.as_ref();
        match energy.and_then(|energy| energy.dissipation.as_ref()) {
            Some(dissipation) => self.dynamic(dissipation, x_dot),
            None => Ok(Expr::ZERO),
        }
    }

    /// The rates ż of the first-order states.
    fn state_rates(&mut self, x_dot: &[(Expr<'g>, Expr<'g>)]) -> Result<Vec<Expr<'g>>, ModelError> {
        let states = self.model.document().states.iter();
        let rates: Result<Vec<Expr<'g>>, ModelError> =
            states.map(|state| self.scope.resolve(&state.rate, Stage::Rate)).collect();
        Ok(self.graph.substitute(&rates?, x_dot))
    }

    /// The entries of `[forces]`: Q_s on quasi-velocities, and F_i on coordinates.
    fn forces(
        &mut self,
        operators: usize,
        x_dot: &[(Expr<'g>, Expr<'g>)],
    ) -> Result<(Vec<Expr<'g>>, Vec<Expr<'g>>), ModelError> {
        let document = self.model.document();
        let mut on_coordinates = vec![Expr::ZERO; document.coordinates.len()];
        let mut forces = match self.is_lagrangian_form() {
            true => on_coordinates.clone(),
            false => vec![Expr::ZERO; operators],
        };
        for force in &document.forces {
            let name = &force.name;
            let on_eta = document.quasi_velocities.iter().position(|q| q.name.text == name.text);
            let on_x = document.coordinates.iter().position(|c| c.name.text == name.text);
            let value = self.dynamic(&force.expression, x_dot)?;
            match (on_eta, on_x) {
                (Some(s), _) => forces[s] += value,
                (None, Some(i)) => on_coordinates[i] += value,
                (None, None) => {
                    let quasi_velocities = document.quasi_velocities.iter().map(|q| q.name.text.clone());
                    let coordinates = document.coordinates.iter().map(|c| c.name.text.clone());
                    let known = quasi_velocities.chain(coordinates).collect();
                    return Err(self.model.document().error(
                        &name.place,
                        MeaningError::UnknownForceTarget { name: name.text.clone(), known },
                    ));
                }
            }
        }
        Ok((forces, on_coordinates))
    }

    fn observed(
        &mut self,
        list: &[NamedExpression],
        eta: &[Expr<'g>],
        x_dot: &[(Expr<'g>, Expr<'g>)],
    ) -> Result<Vec<(String, Expr<'g>)>, ModelError> {
        let mut observed = Vec::new();
        for item in list {
            let value = self.scope.resolve(&item.expression, Stage::Observation)?;
            observed.push((item.name.text.clone(), self.with_velocities(value, eta, x_dot)));
        }
        Ok(observed)
    }

    /// Substitutes ẋ = b η + b_0 for the velocities and, for the accelerations x'', the derivative of this
    /// along the motion,
    ///
    ///   ẍ = b η̇ + (db/dt) η + db_0/dt,
    ///
    /// where `eta` are all quasi-velocities of the system, including those that complete the declared ones.
    fn with_velocities(&self, value: Expr<'g>, eta: &[Expr<'g>], x_dot: &[(Expr<'g>, Expr<'g>)]) -> Expr<'g> {
        let graph = self.graph;
        // Of the velocities that remain, x' is itself a quasi-velocity.
        let rate = |velocity: Expr<'g>| x_dot.iter().find(|(symbol, _)| *symbol == velocity);
        let coordinates = self.scope.coordinates().into_iter().zip(self.scope.velocities());
        let mut rates: Vec<(Expr<'g>, Expr<'g>)> = coordinates
            .map(|(x, velocity)| (x, rate(velocity).map_or(velocity, |(_, rate)| *rate)))
            .collect();
        rates.extend(eta.iter().map(|eta| (*eta, graph.symbol(&format!("{eta}'")))));
        rates.push((graph.symbol("t"), Expr::ONE));
        let velocities: Vec<Expr<'g>> = x_dot.iter().map(|&(_, rate)| rate).collect();
        let accelerations = graph.directional(&velocities, &rates);
        let mut replacements = x_dot.to_vec();
        for (&(velocity, _), acceleration) in x_dot.iter().zip(accelerations) {
            replacements.push((graph.symbol(&format!("{velocity}'")), acceleration));
        }
        graph.substitute(&[value], &replacements)[0]
    }

    /// Finds the first part of the model, as written, whose value at the start is not a finite number.
    fn check_finite(
        &self,
        values: &[(Expr<'g>, f64)],
        x_dot: &[(Expr<'g>, Expr<'g>)],
        state: &[Expr<'g>],
    ) -> Result<(), ModelError> {
        let velocities =
            self.graph.evaluate(&x_dot.iter().map(|&(_, value)| value).collect::<Vec<_>>(), values);
        let velocities = velocities.unwrap_or_default();
        let velocities = x_dot.iter().map(|&(symbol, _)| symbol).zip(velocities);
        let written = self.scope.taken(&velocities.chain(values.iter().copied()).collect::<Vec<_>>());
        let all: Vec<Expr<'g>> = written.iter().map(|written| written.value).collect();
        let all = self.graph.substitute(&all, x_dot);
        // Expressions with accelerations have no value yet: they are checked when the motion is computed.
        let known = SymbolPlaces::of(&values.iter().map(|&(symbol, _)| symbol).collect::<Vec<_>>());
        let is_unknown = |symbol: &Expr<'g>| !known.contains(*symbol);
        let unknown = self.graph.symbols_of(&all).into_iter().filter(is_unknown);
        let at: Vec<(Expr<'g>, f64)> =
            unknown.map(|symbol| (symbol, f64::NAN)).chain(values.iter().copied()).collect();
        let Ok(found) = self.graph.evaluate(&all, &at) else { return Ok(()) }; // every symbol has a value
        for ((written, &value), found) in written.iter().zip(&all).zip(found) {
            if found.is_finite() {
                continue;
            }
            let Ok(value) = self.graph.evaluate(&[value], values) else { continue };
            let shown = values.iter().filter(|(symbol, _)| state.contains(symbol));
            let state = shown.map(|(symbol, value)| (symbol.to_string(), *value)).collect();
            let fault = MeaningError::NotFinite { text: written.text.clone(), value: value[0], state };
            return Err(self.model.document().error(&written.place, fault));
        }
        Ok(())
    }
}
