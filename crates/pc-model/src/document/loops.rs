//! Joints between bodies of the tree, as constraints on points of these bodies.

use super::reader::{Item, Table};
use crate::diagnostics::error::ModelError;
use crate::diagnostics::error_kind::ErrorKind;
use crate::document::expression::{Expression, Located, Name};
use crate::document::joints::Point;
use crate::document::tree::direction;

const KEYS: &[&str] = &["bodies", "kind", "at", "axis", "length"];
const BODIES: &str = "bodies = [\"a\", \"b\"]";
const PLACES: &str = "at = [[0, 0, 0], [0, 0, 0]]";
const DIRECTIONS: &str = "axis = [[0, 0, 1], [0, 0, 1]]";

/// A joint that closes a loop between two bodies of the tree.
pub(super) struct Loop {
    pub(super) name: Name,
    pub(super) points: [Point; 2],
    /// Expressions that are required to stay zero, as functions of the components of the points.
    pub(super) constraints: Vec<Expression>,
}

/// The ways to close a loop.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Closing {
    /// A point of one body coincides with a point of the other.
    Point,
    /// A point of one body coincides with a point of the other, and an axis of one is parallel to an axis of
    /// the other.
    Revolute,
    /// A point of one body keeps a constant distance from a point of the other.
    Rod,
}

/// The entries of `[loops.NAME]`.
#[derive(Default)]
struct Entries<'a> {
    bodies: Option<[Located<String>; 2]>,
    kind: Option<Closing>,
    at: Option<[[Expression; 3]; 2]>,
    axis: Option<(Item<'a>, [[f64; 3]; 2])>,
    length: Option<(Item<'a>, Expression)>,
}

/// `[loops.NAME]`
pub(super) fn loops(table: &Table<'_>) -> Result<Vec<Loop>, ModelError> {
    table.items().map(|item| closed(&item)).collect()
}

fn closed(item: &Item<'_>) -> Result<Loop, ModelError> {
    let name = item.new_name()?;
    let table = item.section(&format!("loops.{}", name.text), "[loops.NAME]")?;
    let entries = entries(&table)?;
    let missing = |key, example| table.error(ErrorKind::Missing { key, example });
    let kind = entries.kind.ok_or_else(|| missing("kind", "kind = \"point\""))?;
    let stray = |part: &Item<'_>, example| {
        Err(part.key_error(ErrorKind::OfOtherJoints { key: part.key().to_owned(), example }))
    };
    if let Some((part, _)) = entries.axis.as_ref().filter(|_| kind != Closing::Revolute) {
        return stray(part, "kind = \"revolute\"");
    }
    if let Some((part, _)) = entries.length.as_ref().filter(|_| kind != Closing::Rod) {
        return stray(part, "kind = \"rod\"");
    }
    let mut texts = apart(&name.text);
    match kind {
        Closing::Point => {}
        Closing::Revolute => {
            let (_, [a, b]) = entries.axis.ok_or_else(|| missing("axis", DIRECTIONS))?;
            texts.extend(across(b).map(|n| scalar_product(&name.text, a, n)));
        }
        Closing::Rod => {
            let (_, length) = entries.length.ok_or_else(|| missing("length", "length = 1.0"))?;
            let squares: Vec<String> = texts.iter().map(|part| format!("({part})^2")).collect();
            texts = vec![format!("{} - ({})^2", squares.join(" + "), length.text)];
        }
    }
    let [first, second] = entries.bodies.ok_or_else(|| missing("bodies", BODIES))?;
    let [here, there] = entries.at.ok_or_else(|| missing("at", PLACES))?;
    let point =
        |end, body, at| Ok(Point::new(item.derived_name(format!("{}_{end}", name.text))?, body, Some(at)));
    let points = [point("a", first, here)?, point("b", second, there)?];
    let constraints = texts.into_iter().map(|text| table.following(text, &name.place));
    Ok(Loop { constraints: constraints.collect::<Result<_, _>>()?, name, points })
}

fn entries<'a>(table: &Table<'a>) -> Result<Entries<'a>, ModelError> {
    let mut entries = Entries::default();
    for part in table.items() {
        match part.key() {
            "bodies" => {
                let both = part.parts(&[2], "2 names of bodies", BODIES)?;
                entries.bodies = Some([both[0].text()?, both[1].text()?]);
            }
            "kind" => {
                let kinds =
                    [("point", Closing::Point), ("revolute", Closing::Revolute), ("rod", Closing::Rod)];
                entries.kind = Some(part.choice(&kinds)?.value);
            }
            "at" => {
                let both = part.parts(&[2], "2 places", PLACES)?;
                let place = |item: &Item<'a>| item.array("3 expressions", PLACES);
                entries.at = Some([place(&both[0])?, place(&both[1])?]);
            }
            "axis" => {
                let both = part.parts(&[2], "2 axes", DIRECTIONS)?;
                entries.axis = Some((part.clone(), [axis(&both[0])?, axis(&both[1])?]));
            }
            "length" => entries.length = Some((part.clone(), part.expression()?)),
            _ => return Err(part.unknown(KEYS)),
        }
    }
    Ok(entries)
}

/// The components of the difference of the two points.
fn apart(name: &str) -> Vec<String> {
    ["x", "y", "z"].iter().map(|i| format!("{name}_a_{i} - {name}_b_{i}")).collect()
}

/// The scalar product of a direction of the first body and a direction of the second.
fn scalar_product(name: &str, a: [f64; 3], b: [f64; 3]) -> String {
    let along = |end: &str, u: &[f64; 3], i: usize| {
        let terms = (0..3).filter(|&j| u[j] != 0.0).map(|j| {
            let entry = format!("{name}_{end}_{i}{}", j + 1);
            if u[j] == 1.0 { entry } else { format!("({:?})*{entry}", u[j]) }
        });
        terms.collect::<Vec<_>>().join(" + ")
    };
    let products = (1..=3).map(|i| format!("({})*({})", along("a", &a, i), along("b", &b, i)));
    products.collect::<Vec<_>>().join(" + ")
}

/// An axis, scaled to a unit vector.
fn axis(item: &Item<'_>) -> Result<[f64; 3], ModelError> {
    let axis = direction(item, DIRECTIONS)?;
    Ok(axis.map(|value| value / norm(axis)))
}

/// Two unit vectors that are orthogonal to a given unit vector and to each other.
fn across(u: [f64; 3]) -> [[f64; 3]; 2] {
    let least = (0..3).fold(0, |least, i| if u[i].abs() < u[least].abs() { i } else { least });
    let first = cross(u, [0, 1, 2].map(|i| f64::from(u8::from(i == least))));
    let first = first.map(|value| value / norm(first));
    [first, cross(u, first)]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn norm(v: [f64; 3]) -> f64 {
    v.iter().fold(0.0, |size: f64, value| size.hypot(*value))
}
