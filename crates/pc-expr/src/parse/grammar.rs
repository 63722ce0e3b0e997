//! The grammar: recursive descent over flat lists.

use winnow::LocatingSlice;
use winnow::Parser as _;
use winnow::ascii::{digit0, digit1};
use winnow::combinator::{alt, eof, opt};
use winnow::error::EmptyError;
use winnow::token::{any, one_of, take_while};

use crate::parse::error::{ParseError, ParseErrorKind};
use crate::parse::syntax_tree::{Ast, AstKind, Factor, MAX_DEPTH, Sign, Span};
use crate::parse::vocabulary::{
    Declared, FUNCTIONS, Function, OTHER_NAMES, continues_name, nearest, starts_name,
};

/// The syntax tree of one expression.
///
/// # Errors
/// An error for the first part of the text that cannot belong to an expression, with the span of that part.
pub fn parse(text: &str) -> Result<Ast, ParseError> {
    parse_with(text, &[])
}

/// The syntax tree of one expression that may also call declared functions.
///
/// ```
/// use pc_expr::parse::{AstKind, Declared, parse_with};
/// let v = Declared { name: "V".to_owned(), arguments: vec!["r".to_owned()] };
/// let tree = parse_with("V(x)", &[v.clone()])?;
/// assert!(matches!(tree.kind, AstKind::Call(name, _, _) if name == "V"));
/// let error = parse_with("V(x, y)", &[v]).unwrap_err();
/// assert_eq!(format!("{error}; {}", error.help()), "`V` takes 1 argument, found 2; it is written `V(r)`");
/// # Ok::<(), pc_expr::parse::ParseError>(())
/// ```
///
/// # Errors
/// As for [`parse`].
pub fn parse_with(text: &str, declared: &[Declared]) -> Result<Ast, ParseError> {
    let mut parser = Parser {
        text,
        declared,
        input: LocatingSlice::new(text),
        token: Token::End,
        span: Span { start: 0, end: 0 },
        last: Span { start: 0, end: 0 },
        depth: 0,
    };
    parser.advance();
    parser.whole().map(|tree| *tree).map_err(|error| *error)
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Token<'i> {
    Number(&'i str),
    Name(&'i str),
    Velocity(&'i str),
    Symbol(char),
    Unknown(char),
    End,
}

/// The longest product that is shown as a whole, in characters.
const LONGEST_PRODUCT: usize = 24;

type Input<'i> = LocatingSlice<&'i str>;
type Lexed<T> = winnow::Result<T, EmptyError>;

fn token<'i>(input: &mut Input<'i>) -> Lexed<(Token<'i>, std::ops::Range<usize>)> {
    take_while(0.., [' ', '\t', '\r', '\n']).parse_next(input)?;
    alt((
        number.map(Token::Number),
        (name, opt('\'')).map(|(name, prime)| match prime {
            Some(_) => Token::Velocity(name),
            None => Token::Name(name),
        }),
        one_of(['+', '-', '*', '/', '^', '(', ')', ',']).map(Token::Symbol),
        any.map(Token::Unknown),
        eof.value(Token::End),
    ))
    .with_span()
    .parse_next(input)
}

fn number<'i>(input: &mut Input<'i>) -> Lexed<&'i str> {
    let mantissa = alt(((digit1, opt(('.', digit0))).void(), ('.', digit1).void()));
    let exponent = (one_of(['e', 'E']), opt(one_of(['+', '-'])), digit1);
    (mantissa, opt(exponent)).take().parse_next(input)
}

fn name<'i>(input: &mut Input<'i>) -> Lexed<&'i str> {
    (one_of(starts_name), take_while(0.., continues_name)).take().parse_next(input)
}

/// Results inside the parser, boxed so that nesting costs little stack.
type Parsed<T = Box<Ast>> = Result<T, Box<ParseError>>;

struct Parser<'i> {
    text: &'i str,
    declared: &'i [Declared],
    input: Input<'i>,
    /// The next token and its position.
    token: Token<'i>,
    span: Span,
    /// Position of the token before the next one.
    last: Span,
    depth: usize,
}

impl<'i> Parser<'i> {
    fn advance(&mut self) {
        self.last = self.span;
        let end = self.text.len();
        let (token, place) = token(&mut self.input).unwrap_or((Token::End, end..end));
        self.token = token;
        self.span = Span { start: place.start, end: place.end };
    }

    fn fail<T>(&self, kind: ParseErrorKind) -> Parsed<T> {
        Err(Box::new(ParseError { span: self.span, kind }))
    }

    fn whole(&mut self) -> Parsed {
        if self.token == Token::End {
            return self.fail(ParseErrorKind::Empty);
        }
        let tree = self.sum()?;
        match self.token {
            Token::End => Ok(tree),
            Token::Symbol(')') => self.fail(ParseErrorKind::Unmatched),
            _ => self.fail_after_operand(),
        }
    }

