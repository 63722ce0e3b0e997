//! Models of tests, each derived a second time.

use pc_model::{Document, Model};
use pc_verify::{Options, VerifyError, verify};

/// Some: models of tests are small, and an error of derivation shows at nearly every state.
const STATES: usize = 3;

/// The model of a document. One that is refused is for the test to look at.
///
/// # Panics
/// If a second derivation disagrees.
#[allow(unreachable_pub, reason = "a module of tests of other crates, too")]
#[track_caller]
#[must_use]
pub fn derived_twice(document: Document) -> Model {
    let model = Model::new(document);
    if let Err(error @ VerifyError::Disagreement(_)) = model.derived(|assembly| {
        verify(&model, assembly, &Options { states: STATES, seed: 1, ..Options::default() })
    }) {
        panic!("{}: {error}", model.title());
    }
    model
}
