//! Sensitivities and projections where forces, tables and integrals jump: refused by name, or compared with closed forms.

use std::process::{Command, Output};

fn pc(name: &str, model: &str, arguments: &[&str]) -> Output {
    let path = std::env::temp_dir().join(format!("pc-jumping-rates-{}-{name}.toml", std::process::id()));
    std::fs::write(&path, model).expect("a place for the model");
    let mut program = Command::new(env!("CARGO_BIN_EXE_pc"));
    let output = program.arg(arguments[0]).arg(&path).args(&arguments[1..]).output().expect("pc runs");
    std::fs::remove_file(&path).expect("the model is removed");
    output
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("UTF-8")
}

/// What is said where a run is refused, from the first word of the reason.
fn refusal(name: &str, model: &str, arguments: &[&str], reason: &str) -> String {
    let output = pc(name, model, arguments);
    let said = text(&output.stderr);
    assert!(!output.status.success(), "{said}");
    let at = said.find(reason).unwrap_or_else(|| panic!("{said}"));
    said[at..].lines().next().expect("a line").to_owned()
}

/// The last row of a table.
fn last(name: &str, model: &str, arguments: &[&str]) -> Vec<f64> {
    let output = pc(name, model, arguments);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let row = text(&output.stdout).lines().last().expect("a row").to_owned();
    row.split(',').map(|cell| cell.parse().expect("a number")).collect()
}

fn point(parameter: &str, start: &str, speed: &str, force: &str) -> String {
    format!(
        "[parameters]\n{parameter}\n[coordinates]\nx = {start}\n[quasi_velocities]\n\"x'\" = {speed}\n\
         [lagrangian]\nkinetic = \"x'^2/2\"\n[forces]\nx = \"{force}\"\n[simulation]\nt_end = 2\n"
    )
}

#[test]
fn jumps_on_surfaces_of_the_state_are_refused() {
    let model = point("c = 0.5", "0", "1", "step(x - c, 2, 0)");
    let said = refusal("surface", &model, &["run", "--sensitivities", "c"], "the rate");
    insta::assert_snapshot!(said, @"the rate of x' jumps where x - c = 0, a surface of the state that `c` moves: derivatives of the motion jump with it, which they would not show. Make the jump an event that switches a state, or smooth it, as tanh does");
    let model = point("k = 0.3", "1", "0", "-x - k*sign(x')");
    let said = refusal("friction", &model, &["run", "--sensitivities", "k", "--method", "bdf"], "the rate");
    insta::assert_snapshot!(said, @"the rate of x' jumps where x' = 0, a surface of the state: derivatives of the motion jump with it, which they would not show. Make the jump an event that switches a state, or smooth it, as tanh does");
}

/// In momenta, the velocity in a dry friction is a function of the state.
#[test]
fn jumps_at_velocities_are_refused_in_momenta_too() {
    let model = point("k = 0.3", "1", "0", "-x - k*sign(x')");
    let arguments = ["run", "--form", "canonical", "--sensitivities", "k", "--method", "bdf"];
    let said = refusal("momenta", &model, &arguments, "the rate");
    assert!(said.starts_with("the rate of p_x jumps where x' = 0, a surface of the state: "), "{said}");
}

#[test]
fn jumps_at_times_are_refused_for_what_moves_them() {
    let model = point("c = 0.37\nk = 2.0", "0", "0", "step(t - c, k, 0)");
    let said = refusal("time", &model, &["run", "--sensitivities", "c"], "the rate");
    insta::assert_snapshot!(said, @"the rate of x' jumps where t - c = 0, at a time that `c` moves: derivatives of the motion jump with it, which they would not show. Make the jump an event that switches a state, or smooth it, as tanh does");
    for method in ["adams", "bdf"] {
        let row = last("amplitude", &model, &["run", "--sensitivities", "k", "--method", method]);
        // x = k (t − c)²/2
        let [by_k, speed_by_k] = row[row.len() - 2..] else { unreachable!("two derivatives") };
        assert!(
            (by_k - 1.63 * 1.63 / 2.0).abs() < 1e-6 && (speed_by_k - 1.63).abs() < 1e-6,
            "{method}: {row:?}"
        );
    }
}

/// (x, x′) at t = 2 of x″ = k (u − x), from (0.1, 0).
fn over_a_table(k: f64) -> [f64; 2] {
    let w = k.sqrt();
    [(0.5, 0.0), (0.6, 1.0), (0.9, -1.0)].into_iter().fold([0.1, 0.0], |[x, v], (time, u)| {
        let (sin, cos) = (w * time).sin_cos();
        [u + (x - u) * cos + v / w * sin, v * cos - (x - u) * w * sin]
    })
}

