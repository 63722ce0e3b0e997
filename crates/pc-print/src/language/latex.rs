//! The equations for a paper: displays of LaTeX with amsmath.

use std::fmt::Write as _;

use pc_expr::{Names, Style, Written};
use pc_mech::{Expr, Graph};

use crate::equations::constraints::kind_in_words;
use crate::equations::sheet::{Bracket, Sheet};
use crate::layout::layout::Layout;
use crate::layout::part::{Part, Parts, Row};
use crate::layout::remark::remark;
use crate::words::lines::columns;

/// A paragraph with a display for each part of the equations.
pub(crate) fn page(heading: &str, sheet: &Sheet<'_>, layout: &Layout, page: &Graph) -> String {
    let parts = Parts::new(sheet, layout, page, false);
    let mut text = format!("% {heading} (needs amsmath)\n");
    // Long displays go on over the next page.
    text += "\\begingroup\n\\allowdisplaybreaks\n";
    for (part, display) in displays(&sheet.brackets.operators, layout, &parts) {
        let Some(display) = display else { continue };
        let remark = remark(sheet, part.heading).map_or_else(String::new, |remark| format!(" {remark}"));
        // Writing to a string cannot fail.
        let _ = write!(text, "\n\\paragraph{{{}.}}{remark}\n{display}\n", part.heading.text());
    }
    text + "\\endgroup\n"
}

/// The parts, each with its display, except parts that have nothing to display.
pub(crate) fn displays<'a, 'p>(
    operators: &'a [String],
    layout: &'a Layout,
    parts: &'a Parts<'p>,
) -> Vec<(&'a Part<'p>, Option<String>)> {
    let names = &parts.names;
    let latex = Latex {
        operators,
        layout,
        names,
        set: names.written(Style::Latex),
        plain: names.written(Style::Book),
    };
    let display = |(part, numbers): (&'a Part<'p>, Vec<usize>)| {
        let lines: Vec<String> = latex.meanings(&numbers).into_iter().chain(latex.rows(part)).collect();
        (part, (!lines.is_empty()).then(|| aligned(&lines)))
    };
    parts.with_names().map(display).collect()
}

/// Puts lines into an environment that aligns them.
pub(crate) fn aligned(lines: &[String]) -> String {
    format!("\\begin{{align*}}\n{}\n\\end{{align*}}", lines.join(" \\\\\n"))
}

/// The parts of a sheet to typeset, with the names in use.
struct Latex<'a, 'p> {
    /// The names of the quasi-velocities to which operators belong.
    operators: &'a [String],
    layout: &'a Layout,
    names: &'a Names<'p>,
    set: Written,
    /// The expressions of the sheet in plain characters, whose widths decide where lines are broken.
    plain: Written,
}

/// Left-hand sides wider than this are put on a line of their own: all right-hand sides of a display begin
/// after the longest of the others.
const LONG_LEFT: usize = 24;
/// The number of columns by which the continuation of a line is indented.
const HANGING: usize = 6;

/// The line, with large brackets that grow with their contents if they open and close within it.
pub(crate) fn whole(line: String) -> String {
    match (line.matches("\\Bigl(").count(), line.matches("\\Bigr)").count()) {
        (1, 1) => line.replace("\\Bigl(", "\\left(").replace("\\Bigr)", "\\right)"),
        _ => line,
    }
}

/// The operator of a quasi-velocity, or X_0.
fn operator_of(quasi_velocity: Option<&str>) -> String {
    format!("X_{{{}}}", quasi_velocity.unwrap_or("0"))
}

/// Terms as typeset, each with its width in columns when written in plain characters.
type Terms = Vec<(String, usize)>;

