//! The size of the largest eigenvalue of ∂f/∂y along a motion.
//!
//! ```text
//! ρ = ‖f(t, y + ε v) − f(t, y)‖ / ε, then v ← that direction; norms weighed by the tolerances, ‖v‖ = 1
//! ```
//! is a step of the power iteration, which is continued from state to state: ∂f/∂y changes little
//! from one step to the next.

/// The power iteration.
#[derive(Debug, Clone)]
pub(super) struct Growth {
    /// The current state, and the tolerances at that state.
    y: Vec<f64>,
    tolerances: Vec<f64>,
    direction: Vec<f64>,
    state: Vec<f64>,
    rates: [Vec<f64>; 2],
    /// The latest estimates; the largest one is used.
    recent: [f64; RECENT],
    count: usize,
}

/// The number of estimates whose maximum is used: the estimates rise and fall where ∂f/∂y rotates
/// vectors.
const RECENT: usize = 6;
/// The size of ε relative to the size of the state: the square root of the relative rounding error
/// of f.
const RELATIVE: f64 = 1.5e-8;

impl Growth {
    pub(super) fn new(dim: usize) -> Growth {
        Growth {
            y: vec![0.0; dim],
            tolerances: vec![0.0; dim],
            direction: vec![0.0; dim],
            state: vec![0.0; dim],
            rates: [vec![0.0; dim], vec![0.0; dim]],
            recent: [0.0; RECENT],
            count: 0,
        }
    }

    /// Restarts the iteration for another motion.
    pub(super) fn forget(&mut self) {
        self.count = 0;
        self.direction.fill(0.0);
    }

    /// Moves to the state y, with these tolerances.
    pub(super) fn stand(&mut self, y: &[f64], tolerance: impl Fn(usize, f64) -> f64) {
        self.y.copy_from_slice(y);
        for (i, of) in self.tolerances.iter_mut().enumerate() {
            *of = tolerance(i, y[i]);
        }
    }

    /// Makes one step of the iteration, with f evaluated by `look`, and returns ρ, or none if f
    /// fails or there are not yet enough estimates.
    pub(super) fn estimate(&mut self, mut look: impl FnMut(&[f64], &mut [f64]) -> bool) -> Option<f64> {
        let Growth { y, tolerances, direction, state, rates: [here, there], recent, count } = self;
        let norm = |v: &[f64]| {
            let weighed = v.iter().zip(&*tolerances).map(|(v, tolerance)| v / tolerance);
            weighed.map(|v| v * v).sum::<f64>().sqrt()
        };
        if !look(y, here) {
            return None;
        }
        let mut length = norm(direction);
        if length == 0.0 {
            // Any direction that is not an eigenvector by accident: decreasing multiples of the
            // tolerances.
            for (i, v) in direction.iter_mut().enumerate() {
                *v = tolerances[i] / (1.0 + i as f64);
            }
            length = norm(direction);
        }
        let epsilon = RELATIVE * norm(y).max(1.0) / length;
        for ((state, y), v) in state.iter_mut().zip(&*y).zip(&*direction) {
            *state = y + epsilon * v;
        }
        if !look(state, there) {
            return None;
        }
        for ((v, there), here) in direction.iter_mut().zip(&*there).zip(&*here) {
            *v = there - here;
        }
        let rho = norm(direction) / (epsilon * length);
        if !rho.is_finite() {
            self.forget();
            return None;
        }
        recent[*count % RECENT] = rho;
        *count += 1;
        (*count >= RECENT).then(|| recent.iter().copied().fold(0.0, f64::max))
    }
}
