//! Equations of motion in one of their forms, with constraints and reactions.

use pc_mech::{Constraint, Equations, Expr, Multipliers};
use pc_model::{Assembly, ConstraintFormulation, ModelError, Variables};
use pc_nonholo::{ConstraintKind, NonholoError, Voronets};

use crate::equations::form::Form;

/// Equations of motion with their constraints and reactions.
#[derive(Clone, Debug)]
pub struct Derived<'g> {
    /// The equations M η̇ = r of the independent quasi-velocities.
    pub equations: Equations<'g>,
    /// The quasi-velocities that constraints keep at zero; sums in the brackets extend over these too.
    pub vanishing: Vec<Expr<'g>>,
    /// The constraints with their kinds.
    pub constraints: Vec<(Constraint<'g>, ConstraintKind)>,
    /// The definitions of the vanishing quasi-velocities in terms of velocities, if these definitions are
    /// known.
    pub definitions: Vec<(Expr<'g>, Expr<'g>)>,
    /// The quasi-velocities that are not those of the model, each with its definition.
    pub quasi_velocities: Vec<(Expr<'g>, Expr<'g>)>,
    /// The reactions with their expressions.
    pub reactions: Vec<(Expr<'g>, Expr<'g>)>,
    /// A remark on the energy.
    pub energy_remark: Option<&'static str>,
}

impl<'g> Derived<'g> {
    /// The equations in a given form, with the name of the form.
    ///
    /// # Errors
    /// [`ModelError`] if the equations have no such form.
    pub fn new(form: Form, assembly: &Assembly<'g>) -> Result<(&'static str, Derived<'g>), ModelError> {
        match form {
            Form::Reduced | Form::LiePoisson => Derived::in_free_form(form, Variables::Reduced, assembly),
            Form::Orthonormal => Derived::in_free_form(form, Variables::Orthonormal, assembly),
            Form::Hamel => Derived::in_free_form(form, Variables::Given, assembly),
            Form::Poincare | Form::Canonical | Form::Lagrange | Form::Voronets => {
                assembly.placed(Derived::of(form, assembly))
            }
        }
    }

