//! The density of an invariant measure, times the compiled field, has no divergence: of random models. (Of the built-in models this
//! is a claim of the program `models`.)

use pc_mech::Graph;
use pc_model::{Document, Model, Source};
use pc_tests::fuzz::generator::specimen;
use pc_tests::fuzz::random::Random;
use pc_tests::fuzz::start::Start;
use pc_tests::fuzz::text;

use crate::divergence::Compared;

const ROUTH: &str = include_str!("../../systems/rouths-sphere.toml");

#[test]
fn measures_of_random_models_are_kept() {
    let mut compared = Compared::default();
    for index in 0..300 {
        let specimen = specimen(3, index);
        let Some(start) = Start::of(&specimen) else { continue };
        let text = text::model(&specimen, &start);
        let Ok(document) = Document::parse(Source::new("random", &text)) else { continue };
        let graph = Graph::new();
        let Ok(assembly) = Model::new(document).assemble(&graph) else { continue };
        let Ok(free) = assembly.free_system() else { continue };
        compared.compare(&text, &assembly, &free, &mut Random::new(2, index));
    }
    assert!(compared.measures >= 60 && compared.varying >= 20 && compared.states >= 300, "{compared:?}");
}

/// The density of Routh's sphere is a power of a polynomial in γ, which no entry of the mass matrix shows.
#[test]
fn routh_s_sphere_keeps_a_measure() {
    let document = Document::parse(Source::new("rouths-sphere.toml", ROUTH)).unwrap();
    let graph = Graph::new();
    let assembly = Model::new(document).assemble(&graph).unwrap();
    let free = assembly.free_system().unwrap();
    let mut compared = Compared::default();
    compared.compare("Routh's sphere", &assembly, &free, &mut Random::new(1, 0));
    assert_eq!((compared.measures, compared.varying), (1, 1));
    assert!(compared.states >= 5 && compared.unseen == 0, "{compared:?}");
}
