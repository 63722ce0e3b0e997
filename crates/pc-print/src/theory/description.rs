//! The description of a model, whatever the format.

use pc_mech::{Expr, Identity, Style};

use crate::words::short;

/// What can be said of a model, part by part.
#[derive(Clone, Debug)]
pub(crate) struct Theory {
    pub(crate) title: String,
    pub(crate) sections: Vec<Section>,
}

/// A part of it.
#[derive(Clone, Debug)]
pub(crate) struct Section {
    /// Its name for programs.
    pub(crate) key: &'static str,
    /// Its name for people.
    pub(crate) title: &'static str,
    pub(crate) entries: Vec<Entry>,
}

/// Formulas that belong together, with what is known of them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Entry {
    pub(crate) name: Option<String>,
    pub(crate) formulas: Vec<(Side, Side)>,
    /// Names with numbers.
    pub(crate) values: Vec<(String, f64)>,
    /// What is known, and of what if not of the formulas.
    pub(crate) verdict: Option<(Option<&'static str>, Verdict)>,
    /// Sentences without formulas.
    pub(crate) words: Vec<String>,
}

/// Whether something holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Verdict {
    /// Whatever the parameters.
    Proved,
    /// For the values that the parameters have.
    ProvedHere,
    /// Numbers leave so large a part of the terms, or differ so much.
    Disproved {
        /// How far it is from holding.
        margin: f64,
    },
    /// Neither.
    Open,
}

/// A side of a formula, in each of the ways in which it is printed.
#[derive(Clone, Debug)]
pub(crate) struct Side {
    /// As in a book.
    pub(crate) book: String,
    pub(crate) latex: String,
    /// In the language of expressions, where it is one.
    pub(crate) text: String,
}

impl Verdict {
    /// That on an identity.
    pub(crate) fn of(identity: Identity) -> Verdict {
        match identity {
            Identity::Proved => Verdict::Proved,
            Identity::Open { .. } => Verdict::Open,
            Identity::Disproved { rest } => Verdict::Disproved { margin: rest },
        }
    }

    /// One of three words.
    pub(crate) fn word(self) -> &'static str {
        match self {
            Verdict::Proved | Verdict::ProvedHere => "proved",
            Verdict::Disproved { .. } => "disproved",
            Verdict::Open => "open",
        }
    }

    /// That word with what belongs to it.
    pub(crate) fn in_words(self) -> String {
        match self {
            Verdict::ProvedHere => "proved for these parameters".to_owned(),
            Verdict::Disproved { margin } => format!("disproved, by {}", short(margin, 3)),
            Verdict::Proved | Verdict::Open => self.word().to_owned(),
        }
    }
}

impl Side {
    /// An expression.
    pub(crate) fn of(e: Expr<'_>) -> Side {
        Side::written(|style| e.display(style))
    }

    /// What is written in each style.
    pub(crate) fn written(write: impl Fn(Style) -> String) -> Side {
        Side { book: write(Style::Book), latex: write(Style::Latex), text: write(Style::Text) }
    }

    /// A symbol of mathematics that is the same in plain text everywhere.
    pub(crate) fn symbol(plain: &str, latex: &str) -> Side {
        Side { book: plain.to_owned(), latex: latex.to_owned(), text: plain.to_owned() }
    }

    /// (f, g)
    pub(crate) fn bracket(f: Expr<'_>, g: Expr<'_>) -> Side {
        Side::written(|style| match style {
            Style::Latex => format!("({},\\, {})", f.display(style), g.display(style)),
            Style::Book | Style::Text => format!("({}, {})", f.display(style), g.display(style)),
        })
    }

    /// df/dt of what has a name.
    pub(crate) fn rate_of(name: &str) -> Side {
        let plain = format!("d/dt {name}");
        Side {
            latex: format!("\\frac{{d}}{{dt}}\\text{{{}}}", in_text(name)),
            book: plain.clone(),
            text: plain,
        }
    }
}

/// Words within a formula of LaTeX.
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

impl Entry {
    /// Left = right.
    pub(crate) fn formula(left: Side, right: Side) -> Entry {
        Entry { formulas: vec![(left, right)], ..Entry::default() }
    }

    /// Something to be said.
    pub(crate) fn words(words: impl Into<String>) -> Entry {
        Entry { words: vec![words.into()], ..Entry::default() }
    }

    pub(crate) fn named(self, name: impl Into<String>) -> Entry {
        Entry { name: Some(name.into()), ..self }
    }

    pub(crate) fn with(self, verdict: Verdict) -> Entry {
        Entry { verdict: Some((None, verdict)), ..self }
    }

    /// With a verdict on something else than its formulas.
    pub(crate) fn with_on(self, subject: &'static str, verdict: Verdict) -> Entry {
        Entry { verdict: Some((Some(subject), verdict)), ..self }
    }

    pub(crate) fn say(mut self, words: impl Into<String>) -> Entry {
        self.words.push(words.into());
        self
    }
}
