//! Equations whose lines a browser breaks to the width of the page, at signs.
//!
//! A browser breaks no line within a `math` element. An equation is therefore a row of such elements, one for
//! each term; a term that is wider than a narrow page is divided further, within brackets and between
//! factors, and a wide fraction is written as a product.

use pc_print::DisplayedEquation;

/// A term wider than this, in columns, is divided: about the width of a page on a telephone.
const WIDE: f64 = 30.0;
/// Left-hand sides wider than this are put on a line of their own.
const LONG_LEFT: f64 = 24.0;
/// Equations wider than this need the whole width of a page.
const HALF: f64 = 50.0;
/// A list of this many equations is long.
const MANY: usize = 8;

/// Equations one below the other; a long list of short ones is divided into two that stand beside each other
/// where the page is wide.
pub(super) fn equations(list: &[DisplayedEquation]) -> String {
    if list.len() < MANY || !are_narrow(list) {
        return column(list);
    }
    let (first, second) = list.split_at(list.len().div_ceil(2));
    format!("<div class=\"pair\">\n{}{}</div>\n", column(first), column(second))
}

/// Equations in a box that scrolls separately if a piece does not fit; browsers make such boxes accessible from
/// the keyboard.
fn column(list: &[DisplayedEquation]) -> String {
    format!("<div class=\"formula\">\n{}</div>\n", list.iter().map(equation).collect::<String>())
}

/// Whether equations fit beside others, in half of a wide page.
pub(super) fn are_narrow(list: &[DisplayedEquation]) -> bool {
    list.iter().all(|DisplayedEquation { left, right }| width(left) + width(right) < HALF)
}

fn equation(DisplayedEquation { left, right }: &DisplayedEquation) -> String {
    let class = if width(left) > LONG_LEFT { "eq long" } else { "eq" };
    let left: String = pieces(left).iter().map(|piece| math(piece)).collect();
    // The equals sign begins the line of the first term.
    let right = pieces(&format!("{EQUALS}{right}"));
    let right: String = right.iter().map(|piece| math(piece)).collect();
    format!("<div class=\"{class}\"><div class=\"lhs\">{left}</div><div class=\"rhs\">{right}</div></div>\n")
}

/// A formula in a line of text; a line may end after it.
fn math(row: &str) -> String {
    format!("<math displaystyle=\"true\">{}</math><wbr/>", clear(row))
}

/// The row as it is read most easily: brackets grow only around what is taller than a line, and an index of
/// an index stands beside it, where it is not too small.
fn clear(row: &str) -> String {
    let element = |element: &Element<'_>| {
        let inner = element.inner;
        let start = element.whole.find('>').map_or(0, |end| end + 1);
        let (head, tail) = (&element.whole[..start], &element.whole[start + inner.len()..]);
        let low = inner.strip_prefix("<mo>(</mo>").and_then(|inner| inner.strip_suffix("<mo>)</mo>"));
        match (element.name, low.filter(|inner| !TALL.iter().any(|tall| inner.contains(tall)))) {
            ("mrow", Some(inner)) => format!("{head}{OPEN}{}{CLOSE}{tail}", clear(inner)),
            ("msub" | "msubsup", _) => {
                let part = |(i, part): (usize, &Element<'_>)| match (i, part.name) {
                    (1, "msub") => format!("<mrow>{}</mrow>", level(part.inner)),
                    _ => clear(part.whole),
                };
                let parts: String = elements(inner).iter().enumerate().map(part).collect();
                format!("{head}{parts}{tail}")
            }
            ("mi", _) => element.whole.replace('_', "\u{2009}"),
            _ if inner.contains('<') => format!("{head}{}{tail}", clear(inner)),
            _ => element.whole.to_owned(),
        }
    };
    elements(row).iter().map(element).collect()
}

/// The row with indices beside what they belong to; a word is apart from its index.
fn level(row: &str) -> String {
    let mut text = String::new();
    for (i, element) in elements(row).iter().enumerate() {
        if i > 0 && width(&text) > 1.5 {
            text += "<mspace width=\"0.17em\"/>";
        }
        text += &match element.name {
            "msub" => level(element.inner),
            _ => clear(element.whole),
        };
    }
    text
}

const EQUALS: &str = "<mo form=\"infix\">=</mo>";
const OPEN: &str = "<mo stretchy=\"false\">(</mo>";
const CLOSE: &str = "<mo stretchy=\"false\">)</mo>";
/// Elements that are taller than a line.
const TALL: [&str; 2] = ["<mfrac", "<msqrt"];

/// An element of a row.
#[derive(Clone, Copy)]
struct Element<'a> {
    name: &'a str,
    whole: &'a str,
    inner: &'a str,
}

