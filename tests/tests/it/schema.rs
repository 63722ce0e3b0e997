//! The JSON Schema of the text format: it has the entries and choices that the reader accepts, no others, and all models are
//! valid.

mod validator;

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use pc_mech::Graph;
use pc_model::document::SCHEMA;
use pc_model::{Builtin, Document, ErrorKind, Model, ModelError, Source};
use serde_json::{Value, json};

use validator::refusal;

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/..");

fn schema() -> Value {
    serde_json::from_str(SCHEMA).unwrap()
}

/// TOML as JSON; dates, which no model has, are text.
fn json_of(text: &str) -> Value {
    fn converted(value: toml::Value) -> Value {
        match value {
            toml::Value::String(text) => Value::from(text),
            toml::Value::Integer(number) => Value::from(number),
            toml::Value::Float(number) => Value::from(number),
            toml::Value::Boolean(value) => Value::from(value),
            toml::Value::Datetime(date) => Value::from(date.to_string()),
            toml::Value::Array(list) => list.into_iter().map(converted).collect(),
            toml::Value::Table(table) => {
                table.into_iter().map(|(key, value)| (key, converted(value))).collect()
            }
        }
    }
    converted(toml::Value::Table(text.parse().unwrap()))
}

fn texts_of(directory: &str) -> Vec<(String, String)> {
    let entries = fs::read_dir(Path::new(ROOT).join(directory)).unwrap().map(|entry| entry.unwrap().path());
    let texts = entries.filter(|path| path.extension().is_some_and(|extension| extension == "toml"));
    texts.map(|path| (path.display().to_string(), fs::read_to_string(&path).unwrap_or_default())).collect()
}

fn read(text: &str) -> Result<Document, ModelError> {
    Document::parse(Source::new("model.toml", text))
}

#[test]
fn all_models_are_valid() {
    let mut texts: Vec<(String, String)> =
        Builtin::all().map(|model| (model.name.to_owned(), model.text.to_owned())).collect();
    texts.extend(["crates/pc-cli/starters", "tests/mechanisms"].into_iter().flat_map(texts_of));
    let page = fs::read_to_string(Path::new(ROOT).join("docs/model-format.md")).unwrap();
    let blocks = page.split("\n```toml\n").skip(1).map(|block| block.split("\n```").next().unwrap());
    texts.extend(blocks.enumerate().map(|(i, block)| (format!("example {i} of the page"), block.to_owned())));
    assert!(texts.len() > 80, "{} texts", texts.len());
    let schema = schema();
    for (name, text) in texts {
        assert_eq!(refusal(&schema, &json_of(&text)), None, "{name}");
    }
}

/// The schema knows less than the reader: what it refuses, the reader refuses.
#[test]
fn what_the_schema_refuses_is_refused() {
    let schema = schema();
    let mut refused = 0;
    for (name, text) in texts_of("tests/malformed") {
        if text.parse::<toml::Table>().is_ok() && refusal(&schema, &json_of(&text)).is_some() {
            refused += 1;
            let model =
                read(&text).and_then(|document| Model::new(document).assemble(&Graph::new()).map(|_| ()));
            assert!(model.is_err(), "{name}");
        }
    }
    assert!(refused >= 15, "{refused} of the malformed models");
}

