//! What holds of all models at once, by what was found of each.

use pc_model::BUILTIN;
use pc_tests::reference::references;

use crate::claims::{BUILT_IN, MECHANISMS};
use crate::derived_equations::HELD;
use crate::divergence::Compared;
use crate::findings::{Costs, Findings};
use crate::forms_agree::NOT_IN_VELOCITIES;
use crate::free_forms::RELATIVISTIC;
use crate::reference_states::{DEPENDENT, IMPLICIT, OUT_OF_ITS_CHART, REDUNDANT, STIFF};
use crate::subject::Subject;
use crate::taylor_references::{IRREVERSIBLE, REFUSED};
use crate::{backends, kept_costs};

fn sum(count: impl Fn(&Findings) -> usize) -> usize {
    BUILT_IN.findings().map(count).sum()
}

fn subjects() -> Vec<&'static Subject> {
    BUILT_IN.findings().map(|findings| findings.subject.as_deref().expect("each model has one")).collect()
}

#[test]
fn every_model_has_a_reference() {
    let mut models: Vec<&str> = BUILTIN.iter().map(|model| model.name).collect();
    let mut known: Vec<&str> = references().map(|reference| reference.model).collect();
    models.sort_unstable();
    known.sort_unstable();
    assert_eq!(models, known);
}

#[test]
fn every_exception_is_a_model() {
    let lists: [&[&str]; 7] =
        [&HELD, &NOT_IN_VELOCITIES, &RELATIVISTIC, &DEPENDENT, &IMPLICIT, &REDUNDANT, &REFUSED];
    let single = [OUT_OF_ITS_CHART, STIFF, IRREVERSIBLE, backends::SINGULAR_AT_REST];
    for name in lists.concat().iter().chain(&single) {
        assert!(BUILTIN.iter().any(|model| model.name == *name), "{name}");
    }
}

#[test]
fn neither_pages_nor_operations_grow() {
    let found = BUILT_IN.findings().chain(MECHANISMS.findings());
    let costs: Costs = found.flat_map(|findings| findings.costs.clone()).collect();
    kept_costs::assert_kept(&costs);
}

#[test]
fn emitted_c_has_the_same_bits() {
    backends::assert_emitted_c(&subjects());
}

#[test]
fn emitted_rust_has_the_same_bits() {
    backends::assert_emitted_rust(&subjects());
}

#[test]
fn pages_of_built_in_models_are_compared() {
    let compared = sum(|findings| findings.pages);
    assert!(compared >= 3 * BUILTIN.len(), "{compared} pages");
}

#[test]
fn integrals_are_tried() {
    let (integrals, tried) = (sum(|findings| findings.integrals), sum(|findings| findings.integrals_tried));
    assert!(integrals > 100 && tried > 500, "{integrals} integrals, {tried} states");
}

#[test]
fn models_have_cyclic_coordinates() {
    let cyclic = sum(|findings| usize::from(findings.has_cyclic));
    assert!(cyclic >= 4, "{cyclic} models with cyclic coordinates");
}

#[test]
fn models_are_reduced() {
    let reduced = sum(|findings| usize::from(findings.is_reduced));
    assert!(reduced > 30, "{reduced} models");
}

#[test]
fn measures_are_compared() {
    let compared = Compared {
        measures: sum(|findings| findings.measures.measures),
        varying: sum(|findings| findings.measures.varying),
        states: sum(|findings| findings.measures.states),
        unseen: sum(|findings| findings.measures.unseen),
    };
    assert!(compared.measures >= 35 && compared.varying >= 15 && compared.states >= 250, "{compared:?}");
    // A wrong density is seen, but where the density happens to be kept along the motion.
    assert!(compared.unseen * 20 <= compared.states, "{compared:?}");
}
