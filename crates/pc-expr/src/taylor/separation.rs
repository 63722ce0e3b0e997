//! Times between which a function along a motion has at most one root.
//!
//! Over an interval of time the functions and their first two derivatives are enclosed by interval arithmetic
//! [Moore 1966], the motion being a polynomial. A function whose enclosure excludes zero has no root there;
//! one whose rate excludes zero has at most one; other intervals are halved. Where the sign changes from one interval
//! without a root to the next, the function jumps between them.

use std::sync::Arc;

use crate::program::program::{Instruction, Program};
use crate::time_profile::interval::Interval;
use crate::time_profile::jet::Jet;
use crate::time_profile::motion::PolynomialMotion;

/// The shortest interval that is resolved, as a fraction of the whole.
const RESOLVED: f64 = 1e-14;
/// The maximum number of intervals examined: enough for hundreds of roots.
const MOST: usize = 4096;
/// The maximum number of intervals of the shortest length in which a root is neither excluded nor single: where a
/// function only touches zero, or is nothing but rounding error.
const VAGUE: usize = 64;
/// The number of intervals with a possible root after which the search ends: a search for the first root does
/// not need them all.
const ENOUGH: usize = 32;

/// Separates the roots of the outputs of a program along motions.
///
/// ```
/// use std::sync::Arc;
/// use pc_expr::{Graph, Inputs, PolynomialMotion, Program, RootSeparation};
///
/// // y = s: the roots of (y − 0.5)(y − 0.5001) are separated.
/// let graph = Graph::new();
/// let y = graph.symbol("y");
/// let inputs = Inputs { time: None, state: vec![y], parameters: vec![] };
/// let program = Program::new(&graph, &inputs, &[(y - 0.5) * (y - 0.5001)])?;
/// let mut separation = RootSeparation::new(Arc::new(program));
/// let motion = PolynomialMotion { start: 0.0, coefficients: &[0.0, 1.0] };
/// let mut places = Vec::new();
/// assert!(separation.separate(motion, (0.0, 1.0), &[], &mut places));
/// assert!(places.iter().any(|s| 0.5 < *s && *s < 0.5001));
/// # Ok::<(), pc_expr::ExprError>(())
/// ```
#[derive(Clone, Debug)]
pub struct RootSeparation {
    program: Arc<Program>,
    /// The components of the state that the outputs contain.
    used: Vec<bool>,
    /// The outputs whose roots do not matter.
    left_out: Vec<bool>,
    registers: Vec<Jet>,
    local: Vec<f64>,
    open: Vec<(f64, f64)>,
    at_middle: Vec<Jet>,
    /// The signs of the outputs in the last two intervals; 0 where they may have a root.
    signs: Vec<i8>,
    signs_before: Vec<i8>,
}

impl RootSeparation {
    /// The separation for the outputs of a program.
    pub fn new(program: Arc<Program>) -> RootSeparation {
        let mut used = vec![false; program.state_len()];
        let operands = program.code().iter().flat_map(Instruction::operands);
        for register in operands.chain(program.outputs().iter().copied()) {
            let place = register.index().checked_sub(program.first_input() + 1);
            if let Some(place) = place.filter(|&place| place < used.len()) {
                used[place] = true;
            }
        }
        let registers = vec![Jet::constant(0.0); program.registers_len()];
        let at_middle = Vec::with_capacity(program.outputs_len());
        // An interval is halved some fifty times.
        let open = Vec::with_capacity(64);
        let signs = vec![0; program.outputs_len()];
        let (local, signs_before) = (Vec::with_capacity(64), signs.clone());
        let left_out = vec![false; program.outputs_len()];
        RootSeparation { program, used, left_out, registers, local, open, at_middle, signs, signs_before }
    }

    /// Leaves out these outputs, and no others, from now on: their roots are not separated.
    ///
    /// # Panics
    /// If there is no output with such a number.
    pub fn leave_out(&mut self, outputs: impl IntoIterator<Item = usize>) {
        self.left_out.fill(false);
        outputs.into_iter().for_each(|output| self.left_out[output] = true);
    }

    /// The program.
    pub fn program(&self) -> &Arc<Program> {
        &self.program
    }

