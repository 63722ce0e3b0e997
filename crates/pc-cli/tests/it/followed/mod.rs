//! A motion followed by the program, and by the functions of the C library.

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::process::Command;
use std::{fs, ptr, slice};

use pc::*;
use serde_json::Value;

/// A motion, as far as it was followed.
pub(crate) struct Motion {
    /// Names of the columns, `t` first.
    pub(crate) columns: Vec<String>,
    pub(crate) rows: Vec<Vec<f64>>,
    /// Events with their times.
    pub(crate) events: Vec<(String, f64)>,
    /// How it ended, as the program calls it.
    pub(crate) ending: String,
    /// The end of the last step, or of a terminal event.
    pub(crate) reached: f64,
    /// Steps, evaluations, Jacobians, rejected steps.
    pub(crate) work: [u64; 4],
}

/// How a motion is integrated.
pub(crate) struct Settings {
    pub(crate) t_start: f64,
    pub(crate) t_end: f64,
    pub(crate) rtol: f64,
    /// That of all components, where they have the same.
    pub(crate) atol: Option<f64>,
    pub(crate) method: c_int,
}

/// Settings of a model in addition to its text.
#[derive(Clone, Copy, Default)]
pub(crate) struct Asked<'a> {
    pub(crate) canonical: bool,
    pub(crate) set: &'a [(&'a str, f64)],
    pub(crate) keep: &'a [&'a str],
    pub(crate) project_start: bool,
}

/// Number of rows.
const SAMPLES: usize = 13;

/// The motion of `pc run MODEL` with reactions and further arguments, and the settings that it
/// reports.
pub(crate) fn by_program(model: &str, asked: &Asked<'_>, further: &[&str]) -> (Motion, Settings) {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("run.json");
    let mut command = Command::new(env!("CARGO_BIN_EXE_pc"));
    command.args(["run", model, "--outputs", "reactions", "--rows", &SAMPLES.to_string(), "-o"]);
    command.arg(&path).args(further).args(["--form", if asked.canonical { "canonical" } else { "poincare" }]);
    command
        .args(asked.set.iter().flat_map(|(name, value)| ["--set".to_owned(), format!("{name}={value:e}")]));
    command.args(asked.keep.iter().flat_map(|name| ["--project", name]));
    command.args(asked.project_start.then_some("--project-start"));
    let output = command.output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(matches!(output.status.code(), Some(0 | 5)), "{model}: {said}");
    read(&fs::read_to_string(path).unwrap())
}

/// Reads the file of a run. The standard library parses its numbers exactly; `serde_json` may err
/// in the last bit.
fn read(text: &str) -> (Motion, Settings) {
    let file: Value = serde_json::from_str(text).unwrap();
    let number = |text: &str| text.parse().unwrap_or(f64::NAN);
    let row = |line: &str| line.trim_matches(['[', ']', ',']).split(',').map(number).collect();
    let times = text.split("\"time\":").skip(1);
    let times = times.map(|rest| number(rest.split('}').next().unwrap()));
    let events = file["events"].as_array().into_iter().flatten();
    let summary = &file["summary"];
    let real = |name: &str| {
        let (_, rest) = text.split_once(&format!("\"{name}\":")).unwrap();
        number(rest.split([',', '}']).next().unwrap())
    };
    let motion = Motion {
        columns: serde_json::from_value(file["columns"].clone()).unwrap(),
        rows: text.lines().filter(|line| line.starts_with('[')).map(row).collect(),
        events: events.map(|event| event["name"].as_str().unwrap().to_owned()).zip(times).collect(),
        ending: summary["ending"].as_str().unwrap().to_owned(),
        reached: real("t_reached"),
        work: ["steps", "evaluations", "jacobians", "rejected_steps"]
            .map(|name| summary[name].as_u64().unwrap()),
    };
    let settings = Settings {
        t_start: real("t_start"),
        t_end: real("t_end"),
        rtol: real("rtol"),
        atol: summary["atol"].as_f64(),
        method: match summary["method"].as_str().unwrap() {
            "auto" => pc_method::PC_AUTO as c_int,
            "bdf" => pc_method::PC_BDF as c_int,
            "adams" => pc_method::PC_ADAMS as c_int,
            other => panic!("{other}"),
        },
    };
    (motion, settings)
}

