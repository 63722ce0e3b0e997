//! The main demonstration: the heavy top of Lagrange, from its text to its motion.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use pc_cli::commands::report;
use pc_cli::commands::run::drawn;
use pc_cli::output::destination::Destination;
use pc_mech::Graph;
use pc_model::document::AbsoluteTolerance;
use pc_model::{Builtin, Model};
use pc_print::{Form, Layout, Page, columns, page, small};
use pc_report::picture::Wanted;
use pc_run::Wishes;
use pc_run::motion::integrate::Besides;
use pc_run::motion::run::Run;
use pc_run::observer::Nobody;
use pc_solve::Method;

const MODEL: &str = "heavy-top-lagrange";
/// γ and ω at t = 10, computed elsewhere to 1e-13.
const REFERENCE: [f64; 6] = [
    -0.5983375993973925,
    -0.1486439622069561,
    0.7873354365496211,
    -0.06583376642272503,
    -0.2664489483922874,
    3.0,
];
/// Rounding and the tolerance 1e-12, with room for what grows along the motion.
const TOLERANCE: f64 = 1e-8;

fn main() -> ExitCode {
    match demonstrate() {
        Ok(difference) if difference <= TOLERANCE => ExitCode::SUCCESS,
        Ok(_) => {
            println!("\n  The end state is NOT that of the reference.");
            ExitCode::FAILURE
        }
        Err(error) => {
            eprintln!("demo: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Shows everything and returns the largest difference from the reference.
fn demonstrate() -> Result<f64, Box<dyn Error>> {
    let builtin = Builtin::named(MODEL).ok_or("the built-in model is gone")?;
    let model = Model::new(builtin.document()?);

    title("The heavy top of Lagrange: from a text model to its motion");
    println!("  A model says how coordinates move with quasi-velocities, and what the energy is.");
    println!("  The equations of Poincaré and Chetaev are derived from it, compiled and integrated.");

    section(&format!("the model, in part (pc run {MODEL})"));
    show_model(builtin.text);

    section("the equations derived from it");
    let graph = Graph::new();
    let assembly = model.assemble(&graph)?;
    let printed = page(Form::Poincare, Page::Text, &Layout::default(), model.title(), &assembly)?;
    for heading in ["Kinematics", "Brackets", "Equations"] {
        let lines = printed.lines().skip_while(|line| *line != heading).skip(1);
        lines.take_while(|line| !line.is_empty()).for_each(|line| println!("{line}"));
    }

    section("the motion, relative tolerance 1e-12");
    let run = |samples| {
        let wishes = Wishes {
            t_end: Some(10.0),
            samples: Some(samples),
            rtol: Some(1e-12),
            atol: AbsoluteTolerance { all: Some(1e-14), each: Vec::new() },
            method: Some(Method::Adams),
            ..Wishes::default()
        };
        Run::of(&model, &wishes, &Besides::shown(), None, &Nobody)
    };
    let table = run(11)?;
    show_table(&table);

    section("what the motion keeps: largest change of each integral");
    let fine = run(1001)?;
    for (name, meaning) in [
        ("energy", "kinetic plus potential energy"),
        ("area", "angular momentum about the vertical"),
        ("norm", "|γ|², since γ is a unit vector"),
    ] {
        let column = fine.table.columns().iter().position(|column| column == name);
        let drift = fine.table.drift(column.ok_or("an integral is gone")?);
        println!("  {name:8}{:>9}    {meaning}", small(drift.absolute));
    }

    section("the result");
    for file in draw(&fine)? {
        println!("  drawn     {}", file.display());
    }
    println!("  report    {}, to be opened in a browser", show_page(&model, &fine)?.display());
    let work = &fine.statistics;
    println!(
        "  work      {} steps, {} evaluations in {:.2} ms",
        work.steps,
        work.rhs_evaluations,
        fine.wall.as_secs_f64() * 1e3
    );
    let end = fine.table.rows().next_back().ok_or("the motion is empty")?;
    let difference = end[1..].iter().zip(REFERENCE).map(|(value, right)| (value - right).abs());
    let difference = difference.fold(0.0, f64::max);
    println!("  at t = 10 the state differs from the reference by at most {}", small(difference));
    Ok(difference)
}

fn title(title: &str) {
    println!("\n  {title}\n  {}\n", "═".repeat(columns(title)));
}

fn section(title: &str) {
    println!("\n── {title} {}", "─".repeat(94_usize.saturating_sub(columns(title))));
}

/// The sections that make the mechanics, without comments.
fn show_model(model: &str) {
    let mut shown = false;
    for line in model.lines().map(|line| line.split('#').next().unwrap_or("").trim_end()) {
        if line.starts_with('[') {
            shown = ["[kinematics]", "[algebra]", "[lagrangian]"].contains(&line);
        }
        if shown && !line.is_empty() {
            println!("  {line}");
        }
    }
}

fn show_table(run: &Run) {
    let table = &run.table;
    let shown = 0..table.quasi_velocities().end;
    let header: String = table.columns()[shown.clone()].iter().map(|name| format!("{name:>12}")).collect();
    println!("{header}");
    for row in table.rows() {
        let cells: String = row[shown.clone()]
            .iter()
            .enumerate()
            .map(|(j, value)| if j == 0 { format!("{value:12}") } else { format!("{value:12.7}") })
            .collect();
        println!("{cells}");
    }
}

fn workspace() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap_or(Path::new("."))
}

/// `target/demo`, which is there then.
fn directory() -> Result<PathBuf, Box<dyn Error>> {
    let directory = Path::new("target").join("demo");
    fs::create_dir_all(workspace().join(&directory))?;
    Ok(directory)
}

/// Writes the page of all that is known of the model.
fn show_page(model: &Model, run: &Run) -> Result<PathBuf, Box<dyn Error>> {
    let file = directory()?.join("heavy-top.html");
    Destination::page(Some(&workspace().join(&file)))?.write_page(&report::page(model, run)?)?;
    Ok(file)
}

/// Draws the motion.
fn draw(run: &Run) -> Result<Vec<PathBuf>, Box<dyn Error>> {
    let (workspace, directory) = (workspace(), directory()?);
    let picture = drawn(run, &Wanted::default())?;
    let mut files = Vec::new();
    for name in ["heavy-top.svg", "heavy-top.png"] {
        let file = directory.join(name);
        if let Some(destination) = Destination::plot(Some(&workspace.join(&file)))? {
            destination.write_plot(&picture)?;
        }
        files.push(file);
    }
    Ok(files)
}
