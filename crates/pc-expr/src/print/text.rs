//! Expressions as text.

use std::fmt;

use crate::graph::expr::Expr;
use crate::graph::node::Atom;
use crate::graph::subgraph::Cone;
use crate::print::names::{Names, Side};
use crate::print::style::Style;
use crate::print::writer::Writer;

/// Expressions of more operations than this, when written out, are written with names for their parts.
const LONG: u32 = 20_000;
/// Columns of what stands between two signs there.
const ROOM: usize = 80;

impl Expr<'_> {
    /// The text in another style than [`Display`](fmt::Display)'s.
    ///
    /// All of it: what is long has parts that are named behind it, `z1 + 1/z1 where z1 = …`. To print several expressions
    /// with names in common there is [`Graph::names`](crate::Graph::names).
    pub fn display(self, style: Style) -> String {
        let Some(graph) = self.graph() else {
            return match self.atom() {
                Atom::Constant(c) => style.number(c).text,
                Atom::Node(_) => "?".to_owned(),
            };
        };
        if self.tree_cost() > LONG {
            return Names::new(graph, &[Side::Sum(self)], &[], ROOM).sentence(self, style);
        }
        graph.with(|dag| {
            let mut writer = Writer::new(dag, style);
            Cone::below(dag, [self.atom()]).order.into_iter().for_each(|node| writer.write(node));
            writer.atom(self.atom()).text
        })
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
