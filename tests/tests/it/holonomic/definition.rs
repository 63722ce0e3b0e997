//! Systems against the definition of their equations, with and without folding by value.

use pc_mech::{Graph, System};
use pc_tests::classical::SplitMix64;
use pc_tests::definition;

const STATES: usize = 100;
/// Coordinates and quasi-velocities are drawn so far about the centre of a system.
const SPREAD: f64 = 0.3;

/// Both foldings of a system agree with its definition at states about `centre`, (x, η), and times from 0 to
/// 2.
pub(super) fn assert_definition(name: &str, build: impl for<'g> Fn(&'g Graph) -> System<'g>, centre: &[f64]) {
    let sample = |random: &mut SplitMix64| {
        let t = random.uniform(0.0, 2.0);
        (t, centre.iter().map(|y| y + random.uniform(-SPREAD, SPREAD)).collect())
    };
    let worst = definition::assert_derived(name, build, 0, STATES, sample);
    println!("{name}: {worst:.1e} of the largest term");
}
