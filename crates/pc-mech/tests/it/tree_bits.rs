//! The numbers of a tree depend on the tree alone, to the last bit; parameters of compiled equations may
//! change.

use std::sync::Arc;

use pc_mech::{
    CompileOptions, Expr, Graph, Interpolation, Joint, LagrangianError, MechError, Motion, Signals, System,
    Table, Tree, TreeBody, TreeElimination, VectorField,
};

const BODIES: usize = 7;

/// A branching tree with a parameter for each number, a spring at its root and an external force at its tip.
fn tree(graph: &Graph) -> System<'_> {
    let [m, l, i, g, stiffness, motor] = graph.symbols(["m", "l", "i", "g", "stiffness", "motor"]);
    let name = |b: usize| format!("b{b}");
    let body = |b: usize| {
        let axis = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.6, 0.0, 0.8]][b % 3];
        let at = if b == 0 { [Expr::ZERO; 3] } else { [Expr::ZERO, l / (b as f64 + 1.0), -l] };
        let body = TreeBody::new(name(b), Joint::revolute(axis).at(at))
            .mass(m * (b + 1) as f64)
            .centre([l / 7.0, Expr::ZERO, -l / 2.0])
            .inertia([i, i + m * l.square() / 12.0, m * l.square() / 5.0]);
        if b == 0 { body } else { body.on(name((b - 1) / 2)) }
    };
    let tree = Tree::new(graph, (0..BODIES).map(body)).unwrap();
    System::builder(graph)
        .coordinates((0..BODIES).map(name))
        .parameter(m, 1.3)
        .parameter(l, 0.7)
        .parameter(i, 0.2)
        .parameter(g, 9.81)
        .parameter(stiffness, 3.0)
        .parameter(motor, 0.4)
        .gravity(|_| [Expr::ZERO, Expr::ZERO, -g])
        .potential(|_, x, _| stiffness * (x[0] - x[2]).square() / 2.0)
        .forces(|_, _, v| {
            (0..BODIES).map(|b| if b == 1 { motor - v[1] / 5.0 } else { Expr::ZERO }).collect::<Vec<_>>()
        })
        .external_force([format!("{}'", name(BODIES - 1))])
        .tree(tree)
        .build()
        .unwrap()
}

fn state() -> Vec<f64> {
    (0..2 * BODIES).map(|i| (0.7 * i as f64).sin()).collect()
}

fn compiled(system: &System<'_>) -> Motion {
    let options = CompileOptions::default().jacobian(false);
    system.poincare().unwrap().compile_for(options).unwrap()
}

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}

fn rates(motion: &mut Motion) -> Vec<f64> {
    motion.rates(0.0, &state()).unwrap()
}

#[test]
fn numbers_do_not_depend_on_what_else_was_derived_in_the_graph() {
    let alone = rates(&mut compiled(&tree(&Graph::new())));
    // A graph with symbols in another order, other expressions of them, and the whole tree beforehand.
    let graph = Graph::new();
    let mut names: Vec<String> = (0..BODIES).flat_map(|b| [format!("b{b}'"), format!("b{b}")]).collect();
    names.extend(["motor", "stiffness", "g", "i", "l", "m"].map(str::to_owned));
    names.reverse();
    let symbols: Vec<Expr<'_>> = names.iter().map(|name| graph.symbol(name)).collect();
    let products: Vec<Expr<'_>> =
        symbols.windows(2).map(|pair| pair[0].sin() * pair[1] - pair[1].cos()).collect();
    assert!(products.iter().all(|x| !x.is_zero()));
    let system = tree(&graph);
    let whole = system.poincare().unwrap();
    assert_eq!(whole.mass_matrix().rows(), BODIES);
    assert_eq!(whole.accelerations().len(), BODIES);
    let once = rates(&mut compiled(&system));
    assert_eq!(bits(&once), bits(&alone));
    let again = rates(&mut compiled(&system));
    assert_eq!(bits(&again), bits(&alone));
}

