//! Integrals that are polynomials in η with coefficients in a span of functions of the position.

use pc_mech::{Equations, Expr, Graph, Neighbourhood, Number};

use crate::error::AnalysisError;
use crate::integrals::integral::{Integral, Integrals, Origin};
use crate::integrals::polynomials::{Generator, combination, monomials};
use crate::integrals::rates::Rates;
use crate::integrals::search::{Search, binomial};

/// The largest number of functions with unknown coefficients; a search with this many takes some seconds.
const MOST_FUNCTIONS: usize = 600;

/// The greatest length of the accelerations along which functions are differentiated, counted in operations
/// of the written-out expressions.
const LONGEST: u32 = 4_000;

/// The largest number of products of known integrals that are excluded from the results.
const MOST_PRODUCTS: usize = 400;

/// The largest number of factors without velocities in a product of known integrals.
const MOST_OF_PLACE: u32 = 2;

/// The largest degree in the parameters that coefficients may have.
const MOST_PARAMETER_DEGREE: u32 = 4;

/// The largest number of products of parameters and functions that have unknown coefficients in a search for
/// coefficients that are polynomials in the parameters.
const MOST_WITH_PARAMETERS: usize = 300;

/// The form of the integrals to be found: Σ a_jlm m_j p_l f_m with rational a_jlm, monomials m_j in η, monomials p_l
/// in the coordinates or in their sines and cosines, and functions f_m of (t, x), 1 among them.
#[derive(Clone, Debug)]
pub struct PolynomialAnsatz<'g> {
    /// The largest degree in η.
    pub degree: u32,
    /// The f_m other than 1.
    pub functions: Vec<Expr<'g>>,
}

/// The extent of a search by an ansatz.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AnsatzSearch {
    /// A search was made, with this number of functions.
    Made {
        /// The largest degree in the coordinates.
        coefficients: u32,
        /// The number of functions with an unknown coefficient.
        functions: usize,
    },
    /// No search was made: there are too many functions.
    TooMany {
        /// The number of functions if the coefficients contain no coordinates except those in the f_m.
        functions: usize,
    },
    /// No search was made: the accelerations are too long.
    TooLong,
}

