//! Options: structures that may grow, each beginning with its size.

use std::ffi::c_int;
use std::time::Duration;

use ::pc_model::document::Simulation;
use ::pc_model::{ORDINARY_TOLERANCE, Variables};
use pc_expr::Limits;
use pc_solve::{Accumulation, Deadline, Inequality, Krylov, LinearSolver, Method, NonlinearSolver, Options};

use crate::api::cancel::pc_cancel;
use crate::ffi::call_error::CallError;
use crate::ffi::pointer::{aligned, integers, numbers};

/// The form of the equations of motion; values of pc_system_options.form.
#[repr(C)]
pub enum pc_form {
    /// Poincaré's equations, in quasi-velocities: in the independent ones if constraints make the
    /// others vanish, otherwise in all of them, with multipliers.
    PC_POINCARE = 0,
    /// Chetaev's canonical equations, in momenta.
    PC_CANONICAL = 1,
    /// Poincaré's equations without the coordinates on which nothing depends, and Euler–Poincaré's
    /// where no coordinate is left; the state has fewer coordinates. Where constraints are imposed
    /// by multipliers, this form and those below give PC_INCONSISTENT_MODEL, unless
    /// pc_model_add_independent says which velocities are independent.
    PC_REDUCED = 2,
    /// The same equations in momenta: Lie–Poisson equations.
    PC_LIE_POISSON = 3,
    /// Poincaré's equations, in quasi-velocities that are orthonormal in the kinetic metric.
    PC_ORTHONORMAL = 4,
    /// Hamel's equations, in the quasi-velocities of pc_model_give_quasi_velocity.
    PC_HAMEL = 5,
}

/// Options for deriving a system. Set them up with pc_system_options_init.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct pc_system_options {
    /// sizeof(pc_system_options), set by pc_system_options_init.
    pub size: usize,
    /// A pc_form; PC_POINCARE by default.
    pub form: c_int,
    /// Reserved; must be 0.
    pub reserved: c_int,
    /// Maximum number of bytes, by estimate, that the expressions of a derivation may take; 0, the
    /// default, for 4 GiB. Beyond it a call returns PC_LIMIT. The limit applies separately to
    /// pc_system_new and to each later call that derives; so do the next two fields.
    pub memory_limit: u64,
    /// Maximum time in seconds, positive, for a derivation and for each call of a solver or an
    /// ensemble of the system; 0, the default, for no limit.
    pub time_limit: f64,
    /// The handle with which derivations and integrations can be ended; NULL, the default, for
    /// none. The handle may be freed when pc_system_new has returned.
    pub cancel: *const pc_cancel,
}

impl Default for pc_system_options {
    fn default() -> Self {
        pc_system_options {
            size: size_of::<Self>(),
            form: pc_form::PC_POINCARE as c_int,
            reserved: 0,
            memory_limit: 0,
            time_limit: 0.0,
            cancel: std::ptr::null(),
        }
    }
}

impl pc_system_options {
    /// The variables of the state.
    pub(crate) fn variables(&self) -> Result<Variables, CallError> {
        match self.form {
            0 => Ok(Variables::QuasiVelocities),
            1 => Ok(Variables::Momenta),
            2 => Ok(Variables::Reduced),
            3 => Ok(Variables::ReducedMomenta),
            4 => Ok(Variables::Orthonormal),
            5 => Ok(Variables::Given),
            value => Err(CallError::Choice { what: "pc_form", value: value.into() }),
        }
    }

    /// The limits of a derivation.
    ///
    /// # Safety
    /// `cancel` is null or a live handle.
    pub(crate) unsafe fn limits(&self) -> Result<Limits, CallError> {
        unreserved("pc_system_options.reserved", self.reserved.into())?;
        let mut limits = Limits::default();
        if self.memory_limit != 0 {
            limits.memory = self.memory_limit;
        }
        if self.time_limit.is_nan() || self.time_limit < 0.0 {
            return Err(CallError::TimeLimit { value: self.time_limit });
        }
        if self.time_limit != 0.0 {
            // More seconds than can be counted are no limit.
            limits.time = Duration::try_from_secs_f64(self.time_limit).ok();
        }
        // SAFETY: as promised.
        if let Some(handle) = unsafe { self.cancel.as_ref() } {
            limits.cancel = handle.cancel.clone();
        }
        Ok(limits)
    }
}

