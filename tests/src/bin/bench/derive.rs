//! `bench derive`: from the text of a model to its compiled motion.

use std::time::{Duration, Instant};

use pc_mech::{CompileOptions, Equations, Graph, VectorField};
use pc_model::{BUILTIN, Builtin, Model};

use crate::error::Error;
use crate::measure::Times;
use crate::report::{Report, triple};
use crate::systems;

/// Links of the pendulum.
const PENDULUM: usize = 16;
/// Most runs of a derivation.
const RUNS: usize = 150;
/// It gets no more runs once they took so long together.
const PATIENCE: Duration = Duration::from_secs(10);
const STAGES: [&str; 5] = ["parse", "assemble", "poincare", "compile", "first call"];

/// One derivation: milliseconds of each stage and of the Jacobian, and what came out.
struct Run {
    stages: [f64; STAGES.len()],
    jacobian: f64,
    nodes: usize,
    operations: usize,
}

/// A derivation with the times of its runs.
struct Derivation {
    name: String,
    run: Box<dyn Fn() -> Result<Run, Error>>,
    runs: Vec<Run>,
    spent: Duration,
}

impl Derivation {
    fn new(name: impl Into<String>, run: impl Fn() -> Result<Run, Error> + 'static) -> Derivation {
        Derivation { name: name.into(), run: Box::new(run), runs: Vec::new(), spent: Duration::ZERO }
    }

    fn times(&self, of: impl Fn(&Run) -> f64) -> Times {
        Times(self.runs.iter().map(of).collect())
    }
}

/// Times all built-in models and a long pendulum.
///
/// # Errors
/// [`Error`] of a model or system that is refused; none is to be expected.
pub(crate) fn run(report: &mut Report) -> Result<(), Error> {
    report.line(format!(
        "ms, as minimum / 10th percentile / median of up to {RUNS} runs ({} s at most), the models taking turns.\n\
         `parse`: text to document, `assemble`: to a system with its structure coefficients, `poincare`: to equations, \
         `compile`: to programs of right-hand side and observables, `first call`: of the right-hand side, for which \
         machine code is made; `total` of these.\n`Jacobian`: compiled with its Jacobian instead, up to the first call \
         of that; explicit methods need none.\n`nodes` were made in the graph by all of it; `operations` is the \
         cost of the right-hand side.\n",
        PATIENCE.as_secs()
    ));
    let mut derivations: Vec<Derivation> =
        BUILTIN.iter().map(|model| Derivation::new(model.name, || derive_model(model))).collect();
    derivations.push(Derivation::new(format!("pendulum of {PENDULUM} links (builder)"), || {
        let graph = Graph::new();
        let mut clock = Clock::new();
        let system = systems::pendulum(&graph, PENDULUM)?;
        let assemble = clock.lap();
        let start: Vec<f64> = (0..2 * PENDULUM).map(|i| 0.1 * i as f64).collect();
        let equations = system.poincare()?;
        let poincare = clock.lap();
        derive(&equations, [0.0, assemble, poincare], 0.0, &start, clock)
    }));
    for _ in 0..RUNS {
        for derivation in &mut derivations {
            if derivation.spent < PATIENCE {
                let start = Instant::now();
                derivation.runs.push((derivation.run)()?);
                derivation.spent += start.elapsed();
            }
        }
    }

    let columns: Vec<&str> = ["model", "runs", "nodes", "operations"]
        .into_iter()
        .chain(STAGES)
        .chain(["total", "Jacobian"])
        .collect();
    report.columns(&columns);
    for derivation in &derivations {
        let last = derivation.runs.last();
        let mut cells = vec![
            derivation.name.clone(),
            derivation.runs.len().to_string(),
            last.map_or_else(String::new, |run| run.nodes.to_string()),
            last.map_or_else(String::new, |run| run.operations.to_string()),
        ];
        cells.extend((0..STAGES.len()).map(|stage| triple(&derivation.times(|run| run.stages[stage]), 3)));
        cells.push(triple(&derivation.times(|run| run.stages.iter().sum()), 3));
        cells.push(triple(&derivation.times(|run| run.jacobian), 3));
        report.row(&cells);
    }
    Ok(())
}

/// A stopwatch.
struct Clock(Instant);

impl Clock {
    fn new() -> Clock {
        Clock(Instant::now())
    }

    /// Milliseconds since the last lap.
    fn lap(&mut self) -> f64 {
        let now = Instant::now();
        let lap = now - self.0;
        self.0 = now;
        lap.as_secs_f64() * 1e3
    }
}

fn derive_model(builtin: &Builtin) -> Result<Run, Error> {
    let mut clock = Clock::new();
    let model = Model::new(builtin.document()?);
    let parse = clock.lap();
    let graph = Graph::new();
    let assembly = model.assemble(&graph)?;
    let assemble = clock.lap();
    let equations = assembly.equations()?;
    let poincare = clock.lap();
    let system = equations.system();
    let state = [system.frame().coordinates(), system.quasi_velocities()].concat();
    derive(&equations, [parse, assemble, poincare], assembly.t_start, &assembly.start_of(&state), clock)
}

fn derive(
    equations: &Equations<'_>,
    [parse, assemble, poincare]: [f64; 3],
    t: f64,
    start: &[f64],
    mut clock: Clock,
) -> Result<Run, Error> {
    let mut motion = equations.compile_for(CompileOptions::default().jacobian(false))?;
    let compile = clock.lap();
    let mut rates = vec![0.0; start.len()];
    motion.rhs(t, start, &mut rates)?;
    let first_call = clock.lap();
    let nodes = equations.system().graph().len();
    let mut motion = equations.compile()?;
    let mut jacobian = vec![0.0; start.len() * start.len()];
    motion.jacobian(t, start, &mut jacobian)?;
    Ok(Run {
        stages: [parse, assemble, poincare, compile, first_call],
        jacobian: clock.lap(),
        nodes,
        operations: motion.cost().total(),
    })
}
