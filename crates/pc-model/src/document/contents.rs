//! The text of a model as a typed document: every entry has its place in the file, and names are not yet
//! resolved.

use std::path::{Path, PathBuf};

use pc_expr::Direction;
use pc_mech::{Interpolation, KnownRates};

use crate::diagnostics::source::{Place, Source};
use crate::document::contact::Contact;
use crate::document::draw::Draw;
use crate::document::drawing::Drawing;
use crate::document::expression::{Expression, Located, Name, NamedExpression};
use crate::document::inertia::Inertia;
use crate::document::joints::{Point, TreeBody};
use crate::document::run_settings::Simulation;

/// A model as written. Every list is in the order of the file.
#[derive(Clone, Debug, Default)]
pub struct Document {
    /// The file.
    pub source: Source,
    /// `[model]`
    pub model: Heading,
    /// `[parameters]`, which stay adjustable, each with its number or an expression in the preceding
    /// parameters.
    pub parameters: Vec<NamedExpression>,
    /// `[inputs]`
    pub inputs: Vec<Input>,
    /// `[functions]`
    pub functions: Vec<GivenFunction>,
    /// `[definitions]`
    pub definitions: Vec<NamedExpression>,
    /// Coordinates, each with its start value: those of joints, then the others, from `[coordinates]`.
    pub coordinates: Vec<NamedExpression>,
    /// Quasi-velocities: those of joints, unless all velocities are `x'`, then the others, from
    /// `[quasi_velocities]`, without its entries `"x'"`.
    pub quasi_velocities: Vec<QuasiVelocity>,
    /// The entries `"x'" = value` of `[quasi_velocities]`: start velocities under the names of their coordinates,
    /// without the prime.
    pub start_velocities: Vec<NamedExpression>,
    /// `[states]`
    pub states: Vec<State>,
    /// `[kinematics]`: the expressions of x_i', under the names of the coordinates.
    pub kinematics: Vec<NamedExpression>,
    /// `[algebra]`
    pub algebra: Option<Algebra>,
    /// `[constraints]`, then the constraints that close `[loops.NAME]`, then those of `[contacts.NAME]`.
    pub constraints: Vec<Constraint>,
    /// `[lagrangian]`, which is always given if there are no bodies.
    pub lagrangian: Option<Lagrangian>,
    /// `[bodies.NAME]` with a position.
    pub bodies: Vec<Body>,
    /// `[bodies.NAME]` with a joint.
    pub tree: Vec<TreeBody>,
    /// `[points.NAME]`, then the points at which `[loops.NAME]` are closed.
    pub points: Vec<Point>,
    /// `[contacts.NAME]`
    pub contacts: Vec<Contact>,
    /// `[gravity]`
    pub gravity: Option<Gravity>,
    /// `[forces]`, under the names of the quasi-velocities or coordinates on which they act.
    pub forces: Vec<NamedExpression>,
    /// `[integrals]`
    pub integrals: Vec<NamedExpression>,
    /// `[outputs]`, then the coordinates of joints that follow others, then the forces of contacts.
    pub outputs: Vec<NamedExpression>,
    /// `[units]`
    pub units: Vec<NamedUnit>,
    /// `[[draw]]`
    pub draw: Vec<Draw>,
    /// `[drawing]`
    pub drawing: Drawing,
    /// `[hamilton_jacobi]`
    pub hamilton_jacobi: Option<HamiltonJacobi>,
    /// `[events.NAME]`, then the ends of contacts.
    pub events: Vec<Event>,
    /// `[simulation]`
    pub simulation: Simulation,
}

/// The name of the unit of a quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedUnit {
    /// The quantity: any declared name, a velocity x', `t` or `energy`.
    pub quantity: Name,
    /// The name of its unit.
    pub unit: Located<String>,
}

/// The title of a model.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Heading {
    /// The name of the system.
    pub name: Option<Located<String>>,
    /// The description of the system.
    pub description: Option<Located<String>>,
    /// The source of the model.
    pub reference: Option<Located<String>>,
}

