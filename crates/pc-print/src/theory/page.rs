//! The theory of a model on a page.

use pc_model::{Assembly, Model, ModelError};

use crate::layout::format::Page;
use crate::theory::basis::Basis;
use crate::theory::description::{Section, Theory};
use crate::theory::options::TheoryOptions;
use crate::theory::{
    action, brackets, canonical_variables, dependent_momenta, dirac, functions, integrals, json, latex,
    measure, names, poissons_theorem, routh, steady, text,
};
use crate::words::visible::{visible, visible_json};

impl<'g> Theory<'g> {
    /// The analysis of the motions of a model.
    ///
    /// # Errors
    /// [`ModelError`] if the equations cannot be derived, or a function cannot be read.
    ///
    /// ```
    /// use pc_mech::Graph;
    /// use pc_model::{Document, Model, Source};
    /// use pc_print::{Page, Theory, TheoryOptions};
    ///
    /// let text = "[parameters]\na = 2.0\n[coordinates]\nx = 1.0\ny = 0.5\n[lagrangian]\n\
    ///             kinetic = \"(x'^2 + y'^2)/2\"\npotential = \"x^2 + a*y^2\"";
    /// let model = Model::new(Document::parse(Source::new("oscillator.toml", text))?);
    /// let graph = Graph::new();
    /// let theory = Theory::of(&model, &model.assemble(&graph)?, &TheoryOptions::default())?;
    /// let printed = theory.printed(Page::Text);
    /// assert!(printed.contains("2 a y² + y'² = const   (proved)"), "{printed}");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn of(
        model: &Model,
        assembly: &Assembly<'g>,
        options: &TheoryOptions,
    ) -> Result<Theory<'g>, ModelError> {
        let ground = Basis::new(model, assembly)?;
        let bracket = ground.placed(brackets::bracket(&ground))?;
        let found = integrals::found(&ground, model, options)?;
        let sections: Vec<Section<'g>> = vec![
            functions::section(&ground),
            brackets::momenta(&ground),
            brackets::brackets(&ground, bracket.as_ref()),
            ground.placed(dependent_momenta::section(&ground))?,
            ground.placed(dirac::section(&ground))?,
            canonical_variables::section(&ground, bracket.as_ref(), model, options)?,
            brackets::casimirs(&ground, bracket.as_ref(), options.degree),
            brackets::group_reduction(&ground, options.degree),
            integrals::section(&ground, &found, options),
            ground.placed(poissons_theorem::section(&ground, bracket.as_ref(), &found.0))?,
            integrals::displacements(&ground, &found.0),
            measure::section(&ground)?,
            measure::multiplier(&ground),
            action::section(&ground),
            steady::section(&ground, &found.0, options.extent)?,
            routh::section(&ground)?,
        ];
        Theory::written(model, assembly, sections)
    }

    /// The verdict on functions as canonical variables, below the momenta of the model: pairs of a name and an expression, as in
    /// [`TheoryOptions::canonical`].
    ///
    /// # Errors
    /// As for [`of`](Theory::of), and if the model has no Poisson bracket to compare with.
    pub fn of_canonical_variables(
        model: &Model,
        assembly: &Assembly<'g>,
        proposed: &[(String, String)],
    ) -> Result<Theory<'g>, ModelError> {
        let ground = Basis::new(model, assembly)?;
        let bracket = ground.placed(brackets::bracket(&ground))?;
        let options = TheoryOptions { canonical: proposed.to_vec(), ..TheoryOptions::default() };
        let sections = vec![
            brackets::momenta(&ground),
            canonical_variables::section(&ground, bracket.as_ref(), model, &options)?,
        ];
        Theory::written(model, assembly, sections)
    }

    /// The sections that have entries, with their formulas written out.
    fn written(
        model: &Model,
        assembly: &Assembly<'g>,
        sections: Vec<Section<'g>>,
    ) -> Result<Theory<'g>, ModelError> {
        let sections = sections.into_iter().filter(|section| !section.entries.is_empty()).collect();
        let mut theory = Theory { title: model.title().to_owned(), sections };
        names::write(&mut theory, assembly);
        assembly.within_limits()?;
        Ok(theory)
    }

    /// The theory on a page.
    pub fn printed(&self, page: Page) -> String {
        match page {
            Page::Text => visible(&text::written(self)).into_owned(),
            Page::Latex => latex::written(self),
            Page::Json => visible_json(&json::written(self)) + "\n",
        }
    }
}