impl Element<'_> {
    fn is_sign(&self) -> bool {
        self.name == "mo" && matches!(self.inner, "+" | "−")
    }

    fn opens(&self) -> bool {
        self.name == "mo" && matches!(self.inner, "(" | "[" | "," | "=")
    }

    /// Whether this is the product sign that nobody sees.
    fn is_times(&self) -> bool {
        self.inner == "&#x2062;"
    }
}

/// The elements that stand side by side in a row of MathML.
fn elements(row: &str) -> Vec<Element<'_>> {
    let (mut list, mut rest) = (Vec::new(), row);
    while let Some(first) = rest.find('<') {
        let row = &rest[first..];
        let Some(head) = row.find('>') else { break };
        let name = row[1..head].split([' ', '/']).next().unwrap_or_default();
        let end = if row[..head].ends_with('/') { head + 1 } else { end_of(row, name) };
        let inner = row[..end].strip_suffix('>').and_then(|row| row.rfind('<')).filter(|&last| last > head);
        let inner = inner.map_or("", |last| &row[head + 1..last]);
        list.push(Element { name, whole: &row[..end], inner });
        rest = &row[end..];
    }
    list
}

/// The length of the element with which the row begins.
fn end_of(row: &str, name: &str) -> usize {
    let (mut depth, mut at) = (0, 0);
    while let Some(tag) = row[at..].find('<').map(|place| at + place) {
        let end = row[tag..].find('>').map_or(row.len(), |length| tag + length + 1);
        let within = &row[tag + 1..end.max(tag + 2) - 1];
        match within.strip_prefix('/') {
            Some(closed) if closed == name => depth -= 1,
            None if within.split(' ').next() == Some(name) && !within.ends_with('/') => depth += 1,
            _ => {}
        }
        at = end;
        if depth == 0 {
            return end;
        }
    }
    row.len()
}

/// The approximate width of a row, in columns.
fn width(row: &str) -> f64 {
    let within = |element: &Element<'_>| -> Vec<f64> {
        elements(element.inner).iter().map(|part| width(part.whole)).collect()
    };
    let one = |element: &Element<'_>| match element.name {
        "mo" if element.inner.starts_with("&#x") => 0.0,
        "mo" if element.is_sign() || element.inner == "=" => 2.2,
        "mspace" => 0.3,
        "mi" | "mn" | "mo" | "mtext" => element.inner.chars().count() as f64,
        "mfrac" => within(element).into_iter().fold(0.0, f64::max) + 0.5,
        "mover" => within(element).first().copied().unwrap_or_default(),
        "msub" | "msup" => {
            within(element).iter().enumerate().map(|(i, w)| if i == 0 { *w } else { 0.7 * w }).sum()
        }
        "msubsup" => match within(element)[..] {
            [base, below, above] => base + 0.7 * below.max(above),
            _ => 0.0,
        },
        _ => within(element).iter().sum(),
    };
    elements(row).iter().map(one).sum()
}

/// The pieces of a row, between which lines may end.
fn pieces(row: &str) -> Vec<String> {
    let mut pieces = Vec::new();
    for term in terms(&elements(&joined(row))) {
        if width(&term) <= WIDE {
            pieces.push(term);
        } else {
            pieces.extend(divided(&term));
        }
    }
    pieces
}

/// The row with brackets that fit on a line as one element, so that no line ends within them.
fn joined(row: &str) -> String {
    let mut open: Vec<String> = vec![String::new()];
    for element in elements(row) {
        let last = open.len() - 1;
        match element.whole {
            OPEN => open.push(String::new()),
            CLOSE if last > 0 => {
                let inner = open.pop().unwrap_or_default();
                let whole = match width(&inner) <= WIDE {
                    true => format!("<mrow><mo>(</mo>{inner}<mo>)</mo></mrow>"),
                    false => format!("{OPEN}{inner}{CLOSE}"),
                };
                push(&mut open, &whole);
            }
            whole => push(&mut open, whole),
        }
    }
    open.join(OPEN) // a bracket that is not closed here stays as it is
}

