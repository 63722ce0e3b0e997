//! The drawing of a panel: axes, grid lines at round numbers, and contents.

use crate::picture::axes::{Axis, label, range, widened};
use crate::picture::drawing::{Anchor, Drawing, Ink};
use crate::picture::panel::{Content, Curve, Panel, Scale};
use crate::picture::simplify::simplified;

/// The largest number of events that are marked.
const MOST_EVENTS: usize = 60;
/// The width of the scale of colours beside cells, including its numbers.
const LEGEND: f64 = 96.0;
/// The colours that represent values, those of the lowest values first [Smith, van der Walt 2015].
const COLOURS: [[u8; 3]; 9] = [
    [68, 1, 84],
    [71, 44, 122],
    [59, 81, 139],
    [44, 113, 142],
    [33, 144, 141],
    [39, 173, 129],
    [92, 200, 99],
    [170, 220, 50],
    [253, 231, 37],
];

/// A panel as an element of a page, with a description, and with texts in the size used on the page.
pub(crate) fn figure(panel: &Panel, most: usize, id: &str) -> String {
    let (mut drawing, frame) = blank(panel);
    panel.draw(&mut drawing, frame, SIZE, most);
    let (span, values) = (panel.span_in_words(), panel.values_in_words());
    let is_time = panel.across.0 == "t" || panel.across.0.starts_with("t [");
    let over = if is_time { "over time" } else { "to the right" };
    let names = panel.names().join(", ");
    let described =
        format!("{names}: {over} from {} to {}; values from {} to {}", span.0, span.1, values.0, values.1);
    drawing.inline(id, &panel.title, &described)
}

/// The ends of the axes of such an element: on each, the lowest and the highest value, and their places.
pub(crate) fn ends(panel: &Panel) -> [[f64; 4]; 2] {
    let (across, up) = blank(panel).1.axes(panel);
    [across.ends(), up.ends()]
}

/// The size of texts on a page.
const SIZE: f64 = 13.0;

/// A drawing for a page without contents, and its axes.
fn blank(panel: &Panel) -> (Drawing, Frame) {
    const WIDTH: f64 = 480.0;
    let (height, top) = if panel.is_portrait() { (420.0, 26.0) } else { (250.0, 8.0) };
    let margin = panel.margin(height - top - 38.0, SIZE).max(48.0);
    let frame = Frame { left: margin, right: WIDTH - 12.0, top, bottom: height - 38.0 };
    (Drawing { width: WIDTH, height, ..Drawing::default() }, frame)
}

/// The area within the axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub(super) left: f64,
    pub(super) right: f64,
    pub(super) top: f64,
    pub(super) bottom: f64,
}

impl Frame {
    fn axes(&self, panel: &Panel) -> (Axis, Axis) {
        let across = Axis::new(panel.across_range(), (self.left, self.right));
        let up = Axis::new(panel.up_range(), (self.bottom, self.top));
        if !panel.equal {
            return (across, up);
        }
        let per_point = across.per_point().max(up.per_point());
        (across.widened_to(per_point), up.widened_to(per_point))
    }
}

/// The approximate width of a text.
pub(super) fn width_of(text: &str, size: f64) -> f64 {
    0.6 * size * text.chars().count() as f64
}

impl Panel {
    fn across_range(&self) -> (f64, f64) {
        let edge = |middles: &[f64]| match middles {
            [] => (0.0, 1.0),
            [only] => (only - 0.5, only + 0.5),
            [first, second, ..] => {
                let n = middles.len();
                let last = middles[n - 1];
                (first - (second - first) / 2.0, last + (last - middles[n - 2]) / 2.0)
            }
        };
        match (&self.content, self.span) {
            (_, Some(span)) => span,
            (Content::Curves(curves), None) => match self.across.1 {
                Scale::Angles => ANGLES,
                _ => widened(curves.iter().flat_map(|curve| curve.points.iter().map(|p| p.0))),
            },
            (Content::Fan(fan), None) => widened(fan.across.iter().copied()),
            (Content::Roots(roots), None) => {
                widened(roots.iter().flat_map(|root| root.points.iter().map(|p| p.0)))
            }
            (Content::Bars(bars), None) => widened(bars.iter().flat_map(|bar| [bar[0], bar[1]])),
            (Content::Cells { columns, .. }, None) => edge(columns),
        }
    }

