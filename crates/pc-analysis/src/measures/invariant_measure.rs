//! The growth of phase volume, and the measures that are invariant.

use pc_mech::{Expr, Graph, Matrix, Number, System, determinant};

use crate::error::AnalysisError;

/// An invariant measure N dx dy with N = Π ψ_i^c_i, where the ψ_i are functions of (t, x, y) and the c_i are
/// rational.
#[derive(Clone, Debug)]
pub struct InvariantMeasure<'g> {
    /// The ψ_i with their powers c_i, none of them 0.
    pub factors: Vec<(Expr<'g>, Number)>,
}

impl<'g> InvariantMeasure<'g> {
    /// The density N.
    pub fn density(&self) -> Expr<'g> {
        self.density_to(Number::ONE)
    }

    /// The measure that follows from a linear relation between the growth rates ψ̇_i/ψ_i, one column each,
    /// and the divergence in the last column.
    pub(crate) fn of_relation(
        graph: &'g Graph,
        factors: &[Expr<'g>],
        columns: &[Vec<Expr<'g>>],
    ) -> Option<InvariantMeasure<'g>> {
        // A relation that contains the last column gives the powers.
        let last = factors.len();
        let relation = graph.linear_relations(columns).into_iter().find(|c| !c[last].is_zero())?;
        let scale = relation[last].recip();
        let powers = factors.iter().copied().zip(relation.into_iter().map(|c| c * scale));
        Some(InvariantMeasure { factors: powers.filter(|(_, power)| !power.is_zero()).collect() })
    }

    /// N^p
    pub(crate) fn density_to(&self, exponent: Number) -> Expr<'g> {
        let power = |&(factor, power): &(Expr<'g>, Number)| {
            let power = power * exponent;
            let twice = (power * Number::integer(2)).as_integer();
            match (power.as_integer(), twice) {
                (Some(power), _) => factor.powi(power),
                (None, Some(twice)) => factor.sqrt().powi(twice),
                (None, None) => (factor.log() * power).exp(),
            }
        };
        self.factors.iter().map(power).fold(Expr::ONE, |density, factor| density * factor)
    }
}

/// The symbols of the first-order states.
fn states<'g>(system: &System<'g>) -> Vec<Expr<'g>> {
    system.states().iter().map(|&(z, _)| z).collect()
}

/// The divergence ∂ẋ_i/∂x_i + ∂ẏ_s/∂y_s + ∂ż/∂z of the motion (10), (11): the rate at which phase volume dx
/// dy grows, in terms of (t, x, y). Under constraints (34) it is the divergence of their [free
/// system](pc_nonholo::Constrained::free_system).
///
/// # Errors
/// [`LagrangianError::NotQuadratic`](pc_mech::LagrangianError::NotQuadratic) if the equations have no closed form.
pub fn divergence<'g>(free: &System<'g>) -> Result<Expr<'g>, AnalysisError> {
    let graph = free.graph();
    let canonical = free.canonical()?;
    canonical.closed_quasi_velocities()?;
    let along = |variables: &[Expr<'g>], rates: &[Expr<'g>]| -> Vec<Expr<'g>> {
        variables.iter().zip(rates).map(|(&z, &rate)| graph.gradient(rate, &[z])[0]).collect()
    };
    let x = along(free.frame().coordinates(), canonical.velocities());
    let y = along(canonical.momenta(), canonical.right_hand_side());
    let z = along(&states(free), canonical.state_rates());
    Ok(graph.shorten(&[graph.sum(x.into_iter().chain(y).chain(z))], canonical.momenta())[0])
}

