//! The table of a sweep: rows of numbers and text, member by member.

use pc_model::Model;

use super::design::Design;
use super::record::Record;

/// What stands in a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Integer,
    Number,
    Text,
}

/// An entry of the table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Cell<'a> {
    Integer(u64),
    Number(f64),
    Text(&'a str),
}

/// The columns.
#[derive(Clone, Debug)]
pub(crate) struct Sheet {
    columns: Vec<(String, Kind)>,
    /// Numbers in a row that are of the motion.
    width: usize,
}

impl Sheet {
    /// Number of the member, what is varied, how it ended, then `motion`, steps and message.
    pub(crate) fn new(design: &Design, motion: &[String]) -> Sheet {
        let numbers = |names: &[String]| names.iter().map(|name| (name.clone(), Kind::Number)).collect();
        let (varied, shown): (Vec<_>, Vec<_>) = (numbers(&design.names()), numbers(motion));
        // What is varied and shown is the same, as a parameter that is an integral would be: names are of one space.
        let taken: Vec<String> = varied.iter().chain(&shown).map(|(name, _)| name.clone()).collect();
        let free = |name: &str, kind| {
            let mut name = name.to_owned();
            while taken.contains(&name) {
                name.push('_');
            }
            vec![(name, kind)]
        };
        let columns = [
            free("member", Kind::Integer),
            varied,
            free("status", Kind::Text),
            shown,
            free("steps", Kind::Integer),
            free("message", Kind::Text),
        ];
        Sheet { columns: columns.concat(), width: motion.len() }
    }

    /// The columns of a motion of a model: those of `pc run`, with the drifts of what should be constant if these are
    /// wanted.
    pub(crate) fn motion(model: &Model, drifts: bool) -> Vec<String> {
        let document = model.document();
        let named = |list: &[pc_model::document::NamedExpression]| {
            list.iter().map(|item| item.name.text.clone()).collect::<Vec<_>>()
        };
        let energy = || vec!["energy".to_owned()];
        let mut columns = vec!["t".to_owned()];
        columns.extend(model.start_names());
        columns.extend([named(&document.integrals), energy(), named(&document.outputs)].concat());
        if drifts {
            let kept = [named(&document.integrals), energy()].concat();
            columns.extend(kept.iter().map(|name| format!("drift({name})")));
        }
        columns
    }

    /// Names and kinds.
    pub(crate) fn columns(&self) -> &[(String, Kind)] {
        &self.columns
    }

    /// The rows of a member, at least one.
    pub(crate) fn rows<'r>(&self, record: &'r Record) -> impl Iterator<Item = Vec<Cell<'r>>> {
        record.rows.chunks_exact(self.width).map(|row| {
            let mut cells = vec![Cell::Integer(record.member)];
            cells.extend(record.values.iter().copied().map(Cell::Number));
            cells.push(Cell::Text(record.status.word()));
            cells.extend(row.iter().copied().map(Cell::Number));
            cells.push(Cell::Integer(record.steps));
            cells.push(Cell::Text(&record.message));
            cells
        })
    }
}
