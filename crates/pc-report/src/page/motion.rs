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
    let groups = groups(record, pairs);
    for Group { heading, panels, left } in &groups {
        let figures: String = panels.iter().map(|(id, panel)| chart(panel, id)).collect();
        let is_over_time = panels.iter().all(|(_, panel)| !panel.is_portrait());
        let class = if is_over_time { "charts" } else { "charts paths" };
        shown += &format!("<h3>{heading}</h3>\n<div class=\"{class}\">\n{figures}</div>\n");
        if *left > 0 {
            shown += &paragraph(&format!("{left} more are not drawn; pc run writes them."));
        }
    }
    let plots = Plots::of(groups.into_iter().flat_map(|group| group.panels));
    if !record.summary.is_empty() {
        shown += "<h3>The run</h3>\n";
        shown += &described(&record.summary);
    }
    format!("{remark}{}{shown}{}", plots.help(), plots.script())
}

/// The charts of one kind, under a heading.
pub(super) struct Group {
    heading: &'static str,
    /// The charts with their ids.
    pub(super) panels: Vec<(String, Panel)>,
    /// The number of columns that are not drawn, since there are too many.
    left: usize,
}

/// The charts of a motion: those over time by the kinds of their columns, then the portraits of pairs.
pub(super) fn groups(record: &Recording, pairs: &[(String, String)]) -> Vec<Group> {
    let of_kinds = record.curves().columns.iter().filter(|columns| !columns.list.is_empty());
    let over_time = of_kinds.map(|columns| (title(columns.kind), panels(record, columns)));
    let portraits = pairs.iter().filter_map(|(x, y)| portrait(record.curves(), (x, y), &[]).ok()).collect();
    let mut number = 0;
    let mut group = |(heading, mut panels): (&'static str, Vec<Panel>)| {
        let left = panels.iter().skip(MOST_CHARTS).map(|panel| panel.names().len()).sum();
        panels.truncate(MOST_CHARTS);
        let mut named = |panel: Panel| {
            number += 1;
            (format!("chart-{number}"), panel.in_units(&record.units))
        };
        Group { heading, panels: panels.into_iter().map(&mut named).collect(), left }
    };
    let all = over_time.chain([("Phase portraits and paths", portraits)]);
    all.filter(|(_, panels)| !panels.is_empty()).map(&mut group).collect()
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
