//! The panels of a motion.

use std::f64::consts::{PI, TAU};

use pc_print::one_line;

use crate::picture::axes::{is_still, range};
use crate::picture::panel::{Content, Curve, Panel, Scale};
use crate::picture::scales::groups;
use crate::recording::{ColumnKind, Columns, Recording, Samples, UnknownColumn};

/// The decimal logarithm of the smallest drift that is drawn: anything smaller is rounding error.
const FLOOR: f64 = -17.0;
/// The greatest ratio of two lengths that are drawn to the same scale: beyond it, the shorter one is
/// invisible.
const MOST_UNEQUAL: f64 = 6.0;

/// The requested parts of a motion.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Wanted {
    /// Columns over time; `drift(NAME)` is the relative drift of NAME, `error(NAME)` its estimated error, if that is known. If
    /// neither columns nor pairs are given, all columns are shown.
    pub columns: Vec<String>,
    /// Pairs of columns, the second drawn against the first.
    pub pairs: Vec<(String, String)>,
    /// Columns with angles that are shown from −π to π.
    pub wrapped: Vec<String>,
}

/// The title of the panels for columns of a kind.
pub(crate) fn title(kind: ColumnKind) -> &'static str {
    match kind {
        ColumnKind::Coordinates => "Coordinates",
        ColumnKind::QuasiVelocities => "Quasi-velocities",
        ColumnKind::States => "States",
        ColumnKind::Conserved => "Relative drift of integrals",
        ColumnKind::Outputs => "Outputs and reactions",
        ColumnKind::Derivatives => "Derivatives by parameters",
        ColumnKind::Errors => "Estimated errors",
    }
}

/// The requested parts of a motion, as panels.
///
/// # Errors
/// [`UnknownColumn`]
pub(crate) fn panels(record: &Recording, wanted: &Wanted) -> Result<Vec<Panel>, UnknownColumn> {
    let samples = record.curves();
    for name in &wanted.wrapped {
        samples.column(name)?;
    }
    let mut panels = Vec::new();
    if wanted.columns.is_empty() && wanted.pairs.is_empty() {
        for columns in &samples.columns {
            panels.extend(of_kind(record, columns, &wanted.wrapped));
        }
        if record.fine.is_some() {
            panels.extend(errors(record, known_errors(record)));
        }
    }
    panels.extend(chosen(record, samples, wanted)?);
    for (x, y) in &wanted.pairs {
        panels.push(portrait(samples, (x, y), &wanted.wrapped)?);
    }
    Ok(panels.into_iter().map(|panel| panel.in_units(&record.units)).collect())
}

/// The panels of the chosen columns: those of one kind are grouped by scale, and drifts are drawn separately.
fn chosen(record: &Recording, samples: &Samples, wanted: &Wanted) -> Result<Vec<Panel>, UnknownColumn> {
    let mut drifts: Vec<(String, Vec<f64>)> = Vec::new();
    let mut kinds: Vec<Columns> = Vec::new();
    for name in &wanted.columns {
        let drift = name.strip_prefix("drift(").and_then(|name| name.strip_suffix(')'));
        if let Some(kept) = drift.filter(|_| samples.column(name).is_err()) {
            let (_, values) =
                samples.column(kept).map_err(|error| UnknownColumn { name: name.clone(), ..error })?;
            drifts.push((kept.to_owned(), values.to_vec()));
            continue;
        }
        // Errors are known at the rows alone.
        let is_error = known_errors(record).iter().any(|(known, _)| known == name);
        let (kind, values) = if is_error { record.rows.column(name)? } else { samples.column(name)? };
        let column = (name.clone(), values.to_vec());
        match kinds.iter_mut().find(|columns| columns.kind == kind) {
            Some(columns) => columns.list.push(column),
            None => kinds.push(Columns { kind, list: vec![column] }),
        }
    }
    let mut panels = Vec::new();
    for columns in &kinds {
        if columns.kind == ColumnKind::Errors {
            panels.extend(errors(record, &columns.list));
            continue;
        }
        let title = if columns.kind == ColumnKind::Conserved { "Integrals" } else { title(columns.kind) };
        panels.extend(by_scale(record, title, &columns.list, &wanted.wrapped));
    }
    panels.extend(drift(record, &drifts));
    Ok(panels)
}

/// The panels of columns of one kind: integrals are shown by their drift, others by their values.
pub(crate) fn of_kind(record: &Recording, columns: &Columns, wrapped: &[String]) -> Vec<Panel> {
    match columns.kind {
        ColumnKind::Conserved => {
            let count = columns.list.len() - usize::from(!record.keeps_energy);
            drift(record, &columns.list[..count]).into_iter().collect()
        }
        ColumnKind::Errors => errors(record, &columns.list).into_iter().collect(),
        kind => by_scale(record, title(kind), &columns.list, wrapped),
    }
}

