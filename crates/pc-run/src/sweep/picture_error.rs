//! Why a sweep cannot be drawn.

/// The most cells of a panel: a picture has no more points.
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
    /// More members than there are cells for colours.
    #[error(
        "{members} members are more than the {MOST_CELLS} colours that can be told apart; give fewer values"
    )]
    Cells {
        /// How many there are.
        members: u64,
    },
    /// A column that does not exist.
    #[error("there is no column `{name}`; the columns are {}", known.join(", "))]
    UnknownColumn {
        /// The requested name.
        name: String,
        /// The existing columns.
        known: Vec<String>,
    },
}
