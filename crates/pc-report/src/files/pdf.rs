//! Drawings as a page of PDF [ISO 32000-1], with text that can be searched and copied.
//!
//! Characters are written as procedures of fonts of type 3 (9.6.5), so that the file contains only the
//! characters that are used; a table gives the Unicode of each (9.10.3). The content is compressed with
//! deflate (7.4.4).

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::Write as _;

use crate::picture::{Drawing, GLASS, Ink, Shape};
use flate2::Compression;
use flate2::write::ZlibEncoder;
use ttf_parser::{GlyphId, OutlineBuilder};

use crate::files::error::PictureError;
use crate::files::glyphs::Glyphs;

/// The largest number of characters of a font: their codes are single bytes other than 0.
const CODES: usize = 255;

/// The page.
///
/// # Errors
/// [`PictureError`]
pub fn pdf(drawing: &Drawing) -> Result<Vec<u8>, PictureError> {
    let glyphs = Glyphs::new()?;
    let mut fonts = Fonts { glyphs: &glyphs, known: BTreeMap::new(), characters: Vec::new() };
    let content = content(drawing, &mut fonts);
    let mut file = File { bytes: b"%PDF-1.4\n%\xc3\xa4\xc3\xb6\n".to_vec(), places: vec![0; 4] };
    let resources = fonts.write(&mut file)?;
    let Drawing { width, height, .. } = drawing;
    file.object(1, b"<< /Type /Catalog /Pages 2 0 R >>");
    file.object(2, b"<< /Type /Pages /Kids [3 0 R] /Count 1 >>");
    let stream = file.stream(content.as_bytes())?;
    let page = format!(
        "<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {width} {height}] /Contents {stream} 0 R /Resources << \
         /ExtGState << /Glass << /ca {GLASS} >> /Opaque << /ca 1 >> >> {resources} >> >>"
    );
    file.object(3, page.as_bytes());
    Ok(file.end())
}

/// The content stream of the page, with y pointing down.
fn content(drawing: &Drawing, fonts: &mut Fonts<'_>) -> String {
    let mut content = format!("1 0 0 -1 0 {} cm 1 j\n", drawing.height);
    add_all(&mut content, &drawing.shapes, fonts);
    content
}

fn add_all(content: &mut String, shapes: &[Shape], fonts: &mut Fonts<'_>) {
    for shape in shapes {
        match shape {
            Shape::Line { points, ink } => {
                let dash = ink.dash().map_or("[]".to_owned(), |[dash, gap]| format!("[{dash} {gap}]"));
                add(content, format_args!("{} RG {} w {dash} 0 d\n", colour(*ink), ink.width()));
                for (i, [x, y]) in points.iter().enumerate() {
                    add(content, format_args!("{x:.2} {y:.2} {}\n", if i == 0 { "m" } else { "l" }));
                }
                content.push_str("S\n");
            }
            Shape::Area { from, to, ink } => add(
                content,
                format_args!(
                    "{} rg {:.2} {:.2} {:.2} {:.2} re f\n",
                    colour(*ink),
                    from[0],
                    from[1],
                    to[0] - from[0],
                    to[1] - from[1]
                ),
            ),
            Shape::Filled { corners, ink } => fill(content, corners, *ink),
            Shape::Glass { corners, ink } => {
                content.push_str("/Glass gs\n");
                fill(content, corners, *ink);
                content.push_str("/Opaque gs\n");
            }
            Shape::Titled { shapes, .. } => add_all(content, shapes, fonts),
            Shape::Text { at, anchor, size, ink, text } => {
                let placed = fonts.glyphs.placed(text, *anchor);
                let start = placed.first().map_or(0.0, |first| first.x) * size / fonts.glyphs.units();
                add(
                    content,
                    format_args!("BT {} rg 1 0 0 -1 {:.2} {:.2} Tm\n", colour(*ink), at[0] + start, at[1]),
                );
                let codes: Vec<(usize, usize)> =
                    placed.iter().map(|glyph| fonts.code(glyph.glyph, glyph.character)).collect();
                for run in codes.chunk_by(|a, b| a.0 == b.0) {
                    let shown: String = run.iter().map(|(_, code)| format!("{code:02x}")).collect();
                    add(content, format_args!("/F{} {size} Tf <{shown}> Tj\n", run[0].0));
                }
                content.push_str("ET\n");
            }
        }
    }
}

fn fill(content: &mut String, corners: &[[f64; 2]], ink: Ink) {
    add(content, format_args!("{} rg\n", colour(ink)));
    for (i, [x, y]) in corners.iter().enumerate() {
        add(content, format_args!("{x:.2} {y:.2} {}\n", if i == 0 { "m" } else { "l" }));
    }
    content.push_str("f\n");
}

fn colour(ink: Ink) -> String {
    ink.colour().map(|part| format!("{:.3}", f64::from(part) / 255.0)).join(" ")
}

fn add(content: &mut String, more: std::fmt::Arguments<'_>) {
    let _ = content.write_fmt(more); // writing to a string cannot fail
}

/// The characters that are used, in order of first use.
struct Fonts<'g> {
    glyphs: &'g Glyphs,
    known: BTreeMap<char, usize>,
    characters: Vec<(GlyphId, char)>,
}

