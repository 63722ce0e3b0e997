//! Routh's reduction by cyclic coordinates.

use pc_analysis::Routhian;
use pc_mech::{Expr, Graph, System, VectorField};

/// Lagrange's top in Euler's angles ψ (precession), θ, φ (spin).
fn top(graph: &Graph) -> System<'_> {
    let [a, c, mgl] = graph.symbols(["A", "C", "mgl"]);
    System::builder(graph)
        .parameter(a, 2.0)
        .parameter(c, 0.7)
        .parameter(mgl, 1.3)
        .coordinates(["ψ", "θ", "φ"])
        .lagrangian(|_, x, v| {
            let (sin, cos) = (x[1].sin(), x[1].cos());
            let spin = v[2] + v[0] * cos;
            (a * (v[1].square() + (v[0] * sin).square()) + c * spin.square()) / 2.0 - mgl * cos
        })
        .build()
        .unwrap()
}

/// R = ½ A θ̇² − (p_ψ − p_φ cos θ)²/(2 A sin² θ) − p_φ²/(2 C) − mgl cos θ
#[test]
fn the_routhian_of_a_heavy_top_describes_its_nutation() {
    let graph = Graph::new();
    let system = top(&graph);
    let names = ["t", "ψ", "θ", "φ", "ψ'", "θ'", "φ'"];
    let start = [0.0, 0.1, 0.8, 0.3, 0.4, -0.2, 5.0];
    let at: Vec<(Expr<'_>, f64)> = names.iter().map(|name| graph.symbol(name)).zip(start).collect();
    let routh = Routhian::of(&system, &at).unwrap().unwrap();
    let [a, c, mgl, th, v, p_psi, p_phi] = graph.symbols(["A", "C", "mgl", "θ", "θ'", "p_ψ", "p_φ"]);
    let expected = a * v.square() / 2.0
        - (p_psi - p_phi * th.cos()).square() / (2.0 * a * th.sin().square())
        - p_phi.square() / (2.0 * c)
        - mgl * th.cos();
    assert_eq!(routh.routhian, expected);
    assert_eq!(routh.cyclic, graph.symbols(["ψ", "φ"]));
    assert_eq!(routh.momenta, [p_psi, p_phi]);

    // The motion of θ is that of the full top, and so are the rates of the other angles.
    let mut whole = system.poincare().unwrap().compile().unwrap();
    let mut rates = [0.0; 6];
    whole.rhs(0.0, &start[1..], &mut rates).unwrap();
    let mut nutation = routh.system.unwrap().poincare().unwrap().compile().unwrap();
    let mut reduced = [0.0; 2];
    nutation.rhs(0.0, &[start[2], start[5]], &mut reduced).unwrap();
    // Some dozens of roundings of numbers of order ten.
    assert!((reduced[1] - rates[4]).abs() < 1e-13, "{} against {}", reduced[1], rates[4]);
    let values: Vec<(Expr<'_>, f64)> =
        [("A", 2.0), ("C", 0.7), ("mgl", 1.3), ("θ", start[2]), ("θ'", start[5])]
            .map(|(name, value)| (graph.symbol(name), value))
            .into_iter()
            .chain(
                routh.momenta.iter().copied().zip(
                    graph
                        .evaluate(&routh.momenta_of_velocities, &[at, system.parameters().to_vec()].concat())
                        .unwrap(),
                ),
            )
            .collect();
    let velocities = graph.evaluate(&routh.rates, &values).unwrap();
    assert!((velocities[0] - start[4]).abs() < 1e-13 && (velocities[1] - start[6]).abs() < 1e-13);
}

/// A force along a coordinate, or one that depends on it, changes its momentum.
#[test]
fn a_coordinate_with_a_force_is_not_cyclic() {
    let graph = Graph::new();
    let build = |on_s: bool| {
        System::builder(&graph)
            .coordinates(["s", "φ"])
            .lagrangian(|_, x, v| v[0].square() + v[1].square() / 2.0 + v[0] * v[1] * x[1].cos() + x[1].cos())
            .forces(|_, x, v| if on_s { [-v[0], Expr::ZERO] } else { [Expr::ZERO, -x[0] * v[1]] })
            .build()
            .unwrap()
    };
    let at: Vec<_> = ["t", "s", "φ", "s'", "φ'"].map(|name| (graph.symbol(name), 0.5)).into();
    assert!(Routhian::of(&build(true), &at).unwrap().is_none());
    assert!(Routhian::of(&build(false), &at).unwrap().is_none());
}

/// A force on the other coordinate may contain the rate of the cyclic one, which is substituted.
#[test]
fn forces_on_other_coordinates_are_kept() {
    let graph = Graph::new();
    let system = System::builder(&graph)
        .coordinates(["r", "φ"])
        .lagrangian(|_, x, v| (v[0].square() + (x[0] * v[1]).square()) / 2.0)
        .forces(|_, _, v| [-v[0] - v[1], Expr::ZERO])
        .build()
        .unwrap();
    let at: Vec<_> = [("t", 0.0), ("r", 2.0), ("φ", 0.0), ("r'", 0.3), ("φ'", 0.5)]
        .map(|(name, value)| (graph.symbol(name), value))
        .into();
    let routh = Routhian::of(&system, &at).unwrap().unwrap();
    let [r, v, p] = graph.symbols(["r", "r'", "p_φ"]);
    assert_eq!(routh.system.unwrap().forces(), [-v - p / r.square()]);
}

#[test]
fn a_free_particle_has_only_cyclic_coordinates() {
    let graph = Graph::new();
    let particle = System::builder(&graph)
        .coordinates(["x", "y"])
        .lagrangian(|_, _, v| (v[0].square() + v[1].square()) / 2.0 + v[0] * v[1] / 4.0)
        .build()
        .unwrap();
    let at: Vec<_> = ["t", "x", "y", "x'", "y'"].map(|name| (graph.symbol(name), 0.5)).into();
    let routh = Routhian::of(&particle, &at).unwrap().unwrap();
    assert!(routh.system.is_none() && routh.cyclic.len() == 2);
}
