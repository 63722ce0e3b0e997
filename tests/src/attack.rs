//! Attacks on the program `pc` from outside: nothing that it is given may make it crash, hang, take more than it may, or
//! lose what it had finished.
//!
//! In goes the program, out come findings, each with how to repeat it. Read `victim` first (the program, run within limits, and
//! what it did), then the attacks: `giants` (models whose equations are larger than anything), `texts` (models changed by
//! chance), `limits` (large models within small limits), `places` (what is no file to write to), `overwrites` (results under the
//! names of what is read), `damage` (checkpoints changed by chance), `kills` (ends at any moment), `signals` (signals, limits on the
//! size of files and readers that go away, at any moment).

pub mod damage;
pub mod giants;
pub mod kills;
pub mod limits;
pub mod overwrites;
pub mod places;
pub mod signals;
pub mod texts;
pub mod victim;
