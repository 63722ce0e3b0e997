//! Expressions written without the symbols that they do not depend on.
//!
//! A symbol that cancels is replaced by a number that leaves the value unchanged, as the fingerprint shows.
//! If constants are rounded there may be no such number; then the derivative decides: it must not exceed its
//! `rounding` error.

use std::collections::HashSet;

use rustc_hash::FxHashMap;

use crate::graph::dag::Dag;
use crate::graph::evaluate::Scalar;
use crate::graph::expr::Expr;
use crate::graph::function::Function;
use crate::graph::graph::Graph;
use crate::graph::node::{Atom, Node, NodeId};
use crate::graph::number::Number;
use crate::graph::places::SymbolPlaces;
use crate::graph::subgraph::Cone;

/// A number at which no divisor is likely to vanish.
const ODD: Number = Number::Rational { num: 355, den: 452 };

impl Graph {
    /// e written without the symbols and angles on which it does not depend: they are replaced by regular
    /// values, `variables` by 0 if that is regular.
    pub(super) fn forget<'g>(&'g self, e: Expr<'g>, variables: &SymbolPlaces) -> Expr<'g> {
        let mut short = e;
        for z in self.repeated_symbols(e) {
            if self.symbols_of(&[short]).contains(&z) && !short.depends_on(z) {
                short = match variables.contains(z) {
                    true => self.at_zero(short, z),
                    false => self.at_regular_point(short, z),
                };
            }
        }
        for angle in self.composite_angles(short) {
            short = self.at_regular_angle(short, angle);
        }
        short
    }

