//! The visible points of a curve.

/// The greatest distance of the curve from the lines between the points that are kept, in points of the
/// drawing.
const TOLERANCE: f64 = 0.05;
/// The width within which only the ends and extremes of a curve are visible.
const COLUMN: f64 = 1.0;

/// Fewer points with the same appearance: at most `most`, or up to twice as many if the curve has many turns.
pub(super) fn simplified(points: &[[f64; 2]], most: usize) -> Vec<[f64; 2]> {
    let onwards = points.windows(2).all(|pair| pair[0][0] <= pair[1][0])
        || points.windows(2).all(|pair| pair[0][0] >= pair[1][0]);
    let (mut column, mut tolerance) = (COLUMN, TOLERANCE);
    loop {
        let seen = if onwards { extremes(points, column) } else { points.to_vec() };
        let few = straightened(&seen, tolerance);
        // A coarser curve would look different.
        if few.len() <= most || tolerance > 40.0 * TOLERANCE {
            return few;
        }
        (column, tolerance) = (1.5 * column, 2.0 * tolerance);
    }
}

/// The first, the lowest, the highest and the last of the points in each column.
fn extremes(points: &[[f64; 2]], width: f64) -> Vec<[f64; 2]> {
    let mut kept = Vec::new();
    for column in points.chunk_by(|a, b| (a[0] / width).floor() == (b[0] / width).floor()) {
        if column.len() <= 4 {
            kept.extend_from_slice(column);
            continue;
        }
        let by_value = |a: &usize, b: &usize| column[*a][1].total_cmp(&column[*b][1]);
        let last = column.len() - 1;
        let (low, high) = ((0..=last).min_by(by_value), (0..=last).max_by(by_value));
        let mut places = [0, low.unwrap_or(0), high.unwrap_or(0), last];
        places.sort_unstable();
        kept.extend(
            places
                .iter()
                .enumerate()
                .filter(|&(i, p)| i == 0 || places[i - 1] != *p)
                .map(|(_, &p)| column[p]),
        );
    }
    kept
}

/// The points at which the line turns: each line from one kept point to the next passes all points between
/// them to within a tolerance [Williams 1978].
fn straightened(points: &[[f64; 2]], tolerance: f64) -> Vec<[f64; 2]> {
    let Some((&first, rest)) = points.split_first() else { return Vec::new() };
    let mut kept = vec![first];
    let (mut anchor, mut last) = (first, first);
    // The directions from the anchor that pass all points so far, relative to the first of them, and the
    // farthest distance.
    let mut cone: Option<(f64, f64, f64)> = None;
    let mut reach = 0.0;
    for &point in rest {
        let (dx, dy) = (point[0] - anchor[0], point[1] - anchor[1]);
        let distance = dx.hypot(dy);
        let fits = match cone {
            _ if distance <= tolerance => reach <= tolerance,
            None => true,
            Some((about, low, high)) => {
                let turn = turned(dy.atan2(dx) - about);
                distance >= reach - tolerance && (low..=high).contains(&turn)
            }
        };
        if !fits {
            kept.push(last);
            (anchor, cone, reach) = (last, None, 0.0);
        }
        let (dx, dy) = (point[0] - anchor[0], point[1] - anchor[1]);
        let distance = dx.hypot(dy);
        if distance > tolerance {
            let (angle, room) = (dy.atan2(dx), (tolerance / distance).asin());
            cone = Some(match cone {
                None => (angle, -room, room),
                Some((about, low, high)) => {
                    let turn = turned(angle - about);
                    (about, low.max(turn - room), high.min(turn + room))
                }
            });
        }
        reach = f64::max(reach, distance);
        last = point;
    }
    if points.len() > 1 {
        kept.push(last);
    }
    kept
}

/// The angle reduced to the range from −π to π.
fn turned(angle: f64) -> f64 {
    let full = 2.0 * std::f64::consts::PI;
    angle - full * (angle / full).round()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The largest distance of a point from the polyline through the kept points, which are in order.
    fn worst(points: &[[f64; 2]], kept: &[[f64; 2]]) -> f64 {
        let to_piece = |p: [f64; 2], a: [f64; 2], b: [f64; 2]| {
            let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
            let length = dx * dx + dy * dy;
            let along = if length == 0.0 { 0.0 } else { ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / length };
            let along = along.clamp(0.0, 1.0);
            (p[0] - a[0] - along * dx).hypot(p[1] - a[1] - along * dy)
        };
        let nearest =
            |p: [f64; 2]| kept.windows(2).map(|w| to_piece(p, w[0], w[1])).fold(f64::INFINITY, f64::min);
        points.iter().map(|&p| nearest(p)).fold(0.0, f64::max)
    }

    #[test]
    fn few_points_pass_all_of_a_curve() {
        let circle: Vec<[f64; 2]> =
            (0..20_000).map(|i| f64::from(i) * 0.001).map(|t| [100.0 * t.cos(), 100.0 * t.sin()]).collect();
        let kept = simplified(&circle, 4000);
        // An arc of a circle of radius 100 is within 2·0.05 of a chord that is no longer than √(8·100·0.1) = 9.
        assert!(kept.len() < 600 && worst(&circle, &kept) <= 2.0 * TOLERANCE, "{}", kept.len());
        assert_eq!((kept[0], kept[kept.len() - 1]), (circle[0], circle[19_999]));
        let line: Vec<[f64; 2]> = (0..1000).map(|i| [f64::from(i), 2.0 * f64::from(i)]).collect();
        assert_eq!(simplified(&line, 10), [[0.0, 0.0], [999.0, 1998.0]]);
        // A path there and back.
        let way = [[0.0, 0.0], [10.0, 0.0], [5.0, 0.0], [5.0, 3.0]];
        assert_eq!(simplified(&way, 10), way);
    }

    #[test]
    fn no_peak_is_lost() {
        let mut points: Vec<[f64; 2]> =
            (0..100_000).map(|i| [f64::from(i) * 0.004, (f64::from(i) * 0.7).sin()]).collect();
        points[31_234][1] = 50.0;
        let kept = simplified(&points, 2000);
        assert!(kept.len() <= 2000 && kept.iter().any(|p| p[1] == 50.0), "{}", kept.len());
        assert!(simplified(&[], 5).is_empty());
        assert_eq!(simplified(&[[1.0, 2.0]], 5), [[1.0, 2.0]]);
    }
}
