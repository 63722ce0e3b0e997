//! The dry friction of contacts, T = −μ N u with u = s/|s| for the velocity s of slip.

use pc_model::document::Document;

use crate::error::Unable;
use crate::text::names::Names;
use crate::text::term::{Function, Term};

/// The friction of one contact.
#[derive(Clone, Debug)]
pub(crate) struct Friction {
    /// The constraint whose reaction is N.
    pub(crate) constraint: usize,
    /// −T/N along the two tangents.
    pub(crate) per_normal_force: [Term; 2],
    /// The velocities of slip along them.
    pub(crate) slips: [Term; 2],
    /// Whether friction jumps where the slip vanishes.
    pub(crate) jumps: bool,
}

/// The friction of all contacts.
pub(crate) struct Frictions {
    pub(crate) all: Vec<Friction>,
    /// Its forces by name.
    pub(crate) forces: Vec<(String, Term)>,
}

impl Frictions {
    pub(crate) fn of(document: &Document, names: &Names) -> Result<Frictions, Unable> {
        let (mut all, mut forces) = (Vec::new(), Vec::new());
        for contact in &document.contacts {
            let Some(friction) = &contact.friction else { continue };
            let name = &contact.name.text;
            let unknown = || Unable::UnknownName { name: name.clone() };
            let constraint = names.constraints.iter().position(|known| known == name).ok_or_else(unknown)?;
            let slip = |i: usize| {
                let component = format!("{name}_slip_{i}");
                let found = names.contacts.iter().find(|(known, _)| *known == component);
                found.map(|(_, slip)| slip.clone()).ok_or_else(unknown)
            };
            let slips = [slip(1)?, slip(2)?];
            let square = |term: &Term| Term::Product(vec![(false, term.clone()), (false, term.clone())]);
            let mut squares: Vec<(bool, Term)> = slips.iter().map(|slip| (false, square(slip))).collect();
            if let Some(creep) = &friction.creep {
                squares.push((false, square(&names.resolve(&creep.ast)?)));
            }
            let size = Term::Call(Function::Sqrt, vec![Term::Sum(squares)]);
            let coefficient = names.resolve(&friction.coefficient.ast)?;
            let per_normal_force = slips.each_ref().map(|slip| {
                Term::Product(vec![(false, coefficient.clone()), (false, slip.clone()), (true, size.clone())])
            });
            for (name, part) in contact.friction_forces().into_iter().zip(&per_normal_force) {
                let force = Term::Product(vec![(false, Term::Reaction(constraint)), (false, part.clone())]);
                forces.push((name, Term::Negative(Box::new(force))));
            }
            all.push(Friction { constraint, per_normal_force, slips, jumps: friction.creep.is_none() });
        }
        Ok(Frictions { all, forces })
    }
}
