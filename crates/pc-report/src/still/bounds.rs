//! The size of the model and of its path, and where it is in each still.

use crate::scene::{Scene, SceneShape};
use crate::still::vectors::{length, vector};

/// The length, relative to the size of the scene, that counts as zero.
pub(super) const NOTHING: f64 = 1e-6;
/// A path that is so many times longer than the model is not shown as a whole: the view follows.
const LONG: f64 = 4.0;
/// What has no parts may be this much smaller than its path.
const LONG_FOR_A_BALL: f64 = 40.0;

/// The box that contains a set of shapes, with and without their extent, and the orientation of discs relative to the axes.
#[derive(Clone, Debug)]
pub(super) struct Bounds {
    pub(super) low: [f64; 3],
    pub(super) high: [f64; 3],
    pub(super) least: [f64; 3],
    pub(super) most: [f64; 3],
    pub(super) across: [f64; 3],
}

impl Default for Bounds {
    /// The box of nothing.
    fn default() -> Bounds {
        let (up, down) = ([f64::NEG_INFINITY; 3], [f64::INFINITY; 3]);
        Bounds { low: down, high: up, least: down, most: up, across: [0.0; 3] }
    }
}

impl Bounds {
    /// The box of the shapes in one still.
    pub(super) fn of(scene: &Scene, numbers: &[f32]) -> Bounds {
        let mut bounds = Bounds::default();
        let mut rest = numbers;
        for shape in &scene.shapes {
            let (own, after) = rest.split_at(shape.numbers());
            rest = after;
            bounds.stretch(vector(own, 0), reach(scene, shape, own));
            match shape {
                SceneShape::Disc | SceneShape::Ring => {
                    let normal = vector(own, 3);
                    (0..3).for_each(|k| bounds.across[k] = bounds.across[k].max(normal[k].abs()));
                }
                SceneShape::Axes | SceneShape::Box | SceneShape::Mesh(_) => bounds.across = [1.0; 3],
                SceneShape::Line(_) | SceneShape::Spring => {
                    (3..own.len()).step_by(3).for_each(|i| bounds.stretch(vector(own, i), [0.0; 3]));
                }
                _ => {}
            }
        }
        bounds
    }

    /// The box of all stills.
    pub(super) fn of_all(scene: &Scene) -> Bounds {
        let stills = scene.stills.chunks_exact(scene.width().max(1));
        stills.fold(Bounds::default(), |all, numbers| all.with(&Bounds::of(scene, numbers)))
    }

    fn with(mut self, other: &Bounds) -> Bounds {
        for k in 0..3 {
            self.low[k] = self.low[k].min(other.low[k]);
            self.high[k] = self.high[k].max(other.high[k]);
            self.least[k] = self.least[k].min(other.least[k]);
            self.most[k] = self.most[k].max(other.most[k]);
            self.across[k] = self.across[k].max(other.across[k]);
        }
        self
    }

    fn stretch(&mut self, p: [f64; 3], reach: [f64; 3]) {
        for k in (0..3).filter(|&k| p[k].is_finite()) {
            self.low[k] = self.low[k].min(p[k] - reach[k]);
            self.high[k] = self.high[k].max(p[k] + reach[k]);
            self.least[k] = self.least[k].min(p[k]);
            self.most[k] = self.most[k].max(p[k]);
        }
    }

    /// Half of the way through; 0 along axes along which nothing is known.
    pub(super) fn middle(&self) -> [f64; 3] {
        self.each(|k| (self.low[k] + self.high[k]) / 2.0)
    }

    pub(super) fn extent(&self) -> [f64; 3] {
        self.each(|k| self.high[k] - self.low[k])
    }

    /// The extent of the places alone.
    pub(super) fn spread(&self) -> [f64; 3] {
        self.each(|k| self.most[k] - self.least[k])
    }

    fn each(&self, f: impl Fn(usize) -> f64) -> [f64; 3] {
        [0, 1, 2].map(|k| if self.low[k].is_finite() { f(k) } else { 0.0 })
    }

    pub(super) fn size(&self) -> f64 {
        self.extent().into_iter().fold(0.0, f64::max)
    }
}

/// What is seen, in units of the size of the model, where the view follows it.
const AROUND: f64 = 1.4;

/// The size of what is seen where the path is so much longer than the model that the view follows it.
pub(super) fn followed(scene: &Scene, all: &Bounds) -> Option<f64> {
    let stills = scene.stills.chunks_exact(scene.width().max(1));
    let model = stills.map(|numbers| Bounds::of(scene, numbers).size()).fold(0.0, f64::max);
    let solid =
        || scene.shapes.iter().filter(|shape| !matches!(shape, SceneShape::Trace | SceneShape::Text(_)));
    let is_ball = solid().count() == 1
        && solid().all(|shape| matches!(shape, SceneShape::Point(_) | SceneShape::Sphere));
    let (path, long) = (all.size(), if is_ball { LONG_FOR_A_BALL } else { LONG });
    (model > NOTHING * path && path > long * model).then_some(AROUND * model)
}

/// How far a shape reaches from its first point along each of the fixed axes.
fn reach(scene: &Scene, shape: &SceneShape, numbers: &[f32]) -> [f64; 3] {
    let size = |i: usize| f64::from(numbers[i]).abs();
    // The rows of R, by half the lengths of the edges of a box along the axes of the body.
    let turned = |rows: usize, half: [f64; 3]| {
        [0, 1, 2].map(|k| (0..3).map(|j| size(rows + 3 * k + j) * half[j]).sum::<f64>())
    };
    let reach = match shape {
        SceneShape::Disc | SceneShape::Ring => {
            let normal = vector(numbers, 3);
            let square = length(normal).powi(2);
            normal.map(|x| size(6) * (1.0 - x * x / if square > 0.0 { square } else { 1.0 }).max(0.0).sqrt())
        }
        SceneShape::Sphere => [size(3); 3],
        SceneShape::Box => turned(6, [3, 4, 5].map(|i| size(i) / 2.0)),
        SceneShape::Mesh(index) => turned(3, scene.meshes[*index][1].reach().map(f64::from)),
        _ => [0.0; 3],
    };
    reach.map(|x| if x.is_finite() { x } else { 0.0 })
}
