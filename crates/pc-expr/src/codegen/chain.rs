//! Long programs as a table of operations, traversed forward for their values and by the chain rule for derivatives.
//!
//! Straight-line code of a Jacobian is an order of magnitude longer than that of its function. If straight-line code
//! is too long to read or compile, the operations of the function become a table, and two short loops do the rest.

use std::fmt::Write;

use crate::codegen::layout::{Calls, Language};
use crate::codegen::{c, rust};
use crate::graph::function::Function;
use crate::program::program::{Instruction, Program, Register};

/// The number of columns of a Jacobian that are computed together.
const LANES: usize = 4;
/// The greatest width of a line in the table.
const WIDTH: usize = 110;

/// The names in the source of a table.
#[derive(Clone, Debug)]
pub struct ChainLayout {
    /// The prefix of names that are not part of the interface; in C all names share one namespace.
    pub prefix: String,
    /// The expression for the length of the state.
    pub dim: String,
    /// The expression for the number of parameters.
    pub parameters: String,
}

/// A program as a table, and its source text.
#[derive(Clone, Debug)]
pub struct Chain {
    /// The table, and the function that computes values.
    pub support: String,
    /// The functions called in the support code and in the derivatives.
    pub calls: Calls,
    places: Vec<usize>,
    values: usize,
    language: Language,
    layout: ChainLayout,
}

/// The text of the derivative of a function in terms of its argument `x` and its value `r`, if there is a
/// rule for that function.
fn derivative(function: Function, language: Language, [x, r]: [&str; 2]) -> Option<String> {
    let call = |f: Function, x: &str| match language {
        Language::C => c::call(f, x, ""), // the library has all of them
        Language::Rust => rust::call(f, x),
    };
    Some(match function {
        Function::Sin => call(Function::Cos, x),
        Function::Cos => format!("-{}", call(Function::Sin, x)),
        Function::Asin => format!("1.0 / {}", call(Function::Sqrt, &format!("1.0 - {x} * {x}"))),
        Function::Acos => format!("-1.0 / {}", call(Function::Sqrt, &format!("1.0 - {x} * {x}"))),
        Function::Atan => format!("1.0 / (1.0 + {x} * {x})"),
        Function::Sinh => call(Function::Cosh, x),
        Function::Cosh => call(Function::Sinh, x),
        Function::Tanh => format!("1.0 - {r} * {r}"),
        Function::Exp => r.to_owned(),
        Function::Log => format!("1.0 / {x}"),
        Function::Sqrt => format!("0.5 / {r}"),
        _ => return None,
    })
}

/// The function called in the derivative of a function.
fn called(function: Function) -> Option<Function> {
    match function {
        Function::Sin => Some(Function::Cos),
        Function::Cos => Some(Function::Sin),
        Function::Asin | Function::Acos => Some(Function::Sqrt),
        Function::Sinh => Some(Function::Cosh),
        Function::Cosh => Some(Function::Sinh),
        _ => None,
    }
}

impl Program {
    /// The program as a table of operations; `None` if it calls a function that has several arguments or no
    /// derivative, is fused, or has more values than can be numbered with 16 bits.
    pub fn chain(&self, language: Language, layout: ChainLayout) -> Option<Chain> {
        let mut calls = Calls::default();
        for instruction in &self.code {
            match instruction {
                Instruction::Call(function, _) => {
                    derivative(*function, language, ["x", "r"])?;
                    calls.add(*function);
                    called(*function).into_iter().for_each(|called| calls.add(called));
                }
                Instruction::Add(..)
                | Instruction::Subtract(..)
                | Instruction::Multiply(..)
                | Instruction::Divide(..)
                | Instruction::Negate(_) => {}
                _ => return None,
            }
        }
        if self.registers_len() > usize::from(u16::MAX) || self.code.is_empty() {
            return None;
        }
        let functions = calls.functions.clone();
        let mut chain = Chain {
            support: String::new(),
            calls,
            places: self.outputs.iter().map(|output| output.index()).collect(),
            values: self.registers_len(),
            language,
            layout,
        };
        chain.support = chain.support(self, &functions);
        Some(chain)
    }
}

