//! A plan as Cranelift's intermediate code.

use cranelift_codegen::Context;
use cranelift_codegen::ir::condcodes::FloatCC;
use cranelift_codegen::ir::{AbiParam, InstBuilder, Signature, Value, types};
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext};
use cranelift_module::FuncId;

use super::assembly::{Assembly, Code};
use super::error::JitError;
use super::host::Host;
use super::memory::{Area, Memory};
use super::options::JitOptions;
use super::plan::{Plan, Stay, Step};
use super::prologue::{close, open};
use super::{shim, sincos};
use crate::graph::function::Function;
use crate::program::program::{Instruction, Program, Register};

/// Compiles a program; also returns the length of its scratch memory.
pub(super) fn compile(
    host: &Host,
    program: &Program,
    plan: &Plan,
    options: &JitOptions,
) -> Result<(Code, usize), JitError> {
    let constants: Box<[f64]> = program.constants().into();
    let mut assembly = Assembly::new(host.isa());
    let leading = options.leading.min(program.outputs_len());
    let mut values = Values::new(program, plan, program.outputs_len() - leading);
    let mut context = Context::new();
    let mut frontend = FunctionBuilderContext::new();
    let mut parts = Vec::new();
    let mut start = 0;
    for &end in &plan.ends {
        context.func.signature = host.entry_signature();
        let mut b = FunctionBuilder::new(&mut context.func, &mut frontend);
        let memory = Memory::open(&mut b, &constants);
        let mut emitter = Emitter { host, program, plan, leading, values: &mut values, memory, b };
        if start == 0 {
            emitter.keep_time();
        }
        for now in start..end {
            emitter.step(now as u32);
        }
        if end == plan.steps.len() {
            emitter.copy_outputs();
            let finite = emitter.all_finite();
            emitter.finish(finite);
        } else {
            let unknown = emitter.b.ins().iconst(types::I8, 0);
            emitter.finish(unknown);
        }
        parts.push(assembly.define(&mut context)?);
        context.clear();
        start = end;
    }
    let entry = if let [whole] = parts[..] {
        whole
    } else {
        call_all(host, &mut assembly, &mut context, &mut frontend, &parts)?
    };
    Ok((assembly.finish(entry, constants)?, values.slots as usize))
}

/// A function that calls the parts one after another.
fn call_all(
    host: &Host,
    assembly: &mut Assembly,
    context: &mut Context,
    frontend: &mut FunctionBuilderContext,
    parts: &[FuncId],
) -> Result<FuncId, JitError> {
    context.func.signature = host.entry_signature();
    let mut b = FunctionBuilder::new(&mut context.func, frontend);
    let arguments = open(&mut b);
    let mut finite = Vec::new();
    for &part in parts {
        let name = assembly.name_in(part, b.func);
        let call = b.ins().call(name, &arguments);
        finite = b.inst_results(call).to_vec();
    }
    close(b, host, &finite);
    assembly.define(context)
}

/// Where a value is in memory.
#[derive(Clone, Copy)]
enum Home {
    None,
    /// A slot of the scratch memory.
    Slot(u32),
    /// An output.
    Output(u32),
}

/// The values of the program's registers while the steps are emitted.
struct Values {
    /// The values held in machine registers, as planned.
    live: Vec<Option<Value>>,
    /// The number of operands read so far.
    read: usize,
    home: Vec<Home>,
    free: Vec<u32>,
    slots: u32,
    /// Outputs that are results, as linked lists: for each register its first output, and for each
    /// output the next one of the same register.
    first_output: Vec<u32>,
    next_output: Vec<u32>,
}

const NONE: u32 = u32::MAX;

/// Number of independent sums by which outputs are found to be finite.
const SUMS: usize = 4;

