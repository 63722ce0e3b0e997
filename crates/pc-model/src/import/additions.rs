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

/// The lines of `[lagrangian]`: ½ a η² of rotors and ½ k (x − rest)² of springs.
pub(crate) fn lagrangian(robot: &Robot, names: &Names<'_>) -> Vec<String> {
    let (mut kinetic, mut potential) = (Vec::new(), Vec::new());
    for joint in &robot.joints {
        if let Some(armature) = names.parameter(joint, "armature") {
            let squares: Vec<String> =
                names.velocities(joint).iter().map(|velocity| format!("{velocity}^2")).collect();
            kinetic.push(match squares.as_slice() {
                [square] => format!("{armature}*{square}/2"),
                _ => format!("{armature}*({})/2", squares.join(" + ")),
            });
        }
        if let (Some(stiffness), Some(x)) = (names.parameter(joint, "stiffness"), names.coordinate(joint)) {
            let stretched = match joint.rest {
                0.0 => x.to_owned(),
                rest => format!("({x}{})", signed(-rest)),
            };
            potential.push(format!("{stiffness}*{stretched}^2/2"));
        }
    }
    let lines = [("kinetic", kinetic), ("potential", potential)];
    let lines = lines.iter().filter(|(_, terms)| !terms.is_empty());
    lines.map(|(key, terms)| format!("{key} = \"{}\"", terms.join(" + "))).collect()
}

/// The lines of `[forces]`: dampers and actuators, for each velocity.
pub(crate) fn forces(robot: &Robot, names: &Names<'_>) -> Vec<String> {
    let mut lines = Vec::new();
    for joint in &robot.joints {
        let drives: String = match names.coordinate(joint) {
            Some(x) => {
                let own = robot.actuators.iter().filter(|actuator| actuator.joint == joint.name);
                own.map(|actuator| drive(actuator, names.input(actuator), x)).collect()
            }
            None => String::new(),
        };
        let damping = names.parameter(joint, "damping");
        if damping.is_none() && drives.is_empty() {
            continue;
        }
        for velocity in names.velocities(joint) {
            let damper = damping.map(|damping| format!("-{damping}*{velocity}")).unwrap_or_default();
            let sum = format!("{damper}{drives}");
            let sum = sum.strip_prefix(" + ").unwrap_or(&sum).trim_start();
            lines.push(format!("\"{velocity}\" = \"{sum}\""));
        }
    }
    lines
}

/// The terms of an actuator: gain u + constant + a x + b x'.
fn drive(actuator: &Actuator, input: &str, x: &str) -> String {
    let mut text = String::new();
    let factors = [
        (actuator.gain, input.to_owned()),
        (actuator.coordinate, x.to_owned()),
        (actuator.velocity, format!("{x}'")),
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
