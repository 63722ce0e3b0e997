//! Integrals that are polynomials in η with coefficients in a span of functions of the position.

use pc_mech::{Equations, Expr, Graph, Neighbourhood};

use crate::error::AnalysisError;
use crate::integrals::integral::{ConservationVerdict, Integral, Integrals, Origin};
use crate::integrals::long_constants::{symbols_with_numbers, with_symbols};
use crate::integrals::polynomials::{Generator, monomials};
use crate::integrals::rates::Rates;
use crate::integrals::search::{Search, binomial};

/// The largest number of functions with unknown coefficients by default; a search with this many takes some seconds.
const MOST_FUNCTIONS: usize = 600;

/// The largest degree in the coordinates, and the largest number of functions if the degree is higher than the usual one.
const HIGHEST: u32 = 4;
const MOST_OF_HIGHER: usize = 150;

/// The greatest length of the accelerations along which functions are differentiated, counted in operations
/// of the written-out expressions.
const LONGEST: u32 = 4_000;

/// The largest number of products of known integrals that are excluded from the results.
const MOST_PRODUCTS: usize = 400;

/// The largest number of factors without velocities in a product of known integrals.
const MOST_OF_PLACE: u32 = 2;

/// The form of the integrals to be found: Σ a_jlm m_j p_l f_m with functions a_jlm of the parameters, monomials m_j in η,
/// monomials p_l in the coordinates or in their sines and cosines, and functions f_m of (t, x), 1 among them.
#[derive(Clone, Debug)]
pub struct PolynomialAnsatz<'g> {
    /// The largest degree in η.
    pub degree: u32,
    /// The f_m other than 1.
    pub functions: Vec<Expr<'g>>,
    /// The largest number of functions with an unknown coefficient: the degree in the coordinates is the highest that has no more.
    pub most: usize,
}

