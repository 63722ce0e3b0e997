//! The equations as printed text, and as C source.

use std::ffi::{c_char, c_int};

use ::pc_model::{Model, Variables};
use pc_mech::{EmitOptions, Language};
use pc_print::{Form, Layout, Page};

use crate::ffi::boundary::entry;
use crate::ffi::call_error::CallError;
use crate::ffi::error::pc_error;
use crate::ffi::pointer::{clear, handle, text, write};
use crate::ffi::status::pc_status;
use crate::ffi::strings::give;
use crate::machinery::system::{Inventory, pc_system};

/// The format in which equations are printed.
#[repr(C)]
pub enum pc_format {
    /// As they appear in a book, in UTF-8.
    PC_TEXT = 0,
    /// LaTeX displays that use amsmath.
    PC_LATEX = 1,
    /// One JSON object, for programs.
    PC_JSON = 2,
}

/// Derives and prints the equations, as `pc derive` does: constraints, kinematics, brackets,
/// equations, energy and reactions, or momenta and Hamiltonian, and the operations of one
/// right-hand side. Where constraints are imposed by multipliers, the text shows the equations in
/// independent velocities. `format` is a pc_format. Parameters have the values of the model. Free
/// the text with pc_string_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_print(
    system: *const pc_system,
    format: c_int,
    text: *mut *mut c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let print = || {
        // SAFETY: the pointers are as the preamble demands.
        unsafe { clear(text, "text") }?;
        let page = page(format)?;
        // SAFETY: as the preamble demands.
        let inventory = &unsafe { handle(system, "system") }?.inventory;
        let printed = inventory.derive(|model| printed(inventory, &model, page))?;
        // SAFETY: as the preamble demands.
        unsafe { write(text, give(&printed), "text") }
    };
    // SAFETY: `error` is null or memory for a pointer.
    unsafe { entry(error, print) }
}

/// The style of printing that a pc_format denotes.
pub(crate) fn page(format: c_int) -> Result<Page, CallError> {
    match format {
        0 => Ok(Page::Text),
        1 => Ok(Page::Latex),
        2 => Ok(Page::Json),
        value => Err(CallError::Choice { what: "pc_format", value: value.into() }),
    }
}

fn printed(inventory: &Inventory, model: &Model, page: Page) -> Result<String, CallError> {
    let form = Form::from(inventory.facts.variables);
    model.derived(|assembly| Ok(pc_print::page(form, page, &Layout::default(), model.title(), assembly)?))
}

/// Writes the equations as C source that does not depend on this library: the text of NAME.h
/// and of NAME.c, where NAME is `name`, turned into an identifier: Greek letters become their
/// names, runs of other characters one `_`, with none at the ends; `n_` precedes a leading digit,
/// `_` follows a keyword of C. The source has the right-hand side, its Jacobian, the mass matrix,
/// the energy, the integrals and the outputs in terms of independent quasi-velocities, or of
/// momenta if these are in the state of the system, and begins with a comment that explains its
/// use. External forces are parameters that come after the others; the name of each is `Q_`
/// followed by the name of its quasi-velocity, and they are zero until they are set. If `t_end` is
/// finite, the source can be compiled with -DNAME_MAIN (in capitals) into a program that integrates
/// from the start of the model to that time. Free both texts with pc_string_free.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_emit_c(
    system: *const pc_system,
    name: *const c_char,
    t_end: f64,
    header: *mut *mut c_char,
    source: *mut *mut c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let emit = || {
        // SAFETY: the pointers are as the preamble demands.
        unsafe { clear(header, "header").and(clear(source, "source")) }?;
        // SAFETY: as the preamble demands.
        let name = unsafe { text(name, "name") }?;
        // SAFETY: as the preamble demands.
        let inventory = &unsafe { handle(system, "system") }?.inventory;
        let [written_header, written_source] =
            inventory.derive(|model| emitted(inventory, &model, name, t_end))?;
        // SAFETY: as the preamble demands; neither is null, so that both texts are handed over.
        unsafe {
            write(header, give(&written_header), "header")?;
            write(source, give(&written_source), "source")
        }
    };
    // SAFETY: `error` is null or memory for a pointer.
    unsafe { entry(error, emit) }
}

fn emitted(inventory: &Inventory, model: &Model, name: &str, t_end: f64) -> Result<[String; 2], CallError> {
    let graph = model.graph();
    let assembly = model.assemble(&graph)?;
    // Sources are written in quasi-velocities.
    let variables = match inventory.facts.variables {
        Variables::Momenta => Variables::QuasiVelocities,
        Variables::ReducedMomenta => Variables::Reduced,
        other => other,
    };
    let (equations, form) = assembly.equations_of(variables)?;
    let mut options = EmitOptions::new(Language::C, name);
    if let Some(title) = &model.document().model.name {
        options = options.title(title.value.clone());
    }
    let has_tables = !equations.system().signals().is_empty();
    if has_tables {
        let remark = "The tables of inputs are not part of this source: their values at each time are arguments of its \
                      functions, like parameters.";
        options = options.remark(remark);
    }
    // With its inputs fixed at their start values, the motion would be a different one.
    if t_end.is_finite() && !has_tables {
        options = options.start(assembly.t_start, &assembly.start_in(&form)?, t_end);
    }
    let files = assembly.placed(equations.emit(&options))?;
    let mut texts = files.into_iter().map(|file| file.text);
    Ok([texts.next().unwrap_or_default(), texts.next().unwrap_or_default()])
}
