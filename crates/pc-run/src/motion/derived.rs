//! The equations of a model in one form, derived and compiled once for any number of runs.

use std::sync::Arc;

use pc_mech::Expr;
use pc_model::{Assembly, Flow, Model, ModelError, Prototype, Variables};
use pc_report::dropped;
use serde::{Deserialize, Serialize};

/// The equations of a model in one form, compiled, with remarks on them.
#[derive(Clone, Serialize, Deserialize)]
pub struct Derived {
    /// The equations, with the values of the model.
    pub flow: Flow,
    /// The equations as a prototype for other values; none if other values may change more than the numbers
    /// in them.
    pub prototype: Option<Arc<Prototype>>,
    /// Remarks on the equations.
    pub(crate) facts: Facts,
}

/// Facts about the equations that are remembered after they are compiled.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Facts {
    /// The constraints that were dropped, each with the reason.
    pub(crate) dropped: Vec<(String, String)>,
    /// Whether forces or the Lagrangian are discontinuous functions of the state.
    pub(crate) jumps: bool,
    /// Whether an event changes the state.
    pub(crate) has_resets: bool,
    /// Whether the energy is conserved: nothing depends on time, and neither forces nor events change the
    /// energy.
    pub(crate) keeps_energy: bool,
}

impl Facts {
    pub(crate) fn of(assembly: &Assembly<'_>) -> Facts {
        let has_resets = assembly.events.iter().any(pc_model::Event::changes_state);
        Facts {
            dropped: dropped(assembly),
            jumps: jumps(assembly),
            has_resets,
            keeps_energy: assembly.keeps_energy() && !has_resets,
        }
    }
}

impl Derived {
    /// The equations of an assembled model in a form.
    ///
    /// # Errors
    /// [`ModelError`] at the place in the text that causes the error.
    pub fn of(model: &Model, assembly: &Assembly<'_>, form: Variables) -> Result<Derived, ModelError> {
        let flow = Flow::new(model, assembly, form)?;
        let prototype = Prototype::of(model, assembly, form, flow.clone()).map(Arc::new);
        Ok(Derived { prototype, facts: Facts::of(assembly), flow })
    }

    /// The same equations for a model with other values.
    ///
    /// # Errors
    /// [`ModelError`] if the equations have to be derived anew and cannot be.
    pub fn renewed(&self, model: &Model, form: Variables, t_start: f64) -> Result<Derived, ModelError> {
        match self.with_values(model, t_start) {
            Some(derived) => Ok(derived),
            None => model.derived(|assembly| Derived::of(model, assembly, form)),
        }
    }

    /// The same equations for a model with other values, unless these change more than the numbers in them.
    pub fn with_values(&self, model: &Model, t_start: f64) -> Option<Derived> {
        let flow = self.prototype.as_ref()?.flow(model, t_start)?;
        Some(Derived { flow, prototype: self.prototype.clone(), facts: self.facts.clone() })
    }
}

fn jumps(assembly: &Assembly<'_>) -> bool {
    let (system, graph) = (&assembly.system, assembly.system.graph());
    let (state, lagrangian) = (system.state(), system.lagrangian());
    let jumps = |&f: &Expr<'_>| graph.applies(f, &state, |function| !function.is_continuous());
    system.forces().iter().chain([&lagrangian]).any(jumps)
}
