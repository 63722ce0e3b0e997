//! Deep recursion on models.

/// If less than this is left of the stack, the work gets a stack of its own.
#[cfg(feature = "any-stack")]
const LEAST: usize = 2 << 20;

/// The size of that stack: functions nested to the greatest depth need a third of a mebibyte, and several
/// times as much without optimisation.
#[cfg(feature = "any-stack")]
const STACK: usize = 8 << 20;

/// Runs work on models that may recurse deeply, such as reading or deriving, on a separate stack if the
/// thread has too little stack left.
///
/// With the feature `any-stack`, any thread with 128 KiB of stack may call this function; without it, the
/// thread needs as much stack as the main thread usually has.
pub fn deep<T>(work: impl FnOnce() -> T) -> T {
    #[cfg(feature = "any-stack")]
    return stacker::maybe_grow(LEAST, STACK, work);
    #[cfg(not(feature = "any-stack"))]
    return work();
}
