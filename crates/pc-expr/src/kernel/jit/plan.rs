//! The order of computation, and which values stay in memory.
//!
//! The values of straight-line code with thousands of operations do not fit into sixteen registers, and
//! register allocators spill them badly. So the order is chosen here: depth first from the outputs, with the
//! operand that needs more registers first. The values that stay in memory are also chosen here: whenever
//! there are too many for the registers, the value whose next use is furthest away goes to memory (Belady,
//! IBM Systems Journal 5 (1966) 78), which for straight-line code minimises the number of loads.

use crate::graph::function::Function;
use crate::program::program::{Instruction, Program, Register};

use super::options::JitOptions;

/// Programs of more [work](Step::work) than this are divided into several functions: the time for which registers are allocated
/// grows faster than the length of a function.
const WHOLE: usize = 50_000;
/// Instructions of the processor for the sines and cosines of one or two arguments.
const CIRCLES: usize = 60;
/// How many of the circles that follow a circle are examined when a partner is sought for it.
const PARTNERS: usize = 8;

/// The sine and the cosine of an argument, as far as they are needed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Circle {
    pub(super) argument: Register,
    pub(super) sin: Option<Register>,
    pub(super) cos: Option<Register>,
}

impl Circle {
    fn results(self) -> impl Iterator<Item = Register> {
        self.sin.into_iter().chain(self.cos)
    }
}

/// A unit of computation.
#[derive(Clone, Copy, Debug)]
pub(super) enum Step {
    /// One instruction and its register.
    One(Register, Instruction),
    /// Sines and cosines of one or two arguments.
    Circles(Circle, Option<Circle>),
}

impl Step {
    /// Calls `f` for every register read.
    pub(super) fn for_each_operand(&self, mut f: impl FnMut(Register)) {
        match self {
            Step::One(_, instruction) => instruction.operands().for_each(f),
            Step::Circles(first, second) => {
                f(first.argument);
                if let Some(second) = second {
                    f(second.argument);
                }
            }
        }
    }

    /// The number of instructions of the processor, roughly.
    fn work(&self) -> usize {
        match self {
            Step::One(..) => 1,
            Step::Circles(..) => CIRCLES,
        }
    }

    /// Calls `f` for every register written.
    pub(super) fn for_each_result(&self, mut f: impl FnMut(Register)) {
        match self {
            Step::One(register, _) => f(*register),
            Step::Circles(first, second) => {
                first.results().for_each(&mut f);
                second.iter().flat_map(|circle| circle.results()).for_each(f);
            }
        }
    }
}

/// The steps of a program, and where their values are kept.
pub(super) struct Plan {
    pub(super) steps: Vec<Step>,
    /// For each register, the last step that reads it.
    pub(super) last_use: Vec<u32>,
    /// For each register, whether it is needed again after leaving the machine registers.
    pub(super) waits: Vec<bool>,
    /// For each operand, in the order of the steps.
    pub(super) stays: Vec<Stay>,
    /// The functions into which the steps are divided: for each, the step that follows its last one.
    pub(super) ends: Vec<usize>,
}

/// Whether an operand is in a machine register before and after its use.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stay {
    /// Whether the operand is in a machine register before its use.
    pub(super) held: bool,
    /// Whether the operand is no longer kept in a machine register after its use.
    pub(super) dies: bool,
}

/// The number that stands for no further use.
const NEVER: u32 = u32::MAX;

impl Plan {
    pub(super) fn new(program: &Program, options: &JitOptions) -> Plan {
        let order = depth_first(program);
        let steps = if options.inline_trig { with_circles(program, &order) } else { plain(program, &order) };
        let ends = divided(&steps, options.chunk);
        let uses = NextUses::of(program, &steps);
        let mut plan = Plan {
            steps,
            last_use: uses.last_use.clone(),
            waits: vec![false; program.registers_len()],
            stays: Vec::with_capacity(uses.after_operand.len()),
            ends,
        };
        plan.hold(
            &uses,
            MachineRegisters::new(options.registers as usize, program.registers_len()),
            program.first_input(),
        );
        plan
    }

