//! Linear solvers, against a stiff system solved in closed form and against each other.

use std::cell::Cell;
use std::f64::consts::PI;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::boxed::{erased, from_fn};
use pc_solve::{
    Failure, FnField, InputError, Integration, Krylov, LinearSolver, Method, NonlinearSolver, Options,
    Pattern, Preconditioner, Side, SolveError, Statistics, VectorField, solve,
};

/// Heat in a rod of n cells: ẏᵢ = κ (yᵢ₋₁ − 2 yᵢ + yᵢ₊₁), y₀ = yₙ₊₁ = 0.
///
/// Mode k, yᵢ = sin(π k i/(n + 1)), decays at the rate 4 κ sin²(π k/(2 (n + 1))).
#[derive(Clone, Copy)]
struct Rod {
    n: usize,
    kappa: f64,
}

impl Rod {
    /// The slowest rate is about 6, the fastest 4000 and more.
    fn new(n: usize) -> Self {
        Rod { n, kappa: 6.0 * ((n + 1) as f64 / PI).powi(2) }
    }

    /// The sum of the slowest and the fastest mode at time t.
    fn exact(self, t: f64) -> Vec<f64> {
        let mode = |k: usize, i: usize| {
            let angle = PI * k as f64 / (self.n + 1) as f64;
            (angle * i as f64).sin() * (-4.0 * self.kappa * (angle / 2.0).sin().powi(2) * t).exp()
        };
        (1..=self.n).map(|i| mode(1, i) + mode(self.n, i)).collect()
    }

    fn rate(self, y: &[f64], ydot: &mut [f64]) {
        let at = |i: usize| y.get(i).copied().unwrap_or(0.0);
        for i in 0..self.n {
            ydot[i] = self.kappa * (at(i.wrapping_sub(1)) - 2.0 * y[i] + at(i + 1));
        }
    }

    fn pattern(self) -> Pattern {
        Pattern::from_columns(self.n, (0..self.n).map(|j| j.saturating_sub(1)..(j + 2).min(self.n)))
    }

    fn entries(self, values: &mut [f64]) {
        for ((i, j), value) in self.pattern().entries().zip(values) {
            *value = self.kappa * if i == j { -2.0 } else { 1.0 };
        }
    }
}

type Closure = Box<dyn FnMut(f64, &[f64], &mut [f64]) -> Result<(), Failure>>;

/// The rod with its pattern, counting calls.
fn quotients(rod: Rod, calls: &Arc<AtomicU64>) -> FnField<Closure> {
    let calls = Arc::clone(calls);
    let rhs: Closure = Box::new(move |_t, y, ydot| {
        calls.fetch_add(1, Ordering::Relaxed);
        rod.rate(y, ydot);
        Ok(())
    });
    from_fn(rod.n, rhs).with_sparsity(rod.pattern())
}

/// The same with its Jacobian.
fn analytic(rod: Rod, calls: &Arc<AtomicU64>) -> impl VectorField {
    quotients(rod, calls).with_sparse_jacobian(move |_t, _y, values| {
        rod.entries(values);
        Ok(())
    })
}

fn options(solver: LinearSolver) -> Options {
    Options::new(Method::Bdf).linear_solver(solver).relative_tolerance(1e-9).absolute_tolerance(1e-11)
}

/// Integrates to t = 0.3, where the slow mode is e^(−1.8), and checks the end.
fn run(rod: Rod, field: impl VectorField, solver: &LinearSolver) -> Statistics {
    let motion = solve(erased(field), 0.0, &rod.exact(0.0), &[0.3], &options(solver.clone())).unwrap();
    for (y, exact) in motion.state(0).iter().zip(rod.exact(0.3)) {
        // Some hundred steps of local errors of 1e-9.
        assert!((y - exact).abs() < 1e-7, "{solver:?}: {y} is not {exact}");
    }
    *motion.statistics()
}

/// Dense matrices below and above the size from which factors are blocked.
#[test]
fn direct_solvers_take_the_same_steps() {
    for n in [20, 100] {
        let rod = Rod::new(n);
        let calls = Arc::new(AtomicU64::new(0));
        let band = LinearSolver::Band { lower: 1, upper: 1 };
        let wide = LinearSolver::Band { lower: 3, upper: 2 };
        let by_dense = run(rod, analytic(rod, &calls), &LinearSolver::Dense);
        assert!(by_dense.steps < 1000 && by_dense.jacobian_evaluations > 5, "{by_dense:?}");
        for solver in [band, wide, LinearSolver::Sparse] {
            let by_this = run(rod, analytic(rod, &calls), &solver);
            // They differ by rounding only, which may decide about a step.
            assert!(by_this.steps.abs_diff(by_dense.steps) <= by_dense.steps / 20, "{solver:?}");
            assert_eq!(by_this.linear_failures, 0);
            assert!(by_this.linear_setups >= by_this.jacobian_evaluations);
        }
    }
}

