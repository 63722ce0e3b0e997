//! Addressing of memory by compiled code.
//!
//! On x86-64 an offset of less than 128 bytes from an address in a register takes one byte of an
//! instruction, a larger one takes four; and code too long for the instruction cache runs several
//! times slower. So memory is divided into windows of 256 bytes, with the address of the middle of each
//! window in a register.

use cranelift_codegen::cursor::{Cursor, FuncCursor};
use cranelift_codegen::ir::{Block, InstBuilder, MemFlagsData, Value, types};
use cranelift_frontend::FunctionBuilder;

/// Number of values in a window.
const WINDOW: u32 = 32;

/// Memory that compiled code reads or writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Area {
    State,
    Parameters,
    Outputs,
    Scratch,
    Constants,
}

impl Area {
    /// Number of windows with a register; memory beyond these windows is addressed from the last one.
    /// The windows of all areas together leave some registers free.
    fn windows(self) -> u32 {
        match self {
            Area::Scratch => 6,
            Area::Constants => 2,
            Area::State | Area::Parameters | Area::Outputs => 1,
        }
    }
}

/// The memory of one function.
pub(super) struct Memory {
    entry: Block,
    body: Block,
    /// The argument t, the only one that is not an address.
    pub(super) t: Value,
    /// Addresses of state, parameters, outputs and scratch.
    arguments: [Value; 4],
    /// Address of the constants.
    constants: i64,
    windows: Vec<(Area, u32, Value)>,
}

impl Memory {
    /// Opens a function with the signature of [`Entry`](super::Entry): a first block to compute
    /// addresses, and the body.
    pub(super) fn open(b: &mut FunctionBuilder<'_>, constants: &[f64]) -> Memory {
        let entry = b.create_block();
        b.append_block_params_for_function_params(entry);
        b.func.layout.append_block(entry);
        let arguments = [0, 1, 2, 3, 4].map(|i| b.block_params(entry)[i]);
        let [t, arguments @ ..] = arguments;
        let body = b.create_block();
        b.switch_to_block(body);
        Memory { entry, body, t, arguments, constants: constants.as_ptr() as i64, windows: Vec::new() }
    }

    pub(super) fn load(&mut self, b: &mut FunctionBuilder<'_>, area: Area, index: u32) -> Value {
        let (base, offset) = self.place(b, area, index);
        b.ins().load(types::F64, MemFlagsData::trusted(), base, offset)
    }

    pub(super) fn store(&mut self, b: &mut FunctionBuilder<'_>, value: Value, area: Area, index: u32) {
        let (base, offset) = self.place(b, area, index);
        b.ins().store(MemFlagsData::trusted(), value, base, offset);
    }

    fn place(&mut self, b: &mut FunctionBuilder<'_>, area: Area, index: u32) -> (Value, i32) {
        let window = (index / WINDOW).min(area.windows() - 1);
        let known = self.windows.iter().find(|&&(of, at, _)| (of, at) == (area, window));
        let base = match known {
            Some(&(.., base)) => base,
            None => {
                let base = self.base(b, area, window);
                self.windows.push((area, window, base));
                base
            }
        };
        (base, (index * 8) as i32 - middle(window))
    }

    /// Computes the address of the middle of a window, in the first block.
    fn base(&self, b: &mut FunctionBuilder<'_>, area: Area, window: u32) -> Value {
        let [state, parameters, outputs, scratch] = self.arguments;
        let mut entry = FuncCursor::new(b.func).at_bottom(self.entry);
        let start = match area {
            Area::State => state,
            Area::Parameters => parameters,
            Area::Outputs => outputs,
            Area::Scratch => scratch,
            Area::Constants => entry.ins().iconst(types::I64, self.constants),
        };
        // Cranelift would fold a sum into each use and compute it there, but not a difference.
        let distance = entry.ins().iconst(types::I64, -i64::from(middle(window)));
        entry.ins().isub(start, distance)
    }

    /// Ends the first block.
    pub(super) fn close(self, b: &mut FunctionBuilder<'_>) {
        b.switch_to_block(self.entry);
        b.ins().jump(self.body, &[]);
    }
}

/// The offset of the middle of a window in bytes from the start of its area.
fn middle(window: u32) -> i32 {
    (window * WINDOW * 8 + WINDOW * 4) as i32
}
