//! The treatment of constraints, and the equations of motion under them.

use std::cell::OnceCell;

use pc_expr::SymbolPlaces;
use pc_mech::{Constraint, ConstraintError, Equations, Expr, MechError, Multipliers, System};
use pc_nonholo::{Adapted, Constrained, ConstraintKind, IntegrableCombination, NonholoError, Redundant};

/// A constraint with its kind.
#[derive(Clone, Debug, PartialEq)]
pub struct ClassifiedConstraint {
    /// Its name.
    pub constraint: String,
    /// Its kind.
    pub kind: ConstraintKind,
}

/// The constraints of a model.
#[derive(Clone, Debug)]
pub struct ConstraintTreatment<'g> {
    formulation: ConstraintFormulation<'g>,
    multipliers: Option<Multipliers<'g>>,
    classified: Vec<ClassifiedConstraint>,
    combinations: usize,
    redundant: Vec<Redundant>,
    undetermined: Vec<String>,
    /// The velocities requested as independent; empty if the choice is left open.
    independent: Vec<Expr<'g>>,
    chosen: OnceCell<Chosen>,
}

/// The indices of the dependent quasi-velocities of a choice, and the values of time and state for which it
/// was made.
#[derive(Clone, Debug)]
struct Chosen {
    at: Vec<f64>,
    dependent: Vec<usize>,
}

/// The formulation of the constraints.
#[derive(Clone, Debug)]
pub enum ConstraintFormulation<'g> {
    /// There are no constraints.
    Free,
    /// Each constraint makes a quasi-velocity of the system vanish: the others have equations (30).
    Vanishing(Box<Constrained<'g>>),
    /// The constraints are of any other kind, and are enforced by multipliers.
    Multipliers(Box<MultiplierFormulation<'g>>),
}

/// Constraints enforced by multipliers.
#[derive(Clone, Debug)]
pub struct MultiplierFormulation<'g> {
    /// The equations of motion in all quasi-velocities, with multipliers.
    pub multipliers: Multipliers<'g>,
    /// Whether all constraints are integrable.
    pub holonomic: bool,
}

