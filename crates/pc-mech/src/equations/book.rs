//! The equations as a book would print them: sums of products of quasi-velocities with collected coefficients.

use pc_expr::{Expr, Folding, Graph, Polynomial, Style};

use crate::equations::poincare::Equations;
use crate::system::system::System;

impl<'g> Equations<'g> {
    /// The left-hand and right-hand sides of M η̇ = r, as k pairs of texts.
    ///
    /// A right-hand side that is a polynomial in the quasi-velocities is written as a sum of their products; the
    /// compiled equations nest these products where that saves operations.
    pub fn balance(&self, style: Style) -> Vec<(String, String)> {
        let graph = self.system.graph();
        let rates = self.system.accelerations();
        (0..self.right_hand_side().len())
            .map(|s| {
                let left = graph.sum(self.mass_matrix().nonzero(s).map(|(r, entry)| entry * rates[r]));
                let right =
                    expanded(&self.system, self.right_hand_side()[s], &self.system.quasi_velocities, style);
                (left.display(style), right)
            })
            .collect()
    }

    /// The right-hand sides of the [balance](Equations::balance) in their written form, in the graph `page`;
    /// none for right-hand sides that are not polynomials, which are written
    /// [unchanged](Equations::right_hand_side).
    pub fn written<'p>(&self, page: &'p Graph) -> Vec<Option<Expr<'p>>> {
        sums_of_products(&self.system, self.right_hand_side(), &self.system.quasi_velocities, page)
    }
}

/// An expression expanded into a sum of products of `variables`, if it is a polynomial in them.
pub(crate) fn expanded<'g>(
    system: &System<'g>,
    expression: Expr<'g>,
    variables: &[Expr<'g>],
    style: Style,
) -> String {
    // A graph of its own keeps the expanded form.
    let page = system.graph().page(Folding::Structural);
    let written = sums_of_products(system, &[expression], variables, &page)[0];
    written.map_or_else(|| expression.display(style), |written| written.display(style))
}

/// Several expressions, each expanded into a sum of products, in the graph `page` with symbols in book order;
/// `None` for those that are not polynomials.
pub(crate) fn sums_of_products<'g, 'p>(
    system: &System<'g>,
    expressions: &[Expr<'g>],
    variables: &[Expr<'g>],
    page: &'p Graph,
) -> Vec<Option<Expr<'p>>> {
    let graph = system.graph();
    let parameters: Vec<Expr<'g>> = system.parameters.iter().map(|&(symbol, _)| symbol).collect();
    let polynomials: Vec<Option<Polynomial<'g>>> = expressions
        .iter()
        .map(|&expression| {
            let mut polynomial = graph.polynomial(expression, variables)?;
            for (_, coefficient) in &mut polynomial.terms {
                *coefficient = graph.shorten(&[*coefficient], &parameters)[0];
            }
            Some(polynomial)
        })
        .collect();
    if polynomials.iter().any(Option::is_some) {
        for symbol in parameters.iter().chain(system.frame.coordinates()).chain(variables) {
            page.symbol(&symbol.symbol_name().unwrap_or_default());
        }
    }
    let known: Vec<Polynomial<'g>> = polynomials.iter().flatten().cloned().collect();
    let mut written = Polynomial::expanded(&known, graph, page).into_iter();
    polynomials.iter().map(|polynomial| polynomial.as_ref().and_then(|_| written.next())).collect()
}