/// The result of a call, with status and message of an error.
fn call(function: impl FnOnce(*mut *mut pc_error) -> pc_status) -> Result<(), (pc_status, String)> {
    let mut error = ptr::null_mut();
    let status = function(&raw mut error);
    // SAFETY: null or an error, which is ours and is freed once.
    let message = unsafe {
        let message = text(pc_error_message(error.as_ref()));
        pc_error_free(error);
        message
    };
    if status == pc_status::PC_OK { Ok(()) } else { Err((status, message)) }
}

/// # Safety
/// A text with a zero at the end.
unsafe fn text(pointer: *const c_char) -> String {
    // SAFETY: as promised.
    unsafe { CStr::from_ptr(pointer).to_str().unwrap().to_owned() }
}

/// The names of the models that come with the library.
pub(crate) fn builtin_models() -> Vec<String> {
    // SAFETY: static texts.
    (0..pc_builtin_count()).map(|i| unsafe { text(pc_builtin_name(i)) }).collect()
}

/// A system, freed in the end.
struct System {
    handle: *mut pc_system,
    canonical: bool,
}

impl Drop for System {
    fn drop(&mut self) {
        // SAFETY: ours, freed once.
        unsafe { pc_system_free(self.handle) };
    }
}

impl System {
    /// The equations of a model that comes with the library, or of a file.
    fn new(name: &str, asked: &Asked<'_>) -> System {
        let c = |text: &str| CString::new(text).unwrap();
        let (mut model, mut handle) = (ptr::null_mut(), ptr::null_mut());
        let form = if asked.canonical { pc_form::PC_CANONICAL } else { pc_form::PC_POINCARE };
        let options = pc_system_options { form: form as c_int, ..Default::default() };
        // SAFETY: live objects, texts with a zero, places for handles; the model is freed once.
        unsafe {
            let open = if name.contains('/') { pc_model_from_file } else { pc_model_builtin };
            call(|error| open(c(name).as_ptr(), &raw mut model, error)).unwrap();
            for &(name, value) in asked.set {
                call(|error| pc_model_set(model, c(name).as_ptr(), value, error)).unwrap();
            }
            for name in asked.keep {
                call(|error| pc_model_keep(model, c(name).as_ptr(), error)).unwrap();
            }
            call(|error| pc_model_project_start(model, c_int::from(asked.project_start), error)).unwrap();
            call(|error| pc_model_observe_reactions(model, 1, error)).unwrap();
            call(|error| pc_system_new(model, &raw const options, &raw mut handle, error)).unwrap();
            pc_model_free(model);
        }
        System { handle, canonical: asked.canonical }
    }

    /// Names of the columns of a row.
    fn columns(&self) -> Vec<String> {
        // SAFETY: a live system; the names live as long.
        let names = unsafe {
            let state = (0..pc_system_dim(self.handle.as_ref()))
                .map(|i| text(pc_system_name(self.handle.as_ref(), i)));
            let observables = 0..pc_system_observable_count(self.handle.as_ref());
            state
                .chain(observables.map(|i| text(pc_system_observable_name(self.handle.as_ref(), i))))
                .collect::<Vec<_>>()
        };
        std::iter::once("t".to_owned()).chain(names).collect()
    }

    /// Time, state and observables, with quasi-velocities in place of momenta.
    fn row(&self, t: f64, y: &[f64]) -> Vec<f64> {
        let at = |function: At, length| {
            let mut values = vec![0.0; length];
            let (y, room, dim) = (y.as_ptr(), values.as_mut_ptr(), y.len());
            // SAFETY: a live system, a state and room as long as said.
            call(|error| unsafe { function(self.handle, t, y, dim, room, length, error) }).unwrap();
            values
        };
        // SAFETY: a live system.
        let observables = unsafe { pc_system_observable_count(self.handle.as_ref()) };
        let state = if self.canonical { at(pc_system_to_quasi_velocities, y.len()) } else { y.to_vec() };
        [&[t][..], &state, &at(pc_system_observe, observables)].concat()
    }
}

