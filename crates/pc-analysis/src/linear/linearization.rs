//! A motion near a state, to first order.

use pc_mech::{Matrix, VectorField};

use crate::error::{AnalysisError, shape};
use crate::linear::leaf::Velocities;
use crate::linear::linearizer::{Evaluated, Linearizer};
use crate::linear::modes::{Mode, modes};
use crate::linear::second_order::{NoSecondOrder, Parts, Reduced, SecondOrder};
use crate::numeric::dense::{norm, product};
use crate::stability::spectrum::Spectrum;
use crate::stability::steady_motion::{SteadyOptions, errors, first_approximation};

/// δẏ = A δy + B δu, δh = C δy + D δu for small deviations of the reduced state: independent coordinates of
/// the states that satisfy the constraints, independent quasi-velocities, and first-order states. Deviations
/// of inputs are measured from their present values.
#[derive(Clone, Debug, PartialEq)]
pub struct Linearization {
    /// Time.
    pub t: f64,
    /// The whole state, with the names of its components.
    pub state: Vec<(String, f64)>,
    /// Whether all rates except those of cyclic coordinates vanish.
    pub is_steady: bool,
    /// √Σ f_i² over the components that are not cyclic.
    pub residual: f64,
    /// The Euclidean distance from the requested state.
    pub distance: f64,
    /// The names of the r components of the reduced state.
    pub components: Vec<String>,
    /// E in δy = E δ(reduced): all components of the state in terms of these r, to first order.
    pub extension: Matrix<f64>,
    /// The cyclic coordinates that are left out, with their rates.
    pub cyclic: Vec<(String, f64)>,
    /// A, r × r.
    pub state_matrix: Matrix<f64>,
    /// The names of the inputs.
    pub inputs: Vec<String>,
    /// B.
    pub input_matrix: Matrix<f64>,
    /// The names of the outputs that have derivatives at the state and depend on no coordinate that is left out.
    pub outputs: Vec<String>,
    /// Their values at the state.
    pub output_values: Vec<f64>,
    /// C.
    pub output_matrix: Matrix<f64>,
    /// D.
    pub feedthrough: Matrix<f64>,
    /// The names of the other outputs.
    pub other_outputs: Vec<String>,
    /// The eigenvalues of A.
    pub spectrum: Spectrum,
    /// Its eigenvectors.
    pub modes: Vec<Mode>,
    /// M q̈ + G q̇ + K q = F u.
    pub second_order: Result<SecondOrder, NoSecondOrder>,
    /// The uncertainty of a steady state, relative to 1 + |y|.
    pub(super) uncertainty: f64,
}

/// The cyclic coordinates that are components of the reduced state.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum CyclicCoordinates {
    /// No cyclic coordinates: stability is judged without them.
    #[default]
    LeftOut,
    /// The cyclic coordinates that are at rest and unaffected by moving ones; without the other cyclic
    /// coordinates the equations have constant coefficients.
    KeptAtRest,
}

/// A rate counts as zero up to this fraction of |∂f/∂y| (1 + |y|).
const AT_REST: f64 = 1e-12;

impl Linearizer {
    /// The linearization at the equilibrium or steady motion near a state, found by Newton's method; cyclic
    /// coordinates are left out.
    ///
    /// # Errors
    /// [`AnalysisError::NoSteadyMotion`] with the residual; [`AnalysisError::DependsOnTime`];
    /// [`AnalysisError::LeafUnknown`].
    pub fn steady(
        &mut self,
        t: f64,
        guess: &[f64],
        options: &SteadyOptions,
    ) -> Result<Linearization, AnalysisError> {
        self.steady_with(t, guess, options, CyclicCoordinates::LeftOut)
    }

    /// As [`steady`](Linearizer::steady), with a choice of the cyclic coordinates that are included.
    ///
    /// # Errors
    /// As there.
    pub fn steady_with(
        &mut self,
        t: f64,
        guess: &[f64],
        options: &SteadyOptions,
        cyclic: CyclicCoordinates,
    ) -> Result<Linearization, AnalysisError> {
        let found = self.find(t, guess, options)?;
        let left_out = match cyclic {
            CyclicCoordinates::LeftOut => self.cyclic.clone(),
            CyclicCoordinates::KeptAtRest => self.moving(t, &found.state)?,
        };
        let mut result = self.put_together(t, &found.state, &left_out, Some(found.uncertainty))?;
        let steps = found.state.iter().zip(guess).map(|(y, guess)| y - guess);
        result.distance = norm(&steps.collect::<Vec<_>>());
        Ok(result)
    }

