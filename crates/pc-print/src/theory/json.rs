//! The theory for programs, as JSON.

use serde_json::{Map, Value, json};

use crate::theory::description::{Entry, Theory, Verdict};

/// The sections, under their keys, each as a list of entries.
pub(crate) fn written(theory: &Theory<'_>) -> Value {
    let mut object = Map::new();
    object.insert("model".to_owned(), json!(theory.title));
    let names = theory.sections.iter().flat_map(|section| &section.names);
    let names: Vec<Value> =
        names.map(|(name, value)| json!({ "name": name.text, "value": value.text })).collect();
    if !names.is_empty() {
        object.insert("definitions".to_owned(), json!(names));
    }
    for section in &theory.sections {
        object.insert(section.key.to_owned(), section.entries.iter().map(entry).collect());
    }
    Value::Object(object)
}

fn entry(entry: &Entry<'_>) -> Value {
    let mut object = Map::new();
    let mut insert = |key: &str, value: Value| object.insert(key.to_owned(), value);
    if let Some(name) = &entry.name {
        insert("name", json!(name));
    }
    if !entry.formulas.is_empty() {
        let formulas = entry.formulas.iter();
        insert(
            "formulas",
            formulas.map(|(left, right)| json!({ "left": left.text, "right": right.text })).collect(),
        );
    }
    if !entry.values.is_empty() {
        let values = entry.values.iter().map(|(name, value)| (name.clone(), json!(value)));
        insert("values", Value::Object(values.collect()));
    }
    if let Some((subject, verdict)) = entry.verdict {
        if let Some(subject) = subject {
            insert("verdict_on", json!(subject));
        }
        insert("verdict", json!(verdict.word()));
        match verdict {
            Verdict::ProvedHere => {
                insert("for_these_parameters", json!(true));
            }
            Verdict::Disproved { margin } | Verdict::Unstable { growth: margin } => {
                insert("margin", json!(margin));
            }
            Verdict::Proved | Verdict::Open => {}
        }
    }
    if !entry.words.is_empty() {
        insert("words", json!(entry.words));
    }
    Value::Object(object)
}
