//! Where quasi-velocities that are defined by velocities determine these.

use pc_algebra::Matrix;
use pc_expr::{Backend, Evaluator, Expr, Inputs, Program};

use crate::error::MechError;
use crate::numeric::singular_values::SingularValues;
use crate::system::system::System;

/// A part of the velocities that is rounding: what the motion is without it is what it is with it.
const AT_REST: f64 = 1e-9;

/// The matrix a of η = a ẋ + a_0 along a motion.
///
/// Where det a = 0 the state (x, η) says nothing of ẋ along ker a. All motions that come there have the same state, whatever
/// this part of ẋ was, so that what follows is an accident of rounding. Its passages are seen by the sign of det a at the ends
/// of a step; two within one step are not, nor one at which det a has a double zero.
#[derive(Clone, Debug)]
pub(crate) struct Chart {
    coordinates: usize,
    parameters: usize,
    entries: Evaluator,
    /// Rows of the matrix, and whether its columns belong to ẋ.
    size: usize,
    of_velocities: bool,
    room: Vec<f64>,
}

impl Chart {
    /// That of a system; none where its quasi-velocities are not defined so, or a is constant.
    ///
    /// # Errors
    /// [`MechError`] for a symbol without a value.
    pub(crate) fn of(system: &System<'_>) -> Result<Option<Chart>, MechError> {
        match system.frame().definition_matrix() {
            Some(a) => Chart::watching(system, a, true),
            None => Ok(None),
        }
    }

    /// That of a system whose quasi-velocities, all of them in their order, are changed by the matrix A: det A a where they are
    /// defined by ẋ, else det A.
    ///
    /// # Errors
    /// [`MechError`] for a symbol without a value.
    pub(crate) fn of_change<'g>(
        system: &System<'g>,
        change: &Matrix<Expr<'g>>,
    ) -> Result<Option<Chart>, MechError> {
        let (graph, frame) = (system.graph(), system.frame());
        let Some(a) = frame.definition_matrix() else {
            let of_velocities = frame.velocities(system.quasi_velocities()) == system.quasi_velocities();
            return Chart::watching(system, change, of_velocities);
        };
        let product = Matrix::from_fn(change.rows(), a.columns(), |u, i| {
            graph.dot(change.row(u).iter().copied(), a.column(i))
        });
        Chart::watching(system, &product, true)
    }

    /// The sign of the determinant of a square matrix; none where it is constant.
    pub(crate) fn watching<'g>(
        system: &System<'g>,
        a: &Matrix<Expr<'g>>,
        of_velocities: bool,
    ) -> Result<Option<Chart>, MechError> {
        let frame = system.frame();
        let moving = || frame.coordinates().iter().copied().chain([frame.time()]);
        let written = a.nonzero_entries();
        if !moving().any(|symbol| written.iter().any(|entry| entry.depends_on(symbol))) {
            return Ok(None);
        }
        let inputs = Inputs {
            time: Some(frame.time()),
            state: frame.coordinates().to_vec(),
            parameters: system.parameters().iter().map(|&(symbol, _)| symbol).collect(),
        };
        let entries =
            Evaluator::new(Program::new(system.graph(), &inputs, &a.entries())?, Backend::Interpreter);
        let (coordinates, parameters) = (inputs.state.len(), inputs.parameters.len());
        let size = a.rows();
        let room = vec![0.0; size * size];
        Ok(Some(Chart { coordinates, parameters, entries, size, of_velocities, room }))
    }

    /// a at (t, y), row after row.
    fn matrix(&mut self, t: f64, y: &[f64], parameters: &[f64]) -> &mut [f64] {
        self.entries.eval(t, &y[..self.coordinates], &parameters[..self.parameters], &mut self.room);
        &mut self.room
    }

    /// Whether det a has another sign at the end of a step than at its start.
    pub(crate) fn is_left(&mut self, from: (f64, &[f64]), to: (f64, &[f64]), parameters: &[f64]) -> bool {
        let n = self.size;
        let mut sign = |(t, y): (f64, &[f64])| sign_of_determinant(self.matrix(t, y, parameters), n);
        sign(from) * sign(to) < 0.0
    }

    /// Whether a motion with these velocities does not move along the direction in which a is nearest to singular: then it needs
    /// no quasi-velocity to say how it does. Said of no motion where the directions are not those of ẋ.
    pub(crate) fn rests(&mut self, (t, y): (f64, &[f64]), velocities: &[f64], parameters: &[f64]) -> bool {
        let n = self.size;
        if !self.of_velocities {
            return false;
        }
        let entries = self.matrix(t, y, parameters);
        let a = Matrix::from_fn(n, n, |i, j| entries[i * n + j]);
        let Ok(SingularValues { right, .. }) = SingularValues::of(&a) else {
            return false;
        };
        let last = right.columns() - 1;
        let along: f64 = velocities.iter().enumerate().map(|(i, v)| right[(i, last)] * v).sum();
        along.abs() <= AT_REST * velocities.iter().fold(0.0f64, |largest, v| largest.max(v.abs()))
    }
}

/// The sign of det A, n × n and row after row, by elimination with row pivots; 0 where a pivot is 0 or no number.
fn sign_of_determinant(a: &mut [f64], n: usize) -> f64 {
    let at = |i: usize, j: usize| i * n + j;
    let mut sign = 1.0;
    for k in 0..n {
        let Some(best) = (k..n).max_by(|&i, &j| a[at(i, k)].abs().total_cmp(&a[at(j, k)].abs())) else {
            break;
        };
        let pivot = a[at(best, k)];
        if pivot == 0.0 || pivot.is_nan() {
            return 0.0;
        }
        sign *= if best == k { pivot.signum() } else { -pivot.signum() };
        for j in k..n {
            a.swap(at(k, j), at(best, j));
        }
        for i in k + 1..n {
            let factor = a[at(i, k)] / pivot;
            for j in k..n {
                a[at(i, j)] -= factor * a[at(k, j)];
            }
        }
    }
    sign
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn determinants_have_the_sign_of_their_permutation() {
        let of = |rows: [[f64; 3]; 3]| sign_of_determinant(&mut rows.concat(), 3);
        assert_eq!(of([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]), 1.0);
        assert_eq!(of([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 2.0]]), -1.0);
        // 1 (4·1 − 1·2) − 2 (3·1 − 1·1) + 0 = −2
        assert_eq!(of([[1.0, 2.0, 0.0], [3.0, 4.0, 1.0], [1.0, 2.0, 1.0]]), -1.0);
        assert_eq!(of([[1.0, 2.0, 0.0], [2.0, 4.0, 0.0], [1.0, 2.0, 1.0]]), 0.0);
    }
}
