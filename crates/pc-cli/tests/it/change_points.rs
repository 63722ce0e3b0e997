//! Motions through places where constraints lose rank, and integrals that are lost.

use std::io::Write;
use std::process::{Command, Stdio};

/// The exit code, the table and standard error.
fn run(model: &str, options: &[&str]) -> (Option<i32>, String, String) {
    let mut child = Command::new(env!("CARGO_BIN_EXE_pc"))
        .args(["run", "-"])
        .args(options)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("pc starts");
    let _ = child.stdin.take().expect("a pipe").write_all(model.as_bytes());
    let output = child.wait_with_output().expect("pc ends");
    let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
    (output.status.code(), text(output.stdout), text(output.stderr))
}

/// Columns of the rows of a table, by name.
fn rows<const N: usize>(table: &str, names: [&str; N]) -> Vec<[f64; N]> {
    let mut lines = table.lines();
    let header: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    let place = |name: &str| header.iter().position(|known| *known == name).expect("a column");
    let places = names.map(place);
    let row = |line: &str| {
        let values: Vec<f64> = line.split(',').map(|value| value.parse().expect("a number")).collect();
        places.map(|place| values[place])
    };
    lines.map(row).collect()
}

/// What was said of the failure.
fn failure(said: &str) -> String {
    said.lines().skip_while(|line| !line.starts_with("pc:")).collect::<Vec<_>>().join("\n")
}

/// A particle of mass 1 in the plane, held where `constraint` vanishes, in x, y and their velocities u, v.
fn particle(constraint: &str, (x, y): (f64, f64), (u, v): (f64, f64), more: &str) -> String {
    format!(
        "[coordinates]\nx = {x}\ny = {y}\n[quasi_velocities]\nu = {u}\nv = {v}\n\
         [kinematics]\nx = \"u\"\ny = \"v\"\n\
         [lagrangian]\nkinetic = \"(u^2 + v^2)/2\"\n{more}\n[constraints]\nline = \"{constraint}\"\n"
    )
}

/// Crank and rocker of length 0.5, coupler and ground of length 1, in the crossed position under gravity.
const FOUR_BAR: &str = r#"
[coordinates]
crank = 1.2
coupler = -2.234830412233197
rocker = -2.234830412233197
[quasi_velocities]
"crank'" = 2.0
[gravity]
acceleration = [0.0, 0.0, -9.81]
[bodies.crank]
joint = { kind = "revolute", axis = [0.0, 1.0, 0.0] }
mass = 1.0
center = [0.25, 0.0, 0.0]
inertia = [0.001, 0.020833333333333332, 0.020833333333333332]
[bodies.coupler]
parent = "crank"
joint = { kind = "revolute", axis = [0.0, 1.0, 0.0], at = [0.5, 0.0, 0.0] }
mass = 2.0
center = [0.5, 0.0, 0.0]
inertia = [0.001, 0.16666666666666666, 0.16666666666666666]
[bodies.rocker]
joint = { kind = "revolute", axis = [0.0, 1.0, 0.0], at = [1.0, 0.0, 0.0] }
mass = 1.5
center = [0.25, 0.0, 0.0]
inertia = [0.001, 0.03125, 0.03125]
[loops.pin]
kind = "revolute"
bodies = ["coupler", "rocker"]
at = [[1.0, 0.0, 0.0], [0.5, 0.0, 0.0]]
axis = [[0.0, 1.0, 0.0], [0.0, 1.0, 0.0]]
"#;

/// The crossed four-bar keeps its energy through its change points, and coupler and rocker stay equal: it does not go
/// over to the parallelogram.
#[test]
fn a_four_bar_of_equal_cranks_passes_its_change_points() {
    for method in ["auto", "dop853", "adams", "bdf"] {
        let options = ["--t-end", "10", "--rtol", "1e-10", "--atol", "1e-12", "--method", method];
        let (code, table, said) = run(FOUR_BAR, &options);
        assert_eq!(code, Some(0), "{said}");
        let rows = rows(&table, ["crank", "coupler", "rocker", "energy"]);
        // It swings through crank = π and back.
        assert!(rows.iter().any(|[crank, ..]| *crank > 3.2) && rows.iter().any(|[crank, ..]| *crank < 2.9));
        for [_, coupler, rocker, energy] in rows {
            // Some thousand steps of the tolerance; the difference of the angles is that of a projection near the place.
            assert!((energy - 1.0884052974582352).abs() < 1e-6, "{method}: {energy}");
            assert!((coupler - rocker).abs() < 1e-6, "{method}: {coupler} {rocker}");
        }
    }
}

