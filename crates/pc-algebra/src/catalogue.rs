//! Lie algebras with a name.

use pc_expr::Number;

use crate::error::AlgebraError;
use crate::lie_algebra::LieAlgebra;

/// An algebra of the catalogue.
pub struct Entry {
    /// The name that [`LieAlgebra::named`] knows.
    pub name: &'static str,
    /// What it is, with the order and signs of its basis.
    pub description: &'static str,
    /// [X_r, X_s] = value·X_m as (r, s, m, value), from 0.
    brackets: &'static [(usize, usize, usize, i32)],
    dim: usize,
}

/// All algebras that have a name.
pub const CATALOGUE: &[Entry] = &[Entry {
    name: "so3",
    description: "rotations of space, basis of body angular velocities: [X1,X2] = X3 and cyclically",
    brackets: &[(0, 1, 2, 1), (1, 2, 0, 1), (2, 0, 1, 1)],
    dim: 3,
}];

impl LieAlgebra {
    /// The rotations of space with c_12^3 = c_23^1 = c_31^2 = 1 (22): the signs of the body angular velocity.
    pub fn so3() -> LieAlgebra {
        let constant = |r: usize, s: usize, m: usize| match (3 + s - r) % 3 {
            1 if m == 3 - r - s => Number::ONE,
            2 if m == 3 - r - s => Number::MINUS_ONE,
            _ => Number::ZERO,
        };
        LieAlgebra::from_constants(3, constant)
    }

    /// The algebra of that name in the [`CATALOGUE`].
    ///
    /// # Errors
    /// [`AlgebraError::UnknownAlgebra`] with the names there are.
    pub fn named(name: &str) -> Result<LieAlgebra, AlgebraError> {
        let Some(entry) = CATALOGUE.iter().find(|entry| entry.name == name) else {
            let known = CATALOGUE.iter().map(|entry| entry.name).collect();
            return Err(AlgebraError::UnknownAlgebra { name: name.to_owned(), known });
        };
        let brackets: Vec<_> = entry.brackets.iter().map(|&(r, s, m, c)| (r, s, m, c.into())).collect();
        LieAlgebra::from_brackets(entry.dim, &brackets)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_entry_is_a_lie_algebra() {
        for entry in CATALOGUE {
            assert_eq!(LieAlgebra::named(entry.name).unwrap().dim(), entry.dim, "{}", entry.name);
        }
    }

    #[test]
    fn so3_is_the_cross_product() {
        let so3 = LieAlgebra::so3();
        assert_eq!(LieAlgebra::named("so3").unwrap(), so3);
        assert_eq!(so3.bracket(&[1.0, 0.0, 0.0], &[0.0, 1.0, 0.0]), [0.0, 0.0, 1.0]);
        assert_eq!(so3.bracket(&[1.0, 2.0, 3.0], &[-4.0, 5.0, 0.5]), [-14.0, -12.5, 13.0]);
    }
}
