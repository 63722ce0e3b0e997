//! The Poisson bracket of coordinates and momenta (12).

use std::collections::BTreeMap;

use pc_algebra::quadratic;
use pc_mech::{
    Expr, Frame, Graph, LieAlgebra, Matrix, MatrixError, MechError, Neighbourhood, StructureCoefficients,
    System,
};

use crate::error::{AnalysisError, check_variables, shape};
use crate::integrals::polynomials::independent;
use crate::integrals::rates::Rates;

/// A Poisson bracket (f, g) = P_ij ∂f/∂z_i ∂g/∂z_j of functions of the variables z, with P_ij = (z_i, z_j).
///
/// For a system, with z = (x, y), it is
///
///   (f, g) = ∂g/∂y_s X_s f − ∂f/∂y_s X_s g + c_rs^m ∂f/∂y_s ∂g/∂y_r y_m   (12),
///
/// and generates the motion, ẋ_i = (x_i, H), ẏ_s = (y_s, H), where b_0 = 0, c_0s = 0 and Q = 0. The term c_0s^m
/// ∂f/∂y_s y_m that the source adds for other systems is left out: with it (f, g) would not equal −(g, f). For
/// them use the [extended](PoissonBracket::extended) bracket.
///
/// Besides the variables, functions may contain symbols that count as constants: the symbols in the tensor,
/// those of the system to which it belongs except for its quasi-velocities, and those
/// [declared](PoissonBracket::with_constants). Any other symbol in a function is an error, including
/// quasi-velocities: [`Canonical::in_momenta`](pc_mech::Canonical::in_momenta) replaces them by momenta.
#[derive(Clone, Debug)]
pub struct PoissonBracket<'g> {
    graph: &'g Graph,
    variables: Vec<Expr<'g>>,
    tensor: Matrix<Expr<'g>>,
    time_momentum: Option<Expr<'g>>,
    constants: Vec<Expr<'g>>,
    /// The constants of which the coefficients of Casimirs may be functions.
    parameters: Vec<Expr<'g>>,
}

/// The parameters of the system that are not signals.
fn parameters<'g>(system: &System<'g>) -> Vec<Expr<'g>> {
    system.numbers().into_iter().map(|(parameter, _)| parameter).collect()
}

/// The symbols of the system that are neither variables of its bracket nor quasi-velocities: time unless it
/// is a variable, parameters, and any others in its equations. If L is not quadratic, H contains the
/// quasi-velocities; once they are replaced by their values, the derivatives of H with respect to the other
/// symbols are those of H(x, y).
fn constants<'g>(system: &System<'g>, variables: &[Expr<'g>]) -> Vec<Expr<'g>> {
    let closed = quadratic(system.graph(), system.lagrangian(), system.quasi_velocities()).is_some();
    let mut constants = system.symbols();
    constants.retain(|z| !(variables.contains(z) || closed && system.quasi_velocities().contains(z)));
    constants
}

/// The symbol of y_0: `p_t`, prefixed with further `p_` if that name is taken.
fn time_momentum_symbol<'g>(system: &System<'g>, momenta: &[Expr<'g>]) -> Expr<'g> {
    let parameters = system.parameters().iter().map(|&(symbol, _)| symbol);
    let state = system.frame().coordinates().iter().chain(system.quasi_velocities()).chain(momenta).copied();
    let taken: Vec<Expr<'g>> = state.chain(parameters).collect();
    let mut name = format!("p_{}", system.frame().time());
    while taken.contains(&system.graph().symbol(&name)) {
        name.insert_str(0, "p_");
    }
    system.graph().symbol(&name)
}

/// The brackets of (t, x, y_0, y): (t, y_0) = 1, (x_i, y_s) = b_is, (y_s, y_r) = c_rs^m y_m with r and s
/// counted from 0; all others are 0.
fn extended_tensor<'g>(
    frame: &Frame<'g>,
    structure: &StructureCoefficients<'g>,
    y: &[Expr<'g>],
) -> Matrix<Expr<'g>> {
    let (n, k) = (frame.coordinates().len(), y.len());
    let (coordinate, momentum) = (|i: usize| 1 + i, |s: usize| 1 + n + s);
    // Of thousands of momenta, most pairs have no bracket.
    let mut contractions: BTreeMap<(usize, usize), Vec<Expr<'g>>> = BTreeMap::new();
    for (r, s, m, c) in structure.nonzero().filter(|&(r, s, m, _)| r.max(s).max(m) <= k) {
        contractions.entry((r, s)).or_default().push(c * y[m - 1]);
    }
    let size = n + k + 2;
    let mut tensor = Matrix::from_fn(size, size, |_, _| Expr::ZERO);
    let mut set = |i: usize, j: usize, value: Expr<'g>| {
        tensor[(i, j)] = value;
        tensor[(j, i)] = -value;
    };
    set(0, momentum(0), Expr::ONE);
    for i in 0..n {
        set(coordinate(i), momentum(0), frame.b0()[i]);
        for s in 1..=k {
            set(coordinate(i), momentum(s), frame.b()[(i, s - 1)]);
        }
    }
    for ((r, s), terms) in contractions {
        set(momentum(s), momentum(r), frame.graph().sum(terms));
    }
    tensor
}

