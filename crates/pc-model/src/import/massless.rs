//! Links that move and carry no mass.

use std::collections::HashSet;

use crate::diagnostics::source::Source;
use crate::import::error::UrdfError;
use crate::import::robot::{Joint, Kind, Link, Robot};

/// The links in the order of a tree, each with the joint by which it hangs on its parent.
pub(crate) type Order<'a> = [(&'a Link, Option<&'a Joint>)];

/// The joints that move nothing that has mass, each with its link, from the root outwards. A joint
/// that mimics another needs no mass of its own, nor does one that has an inertia of its own, of its rotor.
fn joints_without_mass<'a>(order: &Order<'a>) -> Vec<(&'a Link, &'a Joint)> {
    let mut carries: HashSet<&str> = HashSet::new();
    let mut found = Vec::new();
    for (link, joint) in order.iter().rev() {
        let has_mass = link.inertial.as_ref().is_some_and(|inertial| {
            inertial.mass > 0.0 || inertial.inertia.iter().any(|&moment| moment != 0.0)
        });
        if has_mass {
            carries.insert(&link.name);
        }
        let Some(joint) = joint else { continue };
        if carries.contains(link.name.as_str()) {
            carries.insert(&joint.parent);
        } else if joint.armature > 0.0 {
            continue;
        } else if joint.kind != Kind::Fixed && joint.mimic.is_none() {
            found.push((*link, *joint));
        }
    }
    found.reverse();
    found
}

/// Checks that everything that moves has mass.
///
/// # Errors
/// [`UrdfError`] at the link without mass that is farthest from the root.
pub(crate) fn check(source: &Source, robot: &Robot, order: &Order<'_>) -> Result<(), UrdfError> {
    let found = joints_without_mass(order);
    let Some((link, joint)) = found.last() else { return Ok(()) };
    let message = format!("the link `{}` can move, and neither it nor what hangs on it has mass", link.name);
    let help = match follower(robot, joint) {
        Some(follower) => {
            format!("`{}` mimics its joint: let that move by itself, and mimic it", follower.name)
        }
        None => {
            let fixing = "or fix all such joints by `--fix-massless`";
            format!("give it an <inertial>, make its joint `fixed`, {fixing}")
        }
    };
    Err(UrdfError::at(source, link.span.clone(), format!("<link {}>", link.name), message, help))
}

/// A joint that mimics this one.
fn follower<'a>(robot: &'a Robot, joint: &Joint) -> Option<&'a Joint> {
    robot.joints.iter().find(|other| other.mimic.as_ref().is_some_and(|mimic| mimic.joint == joint.name))
}

/// The robot with every joint fixed that moves nothing that has mass and that no other mimics; each has a
/// remark.
pub(crate) fn fixed(robot: &Robot, order: &Order<'_>) -> Robot {
    let found = joints_without_mass(order);
    let names: HashSet<&str> = found
        .iter()
        .filter(|(_, joint)| follower(robot, joint).is_none())
        .map(|(_, joint)| joint.name.as_str())
        .collect();
    let mut fixed = robot.clone();
    for joint in fixed.joints.iter_mut().filter(|joint| names.contains(joint.name.as_str())) {
        let word = joint.kind.word();
        let remark = format!("the joint `{}` is fixed instead of {word}: it moves no mass", joint.name);
        joint.remarks.push(remark);
        joint.kind = Kind::Fixed;
        joint.damping = 0.0;
    }
    fixed
}
