//! The kinds of errors in a model, and how to correct them.

use std::fmt;

use pc_expr::Spent;
use pc_expr::parse::{FUNCTIONS, ParseError};
use thiserror::Error;

use crate::diagnostics::category::Category;
use crate::diagnostics::meaning::MeaningError;
use crate::diagnostics::words::{listed, suggest};

/// The kinds of errors in a model.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ErrorKind {
    /// The file is not text.
    #[error("the file is not UTF-8 text: found byte 0x{byte:02x}")]
    NotText {
        /// The first byte that is not UTF-8.
        byte: u8,
    },
    /// The file is not TOML.
    #[error("not valid TOML: {message}")]
    Toml {
        /// The message of the TOML parser.
        message: String,
        /// A correction.
        help: &'static str,
    },
    /// The same key is given twice in the same table.
    #[error("`{key}` is given twice")]
    DuplicateKey {
        /// The key as written.
        key: String,
    },
    /// The derivation of the model reached its limits.
    #[error("{stage}: {what} ({nodes} expressions were made)")]
    Spent {
        /// Which limit.
        what: Spent,
        /// The stage of the work.
        stage: &'static str,
        /// The number of expressions created so far.
        nodes: usize,
    },
    /// The file is empty.
    #[error("the model is empty")]
    Empty,
    /// Nothing gives the energy.
    #[error("no [lagrangian] section")]
    NoLagrangian,
    /// There are neither coordinates nor quasi-velocities.
    #[error("no [coordinates] and no [quasi_velocities]: nothing moves")]
    NothingMoves,
    /// A section that does not exist.
    #[error("unknown section [{name}]")]
    UnknownSection {
        /// Its name.
        name: String,
        /// A section with a similar name.
        nearest: Option<&'static str>,
    },
    /// An entry before the first section.
    #[error("`{key}` stands outside any section")]
    OutsideSection {
        /// Its key.
        key: String,
    },
    /// An entry that does not exist in its section.
    #[error("unknown entry `{key}`")]
    UnknownKey {
        /// Its key.
        key: String,
        /// The existing entries.
        allowed: &'static [&'static str],
        /// The one with a similar name.
        nearest: Option<&'static str>,
    },
    /// A value of the wrong type.
    #[error("expected {expected}, found {found}")]
    WrongType {
        /// A phrase for the expected type.
        expected: &'static str,
        /// A phrase for the type of the value given.
        found: &'static str,
        /// How the entry could be written.
        example: String,
    },
    /// A list of the wrong length.
    #[error("expected {expected}, found {found}")]
    WrongLength {
        /// A phrase that says what the list should contain.
        expected: &'static str,
        /// The number of elements that the list has.
        found: usize,
        /// How the entry could be written.
        example: &'static str,
    },
    /// An entry that cannot be left out.
    #[error("`{key}` is missing")]
    Missing {
        /// Its key.
        key: &'static str,
        /// How the missing entry could be written.
        example: &'static str,
    },
    /// An entry that has no effect by itself.
    #[error("`{key}` has no effect without `{without}`")]
    NoEffect {
        /// Its key.
        key: String,
        /// The entry that is needed as well.
        without: &'static str,
        /// How that entry could be written.
        example: &'static str,
    },
    /// An entry that joints of this kind do not have.
    #[error("joints of this kind have no `{key}`")]
    OfOtherJoints {
        /// Its key.
        key: String,
        /// What could be written instead of the entry, or in addition to it.
        example: &'static str,
    },
    /// An entry that contacts of this shape do not have.
    #[error("contacts of this shape have no `{key}`")]
    OfOtherShapes {
        /// Its key.
        key: String,
        /// What could be written instead of the entry, or in addition to it.
        example: &'static str,
    },
    /// Dry friction of a contact that has another law.
    #[error("`{key}` is of contacts that slide and lift off, not of one with `{because}`")]
    OfSliding {
        /// The key.
        key: &'static str,
        /// The entry beside which it does not make sense.
        because: &'static str,
    },
    /// A name that is not that of a body.
    #[error("no body is called `{name}`")]
    NoSuchBody {
        /// The name.
        name: String,
        /// The existing bodies.
        known: Vec<String>,
    },
    /// A name in `[drawing]` that is not that of a body or point.
    #[error("no body or point is called `{name}`")]
    NothingToHide {
        /// The name.
        name: String,
        /// The existing bodies and points.
        known: Vec<String>,
    },
    /// A mesh whose file is not there, or is none.
    #[error("`{file}` cannot be drawn: {why}")]
    NotDrawn {
        /// The file as the text names it.
        file: String,
        /// Why.
        why: String,
    },
    /// A body whose angular velocity is all that is known of its attitude, and in whose axes something would be drawn.
    #[error("the axes of `{body}` are not known: its `angular_velocity` is given, not its attitude")]
    NoAxes {
        /// The body.
        body: String,
    },
    /// A body without attitude that would roll or slide.
    #[error("the body `{body}` is a particle, without a shape that could touch anything")]
    Pointlike {
        /// The body.
        body: String,
    },
    /// A name that is not that of a body with a joint.
    #[error("no body with a joint is called `{name}`")]
    NotInTree {
        /// The name.
        name: String,
        /// The existing bodies.
        known: Vec<String>,
    },
    /// Bodies attached to one another in a circle.
    #[error("no body of these hangs on the world: {}", hanging(bodies))]
    CircularParents {
        /// The bodies, each attached to the next and the last to the first.
        bodies: Vec<String>,
    },
    /// A body whose joint another would follow, but which does not exist.
    #[error("no body with a joint is called `{name}`")]
    NothingToFollow {
        /// The name.
        name: String,
        /// The other bodies whose joints have exactly one coordinate.
        known: Vec<String>,
    },
    /// A joint that another would follow, whose coordinates are none or several.
    #[error("the joint of `{name}` is {kind}: a joint follows one that has exactly one coordinate")]
    NotFollowable {
        /// The body whose joint would be followed.
        name: String,
        /// The kind of its joint.
        kind: &'static str,
    },
    /// Joints that follow each other in a circle.
    #[error("joints follow each other in a circle: {}", bodies.join(", "))]
    CircularGears {
        /// The bodies, the joint of each following that of the next and the last that of the first.
        bodies: Vec<String>,
    },
    /// An entry about the motion of a coordinate that belongs to a joint.
    #[error("the joint of `{body}` says how `{name}` moves")]
    OfJoint {
        /// The name.
        name: String,
        /// The body.
        body: String,
    },
    /// A quasi-velocity defined by `is` in a model with a joint that has an angular velocity.
    #[error(
        "the joint of `{body}` has an angular velocity, beside which no quasi-velocity is defined by `is`"
    )]
    DefinedBesideTurning {
        /// The body.
        body: String,
    },
    /// Two entries of which only one may be given.
    #[error("`{first}` and `{second}` exclude each other")]
    Exclusive {
        /// The one.
        first: &'static str,
        /// The other.
        second: &'static str,
        /// A hint that says when to use each of them.
        help: &'static str,
    },
    /// A key that should be a name but is not.
    #[error("`{key}` is not a name")]
    NotAName {
        /// The key.
        key: String,
    },
    /// A label of a constraint, body or event with invisible characters.
    #[error("the label `{}` contains invisible characters", label.escape_debug())]
    HiddenInLabel {
        /// The label.
        label: String,
    },
    /// A name with a fixed meaning.
    #[error("the name `{name}` is reserved")]
    Reserved {
        /// The name.
        name: String,
    },
    /// A name given to two things.
    #[error("`{name}` is already the name of {first} (line {line})")]
    NameTaken {
        /// The name.
        name: String,
        /// What this name was given to first.
        first: Role,
        /// The line on which the first of the two is declared.
        line: usize,
    },
    /// A key of `brackets` that is not a pair.
    #[error("`{key}` is not a pair of names")]
    NotAPair {
        /// The key.
        key: String,
    },
    /// The bracket of a field with itself.
    #[error("the bracket of `{name}` with itself is always zero")]
    SelfBracket {
        /// The name given twice.
        name: String,
    },
    /// The same bracket given twice.
    #[error("the bracket of `{left}` and `{right}` is given twice")]
    BracketTwice {
        /// First name.
        left: String,
        /// Second name.
        right: String,
    },
    /// `nan` or `inf`.
    #[error("expected a finite number, found `{text}`")]
    NotFinite {
        /// As written.
        text: String,
    },
    /// An integer that a floating-point number cannot hold exactly.
    #[error("the integer {text} is too large")]
    IntegerTooLarge {
        /// As written.
        text: String,
    },
    /// A number outside the range of its entry.
    #[error("expected {expected}, found {found}")]
    OutOfRange {
        /// A phrase for the valid values.
        expected: &'static str,
        /// As written.
        found: String,
        /// How the entry could be written.
        example: &'static str,
    },
    /// A word that is not among the choices.
    #[error("`{found}` is not one of the choices")]
    UnknownChoice {
        /// As written.
        found: String,
        /// The choices.
        allowed: Vec<&'static str>,
        /// The one with a similar name.
        nearest: Option<&'static str>,
    },
    /// A text that is not a valid expression.
    #[error(transparent)]
    Expression(#[from] ParseError),
    /// A text that is well formed but has no valid meaning.
    #[error(transparent)]
    Meaning(#[from] MeaningError),
    /// Something that the program cannot do yet.
    #[error("{what} not supported yet")]
    Unsupported {
        /// The feature, with its verb, such as `events are`.
        what: &'static str,
    },
}

/// What a name stands for in the single namespace of a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// An entry of `[parameters]`.
    Parameter,
    /// An entry of `[inputs]`.
    Input,
    /// An entry of `[functions]`.
    Function,
    /// An entry of `[definitions]`.
    Definition,
    /// An entry of `[coordinates]`.
    Coordinate,
    /// An entry of `[quasi_velocities]`.
    QuasiVelocity,
    /// An entry of `[states]`.
    State,
    /// An entry of `[integrals]`.
    Integral,
    /// An entry of `[outputs]`.
    Output,
    /// A constant of `[hamilton_jacobi]`.
    Constant,
    /// A component of a point from `[points.NAME]` or `[loops.NAME]`.
    Point,
    /// A component of a contact from `[contacts.NAME]`.
    Contact,
    /// An entry of `[constraints]`.
    Constraint,
}