    fn up_range(&self) -> (f64, f64) {
        match &self.content {
            Content::Curves(curves) => {
                let range = || widened(curves.iter().flat_map(|curve| curve.points.iter().map(|p| p.1)));
                match self.up.1 {
                    Scale::Linear | Scale::SignedDecades(_) => range(),
                    Scale::Angles => ANGLES,
                    Scale::Decades => {
                        let (low, high) = range();
                        (low.floor(), high.ceil().max(low.floor() + 1.0))
                    }
                }
            }
            Content::Fan(fan) => widened(fan.values()),
            Content::Roots(roots) => widened(roots.iter().flat_map(|root| root.points.iter().map(|p| p.1))),
            Content::Bars(bars) => {
                (0.0, 1.05 * bars.iter().fold(f64::MIN_POSITIVE, |most, bar| most.max(bar[2])))
            }
            Content::Cells { rows, .. } => {
                let turned = Panel {
                    content: Content::Cells { columns: rows.clone(), rows: Vec::new(), values: Vec::new() },
                    ..self.clone()
                };
                Panel { span: None, ..turned }.across_range()
            }
        }
    }

    /// The vertical range of the panel, as the labels of its ends.
    pub(super) fn values_in_words(&self) -> (String, String) {
        let (low, high) = self.up_range();
        (label(low, self.up.1), label(high, self.up.1))
    }

    /// The horizontal range of the panel, as the labels of its ends.
    pub(super) fn span_in_words(&self) -> (String, String) {
        let (low, high) = self.across_range();
        (label(low, self.across.1), label(high, self.across.1))
    }

    /// The width that the numbers beside the vertical axis need.
    pub(super) fn margin(&self, height: f64, size: f64) -> f64 {
        let axis = Axis::new(self.up_range(), (height, 0.0));
        let labels = axis.labels(self.up.1, count(height, 38.0));
        let widest = labels.iter().map(|(_, label)| width_of(label, size)).fold(0.0, f64::max);
        (widest + 12.0).max(36.0)
    }

    /// Draws the panel on axes around `frame`, with texts of this size and curves of at most `most` points.
    pub(super) fn draw(&self, drawing: &mut Drawing, frame: Frame, size: f64, most: usize) {
        let frame = match self.content {
            Content::Cells { .. } => Frame { right: frame.right - LEGEND, ..frame },
            Content::Curves(_) | Content::Fan(_) | Content::Roots(_) | Content::Bars(_) => frame,
        };
        let (across, up) = frame.axes(self);
        // Grid lines are drawn over areas.
        match &self.content {
            Content::Cells { columns, rows, values } => {
                cells(drawing, (&across, &up), (columns, rows, values), size, frame);
            }
            Content::Fan(fan) => fan.shade(drawing, (&across, &up), most),
            Content::Curves(_) | Content::Roots(_) | Content::Bars(_) => {}
        }
        self.mesh(drawing, frame, (&across, &up), size);
        // Bars are wide enough to hide event lines; curves are drawn over them.
        let is_behind = !matches!(self.content, Content::Bars(_));
        if is_behind {
            self.mark(drawing, frame, &across);
        }
        match &self.content {
            Content::Curves(curves) => {
                for (i, curve) in curves.iter().enumerate() {
                    draw_curve(drawing, curve, (&across, &up), Ink::Curve(i), most);
                }
            }
            Content::Fan(fan) => draw_curve(drawing, &fan.middle, (&across, &up), Ink::Curve(0), most),
            Content::Roots(roots) => {
                axes_through_zero(drawing, frame, (&across, &up));
                for (i, root) in roots.iter().enumerate() {
                    root.draw(drawing, (&across, &up), Ink::Curve(i), most);
                }
            }
            Content::Bars(bars) => {
                for &[from, to, height] in bars.iter().filter(|bar| bar[2] > 0.0) {
                    let (left, right) = (across.place(from) + 0.5, across.place(to) - 0.5);
                    drawing.area(
                        [left, up.place(height)],
                        [right.max(left + 0.5), frame.bottom],
                        Ink::Curve(0),
                    );
                }
            }
            Content::Cells { .. } => {}
        }
        if !is_behind {
            self.mark(drawing, frame, &across);
        }
        drawing.line(
            vec![[frame.left, frame.top], [frame.left, frame.bottom], [frame.right, frame.bottom]],
            Ink::Axis,
        );
    }

    fn mark(&self, drawing: &mut Drawing, frame: Frame, across: &Axis) {
        let marked = self.events.iter().filter(|&&t| (across.low..=across.high).contains(&t));
        for &event in marked.take(MOST_EVENTS) {
            let x = across.place(event);
            drawing.line(vec![[x, frame.top], [x, frame.bottom]], Ink::Event);
        }
    }

