//! A system behind its handle: the part that never changes, and the part that one call at a time may use.

use std::ffi::{CString, c_char};
use std::sync::{Arc, OnceLock};

use ::pc_model::{Flow, FlowEvents, Model, Parameters, Variables, deep};
use pc_expr::{Deadline, Evaluator, Event, Events, Pattern, TimeDependence};
use pc_mech::{InverseDynamics, LegendreTransform, MassFactors, MechError, Motion, VectorField};
use serde::{Deserialize, Serialize};

use crate::ffi::boundary::entry;
use crate::ffi::call_error::CallError;
use crate::ffi::error::pc_error;
use crate::ffi::pointer::handle;
use crate::ffi::status::pc_status;
use crate::ffi::strings::{c_string, c_strings, nth};
use crate::machinery::derivations::Derivations;
use crate::machinery::exclusive::Exclusive;
use crate::machinery::kinematics::Kinematics;
use crate::machinery::linear::Linear;
use crate::machinery::lock_free_rhs::Direct;
use crate::machinery::mechanics::Mechanics;
use crate::machinery::motion_field::MotionField;

/// The equations of motion of a model, compiled: ẏ = f(t, y). Free it with pc_system_free.
pub struct pc_system {
    /// Dropped first, because a `destroy` function of the program may read names.
    pub(crate) inner: Exclusive<Inner>,
    /// The machine code of f, which needs a live field but no lock; it is known after the first
    /// evaluation.
    pub(crate) direct: OnceLock<Option<Direct>>,
    pub(crate) inventory: Arc<Inventory>,
}

/// What neither the model nor its motion says.
#[derive(Serialize, Deserialize)]
pub(crate) struct Facts {
    pub(crate) variables: Variables,
    /// The names of the parameters.
    pub(crate) parameters: Vec<String>,
    pub(crate) t_start: f64,
}

/// The part that never changes.
pub(crate) struct Inventory {
    pub(crate) model: Model,
    pub(crate) facts: Facts,
    pub(crate) derivations: Derivations,
    pub(crate) names: Vec<CString>,
    pub(crate) coordinates: usize,
    pub(crate) states: usize,
    pub(crate) parameters: Vec<CString>,
    pub(crate) observables: Vec<CString>,
    pub(crate) conserved: usize,
    pub(crate) constraints: Vec<CString>,
    /// The positions of the reactions among the observables, whose names they share.
    pub(crate) reactions: Vec<usize>,
    pub(crate) pattern: Option<Pattern>,
    /// The quasi-velocities on which external forces act.
    pub(crate) forces: Vec<CString>,
    pub(crate) start: Vec<f64>,
    pub(crate) events: Vec<Event>,
    pub(crate) event_names: Vec<CString>,
}

impl Inventory {
    pub(crate) fn new(model: Model, facts: Facts, flow: &Flow, derivations: Derivations) -> Inventory {
        let motion = &flow.motion;
        let observables = motion.observable_names();
        let constraints = &model.document().constraints;
        let names: Vec<String> = constraints.iter().map(|c| format!("λ_{}", c.name.text)).collect();
        // Reactions follow the outputs of the model, one of which may have the name of a reaction.
        let places = motion.conserved_len() + model.document().outputs.len()..observables.len();
        let reactions =
            places.filter(|&i| model.observes_reactions() && names.contains(&observables[i])).collect();
        let forces = model.external_forces();
        let pattern = match forces.as_slice() {
            [] => motion.sparsity().cloned(),
            _ => Some(Pattern::full(motion.dim(), motion.dim())),
        };
        Inventory {
            names: c_strings(motion.names()),
            coordinates: motion.coordinates(),
            states: motion.states(),
            parameters: c_strings(&facts.parameters),
            observables: c_strings(observables),
            conserved: motion.conserved_len(),
            constraints: c_strings(motion.constraint_names()),
            reactions,
            pattern,
            forces: c_strings(&forces),
            start: flow.start.clone(),
            events: flow.events.events().to_vec(),
            event_names: flow.events.events().iter().map(|event| c_string(event.name())).collect(),
            model,
            facts,
            derivations,
        }
    }

