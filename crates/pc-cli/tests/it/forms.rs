//! The forms of the equations on the command line: printed, run, written as source, and refused.

use std::process::{Command, Output};

fn pc(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pc")).args(arguments).output().expect("pc runs")
}

fn said(arguments: &[&str]) -> String {
    let output = pc(arguments);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("UTF-8")
}

#[track_caller]
fn refused(arguments: &[&str], code: i32, message: &str) {
    let output = pc(arguments);
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(code), "{error}");
    assert!(error.contains(message), "{error}");
    assert!(output.stdout.is_empty(), "{error}");
}

#[test]
fn forms_are_printed_under_their_names() {
    let sleigh = "chaplygin-sleigh";
    for (form, more, heading, equation) in [
        ("reduced", "", "Euler–Poincaré equations", "  ω' (J + m a²) = -m a v ω\n"),
        ("lie-poisson", "", "Lie–Poisson equations", "  p_ω' = -a p_v p_ω/(J + m a²)\n"),
        ("orthonormal", "", "Poincaré's equations in an orthonormal frame", "  diag(1, 1)\n"),
        ("hamel", "p=v+2*ω", "Hamel's equations", "Quasi-velocities\n  p = v + 2 ω\n"),
        ("maggi", "", "Maggi's equations", "  E_X cos(φ) + E_Y sin(φ) = 0\n  E_φ                     = 0\n"),
        ("kane", "", "Kane's equations", "  F*(v) = m a ω² - m v'\n"),
        ("gibbs-appell", "", "Gibbs–Appell's equations", "  m a v ω + ω' (J + m a²) = 0\n"),
    ] {
        let mut arguments = vec!["derive", sleigh, "--form", form];
        arguments.extend((!more.is_empty()).then_some(more));
        let text = said(&arguments);
        assert!(text.contains(heading), "{text}");
        let alike = |text: &str| text.replace("m a² + J", "J + m a²");
        assert!(alike(&text).contains(equation), "{text}");
        let page = said(&[&arguments[..], &["--format", "latex"]].concat());
        assert!(page.contains("\\paragraph{Equations.}\n\\begin{align*}"), "{page}");
        let object = said(&[&arguments[..], &["--format", "json"]].concat());
        let object: serde_json::Value = serde_json::from_str(&object).expect("JSON");
        if form == "hamel" {
            assert_eq!(object["quasi_velocity_definitions"]["p"], "v + 2*ω");
        }
        assert_eq!(object["quasi_velocities"].as_array().map(Vec::len), Some(2));
    }
}

/// The coefficients c_ji^r of (35), in the brackets of ∂/∂x_i + α_ri ∂/∂x_r; those with time are c_0i^r. In the frame of the
/// constraint the same bracket is found from the operators alone.
#[test]
fn coefficients_of_voronets_are_printed() {
    let bracket = |text: String, head: &str| -> Option<String> {
        Some(text.lines().find_map(|line| line.trim().strip_prefix(head))?.to_owned())
    };
    let found = bracket(said(&["derive", "voronets", "--form", "voronets"]), "[x', y'] = ");
    let in_frame = bracket(said(&["derive", "voronets"]), "[vx, vy] = ");
    assert_eq!(found.as_deref(), Some("(x A - x z² + z - 1) z'"));
    assert_eq!(in_frame.map(|right| right.replace("slip", "z'")), found);
    let object = said(&["derive", "voronets-rheonomic", "--form", "voronets", "--format", "json"]);
    let object: serde_json::Value = serde_json::from_str(&object).expect("JSON");
    let structure = object["structure_coefficients"].as_array().expect("a list");
    let indices: Vec<String> =
        structure.iter().map(|c| format!("{} {} {}", c["r"], c["s"], c["m"]).replace('"', "")).collect();
    assert_eq!(indices, ["0 x' z'", "0 y' z'", "x' y' z'"]);
    let page = said(&["derive", "voronets", "--form", "voronets", "--format", "latex"]);
    assert!(page.contains("[X_{\\dot{x}}, X_{\\dot{y}}]"), "{page}");
}

