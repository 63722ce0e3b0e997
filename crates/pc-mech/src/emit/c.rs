//! Writes the header and the source file for C.

use std::fmt::Write;

use crate::emit::source::{EmittedFile, Extent, Routine, Source};

pub(super) fn files(source: &Source<'_>) -> Vec<EmittedFile> {
    let file = |suffix: &str, text: String| EmittedFile { name: format!("{}.{suffix}", source.name), text };
    vec![file("h", header(source)), file("c", body(source))]
}

/// The suffixes of the names of macros.
const MACROS: &[&str] =
    &["N", "K", "STATES", "DIM", "PARAMETERS", "INTEGRALS", "OUTPUTS", "T_START", "T_END", "H", "MAIN"];

/// The macros that the header for `name` defines; local variables must not have these
/// names.
pub(super) fn macros(name: &str) -> Vec<String> {
    MACROS.iter().map(|end| format!("{}_{end}", name.to_uppercase())).collect()
}

/// The name of the source in capitals, for use in macros.
fn capitals(source: &Source<'_>) -> String {
    source.name.to_uppercase()
}

fn declaration(source: &Source<'_>, routine: &Routine) -> String {
    let name = format!("{}_{}", source.name, routine.name);
    let arguments = "double t, const double *y, const double *p";
    match routine.extent {
        Extent::One => format!("double {name}({arguments})"),
        _ => format!("void {name}({arguments}, double *{})", routine.array),
    }
}

fn extent(source: &Source<'_>, extent: Extent) -> String {
    let name = capitals(source);
    match extent {
        Extent::One => "1".to_owned(),
        Extent::State => format!("{name}_DIM"),
        Extent::StateSquared => format!("{name}_DIM*{name}_DIM"),
        Extent::QuasiVelocitiesSquared => format!("{name}_K*{name}_K"),
        Extent::Integrals => format!("{name}_INTEGRALS"),
        Extent::Outputs => format!("{name}_OUTPUTS"),
        Extent::Count(count) => count.to_string(),
    }
}

/// The arrays of the source: for each, its declarator, its contents in words, and its
/// entries.
fn arrays(source: &Source<'_>) -> Vec<(String, &'static str, String)> {
    let (name, capitals) = (&source.name, capitals(source));
    let string = format!("const char *const {name}");
    let mut arrays = vec![(
        format!("{string}_names[{capitals}_DIM]"),
        "Names of the state",
        source.strings(source.state.iter()),
    )];
    if !source.parameters.is_empty() {
        let (names, values): (Vec<_>, Vec<_>) = source.parameters.iter().cloned().unzip();
        arrays.push((
            format!("{string}_parameter_names[{capitals}_PARAMETERS]"),
            "Names of the parameters",
            source.strings(names.iter()),
        ));
        arrays.push((
            format!("const double {name}_default_parameters[{capitals}_PARAMETERS]"),
            "Values of the parameters",
            source.constants(values.into_iter()),
        ));
    }
    let watched = [
        ("integral", "INTEGRALS", "Names of the integrals", &source.integrals),
        ("output", "OUTPUTS", "Names of the outputs", &source.outputs),
    ];
    for (what, size, purpose, names) in watched.into_iter().filter(|(.., names)| !names.is_empty()) {
        arrays.push((
            format!("{string}_{what}_names[{capitals}_{size}]"),
            purpose,
            source.strings(names.iter()),
        ));
    }
    if let Some(start) = &source.options.start {
        arrays.push((
            format!("const double {name}_start[{capitals}_DIM]"),
            "A state to start from",
            source.constants(start.state.iter().copied()),
        ));
    }
    arrays
}

fn header(source: &Source<'_>) -> String {
    let capitals = capitals(source);
    let mut text = String::from("/*\n");
    for line in source.head().into_iter().chain(usage(source)) {
        text += format!(" * {line}").trim_end();
        text += "\n";
    }
    text += " */\n";
    let _ = writeln!(text, "#ifndef {capitals}_H\n#define {capitals}_H\n");
    let mut sizes = vec![
        ("N", source.coordinates.to_string(), "coordinates"),
        ("K", source.quasi_velocities().to_string(), "quasi-velocities"),
        ("DIM", source.state.len().to_string(), "length of the state"),
        ("PARAMETERS", source.parameters.len().to_string(), "parameters"),
        ("INTEGRALS", source.integrals.len().to_string(), "integrals"),
        ("OUTPUTS", source.outputs.len().to_string(), "outputs"),
    ];
    if let Some(start) = &source.options.start {
        sizes.push(("T_START", source.constants([start.t].into_iter()), "time of the start"));
        sizes.push(("T_END", source.constants([start.t_end].into_iter()), "an end time"));
    }
    if source.states > 0 {
        sizes.insert(2, ("STATES", source.states.to_string(), "first-order states"));
    }
    let width = sizes.iter().map(|(_, value, _)| value.len()).max().unwrap_or(0);
    for (size, value, purpose) in sizes {
        let _ = writeln!(text, "#define {capitals}_{size:<10} {value:<width$} /* {purpose} */");
    }
    text += "\n#ifdef __cplusplus\nextern \"C\" {\n#endif\n";
    for (declarator, purpose, _) in arrays(source) {
        let _ = write!(text, "\n/* {purpose}. */\nextern {declarator};\n");
    }
    for routine in &source.routines {
        let verb = if routine.extent == Extent::One { "Returns" } else { "Writes" };
        let purpose = source.options.language.comment(&routine.purpose).replace('`', "");
        let _ = write!(text, "\n/* {verb} {purpose}. */\n{};\n", declaration(source, routine));
    }
    text + &format!("\n#ifdef __cplusplus\n}}\n#endif\n\n#endif /* {capitals}_H */\n")
}

