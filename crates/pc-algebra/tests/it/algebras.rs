//! Known properties of the algebras of the catalogue, and laws under random changes of basis.

use pc_algebra::{AlgebraError, CATALOGUE, LieAlgebra, Matrix, Representation, Subspace};
use pc_expr::Number;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

fn named(name: &str) -> LieAlgebra {
    LieAlgebra::named(name).unwrap()
}

fn dims(series: &[Subspace]) -> Vec<usize> {
    series.iter().map(Subspace::dim).collect()
}

fn integers<const N: usize>(rows: [[i32; N]; N]) -> Matrix<Number> {
    Matrix::from_fn(N, N, |i, j| rows[i][j].into())
}

#[test]
fn killing_forms() {
    assert_eq!(LieAlgebra::so3().killing_form(), Ok(integers([[-2, 0, 0], [0, -2, 0], [0, 0, -2]])));
    assert_eq!(LieAlgebra::sl2().killing_form(), Ok(integers([[8, 0, 0], [0, 0, 4], [0, 4, 0]])));
    assert_eq!(LieAlgebra::aff1().killing_form(), Ok(integers([[1, 0], [0, 0]])));
    // tr(ad x ad y) = (n − 2) tr(xy) on so(n), and tr(R_ij²) = −2.
    for n in 3..7 {
        let form = LieAlgebra::so(n).unwrap().killing_form().unwrap();
        let expected = |r: usize, s: usize| Number::from(if r == s { -2 * (n as i32 - 2) } else { 0 });
        assert_eq!(form, Matrix::from_fn(form.rows(), form.rows(), expected));
    }
}

#[test]
fn semisimple_algebras() {
    for name in ["so3", "so4", "so5", "su2", "sl2", "bianchi8", "bianchi9"] {
        assert_eq!(named(name).is_semisimple(), Ok(true), "{name}");
    }
    for name in ["se2", "se3", "heisenberg", "aff1", "gl2", "bianchi5", "bianchi7"] {
        assert_eq!(named(name).is_semisimple(), Ok(false), "{name}");
    }
}

#[test]
fn ranks_and_indices() {
    let known = [
        ("so3", 1, 1),
        ("so4", 2, 2),
        ("so5", 2, 2),
        ("so6", 3, 3),
        ("sl2", 1, 1),
        ("se2", 1, 1),
        ("se3", 2, 2),
        ("heisenberg", 3, 1), // nilpotent: its own Cartan subalgebra
        ("heisenberg5", 5, 1),
        ("aff1", 1, 0),
        ("gl2", 2, 2),
        ("gl3", 3, 3),
        ("gl4", 4, 4),
        ("bianchi1", 3, 3),
    ];
    for (name, rank, index) in known {
        assert_eq!(named(name).rank(), Ok(rank), "rank of {name}");
        assert_eq!(named(name).index(), Ok(index), "index of {name}");
    }
    // Only X_1 acts on the ideal of the class-B types: one of its eigenvalues there is 0 for III, and none
    // otherwise.
    for (name, rank) in
        [("bianchi3", 2), ("bianchi4", 1), ("bianchi5", 1), ("bianchi6", 1), ("bianchi6(-4)", 1)]
    {
        assert_eq!(named(name).rank(), Ok(rank), "rank of {name}");
        assert_eq!(named(name).index(), Ok(1), "index of {name}");
    }
}

#[test]
fn series_of_all_bianchi_types() {
    let known: [(&str, &[usize], &[usize]); 12] = [
        ("bianchi1", &[3, 0], &[3, 0]),
        ("bianchi2", &[3, 1, 0], &[3, 1, 0]),
        ("bianchi3", &[3, 1, 0], &[3, 1]),
        ("bianchi4", &[3, 2, 0], &[3, 2]),
        ("bianchi5", &[3, 2, 0], &[3, 2]),
        ("bianchi6", &[3, 2, 0], &[3, 2]),
        ("bianchi6(-1)", &[3, 1, 0], &[3, 1]),
        ("bianchi6(-9)", &[3, 2, 0], &[3, 2]),
        ("bianchi7", &[3, 2, 0], &[3, 2]),
        ("bianchi7(1/4)", &[3, 2, 0], &[3, 2]),
        ("bianchi8", &[3], &[3]),
        ("bianchi9", &[3], &[3]),
    ];
    for (name, derived, central) in known {
        let algebra = named(name);
        assert_eq!(dims(&algebra.derived_series().unwrap()), derived, "derived series of {name}");
        assert_eq!(dims(&algebra.lower_central_series().unwrap()), central, "central series of {name}");
        assert_eq!(algebra.is_solvable(), Ok(derived.ends_with(&[0])), "{name}");
        assert_eq!(algebra.is_nilpotent(), Ok(central.ends_with(&[0])), "{name}");
    }
}