/// All forms have the columns of the model, except the coordinates that a reduced form lacks; each
/// run is compared with a second derivation.
#[test]
fn runs_show_the_columns_of_the_model() {
    let sleigh = ["run", "chaplygin-sleigh", "--rows", "3"];
    let header = |more: &[&str]| {
        let output = pc(&[&sleigh, more].concat());
        let summary = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(summary.contains("by a second derivation, which agrees"), "{summary}");
        let table = String::from_utf8(output.stdout).expect("UTF-8");
        let last: Vec<f64> =
            table.lines().last().expect("rows").split(',').map(|x| x.parse().expect("a number")).collect();
        let names: Vec<String> =
            table.lines().next().expect("a head").split(',').map(str::to_owned).collect();
        (names, last)
    };
    let (names, end) = header(&[]);
    let of = |name: &str| end[names.iter().position(|known| known == name).expect("a column")];
    for (more, first) in [
        (&["--form", "reduced"][..], "v"),
        (&["--form", "lie-poisson"], "v"),
        (&["--form", "orthonormal"], "X"),
        (&["--form", "hamel", "p=v+2*ω"], "X"),
    ] {
        let (own, last) = header(more);
        assert_eq!(own[1], first, "{own:?}");
        for (name, value) in own.iter().zip(last) {
            let expected = if name == "p" { of("v") + 2.0 * of("ω") } else { of(name) };
            // Errors of about 1e-9 per step.
            assert!((value - expected).abs() < 1e-6, "{more:?}: {name} is {value}, not {expected}");
        }
    }
}

#[test]
fn source_is_written_in_forms_and_without_a_jacobian() {
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().to_str().expect("UTF-8");
    for (more, has) in [
        (&["--form", "reduced"][..], "y[0]  v\n"),
        (&["--form", "orthonormal"], "y[3]  η1\n"),
        (&["--form", "hamel", "p=v+2*ω", "--no-jacobian"], "y[3]  p\n"),
        (&["--form", "voronets"], "y[3]  X'\n"),
    ] {
        said(&[&["emit", "chaplygin-sleigh", "--lang", "c", "-o", path], more].concat());
        let files = std::fs::read_dir(path).expect("a directory").flatten();
        let texts: Vec<String> = files.filter_map(|file| std::fs::read_to_string(file.path()).ok()).collect();
        let text = texts.concat();
        assert!(text.contains(has), "{text}");
        assert_eq!(text.contains("_jacobian("), !more.contains(&"--no-jacobian"), "{text}");
    }
}

#[test]
fn senseless_requests_are_refused() {
    let sleigh = "chaplygin-sleigh";
    refused(&["derive", sleigh, "p=v"], 2, "`p` is a definition, which only --form hamel takes");
    refused(&["derive", sleigh, "--form", "hamel"], 4, "no quasi-velocities are given");
    refused(&["derive", sleigh, "--form", "hamel", "p"], 2, "write NAME=EXPR");
    refused(&["derive", sleigh, "--form", "hamel", "v=ω"], 3, "already the name of a quasi-velocity");
    refused(&["derive", sleigh, "--form", "hamel", "p=v^2"], 3, "is not linear in the velocities");
    refused(&["derive", sleigh, "--form", "hamel", "p=v+1"], 3, "is not linear in the velocities");
    refused(&["derive", sleigh, "--form", "hamel", "p=v", "q=2*v"], 4, "`q` depends on those before it");
    refused(
        &["derive", sleigh, "--form", "hamel", "p=v", "q=ω", "r=v-ω"],
        4,
        "`r` is one quasi-velocity too many",
    );
    refused(&["run", sleigh, "--form", "maggi"], 2, "not supported yet");
    refused(&["run", "vertical-disk", "--form", "voronets"], 4, "choose these with --independent");
    refused(
        &["derive", "appell-hamel", "--form", "kane"],
        4,
        "Kane's equations need constraints that are affine",
    );
    refused(&["derive", "suslov", "--form", "maggi"], 4, "Lagrange's equations need independent coordinates");
    refused(
        &["derive", sleigh, "--form", "canonical", "--reactions"],
        2,
        "has no reactions in its variables",
    );
    refused(
        &["emit", sleigh, "--lang", "c", "-o", "/nowhere", "--form", "canonical"],
        2,
        "not supported yet",
    );
    refused(&["run", "vertical-disk", "--form", "orthonormal"], 4, "choose these with --independent");
    refused(&["derive", "vertical-disk", "--independent", "φ'"], 4, "cannot be the independent");
    refused(&["derive", sleigh, "--independent", "v"], 4, "cannot be the independent");
    refused(&["derive", "relativistic-particle", "--form", "orthonormal"], 4, "L is not quadratic");
}