impl fmt::Display for Role {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Parameter => "a parameter",
            Self::Input => "an input",
            Self::Function => "a function",
            Self::Definition => "a definition",
            Self::Coordinate => "a coordinate",
            Self::QuasiVelocity => "a quasi-velocity",
            Self::State => "a first-order state",
            Self::Integral => "an integral",
            Self::Output => "an output",
            Self::Constant => "a constant of the action",
            Self::Point => "a component of a point",
            Self::Contact => "a component of a contact",
            Self::Constraint => "a constraint",
        })
    }
}

/// The sections of a model.
pub(crate) const SECTIONS: &[&str] = &[
    "model",
    "parameters",
    "inputs",
    "functions",
    "definitions",
    "coordinates",
    "quasi_velocities",
    "states",
    "kinematics",
    "algebra",
    "constraints",
    "lagrangian",
    "bodies",
    "points",
    "loops",
    "contacts",
    "gravity",
    "forces",
    "integrals",
    "outputs",
    "units",
    "draw",
    "drawing",
    "hamilton_jacobi",
    "events",
    "simulation",
];

const LEAST: &str = "a model needs at least [coordinates] (or [algebra] and [quasi_velocities]) and [lagrangian] \
                     with `kinetic = \"…\"` or `lagrangian = \"…\"`, or [bodies.NAME]";

