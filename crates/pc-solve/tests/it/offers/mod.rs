//! Fields that offer only some of their derivatives.

use pc_solve::{Failure, Method, Options, VectorField};

/// What a field offers for (∂f/∂y) v.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Offer {
    Products,
    Jacobian,
    Neither,
}

pub(crate) const OFFERS: [Offer; 3] = [Offer::Products, Offer::Jacobian, Offer::Neither];

/// A field with products, Jacobian and parameters, of which it offers the parameters and the given
/// choice.
#[derive(Clone, Debug)]
pub(crate) struct Offering<F>(pub(crate) F, pub(crate) Offer);

/// A system given by its formulas.
pub(crate) trait Formulas {
    const DIM: usize;
    const PARAMETERS: usize;
    fn rhs(&self, t: f64, y: &[f64], rate: &mut [f64]);
    fn jacobian(&self, t: f64, y: &[f64], jacobian: &mut [f64]);
    fn by_parameters(&self, t: f64, y: &[f64], jacobian: &mut [f64]);
}

impl<F: Formulas> VectorField for Offering<F> {
    fn dim(&self) -> usize {
        F::DIM
    }
    fn rhs(&mut self, t: f64, y: &[f64], rate: &mut [f64]) -> Result<(), Failure> {
        self.0.rhs(t, y, rate);
        Ok(())
    }
    fn has_jacobian(&self) -> bool {
        self.1 == Offer::Jacobian
    }
    fn jacobian(&mut self, t: f64, y: &[f64], jacobian: &mut [f64]) -> Result<(), Failure> {
        assert_eq!(self.1, Offer::Jacobian);
        self.0.jacobian(t, y, jacobian);
        Ok(())
    }
    fn has_jvp(&self) -> bool {
        self.1 == Offer::Products
    }
    fn jvp(&mut self, t: f64, y: &[f64], v: &[f64], product: &mut [f64]) -> Result<(), Failure> {
        assert_eq!(self.1, Offer::Products);
        let mut jacobian = vec![0.0; F::DIM * F::DIM];
        self.0.jacobian(t, y, &mut jacobian);
        for (i, product) in product.iter_mut().enumerate() {
            *product = (0..F::DIM).map(|j| jacobian[i + j * F::DIM] * v[j]).sum();
        }
        Ok(())
    }
    fn parameters_len(&self) -> usize {
        F::PARAMETERS
    }
    fn has_parameter_jacobian(&self) -> bool {
        F::PARAMETERS > 0
    }
    fn parameter_jacobian(&mut self, t: f64, y: &[f64], jacobian: &mut [f64]) -> Result<(), Failure> {
        self.0.by_parameters(t, y, jacobian);
        Ok(())
    }
}

/// Damped oscillator ẍ = −ω² x − 2c ẋ, of parameters c and ω.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Oscillator {
    pub(crate) damping: f64,
    pub(crate) frequency: f64,
}

impl Formulas for Oscillator {
    const DIM: usize = 2;
    const PARAMETERS: usize = 2;
    fn rhs(&self, _t: f64, y: &[f64], rate: &mut [f64]) {
        rate[0] = y[1];
        rate[1] = -self.frequency.powi(2) * y[0] - 2.0 * self.damping * y[1];
    }
    fn jacobian(&self, _t: f64, _y: &[f64], jacobian: &mut [f64]) {
        jacobian.copy_from_slice(&[0.0, -self.frequency.powi(2), 1.0, -2.0 * self.damping]);
    }
    fn by_parameters(&self, _t: f64, y: &[f64], jacobian: &mut [f64]) {
        jacobian.copy_from_slice(&[0.0, -2.0 * y[1], 0.0, -2.0 * self.frequency * y[0]]);
    }
}

impl Oscillator {
    /// (x, ẋ) at t from (a, b) at 0, in closed form.
    pub(crate) fn motion(&self, t: f64, a: f64, b: f64) -> [f64; 2] {
        let Oscillator { damping, frequency } = *self;
        let omega = (frequency.powi(2) - damping.powi(2)).sqrt();
        let (sin, cos) = (omega * t).sin_cos();
        let decay = (-damping * t).exp();
        let q = (b + damping * a) / omega;
        let x = decay * (a * cos + q * sin);
        [x, decay * omega * (q * cos - a * sin) - damping * x]
    }
}

