//! Writes a robot as the text of a model.

use std::collections::HashSet;
use std::fmt::Write;
use std::path::Path;

use crate::diagnostics::source::Source;
use crate::import::error::UrdfError;
use crate::import::names::Names;
use crate::import::robot::{Inertial, Joint, Kind, Link, Pose, Robot};
use crate::import::urdf;

/// The text of the model of a robot in URDF, and a line for each kind of element that was left out.
///
/// Bodies have the names of links, and coordinates those of joints, changed if they are not valid names; the
/// root link is fixed, or free if `floats` is set. Limits and meshes become comments.
///
/// # Errors
/// [`UrdfError`], which gives the file, line and column.
pub fn model_of_urdf(source: &Source, floats: bool) -> Result<(String, Vec<String>), UrdfError> {
    let robot = urdf::read(source)?;
    let tree = Tree::of(source, &robot)?;
    tree.check_masses()?;
    tree.check_mimics()?;
    Ok((tree.text(floats), tree.left_out()))
}

/// The links of a robot in the order of a tree.
struct Tree<'a> {
    source: &'a Source,
    robot: &'a Robot,
    /// The links, each after its parent, with the joint between the two.
    order: Vec<(&'a Link, Option<&'a Joint>)>,
    names: Names<'a>,
}

impl<'a> Tree<'a> {
    fn of(source: &'a Source, robot: &'a Robot) -> Result<Tree<'a>, UrdfError> {
        let link = |name: &str| robot.links.iter().find(|link| link.name == name);
        for joint in &robot.joints {
            let entry = format!("<joint {}>", joint.name);
            let fault = |message: String, help: &str| {
                Err(UrdfError::at(source, joint.span.clone(), entry.clone(), message, help))
            };
            for (what, name) in [("parent", &joint.parent), ("child", &joint.child)] {
                if link(name).is_none() {
                    return fault(
                        format!("its {what}, the link `{name}`, is not there"),
                        "declare the link, or correct its name",
                    );
                }
            }
            let others = robot.joints.iter().take_while(|other| other.name != joint.name);
            if let Some(other) = others.into_iter().find(|other| other.child == joint.child) {
                let message =
                    format!("the link `{}` is the child of the joint `{}` already", joint.child, other.name);
                return fault(message, "a link hangs on one other; loops have no place in URDF");
            }
        }
        let joint_of = |link: &Link| robot.joints.iter().find(|joint| joint.child == link.name);
        let mut roots = robot.links.iter().filter(|link| joint_of(link).is_none());
        let Some(root) = roots.next() else {
            let (span, name) = (robot.links[0].span.clone(), &robot.links[0].name);
            let message = "every link hangs on another: there is no root";
            return Err(UrdfError::at(
                source,
                span,
                format!("<link {name}>"),
                message,
                "one link is the child of no joint",
            ));
        };
        if let Some(second) = roots.next() {
            let message =
                format!("`{}` and `{}` hang on nothing: there are two roots", root.name, second.name);
            let entry = format!("<link {}>", second.name);
            return Err(UrdfError::at(source, second.span.clone(), entry, message, "join them by a joint"));
        }
        let mut order: Vec<(&Link, Option<&Joint>)> = vec![(root, None)];
        let mut next = 0;
        while let Some(&(parent, _)) = order.get(next) {
            let hanging = robot.joints.iter().filter(|joint| joint.parent == parent.name);
            order.extend(hanging.filter_map(|joint| Some((link(&joint.child)?, Some(joint)))));
            next += 1;
        }
        if let Some(lost) =
            robot.links.iter().find(|link| !order.iter().any(|(known, _)| known.name == link.name))
        {
            let message =
                format!("`{}` hangs on itself by others, not on the root `{}`", lost.name, root.name);
            let entry = format!("<link {}>", lost.name);
            return Err(UrdfError::at(
                source,
                lost.span.clone(),
                entry,
                message,
                "leave a joint of the circle out",
            ));
        }
        let names = Names::of(&order);
        Ok(Tree { source, robot, order, names })
    }

    /// Checks that everything that moves has mass, or mimics something that has mass: a joint that mimics
    /// another needs no mass of its own.
    fn check_masses(&self) -> Result<(), UrdfError> {
        let mut carries: HashSet<&str> = HashSet::new();
        for (link, joint) in self.order.iter().rev() {
            let has_mass = link.inertial.as_ref().is_some_and(|inertial| {
                inertial.mass > 0.0 || inertial.inertia.iter().any(|&moment| moment != 0.0)
            });
            if has_mass {
                carries.insert(&link.name);
            }
            let Some(joint) = joint else { continue };
            if carries.contains(link.name.as_str()) {
                carries.insert(&joint.parent);
            } else if joint.kind != Kind::Fixed && joint.mimic.is_none() {
                let message = format!(
                    "the link `{}` can move, and neither it nor what hangs on it has mass",
                    link.name
                );
                let entry = format!("<link {}>", link.name);
                let help = "give it an <inertial>, or make its joint `fixed`";
                return Err(UrdfError::at(self.source, link.span.clone(), entry, message, help));
            }
        }
        Ok(())
    }

    /// Checks that each joint that mimics another mimics one that has exactly one coordinate, and none itself.
    fn check_mimics(&self) -> Result<(), UrdfError> {
        let mimics = |joint: &&Joint| joint.mimic.is_some() && joint.kind != Kind::Fixed;
        for first in self.robot.joints.iter().filter(mimics) {
            let mut joint = first;
            let mut seen: Vec<&str> = vec![&joint.name];
            while let Some(mimic) = &joint.mimic {
                let entry = format!("<joint {}>", joint.name);
                let fault = |message: String, help: &str| {
                    UrdfError::at(self.source, joint.span.clone(), entry.clone(), message, help)
                };
                let followed = self.joint_named(&mimic.joint);
                let followed = followed.ok_or_else(|| {
                    fault(format!("it mimics `{}`, which is not there", mimic.joint), "name another joint")
                })?;
                if !(joint.kind.is_single() && followed.kind.is_single()) {
                    let help = "revolute, continuous and prismatic joints can";
                    return Err(fault(format!("it cannot mimic `{}`", followed.name), help));
                }
                if seen.contains(&followed.name.as_str()) {
                    let help = "one of them has to move by itself";
                    return Err(fault(format!("it mimics itself by way of `{}`", followed.name), help));
                }
                seen.push(&followed.name);
                joint = followed;
            }
        }
        Ok(())
    }

    fn joint_named(&self, name: &str) -> Option<&'a Joint> {
        self.robot.joints.iter().find(|known| known.name == name)
    }

    fn left_out(&self) -> Vec<String> {
        let elements = self.robot.left_out.iter().map(|(name, count)| match count {
            1 => format!("one <{name}> is left out"),
            _ => format!("{count} <{name}> are left out"),
        });
        let dry = self.robot.joints.iter().filter(|joint| joint.friction != 0.0);
        let dry = dry.map(|joint| {
            format!("the dry friction {} of the joint `{}` is left out", joint.friction, joint.name)
        });
        let still = self.robot.joints.iter().filter(|joint| joint.kind == Kind::Fixed);
        let still = still.filter_map(|joint| {
            let mimic = joint.mimic.as_ref()?;
            Some(format!("the joint `{}` is fixed: that it mimics `{}` is left out", joint.name, mimic.joint))
        });
        elements.chain(dry).chain(still).collect()
    }

    fn text(&self, floats: bool) -> String {
        let mut text = String::new();
        let mut line = |line: String| {
            text += &line;
            text.push('\n');
        };
        let file = Path::new(self.source.name())
            .file_name()
            .map_or_else(|| "-".into(), |name| name.to_string_lossy());
        line(format!("# Made of the URDF file {} by `pc import`.", one_line(&file)));
        self.left_out().iter().for_each(|left| line(format!("# {}.", one_line(left))));
        line("\n[model]".into());
        line(format!("name = {}", quoted(&self.robot.name)));
        line("\n[parameters]\ng = 9.81 # URDF says nothing of gravity".into());
        for joint in &self.robot.joints {
            if let Some(damping) = self.names.damping(joint) {
                line(format!("{damping} = {:?}", joint.damping));
            }
        }
        line("\n[gravity]\nacceleration = [0, 0, \"-g\"]".into());
        for (link, joint) in &self.order {
            line(self.body(link, *joint, floats));
        }
        // Joints with one coordinate have entries for their dampings.
        let several = self.robot.joints.iter().filter(|joint| !joint.kind.is_single());
        let damped: Vec<(&Joint, &str)> =
            several.filter_map(|joint| Some((joint, self.names.damping(joint)?))).collect();
        if !damped.is_empty() {
            line("\n[forces]".into());
        }
        for (joint, damping) in damped {
            for velocity in self.names.velocities(joint) {
                line(format!("\"{velocity}\" = \"-{damping}*{velocity}\""));
            }
        }
        text
    }

    /// The section of a body.
    fn body(&self, link: &Link, joint: Option<&Joint>, floats: bool) -> String {
        let mut text = format!("\n[bodies.{}]", self.names.body(&link.name));
        let mut line = |line: String| {
            text.push('\n');
            text += &line;
        };
        if link.name != self.names.body(&link.name) {
            line(format!("# the link {}", one_line(&link.name)));
        }
        link.meshes.iter().for_each(|mesh| line(format!("# mesh: {}", one_line(mesh))));
        match joint {
            None => line(format!("joint = {{ kind = \"{}\" }}", if floats { "free" } else { "fixed" })),
            Some(joint) => {
                if !joint.limits.is_empty() {
                    let limits: Vec<String> =
                        joint.limits.iter().map(|(key, value)| format!("{key} {value}")).collect();
                    line(format!("# limits of the joint {}: {}", one_line(&joint.name), limits.join(", ")));
                }
                line(format!("parent = \"{}\"", self.names.body(&joint.parent)));
                line(self.joint(joint));
            }
        }
        if link.inertial.is_none() && joint.is_some_and(|joint| joint.mimic.is_some()) {
            line("mass = 0.0\ninertia = [0.0, 0.0, 0.0]".to_owned());
        }
        if let Some(inertial) = &link.inertial {
            line(format!("mass = {:?}", inertial.mass));
            if inertial.origin.xyz != [0.0; 3] {
                line(format!("center = {}", list(&inertial.origin.xyz)));
            }
            line(format!("inertia = {}", list(&along_axes_of_the_link(inertial))));
        }
        text
    }

    fn joint(&self, joint: &Joint) -> String {
        let kind = match joint.kind {
            Kind::Fixed => "fixed",
            Kind::Revolute | Kind::Continuous => "revolute",
            Kind::Prismatic => "prismatic",
            Kind::Floating => "free",
            Kind::Planar => "planar",
        };
        let mut text = format!("joint = {{ kind = \"{kind}\"");
        if joint.kind.is_single() || joint.kind == Kind::Planar {
            let _ = write!(text, ", axis = {}", list(&joint.axis));
        }
        let Pose { xyz, rpy: [roll, pitch, yaw] } = joint.origin;
        if xyz != [0.0; 3] {
            let _ = write!(text, ", at = {}", list(&xyz));
        }
        let turns = [("z", yaw), ("y", pitch), ("x", roll)].into_iter().filter(|(_, angle)| *angle != 0.0);
        let turns: Vec<String> =
            turns.map(|(axis, angle)| format!("[\"{axis}\", {}]", self::angle(angle))).collect();
        if !turns.is_empty() {
            let _ = write!(text, ", turns = [{}]", turns.join(", "));
        }
        let mimic = joint.mimic.as_ref().filter(|_| joint.kind.is_single());
        if let Some((followed, mimic)) =
            mimic.and_then(|mimic| Some((self.joint_named(&mimic.joint)?, mimic)))
        {
            // Writing to a string cannot fail.
            let _ = write!(text, ", follows = {}", quoted(self.names.body(&followed.child)));
            if mimic.multiplier != 1.0 {
                let _ = write!(text, ", ratio = {:?}", mimic.multiplier);
            }
            if mimic.offset != 0.0 {
                let _ = write!(text, ", offset = {:?}", mimic.offset);
            }
        }
        if let Some(damping) = self.names.damping(joint).filter(|_| joint.kind.is_single()) {
            let _ = write!(text, ", damping = \"{damping}\"");
        }
        match self.names.coordinate(joint) {
            Some(x) if x != self.names.body(&joint.child) => {
                let _ = write!(text, ", coordinates = [\"{x}\"]");
            }
            _ => {}
        }
        text + " }"
    }
}

