//! The text of a model as a typed document: every entry has its place in the file, and names are not yet
//! resolved.
//!
//! TOML becomes a [`Document`]. Read the result first: `expression`, whose parts `text_map` locates in the file, and
//! `contents`, section by section; `run_settings` contains the defaults of a run. Then see how the text is read: `reading` reads bytes,
//! `syntax` parses TOML, `reader` gives typed access to its values, and `hidden` lists characters that labels must not contain.
//! `sections`, `bodies`, `tree` with its `joints` and their `inertia`, `loops`, `contacts` made of a `contact` each, `inputs`, `functions`, `draw`, `drawing`, `units` and `simulation`, with its
//! `tolerance`s, read the sections; `hanging` declares the coordinates of joints, `checks` tests conditions between the sections, and
//! `parse` combines all of these. `schema` describes the format for editors.

pub(crate) mod bodies;
pub(crate) mod checks;
pub(crate) mod contact;
pub(crate) mod contacts;
pub(crate) mod contents;
pub(crate) mod draw;
pub(crate) mod drawing;
pub(crate) mod expression;
pub(crate) mod following;
pub(crate) mod functions;
pub(crate) mod hanging;
pub(crate) mod hidden;
pub(crate) mod inertia;
pub(crate) mod inputs;
pub(crate) mod joints;
pub(crate) mod loops;
pub(crate) mod parse;
pub(crate) mod reader;
pub(crate) mod reading;
pub(crate) mod run_settings;
pub(crate) mod schema;
pub(crate) mod sections;
pub(crate) mod simulation;
pub(crate) mod syntax;
pub(crate) mod text_map;
pub(crate) mod tolerance;
pub(crate) mod tree;
pub(crate) mod units;

pub use contact::{Contact, ContactFriction, ContactShape};
pub use contents::{
    Algebra, AlgebraDefinition, Body, Bracket, Constraint, DeclaredKind, Document, Event, GivenFunction,
    Gravity, HamiltonJacobi, Heading, Input, InputValue, Lagrangian, NamedUnit, Orientation, QuasiVelocity,
    State, TableFile,
};
pub use draw::{Draw, DrawnPlace, DrawnShape};
pub use drawing::Drawing;
pub use expression::{Expression, Located, Name, NamedExpression};
pub use hidden::is_hidden;
pub use inertia::Inertia;
pub use joints::{Drive, Following, Joint, JointKind, JointRotation, Point, TreeBody, WORLD};
pub use reading::{MOST_BYTES, read_bounded, read_file_bounded};
pub use run_settings::Simulation;
pub use schema::SCHEMA;
pub use simulation::MOST_SAMPLES;
pub use text_map::TextMap;
pub use tolerance::AbsoluteTolerance;
