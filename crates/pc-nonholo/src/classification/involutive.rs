//! The directions that velocities reach by commutators.

use pc_mech::{Expr, Neighbourhood, System};

/// A field U = U^p X_p, p = 0..k; X_0 belongs to time.
pub(crate) type OperatorField<'g> = Vec<Expr<'g>>;

/// The terms of the sums C_αm U^m, which are the components of a field along the constraints.
pub(crate) type Along<'g> = Vec<Vec<Expr<'g>>>;

/// The components, along the constraints, of the fields that complete the `allowed` ones to a family that
/// contains all its commutators at almost every point [Frobenius; Chow, Math. Ann. 117 (1939) 98].
///
/// The allowed fields are X'_0, which has the component 1 along X_0, and others that have no such component
/// and satisfy C_αm X'^m = 0; `rows` are the C_α.
pub(crate) fn involutive_closure<'g>(
    system: &System<'g>,
    allowed: &[OperatorField<'g>],
    rows: &[Vec<Expr<'g>>],
    near: &Neighbourhood<'g>,
) -> Vec<Along<'g>> {
    let (graph, k) = (system.graph(), system.quasi_velocities().len());
    let (mut fields, mut reached) = (allowed.to_vec(), Vec::new());
    let mut next = 0;
    while next < fields.len() && fields.len() <= k {
        for generator in allowed {
            if graph.check_budget().is_err() {
                return reached; // the stage of the work reports it
            }
            let bracket = commutator(system, generator, &fields[next]);
            let along: Along<'g> = rows.iter().map(|row| component(row, &bracket)).collect();
            // A zero that the graph does not recognise is decided numerically.
            if near.residual(graph, &along) <= Neighbourhood::ROUNDING {
                continue;
            }
            let sums: Vec<Expr<'g>> = bracket.into_iter().map(|terms| graph.sum(terms)).collect();
            fields.push(graph.shorten(&sums, &[]));
            if graph.generic_rank(&fields) < fields.len() {
                fields.pop();
            } else {
                reached.push(along);
            }
        }
        next += 1;
    }
    reached
}

/// The terms of C_m U^m, m = 1..k, of a field whose components are given by their terms.
fn component<'g>(row: &[Expr<'g>], field: &[Vec<Expr<'g>>]) -> Vec<Expr<'g>> {
    let products = row.iter().zip(&field[1..]).flat_map(|(&c, terms)| terms.iter().map(move |&u| c * u));
    products.filter(|term| !term.is_zero()).collect()
}

/// The terms of [U, V]^m = U(V^m) − V(U^m) + c_pq^m U^p V^q, p, q = 0..k.
fn commutator<'g>(system: &System<'g>, u: &OperatorField<'g>, v: &OperatorField<'g>) -> Vec<Vec<Expr<'g>>> {
    let structure = system.structure();
    let forth = along(system, u, v);
    let back = along(system, v, u);
    let mut brackets: Vec<Vec<Expr<'g>>> = forth.iter().zip(back).map(|(&f, b)| vec![f, -b]).collect();
    for (p, q, m, c) in structure.nonzero() {
        brackets[m].extend([c * u[p] * v[q], -(c * u[q] * v[p])]);
    }
    brackets
}

/// U f = U^p X_p f for each f.
pub(crate) fn along<'g>(system: &System<'g>, u: &OperatorField<'g>, functions: &[Expr<'g>]) -> Vec<Expr<'g>> {
    let (graph, frame) = (system.graph(), system.frame());
    let rate = |i: usize| {
        let b = frame.b().row(i);
        let row = std::iter::once(frame.b0()[i]).chain(b.iter().copied());
        graph.dot(row, u.iter().copied())
    };
    let x = frame.coordinates().iter().enumerate().map(|(i, &x)| (x, rate(i)));
    let rates: Vec<_> = x.chain([(frame.time(), u[0])]).collect();
    graph.directional(functions, &rates)
}
