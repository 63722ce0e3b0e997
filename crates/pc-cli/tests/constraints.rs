//! Models with `[constraints]` as the program treats them.

use std::io::Write;
use std::process::{Command, Output, Stdio};

use serde_json::{Value, json};

/// Chaplygin's sleigh, its blade a constraint that defines a quasi-velocity.
const SLEIGH: &str = r#"
[model]
name = "Chaplygin sleigh"
[parameters]
m = 1.0
J = 0.5
a = 0.3
[coordinates]
x = 0.0
y = 0.0
phi = 0.4
[quasi_velocities]
v = { is = "cos(phi)*x' + sin(phi)*y'", start = 1.0 }
omega = { is = "phi'", start = 2.0 }
[constraints]
blade = "-sin(phi)*x' + cos(phi)*y'"
[lagrangian]
kinetic = "m/2*(x'^2 + y'^2) + m*a*omega*(cos(phi)*y' - sin(phi)*x') + (J + m*a^2)/2*omega^2"
[simulation]
t_end = 3.0
samples = 4
"#;

/// The same in a frame that has the lateral velocity u, in the middle.
const SLIP: &str = r#"
[coordinates]
x = 0.0
y = 0.0
phi = 0.4
[quasi_velocities]
v = 1.0
u = 0.0
omega = 2.0
[kinematics]
x = "cos(phi)*v - sin(phi)*u"
y = "sin(phi)*v + cos(phi)*u"
phi = "omega"
[constraints]
slip = "u"
[lagrangian]
kinetic = "(v^2 + (u + 0.3*omega)^2 + 0.5*omega^2)/2"
[simulation]
t_end = 3.0
samples = 4
"#;

/// A spherical pendulum in Cartesian coordinates.
const SPHERE: &str = r#"
[model]
name = "Spherical pendulum"
[parameters]
m = 1.0
g = 9.8
l = 1.0
[coordinates]
x = 0.6
y = 0.0
z = "-0.8*l"
[quasi_velocities]
"y'" = 1.0
[constraints]
length = "x^2+y^2+z^2-l^2"
[lagrangian]
kinetic = "m*(x'^2 + y'^2 + z'^2)/2"
potential = "m*g*z"
[integrals]
area = "x*y' - y*x'"
[simulation]
t_end = 2.0
samples = 5
"#;

fn pc(model: &str, arguments: &[&str]) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_pc"))
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("pc starts");
    child.stdin.take().expect("a pipe").write_all(model.as_bytes()).expect("pc reads");
    child.wait_with_output().expect("pc ends")
}

fn stderr(output: &Output) -> String {
    let text = String::from_utf8(output.stderr.clone()).expect("UTF-8");
    assert!(!text.contains("panicked"), "{text}");
    text
}

#[track_caller]
fn stdout(output: &Output) -> String {
    assert_eq!(output.status.code(), Some(0), "{}", stderr(output));
    String::from_utf8(output.stdout.clone()).expect("UTF-8")
}

/// The header and the rows of a table.
fn table(text: &str) -> (Vec<String>, Vec<Vec<f64>>) {
    let mut lines = text.lines();
    let header = lines.next().expect("a header").split(',').map(str::to_owned).collect();
    let row = |line: &str| line.split(',').map(|cell| cell.parse().expect("a number")).collect();
    (header, lines.map(row).collect())
}

#[track_caller]
fn run(model: &str, arguments: &[&str]) -> (Vec<String>, Vec<Vec<f64>>) {
    table(&stdout(&pc(model, &[&["run", "-"], arguments].concat())))
}

fn json_of(model: &str, arguments: &[&str]) -> Value {
    serde_json::from_str(&stdout(&pc(model, arguments))).expect("JSON")
}

/// The columns of one table that the other has too, side by side; errors of two integrations with the usual
/// tolerance 10⁻⁹ differ by some hundred of it after some seconds.
#[track_caller]
fn agree(one: &(Vec<String>, Vec<Vec<f64>>), other: &(Vec<String>, Vec<Vec<f64>>), tolerance: f64) {
    assert_eq!(one.1.len(), other.1.len());
    for (i, name) in one.0.iter().enumerate() {
        let Some(j) = other.0.iter().position(|known| known == name) else { continue };
        for (a, b) in one.1.iter().zip(&other.1) {
            assert!(
                (a[i] - b[j]).abs() <= tolerance * (1.0 + a[i].abs()),
                "{name} at {}: {} {}",
                a[0],
                a[i],
                b[j]
            );
        }
    }
}

#[test]
fn all_declared_quasi_velocities_are_columns() {
    let slip = run(SLIP, &[]);
    assert_eq!(slip.0, ["t", "x", "y", "phi", "v", "u", "omega", "energy"]);
    assert!(slip.1.iter().all(|row| row[5] == 0.0), "u stays zero");
    let sleigh = run(SLEIGH, &[]);
    assert_eq!(sleigh.0, ["t", "x", "y", "phi", "v", "omega", "energy"]);
    agree(&sleigh, &slip, 1e-7);
    let sphere = run(SPHERE, &[]);
    assert_eq!(sphere.0, ["t", "x", "y", "z", "x'", "y'", "z'", "area", "energy"]);
    for row in &sphere.1 {
        assert!((row[1].hypot(row[2]).hypot(row[3]) - 1.0).abs() < 1e-14, "projected to rounding");
        assert!((row[1] * row[4] + row[2] * row[5] + row[3] * row[6]).abs() < 1e-14);
    }
}