fn usage(source: &Source<'_>) -> Vec<String> {
    let (name, capitals) = (&source.name, capitals(source));
    let command = format!("cc -O2 -fno-tree-slp-vectorize -D{capitals}_MAIN {name}.c -lm");
    let text = match source.options.start {
        Some(_) => format!(
            "To try it:\n    {command} && ./a.out\nwhich integrates from {name}_start and prints t, the state and the \
             energy.\n"
        ),
        None => "Compile it with -O2 -fno-tree-slp-vectorize and link with -lm.\n".to_owned(),
    };
    let text = text
        + "Without -fno-tree-slp-vectorize gcc packs scalars into vectors, which makes such straight-line code slower.\n";
    let text = text
        + if source.options.fused {
            "fma() is fast only with an option such as -march=native, for processors that have it."
        } else {
            "Add -ffp-contract=off for results that are the same to the last bit whether or not the processor can fuse\n\
             a*b + c."
        };
    let end = [
        "",
        "C99 and C++11, in UTF-8. Nothing is allocated or kept between calls. Where an expression is not defined, as",
        "a quotient by zero, results are infinite or NaN.",
    ];
    std::iter::once("").chain(text.lines()).chain(end).map(str::to_owned).collect()
}

fn body(source: &Source<'_>) -> String {
    let name = &source.name;
    let title = source.options.language.comment(&source.options.title);
    let mut text = format!("/* {title}: see {name}.h. */\n#include \"{name}.h\"\n\n#include <math.h>\n\n");
    text += &source.options.language.helpers(&source.calls(), &format!("{name}_"));
    for (declarator, _, entries) in arrays(source) {
        let one_line = format!("{declarator} = {{{entries}}};");
        if one_line.chars().count() <= 110 {
            text += &one_line;
        } else {
            let _ = write!(text, "{declarator} = {{\n    {entries},\n}};");
        }
        text += "\n";
    }
    text += source.shared.as_ref().map_or("", |shared| &shared.support);
    for routine in &source.routines {
        let _ = write!(text, "\n{}\n{{\n{}", declaration(source, routine), routine.body.inputs);
        if !routine.body.inputs.is_empty() {
            text += "\n";
        }
        if routine.sparse {
            let (array, extent) = (routine.array, extent(source, routine.extent));
            let _ = write!(text, "    for (int i = 0; i < {extent}; i++)\n        {array}[i] = 0.0;\n");
        }
        text += &routine.body.statements;
        text += "}\n";
    }
    if source.options.start.is_some() {
        text += &main(source);
    }
    text
}

/// The `main` function: the Runge–Kutta method with fixed steps.
fn main(source: &Source<'_>) -> String {
    let parameters = if source.parameters.is_empty() { "NULL" } else { "@_default_parameters" };
    let text = "
#ifdef $_MAIN

#include <stdio.h>

enum { DIM = $_DIM };

/* One step of the classical Runge-Kutta method of fourth order, from t to t + h. */
static void runge_kutta(double t, double h, const double *p, double *y)
{
    double k1[DIM], k2[DIM], k3[DIM], k4[DIM], z[DIM];
    @_rhs(t, y, p, k1);
    for (int i = 0; i < DIM; i++)
        z[i] = y[i] + h/2*k1[i];
    @_rhs(t + h/2, z, p, k2);
    for (int i = 0; i < DIM; i++)
        z[i] = y[i] + h/2*k2[i];
    @_rhs(t + h/2, z, p, k3);
    for (int i = 0; i < DIM; i++)
        z[i] = y[i] + h*k3[i];
    @_rhs(t + h, z, p, k4);
    for (int i = 0; i < DIM; i++)
        y[i] += h/6*(k1[i] + 2*k2[i] + 2*k3[i] + k4[i]);
}

int main(void)
{
    const int rows = 20, steps = 500; /* rows after the first, and steps between two */
    const double h = ($_T_END - $_T_START)/(rows*steps);
    const double *p = %p;
    double y[DIM];
    for (int i = 0; i < DIM; i++)
        y[i] = @_start[i];

    printf(\"t\");
    for (int i = 0; i < DIM; i++)
        printf(\",%s\", @_names[i]);
    printf(\",energy\\n\");
    for (int n = 0; n <= rows*steps; n++) {
        const double t = $_T_START + n*h;
        if (n % steps == 0) {
            printf(\"%.10g\", t);
            for (int i = 0; i < DIM; i++)
                printf(\",%.16g\", y[i]);
            printf(\",%.16g\\n\", @_energy(t, y, p));
        }
        runge_kutta(t, h, p, y);
    }
    return 0;
}

#endif /* $_MAIN */
";
    text.replace("%p", parameters).replace('$', &capitals(source)).replace('@', &source.name)
}
