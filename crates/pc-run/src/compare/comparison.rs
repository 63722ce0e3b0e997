//! Two motions, compared column by column.

use crate::compare::difference::{Allowance, Difference, Verdict};
use crate::compare::error::CompareError;
use crate::compare::events::{between_events, ends_allowed};
use crate::compare::formula::Formula;
use crate::compare::known::Known;
use crate::motion::run::{Ending, Run};
use crate::motion::table::Table;

/// The column that nearly any two motions have in common.
const ENERGY: &str = "energy";

/// What to compare, and how closely.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Question {
    /// The difference allowed in addition to errors of integration.
    pub allowance: Allowance,
    /// The columns to compare; if empty, all columns that both motions have.
    pub columns: Vec<String>,
    /// Expressions in the columns and parameters of the first motion, each paired with one in those of the
    /// second.
    pub pairs: Vec<(String, String)>,
}

/// How two motions agree and differ.
#[derive(Debug)]
pub struct Comparison {
    /// The difference allowed in addition to errors of integration.
    pub allowance: Allowance,
    /// The number of times at which the motions are compared.
    pub rows: usize,
    /// The number of times that are left out, since an event has happened in one motion and not yet in another.
    pub left_out: usize,
    /// The last time at which the motions are compared.
    pub until: f64,
    /// The difference of each column that is compared.
    pub differences: Vec<Difference>,
    /// Columns that only the first motion has.
    pub only_first: Vec<String>,
    /// Columns that only the second motion has.
    pub only_second: Vec<String>,
    /// A phrase that says how the ends of the motions differ, if they do.
    pub ends: Option<String>,
}

impl Comparison {
    /// Compares two runs at the times that both have, by what each run knows [of its
    /// accuracy](crate::motion::integrate::Besides::accuracy).
    ///
    /// # Errors
    /// [`CompareError`] if there is nothing to compare, or a name is unknown.
    pub fn new(first: &Run, second: &Run, question: &Question) -> Result<Comparison, CompareError> {
        let allowance = question.allowance;
        let times: Vec<f64> = (first.table.column(0).zip(second.table.column(0)))
            .take_while(|(a, b)| a == b)
            .map(|(t, _)| t)
            .collect();
        let (names, others) = (&first.table.columns()[1..], &second.table.columns()[1..]);
        let shared: Vec<String> = names.iter().filter(|name| others.contains(name)).cloned().collect();
        let pairs = pairs(question)?;
        if let Some(name) = question.columns.iter().find(|name| !shared.contains(name)) {
            return Err(CompareError::NotShared { name: name.clone(), shared });
        }
        if question.columns.is_empty() && pairs.is_empty() && shared.iter().all(|name| name == ENERGY) {
            return Err(CompareError::NothingShared { first: names.to_vec(), second: others.to_vec() });
        }
        let wanted = if question.columns.is_empty() { &shared } else { &question.columns };
        let left_out = between_events([first, second], &times);
        let difference = |name: &str, a: &Known, b: &Known| {
            Difference::new(name.to_owned(), &times, [a, b], &left_out, allowance)
        };
        let mut differences = Vec::new();
        for name in wanted {
            let of = |run: &Run| Known::of(run, |table| column(table, name));
            let found = difference(name, &of(first)?, &of(second)?);
            // Lagrangians that differ by a constant or a factor give the same motion but different
            // energies.
            let is_aside = name == ENERGY && question.columns.is_empty();
            differences.push(if is_aside { found.aside() } else { found });
        }
        for (label, a, b) in &pairs {
            let of = |run: &Run, formula: &Formula| Known::of(run, |table| formula.column(run, table));
            differences.push(difference(label, &of(first, a)?, &of(second, b)?));
        }
        let without = |names: &[String], others: &[String]| -> Vec<String> {
            names.iter().filter(|name| !others.contains(name)).cloned().collect()
        };
        let left_out = left_out.iter().filter(|is_out| **is_out).count();
        Ok(Comparison {
            allowance,
            rows: times.len() - left_out,
            left_out,
            until: times.last().copied().unwrap_or(first.plan.t_start),
            differences,
            only_first: without(names, others),
            only_second: without(others, names),
            ends: ends(first, second, allowance),
        })
    }

    /// What the differences that count, and the ends, say together.
    pub fn verdict(&self) -> Verdict {
        let says = |verdict: Verdict| {
            self.differences.iter().any(|found| found.counts && found.verdict() == verdict)
        };
        match (self.ends.is_some() || says(Verdict::Different), says(Verdict::Undecided)) {
            (true, _) => Verdict::Different,
            (false, true) => Verdict::Undecided,
            (false, false) => Verdict::Same,
        }
    }
}

/// The expressions that are compared, with their labels.
fn pairs(question: &Question) -> Result<Vec<(String, Formula, Formula)>, CompareError> {
    let pair = |(first, second): &(String, String)| {
        Ok((format!("{first} = {second}"), Formula::new(first)?, Formula::new(second)?))
    };
    question.pairs.iter().map(pair).collect()
}

/// The column of a table, which has it.
fn column(table: &Table, name: &str) -> Result<Vec<f64>, CompareError> {
    let place = table.columns().iter().position(|column| column == name);
    Ok(place.map_or_else(Vec::new, |j| table.column(j).collect()))
}

/// A phrase that says how the ends of the motions differ, if they do.
fn ends(first: &Run, second: &Run, allowance: Allowance) -> Option<String> {
    let (a, b) = (first.reached(), second.reached());
    let is_event = |run: &Run| matches!(run.ending, Ending::Event { .. });
    let allowed = || allowance.at(a.abs().max(b.abs())) + ends_allowed([first, second]);
    if is_event(first) == is_event(second) && (a == b || (is_event(first) && (a - b).abs() <= allowed())) {
        return None;
    }
    Some(format!("A {}, B {}", ending(first), ending(second)))
}

/// A phrase that says how a motion ended.
pub(super) fn ending(run: &Run) -> String {
    let t = run.reached();
    match &run.ending {
        Ending::Event { name } => format!("is ended by the event {name} at t = {t}"),
        Ending::Completed => format!("goes on to t = {t}"),
        ending => format!("{} at t = {t}", ending.word()),
    }
}