/// A parallelogram in Cartesian coordinates turns with the constant speed 2, four times through its change points, whatever
/// place of one is computed: rank is lost there to the last bit.
#[test]
fn a_parallelogram_turns_through_its_change_points() {
    let model = "[coordinates]\nx1 = 0.0\ny1 = 1.0\nx2 = 2.0\ny2 = 1.0\n\
                 [quasi_velocities]\n\"x1'\" = 2.0\n\"y1'\" = 0.0\n\"x2'\" = 2.0\n\"y2'\" = 0.0\n\
                 [lagrangian]\nkinetic = \"(x1'^2 + y1'^2 + x2'^2 + y2'^2)/2\"\n\
                 [constraints]\na = \"x1^2 + y1^2 - 1\"\nb = \"(x2 - 2)^2 + y2^2 - 1\"\n\
                 c = \"(x2 - x1)^2 + (y2 - y1)^2 - 4\"\n";
    for method in ["auto", "dop853", "adams", "bdf"] {
        let (code, table, said) = run(model, &["--t-end", "7.5", "--method", method, "--rtol", "1e-10"]);
        assert_eq!(code, Some(0), "{method}: {said}");
        for [t, x1, y1, x2] in rows(&table, ["t", "x1", "y1", "x2"]) {
            let [x, y] = [(2.0 * t).sin(), (2.0 * t).cos()];
            let error = (x1 - x).abs().max((y1 - y).abs()).max((x2 - 2.0 - x).abs());
            assert!(error < 1e-5, "{method} at {t}: {error:e}");
        }
    }
}

/// On y (y − x) = 0 the velocity chooses the line: along y = 0 under the force −x the motion is x = −cos t, y = 0.
#[test]
fn the_velocity_chooses_the_branch() {
    let model = particle("y*(y - x)", (-1.0, 0.0), (0.0, 0.0), "potential = \"x^2/2\"");
    for method in ["auto", "adams", "bdf"] {
        let options = ["--t-end", "20", "--rows", "57", "--method", method];
        let (code, table, said) = run(&model, &options);
        assert_eq!(code, Some(0), "{said}");
        for [t, x, y] in rows(&table, ["t", "x", "y"]) {
            assert!((x + t.cos()).abs() < 1e-6 && y.abs() < 1e-9, "{method}: {t} {x} {y}");
        }
    }
}

/// Backwards, and with an event at the place itself.
#[test]
fn the_place_may_be_an_event() {
    let place = "[events]\nplace = { when = \"x\" }";
    let model =
        format!("{}\n{place}\n", particle("y*(y - x)", (-1.0, 0.0), (0.0, 0.0), "potential = \"x^2/2\""));
    for end in ["6", "-6"] {
        let (code, table, said) = run(&model, &["--t-end", end, "--rows", "7"]);
        assert_eq!(code, Some(0), "{said}");
        assert!(said.contains("place  2 times: "), "{said}");
        for [t, x] in rows(&table, ["t", "x"]) {
            assert!((x + t.cos()).abs() < 1e-6, "{t} {x}");
        }
    }
}

