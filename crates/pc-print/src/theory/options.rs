//! Options of the theory.

use crate::theory::extent::Extent;

/// Options of the theory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TheoryOptions {
    /// The largest degree, in the velocities, of the integrals sought; at least 1.
    pub degree: u32,
    /// Functions of the coordinates by which the coefficients of these integrals may be multiplied, in the
    /// language of the model.
    pub functions: Vec<String>,
    /// Functions that are tested as canonical variables: new coordinates with their names, then as many new momenta, in the
    /// language of the model, with the momenta `p_x` as names besides the velocities.
    pub canonical: Vec<(String, String)>,
    /// How far the searches go.
    pub extent: Extent,
}

impl Default for TheoryOptions {
    /// The default options: degree 2, no functions, no new variables.
    fn default() -> TheoryOptions {
        TheoryOptions { degree: 2, functions: Vec::new(), canonical: Vec::new(), extent: Extent::Full }
    }
}
