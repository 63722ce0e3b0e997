//! `modelDescription.xml`: the variables of an FMU, and how they depend on each other.

use std::io;

use pc_expr::Expr;
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};

use crate::contents::{Contents, ParameterKind};
use crate::experiment::Experiment;
use crate::options::{FmiVersion, FmuSolver};

type Xml = Writer<Vec<u8>>;
type Attributes = Vec<(&'static str, String)>;

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
struct Variable {
    name: String,
    causality: &'static str,
    variability: &'static str,
    initial: Option<&'static str>,
    start: Option<f64>,
    /// The value reference of what it is the rate of.
    derivative: Option<usize>,
    description: String,
    /// The value references of the states, inputs and time that it depends on, of what is computed.
    depends: Option<Vec<usize>>,
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
            depends: None,
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

/// Text of an attribute, without characters that XML has not.
fn text(text: &str) -> String {
    text.chars()
        .map(|c| if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') { ' ' } else { c })
        .collect()
}

fn number(value: f64) -> String {
    format!("{value:?}")
}

/// All variables in the order of their value references: time, states, rates, parameters, what is observed, indicators.
fn variables(contents: &Contents<'_>) -> Vec<Variable> {
    let n = contents.states.len();
    let (of_states, of_parameters) = (1, 1 + 2 * n);
    let system = contents.equations.system();
    let graph = system.graph();
    let accelerations = system.accelerations();
    let solved = contents.equations.accelerations();
    let inputs: Vec<(Expr<'_>, usize)> = (contents.symbols.iter().enumerate())
        .map(|(i, &symbol)| (symbol, of_states + i))
        .chain([(contents.time, 0)])
        .chain((contents.parameters.iter().enumerate()).filter_map(|(i, parameter)| {
            (parameter.kind == ParameterKind::Input).then_some((parameter.symbol, of_parameters + i))
        }))
        .collect();
    let known: Vec<_> = accelerations.into_iter().zip(solved.iter().copied()).collect();
    let depends = |value: Expr<'_>| {
        let value = graph.substitute(&[value], &known);
        let symbols = graph.symbols_of(&value);
        let mut places: Vec<usize> =
            inputs.iter().filter(|(symbol, _)| symbols.contains(symbol)).map(|&(_, place)| place).collect();
        places.sort_unstable();
        Some(places)
    };
    let of_states_rates = system.states().iter().map(|&(_, rate)| rate);
    let rates: Vec<Expr<'_>> =
        contents.equations.velocities().iter().copied().chain(solved).chain(of_states_rates).collect();

    let mut all = vec![Variable::new("t", "independent", "continuous").described("time")];
    all.extend(contents.states.iter().enumerate().map(|(i, state)| {
        let causality = if state.is_column { "output" } else { "local" };
        let variable = Variable::new(&state.name, causality, "continuous").starting(state.number);
        Variable { depends: Some(vec![of_states + i]), is_intermediate: true, ..variable }
    }));
    all.extend(contents.states.iter().zip(&rates).enumerate().map(|(i, (state, &rate))| {
        let variable =
            Variable::new(&format!("der({})", state.name), "local", "continuous").initial("calculated");
        let (derivative, depends) = (Some(of_states + i), depends(rate));
        Variable { derivative, depends, is_rate: true, is_intermediate: true, ..variable }
    }));
    let of_parameter = if contents.is_fixed { "fixed" } else { "tunable" };
    all.extend(contents.parameters.iter().map(|parameter| {
        let of = |causality, variability| Variable::new(&parameter.name, causality, variability);
        match parameter.kind {
            ParameterKind::Given => of("parameter", of_parameter).starting(Some(parameter.value)),
            ParameterKind::Follows => of("calculatedParameter", of_parameter).initial("calculated"),
            ParameterKind::Input => {
                let variable = of("input", "continuous");
                Variable { start: Some(parameter.value), is_intermediate: true, ..variable }
            }
        }
    }));
    all.extend(contents.observed.iter().map(|(name, value)| {
        let variable = Variable::new(name, "output", "continuous").initial("calculated");
        Variable { depends: depends(*value), is_intermediate: true, ..variable }
    }));
    all.extend(contents.events.iter().map(|event| {
        let variable = Variable::new(&format!("event({})", event.name), "local", "continuous");
        let variable = variable.initial("calculated").described("vanishes at the event");
        Variable { depends: depends(event.when), is_indicator: true, ..variable }
    }));
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

/// The XML of an element without attributes and its contents.
fn inside(
    xml: &mut Xml,
    name: &str,
    attributes: &Attributes,
    write: impl FnOnce(&mut Xml) -> io::Result<()>,
) -> io::Result<()> {
    let pairs = attributes.iter().map(|(name, value)| (*name, value.as_str()));
    xml.create_element(name).with_attributes(pairs).write_inner_content(write)?;
    Ok(())
}

fn empty(xml: &mut Xml, name: &str, attributes: &Attributes) -> io::Result<()> {
    let pairs = attributes.iter().map(|(name, value)| (*name, value.as_str()));
    xml.create_element(name).with_attributes(pairs).write_empty()?;
    Ok(())
}

/// A document with one element.
pub(crate) fn document(write: impl FnOnce(&mut Xml) -> io::Result<()>) -> io::Result<Vec<u8>> {
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 2);
    xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    write(&mut xml)?;
    let mut bytes = xml.into_inner();
    bytes.push(b'\n');
    Ok(bytes)
}

/// The model description of a version of FMI.
///
/// # Errors
/// None; writing to memory does not fail.
pub(crate) fn model_description(
    version: FmiVersion,
    title: &Title<'_>,
    contents: &Contents<'_>,
    experiment: &Experiment,
) -> io::Result<Vec<u8>> {
    let mut variables = variables(contents);
    if version == FmiVersion::V2 {
        variables.retain(|variable| !variable.is_indicator); // they are a number there
    }
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
        all.extend([(get, yes.clone()), (serialize, yes.clone()), (derivatives, with_derivatives)]);
        if version == FmiVersion::V2 {
            all.push(("canNotUseMemoryManagementFunctions", yes));
        }
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
            inside(xml, "ModelStructure", &Vec::new(), |xml| structure(xml, version, &variables))
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
    let mut of_real: Attributes = Vec::new();
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
    let unknown = |place: usize, variable: &Variable| -> Attributes {
        let name = if version == FmiVersion::V2 { "index" } else { "valueReference" };
        let mut attributes = vec![(name, (place + shift).to_string())];
        if let Some(depends) = &variable.depends {
            let places: Vec<String> = depends.iter().map(|place| (place + shift).to_string()).collect();
            attributes.push(("dependencies", places.join(" ")));
        }
        attributes
    };
    let all = || variables.iter().enumerate();
    let outputs: Vec<Attributes> = all()
        .filter(|(_, variable)| variable.causality == "output")
        .map(|(place, variable)| unknown(place, variable))
        .collect();
    let rates: Vec<Attributes> = all()
        .filter(|(_, variable)| variable.is_rate)
        .map(|(place, variable)| unknown(place, variable))
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
        // Which parameters and start values they follow is not told: any.
        .map(|(place, _)| {
            vec![(if shift == 1 { "index" } else { "valueReference" }, (place + shift).to_string())]
        })
        .collect();
    let indicators: Vec<Attributes> = all()
        .filter(|(_, variable)| variable.is_indicator)
        .map(|(place, variable)| unknown(place, variable))
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
