//! Undetermined functions in expressions: built, replaced by values, and replaced by stand-ins.

use crate::graph::dag::Dag;
use crate::graph::expr::Expr;
use crate::graph::graph::Graph;
use crate::graph::node::{Atom, Candidate, Node, NodeId};
use crate::graph::number::Number;
use crate::graph::stand_in::StandIn;
use crate::graph::subgraph::Cone;
use crate::graph::undetermined::{MOST_ARGUMENTS, Undetermined};

impl Dag {
    /// f(x…) of an undetermined function of this graph.
    pub(crate) fn applied(&mut self, function: Undetermined, args: &[Atom]) -> Atom {
        if args.iter().any(|arg| matches!(arg, Atom::Constant(c) if !c.is_finite())) {
            return Atom::Constant(Number::UNDEFINED);
        }
        let mut ids = [NodeId::NONE; MOST_ARGUMENTS];
        for (id, &arg) in ids.iter_mut().zip(args) {
            *id = self.argument(arg);
        }
        self.admit(&Candidate::Applied(function, ids))
    }

    /// f(x…) of a function of another graph.
    pub(crate) fn applied_as(&mut self, other: &Dag, function: Undetermined, args: &[Atom]) -> Atom {
        let name = self.function(other.function_name(function));
        self.applied(function.with_name(name), args)
    }
}

