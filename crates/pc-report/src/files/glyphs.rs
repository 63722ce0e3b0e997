//! Outlines of the built-in font: pictures do not depend on the fonts of the system.

use crate::picture::Anchor;
use ttf_parser::{Face, GlyphId, OutlineBuilder};

use crate::files::error::PictureError;

/// The built-in font.
pub(super) struct Glyphs {
    face: Face<'static>,
}

/// A character with its position on the line, in units of the font.
pub(super) struct Placed {
    pub(super) glyph: GlyphId,
    pub(super) character: char,
    pub(super) x: f64,
}

impl Glyphs {
    pub(super) fn new() -> Result<Glyphs, PictureError> {
        Face::parse(dejavu::sans::regular(), 0).map(|face| Glyphs { face }).map_err(|_| PictureError::Font)
    }

    /// The number of units of the font that equal the height of a text.
    pub(super) fn units(&self) -> f64 {
        f64::from(self.face.units_per_em())
    }

    /// The characters of a text with their positions relative to its anchor.
    pub(super) fn placed(&self, text: &str, anchor: Anchor) -> Vec<Placed> {
        let mut x = 0.0;
        let mut placed = Vec::new();
        for character in text.chars() {
            // A character that the font lacks is shown as its empty box.
            let glyph = self.face.glyph_index(character).unwrap_or(GlyphId(0));
            placed.push(Placed { glyph, character, x });
            x += self.advance(glyph);
        }
        let shift = match anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => x / 2.0,
            Anchor::End => x,
        };
        placed.iter_mut().for_each(|glyph| glyph.x -= shift);
        placed
    }

    /// The distance from one character to the next.
    pub(super) fn advance(&self, glyph: GlyphId) -> f64 {
        f64::from(self.face.glyph_hor_advance(glyph).unwrap_or(0))
    }

    /// Draws the outline of a character, with y pointing up.
    pub(super) fn outline(&self, glyph: GlyphId, builder: &mut impl OutlineBuilder) {
        // A space has no outline.
        let _ = self.face.outline_glyph(glyph, builder);
    }
}
