//! Poisson's theorem: the brackets of all pairs of functions, expressed through the functions.

use pc_mech::Expr;

use crate::brackets::poisson_bracket::PoissonBracket;
use crate::error::AnalysisError;
use crate::integrals::polynomials::{Generator, independent, monomials};
use crate::integrals::search::binomial;

/// The largest number of products of functions among which a bracket is sought.
const MOST_PRODUCTS: usize = 130;
/// The largest degree of these products.
const LARGEST_DEGREE: u32 = 3;
/// The greatest length of a bracket that is expressed, counted in operations of the written-out expression.
const LONGEST: u32 = 4_000;

/// A function of the variables of a bracket, with the symbol that denotes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DenotedFunction<'g> {
    /// The symbol.
    pub symbol: Expr<'g>,
    /// The function f(z).
    pub value: Expr<'g>,
}

/// Functions that are closed under the bracket as far as their brackets are decided, with the bracket of every pair.
///
/// If the functions are integrals of the motion that the bracket generates, so are their brackets (Poisson's theorem).
#[derive(Clone, Debug)]
pub struct BracketAlgebra<'g> {
    functions: Vec<DenotedFunction<'g>>,
    given: usize,
    pairs: Vec<PairBracket<'g>>,
}

/// The bracket of a pair of functions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairBracket<'g> {
    /// The places i < j of the functions.
    pub pair: [usize; 2],
    /// (f_i, f_j) as a function of the variables.
    pub value: Expr<'g>,
    /// The same through the functions.
    pub meaning: BracketMeaning<'g>,
}

/// What the bracket of two functions is, in terms of the functions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BracketMeaning<'g> {
    /// A polynomial in the symbols of the functions, with functions of the parameters as coefficients; the identity is
    /// proved.
    Polynomial(Expr<'g>),
    /// A new function, independent of those before it, at this place.
    New(usize),
    /// A function of the functions that is no polynomial of low degree in them.
    Dependent,
    /// It is not decided: the expression is too long, or there are no more symbols.
    Undecided,
}

impl<'g> BracketAlgebra<'g> {
    /// The functions: those that were given, then the new ones.
    pub fn functions(&self) -> &[DenotedFunction<'g>] {
        &self.functions
    }

    /// The functions that are brackets of others and independent of those that were given.
    pub fn new_functions(&self) -> &[DenotedFunction<'g>] {
        &self.functions[self.given..]
    }

    /// The brackets of all pairs i < j, ordered by i and j.
    pub fn pairs(&self) -> &[PairBracket<'g>] {
        &self.pairs
    }

    /// Whether all brackets vanish: the functions are in involution.
    pub fn is_commutative(&self) -> bool {
        self.pairs.iter().all(|pair| pair.value.is_zero())
    }

    /// Whether every bracket is a function of the functions.
    pub fn is_closed(&self) -> bool {
        self.pairs.iter().all(|pair| pair.meaning != BracketMeaning::Undecided)
    }
}

