//! Vector fields ẏ = f(t, y), the interface to every integrator.

use crate::forward;
use crate::ode::failure::Failure;
use crate::ode::lane_field::LaneField;
use crate::ode::pattern::Pattern;
use crate::ode::rate_jump::RateJump;
use crate::ode::switching::Switching;
use crate::taylor::coefficients::TaylorSeries;
use crate::time_profile::profile::TimeDependence;
use crate::time_profile::steep::SteepFunctions;

/// A first-order system ẏ = f(t, y) of [`dim`](VectorField::dim) equations.
///
/// This trait is implemented by compiled equations of motion and by users; integrators need nothing else.
pub trait VectorField {
    /// Number of components of y.
    fn dim(&self) -> usize;

    /// Writes f(t, y) to `ydot`; both slices have length [`dim`](VectorField::dim).
    ///
    /// # Errors
    /// [`Failure`] where f is not defined; a recoverable one lets an integrator try a smaller step.
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure>;

    /// Whether [`rhs`](VectorField::rhs) fails where it would write a number that is not finite; if not,
    /// integrators check every number.
    fn checks_rates(&self) -> bool {
        false
    }

    /// Whether [`jacobian`](VectorField::jacobian) is implemented; if not, integrators take difference
    /// quotients.
    fn has_jacobian(&self) -> bool {
        false
    }

    /// Writes ∂f_i/∂y_j to `jacobian[i + j * dim]` (column-major, dim × dim, every entry written).
    ///
    /// Called only if [`has_jacobian`](VectorField::has_jacobian) returns true.
    ///
    /// # Errors
    /// [`Failure`], as for [`rhs`](VectorField::rhs).
    fn jacobian(&mut self, _t: f64, _y: &[f64], _jacobian: &mut [f64]) -> Result<(), Failure> {
        Err(Failure::fatal(NoJacobian))
    }

    /// The zero pattern of ∂f/∂y, dim × dim, if it is known, with or without a Jacobian.
    fn sparsity(&self) -> Option<&Pattern> {
        None
    }

    /// Writes the entries of ∂f/∂y in the pattern [`sparsity`](VectorField::sparsity), in the order of the
    /// pattern.
    ///
    /// Called only if there is a [Jacobian](VectorField::has_jacobian) and a pattern.
    ///
    /// # Errors
    /// [`Failure`], as for [`rhs`](VectorField::rhs).
    fn sparse_jacobian(&mut self, t: f64, y: &[f64], values: &mut [f64]) -> Result<(), Failure> {
        let mut dense = vec![0.0; self.dim() * self.dim()];
        self.jacobian(t, y, &mut dense)?;
        self.sparsity().ok_or_else(|| Failure::fatal(NoPattern))?.gather(&dense, values);
        Ok(())
    }

    /// Whether [`jvp`](VectorField::jvp) is implemented.
    fn has_jvp(&self) -> bool {
        false
    }

    /// Writes the product (∂f/∂y) v to `product`; all slices have length [`dim`](VectorField::dim).
    ///
    /// Called only if [`has_jvp`](VectorField::has_jvp) returns true.
    ///
    /// # Errors
    /// [`Failure`], as for [`rhs`](VectorField::rhs).
    fn jvp(&mut self, _t: f64, _y: &[f64], _v: &[f64], _product: &mut [f64]) -> Result<(), Failure> {
        Err(Failure::fatal(NoProduct))
    }

    /// Whether [`vjp`](VectorField::vjp) is implemented.
    fn has_vjp(&self) -> bool {
        false
    }

    /// Writes the product (∂f/∂y)ᵀ w to `product`; all slices have length [`dim`](VectorField::dim).
    ///
    /// Called only if [`has_vjp`](VectorField::has_vjp) returns true.
    ///
    /// # Errors
    /// [`Failure`], as for [`rhs`](VectorField::rhs).
    fn vjp(&mut self, _t: f64, _y: &[f64], _w: &[f64], _product: &mut [f64]) -> Result<(), Failure> {
        Err(Failure::fatal(NoTransposedProduct))
    }

    /// Number of parameters p of f with respect to which
    /// [`parameter_jacobian`](VectorField::parameter_jacobian) differentiates.
    fn parameters_len(&self) -> usize {
        0
    }

    /// Whether [`parameter_jacobian`](VectorField::parameter_jacobian) is implemented.
    fn has_parameter_jacobian(&self) -> bool {
        false
    }

