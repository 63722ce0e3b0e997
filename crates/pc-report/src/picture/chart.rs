//! Curves over time.

use std::borrow::Cow;
use std::fmt::Write as _;

use pc_print::short;

use crate::page::html::text;
use crate::picture::axes::{Axis, widened};

const WIDTH: f64 = 480.0;
const HEIGHT: f64 = 250.0;
const LEFT: f64 = 58.0;
const RIGHT: f64 = 12.0;
const TOP: f64 = 8.0;
const BOTTOM: f64 = 38.0;
/// Points of a curve: the least and the greatest of each pixel or so.
const MOST_POINTS: usize = 400;
/// Events that are marked.
const MOST_EVENTS: usize = 60;
/// Colours, told apart by colour-blind readers [Okabe, Ito 2008].
const COLOURS: usize = 8;

/// How values are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Scale {
    Linear,
    /// Values are decimal logarithms.
    Decades,
}

/// A curve with its values, one for each time.
#[derive(Clone, Debug)]
pub(crate) struct Curve<'a> {
    pub(crate) name: &'a str,
    pub(crate) values: Cow<'a, [f64]>,
}

/// Curves on common axes.
#[derive(Clone, Debug)]
pub(crate) struct Chart<'a> {
    title: &'static str,
    scale: Scale,
    curves: Vec<Curve<'a>>,
}

impl<'a> Chart<'a> {
    pub(crate) fn new(title: &'static str, scale: Scale, curves: Vec<Curve<'a>>) -> Chart<'a> {
        Chart { title, scale, curves }
    }

    /// The number of curves.
    pub(crate) fn len(&self) -> usize {
        self.curves.len()
    }

    /// The chart with a legend.
    pub(crate) fn figure(&self, times: &[f64], events: &[f64], id: &str) -> String {
        let (first, last) = (times.first().copied().unwrap_or(0.0), times.last().copied().unwrap_or(1.0));
        let span = if first == last { (first, first + 1.0) } else { (first.min(last), first.max(last)) };
        let t = Axis::new(span, (LEFT, WIDTH - RIGHT));
        let values = || self.curves.iter().flat_map(|curve| curve.values.iter().copied());
        let range = match self.scale {
            Scale::Linear => widened(values()),
            Scale::Decades => {
                let (low, high) = widened(values());
                (low.floor(), high.ceil().max(low.floor() + 1.0))
            }
        };
        let v = Axis::new(range, (HEIGHT - BOTTOM, TOP));
        let names: Vec<&str> = self.curves.iter().map(|curve| curve.name).collect();
        let described = format!(
            "{} over time from {} to {}: {}; values from {} to {}",
            self.title,
            short(span.0, 6),
            short(span.1, 6),
            names.join(", "),
            self.label(range.0),
            self.label(range.1)
        );
        let mut svg = format!(
            "<svg viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" aria-labelledby=\"{id}-t {id}-d\">\
             <title id=\"{id}-t\">{}</title><desc id=\"{id}-d\">{}</desc>\n",
            text(self.title),
            text(&described)
        );
        svg += &self.mesh(&t, &v);
        for &event in events.iter().filter(|t| (span.0..=span.1).contains(*t)).take(MOST_EVENTS) {
            let x = t.place(event);
            put(&mut svg, format_args!("<path class=\"event\" d=\"M{x:.1} {TOP}V{:.1}\"/>", HEIGHT - BOTTOM));
        }
        for (i, curve) in self.curves.iter().enumerate() {
            let path = path(times, &curve.values, &t, &v);
            put(&mut svg, format_args!("<path class=\"curve s{}\" d=\"{path}\"/>\n", i % COLOURS));
        }
        svg += "</svg>";
        let key = |(i, name): (usize, &&str)| {
            format!("<span class=\"key\"><i class=\"k{}\"></i>{}</span>", i % COLOURS, text(name))
        };
        let keys: String = names.iter().enumerate().map(key).collect();
        format!("<figure>{svg}<figcaption>{keys}</figcaption></figure>\n")
    }

    /// Axes, their numbers, and lines through them.
    fn mesh(&self, t: &Axis, v: &Axis) -> String {
        let mut svg = String::new();
        let (right, floor) = (WIDTH - RIGHT, HEIGHT - BOTTOM);
        for value in v.ticks(5).into_iter().filter(|v| self.scale == Scale::Linear || v.fract() == 0.0) {
            let y = v.place(value);
            put(&mut svg, format_args!("<path class=\"grid\" d=\"M{LEFT} {y:.1}H{right}\"/>"));
            let label = self.label(value);
            put(
                &mut svg,
                format_args!(
                    "<text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{label}</text>",
                    LEFT - 6.0,
                    y + 4.0
                ),
            );
        }
        for value in t.ticks(6) {
            let x = t.place(value);
            put(&mut svg, format_args!("<path class=\"grid\" d=\"M{x:.1} {TOP}V{floor}\"/>"));
            let label = short(value, 6);
            put(
                &mut svg,
                format_args!(
                    "<text x=\"{x:.1}\" y=\"{}\" text-anchor=\"middle\">{label}</text>",
                    floor + 17.0
                ),
            );
        }
        put(
            &mut svg,
            format_args!("<text x=\"{right}\" y=\"{}\" text-anchor=\"end\">t</text>", HEIGHT - 4.0),
        );
        put(&mut svg, format_args!("<path class=\"axis\" d=\"M{LEFT} {TOP}V{floor}H{right}\"/>\n"));
        svg
    }

    fn label(&self, value: f64) -> String {
        match self.scale {
            Scale::Linear => short(value, 4).replace('-', "−"),
            Scale::Decades => {
                let raised = |c: char| match c {
                    '-' => '⁻',
                    c => c.to_digit(10).map_or(c, |digit| {
                        ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][digit as usize]
                    }),
                };
                format!("10{}", format!("{value:.0}").chars().map(raised).collect::<String>())
            }
        }
    }
}

