//! The picture of a sweep: curves against one parameter, eigenvalues in the complex plane, a coloured cell for each pair of
//! values of two parameters, or histograms of random members.

use std::io;

use pc_report::UnknownColumn;
use pc_report::picture::{Band, Content, Curve, Fan, Panel, Picture, Scale, by_scale};

use super::of::SweepOf;
use crate::linear::locus_picture::{self, Axes};
use crate::sweep::eigenvalues::locus;
use crate::sweep::error::SweepError;
use crate::sweep::journal::Records;
use crate::sweep::picture_error::{MOST_CELLS, SweepPlotError};
use crate::sweep::record::Status;
use crate::sweep::sweep_columns::SweepColumns;
use pc_print::short;

/// The largest number of panels, unless columns are chosen.
const MOST_PANELS: usize = 8;
/// The largest number of members whose curves over time are shown.
const MOST_MEMBERS: usize = 8;
/// The quantiles that are shown, with their names.
const QUANTILES: [(f64, &str); 5] =
    [(0.05, "5 %"), (0.25, "25 %"), (0.5, "median"), (0.75, "75 %"), (0.95, "95 %")];

/// An error, before anything is computed, if a sweep whose varied quantities have these `counts` of values
/// cannot be drawn.
///
/// # Errors
/// [`SweepPlotError`]
pub(crate) fn check(
    sweep_columns: &SweepColumns,
    wanted: &[String],
    counts: &[u64],
    is_random: bool,
) -> Result<(), SweepPlotError> {
    chosen(sweep_columns, wanted)?;
    let varied = counts.iter().filter(|&&count| count > 1).count();
    if is_random {
        return Ok(());
    }
    let members = counts.iter().fold(1u64, |all, &count| all.saturating_mul(count));
    match varied {
        0 | 1 => Ok(()),
        2 if members <= MOST_CELLS => Ok(()),
        2 => Err(SweepPlotError::Cells { members }),
        varied => Err(SweepPlotError::Varied { varied }),
    }
}

/// The indices of the chosen columns among those of the results; all except time and drifts if none is
/// chosen.
fn chosen(sweep_columns: &SweepColumns, wanted: &[String]) -> Result<Vec<usize>, SweepPlotError> {
    let names = sweep_columns.numbers();
    if wanted.is_empty() {
        // Time is the same in most members, and drifts are noise.
        let is_shown = |&j: &usize| !is_time(sweep_columns, j) && !names[j].starts_with("drift(");
        return Ok((0..names.len()).filter(is_shown).collect());
    }
    let place = |name: &String| {
        names.iter().position(|known| *known == name.trim()).ok_or_else(|| {
            let known = names.iter().map(ToString::to_string).collect();
            SweepPlotError::UnknownColumn(UnknownColumn { name: name.trim().to_owned(), known })
        })
    };
    wanted.iter().map(place).collect()
}

/// Whether number `j` in a row is the time of the row.
fn is_time(sweep_columns: &SweepColumns, j: usize) -> bool {
    sweep_columns.of() == SweepOf::Run && j == 0
}

/// A phrase for what a curve, a colour or a bar shows about a member.
fn shown(of: SweepOf) -> &'static str {
    match of {
        SweepOf::Run => "At the end",
        SweepOf::Linearize => "Eigenvalues",
        SweepOf::Check => "Properties",
    }
}

/// What is added to the name of a column to say at which time it is shown.
fn at_the_end(of: SweepOf) -> &'static str {
    if of == SweepOf::Run { " at the end" } else { "" }
}

/// A member that ended as it should, with its values in the chosen columns.
struct Member {
    values: Vec<f64>,
    /// The rows: each contains its time, or its first number if rows have no time, and then the columns.
    rows: Vec<Vec<f64>>,
}

impl Member {
    fn last(&self, column: usize) -> f64 {
        self.rows.last().map_or(f64::NAN, |row| row[1 + column])
    }
}

