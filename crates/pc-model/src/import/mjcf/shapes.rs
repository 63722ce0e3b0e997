//! The masses of geoms.

use std::f64::consts::PI;

use crate::import::error::UrdfError;
use crate::import::mjcf::compiler::Compiler;
use crate::import::mjcf::defaults::Element;
use crate::import::pose::{Pose, shortest_from_z};
use crate::import::robot::Inertial;

/// A shape with its sizes: radii and half lengths.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Shape {
    Sphere {
        radius: f64,
    },
    /// A cylinder along z with half spheres at its ends.
    Capsule {
        radius: f64,
        half: f64,
    },
    /// A cylinder along z.
    Cylinder {
        radius: f64,
        half: f64,
    },
    Ellipsoid([f64; 3]),
    Box([f64; 3]),
}

impl Shape {
    fn volume(self) -> f64 {
        match self {
            Shape::Sphere { radius } => 4.0 / 3.0 * PI * radius.powi(3),
            Shape::Capsule { radius, half } => PI * radius * radius * (2.0 * half + 4.0 / 3.0 * radius),
            Shape::Cylinder { radius, half } => PI * radius * radius * 2.0 * half,
            Shape::Ellipsoid([a, b, c]) => 4.0 / 3.0 * PI * a * b * c,
            Shape::Box([a, b, c]) => 8.0 * a * b * c,
        }
    }

    /// The principal moments of inertia about the centre, for the mass 1.
    fn moments(self) -> [f64; 3] {
        match self {
            Shape::Sphere { radius } => [0.4 * radius * radius; 3],
            Shape::Cylinder { radius, half } => {
                let across = radius * radius / 4.0 + half * half / 3.0;
                [across, across, radius * radius / 2.0]
            }
            Shape::Capsule { radius, half } => {
                // The shares of the cylinder and of the ball of both ends; these lie (half + 3/8 radius) away
                // from the centre.
                let ends = 4.0 / 3.0 * radius / (2.0 * half + 4.0 / 3.0 * radius);
                let middle = 1.0 - ends;
                let square = radius * radius;
                let across = middle * (square / 4.0 + half * half / 3.0)
                    + ends * (0.4 * square + half * half + 0.75 * half * radius);
                [across, across, middle * square / 2.0 + ends * 0.4 * square]
            }
            Shape::Ellipsoid([a, b, c]) => [b * b + c * c, a * a + c * c, a * a + b * b].map(|sum| sum / 5.0),
            Shape::Box([a, b, c]) => [b * b + c * c, a * a + c * c, a * a + b * b].map(|sum| sum / 3.0),
        }
    }
}

/// The mass of a geom; none if it has no mass.
pub(super) fn inertial(
    compiler: &Compiler,
    geom: &Element<'_, '_, '_>,
) -> Result<Option<Inertial>, UrdfError> {
    let group = geom.number("group")?.unwrap_or(0.0);
    if group < compiler.groups.0 || group > compiler.groups.1 {
        return Ok(None);
    }
    let (mass, density) = (geom.number("mass")?, geom.number("density")?.unwrap_or(1000.0));
    if mass.unwrap_or(density) == 0.0 {
        return Ok(None);
    }
    let help = "give the body an <inertial>, or the geom the mass 0";
    if geom.text("shellinertia") == Some("true") {
        return Err(geom.wrong("shellinertia", "the mass of a shell is not known here", help));
    }
    let kind = geom.text("type").unwrap_or("sphere");
    if geom.source("mesh").is_some() && !matches!(kind, "mesh" | "sdf") {
        return Err(geom.wrong("mesh", "the sizes of a shape around a mesh are not known here", help));
    }
    let mut pose = compiler.pose(geom)?;
    let sizes = geom.list("size")?.unwrap_or_default();
    let ends = match geom.list("fromto")?.as_deref() {
        None => None,
        Some(&[a, b, c, d, e, f]) => Some(([a, b, c], [d, e, f])),
        Some(_) => return Err(geom.wrong("fromto", "these are not two points", "write six numbers")),
    };
    let mut half = None;
    if let Some((from, to)) = ends {
        let along: [f64; 3] = std::array::from_fn(|i| to[i] - from[i]);
        let length = along.iter().map(|part| part * part).sum::<f64>().sqrt();
        if length == 0.0 {
            return Err(geom.wrong("fromto", "the two points coincide", "give two points"));
        }
        half = Some(length / 2.0);
        pose = Pose::new(std::array::from_fn(|i| (from[i] + to[i]) / 2.0), &shortest_from_z(along));
    }
    let size = |i: usize| sizes.get(i).copied().filter(|size| *size > 0.0);
    let missing = || geom.wrong("size", format!("the sizes of the {kind} are not there"), "give its `size`");
    let third = |i: usize| half.or_else(|| size(i)).ok_or_else(missing);
    let second = || if half.is_some() { size(0) } else { size(1) }.ok_or_else(missing);
    let first = || size(0).ok_or_else(missing);
    let shape = match kind {
        "sphere" => Shape::Sphere { radius: first()? },
        "capsule" => Shape::Capsule { radius: first()?, half: third(1)? },
        "cylinder" => Shape::Cylinder { radius: first()?, half: third(1)? },
        "ellipsoid" => Shape::Ellipsoid([first()?, second()?, third(2)?]),
        "box" => Shape::Box([first()?, second()?, third(2)?]),
        "plane" | "hfield" => return Ok(None),
        "mesh" | "sdf" => return Err(geom.wrong("type", "the mass of a mesh is not known here", help)),
        other => {
            let help = "the types are sphere, capsule, cylinder, ellipsoid, box, plane, hfield, mesh and sdf";
            return Err(geom.wrong("type", format!("there is no geom of type `{other}`"), help));
        }
    };
    let mass = mass.unwrap_or_else(|| density * shape.volume());
    let [xx, yy, zz] = shape.moments().map(|moment| mass * moment);
    Ok(Some(Inertial { origin: pose, mass, inertia: [xx, yy, zz, 0.0, 0.0, 0.0] }))
}