/// An angle, written as a multiple of a quarter turn if it equals such a multiple to the precision of numbers
/// in a file.
fn angle(angle: f64) -> String {
    let quarters = (angle / std::f64::consts::FRAC_PI_2).round();
    if quarters != 0.0 && (angle - quarters * std::f64::consts::FRAC_PI_2).abs() <= 1e-10 {
        return match quarters as i64 {
            1 => "\"pi/2\"".into(),
            -1 => "\"-pi/2\"".into(),
            2 => "\"pi\"".into(),
            -2 => "\"-pi\"".into(),
            count => format!("\"{count}*pi/2\""),
        };
    }
    format!("{angle:?}")
}

fn list(numbers: &[f64]) -> String {
    let numbers: Vec<String> = numbers
        .iter()
        .map(|number| if *number == 0.0 { "0".into() } else { format!("{number:?}") })
        .collect();
    format!("[{}]", numbers.join(", "))
}

/// The inertia matrix R I Rᵀ, where R is the rotation of the inertial's origin; only the three moments of
/// inertia if the products of inertia vanish.
fn along_axes_of_the_link(inertial: &Inertial) -> Vec<f64> {
    let [xx, yy, zz, xy, yz, xz] = inertial.inertia;
    let own = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    let [roll, pitch, yaw] = inertial.origin.rpy;
    let [xx, yy, zz, xy, yz, xz] = if inertial.origin.rpy == [0.0; 3] {
        inertial.inertia
    } else {
        let product = |a: &[[f64; 3]; 3], b: &[[f64; 3]; 3]| -> [[f64; 3]; 3] {
            std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|l| a[i][l] * b[l][j]).sum()))
        };
        let (a, b, c) = (roll.sin_cos(), pitch.sin_cos(), yaw.sin_cos());
        let about_x = [[1.0, 0.0, 0.0], [0.0, a.1, -a.0], [0.0, a.0, a.1]];
        let about_y = [[b.1, 0.0, b.0], [0.0, 1.0, 0.0], [-b.0, 0.0, b.1]];
        let about_z = [[c.1, -c.0, 0.0], [c.0, c.1, 0.0], [0.0, 0.0, 1.0]];
        let r = product(&about_z, &product(&about_y, &about_x));
        let transposed = std::array::from_fn(|i| std::array::from_fn(|j| r[j][i]));
        let turned = product(&r, &product(&own, &transposed));
        [turned[0][0], turned[1][1], turned[2][2], turned[0][1], turned[1][2], turned[0][2]]
    };
    match [xy, yz, xz] == [0.0; 3] {
        true => vec![xx, yy, zz],
        false => vec![xx, yy, zz, xy, yz, xz],
    }
}

fn quoted(text: &str) -> String {
    let text = text.replace(char::is_control, " ");
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}

fn one_line(text: &str) -> String {
    text.replace(|c: char| c.is_control() || crate::document::is_hidden(c), "\u{fffd}")
}
