//! Start values that satisfy the constraints, found apart from the product.

use nalgebra::{DMatrix, DVector};
use num_dual::Dual64;

use super::comparison::exceeds;
use super::expression::{Expression, Values};
use super::specimen::{Input, Restricts, Specimen};

/// A start that misses the constraints by more is none: it is found to rounding where there is one.
const RESIDUAL: f64 = 1e-12;

/// Singular values below this part of the largest belong to constraints that follow from others.
const RANK: f64 = 1e-9;

/// The values with which a specimen starts.
#[derive(Clone, Debug)]
pub struct Start {
    /// ẋ of the chart.
    pub velocities: Vec<f64>,
    /// Values of everything that has a name, each with its rate of change where it is no velocity.
    pub values: Values,
    /// The value that each constraint keeps, 0 where it is to vanish.
    pub kept: Vec<f64>,
    /// Whether constraints follow from others.
    pub redundant: bool,
}

impl Start {
    /// The start of a specimen, its velocities moved to the nearest that the constraints allow; none where they allow
    /// none, or something has no value.
    pub fn of(specimen: &Specimen) -> Option<Start> {
        let n = specimen.chart.len();
        let linear: Vec<&Expression> = specimen
            .constraints
            .iter()
            .filter(|constraint| constraint.restricts != Restricts::Nonlinearly)
            .map(|constraint| &constraint.expression)
            .collect();
        let positions: Vec<bool> = specimen
            .constraints
            .iter()
            .filter(|constraint| constraint.restricts != Restricts::Nonlinearly)
            .map(|constraint| constraint.restricts == Restricts::Positions)
            .collect();
        let residuals = |velocities: &[f64]| -> Vec<f64> {
            let values = values(specimen, velocities);
            let of = |(f, &position): (&&Expression, &bool)| {
                let value = f.value(&values);
                if position { value.eps } else { value.re }
            };
            linear.iter().zip(&positions).map(of).collect()
        };
        let mut velocities = specimen.velocities.clone();
        velocities.resize(n, 0.0);
        let mut redundant = false;
        if !linear.is_empty() {
            let at_rest = residuals(&vec![0.0; n]);
            let slopes = DMatrix::from_fn(linear.len(), n, |_, _| 0.0);
            let slopes = (0..n).fold(slopes, |mut slopes, i| {
                let unit: Vec<f64> = (0..n).map(|j| f64::from(u8::from(i == j))).collect();
                let column = residuals(&unit).into_iter().zip(&at_rest).map(|(moving, rest)| moving - rest);
                slopes.set_column(i, &DVector::from_iterator(linear.len(), column));
                slopes
            });
            if slopes.iter().any(|slope| !slope.is_finite()) {
                return None;
            }
            let decomposed = slopes.svd(true, true);
            let limit = RANK * decomposed.singular_values.max();
            redundant = decomposed.rank(limit) < linear.len();
            // Twice: what rounding leaves of the first correction is removed by the second.
            for _ in 0..2 {
                let residual = DVector::from_vec(residuals(&velocities));
                let correction = decomposed.solve(&residual, limit).ok()?;
                velocities
                    .iter_mut()
                    .zip(&correction)
                    .for_each(|(velocity, correction)| *velocity -= correction);
            }
            if residuals(&velocities).iter().any(|&residual| exceeds(residual, RESIDUAL)) {
                return None;
            }
        }
        let values = values(specimen, &velocities);
        let kept = specimen
            .constraints
            .iter()
            .map(|constraint| match constraint.restricts {
                Restricts::Velocities => 0.0,
                Restricts::Positions | Restricts::Nonlinearly => constraint.expression.value(&values).re,
            })
            .collect();
        let start = Start { velocities, values, kept, redundant };
        let finite = start.values.values().all(|value| value.re.is_finite() && value.eps.is_finite());
        finite.then_some(start)
    }

    /// The value of a name.
    pub fn value(&self, name: &str) -> f64 {
        self.values.get(name).map_or(f64::NAN, |value| value.re)
    }
}

/// Values of all names at the start with these velocities of the chart.
fn values(specimen: &Specimen, velocities: &[f64]) -> Values {
    let mut values = Values::new();
    values.insert("t".to_owned(), Dual64::new(specimen.t_start, 1.0));
    for (name, value) in &specimen.parameters {
        values.insert(name.clone(), Dual64::from(*value));
    }
    for state in &specimen.states {
        values.insert(state.name.clone(), Dual64::from(state.start));
    }
    for (name, input) in &specimen.inputs {
        // No constraint and no reset has it: any of its values will do.
        let value = match input {
            Input::Constant(value) => *value,
            Input::Table { values, .. } => values.first().copied().unwrap_or(f64::NAN),
        };
        values.insert(name.clone(), Dual64::from(value));
    }
    for (coordinate, &velocity) in specimen.chart.iter().zip(velocities) {
        values.insert(coordinate.name.clone(), Dual64::new(coordinate.start, velocity));
        values.insert(format!("{}'", coordinate.name), Dual64::from(velocity));
    }
    for carried in &specimen.carried {
        let value = carried.value.value(&values);
        values.insert(carried.name.clone(), value);
        values.insert(format!("{}'", carried.name), Dual64::from(value.eps));
    }
    for (name, definition) in specimen.definitions() {
        let value = definition.value(&values);
        values.insert(name, Dual64::from(value.re));
    }
    values
}
