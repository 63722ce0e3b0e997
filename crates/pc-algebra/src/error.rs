//! What can be wrong with a frame or an algebra.

use pc_expr::ExprError;

/// An error of this crate. Operators are numbered from 1; index 0 is time.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AlgebraError {
    /// The parts of a frame do not fit together.
    #[error("{what} has {found} entries where {expected} are needed")]
    Shape {
        /// The part.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The length that fits.
        expected: usize,
    },
    /// A velocity that is not affine in the quasi-velocities.
    #[error("the velocity of `{coordinate}` is not affine in the quasi-velocities: it is `{velocity}`")]
    NotAffine {
        /// Name of the coordinate.
        coordinate: String,
        /// Text of its velocity.
        velocity: String,
    },
    /// A quasi-velocity that is not affine in the velocities.
    #[error("the quasi-velocity number {row} is not affine in the velocities: it is `{definition}`")]
    DefinitionNotAffine {
        /// Number of the definition, from 1.
        row: usize,
        /// Its text.
        definition: String,
    },
    /// Definitions η = a ẋ + a_0 that cannot be solved for ẋ.
    #[error(
        "the definitions of the quasi-velocities cannot be solved for the velocities: their matrix is singular everywhere"
    )]
    SingularDefinitions,
    /// The operators have no coordinates to act on, so only the user knows their brackets.
    #[error(
        "a frame without coordinates does not determine its structure coefficients: the algebra must be given"
    )]
    AlgebraNeeded,
    /// Operators that are linearly dependent at each point and have no constant structure coefficients.
    #[error(
        "the frame has rank {rank} with {operators} operators, so its structure coefficients must be constant to be \
         found, and [X_{}, X_{}] is no constant combination of the X_m: the algebra must be given",
        pair.0, pair.1
    )]
    RankDeficient {
        /// Rank of b.
        rank: usize,
        /// Number of operators.
        operators: usize,
        /// The first pair without constant coefficients.
        pair: (usize, usize),
    },
    /// A commutator outside the span of the operators.
    #[error(
        "the frame is not closed: [X_{}, X_{}] is not a combination of the X_m (relative residual {residual:.1e}), \
         so the constraints it stands for are not integrable",
        pair.0, pair.1
    )]
    NotClosed {
        /// The pair.
        pair: (usize, usize),
        /// Residual relative to the size of the commutator.
        residual: f64,
    },
    /// Given structure coefficients that are not those of the frame.
    #[error(
        "the given algebra contradicts the frame: [X_{}, X_{}] differs from c_rs^m X_m (relative residual {residual:.1e})",
        pair.0, pair.1
    )]
    Contradiction {
        /// The pair.
        pair: (usize, usize),
        /// Residual relative to the size of the commutator.
        residual: f64,
    },
    /// Structure constants that are not antisymmetric.
    #[error(
        "structure constants are not antisymmetric: c_{r}{s}^{m} = {value}, but c_{s}{r}^{m} = {transposed}"
    )]
    NotSkew {
        /// First lower index.
        r: usize,
        /// Second lower index.
        s: usize,
        /// Upper index.
        m: usize,
        /// c_rs^m
        value: String,
        /// c_sr^m
        transposed: String,
    },
    /// Structure constants that violate the Jacobi identity.
    #[error("the Jacobi identity fails for the operators {}, {} and {}: its component along X_{component} is {defect}", triple.0, triple.1, triple.2)]
    Jacobi {
        /// The three operators.
        triple: (usize, usize, usize),
        /// The operator along which the defect was found.
        component: usize,
        /// The component of \[\[X_r,X_s\],X_u\] + cyclic.
        defect: String,
    },
    /// An algebra of the wrong dimension.
    #[error("the algebra has dimension {algebra}, the frame {operators} operators")]
    Dimension {
        /// Dimension of the algebra.
        algebra: usize,
        /// Number of operators.
        operators: usize,
    },
    /// A name that is not in the catalogue.
    #[error("there is no algebra named `{name}` in the catalogue; it has {}", known.join(", "))]
    UnknownAlgebra {
        /// The name asked for.
        name: String,
        /// The names there are.
        known: Vec<&'static str>,
    },
    /// An error of the expressions themselves.
    #[error(transparent)]
    Expr(#[from] ExprError),
}
