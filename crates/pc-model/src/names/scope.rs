//! Names and expressions of a model, resolved to expressions of a graph.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet, HashMap};

use pc_expr::parse::{Ast, AstKind, Factor, Sign, Span};
use pc_expr::{Expr, Graph};

use crate::assembly::resultant::{force_names, joint_force_names, joint_torque_names, torque_names};
use crate::diagnostics::error::ModelError;
use crate::diagnostics::error_kind::ErrorKind;
use crate::diagnostics::meaning::MeaningError;
use crate::diagnostics::source::{Place, Source};
use crate::document::{Body, Document, Expression, InputValue, NamedExpression, TreeBody};
use crate::names::functions::call;
use crate::names::moving::Moving;
use crate::names::stage::Stage;

/// A part of the model as written, with its expression; these parts are searched when a value is not a
/// number.
pub(crate) struct Written<'g> {
    pub(crate) value: Expr<'g>,
    pub(crate) place: Place,
    /// As far as a message shows it.
    pub(crate) text: String,
    context: Context<'g>,
}

/// The characters of a part that a message may show. Each operand of a long sum is a part of its own, and the text up
/// to it as long as the sum.
const MOST_SHOWN: usize = 600;

/// What an allocator keeps beside each piece of memory: its header and, on average, the rest of the last 16 bytes.
const ALLOCATED: usize = 24;

/// Where a part is written: in which definition, if any, and in which branches of `step`.
#[derive(Clone, Default)]
pub(super) struct Context<'g> {
    pub(super) definition: Option<(Stage, usize)>,
    pub(super) branches: Vec<Branch<'g>>,
}

/// One of the two branches of `step(condition, …, …)`.
#[derive(Clone)]
pub(super) struct Branch<'g> {
    condition: Expr<'g>,
    first: bool,
}

impl Branch<'_> {
    fn is_taken(&self, condition: f64) -> bool {
        if self.first { condition >= 0.0 } else { condition < 0.0 }
    }
}

