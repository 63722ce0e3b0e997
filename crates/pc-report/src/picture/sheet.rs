//! A picture: panels arranged one below the other.

use pc_print::one_line;

use crate::picture::chart::{Frame, width_of};
use crate::picture::drawing::{Anchor, Drawing, Ink};
use crate::picture::motion::{Wanted, panels};
use crate::picture::panel::{Content, Panel, Scale};
use crate::recording::{Recording, UnknownColumn};

const WIDTH: f64 = 960.0;
const TITLE: f64 = 46.0;
const REMARK: f64 = 22.0;
/// The heights of the parts of a panel that is plotted over time: its heading, the area within the axes, the
/// numbers below.
const HEADING: f64 = 30.0;
const WITHIN: f64 = 180.0;
const BELOW: f64 = 36.0;
/// The height of the area within the axes of a panel that is not plotted over time.
const SQUARE: f64 = 340.0;
const EDGE: f64 = 14.0;
/// The sizes of texts.
const LARGE: f64 = 17.0;
const HEADLINE: f64 = 13.0;
const SMALL: f64 = 11.0;
/// If there are more curves than this, their names are left out.
const MOST_NAMES: usize = 9;
/// The largest number of points of a curve.
const MOST_POINTS: usize = 12_000;
/// The largest number of panels of a picture, unless its contents were chosen.
const MOST_PANELS: usize = 12;

/// Panels under a title.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// The title.
    pub title: String,
    /// Further remarks, line by line.
    pub remarks: Vec<String>,
    /// The panels.
    pub panels: Vec<Panel>,
}

impl Picture {
    /// The picture of the requested parts of a motion.
    ///
    /// # Errors
    /// [`UnknownColumn`]
    pub fn of(title: &str, record: &Recording, wanted: &Wanted) -> Result<Picture, UnknownColumn> {
        let mut panels = panels(record, wanted)?;
        let mut remarks: Vec<String> = record.remark.iter().cloned().collect();
        if wanted.columns.is_empty() && panels.len() > MOST_PANELS {
            // The drift shows the reliability of the rest.
            let is_more = |panel: &Panel| !panel.is_portrait() && panel.up.1 == Scale::Linear;
            let mut left = panels.len() - MOST_PANELS;
            let are = if left == 1 { "panel is" } else { "panels are" };
            remarks.push(format!("{left} more {are} not drawn; --columns chooses what is."));
            let mut kept: Vec<Panel> = Vec::with_capacity(MOST_PANELS);
            for panel in panels.into_iter().rev() {
                if left > 0 && is_more(&panel) {
                    left -= 1;
                } else {
                    kept.push(panel);
                }
            }
            kept.reverse();
            panels = kept;
        }
        Ok(Picture { title: one_line(title).into_owned(), remarks, panels })
    }

    /// The picture as lines, texts and areas.
    pub fn drawing(&self) -> Drawing {
        let mut drawing = Drawing { width: WIDTH, ..Drawing::default() };
        drawing.text([WIDTH / 2.0, 29.0], Anchor::Middle, LARGE, Ink::Text, self.title.clone());
        let mut y = TITLE;
        for remark in &self.remarks {
            let remark = one_line(remark).into_owned();
            drawing.text([WIDTH / 2.0, y + 6.0], Anchor::Middle, HEADLINE, Ink::Soft, remark);
            y += REMARK;
        }
        let (wide, square): (Vec<&Panel>, Vec<&Panel>) =
            self.panels.iter().partition(|panel| !panel.is_portrait());
        let is_square_first = self.panels.first().is_some_and(Panel::is_portrait);
        if is_square_first {
            y = squares(&mut drawing, &square, y);
        }
        y = rows(&mut drawing, &wide, y, self.legend());
        if !is_square_first {
            y = squares(&mut drawing, &square, y);
        }
        drawing.height = (y + 6.0).ceil();
        drawing
    }

