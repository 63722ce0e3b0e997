//! Derivatives of a pendulum's motion by its length, its drag and its start, and the gradient of
//! one functional by the adjoint equations.
//!
//! Writes t, φ and the derivatives of φ as CSV to standard output, and the gradient of the mean of
//! φ² to standard error.

use std::error::Error;

use pc_solve::{
    AdjointOptions, Failure, Functional, Options, Sensitivities, Solve, VectorField, adjoint_gradient,
};

/// φ̈ = −(g/l) sin φ − c φ̇, of parameters l and c.
#[derive(Clone, Copy)]
struct Pendulum {
    length: f64,
    drag: f64,
}

const GRAVITY: f64 = 9.81;

impl VectorField for Pendulum {
    fn dim(&self) -> usize {
        2
    }

    fn rhs(&mut self, _t: f64, y: &[f64], rate: &mut [f64]) -> Result<(), Failure> {
        rate[0] = y[1];
        rate[1] = -GRAVITY / self.length * y[0].sin() - self.drag * y[1];
        Ok(())
    }

    fn has_jacobian(&self) -> bool {
        true
    }

    fn jacobian(&mut self, _t: f64, y: &[f64], jacobian: &mut [f64]) -> Result<(), Failure> {
        jacobian.copy_from_slice(&[0.0, -GRAVITY / self.length * y[0].cos(), 1.0, -self.drag]);
        Ok(())
    }

    fn parameters_len(&self) -> usize {
        2
    }

    fn has_parameter_jacobian(&self) -> bool {
        true
    }

    fn parameter_jacobian(&mut self, _t: f64, y: &[f64], jacobian: &mut [f64]) -> Result<(), Failure> {
        jacobian.copy_from_slice(&[0.0, GRAVITY / self.length.powi(2) * y[0].sin(), 0.0, -y[1]]);
        Ok(())
    }
}

/// G = 1/T ∫ φ² dt
struct MeanSquare {
    time: f64,
}

impl Functional for MeanSquare {
    fn density(&mut self, _t: f64, y: &[f64], by_y: &mut [f64], by_p: &mut [f64]) -> Result<f64, Failure> {
        by_y.copy_from_slice(&[2.0 * y[0] / self.time, 0.0]);
        by_p.fill(0.0);
        Ok(y[0] * y[0] / self.time)
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let pendulum = Pendulum { length: 1.0, drag: 0.1 };
    let (start, end) = ([1.0, 0.0], 10.0);
    let times: Vec<f64> = (0..=100).map(|i| end * f64::from(i) / 100.0).collect();

    let wanted = Sensitivities::new().by_parameters(0..2).by_start(0);
    let motion =
        Solve::new(pendulum, 0.0, &start).method(&Options::default()).sensitivities(&wanted).run(&times)?;
    println!("t,phi,by_length,by_drag,by_start");
    for (t, y, by) in motion.trajectory.iter() {
        println!("{t},{},{},{},{}", y[0], by[0], by[2], by[4]);
    }

    let options = AdjointOptions::new(Options::default());
    let gradient = adjoint_gradient(pendulum, MeanSquare { time: end }, 0.0, &start, end, &options)?;
    eprintln!(
        "mean square {}, by length {}, by drag {}, by start {}",
        gradient.value, gradient.by_parameters[0], gradient.by_parameters[1], gradient.by_start[0]
    );
    Ok(())
}