    /// Appends points s, in order between `first` and `last`, between which each output has at most one root along the motion. The last
    /// point is s = 1, unless many roots lie before it: then the points end where the next call begins. Returns whether the roots are
    /// separated: not those of a function that touches zero, or is zero up to rounding.
    ///
    /// # Panics
    /// If the motion or the parameters are not those of the program.
    pub fn separate(
        &mut self,
        motion: PolynomialMotion<'_>,
        (first, last): (f64, f64),
        parameters: &[f64],
        places: &mut Vec<f64>,
    ) -> bool {
        let program = Arc::clone(&self.program);
        assert_eq!(parameters.len(), program.parameters_len(), "values of the parameters");
        assert!(motion.coefficients.len().is_multiple_of(program.state_len()), "coefficients of states");
        for (register, &value) in self.registers.iter_mut().zip(program.constants()) {
            *register = Jet::constant(value);
        }
        let inputs = &mut self.registers[program.first_input() + 1 + program.state_len()..];
        for (register, &value) in inputs.iter_mut().zip(parameters) {
            *register = Jet::constant(value);
        }
        self.open.clear();
        self.open.push((first, last));
        self.signs_before.fill(0);
        // The end of the last interval that may contain a root.
        let (mut looked, mut run, mut roots) = (0, first, 0);
        let (mut vague, mut given_up) = (0, false);
        while let Some((a, b)) = self.open.pop() {
            looked += 1;
            let (clear, single) = self.look(motion, (a, b));
            let is_short = (b - a).abs() <= RESOLVED * (last - first).abs();
            given_up |= looked > MOST || vague > VAGUE;
            if !(clear || single || is_short || given_up) {
                let middle = 0.5 * (a + b);
                self.open.push((middle, b));
                self.open.push((a, middle));
                continue;
            }
            // An output may jump where one interval ends and the next one begins.
            let flips = self.signs.iter().zip(&self.signs_before).any(|(now, before)| now * before < 0);
            self.signs_before.copy_from_slice(&self.signs);
            if flips && clear {
                if a != run {
                    places.push(0.5 * (run + a));
                }
                if roots == ENOUGH {
                    break;
                }
                places.push(a);
                (run, roots) = (a, roots + 1);
            }
            if !clear {
                // The gap between two intervals that may contain roots is divided in its middle.
                if a != run {
                    places.push(0.5 * (run + a));
                }
                if roots == ENOUGH {
                    break;
                }
                if a != first {
                    places.push(a);
                }
                // Roots that are not separated may be one touch of zero that spans many intervals.
                (run, roots) = (b, roots + usize::from(single));
                vague += usize::from(!single);
            }
        }
        if self.open.is_empty() {
            if run != last {
                places.push(0.5 * (run + last));
            }
            places.push(last);
        }
        !given_up
    }

    /// Whether no output has a root in an interval, and whether no output has more than one.
    fn look(&mut self, motion: PolynomialMotion<'_>, (a, b): (f64, f64)) -> (bool, bool) {
        let (middle, radius) = (0.5 * (a + b), 0.5 * (b - a).abs());
        self.set_motion(motion, middle, 0.0);
        self.run();
        self.at_middle.clear();
        self.at_middle.extend(self.program.outputs().iter().map(|output| self.registers[output.index()]));
        self.set_motion(motion, middle, radius);
        self.run();
        let around = Interval { lo: -radius, hi: radius };
        let squares = Interval { lo: 0.0, hi: 0.5 * radius * radius };
        let (mut clear, mut single) = (true, true);
        self.signs.fill(0);
        for (k, (output, &at)) in self.program.outputs().iter().zip(&self.at_middle).enumerate() {
            if self.left_out[k] {
                continue;
            }
            let jet = self.registers[output.index()];
            let excludes = |interval: Interval| interval.lo > 0.0 || interval.hi < 0.0;
            let values =
                [jet.value, at.value + jet.rate * around, at.value + at.rate * around + jet.bend * squares];
            // A function that is identically 0 counts as free of roots.
            if let Some(values) = values.into_iter().find(|values| excludes(*values)) {
                self.signs[k] = if values.lo > 0.0 { 1 } else { -1 };
                continue;
            }
            if jet.value == Interval::ZERO {
                continue;
            }
            clear = false;
            single &= [jet.rate, at.rate + jet.bend * around].into_iter().any(excludes);
        }
        (clear, single)
    }

    /// Encloses time and state within a radius of the point s = `middle`.
    fn set_motion(&mut self, motion: PolynomialMotion<'_>, middle: f64, radius: f64) {
        let time = self.program.first_input();
        self.registers[time] = motion.time((middle, radius));
        let dim = self.used.len();
        for i in (0..dim).filter(|&i| self.used[i]) {
            self.registers[time + 1 + i] = motion.component((i, dim), (middle, radius), &mut self.local);
        }
    }

    fn run(&mut self) {
        let first = self.program.first_result();
        for (i, instruction) in self.program.code().iter().enumerate() {
            self.registers[first + i] = Jet::of(instruction, |register| self.registers[register.index()]);
        }
    }
}