/// The picture of finished members.
///
/// # Errors
/// [`SweepError::Drawn`], and [`SweepError::Read`] if members cannot be read.
pub fn picture(
    title: &str,
    sweep_columns: &SweepColumns,
    members: &dyn Records,
    wanted: &[String],
    is_random: bool,
) -> Result<Picture, SweepError> {
    drawn(title, sweep_columns, members, wanted, is_random)
        .map_err(SweepError::Read)?
        .map_err(SweepError::Drawn)
}

fn drawn(
    title: &str,
    sweep_columns: &SweepColumns,
    members: &dyn Records,
    wanted: &[String],
    is_random: bool,
) -> io::Result<Result<Picture, SweepPlotError>> {
    let mut places = match chosen(sweep_columns, wanted) {
        Ok(places) => places,
        Err(error) => return Ok(Err(error)),
    };
    let width = sweep_columns.numbers().len();
    let (mut finished, mut left) = (Vec::new(), 0);
    for record in members.records()? {
        let record = record?;
        sweep_columns.check(&record).map_err(|error| io::Error::new(io::ErrorKind::InvalidData, error))?;
        if !matches!(record.status, Status::Completed | Status::Event) {
            left += 1;
            continue;
        }
        let cells = |row: &[f64]| std::iter::once(row[0]).chain(places.iter().map(|&j| row[j])).collect();
        finished.push(Member {
            rows: record.rows.chunks_exact(width).map(cells).collect(),
            values: record.values,
        });
    }
    let mut remarks = Vec::new();
    if left > 0 {
        remarks.push(format!(
            "{left} of {} members were not completed and are not drawn.",
            left + finished.len()
        ));
    }
    let over_time = finished.iter().any(|member| member.rows.len() > 1);
    let varied: Vec<&str> = sweep_columns.varied().collect();
    let moving: Vec<usize> = (0..varied.len()).filter(|&j| values(&finished, j).len() > 1).collect();
    if let (SweepOf::Linearize, [], &[j], false) = (sweep_columns.of(), wanted, &moving[..], is_random) {
        let rows = finished.iter().filter_map(|member| Some((member.values[j], &member.rows.last()?[1..])));
        if let Some(locus) = locus(rows.collect()) {
            let picture = locus_picture::picture((title, varied[j]), &locus, (None, &[]), Axes::default());
            remarks.extend(picture.remarks);
            return Ok(Ok(Picture { remarks, ..picture }));
        }
    }
    if wanted.is_empty() {
        places = interesting(&mut finished, &places, &mut remarks);
    }
    let names: Vec<String> = places.iter().map(|&j| sweep_columns.numbers()[j].to_owned()).collect();
    let of = sweep_columns.of();
    let panels = match (is_random, over_time, &moving[..]) {
        (true, false, _) => {
            names.iter().enumerate().map(|(k, name)| histogram(&finished, k, name, of)).collect()
        }
        (true, true, _) => names.iter().enumerate().map(|(k, name)| bands(&finished, k, name)).collect(),
        (false, true, [] | [_]) => {
            let label = |member: &Member| match moving.first() {
                Some(&j) => format!("{} = {}", varied[j], short(member.values[j], 4)),
                None => "the member".to_owned(),
            };
            if finished.len() > MOST_MEMBERS {
                remarks.push(format!("{MOST_MEMBERS} of {} members are drawn.", finished.len()));
            }
            names.iter().enumerate().map(|(k, name)| paths(&finished, k, name, &label)).collect()
        }
        (false, false, [] | [_]) => {
            let j = moving.first().copied().unwrap_or(0);
            curves(&finished, j, varied.get(j).copied().unwrap_or_default(), (&names, of))
        }
        (false, _, &[a, b]) => {
            let at = |j| (j, varied[j]);
            names
                .iter()
                .enumerate()
                .map(|(k, name)| cells(&finished, [at(a), at(b)], k, (name, of)))
                .collect()
        }
        (false, _, more) => return Ok(Err(SweepPlotError::Varied { varied: more.len() })),
    };
    Ok(Ok(Picture { title: title.to_owned(), remarks, panels }))
}

