//! From a tape to statements.

use rustc_hash::FxHashSet;

use super::{c, rust};
use crate::codegen::layout::{Calls, FunctionBody, Language, Layout, Place};
use crate::graph::function::Function;
use crate::program::program::{Instruction, Program, Register};

/// Text longer than this gets a name instead of being written inside another expression.
const LONG: usize = 80;
/// A sum written over several lines may become this long before its first part gets a name.
const LONG_SUM: usize = 320;
/// In C programs with more operations than this, `const` is left out of the declarations, which are a tenth
/// of the text.
const MANY: usize = 2000;
/// Comments longer than this are cut.
const LONGEST_COMMENT: usize = 60;
/// The deepest nesting of brackets.
const DEEP: u32 = 3;
/// Lines longer than this are broken.
const WIDTH: usize = 110;
/// Comments on neighbouring lines are aligned up to this column.
const ALIGNED: usize = 64;

/// How tightly a piece of text binds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Binding {
    Sum,
    Product,
    Atom,
}

/// The text of a value.
#[derive(Clone, Debug)]
struct Piece {
    /// The terms of a sum, each except the first with its sign and a space before it; otherwise one term.
    terms: Vec<String>,
    binding: Binding,
    /// How deeply brackets are nested.
    depth: u32,
}

impl Piece {
    fn new(text: String, binding: Binding, depth: u32) -> Piece {
        Piece { terms: vec![text], binding, depth }
    }

    fn atom(text: impl Into<String>) -> Piece {
        Piece::new(text.into(), Binding::Atom, 0)
    }

    fn text(&self) -> String {
        self.terms.join(" ")
    }

    fn len(&self) -> usize {
        self.terms.iter().map(|term| term.len() + 1).sum()
    }

    fn is_negative(&self) -> bool {
        self.terms[0].starts_with('-')
    }

    /// The text for use to the right of an operator, where it cannot begin with a sign, and the depth
    /// of its brackets.
    fn right(&self, least: Binding) -> (String, u32) {
        if self.binding >= least && !self.is_negative() {
            (self.text(), self.depth)
        } else {
            self.bracketed()
        }
    }

    /// The text for use at the beginning of an expression, and the depth of its brackets.
    fn left(&self, least: Binding) -> (String, u32) {
        if self.binding >= least { (self.text(), self.depth) } else { self.bracketed() }
    }

    fn bracketed(&self) -> (String, u32) {
        (format!("({})", self.text()), self.depth + 1)
    }

    /// This sum with one term added.
    fn and(mut self, sign: char, term: &Piece) -> Piece {
        // A term added or subtracted as a whole keeps its brackets.
        let (text, depth) = term.right(Binding::Product);
        if self.binding != Binding::Sum {
            self = Piece::new(self.text(), Binding::Sum, self.depth);
        }
        self.terms.push(format!("{sign} {text}"));
        self.depth = self.depth.max(depth);
        self
    }
}

pub(crate) struct Printer<'a> {
    program: &'a Program,
    language: Language,
    layout: &'a Layout,
    uses: Vec<u32>,
    /// The text of each register: its name, or the expression that is written in place.
    pieces: Vec<Piece>,
    /// Names that are already in use.
    names: FxHashSet<String>,
    locals: usize,
    /// A name for the value of each register, from the slot of an output.
    hints: Vec<Option<&'a str>>,
    statements: Lines,
    calls: Calls,
}

/// Lines of code, each with the comment at its end.
#[derive(Default)]
struct Lines(Vec<(String, String)>);

impl Lines {
    fn push(&mut self, code: impl Into<String>, comment: String) {
        self.0.push((code.into(), comment));
    }