/// The kind of an operation, and its operands.
fn entry(instruction: &Instruction, functions: &[Function]) -> (usize, Register, Register) {
    match *instruction {
        Instruction::Add(a, b) => (0, a, b),
        Instruction::Subtract(a, b) => (1, a, b),
        Instruction::Multiply(a, b) => (2, a, b),
        Instruction::Divide(a, b) => (3, a, b),
        Instruction::Negate(a) => (4, a, a),
        Instruction::Call(function, [a, ..]) => {
            (5 + functions.iter().position(|&known| known == function).unwrap_or(0), a, a)
        }
        Instruction::MultiplyAdd(a, b, _)
        | Instruction::MultiplySubtract(a, b, _)
        | Instruction::NegateMultiplyAdd(a, b, _)
        | Instruction::NegateMultiplySubtract(a, b, _) => (2, a, b), // a chain has no fused operations
    }
}

/// Entries on lines of bounded length.
fn lines(entries: impl Iterator<Item = String>) -> String {
    let (mut text, mut line) = (String::new(), String::new());
    for entry in entries {
        if line.len() + entry.len() + 1 > WIDTH {
            text += &line;
            text.push('\n');
            line.clear();
        }
        line += &entry;
        line.push(',');
    }
    text + &line + "\n"
}

impl Chain {
    fn name(&self, name: &str) -> String {
        match self.language {
            Language::C => format!("{}{name}", self.layout.prefix),
            Language::Rust => name.to_owned(),
        }
    }

    /// The expression for each kind of operation, in terms of a and b.
    fn kinds(&self, functions: &[Function]) -> Vec<String> {
        let call = |&f: &Function| match self.language {
            Language::C => c::call(f, "a", &self.layout.prefix),
            Language::Rust => rust::call(f, "a"),
        };
        let own = ["a + b", "a - b", "a * b", "a / b", "-a"].map(str::to_owned);
        own.into_iter().chain(functions.iter().map(call)).collect()
    }

    /// The derivatives of each kind with respect to a and b.
    fn slopes(&self, functions: &[Function]) -> Vec<[String; 2]> {
        let own = [
            ["1.0", "1.0"],
            ["1.0", "-1.0"],
            ["v[b]", "v[a]"],
            ["1.0 / v[b]", "-v[i] / v[b]"],
            ["-1.0", "0.0"],
        ];
        let own = own.map(|pair| pair.map(str::to_owned));
        let of = |&f: &Function| {
            let slope = derivative(f, self.language, ["v[a]", "v[i]"]).unwrap_or_default();
            [slope, "0.0".to_owned()]
        };
        own.into_iter().chain(functions.iter().map(of)).collect()
    }

