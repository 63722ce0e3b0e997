//! The functions of the program that compute forces, as an external force of `pc_mech`.

use std::ffi::{c_int, c_void};
use std::sync::Arc;

use pc_mech::{ExternalForce, Failure, difference_quotients};

use crate::ffi::user_data::User;

type Function = unsafe extern "C" fn(f64, *const f64, usize, *mut f64, usize, *mut c_void) -> c_int;

/// The functions of the forces, if they have been set; copies share them.
#[derive(Clone, Default)]
pub(crate) struct Controller {
    callback: Option<Arc<Callback>>,
    /// Memory for difference quotients.
    room: Vec<f64>,
}

struct Callback {
    function: Function,
    jacobian: Option<Function>,
    user: Shared,
}

/// The argument of the functions, freed with the last copy.
struct Shared(User);

// SAFETY: pc_system_set_force demands that its functions take `user` on any thread, on several at the same time.
unsafe impl Send for Shared {}
// SAFETY: pc_system_set_force demands the same for several threads at a time.
unsafe impl Sync for Shared {}

/// Why the forces cannot be computed.
#[derive(Clone, Copy, Debug, thiserror::Error)]
enum NoForce {
    #[error("no function has been set for it; pc_system_set_force sets one")]
    Unset,
    #[error("its function returned {0}")]
    Function(c_int),
    #[error("the function of its derivatives returned {0}")]
    Jacobian(c_int),
}

impl NoForce {
    /// Converts the return value of a function to a result.
    fn read(code: c_int, fault: fn(c_int) -> NoForce) -> Result<(), Failure> {
        match code {
            0 => Ok(()),
            1.. => Err(Failure::recoverable(fault(code))),
            _ => Err(Failure::fatal(fault(code))),
        }
    }
}

impl Controller {
    /// Forces that `function` computes; their derivatives come from `jacobian`, or else from
    /// difference quotients.
    pub(crate) fn new(function: Function, jacobian: Option<Function>, user: User) -> Controller {
        let callback = Callback { function, jacobian, user: Shared(user) };
        Controller { callback: Some(Arc::new(callback)), room: Vec::new() }
    }
}

impl Callback {
    /// Calls one of the functions, which writes `values`.
    fn call(&self, function: Function, t: f64, y: &[f64], values: &mut [f64]) -> c_int {
        // SAFETY: a function of that type, as pc_system_set_force demands; the arrays are as long as said.
        unsafe { function(t, y.as_ptr(), y.len(), values.as_mut_ptr(), values.len(), self.user.0.data) }
    }
}

impl ExternalForce for Controller {
    fn force(&mut self, t: f64, y: &[f64], q: &mut [f64]) -> Result<(), Failure> {
        let callback = self.callback.as_ref().ok_or_else(|| Failure::fatal(NoForce::Unset))?;
        NoForce::read(callback.call(callback.function, t, y, q), NoForce::Function)
    }

    fn jacobian(&mut self, t: f64, y: &[f64], dq: &mut [f64]) -> Result<(), Failure> {
        match self.callback.as_ref().and_then(|callback| Some((callback, callback.jacobian?))) {
            Some((callback, jacobian)) => NoForce::read(callback.call(jacobian, t, y, dq), NoForce::Jacobian),
            None => {
                let mut room = std::mem::take(&mut self.room);
                let outcome = difference_quotients(self, (t, y), dq, &mut room);
                self.room = room;
                outcome
            }
        }
    }
}
