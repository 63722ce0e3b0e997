//! Equations of motion: what they are of, and their parameters.

use std::ffi::{CString, c_char};
use std::sync::{Arc, OnceLock};

use ::pc_model::{Flow, FlowEvents, Model, Parameters, Variables};
use pc_expr::{Event, Events, Pattern};
use pc_mech::{Graph, LegendreTransform, VectorField};

use crate::api::mechanics::Mechanics;
use crate::api::model::pc_model;
use crate::api::options::{pc_system_options, take};
use crate::ffi::boundary::{entry, free};
use crate::ffi::error::{Fault, pc_error};
use crate::ffi::pointer::{clear, finite, handle, numbers, room, write};
use crate::ffi::status::pc_status;
use crate::ffi::strings::{c_string, c_strings, nth};
use crate::machinery::exclusive::Held;
use crate::machinery::field::Field;
use crate::machinery::lock_free_rhs::Direct;

/// The equations of motion of a model, compiled: ẏ = f(t, y). Free it with pc_system_free.
pub struct pc_system {
    /// Dropped first: what functions of the program destroy may look at names.
    pub(crate) inner: Held<Inner>,
    /// What needs the field to live, but not to be held; known after the first evaluation.
    direct: OnceLock<Option<Direct>>,
    pub(crate) inventory: Arc<Inventory>,
}

/// What never changes.
pub(crate) struct Inventory {
    pub(crate) model: Model,
    pub(crate) variables: Variables,
    names: Vec<CString>,
    coordinates: usize,
    states: usize,
    parameters: Vec<CString>,
    pub(crate) observables: Vec<CString>,
    pub(crate) conserved: usize,
    constraints: Vec<CString>,
    /// Places of the reactions among the observables, with their names.
    pub(crate) reactions: Vec<usize>,
    pub(crate) pattern: Option<Pattern>,
    /// The quasi-velocities on which external forces act.
    pub(crate) forces: Vec<CString>,
    t_start: f64,
    start: Vec<f64>,
    pub(crate) events: Vec<Event>,
    pub(crate) event_names: Vec<CString>,
}

impl Inventory {
    /// Length of the state.
    pub(crate) fn dim(&self) -> usize {
        self.names.len()
    }

    /// The time and state from which the model starts.
    pub(crate) fn start(&self) -> (f64, &[f64]) {
        (self.t_start, &self.start)
    }
}

#[derive(Clone)]
pub(crate) struct Inner {
    pub(crate) field: Field,
    /// The values of the parameters, of which some follow others.
    values: Parameters,
    /// The time and state with the values of the integrals that are kept by projection.
    kept_at: (f64, Vec<f64>),
    /// What happens where; none in most models.
    pub(crate) events: FlowEvents,
    /// Derived when first asked for.
    pub(crate) mechanics: Option<Mechanics>,
    pub(crate) legendre: Option<LegendreTransform>,
}

impl pc_system {
    /// `reactions` says whether there are reactions among the outputs.
    fn new(model: Model, variables: Variables, reactions: bool) -> Result<pc_system, Fault> {
        let graph = Graph::new();
        let assembly = model.assemble(&graph)?;
        let flow = Flow::new(&model, &assembly, variables)?;
        let motion = &flow.motion;
        let parameters: Vec<_> =
            assembly.system.parameters().iter().map(|(symbol, _)| symbol.to_string()).collect();
        let observables = motion.observable_names();
        let constraints = &model.document().constraints;
        let names: Vec<String> = constraints.iter().map(|c| format!("λ_{}", c.name.text)).collect();
        // After the outputs of the model, of which one may be called as they are.
        let places = motion.conserved_len() + model.document().outputs.len()..observables.len();
        let reactions = places.filter(|&i| reactions && names.contains(&observables[i]));
        let forces = model.external_forces();
        let pattern = match forces.as_slice() {
            [] => motion.sparsity().cloned(),
            _ => Some(Pattern::full(motion.dim(), motion.dim())),
        };
        let inventory = Inventory {
            variables,
            names: c_strings(motion.names()),
            coordinates: motion.coordinates(),
            states: motion.states(),
            parameters: c_strings(&parameters),
            observables: c_strings(observables),
            conserved: motion.conserved_len(),
            constraints: c_strings(motion.constraint_names()),
            reactions: reactions.collect(),
            pattern,
            forces: c_strings(&forces),
            t_start: assembly.t_start,
            start: flow.start.clone(),
            events: flow.events.events().to_vec(),
            event_names: flow.events.events().iter().map(|event| c_string(event.name())).collect(),
            model,
        };
        let field = Field::new(flow.motion, forces)?;
        let kept_at = (assembly.t_start, flow.start);
        let values = inventory.model.parameter_values().clone();
        let inner = Inner { field, values, kept_at, events: flow.events, mechanics: None, legendre: None };
        Ok(pc_system { inventory: Arc::new(inventory), direct: OnceLock::new(), inner: Held::new(inner) })
    }

