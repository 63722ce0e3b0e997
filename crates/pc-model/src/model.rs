//! A document as a mechanical system.

mod bodies;

use pc_expr::Graph;
use pc_mech::{
    AlgebraError, Canonical, CompileOptions, Equations, Expr, Frame, LieAlgebra, MechError, Motion, Number,
    StructureCoefficients, System, VectorField,
};

use crate::document::{AlgebraDefinition, Bracket, Document, Method, NamedExpression};
use crate::error::{ErrorKind, ModelError};
use crate::fault::Fault;
use crate::model::bodies::Body;
use crate::scope::{Scope, Stage, entry};
use crate::source::Place;

/// A model whose parameters can be set and that can be turned into a mechanical system.
#[derive(Clone, Debug)]
pub struct Model {
    document: Document,
    parameters: Vec<f64>,
}

/// The system of a model, with the state its motion starts from.
pub struct Assembly<'g> {
    /// The system.
    pub system: System<'g>,
    /// Start time.
    pub t_start: f64,
    /// Start state: coordinates, then quasi-velocities.
    pub start: Vec<f64>,
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

impl Model {
    /// The model of a document.
    pub fn new(document: Document) -> Model {
        let parameters = document.parameters.iter().map(|p| p.value.value).collect();
        Model { document, parameters }
    }

    /// The document it was made from.
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// Sets a parameter to another value than that of the file.
    ///
    /// # Errors
    /// [`UnknownParameter`] with the parameters there are.
    pub fn set(&mut self, name: &str, value: f64) -> Result<(), UnknownParameter> {
        let parameters = &self.document.parameters;
        let Some(index) = parameters.iter().position(|p| p.name.text == name) else {
            let known = parameters.iter().map(|p| p.name.text.clone()).collect();
            return Err(UnknownParameter { name: name.to_owned(), known });
        };
        self.parameters[index] = value;
        Ok(())
    }

    /// The names and values of the parameters.
    pub fn parameters(&self) -> impl Iterator<Item = (&str, f64)> {
        self.document.parameters.iter().map(|p| p.name.text.as_str()).zip(self.parameters.iter().copied())
    }

