//! Equations of motion as C or Rust source without dependencies.

use pc_expr::{Chain, ChainLayout, Expr, FunctionBody, Language, Layout, Place, Program, Slot};

use crate::compiled::elimination::symbolic_ldl::Factors;
use crate::compiled::first_order::{FirstOrder, Linearised};
use crate::emit::function::SourceFunction;
use crate::emit::source::{EmitOptions, EmittedFile, Extent, Routine, Source};
use crate::emit::{c, rust};
use crate::equations::poincare::Equations;
use crate::error::{MechError, ShapeError};

/// If the number of operations of a right-hand side times the length of the state exceeds this, the Jacobian
/// has some ten thousand operations: too many to read, and enough to keep a compiler busy for minutes.
const LONG_JACOBIAN: usize = 30_000;

/// Equations longer than this are left out of the comment at the head of a file.
const LONG_EQUATION: usize = 160;

impl<'g> Equations<'g> {
    /// The equations as source code: ẏ of y = (x, η), its Jacobian, the mass matrix, the energy, the integrals and the
    /// outputs, each one straight-line function of (t, y, p) with the parameters p as run-time arguments. If the
    /// right-hand side is so long that its Jacobian would have some ten thousand operations, then the right-hand side,
    /// the mass matrix and the energy are computed from a table of operations instead, and the Jacobian by the chain
    /// rule.
    ///
    /// C source consists of a header and a source file, Rust source of one file. Each file explains its use at its
    /// head. The same system, built in a new graph, gives the same source text. The operations are those of a
    /// [`Program`] of the same expressions, so that the values agree with those of the interpreter to the last bit
    /// where the mathematical library is the same.
    ///
    /// ```
    /// use pc_mech::{EmitOptions, Graph, Language, System};
    ///
    /// let graph = Graph::new();
    /// let g = graph.symbol("g");
    /// let pendulum = System::builder(&graph)
    ///     .parameter(g, 9.81)
    ///     .coordinates(["θ"])
    ///     .lagrangian(|_, x, v| v[0].square() / 2.0 + g * x[0].cos())
    ///     .build()?;
    /// let options = EmitOptions::new(Language::C, "pendulum").start(0.0, &[1.0, 0.0], 10.0);
    /// let files = pendulum.poincare()?.emit(&options)?;
    /// assert_eq!([&files[0].name, &files[1].name], ["pendulum.h", "pendulum.c"]);
    /// assert!(files[1].text.contains("    ydot[1] = -g*sin(theta); /* θ'' */\n"));
    /// # Ok::<(), pc_mech::MechError>(())
    /// ```
    ///
    /// # Errors
    /// [`ShapeError`] if the initial state has the wrong length,
    /// [`ExprError::UnboundSymbol`](crate::ExprError::UnboundSymbol) for a symbol that is neither state nor declared
    /// parameter.
    pub fn emit(&self, options: &EmitOptions) -> Result<Vec<EmittedFile>, MechError> {
        self.emit_with(options, &[])
    }