/// In momenta of the velocities left free the others are columns all the same.
#[test]
fn the_canonical_form_has_the_same_columns() {
    for model in [SLEIGH, SLIP, SPHERE] {
        let (usual, canonical) = (run(model, &[]), run(model, &["--form", "canonical"]));
        assert_eq!(usual.0, canonical.0);
        agree(&usual, &canonical, 1e-6);
    }
    // All momenta are components of the state, so that nothing is chosen and the constraints are kept.
    let text = stderr(&pc(SPHERE, &["run", "-", "--form", "canonical"]));
    assert!(!text.contains("note:"), "{text}");
    assert!(text.contains("\n  held     length  to "), "{text}");
}

/// On a belt that moves, ẏ = V + x, the energy of all velocities grows by the work of the belt; it is the same column
/// whatever is integrated, ½ (1 + (V + x)²) with x = t.
#[test]
fn the_energy_is_that_of_all_velocities_in_every_form() {
    let belt = "[coordinates]\nx = 0.0\ny = 0.0\n[quasi_velocities]\n\"x'\" = 1.0\n\"y'\" = 2.0\n[constraints]\n\
                belt = \"y' - 2 - x\"\n[lagrangian]\nkinetic = \"(x'^2 + y'^2)/2\"\n[simulation]\nt_end = 1.0\nsamples = 3\n";
    for form in ["poincare", "canonical"] {
        let (names, rows) = run(belt, &["--form", form]);
        assert_eq!(names, ["t", "x", "y", "x'", "y'", "energy"]);
        for row in rows {
            let expected = (1.0 + (2.0 + row[0]).powi(2)) / 2.0;
            assert!((row[5] - expected).abs() < 1e-8, "{form}: {row:?}"); // the tolerance of the run is 1e-9
        }
    }
    let derived = stdout(&pc(SLEIGH, &["derive", "-", "--form", "canonical"]));
    assert!(derived.contains("none within the frame, which is not closed"), "{derived}");
}

/// λ = v ω (m − m² a²/(m a² + J)) of the blade along the motion.
#[test]
fn reactions_are_columns_where_this_is_asked_for() {
    let (names, rows) = run(SLEIGH, &["--outputs", "reactions"]);
    assert_eq!(names, ["t", "x", "y", "phi", "v", "omega", "energy", "λ_blade"]);
    let share = 1.0 - 0.09 / (0.09 + 0.5);
    for row in rows {
        assert!((row[7] - row[4] * row[5] * share).abs() < 1e-14, "{row:?}");
    }
}

#[test]
fn a_start_is_moved_where_this_is_asked_for() {
    let off = SPHERE.replace("x = 0.6", "x = 0.7");
    let refused = pc(&off, &["run", "-"]);
    assert_eq!(refused.status.code(), Some(4));
    assert_eq!(
        stderr(&refused),
        "pc: <stdin>:15:11: [constraints] length: the start is off the constraint `length`: it is 0.13, not 0\n    \
         length = \"x^2+y^2+z^2-l^2\"\n              ^^^^^^^^^^^^^^^\n  \
         help: give a start that satisfies it, or have it moved there by --project-start\n"
    );
    assert!(refused.stdout.is_empty());
    let (_, rows) = run(&off, &["--project-start"]);
    // The nearest point of the sphere.
    let r = 0.7f64.hypot(0.8);
    assert!((rows[0][1] - 0.7 / r).abs() < 1e-15 && (rows[0][3] + 0.8 / r).abs() < 1e-15, "{:?}", rows[0]);
    for command in ["check", "derive"] {
        assert_eq!(pc(&off, &[command, "-"]).status.code(), Some(4));
        assert_eq!(pc(&off, &[command, "-", "--project-start"]).status.code(), Some(0));
    }
    // Parameters move constraint and start together where the text says so.
    assert_eq!(pc(SPHERE, &["check", "-", "--set", "l=2"]).status.code(), Some(4), "x is a number");
    let together = SPHERE.replace("x = 0.6", "x = \"0.6*l\"");
    assert_eq!(pc(&together, &["check", "-", "--set", "l=2"]).status.code(), Some(0));
}

