//! The version of the library, and the text that applies to all of it.

use std::ffi::c_char;

/// First number of the header's version.
pub const PC_VERSION_MAJOR: u32 = 0;
/// Second number of the header's version.
pub const PC_VERSION_MINOR: u32 = 1;
/// Third number of the header's version.
pub const PC_VERSION_PATCH: u32 = 0;
/// The header's version as one number, major × 10000 + minor × 100 + patch.
pub const PC_VERSION_NUMBER: u32 = 100;
/// Version of the binary interface, the number in the name libpc.so.N. A program runs with
/// any library of the same number that is not older than its header.
pub const PC_ABI_VERSION: u32 = 0;

/// The version of the library, such as "0.1.0". The text is static.
#[unsafe(no_mangle)]
pub extern "C" fn pc_version() -> *const c_char {
    const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), "\0");
    VERSION.as_ptr().cast()
}

/// The version of the library as one number, such as 100 for 0.1.0: what PC_VERSION_NUMBER is for
/// the header.
#[unsafe(no_mangle)]
pub extern "C" fn pc_version_number() -> u32 {
    PC_VERSION_NUMBER
}

/// The PC_ABI_VERSION of the library that is in use.
#[unsafe(no_mangle)]
pub extern "C" fn pc_abi_version() -> u32 {
    PC_ABI_VERSION
}

/// The comment at the top of the header, which says what is true of every function.
pub const PREAMBLE: &str = "\
/*
 * pc: the Poincaré–Chetaev equations of a mechanical system, derived, compiled and integrated.
 *
 *     pc_model *model = NULL;
 *     pc_system *top = NULL;
 *     pc_error *error = NULL;
 *     if (pc_model_builtin(\"heavy-top-lagrange\", &model, &error) == PC_OK &&
 *         pc_system_new(model, NULL, &top, &error) == PC_OK) {
 *         ... pc_system_rhs(top, t, y, n, ydot, n, &error) ...
 *     }
 *     if (error) fprintf(stderr, \"%s\\n\", pc_error_message(error));
 *     pc_error_free(error);
 *     pc_system_free(top);
 *     pc_model_free(model);
 *
 * State. y has n coordinates x, then quasi-velocities (or momenta, in the canonical form), then
 * first-order states; ydot is its rate.
 *
 * Errors. A function that can fail returns a pc_status; its last argument is a place for a
 * pc_error, or NULL. On success it writes NULL there, otherwise a new error, which you free; what
 * the place held before does not matter. PC_STOPPED and PC_EVENT are not failures: an observer, or
 * a terminal event, has ended an integration. Results are written unless the call fails; after a
 * failure a new handle or text is NULL, and arrays for results may hold anything.
 *
 * Ownership. What a function named ..._new, ..._clone, pc_model_parse, pc_model_from_file,
 * pc_model_builtin, pc_code_load, pc_system_of_code, pc_solver_restore, pc_solver_run_dense or
 * pc_system_linearization gives, you free with the ..._free of its type; `char *` you free with
 * pc_string_free, bytes with pc_bytes_free; `const char *` belongs to the handle it came from and
 * lives as long, or is static. All ..._free allow NULL.
 * Handles are independent: a model can be freed while its system lives, and a system while its
 * solvers and kernels do.
 *
 * Arrays. Each comes with its length, which must be exact, not merely large enough. They are
 * `double`, aligned as such, and an array that is written must not overlap another one; this is
 * checked. NULL goes with the length 0. Matrices are dense and column-major, A[i + j*rows],
 * unless the function says otherwise. Text is UTF-8 and zero-terminated.
 *
 * Threads. Nothing is global. A handle may go from thread to thread and is used by one call at a
 * time: a second one at the same time returns PC_BUSY and does nothing. Only pc_system_rhs may
 * run many times side by side, as it says. (Freeing a handle while another thread uses it is not
 * safe.) Different handles are independent; to evaluate on many threads, give each its own by
 * pc_system_of_code or pc_system_clone, or a pc_kernel, which is the one handle that does not
 * notice a second call. Any number of threads may read names and sizes, and use a pc_cancel, a
 * pc_code and a pc_dense, at any time. A `const`
 * handle says only that the call does not change what the handle computes.
 *
 * Signal handlers may call pc_cancel_request only. A fault of the library is PC_INTERNAL and does
 * not end your program; exhausted memory or an exhausted stack does. A thread needs a stack of
 * 128 KiB, whatever the model; deeper derivations run on a separate stack of 8 MiB.
 */";
