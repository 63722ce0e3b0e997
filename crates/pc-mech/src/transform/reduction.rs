//! Systems without their ignorable coordinates: Euler–Poincaré equations.

use pc_algebra::{Frame, Matrix};
use pc_expr::Expr;

use crate::error::MechError;
use crate::system::bodies::velocity::Bodies;
use crate::system::system::System;

impl<'g> System<'g> {
    /// The system without the coordinates on which its motion does not depend: L, Q, c_rs^m and the velocities
    /// of the kept coordinates do not contain them.
    ///
    /// On a group with L invariant, X_s L = 0, and constant c_rs^m no coordinate is left, and the equations (9) are
    /// the Euler–Poincaré equations,
    ///
    ///   d/dt ∂L/∂η_s = c_rs^m η_r ∂L/∂η_m + Q_s,
    ///
    /// the [canonical](System::canonical) ones the Lie–Poisson equations, ẏ_s = c_rs^m ∂H/∂y_r y_m. Integrals and
    /// outputs that contain the omitted coordinates are left out too. The omitted coordinates can be recovered by
    /// integrating ẋ = b η + b_0 (3).
    ///
    /// # Errors
    /// [`MechError::Algebra`] if the parts do not fit together, which cannot happen for a system that was
    /// built.
    ///
    /// ```
    /// use pc_algebra::{LieGroup, UnitQuaternions};
    /// use pc_mech::{Graph, System};
    ///
    /// // A free rigid body whose attitude is a unit quaternion.
    /// let graph = Graph::new();
    /// let q = graph.symbols(["q0", "q1", "q2", "q3"]);
    /// let body = System::builder(&graph)
    ///     .coordinates(["q0", "q1", "q2", "q3"])
    ///     .quasi_velocities(["ω1", "ω2", "ω3"])
    ///     .frame(UnitQuaternions.left_frame(&graph, graph.symbol("t"), q.to_vec())?)
    ///     .lagrangian(|_, _, w| (w[0].square() + 2.0 * w[1].square() + 3.0 * w[2].square()) / 2.0)
    ///     .build()?;
    /// let euler = body.reduced()?;
    /// assert_eq!(euler.frame().coordinates(), []);
    /// assert_eq!(euler.poincare()?.right_hand_side()[0].to_string(), "-ω2*ω3");
    /// # Ok::<(), pc_mech::MechError>(())
    /// ```
    pub fn reduced(&self) -> Result<System<'g>, MechError> {
        let graph = self.graph();
        let order = self.collecting_order();
        let short = |expressions: &[Expr<'g>]| graph.shorten(expressions, &order);
        let lagrangian = short(&[self.lagrangian])[0];
        let forces = short(&self.forces);
        let structure = self.structure.map(|c| short(&[c])[0]);
        let brackets = structure.nonzero().map(|(.., c)| c);
        let states = self.states_in(short);
        let rates = states.iter().map(|&(_, rate)| rate);
        let dynamics: Vec<Expr<'g>> =
            brackets.chain(forces.iter().copied()).chain(rates).chain([lagrangian]).collect();
        let kept = self.kept(&dynamics);

        let x = self.frame.coordinates();
        let (b, b0) = (self.frame.b(), self.frame.b0());
        let frame = Frame::new(
            graph,
            self.frame.time(),
            kept.iter().map(|&i| x[i]).collect(),
            Matrix::from_fn(kept.len(), b.columns(), |i, s| b[(kept[i], s)]),
            kept.iter().map(|&i| b0[i]).collect(),
        )?;
        let dropped: Vec<Expr<'g>> = (0..x.len()).filter(|i| !kept.contains(i)).map(|i| x[i]).collect();
        let known = |list: &[(String, Expr<'g>)]| -> Vec<(String, Expr<'g>)> {
            list.iter().filter(|(_, f)| !dropped.iter().any(|&x| f.depends_on(x))).cloned().collect()
        };
        let is_left = |q: &&[Expr<'g>; 4]| !q.iter().any(|x| dropped.contains(x));
        Ok(System {
            unit_quaternions: self.unit_quaternions.iter().filter(is_left).copied().collect(),
            frame,
            structure,
            states,
            lagrangian,
            forces,
            integrals: known(&self.integrals),
            outputs: known(&self.outputs),
            bodies: Bodies { list: Vec::new(), rest: lagrangian, others: None }, // their coordinates are left out
            tree: None,
            ..self.clone()
        })
    }

    /// The coordinates on which `dynamics` depend, and the coordinates on which their velocities depend in
    /// turn.
    fn kept(&self, dynamics: &[Expr<'g>]) -> Vec<usize> {
        let x = self.frame.coordinates();
        let mut matters: Vec<bool> = x.iter().map(|&x| dynamics.iter().any(|f| f.depends_on(x))).collect();
        loop {
            let rows = (0..x.len()).filter(|&i| matters[i]);
            let row = |i: usize| self.frame.b().nonzero(i).map(|(_, b)| b).chain([self.frame.b0()[i]]);
            let velocities: Vec<Expr<'g>> = rows.flat_map(row).collect();
            let more = (0..x.len()).find(|&i| !matters[i] && velocities.iter().any(|v| v.depends_on(x[i])));
            match more {
                Some(i) => matters[i] = true,
                None => return (0..x.len()).filter(|&i| matters[i]).collect(),
            }
        }
    }
}
