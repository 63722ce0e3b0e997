//! Dirac's bracket under constraints on the positions.

use pc_analysis::{PoissonBracket, Rates};
use pc_mech::{Expr, Graph, System};

/// A point of mass m under gravity.
fn point(graph: &Graph) -> System<'_> {
    let [m, g] = graph.symbols(["m", "g"]);
    System::builder(graph)
        .parameter(m, 2.0)
        .parameter(g, 9.81)
        .coordinates(["x", "y", "z"])
        .lagrangian(|_, x, v| m * (v[0].square() + v[1].square() + v[2].square()) / 2.0 - m * g * x[2])
        .build()
        .unwrap()
}

/// (x_i, p_j)_D = δ_ij − x_i x_j/|x|², (p_i, p_j)_D = (x_j p_i − x_i p_j)/|x|² on a sphere.
#[test]
fn the_bracket_on_a_sphere() {
    let graph = Graph::new();
    let point = point(&graph);
    let bracket = PoissonBracket::new(&point);
    let h = point.canonical().unwrap().hamiltonian();
    let (x, p) = (graph.symbols(["x", "y", "z"]), graph.symbols(["p_x", "p_y", "p_z"]));
    let square = x[0].square() + x[1].square() + x[2].square();
    let constraints = bracket.with_rates(&[square - 1.0], h).unwrap();
    let dirac = bracket.dirac(&constraints).unwrap();
    for i in 0..3 {
        for j in 0..3 {
            let delta = if i == j { Expr::ONE } else { Expr::ZERO };
            assert!(dirac.of(x[i], x[j]).unwrap().is_zero());
            assert_eq!(dirac.of(x[i], p[j]).unwrap(), delta - x[i] * x[j] / square);
            assert_eq!(dirac.of(p[i], p[j]).unwrap(), (x[j] * p[i] - x[i] * p[j]) / square);
        }
    }
    assert!(constraints.iter().all(|&phi| dirac.is_casimir(phi).unwrap()));
    assert!(dirac.jacobi_violation().is_none());
    assert_eq!((dirac.rank(), dirac.corank()), (4, 2));
    // The angular momentum about the vertical is kept, that about the other axes generates rotations.
    let k = [x[1] * p[2] - x[2] * p[1], x[2] * p[0] - x[0] * p[2], x[0] * p[1] - x[1] * p[0]];
    assert!(dirac.of(k[2], h).unwrap().is_zero());
    assert_eq!(dirac.of(k[0], k[1]).unwrap(), k[2]);
}

/// ẍ = −g e_z + λ x/m with λ = m g z − m |v|² where |x| = 1 and x · v = 0: at θ, φ, with any θ', φ'.
#[test]
fn its_motion_is_that_with_multipliers() {
    let graph = Graph::new();
    let point = point(&graph);
    let bracket = PoissonBracket::new(&point);
    let h = point.canonical().unwrap().hamiltonian();
    let (x, p) = (graph.symbols(["x", "y", "z"]), graph.symbols(["p_x", "p_y", "p_z"]));
    let [m, g, theta, phi, u, v] = graph.symbols(["m", "g", "θ", "φ", "u", "v"]);
    let sphere = x[0].square() + x[1].square() + x[2].square() - 1.0;
    let dirac = bracket.dirac(&bracket.with_rates(&[sphere], h).unwrap()).unwrap();
    let place = [theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos()];
    let speed = graph.directional(&place, &[(theta, u), (phi, v)]);
    let there: Vec<_> =
        x.into_iter().zip(place).chain(p.into_iter().zip(speed.iter().map(|&v| m * v))).collect();
    let field = graph.substitute(&dirac.field(h).unwrap(), &there);
    let reaction = m * g * place[2] - m * (speed[0].square() + speed[1].square() + speed[2].square());
    for i in 0..3 {
        let weight = if i == 2 { -m * g } else { Expr::ZERO };
        assert!((field[i] - speed[i]).is_zero());
        assert!((field[3 + i] - weight - reaction * place[i]).is_zero());
    }
}

/// A double pendulum of two rods: four constraints on eight variables.
#[test]
fn two_rods() {
    let graph = Graph::new();
    let pendulum = System::builder(&graph)
        .coordinates(["x1", "y1", "x2", "y2"])
        .lagrangian(|_, x, v| {
            let kinetic = v[0].square() + v[1].square() + 2.0 * (v[2].square() + v[3].square());
            kinetic / 2.0 - x[1] - 2.0 * x[3]
        })
        .build()
        .unwrap();
    let [x1, y1, x2, y2] = graph.symbols(["x1", "y1", "x2", "y2"]);
    let rods = [x1.square() + y1.square() - 1.0, (x2 - x1).square() + (y2 - y1).square() - 1.0];
    let canonical = pendulum.canonical().unwrap();
    let bracket = PoissonBracket::new(&pendulum);
    let constraints = bracket.with_rates(&rods, canonical.hamiltonian()).unwrap();
    let dirac = bracket.dirac(&constraints).unwrap();
    assert!(constraints.iter().all(|&phi| dirac.is_casimir(phi).unwrap()));
    assert!(dirac.jacobi_violation().is_none());
    assert_eq!(dirac.rank(), 4);
    // Energy is kept, and the rates of the positions are those of the canonical equations where the constraints hold.
    let h = canonical.hamiltonian();
    assert!(dirac.of(h, h).unwrap().is_zero());
    assert!(!Rates::canonical(&canonical).of(rods[0]).unwrap().is_zero());
}

#[test]
fn constraints_of_the_first_class_are_refused() {
    let graph = Graph::new();
    let bracket = PoissonBracket::new(&point(&graph));
    let [x, y] = graph.symbols(["x", "y"]);
    let error = bracket.dirac(&[x - y, x + y]).unwrap_err();
    assert_eq!(
        error.to_string(),
        "the brackets of `x - y`, `x + y` with each other form a singular matrix, so that there is no bracket of Dirac"
    );
}
