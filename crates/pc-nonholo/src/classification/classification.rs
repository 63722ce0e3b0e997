//! Constraints with their kinds.

use pc_mech::{Constraint, Expr, Multipliers, Neighbourhood, System};

use crate::classification::binding::{Binding, Redundant};
use crate::classification::reach::{Reach, affine};
use crate::error::NonholoError;

/// The kind of a constraint, by Frobenius' theorem.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ConstraintKind {
    /// It restricts positions: f(t, x) = 0.
    Position,
    /// It restricts velocities, but together with the other constraints it can be written f(t, x) = const: it
    /// is holonomic in disguise.
    Integrable,
    /// It restricts velocities but leaves all positions within reach.
    Nonholonomic {
        /// The largest component, along the constraint, of the commutators of the allowed velocities, at the
        /// state where the constraint was tested.
        residual: f64,
    },
    /// It restricts velocities and is not affine in them. Frobenius' test does not apply to it.
    Nonlinear,
}

/// The constraints of a system: those that bind it, each with its kind (Frobenius), and those that follow from
/// them.
#[derive(Clone, Debug)]
pub struct ConstraintClassification<'g> {
    multipliers: Option<Multipliers<'g>>,
    kinds: Vec<ConstraintKind>,
    combinations: usize,
    redundant: Vec<Redundant>,
}

impl<'g> ConstraintClassification<'g> {
    /// Sorts the constraints of a system: by rank into [binding](Binding) and redundant ones, and by
    /// Frobenius' test into holonomic and nonholonomic ones. If X'_1..X'_l and X'_0 are a basis of the
    /// velocities that all constraints allow,
    ///
    ///   [X'_r, X'_s] = c'_rs^m X'_m + c'_rs^α X'_α,   r, s = 0..l,
    ///
    /// the constraint α is integrable if these brackets have no component along it, c'_rs^α = 0, and brackets of
    /// brackets have none either: then the constraint vanishes on the smallest involutive family of fields that
    /// contains X'_0..X'_l. Conditions on positions come first: a condition on velocities may follow from them, but
    /// never the other way round.
    ///
    /// [Nonlinear](Constraint::nonlinear) constraints come last and are ignored both in the rank and in the test of
    /// the other constraints; a constraint that restricts no velocity at almost all states is not tested for
    /// redundancy.
    ///
    /// `at` are values of time, coordinates, quasi-velocities and parameters where the constraints are regular.
    ///
    /// # Errors
    /// [`NonholoError::Contradictory`] for a constraint that contradicts others, so that no velocity
    /// satisfies them all; the errors of [`System::with_multipliers`] and
    /// [`Adapted::new`](crate::Adapted::new).
    pub fn new(
        system: &System<'g>,
        constraints: &[Constraint<'g>],
        at: &[(Expr<'g>, f64)],
    ) -> Result<ConstraintClassification<'g>, NonholoError> {
        let found = Binding::new(system, constraints, at)?;
        let redundant = found.redundant().to_vec();
        let binding: Vec<Constraint<'g>> = found.binding().iter().map(|&a| constraints[a].clone()).collect();
        if binding.is_empty() {
            return Ok(ConstraintClassification {
                multipliers: None,
                kinds: Vec::new(),
                combinations: 0,
                redundant,
            });
        }
        let multipliers = system.with_multipliers(&binding)?;
        let (kinds, combinations) = kinds(&multipliers, at)?;
        Ok(ConstraintClassification { multipliers: Some(multipliers), kinds, combinations, redundant })
    }

    /// The equations of motion with multipliers, unless no constraint binds.
    pub fn multipliers(&self) -> Option<&Multipliers<'g>> {
        self.multipliers.as_ref()
    }

    /// The kind of each constraint that binds, in the order of [`Multipliers::constraints`].
    pub fn kinds(&self) -> &[ConstraintKind] {
        &self.kinds
    }

    /// The number of combinations of the nonholonomic constraints, with coefficients that are functions of time and
    /// coordinates, that are integrable although no single constraint is
    /// ([`IntegrableCombination`](crate::IntegrableCombination) finds them). It is the dimension l + m of the space
    /// of all velocities, where l is that of the allowed velocities, minus the dimension of the smallest involutive
    /// family of fields that contains the allowed fields, minus the number of integrable constraints.
    pub fn integrable_combinations(&self) -> usize {
        self.combinations
    }

    /// The constraints that follow from others.
    pub fn redundant(&self) -> &[Redundant] {
        &self.redundant
    }

    /// Whether all constraints restrict positions or are integrable.
    pub fn is_holonomic(&self) -> bool {
        self.kinds.iter().all(|kind| matches!(kind, ConstraintKind::Position | ConstraintKind::Integrable))
    }
}

/// The kind of each constraint, and the number of integrable combinations; affine constraints are classified
/// as if there were no others.
fn kinds<'g>(
    multipliers: &Multipliers<'g>,
    at: &[(Expr<'g>, f64)],
) -> Result<(Vec<ConstraintKind>, usize), NonholoError> {
    let mut kinds = vec![ConstraintKind::Nonlinear; multipliers.constraints().len()];
    let (affine, Some(without)) = affine(multipliers)? else { return Ok((kinds, 0)) };
    let (of_affine, combinations) = kinds_of_affine(&without, at)?;
    for (a, kind) in affine.into_iter().zip(of_affine) {
        kinds[a] = kind;
    }
    Ok((kinds, combinations))
}

fn kinds_of_affine<'g>(
    multipliers: &Multipliers<'g>,
    at: &[(Expr<'g>, f64)],
) -> Result<(Vec<ConstraintKind>, usize), NonholoError> {
    let m = multipliers.constraints().len();
    if (0..m).all(|a| multipliers.is_holonomic(a)) {
        return Ok((vec![ConstraintKind::Position; m], 0));
    }
    let system = multipliers.equations().system();
    let reach = Reach::new(multipliers, at)?;
    let (graph, near) = (system.graph(), &reach.near);
    let kinds: Vec<ConstraintKind> = (0..m)
        .map(|a| {
            if multipliers.is_holonomic(a) {
                return ConstraintKind::Position;
            }
            let components: Vec<Vec<Expr<'g>>> = reach.reached.iter().map(|along| along[a].clone()).collect();
            if near.residual(graph, &components) <= Neighbourhood::ROUNDING {
                return ConstraintKind::Integrable;
            }
            let sums: Vec<Expr<'g>> = components.into_iter().map(|terms| graph.sum(terms)).collect();
            ConstraintKind::Nonholonomic { residual: near.largest(graph, &graph.shorten(&sums, &[])) }
        })
        .collect();
    let nonholonomic =
        kinds.iter().filter(|kind| matches!(kind, ConstraintKind::Nonholonomic { .. })).count();
    Ok((kinds, nonholonomic.saturating_sub(reach.reached.len())))
}
