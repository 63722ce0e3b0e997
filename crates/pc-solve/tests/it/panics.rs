//! Panics of the vector field, and drops.

use std::cell::Cell;
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::rc::Rc;

use crate::boxed::{erased, from_fn};
use pc_solve::{Failure, Integration, Method, Observed, Options, VectorField, solve};

/// ẏ = 1, which panics or fails after some time, and counts its drops.
struct Fragile {
    panics_from: f64,
    fails_from: f64,
    jacobian_panics: bool,
    drops: DropCounter,
}

struct DropCounter(Rc<Cell<u32>>);

impl Drop for DropCounter {
    fn drop(&mut self) {
        self.0.set(self.0.get() + 1);
    }
}

impl Fragile {
    fn new(drops: &Rc<Cell<u32>>) -> Self {
        drops.set(0);
        let never = f64::INFINITY;
        let drops = DropCounter(Rc::clone(drops));
        Fragile { panics_from: never, fails_from: never, jacobian_panics: false, drops }
    }
}

impl VectorField for Fragile {
    fn dim(&self) -> usize {
        1
    }

    fn rhs(&mut self, t: f64, _y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        assert!(t < self.panics_from, "no further than {}", self.panics_from);
        if t >= self.fails_from {
            return Err(Failure::fatal(std::fmt::Error));
        }
        ydot[0] = 1.0;
        Ok(())
    }

    fn has_jacobian(&self) -> bool {
        true
    }

    fn jacobian(&mut self, _t: f64, _y: &[f64], jacobian: &mut [f64]) -> Result<(), Failure> {
        assert!(!self.jacobian_panics, "no Jacobian");
        jacobian[0] = 0.0;
        Ok(())
    }
}

fn message(panic: &(dyn std::any::Any + Send)) -> &str {
    panic
        .downcast_ref::<String>()
        .map_or_else(|| panic.downcast_ref::<&str>().copied().unwrap_or("?"), String::as_str)
}

#[test]
fn a_panic_reaches_the_caller_and_leaves_the_last_state() {
    for method in [Method::Adams, Method::Bdf] {
        let drops = Rc::new(Cell::new(0));
        let field = Fragile { panics_from: 2.0, ..Fragile::new(&drops) };
        let options = Options::new(method).max_step(0.1);
        let mut cvode = Integration::new(erased(field), 0.0, &[0.0], &options).unwrap();
        cvode.state_at(1.0).unwrap();
        for _ in 0..3 {
            let panic = catch_unwind(AssertUnwindSafe(|| cvode.state_at(3.0).map(<[f64]>::len))).unwrap_err();
            assert_eq!(message(&*panic), "no further than 2");
            assert!(cvode.time() < 2.0 && cvode.time() > 1.89);
            assert!((cvode.state()[0] - cvode.time()).abs() < 1e-9);
        }
        assert_eq!(drops.get(), 0);
        drop(cvode);
        assert_eq!(drops.get(), 1);
    }
}

#[test]
fn a_panic_unwinds_through_solve() {
    let drops = Rc::new(Cell::new(0));
    let field = Fragile { panics_from: 0.0, ..Fragile::new(&drops) };
    let run = || solve(erased(field), 0.0, &[0.0], &[1.0], &Options::default()).map(|motion| motion.len());
    let panic = catch_unwind(AssertUnwindSafe(run)).unwrap_err();
    assert_eq!(message(&*panic), "no further than 0");
    assert_eq!(drops.get(), 1);

    let field = Fragile { jacobian_panics: true, ..Fragile::new(&drops) };
    let run =
        || solve(erased(field), 0.0, &[0.0], &[1.0], &Options::new(Method::Bdf)).map(|motion| motion.len());
    let panic = catch_unwind(AssertUnwindSafe(run)).unwrap_err();
    assert_eq!(message(&*panic), "no Jacobian");
    assert_eq!(drops.get(), 1);

    // Other integrations are not affected.
    let motion =
        solve(erased(Fragile::new(&drops)), 0.0, &[0.0], &[1.0], &Options::new(Method::Bdf)).unwrap();
    assert!((motion.state(0)[0] - 1.0).abs() < 1e-9);
    assert_eq!(drops.get(), 1);
}

