//! Models, given as a text or built call by call.

use std::ffi::{CString, c_char, c_int};
use std::path::Path;
use std::sync::OnceLock;

use ::pc_model::document::read_file_bounded;
use ::pc_model::import::{Directories, ImportOptions, model_of_robot};
use ::pc_model::{Builtin, Document, Model, Source};

use crate::ffi::boundary::entry;
use crate::ffi::call_error::CallError;
use crate::ffi::error::pc_error;
use crate::ffi::pointer::{bytes, clear, finite, free, handle, text, write};
use crate::ffi::status::pc_status;
use crate::ffi::strings::{c_string, give, nth};
use crate::machinery::draft::Draft;
use crate::machinery::exclusive::Exclusive;

/// A model: parameters, frame, energy, forces, constraints, start. Free it with pc_model_free.
pub struct pc_model {
    pub(crate) contents: Exclusive<Contents>,
}

#[derive(Clone)]
pub(crate) struct Contents {
    pub(crate) origin: Origin,
    kept: Vec<String>,
    /// Quasi-velocities on which external forces act.
    pub(crate) external: Vec<String>,
    /// Quasi-velocities in addition to those of the model, with their definitions.
    pub(crate) given: Vec<(String, String)>,
    /// Velocities chosen as independent.
    pub(crate) independent: Vec<String>,
    projects_start: bool,
    /// Variables that keep their start values when the start is projected.
    held: Vec<String>,
    pub(crate) observes_reactions: bool,
    differentiates: bool,
}

#[derive(Clone)]
pub(crate) enum Origin {
    Text(Box<Model>),
    Calls(Draft),
}

impl Contents {
    /// The model with its settings applied.
    pub(crate) fn model(&self) -> Result<Model, CallError> {
        let mut model = match &self.origin {
            Origin::Text(model) => Model::clone(model),
            Origin::Calls(draft) => Model::new(draft.document()?),
        };
        for name in &self.kept {
            model.keep(name)?;
        }
        for on in &self.external {
            model.external_force(on)?;
        }
        for (name, definition) in &self.given {
            model.give_quasi_velocity(name, definition)?;
        }
        if !self.independent.is_empty() {
            model.choose_independent(self.independent.iter());
        }
        model.project_start(self.projects_start);
        for name in &self.held {
            model.hold_start(name)?;
        }
        model.observe_reactions(self.observes_reactions);
        model.differentiate_by_parameters(self.differentiates);
        Ok(model)
    }
}

pub(crate) fn boxed(origin: Origin) -> *mut pc_model {
    let contents = Contents {
        origin,
        kept: Vec::new(),
        external: Vec::new(),
        given: Vec::new(),
        independent: Vec::new(),
        projects_start: false,
        held: Vec::new(),
        observes_reactions: false,
        differentiates: false,
    };
    Box::into_raw(Box::new(pc_model { contents: Exclusive::new(contents) }))
}

fn of_document(document: Document) -> *mut pc_model {
    boxed(Origin::Text(Box::new(Model::new(document))))
}

/// Reads a model from `length` bytes of text, which need no zero at the end. Messages call the
/// model `name`; NULL means "model".
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_parse(
    text: *const c_char,
    length: usize,
    name: *const c_char,
    model: *mut *mut pc_model,
    error: *mut *mut pc_error,
) -> pc_status {
    let read = || {
        // SAFETY: the pointers are as the preamble demands.
        unsafe { clear(model, "model") }?;
        // SAFETY: as the preamble demands.
        let text = unsafe { bytes(text, length, "text") }?;
        let name = if name.is_null() { c"model".as_ptr() } else { name };
        // SAFETY: as the preamble demands.
        let name = unsafe { crate::ffi::pointer::text(name, "name") }?;
        let document = Document::parse(Source::from_bytes(name, text))?;
        // SAFETY: as the preamble demands.
        unsafe { write(model, of_document(document), "model") }
    };
    // SAFETY: `error` is null or memory for a pointer.
    unsafe { entry(error, read) }
}

