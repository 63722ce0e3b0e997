//! The description of a model, in any format.

use pc_mech::{Expr, Identity, Style};

use crate::language::latex::in_text;
use crate::language::mathml;

/// The analysis of the motions of a model without integrating them: momenta and their brackets, Casimirs, integrals and
/// the displacements to which they belong, invariant measure, Chaplygin's multiplier, Hamilton–Jacobi's equation, steady
/// motions, Routh's reduction. Each claim is proved, disproved or open.
#[derive(Clone, Debug)]
pub struct Theory<'g> {
    pub(crate) title: String,
    pub(crate) sections: Vec<Section<'g>>,
}

/// A part of the description.
#[derive(Clone, Debug)]
pub(crate) struct Section<'g> {
    /// The name of the part, for programs.
    pub(crate) key: &'static str,
    /// The title of the part in print.
    pub(crate) title: &'static str,
    /// The names first used in this part, each with its meaning.
    pub(crate) names: Vec<(Side<'g>, Side<'g>)>,
    pub(crate) entries: Vec<Entry<'g>>,
}

/// Formulas that belong together, with the results about them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Entry<'g> {
    pub(crate) name: Option<String>,
    pub(crate) formulas: Vec<(Side<'g>, Side<'g>)>,
    /// Names with their numerical values.
    pub(crate) values: Vec<(String, f64)>,
    /// The verdict, with its subject if it is not a verdict on the formulas.
    pub(crate) verdict: Option<(Option<&'static str>, Verdict)>,
    /// Sentences that contain no formulas.
    pub(crate) words: Vec<String>,
    /// Real and imaginary parts of the eigenvalues that belong to this entry.
    pub(crate) spectrum: Vec<(f64, f64)>,
}

/// Whether a claim holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Verdict {
    /// The claim holds for all values of the parameters.
    Proved,
    /// The claim holds for the present values of the parameters.
    ProvedHere,
    /// The claim does not hold: numerically, the terms of an identity add up to this fraction of their size.
    Disproved {
        /// The fraction, from 0 to 1.
        margin: f64,
    },
    /// A motion is not stable: others depart from it.
    Unstable {
        /// The largest real part of any eigenvalue.
        growth: f64,
    },
    /// Neither.
    Open,
}

/// A side of a formula, in each style; an expression is written out once all expressions of the page are
/// known.
#[derive(Clone, Debug, Default)]
pub(crate) struct Side<'g> {
    pub(crate) expression: Option<Expr<'g>>,
    /// Text as a book prints it.
    pub(crate) book: String,
    pub(crate) latex: String,
    /// Text in the expression language, if possible.
    pub(crate) text: String,
    /// A row of MathML.
    pub(crate) mathml: String,
}

impl Verdict {
    /// The verdict on an identity.
    pub(crate) fn of(identity: Identity) -> Verdict {
        match identity {
            Identity::Proved => Verdict::Proved,
            Identity::Open { .. } => Verdict::Open,
            Identity::Disproved { rest } => Verdict::Disproved { margin: rest },
        }
    }

    /// The verdict as a single word.
    pub(crate) fn word(self) -> &'static str {
        match self {
            Verdict::Proved | Verdict::ProvedHere => "proved",
            Verdict::Disproved { .. } | Verdict::Unstable { .. } => "disproved",
            Verdict::Open => "open",
        }
    }

    /// The verdict in words, with its details.
    pub(crate) fn in_words(self) -> String {
        match self {
            Verdict::ProvedHere => "proved for these parameters".to_owned(),
            _ => self.word().to_owned(),
        }
    }
}

impl<'g> Side<'g> {
    /// An expression.
    pub(crate) fn of(e: Expr<'g>) -> Side<'g> {
        Side { expression: Some(e), ..Side::default() }
    }

    /// A text, as `write` produces it in each style.
    pub(crate) fn written(write: impl Fn(Style) -> String) -> Side<'g> {
        Side {
            expression: None,
            book: write(Style::Book),
            latex: write(Style::Latex),
            text: write(Style::Text),
            mathml: write(Style::MathMl),
        }
    }

    /// A mathematical symbol that has the same form in all plain text.
    pub(crate) fn symbol(plain: &str, latex: &str, mathml: &str) -> Side<'g> {
        let (book, latex, text) = (plain.to_owned(), latex.to_owned(), plain.to_owned());
        Side { expression: None, book, latex, text, mathml: mathml.to_owned() }
    }

    /// A letter.
    pub(crate) fn letter(letter: &str) -> Side<'g> {
        Side::symbol(letter, letter, &format!("<mi>{letter}</mi>"))
    }

    /// (f, g)
    pub(crate) fn bracket(f: Expr<'_>, g: Expr<'_>) -> Side<'g> {
        Side::written(|style| match style {
            Style::Latex => format!("({},\\, {})", f.display(style), g.display(style)),
            Style::Book | Style::Text => format!("({}, {})", f.display(style), g.display(style)),
            Style::MathMl => {
                let [open, close] = ["(", ")"].map(|sign| format!("<mo stretchy=\"false\">{sign}</mo>"));
                format!("{open}{}<mo>,</mo>{}{close}", f.display(style), g.display(style))
            }
        })
    }

    /// ∂F/∂z of a function that is denoted by a letter.
    pub(crate) fn slope(letter: &str, z: Expr<'_>) -> Side<'g> {
        Side::written(|style| {
            let name = z.display(style);
            match style {
                Style::Latex => format!("\\frac{{\\partial {letter}}}{{\\partial {name}}}"),
                Style::Book | Style::Text => format!("∂{letter}/∂{name}"),
                Style::MathMl => {
                    let above = format!("<mrow><mi>∂</mi><mi>{letter}</mi></mrow>");
                    format!("<mfrac>{above}<mrow><mi>∂</mi>{name}</mrow></mfrac>")
                }
            }
        })
    }

    /// df/dt of a named function.
    pub(crate) fn rate_of(name: &str) -> Side<'g> {
        let plain = format!("d/dt {name}");
        Side {
            expression: None,
            latex: format!("\\frac{{d}}{{dt}}\\text{{{}}}", in_text(name)),
            mathml: format!("{}<mtext>{}</mtext>", mathml::RATE, mathml::escaped(name)),
            book: plain.clone(),
            text: plain,
        }
    }
}

impl<'g> Entry<'g> {
    /// Left = right.
    pub(crate) fn formula(left: Side<'g>, right: Side<'g>) -> Entry<'g> {
        Entry { formulas: vec![(left, right)], ..Entry::default() }
    }

    /// An entry of words without formulas.
    pub(crate) fn words(words: impl Into<String>) -> Entry<'g> {
        Entry { words: vec![words.into()], ..Entry::default() }
    }

    pub(crate) fn named(self, name: impl Into<String>) -> Entry<'g> {
        Entry { name: Some(name.into()), ..self }
    }

    pub(crate) fn with(self, verdict: Verdict) -> Entry<'g> {
        Entry { verdict: Some((None, verdict)), ..self }
    }

    /// The entry with a verdict on something other than its formulas.
    pub(crate) fn with_on(self, subject: &'static str, verdict: Verdict) -> Entry<'g> {
        Entry { verdict: Some((Some(subject), verdict)), ..self }
    }

    pub(crate) fn say(mut self, words: impl Into<String>) -> Entry<'g> {
        self.words.push(words.into());
        self
    }
}
