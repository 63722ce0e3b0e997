//! The integrals of integrable systems are the same for all values of their parameters, π and √2 among them.
//!
//! The comparison is exact, without tolerances: the integrals are functions of the parameters by name, and each is
//! proved.

use std::f64::consts::{PI, SQRT_2};

use pc_analysis::{ConservationVerdict, Integrals, PolynomialAnsatz};
use pc_mech::{Expr, Graph, LieAlgebra, Neighbourhood, System, SystemBuilder};

/// The number of sets of values.
const TRIALS: u64 = 20;

/// π/3, √2 and their products with numbers between 1/2 and 2 that have no short decimals.
fn value(trial: u64, parameter: u64) -> f64 {
    let bits = (2 * trial + parameter + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 11;
    let random = 0.5 + 1.5 * bits as f64 / (1u64 << 53) as f64;
    match (trial, parameter) {
        (0, 0) => PI / 3.0,
        (0, _) => SQRT_2 * random,
        (1, 0) => SQRT_2,
        _ => random,
    }
}

/// The integrals proved for all values of the parameters, for each of which `expected` is the list.
fn assert_integrals(
    parameters: &[&str],
    build: impl for<'g> Fn(SystemBuilder<'g>, &[Expr<'g>]) -> System<'g>,
    degree: u32,
    functions: impl for<'g> Fn(&System<'g>) -> Vec<Expr<'g>>,
    expected: &[&str],
) {
    for trial in 0..TRIALS {
        let graph = Graph::new();
        let symbols: Vec<Expr<'_>> = parameters.iter().map(|name| graph.symbol(name)).collect();
        let mut builder = System::builder(&graph);
        for (i, &symbol) in (0..).zip(&symbols) {
            builder = builder.parameter(symbol, value(trial, i));
        }
        let system = build(builder, &symbols);
        let equations = system.poincare().unwrap();
        let state = system.state().into_iter().enumerate().map(|(i, z)| (z, 0.3 + 0.2 * i as f64));
        let centre = state.chain(system.parameters().iter().copied()).chain([(graph.symbol("t"), 0.0)]);
        let near = Neighbourhood { centre: centre.collect() };
        let mut found = Integrals::find(&equations, &near);
        let ansatz =
            PolynomialAnsatz { functions: functions(&system), ..PolynomialAnsatz::of_degree(degree) };
        found.add_polynomials(&equations, &near, &ansatz).unwrap();
        let proved =
            found.list().iter().filter(|integral| integral.verdict == ConservationVerdict::Conserved);
        let proved: Vec<String> = proved.map(|integral| integral.value.to_string()).collect();
        assert_eq!(proved, expected, "trial {trial}");
        assert_eq!(proved.len(), found.list().len(), "trial {trial}");
    }
}

fn none<'g>(_: &System<'g>) -> Vec<Expr<'g>> {
    Vec::new()
}

fn over_radius<'g>(system: &System<'g>) -> Vec<Expr<'g>> {
    let x = system.frame().coordinates();
    vec![1.0 / (x[0].square() + x[1].square()).sqrt()]
}

/// A particle of mass 1 in the plane with this potential.
fn plane<'g>(builder: SystemBuilder<'g>, potential: impl Fn(Expr<'g>, Expr<'g>) -> Expr<'g>) -> System<'g> {
    builder
        .coordinates(["x", "y"])
        .lagrangian(|_, x, v| (v[0].square() + v[1].square()) / 2.0 - potential(x[0], x[1]))
        .build()
        .unwrap()
}

type Symbols<'a, 'g> = &'a [Expr<'g>];

#[test]
fn oscillator() {
    fn build<'g>(builder: SystemBuilder<'g>, p: Symbols<'_, 'g>) -> System<'g> {
        plane(builder, |x, y| p[0].square() * (x.square() + y.square()) / 2.0)
    }
    assert_integrals(
        &["w"],
        build,
        2,
        none,
        &[
            "1/2*(w^2*(x^2 + y^2) + x'^2 + y'^2)",
            "y*x' - x*y'",
            "w^2*x^2 + x'^2",
            "w^2*x*y + x'*y'",
            "w^2*y^2 + y'^2",
        ],
    );
}

