//! Generalised forces (8), and the power they and the changing of the frame give (10).

use pc_mech::{Expr, Folding, Graph, System};
use pc_tests::classical::SplitMix64;
use pc_tests::closed_form::damped_oscillator;

use super::definition::assert_definition;
use super::harness::{Description, STATES, compiled, distance, integrate};
use super::rheonomic::{HOOP, WIRE};
use super::shared::{CHARGE, SCALED_OSCILLATOR, TURNING_CHART};

/// Error of an integration at rtol = 1e-12 over a few oscillations.
const ARRIVAL: f64 = 1e-9;

/// ẋ(t, x, η)
type Velocity = for<'g> fn(Expr<'g>, Expr<'g>, Expr<'g>) -> Expr<'g>;

const PLAIN: Velocity = |_, _, eta| eta;
const MOVING: Velocity = |t, x, eta| (-t / 4.0).exp() * eta + x / 4.0;
const STRETCHED: Velocity = |_, x, eta| (2.0 + x.sin()) * eta;

/// The oscillator ẍ = −4x in the frame ẋ = `velocity`(t, x, η), braked by the force −½ẋ: Q = −½ẋ ∂ẋ/∂η.
fn braked_oscillator(graph: &Graph, velocity: Velocity) -> System<'_> {
    System::builder(graph)
        .coordinates(["x"])
        .quasi_velocities(["eta"])
        .kinematics(|t, x, eta| [velocity(t, x[0], eta[0])])
        .lagrangian(|t, x, eta| velocity(t, x[0], eta[0]).square() / 2.0 - 2.0 * x[0].square())
        .forces(|t, x, eta| {
            let velocity = velocity(t, x[0], eta[0]);
            [-velocity / 2.0 * velocity.derivative(eta[0])]
        })
        .build()
        .unwrap()
}

/// The brake is a force here and growth of the Lagrangian with time in the model `damped-oscillator`: one motion.
#[test]
fn a_braking_force_damps_as_a_growing_lagrangian() {
    let times = [0.5, 1.0, 2.0, 3.0, 4.5, 6.0];
    let run = |velocity: Velocity, eta: f64| {
        let graph = Graph::new();
        integrate(&mut compiled(&braked_oscillator(&graph, velocity)), &[1.0, eta], &times)
    };
    let (plain, moving) = (run(PLAIN, 1.0), run(MOVING, 0.75));
    let stretched = run(STRETCHED, 1.0 / (2.0 + 1.0f64.sin()));
    for (i, &t) in times.iter().enumerate() {
        let [x, velocity] = damped_oscillator(t);
        let expected = [
            (&plain[i], velocity),
            (&moving[i], (velocity - x / 4.0) * (t / 4.0).exp()),
            (&stretched[i], velocity / (2.0 + x.sin())),
        ];
        for (found, eta) in expected {
            assert!(distance(found, &[x, eta]) < ARRIVAL, "t = {t}: {found:?}, not {:?}", [x, eta]);
        }
    }
}

/// A particle of mass 2 in polar coordinates, pushed by F = (2 cos t, 1) in space.
fn pushed_particle(graph: &Graph) -> System<'_> {
    System::builder(graph)
        .coordinates(["rho", "phi"])
        .quasi_velocities(["u", "v"])
        .kinematics(|_, x, eta| [eta[0], eta[1] / x[0]])
        .lagrangian(|_, _, eta| eta[0].square() + eta[1].square())
        .forces(|t, x, _| {
            // Q_s = F · X_s r
            let (push, lift) = (2.0 * t.cos(), Expr::ONE);
            [push * x[1].cos() + lift * x[1].sin(), lift * x[1].cos() - push * x[1].sin()]
        })
        .build()
        .unwrap()
}

/// x = 2 − cos t, y = t + t²/4
#[test]
fn a_force_in_space_axes_pushes_in_polar_coordinates() {
    let graph = Graph::new();
    let mut motion = compiled(&pushed_particle(&graph));
    let times = [0.5, 1.0, 2.0, 4.0, 6.0];
    let states = integrate(&mut motion, &[1.0, 0.0, 0.0, 1.0], &times);
    for (t, state) in times.into_iter().zip(&states) {
        let (sin, cos) = state[1].sin_cos();
        let found = [
            state[0] * cos,
            state[0] * sin,
            state[2] * cos - state[3] * sin,
            state[2] * sin + state[3] * cos,
        ];
        let expected = [2.0 - f64::cos(t), t + t * t / 4.0, f64::sin(t), 1.0 + t / 2.0];
        assert!(distance(&found, &expected) < ARRIVAL, "t = {t}: {found:?}, not {expected:?}");
    }
}

