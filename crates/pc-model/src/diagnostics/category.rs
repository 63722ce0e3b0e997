//! Categories of errors, according to what has to be changed.

/// The category of an error, according to what has to be changed; it decides the exit code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Category {
    /// The text of the model is wrong.
    Text,
    /// The text is right, but asks for something that cannot be done yet.
    Unsupported,
    /// The text is right, but the model that it describes contradicts itself.
    Inconsistent,
    /// The text may be right, but its equations exceed the limits.
    Spent,
}

impl Category {
    /// The exit code of the program.
    pub fn exit_code(self) -> u8 {
        match self {
            Self::Text | Self::Unsupported => 3,
            Self::Inconsistent | Self::Spent => 4,
        }
    }
}