    /// e with z = 0, if that does not change its value; e itself otherwise.
    fn at_zero<'g>(&'g self, e: Expr<'g>, z: Expr<'g>) -> Expr<'g> {
        let form = self.at(e, z, Number::ZERO);
        if !form.is_undefined() && self.is_same_value(form, e) { form } else { e }
    }

    /// e with sin z and cos z replaced by a point of the circle, and z by a number, that leave the value
    /// unchanged; e itself if there are none. The first point that adds no new divisor is taken, or else the
    /// first point.
    fn at_regular_point<'g>(&'g self, e: Expr<'g>, z: Expr<'g>) -> Expr<'g> {
        self.most_regular(e, self.forms_without(e, z, true))
    }

    /// e with only sin z and cos z replaced by a point of the circle, chosen in the same way.
    fn at_regular_angle<'g>(&'g self, e: Expr<'g>, z: Expr<'g>) -> Expr<'g> {
        self.most_regular(e, self.forms_without(e, z, false))
    }

    /// The first of the forms of e without a new divisor, else the first form, else e.
    fn most_regular<'g>(&'g self, e: Expr<'g>, forms: impl Iterator<Item = Expr<'g>>) -> Expr<'g> {
        let mut forms = forms.peekable();
        let first = forms.peek().copied();
        forms.find(|&form| self.is_as_regular(form, e)).or(first).unwrap_or(e)
    }

    /// For an e that does not depend on the symbol z, an equal expression written without z. Any new divisor
    /// in it vanishes only at exceptional points.
    pub(crate) fn without_symbol<'g>(&'g self, e: Expr<'g>, z: Expr<'g>) -> Expr<'g> {
        self.equal_form_without(e, z).or_else(|| self.rounded_form_without(e, z)).unwrap_or(e)
    }

    /// e written without the symbol z, if e does not depend on z, either exactly or up to the rounding of its
    /// constants; otherwise e itself.
    fn without_idle_symbol<'g>(&'g self, e: Expr<'g>, z: Expr<'g>) -> Expr<'g> {
        // With jumps the slope says nothing: that of atan(tan z) − z is zero.
        let jumps = || self.symbols_of(&self.seams(&[e])).contains(&z);
        let is_idle = || !jumps() && self.is_rounding(e.derivative(z));
        let rounded = || is_idle().then(|| self.rounded_form_without(e, z)).flatten();
        self.equal_form_without(e, z).or_else(rounded).unwrap_or(e)
    }

    /// A form without z that has the fingerprint of e.
    fn equal_form_without<'g>(&'g self, e: Expr<'g>, z: Expr<'g>) -> Option<Expr<'g>> {
        let forms = self.forms_without(e, z, true).filter(|&form| self.is_without(form, z));
        self.regular_or_last(e, forms)
    }

    /// A form without z, if e does not depend on it. If constants are rounded, each form rounds them anew,
    /// so that none has the fingerprint of e. At z = 0 the cancelling terms vanish.
    fn rounded_form_without<'g>(&'g self, e: Expr<'g>, z: Expr<'g>) -> Option<Expr<'g>> {
        let forms = [Number::ZERO, Number::ONE, ODD].into_iter().map(|value| self.at(e, z, value));
        self.regular_or_last(e, forms.filter(|&form| self.is_without(form, z)))
    }

    /// The first of the forms of e without a new divisor, else the last form, which is the most irregular.
    fn regular_or_last<'g>(&'g self, e: Expr<'g>, forms: impl Iterator<Item = Expr<'g>>) -> Option<Expr<'g>> {
        let mut last = None;
        for form in forms {
            last = Some(form);
            if self.is_as_regular(form, e) {
                break;
            }
        }
        last
    }

    /// Whether a form has values, and does not contain the symbol z.
    fn is_without<'g>(&'g self, form: Expr<'g>, z: Expr<'g>) -> bool {
        self.has_values(form) && !self.symbols_of(&[form]).contains(&z)
    }

    /// Whether the calls with numbers as arguments in a form have values: exp(z), written at z = 10⁶, has
    /// none.
    fn has_values<'g>(&'g self, form: Expr<'g>) -> bool {
        let Atom::Node(root) = form.atom_in(self) else { return !form.is_undefined() };
        self.with(|dag| {
            let number = |&arg: &NodeId| match dag.node(arg) {
                Node::Constant(c) => Some(c.to_f64()),
                _ => None,
            };
            Cone::below(dag, [Atom::Node(root)]).order.iter().all(|&node| match dag.node(node) {
                Node::Call { function, args } => {
                    let args: Option<Vec<f64>> = Dag::args(function, &args).iter().map(number).collect();
                    args.is_none_or(|args| f64::call(function, &args).is_normal())
                }
                _ => true,
            })
        })
    }

    /// `outputs` written without the symbols outside `known` on which they do not depend. A symbol that
    /// cancels may still appear if a result has the value of an older and cheaper expression that contains
    /// it. If constants are rounded, a symbol counts as cancelling if the derivative with respect to it is no
    /// more than [rounding error](crate::Weighed::rest).
    ///
    /// ```
    /// # use pc_expr::Graph;
    /// let graph = Graph::new();
    /// let [a, b, z] = graph.symbols(["a", "b", "z"]);
    /// let written = graph.written_in(&[a * b, a + z], &[a, b]);
    /// assert_eq!(written, [a * b, a + z]); // z is needed
    /// ```
    pub fn written_in<'g>(&'g self, outputs: &[Expr<'g>], known: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let known: HashSet<String> = known.iter().filter_map(|symbol| symbol.symbol_name()).collect();
        let is_foreign = |symbol: &Expr<'g>| symbol.symbol_name().is_none_or(|name| !known.contains(&name));
        let foreign = |list: &[Expr<'g>]| -> Vec<Expr<'g>> {
            self.symbols_of(list).into_iter().filter(is_foreign).collect()
        };
        if foreign(outputs).is_empty() {
            return outputs.to_vec();
        }
        let without = |e, z| self.without_idle_symbol(e, z);
        outputs.iter().map(|&e| foreign(&[e]).into_iter().fold(e, without)).collect()
    }

    /// The forms of e at points of z, from simple to irregular ones, that leave its value unchanged.
    fn forms_without<'g>(
        &'g self,
        e: Expr<'g>,
        z: Expr<'g>,
        whole: bool,
    ) -> impl Iterator<Item = Expr<'g>> + 'g {
        // A form with a vanishing denominator or another value is skipped, and the next point is tried.
        let oblique = [Number::ratio(3, 5), Number::ratio(4, 5)];
        [
            (Number::ZERO, [Number::ZERO, Number::ONE]),
            (Number::ZERO, [Number::ONE, Number::ZERO]),
            (Number::ZERO, oblique),
            (Number::ONE, oblique),
            (ODD, [Number::ratio(696, 985), Number::ratio(697, 985)]),
        ]
        .into_iter()
        .map(move |(value, circle)| self.at_point(e, z, whole.then_some(value), circle))
        .filter(move |&form| self.is_same_value(form, e) && self.has_values(form))
    }

    /// The composite angles, such as Ω t in sin Ω t and cos Ω t, of which e contains both the sine and the
    /// cosine.
    fn composite_angles<'g>(&'g self, e: Expr<'g>) -> Vec<Expr<'g>> {
        let Atom::Node(root) = e.atom_in(self) else { return Vec::new() };
        let angles: Vec<NodeId> = self.with(|dag| {
            let cone = Cone::below(dag, [Atom::Node(root)]);
            let (mut sines, mut cosines) = (Vec::new(), Vec::new());
            for &node in &cone.order {
                if let Node::Call { function, args } = dag.node(node)
                    && !matches!(dag.node(args[0]), Node::Symbol(_))
                {
                    match function {
                        Function::Sin => sines.push(args[0]),
                        Function::Cos => cosines.push(args[0]),
                        _ => {}
                    }
                }
            }
            sines.retain(|angle| cosines.contains(angle));
            sines
        });
        angles.into_iter().map(|node| self.expr(Atom::Node(node))).collect()
    }

    /// The symbols that occur more than once when e is written out: only these can cancel.
    fn repeated_symbols<'g>(&'g self, e: Expr<'g>) -> Vec<Expr<'g>> {
        let Atom::Node(root) = e.atom_in(self) else { return Vec::new() };
        let repeated: Vec<NodeId> = self.with(|dag| {
            let cone = Cone::below(dag, [Atom::Node(root)]);
            let mut occurrences: FxHashMap<NodeId, u32> = FxHashMap::default();
            occurrences.insert(root, 1);
            for &node in cone.order.iter().rev() {
                let above = occurrences[&node];
                dag.for_each_child(node, |child| {
                    let count = occurrences.entry(child).or_insert(0);
                    *count = count.saturating_add(above);
                });
            }
            let is_repeated =
                |node: &NodeId| matches!(dag.node(*node), Node::Symbol(_)) && occurrences[node] > 1;
            cone.order.iter().copied().filter(is_repeated).collect()
        });
        repeated.into_iter().map(|node| self.expr(Atom::Node(node))).collect()
    }

    /// e with sin z and cos z replaced as given, and with z itself replaced if there is a `value`.
    fn at_point<'g>(
        &'g self,
        e: Expr<'g>,
        z: Expr<'g>,
        value: Option<Number>,
        [sin, cos]: [Number; 2],
    ) -> Expr<'g> {
        let Atom::Node(angle) = z.atom_in(self) else { return e };
        let mut replacements: Vec<(NodeId, Atom)> =
            value.map(|value| (angle, Atom::Constant(value))).into_iter().collect();
        for (function, value) in [(Function::Sin, sin), (Function::Cos, cos)] {
            if let Some(node) = self.with(|dag| call_node(dag, function, angle)) {
                replacements.push((node, Atom::Constant(value)));
            }
        }
        self.trial(e, &replacements)
    }

    /// e at this value of the symbol z.
    fn at<'g>(&'g self, e: Expr<'g>, z: Expr<'g>, value: Number) -> Expr<'g> {
        self.trial(e, &[(z.symbol_in(self), Atom::Constant(value))])
    }

    /// e with nodes replaced; a division by zero in the process is not reported.
    fn trial<'g>(&'g self, e: Expr<'g>, replacements: &[(NodeId, Atom)]) -> Expr<'g> {
        let output = e.atom_in(self);
        self.build(|dag| {
            let divisions = dag.zero_divisions().len();
            let value = dag.substitute(&[output], replacements)[0];
            dag.forget_zero_divisions(divisions);
            value
        })
    }

    /// Whether the divisors of the first expression vanish only where the divisors of the second do, judged
    /// by the factors of both.
    ///
    /// ```
    /// # use pc_expr::Graph;
    /// let graph = Graph::new();
    /// let [x, y] = graph.symbols(["x", "y"]);
    /// assert!(graph.is_as_regular((x * y) / y, x) && !graph.is_as_regular(y / x, x));
    /// ```
    pub fn is_as_regular<'g>(&'g self, some: Expr<'g>, other: Expr<'g>) -> bool {
        let (some, other) = (some.atom_in(self), other.atom_in(self));
        self.with(|dag| dag.is_as_regular(some, other))
    }

    /// Whether a form has the same fingerprint and the same numerical values as e.
    fn is_same_value<'g>(&'g self, form: Expr<'g>, e: Expr<'g>) -> bool {
        (form - e).is_zero() && self.has_numbers_of(form, e)
    }
}

fn call_node(dag: &mut Dag, function: Function, angle: NodeId) -> Option<NodeId> {
    match dag.call(function, &[Atom::Node(angle)]) {
        Atom::Node(node) => Some(node),
        Atom::Constant(_) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn functions_of_numbers_out_of_range_have_no_values() {
        let graph = Graph::new();
        let x = graph.symbol("x");
        let steep = (1e6 * x).exp() + x.square();
        let at = |value: i32| graph.at(steep, x, Number::integer(value));
        assert!(graph.has_values(steep) && graph.has_values(at(0)) && !graph.has_values(at(1)));
    }
}
