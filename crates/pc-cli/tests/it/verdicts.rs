//! Verdicts of `pc check` by theorems rather than by cancellation of terms.

use std::io::Write;
use std::process::{Command, Stdio};
use std::sync::Mutex;

use crate::each_model::each;
use pc_model::Builtin;
use serde_json::Value;

fn check(model: &str) -> String {
    let mut child = Command::new(env!("CARGO_BIN_EXE_pc"))
        .args(["check", "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("pc starts");
    child.stdin.take().expect("a pipe").write_all(model.as_bytes()).expect("pc reads");
    let output = child.wait_with_output().expect("pc ends");
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("UTF-8")
}

/// The verdict on the energy.
#[track_caller]
fn energy(model: &str) -> String {
    let text = check(model);
    let words = text.lines().find_map(|line| {
        line.trim().strip_prefix("integrals").unwrap_or(line).trim().strip_prefix("energy ")
    });
    words.unwrap_or_else(|| panic!("{text}")).trim().to_owned()
}

/// A particle under a constraint such as ż = α(y) ẋ.
fn bound(constraint: &str, kinetic: &str) -> String {
    format!(
        "[coordinates]\nx = 1.0\ny = 0.0\nz = 0.0\n[quasi_velocities]\n\"x'\" = 1.0\n[constraints]\nc = \"{constraint}\"\n\
         [lagrangian]\nkinetic = \"{kinetic}\"\n"
    )
}

/// Homogeneous constraints do no work, so the rate of the energy need not be seen to cancel, which
/// roots would prevent.
#[test]
fn homogeneous_constraints_keep_the_energy() {
    let kinetic = "(x'^2 + y'^2 + z'^2)/2";
    for rate in ["1 + y^2", "sqrt(1 + y^2)", "sqrt(2 + sqrt(1 + y^2))"] {
        assert_eq!(energy(&bound(&format!("z' - y*x'/({rate})"), kinetic)), "conserved (proved)");
    }
    for not in [
        bound("z' - (y - t)*x'/sqrt(1 + y^2) - t", kinetic), // does work
        bound("z' - y*x'/sqrt(1 + y^2)", "(1 + t^2)*(x'^2 + y'^2 + z'^2)/2"),
        bound("z' - y*x'/sqrt(1 + y^2)", kinetic) + "[forces]\nx = \"-x'\"\n",
    ] {
        assert_ne!(energy(&not), "conserved (proved)");
    }
}

/// A pendulum on a cart, with its weight as a force on a body.
const CART: &str = "[coordinates]\ns = 0.0\nphi = 0.5\n[bodies.cart]\nmass = 2\nposition = [\"s\", 0, 0]\n[bodies.bob]\nmass = 1\n\
                    position = [\"s + sin(phi)/2\", 0, \"-cos(phi)/2\"]\nforce = [0, 0, -9.81]\n";

#[test]
fn weight_counts_in_the_energy() {
    assert_eq!(energy(CART), "conserved (proved)");
    let text = check(CART);
    assert!(text.contains("                     stable, by the second variation of the energy\n"), "{text}");
    // A bead on a turning hoop has Jacobi's integral, if there is no drag.
    let hoop = "[parameters]\nW = 3.0\n[coordinates]\nth = 0.05\n[bodies.bead]\nmass = 1\n\
                position = [\"sin(th)*cos(W*t)\", \"sin(th)*sin(W*t)\", \"-cos(th)\"]\nforce = [0, 0, -9.81]\n";
    assert_eq!(energy(hoop), "conserved (proved)");
    let dragged = energy(&format!("{hoop}[forces]\nth = \"-0.1*th'\"\n"));
    assert_eq!(dragged, "dE/dt = -0.1 th'², 0 at the start");
}

/// The cart moves on for ever, while its pendulum comes to rest on it.
#[test]
fn damping_leaves_the_direction_of_a_momentum_neutral() {
    let text = check(&format!("{CART}[forces]\nphi = \"-0.2*phi'\"\n"));
    let verdict = "asymptotically stable except for one neutral direction, by the first approximation\n";
    assert!(text.contains(verdict), "{text}");
    // Without the integral of momentum, as with a force of higher order on the cart, that direction
    // is undecided.
    let pushed = check(&format!("{CART}[forces]\nphi = \"-0.2*phi'\"\ns = \"s'^3\"\n"));
    assert!(!pushed.contains("asymptotically"), "{pushed}");
}

fn json(arguments: &[&str]) -> Option<Value> {
    let output = Command::new(env!("CARGO_BIN_EXE_pc")).args(arguments).output().expect("pc runs");
    serde_json::from_slice(&output.stdout).ok()
}

/// `pc check` and `pc linearize` count the same eigenvalues and say the same of stability wherever they look at the same
/// state, with a quaternion, constraints and cyclic coordinates or without.
#[test]
fn check_and_linearize_agree_on_stability() {
    let agreeing = Mutex::new(Vec::new());
    each(Builtin::all(), |model| {
        let Some(check) = json(&["check", model.name, "--format", "json"]) else { return };
        let steady = &check["steady_motion"];
        let linearize = ["linearize", model.name, "--format", "json", "--cyclic", "drop"];
        let Some(linear) = (if steady.is_null() { None } else { json(&linearize) }) else { return };
        let values = steady["state"].as_object().expect("names and values");
        let is_near = |(name, value): (&String, &Value)| {
            let (one, other) = (value.as_f64().unwrap_or(f64::NAN), linear["state"][name].as_f64());
            other.is_some_and(|other| (one - other).abs() <= 1e-7 * (1.0 + one.abs()))
        };
        if !values.iter().all(is_near) {
            return; // another member of the family
        }
        let count = |of: &Value| of["eigenvalues"].as_array().map(Vec::len);
        assert_eq!(count(steady), count(&linear), "{}", model.name);
        assert_eq!(steady["verdict"], linear["stability"], "{}", model.name);
        agreeing.lock().expect("no claim panics while it holds the lock").push(model.name);
    });
    let agreeing = agreeing.into_inner().expect("no claim panicked");
    let known =
        ["reaction-wheels", "whipple-bicycle", "slider-crank-loop", "heavy-top-quaternion", "tilted-disk"];
    assert!(known.iter().all(|name| agreeing.contains(name)), "{agreeing:?}");
}

/// A particle in four dimensions under two constraints on its velocities.
fn bound_twice(first: &str, second: &str) -> String {
    format!(
        "[parameters]\nR = 0.37\n[coordinates]\nx = 0.1\ny = 0.2\nz = 0.3\nw = 0.4\n[constraints]\nk1 = \"{first}\"\nk2 = \"{second}\"\n\
         [lagrangian]\nkinetic = \"(x'^2 + y'^2 + z'^2 + w'^2)/2\"\n"
    )
}

/// The report on combinations of constraints.
#[track_caller]
fn combinations(model: &str) -> Vec<String> {
    let text = check(model);
    let lines = text.lines().map(|line| line.trim().trim_start_matches("constraints").trim());
    lines.filter(|line| line.contains("combination")).map(str::to_owned).collect()
}

/// Neither constraint binds positions alone.
#[test]
fn integrable_combinations_of_constraints_are_written() {
    for (first, second, said) in [
        // ż − y ẋ and ẇ − y ẋ: their difference is that of z and w.
        ("z' - y*x'", "w' - y*x'", "k1 - k2: z - w = const"),
        ("z' - y*x'", "w' + y*x'/2 + cos(z)*z'/2 + y'", "k1 + 2 k2: 2 y + z + 2 w + sin(z) = const"),
        // With a parameter.
        ("z' - R*y*x'", "w' - y*x'", "k1 - R k2: z - R w = const"),
        // With functions: dw is y dx divided by z, dz is y dx.
        ("z' - y*x'", "z*w' - y*x'", "-(1/z) k1 + (1/z) k2: w - ½ log(z²) = const"),
        // With the time.
        ("z' - y*x' - t", "w' - y*x'", "k1 - k2: z - w - ½ t² = const"),
    ] {
        assert_eq!(combinations(&bound_twice(first, second)), [format!("integrable combination  {said}")]);
    }
    // The chain of the n-trailer reaches all positions.
    assert!(combinations(&bound_twice("z' - y*x'", "w' - z*x'")).is_empty());
}

/// Two wheels of radius R on an axle of length 2 b: the difference of their angles determines the
/// direction of the axle.
#[test]
fn wheels_on_an_axle_determine_its_direction() {
    let axle = "[parameters]\nR = 0.25\nb = 0.4\n[coordinates]\nx = 0.0\ny = 0.0\npsi = 0.3\nleft = 0.0\nright = 0.0\n\
                [constraints]\nblade = \"y'*cos(psi) - x'*sin(psi)\"\n\
                k1 = \"x'*cos(psi) + y'*sin(psi) - b*psi' - R*left'\"\n\
                k2 = \"x'*cos(psi) + y'*sin(psi) + b*psi' - R*right'\"\n\
                [lagrangian]\nkinetic = \"(x'^2 + y'^2 + psi'^2 + left'^2 + right'^2)/2\"\n";
    let said = combinations(axle);
    assert_eq!(said, ["integrable combination  k1 - k2: R right - R left - 2 b psi = const"]);
}

/// They are counted although their integral, of Airy's kind, is not an elementary function.
#[test]
fn integrable_combinations_that_are_not_found_are_counted() {
    let model = bound_twice("z' - y*x'", "w' - y*x' - exp(z^2)*z'");
    assert_eq!(combinations(&model), ["1 integrable combination, not found in closed form"]);
}

/// `text` in other units, powers of ten of length, time and mass. In it `L{x}` is a length, `V{u}` a velocity, `W{w}` one over a time and
/// `E{}` the unit of energy: a number in the new unit, or the name of a quantity that is measured in it.
fn in_units(text: &str, [length, time, mass]: [i32; 3]) -> String {
    let mut pieces = text.split('{');
    let mut scaled = pieces.next().expect("a beginning").to_owned();
    for piece in pieces {
        let power = match scaled.pop() {
            Some('L') => length,
            Some('V') => length - time,
            Some('W') => -time,
            Some('E') => mass + 2 * (length - time),
            other => {
                // The beginning of a table.
                scaled.extend(other.into_iter().chain(['{']));
                scaled += piece;
                continue;
            }
        };
        let (inside, rest) = piece.split_once('}').expect("an end");
        scaled += &match (inside, inside.parse::<f64>()) {
            ("", _) => format!("1e{power}"),
            (number, Ok(_)) => format!("{number}e{power}"),
            (name, Err(_)) => format!("({name}/1e{power})"),
        };
        scaled += rest;
    }
    format!("{scaled}[simulation]\nt_end = 1.5e{time}\natol = 1e-30\n")
}

/// A model by its name, with the columns of its motion and the powers of length, time and mass in their units.
type Scaled = (&'static str, &'static str, &'static [(&'static str, [i32; 3])]);

