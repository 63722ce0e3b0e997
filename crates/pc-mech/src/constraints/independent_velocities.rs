//! Constraints solved for velocities: redundant coordinates.

use pc_algebra::{Elimination, Matrix, Neighbourhood, StructureCoefficients, inverse};
use pc_expr::Expr;

use crate::compiled::elimination::saddle_point::Saddle;
use crate::compiled::failure::EvaluationFailure;
use crate::constraints::multipliers::Multipliers;
use crate::error::{ConstraintError, MechError, shape};
use crate::numeric::least_squares::LeastSquares;
use crate::system::system::System;

/// The least singular value of a well-conditioned matrix, relative to the largest.
const WELL: f64 = 1e-3;

impl<'g> Multipliers<'g> {
    /// The same system in quasi-velocities that are independent, η_D = −C_D⁻¹ (C_I η_I + c_0): its equations (9) are
    /// the equations of motion in redundant coordinates, which are
    ///
    ///   d/dt ∂L/∂ẋ_s − ∂L/∂x_s − b_js ∂L/∂x_j = Q_s   (14)–(16)
    ///
    /// with X_s = ∂/∂x_s + b_js ∂/∂x_j if the η are velocities. The dependent quasi-velocities η_D are those that
    /// the constraints determine best at the values `at` of time, coordinates, quasi-velocities and parameters. The
    /// equations are singular where det C_D = 0, even if the constraints themselves are not. The brackets follow
    /// from those of the system, as described at [`Elimination::structure_coefficients`], whatever the rank of the
    /// frame.
    ///
    /// # Errors
    /// [`ConstraintError::Singular`] if the constraints are dependent there; [`ConstraintError::NotAffine`];
    /// [`AlgebraError::NotClosed`](crate::AlgebraError::NotClosed) if they are not integrable.
    ///
    /// ```
    /// use pc_mech::{Constraint, Graph, System};
    ///
    /// let graph = Graph::new();
    /// let pendulum = System::builder(&graph)
    ///     .coordinates(["x", "y"])
    ///     .lagrangian(|_, x, v| (v[0].square() + v[1].square()) / 2.0 - 10.0 * x[1])
    ///     .build()?;
    /// let [x, y, vx, vy] = graph.symbols(["x", "y", "x'", "y'"]);
    /// let circle = Constraint::new("length", x.square() + y.square() - 1.0);
    /// let below = [(x, 0.6), (y, -0.8), (vx, 0.0), (vy, 0.0)];
    /// let system = pendulum.with_multipliers(&[circle])?.in_independent_velocities(&below)?;
    /// assert_eq!(system.quasi_velocities(), [vx]);
    /// assert_eq!(system.frame().velocities(&[vx]), [vx, -x * vx / y]);
    /// # Ok::<(), pc_mech::MechError>(())
    /// ```
    pub fn in_independent_velocities(&self, at: &[(Expr<'g>, f64)]) -> Result<System<'g>, MechError> {
        let system = self.equations().system();
        let mut near = Neighbourhood { centre: at.to_vec() };
        near.centre.extend(system.parameters().iter().copied());
        let solved = self.solved_for(&self.dependent_at(at)?)?;
        let structure = self.elimination(&solved)?.structure_coefficients(system.structure(), &near)?;
        self.eliminated(&solved, structure)
    }

    /// Solves η_D = −C_D⁻¹ (C_I η_I + c_0): returns the quasi-velocities with the m indices `dependent`, each with its
    /// expression in terms of the k − m others.
    ///
    /// # Errors
    /// [`ConstraintError::NotAffine`] for a constraint that is [nonlinear](crate::Constraint::nonlinear);
    /// [`ConstraintError::Dependent`] if det C_D = 0 everywhere.
    pub fn solved_for(&self, dependent: &[usize]) -> Result<Vec<(Expr<'g>, Expr<'g>)>, MechError> {
        if let Some(constraint) = self.constraints().iter().find(|constraint| constraint.is_nonlinear()) {
            return Err(ConstraintError::NotAffine { constraint: constraint.name().to_owned() }.into());
        }
        let system = self.equations().system();
        let (graph, eta, c) = (system.graph(), system.quasi_velocities(), self.coefficients());
        let square = Matrix::from_fn(c.rows(), dependent.len(), |a, d| c[(a, dependent[d])]);
        let name = || self.constraints().last().map_or_else(String::new, |c| c.name().to_owned());
        let inverse =
            inverse(graph, &square).ok_or_else(|| ConstraintError::Dependent { constraint: name() })?;
        let zeros: Vec<_> = dependent.iter().map(|&d| (eta[d], Expr::ZERO)).collect();
        let without = graph.substitute(self.velocities(), &zeros);
        let solution = |d: usize| -graph.dot(inverse.row(d).iter().copied(), without.iter().copied());
        Ok(dependent.iter().enumerate().map(|(d, &s)| (eta[s], solution(d))).collect())
    }

    /// The quasi-velocities that remain.
    fn free(&self, solved: &[(Expr<'g>, Expr<'g>)]) -> Vec<Expr<'g>> {
        let eta = self.equations().system().quasi_velocities().iter().copied();
        eta.filter(|eta| solved.iter().all(|(known, _)| known != eta)).collect()
    }

    /// The operators of the velocities that the constraints allow.
    fn elimination(&self, solved: &[(Expr<'g>, Expr<'g>)]) -> Result<Elimination<'g>, MechError> {
        let system = self.equations().system();
        let (graph, eta, free) = (system.graph(), system.quasi_velocities(), self.free(solved));
        let dependent: Vec<usize> =
            (0..eta.len()).filter(|&s| solved.iter().any(|(known, _)| *known == eta[s])).collect();
        let value =
            |&s: &usize| solved.iter().find(|(known, _)| *known == eta[s]).map_or(eta[s], |&(_, x)| x);
        let values: Vec<Expr<'g>> = dependent.iter().map(value).collect();
        let zeros: Vec<_> = free.iter().map(|&eta| (eta, Expr::ZERO)).collect();
        let rows: Vec<Vec<Expr<'g>>> = values.iter().map(|&value| graph.gradient(value, &free)).collect();
        let matrix = Matrix::from_fn(rows.len(), free.len(), |d, s| rows[d][s]);
        Ok(system.frame().eliminated(&dependent, matrix, graph.substitute(&values, &zeros))?)
    }

    /// The system with the dependent quasi-velocities [solved for](Multipliers::solved_for) and substituted, and with
    /// these structure coefficients.
    ///
    /// Its equations (9) are the equations of motion if the constraints are integrable and `structure` consists of
    /// the coefficients for the velocities that they allow. If the constraints are not integrable, the terms of the
    /// eliminated momenta are missing, as in (32), and have to be [added](System::with_added_forces) to the forces.
    ///
    /// # Errors
    /// [`ShapeError`](crate::ShapeError) if `structure` is for a different number of quasi-velocities.
    pub fn eliminated(
        &self,
        solved: &[(Expr<'g>, Expr<'g>)],
        structure: StructureCoefficients<'g>,
    ) -> Result<System<'g>, MechError> {
        let system = self.equations().system();
        let (graph, free) = (system.graph(), self.free(solved));
        let frame = self.elimination(solved)?.frame().clone();
        shape("the list of operators of the structure coefficients", structure.operators(), free.len())?;
        let x = frame.coordinates().iter().copied().zip(frame.velocities(&free));
        let rates = free.iter().map(|&eta| (eta, graph.symbol(&format!("{eta}'"))));
        let along: Vec<_> = x.chain(rates).chain(graph.in_time(frame.time())).collect();
        let values: Vec<Expr<'g>> = solved.iter().map(|&(_, value)| value).collect();
        let accelerations = graph.directional(&values, &along);
        let primed = solved.iter().map(|(eta, _)| graph.symbol(&format!("{eta}'")));
        let known: Vec<_> = solved.iter().copied().chain(primed.zip(accelerations)).collect();
        let put = |list: &[Expr<'g>]| graph.substitute(list, &known);

        // Q'_s = Q_s + Q_D ∂η_D/∂η_s
        let forces = put(system.forces());
        let force = |eta: &Expr<'g>| {
            let place = system.quasi_velocities().iter().position(|known| known == eta);
            place.map_or(Expr::ZERO, |s| forces[s])
        };
        let carried: Vec<Vec<Expr<'g>>> = values.iter().map(|&value| graph.gradient(value, &free)).collect();
        let pushed = solved.iter().map(|(eta, _)| force(eta));
        let push = |s: usize| graph.dot(pushed.clone(), carried.iter().map(|row| row[s]));
        let others = System { forces: Vec::new(), ..system.clone() };
        Ok(System {
            forces: free.iter().enumerate().map(|(s, eta)| force(eta) + push(s)).collect(),
            quasi_velocities: free,
            structure,
            frame,
            ..others.map_expressions(put)
        })
    }

