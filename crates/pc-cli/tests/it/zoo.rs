//! The robots of `tests/zoo` move as by dynamics of another author, whose numbers Pinocchio confirms.

use std::collections::HashMap;
use std::path::PathBuf;

use pc_mech::{Graph, VectorField};
use pc_model::import::model_of_urdf;
use pc_model::{Document, Flow, Model, Source, Variables};
use serde_json::Value;

/// Rounding of the recursion, times the condition of a mass matrix: 8e5 for a snake of forty links.
const ROUNDING: f64 = 1e-10;

fn zoo(file: &str) -> String {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../tests/zoo").join(file);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn numbers(list: &Value) -> Vec<f64> {
    list.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

/// The child link of each joint.
fn children(urdf: &str) -> HashMap<String, String> {
    let options = roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() };
    let document = roxmltree::Document::parse_with_options(urdf, options).unwrap();
    let joints = document.root_element().children().filter(|node| node.tag_name().name() == "joint");
    let pair = |joint: roxmltree::Node<'_, '_>| {
        let child = joint.children().find(|node| node.tag_name().name() == "child")?;
        Some((joint.attribute("name")?.to_owned(), child.attribute("link")?.to_owned()))
    };
    joints.filter_map(pair).collect()
}

/// The body of each link: of the same name, unless a comment below the head of its section says of which link it is.
fn bodies(document: &Document, model: &str) -> HashMap<String, String> {
    let link = |body: &str, place: usize| {
        let below = model[place..].lines().nth(1).unwrap_or_default();
        below.strip_prefix("# the link ").unwrap_or(body).to_owned()
    };
    let tree = document.tree.iter();
    tree.map(|body| {
        let label = body.name.text.clone();
        (link(&label, body.name.place.span.start), label)
    })
    .collect()
}

#[test]
fn robots_of_the_zoo_move_as_by_other_dynamics() {
    let known: HashMap<String, Value> = serde_json::from_str(&zoo("accelerations.json")).unwrap();
    let mut complaints = Vec::new();
    for (name, robot) in &known {
        let urdf = zoo(&format!("{name}.urdf"));
        let source = Source::from_bytes(format!("{name}.urdf"), urdf.as_bytes());
        let floats = robot["floating"].as_bool().unwrap();
        let (text, _) = model_of_urdf(&source, floats).unwrap_or_else(|error| panic!("{error}"));
        let document = Document::parse(Source::new(format!("{name}.toml"), &text)).unwrap();
        let (children, bodies) = (children(urdf.trim_start_matches('\u{feff}')), bodies(&document, &text));
        let model = Model::new(document);
        let graph = Graph::new();
        let assembly = model.assemble(&graph).unwrap_or_else(|error| panic!("{error}"));
        let mut flow = Flow::new(&model, &assembly, Variables::QuasiVelocities)
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        let names = flow.motion.names().to_vec();
        let place = |name: &str| names.iter().position(|known| known == name);
        let mut state = vec![0.0; names.len()];
        let mut expected = vec![f64::NAN; names.len()];
        for joint in robot["joints"].as_array().unwrap() {
            let child = joint["name"].as_str().filter(|name| !name.is_empty()).map(|name| &children[name]);
            // The root hangs on the world by the joint without a name.
            let body = match child {
                Some(link) => &bodies[link],
                None => &model.document().tree[0].name.text,
            };
            let joint_of_text = model.document().tree.iter().find(|known| known.name.text == *body).unwrap();
            let coordinates = joint_of_text.joint.coordinates.iter().zip(numbers(&joint["q"]));
            for (x, value) in coordinates {
                state[place(&x.text).unwrap()] = value;
            }
            let velocities = joint_of_text.joint.quasi_velocities.iter();
            let values = numbers(&joint["v"]).into_iter().zip(numbers(&joint["acceleration"]));
            for (eta, (value, rate)) in velocities.zip(values) {
                state[place(&eta.text).unwrap()] = value;
                expected[place(&eta.text).unwrap()] = rate;
            }
        }
        let mut rates = vec![f64::NAN; state.len()];
        flow.motion.rhs(0.0, &state, &mut rates).unwrap_or_else(|error| panic!("{name}: {error}"));
        let compared: Vec<(f64, f64)> =
            rates.into_iter().zip(expected).filter(|(_, expected)| !expected.is_nan()).collect();
        let size = compared.iter().fold(1.0f64, |size, (_, expected)| size.max(expected.abs()));
        let apart = compared.iter().fold(0.0, |apart: f64, (a, b)| apart.max((a - b).abs() / size));
        if apart.is_nan() || apart > ROUNDING || compared.is_empty() {
            complaints.push(format!("{name}: apart by {apart:e} of {size}"));
        }
    }
    assert!(known.len() >= 60 && complaints.is_empty(), "{complaints:#?}");
}
