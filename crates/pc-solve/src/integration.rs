//! Integration with any method: one engine for outputs, events, dense output and checkpoints.
//!
//! A [`VectorField`](pc_expr::VectorField), a start and a method give states, occurrences and
//! [`Statistics`](statistics::Statistics). First read `stepper`, the interface of a method, and
//! `integration_method`, which starts a method; then `integration`, which is built on them: `front`
//! makes a step and searches it for events, `run` goes from event to event, `step` gives single
//! steps and their polynomials, `occur` applies events, `saltation` computes their effect on
//! derivatives, `held_sides` records which pieces of a field the motion is on, `sides` decides how
//! the motion continues at a surface between two pieces; an `observer` is told of outputs, steps
//! and events. `limits` bounds an integration, `pace` ends an integration that makes hardly any
//! progress, `checks` validates the input; `trajectory` and `dense_output` hold motions. `fn_field`
//! turns closures into vector fields, `breaks` ends steps where a field is not smooth, `since`
//! measures the time of a field from the start.

pub(crate) mod breaks;
pub(crate) mod checks;
pub(crate) mod dense_output;
pub(crate) mod fn_field;
pub(crate) mod front;
pub(crate) mod held_sides;
pub(crate) mod integration;
pub(crate) mod integration_method;
pub(crate) mod limits;
pub(crate) mod observer;
pub(crate) mod occur;
pub(crate) mod pace;
pub(crate) mod run;
pub(crate) mod saltation;
pub(crate) mod sides;
pub(crate) mod since;
pub(crate) mod statistics;
pub(crate) mod step;
pub(crate) mod stepper;
pub(crate) mod trajectory;
