//! The rate of the energy along motions that are driven, and what becomes of it without ∂b/∂t.
//!
//!   dH/dt = X_0 H + c_0r^m η_r y_m + Q_s η_s

use pc_mech::{AlgebraError, Expr, Graph, MechError, Motion, StructureCoefficients, System, VectorField};
use pc_model::{Assembly, Builtin, Model};
use pc_solve::{Method, Options, solve};
use pc_tests::dual::Dual;

const OUTPUTS: usize = 50;
/// Some hundred roundings of the largest term.
const ROUNDING: f64 = 1e-12;
/// What a forgotten term changes at the least, of rates of order one.
const SEEN: f64 = 1e-3;

const DRIVEN: [&str; 7] = [
    "turning-wire",
    "turning-hoop",
    "rotating-oscillator",
    "charged-particle",
    "charged-particle-induction",
    "damped-oscillator",
    "damped-oscillator-scaled-frame",
];

fn with_model(name: &str, work: impl for<'g> FnOnce(&Assembly<'g>, f64)) {
    let model = Model::new(Builtin::named(name).unwrap().document().unwrap());
    let graph = Graph::new();
    let assembly = model.assemble(&graph).unwrap_or_else(|e| panic!("{e}"));
    work(&assembly, model.document().simulation.t_end.as_ref().unwrap().value);
}

/// The motion of a model, at [`OUTPUTS`] times.
fn states(assembly: &Assembly<'_>, motion: &mut Motion, t_end: f64) -> Vec<(f64, Vec<f64>)> {
    let times: Vec<f64> = (1..=OUTPUTS).map(|i| t_end * i as f64 / OUTPUTS as f64).collect();
    let options = Options::new(Method::Adams).relative_tolerance(1e-12).absolute_tolerance(1e-14);
    let trajectory = solve(motion, assembly.t_start, &assembly.start, &times, &options).unwrap();
    trajectory.iter().map(|(t, y)| (t, y.to_vec())).collect()
}

/// Values of (t, x, η) and of the parameters; the variable number `moving` of (t, x, η) has the derivative 1.
fn place<'g>(system: &System<'g>, t: f64, y: &[f64], moving: Option<usize>) -> Vec<(Expr<'g>, Dual)> {
    let frame = system.frame();
    let symbols = [frame.time()].into_iter().chain(frame.coordinates().iter().copied());
    let symbols = symbols.chain(system.quasi_velocities().iter().copied());
    let values = [t].into_iter().chain(y.iter().copied()).enumerate();
    let values = values.map(|(i, value)| Dual::new(value, f64::from(u8::from(moving == Some(i))), 0.0));
    let parameters = system.parameters().iter().map(|&(symbol, value)| (symbol, Dual::new(value, 0.0, 0.0)));
    symbols.zip(values).chain(parameters).collect()
}

fn value<'g>(system: &System<'g>, f: Expr<'g>, t: f64, y: &[f64]) -> f64 {
    system.graph().evaluate(&[f], &place(system, t, y, None)).unwrap()[0].value()
}

/// ∂E/∂t + ẋ ∂E/∂x + η̇ ∂E/∂η, E = y η − L, and its largest term; the rates are those of the compiled motion, the
/// derivatives by dual numbers.
fn rate_along(system: &System<'_>, motion: &mut Motion, t: f64, y: &[f64]) -> (f64, f64) {
    let mut rates = vec![1.0; y.len() + 1];
    motion.rhs(t, y, &mut rates[1..]).unwrap();
    let terms = rates.iter().enumerate().map(|(i, rate)| {
        let energy = system.graph().evaluate(&[system.energy()], &place(system, t, y, Some(i))).unwrap();
        energy[0].first() * rate
    });
    terms.fold((0.0, 1.0), |(sum, largest), term| (sum + term, f64::max(largest, term.abs())))
}

