//! A motion with what it makes of small disturbances, and its derivatives by differences.

use super::field::Field;
use super::formula::{Formula, Place};
use super::motion::{Motion, follow};
use super::skip::Skip;
use super::specimen::Specimen;
use crate::fuzz::random::Random;

/// The disturbances, of the sizes of the components over the whole time: larger than any error that is looked for.
const DISTURBANCE: f64 = 1e-6;
/// In so many directions, both ways.
const DIRECTIONS: usize = 2;
/// What disturbances may grow to: more leaves no digits to compare.
const GROWTH: f64 = 3e3;
/// Steps of differences, of a parameter or of 0.3.
const STEP: f64 = 5e-5;

/// A motion that is known.
#[derive(Clone, Debug)]
pub(super) struct Reference {
    pub(super) motion: Motion,
    /// The largest value of each component.
    pub(super) sizes: Vec<f64>,
    /// What a disturbance has grown to until each row, over all components: at least 1.
    pub(super) growth: Vec<f64>,
    /// For each parameter asked for, by rows.
    pub(super) derivatives: Vec<Vec<Option<Slope>>>,
}

/// A derivative of all components, and how far it may be wrong.
#[derive(Clone, Debug)]
pub(super) struct Slope {
    pub(super) values: Vec<f64>,
    pub(super) doubt: Vec<f64>,
}

impl Reference {
    /// What the errors between two passages come to until a row.
    pub(super) fn errors(&self, row: usize) -> f64 {
        self.growth[row] * (1 + self.motion.passed[row]) as f64
    }
}

pub(super) fn reference(specimen: &Specimen) -> Result<Reference, Skip> {
    let (field, times) = (Field::of(specimen), specimen.times());
    let motion = moved(specimen, &field)?;
    let sizes = sizes(&motion);
    let mut growth: Vec<f64> = vec![1.0; times.len()];
    let mut random = Random::new(0, specimen.parameters.len() as u64);
    for _ in 0..DIRECTIONS {
        let signs = sizes.iter().map(|size| size * if random.chance(50) { 1.0 } else { -1.0 });
        let direction: Vec<f64> = signs.map(|size| size * DISTURBANCE / specimen.t_end).collect();
        for way in [1.0, -1.0] {
            let disturbance = direction.iter().map(|part| way * part).collect();
            let disturbed = moved(specimen, &field.disturbed(disturbance));
            let disturbed = disturbed.map_err(|_| Skip::Unstable)?;
            if !same_passages(&motion, &disturbed) {
                return Err(Skip::Unstable);
            }
            let mut largest = 1.0;
            for (row, growth) in growth.iter_mut().enumerate() {
                let apart = motion.rows[row].iter().zip(&disturbed.rows[row]).zip(&sizes);
                let apart = apart.map(|((a, b), size)| (a - b).abs() / (size * DISTURBANCE));
                largest = apart.fold(largest, f64::max);
                *growth = growth.max(largest);
            }
        }
    }
    if growth.iter().any(|&growth| growth > GROWTH) {
        return Err(Skip::Unstable);
    }
    let derivatives = specimen.asked.iter().map(|&j| differences(specimen, &field, &motion, j)).collect();
    Ok(Reference { motion, sizes, growth, derivatives })
}

fn moved(specimen: &Specimen, field: &Field) -> Result<Motion, Skip> {
    let at = Place { t: 0.0, y: &[], parameters: &field.parameters, inputs: &[], sides: &[], surfaces: &[] };
    let value = |formula: &Formula| formula.value(at);
    let starts = specimen.coordinates.iter().map(|x| value(&x.start));
    let speeds = specimen.coordinates.iter().map(|x| value(&x.speed));
    let states = specimen.states.iter().map(|z| value(&z.start));
    let start: Vec<f64> = starts.chain(speeds).chain(states).collect();
    follow(field, &specimen.tables, &start, &specimen.times())
}

/// At least a hundredth of the largest of all.
fn sizes(motion: &Motion) -> Vec<f64> {
    let dim = motion.rows[0].len();
    let size = |i: usize| motion.rows.iter().fold(0.0, |size: f64, row| size.max(row[i].abs()));
    let sizes: Vec<f64> = (0..dim).map(size).collect();
    let largest = sizes.iter().fold(1e-3, |largest: f64, size| largest.max(*size));
    sizes.into_iter().map(|size| size.max(0.01 * largest)).collect()
}

fn same_passages(a: &Motion, b: &Motion) -> bool {
    let sides = |motion: &Motion| motion.passages.iter().map(|p| p.sides.clone()).collect::<Vec<_>>();
    sides(a) == sides(b)
}

/// Differences of order 4 of motions over the same passages; none of rows that have a passage beside them.
fn differences(specimen: &Specimen, field: &Field, motion: &Motion, j: usize) -> Vec<Option<Slope>> {
    let step = STEP * field.parameters[j].abs().max(0.3);
    let at = |steps: f64| {
        let moved = moved(specimen, &field.with_parameter(j, field.parameters[j] + steps * step));
        moved.ok().filter(|moved| same_passages(motion, moved))
    };
    let motions: Option<Vec<Motion>> = [1.0, -1.0, 2.0, -2.0].map(at).into_iter().collect();
    let Some(motions) = motions else { return vec![None; motion.rows.len()] };
    (0..motion.rows.len())
        .map(|row| {
            let same = motions.iter().all(|moved| moved.passed[row] == motion.passed[row]);
            same.then(|| {
                let of = |i: usize| motions.iter().map(|moved| moved.rows[row][i]).collect::<Vec<f64>>();
                let slopes = (0..motion.rows[row].len()).map(|i| {
                    let y = of(i);
                    let (near, far) = ((y[0] - y[1]) / (2.0 * step), (y[2] - y[3]) / (4.0 * step));
                    (near + (near - far) / 3.0, (near - far) / 3.0)
                });
                let (values, corrections): (Vec<f64>, Vec<f64>) = slopes.unzip();
                // The next term of the expansion is smaller by as much again; a large correction says that there is no such
                // expansion, as beside a passage that is hardly one.
                let doubt = corrections.iter().zip(&values).map(|(correction, value)| {
                    let part = correction.abs() / value.abs().max(1e-3);
                    correction.abs() * (100.0 * part).min(1.0) + 1e-11 / step
                });
                Slope { doubt: doubt.collect(), values }
            })
        })
        .collect()
}
