//! Models whose equations, or whose results, are larger than anything.

use std::fmt::Write;

/// A model with what it is called.
#[derive(Clone, Debug)]
pub struct Giant {
    /// Its name.
    pub name: String,
    /// Its text.
    pub text: String,
}

/// Each once found to take all memory, or to go on for ever; and their neighbours.
pub fn giants() -> Vec<Giant> {
    let mut all = vec![
        giant("powers", tower(70, "{}^1.5")),
        giant("powers-near-one", tower(200, "({} + 0.1)^0.5")),
        giant("sines", tower(10_000, "sin({})")),
        giant("squares", tower(60, "{}*{} + x")),
        giant("quotients", tower(300, "1/(1 + {})")),
        giant("parentheses", one(&format!("{}x{}", "(".repeat(100_000), ")".repeat(100_000)))),
        giant("minus", one(&format!("{}x", "-".repeat(100_000)))),
        giant("nested-sines", one(&format!("{}x{}", "sin(".repeat(5_000), ")".repeat(5_000)))),
        giant(
            "long-sum",
            one(&(1..30_000).map(|i| format!("sin({i}*x)/{i}^3")).collect::<Vec<_>>().join(" + ")),
        ),
        giant("power-of-power", one("((x^65535)^65535)^65535")),
        giant("samples", uncoupled(2).replace("samples = 5", "samples = 2000000")),
        giant("fast-force", one("x*sin(1e21*t)")),
        giant("long-name", one("x").replace('x', &"x".repeat(1_000_000))),
        giant("dense-frame", dense_frame(10)),
        giant("sum-of-squares", sum_of_squares(100)),
        giant("quadratic-constraints", quadratic_constraints(200)),
        giant(
            "binomial",
            one(&format!("({})^12", (1..40).map(|i| format!("cos({i}*x)")).collect::<Vec<_>>().join(" + "))),
        ),
    ];
    for n in [100, 300, 1000] {
        all.push(giant(&format!("uncoupled-{n}"), uncoupled(n)));
    }
    all
}

fn giant(name: &str, text: String) -> Giant {
    Giant { name: name.to_owned(), text }
}

/// One coordinate with a potential.
fn one(potential: &str) -> String {
    format!(
        "[coordinates]\nx = 0.5\n[lagrangian]\nkinetic = \"x'^2/2\"\npotential = \"{potential}\"\n[simulation]\nt_end = 1.0\nsamples = 5\n"
    )
}

/// Definitions, each by the one before, where `step` has `{}`.
fn tower(levels: usize, step: &str) -> String {
    let mut text = "[coordinates]\nx = 0.5\n[definitions]\nd0 = \"1 + x^2\"\n".to_owned();
    for i in 1..=levels {
        // Writing to a String does not fail.
        let _ = writeln!(text, "d{i} = \"{}\"", step.replace("{}", &format!("d{}", i - 1)));
    }
    text + &format!(
        "[lagrangian]\nkinetic = \"x'^2/2\"\npotential = \"d{levels}\"\n[simulation]\nt_end = 1.0\nsamples = 5\n"
    )
}

fn list(n: usize, entry: impl Fn(usize) -> String, between: &str) -> String {
    (0..n).map(entry).collect::<Vec<_>>().join(between)
}

fn coordinates(n: usize) -> String {
    format!("[coordinates]\n{}\n", list(n, |i| format!("x{i} = 0.5"), "\n"))
}

fn uncoupled(n: usize) -> String {
    let squares = |symbol: &str| list(n, |i| format!("x{i}{symbol}^2/2"), " + ");
    format!(
        "{}[lagrangian]\nkinetic = \"{}\"\npotential = \"{}\"\n[simulation]\nt_end = 1.0\nsamples = 5\n",
        coordinates(n),
        squares("'"),
        squares("")
    )
}

fn sum_of_squares(n: usize) -> String {
    let sum = list(n, |i| format!("x{i}'"), " + ");
    let squares = list(n, |i| format!("x{i}'^2"), " + ");
    format!(
        "{}[lagrangian]\nkinetic = \"({sum})^2/2 + ({squares})/2\"\n[simulation]\nt_end = 1.0\nsamples = 5\n",
        coordinates(n)
    )
}

fn quadratic_constraints(n: usize) -> String {
    let constraints = list(n - 1, |i| format!("k{i} = \"x{i}^2 + x{}^2 - 0.5\"", i + 1), "\n");
    let squares = list(n, |i| format!("x{i}'^2/2"), " + ");
    format!(
        "{}[lagrangian]\nkinetic = \"{squares}\"\n[constraints]\n{constraints}\n[simulation]\nt_end = 1.0\nsamples = 5\n",
        coordinates(n)
    )
}

fn dense_frame(n: usize) -> String {
    let entry = |i: usize, j: usize| {
        let diagonal = if i == j { 2 } else { 0 };
        format!("({diagonal} + 0.1*cos(x{} + {j}*x{}))*w{j}", (i + j) % n, (i * j + 1) % n)
    };
    format!(
        "{}[quasi_velocities]\n{}\n[kinematics]\n{}\n[lagrangian]\nkinetic = \"{}\"\n[simulation]\nt_end = 1.0\nsamples = 5\n",
        coordinates(n),
        list(n, |i| format!("w{i} = 0.1"), "\n"),
        list(n, |i| format!("x{i} = \"{}\"", list(n, |j| entry(i, j), " + ")), "\n"),
        list(n, |i| format!("w{i}^2/2"), " + "),
    )
}
