//! The motions of two models, each in a form of its own, integrated and compared.

use pc_model::Model;

use crate::compare::comparison::{Comparison, Question};
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
    /// Integrates the motions of two models, and compares them at the times of the first. Where the motions differ,
    /// both are integrated once more at smaller tolerances, to distinguish different motions from errors of
    /// integration.
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
        let besides = Besides { verify: true, remarks: true, ..Besides::default() };
        let run = |model: &Model, plan: &Plan, besides: &Besides| {
            let run = Run::planned(model, plan.clone(), besides, observer)?;
            match run.stopped() {
                Some(stopped) => Err(stopped),
                None => Ok(run),
            }
        };
        let a = run(models[0], &first, &besides)?;
        let b = run(models[1], &second, &besides)?;
        let mut comparison = Comparison::new(&a, &b, None, question)?;
        if !comparison.is_same() {
            let finer =
                |model, plan: &Plan, of: &Run| run(model, &plan.finer(&of.tolerances), &Besides::default());
            // Where smaller tolerances cannot be met, there is nothing to tell errors by.
            if let Ok(c) = finer(models[0], &first, &a)
                && let Ok(d) = finer(models[1], &second, &b)
            {
                comparison = Comparison::new(&a, &b, Some((&c, &d)), question)?;
            }
        }
        Ok(Compared { runs: [a, b], comparison })
    }

    /// An error unless both motions were completed and agree.
    ///
    /// # Errors
    /// [`CompareError::Different`], or the error of a motion.
    pub fn outcome(self) -> Result<(), RunError> {
        let differences = self.comparison.differing();
        let [a, b] = self.runs;
        a.outcome()?;
        b.outcome()?;
        if differences.is_empty() { Ok(()) } else { Err(CompareError::Different { differences }.into()) }
    }
}
