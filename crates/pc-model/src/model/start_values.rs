//! Start values other than those in the file.

use crate::assembly::start;
use crate::diagnostics::error::ModelError;
use crate::document::Contact;
use crate::document::tolerance::AbsoluteTolerance;
use crate::model::model::Model;

/// A name that has no start value.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{name}` has no start value in this model; {} have", known.join(", "))]
pub struct UnknownStart {
    /// The requested name.
    pub name: String,
    /// The coordinates, quasi-velocities and first-order states; velocities x' if no quasi-velocity is declared.
    pub known: Vec<String>,
}

/// A name that is not that of a parameter and has no start value.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{name}` is neither a parameter nor a start value of this model; its parameters are {}, its start values {}",
    list(parameters),
    list(starts)
)]
pub struct UnknownValue {
    /// The requested name.
    pub name: String,
    /// The parameters, and inputs without a table.
    pub parameters: Vec<String>,
    /// The names that have a start value.
    pub starts: Vec<String>,
}

fn list(names: &[String]) -> String {
    if names.is_empty() { "none".to_owned() } else { names.join(", ") }
}

impl Model {
    /// Gives a value other than that in the file to a parameter, to an input without a table, or to anything that
    /// has a start value.
    ///
    /// # Errors
    /// [`UnknownValue`], which lists the existing names.
    pub fn set_value(&mut self, name: &str, value: f64) -> Result<(), UnknownValue> {
        if self.set(name, value).is_ok() || self.set_start(name, value).is_ok() {
            return Ok(());
        }
        let (parameters, starts) = (self.parameter_names(), self.start_names());
        Err(UnknownValue { name: name.to_owned(), parameters, starts })
    }

    /// The names whose start values differ from those in the file, with their values.
    pub fn replaced_starts(&self) -> Vec<(String, f64)> {
        let mut replaced = self.overridden_starts().to_vec();
        replaced.sort_unstable_by_key(|&(place, _)| place);
        let names = self.start_names();
        replaced.into_iter().map(|(place, value)| (names[place].clone(), value)).collect()
    }

    /// The names that have a start value: coordinates, quasi-velocities (or velocities x' if none is declared), and
    /// first-order states.
    pub fn start_names(&self) -> Vec<String> {
        self.document().start_names()
    }

    /// These absolute tolerances, completed by the tolerances of the text.
    ///
    /// # Errors
    /// [`UnknownStart`] for a name that has no start value.
    pub fn absolute_tolerance(&self, given: AbsoluteTolerance) -> Result<AbsoluteTolerance, UnknownStart> {
        let known = self.start_names();
        if let Some((name, _)) = given.each.iter().find(|(name, _)| !known.contains(name)) {
            return Err(UnknownStart { name: name.clone(), known });
        }
        let written = self.document().simulation.atol.as_ref();
        Ok(written.map_or(given.clone(), |written| given.or(&written.value)))
    }

    /// Gives a coordinate, quasi-velocity or first-order state a start value other than that in the file.
    ///
    /// # Errors
    /// [`UnknownStart`], which lists the existing names.
    pub fn set_start(&mut self, name: &str, value: f64) -> Result<(), UnknownStart> {
        let known = self.start_names();
        match known.iter().position(|known| known == name) {
            Some(place) => {
                self.override_start(place, value);
                Ok(())
            }
            None => Err(UnknownStart { name: name.to_owned(), known }),
        }
    }

    /// Holds the value of a coordinate or quasi-velocity fixed when the start is [moved onto the
    /// constraints](Model::project_start): only the other values move.
    ///
    /// # Errors
    /// [`UnknownStart`], which lists the existing names.
    pub fn hold_start(&mut self, name: &str) -> Result<(), UnknownStart> {
        let mut known = self.start_names();
        known.truncate(known.len() - self.document().states.len()); // constraints do not move first-order states
        match known.iter().position(|known| known == name) {
            Some(place) => {
                self.hold_start_at(place);
                Ok(())
            }
            None => Err(UnknownStart { name: name.to_owned(), known }),
        }
    }

    /// The names of the start values that are held fixed.
    pub fn held_start_names(&self) -> Vec<String> {
        let names = self.start_names();
        self.held_starts().iter().map(|&place| names[place].clone()).collect()
    }

    /// Whether quasi-velocities may be determined by start velocities of coordinates that are given with
    /// them: [`start`](Model::start) then does not contain their values.
    pub fn derives_start(&self) -> bool {
        let document = self.document();
        !document.quasi_velocities.is_empty() && !document.start_velocities.is_empty()
    }

    /// Whether velocities that have no start value may be determined by constraints, or the points of contacts with uneven
    /// ground by the places of bodies: [`start`](Model::start) then does not contain their values.
    pub fn completes_start(&self) -> bool {
        let document = self.document();
        let n = document.coordinates.len();
        let is_set = |s: usize| self.overridden_starts().iter().any(|&(place, _)| place == n + s);
        let given: Vec<bool> = match document.quasi_velocities.is_empty() {
            true => {
                let names = || document.start_velocities.iter().map(|velocity| &velocity.name.text);
                document.coordinates.iter().map(|x| names().any(|name| *name == x.name.text)).collect()
            }
            false => document.quasi_velocities.iter().map(|eta| eta.start.is_some()).collect(),
        };
        let is_set_coordinate = |name: &str| {
            let place = document.coordinates.iter().position(|x| x.name.text == name);
            self.overridden_starts().iter().any(|&(set, _)| Some(set) == place)
        };
        let mut found = document.contacts.iter().flat_map(Contact::found_coordinates);
        if found.any(|name| !is_set_coordinate(&name.text)) {
            return true;
        }
        !document.constraints.is_empty() && !given.iter().enumerate().all(|(s, &given)| given || is_set(s))
    }

    /// The start state (x, η, z) with the declared η, or (x, x', z) if none is declared: the values of the
    /// [`start_names`](Model::start_names) for the current parameters, whether or not these satisfy the
    /// constraints, and 0 where no value is given.
    ///
    /// # Errors
    /// [`ModelError`] if a start value is not a number.
    pub fn start(&self) -> Result<Vec<f64>, ModelError> {
        self.parameter_values().check(self.document())?;
        start::start(self, &self.graph())
    }
}
