//! Whether a frame determines the brackets of its operators, in numbers.

use nalgebra::DMatrix;
use num_dual::Dual64;

use super::expression::{Expression, Values};
use super::random::Random;
use super::specimen::{Frame, Specimen};

/// Points at which the fields are stacked: more than fields.
const POINTS: usize = 12;

/// Singular values below this part of the largest are zeros of rounding.
const RANK: f64 = 1e-9;

/// Whether a combination of the fields X_s, with constant coefficients that are not all zero, vanishes everywhere: it may
/// be added to any bracket.
pub(super) fn dependent_over_constants(specimen: &Specimen) -> bool {
    let Frame::Group { eta, velocities, .. } = &specimen.frame else { return false };
    let rows = specimen.chart.iter().zip(velocities).filter(|(x, _)| x.shown).map(|(_, row)| row);
    let rows: Vec<&Expression> = rows.chain(specimen.carried.iter().map(|c| &c.velocity)).collect();
    if rows.is_empty() {
        return true;
    }
    let mut random = Random::new(0, 0);
    let mut stacked = DMatrix::zeros(POINTS * rows.len(), eta.len());
    for point in 0..POINTS {
        let mut values = Values::new();
        values.insert("t".to_owned(), Dual64::from(random.number(0.0, 1.0)));
        for (name, value) in &specimen.parameters {
            values.insert(name.clone(), Dual64::from(*value));
        }
        for x in &specimen.chart {
            values.insert(x.name.clone(), Dual64::from(random.number(0.2, 1.2)));
        }
        for carried in &specimen.carried {
            values.insert(carried.name.clone(), carried.value.value(&values));
        }
        eta.iter().for_each(|eta| _ = values.insert(eta.clone(), Dual64::from(0.0)));
        let at_rest: Vec<f64> = rows.iter().map(|row| row.value(&values).re).collect();
        for (s, name) in eta.iter().enumerate() {
            values.insert(name.clone(), Dual64::from(1.0));
            for (i, row) in rows.iter().enumerate() {
                stacked[(point * rows.len() + i, s)] = row.value(&values).re - at_rest[i];
            }
            values.insert(name.clone(), Dual64::from(0.0));
        }
    }
    let decomposed = stacked.svd(false, false);
    decomposed.rank(RANK * decomposed.singular_values.max()) < eta.len()
}
