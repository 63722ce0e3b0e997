//! The surface of the states that satisfy constraints, in numbers.

use pc_expr::{Backend, Evaluator, Expr, ExprError, Inputs, Pattern, Program};

use crate::compiled::fault::{Fault, check_finite};
use crate::compiled::solver::Solver;

/// Newton's method comes near by the square of the distance; from where it does not in so many steps, it does not.
const MOST_STEPS: usize = 50;

/// The last step of a projection is rounding against the coordinates, or against the first step.
const ROUNDING: f64 = 1e-8;

/// What a surface is made of, in expressions of t, x, η and parameters.
#[derive(Debug)]
pub(crate) struct Conditions<'a, 'g> {
    /// f(t, x), those that there are.
    pub(crate) positions: &'a [Expr<'g>],
    /// The index of the constraint of each of these.
    pub(crate) places: Vec<usize>,
    /// g(t, x, η), one a constraint; ḟ = g for those with a position.
    pub(crate) velocities: &'a [Expr<'g>],
    /// b η
    pub(crate) displacements: &'a [Expr<'g>],
    /// The lower triangle of the mass matrix bordered by −C = −∂g/∂η, and its pattern.
    pub(crate) lower: Pattern,
    pub(crate) bordered: &'a [Expr<'g>],
    /// Number of quasi-velocities.
    pub(crate) quasi_velocities: usize,
}

/// The states (x, η) with f(t, x) = 0 and g(t, x, η) = 0.
///
/// A state is moved there by the shortest way in the kinetic metric: first x by δx = b δπ with δπ in the span of
/// M⁻¹ ∂f/∂π, then η likewise.
#[derive(Clone, Debug)]
pub(crate) struct Surface {
    coordinates: usize,
    k: usize,
    positions: Evaluator,
    places: Vec<usize>,
    velocities: Evaluator,
    displacements: Evaluator,
    lower: Pattern,
    bordered: Evaluator,
    entries: Vec<f64>,
    solver: Solver,
    /// A right-hand side, then a solution.
    change: Vec<f64>,
    residual: Vec<f64>,
    /// x, then δπ.
    displaced: Vec<f64>,
    moved: Vec<f64>,
}

