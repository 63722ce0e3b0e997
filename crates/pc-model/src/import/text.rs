//! Writes a robot as the text of a model.

use std::fmt::Write;
use std::path::Path;

use crate::diagnostics::source::Source;
use crate::diagnostics::words::rounded;
use crate::import::additions::list;
use crate::import::error::UrdfError;
use crate::import::inertia::{along_axes_of_the_link, impossible};
use crate::import::massless;
use crate::import::meshes::{Directories, Visual};
use crate::import::names::Names;
use crate::import::pose::tidy;
use crate::import::robot::{Inertial, Joint, Kind, Link, Pose, Robot};
use crate::import::xml::parse;
use crate::import::{additions, mjcf, sdf, urdf};

/// How a robot becomes a model.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ImportOptions<'a> {
    /// Whether the root link moves freely; otherwise it is fixed.
    pub floating: bool,
    /// Whether joints that move no mass are fixed; otherwise they are refused.
    pub fix_massless: bool,
    /// The coefficient of restitution of rigid stops at the limits of joints; without it limits become comments.
    pub restitution: Option<f64>,
    /// Where the files of meshes are looked for; without it meshes become comments.
    pub directories: Option<Directories<'a>>,
}

/// The text of the model of a robot in URDF, and notes on what was left out and changed.
///
/// Bodies have the names of links, and coordinates those of joints, changed if they are not valid names.
/// The meshes of URDF are drawn if their files are there; other meshes become comments, and so do limits unless they are to be
/// rigid stops.
///
/// # Errors
/// [`UrdfError`], which gives the file, line and column.
pub fn model_of_robot(
    source: &Source,
    options: ImportOptions<'_>,
) -> Result<(String, Vec<String>), UrdfError> {
    let document = parse(source)?;
    let mut robot = match document.root_element().tag_name().name() {
        "mujoco" => mjcf::read(source, &document)?,
        "sdf" => sdf::read(source, &document)?,
        _ => urdf::read(source, &document)?,
    };
    if let Some(world) = robot.links.first().filter(|link| link.is_world && options.floating) {
        let message = format!("--floating has no place here: {} says which bodies move freely", robot.format);
        let help = "leave the option out, or give the body a free joint";
        return Err(UrdfError::at(source, world.span.clone(), "", message, help));
    }
    if options.fix_massless {
        robot = massless::fixed(&robot, &Tree::of(source, &robot)?.order);
    }
    let tree = Tree::of(source, &robot)?;
    massless::check(source, &robot, &tree.order)?;
    let starts = tree.starts()?;
    let stops = Stops::of(&robot, options.restitution, &starts);
    Ok((tree.text(options, &starts, &stops), tree.left_out(&stops)))
}

/// [`model_of_robot`] with the root link free if `floats` is set, and without joints that move no mass.
///
/// # Errors
/// [`UrdfError`], which gives the file, line and column.
pub fn model_of_urdf(source: &Source, floats: bool) -> Result<(String, Vec<String>), UrdfError> {
    model_of_robot(source, ImportOptions { floating: floats, ..ImportOptions::default() })
}

/// The joints whose limits become rigid stops.
#[derive(Default)]
struct Stops<'a> {
    restitution: f64,
    /// The joints, each with its two ends.
    ends: Vec<(&'a Joint, [f64; 2])>,
    /// The joints whose limits cannot become stops, for they start beyond them.
    beyond: Vec<&'a Joint>,
}

