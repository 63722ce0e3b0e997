//! Expressions as nodes of a graph, interned and normalised as they are built.
//!
//! The operators of [`Expr`](expr::Expr) build nodes; expressions written alike are one node. Read `number`
//! (exact constants), `function` (the elementary functions), `node` and `divisors` (sets of them) first, then
//! `dag` (the arena) with `normal_form`, `calls`, `fractional`, `value`, `signs` and `regularity`, which treat sums and
//! products, calls, powers of powers, values in prime fields, signs, and divisors. `graph` owns a `dag` and stays within a
//! `budget` (`limits`, and for time a `deadline`), and `in_time` knows which symbols are functions of time; `expr` is the handle with which formulas are written;
//! `subgraph` walks the nodes below some expressions, `queries` answers questions about whole expressions,
//! `undetermined` holds functions that are not given,
//! `applied` their calls and `stand_in` the functions that take their place in numbers, `places` finds symbols in long lists, `transcription` writes expressions in another graph, and `evaluate`
//! computes values node by node: the reference for all faster methods.

pub(crate) mod applied;
pub(crate) mod budget;
pub(crate) mod calls;
pub(crate) mod dag;
pub(crate) mod deadline;
pub(crate) mod divisors;
pub(crate) mod evaluate;
pub(crate) mod expr;
pub(crate) mod fractional;
pub(crate) mod function;
pub(crate) mod graph;
pub(crate) mod in_time;
pub(crate) mod limits;
pub(crate) mod node;
pub(crate) mod normal_form;
pub(crate) mod number;
pub(crate) mod places;
pub(crate) mod queries;
pub(crate) mod regularity;
pub(crate) mod signs;
pub(crate) mod stand_in;
pub(crate) mod subgraph;
pub(crate) mod transcription;
pub(crate) mod undetermined;
pub(crate) mod value;