/// The edge of the cusp y² = x³ at the origin: no motion goes on from there.
#[test]
fn a_singular_place_on_the_way_ends_the_run() {
    let cusp = "[coordinates]\nx = 1.0\ny = 1.0\n[quasi_velocities]\n\"x'\" = -2.0\n\"y'\" = -3.0\n[constraints]\n\
                edge = \"y^2 - x^3\"\n[lagrangian]\nkinetic = \"(x'^2 + y'^2)/2\"\n[simulation]\nt_end = 2.0\nsamples = 21\n";
    let output = pc(cusp, &["run", "-"]);
    let text = stderr(&output);
    assert_eq!(output.status.code(), Some(5), "{text}");
    // The length of y² = x³ from (1, 1) to the edge is (13√13 − 8)/27, the speed is √13.
    let arrival = (13.0 * 13f64.sqrt() - 8.0) / 27.0 / 13f64.sqrt();
    let said = text.split("the integration failed at t = ").nth(1).and_then(|rest| rest.split(',').next());
    let t: f64 = said.expect("a time").parse().expect("a number");
    // Near the edge x ~ (t_1 − t)^1, y ~ x^(3/2): a step of the square root of the tolerance is lost there.
    assert!((t - arrival).abs() < 1e-4, "{t} {arrival}");
    assert!(text.contains("`edge`"), "the constraint is named: {text}");
    let (_, rows) = table(&String::from_utf8(output.stdout).expect("UTF-8"));
    let times: Vec<f64> = rows.iter().map(|row| row[0]).collect();
    assert_eq!(times, [0.0, 0.1, 0.2, 0.3], "what was reached is kept");
}

#[test]
fn what_was_dropped_is_said() {
    let twice = SPHERE.replace("length =", "speed = \"x*x' + y*y' + z*z'\"\nnothing = \"0\"\nlength =");
    let note = "note: the constraint nothing says nothing; it is dropped\n\
                note: the constraint speed follows from length; it is dropped\n";
    for arguments in [["derive", "-", "--form", "poincare"], ["derive", "-", "--form", "canonical"]] {
        assert_eq!(stderr(&pc(&twice, &arguments)), note);
    }
    let text = stderr(&pc(&twice, &["run", "-"]));
    assert!(
        text.contains("\n  dropped  nothing says nothing\n           speed follows from length\n"),
        "{text}"
    );
    let check = stdout(&pc(&twice, &["check", "-"]));
    let lines = "constraints        length: holonomic\n                     nothing: says nothing; dropped\n                     \
                 speed: follows from length; dropped\n";
    assert!(check.contains(lines), "{check}");
    let report = json_of(&twice, &["check", "-", "--format", "json"]);
    let dropped = json!([
        { "name": "nothing", "follows_from": [] },
        { "name": "speed", "follows_from": ["length"] },
    ]);
    assert_eq!(report["dropped_constraints"], dropped);
    let directory = tempfile::tempdir().expect("a directory");
    let output = pc(&twice, &["emit", "-", "--lang", "c", "-o", directory.path().to_str().expect("UTF-8")]);
    assert!(stderr(&output).starts_with(note), "{}", stderr(&output));
    assert_eq!(run(&twice, &[]), run(SPHERE, &[]), "the motion is the same");
}

#[test]
fn a_check_says_what_constraints_do() {
    let report = json_of(SPHERE, &["check", "-", "--format", "json"]);
    assert_eq!(report["constraints"], json!([{ "name": "length", "kind": "holonomic", "residual": 0.0 }]));
    // 0.6² + 0.8² in numbers.
    assert!(report["start_residual"].as_f64().expect("a number") < 2e-16, "{report}");
    let report = json_of(SLEIGH, &["check", "-", "--format", "json"]);
    let blade = &report["constraints"][0];
    assert_eq!((&blade["name"], &blade["kind"]), (&json!("blade"), &json!("nonholonomic")));
    // [v, ω] = −blade
    assert_eq!(blade["residual"], 1.0);
    assert_eq!(report["start_residual"], 0.0);
    let text = stdout(&pc(SLEIGH, &["check", "-"]));
    assert!(text.contains("  constraints        blade: nonholonomic, by 1 in a bracket\n"), "{text}");
    assert!(text.contains("  mass matrix        symmetric, rank 2 of 2\n"), "{text}");
}

/// Each form of each model: text that names the constraint, LaTeX that does, and JSON that has it.
#[test]
fn all_forms_are_printed() {
    let sleigh_line = "Constraints\n  blade: y' cos(phi) - x' sin(phi) = 0   (nonholonomic)\n";
    let sphere_line = "Constraints\n  length: x² - l² + y² + z² = 0   (holonomic)\n";
    for (model, line, latex, expression, expected) in [
        (
            SLEIGH,
            sleigh_line,
            "% Constraints\n\\begin{align*}\n  \\dot{y}",
            "y'*cos(phi) - x'*sin(phi)",
            [
                ("poincare", "  omega' (m a² + J) = -m a v omega\n"),
                ("lagrange", "  m x'' - m a phi'' sin(phi) = m a phi'² cos(phi) - λ_blade sin(phi)\n"),
                ("voronets", "  phi'' (m a² + J) = -m a x' phi'/cos(phi)\n"),
                ("canonical", "  p_v'     = m a p_omega²/(m a² + J)²\n"),
            ],
        ),
        (
            SPHERE,
            sphere_line,
            "% Constraints\n\\begin{align*}\n  x^{2}",
            "x^2 - l^2 + y^2 + z^2",
            [
                ("poincare", "  z' = -(x x' + y y')/z\n"),
                ("lagrange", "  m z'' = 2 z λ_length - m g\n"),
                ("voronets", "  z' = -(x x' + y y')/z\n"),
                ("canonical", "  p_x = m x (x x' + y y')/z² + m x'\n"),
            ],
        ),
    ] {
        for (form, equation) in expected {
            let choice: &[&str] = if model == SPHERE { &["--independent", "x',y'"] } else { &[] };
            let text = stdout(&pc(model, &[&["derive", "-", "--form", form], choice].concat()));
            assert!(text.contains(line) && text.contains(equation), "{form}: {text}");
            let page = stdout(&pc(model, &["derive", "-", "--form", form, "--format", "latex"]));
            assert!(page.contains(latex), "{form}: {page}");
            let object = json_of(model, &["derive", "-", "--form", form, "--format", "json"]);
            assert_eq!(object["constraints"][0]["expression"], expression, "{form}");
        }
    }
    let reactions = json_of(SLEIGH, &["derive", "-", "--format", "json"])["reactions"].clone();
    let expected = json!({ "λ_blade": "m*a*omega' + m*v*omega" });
    assert_eq!(reactions, expected);
}