/// The terms of a sum, each with its sign; the sign of the first belongs to it more closely.
fn terms(row: &[Element<'_>]) -> Vec<String> {
    let mut terms = vec![String::new()];
    for (i, element) in row.iter().enumerate() {
        let before = i.checked_sub(1).map(|before| row[before]);
        let is_first = before.is_none_or(|before| before.opens() || before.is_sign());
        match (element.is_sign(), is_first) {
            (true, false) => terms.push(format!("<mo form=\"infix\">{}</mo>", element.inner)),
            (true, true) => push(&mut terms, &format!("<mo form=\"prefix\">{}</mo>", element.inner)),
            _ => push(&mut terms, element.whole),
        }
    }
    terms
}

fn push(pieces: &mut [String], part: &str) {
    if let Some(last) = pieces.last_mut() {
        last.push_str(part);
    }
}

/// A wide term divided between its factors and within them.
fn divided(term: &str) -> Vec<String> {
    let mut pieces = vec![String::new()];
    let mut follows = false; // a factor after which a line may end
    for element in elements(term) {
        if element.is_times() {
            push(&mut pieces, element.whole);
            follows = true;
            continue;
        }
        let parts = opened(&element);
        let splits = follows && width(pieces.last().map_or("", String::as_str)) > WIDE / 3.0;
        for (k, part) in parts.iter().enumerate() {
            if k > 0 || splits {
                pieces.push(String::new());
            }
            push(&mut pieces, part);
        }
        follows = false;
    }
    pieces
}

/// The pieces of a factor.
fn opened(factor: &Element<'_>) -> Vec<String> {
    let whole = || vec![factor.whole.to_owned()];
    if width(factor.whole) <= WIDE {
        return whole();
    }
    let parts = elements(factor.inner);
    match (factor.name, &parts[..]) {
        ("mrow", [open, .., close]) if open.inner == "(" && close.inner == ")" => {
            let start = open.whole.len();
            bracketed(&factor.inner[start..factor.inner.len() - close.whole.len()], CLOSE)
        }
        ("mrow", _) => pieces(factor.inner),
        ("msup", [base, exponent]) if base.name == "mrow" => {
            let parts = elements(base.inner);
            match &parts[..] {
                [open, .., close] if open.inner == "(" => {
                    let inner = &base.inner[open.whole.len()..base.inner.len() - close.whole.len()];
                    bracketed(inner, &format!("<msup>{CLOSE}{}</msup>", exponent.whole))
                }
                _ => whole(),
            }
        }
        ("mfrac", [above, below]) => over(above, below),
        ("msqrt", _) => bracketed(
            factor.inner,
            &format!("<msup>{CLOSE}<mrow><mn>1</mn><mo>/</mo><mn>2</mn></mrow></msup>"),
        ),
        _ => whole(),
    }
}

/// A row between brackets that do not grow, so that a line may end between them.
fn bracketed(row: &str, close: &str) -> Vec<String> {
    let mut parts = pieces(row);
    if let Some(first) = parts.first_mut() {
        first.insert_str(0, OPEN);
    }
    push(&mut parts, close);
    parts
}

/// A wide fraction as a product with the inverse of its denominator.
fn over(above: &Element<'_>, below: &Element<'_>) -> Vec<String> {
    let row = |element: &Element<'_>| match element.name {
        "mrow" => element.inner.to_owned(),
        _ => element.whole.to_owned(),
    };
    let mut parts = Vec::new();
    if width(below.whole) <= WIDE {
        parts.push(format!("<mfrac><mn>1</mn>{}</mfrac>", below.whole));
        parts.extend(bracketed(&row(above), CLOSE));
    } else {
        parts.extend(bracketed(&row(above), CLOSE));
        let inverse = format!("<msup>{CLOSE}<mrow><mo form=\"prefix\">−</mo><mn>1</mn></mrow></msup>");
        parts.extend(bracketed(&row(below), &inverse));
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sum(letters: usize) -> String {
        (0..letters).map(|_| "<mi>abcdef</mi>").collect::<Vec<_>>().join("<mo>+</mo>")
    }

    /// Pieces without their markup.
    fn plain(row: &str) -> Vec<String> {
        let text = |piece: &String| {
            piece.split('<').filter_map(|part| part.split_once('>')).map(|(_, text)| text).collect()
        };
        pieces(row).iter().map(text).collect()
    }

    #[test]
    fn elements_stand_side_by_side() {
        let row = "<mrow><mrow><mi>a</mi></mrow></mrow><mspace width=\"1em\"/><mo stretchy=\"false\">(</mo><mtd></mtd>";
        let list = elements(row);
        assert_eq!(list.iter().map(|e| e.name).collect::<Vec<_>>(), ["mrow", "mspace", "mo", "mtd"]);
        assert_eq!(
            list.iter().map(|e| e.inner).collect::<Vec<_>>(),
            ["<mrow><mi>a</mi></mrow>", "", "(", ""]
        );
        assert_eq!(list.iter().map(|e| e.whole).collect::<String>(), row);
    }

    #[test]
    fn a_long_list_is_divided() {
        let short = DisplayedEquation { left: "<mi>x</mi>".to_owned(), right: "<mi>y</mi>".to_owned() };
        let boxes = |list: &[DisplayedEquation]| equations(list).matches("class=\"formula\"").count();
        let lists = [7, 9].map(|count| vec![short.clone(); count]);
        assert_eq!(lists.map(|list| boxes(&list)), [1, 2]);
        let long = DisplayedEquation { left: short.left.clone(), right: sum(9) };
        assert_eq!(boxes(&vec![long; 9]), 1);
    }

    #[test]
    fn a_line_ends_before_a_sign() {
        assert_eq!(plain("<mo>−</mo><mi>a</mi><mo>+</mo><mi>b</mi><mo>−</mo><mi>c</mi>"), ["−a", "+b", "−c"]);
        assert_eq!(pieces("<mo>−</mo><mi>a</mi>"), ["<mo form=\"prefix\">−</mo><mi>a</mi>"]);
        assert_eq!(pieces("<mi>b</mi><mo>−</mo><mi>a</mi>")[1], "<mo form=\"infix\">−</mo><mi>a</mi>");
        // Signs within brackets that fit divide nothing.
        assert_eq!(plain("<mrow><mo>(</mo><mi>a</mi><mo>+</mo><mi>b</mi><mo>)</mo></mrow>"), ["(a+b)"]);
    }

    #[test]
    fn brackets_that_fit_stay_together() {
        let around = |inner: &str| format!("{OPEN}{inner}{CLOSE}");
        assert_eq!(plain(&around(&sum(3))), ["(abcdef+abcdef+abcdef)"]);
        assert_eq!(plain(&around(&sum(6))).len(), 6);
        assert_eq!(joined(&format!("{OPEN}<mi>a</mi>")), format!("{OPEN}<mi>a</mi>"));
        let fraction = "<mfrac><mi>a</mi><mi>b</mi></mfrac>";
        assert_eq!(joined(&around(fraction)), format!("<mrow><mo>(</mo>{fraction}<mo>)</mo></mrow>"));
    }

    #[test]
    fn wide_brackets_open() {
        let row = format!("<mi>m</mi><mo>&#x2062;</mo><mrow><mo>(</mo>{}<mo>)</mo></mrow>", sum(6));
        assert_eq!(plain(&row), ["m&#x2062;(abcdef", "+abcdef", "+abcdef", "+abcdef", "+abcdef", "+abcdef)"]);
        let square = format!("<msup><mrow><mo>(</mo>{}<mo>)</mo></mrow><mn>2</mn></msup>", sum(5));
        assert_eq!(plain(&square).last().map(String::as_str), Some("+abcdef)2"));
        let root = format!("<msqrt>{}</msqrt>", sum(5));
        assert_eq!(plain(&root).last().map(String::as_str), Some("+abcdef)1/2"));
    }

    #[test]
    fn brackets_grow_around_fractions_alone() {
        let around = |inner: &str| format!("<mrow><mo>(</mo>{inner}<mo>)</mo></mrow>");
        let fraction = around("<mfrac><mi>a</mi><mi>b</mi></mfrac>");
        assert_eq!(clear(&fraction), fraction);
        let both = format!("<mfrac>{}<mi>c</mi></mfrac>", around("<mi>x</mi>"));
        assert_eq!(clear(&both), format!("<mfrac><mrow>{OPEN}<mi>x</mi>{CLOSE}</mrow><mi>c</mi></mfrac>"));
    }

    #[test]
    fn indices_have_one_level() {
        let index = "<msub><mi>ω</mi><mn>1</mn></msub>";
        assert_eq!(
            clear(&format!("<msub><mi>hub</mi>{index}</msub>")),
            "<msub><mi>hub</mi><mrow><mi>ω</mi><mn>1</mn></mrow></msub>"
        );
        let leg = "<msub><mi>X</mi><msub><mi>leg</mi><mi>left_hip</mi></msub></msub>";
        let apart = "<mrow><mi>leg</mi><mspace width=\"0.17em\"/><mi>left\u{2009}hip</mi></mrow>";
        assert_eq!(clear(leg), format!("<msub><mi>X</mi>{apart}</msub>"));
        assert_eq!(clear(index), index);
    }

    #[test]
    fn wide_fractions_are_products() {
        let fraction =
            |above: &str, below: &str| format!("<mfrac><mrow>{above}</mrow><mrow>{below}</mrow></mfrac>");
        assert_eq!(plain(&fraction(&sum(3), &sum(2))).len(), 1);
        let over_few = plain(&fraction(&sum(6), "<mi>J</mi>"));
        assert_eq!((over_few[0].as_str(), over_few[1].as_str(), over_few.len()), ("1J", "(abcdef", 7));
        let over_many = plain(&fraction("<mi>J</mi>", &sum(6)));
        assert_eq!((over_many[0].as_str(), over_many[1].as_str()), ("(J)", "(abcdef"));
        assert_eq!(over_many.last().map(String::as_str), Some("+abcdef)−1"));
    }

    #[test]
    fn a_product_is_divided_between_factors() {
        let factor = "<mi>abcdefghijklmn</mi>";
        let row = [factor; 4].join("<mo>&#x2062;</mo>");
        assert_eq!(plain(&row).len(), 4);
    }
}