/// One evaluation for each component, diagonal or colour; three colours suffice for three
/// diagonals.
#[test]
fn the_cost_of_difference_quotients() {
    let rod = Rod::new(100);
    let solvers = [
        (LinearSolver::Dense, 100),
        (LinearSolver::Band { lower: 1, upper: 1 }, 3),
        (LinearSolver::Band { lower: 3, upper: 2 }, 6),
        (LinearSolver::Sparse, 3),
    ];
    for (solver, evaluations) in solvers {
        let calls = Arc::new(AtomicU64::new(0));
        let with = run(rod, quotients(rod, &calls), &solver);
        assert_eq!(with.rhs_evaluations, calls.load(Ordering::Relaxed), "{solver:?}");
        let rest = with.rhs_evaluations - evaluations * with.jacobian_evaluations;
        // Newton's iterations need one evaluation each, failed ones and starts some more.
        let least = with.nonlinear_iterations;
        assert!((least..least + least / 5).contains(&rest), "{solver:?}: {rest} for {with:?}");
        calls.store(0, Ordering::Relaxed);
        let without = run(rod, analytic(rod, &calls), &solver);
        assert_eq!(without.rhs_evaluations, calls.load(Ordering::Relaxed));
        assert!(without.steps.abs_diff(with.steps) <= with.steps / 10);
    }
}

/// Jacobi's preconditioner, the diagonal of I − γ ∂f/∂y, counting its calls.
#[derive(Clone, Default)]
struct Jacobi {
    diagonal: Vec<f64>,
    factor: Vec<f64>,
    calls: Arc<[AtomicU64; 3]>,
}

impl Preconditioner for Jacobi {
    fn linearise(&mut self, field: &mut dyn VectorField, t: f64, y: &[f64]) -> Result<(), Failure> {
        self.calls[0].fetch_add(1, Ordering::Relaxed);
        let mut jacobian = vec![0.0; y.len() * y.len()];
        field.jacobian(t, y, &mut jacobian)?;
        self.diagonal = jacobian.iter().step_by(y.len() + 1).copied().collect();
        Ok(())
    }
    fn factorise(&mut self, gamma: f64) -> Result<(), Failure> {
        self.calls[1].fetch_add(1, Ordering::Relaxed);
        self.factor = self.diagonal.iter().map(|d| 1.0 / (1.0 - gamma * d)).collect();
        Ok(())
    }
    fn solve(&mut self, r: &[f64], z: &mut [f64]) -> Result<(), Failure> {
        self.calls[2].fetch_add(1, Ordering::Relaxed);
        z.iter_mut().zip(r).zip(&self.factor).for_each(|((z, r), factor)| *z = r * factor);
        Ok(())
    }
}

/// The space has as many dimensions as there are relevant eigenvalues.
#[test]
fn krylov_by_products_and_by_quotients() {
    let rod = Rod::new(20);
    let calls = Arc::new(AtomicU64::new(0));
    let products = Cell::new(0);
    let with_products = quotients(rod, &calls).with_jvp(|_t, _y, v, product| {
        products.set(products.get() + 1);
        rod.rate(v, product);
        Ok(())
    });
    let solver = LinearSolver::Krylov(Krylov::new(20));
    let by_products = run(rod, with_products, &solver);
    assert_eq!(by_products.jacobian_products, products.get());
    assert_eq!(by_products.rhs_evaluations, calls.load(Ordering::Relaxed));
    assert!(by_products.linear_iterations > 0);
    assert_eq!((by_products.jacobian_evaluations, by_products.preconditioner_evaluations), (0, 0));

    calls.store(0, Ordering::Relaxed);
    let by_quotients = run(rod, quotients(rod, &calls), &solver);
    assert_eq!(by_quotients.rhs_evaluations, calls.load(Ordering::Relaxed));
    assert!(by_quotients.rhs_evaluations > by_products.rhs_evaluations + by_quotients.jacobian_products / 2);
    // Small spaces suffice with restarts.
    run(rod, quotients(rod, &calls), &LinearSolver::Krylov(Krylov::new(5).restarts(10)));
}

