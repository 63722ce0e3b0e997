//! Tests of expressions, derivatives, programs and kernels, one module a topic.

#![expect(clippy::unwrap_used, unsafe_code, reason = "a test that cannot go on fails")]

mod common;
mod derivatives;
#[path = "common/double.rs"]
mod double;
mod factor;
mod folding;
mod forwarding;
mod held;
mod jit;
mod jit_circle;
mod lanes;
mod long_sums;
mod merging;
mod parse;
mod patterns;
mod printing;
mod programs;
#[path = "../../../../tests/src/classical/random.rs"]
mod random;
mod regularity;
mod roots;
mod rounded_constants;
mod scale;
mod signs;
mod substitution;
mod taylor;
mod variation;
