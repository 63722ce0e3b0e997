//! Source text in C99 that is also valid C++11.

use crate::codegen::comment::is_hidden;
use crate::codegen::layout::Calls;
use crate::graph::function::Function;

/// Keywords of C and C++, and macros that `<math.h>`, `<stdio.h>` or the compiler may define.
const RESERVED: &[&str] = &[
    "alignas",
    "alignof",
    "and",
    "and_eq",
    "asm",
    "atomic",
    "auto",
    "bitand",
    "bitor",
    "bool",
    "break",
    "case",
    "catch",
    "char",
    "char16_t",
    "char32_t",
    "char8_t",
    "class",
    "co_await",
    "co_return",
    "co_yield",
    "compl",
    "concept",
    "const",
    "const_cast",
    "consteval",
    "constexpr",
    "constinit",
    "continue",
    "decltype",
    "default",
    "delete",
    "do",
    "double",
    "dynamic_cast",
    "else",
    "enum",
    "explicit",
    "export",
    "extern",
    "false",
    "float",
    "for",
    "friend",
    "goto",
    "if",
    "inline",
    "int",
    "long",
    "mutable",
    "namespace",
    "new",
    "noexcept",
    "not",
    "not_eq",
    "nullptr",
    "operator",
    "or",
    "or_eq",
    "private",
    "protected",
    "public",
    "register",
    "reinterpret_cast",
    "requires",
    "restrict",
    "return",
    "short",
    "signed",
    "sizeof",
    "static",
    "static_assert",
    "static_cast",
    "struct",
    "switch",
    "template",
    "this",
    "thread_local",
    "throw",
    "true",
    "try",
    "typedef",
    "typeid",
    "typename",
    "typeof",
    "typeof_unqual",
    "union",
    "unsigned",
    "using",
    "virtual",
    "void",
    "volatile",
    "wchar_t",
    "while",
    "xor",
    "xor_eq",
    "BUFSIZ",
    "DOMAIN",
    "EOF",
    "EXIT_FAILURE",
    "EXIT_SUCCESS",
    "FILE",
    "HUGE",
    "HUGE_VAL",
    "HUGE_VALF",
    "HUGE_VALL",
    "I",
    "INFINITY",
    "MAXFLOAT",
    "NAN",
    "NULL",
    "OVERFLOW",
    "PLOSS",
    "SING",
    "TLOSS",
    "UNDERFLOW",
    "TMP_MAX",
    "errno",
    "i386",
    "isfinite",
    "isinf",
    "isnan",
    "isnormal",
    "linux",
    "math_errhandling",
    "signbit",
    "stderr",
    "stdin",
    "stdout",
    "unix",
];

pub(crate) fn is_reserved(name: &str) -> bool {
    let prefixes = ["M_", "FP_", "MATH_", "SEEK_"];
    RESERVED.contains(&name)
        || name == "fma"
        || Function::ALL.iter().any(|&f| library_name(f) == Some(name))
        || prefixes.iter().any(|prefix| name.starts_with(prefix))
}

/// The name of the function in `<math.h>`, if it is declared there.
fn library_name(function: Function) -> Option<&'static str> {
    match function {
        Function::Abs => Some("fabs"),
        Function::Sign | Function::Min | Function::Max | Function::Step => None,
        other => Some(other.name()),
    }
}

pub(crate) fn call(function: Function, args: &str, prefix: &str) -> String {
    match library_name(function) {
        Some(name) => format!("{name}({args})"),
        None => format!("{prefix}{}({args})", function.name()),
    }
}

pub(crate) fn constant(value: f64) -> String {
    if value.is_nan() {
        "NAN".to_owned()
    } else if value.is_infinite() {
        if value > 0.0 { "HUGE_VAL".to_owned() } else { "-HUGE_VAL".to_owned() }
    } else {
        format!("{value:?}")
    }
}

pub(crate) fn string(text: &str) -> String {
    let mut literal = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => literal.extend(['\\', c]),
            // a trigraph such as ??/ is a backslash
            '?' => literal += "\\?",
            c if is_hidden(c) => literal.push(' '),
            c => literal.push(c),
        }
    }
    literal.push('"');
    literal
}

/// The functions that `<math.h>` lacks; they return the values of [`Function::eval`].
pub(crate) fn helpers(calls: &Calls, prefix: &str) -> String {
    let mut text = String::new();
    for &function in &calls.functions {
        let (purpose, arguments, value) = match function {
            Function::Sign => ("-1, 0 or 1", "double x", "x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : x*0.0"),
            Function::Min => (
                "The lesser; NaN if either is",
                "double a, double b",
                "a != a || b != b ? a + b : a < b ? a : b",
            ),
            Function::Max => (
                "The greater; NaN if either is",
                "double a, double b",
                "a != a || b != b ? a + b : a > b ? a : b",
            ),
            Function::Step => {
                ("a where x >= 0, else b", "double x, double a, double b", "x != x ? x : x >= 0.0 ? a : b")
            }
            _ => continue,
        };
        let name = function.name();
        text += &format!("/* {purpose}. */\nstatic inline double {prefix}{name}({arguments})\n{{\n");
        text += &format!("    return {value};\n}}\n\n");
    }
    text
}