/// Refuses a reserved field that is not 0.
fn unreserved(what: &'static str, value: i64) -> Result<(), CallError> {
    if value == 0 { Ok(()) } else { Err(CallError::Reserved { what, value }) }
}

/// The method of integration; values of pc_solver_options.method.
#[repr(C)]
pub enum pc_method {
    /// Adams–Moulton formulas of orders 1 to 12, for systems that are not stiff.
    PC_ADAMS = 0,
    /// Backward differentiation formulas of orders 1 to 5, for stiff systems.
    PC_BDF = 1,
    /// The explicit Runge–Kutta method of order 8 of Dormand and Prince, for systems that are
    /// not stiff at tolerances of 1e-6 and below: the fastest where the equations are short. It has
    /// no sensitivities, and offers no choice of iteration, linear solver or highest order.
    PC_DOP853 = 2,
    /// Taylor's method of adaptive order and step, for systems that are not stiff: the fastest at
    /// tolerances of 1e-8 and below, and the one that follows a motion to within rounding errors.
    /// It needs equations that are solved symbolically, without tables and without forces from
    /// functions of the program.
    PC_TAYLOR = 3,
    /// PC_DOP853 where the motion is not stiff, PC_BDF where stiffness is detected. With
    /// sensitivities it is PC_ADAMS.
    PC_AUTO = 4,
}

/// How the equation of a step is solved; values of pc_solver_options.iteration.
#[repr(C)]
pub enum pc_iteration {
    /// Newton's iteration for PC_BDF, also within PC_AUTO, and the fixed-point iteration for
    /// PC_ADAMS.
    PC_ITERATION_OF_METHOD = 0,
    /// Newton's iteration, with a linear solver.
    PC_NEWTON = 1,
    /// The fixed-point iteration, which needs no Jacobian.
    PC_FIXED_POINT = 2,
}

/// How the linear systems of Newton's iteration are solved; values of
/// pc_solver_options.linear_solver.
#[repr(C)]
pub enum pc_linear_solver {
    /// Chosen by the size and the zero pattern of the Jacobian.
    PC_LINEAR_AUTOMATIC = 0,
    /// Dense LU factors.
    PC_LINEAR_DENSE = 1,
    /// Sparse LU factors.
    PC_LINEAR_SPARSE = 2,
    /// Matrix-free GMRES.
    PC_LINEAR_KRYLOV = 3,
}

/// What a component of the state has to satisfy; values of pc_solver_options.inequalities.
#[repr(C)]
pub enum pc_inequality {
    /// Nothing.
    PC_FREE = 0,
    /// ≥ 0
    PC_NOT_NEGATIVE = 1,
    /// ≤ 0
    PC_NOT_POSITIVE = -1,
    /// > 0
    PC_POSITIVE = 2,
    /// < 0
    PC_NEGATIVE = -2,
}

