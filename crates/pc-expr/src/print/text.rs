//! Expressions as text.

use std::fmt;

use crate::graph::expr::Expr;
use crate::graph::node::Atom;
use crate::graph::subgraph::Cone;
use crate::print::names::{Names, Side};
use crate::print::style::Style;
use crate::print::writer::Writer;

/// Expressions that take more operations than this when written out get names for their parts.
const LONG: u32 = 20_000;
/// Expressions whose parts have more bytes than this in total also get such names: nested parts can add up to
/// the square of the whole.
const LARGE: usize = 16 << 20;
/// The greatest number of columns between two signs in such an expression.
const ROOM: usize = 80;

impl Expr<'_> {
    /// The text in a style other than that of [`Display`](fmt::Display).
    ///
    /// The text is complete: parts of a long expression are defined after it, `z1 + 1/z1 where z1 = …`.
    /// [`Graph::names`](crate::Graph::names) prints several expressions with shared names for their parts.
    pub fn display(self, style: Style) -> String {
        let Some(graph) = self.graph() else {
            return match self.atom() {
                Atom::Constant(c) => style.number(c).text,
                Atom::Node(_) => "?".to_owned(),
            };
        };
        let written = || {
            graph.with(|dag| {
                let (mut writer, mut size) = (Writer::new(dag, style), 0);
                for node in Cone::below(dag, [self.atom()]).order {
                    writer.write(node);
                    size += writer.size(node);
                    if size > LARGE {
                        return None;
                    }
                }
                Some(writer.atom(self.atom()).text)
            })
        };
        let whole = if self.tree_cost() > LONG { None } else { written() };
        whole.unwrap_or_else(|| Names::new(graph, &[Side::Sum(self)], &[], ROOM).sentence(self, style))
    }
}

impl fmt::Debug for Expr<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl fmt::Display for Expr<'_> {
    /// The text in the expression language.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.display(Style::Text))
    }
}