#[test]
fn oscillator_of_frequencies_one_to_two() {
    fn build<'g>(builder: SystemBuilder<'g>, p: Symbols<'_, 'g>) -> System<'g> {
        plane(builder, |x, y| p[0].square() * (x.square() + 4.0 * y.square()) / 2.0)
    }
    fn functions<'g>(system: &System<'g>) -> Vec<Expr<'g>> {
        system.frame().coordinates()[..1].to_vec()
    }
    assert_integrals(
        &["w"],
        build,
        2,
        functions,
        &[
            "1/2*(w^2*(x^2 + 4*y^2) + x'^2 + y'^2)",
            "w^2*x^2 + x'^2",
            "w^2*x^2*y + x*x'*y' - y*x'^2",
            "4*w^2*y^2 + y'^2",
        ],
    );
}

#[test]
fn kepler() {
    fn build<'g>(builder: SystemBuilder<'g>, p: Symbols<'_, 'g>) -> System<'g> {
        plane(builder, |x, y| -p[0] / (x.square() + y.square()).sqrt())
    }
    assert_integrals(
        &["k"],
        build,
        2,
        over_radius,
        &[
            "1/2*x'^2 - k/sqrt(x^2 + y^2) + 1/2*y'^2",
            "y*x' - x*y'",
            "k*y/sqrt(x^2 + y^2) + x*x'*y' - y*x'^2",
            "k*x/sqrt(x^2 + y^2) - x*y'^2 + y*x'*y'",
        ],
    );
}

/// Kepler's problem in a homogeneous field.
#[test]
fn stark() {
    fn build<'g>(builder: SystemBuilder<'g>, p: Symbols<'_, 'g>) -> System<'g> {
        plane(builder, |x, y| -p[0] / (x.square() + y.square()).sqrt() - p[1] * x)
    }
    assert_integrals(
        &["k", "f"],
        build,
        2,
        over_radius,
        &[
            "1/2*x'^2 - k/sqrt(x^2 + y^2) - f*x + 1/2*y'^2",
            "f*y^2 - 2*k*x/sqrt(x^2 + y^2) + 2*x*y'^2 - 2*y*x'*y'",
        ],
    );
}

#[test]
fn central_force() {
    fn build<'g>(builder: SystemBuilder<'g>, p: Symbols<'_, 'g>) -> System<'g> {
        plane(builder, |x, y| {
            let square = x.square() + y.square();
            p[0] * square + p[1] * square.square()
        })
    }
    assert_integrals(
        &["a", "b"],
        build,
        2,
        none,
        &["a*(x^2 + y^2) + b*(x^2 + y^2)^2 + 1/2*x'^2 + 1/2*y'^2", "y*x' - x*y'"],
    );
}

/// Hénon and Heiles' potential with the cubic terms x² y + 2 y³.
#[test]
fn henon_heiles() {
    fn build<'g>(builder: SystemBuilder<'g>, p: Symbols<'_, 'g>) -> System<'g> {
        plane(builder, |x, y| {
            (p[0] * x.square() + p[1] * y.square()) / 2.0 + x.square() * y + 2.0 * y.powi(3)
        })
    }
    fn functions<'g>(system: &System<'g>) -> Vec<Expr<'g>> {
        let x = system.frame().coordinates();
        vec![x[0].square()]
    }
    assert_integrals(
        &["a", "b"],
        build,
        2,
        functions,
        &[
            "1/2*a*x^2 + 1/2*b*y^2 + x^2*y + 2*y^3 + 1/2*x'^2 + 1/2*y'^2",
            "x^2*(a*b - 4*a^2) - 4*a*x^2*y - x^4 - 4*x^2*y^2 - 4*x*x'*y' + x'^2*(b - 4*a + 4*y)",
        ],
    );
}

/// Two particles that repel each other with the potential g/(x − y)² in an oscillator.
#[test]
fn calogero() {
    fn build<'g>(builder: SystemBuilder<'g>, p: Symbols<'_, 'g>) -> System<'g> {
        plane(builder, |x, y| p[0] / (x - y).square() + p[1].square() * (x.square() + y.square()) / 2.0)
    }
    fn functions<'g>(system: &System<'g>) -> Vec<Expr<'g>> {
        let x = system.frame().coordinates();
        vec![1.0 / (x[0] - x[1]).square()]
    }
    assert_integrals(
        &["g", "w"],
        build,
        2,
        functions,
        &[
            "g/(x - y)^2 + 1/2*w^2*(x^2 + y^2) + 1/2*x'^2 + 1/2*y'^2",
            "w^2*x*y - g/(x - y)^2 + x'*y'",
            "4*g*x*y/(x - y)^2 + x^2*y'^2 - 2*x*y*x'*y' + y^2*x'^2",
        ],
    );
}

