//! The degree of an expression in several symbols together.

use crate::graph::expr::Expr;
use crate::graph::graph::Graph;
use crate::identity::prime_field::Residue;
use crate::identity::rational_function::{Grid, degrees};
use crate::identity::sampler::{Sampler, value_at};

impl Graph {
    /// The degree of e as a polynomial in the `symbols` together, if it is one of degree up to ten: that of e(s z) in s at
    /// a random point.
    ///
    /// ```
    /// use pc_expr::Graph;
    /// let graph = Graph::new();
    /// let [x, y, a] = graph.symbols(["x", "y", "a"]);
    /// let f = (x + y).powi(3) / a - x.powi(3) / a + a.sin() * y;
    /// assert_eq!((graph.total_degree(f, &[x, y]), graph.total_degree(f, &[y])), (Some(3), Some(3)));
    /// assert_eq!((graph.total_degree(f, &[x]), graph.total_degree(f, &[a])), (Some(2), None));
    /// ```
    pub fn total_degree<'g>(&'g self, e: Expr<'g>, symbols: &[Expr<'g>]) -> Option<u32> {
        let scale = self.unused_symbol(e);
        let scaled: Vec<(Expr<'g>, Expr<'g>)> = symbols.iter().map(|&z| (z, scale * z)).collect();
        let e = self.substitute(&[e], &scaled)[0];
        if e.constant().is_some() {
            return Some(0);
        }
        let mut ray = Ray { sampler: Sampler::new(self, &[e], &[scale]), scale };
        match degrees(&mut ray, 0)? {
            (degree, 0) => Some(degree as u32),
            _ => None,
        }
    }

    /// A symbol that does not occur in e.
    fn unused_symbol<'g>(&'g self, e: Expr<'g>) -> Expr<'g> {
        let mut name = "scale".to_owned();
        while e.depends_on(self.symbol(&name)) {
            name.push('_');
        }
        self.symbol(&name)
    }
}

/// The values of an expression of one symbol, while all others stay.
struct Ray<'g> {
    sampler: Sampler<'g>,
    scale: Expr<'g>,
}

impl Grid for Ray<'_> {
    fn variables(&self) -> usize {
        1
    }

    fn variable(&self, _: usize, place: usize) -> Residue {
        value_at(self.scale, place)
    }

    fn value(&mut self, places: &[usize]) -> Option<Residue> {
        self.sampler.at(0, places).first().copied()
    }
}