/// The columns to show: unless they are chosen, the first few that are not the same in all members.
fn interesting(finished: &mut [Member], places: &[usize], remarks: &mut Vec<String>) -> Vec<usize> {
    let differs = |k: usize| {
        let mut all = finished.iter().flat_map(|member| member.rows.iter().map(move |row| row[1 + k]));
        let first = all.next();
        all.any(|value| Some(value) != first)
    };
    let mut kept: Vec<usize> = (0..places.len()).filter(|&k| differs(k)).collect();
    if kept.is_empty() {
        kept = (0..places.len()).collect();
    }
    if kept.len() > MOST_PANELS {
        let more = kept.len() - MOST_PANELS;
        let are = if more == 1 { "column is" } else { "columns are" };
        remarks.push(format!("{more} more {are} not drawn; --columns chooses what is."));
        kept.truncate(MOST_PANELS);
    }
    for row in finished.iter_mut().flat_map(|member| &mut member.rows) {
        *row = std::iter::once(row[0]).chain(kept.iter().map(|&k| row[1 + k])).collect();
    }
    kept.into_iter().map(|k| places[k]).collect()
}

/// The distinct values of a varied quantity, in order.
fn values(finished: &[Member], j: usize) -> Vec<f64> {
    let mut values: Vec<f64> = finished.iter().map(|member| member.values[j]).collect();
    values.sort_by(f64::total_cmp);
    values.dedup();
    values
}

/// A logarithmic scale if the ratio of successive values is constant, otherwise a linear one.
fn scale_of(values: &[f64]) -> Scale {
    let ratios: Vec<f64> = values.windows(2).map(|pair| pair[1] / pair[0]).collect();
    let even = |ratio: &f64| (ratio - ratios[0]).abs() < 1e-6 * ratios[0];
    let is_logarithmic =
        values.len() > 2 && values[0] > 0.0 && ratios[0] > 1.0 + 1e-3 && ratios.iter().all(even);
    if is_logarithmic { Scale::Decades } else { Scale::Linear }
}

fn placed(value: f64, scale: Scale) -> f64 {
    if scale == Scale::Decades { value.log10() } else { value }
}

/// Curves against the quantity that is varied.
fn curves(finished: &[Member], j: usize, varied: &str, (names, of): (&[String], SweepOf)) -> Vec<Panel> {
    let scale = scale_of(&values(finished, j));
    let curve = |(k, name): (usize, &String)| {
        let mut points: Vec<(f64, f64)> =
            finished.iter().map(|member| (placed(member.values[j], scale), member.last(k))).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        Curve { name: name.clone(), points }
    };
    let curves: Vec<Curve> = names.iter().enumerate().map(curve).collect();
    let span = span(curves.first());
    by_scale((varied, scale), shown(of), &curves).into_iter().map(|panel| Panel { span, ..panel }).collect()
}

/// The range of a curve, if its first and last points differ.
fn span(curve: Option<&Curve>) -> Option<(f64, f64)> {
    let points = &curve?.points;
    let (first, last) = (points.first()?.0, points.last()?.0);
    (first != last).then_some((first.min(last), first.max(last)))
}

/// A column over time, with a curve for each member or, if there are many, for some members chosen at even
/// intervals.
fn paths(finished: &[Member], k: usize, name: &str, label: &dyn Fn(&Member) -> String) -> Panel {
    let count = finished.len().min(MOST_MEMBERS);
    let last = finished.len().saturating_sub(1);
    let curve = |i: usize| {
        let member = &finished[if count > 1 { i * last / (count - 1) } else { 0 }];
        Curve { name: label(member), points: member.rows.iter().map(|row| (row[0], row[1 + k])).collect() }
    };
    Panel::over("t", name, Scale::Linear, (0..count).map(curve).collect())
}