    /// Writes ∂f_i/∂p_j to `jacobian[i + j * dim]` (column-major, dim × parameters, every entry written).
    ///
    /// Called only if [`has_parameter_jacobian`](VectorField::has_parameter_jacobian) returns true.
    ///
    /// # Errors
    /// [`Failure`], as for [`rhs`](VectorField::rhs).
    fn parameter_jacobian(&mut self, _t: f64, _y: &[f64], _jacobian: &mut [f64]) -> Result<(), Failure> {
        Err(Failure::fatal(NoParameterJacobian))
    }

    /// The scale of parameter `j`, such as |pⱼ|, if it is known: changes are small or large relative to it.
    fn parameter_size(&self, _j: usize) -> Option<f64> {
        None
    }

    /// Whether the states lie on a surface to which f is tangent and from which numerical errors lead away.
    fn has_projection(&self) -> bool {
        false
    }

    /// Moves `y` to the surface of the states at time t, by no more than the error of the method.
    ///
    /// Called only if [`has_projection`](VectorField::has_projection) returns true.
    ///
    /// # Errors
    /// [`Failure`] where no state of the surface is found near `y`.
    fn project(&mut self, _t: f64, _y: &mut [f64]) -> Result<(), Failure> {
        Ok(())
    }

    /// The explicit dependence of f on t, whose features an integrator must not step over. Integrators query
    /// this dependence when an integration begins.
    fn time_dependence(&self) -> TimeDependence {
        TimeDependence::Unknown
    }

    /// The functions of the state in f whose rise and fall a step may miss, with f [held](VectorField::switching)
    /// on one side if possible; `None` if there are no such functions, or if f does not expose them.
    /// Integrators query these functions when an integration begins.
    fn steep_functions(&self) -> Option<SteepFunctions> {
        None
    }

    /// The Taylor series of the motion, ready to be expanded, with the branch functions and the cost of the
    /// series.
    ///
    /// # Errors
    /// [`Failure`] with the reason why there is no series: f has to be a program.
    fn series(&mut self) -> Result<&TaylorSeries, Failure> {
        Err(Failure::fatal(NoSeries))
    }

    /// Expands the motion through y at time t to the given order, at least 1, on the branch of these
    /// [sides](TaylorSeries::expand). Coefficients need not be finite.
    ///
    /// # Errors
    /// [`Failure`] where f is not defined, as for [`rhs`](VectorField::rhs), and where there is no
    /// [series](VectorField::series).
    fn expand(
        &mut self,
        _t: f64,
        _y: &[f64],
        _sides: &[f64],
        _order: usize,
    ) -> Result<&TaylorSeries, Failure> {
        Err(Failure::fatal(NoSeries))
    }

    /// The Taylor series of the [motion with its derivatives](crate::Program::with_variation), one for each of `columns`.
    ///
    /// # Errors
    /// As for [`series`](VectorField::series).
    fn varied_series(&mut self, _columns: &[Option<usize>]) -> Result<&TaylorSeries, Failure> {
        Err(Failure::fatal(NoSeries))
    }

    /// [Expands](VectorField::expand) the motion with its derivatives through `all`, the state and its columns.
    ///
    /// # Errors
    /// As for [`expand`](VectorField::expand).
    fn expand_varied(
        &mut self,
        _columns: &[Option<usize>],
        _t: f64,
        _all: &[f64],
        _sides: &[f64],
        _order: usize,
    ) -> Result<&TaylorSeries, Failure> {
        Err(Failure::fatal(NoSeries))
    }

    /// f as a program for many states at once, with the present parameters; `None` if f is more than a
    /// program, if it is interpreted, or if it has [steep functions](VectorField::steep_functions) or a
    /// [projection](VectorField::has_projection) other than to unit quaternions.
    fn lanes(&mut self) -> Option<LaneField> {
        None
    }

    /// Announces that the motion continues from `y` at time t, a state that it did not reach on its own, such as one
    /// after an impact: conserved quantities may have new values.
    fn restart(&mut self, _t: f64, _y: &[f64]) {}

    /// The times, in ascending order, at which f is not smooth in t, such as those of a table that it reads:
    /// no step crosses such a time.
    fn breaks(&self) -> &[f64] {
        &[]
    }

    /// Announces that the following evaluations are on the side of t towards `end`, where t is a start or a
    /// [break](VectorField::breaks). Returns whether f jumped there, so that a multistep method has to restart.
    fn enter(&mut self, _t: f64, _end: f64) -> bool {
        false
    }

    /// The surfaces on which f changes from one piece to the next, if there are any and f can be held on one side of
    /// each.
    fn switching(&mut self) -> Option<&mut dyn Switching> {
        None
    }

