//! Settings that errors mention too: a `method`, a `tolerance`, the signs that an `inequality` keeps.

pub(crate) mod inequality;
pub(crate) mod method;
pub(crate) mod tolerance;