const SCALED: [Scaled; 6] = [
    (
        "an operator that grows small with the distance",
        "[coordinates]\nx = \"L{0.4}\"\ny = \"L{0.1}\"\n[quasi_velocities]\nu = \"V{0.7}\"\nv = \"V{1.1}\"\n\
         [kinematics]\nx = \"V{}*V{u}\"\ny = \"V{}*exp(-(L{x})^2)*V{v}\"\n\
         [lagrangian]\nkinetic = \"E{}*(V{u}^2 + 2*V{v}^2)/2\"\npotential = \"E{}*log(1 + L{x}^2 + L{y}^2)\"\n",
        &[("x", [1, 0, 0]), ("y", [1, 0, 0]), ("u", [1, -1, 0]), ("v", [1, -1, 0]), ("energy", [2, -2, 1])],
    ),
    (
        "a bob on a rod",
        "[coordinates]\nx = \"L{0.6}\"\ny = \"L{-0.8}\"\n[constraints]\nrod = \"L{x}^2 + L{y}^2 - 1\"\n\
         [lagrangian]\nkinetic = \"E{}*(V{x'}^2 + V{y'}^2)/2\"\npotential = \"E{}*9.81*L{y}\"\n",
        &[("x", [1, 0, 0]), ("y", [1, 0, 0]), ("x'", [1, -1, 0]), ("energy", [2, -2, 1])],
    ),
    (
        "a blade",
        "[coordinates]\nX = 0.0\nY = 0.0\nf = 0.3\n[quasi_velocities]\n\
         v = { is = \"V{}*(cos(f)*V{X'} + sin(f)*V{Y'})\", start = \"V{0.2}\" }\nw = { is = \"f'\", start = \"W{1}\" }\n\
         [constraints]\nblade = \"cos(f)*V{Y'} - sin(f)*V{X'}\"\n\
         [lagrangian]\nkinetic = \"E{}*(V{v}^2/2 + W{w}^2*0.6)\"\n",
        &[("X", [1, 0, 0]), ("Y", [1, 0, 0]), ("f", [0, 0, 0]), ("v", [1, -1, 0]), ("w", [0, -1, 0])],
    ),
    (
        "an orbit under a screened force",
        "[coordinates]\nr = \"L{1}\"\nf = 0.0\n[quasi_velocities]\n\"r'\" = \"V{0.1}\"\n\"f'\" = \"W{1.1}\"\n\
         [lagrangian]\nkinetic = \"E{}*(V{r'}^2 + L{r}^2*W{f'}^2)/2\"\npotential = \"-E{}*exp(-L{r}/2)/L{r}\"\n\
         [integrals]\narea = \"L{r}^2*W{f'}\"\n",
        &[("r", [1, 0, 0]), ("f", [0, 0, 0]), ("r'", [1, -1, 0]), ("f'", [0, -1, 0]), ("area", [0, 0, 0])],
    ),
    (
        "three particles of Toda's chain",
        "[coordinates]\na = \"L{0.2}\"\nb = \"L{1}\"\nc = \"L{2.5}\"\n\
         [quasi_velocities]\n\"a'\" = \"V{0.3}\"\n\"b'\" = \"V{-0.1}\"\n\"c'\" = \"V{0.2}\"\n\
         [lagrangian]\nkinetic = \"E{}*(V{a'}^2 + V{b'}^2 + V{c'}^2)/2\"\npotential = \"E{}*(exp(L{a} - L{b}) + exp(L{b} - L{c}))\"\n",
        &[("a", [1, 0, 0]), ("b", [1, 0, 0]), ("c'", [1, -1, 0]), ("energy", [2, -2, 1])],
    ),
    (
        "a particle whose velocity z' is left to the constraint",
        "[coordinates]\nx = \"L{0.3}\"\ny = \"L{0.2}\"\nz = \"L{0.5}\"\n[quasi_velocities]\n\"x'\" = \"V{0.5}\"\n\"y'\" = \"V{0.7}\"\n\
         [constraints]\nplane = \"z' - L{y}*tanh(L{z})*x'\"\n\
         [lagrangian]\nkinetic = \"E{}*(V{x'}^2 + V{y'}^2 + V{z'}^2)/2\"\n",
        &[("x", [1, 0, 0]), ("z", [1, 0, 0]), ("x'", [1, -1, 0]), ("y'", [1, -1, 0]), ("energy", [2, -2, 1])],
    ),
];

