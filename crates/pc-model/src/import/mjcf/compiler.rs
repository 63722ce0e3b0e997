//! The settings of `<compiler>`, and attitudes as these say.

use roxmltree::Node;

use crate::import::error::UrdfError;
use crate::import::mjcf::defaults::Element;
use crate::import::pose::{Pose, Rotation, about, about_axis, of_quaternion, product, shortest_from_z};
use crate::import::xml::{Reader, numbers};

/// The settings that concern the motion.
pub(super) struct Compiler {
    /// The size of the unit of angles in radians.
    pub(super) angle: f64,
    /// The letters of successive rotations; small letters stand for turned axes, capitals for fixed ones.
    sequence: String,
    /// Where masses come from.
    pub(super) inertia_from_geoms: FromGeoms,
    /// The groups of geoms that have mass.
    pub(super) groups: (f64, f64),
}

/// Whether the masses of bodies are those of their geoms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FromGeoms {
    /// Always.
    Always,
    /// Never.
    Never,
    /// Where a body has no `<inertial>`.
    WithoutInertial,
}

/// Settings that change masses after everything else, with the values at which they do nothing.
const CHANGES: &[(&str, &[&str])] = &[
    ("coordinate", &["local"]),
    ("boundmass", &["0"]),
    ("boundinertia", &["0"]),
    ("settotalmass", &["-1", "0"]),
    ("balanceinertia", &["false"]),
];

impl Compiler {
    /// The settings of a document; later elements take precedence.
    pub(super) fn of(xml: &Reader<'_>, root: Node<'_, '_>) -> Result<Compiler, UrdfError> {
        let mut compiler = Compiler {
            angle: 1_f64.to_radians(),
            sequence: "xyz".to_owned(),
            inertia_from_geoms: FromGeoms::WithoutInertial,
            groups: (f64::NEG_INFINITY, f64::INFINITY),
        };
        for node in root.children().filter(|node| node.has_tag_name("compiler")) {
            compiler.update(xml, node)?;
        }
        Ok(compiler)
    }

    fn update(&mut self, xml: &Reader<'_>, node: Node<'_, '_>) -> Result<(), UrdfError> {
        let choice = |key: &str, known: &[&str]| match node.attribute(key) {
            Some(word) if !known.contains(&word) => {
                let help = format!("write one of {}", known.join(", "));
                Err(xml.wrong_value(node, key, format!("`{word}` is not known here"), &help))
            }
            word => Ok(word.map(str::to_owned)),
        };
        for (key, idle) in CHANGES {
            if let Some(value) = node.attribute(*key).filter(|value| !idle.contains(value)) {
                let message = format!("`{key}` = {value} has no place in a model");
                let help = "save the compiled file from MuJoCo, by `mj_saveLastXML`, and import that";
                return Err(xml.wrong_value(node, key, message, help));
            }
        }
        match choice("angle", &["degree", "radian"])?.as_deref() {
            Some("radian") => self.angle = 1.0,
            Some(_) => self.angle = 1_f64.to_radians(),
            None => {}
        }
        if let Some(word) = choice("inertiafromgeom", &["auto", "true", "false"])? {
            self.inertia_from_geoms = match word.as_str() {
                "true" => FromGeoms::Always,
                "false" => FromGeoms::Never,
                _ => FromGeoms::WithoutInertial,
            };
        }
        if let Some(sequence) = node.attribute("eulerseq") {
            if sequence.len() != 3 || !sequence.chars().all(|c| "xyzXYZ".contains(c)) {
                let message = format!("`{sequence}` is no sequence of rotations");
                return Err(xml.wrong_value(node, "eulerseq", message, "write three letters such as `xyz`"));
            }
            sequence.clone_into(&mut self.sequence);
        }
        if let Some(text) = node.attribute("inertiagrouprange") {
            match numbers(text).as_deref() {
                Some(&[first, last]) => self.groups = (first, last),
                _ => {
                    let message = format!("`{text}` is not two numbers");
                    return Err(xml.wrong_value(node, "inertiagrouprange", message, "write `0 5`"));
                }
            }
        }
        Ok(())
    }

    /// The pose of an element: its `pos` and its attitude in one of five forms.
    pub(super) fn pose(&self, element: &Element<'_, '_, '_>) -> Result<Pose, UrdfError> {
        let xyz = element.vector("pos")?.unwrap_or_default();
        Ok(match self.attitude(element)? {
            Some(rotation) => Pose::new(xyz, &rotation),
            None => Pose::at(xyz),
        })
    }