#[test]
fn cartans_criterion_of_solvability_agrees_with_the_derived_series() {
    for entry in CATALOGUE {
        let algebra = named(entry.name);
        let form = algebra.killing_form().unwrap();
        let derived = algebra.derived_series().unwrap();
        let commutators = derived.get(1).unwrap_or(&derived[0]).basis();
        let k = algebra.dim();
        // K(g, [g, g]) = 0
        let orthogonal = commutators
            .iter()
            .all(|y| (0..k).all(|r| (0..k).fold(Number::ZERO, |sum, s| sum + form[(r, s)] * y[s]).is_zero()));
        assert_eq!(algebra.is_solvable(), Ok(orthogonal), "{}", entry.name);
    }
}

#[test]
fn centres() {
    for (name, dim) in
        [("so3", 0), ("se3", 0), ("heisenberg", 1), ("heisenberg7", 1), ("gl3", 1), ("bianchi1", 3)]
    {
        assert_eq!(named(name).centre().unwrap().dim(), dim, "{name}");
    }
    let identity: Vec<Number> = [1, 0, 0, 1].map(Number::from).to_vec();
    assert_eq!(named("gl2").centre().unwrap().basis(), [identity]);
}

#[test]
fn invariant_forms() {
    let quadratic = |name: &str| named(name).invariant_quadratic_forms().unwrap();
    assert_eq!(quadratic("so3"), [integers([[1, 0, 0], [0, 1, 0], [0, 0, 1]])]);
    for (name, dim) in [("so4", 2), ("se3", 2), ("gl2", 2), ("sl2", 1), ("bianchi1", 6)] {
        assert_eq!(quadratic(name).len(), dim, "{name}");
    }
    // ω·ω and ω·v on se(3)
    let (one, zero) = (Number::ONE, Number::ZERO);
    let omega = Matrix::from_fn(6, 6, |i, j| if i == j && i < 3 { one } else { zero });
    let mixed = Matrix::from_fn(6, 6, |i, j| if i.abs_diff(j) == 3 { one } else { zero });
    assert_eq!(quadratic("se3"), [omega, mixed]);

    let linear = |name: &str| named(name).invariant_linear_forms().unwrap().len();
    for (name, dim) in [("so3", 0), ("se3", 0), ("se2", 1), ("heisenberg", 2), ("gl3", 1), ("bianchi1", 3)] {
        assert_eq!(linear(name), dim, "{name}");
    }
}

/// B([x, y], z) + B(y, [x, z]) = 0 for every form found, in the whole catalogue.
#[test]
fn invariant_forms_are_invariant() {
    for entry in CATALOGUE {
        let algebra = named(entry.name);
        let k = algebra.dim();
        for form in algebra.invariant_quadratic_forms().unwrap() {
            assert_eq!(form, form.transpose());
            for (r, s, m) in (0..k * k * k).map(|i| (i / k / k, i / k % k, i % k)) {
                let defect = (0..k).fold(Number::ZERO, |sum, p| {
                    sum + algebra.constant(r, s, p) * form[(p, m)] + algebra.constant(r, m, p) * form[(s, p)]
                });
                assert!(defect.is_zero(), "{} ({r}, {s}, {m})", entry.name);
            }
        }
    }
}

#[test]
fn subalgebras_and_ideals() {
    let se3 = LieAlgebra::se3();
    let unit = |i: usize| -> Vec<Number> { (0..6).map(|j| i32::from(i == j).into()).collect() };
    let span =
        |units: &[usize]| Subspace::span(6, &units.iter().map(|&i| unit(i)).collect::<Vec<_>>()).unwrap();
    let verdict = |h: &Subspace| (se3.is_subalgebra(h).unwrap(), se3.is_ideal(h).unwrap());
    assert_eq!(verdict(&span(&[0, 1, 2])), (true, false), "rotations");
    assert_eq!(verdict(&span(&[3, 4, 5])), (true, true), "translations");
    assert_eq!(verdict(&span(&[2, 3, 4])), (true, false), "motions of a plane");
    assert_eq!(verdict(&span(&[0, 1])), (false, false));
    let error = se3.is_ideal(&Subspace::whole(5)).unwrap_err();
    assert_eq!(error.to_string(), "a vector of the subspace has 5 entries where 6 are needed");
}

