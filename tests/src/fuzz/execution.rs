//! A text run through the product in every form, as the program does.

use pc_expr::{Events, VectorField};
use pc_mech::{EmitOptions, Equations, Graph, Language};
use pc_model::{Assembly, Document, Flow, Model, ModelError, Source, Variables};
use pc_solve::{Occurrence, Options, Solve, Trajectory};

use pc_verify::{Agreement, VerifyError, verify};

use super::comparison::exceeds;
use crate::emitted::{Emitted, Routine};

/// Relative tolerance of the motions that are compared.
pub const RTOL: f64 = 1e-11;
/// Absolute tolerance of the motions that are compared.
pub const ATOL: f64 = 1e-13;
/// Rows of a motion.
pub const SAMPLES: usize = 5;

/// States at which a model is compared with its second derivation: an error is seen at almost all.
const STATES: usize = 6;

/// The tolerances of the same motion once more, to see what errors of integration grow to.
const LOOSE: f64 = 1e2;

/// Steps from one row to the next, as many as the program takes. Motions are smooth and need some ten, but a coordinate that is
/// carried along, such as sin x of an x that grows to a thousand, needs as many as it turns.
const MOST_STEPS: u64 = 500_000;

/// The part of the time span by which a state is moved to both sides of an event.
const ASIDE: f64 = 1e-7;

/// The stage of a motion that could not be followed to its end.
pub const GIVEN_UP: &str = "integration";

/// Something that the product did not do, at which stage, and what it said.
#[derive(Clone, Debug, PartialEq)]
pub struct Refusal {
    /// What was to be done.
    pub stage: &'static str,
    /// What was said.
    pub message: String,
}

impl Refusal {
    fn new(stage: &'static str, message: &impl ToString) -> Refusal {
        Refusal { stage, message: message.to_string() }
    }

    /// The kind of refusal: what its first line says, without place, names, numbers and states.
    pub fn cause(&self) -> String {
        let line = self.message.lines().next().unwrap_or_default();
        let mut parts = line.splitn(3, ": ");
        let message = match (parts.next(), parts.next(), parts.next()) {
            (Some(_), Some(entry), Some(message)) if entry.starts_with('[') => message,
            _ => line,
        };
        let mut cause = String::new();
        let (mut quoted, mut depth) = (false, 0u32);
        for c in message.chars() {
            match c {
                '`' => {
                    quoted = !quoted;
                    cause.push_str(if quoted { "`…" } else { "`" });
                }
                _ if quoted => {}
                '(' | '[' => depth += 1,
                ')' | ']' => depth = depth.saturating_sub(1),
                _ if depth > 0 => {}
                c if c.is_ascii_digit() => {
                    if !cause.ends_with('#') {
                        cause.push('#');
                    }
                }
                c => cause.push(c),
            }
        }
        for noise in ["#.#", "#e-#", "#e#", "-#"] {
            while cause.contains(noise) {
                cause = cause.replace(noise, "#");
            }
        }
        format!("{}: {}", self.stage, cause.trim_end())
    }
}

/// What occurred.
#[derive(Clone, Debug)]
pub struct Happening {
    /// The name of the event.
    pub event: String,
    /// When.
    pub time: f64,
    /// The row before.
    pub before: Vec<f64>,
    /// The row after.
    pub after: Vec<f64>,
    /// The function of the event a little before and after, along the motion that led there.
    pub sides: [f64; 2],
}

/// A motion as a table.
#[derive(Clone, Debug)]
pub struct Motion {
    /// The names of the columns, without the time.
    pub columns: Vec<String>,
    /// The times of the rows.
    pub times: Vec<f64>,
    /// The rows.
    pub rows: Vec<Vec<f64>>,
    /// What occurred, in order.
    pub happenings: Vec<Happening>,
    /// How far tolerances a hundred times as large move each column, and the time of each event; none where other events
    /// occur then, or the motion is not followed.
    pub moved: Option<Moved>,
    /// The largest residual of a constraint, with its name.
    pub residual: Option<(String, f64)>,
}

/// How far looser tolerances move a motion.
#[derive(Clone, Debug)]
pub struct Moved {
    /// Each column of each row, at most until then.
    pub rows: Vec<Vec<f64>>,
    /// The time of each event.
    pub happenings: Vec<f64>,
}

/// A model run through the product.
#[derive(Debug)]
pub struct Execution {
    /// Its motion in quasi-velocities.
    pub motion: Motion,
    /// Its motion in momenta.
    pub canonical: Option<Result<Motion, Refusal>>,
    /// Its motion, projected to its energy; where that is claimed to be kept.
    pub projected: Option<Result<Motion, Refusal>>,
    /// Whether the energy is claimed to be kept.
    pub keeps_energy: bool,
    /// The integrals that are claimed to be kept between events, or why nothing is claimed.
    pub conserved: Result<Vec<String>, Refusal>,
    /// Its emitted source, with states and what the interpreter makes of them.
    pub emitted: Option<Result<Emission, Refusal>>,
    /// What a second derivation says.
    pub second: Option<Result<Agreement, VerifyError>>,
}

