//! Derivatives: reverse sweeps for gradients, forward sweeps along a direction.
//!
//! For `step`, min and max, only the branch that is taken counts. The other branch may have no value or no
//! slope there, and multiplying that by 0 would give NaN. A branch that is not defined everywhere is
//! therefore differentiated separately, and the choice is made between the derivatives.

use rustc_hash::FxHashMap;

use crate::graph::dag::Dag;
use crate::graph::expr::Expr;
use crate::graph::function::Function;
use crate::graph::graph::Graph;
use crate::graph::node::{Atom, Node, NodeId};
use crate::graph::number::Number;
use crate::graph::places::SymbolPlaces;
use crate::graph::subgraph::{Assignment, Cone};

/// A node that equals the first branch where the condition is not negative, and the second elsewhere.
struct Choice {
    condition: Atom,
    branches: [NodeId; 2],
}

impl Dag {
    /// ∂`output`/∂`symbol` for each of `symbols`, by one reverse sweep.
    pub(crate) fn gradient(&mut self, output: Atom, symbols: &[NodeId]) -> Vec<Atom> {
        self.gradient_with(output, symbols, &mut FxHashMap::default())
    }

    /// Like [`gradient`](Self::gradient); `known` holds the gradients of branches that have already been
    /// computed.
    fn gradient_with(
        &mut self,
        output: Atom,
        symbols: &[NodeId],
        known: &mut FxHashMap<NodeId, Vec<Atom>>,
    ) -> Vec<Atom> {
        let Some(cone) = self.cone_within_budget([output]) else {
            return vec![Atom::Constant(Number::UNDEFINED); symbols.len()];
        };
        let active = cone.depending_on(self, symbols);
        let mut adjoints: FxHashMap<NodeId, Vec<(Atom, Number)>> = FxHashMap::default();
        if let Atom::Node(root) = output {
            adjoints.insert(root, vec![(Atom::ONE, Number::ONE)]);
        }
        let mut gradient = FxHashMap::default();
        for &node in cone.order.iter().rev() {
            if !active.contains(&node) {
                continue;
            }
            let Some(contributions) = adjoints.remove(&node) else { continue };
            let adjoint = self.sum_of(&contributions);
            if let Node::Symbol(_) = self.node(node) {
                gradient.insert(node, adjoint);
                continue;
            }
            if adjoint.is_zero() {
                continue;
            }
            if let Some(choice) = self.choice(node) {
                let [first, second] =
                    choice.branches.map(|branch| self.branch_gradient(branch, symbols, known));
                for ((&symbol, first), second) in symbols.iter().zip(first).zip(second) {
                    let slope = self.call(Function::Step, &[choice.condition, first, second]);
                    if !slope.is_zero() {
                        let product = self.product_of(Number::ONE, &[adjoint, slope]);
                        adjoints.entry(symbol).or_default().push((product, Number::ONE));
                    }
                }
                continue;
            }
            self.for_each_partial(node, |dag, child, partial, q| {
                if active.contains(&child) {
                    let product = dag.product_of(Number::ONE, &[adjoint, partial]);
                    adjoints.entry(child).or_default().push((product, q));
                }
            });
        }
        symbols.iter().map(|symbol| gradient.get(symbol).copied().unwrap_or(Atom::ZERO)).collect()
    }

    fn branch_gradient(
        &mut self,
        branch: NodeId,
        symbols: &[NodeId],
        known: &mut FxHashMap<NodeId, Vec<Atom>>,
    ) -> Vec<Atom> {
        if let Some(gradient) = known.get(&branch) {
            return gradient.clone();
        }
        let gradient = self.gradient_with(Atom::Node(branch), symbols, known);
        known.insert(branch, gradient.clone());
        gradient
    }

    /// The choice that a node makes between branches, if one of them is not defined everywhere.
    fn choice(&mut self, node: NodeId) -> Option<Choice> {
        let Node::Call { function, args: [a, b, c] } = self.node(node) else { return None };
        let branches = match function {
            Function::Step => [b, c],
            Function::Min | Function::Max => [a, b],
            _ => return None,
        };
        if self.is_defined_everywhere(branches) {
            return None;
        }
        let condition =
            if function == Function::Step { Atom::Node(a) } else { self.lead(function, branches) };
        Some(Choice { condition, branches })
    }

