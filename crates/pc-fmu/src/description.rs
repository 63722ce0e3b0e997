//! `modelDescription.xml`: the variables of an FMU, and how they depend on each other.

use std::io;

use pc_expr::Expr;

use crate::contents::{Contents, OF_STATES, ParameterKind};
use crate::dependencies::{Dependency, Knowns};
use crate::experiment::Experiment;
use crate::options::{FmiVersion, FmuSolver};
use crate::units::{self, Unit, Units};
use crate::xml::{Attributes, Xml, document, empty, inside, number, text};

/// What is written about a whole.
pub(crate) struct Title<'a> {
    /// An identifier of C.
    pub(crate) identifier: &'a str,
    pub(crate) name: &'a str,
    pub(crate) description: &'a str,
    pub(crate) token: &'a str,
    /// The files to be compiled.
    pub(crate) sources: &'a [String],
}

/// A variable, its place among all being its value reference.
pub(crate) struct Variable {
    name: String,
    causality: &'static str,
    variability: &'static str,
    initial: Option<&'static str>,
    start: Option<f64>,
    /// The value reference of what it is the rate of.
    derivative: Option<usize>,
    description: String,
    unit: Option<Unit>,
    /// What it depends on, if it is computed.
    depends: Vec<Dependency>,
    /// The same before the motion begins.
    depends_at_start: Vec<Dependency>,
    is_rate: bool,
    is_indicator: bool,
    /// Whether importers may access it in the middle of a step.
    is_intermediate: bool,
}

impl Variable {
    fn new(name: &str, causality: &'static str, variability: &'static str) -> Variable {
        Variable {
            name: name.to_owned(),
            causality,
            variability,
            initial: None,
            start: None,
            derivative: None,
            description: String::new(),
            unit: None,
            depends: Vec::new(),
            depends_at_start: Vec::new(),
            is_rate: false,
            is_indicator: false,
            is_intermediate: false,
        }
    }

    fn initial(self, initial: &'static str) -> Variable {
        Variable { initial: Some(initial), ..self }
    }

    /// With a start that can be set, or one that follows from parameters.
    fn starting(self, start: Option<f64>) -> Variable {
        let initial = if start.is_some() { "exact" } else { "calculated" };
        Variable { start, ..self.initial(initial) }
    }

    fn described(self, description: &str) -> Variable {
        Variable { description: description.to_owned(), ..self }
    }
}

/// All variables in the order of their value references: time, states, rates, parameters, what is observed, indicators.
pub(crate) fn variables<'g>(contents: &Contents<'g>, units: &Units, version: FmiVersion) -> Vec<Variable> {
    let (in_motion, at_start) = (Knowns::in_motion(contents, version), Knowns::at_start(contents));
    let computed = |variable: Variable, value: Expr<'g>| {
        let (depends, depends_at_start) = (in_motion.of(contents, value), at_start.of(contents, value));
        Variable { depends, depends_at_start, is_intermediate: true, ..variable }
    };
    let mut all = vec![Variable::new("t", "independent", "continuous").described("time")];
    all[0].unit = Some(units.of("t").unwrap_or(Unit::TIME));
    all.extend(contents.states.iter().zip(&contents.symbols).map(|(state, &symbol)| {
        let causality = if state.is_column { "output" } else { "local" };
        let variable = Variable::new(&state.name, causality, "continuous").starting(state.number);
        computed(Variable { unit: units.of(&state.name), ..variable }, symbol)
    }));
    all.extend(contents.states.iter().zip(contents.rates()).enumerate().map(|(i, (state, rate))| {
        let variable =
            Variable::new(&format!("der({})", state.name), "local", "continuous").initial("calculated");
        let given = units.of(&format!("{}'", state.name));
        let unit = given.or_else(|| units.of(&state.name).and_then(Unit::rate));
        let derivative = Some(OF_STATES + i);
        computed(Variable { derivative, unit, is_rate: true, ..variable }, rate)
    }));
    let of_parameter = if contents.is_fixed { "fixed" } else { "tunable" };
    all.extend(contents.parameters.iter().map(|parameter| {
        let of = |causality, variability| {
            let variable = Variable::new(&parameter.name, causality, variability);
            Variable { unit: units.of(&parameter.name), ..variable }
        };
        match parameter.kind {
            ParameterKind::Given => of("parameter", of_parameter).starting(Some(parameter.value)),
            ParameterKind::Follows => {
                let variable = of("calculatedParameter", of_parameter).initial("calculated");
                Variable { depends_at_start: at_start.of(contents, parameter.symbol), ..variable }
            }
            ParameterKind::Input => {
                let variable = of("input", "continuous");
                Variable { start: Some(parameter.value), is_intermediate: true, ..variable }
            }
        }
    }));
    all.extend(contents.observed.iter().map(|(name, value)| {
        let variable = Variable::new(name, "output", "continuous").initial("calculated");
        computed(Variable { unit: units.of(name), ..variable }, *value)
    }));
    if version == FmiVersion::V3 {
        // In FMI 2 they are a number only.
        all.extend(contents.events.iter().map(|event| {
            let variable = Variable::new(&format!("event({})", event.name), "local", "continuous");
            let variable = variable.initial("calculated").described("vanishes at the event");
            let depends = in_motion.of(contents, event.when);
            Variable { depends, is_indicator: true, ..variable }
        }));
    }
    all
}