impl<'p> Latex<'_, 'p> {
    fn meanings(&self, numbers: &[usize]) -> Vec<String> {
        let meaning = |&number: &usize| {
            let name = &self.names.list()[number];
            let terms = self.set.meaning(name.value).into_iter();
            let widths = self.plain.meaning(name.value);
            let terms = terms.zip(widths.iter().map(|term| columns(term))).collect();
            self.equation(vec![(self.set.name(&name.name), columns(&name.name))], terms)
        };
        numbers.iter().map(meaning).collect()
    }

    fn terms(&self, line: Expr<'p>) -> Terms {
        let widths = self.plain.terms(line);
        self.set.terms(line).into_iter().zip(widths.iter().map(|term| columns(term))).collect()
    }

    fn rows(&self, part: &Part<'p>) -> Vec<String> {
        let rows = part.rows.iter().filter_map(|row| match row {
            Row::Constraint { name, left, kind } => {
                let note = format!("\\quad \\text{{({}, {})}}", in_text(name), kind_in_words(*kind));
                Some(self.vanishing(self.terms(*left)) + &note)
            }
            Row::Equation { left, right } => Some(self.equation(self.terms(*left), self.terms(*right))),
            Row::Function { letter, value } => {
                Some(self.equation(vec![((*letter).to_owned(), 1)], self.terms(*value)))
            }
            Row::Bracket(Bracket { pair: [r, s], components }) => {
                let left = format!("[{}, {}]", self.operator(*r), self.operator(*s));
                let components = components.iter().map(|&(m, c)| (c, self.operator(m)));
                Some(self.equation(vec![(left, 8)], self.combination(components)))
            }
            Row::Symbol { indices, value } => {
                let [r, s, m] = indices
                    .map(|s| s.checked_sub(1).map_or("0".to_owned(), |s| self.set.name(&self.operators[s])));
                Some(self.equation(vec![(format!("\\gamma_{{{r} {s}}}^{{{m}}}"), 4)], self.terms(*value)))
            }
            Row::Operator { quasi_velocity, components } => {
                let left = operator_of(quasi_velocity.as_deref().map(|name| self.set.name(name)).as_deref());
                let components = components
                    .iter()
                    .map(|&(x, c)| (c, format!("\\frac{{\\partial}}{{\\partial {}}}", self.set.text(x))));
                Some(self.equation(vec![(left, 3)], self.combination(components)))
            }
            Row::Force { letter, quasi_velocity, value } => {
                let left = format!("{}_{{{}}}", letter.replace('*', "^{*}"), self.set.name(quasi_velocity));
                Some(self.equation(vec![(left, 3)], self.terms(*value)))
            }
            Row::PartialVelocity { rate, quasi_velocity, value } => {
                let (above, below) = (self.set.text(*rate), self.set.text(*quasi_velocity));
                let left = format!("\\frac{{\\partial {above}}}{{\\partial {below}}}");
                Some(self.equation(vec![(left, 5)], self.terms(*value)))
            }
            Row::Entry { .. } => None,
        });
        rows.collect()
    }

    /// X_0, or the operator of a quasi-velocity.
    fn operator(&self, s: usize) -> String {
        operator_of(s.checked_sub(1).map(|s| self.set.name(&self.operators[s])).as_deref())
    }

    fn combination(&self, sum: impl Iterator<Item = (Expr<'p>, String)>) -> Terms {
        let mut terms = Terms::new();
        for (c, operator) in sum {
            let (set, plain) = (self.set.text(c), self.plain.text(c));
            let is_sum = [" + ", " - "].iter().any(|sign| plain.contains(sign));
            let (sign, size) = match set.strip_prefix('-') {
                Some(size) if !is_sum => ("-", size),
                _ => ("+", set.as_str()),
            };
            let term = match size {
                "1" => operator,
                _ if is_sum => format!("\\left({size}\\right) {operator}"),
                _ => format!("{size} \\, {operator}"), // separated from the argument of a sine
            };
            let sign = match (terms.is_empty(), sign) {
                (true, "+") => "",
                (true, _) => "-",
                (false, "+") => "+ ",
                (false, _) => "- ",
            };
            terms.push((format!("{sign}{term}"), columns(&plain) + 4));
        }
        terms
    }

    /// left = 0
    fn vanishing(&self, left: Terms) -> String {
        let lines: Vec<String> =
            self.flowed(left, HANGING).into_iter().map(|(line, _)| whole(line)).collect();
        match lines.as_slice() {
            [line] => format!("  {line} &= 0"),
            lines => format!("  & {} = 0", lines.join(" \\\\\n    &\\quad ")),
        }
    }

    /// The two sides on as many lines as needed: the right-hand side begins after a short left-hand side, or
    /// otherwise on a separate line.
    fn equation(&self, left: Terms, right: Terms) -> String {
        let width: usize = left.iter().map(|(_, width)| width + 1).sum();
        let joined = |lines: Terms, before: &str| {
            let lines: Vec<String> = lines.into_iter().map(|(line, _)| whole(line)).collect();
            lines.join(&format!(" \\\\\n    {before} "))
        };
        if width <= LONG_LEFT {
            let right = joined(self.flowed(right, width + 3), "&\\quad");
            let left = left.into_iter().map(|(term, _)| term).collect::<Vec<_>>().join(" ");
            return format!("  {} &= {right}", whole(left));
        }
        let whole_width = width + right.iter().map(|(_, width)| width + 1).sum::<usize>() + 2;
        if whole_width <= self.layout.width {
            let side = |terms: Terms| terms.into_iter().map(|(term, _)| term).collect::<Vec<_>>().join(" ");
            return format!("  & {} = {}", whole(side(left)), whole(side(right)));
        }
        let left = joined(self.flowed(left, 0), "&\\quad");
        let right = joined(self.flowed(right, HANGING), "&\\qquad");
        format!("  & {left} \\\\\n    &\\quad = {right}")
    }

    /// The terms arranged in lines, each line with its width in columns.
    fn flowed(&self, terms: Terms, begin: usize) -> Terms {
        let mut lines = Terms::new();
        for (term, width) in terms {
            match lines.last_mut() {
                Some((line, used)) if begin + *used + 1 + width <= self.layout.width => {
                    line.push(' ');
                    line.push_str(&term);
                    *used += width + 1;
                }
                _ => lines.push((term, width)),
            }
        }
        lines
    }
}

/// Words escaped for use within a formula of LaTeX.
pub(crate) fn in_text(words: &str) -> String {
    let mut text = String::with_capacity(words.len());
    for c in words.chars() {
        match c {
            '\\' => text += "\\textbackslash{}",
            '^' => text += "\\textasciicircum{}",
            '~' => text += "\\textasciitilde{}",
            '{' | '}' | '_' | '#' | '$' | '%' | '&' => {
                text.push('\\');
                text.push(c);
            }
            _ => text.push(c),
        }
    }
    text
}
