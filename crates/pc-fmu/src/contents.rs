//! What an FMU is made of: its variables, and the functions of (t, y, p) that compute them.

use pc_expr::{Direction, Expr};
use pc_mech::{Equations, SourceFunction};
use pc_model::{Assembly, FreeForm, Model, Variables};

use crate::error::FmuError;
use crate::events::{FmuEvent, events};

/// The value reference of the first state, after that of time.
pub(crate) const OF_STATES: usize = 1;

/// A component of the state.
pub(crate) struct State<'g> {
    pub(crate) name: String,
    /// Whether it is a column of a table of the model.
    pub(crate) is_column: bool,
    /// Its start, a function of parameters.
    pub(crate) start: Expr<'g>,
    /// The number that the start is, if it is one.
    pub(crate) number: Option<f64>,
}

/// What a parameter of the equations is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ParameterKind {
    Given,
    Follows,
    Input,
}

/// A parameter of the equations.
pub(crate) struct Parameter<'g> {
    pub(crate) name: String,
    pub(crate) symbol: Expr<'g>,
    pub(crate) value: f64,
    pub(crate) kind: ParameterKind,
}

/// A function that the motion is kept at.
pub(crate) struct Kept<'g> {
    pub(crate) name: String,
    pub(crate) function: Expr<'g>,
    /// Whether it is zero, as a constraint is, and not what it was at the start.
    pub(crate) is_constraint: bool,
}

/// The derivative of something by a parameter, by their places.
pub(crate) struct Slope<'g> {
    pub(crate) of: usize,
    pub(crate) by: usize,
    pub(crate) value: Expr<'g>,
}

