//! Forces on a model that are computed outside it.

use crate::model::model::Model;

/// A name on which no external force can act.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no external force can act on `{name}`; one can on {}", known.join(", "))]
pub struct NotForced {
    /// The requested name.
    pub name: String,
    /// The quasi-velocities; the velocities x' if none is declared.
    pub known: Vec<String>,
}

impl Model {
    /// Declares that a force computed outside the model, such as that of a controller, acts on a
    /// quasi-velocity or, if none is declared, on a velocity x' or its coordinate x. The system then has an [external
    /// force](pc_mech::System::external_forces), and a motion has one more input, which is zero until it is
    /// set, or is [given by a function](pc_mech::Motion::forced).
    ///
    /// ```
    /// use pc_mech::{Graph, VectorField};
    /// use pc_model::{Document, Flow, Model, Source, Variables};
    ///
    /// let text = "coordinates.x = 1.0\nlagrangian.kinetic = \"x'^2\"";
    /// let mut model = Model::new(Document::parse(Source::new("point.toml", text))?);
    /// model.external_force("x'")?;
    /// let graph = Graph::new();
    /// let assembly = model.assemble(&graph)?;
    /// let flow = Flow::new(&model, &assembly, Variables::QuasiVelocities)?;
    /// let mut spring = flow.motion.forced(model.external_forces(), |_: f64, y: &[f64], q: &mut [f64]| q[0] = -y[0])?;
    /// let mut rate = [0.0; 2];
    /// spring.rhs(0.0, &[1.0, 0.5], &mut rate)?;
    /// assert_eq!(rate, [0.5, -0.5]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`NotForced`], which lists the existing names.
    pub fn external_force(&mut self, on: &str) -> Result<(), NotForced> {
        let known = self.forceable();
        let is_it = |known: &&String| *known == on || known.strip_suffix('\'') == Some(on);
        let Some(on) = known.iter().find(is_it) else {
            return Err(NotForced { name: on.to_owned(), known });
        };
        if !self.external.contains(on) {
            self.external.push(on.clone());
        }
        Ok(())
    }

    /// The quasi-velocities on which external forces act, in the order in which they were declared: `x'` for
    /// a coordinate x.
    pub fn external_forces(&self) -> Vec<String> {
        self.external.clone()
    }

    fn forceable(&self) -> Vec<String> {
        let document = self.document();
        match document.quasi_velocities.as_slice() {
            [] => document.coordinates.iter().map(|x| format!("{}'", x.name.text)).collect(),
            declared => declared.iter().map(|eta| eta.name.text.clone()).collect(),
        }
    }
}
