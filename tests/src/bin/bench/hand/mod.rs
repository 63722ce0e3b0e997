//! Right-hand sides as one writes them who knows the equations and wants them fast.
//!
//! Parameters are numbers, what several terms share is computed once, divisions by constants are products,
//! and where the processor has fused multiply-add, the functions are compiled for it. They have the signature
//! of the code that the JIT makes, and a [`Routine`] calls either through its pointer: the same instructions
//! lead to both.
#![expect(unsafe_code, reason = "a function compiled for some processors only is entered through `unsafe`")]

mod chain;
mod dop853;
mod particle;
mod pendulum;
mod rolling;
mod top;

use pc_expr::{Entry, Jit};
use pc_mech::MachineCode;

pub(crate) use chain::chain;
pub(crate) use dop853::integrate;
pub(crate) use dop853::lockstep::tops;
pub(crate) use particle::{charged, relativistic};
pub(crate) use pendulum::{pendulum, pendulum_by_tensions};
pub(crate) use rolling::{disk, sleigh};
pub(crate) use top::{euler, free_quaternion, poisson, quaternion};

/// A function written by hand, ẏ(y) of `dimension` numbers, which needs no parameters and no scratch.
#[derive(Clone, Copy)]
pub(crate) struct Hand {
    entry: Entry,
    dimension: usize,
}

/// Machine code of ẏ(y) behind a pointer.
pub(crate) struct Routine {
    entry: Entry,
    dimension: usize,
    parameters: Vec<f64>,
    scratch: Vec<f64>,
    /// Code made at run time lives as long as this.
    _code: Option<Jit>,
}

impl From<Hand> for Routine {
    fn from(hand: Hand) -> Routine {
        let Hand { entry, dimension } = hand;
        Routine { entry, dimension, parameters: Vec::new(), scratch: Vec::new(), _code: None }
    }
}

impl Routine {
    /// What the JIT has made, with its parameters.
    ///
    /// # Panics
    /// Unless there are as many outputs as components of the state, and as many parameters as the code reads.
    pub(crate) fn compiled(jit: Jit, parameters: Vec<f64>) -> Routine {
        let dimension = jit.state_len();
        assert_eq!([jit.outputs_len(), jit.parameters_len()], [dimension, parameters.len()]);
        let scratch = vec![0.0; jit.scratch_len()];
        Routine { entry: jit.entry(), dimension, parameters, scratch, _code: Some(jit) }
    }

    /// The code of a motion with what it takes for parameters, none of whose pivots changes; valid as long as the motion.
    ///
    /// # Panics
    /// If one changes, or there are not as many parameters as it takes.
    pub(crate) fn of_motion(code: &MachineCode, parameters: &[f64]) -> Routine {
        assert_eq!(code.watched_len(), 0, "pivots that change");
        assert_eq!(code.parameters_len(), parameters.len(), "parameters of the code");
        let scratch = vec![0.0; code.scratch_len()];
        Routine {
            entry: code.entry(),
            dimension: code.rates_len(),
            parameters: parameters.to_vec(),
            scratch,
            _code: None,
        }
    }

    /// Writes ẏ(y).
    ///
    /// # Panics
    /// If the lengths are not the dimension.
    pub(crate) fn call(&mut self, y: &[f64], dy: &mut [f64]) {
        assert!(y.len() == self.dimension && dy.len() == self.dimension);
        // SAFETY: code by hand reads and writes arrays of the dimension just checked, on a processor that it
        // was made for; the JIT's does also within the parameters and the scratch it was asked for, and
        // `_code` keeps it.
        unsafe {
            (self.entry)(
                0.0,
                y.as_ptr(),
                self.parameters.as_ptr(),
                dy.as_mut_ptr(),
                self.scratch.as_mut_ptr(),
            );
        }
    }
}

/// a·b + c
#[inline(always)]
fn fma<const FMA: bool>(a: f64, b: f64, c: f64) -> f64 {
    if FMA { a.mul_add(b, c) } else { a * b + c }
}

/// The best compilation for this host of a function of `const FMA: bool` and further parameters, from a state
/// to its rate of change, which are arrays of numbers or of arrays.
macro_rules! for_this_host {
    ($function:ident, $state:ty $(, $argument:tt)*) => {{
        use super::{Hand, enter};
        let dimension = size_of::<$state>() / size_of::<f64>();
        #[cfg(target_arch = "x86_64")]
        {
            enter!(#[target_feature(enable = "avx2,fma")] fused, $state, $function::<true $(, $argument)*>);
            if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
                return Hand { entry: fused, dimension };
            }
        }
        enter!(plain, $state, $function::<{ cfg!(target_arch = "aarch64") } $(, $argument)*>);
        Hand { entry: plain, dimension }
    }};
}

/// A function with the signature of compiled code around one from state to state.
macro_rules! enter {
    ($(#[$feature:meta])? $name:ident, $state:ty, $function:expr) => {
        $(#[$feature])?
        unsafe extern "C" fn $name(_: f64, y: *const f64, _: *const f64, dy: *mut f64, _: *mut f64) -> bool {
            // SAFETY: who calls passes as many numbers as the `Hand` says, and those of `dy` overlap nothing.
            let (y, dy) = unsafe { (&*y.cast::<$state>(), &mut *dy.cast::<$state>()) };
            $function(y, dy);
            true
        }
    };
}
use {enter, for_this_host};
