//! Errors of a report.

use pc_model::ModelError;
use pc_verify::VerifyError;

/// The reason why a report cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// The model is wrong, or some part of it cannot be derived.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// The second derivation of the equations disagrees with the first.
    #[error(transparent)]
    Verify(Box<VerifyError>),
}
