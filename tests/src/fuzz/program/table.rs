//! Tables that the program writes.

/// Names and numbers; what is no number in a column of words is NaN.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Table {
    pub(super) columns: Vec<String>,
    pub(super) rows: Vec<Vec<f64>>,
    /// The same fields as they are written.
    pub(super) words: Vec<Vec<String>>,
}

/// Columns of words in a table of members.
const WORDS: [&str; 2] = ["status", "message"];

impl Table {
    /// The table of a text.
    ///
    /// # Errors
    /// What is wrong where it is none: a row of another length than the names, or a number that is none.
    pub(super) fn of(text: &str) -> Result<Table, String> {
        let mut lines = text.lines();
        let columns = fields(lines.next().unwrap_or_default());
        let mut table = Table { columns, rows: Vec::new(), words: Vec::new() };
        for line in lines {
            let words = fields(line);
            if words.len() != table.columns.len() {
                return Err(format!("{} names, but {} numbers: {line}", table.columns.len(), words.len()));
            }
            table.rows.push(words.iter().map(|word| word.parse().unwrap_or(f64::NAN)).collect());
            table.words.push(words);
        }
        if table.rows.is_empty() { Err(format!("no rows: {text}")) } else { Ok(table) }
    }

    /// The number of a column.
    pub(super) fn place(&self, column: &str) -> Option<usize> {
        self.columns.iter().position(|name| name == column)
    }

    /// A word of a row.
    pub(super) fn word(&self, row: usize, column: &str) -> Option<&str> {
        Some(&self.words[row][self.place(column)?])
    }

    /// The first entry that is no number, in rows that are wanted.
    pub(super) fn not_a_number(&self, wanted: impl Fn(usize) -> bool) -> Option<String> {
        for (i, row) in self.rows.iter().enumerate().filter(|(i, _)| wanted(*i)) {
            let numbers = self.columns.iter().zip(row).filter(|(name, _)| !WORDS.contains(&name.as_str()));
            if let Some((name, number)) = numbers.into_iter().find(|(_, number)| !number.is_finite()) {
                return Some(format!("{name} is {number} in row {i}"));
            }
        }
        None
    }
}

/// The fields of a line; those in quotes may contain commas.
fn fields(line: &str) -> Vec<String> {
    let mut fields = vec![String::new()];
    let mut quoted = false;
    for c in line.chars() {
        match c {
            '"' => quoted = !quoted,
            ',' if !quoted => fields.push(String::new()),
            c => fields.last_mut().into_iter().for_each(|field| field.push(c)),
        }
    }
    fields
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_has_as_many_numbers_as_names() {
        let table = Table::of("t,x,message\n0,1.5,\n1,2,\"a, b\"\n").expect("a table");
        assert_eq!(table.rows[1][..2], [1.0, 2.0]);
        assert_eq!(table.word(1, "message"), Some("a, b"));
        assert_eq!(table.not_a_number(|_| true), None);
        assert!(Table::of("t,x\n0,1,2\n").is_err_and(|error| error.starts_with("2 names, but 3 numbers")));
        assert!(Table::of("t,x\n").is_err());
    }

    #[test]
    fn what_is_no_number_is_named_in_rows_that_are_wanted() {
        let table = Table::of("t,x\n0,1\n1,NaN\n").expect("a table");
        assert_eq!(table.not_a_number(|_| true), Some("x is NaN in row 1".to_owned()));
        assert_eq!(table.not_a_number(|row| row < 1), None);
    }
}
