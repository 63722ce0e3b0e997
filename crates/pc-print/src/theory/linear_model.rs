//! A model made ready for its linear theory.

use pc_analysis::{AnalysisError, Conserved, Integrals, Leaf, Linearizer};
use pc_mech::{Equations, Expr, Multipliers};
use pc_model::Assembly;

/// The compiled equations of a model near steady states, with the relations that its motions keep.
pub struct LinearModel<'g> {
    /// The equations that are linearized.
    pub linearizer: Linearizer,
    /// The start in the variables of these equations.
    pub start: Vec<f64>,
    /// The equations with multipliers, if it is these that are linearized.
    held: Option<Multipliers<'g>>,
    leaf: Leaf<'g>,
}

impl<'g> LinearModel<'g> {
    /// The linear theory of a model with these `equations` in independent quasi-velocities; `integrals` are asked for if the
    /// frame keeps functions of the coordinates, and `inputs` are the parameters that are inputs.
    ///
    /// # Errors
    /// [`AnalysisError`] if the equations cannot be compiled.
    pub fn of(
        assembly: &Assembly<'g>,
        equations: &Equations<'g>,
        integrals: impl FnOnce() -> Integrals<'g>,
        inputs: &[&str],
    ) -> Result<LinearModel<'g>, AnalysisError> {
        let mut leaf = Leaf::of(&assembly.system);
        leaf.positions = assembly.held_positions().into_iter().map(|(_, f)| f).collect();
        if leaf.codimension() > 0 {
            leaf.kept = of_coordinates(equations, &integrals());
        }
        let held = held(assembly, equations);
        let linearizer = match &held {
            Some(held) => Linearizer::with_multipliers(held, &leaf, inputs)?,
            None => Linearizer::new(equations, &leaf, inputs)?,
        };
        let start = match held {
            Some(_) => assembly.start.clone(),
            None => assembly.start_of(&equations.system().state()),
        };
        Ok(LinearModel { linearizer, start, held, leaf })
    }

    /// The functions of the state that motions keep.
    pub fn conserved(&self, equations: &Equations<'g>, integrals: &Integrals<'g>) -> Conserved<'g> {
        Conserved::of(equations, self.held.as_ref(), &self.leaf, integrals.list())
    }
}

/// The equations with multipliers, if these are to be linearized: under holonomic constraints, since no choice of independent
/// velocities is regular everywhere, under constraints that are not affine, and under nonholonomic ones if the choice made
/// has a pole nearby. Otherwise independent velocities are better: coordinates are cyclic for these that are not for all.
fn held<'g>(assembly: &Assembly<'g>, equations: &Equations<'g>) -> Option<Multipliers<'g>> {
    let held = assembly.constraints.held()?;
    let is_holonomic = (0..held.constraints().len()).all(|a| held.is_holonomic(a));
    if is_holonomic || held.is_nonlinear() {
        return Some(held.clone());
    }
    let (all, own) = (assembly.system.quasi_velocities(), equations.system().quasi_velocities());
    let dependent: Vec<usize> = (0..all.len()).filter(|&s| !own.contains(&all[s])).collect();
    let is_regular = held.determines_near(&dependent, &assembly.at_start());
    (!is_regular).then(|| held.depending(dependent))
}

/// The integrals that are functions of the coordinates alone.
fn of_coordinates<'g>(equations: &Equations<'g>, integrals: &Integrals<'g>) -> Vec<Expr<'g>> {
    let system = equations.system();
    let others: Vec<Expr<'g>> = system
        .quasi_velocities()
        .iter()
        .copied()
        .chain(system.states().iter().map(|&(z, _)| z))
        .chain([system.frame().time()])
        .collect();
    let conserved =
        integrals.list().iter().filter(|integral| integral.is_conserved() && !integral.is_energy());
    conserved.map(|integral| integral.value).filter(|f| !others.iter().any(|&y| f.depends_on(y))).collect()
}
