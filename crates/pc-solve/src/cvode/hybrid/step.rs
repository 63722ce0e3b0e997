//! Single steps, and states inside them.

use crate::cvode::cvode::Ending;
use std::ops::ControlFlow;

use pc_expr::{Events, VectorField};

use crate::cvode::hybrid::hybrid::Hybrid;
use crate::error::{InputError, SolveError};
use crate::events::events::Occurrence;
use crate::integration::options::finite;

impl<F: VectorField, E: Events> Hybrid<F, E> {
    /// Takes one internal step in the direction of `towards`, or the part of it before the next event, and tells what
    /// occurs at its end, which may lie beyond `towards`, to `occurred`.
    ///
    /// If the integration stands inside such a step, goes to the end of that instead. It stands at y⁺ then.
    ///
    /// # Errors
    /// As for [`advance_to`](Hybrid::advance_to); [`InputError::EndIsStart`] if `towards` is where it stands.
    pub fn step(
        &mut self,
        towards: f64,
        mut occurred: impl FnMut(&Occurrence) -> ControlFlow<()>,
    ) -> Result<Ending, SolveError> {
        self.engine.check_ahead(towards)?;
        if towards == self.time() {
            return Err(InputError::EndIsStart { t: towards }.into());
        }
        if self.time() == self.front.t && self.due.is_empty() {
            self.go_on(towards)?;
        }
        self.engine.time = self.front.t;
        if self.due.is_empty() {
            return Ok(Ending::Completed);
        }
        Ok(self.occur(&mut occurred)?.unwrap_or(Ending::Completed))
    }

    /// The derivative of y of the given order at `t` in the last internal step, as
    /// [`Cvode::interpolate`](crate::Cvode::interpolate) gives it, up to where it is known what occurs.
    ///
    /// # Errors
    /// As there; [`InputError::NoStep`] also after a reset, which makes a new start, and [`InputError::OutsideStep`] also
    /// beyond the next event.
    pub fn interpolate(&mut self, t: f64, order: u32) -> Result<&[f64], SolveError> {
        finite("the time", t)?;
        if self.direction.is_none() || self.engine.restarted {
            return Err(InputError::NoStep.into());
        }
        self.engine.check_inside(t, order, self.front.t)?;
        let time = self.engine.time;
        let interpolated = self.engine.interpolate_to_work(t, order);
        self.engine.time = time;
        interpolated.map(|()| self.engine.work.as_slice())
    }

    /// The derivative of S of the given order at `t` in the last internal step, as
    /// [`Cvode::interpolate_sensitivities`](crate::Cvode::interpolate_sensitivities) gives it, up to where it is known what
    /// occurs.
    ///
    /// # Errors
    /// As there, and as for [`interpolate`](Hybrid::interpolate).
    pub fn interpolate_sensitivities(&mut self, t: f64, order: u32) -> Result<Vec<f64>, SolveError> {
        finite("the time", t)?;
        if self.direction.is_none() || self.engine.restarted {
            return Err(InputError::NoStep.into());
        }
        self.engine.check_inside(t, order, self.front.t)?;
        self.engine.sensitivities_by_time(t, order)?.ok_or_else(|| InputError::NoSensitivities.into())
    }
}
