//! How far an analysis goes.

/// How far an analysis goes: its work grows with the equations, and is estimated from their length, so that the same model has
/// the same results on every machine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Extent {
    /// As far as its searches go by themselves.
    #[default]
    Full,
    /// As far as takes about a second.
    Brief {
        /// The number of operations of one right-hand side, with parameters as inputs.
        operations: usize,
    },
}

impl Extent {
    /// Whether equations of this length are short enough for work that takes a second for `most` operations.
    pub fn allows(self, most: usize) -> bool {
        match self {
            Extent::Full => true,
            Extent::Brief { operations } => operations <= most,
        }
    }

    /// One of two bounds of a search.
    pub(crate) fn either(self, full: usize, brief: usize) -> usize {
        match self {
            Extent::Full => full,
            Extent::Brief { .. } => brief,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_brief_analysis_leaves_out_what_is_long() {
        let of = |operations| Extent::Brief { operations };
        assert!(of(10).allows(10) && !of(11).allows(10) && Extent::Full.allows(0));
        assert_eq!((of(1).either(600, 100), Extent::Full.either(600, 100)), (100, 600));
    }
}