    /// Length of the state.
    pub(crate) fn dim(&self) -> usize {
        self.names.len()
    }

    /// Derives something else from the model, with the limits of the first derivation.
    pub(crate) fn derive<T>(&self, work: impl FnOnce(Model) -> Result<T, CallError>) -> Result<T, CallError> {
        let mut model = self.model.clone();
        model.limit(self.model.budget().limits().clone());
        deep(|| work(model))
    }

    /// The deadline for work that begins now, according to the limits of the first derivation.
    pub(crate) fn deadline(&self) -> Deadline {
        Deadline::new(self.model.budget().limits())
    }

    /// The time and state from which the model starts.
    pub(crate) fn start(&self) -> (f64, &[f64]) {
        (self.facts.t_start, &self.start)
    }
}

#[derive(Clone)]
pub(crate) struct Inner {
    pub(crate) field: MotionField,
    /// The values of the parameters, some of which are expressions in other parameters.
    pub(crate) values: Parameters,
    /// The time and state at which the integrals maintained by projection take their values.
    kept_at: (f64, Vec<f64>),
    /// The events of the model.
    pub(crate) events: FlowEvents,
    /// Copies of derivations, made on first use.
    pub(crate) mechanics: Option<Mechanics>,
    pub(crate) inverse: Option<InverseDynamics>,
    pub(crate) kinematics: Kinematics,
    pub(crate) legendre: Option<LegendreTransform>,
    by_time: Option<Option<Box<Motion>>>,
    /// By the names of bodies and points.
    pub(crate) poses: Vec<(String, Evaluator)>,
    /// The motion with all its first derivatives.
    pub(crate) slopes: Option<Box<Motion>>,
    /// For the inputs that were asked for last.
    pub(crate) linear: Option<Box<Linear>>,
    /// The factors of M, once a system with M has been solved.
    pub(crate) factors: Option<MassFactors>,
    pub(crate) room: Room,
}

/// Room for intermediate results, so that only the first calls allocate.
#[derive(Clone, Default)]
pub(crate) struct Room {
    /// Its length is that of the state.
    pub(crate) state: Vec<f64>,
    /// Its length is what each call needs.
    values: Vec<f64>,
}

impl Room {
    /// Room for `len` numbers, and for a state.
    pub(crate) fn split(&mut self, len: usize) -> (&mut [f64], &mut [f64]) {
        self.values.resize(len, 0.0);
        (&mut self.values, &mut self.state)
    }

    /// Room for `len` numbers.
    pub(crate) fn numbers(&mut self, len: usize) -> &mut [f64] {
        self.split(len).0
    }
}

impl pc_system {
    /// A copy with the same equations.
    pub(crate) fn copy(&self) -> Result<pc_system, CallError> {
        let mut inner = self.inner.take()?.clone();
        let direct = OnceLock::new();
        if self.direct().is_some() {
            // The code is compiled, and the copy shares it.
            direct.get_or_init(|| Direct::of(&mut inner.field));
        }
        Ok(pc_system { inventory: Arc::clone(&self.inventory), direct, inner: Exclusive::new(inner) })
    }

    /// The machine code of f, if f is known to consist of machine code alone.
    #[inline]
    pub(crate) fn direct(&self) -> Option<&Direct> {
        self.direct.get()?.as_ref()
    }

    /// Lets later evaluations use the machine code directly, if f consists of machine code alone.
    pub(crate) fn prepare_direct(&self, inner: &mut Inner) {
        self.direct.get_or_init(|| Direct::of(&mut inner.field));
    }

    /// Takes `values` as the parameters.
    pub(crate) fn take_values(&self, inner: &mut Inner) {
        inner.take_values();
        if let Some(direct) = self.direct() {
            direct.publish(&mut inner.field);
        }
    }
}

