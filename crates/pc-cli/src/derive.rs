//! `pc derive`: the equations of motion, printed.

use pc_algebra::{CATALOGUE, LieAlgebra, StructureCoefficients};
use pc_expr::{Cost, ExprError, Inputs, Program};
use pc_mech::{Canonical, Equations, Expr, Graph, MechError, Style, System};
use serde_json::{Map, Value, json};

use crate::args::{DeriveArguments, Form, Page};
use crate::canonical;
use crate::error::CliError;
use crate::input;
use crate::latex;
use crate::text::{columns, combination, print};

/// Prints the equations of a model.
///
/// # Errors
/// [`CliError`].
pub fn command(arguments: &DeriveArguments) -> Result<(), CliError> {
    let model = input::open(&arguments.model)?;
    let graph = Graph::new();
    let system = model.assemble(&graph)?.system;
    let title = input::title(&model);
    let page = page(arguments, title, &system).map_err(|error| model.derivation_error(error))?;
    print(|out| write!(out, "{page}"))
}

/// The equations in the form and format that are asked for.
fn page(arguments: &DeriveArguments, title: &str, system: &System<'_>) -> Result<String, MechError> {
    let (heading, system) = match arguments.form {
        Form::Poincare => (format!("{title}: Poincaré's equations"), system.clone()),
        Form::Lagrange => (format!("{title}: Lagrange's equations"), system.in_velocities()?),
        Form::Canonical => {
            let equations = system.canonical()?;
            let operations = Operations::of_canonical(&equations)?;
            let heading = format!("{title}: canonical equations");
            return Ok(match arguments.format {
                Page::Text => underlined(&heading) + &canonical::text(&equations, &operations),
                Page::Latex => latex::canonical_page(&heading, &equations),
                Page::Json => format!("{:#}\n", canonical::object(title, &equations, &operations)),
            });
        }
    };
    let equations = system.poincare()?;
    let operations = Operations::of(&equations)?;
    Ok(match arguments.format {
        Page::Text => underlined(&heading) + &text(&equations, &operations),
        Page::Latex => latex::page(&heading, &equations),
        Page::Json => format!("{:#}\n", object(title, &equations, &operations)),
    })
}

fn underlined(heading: &str) -> String {
    format!("{heading}\n{}\n\n", "=".repeat(columns(heading)))
}

/// The operations of one evaluation of the right-hand side ẋ, η̇.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Operations {
    /// With parameters as run-time inputs.
    pub free: Cost,
    /// With parameters bound to their numbers.
    pub bound: Cost,
}

impl Operations {
    /// Those of Poincaré's equations.
    ///
    /// # Errors
    /// [`ExprError`] if the right-hand side cannot be compiled.
    pub fn of(equations: &Equations<'_>) -> Result<Operations, ExprError> {
        let system = equations.system();
        let rates = [equations.velocities(), &equations.accelerations()].concat();
        Operations::counted(system, system.quasi_velocities(), &rates)
    }

    /// Those of the canonical equations; where they are not closed, the quasi-velocities being known.
    ///
    /// # Errors
    /// As [`of`](Operations::of).
    pub fn of_canonical(equations: &Canonical<'_>) -> Result<Operations, ExprError> {
        let rates = [equations.velocities(), equations.right_hand_side()].concat();
        let system = equations.system();
        let implicit = if equations.is_closed() { &[] } else { system.quasi_velocities() };
        Operations::counted(system, &[equations.momenta(), implicit].concat(), &rates)
    }