/// For each object of the schema with entries: its place, and text in which `WRONG` stands among these.
const OBJECTS: &[(&str, &str)] = &[
    ("/properties/model", "[model]\nWRONG = 1"),
    ("/properties/algebra", "[algebra]\nWRONG = 1"),
    ("/properties/lagrangian", "[lagrangian]\nWRONG = 1"),
    ("/properties/gravity", "[gravity]\nWRONG = 1"),
    ("/properties/drawing", "[drawing]\nWRONG = 1"),
    ("/properties/hamilton_jacobi", "[hamilton_jacobi]\nWRONG = 1"),
    ("/properties/simulation", "[simulation]\nWRONG = 1"),
    // The reader knows both kinds of table together.
    ("/definitions/input_table", "[inputs]\na = { WRONG = 1 }"),
    ("/definitions/input_file", "[inputs]\na = { WRONG = 1 }"),
    ("/definitions/function", "[functions]\nV = { of = \"r\", WRONG = 1 }"),
    ("/definitions/quasi_velocity", "[quasi_velocities]\na = { WRONG = 1 }"),
    ("/definitions/state", "[states]\na = { WRONG = 1 }"),
    ("/definitions/constraint", "[constraints]\na = { WRONG = 1 }"),
    ("/definitions/body", "[bodies.a]\nWRONG = 1"),
    ("/definitions/body_on_joint", "[bodies.a]\ncenter = [0, 0, 0]\nWRONG = 1"),
    ("/definitions/joint", "[bodies.a]\njoint = { WRONG = 1 }"),
    ("/definitions/point", "[points.a]\nWRONG = 1"),
    ("/definitions/loop", "[loops.a]\nWRONG = 1"),
    ("/definitions/contact", "[contacts.a]\nWRONG = 1"),
    ("/definitions/shape/oneOf/0", "[[draw]]\nkind = \"point\"\nWRONG = 1"),
    ("/definitions/shape/oneOf/1", "[[draw]]\nkind = \"line\"\nWRONG = 1"),
    ("/definitions/shape/oneOf/2", "[[draw]]\nkind = \"disc\"\nWRONG = 1"),
    ("/definitions/shape/oneOf/3", "[[draw]]\nkind = \"ring\"\nWRONG = 1"),
    ("/definitions/shape/oneOf/4", "[[draw]]\nkind = \"sphere\"\nWRONG = 1"),
    ("/definitions/shape/oneOf/5", "[[draw]]\nkind = \"box\"\nWRONG = 1"),
    ("/definitions/shape/oneOf/6", "[[draw]]\nkind = \"mesh\"\nWRONG = 1"),
    ("/definitions/shape/oneOf/7", "[[draw]]\nkind = \"spring\"\nWRONG = 1"),
    ("/definitions/shape/oneOf/8", "[[draw]]\nkind = \"trace\"\nWRONG = 1"),
    ("/definitions/shape/oneOf/9", "[[draw]]\nkind = \"text\"\nWRONG = 1"),
    ("/definitions/event", "[events.a]\nWRONG = 1"),
];

/// For each choice of the schema: its place, and text in which `WRONG` stands for it.
const CHOICES: &[(&str, &str)] = &[
    ("/properties/simulation/properties/method", "[simulation]\nmethod = \"WRONG\""),
    ("/properties/simulation/properties/form", "[simulation]\nform = \"WRONG\""),
    ("/definitions/input_table/properties/interpolation", "[inputs]\na = { interpolation = \"WRONG\" }"),
    ("/definitions/input_file/properties/interpolation", "[inputs]\na = { interpolation = \"WRONG\" }"),
    ("/definitions/constraint/properties/kind", "[constraints]\na = { kind = \"WRONG\" }"),
    ("/definitions/joint/properties/kind", "[bodies.a]\njoint = { kind = \"WRONG\" }"),
    ("/definitions/loop/properties/kind", "[loops.a]\nkind = \"WRONG\""),
    ("/definitions/contact/properties/shape", "[contacts.a]\nshape = \"WRONG\""),
    ("/definitions/contact/properties/motion", "[contacts.a]\nmotion = \"WRONG\""),
    ("/definitions/event/properties/direction", "[events.a]\ndirection = \"WRONG\""),
];

fn words<'w>(words: impl IntoIterator<Item = &'w str>) -> BTreeSet<String> {
    words.into_iter().map(str::to_owned).collect()
}

fn keys(object: &Value) -> BTreeSet<String> {
    words(object["properties"].as_object().unwrap().keys().map(String::as_str))
}

fn kind_of(text: &str) -> ErrorKind {
    read(text).map(|_| ()).unwrap_err().kind().clone()
}

#[test]
fn the_entries_are_those_that_the_reader_accepts() {
    let schema = schema();
    let help = kind_of("[nonsense]\n").help();
    let (_, sections) = help.split_once("the sections are ").unwrap();
    assert_eq!(keys(&schema), words(sections.split(", ")), "sections");
    for (place, text) in OBJECTS {
        let ErrorKind::UnknownKey { allowed, .. } = kind_of(text) else { panic!("{text}") };
        let mut known = keys(schema.pointer(place).unwrap());
        if place.starts_with("/definitions/input_") {
            let [table, file] = ["/definitions/input_table", "/definitions/input_file"];
            known =
                [table, file].into_iter().flat_map(|place| keys(schema.pointer(place).unwrap())).collect();
        }
        assert_eq!(known, words(allowed.iter().copied()), "{place}");
    }
}

