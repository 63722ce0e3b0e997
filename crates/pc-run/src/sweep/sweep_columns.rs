//! The table of a sweep: rows of numbers and text, member by member.

use std::io;

use serde_json::json;

use super::of::SweepOf;
use super::record::Record;
use crate::table::rows::{Cell, CellKind, Column};

/// A record that does not consist of whole rows: its names and numbers come from different tables.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "member {member} has {} varied values, {} numbers and {} words, which do not fill rows of {}, {} and {}; no table is written, because this is a defect of this program",
    found[0], found[1], found[2], columns[0], columns[1], columns[2]
)]
pub struct Misshapen {
    /// The member.
    pub member: u64,
    /// How many varied values, numbers and words the record has.
    pub found: [usize; 3],
    /// How many varied values, numbers and words belong to one row.
    pub columns: [usize; 3],
}

/// The columns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SweepColumns {
    of: SweepOf,
    columns: Vec<Column>,
    /// How many columns are varied quantities.
    varied: usize,
    /// How many columns are results.
    results: usize,
}

impl SweepColumns {
    /// The columns of a sweep: the number of the member, the varied quantities, how the member ended, then
    /// `results`, the steps of a motion, and a message.
    pub(crate) fn new(of: SweepOf, names: &[String], results: &[Column]) -> SweepColumns {
        let varied: Vec<Column> = names.iter().map(|name| Column::new(name, CellKind::Number)).collect();
        // What is varied and shown is the same, as a parameter that is an integral would be: names are of one space.
        let taken: Vec<&str> = varied.iter().chain(results).map(|column| column.name.as_str()).collect();
        let free = |name: &str, kind| {
            let mut name = name.to_owned();
            while taken.contains(&name.as_str()) {
                name.push('_');
            }
            vec![Column::new(name, kind)]
        };
        let steps = if of == SweepOf::Run { free("steps", CellKind::Integer) } else { Vec::new() };
        let (member, status) = (free("member", CellKind::Integer), free("status", CellKind::Text));
        let message = free("message", CellKind::Text);
        let columns = [member, varied.clone(), status, results.to_vec(), steps, message].concat();
        SweepColumns { of, columns, varied: varied.len(), results: results.len() }
    }

    /// What is computed for each member.
    pub(crate) fn of(&self) -> SweepOf {
        self.of
    }

    /// The columns as text.
    pub(crate) fn to_text(&self) -> String {
        let columns: Vec<_> =
            self.columns.iter().map(|column| json!([column.name, column.kind as u8])).collect();
        json!([self.of.word(), self.varied, self.results, columns]).to_string()
    }

    /// Reads columns from their text.
    pub(crate) fn from_text(text: &str) -> Option<SweepColumns> {
        type Parts = (String, usize, usize, Vec<(String, u8)>);
        let (of, varied, results, columns): Parts = serde_json::from_str(text).ok()?;
        let of = SweepOf::of_word(&of)?;
        let kind = |kind| match kind {
            0 => Some(CellKind::Integer),
            1 => Some(CellKind::Number),
            2 => Some(CellKind::Text),
            _ => None,
        };
        let columns: Option<Vec<_>> =
            columns.into_iter().map(|(name, k)| Some(Column::new(name, kind(k)?))).collect();
        // member, what is varied, status, results, steps, message
        let others = if of == SweepOf::Run { 4 } else { 3 };
        let all = varied.checked_add(results)?.checked_add(others)?;
        let columns = columns.filter(|columns| columns.len() == all && results > 0)?;
        Some(SweepColumns { of, columns, varied, results })
    }

    /// The names of the varied quantities.
    pub(crate) fn varied(&self) -> impl Iterator<Item = &str> {
        self.columns[1..=self.varied].iter().map(|column| column.name.as_str())
    }

    /// Whether column number `j` tells rows apart: the member, what is varied, and the time of a row.
    pub(crate) fn tells_rows_apart(&self, j: usize) -> bool {
        let is_time = self.of == SweepOf::Run && j == self.varied + 2;
        j <= self.varied || is_time
    }

    /// The columns of results.
    fn results(&self) -> &[Column] {
        let from = self.varied + 2;
        &self.columns[from..from + self.results]
    }

    /// The names of those results that are numbers.
    pub(crate) fn numbers(&self) -> Vec<&str> {
        let numbers = self.results().iter().filter(|column| column.kind == CellKind::Number);
        numbers.map(|column| column.name.as_str()).collect()
    }

    /// All columns.
    pub(crate) fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// An error unless the numbers and words of a member fill one or more whole rows.
    ///
    /// # Errors
    /// [`Misshapen`]
    pub(crate) fn check(&self, record: &Record) -> Result<(), Misshapen> {
        let words = self.results().iter().filter(|column| column.kind == CellKind::Text).count();
        let numbers = self.results().len() - words;
        let rows = |found: usize, columns: usize| match (columns, found) {
            (0, 0) => Some(None),
            (0, _) => None,
            _ => (found > 0 && found.is_multiple_of(columns)).then_some(Some(found / columns)),
        };
        let of_both = (rows(record.rows.len(), numbers), rows(record.words.len(), words));
        let is_whole = match of_both {
            (Some(Some(a)), Some(Some(b))) => a == b,
            (Some(_), Some(_)) => true,
            _ => false,
        };
        let is_varied = record.values.len() == self.varied;
        (is_whole && is_varied).then_some(()).ok_or(Misshapen {
            member: record.member,
            found: [record.values.len(), record.rows.len(), record.words.len()],
            columns: [self.varied, numbers, words],
        })
    }

    /// The rows of a member, of which there is at least one.
    ///
    /// # Errors
    /// [`Misshapen`], as [`io::ErrorKind::InvalidData`].
    pub(crate) fn rows<'r>(&self, record: &'r Record) -> io::Result<impl Iterator<Item = Vec<Cell<'r>>>> {
        self.check(record).map_err(|error| io::Error::new(io::ErrorKind::InvalidData, error))?;
        let (mut numbers, mut words) = (record.rows.iter(), record.words.iter());
        let mut result = move |column: &Column| match column.kind {
            CellKind::Text => words.next().map(|word| Cell::Text(word)),
            CellKind::Number | CellKind::Integer => numbers.next().map(|&number| Cell::Number(number)),
        };
        Ok(std::iter::from_fn(move || {
            let mut cells = vec![Cell::Integer(record.member)];
            cells.extend(record.values.iter().copied().map(Cell::Number));
            cells.push(Cell::Text(record.status.word()));
            for column in self.results() {
                cells.push(result(column)?);
            }
            if self.of == SweepOf::Run {
                cells.push(Cell::Integer(record.steps));
            }
            cells.push(Cell::Text(&record.message));
            Some(cells)
        }))
    }
}
