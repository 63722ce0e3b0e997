//! The canonical equations of a relativistic particle, whose L is not quadratic, against closed forms.

use crate::common::{compiled, rates, some};
use pc_analysis::{AnalysisError, CompleteIntegral, Conservation, PoissonBracket, Rates, hamilton_jacobi};
use pc_mech::{Backend, Expr, Graph, Style, System, VectorField};

/// L = −c² √(1 − |η|²/c²) + κ/ρ with η = (ρ̇, ρφ̇).
fn relativistic(graph: &Graph) -> System<'_> {
    let [c, kappa] = graph.symbols(["c", "κ"]);
    System::builder(graph)
        .parameter(c, 2.0)
        .parameter(kappa, 1.0)
        .coordinates(["ρ", "φ"])
        .quasi_velocities(["η1", "η2"])
        .kinematics(|_, x, eta| [eta[0], eta[1] / x[0]])
        .lagrangian(|_, x, eta| {
            let slowness = (1.0 - (eta[0].square() + eta[1].square()) / c.square()).sqrt();
            -c.square() * slowness + kappa / x[0]
        })
        .integral("momentum", |_, x, eta| {
            x[0] * eta[1] / (1.0 - (eta[0].square() + eta[1].square()) / c.square()).sqrt()
        })
        .build()
        .unwrap()
}

/// (ρ̇, φ̇, ẏ_1, ẏ_2) and H, written by hand: η = y/√(1 + |y|²/c²), c_12^2 = −1/ρ.
fn by_hand<'g>(graph: &'g Graph) -> (Vec<Expr<'g>>, Expr<'g>) {
    let [c, kappa, rho, y1, y2] = graph.symbols(["c", "κ", "ρ", "p_η1", "p_η2"]);
    let gamma = (1.0 + (y1.square() + y2.square()) / c.square()).sqrt();
    let (u, v) = (y1 / gamma, y2 / gamma);
    (vec![u, v / rho, v * y2 / rho - kappa / rho.square(), -u * y2 / rho], c.square() * gamma - kappa / rho)
}

/// Relative to the largest entry.
fn assert_close(found: &[f64], expected: &[f64], tolerance: f64, what: &str) {
    let size = expected.iter().fold(0.0f64, |size, v| size.max(v.abs()));
    assert_eq!(found.len(), expected.len(), "{what}");
    for (i, (a, b)) in found.iter().zip(expected).enumerate() {
        assert!((a - b).abs() <= tolerance * size, "{what}, entry {i}: {a} instead of {b}");
    }
}

/// States (ρ, φ, y) with |η| = βc, β from near 0 to 1 − 10⁻⁶.
fn states() -> impl Iterator<Item = [f64; 4]> {
    (0..200).map(|i| {
        let beta = match i % 4 {
            0 => 0.999_999,
            1 => 1.0 - 10f64.powf(-6.0 * some(i, 1).abs()),
            _ => some(i, 2).abs(),
        };
        let (y, angle) = (2.0 * beta / (1.0 - beta * beta).sqrt(), 3.0 * some(i, 3));
        [1.5 + some(i, 4), 3.0 * some(i, 5), y * angle.cos(), y * angle.sin()]
    })
}

/// Where γ = 707, a rounding error of a velocity changes its momentum by γ² ε = 10⁻¹⁰; but the velocities,
/// rates and H of given momenta are all well-conditioned.
#[test]
fn a_relativistic_particle_is_that_of_the_closed_form() {
    let graph = Graph::new();
    let canonical = relativistic(&graph).canonical().unwrap();
    assert!(!canonical.is_closed());
    let (expected, hamiltonian) = by_hand(&graph);
    let mut motion = compiled(&canonical);
    let mut transform = canonical.legendre_transform().unwrap();
    let symbols = graph.symbols(["ρ", "φ", "p_η1", "p_η2", "c", "κ"]);
    for state in states() {
        let values: Vec<_> = symbols.into_iter().zip(state.into_iter().chain([2.0, 1.0])).collect();
        let expected = graph.evaluate(&expected, &values).unwrap();
        assert_close(&rates(&mut motion, 0.0, &state), &expected, 1e-13, "rates");
        let energy = graph.evaluate(&[hamiltonian], &values).unwrap();
        let observed = motion.observe(0.0, &state);
        assert_close(&observed[1..2], &energy, 1e-13, "H");

        let velocities = transform.to_quasi_velocities(0.0, &state).unwrap();
        let eta = [expected[0], expected[1] * state[0]];
        assert_close(&velocities[2..], &eta, 1e-13, "η");
        let gamma_squared = 1.0 + (state[2].powi(2) + state[3].powi(2)) / 4.0;
        let back = transform.to_momenta(0.0, &velocities).unwrap();
        assert_close(&back[2..], &state[2..], 4e-15 * (1.0 + gamma_squared), "y");
    }
}

