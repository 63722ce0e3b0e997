//! Drawings as bitmaps.

use crate::picture::{Drawing, GLASS, Ink, Shape};
use tiny_skia::{
    FillRule, LineCap, LineJoin, Paint, PathBuilder, Pixmap, Rect, Stroke, StrokeDash, Transform,
};
use ttf_parser::OutlineBuilder;

use crate::files::error::PictureError;
use crate::files::glyphs::Glyphs;

/// The number of pixels per point.
const SCALE: f32 = 2.0;

/// The drawing as a bitmap on white.
///
/// # Errors
/// [`PictureError`]
pub fn png(drawing: &Drawing) -> Result<Vec<u8>, PictureError> {
    encoded(&painted(drawing, SCALE, &Glyphs::new()?)?)
}

/// The pixels, `magnification` of them per point.
///
/// # Errors
/// [`PictureError`]
pub(super) fn painted(
    drawing: &Drawing,
    magnification: f32,
    glyphs: &Glyphs,
) -> Result<Pixmap, PictureError> {
    let size = |length: f64| (length * f64::from(magnification)).ceil() as u32;
    let (width, height) = (size(drawing.width), size(drawing.height));
    let mut pixels = Pixmap::new(width, height).ok_or(PictureError::Size { width, height })?;
    pixels.fill(tiny_skia::Color::WHITE);
    let scale = Transform::from_scale(magnification, magnification);
    paint_all(&mut pixels, &drawing.shapes, scale, glyphs);
    Ok(pixels)
}

fn paint_all(pixels: &mut Pixmap, shapes: &[Shape], scale: Transform, glyphs: &Glyphs) {
    for shape in shapes {
        match shape {
            Shape::Line { points, ink } => {
                let Some(path) = path(points).finish() else { continue };
                pixels.stroke_path(&path, &paint(*ink), &stroke(*ink), scale, None);
            }
            Shape::Area { from, to, ink } => {
                let rect = Rect::from_ltrb(from[0] as f32, from[1] as f32, to[0] as f32, to[1] as f32);
                // With antialiasing, the background would show between adjacent areas.
                let paint = Paint { anti_alias: false, ..paint(*ink) };
                if let Some(rect) = rect {
                    pixels.fill_rect(rect, &paint, scale, None);
                }
            }
            Shape::Filled { corners, ink } => fill(pixels, corners, &paint(*ink), scale),
            Shape::Glass { corners, ink } => fill(pixels, corners, &glass(*ink), scale),
            Shape::Titled { shapes, .. } => paint_all(pixels, shapes, scale, glyphs),
            Shape::Text { at, anchor, size, ink, text } => {
                let unit = size / glyphs.units();
                for glyph in glyphs.placed(text, *anchor) {
                    let mut outline = Outline(PathBuilder::new());
                    glyphs.outline(glyph.glyph, &mut outline);
                    let Some(path) = outline.0.finish() else { continue };
                    let place = Transform::from_row(
                        unit as f32,
                        0.0,
                        0.0,
                        -unit as f32,
                        (at[0] + unit * glyph.x) as f32,
                        at[1] as f32,
                    );
                    let place = place.post_concat(scale);
                    pixels.fill_path(&path, &paint(*ink), FillRule::Winding, place, None);
                }
            }
        }
    }
}

fn fill(pixels: &mut Pixmap, corners: &[[f64; 2]], paint: &Paint<'_>, scale: Transform) {
    let mut path = path(corners);
    path.close();
    if let Some(path) = path.finish() {
        pixels.fill_path(&path, paint, FillRule::Winding, scale, None);
    }
}

fn path(points: &[[f64; 2]]) -> PathBuilder {
    let mut path = PathBuilder::new();
    for (i, &[x, y]) in points.iter().enumerate() {
        let (x, y) = (x as f32, y as f32);
        if i == 0 { path.move_to(x, y) } else { path.line_to(x, y) }
    }
    path
}

fn glass(ink: Ink) -> Paint<'static> {
    let [red, green, blue] = ink.colour();
    let mut paint = paint(ink);
    paint.set_color_rgba8(red, green, blue, (255.0 * GLASS).round() as u8);
    paint
}

fn paint(ink: Ink) -> Paint<'static> {
    let [red, green, blue] = ink.colour();
    let mut paint = Paint::default();
    paint.set_color_rgba8(red, green, blue, 255);
    paint.anti_alias = true;
    paint
}

fn stroke(ink: Ink) -> Stroke {
    let dash = ink.dash().and_then(|[dash, gap]| StrokeDash::new(vec![dash as f32, gap as f32], 0.0));
    Stroke {
        width: ink.width() as f32,
        line_cap: LineCap::Butt,
        line_join: LineJoin::Round,
        dash,
        ..Stroke::default()
    }
}

/// The red, green and blue of each pixel.
pub(super) fn opaque(pixels: &Pixmap) -> Vec<u8> {
    pixels.data().chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect()
}

fn encoded(pixels: &Pixmap) -> Result<Vec<u8>, PictureError> {
    let encoding = |error: png::EncodingError| PictureError::Encode { message: error.to_string() };
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, pixels.width(), pixels.height());
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header().map_err(encoding)?;
    writer.write_image_data(&opaque(pixels)).map_err(encoding)?;
    writer.finish().map_err(encoding)?;
    Ok(bytes)
}

struct Outline(PathBuilder);

impl OutlineBuilder for Outline {
    fn move_to(&mut self, x: f32, y: f32) {
        self.0.move_to(x, y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.0.line_to(x, y);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.0.quad_to(x1, y1, x, y);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.0.cubic_to(x1, y1, x2, y2, x, y);
    }

    fn close(&mut self) {
        self.0.close();
    }
}
