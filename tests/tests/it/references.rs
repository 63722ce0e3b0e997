//! What is cited is among the references, once.

use std::fs;
use std::path::{Path, PathBuf};

const REFERENCES: &str = include_str!("../../../docs/references.md");

fn entries() -> Vec<&'static str> {
    REFERENCES.lines().filter_map(|line| line.strip_prefix("- ")).collect()
}

/// Files of source, text and models below a directory of the repository.
fn files(directory: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(directory).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir() && name != "target" {
            files(&path, found);
        } else if [".rs", ".toml", ".c", ".cpp", ".h", ".hpp"].iter().any(|end| name.ends_with(end)) {
            found.push(path);
        }
    }
}

/// A year of a citation: four digits by themselves.
fn year(text: &str) -> Option<&str> {
    let mut words = text.split(|c: char| !c.is_alphanumeric());
    words.find(|word| word.len() == 4 && matches!(word.parse(), Ok(1600..2100)))
}

/// The surname of the first author: the first word that is no initial.
fn surname(text: &str) -> Option<&str> {
    let mut words = text.split([' ', ',', '(']);
    words.find(|word| word.chars().count() > 2 && word.starts_with(char::is_uppercase) && !word.contains('.'))
}

/// The citations of a file with their years: `[Author …, year]` in comments, and the `reference` of a model.
fn citations(text: &str) -> Vec<String> {
    let models = text.lines().filter_map(|line| line.strip_prefix("reference = \"")?.strip_suffix('"'));
    let comment = |line: &str| {
        let line = line.trim_start();
        line.strip_prefix("//").map(|rest| rest.trim_start_matches(['/', '!']).trim_start().to_owned() + " ")
    };
    // Lines without a comment end a comment.
    let comments: String =
        text.lines().map(|line| comment(line).unwrap_or_else(|| "\n".to_owned())).collect();
    let bracketed = comments.lines().flat_map(|line| {
        let parts = line.split('[').skip(1).filter_map(|part| part.split_once(']'));
        parts.map(|(inside, _)| inside.to_owned()).collect::<Vec<_>>()
    });
    let cited =
        models.map(str::to_owned).chain(bracketed.filter(|inside| inside.starts_with(char::is_uppercase)));
    cited.flat_map(|list| list.split(';').map(|one| one.trim().to_owned()).collect::<Vec<_>>()).collect()
}

#[test]
fn every_work_that_is_cited_is_among_the_references() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let mut found = Vec::new();
    ["crates", "tests", "include", "examples-c"].iter().for_each(|part| files(&root.join(part), &mut found));
    found.sort();
    let (mut missing, mut count) = (Vec::new(), 0);
    for path in found {
        let text = fs::read_to_string(&path).unwrap_or_default();
        for citation in citations(&text) {
            let (Some(surname), Some(year)) = (surname(&citation), year(&citation)) else { continue };
            count += 1;
            if !entries().iter().any(|entry| entry.contains(surname) && entry.contains(year)) {
                missing.push(format!("{}: {citation}", path.strip_prefix(root).unwrap().display()));
            }
        }
    }
    assert!(missing.is_empty(), "{}", missing.join("\n"));
    assert!(count > 80, "only {count} citations are found");
}

#[test]
fn each_reference_stands_once_with_its_year() {
    let entries = entries();
    assert!(entries.len() > 80);
    for (i, entry) in entries.iter().enumerate() {
        assert!(!entries[..i].contains(entry), "{entry} stands twice");
        assert!(year(entry).is_some() || entry.contains("Landau"), "{entry} has no year");
    }
}
