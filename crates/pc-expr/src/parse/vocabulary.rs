//! The words of the language: functions and names.

/// A function of the language.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Function {
    /// The name of the function, which is reserved.
    pub name: &'static str,
    /// The number of its arguments.
    pub arguments: usize,
    /// The form of a call.
    pub usage: &'static str,
}

/// A function that a text declares, with the names of its arguments.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Declared {
    /// The name of the function.
    pub name: String,
    /// The names of its arguments.
    pub arguments: Vec<String>,
}

impl Declared {
    /// The form of a call: `V(r)`.
    pub fn usage(&self) -> String {
        format!("{}({})", self.name, self.arguments.join(", "))
    }
}

const fn function(name: &'static str, arguments: usize, usage: &'static str) -> Function {
    Function { name, arguments, usage }
}

/// All functions, `d` included.
pub const FUNCTIONS: &[Function] = &[
    function("sin", 1, "sin(x)"),
    function("cos", 1, "cos(x)"),
    function("tan", 1, "tan(x)"),
    function("cot", 1, "cot(x)"),
    function("asin", 1, "asin(x)"),
    function("acos", 1, "acos(x)"),
    function("atan", 1, "atan(x)"),
    function("atan2", 2, "atan2(y, x)"),
    function("sinh", 1, "sinh(x)"),
    function("cosh", 1, "cosh(x)"),
    function("tanh", 1, "tanh(x)"),
    function("exp", 1, "exp(x)"),
    function("log", 1, "log(x)"),
    function("sqrt", 1, "sqrt(x)"),
    function("abs", 1, "abs(x)"),
    function("sign", 1, "sign(x)"),
    function("min", 2, "min(a, b)"),
    function("max", 2, "max(a, b)"),
    function("step", 3, "step(x, a, b)"),
    function("d", 1, "d(x)"),
];

/// Names that other notations give to our functions.
pub(super) const OTHER_NAMES: &[(&str, &str)] =
    &[("ln", "log"), ("tg", "tan"), ("ctg", "cot"), ("sgn", "sign")];

/// Longest name, in bytes.
const LONGEST_NAME: usize = 255;

/// Whether `text` can be a name: a Latin or Greek letter or `_`, then letters, digits and `_`; at most 255 bytes
/// long.
pub fn is_name(text: &str) -> bool {
    text.len() <= LONGEST_NAME && text.starts_with(starts_name) && text.chars().all(continues_name)
}

pub(super) fn starts_name(c: char) -> bool {
    matches!(c, 'A'..='Z' | 'a'..='z' | '_' | 'α'..='ω' | 'Α'..='Ω')
}

pub(super) fn continues_name(c: char) -> bool {
    starts_name(c) || c.is_ascii_digit()
}

/// The candidate nearest to `word`, if one is near enough to be a misspelling: at most one edit (a letter
/// inserted, deleted or replaced, or two exchanged) for every three letters.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let word: Vec<char> = word.chars().take(64).collect();
    let limit = word.len().div_ceil(3).min(word.len().saturating_sub(1));
    let distances = candidates.into_iter().map(|candidate| (distance(&word, candidate), candidate));
    distances.filter(|(edits, _)| *edits <= limit).min_by_key(|(edits, _)| *edits).map(|(_, name)| name)
}

fn distance(a: &[char], b: &str) -> usize {
    let b: Vec<char> = b.chars().take(64).collect();
    let mut before = Vec::new();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for i in 1..=a.len() {
        let mut next = vec![i];
        for j in 1..=b.len() {
            let other = row[j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut best = other.min(row[j] + 1).min(next[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                let exchanged: &usize = &before[j - 2];
                best = best.min(exchanged + 1);
            }
            next.push(best);
        }
        before = std::mem::replace(&mut row, next);
    }
    row[b.len()]
}