/// What the integration of Co-Simulation is able to do.
fn co_simulation(
    version: FmiVersion,
    contents: &Contents<'_>,
    solver: FmuSolver,
) -> Vec<(&'static str, &'static str)> {
    let has_inputs = contents.parameters.iter().any(|parameter| parameter.kind == ParameterKind::Input);
    let mut all = vec![("canHandleVariableCommunicationStepSize", "true")];
    match version {
        FmiVersion::V2 if has_inputs => all.push(("canInterpolateInputs", "true")),
        FmiVersion::V2 => {}
        FmiVersion::V3 => {
            all.extend([
                ("providesIntermediateUpdate", "true"),
                ("canReturnEarlyAfterIntermediateUpdate", "true"),
            ]);
            if has_inputs {
                all.push(("recommendedIntermediateInputSmoothness", order(solver)));
            }
            if !contents.events.is_empty() {
                all.extend([("mightReturnEarlyFromDoStep", "true"), ("hasEventMode", "true")]);
            }
        }
    }
    all
}

/// The order of a method, which it has under inputs that are so many times continuously differentiable.
fn order(solver: FmuSolver) -> &'static str {
    match solver {
        FmuSolver::Dop853 => "8",
        FmuSolver::Radau5 => "5",
        FmuSolver::RungeKutta4 { .. } => "4",
    }
}

