//! The text of a model: how it is read, every refusal in full, and arbitrary input.

use pc_expr::parse::{Ast, AstKind, Span};
use pc_expr::{Direction, Method};
use pc_model::document::{
    AlgebraDefinition, DeclaredKind, Expression, Inertia, NamedExpression, Orientation,
};
use pc_model::{Category, Document, ErrorKind, Source, Variables};
use proptest::prelude::*;

const SLEIGH: &str = r#"[model]
name = "Chaplygin sleigh"
reference = "Chaplygin 1911"          # optional

[parameters]                          # stay adjustable at run time (--set m=2)
m = 1.0
J = 1.0
a = 0.5

[coordinates]                         # x_i = start value
x = 0.0
y = 0.0
phi = 0.0

[quasi_velocities]                    # η_s: a number, or a definition with its start value
v     = { is = "cos(phi)*x' + sin(phi)*y'", start = 0.0 }
omega = { is = "phi'", start = 1.0 }

[constraints]                         # each expression = 0
blade = "-sin(phi)*x' + cos(phi)*y'"

[lagrangian]
kinetic = "m/2*(x'^2 + y'^2) + m*a*omega*(cos(phi)*y' - sin(phi)*x') + (J + m*a^2)/2*omega^2"
potential = "0"

[simulation]
t_end = 5.0
"#;

/// Every section and every entry.
const EVERYTHING: &str = r#"
[simulation]
t_start = -1
t_end = 1_000
samples = 0x10
rtol = 1e-10
atol = 1e-14
max_step = 0.5
method = "bdf"
form = "canonical"

[events.hit]
when = "θ - 1"
direction = "falling"
terminal = true
reset = { "θ1" = "0", "θ'" = "-θ'" }

[outputs]
work = "d(x')*m"

[integrals]
area = "x*y'"

[forces]
w1 = "-k*w1"
"θ" = 0

[bodies.wheel]
mass = "m"
position = ["x", 0, '''
0''']
inertia = [1, 1, 2, 0, 0, 0.5]
rotation = [1, 0, 0, 0, 1, 0, 0, 0, 1]
force = [0, 0, "-m*g"]

[bodies."left rod"]
mass = 2
position = [0, 0, 0]
inertia = ["I", "I", "0"]
angular_velocity = ["w1", "w2", "w3"]
torque = [0, 0, "M"]

[lagrangian]
potential = "-m*g*x"
dissipation = "k/2*w1^2"

[constraints]
slip-x = "w1"
rod = { expr = "x^2 + y^2 - 1", kind = "holonomic" }
roll = { expr = "x' - w1", kind = "nonholonomic" }

[algebra]
brackets = { "w1,w2" = "w3", " w2 , w3 " = "w1", "t,w1" = 0 }

[kinematics]
x = "w1"

[quasi_velocities]
w1 = 1
w2 = "sqrt(g)"
w3.is = "x' + y'"
"y'" = 2
"θ'" = "m"

[coordinates]
y = 0
x = 0
"θ" = "g/m"

[definitions]
k = "m*g"

[parameters]
m = 1
g = -9.81e0
"#;

fn read(text: &str) -> Document {
    Document::parse(Source::new("m.toml", text)).unwrap_or_else(|error| panic!("{error}"))
}

fn refused(text: &str) -> String {
    match Document::from_bytes("m.toml", text.as_bytes()) {
        Ok(_) => panic!("accepted: {text}"),
        Err(error) => error.to_string(),
    }
}

fn names(entries: &[NamedExpression]) -> Vec<&str> {
    entries.iter().map(|entry| entry.name.text.as_str()).collect()
}

fn texts(expressions: &[Expression]) -> Vec<&str> {
    expressions.iter().map(|expression| expression.text.as_str()).collect()
}

