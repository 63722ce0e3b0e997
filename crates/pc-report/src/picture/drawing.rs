//! The elements of a drawing: lines, texts and areas.

/// A drawing whose lengths are in points, with x pointing to the right and y down.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drawing {
    /// Its width.
    pub width: f64,
    /// Its height.
    pub height: f64,
    /// The shapes, in the order of painting.
    pub shapes: Vec<Shape>,
}

/// A shape to be painted.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A line through points.
    Line {
        /// The points.
        points: Vec<[f64; 2]>,
        /// The colour and width of the line.
        ink: Ink,
    },
    /// A filled rectangle.
    Area {
        /// The upper left corner of the area.
        from: [f64; 2],
        /// The lower right corner of the area.
        to: [f64; 2],
        /// Its colour.
        ink: Ink,
    },
    /// A filled area with these corners.
    Filled {
        /// The corners.
        corners: Vec<[f64; 2]>,
        /// Its colour.
        ink: Ink,
    },
    /// An area with these corners through which one sees what is behind it.
    Glass {
        /// The corners.
        corners: Vec<[f64; 2]>,
        /// Its colour.
        ink: Ink,
    },
    /// Shapes of which a viewer says something where the pointer is on them.
    Titled {
        /// What is said.
        title: String,
        /// The shapes.
        shapes: Vec<Shape>,
    },
    /// Text on one line.
    Text {
        /// The position of the beginning, the middle or the end of the text, on its baseline.
        at: [f64; 2],
        /// The point of the text that lies at this position.
        anchor: Anchor,
        /// The height of the font.
        size: f64,
        /// Its colour.
        ink: Ink,
        /// The text.
        text: String,
    },
}

/// The opacity of [`Shape::Glass`].
pub(crate) const GLASS: f64 = 0.45;

/// The point of a text to which its position refers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// Its beginning.
    Start,
    /// Its middle.
    Middle,
    /// Its end.
    End,
}

/// The purpose of an element, which determines its colour and width; a page has its own colours for each
/// purpose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ink {
    /// Important words.
    Text,
    /// Numbers beside axes.
    Soft,
    /// Axes.
    Axis,
    /// Grid lines at round numbers.
    Grid,
    /// Lines at the times of events.
    Event,
    /// The curve with this index.
    Curve(usize),
    /// Rods and springs of a mechanism.
    Rod,
    /// A colour given by its red, green and blue.
    Mixed([u8; 3]),
}

/// Colours that colour-blind readers can distinguish [Okabe, Ito 2008].
const COLOURS: [[u8; 3]; 8] = [
    [0, 114, 178],
    [213, 94, 0],
    [0, 158, 115],
    [204, 121, 167],
    [230, 159, 0],
    [86, 180, 233],
    [110, 90, 60],
    [120, 120, 120],
];

impl Ink {
    /// The number of distinguishable curves.
    pub(crate) const CURVES: usize = COLOURS.len();

    /// The red, green and blue components of its colour on a white background.
    pub fn colour(self) -> [u8; 3] {
        match self {
            Ink::Text | Ink::Rod => [29, 36, 48],
            Ink::Soft | Ink::Axis => [91, 100, 114],
            Ink::Grid => [228, 231, 236],
            Ink::Event => [140, 148, 160],
            Ink::Curve(i) => COLOURS[i % COLOURS.len()],
            Ink::Mixed(colour) => colour,
        }
    }

    /// The colour with this opacity on a white background.
    #[must_use]
    pub(crate) fn faded(self, opacity: f64) -> Ink {
        Ink::Mixed(self.colour().map(|c| (255.0 - opacity * (255.0 - f64::from(c))).round() as u8))
    }

    /// The colour in a light of this brightness, from 0 to 1.
    #[must_use]
    pub(crate) fn shaded(self, bright: f64) -> Ink {
        Ink::Mixed(self.colour().map(|c| (bright * f64::from(c)).round() as u8))
    }

    /// The width of a line.
    pub fn width(self) -> f64 {
        match self {
            Ink::Curve(_) => 1.5,
            Ink::Rod => 2.0,
            _ => 1.0,
        }
    }

    /// The lengths of a dash and of the following gap, for a line that is not solid.
    pub fn dash(self) -> Option<[f64; 2]> {
        (self == Ink::Event).then_some([2.0, 3.0])
    }
}

impl Drawing {
    pub(crate) fn line(&mut self, points: Vec<[f64; 2]>, ink: Ink) {
        self.shapes.push(Shape::Line { points, ink });
    }

    pub(super) fn area(&mut self, from: [f64; 2], to: [f64; 2], ink: Ink) {
        self.shapes.push(Shape::Area { from, to, ink });
    }

    pub(crate) fn filled(&mut self, corners: Vec<[f64; 2]>, ink: Ink) {
        self.shapes.push(Shape::Filled { corners, ink });
    }

    pub(crate) fn glass(&mut self, corners: Vec<[f64; 2]>, ink: Ink) {
        self.shapes.push(Shape::Glass { corners, ink });
    }

    pub(crate) fn text(
        &mut self,
        at: [f64; 2],
        anchor: Anchor,
        size: f64,
        ink: Ink,
        text: impl Into<String>,
    ) {
        self.shapes.push(Shape::Text { at, anchor, size, ink, text: text.into() });
    }
}
