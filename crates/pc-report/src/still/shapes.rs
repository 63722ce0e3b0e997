//! The drawing of a shape.

use std::f64::consts::TAU;

use crate::mesh::Mesh;
use crate::picture::{Anchor, Drawing, Ink};
use crate::scene::SceneShape;
use crate::still::camera::{Camera, Seen};
use crate::still::vectors::{CORNERS, corners_of_box, cross, rim, turned, unit, vector};

/// The radius of a point.
const DOT: f64 = 5.5;
/// The height of letters.
const LETTERS: f64 = 12.0;
/// The number of segments with which a spring is drawn, and the width of its windings to either side.
const WINDINGS: usize = 22;
const WINDING: f64 = 8.0;
/// The length of axes, in units of the size of the scene.
const AXIS: f64 = 0.12;

/// Half the width of a rod, in units of the size of the scene, and its colour.
const ROD: f64 = 0.0095;
const GREY: Ink = Ink::Mixed([132, 139, 151]);
/// The number of circles of which a ball is made, and how far its brightest place is towards the light.
const RINGS: usize = 6;
const GLOSS: f64 = 0.55;
/// The direction to the light on the paper: right, down, away; of length 1.
const LIGHT: [f64; 3] = [-0.36, -0.48, -0.8];
/// The part of the light that comes from everywhere.
const AMBIENT: f64 = 0.62;
/// The opacity of the colour of a disc's glass.
const CLEAR: f64 = 0.75;
/// How much of white is mixed into the colour of a surface.
const PALE: f64 = 0.3;

/// The corners of the faces of a box: the bits of each number select the ends of its edges.
const FACES: [[usize; 4]; 6] =
    [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];

