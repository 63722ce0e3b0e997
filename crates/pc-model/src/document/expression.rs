//! Values, names and expressions, each with its place in the file.

use std::ops::Range;

use pc_expr::parse::{Ast, Declared, Span, parse_with};

use crate::diagnostics::error::ModelError;
use crate::diagnostics::source::{Place, Source};
use crate::document::text_map::TextMap;

/// A value and its place in the file.
#[derive(Clone, Debug, PartialEq)]
pub struct Located<T> {
    /// The value.
    pub value: T,
    /// Its place.
    pub place: Place,
}

/// A name and its place in the file, without quotes.
#[derive(Clone, Debug, PartialEq)]
pub struct Name {
    /// The name.
    pub text: String,
    /// Its place.
    pub place: Place,
}

/// An expression and its place in the file.
#[derive(Clone, Debug, PartialEq)]
pub struct Expression {
    /// The text as written, with the escapes of the TOML string resolved.
    pub text: String,
    /// Its syntax tree, with spans in `text`.
    pub ast: Ast,
    pub(super) entry: String,
    pub(super) map: TextMap,
}

impl Expression {
    /// The expression given by the whole text of a source, which may call the declared functions.
    ///
    /// # Errors
    /// [`ModelError`] if the text is not an expression.
    pub(crate) fn of(source: &Source, functions: &[Declared]) -> Result<Expression, ModelError> {
        let text = source.text();
        let ast = parse_with(text, functions).map_err(|error| {
            let span = error.span.start..error.span.end;
            source.error(&Place { entry: String::new(), span }, error)
        })?;
        Ok(Expression { text: text.to_owned(), ast, entry: String::new(), map: TextMap::verbatim(text) })
    }

    /// An expression that is not written but implied by the text at a place in the file.
    pub(super) fn following(source: &Source, text: String, place: &Place) -> Result<Expression, ModelError> {
        Expression::implied(source, text, place, &[])
    }

    /// An expression, implied by the text at a place in the file, that may call the declared functions.
    pub(super) fn implied(
        source: &Source,
        text: String,
        place: &Place,
        functions: &[Declared],
    ) -> Result<Expression, ModelError> {
        let ast = parse_with(&text, functions).map_err(|error| source.error(place, error))?;
        let map = TextMap::standing_for(place.span.clone(), text.len());
        Ok(Expression { text, ast, entry: place.entry.clone(), map })
    }

    /// The bytes in the file of a part of the expression.
    pub fn locate(&self, span: Span) -> Range<usize> {
        self.map.locate(span.start..span.end)
    }

    /// The place in the file of a part of the expression.
    pub fn place(&self, span: Span) -> Place {
        Place { entry: self.entry.clone(), span: self.locate(span) }
    }

    /// The place in the file of the whole expression.
    pub fn whole(&self) -> Place {
        self.place(Span { start: 0, end: self.text.len() })
    }
}

/// `name = "expression"`.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedExpression {
    /// The left-hand side.
    pub name: Name,
    /// The right-hand side.
    pub expression: Expression,
}
