//! The request for source text, which gives the language and says where inputs and outputs are, and the
//! result.

use crate::graph::function::Function;

/// A language in which programs are printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Language {
    /// C99 that is also valid C++.
    C,
    /// Rust of the 2021 edition or later.
    Rust,
}

/// Where a printed function puts an output.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// An entry to be assigned, for instance `ydot[0]`.
    Entry(String),
    /// The function returns it as its only output.
    Returned,
}

/// One output of a printed function.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Slot {
    /// Where the output is put.
    pub place: Place,
    /// The meaning of the output, as a comment after the statement; may be empty.
    pub comment: String,
    /// A name for the value of the output in case that value is used again: an identifier of the language;
    /// may be empty.
    pub local: String,
}

/// How a program becomes a function of the arguments `t`, `y` (the state) and `p` (the parameters).
#[derive(Clone, Debug)]
pub struct Layout {
    /// Identifiers of the state and the parameters, from [`Language::identifiers`].
    pub inputs: Vec<String>,
    /// One slot for each output.
    pub slots: Vec<Slot>,
    /// Whether outputs that are zero at all states are left out: the surrounding function then clears the array first.
    pub skip_zeros: bool,
    /// The prefix of the [helper functions](Language::helpers); in C all names share one namespace.
    pub prefix: String,
    /// Identifiers that no local variable may have, such as the name of the array of the outputs.
    pub reserved: Vec<String>,
}

/// The text of a function body, with lines indented by four spaces.
#[derive(Clone, Debug, Default)]
pub struct FunctionBody {
    /// Declarations of the inputs that are read, and statements that mark the other arguments as unused.
    pub inputs: String,
    /// Statements that compute the outputs.
    pub statements: String,
    /// The functions that the statements call.
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
    /// The functions called by either piece of code.
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
