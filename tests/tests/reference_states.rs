//! End states and drifts of every built-in model, integrated with CVODE, against references of 16 digits.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use pc_mech::{AlgebraError, Graph, MechError, VectorField};
use pc_model::{BUILTIN, Builtin, Model};
use pc_solve::{Method, Options, solve};
use pc_tests::reference::REFERENCES;

/// What is asked of an integration at rtol = 1e-12, atol = 1e-14: the references have 16 digits, and the motions
/// magnify an error of the start by at most a few hundred over their time.
const TOLERANCE: f64 = 1e-8;

#[test]
fn every_model_has_a_reference() {
    let mut models: Vec<&str> = BUILTIN.iter().map(|model| model.name).collect();
    models.sort_unstable();
    assert_eq!(models, REFERENCES.iter().map(|reference| reference.model).collect::<Vec<_>>());
}

fn run(method: Method) {
    for reference in REFERENCES {
        let name = reference.model;
        let model = Model::new(Builtin::named(name).unwrap().document().unwrap());
        let graph = Graph::new();
        let assembly = model.assemble(&graph).unwrap();
        let (mut motion, start) = model.compile(&assembly).unwrap();
        let mut watch = motion.clone();

        let times: Vec<f64> = (1..=20).map(|i| reference.t_end * f64::from(i) / 20.0).collect();
        let options = Options::new(method).relative_tolerance(1e-12).absolute_tolerance(1e-14);
        let trajectory = solve(&mut motion, assembly.t_start, &start, &times, &options).unwrap();

        let (_, end) = trajectory.last().unwrap();
        for (i, expected) in reference.state.iter().enumerate() {
            let error = (end[i] - expected).abs();
            assert!(error <= TOLERANCE, "{name} by {method}: component {i} is {}, not {expected}", end[i]);
        }
        let start = watch.observe(assembly.t_start, &start);
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

/// The same end states through momenta.
#[test]
fn the_canonical_equations_reach_the_references() {
    let mut implicit = Vec::new();
    for reference in REFERENCES {
        let name = reference.model;
        let model = Model::new(Builtin::named(name).unwrap().document().unwrap());
        let graph = Graph::new();
        let assembly = model.assemble(&graph).unwrap();
        let canonical = assembly.system.canonical().unwrap();
        if !canonical.is_closed() {
            implicit.push(name);
        }
        let mut transform = canonical.legendre_transform().unwrap();
        let start = transform.to_momenta(assembly.t_start, &assembly.start).unwrap();
        for method in [Method::Adams, Method::Bdf] {
            let mut motion = model.compile_canonical(&canonical, assembly.t_start, &start).unwrap();
            let options = Options::new(method).relative_tolerance(1e-12).absolute_tolerance(1e-14);
            let trajectory =
                solve(&mut motion, assembly.t_start, &start, &[reference.t_end], &options).unwrap();
            let (t, end) = trajectory.last().unwrap();
            let end = transform.to_quasi_velocities(t, end).unwrap();
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
    assert_eq!(implicit, ["relativistic-constant-force", "relativistic-particle"]);
}

/// The same end states by Lagrange's equations, of all models whose frame is a change of coordinate velocities.
#[test]
fn lagranges_equations_reach_the_references() {
    let (mut redundant, mut dependent) = (Vec::new(), Vec::new());
    for reference in REFERENCES {
        let name = reference.model;
        let model = Model::new(Builtin::named(name).unwrap().document().unwrap());
        let graph = Graph::new();
        let assembly = model.assemble(&graph).unwrap();
        let lagrange = match assembly.system.in_velocities() {
            Ok(lagrange) => lagrange,
            Err(MechError::Redundant { .. }) => {
                redundant.push(name);
                continue;
            }
            Err(error) => {
                let singular =
                    matches!(error, MechError::Algebra(AlgebraError::DependentOperators { rank: 2, .. }));
                assert!(singular, "{name}: {error}");
                dependent.push(name);
                continue;
            }
        };
        // ẋ = b η + b_0 at the start and, where η is known there, at the end
        let n = assembly.system.frame().coordinates().len();
        let mut framed = assembly.system.poincare().unwrap().compile().unwrap();
        let mut in_velocities = |t: f64, y: &[f64]| {
            let mut rates = vec![f64::NAN; y.len()];
            framed.rhs(t, y, &mut rates).unwrap();
            [&y[..n], &rates[..n]].concat()
        };
        let start = in_velocities(assembly.t_start, &assembly.start);
        let end = match reference.state {
            state if state.len() == 2 * n => in_velocities(reference.t_end, state),
            coordinates => coordinates.to_vec(),
        };
        let mut motion = lagrange.poincare().unwrap().compile().unwrap();
        for method in [Method::Adams, Method::Bdf] {
            let options = Options::new(method).relative_tolerance(1e-12).absolute_tolerance(1e-14);
            let trajectory =
                solve(&mut motion, assembly.t_start, &start, &[reference.t_end], &options).unwrap();
            let (_, found) = trajectory.last().unwrap();
            for (i, expected) in end.iter().enumerate() {
                let error = (found[i] - expected).abs();
                assert!(
                    error <= TOLERANCE,
                    "{name} by {method}: component {i} is {}, not {expected}",
                    found[i]
                );
            }
        }
    }
    assert_eq!(
        redundant,
        [
            "double-pendulum-cartesian",
            "double-pendulum-links",
            "euler-top",
            "gravity-gradient",
            "heavy-top-quaternion",
            "pendulum-chain-cartesian",
            "rigid-body-spring",
            "spherical-pendulum-cartesian",
            "spherical-pendulum-meridian",
            "turning-hoop",
            "turning-wire",
        ]
    );
    // γ moves on a sphere, so that γ̇ does not tell ω.
    assert_eq!(dependent, ["heavy-top-goryachev-chaplygin", "heavy-top-kovalevskaya", "heavy-top-lagrange"]);
}