    /// Draws numbers beside the axes, and grid lines at these numbers.
    fn mesh(&self, drawing: &mut Drawing, frame: Frame, (across, up): (&Axis, &Axis), size: f64) {
        let is_open = !matches!(self.content, Content::Cells { .. });
        for (value, label) in up.labels(self.up.1, count(frame.bottom - frame.top, 38.0)) {
            let y = up.place(value);
            if is_open {
                drawing.line(vec![[frame.left, y], [frame.right, y]], Ink::Grid);
            }
            drawing.text([frame.left - 6.0, y + 0.35 * size], Anchor::End, size, Ink::Soft, label);
        }
        for (value, label) in across.labels(self.across.1, count(frame.right - frame.left, 75.0)) {
            let x = across.place(value);
            if is_open {
                drawing.line(vec![[x, frame.top], [x, frame.bottom]], Ink::Grid);
            }
            drawing.text([x, frame.bottom + 1.35 * size], Anchor::Middle, size, Ink::Soft, label);
        }
        let below = [frame.right, frame.bottom + 2.6 * size];
        drawing.text(below, Anchor::End, size, Ink::Soft, self.across.0.clone());
        if !self.up.0.is_empty() {
            let above = [frame.left - 6.0, frame.top - 0.6 * size];
            drawing.text(above, Anchor::Start, size, Ink::Soft, self.up.0.clone());
        }
    }
}

/// The range from −π to π, slightly widened.
const ANGLES: (f64, f64) = (-1.03 * std::f64::consts::PI, 1.03 * std::f64::consts::PI);

/// The number of labels that fit along a length if each takes up the length `each`; at least two.
fn count(length: f64, each: f64) -> usize {
    ((length / each) as usize).max(2)
}

/// Draws the real and the imaginary axis.
fn axes_through_zero(drawing: &mut Drawing, frame: Frame, (across, up): (&Axis, &Axis)) {
    let is_within = |axis: &Axis| (axis.low..=axis.high).contains(&0.0);
    if is_within(across) {
        let x = across.place(0.0);
        drawing.line(vec![[x, frame.top], [x, frame.bottom]], Ink::Soft);
    }
    if is_within(up) {
        let y = up.place(0.0);
        drawing.line(vec![[frame.left, y], [frame.right, y]], Ink::Soft);
    }
}

/// Draws a curve, broken where it has no value.
fn draw_curve(drawing: &mut Drawing, curve: &Curve, (across, up): (&Axis, &Axis), ink: Ink, most: usize) {
    let placed: Vec<[f64; 2]> = curve.points.iter().map(|&(x, y)| [across.place(x), up.place(y)]).collect();
    let is_there = |p: &[f64; 2]| p[0].is_finite() && p[1].is_finite();
    let pieces = || placed.split(|p| !is_there(p)).filter(|piece| !piece.is_empty());
    if let (Some([[x, y]]), 1) = (pieces().next(), pieces().count()) {
        // A single point is drawn as a small cross.
        drawing.line(vec![[x - 2.0, *y], [x + 2.0, *y]], ink);
        drawing.line(vec![[*x, y - 2.0], [*x, y + 2.0]], ink);
    }
    pieces().filter(|piece| piece.len() > 1).for_each(|piece| drawing.line(simplified(piece, most), ink));
}

/// Draws cells, each in the colour of its value, and the colour scale.
fn cells(
    drawing: &mut Drawing,
    (across, up): (&Axis, &Axis),
    (columns, rows, values): (&[f64], &[f64], &[f64]),
    size: f64,
    frame: Frame,
) {
    let (low, high) = range(values.iter().copied()).unwrap_or((0.0, 1.0));
    let span = if high > low { high - low } else { 1.0 };
    let borders = |middles: &[f64], axis: &Axis| -> Vec<f64> {
        let between = middles.windows(2).map(|pair| axis.place(f64::midpoint(pair[0], pair[1])));
        std::iter::once(axis.place(axis.low)).chain(between).chain([axis.place(axis.high)]).collect()
    };
    let (x, y) = (borders(columns, across), borders(rows, up));
    for (i, column) in values.chunks(rows.len().max(1)).enumerate() {
        for (j, &value) in column.iter().enumerate().filter(|(_, value)| value.is_finite()) {
            drawing.area([x[i], y[j + 1]], [x[i + 1], y[j]], Ink::Mixed(colour((value - low) / span)));
        }
    }
    // A cell without a value stays blank.
    let scale = Axis::new((low, low + span), (frame.bottom, frame.top));
    let (left, right) = (frame.right + 18.0, frame.right + 34.0);
    const SHADES: usize = 64;
    let step = (frame.bottom - frame.top) / SHADES as f64;
    for k in 0..SHADES {
        let bottom = frame.bottom - k as f64 * step;
        let ink = Ink::Mixed(colour((k as f64 + 0.5) / SHADES as f64));
        drawing.area([left, bottom - step], [right, bottom], ink);
    }
    for (value, label) in scale.labels(Scale::Linear, count(frame.bottom - frame.top, 48.0)) {
        let y = scale.place(value);
        drawing.line(vec![[right, y], [right + 4.0, y]], Ink::Axis);
        drawing.text([right + 7.0, y + 0.35 * size], Anchor::Start, size, Ink::Soft, label);
    }
}

