//! The systems whose right-hand sides are timed; a new one is a function here, listed in [`SYSTEMS`].

use pc_mech::{Equations, Graph, LieAlgebra, MechError, System};
use pc_model::{Builtin, Model};
use pc_nonholo::Constrained;
use pc_tests::classical::{SplitMix64, sample};
use pc_tests::nonholonomic::{DISK, Nonholonomic, SLEIGH};

use crate::error::Error;
use crate::hand::{self, Hand};

/// Draws a state.
type Draw = dyn Fn(&mut SplitMix64) -> Vec<f64>;
/// Derives a case in a graph.
pub(crate) type Derive = fn(&Graph) -> Result<Case<'_>, Error>;

/// A system with its equations derived and written by hand.
pub(crate) struct Case<'g> {
    /// What the table calls it.
    pub(crate) name: String,
    /// The derived equations, parameters free.
    pub(crate) equations: Equations<'g>,
    /// The equations by hand; the first is what the others are compared with.
    pub(crate) hand: Vec<(&'static str, Hand)>,
    /// A random state at which they are regular.
    pub(crate) state: Box<Draw>,
}

/// Those over which means are taken.
pub(crate) const SYSTEMS: &[Derive] = &[
    top_in_poisson_variables,
    top_in_euler_angles,
    body_with_quaternion,
    |graph| nonholonomic(graph, "Chaplygin sleigh", SLEIGH, hand::sleigh()),
    |graph| nonholonomic(graph, "tilted disk", DISK, hand::disk()),
    |graph| pendulum_case(graph, 4),
    |graph| pendulum_case(graph, 8),
    |graph| pendulum_case(graph, 16),
];

/// Those that are shown beside them.
pub(crate) const FURTHER: &[Derive] = &[top_with_quaternion, charged_particle, relativistic_particle];

/// The planar pendulum of unit links and masses in its angles from the vertical.
///
/// # Errors
/// [`MechError`], of which none is to be expected.
pub(crate) fn pendulum(graph: &Graph, links: usize) -> Result<System<'_>, MechError> {
    let gravity = graph.symbol("g");
    let weight = |i: usize| (links - i) as f64;
    System::builder(graph)
        .parameter(gravity, 10.0)
        .coordinates((1..=links).map(|i| format!("θ{i}")))
        .lagrangian(|_, theta, eta| {
            let kinetic = (0..links).flat_map(|i| (0..=i).map(move |j| (i, j))).map(|(i, j)| {
                let pair = if i == j { 0.5 } else { 1.0 };
                pair * weight(i) * (theta[i] - theta[j]).cos() * eta[i] * eta[j]
            });
            let potential = (0..links).map(|i| weight(i) * gravity * theta[i].cos());
            graph.sum(kinetic.chain(potential))
        })
        .build()
}

fn pendulum_case(graph: &Graph, links: usize) -> Result<Case<'_>, Error> {
    Ok(Case {
        name: format!("pendulum of {links} links"),
        equations: pendulum(graph, links)?.poincare()?,
        hand: vec![("hand", hand::pendulum(links)), ("hand, by tensions", hand::pendulum_by_tensions(links))],
        state: Box::new(move |random| (0..2 * links).map(|_| random.normal()).collect()),
    })
}

fn top_in_poisson_variables(graph: &Graph) -> Result<Case<'_>, Error> {
    let inertia = graph.symbols(["I1", "I2", "I3"]);
    let centre = graph.symbols(["r1", "r2", "r3"]);
    let weight = graph.symbol("mg");
    let mut builder = System::builder(graph).parameter(weight, 10.0);
    for (symbol, value) in inertia.into_iter().chain(centre).zip([2.0, 3.0, 4.0, 0.1, 0.2, 0.3]) {
        builder = builder.parameter(symbol, value);
    }
    let system = builder
        .coordinates(["γ1", "γ2", "γ3"])
        .quasi_velocities(["ω1", "ω2", "ω3"])
        .kinematics(|_, g, w| {
            [g[1] * w[2] - g[2] * w[1], g[2] * w[0] - g[0] * w[2], g[0] * w[1] - g[1] * w[0]]
        })
        .algebra(&LieAlgebra::so3())
        .lagrangian(|_, g, w| {
            let squares = [w[0].square(), w[1].square(), w[2].square()];
            let kinetic = inertia[0] * squares[0] + inertia[1] * squares[1] + inertia[2] * squares[2];
            kinetic / 2.0 - weight * (centre[0] * g[0] + centre[1] * g[1] + centre[2] * g[2])
        })
        .build()?;
    Ok(Case {
        name: "top in Poisson's variables".to_owned(),
        equations: system.poincare()?,
        hand: vec![("hand", hand::poisson())],
        state: Box::new(|random| (0..6).map(|_| random.normal()).collect()),
    })
}