    /// An expression that is not negative where the minimum, or the maximum, is the first argument; a tie
    /// goes to the first argument, whose node is older.
    fn lead(&mut self, function: Function, [first, second]: [NodeId; 2]) -> Atom {
        let q = if function == Function::Min { Number::ONE } else { Number::MINUS_ONE };
        self.sum(Number::ZERO, &[(second, q), (first, -q)])
    }

    /// Whether the expressions and their derivatives are defined and finite at all states.
    fn is_defined_everywhere(&self, expressions: [NodeId; 2]) -> bool {
        use Function::{Abs, Atan, Cos, Max, Min, Sign, Sin, Step, Tanh};
        let is_bounded = |&node: &NodeId| match self.node(node) {
            Node::Constant(_) | Node::Symbol(_) | Node::Sum { .. } => true,
            Node::Applied { .. } => false,
            Node::Product { factors } => self.factors(factors).iter().all(|&(_, e)| e > 0),
            Node::Call { function, .. } => {
                matches!(function, Sin | Cos | Tanh | Atan | Abs | Sign | Min | Max | Step)
            }
        };
        Cone::below(self, expressions.map(Atom::Node)).order.iter().all(is_bounded)
    }

    /// The derivatives of `outputs` when each symbol of `seeds` changes at the rate given with it.
    pub(crate) fn directional(&mut self, outputs: &[Atom], seeds: &[(NodeId, Atom)]) -> Vec<Atom> {
        let Some(cone) = self.cone_within_budget(outputs.iter().copied()) else {
            return vec![Atom::Constant(Number::UNDEFINED); outputs.len()];
        };
        let moving: Vec<NodeId> = seeds.iter().map(|&(symbol, _)| symbol).collect();
        let active = cone.depending_on(self, &moving);
        let mut rates = Assignment::from_pairs(seeds);
        for &node in &cone.order {
            if !active.contains(&node) || rates.contains(node) {
                continue;
            }
            if let Some(Choice { condition, branches }) = self.choice(node) {
                let [first, second] = branches.map(|branch| rates.get(branch).unwrap_or(Atom::ZERO));
                let rate = self.call(Function::Step, &[condition, first, second]);
                rates.set(node, rate);
                continue;
            }
            let mut contributions = Vec::new();
            self.for_each_partial(node, |dag, child, partial, q| {
                if let Some(rate) = rates.get(child)
                    && !rate.is_zero()
                {
                    contributions.push((dag.product_of(Number::ONE, &[partial, rate]), q));
                }
            });
            let rate = self.sum_of(&contributions);
            rates.set(node, rate);
        }
        let rate_of = |atom| match atom {
            Atom::Constant(_) => Atom::ZERO,
            Atom::Node(node) => rates.get(node).unwrap_or(Atom::ZERO),
        };
        outputs.iter().map(|&output| rate_of(output)).collect()
    }

    /// Calls `visit(dag, child, p, q)` for each child of `node`, where q·p is the partial derivative with
    /// respect to that child.
    fn for_each_partial(&mut self, node: NodeId, mut visit: impl FnMut(&mut Dag, NodeId, Atom, Number)) {
        match self.node(node) {
            Node::Constant(_) | Node::Symbol(_) => {}
            Node::Sum { terms, .. } => {
                for i in 0..self.terms(terms).len() {
                    let (child, q) = self.terms(terms)[i];
                    visit(self, child, Atom::ONE, q);
                }
            }
            Node::Product { factors } => {
                let factors = self.factors(factors).to_vec();
                for (i, &(child, e)) in factors.iter().enumerate() {
                    let mut rest = factors.clone();
                    rest[i].1 -= 1;
                    let partial = self.product(Number::ONE, &rest);
                    visit(self, child, partial, Number::integer(e));
                }
            }
            Node::Applied { function, args } => {
                let args = function.args(&args);
                let atoms: Vec<Atom> = args.iter().map(|&arg| self.constant_of(Atom::Node(arg))).collect();
                for (position, &arg) in args.iter().enumerate() {
                    let partial = match function.differentiated(position) {
                        Some(derivative) => self.applied(derivative, &atoms),
                        None => Atom::Constant(Number::UNDEFINED),
                    };
                    visit(self, arg, partial, Number::ONE);
                }
            }
            Node::Call { function, args } => {
                let args: Vec<NodeId> = Dag::args(function, &args).to_vec();
                for position in 0..args.len() {
                    let partial = self.partial(function, &args, position, node);
                    if !partial.is_zero() {
                        visit(self, args[position], partial, Number::ONE);
                    }
                }
            }
        }
    }

