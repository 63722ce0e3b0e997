//! The text of a model as a typed document: every entry with its place, names not yet resolved.
//!
//! ```
//! use pc_model::{Document, Source};
//! let text = "coordinates.x = 1.0\nlagrangian.kinetic = \"x'^2/2\"";
//! let document = Document::parse(Source::new("free.toml", text))?;
//! assert_eq!(document.coordinates[0].name.text, "x");
//! # Ok::<(), pc_model::ModelError>(())
//! ```

use std::ops::Range;

use pc_expr::Direction;
use pc_expr::parse::{Ast, Span, nearest, parse};
use pc_mech::Interpolation;

use crate::diagnostics::error::{ErrorKind, ModelError, SECTIONS};
use crate::diagnostics::source::{Place, Source};

use crate::document::simulation::Simulation;
use crate::document::text_map::TextMap;

/// A value and where it stands in the file.
#[derive(Clone, Debug, PartialEq)]
pub struct Located<T> {
    /// The value.
    pub value: T,
    /// Where it stands.
    pub place: Place,
}

/// A name and where it stands in the file, quotes excluded.
#[derive(Clone, Debug, PartialEq)]
pub struct Name {
    /// The name.
    pub text: String,
    /// Where it stands.
    pub place: Place,
}

/// An expression and where it stands in the file.
#[derive(Clone, Debug, PartialEq)]
pub struct Expression {
    /// As written, escapes of the TOML string resolved.
    pub text: String,
    /// Its tree, with spans in `text`.
    pub ast: Ast,
    pub(super) entry: String,
    pub(super) map: TextMap,
}

impl Expression {
    /// The expression that is the whole of a text.
    ///
    /// # Errors
    /// [`ModelError`] if it is none.
    pub(crate) fn of(source: &Source) -> Result<Expression, ModelError> {
        let text = source.text();
        let ast = parse(text).map_err(|error| {
            let span = error.span.start..error.span.end;
            source.error(&Place { entry: String::new(), span }, error)
        })?;
        Ok(Expression { text: text.to_owned(), ast, entry: String::new(), map: TextMap::verbatim(text) })
    }

    /// Bytes of the file at which a part of the expression stands.
    pub fn locate(&self, span: Span) -> Range<usize> {
        self.map.locate(span.start..span.end)
    }

    /// The place of a part of the expression.
    pub fn place(&self, span: Span) -> Place {
        Place { entry: self.entry.clone(), span: self.locate(span) }
    }

    /// The place of the whole expression.
    pub fn whole(&self) -> Place {
        self.place(Span { start: 0, end: self.text.len() })
    }
}

/// `name = "expression"`.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedExpression {
    /// What stands on the left.
    pub name: Name,
    /// What stands on the right.
    pub expression: Expression,
}

/// A model as written. Every list is in the order of the file.
#[derive(Clone, Debug, Default)]
pub struct Document {
    /// The file.
    pub source: Source,
    /// `[model]`
    pub model: Heading,
    /// `[parameters]`: what stays adjustable, each with its number, or an expression in those before it.
    pub parameters: Vec<NamedExpression>,
    /// `[inputs]`
    pub inputs: Vec<Input>,
    /// `[definitions]`
    pub definitions: Vec<NamedExpression>,
    /// `[coordinates]`, each with its start value.
    pub coordinates: Vec<NamedExpression>,
    /// `[quasi_velocities]` but for entries `"x'"`.
    pub quasi_velocities: Vec<QuasiVelocity>,
    /// Entries `"x'" = value` of `[quasi_velocities]`: start velocities by the names of coordinates, without prime.
    pub start_velocities: Vec<NamedExpression>,
    /// `[states]`
    pub states: Vec<State>,
    /// `[kinematics]`: x_i' by the names of coordinates.
    pub kinematics: Vec<NamedExpression>,
    /// `[algebra]`
    pub algebra: Option<Algebra>,
    /// `[constraints]`
    pub constraints: Vec<Constraint>,
    /// `[lagrangian]`; given unless there are bodies.
    pub lagrangian: Option<Lagrangian>,
    /// `[bodies.NAME]`
    pub bodies: Vec<Body>,
    /// `[gravity]`
    pub gravity: Option<Gravity>,
    /// `[forces]`, by the names of quasi-velocities or coordinates.
    pub forces: Vec<NamedExpression>,
    /// `[integrals]`
    pub integrals: Vec<NamedExpression>,
    /// `[outputs]`
    pub outputs: Vec<NamedExpression>,
    /// `[events.NAME]`
    pub events: Vec<Event>,
    /// `[simulation]`
    pub simulation: Simulation,
}