    /// The linearization at a state that satisfies the constraints, steady or not, restricted to such states; it
    /// includes all cyclic coordinates. The reduced state is the deviation from the solution that passes
    /// through this state.
    ///
    /// # Errors
    /// [`ShapeError`](pc_mech::ShapeError); the errors of [`rhs`](pc_mech::VectorField::rhs) if f is not defined.
    pub fn at(&mut self, t: f64, state: &[f64]) -> Result<Linearization, AnalysisError> {
        shape("the state", state.len(), self.names().len())?;
        let rates = self.motion.rates(t, state)?;
        let jacobian = first_approximation(&mut self.motion, t, state)?;
        let enough = AT_REST * norm(&jacobian.entries()) * (1.0 + norm(state));
        let varying = self.varying();
        let kept = (0..state.len()).filter(|i| !self.cyclic.contains(i) && !varying.contains(i));
        let residual = norm(&kept.map(|i| rates[i]).collect::<Vec<_>>());
        let is_steady = !self.depends_on_time() && residual <= enough;
        self.put_together(t, state, &[], is_steady.then_some(0.0))
    }

    /// The number of components that the reduced state has near a state, without the cyclic coordinates or with all of
    /// them.
    ///
    /// # Errors
    /// [`ShapeError`](pc_mech::ShapeError); the errors of [`rhs`](pc_mech::VectorField::rhs) if f is not defined.
    pub fn components(
        &mut self,
        t: f64,
        state: &[f64],
        cyclic: CyclicCoordinates,
    ) -> Result<usize, AnalysisError> {
        shape("the state", state.len(), self.names().len())?;
        let is_left_out = |i: &usize| cyclic == CyclicCoordinates::LeftOut && self.cyclic.contains(i);
        let kept: Vec<usize> = (0..self.sizes.coordinates).filter(|i| !is_left_out(i)).collect();
        let reduced = self.evaluated(t, state)?.reduced(&kept, self.sizes.coordinates, state.len())?;
        Ok(reduced.kept.len())
    }

    /// The cyclic coordinates that move, and those whose rates depend on moving ones.
    fn moving(&mut self, t: f64, state: &[f64]) -> Result<Vec<usize>, AnalysisError> {
        let rates = self.motion.rates(t, state)?;
        let jacobian = first_approximation(&mut self.motion, t, state)?;
        let enough = AT_REST * norm(&jacobian.entries()) * (1.0 + norm(state));
        let mut moving: Vec<usize> =
            self.cyclic.iter().copied().filter(|&i| rates[i].abs() > enough).collect();
        loop {
            let acted_on = self.acted_on(&moving);
            let more: Vec<usize> = acted_on.into_iter().filter(|i| !moving.contains(i)).collect();
            if more.is_empty() {
                moving.sort_unstable();
                return Ok(moving);
            }
            moving.extend(more);
        }
    }

    /// The names of the cyclic coordinates whose rates vary in a steady motion, since cyclic coordinates act on them: the place
    /// of a wheel that rolls in a circle.
    pub fn varying_rates(&self) -> Vec<String> {
        self.acted_on(&self.cyclic).into_iter().map(|i| self.names()[i].clone()).collect()
    }

    /// The cyclic coordinates whose rates depend on these components.
    fn acted_on(&self, by: &[usize]) -> Vec<usize> {
        let pattern = self.motion.sparsity();
        let acts_on = |i: usize| by.iter().any(|&j| pattern.is_none_or(|all| all.column(j).contains(&i)));
        self.cyclic.iter().copied().filter(|&i| acts_on(i)).collect()
    }

