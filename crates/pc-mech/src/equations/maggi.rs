//! Maggi's equations: Lagrange's expressions along the velocities that constraints leave free.

use pc_algebra::Matrix;
use pc_expr::{Expr, Graph};

use crate::equations::book::sums_of_products;
use crate::equations::poincare::Equations;

/// Maggi's equations of l independent quasi-velocities,
///
///   Σ_i E_i ∂ẋ_i/∂η_s = 0,   E_i = d/dt ∂L/∂ẋ_i − ∂L/∂x_i − Q_i,   s = 1..l, i = 1..n,
///
/// with Lagrange's expressions E_i(t, x, ẋ, ẍ) of the motion without constraints [G. A. Maggi, *Principii della teoria
/// matematica del movimento dei corpi* (1896); J. I. Neimark, N. A. Fufaev, *Dynamics of Nonholonomic Systems* (1972), ch.
/// III]. Together with ẋ_i = b_is η_s + b_i0 they determine the motion.
#[derive(Clone, Debug)]
pub struct Maggi<'g> {
    lagrange: Equations<'g>,
    symbols: Vec<Expr<'g>>,
    partial: Matrix<Expr<'g>>,
}

impl<'g> Maggi<'g> {
    /// Maggi's equations from Lagrange's equations in [velocities](crate::System::in_velocities), without constraints, and the n
    /// × l matrix b = ∂ẋ/∂η of the velocities that the constraints leave free.
    ///
    /// ```
    /// use pc_mech::{Graph, Maggi, Matrix, System};
    ///
    /// // A blade on ice: ẋ = v cos φ, ẏ = v sin φ, φ̇ = ω.
    /// let graph = Graph::new();
    /// let blade = System::builder(&graph)
    ///     .coordinates(["x", "y", "φ"])
    ///     .lagrangian(|_, _, v| (v[0].square() + v[1].square() + v[2].square()) / 2.0)
    ///     .build()?;
    /// let phi = graph.symbol("φ");
    /// let free = [[phi.cos(), 0.into()], [phi.sin(), 0.into()], [0.into(), 1.into()]];
    /// let maggi = Maggi::new(blade.poincare()?, Matrix::from_fn(3, 2, |i, s| free[i][s]));
    /// let [ex, ey] = [maggi.symbols()[0], maggi.symbols()[1]];
    /// assert_eq!(maggi.sums()[0], ex * phi.cos() + ey * phi.sin());
    /// # Ok::<(), pc_mech::MechError>(())
    /// ```
    pub fn new(lagrange: Equations<'g>, partial: Matrix<Expr<'g>>) -> Maggi<'g> {
        let system = lagrange.system();
        let names = system.frame().coordinates().iter().map(|x| format!("E_{x}"));
        let symbols = system.all_unused(names, "E_");
        Maggi { lagrange, symbols, partial }
    }

    /// The symbols of the n expressions E_i.
    pub fn symbols(&self) -> &[Expr<'g>] {
        &self.symbols
    }

    /// The n expressions E_i(t, x, ẋ, ẍ).
    pub fn expressions(&self) -> Vec<Expr<'g>> {
        let system = self.lagrange.system();
        let accelerations = system.accelerations();
        let (mass, right) = (self.lagrange.mass_matrix(), self.lagrange.right_hand_side());
        let row = |i: usize| mass.nonzero(i).map(|(j, entry)| entry * accelerations[j]).chain([-right[i]]);
        (0..right.len()).map(|i| system.graph().sum(row(i))).collect()
    }

    /// The l sums Σ_i E_i ∂ẋ_i/∂η_s, in the symbols of the E_i; Maggi's equations say that they vanish.
    pub fn sums(&self) -> Vec<Expr<'g>> {
        let graph = self.lagrange.system().graph();
        let back = self.partial.transpose();
        (0..back.rows()).map(|s| graph.sum(back.nonzero(s).map(|(i, b)| b * self.symbols[i]))).collect()
    }

    /// The [expressions](Maggi::expressions) as sums of products of ẍ and ẋ, in the graph `page`; none for those that are not
    /// polynomials.
    pub fn written<'p>(&self, page: &'p Graph) -> Vec<Option<Expr<'p>>> {
        let system = self.lagrange.system();
        let variables = [&system.accelerations()[..], system.quasi_velocities()].concat();
        sums_of_products(system, &self.expressions(), &variables, page)
    }
}