/// The model description of a version of FMI.
///
/// # Errors
/// None; writing to memory does not fail.
pub(crate) fn model_description(
    version: FmiVersion,
    title: &Title<'_>,
    contents: &Contents<'_>,
    variables: &[Variable],
    experiment: &Experiment,
) -> io::Result<Vec<u8>> {
    let (numbers, token, derivatives, state) = match version {
        FmiVersion::V2 => ("2.0", "guid", "providesDirectionalDerivative", "FMUstate"),
        FmiVersion::V3 => ("3.0", "instantiationToken", "providesDirectionalDerivatives", "FMUState"),
    };
    let mut head: Attributes = vec![
        ("fmiVersion", numbers.to_owned()),
        ("modelName", text(title.name)),
        (token, title.token.to_owned()),
        ("description", text(title.description)),
        ("generationTool", format!("pc {}", env!("CARGO_PKG_VERSION"))),
        ("variableNamingConvention", "flat".to_owned()),
    ];
    if version == FmiVersion::V2 {
        head.push(("numberOfEventIndicators", contents.events.len().to_string()));
    }
    let abilities = |more: &[(&'static str, &str)]| -> Attributes {
        let (get, serialize) = match state {
            "FMUstate" => ("canGetAndSetFMUstate", "canSerializeFMUstate"),
            _ => ("canGetAndSetFMUState", "canSerializeFMUState"),
        };
        let yes = "true".to_owned();
        let mut all = vec![("modelIdentifier", title.identifier.to_owned())];
        all.extend(more.iter().map(|&(name, value)| (name, value.to_owned())));
        let with_derivatives = contents.has_derivatives.to_string();
        all.extend([(get, yes.clone()), (serialize, yes.clone()), (derivatives, with_derivatives.clone())]);
        all.push(match version {
            FmiVersion::V2 => ("canNotUseMemoryManagementFunctions", yes),
            FmiVersion::V3 => ("providesAdjointDerivatives", with_derivatives),
        });
        all
    };
    document(|xml| {
        inside(xml, "fmiModelDescription", &head, |xml| {
            // After each step of an importer it is seen whether an event has been passed; FMI 2 asks for no word on that.
            let completed = [("needsCompletedIntegratorStep", "true")];
            let completed = if version == FmiVersion::V2 { &[][..] } else { &completed };
            let kinds = [
                ("ModelExchange", abilities(completed)),
                ("CoSimulation", abilities(&co_simulation(version, contents, experiment.solver))),
            ];
            for (name, attributes) in kinds {
                match version {
                    FmiVersion::V2 => inside(xml, name, &attributes, |xml| {
                        inside(xml, "SourceFiles", &Vec::new(), |xml| {
                            title
                                .sources
                                .iter()
                                .try_for_each(|file| empty(xml, "File", &vec![("name", file.clone())]))
                        })
                    })?,
                    FmiVersion::V3 => empty(xml, name, &attributes)?,
                }
            }
            units::definitions(variables.iter().filter_map(|variable| variable.unit.clone()), xml)?;
            inside(xml, "LogCategories", &Vec::new(), |xml| {
                empty(xml, "Category", &vec![("name", "logStatusError".to_owned())])
            })?;
            let mut run: Attributes = vec![("startTime", number(experiment.t_start))];
            run.extend(experiment.t_end.map(|t| ("stopTime", number(t))));
            run.push(("tolerance", number(experiment.relative)));
            run.extend(experiment.interval.map(|h| ("stepSize", number(h))));
            empty(xml, "DefaultExperiment", &run)?;
            inside(xml, "ModelVariables", &Vec::new(), |xml| {
                variables
                    .iter()
                    .enumerate()
                    .try_for_each(|(place, variable)| write_variable(xml, version, place, variable))
            })?;
            inside(xml, "ModelStructure", &Vec::new(), |xml| structure(xml, version, variables))
        })
    })
}

fn write_variable(xml: &mut Xml, version: FmiVersion, place: usize, variable: &Variable) -> io::Result<()> {
    let mut attributes: Attributes =
        vec![("name", text(&variable.name)), ("valueReference", place.to_string())];
    if !variable.description.is_empty() {
        attributes.push(("description", text(&variable.description)));
    }
    attributes.push(("causality", variable.causality.to_owned()));
    attributes.push(("variability", variable.variability.to_owned()));
    attributes.extend(variable.initial.map(|initial| ("initial", initial.to_owned())));
    let mut of_real: Attributes = variable.unit.iter().map(|unit| ("unit", text(&unit.name()))).collect();
    of_real.extend(variable.start.map(|start| ("start", number(start))));
    match version {
        FmiVersion::V2 => {
            of_real.extend(variable.derivative.map(|of| ("derivative", (of + 1).to_string())));
            inside(xml, "ScalarVariable", &attributes, |xml| empty(xml, "Real", &of_real))
        }
        FmiVersion::V3 => {
            attributes.extend(of_real);
            if variable.is_intermediate {
                attributes.push(("intermediateUpdate", "true".to_owned()));
            }
            attributes.extend(variable.derivative.map(|of| ("derivative", of.to_string())));
            empty(xml, "Float64", &attributes)
        }
    }
}

/// What is computed, with what it depends on.
fn structure(xml: &mut Xml, version: FmiVersion, variables: &[Variable]) -> io::Result<()> {
    // A place is an index from 1 in FMI 2, and a value reference in FMI 3.
    let shift = usize::from(version == FmiVersion::V2);
    let unknown = |place: usize, depends: &[Dependency]| -> Attributes {
        let name = if version == FmiVersion::V2 { "index" } else { "valueReference" };
        let mut attributes = vec![(name, (place + shift).to_string())];
        let list =
            |word: &dyn Fn(&Dependency) -> String| depends.iter().map(word).collect::<Vec<_>>().join(" ");
        attributes.push(("dependencies", list(&|it| (it.on + shift).to_string())));
        if !depends.is_empty() {
            attributes.push(("dependenciesKind", list(&|it| it.factor.word().to_owned())));
        }
        attributes
    };
    let all = || variables.iter().enumerate();
    let outputs: Vec<Attributes> = all()
        .filter(|(_, variable)| variable.causality == "output")
        .map(|(place, variable)| unknown(place, &variable.depends))
        .collect();
    let rates: Vec<Attributes> = all()
        .filter(|(_, variable)| variable.is_rate)
        .map(|(place, variable)| unknown(place, &variable.depends))
        .collect();
    let initial: Vec<Attributes> = all()
        .filter(|(_, variable)| {
            let at_start = variable.causality == "output" || variable.causality == "calculatedParameter";
            let of_state = variable.is_rate
                || variables.iter().any(|rate| {
                    rate.derivative.is_some_and(|of| std::ptr::eq(&raw const variables[of], *variable))
                });
            variable.initial == Some("calculated") && (at_start || of_state)
        })
        .map(|(place, variable)| unknown(place, &variable.depends_at_start))
        .collect();
    let indicators: Vec<Attributes> = all()
        .filter(|(_, variable)| variable.is_indicator)
        .map(|(place, variable)| unknown(place, &variable.depends))
        .collect();
    match version {
        FmiVersion::V2 => {
            for (name, list) in [("Outputs", outputs), ("Derivatives", rates), ("InitialUnknowns", initial)] {
                if !list.is_empty() {
                    inside(xml, name, &Vec::new(), |xml| {
                        list.iter().try_for_each(|attributes| empty(xml, "Unknown", attributes))
                    })?;
                }
            }
            Ok(())
        }
        FmiVersion::V3 => {
            let lists = [
                ("Output", outputs),
                ("ContinuousStateDerivative", rates),
                ("InitialUnknown", initial),
                ("EventIndicator", indicators),
            ];
            lists.iter().try_for_each(|(name, list)| {
                list.iter().try_for_each(|attributes| empty(xml, name, attributes))
            })
        }
    }
}

/// `sources/buildDescription.xml` of FMI 3.
///
/// # Errors
/// None; writing to memory does not fail.
pub(crate) fn build_description(title: &Title<'_>) -> io::Result<Vec<u8>> {
    document(|xml| {
        inside(xml, "fmiBuildDescription", &vec![("fmiVersion", "3.0".to_owned())], |xml| {
            inside(
                xml,
                "BuildConfiguration",
                &vec![("modelIdentifier", title.identifier.to_owned())],
                |xml| {
                    inside(xml, "SourceFileSet", &vec![("language", "C99".to_owned())], |xml| {
                        title
                            .sources
                            .iter()
                            .try_for_each(|file| empty(xml, "SourceFile", &vec![("name", file.clone())]))
                    })
                },
            )
        })
    })
}
