//! The joints of an MJCF file.

use crate::import::error::UrdfError;
use crate::import::mjcf::compiler::Compiler;
use crate::import::mjcf::defaults::Element;
use crate::import::robot::{Joint, Kind};
use crate::import::xml::Reader;

/// A joint with its position in the body, still without name, parent and child.
pub(super) fn joint(
    xml: &Reader<'_>,
    compiler: &Compiler,
    element: &Element<'_, '_, '_>,
) -> Result<(Joint, [f64; 3]), UrdfError> {
    let span = xml.tag(element.node);
    if element.node.has_tag_name("freejoint") {
        return Ok((Joint { span, kind: Kind::Floating, ..Joint::default() }, [0.0; 3]));
    }
    let word = element.text("type").unwrap_or("hinge");
    let kind = match word {
        "hinge" => Kind::Revolute,
        "slide" => Kind::Prismatic,
        "ball" => Kind::Spherical,
        "free" => Kind::Floating,
        _ => {
            let message = format!("there is no joint of type `{word}`");
            return Err(element.wrong("type", message, "the types are hinge, slide, ball and free"));
        }
    };
    let axis = element.vector("axis")?.unwrap_or([0.0, 0.0, 1.0]);
    if kind.has_axis() && axis == [0.0; 3] {
        return Err(element.wrong("axis", "the axis has length 0", "give it a direction, such as `0 0 1`"));
    }
    if element.list("springdamper")?.is_some_and(|values| values.iter().any(|value| *value != 0.0)) {
        let help = "save the compiled file from MuJoCo, by `mj_saveLastXML`, which has numbers in its place";
        return Err(element.wrong(
            "springdamper",
            "`springdamper` depends on the masses of all bodies",
            help,
        ));
    }
    let unit = if kind == Kind::Revolute { compiler.angle } else { 1.0 };
    let number = |key| element.number(key).map(Option::unwrap_or_default);
    let reference = unit * number("ref")?;
    let mut joint = Joint {
        span,
        kind,
        axis,
        damping: number("damping")?,
        friction: number("frictionloss")?,
        armature: number("armature")?,
        stiffness: number("stiffness")?,
        // The spring is relaxed where MuJoCo's coordinate is `springref`.
        rest: unit * number("springref")? - reference,
        reference,
        ..Joint::default()
    };
    if let Some(&[lower, upper]) = element.list("range")?.as_deref()
        && element.text("limited") != Some("false")
        && (lower, upper) != (0.0, 0.0)
        && kind.is_single()
    {
        joint.limits = vec![("lower", unit * lower - reference), ("upper", unit * upper - reference)];
    }
    let position = match kind {
        Kind::Floating => [0.0; 3],
        _ => element.vector("pos")?.unwrap_or_default(),
    };
    Ok((joint, position))
}
