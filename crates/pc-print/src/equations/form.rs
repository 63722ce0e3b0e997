//! The forms of the equations of motion.

use pc_model::Variables;

/// Form of the equations of motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Equations for the quasi-velocities.
    Poincare,
    /// Equations for the momenta.
    Canonical,
    /// Equations for the velocities.
    Lagrange,
    /// Equations for independent velocities.
    Voronets,
    /// Equations for the quasi-velocities, omitting coordinates on which nothing depends: Euler–Poincaré.
    Reduced,
    /// Equations for the momenta, omitting coordinates on which nothing depends: Lie–Poisson.
    LiePoisson,
    /// Equations for quasi-velocities that are orthonormal in the kinetic metric.
    Orthonormal,
    /// Equations for quasi-velocities given on the command line.
    Hamel,
    /// Lagrange's expressions along the independent quasi-velocities.
    Maggi,
    /// Active forces and forces of inertia along the independent quasi-velocities.
    Kane,
    /// Derivatives of Gibbs' function, the energy of the accelerations, in the independent quasi-velocities.
    GibbsAppell,
}

impl Form {
    /// All forms.
    pub const ALL: [Form; 11] = [
        Form::Poincare,
        Form::Canonical,
        Form::Lagrange,
        Form::Voronets,
        Form::Reduced,
        Form::LiePoisson,
        Form::Orthonormal,
        Form::Hamel,
        Form::Maggi,
        Form::Kane,
        Form::GibbsAppell,
    ];

    /// The variables of the state in this form; none for the forms that serve only for
    /// printing.
    pub fn variables(self) -> Option<Variables> {
        Some(match self {
            Form::Poincare => Variables::QuasiVelocities,
            Form::Canonical => Variables::Momenta,
            Form::Reduced => Variables::Reduced,
            Form::LiePoisson => Variables::ReducedMomenta,
            Form::Orthonormal => Variables::Orthonormal,
            Form::Hamel => Variables::Given,
            Form::Voronets => Variables::IndependentVelocities,
            Form::Lagrange | Form::Maggi | Form::Kane | Form::GibbsAppell => return None,
        })
    }

    /// The form with this [`name`](Form::name).
    pub fn named(name: &str) -> Option<Form> {
        Form::ALL.into_iter().find(|form| form.name() == name)
    }

    /// The name of the form on command lines and in Python.
    pub fn name(self) -> &'static str {
        match self {
            Form::Lagrange => "lagrange",
            Form::Maggi => "maggi",
            Form::Kane => "kane",
            Form::GibbsAppell => "gibbs-appell",
            other => other.variables().map_or("", Variables::name),
        }
    }
}

impl From<Variables> for Form {
    fn from(variables: Variables) -> Form {
        match variables {
            Variables::QuasiVelocities => Form::Poincare,
            Variables::Momenta => Form::Canonical,
            Variables::Reduced => Form::Reduced,
            Variables::ReducedMomenta => Form::LiePoisson,
            Variables::Orthonormal => Form::Orthonormal,
            Variables::Given => Form::Hamel,
            Variables::IndependentVelocities => Form::Voronets,
        }
    }
}
