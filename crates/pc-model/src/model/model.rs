//! A document with the values of its parameters, and the settings for deriving its equations.

use std::sync::Arc;

use pc_expr::{Budget, Graph, Limits};
use pc_mech::Table;
use serde::{Deserialize, Serialize};

use crate::assembly::parameters::Parameters;
use crate::diagnostics::error::ModelError;
use crate::diagnostics::meaning::MeaningError;
use crate::diagnostics::source::Place;
use crate::document::Document;
use crate::model::given::GivenQuasiVelocity;
use crate::model::stored::StoredModel;

/// A model whose parameters can be set and that can be turned into a mechanical system.
///
/// It is stored as its text and what was set, without the limits on its derivations.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(into = "StoredModel", try_from = "StoredModel")]
pub struct Model {
    document: Arc<Document>,
    pub(super) parameters: Parameters,
    /// Start values that replace those of the document, each with its index.
    pub(super) starts: Vec<(usize, f64)>,
    pub(super) projects_start: bool,
    /// The indices of start values that stay fixed when the start is moved onto constraints.
    pub(super) held_starts: Vec<usize>,
    pub(super) observes_reactions: bool,
    /// Whether motions and events are to be differentiated with respect to parameters.
    pub(super) by_parameters: bool,
    pub(super) by_time: bool,
    pub(super) of_observables: bool,
    /// The names of the integrals to be kept.
    pub(super) kept: Vec<String>,
    /// The limits on derivations from this model.
    budget: Budget,
    /// The quasi-velocities, or coordinates, on which external forces act.
    pub(crate) external: Vec<String>,
    /// Quasi-velocities given in addition to those of the document.
    pub(crate) given: Vec<GivenQuasiVelocity>,
    /// The names of the velocities that are requested to be independent.
    pub(crate) independent: Vec<String>,
}

/// A name that is not a parameter of the model.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{name}` is not a parameter of this model; its parameters are {}", if known.is_empty() { "none".to_owned() } else { known.join(", ") })]
pub struct UnknownParameter {
    /// The requested name.
    pub name: String,
    /// The existing parameters.
    pub known: Vec<String>,
}

/// What replaces the value of an input in the document.
#[derive(Clone, Debug, PartialEq)]
pub enum GivenInput {
    /// A number, which stays constant until it is set.
    Constant(f64),
    /// A function of time.
    Table(Table),
}

/// A name that is not an input of the model.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{name}` is not an input of this model; its inputs are {}", if known.is_empty() { "none".to_owned() } else { known.join(", ") })]
pub struct UnknownInput {
    /// The requested name.
    pub name: String,
    /// The existing inputs.
    pub known: Vec<String>,
}

/// A name that is not an integral of the model.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{name}` is not an integral of this model; there are {}", known.join(", "))]
pub struct UnknownIntegral {
    /// The requested name.
    pub name: String,
    /// The existing integrals.
    pub known: Vec<String>,
}

impl Model {
    /// The model of a document.
    pub fn new(document: Document) -> Model {
        let kept = document.simulation.project.iter().map(|name| name.value.clone()).collect();
        Model {
            parameters: Parameters::new(&document),
            given: GivenQuasiVelocity::of_document(&document),
            independent: document.simulation.independent.iter().map(|name| name.value.clone()).collect(),
            document: Arc::new(document),
            starts: Vec::new(),
            projects_start: false,
            held_starts: Vec::new(),
            observes_reactions: false,
            by_parameters: false,
            by_time: false,
            of_observables: false,
            kept,
            budget: Budget::default(),
            external: Vec::new(),
        }
    }

    /// Limits the memory and time that all further derivations of this model and its clones may use together.
    pub fn limit(&mut self, limits: Limits) {
        self.budget = Budget::new(limits);
    }

    /// Makes all further derivations of this model and its clones draw on a budget, which others may share.
    pub fn within(&mut self, budget: Budget) {
        self.budget = budget;
    }

    /// The budget that the limits leave for derivations.
    pub fn budget(&self) -> &Budget {
        &self.budget
    }