impl<'g> Integrals<'g> {
    /// Adds the integrals of an ansatz to those already known, unless they are polynomials in known ones with rational
    /// coefficients; those of low degree come first. Integrals that are other functions of earlier ones, such as the
    /// third component of the Runge–Lenz vector, are marked as dependent.
    ///
    /// The integrals are sought for the present values of the parameters. If the coefficients are polynomials
    /// in the parameters, up to a common factor, these polynomials are used and the integral is proved for
    /// all values.
    ///
    /// # Errors
    /// [`AnalysisError::NotAVariable`] for a function of a symbol that does not belong to the motion.
    ///
    /// ```
    /// use pc_analysis::{Integrals, PolynomialAnsatz};
    /// use pc_mech::{Graph, Neighbourhood, System};
    ///
    /// // Kepler's problem in the plane.
    /// let graph = Graph::new();
    /// let mu = graph.symbol("μ");
    /// let planet = System::builder(&graph)
    ///     .parameter(mu, 2.0)
    ///     .coordinates(["x", "y"])
    ///     .lagrangian(|_, x, v| {
    ///         (v[0].square() + v[1].square()) / 2.0 + mu / (x[0].square() + x[1].square()).sqrt()
    ///     })
    ///     .build()?;
    /// let equations = planet.poincare()?;
    /// let at: Vec<_> = ["t", "x", "y", "x'", "y'"].map(|name| (graph.symbol(name), 0.5)).into();
    /// let near = Neighbourhood { centre: at };
    /// let mut found = Integrals::find(&equations, &near);
    /// let [x, y] = graph.symbols(["x", "y"]);
    /// let functions = vec![1.0 / (x.square() + y.square()).sqrt()];
    /// found.add_polynomials(&equations, &near, &PolynomialAnsatz { degree: 2, functions })?;
    /// assert_eq!(found.list().len(), 4); // energy, area, and the vector of Runge and Lenz
    /// assert!(found.list().iter().all(|integral| integral.is_conserved()));
    /// # Ok::<(), pc_analysis::AnalysisError>(())
    /// ```
    pub fn add_polynomials(
        &mut self,
        equations: &Equations<'g>,
        near: &Neighbourhood<'g>,
        ansatz: &PolynomialAnsatz<'g>,
    ) -> Result<AnsatzSearch, AnalysisError> {
        let search = Search::new(equations, near);
        let graph = search.graph;
        let rates = search.rates.with_parameters_bound();
        rates.of_all(&ansatz.functions)?;
        let costs = equations.accelerations().into_iter().map(Expr::tree_cost);
        if costs.fold(0, u32::saturating_add) > LONGEST {
            return Ok(AnsatzSearch::TooLong);
        }
        // Space components of vectors given in body axes are of the third degree in sines and cosines,
        // including those of angles on which the equations do not depend.
        let cyclic =
            rates.coordinates.iter().filter(|&&x| !rates.flow.iter().any(|(_, rate)| rate.depends_on(x)));
        let circular = cyclic.flat_map(|x| [x.cos(), x.sin()]);
        let functions = ansatz.functions.iter().copied().chain(circular).collect();
        let linear = PolynomialAnsatz { degree: ansatz.degree.min(1), functions };
        let (of_linear, of_all) = (Span::new(graph, &rates, &linear, 3), Span::new(graph, &rates, ansatz, 2));
        if let Ok(span) = &of_linear {
            self.add_span(&search, &rates, span)?;
        }
        match of_all {
            Ok(span) => {
                self.add_span(&search, &rates, &span)?;
                Ok(AnsatzSearch::Made { coefficients: span.coefficients, functions: span.functions.len() })
            }
            Err(functions) => Ok(AnsatzSearch::TooMany { functions }),
        }
    }

    /// Adds the integrals in a span of functions, those of low degree first.
    fn add_span(
        &mut self,
        search: &Search<'_, 'g>,
        rates: &Rates<'g>,
        span: &Span<'g>,
    ) -> Result<(), AnalysisError> {
        let columns: Vec<Vec<Expr<'g>>> =
            rates.of_all(&span.functions)?.into_iter().map(|rate| vec![rate]).collect();
        let relations = search.graph.linear_relations(&columns);
        for degree in 0..span.up_to_degree.len() as u32 {
            let of_degree = relations.iter().filter(|a| span.degree(a) == degree);
            self.add_new(search, span, &of_degree.collect::<Vec<_>>(), degree);
        }
        Ok(())
    }

    /// Adds the relations, all of one degree, that are not polynomials in known integrals.
    fn add_new(&mut self, search: &Search<'_, 'g>, span: &Span<'g>, relations: &[&Vec<Number>], degree: u32) {
        let graph = search.graph;
        let known: Vec<Expr<'g>> = self.conserved().map(|integral| search.bind(integral.value)).collect();
        let eta = search.system().quasi_velocities();
        let products = products(graph, &known, eta, degree);
        let all = [known.as_slice(), &products].concat();
        let candidate = |a: &&Vec<Number>| combination(graph, a, &span.functions);
        let new = relations.iter().filter(|a| !is_combination(graph, &all, candidate(a)));
        let new: Vec<(&Vec<Number>, Expr<'g>)> = new.map(|a| (*a, candidate(a))).collect();
        // Energies of parts are combinations of each other and of the whole; each is listed nevertheless.
        let values = products.iter().copied().chain(new.iter().map(|&(_, value)| value));
        let columns: Vec<Vec<Expr<'g>>> = values.map(|value| vec![value]).collect();
        let dependent: Vec<usize> =
            graph.dependent_columns(&columns, &[]).into_iter().map(|(j, _)| j).collect();
        let mut known = known;
        for (place, &(relation, bound)) in (products.len()..).zip(&new) {
            if dependent.contains(&place) {
                continue;
            }
            let lifted = with_parameters(search, &span.functions, relation);
            let value = graph.shorten(&[lifted.unwrap_or(bound)], eta)[0];
            let number = 1 + self.list().iter().filter(|integral| integral.origin == Origin::Found).count();
            let integral = Integral {
                name: format!("found {number}"),
                value,
                origin: Origin::Found,
                verdict: search.proved(value),
                jumps: false,
                dependent: !search.is_new(&known, bound),
            };
            self.push(integral);
            known.push(bound);
        }
    }
}

/// The functions that have unknown coefficients in a search.
struct Span<'g> {
    /// The functions, in order of ascending degree in η.
    functions: Vec<Expr<'g>>,
    /// The number of functions of degree ≤ 0, 1, ….
    up_to_degree: Vec<usize>,
    /// The largest degree in the coordinates.
    coefficients: u32,
}

