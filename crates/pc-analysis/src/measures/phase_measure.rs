//! The invariant measure of a motion: Liouville's, or one found by a search.

use pc_mech::{Expr, Graph, Matrix, System};

use crate::error::AnalysisError;
use crate::measures::darboux::power_of_polynomial;
use crate::measures::invariant_measure::{
    InvariantMeasure, candidates, determinants_of_blocks, invariant_measure, simple_factors,
};

/// The largest number of free quasi-velocities for which a measure of the motion is sought if no theorem
/// gives one.
const MOST_VELOCITIES: usize = 6;

/// The largest number of factors of a density that are tried together.
const MOST_FACTORS: usize = 60;

/// The greatest length of the equations of such a motion, counted in operations of the written-out
/// expressions; a search then takes some tenths of a second.
const LONGEST: u32 = 4_000;

/// The result of a search for an invariant measure.
#[derive(Clone, Debug)]
pub enum MeasureSearch<'g> {
    /// This measure is invariant.
    Found(PhaseMeasure<'g>),
    /// No invariant measure was found.
    None,
    /// The measure depends on forces that are computed outside the model.
    External,
    /// No theorem gives one, and the equations are too long to search.
    TooLong,
}

/// A measure on the phase space of (x, y) and the first-order states that is invariant under the motion.
#[derive(Clone, Debug)]
pub struct PhaseMeasure<'g> {
    /// Whether the measure is Liouville's, which the frame of a holonomic system determines whatever the
    /// Lagrangian.
    pub liouville: bool,
    /// The density N of N dx dy, positive at the start; none if 1/det b or det(∂f/∂x_D)/det b_I is not a short
    /// expression.
    pub density: Option<Expr<'g>>,
    /// The density N det M of N det M dx dη, with M = ∂²L/∂η∂η; none if it is not a short expression.
    pub in_velocities: Option<Expr<'g>>,
    /// The momenta at whose zeros N is zero or infinite.
    pub singular: Vec<Expr<'g>>,
    /// Whether momenta or ẋ contain a sign, a step or an angle, which may jump: the measure is invariant where they do
    /// not.
    pub jumps: bool,
}