#[test]
fn a_panicking_observer_leaves_the_solver_usable() {
    let drops = Rc::new(Cell::new(0));
    let mut cvode =
        Integration::new(erased(Fragile::new(&drops)), 0.0, &[0.0], &Options::default().max_step(0.1))
            .unwrap();
    let panic =
        catch_unwind(AssertUnwindSafe(|| cvode.run(&[1.0, 2.0], |t, _| panic!("seen {t}")))).unwrap_err();
    assert_eq!(message(&*panic), "seen 1");
    assert_eq!(cvode.time(), 1.0);

    let observer = |t: f64, _: &[f64]| if t > 1.5 { panic!("far enough") } else { ControlFlow::Continue(()) };
    let run =
        || cvode.run_observed(&[1.7, 2.0], Observed::new(|_, _| ControlFlow::Continue(())).steps(observer));
    assert_eq!(message(&*catch_unwind(AssertUnwindSafe(run)).unwrap_err()), "far enough");
    assert!(cvode.time() > 1.5);
    assert!((cvode.state()[0] - cvode.time()).abs() < 1e-9);
    assert!((cvode.state_at(2.0).unwrap()[0] - 2.0).abs() < 1e-9);
}

#[test]
fn a_panic_while_naming_a_component() {
    struct Nameless;
    impl VectorField for Nameless {
        fn dim(&self) -> usize {
            1
        }
        fn rhs(&mut self, _t: f64, _y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
            ydot[0] = f64::NAN;
            Ok(())
        }
        fn component_name(&self, i: usize) -> String {
            panic!("component {i} has no name")
        }
    }
    let run = || solve(erased(Nameless), 0.0, &[0.0], &[1.0], &Options::default()).map(|motion| motion.len());
    assert_eq!(message(&*catch_unwind(run).unwrap_err()), "component 0 has no name");
}

#[test]
fn the_field_is_dropped_once() {
    let drops = Rc::new(Cell::new(0));
    let options = Options::default();

    // Before the first step.
    drop(Integration::new(erased(Fragile::new(&drops)), 0.0, &[0.0], &options).unwrap());
    assert_eq!(drops.get(), 1);

    // In the middle of a step.
    let mut cvode = Integration::new(erased(Fragile::new(&drops)), 0.0, &[0.0], &options).unwrap();
    cvode.state_at(1.0).unwrap();
    drop(cvode);
    assert_eq!(drops.get(), 1);

    // After an error; the error outlives the solver.
    let field = Fragile { fails_from: 1.0, ..Fragile::new(&drops) };
    let mut cvode = Integration::new(erased(field), 0.0, &[0.0], &options).unwrap();
    let error = cvode.state_at(2.0).unwrap_err();
    drop(cvode);
    assert_eq!(drops.get(), 1);
    assert!(error.to_string().starts_with("CV_RHSFUNC_FAIL (-8) after reaching t = "));

    // Refused.
    assert!(Integration::new(erased(Fragile::new(&drops)), f64::NAN, &[0.0], &options).is_err());
    assert_eq!(drops.get(), 1);

    // The field is returned.
    let mut cvode = Integration::new(Fragile::new(&drops), 0.0, &[0.0], &options).unwrap();
    cvode.state_at(1.0).unwrap();
    assert_eq!(cvode.field().drops.0.get(), 0);
    let field = cvode.into_field();
    assert_eq!(drops.get(), 0);
    drop(field);
    assert_eq!(drops.get(), 1);
}

/// A vector field may itself integrate.
#[test]
fn solvers_nest() {
    let inner = |end: f64| {
        let growth = from_fn(1, |_t, y, ydot| {
            ydot[0] = y[0];
            Ok(())
        });
        solve(erased(growth), 0.0, &[1.0], &[end], &Options::default())
            .map_or(f64::NAN, |motion| motion.state(0)[0])
    };
    let outer = from_fn(1, |t: f64, _y: &[f64], ydot: &mut [f64]| {
        ydot[0] = inner(1.0 + t); // e^(1+t)
        Ok(())
    });
    let options = Options::default().relative_tolerance(1e-6);
    let motion = solve(erased(outer), 0.0, &[0.0], &[1.0], &options).unwrap();
    assert!((motion.state(0)[0] - (2.0_f64.exp() - 1.0_f64.exp())).abs() < 1e-5);
}
