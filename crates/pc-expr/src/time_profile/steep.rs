//! Functions of the state that may rise and fall within a step.
//!
//! A barrier such as exp(−((x − a)/w)²) is invisible from afar, and 1/(1 + ((x − a)/w)²) nearly so: a motion that
//! is carried over it in one step never feels it. Along the polynomial of a step such functions are enclosed by
//! interval arithmetic [Moore 1966], like functions of time. Most steps need one enclosure: it shows that the
//! function hardly changes, or that it has no plateau from which to rise. Fields without such functions need none.

use super::interval::Interval;
use super::jet::Jet;
use super::motion::PolynomialMotion;
use super::part::{Motion, Part, Watch, motions};
use super::scan::Scan;
use super::surprises::{Seen, Surprises, Watched};
use crate::graph::function::Function;
use crate::program::program::{Instruction, Program, Register};

/// The greatest number of instructions, leading to the functions of a program, that are examined on each step.
const LONGEST: usize = 256;
/// A function that is never 0 and changes by less than this factor hides nothing.
const FACTOR: f64 = 10.0;
/// A function with values from −1 to 1 that changes by less than this hides nothing either.
const CHANGE: f64 = 0.5;

/// The evidence that a function hides nothing in an interval.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// The function keeps its size, or only rises or falls: an exponential has no plateau.
    Exponential,
    /// The divisor, in this register, keeps its size, or only rises or falls far from its least possible value.
    /// The dividend does not matter: it is not hidden, or is one of these functions itself.
    Reciprocal { divisor: usize, least: f64 },
    /// The function hardly changes.
    Bounded,
    /// There is no such evidence for a function of time and state.
    Moving,
}

impl Kind {
    /// The value that is watched to judge the function in a register.
    fn watch(self, place: usize) -> Watch {
        match self {
            Kind::Reciprocal { divisor, .. } => Watch::Reciprocal(divisor),
            _ => Watch::Value(place),
        }
    }

    /// Whether a function hides nothing if its jet is the given one, and registers are those of `part`.
    fn is_quiet(self, jet: &Jet, part: &Part) -> bool {
        let keeps_size = |Interval { lo, hi }| lo > 0.0 && hi < FACTOR * lo || hi < 0.0 && lo > FACTOR * hi;
        match self {
            Kind::Exponential => keeps_size(jet.value) || jet.rate.sign().is_some(),
            Kind::Reciprocal { divisor, least } => {
                let Jet { value, rate, .. } = part.at(divisor);
                let smallest = value.lo.max(-value.hi);
                keeps_size(value) || rate.sign().is_some() && smallest > FACTOR * least
            }
            Kind::Bounded => jet.value.width() < CHANGE,
            Kind::Moving => false,
        }
    }
}

/// The functions of the state in a vector field whose rise and fall a step may miss, followed along a motion.
///
/// ```
/// use pc_expr::{Graph, Inputs, PolynomialMotion, Program, SteepFunctions};
///
/// // A barrier at 5 of the width 0.001, passed by y = t.
/// let graph = Graph::new();
/// let y = graph.symbol("y");
/// let rate = 1.0 - (-((y - 5.0) / 1e-3).square()).exp();
/// let program = Program::new(&graph, &Inputs { time: None, state: vec![y], parameters: vec![] }, &[rate])?;
/// let mut steep = SteepFunctions::of(&[&program], 1, &[]).unwrap();
/// let motion = PolynomialMotion { start: 0.0, coefficients: &[0.0, 1.0] };
/// let hidden = steep.surprises((0.0, 10.0), motion, false);
/// assert!(hidden.few.iter().any(|t| (t - 5.0).abs() < 1e-3));
/// assert!(steep.surprises((0.0, 4.9), motion, false).few.is_empty());
/// # Ok::<(), pc_expr::ExprError>(())
/// ```
#[derive(Clone, Debug)]
pub struct SteepFunctions {
    parts: Vec<Followed>,
    dim: usize,
    /// The time from which the times of queries and answers are counted.
    origin: f64,
    room: Vec<Seen>,
    times: Surprises,
}

impl SteepFunctions {
    /// The steep functions of rates computed by these programs, whose states begin with `dim` components of y, for
    /// these values of the parameters; `None` if there are no such functions.
    pub fn of(programs: &[&Program], dim: usize, parameters: &[f64]) -> Option<SteepFunctions> {
        let followed = |program: &&Program| Followed::of(program, dim, parameters);
        let parts: Vec<Followed> = programs.iter().filter_map(followed).collect();
        let (room, times) = (Vec::new(), Surprises::default());
        (!parts.is_empty()).then_some(SteepFunctions { parts, dim, origin: 0.0, room, times })
    }

