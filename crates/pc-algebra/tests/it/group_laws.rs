//! One suite of laws that every group passes, at random elements with a fixed seed.

use nalgebra::{DMatrix, DVector};
use pc_algebra::{
    DirectProduct, EulerAngles, HeisenbergGroup, LieAlgebra, LieGroup, Matrix, Neighbourhood, PlaneMotions,
    PlaneRotations, RigidMotions, RotationMatrices, Side, UnitQuaternions,
};
use pc_expr::{Expr, Graph};
use proptest::prelude::*;
use proptest::test_runner::{RngSeed, TestRunner};

/// A few dozen roundings of numbers of size ten.
const ROUNDING: f64 = 1e-13;
/// Central differences with this step have an error of step² and a rounding of 1e-16/step: 1e-10 each.
const STEP: f64 = 1e-5;
const DIFFERENCES: f64 = 1e-8;
/// Components of algebra elements: rotations stay below |x| = 1.7·√3 < π.
const REACH: f64 = 1.7;

fn config() -> ProptestConfig {
    ProptestConfig {
        cases: 64,
        rng_seed: RngSeed::Fixed(11),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

fn laws<G: LieGroup>(group: &G) {
    let vector = || prop::collection::vec(-REACH..REACH, group.dim());
    let check = |(x, y, z): (Vec<f64>, Vec<f64>, Vec<f64>)| {
        product(group, &x, &y, &z);
        exponential(group, &x);
        adjoint(group, &x, &y);
        derivative_of_exponential(group, &x, &y);
        projection(group, &x, &y);
        frame_velocities(group, &group.compose(&group.exp(&x), &group.exp(&y)));
        Ok(())
    };
    TestRunner::new(config()).run(&(vector(), vector(), vector()), check).unwrap();
    shapes(group);
    structure(group);
}

fn close(a: &DMatrix<f64>, b: &DMatrix<f64>, tolerance: f64, what: &str) {
    let size = 1.0 + a.amax().max(b.amax());
    assert!((a - b).amax() < tolerance * size, "{what}: {a} {b}");
}

fn shapes<G: LieGroup>(group: &G) {
    let (n, k) = (group.coordinates().len(), group.dim());
    assert_eq!(group.algebra().dim(), k);
    assert_eq!(group.identity().len(), n);
    assert_eq!(group.exp(&vec![0.0; k]), group.identity());
    assert_eq!(group.log(&group.identity()), vec![0.0; k]);
    for side in [Side::Left, Side::Right] {
        assert_eq!(group.dexp(side, &vec![0.0; k]), DMatrix::identity(k, k));
        assert_eq!(group.dexp_inverse(side, &vec![0.0; k]), DMatrix::identity(k, k));
    }
}

fn product<G: LieGroup>(group: &G, x: &[f64], y: &[f64], z: &[f64]) {
    let [a, b, c] = [x, y, z].map(|x| group.exp(x));
    let left = group.compose(&group.compose(&a, &b), &c);
    let right = group.compose(&a, &group.compose(&b, &c));
    assert!(group.distance(&left, &right) < ROUNDING, "associativity: {left:?} {right:?}");
    let one = group.identity();
    for same in [group.compose(&a, &one), group.compose(&one, &a)] {
        assert!(group.distance(&same, &a) < ROUNDING, "identity: {same:?} {a:?}");
    }
    for none in [group.compose(&a, &group.inverse(&a)), group.compose(&group.inverse(&a), &a)] {
        assert!(group.distance(&none, &one) < ROUNDING, "inverse: {none:?}");
    }
}

fn exponential<G: LieGroup>(group: &G, x: &[f64]) {
    for scale in [1.0, 1e-3, 1e-9] {
        let x: Vec<f64> = x.iter().map(|x| x * scale).collect();
        let back = group.log(&group.exp(&x));
        let error = (DVector::from_vec(back) - DVector::from_vec(x.clone())).amax();
        // The logarithm of a matrix or of angles near 1 is known to the rounding of 1.
        assert!(error < ROUNDING, "log exp {x:?}: {error}");
        let double: Vec<f64> = x.iter().map(|x| 2.0 * x).collect();
        let twice = group.compose(&group.exp(&x), &group.exp(&x));
        assert!(group.distance(&twice, &group.exp(&double)) < ROUNDING, "one-parameter group of {x:?}");
        assert!(
            group.distance(&group.exp(&group.log(&twice)), &twice) < 10.0 * ROUNDING,
            "exp log {twice:?}"
        );
    }
}

fn adjoint<G: LieGroup>(group: &G, x: &[f64], y: &[f64]) {
    let [g, h] = [x, y].map(|x| group.exp(x));
    let both = group.adjoint(&group.compose(&g, &h));
    close(&both, &(group.adjoint(&g) * group.adjoint(&h)), ROUNDING, "Ad gh");
    close(&group.adjoint(&g), &group.ad(x).exp(), 10.0 * ROUNDING, "Ad exp");
    // Ad_g [x, y] = [Ad_g x, Ad_g y], as matrices Ad_g ad_y = ad_(Ad_g y) Ad_g.
    let moved = group.adjoint(&g) * DVector::from_column_slice(y);
    let [left, right] = [group.adjoint(&g) * group.ad(y), group.ad(moved.as_slice()) * group.adjoint(&g)];
    close(&left, &right, ROUNDING, "Ad of a bracket");
    // g exp(y) g⁻¹ = exp(Ad_g y)
    let conjugate = group.compose(&group.compose(&g, &h), &group.inverse(&g));
    assert!(group.distance(&conjugate, &group.exp(moved.as_slice())) < 10.0 * ROUNDING, "conjugation");
}

fn derivative_of_exponential<G: LieGroup>(group: &G, x: &[f64], y: &[f64]) {
    let shifted = |step: f64| {
        let x: Vec<f64> = x.iter().zip(y).map(|(x, y)| x + step * y).collect();
        group.exp(&x)
    };
    let back = group.inverse(&group.exp(x));
    for side in [Side::Left, Side::Right] {
        let rate = |step: f64| {
            let moved = match side {
                Side::Left => group.compose(&back, &shifted(step)),
                Side::Right => group.compose(&shifted(step), &back),
            };
            DVector::from_vec(group.log(&moved))
        };
        let difference = (rate(STEP) - rate(-STEP)) / (2.0 * STEP);
        let dexp = group.dexp(side, x);
        let expected = &dexp * DVector::from_column_slice(y);
        assert!((&difference - &expected).amax() < DIFFERENCES, "dexp {side:?}: {difference} {expected}");
        close(&dexp, &series(side, &group.ad(x)), ROUNDING, "series of dexp");
        let product = dexp * group.dexp_inverse(side, x);
        close(&product, &DMatrix::identity(x.len(), x.len()), 10.0 * ROUNDING, "inverse of dexp");
    }
}

/// Σ (±A)^i/(i + 1)!, minus on the left; |A| is below 10.
fn series(side: Side, ad: &DMatrix<f64>) -> DMatrix<f64> {
    let a = if side == Side::Left { -ad } else { ad.clone() };
    let one = DMatrix::<f64>::identity(ad.nrows(), ad.nrows());
    (1..60).rev().fold(one.clone(), |sum, i| &one + &a * sum / f64::from(i + 1))
}

fn projection<G: LieGroup>(group: &G, x: &[f64], y: &[f64]) {
    let g = group.exp(x);
    assert!(group.distance(&group.project(&g).unwrap(), &g) < ROUNDING, "projection of {g:?}");
    let off: Vec<f64> = g.iter().zip(y.iter().cycle()).map(|(g, y)| g + 1e-3 * y).collect();
    let once = group.project(&off).unwrap();
    let twice = group.project(&once).unwrap();
    assert!(group.distance(&once, &twice) < ROUNDING, "projection twice: {once:?} {twice:?}");
    let one = group.compose(&once, &group.inverse(&once));
    assert!(group.distance(&one, &group.identity()) < ROUNDING, "the projection {once:?} is in the group");
    assert!(group.project(&vec![f64::NAN; g.len()]).is_err());
}

/// The columns of b are d/dε g exp(εe_s) on the left, d/dε exp(εe_s) g on the right.
fn frame_velocities<G: LieGroup>(group: &G, g: &[f64]) {
    let graph = Graph::new();
    let symbols: Vec<_> = group.coordinates().iter().map(|name| graph.symbol(name)).collect();
    let values: Vec<_> = symbols.iter().copied().zip(g.iter().copied()).collect();
    let k = group.dim();
    for side in [Side::Left, Side::Right] {
        let b = group.operators(side, &symbols);
        let numbers = graph.evaluate(&b.entries(), &values).unwrap();
        let size = numbers.iter().fold(1.0f64, |size, b| size.max(b.abs()));
        if size > 20.0 {
            continue; // near the singularity of Euler angles differences are meaningless
        }
        for s in 0..k {
            let moved = |step: f64| {
                let x: Vec<f64> = (0..k).map(|r| if r == s { step } else { 0.0 }).collect();
                match side {
                    Side::Left => group.compose(g, &group.exp(&x)),
                    Side::Right => group.compose(&group.exp(&x), g),
                }
            };
            let (after, before) = (moved(STEP), moved(-STEP));
            for i in 0..g.len() {
                let change = after[i] - before[i];
                let turns = (change / std::f64::consts::TAU).round(); // angles jump by whole turns only
                let rate = (change - turns * std::f64::consts::TAU) / (2.0 * STEP);
                let error = (rate - numbers[i * k + s]).abs();
                assert!(error < DIFFERENCES * size.powi(3), "{side:?} b_{i}{s}: {error}");
            }
        }
    }
}

/// The closure of the frames: c on the left, −c on the right.
fn structure<G: LieGroup>(group: &G) {
    let graph = Graph::new();
    let symbols: Vec<_> = group.coordinates().iter().map(|name| graph.symbol(name)).collect();
    let time = graph.symbol("t");
    let left = group.left_frame(&graph, time, symbols.clone()).unwrap();
    let right = group.right_frame(&graph, time, symbols).unwrap();
    let algebra = group.algebra();
    let opposite = LieAlgebra::new(group.dim(), |r, s, m| -algebra.constant(r, s, m)).unwrap();
    for (frame, expected) in [(left, algebra), (right, opposite)] {
        assert_eq!(frame.rank(), group.dim());
        let c = frame.structure_coefficients(&Neighbourhood::default()).unwrap();
        assert_eq!(c.lie_algebra(), Some(expected));
    }
    assert!(group.left_frame(&graph, time, vec![time]).is_err() || group.coordinates().len() == 1);
}

#[test]
fn plane_rotations() {
    laws(&PlaneRotations);
}

#[test]
fn rotation_matrices() {
    laws(&RotationMatrices);
}

#[test]
fn unit_quaternions() {
    laws(&UnitQuaternions);
}

#[test]
fn euler_angles() {
    for sequence in EulerAngles::SEQUENCES {
        laws(&EulerAngles::about(sequence).unwrap());
    }
}

#[test]
fn plane_motions() {
    laws(&PlaneMotions);
}

#[test]
fn rigid_motions() {
    laws(&RigidMotions);
}

#[test]
fn heisenberg() {
    laws(&HeisenbergGroup::new(1));
    laws(&HeisenbergGroup::new(2));
}

#[test]
fn direct_products() {
    laws(&DirectProduct::new(UnitQuaternions, PlaneRotations));
    laws(&DirectProduct::new(PlaneMotions, DirectProduct::new(HeisenbergGroup::new(1), RotationMatrices)));
}

/// The matrices in expressions are those by which the adjoint representation turns vectors, and Ṙ = R ω̂ along the
/// body frame.
#[test]
fn rotation_matrices_turn_as_the_adjoint_representation() {
    let graph = Graph::new();
    let symbols = graph.symbols(["a", "b", "c", "d", "e", "f", "g", "h", "i"]);
    let check = |group: &dyn LieGroup, matrix: Matrix<Expr<'_>>| {
        let x = &symbols[..group.coordinates().len()];
        let vector = prop::collection::vec(-REACH..REACH, 3);
        let at = |entries: &[Expr<'_>], element: &[f64]| {
            let values: Vec<_> = x.iter().copied().zip(element.iter().copied()).collect();
            DMatrix::from_row_slice(3, 3, &graph.evaluate(entries, &values).unwrap())
        };
        let outcome = TestRunner::new(config()).run(&(vector.clone(), vector), |(v, omega)| {
            let element = group.exp(&v);
            close(&at(&matrix.entries(), &element), &group.adjoint(&element), ROUNDING, "R");
            let b = group.operators(Side::Left, x);
            let rates = x.iter().enumerate().map(|(i, &x)| {
                (x, graph.dot(b.row(i).iter().copied(), omega.iter().map(|&omega| omega.into())))
            });
            let moved = graph.directional(&matrix.entries(), &rates.collect::<Vec<_>>());
            let turning = group.adjoint(&element) * group.ad(&omega);
            close(&at(&moved, &element), &turning, 1e-10, "Ṙ"); // Euler's frames magnify near their poles
            Ok(())
        });
        outcome.unwrap();
    };
    for axes in EulerAngles::SEQUENCES {
        let angles = EulerAngles::about(axes).unwrap();
        check(&angles, angles.rotation_matrix(&symbols));
    }
    check(&UnitQuaternions, UnitQuaternions.rotation_matrix(&symbols));
    check(&RotationMatrices, RotationMatrices.rotation_matrix(&symbols));
}
