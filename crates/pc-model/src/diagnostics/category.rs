//! Categories of errors, by what has to be changed.

/// The category of an error, by what has to be changed; decides the exit code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Category {
    /// The text of the model is wrong.
    Text,
    /// The text is right, but asks for something that cannot be done yet.
    Unsupported,
    /// The text is right, but what it says contradicts itself.
    Inconsistent,
    /// The text may be right, but its equations exceed the limits.
    Spent,
}

impl Category {
    /// Exit code of the program.
    pub fn exit_code(self) -> u8 {
        match self {
            Self::Text | Self::Unsupported => 3,
            Self::Inconsistent | Self::Spent => 4,
        }
    }
}
