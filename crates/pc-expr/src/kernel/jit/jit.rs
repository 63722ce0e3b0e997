//! A program as a kernel of machine code.

use std::borrow::Cow;
use std::error::Error;
use std::fmt;
use std::sync::{Arc, OnceLock};

use crate::kernel::kernel::{Entry, Kernel};
use crate::program::program::Program;

use super::assembly::Code;
use super::error::JitError;
use super::host::Host;
use super::options::JitOptions;
use super::plan::Plan;
use super::{emit, sincos};

/// Maximum number of registers, since offsets in memory are 32-bit.
const MOST_REGISTERS: usize = i32::MAX as usize / 16;

/// A kernel that runs a program as machine code.
///
/// Clones and forks share the code, which is freed with the last of them.
///
/// ```
/// use pc_expr::{Graph, Inputs, Jit, Kernel, Program};
///
/// let graph = Graph::new();
/// let [x, v] = graph.symbols(["x", "v"]);
/// let inputs = Inputs { time: None, state: vec![x, v], parameters: vec![] };
/// let program = Program::new(&graph, &inputs, &[v, -x.sin()])?;
/// let mut kernel = Jit::new(&program)?;
/// let mut out = [0.0; 2];
/// kernel.eval(0.0, &[0.0, 3.0], &[], &mut out);
/// assert_eq!(out, [3.0, 0.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct Jit {
    code: Arc<Code>,
    lengths: [usize; 3],
    /// How many of the outputs the code writes to the memory for outputs.
    leading: usize,
    scratch: Vec<f64>,
}

impl Jit {
    /// Compiles a program with the default [options](JitOptions).
    ///
    /// # Errors
    /// [`JitError`], normally only [`JitError::Host`].
    pub fn new(program: &Program) -> Result<Jit, JitError> {
        Jit::with_options(program, &JitOptions::default())
    }

    /// Compiles a program.
    ///
    /// # Errors
    /// [`JitError`], normally only [`JitError::Host`].
    pub fn with_options(program: &Program, options: &JitOptions) -> Result<Jit, JitError> {
        let host = Host::get()?;
        if program.registers_len().max(program.outputs_len()) > MOST_REGISTERS {
            return Err(JitError::TooLong { instructions: program.code().len() });
        }
        let fused = host.has_fma() && options.fma;
        let program = if fused { Cow::Owned(program.fused()) } else { Cow::Borrowed(program) };
        let options = JitOptions { inline_trig: options.inline_trig && host.has_fma(), ..*options };
        let plan = Plan::new(&program, &options);
        let (code, scratch) = emit::compile(host, &program, &plan, &options)?;
        Ok(Jit {
            leading: options.leading.min(program.outputs_len()),
            code: Arc::new(code),
            lengths: [program.state_len(), program.parameters_len(), program.outputs_len()],
            scratch: vec![0.0; scratch],
        })
    }

    /// The address of the code, for callers that manage memory themselves; valid as long as this
    /// kernel or a clone of it exists.
    pub fn entry(&self) -> Entry {
        self.code.entry()
    }

    /// The length of the scratch memory of [`entry`](Jit::entry). Its contents do not matter; the
    /// code leaves the outputs after the [leading](JitOptions::leading) ones at its start.
    pub fn scratch_len(&self) -> usize {
        self.scratch.len()
    }

    /// Length of the state.
    pub fn state_len(&self) -> usize {
        self.lengths[0]
    }

    /// Number of parameters.
    pub fn parameters_len(&self) -> usize {
        self.lengths[1]
    }

    /// Number of outputs.
    pub fn outputs_len(&self) -> usize {
        self.lengths[2]
    }
}

impl Host {
    /// The host, examined once.
    fn get() -> Result<&'static Host, JitError> {
        static HOST: OnceLock<Result<Host, String>> = OnceLock::new();
        HOST.get_or_init(|| Host::with_routines().map_err(|error| error.to_string()))
            .as_ref()
            .map_err(|reason| JitError::Host { reason: reason.clone() })
    }

    fn with_routines() -> Result<Host, Box<dyn Error + Send + Sync>> {
        let host = Host::new()?;
        if !host.has_fma() {
            return Ok(host);
        }
        let code = sincos::compile_far(&host)?;
        Ok(host.with_far_circle(code))
    }
}

impl fmt::Debug for Jit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [state, parameters, outputs] = self.lengths;
        f.debug_struct("Jit")
            .field("state", &state)
            .field("parameters", &parameters)
            .field("outputs", &outputs)
            .finish_non_exhaustive()
    }
}

impl Kernel for Jit {
    /// # Panics
    /// If a slice does not have the length given by the program: the code would read or write
    /// beyond it.
    fn eval(&mut self, t: f64, state: &[f64], parameters: &[f64], outputs: &mut [f64]) {
        // Compared one by one, in registers, since this runs for every evaluation.
        let [of_state, of_parameters, of_outputs] = self.lengths;
        assert_eq!(state.len(), of_state, "length of the state");
        assert_eq!(parameters.len(), of_parameters, "number of parameters");
        assert_eq!(outputs.len(), of_outputs, "number of outputs");
        let (leading, others) = outputs.split_at_mut(self.leading);
        let entry = self.code.entry();
        // SAFETY: `self.code` holds the code; it reads and writes within the lengths just checked
        // and within `scratch_len` numbers of scratch, and exclusive borrows keep outputs and
        // scratch apart from the rest.
        unsafe {
            entry(t, state.as_ptr(), parameters.as_ptr(), leading.as_mut_ptr(), self.scratch.as_mut_ptr());
        }
        others.copy_from_slice(&self.scratch[..others.len()]);
    }

    /// # Panics
    /// As for [`eval`](Kernel::eval).
    fn eval_leading(
        &mut self,
        t: f64,
        state: &[f64],
        parameters: &[f64],
        leading: &mut [f64],
    ) -> (&[f64], bool) {
        let [of_state, of_parameters, of_outputs] = self.lengths;
        assert_eq!(state.len(), of_state, "length of the state");
        assert_eq!(parameters.len(), of_parameters, "number of parameters");
        assert_eq!(leading.len(), self.leading, "number of leading outputs");
        let entry = self.code.entry();
        // SAFETY: as for `eval`.
        let finite = unsafe {
            entry(t, state.as_ptr(), parameters.as_ptr(), leading.as_mut_ptr(), self.scratch.as_mut_ptr())
        };
        (&self.scratch[..of_outputs - self.leading], finite)
    }

    fn fork(&self) -> Box<dyn Kernel> {
        Box::new(self.clone())
    }

    fn machine_code(&self) -> Option<(Entry, usize)> {
        Some((self.entry(), self.scratch_len()))
    }
}