    /// Whether a program has steep functions of time and state that are too long to be followed.
    pub(crate) fn are_too_long(program: &Program, dim: usize) -> bool {
        let motions = motions(program);
        let moving = steep(program, &[], &motions).filter(|&(_, kind)| kind == Kind::Moving);
        let moving: Vec<Watch> = moving.map(|(place, kind)| kind.watch(place)).collect();
        let parameters = vec![f64::NAN; program.parameters_len()];
        !moving.is_empty() && !is_followed(&Part::new(program, &parameters, moving), dim)
    }

    /// The same functions, for times that are counted from `origin`.
    #[must_use]
    pub fn since(self, origin: f64) -> SteepFunctions {
        SteepFunctions { origin: self.origin + origin, ..self }
    }

    /// The same functions, for states of `len` components that begin with those of y.
    #[must_use]
    pub fn in_states_of(self, len: usize) -> SteepFunctions {
        SteepFunctions { dim: len, ..self }
    }

    /// Those of the functions that depend only on the first `len` components of the state; `None` if there
    /// are none.
    #[must_use]
    pub fn of_components(mut self, len: usize) -> Option<SteepFunctions> {
        self.parts.retain(|followed| followed.watched.part.reads_only(len));
        (!self.parts.is_empty()).then_some(self)
    }

    /// Whether one of the functions may hide something between two times along the motion: a first look,
    /// coarser than [`surprises`](SteepFunctions::surprises).
    pub fn hide(&mut self, (t, to): (f64, f64), motion: PolynomialMotion<'_>) -> bool {
        let (between, along) = self.counted((t, to), motion);
        self.parts.iter_mut().any(|followed| !followed.is_quiet(between, along))
    }

    /// The times between `t` and `to`, in order, at which values and rates at these two times may not show what a
    /// function does in between, along the motion.
    ///
    /// If there are thousands of such times, the list ends at one of them, and sooner if that happens again and again;
    /// with `enough`, the remaining time is examined coarsely.
    pub fn surprises(
        &mut self,
        (t, to): (f64, f64),
        motion: PolynomialMotion<'_>,
        enough: bool,
    ) -> &Surprises {
        let direction = if to < t { -1.0 } else { 1.0 };
        let (between, along) = self.counted((t, to), motion);
        self.times.forget();
        for followed in &mut self.parts {
            let is_quiet = followed.is_quiet(between, along);
            if !is_quiet {
                let Watched { part, scan } = &mut followed.watched;
                part.attend_to(&followed.loud);
                scan.begin(part, between.0, between.1, along);
                self.times.add(&mut followed.watched, between, along, enough, &mut self.room);
            }
            let scan = &mut followed.watched.scan;
            scan.adapt(!is_quiet && scan.is_exhausted());
        }
        self.times.arrange(direction, self.origin);
        &self.times
    }

    /// Times and a motion as the programs count them, with the length of its states.
    fn counted<'m>(
        &self,
        (t, to): (f64, f64),
        motion: PolynomialMotion<'m>,
    ) -> ((f64, f64), (PolynomialMotion<'m>, usize)) {
        let motion = PolynomialMotion { start: self.origin + motion.start, ..motion };
        ((self.origin + t, self.origin + to), (motion, self.dim))
    }
}

/// The functions of a program that are followed, with their kinds.
#[derive(Clone, Debug)]
struct Followed {
    watched: Watched,
    kinds: Vec<Kind>,
    /// Which functions may hide something where they were last examined.
    loud: Vec<bool>,
}

impl Followed {
    /// `None` if there are no such functions, or if they are too long.
    fn of(program: &Program, dim: usize, parameters: &[f64]) -> Option<Followed> {
        let motions = motions(program);
        // For most programs this is known without the ranges of values.
        if !(program.first_result()..).zip(program.code()).any(|at| may_be_steep(at, &motions)) {
            return None;
        }
        let steep = steep(program, parameters, &motions).map(|(place, kind)| (kind.watch(place), kind));
        let (watched, kinds): (Vec<Watch>, Vec<Kind>) = steep.unzip();
        let mut part = Part::new(program, parameters, watched);
        part.shows_rises = true;
        let is_followed = !part.is_empty() && is_followed(&part, dim);
        let loud = vec![true; kinds.len()];
        is_followed.then(|| Followed { watched: Watched { part, scan: Scan::new() }, kinds, loud })
    }

