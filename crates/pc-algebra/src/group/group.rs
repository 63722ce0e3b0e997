//! The interface of Lie groups in coordinates: numbers for integrators, expressions for frames.

use nalgebra::DMatrix;
use pc_expr::{Expr, Graph};

pub use crate::group::direct_product::DirectProduct;
pub use crate::group::euler_angles::EulerAngles;
pub use crate::group::heisenberg::HeisenbergGroup;
pub use crate::group::plane_motions::PlaneMotions;
pub use crate::group::plane_rotations::PlaneRotations;
pub use crate::group::rigid_motions::RigidMotions;
pub use crate::group::rotation_matrices::RotationMatrices;
pub use crate::group::unit_quaternions::UnitQuaternions;

use crate::error::AlgebraError;
use crate::frame::frame::{Frame, shape};
use crate::lie_algebra::lie_algebra::LieAlgebra;
use crate::linear_algebra::matrix::Matrix;

/// How a velocity on a group is mapped to the algebra.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// η = g⁻¹ġ: body velocities, the left-invariant operators X_s.
    Left,
    /// η = ġg⁻¹: spatial velocities, the right-invariant operators X_s.
    Right,
}

/// A Lie group of dimension k, whose elements are given by n ≥ k coordinates.
///
/// Elements g are slices of length n, elements x of the algebra slices of length k in the basis of
/// [`algebra`](LieGroup::algebra). The coordinates may be redundant (n > k, as for a rotation matrix),
/// several values may represent the same element (angles), and the frame may be singular somewhere (Euler
/// angles); the documentation of each group says so.
///
/// # Panics
/// The numerical functions panic if a slice is shorter than these lengths.
///
/// ```
/// use pc_algebra::{LieGroup, RigidMotions};
///
/// let screw = RigidMotions.exp(&[0.0, 0.0, 1.0, 0.0, 0.0, 2.0]); // turn by 1 about z, advance by 2
/// let twice = RigidMotions.compose(&screw, &screw);
/// assert!((RigidMotions.log(&twice)[5] - 4.0).abs() < 1e-14);
/// ```
pub trait LieGroup {
    /// The Lie algebra, with the bracket of left-invariant operators: so(3) has \[X_1, X_2\] = X_3.
    fn algebra(&self) -> LieAlgebra;

    /// Usual names of the n coordinates.
    fn coordinates(&self) -> Vec<String>;

    /// The element 1.
    fn identity(&self) -> Vec<f64>;

    /// The product gh: first h, then g, if elements are motions.
    fn compose(&self, g: &[f64], h: &[f64]) -> Vec<f64>;

    /// g⁻¹
    fn inverse(&self, g: &[f64]) -> Vec<f64>;

    /// The element exp x, which the motion g⁻¹ġ = x reaches at time 1 if it starts at the identity.
    fn exp(&self, x: &[f64]) -> Vec<f64>;

    /// An x with exp x = g, on the branch stated for the group.
    fn log(&self, g: &[f64]) -> Vec<f64>;

    /// The k × k matrix of Ad_g x = g x g⁻¹.
    fn adjoint(&self, g: &[f64]) -> DMatrix<f64>;

    /// The derivative of exp at x, mapped to the algebra, as a k × k matrix: d/dε exp(x + εy) at ε = 0 is
    /// exp(x)·D(x)y with [`Side::Left`] and D(x)y·exp(x) with [`Side::Right`], where
    ///
    /// D(x) = (1 − e^(−ad x))/ad x = Σ (−ad x)^i/(i + 1)! with [`Side::Left`],
    /// D(x) = (e^(ad x) − 1)/ad x = Σ (ad x)^i/(i + 1)! with [`Side::Right`].
    fn dexp(&self, side: Side, x: &[f64]) -> DMatrix<f64>;

    /// The k × k inverse D(x)⁻¹ of [`dexp`](LieGroup::dexp): ẋ = D(x)⁻¹η for g = exp x.
    ///
    /// The inverse has poles where rotations by 2π and its multiples make D singular; the entries grow
    /// without bound there.
    fn dexp_inverse(&self, side: Side, x: &[f64]) -> DMatrix<f64>;