/// Options for an integration. Set them up with pc_solver_options_init, then change what you like.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct pc_solver_options {
    /// sizeof(pc_solver_options), set by pc_solver_options_init.
    pub size: usize,
    /// A pc_method; PC_AUTO by default.
    pub method: c_int,
    /// A pc_iteration; PC_ITERATION_OF_METHOD by default.
    pub iteration: c_int,
    /// A pc_linear_solver; PC_LINEAR_AUTOMATIC by default. It matters only with Newton's iteration.
    pub linear_solver: c_int,
    /// Highest order of the method; 0, the default, for the highest it has.
    pub max_order: c_int,
    /// Relative tolerance, positive; 1e-9 by default.
    pub relative_tolerance: f64,
    /// Absolute tolerance for all components, positive; 1e-12 by default.
    pub absolute_tolerance: f64,
    /// Absolute tolerances, one for each component, copied; NULL, the default, for the one above.
    pub absolute_tolerances: *const f64,
    /// The number of these tolerances; 0 with NULL.
    pub absolute_tolerances_length: usize,
    /// Maximum number of steps from one output to the next; 500000 by default.
    pub max_steps: u64,
    /// Length of the first step, positive in both directions of time; 0, the default, for an
    /// estimate.
    pub initial_step: f64,
    /// Minimum length of a step; 0, the default, for none.
    pub min_step: f64,
    /// Maximum length of a step; 0, the default, for none.
    pub max_step: f64,
    /// A time beyond which the equations are never evaluated; infinity, the default, for none.
    pub stop_time: f64,
    /// Number of equal parts of each step, at least 1; 4 by default. Functions of events that are
    /// not expressions in the state alone (those of your program, and those that are read through
    /// constraints, momenta or tables) are sampled at the ends of the parts, and more closely where
    /// the values leave doubt. Between two such times an even number of zeros may be missed.
    pub samples_per_step: u32,
    /// Reserved; must be 0.
    pub reserved: u32,
    /// Events that follow each other ever faster are an error once the time left until they
    /// accumulate is this fraction of their first interval, at least 0 (never) and less than
    /// 1; 1e-5 by default.
    pub accumulation: f64,
    /// A pc_inequality for each component of the state, copied; NULL, the default, for none. They
    /// hold at the ends of steps; a component that cannot satisfy its inequality ends the
    /// integration. A start that does not satisfy them is refused, and so are inequalities with
    /// PC_TAYLOR, and for systems whose states are projected.
    pub inequalities: *const c_int,
    /// The number of these inequalities; 0 with NULL.
    pub inequalities_length: usize,
}

impl Default for pc_solver_options {
    fn default() -> Self {
        pc_solver_options {
            size: size_of::<Self>(),
            method: pc_method::PC_AUTO as c_int,
            iteration: pc_iteration::PC_ITERATION_OF_METHOD as c_int,
            linear_solver: pc_linear_solver::PC_LINEAR_AUTOMATIC as c_int,
            max_order: 0,
            relative_tolerance: Simulation::RELATIVE_TOLERANCE,
            absolute_tolerance: ORDINARY_TOLERANCE,
            absolute_tolerances: std::ptr::null(),
            absolute_tolerances_length: 0,
            max_steps: 500_000,
            initial_step: 0.0,
            min_step: 0.0,
            max_step: 0.0,
            stop_time: f64::INFINITY,
            samples_per_step: 4,
            reserved: 0,
            accumulation: Accumulation::default().within,
            inequalities: std::ptr::null(),
            inequalities_length: 0,
        }
    }
}

/// Sets the options to their defaults. `size` is sizeof(pc_system_options). NULL is allowed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_options_init(options: *mut pc_system_options, size: usize) {
    // SAFETY: null, or `size` bytes, as the preamble demands.
    unsafe { give(options, pc_system_options { size, ..Default::default() }, size) };
}

/// Sets the options to their defaults. `size` is sizeof(pc_solver_options). NULL is allowed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_solver_options_init(options: *mut pc_solver_options, size: usize) {
    // SAFETY: null, or `size` bytes, as the preamble demands.
    unsafe { give(options, pc_solver_options { size, ..Default::default() }, size) };
}

/// Writes as much of `value` as fits into `size` bytes, and fills the rest of them with zeros.
///
/// # Safety
/// `place` is null, or has room for `size` bytes and is aligned as a `T`.
pub(crate) unsafe fn give<T: Copy>(place: *mut T, value: T, size: usize) {
    if !place.is_null() {
        let (value, place) = (std::ptr::from_ref(&value).cast::<u8>(), place.cast::<u8>());
        let known = size.min(size_of::<T>());
        // SAFETY: no more bytes than either has; plain data.
        unsafe {
            std::ptr::copy_nonoverlapping(value, place, known);
            std::ptr::write_bytes(place.add(known), 0, size - known);
        }
    }
}

