//! The viewpoint of a scene: for a plane motion the view is perpendicular to its plane, for any other motion
//! it is from above and from one side.

use crate::scene::Scene;
use crate::still::bounds::{Bounds, NOTHING, followed};

/// The angles by which a view in space is turned about the vertical, and tilted.
const YAW: f64 = -0.6;
const PITCH: f64 = 0.35;
/// The fraction of the paper that the scene fills.
const FILLED: f64 = 0.85;
/// The distance of the eye from the scene, in units of the size of the scene.
pub(super) const DISTANCE: f64 = 4.0;

/// A point of space as it is seen on the drawing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Seen {
    /// The position of the point, with y pointing down.
    pub(super) at: [f64; 2],
    /// The distance of the point behind the centre of the scene.
    pub(super) depth: f64,
    /// The length that a unit of length at that depth has on the drawing.
    pub(super) scale: f64,
}

/// The view of a scene on paper of a given width and height.
#[derive(Clone, Debug)]
pub(super) struct Camera {
    middle: [f64; 3],
    extent: [f64; 3],
    /// The largest extent of the scene.
    pub(super) size: f64,
    /// The axes of space that point right, away and up, and the signs of the last two.
    axes: [usize; 3],
    signs: [f64; 2],
    pub(super) is_plane: bool,
    /// The height of the floor above the middle: what moves does not go below it.
    pub(super) floor: f64,
    pub(super) paper: [f64; 2],
}

impl Camera {
    /// The view in which the player opens, at a still: of the whole path, or of the model where the path is much longer.
    ///
    /// The direction up is that of the text, or opposite to gravity; without either it is the third axis, or the second
    /// for a motion in a plane perpendicular to the third.
    pub(super) fn of(scene: &Scene, paper: [f64; 2], number: usize) -> Camera {
        let all = Bounds::of_all(scene);
        let spread = all.spread();
        let whole = Some(all.size()).filter(|&size| size > 0.0).unwrap_or(1.0);
        let narrow = spread.into_iter().fold(f64::INFINITY, f64::min);
        let flat = (0..3).rfind(|&k| spread[k] == narrow).unwrap_or(2);
        let is_tilted = |k: usize| all.across[(flat + k) % 3] >= NOTHING;
        let is_plane = narrow < NOTHING * whole && !is_tilted(1) && !is_tilted(2);
        let default = if is_plane && flat == 2 { 1 } else { 2 };
        let down = scene.down();
        let mut up = default;
        let mut steepest = 0.0;
        for (k, g) in down.iter().enumerate() {
            if g.abs() > steepest {
                (steepest, up) = (g.abs(), k);
            }
        }
        if is_plane && up == flat {
            up = default;
        }
        let sign = if down[up] > 0.0 { -1.0 } else { 1.0 };
        let right = if is_plane { 3 - up - flat } else { (up + 1) % 3 };
        let away = 3 - up - right;
        // A right-handed system, also where up is the negative end of an axis.
        let handed = if (right + 1) % 3 == away { sign } else { -sign };
        let (middle, extent, size) = match followed(scene, &all) {
            None => (all.middle(), all.extent(), whole),
            Some(model) => {
                let width = scene.width();
                let still = Bounds::of(scene, &scene.stills[number * width..(number + 1) * width]);
                (still.middle(), [model; 3], model)
            }
        };
        let lowest = if sign > 0.0 { all.low[up] } else { all.high[up] };
        let floor = if lowest.is_finite() { sign * (lowest - middle[up]) } else { 0.0 };
        Camera {
            middle,
            extent,
            size,
            axes: [right, away, up],
            signs: [handed, sign],
            is_plane,
            floor,
            paper,
        }
    }

    /// The distances of a point from the middle of the view: to the right, away, and up.
    pub(super) fn along(&self, p: [f64; 3]) -> [f64; 3] {
        let [right, away, up] = self.axes;
        let from_middle = |k: usize| p[k] - self.middle[k];
        [from_middle(right), self.signs[0] * from_middle(away), self.signs[1] * from_middle(up)]
    }

    /// The point on paper that shows a point in space.
    pub(super) fn project(&self, p: [f64; 3]) -> Seen {
        self.seen(self.along(p))
    }

