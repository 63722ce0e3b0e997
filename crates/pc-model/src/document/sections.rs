//! The sections that describe the system: names, kinematics, algebra, constraints, energy.

use std::collections::HashSet;

use super::reader::{Item, Table};
use crate::diagnostics::error::ModelError;
use crate::diagnostics::error_kind::ErrorKind;
use crate::document::contents::{
    Algebra, AlgebraDefinition, Bracket, Constraint, DeclaredKind, Document, HamiltonJacobi, Heading,
    Lagrangian, QuasiVelocity, State,
};
use crate::document::expression::NamedExpression;

pub(super) fn heading(table: &Table<'_>) -> Result<Heading, ModelError> {
    let mut heading = Heading::default();
    for item in table.items() {
        let field = match item.key() {
            "name" => &mut heading.name,
            "description" => &mut heading.description,
            "reference" => &mut heading.reference,
            _ => return Err(item.unknown(&["name", "description", "reference"])),
        };
        *field = Some(item.text()?);
    }
    Ok(heading)
}

pub(super) fn quasi_velocities(table: &Table<'_>, document: &mut Document) -> Result<(), ModelError> {
    for item in table.items() {
        if let Some(name) = item.velocity() {
            document.start_velocities.push(NamedExpression { name, expression: item.expression()? });
        } else {
            document.quasi_velocities.push(quasi_velocity(&item)?);
        }
    }
    Ok(())
}

fn quasi_velocity(item: &Item<'_>) -> Result<QuasiVelocity, ModelError> {
    let name = item.new_name()?;
    if !item.is_table() {
        return Ok(QuasiVelocity { name, is: None, start: Some(item.expression()?) });
    }
    let (mut is, mut start) = (None, None);
    let table = item.table("a table", "{ is = \"…\", start = 0.0 }")?;
    for part in table.items() {
        match part.key() {
            "is" => is = Some(part.expression()?),
            "start" => start = Some(part.expression()?),
            _ => return Err(part.unknown(&["is", "start"])),
        }
    }
    if is.is_none() && start.is_none() {
        return Err(table.error(ErrorKind::Missing { key: "is", example: "is = \"…\", start = 0.0" }));
    }
    Ok(QuasiVelocity { name, is, start })
}

pub(super) fn states(table: &Table<'_>) -> Result<Vec<State>, ModelError> {
    table.items().map(|item| state(&item)).collect()
}

fn state(item: &Item<'_>) -> Result<State, ModelError> {
    let name = item.new_name()?;
    let (mut start, mut rate) = (None, None);
    let table = item.table("a table", "{ start = 0.0, rate = \"…\" }")?;
    for part in table.items() {
        match part.key() {
            "start" => start = Some(part.expression()?),
            "rate" => rate = Some(part.expression()?),
            _ => return Err(part.unknown(&["start", "rate"])),
        }
    }
    match rate {
        Some(rate) => Ok(State { name, start, rate }),
        None => Err(table.error(ErrorKind::Missing { key: "rate", example: "rate = \"…\"" })),
    }
}

pub(super) fn algebra(table: &Table<'_>) -> Result<Algebra, ModelError> {
    let mut definition = None;
    for item in table.items() {
        let this = match item.key() {
            "name" => AlgebraDefinition::Catalogue(item.text()?),
            "brackets" => AlgebraDefinition::Brackets(brackets(&item)?),
            _ => return Err(item.unknown(&["name", "brackets"])),
        };
        if definition.is_some() {
            return Err(item.key_error(ErrorKind::Exclusive {
                first: "name",
                second: "brackets",
                help: "`name` takes an algebra from the catalogue, `brackets` writes one out",
            }));
        }
        definition = Some(this);
    }
    match definition {
        Some(definition) => Ok(Algebra { place: table.place.clone(), definition }),
        None => Err(table.error(ErrorKind::Missing { key: "name", example: "name = \"so3\"" })),
    }
}

fn brackets(item: &Item<'_>) -> Result<Vec<Bracket>, ModelError> {
    let mut brackets = Vec::new();
    let mut seen = HashSet::new();
    for entry in item.table("a table", "{ \"w1,w2\" = \"w3\" }")?.items() {
        let (left, right) = entry.pair()?;
        if left.text == right.text {
            return Err(entry.key_error(ErrorKind::SelfBracket { name: left.text }));
        }
        if !seen.insert((left.text.clone(), right.text.clone())) {
            return Err(entry.key_error(ErrorKind::BracketTwice { left: left.text, right: right.text }));
        }
        brackets.push(Bracket { left, right, value: entry.expression()? });
    }
    Ok(brackets)
}

pub(super) fn constraints(table: &Table<'_>) -> Result<Vec<Constraint>, ModelError> {
    table.items().map(|item| constraint(&item)).collect()
}

fn constraint(item: &Item<'_>) -> Result<Constraint, ModelError> {
    let name = item.new_label()?;
    if !item.is_table() {
        return Ok(Constraint { name, expression: item.expression()?, kind: None });
    }
    let (mut expression, mut kind) = (None, None);
    let table = item.table("a table", "{ expr = \"…\" }")?;
    for part in table.items() {
        match part.key() {
            "expr" => expression = Some(part.expression()?),
            "kind" => {
                kind = Some(part.choice(&[
                    ("holonomic", DeclaredKind::Holonomic),
                    ("nonholonomic", DeclaredKind::Nonholonomic),
                    ("nonlinear", DeclaredKind::Nonlinear),
                ])?);
            }
            _ => return Err(part.unknown(&["expr", "kind"])),
        }
    }
    match expression {
        Some(expression) => Ok(Constraint { name, expression, kind }),
        None => Err(table.error(ErrorKind::Missing { key: "expr", example: "expr = \"…\"" })),
    }
}

pub(super) fn lagrangian(table: &Table<'_>) -> Result<Lagrangian, ModelError> {
    let mut result = Lagrangian { place: table.place.clone(), ..Lagrangian::default() };
    for item in table.items() {
        let field = match item.key() {
            "kinetic" => &mut result.kinetic,
            "potential" => &mut result.potential,
            "lagrangian" => &mut result.lagrangian,
            "dissipation" => &mut result.dissipation,
            _ => return Err(item.unknown(&["kinetic", "potential", "lagrangian", "dissipation"])),
        };
        *field = Some(item.expression()?);
        let second = match (&result.kinetic, &result.potential) {
            (Some(_), _) => "kinetic",
            (None, Some(_)) => "potential",
            (None, None) => continue,
        };
        if result.lagrangian.is_some() {
            return Err(item.key_error(ErrorKind::Exclusive {
                first: "lagrangian",
                second,
                help: "give `kinetic` and `potential`, or their difference as `lagrangian`",
            }));
        }
    }
    Ok(result)
}

pub(super) fn hamilton_jacobi(table: &Table<'_>) -> Result<HamiltonJacobi, ModelError> {
    let (mut action, mut constants) = (None, Vec::new());
    for item in table.items() {
        match item.key() {
            "action" => action = Some(item.expression()?),
            "constants" => {
                let values = item.table("a table", "{ E = 1.0 }")?;
                let all = values.items().map(|value| Ok((value.new_name()?, value.number()?)));
                constants = all.collect::<Result<_, ModelError>>()?;
            }
            _ => return Err(item.unknown(&["action", "constants"])),
        }
    }
    match action {
        Some(action) => Ok(HamiltonJacobi { action, constants }),
        None => Err(table.error(ErrorKind::Missing { key: "action", example: "action = \"…\"" })),
    }
}
