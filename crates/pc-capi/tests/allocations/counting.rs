//! Counts what is allocated, by Rust and by C.

use std::cell::Cell;
use std::ffi::c_void;

thread_local! {
    static COUNT: Cell<usize> = const { Cell::new(0) };
}

fn count() {
    // A thread that is ending no longer counts.
    let _ = COUNT.try_with(|count| count.set(count.get() + 1));
}

unsafe extern "C" {
    fn __libc_malloc(size: usize) -> *mut c_void;
    fn __libc_calloc(number: usize, size: usize) -> *mut c_void;
    fn __libc_realloc(block: *mut c_void, size: usize) -> *mut c_void;
}

// These take the place of the functions of the C library that Rust and SUNDIALS call.

// SAFETY: the function of the C library by its other name.
#[unsafe(no_mangle)]
unsafe extern "C" fn malloc(size: usize) -> *mut c_void {
    count();
    // SAFETY: as promised to us.
    unsafe { __libc_malloc(size) }
}

// SAFETY: the function of the C library by its other name.
#[unsafe(no_mangle)]
unsafe extern "C" fn calloc(number: usize, size: usize) -> *mut c_void {
    count();
    // SAFETY: as promised to us.
    unsafe { __libc_calloc(number, size) }
}

// SAFETY: the function of the C library by its other name.
#[unsafe(no_mangle)]
unsafe extern "C" fn realloc(block: *mut c_void, size: usize) -> *mut c_void {
    count();
    // SAFETY: as promised to us.
    unsafe { __libc_realloc(block, size) }
}

/// How often this thread has allocated since it began.
pub(crate) fn allocations() -> usize {
    COUNT.get()
}
