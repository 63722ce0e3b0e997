//! The theorems of the paper on the canonical equations, each from a text, from Rust and from C: Poisson's theorem on integrals,
//! the equation of Hamilton and Jacobi, also for a group that acts intransitively, Jacobi's theorem, and nonholonomic constraints
//! with the full H (31).

use std::ffi::{CStr, c_char};
use std::ptr;

use pc_analysis::{CompleteIntegral, DependentMomenta, Orbit, PoissonBracket, hamilton_jacobi};
use pc_mech::{Expr, Graph};
use pc_model::{Assembly, Document, Model, Source};
use pc_print::{Page, Theory, TheoryOptions};

/// A planet in spherical coordinates, with a component of its angular momentum.
const PLANET: &str = r#"
    [parameters]
    m = 2.0
    k = 3.0
    [coordinates]
    r = 1.0
    "θ" = 0.9
    "φ" = 0.3
    [quasi_velocities]
    "r'" = 0.1
    "θ'" = 1.1
    "φ'" = 0.2
    [lagrangian]
    kinetic = "m*(r'^2 + r^2*θ'^2 + r^2*sin(θ)^2*φ'^2)/2"
    potential = "-k/r"
    [integrals]
    Kx = "-m*r^2*(sin(φ)*θ' + sin(θ)*cos(θ)*cos(φ)*φ')"
"#;

/// An oscillator with its action.
const OSCILLATOR: &str = r#"
    [parameters]
    "ω" = 1.5
    [coordinates]
    x = 0.3
    [quasi_velocities]
    "x'" = 1.0
    [lagrangian]
    kinetic = "x'^2/2"
    potential = "ω^2*x^2/2"
    [hamilton_jacobi]
    action = "x*sqrt(2*E - ω^2*x^2)/2 + E/ω*atan(ω*x/sqrt(2*E - ω^2*x^2)) - E*t"
    constants = { E = 2.0 }
"#;

/// A top with equal moments of inertia in the components γ of the vertical, on which the rotations act intransitively, with the
/// action of its motions along great circles.
const TOP: &str = r#"
    [parameters]
    A = 2.0
    [coordinates]
    "γ1" = 0.6
    "γ2" = 0.0
    "γ3" = 0.8
    [quasi_velocities]
    "ω1" = 0.4
    "ω2" = 0.7
    "ω3" = -0.3
    [kinematics]
    "γ1" = "γ2*ω3 - γ3*ω2"
    "γ2" = "γ3*ω1 - γ1*ω3"
    "γ3" = "γ1*ω2 - γ2*ω1"
    [algebra]
    name = "so3"
    [lagrangian]
    kinetic = "A*(ω1^2 + ω2^2 + ω3^2)/2"
    [hamilton_jacobi]
    action = "A*acos(γ1*sin(u)*cos(v) + γ2*sin(u)*sin(v) + γ3*cos(u))^2/(2*t)"
    constants = { u = 0.3, v = 0.5 }
    [simulation]
    t_end = 2.0
"#;

/// A sleigh whose mass centre is in front of the blade.
const SLEIGH: &str = r#"
    [parameters]
    m = 2.0
    J = 0.5
    a = 0.3
    [coordinates]
    X = 0.0
    Y = 0.0
    "φ" = 0.2
    [quasi_velocities]
    v = { is = "X'*cos(φ) + Y'*sin(φ)", start = 1.0 }
    u = { is = "Y'*cos(φ) - X'*sin(φ)", start = 0.0 }
    "ω" = { is = "φ'", start = 0.7 }
    [constraints]
    blade = "u"
    [lagrangian]
    kinetic = "m*(v^2 + (u + a*ω)^2)/2 + J*ω^2/2"
"#;

fn with_assembly<T>(text: &str, then: impl for<'g> FnOnce(&Model, &'g Graph, &Assembly<'g>) -> T) -> T {
    let model = Model::new(Document::parse(Source::new("model", text)).unwrap());
    let graph = model.graph();
    let assembly = model.assemble(&graph).unwrap();
    then(&model, &graph, &assembly)
}

/// The theory as `pc theory` prints it.
fn from_text(text: &str) -> String {
    with_assembly(text, |model, _, assembly| {
        Theory::of(model, assembly, &TheoryOptions::default()).unwrap().printed(Page::Text)
    })
}

/// The theory as a program in C gets it.
#[expect(unsafe_code, reason = "functions of the C library are called")]
fn from_c(text: &str) -> String {
    let (mut model, mut system) = (ptr::null_mut(), ptr::null_mut());
    let mut printed: *mut c_char = ptr::null_mut();
    // SAFETY: each pointer is null where that is allowed, of a live object, or a place for a result that is freed once.
    unsafe {
        let error = ptr::null_mut();
        let read = pc::pc_model_parse(text.as_ptr().cast(), text.len(), ptr::null(), &raw mut model, error);
        assert_eq!(read, pc::pc_status::PC_OK);
        let derived = pc::pc_system_new(model, ptr::null(), &raw mut system, error);
        assert_eq!(derived, pc::pc_status::PC_OK);
        let said = pc::pc_system_theory(system, 0, 2, ptr::null(), 0, &raw mut printed, error);
        assert_eq!(said, pc::pc_status::PC_OK);
        let theory = CStr::from_ptr(printed).to_str().unwrap().to_owned();
        pc::pc_string_free(printed);
        pc::pc_system_free(system);
        pc::pc_model_free(model);
        theory
    }
}

