//! Names of a model, and the terms that syntax trees denote with them.

use pc_expr::StandIn;
use pc_expr::parse::{Ast, AstKind, Factor, Sign};
use pc_model::document::GivenFunction;

use crate::error::Unable;
use crate::text::momentum;
use crate::text::resultant::Resultant;
use crate::text::term::{Function, Term};

/// The number of terms up to which calls of functions are written out.
const MOST_TERMS: usize = 100_000;

const FUNCTIONS: [(&str, Function); 19] = [
    ("sin", Function::Sin),
    ("cos", Function::Cos),
    ("tan", Function::Tan),
    ("cot", Function::Cot),
    ("asin", Function::Asin),
    ("acos", Function::Acos),
    ("atan", Function::Atan),
    ("atan2", Function::Atan2),
    ("sinh", Function::Sinh),
    ("cosh", Function::Cosh),
    ("tanh", Function::Tanh),
    ("exp", Function::Exp),
    ("log", Function::Log),
    ("sqrt", Function::Sqrt),
    ("abs", Function::Abs),
    ("sign", Function::Sign),
    ("min", Function::Min),
    ("max", Function::Max),
    ("step", Function::Step),
];

/// A function that the text declares.
#[derive(Clone, Debug)]
pub(crate) struct Declared {
    name: String,
    arguments: Vec<String>,
    /// Its value, if it is given.
    is: Option<Ast>,
    /// The function that takes its place otherwise.
    pub(crate) stand_in: StandIn,
}

impl Declared {
    pub(crate) fn of(function: &GivenFunction) -> Declared {
        Declared {
            name: function.name.text.clone(),
            arguments: function.arguments.clone(),
            is: function.is.as_ref().map(|is| is.ast.clone()),
            stand_in: StandIn::new(&function.name.text, function.arguments.len()),
        }
    }
}

/// The names of a model, whose positions here are the indices used in terms.
#[derive(Clone, Debug, Default)]
pub(crate) struct Names {
    pub(crate) coordinates: Vec<String>,
    pub(crate) quasi_velocities: Vec<String>,
    /// The parameters, followed by the inputs.
    pub(crate) parameters: Vec<String>,
    pub(crate) states: Vec<String>,
    pub(crate) definitions: Vec<String>,
    pub(crate) constraints: Vec<String>,
    pub(crate) bodies: Vec<String>,
    pub(crate) functions: Vec<Declared>,
    /// The arguments of a function, with the terms they denote where its value is being resolved.
    pub(crate) arguments: Vec<(String, Term)>,
    /// The names of components of points, with the terms they denote.
    pub(crate) points: Vec<(String, Term)>,
    /// The acceleration of gravity.
    pub(crate) gravity: Vec<Term>,
    /// The names of components of contacts, with the terms they denote.
    pub(crate) contacts: Vec<(String, Term)>,
    /// The names of the forces of contacts, with the names of their constraints.
    pub(crate) forces: Vec<(String, String)>,
}

impl Names {
    /// The term that a syntax tree denotes, with its names resolved.
    pub(crate) fn resolve(&self, tree: &Ast) -> Result<Term, Unable> {
        let boxed = |tree: &Ast| self.resolve(tree).map(Box::new);
        let all = |trees: &[Ast]| trees.iter().map(|tree| self.resolve(tree)).collect::<Result<Vec<_>, _>>();
        Ok(match &tree.kind {
            AstKind::Number(value) => Term::Number(*value),
            AstKind::Name(name) => self.name(name)?,
            AstKind::Velocity(name) => {
                let point = || self.point(name).map(|component| Term::Rate(Box::new(component)));
                let velocity = place(&self.coordinates, name).map(Term::Velocity);
                let rate = || place(&self.parameters, &format!("{name}'")).map(Term::Parameter);
                velocity.or_else(rate).or_else(point).ok_or_else(|| unknown(name))?
            }
            AstKind::TotalDerivative(inner) => Term::Rate(boxed(inner)?),
            AstKind::Sum(terms) => {
                let signed = |(sign, tree): &(Sign, Ast)| Ok((*sign == Sign::Minus, self.resolve(tree)?));
                Term::Sum(terms.iter().map(signed).collect::<Result<_, Unable>>()?)
            }
            AstKind::Product(factors) => {
                let sided = |(side, tree): &(Factor, Ast)| Ok((*side == Factor::Over, self.resolve(tree)?));
                Term::Product(factors.iter().map(sided).collect::<Result<_, Unable>>()?)
            }
            AstKind::Negate(inner) => Term::Negative(boxed(inner)?),
            AstKind::Power(base, exponent) => Term::Power(boxed(base)?, boxed(exponent)?),
            AstKind::Call(name, _, arguments) => {
                let known = FUNCTIONS.iter().find(|(known, _)| known == name);
                match known {
                    Some((_, function)) => Term::Call(*function, all(arguments)?),
                    None => self.declared(name, all(arguments)?)?,
                }
            }
        })
    }

