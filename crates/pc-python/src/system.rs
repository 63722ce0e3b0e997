//! Equations of motion, compiled, with the values of parameters and start.

use std::sync::atomic::AtomicBool;
use std::sync::{Mutex, MutexGuard, PoisonError, TryLockError};

use pc_model::{Flow, Model, Variables, deep, name_of, open, seal};
use pc_run::motion::derived::Derived;
use pc_verify::Outlet;
use pyo3::prelude::*;
use serde::{Deserialize, Serialize};

use crate::error::Error;
use crate::kinematics::Kinematics;
use crate::mechanics::Dynamics;
use crate::model::{ModelCore, finite, renewed, variables, vouched};
use crate::task::attended;

/// The equations ẏ = f(t, y) of a model. Any number of threads may use it.
#[pyclass(frozen, subclass, name = "System", module = "chetaev._native")]
pub(crate) struct SystemCore {
    pub(crate) variables: Variables,
    pub(crate) inventory: Inventory,
    state: Mutex<State>,
    /// Locked while values are set, which may take a derivation. No call waits for it, as the call may hold the interpreter's
    /// lock.
    setting: Mutex<()>,
    /// Flows for calls that take a long time, each with the version of its values.
    spare: Mutex<Vec<(u64, Flow)>>,
    pub(crate) dynamics: Mutex<Option<Dynamics>>,
    pub(crate) kinematics: Mutex<Kinematics>,
    /// Whether a motion has been compared with a second derivation.
    pub(crate) verified: AtomicBool,
}

/// What never changes.
pub(crate) struct Inventory {
    pub(crate) names: Vec<String>,
    pub(crate) t_start: f64,
    pub(crate) conserved: usize,
    /// The names of the columns of a motion: coordinates, quasi-velocities, first-order states, then
    /// observables.
    pub(crate) columns: Vec<String>,
    pub(crate) shown: usize,
    /// Whether equations are compared with a second derivation before they are returned.
    pub(crate) verify: bool,
}

/// What changes with the values.
pub(crate) struct State {
    pub(crate) model: Model,
    pub(crate) derived: Derived,
    version: u64,
}

/// The kind of contents of a saved system.
const KIND: &str = "the equations of a system for Python";

/// Equations as they are pickled.
#[derive(Serialize, Deserialize)]
struct Saved {
    /// What they were derived from.
    name: String,
    t_start: f64,
    derived: Derived,
}

impl Saved {
    /// The equations of this model, if that is what the bytes contain.
    fn of(model: &Model, variables: Variables, saved: &[u8]) -> Option<Saved> {
        let name = name_of(KIND, &(model, variables)).ok()?;
        open(KIND, saved).ok().filter(|saved: &Saved| saved.name == name)
    }
}

impl SystemCore {
    /// Locks the state, which is held while a state is evaluated, and never while Python may run.
    pub(crate) fn state(&self) -> MutexGuard<'_, State> {
        // What a panic leaves behind is room that is written before it is read.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A flow with the present values, to be returned with [`put_back`](SystemCore::put_back).
    pub(crate) fn take(&self) -> (u64, Flow) {
        let state = self.state();
        let mut spare = self.spare.lock().unwrap_or_else(PoisonError::into_inner);
        spare.retain(|(version, _)| *version == state.version);
        spare.pop().unwrap_or_else(|| (state.version, state.derived.flow.clone()))
    }

    pub(crate) fn put_back(&self, flow: (u64, Flow)) {
        self.spare.lock().unwrap_or_else(PoisonError::into_inner).push(flow);
    }

    /// The model with the present values, and its equations.
    pub(crate) fn now(&self) -> (Model, Derived) {
        let state = self.state();
        (state.model.clone(), state.derived.clone())
    }

    /// Does work that derives something from the model with the present values.
    pub(crate) fn derive<T: Send + 'static>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&Model) -> Result<T, Error> + Send + 'static,
    ) -> PyResult<T> {
        let (mut model, _) = self.now();
        let cancel = renewed(&mut model);
        attended(py, &cancel, |_| Ok(()), move || deep(|| work(&model)))
    }

    pub(crate) fn dim(&self) -> usize {
        self.inventory.names.len()
    }
}

