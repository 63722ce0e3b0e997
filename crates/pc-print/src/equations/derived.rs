//! Equations of motion in one of their forms, with constraints and reactions.

use pc_mech::{Constraint, Equations, Expr, Maggi, Multipliers};
use pc_model::{Assembly, ConstraintFormulation, ModelError, Variables};
use pc_nonholo::{ConstraintKind, NonholoError, Voronets};

use crate::equations::form::Form;
use crate::equations::principle::Principle;

/// The coefficients c_ji^r of (35) for one pair of independent velocities.
#[derive(Clone, Debug)]
pub struct SolvedBracket<'g> {
    /// j < i, 0 for time.
    pub pair: [usize; 2],
    /// Each coefficient that is not zero, with its r.
    pub components: Vec<(usize, Expr<'g>)>,
}

/// Equations of motion with their constraints and reactions.
#[derive(Clone, Debug)]
pub struct Derived<'g> {
    /// The equations M η̇ = r of the independent quasi-velocities.
    pub equations: Equations<'g>,
    /// The principle by which the equations are written.
    pub principle: Principle<'g>,
    /// The quasi-velocities that constraints keep at zero; sums in the brackets extend over these too.
    pub vanishing: Vec<Expr<'g>>,
    /// The constraints with their kinds.
    pub constraints: Vec<(Constraint<'g>, ConstraintKind)>,
    /// The velocities ẋ_r for which the constraints of Voronets' equations are solved.
    pub dependent: Vec<Expr<'g>>,
    /// The coefficients c_ji^r of (35) that are not zero.
    pub coefficients: Vec<SolvedBracket<'g>>,
    /// The definitions of the vanishing quasi-velocities in terms of velocities, if these definitions are
    /// known.
    pub definitions: Vec<(Expr<'g>, Expr<'g>)>,
    /// The quasi-velocities that are not those of the model, each with its definition.
    pub quasi_velocities: Vec<(Expr<'g>, Expr<'g>)>,
    /// The reactions with their expressions.
    pub reactions: Vec<(Expr<'g>, Expr<'g>)>,
    /// The forces C_αs λ_α of the reactions, each with its velocity; empty unless [asked for](Derived::with_reactions).
    pub reaction_forces: Vec<(Expr<'g>, Expr<'g>)>,
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
            Form::Maggi | Form::Kane | Form::GibbsAppell => Derived::by_principle(form, assembly),
            Form::Voronets => match assembly.voronets()? {
                None => assembly.placed(Derived::of(Form::Lagrange, assembly)),
                Some(voronets) => Derived::solved(&voronets, assembly),
            },
            Form::Poincare | Form::Canonical | Form::Lagrange => assembly.placed(Derived::of(form, assembly)),
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

    /// Voronets' equations, or Chaplygin's.
    fn solved(
        voronets: &Voronets<'g>,
        assembly: &Assembly<'g>,
    ) -> Result<(&'static str, Derived<'g>), ModelError> {
        let name = if voronets.is_chaplygin() { "Chaplygin's equations" } else { "Voronets' equations" };
        let equations = assembly.placed(voronets.system().and_then(|system| Ok(system.poincare()?)))?;
        let (_, lagrange) = assembly.placed(Derived::of(Form::Lagrange, assembly))?;
        let energy_remark = energy_remark(assembly);
        let (dependent, coefficients) = (voronets.solved_velocities(), coefficients(voronets));
        Ok((name, Derived { equations, dependent, coefficients, energy_remark, ..lagrange }))
    }

    /// The equations of the independent quasi-velocities by Maggi, Kane, or Gibbs and Appell.
    fn by_principle(form: Form, assembly: &Assembly<'g>) -> Result<(&'static str, Derived<'g>), ModelError> {
        let name = match form {
            Form::Maggi => "Maggi's equations",
            Form::Kane => "Kane's equations",
            _ => "Gibbs–Appell's equations",
        };
        assembly.placed(affine(assembly, name))?;
        let (_, derived) = assembly.placed(Derived::of(Form::Poincare, assembly))?;
        let derived = Derived { reactions: Vec::new(), ..derived };
        let free = derived.equations.system();
        let balance = || {
            let values = assembly.quasi_velocities_of(free.quasi_velocities())?;
            assembly.placed(assembly.system.force_balance(free.quasi_velocities(), &values))
        };
        let principle = match form {
            Form::Maggi => {
                let (_, lagrange) = assembly.placed(Derived::of(Form::Lagrange, assembly))?;
                let unbound = assembly.placed(lagrange_of(assembly))?;
                let partial = free.frame().b().clone();
                let principle = Principle::Maggi(Box::new(Maggi::new(unbound, partial)));
                let (constraints, definitions) = (lagrange.constraints, Vec::new());
                return Ok((name, Derived { principle, constraints, definitions, ..derived }));
            }
            Form::Kane => Principle::Kane(Box::new(balance()?)),
            _ => Principle::GibbsAppell(Box::new(balance()?)),
        };
        Ok((name, Derived { principle, ..derived }))
    }

    fn of(form: Form, assembly: &Assembly<'g>) -> Result<(&'static str, Derived<'g>), NonholoError> {
        let (bound, system) = (&assembly.constraints, &assembly.system);
        let multipliers = bound.multipliers();
        let kinds = bound.classified().iter().map(|verdict| verdict.kind);
        let constraints = multipliers.map(Multipliers::constraints).unwrap_or_default();
        let plain = Derived {
            equations: assembly.constraints.equations(system, &assembly.at_start())?,
            principle: Principle::Poincare,
            vanishing: Vec::new(),
            dependent: Vec::new(),
            coefficients: Vec::new(),
            constraints: constraints.iter().cloned().zip(kinds.clone()).collect(),
            definitions: Vec::new(),
            quasi_velocities: Vec::new(),
            reactions: Vec::new(),
            reaction_forces: Vec::new(),
            energy_remark: energy_remark(assembly),
        };
        let with = |equations: Equations<'g>, multipliers: &Multipliers<'g>| Derived {
            equations,
            constraints: multipliers.constraints().iter().cloned().zip(kinds.clone()).collect(),
            ..plain.clone()
        };
        Ok(match (form, multipliers) {
            (Form::Lagrange, None) => {
                ("Lagrange's equations", Derived { equations: system.in_velocities()?.poincare()?, ..plain })
            }
            (Form::Lagrange, Some(multipliers)) => {
                let held = multipliers.in_velocities()?;
                let system = held.equations().system().with_added_forces(&held.reaction_forces())?;
                let derived = with(system.poincare()?, &held);
                ("Lagrange's equations with multipliers", Derived { energy_remark: None, ..derived })
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

/// The coefficients c_ji^r of (35) that are not zero.
fn coefficients<'g>(voronets: &Voronets<'g>) -> Vec<SolvedBracket<'g>> {
    let l = voronets.independent().len();
    let pairs = (0..=l).flat_map(|j| (j + 1..=l).map(move |i| [j, i]));
    let of_pair = pairs.map(|[j, i]| {
        let all = voronets.structure(j, i).into_iter().enumerate();
        SolvedBracket { pair: [j, i], components: all.filter(|(_, c)| !c.is_zero()).collect() }
    });
    of_pair.filter(|bracket| !bracket.components.is_empty()).collect()
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

/// Checks that all constraints are affine in the velocities, as this form requires.
fn affine(assembly: &Assembly<'_>, form: &'static str) -> Result<(), NonholoError> {
    let held = assembly.constraints.nonlinear();
    match held.and_then(|held| held.constraints().iter().find(|constraint| constraint.is_nonlinear())) {
        None => Ok(()),
        Some(constraint) => Err(NonholoError::Nonlinear { form, constraint: constraint.name().to_owned() }),
    }
}

/// Lagrange's equations without the constraints; under constraints their mass matrix may be singular.
fn lagrange_of<'g>(assembly: &Assembly<'g>) -> Result<Equations<'g>, NonholoError> {
    Ok(match assembly.constraints.multipliers() {
        None => assembly.system.in_velocities()?.poincare()?,
        Some(multipliers) => multipliers.in_velocities()?.equations().clone(),
    })
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