    /// Poincaré's equations of the independent quasi-velocities in other coordinates and quasi-velocities.
    fn in_free_form(
        form: Form,
        variables: Variables,
        assembly: &Assembly<'g>,
    ) -> Result<(&'static str, Derived<'g>), ModelError> {
        let free = assembly.free_form(variables)?;
        let left = free.system.frame().coordinates();
        let name = match form {
            Form::Orthonormal => "Poincaré's equations in an orthonormal frame",
            Form::Hamel => "Hamel's equations",
            Form::LiePoisson if left.is_empty() => "Lie–Poisson equations",
            Form::LiePoisson => "canonical equations, reduced",
            _ if left.is_empty() => "Euler–Poincaré equations",
            _ => "Poincaré's equations, reduced",
        };
        let (_, plain) = assembly.placed(Derived::of(Form::Canonical, assembly))?;
        let gone = |c: &Constraint<'g>| {
            let x = assembly.system.frame().coordinates().iter().filter(|x| !left.contains(x));
            x.clone().any(|&x| c.expression().depends_on(x))
        };
        Ok((
            name,
            Derived {
                equations: assembly.placed(free.system.poincare())?,
                quasi_velocities: free.defined(),
                reactions: Vec::new(),
                constraints: plain.constraints.into_iter().filter(|(c, _)| !gone(c)).collect(),
                ..plain
            },
        ))
    }

    fn of(form: Form, assembly: &Assembly<'g>) -> Result<(&'static str, Derived<'g>), NonholoError> {
        let (bound, system) = (&assembly.constraints, &assembly.system);
        let multipliers = bound.multipliers();
        let kinds = bound.classified().iter().map(|verdict| verdict.kind);
        let constraints = multipliers.map(Multipliers::constraints).unwrap_or_default();
        let plain = Derived {
            equations: assembly.constraints.equations(system, &assembly.at_start())?,
            vanishing: Vec::new(),
            constraints: constraints.iter().cloned().zip(kinds.clone()).collect(),
            definitions: Vec::new(),
            quasi_velocities: Vec::new(),
            reactions: Vec::new(),
            energy_remark: energy_remark(assembly),
        };
        let with = |equations: Equations<'g>, multipliers: &Multipliers<'g>| Derived {
            equations,
            constraints: multipliers.constraints().iter().cloned().zip(kinds.clone()).collect(),
            ..plain.clone()
        };
        Ok(match (form, multipliers) {
            (Form::Lagrange | Form::Voronets, None) => {
                ("Lagrange's equations", Derived { equations: system.in_velocities()?.poincare()?, ..plain })
            }
            (Form::Lagrange, Some(multipliers)) => {
                let held = multipliers.in_velocities()?;
                let system = held.equations().system().with_added_forces(&held.reaction_forces())?;
                let derived = with(system.poincare()?, &held);
                ("Lagrange's equations with multipliers", Derived { energy_remark: None, ..derived })
            }
            (Form::Voronets, Some(multipliers)) => {
                let held = multipliers.in_velocities()?;
                let mut transform = system.velocity_transform()?;
                let start = transform.to_velocities(assembly.t_start, &assembly.start);
                let lagrange = held.equations().system();
                let mut at: Vec<(Expr<'g>, f64)> = lagrange.state().into_iter().zip(start).collect();
                at.push((lagrange.frame().time(), assembly.t_start));
                let voronets = match bound.asked_for() {
                    [] => Voronets::shortest(&held, &at)?,
                    independent => Voronets::new(&held.with_independent(independent, &at)?, &at)?,
                };
                let name =
                    if voronets.is_chaplygin() { "Chaplygin's equations" } else { "Voronets' equations" };
                (name, with(voronets.system()?.poincare()?, &held))
            }
            (Form::Poincare, Some(held)) if held.is_nonlinear() => {
                let system = held.equations().system().with_added_forces(&held.reaction_forces())?;
                let reactions = bound.reactions(&assembly.at_start())?;
                let name = "Poincaré's equations with multipliers";
                (name, Derived { reactions, ..with(system.poincare()?, held) })
            }
            (_, _) => {
                let reduced = bound.constrained(&assembly.at_start())?;
                let name = "Poincaré's equations";
                match (reduced, multipliers) {
                    (Some(constrained), Some(multipliers)) => {
                        let reactions = bound.reactions(&assembly.at_start())?;
                        let vanishing = constrained.vanishing().to_vec();
                        let in_velocities = multipliers.in_velocities().ok();
                        let velocities = in_velocities.iter().flat_map(|held| held.velocities().to_vec());
                        let definitions = multipliers.constraints().iter().map(Constraint::expression);
                        let definitions = definitions.zip(velocities).collect();
                        (name, Derived { vanishing, definitions, reactions, ..plain })
                    }
                    _ => (name, plain),
                }
            }
        })
    }
}

impl<'g> Derived<'g> {
    /// The left-hand side of a constraint, with its definition written out if it is a quasi-velocity.
    pub fn vanishing(&self, constraint: &Constraint<'g>) -> Expr<'g> {
        let expression = constraint.expression();
        let known =
            self.definitions.iter().find(|(eta, _)| *eta == expression && self.vanishing.contains(eta));
        known.map_or(expression, |&(_, definition)| definition)
    }
}

/// A remark on the energy of equations in independent velocities, if this energy differs from the `energy` of
/// a run.
pub fn energy_remark(assembly: &Assembly<'_>) -> Option<&'static str> {
    let ConstraintFormulation::Multipliers(held) = assembly.constraints.formulation() else { return None };
    let mut constraints = held.multipliers.constraints().iter();
    let same = held.multipliers.is_nonlinear() || constraints.all(|c| c.is_workless(&assembly.system));
    let remark = if assembly.constraints.held().is_some() { OF_INDEPENDENT } else { OF_ALL_INDEPENDENT };
    (!same).then_some(remark)
}

const OF_ALL_INDEPENDENT: &str = "This energy is y·η − L of the independent velocities (Jacobi's integral), \
                                  not that of all velocities.";

const OF_INDEPENDENT: &str = "This energy is y·η − L of the independent velocities (Jacobi's integral). \
                             The energy of a run is that of all velocities.";
