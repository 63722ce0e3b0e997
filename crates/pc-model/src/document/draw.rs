//! `[[draw]]`: shapes that follow the motion.

use super::reader::Item;
use crate::diagnostics::error::ModelError;
use crate::diagnostics::error_kind::ErrorKind;
use crate::diagnostics::source::Place;
use crate::document::expression::{Expression, Located};

/// An entry of `[[draw]]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Draw {
    /// The entry.
    pub place: Place,
    /// The shape drawn.
    pub shape: DrawnShape,
    /// The body in whose axes the shape is described, from the body's origin; the fixed axes if left out.
    pub body: Option<Located<String>>,
}

/// A position, given by two or three expressions.
pub type DrawnPlace = Vec<Expression>;

/// A shape, described by expressions.
#[derive(Clone, Debug, PartialEq)]
pub enum DrawnShape {
    /// A dot whose size does not depend on its distance from the viewer.
    Point {
        /// Its position.
        at: DrawnPlace,
    },
    /// A polyline.
    Line {
        /// Its corners, of which there are two or more.
        through: Vec<DrawnPlace>,
    },
    /// A disc.
    Disc {
        /// Its centre.
        at: DrawnPlace,
        /// A vector perpendicular to the disc.
        normal: Option<DrawnPlace>,
        /// Its radius.
        radius: Expression,
    },
    /// A ring: the edge of a disc.
    Ring {
        /// Its centre.
        at: DrawnPlace,
        /// A vector perpendicular to the ring.
        normal: Option<DrawnPlace>,
        /// Its radius.
        radius: Expression,
    },
    /// A sphere.
    Sphere {
        /// Its centre.
        at: DrawnPlace,
        /// Its radius.
        radius: Expression,
    },
    /// A box.
    Box {
        /// Its centre.
        at: DrawnPlace,
        /// The lengths of the box's edges.
        size: DrawnPlace,
        /// The rows of the rotation matrix R from the box's axes to the fixed axes.
        rotation: Option<Box<[Expression; 9]>>,
    },
    /// A surface of triangles, from a file.
    Mesh {
        /// The file, in STL or OBJ.
        file: Located<String>,
        /// The place of the origin of the file's axes; the origin if left out.
        at: Option<DrawnPlace>,
        /// The rows of the rotation matrix R from the file's axes to those of the body, or to the fixed axes.
        rotation: Option<Box<[Expression; 9]>>,
        /// The factors of the lengths along the file's axes.
        scale: [f64; 3],
    },
    /// A spring.
    Spring {
        /// One end.
        from: DrawnPlace,
        /// The other.
        to: DrawnPlace,
    },
    /// The path that a point has traced so far.
    Trace {
        /// The point.
        at: DrawnPlace,
    },
    /// Words.
    Text {
        /// The position where the words begin.
        at: DrawnPlace,
        /// The words.
        text: Located<String>,
    },
}

const KINDS: &[(&str, Keys)] = &[
    ("point", Keys(&["kind", "body", "at"])),
    ("line", Keys(&["kind", "body", "through"])),
    ("disc", Keys(&["kind", "body", "at", "normal", "radius"])),
    ("ring", Keys(&["kind", "body", "at", "normal", "radius"])),
    ("sphere", Keys(&["kind", "body", "at", "radius"])),
    ("box", Keys(&["kind", "body", "at", "size", "rotation"])),
    ("mesh", Keys(&["kind", "body", "file", "at", "rotation", "scale"])),
    ("spring", Keys(&["kind", "body", "from", "to"])),
    ("trace", Keys(&["kind", "body", "at"])),
    ("text", Keys(&["kind", "body", "at", "text"])),
];

/// The entries allowed for a kind of shape.
#[derive(Clone, Copy)]
struct Keys(&'static [&'static str]);

const AT: &str = "at = [\"x\", \"y\", 0]";
const THROUGH: &str = "through = [[0, 0, 0], [\"x\", \"y\", 0]]";

/// The entries of `[[draw]]`.
pub(super) fn draw(item: &Item<'_>) -> Result<Vec<Draw>, ModelError> {
    item.entries("[[draw]]")?.iter().map(entry).collect()
}

