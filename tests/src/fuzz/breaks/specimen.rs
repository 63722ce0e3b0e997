//! A model of several pieces, known by its formulas.

use std::fmt::Write as _;

use super::formula::{Formula, Names};

/// Rows of a motion.
pub(super) const ROWS: usize = 5;
/// Tolerances of the motions that are tried.
pub(super) const RTOL: f64 = 1e-9;
pub(super) const ATOL: f64 = 1e-12;

/// A coordinate with its start.
#[derive(Clone, Debug)]
pub(super) struct Coordinate {
    pub(super) name: String,
    pub(super) start: Formula,
    pub(super) speed: Formula,
}

/// A first-order state.
#[derive(Clone, Debug)]
pub(super) struct State {
    pub(super) name: String,
    pub(super) start: Formula,
    pub(super) rate: Formula,
}

/// An input that a table gives.
#[derive(Clone, Debug)]
pub(super) struct Table {
    pub(super) name: String,
    pub(super) times: Vec<f64>,
    pub(super) values: Vec<f64>,
    /// The last value, instead of lines.
    pub(super) holds: bool,
}

/// Where a term stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    Kinetic,
    Potential,
    Dissipation,
    /// On the coordinate of this number.
    Force(usize),
}

/// Terms in coordinates, their velocities and first-order states, with the functions of the surfaces where they change.
#[derive(Clone, Debug, Default)]
pub(super) struct Specimen {
    pub(super) parameters: Vec<(String, f64)>,
    pub(super) coordinates: Vec<Coordinate>,
    pub(super) states: Vec<State>,
    pub(super) tables: Vec<Table>,
    pub(super) terms: Vec<(Part, Formula)>,
    pub(super) surfaces: Vec<Formula>,
    pub(super) t_end: f64,
    /// The parameters by which the motion is differentiated.
    pub(super) asked: Vec<usize>,
}

impl Specimen {
    /// The times of the rows.
    pub(super) fn times(&self) -> Vec<f64> {
        let last = (ROWS - 1) as f64;
        (0..ROWS).map(|i| self.t_end * (i as f64 / last)).collect()
    }

    /// Coordinates, velocities and states.
    pub(super) fn variables(&self) -> Vec<String> {
        let names = self.coordinates.iter().map(|x| x.name.clone());
        let velocities = self.coordinates.iter().map(|x| format!("{}'", x.name));
        names.chain(velocities).chain(self.states.iter().map(|z| z.name.clone())).collect()
    }

    /// The values of the parameters.
    pub(super) fn values(&self) -> Vec<f64> {
        self.parameters.iter().map(|(_, value)| *value).collect()
    }

    /// The same without a term, or a state that nothing else needs, for each of them.
    pub(super) fn shorter(&self) -> Vec<Specimen> {
        let without = |i: usize| {
            let mut shorter = self.clone();
            shorter.terms.remove(i);
            shorter
        };
        let removable = (0..self.terms.len()).filter(|&i| self.terms[i].0 != Part::Kinetic);
        let mut all: Vec<Specimen> = removable.map(without).collect();
        if self.asked.len() > 1 {
            all.extend(self.asked.iter().map(|&asked| Specimen { asked: vec![asked], ..self.clone() }));
        }
        all.push(Specimen { t_end: self.t_end / 2.0, ..self.clone() });
        all
    }

    /// The text of the format.
    pub(super) fn text(&self) -> String {
        let parameters: Vec<String> = self.parameters.iter().map(|(name, _)| name.clone()).collect();
        let (variables, inputs) = (self.variables(), self.tables.iter().map(|table| table.name.clone()));
        let inputs: Vec<String> = inputs.collect();
        let names = Names {
            parameters: &parameters,
            variables: &variables,
            inputs: &inputs,
            surfaces: &self.surfaces,
        };
        let mut text = String::from("[parameters]\n");
        for (name, value) in &self.parameters {
            let _ = writeln!(text, "{name} = {value:?}");
        }
        text.push_str("[coordinates]\n");
        for x in &self.coordinates {
            let _ = writeln!(text, "{} = \"{}\"", x.name, x.start.text(names));
        }
        text.push_str("[quasi_velocities]\n");
        for x in &self.coordinates {
            let _ = writeln!(text, "\"{}'\" = \"{}\"", x.name, x.speed.text(names));
        }
        if !self.states.is_empty() {
            text.push_str("[states]\n");
        }
        for z in &self.states {
            let (start, rate) = (z.start.text(names), z.rate.text(names));
            let _ = writeln!(text, "{} = {{ start = \"{start}\", rate = \"{rate}\" }}", z.name);
        }
        if !self.tables.is_empty() {
            text.push_str("[inputs]\n");
        }
        for Table { name, times, values, holds } in &self.tables {
            let interpolation = if *holds { "hold" } else { "linear" };
            let _ = writeln!(
                text,
                "{name} = {{ times = {times:?}, values = {values:?}, interpolation = \"{interpolation}\" }}"
            );
        }
        text.push_str("[lagrangian]\n");
        let parts =
            [("kinetic", Part::Kinetic), ("potential", Part::Potential), ("dissipation", Part::Dissipation)];
        parts.into_iter().for_each(|(key, part)| self.line(&mut text, key, part, names));
        if self.terms.iter().any(|(part, _)| matches!(part, Part::Force(_))) {
            text.push_str("[forces]\n");
        }
        for (i, x) in self.coordinates.iter().enumerate() {
            self.line(&mut text, &x.name, Part::Force(i), names);
        }
        let _ = writeln!(text, "[simulation]\nt_end = {:?}\nsamples = {ROWS}", self.t_end);
        let _ = writeln!(text, "rtol = {RTOL:e}\natol = {ATOL:e}");
        text
    }

    fn line(&self, text: &mut String, key: &str, part: Part, names: Names<'_>) {
        let terms = self.terms.iter().filter(|(of, _)| *of == part);
        let terms: Vec<String> = terms.map(|(_, term)| term.text(names)).collect();
        if !terms.is_empty() {
            let _ = writeln!(text, "{key} = \"{}\"", terms.join(" + "));
        }
    }
}
