//! Functions with a given gradient.
//!
//! Each product in a component f_i suggests candidates for its integral over z_i; fingerprints find the combination of
//! these candidates whose gradient is the one given, if there is one. The result is proved, however the candidates
//! were chosen.

use crate::graph::expr::Expr;
use crate::graph::function::Function;
use crate::graph::graph::Graph;
use crate::graph::node::{Atom, Node};
use crate::graph::number::Number;

/// The maximum number of products into which one component is multiplied out.
const MOST_PRODUCTS: usize = 64;

/// The maximum number of functions that are combined; combining this many takes some hundredths of a second.
const MOST_FUNCTIONS: usize = 200;

/// The maximum length of a component, measured by its number of operations when written out; this also bounds
/// its depth.
const LONGEST: u32 = 1_000;

/// The greatest power of a sum that is multiplied out.
const MOST_POWER: i32 = 4;

/// A product of powers, without its rational factor.
type Product<'g> = Vec<(Expr<'g>, i32)>;

impl Graph {
    /// F with ∂F/∂z_i = f_i, if the `form` f_i dz_i is exact and F is found: a combination with rational
    /// coefficients of products of powers, sines, cosines, exponentials and logarithms like those in the f_i.
    ///
    /// The result is proved to have this gradient. An exact form may go unrecognised.
    ///
    /// # Panics
    /// If there are not as many components as variables.
    ///
    /// ```
    /// # use pc_expr::Graph;
    /// let graph = Graph::new();
    /// let [x, y, p] = graph.symbols(["x", "y", "p"]);
    /// let form = [p * (p * x).cos() * y + 1.0, (p * x).sin() - 2.0 * y];
    /// assert_eq!(graph.potential(&form, &[x, y]), Some(x + y * (p * x).sin() - y.square()));
    /// assert_eq!(graph.potential(&[y, -x], &[x, y]), None);
    /// ```
    pub fn potential<'g>(&'g self, form: &[Expr<'g>], variables: &[Expr<'g>]) -> Option<Expr<'g>> {
        assert_eq!(form.len(), variables.len(), "a component for each variable");
        if form.iter().any(|f| f.tree_cost() > LONGEST) {
            return None;
        }
        let mut functions: Vec<Expr<'g>> = Vec::new();
        for (&f, &z) in form.iter().zip(variables) {
            for product in self.products(f)? {
                for function in self.integrals(&product, z) {
                    if function.constant().is_none() && !functions.contains(&function) {
                        functions.push(function);
                    }
                }
                if functions.len() > MOST_FUNCTIONS {
                    return None;
                }
            }
        }
        functions.sort_by_key(|function| function.tree_cost()); // simple ones are preferred
        let gradients = functions.iter().map(|&function| self.gradient(function, variables));
        let columns: Vec<Vec<Expr<'g>>> = gradients.chain([form.to_vec()]).collect();
        let last = functions.len();
        let relation = self.linear_relations(&columns).into_iter().find(|c| !c[last].is_zero())?;
        let scale = -relation[last].recip();
        Some(self.dot(relation[..last].iter().map(|&c| Expr::from(c * scale)), functions))
    }

    /// The products whose sum is f, unless they are too many.
    fn products<'g>(&'g self, f: Expr<'g>) -> Option<Vec<Product<'g>>> {
        let Atom::Node(id) = f.atom_in(self) else {
            let constant = |c: Number| vec![rounded(c).collect()];
            return Some(f.constant().filter(|c| !c.is_zero()).map_or_else(Vec::new, constant));
        };
        let expr = |id| self.expr(Atom::Node(id));
        let products = match self.with(|dag| dag.node(id)) {
            Node::Sum { constant, terms } => {
                let terms = self.with(|dag| dag.terms(terms).to_vec());
                let mut products =
                    if constant.is_zero() { Vec::new() } else { vec![rounded(constant).collect()] };
                for (term, q) in terms {
                    let with_factor = |term: Product<'g>| term.into_iter().chain(rounded(q)).collect();
                    products.extend(self.products(expr(term))?.into_iter().map(with_factor));
                }
                products
            }
            Node::Product { factors } => {
                let factors: Vec<_> = self.with(|dag| dag.factors(factors).to_vec());
                let mut products = vec![Vec::new()];
                for (factor, power) in factors {
                    let is_sum = self.with(|dag| matches!(dag.node(factor), Node::Sum { .. }));
                    if is_sum && (1..=MOST_POWER).contains(&power) {
                        let terms = self.products(expr(factor))?;
                        for _ in 0..power {
                            let pairs = |product: &Product<'g>| -> Vec<Product<'g>> {
                                terms.iter().map(|term| [product.as_slice(), term].concat()).collect()
                            };
                            products = products.iter().flat_map(pairs).collect();
                            if products.len() > MOST_PRODUCTS {
                                return None;
                            }
                        }
                    } else {
                        products.iter_mut().for_each(|product| product.push((expr(factor), power)));
                    }
                }
                products
            }
            Node::Constant(_) | Node::Symbol(_) | Node::Call { .. } | Node::Applied { .. } => {
                vec![vec![(f, 1)]]
            }
        };
        (products.len() <= MOST_PRODUCTS).then_some(products)
    }

    /// Candidate functions: the integral of a product with respect to z may be a combination of these.
    fn integrals<'g>(&'g self, product: &Product<'g>, z: Expr<'g>) -> Vec<Expr<'g>> {
        let mut collected: Product<'g> = Vec::new();
        for &(factor, power) in product {
            match collected.iter_mut().find(|(known, _)| *known == factor) {
                Some((_, known)) => *known += power,
                None => collected.push((factor, power)),
            }
        }
        let (moving, fixed): (Product<'g>, Product<'g>) =
            collected.into_iter().partition(|(factor, _)| factor.depends_on(z));
        let fixed = fixed.iter().fold(Expr::ONE, |product, (factor, power)| product * factor.powi(*power));
        let own = moving.iter().find(|(factor, _)| *factor == z).map_or(0, |&(_, power)| power);

        let mut functions = vec![fixed];
        let mut logarithms = if own == -1 { vec![fixed * z.square().log()] } else { Vec::new() };
        let mut angles: Vec<(Function, Expr<'g>)> = Vec::new();
        for &(factor, power) in moving.iter().filter(|(factor, _)| *factor != z) {
            let forms = match self.angle(factor) {
                Some(angle) if angles.contains(&angle) => continue,
                Some(angle) => {
                    angles.push(angle);
                    let powers = |f: Expr<'g>| {
                        moving.iter().find(|(known, _)| *known == f).map_or(0, |&(_, power)| power)
                    };
                    let (sine, cosine) = pair(angle);
                    for function in [sine, cosine] {
                        if powers(function) == -1 {
                            logarithms.push(over(fixed * function.square().log(), angle.1, z));
                        }
                    }
                    let circular = circular(sine, cosine, powers(sine), powers(cosine));
                    circular.into_iter().map(|form| over(form, angle.1, z)).collect()
                }
                None => {
                    if power == -1 {
                        logarithms.push(over(fixed * factor.square().log(), factor, z));
                    }
                    let higher = over(factor.powi(power + 1), factor, z);
                    // s ds = r² dr/2 of a root r = √s, r³ of √s ds
                    let root = factor.powi(power + 2);
                    let exponent = match self.call(factor) {
                        Some((Function::Exp, u)) => over(factor.powi(power), u, z),
                        _ => factor.powi(power),
                    };
                    vec![Expr::ONE, exponent, higher, root]
                }
            };
            functions =
                functions.iter().flat_map(|&known| forms.iter().map(move |&form| known * form)).collect();
        }
        let powers = own.min(0)..=own + 1;
        functions = powers.flat_map(|power| functions.iter().map(move |&f| f * z.powi(power))).collect();
        functions.into_iter().chain(logarithms).collect()
    }

    /// The function of one argument that an expression applies, and its argument.
    fn call<'g>(&'g self, value: Expr<'g>) -> Option<(Function, Expr<'g>)> {
        let Atom::Node(id) = value.atom_in(self) else { return None };
        match self.with(|dag| dag.node(id)) {
            Node::Call { function, args } if function.arity() == 1 => {
                Some((function, self.expr(Atom::Node(args[0]))))
            }
            _ => None,
        }
    }

    /// The argument, with sine for a circular function and hyperbolic sine for a hyperbolic one.
    fn angle<'g>(&'g self, value: Expr<'g>) -> Option<(Function, Expr<'g>)> {
        let (function, angle) = self.call(value)?;
        match function {
            Function::Sin | Function::Cos => Some((Function::Sin, angle)),
            Function::Sinh | Function::Cosh => Some((Function::Sinh, angle)),
            _ => None,
        }
    }
}