#[test]
fn the_energy_changes_at_its_rate_along_the_motion() {
    for name in DRIVEN {
        with_model(name, |assembly, t_end| {
            let system = &assembly.system;
            let rate = system.energy_rate();
            let mut motion = system.poincare().unwrap().compile().unwrap();
            for (t, y) in states(assembly, &mut motion, t_end) {
                let (expected, size) = rate_along(system, &mut motion, t, &y);
                let found = value(system, rate, t, &y);
                assert!(
                    (found - expected).abs() <= ROUNDING * size,
                    "{name}, t = {t}: {found}, not {expected}"
                );
            }
        });
    }
}

/// c_0s^m with ∂b/∂t left out of [X_0, X_s] = X_0 b_s − X_s b_0, for frames with one operator. On the wire and the
/// hoop the rest of c_0s is zero: it is the turning of b, which ∂b/∂t undoes. In the scaled frame the commutator of
/// e^(−δt) and δx is half of the whole.
const WITHOUT_RATE_OF_B: [(&str, f64); 3] =
    [("turning-wire", 0.0), ("turning-hoop", 0.0), ("damped-oscillator-scaled-frame", 0.5)];

fn mutant<'g>(system: &System<'g>, left: f64) -> StructureCoefficients<'g> {
    system.structure().map(|c| c * left)
}

/// The rate of the energy, and η̇ = M⁻¹ (… + c_01 p), would both be wrong by more than any tolerance.
#[test]
fn a_missing_rate_of_b_is_detected() {
    for (name, left) in WITHOUT_RATE_OF_B {
        with_model(name, |assembly, t_end| {
            let system = &assembly.system;
            let (eta, momentum) = (system.quasi_velocities()[0], system.momenta()[0]);
            let equations = system.poincare().unwrap();
            let missing = system.structure().get(0, 1, 1) - mutant(system, left).get(0, 1, 1);
            let wrong_rate = system.energy_rate() - missing * eta * momentum;
            let wrong_acceleration = missing * momentum / equations.mass_matrix()[(0, 0)];
            let mut motion = equations.compile().unwrap();
            let mut worst = [0.0f64; 2];
            for (t, y) in states(assembly, &mut motion, t_end) {
                let (expected, _) = rate_along(system, &mut motion, t, &y);
                worst[0] = worst[0].max((value(system, wrong_rate, t, &y) - expected).abs());
                worst[1] = worst[1].max(value(system, wrong_acceleration, t, &y).abs());
            }
            assert!(worst.iter().all(|&error| error > SEEN), "{name}: {worst:?}");
        });
    }
}

/// The system of a model with other structure coefficients.
fn with_structure<'g>(
    assembly: &Assembly<'g>,
    structure: StructureCoefficients<'g>,
) -> Result<System<'g>, MechError> {
    let system = &assembly.system;
    let coordinates = system.frame().coordinates();
    let parameters = system.parameters().iter();
    parameters
        .fold(System::builder(system.graph()), |builder, &(symbol, value)| builder.parameter(symbol, value))
        .coordinates(coordinates.iter().map(Expr::to_string))
        .quasi_velocities(system.quasi_velocities().iter().map(Expr::to_string))
        .frame(system.frame().clone())
        .near(coordinates.iter().copied().zip(assembly.start.iter().copied()))
        .structure(structure)
        .lagrangian(|_, _, _| system.lagrangian())
        .build()
}

/// Given to the library, such coefficients contradict the frame.
#[test]
fn a_missing_rate_of_b_is_refused() {
    for (name, left) in WITHOUT_RATE_OF_B {
        with_model(name, |assembly, _| {
            let system = &assembly.system;
            with_structure(assembly, system.structure().clone()).unwrap();
            let error = with_structure(assembly, mutant(system, left)).unwrap_err();
            let refused = matches!(
                error,
                MechError::Algebra(AlgebraError::Contradiction { pair: (0, 1), residual }) if residual > SEEN
            );
            assert!(refused, "{name}: {error}");
        });
    }
}
