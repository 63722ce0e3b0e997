//! Events under nonholonomic and rolling constraints: times compared with closed forms, in both
//! forms and by both methods.

use std::f64::consts::TAU;
use std::process::Command;

use serde_json::Value;

/// The contents of `-o FILE.json` after a run that succeeds.
fn kept(model: &str, options: &[&str]) -> Value {
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("run.json");
    let mut command = Command::new(env!("CARGO_BIN_EXE_pc"));
    let output = command.args(["run", model, "-o"]).arg(&path).args(options).output().expect("pc runs");
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{text}");
    serde_json::from_slice(&std::fs::read(path).expect("a file")).expect("JSON")
}

/// Runs in both forms and by both methods, with a bound on the errors of times: local errors of
/// 1e-13 in a few thousand steps; the method of order 5 takes several times as many, and its errors
/// have one sign.
fn sharply(model: &str, options: &[&str], check: impl Fn(&Value, f64)) {
    for form in ["poincare", "canonical"] {
        for (method, within) in [("adams", 1e-10), ("bdf", 1e-9)] {
            let sharp = ["--rtol", "1e-13", "--atol", "1e-15", "--form", form, "--method", method];
            check(&kept(model, &[&sharp, options].concat()), within);
        }
    }
}

/// Names and times of the events that occurred, in order.
fn events(run: &Value) -> Vec<(&str, f64)> {
    let events = run["events"].as_array().expect("a list").iter();
    events.map(|e| (e["name"].as_str().expect("a name"), e["time"].as_f64().expect("a time"))).collect()
}

fn rows(run: &Value) -> Vec<Vec<f64>> {
    let rows = run["rows"].as_array().expect("rows").iter();
    rows.map(|row| {
        row.as_array().expect("a row").iter().map(|value| value.as_f64().expect("a number")).collect()
    })
    .collect()
}

#[track_caller]
fn assert_close(run: &Value, expected: &[(&str, f64)], within: f64) {
    let found = events(run);
    assert_eq!(found.len(), expected.len(), "{found:?} {expected:?}");
    for (found, expected) in found.iter().zip(expected) {
        let close = found.0 == expected.0 && (found.1 - expected.1).abs() < within;
        assert!(close, "{found:?} is not {expected:?}");
    }
}

/// Going straight, pulled by a moving peg, the sleigh is the block: slips last (2π − 2 arctan q)/ω
/// with q = ω = 1, stops 2 (F_s − F_k)/(k V) = 2.
#[test]
fn a_sleigh_going_straight_moves_like_the_block() {
    let straight = ["--set", "ω0=0", "--set", "a=0", "--set", "V=0.5", "--set", "Fk=0.5", "--set", "ξ0=-1"];
    let (slip, stop) = (TAU * 0.75, 2.0);
    let expected = [("stop", 0.0), ("slip", stop), ("stop", stop + slip), ("slip", 2.0 * stop + slip)];
    let mut expected: Vec<(&str, f64)> = expected.map(|(name, t)| (name, t + slip)).to_vec();
    expected.push(("stop", 3.0 * slip + 2.0 * stop));
    sharply("stick-slip-sleigh", &straight, |run, within| assert_close(run, &expected, within));
}

