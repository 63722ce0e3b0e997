//! Nothing that `pc` says depends on the units of a model.

use serde_json::Value;

use crate::piped::answer;

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

const SCALED: [Scaled; 10] = [
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
    (
        "a constraint that is another one times a function",
        "[coordinates]\nx = \"L{0.4}\"\ny = \"L{1.1}\"\nz = \"L{0.9}\"\n[quasi_velocities]\n\"x'\" = \"V{0.2}\"\n\"z'\" = \"V{0.8}\"\n\
         [constraints]\nk0 = \"L{y}*V{x'} + 0.7*atan(L{y})*V{y'}\"\nk1 = \"L{x}^2*(L{y}*V{x'} + 0.7*atan(L{y})*V{y'})\"\n\
         [lagrangian]\nkinetic = \"E{}*(V{x'}^2 + V{y'}^2 + V{z'}^2)/2\"\n",
        &[("x", [1, 0, 0]), ("y", [1, 0, 0]), ("z", [1, 0, 0]), ("y'", [1, -1, 0]), ("energy", [2, -2, 1])],
    ),
    (
        "a constraint on positions and a part of it",
        "[coordinates]\nx = \"L{0}\"\ny = \"L{1}\"\n[quasi_velocities]\n\
         v = { is = \"V{y'} + 0.48*(1 + L{y}^2)*V{x'}\", start = 0.26 }\nw = { is = \"V{x'}\", start = 0.5 }\n\
         [constraints]\nk0 = \"L{y}^2 + 0.88*atan(L{x}) - 1\"\nk1 = \"0.66*(L{y}^2 + 0.88*atan(L{x})) - 0.66\"\n\
         [lagrangian]\nkinetic = \"E{}*(v^2 + w^2)\"\n",
        &[("x", [1, 0, 0]), ("y", [1, 0, 0]), ("v", [0, 0, 0]), ("w", [0, 0, 0]), ("energy", [2, -2, 1])],
    ),
    (
        "quasi-velocities by quotients",
        "[coordinates]\nx = \"L{0.4}\"\ny = \"L{0.9}\"\nq = \"L{0.7}\"\n[quasi_velocities]\n\
         u = { is = \"(V{y'} + 0.4*(2 + sin(L{y}))*(V{x'}/(1 + tanh(L{x}))))*(2 + L{y}^2)\", start = 0.1 }\n\
         v = { is = \"V{x'}/(1 + tanh(L{x}))\", start = 0.3 }\n\
         w = { is = \"V{q'} - (V{y'} + 0.4*(2 + sin(L{y}))*(V{x'}/(1 + tanh(L{x}))))*(2 + L{y}^2)/(2 + L{q}^2)\" }\n\
         [lagrangian]\nkinetic = \"E{}*(u^2 + v^2 + w^2)\"\n",
        &[("x", [1, 0, 0]), ("y", [1, 0, 0]), ("q", [1, 0, 0]), ("w", [0, 0, 0]), ("energy", [2, -2, 1])],
    ),
    (
        "a frame that a constraint completes",
        "[coordinates]\nx = \"L{1}\"\ny = \"L{0.5}\"\nf = \"L{0.6}\"\nq = \"L{0.7}\"\n[quasi_velocities]\n\
         u = { is = \"(1 + tanh(L{f}))*V{x'}\", start = -0.7 }\nv = { is = \"L{q}^2*V{y'}\", start = -0.2 }\n\
         w = { is = \"L{q}^2*V{q'} + V{y'}\", start = -0.4 }\n[constraints]\nk0 = \"L{f} + 1.13*L{x} - 1.73\"\n\
         [lagrangian]\nkinetic = \"E{}*(V{x'}^2 + V{y'}^2 + V{f'}^2 + V{q'}^2)\"\n",
        &[("x", [1, 0, 0]), ("y", [1, 0, 0]), ("q", [1, 0, 0]), ("w", [0, 0, 0]), ("energy", [2, -2, 1])],
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

/// What `pc check` says that is no number with a unit.
fn said_of(model: &str) -> Value {
    let said: Value =
        serde_json::from_str(&answer(model, &["check", "-", "--format", "json"])).expect("JSON");
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
            let table = answer(&in_units(model, units), &["run", "-", "--rows", "2"]);
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
