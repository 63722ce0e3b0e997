//! The program in use: exit codes, output streams, and files.

use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use crate::each_model::{answer, each};
use pc_model::Builtin;

use crate::piped;

const HEADER: &str = "t,γ1,γ2,γ3,ω1,ω2,ω3,area,norm,spin,energy";

/// A mass that falls into a centre of attraction, where its speed becomes infinite.
const CENTRE: &str = r#"
[coordinates]
r = 1.0
[lagrangian]
kinetic = "r'^2/2"
potential = "log(r)"
[simulation]
t_end = 2.0
samples = 21
"#;

/// A mass that falls to where the square root of its height becomes undefined.
const WALL: &str = r#"
[coordinates]
x = 1.0
[lagrangian]
kinetic = "x'^2/2"
potential = "x + sqrt(x)/1000"
[simulation]
t_end = 3.0
samples = 31
"#;

const FREE: &str = "[parameters]\nm = 2.0\nl = 3.0\n[coordinates]\nx = \"2*l\"\n[quasi_velocities]\n\"x'\" = 1.0\n\
                    [lagrangian]\nkinetic = \"m*x'^2/2\"\n[simulation]\nt_end = 1.0\nsamples = 3\n";

fn pc() -> Command {
    Command::new(env!("CARGO_BIN_EXE_pc"))
}

fn run(arguments: &[&str]) -> Output {
    pc().args(arguments).stdin(Stdio::null()).output().expect("pc starts")
}

fn run_on(model: &str, arguments: &[&str]) -> Output {
    piped::pc(model, arguments)
}

fn code(output: &Output) -> i32 {
    output.status.code().expect("an exit code")
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).expect("UTF-8")
}

fn stderr(output: &Output) -> String {
    let text = String::from_utf8(output.stderr.clone()).expect("UTF-8");
    assert!(!text.contains("panicked"), "{text}");
    text
}

#[track_caller]
fn refuses(arguments: &[&str], exit_code: i32, mention: &str) {
    let output = run(arguments);
    let text = stderr(&output);
    assert_eq!(code(&output), exit_code, "{arguments:?}: {text}");
    assert!(text.contains(mention), "{arguments:?} should mention {mention}: {text}");
    assert!(output.stdout.is_empty(), "{arguments:?}");
}

#[test]
fn a_run_is_compared_with_a_second_derivation_at_both_ends() {
    let said = |arguments: &[&str]| {
        let output = run(&[&["run", "chaplygin-sleigh", "--rows", "2"], arguments].concat());
        assert_eq!(code(&output), 0);
        stderr(&output)
    };
    for form in ["poincare", "canonical"] {
        let summary = said(&["--form", form]);
        let line = summary.lines().find(|line| line.contains("verified")).expect("a line");
        assert!(line.starts_with("  verified by a second derivation, which agrees to "), "{line}");
        assert!(line.ends_with(" at the start and at the end"), "{line}");
    }
    assert!(!said(&["--no-verify"]).contains("verified"));
}

#[test]
fn the_table_has_its_header_and_all_digits() {
    let output = run(&["run", "heavy-top-lagrange", "--rows", "5", "--t-end", "2"]);
    assert_eq!(code(&output), 0);
    let text = stdout(&output);
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[0], HEADER);
    assert_eq!(lines.len(), 6);
    let mut times = Vec::new();
    for line in &lines[1..] {
        let cells: Vec<&str> = line.split(',').collect();
        assert_eq!(cells.len(), 11);
        for cell in &cells {
            let (mantissa, _) = cell.split_once('e').expect("an exponent");
            assert_eq!(mantissa.trim_start_matches('-').len(), 18, "17 digits and a point: {cell}");
        }
        times.push(cells[0].parse::<f64>().expect("a number"));
    }
    assert_eq!(times, [0.0, 0.5, 1.0, 1.5, 2.0]);
    let summary = stderr(&output);
    for word in [
        "Heavy top of Lagrange",
        "auto",
        "DOP853: no stiffness was seen",
        "rtol 1e-9",
        "steps",
        "area",
        "energy",
        "ω3 = 3",
    ] {
        assert!(summary.contains(word), "{word} not in {summary}");
    }
}

