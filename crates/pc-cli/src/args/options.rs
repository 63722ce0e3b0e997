//! The options of the commands.

use std::path::PathBuf;
use std::time::Duration;

use clap::{Args, ValueEnum};
use pc_model::Variables;
use pc_model::document::{AbsoluteTolerance, MOST_SAMPLES};
use pc_print::Form;
use pc_run::Wishes;
use pc_solve::Method;

use crate::args::checkpoint::CheckpointArguments;
use crate::args::drawn::DrawnArguments;
use crate::args::forms::{emit_form, form, method, run_form};
use crate::args::table::{ColumnArguments, OutputArguments, TableArguments};

/// The model, the values of its parameters, and its start.
#[derive(Clone, Debug, Args)]
pub struct ModelArguments {
    /// A file, `-` for standard input, or a built-in name
    pub model: String,
    /// Set a parameter, or the start of a coordinate, velocity or first-order state, to a value other than that in the file
    /// (repeatable)
    #[arg(long, value_name = "NAME=VALUE", value_parser = setting)]
    pub set: Vec<Setting>,
    /// Move the start onto the constraints, by those steps of Newton's method that are shortest in the kinetic metric
    #[arg(long)]
    pub project_start: bool,
    /// With --project-start: coordinates and quasi-velocities, separated by commas, that keep their start values
    #[arg(long, value_name = "NAMES", value_delimiter = ',', requires = "project_start")]
    pub keep: Vec<String>,
    /// Memory limit for the expressions of the equations, and separately for the rows of a motion, such as
    /// 500M or 8G
    #[arg(long, value_name = "BYTES", value_parser = bytes, default_value = "4G")]
    pub limit_memory: u64,
    /// Time limit in seconds for all work on the model, from its derivation to the end of a motion [default: none]
    #[arg(long, value_name = "SECONDS", value_parser = seconds)]
    pub limit_time: Option<Duration>,
}

/// The options that choose the velocities of the equations.
#[derive(Clone, Debug, Default, Args)]
pub struct VelocityArguments {
    /// With --form hamel: quasi-velocities as linear forms in the velocities x' or the quasi-velocities of the model; if these
    /// are too few, quasi-velocities of the model are added
    #[arg(value_name = "NAME=EXPR", value_parser = definition)]
    pub definitions: Vec<Setting>,
    /// Independent velocities for equations in which multipliers are eliminated, separated by commas: as many quasi-velocities
    /// as the constraints leave free, or velocities x' with --form voronets [default: those that give the shortest equations]
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub independent: Vec<String>,
}

/// Reads a number of bytes: `500M` is 500·2²⁰.
pub(crate) fn bytes(text: &str) -> Result<u64, String> {
    let (number, unit) = match text.find(|c: char| !c.is_ascii_digit()) {
        Some(end) => text.split_at(end),
        None => (text, ""),
    };
    let shift = match unit.to_ascii_lowercase().trim_end_matches("ib").trim_end_matches('b') {
        "" => 0,
        "k" => 10,
        "m" => 20,
        "g" => 30,
        "t" => 40,
        _ => return Err("write a number of bytes, such as 500M or 8G".to_owned()),
    };
    let bytes = number.parse::<u64>().ok().and_then(|number| number.checked_mul(1 << shift));
    bytes.filter(|&bytes| bytes > 0).ok_or_else(|| "write a number of bytes, such as 500M or 8G".to_owned())
}

/// Reads a positive number of seconds.
pub(crate) fn seconds(text: &str) -> Result<Duration, String> {
    let seconds = text.parse::<f64>().ok().and_then(|seconds| Duration::try_from_secs_f64(seconds).ok());
    seconds
        .filter(|time| !time.is_zero())
        .ok_or_else(|| "write a positive number of seconds, such as 60".to_owned())
}

/// A setting `NAME=VALUE`, with the value as written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Setting {
    /// The name of a parameter, or of something that has a start value.
    pub name: String,
    /// The value as written.
    pub value: String,
}

