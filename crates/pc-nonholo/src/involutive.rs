//! The directions that velocities reach by commutators.

use pc_mech::{Expr, Neighbourhood, System};

/// Components of commutators below this are rounding: one that does not vanish is of order one.
pub(crate) const ROUNDING: f64 = 1e-9;

/// A field U = U^p X_p, p = 0..k; X_0 is that of time.
pub(crate) type Field<'g> = Vec<Expr<'g>>;

/// Fields that, with X_0..X_l, span at almost every point all commutators of X_0..X_l, those of commutators included
/// [Frobenius; Chow, Math. Ann. 117 (1939) 98].
pub(crate) fn involutive_closure<'g>(
    system: &System<'g>,
    l: usize,
    near: &Neighbourhood<'g>,
) -> Vec<Field<'g>> {
    let (graph, k) = (system.graph(), system.quasi_velocities().len());
    let generator =
        |p: usize| (0..=k).map(|q| if p == q { Expr::ONE } else { Expr::ZERO }).collect::<Field<'g>>();
    let generators: Vec<Field<'g>> = (0..=l).map(generator).collect();
    let mut fields = generators.clone();
    let mut next = 0;
    while next < fields.len() && fields.len() <= k {
        for generator in &generators {
            let bracket = commutator(system, generator, &fields[next]);
            // What the graph cannot tell from zero is tried in numbers.
            if near.largest(graph, &bracket[l + 1..]) <= ROUNDING {
                continue;
            }
            fields.push(bracket);
            if graph.generic_rank(&fields) < fields.len() {
                fields.pop();
            }
        }
        next += 1;
    }
    fields.split_off(l + 1)
}

/// [U, V]^m = U(V^m) − V(U^m) + c_pq^m U^p V^q, p, q = 0..k.
fn commutator<'g>(system: &System<'g>, u: &Field<'g>, v: &Field<'g>) -> Field<'g> {
    let (graph, structure) = (system.graph(), system.structure());
    let forth = along(system, u, v);
    let back = along(system, v, u);
    let mut brackets: Vec<Vec<Expr<'g>>> = forth.iter().zip(back).map(|(&f, b)| vec![f, -b]).collect();
    for (p, q, m, c) in structure.nonzero() {
        brackets[m].push(c * (u[p] * v[q] - u[q] * v[p]));
    }
    let sums: Vec<Expr<'g>> = brackets.into_iter().map(|terms| graph.sum(terms)).collect();
    graph.shorten(&sums, &[])
}

/// U f = U^p X_p f for each f.
fn along<'g>(system: &System<'g>, u: &Field<'g>, functions: &[Expr<'g>]) -> Vec<Expr<'g>> {
    let (graph, frame) = (system.graph(), system.frame());
    let rate = |i: usize| {
        let row = std::iter::once(frame.b0()[i]).chain(frame.b().row(i).iter().copied());
        graph.dot(row, u.iter().copied())
    };
    let x = frame.coordinates().iter().enumerate().map(|(i, &x)| (x, rate(i)));
    let rates: Vec<_> = x.chain([(frame.time(), u[0])]).collect();
    graph.directional(functions, &rates)
}