#[test]
fn matrices_give_the_constants_of_the_catalogue() {
    let unit =
        |n: usize, i: usize, j: usize| Matrix::from_fn(n, n, |a, b| i32::from((a, b) == (i, j)).into());
    let all: Vec<_> = (0..9).map(|index| unit(3, index / 3, index % 3)).collect();
    assert_eq!(LieAlgebra::of_matrices(&all), LieAlgebra::gl(3));
    // ω̂ in the corner and v in the last column.
    let turn = |i: usize, j: usize| -> Matrix<Number> {
        Matrix::from_fn(4, 4, |a, b| (i32::from((a, b) == (j, i)) - i32::from((a, b) == (i, j))).into())
    };
    let motions = [turn(1, 2), turn(2, 0), turn(0, 1), unit(4, 0, 3), unit(4, 1, 3), unit(4, 2, 3)];
    assert_eq!(LieAlgebra::of_matrices(&motions), Ok(LieAlgebra::se3()));
    let rotations: Vec<_> =
        [(1, 2), (2, 0), (0, 1), (0, 3), (1, 3), (2, 3)].iter().map(|&(i, j)| turn(i, j)).collect();
    assert_eq!(LieAlgebra::of_matrices(&rotations), LieAlgebra::so(4));

    let error = LieAlgebra::of_matrices(&[turn(0, 1), turn(1, 2)]).unwrap_err();
    assert_eq!(error.to_string(), "the commutator of the matrices number 1 and 2 is not in their span");
    let error = LieAlgebra::of_matrices(&[turn(0, 1), turn(1, 0)]).unwrap_err();
    assert_eq!(error.to_string(), "matrix number 2 is a combination of those before it");
}

#[test]
fn representations_and_semidirect_products() {
    let so2_in_the_plane =
        Representation::new(LieAlgebra::commutative(1), 2, vec![integers([[0, -1], [1, 0]])]);
    assert_eq!(so2_in_the_plane.unwrap().semidirect_product(), LieAlgebra::se2());
    for name in ["so3", "sl2", "se2", "heisenberg"] {
        let adjoint = Representation::adjoint(&named(name));
        let coadjoint = adjoint.dual();
        for rho in [adjoint, coadjoint] {
            let matrices = (0..rho.algebra().dim()).map(|s| rho.matrix(s).clone()).collect();
            assert_eq!(Representation::new(named(name), rho.dim(), matrices).as_ref(), Ok(&rho));
            let product = rho.semidirect_product();
            let checked = LieAlgebra::new(product.dim(), |r, s, m| product.constant(r, s, m));
            assert_eq!(checked, Ok(product), "{name}");
        }
    }
    let wrong = vec![integers([[0, 1], [0, 0]]), integers([[0, 0], [1, 0]]), integers([[1, 0], [0, 1]])];
    let error = Representation::new(LieAlgebra::heisenberg(1), 2, wrong).unwrap_err();
    assert_eq!(
        error.to_string(),
        "this is not a representation: ρ([X_1, X_2]) and ρ(X_1)ρ(X_2) − ρ(X_2)ρ(X_1) differ in entry (2, 2)"
    );
}

#[test]
fn real_constants_are_refused_where_exactness_is_needed() {
    let algebra = named("bianchi6(-2)"); // a = √2
    let error = algebra.derived_series().unwrap_err();
    assert_eq!(
        error.to_string(),
        "c_12^2 = -1.4142135623730951 is not a rational number, so nothing exact can be said of the algebra"
    );
    assert!(named("bianchi7(1/2)").centre().is_err(), "0.7071067811865476 is no root of 1/2");
    assert!(matches!(algebra.rank(), Err(AlgebraError::NotRational { r: 1, s: 2, m: 2, .. })));
    assert_eq!(algebra.bracket(&[1.0, 0.0, 0.0], &[0.0, 1.0, 0.0])[2], -1.0);
}

#[test]
fn errors_of_a_change_of_basis_are_named() {
    let so3 = LieAlgebra::so3();
    let singular = integers([[1, 2, 3], [2, 4, 6], [0, 0, 1]]);
    assert_eq!(so3.change_of_basis(&singular), Err(AlgebraError::SingularBasis));
    let scale = Number::ratio(1 << 30, 1);
    let large = Matrix::from_fn(3, 3, |i, j| if i == j && i < 2 { scale } else { i32::from(i == j).into() });
    let error = so3.change_of_basis(&large).unwrap_err();
    assert!(matches!(error, AlgebraError::TooLarge { r: 1, s: 2, m: 3, .. }), "{error}");
    let wrong = so3.change_of_basis(&integers([[1, 0], [0, 1]])).unwrap_err();
    assert_eq!(wrong.to_string(), "a column of the change of basis has 2 entries where 3 are needed");
}

