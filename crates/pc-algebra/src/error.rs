//! Errors of frames and algebras.

use pc_expr::ExprError;

/// An error of this crate. Operators are numbered from 1; index 0 is time.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AlgebraError {
    /// Parts of a frame with inconsistent lengths.
    #[error("{what} has {found} entries where {expected} are needed")]
    Shape {
        /// The part.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The required length.
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
    /// Operators that have no coordinates to act on, so that their brackets must be given.
    #[error(
        "a frame without coordinates does not determine its structure coefficients: the algebra must be given"
    )]
    AlgebraNeeded,
    /// Operators that are linearly dependent at each point and have no constant structure coefficients.
    #[error(
        "the frame has rank {rank} with {operators} operators, so its structure coefficients can be found only if they are \
         constant, and [X_{}, X_{}] is not a constant combination of the X_m: the algebra must be given",
        pair.0, pair.1
    )]
    RankDeficient {
        /// Rank of b.
        rank: usize,
        /// Number of operators.
        operators: usize,
        /// The first pair whose bracket has no constant coefficients.
        pair: (usize, usize),
    },
    /// Operators of which a combination vanishes everywhere; any multiple of this combination could be added
    /// to a bracket.
    #[error(
        "the frame does not determine its structure coefficients: {}, with rank {rank} of {operators}: the algebra must \
         be given",
        acts_as_zero(combination, |s| format!("X_{s}"))
    )]
    Undetermined {
        /// Rank of b.
        rank: usize,
        /// Number of operators.
        operators: usize,
        /// The combination: the numbers of operators, from 1, each with its coefficient as text. Coefficients are
        /// functions of parameters and time. Empty if no combination was found.
        combination: Vec<(usize, String)>,
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
    /// Structure coefficients that were given but are not those of the frame.
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
        /// The index of the operator along which the defect was found.
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
        /// The requested name.
        name: String,
        /// The known names.
        known: Vec<&'static str>,
    },
    /// A structure constant that is a rounded real number, where exact arithmetic is needed.
    #[error("c_{r}{s}^{m} = {value} is not a rational number, so nothing exact can be said of the algebra")]
    NotRational {
        /// First lower index.
        r: usize,
        /// Second lower index.
        s: usize,
        /// Upper index.
        m: usize,
        /// The constant.
        value: String,
    },
    /// A structure constant whose numerator or denominator is too large.
    #[error("c_{r}{s}^{m} = {value} has a numerator or denominator above 2^53")]
    TooLarge {
        /// First lower index.
        r: usize,
        /// Second lower index.
        s: usize,
        /// Upper index.
        m: usize,
        /// The constant.
        value: String,
    },
    /// An entry that is a rounded real number, where exact arithmetic is needed.
    #[error("entry ({row}, {column}) of {what} is {value}, which is not a rational number")]
    IrrationalEntry {
        /// The matrix.
        what: &'static str,
        /// The row of the entry, counted from 1.
        row: usize,
        /// The column of the entry, counted from 1.
        column: usize,
        /// The entry.
        value: String,
    },
    /// A change of basis with a singular matrix.
    #[error("the matrix of the change of basis is singular")]
    SingularBasis,
    /// Matrices ρ(X_s) that do not represent the algebra.
    #[error(
        "this is not a representation: ρ([X_{r}, X_{s}]) and ρ(X_{r})ρ(X_{s}) − ρ(X_{s})ρ(X_{r}) differ in \
         entry ({row}, {column})",
        r = pair.0, s = pair.1
    )]
    NotRepresentation {
        /// The pair, from 1.
        pair: (usize, usize),
        /// The row of the first entry that differs, counted from 1.
        row: usize,
        /// The column of the entry, counted from 1.
        column: usize,
    },
    /// Matrices that are linearly dependent, and so are not a basis.
    #[error("matrix number {number} is a combination of those before it")]
    DependentMatrices {
        /// The number of the first matrix that depends on the preceding ones, from 1.
        number: usize,
    },
    /// Matrices whose commutators lie outside their span.
    #[error("the commutator of the matrices number {} and {} is not in their span", pair.0, pair.1)]
    NotMatrixAlgebra {
        /// The pair, from 1.
        pair: (usize, usize),
    },
    /// A member of a family with too many structure constants.
    #[error("{family}(n) is available up to n = {largest}, not for n = {n}")]
    TooLargeFamily {
        /// Name of the family.
        family: &'static str,
        /// The requested size.
        n: usize,
        /// The largest.
        largest: usize,
    },
    /// A parameter that the Bianchi type does not allow.
    #[error("Bianchi type {kind} has a parameter h {range}, not {h}")]
    BianchiParameter {
        /// The type, VI or VII.
        kind: &'static str,
        /// The range it allows.
        range: &'static str,
        /// The parameter.
        h: String,
    },
    /// Text that is not a sequence of axes for Euler angles.
    #[error(
        "`{axes}` is not a sequence of Euler angles: three letters x, y, z are needed, neighbours different, as in zxz"
    )]
    EulerSequence {
        /// The text.
        axes: String,
    },
    /// Coordinates to which no element of the group is nearest.
    #[error("{element:?} has no nearest element of the group")]
    NoNearestElement {
        /// The numbers.
        element: Vec<f64>,
    },
    /// Frames with different coordinates or different symbols for time.
    #[error("the two frames do not have the same coordinates and time")]
    DifferentSpaces,
    /// Operators that are linearly dependent at each point, so that velocities do not determine
    /// quasi-velocities.
    #[error(
        "the frame has rank {rank} with {operators} operators, so its quasi-velocities are not determined"
    )]
    DependentOperators {
        /// Rank of b.
        rank: usize,
        /// Number of operators.
        operators: usize,
    },
    /// Frames that allow different velocities.
    #[error("X_{operator} of the one frame is not a combination of the operators of the other")]
    DifferentVelocities {
        /// The first operator that the other frame does not allow, 0 for the drift.
        operator: usize,
    },
    /// An error of the expressions themselves.
    #[error(transparent)]
    Expr(#[from] ExprError),
}

/// Describes in words the combination of operators that acts as zero on the coordinates; `name` gives the name
/// of an operator.
pub fn acts_as_zero(combination: &[(usize, String)], name: impl Fn(usize) -> String) -> String {
    let term = |(s, coefficient): &(usize, String)| match coefficient.as_str() {
        "1" => format!("+ {}", name(*s)),
        "-1" => format!("- {}", name(*s)),
        sum if sum.contains([' ', '/']) => format!("+ ({sum})*{}", name(*s)),
        other => match other.strip_prefix('-') {
            Some(size) => format!("- {size}*{}", name(*s)),
            None => format!("+ {other}*{}", name(*s)),
        },
    };
    let sum = combination.iter().map(term).collect::<Vec<_>>().join(" ");
    let sum = match sum.strip_prefix("- ") {
        Some(rest) => format!("-{rest}"),
        None => sum.strip_prefix("+ ").map_or_else(|| sum.clone(), str::to_owned),
    };
    match combination {
        [] => "some combination of the operators acts as zero on the coordinates".to_owned(),
        _ => format!("{sum} acts as zero on the coordinates"),
    }
}