    fn hold(&mut self, uses: &NextUses, mut held: MachineRegisters, time: usize) {
        held.keep(time, uses.at_start[time]);
        let mut results = uses.after_result.iter();
        let mut ends = self.ends.iter().peekable();
        for (now, step) in self.steps.iter().enumerate() {
            if ends.next_if_eq(&&now).is_some() {
                held.clear();
            }
            step.for_each_operand(|r| {
                let (r, operand) = (r.index(), self.stays.len());
                let is_held = held.has(r) || held.was_read_at(now, r);
                if is_held && let Some(stay) = self.stays.get_mut(held.read_last[r]) {
                    stay.dies = false;
                }
                self.waits[r] |= !is_held;
                self.stays.push(Stay { held: is_held, dies: true });
                (held.read_at[r], held.read_last[r]) = (now, operand);
                held.keep(r, uses.after_operand[operand]);
            });
            step.for_each_result(|r| {
                if let Some(&next) = results.next() {
                    held.keep(r.index(), next);
                }
            });
        }
    }
}

/// The ends of the functions of about `chunk` instructions of the processor into which long programs are divided.
fn divided(steps: &[Step], chunk: usize) -> Vec<usize> {
    let mut ends = Vec::new();
    if steps.iter().map(Step::work).sum::<usize>() > WHOLE {
        let mut work = 0;
        for (now, step) in steps.iter().enumerate() {
            if work >= chunk.max(1) {
                ends.push(now);
                work = 0;
            }
            work += step.work();
        }
    }
    ends.push(steps.len());
    ends
}

/// The next uses of values.
struct NextUses {
    /// For each register, the first step that reads it.
    at_start: Vec<u32>,
    /// For each operand, in the order of the steps.
    after_operand: Vec<u32>,
    /// For each result, in the order of the steps.
    after_result: Vec<u32>,
    /// For each register, the last step that uses it.
    last_use: Vec<u32>,
}

impl NextUses {
    fn of(program: &Program, steps: &[Step]) -> NextUses {
        let mut next = vec![NEVER; program.registers_len()];
        let mut last_use = vec![0; program.registers_len()];
        let (mut after_operand, mut after_result) = (Vec::new(), Vec::new());
        let mut registers = Vec::new();
        for (now, step) in steps.iter().enumerate().rev() {
            let now = now as u32;
            step.for_each_result(|r| registers.push(r.index()));
            after_result.extend(registers.drain(..).rev().map(|r| next[r]));
            step.for_each_operand(|r| registers.push(r.index()));
            // Both readings of an operand read twice in a step have the same next use.
            after_operand.extend(registers.iter().rev().map(|&r| next[r]));
            for r in registers.drain(..) {
                last_use[r] = last_use[r].max(now);
                next[r] = now;
            }
        }
        after_operand.reverse();
        after_result.reverse();
        NextUses { at_start: next, after_operand, after_result, last_use }
    }
}

/// The values in machine registers.
struct MachineRegisters {
    room: usize,
    values: Vec<usize>,
    /// For each register of the program, its next use, if it is held.
    next: Vec<u32>,
    /// For each register of the program, the step and the operand that last read it.
    read_at: Vec<usize>,
    read_last: Vec<usize>,
}

impl MachineRegisters {
    fn new(room: usize, registers: usize) -> MachineRegisters {
        MachineRegisters {
            room: room.max(1),
            values: Vec::new(),
            next: vec![NEVER; registers],
            read_at: vec![usize::MAX; registers],
            read_last: vec![usize::MAX; registers],
        }
    }

    fn has(&self, value: usize) -> bool {
        self.next[value] != NEVER
    }

    fn was_read_at(&self, step: usize, value: usize) -> bool {
        self.read_at[value] == step
    }

    fn clear(&mut self) {
        for r in self.values.drain(..) {
            self.next[r] = NEVER;
        }
    }

    /// Keeps `value`, next used at step `next`, if there is room or if another held value is next used even
    /// later.
    fn keep(&mut self, value: usize, next: u32) {
        if let Some(place) = self.values.iter().position(|&r| r == value) {
            self.next[value] = next;
            if next == NEVER {
                self.values.swap_remove(place);
            }
            return;
        }
        if next == NEVER {
            return;
        }
        if self.values.len() == self.room {
            let latest = (0..self.room).max_by_key(|&i| self.next[self.values[i]]);
            let Some(place) = latest.filter(|&i| self.next[self.values[i]] > next) else { return };
            self.next[self.values.swap_remove(place)] = NEVER;
        }
        self.values.push(value);
        self.next[value] = next;
    }
}

