//! Reduction by symmetry.
//!
//! `routhian` is Routh's reduction by cyclic coordinates; reduction by a group is
//! [`System::reduced`](pc_mech::System::reduced).

pub(crate) mod routhian;
