//! The principles by which the equations of independent quasi-velocities can be written.

use pc_expr::Graph;
use pc_mech::{Expr, ForceBalance, Maggi, System};

/// The principle by which equations are written.
#[derive(Clone, Debug)]
pub enum Principle<'g> {
    /// Poincaré's equations, as M η̇ = r.
    Poincare,
    /// Maggi's equations Σ_i E_i ∂ẋ_i/∂η_s = 0.
    Maggi(Box<Maggi<'g>>),
    /// Kane's equations F_s + F*_s = 0.
    Kane(Box<ForceBalance<'g>>),
    /// Gibbs–Appell's equations ∂S/∂η̇_s = Q_s.
    GibbsAppell(Box<ForceBalance<'g>>),
}

/// Maggi's equations in the graph of a page.
#[derive(Clone, Debug)]
pub struct MaggiSheet<'p> {
    /// The symbols of Lagrange's expressions, each with its value E_i(t, x, ẋ, ẍ).
    pub expressions: Vec<(Expr<'p>, Expr<'p>)>,
    /// The sums Σ_i E_i ∂ẋ_i/∂η_s, in these symbols, that vanish.
    pub sums: Vec<Expr<'p>>,
}

/// A balance of forces in the graph of a page.
#[derive(Clone, Debug)]
pub struct ForceSheet<'p> {
    /// η̇
    pub accelerations: Vec<Expr<'p>>,
    /// F_s
    pub active: Vec<Expr<'p>>,
    /// −F*_s = ∂S/∂η̇_s
    pub slopes: Vec<Expr<'p>>,
    /// What is printed of inertia.
    pub inertia: InertiaSheet<'p>,
    /// A remark on what counts as a force.
    pub remark: Option<&'static str>,
}

/// What is printed of inertia.
#[derive(Clone, Debug)]
pub enum InertiaSheet<'p> {
    /// Kane's generalised forces of inertia F*_s.
    Forces(Vec<Expr<'p>>),
    /// Gibbs' function S, without its terms without accelerations.
    Gibbs(Expr<'p>),
}

impl<'p> MaggiSheet<'p> {
    pub(crate) fn of<'g>(maggi: &Maggi<'g>, system: &System<'g>, page: &'p Graph) -> MaggiSheet<'p> {
        let set = |list: &[Expr<'g>]| system.graph().typeset(list, page);
        let expressions = shorter(set(&maggi.expressions()), maggi.written(page), page);
        MaggiSheet {
            expressions: set(maggi.symbols()).into_iter().zip(expressions).collect(),
            sums: set(&maggi.sums()),
        }
    }
}

impl<'p> ForceSheet<'p> {
    /// Kane's sheet, or with `gibbs` that of Gibbs and Appell; `system` is the system of the independent quasi-velocities, and
    /// `whole` the system before constraints.
    pub(crate) fn of<'g>(
        balance: &ForceBalance<'g>,
        gibbs: bool,
        (system, whole): (&System<'g>, &System<'g>),
        page: &'p Graph,
    ) -> ForceSheet<'p> {
        let graph = system.graph();
        let set = |list: &[Expr<'g>]| graph.typeset(list, page);
        let written = |list: &[Expr<'g>]| shorter(set(list), balance.written(list, page), page);
        let inertia = match gibbs {
            true => InertiaSheet::Gibbs(set(&[balance.gibbs_function()])[0]),
            false => InertiaSheet::Forces(written(&balance.of_inertia())),
        };
        ForceSheet {
            accelerations: set(balance.accelerations()),
            active: written(balance.active()),
            slopes: written(&balance.slopes()),
            inertia,
            remark: whole.has_no_rest().then_some(NO_REST),
        }
    }
}

const NO_REST: &str = "The velocities of the frame at zero quasi-velocities count among the active forces.";

/// Expressions as sums of products where they are polynomials, unless this makes them much longer.
pub(crate) fn shorter<'p>(
    plain: Vec<Expr<'p>>,
    products: Vec<Option<Expr<'p>>>,
    page: &'p Graph,
) -> Vec<Expr<'p>> {
    let products: Vec<Expr<'p>> =
        products.into_iter().zip(&plain).map(|(product, &plain)| product.unwrap_or(plain)).collect();
    let longest = page.size(&plain) * 3 / 2 + SMALL;
    if page.size(&products) > longest { plain } else { products }
}

/// Expressions with up to this many nodes are multiplied out even if they become longer.
pub(crate) const SMALL: usize = 60;
