//! Models with thousands of weakly coupled coordinates.

#![cfg(target_os = "linux")]

use std::fs;
use std::process::Command;

/// Oscillators, alone or each pulled by the next.
fn oscillators(n: usize, coupled: bool) -> String {
    let list = |entry: &dyn Fn(usize) -> String| (0..n).map(entry).collect::<Vec<_>>();
    let coordinates = list(&|i| format!("x{i} = 0.5")).join("\n");
    let kinetic = list(&|i| format!("x{i}'^2/2")).join(" + ");
    let alone = |i: usize| format!("x{i}^2/2");
    let pulled = |i: usize| format!("(x{}-x{i})^2/2 + x{i}^4/4", (i + 1) % n);
    let potential = list(if coupled { &pulled } else { &alone }).join(" + ");
    format!(
        "[coordinates]\n{coordinates}\n[lagrangian]\nkinetic = \"{kinetic}\"\npotential = \"{potential}\"\n\
         [simulation]\nt_end = 0.1\nsamples = 2\n"
    )
}

/// Several dense n × n matrices of expressions would take more than a gigabyte for 2000
/// coordinates.
#[test]
fn memory_is_that_of_what_is_not_zero() {
    let place = tempfile::tempdir().expect("a directory");
    for coupled in [false, true] {
        let (model, rows) = (place.path().join("model.toml"), place.path().join("rows.csv"));
        fs::write(&model, oscillators(2000, coupled)).expect("a file");
        let output = Command::new("sh")
            .args(["-c", "ulimit -v 500000; exec \"$0\" run \"$1\" -o \"$2\"", env!("CARGO_BIN_EXE_pc")])
            .args([&model, &rows])
            .output()
            .expect("a shell");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let rows = fs::read_to_string(&rows).expect("rows");
        let last: Vec<f64> =
            rows.lines().last().expect("a row").split(',').map(|x| x.parse().expect("a number")).collect();
        if !coupled {
            // x = 0.5 cos t; the tolerance of the motion is 1e-9.
            let (t, x) = (last[0], &last[1..2001]);
            assert!(x.iter().all(|x| (x - 0.5 * t.cos()).abs() < 1e-7), "{:?}", &x[..3]);
        }
    }
}
