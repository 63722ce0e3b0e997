//! The table of a sweep: rows of numbers and text, member by member.

use pc_model::Model;
use serde_json::json;

use super::design::Design;
use super::record::Record;

/// The kind of a column.
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
    /// How many values are varied.
    varied: usize,
    /// Numbers of the motion in a row.
    width: usize,
}

impl Sheet {
    /// Number of the member, varied quantities, status, then `motion`, steps and message.
    pub(crate) fn new(design: &Design, motion: &[String]) -> Sheet {
        let numbers = |names: &[String]| names.iter().map(|name| (name.clone(), Kind::Number)).collect();
        let (varied, shown): (Vec<_>, Vec<_>) = (numbers(&design.names()), numbers(motion));
        // Varied quantities and columns of the motion share one namespace in the model, so they
        // need no new names.
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
        Sheet { columns: columns.concat(), varied: design.names().len(), width: motion.len() }
    }

    /// The sheet as text.
    pub(crate) fn to_text(&self) -> String {
        let columns: Vec<_> = self.columns.iter().map(|(name, kind)| json!([name, *kind as u8])).collect();
        json!([self.varied, self.width, columns]).to_string()
    }

    /// The sheet from its text.
    pub(crate) fn from_text(text: &str) -> Option<Sheet> {
        let (varied, width, columns): (usize, usize, Vec<(String, u8)>) = serde_json::from_str(text).ok()?;
        let kind = |kind| match kind {
            0 => Some(Kind::Integer),
            1 => Some(Kind::Number),
            2 => Some(Kind::Text),
            _ => None,
        };
        let columns: Option<Vec<_>> = columns.into_iter().map(|(name, k)| Some((name, kind(k)?))).collect();
        // member, varied quantities, status, the motion, steps and message
        columns.filter(|all| all.len() == varied + width + 4 && width > 0).map(|columns| Sheet {
            columns,
            varied,
            width,
        })
    }

    /// Names of the varied quantities.
    pub(crate) fn varied(&self) -> impl Iterator<Item = &str> {
        self.columns[1..=self.varied].iter().map(|(name, _)| name.as_str())
    }

    /// Names of the columns of the motion.
    pub(crate) fn motion_names(&self) -> Vec<&str> {
        let from = self.varied + 2;
        self.columns[from..from + self.width].iter().map(|(name, _)| name.as_str()).collect()
    }

    /// The columns of a motion of a model: those of `pc run`, with the drifts of the integrals and
    /// the energy if wanted.
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
