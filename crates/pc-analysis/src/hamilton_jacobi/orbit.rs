//! The positions that a frame can reach.

use pc_algebra::{affine, quadratic};
use pc_mech::{Expr, Graph, System};

use crate::error::AnalysisError;
use crate::integrals::polynomials::independent;

/// A value of an invariant is taken for the number of twelve digits that differs from it by no more than this fraction.
const ROUNDING: f64 = 1e-15;

/// An orbit of the operators X_0, X_1..X_k of a frame: the surface f_a(t, x) = c_a of n − rank b invariants f_a, X_0 f_a =
/// X_s f_a = 0, to which every motion keeps.
///
/// Where the group acts intransitively, or where coordinates are redundant, Hamilton–Jacobi's equation is needed on one orbit only:
/// all X_s are tangent to it. With rank b < k there are relations λ_s X_s = 0 as well, so that y_s = X_s S satisfies
///
///   λ_s y_s = 0:
///
/// for rotations that act on a unit vector γ, γ_s y_s = 0, and S describes the motions whose area integral is zero.
///
/// ```
/// use pc_analysis::Orbit;
/// use pc_mech::{Graph, LieAlgebra, System};
///
/// let graph = Graph::new();
/// let top = System::builder(&graph)
///     .coordinates(["γ1", "γ2", "γ3"])
///     .quasi_velocities(["ω1", "ω2", "ω3"])
///     .kinematics(|_, g, w| [g[1]*w[2] - g[2]*w[1], g[2]*w[0] - g[0]*w[2], g[0]*w[1] - g[1]*w[0]])
///     .algebra(&LieAlgebra::so3())
///     .lagrangian(|_, g, w| (w[0].square() + w[1].square() + w[2].square())/2.0 - g[2])
///     .build()?;
/// let [x, y, z] = graph.symbols(["γ1", "γ2", "γ3"]);
/// let sphere = Orbit::through(&top, &[x.square() + y.square() + z.square()], &[(x, 0.6), (y, 0.0), (z, 0.8)])?;
/// assert_eq!(sphere.dimension(), 2);
/// assert_eq!(Orbit::relations(&top)[0].to_string(), "γ1*p_ω1 + γ2*p_ω2 + γ3*p_ω3");
/// # Ok::<(), pc_analysis::AnalysisError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Orbit<'g> {
    dimension: usize,
    /// f_a, with their values c_a.
    invariants: Vec<(Expr<'g>, f64)>,
    /// Coordinates as functions of the others, from f_a = c_a.
    solved: Vec<(Expr<'g>, Expr<'g>)>,
}

