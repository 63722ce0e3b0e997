//! Expression graph, derivatives, programs and kernels.
//!
//! Three representations, one line of flow: an [`Expr`] is what formulas are written with, a [`Graph`] interns its
//! nodes and differentiates them, a [`Program`] is a tape of chosen outputs that a [`Kernel`] runs.
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

mod angles;
mod collect;
mod colouring;
mod cone;
mod dag;
mod derivative;
mod emit;
mod error;
mod evaluate;
mod evaluator;
mod events;
mod expr;
mod field;
mod fingerprint;
mod function;
mod fuse;
mod graph;
#[cfg(feature = "jit")]
mod jit;
mod kernel;
mod lower;
mod number;
pub mod parse;
mod pattern;
mod print;
mod profile;
mod program;
mod rank;
mod relations;
mod sharing;
mod vector_field;

pub use collect::Polynomial;
pub use colouring::Colouring;
pub use dag::Folding;
pub use emit::{Body, Calls, Language, Layout, Place, Slot};
pub use error::{ExprError, readable};
pub use evaluate::Scalar;
pub use evaluator::{Backend, Evaluator};
pub use events::{Direction, Event, Events};
pub use expr::Expr;
pub use function::Function;
pub use fuse::Cost;
pub use graph::Graph;
#[cfg(feature = "jit")]
pub use jit::{Jit, JitError, JitOptions};
pub use kernel::{Entry, Interpreter, Kernel, compile};
pub use number::Number;
pub use pattern::Pattern;
pub use print::Style;
pub use profile::{Surprises, TimeDependence, TimeProfile};
pub use program::{Inputs, Instruction, Program, Register};
pub use vector_field::{Failure, VectorField};
