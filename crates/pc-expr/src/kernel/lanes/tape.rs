//! Operations on eight numbers at once; each lane is an independent computation.
//!
//! The results of all operations are determined to the last bit: the four arithmetic operations,
//! square roots and fused multiply-add, each rounded once; comparisons, and operations on the bits.
//! Functions are composed of these operations in the same way for every kernel. So the result of a lane
//! depends only on its own inputs: it does not depend on the other lanes or on the instructions of the
//! processor.

use rustc_hash::FxHashMap;

use crate::graph::function::Function;

/// The number of lanes.
pub const LANES: usize = 8;

/// A number for each lane.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub struct Lanes(pub [f64; LANES]);

impl Lanes {
    /// The same number in each lane.
    pub const fn splat(value: f64) -> Lanes {
        Lanes([value; LANES])
    }
}

/// A value of a [`LaneTape`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct LaneValue(pub(super) u32);

impl LaneValue {
    pub(super) fn index(self) -> usize {
        self.0 as usize
    }
}

/// An operation of two operands a and b.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Binary {
    /// a + b
    Add,
    /// a − b
    Subtract,
    /// a · b
    Multiply,
    /// a / b
    Divide,
    /// a where a < b, else b, also where one of them is NaN
    Lesser,
    /// a where a > b, else b, also where one of them is NaN
    Greater,
    /// bitwise and
    And,
    /// bitwise or
    Or,
    /// bitwise exclusive or
    Xor,
    /// the sum of the bits as integers
    IntegerAdd,
    /// the difference of the bits as integers
    IntegerSubtract,
    /// all bits set where a < b, else none
    Less,
    /// all bits set where a ≤ b, else none
    LessOrEqual,
    /// all bits set where a or b is NaN, else none
    Unordered,
}

/// An operation of three operands a, b and c that rounds once.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Fused {
    /// a·b + c
    MultiplyAdd,
    /// a·b − c
    MultiplySubtract,
    /// c − a·b
    NegateMultiplyAdd,
    /// −a·b − c
    NegateMultiplySubtract,
}

/// The origin of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Node {
    /// Read from a row of the frame.
    Input(u32),
    /// A constant, by its bits.
    Constant(u64),
    Binary(Binary, LaneValue, LaneValue),
    Fused(Fused, LaneValue, LaneValue, LaneValue),
    SquareRoot(LaneValue),
    /// The bits of b where those of a are set, else those of c.
    Select(LaneValue, LaneValue, LaneValue),
    /// The bits a ^ (b & c).
    XorAnd(LaneValue, LaneValue, LaneValue),
    ShiftLeft(LaneValue, u8),
    ShiftRight(LaneValue, u8),
    /// A function, called lane by lane.
    Call(Function, [LaneValue; 3]),
    /// `value` where `size` ≤ `bound`, elsewhere the function of its argument.
    Near {
        function: Function,
        argument: LaneValue,
        size: LaneValue,
        bound: LaneValue,
        value: LaneValue,
    },
}

impl Node {
    /// The values read.
    #[cfg(all(feature = "jit", target_arch = "x86_64", unix))]
    pub(super) fn operands(&self) -> impl Iterator<Item = LaneValue> + use<> {
        let none = LaneValue(0);
        let (values, count) = match *self {
            Node::Input(_) | Node::Constant(_) => ([none; 4], 0),
            Node::Binary(_, a, b) => ([a, b, none, none], 2),
            Node::Fused(_, a, b, c) | Node::Select(a, b, c) | Node::XorAnd(a, b, c) => ([a, b, c, none], 3),
            Node::SquareRoot(a) | Node::ShiftLeft(a, _) | Node::ShiftRight(a, _) => {
                ([a, none, none, none], 1)
            }
            Node::Call(function, [a, b, c]) => ([a, b, c, none], function.arity()),
            Node::Near { argument, size, bound, value, .. } => ([value, size, bound, argument], 4),
        };
        values.into_iter().take(count)
    }
}

/// Straight-line operations on the rows of a frame of [`Lanes`], to be run by a
/// [`LaneKernel`](crate::LaneKernel).
///
/// Inputs are the first rows of the frame; results are written after them, or replace an input.
///
/// ```
/// use pc_expr::{Fused, LaneKernel, LaneTape, Lanes};
///
/// // One step of x ← x + h x, in each lane with its own h.
/// let mut tape = LaneTape::new();
/// let [x, h] = [tape.input(), tape.input()];
/// let next = tape.fused(Fused::MultiplyAdd, h, x, x);
/// tape.replace(x, next);
/// let kernel = LaneKernel::new(tape);
/// let mut frame = kernel.frame();
/// frame[0] = Lanes::splat(2.0);
/// frame[1] = Lanes([0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7]);
/// kernel.run(&mut frame);
/// assert_eq!(frame[0].0[5], 3.0);
/// ```
#[derive(Clone, Debug, Default)]
pub struct LaneTape {
    pub(super) nodes: Vec<Node>,
    pub(super) inputs: usize,
    /// The results in separate rows, in order.
    pub(super) outputs: Vec<LaneValue>,
    /// Rows of inputs, and the values that replace them at the end.
    pub(super) replaced: Vec<(u32, LaneValue)>,
    known: FxHashMap<Node, LaneValue>,
    pub(super) circles: FxHashMap<LaneValue, [LaneValue; 2]>,
}

