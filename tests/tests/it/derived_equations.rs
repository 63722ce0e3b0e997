//! Derived equations of every built-in model against the classical ones, coded by hand, and against their
//! definition.

use pc_mech::{Backend, Expr, Folding, Graph, Motion, System, VectorField};
use pc_model::{Builtin, ConstraintFormulation, Model};
use pc_tests::classical::{MODELS, SplitMix64, classical, sample};
use pc_tests::definition::assert_derived;
use pc_tests::reference::reference;

/// Products of numbers of order one, sums of a dozen terms: a few hundred units of rounding.
const TOLERANCE: f64 = 1e-12;
const STATES: usize = 1000;

fn compare(folding: Folding, backend: Backend) {
    for &name in MODELS {
        let builtin = Builtin::named(name).unwrap_or_else(|| panic!("{name} is not built in"));
        let model = Model::new(builtin.document().unwrap());
        let graph = Graph::with_folding(folding);
        let assembly = model.assemble(&graph).unwrap_or_else(|e| panic!("{e}"));
        assert_classical(name, &mut assembly.equations().unwrap().compile_for(backend).unwrap());
    }
}

/// A motion whose components are columns of a model has the classical rates.
fn assert_classical(name: &str, motion: &mut Motion) {
    let (classical, columns) = (classical(name).unwrap(), reference(name).unwrap());
    let names = motion.names().to_vec();
    let mut random = SplitMix64::new(7);
    for _ in 0..STATES {
        let (t, y) = sample(name, &mut random).unwrap();
        let mut expected = vec![0.0; y.len()];
        classical(t, &y, &mut expected);
        let expected = columns.pick(&names, &expected);
        let mut derived = vec![0.0; names.len()];
        motion.rhs(t, &columns.pick(&names, &y), &mut derived).unwrap();
        let size = expected.iter().fold(1.0f64, |size, v| size.max(v.abs()));
        for (i, (d, e)) in derived.iter().zip(&expected).enumerate() {
            let error = (d - e).abs() / size;
            assert!(error <= TOLERANCE, "{name}: {} at t = {t}, {y:?}: {d} against {e}", names[i]);
        }
    }
}

/// All quasi-velocities, the constraints kept by multipliers: in those models that do not name what vanishes.
#[test]
fn equations_with_multipliers_are_the_classical_ones() {
    let mut held = Vec::new();
    for &name in MODELS {
        let model = Model::new(Builtin::named(name).unwrap().document().unwrap());
        let graph = Graph::new();
        let assembly = model.assemble(&graph).unwrap_or_else(|e| panic!("{e}"));
        if matches!(assembly.constraints.formulation(), ConstraintFormulation::Multipliers(_)) {
            held.push(name);
            assert_classical(name, &mut model.compile(&assembly).unwrap().0);
        }
    }
    assert_eq!(held, ["appell-hamel", "carriage", "vertical-disk"]);
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

/// The whole system, free quasi-velocities first.
fn whole<'g>(model: &Model, graph: &'g Graph) -> (System<'g>, usize) {
    let assembly = model.assemble(graph).unwrap_or_else(|e| panic!("{e}"));
    match assembly.constraints.constrained(&assembly.at_start()).unwrap() {
        Some(constrained) => (constrained.system().clone(), constrained.vanishing().len()),
        None => (assembly.system, 0),
    }
}

#[test]
fn they_are_those_of_the_definition() {
    for &name in MODELS {
        let model = Model::new(Builtin::named(name).unwrap().document().unwrap());
        let graph = Graph::new();
        let (system, vanishing) = whole(&model, &graph);
        let eta = system.quasi_velocities();
        // Which equations are shortest is another matter without folding: there they are those of the same velocities.
        let mut model = model;
        if model.assemble(&graph).unwrap().constraints.held().is_some() && vanishing > 0 {
            model.choose_independent(eta[..eta.len() - vanishing].iter().map(Expr::to_string));
        }
        let state = [system.frame().coordinates(), &eta[..eta.len() - vanishing]].concat();
        let names: Vec<String> = state.iter().map(Expr::to_string).collect();
        let columns = reference(name).unwrap();
        let sample = |random: &mut SplitMix64| {
            let (t, y) = sample(name, random).unwrap();
            (t, columns.pick(&names, &y))
        };
        let worst = assert_derived(name, |graph| whole(&model, graph).0, vanishing, STATES, sample);
        println!("{name}: {worst:.1e} of the largest term");
    }
}
