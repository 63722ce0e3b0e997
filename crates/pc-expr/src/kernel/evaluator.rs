//! A program with the kernel that runs it.

use std::fmt;
use std::sync::{Arc, OnceLock};

use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::error::ExprError;
use crate::kernel::kernel::{Entry, Interpreter, Kernel};
use crate::program::program::Program;

/// The kernel that runs a program. All kernels give the same values, up to the rounding of fused operations.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Backend {
    /// Machine code if the host allows it and the program is not too long, else the interpreter.
    #[default]
    Fastest,
    /// The interpreter, which needs no compilation.
    Interpreter,
}

/// Maximum number of operations for which machine code is made: longer code takes more time and memory
/// to compile than it saves.
#[cfg(feature = "jit")]
const LONGEST_MACHINE_CODE: usize = 250_000;

/// The fastest kernel for `program` on this host: machine code, or the interpreter if none can be
/// made or the program has more than 250 000 operations.
pub fn compile(program: Arc<Program>) -> Box<dyn Kernel> {
    let leading = program.outputs_len();
    compile_with(program, leading)
}

/// The same, for [`Kernel::eval_leading`] with that many leading outputs.
#[cfg_attr(not(feature = "jit"), expect(unused_variables, reason = "machine code alone is made for them"))]
fn compile_with(program: Arc<Program>, leading: usize) -> Box<dyn Kernel> {
    #[cfg(feature = "jit")]
    if program.code().len() <= LONGEST_MACHINE_CODE
        && let Ok(jit) = {
            use crate::kernel::jit::{Jit, JitOptions};
            Jit::with_options(&program, &JitOptions { leading, ..JitOptions::default() })
        }
    {
        return Box::new(jit);
    }
    Box::new(Interpreter::new(program))
}

/// A program and its kernel, made on first use.
///
/// Clones share the machine code, whichever of them is the first to need it: it is compiled once for any number
/// of threads. A stored evaluator is its program; machine code is made again where it is loaded.
pub struct Evaluator {
    code: Arc<Code>,
    kernel: Option<Box<dyn Kernel>>,
}

/// What the clones of an evaluator have in common.
#[derive(Serialize, Deserialize)]
struct Code {
    program: Arc<Program>,
    backend: Backend,
    leading: usize,
    /// A kernel that is never run itself.
    #[serde(skip)]
    prototype: OnceLock<Box<dyn Kernel>>,
}

impl fmt::Debug for Evaluator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Evaluator").field("backend", &self.code.backend).finish_non_exhaustive()
    }
}

impl Clone for Evaluator {
    /// An independent evaluator of the same code, for another thread.
    fn clone(&self) -> Evaluator {
        Evaluator { code: Arc::clone(&self.code), kernel: self.kernel.as_ref().map(|kernel| kernel.fork()) }
    }
}

impl Serialize for Evaluator {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.code.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Evaluator {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Evaluator, D::Error> {
        let code = Code::deserialize(deserializer)?;
        if code.leading > code.program.outputs_len() {
            return Err(D::Error::custom("more leading outputs than outputs"));
        }
        Ok(Evaluator { code: Arc::new(code), kernel: None })
    }
}

impl Code {
    fn prototype(&self) -> &dyn Kernel {
        let made = || match self.backend {
            Backend::Fastest => compile_with(Arc::clone(&self.program), self.leading),
            Backend::Interpreter => Box::new(Interpreter::new(Arc::clone(&self.program))),
        };
        &**self.prototype.get_or_init(made)
    }
}

impl Evaluator {
    /// An evaluator of `program`.
    pub fn new(program: Program, backend: Backend) -> Evaluator {
        let leading = program.outputs_len();
        Evaluator::with_leading(program, backend, leading)
    }

    /// An evaluator of `program` with that many leading outputs.
    pub fn with_leading(program: Program, backend: Backend, leading: usize) -> Evaluator {
        let (program, prototype) = (Arc::new(program), OnceLock::new());
        Evaluator { code: Arc::new(Code { program, backend, leading, prototype }), kernel: None }
    }

    /// The program.
    pub fn program(&self) -> &Arc<Program> {
        &self.code.program
    }

    /// Computes the outputs at (t, state, parameters), as [`Kernel::eval`] does.
    #[inline]
    pub fn eval(&mut self, t: f64, state: &[f64], parameters: &[f64], outputs: &mut [f64]) {
        self.kernel().eval(t, state, parameters, outputs);
    }

    /// Computes the outputs; writes the leading ones, and returns the others and whether all are
    /// finite, as [`Kernel::eval_leading`] does.
    #[inline]
    pub fn eval_leading(
        &mut self,
        t: f64,
        state: &[f64],
        parameters: &[f64],
        leading: &mut [f64],
    ) -> (&[f64], bool) {
        self.kernel().eval_leading(t, state, parameters, leading)
    }

    #[inline]
    fn kernel(&mut self) -> &mut dyn Kernel {
        let code = &self.code;
        &mut **self.kernel.get_or_insert_with(|| code.prototype().fork())
    }

    /// Makes the kernel before it is needed.
    pub fn prepare(&mut self) {
        self.kernel();
    }

    /// The machine code, if there is any: [`Kernel::machine_code`].
    pub fn machine_code(&mut self) -> Option<(Entry, usize)> {
        self.kernel().machine_code()
    }

    /// The value that is not finite at (t, state, parameters), if any; see
    /// [`Interpreter::diagnose`].
    pub fn diagnose(&self, t: f64, state: &[f64], parameters: &[f64]) -> Option<ExprError> {
        Interpreter::new(Arc::clone(&self.code.program)).diagnose(t, state, parameters)
    }

    /// The error for results that are not finite: that of [`diagnose`](Evaluator::diagnose) or, if
    /// the interpreter's unfused operations are all finite, one that names the fused operations of
    /// machine code.
    pub fn blame(&self, t: f64, state: &[f64], parameters: &[f64]) -> ExprError {
        let expression = "a result of fused operations".to_owned();
        let fused = || ExprError::NotFinite { expression, value: f64::NAN, t, state: Vec::new() };
        self.diagnose(t, state, parameters).unwrap_or_else(fused)
    }
}
