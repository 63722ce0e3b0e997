//! Quasi-velocities that are velocities of a coordinate (7).

use pc_expr::Expr;

use crate::frame::frame::Frame;
use crate::frame::structure::StructureCoefficients;

/// Whether a quasi-velocity η_m is the velocity of a coordinate.
#[derive(Clone, Debug, PartialEq)]
pub enum Holonomy<'g> {
    /// All c_rs^m = 0, r, s = 0..k: locally η_m = dπ_m/dt (7), on each submanifold of the constraints if n >
    /// k.
    Holonomic {
        /// The coordinate π_m, if it can be found by elementary means.
        coordinate: Option<Expr<'g>>,
    },
    /// There is no such coordinate.
    Nonholonomic {
        /// The first pair r < s with c_rs^m ≠ 0; 0 is time.
        pair: (usize, usize),
    },
}

impl<'g> Frame<'g> {
    /// Whether η_m is a velocity, m = 1..k, judged by the frame's own structure coefficients.
    ///
    /// Let ω^m = a_mi dx_i + a_m0 dt be the form with ω^m(X_s) = δ_ms, s = 0..k, which is η_m dt along
    /// motions (2). By (6) dω^m(X_r, X_s) = −c_rs^m; so if n = k and the X_0..X_k are a basis, ω^m is
    /// closed if and only if c_rs^m = 0 for all r, s = 0..k, and then locally ω^m = dπ_m. If n > k this
    /// holds on each submanifold to which the constraints confine the motion.
    ///
    /// π_m is returned if n = k and it is [found](pc_expr::Graph::potential); it satisfies X_s π_m = δ_ms.
    ///
    /// # Panics
    /// If m is not in 1..=k.
    ///
    /// ```
    /// # use pc_algebra::{Frame, Holonomy, Neighbourhood};
    /// # use pc_expr::Graph;
    /// // η_1 = x ẏ + y ẋ is the velocity of xy, η_2 = x ẏ of nothing.
    /// let graph = Graph::new();
    /// let [t, x, y, dx, dy] = graph.symbols(["t", "x", "y", "dx", "dy"]);
    /// let frame = Frame::from_definitions(&graph, t, vec![x, y], &[dx, dy], &[x * dy + y * dx, x * dy])?;
    /// let c = frame.structure_coefficients(&Neighbourhood::default())?;
    /// assert_eq!(frame.holonomy(1, &c), Holonomy::Holonomic { coordinate: Some(x * y) });
    /// assert_eq!(frame.holonomy(2, &c), Holonomy::Nonholonomic { pair: (1, 2) });
    /// # Ok::<(), pc_algebra::AlgebraError>(())
    /// ```
    pub fn holonomy(&self, m: usize, structure: &StructureCoefficients<'g>) -> Holonomy<'g> {
        assert!((1..=self.operators()).contains(&m), "there is no quasi-velocity number {m}");
        match structure.nonzero().find(|&(_, _, upper, _)| upper == m) {
            Some((r, s, ..)) => Holonomy::Nonholonomic { pair: (r, s) },
            None => Holonomy::Holonomic { coordinate: self.quasi_coordinate(m) },
        }
    }

    /// The coordinate π_m with dπ_m = ω^m, if one is found.
    fn quasi_coordinate(&self, m: usize) -> Option<Expr<'g>> {
        let is_rate = |i: &usize| {
            let mut row = self.b().nonzero(*i);
            self.b0()[*i].is_zero() && row.next() == Some((m - 1, Expr::ONE)) && row.next().is_none()
        };
        if let Some(i) = (0..self.coordinates().len()).find(is_rate) {
            return Some(self.coordinates()[i]);
        }
        if self.coordinates().len() != self.operators() {
            return None;
        }
        let (a, a0) = self.definitions().ok()?;
        let variables: Vec<Expr<'g>> = self.coordinates().iter().copied().chain([self.time()]).collect();
        let form: Vec<Expr<'g>> = a.row(m - 1).iter().copied().chain([a0[m - 1]]).collect();
        let coordinate = self.graph().potential(&form, &variables)?;
        let derivatives = (0..=self.operators()).map(|s| self.apply(s, &[coordinate])[0]);
        let expected = (0..=self.operators()).map(|s| if s == m { Expr::ONE } else { Expr::ZERO });
        derivatives.eq(expected).then_some(coordinate)
    }
}
