//! libpc, the C interface to the Poincaré–Chetaev equations: one header, one library.
//!
//! A [`pc_model`] is read from a text or built call by call; a [`pc_system`] holds its equations,
//! compiled; a [`pc_solver`] integrates them; a [`pc_kernel`] is the right-hand side alone, for
//! another integrator. The crate contains no mathematics: each function calls `pc_model`, `pc_mech`
//! or `pc_solve`. C programmers read `include/pc.h`, generated from this crate; the comment at its
//! top, the [`preamble`](crate::api::version::PREAMBLE), says what is true of every function.
//!
//! The tests call the functions from Rust, as C does; Rust programs are better served by the crates
//! below.
//!
//! # Around it
//!
//! The layers below are [pc-model](../pc_model/index.html), [`pc_print`], [`pc_verify`] and
//! [`pc_solve`], which the functions call.

#![expect(unsafe_code, reason = "a C interface")]
#![expect(non_camel_case_types, reason = "the names are those of C")]
#![expect(clippy::missing_safety_doc, reason = "one rule holds for all pointers: the preamble of the header")]

mod api;
mod ffi;
mod machinery;

pub use api::action::*;
pub use api::bodies::*;
pub use api::bracket::*;
pub use api::builder::*;
pub use api::cancel::*;
pub use api::checkpoint::*;
pub use api::code::*;
pub use api::dense::*;
pub use api::ensemble::*;
pub use api::events::*;
pub use api::force::*;
pub use api::gradient::*;
pub use api::inputs::*;
pub use api::joints::*;
pub use api::kernel::*;
pub use api::kinematics::*;
pub use api::legendre::*;
pub use api::linearization::*;
pub use api::mechanics::*;
pub use api::model::*;
pub use api::monitor::*;
pub use api::names::*;
pub use api::observe::*;
pub use api::occurrences::*;
pub use api::options::*;
pub use api::poses::*;
pub use api::rates::*;
pub use api::sensitivity::*;
pub use api::settings::*;
pub use api::slopes::*;
pub use api::solver::*;
pub use api::source::*;
pub use api::statistics::*;
pub use api::system::*;
pub use api::theory::*;
pub use api::velocities::*;
pub use api::verify::*;
pub use api::version::*;
pub use ffi::error::*;
pub use ffi::status::*;
pub use ffi::strings::*;
pub use ffi::user_data::*;
pub use machinery::code::pc_code;
pub use machinery::system::pc_system;
