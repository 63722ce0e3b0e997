//! Attacks on the program `pc` from outside: nothing that it is given may make it crash, hang, take more than it may, or
//! lose what it had finished.
//!
//! In goes the program, out come findings, each with how to repeat it. Read `victim` first (the program, run within limits, and
//! what it did), then the attacks: `giants` (models whose equations are larger than anything), `texts` (models changed by
//! chance), `places` (what is no file to write to), `damage` (checkpoints changed by chance), `kills` (ends at any moment).

pub mod damage;
pub mod giants;
pub mod kills;
pub mod places;
pub mod texts;
pub mod victim;
