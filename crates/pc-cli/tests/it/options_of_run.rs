//! `--set` of start values, `--keep`, `--samples-per-step` and `--accumulation` of `pc run`.

use std::process::Output;

use crate::piped;

fn pc(model: &str, arguments: &[&str]) -> Output {
    piped::pc(model, &[&["run", "-"], arguments].concat())
}

fn said(output: &Output, code: i32) -> String {
    let text = String::from_utf8(output.stderr.clone()).expect("UTF-8");
    assert_eq!(output.status.code(), Some(code), "{text}");
    text
}

/// The first row of a table, without the time.
fn start(output: &Output) -> Vec<f64> {
    said(output, 0);
    let text = String::from_utf8(output.stdout.clone()).expect("UTF-8");
    let row = text.lines().nth(1).expect("a row");
    row.split(',').skip(1).map(|number| number.parse().expect("a number")).collect()
}

const CIRCLE: &str = r#"
[coordinates]
x = 0.6
y = 1.0
[constraints]
circle = "x^2 + y^2 - 1"
[lagrangian]
kinetic = "(x'^2 + y'^2)/2"
[simulation]
t_end = 0.1
samples = 2
"#;

/// A mass on a spring with a first-order state; `--set` treats all starts alike.
const SPRING: &str = r#"
[parameters]
k = 4.0
[coordinates]
x = 1.0
[quasi_velocities]
"x'" = 0.5
[states]
z = { start = "k", rate = "-z" }
[lagrangian]
kinetic = "x'^2/2"
potential = "k*x^2/2"
[simulation]
t_end = 0.1
samples = 2
"#;

#[test]
fn set_gives_parameters_and_starts_other_values() {
    let set = |settings: &[&str]| {
        let arguments: Vec<&str> = settings.iter().flat_map(|setting| ["--set", setting]).collect();
        start(&pc(SPRING, &arguments))[..3].to_vec()
    };
    assert_eq!(set(&[]), [1.0, 0.5, 4.0]);
    assert_eq!(set(&["k=9"]), [1.0, 0.5, 9.0]);
    // A start that is set no longer depends on parameters.
    assert_eq!(set(&["x=3", "x'=-2", "z=7", "k=9"]), [3.0, -2.0, 7.0]);
    // The motion of the text with these numbers is the same, to the last digit.
    let written = SPRING.replace("x = 1.0", "x = 3.0").replace("= 0.5", "= -2.0");
    let (asked, written) = (pc(SPRING, &["--set", "x=3", "--set", "x'=-2"]), pc(&written, &[]));
    assert!(asked.status.success() && asked.stdout == written.stdout);
    let text = said(&pc(SPRING, &["--set", "v=1"]), 2);
    assert_eq!(
        text,
        "pc: --set: `v` is neither a parameter nor a start value of this model; its parameters are k, its start values x, x', z\n"
    );
    assert!(said(&pc(SPRING, &["--set", "x=1,5"]), 2).contains("`1,5` is not a finite number"));
    assert!(said(&pc(SPRING, &["--set", "x=1", "--set", "x=1"]), 2).contains("`x` is given two values"));
}

#[test]
fn a_moved_start_keeps_the_named_components() {
    // Newton's method ends at roundings of numbers near 1.
    let near = |a: f64, b: f64| (a - b).abs() < 1e-14;
    let kept = start(&pc(CIRCLE, &["--project-start", "--keep", "x"]));
    assert!(kept[0] == 0.6 && near(kept[1], 0.8), "{kept:?}");
    let other = CIRCLE.replace("y = 1.0", "y = 0.28");
    let kept = start(&pc(&other, &["--project-start", "--keep", "y"]));
    assert!(near(kept[0], 0.96) && kept[1] == 0.28, "{kept:?}");
    let moved = start(&pc(CIRCLE, &["--project-start"]));
    assert!(moved[0] < 0.58 && near(moved[0].hypot(moved[1]), 1.0), "{moved:?}");
}

#[test]
fn unknown_names_are_refused() {
    let unknown = said(&pc(CIRCLE, &["--project-start", "--keep", "x,z"]), 2);
    assert!(unknown.contains("`z`") && unknown.contains("x, y"), "{unknown}");
    let alone = said(&pc(CIRCLE, &["--keep", "x"]), 2);
    assert!(alone.contains("--project-start"), "{alone}");
}

/// How often an event occurred, from `NAME  N times` of the summary.
fn times(summary: &str, event: &str) -> usize {
    let (_, rest) = summary.split_once(&format!("{event}  ")).expect("the event");
    rest.split(' ').next().expect("a number").parse().expect("a number")
}

/// sin 8x vanishes at x = t = kπ/8, 50 times up to 20, while steps of a free body are long. Roots
/// are separated if the state is (x, x'), and sampled if it has momenta.
#[test]
fn zeros_within_a_step_are_found_where_it_is_sampled_densely() {
    let model = "[coordinates]\nx = 0.0\n[quasi_velocities]\n\"x'\" = 1.0\n[lagrangian]\nkinetic = \"x'^2/2\"\n\
                 [events.cross]\nwhen = \"sin(8*x)\"\n[simulation]\nt_end = 20.0\nsamples = 2\n";
    let found = |parts: &str, form: &str| {
        let output = pc(model, &["--samples-per-step", parts, "--form", form]);
        times(&said(&output, 0), "cross")
    };
    assert_eq!((found("1", "poincare"), found("300", "canonical")), (50, 50));
    assert!(found("1", "canonical") < 50);
    let none = said(&pc(model, &["--samples-per-step", "0"]), 2);
    assert!(none.contains("--samples-per-step"), "{none}");
}

/// Flight n of a ball lasts eⁿ times the first, e = 0.5: the time left falls below the fraction p
/// after about log p/log e bounces.
#[test]
fn bounces_are_followed_to_the_requested_fraction() {
    let model = "[coordinates]\ny = 1.0\n[lagrangian]\nkinetic = \"y'^2/2\"\npotential = \"9.81*y\"\n[events.bounce]\nwhen = \"y\"\n\
                 direction = \"falling\"\nreset = { \"y'\" = \"-0.5*y'\" }\n[simulation]\nt_end = 3.0\nsamples = 4\n";
    let followed = |part: &str| {
        let output = pc(model, &["--accumulation", part]);
        let text = String::from_utf8(output.stderr).expect("UTF-8");
        assert!(output.status.code() != Some(0), "{text}");
        times(&text, "bounce") as f64
    };
    let (coarse, fine) = (followed("1e-2"), followed("1e-6"));
    // A fraction smaller by 1e4 takes log 1e4/log 2 = 13.3 more bounces.
    assert!((fine - coarse - 13.3).abs() < 1.5, "{coarse} and {fine}");
    let negative = said(&pc(model, &["--accumulation=-1"]), 2);
    assert!(negative.contains("--accumulation"), "{negative}");
}
