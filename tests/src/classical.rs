//! Equations of motion as the textbooks print them, for comparison with the derived ones.
//!
//! Every function writes ẏ for y = (coordinates, quasi-velocities), in the order of the columns of the built-in
//! model, without quasi-velocities that constraints say vanish. [`classical`] binds them to the parameters of the models; [`sample`] draws states at which to compare.

mod arm;
mod attitude;
mod chains;
pub(crate) mod nonholonomic;
mod orbit;
mod particles;
mod pendulums;
mod random;
mod rheonomic;
mod spring;
#[cfg(test)]
mod tests;
mod tops;

pub use arm::{arm_on_wall, arm_sample};
pub use attitude::{gimbals, quadrotor, reaction_wheels};
pub use chains::{pendulum_chain, pendulum_chain_in_the_plane, toda_chain};
pub use nonholonomic::{
    appell_hamel, ball_in_cylinder, ball_on_turntable, carriage, chaplygin_sleigh, nonholonomic_particle,
    rocking_disk, snakeboard, stick_slip_sleigh, stiff_sleigh, suslov, suslov_in_gravity, tilted_disk,
    vertical_disk, vertical_disk_driven, voronets,
};
pub use orbit::Satellite;
pub use particles::{
    charged_particle, damped_acceleration, damped_oscillator, damped_oscillator_in_scaled_frame,
    relativistic_constant_force, relativistic_particle,
};
pub use pendulums::{DoublePendulum, spherical_pendulum, spherical_pendulum_on_meridians};
pub use random::SplitMix64;
pub use rheonomic::{rotating_oscillator, turning_hoop, turning_wire};
pub use spring::BodyOnSpring;
pub use tops::{HeavyTop, euler_top};

/// A right-hand side ẏ = f(t, y): time, state, and where to write the derivative.
pub type Rhs = fn(f64, &[f64], &mut [f64]);

const LAGRANGE: HeavyTop = HeavyTop { inertia: [1.0, 1.0, 0.5], centre: [0.0, 0.0, 1.0], weight: 1.0 };
const KOVALEVSKAYA: HeavyTop = HeavyTop { inertia: [2.0, 2.0, 1.0], centre: [1.0, 0.0, 0.0], weight: 1.0 };
const GORYACHEV_CHAPLYGIN: HeavyTop =
    HeavyTop { inertia: [4.0, 4.0, 1.0], centre: [1.0, 0.0, 0.0], weight: 1.0 };
const TRIAXIAL: HeavyTop = HeavyTop { inertia: [2.0, 3.0, 4.0], centre: [0.1, 0.2, 0.3], weight: 10.0 };
const ON_SPRING: BodyOnSpring =
    BodyOnSpring { mass: 2.0, inertia: [1.0, 2.0, 3.0], point: [0.5, 0.0, 0.25], stiffness: 5.0 };
const DOUBLE: DoublePendulum = DoublePendulum { masses: [1.0, 2.0] };
const SATELLITE: Satellite = Satellite { inertia: [0.1, 0.2, 0.25], mass: 1.0 };

/// Names of the models that [`classical`] and [`sample`] know, in order.
pub const MODELS: &[&str] = &[
    "appell-hamel",
    "ball-in-cylinder",
    "bouncing-ball",
    "carriage",
    "chaplygin-sleigh",
    "charged-particle",
    "charged-particle-induction",
    "damped-oscillator",
    "damped-oscillator-scaled-frame",
    "double-pendulum-cartesian",
    "double-pendulum-links",
    "euler-top",
    "gimbals",
    "gravity-gradient",
    "heavy-top-euler",
    "heavy-top-euler-symmetric",
    "heavy-top-goryachev-chaplygin",
    "heavy-top-kovalevskaya",
    "heavy-top-lagrange",
    "heavy-top-quaternion",
    "nonholonomic-particle",
    "pendulum-chain",
    "pendulum-chain-cartesian",
    "quadrotor",
    "reaction-wheels",
    "relativistic-constant-force",
    "relativistic-particle",
    "rigid-body-spring",
    "rocking-block",
    "rocking-disk",
    "rotating-oscillator",
    "snakeboard",
    "snakeboard-driven",
    "spherical-pendulum-cartesian",
    "spherical-pendulum-meridian",
    "stick-slip-block",
    "stick-slip-sleigh",
    "stiff-sleigh",
    "suslov",
    "suslov-in-gravity",
    "tilted-disk",
    "toda-chain",
    "turning-hoop",
    "turning-wire",
    "turntable",
    "turntable-accelerated",
    "vertical-disk",
    "vertical-disk-driven",
    "voronets",
    "voronets-rheonomic",
];