/// The invariant measure of the motion (10), (11) of a system whose density is a product of powers of
/// `factors`, functions of (t, x, y) that are not zero, if there is one: ψ̇_i/ψ_i c_i + divergence = 0,
/// solved for rational c_i and proved. Without `factors` the coordinates, their sines and cosines, det b, the
/// entries of the mass matrix and its determinant are tried: if n = k and the forces have a potential, dx
/// dy/det b is Liouville's dx dp in the momenta p = ∂L/∂ẋ, y = bᵀp. Under constraints (34) it is the measure
/// of their [free system](pc_nonholo::Constrained::free_system).
///
/// # Errors
/// [`LagrangianError::NotQuadratic`](pc_mech::LagrangianError::NotQuadratic) if the equations have no closed form.
///
/// ```
/// use pc_analysis::invariant_measure;
/// use pc_mech::{Graph, System};
///
/// // A free particle by its velocities along and across the direction to the origin: r' = u, φ' = w/r, det b = 1/r.
/// let graph = Graph::new();
/// let particle = System::builder(&graph)
///     .coordinates(["r", "φ"])
///     .quasi_velocities(["u", "w"])
///     .kinematics(|_, x, eta| [eta[0], eta[1] / x[0]])
///     .lagrangian(|_, _, eta| (eta[0].square() + eta[1].square()) / 2.0)
///     .build()?;
/// let measure = invariant_measure(&particle, &[])?.unwrap();
/// assert_eq!(measure.density(), graph.symbol("r"));
/// # Ok::<(), pc_analysis::AnalysisError>(())
/// ```
///
/// ```
/// use pc_analysis::invariant_measure;
/// use pc_mech::{Constraint, Graph, System};
/// use pc_nonholo::Adapted;
///
/// // The particle with ż = y ẋ keeps dx dp/√(1 + y²).
/// let graph = Graph::new();
/// let [y, vx, vz] = graph.symbols(["y", "x'", "z'"]);
/// let particle = System::builder(&graph)
///     .coordinates(["x", "y", "z"])
///     .lagrangian(|_, _, v| (v[0].square() + v[1].square() + v[2].square()) / 2.0)
///     .build()?;
/// let held = particle.with_multipliers(&[Constraint::new("knife", vz - y * vx)])?;
/// let at: Vec<_> = ["x", "y", "z", "x'", "y'", "z'", "t"].map(|name| (graph.symbol(name), 0.5)).into();
/// let measure = invariant_measure(&Adapted::new(&held, &at)?.constrained()?.free_system()?, &[])?;
/// assert_eq!(measure.map(|measure| measure.density()), Some(1.0 / (1.0 + y.square()).sqrt()));
/// # Ok::<(), pc_analysis::AnalysisError>(())
/// ```
pub fn invariant_measure<'g>(
    system: &System<'g>,
    factors: &[Expr<'g>],
) -> Result<Option<InvariantMeasure<'g>>, AnalysisError> {
    let (graph, canonical) = (system.graph(), system.canonical()?);
    let divergence = divergence(system)?;
    if divergence.is_zero() {
        return Ok(Some(InvariantMeasure { factors: Vec::new() }));
    }
    let factors = if factors.is_empty() { candidates(system)? } else { factors.to_vec() };
    let x = system.frame().coordinates().iter().copied();
    let z = states(system).into_iter().zip(canonical.state_rates().iter().copied());
    let y = canonical.momenta().iter().copied().zip(canonical.right_hand_side().iter().copied());
    let along: Vec<_> = x
        .zip(canonical.velocities().iter().copied())
        .chain(y)
        .chain(z)
        .chain(graph.in_time(system.frame().time()))
        .collect();
    let rates = graph.directional(&factors, &along);
    let growth = rates.iter().zip(&factors).map(|(&rate, &factor)| vec![rate / factor]);
    let columns: Vec<Vec<Expr<'g>>> = growth.chain([vec![divergence]]).collect();
    Ok(InvariantMeasure::of_relation(graph, &factors, &columns))
}

/// The coordinates on which some expressions depend, with their sines and cosines.
pub(crate) fn simple_factors<'g>(system: &System<'g>, parts: &[Expr<'g>]) -> Vec<Expr<'g>> {
    let symbols = system.graph().symbols_of(parts);
    let moving = system.frame().coordinates().iter().filter(|x| symbols.contains(x));
    moving.flat_map(|&x| [x, x.sin(), x.cos()]).collect()
}

/// Factors to try: the coordinates with their sines and cosines, the factors of det b, the diagonal of the
/// mass matrix and its determinant, except those that are constant.
pub(crate) fn candidates<'g>(system: &System<'g>) -> Result<Vec<Expr<'g>>, AnalysisError> {
    let graph = system.graph();
    let equations = system.poincare()?;
    let mass = equations.mass_matrix();
    let frame = determinants_of_blocks(graph, system.frame().b());
    let inertias = (0..mass.rows()).map(|s| mass[(s, s)]);
    let mut candidates =
        simple_factors(system, &[mass.nonzero_entries(), system.frame().b().nonzero_entries()].concat());
    for candidate in frame.into_iter().flatten().chain(inertias).chain(determinant(graph, mass)) {
        if candidate.constant().is_none() && !candidates.contains(&candidate) {
            candidates.push(candidate);
        }
    }
    Ok(candidates)
}

/// The determinants of the blocks into which the zeros of a matrix divide its rows and columns, up to signs;
/// `None` for blocks that are not square or whose determinant is not a short expression.
pub(crate) fn determinants_of_blocks<'g>(
    graph: &'g Graph,
    matrix: &Matrix<Expr<'g>>,
) -> Vec<Option<Expr<'g>>> {
    let mut determinants = Vec::new();
    let mut open: Vec<usize> = (0..matrix.rows()).collect();
    while let Some(first) = open.first().copied() {
        let (mut rows, mut columns) = (vec![first], Vec::new());
        loop {
            let size = (rows.len(), columns.len());
            columns =
                (0..matrix.columns()).filter(|&j| rows.iter().any(|&i| !matrix[(i, j)].is_zero())).collect();
            rows =
                (0..matrix.rows()).filter(|&i| columns.iter().any(|&j| !matrix[(i, j)].is_zero())).collect();
            if (rows.len(), columns.len()) == size {
                break;
            }
        }
        if rows.is_empty() {
            determinants.push(None); // a row of zeros: no determinant
            break;
        }
        open.retain(|i| !rows.contains(i));
        let block = Matrix::from_fn(rows.len(), columns.len(), |i, j| matrix[(rows[i], columns[j])]);
        determinants.push(determinant(graph, &block).filter(|_| block.rows() == block.columns()));
    }
    determinants
}