/// A triaxial body that turns freely: 4 coordinates, 3 quasi-velocities, the algebra given.
fn body_with_quaternion(graph: &Graph) -> Result<Case<'_>, Error> {
    let inertia = graph.symbols(["I1", "I2", "I3"]);
    let builder = inertia.into_iter().zip([2.0, 3.0, 4.0]);
    let system = builder
        .fold(System::builder(graph), |builder, (symbol, value)| builder.parameter(symbol, value))
        .coordinates(["q0", "q1", "q2", "q3"])
        .quasi_velocities(["ω1", "ω2", "ω3"])
        .kinematics(|_, q, w| {
            [
                (-q[1] * w[0] - q[2] * w[1] - q[3] * w[2]) / 2.0,
                (q[0] * w[0] - q[3] * w[1] + q[2] * w[2]) / 2.0,
                (q[3] * w[0] + q[0] * w[1] - q[1] * w[2]) / 2.0,
                (-q[2] * w[0] + q[1] * w[1] + q[0] * w[2]) / 2.0,
            ]
        })
        .algebra(&LieAlgebra::so3())
        .lagrangian(|_, _, w| graph.sum((0..3).map(|i| inertia[i] * w[i].square())) / 2.0)
        .build()?;
    Ok(Case {
        name: "body with a quaternion".to_owned(),
        equations: system.poincare()?,
        hand: vec![("hand", hand::free_quaternion())],
        state: Box::new(|random| (0..7).map(|_| random.normal()).collect()),
    })
}

/// A system with its constraints.
fn nonholonomic<'g>(
    graph: &'g Graph,
    name: &str,
    described: Nonholonomic,
    hand: Hand,
) -> Result<Case<'g>, Error> {
    let system = (described.system)(graph)?;
    let constrained = Constrained::new(&system, &described.constraints(graph))?;
    Ok(Case {
        name: name.to_owned(),
        equations: constrained.equations().clone(),
        hand: vec![("hand", hand)],
        state: Box::new(move |random| (described.sample)(random).1),
    })
}

fn top_in_euler_angles(graph: &Graph) -> Result<Case<'_>, Error> {
    builtin(graph, "top in Euler's angles", "heavy-top-euler", hand::euler())
}

fn top_with_quaternion(graph: &Graph) -> Result<Case<'_>, Error> {
    builtin(graph, "top with a quaternion", "heavy-top-quaternion", hand::quaternion())
}

fn charged_particle(graph: &Graph) -> Result<Case<'_>, Error> {
    builtin(graph, "charged particle", "charged-particle", hand::charged())
}

fn relativistic_particle(graph: &Graph) -> Result<Case<'_>, Error> {
    builtin(graph, "relativistic particle", "relativistic-particle", hand::relativistic())
}

/// A built-in model with the parameters of its file.
fn builtin<'g>(graph: &'g Graph, name: &str, model: &'static str, hand: Hand) -> Result<Case<'g>, Error> {
    let no_model = || Error::NoModel { name: model };
    let document = Builtin::named(model).ok_or_else(no_model)?.document()?;
    let assembly = Model::new(document).assemble(graph)?;
    sample(model, &mut SplitMix64::new(0)).ok_or_else(no_model)?;
    Ok(Case {
        name: name.to_owned(),
        equations: assembly.system.poincare()?,
        hand: vec![("hand", hand)],
        state: Box::new(move |random| sample(model, random).map_or_else(Vec::new, |(_, state)| state)),
    })
}
