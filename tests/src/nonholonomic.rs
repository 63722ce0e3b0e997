//! Nonholonomic systems: frames whose last operators are constrained to rest, with states to try them at.
//!
//! They are described for the library, and are no reference for it: what judges them comes from elsewhere.

use pc_mech::{Expr, Graph, MechError, System, SystemBuilder};

use crate::classical::SplitMix64;

/// A system with the quasi-velocities that its constraints keep at zero.
#[derive(Clone, Copy, Debug)]
pub struct Nonholonomic {
    /// Its name.
    pub name: &'static str,
    /// The system without its constraints, the quasi-velocities that vanish last.
    pub system: for<'g> fn(&'g Graph) -> Result<System<'g>, MechError>,
    /// The names of those that vanish.
    pub vanishing: &'static [&'static str],
    /// Time and state (coordinates, free quasi-velocities) at which the equations are regular.
    pub sample: fn(&mut SplitMix64) -> (f64, Vec<f64>),
}

/// The Chaplygin sleigh, free and steered, disks that roll, a particle, Suslov's body, snakeboards, two constraints of
/// Voronets' kind, two turntables.
pub const SYSTEMS: &[Nonholonomic] = &[
    SLEIGH,
    Nonholonomic { name: "stiff-sleigh", system: steered_sleigh, vanishing: &["u"], sample: normals::<5> },
    DISK,
    Nonholonomic {
        name: "vertical-disk",
        system: vertical_disk,
        vanishing: &["u", "v"],
        sample: normals::<6>,
    },
    Nonholonomic { name: "particle", system: particle, vanishing: &["slip"], sample: normals::<5> },
    Nonholonomic {
        name: "suslov",
        system: |graph| suslov(graph, false),
        vanishing: &["w3"],
        sample: normals::<6>,
    },
    Nonholonomic {
        name: "suslov-in-gravity",
        system: |graph| suslov(graph, true),
        vanishing: &["w3"],
        sample: normals::<6>,
    },
    Nonholonomic {
        name: "snakeboard",
        system: |graph| snakeboard(graph, false),
        vanishing: &["v", "s"],
        sample: normals::<8>,
    },
    Nonholonomic {
        name: "snakeboard-driven",
        system: |graph| snakeboard(graph, true),
        vanishing: &["v", "s"],
        sample: normals::<8>,
    },
    Nonholonomic {
        name: "voronets",
        system: |graph| voronets(graph, false),
        vanishing: &["slip"],
        sample: normals::<5>,
    },
    Nonholonomic {
        name: "voronets-rheonomic",
        system: |graph| voronets(graph, true),
        vanishing: &["slip"],
        sample: normals::<5>,
    },
    Nonholonomic {
        name: "turntable",
        system: |graph| ball_on_turntable(graph, false),
        vanishing: &["u", "v"],
        sample: normals::<9>,
    },
    Nonholonomic {
        name: "turntable-accelerated",
        system: |graph| ball_on_turntable(graph, true),
        vanishing: &["u", "v"],
        sample: normals::<9>,
    },
];

/// [`sleigh`] with its blade.
pub const SLEIGH: Nonholonomic = Nonholonomic {
    name: "chaplygin-sleigh",
    system: |graph| sleigh(graph, |u| u),
    vanishing: &["u"],
    sample: normals::<5>,
};

/// [`disk`] without slip.
pub const DISK: Nonholonomic =
    Nonholonomic { name: "tilted-disk", system: disk, vanishing: &["u", "v"], sample: upright };

impl Nonholonomic {
    /// The symbols of the quasi-velocities that vanish.
    pub fn constraints<'g>(&self, graph: &'g Graph) -> Vec<Expr<'g>> {
        self.vanishing.iter().map(|name| graph.symbol(name)).collect()
    }
}

fn normals<const N: usize>(random: &mut SplitMix64) -> (f64, Vec<f64>) {
    (random.uniform(0.0, 3.0), (0..N).map(|_| random.normal()).collect())
}

/// The axle of the disk between 0.4 and 2.6 from the vertical.
fn upright(random: &mut SplitMix64) -> (f64, Vec<f64>) {
    let (t, mut y) = normals::<8>(random);
    y[3] = random.uniform(0.4, 2.6);
    (t, y)
}