impl ErrorKind {
    /// Whether the text, the model, or this program is at fault.
    pub fn category(&self) -> Category {
        match self {
            Self::Unsupported { .. } => Category::Unsupported,
            Self::Spent { .. } => Category::Spent,
            Self::Meaning(fault) => fault.category(),
            _ => Category::Text,
        }
    }

    /// A correction.
    pub fn help(&self) -> String {
        match self {
            Self::NotText { .. } => "save the model as plain text in UTF-8".into(),
            Self::Toml { help, .. } => (*help).into(),
            Self::Spent { what: Spent::Cancelled, .. } => "run it again, if this was not intended".into(),
            Self::Spent { .. } => {
                "raise the limit (`--limit-memory`, `--limit-time`; in C `memory_limit`, `time_limit`), or write the model with fewer or shorter expressions"
                    .into()
            }
            Self::DuplicateKey { .. } => "keep one of them".into(),
            Self::Empty | Self::NoLagrangian | Self::NothingMoves => LEAST.into(),
            Self::UnknownSection { nearest, .. } => possible(*nearest, "sections", SECTIONS),
            Self::OutsideSection { .. } => {
                format!("put it under its section header; {}", possible(None, "sections", SECTIONS))
            }
            Self::UnknownKey { allowed, nearest, .. } => possible(*nearest, "entries here", allowed),
            Self::WrongType { example, .. } => format!("write `{example}`"),
            Self::WrongLength { example, .. } | Self::OutOfRange { example, .. } => {
                format!("write `{example}`")
            }
            Self::Missing { example, .. } => format!("add `{example}`"),
            Self::NoEffect { key, example, .. } => format!("add `{example}`, or leave `{key}` out"),
            Self::Exclusive { help, .. } => (*help).into(),
            Self::OfOtherJoints { key, example } => format!("write `{example}`, or leave `{key}` out"),
            Self::OfSliding { because: "keeps = true", .. } => {
                "leave `keeps` out: N may be negative there, and friction would drive the body".into()
            }
            Self::OfSliding { .. } => {
                "write `motion = \"slides\"`: with friction, the body also rolls where friction suffices".into()
            }
            Self::OfOtherShapes { key, example } => format!("write `{example}`, or leave `{key}` out"),
            Self::NoSuchBody { known, .. } if known.is_empty() => "declare it in [bodies.NAME]".into(),
            Self::NoSuchBody { name, known } => {
                suggest(name, known, &format!("the bodies are {}", listed(known)))
            }
            Self::NothingToHide { known, .. } if known.is_empty() => {
                "leave `hide` out: the model has no bodies and no points".into()
            }
            Self::NothingToHide { name, known } => {
                suggest(name, known, &format!("the bodies and points are {}", listed(known)))
            }
            Self::NotDrawn { .. } => {
                "a mesh is a file in STL or OBJ; paths are relative to the model's file".into()
            }
            Self::NoAxes { .. } => "leave `body` out, and describe the shape along the fixed axes".into(),
            Self::Pointlike { .. } => {
                "give it `inertia` and `rotation` or `angular_velocity`, or attach it by a `joint`".into()
            }
            Self::NotInTree { name, known } => {
                suggest(name, known, &format!("the bodies with joints are {}; \"world\" is what they hang on in the end", listed(known)))
            }
            Self::CircularParents { .. } => "leave the `parent` of one of them out: it hangs on the world then".into(),
            Self::NothingToFollow { known, .. } if known.is_empty() => {
                "no other joint has exactly one coordinate".into()
            }
            Self::NothingToFollow { name, known } => {
                suggest(name, known, &format!("the other joints with one coordinate are those of {}", listed(known)))
            }
            Self::NotFollowable { .. } => "follow a revolute, prismatic or screw joint".into(),
            Self::CircularGears { .. } => "leave `follows` out of one of them: it moves by itself then".into(),
            Self::OfJoint { .. } => "give its start value alone, or leave it out".into(),
            Self::DefinedBesideTurning { .. } => {
                "give the velocities of what belongs to no joint in [kinematics]".into()
            }
            Self::NotAName { key } if key.len() > 255 => "a name has at most 255 bytes".into(),
            Self::NotAName { key } => match key.chars().find_map(plain_letter) {
                Some((variant, letter)) => format!("for `{variant}` write `{letter}`"),
                None => "a name is a Latin or Greek letter or `_`, then letters, digits and `_`".into(),
            },
            Self::HiddenInLabel { .. } => {
                "a label stands on one line, in what is printed and in columns: leave out what controls terminals, ends lines or \
                 turns the direction of writing"
                    .into()
            }
            Self::Reserved { name } => reserved(name),
            Self::NameTaken { name, .. } => format!(
                "parameters, inputs, functions, definitions, coordinates, quasi-velocities, states, integrals and outputs share one \
                 namespace; choose another name, such as `{name}_1`"
            ),
            Self::NotAPair { .. } => {
                "a bracket is written `\"w1,w2\" = \"w3\"`, the one with time `\"t,w1\" = \"w2\"`".into()
            }
            Self::SelfBracket { .. } => "remove the entry".into(),
            Self::BracketTwice { .. } => "keep one of them".into(),
            Self::NotFinite { .. } => "write a number such as `1.0` or `1e-3`".into(),
            Self::IntegerTooLarge { .. } => {
                "write it with a decimal point or an exponent, as in `1e20`".into()
            }
            Self::UnknownChoice { allowed, nearest, .. } => possible(*nearest, "choices", allowed),
            Self::Expression(error) => error.help(),
            Self::Meaning(fault) => fault.help(),
            Self::Unsupported { .. } => "remove the entry".into(),
        }
    }
}

