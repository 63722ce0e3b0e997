//! `pc derive`: the equations of motion, printed.

use pc_algebra::{CATALOGUE, LieAlgebra, StructureCoefficients};
use pc_expr::{Cost, ExprError, Inputs, Program};
use pc_mech::{Canonical, Constraint, Equations, Expr, Graph, MechError, Multipliers, Style, System};
use pc_model::Assembly;
use pc_nonholo::{Kind, NonholoError, Voronets};
use serde_json::{Map, Value, json};

use crate::args::{DeriveArguments, Form, Page};
use crate::binding::{constraint_objects, constraints, energy_remark, say_dropped, say_moved};
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
    let assembly = model.assemble(&graph)?;
    say_dropped(&assembly);
    say_moved(&assembly);
    let title = input::title(&model);
    let page = page(arguments, title, &assembly).map_err(|error| model.constraint_error(error))?;
    print(|out| write!(out, "{page}"))
}

/// The equations in the form and format that are asked for.
fn page(arguments: &DeriveArguments, title: &str, assembly: &Assembly<'_>) -> Result<String, NonholoError> {
    if arguments.form == Form::Canonical {
        let (_, derived) = Derived::new(arguments.form, assembly)?;
        let equations = assembly.free_system()?.canonical()?;
        let operations = Operations::of_canonical(&equations).map_err(MechError::from)?;
        let heading = format!("{title}: canonical equations");
        return Ok(match arguments.format {
            Page::Text => underlined(&heading) + &canonical::text(&derived, &equations, &operations),
            Page::Latex => latex::canonical_page(&heading, &derived, &equations),
            Page::Json => format!("{:#}\n", canonical::object(title, &derived, &equations, &operations)),
        });
    }
    let (name, derived) = Derived::new(arguments.form, assembly)?;
    let heading = format!("{title}: {name}");
    let operations = Operations::of(&derived.equations).map_err(MechError::from)?;
    Ok(match arguments.format {
        Page::Text => underlined(&heading) + &text(&derived, &operations),
        Page::Latex => latex::page(&heading, &derived),
        Page::Json => format!("{:#}\n", object(title, &derived, &operations)),
    })
}

/// Equations of motion with what belongs to them.
#[derive(Clone, Debug)]
pub struct Derived<'g> {
    /// M η̇ = r of the independent quasi-velocities.
    pub equations: Equations<'g>,
    /// The quasi-velocities that constraints keep at zero, over which brackets are summed too.
    pub vanishing: Vec<Expr<'g>>,
    /// The constraints with what they do.
    pub constraints: Vec<(Constraint<'g>, Kind)>,
    /// What the quasi-velocities that vanish are in velocities, where that is known.
    pub definitions: Vec<(Expr<'g>, Expr<'g>)>,
    /// The reactions with what they are equal to.
    pub reactions: Vec<(Expr<'g>, Expr<'g>)>,
    /// What is to be known of the energy.
    pub energy_remark: Option<&'static str>,
}