impl<'g> Span<'g> {
    /// The span whose coefficients have the largest degree up to `most` that can be searched; if there are
    /// too many functions even for degree 0, their number.
    fn new(
        graph: &'g Graph,
        rates: &Rates<'g>,
        ansatz: &PolynomialAnsatz<'g>,
        most: u32,
    ) -> Result<Span<'g>, usize> {
        let (n, k, degree) = (rates.coordinates.len(), rates.moving.len(), ansatz.degree as usize);
        let of_velocities = binomial(k + degree, degree);
        let times = 1 + ansatz.functions.len();
        for coefficients in (0..=most).rev() {
            // An angle has a sine and a cosine, so it adds no fewer functions.
            let least = binomial(n + coefficients as usize, coefficients as usize);
            if of_velocities.saturating_mul(least).saturating_mul(times) > MOST_FUNCTIONS {
                continue;
            }
            let places = place_functions(graph, rates, ansatz, coefficients);
            if of_velocities * places.len() > MOST_FUNCTIONS {
                continue;
            }
            let moving: Vec<Generator<'g>> = rates.moving.iter().map(|&z| (z, ansatz.degree)).collect();
            let up_to_degree = (0..=degree).map(|d| binomial(k + d, d) * places.len() - 1).collect();
            let products = monomials(&moving, ansatz.degree).into_iter();
            let products = products.flat_map(|m| places.iter().map(move |&f| m * f));
            // The first function is the constant 1.
            return Ok(Span { functions: products.skip(1).collect(), up_to_degree, coefficients });
        }
        Err(of_velocities.saturating_mul(times))
    }

    /// The degree in η of the combination with these coefficients.
    fn degree(&self, a: &[Number]) -> u32 {
        let last = a.iter().rposition(|a| !a.is_zero()).unwrap_or(0);
        self.up_to_degree.iter().filter(|&&count| count <= last).count() as u32
    }
}

/// The products of monomials in the coordinates and functions of the ansatz, independent of each other; the first
/// is 1.
fn place_functions<'g>(
    graph: &'g Graph,
    rates: &Rates<'g>,
    ansatz: &PolynomialAnsatz<'g>,
    coefficients: u32,
) -> Vec<Expr<'g>> {
    let simple = rates.ansatz(ansatz.degree, coefficients).functions;
    let given = [Expr::ONE].into_iter().chain(ansatz.functions.iter().copied());
    let mut all: Vec<Expr<'g>> = Vec::new();
    for product in given.flat_map(|f| simple.iter().map(move |&p| p * f)) {
        if !all.contains(&product) {
            all.push(product);
        }
    }
    // x²/r³ + y²/r³ is 1/r: a relation of functions is not an integral.
    let columns: Vec<Vec<Expr<'g>>> = all.iter().map(|&f| vec![f]).collect();
    let dependent: Vec<usize> = graph.dependent_columns(&columns, &[]).into_iter().map(|(j, _)| j).collect();
    (0..all.len()).filter(|j| !dependent.contains(j)).map(|j| all[j]).collect()
}