/// A coloured cell for each pair of values.
fn cells(
    finished: &[Member],
    [(a, x), (b, y)]: [(usize, &str); 2],
    k: usize,
    (name, of): (&str, SweepOf),
) -> Panel {
    let (columns, rows) = (values(finished, a), values(finished, b));
    let mut cells = vec![f64::NAN; columns.len() * rows.len()];
    let place = |list: &[f64], value: f64| list.partition_point(|&known| known < value);
    for member in finished {
        let (i, j) = (place(&columns, member.values[a]), place(&rows, member.values[b]));
        cells[i * rows.len() + j] = member.last(k);
    }
    let scales = [scale_of(&columns), scale_of(&rows)];
    let along = |list: &[f64], scale| list.iter().map(|&value| placed(value, scale)).collect();
    Panel {
        up: (y.to_owned(), scales[1]),
        across: (x.to_owned(), scales[0]),
        content: Content::Cells {
            columns: along(&columns, scales[0]),
            rows: along(&rows, scales[1]),
            values: cells,
        },
        ..Panel::over(x, format!("{name}{}", at_the_end(of)), Scale::Linear, Vec::new())
    }
}

/// A histogram of the values of the members, with their quantiles.
fn histogram(finished: &[Member], k: usize, name: &str, of: SweepOf) -> Panel {
    let mut values: Vec<f64> =
        finished.iter().map(|member| member.last(k)).filter(|v| v.is_finite()).collect();
    values.sort_by(f64::total_cmp);
    let marks: Vec<(f64, &str)> =
        QUANTILES.iter().filter_map(|&(part, label)| Some((quantile(&values, part)?, label))).collect();
    let said: Vec<String> =
        marks.iter().map(|(value, label)| format!("{label}: {}", short(*value, 4))).collect();
    Panel {
        content: Content::Bars(bars(&values)),
        events: marks.iter().map(|(value, _)| *value).collect(),
        ..Panel::over(
            name,
            format!("{name}{} of {} members   {}", at_the_end(of), values.len(), said.join(",  ")),
            Scale::Linear,
            Vec::new(),
        )
    }
}

/// Bars of equal width, which is 2 r n^(−1/3) if that is reasonable, where r is the interquartile range
/// [Freedman, Diaconis 1981].
fn bars(sorted: &[f64]) -> Vec<[f64; 3]> {
    let (Some(&low), Some(&high)) = (sorted.first(), sorted.last()) else { return Vec::new() };
    if low == high {
        let half = 0.5 * low.abs().max(1e-3);
        return vec![[low - half, low + half, sorted.len() as f64]];
    }
    let quartile = |part| quantile(sorted, part).unwrap_or(low);
    let width = 2.0 * (quartile(0.75) - quartile(0.25)) / (sorted.len() as f64).cbrt();
    let count = if width > 0.0 { ((high - low) / width).ceil().clamp(6.0, 80.0) } else { 12.0 };
    let step = (high - low) / count;
    let mut bars: Vec<[f64; 3]> =
        (0..count as usize).map(|i| [low + i as f64 * step, low + (i + 1) as f64 * step, 0.0]).collect();
    for value in sorted {
        let i = (((value - low) / step) as usize).min(bars.len() - 1);
        bars[i][2] += 1.0;
    }
    bars
}