    /// ∂f/∂(argument at `position`); `value` is the node of the call itself.
    fn partial(&mut self, function: Function, args: &[NodeId], position: usize, value: NodeId) -> Atom {
        let x = Atom::Node(args[0]);
        let f = Atom::Node(value);
        let one_minus_square = |dag: &mut Dag, u: Atom| {
            let square = dag.powi(u, 2);
            dag.sum_of(&[(Atom::ONE, Number::ONE), (square, Number::MINUS_ONE)])
        };
        match function {
            Function::Sin => self.call(Function::Cos, &[x]),
            Function::Cos => {
                let sin = self.call(Function::Sin, &[x]);
                self.scale(Number::MINUS_ONE, sin)
            }
            Function::Asin | Function::Acos => {
                let radicand = one_minus_square(self, x);
                let root = self.call(Function::Sqrt, &[radicand]);
                let reciprocal = self.powi(root, -1);
                self.scale(
                    if function == Function::Asin { Number::ONE } else { Number::MINUS_ONE },
                    reciprocal,
                )
            }
            Function::Atan => {
                let square = self.powi(x, 2);
                let sum = self.sum_of(&[(Atom::ONE, Number::ONE), (square, Number::ONE)]);
                self.powi(sum, -1)
            }
            Function::Atan2 => {
                // d atan2(y, x) = (x dy − y dx)/(x² + y²)
                let (y, x) = (Atom::Node(args[0]), Atom::Node(args[1]));
                let squares = [self.powi(x, 2), self.powi(y, 2)];
                let norm = self.sum_of(&squares.map(|s| (s, Number::ONE)));
                let reciprocal = self.powi(norm, -1);
                if position == 0 {
                    self.product_of(Number::ONE, &[x, reciprocal])
                } else {
                    self.product_of(Number::MINUS_ONE, &[y, reciprocal])
                }
            }
            Function::Sinh => self.call(Function::Cosh, &[x]),
            Function::Cosh => self.call(Function::Sinh, &[x]),
            Function::Tanh => one_minus_square(self, f),
            Function::Exp => f,
            Function::Log => self.powi(x, -1),
            Function::Sqrt => {
                let reciprocal = self.powi(f, -1);
                self.scale(Number::ratio(1, 2), reciprocal)
            }
            Function::Abs => self.call(Function::Sign, &[x]),
            Function::Sign => Atom::ZERO,
            Function::Min | Function::Max => {
                // The smaller argument alone counts for min, the larger for max.
                let lead = self.lead(function, [args[0], args[1]]);
                let [first, second] =
                    if position == 0 { [Atom::ONE, Atom::ZERO] } else { [Atom::ZERO, Atom::ONE] };
                self.call(Function::Step, &[lead, first, second])
            }
            Function::Step => match position {
                0 => Atom::ZERO, // the jump itself has no derivative
                1 => self.call(Function::Step, &[x, Atom::ONE, Atom::ZERO]),
                _ => self.call(Function::Step, &[x, Atom::ZERO, Atom::ONE]),
            },
            Function::Pow => {
                let y = Atom::Node(args[1]);
                if position == 0 {
                    let exponent = self.sum_of(&[(y, Number::ONE), (Atom::ONE, Number::MINUS_ONE)]);
                    let exponent = self.constant_of(exponent);
                    let power = self.call(Function::Pow, &[x, exponent]);
                    self.product_of(Number::ONE, &[y, power])
                } else {
                    let x = self.constant_of(x);
                    let log = self.call(Function::Log, &[x]);
                    self.product_of(Number::ONE, &[log, f])
                }
            }
        }
    }
}

