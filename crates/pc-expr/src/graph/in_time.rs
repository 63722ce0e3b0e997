//! Symbols that are functions of time, and what moves as time passes.

use crate::graph::expr::Expr;
use crate::graph::graph::Graph;

impl Graph {
    /// Declares that a symbol is a function of time whose derivative is another symbol.
    ///
    /// This is a fact about the two symbols: it holds in the [pages](Graph::page) of this graph that are made from
    /// then on. Partial derivatives do not know of it; those along [time](Graph::in_time) do.
    ///
    /// # Panics
    /// If one of them is not a symbol.
    pub fn declare_rate(&self, function: Expr<'_>, rate: Expr<'_>) {
        for symbol in [function, rate] {
            symbol.symbol_in(self);
        }
        let (function, rate) = (function.to_string(), rate.to_string());
        let mut rates = self.rates_mut();
        if rates.iter().all(|(known, _)| *known != function) {
            rates.push((function, rate));
        }
    }

    /// The derivative of a symbol that is a function of time, if it was [declared](Graph::declare_rate).
    pub fn rate_of<'g>(&'g self, symbol: Expr<'g>) -> Option<Expr<'g>> {
        let name = symbol.to_string();
        let rates = self.rates_mut();
        rates.iter().find(|(known, _)| *known == name).map(|(_, rate)| self.symbol(rate))
    }

    /// What moves as time passes, with its rates: time itself, at the rate 1, and the functions of time.
    ///
    /// ```
    /// # use pc_expr::Graph;
    /// let graph = Graph::new();
    /// let [t, road, slope] = graph.symbols(["t", "road", "road'"]);
    /// graph.declare_rate(road, slope);
    /// let rates = graph.directional(&[t * road], &graph.in_time(t));
    /// assert_eq!(rates, [road + t * slope]);
    /// ```
    pub fn in_time<'g>(&'g self, time: Expr<'g>) -> Vec<(Expr<'g>, Expr<'g>)> {
        let declared = self.rates_mut().clone();
        let moving = declared.iter().map(|(function, rate)| (self.symbol(function), self.symbol(rate)));
        [(time, Expr::ONE)].into_iter().chain(moving).collect()
    }
}
