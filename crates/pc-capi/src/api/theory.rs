//! Printing an analysis of motions that is made without integrating them.

use std::ffi::{c_char, c_int};

use ::pc_model::Model;
use pc_print::TheoryOptions;

use crate::api::source::page;
use crate::ffi::boundary::entry;
use crate::ffi::call_error::CallError;
use crate::ffi::error::pc_error;
use crate::ffi::pointer::{clear, handle, texts, write};
use crate::ffi::status::pc_status;
use crate::ffi::strings::give;
use crate::machinery::system::pc_system;

/// The largest degree in the velocities of the integrals that are sought.
const MOST_DEGREE: usize = 6;

/// Prints an analysis of the motions that is made without integrating them, as `pc theory` does:
/// momenta and their brackets, Dirac's brackets, Casimirs, integrals and their brackets, cyclic
/// displacements, invariant measure, Chaplygin's multiplier, Hamilton-Jacobi's equation with the
/// motion by Jacobi's theorem, steady motions, Routh's reduction. Each claim is marked as proved,
/// disproved or open. The integrals sought are polynomials of a `degree` from 1 to 6 in the
/// velocities, whose coefficients are polynomials in the coordinates times 1 or one of the
/// `functions`, expressions of the model; the list may be empty. `format` is a pc_format.
/// Parameters have the values of the model. Everything is derived again, which takes longer than
/// pc_system_print. Free the text with pc_string_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_theory(
    system: *const pc_system,
    format: c_int,
    degree: usize,
    functions: *const *const c_char,
    function_count: usize,
    text: *mut *mut c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let print = || {
        // SAFETY: the pointers are as the preamble demands.
        unsafe { clear(text, "text") }?;
        let page = page(format)?;
        if !(1..=MOST_DEGREE).contains(&degree) {
            return Err(CallError::Choice { what: "degree", value: degree as i64 });
        }
        // SAFETY: as the preamble demands.
        let functions = unsafe { texts(functions, function_count, "functions") }?;
        let functions = functions.into_iter().map(str::to_owned).collect();
        let options = TheoryOptions { degree: degree as u32, functions, ..TheoryOptions::default() };
        // SAFETY: as the preamble demands.
        let inventory = &unsafe { handle(system, "system") }?.inventory;
        let printed = inventory.derive(|model| printed(&model, page, &options))?;
        // SAFETY: as the preamble demands.
        unsafe { write(text, give(&printed), "text") }
    };
    // SAFETY: `error` is null or memory for a pointer.
    unsafe { entry(error, print) }
}

/// Tests functions as canonical variables, as `pc theory --canonical` does, and prints the momenta
/// with the result: whether the brackets (X_i, Y_j) of the functions are c δ_ij with a constant c
/// and all others zero. The `count` functions, each with its name, are first the new coordinates
/// X_i, then as many new momenta Y_j: expressions of the model in coordinates, velocities and the
/// momenta p_x. `format` is a pc_format. Parameters have the values of the model. Everything is
/// derived again. Free the text with pc_string_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_canonical_variables(
    system: *const pc_system,
    format: c_int,
    names: *const *const c_char,
    functions: *const *const c_char,
    count: usize,
    text: *mut *mut c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let print = || {
        // SAFETY: the pointers are as the preamble demands.
        unsafe { clear(text, "text") }?;
        let page = page(format)?;
        // SAFETY: as the preamble demands.
        let (names, functions) =
            unsafe { (texts(names, count, "names")?, texts(functions, count, "functions")?) };
        let owned = |(name, function): (&str, &str)| (name.to_owned(), function.to_owned());
        let proposed: Vec<(String, String)> = names.into_iter().zip(functions).map(owned).collect();
        // SAFETY: as the preamble demands.
        let inventory = &unsafe { handle(system, "system") }?.inventory;
        let printed = inventory.derive(|model| tested(&model, page, &proposed))?;
        // SAFETY: as the preamble demands.
        unsafe { write(text, give(&printed), "text") }
    };
    // SAFETY: `error` is null or memory for a pointer.
    unsafe { entry(error, print) }
}

fn tested(model: &Model, page: pc_print::Page, proposed: &[(String, String)]) -> Result<String, CallError> {
    model.derived(|assembly| {
        Ok(pc_print::Theory::of_canonical_variables(model, assembly, proposed)?.printed(page))
    })
}

fn printed(model: &Model, page: pc_print::Page, options: &TheoryOptions) -> Result<String, CallError> {
    model.derived(|assembly| Ok(pc_print::Theory::of(model, assembly, options)?.printed(page)))
}