    /// The point on paper that shows the point at these distances from the middle.
    pub(super) fn seen(&self, [x, y, z]: [f64; 3]) -> Seen {
        let [right, _, up] = self.axes;
        let (yaw, pitch) = if self.is_plane { (0.0, 0.0) } else { (YAW, PITCH) };
        let (u, v) = (yaw.cos() * x - yaw.sin() * y, yaw.sin() * x + yaw.cos() * y);
        let (depth, height) = (pitch.cos() * v - pitch.sin() * z, pitch.sin() * v + pitch.cos() * z);
        let far = DISTANCE * self.size;
        let [width, paper_height] = self.paper;
        let room = |paper: f64, extent: f64| paper / if extent > 0.0 { extent } else { self.size };
        let scale = if self.is_plane {
            FILLED * room(width, self.extent[right]).min(room(paper_height, self.extent[up]))
        } else {
            FILLED * width.min(1.1 * paper_height) / self.size * far / (far + depth)
        };
        // In a plane depths are 0 or −0, and neither is before the other.
        let depth = depth + 0.0;
        Seen { at: [width / 2.0 + u * scale, paper_height / 2.0 - height * scale], depth, scale }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::SceneShape;

    fn scene(points: &[[f32; 3]], gravity: [f64; 3]) -> Scene {
        let times = (0..points.len()).map(|i| i as f64).collect();
        Scene {
            shapes: vec![SceneShape::Point(None)],
            times,
            stills: points.concat(),
            gravity,
            ..Scene::default()
        }
    }

    #[test]
    fn a_plane_motion_fills_the_paper_with_gravity_down() {
        // In the plane y = 0, gravity along z.
        let swing = scene(&[[-1.0, 0.0, -2.0], [1.0, 0.0, 0.0]], [0.0, 0.0, -9.81]);
        let camera = Camera::of(&swing, [400.0, 200.0], 0);
        let [left, right] = [camera.project([-1.0, 0.0, -2.0]), camera.project([1.0, 0.0, 0.0])];
        assert_eq!((left.at, right.at), ([115.0, 185.0], [285.0, 15.0]));
        assert_eq!(left.scale, 85.0);
    }

    #[test]
    fn in_a_plane_nothing_is_behind_anything() {
        let swing = scene(&[[-1.0, 0.0, -2.0], [1.0, 0.0, 0.0]], [0.0, 0.0, -9.81]);
        let camera = Camera::of(&swing, [400.0, 200.0], 0);
        let depths = [-0.5, 0.0, 0.5].map(|x| camera.project([x, 0.0, -1.0]).depth);
        assert!(depths.windows(2).all(|pair| pair[0].total_cmp(&pair[1]).is_eq()), "{depths:?}");
    }

    #[test]
    fn what_falls_along_an_axis_is_drawn_downwards() {
        for (axis, sign) in [(0, 1.0), (1, -1.0), (2, 1.0), (2, -1.0)] {
            let mut gravity = [0.0; 3];
            gravity[axis] = sign;
            let cube = scene(&[[-1.0; 3], [1.0; 3], [1.0, -1.0, 0.5]], gravity);
            let camera = Camera::of(&cube, [300.0, 300.0], 0);
            let below = camera.project(gravity);
            assert!(below.at[1] > 150.0, "{axis} {sign}: {below:?}");
        }
    }

    #[test]
    fn the_view_is_not_a_mirror_image() {
        for gravity in [[0.0, 0.0, -1.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0], [1.0, 0.0, 0.0]] {
            let cube = scene(&[[-1.0; 3], [1.0; 3], [1.0, -1.0, 0.5]], gravity);
            let camera = Camera::of(&cube, [300.0, 300.0], 0);
            let [o, x, y, z] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
                .map(|e| camera.project(e.map(|c| 1e-3 * c)))
                .map(|seen| [seen.at[0], -seen.at[1], -seen.depth]);
            let d = |p: [f64; 3]| [0, 1, 2].map(|k| p[k] - o[k]);
            let (a, b, c) = (d(x), d(y), d(z));
            let cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
            let determinant: f64 = (0..3).map(|k| cross[k] * c[k]).sum();
            assert!(determinant > 0.0, "{gravity:?}: {determinant}");
        }
    }
}
