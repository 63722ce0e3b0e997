//! The Coriolis matrix, compiled.

use pc_expr::{Backend, Evaluator, Expr, Inputs, Program};
use serde::{Deserialize, Serialize};

use crate::compiled::elimination::columns::Storage;
use crate::compiled::elimination::products::Products;
use crate::compiled::failure::check_finite;
use crate::compiled::point::Point;
use crate::equations::poincare::Equations;
use crate::error::MechError;
use crate::system::system::System;
use crate::tree::spatial::ZERO;
use crate::tree::system::TreeSystem;

/// The matrix C of [`Equations::coriolis_matrix`] as a function of t and the state y = (x, η, z).
///
/// For a large tree of bodies, its products with unit vectors v are found from body to body, eight at a time: C v is half
/// of what the forces of inertia M η̇ + C η change when η changes by v and η̇ by c(η) v.
///
/// ```
/// # use pc_mech::{Graph, System};
/// // A particle in polar coordinates.
/// let graph = Graph::new();
/// let particle = System::builder(&graph)
///     .coordinates(["r", "φ"])
///     .kinetic(|_, x, v| (v[0].square() + (x[0] * v[1]).square()) / 2.0)
///     .build()?;
/// let mut coriolis = particle.poincare()?.coriolis_of_motion()?;
/// let mut entries = [0.0; 4];
/// coriolis.eval(0.0, &[2.0, 0.0, 3.0, 5.0], &mut entries)?;
/// assert_eq!(entries, [0.0, 10.0, -10.0, 6.0]); // −r φ' in the first row
/// # Ok::<(), pc_mech::MechError>(())
/// ```
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct CoriolisMatrix {
    entries: Entries,
    names: Vec<String>,
    quasi_velocities: Vec<String>,
    parameters: Vec<f64>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
enum Entries {
    /// Column by column.
    Whole(Evaluator),
    /// The columns as products.
    FromBodyToBody(Products),
}

impl Equations<'_> {
    /// The [Coriolis matrix](Equations::coriolis_matrix), compiled.
    ///
    /// # Errors
    /// As for [`coriolis_matrix`](Equations::coriolis_matrix);
    /// [`ExprError::UnboundSymbol`](crate::ExprError::UnboundSymbol) for a symbol that is neither state nor declared parameter.
    pub fn coriolis_of_motion(&self) -> Result<CoriolisMatrix, MechError> {
        let system = self.system();
        let entries = match system.tree.as_ref().filter(|tree| tree.is_large()) {
            None => {
                let matrix = self.coriolis_matrix()?;
                let columns: Vec<Expr<'_>> = (0..matrix.columns()).flat_map(|m| matrix.column(m)).collect();
                let program = Program::new(system.graph(), &system.inputs(), &columns)?;
                Entries::Whole(Evaluator::new(program, Backend::default()))
            }
            Some(_) => {
                let graph = system.graph().page(system.graph().folding());
                Entries::FromBodyToBody(system.in_graph(&graph).coriolis_products()?)
            }
        };
        Ok(CoriolisMatrix {
            entries,
            names: system.state().iter().map(Expr::to_string).collect(),
            quasi_velocities: system.quasi_velocities().iter().map(Expr::to_string).collect(),
            parameters: system.run_time_inputs().into_iter().map(|(_, value)| value).collect(),
        })
    }
}

impl<'g> System<'g> {
    /// The inputs of functions of the state: t, y and what changes at run time.
    pub(crate) fn inputs(&self) -> Inputs<'g> {
        let parameters = self.run_time_inputs().into_iter().map(|(symbol, _)| symbol).collect();
        Inputs { time: Some(self.frame().time()), state: self.state(), parameters }
    }

    /// C v for a tree without weight and other forces, whose equations are M η̇ + C η = 0.
    fn coriolis_products(&self) -> Result<Products, MechError> {
        let (graph, eta, accelerations) = (self.graph(), &self.quasi_velocities, self.accelerations());
        let zeros = vec![Expr::ZERO; eta.len()];
        let inertia = match &self.tree {
            None => Vec::new(), // the system has one
            Some(tree) => {
                let moving = TreeSystem { gravity: ZERO, others: Expr::ZERO, ..(**tree).clone() };
                let dynamics = moving.dynamics(self.frame(), &zeros);
                moving.in_order(&dynamics.balance(&moving.by_link(&accelerations)))
            }
        };
        let v = self.poincare()?.new_symbols("δ", &accelerations);
        let mut turned = vec![Vec::new(); eta.len()];
        for (r, m, l, c) in self.structure.nonzero().filter(|&(r, ..)| r > 0) {
            turned[l - 1].extend([c * eta[r - 1] * v[m - 1], -(c * eta[m - 1] * v[r - 1])]);
        }
        // Their balance is what is missing: −(M η̇ + C η).
        let half = |x: Expr<'g>| -x / 2.0;
        let along_eta = eta.iter().copied().zip(v.iter().map(|&v| half(v)));
        let along_rates =
            accelerations.iter().copied().zip(turned.into_iter().map(|all| half(graph.sum(all))));
        let along: Vec<_> = along_eta.chain(along_rates).collect();
        let products = graph.directional(&inertia, &along);
        Ok(Products::new(graph, &self.inputs(), (&accelerations, &zeros), (&v, &products))?)
    }
}

impl CoriolisMatrix {
    /// k, the number of quasi-velocities.
    pub fn len(&self) -> usize {
        self.quasi_velocities.len()
    }

    /// Whether nothing moves.
    pub fn is_empty(&self) -> bool {
        self.quasi_velocities.is_empty()
    }

    /// The values of the parameters, which may be changed.
    pub fn parameters_mut(&mut self) -> &mut [f64] {
        &mut self.parameters
    }

    /// Writes C at (t, y), k × k, column by column: C_sm at s + k m.
    ///
    /// # Errors
    /// [`MechError::Expr`] where a value is not finite.
    ///
    /// # Panics
    /// If a length is wrong.
    pub fn eval(&mut self, t: f64, y: &[f64], entries: &mut [f64]) -> Result<(), MechError> {
        assert_eq!((y.len(), entries.len()), (self.names.len(), self.len().pow(2)), "lengths of y and of C");
        let at = Point { t, y, p: &self.parameters };
        let outcome = match &mut self.entries {
            Entries::Whole(evaluator) => {
                evaluator.eval(t, y, &self.parameters, entries);
                check_finite(entries, evaluator, at)
            }
            Entries::FromBodyToBody(products) => products.eval(at, entries, Storage::Dense),
        };
        outcome.map_err(|failure| failure.at(&self.quasi_velocities, t, &self.names, y))
    }
}
