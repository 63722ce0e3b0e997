//! The expression parser: precedence, spans, every message, limits, and arbitrary input.

use pc_expr::parse::{Ast, AstKind, FUNCTIONS, Factor, MAX_DEPTH, Sign, Span, is_name, nearest, parse};
use proptest::prelude::*;

/// The tree with a parenthesis around everything that has parts.
fn grouped(ast: &Ast) -> String {
    match &ast.kind {
        AstKind::Number(value) => format!("{value:?}"),
        AstKind::Name(name) => name.clone(),
        AstKind::Velocity(name) => format!("{name}'"),
        AstKind::TotalDerivative(inner) => format!("d({})", grouped(inner)),
        AstKind::Negate(inner) => format!("(-{})", grouped(inner)),
        AstKind::Power(base, exponent) => format!("({}^{})", grouped(base), grouped(exponent)),
        AstKind::Call(name, _, arguments) => {
            let arguments: Vec<_> = arguments.iter().map(grouped).collect();
            format!("{name}({})", arguments.join(", "))
        }
        AstKind::Sum(terms) => list(terms, |sign| if sign == Sign::Plus { " + " } else { " - " }),
        AstKind::Product(factors) => list(factors, |side| if side == Factor::Times { "*" } else { "/" }),
    }
}

fn list<S: Copy>(parts: &[(S, Ast)], operator: fn(S) -> &'static str) -> String {
    let mut text = String::from("(");
    for (i, (sign, part)) in parts.iter().enumerate() {
        text.push_str(if i == 0 { "" } else { operator(*sign) });
        text.push_str(&grouped(part));
    }
    text + ")"
}

#[test]
fn precedence() {
    let table = [
        ("1", "1.0"),
        ("1.5e-3", "0.0015"),
        (".5", "0.5"),
        ("1.", "1.0"),
        ("1e5", "100000.0"),
        ("2E+1", "20.0"),
        ("x'", "x'"),
        ("θ_1' + Ω", "(θ_1' + Ω)"),
        ("a + b - c", "(a + b - c)"),
        ("+a", "a"),
        ("2*+a", "(2.0*a)"),
        ("2^+1", "(2.0^1.0)"),
        ("a + +b - +-c", "(a + b - (-c))"),
        ("+a^2", "(a^2.0)"),
        ("-+a", "(-a)"),
        ("a - (b - c)", "(a - (b - c))"),
        ("(a + b) + c", "((a + b) + c)"),
        ("a*b/c*d1", "(a*b/c*d1)"),
        ("a/(b/c)", "(a/(b/c))"),
        ("a + b*c^2", "(a + (b*(c^2.0)))"),
        ("-x^2", "(-(x^2.0))"),
        ("(-x)^2", "((-x)^2.0)"),
        ("2^-1", "(2.0^(-1.0))"),
        ("2^-x^2", "(2.0^(-(x^2.0)))"),
        ("2*-a", "(2.0*(-a))"),
        ("a - -b", "(a - (-b))"),
        ("--a", "(-(-a))"),
        ("a^b^c", "(a^(b^c))"),
        ("(a^b)^c", "((a^b)^c)"),
        ("-a*b", "((-a)*b)"),
        ("d(x*y)", "d((x*y))"),
        ("sin(x)^2", "(sin(x)^2.0)"),
        ("atan2(-y, x)", "atan2((-y), x)"),
        ("step(t - 1, 0, min(a, b))", "step((t - 1.0), 0.0, min(a, b))"),
        ("m/2*(x'^2 + y'^2)", "(m/2.0*((x'^2.0) + (y'^2.0)))"),
        ("\t(\r\n x )\n", "x"),
        ("pi*t", "(pi*t)"),
    ];
    for (text, expected) in table {
        assert_eq!(grouped(&parse(text).unwrap()), expected, "{text}");
    }
}

/// All spans of the tree, outermost first, as the text they cover.
fn covered<'a>(ast: &Ast, text: &'a str, out: &mut Vec<&'a str>) {
    out.push(&text[ast.span.start..ast.span.end]);
    match &ast.kind {
        AstKind::Number(_) | AstKind::Name(_) | AstKind::Velocity(_) => {}
        AstKind::TotalDerivative(inner) | AstKind::Negate(inner) => covered(inner, text, out),
        AstKind::Power(base, exponent) => {
            covered(base, text, out);
            covered(exponent, text, out);
        }
        AstKind::Call(name, place, arguments) => {
            assert_eq!(name, &text[place.start..place.end]);
            arguments.iter().for_each(|argument| covered(argument, text, out));
        }
        AstKind::Sum(terms) => terms.iter().for_each(|(_, term)| covered(term, text, out)),
        AstKind::Product(factors) => factors.iter().for_each(|(_, factor)| covered(factor, text, out)),
    }
}

