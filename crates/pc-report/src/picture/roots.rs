//! A root locus: the ways of eigenvalues in the complex plane while a quantity varies.

use crate::picture::axes::Axis;
use crate::picture::drawing::{Drawing, Ink, Shape};
use crate::picture::panel::Root;
use crate::picture::simplify::simplified;

/// Half the size of the marks of the first and the last point.
const MARK: f64 = 4.0;
/// The length of an arrow, and half its width.
const ARROW: [f64; 2] = [9.0, 3.5];
/// The parts of a way at which arrows point onwards.
const ARROWS: [f64; 2] = [0.3, 0.7];
/// A shorter way, in points of the drawing, has no arrows.
const SHORTEST: f64 = 30.0;
/// The corners of what looks like a circle.
const CORNERS: u32 = 24;

impl Root {
    /// Draws the way: a cross at its first point, a circle at its last, a disc at the present one, and arrows along it.
    pub(super) fn draw(&self, drawing: &mut Drawing, (across, up): (&Axis, &Axis), ink: Ink, most: usize) {
        let place = |&(re, im): &(f64, f64)| [across.place(re), up.place(im)];
        let placed: Vec<[f64; 2]> = self.points.iter().map(place).collect();
        let is_there = |p: &[f64; 2]| p.iter().all(|x| x.is_finite());
        let mut own = Drawing::default();
        for piece in placed.split(|p| !is_there(p)).filter(|piece| piece.len() > 1) {
            own.line(simplified(piece, most), ink);
            arrows(&mut own, piece, ink);
        }
        let mut ends = placed.iter().filter(|p| is_there(p));
        if let Some(&first) = ends.next() {
            cross(&mut own, first, ink);
            let last = ends.next_back().copied().unwrap_or(first);
            own.line(circle(last, MARK), ink);
        }
        if let Some(present) = self.present.as_ref().map(place).filter(is_there) {
            own.filled(circle(present, MARK), ink);
        }
        drawing.shapes.push(Shape::Titled { title: self.title.clone(), shapes: own.shapes });
    }
}

fn cross(drawing: &mut Drawing, [x, y]: [f64; 2], ink: Ink) {
    for sign in [1.0, -1.0] {
        drawing.line(vec![[x - MARK, y - sign * MARK], [x + MARK, y + sign * MARK]], ink);
    }
}

fn circle([x, y]: [f64; 2], radius: f64) -> Vec<[f64; 2]> {
    let corner = |i: u32| {
        let (sine, cosine) = (std::f64::consts::TAU * f64::from(i) / f64::from(CORNERS)).sin_cos();
        [x + radius * cosine, y + radius * sine]
    };
    (0..=CORNERS).map(corner).collect()
}

/// Arrows at parts of the length of a way.
fn arrows(drawing: &mut Drawing, way: &[[f64; 2]], ink: Ink) {
    let length = |pair: &[[f64; 2]]| (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1]);
    let whole: f64 = way.windows(2).map(length).sum();
    if whole < SHORTEST {
        return;
    }
    for part in ARROWS {
        let (mut before, goal) = (0.0, part * whole);
        for pair in way.windows(2) {
            let own = length(pair);
            if own > 0.0 && before + own >= goal {
                let [dx, dy] = [0, 1].map(|k| (pair[1][k] - pair[0][k]) / own);
                let at = [pair[0][0] + dx * (goal - before), pair[0][1] + dy * (goal - before)];
                drawing.filled(arrow(at, [dx, dy]), ink);
                break;
            }
            before += own;
        }
    }
}

/// The corners of an arrow about a point, in a direction of length 1.
fn arrow([x, y]: [f64; 2], [dx, dy]: [f64; 2]) -> Vec<[f64; 2]> {
    let [length, wide] = ARROW;
    let back = [x - length / 2.0 * dx, y - length / 2.0 * dy];
    vec![
        [x + length / 2.0 * dx, y + length / 2.0 * dy],
        [back[0] - wide * dy, back[1] + wide * dx],
        [back[0] + wide * dy, back[1] - wide * dx],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_way_shows_its_direction_its_ends_and_the_present() {
        let points = (0..=10).map(|i| (f64::from(i), 0.0)).collect();
        let root = Root { title: "λ1".to_owned(), points, present: Some((5.0, 0.0)) };
        let mut drawing = Drawing::default();
        let (across, up) = (Axis::new((0.0, 10.0), (0.0, 100.0)), Axis::new((-1.0, 1.0), (100.0, 0.0)));
        root.draw(&mut drawing, (&across, &up), Ink::Curve(0), 100);
        let [Shape::Titled { title, shapes }] = drawing.shapes.as_slice() else { panic!("{drawing:?}") };
        assert_eq!(title, "λ1");
        let filled = shapes.iter().filter_map(|shape| match shape {
            Shape::Filled { corners, .. } => Some(corners.as_slice()),
            _ => None,
        });
        let filled: Vec<_> = filled.collect();
        // Two arrows to the right, and the disc.
        assert_eq!(filled.iter().map(|corners| corners.len()).collect::<Vec<_>>(), [3, 3, 25]);
        assert!(filled[..2].iter().all(|arrow| arrow[0][0] > arrow[1][0] && arrow[0][1] == 50.0));
        // The way, a cross of two lines, and a circle.
        assert_eq!(shapes.len(), filled.len() + 4);
    }
}
