//! Why a sweep cannot be drawn.

use pc_report::UnknownColumn;

/// The largest number of cells in a panel: a picture has no more points than this.
pub(super) const MOST_CELLS: u64 = 250_000;

/// Why a sweep cannot be drawn.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SweepPlotError {
    /// More quantities are varied than can be drawn.
    #[error(
        "{varied} values are varied; a picture can be made of a grid over one or two values, or of random members"
    )]
    Varied {
        /// How many quantities have more than one value.
        varied: usize,
    },
    /// There are more members than coloured cells.
    #[error(
        "{members} members are more than the {MOST_CELLS} colours that can be told apart; give fewer values"
    )]
    Cells {
        /// How many members there are.
        members: u64,
    },
    /// A column that does not exist.
    #[error(transparent)]
    UnknownColumn(#[from] UnknownColumn),
}