impl<'g> Orbit<'g> {
    /// The orbit through the position `at`, which names values of time, coordinates and parameters. The invariants are
    /// chosen among `functions`; none are needed where rank b = n.
    ///
    /// # Errors
    /// [`AnalysisError::OrbitUnknown`] if fewer than n − rank b of the functions are independent invariants with values there.
    pub fn through(
        system: &System<'g>,
        functions: &[Expr<'g>],
        at: &[(Expr<'g>, f64)],
    ) -> Result<Orbit<'g>, AnalysisError> {
        let (graph, frame) = (system.graph(), system.frame());
        let x = frame.coordinates();
        let dimension = frame.rank();
        let needed = x.len() - dimension;
        let is_kept = |f: &Expr<'g>| {
            graph.symbols_of(&[*f]).iter().all(|z| !system.quasi_velocities().contains(z))
                && (0..=frame.operators()).all(|s| frame.apply(s, &[*f])[0].is_zero())
        };
        let kept = if needed == 0 { Vec::new() } else { functions.iter().copied().filter(is_kept).collect() };
        let invariants: Vec<Expr<'g>> = independent(graph, x, &[], kept);
        let parameters = system.parameters().iter().copied();
        let places: Vec<(Expr<'g>, f64)> = at.iter().copied().chain(parameters).collect();
        let values = graph.evaluate(&invariants, &places).unwrap_or_default();
        if values.len() != needed || values.iter().any(|c| !c.is_finite()) {
            return Err(AnalysisError::OrbitUnknown { found: values.len(), needed });
        }
        let invariants: Vec<_> = invariants.into_iter().zip(values.into_iter().map(short)).collect();
        let solved = solved(graph, &invariants, x, at).unwrap_or_default();
        Ok(Orbit { dimension, invariants, solved })
    }

    /// rank b, the dimension of the orbit.
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// The n − rank b invariants f_a, each with its value c_a.
    pub fn invariants(&self) -> &[(Expr<'g>, f64)] {
        &self.invariants
    }

    /// Functions of (t, x) on the orbit near the given position, with some coordinates expressed through the others where
    /// f_a = c_a is solved for them by square roots at most; elsewhere the functions as they are.
    pub fn restricted(&self, graph: &'g Graph, functions: &[Expr<'g>]) -> Vec<Expr<'g>> {
        self.solved
            .iter()
            .fold(functions.to_vec(), |functions, &solution| graph.substitute(&functions, &[solution]))
    }

    /// The sums λ_s y_s of the [momenta](System::momentum_symbols) with λ_s X_s = 0, at most k − rank b of them: they vanish for
    /// y_s = X_s S. The λ are sought among rational functions of the coordinates.
    pub fn relations(system: &System<'g>) -> Vec<Expr<'g>> {
        let (graph, frame) = (system.graph(), system.frame());
        if frame.rank() == frame.operators() {
            return Vec::new();
        }
        let columns: Vec<Vec<Expr<'g>>> =
            (0..frame.operators()).map(|s| frame.b().column(s).collect()).collect();
        let symbols = graph.symbols_of(&columns.concat());
        let y = system.momentum_symbols();
        let relations = graph.linear_relations_over(&columns, &symbols);
        relations.into_iter().map(|lambda| graph.dot(lambda, y.iter().copied())).collect()
    }
}

/// The value, rounded to twelve digits if that changes it by a rounding error only.
fn short(value: f64) -> f64 {
    let rounded: f64 = format!("{value:.11e}").parse().unwrap_or(value);
    if (rounded - value).abs() <= ROUNDING * value.abs() { rounded } else { value }
}

/// A coordinate for each invariant as a function of the other coordinates; `None` if one is in no coordinate linear or purely
/// quadratic with constant coefficients.
fn solved<'g>(
    graph: &'g Graph,
    invariants: &[(Expr<'g>, f64)],
    coordinates: &[Expr<'g>],
    at: &[(Expr<'g>, f64)],
) -> Option<Vec<(Expr<'g>, Expr<'g>)>> {
    let value = |x: Expr<'g>| at.iter().find(|(known, _)| *known == x).map_or(0.0, |&(_, value)| value);
    // The root of a coordinate far from zero has the wider neighbourhood.
    let mut order = coordinates.to_vec();
    order.sort_by(|&a, &b| value(b).abs().total_cmp(&value(a).abs()));
    let mut solved: Vec<(Expr<'g>, Expr<'g>)> = Vec::new();
    for &(f, c) in invariants {
        let condition = solved.iter().fold(f - c, |f, &known| graph.substitute(&[f], &[known])[0]);
        let solution = order.iter().find_map(|&x| Some((x, root(graph, condition, x, value(x))?)))?;
        solved.push(solution);
    }
    Some(solved)
}

/// x where `condition`, which contains it, vanishes: on the side of zero on which `value` is.
fn root<'g>(graph: &'g Graph, condition: Expr<'g>, x: Expr<'g>, value: f64) -> Option<Expr<'g>> {
    if !condition.depends_on(x) {
        return None;
    }
    let is_constant = |e: Expr<'g>| e.constant().is_some() && !e.is_zero();
    if let Some((slope, rest)) = affine(graph, condition, &[x])
        && is_constant(slope[0])
    {
        return Some(-rest / slope[0]);
    }
    let parts = quadratic(graph, condition, &[x])?;
    let (curvature, is_pure) = (parts.matrix[(0, 0)], parts.linear[0].is_zero());
    (is_pure && is_constant(curvature) && value != 0.0)
        .then(|| (-2.0 * parts.constant / curvature).sqrt() * value.signum())
}