impl Graph {
    /// ∂`output`/∂`symbol` for each of `symbols`, by one reverse sweep.
    ///
    /// # Panics
    /// If one of `symbols` is not a symbol.
    pub fn gradient<'g>(&'g self, output: Expr<'g>, symbols: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let nodes: Vec<NodeId> = symbols.iter().map(|s| s.symbol_in(self)).collect();
        let output = output.atom_in(self);
        self.build_all(|dag| dag.gradient(output, &nodes))
    }

    /// For each of `outputs`, the derivatives ∂`output`/∂`symbol` that are not 0, each with the index of
    /// its symbol: the [gradients](Graph::gradient) as a sparse matrix.
    ///
    /// ```
    /// # use pc_expr::Graph;
    /// let graph = Graph::new();
    /// let [x, y, z] = graph.symbols(["x", "y", "z"]);
    /// assert_eq!(graph.jacobian(&[x * z, y], &[x, y, z]), [vec![(0, z), (2, x)], vec![(1, 1.into())]]);
    /// ```
    ///
    /// # Panics
    /// If one of `symbols` is not a symbol, or occurs twice.
    pub fn jacobian<'g>(&'g self, outputs: &[Expr<'g>], symbols: &[Expr<'g>]) -> Vec<Vec<(usize, Expr<'g>)>> {
        let nodes: Vec<NodeId> = symbols.iter().map(|s| s.symbol_in(self)).collect();
        let places = SymbolPlaces::of(symbols);
        assert!(nodes.iter().enumerate().all(|(place, &node)| places.of_node(node) == Some(place)), "twice");
        let row = |output: &Expr<'g>| {
            let output = output.atom_in(self);
            let slopes = self.with(|dag| {
                let mut moving: Vec<usize> = Cone::below(dag, [output])
                    .order
                    .iter()
                    .filter_map(|&node| places.of_node(node))
                    .collect();
                moving.sort_unstable();
                let symbols: Vec<NodeId> = moving.iter().map(|&place| nodes[place]).collect();
                moving.into_iter().zip(dag.gradient(output, &symbols)).collect::<Vec<_>>()
            });
            let nonzero = slopes.into_iter().filter(|(_, slope)| !slope.is_zero());
            nonzero.map(|(place, slope)| (place, self.expr(slope))).collect()
        };
        outputs.iter().map(row).collect()
    }

    /// The rates of change of `outputs` when each symbol of `rates` changes at the rate paired with it: one
    /// forward sweep.
    ///
    /// # Panics
    /// If the first of a pair is not a symbol.
    pub fn directional<'g>(&'g self, outputs: &[Expr<'g>], rates: &[(Expr<'g>, Expr<'g>)]) -> Vec<Expr<'g>> {
        let seeds: Vec<(NodeId, Atom)> =
            rates.iter().map(|(symbol, rate)| (symbol.symbol_in(self), rate.atom_in(self))).collect();
        let outputs: Vec<Atom> = outputs.iter().map(|x| x.atom_in(self)).collect();
        self.build_all(|dag| dag.directional(&outputs, &seeds))
    }
}

impl<'g> Expr<'g> {
    /// ∂self/∂`symbol`.
    ///
    /// # Panics
    /// If `symbol` is not a symbol.
    #[must_use]
    pub fn derivative(self, symbol: Expr<'g>) -> Expr<'g> {
        match self.graph() {
            Some(graph) if matches!(self.atom(), Atom::Node(_)) => {
                graph.directional(&[self], &[(symbol, Expr::ONE)])[0]
            }
            _ => Expr::ZERO,
        }
    }

    /// Whether the value changes with `symbol`: its derivative is not identically zero.
    pub fn depends_on(self, symbol: Expr<'g>) -> bool {
        !self.derivative(symbol).is_zero()
    }
}
