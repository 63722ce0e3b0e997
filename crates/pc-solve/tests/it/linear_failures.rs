//! Failures, panics and non-finite numbers in callbacks of the linear solvers.

use std::error::Error;
use std::panic::{AssertUnwindSafe, catch_unwind};

use pc_solve::{
    Code, Cvode, Failure, Integration, Krylov, LinearSolver, Method, NonFinite, Options, Pattern,
    Preconditioner, Side, SolveError, VectorField,
};

/// The call that goes wrong.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Place {
    SparseJacobian,
    Product,
    Linearise,
    Factorise,
    Solve,
}

/// How it goes wrong.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Mishap {
    Panic,
    Fatal,
    Recoverable,
    NotFinite,
    Unwritten,
}

#[derive(Debug, thiserror::Error)]
#[error("no more")]
struct NoMore;

const WALL: f64 = 1.0;

/// Writes −1000 v, or goes wrong if `wrong`.
fn answer(mishap: Mishap, wrong: bool, v: &[f64], result: &mut [f64]) -> Result<(), Failure> {
    if wrong {
        match mishap {
            Mishap::Panic => panic!("no more"),
            Mishap::Fatal => return Err(Failure::fatal(NoMore)),
            Mishap::Recoverable => return Err(Failure::recoverable(NoMore)),
            Mishap::NotFinite => result.fill(f64::INFINITY),
            Mishap::Unwritten => {}
        }
    } else {
        result.iter_mut().zip(v).for_each(|(result, v)| *result = -1e3 * v);
    }
    Ok(())
}

/// ẏ = −1000 (y − sin t) of two components, with a call that goes wrong after [`WALL`].
struct Fragile {
    place: Place,
    mishap: Mishap,
    pattern: Pattern,
}

impl VectorField for Fragile {
    fn dim(&self) -> usize {
        2
    }
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        ydot.iter_mut().zip(y).for_each(|(rate, y)| *rate = -1e3 * (y - t.sin()));
        Ok(())
    }
    fn has_jacobian(&self) -> bool {
        true
    }
    fn sparsity(&self) -> Option<&Pattern> {
        Some(&self.pattern)
    }
    fn sparse_jacobian(&mut self, t: f64, _y: &[f64], values: &mut [f64]) -> Result<(), Failure> {
        answer(self.mishap, self.place == Place::SparseJacobian && t > WALL, &[1.0, 1.0], values)
    }
    fn has_jvp(&self) -> bool {
        true
    }
    fn jvp(&mut self, t: f64, _y: &[f64], v: &[f64], product: &mut [f64]) -> Result<(), Failure> {
        answer(self.mishap, self.place == Place::Product && t > WALL, v, product)
    }
    fn component_name(&self, i: usize) -> String {
        ["left", "right"][i].to_owned()
    }
}

/// The exact preconditioner P = (1 + 1000 γ) I.
struct Scale {
    place: Place,
    mishap: Mishap,
    t: f64,
    gamma: f64,
}

impl Preconditioner for Scale {
    fn linearise(&mut self, _field: &mut dyn VectorField, t: f64, _y: &[f64]) -> Result<(), Failure> {
        self.t = t;
        answer(self.mishap, self.place == Place::Linearise && t > WALL, &[], &mut [])
    }
    fn factorise(&mut self, gamma: f64) -> Result<(), Failure> {
        self.gamma = gamma;
        answer(self.mishap, self.place == Place::Factorise && self.t > WALL, &[], &mut [])
    }
    fn solve(&mut self, r: &[f64], z: &mut [f64]) -> Result<(), Failure> {
        answer(self.mishap, self.place == Place::Solve && self.t > WALL, r, z)?;
        let factor = -1e-3 / (1.0 + 1e3 * self.gamma);
        z.iter_mut().for_each(|z| *z *= factor);
        Ok(())
    }
}

fn start(place: Place, mishap: Mishap, solver: &LinearSolver) -> Integration<Cvode<Fragile>> {
    let pattern = Pattern::from_columns(2, [[0], [1]]);
    // Shorter steps would need no products, since their prediction satisfies Newton's iteration at
    // once.
    let options = Options::new(Method::Bdf)
        .relative_tolerance(1e-5)
        .absolute_tolerance(1e-8)
        .max_order(1)
        .min_step(1e-3)
        .max_step(5e-3)
        .linear_solver(solver.clone());
    Integration::new(Fragile { place, mishap, pattern }, 0.0, &[-1e-3; 2], &options).unwrap()
}

