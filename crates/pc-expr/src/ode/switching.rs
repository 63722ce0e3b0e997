//! Piecewise vector fields.

use std::sync::Arc;

use crate::ode::failure::Failure;
use crate::ode::sliding_range::SlidingRange;
use crate::program::program::Program;
use crate::time_profile::profile::TimeDependence;

/// A vector field that changes from one smooth piece to the next on surfaces g(t, y, p) = 0, on which it jumps or
/// has a corner.
///
/// An integrator holds the field on one side of each surface during a step, so that f is smooth along the step, ends
/// the step where a surface is reached, and decides there how the motion continues: on the other side, or along the
/// surface if f leads back to it from both sides.
///
/// A side is 1 or −1, the sign of g, or 0 while the motion slides along the surface.
pub trait Switching {
    /// The texts of the functions g.
    fn surfaces(&self) -> &[String];

    /// Holds f and its derivatives on these sides, one for each surface, until told otherwise; without sides, f is
    /// given by the signs of g.
    fn hold(&mut self, sides: Option<&[f64]>);

    /// The sides on which f is held.
    fn held(&self) -> Option<&[f64]>;

    /// Writes the functions g, which may jump where another one passes through zero; all of them are evaluated
    /// on the sides held. A function without a value is written as NaN.
    fn functions(&mut self, t: f64, y: &[f64], values: &mut [f64]);

    /// Writes f on these sides, none of them 0.
    ///
    /// # Errors
    /// The same as for [`rhs`](crate::VectorField::rhs).
    fn rates(&mut self, sides: &[f64], t: f64, y: &[f64], rates: &mut [f64]) -> Result<(), Failure>;

    /// The σ for which a motion on a surface stays there. Where this range is wider than from −1 to 1, or has no end, a
    /// motion that comes to the surface also stays there if it could go on beside it.
    fn range(&mut self, _surface: usize, _t: f64, _y: &[f64]) -> SlidingRange {
        SlidingRange::default()
    }

    /// Returns ∂g/∂t of a surface, and writes ∂g/∂y.
    fn gradient(&mut self, surface: usize, t: f64, y: &[f64], by_state: &mut [f64]) -> f64;

    /// ∂g/∂pⱼ of a surface; `None` if it was not derived.
    fn by_parameter(&mut self, surface: usize, parameter: usize, t: f64, y: &[f64]) -> Option<f64>;

    /// The explicit dependence of f on t while f is held.
    fn time_dependence(&self) -> TimeDependence;

    /// The program of the functions g of (t, y) and parameters, with the values of the parameters, if there
    /// is one.
    fn program(&self) -> Option<(&Arc<Program>, &[f64])>;
}
