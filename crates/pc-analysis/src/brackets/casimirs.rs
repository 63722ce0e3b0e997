//! Casimirs: functions C with (C, ·) = 0.

use pc_mech::Expr;

use crate::brackets::poisson_bracket::PoissonBracket;
use crate::error::AnalysisError;
use crate::integrals::ansatz::Ansatz;
use crate::integrals::polynomials::{Generator, independent, monomials};

impl<'g> PoissonBracket<'g> {
    /// Whether (f, z_i) = 0 for every variable z_i, as far as the graph can tell: if so, f is an integral
    /// whatever the Hamiltonian is.
    ///
    /// # Errors
    /// [`AnalysisError::NotAVariable`] for a function of anything other than variables and constants.
    pub fn is_casimir(&self, f: Expr<'g>) -> Result<bool, AnalysisError> {
        Ok(self.field(f)?.iter().all(|rate| rate.is_zero()))
    }

    /// A basis of the Casimirs Σ a_j f_j of `functions` f_j, over the field of the rational functions of the parameters of
    /// the system, or of all symbols of a given tensor that are no variables.
    ///
    /// Each is proved: (C, z_i) is folded to zero. See
    /// [`linear_relations_over`](pc_mech::Graph::linear_relations_over) for relations that may be missed.
    ///
    /// # Errors
    /// [`AnalysisError::NotAVariable`] for a function of anything other than variables and constants.
    pub fn casimirs_among(&self, functions: &[Expr<'g>]) -> Result<Vec<Expr<'g>>, AnalysisError> {
        self.check(functions)?;
        Ok(self.combinations(functions))
    }

    /// Functionally independent Casimirs that have the form of an ansatz, Σ a_jl m_j f_l with monomials m_j
    /// in the `moving` variables and functions a_jl of the parameters, and are independent of the functions known to the ansatz.
    ///
    /// # Errors
    /// [`AnalysisError::NotAVariable`] for an ansatz with functions of anything other than variables and constants.
    pub fn casimirs_by(
        &self,
        ansatz: &Ansatz<'g>,
        moving: &[Expr<'g>],
    ) -> Result<Vec<Expr<'g>>, AnalysisError> {
        let generators: Vec<Generator<'g>> = moving.iter().map(|&y| (y, ansatz.degree)).collect();
        let products = monomials(&generators, ansatz.degree).into_iter();
        let functions: Vec<Expr<'g>> =
            products.flat_map(|m| ansatz.functions.iter().map(move |&f| m * f)).collect();
        let found = self.casimirs_among(&functions)?;
        Ok(independent(self.graph(), self.variables(), &ansatz.known, found))
    }

    fn combinations(&self, functions: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let graph = self.graph();
        let brackets: Vec<Vec<Expr<'g>>> =
            self.variables().iter().map(|&z| self.along(functions, z)).collect();
        let column = |j: usize| brackets.iter().map(|row| row[j]).collect();
        let columns: Vec<Vec<Expr<'g>>> = (0..functions.len()).map(column).collect();
        let relations = graph.linear_relations_over(&columns, self.parameters());
        relations.into_iter().map(|a| graph.dot(a, functions.iter().copied())).collect()
    }

    /// Functionally independent Casimirs that are polynomials of degree ≤ `degree` in the variables, with
    /// functions of the parameters as coefficients; those of low degree come first. At most [`corank`](PoissonBracket::corank) of
    /// them exist; if fewer are found, the remaining Casimirs are of higher degree, rational or
    /// transcendental.
    ///
    /// ```
    /// use pc_analysis::PoissonBracket;
    /// use pc_mech::{Graph, LieAlgebra};
    /// let graph = Graph::new();
    /// let bracket = PoissonBracket::lie_poisson(&graph, &LieAlgebra::se3());
    /// let [c, area] = bracket.casimirs(2)[..] else { panic!("two of them") };
    /// assert_eq!(c.to_string(), "y1*y4 + y2*y5 + y3*y6");
    /// assert_eq!(area.to_string(), "y4^2 + y5^2 + y6^2");
    /// ```
    pub fn casimirs(&self, degree: u32) -> Vec<Expr<'g>> {
        if self.corank() == 0 {
            return Vec::new();
        }
        let generators: Vec<Generator<'g>> = self.variables().iter().map(|&z| (z, degree)).collect();
        let found = self.combinations(&monomials(&generators, degree));
        independent(self.graph(), self.variables(), &[], found)
    }
}
