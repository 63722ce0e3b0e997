//! Errors in the text of an expression.

use thiserror::Error;

use crate::parse::syntax_tree::{MAX_DEPTH, Span};
use crate::parse::vocabulary::{Declared, FUNCTIONS, Function};

/// An error in the text of an expression, with its position.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{kind}")]
pub struct ParseError {
    /// The offending text; empty at the end of the expression.
    pub span: Span,
    /// The error.
    pub kind: ParseErrorKind,
}

/// The ways in which the text of an expression can be wrong.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ParseErrorKind {
    /// Nothing but white space.
    #[error("the expression is empty")]
    Empty,
    /// An operand is missing.
    #[error("expected an expression, found {found}")]
    ExpectedExpression {
        /// The token found in its place, in words.
        found: String,
        /// Whether that token is the second star of `**`.
        power: bool,
    },
    /// A character that has no meaning in an expression.
    #[error("unexpected character `{}`", visible(*.0))]
    UnexpectedCharacter(char),
    /// Two operands in a row.
    #[error("expected an operator before `{found}`")]
    ExpectedOperator {
        /// The second operand's first token.
        found: String,
        /// The two operands with a `*` between them.
        product: String,
    },
    /// `(` without `)`.
    #[error("unclosed parenthesis")]
    Unclosed,
    /// `)` without `(`.
    #[error("unmatched `)`")]
    Unmatched,
    /// A comma outside the arguments of a function.
    #[error("unexpected `,`")]
    StrayComma,
    /// A call of something that is not a function.
    #[error("unknown function `{name}`")]
    UnknownFunction {
        /// The name that was called.
        name: String,
        /// A function with a similar name.
        nearest: Option<String>,
    },
    /// A function's name without arguments.
    #[error("the function `{}` needs its arguments", .0.name)]
    NotCalled(Function),
    /// A call with too few or too many arguments.
    #[error("`{}` takes {} argument{}, found {found}", .function.name, .function.arguments, plural(.function.arguments))]
    ArgumentCount {
        /// The function called.
        function: Function,
        /// The number of arguments given.
        found: usize,
    },
    /// A declared function's name without arguments.
    #[error("the function `{}` needs its arguments", .0.name)]
    DeclaredNotCalled(Declared),
    /// A call of a declared function with too few or too many arguments.
    #[error("`{}` takes {} argument{}, found {found}", .function.name, .function.arguments.len(), plural(.function.arguments.len()))]
    DeclaredArgumentCount {
        /// The function called.
        function: Declared,
        /// The number of arguments given.
        found: usize,
    },
    /// A number beyond the largest floating-point number.
    #[error("number out of range")]
    NumberOutOfRange,
    /// Nesting deeper than [`MAX_DEPTH`].
    #[error("the expression is nested deeper than {MAX_DEPTH} levels")]
    TooDeep,
}

/// The character, or its escape if it would be invisible.
fn visible(character: char) -> String {
    if character == '\'' || character == '"' { character.into() } else { character.escape_debug().collect() }
}

fn plural(count: usize) -> &'static str {
    if count == 1 { "" } else { "s" }
}

impl ParseError {
    /// A correction, in one sentence.
    pub fn help(&self) -> String {
        match &self.kind {
            ParseErrorKind::Empty => "write a number, such as `0`, or an expression".into(),
            ParseErrorKind::ExpectedExpression { power: true, .. } => {
                "a power is written with `^`, as in `x^2`".into()
            }
            ParseErrorKind::ExpectedExpression { .. } => {
                "a number, a name, a function call or a parenthesis should stand here".into()
            }
            ParseErrorKind::UnexpectedCharacter(character) => replacement(*character),
            ParseErrorKind::ExpectedOperator { product, .. } => {
                format!("multiplication is written `{product}`")
            }
            ParseErrorKind::Unclosed => "close it with `)`".into(),
            ParseErrorKind::Unmatched => "remove it, or open a parenthesis before it".into(),
            ParseErrorKind::StrayComma => {
                "commas stand between the arguments of a function; the decimal separator is a point".into()
            }
            ParseErrorKind::UnknownFunction { nearest: Some(nearest), .. } => {
                format!("did you mean `{nearest}`?")
            }
            ParseErrorKind::UnknownFunction { name, nearest: None } => {
                let names: Vec<_> = FUNCTIONS.iter().map(|function| function.name).collect();
                format!("the functions are {}; multiplication is written `{name}*(…)`", names.join(", "))
            }
            ParseErrorKind::NotCalled(function) | ParseErrorKind::ArgumentCount { function, .. } => {
                format!("it is written `{}`", function.usage)
            }
            ParseErrorKind::DeclaredNotCalled(function)
            | ParseErrorKind::DeclaredArgumentCount { function, .. } => {
                format!("it is written `{}`", function.usage())
            }
            ParseErrorKind::NumberOutOfRange => "the largest number is about 1.8e308".into(),
            ParseErrorKind::TooDeep => "name the inner parts and use their names".into(),
        }
    }
}

/// The replacement of a character that has no meaning.
fn replacement(character: char) -> String {
    match character {
        '−' | '–' | '—' => "minus is written `-`".into(),
        '·' | '×' | '∙' | '⋅' => "multiplication is written `*`".into(),
        '÷' => "division is written `/`".into(),
        '²' | '³' => "a power is written with `^`, as in `x^2`".into(),
        '\'' | '′' | '’' | '″' | '"' => {
            "the velocity of the coordinate `x` is written `x'`, its acceleration `d(x')`".into()
        }
        '[' | ']' | '{' | '}' => "only the parentheses `(` and `)` group".into(),
        '=' | '<' | '>' => "an expression is not an equation; write the difference of the two sides".into(),
        'ϕ' => "write `φ`".into(),
        'ϑ' => "write `θ`".into(),
        'µ' => "write `μ`".into(),
        _ => "expressions are made of numbers, names, `+ - * / ^`, parentheses and commas".into(),
    }
}
