//! What is said to be kept is kept: integrals, proved in expressions, along compiled motions at random states.

use pc_analysis::{Integral, Integrals, PolynomialAnsatz, Routhian};
use pc_mech::{Expr, Graph, Neighbourhood, Number, VectorField};
use pc_model::{Builtin, Model};

use crate::derived::Derived;

/// Rounding leaves so little of the terms of a rate that vanishes; of the longest models they have some hundred factors.
const ROUNDING: f64 = 1e-9;

/// States at which each is tried.
const STATES: u64 = 8;

/// Numbers from −1 to 1, the same on every run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

/// |∂f/∂t + ∂f/∂y ẏ| against the sum of its terms.
fn part_left(slopes: &[f64], rates: &[f64]) -> f64 {
    let terms = || slopes.iter().zip(rates).map(|(slope, rate)| slope * rate);
    let size: f64 = terms().map(f64::abs).sum();
    if size == 0.0 { 0.0 } else { terms().sum::<f64>().abs() / size }
}

pub(crate) fn integrals_of_all_models_are_kept_at_random_states(derived: &Derived<'_>) {
    let (graph, assembly, equations) = (derived.graph, &derived.assembly, &derived.equations);
    let (system, t) = (equations.system(), assembly.t_start);
    if !system.signals().is_empty() || !system.external_forces().is_empty() {
        return;
    }
    let time = graph.symbol("t");
    let parameters = system.parameters().to_vec();
    let near = Neighbourhood { centre: [assembly.at_start(), parameters.clone()].concat() };
    let mut found = Integrals::known(equations, &near);
    found.add_polynomials(equations, &near, &PolynomialAnsatz::of_degree(2)).unwrap();

    let mut motion = derived.equations_compiled();
    let (state, start) = (system.state(), assembly.start_of(&system.state()));
    let all = [vec![time], state.clone()].concat();
    let kept: Vec<&Integral<'_>> = found.conserved().collect();
    let slopes: Vec<Vec<Expr<'_>>> = kept.iter().map(|f| graph.gradient(f.value, &all)).collect();
    let mut tried = 0;
    let mut random = Random(7);
    for _ in 0..STATES {
        let y: Vec<f64> = start.iter().map(|y| y + (0.1 + 0.2 * y.abs()) * random.next()).collect();
        let mut rates = vec![0.0; y.len()];
        if motion.rhs(t, &y, &mut rates).is_err() {
            continue; // outside of where the coordinates are regular
        }
        rates.insert(0, 1.0);
        let at: Vec<(Expr<'_>, f64)> = state.iter().copied().zip(y).chain(parameters.clone()).collect();
        let at = [at, vec![(time, t)]].concat();
        for (integral, slopes) in kept.iter().zip(&slopes) {
            let slopes = graph.evaluate(slopes, &at).unwrap();
            if slopes.iter().all(|slope| slope.is_finite()) {
                let (left, name) = (part_left(&slopes, &rates), derived.name);
                assert!(left < ROUNDING, "{name}: {} changes, {left} of its terms is left", integral.name);
                tried += 1;
            }
        }
    }
    let mut findings = derived.findings.borrow_mut();
    findings.integrals = kept.len();
    findings.integrals_tried = tried;
}

/// What is said to change does.
#[test]
fn a_function_that_changes_is_found_to_change() {
    let graph = Graph::new();
    let model = Model::new(Builtin::named("euler-top").unwrap().document().unwrap());
    let equations = model.assemble(&graph).unwrap().equations().unwrap();
    let [w1, w2, w3] = graph.symbols(["ω1", "ω2", "ω3"]);
    let f = w1.square() + Expr::from(Number::ratio(1, 2)) * w2.square();
    let state = [0.7, -0.4, 0.9];
    let mut rates = [0.0; 3];
    equations.compile().unwrap().rhs(0.0, &state, &mut rates).unwrap();
    let at: Vec<(Expr<'_>, f64)> = [w1, w2, w3].into_iter().zip(state).collect();
    let slopes = graph.evaluate(&graph.gradient(f, &[w1, w2, w3]), &at).unwrap();
    assert!(part_left(&slopes, &rates) > 1e-3);
}

/// Of all models with cyclic coordinates the equations that remain have the accelerations of the whole.
pub(crate) fn the_equations_that_remain_have_the_motions_of_the_whole(derived: &Derived<'_>) {
    let assembly = &derived.assembly;
    if assembly.constraints.multipliers().is_some() {
        return;
    }
    let system = &assembly.system;
    let at = [assembly.at_start(), system.parameters().to_vec()].concat();
    let Ok(Some(routh)) = Routhian::of(system, &at) else { return };
    let Some(rest) = &routh.system else { return };
    let whole = system.in_velocities().unwrap();
    let mut transform = system.velocity_transform().unwrap();
    let start = transform.to_velocities(assembly.t_start, &assembly.start);
    let mut rates = vec![0.0; start.len()];
    derived.in_velocities().unwrap().rhs(assembly.t_start, &start, &mut rates).unwrap();
    let places: Vec<usize> =
        rest.state().iter().map(|z| whole.state().iter().position(|known| known == z).unwrap()).collect();
    let state: Vec<f64> = places.iter().map(|&i| start[i]).collect();
    let mut remaining = vec![0.0; state.len()];
    rest.poincare().unwrap().compile().unwrap().rhs(assembly.t_start, &state, &mut remaining).unwrap();
    for (&place, found) in places.iter().zip(remaining) {
        let error = (found - rates[place]).abs();
        let close = error < ROUNDING * (1.0 + rates[place].abs());
        assert!(close, "{}: {found} is {}", derived.name, rates[place]);
    }
    derived.findings.borrow_mut().has_cyclic = true;
}
