//! Units: those that the text of a model names, and those that are certain. Without `[units]` the quantities of a model have any
//! consistent units; but importers measure time in seconds, and the angle of a joint is in radians, whatever the unit of length.

use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::ops::Range;

use pc_model::Document;
use pc_model::document::{JointKind, Name};

use crate::xml::{Xml, empty, inside, text};

/// A unit.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Unit {
    /// rad^a s^b
    Certain { radians: i32, seconds: i32 },
    /// One of which only the name is known.
    Named(String),
}

impl Unit {
    pub(crate) const TIME: Unit = Unit::Certain { radians: 0, seconds: 1 };
    const ANGLE: Unit = Unit::Certain { radians: 1, seconds: 0 };

    /// That of the rate of a quantity with this one, if it is certain.
    pub(crate) fn rate(self) -> Option<Unit> {
        match self {
            Unit::Certain { radians, seconds } => Some(Unit::Certain { radians, seconds: seconds - 1 }),
            Unit::Named(_) => None,
        }
    }

    /// The unit that a text names.
    fn called(name: &str) -> Unit {
        match name {
            "s" => Unit::TIME,
            "rad" => Unit::ANGLE,
            "rad/s" => Unit::Certain { radians: 1, seconds: -1 },
            "rad/s2" => Unit::Certain { radians: 1, seconds: -2 },
            other => Unit::Named(other.to_owned()),
        }
    }

    /// `rad/s2`, as FMI writes units.
    pub(crate) fn name(&self) -> String {
        match self {
            Unit::Certain { radians: 0, .. } => "s".to_owned(),
            Unit::Certain { seconds: 0, .. } => "rad".to_owned(),
            Unit::Certain { seconds: -1, .. } => "rad/s".to_owned(),
            Unit::Certain { seconds, .. } => format!("rad/s{}", -seconds),
            Unit::Named(name) => name.clone(),
        }
    }
}

/// The units of quantities by their names.
pub(crate) struct Units(BTreeMap<String, Unit>);

impl Units {
    /// Those of the angles of joints and of their rates, and of the angular velocities of balls, unless the text names others.
    pub(crate) fn new(document: &Document) -> Units {
        let mut units = BTreeMap::new();
        for joint in document.tree.iter().map(|body| &body.joint) {
            let (angles, angular_velocities) = match joint.kind {
                JointKind::Fixed | JointKind::Prismatic => (0..0, 0..0),
                JointKind::Revolute | JointKind::Screw => (0..1, 0..1),
                JointKind::Cylindrical => (1..2, 1..2),
                JointKind::Universal => (0..2, 0..2),
                JointKind::Planar => (2..3, 2..3),
                JointKind::Spherical => (0..0, 0..3),
                JointKind::Free => (0..0, 3..6),
            };
            let named = |names: &[Name], places: Range<usize>, unit: Unit| {
                let names = names.get(places).unwrap_or_default();
                names.iter().map(|name| (name.text.clone(), unit.clone())).collect::<Vec<_>>()
            };
            units.extend(named(&joint.coordinates, angles, Unit::ANGLE));
            units.extend(named(&joint.quasi_velocities, angular_velocities, Unit::called("rad/s")));
        }
        let given = document.units.iter();
        units.extend(given.map(|given| (given.quantity.text.clone(), Unit::called(&given.unit.value))));
        Units(units)
    }

    pub(crate) fn of(&self, name: &str) -> Option<Unit> {
        self.0.get(name).cloned()
    }
}

/// `UnitDefinitions` of the units that occur.
///
/// # Errors
/// None; writing to memory does not fail.
pub(crate) fn definitions(units: impl Iterator<Item = Unit>, xml: &mut Xml) -> io::Result<()> {
    let units: BTreeSet<Unit> = units.collect();
    inside(xml, "UnitDefinitions", &Vec::new(), |xml| {
        units.iter().try_for_each(|unit| {
            inside(xml, "Unit", &vec![("name", text(&unit.name()))], |xml| {
                let Unit::Certain { radians, seconds } = *unit else { return Ok(()) };
                let powers = [("rad", radians), ("s", seconds)].into_iter().filter(|&(_, power)| power != 0);
                empty(xml, "BaseUnit", &powers.map(|(name, power)| (name, power.to_string())).collect())
            })
        })
    })
}
