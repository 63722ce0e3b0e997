//! Bodies on spherical and free joints, at default options: |q| stays 1, and both derivations speak of the same state.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use tempfile::TempDir;

/// The output of `pc` for a model text.
struct Case {
    directory: TempDir,
}

impl Case {
    fn new(text: &str) -> Case {
        let directory = tempfile::tempdir().expect("a directory");
        fs::write(directory.path().join("model.toml"), text).expect("written");
        Case { directory }
    }

    fn path(&self) -> &Path {
        self.directory.path()
    }

    fn pc(&self, arguments: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_pc"));
        let output = command.args(arguments).current_dir(self.path()).output().expect("pc starts");
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        output
    }

    /// The names and rows of a table.
    fn run(&self, further: &[&str]) -> (Vec<String>, Vec<Vec<f64>>) {
        let output = self.pc(&[&["run", "model.toml"], further].concat());
        let text = String::from_utf8(output.stdout).expect("UTF-8");
        let mut lines = text.lines();
        let names = lines.next().expect("a header").split(',').map(str::to_owned).collect();
        let row = |line: &str| line.split(',').map(|number| number.parse().expect("a number")).collect();
        (names, lines.map(row).collect())
    }
}

fn place(names: &[String], name: &str) -> usize {
    names.iter().position(|known| known == name).unwrap_or_else(|| panic!("no {name} in {names:?}"))
}

/// Largest | |q| − 1 | of a quaternion in the rows.
fn off(names: &[String], rows: &[Vec<f64>], joint: &str) -> f64 {
    let places: [usize; 4] = std::array::from_fn(|i| place(names, &format!("{joint}_q{i}")));
    let norm = |row: &Vec<f64>| places.iter().fold(0.0f64, |norm, &i| norm.hypot(row[i]));
    rows.iter().map(|row| (norm(row) - 1.0).abs()).fold(0.0, f64::max)
}

const METHODS: [&str; 5] = ["auto", "dop853", "taylor", "adams", "bdf"];

/// A tumbling top on a ball joint, and a second body on it by another one.
const TOPS: &str = "\
[quasi_velocities]
\"top_ω1\" = 0.5
\"top_ω2\" = -0.2
\"top_ω3\" = 7.0
\"rod_ω2\" = 1.5
[bodies.top]
joint = { kind = \"spherical\" }
mass = 2.0
center = [0, 0, 0.25]
inertia = [0.11, 0.13, 0.07]
[bodies.rod]
parent = \"top\"
joint = { kind = \"spherical\", at = [0, 0.1, 0.5] }
mass = 0.3
center = [0, 0, 0.4]
inertia = [0.02, 0.02, 0.001]
[gravity]
acceleration = [0, 0, -9.81]
";

/// The rounding of four squares and a root.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

#[test]
fn quaternions_keep_their_length_by_all_methods_and_forms() {
    let case = Case::new(TOPS);
    for method in METHODS {
        let loose = ["--t-end", "8", "--rows", "33", "--method", method, "--rtol", "1e-5"];
        let (names, rows) = case.run(&loose);
        for joint in ["top", "rod"] {
            assert!(off(&names, &rows, joint) <= ROUNDING, "{method}: {}", off(&names, &rows, joint));
        }
    }
    let (names, rows) = case.run(&["--t-end", "4", "--rows", "9", "--form", "canonical"]);
    assert!(off(&names, &rows, "top") <= ROUNDING && off(&names, &rows, "rod") <= ROUNDING);
}

/// Rotation about a principal axis: q = (cos ω t/2, 0, 0, sin ω t/2).
#[test]
fn a_body_turns_about_its_principal_axis() {
    let case = Case::new(
        "[quasi_velocities]\n\"b_ω3\" = 1.25\n[bodies.b]\njoint = { kind = \"spherical\" }\ninertia = [2, 1, 4]\n",
    );
    for method in METHODS {
        let (names, rows) = case.run(&["--t-end", "6", "--rows", "4", "--method", method]);
        for row in &rows {
            let (sine, cosine) = (0.625 * row[0]).sin_cos();
            let q = ["b_q0", "b_q1", "b_q2", "b_q3"].map(|name| row[place(&names, name)]);
            // A hundred steps with errors of 1e-9.
            let error =
                q.iter().zip([cosine, 0.0, 0.0, sine]).map(|(q, x)| (q - x).abs()).fold(0.0, f64::max);
            assert!(error < 1e-6, "{method}: {error}");
        }
    }
}

/// The mass centre of a free body falls: z = v t − g t²/2 from body axes that are those of the world at the start.
#[test]
fn a_free_body_falls_and_tumbles() {
    let case = Case::new(
        "[quasi_velocities]\n\"b_ω1\" = 0.02\n\"b_ω2\" = 3.0\n\"b_v3\" = 5.0\n[bodies.b]\njoint = { kind = \"free\" }\n\
         mass = 3.0\ninertia = [1, 2, 2.5]\n[gravity]\nacceleration = [0, 0, -9.81]\n",
    );
    let (names, rows) = case.run(&["--t-end", "20", "--rows", "5"]);
    assert!(off(&names, &rows, "b") <= ROUNDING);
    for row in &rows {
        let z = 5.0 * row[0] - 9.81 / 2.0 * row[0] * row[0];
        assert!((row[place(&names, "b_z")] - z).abs() < 1e-6 * (1.0 + z.abs()), "{row:?}");
    }
}

/// A start of nine digits is that of the unit quaternion nearest to it.
#[test]
fn a_rounded_quaternion_is_a_unit_quaternion() {
    let text = TOPS.replace(
        "[quasi_velocities]",
        "[coordinates]\ntop_q0 = 0.923879533\ntop_q1 = 0.382683432\n[quasi_velocities]",
    );
    let case = Case::new(&text);
    let (names, rows) = case.run(&["--t-end", "1", "--rows", "2"]);
    assert!(off(&names, &rows, "top") <= ROUNDING, "{:?}", rows[0]);
}

/// Members of a sweep are integrated side by side; each is that of a run.
#[test]
fn members_of_a_sweep_keep_the_length_of_quaternions() {
    let case = Case::new(&format!("[parameters]\nm = 0.3\n{}", TOPS.replace("mass = 0.3", "mass = \"m\"")));
    case.pc(&["sweep", "model.toml", "--vary", "m=0.1:0.5:9", "--t-end", "4", "-o", "sweep.csv"]);
    let text = fs::read_to_string(case.path().join("sweep.csv")).expect("a table");
    let mut lines = text.lines().filter(|line| !line.starts_with('#'));
    let names: Vec<String> = lines.next().expect("a header").split(',').map(str::to_owned).collect();
    let rows: Vec<Vec<f64>> =
        lines.map(|line| line.split(',').map(|x| x.parse().unwrap_or(f64::NAN)).collect()).collect();
    assert_eq!(rows.len(), 9);
    assert!(off(&names, &rows, "top") <= ROUNDING && off(&names, &rows, "rod") <= ROUNDING);
    let set = format!("m={}", rows[4][place(&names, "m")]);
    let (of_run, single) = case.run(&["--set", &set, "--t-end", "4", "--rows", "2"]);
    for (name, value) in
        of_run.iter().zip(single.last().expect("a row")).skip(1).filter(|(name, _)| *name != "energy")
    {
        let found = rows[4][place(&names, name)];
        // Other last digits, which a tumbling top makes ten thousand times as large.
        assert!((found - value).abs() < 1e-7 * (1.0 + value.abs()), "{name}: {found}, not {value}");
    }
}
