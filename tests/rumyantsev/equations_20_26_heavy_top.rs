//! The heavy top: equations (20)–(26). Nutation θ, precession ψ, proper rotation φ; ω along the body's principal axes, γ the
//! vertical in these axes, the mass centre at x_i⁰.

use pc_mech::{Expr, Graph, LieAlgebra, Matrix, RigidBody, System, SystemBuilder};

use crate::{assert_all_equal, assert_identities};

type Rows<'g> = [[Expr<'g>; 3]; 3];

fn product<'g>(a: &Rows<'g>, b: &Rows<'g>) -> Rows<'g> {
    std::array::from_fn(|i| {
        std::array::from_fn(|j| a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j])
    })
}

fn transposed<'g>(a: &Rows<'g>) -> Rows<'g> {
    std::array::from_fn(|i| std::array::from_fn(|j| a[j][i]))
}

/// R = R_z(ψ) R_x(θ) R_z(φ), from body axes to axes in space.
fn attitude<'g>(x: &[Expr<'g>]) -> Rows<'g> {
    let (zero, one) = (Expr::ZERO, Expr::ONE);
    let about_z = |angle: Expr<'g>| {
        let (s, c) = (angle.sin(), angle.cos());
        [[c, -s, zero], [s, c, zero], [zero, zero, one]]
    };
    let (s, c) = (x[0].sin(), x[0].cos());
    let about_x = [[one, zero, zero], [zero, c, -s], [zero, s, c]];
    product(&about_z(x[1]), &product(&about_x, &about_z(x[2])))
}

/// γ, the last row of R.
fn vertical<'g>(x: &[Expr<'g>]) -> [Expr<'g>; 3] {
    [x[0].sin() * x[2].sin(), x[0].sin() * x[2].cos(), x[0].cos()]
}

fn cross<'g>(u: &[Expr<'g>], v: &[Expr<'g>]) -> [Expr<'g>; 3] {
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
}

/// (20) as kinematics.
fn in_angles(graph: &Graph) -> SystemBuilder<'_> {
    System::builder(graph).coordinates(["θ", "ψ", "φ"]).quasi_velocities(["ω1", "ω2", "ω3"]).kinematics(
        |_, x, w| {
            let across = w[0] * x[2].sin() + w[1] * x[2].cos();
            [w[0] * x[2].cos() - w[1] * x[2].sin(), across / x[0].sin(), w[2] - x[0].cot() * across]
        },
    )
}