#[test]
fn elimination_goes_beyond_the_range_of_numbers() {
    // Constants at the edge of 2⁵³, whose products and sums leave it.
    let scaled = LieAlgebra::from_brackets(
        3,
        &[
            (0, 1, 2, Number::ratio(9_007_199_254_740_881, 1)),
            (1, 2, 0, Number::ratio(1, 9_007_199_254_740_881)),
            (2, 0, 1, Number::ratio(3, 9_007_199_254_740_847)),
        ],
    )
    .unwrap();
    assert_eq!((scaled.is_semisimple(), scaled.rank(), scaled.index()), (Ok(true), Ok(1), Ok(1)));
}

/// A random unimodular matrix, as a product of elementary ones, so that the constants stay small.
fn basis(k: usize) -> impl Strategy<Value = Matrix<Number>> {
    prop::collection::vec((0..k, 0..k, -2i32..=2), 0..4).prop_map(move |steps| {
        let mut p = Matrix::from_fn(k, k, |i, j| i32::from(i == j).into());
        for (from, to, factor) in steps.into_iter().filter(|(from, to, _)| from != to) {
            for i in 0..k {
                p[(i, to)] = p[(i, to)] + p[(i, from)] * factor.into();
            }
        }
        p
    })
}

fn changed() -> impl Strategy<Value = (LieAlgebra, Matrix<Number>)> {
    (0..CATALOGUE.len()).prop_flat_map(|entry| {
        let algebra = named(CATALOGUE[entry].name);
        basis(algebra.dim()).prop_map(move |p| (algebra.clone(), p))
    })
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 100,
        rng_seed: RngSeed::Fixed(12),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn another_basis_is_a_lie_algebra_with_the_same_invariants((algebra, p) in changed()) {
        let other = algebra.change_of_basis(&p).unwrap();
        let k = algebra.dim();
        // Antisymmetry and Jacobi's identity, exactly.
        prop_assert_eq!(LieAlgebra::new(k, |r, s, m| other.constant(r, s, m)), Ok(other.clone()));
        let invariants = |g: &LieAlgebra| {
            let series = [g.derived_series().unwrap(), g.lower_central_series().unwrap()].map(|s| dims(&s));
            let quadratic = g.invariant_quadratic_forms().unwrap().len();
            let linear = g.invariant_linear_forms().unwrap().len();
            (series, quadratic, linear, g.centre().unwrap().dim(), g.rank(), g.index(), g.is_semisimple())
        };
        prop_assert_eq!(invariants(&algebra), invariants(&other));
    }

    /// K' = pᵀKp, and ad of the image of x is p⁻¹ (ad x) p: p ad'(x') = ad(p x') p.
    #[test]
    fn killing_form_and_ad_transform((algebra, p) in changed()) {
        let other = algebra.change_of_basis(&p).unwrap();
        let k = algebra.dim();
        let product = |a: &Matrix<Number>, b: &Matrix<Number>| {
            Matrix::from_fn(k, k, |i, j| (0..k).fold(Number::ZERO, |sum, l| sum + a[(i, l)] * b[(l, j)]))
        };
        let form = algebra.killing_form().unwrap();
        prop_assert_eq!(other.killing_form().unwrap(), product(&p.transpose(), &product(&form, &p)));
        for s in 0..k {
            let image: Vec<Number> = p.column(s).collect();
            let unit: Vec<i32> = (0..k).map(|r| i32::from(r == s)).collect();
            prop_assert_eq!(product(&p, &other.ad(&unit)), product(&algebra.ad(&image), &p));
            prop_assert_eq!(other.coad(&unit), other.ad(&unit).transpose().map(|x| -x));
        }
    }

    #[test]
    fn a_change_of_basis_and_its_inverse_give_the_same_algebra((algebra, p) in changed()) {
        let k = algebra.dim();
        let rows = |m: &Matrix<Number>| nalgebra::DMatrix::from_fn(k, k, |i, j| m[(i, j)].to_f64());
        // The inverse of a unimodular matrix is whole.
        let back = rows(&p).try_inverse().unwrap();
        let back = Matrix::from_fn(k, k, |i, j| Number::from(back[(i, j)].round()));
        prop_assert_eq!(algebra.change_of_basis(&p).unwrap().change_of_basis(&back), Ok(algebra));
    }
}