    /// An empty graph, subject to the limits of the model, in which to derive its equations.
    pub fn graph(&self) -> Graph {
        Graph::new().within(&self.budget)
    }

    /// The document from which the model was made.
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// Checks that every function has a value, without which there are no numbers, only equations for all functions.
    ///
    /// ```
    /// use pc_model::{Document, Model, Source};
    /// let text = "functions.V.of = \"s\"\ncoordinates.r = 1.0\nlagrangian.lagrangian = \"r'^2/2 - V(r)\"";
    /// let model = Model::new(Document::parse(Source::new("model.toml", text))?);
    /// model.derived(|assembly| {
    ///     let equations = assembly.equations()?;
    ///     assert_eq!(equations.system().energy().to_string(), "1/2*r'^2 + V(r)");
    ///     Ok::<_, pc_model::ModelError>(())
    /// })?;
    /// let error = model.require_values().unwrap_err();
    /// assert_eq!(error.diagnostic().message, "the function `V` has no value, so there are no numbers");
    /// # Ok::<(), pc_model::ModelError>(())
    /// ```
    ///
    /// # Errors
    /// [`ModelError`] at the first function without a value.
    pub fn require_values(&self) -> Result<(), ModelError> {
        match self.document.undetermined_functions().next() {
            Some(function) => {
                let (name, arguments) = (function.name.text.clone(), function.arguments.join(", "));
                Err(self.document.error(&function.name.place, MeaningError::NoValue { name, arguments }))
            }
            None => Ok(()),
        }
    }

    pub(crate) fn shared_document(&self) -> Arc<Document> {
        Arc::clone(&self.document)
    }

    /// The name given in the text, or else the name of the file.
    pub fn title(&self) -> &str {
        let name = self.document.model.name.as_ref();
        name.map_or_else(|| self.document.source.name(), |name| name.value.as_str())
    }

    /// Sets a parameter, or an input that has no table, to a value other than that in the file. Parameters that are
    /// expressions in it are updated; a parameter that is itself an expression becomes a number.
    ///
    /// # Errors
    /// [`UnknownParameter`], which lists the existing parameters.
    pub fn set(&mut self, name: &str, value: f64) -> Result<(), UnknownParameter> {
        let known =
            |&(place, (known, _)): &(usize, (&str, f64))| known == name && !self.parameters.is_table(place);
        let Some(index) = self.parameters().enumerate().find(known).map(|(place, _)| place) else {
            return Err(UnknownParameter { name: name.to_owned(), known: self.parameter_names() });
        };
        self.parameters.set(index, value);
        Ok(())
    }

    /// Gives an input a number or a table, whether it has a number or a table in the document. A table has to begin at or
    /// before the start of the motion; the derivation checks this.
    ///
    /// # Errors
    /// [`UnknownInput`], which lists the existing inputs.
    pub fn give_input(&mut self, name: &str, given: GivenInput) -> Result<(), UnknownInput> {
        let names = || self.document.inputs.iter().map(|input| input.name.text.as_str());
        let Some(index) = names().position(|known| known == name) else {
            return Err(UnknownInput { name: name.to_owned(), known: names().map(str::to_owned).collect() });
        };
        let place = self.document.parameters.len() + index;
        match given {
            GivenInput::Constant(value) => self.parameters.set(place, value),
            GivenInput::Table(table) => self.parameters.set_table(place, table),
        }
        Ok(())
    }

    /// The names of the parameters, then of the inputs that have no table: those that can be [set](Model::set).
    pub fn parameter_names(&self) -> Vec<String> {
        let is_set = |&(place, _): &(usize, (&str, f64))| !self.parameters.is_table(place);
        self.parameters().enumerate().filter(is_set).map(|(_, (name, _))| name.to_owned()).collect()
    }

    /// Gives the parameter or input with index `place` another value.
    pub(crate) fn set_parameter(&mut self, place: usize, value: f64) {
        self.parameters.set(place, value);
    }

