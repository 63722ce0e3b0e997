//! A plan as Cranelift's intermediate code.

use cranelift_codegen::Context;
use cranelift_codegen::ir::condcodes::FloatCC;
use cranelift_codegen::ir::{AbiParam, InstBuilder, MemFlagsData, Signature, Value, types};
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext};
use cranelift_module::FuncId;

use super::JitError;
use super::host::{Assembly, Code, Host};
use super::plan::{Plan, Step};
use super::{circle, shim};
use crate::function::Function;
use crate::program::{Instruction, Program, Register};

/// Compiles a program; answers how many numbers of scratch memory it needs, too.
pub(super) fn compile(host: &Host, program: &Program, plan: &Plan) -> Result<(Code, usize), JitError> {
    let mut assembly = Assembly::new(host);
    let mut values = Values::new(program, plan);
    let mut context = Context::new();
    let mut frontend = FunctionBuilderContext::new();
    let mut parts = Vec::new();
    let mut start = 0_usize;
    loop {
        let end = plan.steps.len().min(start.saturating_add(plan.reach.chunk));
        context.func.signature = host.entry_signature();
        let builder = FunctionBuilder::new(&mut context.func, &mut frontend);
        let mut emitter = Emitter::new(host, program, plan, &mut values, builder, start);
        if start == 0 {
            emitter.keep_time();
        }
        for now in start..end {
            emitter.step(now as u32);
        }
        if end == plan.steps.len() {
            emitter.copy_outputs();
        }
        emitter.finish();
        parts.push(assembly.define(&mut context)?);
        context.clear();
        start = end;
        if end == plan.steps.len() {
            break;
        }
    }
    let entry = if let [whole] = parts[..] {
        whole
    } else {
        call_all(host, &mut assembly, &mut context, &mut frontend, &parts)?
    };
    Ok((assembly.finish(entry)?, values.slots as usize))
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
    for &part in parts {
        let name = assembly.name_in(part, b.func);
        b.ins().call(name, &arguments);
    }
    close(b, host);
    assembly.define(context)
}

/// Opens the first block of a function; answers the function's parameters.
pub(super) fn open(b: &mut FunctionBuilder<'_>) -> Vec<Value> {
    let block = b.create_block();
    b.append_block_params_for_function_params(block);
    b.switch_to_block(block);
    b.block_params(block).to_vec()
}

/// Returns from a function and ends it.
pub(super) fn close(mut b: FunctionBuilder<'_>, host: &Host) {
    b.ins().return_(&[]);
    b.seal_all_blocks();
    b.finalize(host.frontend_config());
}

/// Where a value waits.
#[derive(Clone, Copy)]
enum Home {
    None,
    /// A number of the scratch memory.
    Slot(u32),
    /// An output.
    Output(u32),
}

/// What is known of the registers' values while the steps are written down.
struct Values {
    /// The value in a machine register, and the step that touched it last.
    live: Vec<Option<(Value, u32)>>,
    home: Vec<Home>,
    free: Vec<u32>,
    slots: u32,
    /// The outputs that are results: by register the first of them, and by output the next one of the same register.
    first_output: Vec<u32>,
    next_output: Vec<u32>,
}

const NONE: u32 = u32::MAX;

impl Values {
    fn new(program: &Program, plan: &Plan) -> Values {
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
            home,
            free: Vec::new(),
            slots: 0,
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
    values: &'a mut Values,
    b: FunctionBuilder<'a>,
    t: Value,
    state: Value,
    parameters: Value,
    outputs: Value,
    scratch: Value,
    /// First step of this function.
    start: u32,
}

impl<'a> Emitter<'a> {
    fn new(
        host: &'a Host,
        program: &'a Program,
        plan: &'a Plan,
        values: &'a mut Values,
        mut b: FunctionBuilder<'a>,
        start: usize,
    ) -> Emitter<'a> {
        let arguments = open(&mut b);
        let [t, state, parameters, outputs, scratch] = [0, 1, 2, 3, 4].map(|i| arguments[i]);
        Emitter {
            host,
            program,
            plan,
            values,
            b,
            t,
            state,
            parameters,
            outputs,
            scratch,
            start: start as u32,
        }
    }

    fn finish(self) {
        close(self.b, self.host);
    }

    /// Time is the one input that comes in a register: where it is needed later, it waits in a slot of its own.
    fn keep_time(&mut self) {
        let time = self.program.first_input();
        self.values.live[time] = Some((self.t, 0));
        if self.plan.waits[time] {
            let slot = self.values.slot();
            self.values.home[time] = Home::Slot(slot);
            self.store(self.t, self.scratch, slot);
        }
    }

    /// Outputs that are constants or inputs.
    fn copy_outputs(&mut self) {
        let now = self.plan.steps.len() as u32;
        for (i, &output) in self.program.outputs().iter().enumerate() {
            if output.index() < self.program.first_result() {
                let value = if output.index() == self.program.first_input() {
                    self.t
                } else {
                    self.value(output, now)
                };
                self.store(value, self.outputs, i as u32);
            }
        }
    }