#[test]
fn the_choices_are_those_that_the_reader_accepts() {
    let schema = schema();
    for (place, text) in CHOICES {
        let ErrorKind::UnknownChoice { allowed, .. } = kind_of(text) else { panic!("{text}") };
        let known = schema.pointer(place).unwrap()["enum"].as_array().unwrap();
        assert_eq!(words(known.iter().filter_map(Value::as_str)), words(allowed), "{place}");
    }
    let ErrorKind::UnknownChoice { allowed, .. } = kind_of("[[draw]]\nkind = \"WRONG\"") else {
        panic!("shapes")
    };
    let shapes = schema["definitions"]["shape"]["oneOf"].as_array().unwrap();
    let shapes = shapes.iter().map(|shape| shape["properties"]["kind"]["enum"][0].as_str().unwrap());
    assert_eq!(words(shapes), words(allowed), "shapes");
}

/// No object and no choice of the schema is left out above.
#[test]
fn every_object_and_choice_of_the_schema_is_compared() {
    fn collect(value: &Value, place: &str, objects: &mut BTreeSet<String>, choices: &mut BTreeSet<String>) {
        if value.get("properties").is_some_and(Value::is_object)
            && value.get("type").is_some()
            && !place.is_empty()
        {
            objects.insert(place.to_owned());
        }
        if value.get("enum").is_some_and(Value::is_array) && !place.contains("/shape/") {
            choices.insert(place.to_owned());
        }
        match value {
            Value::Object(entries) => {
                entries
                    .iter()
                    .for_each(|(key, entry)| collect(entry, &format!("{place}/{key}"), objects, choices));
            }
            Value::Array(list) => {
                let elements = list.iter().enumerate();
                elements.for_each(|(i, entry)| collect(entry, &format!("{place}/{i}"), objects, choices));
            }
            _ => {}
        }
    }
    let (mut objects, mut choices) = (BTreeSet::new(), BTreeSet::new());
    collect(&schema(), "", &mut objects, &mut choices);
    assert_eq!(objects, words(OBJECTS.iter().map(|(place, _)| *place)));
    assert_eq!(choices, words(CHOICES.iter().map(|(place, _)| *place)));
}

#[test]
fn types_and_lengths_are_known() {
    let schema = schema();
    let valid = |text: &str| refusal(&schema, &json_of(text)).is_none();
    for text in [
        "[simulation]\nt_end = 1\nsamples = 2",
        "[bodies.a]\nmass = 1\nposition = [0, \"x\", 0]\ninertia = [1, 1, 1, 0, 0, 0]\nrotation = [1,0,0,0,1,0,0,0,1]",
        "[algebra]\nname = \"so3\"",
    ] {
        assert!(valid(text), "{text}");
    }
    for text in [
        "x = 1",
        "[nonsense]",
        "[simulation]\nsamples = 1",
        "[simulation]\nsamples = 2.5",
        "[simulation]\nrtol = 0",
        "[simulation]\naccumulation = 1.0",
        "[coordinates]\nx = true",
        "[bodies.a]\nmass = 1",
        "[bodies.a]\nmass = 1\nposition = [0, 0]",
        "[bodies.a]\nmass = 1\nposition = [0, 0, 0]\ninertia = [1, 1, 1, 0]",
        "[bodies.a]\nmass = 1\nposition = [0, 0, 0]\njoint = { kind = \"fixed\" }",
        "[algebra]\nname = \"so3\"\nbrackets = {}",
        "[inputs]\nu = { times = [0], values = [0], file = \"x.csv\" }",
        "[draw]\nkind = \"point\"",
        "[[draw]]\nkind = \"point\"\nat = [0, 0]\nradius = 1",
    ] {
        assert!(!valid(text), "{text}");
        assert!(read(text).is_err(), "{text}");
    }
    assert_eq!(refusal(&schema, &json!([])), Some(": type \"object\"".to_owned()));
}
