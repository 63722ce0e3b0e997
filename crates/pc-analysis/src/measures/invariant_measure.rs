//! Phase volume: its growth, and the measures that are invariant.

use pc_mech::{Expr, Graph, Matrix, Number, System, determinant};

use crate::error::AnalysisError;

/// An invariant measure N dx dy with N = Π ψ_i^c_i, ψ_i functions of the coordinates and c_i rational.
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

/// The divergence ∂ẋ_i/∂x_i + ∂ẏ_s/∂y_s + ∂ż/∂z of the motion (10), (11): the rate at which phase volume dx dy grows, in
/// terms of (t, x, y). Under constraints, (34), that of their [free system](pc_nonholo::Constrained::free_system).
///
/// # Errors
/// [`MechError::NotQuadratic`](pc_mech::MechError::NotQuadratic) if the equations have no closed form.
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

/// The invariant measure of the motion (10), (11) of a system whose density is a product of powers of `factors`, functions of
/// the coordinates that are not zero, if there is one: ψ̇_i/ψ_i c_i + divergence = 0, solved for rational c_i and proved.
/// Without `factors` det b, the entries of the mass matrix and its determinant are tried: with n = k and forces that have a
/// potential dx dy/det b is Liouville's dx dp, by the momenta p = ∂L/∂ẋ, y = bᵀp. Under constraints, (34), it is that of their
/// [free system](pc_nonholo::Constrained::free_system).
///
/// # Errors
/// [`MechError::NotQuadratic`](pc_mech::MechError::NotQuadratic) if the equations have no closed form.
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
    let along: Vec<_> = x
        .zip(canonical.velocities().iter().copied())
        .chain(z)
        .chain([(system.frame().time(), Expr::ONE)])
        .collect();
    let rates = graph.directional(&factors, &along);
    let growth = rates.iter().zip(&factors).map(|(&rate, &factor)| vec![rate / factor]);
    let columns: Vec<Vec<Expr<'g>>> = growth.chain([vec![divergence]]).collect();
    // The last column is the divergence: a relation in which it stands gives the powers.
    let relation = graph.linear_relations(&columns).into_iter().find(|c| !c[factors.len()].is_zero());
    Ok(relation.map(|c| {
        let scale = c[factors.len()].recip();
        let powers = factors.into_iter().zip(c.into_iter().map(|c| c * scale));
        InvariantMeasure { factors: powers.filter(|(_, power)| !power.is_zero()).collect() }
    }))
}

/// The factors of det b where b is square, the diagonal of the mass matrix and its determinant, as far as they are not constant.
fn candidates<'g>(system: &System<'g>) -> Result<Vec<Expr<'g>>, AnalysisError> {
    let graph = system.graph();
    let equations = system.poincare()?;
    let mass = equations.mass_matrix();
    let frame = determinants_of_blocks(graph, system.frame().b());
    let inertias = (0..mass.rows()).map(|s| mass[(s, s)]);
    let mut candidates: Vec<Expr<'g>> = Vec::new();
    for candidate in frame.into_iter().chain(inertias).chain(determinant(graph, mass)) {
        if candidate.constant().is_none() && !candidates.contains(&candidate) {
            candidates.push(candidate);
        }
    }
    Ok(candidates)
}

/// The determinants of the blocks into which rows and columns of a matrix fall by its zeros, up to signs; those of blocks that
/// are no short expressions are left out.
fn determinants_of_blocks<'g>(graph: &'g Graph, matrix: &Matrix<Expr<'g>>) -> Vec<Expr<'g>> {
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
            break; // a row of zeros: no determinant is a factor of a density
        }
        open.retain(|i| !rows.contains(i));
        let block = Matrix::from_fn(rows.len(), columns.len(), |i, j| matrix[(rows[i], columns[j])]);
        determinants.extend(determinant(graph, &block).filter(|_| block.rows() == block.columns()));
    }
    determinants
}