/// `a` on `b`, `b` on `a`
fn hanging(bodies: &[String]) -> String {
    let next = bodies.iter().cycle().skip(1);
    bodies.iter().zip(next).map(|(body, on)| format!("`{body}` on `{on}`")).collect::<Vec<_>>().join(", ")
}

fn possible(nearest: Option<&str>, what: &str, words: &[&str]) -> String {
    let words = words.join(", ");
    match nearest {
        Some(word) => format!("did you mean `{word}`? The {what} are {words}"),
        None => format!("the {what} are {words}"),
    }
}

fn reserved(name: &str) -> String {
    let meaning = match name {
        "t" => "it is the time".into(),
        "pi" => "it is the number π".into(),
        "energy" => "it is the energy column that every run has".into(),
        "world" => "it is what bodies hang on in the end".into(),
        _ => match FUNCTIONS.iter().find(|function| function.name == name) {
            Some(function) => format!("it is the function `{}`", function.usage),
            None => "it has a meaning of its own".into(),
        },
    };
    format!("{meaning}; choose another name, such as `{name}_1`")
}

/// A form of a letter that is not used in names, with the form to use instead: the micro sign, for example, is
/// not the letter μ.
fn plain_letter(form: char) -> Option<(char, char)> {
    let plain = match form {
        'ϑ' => 'θ',
        'ϕ' => 'φ',
        'ϵ' => 'ε',
        'ϱ' => 'ρ',
        'ϰ' => 'κ',
        'µ' => 'μ',
        _ => return None,
    };
    Some((form, plain))
}
