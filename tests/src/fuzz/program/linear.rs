//! The linear theory of a model in other units, against that in its own.

use std::fs;
use std::io;

use serde_json::Value;

use super::child::Outcome;
use super::{MODEL, Session, Tally};

/// Of the largest eigenvalue: a fourfold one is off by the fourth root of 1e-14.
const EIGENVALUE: f64 = 1e-3;

/// An eigenvalue below this is a zero that is split: rates are about 1.
const SPLIT: f64 = 1e-5;

/// The equilibrium near the start, as far as it is the same in all units.
struct Rest {
    state: Vec<(String, f64)>,
    /// The real and imaginary parts.
    eigenvalues: Vec<(f64, f64)>,
    stability: String,
}

impl Rest {
    fn of(text: &str) -> Option<Rest> {
        let json: Value = serde_json::from_str(text).ok()?;
        let part = |value: &Value, place: usize| value.get(place)?.as_f64();
        let eigenvalues = json.get("eigenvalues")?.as_array()?.iter();
        let state = json.get("state")?.as_object()?.iter();
        Some(Rest {
            state: state.map(|(name, value)| Some((name.clone(), value.as_f64()?))).collect::<Option<_>>()?,
            eigenvalues: eigenvalues
                .map(|value| Some((part(value, 0)?, part(value, 1)?)))
                .collect::<Option<_>>()?,
            stability: json.get("stability")?.as_str()?.to_owned(),
        })
    }

    /// What another finds of the same equilibrium that is not the same.
    fn difference(&self, other: &Rest) -> Option<String> {
        let largest = self.eigenvalues.iter().fold(0.0, |size, (re, im)| f64::max(size, re.hypot(*im)));
        let apart = (EIGENVALUE * largest).max(SPLIT);
        let mut rest = other.eigenvalues.clone();
        for &(re, im) in &self.eigenvalues {
            let near = rest.iter().position(|(r, i)| (r - re).hypot(i - im) <= apart);
            let Some(near) = near else {
                return Some(format!(
                    "eigenvalue {re:?} + {im:?}i of {:?} is not among {rest:?}",
                    self.state
                ));
            };
            rest.swap_remove(near);
        }
        (!rest.is_empty()).then(|| format!("eigenvalues {rest:?} are new at {:?}", other.state))
    }
}

impl Rest {
    /// Whether one is said to be stable and the other is not; which criteria decide depends on what is independent.
    fn contradicts(&self, other: &Rest) -> bool {
        let says = |word: &str, rest: &Rest| rest.stability.starts_with(word);
        let is_unstable = |rest: &Rest| says("unstable", rest);
        let is_stable = |rest: &Rest| says("stable", rest) || says("asymptotically", rest);
        (is_unstable(self) && is_stable(other)) || (is_stable(self) && is_unstable(other))
    }
}

impl Session {
    /// The linear theory of a model in other units, in which a number named so is by a power of ten larger: from the
    /// equilibrium near the start, the same equilibrium must be found there, with the same eigenvalues and the same stability.
    pub(in crate::fuzz) fn linear_in_other_units(
        &self,
        text: &str,
        in_other_units: &str,
        power: impl Fn(&str) -> i32,
    ) -> Tally {
        let mut tally = Tally::default();
        let Some(rest) = self.rest(text, &[], &mut tally).ok().and_then(Result::ok) else { return tally };
        let larger = |(name, value): &(String, f64)| {
            // The digits stay those of the value.
            let digits = format!("{value:e}");
            let (mantissa, exponent) = digits.split_once('e').unwrap_or((&digits, "0"));
            let exponent: i32 = exponent.parse().unwrap_or(0);
            format!("{name}={mantissa}e{}", exponent + power(name))
        };
        let sets: Vec<String> =
            rest.state.iter().flat_map(|entry| ["--set".to_owned(), larger(entry)]).collect();
        // From its own place, too, it must be found in its own units.
        let own: Vec<String> = rest.state.iter().map(|(name, value)| format!("{name}={value:?}")).collect();
        let own: Vec<String> = own.into_iter().flat_map(|value| ["--set".to_owned(), value]).collect();
        let Some(here) = self.rest(text, &own, &mut tally).ok().and_then(Result::ok) else { return tally };
        match self.rest(in_other_units, &sets, &mut tally) {
            Ok(Ok(there)) => {
                if let Some(detail) = here.difference(&there) {
                    tally.find("eigenvalues differ in other units", format!("{detail}\n{in_other_units}"));
                } else if here.contradicts(&there) {
                    let detail = format!(
                        "{} at {:?}, {} at {:?}\n{in_other_units}",
                        here.stability, here.state, there.stability, there.state
                    );
                    tally.find("stability differs in other units", detail);
                }
            }
            Ok(Err(message)) => {
                let detail = format!("{message}: {}\n{in_other_units}", sets.join(" "));
                tally.find("an equilibrium is refused in other units", detail);
            }
            Err(error) => return Tally::refused(format!("the program cannot be tried: {error}")),
        }
        tally
    }

    /// The equilibrium near the start, or what the program says instead.
    fn rest(&self, text: &str, sets: &[String], tally: &mut Tally) -> io::Result<Result<Rest, String>> {
        let directory = tempfile::tempdir()?;
        fs::write(directory.path().join(MODEL), super::at_default_options(text))?;
        let words = ["linearize", MODEL, "--at", "rest", "--format", "json"].map(str::to_owned);
        let words = [&words[..], sets].concat();
        let outcome = self.program.call(directory.path(), &words);
        super::judge(&outcome, &words, false, tally);
        Ok(match outcome {
            Outcome::Done(text) => Rest::of(&text).ok_or_else(|| format!("no linearization: {text}")),
            Outcome::Refused(_, message) | Outcome::Crashed(message) => Err(message),
            Outcome::Late => Err("no end".to_owned()),
        })
    }
}