/// The declared names of a model as symbols of a graph.
pub(crate) struct Scope<'g, 'd> {
    pub(super) graph: &'g Graph,
    pub(super) document: &'d Document,
    /// The source in which the expressions are located.
    source: &'d Source,
    pub(super) time: Expr<'g>,
    /// Symbols that have no declaration in the document.
    others: Vec<Expr<'g>>,
    /// The index of each definition in its section.
    pub(super) places: HashMap<&'d str, usize>,
    /// The definitions used so far: each is resolved once for each stage.
    pub(super) definitions: BTreeMap<(Stage, usize), Expr<'g>>,
    /// The places where definitions are used.
    pub(super) uses: Vec<((Stage, usize), Context<'g>)>,
    /// Where the part that is being resolved is written.
    pub(super) context: Context<'g>,
    /// Quotients, calls and whole expressions, in the order of their evaluation: each after its parts.
    pub(crate) written: Vec<Written<'g>>,
    /// The arguments of the function whose value is being resolved.
    pub(super) arguments: Vec<(&'d str, Expr<'g>)>,
    /// The values of the contacts used so far, by their numbers; none for one that is being found.
    pub(super) contacts: HashMap<usize, Option<Vec<Expr<'g>>>>,
    /// The components of points, which are all computed when one of them is used.
    pub(super) points: Option<HashMap<String, Expr<'g>>>,
    /// The motions of all bodies, which are computed when one of them is used.
    pub(super) moving: Option<Vec<Moving<'g>>>,
    /// The force functions of the forces on bodies that are placed by their position, in their order.
    pub(crate) force_functions: Vec<Expr<'g>>,
    /// The forces and torques of reactions that are used, each with a place in the file.
    pub(crate) resultants: Vec<(Expr<'g>, Place)>,
    /// The inputs whose rates are in use.
    pub(crate) rates_in_use: Vec<Expr<'g>>,
    /// The components of forces and torques of joints that have been named.
    pub(crate) of_joints: Vec<(Expr<'g>, Place)>,
}

impl<'g, 'd> Scope<'g, 'd> {
    /// Creates the symbols, beginning with the parameters, since print-outs list factors in the order in
    /// which their symbols were created.
    pub(crate) fn new(graph: &'g Graph, document: &'d Document) -> Scope<'g, 'd> {
        let names = document.parameters.iter().map(|p| &p.name.text);
        let coordinates = document.coordinates.iter().map(|c| &c.name.text);
        let quasi_velocities = document.quasi_velocities.iter().map(|q| &q.name.text);
        let states = document.states.iter().map(|state| &state.name.text);
        let inputs = document.inputs.iter().map(|input| &input.name.text);
        for name in names.chain(inputs).chain(coordinates).chain(quasi_velocities).chain(states) {
            graph.symbol(name);
        }
        for input in &document.inputs {
            if let InputValue::RateOf(of) = input.value {
                let function = graph.symbol(&document.inputs[of].name.text);
                graph.declare_rate(function, graph.symbol(&input.name.text));
            }
        }
        let time = graph.symbol("t");
        let places = document.definitions.iter().enumerate().map(|(place, d)| (d.name.text.as_str(), place));
        Scope {
            graph,
            document,
            source: &document.source,
            time,
            others: Vec::new(),
            places: places.collect(),
            definitions: BTreeMap::new(),
            uses: Vec::new(),
            context: Context::default(),
            written: Vec::new(),
            arguments: Vec::new(),
            contacts: HashMap::new(),
            points: None,
            moving: None,
            force_functions: Vec::new(),
            resultants: Vec::new(),
            rates_in_use: Vec::new(),
            of_joints: Vec::new(),
        }
    }

    /// A scope with the same names, for expressions in another source.
    pub(crate) fn elsewhere(self, source: &'d Source) -> Scope<'g, 'd> {
        Scope { source, ..self }
    }

    /// The scope with the names of other symbols, which those of the document hide.
    pub(crate) fn with_names_of(self, others: &[Expr<'g>]) -> Scope<'g, 'd> {
        Scope { others: others.to_vec(), ..self }
    }

    /// The scope with other values for the components of points.
    pub(crate) fn with_points(self, points: HashMap<String, Expr<'g>>) -> Scope<'g, 'd> {
        Scope { points: Some(points), ..self }
    }

    pub(crate) fn coordinates(&self) -> Vec<Expr<'g>> {
        self.document.coordinates.iter().map(|c| self.graph.symbol(&c.name.text)).collect()
    }

    pub(crate) fn velocity(&self, coordinate: &str) -> Expr<'g> {
        self.graph.symbol(&format!("{coordinate}'"))
    }

    pub(crate) fn velocities(&self) -> Vec<Expr<'g>> {
        self.document.coordinates.iter().map(|c| self.velocity(&c.name.text)).collect()
    }

    pub(crate) fn states(&self) -> Vec<Expr<'g>> {
        self.document.states.iter().map(|state| self.graph.symbol(&state.name.text)).collect()
    }

