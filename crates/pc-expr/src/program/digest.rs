//! Digests of programs, to tell whether they are the same in two runs.

use std::fmt::{self, Write};

use crate::program::program::Program;

/// A number computed from the text that is written to it, the same in every run and on every machine (FNV-1a, 64
/// bits). A digest detects accidental differences, not deliberate ones.
///
/// ```
/// use std::fmt::Write;
///
/// let mut digest = pc_expr::Digest::default();
/// write!(digest, "{}", "a")?;
/// assert_eq!(digest.value(), 0xaf63_dc4c_8601_ec8c);
/// # Ok::<(), std::fmt::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Digest(u64);

impl Digest {
    /// The digest of everything written so far.
    pub fn value(self) -> u64 {
        self.0
    }

    /// Adds a name and a mark at its end.
    pub fn name(&mut self, name: &str) {
        let _ = write!(self, "{name}\0"); // writing to it cannot fail
    }

    /// Adds a program: its inputs by name, and its operations, without values of parameters.
    pub fn program(&mut self, program: &Program) {
        program.input_names().iter().for_each(|name| self.name(name));
        for constant in program.constants() {
            let _ = write!(self, "{:x} ", constant.to_bits());
        }
        // The printed form is the same for every word size.
        let _ = write!(self, "{:?} {:?}", program.code(), program.outputs());
    }
}

impl Default for Digest {
    fn default() -> Digest {
        Digest(0xcbf2_9ce4_8422_2325)
    }
}

impl Write for Digest {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        for byte in text.bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
        Ok(())
    }
}
