//! Motions, sensitivities and projections where forces, tables and integrals jump: compared with closed forms, or refused by
//! name.

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

/// The last two numbers of a row: the derivatives of x and x' by one parameter.
fn derivatives(name: &str, model: &str, arguments: &[&str]) -> [f64; 2] {
    let row = last(name, model, arguments);
    let [x, speed] = row[row.len() - 2..] else { unreachable!("two derivatives") };
    [x, speed]
}

fn assert_near(found: [f64; 2], right: [f64; 2], what: &str) {
    for (found, right) in found.iter().zip(right) {
        assert!((found - right).abs() < 1e-7, "{what}: {found}, not {right}");
    }
}

/// From x = c on the force is 2: x = c + v s + s² with s = t − c/v, v = 1.
#[test]
fn derivatives_jump_on_surfaces_of_the_state() {
    let model = point("c = 0.5", "0", "1", "step(x - c, 2, 0)");
    for method in ["adams", "bdf", "dop853", "taylor"] {
        let found = derivatives("surface", &model, &["run", "--sensitivities", "c", "--method", method]);
        assert_near(found, [-3.0, -2.0], method);
    }
    // x = k + (1 − k) cos t, and from π on −k + (3 k − 1) cos(t − π).
    let model = point("k = 0.3", "1", "0", "-x - k*sign(x')");
    let since = 4.0 - std::f64::consts::PI;
    let right = [3.0 * since.cos() - 1.0, -3.0 * since.sin()];
    for method in ["adams", "bdf", "dop853", "taylor"] {
        let arguments = ["run", "--sensitivities", "k", "--method", method, "--t-end", "4"];
        assert_near(derivatives("friction", &model, &arguments), right, method);
    }
}

/// In momenta, the velocity in a dry friction is a function of the state.
#[test]
fn derivatives_jump_at_velocities_in_momenta_too() {
    let model = point("k = 0.3", "1", "0", "-x - k*sign(x')");
    let since = 4.0 - std::f64::consts::PI;
    let right = [3.0 * since.cos() - 1.0, -3.0 * since.sin()];
    let arguments = ["run", "--form", "canonical", "--sensitivities", "k", "--method", "bdf", "--t-end", "4"];
    assert_near(derivatives("momenta", &model, &arguments), right, "momenta");
}

/// x = k (t − c)²/2
#[test]
fn derivatives_jump_at_times() {
    let model = point("c = 0.37\nk = 2.0", "0", "0", "step(t - c, k, 0)");
    for method in ["adams", "bdf", "dop853", "taylor"] {
        let by_time = derivatives("time", &model, &["run", "--sensitivities", "c", "--method", method]);
        assert_near(by_time, [-2.0 * 1.63, -2.0], method);
        let by_force = derivatives("amplitude", &model, &["run", "--sensitivities", "k", "--method", method]);
        assert_near(by_force, [1.63 * 1.63 / 2.0, 1.63], method);
    }
}

/// A body on an incline of slope 1 brakes with the friction 4 from v = 1.5 to rest at v²/6, and a push of 2 cos 3t does
/// not move it again.
#[test]
fn friction_holds_by_every_method() {
    let model = point("m = 4", "0", "1.5", "1 - m*sign(x')");
    for method in ["dop853", "adams", "bdf", "auto", "taylor"] {
        let output = pc("holds", &model, &["run", "--method", method]);
        let said = text(&output.stderr);
        assert!(output.status.success() && said.contains("along x' = 0 from 0.5 on"), "{method}: {said}");
        let row = last("holds", &model, &["run", "--method", method]);
        assert!((row[1] - 0.375).abs() < 1e-8 && row[2].abs() < 1e-9, "{method}: {row:?}");
    }
    let pushed = point("m = 4", "0", "0", "1 + 2*cos(3*t) - m*sign(x')");
    for method in ["dop853", "adams", "bdf", "auto", "taylor"] {
        let row = last("pushed", &pushed, &["run", "--method", method]);
        assert!(row[1].abs() < 1e-12 && row[2].abs() < 1e-12, "{method}: {row:?}");
    }
}

