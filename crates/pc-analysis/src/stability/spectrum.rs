//! Eigenvalues of the first approximation, and the stability that follows from them.

use std::fmt;

use pc_mech::{Matrix, MechError, ShapeError, SingularValues};

use crate::numeric::dense::{Eigenpair, eigenvectors, norm, product};
use crate::numeric::equilibrated::Equilibrated;

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
///
/// The matrix is balanced first (E. E. Osborne), and ranks are those of matrices with rows and columns of size one, so that
/// the result does not depend on the units of the components.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    eigenvalues: Vec<Eigenvalue>,
    zero_blocks: Vec<usize>,
    tolerance: f64,
    uncertainty: f64,
}

/// A rank is that of a matrix with rows and columns of size one: singular values below this count as zero.
const RANK: f64 = 1e-13;

impl Spectrum {
    /// The spectrum of a square matrix A whose entries are known to `uncertainty` |A|; uncertainties below 8
    /// n ε, the rounding error of the method, are raised to that value.
    ///
    /// Entries up to `uncertainty` |A| count as zero, and so do real parts within the error that this causes.
    ///
    /// # Errors
    /// [`ShapeError`] if the matrix is not square; [`MatrixError::NoEigenvalues`](pc_mech::MatrixError::NoEigenvalues)
    /// if it is not finite.
    pub fn of(matrix: &Matrix<f64>, uncertainty: f64) -> Result<Spectrum, MechError> {
        let uncertainty = uncertainty.max(8.0 * matrix.rows() as f64 * f64::EPSILON);
        let noise = uncertainty * norm(&matrix.entries());
        let mut spectrum = Spectrum::with_noise(matrix, &matrix.map(|_| noise))?;
        spectrum.uncertainty = uncertainty;
        Ok(spectrum)
    }

