//! Equations as text, as a book prints them.

use pc_expr::{Names, Style, Written};
use pc_mech::{Expr, Graph};

use crate::equations::constraints::kind_in_words;
use crate::equations::operations::Operations;
use crate::equations::sheet::{Balance, Bracket, Brackets, Sheet};
use crate::layout::layout::Layout;
use crate::layout::part::{Heading, Part, Parts, Row, entry_name};
use crate::layout::remark::remark;
use crate::words::lines::{columns, combined};

/// Matrices wider than this, in columns, are written entry by entry.
const WIDEST_MATRIX: usize = 96;
/// The indentation under a heading.
const INDENT: usize = 2;

/// The equations as a book prints them, with the cost of a right-hand side.
pub(crate) fn page(sheet: &Sheet<'_>, operations: &Operations, layout: &Layout, page: &Graph) -> String {
    let layout = Layout { width: layout.width.saturating_sub(INDENT), ..*layout };
    let parts = Parts::new(sheet, &layout, page, true);
    let text = Text { sheet, layout, names: &parts.names, written: parts.names.written(Style::Book) };
    let mut sections: Vec<(&str, Vec<String>)> = parts
        .with_names()
        .map(|(part, names)| {
            let lines = text.meanings(&names).into_iter().chain(text.rows(part));
            (part.heading.text(), lines.collect())
        })
        .collect();
    let cost = match &sheet.balance {
        Balance::Momenta { velocities: None, .. } => {
            "Operations of one right-hand side, quasi-velocities known"
        }
        _ => "Operations of one right-hand side",
    };
    let operations = operations.lines().into_iter().flat_map(|line| {
        let terms: Vec<String> = line.split(" + ").map(str::to_owned).collect();
        let (first, rest) = terms.split_at(1);
        let rest = rest.iter().map(|term| format!("+ {term}"));
        text.layout.flowed("", &first.iter().cloned().chain(rest).collect::<Vec<_>>())
    });
    sections.push((cost, operations.collect()));
    self::sections(&sections)
}

/// A heading, underlined.
pub(crate) fn underlined(heading: &str) -> String {
    format!("{heading}\n{}\n\n", "=".repeat(columns(heading)))
}

/// Titles, each with its lines below; titles without lines are left out.
fn sections(parts: &[(&str, Vec<String>)]) -> String {
    let section = |(title, lines): &(&str, Vec<String>)| {
        let lines: String = lines.iter().map(|line| format!("{:INDENT$}{line}\n", "")).collect();
        format!("{title}\n{lines}")
    };
    let written: Vec<String> = parts.iter().filter(|(_, lines)| !lines.is_empty()).map(section).collect();
    written.join("\n")
}

/// The contents of a sheet as text, with the names in use.
struct Text<'a, 'p> {
    sheet: &'a Sheet<'p>,
    layout: Layout,
    names: &'a Names<'p>,
    written: Written,
}