/// The panel of columns that belong together, over time.
pub(crate) fn together(record: &Recording, kind: ColumnKind, list: &[(String, Vec<f64>)]) -> Panel {
    let times = &record.curves().times;
    let curve = |(name, values): &(String, Vec<f64>)| Curve {
        name: one_line(name).into_owned(),
        points: times.iter().copied().zip(values.iter().copied()).collect(),
    };
    over_time(record, title(kind), Scale::Linear, list.iter().map(curve).collect())
}

fn by_scale(record: &Recording, title: &str, list: &[(String, Vec<f64>)], wrapped: &[String]) -> Vec<Panel> {
    let (angles, others): (Vec<_>, Vec<_>) = list.iter().partition(|(name, _)| wrapped.contains(name));
    let times = &record.curves().times;
    let curve = |(name, values): &(String, Vec<f64>), wrap: bool| Curve {
        name: one_line(name).into_owned(),
        points: broken(times.iter().copied().zip(values.iter().copied()).collect(), [false, wrap]),
    };
    let values: Vec<Vec<f64>> = others.iter().map(|(_, values)| values.clone()).collect();
    let mut panels: Vec<Panel> = groups(&values)
        .into_iter()
        .map(|group| {
            let curves = group.into_iter().map(|j| curve(others[j], false)).collect();
            over_time(record, title, Scale::Linear, curves)
        })
        .collect();
    if !angles.is_empty() {
        let curves = angles.into_iter().map(|column| curve(column, true)).collect();
        panels.push(over_time(record, title, Scale::Angles, curves));
    }
    panels
}

fn over_time(record: &Recording, title: &str, scale: Scale, curves: Vec<Curve>) -> Panel {
    let times = &record.curves().times;
    let (first, last) = (times.first().copied().unwrap_or(0.0), times.last().copied().unwrap_or(1.0));
    let span = if first == last { (first, first + 1.0) } else { (first.min(last), first.max(last)) };
    Panel { span: Some(span), events: record.events.clone(), ..Panel::over("t", title, scale, curves) }
}

/// The panel of log₁₀ |I(t) − I(0)|/|I(0)|; if |I(0)| is at most the drift, the divisor is instead the
/// largest |I|, or 1 if 1 is larger.
fn drift(record: &Recording, list: &[(String, Vec<f64>)]) -> Option<Panel> {
    let curve = |(name, values): &(String, Vec<f64>)| {
        let start = values.first().copied().unwrap_or(0.0);
        let worst = values.iter().fold(0.0f64, |worst, v| worst.max((v - start).abs()));
        let scale =
            if worst < start.abs() { start.abs() } else { values.iter().fold(1.0f64, |a, b| a.max(b.abs())) };
        // An unchanged value has no logarithm; an integral that never changes lies at the bottom.
        let logarithm = |v: &f64| match (v - start).abs() / scale {
            0.0 if worst > 0.0 => f64::NAN,
            drift => drift.log10().max(FLOOR),
        };
        let points = record.curves().times.iter().copied().zip(values.iter().map(logarithm)).collect();
        Curve { name: one_line(name).into_owned(), points }
    };
    let curves: Vec<Curve> = list.iter().map(curve).collect();
    (!curves.is_empty()).then(|| over_time(record, title(ColumnKind::Conserved), Scale::Decades, curves))
}

/// The estimated errors at the rows.
fn known_errors(record: &Recording) -> &[(String, Vec<f64>)] {
    let errors = record.rows.columns.iter().find(|columns| columns.kind == ColumnKind::Errors);
    errors.map_or(&[], |columns| &columns.list)
}

/// The panel of log₁₀ of the errors at the rows; an error of 0 is not drawn.
fn errors(record: &Recording, list: &[(String, Vec<f64>)]) -> Option<Panel> {
    let times = &record.rows.times;
    let curve = |(name, values): &(String, Vec<f64>)| {
        let logarithms = values.iter().map(|error| if *error == 0.0 { f64::NAN } else { error.log10() });
        Curve { name: one_line(name).into_owned(), points: times.iter().copied().zip(logarithms).collect() }
    };
    let curves: Vec<Curve> = list.iter().map(curve).collect();
    (!curves.is_empty()).then(|| over_time(record, title(ColumnKind::Errors), Scale::Decades, curves))
}