    /// Those of `rates`, functions of time, coordinates, `moving` and parameters.
    fn counted<'g>(
        system: &System<'g>,
        moving: &[Expr<'g>],
        rates: &[Expr<'g>],
    ) -> Result<Operations, ExprError> {
        let graph = system.graph();
        let inputs = Inputs {
            time: Some(system.frame().time()),
            state: system.frame().coordinates().iter().chain(moving).copied().collect(),
            parameters: system.parameters().iter().map(|&(symbol, _)| symbol).collect(),
        };
        let numbers: Vec<_> =
            system.parameters().iter().map(|&(symbol, value)| (symbol, value.into())).collect();
        let bound = graph.substitute(rates, &numbers);
        Ok(Operations {
            free: Program::new(graph, &inputs, rates)?.cost(),
            bound: Program::new(graph, &inputs, &bound)?.cost(),
        })
    }
}

/// The equations as a book prints them: kinematics, brackets, mass matrix, M η̇ = r, energy, operations.
pub fn text(equations: &Equations<'_>, operations: &Operations) -> String {
    sections(&[
        ("Kinematics", kinematics(equations.system(), equations.velocities())),
        ("Brackets", brackets(equations.system())),
        ("Mass matrix", mass_matrix(equations)),
        ("Equations", balance(equations)),
        ("Energy", vec![equations.energy().display(Style::Book)]),
        ("Operations of one right-hand side", operations.lines()),
    ])
}

/// Titles with the lines under them; those without lines are left out.
pub fn sections(parts: &[(&str, Vec<String>)]) -> String {
    let section = |(title, lines): &(&str, Vec<String>)| {
        let lines: String = lines.iter().map(|line| format!("  {line}\n")).collect();
        format!("{title}\n{lines}")
    };
    let written: Vec<String> = parts.iter().filter(|(_, lines)| !lines.is_empty()).map(section).collect();
    written.join("\n")
}

/// ẋ_i = `velocities`, a line each; none where these are the velocities themselves.
pub fn kinematics(system: &System<'_>, velocities: &[Expr<'_>]) -> Vec<String> {
    let rates: Vec<String> = system.frame().coordinates().iter().map(|x| format!("{x}'")).collect();
    let velocities: Vec<String> = velocities.iter().map(|v| v.display(Style::Book)).collect();
    if rates == velocities {
        return Vec::new();
    }
    aligned(rates.iter().zip(&velocities))
}

/// M η̇ = r, a line an equation.
pub fn balance(equations: &Equations<'_>) -> Vec<String> {
    let sides = equations.balance(Style::Book);
    aligned(sides.iter().map(|(left, right)| (left, right)))
}

/// Left = right, the equals signs under each other unless a left side is long.
pub fn aligned<'a>(pairs: impl Iterator<Item = (&'a String, &'a String)> + Clone) -> Vec<String> {
    let width = pairs.clone().map(|(left, _)| columns(left)).filter(|&width| width <= 24).max().unwrap_or(0);
    pairs.map(|(left, right)| format!("{left:width$} = {right}")).collect()
}

/// The brackets [X_r, X_s] = c_rs^m X_m that are not zero, by the names of the quasi-velocities, `t` for time.
pub fn brackets(system: &System<'_>) -> Vec<String> {
    let structure = system.structure();
    let name = operator_names(system.quasi_velocities(), "t");
    let k = structure.operators();
    let mut lines = Vec::new();
    for (r, s) in (0..=k).flat_map(|r| (r + 1..=k).map(move |s| (r, s))) {
        let sum =
            combination((1..=k).map(|m| (structure.get(r, s, m).display(Style::Book), name[m].clone())));
        if sum != "0" {
            lines.push(format!("[{}, {}] = {sum}", name[r], name[s]));
        }
    }
    if lines.is_empty() {
        lines.push("all operators commute".to_owned());
    } else if let Some(known) = recognised(structure) {
        lines.push(format!("the algebra {known}"));
    }
    lines
}