    /// The equations as source code, as [`emit`](Equations::emit) writes them, with further functions.
    ///
    /// # Errors
    /// As for [`emit`](Equations::emit).
    pub fn emit_with(
        &self,
        options: &EmitOptions,
        functions: &[SourceFunction<'g>],
    ) -> Result<Vec<EmittedFile>, MechError> {
        let source = self.source(options, functions)?;
        Ok(match options.language {
            Language::C => c::files(&source),
            Language::Rust => rust::files(&source),
        })
    }

    /// Whether derivatives of the right-hand side are too long to be written out, in which case
    /// [`emit`](Equations::emit) does not write them out. The derivatives in a
    /// [directional](SourceFunction::directional) function would then also take a compiler minutes.
    ///
    /// # Errors
    /// As for [`emit`](Equations::emit).
    pub fn has_long_derivatives(&self) -> Result<bool, MechError> {
        let system = self.first_order();
        let solved = Solved::new(self, &system);
        is_long(&system, &solved)
    }

    fn source<'a>(
        &self,
        options: &'a EmitOptions,
        functions: &[SourceFunction<'g>],
    ) -> Result<Source<'a>, MechError> {
        let system = &self.system;
        let names = |symbols: &[Expr<'g>]| symbols.iter().map(Expr::to_string).collect::<Vec<_>>();
        let of = |list: &[(String, Expr<'g>)]| list.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>();
        let state = names(&self.first_order().state);
        if let Some(start) = &options.start
            && start.state.len() != state.len()
        {
            let (found, expected) = (start.state.len(), state.len());
            return Err(ShapeError { what: "the start state", found, expected }.into());
        }
        let writer = Writer::new(self.first_order(), options);
        let solved = Solved::new(self, &writer.system);
        let shared = self.shared(&writer, &solved)?;
        let mut routines = self.routines(&writer, &solved, shared.as_ref())?;
        for function in functions {
            routines.push(self.function(&writer, &solved, function)?);
        }
        Ok(Source {
            options,
            name: options.language.identifiers(&[&options.name], &[]).remove(0),
            state,
            coordinates: system.frame.coordinates().len(),
            states: system.states.len(),
            parameters: system
                .run_time_inputs()
                .into_iter()
                .map(|(symbol, value)| (symbol.to_string(), value))
                .collect(),
            integrals: of(&system.integrals),
            outputs: of(&system.outputs),
            equations: self.equations_as_text(),
            routines,
            shared: shared.map(|(chain, _)| chain),
        })
    }

    fn equations_as_text(&self) -> Vec<String> {
        let graph = self.system.graph();
        let rates = self.system.accelerations();
        let kinematic = self.system.frame.coordinates().iter().zip(self.velocities());
        let mut lines: Vec<String> = kinematic.map(|(x, velocity)| format!("{x}' = {velocity}")).collect();
        for (s, right) in self.right_hand_side().iter().enumerate() {
            let left = graph.dot(self.mass_matrix().row(s).iter().copied(), rates.iter().copied());
            lines.push(format!("{left} = {right}"));
        }
        lines.extend(self.system.states.iter().map(|(z, rate)| format!("{z}' = {rate}")));
        let short = lines.iter().all(|line| line.chars().count() <= LONG_EQUATION);
        if short { lines } else { Vec::new() }
    }

    /// The table for a right-hand side whose Jacobian would be too long if written as statements: its
    /// operations, with those of the mass matrix and of the energy.
    fn shared(
        &self,
        writer: &Writer<'_, 'g>,
        solved: &Solved<'g>,
    ) -> Result<Option<(Chain, Program)>, MechError> {
        let (graph, inputs) = (self.system.graph(), writer.system.inputs(&[]));
        if !writer.options.jacobian || writer.options.fused || !is_long(&writer.system, solved)? {
            return Ok(None);
        }
        let columns = (0..self.mass_matrix().rows()).flat_map(|s| self.mass_matrix().column(s));
        let outputs: Vec<Expr<'g>> =
            solved.motion.iter().copied().chain(columns).chain([self.energy()]).collect();
        let program = Program::new(graph, &inputs, &outputs)?;
        let layout = match writer.options.language {
            Language::C => {
                let capitals = writer.prefix.to_uppercase();
                let (dim, parameters) = (format!("{capitals}DIM"), format!("{capitals}PARAMETERS"));
                ChainLayout { prefix: writer.prefix.clone(), dim, parameters }
            }
            Language::Rust => {
                let (dim, parameters) = ("DIM".to_owned(), "PARAMETERS".to_owned());
                ChainLayout { prefix: String::new(), dim, parameters }
            }
        };
        Ok(program.chain(writer.options.language, layout).map(|chain| (chain, program)))
    }

    fn routines(
        &self,
        writer: &Writer<'_, 'g>,
        solved: &Solved<'g>,
        shared: Option<&(Chain, Program)>,
    ) -> Result<Vec<Routine>, MechError> {
        let system = &self.system;
        let graph = system.graph();
        let k = system.quasi_velocities.len();
        let state: Vec<String> = writer.system.state.iter().map(Expr::to_string).collect();
        let dim = state.len();
        let rates: Vec<String> = state.iter().map(|name| format!("{name}'")).collect();
        let Solved { factors, accelerations, motion } = solved;
        let of_chain = |statements: String| FunctionBody { statements, ..FunctionBody::default() };

        let mut routines = vec![writer.routine(
            "rhs",
            match system.states.as_slice() {
                [] => "`ydot` = dy/dt: the velocities of the coordinates, then the accelerations".to_owned(),
                _ => "`ydot` = dy/dt: the velocities of the coordinates, the accelerations, then the rates of the first-order                       states"
                    .to_owned(),
            },
            ("ydot", Extent::State),
            motion,
            |i| (format!("[{i}]"), rates[i].clone()),
        )?];
        if writer.options.jacobian {
            let purpose =
                format!("the Jacobian of `rhs`, column after column: `jac[i + {dim}*j] = ∂ydot[i]/∂y[j]`");
            routines.push(match shared {
                Some((chain, program)) => {
                    let body = of_chain(chain.jacobian(program, "jac"));
                    Routine {
                        name: "jacobian".to_owned(),
                        purpose,
                        array: "jac",
                        extent: Extent::StateSquared,
                        directional: false,
                        sparse: false,
                        body,
                    }
                }
                None => {
                    let linearised = Linearised::new(&writer.system, factors, accelerations);
                    let mut jacobian = vec![Expr::ZERO; dim * dim];
                    for (j, column) in linearised.columns(&writer.system.state).into_iter().enumerate() {
                        column.into_iter().for_each(|(i, entry)| jacobian[i + dim * j] = entry);
                    }
                    let slot = |e: usize| {
                        let (i, j) = (e % dim, e / dim);
                        (format!("[{i} + {dim}*{j}]"), format!("∂{}/∂{}", rates[i], state[j]))
                    };
                    writer.routine("jacobian", purpose, ("jac", Extent::StateSquared), &jacobian, slot)?
                }
            });
        }
        let purpose = format!(
            "the symmetric mass matrix of the quasi-velocities, row r of column s in `mass[r + {k}*s]`"
        );
        let energy = "the energy, sum of quasi-velocities times momenta less the Lagrangian".to_owned();
        if let Some((chain, _)) = shared {
            let (array, extent, sparse) = ("mass", Extent::QuasiVelocitiesSquared, false);
            let body = of_chain(chain.values(array, dim, k * k));
            let (name, directional) = ("mass_matrix".to_owned(), false);
            routines.push(Routine { name, purpose, array, extent, directional, sparse, body });
            let body = of_chain(chain.value(dim + k * k));
            let (name, purpose, array, extent) = ("energy".to_owned(), energy, "", Extent::One);
            routines.push(Routine { name, purpose, array, extent, directional, sparse, body });
        } else {
            let columns: Vec<Expr<'g>> = (0..k).flat_map(|s| self.mass_matrix().column(s)).collect();
            let slot = |e: usize| (format!("[{} + {k}*{}]", e % k, e / k), String::new());
            let extent = Extent::QuasiVelocitiesSquared;
            routines.push(writer.routine("mass_matrix", purpose, ("mass", extent), &columns, slot)?);
            let slot = |_| Default::default();
            routines.push(writer.routine("energy", energy, ("", Extent::One), &[self.energy()], slot)?);
        }
        let watched = [
            ("integrals", "integrals", Extent::Integrals, &system.integrals),
            ("outputs", "outputs", Extent::Outputs, &system.outputs),
        ];
        let rates: Vec<_> = system.accelerations().into_iter().zip(accelerations.iter().copied()).collect();
        for (name, what, extent, list) in watched.into_iter().filter(|(.., list)| !list.is_empty()) {
            let names: Vec<&str> = list.iter().map(|(name, _)| name.as_str()).collect();
            let values: Vec<Expr<'g>> = list.iter().map(|&(_, value)| value).collect();
            routines.push(writer.routine(
                name,
                format!(
                    "the {what}: {}",
                    names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
                ),
                ("values", extent),
                &graph.substitute(&values, &rates),
                |i| (format!("[{i}]"), names[i].to_owned()),
            )?);
        }
        Ok(routines)
    }

    fn function(
        &self,
        writer: &Writer<'_, 'g>,
        solved: &Solved<'g>,
        function: &SourceFunction<'g>,
    ) -> Result<Routine, MechError> {
        let system = &self.system;
        let names: Vec<String> = function.values.iter().map(|(name, _)| name.clone()).collect();
        let values: Vec<Expr<'g>> = function.values.iter().map(|&(_, value)| value).collect();
        let (name, purpose) = (&function.name, function.purpose.clone());
        if function.is_directional {
            let symbols = writer.system.state.iter().copied().chain(writer.system.parameter_symbols());
            let symbols: Vec<Expr<'g>> = symbols.collect();
            let seeds = writer.system.fresh("d", &symbols);
            let direction: Vec<_> = symbols.into_iter().zip(seeds.iter().copied()).collect();
            let observing = FirstOrder {
                rates: writer.system.rates.iter().chain(&values).copied().collect(),
                ..writer.system.clone()
            };
            let along = Linearised::new(&observing, &solved.factors, &solved.accelerations).along(&direction);
            let what: Vec<String> =
                writer.system.state.iter().map(|name| format!("{name}'")).chain(names).collect();
            let extent = Extent::Count(along.len());
            let slot = |i: usize| (format!("[{i}]"), format!("along: {}", what[i]));
            return writer.routine_along(&seeds, name, purpose, ("values", extent), &along, slot);
        }
        let rates: Vec<_> =
            system.accelerations().into_iter().zip(solved.accelerations.iter().copied()).collect();
        let (values, extent) = (system.graph().substitute(&values, &rates), Extent::Count(values.len()));
        let slot = |i: usize| (format!("[{i}]"), names[i].clone());
        writer.routine(name, purpose, ("values", extent), &values, slot)
    }
}

/// Whether the Jacobian of the right-hand side would be too long to read.
fn is_long<'g>(system: &FirstOrder<'g>, solved: &Solved<'g>) -> Result<bool, MechError> {
    let inputs = system.inputs(&[]);
    let operations = Program::new(system.graph, &inputs, &solved.motion)?.code().len();
    Ok(operations * inputs.state.len() > LONG_JACOBIAN)
}

/// The rates, solved for the accelerations.
struct Solved<'g> {
    factors: Factors<'g>,
    accelerations: Vec<Expr<'g>>,
    /// ẋ, η̇, ż
    motion: Vec<Expr<'g>>,
}

impl<'g> Solved<'g> {
    fn new(equations: &Equations<'g>, first_order: &FirstOrder<'g>) -> Solved<'g> {
        let system = &equations.system;
        let factors = Factors::of(system.graph(), equations.mass_matrix());
        let accelerations = first_order.solve(&factors);
        let of_states = system.states.iter().map(|(_, rate)| rate);
        let motion = equations.velocities().iter().chain(&accelerations).chain(of_states).copied().collect();
        Solved { factors, accelerations, motion }
    }
}