/// Reads a model from a file.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_from_file(
    path: *const c_char,
    model: *mut *mut pc_model,
    error: *mut *mut pc_error,
) -> pc_status {
    let read = || {
        // SAFETY: the pointers are as the preamble demands.
        unsafe { clear(model, "model") }?;
        // SAFETY: as the preamble demands.
        let path = unsafe { text(path, "path") }?;
        let bytes =
            read_file_bounded(path).map_err(|source| CallError::Read { path: path.to_owned(), source })?;
        let document = Document::parse(Source::from_bytes(path, &bytes))?;
        // SAFETY: as the preamble demands.
        unsafe { write(model, of_document(document), "model") }
    };
    // SAFETY: `error` is null or memory for a pointer.
    unsafe { entry(error, read) }
}

/// Reads a robot in URDF with macros expanded, in MJCF or in SDF, as a model of bodies on joints.
/// `floating`: whether the root link of a robot in URDF moves freely; otherwise it stands still.
/// `fix_massless`: whether joints that move no mass are fixed; otherwise they are refused. What a
/// model cannot express is left out, and said in comments at the head of the text, which
/// pc_model_text gives.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_from_robot(
    path: *const c_char,
    floating: c_int,
    fix_massless: c_int,
    model: *mut *mut pc_model,
    error: *mut *mut pc_error,
) -> pc_status {
    let read = || {
        // SAFETY: the pointers are as the preamble demands.
        unsafe { clear(model, "model") }?;
        // SAFETY: as the preamble demands.
        let path = unsafe { text(path, "path") }?;
        let bytes =
            read_file_bounded(path).map_err(|source| CallError::Read { path: path.to_owned(), source })?;
        let options = ImportOptions {
            floating: floating != 0,
            fix_massless: fix_massless != 0,
            directories: Some(Directories::of_files(Path::new(path), Path::new(path))),
            ..ImportOptions::default()
        };
        let (text, _) = model_of_robot(&Source::from_bytes(path, &bytes), options)?;
        let document = Document::parse(Source::new(path, &text))?;
        // SAFETY: as the preamble demands.
        unsafe { write(model, of_document(document), "model") }
    };
    // SAFETY: `error` is null or memory for a pointer.
    unsafe { entry(error, read) }
}

/// Reads a model that comes with the library, such as "heavy-top-lagrange".
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_builtin(
    name: *const c_char,
    model: *mut *mut pc_model,
    error: *mut *mut pc_error,
) -> pc_status {
    let read = || {
        // SAFETY: the pointers are as the preamble demands.
        unsafe { clear(model, "model") }?;
        // SAFETY: as the preamble demands.
        let name = unsafe { text(name, "name") }?;
        let builtin = Builtin::named(name).ok_or_else(|| CallError::NoSuchModel { name: name.to_owned() })?;
        // SAFETY: as the preamble demands.
        unsafe { write(model, of_document(builtin.document()?), "model") }
    };
    // SAFETY: `error` is null or memory for a pointer.
    unsafe { entry(error, read) }
}

/// The number of models that come with the library.
#[unsafe(no_mangle)]
pub extern "C" fn pc_builtin_count() -> usize {
    Builtin::all().count()
}

/// The name of a model that comes with the library, counted from 0; NULL beyond the last. Static.
#[unsafe(no_mangle)]
pub extern "C" fn pc_builtin_name(index: usize) -> *const c_char {
    static NAMES: OnceLock<Vec<CString>> = OnceLock::new();
    nth(NAMES.get_or_init(|| Builtin::all().map(|builtin| c_string(builtin.name)).collect()), index)
}

/// Copies a model; either can be changed independently.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_clone(
    model: *const pc_model,
    copy: *mut *mut pc_model,
    error: *mut *mut pc_error,
) -> pc_status {
    let clone = || {
        // SAFETY: the pointers are as the preamble demands.
        unsafe { clear(copy, "copy") }?;
        // SAFETY: as the preamble demands.
        let contents = unsafe { handle(model, "model") }?.contents.take()?.clone();
        let cloned = Box::into_raw(Box::new(pc_model { contents: Exclusive::new(contents) }));
        // SAFETY: as the preamble demands.
        unsafe { write(copy, cloned, "copy") }
    };
    // SAFETY: `error` is null or memory for a pointer.
    unsafe { entry(error, clone) }
}

/// Frees a model. NULL is allowed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_free(model: *mut pc_model) {
    // SAFETY: null or a live handle, as the preamble demands.
    if unsafe { model.as_ref() }.is_none_or(|model| model.contents.close()) {
        // SAFETY: null or a handle of ours that nobody uses any more.
        unsafe { free(model) };
    }
}