    /// The error for a token that cannot follow an operand.
    fn fail_after_operand<T>(&self) -> Parsed<T> {
        match self.token {
            Token::Unknown(character) => self.fail(ParseErrorKind::UnexpectedCharacter(character)),
            Token::Symbol(',') => self.fail(ParseErrorKind::StrayComma),
            _ => {
                let left = self.product_so_far();
                let found = excerpt(self.text, self.span);
                let right = if found == "(" { "(…)" } else { &found };
                let product = format!("{left}*{right}");
                self.fail(ParseErrorKind::ExpectedOperator { found, product })
            }
        }
    }

    /// The operand before the next token, with the factors that it multiplies or divides: `1/2` before `m` in
    /// `x + 1/2 m`.
    fn product_so_far(&self) -> String {
        let last = excerpt(self.text, self.last);
        if last == ")" {
            return "(…)".into();
        }
        let before = &self.text[..self.last.end];
        let mut input = LocatingSlice::new(before);
        let mut start = 0;
        while let Ok((token, place)) = token(&mut input) {
            match token {
                Token::End => break,
                // Behind a parenthesis the product goes on, but is shown from there.
                Token::Symbol('+' | '-' | ',' | '(' | ')') => start = place.end,
                _ => {}
            }
        }
        let product = before[start..].trim_start_matches([' ', '\t', '\r', '\n', '*', '/', '^']);
        if product.chars().count() > LONGEST_PRODUCT { last } else { product.into() }
    }

    fn sum(&mut self) -> Parsed {
        let first = self.product()?;
        let mut terms = Vec::new();
        while let Token::Symbol(symbol @ ('+' | '-')) = self.token {
            self.advance();
            let sign = if symbol == '+' { Sign::Plus } else { Sign::Minus };
            terms.push((sign, *self.product()?));
        }
        Ok(chain(first, Sign::Plus, terms, AstKind::Sum))
    }

    fn product(&mut self) -> Parsed {
        let first = self.unary()?;
        let mut factors = Vec::new();
        while let Token::Symbol(symbol @ ('*' | '/')) = self.token {
            self.advance();
            let factor = if symbol == '*' { Factor::Times } else { Factor::Over };
            factors.push((factor, *self.unary()?));
        }
        Ok(chain(first, Factor::Times, factors, AstKind::Product))
    }

    /// A signed operand; with a plus it is the operand itself.
    fn unary(&mut self) -> Parsed {
        let Token::Symbol(sign @ ('+' | '-')) = self.token else { return self.power() };
        let start = self.span.start;
        let mut operand = self.nested(Self::unary)?;
        let span = Span { start, end: operand.span.end };
        if sign == '+' {
            operand.span = span;
            return Ok(operand);
        }
        Ok(Box::new(Ast { span, kind: AstKind::Negate(operand) }))
    }

    fn power(&mut self) -> Parsed {
        let base = self.atom()?;
        if self.token != Token::Symbol('^') {
            return Ok(base);
        }
        let exponent = self.nested(Self::unary)?;
        let span = Span { start: base.span.start, end: exponent.span.end };
        Ok(Box::new(Ast { span, kind: AstKind::Power(base, exponent) }))
    }

    fn atom(&mut self) -> Parsed {
        match self.token {
            Token::Symbol('(') => self.parenthesis(),
            Token::Name(_) => self.name_or_call(),
            _ => self.leaf(),
        }
    }

    fn leaf(&mut self) -> Parsed {
        let span = self.span;
        let kind = match self.token {
            Token::Number(digits) => match digits.parse::<f64>() {
                Ok(value) if value.is_finite() => AstKind::Number(value),
                _ => return self.fail(ParseErrorKind::NumberOutOfRange),
            },
            Token::Name(name) => AstKind::Name(name.into()),
            Token::Velocity(name) => AstKind::Velocity(name.into()),
            Token::Unknown(character) => return self.fail(ParseErrorKind::UnexpectedCharacter(character)),
            Token::Symbol(symbol) => {
                let power = symbol == '*' && excerpt(self.text, self.last) == "*";
                let found = format!("`{symbol}`");
                return self.fail(ParseErrorKind::ExpectedExpression { found, power });
            }
            Token::End => {
                let found = "the end of the expression".into();
                return self.fail(ParseErrorKind::ExpectedExpression { found, power: false });
            }
        };
        self.advance();
        Ok(Box::new(Ast { span, kind }))
    }

    fn parenthesis(&mut self) -> Parsed {
        let open = self.span;
        let mut inner = self.nested(Self::sum)?;
        inner.span = Span { start: open.start, end: self.close(open)? };
        Ok(inner)
    }