/// The options at `place`, with defaults for those that the caller's header does not have; if
/// `place` is null, all are defaults.
///
/// # Safety
/// `T` is plain data for which any bytes are valid, and begins with a size; `place` is null or has
/// as many bytes as that size says.
pub(crate) unsafe fn take<T: Copy + Default>(place: *const T, what: &'static str) -> Result<T, CallError> {
    let mut options = T::default();
    if place.is_null() {
        return Ok(options);
    }
    aligned(place, what)?;
    // SAFETY: not null, aligned, and begins with its size.
    let found = unsafe { place.cast::<usize>().read() };
    let (least, most) = (size_of::<usize>(), size_of::<T>());
    if !(least..=most).contains(&found) || found % align_of::<T>() != 0 {
        return Err(CallError::StructSize { what, found, least, most });
    }
    let target = std::ptr::from_mut(&mut options).cast::<u8>();
    // SAFETY: both have `found` bytes, and any are valid.
    unsafe { std::ptr::copy_nonoverlapping(place.cast::<u8>(), target, found) };
    Ok(options)
}

impl pc_solver_options {
    /// The options of a solver for a state of `dim` components, with the deadline.
    ///
    /// # Safety
    /// The tolerances and the inequalities are null or have the stated length.
    pub(crate) unsafe fn options(&self, dim: usize, deadline: Deadline) -> Result<Options, CallError> {
        unreserved("pc_solver_options.reserved", self.reserved.into())?;
        let choice = |what, value: c_int| CallError::Choice { what, value: value.into() };
        let mut options = Options::new(match self.method {
            0 => Method::Adams,
            1 => Method::Bdf,
            2 => Method::Dop853,
            3 => Method::Taylor,
            4 => Method::Auto,
            value => return Err(choice("pc_method", value)),
        });
        match self.iteration {
            0 => {}
            1 => options = options.nonlinear_solver(NonlinearSolver::Newton),
            2 => options = options.nonlinear_solver(NonlinearSolver::FixedPoint),
            value => return Err(choice("pc_iteration", value)),
        }
        match self.linear_solver {
            0 => {}
            1 => options = options.linear_solver(LinearSolver::Dense),
            2 => options = options.linear_solver(LinearSolver::Sparse),
            3 => options = options.linear_solver(LinearSolver::Krylov(Krylov::default())),
            value => return Err(choice("pc_linear_solver", value)),
        }
        options = options.relative_tolerance(self.relative_tolerance).max_steps(self.max_steps);
        options = if self.absolute_tolerances.is_null() && self.absolute_tolerances_length == 0 {
            options.absolute_tolerance(self.absolute_tolerance)
        } else {
            let what = "absolute_tolerances";
            // SAFETY: as promised.
            let tolerances =
                unsafe { numbers(self.absolute_tolerances, self.absolute_tolerances_length, dim, what) }?;
            options.absolute_tolerance(tolerances.to_vec())
        };
        if self.max_order != 0 {
            let order = u32::try_from(self.max_order);
            options = options.max_order(order.map_err(|_| choice("max_order", self.max_order))?);
        }
        // 0 means the default; any other value is passed on, to be used or refused.
        if self.initial_step != 0.0 {
            options = options.initial_step(self.initial_step);
        }
        if self.min_step != 0.0 {
            options = options.min_step(self.min_step);
        }
        if self.max_step != 0.0 {
            options = options.max_step(self.max_step);
        }
        if self.stop_time.is_nan() || self.stop_time.is_finite() {
            options = options.stop_time(self.stop_time);
        }
        // SAFETY: null or as many as stated, as promised.
        let wanted = unsafe { integers(self.inequalities, self.inequalities_length, "inequalities") }?;
        if !wanted.is_empty() {
            let (found, expected) = (wanted.len(), dim);
            if found != expected {
                return Err(CallError::Length { what: "inequalities", found, expected });
            }
            options = options
                .inequalities(wanted.iter().map(|&value| inequality(value)).collect::<Result<_, _>>()?);
        }
        options = options.deadline(deadline);
        let accumulation = Accumulation { within: self.accumulation, ..Accumulation::default() };
        Ok(options.samples_per_step(self.samples_per_step).accumulation(accumulation))
    }
}

/// The inequality with this number.
fn inequality(value: c_int) -> Result<Inequality, CallError> {
    match value {
        0 => Ok(Inequality::Free),
        1 => Ok(Inequality::NotNegative),
        -1 => Ok(Inequality::NotPositive),
        2 => Ok(Inequality::Positive),
        -2 => Ok(Inequality::Negative),
        value => Err(CallError::Choice { what: "pc_inequality", value: value.into() }),
    }
}
