//! Tags of the built-in models: each model has some, and those that a model shows are true.

use std::collections::HashSet;

use pc_mech::Graph;
use pc_model::document::DeclaredKind;
use pc_model::{Builtin, Document, Model, TAGS};
use pc_nonholo::ConstraintKind;

fn documents() -> Vec<(&'static Builtin, Document)> {
    let document = |model: &'static Builtin| {
        (model, model.document().unwrap_or_else(|error| panic!("{}: {error}", model.name)))
    };
    Builtin::all().map(document).collect()
}

#[test]
fn every_model_has_a_tag_and_every_name_is_a_model() {
    for model in Builtin::all() {
        assert!(model.tags().next().is_some(), "{} has no tag in model/tags.rs", model.name);
    }
    let mut names = HashSet::new();
    for tag in TAGS {
        assert!(names.insert(tag.name), "the tag {} is there twice", tag.name);
        let models: HashSet<&str> = tag.models.iter().copied().collect();
        assert_eq!(models.len(), tag.models.len(), "a model is twice under {}", tag.name);
        for name in tag.models {
            assert!(Builtin::named(name).is_some(), "{}: there is no model {name}", tag.name);
        }
    }
}

#[track_caller]
fn compare(tag: &str, is_so: impl Fn(&Builtin, &Document) -> bool) {
    for (model, document) in documents() {
        let is_tagged = model.tags().any(|known| known.name == tag);
        assert_eq!(is_tagged, is_so(model, &document), "the tag {tag} of {}", model.name);
    }
}

#[test]
fn tags_of_the_format_are_true() {
    compare("events", |model, _| model.text.contains("\n[events."));
    compare("inputs", |_, document| !document.inputs.is_empty());
    compare("joints", |_, document| !document.tree.is_empty());
    compare("loops", |model, _| model.text.contains("\n[loops."));
    compare("quaternion", |_, document| {
        document.coordinates.iter().any(|coordinate| coordinate.name.text.ends_with("q0"))
    });
    compare("nonlinear", |_, document| {
        let kinds = document.constraints.iter().filter_map(|constraint| constraint.kind.as_ref());
        kinds.into_iter().any(|kind| kind.value == DeclaredKind::Nonlinear)
    });
}

/// By Frobenius' test, as in `pc check`. Models on joints have constraints by their loops, all on positions, and by
/// their contacts.
#[test]
fn nonholonomic_models_are_those_whose_constraints_cannot_be_integrated() {
    compare("nonholonomic", |model, document| {
        if document.constraints.is_empty() || !document.tree.is_empty() && document.contacts.is_empty() {
            return false;
        }
        let graph = Graph::new();
        let model_of = Model::new(document.clone());
        let assembly = model_of.assemble(&graph).unwrap_or_else(|error| panic!("{}: {error}", model.name));
        assembly
            .constraints
            .classified()
            .iter()
            .any(|found| matches!(found.kind, ConstraintKind::Nonholonomic { .. }))
    });
}
