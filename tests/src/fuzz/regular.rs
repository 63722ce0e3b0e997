//! Whether the frame of a specimen stays regular along a motion, in numbers.

use nalgebra::DMatrix;
use num_dual::Dual64;

use super::execution::Motion;
use super::expression::{Expression, Values};
use super::specimen::{Frame, Restricts, Specimen};
use super::start::Start;

/// How far from zero a coordinate is that has not passed it between two rows.
const MARGIN: f64 = 0.05;

/// The same of a determinant, as a part of what it is at the start.
const DETERMINANT: f64 = 0.1;

/// Whether all coordinates stay positive along a motion in ordinary velocities, since beyond zero roots of them end, and
/// whether definitions and constraints go on to determine the velocities. Where not, no quasi-velocity says how the motion goes on.
pub(super) fn stays_regular(specimen: &Specimen, start: &Start, twin: &Motion) -> bool {
    let place = |name: &String| twin.columns.iter().position(|column| column == name);
    let places: Vec<usize> = specimen.chart.iter().filter_map(|x| place(&x.name)).collect();
    let positive = places.iter().all(|&place| twin.rows.iter().all(|row| row[place] > MARGIN));
    let Frame::Definitions(definitions) = &specimen.frame else { return positive };
    let mut determinants = twin.times.iter().zip(&twin.rows).map(|(&t, row)| {
        let mut values = start.values.clone();
        values.insert("t".to_owned(), Dual64::from(t));
        for (x, &place) in specimen.chart.iter().zip(&places) {
            values.insert(x.name.clone(), Dual64::from(row[place]));
        }
        determinant(specimen, definitions, &values)
    });
    let first = determinants.next().unwrap_or(f64::NAN);
    positive && determinants.all(|determinant| determinant / first > DETERMINANT)
}

/// The determinant of the coefficients of ẋ in the definitions and in the constraints that complete these.
fn determinant(specimen: &Specimen, definitions: &[(String, Expression)], values: &Values) -> f64 {
    let n = specimen.chart.len();
    let column = |i: usize| -> Vec<f64> {
        let mut moving = values.clone();
        for (j, x) in specimen.chart.iter().enumerate() {
            let rate = f64::from(u8::from(i == j));
            let at = moving.get(&x.name).map_or(f64::NAN, |x| x.re);
            moving.insert(x.name.clone(), Dual64::from(at));
            moving.insert(format!("{}'", x.name), Dual64::new(0.0, rate));
        }
        let mut slopes = Vec::with_capacity(n);
        for (name, definition) in definitions {
            let value = definition.value(&moving);
            slopes.push(value.eps);
            moving.insert(name.clone(), value);
        }
        for constraint in specimen.constraints.iter().take(n - definitions.len()) {
            if constraint.restricts == Restricts::Positions {
                let x = &specimen.chart[i].name;
                let at = moving.get(x).map_or(f64::NAN, |x| x.re);
                moving.insert(x.clone(), Dual64::new(at, 1.0));
            }
            slopes.push(constraint.expression.value(&moving).eps);
        }
        slopes
    };
    let columns: Vec<Vec<f64>> = (0..n).map(column).collect();
    if columns.iter().any(|column| column.len() != n) {
        return f64::NAN;
    }
    DMatrix::from_fn(n, n, |i, j| columns[j][i]).determinant()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fuzz::generator;
    use crate::fuzz::specimen::Coordinate;

    #[test]
    fn definitions_that_become_dependent_are_not_a_frame() {
        let mut specimen = generator::empty();
        let coordinate = |name: &str| Coordinate { name: name.to_owned(), start: 0.5, shown: true };
        specimen.chart = vec![coordinate("x"), coordinate("y")];
        specimen.velocities = vec![0.3, -0.2];
        let parsed = |text: &str| Expression::parse(text).expect("an expression");
        // The determinant is 1 - x y.
        let definitions = vec![("w1", "x' + y*y'"), ("w2", "y' + x*x'")];
        let definitions = definitions.into_iter().map(|(name, is)| (name.to_owned(), parsed(is))).collect();
        specimen.frame = Frame::Definitions(definitions);
        let start = Start::of(&specimen).expect("a start");
        let along = |rows: Vec<Vec<f64>>| Motion {
            columns: vec!["x".to_owned(), "y".to_owned()],
            times: (0..rows.len()).map(|i| i as f64).collect(),
            rows,
            happenings: Vec::new(),
            moved: None,
            residual: None,
        };
        assert!(stays_regular(&specimen, &start, &along(vec![vec![0.5, 0.5], vec![0.6, 0.7]])));
        assert!(!stays_regular(&specimen, &start, &along(vec![vec![0.5, 0.5], vec![1.5, 0.7]])));
        assert!(!stays_regular(&specimen, &start, &along(vec![vec![0.5, 0.5], vec![0.02, 0.7]])));
    }
}