/// Gibbs' function of the sleigh is ½ m |a|² + ½ J ω̇² with the acceleration (v̇ − aω², vω + aω̇) of its mass centre.
#[test]
fn the_energy_of_accelerations_is_printed() {
    let text = said(&["derive", "chaplygin-sleigh", "--form", "gibbs-appell"]);
    let function = "Gibbs' function\n  m a v ω ω' - m a ω² v' + ½ m v'² + ½ ω'² (m a² + J)\n";
    assert!(text.contains(function), "{text}");
    assert!(text.contains("  (Terms without accelerations are left out: they do not matter.)\n"), "{text}");
    assert!(!text.contains("Brackets"), "{text}");
    let page = said(&["derive", "chaplygin-sleigh", "--form", "kane", "--format", "latex"]);
    for formula in ["\\frac{\\partial \\dot{X}}{\\partial v} &= \\cos \\varphi", "F^{*}_{v} &= "] {
        assert!(page.contains(formula), "{page}");
    }
    let object = said(&["derive", "chaplygin-sleigh", "--form", "kane", "--format", "json"]);
    let object: serde_json::Value = serde_json::from_str(&object).expect("JSON");
    assert_eq!(object["active_forces"], serde_json::json!(["0", "0"]));
    assert_eq!(object["inertia_forces"][0], "m*a*ω^2 - m*v'");
}

/// A heavy particle on a sphere of radius l about the origin.
const SPHERE: &str = r#"
[parameters]
m = 2.0
g = 9.81
l = 1.5
[coordinates]
x = 0.9
y = 0.0
z = -1.2
[quasi_velocities]
"x'" = 0.0
"y'" = 2.0
"z'" = 0.0
[constraints]
sphere = "x^2 + y^2 + z^2 - l^2"
[lagrangian]
kinetic = "m*(x'^2 + y'^2 + z'^2)/2"
potential = "m*g*z"
[simulation]
t_end = 1.0
"#;

/// λ = m (g z − |ṙ|²)/(2 r²) [Lagrange's first kind], as a formula and as the numbers of a run.
#[test]
fn reactions_of_position_constraints_are_formulas() {
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("sphere.toml");
    std::fs::write(&path, SPHERE).expect("written");
    let model = path.to_str().expect("UTF-8");
    let object = said(&["derive", model, "--form", "lagrange", "--reactions", "--format", "json"]);
    let object: serde_json::Value = serde_json::from_str(&object).expect("JSON");
    assert_eq!(object["reaction_forces"]["z'"], "2*z*λ_sphere");
    let written = object["reactions"]["λ_sphere"].as_str().expect("a formula").to_owned();

    let table = said(&["run", model, "--rows", "2", "--outputs", "reactions"]);
    let row: std::collections::BTreeMap<String, String> = last_row(&table).into_iter().collect();
    let of = |name: &str| row[name].parse::<f64>().expect("a number");
    let squares = |names: [&str; 3]| names.map(|name| of(name).powi(2)).iter().sum::<f64>();
    let (speed, radius) = (squares(["x'", "y'", "z'"]), squares(["x", "y", "z"]));
    let expected = 2.0 * (9.81 * of("z") - speed) / (2.0 * radius);
    assert!((of("λ_sphere") - expected).abs() < 1e-9 * expected.abs(), "{row:?}");

    assert_eq!(written, "m*(g*z - x'^2 - y'^2 - z'^2)/(2*(x^2 + y^2 + z^2))");

    // In independent velocities, and by every principle, each compared with the second derivation.
    for form in ["poincare", "voronets", "maggi", "kane", "gibbs-appell"] {
        let text = said(&["derive", model, "--form", form, "--reactions"]);
        assert!(text.contains("\nReactions\n  λ_sphere = "), "{text}");
        assert!(text.contains("\nReaction forces\n"), "{text}");
    }
}

