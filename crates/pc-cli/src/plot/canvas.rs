//! Drawing a picture with plotters.

use std::error::Error;
use std::sync::OnceLock;

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{FontStyle, register_font};

use crate::plot::error::PlotError;
use crate::plot::picture::{Panel, Picture, Scale};

/// Size in points: of the picture, and of a panel's height.
const WIDTH: u32 = 960;
const PANEL: u32 = 250;
const TITLE: u32 = 44;
const TIME_LABEL: u32 = 18;
/// Width left for the names of the curves.
const LEGEND: u32 = 112;
/// More curves than this are not named.
const MOST_NAMES: usize = 12;

/// Coordinates of the library are integers: an SVG is drawn larger by this and says that it is smaller.
const SVG_SCALE: u32 = 10;
/// A bitmap is drawn larger by `PNG_SCALE·SMOOTHING` and averaged over squares of side `SMOOTHING`.
const PNG_SCALE: u32 = 2;
const SMOOTHING: u32 = 2;

/// The first is looked up in the table of registered fonts as written; an SVG viewer reads it as a list.
const FONT: &str = "DejaVu Sans, sans-serif";
const INK: RGBColor = RGBColor(40, 40, 40);
const FAINT: RGBColor = RGBColor(228, 228, 228);
/// Colours that colour-blind readers tell apart [Okabe, Ito 2008].
const COLOURS: [RGBColor; 8] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(110, 90, 60),
    RGBColor(120, 120, 120),
];

impl Picture {
    /// As vector graphics.
    ///
    /// # Errors
    /// [`PlotError`].
    pub fn svg(&self) -> Result<String, PlotError> {
        svg(self)
    }

    /// As a bitmap.
    ///
    /// # Errors
    /// [`PlotError`].
    pub fn png(&self) -> Result<Vec<u8>, PlotError> {
        png(self)
    }
}

fn svg(picture: &Picture) -> Result<String, PlotError> {
    register()?;
    let (width, height) = size(picture);
    let mut svg = String::new();
    draw_on(SVGBackend::with_string(&mut svg, (width * SVG_SCALE, height * SVG_SCALE)), picture, SVG_SCALE)?;
    let drawn = format!("width=\"{}\" height=\"{}\"", width * SVG_SCALE, height * SVG_SCALE);
    Ok(svg.replacen(&drawn, &format!("width=\"{width}\" height=\"{height}\""), 1))
}

fn png(picture: &Picture) -> Result<Vec<u8>, PlotError> {
    register()?;
    let (width, height) = size(picture);
    let (width, height) = (width * PNG_SCALE, height * PNG_SCALE);
    let large = (width * SMOOTHING, height * SMOOTHING);
    let mut pixels = vec![255; (large.0 * large.1 * 3) as usize];
    draw_on(BitMapBackend::with_buffer(&mut pixels, large), picture, PNG_SCALE * SMOOTHING)?;

    let encoding = |error: png::EncodingError| PlotError::Encode { message: error.to_string() };
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header().map_err(encoding)?;
    writer.write_image_data(&averaged(&pixels, width as usize, height as usize)).map_err(encoding)?;
    writer.finish().map_err(encoding)?;
    Ok(bytes)
}

/// The bitmap of `width` × `height` whose pixels are the means of squares.
fn averaged(large: &[u8], width: usize, height: usize) -> Vec<u8> {
    let side = SMOOTHING as usize;
    let mut small = Vec::with_capacity(width * height * 3);
    for (row, column) in (0..height).flat_map(|row| (0..width).map(move |column| (row, column))) {
        for channel in 0..3 {
            let square = (0..side).flat_map(|i| (0..side).map(move |j| (row * side + i, column * side + j)));
            let sum: u32 = square.map(|(i, j)| u32::from(large[(i * width * side + j) * 3 + channel])).sum();
            small.push((sum / (SMOOTHING * SMOOTHING)) as u8);
        }
    }
    small
}

/// Registers the built-in font once: the program depends on no font of the system.
fn register() -> Result<(), PlotError> {
    static REGISTERED: OnceLock<bool> = OnceLock::new();
    let done =
        *REGISTERED.get_or_init(|| register_font(FONT, FontStyle::Normal, dejavu::sans::regular()).is_ok());
    if done { Ok(()) } else { Err(PlotError::Font) }
}

fn size(picture: &Picture) -> (u32, u32) {
    (WIDTH, TITLE + TIME_LABEL + PANEL * picture.panels.len().max(1) as u32)
}

fn draw_on<B: DrawingBackend>(backend: B, picture: &Picture, scale: u32) -> Result<(), PlotError> {
    let root = backend.into_drawing_area();
    let drawn = draw(&root, picture, scale).and_then(|()| root.present());
    drawn.map_err(|error| PlotError::Draw { message: message(&error) })
}

fn message<E: Error + Send + Sync>(error: &DrawingAreaErrorKind<E>) -> String {
    error.to_string()
}

type Drawn<B> = Result<(), DrawingAreaErrorKind<<B as DrawingBackend>::ErrorType>>;

