//! Remarks on constraints and energy.

use pc_model::Assembly;
use pc_nonholo::Redundant;

/// The constraints that were dropped, each with the reason.
pub fn dropped(assembly: &Assembly<'_>) -> Vec<(String, String)> {
    let reason = |names: &[String]| match names {
        [] => "holds whatever the motion".to_owned(),
        names => format!("follows from {}", names.join(", ")),
    };
    let named = |redundant: &Redundant| (redundant.constraint.clone(), reason(&redundant.follows_from));
    assembly.dropped_constraints().map(named).collect()
}

/// The remark on bodies whose masses change in time, if there are any.
pub fn changing_masses(assembly: &Assembly<'_>) -> Option<String> {
    let (of, changes) = match assembly.changing_masses.as_slice() {
        [] => return None,
        [_] => ("the mass", "changes"),
        _ => ("the masses", "change"),
    };
    let names = assembly.changing_masses.join(", ");
    Some(format!(
        "{of} of {names} {changes} in time: what is lost or taken up is at rest, D_t (m v) = F; for what leaves or comes with a \
         velocity u add the force d(m)*u"
    ))
}

/// The remark on a kinetic energy that is negative for some velocities.
pub const NEGATIVE_ENERGY: &str = "the kinetic energy is negative for some velocities at the start: a mass or a moment of \
                                   inertia has the wrong sign";
