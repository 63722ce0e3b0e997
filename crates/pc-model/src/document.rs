//! The text of a model as a typed document: every entry with its place, names not yet resolved.
//!
//! In goes TOML, out comes a [`Document`](document::Document). `syntax` reads TOML, `text_map` finds places again,
//! `reader` gives typed access; `sections`, `bodies`, `inputs` and `simulation` are the sections, `checks` what must hold
//! between them.

pub(crate) mod bodies;
pub(crate) mod checks;
pub(crate) mod document;
pub(crate) mod inputs;
pub(crate) mod reader;
pub(crate) mod sections;
pub(crate) mod simulation;
pub(crate) mod syntax;
pub(crate) mod text_map;

pub use document::{
    Algebra, AlgebraDefinition, Body, Bracket, Constraint, ConstraintKind, Document, Event, Expression, Form,
    Gravity, Heading, Inertia, Input, InputValue, Lagrangian, Located, Method, Name, NamedExpression,
    Orientation, QuasiVelocity, State, TableFile,
};
pub use simulation::{MOST_SAMPLES, Simulation};
pub use text_map::TextMap;
