//! Families of any length: the pendulum of N links and the Toda chain.

use pc_analysis::{SteadyMotion, SteadyOptions};
use pc_mech::{Expr, Graph, System};

use super::definition::assert_definition;
use super::harness::{STATES, compiled, distance, integrate, normals, rates};
use super::judge::assert_builtin;
use pc_tests::classical::{SplitMix64, pendulum_chain};
use pc_tests::reference::reference;

fn names(letter: &str, count: usize) -> Vec<String> {
    (1..=count).map(|i| format!("{letter}{i}")).collect()
}

/// Unit masses on unit links, g = 10, in the angles θ_i from the vertical.
fn pendulum_in_angles(graph: &Graph, links: usize) -> System<'_> {
    let system = System::builder(graph)
        .coordinates(names("q", links))
        .lagrangian(|_, q, rate| {
            let (mut across, mut up, mut height) = (Expr::ZERO, Expr::ZERO, Expr::ZERO);
            let mut lagrangian = Expr::ZERO;
            for i in 0..links {
                across += q[i].cos() * rate[i];
                up += q[i].sin() * rate[i];
                height -= q[i].cos();
                lagrangian += (across.square() + up.square()) / 2.0 - 10.0 * height;
            }
            lagrangian
        })
        .build()
        .unwrap();
    assert_eq!(system.structure().nonzero().count(), 0);
    system
}

/// The same in the Cartesian coordinates x_i, y_i of its particles, with the rates of the links as quasi-velocities.
fn pendulum_in_the_plane(graph: &Graph, links: usize) -> System<'_> {
    let coordinates = (1..=links).flat_map(|i| [format!("x{i}"), format!("y{i}")]);
    let system = System::builder(graph)
        .coordinates(coordinates)
        .quasi_velocities(names("w", links))
        .kinematics(|_, x, rate| plane_velocities(x, rate))
        .lagrangian(|_, x, rate| {
            let kinetic: Expr<'_> = plane_velocities(x, rate).into_iter().map(Expr::square).sum();
            kinetic / 2.0 - 10.0 * x.iter().skip(1).step_by(2).copied().sum::<Expr<'_>>()
        })
        .build()
        .unwrap();
    assert_eq!(system.structure().nonzero().count(), 0);
    system
}