/// A sleigh on a blade at (x, y), heading φ; η = (v, ω, u), u the lateral velocity of the blade; m = J = 1, a
/// = ½.
///
/// The kinetic energy is computed with `lateral(u)` for u: itself, or 0 to put the constraint in too early.
///
/// # Errors
/// [`MechError`], of which none is to be expected.
pub fn sleigh<'g>(graph: &'g Graph, lateral: fn(Expr<'g>) -> Expr<'g>) -> Result<System<'g>, MechError> {
    on_a_blade(graph, lateral).build()
}

/// The [sleigh] under a stiff spring, a damper, a drive, and friction along the blade.
///
/// # Errors
/// [`MechError`], of which none is to be expected.
pub fn steered_sleigh(graph: &Graph) -> Result<System<'_>, MechError> {
    on_a_blade(graph, |u| u)
        .forces(|t, x, eta| {
            let stribeck = 0.5 + (-4.0 * eta[0].square()).exp() / 2.0;
            let friction = eta[0] / 5.0 + stribeck * (10.0 * eta[0]).tanh();
            let moment = -1.25e6 * (x[2] - t.sin() / 2.0) - 1.25e6 * eta[1];
            [2.0 * (2.0 * t).sin() - friction, moment, Expr::ZERO]
        })
        .build()
}

fn on_a_blade<'g>(graph: &'g Graph, lateral: fn(Expr<'g>) -> Expr<'g>) -> SystemBuilder<'g> {
    let [m, j, a] = graph.symbols(["m", "J", "a"]);
    System::builder(graph)
        .parameter(m, 1.0)
        .parameter(j, 1.0)
        .parameter(a, 0.5)
        .coordinates(["x", "y", "phi"])
        .quasi_velocities(["v", "w", "u"])
        .kinematics(|_, x, eta| {
            let (s, c) = (x[2].sin(), x[2].cos());
            [eta[0] * c - eta[2] * s, eta[0] * s + eta[2] * c, eta[1]]
        })
        .lagrangian(|_, _, eta| {
            let across = lateral(eta[2]) + a * eta[1];
            m * (eta[0].square() + across.square()) / 2.0 + j * eta[1].square() / 2.0
        })
}

/// A vertical disk, θ the angle rolled; η = (θ̇, φ̇, u, v), (u, v) the slip in space axes; m = 2, R = ½, I = ¼, J = ⅛, driven
/// by τ = 0.3.
///
/// # Errors
/// [`MechError`], of which none is to be expected.
pub fn vertical_disk(graph: &Graph) -> Result<System<'_>, MechError> {
    System::builder(graph)
        .coordinates(["X", "Y", "phi", "theta"])
        .quasi_velocities(["roll", "turn", "u", "v"])
        .kinematics(|_, x, eta| {
            [eta[2] + eta[0] * x[2].cos() / 2.0, eta[3] + eta[0] * x[2].sin() / 2.0, eta[1], eta[0]]
        })
        .lagrangian(|_, x, eta| {
            let (vx, vy) = (eta[2] + eta[0] * x[2].cos() / 2.0, eta[3] + eta[0] * x[2].sin() / 2.0);
            vx.square() + vy.square() + eta[0].square() / 8.0 + eta[1].square() / 16.0
        })
        .forces(|_, _, _| [Expr::from(0.3), Expr::ZERO, Expr::ZERO, Expr::ZERO])
        .build()
}

/// A particle of mass one with η = (ẋ, ẏ, ż − y ẋ).
///
/// # Errors
/// [`MechError`], of which none is to be expected.
pub fn particle(graph: &Graph) -> Result<System<'_>, MechError> {
    System::builder(graph)
        .coordinates(["x", "y", "z"])
        .quasi_velocities(["vx", "vy", "slip"])
        .kinematics(|_, x, eta| [eta[0], eta[1], eta[2] + x[1] * eta[0]])
        .lagrangian(|_, x, eta| (eta[0].square() + eta[1].square() + (eta[2] + x[1] * eta[0]).square()) / 2.0)
        .build()
}

