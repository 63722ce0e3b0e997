//! Groups of curves that one scale shows well.

use crate::picture::axes::{is_still, range};
use crate::picture::panel::{Curve, Panel, Scale};

/// A curve looks flat on an axis whose range is more than this many times the range of the curve.
const RATIO: f64 = 12.0;
/// The largest number of curves that share axes.
const MOST_CURVES: usize = 6;
/// Ranges up to this fraction of the largest value are attributed to rounding errors.
const ROUNDING: f64 = 1e-13;

/// Curves over a common quantity, in as few panels as are needed to show each of them well.
pub fn by_scale((across, scale): (&str, Scale), title: &str, curves: &[Curve]) -> Vec<Panel> {
    let values: Vec<Vec<f64>> =
        curves.iter().map(|curve| curve.points.iter().map(|&(_, value)| value).collect()).collect();
    let panel = |group: Vec<usize>| {
        let curves = group.into_iter().map(|j| curves[j].clone()).collect();
        let panel = Panel::over(across, title, Scale::Linear, curves);
        Panel { across: (across.to_owned(), scale), ..panel }
    };
    groups(&values).into_iter().map(panel).collect()
}

/// Groups of lists of values, given by their indices, the widest range first, such that each list varies
/// visibly and no group has more curves than can be distinguished.
pub(super) fn groups(lists: &[Vec<f64>]) -> Vec<Vec<usize>> {
    let ranges: Vec<Option<(f64, f64)>> = lists.iter().map(|list| range(list.iter().copied())).collect();
    let size = |&(low, high): &(f64, f64)| low.abs().max(high.abs());
    let largest = ranges.iter().flatten().map(size).fold(0.0, f64::max);
    let moves = |r: &Option<(f64, f64)>| {
        r.is_some_and(|(low, high)| !is_still(low, high) && high - low > ROUNDING * largest)
    };
    let span = |j: usize| ranges[j].map_or(0.0, |(low, high)| high - low);
    let mut moving: Vec<usize> = (0..lists.len()).filter(|&j| moves(&ranges[j])).collect();
    moving.sort_by(|&a, &b| span(b).total_cmp(&span(a)).then(a.cmp(&b)));
    let mut groups: Vec<((f64, f64), Vec<usize>)> = Vec::new();
    for j in moving {
        let Some(own) = ranges[j] else { continue };
        let least = |group: &[usize]| group.iter().map(|&k| span(k)).fold(span(j), f64::min);
        let fits = groups.iter_mut().find(|(all, group)| {
            let (low, high) = union(*all, own);
            high - low <= RATIO * least(group)
        });
        match fits {
            Some((all, group)) => {
                *all = union(*all, own);
                group.push(j);
            }
            None => groups.push((own, vec![j])),
        }
    }
    // A constant needs no range: it joins the narrowest group that contains it, or nearly does.
    let still: Vec<usize> = (0..lists.len()).filter(|&j| !moves(&ranges[j])).collect();
    let mut apart: Vec<usize> = Vec::new();
    for j in still {
        let Some(own) = ranges[j] else {
            apart.push(j);
            continue;
        };
        let near = groups.iter_mut().rev().find(|(all, _)| {
            let (low, high) = union(*all, own);
            high - low <= 1.3 * (all.1 - all.0)
        });
        match near {
            Some((_, group)) => group.push(j),
            None => apart.push(j),
        }
    }
    let mut groups: Vec<Vec<usize>> = groups.into_iter().map(|(_, group)| group).collect();
    groups.extend((!apart.is_empty()).then_some(apart));
    groups.iter_mut().for_each(|group| group.sort_unstable());
    groups.iter().flat_map(|group| group.chunks(MOST_CURVES).map(<[usize]>::to_vec)).collect()
}

fn union(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    (a.0.min(b.0), a.1.max(b.1))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn about(middle: f64, size: f64) -> Vec<f64> {
        vec![middle, middle + size, middle - size]
    }

    #[test]
    fn a_large_coordinate_does_not_flatten_a_small_one() {
        let lists = [about(0.0, 0.01), about(0.0, 200.0), about(0.0, 0.0), about(0.0, 30.0)];
        assert_eq!(groups(&lists), [vec![1, 3], vec![0, 2]]);
        // Nor does a curve with a small change at a large value.
        assert_eq!(groups(&[about(100.0, 100.0), about(150.0, 0.5)]), [vec![0], vec![1]]);
    }

    #[test]
    fn rounding_takes_no_room() {
        assert_eq!(groups(&[about(0.0, 1.0), about(0.0, 1e-15), about(0.5, 1e-14)]), [vec![0, 1, 2]]);
        assert_eq!(groups(&[about(7.0, 0.0), about(0.0, 0.0)]), [vec![0, 1]]);
        assert_eq!(groups(&[vec![f64::NAN; 3]]), [vec![0]]);
        assert!(groups(&[]).is_empty());
    }

    #[test]
    fn groups_have_no_more_curves_than_can_be_distinguished() {
        let lists: Vec<Vec<f64>> = (0..13).map(|_| about(0.0, 1.0)).collect();
        assert_eq!(groups(&lists).iter().map(Vec::len).collect::<Vec<_>>(), [6, 6, 1]);
    }
}