fn cases() -> Vec<(Place, Mishap, LinearSolver)> {
    let mut cases = Vec::new();
    for mishap in [Mishap::Panic, Mishap::Fatal, Mishap::Recoverable, Mishap::NotFinite, Mishap::Unwritten] {
        let band = LinearSolver::Band { lower: 0, upper: 0 };
        cases.push((Place::SparseJacobian, mishap, band));
        cases.push((Place::SparseJacobian, mishap, LinearSolver::Sparse));
        cases.push((Place::Product, mishap, LinearSolver::Krylov(Krylov::default())));
        for place in [Place::Linearise, Place::Factorise, Place::Solve] {
            if place != Place::Solve && matches!(mishap, Mishap::NotFinite | Mishap::Unwritten) {
                continue; // They write no numbers.
            }
            let scale = move || Scale { place, mishap, t: 0.0, gamma: 0.0 };
            let krylov = Krylov::default().preconditioner(Side::Left, scale);
            cases.push((place, mishap, LinearSolver::Krylov(krylov)));
        }
    }
    cases
}

/// The last state is the one before the wall or, since CVODES reuses its matrices, some steps
/// beyond.
fn assert_reached(t: f64, y: &[f64]) {
    assert!(t > 0.9 * WALL && t < 3.0, "{t}");
    // y = (sin t − ε cos t)/(1 + ε²) with ε = 1/1000, to the tolerance times some hundred steps.
    let exact = (t.sin() - 1e-3 * t.cos()) / (1.0 + 1e-6);
    assert!(y.iter().all(|y| (y - exact).abs() < 1e-4), "{y:?} at {t} is not {exact}");
}

#[test]
fn failures_are_named_and_leave_the_last_state() {
    for (place, mishap, solver) in cases() {
        let mut cvode = start(place, mishap, &solver);
        let case = format!("{place:?} {mishap:?} {solver:?}");
        cvode.state_at(0.5).unwrap();
        let run = catch_unwind(AssertUnwindSafe(|| cvode.state_at(4.0).map(<[f64]>::len)));
        let error = match run {
            Err(panic) => {
                assert_eq!(mishap, Mishap::Panic, "{case}");
                assert_eq!(panic.downcast_ref::<&str>(), Some(&"no more"));
                assert_reached(cvode.time(), cvode.state());
                continue;
            }
            Ok(result) => result.expect_err(&case),
        };
        assert_reached(cvode.time(), cvode.state());
        assert_eq!(error.reached(), Some((cvode.time(), cvode.state())), "{case}");
        let set_up = matches!(place, Place::SparseJacobian | Place::Linearise | Place::Factorise);
        let code = match mishap {
            Mishap::Fatal if set_up => Code::LinearSetup,
            Mishap::Fatal => Code::LinearSolve,
            _ => Code::ConvergenceFailure,
        };
        assert_eq!(error.code(), Some(code), "{case}");
        let SolveError::Integration(error) = error else { panic!("{case}") };
        let cause = error.source().unwrap();
        let t = error.time;
        match (mishap, place) {
            (Mishap::Fatal | Mishap::Recoverable, _) => assert!(cause.is::<NoMore>(), "{case}: {cause}"),
            (_, Place::SparseJacobian) => {
                assert!(
                    cause.to_string().starts_with("the derivative of the rate of left by left is "),
                    "{cause}"
                );
            }
            (_, Place::Product) => {
                assert!(
                    cause.to_string().starts_with("the derivative of the rate of left in a direction is ")
                );
            }
            (_, _) => assert!(cause.to_string().starts_with("the preconditioner sets left to "), "{cause}"),
        }
        if !matches!(mishap, Mishap::Fatal | Mishap::Recoverable) {
            let cause = cause.downcast_ref::<NonFinite>().unwrap();
            let (NonFinite::Jacobian { value, t: at, .. }
            | NonFinite::Product { value, t: at, .. }
            | NonFinite::Preconditioned { value, t: at, .. }) = cause
            else {
                panic!("{case}: {cause}")
            };
            assert_eq!(value.is_nan(), mishap == Mishap::Unwritten);
            assert!(*at > t && *at > WALL, "{at} {t}");
        }
    }
}

