//! Models of any size whose equations are larger than they look.

use crate::attack::limits::expressions::Expressions;
use crate::fuzz::random::Random;

/// The longest text, in bytes or so.
const LONGEST: f64 = 100_000.0;

/// A model; most are from some hundred bytes to some thousand, some are very long.
pub fn model(random: &mut Random) -> String {
    match random.below(12) {
        0..=3 => particles(random),
        4 => dense(random),
        5 => frame(random),
        6 => joints(random),
        7 => pendulums(random),
        8 => constrained(random),
        9 => entries(random),
        10 => algebra(random),
        _ => functions(random),
    }
}

/// A number up to `most` of which the order of magnitude is at random.
fn count(most: f64, random: &mut Random) -> usize {
    random.number(0.0, (most + 1.0).ln()).exp() as usize
}

fn bytes(random: &mut Random) -> usize {
    random.number(20f64.ln(), LONGEST.ln()).exp() as usize
}

fn list(n: usize, entry: impl FnMut(usize) -> String, between: &str) -> String {
    (0..n).map(entry).collect::<Vec<_>>().join(between)
}

fn names(n: usize) -> Vec<String> {
    (0..n).map(|i| format!("x{i}")).collect()
}

/// A whole text: what all models have, and these sections.
fn text(coordinates: usize, sections: &[(&str, String)]) -> String {
    let mut text = "[parameters]\np = 1.3\n[simulation]\nt_end = 0.1\nsamples = 5\n".to_owned();
    let own = ("coordinates", list(coordinates, |i| format!("x{i} = 0.5"), "\n"));
    for (name, entries) in std::iter::once(&own).chain(sections).filter(|(_, entries)| !entries.is_empty()) {
        text += &format!("[{name}]\n{entries}\n");
    }
    text
}

fn squares(n: usize) -> String {
    list(n, |i| format!("x{i}'^2/2"), " + ")
}

/// Coordinates with large expressions wherever some may be.
fn particles(random: &mut Random) -> String {
    let n = count(if random.chance(80) { 6.0 } else { 300.0 }, random).max(1);
    let size = bytes(random);
    let chances: [bool; 7] = std::array::from_fn(|_| random.chance(25));
    let mut all = Expressions::new([names(n), vec!["p".to_owned()]].concat(), random);
    let mut some = |at: usize, entry: &dyn Fn(String) -> String| {
        if chances[at] { entry(all.any(size)) } else { String::new() }
    };
    let mass = some(0, &|e| format!(" + ({e})*x0'^2"));
    let forces = some(1, &|e| format!("x0 = \"{e}\""));
    let events = some(2, &|e| format!("when = \"{e} - 1e3\""));
    let outputs = some(3, &|e| format!("o = \"{e}\""));
    let integrals = some(4, &|e| format!("i = \"{e}\""));
    let states = some(5, &|e| format!("s = {{ start = 0.1, rate = \"{e} - s\" }}"));
    let dissipation = some(6, &|e| format!("dissipation = \"({e})*x0'^2\"\n"));
    let potential = all.any(size);
    let definitions = all.definitions().join("\n");
    text(
        n,
        &[
            ("definitions", definitions),
            ("forces", forces),
            ("events.e", events),
            ("outputs", outputs),
            ("integrals", integrals),
            ("states", states),
            (
                "lagrangian",
                format!("{dissipation}kinetic = \"{}{mass}\"\npotential = \"{potential}\"", squares(n)),
            ),
        ],
    )
}

/// All velocities in one square matrix of expressions.
fn dense(random: &mut Random) -> String {
    let n = count(100.0, random).max(2);
    let size = (bytes(random) / (n * n)).max(10);
    let simple = random.chance(60);
    let mut all = Expressions::new(names(n), random);
    let entry = |i: usize, j: usize, all: &mut Expressions<'_>| {
        if simple {
            format!("cos(x{i} - x{j})*x{i}'*x{j}'")
        } else {
            format!("({})*x{i}'*x{j}'", all.any(size))
        }
    };
    let pairs = list(n, |i| list(i + 1, |j| entry(i, j, &mut all), " + "), " + ");
    let potential = all.any(100);
    let definitions = all.definitions().join("\n");
    let kinetic = format!("{n}*({}) + 0.1*({pairs})", squares(n));
    text(
        n,
        &[
            ("definitions", definitions),
            ("lagrangian", format!("kinetic = \"{kinetic}\"\npotential = \"{potential}\"")),
        ],
    )
}