/// Emitted C, compiled and run on its own: where a quasi-velocity vanishes, and in chosen velocities.
#[test]
fn emitted_source_has_the_same_motion() {
    let directory = tempfile::tempdir().expect("a directory");
    let path = |name: &str| directory.path().join(name).to_str().expect("UTF-8").to_owned();
    for (name, text, state) in [("slip", SLIP, 5), ("sphere", SPHERE, 5)] {
        std::fs::write(path(&format!("{name}.toml")), text).expect("written");
        let (file, directory) = (path(&format!("{name}.toml")), path(""));
        // Shorter equations are those of y' and z', which the motion leads to where they are singular.
        let choice: &[&str] = if name == "sphere" { &["--independent", "x',y'"] } else { &[] };
        let output = pc("", &[&["emit", &file, "--lang", "c", "-o", &directory], choice].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let header = std::fs::read_to_string(path(&format!("{name}.h"))).expect("a header");
        let remark =
            " *\n * The equations are in x', y'; z' follows from the constraints.\n * These are the ones";
        assert_eq!(header.contains(remark), name == "sphere", "{header}");
        assert_eq!(stderr(&output).contains("note: The equations are in x', y'; z' "), name == "sphere");
        let (source, program) = (path(&format!("{name}.c")), path(name));
        let main = format!("-D{}_MAIN", name.to_uppercase());
        let compiled =
            Command::new("cc").args(["-std=c99", "-O1", &main, &source, "-o", &program, "-lm"]).status();
        assert!(compiled.expect("a C compiler").success());
        let printed = Command::new(&program).output().expect("it runs");
        let printed = String::from_utf8(printed.stdout).expect("UTF-8");
        let words = |line: &str| -> Vec<f64> {
            line.split([' ', ',', '\t']).filter_map(|word| word.parse().ok()).collect()
        };
        let last = printed.lines().rev().map(words).find(|row| row.len() > state).expect("rows");
        let (columns, rows) = run(text, &[]);
        let kept: Vec<usize> =
            (0..columns.len()).filter(|&i| !["u", "z'", "area"].contains(&columns[i].as_str())).collect();
        let end = rows.last().expect("rows");
        for (found, &i) in last.iter().zip(&kept) {
            // The main of the source has fixed steps of Runge and Kutta, errors of which are below 10⁻⁶.
            assert!((found - end[i]).abs() < 1e-6, "{name} {}: {found} {}\n{printed}", columns[i], end[i]);
        }
    }
}

fn chain(links: usize) -> String {
    let (mut start, mut constraints) = (String::new(), String::new());
    for i in 1..=links {
        start += &format!("x{i} = {}\ny{i} = {}\n", i as f64 * 0.6, i as f64 * -0.8);
        let (x, y) =
            if i == 1 { ("0".into(), "0".into()) } else { (format!("x{}", i - 1), format!("y{}", i - 1)) };
        constraints += &format!("link{i} = \"(x{i} - {x})^2 + (y{i} - {y})^2 - 1\"\n");
    }
    let kinetic: Vec<String> = (1..=links).map(|i| format!("x{i}'^2 + y{i}'^2")).collect();
    let height: Vec<String> = (1..=links).map(|i| format!("y{i}")).collect();
    format!(
        "[coordinates]\n{start}[constraints]\n{constraints}[lagrangian]\nkinetic = \"({})/2\"\npotential = \"9.8*({})\"\n\
         [simulation]\nt_end = 1.0\nsamples = 3\n",
        kinetic.join(" + "),
        height.join(" + ")
    )
}

/// Thirty links in Cartesian coordinates; whatever the time it takes, the links stay long and the energy stays.
#[test]
fn a_long_chain_is_held() {
    let (columns, rows) = run(&chain(30), &[]);
    assert_eq!(columns.len(), 1 + 4 * 30 + 1);
    let energy = |row: &Vec<f64>| *row.last().expect("an energy");
    // −9.8 · 0.8 · Σ i at the start; 10⁻⁹ of the sizes of its parts a step, some hundred steps.
    assert!((energy(&rows[2]) - energy(&rows[0])).abs() < 1e-7 * energy(&rows[0]).abs(), "{rows:?}");
    let end = &rows[2];
    for i in 1..30 {
        let (x, y) = (end[1 + 2 * i] - end[2 * i - 1], end[2 + 2 * i] - end[2 * i]);
        assert!((x.hypot(y) - 1.0).abs() < 1e-13, "link {i}: rounding of coordinates up to 30");
    }
    assert_eq!(pc(&chain(30), &["derive", "-", "--form", "lagrange"]).status.code(), Some(0));
    assert_eq!(pc(&chain(10), &["check", "-"]).status.code(), Some(0));
}

/// A bead on a circle with L = −√(1 − v²) − y: M depends on the velocities, in the equations and in the metric of the
/// projection. By the angle the same is one equation.
#[test]
fn a_fast_bead_moves_as_by_its_angle() {
    let cartesian = "[coordinates]\nx = 0.6\ny = -0.8\n[quasi_velocities]\n\"x'\" = 0.64\n\"y'\" = 0.48\n[constraints]\n\
                     circle = \"x^2 + y^2 - 1\"\n[lagrangian]\nlagrangian = \"-sqrt(1 - x'^2 - y'^2) - 0.4*y\"\n\
                     [simulation]\nt_end = 5.0\nsamples = 6\n";
    let by_angle = "[coordinates]\nq = \"atan2(-0.8, 0.6)\"\n[quasi_velocities]\n\"q'\" = 0.8\n[lagrangian]\n\
                    lagrangian = \"-sqrt(1 - q'^2) - 0.4*sin(q)\"\n[outputs]\nx = \"cos(q)\"\ny = \"sin(q)\"\n\
                    [simulation]\nt_end = 5.0\nsamples = 6\n";
    let exact = ["--rtol", "1e-12", "--atol", "1e-14"];
    // Some hundred steps of 10⁻¹² each, and what a pendulum makes of them.
    agree(&run(cartesian, &exact), &run(by_angle, &exact), 1e-9);
}

/// A stiff damped spring at a pendulum bound by its length: BDF goes with the Jacobian as with difference quotients.
#[test]
fn the_jacobian_of_held_motions_serves_bdf() {
    use pc_mech::{CompileOptions, Graph};
    use pc_model::{ConstraintFormulation, Document, Model, Source};
    use pc_solve::{Method, Options, solve};
    let text = "[coordinates]\nx = 0.6\ny = -0.8\nu = 0.7\n[quasi_velocities]\n\"u'\" = 0.0\n[constraints]\n\
                length = \"x^2 + y^2 - 1\"\n[lagrangian]\nkinetic = \"(x'^2 + y'^2 + u'^2)/2\"\n\
                potential = \"9.8*y + 1e6*(u - x)^2/2\"\ndissipation = \"1e4*(u' - x')^2/2\"\n";
    let model = Model::new(Document::parse(Source::new("m.toml", text)).expect("a model"));
    let graph = Graph::new();
    let assembly = model.assemble(&graph).expect("a system");
    let ConstraintFormulation::Multipliers(held) = assembly.constraints.formulation() else {
        panic!("held by a multiplier")
    };
    let solved = |jacobian: bool| {
        let options = CompileOptions::default().jacobian(jacobian);
        let mut motion = held.multipliers.compile_for(options).expect("a motion");
        let options = Options::new(Method::Bdf).relative_tolerance(1e-7).absolute_tolerance(1e-10);
        let trajectory = solve(&mut motion, 0.0, &assembly.start, &[1.0, 2.0], &options).expect("it goes on");
        (trajectory.iter().last().expect("a state").1.to_vec(), *trajectory.statistics())
    };
    let (with, without) = (solved(true), solved(false));
    for (a, b) in with.0.iter().zip(&without.0) {
        // The tolerance of a step times the steps of a slow motion.
        assert!((a - b).abs() < 1e-4, "{:?} {:?}", with.0, without.0);
    }
    let [with, without] = [with.1, without.1];
    assert!(with.jacobian_evaluations > 0, "{with:?}");
    // An explicit method would take some 10⁴ steps a second; Newton's method would fail where the Jacobian is wrong.
    assert!(with.steps < 2000 && 2 * with.steps < 3 * without.steps, "{with:?} {without:?}");
    assert!(with.nonlinear_iterations < 2 * with.steps && with.nonlinear_failures < 10, "{with:?}");
}

/// Appell's and Hamel's machine: its forms, and which there are not.
#[test]
fn a_nonlinear_constraint_has_the_forms_with_multipliers() {
    let text = stdout(&pc("", &["derive", "appell-hamel"]));
    let lines = "  m z'' = -m g - 2 k² z' λ_drive\n";
    assert!(
        text.contains("drive: x'² - k² z'² + y'² = 0   (nonholonomic, not affine in the velocities)\n"),
        "{text}"
    );
    assert!(text.contains(lines) && text.contains("\nReactions\n  λ_drive = "), "{text}");
    let text = stdout(&pc("", &["derive", "appell-hamel", "--form", "lagrange"]));
    assert!(text.contains(lines), "{text}");
    let refused = pc("", &["derive", "appell-hamel", "--form", "voronets"]);
    assert_eq!(refused.status.code(), Some(4));
    assert_eq!(
        stderr(&refused),
        "pc: appell-hamel.toml:29:19: [constraints] drive.expr: Voronets' equations need constraints that are affine in \
         the velocities; `drive` is not\n    drive = { expr = \"x'^2 + y'^2 - k^2*z'^2\", kind = \"nonlinear\" }\n\
         \u{20}                     ^^^^^^^^^^^^^^^^^^^^^^\n  \
         help: take a form with multipliers: poincare, lagrange, or canonical\n"
    );
    let report = json_of("", &["check", "appell-hamel", "--format", "json"]);
    let kind =
        json!([{ "name": "drive", "kind": "nonholonomic, not affine in the velocities", "residual": null }]);
    assert_eq!(report["constraints"], kind);
    let check = stdout(&pc("", &["check", "appell-hamel"]));
    assert!(check.contains("energy     conserved (proved)\n"), "{check}");
    assert!(
        check.contains("steady motion      not looked for: a constraint is not affine in the velocities\n"),
        "{check}"
    );

    let run = |arguments: &[&str]| table(&stdout(&pc("", &[&["run", "appell-hamel"], arguments].concat())));
    let (names, rows) = run(&["--outputs", "reactions"]);
    assert_eq!(names, ["t", "x", "y", "z", "x'", "y'", "z'", "direction", "energy", "λ_drive"]);
    // λ = −½ m k² g ż/(k² ż² + k⁴ ż²) = −½ m g/((1 + k²) ż)
    assert!(rows.iter().all(|row| (row[9] + 0.5 * 10.0 / 1.5625 / row[6]).abs() < 1e-8), "{rows:?}");
    agree(&run(&["--form", "canonical"]), &(names, rows), 1e-7);
    let text = stderr(&pc("", &["run", "appell-hamel", "--form", "canonical"]));
    assert!(text.contains("\n  held     drive  to ") && !text.contains("note:"), "{text}");
    let note = "note: The equations are in all velocities, with the reactions put in; drive is an integral of them,\n      \
                and nothing takes errors of the integration back to the constraints.\n";
    let directory = tempfile::tempdir().expect("a directory");
    let output =
        pc("", &["emit", "appell-hamel", "--lang", "c", "-o", directory.path().to_str().expect("UTF-8")]);
    assert!(stderr(&output).starts_with(note), "{}", stderr(&output));
}

/// Outputs that contain reactions, also forces on bodies: of constraints on positions, of a rolling disk held by multipliers, and of
/// quasi-velocities that vanish.
const WITH_REACTIONS: [(&str, &str); 3] = [
    (
        "pendulum",
        "[coordinates]\nx = 0.6\nz = -0.8\n[quasi_velocities]\n\"x'\" = 0.4\n\"z'\" = 0.3\n[bodies.bob]\nmass = 2\n\
         position = [\"x\", 0, \"z\"]\nforce = [0, 0, -19.6]\n[constraints]\nlength = \"x^2 + z^2 - 1\"\n[outputs]\n\
         pull = \"λ_length^2 + x\"\nside = \"F_length_bob_x\"\n[simulation]\nt_end = 1.0\nsamples = 5\n",
    ),
    (
        "skate",
        "[coordinates]\nx = 0.1\ny = 0.2\nphi = 0.3\n[quasi_velocities]\n\"x'\" = \"cos(0.3)\"\n\"y'\" = \"sin(0.3)\"\n\
         \"phi'\" = 0.7\n[constraints]\nblade = \"sin(phi)*x' - cos(phi)*y'\"\n[lagrangian]\n\
         kinetic = \"(x'^2 + y'^2 + phi'^2/2)/2\"\npotential = \"x/3\"\n[outputs]\nside = \"λ_blade*phi\"\n[simulation]\n\
         t_end = 1.0\nsamples = 5\n",
    ),
    (
        "slip",
        "[coordinates]\nx = 0.0\ny = 0.0\nphi = 0.4\n[quasi_velocities]\nv = 1.0\nu = 0.0\nomega = 2.0\n[kinematics]\n\
         x = \"cos(phi)*v - sin(phi)*u\"\ny = \"sin(phi)*v + cos(phi)*u\"\nphi = \"omega\"\n[constraints]\nblade = \"u\"\n\
         [lagrangian]\nkinetic = \"(v^2 + (u + 0.3*omega)^2 + 0.5*omega^2)/2\"\n[outputs]\nside = \"2*λ_blade\"\n\
         [simulation]\nt_end = 1.0\nsamples = 5\n",
    ),
];

/// Emitted source has the reactions put in as functions of the state: at the states of a run it gives the numbers of the run.
#[test]
fn emitted_outputs_have_the_reactions_put_in() {
    let directory = tempfile::tempdir().expect("a directory");
    let path = |name: &str| directory.path().join(name).to_str().expect("UTF-8").to_owned();
    for (name, text) in WITH_REACTIONS {
        std::fs::write(path(&format!("{name}.toml")), text).expect("written");
        for lang in ["c", "rust"] {
            let emitted = pc("", &["emit", &path(&format!("{name}.toml")), "--lang", lang, "-o", &path("")]);
            assert_eq!(emitted.status.code(), Some(0), "{}", stderr(&emitted));
        }
        let (columns, rows) = run(text, &[]);
        let source = std::fs::read_to_string(path(&format!("{name}.h"))).expect("a header");
        let state: Vec<&str> =
            source.lines().filter_map(|line| line.strip_prefix(" *     y[")?.split("  ").nth(1)).collect();
        let place = |name: &str| columns.iter().position(|known| known == name).expect("a column");
        let outputs: Vec<usize> = (place("energy") + 1..columns.len()).collect();
        let literal = |row: &Vec<f64>| {
            let values: Vec<String> = state.iter().map(|x| format!("{:?}", row[place(x)])).collect();
            values.join(", ")
        };
        let (mut c, mut rust) = (String::new(), String::new());
        for row in &rows {
            let (y, t, m) = (literal(row), row[0], outputs.len());
            c += &format!(
                "{{ const double y[] = {{{y}}}; double v[{m}]; {name}_outputs({t:?}, y, 0, v); \
                 for (int i = 0; i < {m}; i++) printf(\"%.17g\\n\", v[i]); }}\n"
            );
            rust += &format!(
                "{{ let mut v = [0.0; {m}]; {name}::outputs({t:?}, &[{y}], &[], &mut v); \
                 for v in v {{ println!(\"{{v:e}}\"); }} }}\n"
            );
        }
        let c = format!("#include <stdio.h>\n#include \"{name}.h\"\nint main(void) {{\n{c}return 0; }}\n");
        std::fs::write(path("main.c"), c).expect("written");
        std::fs::write(path("main.rs"), format!("#[allow(dead_code)] mod {name};\nfn main() {{\n{rust}}}\n"))
            .expect("written");
        let mut cc = Command::new("cc");
        cc.args([
            "-std=c99",
            "-O1",
            &path("main.c"),
            &path(&format!("{name}.c")),
            "-o",
            &path("by_c"),
            "-lm",
        ]);
        let mut rustc = Command::new("rustc");
        rustc.args(["--edition", "2021", &path("main.rs"), "-o", &path("by_rust")]);
        for (compiler, program) in [(&mut cc, "by_c"), (&mut rustc, "by_rust")] {
            assert!(compiler.status().expect("a compiler").success());
            let printed = Command::new(path(program)).output().expect("it runs");
            let printed = String::from_utf8(printed.stdout).expect("UTF-8");
            let found: Vec<f64> = printed.lines().map(|line| line.parse().expect("a number")).collect();
            let expected: Vec<f64> = rows.iter().flat_map(|row| outputs.iter().map(|&j| row[j])).collect();
            assert_eq!(found.len(), expected.len());
            for (found, expected) in found.iter().zip(&expected) {
                // The same function by other operations, at states that satisfy the constraints to rounding.
                assert!(
                    (found - expected).abs() < 1e-12 * (1.0 + expected.abs()),
                    "{name}: {found} {expected}"
                );
            }
        }
    }
}

#[test]
fn forces_on_bodies_are_columns_beside_the_reactions() {
    let pendulum = "[coordinates]\nx = 0.6\nz = -0.8\n[bodies.bob]\nmass = 2\nposition = [\"x\", 0, \"z\"]\n\
                    force = [0, 0, -19.6]\n[constraints]\nlength = \"x^2 + z^2 - 1\"\n[simulation]\nt_end = 1.0\nsamples = 5\n";
    let (names, rows) = run(pendulum, &["--outputs", "reactions"]);
    let columns = ["λ_length", "F_length_bob_x", "F_length_bob_y", "F_length_bob_z"];
    assert_eq!(names[names.len() - 4..], columns);
    for row in &rows {
        // The rod pulls along itself with m g cos θ + m l θ̇².
        let tension = -19.6 * row[2] + 2.0 * (row[3].powi(2) + row[4].powi(2));
        assert!(
            (row[7] + tension * row[1]).abs() < 1e-12 && (row[9] + tension * row[2]).abs() < 1e-12,
            "{row:?}"
        );
    }
    agree(&run(pendulum, &["--outputs", "reactions", "--form", "canonical"]), &(names, rows), 1e-6);
    let tied = pendulum
        .replace("[constraints]", "[bodies.end]\nmass = 1\nposition = [\"2*x\", 0, 0]\n[constraints]");
    let text = stderr(&pc(&tied, &["run", "-", "--outputs", "reactions"]));
    let note = "note: the force on `bob`, the force on `end` of the reactions are left out: the choice of coordinates ties \
                velocities of bodies together, and virtual work does not tell forces between them\n";
    assert!(text.starts_with(note), "{text}");
}

/// On a belt Jacobi's integral is not the energy of the run, and each is called by its name.
#[test]
fn energies_are_told_apart() {
    let belt = "[coordinates]\nx = 0.0\ny = 0.0\n[quasi_velocities]\n\"x'\" = 1.0\n\"y'\" = 2.0\n[constraints]\n\
                belt = \"y' - 2 - x\"\n[lagrangian]\nkinetic = \"(x'^2 + y'^2)/2\"\n[simulation]\nt_end = 1.0\n";
    let remark = "(This energy is y·η − L of the independent velocities (Jacobi's integral). The energy of a run is that of \
                  all velocities.)\n";
    for (form, expected) in [("poincare", true), ("canonical", true), ("voronets", true), ("lagrange", false)]
    {
        let text = stdout(&pc(belt, &["derive", "-", "--form", form]));
        assert_eq!(text.contains(remark), expected, "{form}: {text}");
        let page = stdout(&pc(belt, &["derive", "-", "--form", form, "--format", "latex"]));
        assert_eq!(page.contains("Jacobi's integral"), expected, "{form}: {page}");
    }
    assert!(!stdout(&pc(SPHERE, &["derive", "-"])).contains("Jacobi"));
    let report = json_of(belt, &["check", "-", "--format", "json"]);
    let named = |name: &str| {
        report["integrals"].as_array().expect("a list").iter().find(|i| i["name"] == name).cloned()
    };
    // ½ (1 + (2 + x)²) grows at the rate (2 + x) ẋ = 2.
    assert_eq!(named("energy").expect("listed")["rate_at_start"], 2.0);
    assert!(named("Jacobi's").is_some(), "{report}");
    let directory = tempfile::tempdir().expect("a directory");
    std::fs::write(directory.path().join("belt.toml"), belt).expect("written");
    let path = |name: &str| directory.path().join(name).to_str().expect("UTF-8").to_owned();
    pc("", &["emit", &path("belt.toml"), "--lang", "c", "-o", &path("")]);
    let header = std::fs::read_to_string(path("belt.h")).expect("a header");
    assert!(header.contains("This energy is y·η − L of the independent velocities"), "{header}");
}

#[test]
fn a_mass_of_the_wrong_sign_is_remarked() {
    let words = "the kinetic energy is negative for some velocities at the start: a mass or a moment of inertia has the \
                 wrong sign";
    let negative = ["--set", "m=-1"];
    let text = stdout(&pc(SPHERE, &[&["check", "-"], &negative[..]].concat()));
    assert!(text.contains(words), "{text}");
    let output = pc(SPHERE, &[&["run", "-"], &negative[..]].concat());
    assert_eq!(output.status.code(), Some(0), "a note is no error");
    assert!(stderr(&output).starts_with(&format!("note: {words}\n")), "{}", stderr(&output));
    assert!(!stdout(&pc(SPHERE, &["check", "-"])).contains("wrong sign"));
    // What the constraint forbids does not count.
    let forbidden = "[coordinates]\nx = 0.0\ny = 0.0\n[constraints]\nwall = \"y\"\n[lagrangian]\n\
                     kinetic = \"(x'^2 - y'^2)/2\"\n[simulation]\nt_end = 1.0\n";
    assert!(!stderr(&pc(forbidden, &["run", "-"])).contains("wrong sign"));
}

#[test]
fn what_was_moved_is_said() {
    let off = SPHERE.replace("x = 0.6", "x = 0.7");
    let text = stderr(&pc(&off, &["run", "-", "--project-start"]));
    let note = "note: the start was moved to the constraints:\n      x = 0.7 → 0.6585046079, z = -0.8 → -0.7525766947\n";
    assert!(text.starts_with(note), "{text}");
    let text = stderr(&pc(SLEIGH, &["run", "-", "--project-start"]));
    assert!(text.starts_with("note: the start satisfies the constraints; it was not moved\n"), "{text}");
}

#[test]
fn an_unknown_parameter_is_said_once() {
    let text = stderr(&pc("", &["run", "euler-top", "--set", "I4=1"]));
    assert_eq!(text, "pc: --set: `I4` is not a parameter of this model; its parameters are I1, I2, I3\n");
}

/// Lagrange's equations need as many velocities as coordinates.
#[test]
fn a_form_that_is_not_there_says_which_are() {
    let output = pc("", &["derive", "spherical-pendulum-cartesian", "--form", "lagrange"]);
    assert_eq!(output.status.code(), Some(4));
    let text = stderr(&output);
    let help = "\n  help: its forms are poincare and canonical, in the quasi-velocities of the model\n";
    assert!(text.ends_with(help), "{text}");
}

#[test]
fn names_are_set_alike() {
    let names = "[coordinates]\nth = 0.1\nphi = 0.2\nheight = 0.3\n[lagrangian]\n\
                 kinetic = \"(th'^2 + phi'^2 + height'^2)/2\"\npotential = \"cos(th)*cos(phi)*cos(height)\"\n";
    let page = stdout(&pc(names, &["derive", "-", "--format", "latex"]));
    for word in [
        "\\cos \\theta",
        "\\cos \\varphi",
        "\\cos \\mathrm{height}",
        "\\ddot{\\theta}",
        "\\ddot{\\mathrm{height}}",
    ] {
        assert!(page.contains(word), "{word}: {page}");
    }
    assert!(!page.contains("\\text"), "{page}");
}
