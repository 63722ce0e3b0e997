//! Whether functions are canonical variables.

use pc_mech::Expr;

use crate::brackets::poisson_bracket::PoissonBracket;
use crate::error::{AnalysisError, shape};

/// The verdict on functions X_1..X_m, Y_1..Y_m as new coordinates and momenta.
///
/// They are canonical if (X_i, X_j) = 0, (Y_i, Y_j) = 0 and (X_i, Y_j) = c δ_ij with a constant c ≠ 0: with M = ∂(X, Y)/∂z the
/// matrix M P Mᵀ of their brackets is c J, where P is the tensor of the old bracket.
#[derive(Clone, Debug)]
pub struct CanonicalVariables<'g> {
    /// c: the common value of the (X_i, Y_i) if it is a constant other than zero, else 1.
    pub multiplier: Expr<'g>,
    /// The brackets that are not what they should be; none if the variables are canonical.
    pub violations: Vec<BracketViolation<'g>>,
    /// Whether the variables determine the state on the levels of the Casimirs: 2m is the rank of the bracket.
    pub are_complete: bool,
}

/// A bracket of new variables that is not what it should be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BracketViolation<'g> {
    /// The places of the two variables among X_1..X_m, Y_1..Y_m.
    pub pair: [usize; 2],
    /// The bracket.
    pub value: Expr<'g>,
    /// What it should be: c or 0.
    pub expected: Expr<'g>,
}

impl CanonicalVariables<'_> {
    /// Whether they are canonical, as far as the graph can tell.
    pub fn are_canonical(&self) -> bool {
        self.violations.is_empty()
    }
}

impl<'g> PoissonBracket<'g> {
    /// Whether the functions `coordinates` X_i and `momenta` Y_i are canonical variables of this bracket.
    ///
    /// # Errors
    /// [`ShapeError`](pc_mech::ShapeError) unless there are as many momenta as coordinates;
    /// [`AnalysisError::NotAVariable`] for a function of anything other than variables and constants.
    ///
    /// ```
    /// use pc_analysis::PoissonBracket;
    /// use pc_mech::{Graph, System};
    ///
    /// // Poincaré's variables of an oscillator.
    /// let graph = Graph::new();
    /// let oscillator =
    ///     System::builder(&graph).coordinates(["x"]).lagrangian(|_, x, v| v[0].square() - x[0].square()).build()?;
    /// let bracket = PoissonBracket::new(&oscillator);
    /// let [x, p] = graph.symbols(["x", "p_x"]);
    /// let action = (x.square() + p.square()) / 2.0;
    /// assert!(bracket.canonical_variables(&[x.atan2(p)], &[action])?.are_canonical());
    /// let scaled = bracket.canonical_variables(&[2.0 * x], &[3.0 * p])?;
    /// assert_eq!((scaled.are_canonical(), scaled.multiplier), (true, 6.into()));
    /// assert_eq!(bracket.canonical_variables(&[x], &[x * p])?.violations[0].value, x);
    /// # Ok::<(), pc_analysis::AnalysisError>(())
    /// ```
    pub fn canonical_variables(
        &self,
        coordinates: &[Expr<'g>],
        momenta: &[Expr<'g>],
    ) -> Result<CanonicalVariables<'g>, AnalysisError> {
        shape("the list of new momenta", momenta.len(), coordinates.len())?;
        let (all, m) = ([coordinates, momenta].concat(), coordinates.len());
        self.check(&all)?;
        // Row j holds the brackets (Z_i, Z_j).
        let brackets: Vec<Vec<Expr<'g>>> = all.iter().map(|&z| self.along(&all, z)).collect();
        let is_constant =
            |f: &Expr<'g>| self.graph().gradient(*f, self.variables()).iter().all(|slope| slope.is_zero());
        let mut products = (0..m).map(|i| brackets[m + i][i]);
        let multiplier = products.find(|c| !c.is_zero() && is_constant(c)).unwrap_or(Expr::ONE);
        let pairs = (0..2 * m).flat_map(|i| (i + 1..2 * m).map(move |j| [i, j]));
        let violations = pairs.filter_map(|[i, j]| {
            let expected = if j == i + m { multiplier } else { Expr::ZERO };
            let value = brackets[j][i];
            (!(value - expected).is_zero()).then_some(BracketViolation { pair: [i, j], value, expected })
        });
        Ok(CanonicalVariables {
            violations: violations.collect(),
            multiplier,
            are_complete: 2 * m == self.rank(),
        })
    }
}
