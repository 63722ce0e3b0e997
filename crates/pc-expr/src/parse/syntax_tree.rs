//! The syntax tree of an expression, with the position of each part in the text.

/// Maximum nesting depth of parentheses, calls, exponents and unary minuses in one expression.
pub const MAX_DEPTH: usize = 200;

/// Byte range in the text of one expression.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Span {
    /// First byte.
    pub start: usize,
    /// One past the last byte.
    pub end: usize,
}

/// An expression as written, with its position in the text; parentheses around it belong to the span.
#[derive(Clone, Debug, PartialEq)]
pub struct Ast {
    /// Its position.
    pub span: Span,
    /// Its kind.
    pub kind: AstKind,
}

/// The kinds of expression.
#[derive(Clone, Debug, PartialEq)]
pub enum AstKind {
    /// `1.5e-3`; finite, and not negative when it comes from [`parse`](crate::parse::parse).
    Number(f64),
    /// `x`
    Name(String),
    /// `x'`, the velocity of the coordinate named here without the prime.
    Velocity(String),
    /// `d(expr)`, the total time derivative along the motion.
    TotalDerivative(Box<Ast>),
    /// `a + b - c`, at least two terms.
    Sum(Vec<(Sign, Ast)>),
    /// `a*b/c`, at least two factors, the first one [`Factor::Times`].
    Product(Vec<(Factor, Ast)>),
    /// `-a`
    Negate(Box<Ast>),
    /// `a^b`
    Power(Box<Ast>, Box<Ast>),
    /// A function of [`FUNCTIONS`](crate::parse::FUNCTIONS) or a [declared](crate::parse::Declared) one, the span of its name, and as many arguments as it takes.
    Call(String, Span, Vec<Ast>),
}

/// Sign of a term of a sum; the first one has [`Sign::Plus`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sign {
    /// `+`
    Plus,
    /// `-`
    Minus,
}

/// The side of the fraction bar on which a factor of a product lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Factor {
    /// `*`
    Times,
    /// `/`
    Over,
}
