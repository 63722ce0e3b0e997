//! Inline sines and cosines, two arguments in the two lanes of a vector.
//!
//! With n the integer nearest to 2x/π, r = x − nπ/2 lies in [−π/4, π/4]; sin r and cos r are
//! polynomials in r (those of the Cephes library), and n mod 4 determines which of them, with which
//! sign, is the sine of x and which the cosine.
//!
//! For |x| ≤ [`RANGE`] the errors stay below 2 units in the last place: π/2 is the sum of
//! [`HALF_PI`]; n has 17 bits, so that x − n·HALF_PI\[0\] is exact (a multiple of 2⁻⁵³ below 1),
//! the second part is subtracted by a fused operation that rounds r once, and the third, which
//! matters only for tiny r, is added to the polynomial of the sine; the cosine does not need it.

use cranelift_codegen::Context;
use cranelift_codegen::ir::condcodes::FloatCC;
use cranelift_codegen::ir::{
    AbiParam, BlockArg, ConstantData, InstBuilder, MemFlagsData, Signature, StackSlotData, StackSlotKind,
    Type, Value, types,
};
use cranelift_codegen::isa::CallConv;
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext};

use super::assembly::{Assembly, Code};
use super::error::JitError;
use super::host::Host;
use super::prologue::{close, open};
use super::shim;
use crate::kernel::circle::{COS, HALF_PI, ROUNDING, SIN};

/// Arguments beyond this, and NaN, are left to the library.
const RANGE: f64 = 1e5;

/// Writes (sin x, cos x) of one or two arguments.
pub(super) fn emit(b: &mut FunctionBuilder<'_>, host: &Host, arguments: &[Value]) -> Vec<(Value, Value)> {
    let mut near = None;
    for &x in arguments {
        let size = b.ins().fabs(x);
        let range = b.ins().f64const(RANGE);
        let within = b.ins().fcmp(FloatCC::LessThanOrEqual, size, range); // false for NaN
        near = Some(near.map_or(within, |both| b.ins().band(both, within)));
    }
    let Some(near) = near else { return Vec::new() };
    let [in_line, library, after] = [b.create_block(), b.create_block(), b.create_block()];
    b.set_cold_block(library);
    b.ins().brif(near, in_line, [], library, []);

    b.switch_to_block(in_line);
    let mut x = b.ins().scalar_to_vector(types::F64X2, arguments[0]);
    if let Some(&second) = arguments.get(1) {
        x = b.ins().insertlane(x, second, 1);
    }
    let [sin, cos] = Lanes { b }.circle(x);
    let mut results = Vec::with_capacity(4);
    for lane in 0..arguments.len() {
        for vector in [sin, cos] {
            results.push(BlockArg::Value(b.ins().extractlane(vector, lane as u8)));
        }
    }
    b.ins().jump(after, &results);

    b.switch_to_block(library);
    let pair = b.create_sized_stack_slot(StackSlotData::new(StackSlotKind::ExplicitSlot, 16, 3));
    let signature = b.import_signature(far_signature());
    let address = b.ins().iconst(types::I64, host.far_circle() as i64);
    results.clear();
    for &x in arguments {
        let place = b.ins().stack_addr(types::I64, pair, 0);
        b.ins().call_indirect(signature, address, &[x, place]);
        for offset in [0, 8] {
            results.push(BlockArg::Value(b.ins().load(types::F64, MemFlagsData::trusted(), place, offset)));
        }
    }
    b.ins().jump(after, &results);

    b.switch_to_block(after);
    let results: Vec<Value> = results.iter().map(|_| b.append_block_param(after, types::F64)).collect();
    results.chunks_exact(2).map(|pair| (pair[0], pair[1])).collect()
}

/// The signature of the [far](compile_far) routine: it preserves all registers, so that this rare
/// call does not constrain the surrounding code.
fn far_signature() -> Signature {
    let mut signature = Signature::new(CallConv::PreserveAll);
    signature.params.extend([AbiParam::new(types::F64), AbiParam::new(types::I64)]);
    signature
}

/// Compiles the routine that writes (sin x, cos x), computed by the library, to memory.
pub(super) fn compile_far(host: &Host) -> Result<Code, JitError> {
    let mut context = Context::new();
    context.func.signature = far_signature();
    let mut frontend = FunctionBuilderContext::new();
    let mut b = FunctionBuilder::new(&mut context.func, &mut frontend);
    let arguments = open(&mut b);
    let mut signature = far_signature();
    signature.call_conv = host.convention();
    let signature = b.import_signature(signature);
    let address = b.ins().iconst(types::I64, shim::circle_address() as i64);
    b.ins().call_indirect(signature, address, &arguments);
    close(b, host, &[]);
    let mut assembly = Assembly::new(host.isa());
    let id = assembly.define(&mut context)?;
    assembly.finish(id, Box::default())
}

