//! The part on the motion: curves, drift, portraits, and the summary of the run.

use crate::page::html::{described, paragraph, text};
use crate::picture::chart::figure;
use crate::picture::motion::{of_kind, portrait, title};
use crate::picture::{Ink, Panel};
use crate::recording::Recording;

/// The largest number of charts of a kind; the table of `pc run` has the remaining columns.
const MOST_CHARTS: usize = 8;
/// The largest number of points of a curve.
const MOST_POINTS: usize = 1500;

/// Charts ordered by kind, followed by charts of the most informative pairs of columns, one column plotted
/// against the other, and then the summary.
pub(super) fn motion(record: &Recording, pairs: &[(String, String)]) -> String {
    let mut shown = String::new();
    if let Some(remark) = &record.remark {
        shown += &paragraph(remark);
    }
    let mut number = 0;
    let mut charts = |heading: &str, panels: &[Panel]| {
        let drawn = &panels[..panels.len().min(MOST_CHARTS)];
        let figures: String = drawn
            .iter()
            .map(|panel| {
                number += 1;
                chart(panel, &format!("chart-{number}"))
            })
            .collect();
        let mut all = format!("<h3>{heading}</h3>\n<div class=\"charts\">\n{figures}</div>\n");
        let left: usize = panels[drawn.len()..].iter().map(|panel| panel.names().len()).sum();
        if left > 0 {
            all += &paragraph(&format!("{left} more are not drawn; pc run writes them."));
        }
        all
    };
    for columns in record.curves().columns.iter().filter(|columns| !columns.list.is_empty()) {
        let panels = of_kind(record, columns, &[]);
        if !panels.is_empty() {
            shown += &charts(title(columns.kind), &panels);
        }
    }
    let portraits: Vec<Panel> =
        pairs.iter().filter_map(|(x, y)| portrait(record.curves(), (x, y), &[]).ok()).collect();
    if !portraits.is_empty() {
        shown += &charts("Phase portraits and paths", &portraits);
    }
    if !record.summary.is_empty() {
        shown += "<h3>The run</h3>\n";
        shown += &described(&record.summary);
    }
    shown
}

/// A chart with its legend.
fn chart(panel: &Panel, id: &str) -> String {
    let (svg, names) = (figure(panel, MOST_POINTS, id), panel.names());
    let key = |(i, name): (usize, &&str)| {
        format!("<span class=\"key\"><i class=\"k{}\"></i>{}</span>", i % Ink::CURVES, text(name))
    };
    let keys: String = names.iter().enumerate().map(key).collect();
    format!("<figure>{svg}<figcaption>{keys}</figcaption></figure>\n")
}