    fn attitude(&self, element: &Element<'_, '_, '_>) -> Result<Option<Rotation>, UrdfError> {
        let Some((_, key)) = element.either(&["quat", "axisangle", "euler", "xyaxes", "zaxis"]) else {
            return Ok(None);
        };
        let numbers = element.list(key)?.unwrap_or_default();
        let length = |v: &[f64]| v.iter().map(|part| part * part).sum::<f64>().sqrt();
        let rotation = match (key, numbers.as_slice()) {
            ("quat", &[w, x, y, z]) if length(&numbers) > 0.0 => of_quaternion([x, y, z, w]),
            ("axisangle", &[x, y, z, angle]) if length(&[x, y, z]) > 0.0 => {
                about_axis([x, y, z], angle * self.angle)
            }
            ("euler", angles) if angles.len() == 3 => self.turned(angles),
            ("xyaxes", &[a, b, c, d, e, f]) if length(&[a, b, c]) > 0.0 => {
                let (x, y) = ([a, b, c].map(|part| part / length(&[a, b, c])), [d, e, f]);
                let along: f64 = (0..3).map(|i| x[i] * y[i]).sum();
                let y: [f64; 3] = std::array::from_fn(|i| y[i] - along * x[i]);
                let size = length(&y);
                if size < 1e-10 {
                    return Err(element.wrong(key, "the axes are parallel", "give two other directions"));
                }
                let y = y.map(|part| part / size);
                let z: [f64; 3] = std::array::from_fn(|i| {
                    x[(i + 1) % 3] * y[(i + 2) % 3] - x[(i + 2) % 3] * y[(i + 1) % 3]
                });
                std::array::from_fn(|i| [x[i], y[i], z[i]])
            }
            ("zaxis", &[x, y, z]) if length(&[x, y, z]) > 0.0 => shortest_from_z([x, y, z]),
            _ => {
                let text = element.text(key).unwrap_or_default();
                let help =
                    "a `quat` is w x y z, an `axisangle` x y z φ, `xyaxes` are six numbers, others three";
                return Err(element.wrong(key, format!("`{text}` is no attitude"), help));
            }
        };
        Ok(Some(rotation))
    }

    /// Successive rotations.
    fn turned(&self, angles: &[f64]) -> Rotation {
        let mut rotation = about(0, 0.0);
        for (letter, angle) in self.sequence.chars().zip(angles) {
            let axis = match letter.to_ascii_lowercase() {
                'x' => 0,
                'y' => 1,
                _ => 2,
            };
            let turn = about(axis, angle * self.angle);
            rotation = match letter.is_lowercase() {
                true => product(&rotation, &turn),
                false => product(&turn, &rotation),
            };
        }
        rotation
    }
}

/// The acceleration of gravity.
pub(super) fn gravity(xml: &Reader<'_>, root: Node<'_, '_>) -> Result<[f64; 3], UrdfError> {
    let mut gravity = [0.0, 0.0, -9.81];
    let mut is_on = true;
    for option in root.children().filter(|node| node.has_tag_name("option")) {
        gravity = xml.vector(option, "gravity")?.unwrap_or(gravity);
        for flag in option.children().filter(|node| node.has_tag_name("flag")) {
            match flag.attribute("gravity") {
                Some("disable") => is_on = false,
                Some("enable") => is_on = true,
                _ => {}
            }
        }
    }
    Ok(if is_on { gravity } else { [0.0; 3] })
}

/// Notes on forces of a surrounding fluid, which a model does not have.
pub(super) fn fluid(root: Node<'_, '_>) -> Vec<String> {
    let options = root.children().filter(|node| node.has_tag_name("option"));
    let forces = options.flat_map(|option| {
        ["density", "viscosity"].into_iter().filter(move |key| {
            option.attribute(*key).is_some_and(|value| value.trim().parse::<f64>() != Ok(0.0))
        })
    });
    forces.map(|key| format!("the {key} of the fluid around the bodies is left out")).collect()
}

/// Checks that no element asks for what a model cannot have, or for another file.
pub(super) fn check(xml: &Reader<'_>, root: Node<'_, '_>) -> Result<(), UrdfError> {
    for node in root.descendants().filter(Node::is_element) {
        let message = match node.tag_name().name() {
            "include" => "the contents of another file belong here".to_owned(),
            name @ ("replicate" | "attach" | "composite" | "flexcomp") => {
                format!("<{name}> has no place in a model")
            }
            _ => continue,
        };
        let help = "save the compiled file from MuJoCo, by `mj_saveLastXML`, and import that";
        return Err(xml.wrong(node, message, help));
    }
    Ok(())
}