/// Powers of ten of length, time and mass.
const UNITS: [[i32; 3]; 10] = [
    [-9, 0, 0],
    [-6, 0, 0],
    [6, 0, 0],
    [9, 0, 0],
    [0, -9, 0],
    [0, 9, 0],
    [0, 0, -9],
    [0, 0, 9],
    [-9, -6, 6],
    [6, 6, -9],
];

fn pc(arguments: &[&str], model: &str) -> String {
    let mut child = Command::new(env!("CARGO_BIN_EXE_pc"))
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("pc starts");
    child.stdin.take().expect("a pipe").write_all(model.as_bytes()).expect("pc reads");
    let output = child.wait_with_output().expect("pc ends");
    assert_eq!(output.status.code(), Some(0), "{model}{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("UTF-8")
}

/// What `pc check` says that is no number with a unit.
fn said_of(model: &str) -> Value {
    let said: Value = serde_json::from_str(&pc(&["check", "-", "--format", "json"], model)).expect("JSON");
    let list = |name: &str| said[name].as_array().cloned().unwrap_or_default();
    let is_small = |name: &str| said[name].as_f64().is_none_or(|residual| residual < 1e-9);
    // Of Casimirs there is a basis, and which one depends on the numbers.
    let integrals = list("integrals").into_iter().filter(|integral| integral["how"] != "Casimir");
    serde_json::json!({
        "rank": said["rank"],
        "holonomic": list("holonomic").iter().map(|eta| json_of(eta, &["name", "holonomic"])).collect::<Vec<_>>(),
        "constraints": list("constraints").iter().map(|c| json_of(c, &["name", "kind"])).collect::<Vec<_>>(),
        "dropped": said["dropped_constraints"],
        "closed": is_small("closure_residual"),
        "Jacobi": is_small("jacobi_residual"),
        "algebra": said["algebra"],
        "rank of the mass matrix": said["mass_matrix_rank"],
        "integrals": integrals.map(|integral| json_of(&integral, &["how", "verdict"])).collect::<Vec<_>>(),
    })
}

fn json_of(value: &Value, names: &[&str]) -> Vec<Value> {
    names.iter().map(|&name| value[name].clone()).collect()
}

/// A model in units of 10⁻⁹ to 10⁹ has the verdicts and, in the same units, the motion of the model in units of 1.
#[test]
fn nothing_depends_on_units() {
    for (name, model, columns) in SCALED {
        let end = |units: [i32; 3]| {
            let table = pc(&["run", "-", "--samples", "2"], &in_units(model, units));
            let cells =
                |line: Option<&str>| line.expect("a line").split(',').map(str::to_owned).collect::<Vec<_>>();
            let (names, row) = (cells(table.lines().next()), cells(table.lines().last()));
            let of = |(column, powers): &(&str, [i32; 3])| {
                let place = names.iter().position(|known| known == column).expect("a column");
                let power: i32 = powers.iter().zip(units).map(|(power, unit)| power * unit).sum();
                row[place].parse::<f64>().expect("a number") / 10f64.powi(power)
            };
            columns.iter().map(of).collect::<Vec<f64>>()
        };
        let (known, motion) = (said_of(&in_units(model, [0; 3])), end([0; 3]));
        for units in UNITS {
            assert_eq!(said_of(&in_units(model, units)), known, "{name} in {units:?}");
            for ((found, expected), (column, _)) in end(units).iter().zip(&motion).zip(columns) {
                // Steps of the tolerance 1e-9 are others where atol is other.
                assert!(
                    (found - expected).abs() < 1e-6,
                    "{name} in {units:?}: {column} = {found}, not {expected}"
                );
            }
        }
    }
}
