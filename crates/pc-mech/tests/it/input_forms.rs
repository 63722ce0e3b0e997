//! The forms in which energy and forces can be given are equivalent.

use crate::common;
use pc_analysis::Rates;
use pc_mech::{Expr, Frame, Graph, Matrix, MatrixError, MechError, Particle, System, SystemBuilder};

/// The spherical pendulum with the velocities ẋ and ẏ.
fn spherical(graph: &Graph) -> SystemBuilder<'_> {
    System::builder(graph)
        .coordinates(["x", "y", "z"])
        .quasi_velocities(["u", "v"])
        .kinematics(|_, x, eta| [eta[0], eta[1], -(x[0] * eta[0] + x[1] * eta[1]) / x[2]])
}

#[test]
fn the_lagrangian_in_velocities_is_that_in_quasi_velocities() {
    let graph = Graph::new();
    let by_eta = spherical(&graph)
        .lagrangian(|_, x, eta| {
            let z_rate = -(x[0] * eta[0] + x[1] * eta[1]) / x[2];
            (eta[0].square() + eta[1].square() + z_rate.square()) / 2.0 - 10.0 * x[2]
        })
        .build()
        .unwrap();
    let by_velocities = spherical(&graph)
        .lagrangian_in_velocities(|_, x, v| {
            v.iter().map(|v| v.square() / 2.0).sum::<Expr<'_>>() - 10.0 * x[2]
        })
        .build()
        .unwrap();
    let by_energies = spherical(&graph)
        .potential(|_, x, _| 10.0 * x[2])
        .kinetic(|_, x, eta| {
            (eta[0].square() + eta[1].square() + ((x[0] * eta[0] + x[1] * eta[1]) / x[2]).square()) / 2.0
        })
        .build()
        .unwrap();
    let by_body = spherical(&graph)
        .particle(|_, x, _| Particle::new(1, x.to_vec()).force([0, 0, -10]))
        .build()
        .unwrap();
    let right = |system: System<'_>| format!("{:?}", system.poincare().unwrap().right_hand_side());
    let expected = right(by_eta.clone());
    for other in [by_velocities, by_energies] {
        assert_eq!(other.lagrangian(), by_eta.lagrangian());
        assert_eq!(right(other), expected);
    }
    assert_eq!(by_body.poincare().unwrap().right_hand_side(), by_eta.poincare().unwrap().right_hand_side());
}

fn l<'g>(t: Expr<'g>, x: &[Expr<'g>], v: &[Expr<'g>]) -> Expr<'g> {
    let kinetic = (v[0].square() + t.sin() * v[0] * v[1] + 3.0 * v[1].square()) / 2.0;
    kinetic + t * x[1] * v[0] - x[0].square() * x[1]
}

/// With b and b_0 that depend on time, and the frame given last.
#[test]
fn the_frame_may_come_after_the_energy() {
    let graph = Graph::new();
    let [t, x, y, u, v] = graph.symbols(["t", "x", "y", "u", "v"]);
    let velocities = [u * (1.0 + t.square()) + t * y, v * x - t * u + x.square()];
    let named = || System::builder(&graph).coordinates(["x", "y"]).quasi_velocities(["u", "v"]);
    let frame = Frame::from_velocities(&graph, t, vec![x, y], &[u, v], &velocities).unwrap();
    let after = named().lagrangian_in_velocities(l).frame(frame).build().unwrap();
    let before = common::driven(&graph).lagrangian_in_velocities(l).build().unwrap();
    assert_eq!(after.lagrangian(), l(t, &[x, y], &velocities));
    assert_eq!(before.lagrangian(), after.lagrangian());
}

/// Quasi-velocities may have the names of velocities, even of another coordinate.
#[test]
fn names_of_velocities_are_kept_apart() {
    let graph = Graph::new();
    let [x_rate, y_rate] = graph.symbols(["x'", "y'"]);
    let crossed = System::builder(&graph)
        .coordinates(["x", "y"])
        .quasi_velocities(["x'", "y'"])
        .kinematics(|_, _, eta| [eta[1], 2.0 * eta[0]])
        .lagrangian_in_velocities(|_, _, v| v[0].square() + 3.0 * v[1].square())
        .particle(|_, x, eta| Particle::new(0, [x[1] / 2.0]).force([-eta[0]]))
        .build()
        .unwrap();
    assert_eq!(crossed.lagrangian(), y_rate.square() + 12.0 * x_rate.square());
    assert_eq!(crossed.forces(), [-x_rate, 0.into()]);
}

#[test]
fn parts_add_up() {
    let graph = Graph::new();
    let [x, v] = graph.symbols(["x", "x'"]);
    let system = System::builder(&graph)
        .coordinates(["x"])
        .forces(|_, x, _| [-x[0]])
        .lagrangian(|_, _, v| v[0].square())
        .potential(|_, x, _| x[0].square())
        .lagrangian_in_velocities(|t, _, v| t * v[0])
        .kinetic(|_, _, v| v[0].square())
        .particle(|_, x, _| Particle::new(2, [x[0]]).force([3]))
        .forces(|t, _, _| [t])
        .force_on_coordinates(|_, x, _| [x[0].square()])
        .dissipation(|_, _, v| v[0].powi(4))
        .build()
        .unwrap();
    let t = graph.symbol("t");
    assert_eq!(system.lagrangian(), 3.0 * v.square() - x.square() + 3.0 * x + t * v);
    assert_eq!(system.forces(), [-x + t + x.square() - 4.0 * v.powi(3)]);
}

