//! The equations of V. V. Rumyantsev's paper *On Poincaré–Chetaev's equations* (1994), one by one: a file a subject of the
//! paper, and the number of the equation in the name of each test.
//!
//! | equations | subject | file |
//! |---|---|---|
//! | (1)–(7) | frames of operators and their structure coefficients | `equations_01_07_frames.rs` |
//! | (8), (9) | generalised forces, Poincaré's equations | `equations_08_09_poincare.rs` |
//! | (9) | the same in random frames, against Lagrange's | `equation_09_random_frames.rs` |
//! | (10)–(13) | Chetaev's canonical equations, the Poisson bracket | `equations_10_13_chetaev.rs` |
//! | (14)–(17) | redundant coordinates | `equations_14_17_redundant_coordinates.rs` |
//! | (18), (19) | quasi-coordinates | `equations_18_19_quasi_coordinates.rs` |
//! | (20)–(26) | the heavy top | `equations_20_26_heavy_top.rs` |
//! | (27)–(30), (32), (33) | nonholonomic constraints | `equations_27_33_constraints.rs` |
//! | (31) | nonholonomic constraints in canonical variables | `equation_31_canonical.rs` |
//! | (30) | motions of nonholonomic systems, against references of 16 digits | `equation_30_motions.rs` |
//! | (30)–(35) | forms of the nonholonomic equations, on many systems | `equations_30_35_nonholonomic.rs` |
//! | (10)–(13), (31) | theorems of Poisson, Hamilton and Jacobi, and the full H | `theorems_from_text_rust_and_c.rs` |
//!
//! `cargo test --workspace --test rumyantsev equation_12` runs the tests of one equation. Where the paper has a misprint, the
//! corrected equation is tested, and the test says what is printed.
//!
//! Most of them are identities between expressions. These are decided by `Expr::is_zero`, which needs no tolerance.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

#[path = "../tests/it/holonomic/definition.rs"]
mod definition;
mod equation_09_random_frames;
mod equation_30_motions;
mod equation_31_canonical;
mod equations_01_07_frames;
mod equations_08_09_poincare;
mod equations_10_13_chetaev;
mod equations_14_17_redundant_coordinates;
mod equations_18_19_quasi_coordinates;
mod equations_20_26_heavy_top;
mod equations_27_33_constraints;
mod equations_30_35_nonholonomic;
mod jet;
mod theorems_from_text_rust_and_c;

use pc_mech::{Equations, Expr};

/// The left-hand sides are the right-hand sides, for all values of their symbols.
#[track_caller]
fn assert_identities<'g>(what: &str, pairs: impl IntoIterator<Item = (Expr<'g>, Expr<'g>)>) {
    let mut count = 0;
    for (found, expected) in pairs {
        count += 1;
        assert!((found - expected).is_zero(), "{what}, component {count}: {found} is not {expected}");
    }
    assert!(count > 0, "{what}: nothing is compared");
}

/// As many left-hand sides as right-hand sides, one the other for all values of their symbols.
#[track_caller]
fn assert_all_equal<'g>(
    what: &str,
    found: impl IntoIterator<Item = Expr<'g>>,
    expected: impl IntoIterator<Item = Expr<'g>>,
) {
    let (found, expected): (Vec<_>, Vec<_>) = (found.into_iter().collect(), expected.into_iter().collect());
    assert_eq!(found.len(), expected.len(), "{what}: number of components");
    assert_identities(what, found.into_iter().zip(expected));
}

/// ẋ, η̇ and ṫ = 1 along the motion, for derivatives d/dt.
fn along<'g>(equations: &Equations<'g>) -> Vec<(Expr<'g>, Expr<'g>)> {
    let system = equations.system();
    let x = system.frame().coordinates().iter().copied().zip(equations.velocities().iter().copied());
    let eta = system.quasi_velocities().iter().copied().zip(equations.accelerations());
    x.chain(eta).chain([(system.frame().time(), Expr::ONE)]).collect()
}
