//! How fast the last steps have moved the state.

/// The number of steps that are remembered.
const REMEMBERED: usize = 3;
/// The state is taken to move at most this many times as fast in the next step as in the last ones: where it
/// moved faster, the step would not have the accuracy for which its length was chosen.
const MARGIN: f64 = 4.0;

/// The mean speeds of the components of the state in the last steps.
#[derive(Debug)]
pub(super) struct Pace {
    t: f64,
    state: Vec<f64>,
    speeds: [Vec<f64>; REMEMBERED],
    /// How many steps have been taken, of which the speeds of the last ones are known.
    steps: usize,
}

impl Pace {
    pub(super) fn new(dim: usize) -> Pace {
        Pace { t: f64::NAN, state: vec![0.0; dim], speeds: std::array::from_fn(|_| vec![0.0; dim]), steps: 0 }
    }

    /// Forgets the steps, since another motion begins.
    pub(super) fn forget(&mut self) {
        (self.t, self.steps) = (f64::NAN, 0);
    }

    /// Notes the state at the end of a step.
    pub(super) fn arrive(&mut self, t: f64, state: &[f64]) {
        if t == self.t {
            return;
        }
        if !self.t.is_nan() {
            let length = (t - self.t).abs();
            let speeds = &mut self.speeds[self.steps % REMEMBERED];
            for ((speed, y), before) in speeds.iter_mut().zip(state).zip(&self.state) {
                *speed = (y - before).abs() / length;
            }
            self.steps += 1;
        }
        self.t = t;
        self.state.copy_from_slice(state);
    }

    /// A range that component `i` does not leave in the next step, of this length: its middle and radius. None
    /// after fewer steps than are remembered.
    pub(super) fn range(&self, i: usize, length: f64) -> Option<(f64, f64)> {
        let fastest = self.speeds.iter().map(|speeds| speeds[i]).fold(0.0, f64::max);
        (self.steps >= REMEMBERED).then(|| (self.state[i], MARGIN * fastest * length))
    }
}
