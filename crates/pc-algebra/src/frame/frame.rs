//! Frames of operators X_s = b_is ∂/∂x_i (4), with ẋ = b η + b_0 (3).

use std::collections::{BTreeSet, HashMap};

use pc_expr::{Expr, Graph};

use crate::error::AlgebraError;
use crate::identity::sample::Neighbourhood;
use crate::linear_algebra::affine::affine;
use crate::linear_algebra::inverse::inverse;
use crate::linear_algebra::matrix::Matrix;

/// A frame of k operators on a space of n coordinates and time.
///
/// X_0 f = ∂f/∂t + b_i0 ∂f/∂x_i and X_s f = b_is ∂f/∂x_i for s = 1..k; b is n × k, b_0 has length n, and both
/// may depend on t and x.
#[derive(Clone, Debug)]
pub struct Frame<'g> {
    graph: &'g Graph,
    time: Expr<'g>,
    coordinates: Vec<Expr<'g>>,
    b: Matrix<Expr<'g>>,
    b0: Vec<Expr<'g>>,
    /// The matrix a, if b was defined as a⁻¹.
    a: Option<Matrix<Expr<'g>>>,
}

impl<'g> Frame<'g> {
    /// The frame with matrix b (n × k) and drift b_0 (length n).
    ///
    /// # Errors
    /// [`AlgebraError::Shape`].
    pub fn new(
        graph: &'g Graph,
        time: Expr<'g>,
        coordinates: Vec<Expr<'g>>,
        b: Matrix<Expr<'g>>,
        b0: Vec<Expr<'g>>,
    ) -> Result<Frame<'g>, AlgebraError> {
        let n = coordinates.len();
        shape("the matrix b", b.rows(), n)?;
        shape("the drift b_0", b0.len(), n)?;
        Ok(Frame { graph, time, coordinates, b, b0, a: None })
    }

    /// The frame of ẋ = `velocities`, which are expressions affine in the symbols `eta` (3).
    ///
    /// # Errors
    /// [`AlgebraError::Shape`]; [`AlgebraError::NotAffine`] with the coordinate.
    pub fn from_velocities(
        graph: &'g Graph,
        time: Expr<'g>,
        coordinates: Vec<Expr<'g>>,
        eta: &[Expr<'g>],
        velocities: &[Expr<'g>],
    ) -> Result<Frame<'g>, AlgebraError> {
        shape("the list of velocities", velocities.len(), coordinates.len())?;
        let (b, b0) = affine_parts(graph, eta, velocities).map_err(|row| AlgebraError::NotAffine {
            coordinate: coordinates[row].to_string(),
            velocity: velocities[row].to_string(),
        })?;
        Frame::new(graph, time, coordinates, b, b0)
    }

    /// The frame of quasi-velocities η = `definitions`, which are n expressions affine in the symbols
    /// `velocities` of ẋ (2): η = a ẋ + a_0, b = a⁻¹, b_0 = −b a_0.
    ///
    /// # Errors
    /// [`AlgebraError::Shape`], [`AlgebraError::DefinitionNotAffine`], [`AlgebraError::SingularDefinitions`].
    pub fn from_definitions(
        graph: &'g Graph,
        time: Expr<'g>,
        coordinates: Vec<Expr<'g>>,
        velocities: &[Expr<'g>],
        definitions: &[Expr<'g>],
    ) -> Result<Frame<'g>, AlgebraError> {
        let n = coordinates.len();
        shape("the list of velocity symbols", velocities.len(), n)?;
        shape("the list of definitions", definitions.len(), n)?;
        let (a, a0) = affine_parts(graph, velocities, definitions).map_err(|row| {
            AlgebraError::DefinitionNotAffine { row: row + 1, definition: definitions[row].to_string() }
        })?;
        let b = inverse(graph, &a).ok_or(AlgebraError::SingularDefinitions)?;
        let b0 = (0..n).map(|i| -graph.sum(b.nonzero(i).map(|(j, b)| b * a0[j]))).collect();
        Ok(Frame { a: Some(a), ..Frame::new(graph, time, coordinates, b, b0)? })
    }

    /// The coordinate frame η = ẋ, X_s = ∂/∂x_s.
    pub fn coordinate(graph: &'g Graph, time: Expr<'g>, coordinates: Vec<Expr<'g>>) -> Frame<'g> {
        let n = coordinates.len();
        let b = Matrix::identity(n);
        Frame { graph, time, coordinates, b, b0: vec![Expr::ZERO; n], a: None }
    }

    /// The matrix a of η = a ẋ + a_0 if the frame was made [from definitions](Frame::from_definitions): where
    /// det a = 0 the definitions do not determine ẋ.
    pub fn definition_matrix(&self) -> Option<&Matrix<Expr<'g>>> {
        self.a.as_ref()
    }

    /// The graph that contains all expressions of the frame.
    pub fn graph(&self) -> &'g Graph {
        self.graph
    }

    /// The symbol of time.
    pub fn time(&self) -> Expr<'g> {
        self.time
    }

    /// The symbols x_1..x_n.
    pub fn coordinates(&self) -> &[Expr<'g>] {
        &self.coordinates
    }

    /// Number k of operators, not counting time.
    pub fn operators(&self) -> usize {
        self.b.columns()
    }

    /// The matrix b, n × k.
    pub fn b(&self) -> &Matrix<Expr<'g>> {
        &self.b
    }

    /// The drift b_0, of length n.
    pub fn b0(&self) -> &[Expr<'g>] {
        &self.b0
    }

    /// The velocities ẋ = b η + b_0 (3); `eta` has length k.
    pub fn velocities(&self, eta: &[Expr<'g>]) -> Vec<Expr<'g>> {
        (0..self.coordinates.len())
            .map(|i| {
                let moving = self.b.nonzero(i).map(|(s, b)| b * eta[s]);
                self.graph.sum(moving.chain([self.b0[i]]))
            })
            .collect()
    }

    /// The matrix a (k × n) and the vector a_0 (length k) of η = a ẋ + a_0 (2): a = b⁻¹ and a_0 = −a b_0.
    ///
    /// Where n > k, a is one of many with a b = 1: (bᵀb)⁻¹bᵀ.
    ///
    /// # Errors
    /// [`AlgebraError::DependentOperators`] if rank b < k.
    ///
    /// ```
    /// # use pc_algebra::Frame;
    /// # use pc_expr::Graph;
    /// let graph = Graph::new();
    /// let [t, r, dr] = graph.symbols(["t", "r", "dr"]);
    /// let frame = Frame::from_definitions(&graph, t, vec![r], &[dr], &[r * dr + t])?;
    /// let (a, a0) = frame.definitions()?;
    /// assert_eq!((a[(0, 0)], a0[0]), (r, t));
    /// # Ok::<(), pc_algebra::AlgebraError>(())
    /// ```
    pub fn definitions(&self) -> Result<(Matrix<Expr<'g>>, Vec<Expr<'g>>), AlgebraError> {
        let (rank, operators) = (self.rank(), self.operators());
        if rank < operators {
            return Err(AlgebraError::DependentOperators { rank, operators });
        }
        let a = self.left_inverse().ok_or(AlgebraError::DependentOperators { rank: rank - 1, operators })?;
        let drift = |s: usize| -self.graph.sum(a.nonzero(s).map(|(i, a)| a * self.b0[i]));
        let a0 = (0..operators).map(drift).collect();
        Ok((a, a0))
    }

    /// The derivatives X_s f of each f in `functions`, s = 0..k (4): the rates of change when ẋ_i = b_is (and ṫ
    /// = 1 for s = 0).
    pub fn apply(&self, s: usize, functions: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let rates: Vec<(Expr<'g>, Expr<'g>)> = if s == 0 {
            let drift = self.coordinates.iter().copied().zip(self.b0.iter().copied());
            drift.chain(self.graph.in_time(self.time)).collect()
        } else {
            self.coordinates.iter().copied().zip(self.b.column(s - 1)).collect()
        };
        let moving: Vec<_> = rates.into_iter().filter(|(_, rate)| !rate.is_zero()).collect();
        self.graph.directional(functions, &moving)
    }

    /// The derivatives X_s L = b_is ∂L/∂x_i for s = 1..k, given the gradient ∂L/∂x (length n).
    pub fn contract(&self, gradient: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let mut terms = vec![Vec::new(); self.operators()];
        for (i, &slope) in gradient.iter().enumerate() {
            self.b.nonzero(i).for_each(|(s, b)| terms[s].push(b * slope));
        }
        terms.into_iter().map(|terms| self.graph.sum(terms)).collect()
    }

    /// The components [X_r, X_s]^i = X_r(b_is) − X_s(b_ir), i = 1..n, with r, s = 0..k and b_i0 the drift.
    pub fn commutator(&self, r: usize, s: usize) -> Vec<Expr<'g>> {
        self.commutator_terms(r, s).into_iter().map(|[forth, back]| forth + back).collect()
    }

    /// The two terms X_r(b_is) and −X_s(b_ir) of each component of the commutator.
    pub(crate) fn commutator_terms(&self, r: usize, s: usize) -> Vec<[Expr<'g>; 2]> {
        let forth = self.apply(r, &self.operator(s));
        let back = self.apply(s, &self.operator(r));
        forth.into_iter().zip(back).map(|(forth, back)| [forth, -back]).collect()
    }

    /// The pairs r < s of 0..k whose commutator may not vanish, in order: one of the operators changes something on
    /// which the other's components depend.
    pub(crate) fn coupled_pairs(&self) -> Vec<(usize, usize)> {
        let movers = self.movers();
        let mut coupled = BTreeSet::new();
        for (s, operator) in self.nonzero_operators().into_iter().enumerate() {
            let components: Vec<Expr<'g>> = operator.into_iter().map(|(_, b)| b).collect();
            let moving = movers.of(&components).into_iter().filter(|&r| r != s);
            coupled.extend(moving.map(|r| (r.min(s), r.max(s))));
        }
        coupled.into_iter().collect()
    }

    /// Whether all operators commute, including X_0, as far as the graph can decide.
    pub fn commutes(&self) -> bool {
        self.coupled_pairs().into_iter().all(|(r, s)| self.commutator(r, s).iter().all(|c| c.is_zero()))
    }

    /// The coordinates that each operator changes.
    pub(crate) fn movers(&self) -> Movers<'g> {
        let mut by_name: HashMap<Option<String>, Vec<usize>> = HashMap::new();
        by_name.entry(self.time.symbol_name()).or_default().push(0);
        for (s, operator) in self.nonzero_operators().into_iter().enumerate() {
            let moving = operator.into_iter().map(|(i, _)| self.coordinates[i]);
            moving.for_each(|x| by_name.entry(x.symbol_name()).or_default().push(s));
        }
        Movers { graph: self.graph, by_name }
    }

    /// The components of X_0..X_k that are not zero, with their coordinates.
    fn nonzero_operators(&self) -> Vec<Vec<(usize, Expr<'g>)>> {
        let drift = self.b0.iter().copied().enumerate().filter(|(_, b)| !b.is_zero()).collect();
        std::iter::once(drift).chain(self.b.transpose().nonzero_rows()).collect()
    }

    /// The components b_is of X_s; for s = 0, the drift.
    pub(crate) fn operator(&self, s: usize) -> Vec<Expr<'g>> {
        if s == 0 { self.b0.clone() } else { self.b.column(s - 1).collect() }
    }

    /// The frame of X_0 and the first `operators` operators, or all if there are fewer.
    #[must_use]
    pub fn restricted(&self, operators: usize) -> Frame<'g> {
        let columns = operators.min(self.operators());
        let row = |i| self.b.nonzero(i).filter(|&(s, _)| s < columns).collect();
        let b = Matrix::from_rows(columns, (0..self.b.rows()).map(row).collect());
        Frame { b, a: None, ..self.clone() }
    }

    /// The frame of X_0 and the listed operators, numbered from 0, in the order of the list.
    ///
    /// # Panics
    /// If a number is out of range.
    #[must_use]
    pub fn permuted(&self, order: &[usize]) -> Frame<'g> {
        Frame {
            b: Matrix::from_fn(self.b.rows(), order.len(), |i, s| self.b[(i, order[s])]),
            a: None,
            ..self.clone()
        }
    }

    /// The frame with `f` applied to every coefficient.
    #[must_use]
    pub fn map(&self, mut f: impl FnMut(Expr<'g>) -> Expr<'g>) -> Frame<'g> {
        let (b, a) = (self.b.map(&mut f), self.a.as_ref().map(|a| a.map(&mut f)));
        Frame { b, b0: self.b0.iter().map(|&x| f(x)).collect(), a, ..self.clone() }
    }

    /// The frame with all its expressions, including time and coordinates, replaced by expressions in another
    /// graph.
    #[must_use]
    pub fn written_in<'n>(&self, graph: &'n Graph, mut f: impl FnMut(Expr<'g>) -> Expr<'n>) -> Frame<'n> {
        Frame {
            graph,
            time: f(self.time),
            coordinates: self.coordinates.iter().map(|&x| f(x)).collect(),
            b: self.b.map(&mut f),
            b0: self.b0.iter().map(|&x| f(x)).collect(),
            a: self.a.as_ref().map(|a| a.map(&mut f)),
        }
    }

    /// Rank of b at almost all points, as decided by the graph; the rank is lower if numerical values show
    /// that the operators are dependent.
    pub fn rank(&self) -> usize {
        let known = self.graph.generic_rank_of_entries(self.b.columns(), &self.b.nonzero_rows());
        let near = Neighbourhood::anywhere(self.graph, &self.b.nonzero_entries());
        let seen = near.rank(self.graph, &self.b);
        seen.map_or(known, |seen| seen.min(known))
    }
}

