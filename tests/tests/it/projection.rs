//! Unit vectors, unit quaternions, constraints and energy over long runs, and what keeping them does to the error.

use pc_mech::{Graph, Motion, VectorField};
use pc_model::{Builtin, Model};
use pc_solve::{Integration, Method, Options, solve};

/// The motion of a built-in model in which these integrals are kept and no others, and its start.
fn motion(name: &str, kept: &[&str]) -> (Motion, Vec<f64>) {
    let mut document = Builtin::named(name).unwrap().document().unwrap();
    document.simulation.project.clear();
    let mut model = Model::new(document);
    for name in kept {
        model.keep(name).unwrap();
    }
    let graph = Graph::new();
    let assembly = model.assemble(&graph).unwrap();
    model.compile(&assembly).unwrap()
}

/// The largest change of the observable of this name, and the largest residual of a constraint, over 100 000 internal
/// steps.
fn drift(name: &str, kept: &[&str], observable: &str, method: Method) -> (f64, f64) {
    let (mut motion, start) = motion(name, kept);
    let j = motion.observable_names().iter().position(|name| name == observable).unwrap();
    let level = motion.observe(0.0, &start)[j];
    let mut watch = motion.clone();
    let options = Options::new(method).relative_tolerance(1e-9).absolute_tolerance(1e-9);
    let mut cvode = Integration::new(&mut motion, 0.0, &start, &options).unwrap();
    let (mut worst, mut residual): (f64, f64) = (0.0, 0.0);
    for step in 0..100_000 {
        let t = cvode.step_towards(1e9).unwrap();
        if step % 10 == 0 {
            worst = worst.max((watch.observe(t, cvode.state())[j] - level).abs());
            residual =
                watch.constraint_residuals(t, cvode.state()).iter().fold(residual, |r, c| r.max(c.abs()));
        }
    }
    (worst, residual)
}

#[test]
fn unit_vectors_and_quaternions_stay_so() {
    for method in [Method::Adams, Method::Bdf] {
        for name in ["heavy-top-lagrange", "heavy-top-quaternion"] {
            let (norm, _) = drift(name, &["norm"], "norm", method);
            assert!(norm < 1e-14, "{name} by {method}: {norm:e}"); // some roundings of numbers below 1
        }
    }
    // As far as it goes without: the test can fail.
    assert!(drift("heavy-top-quaternion", &[], "norm", Method::Bdf).0 > 1e-7);
}

#[test]
fn constraints_and_energy_stay_together() {
    for method in [Method::Adams, Method::Bdf] {
        let (energy, constraint) = drift("double-pendulum-cartesian", &["energy"], "energy", method);
        assert!(energy < 1e-12, "{method}: {energy:e}"); // roundings of numbers of order 30
        assert!(constraint < 1e-13, "{method}: {constraint:e}"); // and of order 1
    }
}

/// By how many powers of ten the error falls when the tolerance does by one, over four tolerances; and the error at the
/// last.
fn slope(method: Method, kept: &[&str]) -> (f64, f64) {
    let (reference, start) = motion("heavy-top-quaternion", &[]);
    let exact = Options::new(Method::Adams).relative_tolerance(1e-13).absolute_tolerance(1e-15);
    let end = solve(reference, 0.0, &start, &[10.0], &exact).unwrap();
    let exponents = [-5.0f64, -7.0, -9.0, -11.0];
    let errors: Vec<f64> = exponents
        .iter()
        .map(|exponent| {
            let (motion, start) = motion("heavy-top-quaternion", kept);
            assert_eq!(motion.has_projection(), !kept.is_empty());
            let tolerance = 10.0f64.powf(*exponent);
            let options = Options::new(method).relative_tolerance(tolerance).absolute_tolerance(tolerance);
            let found = solve(motion, 0.0, &start, &[10.0], &options).unwrap();
            let difference = found.state(0).iter().zip(end.state(0)).map(|(a, b)| (a - b).powi(2));
            difference.sum::<f64>().sqrt()
        })
        .collect();
    // Least squares through (exponent, log error).
    let mean = exponents.iter().sum::<f64>() / 4.0;
    let spread: f64 = exponents.iter().map(|x| (x - mean).powi(2)).sum();
    let slope =
        exponents.iter().zip(&errors).map(|(x, error)| (x - mean) * error.log10()).sum::<f64>() / spread;
    println!("{method} {kept:?}: {errors:?}, slope {slope}");
    (slope, errors[3])
}

#[test]
fn the_order_of_accuracy_is_preserved() {
    for method in [Method::Adams, Method::Bdf] {
        let (plain, error) = slope(method, &[]);
        for kept in [&["norm"][..], &["norm", "area", "energy"]] {
            let (projected, with_projection) = slope(method, kept);
            // Errors of one run scatter by a factor of two or three, the slope over six powers of ten by a tenth.
            assert!(projected > plain - 0.1, "{method}: {projected} without, {plain} with projection");
            assert!(with_projection < 4.0 * error, "{method}: {with_projection:e} and {error:e}");
        }
    }
}
