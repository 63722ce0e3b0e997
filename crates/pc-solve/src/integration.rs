//! Integration by any method: one engine for outputs, events, dense output and checkpoints.
//!
//! In go a [`VectorField`](pc_expr::VectorField), a start and a method; out come states, occurrences and
//! [`Statistics`](statistics::Statistics). Read `stepper` first, what a method has to offer, and `method`, how one begins;
//! then `integration`, what is made of it: `run` goes from event to event, `step` gives single steps and their polynomials,
//! `occur` does what happens at events, `saltation` what that does to derivatives; `observer` is told of it all. `limits`
//! say how far, `checks` whether at all; `trajectory` and `dense_output` hold motions. `fn_field` makes closures vector
//! fields, `breaks` ends steps where a field is not smooth.

pub(crate) mod breaks;
pub(crate) mod checks;
pub(crate) mod dense_output;
pub(crate) mod fn_field;
pub(crate) mod integration;
pub(crate) mod limits;
pub(crate) mod method;
pub(crate) mod observer;
pub(crate) mod occur;
pub(crate) mod run;
pub(crate) mod saltation;
pub(crate) mod statistics;
pub(crate) mod step;
pub(crate) mod stepper;
pub(crate) mod trajectory;