/// For each coordinate, and for time, the operators that change it.
pub(crate) struct Movers<'g> {
    graph: &'g Graph,
    by_name: HashMap<Option<String>, Vec<usize>>,
}

impl<'g> Movers<'g> {
    /// The operators X_s, s = 0..k, for which X_s f is not evidently 0 for at least one of the functions f.
    pub(crate) fn of(&self, functions: &[Expr<'g>]) -> BTreeSet<usize> {
        let symbols = self.graph.symbols_of(functions);
        symbols.iter().filter_map(|x| self.by_name.get(&x.symbol_name())).flatten().copied().collect()
    }
}

/// Returns an error unless `found` equals `expected`.
pub(crate) fn shape(what: &'static str, found: usize, expected: usize) -> Result<(), AlgebraError> {
    if found == expected { Ok(()) } else { Err(AlgebraError::Shape { what, found, expected }) }
}

/// The coefficients and the constant parts of expressions affine in `symbols`; otherwise the index of the first
/// expression that is not.
fn affine_parts<'g>(
    graph: &'g Graph,
    symbols: &[Expr<'g>],
    expressions: &[Expr<'g>],
) -> Result<(Matrix<Expr<'g>>, Vec<Expr<'g>>), usize> {
    let mut rows = Vec::with_capacity(expressions.len());
    let mut constants = Vec::with_capacity(expressions.len());
    for (row, &expression) in expressions.iter().enumerate() {
        let (coefficients, constant) = affine(graph, expression, symbols).ok_or(row)?;
        rows.push(coefficients);
        constants.push(constant);
    }
    Ok((Matrix::from_fn(rows.len(), symbols.len(), |i, j| rows[i][j]), constants))
}