#[test]
fn the_same_run_gives_the_same_bytes() {
    let directory = tempfile::tempdir().expect("a directory");
    let mut files = Vec::new();
    for extension in ["csv", "json", "npz", "svg", "png", "pdf"] {
        let option = if matches!(extension, "svg" | "png" | "pdf") { "--plot" } else { "-o" };
        let bytes = ["a", "b"].map(|name| {
            let path = directory.path().join(name).with_extension(extension);
            let output =
                run(&["run", "heavy-top-euler", "--t-end", "1", option, path.to_str().expect("UTF-8")]);
            assert_eq!(code(&output), 0, "{}", stderr(&output));
            std::fs::read(path).expect("a file")
        });
        assert!(bytes[0] == bytes[1], "{extension}");
        files.push(bytes[0].clone());
    }
    let text = String::from_utf8(files[3].clone()).expect("UTF-8");
    assert!(text.starts_with("<svg") && text.contains('ψ') && text.contains("Relative drift"));
    assert!(files[4].starts_with(b"\x89PNG") && files[5].starts_with(b"%PDF"));
}

#[test]
fn json_and_npz_hold_the_table_of_the_csv() {
    let directory = tempfile::tempdir().expect("a directory");
    let at = |name: &str| directory.path().join(name).to_str().expect("UTF-8").to_owned();
    for name in ["a.csv", "a.json", "a.npz"] {
        let output = run(&["run", "heavy-top-lagrange", "--rows", "4", "-o", &at(name)]);
        assert!(code(&output) == 0 && output.stdout.is_empty());
    }
    let csv = std::fs::read_to_string(at("a.csv")).expect("a file");
    let rows: Vec<Vec<f64>> = csv
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|cell| cell.parse().expect("a number")).collect())
        .collect();

    let json: serde_json::Value =
        serde_json::from_slice(&std::fs::read(at("a.json")).expect("a file")).expect("JSON");
    assert_eq!(json["model"], "Heavy top of Lagrange");
    assert_eq!(json["parameters"]["I3"], 0.5);
    assert_eq!(json["columns"].as_array().expect("a list").len(), 11);
    let read: Vec<Vec<f64>> = serde_json::from_value(json["rows"].clone()).expect("rows of numbers");
    for (read, row) in read.iter().flatten().zip(rows.iter().flatten()) {
        assert!((read - row).abs() <= 4.0 * f64::EPSILON * row.abs(), "this reader of JSON rounds a little");
    }
    assert_eq!(json["summary"]["ending"], "completed");
    assert!(json["summary"]["drift"]["energy"]["absolute"].as_f64().expect("a number") < 1e-7);

    let archive = std::fs::File::open(at("a.npz")).expect("a file");
    let mut archive = zip::ZipArchive::new(archive).expect("an archive");
    assert_eq!(archive.len(), 11);
    for (j, name) in HEADER.split(',').enumerate() {
        let mut bytes = Vec::new();
        archive.by_name(&format!("{name}.npy")).expect(name).read_to_end(&mut bytes).expect("an array");
        let column: Vec<f64> = npyz::NpyFile::new(&bytes[..]).expect("npy").into_vec().expect("f64");
        assert_eq!(column, rows.iter().map(|row| row[j]).collect::<Vec<_>>());
    }
}

#[test]
fn the_canonical_form_gives_the_same_table() {
    let end = |model: &str, form: &str| {
        let output = run(&["run", model, "--form", form, "--rtol", "1e-12", "--rows", "2"]);
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        let table = stdout(&output);
        let row = table.lines().last().expect("a row").to_owned();
        let numbers: Vec<f64> = row.split(',').map(|text| text.parse().expect("a number")).collect();
        (table.lines().next().expect("a header").to_owned(), numbers)
    };
    for model in ["heavy-top-euler", "relativistic-particle"] {
        let ((header, poincare), (same_header, canonical)) =
            (end(model, "poincare"), end(model, "canonical"));
        assert_eq!(header, same_header);
        for (a, b) in poincare.iter().zip(&canonical) {
            assert!((a - b).abs() <= 1e-8, "{poincare:?}\n{canonical:?}"); // both to 1e-12 a step
        }
    }
    let model = FREE.replace("t_end", "form = \"canonical\"\nt_end");
    assert_eq!(stdout(&run_on(&model, &["run", "-"])), stdout(&run_on(FREE, &["run", "-"])));
}