impl<'g> Derived<'g> {
    /// The equations in a form, with its name.
    fn new(form: Form, assembly: &Assembly<'g>) -> Result<(&'static str, Derived<'g>), NonholoError> {
        let (bound, system) = (&assembly.bound, &assembly.system);
        let multipliers = bound.multipliers();
        let kinds = bound.verdicts().iter().map(|verdict| verdict.kind);
        let constraints = multipliers.map(Multipliers::constraints).unwrap_or_default();
        let plain = Derived {
            equations: assembly.equations()?,
            vanishing: Vec::new(),
            constraints: constraints.iter().cloned().zip(kinds.clone()).collect(),
            definitions: Vec::new(),
            reactions: Vec::new(),
            energy_remark: energy_remark(assembly),
        };
        let with = |equations: Equations<'g>, multipliers: &Multipliers<'g>| Derived {
            equations,
            constraints: multipliers.constraints().iter().cloned().zip(kinds.clone()).collect(),
            ..plain.clone()
        };
        Ok(match (form, multipliers) {
            (Form::Lagrange | Form::Voronets, None) => {
                ("Lagrange's equations", Derived { equations: system.in_velocities()?.poincare()?, ..plain })
            }
            (Form::Lagrange, Some(multipliers)) => {
                let held = multipliers.in_velocities()?;
                let system = held.equations().system().with_added_forces(&held.reaction_forces())?;
                let derived = with(system.poincare()?, &held);
                ("Lagrange's equations with multipliers", Derived { energy_remark: None, ..derived })
            }
            (Form::Voronets, Some(multipliers)) => {
                let held = multipliers.in_velocities()?;
                let mut transform = system.velocity_transform()?;
                let start = transform.to_velocities(assembly.t_start, &assembly.start);
                let lagrange = held.equations().system();
                let state = lagrange.frame().coordinates().iter().chain(lagrange.quasi_velocities()).copied();
                let mut at: Vec<(Expr<'g>, f64)> = state.zip(start).collect();
                at.push((lagrange.frame().time(), assembly.t_start));
                let voronets = Voronets::new(&held, &at)?;
                let name =
                    if voronets.is_chaplygin() { "Chaplygin's equations" } else { "Voronets' equations" };
                (name, with(voronets.system()?.poincare()?, &held))
            }
            (Form::Poincare, Some(held)) if held.is_nonlinear() => {
                let system = held.equations().system().with_added_forces(&held.reaction_forces())?;
                let reactions = bound.reactions(&assembly.at_start())?;
                let name = "Poincaré's equations with multipliers";
                (name, Derived { reactions, ..with(system.poincare()?, held) })
            }
            (Form::Poincare | Form::Canonical, _) => {
                let reduced = bound.constrained(&assembly.at_start())?;
                let name = "Poincaré's equations";
                match (reduced, multipliers) {
                    (Some(constrained), Some(multipliers)) => {
                        let reactions = bound.reactions(&assembly.at_start())?;
                        let vanishing = constrained.vanishing().to_vec();
                        let in_velocities = multipliers.in_velocities().ok();
                        let velocities = in_velocities.iter().flat_map(|held| held.velocities().to_vec());
                        let definitions = multipliers.constraints().iter().map(Constraint::expression);
                        let definitions = definitions.zip(velocities).collect();
                        (name, Derived { vanishing, definitions, reactions, ..plain })
                    }
                    _ => (name, plain),
                }
            }
        })
    }
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
        let time = system.frame().time();
        let state: Vec<Expr<'g>> = system.frame().coordinates().iter().chain(moving).copied().collect();
        // Parameters, and what else stands in the equations: external forces, reactions.
        let others = graph.symbols_of(rates).into_iter().filter(|x| *x != time && !state.contains(x));
        let inputs = Inputs { time: Some(time), parameters: others.collect(), state };
        let numbers: Vec<_> =
            system.parameters().iter().map(|&(symbol, value)| (symbol, value.into())).collect();
        let bound = graph.substitute(rates, &numbers);
        Ok(Operations {
            free: Program::new(graph, &inputs, rates)?.cost(),
            bound: Program::new(graph, &inputs, &bound)?.cost(),
        })
    }
}

/// The equations as a book prints them: constraints, kinematics, brackets, mass matrix, M η̇ = r, energy, reactions,
/// operations.
pub fn text(derived: &Derived<'_>, operations: &Operations) -> String {
    let equations = &derived.equations;
    let reactions: Vec<(String, String)> = derived
        .reactions
        .iter()
        .map(|(reaction, value)| (reaction.display(Style::Book), value.display(Style::Book)))
        .collect();
    sections(&[
        ("Constraints", constraints(derived)),
        ("Kinematics", kinematics(equations.system(), equations.velocities())),
        ("Brackets", brackets(equations.system(), &derived.vanishing)),
        ("Mass matrix", mass_matrix(equations)),
        ("Equations", balance(equations)),
        ("Energy", derived.with_remark(equations.energy().display(Style::Book))),
        ("Reactions", aligned(reactions.iter().map(|(left, right)| (left, right)))),
        ("Operations of one right-hand side", operations.lines()),
    ])
}

impl<'g> Derived<'g> {
    /// The energy, and a line with what is to be known of it.
    pub fn with_remark(&self, energy: String) -> Vec<String> {
        [energy].into_iter().chain(self.energy_remark.map(|remark| format!("({remark})"))).collect()
    }

