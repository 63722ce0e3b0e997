//! Lie algebras known by name.

use pc_expr::Number;

use crate::error::AlgebraError;
use crate::lie_algebra::bianchi::behr;
use crate::lie_algebra::families::{matrices, rotations};
use crate::lie_algebra::lie_algebra::LieAlgebra;

/// An algebra of the catalogue.
pub struct Entry {
    /// The name under which [`LieAlgebra::named`] finds it.
    pub name: &'static str,
    /// A description, with the order and signs of the basis.
    pub description: &'static str,
    make: fn() -> LieAlgebra,
}

const fn entry(name: &'static str, description: &'static str, make: fn() -> LieAlgebra) -> Entry {
    Entry { name, description, make }
}

/// The algebras whose names contain neither a size nor a parameter. If two algebras have equal constants, the
/// more common name comes first. Commutative algebras are not listed: they need no name.
pub const CATALOGUE: &[Entry] = &[
    entry(
        "so3",
        "rotations of space, basis of body angular velocities: [X1,X2] = X3 and cyclically; \
         so4, so5.. are known too",
        LieAlgebra::so3,
    ),
    entry(
        "so4",
        "rotations of four dimensions: X1..X3 as so3, X4..X6 turn axes 1, 2, 3 towards axis 4",
        || rotations(4),
    ),
    entry(
        "se2",
        "motions of the plane in body axes: rotation X1, translations X2, X3; [X1,X2] = X3, [X1,X3] = -X2",
        LieAlgebra::se2,
    ),
    entry(
        "se3",
        "motions of space in body axes: rotations X1..X3 as so3, translations X4..X6; \
         [X1,X5] = X6 and cyclically",
        LieAlgebra::se3,
    ),
    entry(
        "sl2",
        "traceless real 2 x 2 matrices H, E, F: [X1,X2] = 2*X2, [X1,X3] = -2*X3, [X2,X3] = X1",
        LieAlgebra::sl2,
    ),
    entry(
        "su2",
        "unit quaternions, basis i/2, j/2, k/2: [X1,X2] = X3 and cyclically, as so3",
        LieAlgebra::so3,
    ),
    entry(
        "heisenberg",
        "positions, momenta, centre: [X1,X2] = X3; heisenberg5 is [X1,X3] = [X2,X4] = X5, and so on",
        || LieAlgebra::heisenberg(1),
    ),
    entry("aff1", "affine maps of the line, scaling X1, translation X2: [X1,X2] = X2", LieAlgebra::aff1),
    entry(
        "gl2",
        "all 2 x 2 matrices, basis E11, E12, E21, E22: [Eij,Ekl] = Eil if j = k, less Ekj if i = l; \
         gl3, gl4.. likewise",
        || matrices(2),
    ),
    entry(
        "bianchi2",
        "Bianchi's type II, Heisenberg: [X2,X3] = X1; type I, bianchi1, is commutative",
        || behr(Number::ZERO, [1, 0, 0]),
    ),
    entry("bianchi3", "Bianchi's type III = VI with h = -1: [X1,X2] = [X1,X3] = -X2 - X3", || {
        behr(Number::ONE, [0, 1, -1])
    }),
    entry("bianchi4", "Bianchi's type IV: [X1,X2] = -X2 + X3, [X1,X3] = -X3", || {
        behr(Number::ONE, [0, 0, 1])
    }),
    entry("bianchi5", "Bianchi's type V: [X1,X2] = -X2, [X1,X3] = -X3", || behr(Number::ONE, [0, 0, 0])),
    entry(
        "bianchi6",
        "Bianchi's type VI with h = 0: [X1,X2] = -X3, [X1,X3] = -X2; bianchi6(h), h = -a^2: \
         [X1,X2] = -a*X2 - X3, [X1,X3] = -X2 - a*X3",
        || behr(Number::ZERO, [0, 1, -1]),
    ),
    entry(
        "bianchi7",
        "Bianchi's type VII with h = 0, as se2: [X1,X2] = X3, [X1,X3] = -X2; bianchi7(h), h = a^2: \
         [X1,X2] = -a*X2 + X3, [X1,X3] = -X2 - a*X3",
        || behr(Number::ZERO, [0, 1, 1]),
    ),
    entry("bianchi8", "Bianchi's type VIII, sl(2): [X1,X2] = -X3, [X2,X3] = X1, [X3,X1] = X2", || {
        behr(Number::ZERO, [1, 1, -1])
    }),
    entry("bianchi9", "Bianchi's type IX: [X1,X2] = X3 and cyclically, as so3", || {
        behr(Number::ZERO, [1, 1, 1])
    }),
];