/// The sleigh that turns at a constant rate, m = k = 1, a = V = 0: leg by leg, in coordinates along
/// and across the blade.
fn turning_sleigh(
    omega: f64,
    [static_friction, friction]: [f64; 2],
    x0: f64,
    end: f64,
) -> Vec<(&'static str, f64)> {
    let (mut along, mut across, mut mode, mut t) = (x0, 0.0, 1.0, 0.0);
    let mut found = Vec::new();
    loop {
        if mode == 0.0 {
            // The first time at which ξ = R cos(ψ − ω τ) is ±F_s.
            let (radius, angle) = (f64::hypot(along, across), f64::atan2(across, along));
            if radius <= static_friction {
                return found;
            }
            let wait = [1.0, -1.0].map(|side| {
                let slip: f64 = (side * static_friction / radius).acos();
                [angle - slip, angle + slip].map(|turn| (turn / omega).rem_euclid(TAU / omega.abs()))
            });
            let wait = wait.into_iter().flatten().fold(f64::INFINITY, f64::min);
            let now = angle - omega * wait;
            (along, across, t) = (radius * now.cos(), radius * now.sin(), t + wait);
            mode = -along.signum();
            found.push(("slip", t));
        } else {
            let rate = (1.0 + omega * omega).sqrt();
            let middle = -mode * friction / (rate * rate);
            let (a, b) = (along - middle, omega * across / rate);
            let place = |tau: f64| {
                let (sin, cos) = (rate * tau).sin_cos();
                let far = middle * tau + a * sin / rate + b * (1.0 - cos) / rate;
                let along = middle + a * cos + b * sin;
                let across = across - omega * far;
                (along, across, rate * (b * cos - a * sin) - omega * across)
            };
            // The speed starts at zero, has the sign of the mode, and returns to zero once.
            let mut until = 1e-3;
            while place(until).2 * mode > 0.0 {
                until += 1e-3;
            }
            let mut from = until - 1e-3;
            while from < 0.5 * (from + until) && 0.5 * (from + until) < until {
                let half = 0.5 * (from + until);
                if place(half).2 * mode > 0.0 { from = half } else { until = half }
            }
            (along, across, _) = place(until);
            t += until;
            mode = if along.abs() < static_friction { 0.0 } else { -along.signum() };
            found.push(("stop", t));
        }
        if t > end {
            found.pop();
            return found;
        }
    }
}

/// The constraint makes the spring stiffer, with the frequency (k/m + ω²)^½, and the sleigh turns
/// on the spot while it sticks.
#[test]
fn a_sleigh_that_turns_sticks_and_slips() {
    for (omega, friction, x0) in [(2.0, [1.0, 0.8], -3.0), (1.0, [1.0, 0.9], -4.0), (-1.0, [1.5, 1.0], -4.0)]
    {
        let expected = turning_sleigh(omega, friction, x0, 20.0);
        let slips = expected.iter().filter(|(name, _)| *name == "slip").count();
        assert!(slips > 0 && expected.len() > slips + 3, "it slips back too: {expected:?}");
        let options = [("ω0", omega), ("a", 0.0), ("Fs", friction[0]), ("Fk", friction[1]), ("ξ0", x0)];
        let options = options.map(|(name, value)| ["--set".to_owned(), format!("{name}={value}")]).concat();
        let options: Vec<&str> = options.iter().map(String::as_str).collect();
        sharply("stick-slip-sleigh", &options, |run, within| assert_close(run, &expected, within));
    }
}

/// The rates of y = (X, Y, φ, v, ω) by Newton's and Euler's equations, m = J = k = 1, a = 0.1, with
/// this friction of the blade.
fn sleigh(y: [f64; 5], friction: f64) -> [f64; 5] {
    let ((sin, cos), [v, omega]) = (y[2].sin_cos(), [y[3], y[4]]);
    [v * cos, v * sin, omega, pull(y) - friction, -0.1 * v * omega / 1.01]
}

/// The force along the blade: of the spring, and the centrifugal force of the mass centre.
fn pull(y: [f64; 5]) -> f64 {
    0.1 * y[4] * y[4] - y[0] * y[2].cos() - y[1] * y[2].sin()
}

/// A step of the Runge–Kutta method of order 4.
fn step(rates: impl Fn([f64; 5]) -> [f64; 5], y: [f64; 5], h: f64) -> [f64; 5] {
    let ahead = |rate: [f64; 5], h: f64| std::array::from_fn(|i| y[i] + h * rate[i]);
    let a = rates(y);
    let b = rates(ahead(a, h / 2.0));
    let c = rates(ahead(b, h / 2.0));
    let d = rates(ahead(c, h));
    std::array::from_fn(|i| y[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]))
}

