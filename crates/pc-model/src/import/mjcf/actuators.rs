//! Actuators of an MJCF file whose force is affine in their control, the coordinate and the velocity of a
//! joint.

use roxmltree::Node;

use crate::import::error::UrdfError;
use crate::import::mjcf::defaults::Defaults;
use crate::import::robot::{Actuator, Robot};

/// Adds an actuator to the robot.
pub(super) fn read<'d>(
    defaults: &Defaults<'_, 'd>,
    node: Node<'d, 'd>,
    robot: &mut Robot,
) -> Result<(), UrdfError> {
    let element = defaults.element(node, None)?;
    let kind = node.tag_name().name();
    let called = node.attribute("name").map(|name| format!(" `{name}`")).unwrap_or_default();
    let number = |key: &str, otherwise: f64| element.number(key).map(|value| value.unwrap_or(otherwise));
    let is = |key: &str, words: &[&str]| element.text(key).is_none_or(|word| words.contains(&word));
    // The force along the actuator is gain u + bias_0 + bias_1 length + bias_2 velocity.
    let law = match kind {
        "motor" => Some((1.0, [0.0; 3])),
        "position" => {
            let (kp, kv) = (number("kp", 1.0)?, number("kv", 0.0)?);
            let is_plain = number("dampratio", 0.0)? == 0.0
                && number("timeconst", 0.0)? == 0.0
                && number("inheritrange", 0.0)? == 0.0;
            is_plain.then_some((kp, [0.0, -kp, -kv]))
        }
        "velocity" => {
            let kv = number("kv", 1.0)?;
            Some((kv, [0.0, 0.0, -kv]))
        }
        "general" => {
            let list = |key: &str| element.list(key).map(Option::unwrap_or_default);
            let (gain, bias) = (list("gainprm")?, list("biasprm")?);
            let bias: [f64; 3] = match element.text("biastype") {
                Some("affine") => std::array::from_fn(|i| bias.get(i).copied().unwrap_or_default()),
                _ => [0.0; 3],
            };
            let is_plain =
                is("dyntype", &["none"]) && is("gaintype", &["fixed"]) && is("biastype", &["none", "affine"]);
            is_plain.then_some((gain.first().copied().unwrap_or(1.0), bias))
        }
        _ => None,
    };
    let name = element.source("joint").or_else(|| element.source("jointinparent"));
    let name = name.and_then(|node| node.attribute("joint").or_else(|| node.attribute("jointinparent")));
    let joint = name.and_then(|name| robot.joints.iter().find(|joint| joint.name == name));
    if let (Some(name), None) = (name, joint) {
        let key = if element.source("joint").is_some() { "joint" } else { "jointinparent" };
        return Err(element.wrong(key, format!("there is no joint `{name}`"), "name one that is there"));
    }
    let (Some(joint), Some((gain, [constant, length, velocity]))) =
        (joint.filter(|joint| joint.kind.is_single()), law)
    else {
        robot.notes.push(format!("the actuator <{kind}>{called} is left out"));
        return Ok(());
    };
    let gear = element.list("gear")?.and_then(|gear| gear.first().copied()).unwrap_or(1.0);
    let name = node.attribute("name").map_or_else(|| format!("{}_{kind}", joint.name), str::to_owned);
    let ranges = [("ctrlrange", "ctrllimited", "control"), ("forcerange", "forcelimited", "force")];
    for (range, limited, what) in ranges {
        if let (Some(text), true) = (element.text(range), element.text(limited) != Some("false")) {
            robot.notes.push(format!("the range of {what} of the actuator `{name}`, {text}, is left out"));
        }
    }
    for key in ["armature", "damping"] {
        if element.list(key)?.is_some_and(|values| values.iter().any(|value| *value != 0.0)) {
            robot.notes.push(format!("the {key} of the actuator `{name}` is left out"));
        }
    }
    robot.actuators.push(Actuator {
        joint: joint.name.clone(),
        gain: gear * gain,
        // The length is gear (q + ref).
        constant: gear * (constant + length * gear * joint.reference),
        coordinate: gear * gear * length,
        velocity: gear * gear * velocity,
        name,
    });
    Ok(())
}
