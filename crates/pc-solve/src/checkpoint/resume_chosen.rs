//! Resumption of an integration with the method chosen in the options.

use pc_expr::VectorField;

use crate::checkpoint::checkpoint::Checkpoint;
use crate::chosen::Chosen;
use crate::cvode::cvode::Cvode;
use crate::cvode::forward::sensitivities::Sensitivities;
use crate::error::SolveError;
use crate::integration::integration::Integration;
use crate::settings::options::Options;

impl<F: VectorField> Integration<Chosen<F>> {
    /// Begins at a checkpoint, which may be the start of a motion, with the method of the options
    /// and without its events: [`with_events_of`](Integration::with_events_of) adds them.
    ///
    /// With sensitivities the method is one of those of CVODES, namely Adams for
    /// [`Method::Auto`](crate::Method::Auto); the columns are those of the checkpoint or, at the
    /// start of a motion, those of `sensitivities`.
    ///
    /// # Errors
    /// As for [`Chosen::new`], and
    /// [`resume_with_sensitivities`](Integration::resume_with_sensitivities).
    pub fn begin(
        field: F,
        checkpoint: &Checkpoint,
        options: &Options,
        sensitivities: &Sensitivities,
    ) -> Result<Self, SolveError> {
        let (t, y) = (checkpoint.time, &checkpoint.state[..]);
        let stepper = match (sensitivities.is_empty(), checkpoint.sensitivities.is_empty()) {
            (true, true) => Chosen::new(field, t, y, options)?,
            (false, true) => Chosen::by_cvode(field, t, options, |field, start, options| {
                Cvode::with_sensitivities(field, start, y, options, sensitivities)
            })?,
            (_, false) => Chosen::by_cvode(field, t, options, |field, start, options| {
                let checkpoint = Checkpoint { time: start, ..checkpoint.clone() };
                Cvode::begin_at(field, &checkpoint, options, sensitivities)
            })?,
        };
        Ok(Integration::resumed(stepper, checkpoint))
    }
}
