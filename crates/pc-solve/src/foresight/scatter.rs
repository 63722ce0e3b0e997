//! Functions of time that are noise to a method.

use crate::foresight::SURPRISE;

/// Places at which the field is looked at.
const PLACES: usize = 16;

/// Whether f scatters between a time and one `near` by, by what a step of this `length` would feel: its second differences are
/// large, of which what is smooth has none so near.
///
/// `rates` writes f at a part of the way, and the tolerances of the state there; false where it has no value, which the
/// method will meet.
pub(crate) fn scatters(
    dim: usize,
    length: f64,
    mut rates: impl FnMut(f64, &mut [f64], &mut [f64]) -> bool,
) -> bool {
    let mut rows: [Vec<f64>; 3] = std::array::from_fn(|_| vec![0.0; dim]);
    let mut tolerances = vec![0.0; dim];
    let mut largest = 0.0f64;
    for place in 0..=PLACES {
        rows.rotate_left(1);
        let [first, second, third] = &mut rows;
        if !rates(place as f64 / PLACES as f64, third, &mut tolerances) {
            return false;
        }
        if place < 2 {
            continue;
        }
        for i in 0..dim {
            let difference = third[i] - 2.0 * second[i] + first[i];
            largest = largest.max((0.25 * difference / tolerances[i]).abs());
        }
    }
    length * largest > SURPRISE
}
