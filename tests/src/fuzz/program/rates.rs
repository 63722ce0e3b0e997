//! `pc linearize` and `pc equilibria`, against the rates of this process.

use pc_expr::VectorField as _;
use serde_json::Value;

use super::tried::Tried;
use crate::fuzz::comparison::exceeds;

/// Of the largest entry of the matrix or of 1: differences over 1e-5 leave 1e-10 of third derivatives, and 1e-11 of rounding.
const SLOPE: f64 = 1e-5;

/// Of the rates at the start, of a slope or of 1: Newton's method ends where rounding does.
const REST: f64 = 1e-6;

/// The step of differences, of a component or of 1.
const STEP: f64 = 1e-5;

/// The matrix A and, where the state is said to be steady, the rates there.
pub(super) fn linearized(tried: &mut Tried<'_>) {
    let at = *tried.random.pick(&["start", "start", "steady", "rest"]);
    let arguments = ["--at", at, "--format", "json"].map(str::to_owned);
    let stage = if at == "start" { "pc linearize --at start" } else { "pc linearize" };
    let Some(text) = tried.output(stage, "linearize", &arguments) else { return };
    let Some(read) = Linearized::of(&text) else {
        return tried.tally.find("the program writes what is no table", format!("linearize: {text}"));
    };
    if let Some(detail) = wrong(tried, at, &read) {
        tried
            .tally
            .find("the matrix of linearize is not the slope of the rates", format!("--at {at}: {detail}"));
    }
}

/// The equilibria that are found.
pub(super) fn equilibria(tried: &mut Tried<'_>) {
    let arguments = ["--format", "json", "--starts", "32"].map(str::to_owned);
    let Some(text) = tried.output("pc equilibria", "equilibria", &arguments) else { return };
    let Some(found) = serde_json::from_str(&text).ok().as_ref().and_then(states) else {
        return tried.tally.find("the program writes what is no table", format!("equilibria: {text}"));
    };
    for state in found {
        let Some(y) = state_of(tried, &state) else { return };
        let names: Vec<String> = state.into_iter().map(|(name, _)| name).collect();
        if let Some(detail) = moves(tried, &y, &names) {
            return tried.tally.find("an equilibrium does not rest", detail);
        }
    }
}

/// What `pc linearize --format json` says, as far as it is judged.
struct Linearized {
    t: f64,
    state: Vec<(String, f64)>,
    components: Vec<String>,
    left_out: usize,
    steady: bool,
    matrix: Vec<Vec<f64>>,
}

impl Linearized {
    fn of(text: &str) -> Option<Linearized> {
        let json: Value = serde_json::from_str(text).ok()?;
        let rows = json.get("A")?.as_array()?.iter();
        let matrix =
            rows.map(|row| row.as_array()?.iter().map(Value::as_f64).collect()).collect::<Option<_>>()?;
        let components = json.get("components")?.as_array()?.iter();
        Some(Linearized {
            t: json.get("t")?.as_f64()?,
            state: state(json.get("state")?)?,
            components: components.map(|name| name.as_str().map(str::to_owned)).collect::<Option<_>>()?,
            left_out: json.get("left_out")?.as_object()?.len(),
            steady: json.get("steady")?.as_bool()?,
            matrix,
        })
    }
}

fn states(json: &Value) -> Option<Vec<Vec<(String, f64)>>> {
    json.get("equilibria")?.as_array()?.iter().map(|found| state(found.get("state")?)).collect()
}

fn state(json: &Value) -> Option<Vec<(String, f64)>> {
    let entry = |(name, value): (&String, &Value)| Some((name.clone(), value.as_f64()?));
    json.as_object()?.iter().map(entry).collect()
}

/// The state of the equations for named values; none where the equations have other components, as with constraints put in.
fn state_of(tried: &mut Tried<'_>, named: &[(String, f64)]) -> Option<Vec<f64>> {
    let start = tried.flow.start.clone();
    let row = tried.flow.row(tried.t_start, &start);
    let names = tried.flow.names.clone();
    if start.len() != names.len() || row[..names.len()] != start[..] {
        return None;
    }
    names.iter().map(|name| named.iter().find(|(known, _)| known == name).map(|(_, value)| *value)).collect()
}

fn rates(tried: &mut Tried<'_>, t: f64, y: &[f64]) -> Option<Vec<f64>> {
    let mut rates = vec![f64::NAN; y.len()];
    tried.flow.motion.rhs(t, y, &mut rates).ok()?;
    Some(rates)
}

/// A component with one of these names that moves at a state that is said to be at rest.
fn moves(tried: &mut Tried<'_>, y: &[f64], names: &[String]) -> Option<String> {
    let (t, start) = (tried.t_start, tried.flow.start.clone());
    let usual = rates(tried, t, &start)?;
    let here = rates(tried, t, y)?;
    // What rounding of the state makes of the rates is as steep as they are.
    let mut steepness = 1.0;
    for i in 0..y.len() {
        let mut beside = y.to_vec();
        beside[i] += STEP;
        let beside = rates(tried, t, &beside)?;
        steepness = beside.iter().zip(&here).fold(steepness, |s, (a, b)| f64::max(s, (a - b).abs() / STEP));
    }
    let allowed = REST * usual.iter().fold(steepness, |size, rate| f64::max(size, rate.abs()));
    let moving = tried.flow.names.iter().zip(&here).filter(|(name, _)| names.contains(name));
    let (name, rate) = moving.into_iter().find(|(_, rate)| exceeds(**rate, allowed))?;
    Some(format!("the rate of {name} is {rate:?} at {y:?}; {allowed:.0e} allowed"))
}

