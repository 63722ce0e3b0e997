//! Whole pages: `page`, in any format, and `displayed`, formula by formula.

pub(crate) mod displayed;
pub(crate) mod page;