#[test]
fn the_sleigh() {
    let document = read(SLEIGH);
    let title = document.model.name.unwrap();
    assert_eq!((title.value.as_str(), title.place.entry.as_str()), ("Chaplygin sleigh", "[model] name"));
    assert_eq!(names(&document.parameters), ["m", "J", "a"]);
    assert_eq!(document.parameters[2].expression.ast.kind, AstKind::Number(0.5));
    assert_eq!(names(&document.coordinates), ["x", "y", "phi"]);
    assert_eq!(document.coordinates[0].expression.ast.kind, AstKind::Number(0.0));
    let [v, omega] = &document.quasi_velocities[..] else { panic!("two quasi-velocities") };
    assert_eq!(v.is.as_ref().unwrap().text, "cos(phi)*x' + sin(phi)*y'");
    assert_eq!(omega.name.place.entry, "[quasi_velocities] omega");
    assert_eq!(omega.start.as_ref().unwrap().ast.kind, AstKind::Number(1.0));
    assert_eq!(document.constraints[0].name.text, "blade");
    assert_eq!(document.constraints[0].kind, None);
    let energy = document.lagrangian.unwrap();
    assert!(matches!(energy.kinetic.unwrap().ast.kind, AstKind::Sum(terms) if terms.len() == 3));
    assert_eq!(energy.potential.unwrap().ast.kind, AstKind::Number(0.0));
    assert_eq!(document.source.slice(energy.place.span), "[lagrangian]");
    assert_eq!(document.simulation.t_end.unwrap().value, 5.0);
    assert_eq!(document.simulation.samples, None);
}

#[test]
fn every_entry() {
    let document = read(EVERYTHING);
    assert_eq!(names(&document.coordinates), ["y", "x", "θ"]);
    assert_eq!(names(&document.start_velocities), ["y", "θ"]);
    assert_eq!(names(&document.forces), ["w1", "θ"]);
    assert_eq!(names(&document.kinematics), ["x"]);
    assert_eq!(names(&document.definitions), ["k"]);
    assert_eq!(names(&document.integrals), ["area"]);
    assert_eq!(names(&document.outputs), ["work"]);
    let given: Vec<_> =
        document.quasi_velocities.iter().map(|quasi| (quasi.is.is_some(), quasi.start.is_some())).collect();
    assert_eq!(given, [(false, true), (false, true), (true, false)]);

    let kinds: Vec<_> = document.constraints.iter().map(|c| c.kind.as_ref().map(|kind| kind.value)).collect();
    assert_eq!(kinds, [None, Some(DeclaredKind::Holonomic), Some(DeclaredKind::Nonholonomic)]);
    let AlgebraDefinition::Brackets(brackets) = document.algebra.unwrap().definition else {
        panic!("brackets")
    };
    let pairs: Vec<_> = brackets.iter().map(|b| (b.left.text.as_str(), b.right.text.as_str())).collect();
    assert_eq!(pairs, [("w1", "w2"), ("w2", "w3"), ("t", "w1")]);
    assert_eq!(document.source.slice(brackets[1].right.place.span.clone()), "w3");

    let [wheel, rod] = &document.bodies[..] else { panic!("two bodies") };
    assert_eq!(texts(&wheel.position), ["x", "0", "0"]);
    assert!(matches!(wheel.inertia, Some(Inertia::Full(_))));
    assert!(matches!(wheel.orientation, Some(Orientation::Rotation(_))));
    assert_eq!(rod.name.text, "left rod");
    assert_eq!(document.source.slice(rod.name.place.span.clone()), "left rod");
    assert_eq!(document.source.slice(rod.place.span.clone()), "[bodies.\"left rod\"]");
    assert!(matches!(rod.inertia, Some(Inertia::Principal(_))));
    assert_eq!(texts(rod.torque.as_ref().unwrap()), ["0", "0", "M"]);

    let event = &document.events[0];
    assert_eq!(event.direction.as_ref().unwrap().value, Direction::Falling);
    assert!(event.terminal.as_ref().unwrap().value);
    assert_eq!(names(&event.reset), ["θ1", "θ'"]);

    let simulation = document.simulation;
    assert_eq!(simulation.t_start.unwrap().value, -1.0);
    assert_eq!(simulation.t_end.unwrap().value, 1000.0);
    assert_eq!(simulation.samples.unwrap().value, 16);
    assert_eq!(simulation.method.unwrap().value, Method::Bdf);
    assert_eq!(simulation.form.unwrap().value, Variables::Momenta);
}

/// The names in a tree, as written in the file at their spans.
fn leaves(ast: &Ast, expression: &Expression, source: &Source, out: &mut Vec<String>) {
    match &ast.kind {
        AstKind::Sum(terms) => terms.iter().for_each(|(_, term)| leaves(term, expression, source, out)),
        _ => out.push(source.slice(expression.locate(ast.span)).into()),
    }
}

/// The terms of the sum `literal` as written in the file.
fn located(literal: &str) -> Vec<String> {
    let text = format!("[lagrangian]\nlagrangian = {literal}\n[coordinates]\nx=1");
    let document = read(&text);
    let Some(expression) = document.lagrangian.and_then(|energy| energy.lagrangian) else {
        panic!("{literal}")
    };
    let mut out = Vec::new();
    leaves(&expression.ast, &expression, &document.source, &mut out);
    let whole = document.source.slice(expression.whole().span);
    assert!(literal.contains(whole.trim()), "{whole}");
    out
}

