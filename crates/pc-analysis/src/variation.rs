//! The equations of variation (Poincaré; Chetaev's equations of perturbed motion in the first approximation).

use pc_expr::{Failure, SteepFunctions, TimeDependence, VectorField};
use pc_mech::{EvaluationError, MechError};

/// A motion together with deviations from it, in the first approximation:
///
///   ẏ = f(t, y),   δ̇_a = (∂f/∂y) δ_a,   a = 1..m.
///
/// The state is (y, δ_1, …, δ_m), of n (m + 1) components. To first order in s, y + s δ is a neighbouring
/// motion.
#[derive(Clone, Debug)]
pub struct Variation<F> {
    field: F,
    deviations: usize,
}

impl<F: VectorField> Variation<F> {
    /// The motion of `field` together with `deviations` deviations from it.
    ///
    /// # Errors
    /// [`EvaluationError::NotCompiled`] if the field has no products with its Jacobian, as a
    /// [`Motion`](pc_mech::Motion) has [on demand](pc_mech::CompileOptions::jvp); [`EvaluationError::Pieces`] if it jumps or
    /// has corners, at which deviations would have to jump.
    pub fn new(mut field: F, deviations: usize) -> Result<Variation<F>, MechError> {
        if let Some(switching) = field.switching() {
            return Err(EvaluationError::Pieces { surfaces: switching.surfaces().to_vec() }.into());
        }
        if field.has_jvp() {
            Ok(Variation { field, deviations })
        } else {
            Err(EvaluationError::NotCompiled { what: "products with the Jacobian" }.into())
        }
    }

    /// The vector field for y alone.
    pub fn field(&self) -> &F {
        &self.field
    }
}

impl<F: VectorField> VectorField for Variation<F> {
    fn dim(&self) -> usize {
        self.field.dim() * (self.deviations + 1)
    }

    fn rhs(&mut self, t: f64, state: &[f64], rates: &mut [f64]) -> Result<(), Failure> {
        let n = self.field.dim();
        let (y, deviations) = state.split_at(n);
        let (ydot, rates) = rates.split_at_mut(n);
        self.field.rhs(t, y, ydot)?;
        for a in 0..self.deviations {
            let own = a * n..(a + 1) * n;
            self.field.jvp(t, y, &deviations[own.clone()], &mut rates[own])?;
        }
        Ok(())
    }

    fn breaks(&self) -> &[f64] {
        self.field.breaks()
    }

    fn enter(&mut self, t: f64, end: f64) -> bool {
        self.field.enter(t, end)
    }

    fn leads(&mut self, from: (f64, &[f64]), to: (f64, &[f64])) -> Result<(), Failure> {
        let own = self.field.dim();
        self.field.leads((from.0, &from.1[..own]), (to.0, &to.1[..own]))
    }

    fn time_dependence(&self) -> TimeDependence {
        self.field.time_dependence()
    }

    fn steep_functions(&self) -> Option<SteepFunctions> {
        self.field.steep_functions().map(|steep| steep.in_states_of(self.dim()))
    }

    /// The names of the components of the field, and `δ1 x`, `δ2 x`, … for the deviations of the component
    /// `x`.
    fn component_name(&self, i: usize) -> String {
        let n = self.field.dim().max(1);
        let name = self.field.component_name(i % n);
        if i < n { name } else { format!("δ{} {name}", i / n) }
    }
}
