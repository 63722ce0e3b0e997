//! `pc check`: whether a model holds together.

use pc_mech::{Conservation, Equations, Expr, Graph, MechError, Neighbourhood, Number, System, VectorField};
use pc_model::{Assembly, Model};
use serde_json::{Value, json};

use crate::args::{CheckArguments, Format};
use crate::derive::{Operations, counted, recognised};
use crate::error::CliError;
use crate::input;
use crate::text::{assignments, columns, combination, labelled, print, short, small, wrapped};

/// Prints what can be said of a model before it is run.
///
/// # Errors
/// [`CliError`]; of an inconsistent model that is the answer.
pub fn command(arguments: &CheckArguments) -> Result<(), CliError> {
    let model = input::open(&arguments.model)?;
    let graph = Graph::new();
    let (assembly, equations) = input::derive(&model, &graph)?;
    let report = Report::new(&model, &assembly, &equations)?;
    print(|out| match arguments.format {
        Format::Text => write!(out, "{}", report.text()),
        Format::Json => writeln!(out, "{:#}", report.json()),
    })
}

/// What can be said of a model before it is run.
#[derive(Clone, Debug)]
struct Report {
    title: String,
    coordinates: Vec<String>,
    quasi_velocities: Vec<String>,
    rank: usize,
    given_algebra: bool,
    closure_residual: f64,
    jacobi_residual: f64,
    algebra: String,
    mass_rank: usize,
    t_start: f64,
    start: Vec<f64>,
    largest_rate: f64,
    integrals: Vec<Integral>,
    operations: Operations,
}

/// A function that may keep its value.
#[derive(Clone, Debug)]
struct Integral {
    name: String,
    expression: String,
    /// Where it comes from.
    how: &'static str,
    verdict: Verdict,
}

