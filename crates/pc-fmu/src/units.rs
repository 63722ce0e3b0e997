//! Units, where they are certain. The quantities of a model have any consistent units, which it does not name; but importers measure
//! time in seconds, and the angle of a joint is in radians, whatever the unit of length.

use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::ops::Range;

use pc_model::Document;
use pc_model::document::{JointKind, Name};

use crate::xml::{Xml, empty, inside};

/// rad^a s^b
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Unit {
    radians: i32,
    seconds: i32,
}

impl Unit {
    pub(crate) const TIME: Unit = Unit { radians: 0, seconds: 1 };
    const ANGLE: Unit = Unit { radians: 1, seconds: 0 };

    /// That of the rate of a quantity with this one.
    pub(crate) fn rate(self) -> Unit {
        Unit { seconds: self.seconds - 1, ..self }
    }

    /// `rad/s2`, as FMI writes units.
    pub(crate) fn name(self) -> String {
        match (self.radians, self.seconds) {
            (0, _) => "s".to_owned(),
            (_, 0) => "rad".to_owned(),
            (_, -1) => "rad/s".to_owned(),
            (_, power) => format!("rad/s{}", -power),
        }
    }
}

/// The units of coordinates and quasi-velocities by their names.
pub(crate) struct Units(BTreeMap<String, Unit>);

impl Units {
    /// Those of the angles of joints and of their rates, and of the angular velocities of balls.
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
                names.iter().map(|name| (name.text.clone(), unit)).collect::<Vec<_>>()
            };
            units.extend(named(&joint.coordinates, angles, Unit::ANGLE));
            units.extend(named(&joint.quasi_velocities, angular_velocities, Unit::ANGLE.rate()));
        }
        Units(units)
    }

    pub(crate) fn of(&self, name: &str) -> Option<Unit> {
        self.0.get(name).copied()
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
            inside(xml, "Unit", &vec![("name", unit.name())], |xml| {
                let powers = [("rad", unit.radians), ("s", unit.seconds)];
                let powers = powers.into_iter().filter(|&(_, power)| power != 0);
                empty(xml, "BaseUnit", &powers.map(|(name, power)| (name, power.to_string())).collect())
            })
        })
    })
}