/// Adds to a picture.
pub(crate) fn put(svg: &mut String, element: std::fmt::Arguments<'_>) {
    let _ = svg.write_fmt(element); // writing to a string cannot fail
}

/// The path of a curve, broken where it has no value.
fn path(times: &[f64], values: &[f64], t: &Axis, v: &Axis) -> String {
    let mut path = String::new();
    let mut drawing = false;
    for j in thinned(values) {
        let (x, y) = (t.place(times[j]), v.place(values[j]));
        if !(x.is_finite() && y.is_finite()) {
            drawing = false;
            continue;
        }
        put(&mut path, format_args!("{}{x:.1} {y:.1}", if drawing { "L" } else { "M" }));
        drawing = true;
    }
    path
}

/// The numbers of the points that are drawn: where there are more than can be seen, the least and the greatest of each
/// stretch, in their order, and the ends.
fn thinned(values: &[f64]) -> Vec<usize> {
    if values.len() <= MOST_POINTS {
        return (0..values.len()).collect();
    }
    let stretch = values.len().div_ceil(MOST_POINTS / 2);
    let mut kept = vec![0];
    for start in (0..values.len()).step_by(stretch) {
        let here = || start..(start + stretch).min(values.len());
        let by_value = |a: &usize, b: &usize| values[*a].total_cmp(&values[*b]);
        let ends = (here().min_by(by_value), here().max_by(by_value));
        if let (Some(low), Some(high)) = ends {
            kept.extend([low.min(high), low.max(high)]);
        }
    }
    kept.push(values.len() - 1);
    kept.dedup();
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_keeps_ends_and_extremes() {
        let values: Vec<f64> = (0..100_000).map(|i| f64::from(i % 777)).collect();
        let kept = thinned(&values);
        assert!(kept.len() <= MOST_POINTS + 4 && kept.is_sorted());
        assert!(kept.iter().any(|&j| values[j] == 776.0) && kept.iter().any(|&j| values[j] == 0.0));
        assert_eq!((kept[0], kept[kept.len() - 1]), (0, 99_999));
        assert_eq!(thinned(&values[..3]), [0, 1, 2]);
    }

    #[test]
    fn a_gap_breaks_the_curve() {
        let axis = Axis::new((0.0, 4.0), (0.0, 4.0));
        let drawn = path(&[0.0, 1.0, 2.0, 3.0], &[1.0, 2.0, f64::NAN, 3.0], &axis, &axis);
        assert_eq!(drawn, "M0.0 1.0L1.0 2.0M3.0 3.0");
    }
}
