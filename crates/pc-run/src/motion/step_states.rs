//! A limited number of states at the ends of steps, however many steps there are.

/// The largest number of states kept from the first steps, and also from the later ones.
const MOST: usize = 64;

/// The states after the first steps of a motion, then after every n-th step, with n large enough that only a few
/// are kept. Rows may all fall on the same phase of an oscillation; steps do not, and they are dense where a
/// motion is fast.
#[derive(Clone, Debug)]
pub(crate) struct StepStates {
    first: Vec<(f64, Vec<f64>)>,
    later: Vec<(f64, Vec<f64>)>,
    stride: u64,
    steps: u64,
}

impl StepStates {
    pub(crate) fn new() -> StepStates {
        StepStates { first: Vec::new(), later: Vec::new(), stride: 1, steps: 0 }
    }

    pub(crate) fn note(&mut self, t: f64, y: &[f64]) {
        if self.first.len() < MOST {
            return self.first.push((t, y.to_vec()));
        }
        self.steps += 1;
        if !self.steps.is_multiple_of(self.stride) {
            return;
        }
        if self.later.len() == MOST {
            let mut place = 0;
            self.later.retain(|_| {
                place += 1;
                place % 2 == 0
            });
            self.stride *= 2;
        }
        self.later.push((t, y.to_vec()));
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = (f64, &[f64])> {
        self.first.iter().chain(&self.later).map(|(t, y)| (*t, y.as_slice()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_states_are_spread_over_many_steps() {
        let mut states = StepStates::new();
        (0..100_000).for_each(|step| states.note(f64::from(step), &[0.0]));
        let times: Vec<f64> = states.iter().map(|(t, _)| t).collect();
        assert!(
            times.len() <= 2 * MOST && times[..MOST].iter().zip(0..).all(|(t, step)| *t == f64::from(step))
        );
        assert!(times.windows(2).all(|pair| pair[0] < pair[1] && pair[1] - pair[0] <= 4096.0), "{times:?}");
        assert!(times.last().is_some_and(|last| *last > 95_000.0));
    }
}
