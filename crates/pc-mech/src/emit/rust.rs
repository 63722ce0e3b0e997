//! Writes the source file for Rust.

use std::fmt::Write;

use crate::emit::source::{EmittedFile, Extent, Routine, Source};

/// The names of the constants in the file, which local variables must not have.
pub(super) const CONSTANTS: &[&str] = &[
    "COORDINATES",
    "QUASI_VELOCITIES",
    "STATES",
    "DIM",
    "PARAMETERS",
    "INTEGRALS",
    "OUTPUTS",
    "NAMES",
    "PARAMETER_NAMES",
    "DEFAULT_PARAMETERS",
    "INTEGRAL_NAMES",
    "OUTPUT_NAMES",
    "START",
    "T_START",
    "T_END",
    "CODE",
    "PLACES",
    "NUMBERS",
];

pub(super) fn files(source: &Source<'_>) -> Vec<EmittedFile> {
    let name = format!("{}.rs", source.name);
    let mut text = String::new();
    for line in fenced(&source.head()).into_iter().chain(usage(source, &name)) {
        text += format!("//! {line}").trim_end();
        text += "\n";
    }
    text += "\n#![allow(clippy::all, dead_code, non_snake_case, unexpected_cfgs)]\n\n";
    constants(source, &mut text);
    text += source.shared.as_ref().map_or("", |shared| &shared.support);
    for routine in &source.routines {
        function(source, routine, &mut text);
    }
    text += &source.options.language.helpers(&source.calls(), "");
    if source.options.start.is_some() {
        text += MAIN;
    }
    vec![EmittedFile { name, text }]
}

/// Encloses indented lines between fences: rustdoc would otherwise take the lines for Rust and test them.
fn fenced(lines: &[String]) -> Vec<String> {
    let mut fenced = Vec::new();
    for run in lines.chunk_by(|a, b| a.starts_with("    ") == b.starts_with("    ")) {
        if run[0].starts_with("    ") {
            fenced.push("```text".to_owned());
            fenced.extend(run.iter().map(|line| line.trim_start().to_owned()));
            fenced.push("```".to_owned());
        } else {
            fenced.extend_from_slice(run);
        }
    }
    fenced
}

fn usage(source: &Source<'_>, file: &str) -> Vec<String> {
    let module = &source.name;
    let mut text = String::from("\n# Use\n\n");
    if source.options.start.is_some() {
        let _ = write!(
            text,
            "To try it:\n```text\nrustc -O --cfg pc_main {file} && ./{module}\n```\nThis integrates from [`START`] and \
             prints t, the state and the energy.\n\n"
        );
    }
    let _ = write!(
        text,
        "In a crate, `mod {module};` is enough. For one without `std` add to its `Cargo.toml`\n```toml\n[dependencies]\n\
         libm = {{ version = \"0.2\", optional = true }}\n\n[features]\ndefault = [\"libm\"]\nlibm = [\"dep:libm\"]\n```\n\
         and the elementary functions are those of `libm`. Nothing is allocated."
    );
    text.lines().map(str::to_owned).collect()
}

fn constants(source: &Source<'_>, text: &mut String) {
    let sizes = [
        ("COORDINATES", source.coordinates, "Number of coordinates, which come first in the state"),
        ("QUASI_VELOCITIES", source.quasi_velocities(), "Number of quasi-velocities"),
        ("DIM", source.state.len(), "Length of the state"),
        ("PARAMETERS", source.parameters.len(), "Number of parameters"),
        ("INTEGRALS", source.integrals.len(), "Number of integrals"),
        ("OUTPUTS", source.outputs.len(), "Number of outputs"),
    ];
    let states = ("STATES", source.states, "Number of first-order states, which come last in the state");
    let states = (source.states > 0).then_some(states);
    for (name, value, purpose) in sizes[..2].iter().copied().chain(states).chain(sizes[2..].iter().copied()) {
        let _ = writeln!(text, "/// {purpose}.\npub const {name}: usize = {value};");
    }
    let mut array = |name: &str, kind: &str, size: &str, purpose: &str, entries: String| {
        let _ = write!(text, "\n/// {purpose}.\npub const {name}: [{kind}; {size}] = ");
        let _ = match entries.chars().count() + name.len() + size.len() < 80 {
            true => writeln!(text, "[{entries}];"),
            false => writeln!(text, "[\n    {entries},\n];"),
        };
    };
    let (names, values): (Vec<_>, Vec<_>) = source.parameters.iter().cloned().unzip();
    array("NAMES", "&str", "DIM", "Names of the state", source.strings(source.state.iter()));
    array("PARAMETER_NAMES", "&str", "PARAMETERS", "Names of the parameters", source.strings(names.iter()));
    let values = source.constants(values.into_iter());
    array("DEFAULT_PARAMETERS", "f64", "PARAMETERS", "Values of the parameters", values);
    array(
        "INTEGRAL_NAMES",
        "&str",
        "INTEGRALS",
        "Names of the integrals",
        source.strings(source.integrals.iter()),
    );
    array("OUTPUT_NAMES", "&str", "OUTPUTS", "Names of the outputs", source.strings(source.outputs.iter()));
    if let Some(start) = &source.options.start {
        array("START", "f64", "DIM", "A state to start from", source.constants(start.state.iter().copied()));
        let times = [("T_START", start.t, "Time of the start"), ("T_END", start.t_end, "An end time")];
        for (name, value, purpose) in times {
            let value = source.constants([value].into_iter());
            let _ = writeln!(text, "/// {purpose}.\npub const {name}: f64 = {value};");
        }
    }
}

