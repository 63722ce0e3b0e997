//! The names of units beside the names of quantities.

use crate::picture::panel::{Content, Panel, Scale};
use crate::picture::sheet::Picture;

/// The name of a quantity with that of its unit, `x [m]`, if it has one; an error of x has the unit of x.
fn labelled(name: &str, units: &[(String, String)]) -> String {
    let of = name.strip_prefix("error(").and_then(|name| name.strip_suffix(')')).unwrap_or(name);
    match units.iter().find(|(known, _)| known == of) {
        Some((_, unit)) => format!("{name} [{unit}]"),
        None => name.to_owned(),
    }
}

impl Panel {
    /// The panel with units beside the names on its axes and, unless its values are logarithms, beside those of its curves.
    pub(crate) fn in_units(mut self, units: &[(String, String)]) -> Panel {
        if units.is_empty() {
            return self;
        }
        self.title = labelled(&self.title, units);
        self.across.0 = labelled(&self.across.0, units);
        self.up.0 = labelled(&self.up.0, units);
        if let (Content::Curves(curves), Scale::Linear | Scale::Angles) = (&mut self.content, self.up.1) {
            for curve in curves {
                curve.name = labelled(&curve.name, units);
            }
        }
        self
    }
}

impl Picture {
    /// The picture with units, given as pairs of a quantity and its unit, beside the names of quantities.
    #[must_use]
    pub fn in_units(self, units: &[(String, String)]) -> Picture {
        let panels = self.panels.into_iter().map(|panel| panel.in_units(units)).collect();
        Picture { panels, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::panel::Curve;

    #[test]
    fn quantities_with_a_unit_show_it() {
        let units = [("x", "m"), ("t", "s")].map(|(name, unit)| (name.to_owned(), unit.to_owned()));
        let names = ["x", "error(x)", "y"].map(|name| labelled(name, &units));
        assert_eq!(names, ["x [m]", "error(x) [m]", "y"]);
        let curve = || Curve { name: "x".to_owned(), points: Vec::new() };
        let of = |scale| Panel::over("t", "a", scale, vec![curve()]).in_units(&units);
        assert_eq!(
            (of(Scale::Linear).across.0.as_str(), of(Scale::Linear).names()[0].to_owned()),
            ("t [s]", "x [m]".to_owned())
        );
        // A relative drift has none.
        assert_eq!(of(Scale::Decades).names(), ["x"]);
    }
}
