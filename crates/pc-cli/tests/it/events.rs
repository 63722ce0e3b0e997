//! `pc run` with events: times compared with closed forms, in both forms of the equations, and
//! reports of events.

use std::f64::consts::TAU;
use std::io::Read;
use std::process::Output;

use serde_json::Value;

use crate::piped::pc;

fn said(output: &Output) -> String {
    let text = String::from_utf8(output.stderr.clone()).expect("UTF-8");
    assert!(!text.contains("panicked"), "{text}");
    text
}

/// The contents of `-o FILE.json` after a run that succeeds.
fn kept(model: &str, name: &str, arguments: &[&str]) -> Value {
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("run.json").display().to_string();
    let output = pc(model, &[&["run", name, "-o", &path], arguments].concat());
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    serde_json::from_slice(&std::fs::read(path).expect("a file")).expect("JSON")
}

fn times(run: &Value, event: &str) -> Vec<f64> {
    let events = run["events"].as_array().expect("a list").iter();
    events.filter(|e| e["name"] == event).map(|e| e["time"].as_f64().expect("a number")).collect()
}

/// Runs in both forms and by all methods (Taylor's in quasi-velocities only), with an error over
/// the run below 1e-10.
fn sharply(name: &str, check: impl Fn(&Value)) {
    let run = |form: &str, method: &str| {
        let sharp = ["--rtol", "1e-13", "--atol", "1e-15", "--form", form, "--method", method];
        check(&kept("", name, &sharp));
    };
    run("poincare", "taylor");
    for form in ["poincare", "canonical"] {
        for method in ["adams", "bdf", "dop853", "auto"] {
            run(form, method);
        }
    }
}

#[track_caller]
fn assert_close(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len(), "{found:?} {expected:?}");
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-10, "{found} is not {expected}");
    }
}

/// The first bounce is at t₀ = √(2h/g); then flights take 2 t₀ eⁿ.
#[test]
fn the_ball_bounces() {
    sharply("bouncing-ball", |run| {
        let (mut t, mut flight) = ((2.0_f64 / 9.81).sqrt(), 2.0 * (2.0_f64 / 9.81).sqrt());
        let mut expected = Vec::new();
        while t < 3.0 {
            expected.push(t);
            flight *= 0.8;
            t += flight;
        }
        assert_close(&times(run, "bounce"), &expected);
        assert_eq!(run["summary"]["keeps_energy"], false);
    });
}

