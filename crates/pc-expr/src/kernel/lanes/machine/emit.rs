//! From lines to instructions.

use super::super::instruction_set::InstructionSet;
use super::super::tape::{Binary, Fused, LaneTape, LaneValue, Node};
use super::assembler::{Assembler, EncodeError, Home, Last, Vector};
use super::codes::{Form, binary, commutes, fused};
use super::lines::{Line, Lines};
use super::registers::Registers;

/// A tape as bytes of instructions, with its constants and its number of rows.
pub(super) struct Emitted {
    pub(super) bytes: Vec<u8>,
    /// The constants.
    pub(super) pool: Vec<f64>,
    /// Number of rows of the frame: inputs, outputs, and spilled values.
    pub(super) rows: usize,
}

/// Emits instructions that call `routine` for functions.
pub(super) fn emit(tape: &LaneTape, set: InstructionSet, routine: u64) -> Result<Emitted, EncodeError> {
    let assembler = Assembler::new(set);
    let mut pool = Vec::new();
    let mut home = Vec::with_capacity(tape.nodes.len());
    for node in &tape.nodes {
        home.push(match *node {
            Node::Input(row) => Some(Home::Row(row)),
            Node::Constant(bits) => {
                let place = pool.len() / assembler.copies();
                pool.extend((0..assembler.copies()).map(|_| f64::from_bits(bits)));
                Some(Home::Pool(place as u32))
            }
            _ => None,
        });
    }
    let lines = Lines::of(tape);
    let mut rows_of = vec![Vec::new(); tape.nodes.len()];
    for (k, &value) in tape.outputs.iter().enumerate() {
        rows_of[lines.value(value) as usize].push((tape.inputs + k) as u32);
    }
    let first_free = (tape.inputs + tape.outputs.len()) as u32;
    let registers = Registers::new(assembler.vectors(), home, lines.uses.clone(), first_free);
    let mut emitter = Emitter { tape, lines: &lines, assembler, registers, rows_of, routine, at: 0 };
    let leave = emitter.body()?;
    let end = emitter.assembler.len();
    emitter.assembler.leave()?;
    let rows = emitter.registers.rows() as usize;
    let mut bytes = emitter.assembler.finish();
    if let Some(place) = leave {
        let distance = (end - (place + 4)) as i32;
        bytes[place..place + 4].copy_from_slice(&distance.to_le_bytes());
    }
    Ok(Emitted { bytes, pool, rows })
}

struct Emitter<'a> {
    tape: &'a LaneTape,
    lines: &'a Lines,
    assembler: Assembler,
    registers: Registers,
    /// The rows to which each value is written when it is computed.
    rows_of: Vec<Vec<u32>>,
    routine: u64,
    /// The current line.
    at: u32,
}