#[test]
fn spans() {
    let text = " (a + θ') * sin( 2 )^-x";
    let mut pieces = Vec::new();
    covered(&parse(text).unwrap(), text, &mut pieces);
    let expected =
        ["(a + θ') * sin( 2 )^-x", "(a + θ')", "a", "θ'", "sin( 2 )^-x", "sin( 2 )", "2", "-x", "x"];
    assert_eq!(pieces, expected);
}

/// `text` fails at the part of it that `marked` covers with `^`, with this message and help.
fn fails(text: &str, marked: &str, message: &str, help: &str) {
    let Err(error) = parse(text) else { panic!("{text} is an expression") };
    let Span { start, end } = error.span;
    let before = text[..start].chars().count();
    let width = text[start..end].chars().count();
    let carets = " ".repeat(before) + &"^".repeat(width);
    let found = (carets.as_str(), error.to_string(), error.help());
    assert_eq!(found, (marked, message.into(), help.into()), "{text}");
}

#[test]
#[rustfmt::skip]
fn messages() {
    let operand = "a number, a name, a function call or a parenthesis should stand here";
    let signs = "expressions are made of numbers, names, `+ - * / ^`, parentheses and commas";
    let commas = "commas stand between the arguments of a function; the decimal separator is a point";
    fails("", "", "the expression is empty", "write a number, such as `0`, or an expression");
    fails(" ", " ", "the expression is empty", "write a number, such as `0`, or an expression");
    fails("()", " ^", "expected an expression, found `)`", operand);
    fails("a + ", "    ", "expected an expression, found the end of the expression", operand);
    fails("a + +", "     ", "expected an expression, found the end of the expression", operand);
    fails("a + * b", "    ^", "expected an expression, found `*`", operand);
    fails("min(, b)", "    ^", "expected an expression, found `,`", operand);
    fails("x**2", "  ^", "expected an expression, found `*`", "a power is written with `^`, as in `x^2`");
    fails("(a + b", "^", "unclosed parenthesis", "close it with `)`");
    fails("2*sin(a", "     ^", "unclosed parenthesis", "close it with `)`");
    fails("((a) + b", "^", "unclosed parenthesis", "close it with `)`");
    fails("a)", " ^", "unmatched `)`", "remove it, or open a parenthesis before it");
    fails("(a, b)", "  ^", "unexpected `,`", commas);
    fails("1,5", " ^", "unexpected `,`", commas);
    fails("a $ b", "  ^", "unexpected character `$`", signs);
    fails("a + $", "    ^", "unexpected character `$`", signs);
    fails("a\u{0}b", " ^", r"unexpected character `\0`", signs);
    fails("a − b", "  ^", "unexpected character `−`", "minus is written `-`");
    fails("a·b", " ^", "unexpected character `·`", "multiplication is written `*`");
    fails("a÷b", " ^", "unexpected character `÷`", "division is written `/`");
    fails("a²", " ^", "unexpected character `²`", "a power is written with `^`, as in `x^2`");
    fails("x''", "  ^", "unexpected character `'`", "the velocity of the coordinate `x` is written `x'`, its acceleration `d(x')`");
    fails("[a + b]", "^", "unexpected character `[`", "only the parentheses `(` and `)` group");
    fails("a = b", "  ^", "unexpected character `=`", "an expression is not an equation; write the difference of the two sides");
    fails("ϕ", "^", "unexpected character `ϕ`", "write `φ`");
    fails("ϑ", "^", "unexpected character `ϑ`", "write `θ`");
    fails("µ", "^", "unexpected character `µ`", "write `μ`");
    fails("2 y", "  ^", "expected an operator before `y`", "multiplication is written `2*y`");
    fails("2y", " ^", "expected an operator before `y`", "multiplication is written `2*y`");
    fails("2(y + 1)", " ^", "expected an operator before `(`", "multiplication is written `2*(…)`");
    fails("(a)(b)", "   ^", "expected an operator before `(`", "multiplication is written `(…)*(…)`");
    fails("sin(x y')", "      ^^", "expected an operator before `y'`", "multiplication is written `x*y'`");
    fails("1/2 m x'^2", "    ^", "expected an operator before `m`", "multiplication is written `1/2*m`");
    fails("a + x^2 y", "        ^", "expected an operator before `y`", "multiplication is written `x^2*y`");
    fails("(a + b)*1e-3 y", "             ^", "expected an operator before `y`", "multiplication is written `1e-3*y`");
    fails("1.2.3", "   ^^", "expected an operator before `.3`", "multiplication is written `1.2*.3`");
    fails("1 + 2e999", "    ^^^^^", "number out of range", "the largest number is about 1.8e308");
    fails("a + sni(x)", "    ^^^", "unknown function `sni`", "did you mean `sin`?");
    fails("ln(x)", "^^", "unknown function `ln`", "did you mean `log`?");
    fails("ctg(x)", "^^^", "unknown function `ctg`", "did you mean `cot`?");
    fails("arctan(x)", "^^^^^^", "unknown function `arctan`", "did you mean `atan`?");
    fails("m(x)", "^", "unknown function `m`", "the functions are sin, cos, tan, cot, asin, acos, atan, atan2, sinh, cosh, tanh, exp, log, sqrt, abs, sign, min, max, step, d; multiplication is written `m*(…)`");
    fails("sin x", "^^^", "the function `sin` needs its arguments", "it is written `sin(x)`");
    fails("d*x", "^", "the function `d` needs its arguments", "it is written `d(x)`");
    fails("1 + sin()", "    ^^^^^", "`sin` takes 1 argument, found 0", "it is written `sin(x)`");
    fails("d(x, y)", "^^^^^^^", "`d` takes 1 argument, found 2", "it is written `d(x)`");
    fails("atan2(x) + 1", "^^^^^^^^", "`atan2` takes 2 arguments, found 1", "it is written `atan2(y, x)`");
    fails("step(x, 1)", "^^^^^^^^^^", "`step` takes 3 arguments, found 2", "it is written `step(x, a, b)`");
}

