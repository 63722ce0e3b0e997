//! Why an integration could not go on.

use std::fmt;

use pc_expr::Spent;

use crate::error::return_code::Code;

/// Why an integration could not go on.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Reason {
    /// CVODES returned an error.
    Cvode {
        /// The return code of CVODES.
        code: Code,
        /// Its message.
        message: String,
    },

    /// The limit on the number of steps from one output to the next was reached.
    Steps {
        /// The number of steps made.
        steps: u64,
        /// The time of the next output.
        t: f64,
        /// The length of the last step.
        last: f64,
    },

    /// Many steps together have covered almost none of the remaining time.
    Crawls {
        /// The number of these short steps.
        steps: u64,
        /// The time by which the short steps have advanced.
        by: f64,
        /// Why the steps are so short.
        cause: Shrinks,
    },

    /// The [deadline](crate::Options::deadline) passed.
    Ended(Spent),

    /// The backward integration of the adjoint equations could not go on; the time and the state
    /// reached are those of the motion at that point.
    Adjoint(Box<Reason>),

    /// The end term of a [functional](crate::Functional) failed.
    Functional,

    /// A terminal event ends the motion before the end of a [functional](crate::Functional).
    EndsEarly {
        /// The name of the event.
        event: String,
        /// When the event occurred.
        t: f64,
    },

    /// Within one interval, a tangent vector became a linear combination of the preceding ones, up
    /// to rounding error.
    Collapsed {
        /// The number of the vector.
        vector: usize,
    },

    /// A component became infinite or NaN in a step.
    Overflow {
        /// The name of the component.
        component: String,
        /// NaN or an infinity.
        value: f64,
        /// The end of the step in which this happened.
        t: f64,
    },

    /// The state could not be [projected](pc_expr::VectorField::project) onto the surface to which
    /// it belongs.
    Projection {
        /// The time of the state that could not be projected.
        t: f64,
    },

    /// The steps became so short that t + h rounds to t: the motion is singular there, or every
    /// further step fails.
    Stalled,

    /// The explicit dependence of the field on time varies faster than floating-point times can
    /// resolve, by more than the tolerances.
    Unresolved {
        /// The time at which this was detected.
        t: f64,
    },

    /// The vector field could not be evaluated, and no shorter step is possible.
    Rates {
        /// The time of the state at which the evaluation was tried.
        t: f64,
    },

    /// The motion reaches a corner or a jump of the field and neither crosses nor leaves it: it
    /// would slide along the corner or jump.
    Sliding {
        /// The expression that vanishes at the corner or jump.
        branch: String,
        /// When the corner or jump was reached.
        t: f64,
    },

    /// The motion reaches surfaces on which the field changes, and no continuation is consistent
    /// with the rates there.
    Undecided {
        /// The functions that vanish on these surfaces.
        surfaces: Vec<String>,
        /// When the surfaces were reached.
        t: f64,
    },

    /// The function of an event, or of another event evaluated with it, could not be evaluated.
    Event {
        /// The name of the event.
        event: String,
        /// The time of the state at which the evaluation was tried.
        t: f64,
    },

    /// The reset of an event failed.
    Reset {
        /// The name of the event.
        event: String,
        /// When the event occurred.
        t: f64,
    },

    /// An event that resets the state is reached at zero speed: sensitivities are unbounded.
    Grazing {
        /// The name of the event.
        event: String,
        /// When the event occurred.
        t: f64,
    },

    /// Events that reset the state occur together: sensitivities depend on their order.
    Together {
        /// The names of the events.
        events: Vec<String>,
        /// When the events occurred.
        t: f64,
    },

    /// Resets at one time set each other off without end.
    Cascade {
        /// The event that has occurred too often.
        event: String,
        /// How often that event has occurred at that time.
        occurrences: usize,
        /// When the resets occurred.
        t: f64,
    },

    /// The rates before or after a reset, which determine the jump of sensitivities, cannot be
    /// evaluated.
    Saltation {
        /// When the reset occurred.
        t: f64,
    },

    /// An event [accumulates](crate::Accumulation).
    Accumulation {
        /// The name of the event.
        event: String,
        /// How often the event has occurred.
        occurrences: u64,
        /// The limit of the times of occurrence, if their intervals continue as a geometric series.
        t: f64,
    },
}

/// What keeps the steps short.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum Shrinks {
    /// Rapid changes in the explicit dependence of the field on time.
    Time,
    /// The component with this name: its rate is the largest relative to the tolerances.
    Component(String),
}

impl fmt::Display for Shrinks {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Shrinks::Time => {
                f.write_str("the explicit dependence on time, which turns or jumps at ever new places")
            }
            Shrinks::Component(name) => write!(f, "{name}, whose rate is the largest by the tolerances"),
        }
    }
}

impl Reason {
    /// The same reason, with its times counted from `origin`.
    pub(crate) fn since(mut self, origin: f64) -> Reason {
        match &mut self {
            Reason::Adjoint(reason) => **reason = (**reason).clone().since(origin),
            Reason::Steps { t, .. }
            | Reason::EndsEarly { t, .. }
            | Reason::Overflow { t, .. }
            | Reason::Projection { t }
            | Reason::Unresolved { t }
            | Reason::Rates { t }
            | Reason::Sliding { t, .. }
            | Reason::Undecided { t, .. }
            | Reason::Event { t, .. }
            | Reason::Reset { t, .. }
            | Reason::Grazing { t, .. }
            | Reason::Together { t, .. }
            | Reason::Cascade { t, .. }
            | Reason::Saltation { t }
            | Reason::Accumulation { t, .. } => *t += origin,
            Reason::Cvode { .. }
            | Reason::Crawls { .. }
            | Reason::Ended(_)
            | Reason::Functional
            | Reason::Collapsed { .. }
            | Reason::Stalled => {}
        }
        self
    }

