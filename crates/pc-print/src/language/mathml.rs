//! The equations for a browser: tables of MathML, with lines broken as in LaTeX.

use pc_expr::{Names, Style, Written};
use pc_mech::Expr;

use crate::equations::sheet::Bracket;
use crate::layout::layout::Layout;
use crate::layout::part::{Part, Parts, Row};
use crate::words::lines::columns;

/// d/dt of the expression that follows.
pub(crate) const RATE: &str =
    "<mfrac><mi>d</mi><mrow><mi>d</mi><mi>t</mi></mrow></mfrac><mspace width=\"0.17em\"/>";
const MINUS: &str = "<mo>−</mo>";
const EQUALS: &str = "<mo>=</mo>";
const THIN: &str = "<mspace width=\"0.17em\"/>";

/// Left-hand sides wider than this are put on a line of their own.
const LONG_LEFT: usize = 24;
/// The number of columns by which the continuation of a line is indented.
const HANGING: usize = 6;

/// Terms as typeset, each with its width in columns when written in plain characters.
pub(crate) type Terms = Vec<(String, usize)>;

/// The two sides of an equation, each a row of MathML: elements side by side.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DisplayedEquation {
    /// The left-hand side.
    pub left: String,
    /// The right-hand side.
    pub right: String,
}

impl DisplayedEquation {
    fn of((left, right): &(Terms, Terms)) -> DisplayedEquation {
        let row = |terms: &Terms| terms.iter().map(|(term, _)| term.as_str()).collect();
        DisplayedEquation { left: row(left), right: row(right) }
    }
}

/// The equations of a part.
pub(crate) struct Displayed {
    /// All equations as one formula, with lines broken as in LaTeX.
    pub(crate) table: String,
    /// The meanings of the names that are first used here.
    pub(crate) names: Vec<DisplayedEquation>,
    /// The equations themselves.
    pub(crate) equations: Vec<DisplayedEquation>,
}

/// Text for use between elements, with its markup characters escaped.
pub(crate) fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => safe += "&amp;",
            '<' => safe += "&lt;",
            '>' => safe += "&gt;",
            '"' => safe += "&quot;",
            '\'' => safe += "&#39;",
            c if c.is_whitespace() => safe.push(' '),
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => safe.push('\u{fffd}'),
            c => safe.push(c),
        }
    }
    safe
}

/// A row enclosed in brackets.
pub(crate) fn bracketed(row: &str) -> String {
    format!("<mrow><mo>(</mo>{row}<mo>)</mo></mrow>")
}

/// ∂/∂x
pub(crate) fn partial(x: &str) -> String {
    format!("<mfrac><mi>∂</mi><mrow><mi>∂</mi>{x}</mrow></mfrac>")
}

/// X_s, with the name of η_s as its index.
pub(crate) fn operator(eta: &str) -> String {
    format!("<msub><mi>X</mi>{eta}</msub>")
}

/// The terms of a linear combination; each is given by its coefficient in plain characters, its coefficient
/// as typeset, and its element.
pub(crate) fn combination(terms: impl Iterator<Item = (String, String, String)>) -> Terms {
    let mut sum = Terms::new();
    for (plain, set, element) in terms {
        let is_sum = [" + ", " - "].iter().any(|sign| plain.contains(sign));
        let (negative, size) = match set.strip_prefix(MINUS) {
            Some(size) if !is_sum => (true, size),
            _ => (false, set.as_str()),
        };
        let term = match plain.trim_start_matches('-') {
            "1" => element,
            _ if is_sum => format!("{}{THIN}{element}", bracketed(size)),
            _ => format!("{size}{THIN}{element}"), // separated from the argument of a sine
        };
        let sign = match (sum.is_empty(), negative) {
            (true, false) => "",
            (_, true) => MINUS,
            (false, false) => "<mo>+</mo>",
        };
        sum.push((format!("{sign}{term}"), columns(&plain) + 4));
    }
    if sum.is_empty() { vec![("<mn>0</mn>".to_owned(), 1)] } else { sum }
}

/// The rows of a table, one below the other, as one formula.
fn table(rows: &[String]) -> String {
    format!("<math display=\"block\"><mtable displaystyle=\"true\">{}</mtable></math>", rows.concat())
}

/// The two sides in one row, however long they are.
fn row(left: &str, right: &str) -> String {
    format!("<mtr><mtd>{left}</mtd><mtd>{EQUALS}</mtd><mtd>{right}</mtd></mtr>")
}

/// The two sides in as many rows as needed: the right-hand side begins after a short left-hand side, or
/// otherwise in a separate row.
fn equation(left: Terms, right: Terms, width: usize) -> Vec<String> {
    let columns: usize = left.iter().map(|(_, width)| width + 1).sum();
    if columns <= LONG_LEFT {
        let left: String = left.into_iter().map(|(term, _)| term).collect();
        let line = |(i, line): (usize, String)| match i {
            0 => row(&left, &line),
            _ => format!("<mtr><mtd></mtd><mtd></mtd><mtd>{line}</mtd></mtr>"),
        };
        return flowed(right, columns + 3, width).into_iter().enumerate().map(line).collect();
    }
    let whole = |line: &str| format!("<mtr><mtd columnspan=\"3\">{line}</mtd></mtr>");
    let mut rows: Vec<String> = flowed(left, 0, width).iter().map(|line| whole(line)).collect();
    for (i, line) in flowed(right, HANGING, width).iter().enumerate() {
        let sign = if i == 0 { EQUALS } else { "" };
        rows.push(whole(&format!("<mspace width=\"2em\"/>{sign}{line}")));
    }
    rows
}

