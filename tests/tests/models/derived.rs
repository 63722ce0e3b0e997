//! A model with what is derived from it.

use std::cell::{OnceCell, RefCell};

use pc_expr::{Expr, Inputs, Program};
use pc_mech::{Equations, Graph, MechError, Motion, System};
use pc_model::{Assembly, Document, Flow, Model, Source, Variables};
use pc_tests::classical::SplitMix64;

use crate::findings::Findings;

/// A model with what is derived from it, each thing once, when a claim asks for it first.
pub(crate) struct Derived<'g> {
    pub(crate) name: &'g str,
    pub(crate) model: &'g Model,
    pub(crate) graph: &'g Graph,
    pub(crate) assembly: Assembly<'g>,
    /// What claims find.
    pub(crate) findings: RefCell<Findings>,
    /// Poincaré's equations (9), or (30) of the free quasi-velocities.
    pub(crate) equations: Equations<'g>,
    equations_compiled: OnceCell<Motion>,
    free_system: OnceCell<System<'g>>,
    in_velocities: OnceCell<Result<Motion, MechError>>,
    motion: OnceCell<(Motion, Vec<f64>)>,
    flow: OnceCell<Flow>,
    program: OnceCell<Program>,
}

impl Derived<'_> {
    /// Derives the model of a text, has `claims` made of it, and answers what they do.
    ///
    /// # Panics
    /// If it cannot be derived, and where `claims` do.
    pub(crate) fn of<T>(name: &str, text: &str, claims: impl for<'g> FnOnce(&Derived<'g>) -> T) -> T {
        let document = Document::parse(Source::new(format!("{name}.toml"), text));
        let model = Model::new(document.unwrap_or_else(|error| panic!("{name}: {error}")));
        let graph = Graph::new();
        let assembly = model.assemble(&graph).unwrap_or_else(|error| panic!("{name}: {error}"));
        // First of all, so that they do not depend on what claims ask for: in a graph what was made before may be a shorter form of
        // what is made now, and is rounded otherwise.
        let equations = assembly.equations().unwrap_or_else(|error| panic!("{name}: {error}"));
        let derived = Derived {
            name,
            model: &model,
            graph: &graph,
            assembly,
            findings: RefCell::default(),
            equations,
            equations_compiled: OnceCell::new(),
            free_system: OnceCell::new(),
            in_velocities: OnceCell::new(),
            motion: OnceCell::new(),
            flow: OnceCell::new(),
            program: OnceCell::new(),
        };
        claims(&derived)
    }
}

impl<'g> Derived<'g> {
    /// The state (x, η) of these equations.
    pub(crate) fn state(&self) -> Vec<Expr<'g>> {
        let system = self.equations.system();
        [system.frame().coordinates(), system.quasi_velocities()].concat()
    }

    /// These equations, compiled without what is observed of the model.
    pub(crate) fn equations_compiled(&self) -> Motion {
        self.equations_compiled.get_or_init(|| self.equations.compile().unwrap()).clone()
    }

    /// The rates of (x, η) by these equations as a program of (t, x, η) and the parameters.
    pub(crate) fn program(&self) -> &Program {
        self.program.get_or_init(|| {
            let equations = &self.equations;
            let system = equations.system();
            let parameters = system.parameters().iter().map(|&(symbol, _)| symbol).collect();
            let inputs = Inputs { time: Some(system.frame().time()), state: self.state(), parameters };
            let rates = [equations.velocities(), &equations.accelerations()].concat();
            Program::new(self.graph, &inputs, &rates).unwrap()
        })
    }

    /// The system of the free quasi-velocities.
    pub(crate) fn free_system(&self) -> &System<'g> {
        self.free_system.get_or_init(|| self.assembly.free_system().unwrap())
    }

    /// What is made of the model assembled anew, in a graph of its own: as the program has it, and whatever claims ask for.
    pub(crate) fn anew<T>(&self, make: impl for<'h> FnOnce(&Assembly<'h>) -> T) -> T {
        let graph = Graph::new();
        make(&self.model.assemble(&graph).unwrap_or_else(|error| panic!("{error}")))
    }

    /// Lagrange's equations, compiled, with multipliers where there are constraints.
    pub(crate) fn in_velocities(&self) -> Result<Motion, &MechError> {
        let compiled = |assembly: &Assembly<'_>| match assembly.constraints.multipliers() {
            Some(multipliers) => multipliers.in_velocities()?.compile(),
            None => assembly.system.in_velocities()?.poincare()?.compile(),
        };
        match self.in_velocities.get_or_init(|| self.anew(compiled)) {
            Ok(motion) => Ok(motion.clone()),
            Err(error) => Err(error),
        }
    }

    /// The motion of the model with its start, as it is run.
    pub(crate) fn motion(&self) -> (Motion, Vec<f64>) {
        let assembly = &self.assembly;
        let compiled = || match assembly.constraints.held() {
            Some(_) => self.model.compile(assembly),
            None => {
                let start = assembly.start_of(&self.equations.system().state());
                self.model.compile_equations(&self.equations, assembly.t_start, start)
            }
        };
        self.motion.get_or_init(|| compiled().unwrap_or_else(|error| panic!("{error}"))).clone()
    }

    /// The motion of the model in its quasi-velocities, with its events and columns.
    pub(crate) fn flow(&self) -> Flow {
        let flow = || Flow::new(self.model, &self.assembly, Variables::QuasiVelocities);
        self.flow.get_or_init(|| flow().unwrap_or_else(|error| panic!("{error}"))).clone()
    }

    /// Numbers at random, the same on every run and others for each model.
    pub(crate) fn random(&self, seed: u64) -> SplitMix64 {
        SplitMix64::new(
            self.name.bytes().fold(seed, |seed, byte| seed.wrapping_mul(31).wrapping_add(byte.into())),
        )
    }

    /// Whether the model is among these.
    pub(crate) fn is_among(&self, names: &[&str]) -> bool {
        names.contains(&self.name)
    }
}
