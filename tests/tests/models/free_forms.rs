//! One motion in all the forms its equations have: reduced, in an orthonormal frame, and in quasi-velocities given by random linear
//! forms; each against Poincaré's equations of the model, by their rates.

use std::collections::BTreeMap;

use pc_mech::{Graph, System, VectorField};
use pc_model::{Assembly, Flow, Model, Variables};
use pc_tests::classical::SplitMix64;

use crate::derived::Derived;

/// States tried for each form.
const STATES: usize = 8;

/// Forms lose digits to the condition of their matrices, which is some thousands at states drawn at random; rates are compared with
/// the largest of all.
const TOLERANCE: f64 = 1e-9;

/// The rates of the coordinates that a flow has, and of the quasi-velocities of the model, by their names.
fn rates(
    flow: &mut Flow,
    system: &System<'_>,
    t: f64,
    values: &BTreeMap<String, f64>,
) -> Option<BTreeMap<String, f64>> {
    let (own, n) = (flow.motion.names().to_vec(), flow.motion.coordinates());
    let eta = system.quasi_velocities().iter().map(ToString::to_string);
    let z = system.states().iter().map(|(z, _)| z.to_string());
    let all: Vec<f64> =
        own[..n].iter().cloned().chain(eta.clone()).chain(z).map(|name| values[&name]).collect();
    let state = flow.state_of(t, &all).ok()?;
    let mut found = vec![f64::NAN; state.len()];
    flow.motion.rhs(t, &state, &mut found).ok()?;
    let mut rates: BTreeMap<String, f64> = own.into_iter().zip(found.iter().copied()).collect();
    if let Some(changed) = flow.rates_of_quasi_velocities(t, &state, &found) {
        rates.extend(eta.zip(changed));
    }
    Some(rates)
}

/// Compares a form with Poincaré's equations at states near the start, at one of them at least. The assembly is that of the model, or of
/// it with quasi-velocities given.
#[track_caller]
fn compare(
    name: &str,
    mut plain: Flow,
    (model, assembly): (&Model, &Assembly<'_>),
    variables: Variables,
    random: &mut SplitMix64,
) {
    let system = &assembly.system;
    let mut other = match Flow::new(model, assembly, variables) {
        Ok(flow) => flow,
        Err(error) => panic!("{name}, {}: {error}", variables.name()),
    };
    let free = plain.motion.names().to_vec();
    let mut compared = 0;
    for _ in 0..STATES {
        // Quasi-velocities that constraints keep at zero stay there.
        let value = |(symbol, &start): (String, &f64), by: f64| {
            let moved = start + 0.1 * by * (1.0 + start.abs());
            let value = if free.contains(&symbol) { moved } else { start };
            (symbol, value)
        };
        let symbols = system.state().into_iter().map(|symbol| symbol.to_string());
        let values: BTreeMap<String, f64> =
            symbols.zip(&assembly.start).map(|pair| value(pair, random.normal())).collect();
        let (Some(expected), Some(found)) = (
            rates(&mut plain, system, assembly.t_start, &values),
            rates(&mut other, system, assembly.t_start, &values),
        ) else {
            continue;
        };
        let largest = expected.values().fold(1.0f64, |largest, rate| largest.max(rate.abs()));
        for (symbol, expected) in &expected {
            let Some(found) = found.get(symbol) else { continue }; // a coordinate that is left out
            assert!(
                (found - expected).abs() <= TOLERANCE * largest,
                "{name}, {}: the rate of {symbol} is {found:e}, not {expected:e}, at {values:?}",
                variables.name()
            );
        }
        compared += 1;
    }
    assert!(compared > 0, "{name}, {}", variables.name());
}

/// Lagrangians that are not quadratic have no kinetic metric.
pub(crate) const RELATIVISTIC: [&str; 2] = ["relativistic-particle", "relativistic-constant-force"];

pub(crate) fn all_models_move_alike_in_reduced_and_orthonormal_form(derived: &Derived<'_>) {
    let assembly = &derived.assembly;
    if derived.is_among(&RELATIVISTIC) {
        let error = assembly.free_form(Variables::Orthonormal).unwrap_err().to_string();
        assert!(error.contains("orthonormal in the kinetic metric: L is not quadratic"), "{error}");
    }
    if assembly.constraints.held().is_some() {
        return;
    }
    let mut random = derived.random(19);
    let mut alike = |variables| {
        compare(derived.name, derived.flow(), (derived.model, assembly), variables, &mut random);
    };
    if derived.model.document().events.is_empty() {
        alike(Variables::Reduced);
        derived.findings.borrow_mut().is_reduced = true;
    }
    if !derived.is_among(&RELATIVISTIC) {
        alike(Variables::Orthonormal);
    }
}

/// η'_u = A_us η_s with A_us of random numbers and sines of the coordinates, far from singular.
pub(crate) fn all_models_move_alike_in_quasi_velocities_given_at_random(derived: &Derived<'_>) {
    if derived.assembly.constraints.held().is_some() {
        return;
    }
    let mut random = derived.random(7);
    let mut model = derived.model.clone();
    let form = derived.assembly.free_form(Variables::QuasiVelocities).unwrap();
    let free: Vec<String> = form.independent.iter().map(ToString::to_string).collect();
    let coordinate = model.document().coordinates.first().map(|x| x.name.text.clone());
    let given = 1 + (random.uniform(0.0, 1.0) * free.len().min(4) as f64) as usize;
    for u in 0..given.min(free.len()) {
        let term = |s: usize, random: &mut SplitMix64| {
            let weight = random.uniform(-0.2, 0.2);
            let weight = if s == u { 1.0 + weight } else { weight };
            match &coordinate {
                Some(x) if s != u => format!("{weight:.3}*sin({x} + {s})*{}", free[s]),
                _ => format!("{weight:.3}*{}", free[s]),
            }
        };
        let terms: Vec<String> = (0..free.len().min(4)).map(|s| term(s, &mut random)).collect();
        model.give_quasi_velocity(&format!("given{u}"), &terms.join(" + ").replace("+ -", "- ")).unwrap();
    }
    let given = model.given_quasi_velocities().iter();
    let given: Vec<String> = given.map(|g| format!("{} = {}", g.name(), g.expression().text)).collect();
    let name = format!("{} with {}", derived.name, given.join(", "));
    let graph = Graph::new();
    let assembly = model.assemble(&graph).unwrap_or_else(|error| panic!("{error}"));
    compare(&name, derived.flow(), (&model, &assembly), Variables::Given, &mut random);
}
