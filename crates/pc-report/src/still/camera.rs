//! The viewpoint of a scene: for a plane motion the view is perpendicular to its plane, for any other motion
//! it is from above and from one side.

use crate::scene::{Scene, SceneShape};

/// The angles by which a view in space is turned about the vertical, and tilted.
const YAW: f64 = -0.6;
const PITCH: f64 = 0.35;
/// The fraction of the paper that the scene fills.
const FILLED: f64 = 0.85;
/// The distance of the eye from the scene, in units of the size of the scene.
const DISTANCE: f64 = 4.0;
/// The length, relative to the size of the scene, that counts as zero.
const NOTHING: f64 = 1e-6;

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
    is_plane: bool,
    paper: [f64; 2],
}

/// The box that contains all motion, with and without the extent of the shapes themselves, and the
/// orientation of discs relative to the axes.
struct Bounds {
    low: [f64; 3],
    high: [f64; 3],
    least: [f64; 3],
    most: [f64; 3],
    across: [f64; 3],
}

impl Bounds {
    fn of(scene: &Scene) -> Bounds {
        let (up, down) = ([f64::NEG_INFINITY; 3], [f64::INFINITY; 3]);
        let mut bounds = Bounds { low: down, high: up, least: down, most: up, across: [0.0; 3] };
        for numbers in scene.stills.chunks_exact(scene.width().max(1)) {
            let mut rest = numbers;
            for shape in &scene.shapes {
                let (own, after) = rest.split_at(shape.numbers());
                rest = after;
                bounds.stretch(vector(own, 0), reach(shape, own));
                match shape {
                    SceneShape::Disc | SceneShape::Ring => {
                        let normal = vector(own, 3);
                        (0..3).for_each(|k| bounds.across[k] = bounds.across[k].max(normal[k].abs()));
                    }
                    SceneShape::Axes | SceneShape::Box => bounds.across = [1.0; 3],
                    SceneShape::Line(_) | SceneShape::Spring => {
                        (3..own.len()).step_by(3).for_each(|i| bounds.stretch(vector(own, i), 0.0));
                    }
                    _ => {}
                }
            }
        }
        bounds
    }

    fn stretch(&mut self, p: [f64; 3], reach: f64) {
        for k in (0..3).filter(|&k| p[k].is_finite()) {
            self.low[k] = self.low[k].min(p[k] - reach);
            self.high[k] = self.high[k].max(p[k] + reach);
            self.least[k] = self.least[k].min(p[k]);
            self.most[k] = self.most[k].max(p[k]);
        }
    }
}

/// The extent of a shape around its first point.
fn reach(shape: &SceneShape, numbers: &[f32]) -> f64 {
    let reach = match shape {
        SceneShape::Disc | SceneShape::Ring => f64::from(numbers[6]).abs(),
        SceneShape::Sphere => f64::from(numbers[3]).abs(),
        SceneShape::Box => length(vector(numbers, 3)) / 2.0,
        _ => 0.0,
    };
    if reach.is_finite() { reach } else { 0.0 }
}

/// The vector of the three numbers from index `i` on.
pub(super) fn vector(numbers: &[f32], i: usize) -> [f64; 3] {
    [numbers[i], numbers[i + 1], numbers[i + 2]].map(f64::from)
}

pub(super) fn length(a: [f64; 3]) -> f64 {
    a.iter().map(|x| x * x).sum::<f64>().sqrt()
}

impl Camera {
    /// The direction up is that of the text, or opposite to gravity; without either it is the third axis, or the second
    /// for a motion in a plane perpendicular to the third.
    pub(super) fn of(scene: &Scene, paper: [f64; 2]) -> Camera {
        let Bounds { low, high, least, most, across } = Bounds::of(scene);
        let is_known = [0, 1, 2].map(|k| low[k].is_finite());
        let each = |f: &dyn Fn(usize) -> f64| [0, 1, 2].map(|k| if is_known[k] { f(k) } else { 0.0 });
        let middle = each(&|k| (low[k] + high[k]) / 2.0);
        let extent = each(&|k| high[k] - low[k]);
        let spread = each(&|k| most[k] - least[k]);
        let size = Some(extent.into_iter().fold(0.0, f64::max)).filter(|&size| size > 0.0).unwrap_or(1.0);
        let narrow = spread.into_iter().fold(f64::INFINITY, f64::min);
        let flat = (0..3).rfind(|&k| spread[k] == narrow).unwrap_or(2);
        let is_plane =
            narrow < NOTHING * size && across[(flat + 1) % 3] < NOTHING && across[(flat + 2) % 3] < NOTHING;
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
        Camera { middle, extent, size, axes: [right, away, up], signs: [handed, sign], is_plane, paper }
    }

    /// The point on paper that shows a point in space.
    pub(super) fn project(&self, p: [f64; 3]) -> Seen {
        let [right, away, up] = self.axes;
        let from_middle = |k: usize| p[k] - self.middle[k];
        let (x, y, z) =
            (from_middle(right), self.signs[0] * from_middle(away), self.signs[1] * from_middle(up));
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
        let camera = Camera::of(&swing, [400.0, 200.0]);
        let [left, right] = [camera.project([-1.0, 0.0, -2.0]), camera.project([1.0, 0.0, 0.0])];
        assert_eq!((left.at, right.at), ([115.0, 185.0], [285.0, 15.0]));
        assert_eq!(left.scale, 85.0);
    }

    #[test]
    fn in_a_plane_nothing_is_behind_anything() {
        let swing = scene(&[[-1.0, 0.0, -2.0], [1.0, 0.0, 0.0]], [0.0, 0.0, -9.81]);
        let camera = Camera::of(&swing, [400.0, 200.0]);
        let depths = [-0.5, 0.0, 0.5].map(|x| camera.project([x, 0.0, -1.0]).depth);
        assert!(depths.windows(2).all(|pair| pair[0].total_cmp(&pair[1]).is_eq()), "{depths:?}");
    }

    #[test]
    fn what_falls_along_an_axis_is_drawn_downwards() {
        for (axis, sign) in [(0, 1.0), (1, -1.0), (2, 1.0), (2, -1.0)] {
            let mut gravity = [0.0; 3];
            gravity[axis] = sign;
            let cube = scene(&[[-1.0; 3], [1.0; 3], [1.0, -1.0, 0.5]], gravity);
            let camera = Camera::of(&cube, [300.0, 300.0]);
            let below = camera.project(gravity);
            assert!(below.at[1] > 150.0, "{axis} {sign}: {below:?}");
        }
    }

    #[test]
    fn the_view_is_not_a_mirror_image() {
        for gravity in [[0.0, 0.0, -1.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0], [1.0, 0.0, 0.0]] {
            let cube = scene(&[[-1.0; 3], [1.0; 3], [1.0, -1.0, 0.5]], gravity);
            let camera = Camera::of(&cube, [300.0, 300.0]);
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
