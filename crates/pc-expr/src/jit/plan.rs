//! What is computed when, and which values wait in memory.
//!
//! Straight-line code of thousands of operations does not fit sixteen registers, and register allocators spill it
//! badly. So the order is chosen here: depth first from the outputs, the operand that needs more registers first. And
//! a value that is idle for long is stored once and loaded again at its next use, instead of holding a register.

use crate::function::Function;
use crate::program::{Instruction, Program, Register};

use super::JitOptions;

/// Programs of more instructions than this are cut into several functions.
const WHOLE: usize = 50_000;
/// How many circles further on the partner of one is looked for.
const PARTNERS: usize = 8;

/// The sine and the cosine of one argument, as far as they are wanted.
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

/// What is computed at once.
#[derive(Clone, Copy, Debug)]
pub(super) enum Step {
    /// One instruction and its register.
    One(Register, Instruction),
    /// Sines and cosines of one or two arguments.
    Circles(Circle, Option<Circle>),
}

impl Step {
    /// Calls `f` with every register read.
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

    /// Calls `f` with every register written.
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

/// The steps of a program and where their values live.
pub(super) struct Plan {
    pub(super) steps: Vec<Step>,
    /// By register: the last step that reads it.
    pub(super) last_use: Vec<u32>,
    /// By register: whether it is needed again after a time idle.
    pub(super) waits: Vec<bool>,
    pub(super) reach: Reach,
}

/// How long a value stays in a register.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    /// Steps without use.
    distance: u32,
    /// Steps in a function.
    pub(super) chunk: usize,
}

impl Reach {
    /// Whether a value used or made at step `before` is still in a register at step `now`.
    pub(super) fn keeps(self, before: u32, now: u32) -> bool {
        now - before <= self.distance && before as usize / self.chunk == now as usize / self.chunk
    }
}

impl Plan {
    pub(super) fn new(program: &Program, options: &JitOptions) -> Plan {
        let order = depth_first(program);
        let steps = if options.inline_trig { with_circles(program, &order) } else { plain(program, &order) };
        let chunk = if steps.len() > WHOLE { options.chunk.max(1) } else { usize::MAX };
        let mut plan = Plan {
            steps,
            last_use: vec![0; program.registers_len()],
            waits: vec![false; program.registers_len()],
            reach: Reach { distance: options.spill_distance, chunk },
        };
        plan.find_idle();
        plan
    }

    fn find_idle(&mut self) {
        // Before the first step there are constants and inputs: at step 0, as good as anywhere.
        let mut touched = vec![0; self.waits.len()];
        for (now, step) in (0..).zip(&self.steps) {
            step.for_each_operand(|r| {
                let r = r.index();
                self.waits[r] |= !self.reach.keeps(touched[r], now);
                touched[r] = now;
                self.last_use[r] = now;
            });
            step.for_each_result(|r| touched[r.index()] = now);
        }
    }
}

/// The positions of the instructions that the outputs need, depth first, the more demanding operand first.
fn depth_first(program: &Program) -> Vec<u32> {
    let first = program.first_result();
    let code = program.code();
    let position = |r: Register| r.index().checked_sub(first);
    // How many registers an instruction takes if everything below it is a tree (Sethi and Ullman).
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

/// The steps with sines and cosines of the same argument together, and two such circles together where both arguments
/// are known: two lanes cost as much as one.
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
