//! Inputs, with their tables, of a model that is built call by call.

use std::ffi::c_char;

use crate::api::builder::draft;
use crate::api::model::pc_model;
use crate::ffi::call_error::CallError;
use crate::ffi::error::pc_error;
use crate::ffi::pointer::{finite, numbers, text};
use crate::ffi::status::pc_status;
use crate::machinery::draft::{Draft, Section, number, numbers as list_of, quoted};

/// Adds an input: a value that is constant until it is set, in the same way as a parameter. Inputs
/// come after all parameters. Forces, rates of states, events, integrals and outputs may contain
/// it; velocities, momenta, constraints and positions of bodies may not.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_add_input(
    model: *mut pc_model,
    name: *const c_char,
    value: f64,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or text, as the preamble demands.
        let name = unsafe { text(name, "name") }?;
        draft.add(Section::Inputs, &[name], number(finite(value, "value")?));
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_add_input", write) }
}

/// Adds an input that is a function of time: `length` values at increasing times, interpolated
/// by "linear", "cubic" or "hold"; NULL for "linear". No step of a solver crosses one of the times.
/// The values of the input come from the table alone.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_add_input_table(
    model: *mut pc_model,
    name: *const c_char,
    times: *const f64,
    values: *const f64,
    length: usize,
    interpolation: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or text, null or `length` numbers, as the preamble demands.
        let (name, times, values) = unsafe {
            (
                text(name, "name")?,
                numbers(times, length, length, "times")?,
                numbers(values, length, length, "values")?,
            )
        };
        for &number in times.iter().chain(values) {
            finite(number, "an entry of the table")?;
        }
        // SAFETY: null or text, as the preamble demands.
        let interpolation = unsafe { choice(interpolation, "interpolation") }?;
        draft.add(Section::Inputs, &[name, "times"], list_of(times));
        draft.add(Section::Inputs, &[name, "values"], list_of(values));
        draft.add(Section::Inputs, &[name, "interpolation"], quoted(interpolation));
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_add_input_table", write) }
}

/// Adds an input that is a smooth function of time: `length` values with their rates, and perhaps
/// accelerations, at increasing times. Between these it is a polynomial of degree 3 that has the
/// values and rates at both ends, or of degree 5 with the accelerations too; NULL for accelerations
/// that are not given. Unlike other inputs it may appear in velocities, momenta, constraints and
/// positions of bodies. The inputs u' and u'' that follow it in the list of inputs are its rates.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_add_input_curve(
    model: *mut pc_model,
    name: *const c_char,
    times: *const f64,
    values: *const f64,
    rates: *const f64,
    accelerations: *const f64,
    length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or text, as the preamble demands.
        let name = unsafe { text(name, "name") }?;
        let mut put = |key: &'static str, list: *const f64| {
            // SAFETY: null or `length` numbers, as the preamble demands.
            let list = unsafe { numbers(list, length, length, key) }?;
            for &number in list {
                finite(number, "an entry of the table")?;
            }
            draft.add(Section::Inputs, &[name, key], list_of(list));
            Ok::<(), CallError>(())
        };
        put("times", times)?;
        put("values", values)?;
        put("rates", rates)?;
        if !accelerations.is_null() {
            put("accelerations", accelerations)?;
        }
        let interpolation = if accelerations.is_null() { "cubic" } else { "quintic" };
        draft.add(Section::Inputs, &[name, "interpolation"], quoted(interpolation));
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_add_input_curve", write) }
}

/// Adds an input whose table is a column of a file of comma-separated numbers, the first line of
/// which holds the names of the columns; otherwise this is like pc_model_add_input_table. `time` is
/// the name of the column of times, NULL for "t" or, if there is no such column, for the first one.
/// The path is relative to the working directory at the time of the call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_add_input_file(
    model: *mut pc_model,
    name: *const c_char,
    path: *const c_char,
    column: *const c_char,
    time: *const c_char,
    interpolation: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or text, as the preamble demands.
        let (name, path, column, time, interpolation) = unsafe {
            (
                text(name, "name")?,
                text(path, "path")?,
                text(column, "column")?,
                optional(time, "time")?,
                choice(interpolation, "interpolation")?,
            )
        };
        let columns = [("column", Some(column)), ("time", time)];
        write_file(draft, name, path, &columns, interpolation)
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_add_input_file", write) }
}

/// Adds an input as pc_model_add_input_curve does, from the columns of a file: of values, of rates,
/// of accelerations, NULL where these are not given, and of times, as in pc_model_add_input_file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_add_input_curve_file(
    model: *mut pc_model,
    name: *const c_char,
    path: *const c_char,
    column: *const c_char,
    rate: *const c_char,
    acceleration: *const c_char,
    time: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or text, as the preamble demands.
        let (name, path, columns) = unsafe {
            let columns = [
                ("column", Some(text(column, "column")?)),
                ("rate", Some(text(rate, "rate")?)),
                ("acceleration", optional(acceleration, "acceleration")?),
                ("time", optional(time, "time")?),
            ];
            (text(name, "name")?, text(path, "path")?, columns)
        };
        let interpolation = if acceleration.is_null() { "cubic" } else { "quintic" };
        write_file(draft, name, path, &columns, interpolation)
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_add_input_curve_file", write) }
}

/// The file of an input, by its path from the root: the text of a model has no place. With its
/// columns.
fn write_file(
    draft: &mut Draft,
    name: &str,
    path: &str,
    columns: &[(&'static str, Option<&str>)],
    interpolation: &str,
) -> Result<(), CallError> {
    let absolute =
        std::path::absolute(path).map_err(|source| CallError::Read { path: path.to_owned(), source })?;
    draft.add(Section::Inputs, &[name, "file"], quoted(&absolute.display().to_string()));
    for &(key, column) in columns {
        if let Some(column) = column {
            draft.add(Section::Inputs, &[name, key], quoted(column));
        }
    }
    draft.add(Section::Inputs, &[name, "interpolation"], quoted(interpolation));
    Ok(())
}

/// A text that may be left out.
///
/// # Safety
/// `word` is null or text.
unsafe fn optional<'a>(word: *const c_char, what: &'static str) -> Result<Option<&'a str>, CallError> {
    // SAFETY: as promised.
    if word.is_null() { Ok(None) } else { unsafe { text(word, what) }.map(Some) }
}

/// The word that says how a table is interpolated; "linear" where it is NULL.
///
/// # Safety
/// `word` is null or text.
unsafe fn choice<'a>(word: *const c_char, what: &'static str) -> Result<&'a str, CallError> {
    // SAFETY: as promised.
    if word.is_null() { Ok("linear") } else { unsafe { text(word, what) } }
}