    /// Steps over the `)` that belongs to the parenthesis at `open` and returns where it ends.
    fn close(&mut self, open: Span) -> Parsed<usize> {
        match self.token {
            Token::Symbol(')') => {
                let end = self.span.end;
                self.advance();
                Ok(end)
            }
            Token::End => Err(Box::new(ParseError { span: open, kind: ParseErrorKind::Unclosed })),
            _ => self.fail_after_operand(),
        }
    }

    /// A name, or a call when a parenthesis follows.
    fn name_or_call(&mut self) -> Parsed {
        let name = self.leaf()?;
        let AstKind::Name(text) = &name.kind else { return Ok(name) };
        let function = FUNCTIONS.iter().find(|function| function.name == text);
        match (function, self.token) {
            (Some(function), Token::Symbol('(')) => self.call(function, name.span),
            (Some(function), _) => {
                Err(Box::new(ParseError { span: name.span, kind: ParseErrorKind::NotCalled(*function) }))
            }
            (None, next) => {
                let declared = self.declared.iter().find(|function| function.name == *text);
                match (declared, next) {
                    (Some(function), Token::Symbol('(')) => self.declared_call(function, name.span),
                    (Some(function), _) => {
                        let kind = ParseErrorKind::DeclaredNotCalled(function.clone());
                        Err(Box::new(ParseError { span: name.span, kind }))
                    }
                    (None, Token::Symbol('(')) => {
                        Err(Box::new(unknown_function(text, name.span, self.declared)))
                    }
                    (None, _) => Ok(name),
                }
            }
        }
    }

    fn call(&mut self, function: &Function, place: Span) -> Parsed {
        let open = self.span;
        let mut arguments = self.nested(Self::arguments)?;
        let span = Span { start: place.start, end: self.close(open)? };
        let found = arguments.len();
        if found != function.arguments {
            let kind = ParseErrorKind::ArgumentCount { function: *function, found };
            return Err(Box::new(ParseError { span, kind }));
        }
        let kind = match (function.name, arguments.pop()) {
            ("d", Some(argument)) => AstKind::TotalDerivative(Box::new(argument)),
            (_, last) => {
                arguments.extend(last);
                AstKind::Call(function.name.into(), place, arguments)
            }
        };
        Ok(Box::new(Ast { span, kind }))
    }

    fn declared_call(&mut self, function: &Declared, place: Span) -> Parsed {
        let open = self.span;
        let arguments = self.nested(Self::arguments)?;
        let span = Span { start: place.start, end: self.close(open)? };
        let found = arguments.len();
        if found != function.arguments.len() {
            let kind = ParseErrorKind::DeclaredArgumentCount { function: function.clone(), found };
            return Err(Box::new(ParseError { span, kind }));
        }
        Ok(Box::new(Ast { span, kind: AstKind::Call(function.name.clone(), place, arguments) }))
    }

    fn arguments(&mut self) -> Parsed<Vec<Ast>> {
        if self.token == Token::Symbol(')') {
            return Ok(Vec::new());
        }
        let mut arguments = vec![*self.sum()?];
        while self.token == Token::Symbol(',') {
            self.advance();
            arguments.push(*self.sum()?);
        }
        Ok(arguments)
    }

    /// Steps over the token that opens a level and parses what is inside.
    fn nested<T>(&mut self, inside: fn(&mut Self) -> Parsed<T>) -> Parsed<T> {
        if self.depth == MAX_DEPTH {
            return self.fail(ParseErrorKind::TooDeep);
        }
        self.advance();
        self.depth += 1;
        let result = inside(self);
        self.depth -= 1;
        result
    }
}

/// `first` alone, or the list that it begins.
fn chain<S>(first: Box<Ast>, sign: S, rest: Vec<(S, Ast)>, kind: fn(Vec<(S, Ast)>) -> AstKind) -> Box<Ast> {
    let Some((_, last)) = rest.last() else { return first };
    let span = Span { start: first.span.start, end: last.span.end };
    let list = std::iter::once((sign, *first)).chain(rest).collect();
    Box::new(Ast { span, kind: kind(list) })
}

/// The error for a call of something that is not a function.
fn unknown_function(name: &str, span: Span, declared: &[Declared]) -> ParseError {
    let other = OTHER_NAMES.iter().find(|(other, _)| *other == name).map(|(_, ours)| *ours);
    let ours = FUNCTIONS.iter().map(|function| function.name);
    let theirs = declared.iter().map(|function| function.name.as_str());
    let nearest = other.or_else(|| nearest(name, ours.chain(theirs))).map(str::to_owned);
    let name = excerpt(name, Span { start: 0, end: name.len() });
    ParseError { span, kind: ParseErrorKind::UnknownFunction { name, nearest } }
}

/// The text at `span`, cut to a length that fits into a message.
fn excerpt(text: &str, span: Span) -> String {
    let whole = text.get(span.start..span.end).unwrap_or_default();
    match whole.char_indices().nth(40) {
        Some((cut, _)) => format!("{}…", &whole[..cut]),
        None => whole.into(),
    }
}
