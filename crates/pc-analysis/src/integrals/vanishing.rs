//! Whether a function vanishes on a level.

use pc_mech::Expr;

use crate::integrals::polynomials::{Generator, monomials};
use crate::integrals::rates::Rates;

/// The largest number of products of multipliers and equations.
const MOST_PRODUCTS: usize = 500;
/// The greatest length of a function that is divided, counted in operations of the written-out expression.
const LONGEST: u32 = 4_000;
/// The degree in the coordinates of the multipliers of functions that are no polynomials in them.
const USUAL_DEGREE: u32 = 2;

/// The degrees in velocities and in coordinates; that in the coordinates is unknown for sines and cosines of them.
#[derive(Clone, Copy)]
struct Degrees {
    velocities: u32,
    coordinates: Option<u32>,
}

impl Degrees {
    fn of<'g>(rates: &Rates<'g>, f: Expr<'g>) -> Option<Degrees> {
        Some(Degrees {
            velocities: rates.graph.total_degree(f, &rates.moving)?,
            coordinates: rates.graph.total_degree(f, &rates.coordinates),
        })
    }
}

/// Whether f vanishes wherever all `equations` g_i = 0 hold and f has a value.
///
/// The proof is a representation D f = Σ q_i g_i with polynomials q_i in velocities and coordinates, or in their sines and
/// cosines, over the field of the parameters; D is the common denominator of f.
pub(crate) fn vanishes_where<'g>(rates: &Rates<'g>, f: Expr<'g>, equations: &[Expr<'g>]) -> bool {
    let graph = rates.graph;
    if f.is_zero() {
        return true;
    }
    if f.tree_cost() > LONGEST {
        return false;
    }
    // Fewer factors in the denominator leave fewer products to try.
    let f = graph.shorten(&[f], &rates.moving)[0];
    let divisor = graph.common_denominator(f);
    let numerator = f * divisor;
    let Some(products) = products(rates, numerator, equations) else { return false };
    let columns: Vec<Vec<Expr<'g>>> = products.iter().chain([&numerator]).map(|&f| vec![f]).collect();
    let dependent = graph.dependent_columns(&columns, &rates.indeterminates);
    let Some((_, coefficients)) = dependent.into_iter().find(|&(j, _)| j == products.len()) else {
        return false;
    };
    // The representation is written out and folded.
    let used = products.iter().zip(&coefficients).filter(|(_, a)| !a.is_zero());
    let used: Vec<Vec<Expr<'g>>> = used.map(|(&f, _)| vec![f]).chain([vec![numerator]]).collect();
    let relations = graph.linear_relations_over(&used, &rates.indeterminates);
    // A factor that is zero for the present values proves nothing there.
    relations.iter().any(|a| a.last().is_some_and(|&last| !rates.at_present(last).is_zero()))
}

/// The products of the equations and the monomials that their multipliers may contain; `None` if there are too many.
fn products<'g>(rates: &Rates<'g>, numerator: Expr<'g>, equations: &[Expr<'g>]) -> Option<Vec<Expr<'g>>> {
    let whole = Degrees::of(rates, numerator)?;
    let mut all = Vec::new();
    for &equation in equations {
        let own = Degrees::of(rates, equation)?;
        if own.velocities > whole.velocities {
            continue;
        }
        let degree = whole.velocities - own.velocities;
        let in_coordinates = match (whole.coordinates, own.coordinates) {
            (Some(whole), Some(own)) => whole.checked_sub(own),
            _ => Some(USUAL_DEGREE),
        };
        let Some(in_coordinates) = in_coordinates else { continue };
        let moving: Vec<Generator<'g>> = rates.moving.iter().map(|&z| (z, degree)).collect();
        let places = rates.ansatz(degree, in_coordinates).functions;
        for velocities in monomials(&moving, degree) {
            all.extend(places.iter().map(|&place| velocities * place * equation));
            if all.len() > MOST_PRODUCTS {
                return None;
            }
        }
    }
    Some(all)
}
