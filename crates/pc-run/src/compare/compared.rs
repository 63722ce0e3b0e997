//! The motions of two models, each in a form of its own, integrated and compared.

use pc_model::Model;

use crate::compare::comparison::{Comparison, Question};
use crate::compare::difference::Verdict;
use crate::compare::error::CompareError;
use crate::error::RunError;
use crate::motion::integrate::Besides;
use crate::motion::run::Run;
use crate::observer::Observer;
use crate::plan::Plan;
use crate::plan::Wishes;

/// Two motions, compared.
#[derive(Debug)]
pub struct Compared {
    /// The motions.
    pub runs: [Run; 2],
    /// How the motions agree and differ.
    pub comparison: Comparison,
}

impl Compared {
    /// Integrates the motions of two models, each with a companion that tells its errors of integration, and compares them
    /// at the times of the first.
    ///
    /// # Errors
    /// [`CompareError`] if there is nothing to compare, and any error of a run. It is not an error if a
    /// motion fails: the motion is compared as far as it goes.
    pub fn of(
        models: [&Model; 2],
        wishes: [&Wishes; 2],
        question: &Question,
        observer: &dyn Observer,
    ) -> Result<Compared, RunError> {
        let first = Plan::of(models[0], wishes[0])?;
        let second = Plan::of(models[1], &Wishes { samples: Some(first.samples), ..wishes[1].clone() })?;
        if first.t_start != second.t_start {
            return Err(CompareError::Starts { first: first.t_start, second: second.t_start }.into());
        }
        let besides = Besides { verify: true, remarks: true, accuracy: true, ..Besides::default() };
        let run = |model: &Model, plan: Plan| {
            let run = Run::planned(model, plan, &besides, observer)?;
            match run.stopped() {
                Some(stopped) => Err(stopped),
                // Its companion was stopped.
                None if observer.is_stopped() => Err(RunError::Interrupted { t: run.reached() }),
                None => Ok(run),
            }
        };
        let (a, b) = (run(models[0], first)?, run(models[1], second)?);
        let comparison = Comparison::new(&a, &b, question)?;
        Ok(Compared { runs: [a, b], comparison })
    }

    /// An error unless both motions were completed and agree.
    ///
    /// # Errors
    /// [`CompareError::Different`], [`CompareError::Undecided`], or the error of a motion.
    pub fn outcome(self) -> Result<(), RunError> {
        let verdict = self.comparison.verdict();
        let (differences, untold) = (self.comparison.differing(), self.comparison.untold());
        let [a, b] = self.runs;
        a.outcome()?;
        b.outcome()?;
        match verdict {
            Verdict::Same => Ok(()),
            Verdict::Different => Err(CompareError::Different { differences }.into()),
            Verdict::Undecided => Err(CompareError::Undecided { columns: untold }.into()),
        }
    }
}