/// Title of a model.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Heading {
    /// Name of the system.
    pub name: Option<Located<String>>,
    /// What it is.
    pub description: Option<Located<String>>,
    /// Where it comes from.
    pub reference: Option<Located<String>>,
}

/// What a program, or a table, gives the system.
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
    /// A number, or an expression in parameters: constant until it is set.
    Constant(Expression),
    /// Values at times.
    Lists {
        /// Where they stand.
        place: Place,
        /// The times.
        times: Vec<f64>,
        /// The values.
        values: Vec<f64>,
        /// How they are read between the times.
        interpolation: Interpolation,
    },
    /// A column of a file.
    File(TableFile),
}

/// A column of a file of numbers with commas between them.
#[derive(Clone, Debug, PartialEq)]
pub struct TableFile {
    /// Its path, from where the model's file is.
    pub file: Located<String>,
    /// The column of the values.
    pub column: Located<String>,
    /// That of the times; `t`, else the first one, where it is left out.
    pub time: Option<Located<String>>,
    /// How they are read between the times.
    pub interpolation: Interpolation,
}

/// η_s: at least one of `is` and `start` is given.
#[derive(Clone, Debug, PartialEq)]
pub struct QuasiVelocity {
    /// Its name.
    pub name: Name,
    /// Its definition by the velocities of the coordinates.
    pub is: Option<Expression>,
    /// Its start value; 0 where it is left out.
    pub start: Option<Expression>,
}

/// A first-order state z, which is no part of the frame.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// Its name.
    pub name: Name,
    /// Its start value; 0 where it is left out.
    pub start: Option<Expression>,
    /// ż
    pub rate: Expression,
}

/// Structure coefficients given by the user.
#[derive(Clone, Debug, PartialEq)]
pub struct Algebra {
    /// The section's header.
    pub place: Place,
    /// What they are.
    pub definition: AlgebraDefinition,
}

/// The two ways to give an algebra.
#[derive(Clone, Debug, PartialEq)]
pub enum AlgebraDefinition {
    /// By its name in the catalogue.
    Catalogue(Located<String>),
    /// By its brackets, pairs left out being zero.
    Brackets(Vec<Bracket>),
}

/// [X_left, X_right] = value; one of the names may be `t`. No pair is given twice in the same order.
#[derive(Clone, Debug, PartialEq)]
pub struct Bracket {
    /// First field.
    pub left: Name,
    /// Second field.
    pub right: Name,
    /// A linear combination of the fields.
    pub value: Expression,
}

/// An expression that stays zero.
#[derive(Clone, Debug, PartialEq)]
pub struct Constraint {
    /// Its label, outside the namespace of the model.
    pub name: Name,
    /// What stays zero.
    pub expression: Expression,
    /// What the user says it is.
    pub kind: Option<Located<ConstraintKind>>,
}

/// Whether a constraint can be integrated, or is none that is affine in the velocities.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ConstraintKind {
    /// It can.
    Holonomic,
    /// It cannot.
    Nonholonomic,
    /// It is not affine in the velocities: Chetaev's condition says which displacements are virtual.
    Nonlinear,
}

/// The energy. `lagrangian` excludes `kinetic` and `potential`; one of `lagrangian` and `kinetic` is given unless
/// there are bodies.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lagrangian {
    /// The section's header.
    pub place: Place,
    /// Kinetic energy.
    pub kinetic: Option<Expression>,
    /// Potential energy; 0 where it is left out.
    pub potential: Option<Expression>,
    /// The Lagrangian itself.
    pub lagrangian: Option<Expression>,
    /// R, giving Q_s = −∂R/∂η_s.
    pub dissipation: Option<Expression>,
}

/// A rigid body or mass point.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Its label, outside the namespace of the model.
    pub name: Name,
    /// The section's header.
    pub place: Place,
    /// Its mass.
    pub mass: Expression,
    /// Position of the mass centre, or of a point of the body that is at rest.
    pub position: [Expression; 3],
    /// Inertia about `position`; given only with an orientation.
    pub inertia: Option<Inertia>,
    /// How it turns.
    pub orientation: Option<Orientation>,
    /// Force acting at `position`.
    pub force: Option<[Expression; 3]>,
    /// Torque, in the axes of the angular velocity; given only with an orientation.
    pub torque: Option<[Expression; 3]>,
}

/// A uniform field of gravity, which acts on the mass centres of all bodies.
#[derive(Clone, Debug, PartialEq)]
pub struct Gravity {
    /// The section's header.
    pub place: Place,
    /// The acceleration of what falls, along the axes of the positions.
    pub acceleration: [Expression; 3],
}