/// Along the motion, with H = y_s η_s − L as a function of (t, x, y), y = ∂L/∂η,
///
///   dH/dt = X_0 H + c_0r^m η_r y_m + Q_s η_s,
///   ẏ_s = (c_rs^m ∂H/∂y_r + c_0s^m) y_m − X_s H + Q_s (10), ẋ = b ∂H/∂y + b_0 (11), and X_0 H = −X_0 L.
///
/// The forces are arbitrary functions, so that their power is seen.
fn assert_canonical<'g>(name: &str, system: &System<'g>) {
    let graph = system.graph();
    let (frame, c, eta) = (system.frame(), system.structure(), system.quasi_velocities());
    let (x, k) = (frame.coordinates(), eta.len());
    let equations = system.poincare().unwrap();
    let momenta = system.momenta();

    // η(y) = M⁻¹(y − p(0)), as p is affine in η.
    let y: Vec<Expr<'_>> = (1..=k).map(|s| graph.symbol(&format!("y{s}"))).collect();
    let at_rest: Vec<_> = eta.iter().map(|&eta| (eta, Expr::ZERO)).collect();
    let excess: Vec<_> = y.iter().zip(graph.substitute(&momenta, &at_rest)).map(|(&y, p)| y - p).collect();
    let inverse = pc_algebra::inverse(graph, equations.mass_matrix()).unwrap();
    let velocities: Vec<_> =
        (0..k).map(|s| (eta[s], graph.dot(inverse.row(s).iter().copied(), excess.iter().copied()))).collect();
    let hamiltonian = graph.substitute(&[system.energy()], &velocities)[0];
    let back: Vec<_> = y.iter().copied().zip(momenta.iter().copied()).collect();
    let at_momenta = |f: &[Expr<'g>]| -> Vec<Expr<'g>> { graph.substitute(f, &back) };

    let along: Vec<_> = x
        .iter()
        .copied()
        .zip(equations.velocities().iter().copied())
        .chain(eta.iter().copied().zip(equations.accelerations()))
        .chain([(frame.time(), Expr::ONE)])
        .collect();

    let explicit = at_momenta(&frame.apply(0, &[hamiltonian]))[0];
    let brackets = graph.sum(
        (1..=k)
            .flat_map(|r| (1..=k).map(move |m| (r, m)))
            .map(|(r, m)| c.get(0, r, m) * eta[r - 1] * momenta[m - 1]),
    );
    let power = graph.dot(system.forces().iter().copied(), eta.iter().copied());
    let mut pairs = vec![
        (graph.directional(&[system.energy()], &along)[0], explicit + brackets + power),
        (explicit, -frame.apply(0, &[system.lagrangian()])[0]),
    ];

    let slope = at_momenta(&graph.gradient(hamiltonian, &y));
    let rates = graph.directional(&momenta, &along);
    for s in 1..=k {
        let gyroscopic = graph.sum((1..=k).map(|m| {
            let coefficient = graph.sum((1..=k).map(|r| c.get(r, s, m) * slope[r - 1])) + c.get(0, s, m);
            coefficient * momenta[m - 1]
        }));
        let potential = at_momenta(&frame.apply(s, &[hamiltonian]))[0];
        pairs.push((rates[s - 1], gyroscopic - potential + system.forces()[s - 1]));
    }
    for i in 0..x.len() {
        let moving = graph.dot(frame.b().row(i).iter().copied(), slope.iter().copied());
        pairs.push((equations.velocities()[i], moving + frame.b0()[i]));
    }

    let outputs: Vec<Expr<'_>> = pairs.into_iter().flat_map(|(left, right)| [left, right]).collect();
    let mut random = SplitMix64::new(13);
    for _ in 0..STATES {
        let mut values = vec![(frame.time(), random.uniform(0.0, 3.0))];
        values.extend(x.iter().map(|&x| (x, random.uniform(0.5, 2.0))));
        values.extend(eta.iter().map(|&eta| (eta, random.normal())));
        let values = graph.evaluate(&outputs, &values).unwrap();
        for (i, sides) in values.chunks(2).enumerate() {
            let error = distance(&sides[..1], &sides[1..]);
            assert!(error < 1e-11, "{name}, identity {i}: {} is not {}", sides[0], sides[1]);
        }
    }
}

#[test]
fn power_and_the_canonical_equations() {
    let oscillator = Description {
        coordinates: &["x"],
        quasi_velocities: &["v"],
        velocities: |_, _, eta| eta.to_vec(),
        lagrangian: |t, x, eta| (t / 2.0).exp() * (eta[0].square() / 2.0 - 2.0 * x[0].square()),
    };
    let described = [
        ("wire", WIRE),
        ("hoop", HOOP),
        ("chart", TURNING_CHART),
        ("charge", CHARGE),
        ("oscillator", oscillator),
        ("scaled oscillator", SCALED_OSCILLATOR),
    ];
    let foldings = [Folding::ByValue, Folding::Structural];
    for ((name, description), folding) in described.into_iter().flat_map(|d| foldings.map(|f| (d, f))) {
        let graph = Graph::with_folding(folding);
        let system = description
            .builder(&graph)
            .forces(|t, x, eta| {
                let k = eta.len();
                (0..k)
                    .map(|s| 0.3 * eta[s] * x[0] - (t + x[x.len() - 1]).sin() + eta[k - 1 - s])
                    .collect::<Vec<_>>()
            })
            .build()
            .unwrap();
        assert_canonical(name, &system);
    }
}

#[test]
fn pushed_and_braked_particles_are_those_of_the_definition() {
    for (name, velocity) in [("plain", PLAIN), ("moving", MOVING), ("stretched", STRETCHED)] {
        let name = format!("braked oscillator, {name} frame");
        assert_definition(&name, |graph| braked_oscillator(graph, velocity), &[1.0, 0.7]);
    }
    assert_definition("pushed particle", pushed_particle, &[1.0, 0.0, 0.0, 1.0]);
}
