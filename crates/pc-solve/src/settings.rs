//! Settings that errors mention too: a `method`, a `tolerance`, the signs that an `inequality` keeps; and the `options` that
//! they are parts of.

pub(crate) mod inequality;
pub(crate) mod method;
pub(crate) mod options;
pub(crate) mod tolerance;