    /// A distance between two elements, measured by the entries that describe them; 0 only if they are the
    /// same.
    fn distance(&self, g: &[f64], h: &[f64]) -> f64;

    /// The element nearest to coordinates that have drifted off the group.
    ///
    /// # Errors
    /// [`AlgebraError::NoNearestElement`] if there is no nearest element.
    fn project(&self, g: &[f64]) -> Result<Vec<f64>, AlgebraError>;

    /// The n × k matrix b of ẋ = b η (3), at coordinates `x` of length n.
    fn operators<'g>(&self, side: Side, x: &[Expr<'g>]) -> Matrix<Expr<'g>>;

    /// Dimension k.
    fn dim(&self) -> usize {
        self.algebra().dim()
    }

    /// The k × k matrix of ad x = \[x, ·\].
    fn ad(&self, x: &[f64]) -> DMatrix<f64> {
        let (algebra, k) = (self.algebra(), x.len());
        DMatrix::from_fn(k, k, |m, s| (0..k).map(|r| algebra.constant(r, s, m).to_f64() * x[r]).sum())
    }

    /// The frame of body velocities, ẋ = b η with η = g⁻¹ġ: [X_r, X_s] = c_rs^m X_m with the constants c of
    /// [`algebra`](LieGroup::algebra).
    ///
    /// # Errors
    /// [`AlgebraError::Shape`] unless there are n coordinates.
    ///
    /// ```
    /// # use pc_algebra::{LieGroup, Neighbourhood, UnitQuaternions};
    /// # use pc_expr::Graph;
    /// let graph = Graph::new();
    /// let q = graph.symbols(["q0", "q1", "q2", "q3"]);
    /// let frame = UnitQuaternions.left_frame(&graph, graph.symbol("t"), q.to_vec())?;
    /// let c = frame.structure_coefficients(&Neighbourhood::default())?;
    /// assert_eq!(c.lie_algebra(), Some(UnitQuaternions.algebra()));
    /// # Ok::<(), pc_algebra::AlgebraError>(())
    /// ```
    fn left_frame<'g>(
        &self,
        graph: &'g Graph,
        time: Expr<'g>,
        coordinates: Vec<Expr<'g>>,
    ) -> Result<Frame<'g>, AlgebraError> {
        frame(self, Side::Left, graph, time, coordinates)
    }

    /// The frame of spatial velocities, ẋ = b η with η = ġg⁻¹: [X_r, X_s] = −c_rs^m X_m.
    ///
    /// # Errors
    /// [`AlgebraError::Shape`] unless there are n coordinates.
    fn right_frame<'g>(
        &self,
        graph: &'g Graph,
        time: Expr<'g>,
        coordinates: Vec<Expr<'g>>,
    ) -> Result<Frame<'g>, AlgebraError> {
        frame(self, Side::Right, graph, time, coordinates)
    }
}

fn frame<'g, G: LieGroup + ?Sized>(
    group: &G,
    side: Side,
    graph: &'g Graph,
    time: Expr<'g>,
    coordinates: Vec<Expr<'g>>,
) -> Result<Frame<'g>, AlgebraError> {
    shape("the list of coordinates", coordinates.len(), group.coordinates().len())?;
    let b = group.operators(side, &coordinates);
    let drift = vec![Expr::ZERO; coordinates.len()];
    Frame::new(graph, time, coordinates, b, drift)
}

/// Largest |g_i − h_i|.
pub(super) fn largest_difference(g: &[f64], h: &[f64]) -> f64 {
    g.iter().zip(h).fold(0.0, |largest, (g, h)| largest.max((g - h).abs()))
}

/// The angle in (−π, π] that differs from `angle` by whole turns.
pub(super) fn principal(angle: f64) -> f64 {
    let (sin, cos) = angle.sin_cos();
    if angle.abs() <= std::f64::consts::PI { angle } else { sin.atan2(cos) }
}

/// The element `g`, if all its coordinates are finite.
pub(super) fn finite(g: &[f64]) -> Result<Vec<f64>, AlgebraError> {
    if g.iter().all(|x| x.is_finite()) {
        return Ok(g.to_vec());
    }
    Err(AlgebraError::NoNearestElement { element: g.to_vec() })
}
