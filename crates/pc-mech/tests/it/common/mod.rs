//! Systems that several test files share.

#![allow(dead_code, reason = "each program uses its own part")]

use pc_mech::{
    Canonical, CompileOptions, Expr, Graph, LieAlgebra, Motion, System, SystemBuilder, VectorField,
};

/// A heavy top in Poisson's variables γ, with its moments of inertia and the weight times the place of its centre.
pub(crate) fn top<'g, E>(graph: &'g Graph, inertia: [E; 3], m: [E; 3]) -> SystemBuilder<'g>
where
    E: Copy + Into<Expr<'g>>,
{
    System::builder(graph)
        .coordinates(["γ1", "γ2", "γ3"])
        .quasi_velocities(["ω1", "ω2", "ω3"])
        .kinematics(|_, g, w| {
            [g[1] * w[2] - g[2] * w[1], g[2] * w[0] - g[0] * w[2], g[0] * w[1] - g[1] * w[0]]
        })
        .algebra(&LieAlgebra::so3())
        .lagrangian(|_, g, w| {
            let [a, b, c] = inertia.map(Into::into);
            let kinetic: Expr<'g> = (a * w[0].square() + b * w[1].square() + c * w[2].square()) / 2.0;
            let [m1, m2, m3] = m.map(Into::into);
            kinetic - m1 * g[0] - m2 * g[1] - m3 * g[2]
        })
}

/// The same with the parameters A, B, C, m1, m2, m3, all of them 1.
pub(crate) fn top_of_parameters(graph: &Graph) -> SystemBuilder<'_> {
    let [a, b, c, m1, m2, m3] = graph.symbols(["A", "B", "C", "m1", "m2", "m3"]);
    let ones = [a, b, c, m1, m2, m3];
    ones.into_iter()
        .fold(top(graph, [a, b, c], [m1, m2, m3]), |builder, symbol| builder.parameter(symbol, 1.0))
}

/// Euler's angles ψ, θ, φ with the body angular velocity.
pub(crate) fn in_eulers_angles(graph: &Graph) -> SystemBuilder<'_> {
    System::builder(graph).coordinates(["ψ", "θ", "φ"]).quasi_velocities(["ω1", "ω2", "ω3"]).kinematics(
        |_, x, w| {
            let across = w[0] * x[2].sin() + w[1] * x[2].cos();
            [across / x[1].sin(), w[0] * x[2].cos() - w[1] * x[2].sin(), w[2] - x[1].cot() * across]
        },
    )
}

/// A driven frame: b and b_0 depend on time, b_0 ≠ 0, c_0s ≠ 0.
pub(crate) fn driven(graph: &Graph) -> SystemBuilder<'_> {
    System::builder(graph).coordinates(["x", "y"]).quasi_velocities(["u", "v"]).kinematics(|t, x, eta| {
        [eta[0] * (1.0 + t.square()) + t * x[1], eta[1] * x[0] - t * eta[0] + x[0].square()]
    })
}

/// Canonical equations with all their derivatives.
pub(crate) fn compiled(canonical: &Canonical<'_>) -> Motion {
    canonical.compile_for(CompileOptions::default().jvp(true).parameter_jacobian(true)).unwrap()
}

/// ẏ at (t, y).
pub(crate) fn rates(motion: &mut Motion, t: f64, y: &[f64]) -> Vec<f64> {
    let mut ydot = vec![f64::NAN; y.len()];
    motion.rhs(t, y, &mut ydot).unwrap();
    ydot
}

/// Pseudo-random numbers between −1 and 1.
pub(crate) fn some(i: u32, j: u32) -> f64 {
    (f64::from(i * 7 + j * 13) * 0.618).sin()
}