/// All of it.
pub(crate) struct Contents<'g> {
    pub(crate) equations: Equations<'g>,
    /// Their symbols and what they are.
    pub(crate) accelerations: Vec<(Expr<'g>, Expr<'g>)>,
    pub(crate) time: Expr<'g>,
    pub(crate) symbols: Vec<Expr<'g>>,
    pub(crate) states: Vec<State<'g>>,
    pub(crate) parameters: Vec<Parameter<'g>>,
    /// Parameters that follow others, by their places.
    pub(crate) calculated: Vec<(usize, Expr<'g>)>,
    /// What is observed beside the state.
    pub(crate) observed: Vec<(String, Expr<'g>)>,
    pub(crate) events: Vec<FmuEvent<'g>>,
    pub(crate) kept: Vec<Kept<'g>>,
    pub(crate) guards: Vec<Expr<'g>>,
    /// Whether the parameters stay as they are at the start, since what the motion is kept at depends on them.
    pub(crate) is_fixed: bool,
    /// Whether there are derivatives along directions; those of long equations would take compilers minutes.
    pub(crate) has_derivatives: bool,
    /// What a reader has to know.
    pub(crate) notes: Vec<String>,
}

impl<'g> Contents<'g> {
    /// That of the equations of a model in these variables, which are no momenta.
    ///
    /// # Errors
    /// [`FmuError`] for what an FMU cannot do.
    pub(crate) fn new(
        model: &Model,
        assembly: &Assembly<'g>,
        variables: Variables,
    ) -> Result<Contents<'g>, FmuError> {
        let (equations, form) = assembly.equations_of(variables)?;
        let (system, whole) = (equations.system().clone(), &assembly.system);
        if let Some((on, _)) = system.external_forces().first() {
            return Err(FmuError::ExternalForce { on: on.clone() });
        }
        let graph = system.graph();
        let all = assembly.quasi_velocities_of(&form.independent)?;
        let values: Vec<_> = form.independent.iter().copied().zip(form.values.iter().copied()).collect();
        let all = graph.substitute(&all, &values);
        let known: Vec<_> = whole.quasi_velocities().iter().copied().zip(all).collect();

        let symbols = system.state();
        let declared = &known[..assembly.declared];
        let mut observed: Vec<(String, Expr<'g>)> = declared
            .iter()
            .filter(|(eta, _)| !symbols.contains(eta))
            .map(|&(eta, value)| (eta.to_string(), value))
            .collect();
        observed.extend(system.integrals().iter().cloned());
        observed.push(("energy".to_owned(), equations.energy()));
        observed.extend(system.outputs().iter().cloned());

        let calculated = assembly.parameter_formulas(model)?;
        let mut notes = Vec::new();
        let parameters = parameters(model, &system, &calculated, &mut notes);
        let starts = assembly.start_formulas(model, &form)?;
        let is_column = |symbol: &Expr<'g>| {
            whole.frame().coordinates().contains(symbol)
                || declared.iter().any(|(eta, _)| eta == symbol)
                || whole.states().iter().any(|(z, _)| z == symbol)
        };
        let states = symbols.iter().zip(starts).map(|(symbol, start)| {
            let number = graph
                .symbols_of(&[start])
                .is_empty()
                .then(|| graph.evaluate::<f64>(&[start], &[]).map_or(f64::NAN, |values| values[0]));
            State { name: symbol.to_string(), is_column: is_column(symbol), start, number }
        });
        let guards = assembly.chart_determinants(&form);
        if guards.contains(&None) {
            notes.push(
                "An FMU does not see where the quasi-velocities of this form cease to determine the velocities: their \
                 determinant is too long to be watched."
                    .to_owned(),
            );
        }
        let kept = kept(model, assembly, &equations, &form, &known, &mut notes);
        let has_derivatives = !assembly.placed(equations.has_long_derivatives())?;
        let is_given = |parameter: &Parameter<'g>| parameter.kind != ParameterKind::Input;
        let is_fixed = parameters
            .iter()
            .filter(|parameter| is_given(parameter))
            .any(|parameter| kept.iter().any(|kept| kept.function.depends_on(parameter.symbol)));
        if model.document().simulation.t_end.as_ref().is_some_and(|end| end.value < assembly.t_start) {
            notes.push(
                "The motion of the model goes back in time, an FMU forward: it has no stop time.".to_owned(),
            );
        }
        let accelerations: Vec<_> =
            system.accelerations().into_iter().zip(equations.accelerations()).collect();
        let forces = match assembly.has_events_on_reactions() {
            true => assembly.forces_of_contacts(),
            false => Vec::new(),
        };
        let force = |(name, symbol): (String, Expr<'g>)| {
            let (_, value) = system.outputs().iter().find(|(output, _)| *output == name)?;
            Some((symbol, graph.substitute(&[*value], &accelerations)[0]))
        };
        let forces: Vec<_> = forces.into_iter().filter_map(force).collect();
        Ok(Contents {
            accelerations,
            is_fixed,
            has_derivatives,
            events: events(assembly, &form, &known, &forces)?,
            time: system.frame().time(),
            states: states.collect(),
            symbols,
            parameters,
            calculated,
            observed,
            kept,
            guards: guards.into_iter().flatten().collect(),
            notes,
            equations,
        })
    }

    /// The value reference of the first parameter, after states and rates.
    pub(crate) fn of_parameters(&self) -> usize {
        OF_STATES + 2 * self.states.len()
    }

    /// The rates of the states, with accelerations that are solved.
    pub(crate) fn rates(&self) -> Vec<Expr<'g>> {
        let velocities = self.equations.velocities().iter().copied();
        let of_states = self.equations.system().states().iter().map(|&(_, rate)| rate);
        let accelerations = self.accelerations.iter().map(|&(_, value)| value);
        velocities.chain(accelerations).chain(of_states).collect()
    }

    /// The derivatives of parameters that follow others.
    pub(crate) fn calculated_slopes(&self) -> Vec<Slope<'g>> {
        self.slopes(self.calculated.iter().copied())
    }

    /// The derivatives of the start by parameters.
    pub(crate) fn start_slopes(&self) -> Vec<Slope<'g>> {
        self.slopes(self.states.iter().map(|state| state.start).enumerate())
    }

    fn slopes(&self, values: impl Iterator<Item = (usize, Expr<'g>)>) -> Vec<Slope<'g>> {
        let graph = self.equations.system().graph();
        let symbols: Vec<Expr<'g>> = self.parameters.iter().map(|parameter| parameter.symbol).collect();
        let (places, values): (Vec<usize>, Vec<Expr<'g>>) = values.unzip();
        let rows = places.into_iter().zip(graph.jacobian(&values, &symbols));
        rows.flat_map(|(of, row)| row.into_iter().map(move |(by, value)| Slope { of, by, value })).collect()
    }

    /// The derivatives of the rates, then of what is observed, by time alone; none if all of them are zero.
    pub(crate) fn time_slopes(&self) -> Vec<Expr<'g>> {
        let system = self.equations.system();
        let mut values = self.rates();
        values.extend(self.observed.iter().map(|&(_, value)| value));
        let values = system.graph().substitute(&values, &self.accelerations);
        let slopes = system.graph().directional(&values, &[(self.time, Expr::ONE)]);
        if slopes.iter().all(|slope| slope.is_zero()) { Vec::new() } else { slopes }
    }

    /// The functions beside those of the equations.
    pub(crate) fn functions(&self) -> Vec<SourceFunction<'g>> {
        let graph = self.equations.system().graph();
        let named = |name: String, value: Expr<'g>| (name, value);
        let mut functions = vec![SourceFunction::new(
            "start",
            "the start as the parameters give it",
            self.states.iter().map(|state| named(state.name.clone(), state.start)).collect(),
        )];
        let mut add = |name: &str, purpose: &str, values: Vec<(String, Expr<'g>)>| {
            if !values.is_empty() {
                functions.push(SourceFunction::new(name, purpose, values));
            }
        };
        let calculated = self.calculated.iter();
        let calculated = calculated.map(|&(place, value)| named(self.parameters[place].name.clone(), value));
        add("calculated", "the parameters that follow others", calculated.collect());
        add("observed", "what is observed beside the state", self.observed.clone());
        let when = self.events.iter().map(|event| named(event.name.clone(), event.when));
        add("events", "the functions that vanish at events", when.collect());
        if self.events.iter().any(|event| event.is_reset) {
            let after = self.events.iter().flat_map(|event| {
                let names = self.states.iter().map(|state| state.name.clone());
                names.zip(event.after.iter().copied())
            });
            add("resets", "the state after each event", after.collect());
        }
        let kept = self.kept.iter().map(|kept| named(kept.name.clone(), kept.function));
        add("kept", "what the motion is kept at", kept.collect());
        let moving = self.states.len() - self.equations.system().states().len();
        let slopes = self.kept.iter().flat_map(|kept| {
            let mut slopes = graph.gradient(kept.function, &self.symbols);
            slopes[moving..].fill(Expr::ZERO); // a projection leaves first-order states alone
            let names = self.states.iter().map(|state| format!("∂{}/∂{}", kept.name, state.name));
            names.zip(slopes).collect::<Vec<_>>()
        });
        add("kept_slopes", "its derivatives by the state, one row for each", slopes.collect());
        let guards = self.guards.iter().map(|&guard| named(String::new(), guard));
        add(
            "guards",
            "the determinants that vanish where the state does not determine velocities",
            guards.collect(),
        );
        if self.has_derivatives {
            let slopes =
                |slopes: &[Slope<'g>]| slopes.iter().map(|slope| named(String::new(), slope.value)).collect();
            add(
                "calculated_slopes",
                "the derivatives of parameters that follow others by these, but zeros",
                slopes(&self.calculated_slopes()),
            );
            add(
                "start_slopes",
                "the derivatives of the start by parameters, but zeros",
                slopes(&self.start_slopes()),
            );
            let by_time = self.time_slopes().into_iter().map(|value| named(String::new(), value));
            add(
                "time_slopes",
                "the derivatives of the rates, then of what is observed, by time",
                by_time.collect(),
            );
            functions.push(SourceFunction::directional(
                "directional",
                "the derivatives of the rates, then of what is observed, along a direction that follows `p`",
                self.observed.clone(),
            ));
        }
        functions
    }
}

/// The parameters of the equations, in their order.
fn parameters<'g>(
    model: &Model,
    system: &pc_mech::System<'g>,
    calculated: &[(usize, Expr<'g>)],
    notes: &mut Vec<String>,
) -> Vec<Parameter<'g>> {
    let given = model.document().parameters.len();
    let tables: Vec<&str> = (0..model.parameter_values().values().len())
        .filter(|&place| model.parameter_values().is_table(place))
        .filter_map(|place| model.parameters().nth(place).map(|(name, _)| name))
        .collect();
    if !tables.is_empty() {
        notes.push(format!(
            "The tables of inputs are not part of the FMU: connect {}, which stay at their values at the start otherwise.",
            tables.join(", ")
        ));
    }
    let kind = |place: usize| match () {
        () if place >= given => ParameterKind::Input,
        () if calculated.iter().any(|&(known, _)| known == place) => ParameterKind::Follows,
        () => ParameterKind::Given,
    };
    let parameters = system.parameters().iter().enumerate();
    let parameter = |(place, &(symbol, value)): (usize, &(Expr<'g>, f64))| Parameter {
        name: symbol.to_string(),
        symbol,
        value,
        kind: kind(place),
    };
    parameters.map(parameter).collect()
}

/// Constraints on the state, and the integrals that the model asks to keep.
fn kept<'g>(
    model: &Model,
    assembly: &Assembly<'g>,
    equations: &Equations<'g>,
    form: &FreeForm<'g>,
    known: &[(Expr<'g>, Expr<'g>)],
    notes: &mut Vec<String>,
) -> Vec<Kept<'g>> {
    let (system, graph) = (equations.system(), equations.system().graph());
    let mut kept = Vec::new();
    if let pc_model::ConstraintFormulation::Multipliers(held) = assembly.constraints.formulation()
        && form.system.frame().coordinates() == assembly.system.frame().coordinates()
    {
        for constraint in held.multipliers.constraints() {
            if constraint.is_holonomic(&assembly.system) || held.multipliers.is_nonlinear() {
                let function = graph.substitute(&[constraint.expression()], known)[0];
                if !function.is_zero() {
                    let name = constraint.name().to_owned();
                    kept.push(Kept { name, function, is_constraint: true });
                }
            }
        }
    }
    for q in assembly.system.unit_quaternions() {
        let name = format!("|{}|²", q[0].to_string().trim_end_matches('0'));
        let function = graph.sum(q.iter().map(|q| q.square())) - 1.0;
        kept.push(Kept { name, function, is_constraint: true });
    }
    for name in model.kept() {
        let integral = system.integrals().iter().find(|(known, _)| known == name).map(|&(_, f)| f);
        let function = if name == "energy" { Some(equations.energy()) } else { integral };
        if let Some(function) = function {
            kept.push(Kept { name: name.clone(), function, is_constraint: false });
        }
    }
    if !kept.is_empty() {
        let names: Vec<&str> = kept.iter().map(|kept| kept.name.as_str()).collect();
        notes.push(format!(
            "In Co-Simulation each step is projected to {}; in Model Exchange the importer's steps are not.",
            names.join(", ")
        ));
    }
    kept
}

/// 1 where a function rises, −1 where it falls, 0 either way.
pub(crate) fn sign(direction: Direction) -> i32 {
    match direction {
        Direction::Rising => 1,
        Direction::Falling => -1,
        Direction::Both => 0,
    }
}