    /// The left-hand side of a constraint, written out if it is a quasi-velocity.
    pub fn vanishing(&self, constraint: &Constraint<'g>) -> Expr<'g> {
        let expression = constraint.expression();
        let known =
            self.definitions.iter().find(|(eta, _)| *eta == expression && self.vanishing.contains(eta));
        known.map_or(expression, |&(_, definition)| definition)
    }
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

/// ẋ_i = `velocities`, a line each but for those that are quasi-velocities themselves.
pub fn kinematics(system: &System<'_>, velocities: &[Expr<'_>]) -> Vec<String> {
    let rates = system.frame().coordinates().iter().map(|x| format!("{x}'"));
    let velocities = velocities.iter().map(|v| v.display(Style::Book));
    let lines: Vec<(String, String)> =
        rates.zip(velocities).filter(|(rate, velocity)| rate != velocity).collect();
    aligned(lines.iter().map(|(rate, velocity)| (rate, velocity)))
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

/// The brackets [X_r, X_s] = c_rs^m X_m of the free operators that are not zero, by the names of the quasi-velocities,
/// `t` for time; they may have components along `vanishing`.
pub fn brackets(system: &System<'_>, vanishing: &[Expr<'_>]) -> Vec<String> {
    let structure = system.structure();
    let free = system.quasi_velocities();
    let all: Vec<String> = free.iter().chain(vanishing).map(Expr::to_string).collect();
    let name: Vec<String> = std::iter::once("t".to_owned()).chain(all).collect();
    let mut lines = Vec::new();
    for (r, s) in (0..=free.len()).flat_map(|r| (r + 1..=free.len()).map(move |s| (r, s))) {
        let components = 1..=structure.operators().min(name.len() - 1);
        let sum =
            combination(components.map(|m| (structure.get(r, s, m).display(Style::Book), name[m].clone())));
        if sum != "0" {
            lines.push(format!("[{}, {}] = {sum}", name[r], name[s]));
        }
    }
    let pairs = (0..=free.len()).flat_map(|r| (r + 1..=free.len()).map(move |s| (r, s)));
    let frame = system.frame();
    let commute = || pairs.into_iter().all(|(r, s)| frame.commutator(r, s).iter().all(|c| c.is_zero()));
    if lines.is_empty() {
        let words = if commute() {
            "all operators commute"
        } else {
            "none within the frame, which is not closed: the constraints are not integrable"
        };
        lines.push(words.to_owned());
    } else if let Some(known) = recognised(structure).filter(|_| vanishing.is_empty()) {
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
pub fn object(title: &str, derived: &Derived<'_>, operations: &Operations) -> Value {
    let equations = &derived.equations;
    let mut object = description(title, equations.system(), &derived.vanishing);
    if !derived.constraints.is_empty() {
        object.insert("constraints".to_owned(), constraint_objects(derived));
        let reactions =
            derived.reactions.iter().map(|(name, value)| (name.to_string(), json!(value.to_string())));
        object.insert("reactions".to_owned(), Value::Object(reactions.collect()));
    }
    object.insert("mass_matrix".to_owned(), json!(matrix(&equations.mass_matrix().to_rows())));
    object.insert("equations".to_owned(), json!(strings(equations.right_hand_side())));
    object.insert("energy".to_owned(), json!(equations.energy().to_string()));
    if let Some(remark) = derived.energy_remark {
        object.insert("energy_remark".to_owned(), json!(remark));
    }
    object.insert("operations".to_owned(), operations.object());
    Value::Object(object)
}

/// What all forms of the equations have in common.
pub fn description(title: &str, system: &System<'_>, vanishing: &[Expr<'_>]) -> Map<String, Value> {
    let frame = system.frame();
    let name = operator_names(&[system.quasi_velocities(), vanishing].concat(), "0");
    let free = system.quasi_velocities().len();
    let structure: Vec<Value> = system
        .structure()
        .nonzero()
        .filter(|&(r, s, m, _)| r <= free && s <= free && m < name.len())
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
