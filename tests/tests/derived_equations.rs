//! Derived equations of every built-in model against the classical ones, coded by hand, and against their
//! definition.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use pc_mech::{Backend, Folding, Graph, VectorField};
use pc_model::{Builtin, Model};
use pc_tests::classical::{MODELS, SplitMix64, classical, sample};
use pc_tests::definition::assert_derived;

/// Products of numbers of order one, sums of a dozen terms: a few hundred units of rounding.
const TOLERANCE: f64 = 1e-12;
const STATES: usize = 1000;

fn compare(folding: Folding, backend: Backend) {
    for &name in MODELS {
        let builtin = Builtin::named(name).unwrap_or_else(|| panic!("{name} is not built in"));
        let model = Model::new(builtin.document().unwrap());
        let graph = Graph::with_folding(folding);
        let assembly = model.assemble(&graph).unwrap_or_else(|e| panic!("{e}"));
        let mut motion = assembly.system.poincare().unwrap().compile_for(backend).unwrap();
        let classical = classical(name).unwrap();
        let mut random = SplitMix64::new(7);
        for _ in 0..STATES {
            let (t, y) = sample(name, &mut random).unwrap();
            let (mut derived, mut expected) = (vec![0.0; y.len()], vec![0.0; y.len()]);
            motion.rhs(t, &y, &mut derived).unwrap();
            classical(t, &y, &mut expected);
            let size = expected.iter().fold(1.0f64, |size, v| size.max(v.abs()));
            for (i, (d, e)) in derived.iter().zip(&expected).enumerate() {
                let error = (d - e).abs() / size;
                assert!(error <= TOLERANCE, "{name}: component {i} at t = {t}, {y:?}: {d} against {e}");
            }
        }
    }
}

#[test]
fn derived_equations_are_the_classical_ones() {
    compare(Folding::ByValue, Backend::Interpreter);
    compare(Folding::ByValue, Backend::Fastest);
}

#[test]
fn without_folding_they_are_the_same() {
    compare(Folding::Structural, Backend::Interpreter);
}

#[test]
fn they_are_those_of_the_definition() {
    for &name in MODELS {
        let model = Model::new(Builtin::named(name).unwrap().document().unwrap());
        let worst = assert_derived(
            name,
            |graph| model.assemble(graph).unwrap_or_else(|e| panic!("{e}")).system,
            0,
            STATES,
            |random| sample(name, random).unwrap(),
        );
        println!("{name}: {worst:.1e} of the largest term");
    }
}
