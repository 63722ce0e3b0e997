//! Expressions as text: as a book would write them, and readable back.

use crate::common::{Bounded, trees};
use pc_expr::parse::{Ast, AstKind, Factor, Sign, parse};
use pc_expr::{Expr, Folding, Function, Graph, Polynomial, Scalar, Side, Style};
use proptest::prelude::*;

/// The value of a syntax tree.
fn value(ast: &Ast, name: &impl Fn(&str) -> Bounded) -> Bounded {
    let of = |ast: &Ast| value(ast, name);
    match &ast.kind {
        AstKind::Number(x) => Bounded::from_f64(*x),
        AstKind::Name(symbol) => name(symbol),
        AstKind::Negate(x) => -of(x),
        AstKind::Sum(terms) => terms.iter().fold(Bounded::exact(0.0), |sum, (sign, term)| {
            sum + if *sign == Sign::Plus { of(term) } else { -of(term) }
        }),
        AstKind::Product(factors) => factors.iter().fold(Bounded::exact(1.0), |product, (side, factor)| {
            let factor = of(factor);
            product * if *side == Factor::Times { factor } else { Scalar::powi(factor, -1) }
        }),
        AstKind::Power(base, exponent) => {
            let exponent = of(exponent);
            if exponent.error == 0.0 && exponent.value.fract() == 0.0 && exponent.value.abs() < 1e9 {
                Scalar::powi(of(base), exponent.value as i32)
            } else {
                Scalar::call(Function::Pow, &[of(base), exponent])
            }
        }
        AstKind::Call(function, _, args) => {
            let function = Function::ALL.into_iter().find(|f| f.name() == function).unwrap();
            Scalar::call(function, &args.iter().map(of).collect::<Vec<_>>())
        }
        AstKind::Velocity(_) | AstKind::TotalDerivative(_) => unreachable!("the graph prints no {ast:?}"),
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 2000,
        rng_seed: prop::test_runner::RngSeed::Fixed(5),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn printed_expressions_are_read_back(tree in trees(3), point in prop::array::uniform3(-2.0..2.0)) {
        for folding in [Folding::ByValue, Folding::Structural] {
            let graph = Graph::with_folding(folding);
            let symbols = graph.symbols(["x", "y", "z"]);
            let expr = tree.expr(&symbols);
            let all = [expr, expr.derivative(symbols[0]), -expr, (expr - 0.5).powi(-3), expr.pow(expr)];
            for expr in all.into_iter().filter(|e| !e.is_undefined()) {
                let text = expr.to_string();
                prop_assert!(!text.contains("--") && !text.contains("- -") && !text.contains("+ -"), "{text}");
                let values: Vec<(Expr, Bounded)> =
                    symbols.iter().zip(point).map(|(&s, x)| (s, Bounded::exact(x))).collect();
                let ours = graph.evaluate(&[expr], &values).unwrap()[0];
                let name = |name: &str| values.iter().find(|(s, _)| s.to_string() == name).unwrap().1;
                let read = value(&parse(&text).unwrap(), &name);
                if ours.size().is_finite() && read.size().is_finite() {
                    let tolerance = 10.0 * f64::EPSILON * (ours.size() + read.size());
                    prop_assert!((ours.value - read.value).abs() <= tolerance, "{text}: {ours:?}, read {read:?}");
                }
            }
        }
    }
}

#[test]
fn texts() {
    let graph = Graph::new();
    let [m, v, x, y, z] = graph.symbols(["m", "v", "x", "y", "z"]);
    let [a2, a3] = graph.symbols(["A2", "A3"]);
    let table = [
        (a2 - a3, "A2 - A3"),
        (-(a2 - a3), "A3 - A2"),
        (m * v * v / 2.0, "1/2*m*v^2"),
        (-m * v * v / 2.0, "-1/2*m*v^2"),
        (-x, "-x"),
        (-(x + y), "-x - y"),
        (-2.0 * (x + y), "-2*(x + y)"),
        (2.0 * (x - y), "2*(x - y)"),
        (x - (y - z), "x - y + z"),
        (x / (y * z), "x/(y*z)"),
        (x / y * z, "x*z/y"),
        (x / y / z / 2.0, "x/(2*y*z)"),
        (2.0 / x, "2/x"),
        (Expr::ratio(2, 3) / x, "2/(3*x)"),
        (-1.0 / x, "-1/x"),
        (0.3 / x, "0.3/x"),
        (x.powi(-2), "1/x^2"),
        (x / 3.0, "1/3*x"),
        (0.7 * x, "0.7*x"),
        ((x + y).square(), "(x + y)^2"),
        ((x + y) * (x - y) * z, "z*(x + y)*(x - y)"),
        ((x + y) / (x - y), "(x + y)/(x - y)"),
        (1.0 - x * x, "1 - x^2"),
        (x * y - 0.5, "x*y - 1/2"),
        (x / 2.0 + y, "1/2*x + y"),
        ((x + y) / 2.0, "1/2*(x + y)"),
        (y.powi(4) + x.square() * y + x.powi(3) - 1.0, "x^3 + x^2*y + y^4 - 1"),
        (m * 9.81 * x.sin(), "9.81*m*sin(x)"),
        (x * (a2 - a3) * y + z * x.cos(), "x*y*(A2 - A3) + z*cos(x)"),
        (-x.sin() * y, "-y*sin(x)"),
        ((-x).exp(), "exp(-x)"),
        (x.sin().square() * y, "y*sin(x)^2"),
        (y.sqrt() * 3.0, "3*sqrt(y)"),
        (x.pow(1.5), "x*sqrt(x)"),
        (x.pow(0.3), "x^0.3"),
        (x.pow(-0.3), "x^(-0.3)"),
        (x.pow(Expr::ratio(1, 3)), "x^(1/3)"),
        (x.pow(y), "x^y"),
        (x.pow(y).pow(z), "(x^y)^z"),
        (x.pow(y.pow(z)), "x^(y^z)"),
        ((x * y).pow(y + 1.0), "(x*y)^(y + 1)"),
        (Expr::from(2.0).pow(x), "2^x"),
        (Expr::from(0.5).pow(-x), "(1/2)^(-x)"),
        (x.atan2(y), "atan2(x, y)"),
        ((x - 1.0).step(y, 0.0), "step(x - 1, y, 0)"),
        (1.0 / (1.0 / x + 1.0 / y), "1/(1/x + 1/y)"),
        (6.674e-11 * x, "6.674e-11*x"),
        (1e300 * x, "1e300*x"),
        (x * 0.0, "0"),
        (Expr::ratio(-1, 3), "-1/3"),
    ];
    for (expr, text) in table {
        assert_eq!(expr.to_string(), text);
    }
}

#[test]
fn expressions_as_a_book_sets_them() {
    let graph = Graph::new();
    let [m, v, x, gamma1] = graph.symbols(["m", "v", "x", "γ1"]);
    for (expr, text) in [
        (m * v.square() / 2.0, "½ m v²"),
        (-x.powi(12) * 0.75, "-¾ x¹²"),
        (x.sin().square() * v - m, "v sin(x)² - m"),
        ((x + v).powi(3) / (2.0 * m), "(v + x)³/(2 m)"),
        (m * (v - x) * gamma1.cos(), "m cos(γ1) (v - x)"),
        (x.pow(0.3) + x.exp().powi(2) / 3.0, "x^0.3 + ⅓ exp(x)²"),
        (Expr::from(0.5).pow(-x), "½^(-x)"),
        (5.0 * x / 7.0, "5/7 x"),
    ] {
        assert_eq!(expr.display(Style::Book), text);
    }
}

#[test]
fn latex_keeps_the_meaning() {
    let graph = Graph::new();
    let [a, b, e, x, y, theta] = graph.symbols(["a", "b", "e", "x", "y", "θ"]);
    for (expr, text) in [
        (x.sin(), "\\sin x"),
        (y.log().square(), "\\log^{2} y"),
        (y.square().log(), "\\log y^{2}"),
        ((x + y).log().powi(3), "\\log^{3}\\left(x + y\\right)"),
        (x.log() / x, "\\frac{\\log x}{x}"),
        (
            b.square() * x.sin() * (a + y.exp()),
            "b^{2} \\sin\\left(x\\right) \\left(a + \\mathrm{e}^{y}\\right)",
        ),
        (x.cosh() * (2.0 * y).exp(), "\\cosh\\left(x\\right) \\mathrm{e}^{2 y}"),
        (x.cos() * x.sin(), "\\sin x \\cos x"),
        (theta.cos().square() * y.sqrt(), "\\cos^{2}\\left(\\theta\\right) \\sqrt{y}"),
        (theta.cos().pow(e) * (y + 1.0).sqrt(), "\\cos^{e}\\left(\\theta\\right) \\sqrt{y + 1}"),
        (y.tanh() * x.abs(), "\\tanh\\left(y\\right) \\left|x\\right|"),
        (x.sin() * (a - b) / y, "\\frac{\\sin\\left(x\\right) \\left(a - b\\right)}{y}"),
        (x.sin() + y, "y + \\sin x"),
        ((a * x).sin() * b.exp(), "\\sin\\left(a x\\right) \\mathrm{e}^{b}"),
        (e * y.exp(), "e \\mathrm{e}^{y}"),
        (y.exp().square() * x, "x \\mathrm{e}^{2 y}"),
        (x.sin().atan(), "\\arctan\\left(\\sin x\\right)"),
    ] {
        assert_eq!(expr.display(Style::Latex), text);
    }
}

/// A break within a bracket keeps the meaning: \sin x (a − b) is read as sin(x (a − b)).
#[test]
fn brackets_across_lines_keep_the_meaning() {
    let graph = Graph::with_folding(Folding::Structural);
    let [a, b, x, m_1] = graph.symbols(["a", "b", "x", "m_1"]);
    let factor = x.sin() * (a + b.square());
    for (line, terms) in [
        (factor, vec!["\\sin\\left(x\\right) \\Bigl(a", "+ b^{2}\\Bigr)"]),
        (-factor, vec!["-\\sin\\left(x\\right) \\Bigl(a", "+ b^{2}\\Bigr)"]),
        (-2.0 * m_1 * (a - b), vec!["2\\, m_{1}\\, \\Bigl(b", "- a\\Bigr)"]),
    ] {
        let names = graph.names(&[Side::Sum(line)], &[], 80);
        assert_eq!(names.written(Style::Latex).terms(line), terms);
        assert!(!line.display(Style::Latex).contains("Bigl"), "within others it is whole");
    }
}

/// Ten thousand nested brackets: short when written out, long if each part is written separately.
#[test]
fn deep_expressions_are_printed_compactly() {
    let graph = Graph::with_folding(Folding::Structural);
    let symbols: Vec<Expr> = (0..9_000).map(|i| graph.symbol(&format!("x{i}"))).collect();
    let deep = symbols.iter().fold(graph.symbol("y"), |sum, &x| (sum + 1.0) * x);
    let text = deep.to_string();
    assert!(text.contains(" where z1 = ") && text.len() < 1 << 20, "{} bytes", text.len());
}

/// A subtracted sum is negated where it subtracts at least as much as it adds: l (g − f), not −l (f − g).
#[test]
fn differences_are_subtracted_the_other_way_round() {
    let graph = Graph::new();
    let [a, f, g, l, p] = graph.symbols(["a", "f", "g", "l", "p"]);
    let book = |e: Expr<'_>| e.display(Style::Book);
    assert_eq!(book(p - l * (f - g)), "l (g - f) + p");
    assert_eq!(book(-l * (f - g) - p * (a - f)), "l (g - f) + p (f - a)");
    assert_eq!(book(p - l * (a + f - g)), "p - l (a + f - g)");
    assert_eq!(book((p - f - g) * l * -1.0), "l (f + g - p)");
    assert_eq!(book((a * p - f - g) / -2.0), "½ (f - a p + g)");
    assert_eq!(book(a - (f - g)), "a - f + g");
    // Terms stay separate, so that a line may end between them.
    let page = graph.page(Folding::Structural);
    let [f, g, l] = page.symbols(["f", "g", "l"]);
    let negative = -(l * f.sin() - g * l.cos() + f.powi(2));
    let names = page.names(&[Side::Sum(negative)], &[], 80);
    assert_eq!(names.written(Style::Book).terms(negative).len(), 3);
}

/// Printed forms have 1 − x under a root and as a divisor.
#[test]
fn differences_from_numbers_begin_with_the_number_on_paper() {
    let page = Graph::with_folding(Folding::Structural);
    let [v, c] = page.symbols(["v", "c"]);
    let w = 1.0 - v.square() / c.square();
    assert_eq!((v / w.sqrt() / w).display(Style::Book), "v/(sqrt(1 - v²/c²) (1 - v²/c²))");
    assert_eq!((c * (v.square() - 1.0)).display(Style::Book), "c (v² - 1)");
}

/// J (x − y) sin ε where that is shorter than J x sin ε − J y sin ε.
#[test]
fn monomials_of_one_coefficient_are_collected() {
    let graph = Graph::new();
    let [e, j, u, x, y, z] = graph.symbols(["e", "j", "u", "x", "y", "z"]);
    let page = graph.page(Folding::Structural);
    page.symbols(["e", "j", "u", "x", "y", "z"]);
    let written = |expression: Expr<'_>| {
        let polynomial = graph.polynomial(expression, &[u, x, y, z]).unwrap();
        Polynomial::expanded(&[polynomial], &graph, &page)[0].display(Style::Book)
    };
    assert_eq!(written(j * e.sin() * u * (x + y - z)), "j u sin(e) (x + y - z)");
    assert_eq!(written(j * e.sin() * u * (x + y) + j * e.cos() * u * z), "j u z cos(e) + j u sin(e) (x + y)");
}