    /// The spectrum of a square matrix whose entries have these errors.
    ///
    /// # Errors
    /// As for [`of`](Spectrum::of).
    pub(crate) fn with_noise(matrix: &Matrix<f64>, noise: &Matrix<f64>) -> Result<Spectrum, MechError> {
        let size = matrix.rows();
        if matrix.columns() != size {
            let what = "a row of the matrix of the first approximation";
            return Err(ShapeError { what, found: matrix.columns(), expected: size }.into());
        }
        let certain = certain(matrix, noise);
        let scales = balancing(&certain);
        let scaled =
            |of: &Matrix<f64>| Matrix::from_fn(size, size, |i, j| of[(i, j)] * scales[j] / scales[i]);
        let (balanced, noise) = (scaled(&certain), scaled(noise));
        let (regular, zero_blocks) = without_zeros(&balanced, &noise)?;
        let error = norm(&noise.entries()) + 8.0 * size as f64 * f64::EPSILON * norm(&balanced.entries());
        let mut found = eigenvalues_within(&regular, error, norm(&balanced.entries()))?;
        let tolerance = found.iter().map(|&(_, within)| within).fold(0.0, f64::max);
        let zeros: usize = zero_blocks.iter().sum();
        let mut eigenvalues: Vec<Eigenvalue> = found.drain(..).map(|(value, _)| value).collect();
        eigenvalues.extend(std::iter::repeat_n(Eigenvalue { real: 0.0, imaginary: 0.0 }, zeros));
        eigenvalues.sort_by(|a, b| b.real.total_cmp(&a.real).then(b.imaginary.total_cmp(&a.imaginary)));
        let scale = norm(&balanced.entries());
        let uncertainty = if scale > 0.0 { error / scale } else { 0.0 };
        Ok(Spectrum { eigenvalues, zero_blocks, tolerance, uncertainty })
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

    /// The largest error of a real part; real parts within their own errors are zero.
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// The uncertainty of the entries, as a fraction of |A|.
    pub(crate) fn uncertainty(&self) -> f64 {
        self.uncertainty
    }

    /// The number of eigenvalues whose real part counts as zero, including zero eigenvalues.
    pub fn neutral(&self) -> usize {
        self.eigenvalues.iter().filter(|value| value.real == 0.0).count()
    }

    /// [`Unstable`](Verdict::Unstable) if a real part is positive, by more than its error,
    /// [`AsymptoticallyStable`](Verdict::AsymptoticallyStable) if all are negative in this sense,
    /// [`Undecided`](Verdict::Undecided) otherwise.
    ///
    /// Zero eigenvalues never count as growth, whether in blocks or not: in the first approximation a block
    /// means growth with a power of t, which may lead along a family of steady motions, and the motion itself
    /// need not grow.
    pub fn verdict(&self) -> Verdict {
        match self.eigenvalues.first() {
            Some(first) if first.real > 0.0 => Verdict::Unstable,
            Some(first) if first.real == 0.0 => Verdict::Undecided,
            _ => Verdict::AsymptoticallyStable,
        }
    }
}

/// The eigenvalues of a regular matrix, each with the error of its parts; a part within its error is zero.
///
/// A change E of the matrix moves a simple eigenvalue by up to |E|/|yᴴ x|, where x and y are its right and left eigenvectors
/// of length one (J. H. Wilkinson), and a double one by up to √(|E| |A|).
fn eigenvalues_within(
    regular: &Matrix<f64>,
    error: f64,
    scale: f64,
) -> Result<Vec<(Eigenvalue, f64)>, MechError> {
    let right = eigenvectors(regular)?;
    let left = eigenvectors(&regular.transpose())?;
    let most = (error * scale).sqrt();
    let clean = |part: f64, within: f64| if part.abs() <= within { 0.0 } else { part };
    let with_error = |((real, imaginary), x): &Eigenpair| {
        // The left eigenvector of the same eigenvalue is that of the transpose with the nearest one, not conjugated.
        let distance = |(re, im): (f64, f64)| (re - real).hypot(im - imaginary);
        let nearest = left.iter().min_by(|(a, _), (b, _)| distance(*a).total_cmp(&distance(*b)));
        let along = nearest.map_or(0.0, |(_, y)| {
            let parts = x.iter().zip(y).map(|((a, b), (c, d))| (a * c - b * d, a * d + b * c));
            let (re, im) = parts.fold((0.0, 0.0), |(re, im), (a, b)| (re + a, im + b));
            let length = |v: &[(f64, f64)]| v.iter().map(|(a, b)| a * a + b * b).sum::<f64>().sqrt();
            re.hypot(im) / (length(x) * length(y))
        });
        let within = if along > 0.0 { (SAFETY * error / along).min(most) } else { most };
        (Eigenvalue { real: clean(*real, within), imaginary: clean(*imaginary, within) }, within)
    };
    Ok(right.iter().map(with_error).collect())
}

/// The error of an eigenvalue is estimated to first order, with this margin.
const SAFETY: f64 = 4.0;

/// The matrix without the entries that are within their errors.
fn certain(matrix: &Matrix<f64>, noise: &Matrix<f64>) -> Matrix<f64> {
    let entry = |i: usize, j: usize| if matrix[(i, j)].abs() <= noise[(i, j)] { 0.0 } else { matrix[(i, j)] };
    Matrix::from_fn(matrix.rows(), matrix.columns(), entry)
}

/// The matrix without the rows and columns that are errors as a whole, and the same with entries of size one. A row of which
/// rounding has left 10⁻¹⁶ has errors of that size in all of its entries; scaled to size one, they would pass for those of the
/// matrix.
fn equilibrated(mut matrix: Matrix<f64>, noise: &Matrix<f64>) -> (Matrix<f64>, Equilibrated) {
    let size = matrix.rows();
    loop {
        let scaled = Equilibrated::of(&matrix);
        let errors = Matrix::from_fn(size, size, |i, j| noise[(i, j)] * scaled.rows[i] * scaled.columns[j]);
        let is_lost = |line: &Line| {
            let entry = line.largest(&scaled.matrix);
            entry > 0.0 && line.largest(&errors) > UNCERTAIN * entry
        };
        // One after another, from the smallest: a line may be lost only in the scales that another one asks for.
        let lost = (0..size).flat_map(|i| [Line::Row(i), Line::Column(i)]).filter(is_lost);
        let Some(line) = lost.min_by(|a, b| a.largest(&matrix).total_cmp(&b.largest(&matrix))) else {
            return (matrix, scaled);
        };
        matrix = line.cleared(&matrix);
    }
}

/// A row or a column that has errors of this fraction of its entries is an error.
const UNCERTAIN: f64 = 0.1;

/// A row or a column of a square matrix.
#[derive(Clone, Copy)]
enum Line {
    Row(usize),
    Column(usize),
}

impl Line {
    fn largest(self, matrix: &Matrix<f64>) -> f64 {
        let entry = |along: usize| match self {
            Line::Row(i) => matrix[(i, along)].abs(),
            Line::Column(j) => matrix[(along, j)].abs(),
        };
        (0..matrix.rows()).map(entry).fold(0.0, f64::max)
    }