    pub(crate) fn quasi_velocities(&self) -> Vec<Expr<'g>> {
        self.document.quasi_velocities.iter().map(|q| self.graph.symbol(&q.name.text)).collect()
    }

    /// The expression for the value with index `place` among the parameters and, after them, the inputs.
    pub(crate) fn parameter(
        &mut self,
        place: usize,
        expression: &Expression,
    ) -> Result<Expr<'g>, ModelError> {
        self.context.definition = Some((Stage::Parameter, place));
        let value = self.resolve(expression, Stage::Parameter);
        self.context = Context::default();
        value
    }

    /// The expression in the graph, with velocities as symbols x'.
    pub(crate) fn resolve(&mut self, expression: &Expression, stage: Stage) -> Result<Expr<'g>, ModelError> {
        let before = self.graph.zero_divisions();
        let value = self.ast(expression, &expression.ast, stage)?;
        if self.graph.zero_divisions() > before {
            return Err(
                self.error(expression, expression.ast.span, |text| MeaningError::DivisionByZero { text })
            );
        }
        self.note(expression, expression.ast.span, value);
        Ok(value)
    }

    pub(crate) fn error(
        &self,
        expression: &Expression,
        span: Span,
        fault: impl FnOnce(String) -> MeaningError,
    ) -> ModelError {
        let text = expression.text.get(span.start..span.end).unwrap_or_default().to_owned();
        self.source.error(&expression.place(span), ErrorKind::Meaning(fault(text)))
    }

    pub(super) fn note(&mut self, expression: &Expression, span: Span, value: Expr<'g>) {
        let text = expression.text.get(span.start..span.end).unwrap_or_default();
        let end = text.char_indices().nth(MOST_SHOWN).map_or(text.len(), |(end, _)| end);
        let (text, context) = (text[..end].to_owned(), self.context.clone());
        let place = expression.place(span);
        let apart = text.len() + place.entry.len() + context.branches.len() * size_of::<Branch<'_>>();
        // While a list grows, there are two of it, the new one with twice the places of the old one.
        self.graph.charge(2 * size_of::<Written<'_>>() + apart + 2 * ALLOCATED);
        self.written.push(Written { value, place, text, context });
    }

    /// The written parts that affect the result at these values: those in branches of `step` that are not
    /// taken are left out, and so are those of a definition that is used only in such branches.
    pub(crate) fn taken(&self, values: &[(Expr<'g>, f64)]) -> Vec<&Written<'g>> {
        let is_taken = |branch: &Branch<'g>| {
            let condition = self.graph.evaluate(&[branch.condition], values);
            condition.is_ok_and(|condition| branch.is_taken(condition[0]))
        };
        // A definition is used by later ones, and finally by entries of other sections.
        let mut used: BTreeSet<(Stage, usize)> = BTreeSet::new();
        let mut uses: Vec<_> = self.uses.iter().collect();
        uses.sort_by_key(|(_, context)| Reverse(context.definition.map_or(usize::MAX, |(_, place)| place)));
        let counts = |used: &BTreeSet<(Stage, usize)>, context: &Context<'g>| {
            context.definition.is_none_or(|own| used.contains(&own)) && context.branches.iter().all(is_taken)
        };
        for (definition, context) in uses {
            if counts(&used, context) {
                used.insert(*definition);
            }
        }
        self.written.iter().filter(|written| counts(&used, &written.context)).collect()
    }

    pub(super) fn ast(
        &mut self,
        expression: &Expression,
        ast: &Ast,
        stage: Stage,
    ) -> Result<Expr<'g>, ModelError> {
        match &ast.kind {
            AstKind::Number(value) => Ok((*value).into()),
            AstKind::Name(name) => self.name(expression, ast.span, name, stage),
            AstKind::Velocity(name) => self.velocity_of(expression, ast.span, name, stage),
            AstKind::TotalDerivative(inner) => self.total_derivative(expression, ast.span, inner, stage),
            AstKind::Sum(terms) => {
                let mut values = Vec::with_capacity(terms.len());
                for (sign, term) in terms {
                    let value = self.ast(expression, term, stage)?;
                    values.push(if *sign == Sign::Minus { -value } else { value });
                }
                Ok(self.graph.sum(values))
            }
            AstKind::Product(factors) => self.product(expression, factors, stage),
            AstKind::Negate(inner) => Ok(-self.ast(expression, inner, stage)?),
            AstKind::Power(base, exponent) => {
                let power = self.ast(expression, base, stage)?;
                let power = power.pow(self.ast(expression, exponent, stage)?);
                self.note(expression, ast.span, power);
                Ok(power)
            }
            AstKind::Call(name, _, args) if self.declared(name).is_some() => {
                self.declared_call(expression, ast, (name, args), stage)
            }
            AstKind::Call(function, _, args) => {
                let mut values = Vec::with_capacity(args.len());
                for (i, arg) in args.iter().enumerate() {
                    let branch =
                        (function == "step" && i > 0).then(|| Branch { condition: values[0], first: i == 1 });
                    let depth = self.context.branches.len();
                    self.context.branches.extend(branch);
                    let value = self.ast(expression, arg, stage);
                    self.context.branches.truncate(depth);
                    values.push(value?);
                }
                let before = self.graph.zero_divisions();
                let value = call(function, &values, self.graph);
                if self.graph.zero_divisions() > before {
                    return Err(
                        self.error(expression, ast.span, |text| MeaningError::DivisionByZero { text })
                    );
                }
                self.note(expression, ast.span, value);
                Ok(value)
            }
        }
    }

    fn product(
        &mut self,
        expression: &Expression,
        factors: &[(Factor, Ast)],
        stage: Stage,
    ) -> Result<Expr<'g>, ModelError> {
        let mut product = Expr::ONE;
        let start = factors.first().map_or(0, |(_, first)| first.span.start);
        for (factor, ast) in factors {
            let value = self.ast(expression, ast, stage)?;
            if *factor == Factor::Times {
                product *= value;
                continue;
            }
            let span = Span { start, end: ast.span.end };
            if value.is_zero() {
                return Err(self.error(expression, span, |text| MeaningError::DivisionByZero { text }));
            }
            product = product / value;
            self.note(expression, span, product);
        }
        Ok(product)
    }

    pub(super) fn name(
        &mut self,
        expression: &Expression,
        span: Span,
        name: &str,
        stage: Stage,
    ) -> Result<Expr<'g>, ModelError> {
        let document = self.document;
        let refuse = |scope: &Self| {
            let fault = |_| MeaningError::NotHere {
                name: name.to_owned(),
                place: stage.place(),
                allowed: stage.allowed(),
            };
            Err(scope.error(expression, span, fault))
        };
        if name == "pi" {
            return Ok(std::f64::consts::PI.into());
        }
        if matches!(stage, Stage::Body | Stage::Height) {
            return self.name_in_body(name).map_or_else(|| refuse(self), Ok);
        }
        let own = self.context.definition.map(|(_, own)| own);
        let is_late = |place| own.is_some_and(|own| own <= place);
        let late = |_| MeaningError::UsedBeforeDefined { name: name.to_owned() };
        if let Some(place) = document.parameters.iter().position(|p| p.name.text == name) {
            if stage == Stage::Parameter && is_late(place) {
                return Err(self.error(expression, span, late));
            }
            return Ok(self.graph.symbol(name));
        }
        if let Some(&place) = self.places.get(name).filter(|_| stage != Stage::Parameter) {
            if is_late(place) {
                return Err(self.error(expression, span, late));
            }
            return self.definition(place, stage);
        }
        let is_coordinate = document.coordinates.iter().any(|c| c.name.text == name);
        let is_quasi_velocity = document.quasi_velocities.iter().any(|q| q.name.text == name);
        let is_state = document.states.iter().any(|state| state.name.text == name);
        let is_input = document.inputs.iter().any(|input| input.name.text == name);
        let is_point = self.is_point(name);
        if let Some((number, component)) = self.contact_of(name) {
            let known = if stage.has_velocities() { self.contact(number, component)? } else { None };
            return known.map_or_else(|| refuse(self), Ok);
        }
        match stage {
            _ if is_input => match stage {
                Stage::Parameter
                | Stage::Body
                | Stage::Height
                | Stage::Start
                | Stage::Joint
                | Stage::Action => refuse(self),
                Stage::Definition
                | Stage::Kinematics
                | Stage::Position
                | Stage::Inertia
                | Stage::Constraint
                | Stage::Drawing => match self.rate_of_input(name) {
                    Some(_) => Ok(self.graph.symbol(name)),
                    None => {
                        let fault = |_| MeaningError::NotHere {
                            name: name.to_owned(),
                            place: stage.place(),
                            allowed: "parameters, coordinates, t, and inputs with cubic or quintic tables",
                        };
                        Err(self.error(expression, span, fault))
                    }
                },
                Stage::Rate
                | Stage::Gravity
                | Stage::Dynamics
                | Stage::Event
                | Stage::Function
                | Stage::Observation => Ok(self.graph.symbol(name)),
            },
            Stage::Parameter if self.places.contains_key(name) => refuse(self),
            Stage::Parameter | Stage::Start | Stage::Joint
                if name == "t" || is_coordinate || is_quasi_velocity || is_state || is_point =>
            {
                refuse(self)
            }
            Stage::Definition | Stage::Position | Stage::Action if is_quasi_velocity || is_state => {
                refuse(self)
            }
            Stage::Inertia if is_quasi_velocity => refuse(self),
            Stage::Kinematics | Stage::Constraint if is_state => refuse(self),
            Stage::Gravity if is_coordinate || is_quasi_velocity || is_state || is_point => refuse(self),
            _ if name == "t" => Ok(self.time),
            _ if is_point => self.point(name),
            _ if is_coordinate || is_quasi_velocity || is_state => Ok(self.graph.symbol(name)),
            Stage::Action if self.is_constant(name) => Ok(self.graph.symbol(name)),
            Stage::Observation | Stage::Event if self.reaction_of_contact(name).is_some() => {
                Ok(self.reaction_of_contact(name).unwrap_or(Expr::ZERO))
            }
            Stage::Observation if self.is_friction(name) => Ok(self.graph.symbol(name)),
            Stage::Observation if self.is_reaction(name) => Ok(self.graph.symbol(name)),
            Stage::Observation if self.is_resultant(name) => {
                let symbol = self.graph.symbol(name);
                self.resultants.push((symbol, expression.place(span)));
                Ok(symbol)
            }
            Stage::Observation if self.is_of_joint(name) => {
                let symbol = self.graph.symbol(name);
                self.of_joints.push((symbol, expression.place(span)));
                Ok(symbol)
            }
            _ if self.is_other(name) => Ok(self.graph.symbol(name)),
            _ if self.reaction_of_contact(name).is_some() || self.is_friction(name) => refuse(self),
            _ => {
                if let Some(observed) = self.observed(name) {
                    return match stage {
                        Stage::Event | Stage::Observation => {
                            self.of_motion(expression, span, observed, stage)
                        }
                        _ => refuse(self),
                    };
                }
                let fault = |_| MeaningError::UnknownName { name: name.to_owned(), known: self.known() };
                Err(self.error(expression, span, fault))
            }
        }
    }

    /// Whether `name` is that of a symbol without declaration.
    fn is_other(&self, name: &str) -> bool {
        self.others.iter().any(|other| other.symbol_name().as_deref() == Some(name))
    }

    /// Whether `name` is a constant of the action.
    fn is_constant(&self, name: &str) -> bool {
        let mut constants = self.document.hamilton_jacobi.iter().flat_map(|action| &action.constants);
        constants.any(|(constant, _)| constant.text == name)
    }

    /// Whether `name` is `λ_` followed by the name of a constraint.
    pub(super) fn is_reaction(&self, name: &str) -> bool {
        let constraint = name.strip_prefix("λ_");
        constraint.is_some_and(|name| self.document.constraints.iter().any(|c| c.name.text == name))
    }

    /// Whether `name` is a component of the force or torque of a constraint on a body.
    pub(super) fn is_resultant(&self, name: &str) -> bool {
        let of_body = |constraint: &str, body: &Body| {
            let turns = body.orientation.is_some();
            force_names(constraint, &body.name.text).iter().any(|known| known == name)
                || turns && torque_names(constraint, &body.name.text).iter().any(|known| known == name)
        };
        let of_tree = |constraint: &str, body: &TreeBody| {
            let mut names = force_names(constraint, &body.name.text)
                .into_iter()
                .chain(torque_names(constraint, &body.name.text));
            names.any(|known| known == name)
        };
        let Document { constraints, bodies, tree, .. } = self.document;
        constraints.iter().map(|c| &c.name.text).any(|constraint| {
            bodies.iter().any(|body| of_body(constraint, body))
                || tree.iter().any(|body| of_tree(constraint, body))
        })
    }

    /// Whether `name` is a component of the force or torque of a joint on its body.
    fn is_of_joint(&self, name: &str) -> bool {
        self.document.tree.iter().map(|body| &body.name.text).any(|body| {
            let mut names = joint_force_names(body).into_iter().chain(joint_torque_names(body));
            names.any(|known| known == name)
        })
    }

    fn known(&self) -> Vec<String> {
        let document = self.document;
        let parameters = document.parameters.iter().map(|p| &p.name.text);
        let definitions = document.definitions.iter().map(|d| &d.name.text);
        let coordinates = document.coordinates.iter().map(|c| &c.name.text);
        let quasi_velocities = document.quasi_velocities.iter().map(|q| &q.name.text);
        let states = document.states.iter().map(|state| &state.name.text);
        let rates = coordinates.clone().map(|x| format!("{x}'"));
        let moving = coordinates.chain(quasi_velocities).chain(states);
        let inputs = document.inputs.iter().map(|input| &input.name.text);
        let others = self.others.iter().filter_map(|other| other.symbol_name()).chain(rates);
        parameters.chain(inputs).chain(definitions).chain(moving).cloned().chain(others).collect()
    }
}

/// The entry called `name` in a list of named expressions.
pub(crate) fn entry<'d>(list: &'d [NamedExpression], name: &str) -> Option<&'d NamedExpression> {
    list.iter().find(|item| item.name.text == name)
}
