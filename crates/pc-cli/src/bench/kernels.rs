//! The ways to evaluate the equations of a model.

use std::sync::Arc;

use pc_mech::{Backend, CompileOptions, Equations, Motion, Multipliers, Signals, VectorField};
use pc_model::{Assembly, Model, ModelError};

use crate::bench::measure::Variant;

/// Equations of motion that can be compiled.
enum Form<'a, 'g> {
    Independent(Box<Equations<'g>>),
    Multipliers(&'a Multipliers<'g>),
}

/// The equations of a model in quasi-velocities, held on its constraints by multipliers where `pc run` does so.
pub(crate) struct Derived<'a, 'g> {
    assembly: &'a Assembly<'g>,
    form: Form<'a, 'g>,
    start: Vec<f64>,
    signals: Signals,
}

impl<'a, 'g> Derived<'a, 'g> {
    /// # Errors
    /// [`ModelError`] where there are none.
    pub(crate) fn new(model: &Model, assembly: &'a Assembly<'g>) -> Result<Derived<'a, 'g>, ModelError> {
        let (form, start) = match assembly.constraints.held() {
            Some(held) => (Form::Multipliers(held), assembly.start.clone()),
            None => {
                let equations = assembly.equations()?;
                let start = assembly.start_of(&equations.system().state());
                (Form::Independent(Box::new(equations)), start)
            }
        };
        let names: Vec<&str> = model.parameters().map(|(name, _)| name).collect();
        let tables = model.parameter_values().tables().into_iter();
        let signals = Signals::new(tables.map(|(place, table)| (names[place], place, Arc::clone(table))));
        Ok(Derived { assembly, form, start, signals })
    }

    /// The state at the start.
    pub(crate) fn start(&self) -> &[f64] {
        &self.start
    }

    /// The motion as `pc run` integrates it, with these options of the kernel.
    ///
    /// # Errors
    /// [`ModelError`] where it cannot be compiled.
    pub(crate) fn compile(&self, options: CompileOptions) -> Result<Motion, ModelError> {
        let motion = match &self.form {
            Form::Independent(equations) => self.assembly.placed(equations.compile_for(options)),
            Form::Multipliers(multipliers) => self.assembly.placed(multipliers.compile_for(options)),
        };
        Ok(motion?.driven_by(self.signals.clone()))
    }

    /// The same with the parameters replaced by their values; none where multipliers hold
    /// constraints or inputs have tables.
    fn bound(&self) -> Result<Option<Motion>, ModelError> {
        match &self.form {
            Form::Independent(equations) if self.signals.is_empty() => {
                let equations = equations.with_parameters_bound();
                self.assembly.placed(equations.compile_for(CompileOptions::default())).map(Some)
            }
            _ => Ok(None),
        }
    }

    /// All ways to evaluate the equations that work at the start.
    ///
    /// # Errors
    /// [`ModelError`] where they cannot be compiled.
    pub(crate) fn variants(&self) -> Result<Vec<Variant<'static>>, ModelError> {
        let (t, n) = (self.assembly.t_start, self.start.len());
        let rates = |name, mut motion: Motion| Variant {
            name,
            operations: Some(motion.cost().total()),
            outputs: n,
            call: Box::new(move |y: &[f64], rates: &mut [f64]| motion.rhs(t, y, rates).is_ok()),
        };
        let motion = self.compile(CompileOptions::default())?;
        let (mut by_state, mut watched) = (motion.clone(), motion.clone());
        let observables = watched.observable_names().len();
        let mut variants = vec![
            rates("right-hand side, interpreted", self.compile(Backend::Interpreter.into())?),
            rates("right-hand side, machine code", motion),
        ];
        variants.extend(self.bound()?.map(|motion| rates("right-hand side, parameters bound", motion)));
        variants.push(Variant {
            name: "Jacobian, machine code",
            operations: None,
            outputs: n * n,
            call: Box::new(move |y, jacobian| by_state.jacobian(t, y, jacobian).is_ok()),
        });
        variants.push(Variant {
            name: "integrals, energy, outputs",
            operations: None,
            outputs: observables,
            call: Box::new(move |y, values| {
                watched.observe_to(t, y, values);
                true
            }),
        });
        variants.retain_mut(|variant| {
            let mut outputs = vec![0.0; variant.outputs];
            (variant.call)(&self.start, &mut outputs)
        });
        Ok(variants)
    }
}
