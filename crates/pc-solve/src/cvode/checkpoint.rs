//! Where an integration without events can be taken up again.

use pc_expr::VectorField;

use crate::checkpoint::checkpoint::Checkpoint;
use crate::cvode::cvode::Cvode;
use crate::error::{InputError, SolveError};
use crate::integration::options::{Options, finite};
use crate::sensitivity::options::Sensitivities;

impl<F: VectorField> Cvode<F> {
    /// Time, state, sensitivities and work where the integration stands, to be gone on from by [`resume`](Cvode::resume), or
    /// [with sensitivities](Cvode::resume_with_sensitivities) if there are any.
    pub fn checkpoint(&self) -> Checkpoint {
        let start = Checkpoint::start(self.time(), self.state());
        Checkpoint {
            statistics: self.statistics(),
            jumped: self.jumped,
            sensitivities: self.sensitivities_to_keep(),
            ..start
        }
    }

    /// Begins anew at a checkpoint. Both the motion that was interrupted there and the one that was not go on from here
    /// with the same numbers, if `field` and `options` are the same; a field that remembers earlier evaluations must be
    /// as it was when made.
    ///
    /// If the motion was [restarted](Cvode::restart) before the checkpoint, the field is told to go on from
    /// [there](VectorField::restart), so that it keeps what it kept after the jump.
    ///
    /// # Errors
    /// As for [`new`](Cvode::new); [`InputError::Sensitivities`] if the checkpoint has sensitivities.
    pub fn resume(field: F, checkpoint: &Checkpoint, options: &Options) -> Result<Self, SolveError> {
        Cvode::resume_with_sensitivities(field, checkpoint, options, &Sensitivities::new())
    }

    /// Begins anew at a checkpoint as [`resume`](Cvode::resume) does, with the sensitivities that it has. Their columns are
    /// those of `sensitivities`, whose starts do not matter.
    ///
    /// # Errors
    /// As for [`with_sensitivities`](Cvode::with_sensitivities); [`InputError::Sensitivities`] if the checkpoint has another number
    /// of columns.
    pub fn resume_with_sensitivities(
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
        let start = checkpoint.sensitivities.clone();
        let mut cvode = cvode.and_sensitivities(sensitivities, options, start)?;
        if checkpoint.jumped {
            cvode.callbacks.restart(checkpoint.time, &checkpoint.state);
            cvode.jumped = true;
        }
        Ok(cvode)
    }
}
