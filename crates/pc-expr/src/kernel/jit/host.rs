//! The processor that code is made for, and the memory that code lives in.

use crate::kernel::jit::sincos;
use std::error::Error;
use std::mem::ManuallyDrop;
use std::sync::{Mutex, OnceLock};

use cranelift_codegen::Context;
use cranelift_codegen::ir::{AbiParam, FuncRef, Function, Signature, types};
use cranelift_codegen::isa::{CallConv, OwnedTargetIsa, TargetFrontendConfig};
use cranelift_codegen::settings::{self, Configurable};
use cranelift_jit::{JITBuilder, JITModule};
use cranelift_module::{FuncId, Module, ModuleError};

use super::{Entry, JitError};

/// The processor of this machine.
pub(super) struct Host {
    isa: OwnedTargetIsa,
    fma: bool,
    /// The routine for sines and cosines out of the range of the code in line.
    far_circle: Option<Code>,
}

impl Host {
    /// The host, looked at once.
    pub(super) fn get() -> Result<&'static Host, JitError> {
        static HOST: OnceLock<Result<Host, String>> = OnceLock::new();
        HOST.get_or_init(|| Host::new().map_err(|error| error.to_string()))
            .as_ref()
            .map_err(|reason| JitError::Host { reason: reason.clone() })
    }

    fn new() -> Result<Host, Box<dyn Error + Send + Sync>> {
        if !cfg!(any(target_arch = "x86_64", target_arch = "aarch64")) {
            return Err(format!("the architecture {} is not supported", std::env::consts::ARCH).into());
        }
        let mut flags = settings::builder();
        // The graph has been optimised already; Cranelift would only undo the order of the plan.
        flags.set("opt_level", "none")?;
        flags.set("enable_verifier", if cfg!(debug_assertions) { "true" } else { "false" })?;
        flags.set("unwind_info", "false")?;
        flags.set("is_pic", "false")?;
        flags.set("probestack_strategy", "inline")?;
        let isa = cranelift_native::builder()?.finish(settings::Flags::new(flags))?;
        let flags = isa.isa_flags();
        let fma = cfg!(target_arch = "aarch64") // always there
            || flags.iter().any(|flag| flag.name == "has_fma" && flag.as_bool() == Some(true));
        let mut host = Host { isa, fma, far_circle: None };
        if fma {
            host.far_circle = Some(sincos::compile_far(&host)?);
        }
        Ok(host)
    }

    pub(super) fn has_fma(&self) -> bool {
        self.fma
    }

    /// The address of what [`sincos::compile_far`] made, where there is fused multiply-add.
    pub(super) fn far_circle(&self) -> usize {
        self.far_circle.as_ref().map_or(0, Code::address)
    }

    /// The calling convention of `extern "C"`.
    pub(super) fn convention(&self) -> CallConv {
        self.isa.default_call_conv()
    }

    pub(super) fn frontend_config(&self) -> TargetFrontendConfig {
        self.isa.frontend_config()
    }

    /// The signature of [`Entry`].
    pub(super) fn entry_signature(&self) -> Signature {
        let mut signature = Signature::new(self.convention());
        signature.params.push(AbiParam::new(types::F64));
        signature.params.extend([AbiParam::new(types::I64); 4]);
        signature
    }
}

impl From<ModuleError> for JitError {
    fn from(error: ModuleError) -> JitError {
        JitError::Generator(Box::new(error))
    }
}

/// Compiled functions and the memory they lie in, which is freed with them.
pub(super) struct Assembly(ManuallyDrop<JITModule>);

impl Assembly {
    pub(super) fn new(host: &Host) -> Assembly {
        // No code refers to anything by name: addresses are written into it.
        let builder = JITBuilder::with_isa(host.isa.clone(), cranelift_module::default_libcall_names());
        Assembly(ManuallyDrop::new(JITModule::new(builder)))
    }

    /// Compiles a function.
    pub(super) fn define(&mut self, context: &mut Context) -> Result<FuncId, JitError> {
        let id = self.0.declare_anonymous_function(&context.func.signature)?;
        self.0.define_function(id, context)?;
        Ok(id)
    }

    /// A name by which a function may call another one.
    pub(super) fn name_in(&mut self, id: FuncId, function: &mut Function) -> FuncRef {
        let name = self.0.declare_func_in_func(id, function);
        // The two may lie further apart than a relative call reaches.
        function.dfg.ext_funcs[name].colocated = false;
        name
    }

    /// Makes the code executable, to be entered at a function; `constants` are what it reads by address.
    pub(super) fn finish(mut self, entry: FuncId, constants: Box<[f64]>) -> Result<Code, JitError> {
        self.0.finalize_definitions()?;
        let address = self.0.get_finalized_function(entry) as usize;
        Ok(Code { address, _assembly: Mutex::new(self), _constants: constants })
    }
}

impl Drop for Assembly {
    fn drop(&mut self) {
        // SAFETY: the module is not used after it is taken here. Addresses of its code are in the `Code` that owns this
        // assembly, and whoever copies them from there answers for not using them after it.
        unsafe { ManuallyDrop::take(&mut self.0).free_memory() };
    }
}

/// Executable code.
pub(super) struct Code {
    address: usize,
    /// Owned, never looked at; the mutex makes it `Sync`.
    _assembly: Mutex<Assembly>,
    /// Read by the code.
    _constants: Box<[f64]>,
}

impl Code {
    pub(super) fn address(&self) -> usize {
        self.address
    }

    /// The code as a function, for code of [`Host::entry_signature`].
    pub(super) fn entry(&self) -> Entry {
        // SAFETY: the address is that of a finished function; making a pointer of it does not call it.
        unsafe { std::mem::transmute::<*const u8, Entry>(self.address as *const u8) }
    }
}
