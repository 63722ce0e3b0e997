//! A field of several pieces, written by hand.

use std::sync::Arc;

use pc_expr::{Program, Sliding, Switching};
use pc_solve::{Failure, TimeDependence, VectorField};

/// f on given sides (t, y, p, sides, ẏ).
type Rates = fn(f64, &[f64], &[f64], &[f64], &mut [f64]);
/// g of (t, y, p).
pub(crate) type Function = fn(f64, &[f64], &[f64]) -> f64;

/// ẏ = f on the sides of surfaces, with derivatives by difference quotients.
#[derive(Clone)]
pub(crate) struct Pieces {
    dim: usize,
    pub(crate) parameters: Vec<f64>,
    rates: Rates,
    functions: Vec<Function>,
    names: Vec<String>,
    sides: Option<Vec<f64>>,
    /// Evaluations of f.
    pub(crate) evaluations: usize,
}

impl Pieces {
    pub(crate) fn new(dim: usize, parameters: &[f64], rates: Rates, functions: &[Function]) -> Pieces {
        Pieces {
            dim,
            parameters: parameters.to_vec(),
            rates,
            functions: functions.to_vec(),
            names: (0..functions.len()).map(|k| format!("g{k}")).collect(),
            sides: None,
            evaluations: 0,
        }
    }

    fn quotient(&mut self, out: &mut [f64], mut at: impl FnMut(&mut Pieces, f64, &mut [f64])) {
        let mut values = vec![0.0; out.len()];
        out.fill(0.0);
        for (steps, weight) in WEIGHTS {
            at(self, steps * STEP, &mut values);
            out.iter_mut().zip(&values).for_each(|(out, value)| *out += weight / STEP * value);
        }
    }
}

/// The derivative of a function of one step.
fn slope(function: impl Fn(f64) -> f64) -> f64 {
    WEIGHTS.iter().map(|(steps, weight)| weight / STEP * function(steps * STEP)).sum()
}

/// Difference quotients of order 4.
const WEIGHTS: [(f64, f64); 4] =
    [(1.0, 8.0 / 12.0), (-1.0, -8.0 / 12.0), (2.0, -1.0 / 12.0), (-2.0, 1.0 / 12.0)];
const STEP: f64 = 1e-3;

impl VectorField for Pieces {
    fn dim(&self) -> usize {
        self.dim
    }

    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        self.evaluations += 1;
        match self.sides.clone() {
            Some(sides) if sides.contains(&0.0) => {
                ydot.copy_from_slice(&Sliding::of(self, &sides, t, y)?.rates);
            }
            Some(sides) => (self.rates)(t, y, &self.parameters, &sides, ydot),
            None => {
                let sides: Vec<f64> =
                    self.functions.iter().map(|g| g(t, y, &self.parameters).signum()).collect();
                (self.rates)(t, y, &self.parameters, &sides, ydot);
            }
        }
        Ok(())
    }

    fn has_jvp(&self) -> bool {
        true
    }

    fn jvp(&mut self, t: f64, y: &[f64], v: &[f64], product: &mut [f64]) -> Result<(), Failure> {
        self.quotient(product, |field, step, out| {
            let moved: Vec<f64> = y.iter().zip(v).map(|(y, v)| y + step * v).collect();
            field.rhs(t, &moved, out).unwrap();
        });
        Ok(())
    }

    fn parameters_len(&self) -> usize {
        self.parameters.len()
    }

    fn has_parameter_jacobian(&self) -> bool {
        true
    }

    fn parameter_jacobian(&mut self, t: f64, y: &[f64], jacobian: &mut [f64]) -> Result<(), Failure> {
        for j in 0..self.parameters.len() {
            let value = self.parameters[j];
            self.quotient(&mut jacobian[j * self.dim..(j + 1) * self.dim], |field, step, out| {
                field.parameters[j] = value + step;
                field.rhs(t, y, out).unwrap();
            });
            self.parameters[j] = value;
        }
        Ok(())
    }

    fn time_dependence(&self) -> TimeDependence {
        TimeDependence::Absent
    }

    fn switching(&mut self) -> Option<&mut dyn Switching> {
        Some(self)
    }
}

impl Switching for Pieces {
    fn surfaces(&self) -> &[String] {
        &self.names
    }

    fn hold(&mut self, sides: Option<&[f64]>) {
        self.sides = sides.map(<[f64]>::to_vec);
    }

    fn held(&self) -> Option<&[f64]> {
        self.sides.as_deref()
    }

    fn functions(&mut self, t: f64, y: &[f64], values: &mut [f64]) {
        for (value, g) in values.iter_mut().zip(&self.functions) {
            *value = g(t, y, &self.parameters);
        }
    }

    fn rates(&mut self, sides: &[f64], t: f64, y: &[f64], rates: &mut [f64]) -> Result<(), Failure> {
        self.evaluations += 1;
        (self.rates)(t, y, &self.parameters, sides, rates);
        Ok(())
    }

    fn gradient(&mut self, surface: usize, t: f64, y: &[f64], by_state: &mut [f64]) -> f64 {
        let (g, p) = (self.functions[surface], &self.parameters);
        let moved = |i: usize, step: f64| {
            let mut moved = y.to_vec();
            moved[i] += step;
            moved
        };
        for (i, by) in by_state.iter_mut().enumerate() {
            *by = slope(|step| g(t, &moved(i, step), p));
        }
        slope(|step| g(t + step, y, p))
    }

    fn by_parameter(&mut self, surface: usize, parameter: usize, t: f64, y: &[f64]) -> Option<f64> {
        let moved = |step: f64| {
            let mut moved = self.parameters.clone();
            moved[parameter] += step;
            moved
        };
        Some(slope(|step| self.functions[surface](t, y, &moved(step))))
    }

    fn time_dependence(&self) -> TimeDependence {
        TimeDependence::Absent
    }

    fn program(&self) -> Option<(&Arc<Program>, &[f64])> {
        None
    }
}
