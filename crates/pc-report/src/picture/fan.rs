//! Quantiles over a common quantity: shaded bands about the median.

use crate::picture::axes::Axis;
use crate::picture::drawing::{Drawing, Ink};
use crate::picture::panel::Fan;
use crate::picture::simplify::simplified;

/// The parts of the colour of the curve that the outermost and the innermost band have; the rest is white.
const SHADES: [f64; 2] = [0.18, 0.42];

impl Fan {
    /// All values.
    pub(super) fn values(&self) -> impl Iterator<Item = f64> {
        let edges = self.bands.iter().flat_map(|band| band.low.iter().chain(&band.high)).copied();
        edges.chain(self.middle.points.iter().map(|p| p.1))
    }

    /// The colour of a band.
    pub(super) fn ink(&self, band: usize) -> Ink {
        let last = self.bands.len().saturating_sub(1).max(1) as f64;
        let part = SHADES[0] + (SHADES[1] - SHADES[0]) * band as f64 / last;
        Ink::Mixed(Ink::Curve(0).colour().map(|c| (255.0 - part * (255.0 - f64::from(c))).round() as u8))
    }

    /// Shades the bands, at each edge with at most `most` points.
    pub(super) fn shade(&self, drawing: &mut Drawing, (across, up): (&Axis, &Axis), most: usize) {
        for (i, band) in self.bands.iter().enumerate() {
            let placed: Vec<[[f64; 2]; 2]> = self
                .across
                .iter()
                .zip(band.low.iter().zip(&band.high))
                .map(|(&x, (&low, &high))| {
                    let x = across.place(x);
                    [[x, up.place(low)], [x, up.place(high)]]
                })
                .collect();
            for piece in placed.split(|pair| !pair.as_flattened().iter().all(|x| x.is_finite())) {
                let edge = |k: usize| simplified(&piece.iter().map(|pair| pair[k]).collect::<Vec<_>>(), most);
                if piece.len() > 1 {
                    let corners = edge(0).into_iter().chain(edge(1).into_iter().rev()).collect();
                    drawing.filled(corners, self.ink(i));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::drawing::Shape;
    use crate::picture::panel::{Band, Curve};

    #[test]
    fn a_band_lies_between_its_edges_and_breaks_at_a_gap() {
        let band = Band {
            name: "all".to_owned(),
            low: vec![0.0, 1.0, f64::NAN, 0.0, 0.0],
            high: vec![2.0, 3.0, 3.0, 1.0, 4.0],
        };
        let middle = Curve { name: "median".to_owned(), points: Vec::new() };
        let fan = Fan { across: vec![0.0, 1.0, 2.0, 3.0, 4.0], bands: vec![band], middle };
        let mut drawing = Drawing::default();
        let (across, up) = (Axis::new((0.0, 4.0), (0.0, 40.0)), Axis::new((0.0, 4.0), (40.0, 0.0)));
        fan.shade(&mut drawing, (&across, &up), 100);
        let Shape::Filled { corners, .. } = &drawing.shapes[0] else { panic!("{drawing:?}") };
        assert_eq!(corners, &[[0.0, 40.0], [10.0, 30.0], [10.0, 10.0], [0.0, 20.0]]);
        assert_eq!(drawing.shapes.len(), 2);
    }
}
