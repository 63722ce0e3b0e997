//! Files of results, written whole or not at all.
//!
//! A `target` is examined before anything is computed; `atomic` writes there, by a `partial` file that replaces the old one
//! whole. `rescue` saves a result that cannot be written to its target, and `kept` says where it is. A `stream` takes rows
//! as they are computed; `error` lists the errors.

pub mod atomic;
pub mod error;
pub mod kept;
mod partial;
pub mod rescue;
pub mod stream;
pub mod target;