struct Top<'g> {
    angles: [Expr<'g>; 3],
    omega: [Expr<'g>; 3],
    /// A_i, and Mg x_i⁰.
    inertia: [Expr<'g>; 3],
    moment: [Expr<'g>; 3],
}

fn symbols(graph: &Graph) -> Top<'_> {
    Top {
        angles: graph.symbols(["θ", "ψ", "φ"]),
        omega: graph.symbols(["ω1", "ω2", "ω3"]),
        inertia: graph.symbols(["A1", "A2", "A3"]),
        moment: graph.symbols(["m1", "m2", "m3"]),
    }
}

impl<'g> Top<'g> {
    /// L = ½ A_i ω_i² − Mg x_i⁰ γ_i (23)
    fn lagrangian(&self, vertical: &[Expr<'g>], w: &[Expr<'g>]) -> Expr<'g> {
        (0..3)
            .map(|i| self.inertia[i] * w[i].square() / 2.0 - self.moment[i] * vertical[i])
            .fold(Expr::ZERO, |sum, term| sum + term)
    }

    /// A_1 ω̇_1 = (A_2 − A_3) ω_2 ω_3 + Mg (x_3⁰ γ_2 − x_2⁰ γ_3), cyclically (24).
    fn euler(&self, vertical: &[Expr<'g>]) -> [Expr<'g>; 3] {
        std::array::from_fn(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let weight = self.moment[k] * vertical[j] - self.moment[j] * vertical[k];
            (self.inertia[j] - self.inertia[k]) * self.omega[j] * self.omega[k] + weight
        })
    }

    fn parameters(&self, builder: SystemBuilder<'g>) -> SystemBuilder<'g> {
        let symbols = self.inertia.into_iter().chain(self.moment);
        symbols
            .zip([1.0, 1.5, 0.5, 0.2, 0.3, 1.0])
            .fold(builder, |b, (symbol, value)| b.parameter(symbol, value))
    }

    /// In Euler's angles.
    fn in_angles(&self, graph: &'g Graph) -> System<'g> {
        let builder = in_angles(graph).lagrangian(|_, x, w| self.lagrangian(&vertical(x), w));
        self.parameters(builder).build().unwrap()
    }

    /// In Poisson's variables.
    fn in_vertical(&self, graph: &'g Graph) -> System<'g> {
        let builder = System::builder(graph)
            .coordinates(["γ1", "γ2", "γ3"])
            .quasi_velocities(["ω1", "ω2", "ω3"])
            .kinematics(|_, g, w| cross(g, w))
            .lagrangian(|_, g, w| self.lagrangian(g, w));
        self.parameters(builder).build().unwrap()
    }
}

/// θ̇ = ω_1 cos φ − ω_2 sin φ, ψ̇ = (ω_1 sin φ + ω_2 cos φ)/sin θ, φ̇ = ω_3 − cot θ (ω_1 sin φ + ω_2 cos φ): then RᵀṘ is the
/// matrix of ω.
#[test]
fn equation_20_is_the_angular_velocity_along_body_axes() {
    let graph = Graph::new();
    let top = symbols(&graph);
    let system = top.in_angles(&graph);
    let rates: Vec<_> = top.angles.into_iter().zip(system.frame().velocities(&top.omega)).collect();
    let rotation = attitude(&top.angles);
    let velocity = rotation.map(|row| {
        let rates = graph.directional(&row, &rates);
        [rates[0], rates[1], rates[2]]
    });
    let spin = product(&transposed(&rotation), &velocity);
    let [w1, w2, w3] = top.omega;
    let zero = Expr::ZERO;
    let expected = [[zero, -w3, w2], [w3, zero, -w1], [-w2, w1, zero]];
    assert_all_equal("RᵀṘ", spin.into_iter().flatten(), expected.into_iter().flatten());
}

/// X_1 = cos φ ∂_θ + (sin φ/sin θ) ∂_ψ − cot θ sin φ ∂_φ, X_2 = −sin φ ∂_θ + (cos φ/sin θ) ∂_ψ − cot θ cos φ ∂_φ, X_3 = ∂_φ; they
/// turn the body about its axes, X_s R = R ê_s.
#[test]
fn equation_21_operators_turn_the_body_about_its_axes() {
    let graph = Graph::new();
    let top = symbols(&graph);
    let system = top.in_angles(&graph);
    let [theta, _, phi] = top.angles;
    let (s, c, cot) = (phi.sin(), phi.cos(), theta.cot());
    let expected = [
        [c, s / theta.sin(), -cot * s],
        [-s, c / theta.sin(), -cot * c],
        [Expr::ZERO, Expr::ZERO, Expr::ONE],
    ];
    let found = (1..=3).flat_map(|s| system.frame().apply(s, &top.angles));
    assert_all_equal("X_s x_i", found, expected.into_iter().flatten());

    let rotation = attitude(&top.angles);
    for s in 0..3 {
        let axis: [Expr<'_>; 3] = std::array::from_fn(|i| if i == s { Expr::ONE } else { Expr::ZERO });
        let turned = rotation.map(|row| cross(&row, &axis));
        let found = rotation.into_iter().flat_map(|row| system.frame().apply(s + 1, &row));
        assert_all_equal("X_s R", found, turned.into_iter().flatten());
    }
}

/// [X_1, X_2] = X_3, cyclically: c_12^3 = c_23^1 = c_31^2 = 1.
#[test]
fn equation_22_the_algebra_is_that_of_rotations() {
    let graph = Graph::new();
    let system = symbols(&graph).in_angles(&graph);
    let c = system.structure();
    assert_eq!(c.lie_algebra(), Some(LieAlgebra::so3()));
    for (r, s, m) in [(1, 2, 3), (2, 3, 1), (3, 1, 2)] {
        assert_eq!(c.get(r, s, m), Expr::ONE);
        assert_eq!(c.get(s, r, m), -Expr::ONE);
    }
}

/// From a rigid body under gravity whose mass centre is at the height l on the third axis: A_1 and A_2 are the moments about the
/// fixed point, by Steiner's theorem.
#[test]
fn equation_23_is_the_lagrangian_of_a_body_under_gravity() {
    let graph = Graph::new();
    let [i1, i2, i3, m, l, g] = graph.symbols(["I1", "I2", "I3", "m", "l", "g"]);
    let [w1, w2, w3] = symbols(&graph).omega;
    let parameters = [i1, i2, i3, m, l, g];
    let builder = parameters.into_iter().fold(in_angles(&graph), |b, symbol| b.parameter(symbol, 1.0));
    let system = builder
        .rigid_body(|_, x, _| {
            let rotation = attitude(x);
            let matrix = Matrix::from_fn(3, 3, |i, j| rotation[i][j]);
            RigidBody::rotating(m, rotation.map(|row| row[2] * l), [i1, i2, i3], matrix)
        })
        .gravity(|_| [Expr::ZERO, Expr::ZERO, -g])
        .build()
        .unwrap();
    let steiner = m * l.square();
    let kinetic = (i1 + steiner) * w1.square() + (i2 + steiner) * w2.square() + i3 * w3.square();
    let height = graph.symbol("θ").cos();
    assert_identities("L", [(system.lagrangian(), kinetic / 2.0 - m * g * l * height)]);
}

#[test]
fn equation_24_is_eulers() {
    let graph = Graph::new();
    let top = symbols(&graph);
    let gamma: [Expr<'_>; 3] = graph.symbols(["γ1", "γ2", "γ3"]);
    for (system, vertical) in
        [(top.in_vertical(&graph), gamma), (top.in_angles(&graph), vertical(&top.angles))]
    {
        let equations = system.poincare().unwrap();
        let found = (0..3).map(|i| top.inertia[i] * equations.accelerations()[i]);
        assert_all_equal("A ω̇", found, top.euler(&vertical));
    }
}

/// ẏ_1 = (A_2 − A_3)/(A_2 A_3) y_2 y_3 + Mg (x_3⁰ γ_2 − x_2⁰ γ_3), cyclically.
#[test]
fn equation_25_is_canonical() {
    let graph = Graph::new();
    let top = symbols(&graph);
    let gamma: [Expr<'_>; 3] = graph.symbols(["γ1", "γ2", "γ3"]);
    let canonical = top.in_vertical(&graph).canonical().unwrap();
    let y = canonical.momenta();
    let expected = (0..3).map(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let gyroscopic = (top.inertia[j] - top.inertia[k]) / (top.inertia[j] * top.inertia[k]) * y[j] * y[k];
        gyroscopic + top.moment[k] * gamma[j] - top.moment[j] * gamma[k]
    });
    assert_all_equal("ẏ", canonical.right_hand_side().iter().copied(), expected);
}

/// γ̇ = γ × ω, which follows from (20) for γ = (sin θ sin φ, sin θ cos φ, cos θ).
#[test]
fn equation_26_of_poisson_follows_from_equation_20() {
    let graph = Graph::new();
    let top = symbols(&graph);
    let system = top.in_angles(&graph);
    let rates: Vec<_> = top.angles.into_iter().zip(system.frame().velocities(&top.omega)).collect();
    let gamma = vertical(&top.angles);
    assert_all_equal("γ", attitude(&top.angles)[2], gamma);
    let found = graph.directional(&gamma, &rates);
    assert_all_equal("γ̇", found, cross(&gamma, &top.omega));
}