impl<'p> Text<'_, 'p> {
    /// The lines that define names.
    fn meanings(&self, numbers: &[usize]) -> Vec<String> {
        if self.layout.brief {
            return Vec::new();
        }
        let names = numbers.iter().map(|&number| &self.names.list()[number]);
        let meanings: Vec<_> =
            names.map(|name| (vec![name.name.clone()], self.written.meaning(name.value))).collect();
        self.layout.aligned(&meanings)
    }

    fn rows(&self, part: &Part<'p>) -> Vec<String> {
        match part.heading {
            Heading::Brackets => self.brackets(part),
            Heading::HamelSymbols => self.symbols(part),
            Heading::MassMatrix => self.mass_matrix(part),
            _ => {
                let equations: Vec<_> = part.rows.iter().filter_map(|row| self.equation(row)).collect();
                let others = part.rows.iter().flat_map(|row| self.alone(row));
                let remark = remark(self.sheet, part.heading).map(|remark| format!("({remark})"));
                self.layout.aligned(&equations).into_iter().chain(others).chain(remark).collect()
            }
        }
    }

    fn equation(&self, row: &Row<'p>) -> Option<(Vec<String>, Vec<String>)> {
        match row {
            Row::Equation { left, right } => Some((self.written.terms(*left), self.written.terms(*right))),
            Row::Force { letter, quasi_velocity, value } => {
                Some((vec![format!("{letter}({quasi_velocity})")], self.written.terms(*value)))
            }
            Row::PartialVelocity { rate, quasi_velocity, value } => {
                Some((vec![format!("∂{rate}/∂{quasi_velocity}")], self.written.terms(*value)))
            }
            _ => None,
        }
    }

    fn alone(&self, row: &Row<'p>) -> Vec<String> {
        match row {
            Row::Constraint { name, left, kind } => {
                let mut terms = self.written.terms(*left);
                terms.push(format!("= 0   ({})", kind_in_words(*kind)));
                self.layout.flowed(&format!("{name}: "), &terms)
            }
            Row::Function { value, .. } => self.layout.flowed("", &self.written.terms(*value)),
            Row::Equation { .. }
            | Row::Bracket(_)
            | Row::Symbol { .. }
            | Row::Operator { .. }
            | Row::Force { .. }
            | Row::PartialVelocity { .. }
            | Row::Entry { .. } => Vec::new(),
        }
    }

    /// The brackets, in terms of the names of the quasi-velocities, with `t` for time; they may have
    /// components along vanishing quasi-velocities.
    fn brackets(&self, part: &Part<'p>) -> Vec<String> {
        let mut lines: Vec<String> = part
            .rows
            .iter()
            .filter_map(|row| match row {
                Row::Bracket(Bracket { pair: [r, s], components }) => {
                    let terms =
                        components.iter().map(|&(m, c)| (self.written.text(c), self.operator(m).to_owned()));
                    let head = format!("[{}, {}] = ", self.operator(*r), self.operator(*s));
                    Some(self.layout.flowed(&head, &combined(terms)))
                }
                _ => None,
            })
            .flatten()
            .collect();
        if let Some(known) = self.sheet.brackets.algebra.filter(|_| !lines.is_empty()) {
            lines.push(format!("the algebra {known}"));
        }
        if lines.is_empty() {
            lines.push(no_brackets(&self.sheet.brackets).to_owned());
        } else if self.sheet.brackets.left_out {
            lines.push(format!("({LEFT_OUT})"));
        }
        lines
    }

    /// The name of an operator: that of its quasi-velocity, or `t` for X_0.
    fn operator(&self, s: usize) -> &str {
        s.checked_sub(1).map_or("t", |s| self.sheet.brackets.operators[s].as_str())
    }

    fn symbols(&self, part: &Part<'p>) -> Vec<String> {
        let symbols = part.rows.iter().filter_map(|row| match row {
            &Row::Symbol { indices, value } => {
                let [r, s, m] = indices.map(|s| self.operator(s));
                Some((vec![format!("γ({r}, {s}; {m})")], self.written.terms(value)))
            }
            _ => None,
        });
        let mut lines = self.layout.aligned(&symbols.collect::<Vec<_>>());
        lines.push("(γ(r, s; m) = c_rs^m, antisymmetric in r and s)".to_owned());
        lines.extend(self.sheet.brackets.left_out.then(|| format!("({LEFT_OUT})")));
        lines
    }

    fn mass_matrix(&self, part: &Part<'p>) -> Vec<String> {
        let entries: Vec<([usize; 2], Expr<'p>)> = part
            .rows
            .iter()
            .filter_map(|row| match row {
                Row::Entry { place, value } => Some((*place, *value)),
                _ => None,
            })
            .collect();
        let k = self.sheet.quasi_velocities.len();
        let named = |place| {
            let name = entry_name(self.sheet, place);
            self.names.list().iter().any(|used| used.shorthand && used.name == name)
        };
        if !entries.iter().any(|&(place, _)| named(place)) {
            if entries.iter().all(|([r, s], _)| r == s) {
                let mut diagonal = vec!["0".to_owned(); k];
                entries.iter().for_each(|&([r, _], value)| diagonal[r] = self.written.line(value));
                let line = format!("diag({})", diagonal.join(", "));
                if columns(&line) <= self.layout.width {
                    return vec![line];
                }
            } else if k <= WIDEST_MATRIX {
                let mut cells = vec![vec!["0".to_owned(); k]; k];
                for &([r, s], value) in &entries {
                    cells[r][s] = self.written.line(value);
                    cells[s][r] = cells[r][s].clone();
                }
                if let Some(lines) = matrix(&cells) {
                    return lines;
                }
            }
        }
        let entry = |&(place, value): &([usize; 2], Expr<'p>)| {
            (vec![entry_name(self.sheet, place)], self.written.terms(value))
        };
        self.layout.aligned(&entries.iter().map(entry).collect::<Vec<_>>())
    }
}

/// The line printed if all brackets within the frame are zero.
pub(crate) fn no_brackets(brackets: &Brackets<'_>) -> &'static str {
    if brackets.commute {
        "all operators commute"
    } else {
        "only along the constraints, which are not integrable: these components are left out"
    }
}

/// The remark on brackets of which only the components within the frame are printed.
pub(crate) const LEFT_OUT: &str = "components along the constraints are left out";

/// A matrix row by row, with aligned columns, if it is not too wide.
fn matrix(cells: &[Vec<String>]) -> Option<Vec<String>> {
    let k = cells.len();
    let widths: Vec<usize> =
        (0..k).map(|s| cells.iter().map(|row| columns(&row[s])).max().unwrap_or(0)).collect();
    let line = |row: &Vec<String>| {
        let cells: Vec<String> =
            row.iter().zip(&widths).map(|(cell, &width)| format!("{cell:width$}")).collect();
        format!("[ {} ]", cells.join("   "))
    };
    (widths.iter().sum::<usize>() + 3 * k <= WIDEST_MATRIX).then(|| cells.iter().map(line).collect())
}
