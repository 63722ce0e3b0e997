//! Expressions as nodes of a graph, interned and normalised as they are built.
//!
//! In goes what [`Expr`](expr::Expr)'s operators build; out come nodes that are equal if they are written alike. Read
//! `number` (exact constants) and `function` (the elementary functions) first, then `dag` (the arena and the rules of
//! sums and products) with `calls`, `signs` and `divisors`, what it knows of calls, of signs and of divisors. `graph`
//! owns a `dag`, `expr` is the handle that formulas are written with; `subgraph` walks the nodes that expressions
//! depend on, and `evaluate` computes their values one by one: the reference for all faster ways.

pub(crate) mod calls;
pub(crate) mod dag;
pub(crate) mod divisors;
pub(crate) mod evaluate;
pub(crate) mod expr;
pub(crate) mod function;
pub(crate) mod graph;
pub(crate) mod number;
pub(crate) mod signs;
pub(crate) mod subgraph;
