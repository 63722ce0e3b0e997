//! Recursive work on models.

/// Where less of the stack is left, work gets one of its own.
#[cfg(feature = "any-stack")]
const LEAST: usize = 2 << 20;

/// So much: functions nested as deep as they may be take a third of a mebibyte, several times that in a build without
/// optimisation.
#[cfg(feature = "any-stack")]
const STACK: usize = 8 << 20;

/// Does work on models that may recurse deeply, as reading and deriving do, on a stack of its own where the thread has
/// too little left.
///
/// With the feature `any-stack`, any thread with 128 KiB of stack may call it; without, it needs as much as the main
/// thread usually has.
pub fn deep<T>(work: impl FnOnce() -> T) -> T {
    #[cfg(feature = "any-stack")]
    return stacker::maybe_grow(LEAST, STACK, work);
    #[cfg(not(feature = "any-stack"))]
    return work();
}