    /// The mechanical system, its expressions in `graph`, and its start state.
    ///
    /// # Errors
    /// [`ModelError`] at the place in the file that is to blame.
    pub fn assemble<'g>(&self, graph: &'g Graph) -> Result<Assembly<'g>, ModelError> {
        self.refuse_unsupported()?;
        let mut assembler = Assembler { model: self, graph, scope: Scope::new(graph, &self.document) };
        assembler.assemble()
    }

    /// Compiles equations of this model and tries them at the start.
    ///
    /// # Errors
    /// [`ModelError`] if they cannot be evaluated there.
    pub fn compile(
        &self,
        equations: &Equations<'_>,
        t_start: f64,
        start: &[f64],
    ) -> Result<Motion, ModelError> {
        self.started(equations.compile(), t_start, start)
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
        self.started(equations.compile_for(CompileOptions::default()), t_start, start)
    }

    /// What was compiled, if it can be evaluated at the start.
    fn started(
        &self,
        compiled: Result<Motion, MechError>,
        t_start: f64,
        start: &[f64],
    ) -> Result<Motion, ModelError> {
        let refuse = |cause: String| self.error(&self.energy_place(), Fault::SingularStart { cause });
        let mut motion = compiled.map_err(|error| refuse(error.to_string()))?;
        let mut rate = vec![0.0; start.len()];
        motion.rhs(t_start, start, &mut rate).map_err(|failure| refuse(failure.to_string()))?;
        Ok(motion)
    }

    /// Puts an error of the derivation at the place in the file that is to blame.
    pub fn derivation_error(&self, error: MechError) -> ModelError {
        match error {
            MechError::DegenerateLagrangian { rank, size, quasi_velocities: undetermined } => {
                self.error(&self.energy_place(), Fault::Degenerate { rank, size, undetermined })
            }
            MechError::Algebra(error) => self.algebra_error(error),
            other => self.error(&self.energy_place(), Fault::Derivation { message: other.to_string() }),
        }
    }

    fn error(&self, place: &Place, kind: impl Into<ErrorKind>) -> ModelError {
        self.document.source.error(place, kind)
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
        if let Some(constraint) = document.constraints.first() {
            return refuse(&constraint.name.place, "[constraints] are");
        }
        if let Some(event) = document.events.first() {
            return refuse(&event.place, "[events] are");
        }
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

    fn algebra_error(&self, error: AlgebraError) -> ModelError {
        let names = |pair: (usize, usize)| [self.operator_name(pair.0), self.operator_name(pair.1)];
        let brackets_of = |pair: (usize, usize)| -> Place {
            let algebra = self.document.algebra.as_ref();
            let section = algebra.map_or_else(|| self.operator_place(pair.1), |a| a.place.clone());
            let Some(AlgebraDefinition::Brackets(brackets)) = algebra.map(|a| &a.definition) else {
                return section;
            };
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

struct Assembler<'g, 'm> {
    model: &'m Model,
    graph: &'g Graph,
    scope: Scope<'g, 'm>,
}

impl<'g> Assembler<'g, '_> {
    fn assemble(&mut self) -> Result<Assembly<'g>, ModelError> {
        let document = &self.model.document;
        let parameters: Vec<(Expr<'g>, f64)> =
            self.model.parameters().map(|(name, value)| (self.graph.symbol(name), value)).collect();
        let start = self.start(&parameters)?;
        let t_start = document.simulation.t_start.as_ref().map_or(0.0, |t| t.value);
        let frame = self.frame()?;
        let eta =
            if self.is_lagrangian_form() { self.scope.velocities() } else { self.scope.quasi_velocities() };

        let velocities = frame.velocities(&eta);
        let x_dot: Vec<(Expr<'g>, Expr<'g>)> = self
            .scope
            .velocities()
            .into_iter()
            .zip(velocities)
            .filter(|(symbol, value)| symbol != value)
            .collect();
        let lagrangian = self.lagrangian(&x_dot)?;
        let bodies = self.bodies(&eta, &x_dot)?;
        let dissipation = self.dissipation(&x_dot)?;
        let (forces, on_coordinates) = self.forces(&x_dot)?;
        let integrals = self.observed(&document.integrals, &x_dot)?;
        let outputs = self.observed(&document.outputs, &x_dot)?;

        let state: Vec<Expr<'g>> = frame.coordinates().iter().chain(&eta).copied().collect();
        let mut values = parameters.clone();
        values.push((frame.time(), t_start));
        values.extend(state.iter().copied().zip(start.iter().copied()));
        self.check_finite(&values, &x_dot, &state)?;

        let mut builder = System::builder(self.graph)
            .coordinates(document.coordinates.iter().map(|c| &c.name.text))
            .quasi_velocities(eta.iter().map(Expr::to_string))
            .near(values)
            .lagrangian(|_, _, _| lagrangian)
            .dissipation(|_, _, _| dissipation)
            .forces(|_, _, _| forces)
            .force_on_coordinates(|_, _, _| on_coordinates);
        for body in bodies {
            builder = match body {
                Body::Particle(particle) => builder.particle(|_, _, _| particle),
                Body::Rigid(body) => builder.rigid_body(|_, _, _| *body),
            };
        }
        for (symbol, value) in parameters {
            builder = builder.parameter(symbol, value);
        }
        for (name, value) in integrals {
            builder = builder.integral(name, |_, _, _| value);
        }
        for (name, value) in outputs {
            builder = builder.output(name, |_, _, _| value);
        }
        if let Some(structure) = self.structure(&eta)? {
            builder = builder.structure(structure);
        }
        let system = builder.frame(frame).build().map_err(|error| self.model.derivation_error(error))?;
        Ok(Assembly { system, t_start, start })
    }

    /// Whether η_s = ẋ_s because no quasi-velocity is declared.
    fn is_lagrangian_form(&self) -> bool {
        self.model.document.quasi_velocities.is_empty()
    }

    fn start(&mut self, parameters: &[(Expr<'g>, f64)]) -> Result<Vec<f64>, ModelError> {
        let document = &self.model.document;
        let mut start = Vec::new();
        for coordinate in &document.coordinates {
            start.push(self.start_value(&coordinate.expression, parameters)?);
        }
        for quasi_velocity in &document.quasi_velocities {
            start.push(match &quasi_velocity.start {
                Some(expression) => self.start_value(expression, parameters)?,
                None => 0.0,
            });
        }
        for velocity in &document.start_velocities {
            let name = &velocity.name;
            if entry(&document.coordinates, &name.text).is_none() {
                return Err(self.not_a_coordinate(name));
            }
            if !self.is_lagrangian_form() {
                let what = "start velocities of coordinates beside quasi-velocities are";
                return Err(self.model.error(&name.place, ErrorKind::Unsupported { what }));
            }
        }
        if self.is_lagrangian_form() {
            for coordinate in &document.coordinates {
                start.push(match entry(&document.start_velocities, &coordinate.name.text) {
                    Some(velocity) => self.start_value(&velocity.expression, parameters)?,
                    None => 0.0,
                });
            }
        }
        Ok(start)
    }

    fn start_value(
        &mut self,
        expression: &crate::document::Expression,
        parameters: &[(Expr<'g>, f64)],
    ) -> Result<f64, ModelError> {
        let value = self.scope.resolve(expression, Stage::Start)?;
        let values = self.graph.evaluate(&[value], parameters);
        let value = values.map_or(f64::NAN, |values| values[0]); // parameters are all there can be in it
        if value.is_finite() {
            return Ok(value);
        }
        let fault = |text| Fault::NotFinite { text, value, state: Vec::new() };
        Err(self.scope.error(expression, expression.ast.span, fault))
    }

    fn not_a_coordinate(&self, name: &crate::document::Name) -> ModelError {
        let coordinates = self.model.document.coordinates.iter().map(|c| c.name.text.clone()).collect();
        self.model.error(&name.place, Fault::NotACoordinate { name: name.text.clone(), coordinates })
    }

    /// The frame in one of its four ways: kinematics, definitions, neither (Lagrange), or no coordinates at all.
    fn frame(&mut self) -> Result<Frame<'g>, ModelError> {
        let document = &self.model.document;
        let (time, x) = (self.graph.symbol("t"), self.scope.coordinates());
        if let Some(stray) =
            document.kinematics.iter().find(|k| entry(&document.coordinates, &k.name.text).is_none())
        {
            return Err(self.not_a_coordinate(&stray.name));
        }
        let defined = document.quasi_velocities.iter().find(|q| q.is.is_some());
        match (defined, document.kinematics.first()) {
            (Some(defined), Some(_)) => Err(self
                .model
                .error(&defined.name.place, Fault::TwoKinematics { name: defined.name.text.clone() })),
            (Some(_), None) => self.frame_of_definitions(time, x),
            (None, Some(_)) => self.frame_of_kinematics(time, x),
            (None, None) if self.is_lagrangian_form() => Ok(Frame::coordinate(self.graph, time, x)),
            (None, None) if x.is_empty() => {
                let k = document.quasi_velocities.len();
                let b = pc_mech::Matrix::from_fn(0, k, |_, _| Expr::ZERO);
                Frame::new(self.graph, time, x, b, Vec::new()).map_err(|e| self.model.algebra_error(e))
            }
            (None, None) => {
                let name = &document.quasi_velocities[0].name;
                Err(self.model.error(&name.place, Fault::Undefined { name: name.text.clone() }))
            }
        }
    }

    fn frame_of_kinematics(&mut self, time: Expr<'g>, x: Vec<Expr<'g>>) -> Result<Frame<'g>, ModelError> {
        let document = &self.model.document;
        let mut velocities = Vec::new();
        for coordinate in &document.coordinates {
            let Some(kinematics) = entry(&document.kinematics, &coordinate.name.text) else {
                let coordinate = coordinate.name.text.clone();
                return Err(self
                    .model
                    .error(&document.kinematics[0].name.place, Fault::KinematicsMissing { coordinate }));
            };
            velocities.push(self.scope.resolve(&kinematics.expression, Stage::Kinematics)?);
        }
        let eta = self.scope.quasi_velocities();
        Frame::from_velocities(self.graph, time, x, &eta, &velocities).map_err(|error| match error {
            AlgebraError::NotAffine { coordinate, .. } => match entry(&document.kinematics, &coordinate) {
                Some(NamedExpression { expression, .. }) => {
                    let fault = |text| Fault::NotAffine { text, variables: "quasi-velocities" };
                    self.scope.error(expression, expression.ast.span, fault)
                }
                None => {
                    self.model.algebra_error(AlgebraError::NotAffine { coordinate, velocity: String::new() })
                }
            },
            other => self.model.algebra_error(other),
        })
    }

    fn frame_of_definitions(&mut self, time: Expr<'g>, x: Vec<Expr<'g>>) -> Result<Frame<'g>, ModelError> {
        let document = &self.model.document;
        let mut definitions = Vec::new();
        for quasi_velocity in &document.quasi_velocities {
            let Some(is) = &quasi_velocity.is else {
                let name = quasi_velocity.name.text.clone();
                return Err(self.model.error(&quasi_velocity.name.place, Fault::Undefined { name }));
            };
            definitions.push(self.scope.resolve(is, Stage::Definition)?);
        }
        let place = &document.quasi_velocities[0].name.place;
        if definitions.len() != x.len() {
            let (definitions, coordinates) = (definitions.len(), x.len());
            return Err(self.model.error(place, Fault::DefinitionCount { definitions, coordinates }));
        }
        let velocities = self.scope.velocities();
        Frame::from_definitions(self.graph, time, x, &velocities, &definitions).map_err(|error| match error {
            AlgebraError::DefinitionNotAffine { row, .. } => match &document.quasi_velocities[row - 1].is {
                Some(is) => {
                    let fault = |text| Fault::NotAffine { text, variables: "velocities" };
                    self.scope.error(is, is.ast.span, fault)
                }
                None => self.model.error(place, Fault::DependentDefinitions),
            },
            AlgebraError::SingularDefinitions => self.model.error(place, Fault::DependentDefinitions),
            other => self.model.algebra_error(other),
        })
    }

    /// T − V of `[lagrangian]`, the whole energy but for that of the bodies.
    fn lagrangian(&mut self, x_dot: &[(Expr<'g>, Expr<'g>)]) -> Result<Expr<'g>, ModelError> {
        let Some(energy) = &self.model.document.lagrangian else { return Ok(Expr::ZERO) };
        let mut lagrangian = Expr::ZERO;
        for (expression, sign) in [(&energy.kinetic, 1), (&energy.potential, -1), (&energy.lagrangian, 1)] {
            if let Some(expression) = expression {
                lagrangian += self.dynamic(expression, x_dot)? * sign;
            }
        }
        Ok(lagrangian)
    }

    fn dissipation(&mut self, x_dot: &[(Expr<'g>, Expr<'g>)]) -> Result<Expr<'g>, ModelError> {
        let energy = self.model.document.lagrangian.as_ref();
        match energy.and_then(|energy| energy.dissipation.as_ref()) {
            Some(dissipation) => self.dynamic(dissipation, x_dot),
            None => Ok(Expr::ZERO),
        }
    }

    /// An expression of the dynamics with ẋ = b η + b_0 put in.
    fn dynamic(
        &mut self,
        expression: &crate::document::Expression,
        x_dot: &[(Expr<'g>, Expr<'g>)],
    ) -> Result<Expr<'g>, ModelError> {
        let value = self.scope.resolve(expression, Stage::Dynamics)?;
        Ok(self.graph.substitute(&[value], x_dot)[0])
    }

    /// The entries of `[forces]`: Q_s on quasi-velocities, and F_i on coordinates.
    fn forces(
        &mut self,
        x_dot: &[(Expr<'g>, Expr<'g>)],
    ) -> Result<(Vec<Expr<'g>>, Vec<Expr<'g>>), ModelError> {
        let document = &self.model.document;
        let mut on_coordinates = vec![Expr::ZERO; document.coordinates.len()];
        let mut forces = match self.is_lagrangian_form() {
            true => on_coordinates.clone(),
            false => vec![Expr::ZERO; document.quasi_velocities.len()],
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
                    return Err(self
                        .model
                        .error(&name.place, Fault::NothingToPush { name: name.text.clone(), known }));
                }
            }
        }
        Ok((forces, on_coordinates))
    }

    fn observed(
        &mut self,
        list: &[NamedExpression],
        x_dot: &[(Expr<'g>, Expr<'g>)],
    ) -> Result<Vec<(String, Expr<'g>)>, ModelError> {
        let mut observed = Vec::new();
        for item in list {
            let value = self.scope.resolve(&item.expression, Stage::Observation)?;
            observed.push((item.name.text.clone(), self.with_velocities(value, x_dot)));
        }
        Ok(observed)
    }

    /// Puts ẋ = b η + b_0 in, and its derivative along the motion for the accelerations x''.
    fn with_velocities(&self, value: Expr<'g>, x_dot: &[(Expr<'g>, Expr<'g>)]) -> Expr<'g> {
        let graph = self.graph;
        let eta = self.scope.quasi_velocities();
        let mut rates: Vec<(Expr<'g>, Expr<'g>)> = x_dot
            .iter()
            .filter_map(|(velocity, rate)| {
                let name = velocity.symbol_name()?;
                Some((graph.symbol(name.strip_suffix('\'')?), *rate))
            })
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

    /// The structure coefficients given in `[algebra]`.
    fn structure(&mut self, eta: &[Expr<'g>]) -> Result<Option<StructureCoefficients<'g>>, ModelError> {
        let Some(algebra) = &self.model.document.algebra else { return Ok(None) };
        match &algebra.definition {
            AlgebraDefinition::Catalogue(name) => {
                let algebra = LieAlgebra::named(&name.value).map_err(|error| match error {
                    AlgebraError::UnknownAlgebra { name: wrong, known } => {
                        self.model.error(&name.place, Fault::UnknownAlgebra { name: wrong, known })
                    }
                    other => self.model.algebra_error(other),
                })?;
                if algebra.dim() != eta.len() {
                    let (dimension, operators) = (algebra.dim(), eta.len());
                    let fault = Fault::AlgebraDimension { name: name.value.clone(), dimension, operators };
                    return Err(self.model.error(&name.place, fault));
                }
                Ok(Some(algebra.structure_coefficients()))
            }
            AlgebraDefinition::Brackets(brackets) => self.structure_of(brackets, eta).map(Some),
        }
    }

    fn structure_of(
        &mut self,
        brackets: &[Bracket],
        eta: &[Expr<'g>],
    ) -> Result<StructureCoefficients<'g>, ModelError> {
        let k = eta.len();
        let index = |name: &crate::document::Name| -> Result<usize, ModelError> {
            let declared = &self.model.document.quasi_velocities;
            match declared.iter().position(|q| q.name.text == name.text) {
                Some(s) => Ok(s + 1),
                None if name.text == "t" => Ok(0),
                None => {
                    let known =
                        declared.iter().map(|q| q.name.text.clone()).chain(["t".to_owned()]).collect();
                    let fault = Fault::UnknownName { name: name.text.clone(), known };
                    Err(self.model.error(&name.place, fault))
                }
            }
        };
        let mut table: Vec<((usize, usize), Vec<Number>)> = Vec::new();
        for bracket in brackets {
            let pair = (index(&bracket.left)?, index(&bracket.right)?);
            let value = self.scope.resolve(&bracket.value, Stage::Kinematics)?;
            let coefficients = self.graph.gradient(value, eta);
            let constants: Option<Vec<Number>> = coefficients.iter().map(|c| c.constant()).collect();
            let zero: Vec<_> = eta.iter().map(|&eta| (eta, Expr::ZERO)).collect();
            let remainder = self.graph.substitute(&[value], &zero)[0];
            let Some(constants) = constants.filter(|_| remainder.is_zero()) else {
                let fault = |text| Fault::BracketNotLinear { text };
                return Err(self.scope.error(&bracket.value, bracket.value.ast.span, fault));
            };
            let opposite: Vec<Number> = constants.iter().map(|&c| -c).collect();
            if table.iter().any(|(other, known)| *other == (pair.1, pair.0) && *known != opposite) {
                let (left, right) = (bracket.left.text.clone(), bracket.right.text.clone());
                return Err(self.model.error(&bracket.left.place, Fault::BracketsNotSkew { left, right }));
            }
            table.push((pair, constants));
        }
        let constant = |r: usize, s: usize, m: usize| -> Number {
            let direct = table.iter().find(|(pair, _)| *pair == (r, s)).map(|(_, c)| c[m]);
            let reverse = || table.iter().find(|(pair, _)| *pair == (s, r)).map(|(_, c)| -c[m]);
            direct.or_else(reverse).unwrap_or(Number::ZERO)
        };
        let algebra = LieAlgebra::new(k, |r, s, m| constant(r + 1, s + 1, m));
        let algebra = algebra.map_err(|error| self.model.algebra_error(error))?;
        Ok(algebra.with_time(|s, m| constant(0, s + 1, m)))
    }

    /// Looks for the first part of the model, as written, that is not a number at the start.
    fn check_finite(
        &self,
        values: &[(Expr<'g>, f64)],
        x_dot: &[(Expr<'g>, Expr<'g>)],
        state: &[Expr<'g>],
    ) -> Result<(), ModelError> {
        for written in &self.scope.written {
            let value = self.graph.substitute(&[written.value], x_dot);
            // What contains accelerations has no value yet: it is checked when the motion is computed.
            let Ok(value) = self.graph.evaluate(&value, values) else { continue };
            if value[0].is_finite() {
                continue;
            }
            let shown = values.iter().filter(|(symbol, _)| state.contains(symbol));
            let state = shown.map(|(symbol, value)| (symbol.to_string(), *value)).collect();
            let fault = Fault::NotFinite { text: written.text.clone(), value: value[0], state };
            return Err(self.model.error(&written.place, fault));
        }
        Ok(())
    }
}
