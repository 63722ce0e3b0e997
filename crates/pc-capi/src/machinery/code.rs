//! A model, derived and compiled, which any number of systems share, and which can be stored.

use std::sync::{Arc, OnceLock};

use ::pc_model::{Flow, Model, Variables, open, seal};
use pc_mech::MechError;
use serde::{Deserialize, Serialize};

use crate::ffi::call_error::CallError;
use crate::machinery::derivations::Derivations;
use crate::machinery::exclusive::Exclusive;
use crate::machinery::system::{Facts, Inner, Inventory, pc_system};

/// The equations of motion of a model, derived and compiled: what all its systems have in
/// common. It never changes, so any number of threads may use it. Free it with pc_code_free.
pub struct pc_code {
    inventory: Arc<Inventory>,
    /// The equations with the values of the model, of which each system has a copy.
    flow: Flow,
}

/// The kind of contents of a stored code.
const KIND: &str = "the code of a model for libpc";

/// What is written.
#[derive(Serialize)]
struct Written<'a> {
    model: &'a Model,
    facts: &'a Facts,
    flow: &'a Flow,
    derivations: &'a Derivations,
}

/// The same as it is read.
#[derive(Deserialize)]
struct Read {
    model: Model,
    facts: Facts,
    flow: Flow,
    derivations: Derivations,
}

impl pc_code {
    pub(crate) fn derive(model: Model, variables: Variables) -> Result<pc_code, CallError> {
        let graph = model.graph();
        let assembly = model.assemble(&graph)?;
        let flow = Flow::new(&model, &assembly, variables)?;
        let parameters = assembly.system.parameters().iter().map(|(symbol, _)| symbol.to_string()).collect();
        let facts = Facts { variables, parameters, t_start: assembly.t_start };
        drop(assembly);
        drop(graph);
        let inventory = Arc::new(Inventory::new(model, facts, &flow, Derivations::default()));
        Ok(pc_code { inventory, flow })
    }

    /// The bytes from which [`load`](pc_code::load) makes the same code, with what has been derived so far.
    pub(crate) fn save(&self) -> Result<Vec<u8>, CallError> {
        let Inventory { model, facts, derivations, .. } = &*self.inventory;
        Ok(seal(KIND, &Written { model, facts, flow: &self.flow, derivations })?)
    }

    /// The code from which [`save`](pc_code::save) made these bytes.
    pub(crate) fn load(bytes: &[u8]) -> Result<pc_code, CallError> {
        let Read { model, facts, flow, derivations } = open(KIND, bytes)?;
        let inventory = Arc::new(Inventory::new(model, facts, &flow, derivations));
        Ok(pc_code { inventory, flow })
    }

    /// A system with the values of the model.
    pub(crate) fn system(&self) -> Result<pc_system, MechError> {
        Ok(pc_system {
            inner: Exclusive::new(Inner::new(&self.inventory, self.flow.clone())?),
            direct: OnceLock::new(),
            inventory: Arc::clone(&self.inventory),
        })
    }
}