/// The terms arranged in lines.
fn flowed(terms: Terms, begin: usize, width: usize) -> Vec<String> {
    let mut lines = Terms::new();
    for (term, columns) in terms {
        match lines.last_mut() {
            Some((line, used)) if begin + *used + 1 + columns <= width => {
                line.push_str(&term);
                *used += columns + 1;
            }
            _ => lines.push((term, columns)),
        }
    }
    lines.into_iter().map(|(line, _)| line).collect()
}

/// The parts, each with its table, except parts that have nothing to display.
pub(crate) fn displays<'a, 'p>(
    operators: &'a [String],
    layout: &'a Layout,
    parts: &'a Parts<'p>,
) -> Vec<(&'a Part<'p>, Option<Displayed>)> {
    let names = &parts.names;
    let set = Set { operators, names, set: names.written(Style::MathMl), plain: names.written(Style::Book) };
    let display = |(part, numbers): (&'a Part<'p>, Vec<usize>)| {
        let (names, equations) = (set.meanings(&numbers), set.equations(part));
        let both = names.iter().chain(&equations).cloned();
        let rows: Vec<String> = both.flat_map(|(left, right)| equation(left, right, layout.width)).collect();
        let displayed = || Displayed {
            table: table(&rows),
            names: names.iter().map(DisplayedEquation::of).collect(),
            equations: equations.iter().map(DisplayedEquation::of).collect(),
        };
        (part, (!rows.is_empty()).then(displayed))
    };
    parts.with_names().map(display).collect()
}

/// The expressions to typeset, with the names in use.
struct Set<'a, 'p> {
    /// The names of the quasi-velocities to which operators belong.
    operators: &'a [String],
    names: &'a Names<'p>,
    set: Written,
    /// The expressions of the sheet in plain characters, whose widths decide where lines are broken.
    plain: Written,
}

impl<'p> Set<'_, 'p> {
    fn meanings(&self, numbers: &[usize]) -> Vec<(Terms, Terms)> {
        let meaning = |&number: &usize| {
            let name = &self.names.list()[number];
            let widths = self.plain.meaning(name.value);
            let terms = self.set.meaning(name.value).into_iter().zip(widths.iter().map(|term| columns(term)));
            (vec![(self.set.name(&name.name), columns(&name.name))], terms.collect())
        };
        numbers.iter().map(meaning).collect()
    }

    fn terms(&self, line: Expr<'p>) -> Terms {
        let widths = self.plain.terms(line);
        self.set.terms(line).into_iter().zip(widths.iter().map(|term| columns(term))).collect()
    }

    fn equations(&self, part: &Part<'p>) -> Vec<(Terms, Terms)> {
        let equations = part.rows.iter().filter_map(|row| match row {
            Row::Constraint { left, .. } => Some((vec![("<mn>0</mn>".to_owned(), 1)], self.terms(*left))),
            Row::Equation { left, right } => Some((self.terms(*left), self.terms(*right))),
            Row::Function { letter, value } => {
                Some((vec![(format!("<mi>{letter}</mi>"), 1)], self.terms(*value)))
            }
            Row::Bracket(Bracket { pair: [r, s], components }) => {
                let left = format!(
                    "<mo stretchy=\"false\">[</mo>{}<mo>,</mo>{}<mo stretchy=\"false\">]</mo>",
                    self.operator(*r),
                    self.operator(*s)
                );
                let components = components.iter().map(|&(m, c)| (c, self.operator(m)));
                Some((vec![(left, 8)], self.combination(components)))
            }
            Row::Symbol { indices, value } => {
                let [r, s, m] = indices.map(|s| {
                    s.checked_sub(1).map_or("<mn>0</mn>".to_owned(), |s| self.set.name(&self.operators[s]))
                });
                let left = format!("<msubsup><mi>γ</mi><mrow>{r}{s}</mrow>{m}</msubsup>");
                Some((vec![(left, 4)], self.terms(*value)))
            }
            Row::Operator { quasi_velocity, components } => {
                let eta = quasi_velocity.as_deref().map(|name| self.set.name(name));
                let left = operator(eta.as_deref().unwrap_or("<mn>0</mn>"));
                let components = components.iter().map(|&(x, c)| (c, partial(&self.set.text(x))));
                Some((vec![(left, 3)], self.combination(components)))
            }
            Row::Force { letter, quasi_velocity, value } => {
                let name = self.set.name(quasi_velocity);
                let left = match letter.strip_suffix('*') {
                    None => format!("<msub><mi>{letter}</mi>{name}</msub>"),
                    Some(letter) => format!("<msubsup><mi>{letter}</mi>{name}<mo>*</mo></msubsup>"),
                };
                Some((vec![(left, 3)], self.terms(*value)))
            }
            Row::PartialVelocity { rate, quasi_velocity, value } => {
                let (above, below) = (self.set.text(*rate), self.set.text(*quasi_velocity));
                let left =
                    format!("<mfrac><mrow><mi>∂</mi>{above}</mrow><mrow><mi>∂</mi>{below}</mrow></mfrac>");
                Some((vec![(left, 5)], self.terms(*value)))
            }
            Row::Entry { .. } => None,
        });
        equations.collect()
    }

    /// X_0, or the operator of a quasi-velocity.
    fn operator(&self, s: usize) -> String {
        let eta = s.checked_sub(1).map(|s| self.set.name(&self.operators[s]));
        operator(eta.as_deref().unwrap_or("<mn>0</mn>"))
    }

    fn combination(&self, sum: impl Iterator<Item = (Expr<'p>, String)>) -> Terms {
        combination(sum.map(|(c, element)| (self.plain.text(c), self.set.text(c), element)))
    }
}