    /// The explicit dependence of f on t while it is [held](VectorField::switching), if it can be.
    fn held_time_dependence(&mut self) -> Option<TimeDependence> {
        self.switching().map(|switching| switching.time_dependence())
    }

    /// The surfaces, as far as they are known, on which f jumps as the state passes them, or as t passes them at a
    /// time that depends on parameters. Jumps at a [break](VectorField::breaks), and jumps on surfaces where f is
    /// [held](VectorField::switching), are not included.
    fn jumps(&self) -> &[RateJump] {
        &[]
    }

    /// Checks whether one motion connects the times and states `from` and `to`, between which an integrator made a
    /// step: a field may have barriers that no motion crosses.
    ///
    /// # Errors
    /// [`Failure`] if no motion leads from the first to the second.
    fn leads(&mut self, _from: (f64, &[f64]), _to: (f64, &[f64])) -> Result<(), Failure> {
        Ok(())
    }

    /// Name of component `i` of y, for messages.
    fn component_name(&self, i: usize) -> String {
        format!("y[{i}]")
    }
}

/// A vector field behind a pointer is that vector field.
macro_rules! behind {
    ($pointer:ty) => {
        impl<F: VectorField + ?Sized> VectorField for $pointer {
            forward! { (**self) =>
                fn dim(&self) -> usize;
                fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure>;
                fn checks_rates(&self) -> bool;
                fn has_jacobian(&self) -> bool;
                fn jacobian(&mut self, t: f64, y: &[f64], jacobian: &mut [f64]) -> Result<(), Failure>;
                fn sparsity(&self) -> Option<&Pattern>;
                fn sparse_jacobian(&mut self, t: f64, y: &[f64], values: &mut [f64]) -> Result<(), Failure>;
                fn has_jvp(&self) -> bool;
                fn jvp(&mut self, t: f64, y: &[f64], v: &[f64], product: &mut [f64]) -> Result<(), Failure>;
                fn has_vjp(&self) -> bool;
                fn vjp(&mut self, t: f64, y: &[f64], w: &[f64], product: &mut [f64]) -> Result<(), Failure>;
                fn parameters_len(&self) -> usize;
                fn has_parameter_jacobian(&self) -> bool;
                fn parameter_jacobian(&mut self, t: f64, y: &[f64], jacobian: &mut [f64]) -> Result<(), Failure>;
                fn parameter_size(&self, j: usize) -> Option<f64>;
                fn has_projection(&self) -> bool;
                fn project(&mut self, t: f64, y: &mut [f64]) -> Result<(), Failure>;
                fn time_dependence(&self) -> TimeDependence;
                fn steep_functions(&self) -> Option<SteepFunctions>;
                fn series(&mut self) -> Result<&TaylorSeries, Failure>;
                fn expand(&mut self, t: f64, y: &[f64], sides: &[f64], order: usize) -> Result<&TaylorSeries, Failure>;
                fn varied_series(&mut self, columns: &[Option<usize>]) -> Result<&TaylorSeries, Failure>;
                fn expand_varied(&mut self, columns: &[Option<usize>], t: f64, all: &[f64], sides: &[f64], order: usize) -> Result<&TaylorSeries, Failure>;
                fn lanes(&mut self) -> Option<LaneField>;
                fn restart(&mut self, t: f64, y: &[f64]);
                fn breaks(&self) -> &[f64];
                fn enter(&mut self, t: f64, end: f64) -> bool;
                fn switching(&mut self) -> Option<&mut dyn Switching>;
                fn held_time_dependence(&mut self) -> Option<TimeDependence>;
                fn jumps(&self) -> &[RateJump];
                fn leads(&mut self, from: (f64, &[f64]), to: (f64, &[f64])) -> Result<(), Failure>;
                fn component_name(&self, i: usize) -> String;
            }
        }
    };
}

behind!(&mut F);
behind!(Box<F>);

#[derive(Debug, thiserror::Error)]
#[error("this vector field has no Jacobian")]
struct NoJacobian;

#[derive(Debug, thiserror::Error)]
#[error("the zero pattern of this vector field's Jacobian is not known")]
struct NoPattern;

#[derive(Debug, thiserror::Error)]
#[error("this vector field has no products with its Jacobian")]
struct NoProduct;

#[derive(Debug, thiserror::Error)]
#[error("this vector field has no products with its transposed Jacobian")]
struct NoTransposedProduct;

#[derive(Debug, thiserror::Error)]
#[error("this vector field has no derivative by its parameters")]
struct NoParameterJacobian;

#[derive(Debug, thiserror::Error)]
#[error("Taylor's method needs a vector field that is a program, not a function that is called")]
struct NoSeries;
