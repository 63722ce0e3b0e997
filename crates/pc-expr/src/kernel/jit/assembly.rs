//! Compiled functions, and their memory.

use std::mem::ManuallyDrop;
use std::sync::Mutex;

use cranelift_codegen::Context;
use cranelift_codegen::ir::{FuncRef, Function};
use cranelift_codegen::isa::OwnedTargetIsa;
use cranelift_jit::{JITBuilder, JITModule};
use cranelift_module::{FuncId, Module};

use super::error::JitError;
use crate::kernel::kernel::Entry;

/// Compiled functions with their memory, which is freed with them.
pub(super) struct Assembly(ManuallyDrop<JITModule>);

impl Assembly {
    pub(super) fn new(isa: &OwnedTargetIsa) -> Assembly {
        // The code refers to nothing by name: it contains addresses.
        let builder = JITBuilder::with_isa(isa.clone(), cranelift_module::default_libcall_names());
        Assembly(ManuallyDrop::new(JITModule::new(builder)))
    }

    /// Compiles a function.
    pub(super) fn define(&mut self, context: &mut Context) -> Result<FuncId, JitError> {
        let id = self.0.declare_anonymous_function(&context.func.signature)?;
        self.0.define_function(id, context)?;
        Ok(id)
    }

    /// A reference by which a function may call another one.
    pub(super) fn name_in(&mut self, id: FuncId, function: &mut Function) -> FuncRef {
        let name = self.0.declare_func_in_func(id, function);
        // The two may be further apart than a relative call reaches.
        function.dfg.ext_funcs[name].colocated = false;
        name
    }

    /// Makes the code executable, with this entry; `constants` are read by address.
    pub(super) fn finish(mut self, entry: FuncId, constants: Box<[f64]>) -> Result<Code, JitError> {
        self.0.finalize_definitions()?;
        let address = self.0.get_finalized_function(entry) as usize;
        Ok(Code { address, _assembly: Mutex::new(self), _constants: constants })
    }
}

impl Drop for Assembly {
    fn drop(&mut self) {
        // SAFETY: the module is not used after it is taken here. Addresses of its code are in the
        // `Code` that owns this assembly, and copies of them must not be used after it is dropped.
        unsafe { ManuallyDrop::take(&mut self.0).free_memory() };
    }
}

/// Executable code.
pub(super) struct Code {
    address: usize,
    /// Owned but never read; the mutex makes it `Sync`.
    _assembly: Mutex<Assembly>,
    /// Constants read by the code.
    _constants: Box<[f64]>,
}

impl Code {
    pub(super) fn address(&self) -> usize {
        self.address
    }

    /// The code as a function, for code of [`entry_signature`](super::host::Host::entry_signature).
    pub(super) fn entry(&self) -> Entry {
        // SAFETY: the address is that of a finished function; making a pointer of it does not call
        // it.
        unsafe { std::mem::transmute::<*const u8, Entry>(self.address as *const u8) }
    }
}
