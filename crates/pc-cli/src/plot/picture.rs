//! The picture of a motion: coordinates, quasi-velocities, drift of the integrals, one panel each.

use pc_print::one_line;

use crate::motion::run::Run;
use crate::motion::table::Table;

/// Panels under each other with a common axis of time.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    pub(super) title: String,
    pub(super) time: (f64, f64),
    pub(super) panels: Vec<Panel>,
}

/// Curves on common axes.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Panel {
    pub(super) label: &'static str,
    pub(super) scale: Scale,
    pub(super) curves: Vec<Curve>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scale {
    Linear,
    /// Values are decimal logarithms.
    Decades,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Curve {
    pub(super) name: String,
    pub(super) points: Vec<(f64, f64)>,
}

/// Decimal logarithm of the smallest drift that is drawn: less is rounding.
const FLOOR: f64 = -17.0;
/// Points of a curve beyond which it is thinned; a picture has fewer columns.
const MOST_POINTS: usize = 4000;

impl Picture {
    /// The picture of a run.
    pub fn of(run: &Run) -> Picture {
        let table = &run.table;
        let linear = |label, columns: std::ops::Range<usize>| Panel {
            label,
            scale: Scale::Linear,
            curves: columns
                .map(|j| Curve::new(&table.columns()[j], table.column(0).zip(table.column(j))))
                .collect(),
        };
        let mut conserved = table.conserved();
        if !run.keeps_energy {
            conserved.end -= 1;
        }
        let panels = [
            linear("coordinates", table.coordinates()),
            linear("quasi-velocities", table.quasi_velocities()),
            linear("states", table.states()),
            Panel {
                label: "relative drift",
                scale: Scale::Decades,
                curves: conserved.map(|j| Curve::drift(table, j)).collect(),
            },
        ];
        let (from, to) = (run.plan.t_start, table.column(0).last().unwrap_or(run.plan.t_end));
        let time = if from == to { (from, run.plan.t_end) } else { (from, to) };
        Picture {
            title: one_line(&run.title).into_owned(),
            time: (time.0.min(time.1), time.0.max(time.1)),
            panels: panels.into_iter().filter(|panel| !panel.curves.is_empty()).collect(),
        }
    }
}

impl Curve {
    fn new(name: &str, points: impl Iterator<Item = (f64, f64)>) -> Curve {
        let points: Vec<(f64, f64)> =
            points.filter(|(t, value)| t.is_finite() && value.is_finite()).collect();
        Curve { name: one_line(name).into_owned(), points: thinned(&points) }
    }

    /// log₁₀ |I(t) − I(0)|/|I(0)|; where I(0) is no larger than the drift, the largest |I| stands for it if that is
    /// above 1.
    fn drift(table: &Table, j: usize) -> Curve {
        let start = table.column(j).next().unwrap_or(0.0);
        let scale = match table.drift(j).relative {
            Some(_) => start.abs(),
            None => table.column(j).fold(1.0f64, |a, b| a.max(b.abs())),
        };
        let drift = table.column(j).map(|value| ((value - start).abs() / scale).log10().max(FLOOR));
        Curve::new(&table.columns()[j], table.column(0).zip(drift))
    }
}

/// The least and the greatest of each stretch, in their order, where there are more points than can be seen.
fn thinned(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    if points.len() <= MOST_POINTS {
        return points.to_vec();
    }
    let stretch = points.len().div_ceil(MOST_POINTS / 2);
    let mut kept = Vec::with_capacity(MOST_POINTS);
    for stretch in points.chunks(stretch) {
        let by_value = |a: &&(f64, f64), b: &&(f64, f64)| a.1.total_cmp(&b.1);
        let ends = (stretch.iter().min_by(by_value), stretch.iter().max_by(by_value));
        if let (Some(&low), Some(&high)) = ends {
            kept.extend(if low.0 <= high.0 { [low, high] } else { [high, low] });
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_keeps_extremes() {
        let points: Vec<(f64, f64)> = (0..100_000).map(|i| (f64::from(i), f64::from(i % 777))).collect();
        let kept = thinned(&points);
        assert!(kept.len() <= MOST_POINTS + 2);
        assert!(kept.iter().any(|p| p.1 == 776.0) && kept.iter().any(|p| p.1 == 0.0));
        assert_eq!(thinned(&points[..10]), points[..10]);
    }
}