/// Voronets' and Chaplygin's equations have the motion of the model's own, in each model that has them.
#[test]
fn voronets_equations_have_the_same_motion() {
    for model in ["chaplygin-sleigh", "tilted-disk", "snakeboard", "voronets", "charged-particle"] {
        let run = |form: &str| {
            let end = ["--t-end", "0.5", "--rows", "2", "--rtol", "1e-11", "--form", form];
            last_row(&said(&[&["run", model][..], &end].concat()))
        };
        for ((name, own), (other, value)) in run("poincare").iter().zip(run("voronets")) {
            let number = |text: &str| text.parse::<f64>().expect("a number");
            let (own, value) = (number(own), number(&value));
            assert_eq!(*name, other, "{model}");
            assert!((own - value).abs() < 1e-7 * (1.0 + own.abs()), "{model}: {name} is {value}, not {own}");
        }
    }
}

/// A planet whose file gives the velocities along and across the radius as quasi-velocities.
const PLANET: &str = "[coordinates]\nr = 1.0\n\"φ\" = 0.0\n[quasi_velocities]\n\"φ'\" = 1.1\n[lagrangian]\n\
                      kinetic = \"(r'^2 + r^2*φ'^2)/2\"\npotential = \"-1/r\"\n[simulation]\nt_end = 1.0\nsamples = 2\n";

fn file(directory: &tempfile::TempDir, text: &str) -> String {
    let path = directory.path().join("model.toml");
    std::fs::write(&path, text).expect("written");
    path.display().to_string()
}

/// With affine constraints the energy of new quasi-velocities, Y·V − L, is not that of the velocities of the
/// model, y·η − L: they differ by y times the velocities that are left where V is zero.
#[test]
fn the_energy_of_hamel_is_that_of_the_velocities_printed() {
    let directory = tempfile::tempdir().expect("a directory");
    let text = "[coordinates]\nx = 0.3\ny = 0.2\n[constraints]\nk = \"y' - x' - 1\"\n[lagrangian]\n\
                kinetic = \"(x'^2 + y'^2)/2\"\n[simulation]\nt_end = 1.0\n";
    let path = file(&directory, text);
    let text = said(&["derive", &path, "--project-start", "--form", "hamel", "V=x'+y'"]);
    // x' = (V − 1)/2 and y' = (V + 1)/2, hence L = (V² + 1)/4.
    assert!(text.contains("Energy\n  ¼ (V² - 1)\n"), "{text}");
}

/// `derive` and `run` take `form` and `hamel` of a file; the command line has precedence.
#[test]
fn a_file_says_its_form() {
    let directory = tempfile::tempdir().expect("a directory");
    let path =
        file(&directory, &format!("{PLANET}form = \"hamel\"\nhamel = {{ u = \"r'\", v = \"r*φ'\" }}\n"));
    let text = said(&["derive", &path]);
    assert!(text.contains("Hamel's equations") && text.contains("  v' = -u v/r\n"), "{text}");
    assert!(said(&["derive", &path, "--form", "canonical"]).contains("canonical equations"));
    let other = said(&["derive", &path, "--form", "hamel", "v=2*φ'"]);
    assert!(other.contains("v = 2 φ'") && !other.contains("u = r'"), "{other}");
    let table = said(&["run", &path]);
    assert!(table.starts_with("t,r,φ,r',φ',energy,u,v\n"), "{table}");
    // r φ' at the end
    let end: Vec<f64> =
        table.lines().last().expect("rows").split(',').map(|x| x.parse().expect("a number")).collect();
    assert!((end[7] - end[1] * end[4]).abs() < 1e-12, "{table}");
    let reduced = file(&directory, &format!("{PLANET}form = \"reduced\"\n"));
    assert!(said(&["derive", &reduced]).contains("Poincaré's equations, reduced"));
    for (more, message) in [
        ("form = \"hamel\"\n", "add `hamel = { v = \"r*θ'\" }`"),
        ("hamel = { v = \"r*φ'\" }\n", "`hamel` has no effect without `form`"),
        ("form = \"hamel\"\nhamel = { r = \"r*φ'\" }\n", "`r` is already the name of a coordinate"),
        ("form = \"hamel\"\nhamel = { v = \"r*φ'^2\" }\n", "model.toml:13:16:"),
        ("form = \"lagrange\"\n", "lagrange"),
    ] {
        refused(&["derive", &file(&directory, &format!("{PLANET}{more}"))], 3, message);
    }
}