fn function(source: &Source<'_>, routine: &Routine, text: &mut String) {
    let size = match routine.extent {
        Extent::One => String::new(),
        Extent::State => "DIM".to_owned(),
        Extent::StateSquared => "DIM * DIM".to_owned(),
        Extent::QuasiVelocitiesSquared => "QUASI_VELOCITIES * QUASI_VELOCITIES".to_owned(),
        Extent::Integrals => "INTEGRALS".to_owned(),
        Extent::Outputs => "OUTPUTS".to_owned(),
        Extent::Count(count) => count.to_string(),
    };
    let parameters = if routine.directional { "DIM + 2 * PARAMETERS" } else { "PARAMETERS" };
    let purpose = source.options.language.comment(&routine.purpose);
    let verb = if routine.extent == Extent::One { "Returns" } else { "Writes" };
    let _ = writeln!(text, "\n/// {verb} {purpose}.");
    let Routine { name, array, .. } = routine;
    let mut arguments =
        vec!["t: f64".to_owned(), "y: &[f64; DIM]".to_owned(), format!("p: &[f64; {parameters}]")];
    let mut result = "";
    match routine.extent {
        Extent::One => result = " -> f64",
        _ => arguments.push(format!("{array}: &mut [f64; {size}]")),
    }
    let one_line = format!("pub fn {name}({}){result} {{\n", arguments.join(", "));
    *text += &if one_line.len() <= 100 {
        one_line
    } else {
        format!("pub fn {name}(\n    {},\n){result} {{\n", arguments.join(",\n    "))
    };
    *text += &routine.body.inputs;
    if !routine.body.inputs.is_empty() {
        *text += "\n";
    }
    if routine.sparse {
        let _ = writeln!(text, "    *{array} = [0.0; {size}];");
    }
    *text += &routine.body.statements;
    *text += "}\n";
}

const MAIN: &str = r#"
/// One step of the classical Runge-Kutta method of fourth order, from t to t + h.
#[cfg(pc_main)]
fn runge_kutta(t: f64, h: f64, p: &[f64; PARAMETERS], y: &mut [f64; DIM]) {
    let [mut k1, mut k2, mut k3, mut k4] = [[0.0; DIM]; 4];
    let along = |y: &[f64; DIM], h: f64, k: &[f64; DIM]| -> [f64; DIM] {
        let mut z = *y;
        for i in 0..DIM {
            z[i] += h * k[i];
        }
        z
    };
    rhs(t, y, p, &mut k1);
    rhs(t + h / 2.0, &along(y, h / 2.0, &k1), p, &mut k2);
    rhs(t + h / 2.0, &along(y, h / 2.0, &k2), p, &mut k3);
    rhs(t + h, &along(y, h, &k3), p, &mut k4);
    for i in 0..DIM {
        y[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
    }
}

#[cfg(pc_main)]
fn main() {
    let (rows, steps) = (20, 500); // rows after the first, and steps between two
    let h = (T_END - T_START) / (rows * steps) as f64;
    let (p, mut y) = (&DEFAULT_PARAMETERS, START);
    println!("t,{},energy", NAMES.join(","));
    for n in 0..=rows * steps {
        let t = T_START + n as f64 * h;
        if n % steps == 0 {
            let state = y.iter().map(|y| y.to_string()).collect::<Vec<_>>();
            println!("{},{},{}", t, state.join(","), energy(t, &y, p));
        }
        runge_kutta(t, h, p, &mut y);
    }
}
"#;
