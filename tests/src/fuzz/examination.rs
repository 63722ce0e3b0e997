//! One specimen, examined: what was found, what was refused.

use std::cell::{Cell, RefCell};
use std::panic::{self, AssertUnwindSafe};
use std::sync::mpsc;
use std::thread;
use std::time::Duration;

use super::comparison::{self, Finding};
use super::emission;
use super::execution::{Forms, GIVEN_UP, Refusal, execute};
use super::generator;
use super::program::{Session, Tally};
use super::regular::stays_regular;
use super::specimen::Specimen;
use super::start::Start;
use super::text;
use super::units::Units;

/// A finding in the motion that a model is compared with.
const TWIN_DISAGREES: &str = "second derivation disagrees in ordinary velocities";

/// A motion that runs into a place where its frame is singular: a refusal that is right.
const SINGULAR: &str = "integration, up to where the frame is singular";

/// A motion that ends, in ordinary velocities as well.
const BOTH: &str = "integration, in ordinary velocities, too";

/// The motion in quasi-velocities, with the second derivation.
const TWICE: Forms = Forms { second: true, ..Forms::ONE };

/// The main thread of the program has as much.
const STACK: usize = 8 << 20;

/// What came of a specimen.
#[derive(Clone, Debug, Default)]
pub struct Examined {
    /// Its text; empty where it has no start.
    pub text: String,
    /// Its text in ordinary velocities.
    pub twin: Option<String>,
    /// What is wrong.
    pub findings: Vec<Finding>,
    /// What the product did not do.
    pub refusals: Vec<Refusal>,
    /// Whether the model was run.
    pub ran: bool,
    /// Whether it was refused, as it must be.
    pub rightly_refused: bool,
}

/// How a specimen is examined.
#[derive(Clone, Debug)]
pub struct Thoroughness {
    /// With a compiler for emitted source.
    pub emitted: bool,
    /// By commands of the program.
    pub commands: Option<Session>,
    /// In other units.
    pub units: Option<Units>,
    /// How long it may take.
    pub limit: Duration,
}

/// Examines model number `index` of a seed.
pub fn examine(seed: u64, index: u64, thoroughness: Thoroughness) -> Examined {
    examine_specimen(&generator::specimen(seed, index), thoroughness)
}

/// Examines a specimen in a thread of its own. One that takes too long is left to itself, and refused.
pub fn examine_specimen(specimen: &Specimen, thoroughness: Thoroughness) -> Examined {
    let Some(start) = Start::of(specimen) else { return Examined::default() };
    let (text, twin) = (text::model(specimen, &start), text::twin(specimen, &start));
    let (copy, texts) = (specimen.clone(), (text.clone(), twin.clone()));
    let limit = thoroughness.limit;
    let work = move || examine_texts(&copy, &start, &texts.0, texts.1.as_deref(), thoroughness);
    Examined { text, twin, ..bounded(limit, work) }
}

/// Work in a thread of its own, for so long; a panic is a finding.
pub(super) fn bounded(limit: Duration, work: impl FnOnce() -> Examined + Send + 'static) -> Examined {
    let (sender, receiver) = mpsc::channel();
    let work = move || {
        IS_EXAMINING.set(true);
        // Nobody listens any more where the limit has passed.
        let _ = sender.send(panic::catch_unwind(AssertUnwindSafe(work)).map_err(|_| last_panic()));
    };
    let thread = thread::Builder::new().stack_size(STACK).spawn(work);
    match thread.map(|_| receiver.recv_timeout(limit)) {
        Ok(Ok(Ok(examined))) => examined,
        Ok(Ok(Err(message))) => Examined::of_finding("panic", message),
        Ok(Err(_)) => Examined::of_refusal("time", format!("given up after {limit:?}")),
        Err(error) => Examined::of_refusal("time", format!("no thread: {error}")),
    }
}

impl Examined {
    fn of_finding(kind: &'static str, detail: String) -> Examined {
        Examined { findings: vec![Finding { kind, detail }], ..Examined::default() }
    }

    fn of_refusal(stage: &'static str, message: String) -> Examined {
        Examined { refusals: vec![Refusal { stage, message }], ..Examined::default() }
    }

    /// Adds what came of commands.
    pub(super) fn add(&mut self, tally: Tally) {
        self.findings.extend(tally.findings);
        self.refusals.extend(tally.refusals);
    }

    /// Whether something of this kind was found.
    pub fn has(&self, kind: &str) -> bool {
        self.findings.iter().any(|finding| finding.kind == kind)
    }
}

