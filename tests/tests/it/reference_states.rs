//! End states and drifts of every built-in model, by each method, against references of 16 digits.

use pc_mech::{AlgebraError, Expr, Graph, LagrangianError, MechError, Motion, VectorField};
use pc_model::{Assembly, BUILTIN, Builtin, Model};
use pc_solve::{Method, Options, solve};
use pc_tests::reference::{Reference, references};

/// What is asked of an integration at rtol = 1e-12, atol = 1e-14: the references have 16 digits, and the motions
/// magnify an error of the start by at most a few hundred over their time.
const TOLERANCE: f64 = 1e-8;

/// A model with a spread of rates of 10⁷: for BDF alone, and to 1e-6, which the friction, steep in v, leaves of rtol = 1e-12.
const STIFF: &str = "stiff-sleigh";

/// What is asked of a model by a method, if it is one for the model.
fn tolerance(model: &str, method: Method) -> Option<f64> {
    match (model == STIFF, method) {
        (false, _) => Some(TOLERANCE),
        (true, Method::Bdf | Method::Auto) => Some(1e-6),
        (true, Method::Adams | Method::Dop853 | Method::Taylor) => None,
    }
}

#[test]
fn every_model_has_a_reference() {
    let mut models: Vec<&str> = BUILTIN.iter().map(|model| model.name).collect();
    let mut known: Vec<&str> = references().map(|reference| reference.model).collect();
    models.sort_unstable();
    known.sort_unstable();
    assert_eq!(models, known);
}

/// The columns of these names have arrived.
fn assert_arrived(reference: &Reference, by: &str, names: &[String], end: &[f64], tolerance: f64) {
    let mut compared = 0;
    for (column, expected) in reference.columns.iter().zip(reference.state) {
        let Some(i) = names.iter().position(|name| name == column) else { continue };
        compared += 1;
        let (model, found) = (reference.model, end[i]);
        let error = (found - expected).abs();
        assert!(error <= tolerance, "{model} by {by}: {column} is {found}, not {expected}");
    }
    assert_eq!(compared, names.len().min(reference.state.len()), "{}: {names:?}", reference.model);
}