impl Values {
    /// `others` numbers of scratch memory are kept for outputs.
    fn new(program: &Program, plan: &Plan, others: usize) -> Values {
        let mut first_output = vec![NONE; program.registers_len()];
        let mut next_output = vec![NONE; program.outputs_len()];
        let mut home = vec![Home::None; program.registers_len()];
        for (i, &output) in program.outputs().iter().enumerate() {
            let r = output.index();
            if r >= program.first_result() {
                next_output[i] = first_output[r];
                first_output[r] = i as u32;
                home[r] = Home::Output(i as u32);
            }
        }
        debug_assert_eq!(plan.waits.len(), home.len());
        Values {
            live: vec![None; program.registers_len()],
            read: 0,
            home,
            free: Vec::new(),
            slots: others as u32,
            first_output,
            next_output,
        }
    }

    fn slot(&mut self) -> u32 {
        self.free.pop().unwrap_or_else(|| {
            self.slots += 1;
            self.slots - 1
        })
    }
}

/// Writes one function.
struct Emitter<'a> {
    host: &'a Host,
    program: &'a Program,
    plan: &'a Plan,
    leading: usize,
    values: &'a mut Values,
    memory: Memory,
    b: FunctionBuilder<'a>,
}

impl Emitter<'_> {
    fn finish(mut self, result: Value) {
        self.b.ins().return_(&[result]);
        self.memory.close(&mut self.b);
        self.b.seal_all_blocks();
        self.b.finalize(self.host.frontend_config());
    }

    /// Time is the only input passed in a register: if it is needed later, it gets a slot.
    fn keep_time(&mut self) {
        let time = self.program.first_input();
        self.values.live[time] = Some(self.memory.t);
        if self.plan.waits[time] {
            let slot = self.values.slot();
            self.values.home[time] = Home::Slot(slot);
            self.store(self.memory.t, Area::Scratch, slot);
        }
    }

    /// Writes the outputs that are constants or inputs.
    fn copy_outputs(&mut self) {
        for (i, &output) in self.program.outputs().iter().enumerate() {
            if output.index() < self.program.first_result() {
                let value = if output.index() == self.program.first_input() {
                    self.memory.t
                } else {
                    self.load_value(output.index())
                };
                self.store_output(value, i as u32);
            }
        }
    }

    /// Whether all outputs are finite: 0·s + o is o if s is finite, and NaN if it is not.
    fn all_finite(&mut self) -> Value {
        let zero = self.number(0.0);
        // Several sums, since each waits for its last term.
        let mut sums: Vec<Value> = Vec::new();
        for i in 0..self.program.outputs_len() {
            let output = self.load_output(i as u32);
            if sums.len() < SUMS {
                sums.push(output);
            } else {
                sums[i % SUMS] = self.zero_times_plus(zero, sums[i % SUMS], output);
            }
        }
        let Some(total) = sums.into_iter().reduce(|a, b| self.zero_times_plus(zero, a, b)) else {
            return self.b.ins().iconst(types::I8, 1);
        };
        let difference = self.b.ins().fsub(total, total);
        self.b.ins().fcmp(FloatCC::Ordered, difference, difference)
    }

    fn zero_times_plus(&mut self, zero: Value, a: Value, b: Value) -> Value {
        if self.host.has_fma() {
            return self.b.ins().fma(a, zero, b);
        }
        let product = self.b.ins().fmul(a, zero);
        self.b.ins().fadd(product, b)
    }

    fn step(&mut self, now: u32) {
        match self.plan.steps[now as usize] {
            Step::One(register, instruction) => {
                let value = self.instruction(instruction);
                self.free(now);
                self.set(register, value);
            }
            Step::Circles(first, second) => {
                let circles = [Some(first), second];
                let circles = || circles.iter().flatten();
                let arguments: Vec<Value> = circles().map(|circle| self.value(circle.argument)).collect();
                let results = sincos::emit(&mut self.b, self.host, &arguments);
                self.free(now);
                for (circle, (sin, cos)) in circles().zip(results) {
                    for (register, value) in [(circle.sin, sin), (circle.cos, cos)] {
                        if let Some(register) = register {
                            self.set(register, value);
                        }
                    }
                }
            }
        }
    }

    /// The next operand, loaded unless it is in a machine register, and whether it stays there.
    fn operand(&mut self, register: Register) -> (Value, bool) {
        let r = register.index();
        let Stay { held, dies } = self.plan.stays[self.values.read];
        self.values.read += 1;
        let value = match self.values.live[r] {
            Some(value) if held => value,
            _ => self.load_value(r),
        };
        self.values.live[r] = Some(value);
        (value, !dies)
    }

    /// The value of the next operand.
    fn value(&mut self, register: Register) -> Value {
        self.operand(register).0
    }

    fn load_value(&mut self, r: usize) -> Value {
        let program = self.program;
        if r < program.first_input() {
            return self.load(Area::Constants, r as u32);
        }
        match (self.values.home[r], r.checked_sub(program.first_input() + 1)) {
            (Home::Slot(slot), _) => self.load(Area::Scratch, slot),
            (Home::Output(output), _) => self.load_output(output),
            (Home::None, Some(i)) if i < program.state_len() => self.load(Area::State, i as u32),
            (Home::None, Some(i)) => self.load(Area::Parameters, (i - program.state_len()) as u32),
            (Home::None, None) => self.memory.t,
        }
    }

    /// Records the result of a step, and stores it if it is an output or will be read from memory.
    fn set(&mut self, register: Register, value: Value) {
        let r = register.index();
        self.values.live[r] = Some(value);
        let mut output = self.values.first_output[r];
        if output == NONE && self.plan.waits[r] {
            let slot = self.values.slot();
            self.values.home[r] = Home::Slot(slot);
            self.store(value, Area::Scratch, slot);
        }
        while output != NONE {
            self.store_output(value, output);
            output = self.values.next_output[output as usize];
        }
    }

    /// Frees the slots of values read for the last time by step `now`.
    fn free(&mut self, now: u32) {
        let (plan, values) = (self.plan, &mut *self.values);
        plan.steps[now as usize].for_each_operand(|register| {
            let r = register.index();
            if plan.last_use[r] == now
                && let Home::Slot(slot) = std::mem::replace(&mut values.home[r], Home::None)
            {
                values.free.push(slot);
            }
        });
    }

    /// Where an output is: after the leading ones, at the start of the scratch memory.
    fn place_of_output(&self, output: u32) -> (Area, u32) {
        match output.checked_sub(self.leading as u32) {
            None => (Area::Outputs, output),
            Some(place) => (Area::Scratch, place),
        }
    }

    fn load_output(&mut self, output: u32) -> Value {
        let (area, index) = self.place_of_output(output);
        self.load(area, index)
    }

    fn store_output(&mut self, value: Value, output: u32) {
        let (area, index) = self.place_of_output(output);
        self.store(value, area, index);
    }

    fn load(&mut self, area: Area, index: u32) -> Value {
        self.memory.load(&mut self.b, area, index)
    }

    fn store(&mut self, value: Value, area: Area, index: u32) {
        self.memory.store(&mut self.b, value, area, index);
    }

    fn instruction(&mut self, instruction: Instruction) -> Value {
        match instruction {
            Instruction::Add(a, b) => {
                let (a, b) = (self.value(a), self.value(b));
                self.b.ins().fadd(a, b)
            }
            Instruction::Subtract(a, b) => {
                let (a, b) = (self.value(a), self.value(b));
                self.b.ins().fsub(a, b)
            }
            Instruction::Multiply(a, b) => {
                let (a, b) = (self.value(a), self.value(b));
                self.b.ins().fmul(a, b)
            }
            Instruction::Divide(a, b) => {
                let (a, b) = (self.value(a), self.value(b));
                self.b.ins().fdiv(a, b)
            }
            Instruction::Negate(a) => {
                let a = self.value(a);
                self.b.ins().fneg(a)
            }
            Instruction::MultiplyAdd(a, b, c) => self.multiply_add([a, b, c], false, false),
            Instruction::MultiplySubtract(a, b, c) => self.multiply_add([a, b, c], false, true),
            Instruction::NegateMultiplyAdd(a, b, c) => self.multiply_add([a, b, c], true, false),
            Instruction::NegateMultiplySubtract(a, b, c) => self.multiply_add([a, b, c], true, true),
            Instruction::Call(function, registers) => {
                let mut args = registers.map(|_| self.memory.t);
                for (arg, &register) in args.iter_mut().zip(&registers[..function.arity()]) {
                    *arg = self.value(register);
                }
                self.function(function, args)
            }
        }
    }

    /// ±a·b ± c, rounded once.
    fn multiply_add(&mut self, abc: [Register; 3], negate_product: bool, negate_term: bool) -> Value {
        let [(a, a_stays), (b, b_stays), (c, _)] = abc.map(|r| self.operand(r));
        // The result overwrites the first operand: a factor that is not used again saves a copy.
        let (a, b) = if a_stays && !b_stays { (b, a) } else { (a, b) };
        let a = if negate_product { self.b.ins().fneg(a) } else { a };
        let c = if negate_term { self.b.ins().fneg(c) } else { c };
        if self.host.has_fma() {
            self.b.ins().fma(a, b, c)
        } else {
            self.call(shim::multiply_add_address(), &[a, b, c])
        }
    }

    /// The value of a function, as [`Function::eval`] defines it.
    fn function(&mut self, function: Function, args: [Value; 3]) -> Value {
        let [x, y, z] = args;
        match function {
            Function::Sqrt => self.b.ins().sqrt(x),
            Function::Abs => self.b.ins().fabs(x),
            Function::Sign => {
                let (zero, one, minus_one) = (self.number(0.0), self.number(1.0), self.number(-1.0));
                let neither = self.b.ins().fmul(x, zero);
                let negative = self.b.ins().fcmp(FloatCC::LessThan, x, zero);
                let rest = self.b.ins().select(negative, minus_one, neither);
                let positive = self.b.ins().fcmp(FloatCC::GreaterThan, x, zero);
                self.b.ins().select(positive, one, rest)
            }
            Function::Min | Function::Max => {
                let better = if function == Function::Min { FloatCC::LessThan } else { FloatCC::GreaterThan };
                let second = self.b.ins().fcmp(better, y, x);
                let value = self.b.ins().select(second, y, x);
                self.unless_unordered(x, y, value)
            }
            Function::Step => {
                let zero = self.number(0.0);
                let reached = self.b.ins().fcmp(FloatCC::GreaterThanOrEqual, x, zero);
                let value = self.b.ins().select(reached, y, z);
                self.unless_unordered(x, x, value)
            }
            _ => self.call(shim::address(function), &args[..function.arity()]),
        }
    }

    /// `value`, or NaN if x or y is NaN.
    fn unless_unordered(&mut self, x: Value, y: Value, value: Value) -> Value {
        let nan = self.number(f64::NAN);
        let unordered = self.b.ins().fcmp(FloatCC::Unordered, x, y);
        self.b.ins().select(unordered, nan, value)
    }

    fn number(&mut self, value: f64) -> Value {
        self.b.ins().f64const(value)
    }

    /// Calls the function at an address; its arguments and its result are numbers.
    fn call(&mut self, address: usize, args: &[Value]) -> Value {
        let mut signature = Signature::new(self.host.convention());
        signature.params.extend(args.iter().map(|_| AbiParam::new(types::F64)));
        signature.returns.push(AbiParam::new(types::F64));
        let signature = self.b.import_signature(signature);
        let address = self.b.ins().iconst(types::I64, address as i64);
        let call = self.b.ins().call_indirect(signature, address, args);
        self.b.inst_results(call)[0]
    }
}