#[test]
fn sensitivities_pass_the_jumps_of_a_table() {
    let model = "[parameters]\nk = 0.7\n[inputs]\nu = { times = [0, 0.5, 1.1, 2], values = [0, 1, -1, 0.5], interpolation = \"hold\" }\n\
         [coordinates]\nx = 0.1\n[lagrangian]\nkinetic = \"x'^2/2\"\npotential = \"k*x^2/2\"\n[forces]\nx = \"u*k\"\n\
         [simulation]\nt_end = 2\n";
    let step = 1e-5;
    let (above, below) = (over_a_table(0.7 + step), over_a_table(0.7 - step));
    for method in ["adams", "bdf"] {
        let row = last("table", model, &["run", "--sensitivities", "k", "--method", method]);
        for (found, i) in row[row.len() - 2..].iter().zip(0..) {
            let right = (above[i] - below[i]) / (2.0 * step);
            assert!((found - right).abs() < 1e-7, "{method}: {found}, not {right}");
        }
    }
}

#[test]
fn corners_have_sensitivities() {
    // x = sin(w s)/w with w = √k, the time s = 1 after x = 0.
    let model = point("k = 4.0", "-1", "1", "-k*max(x, 0)");
    let right = (2f64.cos() / 2.0 - 2f64.sin() / 4.0) / 4.0;
    for method in ["adams", "bdf"] {
        let row = last("corner", &model, &["run", "--sensitivities", "k", "--method", method]);
        let found = row[row.len() - 2];
        assert!((found - right).abs() < 1e-6, "{method}: {found}, not {right}");
    }
}

#[test]
fn states_that_events_switch_have_sensitivities() {
    // From x = c on the force is 2: ∂x/∂c = −2 (t − c), ∂x′/∂c = −2.
    let model = point("c = 0.5", "0", "1", "2*s")
        + "[states]\ns = { start = 0, rate = \"0\" }\n[events.on]\nwhen = \"x - c\"\nreset = { s = \"1\" }\n";
    let row = last("switch", &model, &["run", "--sensitivities", "c", "--method", "adams", "--t-end", "1"]);
    let [by_c, speed_by_c] = row[row.len() - 3..row.len() - 1] else { unreachable!("two derivatives") };
    assert!((by_c + 1.0).abs() < 1e-7 && (speed_by_c + 2.0).abs() < 1e-7, "{row:?}");
}

#[test]
fn integrals_that_jump_are_not_kept() {
    let model = "[coordinates]\ny = 1.0\n[integrals]\nk = \"step(t-1,1,2)*(y'^2+y^2)\"\nfree = \"y'^2+y^2\"\n\
         [lagrangian]\nkinetic = \"y'^2/2\"\npotential = \"y^2/2\"\n[simulation]\nt_end = 3\n";
    insta::assert_snapshot!(refusal("kept", model, &["run", "--project", "k"], "`k`"), @"`k` cannot be kept: it may jump along the motion, to another value than that at the start");
    let row = last("free", model, &["run", "--project", "free"]);
    assert!((row[1] - 3f64.cos()).abs() < 1e-6, "{row:?}");
}

#[test]
fn bounded_functions_of_poles_are_conserved_where_they_do_not_jump() {
    let model = "[coordinates]\nx = 0.5\ny = 0.1\n[quasi_velocities]\n\"x'\" = 2\n[lagrangian]\nkinetic = \"(x'^2 + y'^2)/2\"\n\
         [integrals]\na = \"atan(tan(x))-x\"\nb = \"atan(x-3)+atan(1/(x-3))\"\nc = \"sqrt((x-3)^2)/(x-3)\"\n\
         sum = \"atan((x+y)/(1-x*y))-atan(x)-atan(y)\"\nunbounded = \"(x-3)*x'/(x-3)\"\n";
    let output = pc("poles", model, &["check"]);
    let said = text(&output.stdout);
    for name in ["a", "b", "c", "sum"] {
        let line = said.lines().find(|line| line.contains(&format!(" {name} ")));
        assert!(line.is_some_and(|line| line.contains("where it does not jump")), "{name}: {said}");
    }
    let line = said.lines().find(|line| line.contains("unbounded")).unwrap_or_else(|| panic!("{said}"));
    assert!(!line.contains("jump"), "{line}");
}