#[test]
fn a_model_may_come_from_standard_input_and_its_parameters_from_the_command_line() {
    let output = run_on(FREE, &["run", "-", "--set", "l=5", "--set", "m=4"]);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let text = stdout(&output);
    let rows: Vec<Vec<f64>> =
        text.lines().skip(1).map(|l| l.split(',').map(|c| c.parse().expect("a number")).collect()).collect();
    assert_eq!(text.lines().next(), Some("t,x,x',energy"));
    assert_eq!(rows[0], [0.0, 10.0, 1.0, 2.0], "the start follows l, the energy m");
    assert!((rows[2][1] - 11.0).abs() < 1e-9);
}

#[test]
fn a_file_of_the_current_directory_comes_before_a_built_in_model() {
    let directory = tempfile::tempdir().expect("a directory");
    std::fs::write(directory.path().join("euler-top"), FREE).expect("written");
    let header = |command: &mut Command| {
        let output = command.args(["run", "euler-top"]).output().expect("pc starts");
        stdout(&output).lines().next().expect("a header").to_owned()
    };
    assert_eq!(header(pc().current_dir(directory.path())), "t,x,x',energy");
    assert_eq!(header(&mut pc()), "t,ω1,ω2,ω3,momentum,energy");
}

#[test]
fn wrong_usage_is_exit_2_and_suggests_a_correction() {
    refuses(&["run", "heavy-top-lagrang"], 2, "did you mean `heavy-top-lagrange`?");
    refuses(&["run", "no/such/file.toml"], 2, "no file `no/such/file.toml`");
    let tops = "did you mean `heavy-top-lagrange`, `heavy-top-kovalevskaya`, `heavy-top-goryachev-chaplygin`, \
                `heavy-top-euler`, `heavy-top-euler-symmetric` or `heavy-top-quaternion`?";
    refuses(&["check", "heavy-top"], 2, tops);
    refuses(&["check", "kapitsa-pendulum"], 2, "did you mean `kapitza-pendulum`?");
    refuses(&["check", "heavy-top-eulr"], 2, "did you mean `heavy-top-euler`?");
    refuses(&["run", "."], 2, "cannot read .");
    refuses(&["run", "euler-top", "--set", "I4=1"], 2, "its parameters are I1, I2, I3, its start values ω1");
    refuses(&["run", "euler-top", "--set", "I1=one"], 2, "`one` is not a finite number");
    refuses(&["run", "euler-top", "--set", "I1=inf"], 2, "not a finite number");
    refuses(&["run", "euler-top", "--set", "I1"], 2, "NAME=VALUE");
    refuses(
        &["run", "euler-top", "--set", "I1=1", "--set", "I1=1"],
        2,
        "`I1` is given two values; leave one out",
    );
    refuses(&["run", "euler-top", "--rows", "1"], 2, "from 2");
    refuses(&["run", "euler-top", "--rtol", "-1e-9"], 2, "positive");
    refuses(&["run", "euler-top", "--atol", "NaN"], 2, "finite");
    refuses(&["run", "euler-top", "--t-end", "0"], 2, "nothing to integrate");
    refuses(&["run", "euler-top", "--method", "rk4"], 2, "dop853, taylor or auto");
    refuses(&["run", "euler-top", "--form", "maggi"], 2, "not supported yet");
    refuses(&["derive", "euler-top", "--format", "html"], 2, "possible values: text, latex, json");
    refuses(&["sweep", "euler-top"], 2, "sweep");
    refuses(&["run", "euler-top", "-o", "motion.xlsx"], 2, ".csv, .json, .npz or .parquet");
    refuses(&["run", "euler-top", "--plot", "motion.gif"], 2, ".svg, .png or .pdf");
    refuses(&["run", "euler-top", "-o", "no/such/directory/a.csv"], 2, "no directory no/such/directory");
    refuses(&[], 2, "Usage");
    let output = run(&["--help"]);
    assert!(code(&output) == 0 && stdout(&output).contains("Exit codes"));
}

#[test]
fn an_end_time_is_required() {
    let endless = FREE.replace("t_end = 1.0", "");
    let output = run_on(&endless, &["run", "-"]);
    assert_eq!(code(&output), 2);
    assert!(stderr(&output).contains("<stdin>: no end time: give `--t-end T`"));
    assert_eq!(code(&run_on(&endless, &["run", "-", "--t-end", "-1"])), 0, "backwards");
}

