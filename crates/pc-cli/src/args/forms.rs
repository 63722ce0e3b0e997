//! The forms of the equations that a command takes.

use clap::ValueEnum;
use pc_model::Variables;
use pc_model::document::EquationForm;

/// Form of the equations of motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Form {
    /// Equations for the quasi-velocities.
    Poincare,
    /// Equations for the momenta.
    Canonical,
    /// Equations for the velocities.
    Lagrange,
    /// Equations for independent velocities.
    Voronets,
    /// Equations for the quasi-velocities without coordinates that nothing depends on.
    Reduced,
    /// Those for the momenta.
    LiePoisson,
    /// Equations in a frame that is orthonormal in the kinetic metric.
    Orthonormal,
    /// Equations for quasi-velocities given on the command line.
    Hamel,
}

impl From<EquationForm> for Form {
    fn from(form: EquationForm) -> Form {
        match form {
            EquationForm::Poincare => Form::Poincare,
            EquationForm::Canonical => Form::Canonical,
            EquationForm::Reduced => Form::Reduced,
            EquationForm::LiePoisson => Form::LiePoisson,
            EquationForm::Orthonormal => Form::Orthonormal,
            EquationForm::Hamel => Form::Hamel,
        }
    }
}

impl From<Form> for pc_print::Form {
    fn from(form: Form) -> Self {
        match form {
            Form::Poincare => pc_print::Form::Poincare,
            Form::Canonical => pc_print::Form::Canonical,
            Form::Lagrange => pc_print::Form::Lagrange,
            Form::Voronets => pc_print::Form::Voronets,
            Form::Reduced => pc_print::Form::Reduced,
            Form::LiePoisson => pc_print::Form::LiePoisson,
            Form::Orthonormal => pc_print::Form::Orthonormal,
            Form::Hamel => pc_print::Form::Hamel,
        }
    }
}

/// Form of the equations that are written as source.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum EmitForm {
    /// Equations for the quasi-velocities.
    Poincare,
    /// The same without coordinates that nothing depends on.
    Reduced,
    /// Equations in a frame that is orthonormal in the kinetic metric.
    Orthonormal,
    /// Equations for quasi-velocities given on the command line.
    Hamel,
}

impl From<EmitForm> for Variables {
    fn from(form: EmitForm) -> Variables {
        match form {
            EmitForm::Poincare => Variables::QuasiVelocities,
            EmitForm::Reduced => Variables::Reduced,
            EmitForm::Orthonormal => Variables::Orthonormal,
            EmitForm::Hamel => Variables::Given,
        }
    }
}

/// Form of the equations that are integrated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum RunForm {
    /// Equations for the quasi-velocities.
    Poincare,
    /// Equations for the momenta.
    Canonical,
    /// Equations for the quasi-velocities without coordinates that nothing depends on.
    Reduced,
    /// Those for the momenta.
    LiePoisson,
    /// Equations in a frame that is orthonormal in the kinetic metric.
    Orthonormal,
    /// Equations for quasi-velocities given on the command line.
    Hamel,
}

impl From<EquationForm> for RunForm {
    fn from(form: EquationForm) -> RunForm {
        match form {
            EquationForm::Poincare => RunForm::Poincare,
            EquationForm::Canonical => RunForm::Canonical,
            EquationForm::Reduced => RunForm::Reduced,
            EquationForm::LiePoisson => RunForm::LiePoisson,
            EquationForm::Orthonormal => RunForm::Orthonormal,
            EquationForm::Hamel => RunForm::Hamel,
        }
    }
}

impl From<RunForm> for Variables {
    fn from(form: RunForm) -> Variables {
        match form {
            RunForm::Poincare => Variables::QuasiVelocities,
            RunForm::Canonical => Variables::Momenta,
            RunForm::Reduced => Variables::Reduced,
            RunForm::LiePoisson => Variables::ReducedMomenta,
            RunForm::Orthonormal => Variables::Orthonormal,
            RunForm::Hamel => Variables::Given,
        }
    }
}

pub(super) fn form(text: &str) -> Result<Form, String> {
    choice(text, &[])
}

pub(super) fn emit_form(text: &str) -> Result<EmitForm, String> {
    choice(text, &["canonical", "lagrange", "voronets", "lie-poisson"])
}

pub(crate) fn run_form(text: &str) -> Result<RunForm, String> {
    choice(text, &["lagrange", "voronets"])
}

/// One of the values of `T`; those of `later` are not supported yet.
pub(super) fn choice<T: ValueEnum>(text: &str, later: &[&str]) -> Result<T, String> {
    T::from_str(text, false).map_err(|_| {
        let names: Vec<String> = T::value_variants()
            .iter()
            .filter_map(|variant| variant.to_possible_value().map(|value| value.get_name().to_owned()))
            .collect();
        let names = match names.split_last() {
            Some((last, rest)) if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
            _ => names.concat(),
        };
        if later.contains(&text) {
            format!("`{text}` is not supported yet; use {names}")
        } else {
            format!("use {names}")
        }
    })
}
