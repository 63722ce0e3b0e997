//! Executable code, and the routine that it calls.

use std::io;

use memmap2::{Mmap, MmapMut};

use super::super::instruction_set::InstructionSet;
use super::super::tape::{LANES, LaneTape, Lanes};
use super::assembler::EncodeError;
use super::emit::{Emitted, emit};
use crate::graph::function::Function;

/// Takes a frame, starting at the first lane of a vector, and the constants; returns the lanes that are
/// out of range.
type Enter = unsafe extern "sysv64" fn(*mut f64, *const f64) -> u32;

/// Why a tape was not compiled.
#[derive(Debug, thiserror::Error)]
pub(crate) enum CodeError {
    #[error(transparent)]
    Encode(#[from] EncodeError),
    #[error("no memory for code")]
    Memory(#[from] io::Error),
}

/// Executable code of a tape.
#[derive(Debug)]
pub(crate) struct Code {
    /// Written once, then executable and no longer writable.
    memory: Mmap,
    pool: Vec<Lanes>,
    /// Number of lanes in a vector.
    width: usize,
    rows: usize,
}

impl Code {
    /// Compiles a tape.
    ///
    /// # Errors
    /// [`CodeError`] if memory cannot be allocated.
    pub(crate) fn new(tape: &LaneTape, set: InstructionSet) -> Result<Code, CodeError> {
        let Emitted { bytes, pool, rows } = emit(tape, set, routine as *const () as u64)?;
        let mut memory = MmapMut::map_anon(bytes.len())?;
        memory.copy_from_slice(&bytes);
        let memory = memory.make_exec()?;
        let pool = pool.chunks(LANES).map(|chunk| {
            let mut row = Lanes::splat(0.0);
            row.0[..chunk.len()].copy_from_slice(chunk);
            row
        });
        let width = if set == InstructionSet::Avx512 { LANES } else { LANES / 2 };
        Ok(Code { memory, pool: pool.collect(), width, rows })
    }

    /// Number of rows of a frame.
    pub(crate) fn rows(&self) -> usize {
        self.rows
    }

    /// Length in bytes.
    pub(crate) fn len(&self) -> usize {
        self.memory.len()
    }

    /// Runs the code; for each vector with a lane out of range, calls `again` with the first lane and the
    /// width of that vector, while the inputs are still unchanged.
    ///
    /// # Panics
    /// If the frame has too few rows.
    #[inline]
    pub(crate) fn run(&self, frame: &mut [Lanes], mut again: impl FnMut(&mut [Lanes], usize, usize)) {
        assert!(frame.len() >= self.rows, "rows of the frame");
        // SAFETY: the memory holds a whole function of this type, and is not written again.
        let enter = unsafe { std::mem::transmute::<*const u8, Enter>(self.memory.as_ptr()) };
        for first in (0..LANES).step_by(self.width) {
            let start = frame.as_mut_ptr().cast::<f64>();
            // SAFETY: from the lane `first` on, the code reads and writes as many lanes as fit in
            // each of the rows just checked, at addresses aligned to its vectors, since rows are
            // aligned to 64 bytes and `first` is 0 or half a row; the pool holds its constants.
            // Callers of `new` have checked that this processor has the instruction set.
            let noted = unsafe { enter(start.add(first), self.pool.as_ptr().cast()) };
            if noted != 0 {
                again(frame, first, self.width);
            }
        }
    }
}

/// Applies the function with that number to the first `width` lanes of three rows, and writes the
/// results to the first row.
extern "sysv64" fn routine(rows: *mut f64, number: u32, width: u32) {
    let Some(function) = Function::ALL.get(number as usize) else { return };
    for lane in 0..width as usize {
        // SAFETY: the code passes the address of three rows of its frame, in which the lanes of a
        // vector begin there; a row that holds no argument may hold anything.
        unsafe {
            let place = rows.add(lane);
            let arguments = [*place, *place.add(LANES), *place.add(2 * LANES)];
            *place = function.eval(&arguments);
        }
    }
}