    fn support(&self, program: &Program, functions: &[Function]) -> String {
        let first = program.first_result();
        let constants: Vec<String> = program.constants.iter().map(|&c| self.language.constant(c)).collect();
        let code = program.code.iter().enumerate().flat_map(|(i, instruction)| {
            let (kind, a, b) = entry(instruction, functions);
            [kind, first + i - a.index(), first + i - b.index()].map(|number| number.to_string())
        });
        let code = lines(code);
        let places = lines(self.places.iter().map(ToString::to_string));
        let kinds: Vec<String> =
            self.kinds(functions).iter().enumerate().map(|(kind, text)| format!("{kind} {text}")).collect();
        let about = format!(
            "The operations that the right-hand side, the mass matrix and the energy are computed by: the kind of each\n\
             ({}),\nand how many values before it a and b stand. The first values are constants, t, y and p.\n\
             The Jacobian takes {} kB of the stack.",
            kinds.join(", ").replace(" * ", "*").replace(" / ", "/"),
            (self.values * (1 + LANES) * size_of::<f64>()).div_ceil(1000)
        );
        let (dim, parameters) = (&self.layout.dim, &self.layout.parameters);
        let (c, values) = (program.constants.len(), self.values);
        let mut text = String::new();
        let [table, numbers, outputs, compute] =
            ["code", "constants", "places", "compute"].map(|name| self.name(name));
        // Writing to a string cannot fail.
        match self.language {
            Language::C => {
                let about = about.replace('\n', "\n   ");
                let _ = write!(
                    text,
                    "\n/* {about} */\nstatic const unsigned short {table}[] = {{\n{code}}};\n\n\
                     /* Where the right-hand side, the mass matrix and the energy are among the values. */\n\
                     static const unsigned short {outputs}[] = {{\n{places}}};\n"
                );
                if c > 0 {
                    let _ = write!(
                        text,
                        "\nstatic const double {numbers}[] = {{\n{}}};\n",
                        lines(constants.into_iter())
                    );
                }
                let _ = write!(
                    text,
                    "\n/* The first `count` values. */\n\
                     static void {compute}(double t, const double *y, const double *p, int count, double *v)\n{{\n    \
                     const unsigned short *c = {table};\n"
                );
                if c > 0 {
                    let _ = write!(text, "    for (int i = 0; i < {c}; i++)\n        v[i] = {numbers}[i];\n");
                }
                let _ = write!(
                    text,
                    "    v[{c}] = t;\n    for (int i = 0; i < {dim}; i++)\n        v[{} + i] = y[i];\n",
                    c + 1
                );
                match program.parameters_len() {
                    0 => text += "    (void)p;\n",
                    _ => {
                        let _ = write!(
                            text,
                            "    for (int i = 0; i < {parameters}; i++)\n        v[{} + i] = p[i];\n",
                            c + 1 + program.state_len()
                        );
                    }
                }
                let _ = write!(
                    text,
                    "    for (int i = {first}; i < count; i++, c += 3) {{\n        const double a = v[i - c[1]], b = v[i - c[2]];\n        \
                     switch (c[0]) {{\n"
                );
                for (kind, value) in self.kinds(functions).iter().enumerate() {
                    let _ = writeln!(text, "        case {kind}: v[i] = {value}; break;");
                }
                text += "        default: break;\n        }\n    }\n}\n";
            }
            Language::Rust => {
                let about = about.replace('\n', "\n/// ");
                let _ = write!(
                    text,
                    "\n/// {about}\n#[rustfmt::skip]\nstatic CODE: [u16; {}] = [\n{code}];\n\n\
                     /// Where the right-hand side, the mass matrix and the energy are among the values.\n\
                     #[rustfmt::skip]\nstatic PLACES: [u16; {}] = [\n{places}];\n\n\
                     static NUMBERS: [f64; {c}] = [\n{}];\n\n\
                     /// The first `count` values.\n\
                     fn compute(t: f64, y: &[f64; DIM], p: &[f64; PARAMETERS], count: usize, v: &mut [f64; {values}]) {{\n    \
                     v[..{c}].copy_from_slice(&NUMBERS);\n    v[{c}] = t;\n    v[{}..{}].copy_from_slice(y);\n    \
                     v[{}..{first}].copy_from_slice(p);\n    for (i, c) in ({first}..count).zip(CODE.chunks_exact(3)) {{\n        \
                     let (a, b) = (v[i - c[1] as usize], v[i - c[2] as usize]);\n        v[i] = match c[0] {{\n",
                    3 * program.code.len(),
                    self.places.len(),
                    lines(constants.into_iter()),
                    c + 1,
                    c + 1 + program.state_len(),
                    c + 1 + program.state_len(),
                );
                let kinds = self.kinds(functions);
                for (kind, value) in kinds.iter().enumerate() {
                    let pattern = if kind + 1 == kinds.len() { "_".to_owned() } else { kind.to_string() };
                    let _ = writeln!(text, "            {pattern} => {value},");
                }
                text += "        };\n    }\n}\n";
            }
        }
        text
    }

    /// The body of a function that writes `count` outputs, from number `from` on, to an array.
    pub fn values(&self, array: &str, from: usize, count: usize) -> String {
        let upto = self.places[from..from + count].iter().max().map_or(0, |last| last + 1);
        let (values, compute, places) = (self.values, self.name("compute"), self.name("places"));
        match self.language {
            Language::C => format!(
                "    double v[{values}];\n    {compute}(t, y, p, {upto}, v);\n    for (int i = 0; i < {count}; i++)\n        \
                 {array}[i] = v[{places}[{from} + i]];\n"
            ),
            Language::Rust => format!(
                "    let mut v = [0.0; {values}];\n    compute(t, y, p, {upto}, &mut v);\n    for i in 0..{count} {{\n        \
                 {array}[i] = v[PLACES[{from} + i] as usize];\n    }}\n"
            ),
        }
    }