impl Report {
    fn new(model: &Model, assembly: &Assembly<'_>, equations: &Equations<'_>) -> Result<Report, CliError> {
        let system = &assembly.system;
        let (frame, structure, graph) = (system.frame(), system.structure(), system.graph());
        let operations =
            Operations::of(equations).map_err(|error| model.derivation_error(MechError::from(error)))?;
        let names = |symbols: &[Expr<'_>]| symbols.iter().map(Expr::to_string).collect::<Vec<_>>();

        let (mut motion, start) = model.compile(assembly)?;
        let mut rate = vec![0.0; start.len()];
        // `compile` has tried the same
        let evaluated = motion.rhs(assembly.t_start, &start, &mut rate).is_ok();
        let largest_rate = rate.iter().fold(0.0f64, |largest, r| largest.max(r.abs()));

        let state = frame.coordinates().iter().chain(system.quasi_velocities()).copied();
        let mut centre = system.parameters().to_vec();
        centre.push((frame.time(), assembly.t_start));
        centre.extend(state.zip(assembly.start.iter().copied()));
        let near = Neighbourhood { centre };

        let rates = equations.rates();
        let verdict = |function| match rates.verdict(function) {
            Conservation::Conserved => Verdict::Conserved,
            Conservation::ConservedHere => Verdict::ConservedHere,
            Conservation::Changing(rate) => {
                let value = graph.evaluate(&[rate], &near.centre).ok();
                Verdict::Rate(value.map(|values| values[0]).filter(|value| value.is_finite()))
            }
        };
        let declared = system.integrals().iter().map(|(name, value)| (name.clone(), *value, "declared"));
        let integrals = declared
            .chain([("energy".to_owned(), equations.energy(), "energy")])
            .chain(cyclic_momenta(system))
            .map(|(name, value, how)| Integral {
                name,
                expression: value.to_string(),
                how,
                verdict: verdict(value),
            })
            .collect();
        Ok(Report {
            title: input::title(model).to_owned(),
            coordinates: names(frame.coordinates()),
            quasi_velocities: names(system.quasi_velocities()),
            rank: frame.rank(),
            given_algebra: model.document().algebra.is_some(),
            closure_residual: frame.closure_residual(structure, &near),
            jacobi_residual: frame.jacobi_residual(structure, &near),
            algebra: match recognised(structure) {
                Some(name) => format!("{name}, constant structure coefficients"),
                None if structure.nonzero().next().is_none() => "commutative".to_owned(),
                None if structure.are_constant() => {
                    "constant structure coefficients, not one of the catalogue".to_owned()
                }
                None => "none: the structure coefficients depend on the state or on time".to_owned(),
            },
            mass_rank: graph.generic_rank(&equations.mass_matrix().to_rows()),
            t_start: assembly.t_start,
            start: assembly.start.clone(),
            largest_rate: if evaluated { largest_rate } else { f64::NAN },
            integrals,
            operations,
        })
    }

    fn text(&self) -> String {
        const LABEL: usize = 19;
        const WIDTH: usize = 78;
        let k = self.quasi_velocities.len();
        let counted_names = |symbol: &str, names: &[String]| {
            let mut lines = wrapped(names.iter().cloned(), WIDTH - 8);
            lines.insert(0, format!("{symbol} = {}", names.len()));
            if lines.len() == 2 { vec![lines.join("   ")] } else { lines }
        };
        let brackets = match (self.given_algebra, self.rank == k) {
            (true, _) => "brackets given",
            (false, true) => "brackets from the frame",
            (false, false) => "constant brackets found",
        };
        let residual = |value: f64| match value {
            0.0 => "holds identically".to_owned(),
            value => format!("holds to {}", small(value)),
        };
        let names = self.coordinates.iter().chain(&self.quasi_velocities).map(String::as_str);
        let start = assignments(names.zip(self.start.iter().copied()), WIDTH);
        let entries: [(&str, Vec<String>); 11] = [
            ("coordinates", counted_names("n", &self.coordinates)),
            ("quasi-velocities", counted_names("k", &self.quasi_velocities)),
            ("rank of the frame", vec![format!("{} of {k}, {brackets}", self.rank)]),
            ("closure", vec![residual(self.closure_residual)]),
            ("Jacobi identity", vec![residual(self.jacobi_residual)]),
            ("algebra", vec![self.algebra.clone()]),
            ("constraints", vec!["none".to_owned()]),
            ("mass matrix", vec![format!("symmetric, rank {} of {k}", self.mass_rank)]),
            ("start", start),
            (
                "rates there",
                vec![format!(
                    "finite at t = {}, the largest {}",
                    short(self.t_start, 6),
                    short(self.largest_rate, 4)
                )],
            ),
            (
                "operations",
                vec![
                    counted("parameters free ", &self.operations.free),
                    counted("parameters bound", &self.operations.bound),
                ],
            ),
        ];
        let mut text = format!("{}\n", self.title);
        for (label, lines) in &entries {
            text += &labelled(label, LABEL, lines);
        }
        let width = self.integrals.iter().map(|integral| columns(&integral.name)).max().unwrap_or(0);
        let integrals: Vec<String> = self
            .integrals
            .iter()
            .map(|integral| format!("{:width$}  {}", integral.name, integral.verdict.words()))
            .collect();
        text + &labelled("integrals", LABEL, &integrals)
    }

    fn json(&self) -> Value {
        let integrals: Vec<Value> = self
            .integrals
            .iter()
            .map(|integral| {
                let mut object = json!({
                    "name": integral.name,
                    "expression": integral.expression,
                    "how": integral.how,
                    "verdict": integral.verdict.words(),
                });
                if let Verdict::Rate(rate) = integral.verdict {
                    object["rate_at_start"] = json!(rate);
                }
                object
            })
            .collect();
        json!({
            "model": self.title,
            "coordinates": self.coordinates.len(),
            "quasi_velocities": self.quasi_velocities.len(),
            "rank": self.rank,
            "closure_residual": self.closure_residual,
            "constraints": [],
            "jacobi_residual": self.jacobi_residual,
            "algebra": self.algebra,
            "mass_matrix_rank": self.mass_rank,
            "start_residual": 0.0,
            "integrals": integrals,
        })
    }
}

/// The momenta of cyclic displacements that are not declared as integrals, for the values of the parameters.
fn cyclic_momenta<'g>(system: &System<'g>) -> Vec<(String, Expr<'g>, &'static str)> {
    let bound = system.with_parameters_bound();
    let is_declared = |momentum: Expr<'g>| {
        let mut known = bound.integrals().iter().filter(|(_, known)| !known.is_zero());
        known.any(|&(_, known)| (momentum / known).constant().is_some())
    };
    let name = |coefficients: &[Number]| {
        let names = system.quasi_velocities().iter().map(ToString::to_string);
        format!("momentum of {}", combination(coefficients.iter().map(ToString::to_string).zip(names)))
    };
    bound
        .cyclic_displacements()
        .into_iter()
        .filter(|cyclic| !is_declared(cyclic.momentum))
        .map(|cyclic| (name(&cyclic.coefficients), cyclic.momentum, "cyclic displacement"))
        .collect()
}

/// What is known of the rate of change of a function along the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Verdict {
    /// It vanishes identically.
    Conserved,
    /// It vanishes identically for these values of the parameters.
    ConservedHere,
    /// It is not seen to vanish; its value at the start, if it has one.
    Rate(Option<f64>),
}

impl Verdict {
    fn words(self) -> String {
        match self {
            Verdict::Conserved => "conserved (proved)".to_owned(),
            Verdict::ConservedHere => "conserved for these parameters (proved)".to_owned(),
            Verdict::Rate(Some(rate)) => {
                format!("not proved to be conserved: changes at the rate {} at the start", short(rate, 4))
            }
            Verdict::Rate(None) => "not proved to be conserved".to_owned(),
        }
    }
}
