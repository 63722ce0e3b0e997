//! The part on the motion: curves, drift, portraits, and the summary of the run.

use crate::page::html::{described, paragraph, text};
use crate::page::plots::Plots;
use crate::page::vectors::vectors;
use crate::picture::chart::figure;
use crate::picture::motion::{of_kind, portrait, title, together};
use crate::picture::{Ink, Panel};
use crate::recording::{ColumnKind, Columns, Recording};

/// The largest number of charts of a kind; the table of `pc run` has the remaining columns.
const MOST_CHARTS: usize = 10;
/// The largest number of points of a curve.
const MOST_POINTS: usize = 1500;

/// Charts ordered by kind, followed by charts of the most informative pairs of columns, one column plotted
/// against the other, and then the summary.
pub(super) fn motion(record: &Recording, pairs: &[(String, String)]) -> String {
    let remark = record.remark.as_ref().map_or_else(String::new, |remark| paragraph(remark));
    let mut shown = String::new();
    let mut plots = Plots::default();
    let mut number = 0;
    let mut charts = |heading: &str, panels: &[Panel]| {
        let drawn = &panels[..panels.len().min(MOST_CHARTS)];
        let is_over_time = drawn.iter().all(|panel| !panel.is_portrait());
        let mut figures = String::new();
        for panel in drawn {
            number += 1;
            let id = format!("chart-{number}");
            plots.add(&id, panel);
            figures += &chart(panel, &id);
        }
        let class = if is_over_time { "charts" } else { "charts paths" };
        let mut all = format!("<h3>{heading}</h3>\n<div class=\"{class}\">\n{figures}</div>\n");
        let left: usize = panels[drawn.len()..].iter().map(|panel| panel.names().len()).sum();
        if left > 0 {
            all += &paragraph(&format!("{left} more are not drawn; pc run writes them."));
        }
        all
    };
    for columns in record.curves().columns.iter().filter(|columns| !columns.list.is_empty()) {
        let panels: Vec<Panel> =
            panels(record, columns).into_iter().map(|panel| panel.in_units(&record.units)).collect();
        if !panels.is_empty() {
            shown += &charts(title(columns.kind), &panels);
        }
    }
    let portraits: Vec<Panel> = pairs
        .iter()
        .filter_map(|(x, y)| portrait(record.curves(), (x, y), &[]).ok())
        .map(|panel| panel.in_units(&record.units))
        .collect();
    if !portraits.is_empty() {
        shown += &charts("Phase portraits and paths", &portraits);
    }
    if !record.summary.is_empty() {
        shown += "<h3>The run</h3>\n";
        shown += &described(&record.summary);
    }
    format!("{remark}{}{shown}{}", plots.help(), plots.script())
}

/// The panels of columns of one kind: vectors, each by itself, and the others by their scales.
fn panels(record: &Recording, columns: &Columns) -> Vec<Panel> {
    if matches!(columns.kind, ColumnKind::Conserved | ColumnKind::Errors) {
        return of_kind(record, columns, &[]);
    }
    let (vectors, others) = vectors(&columns.list);
    let mut panels: Vec<Panel> = vectors.iter().map(|list| together(record, columns.kind, list)).collect();
    panels.extend(of_kind(record, &Columns { kind: columns.kind, list: others }, &[]));
    panels
}

/// A chart with its legend.
fn chart(panel: &Panel, id: &str) -> String {
    let (svg, names) = (figure(panel, MOST_POINTS, id), panel.names());
    let key = |(i, name): (usize, &&str)| {
        format!("<span class=\"key\"><i class=\"k{}\"></i>{}</span>", i % Ink::CURVES, text(name))
    };
    let keys: String = names.iter().enumerate().map(key).collect();
    format!("<figure id=\"{id}\"><figcaption>{keys}</figcaption>{svg}</figure>\n")
}
