//! Reads the text of an MJCF file, MuJoCo's format, as a robot.
//!
//! A body with several joints becomes a chain of links, of which the last one has the mass. The origin of a
//! link is the place of its joint, so that what is placed in a body is moved by as much. A coordinate
//! vanishes in the position of the file, where that of MuJoCo is the joint's `ref`.

mod actuators;
mod bodies;
mod compiler;
mod defaults;
mod equality;
mod joints;
mod shapes;

use roxmltree::Document;

use crate::diagnostics::source::Source;
use crate::import::error::UrdfError;
use crate::import::mjcf::bodies::Bodies;
use crate::import::mjcf::compiler::Compiler;
use crate::import::mjcf::defaults::{Defaults, elements};
use crate::import::robot::Robot;
use crate::import::xml::Reader;

/// Sections that have no effect on the motion of a model.
const IDLE: &[&str] =
    &["compiler", "option", "size", "visual", "statistic", "default", "asset", "custom", "worldbody"];

/// Reads a robot.
///
/// # Errors
/// [`UrdfError`] at the first invalid element or attribute.
pub(crate) fn read(source: &Source, document: &Document<'_>) -> Result<Robot, UrdfError> {
    let (xml, root) = (Reader { source }, document.root_element());
    compiler::check(&xml, root)?;
    let compiler = Compiler::of(&xml, root)?;
    let defaults = Defaults::of(&xml, root)?;
    let mut bodies = Bodies::new(&defaults, &compiler, root);
    for world in elements(root).filter(|node| node.has_tag_name("worldbody")) {
        bodies.read(world)?;
    }
    let mut robot = std::mem::take(&mut bodies.robot);
    root.attribute("model").unwrap_or("MuJoCo Model").clone_into(&mut robot.name);
    robot.format = "MJCF";
    robot.gravity = Some(compiler::gravity(&xml, root)?);
    robot.notes.extend(compiler::fluid(root));
    if robot.links.len() == 1 {
        return Err(xml.wrong(root, "there is no <body>", "a model has bodies in its <worldbody>"));
    }
    for section in elements(root) {
        match section.tag_name().name() {
            "equality" => {
                elements(section)
                    .try_for_each(|node| equality::read(&defaults, &bodies, node, &mut robot))?;
            }
            "actuator" => {
                elements(section).try_for_each(|node| actuators::read(&defaults, node, &mut robot))?;
            }
            name if IDLE.contains(&name) => {}
            _ => {
                let parts = elements(section).map(|node| node.tag_name().name());
                parts.for_each(|part| robot.leave_out(part));
            }
        }
    }
    if bodies.have_contacts() {
        robot.notes.push("contacts between geoms are left out".to_owned());
    }
    robot.tidy();
    Ok(robot)
}
