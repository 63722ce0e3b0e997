//! f(t, y) computed by machine code alone.

use std::mem::MaybeUninit;
use std::slice;
use std::sync::atomic::{AtomicU64, Ordering, fence};

use pc_mech::MachineCode;

use crate::machinery::motion_field::MotionField;

/// The machine code of f, and the parameters for which it is evaluated.
///
/// An evaluation writes only to its own scratch, so it needs no lock. Like the reader of a seqlock,
/// it notices when new parameters are published during an evaluation.
pub(crate) struct Direct {
    code: MachineCode,
    /// A version number, which is even while the published numbers are complete; every publication
    /// changes it.
    version: AtomicU64,
    /// The published numbers, stored as the bits of f64: pivots that depend on parameters alone,
    /// and the parameters of the code.
    fixed_pivots: Box<[AtomicU64]>,
    parameters: Box<[AtomicU64]>,
    room: usize,
}

/// Largest scratch space on the stack, in numbers; an evaluation that needs more takes long enough
/// to hide the cost of an allocation.
const ON_STACK: usize = 4096;

impl Direct {
    /// The code with the current parameters, compiled on first use; none if the field is more
    /// than machine code. It lives as long as the field.
    pub(crate) fn of(field: &mut MotionField) -> Option<Direct> {
        let code = field.machine_code()?;
        let numbers = |len: usize| (0..len).map(|_| AtomicU64::new(0)).collect();
        let direct = Direct {
            version: AtomicU64::new(0),
            fixed_pivots: numbers(code.fixed_len()),
            parameters: numbers(code.parameters_len()),
            room: code.scratch_len(),
            code,
        };
        direct.publish(field);
        Some(direct)
    }

    /// Publishes the parameters of the field; only one call may do so at a time.
    pub(crate) fn publish(&self, field: &mut MotionField) {
        // Computed before the version turns odd and readers have to give up; below they are only
        // read.
        let _ = field.fixed_pivots();
        let _ = field.code_parameters();
        let version = self.version.load(Ordering::Relaxed);
        self.version.store(version + 1, Ordering::Relaxed);
        // No reader sees one of the numbers before the odd version.
        fence(Ordering::Release);
        let store = |places: &[AtomicU64], values: &[f64]| {
            for (place, value) in places.iter().zip(values) {
                place.store(value.to_bits(), Ordering::Relaxed);
            }
        };
        store(&self.fixed_pivots, field.fixed_pivots().unwrap_or_default());
        store(&self.parameters, field.code_parameters().unwrap_or_default());
        self.version.store(version + 2, Ordering::Release);
    }

    /// Number of components of the state.
    #[inline]
    pub(crate) fn dim(&self) -> usize {
        self.code.rates_len()
    }

    /// Writes ẏ. Returns false if f fails or the parameters change during the call; ẏ is then
    /// undefined.
    ///
    /// # Safety
    /// `y` and `ydot` have room for [`dim`](Direct::dim) numbers and share no memory; the field is
    /// alive.
    #[inline]
    pub(crate) unsafe fn rates(&self, t: f64, y: *const f64, ydot: *mut f64) -> bool {
        let version = self.version.load(Ordering::Acquire);
        let mut on_stack = [const { MaybeUninit::<f64>::uninit() }; ON_STACK];
        let mut on_heap = Vec::<f64>::new();
        let room = if self.room <= ON_STACK {
            on_stack.as_mut_ptr().cast::<f64>()
        } else {
            on_heap.reserve_exact(self.room);
            on_heap.as_mut_ptr()
        };
        // SAFETY: as promised, and the room is large enough.
        let right = unsafe { self.rates_by(t, y, ydot, room) };
        // All reads above come before the second read of the version.
        fence(Ordering::Acquire);
        right && version.is_multiple_of(2) && self.version.load(Ordering::Relaxed) == version
    }

    /// Writes ẏ, reading the published numbers whether they are complete or not.
    ///
    /// # Safety
    /// As for [`rates`](Direct::rates), with memory for the scratch of the code at `room`.
    #[inline]
    unsafe fn rates_by(&self, t: f64, y: *const f64, ydot: *mut f64, room: *mut f64) -> bool {
        let fixed = |place: usize| f64::from_bits(self.fixed_pivots[place].load(Ordering::Relaxed));
        let parameters = self.parameters.as_ptr().cast::<f64>();
        // SAFETY: the atomics are 64 bits each, as f64 is. The code, which lives as long as the field, reads as many
        // numbers of state and parameters as there are, loading each at once, writes all rates, and begins its scratch
        // with what is watched.
        unsafe {
            (self.code.entry())(t, y, parameters, ydot, room)
                && self.code.is_regular(slice::from_raw_parts(room, self.code.watched_len()), fixed)
        }
    }
}
