//! What a sweep computes for each member.

/// What a sweep computes for each member.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SweepOf {
    /// Its motion.
    #[default]
    Run,
    /// The eigenvalues of the member at a state near its start.
    Linearize,
    /// Its properties.
    Check,
}

impl SweepOf {
    /// All of them.
    pub const ALL: [SweepOf; 3] = [SweepOf::Run, SweepOf::Linearize, SweepOf::Check];

    /// Its name in options and output.
    pub fn word(self) -> &'static str {
        match self {
            SweepOf::Run => "run",
            SweepOf::Linearize => "linearize",
            SweepOf::Check => "check",
        }
    }

    /// The computation with this name.
    pub(crate) fn of_word(word: &str) -> Option<SweepOf> {
        SweepOf::ALL.into_iter().find(|of| of.word() == word)
    }
}
