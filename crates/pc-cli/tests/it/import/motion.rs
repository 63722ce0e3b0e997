//! Robots as models, and their motion.

use pc_mech::{Graph, VectorField};
use pc_model::import::model_of_urdf;
use pc_model::{Document, Flow, Model, Source, Variables};

pub(super) fn robot(name: &str) -> String {
    let path = format!("{}/../../tests/robots/{name}.urdf", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(path).unwrap()
}

pub(super) fn imported(name: &str, floats: bool) -> (String, Vec<String>) {
    let source = Source::new(format!("{name}.urdf"), robot(name));
    model_of_urdf(&source, floats).unwrap_or_else(|error| panic!("{error}"))
}

pub(super) fn flow(text: &str) -> Flow {
    let document =
        Document::parse(Source::new("m.toml", text)).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let (model, graph) = (Model::new(document), Graph::new());
    let assembly = model.assemble(&graph).unwrap_or_else(|error| panic!("{error}"));
    Flow::new(&model, &assembly, Variables::QuasiVelocities).unwrap()
}

pub(super) fn rates(flow: &mut Flow, state: &[f64]) -> Vec<f64> {
    let mut rates = vec![f64::NAN; state.len()];
    flow.motion.rhs(0.0, state, &mut rates).unwrap();
    rates
}

#[track_caller]
pub(super) fn alike(one: &[f64], two: &[f64]) {
    assert_eq!(one.len(), two.len());
    let apart = one.iter().zip(two).map(|(a, b)| (a - b).abs() / a.abs().max(1.0)).fold(0.0, f64::max);
    // Rounding of a few hundred operations, with a mass matrix of condition number 1e4.
    assert!(apart < 1e-10, "{apart}\n{one:?}\n{two:?}");
}

pub(super) fn text_of(urdf: &str) -> (String, Vec<String>) {
    model_of_urdf(&Source::new("r.urdf", urdf), false).unwrap_or_else(|error| panic!("{error}"))
}
