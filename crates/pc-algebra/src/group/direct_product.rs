//! Direct products of groups.

use nalgebra::DMatrix;
use pc_expr::Expr;

use crate::error::AlgebraError;
use crate::group::group::{LieGroup, Side};
use crate::lie_algebra::lie_algebra::LieAlgebra;
use crate::linear_algebra::matrix::Matrix;

/// The direct product G × H. Its coordinates are those of G, then those of H, and every
/// operation acts on each part separately.
///
/// `_2` is appended, several times if necessary, to the names of those coordinates of H whose names also
/// occur in G.
///
/// ```
/// use pc_algebra::{DirectProduct, LieGroup, PlaneRotations, UnitQuaternions};
///
/// let rotor_in_a_body = DirectProduct::new(UnitQuaternions, PlaneRotations);
/// assert_eq!(rotor_in_a_body.coordinates(), ["q0", "q1", "q2", "q3", "phi"]);
/// assert_eq!(rotor_in_a_body.dim(), 4);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DirectProduct<G, H> {
    first: G,
    second: H,
    coordinates: usize,
    dim: usize,
}

impl<G: LieGroup, H: LieGroup> DirectProduct<G, H> {
    /// G × H
    pub fn new(first: G, second: H) -> DirectProduct<G, H> {
        let (coordinates, dim) = (first.coordinates().len(), first.dim());
        DirectProduct { first, second, coordinates, dim }
    }

    /// Applies `f` to the first part of an element and `h` to the second, and concatenates the results.
    fn joined<'a>(
        &self,
        g: &'a [f64],
        at: usize,
        f: impl Fn(&G, &'a [f64]) -> Vec<f64>,
        h: impl Fn(&H, &'a [f64]) -> Vec<f64>,
    ) -> Vec<f64> {
        let (a, b) = g.split_at(at);
        [f(&self.first, a), h(&self.second, b)].concat()
    }
}

impl<G: LieGroup, H: LieGroup> LieGroup for DirectProduct<G, H> {
    fn algebra(&self) -> LieAlgebra {
        self.first.algebra().direct_product(&self.second.algebra())
    }

    fn coordinates(&self) -> Vec<String> {
        let mut names = self.first.coordinates();
        for mut name in self.second.coordinates() {
            while names.contains(&name) {
                name.push_str("_2");
            }
            names.push(name);
        }
        names
    }

    fn identity(&self) -> Vec<f64> {
        [self.first.identity(), self.second.identity()].concat()
    }

    fn compose(&self, g: &[f64], h: &[f64]) -> Vec<f64> {
        let (a, b) = h.split_at(self.coordinates);
        self.joined(g, self.coordinates, |group, g| group.compose(g, a), |group, g| group.compose(g, b))
    }

    fn inverse(&self, g: &[f64]) -> Vec<f64> {
        self.joined(g, self.coordinates, G::inverse, H::inverse)
    }

    fn exp(&self, x: &[f64]) -> Vec<f64> {
        self.joined(x, self.dim, G::exp, H::exp)
    }

    fn log(&self, g: &[f64]) -> Vec<f64> {
        self.joined(g, self.coordinates, G::log, H::log)
    }

    fn adjoint(&self, g: &[f64]) -> DMatrix<f64> {
        let (a, b) = g.split_at(self.coordinates);
        block_diagonal(&self.first.adjoint(a), &self.second.adjoint(b))
    }

    fn dexp(&self, side: Side, x: &[f64]) -> DMatrix<f64> {
        let (a, b) = x.split_at(self.dim);
        block_diagonal(&self.first.dexp(side, a), &self.second.dexp(side, b))
    }

    fn dexp_inverse(&self, side: Side, x: &[f64]) -> DMatrix<f64> {
        let (a, b) = x.split_at(self.dim);
        block_diagonal(&self.first.dexp_inverse(side, a), &self.second.dexp_inverse(side, b))
    }

    fn distance(&self, g: &[f64], h: &[f64]) -> f64 {
        let ((a, b), (c, d)) = (g.split_at(self.coordinates), h.split_at(self.coordinates));
        self.first.distance(a, c).max(self.second.distance(b, d))
    }

    fn project(&self, g: &[f64]) -> Result<Vec<f64>, AlgebraError> {
        let (a, b) = g.split_at(self.coordinates);
        Ok([self.first.project(a)?, self.second.project(b)?].concat())
    }

    fn operators<'g>(&self, side: Side, x: &[Expr<'g>]) -> Matrix<Expr<'g>> {
        let (a, b) = x.split_at(self.coordinates);
        let (a, b) = (self.first.operators(side, a), self.second.operators(side, b));
        let (rows, columns) = (a.rows(), a.columns());
        Matrix::from_fn(rows + b.rows(), columns + b.columns(), |i, s| match (i < rows, s < columns) {
            (true, true) => a[(i, s)],
            (false, false) => b[(i - rows, s - columns)],
            _ => Expr::ZERO,
        })
    }
}

fn block_diagonal(a: &DMatrix<f64>, b: &DMatrix<f64>) -> DMatrix<f64> {
    let (n, m) = (a.nrows(), b.nrows());
    let mut matrix = DMatrix::zeros(n + m, n + m);
    matrix.view_mut((0, 0), (n, n)).copy_from(a);
    matrix.view_mut((n, n), (m, m)).copy_from(b);
    matrix
}