impl<'g> PoissonBracket<'g> {
    /// The brackets of every pair of functions, as polynomials of degree up to 3 in the functions where this is possible.
    ///
    /// A bracket that is independent of the functions is added to them under the next of the symbols `new`, and its brackets
    /// are formed too, as long as there are symbols left. Functions and brackets may be long; brackets of more than 4000
    /// operations are left undecided.
    ///
    /// # Errors
    /// [`AnalysisError::NotAVariable`] for a function of anything other than variables and constants.
    ///
    /// ```
    /// use pc_analysis::{BracketMeaning, DenotedFunction, PoissonBracket};
    /// use pc_mech::{Graph, System};
    ///
    /// let graph = Graph::new();
    /// let point = System::builder(&graph)
    ///     .coordinates(["x", "y", "z"])
    ///     .lagrangian(|_, _, v| (v[0].square() + v[1].square() + v[2].square()) / 2.0)
    ///     .build()?;
    /// let [x, y, z, px, py, pz] = graph.symbols(["x", "y", "z", "p_x", "p_y", "p_z"]);
    /// let [k1, k2, k3] = graph.symbols(["K1", "K2", "K3"]);
    /// let given = [(k1, y * pz - z * py), (k2, z * px - x * pz)];
    /// let given = given.map(|(symbol, value)| DenotedFunction { symbol, value });
    /// let algebra = PoissonBracket::new(&point).algebra(&given, &[k3])?;
    /// assert_eq!(algebra.new_functions(), [DenotedFunction { symbol: k3, value: x * py - y * px }]);
    /// let meanings: Vec<_> = algebra.pairs().iter().map(|pair| pair.meaning).collect();
    /// let [minus_k2, k1] = [-k2, k1].map(BracketMeaning::Polynomial);
    /// assert_eq!(meanings, [BracketMeaning::New(2), minus_k2, k1]); // so(3)
    /// # Ok::<(), pc_analysis::AnalysisError>(())
    /// ```
    pub fn algebra(
        &self,
        functions: &[DenotedFunction<'g>],
        new: &[Expr<'g>],
    ) -> Result<BracketAlgebra<'g>, AnalysisError> {
        let values: Vec<Expr<'g>> = functions.iter().map(|f| f.value).collect();
        self.check(&values)?;
        let mut all = functions.to_vec();
        let mut pairs = Vec::new();
        let mut symbols = new.iter();
        let mut last = 1;
        while last < all.len() {
            for first in 0..last {
                let value = self.graph().shorten(&self.along(&[all[first].value], all[last].value), &[])[0];
                let mut meaning = self.meaning(&all, value);
                if meaning == BracketMeaning::Undecided
                    && value.tree_cost() <= LONGEST
                    && let Some(&symbol) = symbols.next()
                {
                    meaning = BracketMeaning::New(all.len());
                    all.push(DenotedFunction { symbol, value });
                }
                pairs.push(PairBracket { pair: [first, last], value, meaning });
            }
            last += 1;
        }
        pairs.sort_unstable_by_key(|pair| pair.pair);
        Ok(BracketAlgebra { functions: all, given: functions.len(), pairs })
    }

    /// What a function is in terms of the functions.
    fn meaning(&self, functions: &[DenotedFunction<'g>], value: Expr<'g>) -> BracketMeaning<'g> {
        if value.is_zero() {
            return BracketMeaning::Polynomial(Expr::ZERO);
        }
        if value.tree_cost() > LONGEST {
            return BracketMeaning::Undecided;
        }
        let within =
            |&degree: &u32| binomial(functions.len() + degree as usize, degree as usize) <= MOST_PRODUCTS;
        let polynomial = (1..=LARGEST_DEGREE)
            .take_while(within)
            .find_map(|degree| self.polynomial(functions, value, degree));
        if let Some(polynomial) = polynomial {
            return BracketMeaning::Polynomial(polynomial);
        }
        let known: Vec<Expr<'g>> = functions.iter().map(|f| f.value).collect();
        match independent(self.graph(), self.variables(), &known, [value]).is_empty() {
            true => BracketMeaning::Dependent,
            false => BracketMeaning::Undecided,
        }
    }

    /// The function as a polynomial in the symbols of the functions, proved.
    fn polynomial(
        &self,
        functions: &[DenotedFunction<'g>],
        value: Expr<'g>,
        degree: u32,
    ) -> Option<Expr<'g>> {
        let graph = self.graph();
        let of = |f: fn(&DenotedFunction<'g>) -> Expr<'g>| {
            let generators: Vec<Generator<'g>> =
                functions.iter().map(|function| (f(function), degree)).collect();
            monomials(&generators, degree)
        };
        let (symbols, products) = (of(|f| f.symbol), of(|f| f.value));
        let columns: Vec<Vec<Expr<'g>>> = products.iter().chain([&value]).map(|&f| vec![f]).collect();
        let dependent = graph.dependent_columns(&columns, self.parameters());
        let (_, seen) = dependent.into_iter().find(|&(j, _)| j == products.len())?;
        let used: Vec<usize> = (0..products.len()).filter(|&j| !seen[j].is_zero()).collect();
        let columns: Vec<Vec<Expr<'g>>> =
            used.iter().map(|&j| products[j]).chain([value]).map(|f| vec![f]).collect();
        let mut relations = graph.linear_relations_over(&columns, self.parameters()).into_iter();
        let a = relations.find(|a| a.last().is_some_and(|last| !last.is_zero()))?;
        let (of_value, of_products) = a.split_last()?;
        let quotients: Vec<Expr<'g>> = of_products.iter().map(|&a| -a / *of_value).collect();
        let coefficients = graph.shorten(&quotients, &[]);
        Some(graph.dot(coefficients, used.into_iter().map(|j| symbols[j])))
    }
}
