//! The constraints of a model: sorted, checked at the start, and put where they are cheapest to keep.

use pc_mech::{Constraint, Expr, System};
use pc_nonholo::{Constrained, ConstraintClassification, Kind, Redundant};

use super::trial::{StartHeld, Trial};
use crate::assembly::assembler::Assembler;
use crate::assembly::constraint_treatment::{
    ClassifiedConstraint, ConstraintFormulation, ConstraintTreatment, MultiplierFormulation,
};
use crate::diagnostics::error::ModelError;
use crate::diagnostics::meaning::MeaningError;
use crate::document;
use crate::document::ConstraintKind;
use crate::names::stage::Stage;

/// A constraint of the text with its expression, x' still symbols.
pub(super) struct Written<'g> {
    place: usize,
    value: Expr<'g>,
    /// Whether it is called nonlinear.
    nonlinear: bool,
    /// The quasi-velocity that it is, where it completes those defined.
    defines: Option<Expr<'g>>,
}

impl<'g> Written<'g> {
    /// Says that it is this quasi-velocity.
    pub(super) fn define(&mut self, quasi_velocity: Expr<'g>) {
        self.defines = Some(quasi_velocity);
    }

    /// Whether it is called nonlinear in the velocities.
    pub(super) fn is_nonlinear(&self) -> bool {
        self.nonlinear
    }

    /// Its place in the section.
    pub(super) fn place(&self) -> usize {
        self.place
    }

    /// Its expression, x' still symbols.
    pub(super) fn value(&self) -> Expr<'g> {
        self.value
    }
}

