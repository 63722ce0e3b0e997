//! End states and drifts of every built-in model, integrated with CVODE, against references of 16 digits.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use pc_mech::{Graph, MechError};
use pc_model::{Builtin, Model};
use pc_solve::{Method, Options, solve};
use pc_tests::reference::REFERENCES;

/// What is asked of an integration at rtol = 1e-12, atol = 1e-14: the references have 16 digits, and the motions
/// magnify an error of the start by at most a few hundred over their time.
const TOLERANCE: f64 = 1e-8;

fn run(method: Method) {
    for reference in REFERENCES {
        let name = reference.model;
        let model = Model::new(Builtin::named(name).unwrap().document().unwrap());
        let graph = Graph::new();
        let assembly = model.assemble(&graph).unwrap();
        let equations = assembly.system.poincare().unwrap();
        let mut motion = model.compile(&equations, assembly.t_start, &assembly.start).unwrap();
        let mut watch = equations.compile().unwrap();

        let times: Vec<f64> = (1..=20).map(|i| reference.t_end * f64::from(i) / 20.0).collect();
        let options = Options::new(method).relative_tolerance(1e-12).absolute_tolerance(1e-14);
        let trajectory = solve(&mut motion, assembly.t_start, &assembly.start, &times, &options).unwrap();

        let (_, end) = trajectory.last().unwrap();
        for (i, expected) in reference.state.iter().enumerate() {
            let error = (end[i] - expected).abs();
            assert!(error <= TOLERANCE, "{name} by {method}: component {i} is {}, not {expected}", end[i]);
        }
        let start = watch.observe(assembly.t_start, &assembly.start);
        let names = watch.observable_names().to_vec();
        for (t, y) in trajectory.iter() {
            let now = watch.observe(t, y);
            for conserved in reference.conserved {
                let i = names.iter().position(|name| name == conserved).unwrap();
                let drift = (now[i] - start[i]).abs() / (1.0 + start[i].abs());
                assert!(drift <= TOLERANCE, "{name} by {method}: {conserved} drifts by {drift:e} at t = {t}");
            }
        }
    }
}

#[test]
fn adams_reaches_the_references() {
    run(Method::Adams);
}

#[test]
fn bdf_reaches_the_references() {
    run(Method::Bdf);
}

/// The same end states through momenta, of all models whose Lagrangian is quadratic in the quasi-velocities.
#[test]
fn the_canonical_equations_reach_the_references() {
    let mut refused = Vec::new();
    for reference in REFERENCES {
        let name = reference.model;
        let model = Model::new(Builtin::named(name).unwrap().document().unwrap());
        let graph = Graph::new();
        let assembly = model.assemble(&graph).unwrap();
        let canonical = match assembly.system.canonical() {
            Ok(canonical) => canonical,
            Err(error) => {
                assert!(matches!(error, MechError::NotQuadratic { .. }), "{name}: {error}");
                refused.push(name);
                continue;
            }
        };
        let mut transform = canonical.legendre_transform().unwrap();
        let start = transform.to_momenta(assembly.t_start, &assembly.start);
        for method in [Method::Adams, Method::Bdf] {
            let mut motion = model.compile_canonical(&canonical, assembly.t_start, &start).unwrap();
            let options = Options::new(method).relative_tolerance(1e-12).absolute_tolerance(1e-14);
            let trajectory =
                solve(&mut motion, assembly.t_start, &start, &[reference.t_end], &options).unwrap();
            let (t, end) = trajectory.last().unwrap();
            let end = transform.to_quasi_velocities(t, end);
            for (i, expected) in reference.state.iter().enumerate() {
                let error = (end[i] - expected).abs();
                assert!(
                    error <= TOLERANCE,
                    "{name} by {method}: component {i} is {}, not {expected}",
                    end[i]
                );
            }
        }
    }
    assert_eq!(refused, ["relativistic-particle"]);
}
