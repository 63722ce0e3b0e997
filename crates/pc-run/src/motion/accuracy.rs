//! What is known of the accuracy of a motion: its rows once more, from a companion and from states that are rounded
//! differently.

use pc_mech::VectorField;
use pc_model::Flow;
use pc_solve::{ErrorEstimate, Solution};

use crate::motion::estimate::why;
use crate::motion::table::Table;
use crate::plan::tolerances::Tolerances;

/// The part of a value that some dozens of operations may change by rounding.
pub(crate) const ROUNDING: f64 = 1e-14;
/// Of its absolute tolerance, the part of a component that its motion does not resolve.
const UNRESOLVED: f64 = 1e-3;
/// The weights of the components in the direction of the rounding errors, used in turn: no weight is a sum of others, so that
/// the changes of no common expression cancel.
const WEIGHTS: [f64; 5] = [1.0, -0.77, 0.59, -0.91, 0.68];

/// The rows of a motion once more, which tell how accurate functions of its columns are.
///
/// The error of such a function is its distance from the same function of the row of the companion. What rounding alone
/// changes is its distance from the functions of the rows of rounded states: large where large terms cancel.
#[derive(Clone, Debug, PartialEq)]
pub struct Accuracy {
    /// The rows of the companion, as far as they are known.
    pub beside: Table,
    /// The rows of the states with rounding errors added, and with the same errors subtracted.
    pub rounded: [Table; 2],
    /// The times of the events of the companion.
    pub events: Vec<f64>,
    /// The reason why later rows have no companion, if there is one.
    pub incomplete: Option<String>,
}

impl Accuracy {
    /// What the companion of a motion and its own states say of it.
    pub(crate) fn of(
        estimate: &ErrorEstimate,
        flow: &mut Flow,
        (motion, tolerances): (&Solution, &Tolerances),
    ) -> Accuracy {
        let mut largest = vec![0.0f64; flow.motion.dim()];
        for (_, y) in motion.trajectory.iter() {
            largest.iter_mut().zip(y).for_each(|(largest, value)| *largest = largest.max(value.abs()));
        }
        let errors: Vec<f64> = (largest.iter().zip(tolerances.values()).zip(WEIGHTS.iter().cycle()))
            .map(|((largest, tolerance), weight)| weight * (ROUNDING * largest + UNRESOLVED * tolerance))
            .collect();
        let mut rounded = |sign: f64| {
            let state = |(t, y): (f64, &[f64])| {
                (t, y.iter().zip(&errors).map(|(value, error)| value + sign * error).collect())
            };
            Table::of_states(flow, motion.trajectory.iter().map(state))
        };
        let rounded = [rounded(1.0), rounded(-1.0)];
        let beside = estimate.beside().iter().take(estimate.len()).map(|(t, y)| (t, y.to_vec()));
        Accuracy {
            beside: Table::of_states(flow, beside),
            rounded,
            events: estimate.occurrences().iter().map(|occurrence| occurrence.time).collect(),
            incomplete: (estimate.len() < motion.trajectory.len()).then(|| why(estimate, flow)),
        }
    }
}