fn examine_texts(
    specimen: &Specimen,
    start: &Start,
    text: &str,
    twin: Option<&str>,
    thoroughness: Thoroughness,
) -> Examined {
    let mut examined = Examined::default();
    let undetermined = comparison::is_undetermined(specimen);
    let execution =
        match execute("model.toml", text, Forms { all: true, emitted: thoroughness.emitted, ..TWICE }) {
            Ok(execution) => execution,
            Err(refusal) => {
                examined.rightly_refused = undetermined;
                let twin = twin.map(|twin| execute("twin.toml", twin, TWICE));
                match (refusal.stage, twin) {
                    (GIVEN_UP, Some(Ok(twin))) if stays_regular(specimen, start, &twin.motion) => {
                        examined.findings.push(Finding {
                            kind: "given up, though not in ordinary velocities",
                            detail: refusal.message,
                        });
                    }
                    (GIVEN_UP, Some(Ok(_))) => examined.refusals.push(Refusal { stage: SINGULAR, ..refusal }),
                    (GIVEN_UP, Some(Err(twin))) if twin.stage == GIVEN_UP => {
                        examined.refusals.push(Refusal { stage: BOTH, ..refusal });
                    }
                    _ => examined.refusals.push(refusal),
                }
                return examined;
            }
        };
    examined.ran = true;
    if undetermined {
        let detail = "the fields are dependent over the constants, and no [algebra] is given".to_owned();
        return Examined { ran: true, ..Examined::of_finding("brackets that nothing determines", detail) };
    }
    examined.refusals = comparison::refusals(&execution);
    examined.findings = comparison::within(specimen, start, &execution);
    if let Some(Ok(emission)) = &execution.emitted {
        examined.findings.extend(emission::compare(emission));
    }
    let rescaled = thoroughness.units.and_then(|units| units.examine(specimen, &execution));
    examined.findings.extend(rescaled.iter().flat_map(|rescaled| rescaled.findings.clone()));
    if let Some(commands) = thoroughness.commands {
        if let (Some(rescaled), Some(units)) = (&rescaled, thoroughness.units) {
            examined.add(commands.clone().follow_in_other_units(text, &rescaled.text));
            let power = |name: &str| units.power(specimen, name);
            examined.add(commands.linear_in_other_units(text, &rescaled.text, power));
        }
        examined.add(commands.examine(text, &execution));
    }
    let Some(twin) = twin else { return examined };
    match execute("twin.toml", twin, TWICE) {
        Ok(twin) => {
            let second = comparison::second(&twin).map(|finding| Finding { kind: TWIN_DISAGREES, ..finding });
            examined.findings.extend(second);
            // Past a place where the frame is singular the model has no motion to be compared.
            if stays_regular(specimen, start, &twin.motion) {
                examined.findings.extend(comparison::between(specimen, start, &execution, &twin));
            }
        }
        Err(refusal) => {
            let message = refusal.message;
            examined.refusals.push(Refusal { stage: "ordinary velocities", message });
        }
    }
    examined
}

thread_local! {
    /// Whether the thread examines a specimen.
    static IS_EXAMINING: Cell<bool> = const { Cell::new(false) };
    static LAST_PANIC: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Has panics of specimens noted, with their places; the hook before is that of all others.
pub fn note_panics() {
    let others = panic::take_hook();
    panic::set_hook(Box::new(move |panic| {
        if !IS_EXAMINING.get() {
            return others(panic);
        }
        let message = panic.payload_as_str().unwrap_or("a panic without words");
        let place = panic.location().map_or_else(String::new, |place| format!(" at {place}"));
        LAST_PANIC.with_borrow_mut(|last| *last = format!("{message}{place}"));
    }));
}

fn last_panic() -> String {
    LAST_PANIC.with_borrow(Clone::clone)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fuzz::campaign::{Campaign, Subject};
    use crate::fuzz::expression::Expression;
    use crate::fuzz::report::Report;
    use crate::fuzz::specimen::{Coordinate, Frame};

    const SHORT: Thoroughness =
        Thoroughness { emitted: false, commands: None, units: None, limit: Duration::from_secs(3600) };

    /// Two masses on a line in quasi-velocities, one of which is said to be another than it is.
    fn with_definition(first: &str) -> Specimen {
        let mut specimen = generator::empty();
        let coordinate = |name: &str| Coordinate { name: name.to_owned(), start: 0.5, shown: true };
        specimen.chart = vec![coordinate("x"), coordinate("y")];
        specimen.velocities = vec![0.3, -0.2];
        let parsed = |text: &str| Expression::parse(text).expect("an expression");
        specimen.kinetic = vec![parsed("w1^2"), parsed("w2^2")];
        specimen.frame = Frame::Group {
            eta: vec!["w1".to_owned(), "w2".to_owned()],
            velocities: vec![parsed("w1"), parsed("w2 + x*w1")],
            inverse: vec![parsed(first), parsed("y' - x*x'")],
        };
        specimen
    }

    #[test]
    fn a_model_and_its_twin_move_alike() {
        let examined = examine_specimen(&with_definition("x'"), SHORT);
        assert!(examined.ran && examined.findings.is_empty(), "{:?}", examined.findings);
    }

    #[test]
    fn a_quasi_velocity_that_is_another_one_is_found() {
        let examined = examine_specimen(&with_definition("1.5*x'"), SHORT);
        assert!(examined.has("motion in ordinary velocities differs"), "{:?}", examined.findings);
    }

    #[test]
    fn brackets_that_nothing_determines_must_be_refused() {
        let mut specimen = with_definition("x'");
        specimen.chart[1].shown = false;
        assert!(comparison::is_undetermined(&specimen));
        specimen.algebra = Some("brackets = { \"w1,w2\" = \"0\" }".to_owned());
        assert!(!comparison::is_undetermined(&specimen));
    }

    #[test]
    fn a_campaign_is_the_same_with_any_number_of_threads() {
        let campaign = Campaign {
            subject: Subject::Models,
            seed: 3,
            first: 10,
            count: 8,
            threads: 1,
            emitted_every: 0,
            program: None,
            program_every: 0,
            units_every: 4,
            limit: Duration::from_secs(3600),
        };
        let one = campaign.run(|_, _| ());
        let several = Campaign { threads: 3, ..campaign.clone() }.run(|_, _| ());
        let texts = |results: &[(u64, Examined)]| -> Vec<String> {
            results.iter().map(|(index, examined)| format!("{index} {}", examined.text)).collect()
        };
        assert_eq!(texts(&one), texts(&several));
        assert_eq!(Report::of(&one).text(), Report::of(&several).text());
    }
}