impl<'g> PolynomialAnsatz<'g> {
    /// The ansatz of a degree in η without further functions, of the usual size.
    pub fn of_degree(degree: u32) -> PolynomialAnsatz<'g> {
        PolynomialAnsatz { degree, functions: Vec::new(), most: MOST_FUNCTIONS }
    }
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
    /// Adds the integrals of an ansatz to those already known, unless they are polynomials in known ones with constant
    /// coefficients; those of low degree come first. Integrals that are other functions of earlier ones, such as the
    /// third component of the Runge–Lenz vector, are marked as dependent.
    ///
    /// Integrals are sought over the field of the parameters, where each is proved for all their values, and, where the
    /// present values of the parameters admit integrals, for these values.
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
    /// let ansatz = PolynomialAnsatz { functions, ..PolynomialAnsatz::of_degree(2) };
    /// found.add_polynomials(&equations, &near, &ansatz)?;
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
        let rates = &search.rates;
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
        let linear = PolynomialAnsatz { degree: ansatz.degree.min(1), functions, most: ansatz.most };
        if let Ok(spans) = Spans::new(graph, rates, &linear, 3) {
            self.add_span(&search, &spans)?;
        }
        match Spans::new(graph, rates, ansatz, 2) {
            Ok(spans) => {
                self.add_span(&search, &spans)?;
                let span = &spans.present;
                Ok(AnsatzSearch::Made { coefficients: span.coefficients, functions: span.functions.len() })
            }
            Err(functions) => Ok(AnsatzSearch::TooMany { functions }),
        }
    }

    /// Adds the integrals in a span of functions, those of low degree first, and of one degree those for all values of the
    /// parameters first.
    fn add_span(&mut self, search: &Search<'_, 'g>, spans: &Spans<'g>) -> Result<(), AnalysisError> {
        let bound = search.rates.with_parameters_bound();
        let here = spans.present.integrals(&bound)?;
        // An integral for all values of the parameters is one for the present values; long constants hide both.
        let (always, free) = match &spans.general {
            Some((rates, span)) if spans.has_long || !here.is_empty() => (span.integrals(rates)?, rates),
            _ => (Vec::new(), &bound),
        };
        for degree in 0..spans.present.up_to_degree.len() as u32 {
            let of_degree = |all: &[(u32, Expr<'g>)]| -> Vec<Expr<'g>> {
                all.iter().filter(|(of, _)| *of == degree).map(|&(_, value)| value).collect()
            };
            let (always, here) = (of_degree(&always), of_degree(&here));
            // As many for the present values as for all values are the same.
            let are_same = !spans.has_long && always.len() == here.len();
            self.add_new(search, free, always, (degree, true));
            if !are_same {
                self.add_new(search, &bound, here, (degree, false));
            }
        }
        Ok(())
    }

    /// Adds integrals, all of one degree, that are not polynomials in known integrals, with functions of the parameters that
    /// `rates` leaves free as coefficients.
    fn add_new(
        &mut self,
        search: &Search<'_, 'g>,
        rates: &Rates<'g>,
        candidates: Vec<Expr<'g>>,
        (degree, always): (u32, bool),
    ) {
        let (graph, eta) = (search.graph, search.system().quasi_velocities());
        let in_field = |f: Expr<'g>| with_symbols(graph, &[if always { f } else { search.bind(f) }])[0];
        let known = self.list().iter().filter(|integral| match always {
            true => {
                matches!(integral.verdict, ConservationVerdict::Conserved | ConservationVerdict::BetweenJumps)
            }
            false => integral.is_conserved(),
        });
        let mut known: Vec<Expr<'g>> = known.map(|integral| in_field(integral.value)).collect();
        let candidates: Vec<Expr<'g>> = candidates.into_iter().map(in_field).collect();
        let numbers = symbols_with_numbers(graph, &[known.as_slice(), &candidates].concat());
        let mut constants = rates.indeterminates.clone();
        constants.extend(numbers.iter().map(|&(symbol, _)| symbol));
        let before = known.clone();
        let mut added: Vec<Expr<'g>> = Vec::new();
        for candidate in candidates {
            let products = products(graph, &known, eta, degree);
            // Energies of parts are combinations of each other and of the whole; each is listed nevertheless.
            let is_polynomial =
                |of: &[Expr<'g>]| is_combination(graph, &[&products, of].concat(), candidate, &constants);
            if candidate.is_zero() || is_polynomial(&before) || is_polynomial(&added) {
                continue;
            }
            let value = graph.substitute(&[graph.shorten(&[candidate], eta)[0]], &numbers)[0];
            let number = 1 + self.list().iter().filter(|integral| integral.origin == Origin::Found).count();
            let integral = Integral {
                name: format!("found {number}"),
                value,
                origin: Origin::Found,
                verdict: match search.proved(value) {
                    ConservationVerdict::ConservedHere if always => ConservationVerdict::Conserved,
                    verdict => verdict,
                },
                jumps: false,
                dependent: !search.is_new(&known, candidate),
                level: Vec::new(),
            };
            self.push(integral);
            added.push(candidate);
            known.push(candidate);
        }
    }
}

/// The functions that have unknown coefficients, for the present values of the parameters, and for all values, with the
/// rates in which these are free, if they are others.
struct Spans<'g> {
    present: Span<'g>,
    general: Option<(Rates<'g>, Span<'g>)>,
    /// Whether the equations or the functions contain long constants, which stand for any value.
    has_long: bool,
}

impl<'g> Spans<'g> {
    /// As for [`Span::new`].
    fn new(
        graph: &'g Graph,
        rates: &Rates<'g>,
        ansatz: &PolynomialAnsatz<'g>,
        usual: u32,
    ) -> Result<Spans<'g>, usize> {
        let functions = ansatz.functions.iter().map(|&f| rates.at_present(f)).collect();
        let bound = PolynomialAnsatz { functions, ..*ansatz };
        let present = Span::new(graph, &rates.with_parameters_bound(), &bound, usual)?;
        let free = rates.with_long_constants_free(&ansatz.functions);
        let has_long = free.is_some();
        let are_others = has_long || rates.depend_on_present_values(&ansatz.functions);
        let general = are_others.then(|| {
            let rates = free.unwrap_or_else(|| rates.clone());
            let functions = with_symbols(graph, &ansatz.functions);
            let span = Span::new(graph, &rates, &PolynomialAnsatz { functions, ..*ansatz }, usual).ok()?;
            Some((rates, span))
        });
        Ok(Spans { present, general: general.flatten(), has_long })
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
    /// The span whose coefficients have the largest degree that can be searched, of few functions if it is above the `usual`; if
    /// there are too many functions even for degree 0, their number.
    fn new(
        graph: &'g Graph,
        rates: &Rates<'g>,
        ansatz: &PolynomialAnsatz<'g>,
        usual: u32,
    ) -> Result<Span<'g>, usize> {
        let (n, k, degree) = (rates.coordinates.len(), rates.moving.len(), ansatz.degree as usize);
        let of_velocities = binomial(k + degree, degree);
        let times = 1 + ansatz.functions.len();
        for coefficients in (0..=HIGHEST).rev() {
            let most = if coefficients > usual { MOST_OF_HIGHER.min(ansatz.most) } else { ansatz.most };
            // An angle has a sine and a cosine, so it adds no fewer functions.
            let least = binomial(n + coefficients as usize, coefficients as usize);
            if of_velocities.saturating_mul(least).saturating_mul(times) > most {
                continue;
            }
            let places = place_functions(graph, rates, ansatz, coefficients);
            if of_velocities * places.len() > most {
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

    /// The integrals in the span over the field of the parameters that stand for any value, each with its degree in η.
    fn integrals(&self, rates: &Rates<'g>) -> Result<Vec<(u32, Expr<'g>)>, AnalysisError> {
        let columns: Vec<Vec<Expr<'g>>> =
            rates.of_all(&self.functions)?.into_iter().map(|rate| vec![rate]).collect();
        let relations = rates.graph.linear_relations_over(&columns, &rates.indeterminates).into_iter();
        let integral = |a: Vec<Expr<'g>>| {
            (self.degree(&a), rates.graph.dot(a.iter().copied(), self.functions.iter().copied()))
        };
        Ok(relations.map(integral).collect())
    }

    /// The degree in η of the combination with these coefficients.
    fn degree(&self, a: &[Expr<'g>]) -> u32 {
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
    let dependent = graph.dependent_columns(&columns, &rates.indeterminates);
    let dependent: Vec<usize> = dependent.into_iter().map(|(j, _)| j).collect();
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

/// Whether f is a linear combination of the functions `of`, with functions of the `constants` as coefficients, as far
/// as fingerprints can decide.
fn is_combination<'g>(graph: &'g Graph, of: &[Expr<'g>], f: Expr<'g>, constants: &[Expr<'g>]) -> bool {
    let columns: Vec<Vec<Expr<'g>>> = of.iter().chain([&f]).map(|&f| vec![f]).collect();
    graph.dependent_columns(&columns, constants).iter().any(|&(j, _)| j == of.len())
}
