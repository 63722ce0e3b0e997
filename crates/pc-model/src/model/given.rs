//! Quasi-velocities given in addition to those of the document.

use pc_expr::parse::{FUNCTIONS, is_name};

use crate::diagnostics::error::ModelError;
use crate::diagnostics::error_kind::ErrorKind;
use crate::diagnostics::meaning::MeaningError;
use crate::diagnostics::source::{Place, Source};
use crate::document::{Document, Expression, Name};

/// A quasi-velocity with its definition, which is a linear form in the velocities or quasi-velocities of a
/// model.
#[derive(Clone, Debug)]
pub struct GivenQuasiVelocity {
    pub(crate) name: String,
    pub(crate) source: Source,
    pub(crate) expression: Expression,
}

impl GivenQuasiVelocity {
    /// Makes a quasi-velocity from a name and the text of its definition.
    ///
    /// # Errors
    /// [`ModelError`] if the name is invalid or taken, or the text is not an expression.
    pub(crate) fn new(
        document: &Document,
        taken: &[&str],
        name: &str,
        text: &str,
    ) -> Result<Self, ModelError> {
        let source = Source::new(name, text);
        let refuse =
            |kind: ErrorKind| Err(source.error(&Place { entry: String::new(), span: 0..text.len() }, kind));
        if !is_name(name) {
            return refuse(ErrorKind::NotAName { key: name.to_owned() });
        }
        let reserved = FUNCTIONS.iter().any(|function| function.name == name);
        if reserved || matches!(name, "t" | "pi" | "energy") {
            return refuse(ErrorKind::Reserved { name: name.to_owned() });
        }
        if taken.contains(&name) {
            return refuse(ErrorKind::Meaning(MeaningError::GivenTwice { name: name.to_owned() }));
        }
        // Those of the file are replaced.
        let of_file = |known: &Name| document.simulation.hamel.iter().any(|given| given.name == *known);
        let mut declared = document.declared_names().into_iter().filter(|(known, _)| !of_file(known));
        if let Some((known, first)) = declared.find(|(known, _)| known.text == name) {
            let line = document.source.position(known.place.span.start).line;
            return refuse(ErrorKind::NameTaken { name: name.to_owned(), first, line });
        }
        let expression = Expression::of(&source, &document.declared_functions())?;
        Ok(GivenQuasiVelocity { name: name.to_owned(), expression, source })
    }

    /// The quasi-velocities of the document, which is already checked.
    pub(crate) fn of_document(document: &Document) -> Vec<Self> {
        let given = document.simulation.hamel.iter().map(|given| GivenQuasiVelocity {
            name: given.name.text.clone(),
            source: document.source.clone(),
            expression: given.expression.clone(),
        });
        given.collect()
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its definition.
    pub fn expression(&self) -> &Expression {
        &self.expression
    }
}