#[test]
fn nesting_is_bounded() {
    let deepest = "(".repeat(MAX_DEPTH) + "x" + &")".repeat(MAX_DEPTH);
    assert_eq!(grouped(&parse(&deepest).unwrap()), "x");
    let openings = ["(", "-", "2^", "sin(", "d(", "x*(", "max(1, ", "2^-("];
    for opening in openings {
        let error = parse(&opening.repeat(10_000)).unwrap_err();
        assert_eq!(error.to_string(), "the expression is nested deeper than 200 levels");
        assert_eq!(error.help(), "name the inner parts and use their names");
    }
    let error = parse(&"(".repeat(MAX_DEPTH + 1)).unwrap_err();
    assert_eq!(error.span, Span { start: MAX_DEPTH, end: MAX_DEPTH + 1 });
}

#[test]
fn length_is_not_bounded() {
    let sum = vec!["x"; 100_000].join(" + ");
    let AstKind::Sum(terms) = parse(&sum).unwrap().kind else { panic!("not a sum") };
    assert_eq!(terms.len(), 100_000);
    let product = vec!["x"; 100_000].join("/");
    let AstKind::Product(factors) = parse(&product).unwrap().kind else { panic!("not a product") };
    assert_eq!(factors.len(), 100_000);
    let name = "x".repeat(1_000_000);
    assert_eq!(parse(&name).unwrap().kind, AstKind::Name(name.clone()));
    let called = parse(&(name + "(1)")).unwrap_err().to_string();
    assert_eq!(called, format!("unknown function `{}…`", "x".repeat(40)));
    assert!(parse(&"9".repeat(1_000_000)).is_err());
    assert!(parse(&"0".repeat(1_000_000)).is_ok());
    assert!(parse(&"$".repeat(1_000_000)).is_err());
}

#[test]
fn words() {
    for good in ["x", "_", "x_1", "θ", "Ω2", "J0"] {
        assert!(is_name(good), "{good}");
    }
    for bad in ["", "1x", "x'", "x y", "x-y", "ё", "x₁", "ϕ"] {
        assert!(!is_name(bad), "{bad}");
    }
    assert_eq!(nearest("kinetik", ["kinetic", "potential"]), Some("kinetic"));
    assert_eq!(nearest("laggrangain", ["lagrangian", "model"]), Some("lagrangian"));
    assert_eq!(nearest("x", ["y"]), None);
    assert_eq!(nearest("", ["y"]), None);
}

