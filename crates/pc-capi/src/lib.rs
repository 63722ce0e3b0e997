//! libpc, the C interface to the Poincaré–Chetaev equations: one header, one library.
//!
//! A [`pc_model`] is a text, or is built call by call; a [`pc_system`] its equations, compiled; a [`pc_solver`]
//! their integration; a [`pc_kernel`] the right-hand side alone, for an integrator of one's own. The crate holds
//! no mathematics: each function hands over to `pc_model`, `pc_mech` or `pc_solve`. What C programmers read is
//! `include/pc.h`, generated from here, and what is true of every function stands at its head, the
//! [`preamble`](crate::version::PREAMBLE).
//!
//! From Rust the functions can be called as they are from C, which is how they are tested; the layers below are nicer.

#![expect(unsafe_code, reason = "a C interface")]
#![expect(non_camel_case_types, reason = "the names are those of C")]
#![expect(clippy::missing_safety_doc, reason = "one rule holds for all pointers: the preamble of the header")]

mod bodies;
mod bracket;
mod builder;
mod checkpoint;
mod dense;
mod direct;
mod draft;
mod engine;
mod ensemble;
mod entry;
mod error;
mod events;
mod field;
mod followed;
mod force;
mod held;
mod kernel;
mod legendre;
mod mechanics;
mod model;
mod observe;
mod occurrences;
mod options;
mod pointer;
mod rates;
mod sensitivity;
mod settings;
mod solver;
mod source;
mod statistics;
mod status;
mod strings;
mod system;
mod user;
mod verify;
pub mod version;

pub use bodies::*;
pub use bracket::*;
pub use builder::*;
pub use checkpoint::*;
pub use dense::*;
pub use ensemble::*;
pub use error::*;
pub use events::*;
pub use force::*;
pub use kernel::*;
pub use legendre::*;
pub use mechanics::*;
pub use model::*;
pub use observe::*;
pub use occurrences::*;
pub use options::*;
pub use rates::*;
pub use sensitivity::*;
pub use settings::*;
pub use solver::*;
pub use source::*;
pub use statistics::*;
pub use status::*;
pub use strings::*;
pub use system::*;
pub use user::*;
pub use verify::*;
pub use version::*;
