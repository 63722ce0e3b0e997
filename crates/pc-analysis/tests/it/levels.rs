//! Functions that are conserved where constraints hold, or on a level of other integrals.

use pc_analysis::{ConservationVerdict, Integral, Integrals};
use pc_mech::{Expr, Graph, LieAlgebra, Neighbourhood, System};

/// The declared integrals of the system, judged on levels, at these values of time, state and parameters.
fn judged<'g>(system: &System<'g>, at: &[(&str, f64)], constraints: &[Expr<'g>]) -> Vec<Integral<'g>> {
    let graph = system.graph();
    let parameters = system.parameters().iter().copied();
    let centre = at.iter().map(|&(name, value)| (graph.symbol(name), value)).chain(parameters).collect();
    let (equations, near) = (system.poincare().unwrap(), Neighbourhood { centre });
    let mut integrals = Integrals::known(&equations, &near);
    integrals.judge_on_levels(&equations, &near, constraints);
    integrals.list().to_vec()
}

fn verdict(list: &[Integral<'_>], name: &str) -> (&'static str, String) {
    let integral = list.iter().find(|integral| integral.name == name).expect("an integral of that name");
    let level: Vec<String> = integral.level.iter().map(|f| format!("{} = {}", f.name, f.value)).collect();
    let verdict = match integral.verdict {
        ConservationVerdict::Conserved => "conserved",
        ConservationVerdict::OnLevel { always: true } => "on a level",
        ConservationVerdict::OnLevel { always: false } => "on a level here",
        ConservationVerdict::Rate { .. } => "open",
        _ => "other",
    };
    (verdict, level.join(", "))
}

/// The heavy top A = B = 4 C with the mass centre on axis 1, and Goryachev and Chaplygin's function.
fn top(graph: &Graph, moments: [f64; 3]) -> System<'_> {
    let [i1, i2, i3, n] = graph.symbols(["I1", "I2", "I3", "n"]);
    let mut builder = System::builder(graph);
    for (symbol, value) in [i1, i2, i3, n].into_iter().zip([moments[0], moments[1], moments[2], 1.7]) {
        builder = builder.parameter(symbol, value);
    }
    builder
        .coordinates(["γ1", "γ2", "γ3"])
        .quasi_velocities(["ω1", "ω2", "ω3"])
        .kinematics(|_, g, w| {
            [g[1] * w[2] - g[2] * w[1], g[2] * w[0] - g[0] * w[2], g[0] * w[1] - g[1] * w[0]]
        })
        .algebra(&LieAlgebra::so3())
        .lagrangian(|_, g, w| (i1 * w[0].square() + i2 * w[1].square() + i3 * w[2].square()) / 2.0 - n * g[0])
        .integral("area", |_, g, w| i1 * w[0] * g[0] + i2 * w[1] * g[1] + i3 * w[2] * g[2])
        .integral("norm", |_, g, _| g[0].square() + g[1].square() + g[2].square())
        .integral("chaplygin", |_, g, w| w[2] * (w[0].square() + w[1].square()) - n / i3 * w[0] * g[2])
        .build()
        .unwrap()
}

fn start(spin: f64) -> [(&'static str, f64); 7] {
    [("t", 0.0), ("γ1", 0.6), ("γ2", 0.0), ("γ3", 0.8), ("ω1", 0.5), ("ω2", 0.7), ("ω3", spin)]
}

#[test]
fn goryachev_and_chaplygin_need_no_area() {
    let graph = Graph::new();
    let list = judged(&top(&graph, [4.0, 4.0, 1.0]), &start(-1.5), &[]);
    assert_eq!(verdict(&list, "chaplygin"), ("on a level here", "area = 0".to_owned()));
    // On another level it changes.
    let list = judged(&top(&graph, [4.0, 4.0, 1.0]), &start(-1.0), &[]);
    assert_eq!(verdict(&list, "chaplygin").0, "open");
    // So it does for other moments of inertia.
    let list = judged(&top(&graph, [4.0, 4.1, 1.0]), &start(-1.5), &[]);
    assert_eq!(verdict(&list, "chaplygin"), ("open", String::new()));
}

/// Neumann's problem: a particle on the sphere in the potential Σ a_i x_i²/2, by the equations
/// ẍ_i = −a_i x_i + x_i (Σ a_j x_j² − |ẋ|²)/|x|², with Uhlenbeck's integrals
/// F_i = x_i² + Σ_j (x_i ẋ_j − x_j ẋ_i)²/(a_i − a_j).
#[test]
fn uhlenbeck_s_integrals_are_some_on_the_sphere() {
    let graph = Graph::new();
    let a = graph.symbols(["a", "b", "c"]);
    let mut builder = System::builder(&graph);
    for (symbol, value) in a.into_iter().zip([1.0, 2f64.sqrt(), 3.0]) {
        builder = builder.parameter(symbol, value);
    }
    let system = builder
        .coordinates(["x", "y", "z"])
        .lagrangian(|_, x, v| {
            let terms = |i: usize| v[i].square() - a[i] * x[i].square();
            (terms(0) + terms(1) + terms(2)) / 2.0
        })
        .forces(|_, x, v| {
            let radius = x[0].square() + x[1].square() + x[2].square();
            let push = a[0] * x[0].square() + a[1] * x[1].square() + a[2] * x[2].square();
            let speed = v[0].square() + v[1].square() + v[2].square();
            [0, 1, 2].map(|i| x[i] * (push - speed) / radius)
        })
        .integral("uhlenbeck", |_, x, v| {
            let part = |j: usize| (x[0] * v[j] - x[j] * v[0]).square() / (a[0] - a[j]);
            x[0].square() + part(1) + part(2)
        })
        .integral("wrong", |_, x, v| {
            let part = |j: usize| (x[0] * v[j] - x[j] * v[0]).square() / (a[0] - a[j]);
            x[0].square() + part(1) - part(2)
        })
        .build()
        .unwrap();
    let [x, y, z, u, v, w] = graph.symbols(["x", "y", "z", "x'", "y'", "z'"]);
    let sphere = [x.square() + y.square() + z.square() - 1.0, x * u + y * v + z * w];
    let at = [("t", 0.0), ("x", 0.6), ("y", 0.8), ("z", 0.0), ("x'", 0.4), ("y'", -0.3), ("z'", 0.5)];
    let list = judged(&system, &at, &sphere);
    assert_eq!(verdict(&list, "uhlenbeck"), ("conserved", String::new()));
    assert_eq!(verdict(&list, "wrong").0, "open");
    let free = judged(&system, &at, &[]);
    assert_eq!(verdict(&free, "uhlenbeck").0, "open");
}
