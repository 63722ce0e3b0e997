//! Reduction by symmetry.
//!
//! `routhian` is Routh's reduction by cyclic coordinates; for reduction by a group see
//! [`System::reduced`](pc_mech::System::reduced).

pub(crate) mod routhian;