/// sin 1000 t passes through zero 3183 times in ten units of time, much faster than the state
/// changes.
#[test]
fn events_faster_than_the_motion_are_found() {
    let model = |simulation: &str| {
        format!(
            "[coordinates]\nx = 1.0\n[lagrangian]\nkinetic = \"x'^2/2\"\npotential = \"x^2/2\"\n\
             [events.beat]\nwhen = \"sin(1000*t)\"\n[simulation]\nt_end = 10.0\nsamples = 2\n{simulation}"
        )
    };
    let expected: Vec<f64> = (1..=3183).map(|n| f64::from(n) * TAU / 2000.0).collect();
    for run in [
        kept(&model("max_step = 1e-3\n"), "-", &[]),
        kept(&model(""), "-", &["--max-step", "1e-3"]),
        kept(&model("max_step = 5.0\n"), "-", &["--max-step", "1e-3"]),
    ] {
        assert_close(&times(&run, "beat"), &expected);
        assert_eq!(run["summary"]["max_step"], 1e-3);
    }
    // The roots are separated in steps of any length.
    for method in ["adams", "bdf", "dop853", "taylor", "auto"] {
        let free = kept(&model(""), "-", &["--method", method]);
        assert_close(&times(&free, "beat"), &expected);
        assert_eq!(free["summary"]["max_step"], Value::Null);
    }
    let refused = pc(&model(""), &["run", "-", "--max-step", "0"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(said(&refused).contains("it must be positive"));
}

/// A slip takes (2π − 2 arctan q)/ω, q = 1, ω = 1; a stop 2 (F_s − F_k)/(k V) = 2.
#[test]
fn the_block_sticks_and_slips() {
    sharply("stick-slip-block", |run| {
        let slip = TAU * 0.75;
        let period = slip + 2.0;
        assert_close(&times(run, "stick"), &[slip, slip + period, slip + 2.0 * period]);
        assert_close(&times(run, "slip"), &[period, 2.0 * period]);
        // The block sticks where the spring pulls with 2 F_k − F_s = 0, exactly at rest.
        let last = run["rows"].as_array().and_then(|rows| rows.last()).expect("rows");
        assert_eq!((last[2].as_f64(), last[3].as_f64()), (Some(0.0), Some(0.0)));
        assert!((last[1].as_f64().expect("x") - (slip + 2.0 * period) / 2.0).abs() < 1e-10);
    });
}

/// The block is upright arcosh 1/(1 − φ_n/α) after rest at φ_n; 1 − (1 − φ_(n+1)/α)² = r² (1 − (1 −
/// φ_n/α)²).
#[test]
fn the_block_rocks() {
    sharply("rocking-block", |run| {
        let mut rest = 0.5_f64; // 1 − φ₀/α
        let mut t = (1.0 / rest).acosh();
        let mut expected = Vec::new();
        while t < 6.0 {
            expected.push(t);
            rest = (1.0 - 0.81 * (1.0 - rest * rest)).sqrt();
            t += 2.0 * (1.0 / rest).acosh();
        }
        assert!(expected.len() >= 3);
        assert_close(&times(run, "impact"), &expected);
    });
}

/// The bead of a pendulum of length 1, held by a multiplier, hits a wall below its point of
/// suspension.
const BEAD: &str = r#"
[parameters]
w = 0.0
[coordinates]
x = 1.0
y = 0.0
[constraints]
circle = "(x^2 + y^2 - 1)/2"
[lagrangian]
kinetic = "(x'^2 + y'^2)/2"
potential = "y"
[events.wall]
when = "x - w"
direction = "falling"
reset = { "x'" = "-x'", "y'" = "3" }
[simulation]
t_end = 12.0
"#;

/// The velocity after the reset is projected onto the constraint by the shortest way, which makes
/// y' vanish.
#[test]
fn resets_under_constraints_end_on_them() {
    let sharp = ["--rtol", "1e-11", "--atol", "1e-13"];
    let run = kept(BEAD, "-", &sharp);
    let quarter = 1.854_074_677_301_371_9; // K(1/2), from the horizontal to the vertical
    let found = times(&run, "wall");
    for (n, t) in found.iter().enumerate() {
        let expected = quarter * (2 * n + 1) as f64;
        assert!((t - expected).abs() < 1e-8, "{t} is not {expected}"); // 1000 rtol
    }
    assert_eq!(found.len(), 3);
    assert!(run["summary"]["constraints"]["circle"].as_f64().expect("a number") < 1e-12);

    // Momenta of y' alone fail at x = 0, so the wall comes before it.
    let aside = |form| {
        let run =
            kept(BEAD, "-", &[&sharp[..], &["--set", "w=0.5", "--t-end", "4", "--form", form]].concat());
        times(&run, "wall")
    };
    let (poincare, canonical) = (aside("poincare"), aside("canonical"));
    assert!(poincare.len() > 1 && poincare.len() == canonical.len(), "{poincare:?} {canonical:?}");
    for (a, b) in poincare.iter().zip(&canonical) {
        assert!((a - b).abs() < 1e-8, "{a} is not {b}"); // 1000 rtol
    }
    let off = BEAD.replace("\"y'\" = \"3\"", "x = \"x + 0.25\"");
    let output = pc(&off, &["run", "-"]);
    assert_eq!(output.status.code(), Some(5));
    let text = said(&output);
    assert!(text.contains("the event wall cannot reset the state at t = 1.85407"), "{text}");
    assert!(text.contains("its reset leaves the constraints: x would have to be "), "{text}");
}

const FALL: &str = r#"
[coordinates]
y = 1.0
[lagrangian]
kinetic = "y'^2/2"
potential = "y"
[events.half]
when = "y - 1/2"
[events.floor]
when = "y"
terminal = true
[events.never]
when = "y + 1"
[simulation]
t_end = 3.0
samples = 4
"#;

#[test]
fn a_terminal_event_ends_the_run_well() {
    let output = pc(FALL, &["run", "-"]);
    assert_eq!(output.status.code(), Some(0));
    let table = String::from_utf8(output.stdout.clone()).expect("UTF-8");
    let rows: Vec<Vec<f64>> = table
        .lines()
        .skip(1)
        .map(|row| row.split(',').map(|cell| cell.parse().expect("a number")).collect())
        .collect();
    assert_eq!((rows[0][0], rows[1][0]), (0.0, 1.0));
    assert!(
        rows.len() == 3 && (rows[2][0] - 2.0_f64.sqrt()).abs() < 1e-9 && rows[2][1].abs() < 1e-9,
        "{rows:?}"
    );
    let text = said(&output);
    for line in [
        "  time     0 to 3, ended by the event floor at 1.41421356",
        "  events   half   once: 1\n           floor  once: 1.41421356",
        "\n           never  does not occur\n",
        "  end      t = 1.41421356",
    ] {
        assert!(text.contains(line), "{line} is not in\n{text}");
    }
    let run = kept(FALL, "-", &[]);
    assert_eq!(run["summary"]["ending"], "event");
    assert!((run["summary"]["t_reached"].as_f64().expect("a number") - 2.0_f64.sqrt()).abs() < 1e-9);
    assert_eq!(
        (times(&run, "half").len(), times(&run, "floor").len(), times(&run, "never").len()),
        (1, 1, 0)
    );
}

/// Two points at height 0: one falls at once, below the floor, the other is thrown up and lands.
#[test]
fn a_function_that_is_zero_at_the_start_and_goes_beyond_is_said() {
    let thrown = |speed: f64| {
        let model = format!(
            "[coordinates]\ny = 0.0\n[quasi_velocities]\n\"y'\" = {speed}\n[lagrangian]\nkinetic = \"y'^2/2\"\n\
             potential = \"2*y\"\n[events.floor]\nwhen = \"y\"\ndirection = \"falling\"\n[simulation]\nt_end = 1.5\n"
        );
        let output = pc(&model, &["run", "-"]);
        assert_eq!(output.status.code(), Some(0));
        said(&output)
    };
    let remark = "zero at the start and beyond it from there on";
    let falls = thrown(0.0);
    assert!(falls.contains("does not occur   (") && falls.contains(remark), "{falls}");
    let lands = thrown(1.0);
    assert!(lands.contains("floor  once: 1\n") && !lands.contains(remark), "{lands}");
}

/// √(1 − x) − 0.2 is zero at x = 0.96, and has no value beyond 1.
#[test]
fn a_terminal_zero_before_an_edge_ends_the_run() {
    let model = "[coordinates]\nx = 0.0\n[quasi_velocities]\n\"x'\" = 1.0\n[lagrangian]\nkinetic = \"x'^2/2\"\n\
                 [events.edge]\nwhen = \"sqrt(1 - x) - 0.2\"\nterminal = true\n[simulation]\nt_end = 2.0\n";
    for method in ["adams", "bdf", "dop853", "taylor", "auto"] {
        let output = pc(model, &["run", "-", "--method", method]);
        assert_eq!(output.status.code(), Some(0), "{method}: {}", said(&output));
        assert!(said(&output).contains("ended by the event edge at 0.96,"), "{method}: {}", said(&output));
    }
}

#[test]
fn bounces_that_accumulate_end_a_run_with_their_limit() {
    let output = pc("", &["run", "bouncing-ball", "--t-end", "9", "--rows", "10", "--set", "e=0.5"]);
    assert_eq!(output.status.code(), Some(5));
    assert_eq!(
        String::from_utf8_lossy(&output.stdout).lines().count(),
        1 + 2,
        "rows before the limit at 1.354…"
    );
    let text = said(&output);
    assert!(
        text.contains("because: the event bounce occurs at ever shorter intervals near t = 1.35457"),
        "{text}"
    );
}

#[test]
fn an_archive_keeps_the_times_of_each_event() {
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().join("a.npz");
    let output = pc("", &["run", "stick-slip-block", "-o", path.to_str().expect("UTF-8")]);
    assert_eq!(output.status.code(), Some(0));
    let mut archive = zip::ZipArchive::new(std::fs::File::open(path).expect("a file")).expect("an archive");
    for (name, expected) in [("events/slip.npy", 2), ("events/stick.npy", 3), ("x.npy", 201)] {
        let mut bytes = Vec::new();
        archive.by_name(name).expect(name).read_to_end(&mut bytes).expect("an array");
        let values: Vec<f64> = npyz::NpyFile::new(&bytes[..]).expect("npy").into_vec().expect("f64");
        assert_eq!(values.len(), expected);
    }
}

#[test]
fn emitted_source_says_that_it_has_no_events() {
    let directory = tempfile::tempdir().expect("a directory");
    let path = directory.path().display().to_string();
    let output = pc("", &["emit", "bouncing-ball", "--lang", "c", "-o", &path]);
    assert_eq!(output.status.code(), Some(0));
    let note = "The events of the model are not part of this source";
    assert!(said(&output).contains(note));
    let files = std::fs::read_dir(directory.path()).expect("a directory");
    let texts = files.map(|file| std::fs::read_to_string(file.expect("a file").path()).expect("text"));
    assert!(texts.into_iter().any(|text| text.contains(note)));
}

/// The example of the book: the third bounce, at √(2/g) (1 + 2·0.8 + 2·0.64), raises the count
/// beyond 2.5 and so ends the run.
#[test]
fn a_reset_sets_off_another_event() {
    let model = "[parameters]\nrestitution = 0.8\n[coordinates]\ny = 1.0\nbounces = 0\n[lagrangian]\n\
                 kinetic = \"(y'^2 + bounces'^2)/2\"\npotential = \"9.81*y\"\n[events.bounce]\nwhen = \"y\"\n\
                 direction = \"falling\"\nreset = { \"y'\" = \"-restitution*y'\", bounces = \"bounces + 1\" }\n\
                 [events.enough]\nwhen = \"bounces - 2.5\"\nterminal = true\n[simulation]\nt_end = 3.0\n\
                 rtol = 1e-13\natol = 1e-15\n";
    let first = (2.0_f64 / 9.81).sqrt();
    let third = first * (1.0 + 1.6 + 1.28);
    for method in ["adams", "bdf", "dop853", "taylor", "auto"] {
        let run = kept(model, "-", &["--method", method]);
        assert_close(&times(&run, "bounce"), &[first, first * 2.6, third]);
        assert_close(&times(&run, "enough"), &[third]);
    }
}

/// A jump through zero is one passage, and leaves the zero after it; a pole of the tangent is none.
#[test]
fn jumps_and_poles_of_event_functions() {
    let model = "[coordinates]\nx = 0\n[quasi_velocities]\n\"x'\" = 1\n[lagrangian]\nkinetic = \"x'^2/2\"\n\
                 [events.jump]\nwhen = \"step(x - 0.3, -1, 1)*(x - 1.5)\"\n[events.square]\n\
                 when = \"sign(sin(10*x + 0.5))\"\n[events.tangent]\nwhen = \"tan(3*x)\"\n\
                 [simulation]\nt_end = 2\n";
    for method in ["adams", "bdf", "dop853", "taylor", "auto"] {
        let run = kept(model, "-", &["--method", method]);
        assert_close(&times(&run, "jump"), &[0.3, 1.5]);
        let square: Vec<f64> = (1..=6).map(|k| (f64::from(k) * TAU / 2.0 - 0.5) / 10.0).collect();
        assert_close(&times(&run, "square"), &square);
        assert_close(&times(&run, "tangent"), &[TAU / 6.0]);
    }
}
