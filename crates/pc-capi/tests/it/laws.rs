//! Forces as functions that count their calls, and systems on which they act.

use std::ffi::{c_int, c_void};
use std::ptr;
use std::slice;
use std::sync::atomic::{AtomicUsize, Ordering::SeqCst};

use crate::common::{Model, ROD, Refusal, System, c, call};
use ::pc_model::Builtin;
use pc::*;

pub(crate) type Write = fn(f64, &[f64], &mut [f64], usize) -> c_int;

/// The target of `user`: functions that also receive the number of the call, with counts of calls.
pub(crate) struct Law {
    pub(crate) force: Write,
    pub(crate) slopes: Option<Write>,
    pub(crate) calls: AtomicUsize,
    pub(crate) destroyed: AtomicUsize,
}

impl Law {
    pub(crate) fn new(force: Write) -> Law {
        Law { force, slopes: None, calls: AtomicUsize::new(0), destroyed: AtomicUsize::new(0) }
    }

    pub(crate) fn destroyed(&self) -> usize {
        self.destroyed.load(SeqCst)
    }

    /// Sets it as the force of a system; `destroy` only counts its calls.
    pub(crate) fn set(&self, system: &System) -> Result<(), Refusal> {
        let slopes: pc_force_jacobian = self.slopes.map(|_| slopes as _);
        // SAFETY: a live system, and functions that take the law, which lives longer.
        call(|error| unsafe {
            pc_system_set_force(system.0, Some(force), slopes, self.user(), Some(destroy), error)
        })
    }

    pub(crate) fn user(&self) -> *mut c_void {
        ptr::from_ref(self).cast_mut().cast()
    }
}

pub(crate) unsafe extern "C" fn force(
    t: f64,
    y: *const f64,
    n: usize,
    q: *mut f64,
    e: usize,
    user: *mut c_void,
) -> c_int {
    // SAFETY: a law, and arrays as long as said.
    let (law, y, q) =
        unsafe { (&*user.cast::<Law>(), slice::from_raw_parts(y, n), slice::from_raw_parts_mut(q, e)) };
    (law.force)(t, y, q, law.calls.fetch_add(1, SeqCst))
}

pub(crate) unsafe extern "C" fn slopes(
    t: f64,
    y: *const f64,
    n: usize,
    dq: *mut f64,
    e: usize,
    user: *mut c_void,
) -> c_int {
    // SAFETY: a law, and arrays as long as said.
    let (law, y, dq) =
        unsafe { (&*user.cast::<Law>(), slice::from_raw_parts(y, n), slice::from_raw_parts_mut(dq, e)) };
    law.slopes.map_or(-7, |slopes| slopes(t, y, dq, 0))
}

pub(crate) unsafe extern "C" fn destroy(user: *mut c_void) {
    // SAFETY: a law.
    unsafe { &*user.cast::<Law>() }.destroyed.fetch_add(1, SeqCst);
}

pub(crate) const PENDULUM: &str = "
[coordinates]
\"θ\" = 0.5
[quasi_velocities]
\"θ'\" = 0.25
[lagrangian]
kinetic = \"2*θ'^2\"
potential = \"-10*cos(θ)\"
";

pub(crate) fn text_of(name: &str) -> String {
    match name {
        "pendulum" => PENDULUM.to_owned(),
        "rod" => ROD.to_owned(),
        name => Builtin::named(name).unwrap().text.to_owned(),
    }
}

pub(crate) fn declare(model: &Model, on: &[&str]) {
    for on in on {
        let on = c(on);
        // SAFETY: a live model and a text.
        call(|error| unsafe { pc_model_add_external_force(model.0, on.as_ptr(), error) }).unwrap();
    }
}

/// The model with reactions among the outputs, and external forces on these quasi-velocities.
pub(crate) fn forced(name: &str, on: &[&str], form: pc_form) -> System {
    let model = Model::text(&text_of(name)).unwrap();
    // SAFETY: a live model.
    call(|error| unsafe { pc_model_observe_reactions(model.0, 1, error) }).unwrap();
    declare(&model, on);
    model.system(form).unwrap()
}

/// The same with the forces in the text.
pub(crate) fn written(name: &str, forces: &[(&str, &str)], form: pc_form) -> System {
    let lines: String = forces.iter().map(|(on, value)| format!("\"{on}\" = \"{value}\"\n")).collect();
    let model = Model::text(&format!("{}\n[forces]\n{lines}", text_of(name))).unwrap();
    // SAFETY: a live model.
    call(|error| unsafe { pc_model_observe_reactions(model.0, 1, error) }).unwrap();
    model.system(form).unwrap()
}

pub(crate) fn count(system: &System, count: extern "C" fn(Option<&pc_system>) -> usize) -> usize {
    // SAFETY: a live system.
    count(unsafe { system.0.as_ref() })
}

pub(crate) fn assert_close(found: &[f64], expected: &[f64], tolerance: f64, what: &str) {
    assert_eq!(found.len(), expected.len(), "{what}");
    for (i, (found, expected)) in found.iter().zip(expected).enumerate() {
        let off = (found - expected).abs() / expected.abs().max(1.0);
        assert!(off < tolerance, "{what}, entry {i}: {found} against {expected}");
    }
}

pub(crate) fn solver(system: &System, method: pc_method) -> Result<*mut pc_solver, Refusal> {
    let (mut solver, mut options) = (ptr::null_mut(), std::mem::MaybeUninit::<pc_solver_options>::uninit());
    call(|error| unsafe {
        // SAFETY: a live system, options set up by the library, a place for the solver.
        pc_solver_options_init(options.as_mut_ptr(), size_of::<pc_solver_options>());
        (*options.as_mut_ptr()).method = method as c_int;
        (*options.as_mut_ptr()).relative_tolerance = 1e-10;
        (*options.as_mut_ptr()).absolute_tolerance = 1e-12;
        pc_solver_new(system.0, options.as_ptr(), 0.0, ptr::null(), 0, &raw mut solver, error)
    })?;
    Ok(solver)
}

pub(crate) fn advance(solver: *mut pc_solver, t: f64, n: usize) -> Result<Vec<f64>, Refusal> {
    let mut y = vec![0.0; n];
    // SAFETY: a live solver and room as said.
    call(|error| unsafe { pc_solver_advance(solver, t, y.as_mut_ptr(), n, error) })?;
    Ok(y)
}

pub(crate) fn reached(solver: *mut pc_solver) -> f64 {
    let mut t = f64::NAN;
    // SAFETY: a live solver and a place for a number.
    call(|error| unsafe { pc_solver_time(solver, &raw mut t, error) }).unwrap();
    t
}

pub(crate) fn constant(_: f64, _: &[f64], q: &mut [f64], _: usize) -> c_int {
    q.fill(2.0);
    0
}