    /// The place in the file of the parameter or input with index `place`.
    pub(crate) fn parameter_place(&self, place: usize) -> Place {
        let parameters = self.document.parameters.iter().map(|p| &p.name);
        let mut names = parameters.chain(self.document.inputs.iter().map(|input| &input.name));
        names.nth(place).map_or_else(|| self.document.end(), |name| name.place.clone())
    }

    /// The names and values of the parameters, then of the inputs; for an input with a table, its value at the start.
    pub fn parameters(&self) -> impl Iterator<Item = (&str, f64)> {
        let parameters = self.document.parameters.iter().map(|p| &p.name);
        let names = parameters.chain(self.document.inputs.iter().map(|input| &input.name));
        names.map(|name| name.text.as_str()).zip(self.parameters.values().iter().copied())
    }

    /// The values of the parameters, which can be changed independently of the model.
    pub fn parameter_values(&self) -> &Parameters {
        &self.parameters
    }

    /// The names of the integrals that the motion keeps by projection.
    pub fn kept(&self) -> &[String] {
        &self.kept
    }

    /// Keeps an integral, or `energy`, at its value at the start, by projection.
    ///
    /// # Errors
    /// [`UnknownIntegral`], which lists the existing integrals.
    pub fn keep(&mut self, name: &str) -> Result<(), UnknownIntegral> {
        let integrals = self.document.integrals.iter().map(|integral| integral.name.text.as_str());
        let known: Vec<&str> = integrals.chain(["energy"]).collect();
        if !known.contains(&name) {
            let known = known.into_iter().map(str::to_owned).collect();
            return Err(UnknownIntegral { name: name.to_owned(), known });
        }
        if !self.kept.iter().any(|kept| kept == name) {
            self.kept.push(name.to_owned());
        }
        Ok(())
    }

    /// Sets whether the start is moved onto the constraints.
    pub fn project_start(&mut self, yes: bool) {
        self.projects_start = yes;
    }

    /// Keeps the start value with index `place` fixed.
    pub(crate) fn hold_start_at(&mut self, place: usize) {
        if !self.held_starts.contains(&place) {
            self.held_starts.push(place);
            self.held_starts.sort_unstable();
        }
    }

    /// The indices of the start values that stay fixed, in ascending order.
    pub(crate) fn held_starts(&self) -> &[usize] {
        &self.held_starts
    }

    /// Sets whether the reactions of all constraints are outputs, each called `λ_` followed by the name of its
    /// constraint.
    pub fn observe_reactions(&mut self, yes: bool) {
        self.observes_reactions = yes;
    }

    /// Sets whether sensitivities are needed: motions are then compiled with their derivatives with respect to the
    /// parameters, and events with their derivatives with respect to time, state and parameters.
    pub fn differentiate_by_parameters(&mut self, yes: bool) {
        self.by_parameters = yes;
    }

    /// Sets whether motions are compiled with [∂f/∂t](pc_mech::Motion::time_derivative).
    pub fn differentiate_by_time(&mut self, yes: bool) {
        self.by_time = yes;
    }

    /// Sets whether motions are compiled with the [derivatives of their observables](pc_mech::Motion::observable_jacobian),
    /// and with ∂f/∂p.
    pub fn differentiate_observables(&mut self, yes: bool) {
        self.of_observables = yes;
    }

    pub(crate) fn differentiates_observables(&self) -> bool {
        self.of_observables
    }

    pub(crate) fn differentiates_by_time(&self) -> bool {
        self.by_time
    }

    pub(crate) fn differentiates_by_parameters(&self) -> bool {
        self.by_parameters
    }

    /// Whether the reactions of all constraints are outputs.
    pub fn observes_reactions(&self) -> bool {
        self.observes_reactions
    }

    /// Replaces the start value with index `place`.
    pub(crate) fn override_start(&mut self, place: usize, value: f64) {
        self.starts.retain(|&(known, _)| known != place);
        self.starts.push((place, value));
    }

    /// The start values that replace those of the document, each with its index.
    pub(crate) fn overridden_starts(&self) -> &[(usize, f64)] {
        &self.starts
    }

    /// Whether the start is moved onto the constraints.
    pub fn projects_start(&self) -> bool {
        self.projects_start
    }
}