/// A plane pendulum with quadratic drag, φ̈ = −p₀ sin φ − p₁ φ̇ |φ̇| + p₂ cos t: linear in p only.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pendulum(pub(crate) [f64; 3]);

impl Formulas for Pendulum {
    const DIM: usize = 2;
    const PARAMETERS: usize = 3;
    fn rhs(&self, t: f64, y: &[f64], rate: &mut [f64]) {
        let p = self.0;
        rate[0] = y[1];
        rate[1] = -p[0] * y[0].sin() - p[1] * y[1] * y[1].abs() + p[2] * t.cos();
    }
    fn jacobian(&self, _t: f64, y: &[f64], jacobian: &mut [f64]) {
        jacobian.copy_from_slice(&[0.0, -self.0[0] * y[0].cos(), 1.0, -2.0 * self.0[1] * y[1].abs()]);
    }
    fn by_parameters(&self, t: f64, y: &[f64], jacobian: &mut [f64]) {
        jacobian.copy_from_slice(&[0.0, -y[0].sin(), 0.0, -y[1] * y[1].abs(), 0.0, t.cos()]);
    }
}

/// A pendulum of unit length and weight in Cartesian coordinates, which notes the largest distance
/// from the circle at which it is linearised.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Circle {
    pub(crate) farthest: f64,
}

impl VectorField for Circle {
    fn dim(&self) -> usize {
        4
    }
    fn rhs(&mut self, _t: f64, y: &[f64], rate: &mut [f64]) -> Result<(), Failure> {
        let pull = (y[2] * y[2] + y[3] * y[3] - y[1]) / (y[0] * y[0] + y[1] * y[1]);
        rate.copy_from_slice(&[y[2], y[3], -pull * y[0], -1.0 - pull * y[1]]);
        Ok(())
    }
    fn has_jvp(&self) -> bool {
        true
    }
    fn jvp(&mut self, _t: f64, y: &[f64], v: &[f64], product: &mut [f64]) -> Result<(), Failure> {
        self.farthest = self.farthest.max((y[0].hypot(y[1]) - 1.0).abs());
        let square = y[0] * y[0] + y[1] * y[1];
        let pull = (y[2] * y[2] + y[3] * y[3] - y[1]) / square;
        let change = (2.0 * (y[2] * v[2] + y[3] * v[3]) - v[1]) / square
            - 2.0 * pull * (y[0] * v[0] + y[1] * v[1]) / square;
        product.copy_from_slice(&[v[2], v[3], -pull * v[0] - change * y[0], -pull * v[1] - change * y[1]]);
        Ok(())
    }
    fn has_projection(&self) -> bool {
        true
    }
    fn project(&mut self, _t: f64, y: &mut [f64]) -> Result<(), Failure> {
        let length = y[0].hypot(y[1]);
        let (x, z) = (y[0] / length, y[1] / length);
        let along = x * y[3] - z * y[2];
        y.copy_from_slice(&[x, z, -along * z, along * x]);
        Ok(())
    }
}

/// A difference quotient of order 4, accurate to 1e-12 with steps of 1e-3 for functions without
/// large derivatives.
pub(crate) fn derivative(of: impl Fn(f64) -> f64, at: f64) -> f64 {
    let step = 1e-3;
    let slope = |step: f64| (of(at + step) - of(at - step)) / (2.0 * step);
    (4.0 * slope(step) - slope(2.0 * step)) / 3.0
}

/// Both methods with tolerances of 1e-11 and 1e-13; the local errors of some hundred steps add up
/// to 1e-9.
pub(crate) fn precise() -> [Options; 2] {
    [Method::Adams, Method::Bdf]
        .map(|method| Options::new(method).relative_tolerance(1e-11).absolute_tolerance(1e-13))
}
