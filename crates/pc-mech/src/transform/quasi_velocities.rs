//! The same system in other quasi-velocities.

use pc_algebra::{AlgebraError, Frame, FrameChange, Matrix, StructureCoefficients, affine};
use pc_expr::Expr;

use crate::error::{MechError, shape};
use crate::system::system::System;

/// A system in other quasi-velocities η' = A η + A_0, with the new quasi-velocities in terms of the old, and
/// the old in terms of the new.
#[derive(Clone, Debug)]
pub struct QuasiVelocityChange<'g> {
    system: System<'g>,
    matrix: Matrix<Expr<'g>>,
    definitions: Vec<Expr<'g>>,
    old: Vec<Expr<'g>>,
}

impl<'g> QuasiVelocityChange<'g> {
    /// The system in the new quasi-velocities.
    pub fn system(&self) -> &System<'g> {
        &self.system
    }

    /// The k × k matrix A, which is singular where the new quasi-velocities do not determine the old ones.
    pub fn matrix(&self) -> &Matrix<Expr<'g>> {
        &self.matrix
    }

    /// The k new quasi-velocities η' as functions of (t, x, η).
    pub fn definitions(&self) -> &[Expr<'g>] {
        &self.definitions
    }

    /// The k old quasi-velocities η as functions of (t, x, η').
    pub fn old_quasi_velocities(&self) -> &[Expr<'g>] {
        &self.old
    }
}

impl<'g> System<'g> {
    /// The same system in the quasi-velocities η' = A η + A_0, given by their names and their expressions in the old
    /// ones. A name may be the same as that of an old quasi-velocity.
    ///
    /// With η = B η' + B_0 the forces are Q'_u = B_su Q_s; the structure coefficients are those of
    /// [`FrameChange::structure_coefficients`].
    ///
    /// # Errors
    /// [`ShapeError`](crate::ShapeError); [`AlgebraError::DefinitionNotAffine`]; [`AlgebraError::SingularDefinitions`]
    /// if A is singular everywhere.
    ///
    /// ```
    /// use pc_mech::{Graph, System};
    ///
    /// // A particle in the plane; u is its velocity across the direction φ.
    /// let graph = Graph::new();
    /// let [x, y, phi, vx, vy, w] = graph.symbols(["x", "y", "φ", "x'", "y'", "φ'"]);
    /// let system = System::builder(&graph)
    ///     .coordinates(["x", "y", "φ"])
    ///     .lagrangian(|_, _, v| (v[0].square() + v[1].square() + v[2].square()) / 2.0)
    ///     .build()?;
    /// let (s, c) = (phi.sin(), phi.cos());
    /// let changed = system.in_quasi_velocities(["v", "u", "ω"], &[c * vx + s * vy, c * vy - s * vx, w])?;
    /// let equations = changed.poincare()?;
    /// assert_eq!(equations.right_hand_side()[0].to_string(), "u*ω");
    /// # let _ = (x, y);
    /// # Ok::<(), pc_mech::MechError>(())
    /// ```
    pub fn in_quasi_velocities<S: AsRef<str>>(
        &self,
        names: impl IntoIterator<Item = S>,
        definitions: &[Expr<'g>],
    ) -> Result<System<'g>, MechError> {
        Ok(self.quasi_velocity_change(names, definitions)?.system)
    }

    /// The system, with the new quasi-velocities in terms of the old ones, and the old ones in terms of the
    /// new.
    ///
    /// # Errors
    /// As for [`in_quasi_velocities`](System::in_quasi_velocities).
    pub fn quasi_velocity_change<S: AsRef<str>>(
        &self,
        names: impl IntoIterator<Item = S>,
        definitions: &[Expr<'g>],
    ) -> Result<QuasiVelocityChange<'g>, MechError> {
        let graph = self.graph();
        let symbols: Vec<Expr<'g>> = names.into_iter().map(|name| graph.symbol(name.as_ref())).collect();
        let (what, expected) = ("the list of new quasi-velocities", self.quasi_velocities.len());
        shape(what, symbols.len(), expected)?;
        shape(what, definitions.len(), expected)?;
        let change = self.change(definitions)?;
        let structure = change.structure_coefficients(&self.structure)?;
        Ok(QuasiVelocityChange {
            matrix: change.matrix().clone(),
            definitions: change.quasi_velocities(&self.quasi_velocities),
            old: change.old_quasi_velocities(&symbols),
            system: self.changed(symbols, &change, change.frame().clone(), structure)?,
        })
    }

    /// The change to quasi-velocities given by their expressions in the old ones.
    pub(crate) fn change(&self, definitions: &[Expr<'g>]) -> Result<FrameChange<'g>, MechError> {
        let (graph, eta) = (self.graph(), &self.quasi_velocities);
        self.check_no_state("the definition of a quasi-velocity", definitions)?;
        let parts = definitions.iter().enumerate().map(|(row, &definition)| {
            affine(graph, definition, eta).ok_or_else(|| AlgebraError::DefinitionNotAffine {
                row: row + 1,
                definition: definition.to_string(),
            })
        });
        let (rows, drift): (Vec<Vec<Expr<'g>>>, Vec<Expr<'g>>) =
            parts.collect::<Result<Vec<_>, _>>()?.into_iter().unzip();
        let matrix = Matrix::from_fn(rows.len(), eta.len(), |u, s| rows[u][s]);
        Ok(self.frame.changed_by(&matrix, &drift)?)
    }

    /// This system in the quasi-velocities of a change, called `symbols`, with the resulting frame.
    pub(crate) fn changed(
        &self,
        symbols: Vec<Expr<'g>>,
        change: &FrameChange<'g>,
        frame: Frame<'g>,
        structure: StructureCoefficients<'g>,
    ) -> Result<System<'g>, MechError> {
        let graph = self.graph();
        let old = change.old_quasi_velocities(&symbols);
        let x = frame.coordinates().iter().copied().zip(frame.velocities(&symbols));
        let rates = symbols.iter().map(|eta| (*eta, graph.symbol(&format!("{eta}'"))));
        let along: Vec<_> = x.chain(rates).chain(graph.in_time(frame.time())).collect();
        let old_rates = graph.directional(&old, &along);
        let before = self.quasi_velocities.iter().copied().chain(self.accelerations());
        let values: Vec<_> = before.zip(old.iter().copied().chain(old_rates)).collect();
        let put = |list: &[Expr<'g>]| graph.substitute(list, &values);
        let forces = put(&self.forces);
        let parameters = self.parameters.iter().map(|&(symbol, _)| symbol);
        let order: Vec<Expr<'g>> = symbols.iter().copied().chain(parameters).collect();
        let others = System { lagrangian: Expr::ZERO, forces: Vec::new(), ..self.clone() };
        Ok(System {
            forces: (0..symbols.len())
                .map(|u| graph.dot(change.back().column(u), forces.iter().copied()))
                .collect(),
            lagrangian: graph.shorten(&put(&[self.lagrangian]), &order)[0],
            quasi_velocities: symbols,
            structure,
            frame,
            ..others.map_expressions(put)
        })
    }
}
