//! A model built call by call, written as a text, so that both ways of making a model have the same
//! meaning.

use std::fmt::Write;

use ::pc_model::{Document, ModelError, Source, UnknownParameter, UnknownStart};

use crate::ffi::call_error::CallError;

/// Entries in the order in which they were added, each in a section of the text.
#[derive(Clone, Debug)]
pub(crate) struct Draft {
    name: String,
    entries: Vec<Entry>,
}

#[derive(Clone, Debug)]
struct Entry {
    section: Section,
    /// The key, followed by the keys inside its tables.
    keys: Vec<String>,
    /// The value as it is written in the text.
    value: String,
}

/// A section of the text; the variants are in the order of the text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Section {
    Heading,
    Parameters,
    Inputs,
    Definitions,
    Coordinates,
    QuasiVelocities,
    States,
    Kinematics,
    Algebra,
    Brackets,
    Constraints,
    Lagrangian,
    Bodies,
    Points,
    Loops,
    Contacts,
    Gravity,
    Forces,
    Integrals,
    Outputs,
    HamiltonJacobi,
    Events,
    Simulation,
}

const SECTIONS: [(Section, &str); 23] = [
    (Section::Heading, "model"),
    (Section::Parameters, "parameters"),
    (Section::Inputs, "inputs"),
    (Section::Definitions, "definitions"),
    (Section::Coordinates, "coordinates"),
    (Section::QuasiVelocities, "quasi_velocities"),
    (Section::States, "states"),
    (Section::Kinematics, "kinematics"),
    (Section::Algebra, "algebra"),
    (Section::Brackets, "algebra.brackets"),
    (Section::Constraints, "constraints"),
    (Section::Lagrangian, "lagrangian"),
    (Section::Bodies, "bodies"),
    (Section::Points, "points"),
    (Section::Loops, "loops"),
    (Section::Contacts, "contacts"),
    (Section::Gravity, "gravity"),
    (Section::Forces, "forces"),
    (Section::Integrals, "integrals"),
    (Section::Outputs, "outputs"),
    (Section::HamiltonJacobi, "hamilton_jacobi"),
    (Section::Events, "events"),
    (Section::Simulation, "simulation"),
];

impl Draft {
    pub(crate) fn new(name: &str) -> Draft {
        let mut draft = Draft { name: name.to_owned(), entries: Vec::new() };
        draft.add(Section::Heading, &["name"], quoted(name));
        draft
    }

    /// Adds an entry; a name that occurs twice is an error when the text is read.
    pub(crate) fn add(&mut self, section: Section, keys: &[&str], value: String) {
        let keys = keys.iter().map(|&key| key.to_owned()).collect();
        self.entries.push(Entry { section, keys, value });
    }

    /// Adds an entry, or changes the value of an existing one.
    pub(crate) fn put(&mut self, section: Section, keys: &[&str], value: String) {
        match self.find(section, keys) {
            Some(entry) => entry.value = value,
            None => self.add(section, keys, value),
        }
    }

    /// Changes the value of a parameter, or of an input without a table.
    pub(crate) fn set(&mut self, name: &str, value: f64) -> Result<(), UnknownParameter> {
        for section in [Section::Parameters, Section::Inputs] {
            if let Some(entry) = self.find(section, &[name]) {
                entry.value = number(value);
                return Ok(());
            }
        }
        let known = self.names(Section::Parameters);
        Err(UnknownParameter { name: name.to_owned(), known })
    }

    /// Changes the start value of a coordinate, quasi-velocity or first-order state; velocities
    /// `x'` are added.
    pub(crate) fn set_start(&mut self, name: &str, value: String) -> Result<(), UnknownStart> {
        let places: [(Section, &[&str]); 4] = [
            (Section::States, &[name, "start"]),
            (Section::Coordinates, &[name]),
            (Section::QuasiVelocities, &[name, "start"]),
            (Section::QuasiVelocities, &[name]),
        ];
        for (section, keys) in places {
            if let Some(entry) = self.find(section, keys) {
                entry.value = value;
                return Ok(());
            }
        }
        if self.find(Section::QuasiVelocities, &[name, "is"]).is_some() {
            self.add(Section::QuasiVelocities, &[name, "start"], value);
            return Ok(());
        }
        let mut known = self.names(Section::Coordinates);
        if name.strip_suffix('\'').is_some_and(|coordinate| known.iter().any(|known| known == coordinate)) {
            self.add(Section::QuasiVelocities, &[name], value);
            return Ok(());
        }
        known.extend(self.names(Section::QuasiVelocities));
        known.extend(self.names(Section::States));
        Err(UnknownStart { name: name.to_owned(), known })
    }

    /// Adds a reset to an existing event.
    pub(crate) fn add_reset(&mut self, event: &str, variable: &str, value: String) -> Result<(), CallError> {
        if !self.names(Section::Events).iter().any(|known| known == event) {
            return Err(CallError::NoSuchEvent { name: event.to_owned() });
        }
        self.add(Section::Events, &[event, "reset", variable], value);
        Ok(())
    }

    fn find(&mut self, section: Section, keys: &[&str]) -> Option<&mut Entry> {
        self.entries.iter_mut().find(|entry| entry.section == section && entry.keys == keys)
    }

    /// The first keys of the entries in a section, each once.
    fn names(&self, section: Section) -> Vec<String> {
        let mut names: Vec<String> = Vec::new();
        for name in self.entries.iter().filter(|entry| entry.section == section).map(|entry| &entry.keys[0]) {
            if !names.contains(name) {
                names.push(name.clone());
            }
        }
        names
    }

    /// The model as text.
    pub(crate) fn text(&self) -> String {
        let mut text = String::new();
        for (section, header) in SECTIONS {
            let mut entries = self.entries.iter().filter(|entry| entry.section == section).peekable();
            if entries.peek().is_some() {
                let line = if text.is_empty() { "" } else { "\n" };
                let _ = writeln!(text, "{line}[{header}]"); // writing to a string cannot fail
            }
            for Entry { keys, value, .. } in entries {
                let keys: Vec<String> = keys.iter().map(|key| quoted(key)).collect();
                let _ = writeln!(text, "{} = {value}", keys.join("."));
            }
        }
        text
    }

    /// The model read from the text.
    pub(crate) fn document(&self) -> Result<Document, ModelError> {
        Document::parse(Source::new(self.name.clone(), self.text()))
    }
}

/// A TOML string on one line.
pub(crate) fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => quoted.extend(['\\', c]),
            c if c.is_control() => {
                let _ = write!(quoted, "\\u{:04X}", u32::from(c)); // writing to a string cannot fail
            }
            c => quoted.push(c),
        }
    }
    quoted.push('"');
    quoted
}

/// A TOML list of strings.
pub(crate) fn list(texts: &[&str]) -> String {
    let texts: Vec<String> = texts.iter().map(|text| quoted(text)).collect();
    format!("[{}]", texts.join(", "))
}

/// A TOML list of finite numbers.
pub(crate) fn numbers(values: &[f64]) -> String {
    let values: Vec<String> = values.iter().map(|&value| number(value)).collect();
    format!("[{}]", values.join(", "))
}

/// A finite number in TOML that reads back as the same number.
pub(crate) fn number(value: f64) -> String {
    format!("{value:?}")
}
