//! Files of results, which are written completely or not at all.
//!
//! What is written is kept `apart` from what is read. A `target` is examined before anything is computed; `atomic` writes there, using a `partial` file that replaces the old
//! one as a whole. `rescue` saves a result that cannot be written to its place, and `kept` says where it was saved; `so_far` is the place
//! of what there is of an interrupted one. A `stream` takes rows as they are computed; `error` lists the errors.

pub mod apart;
pub mod atomic;
pub mod error;
pub mod kept;
mod partial;
pub mod rescue;
pub(crate) mod so_far;
pub mod stream;
pub mod target;