impl LieAlgebra {
    /// The algebra with that name: one of the [`CATALOGUE`], a member of a family by its size (`so5`, `gl3`,
    /// `heisenberg7`), `bianchi1`, or a Bianchi type with parameter (`bianchi6(-1/4)`, `bianchi7(0.25)`).
    ///
    /// # Errors
    /// [`AlgebraError::UnknownAlgebra`] with the existing names; [`AlgebraError::BianchiParameter`];
    /// [`AlgebraError::TooLargeFamily`].
    ///
    /// ```
    /// # use pc_algebra::LieAlgebra;
    /// assert_eq!(LieAlgebra::named("bianchi6(-1)")?, LieAlgebra::named("bianchi3")?);
    /// assert_eq!(LieAlgebra::named("so5")?.dim(), 10);
    /// # Ok::<(), pc_algebra::AlgebraError>(())
    /// ```
    pub fn named(name: &str) -> Result<LieAlgebra, AlgebraError> {
        if let Some(entry) = CATALOGUE.iter().find(|entry| entry.name == name) {
            return Ok((entry.make)());
        }
        if name == "bianchi1" {
            return Ok(LieAlgebra::commutative(3));
        }
        if let Some(h) = parameter(name, "bianchi6") {
            return LieAlgebra::bianchi6(h);
        }
        if let Some(h) = parameter(name, "bianchi7") {
            return LieAlgebra::bianchi7(h);
        }
        if let Some(n) = size(name, "so") {
            return LieAlgebra::so(n);
        }
        if let Some(n) = size(name, "gl") {
            return LieAlgebra::gl(n);
        }
        match size(name, "heisenberg") {
            Some(dim) if dim > LARGEST_HEISENBERG => Err(AlgebraError::TooLargeFamily {
                family: "heisenberg",
                n: dim,
                largest: LARGEST_HEISENBERG,
            }),
            Some(dim) if dim % 2 == 1 => Ok(LieAlgebra::heisenberg(dim / 2)),
            _ => {
                let known = CATALOGUE.iter().map(|entry| entry.name).collect();
                Err(AlgebraError::UnknownAlgebra { name: name.to_owned(), known })
            }
        }
    }
}

/// The largest dimension of a Heisenberg algebra that can be named.
const LARGEST_HEISENBERG: usize = 65;

/// The number n in a name of the form `familyn`.
fn size(name: &str, family: &str) -> Option<usize> {
    let digits = name.strip_prefix(family)?;
    let plain = !digits.starts_with('0') && digits.bytes().all(|b| b.is_ascii_digit());
    plain.then(|| digits.parse().ok()).flatten()
}

/// The number h in a name of the form `kind(h)`, a decimal or a fraction.
fn parameter(name: &str, kind: &str) -> Option<Number> {
    let text = name.strip_prefix(kind)?.trim().strip_prefix('(')?.strip_suffix(')')?;
    let Some((num, den)) = text.split_once('/') else {
        let value: f64 = text.trim().parse().ok()?;
        return Some(Number::from(value));
    };
    let (num, den): (i64, i64) = (num.trim().parse().ok()?, den.trim().parse().ok()?);
    Some(Number::ratio(num, den))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_entry_is_a_lie_algebra() {
        for entry in CATALOGUE {
            let algebra = LieAlgebra::named(entry.name).unwrap();
            let checked = LieAlgebra::new(algebra.dim(), |r, s, m| algebra.constant(r, s, m));
            assert_eq!(checked.as_ref(), Ok(&algebra), "{}", entry.name);
            assert!(!algebra.is_abelian(), "{}", entry.name);
        }
    }

    #[test]
    fn so3_is_the_cross_product() {
        let so3 = LieAlgebra::so3();
        assert_eq!(LieAlgebra::named("so3").unwrap(), so3);
        assert_eq!(so3.bracket(&[1.0, 0.0, 0.0], &[0.0, 1.0, 0.0]), [0.0, 0.0, 1.0]);
        assert_eq!(so3.bracket(&[1.0, 2.0, 3.0], &[-4.0, 5.0, 0.5]), [-14.0, -12.5, 13.0]);
    }

    #[test]
    fn equal_constants_have_the_more_common_name_first() {
        let first = |algebra: &LieAlgebra| {
            CATALOGUE.iter().find(|entry| LieAlgebra::named(entry.name).as_ref() == Ok(algebra)).unwrap().name
        };
        for (name, common) in [("su2", "so3"), ("bianchi9", "so3"), ("bianchi7", "se2"), ("sl2", "sl2")] {
            assert_eq!(first(&LieAlgebra::named(name).unwrap()), common);
        }
    }

    #[test]
    fn names_may_have_a_size_or_a_parameter() {
        assert_eq!(LieAlgebra::named("heisenberg5").unwrap(), LieAlgebra::heisenberg(2));
        assert_eq!(LieAlgebra::named("gl3").unwrap().dim(), 9);
        assert_eq!(LieAlgebra::named("bianchi1").unwrap(), LieAlgebra::commutative(3));
        assert_eq!(LieAlgebra::named("bianchi6( -1/4 )").unwrap().constant(0, 1, 1), Number::ratio(-1, 2));
        assert_eq!(LieAlgebra::named("bianchi7(0.25)"), LieAlgebra::named("bianchi7(1/4)"));
        assert_eq!(LieAlgebra::named("bianchi7(0)"), LieAlgebra::named("se2"));
    }

    #[test]
    fn other_names_are_refused() {
        for wrong in
            ["so(3)", "so", "so03", "heisenberg4", "bianchi10", "bianchi6(x)", "bianchi6(", "gl-2", ""]
        {
            let error = LieAlgebra::named(wrong).unwrap_err();
            assert!(matches!(error, AlgebraError::UnknownAlgebra { .. }), "{wrong}: {error}");
        }
        let message = |name: &str| LieAlgebra::named(name).unwrap_err().to_string();
        assert_eq!(message("bianchi6(2)"), "Bianchi type VI has a parameter h ≤ 0, not 2");
        assert_eq!(message("bianchi7(-1/2)"), "Bianchi type VII has a parameter h ≥ 0, not -1/2");
        assert_eq!(message("so99"), "so(n) is available up to n = 12, not for n = 99");
        for undefined in ["bianchi6(nan)", "bianchi6(-inf)", "bianchi7(1/0)"] {
            let error = LieAlgebra::named(undefined).unwrap_err();
            assert!(matches!(error, AlgebraError::BianchiParameter { .. }), "{undefined}: {error}");
        }
    }
}