/// The classical equations of a built-in model with its parameters, or `None` for a name not in [`MODELS`].
pub fn classical(model: &str) -> Option<Rhs> {
    Some(match model {
        "appell-hamel" => |_, y, dy| appell_hamel(y, dy),
        "ball-in-cylinder" => |_, y, dy| ball_in_cylinder(y, dy),
        "bouncing-ball" => |_, y, dy| dy.copy_from_slice(&[y[1], -9.81]),
        "carriage" => |_, y, dy| carriage(y, dy),
        "chaplygin-sleigh" => |_, y, dy| chaplygin_sleigh(y, dy),
        "charged-particle" => |_, y, dy| charged_particle(2.0, 0.0, y, dy),
        "charged-particle-induction" => {
            |t, y, dy| charged_particle(1.0 + t.sin() / 2.0, t.cos() / 2.0, y, dy)
        }
        "damped-oscillator" => |_, y, dy| damped_oscillator(0.25, 2.0, y, dy),
        "damped-oscillator-scaled-frame" => |t, y, dy| damped_oscillator_in_scaled_frame(0.25, 2.0, t, y, dy),
        "double-pendulum-cartesian" => |_, y, dy| DOUBLE.by_horizontal_velocities(y, dy),
        "double-pendulum-links" => |_, y, dy| DOUBLE.by_rates_of_links(y, dy),
        "euler-top" => |_, y, dy| euler_top([1.0, 2.0, 3.0], y, dy),
        "gimbals" => |_, y, dy| gimbals(y, dy),
        "gravity-gradient" => |_, y, dy| SATELLITE.in_gravity_gradient(y, dy),
        "heavy-top-euler" => |_, y, dy| TRIAXIAL.in_euler_angles(y, dy),
        "heavy-top-euler-symmetric" => |_, y, dy| LAGRANGE.in_euler_angles(y, dy),
        "heavy-top-goryachev-chaplygin" => |_, y, dy| GORYACHEV_CHAPLYGIN.in_poisson_variables(y, dy),
        "heavy-top-kovalevskaya" => |_, y, dy| KOVALEVSKAYA.in_poisson_variables(y, dy),
        "heavy-top-lagrange" => |_, y, dy| LAGRANGE.in_poisson_variables(y, dy),
        "heavy-top-quaternion" => |_, y, dy| TRIAXIAL.in_quaternion(y, dy),
        "nonholonomic-particle" => |_, y, dy| nonholonomic_particle(y, dy),
        "pendulum-chain" => |_, y, dy| pendulum_chain(y, dy),
        "pendulum-chain-cartesian" => |_, y, dy| pendulum_chain_in_the_plane(y, dy),
        "quadrotor" => |_, y, dy| quadrotor(y, dy),
        "reaction-wheels" => |_, y, dy| reaction_wheels(y, dy),
        "relativistic-constant-force" => |_, y, dy| relativistic_constant_force(2.0, 3.0, y, dy),
        "relativistic-particle" => |_, y, dy| relativistic_particle(2.0, 1.0, y, dy),
        "rigid-body-spring" => |_, y, dy| ON_SPRING.on_se3(y, dy),
        "rocking-block" => |_, y, dy| dy.copy_from_slice(&[y[2], 0.0, y[0] - 0.2 * y[1]]),
        "rocking-disk" => |_, y, dy| rocking_disk(y, dy),
        "rotating-oscillator" => |_, y, dy| rotating_oscillator(y, dy),
        "snakeboard" => |_, y, dy| snakeboard([0.0, 0.0], y, dy),
        "snakeboard-driven" => |t, y, dy| snakeboard([(2.0 * t).sin() / 2.0, (3.0 * t).cos() / 5.0], y, dy),
        "spherical-pendulum-cartesian" => |_, y, dy| spherical_pendulum(y, dy),
        "spherical-pendulum-meridian" => |_, y, dy| spherical_pendulum_on_meridians(y, dy),
        // σ = 1 slips, σ = 0 is held
        "stick-slip-block" => |t, y, dy| dy.copy_from_slice(&[y[2], 0.0, y[1] * (t / 2.0 - y[0] - 0.5)]),
        "stick-slip-sleigh" => |_, y, dy| stick_slip_sleigh(y, dy),
        "stiff-sleigh" => stiff_sleigh,
        "suslov" => |_, y, dy| suslov(y, dy),
        "suslov-in-gravity" => |_, y, dy| suslov_in_gravity(y, dy),
        "tilted-disk" => |_, y, dy| tilted_disk(y, dy),
        "toda-chain" => |_, y, dy| toda_chain(y, dy),
        "turning-hoop" => turning_hoop,
        "turning-wire" => turning_wire,
        "turntable" => |_, y, dy| ball_on_turntable(2.0, 0.0, y, dy),
        "turntable-accelerated" => |t, y, dy| ball_on_turntable(1.0 + t / 4.0, 0.25, y, dy),
        "vertical-disk" => |_, y, dy| vertical_disk(y, dy),
        "vertical-disk-driven" => |_, y, dy| vertical_disk_driven(0.3, y, dy),
        "voronets" => |_, y, dy| voronets(None, y, dy),
        "voronets-rheonomic" => |t, y, dy| voronets(Some([t.cos() / 2.0, -t.sin() / 2.0]), y, dy),
        _ => return None,
    })
}

