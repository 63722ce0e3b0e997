//! Requests made in addition to the text: other quasi-velocities, and a choice of independent velocities.

use crate::diagnostics::error::ModelError;
use crate::model::given::GivenQuasiVelocity;
use crate::model::model::Model;

impl Model {
    /// Gives a quasi-velocity in addition to those of the text, as a linear form in the velocities x' and the
    /// quasi-velocities of the model, for equations in [given quasi-velocities](crate::Variables::Given). If fewer
    /// are given than there are independent ones, quasi-velocities of the model complete them; each time, the
    /// quasi-velocity that is least determined at the start by those already chosen is added. Each given
    /// quasi-velocity is also an output.
    ///
    /// ```
    /// use pc_mech::Graph;
    /// use pc_model::{Document, Model, Source, Variables};
    ///
    /// // Polar coordinates, by the velocity across the radius.
    /// let text = "coordinates.r = 1.0\ncoordinates.f = 0.0\nlagrangian.kinetic = \"(r'^2 + r^2*f'^2)/2\"";
    /// let mut model = Model::new(Document::parse(Source::new("point.toml", text))?);
    /// model.give_quasi_velocity("v", "r*f'")?;
    /// let graph = Graph::new();
    /// let assembly = model.assemble(&graph)?;
    /// let form = assembly.free_form(Variables::Given)?;
    /// let names: Vec<String> = form.system.quasi_velocities().iter().map(|eta| eta.to_string()).collect();
    /// assert_eq!(names, ["v", "r'"]);
    /// assert!(model.give_quasi_velocity("v", "r'").is_err());
    /// # Ok::<(), pc_model::ModelError>(())
    /// ```
    ///
    /// # Errors
    /// [`ModelError`] if the name is invalid or taken, or the text is not an expression; errors in the meaning of
    /// the text are reported when the model is assembled.
    pub fn give_quasi_velocity(&mut self, name: &str, definition: &str) -> Result<(), ModelError> {
        let given = {
            let taken: Vec<&str> = self.given.iter().map(GivenQuasiVelocity::name).collect();
            GivenQuasiVelocity::new(self.document(), &taken, name, definition)?
        };
        self.given.push(given);
        Ok(())
    }

    /// Removes the quasi-velocities given in the section `[simulation]` of the text or by earlier calls.
    pub fn give_no_quasi_velocities(&mut self) {
        self.given.clear();
    }

    /// The quasi-velocities given in addition to those of the text.
    pub fn given_quasi_velocities(&self) -> &[GivenQuasiVelocity] {
        &self.given
    }

    /// Chooses these velocities as the independent ones in equations from which multipliers are eliminated:
    /// quasi-velocities of the model, or velocities x' for forms in terms of velocities. Without names, the
    /// velocities whose equations are shortest are chosen.
    pub fn choose_independent<S: Into<String>>(&mut self, names: impl IntoIterator<Item = S>) {
        self.independent = names.into_iter().map(Into::into).collect();
    }

    /// The names of the velocities chosen as independent.
    pub fn independent(&self) -> &[String] {
        &self.independent
    }
}