#[test]
fn a_wrong_model_is_exit_3_and_an_inconsistent_one_4() {
    let output = run_on(&FREE.replace("m*x'^2/2", "m*x'^2/2 + mass"), &["run", "-"]);
    assert_eq!(code(&output), 3);
    let text = stderr(&output);
    assert!(text.contains("<stdin>:9:") && text.contains("mass"), "{text}");
    let output = run_on(&FREE.replace("m*x'^2/2", "m*x'"), &["check", "-"]);
    assert_eq!(code(&output), 4, "{}", stderr(&output));
    let output = run_on(&FREE.replace("m = 2.0", "m = 0.0"), &["run", "-"]);
    assert_eq!(code(&output), 4, "{}", stderr(&output));
}

/// The frame has rank 2 and determined brackets; the error is in the kinetic energy, and is found
/// before M is inverted.
#[test]
fn a_degenerate_lagrangian_is_refused() {
    let models = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/malformed");
    let expected = "pc: rotated-point.toml:18:1: [lagrangian]: the Lagrangian is degenerate: its Hessian in the \
                    quasi-velocities has rank 2 of 3, so ω3' is not determined\n    [lagrangian]\n    \
                    ^^^^^^^^^^^^\n  help: every quasi-velocity needs kinetic energy of its own\n";
    for command in ["check", "derive", "run"] {
        let output = pc().current_dir(models).args([command, "rotated-point.toml"]).output().expect("pc");
        assert_eq!((code(&output), stderr(&output).as_str()), (4, expected), "{command}");
        assert!(output.stdout.is_empty());
    }
}

#[test]
fn rows_reached_before_a_failure_are_written() {
    for (model, at_least, mention) in [(CENTRE, 10, "r = "), (WALL, 10, "x = ")] {
        let output = run_on(model, &["run", "-"]);
        let text = stderr(&output);
        assert_eq!(code(&output), 5, "{text}");
        let rows = stdout(&output).lines().count() - 1;
        assert!((at_least..21).contains(&rows), "{rows} rows");
        assert!(text.contains("the integration failed at t = "), "{text}");
        assert!(text.contains(mention) && text.contains("because: "), "{text}");
    }
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("a.json");
    let output = run_on(WALL, &["run", "-", "-o", path.to_str().expect("UTF-8")]);
    assert_eq!(code(&output), 5);
    let json: serde_json::Value =
        serde_json::from_slice(&std::fs::read(path).expect("a file")).expect("JSON");
    assert_eq!(json["summary"]["ending"], "failed");
}

#[test]
fn a_file_is_replaced_whole_or_not_at_all() {
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("a.csv");
    let name = path.to_str().expect("UTF-8");
    std::fs::write(&path, "precious").expect("written");
    for arguments in [["run", "euler-top", "--set", "I1=0"], ["run", "euler-top", "--t-end", "0"]] {
        let output = run(&[&arguments[..], &["-o", name]].concat());
        assert_ne!(code(&output), 0);
        assert_eq!(std::fs::read_to_string(&path).expect("a file"), "precious");
    }
    assert_eq!(code(&run(&["run", "euler-top", "-o", name])), 0);
    assert!(std::fs::read_to_string(&path).expect("a file").starts_with("t,"));
    assert_eq!(entries(directory.path()), [path], "nothing else is left");
}

fn entries(directory: &Path) -> Vec<PathBuf> {
    std::fs::read_dir(directory).expect("a directory").map(|entry| entry.expect("an entry").path()).collect()
}

#[cfg(unix)]
#[test]
fn a_new_file_has_the_usual_permissions_and_links_are_followed() {
    use std::os::unix::fs::PermissionsExt;
    let directory = tempfile::tempdir().expect("a directory");
    let at = |name: &str| directory.path().join(name);
    std::fs::write(at("plain"), "").expect("written");
    std::os::unix::fs::symlink(at("a.csv"), at("link.csv")).expect("a link");
    let output = at("a.csv");
    assert_eq!(code(&run(&["run", "euler-top", "-o", output.to_str().expect("UTF-8")])), 0);
    let mode = |path: &Path| std::fs::metadata(path).expect("a file").permissions().mode();
    assert_eq!(mode(&output), mode(&at("plain")));
    assert_eq!(code(&run(&["run", "euler-top", "-o", at("link.csv").to_str().expect("UTF-8")])), 0);
    assert!(std::fs::symlink_metadata(at("link.csv")).expect("a link").is_symlink());
}