impl Graph {
    /// An undetermined function of one to three arguments, f(x…): any smooth function of that name.
    ///
    /// Whatever the graph finds equal is equal for every such function. Numbers are computed with a
    /// [stand-in](StandIn).
    ///
    /// ```
    /// # use pc_expr::Graph;
    /// let graph = Graph::new();
    /// let [x, y] = graph.symbols(["x", "y"]);
    /// let r = (x.square() + y.square()).sqrt();
    /// let potential = graph.undetermined("V", &[r]);
    /// // x ∂V/∂y − y ∂V/∂x = 0 for every V(r)
    /// let moment = x * potential.derivative(y) - y * potential.derivative(x);
    /// assert!(moment.is_zero());
    /// assert_eq!(graph.undetermined("V", &[x]).derivative(x).to_string(), "V'(x)");
    /// let field = graph.undetermined("A", &[x, y]);
    /// assert_eq!(field.derivative(y).derivative(x), field.derivative(x).derivative(y));
    /// assert_eq!(field.derivative(y).to_string(), "A_,y(x, y)");
    /// ```
    ///
    /// # Panics
    /// If there are no arguments, or more than three.
    pub fn undetermined<'g>(&'g self, name: &str, args: &[Expr<'g>]) -> Expr<'g> {
        self.applied(name, &[0; MOST_ARGUMENTS][..args.len().min(MOST_ARGUMENTS)], args)
    }

    /// The undetermined function, differentiated as often with respect to each argument as `orders` says.
    pub(crate) fn applied<'g>(&'g self, name: &str, orders: &[u8], args: &[Expr<'g>]) -> Expr<'g> {
        assert!((1..=MOST_ARGUMENTS).contains(&args.len()), "one to three arguments");
        let args: Vec<Atom> = args.iter().map(|arg| arg.atom_in(self)).collect();
        self.build(|dag| {
            let function = Undetermined::new(dag.function(name), orders);
            dag.applied(function, &args)
        })
    }

    /// The names of the undetermined functions in the expressions, in the order of their first use.
    ///
    /// ```
    /// # use pc_expr::Graph;
    /// let graph = Graph::new();
    /// let x = graph.symbol("x");
    /// let force = -graph.undetermined("V", &[x]).derivative(x);
    /// assert_eq!(graph.undetermined_in(&[force, x]), ["V"]);
    /// ```
    pub fn undetermined_in(&self, expressions: &[Expr<'_>]) -> Vec<String> {
        let roots: Vec<Atom> = expressions.iter().map(|expression| expression.atom()).collect();
        self.with(|dag| {
            let mut names: Vec<String> = Vec::new();
            if !dag.has_functions() {
                return names;
            }
            for node in Cone::below(dag, roots).order {
                if let Node::Applied { function, .. } = dag.node(node) {
                    let name = dag.function_name(function);
                    if names.iter().all(|known| known != name) {
                        names.push(name.to_owned());
                    }
                }
            }
            names
        })
    }

    /// The expressions with an undetermined function replaced by a value, its derivatives by those of the value,
    /// which is an expression in the symbols `arguments`.
    ///
    /// ```
    /// # use pc_expr::Graph;
    /// let graph = Graph::new();
    /// let [r, s, k] = graph.symbols(["r", "s", "k"]);
    /// let force = -graph.undetermined("V", &[r]).derivative(r);
    /// assert_eq!(graph.with_value_of("V", &[s], -k / s, &[force]), [-k / r.square()]);
    /// ```
    ///
    /// # Panics
    /// If one of `arguments` is not a symbol, or an expression calls the function with another number of
    /// arguments.
    pub fn with_value_of<'g>(
        &'g self,
        name: &str,
        arguments: &[Expr<'g>],
        value: Expr<'g>,
        outputs: &[Expr<'g>],
    ) -> Vec<Expr<'g>> {
        self.with_applied(outputs, |function, orders, args| {
            if function != name {
                return None;
            }
            assert_eq!(args.len(), arguments.len(), "the number of arguments");
            let derivative = arguments.iter().zip(orders).fold(value, |value, (&argument, &order)| {
                (0..order).fold(value, |value, _| value.derivative(argument))
            });
            let put: Vec<_> = arguments.iter().copied().zip(args.iter().copied()).collect();
            Some(self.substitute(&[derivative], &put)[0])
        })
    }

    /// The expressions with each undetermined function replaced by its [stand-in](StandIn).
    pub(crate) fn with_stand_ins<'g>(&'g self, outputs: &[Expr<'g>]) -> Vec<Expr<'g>> {
        self.with_applied(outputs, |name, orders, args| {
            Some(StandIn::new(name, args.len()).value(orders, args))
        })
    }

    /// The expressions with undetermined functions replaced as `value` says, from the name, the orders of
    /// differentiation and the arguments.
    fn with_applied<'g>(
        &'g self,
        outputs: &[Expr<'g>],
        value: impl Fn(&str, &[u8], &[Expr<'g>]) -> Option<Expr<'g>>,
    ) -> Vec<Expr<'g>> {
        if self.undetermined_in(outputs).is_empty() {
            return outputs.to_vec();
        }
        let roots: Vec<Atom> = outputs.iter().map(|output| output.atom_in(self)).collect();
        let order = self.with(|dag| Cone::below(dag, roots.iter().copied()).order);
        let mut known: Vec<(NodeId, Atom)> = Vec::new();
        for node in order {
            let applied = self.with(|dag| {
                let Node::Applied { function, args } = dag.node(node) else { return None };
                let args: Vec<Atom> =
                    function.args(&args).iter().map(|&arg| dag.constant_of(Atom::Node(arg))).collect();
                Some((dag.function_name(function).to_owned(), function, dag.substitute(&args, &known)))
            });
            let Some((name, function, args)) = applied else { continue };
            let args: Vec<Expr<'g>> = args.into_iter().map(|arg| self.expr(arg)).collect();
            if let Some(value) = value(&name, function.orders(), &args) {
                known.push((node, value.atom()));
            }
        }
        self.build_all(|dag| dag.substitute(&roots, &known))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Style;

    #[test]
    fn derivatives_follow_the_chain_rule() {
        let graph = Graph::new();
        let [x, y] = graph.symbols(["x", "y"]);
        let v = |r| graph.undetermined("V", &[r]);
        let second = v(x * y).derivative(x).derivative(y);
        assert_eq!(second.to_string(), "x*y*V''(x*y) + V'(x*y)");
        let fourth = (0..4).fold(v(x), |f, _| f.derivative(x));
        assert_eq!(fourth.to_string(), "V^(4)(x)");
        let field = graph.undetermined("A", &[x + y, y]);
        assert_eq!(field.derivative(y).to_string(), "A_,1(x + y, y) + A_,y(x + y, y)");
    }

    #[test]
    fn each_style_has_its_signs_of_derivatives() {
        let graph = Graph::new();
        let [r, x, y] = graph.symbols(["r", "x", "y"]);
        let slope = graph.undetermined("V", &[r]).derivative(r);
        assert_eq!(slope.display(Style::Latex), r"V'\left(r\right)");
        assert_eq!(slope.derivative(r).display(Style::Book), "V''(r)");
        let field = graph.undetermined("A", &[x, y]).derivative(x).derivative(y);
        assert_eq!(field.display(Style::Latex), r"A_{,x,y}\left(x, y\right)");
        assert!(slope.display(Style::MathMl).starts_with("<msup><mi>V</mi><mo>′</mo></msup>"));
    }

    /// What holds for every function is found; what holds for some is not.
    #[test]
    fn only_what_holds_for_every_function_is_equal() {
        let graph = Graph::new();
        let [x, y, c] = graph.symbols(["x", "y", "c"]);
        let f = |u| graph.undetermined("f", &[u]);
        let wave = f(x - c * y);
        assert!((wave.derivative(y) + c * wave.derivative(x)).is_zero());
        assert_eq!(f((x + y).square()), f(x * x + 2.0 * x * y + y * y));
        assert!(!(f(x + y) - f(x) - f(y)).is_zero());
        assert!(!(f(x) - f(-x)).is_zero() && !(f(x) + f(-x)).is_zero());
        assert_ne!(f(x), graph.undetermined("g", &[x]));
    }

    /// The stand-in of the derivative is the derivative of the stand-in, as a difference quotient shows.
    #[test]
    fn numbers_are_those_of_one_smooth_function() {
        let graph = Graph::new();
        let [x, y] = graph.symbols(["x", "y"]);
        let field = graph.undetermined("A", &[x, y]);
        let at = |f, x_at: f64| graph.evaluate(&[f], &[(x, x_at), (y, 0.3)]).unwrap()[0];
        let h = 1e-4;
        for f in [field, field.derivative(y), field.derivative(x).derivative(x)] {
            let quotient = (at(f, 0.7 + h) - at(f, 0.7 - h)) / (2.0 * h);
            assert!((quotient - at(f.derivative(x), 0.7)).abs() < 1e-7);
            assert!(
                (graph.with_stand_ins(&[f])[0].derivative(x) - graph.with_stand_ins(&[f.derivative(x)])[0])
                    .constant()
                    .is_none_or(|difference| difference.to_f64().abs() < 1e-12)
            );
        }
    }

    #[test]
    fn other_graphs_take_the_functions_over() {
        let (graph, other) = (Graph::new(), Graph::new());
        let x = graph.symbol("x");
        other.undetermined("W", &[other.symbol("y")]); // another index
        let sum = graph.undetermined("V", &[x]).derivative(x) + graph.undetermined("V", &[Expr::ZERO]);
        assert_eq!(graph.transcribe(&[sum], &other)[0].to_string(), sum.to_string());
        let moved = graph.substitute(&[sum], &[(x, x.square())])[0];
        assert!(moved.to_string().contains("V'(x^2)"), "{moved}");
    }
}