/// A random time and state at which the equations of a built-in model are regular, or `None` for a name not in
/// [`MODELS`].
///
/// Kept away from the poles of Euler's angles (θ between 0.4 and 2.6), from the centre of polar coordinates
/// (ρ between 0.5 and 2) and from the velocity of light (speed at most 0.9 c), from horizontal links and the equator
/// and the poles of the sphere where the frame ends there, from pitch upright. Verticals, links and the quaternion of the heavy top are
/// not normalised: the equations hold off the unit sphere too. Those of the satellite, as printed, do not. Where the
/// velocities of coordinates are columns they satisfy the constraints, and the heading φ is below 1.2, where the
/// equations in ẋ and φ̇ alone are regular too.
pub fn sample(model: &str, rng: &mut SplitMix64) -> Option<(f64, Vec<f64>)> {
    Some(match model {
        "ball-in-cylinder" | "turntable" => (0.0, rng.normals(9)),
        "carriage" => {
            let mut y = rng.normals(10);
            y[2] = rng.uniform(-1.2, 1.2);
            let [v, turn] = [y[5], y[7]];
            (y[5], y[6]) = (v * y[2].cos(), v * y[2].sin());
            (y[8], y[9]) = ((v - 0.4 * turn) / 0.2, (v + 0.4 * turn) / 0.2);
            (0.0, y)
        }
        "chaplygin-sleigh" | "nonholonomic-particle" | "voronets" => (0.0, rng.normals(5)),
        "charged-particle" | "charged-particle-induction" => {
            let t = rng.uniform(0.0, 3.0);
            let mut y = vec![rng.uniform(0.5, 2.0)];
            y.extend(rng.normals(3));
            (t, y)
        }
        "damped-oscillator" | "damped-oscillator-scaled-frame" => (rng.uniform(0.0, 3.0), rng.normals(2)),
        "bouncing-ball" => (0.0, rng.normals(2)),
        "rocking-block" | "rocking-disk" => (0.0, rng.normals(3)),
        "stick-slip-block" => (rng.uniform(0.0, 3.0), rng.normals(3)),
        "stick-slip-sleigh" => (0.0, rng.normals(6)),
        "double-pendulum-cartesian" | "double-pendulum-links" => {
            let mut y = hanging_links(rng, 2);
            y.extend(rng.normals(2));
            (0.0, y)
        }
        "euler-top" => (0.0, rng.normals(3)),
        "gimbals" => (0.0, rng.normals(6)),
        "gravity-gradient" => {
            let mut y = rng.normals(13);
            for (part, length) in [(0..3, 2.0), (3..7, 1.0)] {
                let norm = y[part.clone()].iter().map(|v| v * v).sum::<f64>().sqrt();
                y[part].iter_mut().for_each(|v| *v *= length / norm);
            }
            (0.0, y)
        }
        "heavy-top-euler" | "heavy-top-euler-symmetric" => {
            let mut y: Vec<f64> = (0..3).map(|_| rng.uniform(0.4, 2.6)).collect();
            y.extend(rng.normals(3));
            (0.0, y)
        }
        "heavy-top-goryachev-chaplygin" | "heavy-top-kovalevskaya" | "heavy-top-lagrange" => {
            (0.0, rng.normals(6))
        }
        "heavy-top-quaternion" => (0.0, rng.normals(7)),
        "pendulum-chain" => (0.0, rng.normals(8)),
        "pendulum-chain-cartesian" => {
            let mut y = hanging_links(rng, 4);
            y.extend(rng.normals(4));
            (0.0, y)
        }
        "quadrotor" => {
            let mut y = rng.normals(12);
            y[4] = rng.uniform(-1.2, 1.2);
            (0.0, y)
        }
        "reaction-wheels" => (0.0, rng.normals(11)),
        "relativistic-constant-force" => (0.0, vec![rng.normal(), rng.uniform(-1.8, 1.8)]),
        "relativistic-particle" => {
            let (radius, angle) = (rng.uniform(0.5, 2.0), rng.normal());
            let (speed, direction) = (rng.uniform(0.0, 1.8), rng.uniform(0.0, std::f64::consts::TAU));
            (0.0, vec![radius, angle, speed * direction.cos(), speed * direction.sin()])
        }
        "rigid-body-spring" => {
            let mut y = rng.normals(13);
            let length = y[3..7].iter().map(|q| q * q).sum::<f64>().sqrt();
            y[3..7].iter_mut().for_each(|q| *q /= length);
            (0.0, y)
        }
        "rotating-oscillator" => (0.0, rng.normals(4)),
        "spherical-pendulum-cartesian" | "spherical-pendulum-meridian" => {
            let (angle, rho) = (rng.uniform(-3.0, 3.0), rng.uniform(0.3, 1.5));
            let mut y = vec![rho * angle.cos(), rho * angle.sin(), rng.uniform(-1.5, -0.3)];
            y.extend(rng.normals(2));
            (0.0, y)
        }
        "snakeboard" | "snakeboard-driven" => (rng.uniform(0.0, 3.0), rng.normals(8)),
        "stiff-sleigh" | "voronets-rheonomic" => (rng.uniform(0.0, 3.0), rng.normals(5)),
        "appell-hamel" | "suslov" | "suslov-in-gravity" | "vertical-disk-driven" => (0.0, rng.normals(6)),
        "tilted-disk" => {
            let mut y = rng.normals(8);
            y[3] = rng.uniform(0.4, 2.6);
            (0.0, y)
        }
        "toda-chain" => (0.0, rng.normals(12)),
        "turning-hoop" => {
            let (t, radius, angle) = (rng.uniform(0.0, 3.0), rng.uniform(0.5, 2.0), rng.uniform(-3.0, 3.0));
            let rho = radius * angle.sin();
            let place = [rho * (3.0 * t).cos(), rho * (3.0 * t).sin(), -radius * angle.cos()];
            (t, vec![place[0], place[1], place[2], rng.normal()])
        }
        "turning-wire" => {
            let (t, distance) = (rng.uniform(0.0, 3.0), rng.normal());
            (t, vec![distance * t.cos(), distance * t.sin(), rng.normal()])
        }
        "turntable-accelerated" => (rng.uniform(0.0, 3.0), rng.normals(9)),
        "vertical-disk" => {
            let mut y = rng.normals(8);
            y[2] = rng.uniform(-1.2, 1.2);
            (y[4], y[5]) = (0.5 * y[7] * y[2].cos(), 0.5 * y[7] * y[2].sin());
            (0.0, y)
        }
        _ => return None,
    })
}

/// Places of the ends of links of lengths from 0.5 to 1.5, each at most 1.2 from the vertical, hanging on each other.
fn hanging_links(rng: &mut SplitMix64, links: usize) -> Vec<f64> {
    let mut end = [0.0; 2];
    let ends = (0..links).flat_map(|_| {
        let (angle, length) = (rng.uniform(-1.2, 1.2), rng.uniform(0.5, 1.5));
        end = [end[0] + length * angle.sin(), end[1] - length * angle.cos()];
        end
    });
    ends.collect()
}
