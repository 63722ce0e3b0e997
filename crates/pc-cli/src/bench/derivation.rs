//! From the text of a model to machine code, stage by stage.

use std::time::Instant;

use pc_mech::{CompileOptions, VectorField};
use pc_model::{Document, Model, ModelError};

use crate::bench::kernels::Derived;
use crate::bench::measure::Times;

/// The stages: reading the text; frame, energies and constraints; equations in quasi-velocities;
/// programs of the right-hand side, its Jacobian and the observables; machine code of the
/// right-hand side with its first evaluation.
pub(crate) const STAGES: [&str; 5] = ["text", "system", "equations", "programs", "machine code"];

/// Milliseconds of each stage, and of all of them together.
#[derive(Clone, Debug, Default)]
pub(crate) struct Derivation {
    pub(crate) stages: [Times; STAGES.len()],
    pub(crate) total: Times,
}

impl Derivation {
    /// Derives the equations of a model once more.
    ///
    /// # Errors
    /// [`ModelError`], as for any command.
    pub(crate) fn repeat(&mut self, model: &Model) -> Result<(), ModelError> {
        let mut clock = Clock(Instant::now());
        let mut laps = [0.0; STAGES.len()];
        Document::parse(model.document().source.clone())?;
        laps[0] = clock.lap();
        let graph = model.graph();
        let assembly = model.assemble(&graph)?;
        laps[1] = clock.lap();
        let derived = Derived::new(model, &assembly)?;
        laps[2] = clock.lap();
        let mut motion = derived.compile(CompileOptions::default())?;
        laps[3] = clock.lap();
        let mut rates = vec![0.0; derived.start().len()];
        // Evaluations that fail are found by `Derived::variants`, before anything is timed.
        let _ = motion.rhs(assembly.t_start, derived.start(), &mut rates);
        laps[4] = clock.lap();
        for (times, lap) in self.stages.iter_mut().zip(laps) {
            times.push(lap);
        }
        self.total.push(laps.iter().sum());
        Ok(())
    }
}

/// A stopwatch.
struct Clock(Instant);

impl Clock {
    /// Milliseconds since the last lap.
    fn lap(&mut self) -> f64 {
        let now = Instant::now();
        let lap = now - self.0;
        self.0 = now;
        lap.as_secs_f64() * 1e3
    }
}