/// 1 and the products of at least two of the known integrals, of degree ≤ `degree` in η.
fn products<'g>(graph: &'g Graph, known: &[Expr<'g>], eta: &[Expr<'g>], degree: u32) -> Vec<Expr<'g>> {
    let with_degree = |&f: &Expr<'g>| {
        let terms = graph.polynomial(f, eta)?.terms;
        Some((f, terms.iter().map(|(exponents, _)| exponents.iter().sum::<u32>()).max().unwrap_or(0)))
    };
    let known: Vec<(Expr<'g>, u32)> = known.iter().filter_map(with_degree).collect();
    let (mut all, mut last) = (vec![Expr::ONE], vec![(Expr::ONE, 0, 0)]);
    // In addition to those with a degree in η there may be some of the place alone.
    for factors in 1..=degree + MOST_OF_PLACE {
        let longer = last.iter().flat_map(|&(product, power, first)| {
            let rest = known.iter().enumerate().skip(first);
            rest.map(move |(i, &(f, d))| (product * f, power + d, i))
        });
        last = longer.filter(|&(_, power, _)| power <= degree).take(MOST_PRODUCTS).collect();
        if factors > 1 {
            all.extend(last.iter().map(|&(product, ..)| product));
        }
    }
    all.truncate(MOST_PRODUCTS);
    all
}

/// Whether f is a linear combination, with constant coefficients, of the functions `of`, as far as
/// fingerprints can decide.
fn is_combination<'g>(graph: &'g Graph, of: &[Expr<'g>], f: Expr<'g>) -> bool {
    let columns: Vec<Vec<Expr<'g>>> = of.iter().chain([&f]).map(|&f| vec![f]).collect();
    graph.dependent_columns(&columns, &[]).iter().any(|&(j, _)| j == of.len())
}

/// The integral Σ a_i(p) f_i for all values of the parameters p that for their present values equals Σ a_i
/// f_i up to a factor, if there is one whose coefficients are polynomials of low degree in the parameters of
/// its rates; of several, the one of lowest degree.
///
/// This integral is unique up to its factor: all but the last of the functions in a relation in echelon form
/// are independent, for these values and therefore for almost all.
fn with_parameters<'g>(
    search: &Search<'_, 'g>,
    functions: &[Expr<'g>],
    relation: &[Number],
) -> Option<Expr<'g>> {
    let graph = search.graph;
    let support = (0..relation.len()).filter(|&j| !relation[j].is_zero());
    let support: Vec<Expr<'g>> = support.map(|j| functions[j]).collect();
    let rates = search.rates.of_all(&support).ok()?;
    let present = graph.symbols_of(&rates);
    let parameters = search.system().parameters().iter().map(|&(p, _)| p).filter(|p| present.contains(p));
    let generators: Vec<Generator<'g>> = parameters.map(|p| (p, MOST_PARAMETER_DEGREE)).collect();
    for degree in 0..=MOST_PARAMETER_DEGREE {
        let factors = monomials(&generators, degree);
        if factors.len() * support.len() > MOST_WITH_PARAMETERS {
            return None;
        }
        let scaled = |list: &[Expr<'g>]| -> Vec<Expr<'g>> {
            factors.iter().flat_map(|&factor| list.iter().map(move |&f| factor * f)).collect()
        };
        let columns: Vec<Vec<Expr<'g>>> = scaled(&rates).into_iter().map(|rate| vec![rate]).collect();
        let all = scaled(&support);
        let relations = graph.linear_relations(&columns).into_iter();
        let mut found = relations.map(|a| combination(graph, &a, &all));
        // An integral that vanishes for these values is a different one.
        if let Some(found) = found.find(|&f| !search.bind(f).is_zero()) {
            return Some(found);
        }
    }
    None
}
