//! Model files that must be refused, each wrong in exactly one way, and what must be said of them.
//!
//! The files lie in `malformed/` beside `src/`. `pc run` must end on each with the exit code named here, without a
//! panic, and with a message on standard error that names the file and the line and shows the offending text.
//! Applying the [`correction`](Malformed::correction) makes a model that runs: nothing else is wrong with it.

mod expressions;
mod meaning;
mod text;

use std::path::PathBuf;

/// A model file that must be refused.
#[derive(Clone, Copy, Debug)]
pub struct Malformed {
    /// File name in `malformed/`.
    pub file: &'static str,
    /// What is wrong with it.
    pub fault: &'static str,
    /// 2: no end time; 3: the text is wrong; 4: the text is right and the model inconsistent.
    pub exit_code: i32,
    /// Texts of which at least one must occur in the message, in any case of letters.
    pub mentions: &'static [&'static str],
    /// The line the message must name, counted from 1, where one line is to blame.
    pub line: Option<usize>,
    /// The wrong text, which occurs once in the file, and what to put in its place.
    pub correction: Option<(&'static str, &'static str)>,
}

impl Malformed {
    /// Where the file lies.
    pub fn path(&self) -> PathBuf {
        directory().join(self.file)
    }
}

/// The directory of the malformed files.
pub fn directory() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("malformed")
}

/// The malformed files, topic by topic.
pub fn malformed() -> impl Iterator<Item = &'static Malformed> {
    [text::TEXT, expressions::EXPRESSIONS, meaning::MEANING].into_iter().flatten()
}

/// A model nested so deeply that a careless reader overflows its stack; too dull to be stored.
#[derive(Clone, Debug)]
pub struct DeeplyNested {
    /// What is nested.
    pub what: &'static str,
    /// The text of the model.
    pub text: String,
    /// Exit codes that are right: 3 for nesting beyond the bound, and 0 where a reader may do without nesting.
    pub exit_codes: &'static [i32],
}

/// Models nested to a depth of `depth`, such as 10 000.
pub fn deeply_nested(depth: usize) -> Vec<DeeplyNested> {
    let model = |start: &str, potential: &str| {
        format!(
            "[coordinates]\nx = {start}\n\n[quasi_velocities]\n\"x'\" = 1.0\n\n\
             [lagrangian]\nkinetic = \"x'^2/2\"\npotential = \"{potential}\"\n\n\
             [simulation]\nt_end = 1.0\n"
        )
    };
    let around = |open: &str, middle: &str, close: &str| open.repeat(depth) + middle + &close.repeat(depth);
    let nested = |what, text, exit_codes| DeeplyNested { what, text, exit_codes };
    vec![
        nested("parentheses", model("0.5", &around("(", "x", ")")), &[3]),
        nested("open parentheses", model("0.5", &around("(", "x", "")), &[3]),
        nested("functions", model("0.5", &around("sin(", "x", ")")), &[3]),
        nested("powers", model("0.5", &around("x^", "x", "")), &[0, 3]),
        nested("minus signs", model("0.5", &around("-", "x", "")), &[0, 3]),
        nested("arrays", model(&around("[", "0.5", "]"), "x"), &[3]),
        nested("inline tables", model(&around("{ a = ", "0.5", " }"), "x"), &[3]),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn table_and_directory_list_the_same_files() {
        let listed: BTreeSet<String> = malformed().map(|model| model.file.to_owned()).collect();
        assert_eq!(listed.len(), malformed().count());
        for topic in [text::TEXT, expressions::EXPRESSIONS, meaning::MEANING] {
            assert!(topic.is_sorted_by_key(|model| model.file));
        }
        let stored: BTreeSet<String> = std::fs::read_dir(directory())
            .expect("a directory")
            .map(|entry| entry.expect("an entry").file_name().into_string().expect("a UTF-8 name"))
            .collect();
        assert_eq!(listed, stored);
    }

    /// Where one text must be quoted and one line named, the text stands in that line.
    #[test]
    fn offending_text_stands_in_the_offending_line() {
        for model in malformed() {
            assert!(matches!(model.exit_code, 2..=4) && !model.mentions.is_empty(), "{}", model.file);
            let Ok(text) = String::from_utf8(std::fs::read(model.path()).expect(model.file)) else {
                assert_eq!(model.mentions, ["UTF-8"]);
                continue;
            };
            if let (Some(line), [mention]) = (model.line, model.mentions) {
                let line = text.lines().nth(line - 1).expect(model.file);
                assert!(line.contains(mention), "{}: {mention} not in {line}", model.file);
            }
        }
    }

    #[test]
    fn corrections_apply_once() {
        for model in malformed() {
            let Some((wrong, right)) = model.correction else { continue };
            let text = std::fs::read_to_string(model.path()).expect(model.file);
            assert_eq!(text.matches(wrong).count(), 1, "{}", model.file);
            assert_ne!(wrong, right);
        }
    }

    #[test]
    fn deep_models_are_deep() {
        for model in deeply_nested(1000) {
            assert!(model.text.len() > 1000, "{}", model.what);
        }
        // shallow enough to be right, apart from the types of the last two
        assert!(deeply_nested(1).iter().any(|model| model.text.contains("potential = \"sin(x)\"")));
    }
}
