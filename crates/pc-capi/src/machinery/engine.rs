//! An integration, with its events.

use std::ops::ControlFlow;

use pc_expr::{Event, Events};
use pc_solve::{
    Checkpoint, Chosen, DenseOutput, Ending, Options, Sensitivities, SolveError, Statistics, Stepper,
    VectorField,
};

use crate::ffi::call_error::CallError;
use crate::machinery::event_set::{Followed, Own};
use crate::machinery::motion_field::MotionField;
use crate::machinery::watch::{EventLog, Monitor, Watch};

/// The integration, with its events.
pub(crate) type Engine = Box<pc_solve::Integration<Chosen<MotionField>, Followed>>;

/// Begins at a checkpoint, which may be the start of a motion; `field` keeps its integrals at their
/// values there.
pub(crate) fn engine(
    mut field: MotionField,
    from: &Checkpoint,
    options: &Options,
    events: Followed,
    sensitivities: &Sensitivities,
) -> Result<Engine, SolveError> {
    // A state of another length is refused below.
    if from.state().len() == field.dim() {
        field.restart(from.time(), from.state());
    }
    let begun = pc_solve::Integration::begin(field, from, options, sensitivities)?;
    Ok(Box::new(begun.with_events_of(events, from)?))
}

/// The content of a solver.
pub(crate) struct Integration {
    engine: Engine,
    events: Followed,
    options: Options,
    sensitivities: Sensitivities,
    /// The work done before the last restart.
    earlier: Statistics,
    pub(crate) record: EventLog,
    pub(crate) monitor: Option<Monitor>,
}

impl Integration {
    pub(crate) fn new(
        field: MotionField,
        from: &Checkpoint,
        options: Options,
        events: Followed,
    ) -> Result<Integration, SolveError> {
        let sensitivities = Sensitivities::new();
        let engine = engine(field, from, &options, events.clone(), &sensitivities)?;
        let record = EventLog::of(events.events().len());
        let earlier = Statistics::default();
        Ok(Integration { engine, events, options, sensitivities, earlier, record, monitor: None })
    }

    /// Follows one more event; on an error nothing changes.
    pub(crate) fn add(&mut self, event: Event, own: Own) -> Result<(), CallError> {
        if self.statistics().steps > 0 {
            return Err(CallError::Begun { what: "an event" });
        }
        let events = self.events.with(event, own);
        self.begin(&Checkpoint::start(self.time(), self.state()), events)?;
        self.record.counts.push(0);
        self.record.last.push(None);
        Ok(())
    }

    /// Integrates one more column of sensitivities; on an error nothing changes.
    pub(crate) fn differentiate(&mut self, parameter: usize, start: &[f64]) -> Result<(), CallError> {
        if self.statistics().steps > 0 {
            return Err(CallError::Begun { what: "a sensitivity" });
        }
        let more = self.sensitivities.clone().by_parameter_from(parameter, start);
        let before = std::mem::replace(&mut self.sensitivities, more);
        let begun = self.begin(&Checkpoint::start(self.time(), self.state()), self.events.clone());
        begun.map_err(|error| {
            self.sensitivities = before;
            error.into()
        })
    }

    /// The sensitivities S at the current time, column-major, and the number of their columns.
    pub(crate) fn sensitivities(&mut self) -> Result<(Vec<f64>, usize), SolveError> {
        let matrix = self.engine.stepper().columns()?;
        Ok((matrix, self.sensitivities.len()))
    }

    /// Restarts from a checkpoint with these events.
    fn begin(&mut self, from: &Checkpoint, events: Followed) -> Result<(), SolveError> {
        let field = self.engine.field().clone();
        let engine = engine(field, from, &self.options, events.clone(), &self.sensitivities)?;
        self.earlier = self.statistics();
        (self.engine, self.events) = (engine, events);
        Ok(())
    }

    /// Begins anew at another time and state, like a new solver with the same options, events, observers and sensitivities.
    pub(crate) fn reset(&mut self, t: f64, y: &[f64]) -> Result<(), SolveError> {
        self.begin(&Checkpoint::start(t, y), self.events.clone())?;
        self.earlier = Statistics::default();
        let fresh = EventLog::of(self.record.counts.len());
        self.record = EventLog { observer: self.record.observer.take(), ..fresh };
        Ok(())
    }

    /// The reciprocals of the tolerances of the components at the end of the last step.
    pub(crate) fn error_weights(&self, weights: &mut [f64]) {
        let method = self.engine.stepper();
        for (i, (weight, &y)) in weights.iter_mut().zip(method.end_state()).enumerate() {
            *weight = 1.0 / method.tolerance(i, y);
        }
    }

