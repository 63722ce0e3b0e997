//! A document as a mechanical system.

use std::sync::Arc;

use pc_expr::Graph;
use pc_mech::{
    AlgebraError, Canonical, CompileOptions, Equations, Expr, KeptIntegrals, MechError, Motion, Multipliers,
    Signals, System, VectorField,
};
use pc_nonholo::NonholoError;

use crate::assembly::assembly::assemble;
use crate::assembly::constraint_treatment::{Bound, Form};
use crate::assembly::event::Event;
use crate::assembly::parameters::Parameters;
use crate::diagnostics::error::{ErrorKind, ModelError};
use crate::diagnostics::fault::Fault;
use crate::diagnostics::source::Place;
use crate::document::document;
use crate::document::document::{AlgebraDefinition, Bracket, Document, Method};

/// A model whose parameters can be set and that can be turned into a mechanical system.
#[derive(Clone, Debug)]
pub struct Model {
    document: Document,
    parameters: Parameters,
    /// Start values that are not those of the document, by their places.
    starts: Vec<(usize, f64)>,
    projects_start: bool,
    /// The places of start values that are not moved.
    held_starts: Vec<usize>,
    observes_reactions: bool,
    /// Whether motions and events are to be differentiated by parameters.
    by_parameters: bool,
    /// The names of the integrals to be kept.
    kept: Vec<String>,
    /// The quasi-velocities, or coordinates, on which external forces act.
    pub(crate) external: Vec<String>,
}

/// The system of a model, with the state its motion starts from.
pub struct Assembly<'g> {
    /// The system, without its constraints. Its quasi-velocities are those declared and those that constraints define.
    pub system: System<'g>,
    /// Its constraints.
    pub bound: Bound<'g>,
    /// Start time.
    pub t_start: f64,
    /// Start state: coordinates, quasi-velocities, first-order states.
    pub start: Vec<f64>,
    /// The start state as written, where it was to be moved to the constraints.
    pub written_start: Option<Vec<f64>>,
    /// Number of quasi-velocities that are declared, the first ones; the velocities where none is.
    pub declared: usize,
    /// What happens where, in the order in which simultaneous events are dealt with.
    pub events: Vec<Event<'g>>,
}

impl<'g> Assembly<'g> {
    /// Values of time, coordinates and quasi-velocities at the start.
    pub fn at_start(&self) -> Vec<(Expr<'g>, f64)> {
        let frame = self.system.frame();
        let state = self.system.state().into_iter();
        state.zip(self.start.iter().copied()).chain([(frame.time(), self.t_start)]).collect()
    }

