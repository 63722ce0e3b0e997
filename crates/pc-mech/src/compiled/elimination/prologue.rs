//! What parameters alone determine, computed once for their values.

use std::sync::Arc;

use pc_expr::{Backend, Entry, Evaluator, Program};

/// A program without what the parameters alone determine, as regrouped masses: this is computed when they change.
#[derive(Clone, Debug)]
pub(crate) struct Prologue {
    of_parameters: Evaluator,
    rest: Evaluator,
    /// The parameters, then what is computed of them.
    numbers: Vec<f64>,
    /// The places of the parameters that may change at any time.
    varying: Vec<usize>,
    is_known: bool,
}

impl Prologue {
    /// Of a program of which the parameters in these places may change at any time; none where next to nothing is saved.
    pub(crate) fn of(program: &Program, varying: &[usize], backend: Backend) -> Option<Prologue> {
        let fixed: Vec<bool> = (0..program.parameters_len()).map(|i| !varying.contains(&i)).collect();
        let (of_parameters, rest) = program.hoisted(&fixed)?;
        Some(Prologue {
            numbers: vec![f64::NAN; rest.parameters_len()],
            of_parameters: Evaluator::new(of_parameters, Backend::Interpreter),
            rest: Evaluator::new(rest, backend),
            varying: varying.to_vec(),
            is_known: false,
        })
    }

    /// Says that the parameters may have changed.
    pub(crate) fn forget(&mut self) {
        self.is_known = false;
    }

    /// The places of the parameters that may change at any time.
    pub(crate) fn varying(&self) -> &[usize] {
        &self.varying
    }

    /// Number of parameters and of what is computed of them.
    pub(crate) fn parameters_len(&self) -> usize {
        self.numbers.len()
    }

    /// The parameters, then what is computed of them: what the rest takes for parameters.
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
    pub(crate) fn eval(&mut self, t: f64, y: &[f64], p: &[f64], outputs: &mut [f64]) {
        if !self.is_known {
            self.compute(p);
        }
        for &place in &self.varying {
            self.numbers[place] = p[place];
        }
        self.rest.eval(t, y, &self.numbers, outputs);
    }

    /// The rest, which takes [`numbers`](Prologue::numbers) for parameters.
    pub(crate) fn rest(&self) -> &Arc<Program> {
        self.rest.program()
    }

    /// The machine code of the rest, which takes [`numbers`](Prologue::numbers) for parameters.
    pub(crate) fn machine_code(&mut self) -> Option<(Entry, usize)> {
        self.rest.machine_code()
    }
}
