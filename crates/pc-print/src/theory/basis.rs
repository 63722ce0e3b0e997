//! The common basis of all parts of the theory.

use pc_analysis::AnalysisError;
use pc_mech::{Canonical, Equations, MechError, Neighbourhood, System};
use pc_model::{Assembly, ConstraintFormulation, Model, ModelError};
use pc_nonholo::Constrained;

/// A model with its equations in independent quasi-velocities.
pub(crate) struct Basis<'a, 'g> {
    pub(crate) assembly: &'a Assembly<'g>,
    pub(crate) equations: Equations<'g>,
    /// The system of the independent quasi-velocities.
    pub(crate) free: System<'g>,
    /// The system in the frame in which constraints make quasi-velocities vanish, if they are not integrable.
    pub(crate) constrained: Option<Constrained<'g>>,
    /// The canonical equations of the independent momenta, or the reason why there are none.
    pub(crate) canonical: Result<Canonical<'g>, String>,
    /// The values of time, state and parameters at the start.
    pub(crate) near: Neighbourhood<'g>,
    /// The end of the run of the model, if the text gives it.
    pub(crate) t_end: Option<f64>,
}

impl<'a, 'g> Basis<'a, 'g> {
    pub(crate) fn new(model: &Model, assembly: &'a Assembly<'g>) -> Result<Basis<'a, 'g>, ModelError> {
        let at = assembly.at_start();
        let free = assembly.free_system()?;
        let canonical = match assembly.constraints.nonlinear() {
            Some(_) => Err(NONLINEAR.to_owned()),
            None => match free.canonical() {
                Ok(canonical) if canonical.is_closed() => Ok(canonical),
                Ok(_) => Err(NOT_CLOSED.to_owned()),
                Err(error) => Err(error.to_string()),
            },
        };
        let centre = assembly.system.parameters().iter().copied().chain(at.iter().copied()).collect();
        Ok(Basis {
            equations: assembly.equations()?,
            constrained: assembly.placed(assembly.constraints.constrained(&at))?,
            near: Neighbourhood { centre },
            t_end: model
                .document()
                .simulation
                .t_end
                .as_ref()
                .map(|t| t.value)
                .filter(|&t| t > assembly.t_start),
            assembly,
            canonical,
            free,
        })
    }

    /// Whether all binding constraints are integrable.
    pub(crate) fn is_holonomic(&self) -> bool {
        self.assembly.constraints.positions(&self.assembly.system).is_some()
    }

    /// Whether the system is free of constraints, except those of its frame.
    pub(crate) fn is_unbound(&self) -> bool {
        matches!(self.assembly.constraints.formulation(), ConstraintFormulation::Free)
    }

    /// Whether forces are computed outside the model.
    pub(crate) fn has_external_forces(&self) -> bool {
        !self.assembly.system.external_forces().is_empty()
    }

    /// The result of an analysis, with its error located at the entry of the file that causes it.
    pub(crate) fn placed<T>(&self, found: Result<T, AnalysisError>) -> Result<T, ModelError> {
        placed(self.assembly, found)
    }
}

/// The result of an analysis, with its error located in the same way, for a model whose equations are not at
/// hand.
pub(crate) fn placed<T>(assembly: &Assembly<'_>, found: Result<T, AnalysisError>) -> Result<T, ModelError> {
    found.or_else(|error| match error {
        AnalysisError::Nonholo(error) => assembly.placed(Err(error)),
        AnalysisError::Mech(error) => assembly.placed(Err(error)),
        AnalysisError::Expr(error) => assembly.placed(Err(MechError::from(error))),
        other => Err(assembly.not_derived(other.to_string())),
    })
}

pub(crate) const NONLINEAR: &str = "a constraint is not affine in the velocities";
const NOT_CLOSED: &str = "the momenta are not solved for the velocities in closed form";
