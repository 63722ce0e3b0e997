//! Detection of functions of time that look like noise to a method.

use crate::foresight::SURPRISE;

/// The number of intervals between the evaluations of the field.
const PLACES: usize = 16;

/// Whether f scatters between a time and a nearby one, by enough to affect a step of this `length`:
/// its second differences are large, while those of a smooth function vanish at so small a
/// distance.
///
/// `rates` writes f at a fraction of the way to the nearby time, and the tolerances of the state
/// there; it returns false if f fails, and handling the failure is left to the method.
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