/// The colour that represents a value from 0 to 1.
fn colour(value: f64) -> [u8; 3] {
    let place = value.clamp(0.0, 1.0) * (COLOURS.len() - 1) as f64;
    let i = (place as usize).min(COLOURS.len() - 2);
    let part = place - i as f64;
    [0, 1, 2].map(|k| {
        let (a, b) = (f64::from(COLOURS[i][k]), f64::from(COLOURS[i + 1][k]));
        (a + part * (b - a)).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::drawing::Shape;

    const FRAME: Frame = Frame { left: 0.0, right: 100.0, top: 0.0, bottom: 100.0 };

    fn lines(panel: &Panel, ink: Ink) -> Vec<Vec<[f64; 2]>> {
        let mut drawing = Drawing::default();
        panel.draw(&mut drawing, FRAME, 10.0, 1000);
        let of = |shape: Shape| match shape {
            Shape::Line { points, ink: other } if other == ink => Some(points),
            _ => None,
        };
        drawing.shapes.into_iter().filter_map(of).collect()
    }

    #[test]
    fn a_gap_breaks_the_curve() {
        let points = vec![(0.0, 1.0), (1.0, 2.0), (2.0, f64::NAN), (3.0, 3.0), (4.0, 1.0)];
        let curve = Curve { name: "x".to_owned(), points };
        let panel = Panel { span: Some((0.0, 4.0)), ..Panel::over("t", "a", Scale::Linear, vec![curve]) };
        let drawn = lines(&panel, Ink::Curve(0));
        assert_eq!(drawn.iter().map(Vec::len).collect::<Vec<_>>(), [2, 2]);
        assert_eq!((drawn[0][0][0], drawn[1][1][0]), (0.0, 100.0));
    }

    #[test]
    fn circles_are_round() {
        let points =
            (0..=100).map(|i| f64::from(i) * 0.0628).map(|t| (3.0 * t.cos(), 7.0 + 3.0 * t.sin())).collect();
        let curve = Curve { name: "y over x".to_owned(), points };
        let panel = Panel { equal: true, ..Panel::over("x", "a", Scale::Linear, vec![curve]) };
        let wide = Frame { right: 300.0, ..FRAME };
        let (across, up) = wide.axes(&panel);
        assert!((across.per_point() - up.per_point()).abs() < 1e-15);
        assert!(across.place(3.0) < 300.0 && across.place(-3.0) > 0.0 && up.place(10.0) > 0.0);
    }

    #[test]
    fn cells_have_the_colours_of_their_values() {
        let content = Content::Cells {
            columns: vec![0.0, 1.0],
            rows: vec![0.0, 1.0],
            values: vec![0.0, 1.0, f64::NAN, 2.0],
        };
        let panel = Panel { content, ..Panel::over("a", "z", Scale::Linear, Vec::new()) };
        let mut drawing = Drawing::default();
        panel.draw(&mut drawing, Frame { right: 200.0, ..FRAME }, 10.0, 1000);
        let areas: Vec<_> = drawing
            .shapes
            .iter()
            .filter_map(|shape| match shape {
                Shape::Area { from, to, ink: Ink::Mixed(colour) } if to[0] <= 104.0 => {
                    Some((*from, *to, *colour))
                }
                _ => None,
            })
            .collect();
        // Three values of four, the first at the lower left.
        assert_eq!(areas.len(), 3);
        assert_eq!(areas[0], ([0.0, 50.0], [52.0, 100.0], COLOURS[0]));
        assert_eq!((areas[1].2, areas[2].2), (COLOURS[4], COLOURS[8]));
    }
}