impl LaneTape {
    /// A tape without operations.
    pub fn new() -> LaneTape {
        LaneTape::default()
    }

    /// The value of the next row of the frame.
    pub fn input(&mut self) -> LaneValue {
        self.inputs += 1;
        self.node(Node::Input(self.inputs as u32 - 1))
    }

    /// The values of the next rows.
    pub fn inputs(&mut self, count: usize) -> Vec<LaneValue> {
        (0..count).map(|_| self.input()).collect()
    }

    /// Number of rows that are inputs.
    pub fn inputs_len(&self) -> usize {
        self.inputs
    }

    /// The same number in all lanes.
    pub fn constant(&mut self, value: f64) -> LaneValue {
        self.node(Node::Constant(value.to_bits()))
    }

    /// The same constant in all lanes, by its bits.
    pub fn bits(&mut self, bits: u64) -> LaneValue {
        self.node(Node::Constant(bits))
    }

    /// An operation of two operands.
    pub fn binary(&mut self, operation: Binary, a: LaneValue, b: LaneValue) -> LaneValue {
        self.node(Node::Binary(operation, a, b))
    }

    /// An operation of three operands that rounds once.
    pub fn fused(&mut self, operation: Fused, a: LaneValue, b: LaneValue, c: LaneValue) -> LaneValue {
        self.node(Node::Fused(operation, a, b, c))
    }

    /// √a
    pub fn square_root(&mut self, a: LaneValue) -> LaneValue {
        self.node(Node::SquareRoot(a))
    }

    /// The bits of `a` where those of `mask` are set, else those of `b`.
    pub fn select(&mut self, mask: LaneValue, a: LaneValue, b: LaneValue) -> LaneValue {
        self.node(Node::Select(mask, a, b))
    }

    /// The bits a ^ (b & c).
    pub fn xor_and(&mut self, a: LaneValue, b: LaneValue, c: LaneValue) -> LaneValue {
        self.node(Node::XorAnd(a, b, c))
    }

    /// The bits, shifted left by fewer than 64 places.
    pub fn shift_left(&mut self, a: LaneValue, places: u8) -> LaneValue {
        self.node(Node::ShiftLeft(a, places))
    }

    /// The bits, shifted right by fewer than 64 places.
    pub fn shift_right(&mut self, a: LaneValue, places: u8) -> LaneValue {
        self.node(Node::ShiftRight(a, places))
    }

    /// A function, computed lane by lane.
    pub(super) fn call(&mut self, function: Function, arguments: [LaneValue; 3]) -> LaneValue {
        self.node(Node::Call(function, arguments))
    }

    /// `value` where `size` ≤ `bound`, elsewhere the function of its argument.
    pub(super) fn near(
        &mut self,
        (function, argument): (Function, LaneValue),
        (size, bound): (LaneValue, LaneValue),
        value: LaneValue,
    ) -> LaneValue {
        self.node(Node::Near { function, argument, size, bound, value })
    }

    /// Writes a value to a separate row; returns the number of that row among the outputs.
    pub fn output(&mut self, value: LaneValue) -> usize {
        self.outputs.push(value);
        self.outputs.len() - 1
    }

    /// Writes a value to the row of an input, after everything has been read.
    ///
    /// # Panics
    /// If `input` is not an input, or if `value` is an input.
    pub fn replace(&mut self, input: LaneValue, value: LaneValue) {
        let Node::Input(row) = self.nodes[input.index()] else { panic!("an input is replaced") };
        assert!(!matches!(self.nodes[value.index()], Node::Input(_)), "by a result");
        self.replaced.push((row, value));
    }

    /// Number of operations, including those that are not needed.
    pub fn operations(&self) -> usize {
        self.nodes.iter().filter(|node| !matches!(node, Node::Input(_) | Node::Constant(_))).count()
    }

    /// Whether each value is needed for a result.
    #[cfg(all(feature = "jit", target_arch = "x86_64", unix))]
    pub(super) fn needed(&self) -> Vec<bool> {
        let mut needed = vec![false; self.nodes.len()];
        let written = self.outputs.iter().chain(self.replaced.iter().map(|(_, value)| value));
        written.for_each(|value| needed[value.index()] = true);
        for i in (0..self.nodes.len()).rev() {
            if needed[i] {
                self.nodes[i].operands().for_each(|operand| needed[operand.index()] = true);
            }
        }
        needed
    }

    /// Interns a node: the same operation on the same operands is one value.
    fn node(&mut self, node: Node) -> LaneValue {
        let next = LaneValue(self.nodes.len() as u32);
        let value = *self.known.entry(node).or_insert(next);
        if value == next {
            self.nodes.push(node);
        }
        value
    }
}
