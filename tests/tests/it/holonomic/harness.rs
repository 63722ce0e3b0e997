//! What is asked of a motion: its rates of change at random states, and the place where it arrives.

use pc_mech::{Expr, Graph, Motion, System, SystemBuilder, VectorField};
use pc_solve::{Method, Options, solve};
use pc_tests::classical::SplitMix64;

/// A system as its text would say it: names, ẋ(t, x, η) and L(t, x, η).
#[derive(Clone, Copy)]
pub(super) struct Description {
    pub(super) coordinates: &'static [&'static str],
    pub(super) quasi_velocities: &'static [&'static str],
    pub(super) velocities: for<'g> fn(Expr<'g>, &[Expr<'g>], &[Expr<'g>]) -> Vec<Expr<'g>>,
    pub(super) lagrangian: for<'g> fn(Expr<'g>, &[Expr<'g>], &[Expr<'g>]) -> Expr<'g>,
}

impl Description {
    pub(super) fn builder<'g>(&self, graph: &'g Graph) -> SystemBuilder<'g> {
        System::builder(graph)
            .coordinates(self.coordinates)
            .quasi_velocities(self.quasi_velocities)
            .kinematics(self.velocities)
            .lagrangian(self.lagrangian)
    }
}

/// Random states at which two right-hand sides are compared.
pub(super) const STATES: usize = 200;

pub(super) fn normals<const N: usize>(random: &mut SplitMix64) -> [f64; N] {
    std::array::from_fn(|_| random.normal())
}

/// The derived equations, compiled.
pub(super) fn compiled(system: &System<'_>) -> Motion {
    system.poincare().unwrap().compile().unwrap()
}

/// (ẋ, η̇) at a state.
pub(super) fn rates(motion: &mut Motion, t: f64, y: &[f64]) -> Vec<f64> {
    let mut rates = vec![f64::NAN; y.len()];
    motion.rhs(t, y, &mut rates).unwrap_or_else(|error| panic!("{error}"));
    rates
}

/// Largest difference, relative to the largest entry of `expected` or to 1.
pub(super) fn distance(found: &[f64], expected: &[f64]) -> f64 {
    assert_eq!(found.len(), expected.len(), "length");
    let size = expected.iter().fold(1.0f64, |size, v| size.max(v.abs()));
    let differences = found.iter().zip(expected).map(|(f, e)| (f - e).abs());
    differences.fold(0.0f64, |worst, d| if d.is_nan() || d > worst { d } else { worst }) / size
}

/// The states at `times` of the motion from `start` at t = 0, by Adams' method with rtol = 1e-12, atol = 1e-14.
pub(super) fn integrate(motion: &mut Motion, start: &[f64], times: &[f64]) -> Vec<Vec<f64>> {
    let options = Options::new(Method::Adams).relative_tolerance(1e-12).absolute_tolerance(1e-14);
    let trajectory = solve(motion, 0.0, start, times, &options).unwrap_or_else(|failure| panic!("{failure}"));
    trajectory.iter().map(|(_, y)| y.to_vec()).collect()
}
