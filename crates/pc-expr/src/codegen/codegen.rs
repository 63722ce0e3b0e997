//! Programs as source text: the statements of one straight-line function.
//!
//! What is printed computes what the [interpreter](crate::Interpreter) computes, operation by operation: a value used
//! once is written where it is used, with brackets wherever the order of operations needs them, any other becomes a
//! local constant.

use crate::graph::function::Function;
use crate::program::program::Program;

/// A language that programs are printed in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Language {
    /// C99 that is also C++.
    C,
    /// Rust of the 2021 edition or later.
    Rust,
}

/// Where a printed function puts one output.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// It is assigned to this, for instance `ydot[0]`.
    Entry(String),
    /// It is what the function returns; there is no other output then.
    Returned,
}

/// One output of a printed function.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Slot {
    /// Where it goes.
    pub place: Place,
    /// What it is, as a comment after the statement; may be empty.
    pub comment: String,
    /// A name for its value where that is needed again, an identifier of the language; may be empty.
    pub local: String,
}

/// How a program is put into a function of the arguments `t`, `y` (the state) and `p` (the parameters).
#[derive(Clone, Debug)]
pub struct Layout {
    /// Identifiers of the state and the parameters, from [`Language::identifiers`].
    pub inputs: Vec<String>,
    /// One slot for each output.
    pub slots: Vec<Slot>,
    /// Leaves out the outputs that are zero at all states: whoever writes the function clears the array first.
    pub skip_zeros: bool,
    /// Begins the names of the [helper functions](Language::helpers), which C puts into one space with all others.
    pub prefix: String,
    /// Identifiers that no local may have, such as the name of the array of the outputs.
    pub reserved: Vec<String>,
}

/// The text of a function body, lines indented by four spaces.
#[derive(Clone, Debug, Default)]
pub struct Body {
    /// Declares the inputs that are read, and passes over the arguments that are not.
    pub inputs: String,
    /// Computes the outputs.
    pub statements: String,
    /// What it calls.
    pub calls: Calls,
}

/// The functions that printed code calls.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Calls {
    /// The elementary functions, in the order of [`Function::ALL`].
    pub(super) functions: Vec<Function>,
    /// Whether a fused multiply-add is called.
    pub(super) multiply_add: bool,
}

impl Calls {
    /// These and those.
    #[must_use]
    pub fn and(mut self, other: &Calls) -> Calls {
        other.functions.iter().for_each(|&function| self.add(function));
        self.multiply_add |= other.multiply_add;
        self
    }

    pub(super) fn add(&mut self, function: Function) {
        if let Err(place) = self.functions.binary_search_by_key(&(function as u8), |&known| known as u8) {
            self.functions.insert(place, function);
        }
    }
}

impl Language {
    /// Valid and distinct identifiers for `names`, each as close to its name as can be: Greek letters are spelt out,
    /// a prime becomes `_dot`, and what is a word of the language, an argument of a [`Layout`] or in `reserved` gets
    /// a `_` at its end.
    ///
    /// ```
    /// use pc_expr::Language;
    /// let names = ["γ1", "x'", "δθ", "class", "y", "γ_1"];
    /// let identifiers = Language::C.identifiers(&names, &[]);
    /// assert_eq!(identifiers, ["gamma1", "x_dot", "delta_theta", "class_", "y_", "gamma_1"]);
    /// ```
    pub fn identifiers<S: AsRef<str>>(self, names: &[S], reserved: &[&str]) -> Vec<String> {
        crate::codegen::identifier::distinct(self, names, reserved)
    }

    /// A literal of the constant that reads back to the same bits.
    pub fn constant(self, value: f64) -> String {
        match self {
            Language::C => crate::codegen::c::constant(value),
            Language::Rust => crate::codegen::rust::constant(value),
        }
    }

    /// A string literal.
    pub fn string(self, text: &str) -> String {
        match self {
            Language::C => crate::codegen::c::string(text),
            Language::Rust => crate::codegen::rust::string(text),
        }
    }

    /// `text` on one line and without what would end or break a comment.
    pub fn comment(self, text: &str) -> String {
        crate::codegen::identifier::comment(text)
    }

    /// Definitions that the code which makes these calls needs: in C the functions that `<math.h>` lacks, their names
    /// beginning with `prefix`; in Rust the module `math`.
    pub fn helpers(self, calls: &Calls, prefix: &str) -> String {
        match self {
            Language::C => crate::codegen::c::helpers(calls, prefix),
            Language::Rust => crate::codegen::rust::helpers(calls),
        }
    }
}

impl Program {
    /// The program as the body of a function; multiply-adds are fused only where they are so in a
    /// [fused](Program::fused) program.
    ///
    /// ```
    /// use pc_expr::{Graph, Inputs, Language, Layout, Place, Program, Slot};
    ///
    /// let graph = Graph::new();
    /// let [theta, g] = graph.symbols(["θ", "g"]);
    /// let inputs = Inputs { time: None, state: vec![theta], parameters: vec![g] };
    /// let program = Program::new(&graph, &inputs, &[-g * theta.sin()])?;
    /// let layout = Layout {
    ///     inputs: Language::C.identifiers(&["θ", "g"], &["torque"]),
    ///     slots: vec![Slot { place: Place::Entry("*torque".into()), comment: "N m".into(), local: String::new() }],
    ///     skip_zeros: false,
    ///     prefix: "pendulum_".into(),
    ///     reserved: vec!["torque".into()],
    /// };
    /// let body = program.emit(Language::C, &layout);
    /// assert_eq!(
    ///     body.inputs,
    ///     "    const double theta = y[0]; /* θ */\n    const double g = p[0];\n    (void)t;\n"
    /// );
    /// assert_eq!(body.statements, "    *torque = -g*sin(theta); /* N m */\n");
    /// # Ok::<(), pc_expr::ExprError>(())
    /// ```
    ///
    /// # Panics
    /// If `layout` has not as many identifiers as there are inputs without time, or not as many slots as outputs.
    pub fn emit(&self, language: Language, layout: &Layout) -> Body {
        assert_eq!(layout.inputs.len(), self.state_len() + self.parameters_len(), "identifiers of inputs");
        assert_eq!(layout.slots.len(), self.outputs_len(), "slots of outputs");
        crate::codegen::function_body::Printer::new(self, language, layout).print()
    }
}
