//! Digits of exponentials and logarithms where formulas change or are nearly singular.

use std::f64::consts::PI;

use nalgebra::{DMatrix, Vector3};
use num_rational::BigRational;
use num_traits::{One, ToPrimitive, Zero};
use pc_algebra::{
    EulerAngles, LieGroup, PlaneMotions, RigidMotions, RotationMatrices, Side, UnitQuaternions,
};

type Exact = Vec<Vec<BigRational>>;

fn product(a: &Exact, b: &Exact) -> Exact {
    let entry = |row: &Vec<BigRational>, j: usize| row.iter().zip(b).map(|(x, row)| x * &row[j]).sum();
    a.iter().map(|row| (0..b.len()).map(|j| entry(row, j)).collect()).collect()
}

/// Σ (±A)^i/(i + 1)! with 40 terms in rational arithmetic, minus on the left.
fn exact_dexp(side: Side, ad: &DMatrix<f64>) -> DMatrix<f64> {
    let k = ad.nrows();
    let sign = if side == Side::Left { -1.0 } else { 1.0 };
    let entry = |i: usize, j: usize| BigRational::from_float(sign * ad[(i, j)]).unwrap();
    let a: Exact = (0..k).map(|i| (0..k).map(|j| entry(i, j)).collect()).collect();
    let unit = |i: usize, j: usize| if i == j { BigRational::one() } else { BigRational::zero() };
    let mut term: Exact = (0..k).map(|i| (0..k).map(|j| unit(i, j)).collect()).collect();
    let mut sum = term.clone();
    for i in 1..40u32 {
        let below = BigRational::from_integer((i + 1).into());
        term =
            product(&term, &a).into_iter().map(|row| row.into_iter().map(|x| x / &below).collect()).collect();
        for (sum, term) in sum.iter_mut().flatten().zip(term.iter().flatten()) {
            *sum += term;
        }
    }
    DMatrix::from_fn(k, k, |i, j| sum[i][j].to_f64().unwrap())
}

/// Rotation angles on both sides of 2 and 4, where dexp and its inverse leave their series.
const ANGLES: [f64; 12] = [1e-12, 1e-4, 0.03125, 0.5, 1.5, 1.999, 2.0, 2.001, 3.0, 3.999, 4.0, 4.001];

/// `direction` (not zero in its first three components) scaled to the angle, cut to 12 bits so that rationals
/// stay short.
fn rotation_by(angle: f64, direction: &[f64]) -> Vec<f64> {
    let norm = direction[..3].iter().map(|x| x * x).sum::<f64>().sqrt();
    let short = |x: f64| f64::from_bits(x.to_bits() & !((1 << 40) - 1));
    let scaled = |(i, x): (usize, &f64)| if i < 3 { short(x * angle / norm) } else { *x };
    direction.iter().enumerate().map(scaled).collect()
}

#[test]
fn dexp_of_motions_agrees_with_the_exact_series() {
    let group = RigidMotions;
    for angle in ANGLES {
        let x = rotation_by(angle, &[0.5, -1.0, 0.75, 0.25, 1.0, -0.5]);
        for side in [Side::Left, Side::Right] {
            let exact = exact_dexp(side, &group.ad(&x));
            let error = (group.dexp(side, &x) - &exact).amax() / exact.amax();
            assert!(error < 1e-14, "{angle} {side:?}: {error:e}");
            let inverse = group.dexp_inverse(side, &x);
            let defect = (&inverse * &exact - DMatrix::identity(6, 6)).amax();
            assert!(defect < 1e-14 * inverse.amax() * exact.amax().max(1.0), "{angle} {side:?}: {defect:e}");
        }
    }
}

#[test]
fn dexp_of_rotations_agrees_with_the_exact_series() {
    for angle in ANGLES {
        let x = rotation_by(angle, &[0.5, -1.0, 0.75]);
        for side in [Side::Left, Side::Right] {
            let exact = exact_dexp(side, &RotationMatrices.ad(&x));
            for dexp in [RotationMatrices.dexp(side, &x), UnitQuaternions.dexp(side, &x)] {
                assert!((dexp - &exact).amax() < 1e-14, "{angle} {side:?}");
            }
        }
    }
}

#[test]
fn the_logarithm_of_a_rotation_is_accurate_up_to_the_half_turn() {
    for direction in
        [[1.0, 0.0, 0.0], [0.0, -0.6, 0.8], [0.36, 0.48, 0.8], [-1.0, 2.0, -2.0], [1e-9, 1.0, 1e-4]]
    {
        let axis = Vector3::from(direction).normalize();
        for below in [1.0, 1e-2, 1e-5, 1e-8, 1e-11, 1e-14] {
            let x = axis * (PI - below);
            let back = Vector3::from_vec(RotationMatrices.log(&RotationMatrices.exp(x.as_slice())));
            // The matrix is known to a few units of 1e-16 and the angle is π.
            assert!((back - x).amax() < 1e-14, "{direction:?} {below:e}: {:e}", (back - x).amax());
        }
    }
}

