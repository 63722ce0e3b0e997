//! `pc run --sensitivities`: derivatives over events, compared with closed forms in both forms of
//! the equations; refusals.

use std::process::{Command, Output};

fn pc(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pc")).args(arguments).output().expect("pc runs")
}

/// Names of the columns and the rows of a CSV table.
fn table(output: &Output) -> (Vec<String>, Vec<Vec<f64>>) {
    let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).expect("UTF-8");
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let csv = text(&output.stdout);
    let mut lines = csv.lines();
    let names = lines.next().expect("a header").split(',').map(str::to_owned).collect();
    let number = |cell: &str| cell.parse().expect("a number");
    (names, lines.map(|line| line.split(',').map(number).collect()).collect())
}

/// A ball from height h lands first at t₀ = w/g, w = √(2gh), and for the nth time at t₀ (1 + 2e + …
/// + 2eⁿ⁻¹), which it leaves with the speed eⁿ w.
struct Ball {
    g: f64,
    e: f64,
    h: f64,
}

impl Ball {
    fn impact(&self, n: i32) -> f64 {
        let first = (2.0 * self.h / self.g).sqrt();
        first * (1.0 + (1..n).map(|k| 2.0 * self.e.powi(k)).sum::<f64>())
    }

    /// The number of impacts before t, and (y, ẏ).
    fn at(&self, t: f64) -> (i32, [f64; 2]) {
        let n = (1..).take_while(|&n| self.impact(n) < t).count() as i32;
        if n == 0 {
            return (0, [self.h - self.g * t * t / 2.0, -self.g * t]);
        }
        let (s, speed) = (t - self.impact(n), self.e.powi(n) * (2.0 * self.g * self.h).sqrt());
        (n, [speed * s - self.g * s * s / 2.0, speed - self.g * s])
    }

    /// The derivatives of (y, ẏ) by g, e and h, between impacts.
    fn derivatives(&self, t: f64) -> [[f64; 2]; 3] {
        let Ball { g, e, h } = *self;
        let (n, _) = self.at(t);
        if n == 0 {
            return [[-t * t / 2.0, -t], [0.0; 2], [1.0, 0.0]];
        }
        let (w, first) = ((2.0 * g * h).sqrt(), (2.0 * h / g).sqrt());
        let (s, speed) = (t - self.impact(n), e.powi(n) * w);
        let by_e: f64 = (1..n).map(|k| 2.0 * f64::from(k) * e.powi(k - 1)).sum();
        // From the derivatives of the speed after the nth impact, of its time, and of g.
        let moved = |speed_by: f64, time_by: f64, g_by: f64| {
            let s_by = -time_by;
            [speed_by * s + speed * s_by - g * s * s_by - g_by * s * s / 2.0, speed_by - g * s_by - g_by * s]
        };
        [
            moved(speed / (2.0 * g), -self.impact(n) / (2.0 * g), 1.0),
            moved(f64::from(n) * speed / e, first * by_e, 0.0),
            moved(speed / (2.0 * h), self.impact(n) / (2.0 * h), 0.0),
        ]
    }
}

/// Several impacts, each of which amplifies the errors of the columns by up to 1/e.
#[test]
fn a_bouncing_ball() {
    let sharp = ["--rtol", "1e-12", "--atol", "1e-14", "--rows", "31", "--set", "g=9.5", "--no-verify"];
    for form in ["poincare", "canonical"] {
        let asked = ["run", "bouncing-ball", "--sensitivities", "g,e,h,m", "--form", form];
        let (names, rows) = table(&pc(&[&asked[..], &sharp[..]].concat()));
        let place = |name: &str| names.iter().position(|known| known == name).expect(name);
        let ball = Ball { g: 9.5, e: 0.8, h: 1.0 };
        let mut impacts = 0;
        for row in &rows {
            let t = row[0];
            impacts = ball.at(t).0;
            let by = ball.derivatives(t);
            for (parameter, by) in ["g", "e", "h", "m"].into_iter().zip([by[0], by[1], by[2], [0.0; 2]]) {
                for (x, by) in ["y", "y'"].into_iter().zip(by) {
                    let found = row[place(&format!("∂{x}/∂{parameter}"))];
                    let off = (found - by).abs() / by.abs().max(1.0);
                    assert!(off < 1e-7, "{form}: ∂{x}/∂{parameter} at {t} is {by}, not {found}");
                }
            }
        }
        assert!(impacts >= 5, "{impacts}");
    }
}