/// With parameters set later, the rates are those compiled with them; so are those of machine code with the
/// values that depend on parameters alone.
#[test]
fn values_of_parameters_alone_follow_them() {
    let graph = Graph::new();
    let system = tree(&graph);
    let mut motion = compiled(&system);
    let before = rates(&mut motion);
    let values = [0.9, 1.1, 0.35, 1.62, 7.0, -0.3];
    let mut kept = motion.clone();
    motion.parameters_mut()[..6].copy_from_slice(&values);
    let after = rates(&mut motion);
    assert!(
        before.iter().zip(&after).skip(BODIES).all(|(a, b)| (a - b).abs() > 1e-3),
        "{before:?} {after:?}"
    );
    assert_eq!(bits(&rates(&mut kept)), bits(&before), "a clone has its own parameters");
    // The equations without parameters differ by rounding of two orders of evaluation, times the condition of
    // M.
    let bound = values.iter().zip(system.parameters()).map(|(&value, &(symbol, _))| (symbol, value.into()));
    let bound: Vec<(Expr<'_>, Expr<'_>)> = bound.collect();
    let equations = system.poincare().unwrap();
    let known: Vec<(Expr<'_>, f64)> = system.state().into_iter().zip(state()).collect();
    let accelerations = graph.substitute(&equations.accelerations(), &bound);
    let external: Vec<(Expr<'_>, f64)> =
        system.external_forces().iter().map(|&(_, symbol)| (symbol, 0.0)).collect();
    let expected = graph.evaluate(&accelerations, &[known, external].concat()).unwrap();
    for (found, expected) in after[BODIES..].iter().zip(&expected) {
        assert!((found - expected).abs() < 1e-10 * expected.abs().max(1.0), "{found} {expected}");
    }

    let Some(code) = motion.machine_code() else { return };
    let numbers = motion.code_parameters().unwrap();
    assert_eq!(numbers.len(), code.parameters_len());
    assert_eq!(&numbers[..6], &values, "the parameters come first");
    assert!(numbers.len() > 7, "something is computed of them");
}

/// An external force and a parameter from a table change at each evaluation, and so do values that depend on
/// them.
#[test]
fn varying_parameters_are_read_at_each_evaluation() {
    let graph = Graph::new();
    let system = tree(&graph);
    let mut motion = compiled(&system);
    let plain = rates(&mut motion);
    let tip = 2 * BODIES - 1;
    let options = CompileOptions::default().jacobian(false);
    let push = |t: f64, _: &[f64], q: &mut [f64]| q[0] = t;
    let mut forced = system.poincare().unwrap().compile_forced_for(options, push).unwrap();
    let [none, one, two] = [0.0, 1.0, 2.0].map(|t| {
        let mut rates = vec![0.0; 2 * BODIES];
        forced.rhs(t, &state(), &mut rates).unwrap();
        rates[tip]
    });
    assert_eq!(none, plain[tip]);
    // Accelerations are affine in forces: the second difference is rounding.
    assert!(((two - one) - (one - none)).abs() < 1e-12 * two.abs().max(1.0) && (one - none).abs() > 1e-3);

    // The length of the links from a table: declared as a parameter, but never constant.
    let table = Table::new(vec![0.0, 1.0], vec![0.7, 1.4], Interpolation::Linear).unwrap();
    let mut driven = compiled(&system).driven_by(Signals::new([("l", 1, Arc::new(table))]));
    for t in [0.0, 0.25, 1.0, 0.5] {
        let found = driven.rates(t, &state()).unwrap();
        motion.parameters_mut()[1] = 0.7 + 0.7 * t;
        let expected = rates(&mut motion);
        let error = found.iter().zip(&expected).fold(0.0f64, |error, (a, b)| error.max((a - b).abs()));
        // Fused operations round differently where a part is computed beforehand.
        assert!(error < 1e-10 * expected.iter().fold(1.0f64, |size, x| size.max(x.abs())), "at {t}: {error}");
    }
}

#[test]
fn a_tip_without_mass_is_degenerate_in_every_elimination() {
    let graph = Graph::new();
    let system = |bodies: usize| {
        let arm = |b: usize| {
            let arm = TreeBody::new(format!("b{b}"), Joint::revolute([0.0, 1.0, 0.0]).at([0, 0, -1]));
            let arm = if b + 1 < bodies { arm.mass(1).centre([0, 0, -1]) } else { arm };
            if b == 0 { arm } else { arm.on(format!("b{}", b - 1)) }
        };
        let tree = Tree::new(&graph, (0..bodies).map(arm)).unwrap();
        System::builder(&graph).coordinates((0..bodies).map(|b| format!("b{b}"))).tree(tree).build().unwrap()
    };
    for bodies in [2, 6] {
        let by_joints = CompileOptions::default().elimination(TreeElimination::ByJoints);
        let outcome = system(bodies).poincare().and_then(|equations| equations.compile_for(by_joints));
        let Err(MechError::Lagrangian(LagrangianError::Degenerate { rank, size, quasi_velocities })) =
            outcome
        else {
            panic!("{outcome:?}");
        };
        assert_eq!(
            (rank, size, quasi_velocities.as_slice()),
            (bodies - 1, bodies, &[format!("b{}'", bodies - 1)][..])
        );
    }
}

#[test]
fn signs_of_masses_and_inertias_are_those_at_the_parameters() {
    let graph = Graph::new();
    let [m, i] = graph.symbols(["m", "i"]);
    let body = TreeBody::new("b", Joint::spherical()).mass(m).inertia([i, i, i, i / 2.0, 0.into(), 0.into()]);
    let tree = Tree::new(&graph, [body]).unwrap();
    assert!(tree.is_nowhere_negative(&[(m, 1.0), (i, 2.0)]));
    assert!(tree.is_nowhere_negative(&[(m, 0.0), (i, 0.0)]));
    assert!(!tree.is_nowhere_negative(&[(m, -1.0), (i, 2.0)]));
    assert!(!tree.is_nowhere_negative(&[(m, 1.0), (i, -2.0)]));
    assert!(!tree.is_nowhere_negative(&[(m, 1.0)]), "not known");
    // Positive on the diagonal, but indefinite.
    let body = TreeBody::new("b", Joint::spherical()).mass(1).inertia([1, 1, 1, 2, 0, 0]);
    assert!(!Tree::new(&graph, [body]).unwrap().is_nowhere_negative(&[]));
}
