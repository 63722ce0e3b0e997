//! The plots that answer to the mouse: their data, and the script that draws them in place of the pictures.

use serde_json::{Value, json};

use crate::base64;
use crate::page::html::{PLOTS, data};
use crate::picture::chart::ends;
use crate::picture::{Content, Curve, Panel, Scale};

/// The script that draws the plots, with the licence of uPlot at its head.
pub const SCRIPT: &str = include_str!("../../plots/dist/plots.js");

/// The largest number of values in the plots of a page, which take up a fifth of a megabyte.
const MOST_NUMBERS: usize = 36_000;

/// The panels of a page, with the ids of their figures.
pub(super) struct Plots {
    panels: Vec<(String, Panel)>,
}

impl Plots {
    pub(super) fn of(panels: impl Iterator<Item = (String, Panel)>) -> Plots {
        Plots { panels: panels.collect() }
    }

    fn is_empty(&self) -> bool {
        self.panels.iter().all(|(_, panel)| panel.is_portrait())
    }

    /// What readers are told once the script runs.
    pub(super) fn help(&self) -> &'static str {
        if self.is_empty() {
            return "";
        }
        "<p class=\"soft\" id=\"plots-help\" hidden=\"hidden\">Drag across a plot to see a part of the time, click twice to see all \
         of it. A click goes to a time; names hide their curves.</p>\n"
    }

    /// The data and the script; nothing if there are no plots.
    pub(super) fn script(&self) -> String {
        if self.is_empty() {
            return String::new();
        }
        format!(
            "<script type=\"application/json\" id=\"{PLOTS}\">{}</script>\n\
             <script>/*<![CDATA[*/\n{SCRIPT}/*]]>*/</script>\n",
            data(&self.data())
        )
    }

    /// The charts over time with their numbers, the lists of times, which charts share, and the paths of one
    /// column against another, with the ends of their axes.
    pub(super) fn data(&self) -> Value {
        let (paths, panels): (Vec<_>, Vec<_>) =
            self.panels.iter().partition(|(_, panel)| panel.is_portrait());
        let paths = paths.iter().map(|(id, panel)| {
            let [across, up] = ends(panel);
            json!({ "id": id, "x": panel.across.0, "y": panel.up.0, "across": across, "up": up })
        });
        let curves: usize = panels.iter().map(|(_, panel)| panel.names().len()).sum();
        let most = MOST_NUMBERS / curves.max(1);
        let mut times: Vec<Vec<f64>> = Vec::new();
        let mut charts: Vec<Value> = Vec::new();
        for (id, panel) in panels {
            let Content::Curves(curves) = &panel.content else { continue };
            let mut kept = telling(curves, most);
            if curves.first().is_some_and(is_backwards) {
                kept.reverse(); // the script wants times that grow
            }
            let at: Vec<f64> = kept.iter().map(|&i| curves[0].points[i].0).collect();
            let place = times.iter().position(|known| *known == at).unwrap_or_else(|| {
                times.push(at);
                times.len() - 1
            });
            let curve = |curve: &Curve| {
                let [offset, values] = packed(kept.iter().map(|&i| curve.points[i].1));
                json!([curve.name, offset, values])
            };
            charts.push(json!({
                "id": id,
                "label": format!("{}: {} over time", panel.title, panel.names().join(", ")),
                "decades": panel.up.1 == Scale::Decades,
                "events": panel.events,
                "times": place,
                "curves": curves.iter().map(curve).collect::<Vec<_>>(),
            }));
        }
        let times: Vec<[Value; 2]> = times.iter().map(|times| packed(times.iter().copied())).collect();
        json!({ "times": times, "charts": charts, "paths": paths.collect::<Vec<_>>() })
    }
}

fn is_backwards(curve: &Curve) -> bool {
    matches!(curve.points[..], [first, .., last] if last.0 < first.0)
}

/// The numbers relative to the first of them that is finite, so that single precision shows small changes of
/// a large value.
fn packed(numbers: impl Iterator<Item = f64> + Clone) -> [Value; 2] {
    let offset = numbers.clone().find(|number| number.is_finite()).unwrap_or(0.0);
    let single: Vec<f32> = numbers.map(|number| (number - offset) as f32).collect();
    [json!(offset), json!(base64::numbers(&single))]
}

/// The indices of about `most` points of curves over the same times: all, or else, in each of several
/// intervals, the first point and the lowest and the highest of each curve.
fn telling(curves: &[Curve], most: usize) -> Vec<usize> {
    let count = curves.first().map_or(0, |curve| curve.points.len());
    if count <= most {
        return (0..count).collect();
    }
    let intervals = (most / (2 * curves.len() + 1)).max(1);
    let mut kept: Vec<usize> = vec![count - 1];
    for k in 0..intervals {
        let (start, end) = (k * count / intervals, (k + 1) * count / intervals);
        kept.push(start);
        for curve in curves {
            let value = |i: &usize| curve.points[*i].1;
            let finite = || (start..end).filter(|i| value(i).is_finite());
            kept.extend(finite().min_by(|a, b| value(a).total_cmp(&value(b))));
            kept.extend(finite().max_by(|a, b| value(a).total_cmp(&value(b))));
        }
    }
    kept.sort_unstable();
    kept.dedup();
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_peak_is_lost() {
        let mut points: Vec<(f64, f64)> = (0..10_000).map(|i| (f64::from(i), 0.0)).collect();
        points[4321].1 = 5.0;
        points[8765].1 = f64::NAN;
        let curves = [Curve { name: "x".to_owned(), points }];
        let kept = telling(&curves, 300);
        assert!(kept.len() <= 301 && kept.contains(&4321), "{}", kept.len());
        assert_eq!((kept[0], kept[kept.len() - 1]), (0, 9999));
        assert_eq!(telling(&curves, 10_000).len(), 10_000);
        assert!(telling(&[], 10).is_empty());
    }

    #[test]
    fn a_large_value_keeps_its_small_changes() {
        let [offset, text] = packed([f64::NAN, 1e6, 1e6 + 1e-3].into_iter());
        assert_eq!(offset, json!(1e6));
        assert_eq!(text, json!(base64::numbers(&[f32::NAN, 0.0, ((1e6 + 1e-3) - 1e6) as f32])));
    }
}
