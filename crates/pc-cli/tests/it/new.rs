//! Models to start from: they run, agree with their second derivation, and replace nothing.

use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use clap::ValueEnum;
use pc_cli::args::tools::Kind;
use pc_model::document::SCHEMA;
use pc_model::{Document, Model, Source};
use pc_verify::{Options, verify};

fn pc(directory: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_pc"));
    command.args(arguments).current_dir(directory).stdin(Stdio::null()).output().expect("pc starts")
}

fn said(output: &Output) -> &str {
    std::str::from_utf8(&output.stderr).expect("UTF-8")
}

fn kinds() -> Vec<(Kind, String)> {
    let name = |kind: &Kind| kind.to_possible_value().expect("a name").get_name().to_owned();
    Kind::value_variants().iter().map(|kind| (*kind, name(kind))).collect()
}

#[test]
fn each_text_is_checked_derived_and_run() {
    let directory = tempfile::tempdir().expect("a directory");
    let here = directory.path();
    for (kind, name) in kinds() {
        let file = format!("{name}.toml");
        let made = pc(here, &["new", &name, "-o", &file]);
        assert!(made.status.success() && made.stdout.is_empty(), "{}", said(&made));
        let expected =
            format!("{file}: now `pc check {file}`, `pc derive {file}`, `pc run {file}`, `pc live {file}`\n");
        assert_eq!(said(&made), expected);
        assert_eq!(fs::read_to_string(here.join(&file)).expect("a file"), kind.text());
        for output in [pc(here, &["new", &name]), pc(here, &["new", &name, "-o", "-"])] {
            assert!(output.status.success() && output.stdout == kind.text().as_bytes(), "{name}");
        }
        for command in ["check", "derive", "run", "animate"] {
            let output = pc(here, &[command, &file]);
            assert!(output.status.success(), "{command} {file}: {}", said(&output));
            assert!(
                command != "run" || said(&output).contains("at the start and at the end"),
                "{}",
                said(&output)
            );
        }
    }
}

/// There is no disagreement, and there were states to compare at.
#[test]
fn each_text_agrees_with_its_second_derivation() {
    for (kind, name) in kinds() {
        let document = Document::parse(Source::new(format!("{name}.toml"), kind.text()));
        let model = Model::new(document.unwrap_or_else(|error| panic!("{error}")));
        let agreement = model.derived(|assembly| {
            verify(&model, assembly, &Options { states: 50, seed: 3, ..Options::default() })
        });
        let agreement = agreement.unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(agreement.states, 50, "{name}: {agreement}");
        // The table of its input begins where the motion does: no state is tried before.
        assert!(name != "control" || agreement.skipped == 0, "{agreement}");
    }
}

/// Declared integrals are conserved to 1e-6 of their size, a thousand times the tolerance of a
/// step.
#[test]
fn integrals_of_the_texts_are_integrals() {
    let directory = tempfile::tempdir().expect("a directory");
    let drifts = |name: &str| {
        let file = directory.path().join(format!("{name}.json"));
        assert!(pc(directory.path(), &["new", name, "-o", "model.toml"]).status.success());
        let output = pc(directory.path(), &["run", "model.toml", "-o", file.to_str().expect("UTF-8")]);
        assert!(output.status.success(), "{}", said(&output));
        fs::remove_file(directory.path().join("model.toml")).expect("there");
        let json: serde_json::Value = serde_json::from_slice(&fs::read(file).expect("a file")).expect("JSON");
        json["summary"]["drift"].as_object().expect("an object").clone()
    };
    for (name, integrals) in
        [("rigid-body", &["vertical", "spin", "energy"][..]), ("nonholonomic", &["turning", "energy"])]
    {
        let drifts = drifts(name);
        assert_eq!(drifts.keys().map(String::as_str).collect::<Vec<_>>(), integrals);
        for (integral, drift) in drifts {
            assert!(drift["relative"].as_f64().expect("a number") < 1e-6, "{name} {integral}: {drift}");
        }
    }
}

#[test]
fn nothing_is_replaced() {
    let directory = tempfile::tempdir().expect("a directory");
    let here = directory.path();
    fs::write(here.join("mine.toml"), "precious").expect("written");
    let refused = |file: &str, reason: &str| {
        let output = pc(here, &["new", "coordinates", "-o", file]);
        let message = format!("pc: cannot write {file}; nothing was computed\n  because: {reason}\n");
        assert_eq!((output.status.code(), said(&output)), (Some(2), message.as_str()));
    };
    let there = "it is there already, and nothing is replaced; give another name";
    refused("mine.toml", there);
    assert_eq!(fs::read_to_string(here.join("mine.toml")).expect("a file"), "precious");
    refused("no/such/model.toml", "there is no directory no/such");
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("elsewhere.toml", here.join("link.toml")).expect("a link");
        refused("link.toml", there);
        assert!(!here.join("elsewhere.toml").exists());
        fs::remove_file(here.join("link.toml")).expect("a link");
    }
    let left: Vec<_> =
        fs::read_dir(here).expect("a directory").map(|entry| entry.expect("one").path()).collect();
    assert_eq!(left, [here.join("mine.toml")], "nothing else is left");
}

/// The first line of the model names the file beside it.
#[test]
fn the_schema_is_written_beside_the_model_and_kept() {
    let directory = tempfile::tempdir().expect("a directory");
    let here = directory.path();
    let (model, schema) = (here.join("a.toml"), here.join("pc-model.schema.json"));
    assert!(pc(here, &["new", "joints", "-o", "a.toml", "--schema"]).status.success());
    let text = fs::read_to_string(&model).expect("a file");
    assert_eq!(text, format!("#:schema ./pc-model.schema.json\n{}", Kind::Joints.text()));
    assert_eq!(fs::read_to_string(&schema).expect("a file"), SCHEMA);
    assert!(pc(here, &["check", "a.toml"]).status.success());
    let again = pc(here, &["new", "joints", "-o", "b.toml", "--schema"]);
    assert!(again.status.success() && !said(&again).contains("note"), "{}", said(&again));
    fs::write(&schema, "{}").expect("written");
    let other = pc(here, &["new", "joints", "-o", "c.toml", "--schema"]);
    let note = "note: pc-model.schema.json is not what `pc schema` prints; it is kept as it is\n";
    assert!(other.status.success() && said(&other).starts_with(note), "{}", said(&other));
    assert_eq!(fs::read_to_string(&schema).expect("a file"), "{}");
    assert_eq!(pc(here, &["new", "joints", "--schema"]).status.code(), Some(2));
}

#[test]
fn an_unknown_kind_is_refused_with_the_existing_ones() {
    let output = pc(Path::new("."), &["new", "rigidbody"]);
    assert_eq!(output.status.code(), Some(2));
    let all = "[possible values: coordinates, rigid-body, nonholonomic, joints, control]";
    assert!(said(&output).contains(all) && said(&output).contains("'rigid-body'"), "{}", said(&output));
}
