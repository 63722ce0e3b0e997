//! f(t, y) by nothing but machine code.

use std::mem::MaybeUninit;
use std::slice;
use std::sync::atomic::{AtomicU64, Ordering, fence};

use pc_mech::MachineCode;

use crate::machinery::motion_field::MotionField;

/// The machine code of f, and the parameters it is for.
///
/// An evaluation changes nothing but its room, so that it needs no lock. It notices when the parameters are published
/// anew meanwhile, as the reader of a seqlock does.
pub(crate) struct Direct {
    code: MachineCode,
    /// What is published is complete if this is even, and another one if it is another number.
    version: AtomicU64,
    /// What is published, f64 all of it; after the parameters what is computed of them.
    fixed_pivots: Box<[AtomicU64]>,
    parameters: Box<[AtomicU64]>,
    room: usize,
}

/// Most numbers that are taken from the stack; for more, whatever they are, an allocation is not felt.
const ON_STACK: usize = 4096;

impl Direct {
    /// With the parameters as they are; none where the field is more than machine code. The code is compiled if it was
    /// not, and lives as long as the field.
    pub(crate) fn of(field: &mut MotionField) -> Option<Direct> {
        let code = field.machine_code()?;
        let beside = if code.outputs_len() == code.rates_len() { 0 } else { code.outputs_len() };
        let numbers = |len: usize| (0..len).map(|_| AtomicU64::new(0)).collect();
        let direct = Direct {
            version: AtomicU64::new(0),
            fixed_pivots: numbers(code.fixed_len()),
            parameters: numbers(code.parameters_len()),
            room: beside + code.scratch_len(),
            code,
        };
        direct.publish(field);
        Some(direct)
    }

    /// Takes over the parameters of the field; one call at a time.
    pub(crate) fn publish(&self, field: &mut MotionField) {
        // They are computed now, while nobody has to wait for them, and only read below.
        let _ = field.fixed_pivots();
        let _ = field.code_parameters();
        let version = self.version.load(Ordering::Relaxed);
        self.version.store(version + 1, Ordering::Relaxed);
        // None of the numbers is seen before that.
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

    /// How many numbers it needs for scratch, and for its outputs where they are not the rates alone.
    pub(crate) fn room(&self) -> usize {
        self.room
    }

    /// Writes ẏ. False where f fails, and where the parameters change meanwhile: ẏ is of no use then.
    ///
    /// # Safety
    /// `y` and `ydot` have place for [`dim`](Direct::dim) numbers and share no memory; the field lives.
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
        let right = unsafe { self.rates_alone(t, y, ydot, room) };
        // All that was read was read before this.
        fence(Ordering::Acquire);
        right && version.is_multiple_of(2) && self.version.load(Ordering::Relaxed) == version
    }

    /// The same where nobody publishes meanwhile.
    ///
    /// # Safety
    /// As for [`rates`](Direct::rates), with place for [`room`](Direct::room) numbers at `room`.
    #[inline]
    pub(crate) unsafe fn rates_alone(&self, t: f64, y: *const f64, ydot: *mut f64, room: *mut f64) -> bool {
        let (dim, outputs) = (self.dim(), self.code.outputs_len());
        let fixed = |place: usize| f64::from_bits(self.fixed_pivots[place].load(Ordering::Relaxed));
        let parameters = self.parameters.as_ptr().cast::<f64>();
        // SAFETY: the atomics are 64 bits each, as f64 is. The code, which lives as long as the field, reads as many
        // numbers of state and parameters as there are, loading each at once, and writes all outputs and the scratch.
        unsafe {
            let run = |outputs, scratch| (self.code.entry())(t, y, parameters, outputs, scratch);
            if outputs == dim {
                run(ydot, room);
                let rates = slice::from_raw_parts(ydot, dim);
                return rates.iter().all(|rate| rate.is_finite()) && self.code.is_regular(&[], fixed);
            }
            run(room, room.add(outputs));
            let (rates, watched) = slice::from_raw_parts(room, outputs).split_at(dim);
            // One pass with an early end, which keeps it number by number: a copy in wider pieces would wait for the
            // numbers just written.
            let copied = rates.iter().enumerate().all(|(i, &rate)| {
                ydot.add(i).write(rate);
                rate.is_finite()
            });
            copied && self.code.is_regular(watched, fixed)
        }
    }
}