/// dE/dt = −2R for R quadratic in η.
#[test]
fn dissipation_takes_twice_its_function() {
    let graph = Graph::new();
    let [d1, d2, d3] = graph.symbols(["d1", "d2", "d3"]);
    let [g2, w1, w2, w3] = graph.symbols(["γ2", "ω1", "ω2", "ω3"]);
    let r = (d1 * w1.square() + d2 * (w1 - g2 * w2).square() + d3 * w3.square()) / 2.0;
    let system = common::top_of_parameters(&graph).dissipation(|_, _, _| r).build().unwrap();
    assert_eq!(system.energy_rate(), -2.0 * r);
    assert_eq!(Rates::poincare(&system.poincare().unwrap()).of(system.energy()).unwrap(), -2.0 * r);
}

fn skew<'g>(t: Expr<'g>, x: &[Expr<'g>], _: &[Expr<'g>]) -> Matrix<Expr<'g>> {
    let [a, b, c] = [t * x[0], x[1] + 1.0, x[2].sin()];
    Matrix::from_fn(3, 3, |i, j| [[Expr::ZERO, a, -b], [-a, Expr::ZERO, c], [b, -c, Expr::ZERO]][i][j])
}

#[test]
fn gyroscopic_forces_do_no_work() {
    let graph = Graph::new();
    let system = common::top_of_parameters(&graph).gyroscopic(skew).build().unwrap();
    let [t, g1, g2, w2, w3] = graph.symbols(["t", "γ1", "γ2", "ω2", "ω3"]);
    assert_eq!(system.forces()[0], t * g1 * w2 - (g2 + 1.0) * w3);
    assert!(!system.forces()[1].is_zero() && system.energy_rate().is_zero());
    assert!(Rates::poincare(&system.poincare().unwrap()).verdict(system.energy()).unwrap().is_conserved());

    // A charge in a uniform field: η̇_1 = B η_2.
    let charge = System::builder(&graph)
        .coordinates(["x", "y"])
        .kinetic(|_, _, v| (v[0].square() + v[1].square()) / 2.0)
        .gyroscopic(|_, _, _| {
            let b = graph.symbol("B");
            Matrix::from_fn(2, 2, |i, j| if i == j { Expr::ZERO } else { (j as f64 - i as f64) * b })
        })
        .build()
        .unwrap();
    let [b, x_rate, y_rate] = graph.symbols(["B", "x'", "y'"]);
    assert_eq!(charge.poincare().unwrap().right_hand_side(), [b * y_rate, -b * x_rate]);

    let refused = |entry: (usize, usize)| {
        let matrix = Matrix::from_fn(3, 3, |i, j| if (i, j) == entry { g1 } else { Expr::ZERO });
        common::top_of_parameters(&graph).gyroscopic(|_, _, _| matrix).build().unwrap_err()
    };
    assert_eq!(
        refused((2, 0)),
        MechError::Matrix(MatrixError::NotSkew {
            what: "the matrix of gyroscopic forces",
            pair: ["ω1".into(), "ω3".into()]
        })
    );
    assert_eq!(
        refused((1, 1)).to_string(),
        "the matrix of gyroscopic forces must be antisymmetric, but its entries for `ω2` and `ω2` do not add up to zero"
    );
}

/// Q_s η_s = F_i (ẋ_i − b_i0).
#[test]
fn forces_on_coordinates_keep_their_power() {
    let graph = Graph::new();
    let system = common::driven(&graph)
        .kinetic(|_, _, eta| eta[0].square() + eta[1].square())
        .force_on_coordinates(|t, x, eta| [t * x[1] - eta[0], x[0].sin()])
        .build()
        .unwrap();
    let eta = system.quasi_velocities();
    let [t, x, y] = graph.symbols(["t", "x", "y"]);
    let moved = system.frame().velocities(eta);
    let drift = system.frame().b0();
    let expected = (t * y - eta[0]) * (moved[0] - drift[0]) + x.sin() * (moved[1] - drift[1]);
    assert_eq!(system.forces()[0] * eta[0] + system.forces()[1] * eta[1], expected);
}

#[test]
fn wrong_lengths_are_refused() {
    let graph = Graph::new();
    let builder = || spherical(&graph).kinetic(|_, _, eta| eta[0].square() + eta[1].square());
    let refused = |builder: SystemBuilder<'_>| builder.build().unwrap_err().to_string();
    assert_eq!(
        refused(builder().forces(|_, x, _| x.to_vec())),
        "the list of forces has 3 entries where 2 are needed"
    );
    assert_eq!(
        refused(builder().force_on_coordinates(|_, _, eta| eta.to_vec())),
        "the list of forces on coordinates has 2 entries where 3 are needed"
    );
    assert_eq!(
        refused(builder().gyroscopic(|_, _, _| Matrix::from_fn(2, 3, |_, _| Expr::ZERO))),
        "the list of columns of the gyroscopic matrix has 3 entries where 2 are needed"
    );
}