    /// The equations of motion in independent quasi-velocities.
    ///
    /// # Errors
    /// [`NonholoError`] if they cannot be derived.
    pub fn equations(&self) -> Result<Equations<'g>, NonholoError> {
        self.bound.equations(&self.system, &self.at_start())
    }

    /// The system of the independent quasi-velocities whose equations (9) are the equations of motion.
    ///
    /// # Errors
    /// [`NonholoError`] if it cannot be derived.
    pub fn free_system(&self) -> Result<System<'g>, NonholoError> {
        self.bound.free_system(&self.system, &self.at_start())
    }

    /// Each quasi-velocity of the system as a function of time, coordinates and the `free` ones, those of a
    /// [free system](Assembly::free_system) or all.
    ///
    /// # Errors
    /// [`NonholoError`] if these do not determine the others.
    pub fn quasi_velocities_of(&self, free: &[Expr<'g>]) -> Result<Vec<Expr<'g>>, NonholoError> {
        self.bound.quasi_velocities_of(self.system.quasi_velocities(), free)
    }

    /// Whether the motion is proved to keep its energy, that of all velocities where multipliers hold constraints, else that
    /// of the free ones: dH/dt = X_0 H + c_0r^m η_r y_m + Q_s η_s vanishes where the constraints hold, and these are
    /// homogeneous in the velocities, so that their reactions do no work.
    pub fn keeps_energy(&self) -> bool {
        let (system, graph) = (&self.system, self.system.graph());
        match self.bound.form() {
            Form::Held(held) => {
                let mut constraints = held.multipliers.constraints().iter();
                system.energy_rate().is_zero() && constraints.all(|c| c.is_workless(system))
            }
            Form::Free => system.energy_rate().is_zero(),
            Form::Vanishing(constrained) => {
                let zeros: Vec<_> = constrained.vanishing().iter().map(|&eta| (eta, Expr::ZERO)).collect();
                graph.substitute(&[system.energy_rate()], &zeros)[0].is_zero()
            }
        }
    }

    /// The quasi-velocities of the system at the start.
    pub fn start_velocities(&self) -> Vec<f64> {
        self.start_of(self.system.quasi_velocities())
    }

    /// The start state of a motion with these components: coordinates and some of the quasi-velocities.
    pub fn start_of(&self, components: &[Expr<'g>]) -> Vec<f64> {
        let at = self.at_start();
        let value =
            |x: &Expr<'g>| at.iter().find(|(known, _)| known == x).map_or(f64::NAN, |&(_, value)| value);
        components.iter().map(value).collect()
    }
}

/// A name that is not a parameter of the model.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{name}` is not a parameter of this model; its parameters are {}", if known.is_empty() { "none".to_owned() } else { known.join(", ") })]
pub struct UnknownParameter {
    /// The name asked for.
    pub name: String,
    /// The parameters there are.
    pub known: Vec<String>,
}

/// A name that is not an integral of the model.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{name}` is not an integral of this model; there are {}", known.join(", "))]
pub struct UnknownIntegral {
    /// The name asked for.
    pub name: String,
    /// The integrals there are.
    pub known: Vec<String>,
}

impl Model {
    /// The model of a document.
    pub fn new(document: Document) -> Model {
        let kept = document.simulation.project.iter().map(|name| name.value.clone()).collect();
        Model {
            parameters: Parameters::new(&document),
            document,
            starts: Vec::new(),
            projects_start: false,
            held_starts: Vec::new(),
            observes_reactions: false,
            by_parameters: false,
            kept,
            external: Vec::new(),
        }
    }

    /// The document it was made from.
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// What the model calls itself, else the name of its file.
    pub fn title(&self) -> &str {
        let name = self.document.model.name.as_ref();
        name.map_or_else(|| self.document.source.name(), |name| name.value.as_str())
    }

    /// Sets a parameter, or an input that has no table, to another value than that of the file. Parameters that are expressions
    /// in it follow; one that is an expression itself is no longer.
    ///
    /// # Errors
    /// [`UnknownParameter`] with the parameters there are.
    pub fn set(&mut self, name: &str, value: f64) -> Result<(), UnknownParameter> {
        let is_set = |&place: &usize| !self.parameters.is_table(place);
        let names: Vec<String> = self.parameters().map(|(name, _)| name.to_owned()).collect();
        let Some(index) = names.iter().position(|known| known == name).filter(is_set) else {
            let known = (0..names.len()).filter(is_set).map(|place| names[place].clone()).collect();
            return Err(UnknownParameter { name: name.to_owned(), known });
        };
        self.parameters.set(index, value);
        Ok(())
    }

    /// Gives number `place` of the parameters and inputs another value.
    pub(crate) fn set_parameter(&mut self, place: usize, value: f64) {
        self.parameters.set(place, value);
    }

    /// Where number `place` of the parameters and inputs is written.
    pub(crate) fn parameter_place(&self, place: usize) -> Place {
        let parameters = self.document.parameters.iter().map(|p| &p.name);
        let mut names = parameters.chain(self.document.inputs.iter().map(|input| &input.name));
        names.nth(place).map_or_else(|| self.document.end(), |name| name.place.clone())
    }

    /// The names and values of the parameters, then of the inputs: of those with a table that at the start.
    pub fn parameters(&self) -> impl Iterator<Item = (&str, f64)> {
        let parameters = self.document.parameters.iter().map(|p| &p.name);
        let names = parameters.chain(self.document.inputs.iter().map(|input| &input.name));
        names.map(|name| name.text.as_str()).zip(self.parameters.values().iter().copied())
    }

    /// The values of the parameters, to be changed by themselves.
    pub fn parameter_values(&self) -> &Parameters {
        &self.parameters
    }

    /// The mechanical system, its expressions in `graph`, and its start state.
    ///
    /// # Errors
    /// [`ModelError`] at the place in the file that is to blame.
    pub fn assemble<'g>(&self, graph: &'g Graph) -> Result<Assembly<'g>, ModelError> {
        self.refuse_unsupported()?;
        self.parameters.check(&self.document)?;
        assemble(self, graph)
    }

    /// Compiles the motion of this model and tries it at the start, which is returned with it: (x, η) with the free
    /// quasi-velocities if constraints say that the others vanish, with all otherwise.
    ///
    /// # Errors
    /// [`ModelError`] if it cannot be evaluated there.
    pub fn compile(&self, assembly: &Assembly<'_>) -> Result<(Motion, Vec<f64>), ModelError> {
        let refused = |error| self.constraint_error(error);
        match assembly.bound.form() {
            Form::Held(held) => {
                let (compiled, start) =
                    (held.multipliers.compile_for(self.options()), assembly.start.clone());
                self.started(compiled, || held.multipliers.kept(&self.kept), assembly.t_start, start)
            }
            Form::Free | Form::Vanishing(_) => {
                let equations = assembly.equations().map_err(refused)?;
                let system = equations.system();
                let state = system.state();
                let (compiled, start) = (equations.compile_for(self.options()), assembly.start_of(&state));
                self.started(compiled, || equations.kept(&self.kept), assembly.t_start, start)
            }
        }
    }

    /// Compiles canonical equations of this model and tries them at the start (x, y).
    ///
    /// # Errors
    /// [`ModelError`] if they cannot be evaluated there.
    pub fn compile_canonical(
        &self,
        equations: &Canonical<'_>,
        t_start: f64,
        start: &[f64],
    ) -> Result<Motion, ModelError> {
        let compiled = equations.compile_for(self.options());
        let (motion, _) = self.started(compiled, || equations.kept(&self.kept), t_start, start.to_vec())?;
        Ok(motion)
    }

    /// Compiles the canonical equations of this model with multipliers, and tries them at the start (x, y).
    ///
    /// # Errors
    /// [`ModelError`] if they cannot be evaluated there.
    pub fn compile_in_momenta(
        &self,
        multipliers: &Multipliers<'_>,
        assembly: &Assembly<'_>,
        start: &[f64],
    ) -> Result<Motion, ModelError> {
        let compiled = multipliers.compile_in_momenta(self.options(), &assembly.start_velocities());
        let kept = || multipliers.kept(&self.kept);
        Ok(self.started(compiled, kept, assembly.t_start, start.to_vec())?.0)
    }

    /// The derivative by external forces is part of the Jacobian under them.
    fn options(&self) -> CompileOptions {
        CompileOptions::default().parameter_jacobian(self.by_parameters || !self.external.is_empty())
    }

    /// What was compiled, if it can be evaluated at the start, projected to the integrals that are to be kept. These are to be
    /// integrals whatever the external forces.
    fn started(
        &self,
        compiled: Result<Motion, MechError>,
        kept: impl FnOnce() -> Result<KeptIntegrals, MechError>,
        t_start: f64,
        start: Vec<f64>,
    ) -> Result<(Motion, Vec<f64>), ModelError> {
        let refuse = |cause: String| self.error(&self.energy_place(), Fault::SingularStart { cause });
        let mut motion = compiled.map_err(|error| refuse(error.to_string()))?.driven_by(self.signals());
        let mut rate = vec![0.0; start.len()];
        motion.rhs(t_start, &start, &mut rate).map_err(|failure| match MechError::from(failure) {
            error @ MechError::SingularConstraint { .. } => self.constraint_error(error.into()),
            error => refuse(error.to_string()),
        })?;
        if let Some(name) = self.kept.first().filter(|_| !self.parameters.tables().is_empty()) {
            let message = format!("`{name}` cannot be kept where inputs change with time");
            let help = "leave it out of `project`, or give the inputs constant values";
            return Err(self.error(&self.kept_place(name), Fault::NoForm { message, help }));
        }
        if !self.kept.is_empty() {
            let kept = kept().map_err(|error| self.derivation_error(error))?;
            let forces = motion.parameters().len() - self.external.len()..;
            for (i, force) in motion.parameters_mut()[forces.clone()].iter_mut().enumerate() {
                *force = std::f64::consts::PI / (i + 1) as f64; // in balance with nothing that is written
            }
            motion = motion.keep(kept, t_start, &start).map_err(|error| self.derivation_error(error))?;
            motion.parameters_mut()[forces].fill(0.0);
        }
        Ok((motion, start))
    }

    /// The inputs that have tables.
    pub(crate) fn signals(&self) -> Signals {
        let names: Vec<&str> = self.parameters().map(|(name, _)| name).collect();
        let tables = self.parameters.tables().into_iter();
        Signals::new(tables.map(|(place, table)| (names[place], place, Arc::clone(table))))
    }

    /// The names of the integrals that the motion is projected to.
    pub fn kept(&self) -> &[String] {
        &self.kept
    }

    /// Says that the motion is to be projected to the value that an integral, or `energy`, has at the start.
    ///
    /// # Errors
    /// [`UnknownIntegral`] with the integrals there are.
    pub fn keep(&mut self, name: &str) -> Result<(), UnknownIntegral> {
        let integrals = self.document.integrals.iter().map(|integral| integral.name.text.as_str());
        let known: Vec<&str> = integrals.chain(["energy"]).collect();
        if !known.contains(&name) {
            let known = known.into_iter().map(str::to_owned).collect();
            return Err(UnknownIntegral { name: name.to_owned(), known });
        }
        if !self.kept.iter().any(|kept| kept == name) {
            self.kept.push(name.to_owned());
        }
        Ok(())
    }

    /// Says that the start is to be moved to where the constraints are satisfied.
    pub fn project_start(&mut self, yes: bool) {
        self.projects_start = yes;
    }

    /// Says that start value number `place` is not to be moved.
    pub(crate) fn hold_start_at(&mut self, place: usize) {
        if !self.held_starts.contains(&place) {
            self.held_starts.push(place);
            self.held_starts.sort_unstable();
        }
    }

    /// The places of the start values that are not to be moved, rising.
    pub(crate) fn held_starts(&self) -> &[usize] {
        &self.held_starts
    }

    /// Says that the reactions of all constraints are outputs, each called `λ_` and the name of its constraint.
    pub fn observe_reactions(&mut self, yes: bool) {
        self.observes_reactions = yes;
    }

    /// Says that sensitivities will be asked for: motions are compiled with their derivatives by the parameters, and events with
    /// theirs by time, state and parameters.
    pub fn differentiate_by_parameters(&mut self, yes: bool) {
        self.by_parameters = yes;
    }

    pub(crate) fn differentiates_by_parameters(&self) -> bool {
        self.by_parameters
    }

    pub(crate) fn observes_reactions(&self) -> bool {
        self.observes_reactions
    }

    /// Replaces start value number `place`.
    pub(crate) fn override_start(&mut self, place: usize, value: f64) {
        self.starts.retain(|&(known, _)| known != place);
        self.starts.push((place, value));
    }

    /// The start values that are not those of the document, by their places.
    pub(crate) fn overridden_starts(&self) -> &[(usize, f64)] {
        &self.starts
    }

    /// Whether the start is to be moved to where the constraints are satisfied.
    pub fn projects_start(&self) -> bool {
        self.projects_start
    }

    /// Puts an error of the derivation under constraints at the place in the file that is to blame.
    pub fn constraint_error(&self, error: NonholoError) -> ModelError {
        let message = error.to_string();
        let cannot = |name: &str, help| {
            self.constraint_fault(name, Fault::Constraint { message: message.clone(), help })
        };
        let last = self.document.constraints.last().map_or("", |constraint| constraint.name.text.as_str());
        match error {
            NonholoError::Contradictory { constraint, .. } => {
                cannot(&constraint, "no motion satisfies it; mend it or leave it out")
            }
            NonholoError::Nonlinear { constraint, .. } => {
                cannot(&constraint, "take a form with multipliers: poincare, lagrange, or canonical")
            }
            NonholoError::Mech(error) => match error {
                MechError::ConstraintNotAffine { constraint } => {
                    let text = self.constraint_text(&constraint).map(|c| c.expression.text.clone());
                    let text = text.unwrap_or_default();
                    let fault = Fault::ConstraintNotAffine { constraint: constraint.clone(), text };
                    self.constraint_fault(&constraint, fault)
                }
                MechError::TooManyConstraints { .. } => cannot(
                    last,
                    "there must be fewer independent constraints than velocities, or nothing moves",
                ),
                MechError::DependentConstraint { constraint } => {
                    cannot(&constraint, "leave out what follows from other constraints")
                }
                MechError::SingularConstraint { constraint, .. } => {
                    cannot(&constraint, "start where the constraints are independent of each other")
                }
                MechError::NoProjection { constraints, .. } => cannot(
                    constraints.first().map_or(last, String::as_str),
                    "start nearer to a state that satisfies them, if there is one",
                ),
                other => self.derivation_error(other),
            },
            NonholoError::NotAQuasiVelocity { .. }
            | NonholoError::Twice { .. }
            | NonholoError::NotInVelocities => cannot(last, "check [constraints]"),
        }
    }

    /// The text of a constraint.
    pub(crate) fn constraint_text(&self, name: &str) -> Option<&document::Constraint> {
        self.document.constraints.iter().find(|constraint| constraint.name.text == name)
    }

    /// A fault of a constraint, at its expression.
    pub(crate) fn constraint_fault(&self, name: &str, fault: Fault) -> ModelError {
        let expression = self.constraint_text(name).map(|constraint| &constraint.expression);
        let place = expression.map(|expression| expression.place(expression.ast.span));
        self.error(&place.unwrap_or_else(|| self.document.end()), fault)
    }

    /// Puts an error of the derivation at the place in the file that is to blame.
    pub fn derivation_error(&self, error: MechError) -> ModelError {
        match error {
            MechError::DegenerateLagrangian { rank, size, quasi_velocities: undetermined } => {
                self.error(&self.energy_place(), Fault::Degenerate { rank, size, undetermined })
            }
            error @ (MechError::Redundant { .. }
            | MechError::Algebra(AlgebraError::DependentOperators { .. })) => {
                let help = "its forms are poincare and canonical, in the quasi-velocities of the model";
                self.error(&self.energy_place(), Fault::NoForm { message: error.to_string(), help })
            }
            error @ MechError::NotQuadratic { .. } => {
                let help = "its forms are poincare and, where the coordinates are independent, lagrange";
                self.error(&self.energy_place(), Fault::NoForm { message: error.to_string(), help })
            }
            MechError::Algebra(error) => self.algebra_error(error),
            MechError::UnknownIntegral { name, known } => {
                self.error(&self.kept_place(&name), Fault::UnknownIntegral { name, known })
            }
            MechError::NotAnIntegral { name, t, rate } => {
                self.error(&self.kept_place(&name), Fault::NotAnIntegral { name, t, rate })
            }
            other => self.error(&self.energy_place(), Fault::Derivation { message: other.to_string() }),
        }
    }

    pub(crate) fn error(&self, place: &Place, kind: impl Into<ErrorKind>) -> ModelError {
        self.document.source.error(place, kind)
    }

    /// Where it is said that an integral is to be kept; its definition if it is said elsewhere.
    fn kept_place(&self, name: &str) -> Place {
        let written = self.document.simulation.project.iter().find(|written| written.value == name);
        let integral = || self.document.integrals.iter().find(|integral| integral.name.text == name);
        let defined = || integral().map(|integral| integral.name.place.clone());
        written.map(|name| name.place.clone()).or_else(defined).unwrap_or_else(|| self.energy_place())
    }

    fn energy_place(&self) -> Place {
        let document = &self.document;
        let energy = document.lagrangian.as_ref().map(|l| &l.place);
        let place = energy.or_else(|| document.bodies.first().map(|body| &body.place));
        place.cloned().unwrap_or_else(|| document.end())
    }

    fn refuse_unsupported(&self) -> Result<(), ModelError> {
        let document = &self.document;
        let refuse = |place: &Place, what| Err(self.error(place, ErrorKind::Unsupported { what }));
        let simulation = &document.simulation;
        if let Some(method) = &simulation.method
            && !matches!(method.value, Method::Bdf | Method::Adams)
        {
            return refuse(&method.place, "methods other than bdf and adams are");
        }
        Ok(())
    }

    /// The name of operator number s, from 1; 0 is time.
    fn operator_name(&self, s: usize) -> String {
        let declared = &self.document.quasi_velocities;
        match (s, declared.is_empty()) {
            (0, _) => "t".to_owned(),
            (_, false) => declared.get(s - 1).map_or_else(String::new, |q| q.name.text.clone()),
            (_, true) => {
                self.document.coordinates.get(s - 1).map_or_else(String::new, |x| format!("{}'", x.name.text))
            }
        }
    }

    fn operator_place(&self, s: usize) -> Place {
        let quasi_velocity = self.document.quasi_velocities.get(s.max(1) - 1);
        quasi_velocity.map_or_else(|| self.document.end(), |q| q.name.place.clone())
    }

    pub(crate) fn algebra_error(&self, error: AlgebraError) -> ModelError {
        let names = |pair: (usize, usize)| [self.operator_name(pair.0), self.operator_name(pair.1)];
        let brackets_of = |pair: (usize, usize)| -> Place {
            let algebra = self.document.algebra.as_ref();
            let brackets = match algebra.map(|a| &a.definition) {
                None => return self.operator_place(pair.1),
                Some(AlgebraDefinition::Catalogue(name)) => return name.place.clone(),
                Some(AlgebraDefinition::Brackets(brackets)) => brackets,
            };
            let section = algebra.map_or_else(|| self.document.end(), |a| a.place.clone());
            let [r, s] = names(pair);
            let matches = |b: &&Bracket| {
                (b.left.text == r && b.right.text == s) || (b.left.text == s && b.right.text == r)
            };
            brackets.iter().find(matches).map_or(section, |b| b.left.place.clone())
        };
        match error {
            AlgebraError::RankDeficient { rank, operators, pair } => self.error(
                &self.operator_place(pair.1),
                Fault::RankDeficient { rank, operators, pair: names(pair) },
            ),
            AlgebraError::Undetermined { combination, operators, .. } => {
                let last = combination.last().map_or(1, |&(s, _)| s);
                let names = (1..=operators).map(|s| self.operator_name(s)).collect();
                self.error(&self.operator_place(last), Fault::Undetermined { combination, names })
            }
            AlgebraError::NotClosed { pair, residual } => {
                self.error(&self.operator_place(pair.1), Fault::NotClosed { pair: names(pair), residual })
            }
            AlgebraError::Contradiction { pair, residual } => {
                self.error(&brackets_of(pair), Fault::Contradiction { pair: names(pair), residual })
            }
            AlgebraError::Jacobi { triple: (r, s, u), component, defect } => {
                let triple = [r, s, u].map(|s| self.operator_name(s));
                let fault = Fault::Jacobi { triple, component: self.operator_name(component), defect };
                self.error(&brackets_of((r, s)), fault)
            }
            AlgebraError::AlgebraNeeded => self.error(&self.operator_place(1), Fault::AlgebraNeeded),
            other => self.error(&self.operator_place(1), Fault::Derivation { message: other.to_string() }),
        }
    }
}
