//! Vector fields that are programs.

#![allow(dead_code, reason = "each test uses its part")]

use pc_expr::{Backend, Expr, Graph, Inputs, Program, ProgramField};

/// The field of these rates in (t, y), `dim` of them.
pub(crate) fn field<const N: usize>(
    rates: impl for<'g> Fn(Expr<'g>, [Expr<'g>; N]) -> [Expr<'g>; N],
) -> ProgramField {
    let graph = Graph::new();
    let t = graph.symbol("t");
    let y: [Expr<'_>; N] = std::array::from_fn(|i| graph.symbol(&format!("y{i}")));
    let inputs = Inputs { time: Some(t), state: y.to_vec(), parameters: Vec::new() };
    let program = Program::new(&graph, &inputs, &rates(t, y)).unwrap();
    ProgramField::new(program, Vec::new(), Backend::Fastest)
}

pub(crate) fn oscillator() -> ProgramField {
    field(|_, [x, v]| [v, -x])
}
