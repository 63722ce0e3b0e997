//! Invariant measures whose density is a power of a polynomial in the coordinates.

use pc_mech::{Expr, Number, System};

use crate::error::AnalysisError;
use crate::integrals::rates::Rates;
use crate::measures::invariant_measure::{InvariantMeasure, divergence};

/// The largest degree of the polynomial.
const DEGREE: u32 = 2;

/// The largest number of coefficients of the polynomial.
const MOST_COEFFICIENTS: usize = 60;

/// Twice the powers that are tried.
const HALVES: [i64; 8] = [-1, 1, -2, 2, -3, 3, -4, 4];

/// The invariant measure P^c dx dy, with a polynomial P of the second degree in the coordinates, or in sines and cosines of
/// angles, and a half-integer c from −2 to 2; `None` if there is none.
///
/// N = P^c satisfies Ṅ + N div = 0 if Ṗ + P div/c = 0: P is a Darboux polynomial, and this is linear in its coefficients, which are
/// functions of the parameters. An example is Routh's sphere, which rolls on a plane with its mass centre off its middle: with r
/// from the centre of mass to the point of contact, N is a power of AC + m r·Ir, the factor of det M that no entry of M shows
/// [Borisov and Mamaev, 2002].
///
/// # Errors
/// As for [`invariant_measure`](crate::invariant_measure).
pub(crate) fn power_of_polynomial<'g>(
    system: &System<'g>,
) -> Result<Option<InvariantMeasure<'g>>, AnalysisError> {
    let (graph, divergence) = (system.graph(), divergence(system)?);
    let rates = Rates::canonical(&system.canonical()?);
    let terms = rates.ansatz(0, DEGREE).functions;
    if terms.len() > MOST_COEFFICIENTS {
        return Ok(None);
    }
    let slopes = rates.of_all(&terms)?;
    for power in HALVES.map(|twice| Number::ratio(twice, 2)) {
        let growth = divergence / Expr::from(power);
        let columns: Vec<Vec<Expr<'g>>> =
            terms.iter().zip(&slopes).map(|(&term, &slope)| vec![slope + growth * term]).collect();
        let relation = graph.linear_relations_over(&columns, &rates.indeterminates).into_iter().next();
        if let Some(relation) = relation {
            let polynomial = graph.dot(relation, terms.iter().copied());
            return Ok(Some(InvariantMeasure { factors: vec![(polynomial, power)] }));
        }
    }
    Ok(None)
}
