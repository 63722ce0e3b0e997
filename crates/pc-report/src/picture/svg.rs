//! Drawings as SVG, either on a page, in the colours of the page, or in a separate file.

use std::fmt::Write as _;

use crate::page::html::text;
use crate::picture::drawing::{Anchor, Drawing, GLASS, Ink, Shape};

/// The list of fonts from which a viewer chooses.
const FONT: &str = "DejaVu Sans, Verdana, sans-serif";

impl Drawing {
    /// The text of a separate file, with a white background.
    pub fn svg(&self) -> String {
        let Drawing { width, height, .. } = self;
        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
             font-family=\"{FONT}\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n"
        );
        separate(&mut svg, &self.shapes);
        svg + "</svg>\n"
    }

    /// The drawing as an element of a page, in the colours of the page, with a title and a description whose
    /// ids begin with `id`.
    pub(crate) fn inline(&self, id: &str, title: &str, description: &str) -> String {
        let Drawing { width, height, .. } = self;
        let mut svg = format!(
            "<svg viewBox=\"0 0 {width} {height}\" role=\"img\" aria-labelledby=\"{id}-t {id}-d\">\
             <title id=\"{id}-t\">{}</title><desc id=\"{id}-d\">{}</desc>\n",
            text(title),
            text(description)
        );
        on_page(&mut svg, &self.shapes);
        svg + "</svg>"
    }
}

/// Appends shapes to the text of a separate file.
fn separate(svg: &mut String, shapes: &[Shape]) {
    for shape in shapes {
        match shape {
            Shape::Line { points, ink } => {
                let dash = ink
                    .dash()
                    .map_or_else(String::new, |[dash, gap]| format!(" stroke-dasharray=\"{dash} {gap}\""));
                let (colour, width) = (hexadecimal(*ink), ink.width());
                let d = path(points, 2);
                put(
                    svg,
                    format_args!(
                        "<path d=\"{d}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\" \
                         stroke-linejoin=\"round\"{dash}/>\n"
                    ),
                );
            }
            Shape::Area { from, to, ink } => put(
                svg,
                format_args!(
                    "<rect x=\"{:.2}\" y=\"{:.2}\" width=\"{:.2}\" height=\"{:.2}\" fill=\"{}\"/>\n",
                    from[0],
                    from[1],
                    to[0] - from[0],
                    to[1] - from[1],
                    hexadecimal(*ink)
                ),
            ),
            Shape::Filled { corners, ink } => {
                put(
                    svg,
                    format_args!("<path d=\"{}Z\" fill=\"{}\"/>\n", path(corners, 2), hexadecimal(*ink)),
                );
            }
            Shape::Glass { corners, ink } => {
                put(
                    svg,
                    format_args!(
                        "<path d=\"{}Z\" fill=\"{}\" fill-opacity=\"{GLASS}\"/>\n",
                        path(corners, 2),
                        hexadecimal(*ink)
                    ),
                );
            }
            Shape::Titled { title, shapes } => {
                put(svg, format_args!("<g><title>{}</title>\n", text(title)));
                separate(svg, shapes);
                svg.push_str("</g>\n");
            }
            Shape::Text { at: [x, y], anchor, size, ink, text: words } => put(
                svg,
                format_args!(
                    "<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"{size}\" fill=\"{}\"{}>{}</text>\n",
                    hexadecimal(*ink),
                    placed(*anchor),
                    text(words)
                ),
            ),
        }
    }
}

/// Appends shapes to an element of a page.
fn on_page(svg: &mut String, shapes: &[Shape]) {
    for shape in shapes {
        match shape {
            Shape::Line { points, ink } => {
                put(svg, format_args!("<path class=\"{}\" d=\"{}\"/>\n", class(*ink), path(points, 1)));
            }
            Shape::Area { from, to, ink } => put(
                svg,
                format_args!(
                    "<path fill=\"{}\" d=\"M{:.1} {:.1}H{:.1}V{:.1}H{:.1}Z\"/>\n",
                    hexadecimal(*ink),
                    from[0],
                    from[1],
                    to[0],
                    to[1],
                    from[0]
                ),
            ),
            Shape::Filled { corners, ink } => {
                put(
                    svg,
                    format_args!("<path fill=\"{}\" d=\"{}Z\"/>\n", hexadecimal(*ink), path(corners, 1)),
                );
            }
            Shape::Glass { corners, ink } => {
                put(
                    svg,
                    format_args!(
                        "<path fill=\"{}\" fill-opacity=\"{GLASS}\" d=\"{}Z\"/>\n",
                        hexadecimal(*ink),
                        path(corners, 1)
                    ),
                );
            }
            Shape::Titled { title, shapes } => {
                put(svg, format_args!("<g><title>{}</title>\n", text(title)));
                on_page(svg, shapes);
                svg.push_str("</g>\n");
            }
            Shape::Text { at: [x, y], anchor, text: words, .. } => put(
                svg,
                format_args!("<text x=\"{x:.1}\" y=\"{y:.1}\"{}>{}</text>\n", placed(*anchor), text(words)),
            ),
        }
    }
}

fn class(ink: Ink) -> String {
    match ink {
        Ink::Text | Ink::Soft | Ink::Axis | Ink::Rod | Ink::Mixed(_) => "axis".to_owned(),
        Ink::Grid => "grid".to_owned(),
        Ink::Event => "event".to_owned(),
        Ink::Curve(i) => format!("curve s{}", i % Ink::CURVES),
    }
}

fn placed(anchor: Anchor) -> &'static str {
    match anchor {
        Anchor::Start => "",
        Anchor::Middle => " text-anchor=\"middle\"",
        Anchor::End => " text-anchor=\"end\"",
    }
}

fn hexadecimal(ink: Ink) -> String {
    let [red, green, blue] = ink.colour();
    format!("#{red:02x}{green:02x}{blue:02x}")
}

fn path(points: &[[f64; 2]], digits: usize) -> String {
    let mut path = String::new();
    for (i, [x, y]) in points.iter().enumerate() {
        put(&mut path, format_args!("{}{x:.digits$} {y:.digits$}", if i == 0 { "M" } else { "L" }));
    }
    path
}

/// Appends an element to the text of a picture.
pub(super) fn put(svg: &mut String, element: std::fmt::Arguments<'_>) {
    let _ = svg.write_fmt(element); // writing to a string cannot fail
}
