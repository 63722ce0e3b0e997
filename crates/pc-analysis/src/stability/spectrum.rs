//! Eigenvalues of the first approximation, and the stability that follows from them.

use std::fmt;

use pc_mech::{Matrix, MechError, ShapeError, SingularValues};

use crate::numeric::dense::{eigenvalues, norm, product};

/// The verdict on the stability of an equilibrium or a steady motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Neighbouring motions approach the steady motion: all real parts are negative (Lyapunov's first
    /// method).
    AsymptoticallyStable,
    /// Neighbouring motions stay close to the steady motion: an integral has a strict extremum there
    /// (Lyapunov's second method).
    Stable,
    /// Some neighbouring motion departs: a real part is positive (Lyapunov's first method).
    Unstable,
    /// The method does not decide: the case is critical, as it is in the first approximation of every stable
    /// conservative system.
    Undecided,
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Verdict::AsymptoticallyStable => "asymptotically stable",
            Verdict::Stable => "stable",
            Verdict::Unstable => "unstable",
            Verdict::Undecided => "undecided",
        })
    }
}

/// An eigenvalue λ: a small deviation varies as e^λt.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Eigenvalue {
    /// The rate of growth.
    pub real: f64,
    /// The angular frequency.
    pub imaginary: f64,
}

/// The eigenvalues of a matrix A, with its zero eigenvalues counted by ranks and not by their computed sizes.
///
/// Any eigenvalue routine returns a zero of multiplicity m in one Jordan block as m numbers of size ε^(1/m)
/// |A|, some with a positive real part. Zeros in blocks are the rule here: a family of steady motions gives A
/// a kernel, and an angle whose speed changes along the family gives a block of size two. Therefore zeros are
/// split off by orthogonal transformations first: with A = U Σ Vᵀ of rank r, A and its compression to the
/// image, the r × r matrix U_rᵀ A U_r, have the same eigenvalues except for n − r zeros; this is repeated
/// until the rest is regular. The numbers split off are [`zero_blocks`](Spectrum::zero_blocks) (V. N.
/// Kublanovskaya's method for the Jordan structure).
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    eigenvalues: Vec<Eigenvalue>,
    zero_blocks: Vec<usize>,
    tolerance: f64,
    uncertainty: f64,
}

impl Spectrum {
    /// The spectrum of a square matrix A whose entries are known to `uncertainty` |A|; uncertainties below 8
    /// n ε, the rounding error of the method, are raised to that value.
    ///
    /// Singular values up to `uncertainty` |A| count as zero. A real part counts as zero up to √`uncertainty`
    /// |A|, to which a double eigenvalue is determined.
    ///
    /// # Errors
    /// [`ShapeError`] if the matrix is not square; [`MatrixError::NoEigenvalues`](pc_mech::MatrixError::NoEigenvalues)
    /// if it is not finite.
    pub fn of(matrix: &Matrix<f64>, uncertainty: f64) -> Result<Spectrum, MechError> {
        let size = matrix.rows();
        if matrix.columns() != size {
            let what = "a row of the matrix of the first approximation";
            return Err(ShapeError { what, found: matrix.columns(), expected: size }.into());
        }
        let uncertainty = uncertainty.max(8.0 * size as f64 * f64::EPSILON);
        let scale = norm(&matrix.entries());
        let (regular, zero_blocks) = without_zeros(matrix, uncertainty * scale)?;
        let mut found: Vec<Eigenvalue> = eigenvalues(&regular)?
            .into_iter()
            .map(|(real, imaginary)| Eigenvalue { real, imaginary })
            .collect();
        let zeros = zero_blocks.iter().sum();
        found.extend(std::iter::repeat_n(Eigenvalue { real: 0.0, imaginary: 0.0 }, zeros));
        found.sort_by(|a, b| b.real.total_cmp(&a.real).then(b.imaginary.total_cmp(&a.imaginary)));
        let tolerance = uncertainty.sqrt() * scale;
        Ok(Spectrum { eigenvalues: found, zero_blocks, tolerance, uncertainty })
    }

    /// The n eigenvalues, in descending order of their real parts.
    pub fn eigenvalues(&self) -> &[Eigenvalue] {
        &self.eigenvalues
    }

    /// The numbers of Jordan blocks of size at least 1, 2, … that the eigenvalue zero has; their sum is the
    /// multiplicity of zero, and the first is the dimension of the kernel.
    pub fn zero_blocks(&self) -> &[usize] {
        &self.zero_blocks
    }

    /// The absolute value up to which a real part counts as zero.
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// The uncertainty of the entries, as a fraction of |A|.
    pub(crate) fn uncertainty(&self) -> f64 {
        self.uncertainty
    }

    /// The number of eigenvalues whose real part counts as zero, including zero eigenvalues.
    pub fn neutral(&self) -> usize {
        self.eigenvalues.iter().filter(|value| value.real.abs() <= self.tolerance).count()
    }

    /// [`Unstable`](Verdict::Unstable) if a real part is above the [tolerance](Spectrum::tolerance),
    /// [`AsymptoticallyStable`](Verdict::AsymptoticallyStable) if all are below minus the tolerance,
    /// [`Undecided`](Verdict::Undecided) otherwise.
    ///
    /// Zero eigenvalues never count as growth, whether in blocks or not: in the first approximation a block
    /// means growth with a power of t, which may lead along a family of steady motions, and the motion itself
    /// need not grow.
    pub fn verdict(&self) -> Verdict {
        match self.eigenvalues.first() {
            Some(first) if first.real > self.tolerance => Verdict::Unstable,
            Some(first) if first.real >= -self.tolerance => Verdict::Undecided,
            _ => Verdict::AsymptoticallyStable,
        }
    }
}

/// A regular matrix that has the nonzero eigenvalues of `matrix`, and the number of zeros split off at each
/// step.
fn without_zeros(matrix: &Matrix<f64>, tolerance: f64) -> Result<(Matrix<f64>, Vec<usize>), MechError> {
    let (mut rest, mut blocks) = (matrix.clone(), Vec::new());
    loop {
        let factors = SingularValues::of(&rest)?;
        let (size, rank) = (rest.rows(), factors.rank(tolerance));
        if rank == size {
            return Ok((rest, blocks));
        }
        blocks.push(size - rank);
        let image = Matrix::from_fn(size, rank, |i, j| factors.left[(i, j)]);
        rest = product(&image.transpose(), &product(&rest, &image));
    }
}
