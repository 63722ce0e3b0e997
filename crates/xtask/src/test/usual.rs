//! How long stages and test programs usually take, and how long they may.

use std::time::Duration;

/// What anything may take.
const LEAST: Duration = Duration::from_secs(60);

/// Beyond this many times its usual time a stage has stopped working: slow machines and work beside it take less.
const FACTOR: u32 = 5;

/// Seconds that the test programs take on two cores which do nothing else; those that are not named take less than twelve.
const PROGRAMS: [(&str, u64); 11] = [
    ("pc-capi it", 15),
    ("pc-cli it", 300),
    ("pc-expr it", 15),
    ("pc-mech it", 15),
    ("pc-model it", 20),
    ("pc-report pages", 90),
    ("pc-solve it", 60),
    ("pc-tests it", 350),
    ("pc-tests models", 60),
    ("pc-tests rumyantsev", 25),
    ("pc-verify it", 15),
];

/// The limit of what usually takes some seconds.
pub(crate) fn limit(usual: u64) -> Duration {
    (Duration::from_secs(usual) * FACTOR).max(LEAST)
}

/// The limit of a test program.
pub(crate) fn limit_of_program(name: &str) -> Duration {
    let known = PROGRAMS.iter().find(|(known, _)| *known == name);
    limit(known.map_or(0, |&(_, seconds)| seconds))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_five_times_the_usual_time_and_at_least_a_minute() {
        assert_eq!(limit(3), Duration::from_secs(60));
        assert_eq!(limit(100), Duration::from_secs(500));
        assert_eq!(limit_of_program("no such program"), Duration::from_secs(60));
    }
}
