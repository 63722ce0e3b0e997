//! Equations of the last texts, for which other values need only an integration.

use std::sync::{Mutex, PoisonError};

use pc_model::{Assembly, Model, Variables};
use pc_run::RunError;
use pc_run::motion::derived::Derived;

/// The number of texts whose equations are kept.
const MOST: usize = 2;

/// The equations of the last texts, the latest first.
#[derive(Default)]
pub(super) struct Kept(Mutex<Vec<Entry>>);

struct Entry {
    text: String,
    form: Variables,
    derived: Derived,
}

impl Kept {
    /// The equations of a model in a form, for its present values.
    ///
    /// # Errors
    /// [`RunError`] if they have to be derived and cannot be.
    pub(super) fn derived(
        &self,
        model: &Model,
        assembly: &Assembly<'_>,
        form: Variables,
    ) -> Result<Derived, RunError> {
        let text = model.document().source.text();
        let known = self.find(text, form);
        let renewed = known.and_then(|derived| derived.with_values(model, assembly.t_start));
        if let Some(derived) = renewed {
            return Ok(derived);
        }
        let derived = Derived::of(model, assembly, form)?;
        self.keep(Entry { text: text.to_owned(), form, derived: derived.clone() });
        Ok(derived)
    }

    fn find(&self, text: &str, form: Variables) -> Option<Derived> {
        let entries = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let found = entries.iter().find(|entry| entry.form == form && entry.text == text);
        found.map(|entry| entry.derived.clone())
    }

    fn keep(&self, entry: Entry) {
        let mut entries = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        entries.retain(|known| known.form != entry.form || known.text != entry.text);
        entries.insert(0, entry);
        entries.truncate(MOST);
    }
}