/// A factor that is not a rational number.
fn rounded<'g>(c: Number) -> impl Iterator<Item = (Expr<'g>, i32)> {
    (!matches!(c, Number::Rational { .. })).then(|| (Expr::from(c), 1)).into_iter()
}

/// The sine and the cosine of an angle.
fn pair<'g>((sine, angle): (Function, Expr<'g>)) -> (Expr<'g>, Expr<'g>) {
    let cosine = if sine == Function::Sin { Function::Cos } else { Function::Cosh };
    (Expr::apply(sine, &[angle]), Expr::apply(cosine, &[angle]))
}

/// f divided by ∂u/∂z, if the quotient is free of z.
fn over<'g>(f: Expr<'g>, u: Expr<'g>, z: Expr<'g>) -> Expr<'g> {
    let slope = u.derivative(z);
    if slope.is_zero() || slope.depends_on(z) { f } else { f / slope }
}

/// The products s^i' c^j' of the same degree as s^i c^j, or, for quotients, those whose exponents differ from
/// i and j by at most one.
fn circular<'g>(s: Expr<'g>, c: Expr<'g>, i: i32, j: i32) -> Vec<Expr<'g>> {
    if i >= 0 && j >= 0 {
        return (0..=i + j).map(|p| s.powi(p) * c.powi(i + j - p)).collect();
    }
    let near = |e: i32| e - 1..=e + 1;
    near(i).flat_map(|p| near(j).map(move |q| s.powi(p) * c.powi(q))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A function is recovered from its gradient, up to a constant.
    #[test]
    fn gradients_are_integrated() {
        let graph = Graph::new();
        let [x, y, z, r, k] = graph.symbols(["x", "y", "z", "R", "k"]);
        let variables = [x, y, z];
        for f in [
            x + 2.0 * y - z.sin(),
            r * (x + y).square() * z - x.powi(5) * 0.3,
            y * x.square() * (k * x).sin() + z.cos().powi(3),
            (k * x).exp() * (y - r * z).cos() + x * y.exp(),
            (x - r * y) / z + (z * k).sinh() * y,
            (x.square() + y.square()).sqrt() * r + z.square().log(),
            r * x.tan() + (1.0 + z) / (2.0 + y.square()),
            y.cos().square().log() * 3.0 + x.sin().square(),
            z.log() * z + x,
            2f64.sqrt() * x * y + 0.1 * z,
        ] {
            let form = graph.gradient(f, &variables);
            let Some(found) = graph.potential(&form, &variables) else { panic!("{f}") };
            let again = graph.gradient(found, &variables);
            assert!(again.iter().zip(&form).all(|(a, b)| (*a - *b).is_zero()), "{f}: {found}");
        }
    }

    #[test]
    fn forms_that_are_not_exact_have_no_potential() {
        let graph = Graph::new();
        let [x, y, z] = graph.symbols(["x", "y", "z"]);
        for form in [[y, 0.into(), 1.into()], [y.cos(), y.sin(), 0.into()], [x, x * z, x * y]] {
            assert_eq!(graph.potential(&form, &[x, y, z]), None);
        }
        assert_eq!(graph.potential(&[0.into(), 0.into(), 0.into()], &[x, y, z]), Some(0.into()));
    }

    /// A deeply nested form is refused without descending into it.
    #[test]
    fn deeply_nested_forms_are_refused() {
        let graph = Graph::new();
        let [x, y] = graph.symbols(["x", "y"]);
        let nested = |depth: usize| (0..depth).fold(y, |f, _| (f * x + 1.0) * y + 2.0);
        assert!(graph.potential(&[nested(4), y], &[x, y]).is_none());
        assert!(graph.potential(&[nested(100_000), y], &[x, y]).is_none());
    }
}
