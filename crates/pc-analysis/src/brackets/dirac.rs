//! Dirac's bracket, under constraints on the canonical variables.

use pc_algebra::inverse;
use pc_mech::{Expr, Matrix};

use crate::brackets::poisson_bracket::PoissonBracket;
use crate::error::AnalysisError;

impl<'g> PoissonBracket<'g> {
    /// Dirac's bracket under constraints φ_a = 0 of the second class [Dirac, Canad. J. Math. 2 (1950) 129],
    ///
    ///   (f, g)_D = (f, g) − (f, φ_a) C^ab (φ_b, g),   C^ab the inverse of C_ab = (φ_a, φ_b).
    ///
    /// It is a Poisson bracket if (f, g) is one; its Casimirs are those of (f, g) and the φ_a. For constraints f(x) = 0 on the
    /// positions, φ consists of [f and ḟ = (f, H)](PoissonBracket::with_rates): then H generates the motion with
    /// Lagrange's multipliers, ż = (z, H)_D, where the constraints hold.
    ///
    /// # Errors
    /// [`AnalysisError::NotAVariable`]; [`AnalysisError::NotSecondClass`] if the matrix C is singular everywhere.
    ///
    /// ```
    /// use pc_analysis::PoissonBracket;
    /// use pc_mech::{Graph, System};
    ///
    /// // A point of unit mass on a circle.
    /// let graph = Graph::new();
    /// let point = System::builder(&graph)
    ///     .coordinates(["x", "y"])
    ///     .lagrangian(|_, _, v| (v[0].square() + v[1].square()) / 2.0)
    ///     .build()?;
    /// let [x, y, px, py] = graph.symbols(["x", "y", "p_x", "p_y"]);
    /// let bracket = PoissonBracket::new(&point);
    /// let circle = x.square() + y.square() - 1.0;
    /// let constraints = bracket.with_rates(&[circle], (px.square() + py.square()) / 2.0)?;
    /// let dirac = bracket.dirac(&constraints)?;
    /// assert_eq!(dirac.of(x, px)?, 1.0 - x.square() / (x.square() + y.square()));
    /// assert_eq!(dirac.of(px, py)?, (y * px - x * py) / (x.square() + y.square()));
    /// assert!(dirac.is_casimir(circle)?);
    /// # Ok::<(), pc_analysis::AnalysisError>(())
    /// ```
    pub fn dirac(&self, constraints: &[Expr<'g>]) -> Result<PoissonBracket<'g>, AnalysisError> {
        self.check(constraints)?;
        let (graph, z) = (self.graph(), self.variables());
        // Column a holds (z_i, φ_a).
        let fields: Result<Vec<Vec<Expr<'g>>>, AnalysisError> =
            constraints.iter().map(|&phi| self.field(phi)).collect();
        let fields = fields?;
        let brackets: Vec<Vec<Expr<'g>>> =
            constraints.iter().map(|&phi| self.along(constraints, phi)).collect();
        let between = Matrix::from_fn(constraints.len(), constraints.len(), |a, b| brackets[b][a]);
        let Some(inverse) = inverse(graph, &between) else {
            let constraints = constraints.iter().map(Expr::to_string).collect();
            return Err(AnalysisError::NotSecondClass { constraints });
        };
        // (z_i, φ_a) C^ab
        let left = |i: usize, b: usize| graph.sum((0..fields.len()).map(|a| fields[a][i] * inverse[(a, b)]));
        let left: Vec<Vec<Expr<'g>>> =
            (0..z.len()).map(|i| (0..fields.len()).map(|b| left(i, b)).collect()).collect();
        let entry = |i: usize, j: usize| {
            // (φ_b, z_j) = −(z_j, φ_b)
            let correction = graph.dot(left[i].iter().copied(), fields.iter().map(|field| field[j]));
            graph.shorten(&[self.tensor()[(i, j)] + correction], z)[0]
        };
        let upper = Matrix::from_fn(z.len(), z.len(), |i, j| if i < j { entry(i, j) } else { Expr::ZERO });
        let tensor = Matrix::from_fn(z.len(), z.len(), |i, j| upper[(i, j)] - upper[(j, i)]);
        Ok(self.with_tensor(tensor))
    }

    /// The functions f, followed by their rates ḟ = (f, h): with the constraints f = 0 on the positions of a motion, all
    /// conditions on its state.
    ///
    /// # Errors
    /// [`AnalysisError::NotAVariable`] for a function of anything other than variables and constants.
    pub fn with_rates(&self, functions: &[Expr<'g>], h: Expr<'g>) -> Result<Vec<Expr<'g>>, AnalysisError> {
        Ok([functions, &self.rates(functions, h)?].concat())
    }
}
