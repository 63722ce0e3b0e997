//! Derived equations of every built-in model against the classical ones, coded by hand, and against their
//! definition.

use pc_mech::{Backend, Expr, Folding, Graph, Motion, System, VectorField};
use pc_model::{Assembly, ConstraintFormulation, Model};
use pc_tests::classical::{SplitMix64, classical, sample};
use pc_tests::definition::assert_derived;
use pc_tests::reference::reference;

use crate::derived::Derived;

/// Products of numbers of order one, sums of a dozen terms: a few hundred units of rounding.
const TOLERANCE: f64 = 1e-12;
const STATES: usize = 1000;

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

/// These do not name what vanishes.
pub(crate) const HELD: [&str; 3] = ["appell-hamel", "carriage", "vertical-disk"];

/// All quasi-velocities, the constraints kept by multipliers: in those models that do not name what vanishes.
pub(crate) fn equations_with_multipliers_are_the_classical_ones(derived: &Derived<'_>) {
    let formulation = derived.assembly.constraints.formulation();
    let held = matches!(formulation, ConstraintFormulation::Multipliers(_));
    assert_eq!(held, derived.is_among(&HELD), "{}", derived.name);
    if held {
        assert_classical(derived.name, &mut derived.motion().0);
    }
}

pub(crate) fn derived_equations_are_the_classical_ones(derived: &Derived<'_>) {
    for backend in [Backend::Interpreter, Backend::Fastest] {
        assert_classical(derived.name, &mut derived.equations.compile_for(backend).unwrap());
    }
}

pub(crate) fn without_folding_they_are_the_same(derived: &Derived<'_>) {
    let graph = Graph::with_folding(Folding::Structural);
    let assembly = derived.model.assemble(&graph).unwrap_or_else(|e| panic!("{e}"));
    assert_classical(
        derived.name,
        &mut assembly.equations().unwrap().compile_for(Backend::Interpreter).unwrap(),
    );
}

/// The whole system, free quasi-velocities first, and how many of them vanish.
fn whole<'g>(assembly: &Assembly<'g>) -> (System<'g>, usize) {
    match assembly.constraints.constrained(&assembly.at_start()).unwrap() {
        Some(constrained) => (constrained.system().clone(), constrained.vanishing().len()),
        None => (assembly.system.clone(), 0),
    }
}

pub(crate) fn they_are_those_of_the_definition(derived: &Derived<'_>) {
    let name = derived.name;
    let (system, vanishing) = whole(&derived.assembly);
    let eta = system.quasi_velocities();
    // Which equations are shortest is another matter without folding: there they are those of the same velocities.
    let mut model: Model = derived.model.clone();
    if derived.assembly.constraints.held().is_some() && vanishing > 0 {
        model.choose_independent(eta[..eta.len() - vanishing].iter().map(Expr::to_string));
    }
    let state = [system.frame().coordinates(), &eta[..eta.len() - vanishing]].concat();
    let names: Vec<String> = state.iter().map(Expr::to_string).collect();
    let columns = reference(name).unwrap();
    let sample = |random: &mut SplitMix64| {
        let (t, y) = sample(name, random).unwrap();
        (t, columns.pick(&names, &y))
    };
    fn build<'g>(model: &Model, graph: &'g Graph) -> System<'g> {
        whole(&model.assemble(graph).unwrap_or_else(|e| panic!("{e}"))).0
    }
    let worst = assert_derived(name, |graph| build(&model, graph), vanishing, STATES, sample);
    println!("{name}: {worst:.1e} of the largest term");
}
