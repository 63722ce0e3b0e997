//! The constraints of a model: they are classified, checked at the start, and treated in the cheapest way.

use pc_mech::{Constraint, Expr, Multipliers, System};
use pc_nonholo::{Constrained, ConstraintClassification, ConstraintKind, Redundant};

use super::trial::{StartHeld, Trial};
use crate::assembly::assembler::Assembler;
use crate::assembly::constraint_treatment::{
    ClassifiedConstraint, ConstraintFormulation, ConstraintTreatment, MultiplierFormulation,
};
use crate::diagnostics::error::ModelError;
use crate::diagnostics::meaning::MeaningError;
use crate::document;
use crate::document::DeclaredKind;
use crate::names::stage::Stage;

/// A constraint of the text with its expression, in which the velocities x' are symbols.
pub(super) struct Written<'g> {
    place: usize,
    value: Expr<'g>,
    /// Whether it is declared nonlinear.
    nonlinear: bool,
    /// The quasi-velocity that the constraint defines, if this quasi-velocity completes the declared ones.
    defines: Option<Expr<'g>>,
}

impl<'g> Written<'g> {
    /// Makes the constraint define this quasi-velocity.
    pub(super) fn define(&mut self, quasi_velocity: Expr<'g>) {
        self.defines = Some(quasi_velocity);
    }

    /// Whether the constraint is declared nonlinear in the velocities.
    pub(super) fn is_nonlinear(&self) -> bool {
        self.nonlinear
    }

    /// Its index in the section.
    pub(super) fn place(&self) -> usize {
        self.place
    }

    /// Its expression, in which x' are symbols.
    pub(super) fn value(&self) -> Expr<'g> {
        self.value
    }
}