/// What emitted source has to compute.
#[derive(Debug)]
pub struct Emission {
    /// The source.
    pub source: Emitted,
    /// t, state, parameters
    pub inputs: Vec<Vec<f64>>,
    /// The rates there.
    pub rates: Vec<Vec<f64>>,
}

/// In which forms a model is to be run.
#[derive(Clone, Copy, Debug)]
pub struct Forms {
    /// In momenta, with claims of conservation, and projected.
    pub all: bool,
    /// As source.
    pub emitted: bool,
    /// Beside its second derivation.
    pub second: bool,
    /// The absolute tolerance of its motions, smaller where lengths are.
    pub atol: f64,
}

impl Forms {
    /// The motion in quasi-velocities alone.
    pub const ONE: Forms = Forms { all: false, emitted: false, second: false, atol: ATOL };
}

/// Runs a text; what it is called names emitted source.
///
/// # Errors
/// [`Refusal`] if there is no motion in quasi-velocities.
pub fn execute(name: &str, text: &str, forms: Forms) -> Result<Execution, Refusal> {
    let document = Document::parse(Source::new(name, text)).map_err(|e| Refusal::new("text", &e))?;
    let mut model = Model::new(document);
    model.observe_reactions(true);
    let graph = Graph::new();
    let assembly = model.assemble(&graph).map_err(|e| Refusal::new("model", &e))?;
    let mut flow =
        Flow::new(&model, &assembly, Variables::QuasiVelocities).map_err(|e| Refusal::new("model", &e))?;
    let motion = follow(&mut flow, &model, &assembly, forms.atol)?;
    let resets = assembly.events.iter().any(|event| !event.resets.is_empty());
    let keeps_energy = assembly.keeps_energy() && !resets;
    let canonical = forms.all.then(|| {
        let flow = Flow::new(&model, &assembly, Variables::Momenta);
        let mut flow = flow.map_err(|error| Refusal::new("canonical form", &error))?;
        follow(&mut flow, &model, &assembly, forms.atol)
    });
    let projected = (forms.all && keeps_energy).then(|| projected(model.clone(), forms.atol));
    let equations = assembly.equations().map_err(|error| Refusal::new("independent velocities", &error));
    let conserved = match (&equations, forms.all) {
        (Ok(equations), true) => Ok(conserved(equations)),
        (Err(refusal), true) => Err(refusal.clone()),
        (_, false) => Ok(Vec::new()),
    };
    let emitted = forms.emitted.then(|| emission(name, &assembly, &equations?));
    model.observe_reactions(false);
    let second = forms.second.then(|| {
        model.derived(|assembly| {
            verify(&model, assembly, &pc_verify::Options { states: STATES, ..pc_verify::Options::default() })
        })
    });
    Ok(Execution { motion, canonical, projected, keeps_energy, conserved, emitted, second })
}

fn projected(mut model: Model, atol: f64) -> Result<Motion, Refusal> {
    let refused = |error: ModelError| Refusal::new("projection", &error);
    model.keep("energy").map_err(|error| Refusal::new("projection", &error))?;
    let graph = Graph::new();
    let assembly = model.assemble(&graph).map_err(refused)?;
    let mut flow = Flow::new(&model, &assembly, Variables::QuasiVelocities).map_err(refused)?;
    follow(&mut flow, &model, &assembly, atol)
}

fn conserved(equations: &Equations<'_>) -> Vec<String> {
    let rates = pc_analysis::Rates::poincare(equations);
    let integrals = equations.system().integrals().iter();
    let kept = integrals
        .filter(|(_, value)| rates.verdict(*value).is_ok_and(pc_analysis::Conservation::is_conserved));
    kept.map(|(name, _)| name.clone()).collect()
}

fn emission<'g>(name: &str, assembly: &Assembly<'g>, equations: &Equations<'g>) -> Result<Emission, Refusal> {
    let refused = |error: pc_mech::MechError| Refusal::new("emission", &error);
    let system = equations.system();
    let state = system.state();
    let start = assembly.start_of(&state);
    let routines = vec![Routine { name: "rhs", outputs: Some(state.len()) }];
    let source = Emitted::new(equations, |language: Language| EmitOptions::new(language, name), routines);
    let source = source.map_err(refused)?;
    let mut motion = equations.compile_for(pc_mech::Backend::Interpreter).map_err(refused)?;
    let (mut inputs, mut rates) = (Vec::new(), Vec::new());
    for i in 0..8 {
        let moved = |(j, y): (usize, &f64)| y + f64::from(i) * 1e-2 * (1.0 + j as f64).sin();
        let y: Vec<f64> = start.iter().enumerate().map(moved).collect();
        let mut rate = vec![f64::NAN; y.len()];
        if motion.rhs(assembly.t_start, &y, &mut rate).is_ok() {
            inputs.push([&[assembly.t_start], &y[..], motion.parameters()].concat());
            rates.push(rate);
        }
    }
    Ok(Emission { source, inputs, rates })
}