/// The positions of the instructions that the outputs need, depth first, the operand that needs
/// more registers first.
fn depth_first(program: &Program) -> Vec<u32> {
    let first = program.first_result();
    let code = program.code();
    let position = |r: Register| r.index().checked_sub(first);
    // Number of registers for an instruction if its operands form a tree (Sethi and Ullman).
    let mut needs: Vec<u32> = Vec::with_capacity(code.len());
    let sorted = |needs: &[u32], instruction: &Instruction| {
        let mut operands = [(0, 0); 3];
        let mut count = 0;
        for r in instruction.operands() {
            if let Some(i) = position(r) {
                operands[count] = (needs[i], i as u32);
                count += 1;
            }
        }
        operands[..count].sort_unstable_by(|a, b| b.cmp(a));
        (operands, count)
    };
    for instruction in code {
        let (operands, count) = sorted(&needs, instruction);
        let operands = (0..).zip(&operands[..count]);
        needs.push(operands.map(|(held, (need, _))| need + held).max().unwrap_or(1));
    }
    let mut order = Vec::with_capacity(code.len());
    let mut opened = vec![false; code.len()];
    let mut open = Vec::new();
    for root in program.outputs().iter().filter_map(|&r| position(r)) {
        open.push((root as u32, false));
        while let Some((i, operands_done)) = open.pop() {
            if operands_done {
                order.push(i);
            } else if !opened[i as usize] {
                opened[i as usize] = true;
                open.push((i, true));
                let (operands, count) = sorted(&needs, &code[i as usize]);
                open.extend(operands[..count].iter().rev().map(|&(_, operand)| (operand, false)));
            }
        }
    }
    order
}

fn plain(program: &Program, order: &[u32]) -> Vec<Step> {
    order.iter().map(|&i| one(program, i)).collect()
}

fn one(program: &Program, i: u32) -> Step {
    let register = Register((program.first_result() + i as usize) as u32);
    Step::One(register, program.code()[i as usize])
}

/// The steps, with sines and cosines of the same argument computed together, and two such circles
/// together if both arguments are known: two lanes cost as much as one.
fn with_circles(program: &Program, order: &[u32]) -> Vec<Step> {
    let mut circles: Vec<Circle> = Vec::new();
    let mut circle_of_argument = vec![u32::MAX; program.registers_len()];
    // By instruction: its circle.
    let mut circle_of = vec![u32::MAX; program.code().len()];
    for &i in order {
        let Instruction::Call(function @ (Function::Sin | Function::Cos), [argument, ..]) =
            program.code()[i as usize]
        else {
            continue;
        };
        let circle = &mut circle_of_argument[argument.index()];
        if *circle == u32::MAX {
            *circle = circles.len() as u32;
            circles.push(Circle { argument, sin: None, cos: None });
        }
        let register = Some(Register((program.first_result() + i as usize) as u32));
        match function {
            Function::Sin => circles[*circle as usize].sin = register,
            _ => circles[*circle as usize].cos = register,
        }
        circle_of[i as usize] = *circle;
    }

    let mut known = vec![false; program.registers_len()];
    known[..program.first_result()].fill(true);
    let mut done = vec![false; circles.len()];
    let mut steps = Vec::with_capacity(order.len());
    for &i in order {
        let circle = circle_of[i as usize] as usize;
        let step = if circle >= circles.len() {
            one(program, i)
        } else if done[circle] {
            continue;
        } else {
            done[circle] = true;
            let later = circle + 1..circles.len().min(circle + 1 + PARTNERS);
            let partner = later.into_iter().find(|&j| !done[j] && known[circles[j].argument.index()]);
            if let Some(j) = partner {
                done[j] = true;
            }
            Step::Circles(circles[circle], partner.map(|j| circles[j]))
        };
        step.for_each_result(|r| known[r.index()] = true);
        steps.push(step);
    }
    steps
}
