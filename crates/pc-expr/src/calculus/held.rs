//! Piecewise expressions, held on one of their pieces.

use rustc_hash::FxHashSet;

use crate::graph::dag::Dag;
use crate::graph::expr::Expr;
use crate::graph::function::Function;
use crate::graph::graph::Graph;
use crate::graph::node::{Atom, Node, NodeId};
use crate::graph::number::Number;
use crate::graph::subgraph::Cone;

/// Expressions in which the side of each surface is a symbol: smooth functions, which continue beyond the surfaces.
#[derive(Clone, Debug)]
pub struct Held<'g> {
    /// The expressions, with pieces chosen by the sides.
    pub values: Vec<Expr<'g>>,
    /// The surfaces, each with its side; a surface contains only the sides of preceding surfaces.
    pub surfaces: Vec<Surface<'g>>,
}

/// A surface on which expressions change from one piece to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface<'g> {
    /// Vanishes there.
    pub function: Expr<'g>,
    /// The sign of the function: 1 or −1.
    pub side: Expr<'g>,
}

impl Graph {
    /// The expressions with their pieces held: with the side s of each surface g that is passed as the `moving` symbols
    /// change,
    /// ```text
    /// sign(g) = s,   |g| = s g,   step(g, a, b) = step(s, a, b),   min(a, b) = step(s, b, a) with g = a − b,
    /// atan(u/v) = atan2(s u, s v) with g = v
    /// ```
    /// The surfaces of a product are the surfaces of its factors. Expressions that are not piecewise stay as
    /// they are.
    ///
    /// ```
    /// # use pc_expr::Graph;
    /// let graph = Graph::new();
    /// let [x, m] = graph.symbols(["x", "m"]);
    /// let held = graph.held(&[-m * (2.0 * x).sign(), (x * m).abs()], &[x]);
    /// assert_eq!(held.surfaces.len(), 1);
    /// let (s, function) = (held.surfaces[0].side, held.surfaces[0].function);
    /// assert_eq!((function, held.values[0]), (x, -m * s));
    /// assert_eq!(graph.held(&[x.sin(), m.abs()], &[x]).surfaces, []);
    /// ```
    pub fn held<'g>(&'g self, values: &[Expr<'g>], moving: &[Expr<'g>]) -> Held<'g> {
        self.held_on(values, moving, &[])
    }

    /// As [`held`](Self::held), for further expressions: known `surfaces` keep their sides, and new ones
    /// follow them.
    pub fn held_on<'g>(
        &'g self,
        values: &[Expr<'g>],
        moving: &[Expr<'g>],
        surfaces: &[Surface<'g>],
    ) -> Held<'g> {
        let mut held = Held { values: values.to_vec(), surfaces: surfaces.to_vec() };
        let moving: Vec<NodeId> = moving.iter().map(|symbol| symbol.symbol_in(self)).collect();
        // From within outwards: as many rounds as pieces are nested. Where a piece cancels it may come back with an older
        // expression of the same value, which does not change with it.
        let mut done: FxHashSet<NodeId> = FxHashSet::default();
        loop {
            let pieces = self.innermost_pieces(&held.values, &moving);
            let before = done.len();
            done.extend(pieces.iter().map(|piece| piece.node));
            if done.len() == before {
                break;
            }
            let smooth = |piece| (piece, self.smooth(piece, &moving, &mut held.surfaces));
            let replaced: Vec<(Piece<'g>, Expr<'g>)> = pieces.into_iter().map(smooth).collect();
            let replaced: Vec<(NodeId, Atom)> =
                replaced.iter().map(|(piece, smooth)| (piece.node, smooth.atom_in(self))).collect();
            let roots: Vec<Atom> = held.values.iter().map(|value| value.atom_in(self)).collect();
            held.values = self.build_all(|dag| dag.substitute(&roots, &replaced));
        }
        held
    }

    /// Held expressions between two pieces, for sides from −1 to 1: with step(s, a, b) = (1 + s)/2 a + (1 − s)/2 b for
    /// each s composed of `sides`, the expressions become combinations of their values on both sides.
    ///
    /// ```
    /// # use pc_expr::Graph;
    /// let graph = Graph::new();
    /// let [x, a, b, s] = graph.symbols(["x", "a", "b", "s"]);
    /// let value = x * s.step(a, b) + a.step(x, b);
    /// let between = graph.blended(&[value], &[s])[0];
    /// assert_eq!(between, x * ((1.0 + s) / 2.0 * a + (1.0 - s) / 2.0 * b) + a.step(x, b));
    /// ```
    pub fn blended<'g>(&'g self, values: &[Expr<'g>], sides: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let mut values = values.to_vec();
        loop {
            let choices = self.innermost_choices(&values, sides);
            if choices.is_empty() {
                return values;
            }
            let between = |&(node, [side, a, b]): &(NodeId, [Expr<'g>; 3])| {
                (node, ((1.0 + side) / 2.0 * a + (1.0 - side) / 2.0 * b).atom_in(self))
            };
            let replaced: Vec<(NodeId, Atom)> = choices.iter().map(between).collect();
            let roots: Vec<Atom> = values.iter().map(|value| value.atom_in(self)).collect();
            values = self.build_all(|dag| dag.substitute(&roots, &replaced));
        }
    }

    /// The calls of step whose condition contains only sides and that contain no other such call, with their
    /// arguments.
    fn innermost_choices<'g>(
        &'g self,
        values: &[Expr<'g>],
        sides: &[Expr<'g>],
    ) -> Vec<(NodeId, [Expr<'g>; 3])> {
        let roots: Vec<Atom> = values.iter().map(|value| value.atom_in(self)).collect();
        let sides: Vec<NodeId> = sides.iter().map(|side| side.symbol_in(self)).collect();
        let choices: Vec<(NodeId, [NodeId; 3])> = self.with(|dag| {
            let cone = Cone::below(dag, roots);
            let by_sides = cone.depending_on(dag, &sides);
            let is_symbol = |node: &NodeId| matches!(dag.node(*node), Node::Symbol(_));
            let others: Vec<NodeId> =
                cone.order.iter().copied().filter(|node| is_symbol(node) && !sides.contains(node)).collect();
            let by_others = cone.depending_on(dag, &others);
            let choice = |node: NodeId| match dag.node(node) {
                Node::Call { function: Function::Step, args }
                    if by_sides.contains(&args[0]) && !by_others.contains(&args[0]) =>
                {
                    Some(args)
                }
                _ => None,
            };
            cone.innermost(dag, choice)
        });
        let argument = |node: NodeId| self.build(|dag| dag.constant_of(Atom::Node(node)));
        choices.into_iter().map(|(node, args)| (node, args.map(argument))).collect()
    }

    /// The piecewise nodes whose surfaces move and that contain no other such node.
    fn innermost_pieces<'g>(&'g self, values: &[Expr<'g>], moving: &[NodeId]) -> Vec<Piece<'g>> {
        let roots: Vec<Atom> = values.iter().map(|value| value.atom_in(self)).collect();
        let pieces = self.with(|dag| {
            let cone = Cone::below(dag, roots);
            let is_one = |node: &NodeId| match dag.node(*node) {
                Node::Call { function, .. } => function.is_piecewise() || function == Function::Atan,
                _ => false,
            };
            if !cone.order.iter().any(is_one) {
                return Vec::new();
            }
            let moves = cone.depending_on(dag, moving);
            cone.innermost(dag, |node| {
                let Node::Call { function, args } = dag.node(node) else { return None };
                let passes = match function {
                    Function::Min | Function::Max => moves.contains(&args[0]) || moves.contains(&args[1]),
                    Function::Atan => dag.has_pole(args[0], &moves),
                    _ => function.is_piecewise() && moves.contains(&args[0]),
                };
                passes.then_some((function, args))
            })
        });
        let piece = |(node, (function, args)): (NodeId, (Function, [NodeId; 3]))| {
            let arity = function.arity();
            let argument = |i: usize| {
                let node = args[if i < arity { i } else { 0 }];
                self.build(|dag| dag.constant_of(Atom::Node(node)))
            };
            Piece { node, function, args: [argument(0), argument(1), argument(2)] }
        };
        pieces.into_iter().map(piece).collect()
    }

    /// A piece with its surfaces held; new surfaces are added to the list.
    fn smooth<'g>(
        &'g self,
        Piece { function, args: [a, b, c], .. }: Piece<'g>,
        moving: &[NodeId],
        surfaces: &mut Vec<Surface<'g>>,
    ) -> Expr<'g> {
        let mut side = |function: Expr<'g>| self.side(function, moving, surfaces);
        match function {
            Function::Sign => side(a),
            Function::Abs => side(a) * a,
            Function::Min => side(a - b).step(b, a),
            Function::Max => side(a - b).step(a, b),
            Function::Atan => {
                let (above, below) = self.parts(a);
                let side = side(below);
                (side * above).atan2(side * below)
            }
            _ => side(a).step(b, c),
        }
    }

    /// The sign of a function in terms of the sides of those of its factors that move; new surfaces are added
    /// to the list.
    fn side<'g>(
        &'g self,
        function: Expr<'g>,
        moving: &[NodeId],
        surfaces: &mut Vec<Surface<'g>>,
    ) -> Expr<'g> {
        let number = function.numerical_factor();
        let mut side: Expr<'g> = if number.is_negative() { -1 } else { 1 }.into();
        for (factor, exponent) in self.factors(function) {
            if exponent % 2 == 0 || self.is_positive(factor) {
                continue;
            }
            side *= match self.moves(factor, moving) {
                true => self.side_of_factor(factor, surfaces),
                false => factor.sign(),
            };
        }
        side
    }

    fn side_of_factor<'g>(&'g self, factor: Expr<'g>, surfaces: &mut Vec<Surface<'g>>) -> Expr<'g> {
        // x − a and a − x are one surface.
        let is_reversed = self.leading(factor).is_negative();
        let function = if is_reversed { -factor } else { factor };
        let known = surfaces.iter().find(|surface| surface.function == function).map(|surface| surface.side);
        let side = known.unwrap_or_else(|| {
            let side = self.symbol(&format!("side {}", surfaces.len()));
            let node = side.symbol_in(self);
            self.with(|dag| dag.confine(node));
            surfaces.push(Surface { function, side });
            side
        });
        if is_reversed { -side } else { side }
    }

    /// The coefficient of the first term.
    fn leading(&self, function: Expr<'_>) -> Number {
        let Atom::Node(node) = function.atom_in(self) else { return Number::ONE };
        self.with(|dag| match dag.node(node) {
            Node::Sum { terms, .. } => dag.terms(terms).first().map_or(Number::ONE, |&(_, factor)| factor),
            _ => Number::ONE,
        })
    }

    fn is_positive(&self, function: Expr<'_>) -> bool {
        let Atom::Node(node) = function.atom_in(self) else { return false };
        self.with(|dag| dag.is_nonnegative(node))
    }

    fn moves(&self, function: Expr<'_>, moving: &[NodeId]) -> bool {
        let root = function.atom_in(self);
        self.with(|dag| {
            let moves = Cone::below(dag, [root]).depending_on(dag, moving);
            matches!(root, Atom::Node(node) if moves.contains(&node))
        })
    }

    /// u and v of u/v.
    fn parts<'g>(&'g self, quotient: Expr<'g>) -> (Expr<'g>, Expr<'g>) {
        let number: Expr<'g> = quotient.numerical_factor().into();
        self.factors(quotient).into_iter().fold((number, Expr::ONE), |(u, v), (factor, exponent)| {
            if exponent < 0 { (u, v * factor.powi(-exponent)) } else { (u * factor.powi(exponent), v) }
        })
    }
}

/// A call of a piecewise function.
#[derive(Clone, Copy)]
struct Piece<'g> {
    node: NodeId,
    function: Function,
    args: [Expr<'g>; 3],
}

impl Dag {
    /// Whether a quotient has a divisor that moves through zero.
    fn has_pole(&self, node: NodeId, moves: &FxHashSet<NodeId>) -> bool {
        let product = match self.node(node) {
            Node::Sum { constant, terms } if constant.is_zero() => match self.terms(terms) {
                [(product, _)] => self.node(*product),
                _ => return false,
            },
            other => other,
        };
        let Node::Product { factors } = product else { return false };
        self.factors(factors).iter().any(|&(factor, exponent)| {
            exponent < 0 && exponent % 2 != 0 && moves.contains(&factor) && !self.is_nonnegative(factor)
        })
    }
}