    /// The estimated errors of the components in the last step; none if the method has no such estimate.
    pub(crate) fn local_errors(&mut self) -> Result<Option<&[f64]>, SolveError> {
        self.engine.local_errors()
    }

    /// A checkpoint of the motion, from which this integration restarts too.
    pub(crate) fn checkpoint(&mut self) -> Result<Checkpoint, CallError> {
        let checkpoint = self.stand("a checkpoint")?;
        self.begin(&checkpoint, self.events.clone())?;
        Ok(checkpoint)
    }

    /// Restarts at the current state with these values of the parameters.
    pub(crate) fn set_parameters(&mut self, values: &[f64]) -> Result<(), CallError> {
        let what = "a change of parameters";
        let stand = self.stand(what)?;
        if !self.sensitivities.is_empty() {
            return Err(CallError::Unsupported { what, why: "there are sensitivities by them" });
        }
        let (mut field, mut events) = (self.engine.field().clone(), self.events.clone());
        let (found, expected) = (values.len(), field.parameters().len());
        if found != expected {
            return Err(CallError::Length { what: "the parameters", found, expected });
        }
        field.parameters_mut().copy_from_slice(values);
        events.set_parameters(values);
        let engine = engine(field, &stand, &self.options, events.clone(), &self.sensitivities)?;
        self.earlier = self.statistics();
        (self.engine, self.events) = (engine, events);
        Ok(())
    }

    /// A number that distinguishes the equations from others.
    pub(crate) fn digest(&self) -> u64 {
        self.engine.field().digest()
    }

    fn stand(&self, what: &'static str) -> Result<Checkpoint, CallError> {
        if self.events.has_own() {
            return Err(CallError::Unsupported { what, why: "there are events of the program's own" });
        }
        Ok(self.engine.checkpoint())
    }

    /// Begins a call, for which the full time limit is available again.
    fn called(&mut self) {
        self.record.terminal = None;
        self.engine.renew_deadline();
    }

    pub(crate) fn advance(&mut self, t: f64) -> Result<Ending, SolveError> {
        self.called();
        let Integration { engine, record, monitor, .. } = self;
        engine.advance_observed(t, Watch { output: nothing, record, monitor: monitor.as_ref() })
    }

    pub(crate) fn step(&mut self, towards: f64) -> Result<Ending, SolveError> {
        self.called();
        let Integration { engine, record, monitor, .. } = self;
        engine.step_observed(towards, Watch { output: nothing, record, monitor: monitor.as_ref() })
    }

    pub(crate) fn run(
        &mut self,
        times: &[f64],
        output: impl FnMut(f64, &[f64]) -> ControlFlow<()>,
    ) -> Result<Ending, SolveError> {
        self.called();
        let Integration { engine, record, monitor, .. } = self;
        engine.run_observed(times, Watch { output, record, monitor: monitor.as_ref() })
    }

    pub(crate) fn run_dense(&mut self, end: f64) -> Result<(DenseOutput, Ending), SolveError> {
        self.called();
        let mut motion = DenseOutput::default();
        let keep = |segment| {
            motion.extend([segment]);
            ControlFlow::Continue(())
        };
        let Integration { engine, record, monitor, .. } = self;
        let watch = Watch { output: nothing, record, monitor: monitor.as_ref() };
        let ending = engine.run_dense_observed(end, keep, watch)?;
        Ok((motion, ending))
    }

    pub(crate) fn interpolate(&mut self, t: f64, order: u32) -> Result<&[f64], SolveError> {
        self.engine.interpolate(t, order)
    }

    /// The result of a call, given how the integration ended.
    pub(crate) fn ended(&mut self, ending: Ending) -> Result<(), CallError> {
        match ending {
            Ending::Completed => Ok(()),
            Ending::Stopped => Err(CallError::Stopped),
            Ending::Event { event } => {
                self.record.terminal = Some(event);
                Err(CallError::Terminal)
            }
        }
    }

    pub(crate) fn time(&self) -> f64 {
        self.engine.time()
    }

    pub(crate) fn state(&self) -> &[f64] {
        self.engine.state()
    }

    pub(crate) fn statistics(&self) -> Statistics {
        self.earlier.followed_by(&self.engine.statistics())
    }
}

/// Takes an output of which there is none.
fn nothing(_: f64, _: &[f64]) -> ControlFlow<()> {
    ControlFlow::Continue(())
}