impl<'g> MeasureSearch<'g> {
    /// The measure of the motion (10), (11) of a system; under constraints, that of their [free
    /// system](pc_nonholo::Constrained::free_system).
    ///
    /// Where forces other than those of L are functions of the position, or gyroscopic, phase volume grows
    /// at the rate η_r (∂b_ir/∂x_i + c_rs^s) + ∂b_i0/∂x_i + c_0s^s, for every L: in (10) the terms with H
    /// cancel, and those with c_rs^m by its antisymmetry. N = 1 is a density if this rate vanishes. If n = k
    /// and rank b = k, the density is N = 1/det b, with which N dx dy is Liouville's dx dp: y = bᵀp. If n − k
    /// functions f(t, x) are constant, then for any choice of as many dependent coordinates x_D, x_I being
    /// the others, the density is N = det(∂f/∂x_D)/det b_I: Liouville's on each surface f = const. If no f
    /// are known, N is sought as a product of powers of coordinates, their sines and cosines. For dx dη the
    /// density is multiplied by det M. `positions` are functions f of a holonomic system, in addition to
    /// declared integrals that depend on the position alone; `None` means that the system is not holonomic.
    ///
    /// Otherwise a density with these factors and those of [`invariant_measure`] is sought, then one that has
    /// momenta among its factors as well, then a power of a polynomial of the second degree in the coordinates; this search is
    /// omitted for more than six quasi-velocities and for long equations.
    ///
    /// `at` gives values of time, state and parameters at which N is positive.
    ///
    /// # Errors
    /// The errors in deriving equations (9).
    ///
    /// ```
    /// use pc_analysis::MeasureSearch;
    /// use pc_mech::{Graph, System};
    ///
    /// // r' = u, φ' = w/r with an inertia m(r) of w: dx dy r, dx dη r m.
    /// let graph = Graph::new();
    /// let particle = System::builder(&graph)
    ///     .coordinates(["r", "φ"])
    ///     .quasi_velocities(["u", "w"])
    ///     .kinematics(|_, x, eta| [eta[0], eta[1] / x[0]])
    ///     .lagrangian(|_, x, eta| (eta[0].square() + x[0].exp() * eta[1].square()) / 2.0)
    ///     .build()?;
    /// let r = graph.symbol("r");
    /// let MeasureSearch::Found(measure) = MeasureSearch::of(&particle, Some(&[]), &[(r, 2.0)])? else { panic!() };
    /// assert!(measure.liouville);
    /// assert_eq!(measure.density, Some(r));
    /// assert_eq!(measure.in_velocities, Some(r * r.exp()));
    /// # Ok::<(), pc_analysis::AnalysisError>(())
    /// ```
    pub fn of(
        system: &System<'g>,
        positions: Option<&[Expr<'g>]>,
        at: &[(Expr<'g>, f64)],
    ) -> Result<MeasureSearch<'g>, AnalysisError> {
        let external = system.external_forces().iter();
        if external.clone().any(|(_, force)| system.forces().iter().any(|q| q.depends_on(*force))) {
            return Ok(MeasureSearch::External);
        }
        let equations = system.poincare()?;
        let mass = equations.mass_matrix();
        let (liouville, density, momenta) = match positions
            .and_then(|positions| of_the_frame(system, positions))
        {
            Some(density) => (true, density, Vec::new()),
            None => {
                let cost =
                    |parts: &[Expr<'g>]| parts.iter().map(|e| e.tree_cost()).fold(0, u32::saturating_add);
                let length = cost(&mass.nonzero_entries()).saturating_add(cost(equations.right_hand_side()));
                if mass.rows() > MOST_VELOCITIES || length > LONGEST {
                    return Ok(MeasureSearch::TooLong);
                }
                let Some(measure) = found(system)? else { return Ok(MeasureSearch::None) };
                let momenta = system.momentum_symbols();
                let singular = |factor: &Expr<'g>| momenta.contains(factor);
                let singular = measure.factors.iter().map(|&(factor, _)| factor).filter(singular).collect();
                (false, Some(measure.density()), singular)
            }
        };
        let known: Vec<_> = system.momentum_symbols().into_iter().zip(system.momenta()).collect();
        let graph = system.graph();
        let all = product_of_blocks(graph, mass).zip(density).map(|(of_mass, density)| {
            let density = graph.substitute(&[density], &known)[0];
            positive(system, graph.shorten(&[density * of_mass], &[])[0], at)
        });
        Ok(MeasureSearch::Found(PhaseMeasure {
            liouville,
            density: density.map(|density| positive(system, density, at)),
            in_velocities: all,
            singular: momenta,
            jumps: jumps(system),
        }))
    }
}

/// Whether momenta or ẋ may jump as functions of (t, x, η).
fn jumps(system: &System<'_>) -> bool {
    let eta = system.quasi_velocities();
    let state: Vec<Expr<'_>> = system.state().into_iter().chain([system.frame().time()]).collect();
    let parts = [system.momenta(), system.frame().velocities(eta)].concat();
    parts.iter().any(|&part| system.graph().applies(part, &state, |function| !function.is_continuous()))
}

/// The density of the measure that the motion (10), (11) leaves invariant for any Lagrangian; `Some(None)` if
/// it is not a short expression.
fn of_the_frame<'g>(system: &System<'g>, positions: &[Expr<'g>]) -> Option<Option<Expr<'g>>> {
    if !system.states().is_empty() || has_resistance(system) {
        return None;
    }
    let (graph, frame) = (system.graph(), system.frame());
    let growth = growth(system);
    if growth.iter().all(|growth| growth.is_zero()) {
        return Some(Some(Expr::ONE));
    }
    if frame.coordinates().len() == frame.operators() && frame.rank() == frame.operators() {
        return Some(product_of_blocks(graph, frame.b()).map(|det| 1.0 / det));
    }
    of_surfaces(system, positions, &growth).or_else(|| of_factors(system, growth).map(Some))
}

/// det(∂f/∂x_D)/det b_I for the first independent functions f that motions keep constant, among `positions`
/// and the integrals that depend on the position alone; `Some(None)` if it is not a short expression.
fn of_surfaces<'g>(
    system: &System<'g>,
    positions: &[Expr<'g>],
    growth: &[Expr<'g>],
) -> Option<Option<Expr<'g>>> {
    let (graph, frame) = (system.graph(), system.frame());
    let (x, k) = (frame.coordinates(), frame.operators());
    let parameters = system.parameters().iter().map(|(parameter, _)| parameter);
    let known: Vec<Expr<'g>> = x.iter().chain(parameters).copied().chain([frame.time()]).collect();
    let of_place = |f: &Expr<'g>| graph.symbols_of(&[*f]).iter().all(|symbol| known.contains(symbol));
    let integrals = system.integrals().iter().map(|&(_, f)| f).filter(of_place);
    let mut slopes: Vec<Vec<Expr<'g>>> = Vec::new();
    for f in positions.iter().copied().chain(integrals) {
        let is_kept = (0..=k).all(|r| frame.apply(r, &[f])[0].is_zero());
        let known = [slopes.as_slice(), &[graph.gradient(f, x)]].concat();
        if is_kept && slopes.len() + k < x.len() && graph.generic_rank(&known) == known.len() {
            slopes = known;
        }
    }
    let dependent = independent_columns(graph, &slopes);
    let others: Vec<usize> = (0..x.len()).filter(|i| !dependent.contains(i)).collect();
    if others.len() != k {
        return None;
    }
    let of = |rows: usize, entry: &dyn Fn(usize, usize) -> Expr<'g>| {
        product_of_blocks(graph, &Matrix::from_fn(rows, rows, entry))
    };
    let held = of(dependent.len(), &|a, i| slopes[a][dependent[i]]);
    let free = of(others.len(), &|i, s| frame.b()[(others[i], s)]);
    let (Some(held), Some(free)) = (held, free) else { return Some(None) };
    let density = graph.shorten(&[held / free], &[])[0];
    let mut changes = (0..=k).map(|r| frame.apply(r, &[density])[0] / density + growth[r]);
    changes.all(Expr::is_zero).then_some(Some(density))
}

/// A density that is a product of powers of coordinates, their sines and cosines.
fn of_factors<'g>(system: &System<'g>, growth: Vec<Expr<'g>>) -> Option<Expr<'g>> {
    let (graph, frame) = (system.graph(), system.frame());
    let factors = simple_factors(system, &frame.b().nonzero_entries());
    if factors.len() > MOST_FACTORS {
        return None;
    }
    let rates = (0..=frame.operators()).map(|r| frame.apply(r, &factors)).collect::<Vec<_>>();
    let of_factor = |j: usize| rates.iter().map(|rates| rates[j] / factors[j]).collect();
    let columns: Vec<Vec<Expr<'g>>> = (0..factors.len()).map(of_factor).chain([growth]).collect();
    Some(InvariantMeasure::of_relation(graph, &factors, &columns)?.density())
}

/// The indices of the first columns that are independent at almost all positions.
fn independent_columns<'g>(graph: &'g Graph, rows: &[Vec<Expr<'g>>]) -> Vec<usize> {
    let mut kept: Vec<usize> = Vec::new();
    for column in 0..rows.first().map_or(0, Vec::len) {
        let chosen = |row: &Vec<Expr<'g>>| kept.iter().chain([&column]).map(|&j| row[j]).collect();
        if graph.generic_rank(&rows.iter().map(chosen).collect::<Vec<_>>()) > kept.len() {
            kept.push(column);
        }
    }
    kept
}

/// Whether ∂Q_s/∂η_r + ∂Q_r/∂η_s is not identically zero; if it is zero, the trace of ∂Q/∂y vanishes by the symmetry
/// of M.
fn has_resistance(system: &System<'_>) -> bool {
    let (graph, eta) = (system.graph(), system.quasi_velocities());
    let slopes: Vec<_> = system.forces().iter().map(|&q| graph.gradient(q, eta)).collect();
    let k = slopes.len();
    (0..k).any(|s| (0..=s).any(|r| !(slopes[s][r] + slopes[r][s]).is_zero()))
}

/// ∂b_ir/∂x_i + c_rs^s for r = 0..k; N is a density if X_r N/N cancels these terms.
fn growth<'g>(system: &System<'g>) -> Vec<Expr<'g>> {
    let (graph, frame, structure) = (system.graph(), system.frame(), system.structure());
    let mut traces = vec![Vec::new(); frame.operators() + 1];
    // Of c_rs^m and c_sr^m only the one with r < s is listed.
    for (r, s, m, c) in structure.nonzero() {
        if m == s {
            traces[r].push(c);
        }
        if m == r {
            traces[s].push(-c);
        }
    }
    let component = |r: usize, i: usize| match r.checked_sub(1) {
        None => frame.b0()[i],
        Some(s) => frame.b()[(i, s)],
    };
    let of = |(r, trace): (usize, Vec<Expr<'g>>)| {
        let x = frame.coordinates().iter().enumerate();
        graph.sum(x.map(|(i, &x)| component(r, i).derivative(x)).chain(trace))
    };
    traces.into_iter().enumerate().map(of).collect()
}

/// The determinant of a square matrix up to its sign, as the product of the determinants of its blocks;
/// `None` if one of them is not a short expression.
fn product_of_blocks<'g>(graph: &'g Graph, matrix: &Matrix<Expr<'g>>) -> Option<Expr<'g>> {
    let blocks = determinants_of_blocks(graph, matrix);
    let product = blocks.iter().try_fold(Expr::ONE, |product, block| Some(product * (*block)?))?;
    (!product.is_zero()).then_some(product)
}

/// The measure found by a search for its factors, preferably one without momenta among them, or else as a power of a polynomial.
fn found<'g>(system: &System<'g>) -> Result<Option<InvariantMeasure<'g>>, AnalysisError> {
    let known = |error| match error {
        AnalysisError::Mech(error) if error.is_not_quadratic() => Ok(None),
        error => Err(error),
    };
    let factors = candidates(system)?;
    match invariant_measure(system, &factors).or_else(known)? {
        Some(measure) => Ok(Some(measure)),
        None => {
            let momenta = system.momentum_symbols();
            match invariant_measure(system, &[factors, momenta].concat()).or_else(known)? {
                Some(measure) => Ok(Some(measure)),
                None => power_of_polynomial(system).or_else(known),
            }
        }
    }
}