/// Suslov's body with a unit quaternion, angular velocity in body axes: free with the products of inertia I_13 = ½,
/// I_23 = −0.8, or in gravity with I = diag(1, 2, 3) and the mass centre (3/2, 1, 0).
///
/// # Errors
/// [`MechError`], of which none is to be expected.
pub fn suslov(graph: &Graph, gravity: bool) -> Result<System<'_>, MechError> {
    System::builder(graph)
        .coordinates(["q0", "q1", "q2", "q3"])
        .quasi_velocities(["w1", "w2", "w3"])
        .kinematics(|_, q, w| {
            [
                (-q[1] * w[0] - q[2] * w[1] - q[3] * w[2]) / 2.0,
                (q[0] * w[0] - q[3] * w[1] + q[2] * w[2]) / 2.0,
                (q[3] * w[0] + q[0] * w[1] - q[1] * w[2]) / 2.0,
                (-q[2] * w[0] + q[1] * w[1] + q[0] * w[2]) / 2.0,
            ]
        })
        .lagrangian(|_, q, w| {
            let squares: Vec<Expr<'_>> = w.iter().map(|w| w.square()).collect();
            if gravity {
                let up = [2.0 * (q[1] * q[3] - q[0] * q[2]), 2.0 * (q[2] * q[3] + q[0] * q[1])];
                (squares[0] + 2.0 * squares[1] + 3.0 * squares[2]) / 2.0 - up[0] * 1.5 - up[1]
            } else {
                let products = (w[0] / 2.0 - 0.8 * w[1]) * w[2];
                (2.0 * squares[0] + 3.0 * squares[1] + 4.0 * squares[2]) / 2.0 + products
            }
        })
        .build()
}

/// A snakeboard; η = (ψ̇, φ̇, w, v, s), the velocity along the board −r w cos φ + s sin φ, across it v, and
/// r θ̇ = r w sin φ + s cos φ; m = 2, r = ½, J_0 = ¼, J_1 = 0.1; `driven` by ½ sin 2t on the rotor and 0.2 cos 3t on the
/// steering.
///
/// # Errors
/// [`MechError`], of which none is to be expected.
pub fn snakeboard(graph: &Graph, driven: bool) -> Result<System<'_>, MechError> {
    System::builder(graph)
        .coordinates(["X", "Y", "theta", "psi", "phi"])
        .quasi_velocities(["rotor", "steering", "w", "v", "s"])
        .kinematics(|_, x, eta| {
            let [along, turn] = board(x, eta);
            let (s, c) = (x[2].sin(), x[2].cos());
            [along * c - eta[3] * s, along * s + eta[3] * c, turn, eta[0], eta[1]]
        })
        .lagrangian(|_, x, eta| {
            let [along, turn] = board(x, eta);
            let whole = along.square() + eta[3].square() + turn.square() / 4.0;
            whole + eta[0].square() / 8.0 + eta[0] * turn / 4.0 + eta[1].square() / 10.0
        })
        .forces(|t, _, _| {
            let torques = [(2.0 * t).sin() / 2.0, (3.0 * t).cos() / 5.0];
            let [rotor, steering] = if driven { torques } else { [Expr::ZERO; 2] };
            [rotor, steering, Expr::ZERO, Expr::ZERO, Expr::ZERO]
        })
        .build()
}

/// Velocity along the snakeboard, and θ̇.
fn board<'g>(x: &[Expr<'g>], eta: &[Expr<'g>]) -> [Expr<'g>; 2] {
    let (s, c) = (x[4].sin(), x[4].cos());
    [eta[4] * s - eta[2] * c / 2.0, eta[2] * s + 2.0 * eta[4] * c]
}

