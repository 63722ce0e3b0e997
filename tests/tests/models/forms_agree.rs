//! Poincaré's, Chetaev's and Lagrange's equations of every built-in model say the same at one state.

use pc_mech::{Backend, Expr, Motion, System, VectorField};
use pc_tests::classical::SplitMix64;
use pc_tests::dual::Dual;

use crate::derived::Derived;

const STATES: usize = 1000;
/// Times are drawn so far after the start, states so far about it: where every frame is regular, and no particle
/// faster than light.
const SPREAD: f64 = 0.1;
/// Two mass matrices of condition below some hundred are inverted, of terms of order ten.
const ROUNDING: f64 = 1e-11;

/// The states of a system near the start of a model, and what moves along Poincaré's equations.
struct Along<'g> {
    system: System<'g>,
    motion: Motion,
    /// t, x, η and the parameters
    symbols: Vec<Expr<'g>>,
    random: SplitMix64,
    start: (f64, Vec<f64>),
}

impl<'g> Along<'g> {
    fn new(derived: &Derived<'g>) -> Along<'g> {
        let (system, state) = (derived.equations.system().clone(), derived.state());
        let parameters = system.parameters().iter().map(|&(symbol, _)| symbol);
        Along {
            motion: derived.equations_compiled(),
            symbols: [system.frame().time()].into_iter().chain(state.clone()).chain(parameters).collect(),
            random: SplitMix64::new(23),
            start: (derived.assembly.t_start, derived.assembly.start_of(&state)),
            system,
        }
    }

    fn state(&mut self) -> (f64, Vec<f64>) {
        let (t, start) = &self.start;
        let random = &mut self.random;
        (t + random.uniform(0.0, SPREAD), start.iter().map(|y| y + random.uniform(-SPREAD, SPREAD)).collect())
    }

    /// Functions of (t, x, η) with their rates of change along the equations, by dual numbers.
    fn rates(&mut self, functions: &[Expr<'g>], t: f64, y: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let mut rates = vec![f64::NAN; y.len()];
        self.motion.rhs(t, y, &mut rates).unwrap();
        let parameters = self.system.parameters().iter().map(|&(_, value)| Dual::new(value, 0.0, 0.0));
        let moving = y.iter().zip(&rates).map(|(&y, &rate)| Dual::new(y, rate, 0.0));
        let values = [Dual::new(t, 1.0, 0.0)].into_iter().chain(moving).chain(parameters);
        let place: Vec<(Expr<'g>, Dual)> = self.symbols.iter().copied().zip(values).collect();
        let found = self.system.graph().evaluate(functions, &place).unwrap();
        (found.iter().map(|f| f.value()).collect(), found.iter().map(|f| f.first()).collect())
    }
}

#[track_caller]
fn assert_close(name: &str, what: &str, found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len(), "{name}");
    let size = expected.iter().fold(1.0f64, |size, v| size.max(v.abs()));
    for (i, (f, e)) in found.iter().zip(expected).enumerate() {
        let error = (f - e).abs() / size;
        assert!(error <= ROUNDING, "{name}: {what} {i} is {f}, not {e}"); // false for NaN too
    }
}

/// d/dt ∂L/∂η_s along (9) or (30) is ẏ_s of (10) or (34), ẋ is that of (11), and η comes back from y.
pub(crate) fn canonical_equations_are_poincares(derived: &Derived<'_>) {
    let (name, system) = (derived.name, derived.free_system());
    let canonical = system.canonical().unwrap();
    let mut transform = canonical.legendre_transform().unwrap();
    let mut motion = canonical.compile_for(Backend::Fastest).unwrap();
    let functions = [system.frame().coordinates(), &system.momenta()].concat();
    let mut along = Along::new(derived);
    for _ in 0..STATES {
        let (t, state) = along.state();
        let (values, expected) = along.rates(&functions, t, &state);
        let mut found = vec![f64::NAN; state.len()];
        motion.rhs(t, &values, &mut found).unwrap();
        assert_close(name, "rate", &found, &expected);
        assert_close(name, "momentum", &transform.to_momenta(t, &state).unwrap(), &values);
        assert_close(name, "component", &transform.to_quasi_velocities(t, &values).unwrap(), &state);
    }
}

/// In these n > k, n = 0, or γ lies on a sphere; ṡ = 0 of the place that a block sticks at, of the side it rocks on.
pub(crate) const NOT_IN_VELOCITIES: [&str; 23] = [
    "heavy-top-lagrange",
    "heavy-top-kovalevskaya",
    "heavy-top-goryachev-chaplygin",
    "heavy-top-quaternion",
    "euler-top",
    "rigid-body-spring",
    "gravity-gradient",
    "reaction-wheels",
    "spherical-pendulum-cartesian",
    "spherical-pendulum-meridian",
    "double-pendulum-cartesian",
    "double-pendulum-links",
    "turning-wire",
    "turning-hoop",
    "pendulum-chain-cartesian",
    "suslov",
    "suslov-in-gravity",
    "turntable",
    "turntable-accelerated",
    "ball-in-cylinder",
    "stick-slip-block",
    "rocking-block",
    "stick-slip-sleigh",
];

/// ẋ = b η + b_0, differentiated along (9) or (30), is ẍ of Lagrange's equations, with multipliers where there are
/// constraints.
pub(crate) fn lagranges_equations_are_poincares(derived: &Derived<'_>) {
    let name = derived.name;
    let in_velocities = derived.in_velocities();
    let without = derived.is_among(&NOT_IN_VELOCITIES);
    assert_eq!(in_velocities.is_err(), without, "{name}: {:?}", in_velocities.err());
    let Ok(mut motion) = in_velocities else { return };
    let equations = &derived.equations;
    let functions = [equations.system().frame().coordinates(), equations.velocities()].concat();
    let mut along = Along::new(derived);
    for _ in 0..STATES {
        let (t, state) = along.state();
        let (values, expected) = along.rates(&functions, t, &state);
        let mut found = vec![f64::NAN; values.len()];
        motion.rhs(t, &values, &mut found).unwrap();
        assert_close(name, "rate", &found, &expected);
    }
}
