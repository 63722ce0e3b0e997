//! The drawing of a shape.

use std::f64::consts::TAU;

use crate::picture::{Anchor, Drawing, Ink};
use crate::scene::SceneShape;
use crate::still::camera::{Camera, Seen, length, vector};

/// The radius of a point.
const DOT: f64 = 5.5;
/// The height of letters.
const LETTERS: f64 = 12.0;
/// The number of corners with which a circle is drawn.
const CORNERS: usize = 48;
/// The number of segments with which a spring is drawn, and the width of its windings to either side.
const WINDINGS: usize = 22;
const WINDING: f64 = 8.0;
/// The length of axes, in units of the size of the scene.
const AXIS: f64 = 0.12;

/// The corners of the faces of a box: the bits of each number select the ends of its edges.
const FACES: [[usize; 4]; 6] =
    [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];

/// Draws a shape, given its numbers, in its own colour; `trace` has its previous points.
pub(super) fn draw(
    drawing: &mut Drawing,
    camera: &Camera,
    shape: &SceneShape,
    numbers: &[f32],
    ink: Ink,
    trace: &[[f64; 3]],
) {
    let at = vector(numbers, 0);
    let seen = camera.project(at);
    let place = |p: [f64; 3]| camera.project(p).at;
    match shape {
        SceneShape::Point(label) => {
            drawing.filled(circle(seen, DOT), ink);
            if let Some(label) = label {
                let beside = [seen.at[0] + 1.5 * DOT, seen.at[1] - DOT];
                drawing.text(beside, Anchor::Start, LETTERS, Ink::Soft, label.clone());
            }
        }
        SceneShape::Sphere => {
            drawing.filled(circle(seen, (f64::from(numbers[3]).abs() * seen.scale).max(1.0)), ink);
        }
        SceneShape::Line(_) => {
            drawing
                .line((0..numbers.len()).step_by(3).map(|i| place(vector(numbers, i))).collect(), Ink::Rod);
        }
        SceneShape::Disc => {
            let rim = rim(at, vector(numbers, 3), f64::from(numbers[6])).map(place);
            outlined(drawing, rim.collect(), ink, 0.35);
        }
        SceneShape::Ring => {
            let mut rim: Vec<_> = rim(at, vector(numbers, 3), f64::from(numbers[6])).map(place).collect();
            rim.extend(rim.first().copied());
            drawing.line(rim, ink);
        }
        SceneShape::Box => {
            let edges = vector(numbers, 3);
            let corner = |bits: usize| {
                let end = |k: usize| ((bits >> k & 1) as f64 - 0.5) * edges[k];
                camera.project(turned(at, &numbers[6..], [end(0), end(1), end(2)]))
            };
            let mut faces = FACES.map(|face| face.map(corner));
            let depth = |face: &[Seen; 4]| face.iter().map(|corner| corner.depth).sum::<f64>();
            faces.sort_by(|a, b| depth(b).total_cmp(&depth(a)));
            for face in faces {
                outlined(drawing, face.map(|corner| corner.at).to_vec(), ink, 0.2);
            }
        }
        SceneShape::Axes => {
            for k in 0..3 {
                let mut end = [0.0; 3];
                end[k] = AXIS * camera.size;
                drawing.line(vec![seen.at, place(turned(at, &numbers[3..], end))], Ink::Curve(k));
            }
        }
        SceneShape::Spring => drawing.line(windings(camera, at, vector(numbers, 3)), Ink::Rod),
        SceneShape::Trace => drawing.line(trace.iter().map(|&p| place(p)).collect(), ink),
        SceneShape::Text(words) => drawing.text(seen.at, Anchor::Start, LETTERS, Ink::Soft, words.clone()),
    }
}

/// Draws an area, with its edge, with a given opacity on white.
fn outlined(drawing: &mut Drawing, mut corners: Vec<[f64; 2]>, ink: Ink, part: f64) {
    let pale = ink.colour().map(|c| (255.0 - part * (255.0 - f64::from(c))).round() as u8);
    drawing.filled(corners.clone(), Ink::Mixed(pale));
    corners.extend(corners.first().copied());
    drawing.line(corners, ink);
}

fn circle(middle: Seen, radius: f64) -> Vec<[f64; 2]> {
    let corner = |i: usize| {
        let (sin, cos) = (TAU * i as f64 / CORNERS as f64).sin_cos();
        [middle.at[0] + radius * cos, middle.at[1] + radius * sin]
    };
    (0..CORNERS).map(corner).collect()
}

/// The points of the rim of a disc perpendicular to a normal.
fn rim(middle: [f64; 3], normal: [f64; 3], radius: f64) -> impl Iterator<Item = [f64; 3]> {
    let n = unit(normal);
    let a = unit(cross(n, if n[0].abs() > 0.9 { [0.0, 1.0, 0.0] } else { [1.0, 0.0, 0.0] }));
    let b = cross(n, a);
    (0..CORNERS).map(move |i| {
        let (sin, cos) = (TAU * i as f64 / CORNERS as f64).sin_cos();
        [0, 1, 2].map(|k| middle[k] + radius * (cos * a[k] + sin * b[k]))
    })
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = length(a);
    a.map(|x| if length > 0.0 { x / length } else { 0.0 })
}

/// The point `at` + R v, with R given row by row.
fn turned(at: [f64; 3], rotation: &[f32], v: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| {
        let row = vector(rotation, 3 * k);
        at[k] + row[0] * v[0] + row[1] * v[1] + row[2] * v[2]
    })
}

/// The points of a zigzag line between two points in space.
fn windings(camera: &Camera, from: [f64; 3], to: [f64; 3]) -> Vec<[f64; 2]> {
    let [start, end] = [camera.project(from).at, camera.project(to).at];
    let way = [end[0] - start[0], end[1] - start[1]];
    let length = way[0].hypot(way[1]);
    let across = if length > 0.0 { [-way[1] / length, way[0] / length] } else { [0.0; 2] };
    let point = |i: usize| {
        let part = i as f64 / WINDINGS as f64;
        let place = camera.project([0, 1, 2].map(|k| from[k] + part * (to[k] - from[k]))).at;
        let side = match i {
            _ if i < 2 || i + 2 > WINDINGS => 0.0,
            _ if i % 2 == 1 => WINDING,
            _ => -WINDING,
        };
        [place[0] + side * across[0], place[1] + side * across[1]]
    };
    (0..=WINDINGS).map(point).collect()
}