/// `independent` of a file has the effect of `--independent`, which has precedence.
#[test]
fn a_file_says_its_independent_velocities() {
    let text = include_str!("../../../pc-model/models/carriage.toml");
    let directory = tempfile::tempdir().expect("a directory");
    let path =
        file(&directory, &text.replace("[simulation]\n", "[simulation]\nindependent = [\"x'\", \"φ'\"]\n"));
    assert_eq!(said(&["derive", &path]), said(&["derive", "carriage", "--independent", "x',φ'"]));
    let other = ["--independent", "ψ1',ψ2'"];
    assert_eq!(
        said(&[&["derive", path.as_str()][..], &other].concat()),
        said(&[&["derive", "carriage"][..], &other].concat())
    );
    assert_ne!(said(&["derive", &path]), said(&[&["derive", "carriage"][..], &other].concat()));
}

/// A particle in the field −k/r in polar coordinates, with the velocity v = r φ' across.
const ORBIT: &str = r#"
[parameters]
k = 1.0
[coordinates]
r = 1.0
"φ" = 0.0
[quasi_velocities]
"r'" = 0.1
"φ'" = 1.0
[lagrangian]
kinetic = "(r'^2 + r^2*φ'^2)/2"
potential = "-k/r"
[integrals]
area = "r^2*φ'"
[outputs]
distance = "r"
[simulation]
t_end = 1.0
form = "hamel"
hamel = { v = "r*φ'" }
"#;

/// Numbers as they are printed, by the names of their columns.
fn last_row(csv: &str) -> Vec<(String, String)> {
    let cells = |line: &str| line.split(',').map(str::to_owned).collect::<Vec<_>>();
    let names = cells(csv.lines().next().expect("a head"));
    let row = cells(csv.lines().last().expect("a row"));
    assert_eq!(names.len(), row.len(), "{csv}");
    names.into_iter().zip(row).collect()
}

