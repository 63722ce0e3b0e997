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

/// The tests that take more than ten seconds: `--quick` leaves them out.
pub(crate) const LONG: [(&str, &str); 15] = [
    ("pc-cli it", "browser::the_page_of_a_bicycle"),
    ("pc-cli it", "browser::the_page_of_a_car_with_trailers"),
    ("pc-cli it", "browser::the_page_of_a_heavy_top"),
    ("pc-cli it", "checkpoint::a_run_with_events_gives_the_same_bytes_from_each_checkpoint"),
    ("pc-cli it", "help::the_examples_run"),
    ("pc-cli it", "program::models_and_algebras_are_listed"),
    ("pc-cli it", "report::the_page_of_a_platform_on_six_legs_is_not_too_long"),
    ("pc-cli it", "sweep_of::what_was_cut_short_goes_on_and_gives_the_same_bytes"),
    ("pc-cli it", "theory::all_models_have_a_theory"),
    ("pc-cli it", "verdicts::check_and_linearize_agree_on_stability"),
    ("pc-model it", "definitions::ten_thousand_nested_definitions_need_no_deep_stack"),
    ("pc-report pages", "pages_of_all_models"),
    ("pc-tests it", "mechanisms::a_bicycle_rides_alike_in_rates_of_roll_and_steer_and_in_velocities"),
    ("pc-tests it", "printed_pages::accelerations_that_are_read_back_are_those_of_the_run"),
    ("pc-tests it", "random_models::random_models_agree_with_independent_computations"),
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
    use std::fs;
    use std::path::Path;

    use super::*;

    /// A name that no test has leaves nothing out.
    #[test]
    fn long_tests_exist() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        for (program, test) in LONG {
            let (package, program) = program.split_once(' ').unwrap();
            let package =
                if package == "pc-tests" { "tests".to_owned() } else { format!("crates/{package}") };
            let (file, name) =
                test.split_once("::").map_or((format!("{program}.rs"), test), |(module, name)| {
                    (format!("{program}/{module}.rs"), name)
                });
            let text = fs::read_to_string(root.join(package).join("tests").join(&file)).unwrap();
            assert!(text.contains(&format!("fn {name}(")), "{file}: {name}");
        }
    }

    #[test]
    fn limits_are_five_times_the_usual_time_and_at_least_a_minute() {
        assert_eq!(limit(3), Duration::from_secs(60));
        assert_eq!(limit(100), Duration::from_secs(500));
        assert_eq!(limit_of_program("no such program"), Duration::from_secs(60));
    }
}
