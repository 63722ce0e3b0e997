//! Vectors and matrices with three components.

use pc_algebra::Matrix;
use pc_expr::{Expr, Graph};

/// A vector with components along three axes.
pub(crate) type Vector<'g> = [Expr<'g>; 3];

/// A matrix with three rows and columns.
pub(crate) type Tensor<'g> = [[Expr<'g>; 3]; 3];

pub(crate) const ZERO: Vector<'static> = [Expr::ZERO; 3];

/// The unit matrix.
pub(crate) fn unit<'g>() -> Tensor<'g> {
    tensor(|i, j| if i == j { Expr::ONE } else { Expr::ZERO })
}

pub(crate) fn vector<'g>(component: impl FnMut(usize) -> Expr<'g>) -> Vector<'g> {
    std::array::from_fn(component)
}

pub(crate) fn tensor<'g>(entry: impl Fn(usize, usize) -> Expr<'g>) -> Tensor<'g> {
    std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)))
}

/// The entries of a matrix with three rows and columns.
pub(crate) fn entries_of<'g>(matrix: &Matrix<Expr<'g>>) -> Tensor<'g> {
    tensor(|i, j| matrix[(i, j)])
}

pub(crate) fn matrix_of<'g>(tensor: &Tensor<'g>) -> Matrix<Expr<'g>> {
    Matrix::from_fn(3, 3, |i, j| tensor[i][j])
}

pub(crate) fn add<'g>(a: &Vector<'g>, b: &Vector<'g>) -> Vector<'g> {
    vector(|i| a[i] + b[i])
}

pub(crate) fn scaled<'g>(factor: Expr<'g>, a: &Vector<'g>) -> Vector<'g> {
    a.map(|component| factor * component)
}

pub(crate) fn dot<'g>(graph: &'g Graph, a: &Vector<'g>, b: &Vector<'g>) -> Expr<'g> {
    graph.dot(a.iter().copied(), b.iter().copied())
}

pub(crate) fn cross<'g>(a: &Vector<'g>, b: &Vector<'g>) -> Vector<'g> {
    vector(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3])
}

/// A v
pub(crate) fn apply<'g>(graph: &'g Graph, a: &Tensor<'g>, v: &Vector<'g>) -> Vector<'g> {
    vector(|i| dot(graph, &a[i], v))
}

/// Aᵀ v
pub(crate) fn apply_transpose<'g>(graph: &'g Graph, a: &Tensor<'g>, v: &Vector<'g>) -> Vector<'g> {
    apply(graph, &transpose(a), v)
}

pub(crate) fn transpose<'g>(a: &Tensor<'g>) -> Tensor<'g> {
    tensor(|i, j| a[j][i])
}

/// A B
pub(crate) fn product<'g>(graph: &'g Graph, a: &Tensor<'g>, b: &Tensor<'g>) -> Tensor<'g> {
    let b = transpose(b);
    tensor(|i, j| dot(graph, &a[i], &b[j]))
}

/// A B Aᵀ
pub(crate) fn congruent<'g>(graph: &'g Graph, a: &Tensor<'g>, b: &Tensor<'g>) -> Tensor<'g> {
    product(graph, &product(graph, a, b), &transpose(a))
}