    /// Another one of the same equations.
    fn copy(&self) -> Result<pc_system, Fault> {
        let mut inner = self.inner.take()?.clone();
        let direct = OnceLock::new();
        if self.direct().is_some() {
            // The code is there, and the copy has it as well.
            direct.get_or_init(|| Direct::of(&mut inner.field));
        }
        Ok(pc_system { inventory: Arc::clone(&self.inventory), direct, inner: Held::new(inner) })
    }

    /// The machine code of f, where it is all that f is, and known to be.
    #[inline]
    pub(crate) fn direct(&self) -> Option<&Direct> {
        self.direct.get()?.as_ref()
    }

    /// So that evaluations from now on need only the machine code, if that is all.
    pub(crate) fn prepare_direct(&self, inner: &mut Inner) {
        self.direct.get_or_init(|| Direct::of(&mut inner.field));
    }

    fn set_parameters(&self, inner: &mut Inner, set: impl Fn(&mut [f64])) {
        inner.set_parameters(set);
        if let Some(direct) = self.direct() {
            direct.publish(&mut inner.field);
        }
    }
}

/// Derives and compiles the equations of a model. `options` may be NULL. This takes from milliseconds to, for a hundred
/// bodies, seconds; everything else is fast, except where it says that it derives.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_new(
    model: *const pc_model,
    options: *const pc_system_options,
    system: *mut *mut pc_system,
    error: *mut *mut pc_error,
) -> pc_status {
    let new = || {
        // SAFETY: the pointers are as the preamble demands.
        unsafe { clear(system, "system") }?;
        // SAFETY: as above.
        let options = unsafe { take(options, "options") }?;
        let variables = options.variables()?;
        // SAFETY: as above.
        let contents = unsafe { handle(model, "model") }?.contents.take()?.clone();
        let derived = pc_system::new(contents.model()?, variables, contents.observes_reactions)?;
        // SAFETY: as above.
        unsafe { write(system, Box::into_raw(Box::new(derived)), "system") }
    };
    // SAFETY: `error` is null or a place for a pointer.
    unsafe { entry(error, new) }
}

/// A copy for another thread, with the parameters as they are now. It shares the machine code there is: that of
/// f, and that of each derivative which the original has evaluated before (the first evaluation of each compiles
/// it).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_clone(
    system: *const pc_system,
    copy: *mut *mut pc_system,
    error: *mut *mut pc_error,
) -> pc_status {
    let clone = || {
        // SAFETY: the pointers are as the preamble demands.
        unsafe { clear(copy, "copy") }?;
        // SAFETY: as above.
        let system = unsafe { handle(system, "system") }?;
        let cloned = system.copy()?;
        // SAFETY: as above.
        unsafe { write(copy, Box::into_raw(Box::new(cloned)), "copy") }
    };
    // SAFETY: `error` is null or a place for a pointer.
    unsafe { entry(error, clone) }
}