#[test]
fn a_name_that_is_not_a_parameter_is_refused() {
    let refused = |arguments: &[&str]| {
        let output = pc(&[&["run", "bouncing-ball"], arguments].concat());
        (output.status.code(), String::from_utf8(output.stderr).expect("UTF-8"))
    };
    let (code, message) = refused(&["--sensitivities", "k"]);
    assert_eq!(code, Some(2));
    assert_eq!(
        message,
        "pc: --sensitivities: `k` is not a parameter of this model; its parameters are m, g, e, h\n"
    );
}

/// With checkpoints the columns are those without, within the tolerance, and a checkpoint has those of the rows before it.
#[test]
fn derivatives_are_kept_in_checkpoints() {
    let directory = tempfile::tempdir().expect("a directory");
    let place = |name: &str| directory.path().join(name).display().to_string();
    for method in ["adams", "dop853", "taylor"] {
        let kept = place(method);
        let all = ["run", "bouncing-ball", "--sensitivities", "g,e", "--rows", "9", "--method", method];
        let run = |more: &[&str]| pc(&[&all[..], more].concat());
        let (names, plain) = table(&run(&[]));
        let whole = run(&["--checkpoint", &kept, "--every", "20"]);
        let (same, rows) = table(&whole);
        assert_eq!(names, same);
        for (row, plain) in rows.iter().flatten().zip(plain.iter().flatten()) {
            // Adams begins at order 1 after each bounce and each checkpoint.
            assert!((row - plain).abs() <= 1e-6 * plain.abs().max(1.0), "{method}: {row}, not {plain}");
        }
        assert_eq!(run(&["--resume", &kept]).stdout, whole.stdout, "{method}");
        let other = pc(&[&all[..2], &["--rows", "9", "--method", method, "--resume", &kept]].concat());
        let said = String::from_utf8(other.stderr).expect("UTF-8");
        assert!(other.status.code() == Some(2) && said.contains("--sensitivities g,e"), "{method}: {said}");
    }
}

/// The derivative by a parameter that others are expressions in would have to include these, which
/// columns do not.
#[test]
fn a_parameter_that_others_follow_is_refused() {
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("m.toml");
    let text = "[parameters]\na = 1.0\nb = \"2*a\"\n[coordinates]\nx = 1.0\n[lagrangian]\n\
                kinetic = \"x'^2/2\"\npotential = \"b*x^2/2\"\n[simulation]\nt_end = 1.0\n";
    std::fs::write(&path, text).expect("a file");
    let path = path.display().to_string();
    let output = pc(&["run", &path, "--sensitivities", "a"]);
    assert_eq!(output.status.code(), Some(4));
    let message = String::from_utf8(output.stderr).expect("UTF-8");
    assert!(message.contains("no sensitivities by `a`: other parameters are expressions in it"), "{message}");
    // ∂x/∂b of x = cos(√b t)
    let (names, rows) = table(&pc(&["run", &path, "--sensitivities", "b"]));
    assert_eq!(names.last().map(String::as_str), Some("∂x'/∂b"));
    let (root, last) = (2.0_f64.sqrt(), rows.last().expect("a row"));
    let expected = -root.sin() / (2.0 * root);
    assert!((last[names.len() - 2] - expected).abs() < 1e-8, "{last:?}"); // rtol 1e-9
}
