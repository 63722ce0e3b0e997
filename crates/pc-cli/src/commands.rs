//! The commands, a file each: `models`, `check`, `derive`, `run`, `emit`; sweeps have a room of their own.

pub mod check;
pub mod derive;
pub mod emit;
pub mod models;
pub mod run;