fn ast(kind: AstKind) -> Ast {
    Ast { span: Span { start: 0, end: 0 }, kind }
}

/// Any tree in the range of the parser.
fn trees() -> impl Strategy<Value = Ast> {
    let name = "[a-zα-ω_][a-z0-9_Α-Ω]{0,3}"
        .prop_filter("a function", |name| FUNCTIONS.iter().all(|function| function.name != name));
    let leaf = prop_oneof![
        (0.0..1e300).prop_map(AstKind::Number),
        any::<u16>().prop_map(|n| AstKind::Number(n.into())),
        name.clone().prop_map(AstKind::Name),
        name.prop_map(AstKind::Velocity),
    ];
    leaf.prop_map(ast).prop_recursive(6, 64, 4, |inner| {
        let boxed = || inner.clone().prop_map(Box::new);
        let several = || prop::collection::vec((any::<bool>(), inner.clone()), 2..5);
        let called = (0..FUNCTIONS.len() - 1, prop::collection::vec(inner.clone(), 3));
        let kind = prop_oneof![
            boxed().prop_map(AstKind::TotalDerivative),
            boxed().prop_map(AstKind::Negate),
            (boxed(), boxed()).prop_map(|(base, exponent)| AstKind::Power(base, exponent)),
            several().prop_map(|parts| AstKind::Sum(signed(parts, Sign::Plus, Sign::Minus))),
            several().prop_map(|parts| AstKind::Product(signed(parts, Factor::Times, Factor::Over))),
            called.prop_map(|(index, mut arguments)| {
                let function = FUNCTIONS[index];
                arguments.truncate(function.arguments);
                AstKind::Call(function.name.into(), Span { start: 0, end: 0 }, arguments)
            }),
        ];
        kind.prop_map(ast)
    })
}

fn signed<S: Copy>(parts: Vec<(bool, Ast)>, first: S, other: S) -> Vec<(S, Ast)> {
    let signs = parts.into_iter().enumerate();
    signs.map(|(i, (changed, part))| (if i > 0 && changed { other } else { first }, part)).collect()
}

/// The tree with all spans empty.
fn bare(tree: &Ast) -> Ast {
    ast(match &tree.kind {
        leaf @ (AstKind::Number(_) | AstKind::Name(_) | AstKind::Velocity(_)) => leaf.clone(),
        AstKind::TotalDerivative(inner) => AstKind::TotalDerivative(Box::new(bare(inner))),
        AstKind::Negate(inner) => AstKind::Negate(Box::new(bare(inner))),
        AstKind::Power(base, exponent) => AstKind::Power(Box::new(bare(base)), Box::new(bare(exponent))),
        AstKind::Sum(terms) => AstKind::Sum(terms.iter().map(|(sign, part)| (*sign, bare(part))).collect()),
        AstKind::Product(factors) => {
            AstKind::Product(factors.iter().map(|(side, part)| (*side, bare(part))).collect())
        }
        AstKind::Call(name, _, arguments) => {
            let arguments = arguments.iter().map(bare).collect();
            AstKind::Call(name.clone(), Span { start: 0, end: 0 }, arguments)
        }
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(500) })]

    #[test]
    fn printing_and_parsing_give_the_tree_back(tree in trees()) {
        prop_assert_eq!(bare(&parse(&grouped(&tree)).unwrap()), tree);
    }

    #[test]
    fn any_text_is_a_tree_or_an_error_within_the_text(text in any::<String>()) {
        if let Err(error) = parse(&text) {
            prop_assert!(text.get(error.span.start..error.span.end).is_some());
        }
    }

    #[test]
    fn likely_text_is_a_tree_or_an_error_within_the_text(text in "([-+*/^(),' ]|sin|max|d|x'?|[0-9.e]){0,30}") {
        match parse(&text) {
            Ok(tree) => prop_assert!(text.get(tree.span.start..tree.span.end).is_some()),
            Err(error) => {
                prop_assert!(text.get(error.span.start..error.span.end).is_some());
                prop_assert!(!error.help().is_empty());
            }
        }
    }
}