#[test]
fn the_half_turn_has_a_rotation_vector_with_a_positive_first_component() {
    for (diagonal, expected) in [
        ([1.0, -1.0, -1.0], [PI, 0.0, 0.0]),
        ([-1.0, 1.0, -1.0], [0.0, PI, 0.0]),
        ([-1.0, -1.0, 1.0], [0.0, 0.0, PI]),
    ] {
        let g: Vec<f64> = (0..9).map(|i| if i % 4 == 0 { diagonal[i / 4] } else { 0.0 }).collect();
        assert_eq!(RotationMatrices.log(&g), expected);
    }
    // 2 a aᵀ − 1 with a = (0, −0.6, 0.8)
    let g = [-1.0, 0.0, 0.0, 0.0, -0.28, -0.96, 0.0, -0.96, 0.28];
    let x = RotationMatrices.log(&g);
    assert!((x[1] - 0.6 * PI).abs() < 1e-14 && (x[2] + 0.8 * PI).abs() < 1e-14, "{x:?}");
}

#[test]
fn logarithms_of_small_rotations_keep_their_relative_accuracy() {
    for size in [1e-3, 1e-7, 1e-12, 1e-100, 1e-170, 1e-300] {
        let x = [size, -2.0 * size, 3.0 * size, 4.0, 5.0, 6.0];
        let relative =
            |back: &[f64]| x.iter().zip(back).map(|(x, y)| (y / x - 1.0).abs()).fold(0.0, f64::max);
        assert!(relative(&UnitQuaternions.log(&UnitQuaternions.exp(&x[..3]))) < 1e-14, "{size:e}");
        assert!(relative(&RigidMotions.log(&RigidMotions.exp(&x))) < 1e-14, "{size:e}");
        // R_32 − R_23 = 2 x_1 c_1, of entries as large as x_2 x_3 and x_1.
        assert!(relative(&RotationMatrices.log(&RotationMatrices.exp(&x[..3]))) < 1e-14, "{size:e}");
        let plane = [size, 4.0, 5.0];
        let back = PlaneMotions.log(&PlaneMotions.exp(&plane));
        assert!(plane.iter().zip(&back).all(|(x, y)| (y / x - 1.0).abs() < 1e-14), "{size:e}");
    }
}

#[test]
fn the_logarithm_of_a_quaternion_reaches_the_full_turn() {
    let axis = Vector3::new(2.0, -1.0, 2.0) / 3.0;
    for angle in [3.0, 3.2, 5.0, 6.0, 6.25] {
        let x = axis * angle;
        let back = Vector3::from_vec(UnitQuaternions.log(&UnitQuaternions.exp(x.as_slice())));
        assert!((back - x).amax() < 1e-14, "{angle}");
    }
    assert_eq!(UnitQuaternions.log(&[-1.0, 0.0, 0.0, 0.0]), [2.0 * PI, 0.0, 0.0]);
    let full_screw = RigidMotions.log(&[-1.0, 0.0, 0.0, 0.0, 0.0, 3.0, 0.0]);
    let again = RigidMotions.exp(&full_screw);
    assert!(RigidMotions.distance(&again, &[-1.0, 0.0, 0.0, 0.0, 0.0, 3.0, 0.0]) < 1e-14, "{full_screw:?}");
}

#[test]
fn euler_angles_compose_at_their_singularity() {
    for sequence in EulerAngles::SEQUENCES {
        let group = EulerAngles::about(sequence).unwrap();
        for beta in [0.0, PI / 2.0, PI, -PI / 2.0, 1e-9, PI / 2.0 - 1e-9] {
            let g = [0.7, beta, -0.4];
            let h = group.compose(&g, &group.identity());
            assert!(group.distance(&g, &h) < 4e-15, "{sequence} {g:?} {h:?}");
        }
    }
}

#[test]
fn heavy_top_angles_turn_space_and_body_as_in_the_book() {
    // zxz: γ = Rᵀe_3 = (sin θ sin φ, sin θ cos φ, cos θ).
    let [psi, theta, phi] = [0.3f64, 0.8, -1.1];
    let rotation = EulerAngles::about("zxz").unwrap().adjoint(&[psi, theta, phi]);
    let expected = [theta.sin() * phi.sin(), theta.sin() * phi.cos(), theta.cos()];
    assert!((0..3).all(|i| (rotation[(2, i)] - expected[i]).abs() < 1e-15));
}

#[test]
fn elements_without_a_nearest_one_are_refused() {
    let message = UnitQuaternions.project(&[0.0; 4]).unwrap_err().to_string();
    assert_eq!(message, "[0.0, 0.0, 0.0, 0.0] has no nearest element of the group");
    assert!(RotationMatrices.project(&[0.0; 9]).is_err());
    assert_eq!(UnitQuaternions.project(&[3e200, 0.0, 0.0, 4e200]).unwrap(), [0.6, 0.0, 0.0, 0.8]);
    // The reflection in z is nearest to rotations at the same distance; one of them is given.
    let reflection = [2.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, -1.0];
    assert_eq!(RotationMatrices.project(&reflection).unwrap(), RotationMatrices.identity());
}

#[test]
fn sequences_are_three_axes_with_different_neighbours() {
    for wrong in ["", "xy", "xxy", "xyy", "abc", "xyzx"] {
        assert!(EulerAngles::about(wrong).is_err(), "{wrong}");
    }
    let message = EulerAngles::about("zzx").unwrap_err().to_string();
    assert!(message.starts_with("`zzx` is not a sequence of Euler angles"), "{message}");
}