/// Two particles of Toda's chain.
#[test]
fn toda() {
    fn build<'g>(builder: SystemBuilder<'g>, p: Symbols<'_, 'g>) -> System<'g> {
        plane(builder, |x, y| p[0] * (x - y).exp())
    }
    fn functions<'g>(system: &System<'g>) -> Vec<Expr<'g>> {
        let x = system.frame().coordinates();
        vec![(x[0] - x[1]).exp()]
    }
    assert_integrals(&["a"], build, 2, functions, &["a*exp(x - y) + 1/2*x'^2 + 1/2*y'^2", "x' + y'"]);
}

/// A charge in a homogeneous magnetic field.
#[test]
fn magnetic_field() {
    fn build<'g>(builder: SystemBuilder<'g>, p: Symbols<'_, 'g>) -> System<'g> {
        let lagrangian = |x: &[Expr<'g>], v: &[Expr<'g>]| {
            p[0] * (v[0].square() + v[1].square()) / 2.0 + p[1] * (x[0] * v[1] - x[1] * v[0]) / 2.0
        };
        builder.coordinates(["x", "y"]).lagrangian(|_, x, v| lagrangian(x, v)).build().unwrap()
    }
    assert_integrals(
        &["m", "b"],
        build,
        2,
        none,
        &["1/2*m*(x'^2 + y'^2)", "b*y - m*x'", "m*y' + b*x", "2*m*x*y' - 2*m*y*x' + b*x^2 + b*y^2"],
    );
}

#[test]
fn euler_top() {
    fn build<'g>(builder: SystemBuilder<'g>, p: Symbols<'_, 'g>) -> System<'g> {
        builder
            .quasi_velocities(["ω1", "ω2", "ω3"])
            .algebra(&LieAlgebra::so3())
            .lagrangian(|_, _, w| (0..3).map(|i| p[i] * w[i].square() / 2.0).sum())
            .build()
            .unwrap()
    }
    assert_integrals(
        &["a", "b", "c"],
        build,
        2,
        none,
        &["1/2*(a*ω1^2 + b*ω2^2 + c*ω3^2)", "a^2*ω1^2 + b^2*ω2^2 + c^2*ω3^2"],
    );
}

#[test]
fn lagrange_top() {
    fn build<'g>(builder: SystemBuilder<'g>, p: Symbols<'_, 'g>) -> System<'g> {
        builder
            .coordinates(["γ1", "γ2", "γ3"])
            .quasi_velocities(["ω1", "ω2", "ω3"])
            .kinematics(|_, g, w| {
                [g[1] * w[2] - g[2] * w[1], g[2] * w[0] - g[0] * w[2], g[0] * w[1] - g[1] * w[0]]
            })
            .algebra(&LieAlgebra::so3())
            .lagrangian(|_, g, w| {
                (p[0] * (w[0].square() + w[1].square()) + p[1] * w[2].square()) / 2.0 - p[2] * g[2]
            })
            .build()
            .unwrap()
    }
    assert_integrals(
        &["a", "c", "n"],
        build,
        1,
        none,
        &[
            "1/2*a*(ω1^2 + ω2^2) + 1/2*c*ω3^2 + n*γ3",
            "c*ω3",
            "γ1^2 + γ2^2 + γ3^2",
            "a*γ1*ω1 + a*γ2*ω2 + c*γ3*ω3",
        ],
    );
}

/// Kirchhoff's ellipsoid of revolution in an ideal fluid.
#[test]
fn kirchhoff() {
    fn build<'g>(builder: SystemBuilder<'g>, p: Symbols<'_, 'g>) -> System<'g> {
        builder
            .quasi_velocities(["ω1", "ω2", "ω3", "u1", "u2", "u3"])
            .algebra(&LieAlgebra::se3())
            .lagrangian(|_, _, v| {
                let pair = |i: usize| v[i].square() + v[i + 1].square();
                (p[0] * pair(0) + p[1] * v[2].square() + p[2] * pair(3) + p[3] * v[5].square()) / 2.0
            })
            .build()
            .unwrap()
    }
    assert_integrals(
        &["a", "c", "m", "n"],
        build,
        2,
        none,
        &[
            "1/2*(a*(ω1^2 + ω2^2) + c*ω3^2 + m*(u1^2 + u2^2) + n*u3^2)",
            "c*ω3",
            "a*m*ω1*u1 + a*m*ω2*u2 + c*n*ω3*u3",
            "m^2*u1^2 + m^2*u2^2 + n^2*u3^2",
        ],
    );
}