/// An entry of the matrix that is not the slope of the rates, or a component of a steady state that is not steady.
fn wrong(tried: &mut Tried<'_>, at: &str, read: &Linearized) -> Option<String> {
    let y = state_of(tried, &read.state)?;
    // At the start cyclic coordinates are components even where they move.
    if read.steady
        && at != "start"
        && let Some(moving) = moves(tried, &y, &read.components)
    {
        return Some(moving);
    }
    // With fewer components the others follow by constraints, which differences would have to keep.
    if read.components.len() + read.left_out != y.len() {
        return None;
    }
    let names = tried.flow.names.clone();
    let place = |name: &String| names.iter().position(|known| known == name);
    let places: Vec<usize> = read.components.iter().map(place).collect::<Option<_>>()?;
    let size = read.matrix.iter().flatten().fold(1.0, |size, entry| f64::max(size, entry.abs()));
    for (column, &j) in places.iter().enumerate() {
        let step = STEP * y[j].abs().max(1.0);
        let narrow = slope(tried, read.t, &y, j, step)?;
        let wide = slope(tried, read.t, &y, j, 2.0 * step)?;
        for (row, &i) in places.iter().enumerate() {
            let settled = f64::abs(narrow[i] - wide[i]) <= SLOPE * size / 4.0;
            let entry = read.matrix[row][column];
            if settled && exceeds(entry - narrow[i], SLOPE * size) {
                let (of, by) = (&names[i], &names[j]);
                return Some(format!(
                    "the rate of {of} by {by} is {entry:?}, the difference {:?}",
                    narrow[i]
                ));
            }
        }
    }
    None
}

/// (ẏ(y + h e_j) − ẏ(y − h e_j))/2h
fn slope(tried: &mut Tried<'_>, t: f64, y: &[f64], j: usize, step: f64) -> Option<Vec<f64>> {
    let mut at = |step: f64| {
        let mut moved = y.to_vec();
        moved[j] += step;
        rates(tried, t, &moved)
    };
    let (above, below) = (at(step)?, at(-step)?);
    Some(above.iter().zip(&below).map(|(a, b)| (a - b) / (2.0 * step)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fuzz::execution::{Forms, execute};
    use crate::fuzz::program::child::Program;
    use crate::fuzz::random::Random;

    const OSCILLATOR: &str = "[coordinates]\nx = 0.5\n[quasi_velocities]\n\"x'\" = 0.2\n[lagrangian]\nkinetic = \"x'^2/2\"\n\
         potential = \"x^2 + x^3\"\n[simulation]\nt_end = 1\n";

    /// What is done with the rates of ẍ = −2 x − 3 x².
    fn with_rates<T>(work: impl FnOnce(&mut Tried<'_>) -> T) -> T {
        let execution = execute("model.toml", OSCILLATOR, Forms::ONE).expect("a motion");
        let (program, mut random) = (Program::nowhere(), Random::new(0, 0));
        let here = std::path::Path::new(".");
        work(&mut Tried::new(&program, here, OSCILLATOR, &execution, &mut random).expect("a model"))
    }

    fn said(slope: f64) -> Linearized {
        let matrix = format!("[[0.0, 1.0], [{slope:?}, 0.0]]");
        let state = "{\"x\": 0.5, \"x'\": 0.2}";
        let rest = "\"left_out\": {}, \"steady\": false, \"t\": 0.0";
        let text =
            format!("{{\"state\": {state}, \"components\": [\"x\", \"x'\"], \"A\": {matrix}, {rest}}}");
        Linearized::of(&text).expect("a linearization")
    }

    #[test]
    fn a_slope_that_is_another_is_found() {
        // −2 − 6 x
        assert_eq!(with_rates(|tried| wrong(tried, "start", &said(-5.0))), None);
        let found = with_rates(|tried| wrong(tried, "start", &said(-5.01)));
        assert!(found.is_some_and(|detail| detail.contains("the rate of x' by x is -5.01")));
    }

    #[test]
    fn an_equilibrium_that_moves_is_found() {
        let names = ["x".to_owned(), "x'".to_owned()];
        // −2 x − 3 x² vanishes at 0 and −2/3.
        assert_eq!(with_rates(|tried| moves(tried, &[-2.0 / 3.0, 0.0], &names)), None);
        let found = with_rates(|tried| moves(tried, &[-0.66, 0.0], &names));
        assert!(found.is_some_and(|detail| detail.starts_with("the rate of x'")));
        assert!(with_rates(|tried| moves(tried, &[0.0, 0.1], &names)).is_some());
    }
}
