//! The equilibria in a box, for people and for programs.

use std::io::{self, Seek, Write};
use std::ops::Range;

use pc_analysis::{Eigenvalue, Equilibria, EquilibriumSearch, FoundEquilibrium, Linearization};
use pc_model::Model;
use pc_print::{eigenvalues_in_words, labelled, one_line, short, stability_in_words, wrapped};
use serde_json::{Value, json};

use crate::error::RunError;
use crate::linear::compared;
use crate::linear::error::LinearError;
use crate::linear::json::map;
use crate::linear::linearizable::{Linearizable, placed};
use crate::linear::output::Contents;
use crate::linear::text::{in_digits, rounded};
use crate::observer::Observer;
use crate::table::csv::{field, header};
use crate::table::format::Format;
use crate::table::tabulated::Tabulated;

/// The width at which a line is wrapped, not counting its number.
const WIDTH: usize = 92;
const LABEL: usize = 4;

/// The largest value that Newton's method may leave in place of a zero.
const ZERO: f64 = 1e-9;

/// The digits of the components of a state, with which it may be given again as a start.
const DIGITS: usize = 9;

/// Where to look for equilibria.
#[derive(Clone, Debug, PartialEq)]
pub struct Search {
    /// Lower and upper bounds of coordinates and first-order states, with their names.
    pub bounds: Vec<(String, f64, f64)>,
    /// The number of points from which Newton's method is started.
    pub starts: usize,
}

impl Default for Search {
    fn default() -> Search {
        Search { bounds: Vec::new(), starts: 256 }
    }
}

/// The equilibria that a search has found for a model.
#[derive(Debug)]
pub struct Found {
    title: String,
    names: Vec<String>,
    /// Which of the names are quasi-velocities.
    velocities: Range<usize>,
    /// The equilibria.
    pub equilibria: Equilibria,
}

impl Found {
    /// Looks for the equilibria of a model; if `verify` is set, each is compared with a second derivation: its rates, its
    /// reactions and its matrices.
    ///
    /// # Errors
    /// [`RunError`], also if none is found.
    pub fn of(
        model: &Model,
        wanted: &Search,
        verify: bool,
        observer: &dyn Observer,
    ) -> Result<Found, RunError> {
        let graph = model.graph();
        let mut ground = Linearizable::vouched(model, &graph, verify, observer)?;
        let conserved = ground.conserved();
        let mut search = EquilibriumSearch::default().starts(wanted.starts);
        for (i, (name, low, high)) in wanted.bounds.iter().enumerate() {
            if wanted.bounds[..i].iter().any(|(known, ..)| known == name) {
                return Err(LinearError::Twice { name: name.clone() }.into());
            }
            search = search.within(name, *low, *high);
        }
        let at = (ground.assembly.t_start, ground.linear.start.as_slice());
        let found = search.run(&mut ground.linear.linearizer, at, &conserved);
        ground.assembly.within_limits()?;
        let equilibria = found.map_err(|error| placed(&ground.assembly, error, false))?;
        if equilibria.list.is_empty() {
            let Equilibria { starts, converged, poles, .. } = equilibria;
            return Err(LinearError::NoEquilibrium { starts, converged, poles }.into());
        }
        if verify {
            let all: Vec<&Linearization> = equilibria.list.iter().map(|one| &one.linearization).collect();
            compared::compare(model, &ground.assembly, &all, observer)?;
        }
        Ok(Found {
            title: model.title().to_owned(),
            names: ground.linear.linearizer.names().to_vec(),
            velocities: ground.linear.linearizer.quasi_velocities(),
            equilibria,
        })
    }

    /// The equilibria as text, with a paragraph for each.
    pub fn text(&self) -> String {
        text(&self.title, &self.names, &self.velocities, &self.equilibria)
    }

    /// The equilibria as one JSON object.
    pub fn json(&self) -> Value {
        json(&self.title, &self.names, &self.equilibria)
    }

    /// A line for each equilibrium: its state, energy, verdict and family, and the real and imaginary part of
    /// each eigenvalue.
    pub fn csv(&self) -> String {
        csv(&self.names, &self.equilibria)
    }
}

impl Tabulated for Found {
    fn formats(&self) -> &'static [Format] {
        Format::OF_LISTS
    }

    fn write_as(&self, format: Format, out: &mut (impl Write + Seek + Send)) -> io::Result<()> {
        let contents = Contents {
            text: &|| self.text(),
            json: &|| self.json(),
            csv: &|| self.csv(),
            arrays: &Vec::new,
            texts: &[],
        };
        contents.write_as(format, out)
    }
}

/// The components of a state that are shown: all except the quasi-velocities that vanish.
fn shown<'a>(
    names: &'a [String],
    found: &FoundEquilibrium,
    velocities: &Range<usize>,
) -> Vec<(&'a str, f64)> {
    let all = names.iter().zip(&found.state).enumerate();
    let is_shown =
        |&(i, (_, value)): &(usize, (&String, &f64))| !velocities.contains(&i) || value.abs() > ZERO;
    all.filter(is_shown).map(|(_, (name, &value))| (name.as_str(), value)).collect()
}