/// f itself fails in the difference quotients for a sparse Jacobian.
#[test]
fn failures_inside_quotients() {
    for recoverable in [true, false] {
        let field = pc_solve::from_fn(2, move |t: f64, y: &[f64], ydot: &mut [f64]| {
            // The increments of quotients leave the line y₀ = y₁ of the motion.
            if t > WALL && y[0] != y[1] {
                return Err(if recoverable { Failure::recoverable(NoMore) } else { Failure::fatal(NoMore) });
            }
            ydot.iter_mut().zip(y).for_each(|(rate, y)| *rate = -1e3 * (y - t.sin()));
            Ok(())
        })
        .with_sparsity(Pattern::from_columns(2, [[0, 1], [0, 1]]));
        let options = Options::new(Method::Bdf)
            .relative_tolerance(1e-6)
            .absolute_tolerance(1e-8)
            .max_step(0.005)
            .linear_solver(LinearSolver::Sparse);
        let mut cvode = Integration::new(field, 0.0, &[0.0, 0.0], &options).unwrap();
        let error = cvode.state_at(4.0).unwrap_err();
        assert_reached(cvode.time(), cvode.state());
        let code = if recoverable { Code::ConvergenceFailure } else { Code::LinearSetup };
        assert_eq!(error.code(), Some(code));
        let cause = error.source().unwrap();
        assert!(cause.is::<NoMore>(), "{cause}");
    }
}

/// Preconditioners, products and Jacobians receive states on the surface of the projection, to
/// within a step, not the variables of CVODES, which drift away from it.
#[test]
fn callbacks_receive_states() {
    struct Line {
        pattern: Pattern,
        worst: f64,
    }
    impl Line {
        fn note(&mut self, y: &[f64]) {
            self.worst = self.worst.max(y[1].abs());
        }
    }
    /// ẏ = (−100 (y₁ − cos t), 1), with y₂ = 0 restored by each projection.
    impl VectorField for Line {
        fn dim(&self) -> usize {
            2
        }
        fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
            ydot.copy_from_slice(&[-100.0 * (y[0] - t.cos()), 1.0]);
            Ok(())
        }
        fn has_jacobian(&self) -> bool {
            true
        }
        fn jacobian(&mut self, _t: f64, y: &[f64], jacobian: &mut [f64]) -> Result<(), Failure> {
            self.note(y);
            jacobian.copy_from_slice(&[-100.0, 0.0, 0.0, 0.0]);
            Ok(())
        }
        fn sparsity(&self) -> Option<&Pattern> {
            Some(&self.pattern)
        }
        fn sparse_jacobian(&mut self, _t: f64, y: &[f64], values: &mut [f64]) -> Result<(), Failure> {
            self.note(y);
            values[0] = -100.0;
            Ok(())
        }
        fn has_jvp(&self) -> bool {
            true
        }
        fn jvp(&mut self, _t: f64, y: &[f64], v: &[f64], product: &mut [f64]) -> Result<(), Failure> {
            self.note(y);
            product.copy_from_slice(&[-100.0 * v[0], 0.0]);
            Ok(())
        }
        fn has_projection(&self) -> bool {
            true
        }
        fn project(&mut self, _t: f64, y: &mut [f64]) -> Result<(), Failure> {
            y[1] = 0.0;
            Ok(())
        }
    }
    struct Nothing;
    impl Preconditioner for Nothing {
        fn linearise(&mut self, field: &mut dyn VectorField, t: f64, y: &[f64]) -> Result<(), Failure> {
            field.jacobian(t, y, &mut [0.0; 4])
        }
        fn factorise(&mut self, _gamma: f64) -> Result<(), Failure> {
            Ok(())
        }
        fn solve(&mut self, r: &[f64], z: &mut [f64]) -> Result<(), Failure> {
            z.copy_from_slice(r);
            Ok(())
        }
    }
    let krylov = Krylov::default();
    let solvers = [
        LinearSolver::Dense,
        LinearSolver::Band { lower: 1, upper: 1 },
        LinearSolver::Sparse,
        LinearSolver::Krylov(krylov.clone()),
        LinearSolver::Krylov(krylov.preconditioner(Side::Right, || Nothing)),
    ];
    for solver in solvers {
        let options = Options::new(Method::Bdf)
            .relative_tolerance(1e-6)
            .absolute_tolerance(1e-6)
            .max_step(0.1)
            .linear_solver(solver.clone());
        let line = Line { pattern: Pattern::from_columns(2, [vec![0], vec![]]), worst: 0.0 };
        let mut cvode = Integration::new(line, 0.0, &[1.0, 0.0], &options).unwrap();
        cvode.state_at(10.0).unwrap();
        let worst = cvode.field().worst;
        // At most the length of a step; without projection it would be the whole time.
        assert!(worst > 0.0 && worst < 0.1 + 1e-6, "{solver:?}: {worst:e}");
    }
}