impl<'a> Stops<'a> {
    /// The stops of a robot with this coefficient of restitution, if one is given.
    fn of(robot: &'a Robot, restitution: Option<f64>, starts: &[(&Joint, f64)]) -> Stops<'a> {
        let Some(restitution) = restitution else { return Stops::default() };
        let mut stops = Stops { restitution, ..Stops::default() };
        let coupled = additions::coupled_starts(robot, starts);
        let start_of = |joint: &Joint| {
            let known = coupled.iter().chain(starts).find(|(other, _)| other.name == joint.name);
            known.map_or(0.0, |(_, start)| *start)
        };
        for joint in robot.joints.iter().filter(|joint| joint.kind.is_single()) {
            let end = |key: &str| joint.limits.iter().find(|(known, _)| *known == key).map(|(_, end)| *end);
            let (Some(lower), Some(upper)) = (end("lower"), end("upper")) else { continue };
            match (lower..=upper).contains(&start_of(joint)) && lower < upper {
                true => stops.ends.push((joint, [lower, upper])),
                false => stops.beyond.push(joint),
            }
        }
        stops
    }

    /// The entries of a joint.
    fn entries(&self, joint: &Joint) -> Option<String> {
        let (_, ends) = self.ends.iter().find(|(other, _)| other.name == joint.name)?;
        Some(format!(", limits = {}, restitution = {:?}", list(ends), self.restitution))
    }
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
        let names = Names::of(robot, &order);
        Ok(Tree { source, robot, order, names })
    }

