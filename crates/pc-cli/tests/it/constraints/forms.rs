//! Equations and source under constraints, in each form.

use std::process::Command;

use serde_json::json;

use super::{SLEIGH, SLIP, SPHERE, agree, json_of, pc, run, stderr, stdout, table};

/// For each form of each model, text, LaTeX and JSON contain the constraint.
#[test]
fn all_forms_are_printed() {
    let sleigh_line = "Constraints\n  blade: y' cos(phi) - x' sin(phi) = 0   (nonholonomic)\n";
    let sphere_line = "Constraints\n  length: x² - l² + y² + z² = 0   (holonomic)\n";
    for (model, line, latex, expression, expected) in [
        (
            SLEIGH,
            sleigh_line,
            "\\paragraph{Constraints.}\n\\begin{align*}\n  \\dot{y}",
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
            "\\paragraph{Constraints.}\n\\begin{align*}\n  x^{2}",
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

/// Emitted C is compiled and run: where a quasi-velocity vanishes, and in chosen velocities.
#[test]
fn emitted_source_has_the_same_motion() {
    let directory = tempfile::tempdir().expect("a directory");
    let path = |name: &str| directory.path().join(name).to_str().expect("UTF-8").to_owned();
    for (name, text, state) in [("slip", SLIP, 5), ("sphere", SPHERE, 5)] {
        std::fs::write(path(&format!("{name}.toml")), text).expect("written");
        let (file, directory) = (path(&format!("{name}.toml")), path(""));
        // The equations of y' and z' are shorter, but become singular along the motion.
        let choice: &[&str] = if name == "sphere" { &["--independent", "x',y'"] } else { &[] };
        let output = pc("", &[&["emit", &file, "--lang", "c", "-o", &directory], choice].concat());
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let header = std::fs::read_to_string(path(&format!("{name}.h"))).expect("a header");
        let remark = " *\n * The equations are in x', y'; z' follows from the constraints.\n * These are the";
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
            // The main of the source uses Runge–Kutta steps of fixed length, with errors below
            // 10⁻⁶.
            assert!((found - end[i]).abs() < 1e-6, "{name} {}: {found} {}\n{printed}", columns[i], end[i]);
        }
    }
}

/// Appell's and Hamel's machine: its forms, and those that it lacks.
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
         help: use a form with multipliers: poincare, lagrange, or canonical\n"
    );
    let report = json_of("", &["check", "appell-hamel", "--format", "json"]);
    let kind =
        json!([{ "name": "drive", "kind": "nonholonomic, not affine in the velocities", "residual": null }]);
    assert_eq!(report["constraints"], kind);
    let check = stdout(&pc("", &["check", "appell-hamel"]));
    assert!(check.contains("energy     conserved (proved)\n"), "{check}");
    assert!(check.contains("steady motion      none found near the start\n"), "{check}");

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

/// Outputs that contain reactions, also as forces on bodies: of constraints on positions, of a
/// skate held by multipliers, and of quasi-velocities that vanish.
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

/// In emitted source, reactions are functions of the state: at the states of a run it gives the
/// numbers of the run.
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