    /// Whether none of the functions hides anything between two times along a motion.
    fn is_quiet(&mut self, between: (f64, f64), along: (PolynomialMotion<'_>, usize)) -> bool {
        let part = &mut self.watched.part;
        self.loud.fill(true);
        part.attend_to(&self.loud);
        part.enclose(between, along);
        for ((loud, jet), kind) in self.loud.iter_mut().zip(part.jets()).zip(&self.kinds) {
            *loud = !kind.is_quiet(&jet, part);
        }
        !self.loud.contains(&true)
    }
}

fn is_followed(part: &Part, dim: usize) -> bool {
    part.len() <= LONGEST && part.reads_only(dim)
}

/// The registers of the functions that may rise and fall within a step, with their kinds; without parameters those
/// of time and state.
fn steep<'a>(
    program: &'a Program,
    parameters: &[f64],
    motions: &'a [Motion],
) -> impl Iterator<Item = (usize, Kind)> + 'a {
    let ranges = ranges(program, parameters);
    (program.first_result()..).zip(program.code()).filter_map(move |(place, instruction)| {
        let motion = motions[place];
        let kind = match (motion.state, motion.time) {
            (true, true) if changes_faster(instruction, motions) => Kind::Moving,
            (true, false) if may_be_steep((place, instruction), motions) => kind(instruction, &ranges)?,
            _ => return None,
        };
        Some((place, kind))
    })
}

/// Whether the function in a register is one of those that [`steep`] examines.
fn may_be_steep((place, instruction): (usize, &Instruction), motions: &[Motion]) -> bool {
    let motion = motions[place];
    let of_state = match *instruction {
        Instruction::Divide(_, b) => motions[b.index()].state,
        Instruction::Call(Function::Pow | Function::Exp | Function::Tanh | Function::Atan, _) => true,
        _ => false,
    };
    motion.state && (of_state || motion.time && changes_faster(instruction, motions))
}

/// Whether a function of t and the state may change much faster than its arguments.
fn changes_faster(instruction: &Instruction, motions: &[Motion]) -> bool {
    let mixed = |register: Register| motions[register.index()].is_mixed();
    match *instruction {
        Instruction::Divide(_, b) => mixed(b),
        Instruction::Call(Function::Sin | Function::Cos, _) => false,
        Instruction::Call(..) => instruction.operands().any(mixed),
        _ => false,
    }
}

/// The kind of a function of the state whose possible values are so far apart that it may have a peak between
/// plateaus.
fn kind(instruction: &Instruction, ranges: &[Interval]) -> Option<Kind> {
    let range = |register: Register| ranges[register.index()];
    // A divisor that is never 0 and may be much larger than its least value.
    let reciprocal = |divisor: Register| {
        let least = range(divisor).lo.max(-range(divisor).hi);
        let is_wide = least > 0.0 && range(divisor).size() > FACTOR.powi(2) * least;
        is_wide.then_some(Kind::Reciprocal { divisor: divisor.index(), least })
    };
    match *instruction {
        Instruction::Divide(_, b) => reciprocal(b),
        Instruction::Call(Function::Pow, [a, c, _]) if range(c).hi < 0.0 => reciprocal(a),
        Instruction::Call(Function::Exp, [a, ..]) => {
            (range(a).width() >= FACTOR.ln()).then_some(Kind::Exponential)
        }
        Instruction::Call(Function::Tanh | Function::Atan, [a, ..]) => {
            (range(a).width() >= CHANGE).then_some(Kind::Bounded)
        }
        _ => None,
    }
}

/// The values of each register over all times and states.
fn ranges(program: &Program, parameters: &[f64]) -> Vec<Interval> {
    let anything = Jet { value: Interval::ALL, rate: Interval::ALL, bend: Interval::ALL };
    let mut registers = vec![anything; program.registers_len()];
    for (register, &value) in registers.iter_mut().zip(program.constants()) {
        *register = Jet::constant(value);
    }
    let inputs = &mut registers[program.first_input() + 1 + program.state_len()..];
    for (register, &value) in inputs.iter_mut().zip(parameters) {
        *register = Jet::constant(value);
    }
    let first = program.first_result();
    for (i, instruction) in program.code().iter().enumerate() {
        registers[first + i] = Jet::of(instruction, |register| registers[register.index()]);
    }
    registers.into_iter().map(|jet| jet.value).collect()
}