#[test]
#[rustfmt::skip]
fn places_in_all_kinds_of_strings() {
    assert_eq!(located(r#""aa + θ + cc""#), ["aa", "θ", "cc"]);
    assert_eq!(located(r"'aa + bb + cc'"), ["aa", "bb", "cc"]);
    assert_eq!(located(r#""aa\t + \u0062b\n + c\x63""#), ["aa", r"\u0062b", r"c\x63"]);
    assert_eq!(located(r#""\U000003B8\u03b8 + \e""#.replace(r" + \e", "+ c").as_str()), [r"\U000003B8\u03b8", "c"]);
    assert_eq!(located("\"\"\"aa\n + bb\n + cc\"\"\""), ["aa", "bb", "cc"]);
    assert_eq!(located("\"\"\"\naa + \\\n\n    bb + c\\\n  c\"\"\""), ["aa", "bb", "c\\\n  c"]);
    assert_eq!(located("\"\"\"\r\naa + \\  \r\n\t bb\r\n + cc\"\"\""), ["aa", "bb", "cc"]);
    assert_eq!(located("'''\naa' + bb\n + cc'''"), ["aa'", "bb", "cc"]);
    assert_eq!(located("1_0.5"), ["1_0.5"]);
}

#[test]
fn every_message() {
    let golden = include_str!("refused.txt").replace("\r\n", "\n");
    let mut count = 0;
    for block in golden.split("=====\n") {
        let (text, expected) = block.split_once("-----\n").unwrap();
        assert_eq!(refused(text) + "\n", expected, "\n{text}");
        count += 1;
    }
    assert_eq!(count, 122);
}

#[test]
fn tabs_wide_characters_and_line_endings() {
    let expected = "m.toml:2:14: [lagrangian] kinetic: unexpected character `あ`\n    \tkinetic\t=\t\"bあ\t+ c\"\n    \
                    \t       \t \t  ^^\n  help: expressions are made of numbers, names, `+ - * / ^`, parentheses and commas";
    let text = "[lagrangian]\n\tkinetic\t=\t\"bあ\t+ c\"\n";
    assert_eq!(refused(text), expected);
    assert_eq!(refused(&text.replace('\n', "\r\n")), expected);

    let combined = refused("[outputs]\nx = \"e\u{301}\"\n");
    assert!(combined.starts_with("m.toml:2:7: [outputs] x: unexpected character `\\u{301}`\n"), "{combined}");

    let document = read(&SLEIGH.replace('\n', "\r\n"));
    assert_eq!(names(&document.coordinates), ["x", "y", "phi"]);
    let document = read(&format!("\u{feff}{SLEIGH}"));
    assert_eq!(names(&document.coordinates), ["x", "y", "phi"]);
}

#[test]
fn long_lines_are_cut() {
    let long = "a + ".repeat(1000);
    let message = refused(&format!("[lagrangian]\nkinetic = \"{long}$ + {long}a\""));
    let lines: Vec<_> = message.lines().collect();
    assert_eq!(lines[0], "m.toml:2:4012: [lagrangian] kinetic: unexpected character `$`");
    let left = "a + ".repeat(15);
    let right = "a + ".repeat(24);
    assert_eq!(lines[1], format!("    …{left}$ + {right}…"));
    assert_eq!(lines[2], format!("     {}^", " ".repeat(60)));
}

#[test]
fn size_is_not_bounded_but_messages_are() {
    let parameters: String = (0..50_000).map(|i| format!("p{i} = {i}\n")).collect();
    let sum = vec!["x'^2"; 100_000].join(" + ");
    let model =
        format!("[parameters]\n{parameters}[coordinates]\nx = 1\n[lagrangian]\nkinetic = \"{sum}\"\n");
    assert_eq!(read(&model).parameters.len(), 50_000);
    assert!(refused(&format!("{model}[outputs]\np49999 = 1")).contains("(line 50001)"));
    let name = "x".repeat(1_000_000);
    for text in [format!("[model]\n{name} = 1"), format!("[{name}]"), format!("[outputs]\ny = \"{name}(1)\"")]
    {
        assert!(refused(&text).len() < 3000);
    }
}

#[test]
fn not_text() {
    let error = Document::from_bytes("m.toml", b"[model]\nname = \"\xff\xfe\"\n").unwrap_err();
    let expected = "m.toml:2:9: the file is not UTF-8 text: found byte 0xff\n    name = \"\u{fffd}\u{fffd}\"\n            \
                    ^\n  help: save the model as plain text in UTF-8";
    assert_eq!(error.to_string(), expected);
    assert_eq!(error.kind(), &ErrorKind::NotText { byte: 0xff });
    assert_eq!((error.category(), error.category().exit_code()), (Category::Text, 3));
    assert_eq!((error.position().line, error.position().column, error.span()), (2, 9, 16..17));

    let nul = refused("[model]\nname\0 = 1\n");
    assert!(nul.starts_with("m.toml:2:"), "{nul}");
    assert!(!nul.contains('\0'), "{nul}");
    assert!(refused("").starts_with("m.toml:1:1: the model is empty\n    \n    ^\n  help: a model needs"));
    assert!(refused("\n\n").starts_with("m.toml:1:1: the model is empty\n"));
    assert!(Document::from_bytes("junk", &(0..=255).collect::<Vec<u8>>()).is_err());
}

#[test]
fn nesting_in_toml_is_bounded() {
    let deep = [
        format!("[model]\nname = {}", "[".repeat(10_000)),
        format!("[model]\nname = {}{}", "[".repeat(10_000), "]".repeat(10_000)),
        format!("[model]\nname = {}", "{a=".repeat(10_000)),
        format!("[model]\nname = {}1{}", "{a=".repeat(10_000), "}".repeat(10_000)),
        format!("[model]\n{}a = 1", "a.".repeat(10_000)),
        format!("[{}a]", "a.".repeat(10_000)),
        "[".repeat(1_000_000),
    ];
    for text in deep {
        let message = refused(&text);
        assert!(message.len() < 2000, "{message}");
    }
    let nested = refused(&format!("[model]\nname = {}{}", "[".repeat(100), "]".repeat(100)));
    let expected = "m.toml:2:88: not valid TOML: cannot recurse further; max recursion depth met";
    assert_eq!(nested.lines().next(), Some(expected));
    assert_eq!(nested.lines().last(), Some("  help: a model needs no such nesting"));
}

#[test]
fn later_stages_report_in_the_same_way() {
    let document = read(SLEIGH);
    let kinetic = document.lagrangian.unwrap().kinetic.unwrap();
    let place = kinetic.place(Span { start: 0, end: 1 });
    let error = document.source.error(&place, ErrorKind::Unsupported { what: "masses are" });
    let line = SLEIGH.lines().find(|line| line.starts_with("kinetic")).unwrap();
    let expected = format!(
        "m.toml:23:12: [lagrangian] kinetic: masses are not supported yet\n    {line}\n               ^\n  help: remove the entry"
    );
    assert_eq!(error.to_string(), expected);
    assert_eq!(error.category(), Category::Unsupported);
    assert_eq!(error.diagnostic().render(&document.source), expected);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(500) })]

    #[test]
    fn any_bytes(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        if let Err(error) = Document::from_bytes("m", &bytes) {
            prop_assert!(error.to_string().starts_with("m:"));
        }
    }

    #[test]
    fn any_text(text in any::<String>()) {
        prop_assert!(Document::from_bytes("m", text.as_bytes()).is_err());
    }

    /// A valid model with a piece removed, doubled, or replaced.
    #[test]
    fn damaged_models(
        from in 0..EVERYTHING.len(), length in 0..60usize, to in 0..EVERYTHING.len(), junk in "[-\\]\\[{}\"'=#.,θ\n\\\\ a1]{0,8}",
    ) {
        let characters: Vec<char> = EVERYTHING.chars().collect();
        let (from, to) = (from.min(characters.len()), to.min(characters.len()));
        let piece = &characters[from..characters.len().min(from + length)];
        let rest = characters.len().min(from + length)..;
        let whole = |middle: &str| {
            let head: String = characters[..from].iter().collect();
            let tail: String = characters[rest.clone()].iter().collect();
            head + middle + &tail
        };
        let piece: String = piece.iter().collect();
        let other: String = characters[to..characters.len().min(to + length)].iter().collect();
        for text in [whole(""), whole(&junk), whole(&other), whole(&(piece.clone() + &piece))] {
            if let Err(error) = Document::parse(Source::new("m", text.clone())) {
                let span = error.span();
                prop_assert!(span.start <= span.end && span.end <= text.len(), "{error}");
                prop_assert!(error.to_string().starts_with("m:"));
            }
        }
    }
}
