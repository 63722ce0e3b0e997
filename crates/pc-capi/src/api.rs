//! The functions of pc.h, with one file for each group.
//!
//! `ffi` checks the numbers and pointers of a call, the crates below compute the results, and
//! `machinery` holds what outlives a call. Models: `model`, `builder`, `inputs`, `bodies`, `joints`
//! (with `entry`), `action`, `settings`. Equations: `system`, `names`, `rates`, `mechanics`,
//! `kinematics`, `poses`, `slopes`, `linearization`, `kernel`, `legendre`, `bracket`, `source`, `theory`, `verify`. Motions: `options`, `cancel`,
//! `solver`, `monitor`, `observe`, `events`, `occurrences`, `force`, `dense`, `checkpoint`, `statistics`,
//! `ensemble`, `gradient`. The library: `version`.

pub(crate) mod action;
pub(crate) mod bodies;
pub(crate) mod bracket;
pub(crate) mod builder;
pub(crate) mod cancel;
pub(crate) mod checkpoint;
pub(crate) mod code;
pub(crate) mod dense;
pub(crate) mod ensemble;
pub(crate) mod entry;
pub(crate) mod events;
pub(crate) mod force;
pub(crate) mod gradient;
pub(crate) mod inputs;
pub(crate) mod joints;
pub(crate) mod kernel;
pub(crate) mod kinematics;
pub(crate) mod legendre;
pub(crate) mod linearization;
pub(crate) mod mechanics;
pub(crate) mod model;
pub(crate) mod monitor;
pub(crate) mod names;
pub(crate) mod observe;
pub(crate) mod occurrences;
pub(crate) mod options;
pub(crate) mod poses;
pub(crate) mod rates;
pub(crate) mod sensitivity;
pub(crate) mod settings;
pub(crate) mod slopes;
pub(crate) mod solver;
pub(crate) mod source;
pub(crate) mod statistics;
pub(crate) mod system;
pub(crate) mod theory;
pub(crate) mod velocities;
pub(crate) mod verify;
pub(crate) mod version;