/// x y = 10⁻⁸ has no such place: the particle turns round the corner at its constant speed and leaves along the other
/// asymptote.
#[test]
fn a_sharp_corner_is_no_change_point() {
    let (x, y) = (-1.0, -1e-8);
    // The velocity along the hyperbola, of size 1 up to 1e-16.
    let model = particle("x*y - 1e-8", (x, y), (1.0, -1e-8), "");
    for method in ["auto", "adams"] {
        let (code, table, said) = run(&model, &["--t-end", "2", "--rows", "5", "--method", method]);
        assert_eq!(code, Some(0), "{said}");
        let end = rows(&table, ["x", "y"]).pop().expect("a row");
        // The corner is shorter than the asymptotes by some 1e-4.
        assert!(end[0].abs() < 1e-7 && (end[1] + 1.0).abs() < 1e-3, "{method}: {end:?}");
    }
}

/// Derivatives do not go across on a bridge: the change point is an error at once, wherever steps have come to.
#[test]
fn a_change_point_cannot_be_differentiated() {
    let model = format!("[parameters]\ng = 9.81\n{}", FOUR_BAR.replace("-9.81", "\"-g\""));
    let options = ["--t-end", "3", "--rows", "4", "--sensitivities", "g", "--method", "dop853"];
    let (code, table, said) = run(&model, &options);
    assert_eq!((code, table.lines().count()), (Some(5), 2), "{said}");
    insta::assert_snapshot!(without_numbers(&failure(&said)));
}

/// A text without its decimal numbers.
fn without_numbers(text: &str) -> String {
    let words = text.split_inclusive([' ', ',', '\n']);
    let word = |word: &str| {
        let number = word.trim_end_matches([' ', ',', '\n']);
        if number.parse::<f64>().is_ok() { word.replace(number, "[..]") } else { word.to_owned() }
    };
    words.map(word).collect()
}

/// In a thousand periods at a tolerance of 1e-4 BDF changes the energy of an oscillator: the table is whole, and the exit code that of a failure.
#[test]
fn a_proved_integral_that_drifts_is_an_error() {
    let model = "[coordinates]\nx = 1.0\n[quasi_velocities]\nu = 0.0\n[kinematics]\nx = \"u\"\n\
                 [lagrangian]\nkinetic = \"u^2/2\"\npotential = \"x^4/4 + 1000\"\n";
    let options = ["--t-end", "5000", "--rows", "11", "--rtol", "1e-4", "--atol", "1e-4", "--method", "bdf"];
    let (code, table, said) = run(model, &options);
    assert_eq!((code, table.lines().count()), (Some(5), 12), "{said}");
    insta::assert_snapshot!(failure(&said));
    // The same to 1e-9.
    assert_eq!(run(model, &["--t-end", "50"]).0, Some(0));
}

/// Of a motion that has come to rest within its absolute tolerance, e^{2γt} makes an integral of any size.
#[test]
fn a_drift_that_tolerances_explain_is_no_loss() {
    let model = "[parameters]\ng = 0.1\n[coordinates]\nx = 1.0\n[quasi_velocities]\n\"x'\" = 0.0\n\
                 [lagrangian]\nkinetic = \"exp(2*g*t)*x'^2/2\"\npotential = \"exp(2*g*t)*x^2/2\"\n\
                 [integrals]\nk = \"exp(2*g*t)*(x'^2 + x^2 + 2*g*x*x')/2\"\n";
    for options in [["--t-end", "400", "--rtol", "1e-9"], ["--t-end", "40", "--rtol", "1e-3"]] {
        let (code, _, said) = run(model, &options);
        assert_eq!(code, Some(0), "{options:?}: {said}");
    }
}

/// A constant of 10¹² in the energy rounds it by 1e-4; that is no loss of the energy of 1e-2.
#[test]
fn rounding_of_a_large_constant_is_no_loss() {
    let model = "[coordinates]\nx = 0.1\n[quasi_velocities]\nu = 0.0\n[kinematics]\nx = \"u\"\n\
                 [lagrangian]\nkinetic = \"u^2/2\"\npotential = \"x^2/2 + 1e12\"\n";
    let (code, _, said) = run(model, &["--t-end", "50"]);
    assert_eq!(code, Some(0), "{said}");
}