impl Fonts<'_> {
    /// The number of the font that contains a character, and the code of the character in that font.
    fn code(&mut self, glyph: GlyphId, character: char) -> (usize, usize) {
        let next = self.characters.len();
        let place = *self.known.entry(character).or_insert(next);
        if place == next {
            self.characters.push((glyph, character));
        }
        (place / CODES, place % CODES + 1)
    }

    /// Writes the fonts, and returns the resources of the page.
    fn write(&self, file: &mut File) -> Result<String, PictureError> {
        let mut resources = "/Font <<".to_owned();
        for (number, characters) in self.characters.chunks(CODES).enumerate() {
            let (mut procedures, mut names, mut widths) = (String::new(), String::new(), String::new());
            let mut meanings = String::new();
            for (code, &(glyph, character)) in (1..).zip(characters) {
                let advance = self.glyphs.advance(glyph);
                let mut outline = Outline { path: format!("{advance} 0 d0\n"), at: [0.0; 2] };
                self.glyphs.outline(glyph, &mut outline);
                outline.path += "f\n";
                let procedure = file.stream(outline.path.as_bytes())?;
                add(&mut procedures, format_args!(" /g{code} {procedure} 0 R"));
                add(&mut names, format_args!(" /g{code}"));
                add(&mut widths, format_args!(" {advance}"));
                let mut units = [0; 2];
                let utf16: String =
                    character.encode_utf16(&mut units).iter().map(|unit| format!("{unit:04x}")).collect();
                add(&mut meanings, format_args!("<{code:02x}> <{utf16}>\n"));
            }
            let table = format!(
                "/CIDInit /ProcSet findresource begin 12 dict begin begincmap /CMapName /Meanings def /CMapType 2 def\n\
                 1 begincodespacerange <00> <ff> endcodespacerange\n{}endcmap end end\n",
                blocks(&meanings)
            );
            let table = file.stream(table.as_bytes())?;
            let (unit, last) = (1.0 / self.glyphs.units(), characters.len());
            let font = file.next();
            file.object(
                font,
                format!(
                    "<< /Type /Font /Subtype /Type3 /FontBBox [0 0 0 0] /FontMatrix [{unit} 0 0 {unit} 0 0] /CharProcs <<{procedures} \
                     >> /Encoding << /Type /Encoding /Differences [1{names}] >> /FirstChar 1 /LastChar {last} /Widths [{widths} ] \
                     /ToUnicode {table} 0 R /Resources << >> >>"
                )
                .as_bytes(),
            );
            add(&mut resources, format_args!(" /F{number} {font} 0 R"));
        }
        Ok(resources + " >>")
    }
}

/// The lines of a table, divided into blocks of at most 100.
fn blocks(lines: &str) -> String {
    let lines: Vec<&str> = lines.lines().collect();
    let block = |some: &[&str]| format!("{} beginbfchar\n{}\nendbfchar\n", some.len(), some.join("\n"));
    lines.chunks(100).map(block).collect()
}

/// The outline of a character as a path; quadratic curves are written as cubic ones.
struct Outline {
    path: String,
    at: [f32; 2],
}

impl Outline {
    fn go(&mut self, to: [f32; 2], step: std::fmt::Arguments<'_>) {
        add(&mut self.path, step);
        self.at = to;
    }
}

impl OutlineBuilder for Outline {
    fn move_to(&mut self, x: f32, y: f32) {
        self.go([x, y], format_args!("{x} {y} m\n"));
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.go([x, y], format_args!("{x} {y} l\n"));
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let between = |a: f32, b: f32| a + 2.0 / 3.0 * (b - a);
        let [x0, y0] = self.at;
        self.curve_to(between(x0, x1), between(y0, y1), between(x, x1), between(y, y1), x, y);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.go([x, y], format_args!("{x1:.1} {y1:.1} {x2:.1} {y2:.1} {x} {y} c\n"));
    }

    fn close(&mut self) {
        self.path += "h\n";
    }
}

/// The file as written so far, with the offset of each object; number 0 is not used, and 1 to 3 are for the
/// page.
struct File {
    bytes: Vec<u8>,
    places: Vec<usize>,
}

impl File {
    fn next(&mut self) -> usize {
        self.places.push(0);
        self.places.len() - 1
    }

    fn object(&mut self, number: usize, body: &[u8]) {
        self.places[number] = self.bytes.len();
        self.bytes.extend(format!("{number} 0 obj\n").as_bytes());
        self.bytes.extend(body);
        self.bytes.extend(b"\nendobj\n");
    }

    fn stream(&mut self, body: &[u8]) -> Result<usize, PictureError> {
        let encoding = |error: std::io::Error| PictureError::Encode { message: error.to_string() };
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
        encoder.write_all(body).map_err(encoding)?;
        let packed = encoder.finish().map_err(encoding)?;
        let head = format!("<< /Filter /FlateDecode /Length {} >>\nstream\n", packed.len());
        let number = self.next();
        self.object(number, &[head.as_bytes(), &packed, b"\nendstream"].concat());
        Ok(number)
    }

    /// The complete file, ending with its table of offsets.
    fn end(mut self) -> Vec<u8> {
        let (start, count) = (self.bytes.len(), self.places.len());
        let entries: String =
            self.places[1..].iter().map(|place| format!("{place:010} 00000 n \n")).collect();
        let table = format!(
            "xref\n0 {count}\n0000000000 65535 f \n{entries}trailer\n<< /Size {count} /Root 1 0 R >>\nstartxref\n{start}\n%%EOF\n"
        );
        self.bytes.extend(table.as_bytes());
        self.bytes
    }
}