/// A value that a program or a table supplies to the system.
#[derive(Clone, Debug, PartialEq)]
pub struct Input {
    /// Its name.
    pub name: Name,
    /// Its value.
    pub value: InputValue,
}

/// The value of an input.
#[derive(Clone, Debug, PartialEq)]
pub enum InputValue {
    /// A number, or an expression in parameters: the input is constant until it is set.
    Constant(Expression),
    /// A list of times and the values at these times.
    Lists {
        /// Their place.
        place: Place,
        /// The times.
        times: Vec<f64>,
        /// The values.
        values: Vec<f64>,
        /// The rates and accelerations at the times, if they are listed.
        known: KnownRates,
        /// The interpolation between the times.
        interpolation: Interpolation,
    },
    /// A column of a file.
    File(TableFile),
    /// The rate u' of the input u with this index among the inputs, whose table is a curve.
    RateOf(usize),
}

impl Input {
    /// Whether its table is a curve, which has a rate and a second derivative.
    pub(crate) fn is_curve(&self) -> bool {
        let (InputValue::Lists { interpolation, .. } | InputValue::File(TableFile { interpolation, .. })) =
            &self.value
        else {
            return false;
        };
        matches!(interpolation, Interpolation::Cubic | Interpolation::Quintic)
    }
}

/// A column of a file of comma-separated numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct TableFile {
    /// Its path, relative to the model's file.
    pub file: Located<String>,
    /// The column of the values.
    pub column: Located<String>,
    /// The column of the rates, if there is one.
    pub rate: Option<Located<String>>,
    /// The column of the accelerations, if there is one.
    pub acceleration: Option<Located<String>>,
    /// The column of the times; if left out, the column `t`, or else the first column.
    pub time: Option<Located<String>>,
    /// The interpolation between the times.
    pub interpolation: Interpolation,
}

/// A function that expressions may call, f(x…).
#[derive(Clone, Debug, PartialEq)]
pub struct GivenFunction {
    /// Its name.
    pub name: Name,
    /// The names of its arguments.
    pub arguments: Vec<String>,
    /// Its value, an expression in its arguments and parameters; without a value, it stands for any smooth function.
    pub is: Option<Expression>,
}

/// A quasi-velocity η_s: at least one of `is` and `start` is given.
#[derive(Clone, Debug, PartialEq)]
pub struct QuasiVelocity {
    /// Its name.
    pub name: Name,
    /// Its definition in terms of the velocities of the coordinates.
    pub is: Option<Expression>,
    /// Its start value; 0 if it is left out.
    pub start: Option<Expression>,
}

/// A first-order state z, which is not part of the frame.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// Its name.
    pub name: Name,
    /// Its start value; 0 if it is left out.
    pub start: Option<Expression>,
    /// ż
    pub rate: Expression,
}

/// Structure coefficients given by the user.
#[derive(Clone, Debug, PartialEq)]
pub struct Algebra {
    /// The section's header.
    pub place: Place,
    /// The coefficients.
    pub definition: AlgebraDefinition,
}

/// The two ways in which an algebra can be given.
#[derive(Clone, Debug, PartialEq)]
pub enum AlgebraDefinition {
    /// By its name in the catalogue.
    Catalogue(Located<String>),
    /// By its brackets; pairs that are left out have the bracket 0.
    Brackets(Vec<Bracket>),
}

/// A given bracket [X_left, X_right] = value; one of the names may be `t`. No pair is given twice in the same
/// order.
#[derive(Clone, Debug, PartialEq)]
pub struct Bracket {
    /// First field.
    pub left: Name,
    /// Second field.
    pub right: Name,
    /// A linear combination of the fields.
    pub value: Expression,
}

/// A constraint: an expression that is required to stay zero.
#[derive(Clone, Debug, PartialEq)]
pub struct Constraint {
    /// Its label, which lies outside the namespace of the model.
    pub name: Name,
    /// The expression that stays zero.
    pub expression: Expression,
    /// The declared kind.
    pub kind: Option<Located<DeclaredKind>>,
}