    /// The same equations with a preference: the k − m listed quasi-velocities are taken as
    /// [independent](Multipliers::in_independent_velocities) wherever they determine the others well.
    #[must_use]
    pub fn preferring(mut self, independent: &[Expr<'g>]) -> Multipliers<'g> {
        let eta = self.equations().system().quasi_velocities();
        let dependent: Vec<usize> = (0..eta.len()).filter(|&s| !independent.contains(&eta[s])).collect();
        self.dependent = (dependent.len() == self.constraints().len()).then_some(dependent);
        self
    }

    /// Whether C_D, with the rows of C scaled to length one, is far from singular at these values.
    pub(super) fn determines(&self, dependent: &[usize], at: &[(Expr<'g>, f64)]) -> Result<bool, MechError> {
        let (system, c) = (self.equations().system(), self.coefficients());
        let values = system.graph().evaluate(&c.entries(), &[system.parameters(), at].concat())?;
        let row = |a: usize| &values[a * c.columns()..(a + 1) * c.columns()];
        let size = |a: usize| row(a).iter().fold(0.0f64, |size, entry| size.hypot(*entry));
        let square = Matrix::from_fn(c.rows(), dependent.len(), |a, d| row(a)[dependent[d]] / size(a));
        Ok(LeastSquares::of(&square).is_ok_and(|square| square.reciprocal_condition() > WELL))
    }

    /// The reactions λ in terms of (t, x) and independent quasi-velocities, each of which is given with its
    /// acceleration. With the dependent quasi-velocities [solved for](Multipliers::solved_for), the reactions follow
    /// from their rows of M η̇ = r + Cᵀ λ:
    ///
    ///   C_αD λ_α = (M η̇ − r)_D,
    ///
    /// length m.
    ///
    /// # Errors
    /// As for [`solved_for`](Multipliers::solved_for).
    pub fn reactions_of_independent(
        &self,
        accelerations: &[(Expr<'g>, Expr<'g>)],
    ) -> Result<Vec<Expr<'g>>, MechError> {
        let (system, c) = (self.equations().system(), self.coefficients());
        let (graph, eta) = (system.graph(), system.quasi_velocities());
        let is_free = |s: &usize| accelerations.iter().any(|&(free, _)| free == eta[*s]);
        let dependent: Vec<usize> = (0..eta.len()).filter(|s| !is_free(s)).collect();
        let solved = self.solved_for(&dependent)?;
        let put = |list: &[Expr<'g>]| graph.substitute(list, &solved);
        let x = system.frame().coordinates().iter().copied();
        let along: Vec<_> = x
            .zip(put(self.equations().velocities()))
            .chain(accelerations.iter().copied())
            .chain(graph.in_time(system.frame().time()))
            .collect();
        let values: Vec<Expr<'g>> = solved.iter().map(|&(_, value)| value).collect();
        let rates = graph.directional(&values, &along);
        let rate = |s: usize| {
            let of_dependent = || dependent.iter().zip(&rates).find(|(d, _)| **d == s);
            let free = accelerations.iter().find(|&&(free, _)| free == eta[s]).map(|&(_, rate)| rate);
            free.or_else(|| of_dependent().map(|(_, &rate)| rate)).unwrap_or(Expr::ZERO)
        };
        let (mass, right) = (self.equations().mass_matrix(), put(self.equations().right_hand_side()));
        let rests = dependent.iter().map(|&d| {
            let row = put(&mass.row(d));
            graph.dot(row, (0..eta.len()).map(rate)) - right[d]
        });
        let rests: Vec<Expr<'g>> = rests.collect();
        let square = Matrix::from_fn(c.rows(), dependent.len(), |a, d| put(&[c[(a, dependent[d])]])[0]);
        let name = || self.constraints().last().map_or_else(String::new, |c| c.name().to_owned());
        let inverse =
            inverse(graph, &square).ok_or_else(|| ConstraintError::Dependent { constraint: name() })?;
        let reactions: Vec<Expr<'g>> =
            (0..c.rows()).map(|a| graph.dot(inverse.column(a), rests.iter().copied())).collect();
        graph.check(&reactions)?;
        Ok(graph.shorten(&reactions, &system.collecting_order()))
    }

    /// The m indices of the quasi-velocities that the constraints determine best at the values `at` of time,
    /// coordinates and quasi-velocities, in ascending order, or the [preferred](Multipliers::preferring) ones
    /// where they can be solved for; `at` may override values of parameters.
    ///
    /// # Errors
    /// [`ConstraintError::Singular`] if the constraints are dependent there;
    /// [`ExprError::UnboundSymbol`](crate::ExprError::UnboundSymbol) if a value is missing.
    pub fn dependent_at(&self, at: &[(Expr<'g>, f64)]) -> Result<Vec<usize>, MechError> {
        if let Some(dependent) = &self.dependent
            && self.determines(dependent, at)?
        {
            return Ok(dependent.clone());
        }
        let system = self.equations().system();
        let (graph, k, m) = (system.graph(), system.quasi_velocities().len(), self.constraints().len());
        let (lower, entries) = self.first_order().lower_triangle();
        let values = graph.evaluate(&entries, &[system.parameters(), at].concat())?;
        let mut saddle = Saddle::of_rank(k, m, m);
        saddle.eliminate(&lower, &values).map_err(|failure| {
            let place = match failure {
                EvaluationFailure::Constraint { index } => index - k,
                _ => 0,
            };
            let value = |symbol: Expr<'g>| at.iter().find(|(known, _)| *known == symbol);
            let state = system.state();
            ConstraintError::Singular {
                constraint: self.constraints()[place].name().to_owned(),
                t: value(system.frame().time()).map_or(f64::NAN, |&(_, t)| t),
                state: state.into_iter().filter_map(|x| Some((x.to_string(), value(x)?.1))).collect(),
            }
        })?;
        let mut dependent = saddle.dependent().to_vec();
        dependent.sort_unstable();
        Ok(dependent)
    }
}
