//! What a model has besides bodies on joints: springs, rotors, actuators, couplings and loops, as lines of
//! text.

use std::fmt::Write;

use crate::import::names::Names;
use crate::import::pose::{Rotation, applied};
use crate::import::robot::{Actuator, Closing, Closure, Coupling, Joint, Robot};

/// The lines `NAME = value` of `[parameters]`, joint by joint.
pub(crate) fn parameters(robot: &Robot, names: &Names<'_>) -> Vec<String> {
    let mut lines = Vec::new();
    for joint in &robot.joints {
        for (quantity, value) in joint.quantities() {
            if let Some(name) = names.parameter(joint, quantity) {
                lines.push(format!("{name} = {value:?}"));
            }
        }
    }
    lines
}

/// The lines of `[inputs]`: the control of each actuator.
pub(crate) fn inputs(robot: &Robot, names: &Names<'_>) -> Vec<String> {
    robot.actuators.iter().map(|actuator| format!("{} = 0.0", names.input(actuator))).collect()
}

/// The rotor, spring, damper and friction of a joint with one coordinate, as entries of the joint.
pub(crate) fn drive_of(joint: &Joint, names: &Names<'_>) -> String {
    let mut text = String::new();
    if !joint.kind.is_single() {
        return text;
    }
    for quantity in ["armature", "stiffness", "damping", "friction"] {
        let Some(name) = names.parameter(joint, quantity) else { continue };
        // Writing to a string cannot fail.
        let _ = write!(text, ", {quantity} = \"{name}\"");
        if quantity == "stiffness" && joint.rest != 0.0 {
            let _ = write!(text, ", rest = {:?}", joint.rest);
        }
    }
    text
}

/// The lines of `[lagrangian]`: ½ a η² of the rotors of joints with several velocities.
pub(crate) fn lagrangian(robot: &Robot, names: &Names<'_>) -> Vec<String> {
    let several = robot.joints.iter().filter(|joint| !joint.kind.is_single());
    let kinetic = several.filter_map(|joint| {
        let armature = names.parameter(joint, "armature")?;
        let squares: Vec<String> =
            names.velocities(joint).iter().map(|velocity| format!("{velocity}^2")).collect();
        Some(format!("{armature}*({})/2", squares.join(" + ")))
    });
    let terms: Vec<String> = kinetic.collect();
    if terms.is_empty() { Vec::new() } else { vec![format!("kinetic = \"{}\"", terms.join(" + "))] }
}

/// The lines of `[forces]`: actuators, and dampers of joints with several velocities, for each velocity. A force on
/// a joint that follows another acts on the velocity of that one, in the ratio of the two.
pub(crate) fn forces(robot: &Robot, names: &Names<'_>) -> Vec<String> {
    let mut forces: Vec<(String, String)> = Vec::new();
    let mut add = |velocity: &str, term: &str| match forces.iter_mut().find(|(known, _)| known == velocity) {
        Some((_, sum)) => *sum += term,
        None => forces.push((velocity.to_owned(), term.to_owned())),
    };
    for joint in &robot.joints {
        if !joint.kind.is_single() {
            let Some(damping) = names.parameter(joint, "damping") else { continue };
            names
                .velocities(joint)
                .iter()
                .for_each(|velocity| add(velocity, &format!(" - {damping}*{velocity}")));
            continue;
        }
        let (leader, ratio) = leader(robot, joint);
        let (Some(x), Some(leading)) = (names.coordinate(joint), names.coordinate(leader)) else { continue };
        for actuator in robot.actuators.iter().filter(|actuator| actuator.joint == joint.name) {
            let input = names.input(actuator);
            let velocity = format!("{leading}'");
            match ratio {
                1.0 => add(&velocity, &drive(actuator, input, (x, &velocity))),
                ratio => {
                    let own = drive(actuator, input, (x, &format!("{ratio:?}*{velocity}")));
                    add(&velocity, &format!(" + {ratio:?}*({})", plain(&own)));
                }
            }
        }
    }
    forces.iter().map(|(velocity, sum)| format!("\"{velocity}\" = \"{}\"", plain(sum))).collect()
}

/// A sum without the plus sign and the spaces before its first term.
fn plain(sum: &str) -> String {
    match sum.strip_prefix(" + ") {
        Some(first) => first.to_owned(),
        None => sum.replacen(" - ", "-", 1),
    }
}

/// The joint that moves a joint, by way of any number of others that it mimics, and the ratio of the two.
fn leader<'r>(robot: &'r Robot, joint: &'r Joint) -> (&'r Joint, f64) {
    let (mut leader, mut ratio) = (joint, 1.0);
    while let Some((mimic, other)) =
        leader.mimic.as_ref().and_then(|mimic| Some((mimic, robot.joint(&mimic.joint)?)))
    {
        ratio *= mimic.multiplier;
        leader = other;
    }
    (leader, ratio)
}

/// The terms of an actuator: gain u + constant + a x + b x'.
fn drive(actuator: &Actuator, input: &str, (x, velocity): (&str, &str)) -> String {
    let mut text = String::new();
    let factors = [
        (actuator.gain, input.to_owned()),
        (actuator.coordinate, x.to_owned()),
        (actuator.velocity, velocity.to_owned()),
    ];
    for (factor, of) in factors.into_iter().filter(|(factor, _)| *factor != 0.0) {
        let sign = if factor < 0.0 { "-" } else { "+" };
        let _ = match factor.abs() {
            1.0 => write!(text, " {sign} {of}"),
            size => write!(text, " {sign} {size:?}*{of}"),
        };
    }
    if actuator.constant != 0.0 {
        text += &signed(actuator.constant);
    }
    text
}