/// A function that writes numbers at a state.
type At = unsafe extern "C" fn(
    *const pc_system,
    f64,
    *const f64,
    usize,
    *mut f64,
    usize,
    *mut *mut pc_error,
) -> pc_status;

/// What the observers fill.
struct Record {
    system: System,
    rows: Vec<Vec<f64>>,
    events: Vec<(String, f64)>,
}

extern "C" fn see(t: f64, y: *const f64, length: usize, user: *mut c_void) -> c_int {
    // SAFETY: the record that `by_library` passes; a state as long as said.
    let (record, y) = unsafe { (&mut *user.cast::<Record>(), slice::from_raw_parts(y, length)) };
    record.rows.push(record.system.row(t, y));
    0
}

extern "C" fn note(
    event: usize,
    t: f64,
    _before: *const f64,
    _after: *const f64,
    _length: usize,
    user: *mut c_void,
) -> c_int {
    // SAFETY: the record that `by_library` passes; the name lives as long as its system.
    unsafe {
        let record = &mut *user.cast::<Record>();
        record.events.push((text(pc_system_event_name(record.system.handle.as_ref(), event)), t));
    }
    0
}

/// The same motion by pc_solver_run, and the number of observables, which are its last columns. As
/// in the program, the equations are not evaluated beyond the end.
pub(crate) fn by_library(model: &str, asked: &Asked<'_>, settings: &Settings) -> (Motion, usize) {
    let &Settings { t_start, t_end, rtol, atol, method } = settings;
    let last = SAMPLES - 1;
    let inner = (0..last).map(|i| t_start + (t_end - t_start) * (i as f64 / last as f64));
    let times: Vec<f64> = inner.chain([t_end]).collect();

    let mut record = Record { system: System::new(model, asked), rows: Vec::new(), events: Vec::new() };
    let (mut solver, mut work, mut time) = (ptr::null_mut(), pc_statistics::default(), f64::NAN);
    let (system, user): (_, *mut c_void) = (record.system.handle, (&raw mut record).cast());
    // SAFETY: a live system.
    let dim = unsafe { pc_system_dim(system.as_ref()) };
    let mut tolerances = vec![f64::NAN; dim];
    let data = tolerances.as_mut_ptr();
    // SAFETY: a live system, and room as said.
    call(|error| unsafe { pc_system_absolute_tolerances(system, rtol, t_end, data, dim, error) }).unwrap();
    // Those by the scales of components are found here once more.
    if let Some(all) = atol {
        tolerances.fill(all);
    }
    let options = pc_solver_options {
        method,
        relative_tolerance: rtol,
        absolute_tolerances: tolerances.as_ptr(),
        absolute_tolerances_length: dim,
        stop_time: t_end,
        ..Default::default()
    };
    // SAFETY: live handles, arrays as long as said, a record that outlives the solver, which is freed once.
    let outcome = unsafe {
        let new = |error| pc_solver_new(system, &options, 0.0, ptr::null(), 0, &raw mut solver, error);
        call(new).unwrap();
        call(|error| pc_solver_observe_events(solver, Some(note), user, error)).unwrap();
        let run = |error| pc_solver_run(solver, times.as_ptr(), times.len(), Some(see), user, error);
        let outcome = call(run);
        let size = size_of::<pc_statistics>();
        call(|error| pc_solver_statistics(solver, &raw mut work, size, error)).unwrap();
        call(|error| pc_solver_time(solver, &raw mut time, error)).unwrap();
        pc_solver_free(solver);
        outcome
    };
    let ending = match outcome {
        Ok(()) => "completed",
        Err((pc_status::PC_EVENT, _)) => "event",
        Err((pc_status::PC_INTEGRATION, _)) => "failed",
        Err(other) => panic!("{model}: {other:?}"),
    };
    // SAFETY: a live system.
    let observables = unsafe { pc_system_observable_count(record.system.handle.as_ref()) };
    let motion = Motion {
        columns: record.system.columns(),
        rows: record.rows,
        events: record.events,
        ending: ending.to_owned(),
        reached: if ending == "event" { time } else { work.step_time },
        work: [work.steps, work.rhs_evaluations, work.jacobian_evaluations, work.error_test_failures],
    };
    (motion, observables)
}