/// Whether a constraint is integrable, nonholonomic, or not affine in the velocities.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DeclaredKind {
    /// It is integrable.
    Holonomic,
    /// It is not integrable.
    Nonholonomic,
    /// It is not affine in the velocities: Chetaev's condition determines the virtual displacements.
    Nonlinear,
}

/// The energy. `lagrangian` excludes `kinetic` and `potential`; if there are no bodies, either `lagrangian` or
/// `kinetic` is given.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lagrangian {
    /// The section's header.
    pub place: Place,
    /// Kinetic energy.
    pub kinetic: Option<Expression>,
    /// The potential energy; 0 if left out.
    pub potential: Option<Expression>,
    /// The Lagrangian itself.
    pub lagrangian: Option<Expression>,
    /// R, giving Q_s = −∂R/∂η_s.
    pub dissipation: Option<Expression>,
}

/// A rigid body or mass point.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Its label, which lies outside the namespace of the model.
    pub name: Name,
    /// The section's header.
    pub place: Place,
    /// Its mass.
    pub mass: Expression,
    /// The position of the mass centre, or of a point of the body that is at rest.
    pub position: [Expression; 3],
    /// The inertia about `position`; given only with an orientation.
    pub inertia: Option<Inertia>,
    /// Its orientation.
    pub orientation: Option<Orientation>,
    /// The force that acts at `position`.
    pub force: Option<[Expression; 3]>,
    /// The torque, in components along the axes of the angular velocity; given only with an orientation.
    pub torque: Option<[Expression; 3]>,
}

/// A uniform gravitational field, which acts on the mass centres of all bodies.
#[derive(Clone, Debug, PartialEq)]
pub struct Gravity {
    /// The section's header.
    pub place: Place,
    /// The acceleration of free fall, in components along the axes of the positions.
    pub acceleration: [Expression; 3],
}

/// The orientation of a body.
#[derive(Clone, Debug, PartialEq)]
pub enum Orientation {
    /// The rows of the rotation matrix R from body axes to fixed axes.
    Rotation(Box<[Expression; 9]>),
    /// The components of the angular velocity.
    AngularVelocity(Box<[Expression; 3]>),
}

/// A solution of Hamilton–Jacobi's equation, as claimed by the user.
#[derive(Clone, Debug, PartialEq)]
pub struct HamiltonJacobi {
    /// The function S of time, coordinates and constants.
    pub action: Expression,
    /// Its constants, each with a value near which S is defined.
    pub constants: Vec<(Name, Located<f64>)>,
}

/// An event, which occurs where an expression passes through zero.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// Its label, which lies outside the namespace of the model.
    pub name: Name,
    /// The section's header.
    pub place: Place,
    /// The expression that passes through zero.
    pub when: Expression,
    /// The direction in which the expression passes through zero.
    pub direction: Option<Located<Direction>>,
    /// Whether the run ends there.
    pub terminal: Option<Located<bool>>,
    /// The new values after the event; the name of a velocity keeps its prime.
    pub reset: Vec<NamedExpression>,
}

impl Document {
    /// The place at the end of the file, where missing entries could be added.
    pub fn end(&self) -> Place {
        let end = self.source.text().trim_end().len();
        Place { entry: String::new(), span: end..end }
    }

    /// The files that it reads besides its own: those of the tables of inputs.
    pub fn files(&self) -> Vec<PathBuf> {
        let of_table = |input: &Input| match &input.value {
            InputValue::File(table) => Some(self.beside(&table.file.value)),
            InputValue::Constant(_) | InputValue::RateOf(_) | InputValue::Lists { .. } => None,
        };
        self.inputs.iter().filter_map(of_table).collect()
    }

    /// The path of a file that the text names: relative to the directory of the model.
    pub(crate) fn beside(&self, name: &str) -> PathBuf {
        Path::new(self.source.name()).parent().unwrap_or(Path::new("")).join(name)
    }
}