/// Arguments of `pc check`.
#[derive(Clone, Debug, Args)]
pub struct CheckArguments {
    /// The model.
    #[command(flatten)]
    pub model: ModelArguments,
    /// How to print
    #[arg(long, default_value = "text")]
    pub format: Format,
    /// Write to FILE instead of standard output
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
}

/// Arguments of `pc derive`.
#[derive(Clone, Debug, Args)]
pub struct DeriveArguments {
    /// The model.
    #[command(flatten)]
    pub model: ModelArguments,
    /// Velocities.
    #[command(flatten)]
    pub velocities: VelocityArguments,
    /// Form of the equations: poincare, canonical (in momenta), lagrange (in velocities, with multipliers where there
    /// are constraints), voronets (constraints solved for velocities), reduced (without coordinates that nothing depends on:
    /// Euler–Poincaré), lie-poisson (the same in momenta), orthonormal (in a frame that is orthonormal in the kinetic metric),
    /// hamel (in the quasi-velocities NAME=EXPR), maggi (Lagrange's expressions along the independent velocities), kane (active
    /// and inertia forces) or gibbs-appell (derivatives of the energy of the accelerations) [default: that of the file, or
    /// poincare]
    #[arg(long, value_name = "FORM", value_parser = form)]
    pub form: Option<Form>,
    /// How to print
    #[arg(long, default_value = "text")]
    pub format: Page,
    /// Width of a line in columns; longer expressions are broken between terms
    #[arg(long, value_name = "COLUMNS", default_value_t = 100, value_parser = clap::value_parser!(u16).range(60..))]
    pub width: u16,
    /// In text: print only the first line of each equation, without the definitions of the names given to long parts
    #[arg(long)]
    pub brief: bool,
    /// Write out the definitions of the model instead of naming them
    #[arg(long)]
    pub inline: bool,
    /// Print brackets by their coefficients c_rs^m, the symbols γ_rs^m of Boltzmann and Hamel
    #[arg(long)]
    pub symbols: bool,
    /// Print all reactions λ as functions of the state, and their forces on the velocities; in the forms poincare, lagrange,
    /// voronets, maggi, kane and gibbs-appell
    #[arg(long)]
    pub reactions: bool,
    /// Verification.
    #[command(flatten)]
    pub verify: VerifyArguments,
    /// Write to FILE instead of standard output
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
}

/// Whether equations are compared with a second derivation before they are printed or written.
#[derive(Clone, Copy, Debug, Default, Args)]
pub struct VerifyArguments {
    /// Do not compare the equations with a second derivation, at the start and near it
    #[arg(long)]
    pub no_verify: bool,
}

/// Arguments of `pc theory`.
#[derive(Clone, Debug, Args)]
pub struct TheoryArguments {
    /// The model.
    #[command(flatten)]
    pub model: ModelArguments,
    /// Look for integrals that are polynomials of up to this degree in the velocities
    #[arg(long, value_name = "N", default_value = "2", value_parser = clap::value_parser!(u32).range(1..=6))]
    pub degree: u32,
    /// Functions of the coordinates by which the coefficients of integrals may be multiplied, such as "1/r" (repeatable);
    /// polynomials in the coordinates, or in their sines and cosines, are always tried
    #[arg(long, value_name = "EXPRESSIONS", num_args = 1..)]
    pub functions: Vec<String>,
    /// Test functions as canonical variables: new coordinates, then as many new momenta, in coordinates, velocities and momenta
    /// such as p_x
    #[arg(long, value_name = "NAME=EXPR", num_args = 1.., value_parser = definition)]
    pub canonical: Vec<Setting>,
    /// How to print
    #[arg(long, default_value = "text")]
    pub format: Page,
    /// Verification.
    #[command(flatten)]
    pub verify: VerifyArguments,
    /// Write to FILE instead of standard output
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
}

/// The options of the search for events.
#[derive(Clone, Debug, Default, Args)]
pub struct EventArguments {
    /// Split each step into N equal parts, or more where the values leave doubt, to search for events whose functions are known
    /// only numerically (because of constraints, momenta or tables); an even number of zeros within one part may be missed
    /// [default: the file's, or 4]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub samples_per_step: Option<u32>,
    /// Events that follow each other ever faster are an error once the time left until they accumulate is this fraction of the
    /// first interval between them; 0 means never [default: the file's, or 1e-5]
    #[arg(long, value_name = "P", value_parser = part)]
    pub accumulation: Option<f64>,
}

