//! Integration by any method: one engine for outputs, events, dense output and checkpoints.
//!
//! In go a [`VectorField`](pc_expr::VectorField), a start and a method; out come states, occurrences and
//! [`Statistics`](statistics::Statistics). Read `solve` (integration in one call) first, then `stepper`, what a method has to
//! offer, and `integration`, what is made of it: `run` goes from event to event, `step` gives single steps and their
//! polynomials, `occur` does what happens at events, `resume` goes on from checkpoints; `observer` is told of it all.
//! `options` and `limits` say how; `trajectory`, `dense_output` and `motion_record` hold motions, `integrals` are taken along
//! them. `fn_field` makes closures vector fields, `inequality` keeps signs, `breaks` ends steps where a field is not smooth,
//! `projection` brings states of a multistep method back without a restart.

pub(crate) mod integration;
pub(crate) mod occur;
pub(crate) mod resume;
pub(crate) mod run;
pub(crate) mod step;

pub(crate) mod breaks;
pub(crate) mod dense_output;
pub(crate) mod fn_field;
pub(crate) mod inequality;
pub(crate) mod integrals;
pub(crate) mod limits;
pub(crate) mod motion_record;
pub(crate) mod observer;
pub(crate) mod options;
pub(crate) mod projection;
pub(crate) mod solve;
pub(crate) mod statistics;
pub(crate) mod stepper;
pub(crate) mod trajectory;