/// The table of a sweep is that of the runs of its members: the same names, the same numbers, in every form.
#[test]
fn sweeps_have_the_columns_and_numbers_of_runs_in_each_form() {
    let directory = tempfile::tempdir().expect("a directory");
    let path = |name: &str| directory.path().join(name).to_str().expect("UTF-8").to_owned();
    let orbit = path("orbit.toml");
    std::fs::write(&orbit, ORBIT).expect("written");
    let given = ["poincare", "canonical", "reduced", "lie-poisson", "orthonormal", "hamel"];
    for (model, parameter, values, forms) in [
        (orbit.as_str(), "k", ["1", "1.2"], &given[..]),
        ("chaplygin-sleigh", "a", ["0.3", "0.45"], &given[..5]),
        ("tilted-disk", "m", ["1", "1.5"], &given[..5]),
        ("swinging-atwood", "g", ["9.81", "4.9"], &given[..5]),
        ("elroys-beanie", "I1", ["1.5", "2"], &given[..5]),
    ] {
        for form in forms {
            // Beside others in vectors the last digits are others.
            let own = ["--form", form, "--t-end", "1", "--method", "adams"];
            let set = format!("{parameter}={}", values[1]);
            let run = |more: &[&str]| {
                let run = ["run", model, "--no-verify", "--set", &set];
                last_row(&said(&[&run[..], &own, more].concat()))
            };
            let vary = format!("{parameter}={},{}", values[0], values[1]);
            let sweep = |name: &str, more: &[&str]| {
                let table = path(name);
                let arguments = [&["sweep", model, "--vary", &vary, "-o", &table][..], &own, more].concat();
                said(&arguments);
                std::fs::read_to_string(&table).expect("a table")
            };
            let swept = sweep("last.csv", &["--rows", "3"]);
            assert_eq!(swept.lines().count(), 1 + 2 * 3, "{model} {form}: {swept}");
            let (swept, run_in_rows) = (last_row(&swept), run(&["--rows", "3"]));
            let run = run(&[]);
            assert_eq!(swept[3..3 + run.len()], run_in_rows, "{model} {form}");
            let names: Vec<&str> = swept[3 + run.len()..].iter().map(|(name, _)| name.as_str()).collect();
            assert_eq!(names, ["steps", "message"], "{model} {form}");

            let with_drifts = last_row(&sweep("drifts.csv", &[]));
            assert_eq!(with_drifts[3..3 + run.len()], run, "{model} {form}");
            let drifts: Vec<_> = with_drifts.iter().filter(|(name, _)| name.starts_with("drift(")).collect();
            let conserved =
                run.iter().filter(|(name, _)| drifts.iter().any(|(d, _)| *d == format!("drift({name})")));
            assert_eq!((drifts.len(), drifts.len()), (conserved.count(), with_drifts.len() - run.len() - 5));
            for (name, drift) in drifts {
                // The tolerance 1e-9 a step, times some hundred steps and values of order 1.
                let drift: f64 = drift.parse().expect("a number");
                assert!(drift.abs() < 1e-6, "{model} {form}: {name} = {drift}");
            }
            // Shards have the same columns, each by itself.
            if !matches!(*form, "reduced" | "hamel") {
                continue;
            }
            for shard in ["1/2", "2/2"] {
                said(
                    &[&["sweep", model, "--vary", &vary, "-o", &path("s.csv"), "--shard", shard][..], &own]
                        .concat(),
                );
            }
            let shards = ["1", "2"].map(|number| path(&format!("s.csv.shard-{number}-of-2")));
            said(&["merge", &shards[0], &shards[1], "-o", &path("s.csv")]);
            let read = |name: &str| std::fs::read_to_string(path(name)).expect("a table");
            assert_eq!(read("s.csv"), read("drifts.csv"), "{model} {form}");
            shards.iter().for_each(|shard| std::fs::remove_file(shard).expect("removed"));
        }
    }
}

/// The columns of a sweep are known where the model as it is has no motion, too: from the first member that has one.
#[test]
fn a_model_that_is_wrong_only_as_it_is_has_columns() {
    let directory = tempfile::tempdir().expect("a directory");
    let path = |name: &str| directory.path().join(name).to_str().expect("UTF-8").to_owned();
    let massless = ORBIT.replace("k = 1.0", "k = 1.0\nm = 0.0").replace("\"(r'", "\"m*(r'");
    std::fs::write(path("model.toml"), massless).expect("written");
    let common = ["--form", "reduced", "--method", "adams"];
    let model = path("model.toml");
    said(&[&["sweep", &model, "--vary", "m=0,2", "-o", &path("a.csv")][..], &common].concat());
    let table = std::fs::read_to_string(path("a.csv")).expect("a table");
    let refused = table.lines().nth(1).expect("a first member");
    assert!(refused.contains(",refused,NaN,NaN,"), "{table}");
    let run = said(&[&["run", &model, "--rows", "2", "--set", "m=2"][..], &common].concat());
    let run = last_row(&run);
    assert_eq!(last_row(&table)[3..3 + run.len()], run);
    assert_eq!(run[1].0, "r");
    assert_eq!(run[2].0, "r'", "nothing depends on φ");
}

/// [X_1, X_2] = X_3 on the rotations, and what the blade of a sleigh forbids.
#[test]
fn brackets_are_printed_as_symbols_of_boltzmann_and_hamel() {
    let text = said(&["derive", "euler-top", "--symbols"]);
    let top =
        "Symbols of Boltzmann and Hamel\n  γ(ω1, ω2; ω3) = 1\n  γ(ω1, ω3; ω2) = -1\n  γ(ω2, ω3; ω1) = 1\n";
    assert!(text.contains(top), "{text}");
    let text = said(&["derive", "chaplygin-sleigh", "--symbols", "--format", "latex"]);
    assert!(text.contains("\\gamma_{v \\omega}^{\\mathrm{blade}} &= -1"), "{text}");
    let text = said(&["derive", "double-pendulum-links", "--symbols"]);
    assert!(text.contains("Brackets\n"), "no symbols where all brackets are zero: {text}");
}