/// The system with its observed reactions, and its equations with multipliers.
struct Reacting<'g> {
    system: System<'g>,
    multipliers: Multipliers<'g>,
    /// Descriptions of the forces on bodies that virtual work leaves undetermined.
    undetermined: Vec<String>,
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

    /// The name of a constraint, extended if it is already taken.
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

    /// The treatment of the constraints, and the start that satisfies them; `at` are the values of all
    /// symbols at the start, and the first `prescribed` quasi-velocities determine the others.
    pub(super) fn treatment(
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
        let constraints = self.in_quasi_velocities(written, x_dot);
        let (classification, classified) =
            self.on_constraints((system, &constraints), at, (t_start, start), prescribed)?;
        let trial = Trial { model: self.model, system, constraints: &constraints, t: t_start };
        match self.attach_reactions(&trial, &classification)? {
            None => Ok(ConstraintTreatment::nothing(classification.redundant().to_vec())),
            Some(reacting) => self.choose(reacting, &classification, classified, at),
        }
    }

    /// The constraints, expressed in quasi-velocities.
    pub(super) fn in_quasi_velocities(
        &self,
        written: &[Written<'g>],
        x_dot: &[(Expr<'g>, Expr<'g>)],
    ) -> Vec<Constraint<'g>> {
        written.iter().map(|w| self.constraint(w, x_dot)).collect()
    }

    /// The kinds of the constraints at the start, which is moved onto the constraints if the model requests
    /// it.
    pub(super) fn on_constraints(
        &self,
        (system, constraints): (&System<'g>, &[Constraint<'g>]),
        at: &[(Expr<'g>, f64)],
        (t, start): (f64, &mut Vec<f64>),
        prescribed: usize,
    ) -> Result<(ConstraintClassification<'g>, Vec<ClassifiedConstraint>), ModelError> {
        let trial = Trial { model: self.model, system, constraints, t };
        let (classification, classified) = self.classify(&trial, start, at)?;
        self.project_start(&trial, &classification, start, prescribed)?;
        Ok((classification, classified))
    }

    /// The kinds of the constraints at the start.
    fn classify(
        &self,
        trial: &Trial<'_, 'g>,
        start: &[f64],
        at: &[(Expr<'g>, f64)],
    ) -> Result<(ConstraintClassification<'g>, Vec<ClassifiedConstraint>), ModelError> {
        self.check_nonlinear(trial.system, trial.constraints)?;
        trial.check_finite(start)?;
        let classification = ConstraintClassification::new(trial.system, trial.constraints, at);
        let classification = classification.map_err(|error| self.model.document().constraint_error(error))?;
        let classified = self.classified(&classification)?;
        Ok((classification, classified))
    }

    /// Moves the start onto the constraints, if the model requests it, and checks that it satisfies them.
    fn project_start(
        &self,
        trial: &Trial<'_, 'g>,
        classification: &ConstraintClassification<'g>,
        start: &mut Vec<f64>,
        prescribed: usize,
    ) -> Result<(), ModelError> {
        let projects = self.model.projects_start();
        if projects || !classification.redundant().is_empty() {
            // Quasi-velocities that determine the others keep their prescribed values.
            let binding = classification.multipliers().map_or(0, |m| m.constraints().len());
            let free = trial.system.quasi_velocities().len() - binding;
            let held = StartHeld::new(self.model, if free == prescribed { prescribed } else { 0 });
            let nearest = trial.nearest(classification, start, &held);
            if let Ok(nearest) = &nearest {
                trial.check_redundant(classification, nearest)?;
            }
            if projects {
                *start = nearest?;
            }
        }
        trial.check(start)
    }

    /// The equations with multipliers, and the observed reactions; `None` if no constraint binds.
    fn attach_reactions(
        &self,
        trial: &Trial<'_, 'g>,
        classification: &ConstraintClassification<'g>,
    ) -> Result<Option<Reacting<'g>>, ModelError> {
        let Some(binding) = classification.multipliers() else { return Ok(None) };
        let redundant = classification.redundant();
        // How constraints that follow from each other share their reaction is not determined: dropped ones have none.
        let is_dropped = |name: &str| redundant.iter().any(|dropped| dropped.constraint == name);
        let reaction = |name: &str| self.graph.symbol(&format!("λ_{name}"));
        let none = |dropped: &Redundant| (reaction(&dropped.constraint), Expr::ZERO);
        let mut system = trial.system.with_observed(&redundant.iter().map(none).collect::<Vec<_>>());
        if self.model.observes_reactions() {
            let names =
                self.model.document().constraints.iter().map(|constraint| constraint.name.text.as_str());
            let binding = names.filter(|name| !is_dropped(name));
            system = system.with_more_outputs(binding.map(|name| (format!("λ_{name}"), reaction(name))));
        }
        let (system, undetermined) = self.with_resultants(system, binding, redundant)?;
        let multipliers = system.with_multipliers(binding.constraints());
        let multipliers =
            multipliers.map_err(|error| self.model.document().constraint_error(error.into()))?;
        // The declared quasi-velocities, if these are completed and then independent.
        let declared = &system.quasi_velocities()[..self.scope.quasi_velocities().len()];
        let dropped = |c: &&Constraint<'g>| is_dropped(c.name());
        let followers: Vec<Constraint<'g>> = trial.constraints.iter().filter(dropped).cloned().collect();
        let multipliers = multipliers.preferring(declared).followed_by(&followers);
        Ok(Some(Reacting { system, multipliers, undetermined }))
    }

    /// The cheapest formulation: without the vanishing quasi-velocities if each constraint only makes one
    /// quasi-velocity vanish, otherwise with multipliers.
    fn choose(
        &self,
        Reacting { system, multipliers, undetermined }: Reacting<'g>,
        classification: &ConstraintClassification<'g>,
        classified: Vec<ClassifiedConstraint>,
        at: &[(Expr<'g>, f64)],
    ) -> Result<ConstraintTreatment<'g>, ModelError> {
        let refused = |error| self.model.document().constraint_error(error);
        let eta = system.quasi_velocities();
        let bare = |c: &Constraint<'g>| eta.iter().copied().find(|&eta| eta == c.expression());
        let vanishing: Option<Vec<Expr<'g>>> = multipliers.constraints().iter().map(bare).collect();
        let constrained = |system: &System<'g>, vanishing: &[Expr<'g>]| {
            let constrained = Constrained::new(system, vanishing).map_err(refused)?;
            Ok(ConstraintFormulation::Vanishing(Box::new(constrained)))
        };
        let formulation = match &vanishing {
            Some(vanishing) => constrained(&system, vanishing)?,
            None => ConstraintFormulation::Multipliers(Box::new(MultiplierFormulation {
                multipliers: multipliers.clone(),
                holonomic: classification.is_holonomic(),
            })),
        };
        let redundant = classification.redundant().to_vec();
        let treatment = ConstraintTreatment::new(formulation, multipliers.clone(), classified, redundant)
            .with_undetermined(undetermined)
            .with_integrable_combinations(classification.integrable_combinations());
        let reactions = multipliers.reactions();
        let mut observed = system.integrals().iter().chain(system.outputs());
        let is_observed = observed.any(|(_, f)| reactions.iter().any(|&reaction| f.depends_on(reaction)));
        match vanishing.filter(|_| is_observed) {
            None => Ok(treatment),
            Some(vanishing) => {
                let known = treatment.reactions(at).map_err(refused)?;
                Ok(treatment.in_formulation(constrained(&system.with_observed(&known), &vanishing)?))
            }
        }
    }

    /// The constraint, expressed in quasi-velocities.
    fn constraint(&self, written: &Written<'g>, x_dot: &[(Expr<'g>, Expr<'g>)]) -> Constraint<'g> {
        let value = self.graph.substitute(&[written.value], x_dot)[0];
        let (text, value) = (self.text_of(written), written.defines.unwrap_or(value));
        match is_called_nonlinear(text) {
            true => Constraint::nonlinear(text.name.text.clone(), value),
            false => Constraint::new(text.name.text.clone(), value),
        }
    }

    /// Checks that constraints declared nonlinear are nonlinear: affine constraints allow more forms of the
    /// equations and Frobenius' test.
    fn check_nonlinear(&self, system: &System<'g>, constraints: &[Constraint<'g>]) -> Result<(), ModelError> {
        for constraint in constraints.iter().filter(|constraint| constraint.is_nonlinear()) {
            let what = match constraint.coefficients(system) {
                _ if constraint.is_holonomic(system) => "contains no velocity",
                Ok(_) => "is affine in the velocities",
                Err(_) => continue,
            };
            let text =
                self.model.document().constraint_text(constraint.name()).and_then(|text| text.kind.as_ref());
            if let Some(kind) = text {
                let constraint = constraint.name().to_owned();
                return Err(self
                    .model
                    .document()
                    .error(&kind.place, MeaningError::NotNonlinear { constraint, what }));
            }
        }
        Ok(())
    }

    fn text_of(&self, written: &Written<'g>) -> &document::Constraint {
        &self.model.document().constraints[written.place]
    }

    /// The kind of each binding constraint, checked against the kind declared in the text.
    fn classified(
        &self,
        classification: &ConstraintClassification<'g>,
    ) -> Result<Vec<ClassifiedConstraint>, ModelError> {
        let Some(multipliers) = classification.multipliers() else { return Ok(Vec::new()) };
        multipliers
            .constraints()
            .iter()
            .zip(classification.kinds())
            .map(|(constraint, &kind)| {
                let given = self
                    .model
                    .document()
                    .constraint_text(constraint.name())
                    .and_then(|text| text.kind.as_ref());
                if let (Some(given), ConstraintKind::Nonholonomic { residual }) = (given, kind)
                    && given.value == DeclaredKind::Holonomic
                {
                    let constraint = constraint.name().to_owned();
                    return Err(self
                        .model
                        .document()
                        .error(&given.place, MeaningError::NotHolonomic { constraint, residual }));
                }
                Ok(ClassifiedConstraint { constraint: constraint.name().to_owned(), kind })
            })
            .collect()
    }
}

/// Whether the text declares the constraint as not affine in the velocities.
fn is_called_nonlinear(constraint: &document::Constraint) -> bool {
    constraint.kind.as_ref().is_some_and(|kind| kind.value == DeclaredKind::Nonlinear)
}
