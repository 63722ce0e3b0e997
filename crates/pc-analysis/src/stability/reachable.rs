//! The directions in which a steady motion has neighbours, and those among them that are neutral.

use pc_mech::{Matrix, MechError, SingularValues};

use crate::numeric::dense::{norm, product};
use crate::stability::spectrum::Spectrum;
use crate::stability::steady_motion::SteadyMotion;

/// Singular values below this count as zero, for rows and basis vectors of length one.
const ZERO: f64 = 1e-10;

/// A differential is independent of others if more than this fraction of it is orthogonal to them.
const INDEPENDENT: f64 = 1e-8;

/// The directions δy = E δz to the states that motions can reach: those that leave unchanged every function of the
/// coordinates that is constant along all motions, such as the length of a quaternion or a constraint on
/// positions. These directions are invariant under the first approximation, δż = Eᵀ A E δz.
#[derive(Clone, Debug)]
pub(super) struct Reachable {
    /// E, orthonormal, with a row for each component that is not cyclic.
    basis: Matrix<f64>,
    /// The spectrum of Eᵀ A E.
    pub(super) spectrum: Spectrum,
}

impl Reachable {
    /// `normals` has a row ∂g/∂y over the whole state for each function g; `kept` are the indices in the
    /// state of the components that are not cyclic.
    pub(super) fn of(
        found: &SteadyMotion,
        kept: &[usize],
        normals: &Matrix<f64>,
    ) -> Result<Reachable, MechError> {
        let basis = directions(kept, normals)?;
        let spectrum = match basis.columns() == kept.len() {
            true => found.spectrum.clone(),
            false => {
                let moved = product(&found.first_approximation, &basis);
                Spectrum::of(&product(&basis.transpose(), &moved), found.spectrum.uncertainty())?
            }
        };
        Ok(Reachable { basis, spectrum })
    }

    /// The number k of neutral directions of a member of a family of steady motions: the first approximation has
    /// λ = 0 in k blocks of size 1 and otherwise negative real parts, and there are k integrals with independent
    /// differentials, so that on each nearby level the steady motion is isolated and asymptotically stable (I.
    /// G. Malkin's theorem on the critical case of k zeros).
    ///
    /// `differentials` are those of the integrals with respect to the components that are not cyclic.
    pub(super) fn neutral(&self, differentials: &[Vec<f64>]) -> Option<usize> {
        let spectrum = &self.spectrum;
        let &[count] = spectrum.zero_blocks() else { return None };
        let damped = spectrum.eigenvalues().iter().filter(|value| value.real < 0.0).count();
        if damped + count != spectrum.eigenvalues().len() || spectrum.neutral() != count {
            return None;
        }
        let mut independent: Vec<Vec<f64>> = Vec::new();
        for whole in differentials {
            let column =
                |j: usize| whole.iter().enumerate().map(move |(i, slope)| self.basis[(i, j)] * slope);
            let mut left: Vec<f64> = (0..self.basis.columns()).map(|j| column(j).sum()).collect();
            for known in &independent {
                let along: f64 = known.iter().zip(&left).map(|(a, b)| a * b).sum();
                left.iter_mut().zip(known).for_each(|(slope, known)| *slope -= along * known);
            }
            let size = norm(&left);
            if size > INDEPENDENT * norm(whole) {
                independent.push(left.iter().map(|slope| slope / size).collect());
            }
        }
        (independent.len() >= count).then_some(count)
    }
}

/// An orthonormal basis of the kernel of `normals`, restricted to the components `kept`.
fn directions(kept: &[usize], normals: &Matrix<f64>) -> Result<Matrix<f64>, MechError> {
    if normals.rows() == 0 {
        return Ok(Matrix::from_fn(kept.len(), kept.len(), |i, j| f64::from(u8::from(i == j))));
    }
    let sizes: Vec<f64> = (0..normals.rows()).map(|a| norm(&normals.row(a))).collect();
    let scaled = |a: usize, j: usize| if sizes[a] > 0.0 { normals[(a, j)] / sizes[a] } else { 0.0 };
    let factors = SingularValues::of(&Matrix::from_fn(normals.rows(), normals.columns(), scaled))?;
    let kernel = factors.kernel(factors.rank(ZERO));
    let seen =
        SingularValues::of(&Matrix::from_fn(kept.len(), kernel.columns(), |i, j| kernel[(kept[i], j)]))?;
    Ok(Matrix::from_fn(kept.len(), seen.rank(ZERO), |i, j| seen.left[(i, j)]))
}
