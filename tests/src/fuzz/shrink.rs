//! Shorter models that have the same finding.

use std::time::{Duration, Instant};

use super::examination::{Examined, Thoroughness, examine_specimen};
use super::expression::Expression;
use super::specimen::{Frame, Specimen};

/// A model is shrunk for no longer.
const LIMIT: Duration = Duration::from_secs(40);

/// The shortest specimen that was found to have a finding of this kind, with what came of it.
pub fn shrink(specimen: &Specimen, kind: &str, thoroughness: &Thoroughness) -> (Specimen, Examined) {
    let end = Instant::now() + LIMIT;
    let mut best = (specimen.clone(), examine_specimen(specimen, thoroughness.clone()));
    let mut place = 0;
    while Instant::now() < end {
        // On from where the last one was found: what was tried before it is not worth while once more at once.
        let candidates = candidates(&best.0);
        let order = (0..candidates.len()).map(|i| (i + place) % candidates.len());
        let shorter = order.take_while(|_| Instant::now() < end).find_map(|i| {
            let examined = examine_specimen(&candidates[i], thoroughness.clone());
            examined.has(kind).then(|| (i, candidates[i].clone(), examined))
        });
        let Some((i, specimen, examined)) = shorter else { break };
        place = i;
        best = (specimen, examined);
    }
    best
}

/// The specimen with one part less, whole sections first.
fn candidates(specimen: &Specimen) -> Vec<Specimen> {
    let mut candidates = Vec::new();
    let mut without = |change: &dyn Fn(&mut Specimen)| {
        let mut candidate = specimen.clone();
        change(&mut candidate);
        candidates.push(candidate);
    };
    for (count, remove) in lists(specimen) {
        (0..count).for_each(|i| without(&|specimen| remove(specimen, i)));
    }
    if let Frame::Triangular(frame) = &specimen.frame {
        for i in 0..frame.lower.len() {
            without(&|specimen| {
                if let Frame::Triangular(frame) = &mut specimen.frame {
                    frame.lower.remove(i);
                }
            });
        }
        if specimen.carried.is_empty() {
            for i in 0..frame.eta.len() {
                let one = Expression::Number(1.0);
                without(&|specimen| {
                    if let Frame::Triangular(frame) = &mut specimen.frame {
                        frame.diagonal[i] = one.clone();
                        frame.drift[i] = Expression::Number(0.0);
                    }
                });
            }
        }
    }
    // The rates of carried coordinates are written out: a change of the frame would belie them.
    let fixed = match &specimen.frame {
        Frame::Triangular(frame) if !specimen.carried.is_empty() => 2 * frame.eta.len() + frame.lower.len(),
        _ => 0,
    };
    let count = specimen.clone().expressions_mut().len();
    for place in fixed..count {
        let smaller = specimen.clone().expressions_mut()[place].smaller();
        for expression in smaller {
            let mut candidate = specimen.clone();
            *candidate.expressions_mut()[place] = expression;
            candidates.push(candidate);
        }
    }
    candidates
}

type Remove = fn(&mut Specimen, usize);

/// The lists of a specimen, each with its length and how an entry is removed.
fn lists(specimen: &Specimen) -> [(usize, Remove); 12] {
    [
        (specimen.events.len(), |specimen, i| _ = specimen.events.remove(i)),
        (specimen.bodies.len(), |specimen, i| _ = specimen.bodies.remove(i)),
        (specimen.constraints.len(), |specimen, i| _ = specimen.constraints.remove(i)),
        (usize::from(specimen.gravity.is_some()), |specimen, _| specimen.gravity = None),
        (specimen.states.len(), |specimen, i| _ = specimen.states.remove(i)),
        (specimen.inputs.len(), |specimen, i| _ = specimen.inputs.remove(i)),
        (specimen.forces.len(), |specimen, i| _ = specimen.forces.remove(i)),
        (specimen.dissipation.len(), |specimen, i| _ = specimen.dissipation.remove(i)),
        (specimen.potential.len(), |specimen, i| _ = specimen.potential.remove(i)),
        (specimen.outputs.len(), |specimen, i| _ = specimen.outputs.remove(i)),
        (specimen.kinetic.len(), |specimen, i| _ = specimen.kinetic.remove(i)),
        (specimen.carried.len(), |specimen, i| _ = specimen.carried.remove(i)),
    ]
}
