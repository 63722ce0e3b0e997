//! First integrals from an ansatz.

use pc_expr::{Expr, Function, Number, Scalar};

use crate::error::AnalysisError;
use crate::integrals::polynomials::{Generator, independent, monomials};
use crate::integrals::rates::Rates;

/// The form of the first integrals to be found: Σ a_jl m_j f_l with functions a_jl of the parameters, monomials m_j in
/// the quasi-velocities (or momenta) up to a degree, and given functions f_l of (t, x).
#[derive(Clone, Debug)]
pub struct Ansatz<'g> {
    /// Degree in η or y.
    pub degree: u32,
    /// f_1, f_2, …, simple ones first; they include [`Expr::ONE`] if the coefficients may be constants.
    pub functions: Vec<Expr<'g>>,
    /// Integrals that are already known: functions of them are not returned.
    pub known: Vec<Expr<'g>>,
}

impl<'g> Rates<'g> {
    /// A basis of the integrals Σ a_j f_j of `functions` f_j, over the field of the rational functions of the parameters,
    /// including constants and integrals that are functions of each other.
    ///
    /// The functions are of (t, x, η) or (t, x, y), and may contain parameters. Each integral is proved: its rate is
    /// folded to zero, for all values of the parameters; [bind](Rates::with_parameters_bound) them to search for
    /// integrals at given values. See [`linear_relations_over`](pc_expr::Graph::linear_relations_over) for integrals
    /// that may be missed.
    ///
    /// # Errors
    /// [`AnalysisError::NotAVariable`] for a function of a symbol that does not belong to the motion.
    pub fn integrals_among(&self, functions: &[Expr<'g>]) -> Result<Vec<Expr<'g>>, AnalysisError> {
        let rates: Vec<Vec<Expr<'g>>> = self.of_all(functions)?.into_iter().map(|rate| vec![rate]).collect();
        let relations = self.graph.linear_relations_over(&rates, &self.indeterminates);
        Ok(relations.into_iter().map(|a| self.graph.dot(a, functions.iter().copied())).collect())
    }

    /// The integrals that have the form of the ansatz, functionally independent of each other and of the
    /// known ones; those of low degree come first.
    ///
    /// # Errors
    /// [`AnalysisError::NotAVariable`] for a function of a symbol that does not belong to the motion.
    ///
    /// ```
    /// use pc_analysis::Rates;
    /// use pc_mech::{Graph, System};
    /// let graph = Graph::new();
    /// let plane = System::builder(&graph)
    ///     .coordinates(["x", "y"])
    ///     .lagrangian(|_, x, v| (v[0].square() + v[1].square() - x[0].square() - x[1].square()) / 2.0)
    ///     .build()?;
    /// let rates = Rates::canonical(&plane.canonical()?);
    /// let found = rates.integrals(&rates.ansatz(2, 2))?;
    /// let shown: Vec<String> = found.iter().map(|f| f.to_string()).collect();
    /// assert_eq!(shown, ["y*p_x - x*p_y", "x^2 + p_x^2", "x*y + p_x*p_y"]);
    /// # Ok::<(), pc_analysis::AnalysisError>(())
    /// ```
    pub fn integrals(&self, ansatz: &Ansatz<'g>) -> Result<Vec<Expr<'g>>, AnalysisError> {
        let moving: Vec<Generator<'g>> = self.moving.iter().map(|&z| (z, ansatz.degree)).collect();
        let functions: Vec<Expr<'g>> = monomials(&moving, ansatz.degree)
            .into_iter()
            .flat_map(|m| ansatz.functions.iter().map(move |&f| m * f))
            .collect();
        let variables: Vec<Expr<'g>> =
            [self.time].iter().chain(&self.coordinates).chain(&self.moving).copied().collect();
        Ok(independent(self.graph, &variables, &ansatz.known, self.integrals_among(&functions)?))
    }

    /// The ansatz of polynomials of degree ≤ `degree` in η or y whose coefficients are polynomials of degree
    /// ≤ `coefficients` in the coordinates, or, for coordinates that occur in the equations only in sines and
    /// cosines, in their sine and cosine; its list of known integrals is empty. Time is left out; add functions of
    /// it if they matter.
    pub fn ansatz(&self, degree: u32, coefficients: u32) -> Ansatz<'g> {
        let rates: Vec<Expr<'g>> = self.flow.iter().map(|&(_, rate)| rate).collect();
        let places: Vec<Places> = self.coordinates.iter().map(|&x| Places::of(self, x, &rates)).collect();
        let generators = self.coordinates.iter().zip(places).flat_map(|(&x, places)| {
            let angle = places.in_circle && !places.elsewhere;
            // A higher power of the sine is unnecessary: sin² is 1 − cos².
            if angle { vec![(x.cos(), coefficients), (x.sin(), 1)] } else { vec![(x, coefficients)] }
        });
        let functions = monomials(&generators.collect::<Vec<_>>(), coefficients);
        Ansatz { degree, functions, known: Vec::new() }
    }
}

/// Where a symbol occurs in an expression: in the argument of a sine or cosine, or elsewhere.
///
/// This is found by evaluating the expression over this type: the symbol itself counts as occurring
/// elsewhere, all others as occurring nowhere.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Places {
    in_circle: bool,
    elsewhere: bool,
}

impl Places {
    fn of<'g>(rates: &Rates<'g>, symbol: Expr<'g>, expressions: &[Expr<'g>]) -> Places {
        let place = |z: &Expr<'g>| (*z, Places { in_circle: false, elsewhere: *z == symbol });
        let values: Vec<_> = rates.graph.symbols_of(expressions).iter().map(place).collect();
        // All symbols have a value, so none is unbound.
        let places = rates.graph.evaluate(expressions, &values).unwrap_or_default();
        places.into_iter().fold(Places::default(), Places::or)
    }

    fn or(self, other: Places) -> Places {
        Places { in_circle: self.in_circle || other.in_circle, elsewhere: self.elsewhere || other.elsewhere }
    }
}

impl Scalar for Places {
    fn from_f64(_: f64) -> Places {
        Places::default()
    }

    fn constant(_: Number) -> Places {
        Places::default()
    }

    fn powi(self, _: i32) -> Places {
        self
    }

    fn call(function: Function, args: &[Places]) -> Places {
        let all = args.iter().copied().fold(Places::default(), Places::or);
        match function {
            Function::Sin | Function::Cos => {
                Places { in_circle: all.in_circle || all.elsewhere, elsewhere: false }
            }
            _ => all,
        }
    }
}

impl std::ops::Add for Places {
    type Output = Places;
    fn add(self, other: Places) -> Places {
        self.or(other)
    }
}

impl std::ops::Mul for Places {
    type Output = Places;
    fn mul(self, other: Places) -> Places {
        self.or(other)
    }
}

impl std::ops::Neg for Places {
    type Output = Places;
    fn neg(self) -> Places {
        self
    }
}
