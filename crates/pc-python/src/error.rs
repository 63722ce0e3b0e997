//! Errors, and the exceptions that they become.

use std::error::Error as _;

use pc_mech::{Failure, MechError};
use pc_model::{ModelError, UnknownIntegral, UnknownParameter, UnknownStart};
use pc_report::ReportError;
use pc_solve::{EnsembleError, InputError, SolveError};
use pc_verify::VerifyError;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyType;

/// What can go wrong below Python.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Error {
    #[error(transparent)]
    Model(#[from] ModelError),
    #[error(transparent)]
    Parameter(#[from] UnknownParameter),
    #[error(transparent)]
    Start(#[from] UnknownStart),
    #[error(transparent)]
    Integral(#[from] UnknownIntegral),
    #[error(transparent)]
    Mech(#[from] MechError),
    #[error(transparent)]
    Failure(#[from] Failure),
    #[error(transparent)]
    Verify(#[from] VerifyError),
    #[error(transparent)]
    Report(#[from] ReportError),
    #[error(transparent)]
    Solve(#[from] SolveError),
    #[error(transparent)]
    Input(#[from] InputError),
    #[error(transparent)]
    Ensemble(#[from] EnsembleError),
    #[error("{what} is `{given}`; choose one of {}", known.join(", "))]
    Choice { what: &'static str, given: String, known: Vec<&'static str> },
    #[error("{what} has {given} numbers instead of {expected}")]
    Length { what: &'static str, given: usize, expected: usize },
    #[error("{what} is {value}, which is not a finite number")]
    NotFinite { what: String, value: f64 },
    #[error("{what} cannot be had: {why}")]
    Unsupported { what: &'static str, why: &'static str },
    #[error("another thread is setting values of this system")]
    Busy,
    #[error("`{name}({first}, {second})` is no distribution")]
    Law { name: String, first: f64, second: f64 },
    #[error("this is an error of the program, which a report would help to mend: {message}")]
    Panic { message: String },
}

/// An error with its causes, in one line each.
pub(crate) fn chain(error: &dyn std::error::Error) -> String {
    let mut text = error.to_string();
    let mut source = error.source();
    while let Some(error) = source {
        let cause = error.to_string();
        if !text.ends_with(&cause) {
            text += &format!("; because: {cause}");
        }
        source = error.source();
    }
    text
}

/// A class of `chetaev._errors`.
fn class<'py>(py: Python<'py>, name: &'static str) -> PyResult<Bound<'py, PyType>> {
    static MODULE: PyOnceLock<Py<PyModule>> = PyOnceLock::new();
    let module = MODULE.get_or_try_init(py, || py.import("chetaev._errors").map(Bound::unbind))?;
    Ok(module.bind(py).getattr(name)?.cast_into::<PyType>()?)
}

fn raised(py: Python<'_>, name: &'static str, message: String) -> PyErr {
    match class(py, name).and_then(|class| class.call1((message,))) {
        Ok(exception) => PyErr::from_value(exception),
        Err(error) => error,
    }
}

/// With file, entry, line, column and help apart.
fn of_model(py: Python<'_>, error: &ModelError) -> PyErr {
    let (diagnostic, position) = (error.diagnostic(), error.position());
    let arguments = (
        error.to_string(),
        &diagnostic.message,
        &diagnostic.place.entry,
        position.line,
        position.column,
        diagnostic.help.as_deref(),
    );
    match class(py, "ModelError").and_then(|class| class.call1(arguments)) {
        Ok(exception) => PyErr::from_value(exception),
        Err(error) => error,
    }
}

impl From<Error> for PyErr {
    fn from(error: Error) -> PyErr {
        Python::attach(|py| match &error {
            Error::Model(error) | Error::Verify(VerifyError::Model(error)) => of_model(py, error),
            Error::Report(report) => match report.source().and_then(|error| error.downcast_ref()) {
                Some(error) => of_model(py, error),
                None => raised(py, "ChetaevError", chain(report)),
            },
            Error::Parameter(_) | Error::Start(_) | Error::Integral(_) => {
                raised(py, "UnknownNameError", error.to_string())
            }
            Error::Verify(VerifyError::Disagreement(_)) => raised(py, "DisagreementError", error.to_string()),
            Error::Mech(_) | Error::Failure(_) => raised(py, "EvaluationError", chain(&error)),
            Error::Solve(SolveError::Integration(_) | SolveError::Setup { .. }) => {
                raised(py, "IntegrationError", chain(&error))
            }
            Error::Verify(_) | Error::Unsupported { .. } | Error::Busy => {
                raised(py, "ChetaevError", chain(&error))
            }
            Error::Choice { .. }
            | Error::Length { .. }
            | Error::NotFinite { .. }
            | Error::Law { .. }
            | Error::Solve(SolveError::Input(_))
            | Error::Input(_) => PyValueError::new_err(chain(&error)),
            Error::Ensemble(_) | Error::Panic { .. } => PyRuntimeError::new_err(chain(&error)),
            Error::Solve(_) => raised(py, "IntegrationError", chain(&error)),
        })
    }
}
