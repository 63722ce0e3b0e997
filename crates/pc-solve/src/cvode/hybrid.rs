//! An integration that events interrupt.
//!
//! Read `hybrid` first, then `run`, from event to event, `step`, inside a step, and `occur`, what happens to the state;
//! `saltation` is what a reset does to derivatives, `checkpoint` where such a motion is taken up again.

pub(crate) mod checkpoint;
pub(crate) mod hybrid;
pub(crate) mod occur;
pub(crate) mod run;
pub(crate) mod saltation;
pub(crate) mod step;
