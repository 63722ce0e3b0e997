//! Functions of the state in addition to those of the text.

use pc_mech::Expr;

use crate::assembly::assembly::Assembly;
use crate::diagnostics::error::ModelError;
use crate::diagnostics::source::Source;
use crate::document::Expression;
use crate::model::model::Model;
use crate::names::scope::Scope;
use crate::names::stage::Stage;

impl Model {
    /// The function of (t, x, η) given by a text that uses the names of the model, where x' is the velocity of a
    /// coordinate x.
    ///
    /// ```
    /// use pc_mech::Graph;
    /// use pc_model::{Document, Model, Source};
    ///
    /// let text = "coordinates.r = 1.0\nquasi_velocities.p.is = \"r^2*r'\"\nlagrangian.kinetic = \"p^2\"";
    /// let model = Model::new(Document::parse(Source::new("point.toml", text))?);
    /// let graph = Graph::new();
    /// let assembly = model.assemble(&graph)?;
    /// assert_eq!(model.function(&assembly, "2*r*r'")?.to_string(), "2*p/r");
    /// assert!(model.function(&assembly, "2*s").is_err());
    /// # Ok::<(), pc_model::ModelError>(())
    /// ```
    ///
    /// # Errors
    /// [`ModelError`] at the place in `text` that causes the error.
    pub fn function<'g>(&self, assembly: &Assembly<'g>, text: &str) -> Result<Expr<'g>, ModelError> {
        self.function_in(assembly, text, &[])
    }

    /// The function of (t, x, η) and of `others`, symbols such as momenta, given by a text as for
    /// [`function`](Model::function); a name of the model does not denote another symbol.
    ///
    /// # Errors
    /// [`ModelError`] at the place in `text` that causes the error.
    pub fn function_in<'g>(
        &self,
        assembly: &Assembly<'g>,
        text: &str,
        others: &[Expr<'g>],
    ) -> Result<Expr<'g>, ModelError> {
        let (system, source) = (&assembly.system, Source::new("expression", text));
        let expression = Expression::of(&source, &self.document().declared_functions())?;
        let mut scope = Scope::new(system.graph(), self.document()).elsewhere(&source).with_names_of(others);
        let value = scope.resolve(&expression, Stage::Function)?;
        let velocities = system.frame().velocities(system.quasi_velocities());
        let velocities: Vec<_> = scope.velocities().into_iter().zip(velocities).collect();
        Ok(system.graph().substitute(&[value], &velocities)[0])
    }
}
