//! The motions near a state, to first order.

use std::io::{self, Seek, Write};

use pc_analysis::{Linearization, Stability, Trim};
use pc_model::Model;
use pc_print::stability_in_words;
use serde_json::{Map, Value, json};

use crate::error::RunError;
use crate::linear::arrays::of_linearization;
use crate::linear::linearizable::{Linearizable, placed};
use crate::linear::near::{CyclicChoice, near};
use crate::linear::output::Contents;
use crate::linear::state::{At, Cyclic, StateChoice};
use crate::linear::trim::Trimmed;
use crate::linear::{compared, json, text};
use crate::observer::Observer;
use crate::table::array::Array;
use crate::table::csv::field;
use crate::table::format::Format;
use crate::table::tabulated::Tabulated;

/// A linearization of a model, with the stability of its state.
#[derive(Debug)]
pub struct Linearized {
    title: String,
    parameters: Vec<(String, f64)>,
    at: At,
    /// The inputs that were chosen; none if all were given.
    chosen: Vec<(String, f64)>,
    /// The linearization.
    pub linear: Linearization,
    /// The stability, as `pc check` judges it; none if the state is not steady.
    pub stability: Option<Stability>,
}

impl Linearized {
    /// Linearizes a model at the chosen state; if `verify` is set, the equations and matrices are compared with a
    /// second derivation.
    ///
    /// # Errors
    /// [`RunError`]
    pub fn of(
        model: &Model,
        state: &StateChoice,
        verify: bool,
        observer: &dyn Observer,
    ) -> Result<Linearized, RunError> {
        Linearized::from(model, None, state, verify, observer)
    }

    /// Linearizes a model at a state that is steady by the choice of the inputs and components `free`, as
    /// [`Trimmed::of`] finds them; all others keep their values.
    ///
    /// # Errors
    /// [`RunError`]
    pub fn trimmed(
        model: &Model,
        free: &[String],
        cyclic: Option<Cyclic>,
        verify: bool,
        observer: &dyn Observer,
    ) -> Result<Linearized, RunError> {
        let trimmed = Trimmed::of(model, free, verify, observer)?;
        let state = StateChoice { cyclic, ..StateChoice::default() };
        Linearized::from(&trimmed.with_inputs(model)?, Some(trimmed.trim), &state, verify, observer)
    }

    /// The linearization at the chosen state near the start, or at a state and inputs that balance.
    fn from(
        model: &Model,
        trim: Option<Trim>,
        state: &StateChoice,
        verify: bool,
        observer: &dyn Observer,
    ) -> Result<Linearized, RunError> {
        let graph = model.graph();
        let mut ground = Linearizable::vouched(model, &graph, verify, observer)?;
        let (t, start) = (ground.assembly.t_start, ground.linear.start.clone());
        let guess: Vec<f64> = match &trim {
            Some(trim) => trim.state.iter().map(|&(_, value)| value).collect(),
            None => start.clone(),
        };
        let mut linear = near(&mut ground.linear.linearizer, t, &guess, state, CyclicChoice::OfState)
            .map_err(|error| placed(&ground.assembly, error, true))?;
        if trim.is_some() {
            let apart = linear.state.iter().zip(&start).map(|((_, value), start)| value - start);
            linear.distance = apart.fold(0.0, f64::hypot);
        }
        if verify {
            compared::compare(model, &ground.assembly, &[&linear], observer)?;
        }
        let stability = ground.stability(&linear).map_err(|error| placed(&ground.assembly, error, true))?;
        ground.assembly.within_limits()?;
        Ok(Linearized {
            title: model.title().to_owned(),
            parameters: model.parameters().map(|(name, value)| (name.to_owned(), value)).collect(),
            at: state.at,
            chosen: trim.map(|trim| trim.inputs).unwrap_or_default(),
            linear,
            stability,
        })
    }

    /// The linearization as text for people.
    pub fn text(&self) -> String {
        text::page(&self.title, &self.chosen, &self.linear, self.stability.as_ref(), self.at != At::Start)
    }

    /// The linearization as one JSON object; docs/linearization.md says what the members are.
    pub fn json(&self) -> Value {
        let parameters = self.parameters.iter().map(|(name, value)| (name.as_str(), *value));
        let mut all = Map::new();
        all.insert("model".to_owned(), json!(self.title));
        all.insert("parameters".to_owned(), json::map(parameters));
        all.insert("at".to_owned(), json!(self.at.word()));
        let chosen = self.chosen.iter().map(|(name, value)| (name.as_str(), *value));
        all.insert("chosen_inputs".to_owned(), json::map(chosen));
        all.extend(json::members(&self.linear));
        all.insert("stability".to_owned(), json!(self.stability.as_ref().map(stability_in_words)));
        Value::from(all)
    }

    /// The linearization as a table with a line for each number.
    pub fn csv(&self) -> String {
        csv(&self.linear)
    }
}

impl Tabulated for Linearized {
    fn formats(&self) -> &'static [Format] {
        Format::OF_ARRAYS
    }

    fn write_as(&self, format: Format, out: &mut (impl Write + Seek + Send)) -> io::Result<()> {
        let contents = Contents {
            text: &|| self.text(),
            json: &|| self.json(),
            csv: &|| self.csv(),
            arrays: &|| of_linearization(&self.linear),
            texts: &names(&self.linear),
        };
        contents.write_as(format, out)
    }
}

/// The names of the rows and columns of the arrays, as lists separated by commas.
fn names(linear: &Linearization) -> Vec<(&'static str, String)> {
    let state: Vec<&str> = linear.state.iter().map(|(name, _)| name.as_str()).collect();
    let mut names = vec![
        ("state_names", state.join(",")),
        ("components", linear.components.join(",")),
        ("inputs", linear.inputs.join(",")),
        ("outputs", linear.outputs.join(",")),
    ];
    if let Ok(second) = &linear.second_order {
        names.push(("coordinates", second.coordinates.join(",")));
    }
    names
}

/// A line for each number: its array, the names of its row and column, and the number; real and imaginary
/// parts are on separate lines.
fn csv(linear: &Linearization) -> String {
    let (y, u, h) = (&linear.components, &linear.inputs, &linear.outputs);
    let numbers = |count: usize| (1..=count).map(|i| i.to_string()).collect::<Vec<_>>();
    let states: Vec<String> = linear.state.iter().map(|(name, _)| name.clone()).collect();
    let q = linear.second_order.as_ref().map(|second| second.coordinates.clone()).unwrap_or_default();
    let of = |array: &Array| match array.name.as_str() {
        "state" => (states.clone(), vec![String::new()]),
        "A" => (y.clone(), y.clone()),
        "B" => (y.clone(), u.clone()),
        "C" => (h.clone(), y.clone()),
        "D" => (h.clone(), u.clone()),
        "modes" => (y.clone(), numbers(array.columns)),
        "F" => (q.clone(), u.clone()),
        "M" | "G" | "K" => (q.clone(), q.clone()),
        _ => (numbers(array.rows), vec![String::new()]),
    };
    let mut text = "array,row,column,value\n".to_owned();
    for array in of_linearization(linear) {
        let (rows, columns) = of(&array);
        let parts = match &array.imaginary {
            None => vec![("", &array.real)],
            Some(imaginary) => vec![".re", ".im"].into_iter().zip([&array.real, imaginary]).collect(),
        };
        for (part, values) in parts {
            for (place, value) in values.iter().enumerate() {
                let (row, column) = (&rows[place / array.columns], &columns[place % array.columns]);
                text += &format!("{}{part},{},{},{value:.16e}\n", array.name, field(row), field(column));
            }
        }
    }
    text
}
