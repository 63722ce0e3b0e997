//! Errors, and the exceptions as which they are raised.

use std::error::Error as _;

use pc_fmu::FmuError;
use pc_mech::{Failure, MechError, TableError};
use pc_model::import::UrdfError;
use pc_model::{ModelError, SealError, UnknownInput, UnknownIntegral, UnknownParameter, UnknownStart};
use pc_report::ReportError;
use pc_run::files::error::FileError;
use pc_run::linear::error::LinearError;
use pc_run::sweep::error::SweepError;
use pc_run::{RunError, chain};
use pc_solve::{InputError, SolveError};
use pc_verify::VerifyError;
use pyo3::exceptions::{PyOSError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyType;

use crate::notation::in_python;

/// The errors that can occur below Python.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Error {
    #[error(transparent)]
    Model(#[from] ModelError),
    #[error(transparent)]
    Parameter(#[from] UnknownParameter),
    #[error(transparent)]
    InputName(#[from] UnknownInput),
    #[error("the input `{name}`: {error}")]
    Table { name: String, error: TableError },
    #[error(transparent)]
    Start(#[from] UnknownStart),
    #[error(transparent)]
    Integral(#[from] UnknownIntegral),
    #[error(transparent)]
    Saved(#[from] SealError),
    #[error(transparent)]
    Mech(#[from] MechError),
    #[error(transparent)]
    Failure(#[from] Failure),
    #[error(transparent)]
    Verify(#[from] VerifyError),
    #[error(transparent)]
    Report(#[from] ReportError),
    #[error(transparent)]
    Run(#[from] RunError),
    #[error(transparent)]
    File(#[from] FileError),
    #[error(transparent)]
    Urdf(#[from] UrdfError),
    #[error(transparent)]
    Fmu(FmuError),
    #[error(transparent)]
    Solve(#[from] SolveError),
    #[error(transparent)]
    Input(#[from] InputError),
    #[error(transparent)]
    Sweep(#[from] SweepError),
    #[error("{what} is `{given}`; choose one of {}", known.join(", "))]
    Choice { what: &'static str, given: String, known: Vec<&'static str> },
    #[error("{what} has {given} numbers instead of {expected}")]
    Length { what: &'static str, given: usize, expected: usize },
    #[error("{what} is {value}, which is not a finite number")]
    NotFinite { what: String, value: f64 },
    #[error("{what} cannot be had: {why}")]
    Unsupported { what: &'static str, why: &'static str },
    #[error("the state is off the constraints: the nearest one on them differs by {moved:e}")]
    OffConstraints { moved: f64 },
    #[error("limit_time is {seconds}; give seconds, 0 or more")]
    LimitTime { seconds: f64 },
    #[error("another thread is setting values of this system")]
    Busy,
    #[error("`{name}({first}, {second})` is not a valid distribution")]
    Law { name: String, first: f64, second: f64 },
    #[error("internal error; please report it: {message}")]
    Panic { message: String },
}

impl From<FmuError> for Error {
    fn from(error: FmuError) -> Error {
        match error {
            FmuError::Model(error) => Error::Model(error),
            other => Error::Fmu(other),
        }
    }
}

/// A class of `chetaev._language.errors`.
fn class<'py>(py: Python<'py>, name: &'static str) -> PyResult<Bound<'py, PyType>> {
    static MODULE: PyOnceLock<Py<PyModule>> = PyOnceLock::new();
    let module = MODULE.get_or_try_init(py, || py.import("chetaev._language.errors").map(Bound::unbind))?;
    Ok(module.bind(py).getattr(name)?.cast_into::<PyType>()?)
}

fn raised(py: Python<'_>, name: &'static str, message: &str) -> PyErr {
    match class(py, name).and_then(|class| class.call1((in_python(message),))) {
        Ok(exception) => PyErr::from_value(exception),
        Err(error) => error,
    }
}

fn invalid(message: &str) -> PyErr {
    PyValueError::new_err(in_python(message))
}

/// The exception for an error in a model, with entry, line, column and help as attributes.
fn of_model(py: Python<'_>, error: &ModelError) -> PyErr {
    let (diagnostic, position) = (error.diagnostic(), error.position());
    // The line of the text, which is quoted between them, stays as it is.
    let (mut text, help) = (error.to_string(), diagnostic.help.as_deref().map(in_python));
    if let (Some(written), Some(help)) = (&diagnostic.help, &help) {
        text = text.replace(written, help);
    }
    let arguments =
        (text, &diagnostic.message, &diagnostic.place.entry, position.line, position.column, help);
    match class(py, "ModelError").and_then(|class| class.call1(arguments)) {
        Ok(exception) => PyErr::from_value(exception),
        Err(error) => error,
    }
}

/// The exception for an error of a run; where the terms of the program differ from those of the package, the latter are
/// used.
fn of_run(py: Python<'_>, error: &RunError) -> PyErr {
    match error {
        RunError::Model(error) => of_model(py, error),
        RunError::Linear(error) => of_linear(py, error),
        RunError::Verify(error) => match &**error {
            VerifyError::Model(error) => of_model(py, error),
            VerifyError::Disagreement(_) => raised(py, "DisagreementError", &error.to_string()),
            _ => raised(py, "ChetaevError", &chain(error.as_ref())),
        },
        RunError::Tolerance(unknown) => raised(py, "UnknownNameError", &unknown.to_string()),
        RunError::Sensitivities(unknown) => raised(py, "UnknownNameError", &unknown.to_string()),
        RunError::NoEnd { .. } => invalid("the text says no end of time: give t_end"),
        RunError::EndIsStart { t } => invalid(&format!("the end t = {t} is the start")),
        RunError::Rows { rows, numbers, bytes, limit } => {
            let [bytes, limit] = [bytes, limit].map(|bytes| bytes.div_ceil(1 << 20));
            let message = format!(
                "{rows} rows of {numbers} numbers would take {bytes} MiB, more than the limit of {limit} MiB; ask for fewer, or give \
                 the system a larger `limit_memory`"
            );
            raised(py, "ChetaevError", &message)
        }
        RunError::Integration { .. } => raised(py, "IntegrationError", &chain(error)),
        other => raised(py, "ChetaevError", &chain(other)),
    }
}

fn of_linear(py: Python<'_>, error: &LinearError) -> PyErr {
    match error {
        LinearError::Varied(unknown) => raised(py, "UnknownNameError", &unknown.to_string()),
        LinearError::Component { .. } | LinearError::Free { .. } => {
            raised(py, "UnknownNameError", &error.to_string())
        }
        other => raised(py, "ChetaevError", &chain(other)),
    }
}

impl From<Error> for PyErr {
    fn from(error: Error) -> PyErr {
        Python::attach(|py| match &error {
            Error::Model(error) | Error::Verify(VerifyError::Model(error)) => of_model(py, error),
            Error::Report(report) => match report.source().and_then(|error| error.downcast_ref()) {
                Some(error) => of_model(py, error),
                None => raised(py, "ChetaevError", &chain(report)),
            },
            Error::Parameter(_) | Error::InputName(_) | Error::Start(_) | Error::Integral(_) => {
                raised(py, "UnknownNameError", &error.to_string())
            }
            Error::Verify(VerifyError::Disagreement(_)) => {
                raised(py, "DisagreementError", &error.to_string())
            }
            Error::Mech(_) | Error::Failure(_) => raised(py, "EvaluationError", &chain(&error)),
            Error::Solve(SolveError::Integration(_) | SolveError::Setup { .. }) => {
                raised(py, "IntegrationError", &chain(&error))
            }
            Error::Verify(_) | Error::Unsupported { .. } | Error::Busy | Error::Saved(_) => {
                raised(py, "ChetaevError", &chain(&error))
            }
            Error::Choice { .. }
            | Error::Table { .. }
            | Error::Length { .. }
            | Error::NotFinite { .. }
            | Error::Law { .. }
            | Error::OffConstraints { .. }
            | Error::LimitTime { .. }
            | Error::Solve(SolveError::Input(_))
            | Error::Input(_) => invalid(&chain(&error)),
            Error::Sweep(SweepError::UnknownValue(unknown)) => {
                raised(py, "UnknownNameError", &unknown.to_string())
            }
            Error::Run(error) => of_run(py, error),
            Error::File(error) => PyOSError::new_err(chain(error)),
            Error::Urdf(_) | Error::Fmu(_) => raised(py, "ChetaevError", &chain(&error)),
            Error::Sweep(SweepError::Ended { done, members, limit }) => {
                raised(py, "IntegrationError", &format!("ended after {done} of {members} members: {limit}"))
            }
            Error::Sweep(_) | Error::Panic { .. } => PyRuntimeError::new_err(in_python(&chain(&error))),
            Error::Solve(_) => raised(py, "IntegrationError", &chain(&error)),
        })
    }
}
