//! Motions in closed form: of a body without coordinates, and of a Lagrangian that is not quadratic.

use pc_mech::{AlgebraError, Graph, LieAlgebra, System, SystemBuilder};
use pc_tests::closed_form::{euler_top, euler_top_separatrix, relativistic_fall};

use super::definition::assert_definition;
use super::harness::{compiled, distance, integrate};

/// Error of an integration at rtol = 1e-12 over a few periods.
const ARRIVAL: f64 = 1e-9;

/// The free top with I = (1, 2, 3): n = 0.
fn free_top(graph: &Graph) -> SystemBuilder<'_> {
    System::builder(graph)
        .quasi_velocities(["w1", "w2", "w3"])
        .kinematics(|_, _, _| [])
        .lagrangian(|_, _, w| (w[0].square() + 2.0 * w[1].square() + 3.0 * w[2].square()) / 2.0)
}

#[test]
fn a_free_top_moves_as_elliptic_functions() {
    let graph = Graph::new();
    let top = free_top(&graph).algebra(&LieAlgebra::so3()).build().unwrap();
    let equations = top.poincare().unwrap();
    let [w1, w2, w3] = graph.symbols(["w1", "w2", "w3"]);
    assert_eq!(equations.accelerations(), [-w2 * w3, w3 * w1, -w1 * w2 / 3.0]);
    let mut motion = equations.compile().unwrap();
    let times = [1.0, 5.0, 10.0, 20.0];
    for (t, w) in times.iter().zip(integrate(&mut motion, &[1.0, 0.0, 1.0], &times)) {
        assert!(distance(&w, &euler_top(*t)) < ARRIVAL, "t = {t}: {w:?}");
    }
    // Errors grow as e^t off the separatrix.
    let times = [0.5, 1.0, 2.0, 3.0];
    for (t, w) in times.iter().zip(integrate(&mut motion, &[3f64.sqrt(), 0.0, 1.0], &times)) {
        assert!(distance(&w, &euler_top_separatrix(*t)) < ARRIVAL, "t = {t}: {w:?}");
    }
}

#[test]
fn a_free_top_without_its_algebra_is_refused() {
    let error = free_top(&Graph::new()).build().unwrap_err();
    assert_eq!(error, AlgebraError::AlgebraNeeded.into());
    assert_eq!(
        error.to_string(),
        "a frame without coordinates does not determine its structure coefficients: the algebra must be given"
    );
}

/// L = −c² √(1 − ẋ²/c²) + f x with c = 2 and f = 3.
fn under_constant_force(graph: &Graph) -> System<'_> {
    System::builder(graph)
        .coordinates(["x"])
        .lagrangian(|_, x, v| -4.0 * (1.0 - v[0].square() / 4.0).sqrt() + 3.0 * x[0])
        .build()
        .unwrap()
}

#[test]
fn a_constant_force_drives_a_particle_to_the_velocity_of_light() {
    let graph = Graph::new();
    let mut motion = compiled(&under_constant_force(&graph));
    let times = [0.1, 0.5, 1.0, 2.0, 3.0];
    for (t, y) in times.iter().zip(integrate(&mut motion, &[0.0, 0.0], &times)) {
        let velocity = 3.0 * t / (1.5 * t).hypot(1.0);
        assert!(distance(&y, &[relativistic_fall(2.0, 3.0, *t), velocity]) < ARRIVAL, "t = {t}: {y:?}");
    }
}

#[test]
fn they_are_those_of_the_definition() {
    let so3 = LieAlgebra::so3();
    assert_definition("free top", |graph| free_top(graph).algebra(&so3).build().unwrap(), &[1.0, 0.2, 1.0]);
    assert_definition("constant force", under_constant_force, &[0.0, 0.5]);
}
