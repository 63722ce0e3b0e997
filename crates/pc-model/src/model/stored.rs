//! A model as it is stored: its text, and what was set beside it.

use serde::{Deserialize, Serialize};

use crate::assembly::parameters::Change;
use crate::diagnostics::error::ModelError;
use crate::diagnostics::source::Source;
use crate::document::Document;
use crate::model::model::Model;

#[derive(Serialize, Deserialize)]
pub(super) struct StoredModel {
    name: String,
    text: String,
    parameters: Vec<Change>,
    starts: Vec<(usize, f64)>,
    projects_start: bool,
    held_starts: Vec<usize>,
    observes_reactions: bool,
    by_parameters: bool,
    by_time: bool,
    of_observables: bool,
    kept: Vec<String>,
    external: Vec<String>,
    /// The quasi-velocities of the text were removed.
    without_given: bool,
    /// Names and definitions of the others.
    given: Vec<(String, String)>,
    independent: Vec<String>,
}

impl From<Model> for StoredModel {
    fn from(model: Model) -> StoredModel {
        let document = model.document();
        let of_text = document.simulation.hamel.len();
        let is_of_text = |i: usize| {
            let given = model.given.get(i);
            given.is_some_and(|given| given.name == document.simulation.hamel[i].name.text)
        };
        let without_given = !(0..of_text).all(is_of_text);
        let skipped = if without_given { 0 } else { of_text };
        let given = model.given.iter().skip(skipped);
        StoredModel {
            name: document.source.name().to_owned(),
            text: document.source.text().to_owned(),
            parameters: model.parameters.changes(document),
            without_given,
            given: given.map(|given| (given.name.clone(), given.expression.text.clone())).collect(),
            starts: model.starts,
            projects_start: model.projects_start,
            held_starts: model.held_starts,
            observes_reactions: model.observes_reactions,
            by_parameters: model.by_parameters,
            by_time: model.by_time,
            of_observables: model.of_observables,
            kept: model.kept,
            external: model.external,
            independent: model.independent,
        }
    }
}

impl TryFrom<StoredModel> for Model {
    type Error = ModelError;

    fn try_from(stored: StoredModel) -> Result<Model, ModelError> {
        let mut model = Model::new(Document::parse(Source::new(stored.name, stored.text))?);
        model.parameters.change(stored.parameters);
        if stored.without_given {
            model.give_no_quasi_velocities();
        }
        for (name, definition) in &stored.given {
            model.give_quasi_velocity(name, definition)?;
        }
        model.starts = stored.starts;
        model.projects_start = stored.projects_start;
        model.held_starts = stored.held_starts;
        model.observes_reactions = stored.observes_reactions;
        model.by_parameters = stored.by_parameters;
        model.by_time = stored.by_time;
        model.of_observables = stored.of_observables;
        model.kept = stored.kept;
        model.external = stored.external;
        model.independent = stored.independent;
        Ok(model)
    }
}