/// Frees a system. Null is allowed. In a function that is called by a call of this system it does nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_free(system: *mut pc_system) {
    // SAFETY: null or a live handle, as the preamble demands.
    if unsafe { system.as_ref() }.is_none_or(|system| system.inner.close()) {
        // SAFETY: null or a handle of ours that nobody uses any more.
        unsafe { free(system) };
    }
}

/// A number of the inventory; 0 of null.
pub(crate) fn count(system: *const pc_system, number: impl FnOnce(&Inventory) -> usize) -> usize {
    // SAFETY: null or a live handle, as the preamble demands of the callers.
    unsafe { system.as_ref() }.map_or(0, |system| number(&system.inventory))
}

/// A name of the inventory; null of null, and beyond the last.
pub(crate) fn name(
    system: *const pc_system,
    index: usize,
    list: impl FnOnce(&Inventory) -> &[CString],
) -> *const c_char {
    // SAFETY: null or a live handle, as the preamble demands of the callers.
    unsafe { system.as_ref() }.map_or(std::ptr::null(), |system| nth(list(&system.inventory), index))
}

/// The length of the state y: coordinates, quasi-velocities or momenta, first-order states. 0 of NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_dim(system: *const pc_system) -> usize {
    count(system, Inventory::dim)
}

/// The number of coordinates, which come first in the state. 0 of NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_coordinate_count(system: *const pc_system) -> usize {
    count(system, |inventory| inventory.coordinates)
}

/// The number of first-order states, which come last in the state. 0 of NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_state_count(system: *const pc_system) -> usize {
    count(system, |inventory| inventory.states)
}

/// The number of parameters. 0 of NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_parameter_count(system: *const pc_system) -> usize {
    count(system, |inventory| inventory.parameters.len())
}

/// The number of observables: the integrals, "energy", the outputs. 0 of NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_observable_count(system: *const pc_system) -> usize {
    count(system, |inventory| inventory.observables.len())
}

/// The number of observables, the first ones, that should stay constant: integrals and energy. 0 of NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_conserved_count(system: *const pc_system) -> usize {
    count(system, |inventory| inventory.conserved)
}

/// The number of constraints that are kept by projection. 0 of NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_constraint_count(system: *const pc_system) -> usize {
    count(system, |inventory| inventory.constraints.len())
}

/// The number of reactions; 0 unless pc_model_observe_reactions was asked, and of NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_reaction_count(system: *const pc_system) -> usize {
    count(system, |inventory| inventory.reactions.len())
}

/// The name of a component of the state, from 0; NULL beyond the last.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_name(system: *const pc_system, index: usize) -> *const c_char {
    name(system, index, |inventory| &inventory.names)
}

/// The name of a parameter, from 0; NULL beyond the last.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_parameter_name(system: *const pc_system, index: usize) -> *const c_char {
    name(system, index, |inventory| &inventory.parameters)
}

/// The name of an observable, from 0; NULL beyond the last.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_observable_name(system: *const pc_system, index: usize) -> *const c_char {
    name(system, index, |inventory| &inventory.observables)
}

/// The name of a constraint that is kept by projection, from 0; NULL beyond the last.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_constraint_name(system: *const pc_system, index: usize) -> *const c_char {
    name(system, index, |inventory| &inventory.constraints)
}

/// The name of a reaction, `λ_` and that of its constraint, from 0; NULL beyond the last.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_reaction_name(system: *const pc_system, index: usize) -> *const c_char {
    // SAFETY: null or a live handle, as the preamble demands.
    let inventory = unsafe { system.as_ref() }.map(|system| &system.inventory);
    let place = inventory.and_then(|inventory| inventory.reactions.get(index).copied());
    name(system, place.unwrap_or(usize::MAX), |inventory| &inventory.observables)
}

/// The time and state from which the model starts. `t` may be NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_start(
    system: *const pc_system,
    t: *mut f64,
    y: *mut f64,
    y_length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let start = || {
        // SAFETY: the pointers are as the preamble demands.
        let inventory = &unsafe { handle(system, "system") }?.inventory;
        // SAFETY: as above.
        unsafe { room(y, y_length, inventory.dim(), "y") }?.copy_from_slice(&inventory.start);
        // SAFETY: as above.
        if t.is_null() { Ok(()) } else { unsafe { write(t, inventory.t_start, "t") } }
    };
    // SAFETY: `error` is null or a place for a pointer.
    unsafe { entry(error, start) }
}