/// The row of MathML in short: tags without `m`, invisible operators as ⁢ (times) and ⁡ (applied to).
fn short(row: &str) -> String {
    let invisible =
        [("<mo>&#x2062;</mo>", "·"), ("<mo>&#x2061;</mo>", "@"), ("<mspace width=\"0.17em\"/>", "~")];
    let short = invisible.iter().fold(row.to_owned(), |row, (long, short)| row.replace(long, short));
    let short = short.replace("<mo>", "").replace("</mo>", "");
    ["mi", "mn"]
        .iter()
        .fold(short, |row, tag| row.replace(&format!("<{tag}>"), "{").replace(&format!("</{tag}>"), "}"))
}

#[test]
fn mathml_has_the_structure_of_the_expression() {
    let graph = Graph::with_folding(Folding::Structural);
    let [a, b, x, y, omega, theta] = graph.symbols(["a", "b", "x", "y", "ω1", "th"]);
    let [rate, second, momentum, long] = graph.symbols(["x'", "φ_2''", "p_ω1", "mass"]);
    let half = 0.5 * omega.square();
    for (expr, row) in [
        (omega, "<msub>{ω}{1}</msub>"),
        (theta, "{θ}"),
        (rate, "<mover>{x}˙</mover>"),
        (second, "<msub><mover>{φ}¨</mover>{2}</msub>"),
        (momentum, "<msub>{p}<msub>{ω}{1}</msub></msub>"),
        (half, "<mfrac>{1}{2}</mfrac>·~<msubsup>{ω}{1}{2}</msubsup>"),
        (long * a, "{a}·~{mass}"),
        (a - b, "{a} −{b}"),
        (-(a + b).square(), "−<msup><mrow>({a} +{b})</mrow>{2}</msup>"),
        (a / (b + x), "<mfrac>{a}<mrow>{b} +{x}</mrow></mfrac>"),
        (theta.sin() * theta.cos(), "{sin}@~{θ}·~{cos}@~{θ}"),
        (x.sin() * (a - b), "{sin}@<mrow>({x})</mrow>·~<mrow>({a} −{b})</mrow>"),
        (theta.cos().square(), "<msup>{cos}{2}</msup>@~{θ}"),
        (theta.cos().square() * (a - b), "<msup>{cos}{2}</msup>@<mrow>({θ})</mrow>·~<mrow>({a} −{b})</mrow>"),
        // The outer call has brackets, which the inner one does without.
        (x.cos().tanh() * (a - b), "{tanh}@<mrow>({cos}@~{x})</mrow>·~<mrow>({a} −{b})</mrow>"),
        ((a + b).sqrt(), "<msqrt>{a} +{b}</msqrt>"),
        (x.abs() * y, "{y}·<mrow>|{x}|</mrow>"),
        (x.exp(), "<msup><mi mathvariant=\"normal\">e}{x}</msup>"),
        ((a * x).exp(), "<msup><mi mathvariant=\"normal\">e}<mrow>{a}·{x}</mrow></msup>"),
        (x.asin(), "{arcsin}@<mrow>({x})</mrow>"),
        (Expr::from(1e-20) * x, "{1}⋅<msup>{10}{−20}</msup>·{x}"),
        (Expr::from(-2.0), "−{2}"),
    ] {
        assert_eq!(short(&expr.display(Style::MathMl)), row, "{expr}");
    }
}