    /// The body of a function that returns an output.
    pub fn value(&self, output: usize) -> String {
        let place = self.places[output];
        let (values, compute) = (self.values, self.name("compute"));
        match self.language {
            Language::C => format!(
                "    double v[{values}];\n    {compute}(t, y, p, {}, v);\n    return v[{place}];\n",
                place + 1
            ),
            Language::Rust => format!(
                "    let mut v = [0.0; {values}];\n    compute(t, y, p, {}, &mut v);\n    v[{place}]\n",
                place + 1
            ),
        }
    }

    /// The body of a function that writes the derivatives of the first outputs, as many as the state has
    /// components, with respect to the state, column by column.
    pub fn jacobian(&self, program: &Program, array: &str) -> String {
        let functions = &self.calls.functions;
        let (first, values, n) = (program.first_result(), self.values, program.state_len());
        let state = program.constants.len() + 1;
        let dim = &self.layout.dim;
        let upto = self.places[..n].iter().max().map_or(0, |last| last + 1);
        let (compute, table, places) = (self.name("compute"), self.name("code"), self.name("places"));
        let slopes = self.slopes(functions);
        let mut text = String::new();
        // Writing to a string cannot fail.
        match self.language {
            Language::C => {
                let _ = write!(
                    text,
                    "    double v[{values}], d[{values}][{LANES}];\n    {compute}(t, y, p, {upto}, v);\n    \
                     for (int j = 0; j < {dim}; j += {LANES}) {{\n        const unsigned short *c = {table};\n        \
                     for (int i = 0; i < {first}; i++)\n            for (int k = 0; k < {LANES}; k++)\n                \
                     d[i][k] = i == {state} + j + k ? 1.0 : 0.0;\n        \
                     for (int i = {first}; i < {upto}; i++, c += 3) {{\n            const int a = i - c[1], b = i - c[2];\n            \
                     double by_a = 0.0, by_b = 0.0;\n            switch (c[0]) {{\n"
                );
                for (kind, [by_a, by_b]) in slopes.iter().enumerate() {
                    let by_b = if by_b == "0.0" { String::new() } else { format!(" by_b = {by_b};") };
                    let _ = writeln!(text, "            case {kind}: by_a = {by_a};{by_b} break;");
                }
                let _ = write!(
                    text,
                    "            default: break;\n            }}\n            for (int k = 0; k < {LANES}; k++)\n                \
                     d[i][k] = by_a*d[a][k] + by_b*d[b][k];\n        }}\n        \
                     for (int k = 0; k < {LANES} && j + k < {dim}; k++)\n            for (int i = 0; i < {dim}; i++)\n                \
                     {array}[i + {dim}*(j + k)] = d[{places}[i]][k];\n    }}\n"
                );
            }
            Language::Rust => {
                let _ = write!(
                    text,
                    "    let (mut v, mut d) = ([0.0; {values}], [[0.0; {LANES}]; {values}]);\n    compute(t, y, p, {upto}, &mut v);\n    \
                     for j in (0..DIM).step_by({LANES}) {{\n        for (i, d) in d[..{first}].iter_mut().enumerate() {{\n            \
                     for k in 0..{LANES} {{\n                d[k] = if i == {state} + j + k {{ 1.0 }} else {{ 0.0 }};\n            }}\n        }}\n        \
                     for (i, c) in ({first}..{upto}).zip(CODE.chunks_exact(3)) {{\n            \
                     let (a, b) = (i - c[1] as usize, i - c[2] as usize);\n            \
                     let (by_a, by_b): (f64, f64) = match c[0] {{\n"
                );
                for (kind, [by_a, by_b]) in slopes.iter().enumerate() {
                    let pattern = if kind + 1 == slopes.len() { "_".to_owned() } else { kind.to_string() };
                    let _ = writeln!(text, "                {pattern} => ({by_a}, {by_b}),");
                }
                let _ = write!(
                    text,
                    "            }};\n            for k in 0..{LANES} {{\n                \
                     d[i][k] = by_a * d[a][k] + by_b * d[b][k];\n            }}\n        }}\n        \
                     for k in 0..{LANES}.min(DIM - j) {{\n            for i in 0..DIM {{\n                \
                     {array}[i + DIM * (j + k)] = d[PLACES[i] as usize][k];\n            }}\n        }}\n    }}\n"
                );
            }
        }
        text
    }
}
