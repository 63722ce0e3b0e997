//! Linear subspaces of a Lie algebra.

use num_rational::BigRational;
use pc_expr::Number;

use crate::error::AlgebraError;
use crate::frame::frame::shape;
use crate::lie_algebra::structure_constants::{exact, primitive, rounded};
use crate::linear_algebra::echelon::Echelon;

/// A linear subspace of ℚ^k, stored in reduced row echelon form, so that equal subspaces compare equal.
#[derive(Clone, Debug, PartialEq)]
pub struct Subspace {
    echelon: Echelon,
}

impl Subspace {
    /// The span of vectors of length `ambient`.
    ///
    /// # Errors
    /// [`AlgebraError::Shape`] for a vector of a different length, [`AlgebraError::IrrationalEntry`] for an
    /// entry that is not rational (the vectors count as rows).
    ///
    /// ```
    /// # use pc_algebra::Subspace;
    /// let [u, v] = [[1, 2, 3], [0, 2, 1]].map(|vector| vector.map(Into::into).to_vec());
    /// let plane = Subspace::span(3, &[u, v])?;
    /// assert_eq!(plane.dim(), 2);
    /// assert!(plane.contains(&[1.into(), 0.into(), 2.into()])?);
    /// # Ok::<(), pc_algebra::AlgebraError>(())
    /// ```
    pub fn span(ambient: usize, vectors: &[Vec<Number>]) -> Result<Subspace, AlgebraError> {
        let mut echelon = Echelon::new(ambient);
        for (row, vector) in vectors.iter().enumerate() {
            echelon.insert(exact_vector(ambient, row, vector)?);
        }
        Ok(Subspace { echelon })
    }

    /// All of ℚ^k.
    pub fn whole(ambient: usize) -> Subspace {
        let unit = |i: usize| -> Vec<BigRational> {
            (0..ambient).map(|j| BigRational::from_integer(i32::from(i == j).into())).collect()
        };
        Subspace { echelon: Echelon::of(ambient, (0..ambient).map(unit)) }
    }

    pub(crate) fn of_exact(ambient: usize, vectors: impl IntoIterator<Item = Vec<BigRational>>) -> Subspace {
        Subspace { echelon: Echelon::of(ambient, vectors) }
    }

    pub(crate) fn rows(&self) -> &[Vec<BigRational>] {
        self.echelon.rows()
    }

    pub(crate) fn has(&self, vector: &[BigRational]) -> bool {
        self.echelon.contains(vector)
    }

    /// Dimension of the subspace.
    pub fn dim(&self) -> usize {
        self.echelon.rank()
    }

    /// Dimension k of the ambient space.
    pub fn ambient(&self) -> usize {
        self.echelon.columns()
    }

    /// A basis of vectors with coprime integer entries (rounded if they exceed 2⁵³), in echelon form.
    pub fn basis(&self) -> Vec<Vec<Number>> {
        self.rows().iter().map(|row| primitive(row).iter().map(rounded).collect()).collect()
    }

    /// Whether `vector`, of length [`ambient`](Subspace::ambient), lies in the subspace.
    ///
    /// # Errors
    /// As for [`span`](Subspace::span).
    pub fn contains(&self, vector: &[Number]) -> Result<bool, AlgebraError> {
        Ok(self.has(&exact_vector(self.ambient(), 0, vector)?))
    }

    /// Whether every vector of this subspace lies in `other`; false for different ambient spaces.
    pub fn is_within(&self, other: &Subspace) -> bool {
        self.ambient() == other.ambient() && self.rows().iter().all(|row| other.has(row))
    }
}

fn exact_vector(ambient: usize, row: usize, vector: &[Number]) -> Result<Vec<BigRational>, AlgebraError> {
    shape("the vector", vector.len(), ambient)?;
    let entry = |(column, &value): (usize, &Number)| {
        exact(value).ok_or_else(|| AlgebraError::IrrationalEntry {
            what: "the list of vectors",
            row: row + 1,
            column: column + 1,
            value: value.to_string(),
        })
    };
    vector.iter().enumerate().map(entry).collect()
}
