//! Encoding of instructions as bytes.

use iced_x86::{Code, Encoder, Instruction, MemoryOperand, Register};

use super::super::instruction_set::InstructionSet;
use super::super::tape::LANES;

/// Registers for the address of the frame, the address of the constants, and the mask of lanes out of range;
/// calls preserve these registers.
const FRAME: Register = Register::RBX;
const POOL: Register = Register::R12;
pub(super) const NOTED: Register = Register::R13D;

/// A vector register, given by its number.
pub(super) type Vector = u8;

/// Where a value is in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Home {
    /// A row of the frame.
    Row(u32),
    /// A constant.
    Pool(u32),
}

/// The last operand of an instruction.
#[derive(Clone, Copy, Debug)]
pub(super) enum Last {
    Register(Vector),
    Memory(Home),
}

/// An instruction that does not exist; no program produces it.
#[derive(Debug, thiserror::Error)]
#[error("an instruction could not be encoded: {0}")]
pub(crate) struct EncodeError(#[from] iced_x86::IcedError);

/// Instructions as bytes.
pub(super) struct Assembler {
    pub(super) set: InstructionSet,
    encoder: Encoder,
    len: usize,
}

impl Assembler {
    pub(super) fn new(set: InstructionSet) -> Assembler {
        Assembler { set, encoder: Encoder::new(64), len: 0 }
    }

    pub(super) fn is_wide(&self) -> bool {
        self.set == InstructionSet::Avx512
    }

    /// Number of vector registers.
    pub(super) fn vectors(&self) -> usize {
        if self.is_wide() { 32 } else { 16 }
    }

    /// Number of lanes in a vector.
    pub(super) fn width(&self) -> usize {
        if self.is_wide() { LANES } else { LANES / 2 }
    }

    /// Number of copies of each constant in the pool: AVX-512 instructions can broadcast a single one.
    pub(super) fn copies(&self) -> usize {
        if self.is_wide() { 1 } else { self.width() }
    }

    /// Biases of the addresses, so that one byte of displacement, in units of an operand, reaches
    /// most of the memory.
    fn biases(&self) -> [i64; 2] {
        if self.is_wide() { [128 * 64, 128 * 8] } else { [128, 128] }
    }

    /// The number of bytes so far.
    pub(super) fn len(&self) -> usize {
        self.len
    }

    pub(super) fn finish(mut self) -> Vec<u8> {
        self.encoder.take_buffer()
    }

    fn put(&mut self, instruction: &Instruction) -> Result<(), EncodeError> {
        self.len += self.encoder.encode(instruction, 0)?;
        Ok(())
    }

    fn raw(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|&byte| self.encoder.write_u8(byte));
        self.len += bytes.len();
    }

    fn vector(&self, vector: Vector) -> Register {
        let first = if self.is_wide() { Register::ZMM0 } else { Register::YMM0 };
        first + u32::from(vector)
    }

    fn memory(&self, home: Home) -> MemoryOperand {
        let [frame, pool] = self.biases();
        match home {
            Home::Row(row) => MemoryOperand::with_base_displ(FRAME, i64::from(row) * 64 - frame),
            Home::Pool(place) => {
                let offset = i64::from(place) * 8 * self.copies() as i64 - pool;
                MemoryOperand::with_base_displ_bcst_seg(POOL, offset, self.is_wide(), Register::None)
            }
        }
    }

    /// d ← code(a, b)
    pub(super) fn three(
        &mut self,
        code: Code,
        d: Vector,
        a: Vector,
        last: Last,
        number: Option<u32>,
    ) -> Result<(), EncodeError> {
        let (d, a) = (self.vector(d), self.vector(a));
        let instruction = match (last, number) {
            (Last::Register(b), None) => Instruction::with3(code, d, a, self.vector(b))?,
            (Last::Memory(home), None) => Instruction::with3(code, d, a, self.memory(home))?,
            (Last::Register(b), Some(number)) => Instruction::with4(code, d, a, self.vector(b), number)?,
            (Last::Memory(home), Some(number)) => Instruction::with4(code, d, a, self.memory(home), number)?,
        };
        self.put(&instruction)
    }

    /// The mask d ← a compared with the last operand.
    pub(super) fn compare(
        &mut self,
        (code, predicate): (Code, u32),
        d: Vector,
        a: Vector,
        last: Last,
    ) -> Result<(), EncodeError> {
        if !self.is_wide() {
            return self.three(code, d, a, last, Some(predicate));
        }
        self.compare_to_mask((code, predicate), a, last)?;
        let spread = Instruction::with2(Code::EVEX_Vpmovm2q_zmm_kr, self.vector(d), Register::K1)?;
        self.put(&spread)
    }

    fn compare_to_mask(
        &mut self,
        (code, predicate): (Code, u32),
        a: Vector,
        last: Last,
    ) -> Result<(), EncodeError> {
        let a = self.vector(a);
        let instruction = match last {
            Last::Register(b) => Instruction::with4(code, Register::K1, a, self.vector(b), predicate)?,
            Last::Memory(home) => Instruction::with4(code, Register::K1, a, self.memory(home), predicate)?,
        };
        self.put(&instruction)
    }

    /// Records the lanes in which a ≤ b does not hold; `free` is a vector that may be overwritten.
    pub(super) fn note(&mut self, free: Vector, a: Vector, last: Last) -> Result<(), EncodeError> {
        const NOT_LESS_OR_EQUAL: u32 = 0x16; // NLE_UQ
        let read = if self.is_wide() {
            let code = Code::EVEX_Vcmppd_kr_k1_zmm_zmmm512b64_imm8_sae;
            self.compare_to_mask((code, NOT_LESS_OR_EQUAL), a, last)?;
            Instruction::with2(Code::VEX_Kmovb_r32_kr, Register::EAX, Register::K1)?
        } else {
            let code = Code::VEX_Vcmppd_ymm_ymm_ymmm256_imm8;
            self.three(code, free, a, last, Some(NOT_LESS_OR_EQUAL))?;
            Instruction::with2(Code::VEX_Vmovmskpd_r32_ymm, Register::EAX, self.vector(free))?
        };
        self.put(&read)?;
        let note = Instruction::with2(Code::Or_r32_rm32, NOTED, Register::EAX)?;
        self.put(&note)
    }

    /// d ← the bits of `a` where those of the mask are set, else of `b`, for AVX2.
    pub(super) fn blend(&mut self, d: Vector, mask: Vector, a: Last, b: Vector) -> Result<(), EncodeError> {
        let code = Code::VEX_Vblendvpd_ymm_ymm_ymmm256_ymm;
        let (d, b, mask) = (self.vector(d), self.vector(b), self.vector(mask));
        let instruction = match a {
            Last::Register(a) => Instruction::with4(code, d, b, self.vector(a), mask)?,
            Last::Memory(home) => Instruction::with4(code, d, b, self.memory(home), mask)?,
        };
        self.put(&instruction)
    }

    pub(super) fn square_root(&mut self, d: Vector, a: Last) -> Result<(), EncodeError> {
        let code = if self.is_wide() {
            Code::EVEX_Vsqrtpd_zmm_k1z_zmmm512b64_er
        } else {
            Code::VEX_Vsqrtpd_ymm_ymmm256
        };
        let d = self.vector(d);
        let instruction = match a {
            Last::Register(a) => Instruction::with2(code, d, self.vector(a))?,
            Last::Memory(home) => Instruction::with2(code, d, self.memory(home))?,
        };
        self.put(&instruction)
    }

    pub(super) fn shift(&mut self, left: bool, d: Vector, a: Vector, places: u8) -> Result<(), EncodeError> {
        let code = match (self.is_wide(), left) {
            (true, true) => Code::EVEX_Vpsllq_zmm_k1z_zmmm512b64_imm8,
            (true, false) => Code::EVEX_Vpsrlq_zmm_k1z_zmmm512b64_imm8,
            (false, true) => Code::VEX_Vpsllq_ymm_ymm_imm8,
            (false, false) => Code::VEX_Vpsrlq_ymm_ymm_imm8,
        };
        let instruction = Instruction::with3(code, self.vector(d), self.vector(a), u32::from(places))?;
        self.put(&instruction)
    }

    pub(super) fn copy(&mut self, d: Vector, a: Vector) -> Result<(), EncodeError> {
        let code = self.load_code();
        let instruction = Instruction::with2(code, self.vector(d), self.vector(a))?;
        self.put(&instruction)
    }

    pub(super) fn load(&mut self, d: Vector, home: Home) -> Result<(), EncodeError> {
        let (code, memory) = match home {
            Home::Pool(place) if self.is_wide() => {
                let offset = i64::from(place) * 8 - self.biases()[1];
                let memory = MemoryOperand::with_base_displ(POOL, offset);
                (Code::EVEX_Vbroadcastsd_zmm_k1z_xmmm64, memory)
            }
            home => (self.load_code(), self.memory(home)),
        };
        let instruction = Instruction::with2(code, self.vector(d), memory)?;
        self.put(&instruction)
    }

    pub(super) fn store(&mut self, row: u32, a: Vector) -> Result<(), EncodeError> {
        let code =
            if self.is_wide() { Code::EVEX_Vmovapd_zmmm512_k1z_zmm } else { Code::VEX_Vmovapd_ymmm256_ymm };
        let instruction = Instruction::with2(code, self.memory(Home::Row(row)), self.vector(a))?;
        self.put(&instruction)
    }

    fn load_code(&self) -> Code {
        if self.is_wide() { Code::EVEX_Vmovapd_zmm_k1z_zmmm512 } else { Code::VEX_Vmovapd_ymm_ymmm256 }
    }

    /// Enters a function of (frame, pool) under the calling convention of System V.
    pub(super) fn enter(&mut self) -> Result<(), EncodeError> {
        // Three registers leave the stack aligned for calls.
        for register in [FRAME, POOL, Register::R13] {
            self.put(&Instruction::with1(Code::Push_r64, register)?)?;
        }
        let [frame, pool] = self.biases();
        for (to, from, bias) in [(FRAME, Register::RDI, frame), (POOL, Register::RSI, pool)] {
            let memory = MemoryOperand::with_base_displ(from, bias);
            self.put(&Instruction::with2(Code::Lea_r64_m, to, memory)?)?;
        }
        self.put(&Instruction::with2(Code::Xor_r32_rm32, NOTED, NOTED)?)
    }

    /// Calls `routine` with the address of a row, a number and the number of lanes.
    pub(super) fn call(&mut self, routine: u64, row: u32, number: u32) -> Result<(), EncodeError> {
        let place = MemoryOperand::with_base_displ(FRAME, i64::from(row) * 64 - self.biases()[0]);
        self.put(&Instruction::with2(Code::Lea_r64_m, Register::RDI, place)?)?;
        self.put(&Instruction::with2(Code::Mov_r32_imm32, Register::ESI, number)?)?;
        self.put(&Instruction::with2(Code::Mov_r32_imm32, Register::EDX, self.width() as u32)?)?;
        self.put(&Instruction::with2(Code::Mov_r64_imm64, Register::RAX, routine)?)?;
        // Avoids the transition penalty of non-VEX code.
        self.put(&Instruction::with(Code::VEX_Vzeroupper))?;
        self.put(&Instruction::with1(Code::Call_rm64, Register::RAX)?)
    }

    /// Jumps to the end if a lane was recorded; returns the position of the jump's distance, to be
    /// filled in.
    pub(super) fn leave_if_noted(&mut self) -> Result<usize, EncodeError> {
        self.put(&Instruction::with2(Code::Test_rm32_r32, NOTED, NOTED)?)?;
        self.raw(&[0x0f, 0x85, 0, 0, 0, 0]); // jne
        Ok(self.len - 4)
    }

    /// Returns the recorded lanes.
    pub(super) fn leave(&mut self) -> Result<(), EncodeError> {
        self.put(&Instruction::with2(Code::Mov_r32_rm32, Register::EAX, NOTED)?)?;
        self.put(&Instruction::with(Code::VEX_Vzeroupper))?;
        for register in [Register::R13, POOL, FRAME] {
            self.put(&Instruction::with1(Code::Pop_r64, register)?)?;
        }
        self.put(&Instruction::with(Code::Retnq))
    }
}