    /// The call of a function of the text: its value with the arguments put in, if it has one.
    fn declared(&self, name: &str, arguments: Vec<Term>) -> Result<Term, Unable> {
        let place = self.functions.iter().position(|function| function.name == name);
        let place = place.ok_or_else(|| unknown(name))?;
        let function = &self.functions[place];
        let Some(is) = &function.is else { return Ok(Term::Call(Function::Undetermined(place), arguments)) };
        let inside = Names {
            parameters: self.parameters.clone(),
            functions: self.functions.clone(),
            arguments: function.arguments.iter().cloned().zip(arguments).collect(),
            ..Names::default()
        };
        match inside.resolve(is)? {
            long if long.size() > MOST_TERMS => Err(Unable::TooLong { name: name.to_owned() }),
            value => Ok(value),
        }
    }

    /// The coordinate with this name.
    pub(crate) fn coordinate(&self, name: &str) -> Result<Term, Unable> {
        place(&self.coordinates, name).map(Term::Coordinate).ok_or_else(|| unknown(name))
    }

    /// The quasi-velocity with this name.
    pub(crate) fn quasi_velocity(&self, name: &str) -> Result<Term, Unable> {
        place(&self.quasi_velocities, name).map(Term::QuasiVelocity).ok_or_else(|| unknown(name))
    }

    fn argument(&self, name: &str) -> Option<Term> {
        self.arguments.iter().find(|(known, _)| known == name).map(|(_, value)| value.clone())
    }

    fn point(&self, name: &str) -> Option<Term> {
        let mut components = self.points.iter().chain(&self.contacts);
        components.find(|(known, _)| known == name).map(|(_, component)| component.clone())
    }

    fn name(&self, name: &str) -> Result<Term, Unable> {
        let reaction = || place(&self.constraints, name.strip_prefix("λ_")?).map(Term::Reaction);
        let force = || {
            let (_, constraint) = self.forces.iter().find(|(force, _)| force == name)?;
            place(&self.constraints, constraint).map(Term::Reaction)
        };
        match name {
            "t" => Ok(Term::Time),
            "pi" => Ok(Term::Number(std::f64::consts::PI)),
            _ => None
                .or_else(|| self.argument(name))
                .or_else(|| place(&self.parameters, name).map(Term::Parameter))
                .or_else(|| place(&self.states, name).map(Term::State))
                .or_else(|| place(&self.coordinates, name).map(Term::Coordinate))
                .or_else(|| place(&self.quasi_velocities, name).map(Term::QuasiVelocity))
                .or_else(|| place(&self.definitions, name).map(Term::Definition))
                .or_else(|| self.point(name))
                .or_else(reaction)
                .or_else(force)
                .or_else(|| Resultant::named(name, &self.constraints, &self.bodies).map(Term::Resultant))
                .or_else(|| momentum::named(name, &self.bodies, &self.gravity))
                .ok_or_else(|| unknown(name)),
        }
    }
}

fn place(names: &[String], name: &str) -> Option<usize> {
    names.iter().position(|known| known == name)
}

fn unknown(name: &str) -> Unable {
    Unable::UnknownName { name: name.to_owned() }
}
