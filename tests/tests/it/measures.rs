//! The density of an invariant measure, times the compiled field, has no divergence: of random models. (Of the built-in models this
//! is a claim of the program `models`.)

use pc_mech::Graph;
use pc_model::{Document, Model, Source};
use pc_tests::fuzz::generator::specimen;
use pc_tests::fuzz::random::Random;
use pc_tests::fuzz::start::Start;
use pc_tests::fuzz::text;

use crate::divergence::Compared;

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
