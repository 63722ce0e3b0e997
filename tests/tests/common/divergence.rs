//! The density of an invariant measure, times the compiled field, has no divergence: in numbers, at random states.

use pc_analysis::{MeasureSearch, PhaseMeasure};
use pc_mech::{Backend, Expr, Graph, Motion, System, VectorField};
use pc_model::Assembly;
use pc_tests::fuzz::random::Random;

/// States of each model.
const STATES: usize = 5;

/// Five values each STEP apart leave STEP⁴ of the fifth derivative of N f, and 1e-16/STEP of its rounding.
const STEP: f64 = 1e-3;

/// What is left of a divergence that vanishes, of its terms: the fifth derivatives of fields with sines of a few multiples of
/// their argument are some thousand times as large as these.
const VANISHES: f64 = 1e-8;

/// ∂(N f_i)/∂z_i + ∂N/∂t against the size of its terms, at one state; none where the stencil does not converge: at a corner,
/// or where the equations are near a singular state.
fn divergence<'g>(
    graph: &'g Graph,
    density: Expr<'g>,
    (time, variables): (Expr<'g>, &[Expr<'g>]),
    parameters: &[(Expr<'g>, f64)],
    field: &mut impl VectorField,
    (t, state): (f64, &[f64]),
) -> Option<f64> {
    let mut flux = |place: Option<usize>, t: f64, state: &[f64]| -> Option<f64> {
        let symbols = variables.iter().copied().zip(state.iter().copied());
        let values: Vec<_> = parameters.iter().copied().chain(symbols).chain([(time, t)]).collect();
        let density = graph.evaluate(&[density], &values).ok()?[0];
        let mut rates = vec![0.0; state.len()];
        field.rhs(t, state, &mut rates).ok()?;
        Some(place.map_or(density, |i| density * rates[i])).filter(|flux| flux.is_finite())
    };
    let mut slope = |place: Option<usize>, step: f64| -> Option<f64> {
        let mut at = |distance: f64| {
            let (mut t, mut state) = (t, state.to_vec());
            match place {
                None => t += distance,
                Some(i) => state[i] += distance,
            }
            flux(place, t, &state)
        };
        let near = at(step)? - at(-step)?;
        let far = at(2.0 * step)? - at(-2.0 * step)?;
        Some((8.0 * near - far) / (12.0 * step))
    };
    let places = || std::iter::once(None).chain((0..state.len()).map(Some));
    let mut all = |step: f64| places().map(|place| slope(place, step)).collect::<Option<Vec<f64>>>();
    let (coarse, fine) = (all(STEP)?, all(STEP / 2.0)?);
    let fluxes = places().map(|place| flux(place, t, state)).collect::<Option<Vec<f64>>>()?;
    let size = fine.iter().chain(&fluxes).map(|term| term.abs()).sum::<f64>();
    let error = coarse.iter().zip(&fine).map(|(coarse, fine)| (coarse - fine).abs()).sum::<f64>();
    (error <= VANISHES * size).then(|| fine.iter().sum::<f64>().abs() / size)
}

/// What has been compared.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Compared {
    /// Measures of models.
    pub(crate) measures: usize,
    /// Of these, densities that are not constant.
    pub(crate) varying: usize,
    pub(crate) states: usize,
    /// States where the square of a density that varies has no divergence either.
    pub(crate) unseen: usize,
}

/// The fields of a system in velocities and in momenta, as far as densities of its measure are known there.
struct Fields<'g> {
    free: System<'g>,
    in_velocities: Option<(Expr<'g>, Motion)>,
    /// With the momenta.
    in_momenta: Option<(Expr<'g>, Vec<Expr<'g>>, Motion)>,
}

impl<'g> Fields<'g> {
    fn of(free: &System<'g>, measure: &PhaseMeasure<'g>) -> Fields<'g> {
        let free = free.without_observed(); // what is observed of reactions cannot be compiled here
        let canonical = free.canonical().unwrap();
        let in_momenta = measure.density.filter(|_| canonical.is_closed()).map(|density| {
            (density, canonical.momenta().to_vec(), canonical.compile_for(Backend::Interpreter).unwrap())
        });
        let compiled = || free.poincare().unwrap().compile().unwrap();
        let in_velocities = measure.in_velocities.map(|density| (density, compiled()));
        Fields { free, in_velocities, in_momenta }
    }
}

impl Compared {
    /// Tries the measure of a model at random states near its start; `free` is its system of free quasi-velocities.
    pub(crate) fn compare<'g>(
        &mut self,
        name: &str,
        assembly: &Assembly<'g>,
        free: &System<'g>,
        random: &mut Random,
    ) {
        if assembly.constraints.nonlinear().is_some() {
            return;
        }
        let positions = assembly.constraints.positions(&assembly.system);
        let at = [assembly.at_start(), free.parameters().to_vec()].concat();
        let Ok(MeasureSearch::Found(measure)) = MeasureSearch::of(free, positions.as_deref(), &at) else {
            return;
        };
        let mut fields = Fields::of(free, &measure);
        self.measures += 1;
        let start = assembly.start_of(&free.state());
        for _ in 0..STATES {
            let vary = |x: &f64| x + random.number(-0.2, 0.2);
            let state: Vec<f64> = start.iter().map(vary).collect();
            self.compare_at(name, &mut fields, (assembly.t_start + random.number(0.0, 1.0), &state));
        }
        let constant = measure.density.is_none_or(|density| density.constant().is_some());
        self.varying += usize::from(!constant);
    }

    fn compare_at(&mut self, name: &str, fields: &mut Fields<'_>, (t, state): (f64, &[f64])) {
        let free = &fields.free;
        let (graph, time) = (free.graph(), free.frame().time());
        if let Some((density, motion)) = &mut fields.in_velocities {
            let symbols = free.state();
            let mut left = |density| {
                let place = (t, state);
                divergence(graph, density, (time, &symbols), free.parameters(), motion, place)
            };
            if let Some(left_over) = left(*density) {
                assert!(
                    left_over <= VANISHES,
                    "{name}: {left_over:e} of div ({density}) (ẋ, η̇) at {state:?}"
                );
                self.states += 1;
                let is_unseen = left(density.square()).is_some_and(|left_over| left_over <= VANISHES);
                self.unseen += usize::from(is_unseen && density.constant().is_none());
            }
        }
        let Some((density, momenta, motion)) = &mut fields.in_momenta else { return };
        let n = free.frame().coordinates().len();
        let known: Vec<_> = free.parameters().iter().copied().chain([(time, t)]).collect();
        let known = [known, free.state().into_iter().zip(state.iter().copied()).collect()].concat();
        let Ok(values) = graph.evaluate(&free.momenta(), &known) else { return };
        let mut state = state.to_vec();
        state[n..n + values.len()].copy_from_slice(&values);
        let symbols = free.state_with(momenta);
        let place = (t, state.as_slice());
        if let Some(left_over) =
            divergence(graph, *density, (time, &symbols), free.parameters(), motion, place)
        {
            assert!(left_over <= VANISHES, "{name}: {left_over:e} of div ({density}) (ẋ, ẏ) at {state:?}");
            self.states += 1;
        }
    }
}