/// Rounding of the closed form, its derivative and an elimination: with γ < 4, some hundred units in the last
/// place.
#[test]
fn derivatives_are_those_of_the_closed_form() {
    let graph = Graph::new();
    let canonical = relativistic(&graph).canonical().unwrap();
    let (expected, _) = by_hand(&graph);
    let mut motion = compiled(&canonical);
    let symbols = graph.symbols(["ρ", "φ", "p_η1", "p_η2", "c", "κ"]);
    let pattern = motion.sparsity().unwrap().clone();
    assert!(pattern.column(1).is_empty(), "nothing depends on φ");
    for state in states().filter(|y| y[2].hypot(y[3]) < 7.0) {
        // The result is independent of earlier evaluations.
        rates(&mut motion, 0.0, &[1.0, 0.0, 30.0 * some(1, 1), -20.0]);
        let values: Vec<_> = symbols.into_iter().zip(state.into_iter().chain([2.0, 1.0])).collect();
        let columns: Vec<f64> = symbols
            .iter()
            .flat_map(|&q| expected.iter().map(move |f| f.derivative(q)))
            .map(|slope| graph.evaluate(&[slope], &values).unwrap()[0])
            .collect();
        let (mut jacobian, mut by_parameters) = ([f64::NAN; 16], [f64::NAN; 8]);
        motion.jacobian(0.0, &state, &mut jacobian).unwrap();
        assert_close(&jacobian, &columns[..16], 1e-12, "Jacobian");
        motion.parameter_jacobian(0.0, &state, &mut by_parameters).unwrap();
        assert_close(&by_parameters, &columns[16..], 1e-12, "by parameters");

        let (mut entries, mut scattered) = (vec![f64::NAN; pattern.len()], [f64::NAN; 16]);
        motion.sparse_jacobian(0.0, &state, &mut entries).unwrap();
        pattern.scatter(&entries, &mut scattered);
        assert_eq!(scattered, jacobian);

        let (v, mut product) = ([0.3, -0.5, 0.7, 1.1], [f64::NAN; 4]);
        motion.jvp(0.0, &state, &v, &mut product).unwrap();
        let sum = |i: usize| (0..4).map(|j| columns[i + 4 * j] * v[j]).sum();
        let size = columns[..16].iter().fold(1.0f64, |size, v| size.max(v.abs()));
        for i in 0..4 {
            let expected: f64 = sum(i);
            assert!((product[i] - expected).abs() <= 1e-12 * size, "product: {product:?}");
        }
    }
}

#[test]
fn earlier_solutions_change_no_bit() {
    let graph = Graph::new();
    let canonical = relativistic(&graph).canonical().unwrap();
    let mut motion = compiled(&canonical);
    let states: Vec<_> = states().collect();
    let forwards: Vec<_> = states.iter().map(|y| rates(&mut motion, 0.0, y)).collect();
    let mut backwards: Vec<_> = states.iter().rev().map(|y| rates(&mut motion.clone(), 0.0, y)).collect();
    backwards.reverse();
    assert_eq!(forwards, backwards);
}

/// From a guess near the velocity of light, Newton's method misses velocities near that of light in another
/// direction. The motion reaches them nevertheless.
#[test]
fn the_last_solution_serves_where_the_guess_fails() {
    let graph = Graph::new();
    let canonical = relativistic(&graph).canonical().unwrap().with_guess(&[0.0, -1.999]).unwrap();
    let (mut motion, mut fresh) = (compiled(&canonical), compiled(&canonical));
    let mut from_rest = compiled(&relativistic(&graph).canonical().unwrap());
    let at = |y: f64| [1.0, 0.0, 0.6 * y, 0.8 * y];
    assert!(fresh.rhs(0.0, &at(2000.0), &mut [0.0; 4]).is_err());
    for i in 0..=200 {
        let state = at(10f64.powf(f64::from(i) * 0.0165));
        assert_close(&rates(&mut motion, 0.0, &state), &rates(&mut from_rest, 0.0, &state), 1e-14, "rates");
    }
}