/// Quasi-velocities of which each is in the velocity of every coordinate.
fn frame(random: &mut Random) -> String {
    let n = count(20.0, random).max(2);
    let size = (bytes(random) / (n * n)).max(10);
    let by_definitions = random.chance(50);
    let mut all = Expressions::new(names(n), random);
    let mut row = |i: usize, name: &str| {
        list(
            n,
            |j| {
                format!(
                    "({} + 0.01*({}))*{}",
                    9 * usize::from(i == j),
                    all.any(size),
                    name.replace("{}", &j.to_string())
                )
            },
            " + ",
        )
    };
    let (velocities, kinematics) = if by_definitions {
        (list(n, |i| format!("w{i} = {{ is = \"{}\" }}", row(i, "x{}'")), "\n"), String::new())
    } else {
        let kinematics = list(n, |i| format!("x{i} = \"{}\"", row(i, "w{}")), "\n");
        (list(n, |i| format!("w{i} = 0.1"), "\n"), kinematics)
    };
    let potential = all.any(100);
    let definitions = all.definitions().join("\n");
    let kinetic = list(n, |i| format!("w{i}^2/2"), " + ");
    text(
        n,
        &[
            ("definitions", definitions),
            ("quasi_velocities", velocities),
            ("kinematics", kinematics),
            ("lagrangian", format!("kinetic = \"{kinetic}\"\npotential = \"{potential}\"")),
        ],
    )
}

/// Bodies on joints, each on the one before or on any before it.
fn joints(random: &mut Random) -> String {
    let n = count(300.0, random).max(1);
    let (is_chain, alike) = (random.chance(60), random.chance(60));
    let kinds = [
        "kind = \"revolute\", axis = [0, 1, 0], damping = 0.1",
        "kind = \"revolute\", axis = [1, 2, 3], stiffness = 3",
        "kind = \"spherical\"",
        "kind = \"universal\", axes = [[1, 0, 0], [0, 1, 0]]",
        "kind = \"cylindrical\", axis = [0, 0, 1]",
        "kind = \"free\"",
        "kind = \"prismatic\", axis = [1, 0, 1], stiffness = 5",
    ];
    let first = *random.pick(&kinds);
    let body = |i: usize| {
        let kind = if alike { first } else { *random.pick(&kinds) };
        let parent = match i {
            0 => "world".to_owned(),
            _ if is_chain => format!("b{}", i - 1),
            _ => format!("b{}", random.below(i)),
        };
        format!(
            "[bodies.b{i}]\nparent = \"{parent}\"\njoint = {{ {kind}, at = [0.1, 0, \"-p\"] }}\nmass = 1.0\n\
             center = [0, 0.1, -0.5]\ninertia = [0.1, 0.2, 0.15]"
        )
    };
    let bodies = list(n, body, "\n");
    let loops = if n > 3 && random.chance(30) { count(n as f64 / 3.0, random) } else { 0 };
    let closed = |i: usize| {
        let (a, b) = (random.below(n), random.below(n));
        format!(
            "[loops.l{i}]\nkind = \"rod\"\nbodies = [\"b{a}\", \"b{b}\"]\nat = [[0.1, 0, -1], [0.2, 0.3, 0]]\n\
             length = 1.0"
        )
    };
    format!(
        "{}[gravity]\nacceleration = [0, 0, -9.81]\n{bodies}\n{}\n",
        text(0, &[]),
        list(loops, closed, "\n")
    )
}

/// Bodies that hang on each other, placed by sums of sines, and turned by products of matrices.
fn pendulums(random: &mut Random) -> String {
    let n = count(60.0, random).max(1);
    let in_space = random.chance(50);
    let place = |i: usize, function: &str| list(i + 1, |j| format!("p*{function}(x{j})"), " + ");
    let around = |i: usize, function: &str| list(i + 1, |j| format!("sin(x{j})*{function}(y{j})"), " + ");
    let position = |i: usize| {
        if in_space {
            format!("\"{}\", \"{}\", \"{}\"", around(i, "cos"), around(i, "sin"), place(i, "cos"))
        } else {
            format!("\"{}\", 0, \"-({})\"", place(i, "sin"), place(i, "cos"))
        }
    };
    let body = |i: usize| format!("[bodies.b{i}]\nmass = 1.0\nposition = [{}]", position(i));
    let more = if in_space { list(n, |i| format!("y{i} = 0.3"), "\n") } else { String::new() };
    let coordinates = format!("{}\n{more}", list(n, |i| format!("x{i} = 0.5"), "\n"));
    format!(
        "{}[coordinates]\n{coordinates}\n[gravity]\nacceleration = [0, 0, -9.81]\n{}\n",
        text(0, &[]),
        list(n, body, "\n")
    )
}

