//! Fewer equations by symmetry.
//!
//! In goes a system, out comes one of the coordinates that are left. `routhian` has Routh's reduction by cyclic coordinates;
//! that by a group is [`System::reduced`](pc_mech::System::reduced).

pub(crate) mod routhian;
