//! States that satisfy constraints up to rounding, or nearly, are projected to them in all units.

use pc_mech::{Constraint, Graph, Multipliers, System, VectorField};

use crate::random::numbers;

/// A particle of mass m on a circle of radius r, with a rolling wheel of radius r/3.
fn wheel(graph: &Graph) -> Multipliers<'_> {
    let [m, r, x, y, vx, vy, spin] = graph.symbols(["m", "r", "x", "y", "x'", "y'", "φ'"]);
    let system = System::builder(graph)
        .parameter(m, 1.0)
        .parameter(r, 1.0)
        .coordinates(["x", "y", "φ"])
        .lagrangian(|_, _, v| m * (v[0].square() + v[1].square() + (r / 3.0).square() * v[2].square()) / 2.0)
        .build()
        .unwrap();
    let circle = Constraint::new("circle", x.square() + y.square() - r.square());
    let rolling = Constraint::new("rolling", (x * vy - y * vx) / r - r / 3.0 * spin);
    system.with_multipliers(&[circle, rolling]).unwrap()
}

/// The smallest squares of radii are just above subnormal numbers, the largest just below infinity.
#[test]
fn a_state_on_its_constraints_up_to_rounding_stays_there() {
    let graph = Graph::new();
    let mut motion = wheel(&graph).compile().unwrap();
    let mut next = numbers(11);
    for radius in [1e-150f64, 3e-80, 1e-8, 1.0, 7e8, 1e80, 1e150] {
        // Moments of inertia stay in the range of numbers, too.
        let masses = [1e-100f64, 1e-3, 1.0, 1e100].into_iter();
        for mass in masses.filter(|mass| (mass * radius * radius / 9.0).is_normal()) {
            motion.parameters_mut().copy_from_slice(&[mass, radius]);
            for _ in 0..40 {
                let (angle, rate) = (3.0 * next(), 10f64.powf(6.0 * next()));
                let (sine, cosine) = angle.sin_cos();
                let speed = rate * radius;
                let there =
                    [radius * cosine, radius * sine, angle, -speed * sine, speed * cosine, 3.0 * rate];
                let given = there.map(|y| y * (1.0 + 4.0 * f64::EPSILON * next()));
                let mut state = given;
                motion.project(0.0, &mut state).unwrap();
                let sizes = [radius, radius, 1.0 + rate, speed, speed, 3.0 * rate];
                for i in 0..6 {
                    let moved = (state[i] - given[i]).abs();
                    // Moved by at most its distance from the constraints, some roundings of each component.
                    assert!(
                        moved <= 32.0 * f64::EPSILON * sizes[i],
                        "{radius:e} {mass:e}: {given:?} {state:?}"
                    );
                }
                let mut again = state;
                motion.project(0.0, &mut again).unwrap();
                for i in 0..6 {
                    let moved = (state[i] - again[i]).abs();
                    assert!(
                        moved <= 4.0 * f64::EPSILON * sizes[i],
                        "{radius:e} {mass:e}: {state:?} {again:?}"
                    );
                }
            }
        }
    }
}

/// A state farther away reaches the constraints, to rounding.
#[test]
fn nearby_states_are_projected_to_their_constraints() {
    let graph = Graph::new();
    let mut motion = wheel(&graph).compile().unwrap();
    let mut next = numbers(12);
    for radius in [1e-150, 1e-8, 1.0, 1e150] {
        motion.parameters_mut().copy_from_slice(&[2.0, radius]);
        for _ in 0..40 {
            let angle = 3.0 * next();
            let mut state = [angle.cos() * radius, angle.sin() * radius, 0.0, radius, -radius, 1.0]
                .map(|y| y * (1.0 + 0.3 * next()));
            motion.project(0.0, &mut state).unwrap();
            assert!((state[0].hypot(state[1]) / radius - 1.0).abs() < 1e-14, "{state:?}");
            let radial =
                (state[0] / radius) * (state[3] / radius) + (state[1] / radius) * (state[4] / radius);
            assert!(radial.abs() < 1e-14, "{state:?}");
        }
    }
}