impl<'g> Assembler<'g, '_> {
    /// The entries of `[constraints]`.
    pub(super) fn constraints(&mut self) -> Result<Vec<Written<'g>>, ModelError> {
        let mut written = Vec::new();
        for (place, constraint) in self.model.document().constraints.iter().enumerate() {
            let value = self.scope.resolve(&constraint.expression, Stage::Constraint)?;
            written.push(Written { place, value, nonlinear: is_called_nonlinear(constraint), defines: None });
        }
        Ok(written)
    }

    /// The name of a constraint, made longer where it is that of something else.
    pub(super) fn unused(&self, label: &str) -> String {
        let document = self.model.document();
        let parameters = document.parameters.iter().map(|p| &p.name.text);
        let coordinates = document.coordinates.iter().map(|c| &c.name.text);
        let quasi_velocities = document.quasi_velocities.iter().map(|q| &q.name.text);
        let taken: Vec<&String> = parameters.chain(coordinates).chain(quasi_velocities).collect();
        let mut name = label.to_owned();
        while taken.contains(&&name) || name == "t" {
            name.push('_');
        }
        name
    }

    /// How the constraints bind the system, and the start on them; `at` are values of all symbols there, and so many of the
    /// quasi-velocities are `prescribed` for others to follow.
    pub(super) fn bound(
        &self,
        system: &System<'g>,
        written: &[Written<'g>],
        x_dot: &[(Expr<'g>, Expr<'g>)],
        at: &[(Expr<'g>, f64)],
        (t_start, start): (f64, &mut Vec<f64>),
        prescribed: usize,
    ) -> Result<ConstraintTreatment<'g>, ModelError> {
        if written.is_empty() {
            return Ok(ConstraintTreatment::free());
        }
        let constraints: Vec<Constraint<'g>> = written.iter().map(|w| self.constraint(w, x_dot)).collect();
        self.check_nonlinear(system, &constraints)?;
        let trial = Trial { model: self.model, system, constraints: &constraints, t: t_start };
        trial.check_finite(start)?;
        let refused = |error| self.model.constraint_error(error);
        let sorted = ConstraintClassification::new(system, &constraints, at).map_err(refused)?;
        let classified = self.classified(&sorted)?;
        let projects = self.model.projects_start();
        if projects || !sorted.redundant().is_empty() {
            // Quasi-velocities that determine the others stay as they are prescribed.
            let free =
                system.quasi_velocities().len() - sorted.multipliers().map_or(0, |m| m.constraints().len());
            let held = StartHeld::new(self.model, if free == prescribed { prescribed } else { 0 });
            let nearest = trial.nearest(&sorted, start, &held);
            if let Ok(nearest) = &nearest {
                trial.check_redundant(&sorted, nearest)?;
            }
            if projects {
                *start = nearest?;
            }
        }
        trial.check(start)?;

        let eta = system.quasi_velocities();
        let vanishing: Option<Vec<Expr<'g>>> = sorted.multipliers().and_then(|multipliers| {
            let bare = |c: &Constraint<'g>| eta.iter().copied().find(|&eta| eta == c.expression());
            multipliers.constraints().iter().map(bare).collect()
        });
        let (redundant, combinations) = (sorted.redundant().to_vec(), sorted.integrable_combinations());
        let Some(multipliers) = sorted.multipliers() else {
            return Ok(ConstraintTreatment::nothing(redundant));
        };
        // What is dropped has no reaction.
        let none =
            |dropped: &Redundant| (self.graph.symbol(&format!("λ_{}", dropped.constraint)), Expr::ZERO);
        let system = system.with_observed(&redundant.iter().map(none).collect::<Vec<_>>());
        let (system, undetermined) = self.with_resultants(system, multipliers, &redundant)?;
        let multipliers =
            system.with_multipliers(multipliers.constraints()).map_err(|e| refused(e.into()))?;
        // As many as are declared where these are completed, and independent then.
        let declared = &system.quasi_velocities()[..self.scope.quasi_velocities().len()];
        let dropped = |c: &&Constraint<'g>| redundant.iter().any(|dropped| dropped.constraint == c.name());
        let followers: Vec<Constraint<'g>> = constraints.iter().filter(dropped).cloned().collect();
        let multipliers = multipliers.preferring(declared).followed_by(&followers);
        let Some(vanishing) = vanishing else {
            let held =
                MultiplierFormulation { multipliers: multipliers.clone(), holonomic: sorted.is_holonomic() };
            let bound = ConstraintTreatment::new(
                ConstraintFormulation::Multipliers(Box::new(held)),
                multipliers,
                classified,
                redundant,
            );
            return Ok(bound.with_undetermined(undetermined).with_integrable_combinations(combinations));
        };
        let constrained = |system: &System<'g>| Constrained::new(system, &vanishing).map_err(refused);
        let form = ConstraintFormulation::Vanishing(Box::new(constrained(&system)?));
        let bound =
            ConstraintTreatment::new(form, multipliers.clone(), classified.clone(), redundant.clone());
        let bound = bound.with_undetermined(undetermined.clone()).with_integrable_combinations(combinations);
        let observed = system.integrals().iter().chain(system.outputs());
        let reactions = multipliers.reactions();
        if !observed.into_iter().any(|(_, f)| reactions.iter().any(|&reaction| f.depends_on(reaction))) {
            return Ok(bound);
        }
        let known = bound.reactions(at).map_err(refused)?;
        let form = ConstraintFormulation::Vanishing(Box::new(constrained(&system.with_observed(&known))?));
        let bound = ConstraintTreatment::new(form, multipliers, classified, redundant)
            .with_undetermined(undetermined);
        Ok(bound.with_integrable_combinations(combinations))
    }

    /// The constraint, in quasi-velocities.
    fn constraint(&self, written: &Written<'g>, x_dot: &[(Expr<'g>, Expr<'g>)]) -> Constraint<'g> {
        let value = self.graph.substitute(&[written.value], x_dot)[0];
        let (text, value) = (self.text_of(written), written.defines.unwrap_or(value));
        match is_called_nonlinear(text) {
            true => Constraint::nonlinear(text.name.text.clone(), value),
            false => Constraint::new(text.name.text.clone(), value),
        }
    }

    /// That what is called nonlinear is so: what is affine has more forms and Frobenius' test.
    fn check_nonlinear(&self, system: &System<'g>, constraints: &[Constraint<'g>]) -> Result<(), ModelError> {
        for constraint in constraints.iter().filter(|constraint| constraint.is_nonlinear()) {
            let what = match constraint.coefficients(system) {
                _ if constraint.is_holonomic(system) => "contains no velocity",
                Ok(_) => "is affine in the velocities",
                Err(_) => continue,
            };
            let text = self.model.constraint_text(constraint.name()).and_then(|text| text.kind.as_ref());
            if let Some(kind) = text {
                let constraint = constraint.name().to_owned();
                return Err(self.model.error(&kind.place, MeaningError::NotNonlinear { constraint, what }));
            }
        }
        Ok(())
    }

    fn text_of(&self, written: &Written<'g>) -> &document::Constraint {
        &self.model.document().constraints[written.place]
    }

    /// What each binding constraint does, unless the text says otherwise.
    fn classified(
        &self,
        sorted: &ConstraintClassification<'g>,
    ) -> Result<Vec<ClassifiedConstraint>, ModelError> {
        let Some(multipliers) = sorted.multipliers() else { return Ok(Vec::new()) };
        multipliers
            .constraints()
            .iter()
            .zip(sorted.kinds())
            .map(|(constraint, &kind)| {
                let given = self.model.constraint_text(constraint.name()).and_then(|text| text.kind.as_ref());
                if let (Some(given), Kind::Nonholonomic { residual }) = (given, kind)
                    && given.value == ConstraintKind::Holonomic
                {
                    let constraint = constraint.name().to_owned();
                    return Err(self
                        .model
                        .error(&given.place, MeaningError::NotHolonomic { constraint, residual }));
                }
                Ok(ClassifiedConstraint { constraint: constraint.name().to_owned(), kind })
            })
            .collect()
    }
}

/// Whether the text says that it is not affine in the velocities.
fn is_called_nonlinear(constraint: &document::Constraint) -> bool {
    constraint.kind.as_ref().is_some_and(|kind| kind.value == ConstraintKind::Nonlinear)
}