/// A paragraph for each equilibrium.
fn text(title: &str, names: &[String], velocities: &Range<usize>, found: &Equilibria) -> String {
    let mut text = format!("{}\n", one_line(title));
    for (number, one) in (1..).zip(&found.list) {
        let values = shown(names, one, velocities);
        let values = values.into_iter().map(|(name, value)| format!("{name} = {}", in_digits(value, DIGITS)));
        let energy = format!("energy {}", rounded(one.energy));
        let linear = &one.linearization;
        let mut lines = wrapped(values, WIDTH);
        lines.push(stability_in_words(&one.stability));
        let eigenvalues = eigenvalues_in_words(linear.spectrum.eigenvalues(), 0.0);
        lines.extend(wrapped([energy, "eigenvalues ".to_owned() + &eigenvalues.join(", ")], WIDTH));
        let outputs = linear.outputs.iter().zip(&linear.output_values);
        let outputs: Vec<String> =
            outputs.map(|(name, value)| format!("{name} = {}", rounded(*value))).collect();
        lines.extend(wrapped(outputs, WIDTH));
        lines.extend(family(one));
        text += &labelled(&format!("{number}:"), LABEL, &lines);
    }
    if !found.anywhere.is_empty() {
        text += &labelled("at", LABEL, &wrapped([format!("any {}", found.anywhere.join(", "))], WIDTH));
    }
    let bounds = found.bounds.iter();
    let bounds =
        bounds.map(|(name, low, high)| format!("{name} from {} to {}", short(*low, 4), short(*high, 4)));
    let over: Vec<String> = bounds.collect();
    let over = if over.is_empty() { String::new() } else { format!(" over {}", over.join(", ")) };
    let starts = format!(
        "found from {} starts{over}, of which {} converged; there may be others",
        found.starts, found.converged
    );
    text += &format!("  {starts}\n");
    text
}

fn eigenvalues(one: &FoundEquilibrium) -> impl Iterator<Item = &Eigenvalue> {
    one.linearization.spectrum.eigenvalues().iter()
}

/// The outputs that do not depend on cyclic coordinates.
fn outputs(one: &FoundEquilibrium) -> impl Iterator<Item = (&str, f64)> {
    let Linearization { outputs, output_values, .. } = &one.linearization;
    outputs.iter().map(String::as_str).zip(output_values.iter().copied())
}

fn family(one: &FoundEquilibrium) -> Option<String> {
    let dimensions = match one.family {
        0 => return None,
        1 => "1 dimension".to_owned(),
        n => format!("{n} dimensions"),
    };
    Some(match one.members {
        1 => format!("one of a family of {dimensions}"),
        members => format!("one of a family of {dimensions}, of which {members} were found"),
    })
}

/// The equilibria as one JSON object.
fn json(title: &str, names: &[String], found: &Equilibria) -> Value {
    let one = |one: &FoundEquilibrium| {
        json!({
            "state": map(names.iter().map(String::as_str).zip(one.state.iter().copied())),
            "energy": one.energy,
            "components": one.linearization.components,
            "eigenvalues": eigenvalues(one).map(|l| [l.real, l.imaginary]).collect::<Vec<_>>(),
            "first_approximation": one.linearization.spectrum.verdict().to_string(),
            "verdict": stability_in_words(&one.stability),
            "outputs": map(outputs(one)),
            "family": one.family,
            "members": one.members,
        })
    };
    let bounds = found.bounds.iter().map(|(name, low, high)| (name.clone(), json!([low, high])));
    json!({
        "model": title,
        "equilibria": found.list.iter().map(one).collect::<Value>(),
        "anywhere": found.anywhere,
        "box": bounds.collect::<serde_json::Map<_, _>>(),
        "starts": found.starts,
        "converged": found.converged,
    })
}

/// A line for each equilibrium: its state, energy, verdict and family, and the real and imaginary part of
/// each eigenvalue.
fn csv(names: &[String], found: &Equilibria) -> String {
    let count = found.list.iter().map(|one| eigenvalues(one).count()).max().unwrap_or(0);
    let named: Vec<String> =
        found.list.first().map(|one| one.linearization.outputs.clone()).unwrap_or_default();
    let mut columns = names.to_vec();
    columns.push("energy".to_owned());
    columns.extend(named.iter().cloned());
    columns.extend(["verdict", "family", "members"].map(str::to_owned));
    columns.extend((1..=count).flat_map(|i| [format!("re{i}"), format!("im{i}")]));
    let mut text = header(&columns) + "\n";
    for one in &found.list {
        let output = |name: &String| {
            outputs(one).find(|(known, _)| known == name).map_or(f64::NAN, |(_, value)| value)
        };
        let numbers = one.state.iter().copied().chain([one.energy]).chain(named.iter().map(output));
        let numbers = numbers.map(|value| format!("{value:.16e}"));
        let words =
            [field(&stability_in_words(&one.stability)), one.family.to_string(), one.members.to_string()];
        let parts = (0..count).flat_map(|i| {
            eigenvalues(one).nth(i).map_or([f64::NAN; 2], |value| [value.real, value.imaginary])
        });
        let row: Vec<String> =
            numbers.chain(words).chain(parts.map(|value| format!("{value:.16e}"))).collect();
        text += &row.join(",");
        text.push('\n');
    }
    text
}