/// Many constraints, on positions and on velocities.
fn constrained(random: &mut Random) -> String {
    let n = count(150.0, random).max(3);
    let m = 1 + random.below(n - 2);
    let size = (bytes(random) / m).max(10);
    let kind = random.below(4);
    let starts = list(n, |i| format!("x{i} = 0.5"), "\n");
    let mut all = Expressions::new(names(n), random);
    let constraint = |i: usize| match kind {
        0 => format!("k{i} = \"x{i}^2 + x{}^2 - 0.5\"", i + 1),
        1 => format!("k{i} = \"x{i}' - (1 + sin(x{}))*x{}'\"", i + 1, i + 1),
        2 => format!("k{i} = \"({})*(x{i} - x{})\"", all.any(size), i + 1),
        _ => format!("k{i} = \"({})*x{i}' - ({})*x{}'\"", all.any(size), all.any(size), i + 1),
    };
    let constraints = list(m, constraint, "\n");
    let definitions = all.definitions().join("\n");
    format!(
        "{}[coordinates]\n{starts}\n{}\n[constraints]\n{constraints}\n[lagrangian]\nkinetic = \"{}\"\n\
         potential = \"{}\"\n",
        text(0, &[]),
        if definitions.is_empty() { definitions } else { format!("[definitions]\n{definitions}") },
        squares(n),
        list(n, |i| format!("x{i}"), " + "),
    )
}

/// Many entries of one section, or of several.
fn entries(random: &mut Random) -> String {
    let n = 1 + random.below(3);
    let mut all = Expressions::new([names(n), vec!["t".to_owned()]].concat(), random);
    let section = |entry: &dyn Fn(usize, String) -> String, all: &mut Expressions<'_>| {
        let (count, size) = all.several(LONGEST);
        list(count, |i| entry(i, all.any(size)), "\n")
    };
    let mut sections = Vec::new();
    for at in all.chosen(7) {
        sections.push(match at {
            0 => ("outputs", section(&|i, e| format!("o{i} = \"{e}\""), &mut all)),
            1 => ("integrals", section(&|i, e| format!("i{i} = \"{e}\""), &mut all)),
            2 => ("states", section(&|i, e| format!("s{i} = {{ rate = \"{e} - s{i}\" }}"), &mut all)),
            3 => ("forces", section(&|i, e| format!("x{} = \"{e}\"", i % n), &mut all)),
            4 => (
                "events",
                section(
                    &|i, e| format!("e{i} = {{ when = \"{e} - {i}\", direction = \"rising\" }}"),
                    &mut all,
                ),
            ),
            5 => ("inputs", section(&|i, e| format!("u{i} = {}", e.len()), &mut all)),
            _ => ("inputs.table", {
                let (count, _) = all.several(4.0 * LONGEST);
                let times = list(count + 1, |i| format!("{}", i as f64 / 100.0), ", ");
                format!("times = [{times}]\nvalues = [{times}]\ninterpolation = \"cubic\"")
            }),
        });
    }
    let definitions = all.definitions().join("\n");
    sections.push(("definitions", definitions));
    sections.push(("lagrangian", format!("kinetic = \"{}\"\npotential = \"x0^4\"", squares(n))));
    text(n, &sections)
}

/// A group of many dimensions.
fn algebra(random: &mut Random) -> String {
    let k = count(20.0, random).max(3);
    let (name, n) = match random.below(3) {
        0 => (format!("so{k}"), k * (k - 1) / 2),
        1 => (format!("gl{k}"), k * k),
        _ => (format!("heisenberg{}", 2 * k + 1), 2 * k + 1),
    };
    let is_dense = random.chance(40);
    let pairs = if is_dense { list(n - 1, |i| format!(" + 0.1*w{i}*w{}", i + 1), "") } else { String::new() };
    let kinetic = list(n, |i| format!("{}*w{i}^2/2", i + 1), " + ");
    text(
        0,
        &[
            ("quasi_velocities", list(n, |i| format!("w{i} = 0.1"), "\n")),
            ("algebra", format!("name = \"{name}\"")),
            ("lagrangian", format!("kinetic = \"{kinetic}{pairs}\"")),
        ],
    )
}

/// Functions that call each other.
fn functions(random: &mut Random) -> String {
    let levels = count(200.0, random).max(1);
    let step = *random.pick(&[
        "f{}(f{}(s))",
        "f{}(s) + f{}(s/2)",
        "sin(f{}(s)) + s",
        "f{}(s)*f{}(s + 1)",
        "1/(1 + f{}(s)^2)",
        "f{}(s*f{}(s))",
    ]);
    let mut all = Expressions::new(vec!["s".to_owned()], random);
    let first = all.plain();
    let function = |i: usize| {
        let is = if i == 0 { first.clone() } else { step.replace("{}", &(i - 1).to_string()) };
        format!("f{i} = {{ of = \"s\", is = \"{is}\" }}")
    };
    text(
        2,
        &[
            ("functions", list(levels, function, "\n")),
            ("lagrangian", format!("kinetic = \"{}\"\npotential = \"f{}(x0 - x1)\"", squares(2), levels - 1)),
        ],
    )
}
