//! Tapes without machine code.

use super::tape::{Binary, Fused, LANES, LaneTape, Lanes, Node};

/// Number of lanes computed at a time.
pub(super) const CHUNK: usize = 4;

type Chunk = [f64; CHUNK];

impl LaneTape {
    /// Number of rows for intermediate values of [`walk`](LaneTape::walk).
    pub(super) fn rows(&self) -> usize {
        self.nodes.len()
    }

    /// Computes the lanes from `first` on, [`CHUNK`] of them, in a frame; `room` holds intermediate
    /// values.
    pub(super) fn walk(&self, frame: &mut [Lanes], room: &mut [Lanes], first: usize) {
        debug_assert!(first.is_multiple_of(CHUNK) && first + CHUNK <= LANES);
        let read = |rows: &[Lanes], row: usize| -> Chunk { std::array::from_fn(|i| rows[row].0[first + i]) };
        for (i, node) in self.nodes.iter().enumerate() {
            let get = |value: super::tape::LaneValue| read(room, value.index());
            let value = match *node {
                Node::Input(row) => read(frame, row as usize),
                Node::Constant(bits) => [f64::from_bits(bits); CHUNK],
                Node::Binary(operation, a, b) => binary(operation, get(a), get(b)),
                Node::Fused(operation, a, b, c) => fused(operation, get(a), get(b), get(c)),
                Node::SquareRoot(a) => get(a).map(f64::sqrt),
                Node::Select(mask, a, b) => {
                    let (mask, a, b) = (bits(get(mask)), bits(get(a)), bits(get(b)));
                    each(|i| (mask[i] & a[i]) | (!mask[i] & b[i]))
                }
                Node::XorAnd(a, b, c) => {
                    let (a, b, c) = (bits(get(a)), bits(get(b)), bits(get(c)));
                    each(|i| a[i] ^ (b[i] & c[i]))
                }
                Node::ShiftLeft(a, places) => {
                    let a = bits(get(a));
                    each(|i| a[i] << places)
                }
                Node::ShiftRight(a, places) => {
                    let a = bits(get(a));
                    each(|i| a[i] >> places)
                }
                Node::Call(function, arguments) => {
                    let arguments = arguments.map(get);
                    std::array::from_fn(|i| function.eval(&arguments.map(|argument| argument[i])))
                }
                Node::Near { function, argument, size, bound, value } => {
                    let (argument, size, bound, value) = (get(argument), get(size), get(bound), get(value));
                    std::array::from_fn(|i| {
                        if size[i] <= bound[i] { value[i] } else { function.eval(&[argument[i]]) }
                    })
                }
            };
            room[i].0[first..first + CHUNK].copy_from_slice(&value);
        }
        for (k, value) in self.outputs.iter().enumerate() {
            let value = read(room, value.index());
            frame[self.inputs + k].0[first..first + CHUNK].copy_from_slice(&value);
        }
        for &(row, value) in &self.replaced {
            let value = read(room, value.index());
            frame[row as usize].0[first..first + CHUNK].copy_from_slice(&value);
        }
    }
}

fn bits(value: Chunk) -> [u64; CHUNK] {
    value.map(f64::to_bits)
}

fn each(f: impl Fn(usize) -> u64) -> Chunk {
    std::array::from_fn(|i| f64::from_bits(f(i)))
}

fn binary(operation: Binary, a: Chunk, b: Chunk) -> Chunk {
    let number = |f: fn(f64, f64) -> f64| -> Chunk { std::array::from_fn(|i| f(a[i], b[i])) };
    let whole = |f: fn(u64, u64) -> u64| each(|i| f(a[i].to_bits(), b[i].to_bits()));
    let mask = |f: fn(f64, f64) -> bool| each(|i| if f(a[i], b[i]) { u64::MAX } else { 0 });
    match operation {
        Binary::Add => number(|a, b| a + b),
        Binary::Subtract => number(|a, b| a - b),
        Binary::Multiply => number(|a, b| a * b),
        Binary::Divide => number(|a, b| a / b),
        Binary::Lesser => number(|a, b| if a < b { a } else { b }),
        Binary::Greater => number(|a, b| if a > b { a } else { b }),
        Binary::And => whole(|a, b| a & b),
        Binary::Or => whole(|a, b| a | b),
        Binary::Xor => whole(|a, b| a ^ b),
        Binary::IntegerAdd => whole(u64::wrapping_add),
        Binary::IntegerSubtract => whole(u64::wrapping_sub),
        Binary::Less => mask(|a, b| a < b),
        Binary::LessOrEqual => mask(|a, b| a <= b),
        Binary::Unordered => mask(|a, b| a.is_nan() || b.is_nan()),
    }
}

fn fused(operation: Fused, a: Chunk, b: Chunk, c: Chunk) -> Chunk {
    let (of_product, of_sum) = match operation {
        Fused::MultiplyAdd => (1.0, 1.0),
        Fused::MultiplySubtract => (1.0, -1.0),
        Fused::NegateMultiplyAdd => (-1.0, 1.0),
        Fused::NegateMultiplySubtract => (-1.0, -1.0),
    };
    std::array::from_fn(|i| (of_product * a[i]).mul_add(b[i], of_sum * c[i]))
}
