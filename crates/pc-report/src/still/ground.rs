//! The ground below a motion in space, and the wall behind one in a plane: a grid that fades away.

use crate::picture::{Drawing, Ink};
use crate::still::camera::{Camera, DISTANCE};

/// Half the width of the ground, in units of the size of the scene. What is nearer to the eye than this part is not drawn.
const REACH: f64 = 6.0;
const NEAR: f64 = 0.8;
/// Lines of the grid in the size of the scene, and every how many is a strong one.
const LINES: f64 = 5.0;
const STRONG: i64 = 5;
/// The number of pieces of a line, each of one colour.
const PIECES: usize = 24;
/// The opacity of a strong line and of another, and the least that is drawn.
const OPACITY: [f64; 2] = [0.42, 0.19];
const FAINT: f64 = 0.01;

/// Draws the grid.
pub(super) fn draw(drawing: &mut Drawing, camera: &Camera) {
    let spacing = round_below(camera.size / LINES);
    let reach = REACH * camera.size;
    // The grid goes through the origin of space, wherever the view is.
    let origin = camera.along([0.0; 3]);
    let third = if camera.is_plane { 2 } else { 1 };
    for (line, across) in [(0, third), (third, 0)] {
        let first = ((-reach - origin[line]) / spacing).ceil() as i64;
        let last = ((reach - origin[line]) / spacing).floor() as i64;
        for n in first..=last {
            let at = origin[line] + n as f64 * spacing;
            let strength = OPACITY[usize::from(n % STRONG != 0)];
            let place = |along: f64| {
                let mut place = [0.0, 0.0, if camera.is_plane { 0.0 } else { camera.floor }];
                (place[line], place[across]) = (at, along);
                place
            };
            for piece in 0..PIECES {
                let end = |n: usize| reach * (2.0 * n as f64 / PIECES as f64 - 1.0);
                let ends = [end(piece), end(piece + 1)];
                stroke(
                    drawing,
                    camera,
                    ends.map(place),
                    strength * fading(at, (ends[0] + ends[1]) / 2.0, reach),
                );
            }
        }
    }
}

/// Draws a piece of a line, as pale as its opacity says.
fn stroke(drawing: &mut Drawing, camera: &Camera, ends: [[f64; 3]; 2], opacity: f64) {
    let seen = ends.map(|end| camera.seen(end));
    let is_before = |depth: f64| camera.is_plane || depth > -NEAR * DISTANCE * camera.size;
    if opacity < FAINT || !seen.iter().all(|end| is_before(end.depth)) {
        return;
    }
    let on_paper = |k: usize| {
        let (low, high) = (seen[0].at[k].min(seen[1].at[k]), seen[0].at[k].max(seen[1].at[k]));
        high > 0.0 && low < camera.paper[k]
    };
    if on_paper(0) && on_paper(1) {
        drawing.line(seen.map(|end| end.at).to_vec(), Ink::Soft.faded(opacity));
    }
}

fn fading(x: f64, y: f64, reach: f64) -> f64 {
    let far = ((x.hypot(y) / reach - 0.1) / 0.9).clamp(0.0, 1.0);
    let fading = 1.0 - far * far * (3.0 - 2.0 * far);
    fading * fading
}

/// The largest of 1, 2 and 5 times a power of 10 that is no larger.
fn round_below(x: f64) -> f64 {
    let power = 10.0_f64.powf(x.log10().floor());
    [5.0, 2.0].into_iter().map(|digit| digit * power).find(|&round| round <= x).unwrap_or(power)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spacings_are_round() {
        assert_eq!([1.0, 1.9, 2.0, 4.9, 7.0, 0.3].map(round_below), [1.0, 1.0, 2.0, 2.0, 5.0, 0.2]);
    }

    #[test]
    fn the_grid_fades_away() {
        assert_eq!((fading(0.05, 0.0, 1.0), fading(0.8, 0.8, 1.0)), (1.0, 0.0));
    }
}
