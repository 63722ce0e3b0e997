//! Whether integrals suffice to integrate the motion.

use pc_mech::Expr;

use crate::brackets::poisson_bracket::PoissonBracket;
use crate::error::AnalysisError;

/// What the theorems of Liouville and of Mishchenko and Fomenko ask of integrals F, on the levels of the Casimirs.
///
/// Let d be the number of those F that are independent on such a level, 2n its dimension, and ρ the rank of the
/// matrix (F_i, F_j). If the F are closed under the bracket and 2d − ρ = 2n, the compact levels of the F are tori of
/// dimension d − ρ, on which the motion is a uniform rotation [Mishchenko, Fomenko, Funct. Anal. Appl. 12 (1978) 113]. For
/// ρ = 0 this is Liouville's theorem, d = n.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Integrability {
    /// d, the rank of the fields (z, F_i).
    pub independent: usize,
    /// ρ
    pub bracket_rank: usize,
    /// 2n, the rank of the bracket.
    pub leaf: usize,
}

impl Integrability {
    /// The dimension d − ρ of the tori, if the integrals suffice: 2d − ρ = 2n.
    pub fn torus(self) -> Option<usize> {
        let Integrability { independent, bracket_rank, leaf } = self;
        (2 * independent == leaf + bracket_rank).then(|| independent - bracket_rank)
    }
}

impl<'g> PoissonBracket<'g> {
    /// The numbers on which it depends whether integrals suffice to integrate the motion; the ranks are those at almost all
    /// points.
    ///
    /// # Errors
    /// [`AnalysisError::NotAVariable`] for a function of anything other than variables and constants.
    ///
    /// ```
    /// use pc_analysis::PoissonBracket;
    /// use pc_mech::{Graph, LieAlgebra};
    /// // Euler's top: the energy suffices on the spheres of the angular momentum.
    /// let graph = Graph::new();
    /// let [x, y, z] = graph.symbols(["y1", "y2", "y3"]);
    /// let energy = x.square() + 2.0 * y.square() + 3.0 * z.square();
    /// let found = PoissonBracket::lie_poisson(&graph, &LieAlgebra::so3()).integrability(&[energy])?;
    /// assert_eq!((found.independent, found.leaf, found.torus()), (1, 2, Some(1)));
    /// # Ok::<(), pc_analysis::AnalysisError>(())
    /// ```
    pub fn integrability(&self, integrals: &[Expr<'g>]) -> Result<Integrability, AnalysisError> {
        let fields: Result<Vec<Vec<Expr<'g>>>, AnalysisError> =
            integrals.iter().map(|&f| self.field(f)).collect();
        let brackets: Vec<Vec<Expr<'g>>> = integrals.iter().map(|&g| self.along(integrals, g)).collect();
        let graph = self.graph();
        Ok(Integrability {
            independent: graph.generic_rank(&fields?),
            bracket_rank: graph.generic_rank(&brackets),
            leaf: self.rank(),
        })
    }
}
