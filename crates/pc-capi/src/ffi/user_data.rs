//! The argument `user` of the program's functions.

use std::ffi::c_void;

/// Frees the data to which the `user` of a function points. It must return normally: no exceptions,
/// no longjmp.
pub type pc_destroy = Option<unsafe extern "C" fn(user: *mut c_void)>;

/// The argument of functions of the program, which is destroyed together with them.
pub(crate) struct User {
    pub(crate) data: *mut c_void,
    pub(crate) destroy: pc_destroy,
}

impl Drop for User {
    fn drop(&mut self) {
        if let Some(destroy) = self.destroy {
            // SAFETY: a function of that type and its argument, as the functions that take them demand; called once.
            unsafe { destroy(self.data) };
        }
    }
}