impl Emitter<'_> {
    /// Emits everything up to the return; returns the position of the jump's distance to it, if there
    /// is a jump.
    fn body(&mut self) -> Result<Option<usize>, EncodeError> {
        self.assembler.enter()?;
        let lines = self.lines;
        for (at, &line) in lines.lines.iter().enumerate() {
            self.at = at as u32;
            let operands = lines.operands(self.tape, line);
            self.registers.lock(&operands);
            let made = match line {
                Line::Note(a, b) => {
                    self.note(a, b)?;
                    None
                }
                Line::Node(value) => Some((value, self.node(value)?)),
            };
            self.registers.end_line(&operands, self.at);
            if let Some((value, vector)) = made {
                self.made(value, vector)?;
            }
        }
        self.at = lines.lines.len() as u32;
        let passed = lines.passed(self.tape).count();
        let mut last = lines.written_last(self.tape);
        for (row, value) in last.by_ref().take(passed) {
            self.write(row, value)?;
        }
        if self.tape.replaced.is_empty() {
            return Ok(None);
        }
        // Inputs must not change if the lanes have to be computed again.
        let noting = lines.lines.iter().any(|line| matches!(line, Line::Note(..)));
        let leave = if noting { Some(self.assembler.leave_if_noted()?) } else { None };
        for (row, value) in last {
            self.write(row, value)?;
        }
        Ok(leave)
    }

    /// Writes a value to a row, as a line of its own.
    fn write(&mut self, row: u32, value: u32) -> Result<(), EncodeError> {
        self.registers.end_line(&[], self.at);
        let vector = self.registers.in_register(value, &mut self.assembler, self.at)?;
        self.at += 1;
        self.assembler.store(row, vector)
    }

    /// Records the register of a value, and writes the value to its rows.
    fn made(&mut self, value: u32, vector: Vector) -> Result<(), EncodeError> {
        self.registers.put(value, vector);
        for &row in &self.rows_of[value as usize] {
            self.assembler.store(row, vector)?;
            self.registers.set_home(value, Home::Row(row));
        }
        self.registers.release(value, self.at);
        Ok(())
    }

    /// Computes the value of a node; returns its register.
    fn node(&mut self, value: u32) -> Result<Vector, EncodeError> {
        let get = |value: LaneValue| self.lines.value(value);
        match self.tape.nodes[value as usize] {
            Node::Binary(operation, a, b) => self.binary(operation, get(a), get(b)),
            Node::Fused(operation, a, b, c) => self.fused(operation, get(a), get(b), get(c)),
            Node::SquareRoot(a) => {
                let a = self.last(get(a))?;
                let d = self.take()?;
                self.assembler.square_root(d, a)?;
                Ok(d)
            }
            Node::Select(a, b, c) => self.select([get(a), get(b), get(c)]),
            Node::XorAnd(a, b, c) => self.xor_and([get(a), get(b), get(c)]),
            Node::ShiftLeft(a, places) => self.shift(true, get(a), places),
            Node::ShiftRight(a, places) => self.shift(false, get(a), places),
            Node::Call(function, arguments) => {
                let arguments = arguments.map(get);
                self.call(function as u32, &arguments[..function.arity()])
            }
            Node::Input(_) | Node::Constant(_) | Node::Near { .. } => unreachable!("no line of its own"),
        }
    }

    fn take(&mut self) -> Result<Vector, EncodeError> {
        self.registers.take(&mut self.assembler, self.at)
    }

    fn in_register(&mut self, value: u32) -> Result<Vector, EncodeError> {
        self.registers.in_register(value, &mut self.assembler, self.at)
    }

    fn last(&mut self, value: u32) -> Result<Last, EncodeError> {
        self.registers.last(value, &mut self.assembler, self.at)
    }

    /// The register of a value that is not read after this line, if it is in one.
    fn dying(&mut self, value: u32) -> Option<Vector> {
        let vector = self.registers.place(value)?;
        self.registers.is_last_use(value, self.at).then_some(vector)
    }

    /// The register of an operand read for the last time, else a free one.
    fn target(&mut self, of: [u32; 2]) -> Result<Vector, EncodeError> {
        match self.dying(of[0]).or_else(|| self.dying(of[1])) {
            Some(vector) => Ok(vector),
            None => self.take(),
        }
    }

    fn binary(&mut self, operation: Binary, mut a: u32, mut b: u32) -> Result<Vector, EncodeError> {
        if commutes(operation) && self.registers.place(a).is_none() && self.registers.place(b).is_some() {
            (a, b) = (b, a);
        }
        let first = self.in_register(a)?;
        let last = self.last(b)?;
        let d = self.target([a, b])?;
        match binary(self.assembler.set, operation) {
            (code, None) => self.assembler.three(code, d, first, last, None)?,
            (code, Some(predicate)) => self.assembler.compare((code, predicate), d, first, last)?,
        }
        Ok(d)
    }

    fn note(&mut self, a: u32, b: u32) -> Result<(), EncodeError> {
        let first = self.in_register(a)?;
        let last = self.last(b)?;
        let free = if self.assembler.is_wide() { 0 } else { self.take()? };
        self.assembler.note(free, first, last)
    }

    fn shift(&mut self, left: bool, a: u32, places: u8) -> Result<Vector, EncodeError> {
        let first = self.in_register(a)?;
        let d = self.target([a, a])?;
        self.assembler.shift(left, d, first, places)?;
        Ok(d)
    }

    /// A register that may be overwritten and holds one of these operands, either read for the last
    /// time or a copy; it is returned after the index of that operand.
    fn overwritten(&mut self, operands: [u32; 3], order: [usize; 3]) -> Result<(usize, Vector), EncodeError> {
        let alone = |i: usize| (0..3).all(|j| j == i || operands[j] != operands[i]);
        for i in order {
            if alone(i)
                && let Some(vector) = self.dying(operands[i])
            {
                return Ok((i, vector));
            }
        }
        let waiting = order.into_iter().find(|&i| self.registers.place(operands[i]).is_none());
        let i = waiting.unwrap_or(order[0]);
        let d = self.take()?;
        match self.registers.place(operands[i]) {
            Some(vector) => self.assembler.copy(d, vector)?,
            None => self.registers.load(d, operands[i], &mut self.assembler)?,
        }
        Ok((i, d))
    }

    /// One of two operands in a register and the other possibly in memory, and whether the two have been
    /// exchanged.
    fn pair(&mut self, a: u32, b: u32) -> Result<(Vector, Last, bool), EncodeError> {
        let swaps = self.registers.place(a).is_none() && self.registers.place(b).is_some();
        let (a, b) = if swaps { (b, a) } else { (a, b) };
        Ok((self.in_register(a)?, self.last(b)?, swaps))
    }

    fn fused(&mut self, operation: Fused, a: u32, b: u32, c: u32) -> Result<Vector, EncodeError> {
        let (overwritten, d) = self.overwritten([a, b, c], [2, 0, 1])?;
        let (form, second, last) = match overwritten {
            2 => {
                let (second, last, _) = self.pair(a, b)?;
                (Form::Sum, second, last)
            }
            other => {
                let factor = if other == 0 { b } else { a };
                let (second, last, swapped) = self.pair(factor, c)?;
                (if swapped { Form::ByThird } else { Form::BySecond }, second, last)
            }
        };
        let code = fused(self.assembler.set, operation, form);
        self.assembler.three(code, d, second, last, None)?;
        Ok(d)
    }

    fn select(&mut self, [mask, a, b]: [u32; 3]) -> Result<Vector, EncodeError> {
        if self.assembler.is_wide() {
            return self.by_table([mask, a, b], |[mask, a, b]| (mask & a) | (!mask & b));
        }
        let (mask_at, other) = (self.in_register(mask)?, self.in_register(b)?);
        let last = self.last(a)?;
        let d = self.take()?;
        self.assembler.blend(d, mask_at, last, other)?;
        Ok(d)
    }

    fn xor_and(&mut self, [a, b, c]: [u32; 3]) -> Result<Vector, EncodeError> {
        if self.assembler.is_wide() {
            return self.by_table([a, b, c], |[a, b, c]| a ^ (b & c));
        }
        let (second, third, _) = self.pair(b, c)?;
        let d = self.take()?;
        let (and, _) = binary(self.assembler.set, Binary::And);
        self.assembler.three(and, d, second, third, None)?;
        let last = self.last(a)?;
        let (xor, _) = binary(self.assembler.set, Binary::Xor);
        self.assembler.three(xor, d, d, last, None)?;
        Ok(d)
    }

    /// Applies a function of three bits to each bit of the operands, with AVX-512.
    fn by_table(
        &mut self,
        operands: [u32; 3],
        function: impl Fn([u8; 3]) -> u8,
    ) -> Result<Vector, EncodeError> {
        let (first, d) = self.overwritten(operands, [0, 1, 2])?;
        let [second, third] = [(first + 1) % 3, (first + 2) % 3];
        let (vector, last, swapped) = self.pair(operands[second], operands[third])?;
        let [second, third] = if swapped { [third, second] } else { [second, third] };
        // The bits of `place` are those of the first, the second and the third operand.
        let table = (0..8u8).fold(0, |table, place| {
            let mut bits = [0; 3];
            (bits[first], bits[second], bits[third]) = (place >> 2 & 1, place >> 1 & 1, place & 1);
            table | u32::from(function(bits) & 1) << place
        });
        let code = iced_x86::Code::EVEX_Vpternlogq_zmm_k1z_zmm_zmmm512b64_imm8;
        self.assembler.three(code, d, vector, last, Some(table))?;
        Ok(d)
    }

    /// Calls a function on rows; all values read later are spilled to memory.
    fn call(&mut self, number: u32, arguments: &[u32]) -> Result<Vector, EncodeError> {
        let rows = self.registers.rows_in_sequence(3);
        for (k, &argument) in arguments.iter().enumerate() {
            let vector = self.in_register(argument)?;
            self.assembler.store(rows + k as u32, vector)?;
        }
        self.registers.give_up_all(&mut self.assembler, self.at)?;
        self.assembler.call(self.routine, rows, number)?;
        let d = self.take()?;
        self.assembler.load(d, Home::Row(rows))?;
        Ok(d)
    }
}
