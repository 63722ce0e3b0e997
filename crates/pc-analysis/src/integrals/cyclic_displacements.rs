//! Cyclic displacements: operators whose momentum is an integral.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use pc_mech::{Expr, Graph, Number, System};

use crate::integrals::polynomials::combination;

/// A displacement X = a_s X_s with constant a_s, whose momentum a_s y_s is conserved by the motion.
#[derive(Clone, Debug, PartialEq)]
pub struct CyclicDisplacement<'g> {
    /// a_1..a_k, coprime integers.
    pub coefficients: Vec<Number>,
    /// The integral a_s ∂L/∂η_s in terms of (t, x, η).
    pub momentum: Expr<'g>,
    /// Whether X commutes with X_0..X_k, that is, a_s c_rs^m = 0 for r = 0..k. If so, the condition is X L + a_s
    /// Q_s = 0; otherwise the condition holds because terms of this particular Lagrangian cancel.
    pub commutes: bool,
}

impl<'g> CyclicDisplacement<'g> {
    /// A basis of the displacements X = a_s X_s, with rational constants a_s, whose momentum is an integral:
    ///
    ///   d/dt (a_s y_s) = a_s [(c_rs^m η_r + c_0s^m) y_m + X_s L + Q_s] = 0   identically in (t, x, η),
    ///
    /// by (9). The condition is sufficient and, for constant a_s, necessary. The condition holds in particular for
    /// the displacements that are cyclic in Chetaev's sense: they [commute](CyclicDisplacement::commutes) with all
    /// operators, and X L = 0. In the frame X_s = ∂/∂x_s these are the coordinates that are cyclic in Lagrange's
    /// sense. The condition also holds for X_3 of Lagrange's top in body axes, where the first term is ω_2 y_1 − ω_1
    /// y_2 = (A − B) ω_1 ω_2.
    ///
    /// Parameters count as independent of each other; [bind](System::with_parameters_bound) them to use their
    /// values.
    pub fn all(system: &System<'g>) -> Vec<CyclicDisplacement<'g>> {
        let (graph, momenta) = (system.graph(), system.momenta());
        let x = system.frame().coordinates();
        let slope = system.frame().contract(&graph.gradient(system.lagrangian(), x));
        let gyroscopic = system.structure().gyroscopic(graph, system.quasi_velocities(), &momenta);
        let rate = |s: usize| graph.sum([gyroscopic[s], slope[s], system.forces()[s]]);
        let rates: Vec<Expr<'g>> = (0..momenta.len()).map(rate).collect();
        let displacement = |a: Vec<Number>| CyclicDisplacement {
            momentum: combination(graph, &a, &momenta),
            commutes: is_central(system, &a),
            coefficients: a,
        };
        let members = members(graph, &rates);
        let related: Vec<Vec<Expr<'g>>> = members.iter().map(|&s| vec![rates[s]]).collect();
        let all = |relation: Vec<Number>| {
            let mut a = vec![Number::ZERO; rates.len()];
            members.iter().zip(relation).for_each(|(&s, coefficient)| a[s] = coefficient);
            a
        };
        graph.linear_relations(&related).into_iter().map(all).map(displacement).collect()
    }
}

/// The number of rates up to which their relations are found at once: that takes the third power of their number.
const MANY: usize = 64;

/// The indices of the rates that a relation may contain. A rate that changes with a symbol which no other contains is in none;
/// where there are many, it is left out, and so on.
fn members<'g>(graph: &'g Graph, rates: &[Expr<'g>]) -> Vec<usize> {
    let mut members: BTreeSet<usize> = (0..rates.len()).collect();
    if rates.len() <= MANY {
        return members.into_iter().collect();
    }
    loop {
        let mut holders: HashMap<Option<String>, Vec<(usize, Expr<'g>)>> = HashMap::new();
        for &s in &members {
            for symbol in graph.symbols_of(&[rates[s]]) {
                holders.entry(symbol.symbol_name()).or_default().push((s, symbol));
            }
        }
        let alone = holders.into_values().filter(|of| of.len() == 1).flatten();
        let apart: Vec<usize> =
            alone.filter(|&(s, symbol)| rates[s].depends_on(symbol)).map(|(s, _)| s).collect();
        if apart.is_empty() {
            return members.into_iter().collect();
        }
        apart.iter().for_each(|s| _ = members.remove(s));
    }
}

/// a_s c_rs^m = 0 for r = 0..k, m = 1..k
fn is_central<'g>(system: &System<'g>, a: &[Number]) -> bool {
    let mut along: BTreeMap<(usize, usize), Vec<Expr<'g>>> = BTreeMap::new();
    for (r, s, m, c) in system.structure().nonzero() {
        along.entry((r, m)).or_default().push(c * Expr::from(a[s - 1]));
        if r > 0 {
            along.entry((s, m)).or_default().push(-(c * Expr::from(a[r - 1])));
        }
    }
    along.into_values().all(|terms| terms.into_iter().sum::<Expr<'g>>().is_zero())
}