#[pymethods]
impl SystemCore {
    /// `saved` is what `_saved_equations` gives for the same model and form; anything else is not used.
    #[new]
    #[pyo3(signature = (model, form, saved=None))]
    fn new(py: Python<'_>, model: &ModelCore, form: &str, saved: Option<&[u8]>) -> PyResult<SystemCore> {
        let variables = variables(form)?;
        let verify = model.verify;
        let mut model = model.model.clone();
        let cancel = renewed(&mut model);
        let saved = saved.map(<[u8]>::to_vec);
        let derive = move || {
            deep(|| {
                if let Some(Saved { derived, t_start, .. }) =
                    saved.and_then(|saved| Saved::of(&model, variables, &saved))
                {
                    return Ok((model, derived, t_start));
                }
                let graph = model.graph();
                let assembly = model.assemble(&graph)?;
                let derived = Derived::of(&model, &assembly, variables)?;
                let t_start = assembly.t_start;
                if verify {
                    vouched(&model, &assembly, Outlet::Equations(variables))?;
                    assembly.within_limits()?;
                }
                drop(assembly);
                drop(graph);
                Ok((model, derived, t_start))
            })
        };
        let (model, derived, t_start) = attended(py, &cancel, |_| Ok(()), derive)?;
        let (flow, motion) = (&derived.flow, &derived.flow.motion);
        let inventory = Inventory {
            names: motion.names().to_vec(),
            t_start,
            conserved: motion.conserved_len(),
            columns: flow.columns(),
            shown: flow.names.len(),
            verify,
        };
        let state = State { version: 0, model, derived };
        Ok(SystemCore {
            variables,
            inventory,
            state: Mutex::new(state),
            setting: Mutex::new(()),
            spare: Mutex::new(Vec::new()),
            dynamics: Mutex::new(None),
            kinematics: Mutex::default(),
            verified: AtomicBool::new(false),
        })
    }

    /// The equations with the present values, as bytes.
    #[pyo3(name = "_saved_equations")]
    fn saved(&self) -> PyResult<Vec<u8>> {
        let (model, derived) = self.now();
        let name = name_of(KIND, &(&model, self.variables)).map_err(Error::from)?;
        let saved = Saved { name, t_start: self.inventory.t_start, derived };
        Ok(seal(KIND, &saved).map_err(Error::from)?)
    }

    /// Names of the components of a state.
    #[getter(_state_names)]
    fn state_names(&self) -> Vec<String> {
        self.inventory.names.clone()
    }

    /// Names of the columns of a motion, without t.
    #[getter(_column_names)]
    fn column_names(&self) -> Vec<String> {
        self.inventory.columns.clone()
    }

    /// The time at the start.
    #[getter(_t_start)]
    fn t_start(&self) -> f64 {
        self.inventory.t_start
    }

    /// The state at the start.
    #[pyo3(name = "_start_state")]
    fn start_state(&self) -> Vec<f64> {
        self.state().derived.flow.start.clone()
    }

    /// The model with the present values.
    #[pyo3(name = "_model_now")]
    fn model_now(&self) -> ModelCore {
        ModelCore { model: self.state().model.clone(), verify: self.inventory.verify }
    }

    /// Gives parameters and start new values: all of them, or none if that fails.
    #[pyo3(name = "_update")]
    fn update(
        &self,
        py: Python<'_>,
        parameters: Vec<(String, f64)>,
        start: Vec<(String, f64)>,
    ) -> PyResult<()> {
        let _alone = match self.setting.try_lock() {
            Err(TryLockError::WouldBlock) => return Err(Error::Busy.into()),
            Err(TryLockError::Poisoned(held)) => held.into_inner(),
            Ok(held) => held,
        };
        let mut model = self.state().model.clone();
        for (name, value) in &parameters {
            model.set(name, finite(name, *value)?).map_err(Error::from)?;
        }
        for (name, value) in &start {
            model.set_start(name, finite(name, *value)?).map_err(Error::from)?;
        }
        let cancel = renewed(&mut model);
        let (variables, t_start) = (self.variables, self.inventory.t_start);
        let (derived, known) = (self.state().derived.clone(), model.clone());
        let work = move || deep(|| Ok(derived.renewed(&known, variables, t_start)?));
        let derived = attended(py, &cancel, |_| Ok(()), work)?;
        let mut state = self.state();
        state.model = model;
        state.derived = derived;
        state.version += 1;
        Ok(())
    }
}