/// The motion, and how far looser tolerances move it.
fn follow(flow: &mut Flow, model: &Model, assembly: &Assembly<'_>, atol: f64) -> Result<Motion, Refusal> {
    let motion = integrate(flow, model, assembly, [RTOL, atol])?;
    let moved = integrate(flow, model, assembly, [RTOL * LOOSE, atol * LOOSE])
        .ok()
        .and_then(|loose| moved(&motion, &loose));
    Ok(Motion { moved, ..motion })
}

fn moved(motion: &Motion, loose: &Motion) -> Option<Moved> {
    let names = |motion: &Motion| motion.happenings.iter().map(|h| h.event.clone()).collect::<Vec<_>>();
    if names(motion) != names(loose) || motion.times.len() != loose.times.len() {
        return None;
    }
    let mut worst = vec![0.0; motion.columns.len()];
    let rows = motion.rows.iter().zip(&loose.rows).map(|(a, b)| {
        for (worst, (a, b)) in worst.iter_mut().zip(a.iter().zip(b)) {
            let moved = f64::abs(a - b);
            // f64::max would lose what is no number
            *worst = if moved <= *worst { *worst } else { moved };
        }
        worst.clone()
    });
    let rows = rows.collect();
    let happenings = motion.happenings.iter().zip(&loose.happenings).map(|(a, b)| (a.time - b.time).abs());
    Some(Moved { rows, happenings: happenings.collect() })
}

fn integrate(
    flow: &mut Flow,
    model: &Model,
    assembly: &Assembly<'_>,
    [rtol, atol]: [f64; 2],
) -> Result<Motion, Refusal> {
    let t_start = assembly.t_start;
    let t_end = model.document().simulation.t_end.as_ref().map_or(t_start, |t| t.value);
    let last = (SAMPLES - 1) as f64;
    let times: Vec<f64> = (0..SAMPLES).map(|i| t_start + (t_end - t_start) * (i as f64 / last)).collect();
    let options = Options::default().relative_tolerance(rtol).absolute_tolerance(atol);
    let options = options.max_steps(MOST_STEPS);
    let start = flow.start.clone();
    let solved =
        Solve::new(&mut flow.motion, t_start, &start).method(&options).events(&mut flow.events).run(&times);
    let solved = solved.map_err(|failure| Refusal::new(GIVEN_UP, &failure.error))?;
    let residual = residual(flow, &solved.trajectory);
    let names: Vec<String> = flow.events.events().iter().map(|event| event.name().to_owned()).collect();
    let aside = ASIDE * (t_end - t_start);
    let happenings = solved
        .occurrences
        .iter()
        .map(|occurrence| Happening {
            event: names[occurrence.event].clone(),
            time: occurrence.time,
            before: flow.row(occurrence.time, &occurrence.state_before),
            after: flow.row(occurrence.time, &occurrence.state_after),
            sides: sides(flow, occurrence, aside),
        })
        .collect();
    let columns = flow.names.iter().chain(flow.motion.observable_names()).cloned().collect();
    let (times, rows) = solved.trajectory.iter().map(|(t, y)| (t, flow.row(t, y))).unzip();
    Ok(Motion { columns, times, rows, happenings, moved: None, residual })
}

fn residual(flow: &mut Flow, trajectory: &Trajectory) -> Option<(String, f64)> {
    let names = flow.constraint_names();
    let mut worst: Option<(String, f64)> = None;
    for (t, y) in trajectory.iter() {
        for (name, residual) in names.iter().zip(flow.constraint_residuals(t, y)) {
            if worst.as_ref().is_none_or(|(_, worst)| exceeds(residual, *worst)) {
                worst = Some((name.clone(), residual.abs()));
            }
        }
    }
    worst
}

/// The function of an event at y⁻ ∓ aside ẏ; no numbers where there are no rates.
fn sides(flow: &mut Flow, occurrence: &Occurrence, aside: f64) -> [f64; 2] {
    let y = &occurrence.state_before;
    let mut rate = vec![f64::NAN; y.len()];
    if flow.motion.rhs(occurrence.time, y, &mut rate).is_err() {
        return [f64::NAN; 2];
    }
    [-aside, aside].map(|aside| {
        let moved: Vec<f64> = y.iter().zip(&rate).map(|(y, rate)| y + aside * rate).collect();
        let mut values = vec![f64::NAN; flow.events.events().len()];
        match flow.events.evaluate(occurrence.time + aside, &moved, &mut values) {
            Ok(()) => values[occurrence.event],
            Err(_) => f64::NAN,
        }
    })
}
