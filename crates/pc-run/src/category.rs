//! The kinds of errors, according to what can be done about them.

/// The kind of an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Category {
    /// Two motions that were compared differ.
    Different,
    /// The errors of two motions are too large to tell whether they differ.
    Undecided,
    /// What was requested is wrong, whatever the model.
    Request,
    /// The text of the model is wrong, or asks for something that cannot be done yet.
    Text,
    /// What was requested is not defined for this model, or exceeds its limits.
    Undefined,
    /// A numerical method did not converge or did not reach the end.
    Failed,
    /// A result could not be written.
    Unwritten,
    /// The observer ended the run.
    Interrupted,
}

impl From<pc_model::Category> for Category {
    fn from(category: pc_model::Category) -> Category {
        match category {
            pc_model::Category::Text | pc_model::Category::Unsupported => Category::Text,
            pc_model::Category::Inconsistent | pc_model::Category::Spent => Category::Undefined,
        }
    }
}