/// The name of the algebra, if the structure coefficients are those of one in the catalogue.
pub fn recognised(structure: &StructureCoefficients<'_>) -> Option<&'static str> {
    let algebra = structure.lie_algebra().filter(|_| structure.nonzero().all(|(r, ..)| r > 0))?;
    let known = CATALOGUE.iter().find(|entry| LieAlgebra::named(entry.name).as_ref() == Ok(&algebra));
    known.map(|entry| entry.name)
}

/// Names of X_0..X_k: that of time, then of the quasi-velocities.
fn operator_names(quasi_velocities: &[Expr<'_>], time: &str) -> Vec<String> {
    std::iter::once(time.to_owned()).chain(quasi_velocities.iter().map(Expr::to_string)).collect()
}

fn mass_matrix(equations: &Equations<'_>) -> Vec<String> {
    const WIDEST: usize = 96;
    let rows: Vec<Vec<String>> = equations
        .mass_matrix()
        .to_rows()
        .iter()
        .map(|row| row.iter().map(|entry| entry.display(Style::Book)).collect())
        .collect();
    let k = rows.len();
    let entries = || (0..k).flat_map(|r| (0..k).map(move |s| (r, s)));
    if entries().all(|(r, s)| r == s || rows[r][s] == "0") {
        let diagonal: Vec<&str> = (0..k).map(|s| rows[s][s].as_str()).collect();
        return vec![format!("diag({})", diagonal.join(", "))];
    }
    let widths: Vec<usize> =
        (0..k).map(|s| rows.iter().map(|row| columns(&row[s])).max().unwrap_or(0)).collect();
    if widths.iter().sum::<usize>() + 3 * k <= WIDEST {
        let line = |row: &Vec<String>| {
            let cells: Vec<String> =
                row.iter().zip(&widths).map(|(entry, &width)| format!("{entry:width$}")).collect();
            format!("[ {} ]", cells.join("   "))
        };
        return rows.iter().map(line).collect();
    }
    let name = operator_names(equations.system().quasi_velocities(), "t");
    entries()
        .filter(|&(r, s)| s <= r && rows[r][s] != "0")
        .map(|(r, s)| format!("M({}, {}) = {}", name[r + 1], name[s + 1], rows[r][s]))
        .collect()
}

impl Operations {
    /// A line each for parameters free and bound.
    pub fn lines(&self) -> Vec<String> {
        vec![counted("parameters free ", &self.free), counted("parameters bound", &self.bound)]
    }
}

/// `what: total (kind count, …)`.
pub fn counted(what: &str, cost: &Cost) -> String {
    let kinds: Vec<String> = cost.iter().map(|(kind, count)| format!("{count} {kind}")).collect();
    match kinds.as_slice() {
        [] => format!("{what}  0"),
        kinds => format!("{what}  {} = {}", cost.total(), kinds.join(" + ")),
    }
}

/// The equations for programs.
pub fn object(title: &str, equations: &Equations<'_>, operations: &Operations) -> Value {
    let mut object = description(title, equations.system());
    object.insert("mass_matrix".to_owned(), json!(matrix(&equations.mass_matrix().to_rows())));
    object.insert("equations".to_owned(), json!(strings(equations.right_hand_side())));
    object.insert("energy".to_owned(), json!(equations.energy().to_string()));
    object.insert("operations".to_owned(), operations.object());
    Value::Object(object)
}

/// What all forms of the equations have in common.
pub fn description(title: &str, system: &System<'_>) -> Map<String, Value> {
    let frame = system.frame();
    let name = operator_names(system.quasi_velocities(), "0");
    let structure: Vec<Value> = system
        .structure()
        .nonzero()
        .map(|(r, s, m, c)| json!({ "r": name[r], "s": name[s], "m": name[m], "value": c.to_string() }))
        .collect();
    let parameters: Map<String, Value> =
        system.parameters().iter().map(|(symbol, value)| (symbol.to_string(), json!(value))).collect();
    let entries = [
        ("model", json!(title)),
        ("coordinates", json!(strings(frame.coordinates()))),
        ("quasi_velocities", json!(strings(system.quasi_velocities()))),
        ("parameters", Value::Object(parameters)),
        ("kinematics", json!({ "b": matrix(&frame.b().to_rows()), "b_0": strings(frame.b0()) })),
        ("structure_coefficients", json!(structure)),
    ];
    entries.into_iter().map(|(key, value)| (key.to_owned(), value)).collect()
}

/// The expressions as text.
pub fn strings(list: &[Expr<'_>]) -> Vec<String> {
    list.iter().map(Expr::to_string).collect()
}

fn matrix(rows: &[Vec<Expr<'_>>]) -> Vec<Vec<String>> {
    rows.iter().map(|row| strings(row)).collect()
}

impl Operations {
    /// For programs.
    pub fn object(&self) -> Value {
        json!({ "free": counts(&self.free), "bound": counts(&self.bound) })
    }
}

fn counts(cost: &Cost) -> Value {
    let kinds = cost.iter().map(|(kind, count)| (kind.to_owned(), json!(count)));
    Value::Object(std::iter::once(("total".to_owned(), json!(cost.total()))).chain(kinds).collect())
}