    fn step(&mut self, now: u32) {
        match self.plan.steps[now as usize] {
            Step::One(register, instruction) => {
                let value = self.instruction(instruction, now);
                self.free(now);
                self.set(register, value, now);
            }
            Step::Circles(first, second) => {
                let circles = [Some(first), second];
                let circles = || circles.iter().flatten();
                let arguments: Vec<Value> =
                    circles().map(|circle| self.value(circle.argument, now)).collect();
                let results = circle::emit(&mut self.b, self.host, &arguments);
                self.free(now);
                for (circle, (sin, cos)) in circles().zip(results) {
                    for (register, value) in [(circle.sin, sin), (circle.cos, cos)] {
                        if let Some(register) = register {
                            self.set(register, value, now);
                        }
                    }
                }
            }
        }
    }

    /// The value of a register for use at step `now`, loaded where it is not in a machine register.
    fn value(&mut self, register: Register, now: u32) -> Value {
        let r = register.index();
        let value = match self.values.live[r] {
            Some((value, touched)) if touched >= self.start && self.plan.reach.keeps(touched, now) => value,
            _ => self.load_value(r),
        };
        self.values.live[r] = Some((value, now));
        value
    }

    fn load_value(&mut self, r: usize) -> Value {
        let program = self.program;
        if r < program.first_input() {
            return self.b.ins().f64const(program.constants()[r]);
        }
        match (self.values.home[r], r.checked_sub(program.first_input() + 1)) {
            (Home::Slot(slot), _) => self.load(self.scratch, slot),
            (Home::Output(output), _) => self.load(self.outputs, output),
            (Home::None, Some(i)) if i < program.state_len() => self.load(self.state, i as u32),
            (Home::None, Some(i)) => self.load(self.parameters, (i - program.state_len()) as u32),
            (Home::None, None) => self.t,
        }
    }

    /// Notes the result of a step, and stores it if it is an output or must wait.
    fn set(&mut self, register: Register, value: Value, now: u32) {
        let r = register.index();
        self.values.live[r] = Some((value, now));
        let mut output = self.values.first_output[r];
        if output == NONE && self.plan.waits[r] {
            let slot = self.values.slot();
            self.values.home[r] = Home::Slot(slot);
            self.store(value, self.scratch, slot);
        }
        while output != NONE {
            self.store(value, self.outputs, output);
            output = self.values.next_output[output as usize];
        }
    }

    /// Gives back the slots of values that step `now` was the last to read.
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

    fn load(&mut self, base: Value, index: u32) -> Value {
        self.b.ins().load(types::F64, MemFlagsData::trusted(), base, (index * 8) as i32)
    }

    fn store(&mut self, value: Value, base: Value, index: u32) {
        self.b.ins().store(MemFlagsData::trusted(), value, base, (index * 8) as i32);
    }

    fn instruction(&mut self, instruction: Instruction, now: u32) -> Value {
        let mut get = |r: Register| self.value(r, now);
        match instruction {
            Instruction::Add(a, b) => {
                let (a, b) = (get(a), get(b));
                self.b.ins().fadd(a, b)
            }
            Instruction::Subtract(a, b) => {
                let (a, b) = (get(a), get(b));
                self.b.ins().fsub(a, b)
            }
            Instruction::Multiply(a, b) => {
                let (a, b) = (get(a), get(b));
                self.b.ins().fmul(a, b)
            }
            Instruction::Divide(a, b) => {
                let (a, b) = (get(a), get(b));
                self.b.ins().fdiv(a, b)
            }
            Instruction::Negate(a) => {
                let a = get(a);
                self.b.ins().fneg(a)
            }
            Instruction::MultiplyAdd(a, b, c) => {
                let abc = [get(a), get(b), get(c)];
                self.multiply_add(abc, false, false)
            }
            Instruction::MultiplySubtract(a, b, c) => {
                let abc = [get(a), get(b), get(c)];
                self.multiply_add(abc, false, true)
            }
            Instruction::NegateMultiplyAdd(a, b, c) => {
                let abc = [get(a), get(b), get(c)];
                self.multiply_add(abc, true, false)
            }
            Instruction::NegateMultiplySubtract(a, b, c) => {
                let abc = [get(a), get(b), get(c)];
                self.multiply_add(abc, true, true)
            }
            Instruction::Call(function, registers) => {
                let mut args = registers.map(|_| self.t);
                for (arg, &register) in args.iter_mut().zip(&registers[..function.arity()]) {
                    *arg = self.value(register, now);
                }
                self.function(function, args)
            }
        }
    }

    /// ±a·b ± c, rounded once.
    fn multiply_add(&mut self, [a, b, c]: [Value; 3], negate_product: bool, negate_term: bool) -> Value {
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

    /// `value`, or NaN if one of x, y is.
    fn unless_unordered(&mut self, x: Value, y: Value, value: Value) -> Value {
        let nan = self.number(f64::NAN);
        let unordered = self.b.ins().fcmp(FloatCC::Unordered, x, y);
        self.b.ins().select(unordered, nan, value)
    }

    fn number(&mut self, value: f64) -> Value {
        self.b.ins().f64const(value)
    }

    /// Calls a function of numbers at an address.
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
