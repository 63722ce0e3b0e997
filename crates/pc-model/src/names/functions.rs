//! The functions that expressions may contain.

use pc_expr::{Expr, Graph};

/// The expression for a call of a function of the expression language.
pub(super) fn call<'g>(function: &str, args: &[Expr<'g>], graph: &'g Graph) -> Expr<'g> {
    match (function, args) {
        ("sin", &[x]) => x.sin(),
        ("cos", &[x]) => x.cos(),
        ("tan", &[x]) => x.tan(),
        ("cot", &[x]) => x.cot(),
        ("asin", &[x]) => x.asin(),
        ("acos", &[x]) => x.acos(),
        ("atan", &[x]) => x.atan(),
        ("sinh", &[x]) => x.sinh(),
        ("cosh", &[x]) => x.cosh(),
        ("tanh", &[x]) => x.tanh(),
        ("exp", &[x]) => x.exp(),
        ("log", &[x]) => x.log(),
        ("sqrt", &[x]) => x.sqrt(),
        ("abs", &[x]) => x.abs(),
        ("sign", &[x]) => x.sign(),
        ("atan2", &[y, x]) => y.atan2(x),
        ("min", &[x, y]) => x.min(y),
        ("max", &[x, y]) => x.max(y),
        ("step", &[x, a, b]) => x.step(a, b),
        _ => unreachable!("the parser knows the functions and their arguments: {function} of {graph:?}"),
    }
}