impl<'g> PoissonBracket<'g> {
    /// The bracket (12) in the n + k variables (x, y), y being the [momenta](System::momentum_symbols).
    ///
    /// ```
    /// use pc_analysis::PoissonBracket;
    /// use pc_mech::{Graph, System};
    /// let graph = Graph::new();
    /// let [x, p] = graph.symbols(["x", "p_x"]);
    /// let builder = System::builder(&graph).coordinates(["x"]);
    /// let particle = builder.lagrangian(|_, _, v| v[0].square() / 2.0).build()?;
    /// assert_eq!(PoissonBracket::new(&particle).of(x.square(), p)?, 2.0 * x);
    /// assert!(PoissonBracket::new(&particle).of(x, graph.symbol("x'")).is_err()); // the variable is p_x
    /// # Ok::<(), pc_analysis::AnalysisError>(())
    /// ```
    pub fn new(system: &System<'g>) -> PoissonBracket<'g> {
        let y = system.momentum_symbols();
        let variables: Vec<Expr<'g>> = system.frame().coordinates().iter().chain(&y).copied().collect();
        let n = system.frame().coordinates().len();
        // The rows of x and y among those of (t, x, y_0, y).
        let row = |i: usize| if i < n { i + 1 } else { i + 2 };
        let tensor = extended_tensor(system.frame(), system.structure(), &y);
        PoissonBracket {
            graph: system.graph(),
            tensor: Matrix::from_fn(n + y.len(), n + y.len(), |i, j| tensor[(row(i), row(j))]),
            constants: constants(system, &variables),
            parameters: parameters(system),
            variables,
            time_momentum: None,
        }
    }

    /// The bracket in the n + k + 2 variables (t, x, y_0, y): (12) with r and s counted from 0 and m from 1,
    /// and with y_0 conjugate to t.
    ///
    /// With H + y_0 it generates the motion of every system without forces Q, even if b_0 or c_0s are not 0:
    /// ẋ_i = (x_i, H + y_0) is (11), ẏ_s = (y_s, H + y_0) is (10), and ẏ_0 = (y_0, H) = −dH/dt.
    pub fn extended(system: &System<'g>) -> PoissonBracket<'g> {
        let (t, x, y) = (system.frame().time(), system.frame().coordinates(), system.momentum_symbols());
        let y0 = time_momentum_symbol(system, &y);
        let variables: Vec<Expr<'g>> = [t].iter().chain(x).chain(&[y0]).chain(&y).copied().collect();
        let tensor = extended_tensor(system.frame(), system.structure(), &y);
        let constants = constants(system, &variables);
        PoissonBracket {
            graph: system.graph(),
            tensor,
            variables,
            time_momentum: Some(y0),
            constants,
            parameters: parameters(system),
        }
    }

    /// The Lie–Poisson bracket of an algebra, (y_s, y_r) = c_rs^m y_m, in the variables `y1`, `y2`, …: (12)
    /// for n = 0, with the sign of *body* momenta.
    ///
    /// ```
    /// use pc_analysis::PoissonBracket;
    /// use pc_mech::{Graph, LieAlgebra};
    /// let graph = Graph::new();
    /// let [y1, y2, y3] = graph.symbols(["y1", "y2", "y3"]);
    /// let bracket = PoissonBracket::lie_poisson(&graph, &LieAlgebra::so3());
    /// assert_eq!(bracket.of(y1, y2)?, -y3);
    /// assert!(bracket.is_casimir(y1.square() + y2.square() + y3.square())?);
    /// # Ok::<(), pc_analysis::AnalysisError>(())
    /// ```
    pub fn lie_poisson(graph: &'g Graph, algebra: &LieAlgebra) -> PoissonBracket<'g> {
        let k = algebra.dim();
        let y: Vec<Expr<'g>> = (1..=k).map(|s| graph.symbol(&format!("y{s}"))).collect();
        let entry = |s: usize, r: usize| -> Expr<'g> {
            (0..k).map(|m| Expr::from(algebra.constant(r, s, m)) * y[m]).sum()
        };
        let tensor = Matrix::from_fn(k, k, entry);
        let (constants, parameters) = (Vec::new(), Vec::new());
        PoissonBracket { graph, tensor, variables: y, time_momentum: None, constants, parameters }
    }

    /// The bracket with (z_i, z_j) = `tensor`_ij for the variables z, whether or not it satisfies Jacobi's
    /// identity.
    ///
    /// # Errors
    /// [`ShapeError`](pc_mech::ShapeError) if the tensor is not square with one row per variable;
    /// [`MatrixError::NotSkew`].
    pub fn of_tensor(
        graph: &'g Graph,
        variables: Vec<Expr<'g>>,
        tensor: Matrix<Expr<'g>>,
    ) -> Result<PoissonBracket<'g>, AnalysisError> {
        let size = variables.len();
        shape("the rows of the tensor", tensor.rows(), size)?;
        shape("the columns of the tensor", tensor.columns(), size)?;
        let mut pairs = (0..size).flat_map(|i| (0..=i).map(move |j| (i, j)));
        match pairs.find(|&(i, j)| !(tensor[(i, j)] + tensor[(j, i)]).is_zero()) {
            Some((i, j)) => {
                let pair = [i, j].map(|z| variables[z].to_string());
                Err(MechError::from(MatrixError::NotSkew { what: "a Poisson tensor", pair }).into())
            }
            None => {
                let mut constants = graph.symbols_of(&tensor.nonzero_entries());
                constants.retain(|z| !variables.contains(z));
                let parameters = constants.clone();
                Ok(PoissonBracket { graph, variables, tensor, time_momentum: None, constants, parameters })
            }
        }
    }

    /// The same bracket with additional symbols that count as constants in functions.
    #[must_use]
    pub fn with_constants(mut self, constants: impl IntoIterator<Item = Expr<'g>>) -> PoissonBracket<'g> {
        self.constants.extend(constants);
        self
    }

    /// The same bracket for the present values of the parameters, as [`Rates::at_present`] takes them.
    #[must_use]
    pub fn at_present(&self, rates: &Rates<'g>) -> PoissonBracket<'g> {
        self.with_tensor(self.tensor.map(|entry| rates.at_present(entry)))
    }

    /// The bracket of the same variables and constants with another tensor, which is skew.
    pub(crate) fn with_tensor(&self, tensor: Matrix<Expr<'g>>) -> PoissonBracket<'g> {
        PoissonBracket { tensor, ..self.clone() }
    }

    /// The symbols that count as constants in functions.
    pub fn constants(&self) -> &[Expr<'g>] {
        &self.constants
    }

    /// The constants of which the coefficients of Casimirs may be functions: the parameters of the system, or all
    /// symbols of a given tensor.
    pub(crate) fn parameters(&self) -> &[Expr<'g>] {
        &self.parameters
    }

    /// Checks that functions contain only variables and constants.
    ///
    /// # Errors
    /// [`AnalysisError::NotAVariable`] naming the first other symbol.
    pub(crate) fn check(&self, functions: &[Expr<'g>]) -> Result<(), AnalysisError> {
        let known: Vec<Expr<'g>> = self.variables.iter().chain(&self.constants).copied().collect();
        check_variables("a function in a Poisson bracket", self.graph, functions, &known)
    }

    /// The first three variables whose brackets do not satisfy Jacobi's identity, with the defect; `None` if there
    /// are no such variables. A defect that is not folded to zero counts only if its numerical values show that it
    /// is not zero.
    pub fn jacobi_violation(&self) -> Option<([Expr<'g>; 3], Expr<'g>)> {
        let z = &self.variables;
        let triples = (0..z.len())
            .flat_map(|i| (i + 1..z.len()).flat_map(move |j| (j + 1..z.len()).map(move |k| [i, j, k])));
        let mut defects = triples.map(|triple| {
            let [f, g, h] = triple.map(|i| z[i]);
            ([f, g, h], self.defect(f, g, h))
        });
        defects
            .find(|&(_, defect)| !Neighbourhood::anywhere(self.graph, &[defect]).vanishes(self.graph, defect))
    }

    /// The graph that holds all expressions of the bracket.
    pub fn graph(&self) -> &'g Graph {
        self.graph
    }

    /// The variables z: the n + k variables (x, y), or the n + k + 2 variables (t, x, y_0, y) of the extended
    /// bracket.
    pub fn variables(&self) -> &[Expr<'g>] {
        &self.variables
    }

    /// The symbol y_0 of the extended bracket: its Hamiltonian is H + y_0.
    pub fn time_momentum(&self) -> Option<Expr<'g>> {
        self.time_momentum
    }

    /// The Poisson tensor P_ij = (z_i, z_j), skew, with a row and a column for each variable.
    pub fn tensor(&self) -> &Matrix<Expr<'g>> {
        &self.tensor
    }

    /// (f, g) = P_ij ∂f/∂z_i ∂g/∂z_j (12).
    ///
    /// The bracket of two integrals of the motion that it generates is an integral (Poisson's theorem); see
    /// [`closure`](PoissonBracket::closure).
    ///
    /// # Errors
    /// [`AnalysisError::NotAVariable`] for a function of anything other than variables and constants.
    pub fn of(&self, f: Expr<'g>, g: Expr<'g>) -> Result<Expr<'g>, AnalysisError> {
        self.check(&[f, g])?;
        Ok(self.bracket(f, g))
    }

    /// The rates (f, h) of the functions f along the flow of h, ż_i = (z_i, h), one for each function.
    ///
    /// # Errors
    /// As for [`of`](PoissonBracket::of).
    pub fn rates(&self, functions: &[Expr<'g>], h: Expr<'g>) -> Result<Vec<Expr<'g>>, AnalysisError> {
        self.check(functions)?;
        self.check(&[h])?;
        Ok(self.along(functions, h))
    }

    /// The components (z_i, h) = P_ij ∂h/∂z_j of the vector field of h, one for each variable.
    ///
    /// # Errors
    /// As for [`of`](PoissonBracket::of).
    pub fn field(&self, h: Expr<'g>) -> Result<Vec<Expr<'g>>, AnalysisError> {
        self.check(&[h])?;
        Ok(self.components(h))
    }

    /// (f, (g, h)) + (g, (h, f)) + (h, (f, g)), which is zero if Jacobi's identity holds.
    ///
    /// # Errors
    /// As for [`of`](PoissonBracket::of).
    pub fn jacobi_defect(&self, f: Expr<'g>, g: Expr<'g>, h: Expr<'g>) -> Result<Expr<'g>, AnalysisError> {
        self.check(&[f, g, h])?;
        Ok(self.defect(f, g, h))
    }

    /// The functions, their brackets, the brackets of those brackets, and so on, except functions that depend
    /// functionally on earlier ones; the given functions come first. If the given functions are integrals, so
    /// are their brackets.
    ///
    /// # Errors
    /// As for [`of`](PoissonBracket::of).
    pub fn closure(&self, functions: &[Expr<'g>]) -> Result<Vec<Expr<'g>>, AnalysisError> {
        self.check(functions)?;
        let new = |known: &[Expr<'g>], f: &[Expr<'g>]| {
            independent(self.graph, &self.variables, known, f.iter().copied())
        };
        let mut all = new(&[], functions);
        let mut last = 1;
        while last < all.len() {
            for first in 0..last {
                let bracket = self.bracket(all[first], all[last]);
                all.extend(new(&all, &[bracket]));
            }
            last += 1;
        }
        Ok(all)
    }

    /// [`of`](PoissonBracket::of) for functions already checked.
    fn bracket(&self, f: Expr<'g>, g: Expr<'g>) -> Expr<'g> {
        self.along(&[f], g)[0]
    }

    /// [`rates`](PoissonBracket::rates) for functions already checked.
    pub(crate) fn along(&self, functions: &[Expr<'g>], h: Expr<'g>) -> Vec<Expr<'g>> {
        let field = self.variables.iter().copied().zip(self.components(h)).collect::<Vec<_>>();
        self.graph.directional(functions, &field)
    }

    /// [`field`](PoissonBracket::field) for functions already checked.
    fn components(&self, h: Expr<'g>) -> Vec<Expr<'g>> {
        let slope = self.graph.gradient(h, &self.variables);
        let component = |i: usize| self.graph.sum(self.tensor.nonzero(i).map(|(j, entry)| entry * slope[j]));
        (0..self.variables.len()).map(component).collect()
    }

    /// [`jacobi_defect`](PoissonBracket::jacobi_defect) for functions already checked.
    fn defect(&self, f: Expr<'g>, g: Expr<'g>, h: Expr<'g>) -> Expr<'g> {
        let cycle = [(f, g, h), (g, h, f), (h, f, g)];
        self.graph.sum(cycle.map(|(f, g, h)| self.bracket(f, self.bracket(g, h))))
    }

    /// The rank of the Poisson tensor at almost all points; it is always even.
    pub fn rank(&self) -> usize {
        self.graph.generic_rank_of_entries(self.tensor.columns(), &self.tensor.nonzero_rows())
    }

    /// The number of variables minus the rank: the number of independent Casimirs near almost every point.
    pub fn corank(&self) -> usize {
        self.variables.len() - self.rank()
    }
}