    /// The text, with comments on neighbouring lines aligned.
    fn text(&self, language: Language) -> String {
        let mut text = String::new();
        let run = |(code, comment): &(String, String)| !comment.is_empty() && code.len() <= ALIGNED;
        for lines in self.0.chunk_by(|a, b| run(a) && run(b)) {
            let width = lines.iter().map(|(code, _)| code.len()).max().unwrap_or(0);
            for (code, comment) in lines {
                // A format width is at most 65 535, a line of code may be longer.
                let gap = " ".repeat(width - code.len());
                text += &match language {
                    _ if comment.is_empty() => format!("    {code}\n"),
                    Language::C => format!("    {code}{gap} /* {comment} */\n"),
                    Language::Rust => format!("    {code}{gap} // {comment}\n"),
                };
            }
        }
        text
    }
}

impl<'a> Printer<'a> {
    pub(crate) fn new(program: &'a Program, language: Language, layout: &'a Layout) -> Printer<'a> {
        let constants = program.constants().iter().map(|&c| {
            let text = language.constant(c);
            let binding = if text.starts_with('-') { Binding::Product } else { Binding::Atom };
            Piece::new(text, binding, 0)
        });
        let inputs = std::iter::once("t").chain(layout.inputs.iter().map(String::as_str)).map(Piece::atom);
        let pieces = constants.chain(inputs).collect();
        let mut hints = vec![None; program.registers_len()];
        for (slot, output) in layout.slots.iter().zip(program.outputs()).rev() {
            hints[output.index()] = Some(slot.local.as_str()).filter(|name| !name.is_empty());
        }
        let mut names: FxHashSet<String> = ["t", "y", "p"].map(str::to_owned).into_iter().collect();
        names.extend(layout.inputs.iter().chain(&layout.reserved).cloned());
        let uses = program.uses();
        let (statements, calls) = (Lines::default(), Calls::default());
        Printer { program, language, layout, uses, pieces, names, locals: 0, hints, statements, calls }
    }

    pub(crate) fn print(mut self) -> FunctionBody {
        let first = self.program.first_result();
        let mut done = 0;
        self.write_outputs(&mut done, first);
        for (i, &instruction) in self.program.code().iter().enumerate() {
            let register = first + i;
            let piece = self.piece(instruction);
            let piece =
                if self.uses[register] > 1 { self.named(register, instruction, &piece) } else { piece };
            self.pieces.push(piece);
            self.write_outputs(&mut done, register + 1);
        }
        let inputs = self.inputs().text(self.language);
        FunctionBody { inputs, statements: self.statements.text(self.language), calls: self.calls }
    }

    /// Writes the outputs whose registers are below `known`, in their order.
    fn write_outputs(&mut self, done: &mut usize, known: usize) {
        while let Some(output) = self.program.outputs().get(*done).filter(|output| output.index() < known) {
            let slot = &self.layout.slots[*done];
            *done += 1;
            if self.layout.skip_zeros && self.constant(*output) == Some(0) {
                continue;
            }
            let piece = self.pieces[output.index()].clone();
            match &slot.place {
                Place::Entry(entry) => self.statement(&format!("{entry} = "), &piece, &slot.comment),
                Place::Returned if self.language == Language::Rust => {
                    self.write("", &piece, "", &slot.comment);
                }
                Place::Returned => self.statement("return ", &piece, &slot.comment),
            }
        }
    }

    /// The bits of a constant.
    fn constant(&self, register: Register) -> Option<u64> {
        self.program.constants().get(register.index()).map(|c| c.to_bits())
    }

    fn statement(&mut self, head: &str, piece: &Piece, comment: &str) {
        self.write(head, piece, ";", comment);
    }

    fn write(&mut self, head: &str, piece: &Piece, tail: &str, comment: &str) {
        let mut line = head.to_owned();
        for (i, term) in piece.terms.iter().enumerate() {
            if i > 0 && line.len() + term.len() + 5 >= WIDTH {
                self.statements.push(line, String::new());
                line = "    ".to_owned();
            } else if i > 0 {
                line.push(' ');
            }
            line += term;
        }
        self.statements.push(line + tail, shortened(self.language.comment(comment)));
    }

    fn piece(&mut self, instruction: Instruction) -> Piece {
        use Instruction::*;
        match instruction {
            Add(a, b) => self.sum(a, b),
            Subtract(a, b) => {
                let (a, b) = (self.first_term(a), self.operand(b));
                a.and('-', &b)
            }
            Multiply(a, b) => {
                let (a, b) = (self.operand(a), self.operand(b));
                // a·b is b·a to the last bit: a factor that is a product comes first and needs no brackets.
                let is_product = |piece: &Piece| piece.binding == Binding::Product && !piece.is_negative();
                let is_number =
                    |piece: &Piece| piece.terms[0].starts_with(|c: char| c.is_ascii_digit() || c == '-');
                if is_product(&b) && !is_product(&a) && !is_number(&a) {
                    product('*', &b, &a)
                } else {
                    product('*', &a, &b)
                }
            }
            Divide(a, b) => {
                let (a, b) = (self.operand(a), self.operand(b));
                product('/', &a, &b)
            }
            Negate(a) => {
                let a = self.operand(a);
                negative(&a)
            }
            MultiplyAdd(a, b, c) => self.multiply_add(a, b, c, false, false),
            MultiplySubtract(a, b, c) => self.multiply_add(a, b, c, false, true),
            NegateMultiplyAdd(a, b, c) => self.multiply_add(a, b, c, true, false),
            NegateMultiplySubtract(a, b, c) => self.multiply_add(a, b, c, true, true),
            Call(function, args) => {
                let args: Vec<Piece> = args[..function.arity()].iter().map(|&r| self.operand(r)).collect();
                self.calls.add(function);
                let depth = args.iter().map(|arg| arg.depth).max().unwrap_or(0);
                let args = args.iter().map(Piece::text).collect::<Vec<_>>().join(", ");
                let text = match self.language {
                    Language::C => c::call(function, &args, &self.layout.prefix),
                    Language::Rust => rust::call(function, &args),
                };
                Piece::new(text, Binding::Atom, depth + 1)
            }
        }
    }

    /// a + b is b + a to the last bit: a summand that is a sum comes first and needs no brackets; one that
    /// begins with a sign comes last and is subtracted.
    fn sum(&mut self, a: Register, b: Register) -> Piece {
        let is_sum = |printer: &Self, r: Register| printer.pieces[r.index()].binding == Binding::Sum;
        let (a, b) = if is_sum(self, b) && !is_sum(self, a) { (b, a) } else { (a, b) };
        let (first, second) = (self.first_term(a), self.operand(b));
        if first.is_negative() && first.binding != Binding::Sum && !second.is_negative() {
            let (first, second) = (self.first_term(b), self.operand(a));
            return first.and_signed(&second);
        }
        first.and_signed(&second)
    }

    fn multiply_add(&mut self, a: Register, b: Register, c: Register, minus: bool, less: bool) -> Piece {
        self.calls.multiply_add = true;
        let [a, b, c] = [a, b, c].map(|r| self.operand(r));
        let a = if minus { negative(&a) } else { a };
        let c = if less { negative(&c) } else { c };
        let depth = a.depth.max(b.depth).max(c.depth) + 1;
        let name = match self.language {
            Language::C => "fma",
            Language::Rust => "math::mul_add",
        };
        Piece::new(format!("{name}({}, {}, {})", a.text(), b.text(), c.text()), Binding::Atom, depth)
    }

    /// The text of a register for use in an expression; text too long or too deep gets a name first.
    fn operand(&mut self, register: Register) -> Piece {
        let piece = &self.pieces[register.index()];
        if piece.len() > LONG || piece.depth >= DEEP { self.name_now(register) } else { piece.clone() }
    }

    /// The text of a register for use at the beginning of a sum; see [`operand`](Self::operand).
    fn first_term(&mut self, register: Register) -> Piece {
        let piece = &self.pieces[register.index()];
        let limit = if piece.binding == Binding::Sum { LONG_SUM } else { WIDTH };
        if piece.len() > limit || piece.depth > DEEP { self.name_now(register) } else { piece.clone() }
    }

    fn name_now(&mut self, register: Register) -> Piece {
        let index = register.index();
        let Some(&instruction) =
            index.checked_sub(self.program.first_result()).map(|i| &self.program.code()[i])
        else {
            return self.pieces[index].clone(); // the long name of an input
        };
        let piece = self.pieces[index].clone();
        if self.uses[index] > 1 {
            return piece; // it already has a name
        }
        let named = self.named(index, instruction, &piece);
        self.pieces[index] = named.clone();
        named
    }

    /// Declares a local variable for a value.
    fn named(&mut self, register: usize, instruction: Instruction, piece: &Piece) -> Piece {
        let name = self.local(register, instruction);
        let head = match self.language {
            Language::C if self.program.code().len() > MANY => format!("double {name} = "),
            Language::C => format!("const double {name} = "),
            Language::Rust => format!("let {name} = "),
        };
        self.statement(&head, piece, "");
        Piece::atom(name)
    }

    /// A name that says what the value is, such as `sin_theta` or `omega1_dot`, if there is one; otherwise a
    /// number.
    fn local(&mut self, register: usize, instruction: Instruction) -> String {
        let inputs = self.program.first_input() + 1..self.program.first_result();
        let of_input = match instruction {
            Instruction::Call(function, [x, ..]) if function.arity() == 1 && inputs.contains(&x.index()) => {
                let name = if function == Function::Abs { "abs" } else { function.name() };
                Some(format!("{name}_{}", self.pieces[x.index()].text()))
            }
            _ => None,
        };
        for name in [of_input, self.hints[register].map(str::to_owned)].into_iter().flatten() {
            if self.names.insert(name.clone()) {
                return name;
            }
        }
        loop {
            self.locals += 1;
            let name = format!("v{}", self.locals);
            if self.names.insert(name.clone()) {
                return name;
            }
        }
    }

    /// Declares the inputs that are read, and discards the other arguments.
    fn inputs(&self) -> Lines {
        let first = self.program.first_input();
        let read = |i: usize| self.uses[first + i] > 0;
        let state = self.program.state_len();
        let mut arguments = [("t", read(0)), ("y", false), ("p", false)];
        let mut lines = Lines::default();
        for (i, name) in self.layout.inputs.iter().enumerate().filter(|(i, _)| read(i + 1)) {
            let (array, index) = if i < state { (1, i) } else { (2, i - state) };
            arguments[array].1 = true;
            let from = format!("{}[{index}]", arguments[array].0);
            let symbol = &self.program.input_names()[i + 1];
            let comment =
                if symbol == name { String::new() } else { shortened(self.language.comment(symbol)) };
            match self.language {
                Language::C => lines.push(format!("const double {name} = {from};"), comment),
                Language::Rust => lines.push(format!("let {name} = {from};"), comment),
            }
        }
        for (argument, _) in arguments.iter().filter(|(_, read)| !read) {
            match self.language {
                Language::C => lines.push(format!("(void){argument};"), String::new()),
                Language::Rust => lines.push(format!("let _ = {argument};"), String::new()),
            }
        }
        lines
    }
}

impl Piece {
    /// The sum of this piece and a term that may begin with a sign.
    fn and_signed(self, term: &Piece) -> Piece {
        if term.is_negative() && term.binding != Binding::Sum {
            let mut positive = term.clone();
            positive.terms[0].remove(0);
            self.and('-', &positive)
        } else {
            self.and('+', term)
        }
    }
}

/// A comment of bounded length: names may have hundreds of letters.
fn shortened(comment: String) -> String {
    match comment.char_indices().nth(LONGEST_COMMENT) {
        Some((end, _)) => format!("{}...", comment[..end].trim_end()),
        None => comment,
    }
}

fn product(operator: char, a: &Piece, b: &Piece) -> Piece {
    let (left, left_depth) = a.left(Binding::Product);
    let (right, right_depth) = b.right(Binding::Atom);
    Piece::new(format!("{left}{operator}{right}"), Binding::Product, left_depth.max(right_depth))
}

/// −(a·b) is (−a)·b to the last bit.
fn negative(a: &Piece) -> Piece {
    let (text, depth) = a.right(Binding::Product);
    Piece::new(format!("-{text}"), Binding::Product, depth)
}