/// The density without constant factors, with its sign chosen so that it is positive at the values `at`.
fn positive<'g>(system: &System<'g>, density: Expr<'g>, at: &[(Expr<'g>, f64)]) -> Expr<'g> {
    let graph = system.graph();
    let variables: Vec<Expr<'g>> = [system.frame().time()]
        .into_iter()
        .chain(system.state_with(&[system.quasi_velocities(), &system.momentum_symbols()].concat()))
        .collect();
    let fixed = |factor: Expr<'g>| !variables.iter().any(|&z| factor.depends_on(z));
    let without = |density: Expr<'g>, parameter: Expr<'g>| {
        let short = graph.substitute(&[density], &[(parameter, Expr::ONE)])[0];
        // The quotient depends on other parameters where this one is part of a sum.
        let is_factor = || graph.are_made_of(&[density / short], &[parameter])[0];
        if !short.is_undefined() && !short.is_zero() && is_factor() { short } else { density }
    };
    let density = system.parameters().iter().fold(density, |density, &(p, _)| without(density, p));
    let factors = graph.factors(density).into_iter().filter(|&(factor, _)| !fixed(factor));
    let density = factors.fold(Expr::ONE, |product, (factor, exponent)| product * factor.powi(exponent));
    let momenta: Vec<_> = system.momentum_symbols().into_iter().zip(system.momenta()).collect();
    let of_velocities = graph.substitute(&[density], &momenta);
    let value = graph.evaluate(&of_velocities, at).map_or(1.0, |values| values[0]);
    if value < 0.0 { -density } else { density }
}
