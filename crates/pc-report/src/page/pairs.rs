//! The most informative pairs of columns of a motion, to be plotted against each other.

use pc_model::Assembly;

use crate::picture::motion::{are_alike, moves};
use crate::recording::{ColumnKind, Recording};

/// The pairs of each coordinate with the quasi-velocity that is its rate, then of successive components of
/// one vector; columns that do not change are left out.
pub(super) fn pairs(assembly: &Assembly<'_>, record: &Recording) -> Vec<(String, String)> {
    let (system, samples) = (&assembly.system, record.curves());
    let shown = |name: &str| samples.column(name).is_ok_and(|(_, values)| moves(values));
    let eta = system.quasi_velocities();
    let rates = system.frame().velocities(eta);
    let mut pairs: Vec<(String, String)> = Vec::new();
    for (x, rate) in system.frame().coordinates().iter().zip(&rates) {
        if let Some(velocity) = eta.iter().find(|velocity| *velocity == rate) {
            pairs.push((x.to_string(), velocity.to_string()));
        }
    }
    let vectors = samples
        .columns
        .iter()
        .filter(|columns| matches!(columns.kind, ColumnKind::Coordinates | ColumnKind::QuasiVelocities))
        .flat_map(|columns| columns.list.windows(2))
        .map(|pair| (pair[0].0.clone(), pair[1].0.clone()))
        .filter(|(a, b)| are_alike(a, b));
    pairs.extend(vectors);
    pairs.retain(|(a, b)| shown(a) && shown(b));
    pairs
}
