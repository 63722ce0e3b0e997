//! A chain of 200 links, 800 components, with every linear solver.

use crate::boxed::erased;
use crate::model::Chain;
use pc_solve::{
    Integration, Krylov, LinearSolver, Method, Options, Statistics, Trajectory, VectorField, solve,
};

fn motion(chain: Chain, end: f64, solver: LinearSolver) -> Trajectory {
    let options =
        Options::new(Method::Bdf).relative_tolerance(1e-10).absolute_tolerance(1e-10).linear_solver(solver);
    let start = chain.start();
    solve(erased(chain), 0.0, &start, &[end], &options).unwrap()
}

fn distance(a: &Trajectory, b: &Trajectory) -> f64 {
    a.state(0).iter().zip(b.state(0)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// The derivatives agree with central differences of f in random directions, whose error is about
/// ε^(2/3) of the largest term.
#[test]
fn derivatives_are_those_of_the_forces() {
    let mut chain = Chain::new(7);
    let n = chain.dim();
    let wobble = |i: usize, by: f64| (by * (i + 1) as f64).sin();
    let y: Vec<f64> = chain.start().iter().enumerate().map(|(i, y)| y + 0.1 * wobble(i, 1.7)).collect();
    let v: Vec<f64> = (0..n).map(|i| wobble(i, 2.3)).collect();
    let mut at = |h: f64| {
        let moved: Vec<f64> = y.iter().zip(&v).map(|(y, v)| y + h * v).collect();
        let mut rate = vec![0.0; n];
        chain.rhs(0.0, &moved, &mut rate).unwrap();
        rate
    };
    let h = 1e-6;
    let (after, before) = (at(h), at(-h));
    let (mut product, mut jacobian) = (vec![0.0; n], vec![0.0; n * n]);
    chain.jvp(0.0, &y, &v, &mut product).unwrap();
    chain.jacobian(0.0, &y, &mut jacobian).unwrap();
    for i in 0..n {
        let quotient = (after[i] - before[i]) / (2.0 * h);
        let sum: f64 = (0..n).map(|j| jacobian[i + j * n] * v[j]).sum();
        assert!((product[i] - quotient).abs() < 1e-4, "{i}: {} is not {quotient}", product[i]);
        assert!((product[i] - sum).abs() < 1e-10);
    }
}

/// The error of each is some hundred local errors of 1e-10 in the norm of the error test, reduced
/// by damping; Newton's iteration adds a tenth of them.
#[test]
fn all_solvers_find_the_same_motion() {
    let dense = motion(Chain::new(200), 0.1, LinearSolver::Dense);
    let sparse = motion(Chain::new(200), 0.1, LinearSolver::Sparse);
    let band = motion(Chain::new(200), 0.1, LinearSolver::Band { lower: 7, upper: 4 });
    let free = motion(Chain::new(200), 0.1, LinearSolver::Krylov(Krylov::new(30)));
    for (name, motion) in [("sparse", &sparse), ("band", &band), ("Krylov", &free)] {
        let distance = distance(motion, &dense);
        assert!(distance < 1e-8, "{name}: {distance:e}");
    }

    let work = |motion: &Trajectory| -> Statistics { *motion.statistics() };
    let [dense, sparse, free] = [&dense, &sparse, &free].map(work);
    assert!(dense.steps < 300, "{dense:?}");
    assert!(sparse.steps.abs_diff(dense.steps) <= dense.steps / 20);
    assert!(sparse.linear_setups.abs_diff(dense.linear_setups) <= 2 + dense.linear_setups / 10);
    assert_eq!((dense.linear_iterations, sparse.jacobian_products), (0, 0));
    assert!(free.jacobian_evaluations == 0 && free.linear_setups == 0);
    assert!(free.jacobian_products >= free.linear_iterations && free.linear_iterations > 0);
}

/// By the colours of the pattern, a Jacobian of 800 columns takes little more than 6 evaluations of
/// f.
#[test]
fn quotients_find_the_same_motion_by_few_evaluations() {
    let analytic = motion(Chain::new(200), 0.1, LinearSolver::Sparse);
    let without = |knows_products| Chain { knows_jacobian: false, knows_products, ..Chain::new(200) };
    let quotients = motion(without(false), 0.1, LinearSolver::Sparse);
    let free = motion(without(false), 0.1, LinearSolver::Krylov(Krylov::new(30)));
    for motion in [&quotients, &free] {
        let distance = distance(motion, &analytic);
        assert!(distance < 1e-8, "{distance:e}");
    }
    let work = quotients.statistics();
    let colours = Chain::new(200).sparsity().unwrap().colouring().len() as u64;
    assert!(colours <= 12, "{colours}");
    let rest = work.rhs_evaluations - colours * work.jacobian_evaluations;
    assert!((work.nonlinear_iterations..work.nonlinear_iterations * 5 / 4 + 10).contains(&rest), "{work:?}");
}

#[test]
fn the_chain_is_found_to_be_sparse() {
    let chain = Chain::new(200);
    let start = chain.start();
    let cvode = Integration::new(erased(chain), 0.0, &start, &Options::new(Method::Bdf)).unwrap();
    assert_eq!(cvode.linear_solver(), Some(&LinearSolver::Sparse));
}
