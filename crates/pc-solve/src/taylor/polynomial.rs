//! The polynomial of a step.

/// The polynomial y(t₀ + s) = Σ_k c_k sᵏ; the coefficients, each as long as the state, are stored
/// with c_0 first.
#[derive(Debug, Clone)]
pub(super) struct Polynomial {
    pub(super) coefficients: Vec<f64>,
    pub(super) dim: usize,
}

impl Polynomial {
    pub(super) fn new(dim: usize, order: usize) -> Polynomial {
        Polynomial { coefficients: vec![0.0; dim * (order + 1)], dim }
    }

    pub(super) fn order(&self) -> usize {
        self.coefficients.len() / self.dim - 1
    }

    pub(super) fn of_order(&self, k: usize) -> &[f64] {
        &self.coefficients[k * self.dim..][..self.dim]
    }

    pub(super) fn of_order_mut(&mut self, k: usize) -> &mut [f64] {
        &mut self.coefficients[k * self.dim..][..self.dim]
    }

    /// Whether all coefficients are finite.
    pub(super) fn is_finite(&self) -> bool {
        // One pass without branches: c · 0 is NaN unless c is finite, and a NaN persists. Each sum waits for its
        // last term, so that there are several.
        let mut sums = [0.0; 8];
        let blocks = self.coefficients.chunks_exact(sums.len());
        let rest = blocks.remainder().iter().fold(0.0, |sum, c| sum + c * 0.0);
        for block in blocks {
            for (sum, c) in sums.iter_mut().zip(block) {
                *sum += c * 0.0;
            }
        }
        sums.iter().sum::<f64>() + rest == 0.0
    }

    /// Writes y(s) − y(0) and ẏ(s).
    pub(super) fn change(&self, s: f64, change: &mut [f64], slope: &mut [f64]) {
        let p = self.order();
        change.copy_from_slice(self.of_order(p));
        slope.fill(0.0);
        for k in (1..p).rev() {
            let terms = self.of_order(k);
            for ((change, slope), term) in change.iter_mut().zip(&mut *slope).zip(terms) {
                *slope = *slope * s + *change;
                *change = *change * s + term;
            }
        }
        for (change, slope) in change.iter_mut().zip(slope) {
            *slope = *slope * s + *change;
            *change *= s;
        }
    }

    /// Writes the derivative of this order at s.
    pub(super) fn derivative(&self, s: f64, order: usize, state: &mut [f64]) {
        state.fill(0.0);
        for k in (order..=self.order()).rev() {
            let factor = (k + 1 - order..=k).fold(1.0, |factor, j| factor * j as f64);
            for (state, term) in state.iter_mut().zip(self.of_order(k)) {
                *state = *state * s + factor * term;
            }
        }
    }
}