/// The model with its own parameters: the mass centre is ahead of the blade, and speed along the
/// blade is gained from turning.
#[test]
fn the_mass_centre_ahead_of_the_blade() {
    const H: f64 = 1.0 / 4096.0; // H⁴ is 4e-15
    let (mut y, mut mode, mut t) = ([-3.0, 0.0, 0.0, 0.0, 2.0], 1.0, 0.0);
    let mut expected = Vec::new();
    while t < 20.0 {
        // A leg ends when the spring overcomes static friction, or when the speed changes sign.
        let ended = |y: [f64; 5]| if mode == 0.0 { pull(y).abs() > 1.0 } else { y[3] * mode < 0.0 };
        let rates = |y: [f64; 5]| {
            if mode == 0.0 { [0.0, 0.0, y[4], 0.0, 0.0] } else { sleigh(y, 0.8 * mode) }
        };
        let next = step(rates, y, H);
        if !ended(next) {
            (y, t) = (next, t + H);
            continue;
        }
        let (mut from, mut until) = (0.0, H);
        for _ in 0..60 {
            let half = 0.5 * (from + until);
            if ended(step(rates, y, half)) { until = half } else { from = half }
        }
        (y, t) = (step(rates, y, until), t + until);
        expected.push((if mode == 0.0 { "slip" } else { "stop" }, t));
        let sticks = mode != 0.0 && pull(y).abs() <= 1.0;
        mode = if sticks { 0.0 } else { pull(y).signum() };
        y[3] = 0.0;
    }
    expected.retain(|&(_, t)| t < 20.0);
    let count = |name| expected.iter().filter(|event| event.0 == name).count();
    assert!(count("slip") > 2 && count("stop") > count("slip") + 2, "{expected:?}");
    sharply("stick-slip-sleigh", &[], |run, within| {
        assert_close(run, &expected, within);
        assert_eq!(run["summary"]["keeps_energy"], false);
        assert!((rows(run).last().expect("rows")[6] - y[4]).abs() < 10.0 * within, "ω at the end");
    });
}

/// ∫ f from 0 to b by Simpson's rule.
fn integral(f: impl Fn(f64) -> f64, b: f64) -> f64 {
    let n = 2000; // h⁴ is 1e-14
    let h = b / f64::from(n);
    let weight = |i: i32| if i == 0 || i == n { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
    h / 3.0 * (0..=n).map(|i| weight(i) * f(h * f64::from(i))).sum::<f64>()
}

/// T(E) = ∫₀^α √(I/(2E + 2 m g c cos θ)) dθ to the first impact, twice that between impacts; impact
/// n leaves e²ⁿ of the kinetic energy at the pegs.
#[test]
fn the_disk_rocks() {
    let (alpha, weight) = (0.6_f64, 9.81 * 0.5); // m g c
    let inertia = |theta: f64| 0.3 + 1.25 - theta.cos();
    let mut kinetic = 0.5 * inertia(0.0) * 9.0 - weight * (1.0 - alpha.cos()); // at the pegs
    let quarter = |kinetic: f64| {
        let at = |theta: f64| kinetic + weight * (theta.cos() - alpha.cos());
        integral(|theta| (inertia(theta) / (2.0 * at(theta))).sqrt(), alpha)
    };
    let (mut t, mut expected) = (quarter(kinetic), Vec::new());
    while t < 5.0 {
        expected.push((if expected.len() % 2 == 0 { "right" } else { "left" }, t));
        kinetic *= 0.64;
        t += 2.0 * quarter(kinetic);
    }
    assert!(expected.len() > 5, "{expected:?}");
    sharply("rocking-disk", &[], |run, within| {
        assert_close(run, &expected, within);
        // The disk rolls, X = R θ, and stays between the pegs.
        assert!(rows(run).iter().all(|row| (row[1] - row[2]).abs() < within && row[2].abs() < alpha + 1e-12));
    });
}