/// Near an equilibrium the energy, 1 − cos φ and less, is rounding; rows at each period of an oscillation are all at rest.
#[test]
fn small_motions_and_rows_in_step_with_a_motion_are_no_loss() {
    let pendulum = |start: &str| {
        format!(
            "[coordinates]\nphi = {start}\n[quasi_velocities]\nu = 0.0\n[kinematics]\nphi = \"u\"\n\
             [lagrangian]\nkinetic = \"u^2/2\"\npotential = \"1 - cos(phi)\"\n"
        )
    };
    for start in ["0.0", "1e-12", "1e-8", "1e-4", "3.141592653589793"] {
        let (code, _, said) = run(&pendulum(start), &["--t-end", "50"]);
        assert_eq!(code, Some(0), "{start}: {said}");
    }
    let spring = "[coordinates]\nx = 1.0\n[quasi_velocities]\nu = 0.0\n[kinematics]\nx = \"u\"\n\
                  [lagrangian]\nkinetic = \"u^2/2\"\npotential = \"2*pi^2*x^2\"\n";
    let (code, _, said) = run(spring, &["--t-end", "50", "--rows", "51"]);
    assert_eq!(code, Some(0), "{said}");
}

/// An integral whose value is 0 has a scale all the same, and only what is proved counts.
#[test]
fn integrals_of_the_text_are_judged_by_their_terms() {
    let model = |integral: &str| {
        format!(
            "[coordinates]\nx = 1.0\ny = 1.0\n[quasi_velocities]\nu = 0.7\nv = 0.7\n\
             [kinematics]\nx = \"u\"\ny = \"v\"\n[lagrangian]\nkinetic = \"(u^2 + v^2)/2\"\n\
             potential = \"(x^2 + y^2)/2 + (x^2 + y^2)^2\"\n[integrals]\narea = \"{integral}\"\n"
        )
    };
    let fine = ["--t-end", "10"];
    let (code, _, said) = run(&model("x*v - y*u"), &fine);
    assert_eq!(code, Some(0), "{said}");
    // No integral: its drift is none of an error.
    let (code, _, said) = run(&model("x*v"), &fine);
    assert_eq!(code, Some(0), "{said}");
}

/// The mass of v vanishes at x = 1, where v becomes infinite in finite time: v² (1 − x) = 1, at t = 2/3.
#[test]
fn a_velocity_that_loses_its_inertia_is_named() {
    let model = "[coordinates]\nx = 0.0\ny = 0.0\n[quasi_velocities]\nv = 1.0\nw = 1.0\n\
                 [kinematics]\nx = \"v\"\ny = \"w\"\n\
                 [lagrangian]\nkinetic = \"(1 - x)*v^2/2 + w^2/2\"\n";
    for method in ["auto", "adams", "bdf"] {
        let (code, _, said) = run(model, &["--t-end", "2", "--method", method]);
        assert_eq!(code, Some(5));
        let help = said.lines().last().unwrap_or_default();
        let expected = "  help: the mass matrix becomes singular there: of the inertia of v at the start ";
        assert!(help.starts_with(expected), "{help}");
    }
}

/// From t = 1e20 on, steps are shorter than the rounding of t; a length of zero was halved for ever.
#[test]
fn steps_shorter_than_the_rounding_of_time_come_to_an_end() {
    let linkage = r#"
[coordinates]
arm = 0.4
link = 0.4
[quasi_velocities]
"arm'" = 0.0145
"link'" = 0.0145
[bodies.arm]
joint = { kind = "revolute", axis = [0, 0, 1] }
mass = 1.0
inertia = [0.1, 0.1, 0.1]
[bodies.link]
joint = { kind = "revolute", axis = [0, 0, 1], at = [1, 0, 0] }
mass = 1.0
inertia = [0.1, 0.1, 0.1]
[loops.pin]
bodies = ["arm", "link"]
kind = "rod"
at = [[1, 0, 0], [1, 0, 0]]
length = 1.0
[simulation]
t_start = 1e20
"#;
    let (code, _, said) = run(linkage, &["--t-end", "0", "--method", "dop853", "--max-steps", "100"]);
    assert_eq!(code, Some(5), "{said}");
    assert!(said.contains("100 steps were not enough"), "{said}");
}