    /// The return code of CVODES that corresponds to the reason, if there is one.
    pub(super) fn code(&self) -> Option<Code> {
        match self {
            Reason::Cvode { code, .. } => Some(*code),
            Reason::Adjoint(reason) => reason.code(),
            // The name that CVODE has for it, for any method.
            Reason::Steps { .. } | Reason::Crawls { .. } => Some(Code::TooMuchWork),
            Reason::Ended(_)
            | Reason::Overflow { .. }
            | Reason::Projection { .. }
            | Reason::Functional
            | Reason::EndsEarly { .. }
            | Reason::Collapsed { .. }
            | Reason::Stalled
            | Reason::Unresolved { .. }
            | Reason::Rates { .. }
            | Reason::Sliding { .. }
            | Reason::Undecided { .. }
            | Reason::Event { .. }
            | Reason::Reset { .. }
            | Reason::Accumulation { .. }
            | Reason::Grazing { .. }
            | Reason::Together { .. }
            | Reason::Cascade { .. }
            | Reason::Saltation { .. } => None,
        }
    }

    /// Which limit was reached, if a limit is the reason.
    pub(super) fn ended(&self) -> Option<Spent> {
        match self {
            Reason::Ended(spent) => Some(*spent),
            Reason::Adjoint(reason) => reason.ended(),
            _ => None,
        }
    }

    /// Writes the message about an integration that reached `time`.
    pub(super) fn write(&self, time: f64, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Reason::Cvode { code, message } => write!(f, "{code} after reaching t = {time}: {message}"),
            Reason::Steps { steps, t, last } => write!(
                f,
                "{steps} steps were not enough to reach the output at t = {t}: the last, of length {last:.1e}, ended at t = {time}"
            ),
            Reason::Crawls { steps, by, cause } => write!(
                f,
                "the last {steps} steps up to t = {time} have together advanced by {by:.1e}: they are kept short by {cause}"
            ),
            Reason::Ended(spent) => write!(f, "{spent}, after reaching t = {time}"),
            Reason::Adjoint(reason) => {
                f.write_str("in the adjoint equations, integrated backwards from the end: ")?;
                reason.write(time, f)
            }
            Reason::EndsEarly { event, t } => write!(
                f,
                "the event {event} ends the motion at t = {t}: gradients are available only for motions that reach \
                 their given end time"
            ),
            Reason::Functional => write!(f, "the functional cannot be evaluated at the end, t = {time}"),
            Reason::Collapsed { vector } => write!(
                f,
                "tangent vector number {vector} (from 0) is a combination of those before it, up to rounding, at \
                 t = {time}: choose shorter intervals"
            ),
            Reason::Overflow { component, value, t } => {
                write!(f, "{component} is {value} at t = {t}, after reaching t = {time}")
            }
            Reason::Projection { t } => write!(
                f,
                "the state at t = {t} cannot be projected onto the surface where it must stay, after reaching t = {time}"
            ),
            Reason::Stalled => write!(f, "the steps have become too short to continue from t = {time}"),
            Reason::Unresolved { t } => write!(
                f,
                "near t = {t} the vector field changes with time faster than floating-point times can resolve: no step can follow it"
            ),
            Reason::Rates { t } => {
                write!(f, "the rates at t = {t} cannot be computed, after reaching t = {time}")
            }
            Reason::Sliding { branch, t } => write!(
                f,
                "the motion reaches a corner or a jump of the field, {branch}, at t = {t} and does not cross it: Taylor's \
                 method cannot follow it there; choose another method"
            ),
            Reason::Undecided { surfaces, t } => write!(
                f,
                "at t = {t} the motion reaches surfaces on which the rates change, where {} = 0: no combination of their \
                 sides leads on from there",
                surfaces.join(" = ")
            ),
            Reason::Event { event, t } => {
                write!(f, "the event {event} cannot be evaluated at t = {t}, after reaching t = {time}")
            }
            Reason::Reset { event, t } => write!(f, "the event {event} cannot reset the state at t = {t}"),
            Reason::Grazing { event, t } => write!(
                f,
                "the function of the event {event} touches zero at t = {t} without crossing it: the motion after it cannot be differentiated"
            ),
            Reason::Together { events, t } => write!(
                f,
                "the events {} occur together at t = {t}: the motion after them cannot be differentiated",
                events.join(", ")
            ),
            Reason::Cascade { event, occurrences, t } => write!(
                f,
                "the resets of events set each other off without end at t = {t}: the event {event} has occurred \
                 {occurrences} times there"
            ),
            Reason::Saltation { t } => {
                write!(
                    f,
                    "the rates before and after the reset at t = {t}, which sensitivities need, cannot be evaluated"
                )
            }
            Reason::Accumulation { event, occurrences, t } => write!(
                f,
                "the event {event} occurs at ever shorter intervals near t = {t:.5e} ({occurrences} times up to t = {time})"
            ),
        }
    }
}
