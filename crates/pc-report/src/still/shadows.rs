//! Shadows on the ground, in a light from above.

use crate::mesh::Mesh;
use crate::picture::{Drawing, Ink};
use crate::scene::SceneShape;
use crate::still::camera::Camera;
use crate::still::vectors::{corners_of_box, rim, turned, vector};

/// How far a shadow moves to the right and away for each unit of height.
const SLANT: [f64; 2] = [0.18, 0.12];
/// How dark it is.
const OPACITY: f64 = 0.16;
/// The width of the shadow of a rod, in units of the size of the scene.
const ROD: f64 = 0.019;
/// The number of corners of the shadow of a ball.
const CORNERS: usize = 24;

/// Draws the shadow of a shape, given its numbers.
pub(super) fn draw(
    drawing: &mut Drawing,
    camera: &Camera,
    (shape, meshes): (&SceneShape, &[[Mesh; 2]]),
    numbers: &[f32],
) {
    let at = vector(numbers, 0);
    let mut area = |places: Vec<[f64; 2]>| {
        drawing.filled(
            places.into_iter().map(|[x, y]| camera.seen([x, y, camera.floor]).at).collect(),
            Ink::Soft.faded(OPACITY),
        );
    };
    let place = |p: [f64; 3]| fallen(camera, p);
    match shape {
        SceneShape::Line(_) | SceneShape::Spring => {
            let corners: Vec<[f64; 2]> =
                (0..numbers.len()).step_by(3).map(|i| place(vector(numbers, i))).collect();
            corners.windows(2).for_each(|ends| area(band(ends[0], ends[1], ROD * camera.size)));
        }
        SceneShape::Disc => area(rim(at, vector(numbers, 3), f64::from(numbers[6])).map(place).collect()),
        SceneShape::Ring => {
            let mut corners: Vec<[f64; 2]> =
                rim(at, vector(numbers, 3), f64::from(numbers[6])).map(place).collect();
            corners.extend(corners.first().copied());
            corners.windows(2).for_each(|ends| area(band(ends[0], ends[1], ROD * camera.size)));
        }
        SceneShape::Sphere => {
            let ([x, y], radius) = (place(at), f64::from(numbers[3]).abs());
            let corner = |i: usize| {
                let (sin, cos) = (std::f64::consts::TAU * i as f64 / CORNERS as f64).sin_cos();
                [x + radius * cos, y + radius * sin]
            };
            area((0..CORNERS).map(corner).collect());
        }
        SceneShape::Box => area(hull(corners_of_box(numbers).map(place).to_vec())),
        SceneShape::Mesh(index) => {
            let mesh = &meshes[*index][1];
            let corner = |p: &[f32; 3]| place(turned(at, &numbers[3..], p.map(f64::from)));
            let corners: Vec<[f64; 2]> = mesh.corners.iter().map(corner).collect();
            for face in &mesh.faces {
                area(face.map(|corner| corners[corner as usize]).to_vec());
            }
        }
        SceneShape::Point(_) | SceneShape::Axes | SceneShape::Trace | SceneShape::Text(_) => {}
    }
}

/// Where the shadow of a point falls, to the right and away.
fn fallen(camera: &Camera, p: [f64; 3]) -> [f64; 2] {
    let [x, y, z] = camera.along(p);
    [x + SLANT[0] * (z - camera.floor), y + SLANT[1] * (z - camera.floor)]
}

/// A band of a given width between two points.
fn band(a: [f64; 2], b: [f64; 2], width: f64) -> Vec<[f64; 2]> {
    let way = [b[0] - a[0], b[1] - a[1]];
    let length = way[0].hypot(way[1]);
    if length == 0.0 {
        return Vec::new();
    }
    let side = [-way[1], way[0]].map(|x| x / length * width / 2.0);
    let beside = |p: [f64; 2], sign: f64| [p[0] + sign * side[0], p[1] + sign * side[1]];
    vec![beside(a, 1.0), beside(b, 1.0), beside(b, -1.0), beside(a, -1.0)]
}

/// The convex hull, by Andrew's monotone chain.
fn hull(mut points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let turn =
        |a: [f64; 2], b: [f64; 2], c: [f64; 2]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    let half = |points: &mut dyn Iterator<Item = [f64; 2]>| {
        let mut chain: Vec<[f64; 2]> = Vec::new();
        for p in points {
            while chain.len() > 1 && turn(chain[chain.len() - 2], chain[chain.len() - 1], p) <= 0.0 {
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let lower = half(&mut points.iter().copied());
    let upper = half(&mut points.iter().rev().copied());
    [lower, upper].concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hull_goes_around() {
        let square = [[0.0, 0.0], [1.0, 0.0], [0.5, 0.5], [1.0, 1.0], [0.0, 1.0], [0.5, 0.0]];
        assert_eq!(hull(square.to_vec()), [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
    }
}