/// The values of all parameters.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_parameters(
    system: *const pc_system,
    values: *mut f64,
    length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let get = |inventory: &Inventory, inner: &mut Inner| {
        // SAFETY: null or room for `length` numbers, as the preamble demands.
        let values = unsafe { room(values, length, inventory.parameters.len(), "values") }?;
        values.copy_from_slice(inner.field.parameters());
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, get) }
}

/// Sets all parameters; cheap, nothing is derived again. The start stays, and solvers and kernels made before
/// keep their values. Inputs come after the parameters; those with a table are read from it whatever they are set to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_set_parameters(
    system: *mut pc_system,
    values: *const f64,
    length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let set = |system: &pc_system, inner: &mut Inner| {
        // SAFETY: null or `length` numbers, as the preamble demands.
        let values = unsafe { numbers(values, length, system.inventory.parameters.len(), "values") }?;
        for &value in values {
            finite(value, "a parameter")?;
        }
        inner.values.set_all(values);
        system.set_parameters(inner, |parameters| parameters.copy_from_slice(values));
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { holding(system, error, set) }
}

/// Sets one parameter, by its place; those that are expressions in it follow, unless they have been set themselves. Otherwise
/// as pc_system_set_parameters.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_set_parameter(
    system: *mut pc_system,
    index: usize,
    value: f64,
    error: *mut *mut pc_error,
) -> pc_status {
    let set = |system: &pc_system, inner: &mut Inner| {
        let count = system.inventory.parameters.len();
        if index >= count {
            return Err(Fault::Index { what: "the parameters", index, count });
        }
        let value = finite(value, "value")?;
        if inner.values.is_table(index) {
            return Err(Fault::Unsupported { what: "setting this input", why: "it is read from a table" });
        }
        inner.values.set(index, value);
        let values = inner.values.values().to_vec();
        system.set_parameters(inner, |parameters| parameters.copy_from_slice(&values));
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { holding(system, error, set) }
}

impl Inner {
    /// What is kept by projection are then the values of these parameters.
    fn set_parameters(&mut self, set: impl Fn(&mut [f64])) {
        set(self.field.parameters_mut());
        self.field.restart(self.kept_at.0, &self.kept_at.1);
        self.events.set_parameters(self.field.parameters());
        if let Some(legendre) = &mut self.legendre {
            set(legendre.parameters_mut());
        }
    }

    /// What is kept by projection are then the values there.
    pub(crate) fn keep_from(&mut self, t: f64, y: &[f64]) {
        self.kept_at = (t, y.to_vec());
        self.field.restart(t, y);
    }
}

/// Calls `body` with what the system is, and what only one may use at a time.
///
/// # Safety
/// `system` is null or a live handle, `error` null or a place for a pointer.
pub(crate) unsafe fn inside(
    system: *const pc_system,
    error: *mut *mut pc_error,
    body: impl FnOnce(&Inventory, &mut Inner) -> Result<(), Fault>,
) -> pc_status {
    // SAFETY: as promised.
    unsafe { holding(system, error, |system, inner| body(&system.inventory, inner)) }
}

/// Calls `body` with the system, and what only one may use at a time.
///
/// # Safety
/// As for [`inside`].
pub(crate) unsafe fn holding(
    system: *const pc_system,
    error: *mut *mut pc_error,
    body: impl FnOnce(&pc_system, &mut Inner) -> Result<(), Fault>,
) -> pc_status {
    let body = || {
        // SAFETY: as promised.
        let system = unsafe { handle(system, "system") }?;
        body(system, &mut *system.inner.take()?)
    };
    // SAFETY: as promised.
    unsafe { entry(error, body) }
}
