//! Where a result that could not be written to its destination was kept.

use std::fmt;
use std::path::PathBuf;

/// Where a result that could not be written to its destination was kept.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Kept {
    /// Nowhere.
    #[default]
    Nowhere,
    /// The whole result was kept in another file.
    Elsewhere(PathBuf),
    /// The first lines were kept beside the file.
    Beginning(PathBuf),
    /// The finished members of a sweep were kept.
    Journal(PathBuf),
}

impl fmt::Display for Kept {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Kept::Nowhere => Ok(()),
            Kept::Elsewhere(path) => write!(f, "; the result is in {}", path.display()),
            Kept::Beginning(path) => write!(f, "; what could be written of it is in {}", path.display()),
            Kept::Journal(path) => write!(
                f,
                "; the finished members are in {}, and the same command continues from there",
                path.display()
            ),
        }
    }
}
