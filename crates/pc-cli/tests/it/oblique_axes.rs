//! Bodies on joints along axes with three components, whose constants are rounded.

use std::fs;
use std::process::Command;

/// A body on a ball joint, and one that slides and turns along an axis of it.
const PAIR: &str = "\
[quasi_velocities]
\"a_ω1\" = 0.4
\"a_ω2\" = -1.1
\"a_ω3\" = -2.3
[bodies.a]
joint = { kind = \"spherical\" }
mass = 0.8
center = [0.13, 0.06, -0.32]
inertia = [0.23, 0.25, 0.31]
[bodies.b]
parent = \"a\"
joint = { kind = \"cylindrical\", axis = [-0.25, 0.95, 0.2], at = [-0.6, 0.3, 0.1] }
mass = 1.5
center = [-0.4, 0.5, -0.3]
inertia = [0.9, 1.1, 1.2]
[gravity]
acceleration = [0, 0, -9.81]
";

/// A third body that is placed relative to the second, but not held by it.
const LOOSE: &str = "\
[bodies.c]
parent = \"b\"
joint = { kind = \"free\", at = [0.6, -0.7, -0.1] }
mass = 2.5
center = [-0.3, 0.04, -0.17]
inertia = [0.7, 1.3, 1.6]
";

/// The names and rows of a motion.
fn run(text: &str) -> (Vec<String>, Vec<Vec<f64>>) {
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("model.toml"), text).unwrap();
    let arguments = ["run", "model.toml", "--t-end", "2", "--rows", "9", "--rtol", "1e-12"];
    let output = Command::new(env!("CARGO_BIN_EXE_pc"))
        .args(arguments)
        .current_dir(directory.path())
        .output()
        .expect("pc starts");
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    let mut lines = text.lines();
    let names = lines.next().expect("a header").split(',').map(str::to_owned).collect();
    let row = |line: &str| line.split(',').map(|number| number.parse().unwrap()).collect();
    (names, lines.map(row).collect())
}

/// A free joint exerts no load: the bodies before it move as if there were none, and the whole keeps its energy.
/// The equations of this chain were refused, as an acceleration cancels from them but for rounding.
#[test]
fn a_body_on_a_free_joint_does_not_move_those_before_it() {
    let (pair, alone) = run(PAIR);
    let moving = PAIR.replace(
        "[bodies.a]",
        "\"c_ω1\" = 0.6\n\"c_ω2\" = 1.2\n\"c_ω3\" = -0.7\n\"c_v1\" = 0.9\n\"c_v2\" = 1.4\n\"c_v3\" = -0.8\n[bodies.a]",
    );
    let (names, rows) = run(&moving.replace("[gravity]", &format!("{LOOSE}[gravity]")));
    assert_eq!((rows.len(), alone.len()), (9, 9));
    let place =
        |names: &[String], name: &str| names.iter().position(|known| known == name).expect("a column");
    let energy = place(&names, "energy");
    let compared: Vec<(usize, usize)> = (pair.iter().enumerate())
        .filter(|(_, name)| *name != "energy")
        .map(|(column, name)| (column, place(&names, name)))
        .collect();
    assert_eq!(compared.len(), 12, "{pair:?}");
    for (row, alone) in rows.iter().zip(&alone) {
        // A few hundred steps with relative errors of 1e-12 in numbers up to 100.
        let change = (row[energy] / rows[0][energy] - 1.0).abs();
        assert!(change < 1e-9, "{change} of the energy at {}", row[0]);
        for &(of_pair, of_whole) in &compared {
            let (expected, found) = (alone[of_pair], row[of_whole]);
            let error = (found - expected).abs() / (1.0 + expected.abs());
            assert!(error < 1e-9, "{} at {}: {found}, not {expected}", pair[of_pair], row[0]);
        }
    }
}
