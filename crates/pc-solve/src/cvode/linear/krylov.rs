//! The choices for Krylov's method.

use std::fmt;
use std::sync::Arc;

use crate::cvode::linear::preconditioner::Preconditioner;
use crate::error::InputError;
use crate::integration::checks::positive;

/// The side of A = I − γ ∂f/∂y on which the inverse of the preconditioner P is applied.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Side {
    /// P⁻¹ A x = P⁻¹ b: the minimised residual is P⁻¹ (b − A x).
    Left,
    /// A P⁻¹ (P x) = b: the residual is b − A x, as without a preconditioner.
    Right,
}

/// The generalised minimal residual method, GMRES [Saad, Schultz, SIAM J. Sci. Stat. Comp. 7
/// (1986) 856].
#[derive(Debug, Clone, PartialEq)]
pub struct Krylov {
    pub(super) dimension: u32,
    pub(super) restarts: u32,
    pub(super) tolerance: f64,
    pub(super) preconditioner: Option<(Side, Maker)>,
}

impl Default for Krylov {
    /// A method that searches spaces of dimension 5.
    fn default() -> Self {
        Krylov::new(5)
    }
}

impl Krylov {
    /// A method that searches spaces spanned by b, A b, A² b, … of the given dimension, at least 1;
    /// without restarts or a preconditioner, and with tolerance 0.05.
    pub fn new(dimension: u32) -> Self {
        Krylov { dimension, restarts: 0, tolerance: 0.05, preconditioner: None }
    }

    /// Sets how often the method restarts from the residual with a new space if the first one does
    /// not suffice.
    pub fn restarts(self, restarts: u32) -> Self {
        Krylov { restarts, ..self }
    }

    /// Sets the tolerance of the residual, relative to the tolerance of Newton's iteration; it is
    /// positive.
    pub fn tolerance(self, tolerance: f64) -> Self {
        Krylov { tolerance, ..self }
    }

    /// Adds a preconditioner: `make` makes one for each integration.
    pub fn preconditioner<P: Preconditioner + Send + 'static>(
        self,
        side: Side,
        make: impl Fn() -> P + Send + Sync + 'static,
    ) -> Self {
        let maker = Maker(Arc::new(move || Box::new(make())));
        Krylov { preconditioner: Some((side, maker)), ..self }
    }

    pub(super) fn check(&self) -> Result<(), InputError> {
        positive("the dimension of the Krylov space", f64::from(self.dimension))?;
        positive("the tolerance of the Krylov solver", self.tolerance)
    }
}

/// Makes preconditioners. Two makers are equal if they are clones of the same maker.
#[derive(Clone)]
pub(super) struct Maker(pub(super) Arc<dyn Fn() -> Box<dyn Preconditioner + Send> + Send + Sync>);

impl fmt::Debug for Maker {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Maker")
    }
}

impl PartialEq for Maker {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}
