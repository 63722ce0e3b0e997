//! The source of the structure coefficients.

use crate::derivation::constants::Constants;
use crate::error::Unable;
use crate::text::term::Term;
use crate::text::text::{Brackets, Text};

/// The source of the brackets.
#[derive(Clone, Debug)]
pub(crate) enum Structure {
    /// The frame, if b has as many independent columns as there are quasi-velocities.
    Frame,
    /// Constants that are given by the name of an algebra.
    Constant(Constants),
    /// A table whose values may depend on parameters and time.
    Table(Vec<(usize, usize, Term)>),
    /// Constants for which [X_r, X_s] = c_rs^m X_m holds everywhere.
    Fitted,
}

impl Structure {
    /// The source of the brackets, given that `rank` of the `k` fields are independent at a point.
    pub(crate) fn new(text: &Text, rank: usize, k: usize) -> Result<Structure, Unable> {
        if rank == k {
            return Ok(Structure::Frame);
        }
        match &text.brackets {
            Some(Brackets::Catalogue(name)) => {
                let unknown = || Unable::UnknownAlgebra { name: name.clone() };
                let constants = Constants::named(name).filter(|c| c.k == k).ok_or_else(unknown)?;
                Ok(Structure::Constant(constants))
            }
            Some(Brackets::Table(table)) => Ok(Structure::Table(table.clone())),
            None if text.coordinates() == 0 => Err(Unable::NoBrackets),
            None => Ok(Structure::Fitted),
        }
    }
}