/// The panel with the curve of one column against another.
pub(crate) fn portrait(
    samples: &Samples,
    (x, y): (&str, &str),
    wrapped: &[String],
) -> Result<Panel, UnknownColumn> {
    let (_, across) = samples.column(x)?;
    let (_, up) = samples.column(y)?;
    let wrap = [x, y].map(|name| wrapped.iter().any(|known| known == name));
    let scale = |wrap: bool| if wrap { Scale::Angles } else { Scale::Linear };
    let points = broken(across.iter().copied().zip(up.iter().copied()).collect(), wrap);
    let (x_name, y_name) = (one_line(x).into_owned(), one_line(y).into_owned());
    let name = format!("{y_name} over {x_name}");
    Ok(Panel {
        title: name.clone(),
        across: (x_name, scale(wrap[0])),
        up: (y_name, scale(wrap[1])),
        span: None,
        equal: wrap == [false; 2] && are_alike(x, y) && are_comparable(across, up),
        events: Vec::new(),
        content: Content::Curves(vec![Curve { name, points }]),
    })
}

/// Whether two names denote components of one vector: they differ only in one letter among x, y, z or in one
/// digit.
pub(crate) fn are_alike(a: &str, b: &str) -> bool {
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    let differ = |(x, y): (&char, &char)| (x != y).then_some([*x, *y]);
    let different: Vec<[char; 2]> = a.iter().zip(&b).filter_map(differ).collect();
    let among = |set: &str| different[0].iter().all(|c| set.contains(*c));
    a.len() == b.len()
        && different.len() == 1
        && ["xyz", "XYZ", "0123456789", "₀₁₂₃₄₅₆₇₈₉"].iter().any(|set| among(set))
}

/// Whether values differ by more than rounding errors.
pub(crate) fn moves(values: &[f64]) -> bool {
    range(values.iter().copied()).is_some_and(|(low, high)| !is_still(low, high) && high - low > 1e-12)
}

fn are_comparable(a: &[f64], b: &[f64]) -> bool {
    let span = |values: &[f64]| range(values.iter().copied()).map_or(0.0, |(low, high)| high - low);
    let (a, b) = (span(a), span(b));
    a.max(b) <= MOST_UNEQUAL * a.min(b)
}

/// Points whose first or second numbers are angles, which are reduced to the range from −π to π: the curve is
/// broken where it leaves that range.
fn broken(points: Vec<(f64, f64)>, wrap: [bool; 2]) -> Vec<(f64, f64)> {
    if wrap == [false; 2] {
        return points;
    }
    let turns = |value: f64, wrap: bool| if wrap { ((value + PI) / TAU).floor() } else { 0.0 };
    let at = |(x, y): (f64, f64)| [turns(x, wrap[0]), turns(y, wrap[1])];
    let within = |(x, y): (f64, f64), turns: [f64; 2]| (x - TAU * turns[0], y - TAU * turns[1]);
    let mut shown = Vec::with_capacity(points.len());
    let mut before: Option<((f64, f64), [f64; 2])> = None;
    for point in points {
        let now = at(point);
        if let Some((last, then)) = before.filter(|(_, then)| *then != now) {
            // The curve continues to the edge, on the line between the two points.
            let edge = |k: usize, a: f64, b: f64| {
                let border = TAU * then[k].max(now[k]) - PI;
                if then[k] == now[k] { 1.0 } else { ((border - a) / (b - a)).clamp(0.0, 1.0) }
            };
            let s = edge(0, last.0, point.0).min(edge(1, last.1, point.1));
            let middle = (last.0 + s * (point.0 - last.0), last.1 + s * (point.1 - last.1));
            if middle.0.is_finite() && middle.1.is_finite() {
                shown.extend([within(middle, then), (f64::NAN, f64::NAN), within(middle, now)]);
            }
        }
        shown.push(within(point, now));
        before = Some((point, now));
    }
    shown
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_are_wrapped_at_the_edge() {
        let shown = broken(vec![(0.0, 3.0), (1.0, 3.0 + 2.0 * (PI - 3.0))], [false, true]);
        assert_eq!(shown.len(), 5);
        let near = |a: (f64, f64), b: (f64, f64)| (a.0 - b.0).abs() < 1e-14 && (a.1 - b.1).abs() < 1e-14;
        assert!(near(shown[1], (0.5, PI)) && near(shown[3], (0.5, -PI)), "{shown:?}");
        assert!(shown[2].1.is_nan() && near(shown[4], (1.0, -3.0)), "{shown:?}");
        assert_eq!(broken(vec![(0.0, 9.0)], [false; 2]), [(0.0, 9.0)]);
    }

    #[test]
    fn components_of_a_vector_are_alike() {
        for (a, b) in [("x", "y"), ("x1", "y1"), ("ω1", "ω3"), ("F_rod_x", "F_rod_z")] {
            assert!(are_alike(a, b), "{a} {b}");
        }
        for (a, b) in [("x", "x'"), ("x", "φ"), ("x", "x"), ("x1", "y2"), ("r", "s"), ("x1", "y")] {
            assert!(!are_alike(a, b), "{a} {b}");
        }
    }
}