/// Arithmetic on vectors of two numbers.
struct Lanes<'a, 'f> {
    b: &'a mut FunctionBuilder<'f>,
}

impl Lanes<'_, '_> {
    /// The vectors (sin x, cos x) for x within the range.
    fn circle(&mut self, x: Value) -> [Value; 2] {
        let two_over_pi = self.number(std::f64::consts::FRAC_2_PI);
        let rounding = self.number(ROUNDING);
        let shifted = self.b.ins().fma(x, two_over_pi, rounding);
        let n = self.b.ins().fsub(shifted, rounding);
        let minus_n = self.b.ins().fneg(n);
        let [first, second, third] = HALF_PI.map(|part| self.number(part));
        let rest = self.b.ins().fma(minus_n, first, x);
        let r = self.b.ins().fma(minus_n, second, rest);

        let z = self.b.ins().fmul(r, r);
        let z2 = self.b.ins().fmul(z, z);
        let z4 = self.b.ins().fmul(z2, z2);
        // −sin r = (−r) − (r³p − n·π₃): with these signs that of zero is right.
        let p = self.polynomial(&SIN, z, z2, z4);
        let tail = self.b.ins().fmul(minus_n, third);
        let r3 = self.b.ins().fmul(r, z);
        let bend = self.b.ins().fma(r3, p, tail);
        let minus_r = self.b.ins().fneg(r);
        let minus_sin = self.b.ins().fsub(minus_r, bend);
        let q = self.polynomial(&COS, z, z2, z4);
        let minus_half = self.number(-0.5);
        let one = self.number(1.0);
        let top = self.b.ins().fma(z, minus_half, one);
        let cos = self.b.ins().fma(z2, q, top);

        // n mod 4 = 0, 1, 2, 3:  sin x = s, c, −s, −c;  cos x = c, −s, −c, s.
        let n = self.bits(shifted);
        let [s, c] = [self.bits(minus_sin), self.bits(cos)];
        let [zero, one, two, three] = [0, 1, 2, 3].map(|k| self.integer(k));
        let odd = self.b.ins().band(n, one);
        let odd = self.b.ins().isub(zero, odd);
        let both = self.b.ins().bxor(s, c);
        let exchange = self.b.ins().band(both, odd);
        let n3 = self.b.ins().iadd(n, three);
        [(s, n3), (c, n)].map(|(value, n)| {
            let value = self.b.ins().bxor(value, exchange);
            let second_bit = self.b.ins().band(n, two);
            let sixty_two = self.b.ins().iconst(types::I32, 62);
            let sign = self.b.ins().ishl(second_bit, sixty_two);
            let value = self.b.ins().bxor(value, sign);
            self.cast(types::F64X2, value)
        })
    }

    /// Σ cᵢ zⁱ, evaluated in pairs so that few operations depend on each other.
    fn polynomial(&mut self, c: &[f64; 6], z: Value, z2: Value, z4: Value) -> Value {
        let [c0, c1, c2, c3, c4, c5] = c.map(|c| self.number(c));
        let low = self.b.ins().fma(c1, z, c0);
        let middle = self.b.ins().fma(c3, z, c2);
        let high = self.b.ins().fma(c5, z, c4);
        let low = self.b.ins().fma(middle, z2, low);
        self.b.ins().fma(high, z4, low)
    }

    fn number(&mut self, value: f64) -> Value {
        self.constant(types::F64X2, value.to_bits())
    }

    fn integer(&mut self, value: u64) -> Value {
        self.constant(types::I64X2, value)
    }

    fn constant(&mut self, ty: Type, bits: u64) -> Value {
        let lane = bits.to_le_bytes();
        let constant = self.b.func.dfg.constants.insert(ConstantData::from([lane, lane].concat()));
        self.b.ins().vconst(ty, constant)
    }

    fn bits(&mut self, value: Value) -> Value {
        self.cast(types::I64X2, value)
    }

    fn cast(&mut self, ty: Type, value: Value) -> Value {
        self.b.ins().bitcast(ty, MemFlagsData::new(), value)
    }
}