/// How a motion is integrated.
#[derive(Clone, Debug, Default, Args)]
pub struct IntegrationArguments {
    /// Relative tolerance [default: the file's, or 1e-9]
    #[arg(long, value_name = "R", allow_hyphen_values = true, value_parser = positive)]
    pub rtol: Option<f64>,
    /// Absolute tolerance of all components of the state, or of one by its name (repeatable, or separated by commas)
    /// [default: the file's, or min(1e-12, rtol times the scale of the component at the start)]
    #[arg(long, value_name = "A|NAME=A", allow_hyphen_values = true, value_delimiter = ',', value_parser = tolerance)]
    pub atol: Vec<ToleranceSetting>,
    /// Largest step [default: the file's, or none]
    #[arg(long, value_name = "H", allow_hyphen_values = true, value_parser = positive)]
    pub max_step: Option<f64>,
    /// Largest number of steps from one row to the next; events do not count as steps [default: 500000]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub max_steps: Option<u64>,
    /// Events.
    #[command(flatten)]
    pub events: EventArguments,
    /// Method: auto (dop853, and bdf where stiffness is detected); adams, dop853 or taylor (not stiff); or bdf (stiff)
    /// [default: the file's, or auto]
    #[arg(long, value_name = "METHOD", value_parser = method)]
    pub method: Option<Method>,
}

/// `A`, or `NAME=A` for one component of the state.
#[derive(Clone, Debug, PartialEq)]
pub struct ToleranceSetting {
    /// The name of the component; none means all components.
    pub name: Option<String>,
    /// The tolerance.
    pub value: f64,
}

impl IntegrationArguments {
    /// The options of the integration.
    pub(crate) fn wishes(&self) -> Wishes {
        let all = self.atol.iter().rev().find(|setting| setting.name.is_none()).map(|setting| setting.value);
        let own = |setting: &ToleranceSetting| Some((setting.name.clone()?, setting.value));
        Wishes {
            rtol: self.rtol,
            atol: AbsoluteTolerance { all, each: self.atol.iter().filter_map(own).collect() },
            max_step: self.max_step,
            max_steps: self.max_steps,
            samples_per_step: self.events.samples_per_step,
            accumulation: self.events.accumulation,
            method: self.method,
            ..Wishes::default()
        }
    }
}

/// Arguments of `pc run`.
#[derive(Clone, Debug, Args)]
pub struct RunArguments {
    /// The model.
    #[command(flatten)]
    pub model: ModelArguments,
    /// Velocities.
    #[command(flatten)]
    pub velocities: VelocityArguments,
    /// End time [default: the file's]
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_parser = finite)]
    pub t_end: Option<f64>,
    /// Number of evenly spaced rows, start and end included [default: the file's, or 201]
    #[arg(long, value_name = "N", value_parser = rows)]
    pub rows: Option<usize>,
    /// Tolerances and method.
    #[command(flatten)]
    pub integration: IntegrationArguments,
    /// Form of the equations: poincare, canonical, reduced, lie-poisson, orthonormal, voronets or hamel (see `pc derive --help`).
    /// The columns are the same in every form, except that reduced and lie-poisson lack some coordinates, and hamel adds each
    /// NAME after the outputs [default: the file's, or poincare]
    #[arg(long, value_name = "FORM", value_parser = run_form)]
    pub form: Option<Variables>,
    /// Keep an integral, or energy, at its start value by projection after each step (repeatable)
    #[arg(long, value_name = "NAME")]
    pub project: Vec<String>,
    /// Further outputs.
    #[command(flatten)]
    pub outputs: OutputArguments,
    /// More columns: the derivatives ∂x/∂p of coordinates, quasi-velocities and first-order states with respect to these
    /// parameters, separated by commas; a start that depends on them, and events, are taken into account
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub sensitivities: Vec<String>,
    /// More columns: error(NAME), the estimated global error of each column NAME except those of --sensitivities. This error is
    /// the distance from a companion, a second motion that is integrated more accurately, by taylor at rtol 1e-16 where
    /// possible. The summary gives the errors at the end
    #[arg(long)]
    pub estimate: bool,
    /// Do not compare the motion at its start and at its end with a second derivation
    #[arg(long)]
    pub no_verify: bool,
    /// The table.
    #[command(flatten)]
    pub table: TableArguments,
    /// Its columns.
    #[command(flatten)]
    pub columns: ColumnArguments,
    /// Draw the motion into FILE.svg, FILE.png or FILE.pdf: curves of similar scale share axes, with events and the drift of
    /// integrals; the curves also follow the motion between the rows
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
    /// What is drawn.
    #[command(flatten)]
    pub drawn: DrawnArguments,
    /// Checkpoints.
    #[command(flatten)]
    pub checkpoints: CheckpointArguments,
}

