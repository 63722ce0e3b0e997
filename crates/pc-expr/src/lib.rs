//! Expression graph, derivatives, programs and kernels.
//!
//! Three representations, one after the other: an [`Expr`] is the handle with which formulas are written, a
//! [`Graph`] interns their nodes and differentiates them, a [`Program`] is a tape of chosen outputs that a
//! [`Kernel`] runs.
//!
//! ```
//! use std::sync::Arc;
//! use pc_expr::{Graph, Inputs, Interpreter, Kernel, Program};
//!
//! let graph = Graph::new();
//! let [x, v, k] = graph.symbols(["x", "v", "k"]);
//! let energy = (v * v + k * x * x) / 2.0;
//! let gradient = graph.gradient(energy, &[x, v]);
//! assert_eq!(gradient[0].to_string(), "x*k");
//!
//! let inputs = Inputs { time: None, state: vec![x, v], parameters: vec![k] };
//! let program = Program::new(&graph, &inputs, &gradient)?;
//! let mut kernel = Interpreter::new(Arc::new(program));
//! let mut out = [0.0; 2];
//! kernel.eval(0.0, &[1.0, 2.0], &[3.0], &mut out);
//! assert_eq!(out, [3.0, 2.0]);
//! # Ok::<(), pc_expr::ExprError>(())
//! ```
//!
//! # Modules, in the order of the flow
//!
//! `parse` text → syntax tree · `graph` expressions · `identity` equality, decided by fingerprints · `calculus`
//! derivatives and short forms · `print` text and LaTeX · `program` chosen outputs as a tape · `kernel` running a tape
//! · `codegen` tapes as source text · `ode` the interface to integrators · `taylor` the Taylor
//! coefficients of solutions · `time_profile` the explicit dependence of a field on time.
//!
//! # Around it
//!
//! Below this crate: no other crate of pc. Above it: [pc-algebra](../pc_algebra/index.html), which makes
//! frames from expressions, and [pc-solve](../pc_solve/index.html), which integrates vector fields.

mod calculus;
mod codegen;
mod error;
mod graph;
mod identity;
mod kernel;
mod ode;
pub mod parse;
mod print;
mod program;
#[cfg(test)]
#[path = "../../../tests/src/classical/random.rs"]
mod random;
mod taylor;
mod time_profile;

pub use calculus::breaks::Break;
pub use calculus::held::{Held, Surface};
pub use calculus::polynomial::Polynomial;
pub use calculus::substitution::Substitution;
pub use codegen::chain::{Chain, ChainLayout};
pub use codegen::identifier::greek;
pub use codegen::layout::{Calls, FunctionBody, Language, Layout, Place, Slot};
pub use error::{ExprError, readable};
pub use graph::budget::Budget;
pub use graph::deadline::Deadline;
pub use graph::evaluate::Scalar;
pub use graph::expr::Expr;
pub use graph::function::Function;
pub use graph::graph::Graph;
pub use graph::limits::{Cancel, Limits, Spent};
pub use graph::node::Folding;
pub use graph::number::Number;
pub use graph::places::SymbolPlaces;
pub use graph::stand_in::{StandIn, Wave};
pub use graph::transcription::Transcription;
pub use graph::undetermined::MOST_ARGUMENTS;
pub use identity::blocks::independent_blocks;
pub use identity::echelon::ResidueEchelon;
pub use identity::prime_field::Residue;
pub use identity::running_error::Weighed;
pub use kernel::evaluator::{Backend, Evaluator, compile};
#[cfg(feature = "jit")]
pub use kernel::jit::{Jit, JitError, JitOptions};
pub use kernel::kernel::{Entry, Interpreter, Kernel};
pub use kernel::lanes::instruction_set::InstructionSet;
pub use kernel::lanes::kernel::LaneKernel;
pub use kernel::lanes::tape::{Binary, Fused, LANES, LaneTape, LaneValue, Lanes};
pub use ode::colouring::Colouring;
pub use ode::events::{Direction, Event, Events};
pub use ode::failure::Failure;
pub use ode::lane_field::{LaneField, Watched};
pub use ode::method::Method;
pub use ode::pattern::Pattern;
pub use ode::program_field::ProgramField;
pub use ode::rate_jump::RateJump;
pub use ode::sliding::{Sliding, SlidingError};
pub use ode::sliding_range::SlidingRange;
pub use ode::switching::Switching;
pub use ode::varied::VariedSeries;
pub use ode::vector_field::VectorField;
pub use print::names::{Given, Name, Names, Side, Written};
pub use print::style::Style;
pub use program::digest::Digest;
pub use program::fuse::Cost;
pub use program::program::{Inputs, Instruction, Program, Register};
pub use program::sliding::Normals;
pub use taylor::coefficients::TaylorSeries;
pub use taylor::separation::RootSeparation;
pub use time_profile::motion::PolynomialMotion;
pub use time_profile::profile::{TimeDependence, TimeProfile};
pub use time_profile::steep::SteepFunctions;
pub use time_profile::surprises::Surprises;