/// Inertia matrix.
#[derive(Clone, Debug, PartialEq)]
pub enum Inertia {
    /// Ixx, Iyy, Izz, the other entries zero.
    Principal(Box<[Expression; 3]>),
    /// Ixx, Iyy, Izz, Ixy, Iyz, Ixz.
    Full(Box<[Expression; 6]>),
}

/// How a body turns.
#[derive(Clone, Debug, PartialEq)]
pub enum Orientation {
    /// The rows of R, from body to space.
    Rotation(Box<[Expression; 9]>),
    /// The components of the angular velocity.
    AngularVelocity(Box<[Expression; 3]>),
}

/// Something that happens when an expression passes through zero.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// Its label, outside the namespace of the model.
    pub name: Name,
    /// The section's header.
    pub place: Place,
    /// What passes through zero.
    pub when: Expression,
    /// In which direction.
    pub direction: Option<Located<Direction>>,
    /// Whether the run ends there.
    pub terminal: Option<Located<bool>>,
    /// New values; a velocity keeps its prime in the name.
    pub reset: Vec<NamedExpression>,
}

/// Integration methods.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Backward differentiation formulas.
    Bdf,
    /// Adams–Moulton formulas.
    Adams,
    /// Taylor series.
    Taylor,
    /// Dormand–Prince of order 8.
    Dop853,
    /// The program's choice.
    Auto,
}

/// Forms of the equations of motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Equations for η.
    Poincare,
    /// Equations for the momenta.
    Canonical,
}

impl Document {
    /// The document of a model file.
    ///
    /// # Errors
    /// The first thing in the file that is not part of a model.
    pub fn parse(source: Source) -> Result<Self, ModelError> {
        let mut document = Self::default();
        for item in
            crate::document::reader::Table::root(&source, &crate::document::syntax::table(&source)?).items()
        {
            document.read(&item)?;
        }
        document.source = source;
        crate::document::checks::check_names(&document)?;
        crate::document::checks::require_motion(&document)?;
        crate::document::checks::require_energy(&document)?;
        crate::document::checks::require_bodies(&document)?;
        Ok(document)
    }

    /// The document of a model file as read from disk.
    ///
    /// # Errors
    /// As [`Document::parse`], and when the bytes are not UTF-8.
    pub fn from_bytes(name: impl Into<String>, bytes: &[u8]) -> Result<Self, ModelError> {
        Self::parse(Source::from_bytes(name, bytes))
    }

    /// The end of the file, where what is missing could be added.
    pub fn end(&self) -> Place {
        let end = self.source.text().trim_end().len();
        Place { entry: String::new(), span: end..end }
    }

    /// Reads one section.
    fn read(&mut self, item: &crate::document::reader::Item<'_>) -> Result<(), ModelError> {
        let key = item.key();
        if !SECTIONS.contains(&key) {
            let name = key.to_owned();
            return Err(item.key_error(if item.is_table() {
                ErrorKind::UnknownSection { name, nearest: nearest(key, SECTIONS.iter().copied()) }
            } else {
                ErrorKind::OutsideSection { key: name }
            }));
        }
        let table = item.section(key, &format!("[{key}]"))?;
        match key {
            "model" => self.model = crate::document::sections::heading(&table)?,
            "parameters" => self.parameters = table.declarations()?,
            "inputs" => self.inputs = crate::document::inputs::inputs(&table)?,
            "definitions" => self.definitions = table.declarations()?,
            "coordinates" => self.coordinates = table.declarations()?,
            "quasi_velocities" => crate::document::sections::quasi_velocities(&table, self)?,
            "states" => self.states = crate::document::sections::states(&table)?,
            "kinematics" => self.kinematics = table.expressions()?,
            "algebra" => self.algebra = Some(crate::document::sections::algebra(&table)?),
            "constraints" => self.constraints = crate::document::sections::constraints(&table)?,
            "lagrangian" => self.lagrangian = Some(crate::document::sections::lagrangian(&table)?),
            "bodies" => self.bodies = crate::document::bodies::bodies(&table)?,
            "gravity" => self.gravity = Some(crate::document::bodies::gravity(&table)?),
            "forces" => self.forces = table.expressions()?,
            "integrals" => self.integrals = table.declarations()?,
            "outputs" => self.outputs = table.declarations()?,
            "events" => self.events = crate::document::simulation::events(&table)?,
            _ => self.simulation = crate::document::simulation::simulation(&table)?,
        }
        Ok(())
    }
}