impl Inner {
    pub(crate) fn new(inventory: &Inventory, flow: Flow) -> Result<Inner, MechError> {
        Ok(Inner {
            field: MotionField::new(flow.motion, inventory.model.external_forces())?,
            values: inventory.model.parameter_values().clone(),
            kept_at: (inventory.facts.t_start, flow.start),
            events: flow.events,
            mechanics: None,
            inverse: None,
            kinematics: Kinematics::default(),
            legendre: None,
            by_time: None,
            poses: Vec::new(),
            slopes: None,
            linear: None,
            factors: None,
            room: Room { state: vec![0.0; inventory.dim()], values: Vec::new() },
        })
    }

    /// Takes `values` as the parameters; the integrals to be kept then take the values for these
    /// parameters.
    fn take_values(&mut self) {
        let values = self.values.values();
        self.field.parameters_mut().copy_from_slice(values);
        self.field.restart(self.kept_at.0, &self.kept_at.1);
        self.events.set_parameters(self.field.parameters());
        if let Some(legendre) = &mut self.legendre {
            legendre.parameters_mut().copy_from_slice(values);
        }
    }

    /// The motion with its derivative with respect to time, derived on first use, with the current
    /// parameters; nothing if f does not contain time.
    pub(crate) fn by_time(&mut self, inventory: &Inventory) -> Result<Option<&mut Motion>, CallError> {
        let Inner { field, by_time, .. } = self;
        let derive = || match field.time_dependence() {
            TimeDependence::Absent => Ok(None),
            TimeDependence::Known(_) | TimeDependence::Unknown => inventory.derive(|mut model| {
                model.differentiate_by_time(true);
                model.derived(|assembly| {
                    Ok(Some(Box::new(Flow::new(&model, assembly, inventory.facts.variables)?.motion)))
                })
            }),
        };
        let mut motion = inventory.derivations.by_time.own(by_time, derive)?.as_deref_mut();
        if let Some(motion) = &mut motion {
            motion.parameters_mut().copy_from_slice(field.parameters());
        }
        Ok(motion)
    }

    /// Keeps integrals at their values at (t, y).
    pub(crate) fn keep_from(&mut self, t: f64, y: &[f64]) {
        self.kept_at = (t, y.to_vec());
        self.field.restart(t, y);
    }
}

/// Calls `body` with the inventory of the system and with the part that one call at a time may use.
///
/// # Safety
/// `system` is null or a live handle, and `error` is null or points to memory for a pointer.
pub(crate) unsafe fn inside(
    system: *const pc_system,
    error: *mut *mut pc_error,
    body: impl FnOnce(&Inventory, &mut Inner) -> Result<(), CallError>,
) -> pc_status {
    // SAFETY: as promised.
    unsafe { holding(system, error, |system, inner| body(&system.inventory, inner)) }
}

/// Calls `body` with the system and with the part that one call at a time may use.
///
/// # Safety
/// As for [`inside`].
pub(crate) unsafe fn holding(
    system: *const pc_system,
    error: *mut *mut pc_error,
    body: impl FnOnce(&pc_system, &mut Inner) -> Result<(), CallError>,
) -> pc_status {
    let body = || {
        // SAFETY: as promised.
        let system = unsafe { handle(system, "system") }?;
        body(system, &mut *system.inner.take()?)
    };
    // SAFETY: as promised.
    unsafe { entry(error, body) }
}

/// A number from the inventory of a system; 0 for null.
pub(crate) fn count(system: Option<&pc_system>, number: impl FnOnce(&Inventory) -> usize) -> usize {
    system.map_or(0, |system| number(&system.inventory))
}

/// A name from the inventory of a system; null for a null system, and beyond the last name.
pub(crate) fn name(
    system: Option<&pc_system>,
    index: usize,
    list: impl FnOnce(&Inventory) -> &[CString],
) -> *const c_char {
    system.map_or(std::ptr::null(), |system| nth(list(&system.inventory), index))
}
