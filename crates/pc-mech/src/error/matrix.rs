//! Errors of matrices.

/// An error of a matrix.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MatrixError {
    /// A matrix that must be antisymmetric and is not.
    #[error("{what} must be antisymmetric, but its entries for `{}` and `{}` do not add up to zero", pair[0], pair[1])]
    NotSkew {
        /// The matrix.
        what: &'static str,
        /// The variables of the entries.
        pair: [String; 2],
    },
    /// A matrix whose eigenvalues or singular values cannot be computed.
    #[error(
        "a {rows} × {columns} matrix has entries that are not finite, or eigenvalues that cannot be found"
    )]
    NoEigenvalues {
        /// Its rows.
        rows: usize,
        /// Its columns.
        columns: usize,
    },
}