/// Calls `change` with the content of the model.
///
/// # Safety
/// `model` is null or a live handle, and `error` is null or points to memory for a pointer.
pub(crate) unsafe fn change(
    model: *mut pc_model,
    error: *mut *mut pc_error,
    change: impl FnOnce(&mut Contents) -> Result<(), CallError>,
) -> pc_status {
    // SAFETY: as promised.
    unsafe { entry(error, || change(&mut *handle(model, "model")?.contents.take()?)) }
}

/// Sets a parameter of the model to another value.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set(
    model: *mut pc_model,
    name: *const c_char,
    value: f64,
    error: *mut *mut pc_error,
) -> pc_status {
    let set = |contents: &mut Contents| {
        // SAFETY: null or text, as the preamble demands.
        let name = unsafe { text(name, "name") }?;
        let value = finite(value, "value")?;
        match &mut contents.origin {
            Origin::Text(model) => model.set(name, value)?,
            Origin::Calls(draft) => draft.set(name, value)?,
        }
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { change(model, error, set) }
}

/// Makes projection keep this integral, or "energy", at its value at the start: after each step of
/// a solver, and in pc_system_project. An unknown name is reported by pc_system_new.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_keep(
    model: *mut pc_model,
    integral: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let keep = |contents: &mut Contents| {
        // SAFETY: null or text, as the preamble demands.
        let name = unsafe { text(integral, "integral") }?;
        contents.kept.push(name.to_owned());
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { change(model, error, keep) }
}

/// Sets whether the start is moved onto the constraints (otherwise a start that violates them is
/// refused). Any value but 0 means yes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_project_start(
    model: *mut pc_model,
    yes: c_int,
    error: *mut *mut pc_error,
) -> pc_status {
    let project = |contents: &mut Contents| {
        contents.projects_start = yes != 0;
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { change(model, error, project) }
}

/// Holds the start value of this coordinate or quasi-velocity fixed while the others are moved to
/// satisfy the constraints. Without pc_model_project_start it has no effect. An unknown name is
/// reported by pc_system_new, with PC_NOT_FOUND.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_hold_start(
    model: *mut pc_model,
    name: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let hold = |contents: &mut Contents| {
        // SAFETY: null or text, as the preamble demands.
        let name = unsafe { text(name, "name") }?;
        contents.held.push(name.to_owned());
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { change(model, error, hold) }
}

/// Sets whether the reactions of the constraints are observed; the name of each is `λ_` followed by
/// that of its constraint. Any value but 0 means yes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_observe_reactions(
    model: *mut pc_model,
    yes: c_int,
    error: *mut *mut pc_error,
) -> pc_status {
    let observe = |contents: &mut Contents| {
        contents.observes_reactions = yes != 0;
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { change(model, error, observe) }
}

/// Sets whether systems of the model are derived with their derivatives with respect to parameters,
/// which pc_solver_add_sensitivity needs. Any value but 0 means yes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_differentiate(
    model: *mut pc_model,
    yes: c_int,
    error: *mut *mut pc_error,
) -> pc_status {
    let differentiate = |contents: &mut Contents| {
        contents.differentiates = yes != 0;
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { change(model, error, differentiate) }
}

/// Gives the text of the model, to be freed with pc_string_free. For a model built by calls it is
/// the text that the calls wrote; errors refer to its lines and columns. Settings that cannot be
/// expressed in the text format are omitted: parameters set by pc_model_set, a start set by
/// pc_model_set_start for a model that was read, and the settings of pc_model_keep,
/// pc_model_project_start, pc_model_hold_start, pc_model_observe_reactions, pc_model_differentiate,
/// pc_model_add_external_force, pc_model_give_quasi_velocity, pc_model_add_independent.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_text(
    model: *const pc_model,
    text: *mut *mut c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let write_text = || {
        // SAFETY: the pointers are as the preamble demands.
        unsafe { clear(text, "text") }?;
        // SAFETY: as the preamble demands.
        let model = unsafe { handle(model, "model") }?;
        let written = match &model.contents.take()?.origin {
            Origin::Text(model) => model.document().source.text().to_owned(),
            Origin::Calls(draft) => draft.text(),
        };
        // SAFETY: as the preamble demands.
        unsafe { write(text, give(&written), "text") }
    };
    // SAFETY: `error` is null or memory for a pointer.
    unsafe { entry(error, write_text) }
}
