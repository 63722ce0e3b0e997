//! The beginning and end of functions.

use cranelift_codegen::ir::{InstBuilder, Value};
use cranelift_frontend::FunctionBuilder;

use super::host::Host;

/// Opens the first block of a function; returns the function's parameters.
pub(super) fn open(b: &mut FunctionBuilder<'_>) -> Vec<Value> {
    let block = b.create_block();
    b.append_block_params_for_function_params(block);
    b.switch_to_block(block);
    b.block_params(block).to_vec()
}

/// Returns from a function and ends it.
pub(super) fn close(mut b: FunctionBuilder<'_>, host: &Host, results: &[Value]) {
    b.ins().return_(results);
    b.seal_all_blocks();
    b.finalize(host.frontend_config());
}
