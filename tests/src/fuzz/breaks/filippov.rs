//! How a motion goes on from surfaces. [Filippov 1988]
//!
//! On each surface that it has reached it may go on on one side, where the normal rate leads away, or along it, by the σ in (-1, 1)
//! with which all normal rates along the surfaces that are kept vanish. One choice that is consistent is the way on.

use super::field::{At, Field, solve};
use super::skip::Skip;

/// A normal rate, or the distance of σ from ±1, that is nearer to zero says nothing.
const CERTAIN: f64 = 1e-6;
/// What the normal rates that vanish may be, of the largest on the sides: rounding.
const VANISHES: f64 = 1e-9;
/// More surfaces are not decided on.
const MOST: usize = 4;

/// The rates where the surfaces of side 0 are kept, with σ of these.
pub(super) fn combined(field: &Field, at: At<'_>, sides: &[f64]) -> Result<(Vec<f64>, Vec<f64>), Skip> {
    let kept: Vec<usize> = (0..sides.len()).filter(|&k| sides[k] == 0.0).collect();
    if kept.is_empty() {
        return Ok((field.rates(at, sides), sides.to_vec()));
    }
    let normals = |rates: &[f64], sides: &[f64]| -> Vec<f64> {
        kept.iter().map(|&k| field.normal(k, at, sides, rates)).collect()
    };
    let middle = normals(&field.rates(at, sides), sides);
    let mut columns = Vec::new();
    for &k in &kept {
        let mut moved = sides.to_vec();
        moved[k] = 1.0;
        let normals = normals(&field.rates(at, &moved), &moved);
        columns.push(normals.iter().zip(&middle).map(|(a, b)| a - b).collect::<Vec<f64>>());
    }
    let count = kept.len();
    let mut matrix: Vec<f64> =
        (0..count).flat_map(|row| columns.iter().map(move |column| column[row])).collect();
    let size = matrix.iter().chain(&middle).fold(0.0, |size: f64, entry| size.max(entry.abs()));
    let mut sigma: Vec<f64> = middle.iter().map(|normal| -normal).collect();
    solve(&mut matrix, &mut sigma);
    let mut all = sides.to_vec();
    kept.iter().zip(&sigma).for_each(|(&k, &sigma)| all[k] = sigma);
    let rates = field.rates(at, &all);
    // Where f is no sum of what each surface changes, σ is not found so.
    let left = normals(&rates, &all).iter().fold(0.0, |left: f64, normal| left.max(normal.abs()));
    let between = sigma.iter().all(|sigma| sigma.abs() <= 1.0);
    if between && left > VANISHES * size { Err(Skip::Undecided) } else { Ok((rates, all)) }
}

/// The sides after the surfaces `reached`, of which those of side 0 were kept before.
pub(super) fn decide(field: &Field, at: At<'_>, sides: &[f64], reached: &[usize]) -> Result<Vec<f64>, Skip> {
    if reached.len() > MOST {
        return Err(Skip::Undecided);
    }
    let mut found = None;
    for choice in 0..3usize.pow(u32::try_from(reached.len()).unwrap_or(0)) {
        let mut candidate = sides.to_vec();
        for (place, &k) in reached.iter().enumerate() {
            candidate[k] = [1.0, -1.0, 0.0][choice / 3usize.pow(u32::try_from(place).unwrap_or(0)) % 3];
        }
        if is_consistent(field, at, &candidate, reached)? && found.replace(candidate).is_some() {
            return Err(Skip::Undecided);
        }
    }
    found.ok_or(Skip::Undecided)
}

/// Whether all normal rates lead away, or σ lies between the sides; doubt counts only where nothing else excludes the choice.
fn is_consistent(field: &Field, at: At<'_>, candidate: &[f64], reached: &[usize]) -> Result<bool, Skip> {
    let (rates, all) = combined(field, at, candidate)?;
    let mut margin = f64::INFINITY;
    for &k in reached {
        let of = match candidate[k] {
            0.0 if all[k].is_finite() => 1.0 - all[k].abs(),
            0.0 => return Ok(false),
            side => side * field.normal(k, at, &all, &rates),
        };
        margin = margin.min(of);
    }
    if margin.is_nan() {
        Ok(false)
    } else if margin.abs() < CERTAIN {
        Err(Skip::Grazes)
    } else {
        Ok(margin > 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fuzz::breaks::formula::Formula;
    use crate::fuzz::breaks::specimen::{Coordinate, Part, Specimen};

    /// ẍ = push - sign(ẋ)
    fn block(push: f64) -> Field {
        let (zero, speed) = (Formula::Number(0.0), Formula::Variable(1));
        Field::of(&Specimen {
            coordinates: vec![Coordinate { name: "x".to_owned(), start: zero.clone(), speed: zero }],
            surfaces: vec![speed.clone()],
            terms: vec![
                (Part::Kinetic, speed.squared().half()),
                (Part::Force(0), Formula::Sign(0).minus().plus(Formula::Number(push))),
            ],
            ..Specimen::default()
        })
    }

    #[test]
    fn a_block_sticks_until_it_is_pushed_harder() {
        let at = At { t: 0.0, y: &[0.0, 0.0], inputs: &[] };
        for (push, side) in [(0.4, 0.0), (1.5, 1.0), (-1.5, -1.0)] {
            assert_eq!(decide(&block(push), at, &[1.0], &[0]), Ok(vec![side]));
        }
        assert_eq!(decide(&block(1.0), at, &[1.0], &[0]), Err(Skip::Grazes));
        assert_eq!(combined(&block(0.4), at, &[0.0]), Ok((vec![0.0, 0.0], vec![0.4])));
    }
}
