//! `pc derive`: the equations of motion, printed.

use pc_algebra::{CATALOGUE, LieAlgebra, StructureCoefficients};
use pc_expr::{Cost, ExprError, Inputs, Program};
use pc_mech::{Equations, Expr, Graph, MechError, Style};
use serde_json::{Map, Value, json};

use crate::args::{DeriveArguments, Page};
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
    let (_, equations) = input::derive(&model, &graph)?;
    let operations =
        Operations::of(&equations).map_err(|error| model.derivation_error(MechError::from(error)))?;
    let title = input::title(&model);
    print(|out| match arguments.format {
        Page::Text => write!(out, "{}\n\n{}", heading(title), text(&equations, &operations)),
        Page::Latex => write!(out, "{}", latex::page(title, &equations)),
        Page::Json => writeln!(out, "{:#}", object(title, &equations, &operations)),
    })
}

fn heading(title: &str) -> String {
    let title = format!("{title}: Poincaré's equations");
    format!("{title}\n{}", "=".repeat(columns(&title)))
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
    /// Counts them.
    ///
    /// # Errors
    /// [`ExprError`] if the right-hand side cannot be compiled.
    pub fn of(equations: &Equations<'_>) -> Result<Operations, ExprError> {
        let system = equations.system();
        let graph = system.graph();
        let state = system.frame().coordinates().iter().chain(system.quasi_velocities());
        let inputs = Inputs {
            time: Some(system.frame().time()),
            state: state.copied().collect(),
            parameters: system.parameters().iter().map(|&(symbol, _)| symbol).collect(),
        };
        let mut rates = equations.velocities().to_vec();
        rates.extend(equations.accelerations());
        let numbers: Vec<_> =
            system.parameters().iter().map(|&(symbol, value)| (symbol, value.into())).collect();
        let bound = graph.substitute(&rates, &numbers);
        Ok(Operations {
            free: Program::new(graph, &inputs, &rates)?.cost(),
            bound: Program::new(graph, &inputs, &bound)?.cost(),
        })
    }
}

/// The equations as a book prints them: kinematics, brackets, mass matrix, M η̇ = r, energy, operations.
pub fn text(equations: &Equations<'_>, operations: &Operations) -> String {
    let section = |title: &str, lines: &[String]| {
        let lines: String = lines.iter().map(|line| format!("  {line}\n")).collect();
        format!("{title}\n{lines}\n")
    };
    let kinematics = kinematics(equations);
    let mut text = String::new();
    if !kinematics.is_empty() {
        text += &section("Kinematics", &kinematics);
    }
    text += &section("Brackets", &brackets(equations));
    text += &section("Mass matrix", &mass_matrix(equations));
    text += &section("Equations", &balance(equations));
    text += &section("Energy", &[equations.energy().to_string()]);
    let costs = [("parameters free ", &operations.free), ("parameters bound", &operations.bound)];
    text += &section("Operations of one right-hand side", &costs.map(|(what, cost)| counted(what, cost)));
    text.truncate(text.trim_end().len());
    text + "\n"
}

/// ẋ_i = b_is η_s + b_i0, a line each; none where η = ẋ.
pub fn kinematics(equations: &Equations<'_>) -> Vec<String> {
    let system = equations.system();
    let rates: Vec<String> = system.frame().coordinates().iter().map(|x| format!("{x}'")).collect();
    let velocities: Vec<String> = equations.velocities().iter().map(Expr::to_string).collect();
    if rates == velocities {
        return Vec::new();
    }
    aligned(rates.iter().zip(&velocities))
}

/// M η̇ = r, a line an equation.
pub fn balance(equations: &Equations<'_>) -> Vec<String> {
    let sides = equations.balance(Style::Text);
    aligned(sides.iter().map(|(left, right)| (left, right)))
}

/// Left = right, the equals signs under each other unless a left side is long.
fn aligned<'a>(pairs: impl Iterator<Item = (&'a String, &'a String)> + Clone) -> Vec<String> {
    let width = pairs.clone().map(|(left, _)| columns(left)).filter(|&width| width <= 24).max().unwrap_or(0);
    pairs.map(|(left, right)| format!("{left:width$} = {right}")).collect()
}

/// The brackets [X_r, X_s] = c_rs^m X_m that are not zero, by the names of the quasi-velocities, `t` for time.
pub fn brackets(equations: &Equations<'_>) -> Vec<String> {
    let system = equations.system();
    let structure = system.structure();
    let name = operator_names(system.quasi_velocities(), "t");
    let k = structure.operators();
    let mut lines = Vec::new();
    for (r, s) in (0..=k).flat_map(|r| (r + 1..=k).map(move |s| (r, s))) {
        let sum = combination((1..=k).map(|m| (structure.get(r, s, m).to_string(), name[m].clone())));
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
        .map(|row| row.iter().map(Expr::to_string).collect())
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
    let system = equations.system();
    let frame = system.frame();
    let strings = |list: &[Expr<'_>]| list.iter().map(Expr::to_string).collect::<Vec<_>>();
    let matrix = |rows: Vec<Vec<Expr<'_>>>| rows.iter().map(|row| strings(row)).collect::<Vec<_>>();
    let name = operator_names(system.quasi_velocities(), "0");
    let structure: Vec<Value> = system
        .structure()
        .nonzero()
        .map(|(r, s, m, c)| json!({ "r": name[r], "s": name[s], "m": name[m], "value": c.to_string() }))
        .collect();
    let parameters: Map<String, Value> =
        system.parameters().iter().map(|(symbol, value)| (symbol.to_string(), json!(value))).collect();
    json!({
        "model": title,
        "coordinates": strings(frame.coordinates()),
        "quasi_velocities": strings(system.quasi_velocities()),
        "parameters": parameters,
        "kinematics": { "b": matrix(frame.b().to_rows()), "b_0": strings(frame.b0()) },
        "structure_coefficients": structure,
        "mass_matrix": matrix(equations.mass_matrix().to_rows()),
        "equations": strings(equations.right_hand_side()),
        "energy": equations.energy().to_string(),
        "operations": { "free": counts(&operations.free), "bound": counts(&operations.bound) },
    })
}

fn counts(cost: &Cost) -> Value {
    let kinds = cost.iter().map(|(kind, count)| (kind.to_owned(), json!(count)));
    Value::Object(std::iter::once(("total".to_owned(), json!(cost.total()))).chain(kinds).collect())
}