/// A rod of cells with very different conductivities has very different diagonal entries, which
/// Jacobi's preconditioner scales to 1; the resulting system is easily solved.
#[test]
fn preconditioners_save_iterations() {
    let n = 30;
    let weight = |i: usize| 10.0_f64.powf(5.0 * i as f64 / n as f64);
    let field = || {
        let rate = move |y: &[f64], ydot: &mut [f64]| {
            for i in 0..n {
                let before = if i > 0 { y[i - 1] } else { 0.0 };
                ydot[i] = weight(i) * (0.1 * before - y[i]);
            }
        };
        from_fn(n, move |_t, y, ydot| {
            rate(y, ydot);
            Ok(())
        })
        .with_jvp(move |_t, _y, v, product| {
            rate(v, product);
            Ok(())
        })
        .with_sparsity(Pattern::from_columns(n, (0..n).map(|j| j..(j + 2).min(n))))
        .with_sparse_jacobian(move |_t, _y, values| {
            let lower = (0..n).flat_map(|j| [-weight(j), 0.1 * if j + 1 < n { weight(j + 1) } else { 0.0 }]);
            values.iter_mut().zip(lower).for_each(|(value, entry)| *value = entry);
            Ok(())
        })
    };
    let start = vec![1.0; n];
    let motion = |solver| solve(erased(field()), 0.0, &start, &[1.0], &options(solver)).unwrap();
    let plain = motion(LinearSolver::Krylov(Krylov::new(30)));
    let sparse = motion(LinearSolver::Sparse);
    for side in [Side::Left, Side::Right] {
        let jacobi = Jacobi::default();
        let shared = jacobi.clone();
        let krylov = Krylov::new(30).preconditioner(side, move || shared.clone());
        let preconditioned = motion(LinearSolver::Krylov(krylov));
        let work = preconditioned.statistics();
        for other in [&plain, &sparse] {
            for (a, b) in preconditioned.state(0).iter().zip(other.state(0)) {
                assert!((a - b).abs() < 1e-7); // as for the rod
            }
        }
        assert!(work.linear_iterations * 2 < plain.statistics().linear_iterations, "{side:?}: {work:?}");
        let [linearised, factorised, solved] = [0, 1, 2].map(|k| jacobi.calls[k].load(Ordering::Relaxed));
        assert_eq!(linearised, work.preconditioner_evaluations);
        assert_eq!(factorised, work.linear_setups);
        assert_eq!(solved, work.preconditioner_solves);
        assert!(linearised < factorised, "∂f/∂y is kept while γ changes");
    }
}

/// I − γ ∂f/∂y is exactly 0 in the first step, which is then repeated with another length.
#[test]
fn singular_matrices_are_overcome() {
    let lambda = 1024.0;
    let solvers = [
        (2, LinearSolver::Dense),
        (80, LinearSolver::Dense),
        (2, LinearSolver::Band { lower: 0, upper: 0 }),
        (80, LinearSolver::Sparse),
    ];
    for (n, solver) in solvers {
        let growth = from_fn(n, move |_t, y, ydot| {
            ydot.iter_mut().zip(y).for_each(|(rate, y)| *rate = lambda * y);
            Ok(())
        })
        .with_sparsity(Pattern::from_columns(n, (0..n).map(|j| [j])))
        .with_sparse_jacobian(move |_t, _y, values| {
            values.fill(lambda);
            Ok(())
        });
        let options = options(solver.clone()).initial_step(1.0 / lambda);
        let motion = solve(erased(growth), 0.0, &vec![1.0; n], &[3.0 / lambda], &options).unwrap();
        let work = motion.statistics();
        assert!(work.step_failures > 0, "{solver:?}: {work:?}");
        // Zero pivots of sparse factors are found only when solving.
        assert_eq!(work.linear_failures > 0, solver == LinearSolver::Sparse);
        // Some hundred steps with relative errors of 1e-9.
        assert!(motion.state(0).iter().all(|y| (y / 3.0_f64.exp() - 1.0).abs() < 1e-6), "{solver:?}");
    }
}