    /// The linearization at a state without the coordinates `left_out`; for a steady state, with the relative `uncertainty` of
    /// its components.
    pub(super) fn put_together(
        &mut self,
        t: f64,
        state: &[f64],
        left_out: &[usize],
        uncertainty: Option<f64>,
    ) -> Result<Linearization, AnalysisError> {
        let evaluated = self.evaluated(t, state)?;
        let rates = self.motion.rates(t, state)?;
        let uncertain = uncertainty.unwrap_or(0.0);
        let noise = errors(&mut self.motion, (t, state), &self.units, &evaluated.jacobian, uncertain);
        let (n, all) = (self.sizes.coordinates, state.len());
        let coordinates: Vec<usize> = (0..n).filter(|i| !left_out.contains(i)).collect();
        let reduced = evaluated.reduced(&coordinates, n, all)?;
        let Evaluated { jacobian, by_inputs, output_values, outputs, outputs_by_inputs, .. } = &evaluated;
        let Reduced { kept, extension, .. } = &reduced;
        let r = kept.len();
        let moved = product(jacobian, extension);
        let state_matrix = Matrix::from_fn(r, r, |i, j| moved[(kept[i], j)]);
        let input_matrix = Matrix::from_fn(r, by_inputs.columns(), |i, j| by_inputs[(kept[i], j)]);

        let is_smooth = |o: usize| {
            let slopes =
                outputs.row(o).iter().chain(outputs_by_inputs.row(o).iter()).all(|slope| slope.is_finite());
            slopes && output_values[o].is_finite()
        };
        let is_own = |&o: &usize| is_smooth(o) && left_out.iter().all(|&x| outputs[(o, x)] == 0.0);
        let (own, others): (Vec<usize>, Vec<usize>) = (0..outputs.rows()).partition(is_own);
        let seen = product(outputs, extension);
        let name = |o: &usize| self.outputs()[*o].clone();

        let varying = self.varying();
        let is_constant = |i: &usize| !self.cyclic.contains(i) && !varying.contains(i);
        let resting: Vec<f64> = (0..all).filter(is_constant).map(|i| rates[i]).collect();
        let residual = norm(&resting);
        let scale = norm(&jacobian.entries()) * (1.0 + norm(state));
        let is_steady = uncertainty.is_some();
        // Errors of rows are carried by the directions.
        let moved_noise = product(&noise, &extension.map(f64::abs));
        let noise = Matrix::from_fn(r, r, |i, j| moved_noise[(kept[i], j)]);
        let spectrum = Spectrum::with_noise(&state_matrix, &noise)?;
        let named = |i: &usize| (self.names()[*i].clone(), rates[*i]);
        Ok(Linearization {
            t,
            state: self.names().iter().cloned().zip(state.iter().copied()).collect(),
            is_steady,
            residual,
            distance: 0.0,
            components: kept.iter().map(|&i| self.names()[i].clone()).collect(),
            extension: extension.clone(),
            cyclic: left_out.iter().map(named).collect(),
            modes: modes(&state_matrix, &spectrum)?,
            second_order: self.second_order(&evaluated, &rates, scale, is_steady)?,
            inputs: self.inputs(),
            input_matrix,
            outputs: own.iter().map(name).collect(),
            output_values: own.iter().map(|&o| output_values[o]).collect(),
            output_matrix: Matrix::from_fn(own.len(), r, |i, j| seen[(own[i], j)]),
            feedthrough: Matrix::from_fn(own.len(), outputs_by_inputs.columns(), |i, j| {
                outputs_by_inputs[(own[i], j)]
            }),
            other_outputs: others.iter().map(name).collect(),
            state_matrix,
            spectrum,
            uncertainty: uncertain,
        })
    }

    /// The equations of the second order in the coordinates that are not cyclic and as many cyclic ones as
    /// are needed.
    fn second_order(
        &self,
        evaluated: &Evaluated,
        rates: &[f64],
        scale: f64,
        is_steady: bool,
    ) -> Result<Result<SecondOrder, NoSecondOrder>, AnalysisError> {
        if !is_steady {
            return Ok(Err(NoSecondOrder::NotSteady));
        }
        let Some(mass) = &evaluated.mass else { return Ok(Err(NoSecondOrder::LargeTree)) };
        let others: Vec<usize> = (0..self.sizes.coordinates).filter(|i| !self.cyclic.contains(i)).collect();
        let reduced = evaluated.reduced(&others, self.sizes.coordinates, self.names().len())?;
        let moving: Vec<usize> =
            self.cyclic.iter().copied().filter(|&i| rates[i].abs() > AT_REST * scale).collect();
        let parts = Parts {
            names: self.names(),
            quasi_velocities: self.quasi_velocities(),
            jacobian: &evaluated.jacobian,
            moved: &product(&evaluated.jacobian, &reduced.extension),
            by_inputs: &evaluated.by_inputs,
            mass,
            cyclic: &self.cyclic,
            acted_on: &self.acted_on(&moving),
            reduced: &reduced,
        };
        Ok(parts.second_order())
    }
}

impl Evaluated {
    /// The reduced state that uses only these of the n coordinates, for a state of `all` components.
    fn reduced(&self, coordinates: &[usize], n: usize, all: usize) -> Result<Reduced, AnalysisError> {
        let chart = self.directions.chart(coordinates)?;
        let Velocities { independent, of_independent, of_coordinates } = &self.velocities;
        let (d, l, k) = (chart.independent.len(), independent.len(), of_independent.rows());
        let of_place = |i: usize, j: usize| match coordinates.iter().position(|&x| x == i) {
            Some(row) if j < d => chart.of_independent[(row, j)],
            _ => 0.0,
        };
        let of_velocity = |s: usize, j: usize| match j.checked_sub(d) {
            None => (0..n).map(|i| of_coordinates[(s, i)] * of_place(i, j)).sum(),
            Some(j) if j < l => of_independent[(s, j)],
            Some(_) => 0.0,
        };
        let entry = |i: usize, j: usize| match i.checked_sub(n) {
            None => of_place(i, j),
            Some(s) if s < k => of_velocity(s, j),
            Some(state) => f64::from(u8::from(j == d + l + state - k)),
        };
        let extension = Matrix::from_fn(all, d + l + all - n - k, entry);
        let velocities = independent.iter().map(|s| n + s);
        let kept = chart.independent.iter().copied().chain(velocities).chain(n + k..all).collect();
        Ok(Reduced { kept, coordinates: d, velocities: l, extension })
    }
}
