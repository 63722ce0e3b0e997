//! Constraints solved for velocities: redundant coordinates.

use pc_algebra::{Frame, Matrix, Neighbourhood, inverse};
use pc_expr::Expr;

use crate::compiled::fault::Fault;
use crate::compiled::saddle::Saddle;
use crate::error::MechError;
use crate::multipliers::Multipliers;
use crate::system::System;

impl<'g> Multipliers<'g> {
    /// The same system in quasi-velocities that are independent, η_D = −C_D⁻¹ (C_I η_I + c_0): its equations (9) are
    /// those of motion in redundant coordinates, which are
    ///
    ///   d/dt ∂L/∂ẋ_s − ∂L/∂x_s − b_js ∂L/∂x_j = Q_s   (14)–(16)
    ///
    /// with X_s = ∂/∂x_s + b_js ∂/∂x_j if the η are velocities. The dependent ones are those that the constraints
    /// determine best at the values `at` of time, coordinates, quasi-velocities and parameters. The equations are
    /// singular where det C_D = 0, where the constraints themselves are not.
    ///
    /// # Errors
    /// [`MechError::SingularConstraint`] if the constraints are dependent there;
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
        let (graph, eta) = (system.graph(), system.quasi_velocities());
        let mut near = Neighbourhood { centre: at.to_vec() };
        near.centre.extend(system.parameters().iter().copied());
        let dependent = self.dependent_at(at)?;
        let independent: Vec<usize> = (0..eta.len()).filter(|s| !dependent.contains(s)).collect();

        let c = self.coefficients();
        let m = dependent.len();
        let square = Matrix::from_fn(m, m, |a, d| c[(a, dependent[d])]);
        let name = || self.constraints().last().map_or_else(String::new, |c| c.name().to_owned());
        let inverse =
            inverse(graph, &square).ok_or_else(|| MechError::DependentConstraint { constraint: name() })?;
        let zeros: Vec<_> = dependent.iter().map(|&d| (eta[d], Expr::ZERO)).collect();
        let without = graph.substitute(self.velocities(), &zeros);
        let solved: Vec<(Expr<'g>, Expr<'g>)> = (0..m)
            .map(|d| (eta[dependent[d]], -graph.dot(inverse.row(d).iter().copied(), without.iter().copied())))
            .collect();

        let free: Vec<Expr<'g>> = independent.iter().map(|&s| eta[s]).collect();
        let velocities = graph.substitute(&system.frame().velocities(eta), &solved);
        let (time, x) = (system.frame().time(), system.frame().coordinates());
        let frame = Frame::from_velocities(graph, time, x.to_vec(), &free, &velocities)?;
        let structure = frame.structure_coefficients(&near)?;

        let rates: Vec<_> = x
            .iter()
            .copied()
            .zip(velocities)
            .chain(free.iter().map(|&eta| (eta, graph.symbol(&format!("{eta}'")))))
            .chain([(time, Expr::ONE)])
            .collect();
        let values: Vec<Expr<'g>> = solved.iter().map(|&(_, value)| value).collect();
        let accelerations = graph.directional(&values, &rates);
        let mut known = solved.clone();
        known.extend(
            solved.iter().zip(accelerations).map(|((eta, _), rate)| (graph.symbol(&format!("{eta}'")), rate)),
        );
        let put = |list: &[Expr<'g>]| graph.substitute(list, &known);
        let named = |list: &[(String, Expr<'g>)]| {
            list.iter().map(|(name, value)| (name.clone(), put(&[*value])[0])).collect()
        };
        let forces = put(system.forces());
        let dependence: Vec<Vec<Expr<'g>>> =
            values.iter().map(|&value| graph.gradient(value, &free)).collect();
        let carried =
            |s: usize| graph.dot(dependent.iter().map(|&d| forces[d]), dependence.iter().map(|row| row[s]));
        Ok(System {
            structure,
            frame,
            parameters: system.parameters().to_vec(),
            lagrangian: put(&[system.lagrangian()])[0],
            forces: independent.iter().enumerate().map(|(s, &old)| forces[old] + carried(s)).collect(),
            integrals: named(system.integrals()),
            outputs: named(system.outputs()),
            quasi_velocities: free,
        })
    }

    /// The indices of the quasi-velocities that the constraints determine best at the values `at` of time, coordinates
    /// and quasi-velocities, rising; `at` may have other values of parameters.
    ///
    /// # Errors
    /// [`MechError::SingularConstraint`] if the constraints are dependent there;
    /// [`ExprError::UnboundSymbol`](crate::ExprError::UnboundSymbol) if a value is missing.
    pub fn dependent_at(&self, at: &[(Expr<'g>, f64)]) -> Result<Vec<usize>, MechError> {
        let system = self.equations().system();
        let (graph, k, m) = (system.graph(), system.quasi_velocities().len(), self.constraints().len());
        let (lower, entries) = self.lower_triangle();
        let values = graph.evaluate(&entries, &[system.parameters(), at].concat())?;
        let mut saddle = Saddle::new(k, m);
        saddle.eliminate(&lower, &values).map_err(|fault| {
            let place = match fault {
                Fault::Pivot { index, .. } => index.saturating_sub(k),
                _ => 0,
            };
            let value = |symbol: Expr<'g>| at.iter().find(|(known, _)| *known == symbol);
            let state = system.frame().coordinates().iter().chain(system.quasi_velocities());
            MechError::SingularConstraint {
                constraint: self.constraints()[place].name().to_owned(),
                t: value(system.frame().time()).map_or(f64::NAN, |&(_, t)| t),
                state: state.filter_map(|&x| Some((x.to_string(), value(x)?.1))).collect(),
            }
        })?;
        let mut dependent = saddle.dependent().to_vec();
        dependent.sort_unstable();
        Ok(dependent)
    }
}