fn plane_velocities<'g>(x: &[Expr<'g>], rate: &[Expr<'g>]) -> Vec<Expr<'g>> {
    let (mut velocities, mut velocity, mut joint) = (Vec::new(), [Expr::ZERO; 2], [Expr::ZERO; 2]);
    for (place, &rate) in x.chunks(2).zip(rate) {
        velocity[0] -= (place[1] - joint[1]) * rate;
        velocity[1] += (place[0] - joint[0]) * rate;
        joint = [place[0], place[1]];
        velocities.extend(velocity);
    }
    velocities
}

fn place(angles: &[f64]) -> Vec<f64> {
    let mut end = [0.0; 2];
    let particles = angles.iter().flat_map(|angle| {
        end = [end[0] + angle.sin(), end[1] - angle.cos()];
        end
    });
    particles.collect()
}

#[test]
fn a_pendulum_of_four_links() {
    let graph = Graph::new();
    let mut motion = compiled(&pendulum_in_angles(&graph, 4));
    assert_builtin("pendulum-chain", &mut motion, &["energy"]);
}

/// L_N(x) = Σ_k binomial(N, k) (−x)^k/k!
fn laguerre(degree: usize, x: f64) -> f64 {
    let (mut sum, mut term) = (1.0, 1.0);
    for k in 1..=degree {
        term *= -x * (degree + 1 - k) as f64 / (k * k) as f64;
        sum += term;
    }
    sum
}

/// Small swings of N links have the frequencies √(g x/l) with the zeros x of L_N [D. Bernoulli 1738].
#[test]
fn small_swings_of_a_chain_have_laguerres_frequencies() {
    for links in [1, 2, 4, 6] {
        let graph = Graph::new();
        let mut motion = compiled(&pendulum_in_angles(&graph, links));
        let rest =
            SteadyMotion::near(&mut motion, 0.0, &vec![0.0; 2 * links], &SteadyOptions::default()).unwrap();
        let mut squares: Vec<f64> = Vec::new();
        for eigenvalue in rest.spectrum.eigenvalues().iter().filter(|eigenvalue| eigenvalue.imaginary > 0.0) {
            assert!(eigenvalue.real.abs() < 1e-12, "{eigenvalue:?}");
            squares.push(eigenvalue.imaginary * eigenvalue.imaginary / 10.0);
        }
        assert_eq!(squares.len(), links);
        squares.sort_by(f64::total_cmp);
        for (i, x) in squares.iter().enumerate() {
            // Each is a zero to some roundings: L_N changes its sign within them.
            let around = [x * (1.0 - 1e-12), x * (1.0 + 1e-12)].map(|x| laguerre(links, x));
            assert!(around[0] * around[1] < 0.0, "zero {i} of L_{links}: {x}, {around:?}");
        }
    }
}

/// The same accelerations at random states, and the same motion, as in the angles.
#[test]
fn a_pendulum_of_three_links_in_redundant_coordinates() {
    let graph = Graph::new();
    let mut angles = compiled(&pendulum_in_angles(&graph, 3));
    let mut plane = compiled(&pendulum_in_the_plane(&graph, 3));
    let in_the_plane = |y: &[f64]| [place(&y[..3]), y[3..].to_vec()].concat();
    let mut random = SplitMix64::new(5);
    for _ in 0..STATES {
        let y = normals::<6>(&mut random);
        let expected = &rates(&mut angles, 0.0, &y)[3..];
        let found = &rates(&mut plane, 0.0, &in_the_plane(&y))[6..];
        assert!(distance(found, expected) < 1e-12, "{y:?}: {found:?}, not {expected:?}");
        let mut classical = [0.0; 6];
        pendulum_chain(&y, &mut classical);
        assert!(distance(expected, &classical[3..]) < 1e-12, "{y:?}");
    }
    let (start, times) = ([0.5, 0.6, 0.7, 0.0, 0.1, -0.2], [0.5, 1.0, 1.5, 2.0]);
    let expected = integrate(&mut angles, &start, &times);
    let found = integrate(&mut plane, &in_the_plane(&start), &times);
    for (found, expected) in found.iter().zip(&expected) {
        assert!(distance(found, &in_the_plane(expected)) < 1e-8, "{found:?}, not {expected:?}");
    }
}

const BODIES: usize = 6;

/// Sums of the first entries: the velocities q̇ of relative velocities η.
fn sums<T: Copy + std::ops::AddAssign>(eta: &[T]) -> Vec<T> {
    let mut sums = eta.to_vec();
    for i in 1..sums.len() {
        let before = sums[i - 1];
        sums[i] += before;
    }
    sums
}

/// tr Λ^power of the tridiagonal matrix with the diagonal −q̇_i/2 beside e^((q_i − q_(i+1))/2)/2.
fn trace_of_lax_power<'g>(q: &[Expr<'g>], eta: &[Expr<'g>], power: usize) -> Expr<'g> {
    let velocity = sums(eta);
    let entry = |i: usize, j: usize| match (i, j) {
        _ if i == j => -velocity[i] / 2.0,
        _ if i + 1 == j || j + 1 == i => ((q[i.min(j)] - q[i.max(j)]) / 2.0).exp() / 2.0,
        _ => Expr::ZERO,
    };
    let mut product: Vec<Vec<Expr<'g>>> =
        (0..BODIES).map(|i| (0..BODIES).map(|j| entry(i, j)).collect()).collect();
    for _ in 1..power {
        let next = |i: usize, j: usize| (0..BODIES).map(|m| product[i][m] * entry(m, j)).sum();
        product = (0..BODIES).map(|i| (0..BODIES).map(|j| next(i, j)).collect()).collect();
    }
    (0..BODIES).map(|i| product[i][i]).sum()
}

/// Toda's open chain in the relative velocities η_1 = q̇_1, η_i = q̇_i − q̇_(i−1).
fn toda(graph: &Graph) -> System<'_> {
    let mut builder = System::builder(graph)
        .coordinates(names("q", BODIES))
        .quasi_velocities(names("w", BODIES))
        .kinematics(|_, _, eta| sums(eta))
        .lagrangian(|_, q, eta| {
            let kinetic: Expr<'_> = sums(eta).into_iter().map(Expr::square).sum();
            kinetic / 2.0 - q.windows(2).map(|pair| (pair[0] - pair[1]).exp()).sum::<Expr<'_>>()
        });
    for (power, name) in (1..=BODIES).zip(traces()) {
        builder = builder.integral(name, |_, q, eta| trace_of_lax_power(q, eta, power));
    }
    builder.build().unwrap()
}

fn traces() -> Vec<String> {
    (1..=BODIES).map(|power| format!("trace {power}")).collect()
}

/// q̈_i = e^(q_(i−1) − q_i) − e^(q_i − q_(i+1))
#[test]
fn an_open_toda_chain() {
    let graph = Graph::new();
    let system = toda(&graph);
    assert_eq!(system.structure().nonzero().count(), 0);
    let mut motion = compiled(&system);

    let traces = traces();
    let mut conserved: Vec<&str> = traces.iter().map(String::as_str).collect();
    conserved.push("energy");
    assert_builtin("toda-chain", &mut motion, &conserved);

    // At t = 80 the forces are below e^(−30): the velocities are the eigenvalues of −2Λ, in rising order.
    let start = reference("toda-chain").unwrap().start;
    let end = integrate(&mut motion, start, &[80.0]).remove(0);
    let velocity = sums(&end[BODIES..]);
    assert!(velocity.is_sorted(), "{velocity:?}");
    let initial = motion.observe(0.0, start);
    for (i, power) in (1..=BODIES as i32).enumerate() {
        let found: f64 = velocity.iter().map(|v| (-v / 2.0).powi(power)).sum();
        assert!((found - initial[i]).abs() < 1e-8, "trace {power}: {found}, not {}", initial[i]);
    }
}

#[test]
fn chains_are_those_of_the_definition() {
    let angles = [0.5, 0.9, 1.4, 2.0, 0.3, -1.0, 0.7, 1.0];
    assert_definition("pendulum of four links", |graph| pendulum_in_angles(graph, 4), &angles);
    let plane = [0.5, -0.9, 1.1, -1.7, 1.8, -2.4, 0.5, -0.3, 0.8];
    assert_definition("three links in the plane", |graph| pendulum_in_the_plane(graph, 3), &plane);
    let bodies = [0.0, 0.5, 1.0, 1.0, 2.0, 2.0, 1.0, -1.0, 0.5, 0.0, -1.0, 0.5];
    assert_definition("Toda's chain", toda, &bodies);
}
