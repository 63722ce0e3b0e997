//! The frame of a model, and errors in the frame.

use pc_mech::{AlgebraError, Expr, Frame};

use super::constraints::Written;
use crate::assembly::assembler::Assembler;
use crate::diagnostics::error::ModelError;
use crate::diagnostics::meaning::MeaningError;
use crate::document::{Contact, Name, NamedExpression};
use crate::names::scope::entry;
use crate::names::stage::Stage;

impl<'g> Assembler<'g, '_> {
    /// The frame, given in one of four ways: by kinematics, by definitions, by neither (Lagrange), or without
    /// coordinates.
    ///
    /// Constraints or velocities x' complete the definitions, as quasi-velocities that come after the
    /// declared ones; `at` are the values at the start.
    pub(super) fn frame(
        &mut self,
        constraints: &mut [Written<'g>],
        at: &[(Expr<'g>, f64)],
    ) -> Result<(Frame<'g>, Vec<Expr<'g>>), ModelError> {
        let document = self.model.document();
        let (time, x) = (self.graph.symbol("t"), self.scope.coordinates());
        if let Some(stray) =
            document.kinematics.iter().find(|k| entry(&document.coordinates, &k.name.text).is_none())
        {
            return Err(self.not_a_coordinate(&stray.name));
        }
        let own = self.first_own_quasi_velocity();
        let defined = document.quasi_velocities.iter().find(|q| q.is.is_some());
        let defined = own.filter(|own| own.is.is_some()).or(defined);
        let frame = match (defined, document.kinematics.first()) {
            (Some(defined), Some(_)) => Err(self
                .model
                .document()
                .error(&defined.name.place, MeaningError::TwoKinematics { name: defined.name.text.clone() })),
            (Some(_), None) => return self.frame_of_definitions(time, x, constraints, at),
            (None, Some(_)) => self.frame_of_kinematics(time, x),
            (None, None) if self.is_lagrangian_form() => Ok(Frame::coordinate(self.graph, time, x)),
            (None, None) if self.is_moved_by_joints() => self.frame_of_kinematics(time, x),
            (None, None) if x.is_empty() => {
                let k = document.quasi_velocities.len();
                let b = pc_mech::Matrix::from_fn(0, k, |_, _| Expr::ZERO);
                Frame::new(self.graph, time, x, b, Vec::new())
                    .map_err(|e| self.model.document().algebra_error(e))
            }
            (None, None) => {
                let name = &own.unwrap_or(&document.quasi_velocities[0]).name;
                Err(self
                    .model
                    .document()
                    .error(&name.place, MeaningError::Undefined { name: name.text.clone() }))
            }
        };
        Ok((frame?, Vec::new()))
    }

    fn frame_of_kinematics(&mut self, time: Expr<'g>, x: Vec<Expr<'g>>) -> Result<Frame<'g>, ModelError> {
        let document = self.model.document();
        let mut velocities = self.joint_velocities()?;
        let of_contacts: Vec<&Name> = document.contacts.iter().flat_map(Contact::coordinates).collect();
        for coordinate in &document.coordinates[velocities.len()..] {
            // A contact declares the velocity x' with its coordinate x, unless the kinematics give it.
            let is_of_contact = of_contacts.iter().any(|name| name.text == coordinate.name.text)
                && entry(&document.kinematics, &coordinate.name.text).is_none();
            if document.kinematics.is_empty() || is_of_contact {
                velocities.push(self.scope.velocity(&coordinate.name.text));
                continue;
            }
            let Some(kinematics) = entry(&document.kinematics, &coordinate.name.text) else {
                let coordinate = coordinate.name.text.clone();
                return Err(self.model.document().error(
                    &document.kinematics[0].name.place,
                    MeaningError::KinematicsMissing { coordinate },
                ));
            };
            velocities.push(self.scope.resolve(&kinematics.expression, Stage::Kinematics)?);
        }
        let eta = self.scope.quasi_velocities();
        Frame::from_velocities(self.graph, time, x, &eta, &velocities).map_err(|error| match error {
            AlgebraError::NotAffine { coordinate, .. } => match entry(&document.kinematics, &coordinate) {
                Some(NamedExpression { expression, .. }) => {
                    let fault =
                        |text| MeaningError::NonlinearQuasiVelocity { text, variables: "quasi-velocities" };
                    self.scope.error(expression, expression.ast.span, fault)
                }
                None => self
                    .model
                    .document()
                    .algebra_error(AlgebraError::NotAffine { coordinate, velocity: String::new() }),
            },
            other => self.model.document().algebra_error(other),
        })
    }
}