/// RK4 with h = 1/500: errors of some h⁴ = 10⁻¹¹ times derivatives below ten.
#[test]
fn a_constant_force_drives_a_particle_to_the_velocity_of_light() {
    let graph = Graph::new();
    let (c, force) = (2.0, 3.0);
    let system = System::builder(&graph)
        .coordinates(["x"])
        .lagrangian(|_, x, v| -(c * c) * (1.0 - v[0].square() / (c * c)).sqrt() + force * x[0])
        .build()
        .unwrap();
    let mut motion = system.canonical().unwrap().compile_for(Backend::Fastest).unwrap();
    let (mut y, h) = (vec![0.0, 0.0], 1.0 / 500.0);
    for step in 1..=2000 {
        let ahead = |k: &[f64], h: f64| y.iter().zip(k).map(|(y, k)| y + h * k).collect::<Vec<_>>();
        let k1 = rates(&mut motion, 0.0, &y);
        let k2 = rates(&mut motion, 0.0, &ahead(&k1, h / 2.0));
        let k3 = rates(&mut motion, 0.0, &ahead(&k2, h / 2.0));
        let k4 = rates(&mut motion, 0.0, &ahead(&k3, h));
        for i in 0..2 {
            y[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
        }
        let t = h * f64::from(step);
        let x = c * c / force * ((force * t / c).hypot(1.0) - 1.0);
        assert!((y[0] - x).abs() < 1e-10 && (y[1] - force * t).abs() < 1e-10, "t = {t}: {y:?}, {x}");
    }
}

#[test]
fn functions_that_need_a_closed_hamiltonian_are_refused() {
    let graph = Graph::new();
    let canonical = relativistic(&graph).canonical().unwrap();
    let action = graph.symbol("φ");
    let error = hamilton_jacobi(&canonical, action).unwrap_err();
    assert!(matches!(&error, AnalysisError::Mech(error) if error.is_not_quadratic()));
    assert_eq!(
        error.to_string(),
        "the Hamiltonian as a function of the momenta needs a Lagrangian that is quadratic in the \
         quasi-velocities; this one is not in `η1`"
    );
    let error = CompleteIntegral::new(&canonical, action, &["a", "b"]).unwrap_err();
    assert!(matches!(&error, AnalysisError::Mech(error) if error.is_not_quadratic()));
}

/// ẏ = (y, H) and ẋ = (x, H) with H = y_s η_s − L at fixed η, and rates of functions of (t, x, y) in (t, x, η).
#[test]
fn brackets_and_rates_of_equations_that_are_not_closed() {
    let graph = Graph::new();
    let system = relativistic(&graph);
    let canonical = system.canonical().unwrap();
    let [rho, y2, eta1, eta2] = graph.symbols(["ρ", "p_η2", "η1", "η2"]);
    assert_eq!(canonical.quasi_velocities(), [eta1, eta2]);
    let bracket = PoissonBracket::new(&system);
    let h = canonical.hamiltonian();
    let rates = [canonical.velocities(), canonical.right_hand_side()].concat();
    // ∂H/∂y at fixed η is η, X_s H is −X_s L.
    for (&z, &rate) in bracket.variables().iter().zip(&rates) {
        assert_eq!(bracket.of(z, h).unwrap(), rate);
    }
    assert_eq!(Rates::canonical(&canonical).verdict(rho * y2).unwrap(), Conservation::Conserved);
    assert_eq!(Rates::canonical(&canonical).verdict(h).unwrap(), Conservation::Conserved);
    assert!(!Rates::canonical(&canonical).verdict(y2).unwrap().is_conserved());
    assert_eq!(canonical.in_momenta(eta1), eta1);
    let lines: Vec<_> =
        canonical.balance(Style::Text).into_iter().map(|(l, r)| format!("{l} = {r}")).collect();
    assert_eq!(lines, ["p_η1' = p_η2*η2/ρ - κ/ρ^2", "p_η2' = -p_η2*η1/ρ"]);
}