/// A disk on a plane, θ the angle of its axle with the vertical; η = (ω_1, ω_2, ω_3, u, v) with u, v the slip
/// of the point of contact; m = r = 1, A = ¼, C = ½, g = 10.
///
/// # Errors
/// [`MechError`], of which none is to be expected.
pub fn disk(graph: &Graph) -> Result<System<'_>, MechError> {
    let [m, a, c, r, g] = graph.symbols(["m", "A", "C", "r", "g"]);
    let numbers = [(m, 1.0), (a, 0.25), (c, 0.5), (r, 1.0), (g, 10.0)];
    let builder =
        numbers.into_iter().fold(System::builder(graph), |b, (symbol, value)| b.parameter(symbol, value));
    builder
        .coordinates(["X", "Y", "psi", "theta", "phi"])
        .quasi_velocities(["w1", "w2", "w3", "u", "v"])
        .kinematics(|_, x, w| {
            let roll = w[2] - w[1] * x[3].cot();
            let along = w[3] - r * roll;
            [
                along * x[2].cos() - w[4] * x[2].sin(),
                along * x[2].sin() + w[4] * x[2].cos(),
                w[1] / x[3].sin(),
                w[0],
                roll,
            ]
        })
        .lagrangian(|_, x, w| {
            let (s, co) = (x[3].sin(), x[3].cos());
            let centre = (w[3] - r * w[2]).square() + (w[4] * co).square() + (r * w[0] - w[4] * s).square();
            (m * centre + a * (w[0].square() + w[1].square()) + c * w[2].square()) / 2.0 - m * g * r * s
        })
        .build()
}

/// A, B, D of the constraint ż = A ẋ + B ẏ + D.
fn voronets_coefficients<'g>(affine: bool, t: Expr<'g>, x: &[Expr<'g>]) -> [Expr<'g>; 3] {
    let drift = if affine { t.cos() / 2.0 + x[1] / 10.0 + x[2] / 5.0 } else { Expr::ZERO };
    [x[1] + x[2].square() / 2.0, x[0] * x[2], drift]
}

/// A constraint whose coefficients depend on the dependent coordinate z and, where `affine`, on time:
/// η = (ẋ, ẏ, ż − A ẋ − B ẏ − D).
///
/// # Errors
/// [`MechError`], of which none is to be expected.
pub fn voronets(graph: &Graph, affine: bool) -> Result<System<'_>, MechError> {
    System::builder(graph)
        .coordinates(["x", "y", "z"])
        .quasi_velocities(["vx", "vy", "slip"])
        .kinematics(|t, x, eta| {
            let [a, b, d] = voronets_coefficients(affine, t, x);
            [eta[0], eta[1], eta[2] + a * eta[0] + b * eta[1] + d]
        })
        .lagrangian(|t, x, eta| {
            let [a, b, d] = voronets_coefficients(affine, t, x);
            let vz = a * eta[0] + b * eta[1] + eta[2] + d;
            (eta[0].square() + eta[1].square() + vz.square()) / 2.0 - x[2].square() / 2.0 - x[0] * x[2] / 4.0
        })
        .build()
}

fn table_rate(t: Expr<'_>, accelerated: bool) -> Expr<'_> {
    if accelerated { 1.0 + t / 4.0 } else { 2.0.into() }
}

/// A homogeneous ball on a table that turns with Ω = 2 or, `accelerated`, with 1 + t/4: redundant quaternion,
/// angular velocity on space axes, (u, v) the slip on the table; b_0 ≠ 0 and c_0s ≠ 0.
///
/// # Errors
/// [`MechError`], of which none is to be expected.
pub fn ball_on_turntable(graph: &Graph, accelerated: bool) -> Result<System<'_>, MechError> {
    let (m, r, j) = (1.0, 0.5, 0.1);
    System::builder(graph)
        .coordinates(["q0", "q1", "q2", "q3", "X", "Y"])
        .quasi_velocities(["wx", "wy", "wz", "u", "v"])
        .kinematics(|t, x, w| {
            let (omega, q) = (table_rate(t, accelerated), &x[..4]);
            [
                (-q[1] * w[0] - q[2] * w[1] - q[3] * w[2]) / 2.0,
                (q[0] * w[0] + q[3] * w[1] - q[2] * w[2]) / 2.0,
                (q[0] * w[1] + q[1] * w[2] - q[3] * w[0]) / 2.0,
                (q[0] * w[2] + q[2] * w[0] - q[1] * w[1]) / 2.0,
                w[1] * r + w[3] - omega * x[5],
                w[4] - w[0] * r + omega * x[4],
            ]
        })
        .lagrangian(|t, x, w| {
            let omega = table_rate(t, accelerated);
            let (vx, vy) = (w[1] * r + w[3] - omega * x[5], w[4] - w[0] * r + omega * x[4]);
            let spin = w[0].square() + w[1].square() + w[2].square();
            (vx.square() + vy.square()) * (m / 2.0) + spin * (j / 2.0)
        })
        .build()
}
