//! Events of a motion: zeros of functions g(t, y), and resets of the state at these zeros.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::forward;
use crate::ode::failure::Failure;
use crate::program::program::Program;

/// The direction in which a function passes through zero along the integration: backwards in time if
/// the integration goes backwards.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
pub enum Direction {
    /// From below.
    Rising,
    /// From above.
    Falling,
    /// Either way.
    #[default]
    Both,
}

impl Direction {
    /// Whether a function that leaves the side with this sign passes through zero in this direction.
    pub fn leaves(self, side: f64) -> bool {
        match self {
            Direction::Rising => side < 0.0,
            Direction::Falling => side > 0.0,
            Direction::Both => side != 0.0,
        }
    }
}

/// The properties of an event besides its function.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Event {
    name: String,
    direction: Direction,
    terminal: bool,
    resets: bool,
    settles: bool,
}

impl Event {
    /// An event that occurs in either direction and changes nothing.
    pub fn new(name: impl Into<String>) -> Event {
        let name = name.into();
        Event { name, direction: Direction::Both, terminal: false, resets: false, settles: false }
    }

    /// This event with the given direction.
    pub fn direction(self, direction: Direction) -> Event {
        Event { direction, ..self }
    }

    /// This event, restricted to zeros through which its function rises.
    pub fn rising(self) -> Event {
        self.direction(Direction::Rising)
    }

    /// This event, restricted to zeros through which its function falls.
    pub fn falling(self) -> Event {
        self.direction(Direction::Falling)
    }

    /// This event; `terminal` says whether the integration ends at it.
    pub fn terminal(self, terminal: bool) -> Event {
        Event { terminal, ..self }
    }

    /// This event; `resets` says whether [`Events::reset`] changes the state at it.
    pub fn resetting(self, resets: bool) -> Event {
        Event { resets, ..self }
    }

    /// This event; `settles` says whether the motion comes to rest where occurrences follow each other ever faster, so
    /// that this is no reason to end the integration.
    pub fn settling(self, settles: bool) -> Event {
        Event { settles, ..self }
    }

    /// The name of the event, for messages.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its direction.
    pub fn crosses(&self) -> Direction {
        self.direction
    }

    /// Whether the integration ends at the event.
    pub fn is_terminal(&self) -> bool {
        self.terminal
    }

    /// Whether the event resets the state.
    pub fn resets(&self) -> bool {
        self.resets
    }

    /// Whether the motion comes to rest where its occurrences follow each other ever faster.
    pub fn settles(&self) -> bool {
        self.settles
    }
}

/// Events of a motion: functions g(t, y), evaluated all at once, and resets y⁺ = R(t, y⁻).
///
/// An event occurs where its function passes through zero in its direction: where it changes sign, or reaches
/// zero and stays there. A function that touches zero, and returns to its side within the resolution of time,
/// causes no event. A function that is zero at the start, or after its own reset, has to leave zero first. A
/// function that the reset of another event carries through zero in its direction, or to zero where it stays,
/// makes its event occur at the same time; its own reset does not make an event occur again.
pub trait Events {
    /// The events, in the order in which simultaneous ones are handled.
    fn events(&self) -> &[Event];

    /// Writes g_i(t, y) to `values`, one for each event.
    ///
    /// # Errors
    /// [`Failure`] where one of the functions is not defined; the failure ends the integration.
    fn evaluate(&mut self, t: f64, y: &[f64], values: &mut [f64]) -> Result<(), Failure>;

    /// The program whose outputs are the first of the functions g, in terms of (t, y) and parameters, with
    /// the values of these parameters, if there is such a program. Methods that have the motion as a function
    /// of time find all roots of these functions.
    fn program(&self) -> Option<(&Arc<Program>, &[f64])> {
        None
    }

    /// Whether [`by_parameter`](Events::by_parameter) is implemented.
    fn has_parameter_derivatives(&self) -> bool {
        false
    }

    /// Returns ∂g/∂pⱼ of event number `event` for the parameter number `parameter` of the vector field, and
    /// writes ∂R/∂pⱼ of its reset, one number per component of the state: zeros where nothing is reset or
    /// where the reset does not depend on pⱼ.
    ///
    /// Called only if [they exist](Events::has_parameter_derivatives), for sensitivities.
    ///
    /// # Errors
    /// [`Failure`] where a derivative is not defined; the failure ends the integration.
    fn by_parameter(
        &mut self,
        _event: usize,
        _parameter: usize,
        _t: f64,
        _y: &[f64],
        _reset: &mut [f64],
    ) -> Result<f64, Failure> {
        Err(Failure::fatal(NoParameterDerivatives))
    }

    /// Whether [`gradient`](Events::gradient) and [`reset_along`](Events::reset_along) are implemented; if
    /// not, integrators take difference quotients.
    fn has_derivatives(&self) -> bool {
        false
    }

    /// Returns ∂g/∂t of event number `event`, and writes ∂g/∂y, one number per component.
    ///
    /// Called only if [they exist](Events::has_derivatives), for sensitivities.
    ///
    /// # Errors
    /// [`Failure`] where a derivative is not defined; the failure ends the integration.
    fn gradient(
        &mut self,
        _event: usize,
        _t: f64,
        _y: &[f64],
        _by_state: &mut [f64],
    ) -> Result<f64, Failure> {
        Err(Failure::fatal(NoDerivatives))
    }

    /// Writes τ ∂R/∂t + (∂R/∂y) v of the reset of event number `event` along (τ, v), one number per
    /// component.
    ///
    /// Called only if [they exist](Events::has_derivatives), for sensitivities.
    ///
    /// # Errors
    /// [`Failure`] where a derivative is not defined; the failure ends the integration.
    fn reset_along(
        &mut self,
        _event: usize,
        _t: f64,
        _y: &[f64],
        _along: (f64, &[f64]),
        _change: &mut [f64],
    ) -> Result<(), Failure> {
        Err(Failure::fatal(NoDerivatives))
    }

    /// Turns y⁻ into y⁺ at event number `event`; called only if that event [resets](Event::resets) the state.
    ///
    /// # Errors
    /// [`Failure`] where the new state is not defined; the failure ends the integration.
    fn reset(&mut self, _event: usize, _t: f64, _y: &mut [f64]) -> Result<(), Failure> {
        Ok(())
    }
}

impl<E: Events + ?Sized> Events for &mut E {
    forward! { (**self) =>
        fn events(&self) -> &[Event];
        fn evaluate(&mut self, t: f64, y: &[f64], values: &mut [f64]) -> Result<(), Failure>;
        fn program(&self) -> Option<(&Arc<Program>, &[f64])>;
        fn has_parameter_derivatives(&self) -> bool;
        fn by_parameter(&mut self, event: usize, parameter: usize, t: f64, y: &[f64], reset: &mut [f64]) -> Result<f64, Failure>;
        fn has_derivatives(&self) -> bool;
        fn gradient(&mut self, event: usize, t: f64, y: &[f64], by_state: &mut [f64]) -> Result<f64, Failure>;
        fn reset_along(&mut self, event: usize, t: f64, y: &[f64], along: (f64, &[f64]), change: &mut [f64]) -> Result<(), Failure>;
        fn reset(&mut self, event: usize, t: f64, y: &mut [f64]) -> Result<(), Failure>;
    }
}

#[derive(Debug, thiserror::Error)]
#[error("these events have no derivatives by parameters")]
struct NoParameterDerivatives;

#[derive(Debug, thiserror::Error)]
#[error("these events have no derivatives by time and state")]
struct NoDerivatives;
