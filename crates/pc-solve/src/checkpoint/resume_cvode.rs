//! Resumption of an integration with CVODES.

use pc_expr::VectorField;

use crate::checkpoint::checkpoint::Checkpoint;
use crate::cvode::cvode::Cvode;
use crate::cvode::forward::sensitivities::Sensitivities;
use crate::error::{InputError, SolveError};
use crate::integration::checks::finite;
use crate::integration::integration::Integration;
use crate::settings::options::Options;

impl<F: VectorField> Cvode<F> {
    /// Begins at a checkpoint with its columns of sensitivities.
    ///
    /// # Errors
    /// As for [`with_sensitivities`](Cvode::with_sensitivities); [`InputError::Sensitivities`] if
    /// the checkpoint has a different number of columns.
    pub(crate) fn begin_at(
        field: F,
        checkpoint: &Checkpoint,
        options: &Options,
        sensitivities: &Sensitivities,
    ) -> Result<Self, SolveError> {
        let (found, dim) = (checkpoint.sensitivities.len(), checkpoint.state.len());
        if found != dim * sensitivities.len() {
            let (expected, found) = (sensitivities.len(), found / dim.max(1));
            return Err(InputError::Sensitivities { expected, found }.into());
        }
        for &value in &checkpoint.sensitivities {
            finite("a sensitivity of the checkpoint", value)?;
        }
        let cvode = Cvode::new(field, checkpoint.time, &checkpoint.state, options)?;
        cvode.and_sensitivities(sensitivities, options, checkpoint.sensitivities.clone())
    }
}

impl<F: VectorField> Integration<Cvode<F>> {
    /// Restarts at a checkpoint, which may be the start of a motion, without its events:
    /// [`with_events_of`](Integration::with_events_of) adds them.
    ///
    /// The resumed motion equals the uninterrupted one to the last bit if `field`, events and
    /// `options` are the same; fields and events that remember earlier evaluations must be in the
    /// state in which they were created.
    ///
    /// # Errors
    /// As for [`new`](Integration::new); [`InputError::Sensitivities`] if the checkpoint has
    /// sensitivities.
    pub fn resume(field: F, checkpoint: &Checkpoint, options: &Options) -> Result<Self, SolveError> {
        Integration::resume_with_sensitivities(field, checkpoint, options, &Sensitivities::new())
    }

    /// Restarts at a checkpoint as [`resume`](Integration::resume) does, with its sensitivities.
    /// The columns are specified by `sensitivities`, whose initial values are ignored.
    ///
    /// # Errors
    /// As for [`resume`](Integration::resume); [`InputError::Sensitivities`] if the checkpoint has
    /// a different number of columns.
    pub fn resume_with_sensitivities(
        field: F,
        checkpoint: &Checkpoint,
        options: &Options,
        sensitivities: &Sensitivities,
    ) -> Result<Self, SolveError> {
        Ok(Integration::resumed(Cvode::begin_at(field, checkpoint, options, sensitivities)?, checkpoint))
    }
}