impl RunArguments {
    /// The options of the run.
    pub(crate) fn wishes(&self) -> Wishes {
        Wishes {
            form: self.form,
            t_end: self.t_end,
            samples: self.rows,
            sensitivities: self.sensitivities.clone(),
            ..self.integration.wishes()
        }
    }
}

/// Arguments of `pc emit`.
#[derive(Clone, Debug, Args)]
pub struct EmitArguments {
    /// The model.
    #[command(flatten)]
    pub model: ModelArguments,
    /// Language of the source
    #[arg(long, required_unless_present = "fmu", conflicts_with = "fmu")]
    pub lang: Option<Lang>,
    /// Write a Functional Mock-up Unit of this version of FMI, for Model Exchange and Co-Simulation, with sources and a binary for this
    /// machine
    #[arg(long, value_name = "VERSION")]
    pub fmu: Option<FmuVersion>,
    /// With --fmu: how the FMU integrates by itself in Co-Simulation: dop853 (not stiff), radau5 (stiff) or rk4 (fixed steps,
    /// see --step) [default: radau5 where the model says bdf or auto, else dop853]
    #[arg(long, value_name = "METHOD", requires = "fmu", conflicts_with = "lang")]
    pub solver: Option<FmuMethod>,
    /// With --solver rk4: the length of its steps
    #[arg(long, value_name = "H", allow_hyphen_values = true, value_parser = positive, requires = "solver", required_if_eq("solver", "rk4"))]
    pub step: Option<f64>,
    /// With --fmu: leave out the binary; importers then compile the sources
    #[arg(long, requires = "fmu", conflicts_with = "lang")]
    pub sources_only: bool,
    /// Velocities.
    #[command(flatten)]
    pub velocities: VelocityArguments,
    /// Form of the equations: poincare, reduced, orthonormal, voronets or hamel (see `pc derive --help`)
    #[arg(long, value_name = "FORM", default_value = "poincare", value_parser = emit_form)]
    pub form: Variables,
    /// Leave out the Jacobian
    #[arg(long, conflicts_with = "fmu")]
    pub no_jacobian: bool,
    /// Verification.
    #[command(flatten)]
    pub verify: VerifyArguments,
    /// Output directory, created if it does not exist, or `-` for standard output (Rust only); with --fmu the file to write
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,
}

/// Versions of FMI.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum FmuVersion {
    /// FMI 2.0.
    #[value(name = "2")]
    V2,
    /// FMI 3.0.
    #[value(name = "3")]
    V3,
}

/// How an FMU integrates by itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum FmuMethod {
    /// The Runge–Kutta method of order 8 of Dormand and Prince.
    Dop853,
    /// Radau's implicit Runge–Kutta method of order 5.
    Radau5,
    /// The Runge–Kutta method of order 4, with fixed steps.
    Rk4,
}

/// Languages of emitted source.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Lang {
    /// C99, which is also C++: a header and a source file.
    C,
    /// Rust: one file.
    Rust,
}

