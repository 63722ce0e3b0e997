//! What is asked of the equations beside what the text says: other quasi-velocities, independent ones.

use crate::diagnostics::error::ModelError;
use crate::model::given::GivenQuasiVelocity;
use crate::model::model::Model;

impl Model {
    /// Gives a quasi-velocity beside those of the text, by a linear form in the velocities x' and quasi-velocities of the model, for
    /// equations in [such ones](crate::Variables::Given). Where these are fewer than the independent ones, quasi-velocities of the
    /// model complete them, each time the one that those there are determine least at the start. Each is an output too.
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
    /// [`ModelError`] if the name is none or is taken, or the text is no expression; what is wrong with its meaning is said when
    /// the model is assembled.
    pub fn give_quasi_velocity(&mut self, name: &str, definition: &str) -> Result<(), ModelError> {
        let given = {
            let taken: Vec<&str> = self.given.iter().map(GivenQuasiVelocity::name).collect();
            GivenQuasiVelocity::new(self.document(), &taken, name, definition)?
        };
        self.given.push(given);
        Ok(())
    }

    /// Forgets the quasi-velocities that `[simulation]` of the text or calls before this one give.
    pub fn give_no_quasi_velocities(&mut self) {
        self.given.clear();
    }

    /// The quasi-velocities given beside those of the text.
    pub fn given_quasi_velocities(&self) -> &[GivenQuasiVelocity] {
        &self.given
    }

    /// Asks for these velocities as the independent ones of equations in which multipliers are eliminated: quasi-velocities of the
    /// model, or velocities x' for the forms in these. Without names the choice is that whose equations are shortest.
    pub fn choose_independent<S: Into<String>>(&mut self, names: impl IntoIterator<Item = S>) {
        self.independent = names.into_iter().map(Into::into).collect();
    }

    /// The names of the velocities that are asked for as independent ones.
    pub fn independent(&self) -> &[String] {
        &self.independent
    }
}