/// The quantiles of a column over time, as bands about the median.
fn bands(finished: &[Member], k: usize, name: &str) -> Panel {
    let grid = finished.iter().map(|member| &member.rows).max_by_key(|rows| rows.len());
    let times: Vec<f64> = grid.map_or_else(Vec::new, |rows| rows.iter().map(|row| row[0]).collect());
    let sorted = |(i, t): (usize, &f64)| {
        // A member ended by an event has a last row at another time.
        let here = finished.iter().filter_map(|member| member.rows.get(i)).filter(|row| row[0] == *t);
        let mut values: Vec<f64> = here.map(|row| row[1 + k]).filter(|v| v.is_finite()).collect();
        values.sort_by(f64::total_cmp);
        values
    };
    let sorted: Vec<Vec<f64>> = times.iter().enumerate().map(sorted).collect();
    let at = |part: f64| sorted.iter().map(move |values| quantile(values, part).unwrap_or(f64::NAN));
    let pairs = QUANTILES.iter().zip(QUANTILES.iter().rev()).take(QUANTILES.len() / 2);
    let band = |(&(low, from), &(high, to)): (&(f64, &str), &(f64, &str))| Band {
        name: format!("{from} to {to}"),
        low: at(low).collect(),
        high: at(high).collect(),
    };
    let (median, called) = QUANTILES[QUANTILES.len() / 2];
    let middle = Curve { name: called.to_owned(), points: times.iter().copied().zip(at(median)).collect() };
    let fan = Fan { bands: pairs.map(band).collect(), middle, across: times };
    Panel {
        span: span(Some(&fan.middle)),
        content: Content::Fan(fan),
        ..Panel::over("t", name, Scale::Linear, Vec::new())
    }
}

/// A quantile of sorted values, found by linear interpolation between two of them.
fn quantile(sorted: &[f64], part: f64) -> Option<f64> {
    let place = part * (sorted.len().checked_sub(1)?) as f64;
    let (below, rest) = (place.floor() as usize, place.fract());
    let above = (below + 1).min(sorted.len() - 1);
    Some(sorted[below] + rest * (sorted[above] - sorted[below]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_of_evenly_spaced_values() {
        let values: Vec<f64> = (0..=100).map(f64::from).collect();
        assert_eq!(
            QUANTILES.map(|(part, _)| quantile(&values, part)),
            [5.0, 25.0, 50.0, 75.0, 95.0].map(Some)
        );
        assert_eq!((quantile(&[1.0, 2.0], 0.25), quantile(&[], 0.5)), (Some(1.25), None));
    }

    #[test]
    fn random_members_over_time_are_bands_about_the_median() {
        let member = |i: u32| Member {
            values: Vec::new(),
            rows: (0..3).map(|t| vec![f64::from(t), f64::from(i * t)]).collect(),
        };
        let members: Vec<Member> = (0..=100).map(member).collect();
        let panel = bands(&members, 0, "x");
        let Content::Fan(fan) = &panel.content else { panic!("{panel:?}") };
        let names: Vec<&str> = fan.bands.iter().map(|band| band.name.as_str()).collect();
        assert_eq!(names, ["5 % to 95 %", "25 % to 75 %"]);
        assert_eq!((fan.bands[0].low[2], fan.bands[0].high[2]), (10.0, 190.0));
        assert_eq!(fan.middle.points, [(0.0, 0.0), (1.0, 50.0), (2.0, 100.0)]);
        assert_eq!(panel.span, Some((0.0, 2.0)));
    }

    #[test]
    fn every_value_is_in_one_bar() {
        let values: Vec<f64> = (0..1000).map(|i| f64::from(i * i)).collect();
        let bars = bars(&values);
        assert_eq!(bars.iter().map(|bar| bar[2]).sum::<f64>(), 1000.0);
        assert!((6..=80).contains(&bars.len()) && bars[0][2] > bars[bars.len() - 1][2]);
        assert_eq!(super::bars(&[2.0, 2.0]), [[1.0, 3.0, 2.0]]);
        assert!(super::bars(&[]).is_empty());
    }

    #[test]
    fn ranges_of_equal_ratios_are_logarithmic() {
        assert_eq!(scale_of(&[0.1, 1.0, 10.0]), Scale::Decades);
        for linear in [&[1.0, 2.0, 3.0][..], &[1.0, 10.0], &[-100.0, -10.0, -1.0], &[0.0, 1.0, 10.0]] {
            assert_eq!(scale_of(linear), Scale::Linear, "{linear:?}");
        }
    }
}