    fn cleared(self, matrix: &Matrix<f64>) -> Matrix<f64> {
        Matrix::from_fn(matrix.rows(), matrix.columns(), |i, j| match self {
            Line::Row(own) if own == i => 0.0,
            Line::Column(own) if own == j => 0.0,
            _ => matrix[(i, j)],
        })
    }
}

/// The numbers d, powers of two, for which the rows and columns of d_i⁻¹ A_ij d_j have about the same size.
fn balancing(matrix: &Matrix<f64>) -> Vec<f64> {
    let size = matrix.rows();
    let mut scales = vec![1.0; size];
    for _ in 0..MOST_PASSES {
        let mut changed = false;
        for i in 0..size {
            let others = (0..size).filter(|&j| j != i);
            let entry = |i: usize, j: usize| (matrix[(i, j)] * scales[j] / scales[i]).abs();
            let (row, column) = others.fold((0.0f64, 0.0f64), |(row, column), j| {
                (row.hypot(entry(i, j)), column.hypot(entry(j, i)))
            });
            if row == 0.0 || column == 0.0 {
                continue;
            }
            let factor = ((row / column).log2() / 2.0).round().exp2();
            if factor != 1.0 {
                scales[i] *= factor;
                changed = true;
            }
        }
        if !changed {
            break;
        }
    }
    scales
}

/// The largest number of passes of balancing.
const MOST_PASSES: usize = 40;

/// A regular matrix that has the nonzero eigenvalues of `matrix`, and the number of zeros split off at each
/// step.
fn without_zeros(matrix: &Matrix<f64>, noise: &Matrix<f64>) -> Result<(Matrix<f64>, Vec<usize>), MechError> {
    let (mut rest, mut noise, mut blocks) = (matrix.clone(), noise.clone(), Vec::new());
    loop {
        let scaled;
        (rest, scaled) = equilibrated(certain(&rest, &noise), &noise);
        let factors = SingularValues::of(&scaled.matrix)?;
        let size = rest.rows();
        let error = |i: usize, j: usize| noise[(i, j)] * scaled.rows[i] * scaled.columns[j];
        let within = norm(&Matrix::from_fn(size, size, error).entries());
        let largest = factors.values.first().copied().unwrap_or(0.0);
        let rank = factors.rank(within.max(RANK * largest));
        if rank == size {
            return Ok((rest, blocks));
        }
        blocks.push(size - rank);
        // The image of the matrix itself, orthonormal.
        let image = |i: usize, j: usize| factors.left[(i, j)] / scaled.rows[i];
        let lengths: Vec<f64> =
            (0..rank).map(|j| norm(&(0..size).map(|i| image(i, j)).collect::<Vec<_>>())).collect();
        let image = SingularValues::of(&Matrix::from_fn(size, rank, |i, j| image(i, j) / lengths[j]))?.left;
        let basis = Matrix::from_fn(size, rank, |i, j| image[(i, j)]);
        let compressed = |of: &Matrix<f64>| product(&basis.transpose(), &product(of, &basis));
        let sizes = basis.map(f64::abs);
        noise = product(&sizes.transpose(), &product(&noise, &sizes));
        rest = compressed(&rest);
    }
}
