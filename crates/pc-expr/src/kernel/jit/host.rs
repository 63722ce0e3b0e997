//! The processor for which code is compiled.

use std::error::Error;

use cranelift_codegen::ir::{AbiParam, Signature, types};
use cranelift_codegen::isa::{CallConv, OwnedTargetIsa, TargetFrontendConfig};
use cranelift_codegen::settings::{self, Configurable};

use super::assembly::Code;

/// The processor of this machine.
pub(super) struct Host {
    isa: OwnedTargetIsa,
    fma: bool,
    /// The routine for sines and cosines outside the range of the inline code.
    far_circle: Option<Code>,
}

impl Host {
    /// The processor, without `far_circle`.
    pub(super) fn new() -> Result<Host, Box<dyn Error + Send + Sync>> {
        if !cfg!(any(target_arch = "x86_64", target_arch = "aarch64")) {
            return Err(format!("the architecture {} is not supported", std::env::consts::ARCH).into());
        }
        let mut flags = settings::builder();
        // The graph is already optimised; Cranelift would only undo the order of the plan.
        flags.set("opt_level", "none")?;
        flags.set("enable_verifier", if cfg!(debug_assertions) { "true" } else { "false" })?;
        flags.set("unwind_info", "false")?;
        flags.set("is_pic", "false")?;
        flags.set("probestack_strategy", "inline")?;
        let isa = cranelift_native::builder()?.finish(settings::Flags::new(flags))?;
        let flags = isa.isa_flags();
        let fma = cfg!(target_arch = "aarch64") // always available
            || flags.iter().any(|flag| flag.name == "has_fma" && flag.as_bool() == Some(true));
        Ok(Host { isa, fma, far_circle: None })
    }

    pub(super) fn with_far_circle(self, code: Code) -> Host {
        Host { far_circle: Some(code), ..self }
    }

    pub(super) fn isa(&self) -> &OwnedTargetIsa {
        &self.isa
    }

    pub(super) fn has_fma(&self) -> bool {
        self.fma
    }

    /// The address of the routine compiled by [`compile_far`](super::sincos::compile_far), on
    /// processors with fused multiply-add.
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

    /// The signature of [`Entry`](crate::Entry).
    pub(super) fn entry_signature(&self) -> Signature {
        let mut signature = Signature::new(self.convention());
        signature.params.push(AbiParam::new(types::F64));
        signature.params.extend([AbiParam::new(types::I64); 4]);
        signature.returns.push(AbiParam::new(types::I8));
        signature
    }
}
