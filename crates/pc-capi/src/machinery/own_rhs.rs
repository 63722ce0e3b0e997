//! f(t, y) computed by machine code for one thread.

use std::slice;

use pc_mech::MachineCode;

use crate::machinery::motion_field::MotionField;

/// The machine code of f with its parameters and its scratch memory, which nobody else uses.
pub(crate) struct Own {
    code: MachineCode,
    parameters: Vec<f64>,
    /// Pivots that depend on parameters alone.
    fixed_pivots: Vec<f64>,
    /// Its start is what the code leaves for [`MachineCode::is_regular`].
    room: Vec<f64>,
}

impl Own {
    /// The code with the current parameters; none if the field is more than machine code. It lives as
    /// long as the field.
    pub(crate) fn of(field: &mut MotionField) -> Option<Own> {
        let code = field.machine_code()?;
        let room = vec![0.0; code.scratch_len()];
        let mut own = Own { code, parameters: Vec::new(), fixed_pivots: Vec::new(), room };
        own.read_parameters(field);
        Some(own)
    }

    /// Reads the parameters of the field, which have changed.
    pub(crate) fn read_parameters(&mut self, field: &mut MotionField) {
        // In place: a kernel allocates nothing after it was made.
        let copy = |to: &mut Vec<f64>, from: Option<&[f64]>| {
            to.clear();
            to.extend_from_slice(from.unwrap_or_default());
        };
        copy(&mut self.fixed_pivots, field.fixed_pivots());
        copy(&mut self.parameters, field.code_parameters());
        assert_eq!(self.parameters.len(), self.code.parameters_len(), "parameters of the code");
    }

    /// Writes ẏ. Returns false if f fails; ẏ is then undefined.
    ///
    /// # Safety
    /// `y` and `ydot` have room for the state and share no memory; the field is alive.
    #[inline]
    pub(crate) unsafe fn rates(&mut self, t: f64, y: *const f64, ydot: *mut f64) -> bool {
        let Own { code, parameters, fixed_pivots, room } = self;
        // SAFETY: the code, which lives as long as the field, reads as many numbers of state and parameters as there
        // are, writes all rates, and has the scratch that it asked for, which begins with what is watched.
        unsafe {
            (code.entry())(t, y, parameters.as_ptr(), ydot, room.as_mut_ptr())
                && code.is_regular(slice::from_raw_parts(room.as_ptr(), code.watched_len()), |place| {
                    fixed_pivots[place]
                })
        }
    }
}
