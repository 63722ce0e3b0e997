//! A car with n trailers: steady circles, and Lagrange's equations with multipliers in the plane.

use pc_mech::{Constraint, Expr, Graph, System, VectorField};
use pc_nonholo::{NTrailer, Wagon};

const MASSES: [f64; 4] = [3.0, 1.0, 0.7, 1.2];
const INERTIAS: [f64; 4] = [1.5, 0.4, 0.3, 0.5];
const LENGTHS: [f64; 3] = [1.1, 0.8, 0.9];

fn train(graph: &Graph, trailers: usize, ahead: [f64; 4]) -> NTrailer<'_> {
    let wagon =
        |i: usize| Wagon { mass: MASSES[i].into(), inertia: INERTIAS[i].into(), ahead: ahead[i].into() };
    (0..trailers)
        .fold(NTrailer::new(graph, wagon(0)), |train, i| train.trailer(LENGTHS[i].into(), wagon(i + 1)))
}

/// Rates of coordinates and of v, ω at x, y, θ0.. and v, ω.
fn rates(graph: &Graph, train: &NTrailer<'_>, headings: &[f64], v: f64, w: f64) -> Vec<f64> {
    let train = train.constrained().unwrap();
    let equations = train.equations();
    let x = train.system().frame().coordinates();
    let values = [0.4, -0.2].iter().chain(headings);
    let mut at: Vec<_> = x.iter().copied().zip(values.copied()).collect();
    at.extend(graph.symbols(["v", "ω"]).into_iter().zip([v, w]));
    let rates = [equations.velocities().to_vec(), equations.accelerations()].concat();
    graph.evaluate(&rates, &at).unwrap()
}

/// With the mass centres on the axles, which circle one centre, only the wheels exert forces: R_i² = R_{i−1}²
/// − ℓ_i², and all turn at the same rate.
#[test]
fn circles_are_steady() {
    let (v, w) = (1.5, 0.6);
    let mut radius: f64 = v / w;
    let mut headings = vec![0.3];
    for length in LENGTHS {
        let angle = (length / radius).asin();
        headings.push(headings.last().unwrap() - angle);
        radius = (radius * radius - length * length).sqrt();
    }
    let graph = Graph::new();
    let rates = rates(&graph, &train(&graph, 3, [0.0; 4]), &headings, v, w);
    for turning in &rates[2..6] {
        assert!((turning - w).abs() < 1e-15, "{turning}"); // a few roundings
    }
    assert!(rates[6].abs() < 1e-14 && rates[7].abs() < 1e-14, "{:?}", &rates[6..]);
}

/// The bodies by the places of their mass centres, the wheels by the velocities of their axles, written out
/// in x, y, θ.
fn in_the_plane<'g>(graph: &'g Graph, ahead: [f64; 4]) -> (System<'g>, Vec<Constraint<'g>>) {
    /// The velocity of axle i.
    fn axle<'g>(i: usize, x: &[Expr<'g>], v: &[Expr<'g>]) -> [Expr<'g>; 2] {
        let mut place = [v[0], v[1]];
        for j in 1..=i {
            let swing = LENGTHS[j - 1] * v[j + 2];
            place = [place[0] + swing * x[j + 2].sin(), place[1] - swing * x[j + 2].cos()];
        }
        place
    }
    let system = System::builder(graph)
        .coordinates(["x", "y", "θ0", "θ1", "θ2", "θ3"])
        .lagrangian(|_, x, v| {
            graph.sum((0..4).map(|i| {
                let (along, swing) = (axle(i, x, v), ahead[i] * v[i + 2]);
                let centre = [along[0] - swing * x[i + 2].sin(), along[1] + swing * x[i + 2].cos()];
                let speed = centre[0].square() + centre[1].square();
                (MASSES[i] * speed + INERTIAS[i] * v[i + 2].square()) / 2.0
            }))
        })
        .build()
        .unwrap();
    let (x, v) = (system.frame().coordinates().to_vec(), system.quasi_velocities().to_vec());
    let wheels = (0..4).map(|i| {
        let along = axle(i, &x, &v);
        Constraint::new(format!("wheels {i}"), along[1] * x[i + 2].cos() - along[0] * x[i + 2].sin())
    });
    (system.clone(), wheels.collect())
}

#[test]
fn three_trailers_obey_lagrange_with_multipliers() {
    let ahead = [0.4, -0.1, 0.2, 0.05];
    let headings = [0.3, -0.2, 0.5, 0.1];
    let (v, w) = (1.3, -0.7);
    let graph = Graph::new();
    let found = rates(&graph, &train(&graph, 3, ahead), &headings, v, w);

    let (system, wheels) = in_the_plane(&graph, ahead);
    let multipliers = system.with_multipliers(&wheels).unwrap();
    let mut motion = multipliers.compile().unwrap();
    let state = [&[0.4, -0.2], &headings[..], &found[..6]].concat();
    let mut expected = vec![0.0; 12];
    motion.rhs(0.0, &state, &mut expected).unwrap();
    // v = ẋ cos θ0 + ẏ sin θ0, whose rate has no other terms as the car does not slip; ω = θ̇0.
    let (s, c) = headings[0].sin_cos();
    let speed = expected[6] * c + expected[7] * s;
    assert!((found[6] - speed).abs() < 1e-12, "{} and {speed}", found[6]); // some thousand roundings of numbers below 5
    assert!((found[7] - expected[8]).abs() < 1e-12, "{} and {}", found[7], expected[8]);
}

#[test]
fn the_number_of_trailers_is_free() {
    for trailers in 0..=3 {
        let graph = Graph::new();
        let constrained = train(&graph, trailers, [0.1; 4]).constrained().unwrap();
        assert_eq!(constrained.system().quasi_velocities().len(), trailers + 3);
        assert_eq!(constrained.vanishing().len(), trailers + 1);
        assert_eq!(constrained.reactions().len(), trailers + 1);
    }
}
