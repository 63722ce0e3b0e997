//! A model, and what is printed of it.

use std::collections::HashMap;

use pc_expr::{Cancel, Limits};
use pc_mech::{EmitOptions, Interpolation, KnownRates, Language, Table};
use pc_model::document::AbsoluteTolerance;
use pc_model::{Assembly, Builtin, Document, GivenInput, Model, Variables, deep};
use pc_print::{Extent, Form, Layout, Page, Theory, TheoryOptions, displayed_equations, page};
use pc_run::motion::verification::checked;
use pc_verify::{Outlet, VerifyError, vouch};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::Error;
use crate::plan::limit;
use crate::task::attended;

/// A model with the values of its parameters and start, and the settings of its derivation; it never changes.
#[pyclass(frozen, module = "chetaev._native")]
pub(crate) struct ModelCore {
    pub(crate) model: Model,
    /// Whether equations are compared with a second derivation before they are returned.
    pub(crate) verify: bool,
}

/// The changes to a model before it is derived.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Changes {
    inputs: Vec<(String, Course)>,
    parameters: Vec<(String, f64)>,
    start: Vec<(String, f64)>,
    project_start: bool,
    hold: Vec<String>,
    project: Vec<String>,
    velocities: Vec<(String, String)>,
    independent: Vec<String>,
    reactions: bool,
    limit_memory: Option<u64>,
    limit_time: Option<f64>,
    verify: bool,
}

/// What an input is set to: a number, or times, values and the interpolation between them.
#[derive(FromPyObject)]
pub(crate) enum Course {
    Constant(f64),
    Table(Vec<f64>, Vec<f64>, String),
    /// Times, values, rates, and accelerations where they are given.
    Curve(Vec<f64>, Vec<f64>, Vec<f64>, Option<Vec<f64>>),
}

impl Course {
    /// What the input with this name is set to.
    pub(crate) fn given(self, name: &str) -> Result<GivenInput, Error> {
        match self {
            Course::Constant(value) => Ok(GivenInput::Constant(finite(name, value)?)),
            Course::Table(times, values, interpolation) => {
                let interpolation = match interpolation.as_str() {
                    "linear" => Interpolation::Linear,
                    "cubic" => Interpolation::Cubic,
                    "hold" => Interpolation::Hold,
                    _ => {
                        let known = vec!["linear", "cubic", "hold"];
                        return Err(Error::Choice { what: "the interpolation", given: interpolation, known });
                    }
                };
                let table = Table::new(times, values, interpolation);
                let table = table.map_err(|error| Error::Table { name: name.to_owned(), error })?;
                Ok(GivenInput::Table(table))
            }
            Course::Curve(times, values, rates, accelerations) => {
                let quintic = accelerations.is_some();
                let interpolation = if quintic { Interpolation::Quintic } else { Interpolation::Cubic };
                let known = KnownRates { rates: Some(rates), accelerations };
                let table = Table::with_rates(times, values, &known, interpolation);
                let table = table.map_err(|error| Error::Table { name: name.to_owned(), error })?;
                Ok(GivenInput::Table(table))
            }
        }
    }
}

/// The form with this name.
pub(crate) fn form(name: &str) -> Result<Form, Error> {
    Form::named(name).ok_or_else(|| Error::Choice {
        what: "the form",
        given: name.to_owned(),
        known: Form::ALL.map(Form::name).to_vec(),
    })
}

/// The variables of a form whose equations can be evaluated.
pub(crate) fn variables(name: &str) -> Result<Variables, Error> {
    form(name)?.variables().ok_or(Error::Unsupported {
        what: "a system in this form",
        why: "its equations are for print; use poincare, canonical, reduced, lie-poisson, orthonormal, voronets or hamel",
    })
}

/// A tolerance as the user gives it: a number, or a mapping of names.
#[derive(IntoPyObject)]
enum GivenTolerance {
    All(f64),
    Each(HashMap<String, f64>),
}

fn absolute(given: AbsoluteTolerance) -> GivenTolerance {
    match given.all {
        Some(all) => GivenTolerance::All(all),
        None => GivenTolerance::Each(given.each.into_iter().collect()),
    }
}

/// Compares equations with a second derivation before they are returned. It is not an error if there can be no second derivation:
/// `check` says why.
///
/// # Errors
/// [`Error::Verify`] if the derivations disagree.
pub(crate) fn vouched(model: &Model, assembly: &Assembly<'_>, outlet: Outlet) -> Result<(), Error> {
    match vouch(model, assembly, outlet) {
        Err(error @ VerifyError::Disagreement(_)) => Err(error.into()),
        _ => Ok(()),
    }
}

/// The limits of a model for work that begins now, and the handle that ends it.
pub(crate) fn renewed(model: &mut Model) -> Cancel {
    let cancel = Cancel::default();
    model.limit(Limits { cancel: cancel.clone(), ..model.budget().limits().clone() });
    cancel
}

