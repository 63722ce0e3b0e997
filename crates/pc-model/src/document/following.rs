//! Joints that follow others: the definition of each one's coordinate, which is an output too.

use pc_expr::parse::{Ast, AstKind, Declared};

use crate::diagnostics::error::ModelError;
use crate::diagnostics::error_kind::ErrorKind;
use crate::document::contents::Document;
use crate::document::expression::{Expression, NamedExpression};
use crate::document::joints::{Following, TreeBody};

/// Adds the definition x = ratio · y + offset of each joint that follows another with the coordinate y, and the
/// output x.
///
/// # Errors
/// If the followed body does not exist or has a joint with another number of coordinates, or if joints follow
/// each other in a circle.
pub(super) fn declare(document: &mut Document, functions: &[Declared]) -> Result<(), ModelError> {
    for body in from_followed_to_following(document)? {
        let body = &document.tree[body];
        let Some(Following { ratio, offset, name, .. }) = &body.joint.follows else { continue };
        let other = followed(document, body)?.and_then(coordinate).unwrap_or_default();
        let ratio = ratio.as_ref().map_or_else(String::new, |ratio| format!("({})*", ratio.text));
        let offset = offset.as_ref().map_or_else(String::new, |offset| format!(" + ({})", offset.text));
        let text = format!("{ratio}{other}{offset}");
        let value = Expression::implied(&document.source, text, &name.place, functions)?;
        let output = Expression::following(&document.source, name.text.clone(), &name.place)?;
        let name = name.clone();
        let used = |definition: &NamedExpression| mentions(&value.ast, &definition.name.text);
        let place = document.definitions.iter().rposition(used).map_or(0, |last| last + 1);
        document.definitions.insert(place, NamedExpression { name: name.clone(), expression: value });
        document.outputs.push(NamedExpression { name, expression: output });
    }
    Ok(())
}

/// The bodies whose joints follow others, each after the one that it follows.
fn from_followed_to_following(document: &Document) -> Result<Vec<usize>, ModelError> {
    let mut order: Vec<usize> = Vec::new();
    for start in 0..document.tree.len() {
        let mut chain = Vec::new();
        let mut next = Some(start);
        while let Some(body) = next.filter(|body| !order.contains(body)) {
            if let Some(first) = chain.iter().position(|known| *known == body) {
                let bodies: Vec<String> = chain[first..]
                    .iter()
                    .map(|&body: &usize| document.tree[body].name.text.clone())
                    .collect();
                let place = &document.tree[body].joint.place;
                return Err(document.source.error(place, ErrorKind::CircularGears { bodies }));
            }
            chain.push(body);
            let other = followed(document, &document.tree[body])?;
            next = other.and_then(|other| document.tree.iter().position(|body| body.name == other.name));
        }
        order.extend(chain.into_iter().rev());
    }
    order.retain(|&body| document.tree[body].joint.follows.is_some());
    Ok(order)
}

/// The body whose joint that of `body` follows.
fn followed<'d>(document: &'d Document, body: &TreeBody) -> Result<Option<&'d TreeBody>, ModelError> {
    let Some(Following { body: named, .. }) = &body.joint.follows else { return Ok(None) };
    match document.tree.iter().find(|known| known.name.text == named.value) {
        Some(other) if other.joint.kind.is_single() => Ok(Some(other)),
        Some(other) => {
            let (name, kind) = (named.value.clone(), other.joint.kind.word());
            Err(document.source.error(&named.place, ErrorKind::NotFollowable { name, kind }))
        }
        None => {
            let known = document.tree.iter().filter(|other| other.joint.kind.is_single());
            let known = known.filter(|other| other.name != body.name).map(|other| other.name.text.clone());
            let kind = ErrorKind::NothingToFollow { name: named.value.clone(), known: known.collect() };
            Err(document.source.error(&named.place, kind))
        }
    }
}

/// The name of the coordinate of a joint that has one.
fn coordinate(body: &TreeBody) -> Option<&str> {
    match &body.joint.follows {
        Some(following) => Some(&following.name.text),
        None => body.joint.coordinates.first().map(|name| name.text.as_str()),
    }
}

/// Whether an expression contains a name.
pub(super) fn mentions(ast: &Ast, name: &str) -> bool {
    let any = |parts: &[&Ast]| parts.iter().any(|part| mentions(part, name));
    match &ast.kind {
        AstKind::Number(_) => false,
        AstKind::Name(known) | AstKind::Velocity(known) => known == name,
        AstKind::TotalDerivative(inner) | AstKind::Negate(inner) => mentions(inner, name),
        AstKind::Sum(terms) => terms.iter().any(|(_, term)| mentions(term, name)),
        AstKind::Product(factors) => factors.iter().any(|(_, factor)| mentions(factor, name)),
        AstKind::Power(base, exponent) => any(&[base, exponent]),
        AstKind::Call(_, _, arguments) => arguments.iter().any(|argument| mentions(argument, name)),
    }
}
