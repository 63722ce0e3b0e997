//! One still of a scene.

use crate::picture::{Anchor, Drawing, Ink};
use crate::scene::{Scene, SceneShape};
use crate::still::camera::Camera;
use crate::still::vectors::vector;
use crate::still::{ground, shadows, shapes};

/// The height of the letters of the title and the clock.
const LETTERS: f64 = 14.0;
/// Their position.
const EDGE: f64 = 12.0;

impl Scene {
    /// Still number `number` on paper of this width and height, with the title and the time; the last still if there
    /// are fewer. The still looks as it does in the player of [`animation`](crate::animation) before the view is
    /// turned.
    pub fn drawing(&self, title: &str, number: usize, [width, height]: [f64; 2]) -> Drawing {
        let mut drawing = Drawing { width, height, shapes: Vec::new() };
        let Some(last) = self.times.len().checked_sub(1) else { return drawing };
        let number = number.min(last);
        let camera = Camera::of(self, [width, height], number);
        let all = self.width();
        let still = |i: usize| &self.stills[i * all..(i + 1) * all];
        let (mut own, mut from, mut colours) = (Vec::new(), 0, 0);
        for shape in &self.shapes {
            let numbers = &still(number)[from..from + shape.numbers()];
            let trace: Vec<[f64; 3]> = match shape {
                SceneShape::Trace => (0..=number).map(|i| vector(still(i), from)).collect(),
                _ => Vec::new(),
            };
            let ink = Ink::Curve(colours);
            colours += usize::from(shape.has_colour());
            own.push((camera.project(vector(numbers, 0)).depth, shape, numbers, ink, trace));
            from += shape.numbers();
        }
        own.sort_by(|a, b| b.0.total_cmp(&a.0));
        // What is not defined at this time is not there.
        own.retain(|(_, _, numbers, ..)| numbers.iter().all(|number| number.is_finite()));
        if !camera.is_plane {
            for (_, shape, numbers, ..) in &own {
                shadows::draw(&mut drawing, &camera, (shape, &self.meshes), numbers);
            }
        }
        ground::draw(&mut drawing, &camera);
        for (_, shape, numbers, ink, trace) in own {
            shapes::draw(&mut drawing, &camera, (shape, &self.meshes), numbers, ink, &trace);
        }
        let clock = format!("t = {:.3}", self.times[number]);
        drawing.text([EDGE, EDGE + LETTERS], Anchor::Start, LETTERS, Ink::Text, title);
        drawing.text([width - EDGE, EDGE + LETTERS], Anchor::End, LETTERS, Ink::Soft, clock);
        drawing
    }
}

impl SceneShape {
    /// Whether a shape has its own colour.
    fn has_colour(&self) -> bool {
        match self {
            SceneShape::Point(_)
            | SceneShape::Disc
            | SceneShape::Ring
            | SceneShape::Sphere
            | SceneShape::Box
            | SceneShape::Mesh(_)
            | SceneShape::Trace => true,
            SceneShape::Line(_) | SceneShape::Axes | SceneShape::Spring | SceneShape::Text(_) => false,
        }
    }
}