impl ModelCore {
    /// Does work on the model that may take a long time.
    fn attend<T: Send + 'static>(
        &self,
        py: Python<'_>,
        work: impl FnOnce(&Model) -> Result<T, Error> + Send + 'static,
    ) -> PyResult<T> {
        let mut model = self.model.clone();
        let cancel = renewed(&mut model);
        attended(py, &cancel, |_| Ok(()), move || deep(|| work(&model)))
    }

    /// Does work on the assembled model, and compares what leaves it through `outlet`; without one, the work itself
    /// makes the comparison.
    fn assembled<T: Send + 'static>(
        &self,
        py: Python<'_>,
        outlet: Option<Outlet>,
        work: impl FnOnce(&Model, &Assembly<'_>) -> Result<T, Error> + Send + 'static,
    ) -> PyResult<T> {
        let outlet = outlet.filter(|_| self.verify);
        self.attend(py, move |model| {
            let graph = model.graph();
            let assembly = model.assemble(&graph)?;
            let result = work(model, &assembly)?;
            assembly.within_limits()?;
            if let Some(outlet) = outlet {
                vouched(model, &assembly, outlet)?;
                assembly.within_limits()?;
            }
            Ok(result)
        })
    }
}

#[pymethods]
impl ModelCore {
    #[new]
    fn new(name: String, text: &[u8]) -> Result<ModelCore, Error> {
        Ok(ModelCore { model: Model::new(Document::from_bytes(&name, text)?), verify: true })
    }

    /// The model with this name that comes with the package; `None` if there is none.
    #[staticmethod]
    fn builtin(name: &str) -> Result<Option<ModelCore>, Error> {
        let Some(builtin) = Builtin::named(name) else { return Ok(None) };
        Ok(Some(ModelCore { model: Model::new(builtin.document()?), verify: true }))
    }

    /// The same model with other values and settings.
    fn changed(&self, changes: Changes) -> Result<ModelCore, Error> {
        let mut model = self.model.clone();
        let limits = Limits::default();
        model.limit(Limits {
            memory: changes.limit_memory.unwrap_or(limits.memory),
            time: limit(changes.limit_time)?,
            ..limits
        });
        for (name, course) in changes.inputs {
            model.give_input(&name, course.given(&name)?)?;
        }
        for (name, value) in &changes.parameters {
            model.set(name, finite(name, *value)?)?;
        }
        for (name, value) in &changes.start {
            model.set_start(name, finite(name, *value)?)?;
        }
        model.project_start(changes.project_start);
        for name in &changes.hold {
            model.hold_start(name)?;
        }
        for name in &changes.project {
            model.keep(name)?;
        }
        if !changes.velocities.is_empty() {
            model.give_no_quasi_velocities();
        }
        for (name, definition) in &changes.velocities {
            model.give_quasi_velocity(name, definition)?;
        }
        if !changes.independent.is_empty() {
            model.choose_independent(changes.independent);
        }
        model.observe_reactions(changes.reactions);
        Ok(ModelCore { model, verify: changes.verify })
    }

    #[getter]
    fn name(&self) -> &str {
        self.model.document().source.name()
    }

    #[getter]
    fn text(&self) -> &str {
        self.model.document().source.text()
    }

    #[getter]
    fn title(&self) -> &str {
        self.model.title()
    }

    /// Names and values of the parameters, then of the inputs.
    fn parameters(&self) -> Vec<(String, f64)> {
        self.model.parameters().map(|(name, value)| (name.to_owned(), value)).collect()
    }

    /// Names of the parameters and inputs that are numbers alone: they depend neither on others nor on a table, and no others depend
    /// on them.
    fn numbers(&self) -> Vec<&str> {
        let values = self.model.parameter_values();
        let is_alone = |place: usize, value: f64| {
            let mut moved = values.clone();
            moved.set(place, value + value.abs().max(1.0));
            let others = moved.values().iter().zip(values.values()).enumerate();
            others.into_iter().all(|(i, (moved, held))| i == place || moved == held)
        };
        let names = self.model.parameters().enumerate();
        let names = names.filter(|&(place, (_, value))| {
            !values.follows(place) && !values.is_table(place) && is_alone(place, value)
        });
        names.map(|(_, (name, _))| name).collect()
    }

    /// Names of the inputs.
    fn inputs(&self) -> Vec<&str> {
        self.model.document().inputs.iter().map(|input| input.name.text.as_str()).collect()
    }

    /// Names of the constraints.
    fn constraints(&self) -> Vec<&str> {
        self.model.document().constraints.iter().map(|constraint| constraint.name.text.as_str()).collect()
    }

    /// Names and values of the start.
    fn start(&self) -> Result<Vec<(String, f64)>, Error> {
        Ok(self.model.start_names().into_iter().zip(self.model.start()?).collect())
    }