fn draw<B: DrawingBackend>(root: &DrawingArea<B, Shift>, picture: &Picture, scale: u32) -> Drawn<B> {
    root.fill(&WHITE)?;
    let at = |x: u32, y: u32| ((x * scale) as i32, (y * scale) as i32);
    let centred = font(17, scale).pos(Pos::new(HPos::Center, VPos::Center));
    root.draw(&Text::new(picture.title.as_str(), at((WIDTH - LEGEND) / 2 + 30, TITLE / 2), centred))?;
    let (_, below) = root.split_vertically(TITLE * scale);
    let mut rest = below;
    for (i, panel) in picture.panels.iter().enumerate() {
        let last = i + 1 == picture.panels.len();
        let height = PANEL + if last { TIME_LABEL } else { 0 };
        let (area, under) = rest.split_vertically(height * scale);
        draw_panel(&area, panel, picture.time, last, scale)?;
        rest = under;
    }
    Ok(())
}

fn font<'a>(points: u32, scale: u32) -> TextStyle<'a> {
    (FONT, points * scale).into_font().color(&INK)
}

fn draw_panel<B: DrawingBackend>(
    area: &DrawingArea<B, Shift>,
    panel: &Panel,
    time: (f64, f64),
    last: bool,
    scale: u32,
) -> Drawn<B> {
    let (left, right) = area.split_horizontally((WIDTH - LEGEND) * scale);
    let (low, high) = range(panel);
    let mut chart = ChartBuilder::on(&left)
        .margin(8 * scale)
        .x_label_area_size(if last { 24 + TIME_LABEL } else { 24 } * scale)
        .y_label_area_size(66 * scale)
        .build_cartesian_2d(time.0..time.1, low..high)?;
    let value: &dyn Fn(&f64) -> String = match panel.scale {
        Scale::Linear => &|value| crate::report::text::short(*value, 6),
        Scale::Decades => &|value| decade(*value),
    };
    chart
        .configure_mesh()
        .x_desc(if last { "t" } else { "" })
        .y_desc(panel.label)
        .axis_desc_style(font(13, scale))
        .label_style(font(11, scale))
        .x_label_formatter(&|t| crate::report::text::short(*t, 6))
        .y_label_formatter(value)
        .y_labels(7)
        .x_labels(11)
        .axis_style(INK.stroke_width(scale))
        .bold_line_style(FAINT.stroke_width(scale))
        .light_line_style(TRANSPARENT)
        .set_all_tick_mark_size(4 * scale)
        .draw()?;
    for (i, curve) in panel.curves.iter().enumerate() {
        chart.draw_series(LineSeries::new(curve.points.iter().copied(), line(i, scale)))?;
    }
    draw_names(&right, panel, scale)
}

fn line(i: usize, scale: u32) -> ShapeStyle {
    COLOURS[i % COLOURS.len()].stroke_width(scale + scale / 2)
}

fn draw_names<B: DrawingBackend>(area: &DrawingArea<B, Shift>, panel: &Panel, scale: u32) -> Drawn<B> {
    const STEP: u32 = 18;
    let at = |x: u32, y: u32| ((x * scale) as i32, (y * scale) as i32);
    let style = font(13, scale).pos(Pos::new(HPos::Left, VPos::Center));
    for (i, curve) in panel.curves.iter().take(MOST_NAMES).enumerate() {
        let y = 18 + STEP * i as u32;
        area.draw(&PathElement::new([at(4, y), at(24, y)], line(i, scale)))?;
        area.draw(&Text::new(curve.name.clone(), at(30, y), style.clone()))?;
    }
    if panel.curves.len() > MOST_NAMES {
        let more = format!("and {} more", panel.curves.len() - MOST_NAMES);
        area.draw(&Text::new(more, at(4, 18 + STEP * MOST_NAMES as u32), style))?;
    }
    Ok(())
}

/// The range of values, a little widened.
fn range(panel: &Panel) -> (f64, f64) {
    let values = || panel.curves.iter().flat_map(|curve| &curve.points).map(|&(_, value)| value);
    let (low, high) = values().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
    if low > high {
        return (0.0, 1.0);
    }
    match panel.scale {
        Scale::Decades => (low.floor(), (high.ceil()).max(low.floor() + 1.0)),
        Scale::Linear => {
            let margin = 0.05 * (high - low);
            let margin =
                if margin > 1e-9 * low.abs().max(high.abs()) { margin } else { 0.1 * high.abs().max(1.0) };
            (low - margin, high + margin)
        }
    }
}

/// 10 to a whole power.
fn decade(exponent: f64) -> String {
    if exponent.fract() != 0.0 {
        return String::new();
    }
    let raised = |c: char| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '0' | '4'..='9' => char::from_u32('⁰' as u32 + c.to_digit(10).unwrap_or(0)).unwrap_or(c),
        other => other,
    };
    format!("10{}", format!("{exponent:.0}").chars().map(raised).collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_ten_are_raised() {
        assert_eq!(decade(-12.0), "10⁻¹²");
        assert_eq!(decade(0.0), "10⁰");
        assert_eq!(decade(4.5), "");
    }
}