    /// The start values of joints that mimic others; all other joints start at 0.
    fn starts(&self) -> Result<Vec<(&'a Joint, f64)>, UrdfError> {
        let mut starts = Vec::new();
        for first in
            self.robot.joints.iter().filter(|joint| joint.mimic.is_some() && joint.kind != Kind::Fixed)
        {
            // x = m (m' (… ) + o') + o
            let (mut factor, mut start, mut joint) = (1.0, 0.0, first);
            let mut seen: Vec<&str> = vec![&joint.name];
            while let Some(mimic) = &joint.mimic {
                start += factor * mimic.offset;
                factor *= mimic.multiplier;
                let entry = format!("<joint {}>", joint.name);
                let fault = |message: String, help: &str| {
                    UrdfError::at(self.source, joint.span.clone(), entry.clone(), message, help)
                };
                let followed = self.robot.joints.iter().find(|known| known.name == mimic.joint);
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
            starts.push((first, start));
        }
        Ok(starts)
    }

    fn left_out(&self, stops: &Stops<'_>) -> Vec<String> {
        let elements = self.robot.left_out.iter().map(|(name, count)| match count {
            1 => format!("one <{name}> is left out"),
            _ => format!("{count} <{name}> are left out"),
        });
        let dry = self.robot.joints.iter().filter(|joint| joint.friction != 0.0 && !joint.kind.is_single());
        let dry = dry.map(|joint| {
            format!("the dry friction {} of the joint `{}` is left out", joint.friction, joint.name)
        });
        let still = self.robot.joints.iter().filter(|joint| joint.kind == Kind::Fixed);
        let still = still.filter_map(|joint| {
            let mimic = joint.mimic.as_ref()?;
            Some(format!("the joint `{}` is fixed: that it mimics `{}` is left out", joint.name, mimic.joint))
        });
        let remarks = self.robot.joints.iter().flat_map(|joint| joint.remarks.clone());
        let beyond = stops
            .beyond
            .iter()
            .map(|joint| format!("the joint `{}` starts beyond its limits, which are left out", joint.name));
        let moments = self.robot.links.iter().filter_map(|link| {
            let [a, b, c] = impossible(link.inertial.as_ref()?)?.map(rounded);
            Some(format!(
                "no body has the principal moments of inertia {a}, {b} and {c} of the link `{}`: one is \
                 negative, or larger than the sum of the others",
                link.name
            ))
        });
        elements
            .chain(self.robot.notes.clone())
            .chain(dry)
            .chain(still)
            .chain(remarks)
            .chain(beyond)
            .chain(moments)
            .collect()
    }

    fn text(&self, options: ImportOptions<'_>, starts: &[(&Joint, f64)], stops: &Stops<'_>) -> String {
        let mut text = String::new();
        let mut line = |line: String| {
            text += &line;
            text.push('\n');
        };
        let file = Path::new(self.source.name())
            .file_name()
            .map_or_else(|| "-".into(), |name| name.to_string_lossy());
        line(format!("# Made of the {} file {} by `pc import`.", self.robot.format, one_line(&file)));
        self.left_out(stops).iter().for_each(|left| line(format!("# {}.", one_line(left))));
        line("\n[model]".into());
        line(format!("name = {}", quoted(&self.robot.name)));
        let section = |title: &str, lines: Vec<String>| match lines.as_slice() {
            [] => String::new(),
            lines => format!("\n[{title}]\n{}\n", lines.join("\n")),
        };
        let (weight, gravity) = self.gravity();
        let parameters = weight.into_iter().chain(additions::parameters(self.robot, &self.names)).collect();
        text += &section("parameters", parameters);
        text += &section("inputs", additions::inputs(self.robot, &self.names));
        text += &section("gravity", vec![gravity]);
        let mut line = |line: String| {
            text += &line;
            text.push('\n');
        };
        let coupled = additions::coupled_starts(self.robot, starts);
        let apart: Vec<_> = coupled.iter().filter(|(_, start)| *start != 0.0).collect();
        if !apart.is_empty() {
            line("\n[coordinates]".into());
            for (joint, start) in apart {
                let x = self.names.coordinate(joint).unwrap_or_default(); // what is coupled has one
                line(format!("{x} = {start:?}"));
            }
        }
        for (link, joint) in self.order.iter().filter(|(link, _)| !link.is_world) {
            line(self.body(link, *joint, options, stops));
        }
        additions::loops(self.robot, &self.names).into_iter().for_each(&mut line);
        text += &section("constraints", additions::constraints(self.robot, &self.names));
        text += &section("lagrangian", additions::lagrangian(self.robot, &self.names));
        text += &section("forces", additions::forces(self.robot, &self.names));
        for (link, visual, path) in self.seen(options) {
            text += &self.drawn(link, visual, &path);
        }
        text
    }

    /// A parameter for the weight, if gravity is vertical, and the line of `[gravity]`.
    fn gravity(&self) -> (Option<String>, String) {
        match self.robot.gravity {
            None => {
                let weight = format!("g = 9.81 # {} says nothing of gravity", self.robot.format);
                (Some(weight), "acceleration = [0, 0, \"-g\"]".to_owned())
            }
            Some([0.0, 0.0, down]) if down < 0.0 => {
                (Some(format!("g = {:?}", -down)), "acceleration = [0, 0, \"-g\"]".to_owned())
            }
            Some(acceleration) => (None, format!("acceleration = {}", list(&acceleration))),
        }
    }

    /// The meshes whose files are there, each with its link and the path of its file.
    fn seen(&self, options: ImportOptions<'a>) -> impl Iterator<Item = (&'a Link, &'a Visual, String)> {
        let links = self.order.iter().map(|&(link, _)| link);
        let visuals = links.flat_map(|link| link.visuals.iter().map(move |visual| (link, visual)));
        visuals
            .filter_map(move |(link, visual)| Some((link, visual, options.directories?.path(&visual.file)?)))
    }

    /// The entry of a mesh.
    fn drawn(&self, link: &Link, visual: &Visual, path: &str) -> String {
        let Visual { origin, scale, .. } = visual;
        let mut lines = vec!["\n[[draw]]".to_owned(), "kind = \"mesh\"".to_owned()];
        lines.push(format!("body = {}", quoted(self.names.body(&link.name))));
        lines.push(format!("file = {}", quoted(path)));
        if origin.xyz != [0.0; 3] {
            lines.push(format!("at = {}", list(&origin.xyz)));
        }
        if origin.rpy != [0.0; 3] {
            lines.push(format!("rotation = {}", list(&origin.rotation().map(tidy).concat())));
        }
        if *scale != [1.0; 3] {
            lines.push(format!("scale = {}", list(scale)));
        }
        lines.join("\n") + "\n"
    }

    /// The section of a body.
    fn body(
        &self,
        link: &Link,
        joint: Option<&Joint>,
        options: ImportOptions<'_>,
        stops: &Stops<'_>,
    ) -> String {
        let mut text = format!("\n[bodies.{}]", self.names.body(&link.name));
        let mut line = |line: String| {
            text.push('\n');
            text += &line;
        };
        if link.name != self.names.body(&link.name) {
            line(format!("# the link {}", one_line(&link.name)));
        }
        let is_seen = |mesh: &str| {
            let mut visuals = link.visuals.iter().filter(|visual| visual.file == mesh);
            options.directories.is_some_and(|at| at.path(mesh).is_some()) && visuals.next().is_some()
        };
        for mesh in link.meshes.iter().filter(|mesh| !is_seen(mesh)) {
            line(format!("# mesh: {}", one_line(mesh)));
        }
        match joint {
            None => {
                line(format!("joint = {{ kind = \"{}\" }}", if options.floating { "free" } else { "fixed" }));
            }
            Some(joint) => {
                joint.remarks.iter().for_each(|remark| line(format!("# {}", one_line(remark))));
                if self.names.coordinate(joint).is_some_and(|x| x != joint.name) {
                    line(format!("# the joint {}", one_line(&joint.name)));
                }
                let stopped = stops.entries(joint);
                if stopped.is_none() && !joint.limits.is_empty() {
                    let limits: Vec<String> =
                        joint.limits.iter().map(|(key, value)| format!("{key} {value}")).collect();
                    line(format!("# limits of the joint {}: {}", one_line(&joint.name), limits.join(", ")));
                }
                line(format!("parent = \"{}\"", self.names.body(&joint.parent)));
                line(self.joint(joint, stopped.as_deref().unwrap_or_default()));
            }
        }
        if let Some(inertial) = &link.inertial {
            line(format!("mass = {:?}", inertial.mass));
            if inertial.origin.xyz != [0.0; 3] {
                line(format!("center = {}", list(&inertial.origin.xyz)));
            }
            line(format!("inertia = {}", list(&moments(inertial))));
        }
        text
    }

    /// The entry `joint`, with the entries of its stops.
    fn joint(&self, joint: &Joint, stops: &str) -> String {
        let kind = match joint.kind {
            Kind::Fixed => "fixed",
            Kind::Revolute | Kind::Continuous => "revolute",
            Kind::Prismatic => "prismatic",
            Kind::Floating => "free",
            Kind::Planar => "planar",
            Kind::Spherical => "spherical",
            Kind::Universal => "universal",
            Kind::Screw => "screw",
        };
        let mut text = format!("joint = {{ kind = \"{kind}\"");
        if joint.kind == Kind::Universal {
            let _ = write!(text, ", axes = [{}, {}]", list(&joint.axis), list(&joint.second_axis));
        } else if joint.kind.has_axis() {
            let _ = write!(text, ", axis = {}", list(&joint.axis));
        }
        if joint.kind == Kind::Screw {
            let _ = write!(text, ", pitch = {:?}", joint.pitch);
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
        if let Some(mimic) = joint.mimic.as_ref().filter(|_| joint.kind.is_single()) {
            let followed = self.robot.joint(&mimic.joint).map_or("", |other| self.names.body(&other.child));
            // Writing to a string cannot fail.
            let _ = write!(text, ", follows = {}", quoted(followed));
            if mimic.multiplier != 1.0 {
                let _ = write!(text, ", ratio = {:?}", mimic.multiplier);
            }
            if mimic.offset != 0.0 {
                let _ = write!(text, ", offset = {:?}", mimic.offset);
            }
        }
        text += &additions::drive_of(joint, &self.names);
        text += stops;
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

/// The inertia matrix in axes of the link; only the three moments of inertia if the products of inertia
/// vanish.
fn moments(inertial: &Inertial) -> Vec<f64> {
    let [xx, yy, zz, xy, yz, xz] = along_axes_of_the_link(inertial);
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