fn names(symbols: &[&[Expr<'_>]]) -> Vec<String> {
    symbols.concat().iter().map(Expr::to_string).collect()
}

fn run(method: Method) {
    for reference in references() {
        let name = reference.model;
        let Some(tolerance) = tolerance(name, method) else { continue };
        let model = Model::new(Builtin::named(name).unwrap().document().unwrap());
        let graph = Graph::new();
        let assembly = model.assemble(&graph).unwrap();
        let (mut motion, start) = model.compile(&assembly).unwrap();
        let mut watch = motion.clone();

        let times: Vec<f64> = (1..=20).map(|i| reference.t_end * f64::from(i) / 20.0).collect();
        let options = Options::new(method).relative_tolerance(1e-12).absolute_tolerance(1e-14);
        let trajectory = solve(&mut motion, assembly.t_start, &start, &times, &options).unwrap();

        let (_, end) = trajectory.last().unwrap();
        assert_arrived(reference, &method.to_string(), watch.names(), end, tolerance);
        let start = watch.observe(assembly.t_start, &start);
        let names = watch.observable_names().to_vec();
        for (t, y) in trajectory.iter() {
            let now = watch.observe(t, y);
            for conserved in reference.conserved {
                let i = names.iter().position(|name| name == conserved).unwrap();
                let drift = (now[i] - start[i]).abs() / (1.0 + start[i].abs());
                assert!(drift <= tolerance, "{name} by {method}: {conserved} drifts by {drift:e} at t = {t}");
            }
            let slips = watch.constraint_residuals(t, y);
            assert!(slips.iter().all(|slip| slip.abs() <= tolerance), "{name} by {method}: {slips:?}");
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

#[test]
fn dop853_reaches_the_references() {
    run(Method::Dop853);
}

#[test]
fn the_choice_of_methods_reaches_the_references() {
    run(Method::Auto);
}

/// From the end back to the start, of the motions that do not grow on the way back by more than a thousandfold.
#[test]
fn dop853_comes_back_to_the_starts() {
    let mut far = Vec::new();
    for reference in references() {
        let name = reference.model;
        let Some(tolerance) = tolerance(name, Method::Dop853) else { continue };
        let model = Model::new(Builtin::named(name).unwrap().document().unwrap());
        let graph = Graph::new();
        let assembly = model.assemble(&graph).unwrap();
        let (mut motion, start) = model.compile(&assembly).unwrap();
        let options = Options::new(Method::Dop853).relative_tolerance(1e-12).absolute_tolerance(1e-14);
        let t = assembly.t_start;
        let there = solve(&mut motion, t, &start, &[reference.t_end], &options).unwrap();
        let (end, state) = there.last().unwrap();
        let back = solve(&mut motion, end, state, &[t], &options).map(|back| back.state(0).to_vec());
        let error = |back: &[f64]| back.iter().zip(&start).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        match back {
            Ok(back) if error(&back) <= 1e3 * tolerance => {}
            _ => far.push(name),
        }
    }
    assert_eq!(far, [""; 0]);
}

/// Where the velocities that its constraints determine best at the start, Ẏ and θ̇ of Ẋ and φ̇, are no longer determined
/// on the way: at cos φ = 0.
const OUT_OF_ITS_CHART: &str = "vertical-disk";

/// The same end states through momenta.
#[test]
fn the_canonical_equations_reach_the_references() {
    let mut implicit = Vec::new();
    for reference in references().filter(|reference| reference.model != OUT_OF_ITS_CHART) {
        let name = reference.model;
        let model = Model::new(Builtin::named(name).unwrap().document().unwrap());
        let graph = Graph::new();
        let assembly = model.assemble(&graph).unwrap();
        let system = assembly.free_system().unwrap();
        let canonical = system.canonical().unwrap();
        if !canonical.is_closed() {
            implicit.push(name);
        }
        let mut transform = canonical.legendre_transform().unwrap();
        let state = [system.frame().coordinates(), system.quasi_velocities()];
        let start = transform.to_momenta(assembly.t_start, &assembly.start_of(&state.concat())).unwrap();
        for method in [Method::Adams, Method::Bdf, Method::Dop853] {
            let Some(tolerance) = tolerance(name, method) else { continue };
            let mut motion = model.compile_canonical(&canonical, assembly.t_start, &start).unwrap();
            let options = Options::new(method).relative_tolerance(1e-12).absolute_tolerance(1e-14);
            let trajectory =
                solve(&mut motion, assembly.t_start, &start, &[reference.t_end], &options).unwrap();
            let (t, end) = trajectory.last().unwrap();
            let end = transform.to_quasi_velocities(t, end).unwrap();
            assert_arrived(reference, &method.to_string(), &names(&state), &end, tolerance);
        }
    }
    assert_eq!(implicit, ["relativistic-constant-force", "relativistic-particle"]);
}

/// Lagrange's equations of a model, with multipliers where it has constraints.
fn in_velocities(assembly: &Assembly<'_>) -> Result<Motion, MechError> {
    match assembly.constraints.multipliers() {
        Some(multipliers) => multipliers.in_velocities()?.compile(),
        None => assembly.system.in_velocities()?.poincare()?.compile(),
    }
}

/// The same end states by Lagrange's equations, of all models whose frame is a change of coordinate velocities.
#[test]
fn lagranges_equations_reach_the_references() {
    let (mut redundant, mut dependent) = (Vec::new(), Vec::new());
    for reference in references() {
        let name = reference.model;
        let model = Model::new(Builtin::named(name).unwrap().document().unwrap());
        let graph = Graph::new();
        let assembly = model.assemble(&graph).unwrap();
        let mut motion = match in_velocities(&assembly) {
            Ok(motion) => motion,
            Err(MechError::Lagrangian(LagrangianError::RedundantCoordinates { .. })) => {
                redundant.push(name);
                continue;
            }
            Err(error) => {
                assert!(error.is_of_dependent_coordinates(), "{name}: {error}");
                let singular =
                    matches!(error, MechError::Algebra(AlgebraError::DependentOperators { rank: 2, .. }));
                assert!(singular, "{name}: {error}");
                dependent.push(name);
                continue;
            }
        };
        // ẋ = b η + b_0 at the start and, where η is known there, at the end
        let equations = assembly.equations().unwrap();
        let (x, eta) = (equations.system().frame().coordinates(), equations.system().quasi_velocities());
        let mut framed = equations.compile().unwrap();
        let mut with_velocities = |t: f64, y: &[f64]| {
            let mut rates = vec![f64::NAN; y.len()];
            framed.rhs(t, y, &mut rates).unwrap();
            [&y[..x.len()], &rates[..x.len()]].concat()
        };
        let start = with_velocities(assembly.t_start, &assembly.start_of(&[x, eta].concat()));
        let end = match reference.state {
            state if state.len() == reference.columns.len() => {
                with_velocities(reference.t_end, &reference.pick([x, eta].concat(), state))
            }
            coordinates => coordinates.to_vec(),
        };
        for method in [Method::Adams, Method::Bdf, Method::Dop853] {
            let Some(tolerance) = tolerance(name, method) else { continue };
            let options = Options::new(method).relative_tolerance(1e-12).absolute_tolerance(1e-14);
            let trajectory =
                solve(&mut motion, assembly.t_start, &start, &[reference.t_end], &options).unwrap();
            let (_, found) = trajectory.last().unwrap();
            for (i, expected) in end.iter().enumerate() {
                let error = (found[i] - expected).abs();
                assert!(
                    error <= tolerance,
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
            "reaction-wheels",
            "rigid-body-spring",
            "rocking-block",
            "spherical-pendulum-cartesian",
            "spherical-pendulum-meridian",
            "stick-slip-block",
            "turning-hoop",
            "turning-wire",
            "ball-in-cylinder",
            "stick-slip-sleigh",
            "suslov",
            "suslov-in-gravity",
            "turntable",
            "turntable-accelerated",
        ]
    );
    // γ moves on a sphere, so that γ̇ does not tell ω.
    assert_eq!(dependent, ["heavy-top-goryachev-chaplygin", "heavy-top-kovalevskaya", "heavy-top-lagrange"]);
}
