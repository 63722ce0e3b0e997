//! Source text in Rust that does not need `std`.

use crate::codegen::layout::Calls;
use crate::graph::function::Function;

/// Keywords of the language, names that cannot be bound, and names that the printed code uses.
const RESERVED: &[&str] = &[
    "Err", "None", "Ok", "Self", "Some", "abstract", "as", "async", "await", "become", "box", "break",
    "const", "continue", "crate", "do", "dyn", "else", "enum", "extern", "f64", "false", "final", "fn",
    "for", "gen", "if", "impl", "in", "let", "libm", "loop", "macro", "match", "math", "max", "min", "mod",
    "move", "mut", "override", "priv", "pub", "ref", "return", "self", "sign", "static", "step", "struct",
    "super", "trait", "true", "try", "type", "typeof", "union", "unsafe", "unsized", "use", "usize",
    "virtual", "where", "while", "yield",
];

pub(crate) fn is_reserved(name: &str) -> bool {
    RESERVED.contains(&name)
}

pub(crate) fn call(function: Function, args: &str) -> String {
    let module = if library_function(function).is_some() { "math::" } else { "" };
    format!("{module}{}({args})", function.name())
}

pub(crate) fn constant(value: f64) -> String {
    if value.is_nan() {
        "f64::NAN".to_owned()
    } else if value.is_infinite() {
        if value > 0.0 { "f64::INFINITY".to_owned() } else { "f64::NEG_INFINITY".to_owned() }
    } else {
        format!("{value:?}")
    }
}

pub(crate) fn string(text: &str) -> String {
    format!("{text:?}")
}

/// A function of the module `math`: its name in that module, its expression with `std`, and its name in
/// `libm`.
struct Library {
    name: &'static str,
    arguments: &'static str,
    std: &'static str,
    libm: &'static str,
}

fn library_function(function: Function) -> Option<Library> {
    let (arguments, std, libm) = match function {
        Function::Sin => ("x: f64", "x.sin()", "sin"),
        Function::Cos => ("x: f64", "x.cos()", "cos"),
        Function::Asin => ("x: f64", "x.asin()", "asin"),
        Function::Acos => ("x: f64", "x.acos()", "acos"),
        Function::Atan => ("x: f64", "x.atan()", "atan"),
        Function::Atan2 => ("y: f64, x: f64", "y.atan2(x)", "atan2"),
        Function::Sinh => ("x: f64", "x.sinh()", "sinh"),
        Function::Cosh => ("x: f64", "x.cosh()", "cosh"),
        Function::Tanh => ("x: f64", "x.tanh()", "tanh"),
        Function::Exp => ("x: f64", "x.exp()", "exp"),
        Function::Log => ("x: f64", "x.ln()", "log"),
        Function::Sqrt => ("x: f64", "x.sqrt()", "sqrt"),
        Function::Abs => ("x: f64", "x.abs()", "fabs"),
        Function::Pow => ("x: f64, y: f64", "x.powf(y)", "pow"),
        Function::Sign | Function::Min | Function::Max | Function::Step => return None,
    };
    Some(Library { name: function.name(), arguments, std, libm })
}

/// The module `math`, and the functions that neither `std` nor `libm` has; they return the values of
/// [`Function::eval`].
pub(crate) fn helpers(calls: &Calls) -> String {
    let mut text = String::new();
    let mut library = Vec::new();
    for &function in &calls.functions {
        let (purpose, arguments, choices, otherwise) = match function {
            Function::Sign => ("−1, 0 or 1", "x: f64", [("x > 0.0", "1.0"), ("x < 0.0", "-1.0")], "x * 0.0"),
            Function::Min => (
                "The lesser; NaN if either is",
                "a: f64, b: f64",
                [("a.is_nan() || b.is_nan()", "a + b"), ("a < b", "a")],
                "b",
            ),
            Function::Max => (
                "The greater; NaN if either is",
                "a: f64, b: f64",
                [("a.is_nan() || b.is_nan()", "a + b"), ("a > b", "a")],
                "b",
            ),
            Function::Step => (
                "a where x ≥ 0, else b",
                "x: f64, a: f64, b: f64",
                [("x.is_nan()", "x"), ("x >= 0.0", "a")],
                "b",
            ),
            _ => {
                library.extend(library_function(function));
                continue;
            }
        };
        let [(first, a), (second, b)] = choices;
        text += &format!(
            "\n/// {purpose}.\n#[inline]\nfn {name}({arguments}) -> f64 {{\n    if {first} {{\n        {a}\n    }} \
             else if {second} {{\n        {b}\n    }} else {{\n        {otherwise}\n    }}\n}}\n",
            name = function.name(),
        );
    }
    if calls.multiply_add {
        library.push(Library {
            name: "mul_add",
            arguments: "a: f64, b: f64, c: f64",
            std: "a.mul_add(b, c)",
            libm: "fma",
        });
    }
    if library.is_empty() {
        return text;
    }
    text += "\n/// The elementary functions of `std`.\n#[cfg(not(feature = \"libm\"))]\nmod math {\n";
    for Library { name, arguments, std, .. } in &library {
        text += &format!("    #[inline]\n    pub fn {name}({arguments}) -> f64 {{\n        {std}\n    }}\n");
    }
    text +=
        "}\n\n/// The elementary functions of the crate `libm`.\n#[cfg(feature = \"libm\")]\nmod math {\n";
    for Library { name, libm, .. } in &library {
        let renamed = if name == libm { String::new() } else { format!(" as {name}") };
        text += &format!("    pub use libm::{libm}{renamed};\n");
    }
    text + "}\n"
}
