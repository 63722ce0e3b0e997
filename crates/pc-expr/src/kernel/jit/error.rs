//! Why a program was not compiled.

use std::error::Error;

use cranelift_module::ModuleError;

/// Why a program was not compiled.
#[derive(Debug, thiserror::Error)]
pub enum JitError {
    /// No code can be made for this processor or operating system.
    #[error("no machine code for this host: {reason}")]
    Host {
        /// What is missing.
        reason: String,
    },
    /// The program is too long for 32-bit offsets.
    #[error("a program of {instructions} instructions is too long to compile")]
    TooLong {
        /// Its length.
        instructions: usize,
    },
    /// The code generator failed, or memory for the code could not be allocated.
    #[error("the program could not be compiled")]
    Generator(#[source] Box<dyn Error + Send + Sync>),
}

impl From<ModuleError> for JitError {
    fn from(error: ModuleError) -> JitError {
        JitError::Generator(Box::new(error))
    }
}