/// What is printed from the text and in C are one, and contain these lines, up to their indentation.
#[track_caller]
fn assert_said(text: &str, lines: &[&str]) {
    let said = from_text(text);
    assert_eq!(from_c(text), said);
    for line in lines {
        assert!(said.lines().any(|one| one.trim_start().starts_with(line)), "{line}\n{said}");
    }
}

/// Two components of the angular momentum bring the third.
#[test]
fn poissons_theorem_brings_a_new_integral() {
    assert_said(PLANET, &["(Kx, F1) = N1   (proved)", "a new integral, by Poisson's theorem"]);
    with_assembly(PLANET, |_, graph, assembly| {
        let canonical = assembly.system.canonical().unwrap();
        let [kx, kz] =
            [assembly.system.integrals()[0].1, assembly.system.momenta()[2]].map(|f| canonical.in_momenta(f));
        let bracket = PoissonBracket::new(&assembly.system);
        let all = bracket.closure(&[kx, kz]).unwrap();
        let [p, q, theta, phi] = graph.symbols(["p_θ", "p_φ", "θ", "φ"]);
        assert_eq!(all.len(), 3);
        let ky = p * phi.cos() - q * phi.sin() * theta.cos() / theta.sin();
        assert!((all[2] - ky).is_zero() || (all[2] + ky).is_zero(), "{}", all[2]);
        assert!(bracket.of(all[2], canonical.hamiltonian()).unwrap().is_zero());
    });
}

#[test]
fn the_equation_of_hamilton_and_jacobi_is_satisfied() {
    assert_said(OSCILLATOR, &["½ ω² x² + ½ S_x² + S_t = 0", "action: S = "]);
    assert!(from_text(OSCILLATOR).contains("(proved)\n      complete: ∂(X_s S)/∂α has rank 1 of 1"));
    with_assembly(OSCILLATOR, |_, _, assembly| {
        let canonical = assembly.system.canonical().unwrap();
        assert!(hamilton_jacobi(&canonical, assembly.action.as_ref().unwrap().value).unwrap().is_zero());
    });
}

/// E = ½ (ẋ² + ω² x²) and β = atan(ω x/ẋ)/ω − t are those of x = √(2E) sin ω(t + β)/ω.
#[test]
fn jacobis_theorem_gives_the_motion() {
    assert_said(OSCILLATOR, &["Jacobi's theorem: ∂S/∂E = ", "agrees with the motion of (10), (11) within "]);
    with_assembly(OSCILLATOR, |_, _, assembly| {
        let canonical = assembly.system.canonical().unwrap();
        let action = assembly.action.as_ref().unwrap().value;
        let integral = CompleteIntegral::new(&canonical, action, &["E"]).unwrap();
        let mut motion = integral.motion_through(0.0, (&[0.3], &[1.0]), &[2.0]).unwrap();
        let (energy, beta) = ((1.0 + 0.45f64.powi(2)) / 2.0, 0.45f64.atan2(1.0) / 1.5);
        assert!((motion.alpha()[0] - energy).abs() < 1e-14 && (motion.beta()[0] - beta).abs() < 1e-14);
        let agreement = motion.agreement(&canonical, 10.0).unwrap();
        // Until the velocity changes its sign.
        let turn = (std::f64::consts::FRAC_PI_2 / 1.5) - beta;
        assert!(agreement.end.is_some() && (agreement.until - turn).abs() < 1e-6, "{agreement:?}");
        assert!(agreement.deviation.unwrap() < 1e-13, "{agreement:?}");
    });
}

/// The rotations act on γ with spheres as orbits: S has two constants, and y_s = X_s S describes the motions with γ_s y_s = 0.
#[test]
fn the_equation_of_hamilton_and_jacobi_holds_on_an_orbit() {
    let lines = [
        "complete: ∂(X_s S)/∂α has rank 2 of 2",
        "on the orbit: γ1² + γ2² + γ3² = 1",
        "the motions of S: γ1 p_ω1 + γ2 p_ω2 + γ3 p_ω3 = 0",
        "agrees with the motion of (10), (11) within ",
    ];
    assert_said(TOP, &lines);
    with_assembly(TOP, |_, graph, assembly| {
        let (system, canonical) = (&assembly.system, assembly.system.canonical().unwrap());
        let action = assembly.action.as_ref().unwrap().value;
        let [x, y, z] = graph.symbols(["γ1", "γ2", "γ3"]);
        let norm: Expr<'_> = x.square() + y.square() + z.square();
        let sphere = Orbit::through(system, &[norm], &assembly.at_start()).unwrap();
        assert!(!hamilton_jacobi(&canonical, action).unwrap().is_zero());
        assert!(CompleteIntegral::on_orbit(&canonical, action, &["u", "v"], &sphere).is_ok());
    });
}

/// ∂H/∂y_α = 0, ẋ_i = b_is ∂H/∂y_s + b_i0 with H of all momenta.
#[test]
fn equation_31_has_the_full_hamiltonian() {
    assert_said(SLEIGH, &["p_u = m a p_ω/(m a² + J)   (proved)", "from ∂H/∂p_u = 0, the constraint"]);
    with_assembly(SLEIGH, |_, graph, assembly| {
        let constrained = assembly.constraints.constrained(&assembly.at_start()).unwrap().unwrap();
        let found = DependentMomenta::of(&constrained).unwrap().unwrap();
        let [m, j, a, omega] = graph.symbols(["m", "J", "a", "p_ω"]);
        assert!(found.are_proved && (found.values[0].1 - m * a * omega / (m * a.square() + j)).is_zero());
    });
}
