//! The motion: curves, drift, what is said of the run.

use crate::page::html::{described, paragraph};
use crate::picture::chart::{Chart, Curve, Scale};
use crate::record::{Columns, Kind, Record};

/// Curves in a chart.
const MOST_CURVES: usize = 6;
/// Charts of a kind; what is left out is in the table of `pc run`.
const MOST_CHARTS: usize = 8;
/// Curves whose sizes differ by more are drawn in different charts, so that each is seen to move.
const RATIO: f64 = 12.0;
/// Decimal logarithm of the smallest drift that is drawn: less is rounding.
const FLOOR: f64 = -17.0;

/// Charts by kind, then the summary.
pub(super) fn motion(record: &Record) -> String {
    let mut shown = String::new();
    if let Some(remark) = &record.remark {
        shown += &paragraph(remark);
    }
    let mut number = 0;
    for columns in record.columns.iter().filter(|columns| !columns.list.is_empty()) {
        let charts = match columns.kind {
            Kind::Conserved => drift(record, columns).into_iter().collect(),
            _ => by_scale(columns)
                .into_iter()
                .map(|curves| Chart::new(title(columns.kind), Scale::Linear, curves))
                .collect(),
        };
        let charts: Vec<Chart<'_>> = charts;
        if charts.is_empty() {
            continue;
        }
        shown += &format!("<h3>{}</h3>\n<div class=\"charts\">\n", title(columns.kind));
        for chart in charts.iter().take(MOST_CHARTS) {
            number += 1;
            shown += &chart.figure(&record.times, &record.events, &format!("chart-{number}"));
        }
        shown += "</div>\n";
        if charts.len() > MOST_CHARTS {
            let left: usize = charts[MOST_CHARTS..].iter().map(Chart::len).sum();
            shown += &paragraph(&format!("{left} more are not drawn; pc run writes them."));
        }
    }
    if !record.summary.is_empty() {
        shown += "<h3>The run</h3>\n";
        shown += &described(&record.summary);
    }
    shown
}

fn title(kind: Kind) -> &'static str {
    match kind {
        Kind::Coordinates => "Coordinates",
        Kind::QuasiVelocities => "Quasi-velocities",
        Kind::States => "States",
        Kind::Conserved => "Relative drift of integrals",
        Kind::Outputs => "Outputs and reactions",
    }
}

/// Curves of like size together, the largest first, in a chart no more than can be told apart.
fn by_scale(columns: &Columns) -> Vec<Vec<Curve<'_>>> {
    let size =
        |values: &[f64]| values.iter().filter(|v| v.is_finite()).fold(0.0f64, |size, v| size.max(v.abs()));
    let mut sized: Vec<(usize, f64)> =
        columns.list.iter().enumerate().map(|(j, (_, values))| (j, size(values))).collect();
    sized.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    let mut groups: Vec<(f64, Vec<usize>)> = Vec::new();
    for (j, size) in sized {
        match groups.last_mut() {
            // What does not move at all takes no room.
            Some((largest, group)) if size * RATIO >= *largest || size == 0.0 => group.push(j),
            _ => groups.push((size, vec![j])),
        }
    }
    let curve = |&j: &usize| {
        let (name, values) = &columns.list[j];
        Curve { name, values: values.into() }
    };
    let chart = |(_, mut group): (f64, Vec<usize>)| {
        group.sort_unstable();
        group.chunks(MOST_CURVES).map(|some| some.iter().map(curve).collect()).collect::<Vec<_>>()
    };
    groups.into_iter().flat_map(chart).collect()
}

/// log₁₀ |I(t) − I(0)|/|I(0)|; where I(0) is no larger than the drift, the largest |I| stands for it if that is above 1.
fn drift<'a>(record: &Record, columns: &'a Columns) -> Option<Chart<'a>> {
    let count = columns.list.len() - usize::from(!record.keeps_energy);
    let curve = |(name, values): &'a (String, Vec<f64>)| {
        let start = values.first().copied().unwrap_or(0.0);
        let worst = values.iter().fold(0.0f64, |worst, v| worst.max((v - start).abs()));
        let scale =
            if worst < start.abs() { start.abs() } else { values.iter().fold(1.0f64, |a, b| a.max(b.abs())) };
        let logarithm = |v: &f64| ((v - start).abs() / scale).log10().max(FLOOR);
        Curve { name, values: values.iter().map(logarithm).collect::<Vec<_>>().into() }
    };
    let curves: Vec<Curve<'a>> = columns.list.iter().take(count).map(curve).collect();
    (!curves.is_empty()).then(|| Chart::new("Relative drift", Scale::Decades, curves))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_large_coordinate_does_not_flatten_a_small_one() {
        let column = |name: &str, size: f64| (name.to_owned(), vec![0.0, size, -size]);
        let list =
            vec![column("small", 0.01), column("large", 200.0), column("still", 0.0), column("near", 30.0)];
        let columns = Columns { kind: Kind::Coordinates, list };
        let names: Vec<Vec<&str>> =
            by_scale(&columns).iter().map(|chart| chart.iter().map(|curve| curve.name).collect()).collect();
        assert_eq!(names, [vec!["large", "near"], vec!["small", "still"]]);
    }
}
