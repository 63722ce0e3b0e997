//! From the text of an expression to a syntax tree with spans.
//!
//! ```text
//! sum     = product { ("+" | "-") product }
//! product = unary { ("*" | "/") unary }
//! unary   = "-" unary | power
//! power   = atom [ "^" unary ]                       right-associative, tighter than a minus on its left
//! atom    = number | name | name "'" | function "(" sum { "," sum } ")" | "(" sum ")"
//! ```
//! Sums and products are flat lists, so that their length costs no stack; everything that nests is bounded by
//! [`MAX_DEPTH`]. Names are not resolved here: `pi` and `t` are names like any other.
//!
//! ```
//! use pc_expr::parse::{AstKind, parse};
//! let tree = parse("m/2*x'^2")?;
//! assert!(matches!(tree.kind, AstKind::Product(factors) if factors.len() == 3));
//! assert_eq!(parse("2 x").unwrap_err().to_string(), "expected an operator before `x`");
//! # Ok::<(), pc_expr::parse::ParseError>(())
//! ```

mod error;
mod grammar;
mod syntax_tree;
mod vocabulary;

pub use error::{ParseError, ParseErrorKind};
pub use grammar::{parse, parse_with};
pub use syntax_tree::{Ast, AstKind, Factor, MAX_DEPTH, Sign, Span};
pub use vocabulary::{Declared, FUNCTIONS, Function, is_name, nearest};
