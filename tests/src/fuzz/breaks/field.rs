//! The equations of a specimen, derived here from its terms: Lagrange's, on given sides of all surfaces.

use super::formula::{By, Formula, Place, sum};
use super::specimen::{Part, Specimen};

/// ẏ = f(t, y, σ) with y = (q, q̇, z), from M q̈ = Q.
#[derive(Clone, Debug)]
pub(super) struct Field {
    coordinates: usize,
    /// M row by row.
    masses: Vec<Formula>,
    /// Q = F − ∂(V − T)/∂q − ∂R/∂q̇ − (∂²T/∂q̇∂q) q̇
    forces: Vec<Formula>,
    states: Vec<Formula>,
    pub(super) surfaces: Vec<Formula>,
    /// The surfaces where something changes.
    pub(super) watched: Vec<usize>,
    /// ∂g/∂t, and ∂g/∂y where it is not zero.
    gradients: Vec<(Formula, Vec<(usize, Formula)>)>,
    pub(super) parameters: Vec<f64>,
    /// Added to the rates, to see how the motion answers.
    disturbance: Vec<f64>,
}

/// Where rates are taken.
#[derive(Clone, Copy, Debug)]
pub(super) struct At<'a> {
    pub(super) t: f64,
    pub(super) y: &'a [f64],
    pub(super) inputs: &'a [[f64; 2]],
}

impl Field {
    pub(super) fn of(specimen: &Specimen) -> Field {
        let n = specimen.coordinates.len();
        let surfaces = &specimen.surfaces;
        let by = |formula: &Formula, i: usize| formula.derivative(By::Variable(i), surfaces);
        let all = |part: Part| {
            let terms = specimen.terms.iter().filter(move |(of, _)| *of == part);
            sum(terms.map(|(_, term)| term.clone()))
        };
        let (kinetic, potential, dissipation) =
            (all(Part::Kinetic), all(Part::Potential), all(Part::Dissipation));
        let momenta: Vec<Formula> = (0..n).map(|i| by(&kinetic, n + i)).collect();
        let masses = momenta.iter().flat_map(|p| (0..n).map(|j| by(p, n + j))).collect();
        let forces = (0..n).map(|i| {
            let carried = (0..n).map(|j| by(&momenta[i], j).times(Formula::Variable(n + j)).minus());
            let given = [all(Part::Force(i)), by(&kinetic, i), by(&potential, i).minus()];
            sum(given.into_iter().chain([by(&dissipation, n + i).minus()]).chain(carried))
        });
        let forces: Vec<Formula> = forces.collect();
        let states: Vec<Formula> = specimen.states.iter().map(|z| z.rate.clone()).collect();
        let mut marked = vec![false; surfaces.len()];
        forces.iter().chain(&states).for_each(|formula| formula.mark(surfaces, &mut marked));
        let size = 2 * n + states.len();
        let gradient = |g: &Formula| {
            let slopes = (0..size).map(|i| (i, by(g, i)));
            let slopes = slopes.filter(|(_, slope)| *slope != Formula::Number(0.0));
            (g.derivative(By::Time, surfaces), slopes.collect())
        };
        Field {
            coordinates: n,
            masses,
            forces,
            states,
            watched: (0..surfaces.len()).filter(|&k| marked[k]).collect(),
            gradients: surfaces.iter().map(gradient).collect(),
            surfaces: surfaces.clone(),
            parameters: specimen.values(),
            disturbance: vec![0.0; size],
        }
    }

    /// The same with this added to the rates.
    pub(super) fn disturbed(&self, disturbance: Vec<f64>) -> Field {
        Field { disturbance, ..self.clone() }
    }

    /// The same with a parameter moved.
    pub(super) fn with_parameter(&self, j: usize, value: f64) -> Field {
        let mut moved = self.clone();
        moved.parameters[j] = value;
        moved
    }

    fn place<'a>(&'a self, at: At<'a>, sides: &'a [f64]) -> Place<'a> {
        let At { t, y, inputs } = at;
        Place { t, y, inputs, sides, parameters: &self.parameters, surfaces: &self.surfaces }
    }

    /// f on these sides.
    pub(super) fn rates(&self, at: At<'_>, sides: &[f64]) -> Vec<f64> {
        let (n, place) = (self.coordinates, self.place(at, sides));
        let mut matrix: Vec<f64> = self.masses.iter().map(|mass| mass.value(place)).collect();
        let mut accelerations: Vec<f64> = self.forces.iter().map(|force| force.value(place)).collect();
        solve(&mut matrix, &mut accelerations);
        let states = self.states.iter().map(|rate| rate.value(place));
        let rates = at.y[n..2 * n].iter().copied().chain(accelerations).chain(states);
        rates.zip(&self.disturbance).map(|(rate, more)| rate + more).collect()
    }

    /// g of a surface.
    pub(super) fn function(&self, k: usize, at: At<'_>, sides: &[f64]) -> f64 {
        self.surfaces[k].value(self.place(at, sides))
    }

    /// ∂g/∂t + ∇g·f for these rates f.
    pub(super) fn normal(&self, k: usize, at: At<'_>, sides: &[f64], rates: &[f64]) -> f64 {
        let (place, (by_time, slopes)) = (self.place(at, sides), &self.gradients[k]);
        by_time.value(place) + slopes.iter().map(|(i, slope)| slope.value(place) * rates[*i]).sum::<f64>()
    }
}

/// Solves a small system by elimination with row pivots; no numbers where it is singular.
pub(super) fn solve(matrix: &mut [f64], right: &mut [f64]) {
    let n = right.len();
    for column in 0..n {
        let size = |row: usize, matrix: &[f64]| matrix[row * n + column].abs();
        let pivot = (column..n).max_by(|&a, &b| size(a, matrix).total_cmp(&size(b, matrix)));
        let pivot = pivot.unwrap_or(column);
        for k in 0..n {
            matrix.swap(column * n + k, pivot * n + k);
        }
        right.swap(column, pivot);
        for row in column + 1..n {
            let factor = matrix[row * n + column] / matrix[column * n + column];
            for k in column..n {
                matrix[row * n + k] -= factor * matrix[column * n + k];
            }
            right[row] -= factor * right[column];
        }
    }
    for row in (0..n).rev() {
        let known: f64 = (row + 1..n).map(|k| matrix[row * n + k] * right[k]).sum();
        right[row] = (right[row] - known) / matrix[row * n + row];
    }
}