fn entry(item: &Item<'_>) -> Result<Draw, ModelError> {
    let table = item.table("an entry [[draw]]", "kind = \"point\"")?;
    let part = |key: &str| table.items().find(|part| part.key() == key);
    let wanted = |key: &'static str, example: &'static str| {
        part(key).ok_or_else(|| table.error(ErrorKind::Missing { key, example }))
    };
    let kind = wanted("kind", "kind = \"point\"")?;
    let Keys(allowed) = kind.choice(KINDS)?.value;
    if let Some(foreign) = table.items().find(|part| !allowed.contains(&part.key())) {
        return Err(foreign.unknown(allowed));
    }
    let at = || place(&wanted("at", AT)?);
    let rotation = || {
        let rows = part("rotation")
            .map(|part| part.array("9 expressions", "rotation = [1, 0, 0, 0, 1, 0, 0, 0, 1]"))
            .transpose();
        rows.map(|rows| rows.map(Box::new))
    };
    let shape = match kind.text()?.value.as_str() {
        "line" => {
            let through = wanted("through", THROUGH)?;
            let corners = through.parts(LINES, "2 to 64 places", THROUGH)?;
            DrawnShape::Line { through: corners.iter().map(place).collect::<Result<_, _>>()? }
        }
        "disc" | "ring" => {
            let (at, normal) = (at()?, part("normal").as_ref().map(place).transpose()?);
            let radius = wanted("radius", "radius = \"r\"")?.expression()?;
            match kind.text()?.value.as_str() {
                "disc" => DrawnShape::Disc { at, normal, radius },
                _ => DrawnShape::Ring { at, normal, radius },
            }
        }
        "sphere" => {
            DrawnShape::Sphere { at: at()?, radius: wanted("radius", "radius = \"r\"")?.expression()? }
        }
        "box" => DrawnShape::Box {
            at: at()?,
            size: place(&wanted("size", "size = [1.0, 0.5, 0.2]")?)?,
            rotation: rotation()?,
        },
        "mesh" => DrawnShape::Mesh {
            file: wanted("file", "file = \"arm.stl\"")?.text()?,
            at: part("at").as_ref().map(place).transpose()?,
            rotation: rotation()?,
            scale: part("scale").as_ref().map_or(Ok([1.0; 3]), scale)?,
        },
        "spring" => DrawnShape::Spring {
            from: place(&wanted("from", "from = [0, 0, 0]")?)?,
            to: place(&wanted("to", "to = [\"x\", 0, 0]")?)?,
        },
        "trace" => DrawnShape::Trace { at: at()? },
        "text" => DrawnShape::Text { at: at()?, text: wanted("text", "text = \"…\"")?.text()? },
        _ => DrawnShape::Point { at: at()? },
    };
    let body = part("body").map(|part| part.text()).transpose()?;
    Ok(Draw { place: table.place.clone(), shape, body })
}

/// The factor of all lengths, or one for each axis.
fn scale(item: &Item<'_>) -> Result<[f64; 3], ModelError> {
    let (expected, example) = ("a number or 3 numbers", "scale = 0.001");
    let given =
        if item.is_number() { vec![item.number()?.value; 3] } else { item.numbers(expected, example)? };
    let wrong = |kind| Err(item.error(kind));
    match <[f64; 3]>::try_from(given) {
        Ok(scale) if !scale.contains(&0.0) => Ok(scale),
        Ok(_) => {
            let expected = "factors other than 0";
            wrong(ErrorKind::OutOfRange { expected, found: item.raw().to_owned(), example })
        }
        Err(given) => wrong(ErrorKind::WrongLength { expected, found: given.len(), example }),
    }
}

/// The numbers of corners that a polyline may have.
const LINES: &[usize] = &{
    let mut lengths = [0; 63];
    let mut i = 0;
    while i < lengths.len() {
        lengths[i] = i + 2;
        i += 1;
    }
    lengths
};

/// A position: two expressions in a plane, three in space.
fn place(item: &Item<'_>) -> Result<DrawnPlace, ModelError> {
    item.list(&[2, 3], "2 or 3 expressions", AT)
}