    /// The width that the names of curves need.
    fn legend(&self) -> f64 {
        let over_time = self.panels.iter().filter(|panel| !panel.is_portrait());
        let longest = over_time
            .flat_map(|panel| panel.names())
            .map(|name| width_of(name, HEADLINE))
            .fold(0.0, f64::max);
        if longest == 0.0 { 0.0 } else { (longest + 52.0).clamp(90.0, 270.0) }
    }
}

/// Draws panels over one quantity below each other from `y` on, and returns where they end.
fn rows(drawing: &mut Drawing, wide: &[&Panel], mut y: f64, legend: f64) -> f64 {
    let margin = wide.iter().map(|panel| panel.margin(WITHIN, SMALL)).fold(0.0, f64::max);
    for (i, panel) in wide.iter().enumerate() {
        // The label to the right is written below the last of several.
        let again = wide.get(i + 1).is_some_and(|next| next.across == panel.across);
        let panel = &Panel {
            across: if again { (String::new(), panel.across.1) } else { panel.across.clone() },
            ..(*panel).clone()
        };
        let top = y + HEADING;
        let frame = Frame { left: EDGE + margin, right: WIDTH - EDGE - legend, top, bottom: top + WITHIN };
        drawing.text([EDGE, y + 18.0], Anchor::Start, HEADLINE, Ink::Text, panel.title.clone());
        panel.draw(drawing, frame, SMALL, MOST_POINTS);
        names(drawing, panel, [frame.right + 14.0, top + 8.0], legend - 14.0);
        y = frame.bottom + if again { BELOW - 12.0 } else { BELOW };
    }
    y
}

/// Draws panels with axes that are alike from `y` on, and returns where they end.
fn squares(drawing: &mut Drawing, square: &[&Panel], mut y: f64) -> f64 {
    // Two side by side; a single one has the whole width.
    for pair in square.chunks(2) {
        let cell = (WIDTH - 2.0 * EDGE) / pair.len() as f64;
        let top = y + HEADING + 16.0;
        for (i, panel) in pair.iter().enumerate() {
            let left = EDGE + i as f64 * cell;
            let frame = Frame {
                left: left + panel.margin(SQUARE, SMALL),
                right: left + cell - 2.0 * EDGE,
                top,
                bottom: top + SQUARE * if pair.len() == 1 { 1.4 } else { 1.0 },
            };
            drawing.text([left, y + 18.0], Anchor::Start, HEADLINE, Ink::Text, panel.title.clone());
            panel.draw(drawing, frame, SMALL, MOST_POINTS);
        }
        y = top + SQUARE * if pair.len() == 1 { 1.4 } else { 1.0 } + BELOW;
    }
    y
}

/// Draws the names of curves with their colours, one below the other.
fn names(drawing: &mut Drawing, panel: &Panel, [x, y]: [f64; 2], width: f64) {
    const STEP: f64 = 18.0;
    let names = panel.names();
    let most = ((width - 26.0) / width_of("x", HEADLINE)).max(4.0) as usize;
    for (i, name) in names.iter().take(MOST_NAMES).enumerate() {
        let y = y + STEP * i as f64;
        match &panel.content {
            Content::Fan(fan) if i < fan.bands.len() => {
                drawing.area([x, y - 5.0], [x + 18.0, y + 5.0], fan.ink(i));
            }
            Content::Fan(_) => drawing.line(vec![[x, y], [x + 18.0, y]], Ink::Curve(0)),
            _ => drawing.line(vec![[x, y], [x + 18.0, y]], Ink::Curve(i)),
        }
        let name = if name.chars().count() > most {
            name.chars().take(most - 1).chain(['…']).collect()
        } else {
            (*name).to_owned()
        };
        drawing.text([x + 25.0, y + 4.5], Anchor::Start, HEADLINE, Ink::Text, name);
    }
    if names.len() > MOST_NAMES {
        let more = format!("and {} more", names.len() - MOST_NAMES);
        let y = y + STEP * MOST_NAMES as f64 + 4.5;
        drawing.text([x, y], Anchor::Start, HEADLINE, Ink::Soft, more);
    }
}