/// The lines of `[constraints]`: couplings, and what a loop of its kind does not hold.
pub(crate) fn constraints(robot: &Robot, names: &Names<'_>) -> Vec<String> {
    let couplings = robot.couplings.iter().filter_map(|coupling| {
        let x = names.coordinate(robot.joint(&coupling.joint)?)?;
        let other = coupling.other.as_ref().and_then(|other| names.coordinate(robot.joint(other)?));
        Some(format!("coupled_{x} = \"{x}{}\"", minus_polynomial(coupling, other)))
    });
    let welds = robot.loops.iter().enumerate().filter(|(_, closure)| closure.kind == Closing::Weld);
    let welds = welds.map(|(place, closure)| {
        let name = names.closure(place);
        let [one, two] = closure.places.map(|place| place.rotation());
        // The x-axis of one stays perpendicular to the y-axis of the other, both turned about the axis of the
        // loop.
        let terms: Vec<String> = (1..=3)
            .map(|k| {
                let [one, two] = [(&one, 0, "a"), (&two, 1, "b")]
                    .map(|(rotation, axis, end)| component(&format!("{name}_{end}"), k, rotation, axis));
                format!("{one}*{two}")
            })
            .collect();
        format!("{name}_turn = \"{}\"", terms.join(" + "))
    });
    couplings.chain(welds).collect()
}

/// The component k along fixed axes of an axis of a frame of a body, by the rotation matrix of the body at a
/// point.
fn component(point: &str, k: usize, rotation: &Rotation, axis: usize) -> String {
    let mut sum = String::new();
    let mut count = 0;
    for (j, row) in rotation.iter().enumerate() {
        let entry = if row[axis].abs() < 1e-15 { 0.0 } else { row[axis] };
        if entry == 0.0 {
            continue;
        }
        let of = format!("{point}_{k}{}", j + 1);
        let sign = if entry < 0.0 { " - " } else { " + " };
        let _ = match (entry.abs() - 1.0).abs() < 1e-15 {
            true => write!(sum, "{sign}{of}"),
            false => write!(sum, "{sign}{:?}*{of}", entry.abs()),
        };
        count += 1;
    }
    match sum.strip_prefix(" + ") {
        Some(plain) if count == 1 => plain.to_owned(),
        Some(plain) => format!("({plain})"),
        None => format!("({})", sum.trim_start().replacen("- ", "-", 1)),
    }
}

/// −(a_0 + a_1 x + a_2 x² + …)
fn minus_polynomial(coupling: &Coupling, other: Option<&str>) -> String {
    let mut text = String::new();
    for (power, coefficient) in coupling.coefficients.iter().enumerate() {
        if *coefficient == 0.0 {
            continue;
        }
        text += &signed(-coefficient);
        match (power, other) {
            (0, _) => {}
            (1, Some(other)) => text += &format!("*{other}"),
            (power, Some(other)) => text += &format!("*{other}^{power}"),
            (_, None) => text += "*0",
        }
    }
    text
}

/// ` + number` or ` - number`
fn signed(number: f64) -> String {
    if number < 0.0 { format!(" - {:?}", -number) } else { format!(" + {number:?}") }
}

/// The start values of coupled coordinates, those of others being the ones given.
pub(crate) fn coupled_starts<'a>(robot: &'a Robot, starts: &[(&Joint, f64)]) -> Vec<(&'a Joint, f64)> {
    let of =
        |name: &str| starts.iter().find(|(joint, _)| joint.name == name).map_or(0.0, |(_, start)| *start);
    let coupled = robot.couplings.iter().filter_map(|coupling| {
        let x = coupling.other.as_deref().map_or(0.0, of);
        let start = coupling.coefficients.iter().rev().fold(0.0, |sum, coefficient| sum * x + coefficient);
        Some((robot.joint(&coupling.joint)?, start))
    });
    coupled.collect()
}

/// The sections of loops.
pub(crate) fn loops(robot: &Robot, names: &Names<'_>) -> Vec<String> {
    robot
        .loops
        .iter()
        .enumerate()
        .map(|(place, closure)| section(closure, names.closure(place), names))
        .collect()
}

fn section(closure: &Closure, name: &str, names: &Names<'_>) -> String {
    let [one, two] = [0, 1].map(|i| names.body(&closure.links[i]));
    let remark = if closure.name == name { String::new() } else { format!("# the loop {}\n", closure.name) };
    let mut text = format!("\n[loops.{name}]\n{remark}");
    let kind = if closure.kind == Closing::Point { "point" } else { "revolute" };
    let _ = write!(text, "kind = \"{kind}\"\nbodies = [\"{one}\", \"{two}\"]\n");
    let [at_one, at_two] = closure.places.map(|place| list(&place.xyz));
    let _ = write!(text, "at = [{at_one}, {at_two}]");
    let axis = match closure.kind {
        Closing::Point => return text,
        Closing::Revolute(axis) => axis,
        Closing::Weld => [0.0, 0.0, 1.0],
    };
    let axes = closure.places.map(|place| {
        let direction = applied(&place.rotation(), axis);
        list(&crate::import::pose::tidy(direction))
    });
    let _ = write!(text, "\naxis = [{}]", axes.join(", "));
    text
}

/// Numbers in brackets.
pub(crate) fn list(numbers: &[f64]) -> String {
    let numbers: Vec<String> = numbers
        .iter()
        .map(|number| if *number == 0.0 { "0".into() } else { format!("{number:?}") })
        .collect();
    format!("[{}]", numbers.join(", "))
}
