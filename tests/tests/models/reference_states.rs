//! End states and drifts of every built-in model, by each method, against references of 16 digits.

use pc_mech::{AlgebraError, Expr, LagrangianError, MechError, VectorField};
use pc_model::Assembly;
use pc_solve::{Method, Options, solve};
use pc_tests::reference::{Reference, reference};

use crate::derived::Derived;

/// What is asked of an integration at rtol = 1e-12, atol = 1e-14: the references have 16 digits, and the motions
/// magnify an error of the start by at most a few hundred over their time.
const TOLERANCE: f64 = 1e-8;

/// A model with a spread of rates of 10⁷: for BDF alone, and to 1e-6, which the friction, steep in v, leaves of rtol = 1e-12.
pub(crate) const STIFF: &str = "stiff-sleigh";

/// What is asked of a model by a method, if it is one for the model.
fn tolerance(model: &str, method: Method) -> Option<f64> {
    match (model == STIFF, method) {
        (false, _) => Some(TOLERANCE),
        (true, Method::Bdf | Method::Auto) => Some(1e-6),
        (true, Method::Adams | Method::Dop853 | Method::Taylor) => None,
    }
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

fn options(method: Method) -> Options {
    Options::new(method).relative_tolerance(1e-12).absolute_tolerance(1e-14)
}

fn run(derived: &Derived<'_>, method: Method) {
    let name = derived.name;
    let Some(tolerance) = tolerance(name, method) else { return };
    let (reference, t_start) = (reference(name).unwrap(), derived.assembly.t_start);
    let (mut motion, start) = derived.motion();
    let mut watch = motion.clone();

    let times: Vec<f64> = (1..=20).map(|i| reference.t_end * f64::from(i) / 20.0).collect();
    let trajectory = solve(&mut motion, t_start, &start, &times, &options(method)).unwrap();

    let (_, end) = trajectory.last().unwrap();
    assert_arrived(reference, &method.to_string(), watch.names(), end, tolerance);
    let start = watch.observe(t_start, &start);
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

pub(crate) fn adams_reaches_the_references(derived: &Derived<'_>) {
    run(derived, Method::Adams);
}

pub(crate) fn bdf_reaches_the_references(derived: &Derived<'_>) {
    run(derived, Method::Bdf);
}

pub(crate) fn dop853_reaches_the_references(derived: &Derived<'_>) {
    run(derived, Method::Dop853);
}

pub(crate) fn the_choice_of_methods_reaches_the_references(derived: &Derived<'_>) {
    run(derived, Method::Auto);
}

/// From the end back to the start, of the motions that do not grow on the way back by more than a thousandfold.
pub(crate) fn dop853_comes_back_to_the_starts(derived: &Derived<'_>) {
    let name = derived.name;
    let Some(tolerance) = tolerance(name, Method::Dop853) else { return };
    let ((mut motion, start), t) = (derived.motion(), derived.assembly.t_start);
    let options = options(Method::Dop853);
    let there = solve(&mut motion, t, &start, &[reference(name).unwrap().t_end], &options).unwrap();
    let (end, state) = there.last().unwrap();
    let back =
        solve(&mut motion, end, state, &[t], &options).unwrap_or_else(|error| panic!("{name}: {error}"));
    let error = back.state(0).iter().zip(&start).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(error <= 1e3 * tolerance, "{name} comes back {error:e} aside of the start");
}

/// Where the velocities that its constraints determine best at the start, Ẏ and θ̇ of Ẋ and φ̇, are no longer determined
/// on the way: at cos φ = 0.
pub(crate) const OUT_OF_ITS_CHART: &str = "vertical-disk";

/// Their Lagrangians are not quadratic, and η is not solved for.
pub(crate) const IMPLICIT: [&str; 2] = ["relativistic-constant-force", "relativistic-particle"];

/// The same end states through momenta.
pub(crate) fn the_canonical_equations_reach_the_references(derived: &Derived<'_>) {
    if derived.name != OUT_OF_ITS_CHART {
        derived.anew(|assembly| reaches_through_momenta(derived, assembly));
    }
}

fn reaches_through_momenta(derived: &Derived<'_>, assembly: &Assembly<'_>) {
    let (name, t_start) = (derived.name, assembly.t_start);
    let (reference, system) = (reference(name).unwrap(), assembly.free_system().unwrap());
    let canonical = system.canonical().unwrap();
    assert_eq!(canonical.is_closed(), !derived.is_among(&IMPLICIT), "{name}");
    let mut transform = canonical.legendre_transform().unwrap();
    let state = [system.frame().coordinates(), system.quasi_velocities()];
    let start = transform.to_momenta(t_start, &assembly.start_of(&state.concat())).unwrap();
    let motion = derived.model.compile_canonical(&canonical, t_start, &start).unwrap();
    for method in [Method::Adams, Method::Bdf, Method::Dop853] {
        let Some(tolerance) = tolerance(name, method) else { continue };
        let mut motion = motion.clone();
        let trajectory = solve(&mut motion, t_start, &start, &[reference.t_end], &options(method)).unwrap();
        let (t, end) = trajectory.last().unwrap();
        let end = transform.to_quasi_velocities(t, end).unwrap();
        assert_arrived(reference, &method.to_string(), &names(&state), &end, tolerance);
    }
}

/// More coordinates than quasi-velocities, or none.
pub(crate) const REDUNDANT: [&str; 20] = [
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
];

/// γ moves on a sphere, so that γ̇ does not tell ω.
pub(crate) const DEPENDENT: [&str; 3] =
    ["heavy-top-goryachev-chaplygin", "heavy-top-kovalevskaya", "heavy-top-lagrange"];

/// That a model has no equations in velocities is said of the models of which it is true, by the right error.
fn assert_not_in_velocities(derived: &Derived<'_>, error: &MechError) {
    let name = derived.name;
    if let MechError::Lagrangian(LagrangianError::RedundantCoordinates { .. }) = error {
        assert!(derived.is_among(&REDUNDANT), "{name}: {error}");
        return;
    }
    assert!(error.is_of_dependent_coordinates(), "{name}: {error}");
    let singular = matches!(error, MechError::Algebra(AlgebraError::DependentOperators { rank: 2, .. }));
    assert!(singular && derived.is_among(&DEPENDENT), "{name}: {error}");
}

/// The same end states by Lagrange's equations, of all models whose frame is a change of coordinate velocities.
pub(crate) fn lagranges_equations_reach_the_references(derived: &Derived<'_>) {
    let (name, t_start) = (derived.name, derived.assembly.t_start);
    let motion = match derived.in_velocities() {
        Ok(motion) => motion,
        Err(error) => return assert_not_in_velocities(derived, error),
    };
    assert!(!derived.is_among(&REDUNDANT) && !derived.is_among(&DEPENDENT), "{name}");
    let reference = reference(name).unwrap();
    // ẋ = b η + b_0 at the start and, where η is known there, at the end
    let system = derived.equations.system();
    let n = system.frame().coordinates().len();
    let mut framed = derived.equations_compiled();
    let mut with_velocities = |t: f64, y: &[f64]| {
        let mut rates = vec![f64::NAN; y.len()];
        framed.rhs(t, y, &mut rates).unwrap();
        [&y[..n], &rates[..n]].concat()
    };
    let start = with_velocities(t_start, &derived.assembly.start_of(&derived.state()));
    let end = match reference.state {
        state if state.len() == reference.columns.len() => {
            with_velocities(reference.t_end, &reference.pick(derived.state(), state))
        }
        coordinates => coordinates.to_vec(),
    };
    for method in [Method::Adams, Method::Bdf, Method::Dop853] {
        let Some(tolerance) = tolerance(name, method) else { continue };
        let trajectory =
            solve(&mut motion.clone(), t_start, &start, &[reference.t_end], &options(method)).unwrap();
        let (_, found) = trajectory.last().unwrap();
        for (i, expected) in end.iter().enumerate() {
            let error = (found[i] - expected).abs();
            let arrived = error <= tolerance;
            assert!(arrived, "{name} by {method}: component {i} is {}, not {expected}", found[i]);
        }
    }
}
