//! Where an integration without events can be taken up again.

use pc_expr::VectorField;

use super::Cvode;
use crate::checkpoint::Checkpoint;
use crate::error::SolveError;
use crate::options::Options;

impl<F: VectorField> Cvode<F> {
    /// Time, state and work where the integration stands, to be gone on from by [`resume`](Cvode::resume).
    pub fn checkpoint(&self) -> Checkpoint {
        let start = Checkpoint::start(self.time(), self.state());
        Checkpoint { statistics: self.statistics(), jumped: self.jumped, ..start }
    }

    /// Begins anew at a checkpoint. Both the motion that was interrupted there and the one that was not go on from here
    /// with the same numbers, if `field` and `options` are the same; a field that remembers earlier evaluations must be
    /// as it was when made.
    ///
    /// If the motion was [restarted](Cvode::restart) before the checkpoint, the field is told to go on from
    /// [there](VectorField::restart), so that it keeps what it kept after the jump.
    ///
    /// # Errors
    /// As for [`new`](Cvode::new).
    pub fn resume(field: F, checkpoint: &Checkpoint, options: &Options) -> Result<Self, SolveError> {
        let mut cvode = Cvode::new(field, checkpoint.time, &checkpoint.state, options)?;
        if checkpoint.jumped {
            cvode.callbacks.restart(checkpoint.time, &checkpoint.state);
            cvode.jumped = true;
        }
        Ok(cvode)
    }
}