/// Arguments of `pc import`.
#[derive(Clone, Debug, Args)]
pub struct ImportArguments {
    /// The robot, in URDF with macros expanded, in MJCF or in SDF; `-` for standard input
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// In URDF: let the root link move freely; otherwise it is fixed
    #[arg(long)]
    pub floating: bool,
    /// Fix the joints that move no mass, with a note for each; otherwise they are an error
    #[arg(long)]
    pub fix_massless: bool,
    /// Turn the limits of joints into rigid stops with the coefficient E of restitution, from 0 to 1; otherwise they become comments
    #[arg(long, value_name = "E", value_parser = restitution)]
    pub limits: Option<f64>,
    /// The model to write; standard output if it is not given
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
}

/// A number from 0 to 1.
fn restitution(text: &str) -> Result<f64, String> {
    let number: Option<f64> = text.parse().ok().filter(|number| (0.0..=1.0).contains(number));
    number.ok_or_else(|| "a coefficient of restitution is a number from 0 to 1".to_owned())
}

/// Arguments of `pc export`.
#[derive(Clone, Debug, Args)]
pub struct ExportArguments {
    /// The model.
    #[command(flatten)]
    pub model: ModelArguments,
    /// Write to FILE instead of standard output
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
}

/// How a result is printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// For people.
    Text,
    /// For programs.
    Json,
}

/// How equations are printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Page {
    /// For people.
    Text,
    /// For a paper.
    Latex,
    /// For programs.
    Json,
}

impl From<Page> for pc_print::Page {
    fn from(page: Page) -> Self {
        match page {
            Page::Text => pc_print::Page::Text,
            Page::Latex => pc_print::Page::Latex,
            Page::Json => pc_print::Page::Json,
        }
    }
}

pub(crate) fn definition(text: &str) -> Result<Setting, String> {
    setting(text).map_err(|_| "write NAME=EXPR, as in `\"v=r*φ'\"`".to_owned())
}

pub(crate) fn setting(text: &str) -> Result<Setting, String> {
    match text.split_once('=') {
        Some((name, value)) if !name.trim().is_empty() => {
            Ok(Setting { name: name.trim().to_owned(), value: value.trim().to_owned() })
        }
        _ => Err("write NAME=VALUE, as in `--set m=2.5`".to_owned()),
    }
}

pub(crate) fn finite(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err("write a finite number, such as 10 or 1e-3".to_owned()),
    }
}

pub(crate) fn tolerance(text: &str) -> Result<ToleranceSetting, String> {
    let (name, value) = match text.split_once('=') {
        Some((name, value)) => (Some(name.trim().to_owned()), value.trim()),
        None if text.trim().parse::<f64>().is_err() => {
            return Err(
                "write a tolerance, as in `--atol 1e-12`, or NAME=A, as in `--atol x=1e-15`".to_owned()
            );
        }
        None => (None, text),
    };
    Ok(ToleranceSetting { name, value: positive(value)? })
}

pub(crate) fn positive(text: &str) -> Result<f64, String> {
    match finite(text)? {
        value if value > 0.0 => Ok(value),
        _ => Err("it must be positive".to_owned()),
    }
}

pub(crate) fn not_negative(text: &str) -> Result<f64, String> {
    match finite(text)? {
        value if value >= 0.0 => Ok(value),
        _ => Err("it must not be negative".to_owned()),
    }
}

/// Reads a fraction that is at least 0 and less than 1.
fn part(text: &str) -> Result<f64, String> {
    match finite(text)? {
        value if (0.0..1.0).contains(&value) => Ok(value),
        _ => Err("write a fraction from 0 to less than 1, such as 1e-6".to_owned()),
    }
}

pub(crate) fn rows(text: &str) -> Result<usize, String> {
    match text.parse::<usize>() {
        Ok(count) if (2..=MOST_SAMPLES).contains(&count) => Ok(count),
        _ => Err(format!("write a whole number from 2 (start and end) to {MOST_SAMPLES}")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_are_split_at_the_first_equals_sign() {
        let set = |name: &str, value: &str| Setting { name: name.into(), value: value.into() };
        assert_eq!(setting("m=2"), Ok(set("m", "2")));
        assert_eq!(setting("m = -1e3"), Ok(set("m", "-1e3")));
        assert_eq!(setting("m=a=b"), Ok(set("m", "a=b")));
        assert!(setting("m").is_err() && setting("=2").is_err());
    }
}
