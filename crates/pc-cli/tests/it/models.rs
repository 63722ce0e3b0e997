//! `pc models`: the list of models, chosen by tags.

use std::process::{Command, Output};

use pc_model::{Builtin, TAGS};
use serde_json::Value;

fn pc(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pc")).args(arguments).output().expect("pc starts")
}

#[track_caller]
fn printed(arguments: &[&str]) -> String {
    let output = pc(arguments);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("UTF-8")
}

fn names(text: &str) -> Vec<&str> {
    let entries = text.lines().filter(|line| !line.starts_with(' '));
    entries.filter_map(|line| line.split_whitespace().next()).collect()
}

#[test]
fn models_are_chosen_that_have_all_tags() {
    for tag in TAGS {
        let listed = printed(&["models", "--tag", tag.name]);
        let wanted: Vec<&str> =
            Builtin::all().map(|model| model.name).filter(|name| tag.models.contains(name)).collect();
        assert_eq!(names(&listed), wanted, "{}", tag.name);
    }
    let both = printed(&["models", "--tag", "events", "--tag", "rolling"]);
    assert!(names(&both).contains(&"rocking-disk") && !names(&both).contains(&"bouncing-ball"), "{both}");
    assert!(printed(&["models", "--tag", "joints", "--tag", "relativistic"]).is_empty());
}

#[test]
fn models_of_a_tag_are_listed_with_references_and_tags() {
    let listed = printed(&["models", "--tag", "stiff"]);
    insta::assert_snapshot!(listed);
    let all = printed(&["models", "--long"]);
    assert_eq!(names(&all), Builtin::all().map(|model| model.name).collect::<Vec<_>>());
    let indented =
        |text: &str| -> Vec<String> { text.lines().skip(1).map(|line| line.trim().to_owned()).collect() };
    assert!(indented(&listed).iter().all(|line| all.contains(line)));
}

#[test]
fn tags_are_listed_with_the_number_of_their_models() {
    let listed = printed(&["models", "--tags"]);
    for (line, tag) in listed.lines().zip(TAGS) {
        let words: Vec<&str> = line.split_whitespace().collect();
        assert_eq!((words[0], words[1]), (tag.name, tag.models.len().to_string().as_str()));
        assert!(line.ends_with(tag.meaning), "{line}");
    }
    assert_eq!(listed.lines().count(), TAGS.len());
}

/// Every model has a title, a description and a reference.
#[test]
fn the_list_for_programs_is_complete() {
    let listed: Value = serde_json::from_str(&printed(&["models", "--format", "json"])).expect("JSON");
    let listed = listed.as_array().expect("a list");
    assert_eq!(listed.len(), Builtin::all().count());
    for (entry, model) in listed.iter().zip(Builtin::all()) {
        assert_eq!(entry["name"], model.name);
        for key in ["title", "description", "reference"] {
            assert!(entry[key].as_str().is_some_and(|text| !text.is_empty()), "{} has no {key}", model.name);
        }
        let tags: Vec<&str> = model.tags().map(|tag| tag.name).collect();
        assert_eq!(entry["tags"], Value::from(tags));
    }
}

#[test]
fn an_unknown_tag_is_refused_with_the_nearest_one() {
    let refused = |arguments: &[&str], message: &str| {
        let output = pc(arguments);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains(message) && output.stdout.is_empty(), "{said}");
    };
    refused(
        &["models", "--tag", "nonholonomc"],
        "pc: there is no tag `nonholonomc`; did you mean `nonholonomic`?\n",
    );
    refused(
        &["models", "--tag", "quantum"],
        "pc: there is no tag `quantum` (`pc models --tags` lists them)\n",
    );
    refused(&["models", "euler-top", "--tag", "top"], "cannot be used with");
    refused(&["models", "--tags", "--algebras"], "cannot be used with");
}
