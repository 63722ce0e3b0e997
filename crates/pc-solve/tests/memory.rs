//! Memory over a million events.
#![cfg(target_os = "linux")]
#![expect(clippy::unwrap_used, reason = "tests")]

use std::fs;
use std::ops::ControlFlow::Continue;

use pc_solve::{Ending, Event, FnEvents, Integration, Options, from_fn};

/// The resident memory of this process in kB.
fn resident() -> u64 {
    let status = fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find(|line| line.starts_with("VmRSS:")).unwrap();
    line.split_whitespace().nth(1).unwrap().parse().unwrap()
}

/// A saw tooth, each tooth with a passage that changes nothing and a reset: an integration keeps
/// only the last times of events. One number for each event would take 7 MB more at the end.
#[test]
fn a_million_events_leave_no_trace() {
    let clock = from_fn(1, |_t, _y: &[f64], ydot: &mut [f64]| {
        ydot[0] = 1.0;
        Ok(())
    });
    let tooth = FnEvents::new().with(Event::new("half").rising(), |_, y| Ok(y[0] - 0.5)).with_reset(
        Event::new("tooth").rising(),
        |_, y| Ok(y[0] - 1.0),
        |_, y| {
            y[0] = 0.0;
            Ok(())
        },
    );
    // One step for each tooth.
    let options = Options::default().initial_step(1.25).max_steps(1_000_000);
    let mut saw = Integration::new(clock, 0.0, &[0.0], &options).unwrap().with_events(tooth).unwrap();
    let mut events = 0_u64;
    let mut run_to = |t| {
        let count = |_: &_| {
            events += 1;
            Continue(())
        };
        assert_eq!(saw.advance_to(t, count).unwrap(), Ending::Completed);
        (events, resident())
    };
    let (first, before) = run_to(50_000.25);
    let (all, after) = run_to(500_000.25);
    assert_eq!((first, all), (100_000, 1_000_000));
    assert!(after < before + 1024, "{before} kB after {first} events, {after} kB after {all}");
}
