//! Values that depend on parameters alone, computed once.

use std::sync::Arc;

use pc_expr::{Backend, Entry, Evaluator, Program};
use serde::{Deserialize, Serialize};

/// A program divided into two parts: the first depends on parameters alone, such as regrouped masses, and
/// runs when they change; the second is the rest.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Prologue {
    of_parameters: Evaluator,
    rest: Evaluator,
    /// The parameters, then the results of the first part.
    numbers: Vec<f64>,
    /// The indices of parameters that may change at each evaluation.
    varying: Vec<usize>,
    is_known: bool,
}

impl Prologue {
    /// Divides a program whose parameters with these indices may change at each evaluation, and that has so many
    /// leading outputs; `None` if the division saves next to nothing.
    pub(crate) fn of(
        program: &Program,
        varying: &[usize],
        backend: Backend,
        leading: usize,
    ) -> Option<Prologue> {
        let fixed: Vec<bool> = (0..program.parameters_len()).map(|i| !varying.contains(&i)).collect();
        let (of_parameters, rest) = program.hoisted(&fixed)?;
        Some(Prologue {
            numbers: vec![f64::NAN; rest.parameters_len()],
            of_parameters: Evaluator::new(of_parameters, Backend::Interpreter),
            rest: Evaluator::with_leading(rest, backend, leading),
            varying: varying.to_vec(),
            is_known: false,
        })
    }

    /// Announces that the parameters may have changed.
    pub(crate) fn forget(&mut self) {
        self.is_known = false;
    }

    /// The indices of parameters that may change at each evaluation.
    pub(crate) fn varying(&self) -> &[usize] {
        &self.varying
    }

    /// The number of parameters plus the number of results of the first part.
    pub(crate) fn parameters_len(&self) -> usize {
        self.numbers.len()
    }

    /// The parameters, then the results of the first part: the parameters of the rest.
    pub(crate) fn numbers(&mut self, p: &[f64]) -> &[f64] {
        if !self.is_known {
            self.compute(p);
        }
        &self.numbers
    }

    #[cold]
    fn compute(&mut self, p: &[f64]) {
        let (parameters, computed) = self.numbers.split_at_mut(p.len());
        parameters.copy_from_slice(p);
        self.of_parameters.eval(0.0, &[], p, computed);
        self.is_known = true;
    }

    #[inline]
    pub(crate) fn eval_leading(
        &mut self,
        t: f64,
        y: &[f64],
        p: &[f64],
        leading: &mut [f64],
    ) -> (&[f64], bool) {
        if !self.is_known {
            self.compute(p);
        }
        for &place in &self.varying {
            self.numbers[place] = p[place];
        }
        self.rest.eval_leading(t, y, &self.numbers, leading)
    }

    /// The second part, which takes [`numbers`](Prologue::numbers) as its parameters.
    pub(crate) fn rest(&self) -> &Arc<Program> {
        self.rest.program()
    }

    /// The machine code of the second part, which takes [`numbers`](Prologue::numbers) as its parameters.
    pub(crate) fn machine_code(&mut self) -> Option<(Entry, usize)> {
        self.rest.machine_code()
    }
}