/// A body held by friction on belts whose speed changes slips until it is as fast as the next one.
#[test]
fn friction_follows_a_belt_that_changes_its_speed() {
    // The speeds of the belts, then (x, x') at t = 5. From 1 to 2 and back the body needs 1 and the way 3/2.
    let cases = [
        ("step(x - 2, 2, 1)", "1", [7.5, 2.0]),
        ("step(x - 1, step(3 - x, 2, 1), 1)", "1", [6.25, 1.0]),
        ("step(t - 1, 1, 0)", "0", [3.5, 1.0]),
    ];
    for (k, (belt, speed, right)) in cases.into_iter().enumerate() {
        let model = point("m = 1", "0", speed, &format!("-m*sign(x' - {belt})"));
        for method in ["dop853", "adams", "bdf", "auto", "taylor"] {
            let output = pc(&format!("belt-{k}"), &model, &["run", "--t-end", "5", "--method", method]);
            let (said, table) = (text(&output.stderr), text(&output.stdout));
            assert!(output.status.success() && !said.contains("side 0"), "{belt} by {method}: {said}");
            let row: Vec<f64> = table
                .lines()
                .last()
                .expect("a row")
                .split(',')
                .map(|cell| cell.parse().expect("a number"))
                .collect();
            assert_near([row[1], row[2]], right, &format!("{belt} by {method}"));
        }
    }
}

/// A spring of constant force whose rest jumps at t = 1 from 0 to −1 while the body passes: it is to the right of the rest for a
/// short time, which one step of DOP853 contains.
#[test]
fn a_table_jumps_over_a_body_that_returns_within_a_step() {
    let model = "[coordinates]\nx = 0.5\n[quasi_velocities]\n\"x'\" = -1.4\n\
                 [inputs]\nr = { times = [0.0, 1.0, 5.0], values = [0.0, -1.0, -1.0], interpolation = \"hold\" }\n\
                 [lagrangian]\nkinetic = \"x'^2/2\"\npotential = \"abs(x - r)/10\"\n[simulation]\nt_end = 2\n";
    // It passes 0 at τ with the speed v, is pushed back up to t = 1, forward up to −1, and back from there.
    let motion = |x: f64, v: f64, a: f64, t: f64| (x + v * t + a * t * t / 2.0, v + a * t);
    let until = |x: f64, v: f64, a: f64, to: f64| {
        let root = (v * v + 2.0 * a * (to - x)).sqrt();
        (-v - root) / a
    };
    let mut at = (0.5, -1.4);
    let first = until(at.0, at.1, -0.1, 0.0);
    at = motion(at.0, at.1, -0.1, first);
    at = motion(at.0, at.1, 0.1, 1.0 - first);
    let second = until(at.0, at.1, -0.1, -1.0);
    at = motion(at.0, at.1, -0.1, second);
    at = motion(at.0, at.1, 0.1, 1.0 - second);
    assert!(first < 1.0 && second > 0.0 && second < 0.1);
    for method in ["dop853", "adams", "bdf", "auto"] {
        let row = last("rest", model, &["run", "--method", method, "--rtol", "1e-10"]);
        assert_near([row[1], row[2]], at.into(), method);
    }
}

/// A relay that holds b where 0.12 b = −0.0968 is at the end on a jump of its rate, where rounding chooses the side: derivations
/// are compared beside it.
#[test]
fn a_motion_may_end_on_a_jump() {
    let model = point("m = 1", "0", "0", "0")
        + "[states]\na = { start = 0.48, rate = \"-0.83*a + 0.02 - 0.95*step(0.03*b - 0.53, step(1.79*b + 0.17 - \
           1.31*sign(1.67*a - 0.3*b - 0.73), -0.34, 0.77), -1.1)\" }\n\
           b = { start = -0.59, rate = \"-0.84*b - 0.83 - 1.53*step(0.12*b + 0.98 - 0.96*step(-0.57*a - 0.85 + \
           1.39*step(-1.32*a - 0.48*b - 0.86, 1.91, 0.53), -1.95, 0.92), 0.51, -0.34)\" }\n";
    for method in ["dop853", "adams", "bdf", "taylor"] {
        let row = last("relay", &model, &["run", "--t-end", "3", "--rtol", "1e-10", "--method", method]);
        assert_near([row[3], row[4]], [1.2165448388892248, -0.0968 / 0.12], method);
    }
}

