//! Two motions, compared column by column.

use crate::compare::difference::{Allowance, Difference};
use crate::compare::error::CompareError;
use crate::compare::formula::Formula;
use crate::motion::run::{Ending, Run};

/// The column that nearly any two motions have in common.
const ENERGY: &str = "energy";

/// What to compare, and how closely.
#[derive(Clone, Debug, PartialEq)]
pub struct Question {
    /// The difference allowed.
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
    /// The difference allowed.
    pub allowance: Allowance,
    /// The number of times at which the motions are compared.
    pub rows: usize,
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
    /// Compares two runs at the times that both have. If `finer` contains both runs at smaller tolerances, twice the resulting
    /// changes are allowed in addition: they are errors of integration, which may have grown along the motion.
    ///
    /// # Errors
    /// [`CompareError`] if there is nothing to compare, or a name is unknown.
    pub fn new(
        first: &Run,
        second: &Run,
        finer: Option<(&Run, &Run)>,
        question: &Question,
    ) -> Result<Comparison, CompareError> {
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
        let is_wanted = |name: &&String| question.columns.is_empty() || question.columns.contains(name);
        let difference = |name: &str, [a, b]: [Vec<f64>; 2], finer: Option<[Vec<f64>; 2]>| {
            let uncertain = finer.map_or_else(Vec::new, |[c, d]| uncertain([&a, &b], [&c, &d]));
            let values: Vec<_> = times.iter().zip(a.iter().zip(&b)).map(|(&t, (&a, &b))| (t, a, b)).collect();
            Difference::new(name.to_owned(), &values, allowance, &uncertain)
        };
        let mut differences = Vec::new();
        for name in shared.iter().filter(is_wanted) {
            let both = |(a, b): (&Run, &Run)| [column(a, name), column(b, name)];
            let found = difference(name, both((first, second)), finer.map(both));
            // Lagrangians that differ by a constant or a factor give the same motion but different
            // energies.
            let is_aside = name == ENERGY && question.columns.is_empty();
            differences.push(if is_aside { found.aside() } else { found });
        }
        for (label, a, b) in &pairs {
            let both = |(first, second): (&Run, &Run)| Ok([a.column(first)?, b.column(second)?]);
            differences.push(difference(label, both((first, second))?, finer.map(both).transpose()?));
        }
        let without = |names: &[String], others: &[String]| -> Vec<String> {
            names.iter().filter(|name| !others.contains(name)).cloned().collect()
        };
        Ok(Comparison {
            allowance,
            rows: times.len(),
            until: times.last().copied().unwrap_or(first.plan.t_start),
            differences,
            only_first: without(names, others),
            only_second: without(others, names),
            ends: ends(first, second, allowance),
        })
    }

    /// Whether nothing differs by more than the allowed amount.
    pub fn is_same(&self) -> bool {
        self.ends.is_none() && self.differences.iter().all(Difference::is_allowed)
    }
}

/// For each time, twice the largest change up to that time that smaller tolerances make in the two columns together; infinite
/// from the first row that is missing at smaller tolerances.
fn uncertain(columns: [&[f64]; 2], finer: [&[f64]; 2]) -> Vec<f64> {
    let rows = columns[0].len().min(columns[1].len());
    let change = |i: usize| -> f64 {
        columns
            .iter()
            .zip(&finer)
            .map(|(column, finer)| match finer.get(i) {
                Some(finer) if column[i].is_finite() => (column[i] - finer).abs(),
                Some(_) => 0.0,
                None => f64::INFINITY,
            })
            .sum()
    };
    let mut most = 0.0f64;
    (0..rows)
        .map(|i| {
            most = most.max(2.0 * change(i));
            most
        })
        .collect()
}

/// The expressions that are compared, with their labels.
fn pairs(question: &Question) -> Result<Vec<(String, Formula, Formula)>, CompareError> {
    let pair = |(first, second): &(String, String)| {
        Ok((format!("{first} = {second}"), Formula::new(first)?, Formula::new(second)?))
    };
    question.pairs.iter().map(pair).collect()
}

fn column(run: &Run, name: &str) -> Vec<f64> {
    let place = run.table.columns().iter().position(|column| column == name);
    place.map_or_else(Vec::new, |j| run.table.column(j).collect())
}

/// A phrase that says how the ends of the motions differ, if they do.
fn ends(first: &Run, second: &Run, allowance: Allowance) -> Option<String> {
    let (a, b) = (first.reached(), second.reached());
    let is_event = |run: &Run| matches!(run.ending, Ending::Event { .. });
    let allowed = if is_event(first) && is_event(second) { allowance.at(a.abs().max(b.abs())) } else { 0.0 };
    if is_event(first) == is_event(second) && (a - b).abs() <= allowed {
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
