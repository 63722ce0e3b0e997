//! A model put together call by call: it is written as a text, so that there is one meaning.

use std::fmt::Write;

use ::pc_model::{Document, ModelError, Source, UnknownParameter};

/// Entries in the order in which they came, each in a section of the text.
#[derive(Clone, Debug)]
pub(crate) struct Draft {
    name: String,
    entries: Vec<Entry>,
}

#[derive(Clone, Debug)]
struct Entry {
    section: Section,
    key: String,
    /// As written in the text.
    value: String,
}

/// A section of the text, in the order of the text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Section {
    Parameters,
    Definitions,
    Coordinates,
    QuasiVelocities,
    Kinematics,
    Algebra,
    Brackets,
    Constraints,
    Lagrangian,
    Forces,
    Integrals,
    Outputs,
}

const SECTIONS: [(Section, &str); 12] = [
    (Section::Parameters, "parameters"),
    (Section::Definitions, "definitions"),
    (Section::Coordinates, "coordinates"),
    (Section::QuasiVelocities, "quasi_velocities"),
    (Section::Kinematics, "kinematics"),
    (Section::Algebra, "algebra"),
    (Section::Brackets, "algebra.brackets"),
    (Section::Constraints, "constraints"),
    (Section::Lagrangian, "lagrangian"),
    (Section::Forces, "forces"),
    (Section::Integrals, "integrals"),
    (Section::Outputs, "outputs"),
];

impl Draft {
    pub(crate) fn new(name: &str) -> Draft {
        Draft { name: name.to_owned(), entries: Vec::new() }
    }

    /// Adds an entry; that a name comes twice is found where the text is read.
    pub(crate) fn add(&mut self, section: Section, key: &str, value: String) {
        self.entries.push(Entry { section, key: key.to_owned(), value });
    }

    /// Adds an entry, or gives the one there is a new value.
    pub(crate) fn put(&mut self, section: Section, key: &str, value: String) {
        match self.find(section, key) {
            Some(entry) => entry.value = value,
            None => self.add(section, key, value),
        }
    }

    /// Gives a parameter that has been added a new value.
    pub(crate) fn set(&mut self, name: &str, value: f64) -> Result<(), UnknownParameter> {
        if let Some(entry) = self.find(Section::Parameters, name) {
            entry.value = number(value);
            return Ok(());
        }
        let parameters = self.entries.iter().filter(|entry| entry.section == Section::Parameters);
        let known = parameters.map(|entry| entry.key.clone()).collect();
        Err(UnknownParameter { name: name.to_owned(), known })
    }

    fn find(&mut self, section: Section, key: &str) -> Option<&mut Entry> {
        self.entries.iter_mut().find(|entry| entry.section == section && entry.key == key)
    }

    /// The text model.
    pub(crate) fn text(&self) -> String {
        let mut text = format!("[model]\nname = {}\n", quoted(&self.name));
        for (section, header) in SECTIONS {
            let mut entries = self.entries.iter().filter(|entry| entry.section == section).peekable();
            if entries.peek().is_some() {
                let _ = writeln!(text, "\n[{header}]"); // writing to a string cannot fail
            }
            for Entry { key, value, .. } in entries {
                let _ = writeln!(text, "{} = {value}", quoted(key));
            }
        }
        text
    }

    /// The model as read from the text.
    pub(crate) fn document(&self) -> Result<Document, ModelError> {
        Document::parse(Source::new(self.name.clone(), self.text()))
    }
}

/// A string of TOML on one line.
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

/// A finite number of TOML that reads back as the same.
pub(crate) fn number(value: f64) -> String {
    format!("{value:?}")
}