    /// The settings of a run in the text.
    fn simulation<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let simulation = &self.model.document().simulation;
        let number = |located: &Option<_>| {
            located.as_ref().map(|located: &pc_model::document::Located<f64>| located.value)
        };
        let settings = PyDict::new(py);
        settings.set_item("t_start", number(&simulation.t_start))?;
        settings.set_item("t_end", number(&simulation.t_end))?;
        settings.set_item("samples", simulation.samples.as_ref().map(|samples| samples.value))?;
        settings.set_item("rtol", number(&simulation.rtol))?;
        settings.set_item("atol", simulation.atol.as_ref().map(|atol| atol.value.clone()).map(absolute))?;
        settings.set_item("max_step", number(&simulation.max_step))?;
        settings.set_item("accumulation", number(&simulation.accumulation))?;
        settings.set_item("samples_per_step", simulation.samples_per_step.as_ref().map(|n| n.value))?;
        settings.set_item("method", simulation.method.as_ref().map(|method| method.value.name()))?;
        settings.set_item("form", simulation.form.as_ref().map(|form| form.value.name()))?;
        Ok(settings)
    }

    /// The properties of the model before it is run: as text, and as JSON.
    fn check(&self, py: Python<'_>) -> PyResult<(String, String)> {
        self.assembled(py, None, |model, assembly| {
            let equations = assembly.equations()?;
            let check = checked(model, assembly, &equations)?;
            Ok((check.text(), check.json().to_string()))
        })
    }

    /// The equations as text, LaTeX or JSON.
    fn printed(
        &self,
        py: Python<'_>,
        form: &str,
        language: &str,
        width: usize,
        inline: bool,
    ) -> PyResult<String> {
        let (form, language) = (self::form(form)?, self::language(language)?);
        let layout = Layout { width, inline, ..Layout::default() };
        self.assembled(py, Some(Outlet::Page(form)), move |model, assembly| {
            Ok(page(form, language, &layout, model.title(), assembly)?)
        })
    }

    /// The name of the form; headings, each with a `math` element or plain text and with notes.
    #[expect(clippy::type_complexity, reason = "a tuple for Python")]
    fn displayed(
        &self,
        py: Python<'_>,
        form: &str,
        inline: bool,
    ) -> PyResult<(String, Option<String>, Vec<(String, Option<String>, Vec<String>)>)> {
        let form = self::form(form)?;
        let layout = Layout { inline, ..Layout::default() };
        self.assembled(py, Some(Outlet::Page(form)), move |model, assembly| {
            let shown = displayed_equations(form, &layout, model.title(), assembly)?;
            let parts = shown.parts.into_iter();
            let parts = parts
                .map(|part| (part.title.to_owned(), part.display.map(|display| display.mathml), part.notes));
            Ok((shown.name, shown.plain.map(|(text, _)| text), parts.collect()))
        })
    }

    /// Brackets, integrals, steady motions: as text, LaTeX or JSON.
    fn theory(
        &self,
        py: Python<'_>,
        language: &str,
        degree: u32,
        functions: Vec<String>,
        canonical: Vec<(String, String)>,
    ) -> PyResult<String> {
        let language = self::language(language)?;
        let options = TheoryOptions { degree, functions, canonical, extent: Extent::Full };
        self.assembled(py, Some(Outlet::Equations(Variables::QuasiVelocities)), move |model, assembly| {
            Ok(Theory::of(model, assembly, &options)?.printed(language))
        })
    }

    /// The source of the equations: names of files with their texts.
    fn source(
        &self,
        py: Python<'_>,
        form: &str,
        language: &str,
        name: String,
        jacobian: bool,
    ) -> PyResult<Vec<(String, String)>> {
        let variables = variables(form)?;
        let language = match language {
            "c" => Language::C,
            "rust" => Language::Rust,
            other => {
                let known = vec!["c", "rust"];
                return Err(Error::Choice { what: "the language", given: other.to_owned(), known }.into());
            }
        };
        if variables.has_momenta() {
            let why = "it is written of equations in velocities; use the form poincare";
            return Err(Error::Unsupported { what: "the source", why }.into());
        }
        self.assembled(py, Some(Outlet::Source(variables)), move |model, assembly| {
            let (equations, form) = assembly.equations_of(variables)?;
            let mut options = EmitOptions::new(language, &name).title(model.title()).jacobian(jacobian);
            // A motion with the inputs of the start would be another.
            let steady = equations.system().signals().is_empty();
            if let Some(t_end) = model.document().simulation.t_end.as_ref().filter(|_| steady) {
                options = options.start(assembly.t_start, &assembly.start_in(&form)?, t_end.value);
            }
            let files = assembly.placed(equations.emit(&options))?;
            Ok(files.into_iter().map(|file| (file.name, file.text)).collect())
        })
    }
}

/// The names of the models that come with the package.
#[pyfunction]
pub(crate) fn builtin_names() -> Vec<&'static str> {
    Builtin::all().map(|builtin| builtin.name).collect()
}

fn language(name: &str) -> Result<Page, Error> {
    match name {
        "text" => Ok(Page::Text),
        "latex" => Ok(Page::Latex),
        "json" => Ok(Page::Json),
        other => {
            let known = vec!["text", "latex", "json"];
            Err(Error::Choice { what: "the language", given: other.to_owned(), known })
        }
    }
}

/// The number, if a model may have it.
pub(crate) fn finite(name: &str, value: f64) -> Result<f64, Error> {
    if value.is_finite() { Ok(value) } else { Err(Error::NotFinite { what: format!("`{name}`"), value }) }
}
