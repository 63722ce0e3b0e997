//! The events of an integration: those of the model, then those that functions of the program compute.

use std::ffi::{c_int, c_void};
use std::rc::Rc;
use std::sync::Arc;

use ::pc_model::FlowEvents;
use pc_expr::{Event, Events, Failure, Program};

use crate::ffi::user_data::User;

/// The function g(t, y) of an event, as a C function.
pub(crate) type Function = unsafe extern "C" fn(f64, *const f64, usize, *mut f64, *mut c_void) -> c_int;
/// The reset of an event, as a C function that overwrites y⁻ with y⁺.
pub(crate) type Reset = unsafe extern "C" fn(f64, *mut f64, usize, *mut c_void) -> c_int;
/// The events of an integration. Copies share the functions of the program, and all belong to the
/// same solver.
#[derive(Clone)]
pub(crate) struct Followed {
    list: Vec<Event>,
    model: FlowEvents,
    own: Vec<Rc<Own>>,
}

/// An event that functions of the program compute.
pub(crate) struct Own {
    pub(crate) name: String,
    pub(crate) function: Function,
    pub(crate) reset: Option<Reset>,
    pub(crate) user: User,
}

/// The error for a function of the program that failed.
#[derive(Debug, thiserror::Error)]
#[error("the {what} of the event {event} returned {code}")]
struct Returned {
    what: &'static str,
    event: String,
    code: c_int,
}

impl Own {
    fn read(&self, what: &'static str, code: c_int) -> Result<(), Failure> {
        match code {
            0 => Ok(()),
            _ => Err(Failure::fatal(Returned { what, event: self.name.clone(), code })),
        }
    }
}

impl Followed {
    /// The events of the model.
    pub(crate) fn new(model: FlowEvents) -> Followed {
        Followed { list: model.events().to_vec(), model, own: Vec::new() }
    }

    /// These events and one more.
    pub(crate) fn with(&self, event: Event, own: Own) -> Followed {
        let mut more = self.clone();
        more.list.push(event);
        more.own.push(Rc::new(own));
        more
    }

    /// Sets the parameters of the model's events.
    pub(crate) fn set_parameters(&mut self, values: &[f64]) {
        self.model.set_parameters(values);
    }

    /// The number of the model's events.
    fn of_model(&self) -> usize {
        self.list.len() - self.own.len()
    }

    /// Whether any events are computed by functions of the program.
    pub(crate) fn has_own(&self) -> bool {
        !self.own.is_empty()
    }
}

impl Events for Followed {
    fn events(&self) -> &[Event] {
        &self.list
    }

    fn evaluate(&mut self, t: f64, y: &[f64], values: &mut [f64]) -> Result<(), Failure> {
        let (of_model, of_own) = values.split_at_mut(self.of_model());
        if !of_model.is_empty() {
            self.model.evaluate(t, y, of_model)?;
        }
        for (own, value) in self.own.iter().zip(of_own) {
            // SAFETY: a function of that type, as pc_solver_add_event demands; `y` is as long as said.
            let code = unsafe { (own.function)(t, y.as_ptr(), y.len(), value, own.user.data) };
            if code != 0 {
                *value = f64::NAN;
            }
            own.read("function", code)?;
        }
        Ok(())
    }

    /// The program of the model's event functions, which come first.
    fn program(&self) -> Option<(&Arc<Program>, &[f64])> {
        self.model.program()
    }

    fn reset(&mut self, event: usize, t: f64, y: &mut [f64]) -> Result<(), Failure> {
        let of_model = self.of_model();
        if event < of_model {
            return self.model.reset(event, t, y);
        }
        let own = &self.own[event - of_model];
        match own.reset {
            // SAFETY: a function of that type, as pc_solver_add_event demands; `y` is as long as said.
            Some(reset) => own.read("reset", unsafe { reset(t, y.as_mut_ptr(), y.len(), own.user.data) }),
            None => Ok(()),
        }
    }

    /// The derivatives of a reset by the program are unknown.
    fn has_parameter_derivatives(&self) -> bool {
        self.own.iter().all(|own| own.reset.is_none()) && self.model.has_parameter_derivatives()
    }

    fn by_parameter(
        &mut self,
        event: usize,
        parameter: usize,
        t: f64,
        y: &[f64],
        reset: &mut [f64],
    ) -> Result<f64, Failure> {
        if event < self.of_model() {
            return self.model.by_parameter(event, parameter, t, y, reset);
        }
        // A function of the program is one of t and y, and resets nothing where sensitivities are.
        reset.fill(0.0);
        Ok(0.0)
    }

    /// Those of functions of the program are difference quotients, and with them all.
    fn has_derivatives(&self) -> bool {
        self.own.is_empty() && self.model.has_derivatives()
    }

    fn gradient(&mut self, event: usize, t: f64, y: &[f64], by_state: &mut [f64]) -> Result<f64, Failure> {
        self.model.gradient(event, t, y, by_state)
    }

    fn reset_along(
        &mut self,
        event: usize,
        t: f64,
        y: &[f64],
        along: (f64, &[f64]),
        change: &mut [f64],
    ) -> Result<(), Failure> {
        self.model.reset_along(event, t, y, along, change)
    }
}
