//! What is chosen by a name or by numbers, of which errors speak too: a `method`, a `tolerance`, the signs that an
//! `inequality` keeps.

pub(crate) mod inequality;
pub(crate) mod method;
pub(crate) mod tolerance;
