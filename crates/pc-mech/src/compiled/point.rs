//! Where the functions of a motion are evaluated.

/// Time t, state y and parameters p: the arguments of every program of a motion.
///
/// For some programs y is the state followed by the unknowns.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Point<'a> {
    pub(crate) t: f64,
    pub(crate) y: &'a [f64],
    pub(crate) p: &'a [f64],
}