#[test]
fn no_name_breaks_out_of_mathml() {
    let graph = Graph::new();
    let [hostile] = graph.symbols(["λ_</mi><script>&\"\u{0}\n"]);
    let row = hostile.display(Style::MathMl);
    assert_eq!(row, "<msub><mi>λ</mi><mi>&lt;/mi&gt;&lt;script&gt;&amp;&quot;\u{fffd} </mi></msub>");
}

/// Each line is complete by itself: elements are closed in it, brackets across lines do not grow.
#[test]
fn lines_of_mathml_are_complete() {
    let graph = Graph::with_folding(Folding::Structural);
    let [a, b, x] = graph.symbols(["a", "b", "x"]);
    let line = -x.sin() * (a + b.square() / x);
    let terms = graph.names(&[Side::Sum(line)], &[], 80).written(Style::MathMl).terms(line);
    assert_eq!(terms.len(), 2, "{terms:?}");
    for term in &terms {
        let tags = |start: &str| term.matches(start).count();
        assert_eq!(tags("<m") - tags("<mspace"), tags("</m"), "{term}");
    }
    assert!(terms[0].starts_with("<mo>−</mo><mi>sin</mi>"), "{}", terms[0]);
    assert!(terms[1].starts_with("<mo>+</mo>") && terms[1].ends_with("<mo stretchy=\"false\">)</mo>"));
}
