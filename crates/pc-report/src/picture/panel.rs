//! Panels: contents that share axes.

/// Contents that share axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// The title.
    pub title: String,
    /// The name of the horizontal axis, and its scale.
    pub across: (String, Scale),
    /// The name of the vertical axis, if there is one for all curves, and its scale.
    pub up: (String, Scale),
    /// The horizontal range, if it differs from that of the contents.
    pub span: Option<(f64, f64)>,
    /// Whether both axes have the same scale.
    pub equal: bool,
    /// Horizontal values at which events occurred.
    pub events: Vec<f64>,
    /// The contents.
    pub content: Content,
}

/// The scale of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// The values are shown as they are.
    Linear,
    /// The values are decimal logarithms.
    Decades,
    /// The values are logarithms with a sign, sign(v) log₁₀(1 + |v|/10ⁿ): linear up to 10ⁿ, and then in decades.
    SignedDecades(i32),
    /// The values are angles from −π to π.
    Angles,
}

/// The contents of a panel.
#[derive(Clone, Debug, PartialEq)]
pub enum Content {
    /// Curves, each with its name.
    Curves(Vec<Curve>),
    /// Bands between quantiles.
    Fan(Fan),
    /// The ways of eigenvalues, with the real part to the right and the imaginary one up.
    Roots(Vec<Root>),
    /// Bars, each given by its left end, its right end and its height.
    Bars(Vec<[f64; 3]>),
    /// A colour for each value; the values are listed column by column.
    Cells {
        /// The middles of the columns.
        columns: Vec<f64>,
        /// The middles of the rows.
        rows: Vec<f64>,
        /// The values.
        values: Vec<f64>,
    },
}

/// A curve, which is broken where a value is not finite.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Its name.
    pub name: String,
    /// Its points.
    pub points: Vec<(f64, f64)>,
}

/// Bands between quantiles, with the middle one as a curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Fan {
    /// The values to the right.
    pub across: Vec<f64>,
    /// The bands, the widest first.
    pub bands: Vec<Band>,
    /// The middle.
    pub middle: Curve,
}

/// A band, broken where a value is not finite.
#[derive(Clone, Debug, PartialEq)]
pub struct Band {
    /// Its name.
    pub name: String,
    /// Its lower edge.
    pub low: Vec<f64>,
    /// Its upper edge.
    pub high: Vec<f64>,
}

/// The way of an eigenvalue, broken where it has no value.
#[derive(Clone, Debug, PartialEq)]
pub struct Root {
    /// What is said of it where a viewer points at it.
    pub title: String,
    /// Its real and imaginary part for each value of the quantity.
    pub points: Vec<(f64, f64)>,
    /// Its parts for the present value of the quantity.
    pub present: Option<(f64, f64)>,
}

impl Scale {
    /// The place of a value on the axis, as it is given to a panel.
    pub fn of(self, value: f64) -> f64 {
        match self {
            Scale::Linear | Scale::Angles => value,
            Scale::Decades => value.log10(),
            Scale::SignedDecades(n) => value.signum() * (1.0 + value.abs() / 10f64.powi(n)).log10(),
        }
    }
}

impl Panel {
    /// A panel of curves over a common quantity.
    pub fn over(across: &str, title: impl Into<String>, scale: Scale, curves: Vec<Curve>) -> Panel {
        Panel {
            title: title.into(),
            across: (across.to_owned(), Scale::Linear),
            up: (String::new(), scale),
            span: None,
            equal: false,
            events: Vec::new(),
            content: Content::Curves(curves),
        }
    }

    /// The names of the curves in the panel.
    pub(crate) fn names(&self) -> Vec<&str> {
        match &self.content {
            Content::Curves(curves) => curves.iter().map(|curve| curve.name.as_str()).collect(),
            Content::Fan(fan) => {
                let bands = fan.bands.iter().map(|band| band.name.as_str());
                bands.chain([fan.middle.name.as_str()]).collect()
            }
            Content::Roots(_) | Content::Bars(_) | Content::Cells { .. } => Vec::new(),
        }
    }

    /// Whether the two axes of the panel are alike and neither of them is time.
    pub(crate) fn is_portrait(&self) -> bool {
        !self.up.0.is_empty()
    }
}