impl<'g> ConstraintTreatment<'g> {
    pub(crate) fn free() -> ConstraintTreatment<'g> {
        ConstraintTreatment::nothing(Vec::new())
    }

    /// The treatment if no constraint binds; `redundant` are the constraints that were dropped.
    pub(crate) fn nothing(redundant: Vec<Redundant>) -> ConstraintTreatment<'g> {
        ConstraintTreatment {
            formulation: ConstraintFormulation::Free,
            multipliers: None,
            classified: Vec::new(),
            combinations: 0,
            redundant,
            undetermined: Vec::new(),
            independent: Vec::new(),
            chosen: OnceCell::new(),
        }
    }

    /// The treatment of constraints that bind, in this formulation.
    pub(crate) fn new(
        formulation: ConstraintFormulation<'g>,
        multipliers: Multipliers<'g>,
        classified: Vec<ClassifiedConstraint>,
        redundant: Vec<Redundant>,
    ) -> ConstraintTreatment<'g> {
        let multipliers = Some(multipliers);
        ConstraintTreatment {
            formulation,
            multipliers,
            classified,
            combinations: 0,
            redundant,
            undetermined: Vec::new(),
            independent: Vec::new(),
            chosen: OnceCell::new(),
        }
    }

    pub(crate) fn with_integrable_combinations(self, combinations: usize) -> ConstraintTreatment<'g> {
        ConstraintTreatment { combinations, ..self }
    }

    /// The same constraints in another formulation.
    pub(crate) fn in_formulation(self, formulation: ConstraintFormulation<'g>) -> ConstraintTreatment<'g> {
        ConstraintTreatment { formulation, ..self }
    }

    /// The same constraints with these velocities as the independent ones wherever there is a choice.
    pub(crate) fn with_independent(self, independent: Vec<Expr<'g>>) -> ConstraintTreatment<'g> {
        ConstraintTreatment { independent, chosen: OnceCell::new(), ..self }
    }

    /// The velocities requested as independent; empty if the choice is left open.
    pub fn asked_for(&self) -> &[Expr<'g>] {
        &self.independent
    }

    /// The equations with multipliers, if these equations are integrated; `None` if independent velocities
    /// were requested.
    pub fn held(&self) -> Option<&Multipliers<'g>> {
        match &self.formulation {
            ConstraintFormulation::Multipliers(held) if self.independent.is_empty() => {
                Some(&held.multipliers)
            }
            _ => None,
        }
    }

    /// The equations of a formulation with multipliers, with the requested independent quasi-velocities or,
    /// among the choices that are regular at the values `at`, those whose equations are
    /// [shortest](Multipliers::shortest).
    fn chosen(
        &self,
        held: &MultiplierFormulation<'g>,
        at: &[(Expr<'g>, f64)],
    ) -> Result<Multipliers<'g>, NonholoError> {
        let there: Vec<f64> = at.iter().map(|&(_, value)| value).collect();
        if let Some(known) = self.chosen.get().filter(|known| known.at == there) {
            return Ok(held.multipliers.depending(known.dependent.clone()));
        }
        let chosen = match self.independent.as_slice() {
            [] if held.holonomic => {
                held.multipliers.shortest(at, |chosen| chosen.in_independent_velocities(at)?.poincare())?
            }
            [] => held.multipliers.shortest(at, |chosen| {
                Ok::<_, NonholoError>(Adapted::new(chosen, at)?.constrained()?.equations().clone())
            })?,
            independent => held.multipliers.with_independent(independent, at)?,
        };
        // The choice is kept for the values for which it is first made.
        self.chosen.get_or_init(|| Chosen { at: there, dependent: chosen.dependent().to_vec() });
        Ok(chosen)
    }

    /// Checks that the requested independent quasi-velocities, if any, are the `free` ones, since there is no
    /// other choice where constraints make quasi-velocities of the model vanish or no constraint binds.
    fn check_no_choice(&self, free: &[Expr<'g>]) -> Result<(), NonholoError> {
        let is_other = |chosen: &[Expr<'g>]| {
            chosen.len() != free.len() || !chosen.iter().all(|chosen| free.contains(chosen))
        };
        if self.independent.is_empty() || !is_other(&self.independent) {
            return Ok(());
        }
        let names = |list: &[Expr<'g>]| list.iter().map(Expr::to_string).collect::<Vec<_>>();
        let why = format!("the independent ones are {}", names(free).join(", "));
        let error = ConstraintError::NotIndependent { chosen: names(&self.independent), why };
        Err(MechError::from(error).into())
    }

    pub(crate) fn with_undetermined(self, undetermined: Vec<String>) -> ConstraintTreatment<'g> {
        ConstraintTreatment { undetermined, ..self }
    }

    /// The equations with multipliers, unless no constraint binds.
    pub fn multipliers(&self) -> Option<&Multipliers<'g>> {
        self.multipliers.as_ref()
    }

    /// The formulation of the constraints.
    pub fn formulation(&self) -> &ConstraintFormulation<'g> {
        &self.formulation
    }

    /// The binding constraints with their kinds.
    pub fn classified(&self) -> &[ClassifiedConstraint] {
        &self.classified
    }

    /// The number of combinations of the nonholonomic constraints that are integrable although no
    /// single constraint is: see
    /// [`ConstraintClassification`](pc_nonholo::ConstraintClassification::integrable_combinations).
    pub fn integrable_combinations(&self) -> usize {
        self.combinations
    }

    /// The integrable combinations that are found in closed form; `at` are values of time and state where the
    /// constraints are regular.
    ///
    /// # Errors
    /// [`NonholoError`]; it does not occur if the constraints could be classified at these values.
    pub fn combinations_found(
        &self,
        at: &[(Expr<'g>, f64)],
    ) -> Result<Vec<IntegrableCombination<'g>>, NonholoError> {
        let Some(multipliers) = &self.multipliers else { return Ok(Vec::new()) };
        let kinds: Vec<ConstraintKind> = self.classified.iter().map(|verdict| verdict.kind).collect();
        IntegrableCombination::find(multipliers, &kinds, self.combinations, at)
    }

    /// The functions f of the conditions f(t, x) = 0 enforced by multipliers, if all constraints are
    /// integrable.
    pub fn positions(&self, system: &System<'g>) -> Option<Vec<Expr<'g>>> {
        let is_holonomic = |verdict: &ClassifiedConstraint| {
            matches!(verdict.kind, ConstraintKind::Position | ConstraintKind::Integrable)
        };
        if !self.classified.iter().all(is_holonomic) {
            return None;
        }
        let ConstraintFormulation::Multipliers(held) = &self.formulation else { return Some(Vec::new()) };
        let positions = held.multipliers.constraints().iter().filter(|c| c.is_holonomic(system));
        Some(positions.map(Constraint::expression).collect())
    }

    /// The constraints that follow from other constraints and were dropped.
    pub fn redundant(&self) -> &[Redundant] {
        &self.redundant
    }

    /// Descriptions of the reaction forces on bodies that are observed but not determined by virtual work: each
    /// is `the force on`, followed by the name of the body.
    pub fn undetermined(&self) -> &[String] {
        &self.undetermined
    }

    /// The system in a frame in which the constraints make quasi-velocities vanish: the frame of the model if it is
    /// such a frame, otherwise the frame that is best at the values `at` of time and state. `None` if there are no
    /// constraints, if all of them are integrable and enforced by multipliers, or if one is not affine in the
    /// velocities.
    ///
    /// # Errors
    /// [`NonholoError`] if there is no such frame.
    pub fn constrained(&self, at: &[(Expr<'g>, f64)]) -> Result<Option<Constrained<'g>>, NonholoError> {
        Ok(match &self.formulation {
            ConstraintFormulation::Free => None,
            ConstraintFormulation::Vanishing(constrained) => {
                self.check_no_choice(constrained.equations().system().quasi_velocities())?;
                Some(Constrained::clone(constrained))
            }
            ConstraintFormulation::Multipliers(held) if held.holonomic || held.multipliers.is_nonlinear() => {
                None
            }
            ConstraintFormulation::Multipliers(held) => {
                Some(Adapted::new(&self.chosen(held, at)?, at)?.constrained()?)
            }
        })
    }

    /// The symbols λ of the reactions with their values in the frame of
    /// [`constrained`](ConstraintTreatment::constrained), as functions of time, coordinates and the free
    /// quasi-velocities, or of all quasi-velocities where constraints are not affine in these; empty if integrable
    /// constraints are enforced by multipliers. The values contain the symbols of the accelerations if that makes them
    /// shorter.
    ///
    /// # Errors
    /// As for [`constrained`](ConstraintTreatment::constrained).
    pub fn reactions(&self, at: &[(Expr<'g>, f64)]) -> Result<Vec<(Expr<'g>, Expr<'g>)>, NonholoError> {
        if let Some(held) = self.nonlinear() {
            return Ok(held.reactions().iter().copied().zip(held.reactions_of_state()?).collect());
        }
        let (Some(constrained), Some(multipliers)) = (self.constrained(at)?, &self.multipliers) else {
            return Ok(Vec::new());
        };
        let graph = constrained.system().graph();
        let accelerations = constrained.equations().system().accelerations();
        let (solved, open) = (constrained.reactions(), constrained.reactions_by(&accelerations));
        let shorter =
            |(solved, open)| if graph.size(&[solved]) > graph.size(&[open]) { open } else { solved };
        let values: Vec<Expr<'g>> = solved.into_iter().zip(open).map(shorter).collect();
        // Constraints that are quasi-velocities keep the order of these, others their own.
        let place = |(a, constraint): (usize, &Constraint<'g>)| {
            constrained.vanishing().iter().position(|&eta| eta == constraint.expression()).unwrap_or(a)
        };
        let places = multipliers.constraints().iter().enumerate().map(place);
        Ok(multipliers.reactions().iter().copied().zip(places.map(|a| values[a])).collect())
    }

    /// The equations with multipliers, if a constraint is not affine in the velocities, so that there are no
    /// independent velocities.
    pub fn nonlinear(&self) -> Option<&Multipliers<'g>> {
        self.multipliers.as_ref().filter(|multipliers| multipliers.is_nonlinear())
    }

    /// The equations of motion in independent quasi-velocities: (9), (14) or (30). Under constraints enforced by
    /// multipliers, the equations use the requested independent quasi-velocities or, among the choices regular at
    /// `at`, those whose equations are shortest, and the reactions are substituted in observables. If a constraint
    /// is not affine in the velocities, the result is the equations in all velocities, with the reactions
    /// substituted.
    ///
    /// # Errors
    /// [`NonholoError`] if the equations cannot be derived.
    pub fn equations(
        &self,
        system: &System<'g>,
        at: &[(Expr<'g>, f64)],
    ) -> Result<Equations<'g>, NonholoError> {
        let equations = match self.constrained(at)? {
            Some(constrained) => constrained.equations().clone(),
            None => self.independent(system, at)?.poincare()?,
        };
        let ConstraintFormulation::Multipliers(held) = &self.formulation else { return Ok(equations) };
        let (multipliers, observing) = (&held.multipliers, equations.system());
        let mut observed = observing.integrals().iter().chain(observing.outputs());
        if !observed.any(|(_, f)| multipliers.reactions().iter().any(|&reaction| f.depends_on(reaction))) {
            return Ok(equations);
        }
        let free = observing.quasi_velocities().iter().copied();
        let accelerations: Vec<_> = free.zip(equations.accelerations()).collect();
        let reactions = multipliers.reactions_of_independent(&accelerations)?;
        let known: Vec<_> = multipliers.reactions().iter().copied().zip(reactions).collect();
        Ok(equations.with_observed(&known))
    }

    /// The system of the independent quasi-velocities whose equations (9) are the equations of motion.
    ///
    /// # Errors
    /// As for [`equations`](ConstraintTreatment::equations).
    pub fn free_system(
        &self,
        system: &System<'g>,
        at: &[(Expr<'g>, f64)],
    ) -> Result<System<'g>, NonholoError> {
        match self.constrained(at)? {
            Some(constrained) => constrained.free_system(),
            None => self.independent(system, at),
        }
    }

    pub(crate) fn quasi_velocities_of(
        &self,
        all: &[Expr<'g>],
        free: &[Expr<'g>],
    ) -> Result<Vec<Expr<'g>>, NonholoError> {
        let free = SymbolPlaces::of(free);
        let dependent: Vec<usize> = (0..all.len()).filter(|&s| !free.contains(all[s])).collect();
        let solved: Vec<(Expr<'g>, Expr<'g>)> = match &self.formulation {
            ConstraintFormulation::Multipliers(held) if !dependent.is_empty() => {
                held.multipliers.solved_for(&dependent)?
            }
            ConstraintFormulation::Free
            | ConstraintFormulation::Vanishing(_)
            | ConstraintFormulation::Multipliers(_) => {
                dependent.iter().map(|&s| (all[s], Expr::ZERO)).collect()
            }
        };
        let places = SymbolPlaces::of(&solved.iter().map(|&(eta, _)| eta).collect::<Vec<_>>());
        Ok(all.iter().map(|&eta| places.get(eta).map_or(eta, |place| solved[place].1)).collect())
    }

    fn independent(&self, system: &System<'g>, at: &[(Expr<'g>, f64)]) -> Result<System<'g>, NonholoError> {
        match &self.formulation {
            ConstraintFormulation::Multipliers(held) if held.multipliers.is_nonlinear() => {
                self.check_no_choice(system.quasi_velocities())?;
                Ok(held.multipliers.with_reactions_put_in()?)
            }
            ConstraintFormulation::Multipliers(held) => {
                Ok(self.chosen(held, at)?.in_independent_velocities(at)?)
            }
            ConstraintFormulation::Free => {
                self.check_no_choice(system.quasi_velocities())?;
                Ok(system.clone())
            }
            ConstraintFormulation::Vanishing(_) => Ok(system.clone()),
        }
    }
}
