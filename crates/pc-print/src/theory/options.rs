//! Options of the theory.

/// Options of the theory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TheoryOptions {
    /// The largest degree, in the velocities, of the integrals sought; at least 1.
    pub degree: u32,
    /// Functions of the coordinates by which the coefficients of these integrals may be multiplied, in the
    /// language of the model.
    pub functions: Vec<String>,
}

impl Default for TheoryOptions {
    /// The default options: degree 2, no functions.
    fn default() -> TheoryOptions {
        TheoryOptions { degree: 2, functions: Vec::new() }
    }
}
