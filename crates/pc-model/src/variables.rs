//! The variables of the state, which decide the form of the equations.

/// The variables of the state in addition to the coordinates, which decide the equations of motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variables {
    /// The quasi-velocities of (9), or of (30): independent ones if constraints make the others vanish, all of them
    /// with multipliers otherwise.
    QuasiVelocities,
    /// The momenta of (10), those of the same quasi-velocities.
    Momenta,
    /// The quasi-velocities of (9) without the coordinates that nothing depends on: Euler–Poincaré's equations if
    /// none is left.
    Reduced,
    /// The momenta of the same: Lie–Poisson equations.
    ReducedMomenta,
    /// Quasi-velocities that are orthonormal in the kinetic metric.
    Orthonormal,
    /// Quasi-velocities [given](crate::Model::give_quasi_velocity) in addition to those of the text: Hamel's
    /// equations in these.
    Given,
}

impl Variables {
    /// All of them.
    pub const ALL: [Variables; 6] = [
        Variables::QuasiVelocities,
        Variables::Momenta,
        Variables::Reduced,
        Variables::ReducedMomenta,
        Variables::Orthonormal,
        Variables::Given,
    ];

    /// Whether the state has momenta.
    pub fn has_momenta(self) -> bool {
        matches!(self, Variables::Momenta | Variables::ReducedMomenta)
    }

    /// Whether the equations are those of the model's own coordinates and quasi-velocities.
    pub fn are_own(self) -> bool {
        matches!(self, Variables::QuasiVelocities | Variables::Momenta)
    }

    /// The name of their form of the equations in model files, on command lines and in Python.
    pub fn name(self) -> &'static str {
        match self {
            Variables::QuasiVelocities => "poincare",
            Variables::Momenta => "canonical",
            Variables::Reduced => "reduced",
            Variables::ReducedMomenta => "lie-poisson",
            Variables::Orthonormal => "orthonormal",
            Variables::Given => "hamel",
        }
    }
}