/// Forces that change at times, at places, at corners and where an angle is cut: x and x' at t = 2 by every method.
/// While friction holds a body, its acceleration is 0 and the friction is the force against the push; before, it slips.
#[test]
fn outputs_are_those_of_the_friction_that_holds() {
    let model = point("mu = 3", "0", "2", "-mu*sign(x') + 2*cos(t)")
        + "samples = 41\n[outputs]\nacceleration = \"d(x')\"\nfriction = \"-mu*sign(x')\"\nsquare = \"(mu*sign(x'))^2\"\n";
    for method in ["auto", "adams", "bdf", "taylor"] {
        let output = pc("held", &model, &["run", "--t-end", "5", "--method", method]);
        assert!(output.status.success(), "{}", text(&output.stderr));
        let rows = text(&output.stdout);
        let (mut slips, mut holds) = (0, 0);
        for row in rows.lines().skip(1) {
            let row: Vec<f64> = row.split(',').map(|cell| cell.parse().expect("a number")).collect();
            let [t, _, speed, _, acceleration, friction, square] = row[..] else { panic!("{row:?}") };
            let push = 2.0 * f64::cos(t);
            let right = if speed > 1e-6 { -3.0 } else { -push };
            assert!((friction - right).abs() < 1e-9 && (square - right * right).abs() < 1e-8, "{method} {t}");
            assert!((acceleration - (push + right)).abs() < 1e-9, "{method} {t}: {acceleration}");
            if speed > 1e-6 { slips += 1 } else { holds += 1 }
        }
        assert_eq!((slips, holds), (11, 30), "{method}");
    }
}

#[test]
fn steps_end_where_forces_change() {
    let half = 0.5f64;
    let cases = [
        // 1 for t < 1/2, −1 then, and so on: the speed is a triangle.
        ("sign(sin(2*pi*t))", "0", "0", [half, 0.0]),
        // x = t until 1/2, then cosh(t − 1/2) … of x″ = x − 1/2 from speed 1.
        ("max(x - 1/2, 0)", "0", "1", [half + 1.5f64.sinh(), 1.5f64.cosh()]),
        // A sawtooth t − 1/2 − [t].
        ("atan(tan(pi*(t - 0.5)))/pi", "0", "0", [-1.0 / 6.0, 0.0]),
        // Through a layer of width 0.001 in which the force is 1000: the speed is √3.
        ("step(x - 1, step(1.001 - x, 1000, 0), 0)", "0", "1", {
            let speed = 3f64.sqrt();
            let through = (speed - 1.0) / 1000.0;
            [1.001 + speed * (1.0 - through), speed]
        }),
        // A pulse with a corner, of the momentum 2.
        ("exp(-abs(t - 1.3)/0.001)/0.001", "0", "0", [1.4, 2.0]),
        // A wall, V = 2 exp(−|x − 5|/0.01): a body of the energy 1/2 comes back as from x = 5.
        ("200*sign(x - 5)*exp(-abs(x - 5)/0.01)", "4", "1", [4.0, -1.0]),
    ];
    for (k, (force, start, speed, right)) in cases.into_iter().enumerate() {
        let model = point("m = 1", start, speed, force);
        for method in ["dop853", "adams", "bdf", "auto", "taylor"] {
            let row = last(&format!("changes-{k}"), &model, &["run", "--method", method, "--rtol", "1e-11"]);
            let near = (row[1] - right[0]).abs() < 1e-6 && (row[2] - right[1]).abs() < 1e-6;
            assert!(near, "{force} by {method}: {row:?}, not {right:?}");
        }
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
    for method in ["adams", "bdf", "dop853"] {
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
    for method in ["adams", "bdf", "dop853", "taylor"] {
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