/// Prints programs that have the same inputs.
struct Writer<'a, 'g> {
    system: FirstOrder<'g>,
    options: &'a EmitOptions,
    inputs: Vec<String>,
    prefix: String,
    /// Names that local variables must not have.
    reserved: Vec<String>,
}

impl<'a, 'g> Writer<'a, 'g> {
    fn new(system: FirstOrder<'g>, options: &'a EmitOptions) -> Writer<'a, 'g> {
        let inputs = system.inputs(&[]);
        let names: Vec<String> = inputs.state.iter().chain(&inputs.parameters).map(Expr::to_string).collect();
        let language = options.language;
        let name = language.identifiers(&[&options.name], &[]).remove(0);
        let mut reserved = match language {
            Language::C => c::macros(&name),
            Language::Rust => rust::CONSTANTS.iter().map(|&name| name.to_owned()).collect(),
        };
        reserved.extend(["ydot", "jac", "mass", "values"].map(str::to_owned));
        let inputs = language.identifiers(&names, &reserved.iter().map(String::as_str).collect::<Vec<_>>());
        Writer { system, options, inputs, prefix: name + "_", reserved }
    }

    /// A function with the given name and purpose that writes the given array; `slot` gives the index of each
    /// output in the array and its meaning.
    fn routine(
        &self,
        name: &str,
        purpose: String,
        (array, extent): (&'static str, Extent),
        values: &[Expr<'g>],
        slot: impl Fn(usize) -> (String, String),
    ) -> Result<Routine, MechError> {
        self.routine_along(&[], name, purpose, (array, extent), values, slot)
    }

    /// Like [`routine`](Self::routine), but with these symbols for a direction after the parameters.
    fn routine_along(
        &self,
        direction: &[Expr<'g>],
        name: &str,
        purpose: String,
        (array, extent): (&'static str, Extent),
        values: &[Expr<'g>],
        slot: impl Fn(usize) -> (String, String),
    ) -> Result<Routine, MechError> {
        let language = self.options.language;
        let mut inputs = self.system.inputs(&[]);
        inputs.parameters.extend_from_slice(direction);
        let mut program = Program::new(self.system.graph, &inputs, values)?;
        if self.options.fused {
            program = program.fused();
        }
        let slots: Vec<(String, String)> = (0..values.len()).map(slot).collect();
        let is_matrix = matches!(extent, Extent::StateSquared | Extent::QuasiVelocitiesSquared);
        let locals = match is_matrix || extent == Extent::One {
            true => vec![String::new(); slots.len()],
            false => language.identifiers(&slots.iter().map(|(_, what)| what).collect::<Vec<_>>(), &[array]),
        };
        let identifiers = match direction {
            [] => self.inputs.clone(),
            _ => {
                let symbols = inputs.state.iter().chain(&inputs.parameters);
                let reserved: Vec<&str> = self.reserved.iter().map(String::as_str).collect();
                language.identifiers(&symbols.map(Expr::to_string).collect::<Vec<_>>(), &reserved)
            }
        };
        let place = |index: &str| match extent {
            Extent::One => Place::Returned,
            _ => Place::Entry(format!("{array}{index}")),
        };
        let layout = Layout {
            inputs: identifiers,
            slots: slots
                .iter()
                .zip(locals)
                .map(|((index, what), local)| Slot { place: place(index), comment: what.clone(), local })
                .collect(),
            skip_zeros: is_matrix,
            prefix: self.prefix.clone(),
            reserved: self.reserved.clone(),
        };
        let sparse = is_matrix && values.iter().any(|value| value.is_zero());
        let (name, directional) = (name.to_owned(), !direction.is_empty());
        Ok(Routine {
            name,
            purpose,
            array,
            extent,
            directional,
            sparse,
            body: program.emit(language, &layout),
        })
    }
}
