//! Settings, which errors refer to: `method`, `tolerance` and `inequality`, and the `options` that
//! contain them.

pub(crate) mod inequality;
pub(crate) mod method;
pub(crate) mod options;
pub(crate) mod tolerance;