/// Draws a shape, given its numbers, in its own colour; `trace` has its previous points.
pub(super) fn draw(
    drawing: &mut Drawing,
    camera: &Camera,
    (shape, meshes): (&SceneShape, &[[Mesh; 2]]),
    numbers: &[f32],
    ink: Ink,
    trace: &[[f64; 3]],
) {
    let at = vector(numbers, 0);
    let seen = camera.project(at);
    let place = |p: [f64; 3]| camera.project(p).at;
    match shape {
        SceneShape::Point(label) => {
            ball(drawing, seen, DOT, ink);
            if let Some(label) = label {
                let beside = [seen.at[0] + 1.5 * DOT, seen.at[1] - DOT];
                drawing.text(beside, Anchor::Start, LETTERS, Ink::Soft, label.clone());
            }
        }
        SceneShape::Sphere => {
            ball(drawing, seen, (f64::from(numbers[3]).abs() * seen.scale).max(1.0), ink);
        }
        SceneShape::Line(_) => {
            let corners: Vec<Seen> =
                (0..numbers.len()).step_by(3).map(|i| camera.project(vector(numbers, i))).collect();
            rods(drawing, camera, &corners);
        }
        SceneShape::Disc => {
            let rim = rim(at, vector(numbers, 3), f64::from(numbers[6])).map(place);
            let mut rim: Vec<_> = rim.collect();
            drawing.glass(rim.clone(), ink.faded(CLEAR));
            rim.extend(rim.first().copied());
            drawing.line(rim, ink);
        }
        SceneShape::Ring => {
            let mut rim: Vec<_> = rim(at, vector(numbers, 3), f64::from(numbers[6])).map(place).collect();
            rim.extend(rim.first().copied());
            drawing.line(rim, ink);
        }
        SceneShape::Box => {
            let corners = corners_of_box(numbers).map(|p| camera.project(p));
            let mut faces = FACES.map(|face| face.map(|corner| corners[corner]));
            let depth = |face: &[Seen; 4]| face.iter().map(|corner| corner.depth).sum::<f64>();
            faces.sort_by(|a, b| depth(b).total_cmp(&depth(a)));
            for face in faces {
                let mut rim = face.map(|corner| corner.at).to_vec();
                drawing.glass(rim.clone(), lit([face[0], face[1], face[2]], ink));
                rim.push(rim[0]);
                drawing.line(rim, ink);
            }
        }
        SceneShape::Mesh(index) => surface(drawing, camera, &meshes[*index][1], numbers, ink),
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

/// Draws a surface in a light from above and from the left, behind the eye: the farthest triangles first.
fn surface(drawing: &mut Drawing, camera: &Camera, mesh: &Mesh, numbers: &[f32], ink: Ink) {
    let at = vector(numbers, 0);
    let corners: Vec<Seen> =
        mesh.corners.iter().map(|p| camera.project(turned(at, &numbers[3..], p.map(f64::from)))).collect();
    let mut faces: Vec<[Seen; 3]> =
        mesh.faces.iter().map(|face| face.map(|corner| corners[corner as usize])).collect();
    let depth = |face: &[Seen; 3]| face.iter().map(|corner| corner.depth).sum::<f64>();
    faces.sort_by(|a, b| depth(b).total_cmp(&depth(a)));
    for face in faces {
        let ink = lit(face, ink);
        let mut rim = face.map(|corner| corner.at).to_vec();
        drawing.filled(rim.clone(), ink);
        // Without its edge there would be gaps between neighbours.
        rim.push(rim[0]);
        drawing.line(rim, ink);
    }
}

/// The colour of a triangle by the angle between its normal and the light.
fn lit(face: [Seen; 3], ink: Ink) -> Ink {
    // On the paper, depths in its units: right, down, away.
    let edge = |k: usize| {
        let (a, b) = (face[0], face[k]);
        [b.at[0] - a.at[0], b.at[1] - a.at[1], (b.depth - a.depth) * a.scale]
    };
    let normal = unit(cross(edge(1), edge(2)));
    let cosine: f64 = normal.iter().zip(LIGHT).map(|(n, l)| n * l).sum();
    let bright = AMBIENT + (1.0 - AMBIENT) * cosine.abs();
    ink.faded(1.0 - PALE).shaded(bright)
}

/// Draws a ball in the same light, its middle the brightest.
fn ball(drawing: &mut Drawing, seen: Seen, radius: f64, ink: Ink) {
    for ring in 0..RINGS {
        let part = ring as f64 / RINGS as f64;
        let to_light = |k: usize| seen.at[k] + GLOSS * part * radius * LIGHT[k];
        let at = [to_light(0), to_light(1)];
        let corners = circle(Seen { at, ..seen }, radius * (1.0 - part));
        drawing
            .filled(corners, ink.faded(1.0 - 0.55 * part * part).shaded(0.8 + 0.2 * (2.0 * part).min(1.0)));
    }
}

/// Draws rods from corner to corner, with joints as wide as they are.
fn rods(drawing: &mut Drawing, camera: &Camera, corners: &[Seen]) {
    let half = |seen: &Seen| (ROD * camera.size * seen.scale).max(1.0);
    for (part, grey) in [(1.0, GREY), (0.45, GREY.faded(0.6))] {
        // The bright line is towards the light.
        let shift = |seen: &Seen, k: usize| seen.at[k] + (1.0 - part) * 0.5 * half(seen) * LIGHT[k];
        let ends: Vec<([f64; 2], f64)> =
            corners.iter().map(|seen| ([shift(seen, 0), shift(seen, 1)], part * half(seen))).collect();
        for two in ends.windows(2) {
            let [(a, ra), (b, rb)] = [two[0], two[1]];
            let way = [b[0] - a[0], b[1] - a[1]];
            let length = way[0].hypot(way[1]);
            if length > 0.0 {
                let side = [-way[1] / length, way[0] / length];
                let beside = |p: [f64; 2], r: f64| [p[0] + r * side[0], p[1] + r * side[1]];
                drawing.filled(vec![beside(a, ra), beside(b, rb), beside(b, -rb), beside(a, -ra)], grey);
            }
        }
        for (seen, (at, radius)) in corners.iter().zip(&ends) {
            drawing.filled(circle(Seen { at: *at, ..*seen }, *radius), grey);
        }
    }
}

fn circle(middle: Seen, radius: f64) -> Vec<[f64; 2]> {
    let corner = |i: usize| {
        let (sin, cos) = (TAU * i as f64 / CORNERS as f64).sin_cos();
        [middle.at[0] + radius * cos, middle.at[1] + radius * sin]
    };
    (0..CORNERS).map(corner).collect()
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