#[test]
fn the_linear_solver_is_chosen_by_size_and_pattern() {
    let chosen = |n: usize, pattern: Option<Pattern>, options: &Options| {
        let field = from_fn(n, |_t, _y, ydot| {
            ydot.fill(0.0);
            Ok(())
        });
        let field = match pattern {
            Some(pattern) => field.with_sparsity(pattern),
            None => field,
        };
        Integration::new(erased(field), 0.0, &vec![0.0; n], options)
            .map(|cvode| cvode.linear_solver().cloned())
    };
    let bdf = Options::new(Method::Bdf);
    let rod = |n| Some(Rod::new(n).pattern());
    assert_eq!(chosen(59, rod(59), &bdf).unwrap(), Some(LinearSolver::Dense));
    assert_eq!(chosen(60, rod(60), &bdf).unwrap(), Some(LinearSolver::Sparse));
    assert_eq!(chosen(60, Some(Pattern::full(60, 60)), &bdf).unwrap(), Some(LinearSolver::Dense));
    assert_eq!(chosen(60, None, &bdf).unwrap(), Some(LinearSolver::Dense));
    assert_eq!(chosen(60, rod(60), &Options::new(Method::Adams)).unwrap(), None);
    let newton = Options::new(Method::Adams).nonlinear_solver(NonlinearSolver::Newton);
    assert_eq!(chosen(60, rod(60), &newton).unwrap(), Some(LinearSolver::Sparse));

    let refusal = |n, pattern, solver| {
        let error = chosen(n, pattern, &bdf.clone().linear_solver(solver)).unwrap_err();
        assert!(matches!(error, SolveError::Input(_)));
        error.to_string()
    };
    let no_pattern = "the sparse linear solver needs the zero pattern of the Jacobian, which the vector field does not provide";
    assert_eq!(refusal(2, None, LinearSolver::Sparse), no_pattern);
    assert_eq!(
        refusal(2, rod(3), LinearSolver::Sparse),
        "the zero pattern of the Jacobian is 3 × 3, but must be 2 × 2"
    );
    assert_eq!(
        refusal(3, rod(3), LinearSolver::Band { lower: 1, upper: 0 }),
        "the rate of y[0] depends on y[1], which lies outside the band of 1 diagonals below the main one and 0 above: widen the band"
    );
    assert_eq!(
        refusal(3, rod(3), LinearSolver::Band { lower: 0, upper: 2 }),
        "the rate of y[1] depends on y[0], which lies outside the band of 0 diagonals below the main one and 2 above: widen the band"
    );
    assert_eq!(
        refusal(3, None, LinearSolver::Band { lower: 3, upper: 0 }),
        "a band of 3 diagonals below the main one and 0 above is too wide for a Jacobian of 3 × 3"
    );
    assert_eq!(
        refusal(2, None, LinearSolver::Krylov(Krylov::new(0))),
        "the dimension of the Krylov space is 0, but must be positive"
    );
    assert_eq!(
        refusal(2, None, LinearSolver::Krylov(Krylov::default().tolerance(f64::NAN))),
        "the tolerance of the Krylov solver is NaN"
    );
    let unused =
        chosen(2, None, &Options::new(Method::Adams).linear_solver(LinearSolver::Dense)).unwrap_err();
    assert!(matches!(unused, SolveError::Input(InputError::LinearSolverUnused)));
}

/// In an accepted step the weighted local errors have a root mean square of at most 1; the weights
/// are those of the tolerances.
#[test]
fn weights_and_errors_are_those_of_the_test() {
    let rod = Rod::new(5);
    let calls = Arc::new(AtomicU64::new(0));
    let mut cvode =
        Integration::new(erased(analytic(rod, &calls)), 0.0, &rod.exact(0.0), &options(LinearSolver::Dense))
            .unwrap();
    assert!(matches!(cvode.error_weights(), Err(SolveError::Input(InputError::NoStep))));
    assert!(matches!(cvode.local_errors(), Err(SolveError::Input(InputError::NoStep))));
    let start = cvode.statistics();
    assert_eq!((start.current_order, start.first_step, start.current_step), (0, 0.0, 0.0));
    for step in 0..100 {
        let before = cvode.state().to_vec();
        let t = cvode.step_towards(1.0).unwrap();
        let weights = cvode.error_weights().unwrap().to_vec();
        let errors = cvode.local_errors().unwrap().to_vec();
        // The weights of the last step, from the state before it.
        for (w, y) in weights.iter().zip(&before) {
            assert!((w * (1e-9 * y.abs() + 1e-11) - 1.0).abs() < 1e-12);
        }
        let square: f64 = weights.iter().zip(&errors).map(|(w, e)| (w * e).powi(2)).sum();
        assert!(square > 0.0 && (square / 5.0).sqrt() <= 1.0, "{square}");
        let work = cvode.statistics();
        if step == 0 {
            assert_eq!((work.first_step, work.last_step), (t, t));
        }
        assert!((1..=5).contains(&work.current_order) && work.current_order.abs_diff(work.last_order) <= 1);
        assert!(work.current_step > 0.0);
    }
}