#[test]
fn a_closed_pipe_is_reported_by_the_exit_code_alone() {
    let mut child = pc()
        .args(["run", "euler-top", "--rows", "50000"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("pc starts");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("pc ends");
    let text = stderr(&output);
    assert_eq!(code(&output), 6, "{text}");
    assert!(text.starts_with("Euler's top\n") && !text.contains("pc: "), "the summary alone: {text}");
}

#[test]
fn models_and_algebras_are_listed() {
    let text = stdout(&run(&["models"]));
    let names: Vec<&str> = text.lines().filter_map(|line| line.split_whitespace().next()).collect();
    assert!(names.contains(&"heavy-top-lagrange") && names.contains(&"euler-top"));
    let all: Vec<&str> = Builtin::all().map(|model| model.name).collect();
    assert!(names.iter().all(|name| all.contains(name)) && names.len() == all.len());
    each(Builtin::all(), |model| {
        let output = answer(&["check", model.name]);
        assert_eq!(code(&output), 0, "{}: {}", model.name, stderr(&output));
    });
    let text = stdout(&run(&["models", "--algebras"]));
    assert!(text.contains("so3") && text.contains("[X1,X2] = X3"));
}

#[test]
fn the_text_of_a_model_is_printed() {
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("ball.toml");
    let text = stdout(&run(&["models", "bouncing-ball"]));
    std::fs::write(&path, text.replace("e = 0.8", "e = 0.5")).expect("written");
    let path = path.display().to_string();
    let changed = stdout(&run(&["run", &path, "--t-end", "1"]));
    assert_eq!(changed, stdout(&run(&["run", "bouncing-ball", "--set", "e=0.5", "--t-end", "1"])));
    refuses(&["models", "bouncing-bal"], 2, "bouncing-ball");
    refuses(&["models", "bouncing-ball", "--algebras"], 2, "cannot be used with");
}

#[test]
fn source_is_emitted_into_a_directory() {
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("new").display().to_string();
    for (language, files) in [("c", ["euler_top.h", "euler_top.c"].as_slice()), ("rust", &["euler_top.rs"])] {
        let output = run(&["emit", "euler-top", "--lang", language, "-o", &path]);
        assert_eq!(code(&output), 0);
        for file in files {
            let text = std::fs::read_to_string(directory.path().join("new").join(file)).expect(file);
            assert!(text.contains("euler_top") && text.contains("ω1"), "{text}");
        }
    }
    refuses(&["emit", "euler-top", "--lang", "fortran", "-o", &path], 2, "possible values: c, rust");
}

#[test]
fn an_fmu_is_a_file_of_a_version_with_or_without_a_binary() {
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("top.fmu").display().to_string();
    let emit = |more: &[&'static str]| [&["emit", "euler-top", "--fmu", "3", "-o", &path], more].concat();
    assert_eq!(code(&run(&emit(&["--sources-only"]))), 0);
    let sources = std::fs::read(&path).expect("written");
    assert!(sources.starts_with(b"PK"));
    assert_eq!(code(&run(&emit(&["--sources-only"]))), 0);
    assert!(std::fs::read(&path).expect("written") == sources, "the same model gives the same bytes");
    assert_eq!(code(&run(&emit(&[]))), 0);
    assert!(std::fs::read(&path).expect("written").len() > sources.len());

    refuses(&["emit", "euler-top", "-o", &path], 2, "--lang");
    refuses(&["emit", "euler-top", "--fmu", "1", "-o", &path], 2, "possible values: 2, 3");
    refuses(&["emit", "euler-top", "--fmu", "3", "-o", "top.zip"], 2, "the name must end in .fmu");
    refuses(&emit(&["--lang", "c"]), 2, "cannot be used with");
    refuses(&emit(&["--solver", "rk4"]), 2, "--step");
    refuses(&["emit", "euler-top", "--lang", "c", "--sources-only", "-o", &path], 2, "cannot be used with");
}

#[test]
fn without_a_compiler_an_fmu_says_what_would_do() {
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("top.fmu");
    let output = Command::new(env!("CARGO_BIN_EXE_pc"))
        .args(["emit", "euler-top", "--fmu", "2", "-o"])
        .arg(&path)
        .env("CC", "no-such-compiler")
        .output()
        .expect("pc runs");
    assert_eq!(code(&output), 6);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(
        said.contains("there is no C compiler `no-such-compiler`") && said.contains("sources alone"),
        "{said}"
    );
    assert!(!path.exists());
}
