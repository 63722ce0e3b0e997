//! Shorter models that have the same finding.

use std::time::{Duration, Instant};

use super::examine_specimen;
use super::generator;
use crate::fuzz::examination::Examined;

/// A model is shrunk for no longer.
const LIMIT: Duration = Duration::from_secs(40);

/// The shortest of model number `index` that was found to have a finding of this kind.
pub fn shrink(seed: u64, index: u64, kind: &str, limit: Duration) -> Examined {
    let end = Instant::now() + LIMIT;
    let mut specimen = generator::specimen(seed, index);
    let mut best = examine_specimen(&specimen, limit);
    while Instant::now() < end {
        let candidates = specimen.shorter().into_iter().take_while(|_| Instant::now() < end);
        let shorter = candidates.map(|candidate| (examine_specimen(&candidate, limit), candidate));
        let Some((examined, shorter)) = shorter.into_iter().find(|(examined, _)| examined.has(kind)) else {
            break;
        };
        (best, specimen) = (examined, shorter);
    }
    best
}