impl Surface {
    /// # Errors
    /// As for [`Program::new`].
    pub(crate) fn new<'g>(
        inputs: &Inputs<'g>,
        conditions: Conditions<'_, 'g>,
        graph: &'g pc_expr::Graph,
    ) -> Result<Surface, ExprError> {
        let compiled = |outputs: &[Expr<'g>]| -> Result<Evaluator, ExprError> {
            Ok(Evaluator::new(Program::new(graph, inputs, outputs)?, Backend::Interpreter))
        };
        let (k, m) = (conditions.quasi_velocities, conditions.velocities.len());
        let coordinates = conditions.displacements.len();
        Ok(Surface {
            coordinates,
            k,
            positions: compiled(conditions.positions)?,
            velocities: compiled(conditions.velocities)?,
            displacements: compiled(conditions.displacements)?,
            bordered: compiled(conditions.bordered)?,
            entries: vec![0.0; conditions.lower.len()],
            lower: conditions.lower,
            solver: Solver::new(k + m, m),
            change: vec![0.0; k + m],
            residual: vec![0.0; m],
            displaced: vec![0.0; coordinates + k],
            moved: vec![0.0; coordinates],
            places: conditions.places,
        })
    }

    /// f where a constraint has a position and g where it has none, one number a constraint.
    pub(crate) fn residuals(&mut self, t: f64, y: &[f64], p: &[f64]) -> Vec<f64> {
        let mut residuals = vec![0.0; self.residual.len()];
        self.velocities.eval(t, y, p, &mut residuals);
        let found = &mut self.residual[..self.places.len()];
        self.positions.eval(t, y, p, found);
        for (&place, &value) in self.places.iter().zip(&*found) {
            residuals[place] = value;
        }
        residuals
    }

    /// Moves `y` to the surface.
    ///
    /// # Errors
    /// [`Fault::NoProjection`] if the way leads nowhere, [`Fault::Constraint`] where the surface has an edge.
    pub(crate) fn project(&mut self, t: f64, y: &mut [f64], p: &[f64]) -> Result<(), Fault> {
        self.factorise(t, y, p)?;
        if !self.places.is_empty() {
            self.project_position(t, y, p)?;
        }
        self.project_velocity(t, y, p)
    }

    fn factorise(&mut self, t: f64, y: &[f64], p: &[f64]) -> Result<(), Fault> {
        self.bordered.eval(t, y, p, &mut self.entries);
        check_finite(&self.entries, &self.bordered, (t, y, p))?;
        self.solver.factorise(&self.lower, &self.entries)
    }

    /// Newton's method for f(t, x) = 0; leaves the matrix factorised where it ends.
    fn project_position(&mut self, t: f64, y: &mut [f64], p: &[f64]) -> Result<(), Fault> {
        let n = self.coordinates;
        let (mut first, mut before) = (f64::INFINITY, f64::INFINITY);
        for _ in 0..MOST_STEPS {
            let found = &mut self.residual[..self.places.len()];
            self.positions.eval(t, y, p, found);
            check_finite(found, &self.positions, (t, y, p))?;
            self.change.fill(0.0);
            for (&place, &value) in self.places.iter().zip(&*found) {
                self.change[self.k + place] = value;
            }
            self.solver.solve(&mut self.change);
            // M δπ − Cᵀ μ = 0 and −C δπ = f: δπᵀ M δπ = −μ f
            let multipliers = self.places.iter().map(|&place| self.change[self.k + place]);
            let length = multipliers.zip(&*found).map(|(mu, f)| mu * f).sum::<f64>().abs().sqrt();
            self.displaced[..n].copy_from_slice(&y[..n]);
            self.displaced[n..].copy_from_slice(&self.change[..self.k]);
            self.displacements.eval(t, &self.displaced, p, &mut self.moved);
            if length >= before / 2.0 || length == 0.0 {
                let largest = |values: &[f64]| values.iter().fold(0.0f64, |size, x| size.max(x.abs()));
                let small = largest(&self.moved) <= ROUNDING * largest(&y[..n]) || length <= ROUNDING * first;
                return if small { Ok(()) } else { Err(Fault::NoProjection { unknowns: self.k }) };
            }
            for (x, moved) in y[..n].iter_mut().zip(&self.moved) {
                *x += moved;
            }
            self.factorise(t, y, p)?;
            first = first.min(length);
            before = length;
        }
        Err(Fault::NoProjection { unknowns: self.k })
    }

    /// Newton's method for g(t, x, η) = 0, which comes to its end at once where g is affine in η.
    fn project_velocity(&mut self, t: f64, y: &mut [f64], p: &[f64]) -> Result<(), Fault> {
        let n = self.coordinates;
        let (mut first, mut before) = (f64::INFINITY, f64::INFINITY);
        for _ in 0..MOST_STEPS {
            self.velocities.eval(t, y, p, &mut self.residual);
            check_finite(&self.residual, &self.velocities, (t, y, p))?;
            self.change[..self.k].fill(0.0);
            self.change[self.k..].copy_from_slice(&self.residual);
            self.solver.solve(&mut self.change);
            let along = self.change[self.k..].iter().zip(&self.residual);
            let length = along.map(|(mu, g)| mu * g).sum::<f64>().abs().sqrt();
            if length >= before / 2.0 || length == 0.0 {
                let largest = |values: &[f64]| values.iter().fold(0.0f64, |size, x| size.max(x.abs()));
                let (change, size) = (largest(&self.change[..self.k]), largest(&y[n..]));
                // Where nothing moves, what is left of g is the rounding of numbers that cancel.
                let small = change <= ROUNDING * size || length <= ROUNDING * first || size == 0.0;
                return if small { Ok(()) } else { Err(Fault::NoProjection { unknowns: self.k }) };
            }
            for (eta, change) in y[n..].iter_mut().zip(&self.change) {
                *eta += change;
            }
            self.factorise(t, y, p)?;
            first = first.min(length);
            before = length;
        }
        Err(Fault::NoProjection { unknowns: self.k })
    }
}
