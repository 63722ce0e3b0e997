//! The numbers of a linearization, as named arrays.

use pc_analysis::{Linearization, RootLocus};

use crate::table::array::Array;

/// A missing number.
const NONE: (f64, f64) = (f64::NAN, f64::NAN);

/// The arrays `state`, `A`, `B`, `C`, `D`, `eigenvalues` and `modes` (as columns), and `M`, `G`, `K`, `F` where
/// they are defined.
pub(crate) fn of_linearization(linear: &Linearization) -> Vec<Array> {
    let eigenvalues: Vec<Vec<(f64, f64)>> =
        linear.spectrum.eigenvalues().iter().map(|value| vec![(value.real, value.imaginary)]).collect();
    let component = |i: usize| -> Vec<(f64, f64)> {
        linear.modes.iter().map(|mode| mode.vector.as_ref().map_or(NONE, |vector| vector[i])).collect()
    };
    let modes: Vec<Vec<(f64, f64)>> = (0..linear.components.len()).map(component).collect();
    let mut all = vec![
        Array::column("state", linear.state.iter().map(|&(_, value)| value)),
        Array::of("A", &linear.state_matrix),
        Array::of("B", &linear.input_matrix),
        Array::of("C", &linear.output_matrix),
        Array::of("D", &linear.feedthrough),
        Array { is_list: true, ..Array::complex("eigenvalues", &eigenvalues) },
        Array::complex("modes", &modes),
    ];
    if let Ok(second) = &linear.second_order {
        let matrices =
            [("M", &second.mass), ("G", &second.velocity), ("K", &second.stiffness), ("F", &second.input)];
        all.extend(matrices.map(|(name, matrix)| Array::of(name, matrix)));
    }
    all
}

/// The arrays `values` of the parameter and `eigenvalues`, with a row for each value and a column for each
/// branch.
pub(crate) fn of_locus(locus: &RootLocus) -> Vec<Array> {
    let row = |i: usize| -> Vec<(f64, f64)> {
        let branches = locus.branches().iter();
        branches.map(|branch| branch[i].map_or(NONE, |value| (value.real, value.imaginary))).collect()
    };
    let rows: Vec<Vec<(f64, f64)>> = (0..locus.values().len()).map(row).collect();
    vec![Array::column("values", locus.values().iter().copied()), Array::complex("eigenvalues", &rows)]
}
